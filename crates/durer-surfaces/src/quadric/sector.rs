//! The spherical sector: the part of a ball inside a cone from its centre.
//!
//! ```text
//!       ╭──╮ ╱       y = x - centre,  k = cos(half-angle)
//!      │   ●╱ ▷ axis   |y|² <= r²,   y·a >= 0,   (y·a)² >= k² |a|² |y|²
//!       ╰──╯ ╲
//! ```
//!
//! The exact surface uses the number `k`: an angle is converted to its cosine once, when the sector
//! is made. A half-angle of 90 degrees gives half a ball. Larger ones are not convex and are not
//! supported.

use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::chart::{Chart, Frame, Tip, sheared, sphere_chart, tangents};
use crate::faces::form::Form;
use crate::quadric::solid::QuadricSolid;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Point3, Ring, U, Vec3, elementary};

/// A spherical sector, a solid. Face 0 is the spherical part, face 1 the cone, face 2 the plane
/// that cuts off the cone's other half.
pub type SphericalSector = QuadricSolid<SectorShape>;

/// The numbers of a [`SphericalSector`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectorShape {
    centre: Point3,
    radius: f64,
    axis: Vec3,
    cosine: f64,
}

/// Why a [`SphericalSector`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SectorError {
    /// The centre has an infinite or NaN coordinate.
    #[error("spherical sector: the centre must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Centre(Point3),
    /// The radius is zero, negative, infinite or NaN.
    #[error("spherical sector: the radius must be finite and positive, got {0}")]
    Radius(f64),
    /// The axis is zero, infinite or NaN.
    #[error("spherical sector: the axis must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Axis(Vec3),
    /// The cosine of the half-angle is not in `[0, 1)`.
    #[error("spherical sector: the half-angle must be above 0 and at most 90 degrees; its cosine is {0}")]
    Angle(f64),
}

impl SphericalSector {
    /// The sector about `axis` (of any length) with the cosine of its half-angle in `[0, 1)`.
    pub fn new(centre: Point3, radius: f64, axis: Vec3, cosine: f64) -> Result<Self, SectorError> {
        if !centre.is_finite() {
            return Err(SectorError::Centre(centre));
        }
        if !(radius.is_finite() && radius > 0.0) {
            return Err(SectorError::Radius(radius));
        }
        if !axis.is_finite() || axis == Vec3::ZERO {
            return Err(SectorError::Axis(axis));
        }
        if !(0.0..1.0).contains(&cosine) {
            return Err(SectorError::Angle(cosine));
        }
        Ok(Self::of(SectorShape { centre, radius, axis, cosine }))
    }

    /// The sector with a half-angle in radians.
    pub fn with_half_angle(
        centre: Point3,
        radius: f64,
        axis: Vec3,
        half_angle: f64,
    ) -> Result<Self, SectorError> {
        // The cosine of the f64 nearest to a right angle is 6e-17, not 0.
        let right = half_angle == core::f64::consts::FRAC_PI_2;
        let cosine = if right { 0.0 } else { elementary::cos(half_angle) };
        if half_angle <= 0.0 {
            return Err(SectorError::Angle(cosine));
        }
        Self::new(centre, radius, axis, cosine)
    }
}

impl SectorShape {
    fn scale(&self) -> i32 {
        exponent(self.radius).max(-1022)
    }

    fn unit_axis<T: Ring>(&self) -> [T; 3] {
        let k = -exponent(self.axis.max_abs());
        self.axis.to_array().map(|x| T::exact(x).scale2(k))
    }

    fn direction(&self) -> Vec3 {
        let k = -exponent(self.axis.max_abs());
        let a = self.axis.map(|x| scale2(x, k));
        a * (1.0 / a.length())
    }
}

impl QuadricFaces for SectorShape {
    fn name(&self) -> &'static str {
        "spherical sector"
    }

    fn frame(&self) -> Frame {
        let scale = self.scale();
        Frame { centre: self.centre, scale, reach: scale2(self.radius, -scale) * (1.0 + 2.0 * U) }
    }

    fn faces(&self) -> usize {
        if self.cosine == 0.0 { 2 } else { 3 }
    }

    #[inline(always)]
    fn form<T: Ring>(&self, face: usize) -> Form<T> {
        let a = self.unit_axis::<T>();
        let plane = self.faces() - 1;
        if face == 0 {
            let one = || T::exact(1.0);
            return Form::diagonal(
                [one(), one(), one()],
                -T::exact(self.radius).scale2(-self.scale()).square(),
            );
        }
        if face == plane {
            return Form::half_space(a.map(|x| -x), T::exact(0.0));
        }
        // k²|a|² I - a aᵀ.
        let aa = a[0].clone().square() + a[1].clone().square() + a[2].clone().square();
        let k = aa * T::exact(self.cosine).square();
        let m = |i: usize, j: usize| -(a[i].clone() * a[j].clone());
        let zero = || T::exact(0.0);
        Form {
            q: [k.clone() + m(0, 0), k.clone() + m(1, 1), k + m(2, 2), m(0, 1), m(0, 2), m(1, 2)],
            b: [zero(), zero(), zero()],
            c: zero(),
        }
    }

    fn bounds(&self) -> Aabb {
        // The ball's box, reduced where the cone excludes an axis: a point at the angle θ from the
        // axis reaches at most r cos(θ - half-angle).
        let a = self.direction();
        let sine = (1.0 - self.cosine * self.cosine).max(0.0).sqrt();
        let reach = |cos: f64| {
            let far = if cos >= self.cosine {
                1.0
            } else {
                (cos * self.cosine + (1.0 - cos * cos).max(0.0).sqrt() * sine).max(0.0)
            };
            // The square roots lose half their digits near their zeros.
            self.radius * (far + 1e-7).min(1.0)
        };
        let max = Vec3::new(reach(a.x), reach(a.y), reach(a.z));
        let min = Vec3::new(reach(-a.x), reach(-a.y), reach(-a.z));
        let upper = Aabb::centred(self.centre, max).max;
        let lower = Aabb::centred(self.centre, min).min;
        Aabb::new(lower, upper)
    }

    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart {
        let a = self.direction();
        let (e1, e2) = tangents(a);
        let local = Vec3::new(y.dot(e1), y.dot(e2), y.dot(a));
        let back = |v: Vec3| e1 * v.x + e2 * v.y + a * v.z;
        let Chart { uv, dpdu, dpdv } = sphere_chart(local);
        if face == 0 {
            return Chart { uv, dpdu: back(dpdu), dpdv: back(dpdv) };
        }
        // Around the axis, and outward along the cone or the disc.
        let unit = scale2(self.radius, -self.scale());
        let out = if y.length() > f64::MIN_POSITIVE { y * (1.0 / y.length()) } else { e1 };
        Chart {
            uv: [uv[0], y.length() / unit],
            dpdu: sheared(back(dpdu), out, n),
            dpdv: sheared(out * unit, n, n),
        }
    }

    fn tip(&self, face: usize) -> Option<Tip> {
        (face == 1 && self.cosine > 0.0).then(|| Tip { normal: -self.direction(), is_double: false })
    }
}
