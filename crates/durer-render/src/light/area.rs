//! The points of an area light, which throw soft shadows.

use crate::vector::{dot, length};
use core::f64::consts::FRAC_PI_4;
use durer_math::{F8, Vec3, elementary};
use durer_scene::AreaLight;

/// The points of an area light.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    sides: [Vec3; 2],
    orient: bool,
    /// The positions along the sides, from -1/2 to 1/2. Those that are looked at first come first.
    points: Box<[(f64, f64)]>,
    /// How many are looked at first; the others only where their shadows differ.
    pub(crate) first: usize,
}

impl Area {
    /// `None` for a single point in the middle.
    pub(super) fn new(area: &AreaLight) -> Option<Self> {
        let [columns, rows] = area.points;
        if columns * rows <= 1 {
            return None;
        }
        let mut points = Vec::with_capacity((columns * rows) as usize);
        let mut rest = Vec::new();
        for row in 0..rows {
            for column in 0..columns {
                let at = |number: u32, of: u32| match of {
                    1 => 0.0,
                    _ => f64::from(number) / f64::from(of - 1) - 0.5,
                };
                let (u, v) = (at(column, columns), at(row, rows));
                let place = if area.circular { on_disc(u, v) } else { (u, v) };
                let is_first = area
                    .adaptive
                    .is_none_or(|level| is_coarse(column, columns, level) && is_coarse(row, rows, level));
                if is_first { &mut points } else { &mut rest }.push(place);
            }
        }
        let first = points.len();
        points.extend(rest);
        Some(Self { sides: area.sides, orient: area.orient, points: points.into(), first })
    }

    /// The number of points.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// The way from the light's location to one of its points, for points that are lit from some
    /// directions.
    #[inline(always)]
    pub(crate) fn offset(&self, number: usize, to_light: Vec3<F8>) -> Vec3<F8> {
        let (u, v) = self.points[number];
        let [a, b] = self.sides;
        if !self.orient {
            return Vec3::<F8>::splat(a * u + b * v);
        }
        let (across, up) = around(to_light);
        across * F8::splat(u * length(a)) + up * F8::splat(v * length(b))
    }
}

/// Whether a point belongs to the coarse grid of a level.
fn is_coarse(number: u32, of: u32, level: u32) -> bool {
    let parts = 1_u32 << level.min(16);
    let last = of - 1;
    (0..=parts).any(|k| (k * last + parts / 2) / parts == number)
}

/// Two unit vectors across a direction and each other.
fn around(d: Vec3<F8>) -> (Vec3<F8>, Vec3<F8>) {
    let steep = F8::splat(0.9).lt(d.y.abs());
    let helper = steep.select3(Vec3::<F8>::splat(Vec3::X), Vec3::<F8>::splat(Vec3::Y));
    let across = cross(helper, d);
    let across = across * (F8::ONE / dot(across, across).sqrt());
    (across, cross(d, across))
}

fn cross(a: Vec3<F8>, b: Vec3<F8>) -> Vec3<F8> {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// The point of a disc for a point of the square around it: squares become circles.
fn on_disc(u: f64, v: f64) -> (f64, f64) {
    let r = u.abs().max(v.abs());
    if r == 0.0 {
        return (0.0, 0.0);
    }
    let angle = if u.abs() > v.abs() {
        FRAC_PI_4 * (v / u) + if u < 0.0 { 4.0 * FRAC_PI_4 } else { 0.0 }
    } else {
        2.0 * FRAC_PI_4 - FRAC_PI_4 * (u / v) + if v < 0.0 { 4.0 * FRAC_PI_4 } else { 0.0 }
    };
    (r * elementary::cos(angle), r * elementary::sin(angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_looked_at_first() {
        let area = AreaLight {
            sides: [Vec3::X, Vec3::Y],
            points: [5, 3],
            circular: false,
            orient: false,
            adaptive: Some(0),
        };
        let area = Area::new(&area).unwrap();
        assert_eq!((area.first, area.len()), (4, 15));
        assert_eq!(area.points[0], (-0.5, -0.5));
    }

    #[test]
    fn squares_become_circles() {
        for (u, v) in [(0.5, 0.5), (-0.5, 0.1), (0.2, -0.5), (0.5, 0.0)] {
            let (x, y) = on_disc(u, v);
            assert!((x.hypot(y) - 0.5).abs() < 1e-12);
            assert!(x * u >= 0.0 && y * v >= 0.0);
        }
    }
}
