//! Bins: where entries are sorted to, along three axes at once.

use super::area::Extent;
use crate::frame::Entry;
use core::ops::Range;

/// Bins per axis.
pub(crate) const BINS: usize = 16;

/// How twice-centres map to bins: `(x - from) scale` is in `[0, 16)`, and half less is rounded to
/// the nearest integer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    /// The last lanes are zero.
    pub(crate) from: [f32; 4],
    pub(crate) scale: [f32; 4],
}

/// A little less than the number of bins: three roundings by half an ulp do not lead out of the
/// last one.
const REACH: f32 = BINS as f32 * (1.0 - 1.0 / (1 << 20) as f32);

/// Added to a small number it leaves its nearest integer in the lowest bits, which a conversion
/// takes more steps to find.
pub(crate) const INTEGERS: f32 = 1.5 * (1 << 23) as f32;

impl Bins {
    /// Bins between the least and the greatest of all twice-centres.
    pub(crate) fn over(centres: &Extent) -> Self {
        let (lo, hi) = (centres.lo(), centres.hi());
        let mut bins = Self { from: [0.0; 4], scale: [0.0; 4] };
        for i in 0..3 {
            let scale = REACH / (hi[i] - lo[i]);
            (bins.from[i], bins.scale[i]) = (lo[i], if scale.is_finite() { scale } else { 0.0 });
        }
        bins
    }

    /// The bin of an entry along an axis.
    #[inline(always)]
    pub(crate) fn of(&self, entry: &Entry, axis: usize) -> u32 {
        let x = (entry.centre2(axis) - self.from[axis]) * self.scale[axis] - 0.5;
        (x + INTEGERS).to_bits() & (BINS as u32 - 1)
    }
}

/// What is in the bins of each axis.
#[derive(Debug)]
pub(crate) struct Filled {
    pub(crate) extents: [[Extent; BINS]; 3],
    pub(crate) counts: [[u32; BINS]; 3],
}

impl Filled {
    pub(crate) const EMPTY: Self = Self { extents: [[Extent::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] };

    pub(super) fn joined(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.extents[axis][bin].unite(&other.extents[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// All of some bins.
    pub(super) fn all(&self, axis: usize, bins: Range<usize>) -> (Extent, usize) {
        let extent = self.extents[axis][bins.clone()].iter().fold(Extent::EMPTY, Extent::united);
        (extent, self.counts[axis][bins].iter().sum::<u32>() as usize)
    }
}
