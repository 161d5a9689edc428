//! Eight numbers side by side: the same formula for eight rays at once.
//!
//! Plain arrays with plain loops. Inside [`Isa::run_in_lanes`](crate::Isa::run_in_lanes) the
//! compiler turns them into vector instructions, two registers with AVX2 and one with AVX-512; each
//! lane has the bits of the scalar operation everywhere.
//!
//! Each operation is a loop by itself (`lanes!`). The library's `array::from_fn` and `array::map`
//! are made of functions that the compiler leaves apart in large kernels, where they are compiled
//! for the basic CPU: a fused product is eight calls there.

use crate::{Scalar, Vec3};
use core::ops::{Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, Div, Mul, Neg, Not, Sub};
use core::sync::atomic::{Ordering, compiler_fence};

/// How many lanes there are.
pub const LANES: usize = 8;

/// Eight f64.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub struct F8(pub [f64; LANES]);

/// Eight answers to a yes-no question: all bits set for a yes, as vector instructions have it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(64))]
pub struct M8([u64; LANES]);

#[inline(always)]
fn all_bits(yes: bool) -> u64 {
    if yes { u64::MAX } else { 0 }
}

/// An array of what an expression is in each lane.
macro_rules! lanes {
    ($zero:expr, $i:ident => $each:expr) => {{
        let mut all = [$zero; LANES];
        let mut $i = 0;
        while $i < LANES {
            all[$i] = $each;
            $i += 1;
        }
        all
    }};
}

/// The numbers of the bits that are set, ascending.
#[inline(always)]
pub fn set_bits(mut bits: u8) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let i = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (i < LANES).then_some(i)
    })
}

impl F8 {
    /// Zero in every lane.
    pub const ZERO: Self = Self([0.0; LANES]);
    /// One in every lane.
    pub const ONE: Self = Self([1.0; LANES]);

    /// Every lane holds `x`.
    #[inline(always)]
    pub const fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// One packet for each number; every lane holds that number.
    #[inline(always)]
    pub const fn splats<const N: usize>(x: [f64; N]) -> [Self; N] {
        let mut all = [Self::ZERO; N];
        let mut k = 0;
        while k < N {
            all[k] = Self::splat(x[k]);
            k += 1;
        }
        all
    }

    /// Replaces the value by `x` in some lanes.
    ///
    /// Written so that the compiler does not emit a masked store, which is slow on some machines
    /// (docs/performance.md, "What helped", 6).
    #[inline(always)]
    pub fn set_where(&mut self, lanes: M8, x: Self) {
        let old = *self;
        compiler_fence(Ordering::AcqRel);
        *self = lanes.select(x, old);
    }

    /// A function of each lane.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(lanes!(0.0, i => f(self.0[i])))
    }

    /// `self * a + b`, rounded once.
    #[inline(always)]
    #[must_use]
    pub fn mul_add(self, a: Self, b: Self) -> Self {
        Self(lanes!(0.0, i => self.0[i].mul_add(a.0[i], b.0[i])))
    }

    /// The square root.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self(lanes!(0.0, i => self.0[i].sqrt()))
    }

    /// The absolute value.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self(lanes!(0.0, i => self.0[i].abs()))
    }

    /// The lesser number; `other` where one is not a number.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(lanes!(0.0, i => if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// The greater number; `other` where one is not a number.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(lanes!(0.0, i => if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// The magnitude of `self` with the sign of `sign`.
    #[inline(always)]
    #[must_use]
    pub fn copysign(self, sign: Self) -> Self {
        Self(lanes!(0.0, i => self.0[i].copysign(sign.0[i])))
    }

    /// Where `self < other`.
    #[inline(always)]
    pub fn lt(self, other: Self) -> M8 {
        M8(lanes!(0, i => all_bits(self.0[i] < other.0[i])))
    }

    /// Where `self <= other`.
    #[inline(always)]
    pub fn le(self, other: Self) -> M8 {
        M8(lanes!(0, i => all_bits(self.0[i] <= other.0[i])))
    }

    /// Where `self == other`.
    #[inline(always)]
    pub fn equals(self, other: Self) -> M8 {
        M8(lanes!(0, i => all_bits(self.0[i] == other.0[i])))
    }

    /// Where `self > other`.
    #[inline(always)]
    pub fn gt(self, other: Self) -> M8 {
        other.lt(self)
    }

    /// Where `self >= other`.
    #[inline(always)]
    pub fn ge(self, other: Self) -> M8 {
        other.le(self)
    }
}

impl M8 {
    /// No lane.
    pub const NONE: Self = Self([0; LANES]);
    /// Every lane.
    pub const ALL: Self = Self([u64::MAX; LANES]);

