//! Boxes while building.

use crate::frame::Entry;

/// A box in tree units, empty to begin with; four lanes, so that it grows by vector minima and maxima.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    lo: [f32; 4],
    hi: [f32; 4],
}

impl Extent {
    pub(crate) const EMPTY: Self = Self { lo: [f32::INFINITY; 4], hi: [f32::NEG_INFINITY; 4] };

    #[inline(always)]
    pub(crate) fn grow(&mut self, lo: [f32; 3], hi: [f32; 3]) {
        self.unite(&Self { lo: [lo[0], lo[1], lo[2], 0.0], hi: [hi[0], hi[1], hi[2], 0.0] });
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, entry: &Entry) {
        self.grow(entry.lo, entry.hi);
    }

    #[inline(always)]
    pub(crate) fn unite(&mut self, b: &Self) {
        for i in 0..4 {
            self.lo[i] = if b.lo[i] < self.lo[i] { b.lo[i] } else { self.lo[i] };
            self.hi[i] = if b.hi[i] > self.hi[i] { b.hi[i] } else { self.hi[i] };
        }
    }

    pub(crate) fn united(mut self, b: &Self) -> Self {
        self.unite(b);
        self
    }

    pub(crate) fn lo(&self) -> [f32; 3] {
        [self.lo[0], self.lo[1], self.lo[2]]
    }

    pub(crate) fn hi(&self) -> [f32; 3] {
        [self.hi[0], self.hi[1], self.hi[2]]
    }

    /// Half the surface; zero if empty.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let w = |i: usize| (self.hi[i] - self.lo[i]).max(0.0);
        let (x, y, z) = (w(0), w(1), w(2));
        x * y + y * z + z * x
    }
}
