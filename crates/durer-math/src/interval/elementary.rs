//! Elementary functions of intervals.
//!
//! Each function of f64 comes from [`elementary`](crate::elementary), a port of musl's and
//! CORE-MATH's functions. Their authors state errors below 1 ulp for most, and below 2 to 4 ulp for
//! the hyperbolic functions and their inverses. These statements are not proofs, so every value is
//! widened by [`ULPS`] ulp, at least twice the largest stated error, and
//! `tests/interval_functions.rs` measures the true errors against multi-precision arithmetic.
//! Monotonicity, extremes and ranges of the functions are proven and need no measurement.
//!
//! Where a function is undefined on a part of the interval, the result encloses its values on the
//! rest, and [`Defined`] reports it: the decorations of IEEE 1788-2015, "Standard for interval
//! arithmetic", clause 8, as far as root finding needs them.

use super::Interval;
use crate::elementary as f64s;
use crate::rounding::{add_up, mul_up, sub_down};
use core::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// How far, in ulp, a value of [`crate::elementary`] is taken to be from the true one. Its authors
/// state at most 4 (`lgamma` and Bessel functions apart, which are not used), and what the tests
/// measure is below 2.
pub const ULPS: f64 = 8.0;

/// Where a function is defined and continuous on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defined {
    /// It is defined and continuous everywhere.
    Continuous,
    /// It is defined everywhere, but may jump.
    Jumps,
    /// There may be points where it is undefined.
    Partly,
    /// It is undefined everywhere.
    Nowhere,
}

use Defined::{Continuous, Jumps, Nowhere, Partly};

/// The values of a function on an interval.
pub type Range = (Interval, Defined);

const NONE: Range = (Interval::EMPTY, Nowhere);

/// `x` moved down by [`ULPS`] ulp; a finite number stays finite.
#[inline]
fn lower(x: f64) -> f64 {
    let x = if x > f64::MAX { f64::MAX } else { x };
    sub_down(x, mul_up(x.abs(), ULPS * f64::EPSILON) + f64::MIN_POSITIVE)
}

#[inline]
fn upper(x: f64) -> f64 {
    let x = if x < f64::MIN { f64::MIN } else { x };
    add_up(x, mul_up(x.abs(), ULPS * f64::EPSILON) + f64::MIN_POSITIVE)
}

fn rising(x: Interval, f: impl Fn(f64) -> f64) -> Interval {
    Interval { lo: lower(f(x.lo)), hi: upper(f(x.hi)) }
}

fn within(x: Interval, lo: f64, hi: f64) -> Interval {
    Interval { lo: x.lo.max(lo), hi: x.hi.min(hi) }
}

/// The part of `x` in a domain, and what is said of it.
fn domain(x: Interval, lo: f64, hi: f64) -> Range {
    match x.intersection(Interval { lo, hi }) {
        None => NONE,
        Some(part) if part == x => (part, Continuous),
        Some(part) => (part, Partly),
    }
}

impl Interval {
    /// Whether some `k` with the given parity has `offset + k` near or in the interval of `x / pi`:
    /// where a sine has its extremes.
    fn has_turn(turns: Self, offset: f64, parity: f64) -> bool {
        // The quotient by pi errs by a few ulp of at most 2^20: 1e-9 is more. To say yes needlessly
        // loses nothing to speak of.
        const MARGIN: f64 = 1e-9;
        let first = 2.0 * ((turns.lo - offset - parity - MARGIN) * 0.5).ceil() + parity;
        first <= turns.hi - offset + MARGIN
    }

    fn wave(self, f: impl Fn(f64) -> f64, offset: f64) -> Self {
        const FAR: f64 = (1u64 << 20) as f64;
        if self.magnitude() > FAR || self.width() >= 2.0 * PI {
            return Self { lo: -1.0, hi: 1.0 };
        }
        let turns = Self { lo: self.lo * FRAC_1_PI, hi: self.hi * FRAC_1_PI };
        let (a, b) = (f(self.lo), f(self.hi));
        let hi = if Self::has_turn(turns, offset, 0.0) { 1.0 } else { upper(a.max(b)).min(1.0) };
        let lo = if Self::has_turn(turns, offset, 1.0) { -1.0 } else { lower(a.min(b)).max(-1.0) };
        Self { lo, hi }
    }

