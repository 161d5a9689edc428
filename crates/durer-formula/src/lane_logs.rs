//! Binary logarithms and powers of two of eight numbers at once, with bounds that are derived, not
//! measured.
//!
//! **Logarithm.** `x = 2^e m` with `m` between the roots of 1/2 and 2, `ln m = 2 artanh s`,
//! `s = (m - 1) / (m + 1)`, `|s| <= 0.1716`. `m - 1` is exact, the sum and the quotient round: `s`
//! has a relative error of `2 u`. The series of `artanh s / s` in `z = s^2 <= 0.02945` is cut after
//! `z^9 / 19`, which omits `z^10 / 21 / (1 - z) < 0.22 u`; all but its first term are below
//! `0.0101`, so that Horner's scheme, fused, errs by `1.1 u`. The product with `s` and the constant
//! `2 log2 e` add `2 u`, the sum with `e` rounds once, and is at least `|log2 m|` where `e` is not
//! zero. Together `6.5 u` of the logarithm; the stated bound is [`LOG2_ERROR`].
//!
//! **Power.** `t = k + f` with an integer `k` and `|f| <= 1/2`, exactly; `r = f ln 2` has a
//! relative error of `2 u`, so `e^r` one of `0.7 u`. The series is cut after `r^13 / 13!`, which
//! omits `0.06 u`; Horner's scheme, fused, errs by `1.5 u` before its last rounding of at most
//! `1.42 u`, of a value of at least 0.707. Together `3.1 u` of the power; the stated bound is
//! [`EXP2_ERROR`].
//!
//! **Any power.** `x^p = 2^(p e + p log2 m)`: the product `p e` is computed with its error, an
//! integer `k` is subtracted, and the rest has errors of `3.2 u |p|` from the logarithm of `m`, at
//! most 1/2, and of `u |p| / 2 + u` from its own rounding. That makes `(2.6 |p| + 4) u` of the
//! power; the stated bound is [`power_error`].

use durer_math::{F8, U};

/// Bound on the error of [`log2`], relative to the logarithm.
pub const LOG2_ERROR: f64 = 8.0 * U;
/// Bound on the error of [`exp2`], relative to the power.
pub const EXP2_ERROR: f64 = 4.0 * U;

/// The largest exponent for [`power`].
pub const MOST_POWER: f64 = 512.0;

/// A sum with this is rounded to an integer, whose value is in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// The root of 1/2, and 1, in bits.
const ROOT: u64 = 0x3fe6_a09e_667f_3bcd;
const ONE: u64 = 0x3ff0_0000_0000_0000;

/// The reciprocals of the odd numbers from 19 down to 1: `artanh s = s (1 + s^2/3 + s^4/5 + ...)`.
const ARTANH: [f64; 10] = [
    1.0 / 19.0,
    1.0 / 17.0,
    1.0 / 15.0,
    1.0 / 13.0,
    1.0 / 11.0,
    1.0 / 9.0,
    1.0 / 7.0,
    1.0 / 5.0,
    1.0 / 3.0,
    1.0,
];

/// The reciprocals of the factorials from 13 down to 0.
const EXP: [f64; 14] = [
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

/// Bound on the error of [`power`], relative to the power.
#[inline(always)]
#[must_use]
pub fn power_error(p: f64) -> f64 {
    (p.abs() * 4.0 + 8.0) * U
}

/// `x = 2^e m`: the exponent, and half the natural logarithm of `m`: `artanh s`.
#[inline(always)]
fn split(x: F8) -> (F8, F8) {
    let (mut e, mut m) = (F8::ZERO, F8::ZERO);
    for i in 0..8 {
        let b = x.0[i].to_bits();
        e.0[i] = f64::from_bits((b.wrapping_add(ONE - ROOT) >> 52) | WHOLE.to_bits());
        m.0[i] = f64::from_bits(b.wrapping_sub(b.wrapping_sub(ROOT) & (u64::MAX << 52)));
    }
    let e = e - F8::splat(WHOLE + 1023.0);
    let s = (m - F8::ONE) / (m + F8::ONE);
    let z = s * s;
    let mut series = F8::splat(ARTANH[0]);
    for c in &ARTANH[1..] {
        series = series.mul_add(z, F8::splat(*c));
    }
    (e, s * series)
}

/// Two to the power `k + f`; the last bits of `rounded` are the integer `k`.
#[inline(always)]
fn raised(rounded: F8, f: F8) -> F8 {
    let r = f * core::f64::consts::LN_2;
    let mut series = F8::splat(EXP[0]);
    for c in &EXP[1..] {
        series = series.mul_add(r, F8::splat(*c));
    }
    // A number's exponent bits are k + 1023.
    let mut power = F8::ZERO;
    for i in 0..8 {
        power.0[i] = f64::from_bits(rounded.0[i].to_bits().wrapping_add(1023) << 52);
    }
    series * power
}

/// The logarithms to base 2 of eight positive normal numbers, within [`LOG2_ERROR`]; arbitrary for
/// other arguments.
#[inline(always)]
#[must_use]
pub fn log2(x: F8) -> F8 {
    let (e, half) = split(x);
    half.mul_add(F8::splat(2.0 * core::f64::consts::LOG2_E), e)
}

/// Two to the power of eight numbers from -1020 to 1020, within [`EXP2_ERROR`]; arbitrary for other
/// arguments.
#[inline(always)]
#[must_use]
pub fn exp2(t: F8) -> F8 {
    let rounded = t + F8::splat(WHOLE);
    raised(rounded, t - (rounded - F8::splat(WHOLE)))
}

/// `x^p` for eight positive normal numbers and exponents of magnitude up to [`MOST_POWER`], within
/// [`power_error`], and the exponent to base 2, rounded: where that is not within 1010 the power is
/// arbitrary.
#[inline(always)]
#[must_use]
pub fn power(x: F8, p: F8) -> (F8, F8) {
    let (e, half) = split(x);
    let y = half * (2.0 * core::f64::consts::LOG2_E);
    let high = p * e;
    let low = p.mul_add(e, -high);
    let t = p.mul_add(y, high);
    let rounded = t + F8::splat(WHOLE);
    let f = (high - (rounded - F8::splat(WHOLE))) + p.mul_add(y, low);
    (raised(rounded, f), t)
}
