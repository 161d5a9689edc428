//! Boxes while building.

use crate::frame::Entry;

/// A box in tree units, empty to begin with: the low corner, negated, and the high one, so that it
/// grows by eight maxima at once.
///
/// Lanes 3 and 7 mean nothing.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Extent(pub(crate) [f32; 8]);

impl Extent {
    pub(crate) const EMPTY: Self = Self([f32::NEG_INFINITY; 8]);

    #[inline(always)]
    pub(crate) fn of(entry: &Entry) -> Self {
        Self(entry.reach())
    }

    /// A box between two corners.
    pub(crate) fn between((lo, hi): ([f32; 3], [f32; 3])) -> Self {
        Self([0.0 - lo[0], 0.0 - lo[1], 0.0 - lo[2], 0.0, hi[0], hi[1], hi[2], 0.0])
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, entry: &Entry) {
        self.unite(&Self::of(entry));
    }

    #[inline(always)]
    pub(crate) fn unite(&mut self, b: &Self) {
        for i in 0..8 {
            self.0[i] = if b.0[i] > self.0[i] { b.0[i] } else { self.0[i] };
        }
    }

    #[inline(always)]
    pub(crate) fn united(mut self, b: &Self) -> Self {
        self.unite(b);
        self
    }

    /// A point.
    #[inline(always)]
    pub(crate) fn at(p: &[f32; 3]) -> Self {
        Self([-p[0], -p[1], -p[2], 0.0, p[0], p[1], p[2], 0.0])
    }

    /// Whether there is no point in it.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        let gap = |i: usize| self.0[i] + self.0[4 + i] < 0.0;
        gap(0) | gap(1) | gap(2)
    }

    /// What is in both.
    #[inline(always)]
    pub(crate) fn common(mut self, b: &Self) -> Self {
        for i in 0..8 {
            self.0[i] = if b.0[i] < self.0[i] { b.0[i] } else { self.0[i] };
        }
        self
    }

    #[inline(always)]
    pub(crate) fn lo(&self) -> [f32; 3] {
        [0.0 - self.0[0], 0.0 - self.0[1], 0.0 - self.0[2]]
    }

    #[inline(always)]
    pub(crate) fn hi(&self) -> [f32; 3] {
        [self.0[4], self.0[5], self.0[6]]
    }

    /// Half the surface; zero if empty.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let mut widths = [0.0; 4];
        for (i, width) in widths.iter_mut().enumerate() {
            let w = self.0[4 + i] + self.0[i];
            *width = if w > 0.0 { w } else { 0.0 };
        }
        widths[0] * widths[1] + widths[1] * widths[2] + widths[2] * widths[0]
    }
}
