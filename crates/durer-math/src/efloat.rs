//! Running error: a number together with a proven bound on its error.
//!
//! Each operation rounds once and charges that rounding, and what it does to the errors it was
//! given, to `e`. The result is nearly as tight as interval arithmetic at half its cost, and the
//! value is exactly the one that the plain formula gives. N. J. Higham, "Accuracy and Stability of
//! Numerical Algorithms", 2nd ed., SIAM (2002), section 3.3; J. H. Wilkinson, "Error analysis
//! revisited", IMA Bulletin 22 (1986).
//!
//! **Why the bound is a true bound although it is itself rounded.** With `u = 2^-53`, an addition
//! needs `a.e + b.e + u|s|`; it is computed as `fma(K, a.e + b.e, u'|s|)` with `K = 1 + 16u`,
//! `u' = u(1 + 32u)`, whose two roundings lose at most a factor `(1-u)^2`. A product needs
//! `|a| b.e + a.e (|b| + b.e) + u|p| + 2^-1075`; it is computed with one sum, three fused
//! operations and a final product by `K`, which lose at most `(1-u)^5`, and, where they are
//! subnormal, `2^-1075` each, for which `FLOOR` pays. Additions are exact in the subnormal range
//! and need no floor. A factor that is exactly zero gives exactly zero. For `T = Dd` the part `hi`
//! stands for the number, which costs another `(1+u)^2`, again within `K`.
//!
//! Overflow turns `v` or `e` into an infinity or NaN; then no sign is certain and the enclosure is
//! the whole line.

use crate::rounding::{add_down, add_up, sub_down};
use crate::scale::ldexp;
use crate::{Dd, Ring};
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Covers the roundings made while a bound is computed; see the module's text.
const K: f64 = 1.0 + 8.0 * f64::EPSILON;
/// Covers what subnormal results lose, at most a few times `2^-1074`. Far more than needed, so that
/// it and its multiples are normal numbers: a subnormal operand or result costs a microcode assist
/// on many CPUs, a hundred times the operation itself. It is felt only where numbers are below
/// `2^-890`.
const FLOOR: f64 = crate::scale::pow2(-1000);
/// The floor for [`Ring::scale2`], which is rarely used and must be tight: maps of size `1e300`
/// have inverses near `2^-1000`.
const SCALE_FLOOR: f64 = f64::from_bits(16);

/// A number `v` that differs from the true one by at most `e`. `T` is f64 or [`Dd`].
///
/// ```
/// use durer_math::{Ring, EFloat};
/// let third = EFloat::<f64>::exact(1.0) / EFloat::exact(3.0);
/// let sum = third + third + third;
/// assert!(sum.lo() <= 1.0 && 1.0 <= sum.hi());
/// assert_eq!((sum - EFloat::exact(1.0)).sign(), None); // cannot tell
/// assert_eq!((sum - EFloat::exact(0.999)).sign(), Some(core::cmp::Ordering::Greater));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EFloat<T = f64> {
    /// The computed value.
    pub v: T,
    /// The bound on its error; infinite or NaN if nothing is known.
    pub e: f64,
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for crate::Dd {}
}

/// The number types that [`EFloat`] may hold: f64 or [`Dd`].
pub trait Word:
    sealed::Sealed
    + Copy
    + core::fmt::Debug
    + PartialEq
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Bound on the relative error of a sum, as a multiple of the computed sum, and a little more.
    const ADD: f64;
    /// Relative rounding error of a product.
    const MUL: f64;
    /// Relative rounding error of a quotient or a square root.
    const DIV: f64;
    /// Absolute error which underflow may put into the residual of a quotient or root.
    const RESIDUAL: f64;
    /// The nearest f64.
    fn to_f64(self) -> f64;
    /// The square root.
    fn root(self) -> Self;
    /// Times `2^k`.
    fn times_pow2(self, k: i32) -> Self;
    /// An f64 not above `self - e`, and one not below `self + e`.
    fn enclose(self, e: f64) -> (f64, f64);
}

