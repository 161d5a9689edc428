//! Eight rounded numbers side by side as a [`Number`] of formulas: for quick estimates, as f64 is
//! for one point. Undefined is NaN.
//!
//! Each function has the error of its kernel (`lane_waves.rs`, `lane_logs.rs`, `lane_angles.rs`),
//! or is that of f64, lane by lane.

use crate::noise::{Nearest, NoiseTable};
use crate::number::{Comparison, Function, Number, Sloped};
use crate::{lane_angles, lane_powers, lane_waves, noise};
use durer_math::{F8, Interval, M8};

const NAN: F8 = F8::splat(f64::NAN);

/// Completes a packet result: unknown lanes are computed one by one.
#[inline(always)]
fn or_by_itself((mut out, known): (F8, M8), f: impl Fn(usize) -> f64) -> F8 {
    for i in (!known).lanes() {
        out.0[i] = f(i);
    }
    out
}

/// The lanes that are not NaN.
#[inline(always)]
fn defined(a: &F8) -> M8 {
    a.equals(*a)
}

impl Number for F8 {
    #[inline(always)]
    fn constant(c: Interval) -> Self {
        Self::splat(c.mid())
    }
    #[inline(always)]
    fn add(a: &Self, b: &Self) -> Self {
        *a + *b
    }
    #[inline(always)]
    fn sub(a: &Self, b: &Self) -> Self {
        *a - *b
    }
    #[inline(always)]
    fn mul(a: &Self, b: &Self) -> Self {
        *a * *b
    }
    #[inline(always)]
    fn div(a: &Self, b: &Self) -> Self {
        b.equals(Self::ZERO).select(NAN, *a / *b)
    }
    #[inline(always)]
    fn neg(a: &Self) -> Self {
        -*a
    }
    #[inline(always)]
    fn sqr(a: &Self) -> Self {
        *a * *a
    }
    #[inline(always)]
    fn abs(a: &Self) -> Self {
        Self::abs(*a)
    }
    #[inline(always)]
    fn sqrt(a: &Self) -> Self {
        Self::sqrt(*a)
    }
    #[inline(always)]
    fn min(a: &Self, b: &Self) -> Self {
        a.le(*b).select(*a, b.lt(*a).select(*b, NAN))
    }
    #[inline(always)]
    fn max(a: &Self, b: &Self) -> Self {
        b.le(*a).select(*a, a.lt(*b).select(*b, NAN))
    }
    #[inline(always)]
    fn powi(a: &Self, n: i32) -> Self {
        let (mut result, mut base, mut left) = (Self::ONE, *a, n.unsigned_abs());
        while left > 0 {
            if left & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            left >>= 1;
        }
        // NaN stays NaN, even to the power of zero.
        let result = defined(a).select(result, NAN);
        if n < 0 { a.equals(Self::ZERO).select(NAN, Self::ONE / result) } else { result }
    }
    #[inline(always)]
    fn pow(a: &Self, b: &Self) -> Self {
        or_by_itself(
            lane_powers::rounded(*a, *b),
            #[inline(always)]
            |i| Number::pow(&a.0[i], &b.0[i]),
        )
    }
    #[inline(always)]
    fn atan2(y: &Self, x: &Self) -> Self {
        or_by_itself(
            lane_angles::rounded(*y, *x),
            #[inline(always)]
            |i| Number::atan2(&y.0[i], &x.0[i]),
        )
    }
    #[inline(always)]
    fn rem(a: &Self, b: &Self) -> Self {
        or_by_itself(
            (NAN, M8::NONE),
            #[inline(always)]
            |i| Number::rem(&a.0[i], &b.0[i]),
        )
    }
    #[inline(always)]
    fn function(f: Function, a: &Self) -> Self {
        let told = match f {
            Function::Sin => lane_waves::rounded(a, 0.0),
            Function::Cos => lane_waves::rounded(a, 1.0),
            _ => (NAN, M8::NONE),
        };
        or_by_itself(
            told,
            #[inline(always)]
            |i| Number::function(f, &a.0[i]),
        )
    }
    #[inline(always)]
    fn sine_and_cosine(a: &Self) -> (Self, Self) {
        let (sine, cosine, known) = lane_waves::both_rounded(a);
        let by_itself = |f: Function, told: Self| {
            or_by_itself(
                (told, known),
                #[inline(always)]
                |i| Number::function(f, &a.0[i]),
            )
        };
        (by_itself(Function::Sin, sine), by_itself(Function::Cos, cosine))
    }
    #[inline(always)]
    fn noise(table: Option<&NoiseTable>, p: [&Self; 3]) -> Self {
        noise::values(table, p)
    }
    #[inline(always)]
    fn nearest(which: Nearest, p: [&Self; 3]) -> Self {
        which.values(p)
    }
    #[inline(always)]
    fn compare(c: Comparison, a: &Self, b: &Self) -> Self {
        let zero = Self::ZERO;
        let yes = match c {
            Comparison::Less => a.lt(*b),
            Comparison::LessEqual => a.le(*b),
            Comparison::Equal => a.equals(*b),
            Comparison::NotEqual => !a.equals(*b),
            Comparison::And => !(a.equals(zero) | b.equals(zero)),
            Comparison::Or => !(a.equals(zero) & b.equals(zero)),
        };
        (defined(a) & defined(b)).select(yes.keep(Self::ONE), NAN)
    }
    #[inline(always)]
    fn select(c: &Self, below: &Self, at: &Self, above: &Self) -> Self {
        let zero = Self::ZERO;
        c.lt(zero).select(*below, c.gt(zero).select(*above, c.equals(zero).select(*at, NAN)))
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.equals(Self::ZERO).all()
    }
    #[inline(always)]
    fn above(a: &Self) -> Option<Self> {
        a.gt(Self::ONE).all().then_some(*a)
    }
}

