//! Cameras whose picture is not a plane: fisheyes, spheres and cylinders.
//!
//! With the unit vectors `r`, `u`, `f` to the right, up and forwards, and `x = px`, `y = -py`:
//!
//! ```text
//!   fisheye     t = (a/2) |(x |right|, y |up|)|, seen up to 1:  sin(t) (cos, sin)(angle in the picture), cos(t)
//!   omnimax     phi = 1.411269 r - 0.09439 r^3 + 0.25674 r^5 from the direction of view, seen up to r = 1
//!   ultra wide  (sin s, sin t, cos s cos t),  s = x a/2,  t = y (a/2) |up|/|right|
//!   spherical   (sin s cos t, sin t, cos s cos t),  s = x h/2,  t = y v/2
//!   panoramic   the same for h = v = 180 degrees, times (|right|, |up|, |direction|)
//!   cylinder    (sin s, y |up|/2, cos s),  s = x a/2;  a horizontal one has x and y exchanged
//! ```
//!
//! The polynomial of the Omnimax lens is that of N. Greene and P. S. Heckbert, "Creating raster
//! Omnimax images from multiple perspective views using the elliptical weighted average filter",
//! *IEEE Computer Graphics and Applications* 6 (1986) 21-27, with the coefficient of `r^3` that
//! POV-Ray's pictures show. The lens's picture ends 45 degrees below the direction of view, at `y = -0.55829`. With `k = |up|/|right|`, the picture covers `y` from
//! `1 - 2 k` up to 1 if `k` is below 1, and from `-k` to `k` otherwise; if that ends within the
//! lens's picture, `y` ends with it and `x` is widened. This was found from POV-Ray's pictures.

use super::{CameraError, check};
use core::f64::consts::{FRAC_PI_2, TAU};
use durer_math::lanes::LANES;
use durer_math::{F8, Point3, Ray, Vec3, elementary};
use durer_scene::Projection;

use crate::vector::{length, unit};

/// The kind of a [`Curved`] camera; see [`Projection`].
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Fisheye(f64),
    UltraWideAngle(f64),
    Spherical(f64, f64),
    Panoramic,
    Omnimax,
    Cylinder { angle: f64, vertical: bool, moving: bool },
}

/// Where the picture of the Omnimax lens ends, 45 degrees below the direction of view but for 6e-7;
/// with the polynomial it gives the angles of POV-Ray's pictures within 1e-11.
const OMNIMAX_END: f64 = 0.558_290_181_7;

/// A camera whose picture is not a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curved {
    kind: Kind,
    origin: Point3,
    /// To the right, up and forwards, with length 1.
    frame: [Vec3; 3],
    /// The lengths of the scene's vectors.
    lengths: [f64; 3],
}

impl Curved {
    /// Converts the scene's camera.
    pub(super) fn new(camera: &durer_scene::Camera) -> Result<Self, CameraError> {
        let own = [camera.right, camera.up, camera.direction];
        let [right, up, direction] = own;
        check(camera.location, [("direction", direction), ("right vector", right), ("up vector", up)])?;
        let kind = match camera.projection {
            Projection::Fisheye(angle) => Kind::Fisheye(angle),
            Projection::UltraWideAngle(angle) => Kind::UltraWideAngle(angle),
            Projection::Spherical(wide, high) => Kind::Spherical(wide, high),
            Projection::Cylinder { angle, vertical, moving } => Kind::Cylinder { angle, vertical, moving },
            Projection::Omnimax => Kind::Omnimax,
            // The others have cameras of their own.
            Projection::Panoramic
            | Projection::Perspective
            | Projection::Orthographic
            | Projection::Mesh(_) => Kind::Panoramic,
        };
        Ok(Self { kind, origin: camera.location, frame: own.map(unit), lengths: own.map(length) })
    }

    /// The ray through the point `(px, py)` of the picture; its direction is zero where the picture
    /// shows nothing.
    pub fn ray(&self, px: f64, py: f64) -> Ray {
        let (x, y) = (px, -py);
        let [right, up, forwards] = self.lengths;
        let sphere = |s: f64, t: f64| {
            let ((sin_s, cos_s), (sin_t, cos_t)) = (elementary::sin_cos(s), elementary::sin_cos(t));
            Vec3::new(sin_s * cos_t, sin_t, cos_s * cos_t)
        };
        let mut origin = self.origin;
        let v = match self.kind {
            Kind::Fisheye(angle) => {
                let (x, y) = (x * right, y * up);
                let from_middle = (x * x + y * y).sqrt();
                if from_middle >= 1.0 {
                    Vec3::ZERO
                } else {
                    let (sin, cos) = elementary::sin_cos(from_middle * angle * 0.5);
                    let k = if from_middle > 0.0 { sin / from_middle } else { 0.0 };
                    Vec3::new(x * k, y * k, cos)
                }
            }
            Kind::UltraWideAngle(angle) => {
                let (s, t) = (x * angle * 0.5, y * angle * 0.5 * up / right);
                let ((sin_s, cos_s), (sin_t, cos_t)) = (elementary::sin_cos(s), elementary::sin_cos(t));
                Vec3::new(sin_s, sin_t, cos_s * cos_t)
            }
            Kind::Spherical(wide, high) => sphere(x * wide * 0.5, y * high * 0.5),
            Kind::Panoramic => {
                let v = sphere(x * FRAC_PI_2, y * FRAC_PI_2);
                Vec3::new(v.x * right, v.y * up, v.z * forwards)
            }
            Kind::Cylinder { angle, vertical, moving } => {
                let (around, along, size) = if vertical { (x, y, up) } else { (y, x, right) };
                let (sin, cos) = elementary::sin_cos(around * angle * 0.5);
                let mut along = along * size * 0.5;
                if moving {
                    origin = origin + self.frame[usize::from(vertical)] * along;
                    along = 0.0;
                }
                if vertical { Vec3::new(sin, along, cos) } else { Vec3::new(along, sin, cos) }
            }
            Kind::Omnimax => omnimax(x, y, up / right),
        };
        let [r, u, f] = self.frame;
        Ray::new(origin, r * v.x + u * v.y + f * v.z)
    }

