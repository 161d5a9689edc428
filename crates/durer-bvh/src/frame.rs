//! The tree's own units, and boxes in them: f32, rounded outward.

use crate::build::Extent;
use durer_math::eft::scale2;
use durer_math::scale::exponent;
use durer_math::{Aabb, Point3};

/// The exact power of two that makes all coordinates of a tree at most 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Tree coordinates are `2^-exponent` times the caller's.
    exponent: i32,
}

/// A box for the builder, in tree units, with the kind and the index of its object. 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Entry {
    /// The low corner, negated, so that boxes grow by maxima alone; the kind; the high corner; the
    /// index. Coordinates are the bits of f32.
    pub(crate) words: [u32; 8],
}

impl Frame {
    /// The least exponent. Below it lengths are so small that a tree would need numbers below
    /// f32's. Such a tree holds everything near its centre, and every ray there meets every box.
    const LEAST: i32 = -900;

    /// The units for a tree over everything in `bounds`, which should be bounded or empty.
    pub fn around(bounds: &Aabb) -> Self {
        let size = if bounds.is_empty() { 0.0 } else { bounds.magnitude().min(f64::MAX) };
        // magnitude < 2^(e + 1)
        let exponent = if size > 0.0 { exponent(size) + 1 } else { 0 };
        Self { exponent: exponent.max(Self::LEAST) }
    }

    /// Converts a length of the caller's to tree units; exact unless it underflows (or is far
    /// outside the tree and overflows).
    #[inline(always)]
    pub(crate) fn inward(self, x: f64) -> f64 {
        scale2(x, -self.exponent)
    }

    /// Converts a length in tree units to the caller's units.
    #[inline(always)]
    pub(crate) fn outward(self, x: f64) -> f64 {
        scale2(x, self.exponent)
    }

    /// Lengths in tree units times two to this power are the caller's.
    pub(crate) fn outward_exponent(self) -> i32 {
        self.exponent
    }

    /// The entry of object `index` of its `kind`, with its box rounded outward. An unbounded box,
    /// or one with a NaN, gives an entry that is not [bounded](Entry::is_bounded).
    pub fn entry(self, bounds: &Aabb, kind: u32, index: u32) -> Entry {
        // Where scaling underflows, one more step outward makes up for the loss.
        let lost = |x: f64, y: f64| y.abs() < f64::MIN_POSITIVE && x != 0.0;
        let low = |x: f64, y: f64| down32(if lost(x, y) { y.next_down() } else { y });
        let high = |x: f64, y: f64| up32(if lost(x, y) { y.next_up() } else { y });
        let a = bounds.min.map(|x| low(x, self.inward(x))).to_array();
        let b = bounds.max.map(|x| high(x, self.inward(x))).to_array();
        Entry::new(a, kind, b, index)
    }

    /// Converts a box in tree units to the caller's units.
    pub(crate) fn bounds(self, lo: [f32; 3], hi: [f32; 3]) -> Aabb {
        let point = |c: [f32; 3]| Point3::from(c.map(|x| self.outward(f64::from(x))));
        Aabb::new(point(lo), point(hi))
    }
}

impl Entry {
    #[inline(always)]
    fn new(lo: [f32; 3], kind: u32, hi: [f32; 3], index: u32) -> Self {
        // Zeros are positive, so that no maximum depends on the order.
        let low = |i: usize| (0.0 - lo[i]).to_bits();
        let high = |i: usize| (hi[i] + 0.0).to_bits();
        Self { words: [low(0), low(1), low(2), kind, high(0), high(1), high(2), index] }
    }

    /// The kind of its object.
    #[inline]
    pub fn kind(&self) -> u32 {
        self.words[3]
    }

    /// The index of its object within the kind.
    #[inline]
    pub fn index(&self) -> u32 {
        self.words[7]
    }

