//! Intervals of f64 with outward rounding.
//!
//! R. E. Moore, "Interval Analysis", Prentice-Hall (1966); the treatment of undefined parts follows
//! IEEE 1788-2015's set-based flavour. Each end is the tightest f64 that bounds the exact result
//! (see [`rounding`](crate::rounding)).

pub mod elementary;

use crate::Scalar;
use crate::rounding::{
    add_down, add_up, div_down, div_up, mul_down, mul_up, sqrt_down, sqrt_up, sub_down, sub_up,
};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The closed interval `[lo, hi]`; ends may be infinite. The empty interval is `[NaN, NaN]` and
/// spreads.
///
/// ```
/// use durer_math::Interval;
/// let tenth = Interval::from(1.0) / Interval::from(10.0);
/// assert!(tenth.lo < 0.1 && tenth.hi == 0.1); // the f64 0.1 lies just above 1/10
/// assert!((Interval::new(-1.0, 2.0) * Interval::new(3.0, 4.0)) == Interval::new(-4.0, 8.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    /// The least number.
    pub lo: f64,
    /// The greatest number.
    pub hi: f64,
}

/// A product that takes `0 * inf` as 0: an infinite end is never reached.
#[inline(always)]
fn times(a: f64, b: f64, round: impl Fn(f64, f64) -> f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { round(a, b) }
}

impl Interval {
    /// No number.
    pub const EMPTY: Self = Self { lo: f64::NAN, hi: f64::NAN };
    /// All numbers.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// From `lo` to `hi`; `lo <= hi` is the caller's promise.
    #[inline(always)]
    pub const fn new(lo: f64, hi: f64) -> Self {
        Self { lo, hi }
    }

    /// All numbers within `radius` of `centre`.
    #[inline(always)]
    pub fn around(centre: f64, radius: f64) -> Self {
        Self { lo: sub_down(centre, radius), hi: add_up(centre, radius) }
    }

    /// Whether there is no number in it.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.lo.is_nan() || self.hi.is_nan()
    }

    /// Whether `x` lies in it.
    #[inline(always)]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether all of `other` lies in it.
    #[inline(always)]
    pub fn encloses(self, other: Self) -> bool {
        other.is_empty() || (self.lo <= other.lo && other.hi <= self.hi)
    }

    /// The numbers in both, if any.
    #[inline(always)]
    pub fn intersection(self, other: Self) -> Option<Self> {
        let lo = if self.lo > other.lo { self.lo } else { other.lo };
        let hi = if self.hi < other.hi { self.hi } else { other.hi };
        let empty = self.is_empty() || other.is_empty();
        (lo <= hi && !empty).then_some(Self { lo, hi })
    }

    /// The least interval that holds both.
    #[inline(always)]
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        // `f64::min` prefers the number to the NaN of an empty interval.
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Its width, rounded up.
    #[inline(always)]
    pub fn width(self) -> f64 {
        sub_up(self.hi, self.lo)
    }

    /// A number near the middle, in the interval.
    #[inline(always)]
    pub fn mid(self) -> f64 {
        if self.lo == f64::NEG_INFINITY && self.hi == f64::INFINITY {
            return 0.0;
        }
        let m = 0.5 * self.lo + 0.5 * self.hi;
        // Halving a subnormal rounds.
        m.clamp_to(self.lo, self.hi)
    }

    /// The largest absolute value in it.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The interval of the lesser of two numbers.
    #[inline(always)]
    #[must_use]
    pub fn min(self, b: Self) -> Self {
        if self.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        Self { lo: self.lo.min(b.lo), hi: self.hi.min(b.hi) }
    }

    /// The interval of the greater of two numbers.
    #[inline(always)]
    #[must_use]
    pub fn max(self, b: Self) -> Self {
        if self.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        Self { lo: self.lo.max(b.lo), hi: self.hi.max(b.hi) }
    }

    /// The interval of absolute values.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else if self.is_empty() {
            Self::EMPTY
        } else {
            Self { lo: 0.0, hi: self.magnitude() }
        }
    }

    /// The interval of squares; tighter than `self * self`.
    #[inline(always)]
    #[must_use]
    pub fn square(self) -> Self {
        let a = self.abs();
        Self { lo: times(a.lo, a.lo, mul_down), hi: times(a.hi, a.hi, mul_up) }
    }

    /// The square roots of its non-negative numbers; empty if there are none.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.hi >= 0.0 {
            let lo = if self.lo > 0.0 { sqrt_down(self.lo) } else { 0.0 };
            Self { lo, hi: sqrt_up(self.hi) }
        } else {
            Self::EMPTY
        }
    }
}

