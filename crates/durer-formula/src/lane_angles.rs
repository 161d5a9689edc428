//! Angles of eight boxes of points at once.
//!
//! `t = min / max` of `|x|` and `|y|`. Beyond `tan(pi/8)` an eighth of a turn is subtracted,
//! `u = (t - 1) / (t + 1)`, so `|u| <= 0.4143`. The series of `atan u / u` in `z = u^2 <= 0.1717`
//! ends with `z^19 / 39`, a truncation error of `0.1 U`. If `u = t`, it errs by `U` of itself and
//! the angle by `3 U`; otherwise `u` errs by `1.8 U` and the angle, at least `pi/8`, by `4 U`,
//! which is `10 U` of itself. Each subtraction from `pi/2` or `pi` rounds once more, and its result
//! is larger. The sum is below [`ANGLE_ERROR`].

use crate::I8;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use durer_math::{F8, Isa, M8, U};

/// Bound on an angle's error, relative to the angle: equal to that of the scalar functions.
const ANGLE_ERROR: f64 = 16.0 * U;
/// Covers results below the normal range.
const TINY: f64 = durer_math::scale::pow2(-1000);
/// Points whose larger coordinate is beyond this, or below its inverse, are left to the scalar
/// functions.
const FAR: f64 = durer_math::scale::pow2(500);
/// `tan(pi/8)`, about.
const EIGHTH: f64 = 0.414_213_562_373_095_05;

/// The angles of eight points whose larger coordinates are neither too large nor too small, in
/// `(-pi, pi]`.
#[inline(always)]
fn angle(y: F8, x: F8) -> F8 {
    let (ax, ay) = (x.abs(), y.abs());
    let t = ax.min(ay) / ax.max(ay);
    let beyond = t.gt(F8::splat(EIGHTH));
    let u = beyond.select((t - F8::ONE) / (t + F8::ONE), t);
    let z = u * u;
    // The reciprocals of the odd numbers, with alternating signs, from the last.
    let mut series = F8::splat(-1.0 / 39.0);
    for k in (0..19_i32).rev() {
        let c = 1.0 / f64::from(2 * k + 1);
        series = series.mul_add(z, F8::splat(if k % 2 == 0 { c } else { -c }));
    }
    let small = series * u;
    let a = beyond.select(small + F8::splat(FRAC_PI_4), small);
    let a = ay.gt(ax).select(F8::splat(FRAC_PI_2) - a, a);
    let a = x.lt(F8::ZERO).select(F8::splat(PI) - a, a);
    a.copysign(y)
}

/// The lanes in which a point's larger coordinate is neither too large nor too small.
#[inline(always)]
fn ordinary(y: F8, x: F8) -> M8 {
    let size = y.abs().max(x.abs());
    size.ge(F8::splat(1.0 / FAR)) & size.le(F8::splat(FAR))
}

/// The rounded angles, and the lanes that are computed.
#[inline(always)]
pub(crate) fn rounded(y: F8, x: F8) -> (F8, M8) {
    (angle(y + F8::ZERO, x), ordinary(y, x))
}

/// Bounds on the angles, and the lanes that are computed.
#[inline(always)]
fn corners(y: &I8, x: &I8) -> (F8, F8, M8) {
    let zero = F8::ZERO;
    let right = x.lo.gt(zero);
    let (up, down) = (y.lo.gt(zero) & !right, y.hi.lt(zero) & !right);
    // To the right of the origin the angle rises with y, and goes towards zero as x grows; above it
    // falls with x, below it rises.
    let low_y =
        right.select(y.lo, up.select(x.hi.ge(zero).select(y.lo, y.hi), x.lo.ge(zero).select(y.lo, y.hi)));
    let low_x = right.select(y.lo.ge(zero).select(x.hi, x.lo), up.select(x.hi, x.lo));
    let high_y =
        right.select(y.hi, up.select(x.lo.ge(zero).select(y.hi, y.lo), x.hi.ge(zero).select(y.hi, y.lo)));
    let high_x = right.select(y.hi.ge(zero).select(x.lo, x.hi), up.select(x.lo, x.hi));
    let known = (right | up | down) & ordinary(low_y, low_x) & ordinary(high_y, high_x);
    // Adding zero makes a zero positive: to the right both zeros have the same angle, and no other
    // case gets here.
    let (low, high) = (angle(low_y + zero, low_x), angle(high_y + zero, high_x));
    let slack = |a: F8| a.abs() * ANGLE_ERROR + F8::splat(TINY);
    (low - slack(low), high + slack(high), known)
}

/// The angles of the points `(x, y)` in lanes, and the lanes that must be computed one by one.
#[inline(never)]
pub(crate) fn atan2(y: &I8, x: &I8) -> (I8, u8) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let (lo, hi, known) = corners(y, x);
            (I8::new(lo, hi), !known.bits())
        },
    )
}
