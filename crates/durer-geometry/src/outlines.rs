//! The outlines of all slots, for small geometries.

use crate::Geometry;
use durer_math::{Aabb, Shaft};
use durer_surfaces::outline::Outline;

/// Outlines by arena and slot.
#[derive(Debug, Default)]
pub(crate) struct Outlines(Vec<Vec<Drawn>>);

/// A slot as lanes see it.
#[derive(Debug)]
pub(crate) struct Drawn {
    /// `None` if its numbers are too large or too small for that.
    pub(crate) outline: Option<Outline>,
    /// A box that holds the slot's surface or part.
    pub(crate) bounds: Aabb,
}

impl Outlines {
    /// An outline takes several times the memory of the surface it is made of, and takes microseconds to make. Where there are more slots than this, few rays side by
    /// side meet the same ones, so lanes would be empty anyway.
    const MOST: u64 = 1 << 14;

    pub(crate) fn of(geometry: &Geometry) -> Self {
        let slots: u64 = geometry.arenas.iter().map(|a| u64::from(a.len())).sum();
        if slots > Self::MOST {
            return Self::default();
        }
        Self(geometry.arenas.iter().map(|a| (0..a.len()).map(|slot| a.drawn(slot)).collect()).collect())
    }

    #[inline(always)]
    pub(crate) fn get(&self, arena: u32, slot: u32) -> Option<&Outline> {
        self.drawn(arena, slot)?.outline.as_ref()
    }

    #[inline(always)]
    fn drawn(&self, arena: u32, slot: u32) -> Option<&Drawn> {
        self.0.get(arena as usize)?.get(slot as usize)
    }

    /// Whether no ray of a bundle meets a slot, by its box: `true` is certain.
    #[inline]
    pub(crate) fn misses(&self, arena: u32, slot: u32, shaft: &Shaft) -> bool {
        self.drawn(arena, slot).is_some_and(|drawn| !shaft.may_meet(&drawn.bounds))
    }
}
