//! Powers of eight intervals at once, with any exponents of one sign.
//!
//! `x^y` is monotone in each operand as long as `x` and `y` keep their signs: the corners of a box
//! hold its extremes, with `y` in the opposite order for `x` below 1. All other cases (bases that
//! may be negative or zero, exponents of either sign or very large) go lane by lane to
//! [`Interval::pow`].

use crate::I8;
use crate::lane_logs::{MOST_POWER, power, power_error};
use durer_math::{F8, Isa, M8, U};

/// The greatest magnitude of the power's binary exponent that is computed; beyond, bounds are zero,
/// infinite, or powers of two near the limit.
const FAR: f64 = 1000.0;
/// A smaller base is replaced by this where a bound may be too large.
const LEAST: f64 = durer_math::scale::pow2(-1000);
/// Covers results below the normal range.
const TINY: f64 = durer_math::scale::pow2(-1000);

/// Bounds on powers, and the lanes that are computed.
#[inline(always)]
fn corners(a: &I8, b: &I8) -> (F8, F8, M8) {
    let (zero, one) = (F8::ZERO, F8::ONE);
    let (rises, falls) = (b.lo.gt(zero), b.hi.lt(zero));
    let near = b.lo.ge(F8::splat(-MOST_POWER)) & b.hi.le(F8::splat(MOST_POWER));
    let apart = a.lo.ge(F8::splat(LEAST)) & a.hi.le(F8::splat(f64::MAX));
    let known = near & (rises & a.lo.ge(zero) & a.hi.le(F8::splat(f64::MAX)) | falls & apart);
    let from = rises.select(a.lo, a.hi);
    let to = rises.select(a.hi, a.lo);
    let least = from.le(one).select(b.hi, b.lo);
    let most = to.le(one).select(b.lo, b.hi);
    let small = F8::splat(LEAST);
    let (low, t_low) = power(from.max(small), least);
    let (high, t_high) = power(to.max(small), most);
    let (far, slack) = (F8::splat(FAR), F8::splat(TINY));
    let error = |p: F8| p.map(|p| power_error(p) + 4.0 * U);
    let lo = (low - (low * error(least) + slack)).max(zero);
    let hi = high + (high * error(most) + slack);
    // Exponents beyond the limit, and bases below theirs.
    let lo = (t_low.le(-far) | from.lt(small))
        .select(zero, t_low.ge(far).select(F8::splat(durer_math::scale::pow2(999)), lo));
    let hi = t_high.ge(far).select(
        F8::splat(f64::INFINITY),
        t_high.le(-far).select(F8::splat(durer_math::scale::pow2(-999)), hi),
    );
    let nothing = to.equals(zero) & rises;
    (lo, nothing.select(zero, hi), known)
}

/// `a^b`, rounded, and the lanes that are computed.
#[inline(always)]
pub(crate) fn rounded(a: F8, b: F8) -> (F8, M8) {
    let (value, t) = power(a, b);
    let ordinary = a.ge(F8::splat(LEAST)) & a.le(F8::splat(f64::MAX));
    (value, ordinary & b.abs().le(F8::splat(MOST_POWER)) & t.abs().lt(F8::splat(FAR)))
}

/// `a^b` in lanes, and the lanes that must be computed one by one.
#[inline(never)]
pub(crate) fn pow(a: &I8, b: &I8) -> (I8, u8) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let (lo, hi, known) = corners(a, b);
            (I8::new(lo, hi), !known.bits())
        },
    )
}