    /// The first `n` lanes.
    #[inline(always)]
    pub fn first(n: usize) -> Self {
        Self(lanes!(0, i => all_bits(i < n)))
    }

    /// Every lane holds `x`.
    #[inline(always)]
    pub const fn splat(x: bool) -> Self {
        if x { Self::ALL } else { Self::NONE }
    }

    /// An answer for each lane.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> bool) -> Self {
        Self(lanes!(0, i => all_bits(f(i))))
    }

    /// The answer of lane `i`.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> bool {
        self.0[i] != 0
    }

    /// Sets the answer of lane `i`.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, yes: bool) {
        self.0[i] = all_bits(yes);
    }

    /// `yes` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub fn select(self, yes: F8, no: F8) -> F8 {
        F8(lanes!(0.0, i => if self.0[i] != 0 { yes.0[i] } else { no.0[i] }))
    }

    /// `x` where the mask is set, zero elsewhere.
    #[inline(always)]
    pub fn keep(self, x: F8) -> F8 {
        F8(lanes!(0.0, i => f64::from_bits(x.0[i].to_bits() & self.0[i])))
    }

    /// As [`M8::select`], for vectors.
    #[inline(always)]
    pub fn select3(self, yes: Vec3<F8>, no: Vec3<F8>) -> Vec3<F8> {
        Vec3::new(self.select(yes.x, no.x), self.select(yes.y, no.y), self.select(yes.z, no.z))
    }

    /// Lane `i` as bit `i`.
    #[inline(always)]
    pub fn bits(self) -> u8 {
        crate::kernels::bits_of_masks(&self.0)
    }

    /// Bit `i` as lane `i`.
    #[inline(always)]
    pub fn from_bits(bits: u8) -> Self {
        Self(lanes!(0, i => all_bits(bits >> i & 1 == 1)))
    }

    /// Whether any lane is set.
    #[inline(always)]
    pub fn any(self) -> bool {
        let mut any = 0;
        for i in 0..LANES {
            any |= self.0[i];
        }
        any != 0
    }

    /// Whether every lane is set.
    #[inline(always)]
    pub fn all(self) -> bool {
        let mut all = u64::MAX;
        for i in 0..LANES {
            all &= self.0[i];
        }
        all != 0
    }

    /// The first lane that is set.
    #[inline(always)]
    pub fn first_set(self) -> Option<usize> {
        let bits = self.bits();
        (bits != 0).then(|| bits.trailing_zeros() as usize)
    }

    /// The lanes that are set, in order.
    #[inline(always)]
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        set_bits(self.bits())
    }

    /// How many lanes are set.
    #[inline(always)]
    pub fn count(self) -> usize {
        self.bits().count_ones() as usize
    }
}

impl Vec3<F8> {
    /// Every lane holds `v`.
    #[inline(always)]
    pub const fn splat(v: Vec3) -> Self {
        Self::new(F8::splat(v.x), F8::splat(v.y), F8::splat(v.z))
    }

    /// One packet for each vector; every lane holds that vector.
    #[inline(always)]
    pub const fn splats<const N: usize>(v: [Vec3; N]) -> [Self; N] {
        let mut all = [Self::splat(Vec3::ZERO); N];
        let mut k = 0;
        while k < N {
            all[k] = Self::splat(v[k]);
            k += 1;
        }
        all
    }

    /// The vector in lane `i`.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> Vec3 {
        Vec3::new(self.x.0[i], self.y.0[i], self.z.0[i])
    }

    /// [`F8::set_where`], for vectors.
    #[inline(always)]
    pub fn set_where(&mut self, lanes: M8, v: Self) {
        self.x.set_where(lanes, v.x);
        self.y.set_where(lanes, v.y);
        self.z.set_where(lanes, v.z);
    }

    /// Puts a vector into lane `i`.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, v: Vec3) {
        (self.x.0[i], self.y.0[i], self.z.0[i]) = (v.x, v.y, v.z);
    }
}

impl From<f64> for F8 {
    #[inline(always)]
    fn from(x: f64) -> Self {
        Self::splat(x)
    }
}

macro_rules! arithmetic {
    ($($trait:ident, $method:ident, $op:tt;)*) => {$(
        impl $trait for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Self(lanes!(0.0, i => self.0[i] $op o.0[i]))
            }
        }
        impl $trait<f64> for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: f64) -> Self {
                Self(lanes!(0.0, i => self.0[i] $op o))
            }
        }
    )*};
}
arithmetic! { Add, add, +; Sub, sub, -; Mul, mul, *; Div, div, /; }

impl AddAssign for F8 {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Neg for F8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(lanes!(0.0, i => -self.0[i]))
    }
}

