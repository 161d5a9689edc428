//! Cameras map points of the picture to rays.
//!
//! The picture is the square `[-1, 1] x [-1, 1]` of points `p = (px, py)`, with `px` to the right
//! and `py` *down*: the middle of the pixel in column `x` and row `y` of an `X` by `Y` picture has
//! `px = 2 (x + 0.5) / X - 1` and `py = 2 (y + 0.5) / Y - 1`, rows counted from the top. A camera
//! has two screen vectors: `sx` from the middle of the picture to the middle of its right side, and
//! `sy` to the middle of its *lower* side.

mod curved;
mod lens;
mod mesh;
mod modified;
mod orthographic;
mod perspective;
mod uv_grid;

pub use self::curved::Curved;
pub(crate) use self::lens::{RenderLens, Samples};
pub use self::mesh::MeshRays;
pub use self::modified::Modified;
pub use self::orthographic::Orthographic;
pub use self::perspective::Perspective;

use std::sync::Arc;

use durer_math::lanes::LANES;
use durer_math::{AffineError, F8, Point3, Ray, Vec3};
use durer_scene::Projection;

/// Why a camera cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is infinite or NaN.
    #[error("camera: the {name} must be finite, got <{}, {}, {}>", .value[0], .value[1], .value[2])]
    NotFinite {
        /// Which vector.
        name: &'static str,
        /// Its coordinates.
        value: [f64; 3],
    },
    /// A vector has no length.
    #[error("camera: the {0} must not be zero")]
    Zero(&'static str),
    /// The transformation of the camera's normal or bokeh is singular or not finite.
    #[error("camera: a texture's transformation: {0}")]
    Texture(#[from] AffineError),
}

/// A camera of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// A pinhole camera: all rays start at one point.
    Perspective(Perspective),
    /// A camera with parallel rays: all rays have one direction.
    Orthographic(Orthographic),
    /// A camera whose picture is not a plane.
    Curved(Curved),
    /// A camera whose rays start at the faces of meshes.
    Mesh(Arc<MeshRays>),
    /// A camera with a lens, or whose rays are perturbed.
    Modified(Arc<Modified>),
}

/// The number of rays for a point of the picture.
pub(crate) enum Sampling<'a> {
    /// One ray.
    Once,
    /// One ray for each face of a mesh camera at the point.
    Faces(&'a MeshRays),
    /// As many as a lens needs.
    Lens(&'a RenderLens),
}

impl Camera {
    /// Converts the scene's camera: `f = direction`, `sx = right / 2`, `sy = -up / 2`.
    pub fn new(camera: &durer_scene::Camera) -> Result<Self, CameraError> {
        let (o, f) = (camera.location, camera.direction);
        let (sx, sy) = (camera.right * 0.5, camera.up * -0.5);
        let base = match &camera.projection {
            Projection::Perspective => Self::Perspective(Perspective::new(o, f, sx, sy)?),
            Projection::Orthographic => Self::Orthographic(Orthographic::new(o, f, sx, sy)?),
            Projection::Mesh(mesh) => Self::Mesh(Arc::new(MeshRays::new(mesh, o, f))),
            _ => Self::Curved(Curved::new(camera)?),
        };
        Ok(match Modified::new(&base, camera)? {
            Some(modified) => Self::Modified(Arc::new(modified)),
            None => base,
        })
    }

    /// The ray with this number through a point, in pixels, of a picture of the given size. Its
    /// direction is zero where the picture shows nothing. For cameras with one ray per point all
    /// numbers give that ray.
    #[inline]
    pub(crate) fn numbered(&self, x: f64, y: f64, number: u32, picture: (u32, u32)) -> Ray {
        let (px, py) = (on_picture(x, picture.0), on_picture(y, picture.1));
        match self {
            Self::Perspective(camera) => camera.ray(px, py),
            Self::Orthographic(camera) => camera.ray(px, py),
            Self::Curved(camera) => camera.ray(px, py),
            Self::Mesh(camera) => {
                camera.ray(x, y, number, picture).unwrap_or(Ray::new(Point3::ORIGIN, Vec3::ZERO))
            }
            Self::Modified(camera) => camera.ray(x, y, number, picture),
        }
    }

    /// The number of rays for a point.
    pub(crate) fn sampling(&self) -> Sampling<'_> {
        match self {
            Self::Mesh(camera) if camera.rays_per_place() > 1 => Sampling::Faces(camera),
            Self::Modified(camera) => camera.lens.as_ref().map_or(Sampling::Once, Sampling::Lens),
            _ => Sampling::Once,
        }
    }

    /// The end of the rays' range.
    pub(crate) fn t_max(&self) -> f64 {
        if let Self::Mesh(camera) = self { camera.t_max } else { f64::INFINITY }
    }

    /// The sum of the magnitudes of the coordinates from which the starts of rays are computed.
    pub(crate) fn start_size(&self) -> f64 {
        let sum = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
        match self {
            Self::Perspective(camera) => sum(camera.origin().to_vec()),
            Self::Orthographic(camera) => camera.start_terms().map(sum).into_iter().sum(),
            Self::Curved(camera) => camera.start_terms().map(sum).into_iter().sum(),
            Self::Mesh(camera) => camera.start_size(),
            Self::Modified(camera) => camera.base().start_size(),
        }
    }

    /// The rays with these numbers through some points of a picture of the given size. The points
    /// are in pixels from the top left.
    #[inline(always)]
    pub(crate) fn rays(
        &self,
        (x, y, numbers): (F8, F8, [u32; LANES]),
        (width, height): (u32, u32),
    ) -> (Point3<F8>, Vec3<F8>) {
        let (px, py) = (on_picture_lanes(x, width), on_picture_lanes(y, height));
        match self {
            Self::Perspective(camera) => camera.rays(px, py),
            Self::Orthographic(camera) => camera.rays(px, py),
            Self::Curved(camera) => camera.rays(px, py),
            Self::Mesh(_) | Self::Modified(_) => self.each((x, y, numbers), (width, height)),
        }
    }

    /// [`Camera::rays`], one after the other.
    fn each(&self, (x, y, numbers): (F8, F8, [u32; LANES]), picture: (u32, u32)) -> (Point3<F8>, Vec3<F8>) {
        let mut origin = Vec3::<F8>::splat(Vec3::ZERO);
        let mut direction = origin;
        for (i, number) in numbers.into_iter().enumerate() {
            let ray = self.numbered(x.0[i], y.0[i], number, picture);
            origin.set_lane(i, ray.origin.to_vec());
            direction.set_lane(i, ray.direction);
        }
        (origin.to_point(), direction)
    }

    /// The ray through the middle of the pixel in column `x` and row `y` of a picture of `width` by
    /// `height` pixels.
    pub fn pixel(&self, x: u32, y: u32, width: u32, height: u32) -> Ray {
        self.numbered(f64::from(x) + 0.5, f64::from(y) + 0.5, 0, (width, height))
    }
}

