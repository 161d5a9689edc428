//! Dual numbers: a value and its derivative, by the chain rule alone (forward-mode
//! differentiation).
//!
//! W. K. Clifford, "Preliminary sketch of biquaternions", Proc. London Math. Soc. 4 (1873); for the
//! use in computing: R. E. Wengert, "A simple automatic derivative evaluation program",
//! Communications of the ACM 7 (1964).

use core::ops::{Add, Div, Mul, Neg, Sub};
use durer_math::Scalar;

/// `v + d eps` with `eps^2 = 0`; or, with a [`Gradient`](crate::Gradient),
/// `v + d_1 eps_1 + d_2 eps_2 + d_3 eps_3`, where all `eps_i eps_j = 0`.
///
/// ```
/// use durer_formula::Dual;
/// use durer_math::{Interval, Scalar};
/// let x = Dual::variable(3.0);
/// assert_eq!(x * x * x, Dual { v: 27.0, d: 27.0 }); // x^3 and 3 x^2
/// let x = Dual::variable(Interval::new(1.0, 2.0));
/// assert_eq!((x * x).d, Interval::new(2.0, 4.0)); // 2 x on [1, 2]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T = f64, D = T> {
    /// The value.
    pub v: T,
    /// The derivative, or several.
    pub d: D,
}

impl<T: Scalar> Dual<T> {
    /// A constant.
    #[inline(always)]
    pub fn constant(v: T) -> Self {
        Self { v, d: T::from(0.0) }
    }

    /// The variable of differentiation, at `v`.
    #[inline(always)]
    pub fn variable(v: T) -> Self {
        Self { v, d: T::from(1.0) }
    }
}

impl<T: Scalar> From<f64> for Dual<T> {
    #[inline(always)]
    fn from(x: f64) -> Self {
        Self::constant(T::from(x))
    }
}

impl<T: Scalar> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { v: -self.v, d: -self.d }
    }
}

impl<T: Scalar> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { v: self.v + b.v, d: self.d + b.d }
    }
}

impl<T: Scalar> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { v: self.v - b.v, d: self.d - b.d }
    }
}

impl<T: Scalar> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self { v: self.v * b.v, d: self.v.mul_add(b.d, self.d * b.v) }
    }
}

impl<T: Scalar> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let v = self.v / b.v;
        Self { v, d: (self.d - v * b.d) / b.v }
    }
}

impl<T: Scalar> Scalar for Dual<T> {
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self { v: self.v.mul_add(a.v, b.v), d: self.v.mul_add(a.d, self.d.mul_add(a.v, b.d)) }
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let v = T::difference_of_products(a.v, b.v, c.v, d.v);
        let left = T::difference_of_products(a.v, b.d, c.v, d.d);
        let right = T::difference_of_products(a.d, b.v, c.d, d.v);
        Self { v, d: left + right }
    }
    /// The derivative is `d v/|v|`: undefined at zero (NaN for f64; an interval around zero gives
    /// one that is too wide).
    #[inline(always)]
    fn abs(self) -> Self {
        let v = self.v.abs();
        Self { v, d: self.d * (self.v / v) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let v = self.v.sqrt();
        Self { v, d: self.d / (v + v) }
    }
}
