//! Sums, products, quotients and square roots rounded down or up, without touching the CPU's
//! rounding mode.
//!
//! The rounded result and the *sign* of its exact error tell whether to step to the neighbour. The
//! error comes from an error-free transform; where its low part could underflow the operands are
//! first scaled by powers of two, so that the results are correctly directed for all finite
//! operands: the greatest f64 not above (least not below) the exact result. With infinite operands
//! the results still bound. NaN in, NaN out.

use crate::eft::{two_prod, two_sum};
use crate::scale::{exponent, ldexp};

/// Below this a product's error term may be subnormal: `2^-1022 * 2^53`, and then some.
const SMALL: f64 = f64::from_bits((1023 - 960) << 52);
/// Above this a scaled residual could overflow.
const LARGE: f64 = f64::from_bits((1023 + 960) << 52);

/// `s` or the next number below, if the exact result lies below `s`; a NaN error says "perhaps".
#[inline(always)]
fn down(s: f64, error: f64) -> f64 {
    if error >= 0.0 { s } else { s.next_down() }
}

#[inline(always)]
fn up(s: f64, error: f64) -> f64 {
    if error <= 0.0 { s } else { s.next_up() }
}

/// `a + b` rounded down.
#[inline(always)]
pub fn add_down(a: f64, b: f64) -> f64 {
    let (s, e) = two_sum(a, b);
    down(s, e)
}

/// `a + b` rounded up.
#[inline(always)]
pub fn add_up(a: f64, b: f64) -> f64 {
    let (s, e) = two_sum(a, b);
    up(s, e)
}

/// `a - b` rounded down.
#[inline(always)]
pub fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// `a - b` rounded up.
#[inline(always)]
pub fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// A product and a number with the sign of its error.
#[inline(always)]
fn product(a: f64, b: f64) -> (f64, f64) {
    let (p, e) = two_prod(a, b);
    if p.abs() > SMALL { (p, e) } else { small_product(a, b, p) }
}

#[cold]
fn small_product(a: f64, b: f64, p: f64) -> (f64, f64) {
    if p.is_nan() || a == 0.0 || b == 0.0 {
        return (p, if p.is_nan() { f64::NAN } else { 0.0 });
    }
    let (ka, kb) = (exponent(a), exponent(b));
    (p, ldexp(a, -ka).mul_add(ldexp(b, -kb), -ldexp(p, -ka - kb)))
}

/// `a b` rounded down.
#[inline(always)]
pub fn mul_down(a: f64, b: f64) -> f64 {
    let (p, e) = product(a, b);
    down(p, e)
}

/// `a b` rounded up.
#[inline(always)]
pub fn mul_up(a: f64, b: f64) -> f64 {
    let (p, e) = product(a, b);
    up(p, e)
}

/// A quotient and a number with the sign of its error.
#[inline(always)]
fn quotient(a: f64, b: f64) -> (f64, f64) {
    let q = a / b;
    let in_range = |x: f64| x.abs() > SMALL && x.abs() < LARGE;
    if in_range(a) && in_range(b) && in_range(q) {
        let r = (-q).mul_add(b, a);
        return (q, if b > 0.0 { r } else { -r });
    }
    wild_quotient(a, b, q)
}

#[cold]
fn wild_quotient(a: f64, b: f64, q: f64) -> (f64, f64) {
    if a == 0.0 && b != 0.0 && !b.is_nan() {
        return (q, 0.0);
    }
    if !a.is_finite() || !b.is_finite() || b == 0.0 || q.is_infinite() {
        // Infinite operands: a step inward from an infinity, or from zero, still bounds.
        return (q, f64::NAN);
    }
    let (ka, kb) = (exponent(a), exponent(b));
    let (a, b) = (ldexp(a, -ka), ldexp(b, -kb));
    // q 2^(kb - ka) lies near 1, or is a subnormal scaled up: exact.
    let r = (-ldexp(q, kb - ka)).mul_add(b, a);
    (q, if b > 0.0 { r } else { -r })
}

/// `a / b` rounded down.
#[inline(always)]
pub fn div_down(a: f64, b: f64) -> f64 {
    let (q, e) = quotient(a, b);
    down(q, e)
}

/// `a / b` rounded up.
#[inline(always)]
pub fn div_up(a: f64, b: f64) -> f64 {
    let (q, e) = quotient(a, b);
    up(q, e)
}

/// A square root and a number with the sign of its error.
#[inline(always)]
fn root(a: f64) -> (f64, f64) {
    if a > SMALL && a < f64::INFINITY {
        let s = a.sqrt();
        return (s, (-s).mul_add(s, a));
    }
    small_root(a)
}

#[cold]
fn small_root(a: f64) -> (f64, f64) {
    let s = a.sqrt();
    if a == 0.0 || a == f64::INFINITY {
        return (s, 0.0);
    }
    let (a, s1) = (ldexp(a, 600), ldexp(s, 300));
    (s, (-s1).mul_add(s1, a))
}

/// The square root of `a` rounded down; NaN for negative `a`.
#[inline(always)]
pub fn sqrt_down(a: f64) -> f64 {
    let (s, e) = root(a);
    down(s, e)
}

/// The square root of `a` rounded up; NaN for negative `a`.
#[inline(always)]
pub fn sqrt_up(a: f64) -> f64 {
    let (s, e) = root(a);
    up(s, e)
}