impl Word for f64 {
    const ADD: f64 = crate::U * (1.0 + 16.0 * f64::EPSILON);
    const MUL: f64 = Self::ADD;
    const DIV: f64 = Self::ADD;
    const RESIDUAL: f64 = 0.0;
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn times_pow2(self, k: i32) -> Self {
        ldexp(self, k)
    }
    #[inline(always)]
    fn enclose(self, e: f64) -> (f64, f64) {
        (sub_down(self, e), add_up(self, e))
    }
}

impl Word for Dd {
    // 3 u^2 + 13 u^3, 4 u^2, 15 u^2 + 56 u^3 (see `dd`), relative to the exact results.
    const ADD: f64 = 3.0 * crate::U * crate::U * (1.0 + 16.0 * f64::EPSILON);
    const MUL: f64 = 4.0 * crate::U * crate::U * (1.0 + 16.0 * f64::EPSILON);
    const DIV: f64 = 15.0 * crate::U * crate::U * (1.0 + 16.0 * f64::EPSILON);
    const RESIDUAL: f64 = FLOOR;
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.hi
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn times_pow2(self, k: i32) -> Self {
        self.scale2(k)
    }
    #[inline(always)]
    fn enclose(self, e: f64) -> (f64, f64) {
        (add_down(self.hi, sub_down(self.lo, e)), add_up(self.hi, add_up(self.lo, e)))
    }
}

impl<T: Word> EFloat<T> {
    /// Zero, exactly.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { v: T::from(0.0), e: 0.0 }
    }

    /// The number `x` with an error of at most `e`.
    #[inline(always)]
    pub fn with_error(x: T, e: f64) -> Self {
        Self { v: x, e }
    }

    /// The value, rounded to f64.
    #[inline(always)]
    pub fn value(self) -> f64 {
        self.v.to_f64()
    }

    /// An f64 not above the true number; `-inf` if nothing is known.
    #[inline(always)]
    pub fn lo(self) -> f64 {
        let lo = self.v.enclose(self.e).0;
        if lo.is_nan() { f64::NEG_INFINITY } else { lo }
    }

    /// An f64 not below the true number; `inf` if nothing is known.
    #[inline(always)]
    pub fn hi(self) -> f64 {
        let hi = self.v.enclose(self.e).1;
        if hi.is_nan() { f64::INFINITY } else { hi }
    }

    /// An upper bound of the absolute value of the true number.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        let m = (self.v.to_f64().abs() + self.e) * K;
        if m.is_nan() { f64::INFINITY } else { m }
    }

    /// The absolute value; the bound stays.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        if self.v.to_f64() < 0.0 { -self } else { self }
    }

    /// The square root of the true number's non-negative part.
    ///
    /// A number that is certainly negative has none: NaN, with an infinite bound.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        let x = self.v.to_f64();
        // |sqrt(x + d) - sqrt(x)| is greatest for d = -e: e / (sqrt(x) + sqrt(x - e)).
        // For Dd, hi + lo >= hi (1 - u).
        let low = x.mul_add(2.0 - K, -self.e) * (2.0 - K);
        if low > 0.0 {
            let v = self.v.root();
            let s = v.to_f64();
            let e = (self.e + T::RESIDUAL) / (s + low.sqrt());
            return Self { v, e: T::DIV.mul_add(s, e) * K + T::RESIDUAL };
        }
        self.sqrt_near_zero()
    }

    #[cold]
    fn sqrt_near_zero(self) -> Self {
        let top = self.hi();
        if top < 0.0 || self.v.to_f64().is_nan() {
            return Self { v: T::from(f64::NAN), e: f64::INFINITY };
        }
        if top == 0.0 {
            return Self::zero();
        }
        // Anything in [0, sqrt(top)].
        let half = 0.5 * top.sqrt() * K + FLOOR;
        Self { v: T::from(half), e: half }
    }
}