trait ClampTo {
    fn clamp_to(self, lo: f64, hi: f64) -> f64;
}

impl ClampTo for f64 {
    /// As `clamp`, which panics for NaN.
    #[inline(always)]
    fn clamp_to(self, lo: f64, hi: f64) -> f64 {
        if self < lo {
            lo
        } else if self > hi {
            hi
        } else {
            self
        }
    }
}

impl PartialEq for Interval {
    /// As sets: two empty intervals are equal.
    #[inline(always)]
    fn eq(&self, b: &Self) -> bool {
        (self.lo == b.lo && self.hi == b.hi) || (self.is_empty() && b.is_empty())
    }
}

impl From<f64> for Interval {
    /// The number `x` alone; empty for an infinity or NaN.
    #[inline(always)]
    fn from(x: f64) -> Self {
        if x.is_finite() { Self { lo: x, hi: x } } else { Self::EMPTY }
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { lo: add_down(self.lo, b.lo), hi: add_up(self.hi, b.hi) }
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { lo: sub_down(self.lo, b.hi), hi: sub_up(self.hi, b.lo) }
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let a = self;
        if a.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        // Which ends meet in the least product, and which in the greatest.
        let (l, h) = if a.lo >= 0.0 {
            if b.lo >= 0.0 {
                ((a.lo, b.lo), (a.hi, b.hi))
            } else if b.hi <= 0.0 {
                ((a.hi, b.lo), (a.lo, b.hi))
            } else {
                ((a.hi, b.lo), (a.hi, b.hi))
            }
        } else if a.hi <= 0.0 {
            if b.lo >= 0.0 {
                ((a.lo, b.hi), (a.hi, b.lo))
            } else if b.hi <= 0.0 {
                ((a.hi, b.hi), (a.lo, b.lo))
            } else {
                ((a.lo, b.hi), (a.lo, b.lo))
            }
        } else if b.lo >= 0.0 {
            ((a.lo, b.hi), (a.hi, b.hi))
        } else if b.hi <= 0.0 {
            ((a.hi, b.lo), (a.lo, b.lo))
        } else {
            return Self {
                lo: times(a.lo, b.hi, mul_down).min(times(a.hi, b.lo, mul_down)),
                hi: times(a.lo, b.lo, mul_up).max(times(a.hi, b.hi, mul_up)),
            };
        };
        Self { lo: times(l.0, l.1, mul_down), hi: times(h.0, h.1, mul_up) }
    }
}

impl Div for Interval {
    type Output = Self;
    /// All quotients by the divisor's numbers other than zero; empty if there is none.
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let a = self;
        if a.is_empty() || b.is_empty() || (b.lo == 0.0 && b.hi == 0.0) {
            return Self::EMPTY;
        }
        if b.hi <= 0.0 {
            return -a / -b;
        }
        if b.lo < 0.0 {
            return if a.lo == 0.0 && a.hi == 0.0 { a } else { Self::ENTIRE };
        }
        // 0 <= b.lo, 0 < b.hi. A quotient by an end that is 0 or infinite is a limit.
        let end = |x: f64, y: f64, round: fn(f64, f64) -> f64, limit: f64| {
            if x == 0.0 || y == f64::INFINITY {
                0.0
            } else if y == 0.0 {
                limit
            } else {
                round(x, y)
            }
        };
        let lo = end(a.lo, if a.lo >= 0.0 { b.hi } else { b.lo }, div_down, f64::NEG_INFINITY);
        let hi = end(a.hi, if a.hi >= 0.0 { b.lo } else { b.hi }, div_up, f64::INFINITY);
        Self { lo, hi }
    }
}

impl Scalar for Interval {
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        a * b - c * d
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
