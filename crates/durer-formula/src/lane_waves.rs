//! Sines and cosines of eight intervals at once.
//!
//! The argument is reduced by integer multiples of a quarter turn: `r = x - k pi/2` with `pi/2` in
//! three parts of 25, 24 and 53 bits (W. J. Cody, W. Waite, *Software Manual for the Elementary
//! Functions*, 1980). For `|x| <= 2^20` the products with the first two parts are exact, and so are
//! the differences, multiples of `2^-53` below 1; the third rounds to `2^-54`, and the rest of
//! `pi/2` is below `2^-88`. On `|r| <= 0.7855` Taylor's series to `r^17` and `r^18` omit less than
//! `1e-19`, and Horner's scheme rounds to less than `4 u` of the value. The stated bounds are
//! [`RELATIVE`] and [`ABSOLUTE`], twice as much at least.

use crate::I8;
use durer_math::{F8, M8};

/// The largest argument that is reduced; beyond, the bounds are -1 and 1.
const FAR: f64 = (1u64 << 20) as f64;
/// Bound on the error, relative to the value: `8 u`.
const RELATIVE: f64 = 8.0 * durer_math::U;
/// Bound on the error of the argument's reduction, if there is one.
const ABSOLUTE: f64 = 2.0 * durer_math::U;
/// Covers results below the normal range.
const TINY: f64 = durer_math::scale::pow2(-1000);
/// A quarter turn: the first 25 bits, the next 24, and the rest.
const PARTS: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5000_0000),
    f64::from_bits(0x3e51_10b4_6000_0000),
    f64::from_bits(0x3c91_a626_3314_5c07),
];
/// A sum with this is rounded to an integer.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// A reduced argument: sine and cosine of the rest, and the integer number of quarter turns.
struct Turned {
    sine: F8,
    cosine: F8,
    k: F8,
}

/// Reduces arguments; the result of lanes beyond [`FAR`] is arbitrary.
#[inline(always)]
fn turned(x: &F8) -> Turned {
    let mut out = Turned { sine: F8::ZERO, cosine: F8::ZERO, k: F8::ZERO };
    for i in 0..8 {
        let x = x.0[i];
        let k = (x * core::f64::consts::FRAC_2_PI + WHOLE) - WHOLE;
        let r = (-k).mul_add(PARTS[2], (-k).mul_add(PARTS[1], (-k).mul_add(PARTS[0], x)));
        let z = r * r;
        let mut s: f64 = 1.0 / 355_687_428_096_000.0;
        s = s.mul_add(z, -1.0 / 1_307_674_368_000.0);
        s = s.mul_add(z, 1.0 / 6_227_020_800.0);
        s = s.mul_add(z, -1.0 / 39_916_800.0);
        s = s.mul_add(z, 1.0 / 362_880.0);
        s = s.mul_add(z, -1.0 / 5040.0);
        s = s.mul_add(z, 1.0 / 120.0);
        s = s.mul_add(z, -1.0 / 6.0);
        out.sine.0[i] = r.mul_add(z * s, r);
        let mut c: f64 = -1.0 / 6_402_373_705_728_000.0;
        c = c.mul_add(z, 1.0 / 20_922_789_888_000.0);
        c = c.mul_add(z, -1.0 / 87_178_291_200.0);
        c = c.mul_add(z, 1.0 / 479_001_600.0);
        c = c.mul_add(z, -1.0 / 3_628_800.0);
        c = c.mul_add(z, 1.0 / 40_320.0);
        c = c.mul_add(z, -1.0 / 720.0);
        c = c.mul_add(z, 1.0 / 24.0);
        out.cosine.0[i] = 1.0 - (0.5 * z - z * (z * c));
        out.k.0[i] = k;
    }
    out
}

/// The sine of the argument plus `shift` quarter turns, and the bound on its error.
#[inline(always)]
fn shifted(turned: &Turned, shift: f64) -> (F8, F8) {
    let (mut value, mut error) = (F8::ZERO, F8::ZERO);
    for i in 0..8 {
        let (sine, cosine, k) = (turned.sine.0[i], turned.cosine.0[i], turned.k.0[i]);
        // The number of the quarter, from 0 to 3, as an f64.
        let q = k + shift;
        let q = q - 4.0 * (q * 0.25).floor();
        let v = if (q == 1.0) | (q == 3.0) { cosine } else { sine };
        let v = if q >= 2.0 { -v } else { v };
        value.0[i] = v;
        error.0[i] = v.abs() * RELATIVE + if k == 0.0 { TINY } else { ABSOLUTE };
    }
    (value, error)
}

/// Rounded sines (`shift` 0) or cosines (1), and the lanes that are computed.
#[inline(always)]
pub(crate) fn rounded(x: &F8, shift: f64) -> (F8, M8) {
    (shifted(&turned(x), shift).0, x.abs().le(F8::splat(FAR)))
}

/// Rounded sines and cosines, and the lanes that are computed.
#[inline(always)]
pub(crate) fn both_rounded(x: &F8) -> (F8, F8, M8) {
    let turned = turned(x);
    (shifted(&turned, 0.0).0, shifted(&turned, 1.0).0, x.abs().le(F8::splat(FAR)))
}

/// The sine of intervals plus `shift` quarter turns: 0 for the sine, 1 for the cosine.
#[inline(always)]
pub(crate) fn wave(a: &I8, shift: f64) -> I8 {
    between(a, (&turned(&a.lo), &turned(&a.hi)), shift)
}

/// The sine and the cosine of intervals.
#[inline(always)]
pub(crate) fn waves(a: &I8) -> (I8, I8) {
    let ends = (&turned(&a.lo), &turned(&a.hi));
    (between(a, ends, 0.0), between(a, ends, 1.0))
}

#[inline(always)]
fn between(a: &I8, (lo, hi): (&Turned, &Turned), shift: f64) -> I8 {
    // More than the error of an argument's quotient by a quarter turn. A needless crest widens the
    // result only a little.
    const MARGIN: f64 = 1.0 / (1u64 << 26) as f64;
    let mut out = *a;
    let (from, e_from) = shifted(lo, shift);
    let (to, e_to) = shifted(hi, shift);
    for i in 0..8 {
        let (lo, hi) = (a.lo.0[i], a.hi.0[i]);
        let first = lo * core::f64::consts::FRAC_2_PI + (shift - MARGIN);
        let last = hi * core::f64::consts::FRAC_2_PI + (shift + MARGIN);
        // Crests are at 1 + 4 m quarter turns, troughs at 3 + 4 m.
        let crest = 4.0 * ((first - 1.0) * 0.25).ceil() + 1.0 <= last;
        let trough = 4.0 * ((first - 3.0) * 0.25).ceil() + 3.0 <= last;
        let far = (lo < -FAR) | (hi > FAR);
        let (s, t) = (from.0[i], to.0[i]);
        let low = if s - e_from.0[i] < t - e_to.0[i] { s - e_from.0[i] } else { t - e_to.0[i] };
        let high = if s + e_from.0[i] > t + e_to.0[i] { s + e_from.0[i] } else { t + e_to.0[i] };
        out.lo.0[i] = if trough | far | (low < -1.0) { -1.0 } else { low };
        out.hi.0[i] = if crest | far | (high > 1.0) { 1.0 } else { high };
    }
    out
}
