//! A point in a surface's frame, and how it came there.

use super::{LocalRay, TINY, relative, through_inverse};
use durer_math::eft::scale2;
use durer_math::{Affine, Point3, Ring, Vec3};

/// A point in a surface's frame, within `p_err` (per axis), and exact on demand.
#[derive(Clone, Copy, Debug)]
pub struct LocalPoint<'a> {
    /// The coordinates.
    pub p: Point3,
    /// Per-axis bound on their error.
    pub p_err: Vec3,
    origin: PointOrigin<'a>,
}

/// How a local point came to be.
#[derive(Clone, Copy, Debug)]
enum PointOrigin<'a> {
    /// `p` was given.
    Given,
    /// The parent's point, through the inverse of an affine map.
    Placed(&'a LocalPoint<'a>, &'a Affine),
    /// The ray's point at this parameter.
    Along(&'a LocalRay<'a>, f64),
}

impl LocalPoint<'static> {
    /// The point itself, in the frame in which it is given.
    pub fn new(p: Point3) -> Self {
        Self { p, p_err: Vec3::ZERO, origin: PointOrigin::Given }
    }
}

impl<'a> LocalPoint<'a> {
    /// The ray's point `o + s d`, with `s` in the ray's own parameter: exactly on the ray.
    #[inline(always)]
    pub fn along(ray: &'a LocalRay<'a>, s: f64) -> Self {
        let (x, e) = ray.moved(Point3::ORIGIN, s);
        Self { p: x.to_point(), p_err: e, origin: PointOrigin::Along(ray, s) }
    }

    /// The point in the frame of a surface that `affine` places.
    #[inline(always)]
    pub fn through(&'a self, affine: &'a Affine) -> LocalPoint<'a> {
        let (x, e) = relative(self.p, self.p_err, affine.centre());
        let (x, e) = through_inverse(affine, x, e);
        LocalPoint { p: x.to_point(), p_err: e, origin: PointOrigin::Placed(self, affine) }
    }

    /// The point relative to `centre`, in units of `2^scale`, with a bound on its error.
    #[inline(always)]
    pub fn relative_to(&self, centre: Point3, scale: i32) -> (Vec3, Vec3) {
        let (x, e) = relative(self.p, self.p_err, centre);
        (x.map(|x| scale2(x, -scale)), e.map(|x| scale2(x, -scale) + TINY))
    }

    /// The exact point in a ring: `(coordinates times w, w)` with `w > 0`.
    pub fn in_ring<T: Ring>(&self) -> Option<([T; 3], T)> {
        match self.origin {
            PointOrigin::Given => Some((
                [
                    T::within(self.p.x, self.p_err.x)?,
                    T::within(self.p.y, self.p_err.y)?,
                    T::within(self.p.z, self.p_err.z)?,
                ],
                T::exact(1.0),
            )),
            PointOrigin::Along(ray, s) => {
                let at = ray.in_ring::<T>()?.moved(Point3::ORIGIN, s);
                Some((at.o, at.w))
            }
            PointOrigin::Placed(parent, affine) => {
                let (p, w) = parent.in_ring::<T>()?;
                let c = affine.centre().to_array();
                let [x, y, z] = p;
                let v = [
                    x - T::exact(c[0]) * w.clone(),
                    y - T::exact(c[1]) * w.clone(),
                    z - T::exact(c[2]) * w.clone(),
                ];
                let (adjugate, determinant) = affine.adjugate::<T>();
                let q = adjugate.map(|[a, b, c]| a * v[0].clone() + b * v[1].clone() + c * v[2].clone());
                Some((q, w * determinant))
            }
        }
    }
}
