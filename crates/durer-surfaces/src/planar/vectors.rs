//! Vectors in rings, and vectors in f64 with bounds on their errors.

use super::TINY;
use crate::{CentredRay, RingRay};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, EFloat, Normal3, Point3, Ring, U, Vec3};

/// The exact vector `v` in a ring, as three numbers.
#[inline(always)]
pub(crate) fn exact3<T: Ring>(v: Vec3) -> [T; 3] {
    [T::exact(v.x), T::exact(v.y), T::exact(v.z)]
}

/// The dot product in a ring.
#[inline(always)]
pub(crate) fn dot<T: Ring>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
}

/// The cross product in a ring.
#[inline(always)]
pub(crate) fn cross<T: Ring>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    // A closure could be compiled by itself, without fused operations.
    #[inline(always)]
    fn minor<T: Ring>(a: &[T; 3], b: &[T; 3], i: usize, j: usize) -> T {
        a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone()
    }
    [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)]
}

/// The exact point `p` relative to `centre` in units of `2^scale`.
#[inline(always)]
pub(crate) fn seen_from<T: Ring>(p: Point3, centre: Point3, scale: i32) -> [T; 3] {
    #[inline(always)]
    fn axis<T: Ring>(p: f64, c: f64, scale: i32) -> T {
        (T::exact(p) - T::exact(c)).scale2(-scale)
    }
    [axis(p.x, centre.x, scale), axis(p.y, centre.y, scale), axis(p.z, centre.z, scale)]
}

/// The vector `v` times `w` in a ring.
#[inline(always)]
pub(crate) fn times<T: Ring>([x, y, z]: [T; 3], w: &T) -> [T; 3] {
    [x * w.clone(), y * w.clone(), z * w.clone()]
}

/// `a - b` in a ring.
#[inline(always)]
pub(crate) fn minus<T: Ring>([x, y, z]: [T; 3], [a, b, c]: [T; 3]) -> [T; 3] {
    [x - a, y - b, z - c]
}

/// The vector from a ray's point at `s = 0` to `v`, times the ray's `w`; the ray is relative to
/// `centre` in units of `2^scale`.
#[inline(always)]
pub(crate) fn towards<T: Ring>(ray: &RingRay<T>, v: Point3, centre: Point3, scale: i32) -> [T; 3] {
    minus(times(seen_from(v, centre, scale), &ray.w), ray.o.clone())
}

/// The cross product of two vectors whose components were rounded at most once, and a bound on its
/// error per component.
#[inline(always)]
pub(crate) fn cross_and_error(a: Vec3, b: Vec3) -> (Vec3, Vec3) {
    let (p, q) = (a.abs(), b.abs());
    // A product of two such components has an error of slightly more than 2u; Kahan's minor of 1.5
    // ulp of the difference.
    let err =
        |i: usize, j: usize| (p[i].mul_add(q[j], p[j] * q[i])).mul_add(6.0 * U * (1.0 + 16.0 * U), TINY);
    (a.cross(b), Vec3::new(err(1, 2), err(2, 0), err(0, 1)))
}

/// The ray's origin relative to a point, and a bound on its error per axis.
#[inline(always)]
pub(crate) fn origin_from(ray: &CentredRay<'_>, p: Point3) -> (Vec3, Vec3) {
    let p = (p - ray.centre).map(|x| scale2(x, -ray.scale));
    let q = ray.o - p;
    let err = |i: usize| (p[i].abs() + q[i].abs()).mul_add(U * (1.0 + 8.0 * U), ray.o_err[i] + TINY);
    (q, Vec3::new(err(0), err(1), err(2)))
}

/// A lower bound of a vector's length; zero if there is no better one.
#[inline(always)]
pub(crate) fn least_length(n: [EFloat; 3]) -> f64 {
    let least = n.map(|x| (x.v.abs() - x.e).max(0.0));
    Vec3::from(least).length() * (1.0 - 8.0 * U)
}

/// The middle of a box that is not empty, rounded, and half its largest width.
#[inline(always)]
pub(crate) fn middle(b: &Aabb) -> (Point3, f64) {
    // Halves first, to prevent overflow.
    let (min, max) = (b.min.map(|x| 0.5 * x), b.max.map(|x| 0.5 * x));
    (min + max.to_vec(), (max - min).max_abs())
}

/// The unit normal of a vector whose largest component is in [1, 2) in magnitude; each component
/// within 4u, relatively.
#[inline(always)]
pub(crate) fn unit(n: Vec3) -> Normal3 {
    (n / n.length()).to_normal()
}

/// A vector scaled by a power of two so that its largest component is in [1, 2) in magnitude;
/// `None` if it is zero or not finite. Components more than `2^1022` below the largest may lose
/// bits.
pub(crate) fn scaled_to_one(n: Vec3) -> Option<Vec3> {
    if !n.is_finite() || n == Vec3::ZERO {
        return None;
    }
    let k = exponent(n.max_abs());
    let up = if k < -1022 { 60 } else { 0 };
    let n = n.map(|x| scale2(x, up));
    let k = exponent(n.max_abs());
    Some(n.map(|x| scale2(x, -k)))
}
