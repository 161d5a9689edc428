//! Patterns that depend on the surface: the angle of its normal `n`, on the side of the eye.
//!
//! ```text
//!   s(d) = 1 - acos(n d)/pi                                  for a unit vector d: 0 if opposite, 1/2 if perpendicular, 1 if parallel
//!   aoi        s(-ray)
//!   slope      (s - low)/(high - low)                        d the direction, or from the surface to a point
//!   altitude   (|d| slope + |a| (p a/|a| - low')/(high' - low'))/(|d| + |a|)
//! ```
//!
//! The normals, directions and reference points are those of the world, whatever the placement of
//! the pattern; only the altitude is measured in the pattern's space (facts of the scene language).

use core::f64::consts::PI;

use durer_math::{Point3, Vec3, elementary};
use durer_scene::{Slope, SlopeTo};

use crate::texture::Around;
use crate::vector::{dot, floor, length, unit};

/// The angle between two unit vectors as a number from 0 (opposite) to 1 (parallel).
fn nearness(n: Vec3, d: Vec3) -> f64 {
    1.0 - elementary::acos(dot(n, d).clamp(-1.0, 1.0)) / PI
}

/// The value of `aoi`; 0 where there is no surface.
pub(super) fn incidence(around: Around) -> f64 {
    let (normal, ray) = (around.normal(), around.ray());
    if normal == Vec3::ZERO || ray == Vec3::ZERO {
        return 0.0;
    }
    nearness(normal, unit(ray) * -1.0)
}

/// The value of `slope` at a point; 0 where there is no surface.
pub(super) fn value(slope: &Slope, p: Point3, around: Around) -> f64 {
    let normal = around.normal();
    if normal == Vec3::ZERO {
        return 0.0;
    }
    let (to, weight) = match slope.to {
        SlopeTo::Direction(d) => (d, length(d)),
        SlopeTo::Point(target) => (target - around.point(), 1.0),
    };
    let steep = if to == Vec3::ZERO { 0.0 } else { nearness(normal, unit(to)) };
    let steep = stretched(steep, slope.range);
    let value = match slope.altitude {
        None => steep,
        Some((axis, range)) => {
            let of_height = length(axis);
            let height = stretched(dot(p.to_vec(), axis) / of_height, range);
            (weight * steep + of_height * height) / (weight + of_height)
        }
    };
    // A frequency shows that values outside of the range begin anew (a fact of the scene language).
    if (0.0..=1.0).contains(&value) { value } else { value - floor(value) }
}

/// 0 at the first end of a range, 1 at the second.
fn stretched(x: f64, [low, high]: [f64; 2]) -> f64 {
    (x - low) / (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Around8;

    fn at(slope: &Slope, n: Vec3, p: Point3) -> f64 {
        let mut around = Around8::NOWHERE;
        around.normals.set_lane(3, n);
        around.points = Vec3::splat(p.to_vec()).to_point();
        value(slope, p, around.lane(3))
    }

    /// Values of POV-Ray on the unit sphere.
    #[test]
    fn values_are_those_of_the_scene_language() {
        let y = 8.0 / 9.0;
        let (n, p) = (Vec3::new(0.0, y, -f64::sqrt(1.0 - y * y)), Point3::new(0.0, y, 0.0));
        let plain = Slope { to: SlopeTo::Direction(Vec3::Y * 3.0), range: [0.0, 1.0], altitude: None };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-4, "{a} instead of {b}");
        close(at(&plain, n, p), 0.8485);
        close(at(&Slope { range: [0.25, 0.5], ..plain }, n, p), 0.3941);
        // Of values below the range, too: 400 x 400 points of the sphere agree within 1e-5.
        close(at(&Slope { range: [0.9, 1.0], ..plain }, n, p), 0.4852);
        let altitude = Some((Vec3::Y, [0.0, 1.0]));
        close(at(&Slope { to: SlopeTo::Direction(Vec3::Y * 2.0), altitude, ..plain }, n, p), 0.862);
        let on = Point3::new(0.0, y, -(1.0 - y * y).sqrt());
        close(at(&Slope { to: SlopeTo::Point(Point3::new(0.0, 3.0, 0.0)), ..plain }, n, on), 0.7805);
        assert_eq!(value(&plain, p, Around::NOWHERE), 0.0);
    }
}
