//! Double-double numbers: the unevaluated sum of two f64, about 106 bits.
//!
//! Algorithms and bounds: M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for
//! basic building blocks of double-word arithmetic", ACM Transactions on Mathematical Software
//! 44(2), 2017 (JMP below); the square root is from V. Lefèvre, N. Louvet, J.-M. Muller, J. Picot,
//! L. Rideau, "Accurate calculation of Euclidean norms using double-word arithmetic", ACM TOMS
//! 49(1), 2023. `u = 2^-53`; all bounds are relative, and hold barring overflow and underflow
//! ([`EFloat`](crate::EFloat) charges for underflow).

use crate::eft::{fast_two_sum, two_diff, two_prod, two_sum};
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The number `hi + lo`.
///
/// # Invariants
///
/// `hi = fl(hi + lo)`: the parts do not overlap. Every operation keeps it; [`Dd::new`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dd {
    /// The number rounded to f64.
    pub hi: f64,
    /// The rounding error of `hi`.
    pub lo: f64,
}

impl Dd {
    /// Zero.
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    /// One.
    pub const ONE: Self = Self { hi: 1.0, lo: 0.0 };

    /// The sum of any two f64, exactly.
    #[inline(always)]
    pub fn new(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, b);
        Self { hi, lo }
    }

    /// The difference of two f64, exactly.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_diff(a, b);
        Self { hi, lo }
    }

    /// The product of two f64, exactly unless its low part underflows.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        let (hi, lo) = two_prod(a, b);
        Self { hi, lo }
    }

    /// The nearest f64.
    #[inline(always)]
    pub fn to_f64(self) -> f64 {
        self.hi
    }

    /// The absolute value, exactly.
    #[inline(always)]
    pub fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }

    /// The square root: JMP-style correction of `fl(sqrt(hi))`; error at most `25/8 u^2` (Lefèvre
    /// et al. 2023, theorem on SQRTDWtoDW). NaN for a negative number.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let s = self.hi.sqrt();
        if s == 0.0 {
            return Self { hi: s, lo: 0.0 };
        }
        let residual = (-s).mul_add(s, self.hi);
        let (hi, lo) = fast_two_sum(s, (residual + self.lo) / (2.0 * s));
        Self { hi, lo }
    }

    /// The number times `2^k`; exact barring over- and underflow.
    #[inline(always)]
    pub fn scale2(self, k: i32) -> Self {
        Self { hi: crate::scale::ldexp(self.hi, k), lo: crate::scale::ldexp(self.lo, k) }
    }
}

impl From<f64> for Dd {
    #[inline(always)]
    fn from(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Dd {
    type Output = Self;
    /// JMP algorithm 6 (AccurateDWPlusDW): error at most `3 u^2 + 13 u^3`. Exact in the subnormal
    /// range.
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let (sh, sl) = two_sum(self.hi, b.hi);
        let (th, tl) = two_sum(self.lo, b.lo);
        let (vh, vl) = fast_two_sum(sh, sl + th);
        let (hi, lo) = fast_two_sum(vh, tl + vl);
        Self { hi, lo }
    }
}

impl Sub for Dd {
    type Output = Self;
    /// As addition.
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Dd {
    type Output = Self;
    /// JMP algorithm 12 (DWTimesDW3): error at most `4 u^2`.
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let (ch, cl) = two_prod(self.hi, b.hi);
        let t = self.hi.mul_add(b.lo, self.lo * b.lo);
        let t = self.lo.mul_add(b.hi, t);
        let (hi, lo) = fast_two_sum(ch, cl + t);
        Self { hi, lo }
    }
}

impl Mul<f64> for Dd {
    type Output = Self;
    /// JMP algorithm 9 (DWTimesFP3): error at most `2 u^2`.
    #[inline(always)]
    fn mul(self, b: f64) -> Self {
        let (ch, cl) = two_prod(self.hi, b);
        let (hi, lo) = fast_two_sum(ch, self.lo.mul_add(b, cl));
        Self { hi, lo }
    }
}

impl Div for Dd {
    type Output = Self;
    /// JMP algorithm 17 (DWDivDW2): error at most `15 u^2 + 56 u^3`.
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let th = self.hi / b.hi;
        let r = b * th;
        let delta = (self.hi - r.hi) + (self.lo - r.lo);
        let (hi, lo) = fast_two_sum(th, delta / b.hi);
        Self { hi, lo }
    }
}

impl PartialOrd for Dd {
    #[inline(always)]
    fn partial_cmp(&self, b: &Self) -> Option<Ordering> {
        match self.hi.partial_cmp(&b.hi) {
            Some(Ordering::Equal) => self.lo.partial_cmp(&b.lo),
            order => order,
        }
    }
}
