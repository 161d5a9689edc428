//! Planes through three points, and the exact polynomials of planes along rays.

use super::{PlaneForm, Quick, cross, cross_and_error, dot, origin_from, seen_from};
use crate::{CentredRay, LocalRay, RingRay};
use durer_math::eft::scale2;
use durer_math::{Dyadic, Point3, Ring};
use durer_roots::quadratic::Quadratic;

/// A plane through three points, relative to a centre; its normal is `(b - a) x (c - a)`.
#[derive(Clone, Debug)]
pub(crate) struct ThreePoints {
    pub(crate) points: [Point3; 3],
    pub(crate) centre: Point3,
    pub(crate) scale: i32,
}

impl ThreePoints {
    /// The first point, and the normal, in units of `2^scale`.
    #[inline(always)]
    pub(crate) fn normal<T: Ring>(&self) -> ([T; 3], [T; 3]) {
        let [a, b, c] = self.points;
        (
            seen_from(a, self.centre, self.scale),
            cross(&seen_from(b, a, self.scale), &seen_from(c, a, self.scale)),
        )
    }
}

/// The polynomial `n·(x - p)` along a ray, exactly; `None` if the ray is not exactly known.
pub(crate) fn plane_along(normal: &[Dyadic; 3], p: Point3, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
    let ray = ray.in_ring_from::<Dyadic>(p, 0)?;
    let slope = dot(normal, &ray.d);
    Some(Quadratic { a: Dyadic::exact(0.0), b: Ring::scale2(slope, -1), c: dot(normal, &ray.o) })
}

/// The polynomial of the plane through three points along a ray, exactly; `None` if the ray is not
/// exactly known.
pub(crate) fn plane_through_along(points: [Point3; 3], ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
    let centre = points[0];
    plane_along(&ThreePoints { points, centre, scale: 0 }.normal().1, centre, ray)
}

impl PlaneForm for ThreePoints {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<Quick> {
        let [a, b, c] = self.points;
        let edge = |to: Point3| (to - a).map(|x| scale2(x, -self.scale));
        Some(Quick::new(cross_and_error(edge(b), edge(c)), origin_from(ray, a), (0.0, 0.0), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        dot(&self.normal().1, &ray.d)
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (a, n) = self.normal::<T>();
        let ([x, y, z], [ox, oy, oz], w) = (a, ray.o.clone(), || ray.w.clone());
        Some(dot(&n, &[ox - x * w(), oy - y * w(), oz - z * w()]))
    }
}
