//! The surface around a point at which a texture is evaluated.

use durer_math::{F8, Point3, Vec3};

/// The properties of the surface at eight points that patterns may use, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Around8 {
    /// The points.
    pub(crate) points: Point3<F8>,
    /// The unit normals, on the side of the eye; zero where there is no surface.
    pub(crate) normals: Vec3<F8>,
    /// The directions of the rays that meet the surface there, of any length.
    pub(crate) rays: Vec3<F8>,
    /// The texture coordinates; zero if the texture needs none.
    pub(crate) uv: [F8; 2],
}

impl Around8 {
    /// Points that lie on no surface.
    pub(crate) const NOWHERE: Self = {
        let zero = Vec3 { x: F8::ZERO, y: F8::ZERO, z: F8::ZERO };
        Self {
            points: Point3 { x: F8::ZERO, y: F8::ZERO, z: F8::ZERO },
            normals: zero,
            rays: zero,
            uv: [F8::ZERO; 2],
        }
    };

    /// The surface around one of the points.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Around<'_> {
        Around { all: self, lane }
    }
}

/// The properties of the surface at a point that patterns may use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    all: &'a Around8,
    lane: usize,
}

impl Around<'_> {
    /// A point that lies on no surface.
    pub(crate) const NOWHERE: Self = Around { all: &Around8::NOWHERE, lane: 0 };

    /// The surface around this point, eight times.
    pub(super) fn everywhere(self) -> Around8 {
        let splat = Vec3::<F8>::splat;
        let points = splat(self.point().to_vec()).to_point();
        let uv = self.all.uv.map(|x| F8::splat(x.0[self.lane]));
        Around8 { points, normals: splat(self.normal()), rays: splat(self.ray()), uv }
    }

    pub(super) fn point(self) -> Point3 {
        self.all.points.to_vec().lane(self.lane).to_point()
    }

    /// The texture coordinates, as a point of the plane `z = 0`.
    pub(super) fn uv(self) -> Point3 {
        let [u, v] = self.all.uv;
        Point3::new(u.0[self.lane], v.0[self.lane], 0.0)
    }

    pub(super) fn normal(self) -> Vec3 {
        self.all.normals.lane(self.lane)
    }

    pub(super) fn ray(self) -> Vec3 {
        self.all.rays.lane(self.lane)
    }
}
