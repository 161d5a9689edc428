//! A plane across the axis of a solid of revolution, or of a sweep.

use crate::planar::{self, AlongRay, Line, PlaneForm, Probe};
use crate::{CentredRay, RingRay};
use core::cmp::Ordering;
use durer_math::{Dyadic, Point3, Ring, Vec3};
use durer_roots::quadratic::{self, Quadratic};

/// The plane at a height, its normal upward.
pub(crate) struct HeightPlane {
    pub(crate) height: f64,
    /// The height of the frame's centre, and its unit.
    pub(crate) centre: f64,
    pub(crate) scale: i32,
}

/// How far the start of a ray is above the plane.
impl AlongRay for HeightPlane {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        self.height(ray)
    }
}

impl PlaneForm for HeightPlane {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<planar::Quick> {
        let at = Point3::new(0.0, self.height, 0.0);
        Some(planar::Quick::new((Vec3::Y, Vec3::ZERO), planar::origin_from(ray, at), (0.0, 0.0), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        ray.d[1].clone()
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let level = (T::exact(self.height) - T::exact(self.centre)).scale2(-self.scale);
        Some(ray.o[1].clone() - level * ray.w.clone())
    }
}

impl HeightPlane {
    /// The exact sign of a quadratic at the point where an exact ray passes this height.
    pub(crate) fn sign_at_root(&self, ray: &RingRay<Dyadic>, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let (slope, height) = (self.slope(ray).scale2(-1), self.height(ray)?);
        let p = Quadratic { a: Dyadic::exact(0.0), b: slope, c: height };
        let rises = p.b.exact_sign().is_gt();
        let crossing = if rises { quadratic::Crossing::Out } else { quadratic::Crossing::In };
        Some(quadratic::sign_at_root(&p, crossing, q))
    }

    /// The exact ray with its start moved to this height, times a positive number.
    pub(super) fn passing(&self, probe: &Probe<'_>) -> Option<RingRay<Dyadic>> {
        let ray = probe.exact()?;
        let (mut height, mut slope) = (self.height(&ray)?, self.slope(&ray));
        if slope.exact_sign().is_lt() {
            (height, slope) = (-height, -slope);
        }
        let o = [0, 1, 2].map(|i| ray.o[i].clone() * slope.clone() - ray.d[i].clone() * height.clone());
        let d = ray.d.map(|d| d * slope.clone());
        Some(RingRay { o, d, w: ray.w * slope })
    }
}
