//! Elementary functions with the same bits on every CPU.
//!
//! The C library's `sin`, `pow`, ... are chosen at run time for the CPU at hand and differ in the
//! last place; these stand on the pure-Rust `libm` crate, a port of musl and of CORE-MATH. Its
//! feature `arch` (on by default) replaces only `sqrt`, `fma` and `rint` by machine instructions on
//! x86-64 and ARM64. Those three are correctly rounded, so their bits cannot differ; the functions
//! that call them are otherwise plain IEEE operations in a fixed order. (Only on 32-bit x86 without
//! SSE2 does `arch` reach further, into x87's `exp`; durer does not run there.)
//!
//! None of them has a proven bound, most err by less than 1 ulp: good for shading and for building
//! matrices, which are then the exact data; never for a certified bracket.

use crate::{F8, M8};

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

/// The inverse hyperbolic cosine; NaN below 1.
#[inline]
pub fn acosh(x: f64) -> f64 {
    // Between -2^26 and -2 `libm` makes the logarithm of a rounding error out of it.
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
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

/// `x^y` in lanes, within one part in 10^12 of the true power for positive normal `x`; zero where
/// that is below `2^-1021`.
///
/// With `x = 2^e m` and `m` between the roots of 1/2 and 2, the logarithm is `e + log2 m`, where
/// `ln m = 2 artanh s` with `s = (m - 1) / (m + 1)`; both that series and the one of `2^r` for
/// `|r| <= 1/2` are cut where less than the last place is left. The products with `y` and with
/// `log2 e` err by a few last places of an exponent below 1024. Lanes that are not live hold
/// anything.
#[inline(always)]
pub fn pow_lanes(x: F8, y: f64, live: M8) -> F8 {
    if !live.any() {
        return F8::ZERO;
    }
    const ROOT: u64 = 0x3fe6_a09e_667f_3bcd; // of 1/2, in bits
    const ONE: u64 = 0x3ff0_0000_0000_0000;
    const WHOLE: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52: a sum with it is a whole number, which its last bits say
    let bits = |x: F8, f: fn(u64) -> u64| x.map(|x| f64::from_bits(f(x.to_bits())));
    let e = bits(x, |b| (b.wrapping_add(ONE - ROOT) >> 52) | WHOLE.to_bits()) - F8::splat(WHOLE + 1023.0);
    let m = bits(x, |b| b.wrapping_sub(b.wrapping_sub(ROOT) & (u64::MAX << 52)));
    let s = (m - F8::ONE) / (m + F8::ONE);
    let square = s * s;
    let mut artanh = F8::splat(1.0 / 19.0);
    for k in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        artanh = artanh * square + F8::splat(1.0 / k);
    }
    let t = (e + s * artanh * (2.0 * core::f64::consts::LOG2_E)) * y;
    let rounded = t + F8::splat(WHOLE);
    let r = (t - (rounded - F8::splat(WHOLE))) * core::f64::consts::LN_2;
    let mut power = F8::splat(1.0 / 12.0) * r + F8::ONE;
    for k in [11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        power = power * r * (1.0 / k) + F8::ONE;
    }
    // Half of the power of two is always a normal number.
    let scaled = power * bits(rounded, |b| b.wrapping_add(1022) << 52) * 2.0;
    let scaled = t.lt(F8::splat(1024.0)).select(scaled, F8::splat(f64::INFINITY));
    let scaled = t.ge(F8::splat(-1021.0)).keep(scaled);
    let other = live & !(x.ge(F8::splat(f64::MIN_POSITIVE)) & x.le(F8::splat(f64::MAX)));
    if other.any() { other.select(others(x, y, other), scaled) } else { scaled }
}

/// The powers of what is zero, negative, subnormal, infinite or no number.
#[cold]
#[inline(never)]
fn others(x: F8, y: f64, lanes: M8) -> F8 {
    let mut powers = F8::ZERO;
    for i in lanes.lanes() {
        powers.0[i] = pow(x.0[i], y);
    }
    powers
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

    /// Bits of all functions over many arguments, folded into one number that must never change:
    /// pictures depend on it.
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
        assert!((0..1000).all(|i| acosh(0.999 - f64::from(i * i) * 1e3).is_nan()) && acosh(1.0) == 0.0);
    }

    #[test]
    fn powers_in_lanes_are_powers() {
        let check = |x: F8, y: f64| {
            let all: Vec<F8> = crate::Isa::available()
                .map(|isa| {
                    isa.run_in_lanes(
                        #[inline(always)]
                        || pow_lanes(x, y, M8::ALL),
                    )
                })
                .collect();
            assert!(
                all.iter().all(|p| p.0.map(f64::to_bits) == pow_lanes(x, y, M8::ALL).0.map(f64::to_bits))
            );
            for (got, x) in all[0].0.into_iter().zip(x.0) {
                let want = pow(x, y);
                let low = want < 1e-307 && got <= want;
                assert!(low || got == want || (got - want).abs() <= 1e-12 * want, "{x}^{y}: {got}, {want}");
            }
        };
        let root = core::f64::consts::FRAC_1_SQRT_2;
        for y in [0.5, 2.5, 1.0 / 3.0, 40.1, 1e4, 12345.6, -0.7, -3.0, 1e-9] {
            for k in 1..400 {
                let near = 1.0 - f64::from(k) * 1e-5;
                let x = f64::from(k) * 0.0025;
                check(F8([x, near, 1.0 / near, near.next_up(), root, root.next_down(), 40.0 * x, 1.0]), y);
            }
            check(F8([0.0, f64::INFINITY, 1e-310, f64::MIN_POSITIVE, f64::MAX, 1e-200, 1e200, 1e-30]), y);
        }
        assert!(
            pow_lanes(F8([f64::NAN, -1.0, -0.5, -2.0, 1.0, 1.0, 1.0, 1.0]), 0.5, M8::ALL).0[..4]
                .iter()
                .all(|p| p.is_nan())
        );
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!(powi(3.0, 5), 243.0);
        assert_eq!(powi(2.0, -3), 0.125);
        assert_eq!(powi(7.0, 0), 1.0);
        assert_eq!(powi(-2.0, 3), -8.0);
    }
}
