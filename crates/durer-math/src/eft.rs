//! Error-free transforms: a rounded result together with its exact rounding error.
//!
//! T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math.
//! 18 (1971); D. E. Knuth, The Art of Computer Programming, vol. 2; T. Ogita, S. M. Rump, S. Oishi,
//! "Accurate sum and dot product", SIAM J. Sci. Comput. 26 (2005). All are exact barring overflow;
//! [`two_prod`] also needs the product's low part not to underflow.

/// `(s, e)` with `s = fl(a + b)` and `s + e = a + b` exactly.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let bb = s - a;
    (s, (a - (s - bb)) + (b - bb))
}

/// As [`two_sum`], for `|a| >= |b|` or `a == 0`.
#[inline(always)]
pub fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `(d, e)` with `d = fl(a - b)` and `d + e = a - b` exactly.
#[inline(always)]
pub fn two_diff(a: f64, b: f64) -> (f64, f64) {
    two_sum(a, -b)
}

/// `(p, e)` with `p = fl(a * b)` and `p + e = a * b` exactly.
#[inline(always)]
pub fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    (p, a.mul_add(b, -p))
}

/// `a b - c d` within 1.5 ulp (Kahan).
///
/// Jeannerod, Louvet, Muller, "Further analysis of Kahan's algorithm for the accurate computation
/// of 2x2 determinants", Mathematics of Computation 82 (2013).
#[inline(always)]
pub fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let w = c * d;
    let e = (-c).mul_add(d, w);
    let f = a.mul_add(b, -w);
    f + e
}

/// `x * 2^exponent`, exact unless the result leaves the range of normal numbers.
#[inline(always)]
pub fn scale2(x: f64, exponent: i32) -> f64 {
    if (-1022..=1023).contains(&exponent) {
        x * f64::from_bits(((exponent + 1023) as u64) << 52)
    } else {
        libm::ldexp(x, exponent)
    }
}

/// `floor(log2 |x|)` for a normal `x`; at most -1023 for subnormal numbers and zero.
#[inline(always)]
pub fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023
}
