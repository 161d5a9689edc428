//! The tree's own coordinates, and boxes in them: f32, rounded outward.
//!
//! ```text
//!   tree = (caller - centre) 2^-exponent,      |tree| <= 1 on each axis
//! ```
//!
//! f32 has 24 bits, so boxes in the caller's coordinates would be useless far from the origin: at
//! 5e6, a UTM northing, f32 numbers are 0.5 apart. Let `H` be half the largest width of everything
//! in the tree, and `m` the middle along an axis. Where `|m| <= 4 H` the centre is 0: coordinates
//! are at most `5 H`, so f32 loses three bits at most, and nothing is subtracted. Elsewhere the
//! centre is `m`. A coordinate `x` of something in the tree is then within `H` of `m`, so `x / m`
//! is in `[3/4, 5/4]`, and the difference of two f64 numbers within a factor of two is exact (P. H.
//! Sterbenz, *Floating-point computation*, 1974). Boxes and corners lose nothing; only the origins
//! of rays may, and their rounding is added to the ray's error.

use crate::build::Extent;
use crate::ray::Ray64;
use durer_math::eft::{scale2, two_diff, two_sum};
use durer_math::scale::exponent;
use durer_math::{Aabb, Point3};

/// The exact map from the caller's coordinates to the tree's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    units: Units,
    centre: Point3,
    /// Whether the centre is not the origin.
    is_moved: bool,
}

/// The exact power of two that makes all coordinates of a tree at most 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Units {
    /// Lengths in tree units are `2^-exponent` times the caller's.
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

impl Units {
    /// The least exponent. Below it lengths are so small that a tree would need numbers below
    /// f32's. Such a tree holds everything near its centre, and every ray there meets every box.
    const LEAST: i32 = -900;

    /// The units in which lengths up to `size` are at most 1.
    fn of(size: f64) -> Self {
        // size < 2^(e + 1)
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
}

impl Frame {
    /// How many times half the largest width the middle may be from the origin before it becomes
    /// the centre.
    const NEAR: f64 = 4.0;

    /// The frame of a tree over everything in `bounds`, which should be bounded or empty.
    pub fn around(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self { units: Units::of(0.0), centre: Point3::ORIGIN, is_moved: false };
        }
        let half = 0.5 * bounds.widths().max_abs();
        let middle = bounds.centre();
        // False for NaN.
        let is_far = |m: f64| m.abs() > Self::NEAR * half && m.is_finite();
        let centre = middle.map(|m| if is_far(m) { m } else { 0.0 });
        let is_moved = centre != Point3::ORIGIN;
        let size = if is_moved {
            let corners = [bounds.min - centre, bounds.max - centre];
            // A tree without extent has the units of the numbers around it.
            let spacing = centre.to_vec().max_abs() * f64::EPSILON;
            corners[0].max_abs().max(corners[1].max_abs()).max(spacing)
        } else {
            bounds.magnitude().min(f64::MAX)
        };
        Self { units: Units::of(size), centre, is_moved }
    }

    /// The scale of lengths.
    #[inline(always)]
    pub(crate) fn units(self) -> Units {
        self.units
    }

    /// Whether the tree's origin is not the caller's.
    #[inline(always)]
    pub(crate) fn is_moved(self) -> bool {
        self.is_moved
    }

    /// The caller's coordinates of the tree's origin.
    pub(crate) fn centre(self) -> Point3 {
        self.centre
    }

    /// An upper bound on the caller's coordinates.
    #[inline(always)]
    pub(crate) fn size(self) -> f64 {
        self.units.outward(1.0) + self.centre.to_vec().max_abs()
    }

    /// The difference of a coordinate and the centre's, and its rounding error.
    #[inline(always)]
    pub(crate) fn difference(self, x: f64, axis: usize) -> (f64, f64) {
        // Also keeps infinities.
        if self.centre[axis] == 0.0 { (x, 0.0) } else { two_diff(x, self.centre[axis]) }
    }

