//! Choices between two functions that meet: at zero of what chooses, both have the same value, so
//! that nothing jumps there.

use crate::number::Slopes;
use crate::{Dual, F8, I8, Number, Sloped};

/// A number that may be one of two which meet.
pub trait Joined {
    /// One of two by the sign of `c`, which have the same value where `c` is zero.
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
    /// It jumps where one of the sides does.
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        let (may_below, may_above) = (c.lo.lt(F8::ZERO).bits(), c.hi.ge(F8::ZERO).bits());
        let mut out: Self = Number::select(c, below, above, above);
        out.jump = c.jump | may_below & below.jump | may_above & above.jump;
        out
    }
}

impl<T: Sloped, D: Slopes<T>> Joined for Dual<T, D> {
    /// Where they meet: all slopes between the two.
    #[inline(always)]
    fn joined(c: &Self, below: &Self, above: &Self) -> Self {
        let d = D::selected(&c.v, &below.d, &above.d, &above.d);
        Self { v: T::joined(&c.v, &below.v, &above.v), d }
    }
}
