//! The number types that points and vectors may be made of.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number type for points and vectors: f64, and the interval and dual numbers that come free with
/// it.
pub trait Scalar:
    Copy
    + core::fmt::Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + From<f64>
{
    /// `self * a + b`, fused where the type can.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// `a b - c d`, without needless cancellation where the type can.
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
}

impl Scalar for f64 {
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        f64::mul_add(self, a, b)
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        crate::eft::difference_of_products(a, b, c, d)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}
