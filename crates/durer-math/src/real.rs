//! Numbers that may be f32. Where f32's rounding is small compared with other errors, eight numbers
//! fill one AVX2 register instead of two.
//!
//! Results with either type are certain: each includes its own rounding errors ([`Real::U`]).

use crate::lanes::LANES;
use crate::scale::pow2;
use crate::{F8, M8};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// f64 or f32.
pub trait Real:
    Copy
    + PartialOrd
    + From<f32>
    + Into<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// The bound on the relative error of one rounding.
    const U: Self;
    /// Covers results below the normal range.
    const TINY: Self;
    /// `self * a + b`, rounded once.
    #[must_use]
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// The lesser number; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The greater number; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

/// A number that both types represent.
#[inline(always)]
pub fn real<T: Real>(x: f32) -> T {
    T::from(x)
}

/// The bound on `count` roundings of a number of size 1.
#[inline(always)]
pub fn roundings<T: Real>(count: f32) -> T {
    T::from(count) * T::U
}

/// 1 plus the bound on `count` roundings.
#[inline(always)]
pub fn more<T: Real>(count: f32) -> T {
    T::from(1.0) + roundings(count)
}

/// 1 minus the bound on `count` roundings.
#[inline(always)]
pub fn less<T: Real>(count: f32) -> T {
    T::from(1.0) - roundings(count)
}

macro_rules! impl_real {
    ($number:ty, $tiny:expr) => {
        impl Real for $number {
            const ZERO: Self = 0.0;
            const U: Self = 0.5 * <$number>::EPSILON;
            const TINY: Self = $tiny;
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self.mul_add(a, b)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
        }
    };
}

impl_real!(f64, pow2(-900));
impl_real!(f32, pow2(-110) as f32);

/// Eight numbers of either type, like [`F8`].
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Eight<T>(pub [T; LANES]);

impl<T: Real> Eight<T> {
    /// Zero in every lane.
    pub const ZERO: Self = Self([T::ZERO; LANES]);

    /// Every lane holds `x`.
    #[inline(always)]
    pub const fn splat(x: T) -> Self {
        Self([x; LANES])
    }

    /// Converts to f64, exactly.
    #[inline(always)]
    pub fn widened(&self) -> F8 {
        let mut wide = F8::ZERO;
        for k in 0..LANES {
            wide.0[k] = self.0[k].into();
        }
        wide
    }

    /// Replaces each number by the greater one of it and the number in `others`.
    #[inline(always)]
    pub fn raise(&mut self, others: &Self) {
        for k in 0..LANES {
            self.0[k] = others.0[k].max(self.0[k]);
        }
    }

    /// Whether all are positive.
    #[inline(always)]
    pub fn are_all_positive(&self) -> bool {
        let mut all = true;
        for k in 0..LANES {
            all &= self.0[k] > T::ZERO;
        }
        all
    }

    /// The mask of positive numbers.
    #[inline(always)]
    pub fn are_positive(&self) -> M8 {
        self.widened().gt(F8::ZERO)
    }

    /// `self * a + b`, rounded once.
    #[inline(always)]
    #[must_use]
    pub fn mul_add(mut self, a: Self, b: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].mul_add(a.0[k], b.0[k]);
        }
        self
    }

    /// The absolute value.
    #[inline(always)]
    #[must_use]
    pub fn abs(mut self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].abs();
        }
        self
    }

    /// The lesser number; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn min(mut self, other: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].min(other.0[k]);
        }
        self
    }

    /// The greater number; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn max(mut self, other: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].max(other.0[k]);
        }
        self
    }
}

macro_rules! arithmetic {
    ($($trait:ident, $method:ident, $op:tt;)*) => {$(
        impl<T: Real> $trait for Eight<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, o: Self) -> Self {
                for k in 0..LANES {
                    self.0[k] = self.0[k] $op o.0[k];
                }
                self
            }
        }
        impl<T: Real> $trait<T> for Eight<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, o: T) -> Self {
                for k in 0..LANES {
                    self.0[k] = self.0[k] $op o;
                }
                self
            }
        }
    )*};
}
arithmetic! { Add, add, +; Sub, sub, -; Mul, mul, *; }

impl<T: Real> Neg for Eight<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for k in 0..LANES {
            self.0[k] = -self.0[k];
        }
        self
    }
}