    /// The place at which a normal of the camera is evaluated, in the numbers in which the formulas
    /// above are written: angles in radians, and for a fisheye the angle in the picture and that from
    /// the direction of view. This was found from POV-Ray's pictures with bumps that jump.
    pub(super) fn place_on_picture(&self, px: f64, py: f64) -> [f64; 2] {
        let (x, y) = (px, -py);
        let [right, up, _] = self.lengths;
        match self.kind {
            Kind::Fisheye(angle) => {
                let (x, y) = (x * right, y * up);
                [angle_in_picture(x, y), (x * x + y * y).sqrt() * angle * 0.5]
            }
            Kind::Omnimax => {
                let (x, y) = omnimax_place(x, y, up / right);
                [angle_in_picture(x, y), omnimax_angle((x * x + y * y).sqrt())]
            }
            Kind::UltraWideAngle(angle) => [x * angle * 0.5, y * angle * 0.5 * up / right],
            Kind::Spherical(wide, high) => [x * wide * 0.5, y * high * 0.5],
            Kind::Panoramic => [FRAC_PI_2 - x * FRAC_PI_2, y * FRAC_PI_2],
            Kind::Cylinder { angle, vertical: true, .. } => [x * angle * 0.5, y * up * 0.5],
            Kind::Cylinder { angle, vertical: false, .. } => [x * right * 0.5, y * angle * 0.5],
        }
    }

    /// The rays through some points.
    pub(super) fn rays(&self, px: F8, py: F8) -> (Point3<F8>, Vec3<F8>) {
        let mut origin = Vec3::<F8>::splat(self.origin.to_vec());
        let mut direction = Vec3::<F8>::splat(Vec3::ZERO);
        for i in 0..LANES {
            let ray = self.ray(px.0[i], py.0[i]);
            origin.set_lane(i, ray.origin.to_vec());
            direction.set_lane(i, ray.direction);
        }
        (origin.to_point(), direction)
    }

    /// The vectors whose sums are the starts of rays.
    pub(super) fn start_terms(&self) -> [Vec3; 3] {
        [
            self.origin.to_vec(),
            self.frame[0] * (self.lengths[0] * 0.5),
            self.frame[1] * (self.lengths[1] * 0.5),
        ]
    }
}

/// The angle of a point of the picture around its middle, from -pi/2 to 3 pi/2.
fn angle_in_picture(x: f64, y: f64) -> f64 {
    let angle = elementary::atan2(y, x);
    if angle < -FRAC_PI_2 { angle + TAU } else { angle }
}

/// The point of the Omnimax lens's picture, whose radius is 1, at a point of the whole picture. `k` is
/// the height of that in units of its width.
fn omnimax_place(x: f64, y: f64, k: f64) -> (f64, f64) {
    let half = 0.5 * (1.0 + OMNIMAX_END);
    if k >= 1.0 {
        (x, y * k)
    } else if k >= half {
        (x, y * k + (1.0 - k))
    } else {
        (x * half / k, y * half + (1.0 - half))
    }
}

/// The angle from the direction of view at the distance `r` from the middle of the lens's picture.
fn omnimax_angle(r: f64) -> f64 {
    let square = r * r;
    r * (1.411_269 + square * (-0.094_39 + square * 0.256_74))
}

/// The direction to the right, up and forwards of a point of the Omnimax picture; zero where it
/// shows nothing.
fn omnimax(x: f64, y: f64, k: f64) -> Vec3 {
    let (x, y) = omnimax_place(x, y, k);
    let r = (x * x + y * y).sqrt();
    let (sin, cos) = elementary::sin_cos(omnimax_angle(r));
    let aside = if r > 0.0 { sin / r } else { 0.0 };
    let v = Vec3::new(x * aside, y * aside, cos);
    if r > 1.0 || v.y + v.z < 0.0 { Vec3::ZERO } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_evaluated_at_angles() {
        let place = |projection, x, y| {
            let camera = durer_scene::Camera {
                right: Vec3::new(4.0 / 3.0, 0.0, 0.0),
                up: Vec3::Y,
                projection,
                ..Default::default()
            };
            Curved::new(&camera).unwrap().place_on_picture(x, y)
        };
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12;
        assert!(near(place(Projection::Fisheye(2.0), 0.0, -0.5), [FRAC_PI_2, 0.5]));
        assert!(near(place(Projection::Fisheye(2.0), -0.375, 0.5), [2.5 * FRAC_PI_2, 0.5_f64.sqrt()]));
        assert!(near(place(Projection::UltraWideAngle(2.0), 0.5, -1.0), [0.5, 0.75]));
        assert!(near(place(Projection::Spherical(3.0, 2.0), 0.5, 0.5), [0.75, -0.5]));
        assert!(near(place(Projection::Panoramic, 1.0, 0.0), [0.0, 0.0]));
        let tube = |vertical| Projection::Cylinder { angle: 2.0, vertical, moving: false };
        assert!(near(place(tube(true), 0.5, -1.0), [0.5, 0.5]));
        assert!(near(place(tube(false), 1.0, -0.5), [2.0 / 3.0, 0.5]));
    }
}
