//! One formula, several precisions: the ladder of a decision.
//!
//! Whether a line meets a quadric is the sign of a polynomial in the numbers of the ray and of the
//! surface. The polynomial is written once, generic over [`Ring`], and evaluated in `EFloat<f64>`
//! (a value with its running error), then in `EFloat<Dd>`, then in [`Dyadic`](crate::Dyadic), which
//! is exact. Each step answers [`Ring::sign`] with `Some` only where the answer is certain; the
//! last always does.

use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};

/// A number type in which polynomials can be evaluated, and which knows when the sign of a result
/// is certain.
pub trait Ring:
    Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The number `x`, exactly. `x` must be finite.
    fn exact(x: f64) -> Self;

    /// Some number within `error` of `x`; `None` if this type can only hold exact numbers and
    /// `error` is not zero.
    fn within(x: f64, error: f64) -> Option<Self>;

    /// This number times `2^exponent`.
    fn scale2(self, exponent: i32) -> Self;

    /// The sign (compared with zero) if it is certain.
    fn sign(&self) -> Option<Ordering>;

    /// The square.
    #[inline(always)]
    fn square(self) -> Self {
        self.clone() * self
    }
}
