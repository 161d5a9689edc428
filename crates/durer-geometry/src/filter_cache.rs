//! The packet filters of slots, each made at its first use.

use crate::Geometry;
use crate::csg::PacketCsg;
use durer_math::{Aabb, Shaft};
use durer_surfaces::packet::{FilterSource, PacketFilter};
use std::sync::OnceLock;

/// Packet filters by arena and slot.
#[derive(Debug, Default)]
pub(crate) struct Outlines(Vec<Vec<OnceLock<Box<SlotFilter>>>>);

/// The packet filter of a slot.
#[derive(Debug)]
pub(crate) struct SlotFilter {
    pub(crate) seen: FilterKind,
    /// A box that holds the slot's surface or part.
    pub(crate) bounds: Aabb,
}

/// The kinds of packet filters.
#[derive(Debug)]
pub(crate) enum FilterKind {
    /// The filter of a surface.
    Outline(PacketFilter),
    /// A CSG solid.
    Body(Box<PacketCsg>),
    /// No filter: the surface's numbers are too large or too small.
    Nothing,
}

impl FilterKind {
    pub(crate) fn of(sketch: &FilterSource) -> Self {
        sketch.build().map_or(Self::Nothing, Self::Outline)
    }
}

impl Outlines {
    /// The greatest number of slots. Each takes 16 bytes, whether its filter is made or not: 16 MiB
    /// are enough.
    const MOST: u64 = 1 << 20;

    /// An empty cell for each slot.
    pub(crate) fn of(geometry: &Geometry) -> Self {
        let slots: u64 = geometry.arenas.iter().map(|a| u64::from(a.len())).sum();
        if slots > Self::MOST {
            return Self::default();
        }
        let empty = |len: u32| (0..len).map(|_| OnceLock::new()).collect();
        Self(geometry.arenas.iter().map(|a| empty(a.len())).collect())
    }
}

impl Geometry {
    #[inline]
    fn drawn(&self, arena: u32, slot: u32) -> Option<&SlotFilter> {
        let outlines = self.outlines.get_or_init(|| Outlines::of(self));
        let place = outlines.0.get(arena as usize)?.get(slot as usize)?;
        Some(place.get_or_init(|| Box::new(self.arenas[arena as usize].drawn(slot))))
    }

    /// The packet filter of a slot.
    #[inline]
    pub(crate) fn seen_of(&self, arena: u32, slot: u32) -> &FilterKind {
        self.drawn(arena, slot).map_or(&FilterKind::Nothing, |drawn| &drawn.seen)
    }

    /// Whether no ray of a bundle hits a slot, by its box; `true` is certain.
    #[inline]
    pub(crate) fn slot_misses(&self, arena: u32, slot: u32, shaft: &Shaft) -> bool {
        self.drawn(arena, slot).is_some_and(|drawn| !shaft.may_meet(&drawn.bounds))
    }
}
