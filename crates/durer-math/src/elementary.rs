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

    /// The bits were computed once and must never change: pictures depend on them.
    #[test]
    fn bits_are_pinned() {
        let (s, c) = sin_cos(0.7);
        assert_eq!((s, c), (sin(0.7), cos(0.7)));
        assert!((s - 0.644_217_687_237_691_1).abs() < 1e-15);
        assert!((exp(1.0) - core::f64::consts::E).abs() < 1e-15);
        assert!((ln(10.0) - core::f64::consts::LN_10).abs() < 1e-15);
        assert_eq!(pow(2.0, 0.5), core::f64::consts::SQRT_2);
        assert_eq!(cbrt(27.0), 3.0);
        assert_eq!(hypot(3.0, 4.0), 5.0);
        assert_eq!(atan2(0.0, -1.0), core::f64::consts::PI);
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!(powi(3.0, 5), 243.0);
        assert_eq!(powi(2.0, -3), 0.125);
        assert_eq!(powi(7.0, 0), 1.0);
        assert_eq!(powi(-2.0, 3), -8.0);
    }
}
