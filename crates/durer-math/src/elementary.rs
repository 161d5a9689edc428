//! Elementary functions with the same bits on every CPU.
//!
//! The C library's `sin`, `pow`, ... are chosen at run time for the CPU at hand and differ in the last place; these stand
//! on the pure-Rust `libm` crate, a port of musl and of CORE-MATH. Its feature `arch` (on by default) replaces only `sqrt`, `fma`
//! and `rint` by machine instructions on x86-64 and ARM64. Those three are correctly rounded, so their bits cannot
//! differ; the functions that call them are otherwise plain IEEE operations in a fixed order. (Only on 32-bit x86 without SSE2
//! does `arch` reach further, into x87's `exp`; durer does not run there.)
//!
//! None of them has a proven bound, most err by less than 1 ulp: good for shading and for building
//! matrices, which are then the exact data; never for a certified bracket.

macro_rules! one {
    ($($(#[$doc:meta])* $name:ident = $libm:ident;)*) => {$(
        $(#[$doc])*
        #[inline]
        pub fn $name(x: f64) -> f64 {
            libm::$libm(x)
        }
    )*};
}

one! {
    /// The sine of `x` radians.
    sin = sin;
    /// The cosine of `x` radians.
    cos = cos;
    /// The tangent of `x` radians.
    tan = tan;
    /// The angle in `[-pi/2, pi/2]` whose sine is `x`; NaN outside `[-1, 1]`.
    asin = asin;
    /// The angle in `[0, pi]` whose cosine is `x`; NaN outside `[-1, 1]`.
    acos = acos;
    /// The angle in `[-pi/2, pi/2]` whose tangent is `x`.
    atan = atan;
    /// The hyperbolic sine.
    sinh = sinh;
    /// The hyperbolic cosine.
    cosh = cosh;
    /// The hyperbolic tangent.
    tanh = tanh;
    /// The inverse hyperbolic sine.
    asinh = asinh;
    /// The inverse hyperbolic cosine; NaN below 1.
    acosh = acosh;
    /// The inverse hyperbolic tangent; NaN outside `[-1, 1]`.
    atanh = atanh;
    /// `e^x`.
    exp = exp;
    /// `2^x`.
    exp2 = exp2;
    /// `e^x - 1`, accurate near 0.
    exp_m1 = expm1;
    /// The natural logarithm; NaN for negative `x`.
    ln = log;
    /// `ln(1 + x)`, accurate near 0.
    ln_1p = log1p;
    /// The logarithm to base 2.
    log2 = log2;
    /// The logarithm to base 10.
    log10 = log10;
    /// The cube root.
    cbrt = cbrt;
    /// The largest whole number not above `x`.
    floor = floor;
    /// The smallest whole number not below `x`.
    ceil = ceil;
}

/// The sine and the cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// The angle of the point `(x, y)`, in `[-pi, pi]`.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `x^y`, with IEEE 754's special cases.
#[inline]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// `x^n` by repeated squaring; at most `2 log2 |n|` roundings, and one more for a negative `n`.
#[inline]
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut result, mut power, mut left) = (1.0, x, n.unsigned_abs());
    while left != 0 {
        if left & 1 == 1 {
            result *= power;
        }
        power *= power;
        left >>= 1;
    }
    if n < 0 { 1.0 / result } else { result }
}

/// `sqrt(x^2 + y^2)` without needless over- or underflow.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PINNED: u64 = 0x694b_16fa_cc6e_c32d;

    /// Bits of all functions over many arguments, folded into one number that must never change: pictures depend on it.
    #[test]
    fn bits_are_pinned() {
        let mut hash = 0_u64;
        let mut fold = |x: f64| {
            // NaNs have many forms; one stands for all.
            let bits = if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
            hash = hash.rotate_left(5).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ bits;
        };
        let functions = [
            sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, exp, exp2, exp_m1, ln,
            ln_1p, log2, log10, cbrt, floor, ceil,
        ];
        for i in -500..=500 {
            let x = f64::from(i) * 0.013;
            functions.iter().for_each(|f| fold(f(x)));
            fold(atan2(x, 0.7));
            fold(pow(x.abs(), 1.7));
            fold(hypot(x, 0.3));
            fold(powi(x, 5));
            assert_eq!(sin_cos(x), (sin(x), cos(x)));
        }
        assert_eq!(hash, PINNED, "{hash:#018x}");
    }

    /// Known values, so that what is pinned is also right.
    #[test]
    fn known_values() {
        use core::f64::consts::{E, FRAC_PI_6, LN_10, PI, SQRT_2};
        let near = |x: f64, y: f64| (x - y).abs() <= 2.0 * f64::EPSILON * y.abs();
        assert!(near(sin(FRAC_PI_6), 0.5) && near(cos(PI), -1.0) && near(tan(PI / 4.0), 1.0));
        assert!(near(asin(0.5), FRAC_PI_6) && near(acos(-1.0), PI) && near(atan(1.0), PI / 4.0));
        assert!(
            near(exp(1.0), E) && near(ln(10.0), LN_10) && near(log10(1000.0), 3.0) && near(log2(8.0), 3.0)
        );
        assert!(near(exp2(0.5), SQRT_2) && near(pow(2.0, 0.5), SQRT_2) && near(cbrt(27.0), 3.0));
        assert!(near(exp_m1(1e-10), 1e-10 + 5e-21) && near(ln_1p(1e-10), 1e-10 - 5e-21));
        assert!(near(sinh(1.0) + cosh(1.0), E) && near(tanh(atanh(0.5)), 0.5));
        assert!(near(sinh(asinh(3.0)), 3.0) && near(cosh(acosh(3.0)), 3.0));
        assert!(near(hypot(3.0, 4.0), 5.0) && near(atan2(0.0, -1.0), PI));
        assert_eq!((floor(-1.5), ceil(-1.5)), (-2.0, -1.0));
        assert!(acos(2.0).is_nan() && ln(-1.0).is_nan());
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!(powi(3.0, 5), 243.0);
        assert_eq!(powi(2.0, -3), 0.125);
        assert_eq!(powi(7.0, 0), 1.0);
        assert_eq!(powi(-2.0, 3), -8.0);
    }
}
