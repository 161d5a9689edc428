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
    /// The points. Those that are looked at first come first.
    points: Box<[Point]>,
    /// How many are looked at first; the others only where their shadows differ.
    pub(crate) first: usize,
}

/// A point of an area light.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// The position along the sides, from -1/2 to 1/2.
    at: (f64, f64),
    /// Its weight among all points, and among those that are looked at first.
    weights: [f64; 2],
}

impl Area {
    /// `None` for a single point in the middle.
    pub(super) fn new(area: &AreaLight) -> Option<Self> {
        let [columns, rows] = area.points;
        if columns * rows <= 1 {
            return None;
        }
        let mut weights = vec![[0.0; 2]; (columns * rows) as usize];
        let whole = [0, 0, columns - 1, rows - 1];
        spread(&mut weights, columns, whole, 1.0, 0, u32::MAX);
        spread(&mut weights, columns, whole, 1.0, 1, area.adaptive.unwrap_or(u32::MAX));
        let mut points = Vec::with_capacity(weights.len());
        for (number, weights) in (0..).zip(weights) {
            let at = |number: u32, of: u32| match of {
                1 => 0.0,
                _ => f64::from(number) / f64::from(of - 1) - 0.5,
            };
            let (u, v) = (at(number % columns, columns), at(number / columns, rows));
            points.push(Point { at: if area.circular { on_disc(u, v) } else { (u, v) }, weights });
        }
        points.sort_by_key(|point| point.weights[1] == 0.0);
        let first = points.iter().take_while(|point| point.weights[1] > 0.0).count();
        Some(Self { sides: area.sides, orient: area.orient, points: points.into(), first })
    }

    /// The weight of a point among all points, and among those that are looked at first.
    pub(crate) fn weights(&self, number: usize) -> [f64; 2] {
        self.points[number].weights
    }

    /// The number of points.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// The way from the light's location to one of its points, for points that are lit from some
    /// directions.
    #[inline(always)]
    pub(crate) fn offset(&self, number: usize, to_light: Vec3<F8>) -> Vec3<F8> {
        let (u, v) = self.points[number].at;
        let [a, b] = self.sides;
        if !self.orient {
            return Vec3::<F8>::splat(a * u + b * v);
        }
        let (across, up) = around(to_light);
        across * F8::splat(u * length(a)) + up * F8::splat(v * length(b))
    }
}

/// Adds the weights of the points of a part of the grid, from one corner to the other: the mean of
/// the four corners, or of four smaller parts, down to the given depth.
fn spread(
    weights: &mut [[f64; 2]],
    columns: u32,
    [u1, v1, u2, v2]: [u32; 4],
    weight: f64,
    kind: usize,
    depth: u32,
) {
    if depth == 0 || (u2 <= u1 + 1 && v2 <= v1 + 1) {
        for (u, v) in [(u1, v1), (u2, v1), (u1, v2), (u2, v2)] {
            weights[(v * columns + u) as usize][kind] += weight * 0.25;
        }
        return;
    }
    let (u, v) = ((u1 + u2) / 2, (v1 + v2) / 2);
    for part in [[u1, v1, u, v], [u, v1, u2, v], [u1, v, u, v2], [u, v, u2, v2]] {
        spread(weights, columns, part, weight * 0.25, kind, depth - 1);
    }
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
            illuminates: false,
        };
        let area = Area::new(&area).unwrap();
        assert_eq!((area.first, area.len()), (4, 15));
        assert_eq!(area.points[0].at, (-0.5, -0.5));
        let sum = |kind: usize| area.points.iter().map(|point| point.weights[kind]).sum::<f64>();
        assert_eq!([sum(0), sum(1)], [1.0, 1.0]);
    }

    #[test]
    fn squares_become_circles() {
        for (u, v) in [(0.5, 0.5), (-0.5, 0.1), (0.2, -0.5), (0.5, 0.0)] {
            let (x, y) = on_disc(u, v);
            assert!(((x * x + y * y).sqrt() - 0.5).abs() < 1e-12);
            assert!(x * u >= 0.0 && y * v >= 0.0);
        }
    }
}
