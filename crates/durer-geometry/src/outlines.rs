//! The outlines of all slots, for small geometries.

use crate::Geometry;
use durer_surfaces::outline::Outline;

/// Outlines by arena and slot.
#[derive(Debug, Default)]
pub(crate) struct Outlines(Vec<Vec<Option<Outline>>>);

impl Outlines {
    /// An outline takes several times the memory of the surface it is made of, and takes microseconds to make. Where there are more slots than this, few rays side by
    /// side meet the same ones, so lanes would be empty anyway.
    const MOST: u64 = 1 << 14;

    pub(crate) fn of(geometry: &Geometry) -> Self {
        let slots: u64 = geometry.arenas.iter().map(|a| u64::from(a.len())).sum();
        if slots > Self::MOST {
            return Self::default();
        }
        Self(geometry.arenas.iter().map(|a| (0..a.len()).map(|slot| a.outline(slot)).collect()).collect())
    }

    #[inline(always)]
    pub(crate) fn get(&self, arena: u32, slot: u32) -> Option<&Outline> {
        self.0.get(arena as usize)?.get(slot as usize)?.as_ref()
    }
}
