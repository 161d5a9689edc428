//! Exact scaling by powers of two.

/// `2^k` for `k` in `[-1022, 1023]`.
#[inline(always)]
pub const fn pow2(k: i32) -> f64 {
    debug_assert!(k >= -1022 && k <= 1023);
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// `x * 2^k`, rounded once: exact unless the result overflows or is subnormal.
#[inline(always)]
pub fn ldexp(x: f64, k: i32) -> f64 {
    if (-1022..=1023).contains(&k) {
        return x * pow2(k);
    }
    libm::scalbn(x, k)
}

/// The `e` with `2^e <= |x| < 2^(e+1)`, for finite `x` other than zero; subnormal `x` included.
#[inline]
pub const fn exponent(x: f64) -> i32 {
    let bits = x.to_bits() & !(1 << 63);
    let field = (bits >> 52) as i32;
    if field == 0 { -1011 - bits.leading_zeros() as i32 } else { field - 1023 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_and_powers_fit_together() {
        for k in -1022..=1023 {
            assert_eq!(exponent(pow2(k)), k);
            assert_eq!(exponent(pow2(k).next_up()), k);
        }
        assert_eq!(exponent(5e-324), -1074);
        assert_eq!(exponent(f64::MIN_POSITIVE.next_down()), -1023);
        assert_eq!(ldexp(5e-324, 1074), 1.0);
        assert_eq!(ldexp(1.0, -1074), 5e-324);
        assert_eq!(ldexp(ldexp(1.5, 900), -1800), ldexp(1.5, -900));
    }
}
