//! Patterns with short formulas.

use crate::vector::{floor, length};
use core::f64::consts::{PI, TAU};
use durer_math::{Point3, elementary};

pub(super) fn spherical(p: Point3) -> f64 {
    (1.0 - length(p.to_vec())).max(0.0)
}

pub(super) fn cylindrical(p: Point3) -> f64 {
    (1.0 - (p.x * p.x + p.z * p.z).sqrt()).max(0.0)
}

pub(super) fn boxed(p: Point3) -> f64 {
    (1.0 - p.x.abs().max(p.y.abs()).max(p.z.abs())).max(0.0)
}

pub(super) fn onion(p: Point3) -> f64 {
    let r = length(p.to_vec());
    r - floor(r)
}

pub(super) fn leopard(p: Point3) -> f64 {
    let mean = (elementary::sin(p.x) + elementary::sin(p.y) + elementary::sin(p.z)) / 3.0;
    mean * mean
}

pub(super) fn radial(p: Point3) -> f64 {
    0.25 + (elementary::atan2(p.x, p.z) + PI) / TAU
}

/// A spiral around the z axis:
///
/// ```text
///   one:  z + r + n frac(theta/(2 pi) + 1/4),   two:  tri(one) + tri(r),   tri(w) = 1 - |2 frac(w) - 1|
/// ```
///
/// for `n` arms at the distance `r` from the axis and the angle `theta` from the x axis.
pub(super) fn spiral(p: Point3, arms: f64, double: bool, shift: f64) -> f64 {
    let r = (p.x * p.x + p.y * p.y).sqrt();
    // The angle goes from 0 to 1, from the direction -y on. A frequency shows where it begins.
    let turn = elementary::atan2(p.y, p.x) / TAU + 0.25;
    let one = p.z + r + shift + arms * (turn - floor(turn));
    if double { triangle(one) + triangle(r) } else { one }
}

fn triangle(w: f64) -> f64 {
    1.0 - (2.0 * (w - floor(w)) - 1.0).abs()
}

/// Cushions in unit cubes. `r` is the distance from the cube's centre; over it a cubic curve with
/// the control values 0, `bottom`, `top` and 1 rises.
pub(super) fn quilted(p: Point3, bottom: f64, top: f64) -> f64 {
    let half = |x: f64| x - floor(x) - 0.5;
    let (x, y, z) = (half(p.x), half(p.y), half(p.z));
    let r = (x * x + y * y + z * z).sqrt();
    // 2/(3 sqrt 3)
    const SCALE: f64 = 0.384_900_179_459_750_5;
    (x.abs() + y.abs() + z.abs()) * quilt_curve(r, bottom, top) * SCALE
}

/// The curve of a cushion at the distance `r` from its middle.
pub(super) fn quilt_curve(r: f64, bottom: f64, top: f64) -> f64 {
    let rest = 1.0 - r;
    3.0 * r * rest * (rest * bottom + r * top) + r * r * r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_of_a_spiral_begins_at_minus_y() {
        // POV-Ray's values, less the radius 1.
        for (degrees, want) in [(-170.0_f64, 0.7778), (-110.0, 0.9444), (-70.0, 0.0556), (170.0, 0.7222)] {
            let (sin, cos) = elementary::sin_cos(degrees.to_radians());
            let found = spiral(Point3::new(cos, sin, 0.0), 1.0, false, 0.0) - 1.0;
            assert!((found - want).abs() < 1e-4, "{degrees}: {found}");
        }
    }

    /// Values of POV-Ray.
    #[test]
    fn spirals_and_quilts_have_known_values() {
        let at = |x, y, z| Point3::new(x, y, z);
        // As functions they have a triangle wave, whose values POV-Ray shortens by 2e-5.
        for (n, z, want) in [(1.0, 0.0, 1.0), (2.0, 0.0, 0.0), (3.0, 0.0, 0.6), (1.0, 0.1, 0.6)] {
            assert!((triangle(spiral(at(0.3, 0.0, z), n, true, 0.0)) - want).abs() < 3e-5);
        }
        let quilts = [(1.0, 1.0, 0.3, 0.07586), (0.0, 1.0, 0.4, 0.05419), (1.0, 0.0, 0.5, 0.09623)];
        for (bottom, top, x, want) in quilts {
            // Of both sides of a border, the one that begins there counts.
            let x = 0.5 + x - if x == 0.5 { 1e-9 } else { 0.0 };
            assert!((quilted(at(x, 0.5, 0.5), bottom, top) - want).abs() < 1e-5, "{bottom} {top} {x}");
        }
    }
}