impl Sloped for F8 {
    #[inline(always)]
    fn noise_and_slopes(table: Option<&NoiseTable>, p: [&Self; 3]) -> (Self, [Self; 3]) {
        noise::slants(table, p)
    }
    #[inline(always)]
    fn nearest_and_slopes(which: Nearest, p: [&Self; 3]) -> (Self, [Self; 3]) {
        which.values_and_slopes(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unusual numbers, and points at which functions are undefined or jump.
    const PROBES: [f64; 16] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.3,
        -0.7,
        2.5,
        -3.0,
        1e-310,
        -1e-200,
        1e9,
        -4e7,
        1e200,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];

    /// Equal up to rounding: a few ulp, and the error of the reduction of a large angle.
    fn agree(lane: f64, single: f64) -> bool {
        lane == single
            || lane.is_nan() && single.is_nan()
            || (lane - single).abs() <= 64.0 * durer_math::U * single.abs().max(durer_math::U)
    }

    #[test]
    fn each_lane_is_what_a_single_number_is() {
        use Function::{Acos, Atan, Cos, Exp, Ln, Sin, Trunc};
        for a in PROBES {
            for b in PROBES {
                for c in [-2.0, 0.0, 3.0, f64::NAN] {
                    let lanes = F8([a; 8]);
                    let mut others = F8([0.5; 8]);
                    others.0[3] = b;
                    let chosen = F8([c; 8]);
                    let pairs = [
                        ("add", Number::add(&lanes, &others), Number::add(&a, &b)),
                        ("sub", Number::sub(&lanes, &others), Number::sub(&a, &b)),
                        ("mul", Number::mul(&lanes, &others), Number::mul(&a, &b)),
                        ("div", Number::div(&lanes, &others), Number::div(&a, &b)),
                        ("min", Number::min(&lanes, &others), Number::min(&a, &b)),
                        ("max", Number::max(&lanes, &others), Number::max(&a, &b)),
                        ("pow", Number::pow(&lanes, &others), Number::pow(&a, &b)),
                        ("atan2", Number::atan2(&lanes, &others), Number::atan2(&a, &b)),
                        ("rem", Number::rem(&lanes, &others), Number::rem(&a, &b)),
                        (
                            "select",
                            Number::select(&chosen, &lanes, &others, &F8::ONE),
                            Number::select(&c, &a, &b, &1.0),
                        ),
                    ];
                    for (name, lane, single) in pairs {
                        assert!(agree(lane.0[3], single), "{name} {a} {b} {c}: {} {single}", lane.0[3]);
                    }
                    for c in [Comparison::Less, Comparison::LessEqual, Comparison::Equal] {
                        assert!(
                            agree(Number::compare(c, &lanes, &others).0[3], Number::compare(c, &a, &b)),
                            "{c:?} {a} {b}"
                        );
                    }
                    for c in [Comparison::NotEqual, Comparison::And, Comparison::Or] {
                        assert!(
                            agree(Number::compare(c, &lanes, &others).0[3], Number::compare(c, &a, &b)),
                            "{c:?} {a} {b}"
                        );
                    }
                }
            }
            let mut lanes = F8([0.25; 8]);
            lanes.0[5] = a;
            for f in [Sin, Cos, Acos, Atan, Exp, Ln, Trunc] {
                let (lane, single) = (Number::function(f, &lanes).0[5], Number::function(f, &a));
                assert!(agree(lane, single), "{f:?} {a}: {lane} {single}");
            }
            for n in [-3, -1, 0, 1, 2, 5, 12] {
                let (lane, single) = (Number::powi(&lanes, n).0[5], Number::powi(&a, n));
                assert!(agree(lane, single), "{a} to the power {n}: {lane} {single}");
            }
        }
    }
}
