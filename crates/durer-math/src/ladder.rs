//! The ladder of a decision: one formula, evaluated ever more precisely until its sign is certain.
//!
//! ```
//! use durer_math::{Ring, ladder::{self, Predicate}};
//! use core::cmp::Ordering;
//!
//! /// The sign of `b^2 - a c`.
//! struct Discriminant { a: f64, b: f64, c: f64 }
//!
//! impl Predicate for Discriminant {
//!     fn eval<T: Ring>(&self) -> Option<T> {
//!         Some(T::exact(self.b).square() - T::exact(self.a) * T::exact(self.c))
//!     }
//! }
//!
//! let tangent = Discriminant { a: 9e200, b: 3e100 * 0.5, c: 0.25 };
//! assert_eq!(ladder::sign(&tangent), Some(Ordering::Less)); // 3e100 is not a square root of 9e200: rounding
//! ```

use crate::{Dd, Dyadic, EFloat, Ring};
use core::cmp::Ordering;

/// A polynomial whose sign is asked for.
pub trait Predicate {
    /// The polynomial's value. `None` only where `T` cannot hold the inputs: [`Ring::within`] said
    /// so.
    fn eval<T: Ring>(&self) -> Option<T>;
}

/// Which step of the ladder decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// `EFloat<f64>`.
    Double,
    /// `EFloat<Dd>`.
    DoubleDouble,
    /// [`Dyadic`].
    Exact,
}

/// The sign of `p`, compared with zero.
///
/// `None` only if the inputs are not exact (an error came in through [`Ring::within`]) and their
/// errors leave the sign open. Inputs must be finite; intermediate overflow and underflow are no
/// trouble.
#[inline(always)]
pub fn sign<P: Predicate + ?Sized>(p: &P) -> Option<Ordering> {
    match p.eval::<EFloat<f64>>().and_then(|x| x.sign()) {
        None => climb(p).map(|(sign, _)| sign),
        sign => sign,
    }
}

/// As [`sign()`], and which step knew it: for measuring how often the ladder is climbed.
pub fn sign_and_step<P: Predicate + ?Sized>(p: &P) -> Option<(Ordering, Step)> {
    match p.eval::<EFloat<f64>>().and_then(|x| x.sign()) {
        Some(sign) => Some((sign, Step::Double)),
        None => climb(p),
    }
}

#[cold]
#[inline(never)]
fn climb<P: Predicate + ?Sized>(p: &P) -> Option<(Ordering, Step)> {
    if let Some(sign) = p.eval::<EFloat<Dd>>().and_then(|x| x.sign()) {
        return Some((sign, Step::DoubleDouble));
    }
    p.eval::<Dyadic>().map(|x| (x.exact_sign(), Step::Exact))
}