/// Converts a coordinate in pixels from the left or the top to `[-1, 1]`: `2 x / X - 1`.
#[inline]
pub fn on_picture(x: f64, size: u32) -> f64 {
    2.0 * x / f64::from(size) - 1.0
}

/// [`on_picture`] for eight coordinates.
#[inline(always)]
fn on_picture_lanes(x: F8, size: u32) -> F8 {
    x * 2.0 / f64::from(size) - F8::ONE
}

fn check(origin: Point3, named: [(&'static str, Vec3); 3]) -> Result<(), CameraError> {
    if !origin.is_finite() {
        return Err(CameraError::NotFinite { name: "location", value: origin.to_array() });
    }
    for (name, v) in named {
        if !v.is_finite() {
            return Err(CameraError::NotFinite { name, value: v.to_array() });
        }
        if v == Vec3::ZERO {
            return Err(CameraError::Zero(name));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middles_of_pixels_are_on_the_picture() {
        assert_eq!([0.5, 1.5, 2.5, 3.5].map(|x| on_picture(x, 4)), [-0.75, -0.25, 0.25, 0.75]);
        assert_eq!(on_picture(0.5, 1), 0.0);
    }

    #[test]
    fn the_first_pixel_is_at_the_top_left() {
        let camera = Camera::new(&durer_scene::Camera::default()).unwrap();
        let ray = camera.pixel(0, 0, 2, 2);
        assert_eq!(ray.direction, Vec3::new(-1.33 / 4.0, 0.25, 1.0));
    }

    #[test]
    fn lanes_have_the_rays_of_single_points() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let block = durer_scene::Camera { projection, ..Default::default() };
            let block = durer_scene::Camera { location: Point3::new(0.1, 0.2, -3.0), ..block };
            let camera = Camera::new(&block).unwrap();
            let x = F8([0.5, 1.5, 2.25, 3.0, 99.5, 7.1, 0.0, 160.0]);
            let y = F8([0.5, 0.5, 17.25, 3.0, 11.5, 7.9, 0.0, 120.0]);
            let (origin, direction) = camera.rays((x, y, [0; LANES]), (160, 120));
            for i in 0..8 {
                let ray = camera.numbered(x.0[i], y.0[i], 0, (160, 120));
                assert_eq!(
                    (origin.to_vec().lane(i).to_point(), direction.lane(i)),
                    (ray.origin, ray.direction)
                );
            }
        }
    }

    #[test]
    fn a_bad_vector_is_named() {
        let block = durer_scene::Camera { right: Vec3::ZERO, ..Default::default() };
        assert_eq!(Camera::new(&block), Err(CameraError::Zero("right vector")));
        let block = durer_scene::Camera { location: Point3::new(f64::NAN, 0.0, 0.0), ..Default::default() };
        assert!(matches!(Camera::new(&block), Err(CameraError::NotFinite { name: "location", .. })));
    }
}
