//! Vector arithmetic for shading.
//!
//! The certified kernels use fused operations. Shading needs no bounds: unfused products and sums
//! have the same bits on every CPU, and need no library call where the compiler may not assume a
//! fused unit.

use durer_math::{F8, Scalar, Vec3};

#[inline(always)]
pub(crate) fn dot<T: Scalar>(a: Vec3<T>, b: Vec3<T>) -> T {
    a.x * b.x + a.y * b.y + a.z * b.z
}

#[inline(always)]
pub(crate) fn length<T: Scalar>(v: Vec3<T>) -> T {
    dot(v, v).sqrt()
}

/// `v` scaled to length 1; unchanged if it is too short or too long for that.
#[inline(always)]
pub(crate) fn unit(v: Vec3) -> Vec3 {
    let length = length(v);
    if length > 0.0 && length.is_finite() { v * (1.0 / length) } else { v }
}

/// The direction `d` (of any length), mirrored in a plane with unit normal `n`.
#[inline(always)]
pub(crate) fn reflect<T: Scalar>(d: Vec3<T>, n: Vec3<T>) -> Vec3<T> {
    d - n * (T::from(2.0) * dot(d, n))
}

/// [`floor`] of a large number.
#[cold]
fn by_parts(x: f64) -> f64 {
    if x.abs() < 9_007_199_254_740_992.0 {
        let cut = (x as i64) as f64;
        if cut > x { cut - 1.0 } else { cut }
    } else {
        x
    }
}

/// The largest integer not above `x`.
#[inline(always)]
pub(crate) fn floor(x: f64) -> f64 {
    // From 2^52 on every f64 is an integer. Below 2^51 the sum below loses only its fraction.
    const EXACT: f64 = (1_u64 << 51) as f64;
    if x.abs() < EXACT {
        let nearest = (x + 3.0 * EXACT) - 3.0 * EXACT;
        if nearest > x { nearest - 1.0 } else { nearest }
    } else {
        by_parts(x)
    }
}

/// The largest integers not above the numbers in the lanes.
#[inline(always)]
pub(crate) fn floor_lanes(x: F8) -> F8 {
    x.map(f64::floor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_is_the_librarys() {
        for x in [
            0.0,
            -0.0,
            0.5,
            -0.5,
            3.0,
            -3.0,
            -1e-300,
            1e300,
            -1e16,
            2.5e9,
            -2.5e9,
            f64::INFINITY,
            2_251_799_813_685_247.5,
            -2_251_799_813_685_247.5,
            4_503_599_627_370_495.5,
        ] {
            assert_eq!(floor(x), x.floor(), "{x}");
        }
        assert!(floor(f64::NAN).is_nan());
    }

    #[test]
    fn a_mirror_turns_the_normal_part_round() {
        let n = Vec3::new(0.0, 1.0, 0.0);
        assert_eq!(reflect(Vec3::new(1.0, -2.0, 3.0), n), Vec3::new(1.0, 2.0, 3.0));
    }
}
