//! The pinhole camera: all rays start at the eye.
//!
//! ```text
//!                    ╱│ o + f + sx          d(p) = f + px sx + py sy
//!                  ╱  │
//!     eye o ●────f────┼──▶                  the ray through p is  r(t) = o + t d(p)
//!                  ╲  │
//!                    ╲│ o + f - sx          (sy points down)
//! ```
//!
//! The direction is affine in `p` and not normalised, so `t` is the depth in units of `|f|`, and
//! the differentials of the ray are just `sx` and `sy` times the size of a pixel. With `|f|` = 1
//! the picture is `2 |sx|` wide at distance 1: `|sx| = tan(w / 2)` for a horizontal field of view
//! `w`, and `|sy| = |sx| Y / X` for square pixels.

use super::{CameraError, check};
use durer_math::{F8, Point3, Ray, Vec3, elementary};

/// A pinhole camera: `d = f + px sx + py sy` from a fixed origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    origin: Point3,
    f: Vec3,
    sx: Vec3,
    sy: Vec3,
}

impl Perspective {
    /// Makes a camera from the eye, the vector to the middle of the picture, and the vectors from
    /// there to the middles of the right and lower sides.
    pub fn new(origin: Point3, f: Vec3, sx: Vec3, sy: Vec3) -> Result<Self, CameraError> {
        check(origin, [("direction", f), ("right vector", sx), ("up vector", sy)])?;
        Ok(Self { origin, f, sx, sy })
    }

    /// Makes a right-handed camera at `origin` that looks at `target`, with `up` upwards, a
    /// horizontal field of view in radians (below pi) and a picture `aspect` times as wide as it is
    /// high.
    ///
    /// ```
    /// use durer_math::{Point3, Vec3};
    /// use durer_render::camera::Perspective;
    /// let eye = Point3::new(0.0, 0.0, 4.0);
    /// let camera = Perspective::looking_at(eye, Point3::ORIGIN, Vec3::Y, 1.2, 4.0 / 3.0)?;
    /// let middle = camera.ray(0.0, 0.0);
    /// assert!((middle.direction - -Vec3::Z).length() < 1e-15);
    /// assert!(camera.ray(1.0, 0.0).direction.x > 0.0); // right
    /// assert!(camera.ray(0.0, 1.0).direction.y < 0.0); // down
    /// # Ok::<(), durer_render::camera::CameraError>(())
    /// ```
    pub fn looking_at(
        origin: Point3,
        target: Point3,
        up: Vec3,
        field_of_view: f64,
        aspect: f64,
    ) -> Result<Self, CameraError> {
        let f = (target - origin).normalized().ok_or(CameraError::Zero("direction"))?;
        let right = f.cross(up).normalized().ok_or(CameraError::Zero("right vector"))?;
        let down = f.cross(right);
        let reach = elementary::tan(field_of_view * 0.5);
        Self::new(origin, f, right * reach, down * (reach / aspect))
    }

    /// The ray through the point `(px, py)` of the picture.
    #[inline]
    pub fn ray(&self, px: f64, py: f64) -> Ray {
        Ray::new(self.origin, self.f + self.sx * px + self.sy * py)
    }

    /// The origin and the directions of the rays through some points.
    #[inline(always)]
    pub(super) fn rays(&self, px: F8, py: F8) -> (Point3<F8>, Vec3<F8>) {
        let splat = Vec3::<F8>::splat;
        (splat(self.origin.to_vec()).to_point(), splat(self.f) + splat(self.sx) * px + splat(self.sy) * py)
    }

    /// The point where all rays start.
    pub fn origin(&self) -> Point3 {
        self.origin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_are_the_sums_of_the_vectors() {
        let (f, sx, sy) = (Vec3::new(0.0, 0.0, 2.0), Vec3::X, Vec3::new(0.0, -0.75, 0.0));
        let camera = Perspective::new(Point3::new(1.0, 2.0, 3.0), f, sx, sy).unwrap();
        let corner = camera.ray(-1.0, -1.0);
        assert_eq!(corner.origin, Point3::new(1.0, 2.0, 3.0));
        assert_eq!(corner.direction, Vec3::new(-1.0, 0.75, 2.0));
        assert_eq!(camera.ray(1.0, 1.0).direction, Vec3::new(1.0, -0.75, 2.0));
    }

    #[test]
    fn the_field_of_view_is_seen() {
        let (angle, aspect) = (1.0, 1.5);
        let camera =
            Perspective::looking_at(Point3::ORIGIN, Point3::new(3.0, 0.0, 0.0), Vec3::Y, angle, aspect)
                .unwrap();
        let (l, r) = (camera.ray(-1.0, 0.0).direction, camera.ray(1.0, 0.0).direction);
        let cosine = l.dot(r) / (l.length() * r.length());
        assert!((elementary::acos(cosine) - angle).abs() < 1e-14);
        let (low, right) = (camera.ray(0.0, 1.0).direction, r);
        assert!((right.z / -low.y - aspect).abs() < 1e-14);
    }
}