    /// The ray with its origin relative to the centre.
    pub(crate) fn moved(self, ray: &Ray64) -> Ray64 {
        let (mut origin, mut error) = (ray.origin, ray.origin_error);
        for axis in 0..3 {
            let (o, lost) = self.difference(ray.origin[axis], axis);
            origin[axis] = o;
            if lost != 0.0 {
                error[axis] = (error[axis] + lost.abs()).next_up();
            }
        }
        Ray64 { origin, origin_error: error, ..*ray }
    }

    /// The least f64 interval around a coordinate, in tree units.
    #[inline(always)]
    pub(crate) fn interval(self, x: f64, axis: usize) -> (f64, f64) {
        let (from_centre, error) = self.difference(x, axis);
        let y = self.units.inward(from_centre);
        // Where scaling underflows, one more step outward makes up for the loss.
        let is_lost = y.abs() < f64::MIN_POSITIVE && from_centre != 0.0;
        let low = if is_lost || error < 0.0 { y.next_down() } else { y };
        let high = if is_lost || error > 0.0 { y.next_up() } else { y };
        (low, high)
    }

    /// The entry of object `index` of its `kind`, with its box rounded outward. An unbounded box,
    /// or one with a NaN, gives an entry that is not [bounded](Entry::is_bounded).
    pub fn entry(self, bounds: &Aabb, kind: u32, index: u32) -> Entry {
        let a = core::array::from_fn(|i| down32(self.interval(bounds.min[i], i).0));
        let b = core::array::from_fn(|i| up32(self.interval(bounds.max[i], i).1));
        Entry::new(a, kind, b, index)
    }

    /// Converts a box in tree units to the caller's coordinates, rounded outward.
    pub(crate) fn bounds(self, lo: [f32; 3], hi: [f32; 3]) -> Aabb {
        let place = |x: f32, axis: usize| {
            let y = self.units.outward(f64::from(x));
            if self.centre[axis] == 0.0 { (y, 0.0) } else { two_sum(y, self.centre[axis]) }
        };
        let low = |axis: usize| match place(lo[axis], axis) {
            (x, error) if error < 0.0 => x.next_down(),
            (x, _) => x,
        };
        let high = |axis: usize| match place(hi[axis], axis) {
            (x, error) if error > 0.0 => x.next_up(),
            (x, _) => x,
        };
        Aabb::new(Point3::new(low(0), low(1), low(2)), Point3::new(high(0), high(1), high(2)))
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

    proptest! {
        /// Far from the origin boxes are as narrow as near it, and nothing is lost.
        #[test]
        fn boxes_far_from_the_origin_are_narrow(
            place in prop::array::uniform3((-1.0..1.0, 0..60_i32)),
            a in prop::array::uniform3(-1.0..1.0_f64),
            b in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let place: Point3 = Point3::from(place.map(|(x, e): (f64, i32)| x * durer_math::scale::pow2(e)));
            let corner = |v: [f64; 3]| Point3::new(place.x + v[0], place.y + v[1], place.z + v[2]);
            let bounds = Aabb::from_points([corner(a), corner(b)]);
            let frame = Frame::around(&bounds);
            let entry = frame.entry(&bounds, 0, 0);
            prop_assert!(entry.lo().iter().chain(&entry.hi()).all(|x| x.abs() <= 1.0));
            let back = frame.bounds(entry.lo(), entry.hi());
            prop_assert!(back.encloses(&bounds));
            // Two roundings to f32 of coordinates up to five times half the largest width, in units
            // of the next power of two, and one to f64 of the caller's coordinates.
            let slack = 10.0 * bounds.widths().max_abs() * 2.0_f64.next_up() / (1 << 24) as f64;
            for i in 0..3 {
                let ulp = place[i].abs() * 4.0 * f64::EPSILON;
                prop_assert!(back.max[i] - bounds.max[i] <= slack + ulp && bounds.min[i] - back.min[i] <= slack + ulp);
                for x in [bounds.min[i], bounds.max[i]] {
                    prop_assert_eq!(frame.difference(x, i).1, 0.0);
                }
            }
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