    /// The sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.wave(f64s::sin, 0.5)
    }

    /// The cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.wave(f64s::cos, 0.0)
    }

    /// The tangent; undefined at odd multiples of a quarter turn.
    pub fn tan(self) -> Range {
        const FAR: f64 = (1u64 << 20) as f64;
        let turns = Self { lo: self.lo * FRAC_1_PI, hi: self.hi * FRAC_1_PI };
        let pole = Self::has_turn(turns, 0.5, 0.0) || Self::has_turn(turns, 0.5, 1.0);
        if self.magnitude() > FAR || self.width() >= PI || pole {
            return (Self::ENTIRE, Partly);
        }
        (rising(self, f64s::tan), Continuous)
    }

    /// The arc sine, in `[-pi/2, pi/2]`.
    pub fn asin(self) -> Range {
        let (x, d) = domain(self, -1.0, 1.0);
        if d == Nowhere { NONE } else { (rising(x, f64s::asin), d) }
    }

    /// The arc cosine, in `[0, pi]`.
    pub fn acos(self) -> Range {
        let (x, d) = domain(self, -1.0, 1.0);
        if d == Nowhere {
            return NONE;
        }
        (Self { lo: lower(f64s::acos(x.hi)).max(0.0), hi: upper(f64s::acos(x.lo)) }, d)
    }

    /// The arc tangent.
    #[must_use]
    pub fn atan(self) -> Self {
        rising(self, f64s::atan)
    }

    /// The angle of the points `(x, self)`, in `(-pi, pi]`; undefined at the origin.
    pub fn atan2(self, x: Self) -> Range {
        let y = self;
        if y.lo == 0.0 && y.hi == 0.0 && x.lo == 0.0 && x.hi == 0.0 {
            return NONE;
        }
        let corners = |points: [(f64, f64); 2]| {
            // Towards infinity the angle has limits, which are the values at infinite ends.
            let [a, b] = points.map(|(y, x)| f64s::atan2(y + 0.0, x));
            Self { lo: lower(a), hi: upper(b) }
        };
        let origin = y.lo <= 0.0 && y.hi >= 0.0 && x.lo <= 0.0 && x.hi >= 0.0;
        let d = if origin { Partly } else { Continuous };
        if x.lo > 0.0 || (x.lo == 0.0 && !origin) {
            // To the right of the origin: the angle rises with y; with x it goes towards zero.
            let low = (y.lo, if y.lo >= 0.0 { x.hi } else { x.lo });
            let high = (y.hi, if y.hi >= 0.0 { x.lo } else { x.hi });
            return (corners([low, high]), d);
        }
        if y.lo > 0.0 {
            let low = (if x.hi >= 0.0 { y.lo } else { y.hi }, x.hi);
            let high = (if x.lo >= 0.0 { y.hi } else { y.lo }, x.lo);
            return (corners([low, high]), d);
        }
        if y.hi < 0.0 {
            let (angle, d) = (-y).atan2(x);
            return (-angle, d);
        }
        // The negative half of the x axis is in it, where the angle jumps, unless all is on one
        // side of that.
        if y.lo >= 0.0 {
            return (
                Self { lo: if x.hi < 0.0 { lower(f64s::atan2(y.hi, x.hi)) } else { 0.0 }, hi: upper(PI) },
                d,
            );
        }
        (Self { lo: lower(-PI), hi: upper(PI) }, if origin { Partly } else { Jumps })
    }

    /// The hyperbolic sine.
    #[must_use]
    pub fn sinh(self) -> Self {
        rising(self, f64s::sinh)
    }

    /// The hyperbolic cosine.
    #[must_use]
    pub fn cosh(self) -> Self {
        let a = self.abs();
        let r = rising(a, f64s::cosh);
        Self { lo: r.lo.max(1.0), hi: r.hi }
    }

    /// The hyperbolic tangent.
    #[must_use]
    pub fn tanh(self) -> Self {
        within(rising(self, f64s::tanh), -1.0, 1.0)
    }

    /// The inverse hyperbolic sine.
    #[must_use]
    pub fn asinh(self) -> Self {
        rising(self, f64s::asinh)
    }

    /// The inverse hyperbolic cosine, of numbers from 1 up.
    pub fn acosh(self) -> Range {
        let (x, d) = domain(self, 1.0, f64::INFINITY);
        if d == Nowhere {
            return NONE;
        }
        let r = rising(x, f64s::acosh);
        (Self { lo: r.lo.max(0.0), hi: r.hi }, d)
    }

    /// The inverse hyperbolic tangent, of numbers strictly between -1 and 1.
    pub fn atanh(self) -> Range {
        if self.lo >= 1.0 || self.hi <= -1.0 {
            return NONE;
        }
        let lo = if self.lo <= -1.0 { f64::NEG_INFINITY } else { lower(f64s::atanh(self.lo)) };
        let hi = if self.hi >= 1.0 { f64::INFINITY } else { upper(f64s::atanh(self.hi)) };
        let d = if self.lo > -1.0 && self.hi < 1.0 { Continuous } else { Partly };
        (Self { lo, hi }, d)
    }

    /// `e^x`.
    #[must_use]
    pub fn exp(self) -> Self {
        let r = rising(self, f64s::exp);
        Self { lo: r.lo.max(0.0), hi: r.hi }
    }

    fn logarithm(self, f: impl Fn(f64) -> f64) -> Range {
        if self.hi <= 0.0 {
            return NONE;
        }
        let lo = if self.lo <= 0.0 { f64::NEG_INFINITY } else { lower(f(self.lo)) };
        (Self { lo, hi: upper(f(self.hi)) }, if self.lo > 0.0 { Continuous } else { Partly })
    }

    /// The natural logarithm.
    pub fn ln(self) -> Range {
        self.logarithm(f64s::ln)
    }

    /// The logarithm to base 10.
    pub fn log10(self) -> Range {
        self.logarithm(f64s::log10)
    }

    /// `x^n` for a whole `n`; undefined at zero where `n` is negative.
    pub fn powi(self, n: i32) -> Range {
        if n == 0 {
            return (Self { lo: 1.0, hi: 1.0 }, Continuous);
        }
        if n < 0 {
            let below = self.powi_up(n.unsigned_abs());
            if below.lo == 0.0 && below.hi == 0.0 {
                return NONE;
            }
            let d = if self.contains(0.0) { Partly } else { Continuous };
            return (Self::from(1.0) / below, d);
        }
        (self.powi_up(n.unsigned_abs()), Continuous)
    }

    fn powi_up(self, n: u32) -> Self {
        let even = n & 1 == 0;
        let x = if even { self.abs() } else { self };
        // Between numbers of one sign, products of ends are ends of products.
        let end = |x: f64| {
            let one = Self { lo: x.abs(), hi: x.abs() };
            let (mut result, mut power, mut left) = (Self { lo: 1.0, hi: 1.0 }, one, n);
            while left != 0 {
                if left & 1 == 1 {
                    result = result * power;
                }
                left >>= 1;
                if left != 0 {
                    power = power.square();
                }
            }
            if x < 0.0 { -result } else { result }
        };
        Self { lo: end(x.lo).lo, hi: end(x.hi).hi }
    }

    /// `x^y` for real exponents: for `x > 0`, for `x = 0 < y`, and of negative `x` for whole `y`
    /// alone.
    pub fn pow(self, y: Self) -> Range {
        if y.lo == y.hi && y.lo.fract() == 0.0 && y.lo.abs() < 65536.0 {
            return self.powi(y.lo as i32);
        }
        let whole = y.lo.ceil() <= y.hi;
        if self.hi < 0.0 && !whole {
            return NONE;
        }
        // The one power for a base up to 1, the other beyond.
        let corner = |x: f64, to_one: f64, beyond: f64| f64s::pow(x, if x <= 1.0 { to_one } else { beyond });
        let power = |x: Self| {
            // Each edge of the rectangle is monotone and its inside has no extreme: the corners say
            // all. Which two of them do is plain where the power has one sign.
            let (least, most) = if y.lo >= 0.0 {
                (corner(x.lo, y.hi, y.lo), corner(x.hi, y.lo, y.hi))
            } else if y.hi <= 0.0 {
                (corner(x.hi, y.hi, y.lo), corner(x.lo, y.lo, y.hi))
            } else {
                let c =
                    [(x.lo, y.lo), (x.lo, y.hi), (x.hi, y.lo), (x.hi, y.hi)].map(|(x, y)| f64s::pow(x, y));
                (c.into_iter().fold(f64::INFINITY, f64::min), c.into_iter().fold(0.0, f64::max))
            };
            let inner = x.lo <= 0.0 && y.lo <= 0.0;
            Self { lo: lower(least).max(0.0), hi: if inner { f64::INFINITY } else { upper(most) } }
        };
        let positive = (self.hi >= 0.0).then(|| power(Self { lo: self.lo.max(0.0), hi: self.hi }));
        if self.lo >= 0.0 {
            let d = if self.lo > 0.0 || y.lo > 0.0 { Continuous } else { Partly };
            return (positive.unwrap_or(Self::EMPTY), d);
        }
        let mut all = positive.unwrap_or(Self::EMPTY);
        if whole {
            let most = power(Self { lo: (-self.hi).max(0.0), hi: -self.lo }).hi;
            all = all.hull(Self { lo: -most, hi: most });
        }
        (all, Partly)
    }

    fn steps(self, f: impl Fn(f64) -> f64) -> Range {
        let (lo, hi) = (f(self.lo), f(self.hi));
        (Self { lo, hi }, if lo == hi { Continuous } else { Jumps })
    }

    /// The largest whole number not above.
    pub fn floor(self) -> Range {
        self.steps(f64::floor)
    }

    /// The smallest whole number not below.
    pub fn ceil(self) -> Range {
        self.steps(f64::ceil)
    }

    /// The whole part, towards zero.
    pub fn trunc(self) -> Range {
        self.steps(f64::trunc)
    }

    /// The remainder of `self / b` with the sign of `self` (C's `fmod`). Undefined for `b = 0`.
    pub fn remainder(self, b: Self) -> Range {
        if b.lo == 0.0 && b.hi == 0.0 {
            return NONE;
        }
        let size = b.abs();
        if let Some(exact) = self.remainder_of_one(size) {
            return (exact, Continuous);
        }
        if size.lo > 0.0 {
            let q = (self / b).trunc();
            if q.1 == Continuous && q.0.lo.is_finite() {
                let rest = self - b * q.0;
                // A quotient's rounding may have put a whole number on the wrong side, but not at
                // both ends.
                let bound = Self { lo: -size.hi, hi: size.hi };
                return (rest.intersection(bound).unwrap_or(rest), Continuous);
            }
        }
        let most = size.hi;
        let lo = if self.lo < 0.0 { self.lo.max(-most) } else { 0.0 };
        let hi = if self.hi > 0.0 { self.hi.min(most) } else { 0.0 };
        (Self { lo, hi }, if size.lo > 0.0 { Jumps } else { Partly })
    }

    /// The remainder by one number `b > 0` if no multiple of `b` lies above the lower end (of a
    /// positive interval). Remainders of numbers are exact.
    fn remainder_of_one(self, b: Self) -> Option<Self> {
        if self.hi <= 0.0 && self.lo < 0.0 {
            return (-self).remainder_of_one(b).map(|rest| -rest);
        }
        let (least, most) = (self.lo % b.lo, self.hi % b.lo);
        // Less than b apart, as their rounded difference is no less than b where the exact one is
        // not: k b + least and m b + most have the same k and m unless the remainder falls.
        let is_one = b.lo == b.hi && self.lo >= 0.0 && self.hi - self.lo < b.lo;
        (is_one && least <= most).then_some(Self { lo: least, hi: most })
    }

    /// An angle of degrees in radians.
    #[must_use]
    pub fn to_radians(self) -> Self {
        self * Self { lo: (PI / 180.0).next_down(), hi: (PI / 180.0).next_up() }
    }

    /// An angle of radians in degrees.
    #[must_use]
    pub fn to_degrees(self) -> Self {
        self * Self { lo: (180.0 / PI).next_down(), hi: (180.0 / PI).next_up() }
    }

    /// pi.
    pub const PI: Self = Self { lo: PI, hi: 2.0 * FRAC_PI_2.next_up() };
}