    /// The low corner, negated, and the high one; lanes 3 and 7 are zero.
    #[inline(always)]
    pub(crate) fn reach(&self) -> [f32; 8] {
        let at = |i: usize| f32::from_bits(self.words[i]);
        [at(0), at(1), at(2), 0.0, at(4), at(5), at(6), 0.0]
    }

    #[inline(always)]
    pub(crate) fn lo(&self) -> [f32; 3] {
        let [x, y, z, ..] = self.reach();
        [0.0 - x, 0.0 - y, 0.0 - z]
    }

    #[inline(always)]
    pub(crate) fn hi(&self) -> [f32; 3] {
        let [.., x, y, z, _] = self.reach();
        [x, y, z]
    }

    /// Whether a tree can hold it.
    #[inline]
    pub fn is_bounded(&self) -> bool {
        let (lo, hi) = (self.lo(), self.hi());
        (0..3).all(|i| lo[i] <= hi[i] && lo[i] > f32::NEG_INFINITY && hi[i] < f32::INFINITY)
    }

    /// Whether the box has no point, so that no ray can meet it. A NaN is not empty, but unknown.
    #[inline]
    pub fn is_empty(&self) -> bool {
        let (lo, hi) = (self.lo(), self.hi());
        (0..3).any(|i| lo[i] > hi[i]) && lo.iter().chain(&hi).all(|x| !x.is_nan())
    }

    /// An entry with this box, in tree units.
    pub(crate) fn of_extent(extent: &Extent, kind: u32, index: u32) -> Self {
        Self::new(extent.lo(), kind, extent.hi(), index)
    }

    /// The same object, or a part of it, with another box.
    pub(crate) fn with_extent(&self, extent: &Extent) -> Self {
        Self::of_extent(extent, self.kind(), self.index())
    }

    /// Twice the centre along an axis.
    #[inline(always)]
    pub(crate) fn centre2(&self, axis: usize) -> f32 {
        f32::from_bits(self.words[4 + axis]) - f32::from_bits(self.words[axis])
    }
}

/// The greatest f32 that is not above `x`.
#[inline(always)]
pub(crate) fn down32(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// The least f32 that is not below `x`.
#[inline(always)]
pub(crate) fn up32(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn boxes_are_rounded_outward(a in any::<[f64; 3]>(), b in any::<[f64; 3]>()) {
            let bounds = Aabb::from_points([Point3::from(a), Point3::from(b)]);
            prop_assume!(bounds.is_bounded());
            let frame = Frame::around(&bounds);
            let entry = frame.entry(&bounds, 0, 0);
            prop_assert!(entry.is_bounded() && !entry.is_empty());
            prop_assert!(entry.lo().iter().chain(&entry.hi()).all(|x| x.abs() <= 1.0));
            prop_assert!(frame.bounds(entry.lo(), entry.hi()).encloses(&bounds));
        }
    }

    #[test]
    fn what_is_unbounded_or_unknown_is_not_empty() {
        let frame = Frame::around(&Aabb::UNBOUNDED);
        let entry = |b: &Aabb| frame.entry(b, 0, 0);
        assert!(!entry(&Aabb::UNBOUNDED).is_bounded() && !entry(&Aabb::UNBOUNDED).is_empty());
        assert!(!entry(&Aabb::EMPTY).is_bounded() && entry(&Aabb::EMPTY).is_empty());
        let unknown = Aabb::new(Point3::new(f64::NAN, 0.0, 0.0), Point3::ORIGIN);
        assert!(!entry(&unknown).is_bounded() && !entry(&unknown).is_empty());
    }

    #[test]
    fn rounding_to_f32_is_directed() {
        assert_eq!((down32(0.1), up32(0.1)), (0.1_f32.next_down(), 0.1));
        assert_eq!((down32(-0.1), up32(-0.1)), (-0.1, (-0.1_f32).next_up()));
        assert_eq!((down32(1e300), up32(-1e300)), (f32::MAX, f32::MIN));
        assert_eq!((up32(1e-60), down32(-1e-60)), (f32::from_bits(1), -f32::from_bits(1)));
    }
}
