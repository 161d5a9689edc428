//! Continuous choices between two functions: where the selector is zero, both have the same value,
//! so that there is no jump.

use crate::number::Slopes;
use crate::{Dual, I8, Number, Sloped};
use durer_math::F8;

/// Number types with a continuous choice.
pub trait Joined {
    /// `below` or `above`, by the sign of `c`. Both have the same value where `c` is zero.
    fn joined(c: &Self, below: &Self, above: &Self) -> Self;
}

impl Joined for f64 {
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        Number::select(c, below, above, above)
    }
}

impl Joined for F8 {
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        Number::select(c, below, above, above)
    }
}

impl Joined for I8 {
    /// The result may jump only where one of the sides does.
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        let (may_below, may_above) = (c.lo.lt(F8::ZERO).bits(), c.hi.ge(F8::ZERO).bits());
        let mut out: Self = Number::select(c, below, above, above);
        out.jump = c.jump | may_below & below.jump | may_above & above.jump;
        out
    }
}

impl<T: Sloped, D: Slopes<T>> Joined for Dual<T, D> {
    /// Where the sides meet, the slopes are all between the two.
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        let d = D::selected(&c.v, &below.d, &above.d, &above.d);
        Self { v: T::joined(&c.v, &below.v, &above.v), d }
    }
}