macro_rules! logic {
    ($($trait:ident, $method:ident, $assign:ident, $assigns:ident, $op:tt;)*) => {$(
        impl $trait for M8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Self(lanes!(0, i => self.0[i] $op o.0[i]))
            }
        }
        impl $assign for M8 {
            #[inline(always)]
            fn $assigns(&mut self, o: Self) {
                *self = *self $op o;
            }
        }
    )*};
}
logic! { BitAnd, bitand, BitAndAssign, bitand_assign, &; BitOr, bitor, BitOrAssign, bitor_assign, |; }

impl Not for M8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(lanes!(0, i => !self.0[i]))
    }
}

impl Scalar for F8 {
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self::mul_add(self, a, b)
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        // Kahan's, as for f64.
        let cd = c * d;
        let lost = (-c).mul_add(d, cd);
        a.mul_add(b, -cd) + lost
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Isa;

    #[test]
    fn lanes_have_the_bits_of_the_scalar_operations() {
        let a = F8([1.5, -0.1, 3e300, 1e-310, 0.0, -0.0, f64::INFINITY, 7.0]);
        let b = F8([0.1, 0.3, -2e10, 3.0, -0.0, 5.0, 1.0, f64::NAN]);
        for isa in Isa::available() {
            let (sum, fused, least, kahan, root) = isa.run_in_lanes(
                #[inline(always)]
                || (a + b, a.mul_add(b, a), a.min(b), F8::difference_of_products(a, b, b, a), a.sqrt()),
            );
            for i in 0..LANES {
                let (x, y) = (a.0[i], b.0[i]);
                let same = |got: F8, want: f64| assert_eq!(got.0[i].to_bits(), want.to_bits(), "{isa:?} {i}");
                same(sum, x + y);
                same(least, if x < y { x } else { y });
                // The sign of a NaN means nothing.
                if !(x * y).is_nan() && (x * y).is_finite() && x >= 0.0 {
                    same(fused, x.mul_add(y, x));
                    same(kahan, crate::eft::difference_of_products(x, y, y, x));
                    same(root, x.sqrt());
                }
            }
        }
    }

    #[test]
    fn some_lanes_are_set_and_the_others_stay() {
        let before = F8([1.0, f64::NAN, -0.0, 4.0, 5.0, f64::INFINITY, 7.0, 8.0]);
        let x = F8([-1.0, 2.0, 0.0, f64::NAN, 1e-310, 6.0, -7.0, f64::NEG_INFINITY]);
        for isa in Isa::available() {
            for bits in 0..=u8::MAX {
                let mut after = Vec3::new(before, x, before);
                isa.run_in_lanes(
                    #[inline(always)]
                    || after.set_where(M8::from_bits(bits), Vec3::new(x, before, x)),
                );
                for i in 0..LANES {
                    let (kept, set) = (before.0[i].to_bits(), x.0[i].to_bits());
                    let want = if bits >> i & 1 == 1 { (set, kept, set) } else { (kept, set, kept) };
                    let got = after.lane(i);
                    assert_eq!(
                        (got.x.to_bits(), got.y.to_bits(), got.z.to_bits()),
                        want,
                        "{isa:?} {bits} {i}"
                    );
                }
            }
        }
    }

    #[test]
    fn comparisons_are_those_of_numbers() {
        let a = F8([1.0, 2.0, 3.0, f64::NAN, 0.0, -0.0, f64::INFINITY, -1.0]);
        let b = F8([2.0, 2.0, 2.0, 2.0, -0.0, 0.0, f64::INFINITY, f64::NAN]);
        assert_eq!([a.lt(b), a.le(b), a.equals(b)].map(M8::bits), [0b1, 0b111_0011, 0b111_0010]);
    }

    #[test]
    fn masks_and_bits_are_two_ways_to_say_the_same() {
        for bits in 0..=255_u8 {
            let mask = M8::from_bits(bits);
            assert_eq!((mask.bits(), mask.count()), (bits, bits.count_ones() as usize));
            assert!(
                mask.lanes().eq((0..LANES).filter(|&i| mask.lane(i)))
                    && mask.first_set() == mask.lanes().next()
            );
            assert_eq!((mask.any(), mask.all()), (bits != 0, bits == 255));
            let chosen = mask.select(F8::ONE, F8::ZERO);
            assert!((0..LANES).all(|i| (chosen.0[i] == 1.0) == mask.lane(i)));
            assert_eq!(chosen, mask.keep(F8::ONE));
        }
        assert_eq!([0, 3, 8].map(|n| M8::first(n).bits()), [0, 7, 255]);
    }
}