impl<T: Word> Neg for EFloat<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { v: -self.v, e: self.e }
    }
}

impl<T: Word> Add for EFloat<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let v = self.v + b.v;
        Self { v, e: K.mul_add(self.e + b.e, T::ADD * v.to_f64().abs()) }
    }
}

impl<T: Word> Sub for EFloat<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        let v = self.v - b.v;
        Self { v, e: K.mul_add(self.e + b.e, T::ADD * v.to_f64().abs()) }
    }
}

impl<T: Word> Mul for EFloat<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let v = self.v * b.v;
        let (a_abs, b_abs) = (self.v.to_f64().abs(), b.v.to_f64().abs());
        let p = v.to_f64().abs();
        if p == 0.0 && (a_abs + self.e == 0.0 || b_abs + b.e == 0.0) {
            return Self { v, e: 0.0 };
        }
        let e = T::MUL.mul_add(p, FLOOR);
        let e = self.e.mul_add(b_abs + b.e, e);
        Self { v, e: a_abs.mul_add(b.e, e) * K }
    }
}

impl<T: Word> Div for EFloat<T> {
    type Output = Self;
    /// A divisor that may be zero gives an infinite bound.
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let v = self.v / b.v;
        let (q, b_abs) = (v.to_f64().abs(), b.v.to_f64().abs());
        // For Dd, |hi + lo| >= |hi| (1 - u).
        let least = b_abs.mul_add(2.0 - K, -b.e) * (2.0 - K);
        if least <= 0.0 || least.is_nan() {
            return Self { v, e: f64::INFINITY };
        }
        if self.v.to_f64() == 0.0 && self.e == 0.0 {
            return Self { v, e: 0.0 };
        }
        // |(a + da)/(b + db) - a/b| = |da - (a/b) db| / |b + db|.
        // The product `q b.e` may underflow before it is divided by a tiny divisor.
        let floor = if b.e == 0.0 { T::RESIDUAL } else { FLOOR };
        let e = q.mul_add(b.e, self.e + floor);
        Self { v, e: T::DIV.mul_add(q, e / least) * K + FLOOR }
    }
}

impl<T: Word> Ring for EFloat<T> {
    #[inline(always)]
    fn exact(x: f64) -> Self {
        Self { v: T::from(x), e: 0.0 }
    }

    #[inline(always)]
    fn within(x: f64, error: f64) -> Option<Self> {
        Some(Self { v: T::from(x), e: error })
    }

    #[inline(always)]
    fn scale2(self, exponent: i32) -> Self {
        let v = self.v.times_pow2(exponent);
        let exact = v.times_pow2(-exponent) == self.v;
        let e = ldexp(self.e, exponent);
        let e_exact = ldexp(e, -exponent) == self.e;
        let overflow = v.to_f64().abs() == f64::INFINITY;
        let floor = if overflow { f64::INFINITY } else { SCALE_FLOOR };
        Self { v, e: if exact & e_exact { e } else { (e + floor) * K } }
    }

    #[inline(always)]
    fn sign(&self) -> Option<Ordering> {
        let x = self.v.to_f64();
        // For Dd, |hi + lo| >= |hi|(1 - u).
        if x.abs() * (2.0 - K) > self.e {
            return Some(if x > 0.0 { Ordering::Greater } else { Ordering::Less });
        }
        (x == 0.0 && self.e == 0.0).then_some(Ordering::Equal)
    }

    #[inline(always)]
    fn square(self) -> Self {
        let v = self.v * self.v;
        let (a, p) = (self.v.to_f64().abs(), v.to_f64().abs());
        if p == 0.0 && a + self.e == 0.0 {
            return Self { v, e: 0.0 };
        }
        let e = T::MUL.mul_add(p, FLOOR);
        Self { v, e: self.e.mul_add(2.0 * a + self.e, e) * K }
    }
}
