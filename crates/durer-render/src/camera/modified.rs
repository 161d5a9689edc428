//! Cameras with a lens, and cameras whose rays are perturbed like normals.

use durer_math::{Affine, AffineError, F8, M8, Point3, Ray, Vec3};

use super::lens::RenderLens;
use super::{Camera, on_picture};
use crate::texture::{Around8, RenderNormal};
use crate::vector::{dot, unit};

/// A camera with a lens, or whose rays are perturbed.
#[derive(Clone, Debug, PartialEq)]
pub struct Modified {
    base: Camera,
    normal: Option<RenderNormal>,
    pub(super) lens: Option<RenderLens>,
    /// To the right, up and forwards, with length 1.
    frame: [Vec3; 3],
    /// Whether the plane of focus lies across the direction of view; otherwise it is a sphere.
    flat: bool,
}

impl Modified {
    /// Adds the lens and the normal of the scene's camera to its rays. `None` if it has neither.
    pub(super) fn new(base: &Camera, camera: &durer_scene::Camera) -> Result<Option<Self>, AffineError> {
        let lens = camera.lens.as_ref().map(RenderLens::new).transpose()?.flatten();
        let normal = camera.normal.as_ref();
        let normal = normal.map(|own| RenderNormal::new(own, &Affine::IDENTITY, &Affine::IDENTITY));
        let normal = normal.transpose()?;
        let is_plain = lens.is_none() && normal.is_none() || matches!(base, Camera::Mesh(_));
        Ok((!is_plain).then(|| Self {
            base: base.clone(),
            normal,
            lens,
            frame: [camera.right, camera.up, camera.direction].map(unit),
            flat: !matches!(base, Camera::Curved(_)),
        }))
    }

    /// The camera without its lens and its normal.
    pub(super) fn base(&self) -> &Camera {
        &self.base
    }

    /// The ray with this number through a place in pixels of a picture.
    pub(super) fn ray(&self, x: f64, y: f64, number: u32, picture: (u32, u32)) -> Ray {
        let (shift, point) = match &self.lens {
            Some(lens) => lens.sample(x, y, number),
            None => ([0.0; 2], [0.0; 2]),
        };
        let (x, y) = (x + shift[0], y + shift[1]);
        let mut ray = self.base.numbered(x, y, 0, picture);
        if ray.direction == Vec3::ZERO {
            return ray;
        }
        if let Some(normal) = &self.normal {
            let (u, v) = (on_picture(x, picture.0), on_picture(y, picture.1));
            let [u, v] = match &self.base {
                Camera::Curved(curved) => curved.place_on_picture(u, v),
                _ => [0.5 * u, -0.5 * v],
            };
            let around = Around8 {
                points: Vec3::<F8>::splat(Vec3::new(u, v, 0.0)).to_point(),
                normals: Vec3::<F8>::splat(unit(ray.direction)),
                rays: Vec3::<F8>::splat(ray.direction),
                uv: [F8::splat(u), F8::splat(v)],
            };
            ray.direction = normal.perturbed(around.points, &around, M8::first(1)).lane(0);
        }
        if let Some(lens) = &self.lens {
            let [right, up, forwards] = self.frame;
            let speed =
                if self.flat { dot(ray.direction, forwards) } else { crate::vector::length(ray.direction) };
            let focus = ray.direction * (lens.focus / speed);
            let aside = right * point[0] + up * point[1];
            let target: Point3 = ray.origin + focus;
            let start = ray.origin + aside;
            ray = Ray::new(start, target - start);
        }
        ray
    }
}
