//! The orthographic camera: all rays are parallel to the direction of view.
//!
//! ```text
//!     o + sx ●──────▶           o(p) = o + px sx + py sy
//!          o ●──────▶ f
//!     o - sx ●──────▶           the ray through p is  r(t) = o(p) + t f
//! ```

use super::{CameraError, check};
use durer_math::{F8, Point3, Ray, Vec3};

/// A camera with parallel rays: origins `o + px sx + py sy`, one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    origin: Point3,
    direction: Vec3,
    sx: Vec3,
    sy: Vec3,
}

impl Orthographic {
    /// Makes a camera from the middle of the picture, the direction of all rays, and the vectors
    /// from the middle of the picture to the middles of its right and lower sides.
    ///
    /// ```
    /// use durer_math::{Point3, Vec3};
    /// use durer_render::camera::Orthographic;
    /// let camera = Orthographic::new(Point3::ORIGIN, Vec3::Z, Vec3::X * 4.0, Vec3::Y * -3.0)?;
    /// assert_eq!(camera.ray(1.0, -1.0).origin, Point3::new(4.0, 3.0, 0.0)); // the upper right corner
    /// assert_eq!(camera.ray(1.0, -1.0).direction, Vec3::Z);
    /// # Ok::<(), durer_render::camera::CameraError>(())
    /// ```
    pub fn new(origin: Point3, direction: Vec3, sx: Vec3, sy: Vec3) -> Result<Self, CameraError> {
        check(origin, [("direction", direction), ("right vector", sx), ("up vector", sy)])?;
        Ok(Self { origin, direction, sx, sy })
    }

    /// The ray through the point `(px, py)` of the picture.
    #[inline]
    pub fn ray(&self, px: f64, py: f64) -> Ray {
        Ray::new(self.origin + (self.sx * px + self.sy * py), self.direction)
    }

    /// The vectors whose sums are the starts of rays.
    pub(super) fn start_terms(&self) -> [Vec3; 3] {
        [self.origin.to_vec(), self.sx, self.sy]
    }

    /// The origins and the direction of the rays through some points.
    #[inline(always)]
    pub(super) fn rays(&self, px: F8, py: F8) -> (Point3<F8>, Vec3<F8>) {
        let splat = Vec3::<F8>::splat;
        let aside = splat(self.sx) * px + splat(self.sy) * py;
        (splat(self.origin.to_vec()).to_point() + aside, splat(self.direction))
    }
}
