//! The points of an area light, which throw soft shadows.

use crate::vector::{dot, length};
use durer_math::{F8, Vec3};
use durer_scene::AreaLight;

/// The points of a round light lie aside by this fraction of its sides, before the square becomes a disc (a fact of
/// the scene language).
const ASIDE: f64 = 0.001;

/// The points of an area light.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    sides: [Vec3; 2],
    orient: bool,
    points: Box<[Point]>,
    /// The parts that an adaptive light may leave undivided; empty if all points are tested.
    parts: Box<[Part]>,
}

/// A point of an area light.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// The position along the sides, from -1/2 to 1/2.
    at: (f64, f64),
    /// Its weight among all points.
    weight: f64,
}

/// A part of the grid of an adaptive light, in the order of a walk that visits each part before the
/// parts that it is divided into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    /// The points at its corners.
    pub(crate) corners: [usize; 4],
    /// How often the grid was divided to make it.
    pub(crate) depth: usize,
    /// The weight of each corner if it is not divided.
    pub(crate) weight: f64,
    pub(crate) divides: Divides,
    /// The first part that is not one of its own parts.
    pub(crate) next: usize,
}

/// When a part of the grid is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Divides {
    Always,
    /// Where the shadows of its corners differ.
    WhereCornersDiffer,
    Never,
}

impl Area {
    /// `None` for a single point in the middle.
    pub(super) fn new(area: &AreaLight) -> Option<Self> {
        let [columns, rows] = area.points;
        if columns * rows <= 1 {
            return None;
        }
        // A light that turns towards the points is round, too, unless it is a row.
        let is_round = (area.circular || area.orient) && columns > 1 && rows > 1;
        let mut walk = Vec::new();
        let grid = Cells { columns, depth: 0, adaptive: area.adaptive.unwrap_or(u32::MAX) };
        grid.divide([0, 0, columns - 1, rows - 1], 0.25, &mut walk);
        let mut weights = vec![0.0; (columns * rows) as usize];
        // All parts that are not divided, if corners differ everywhere.
        for part in walk.iter().filter(|part| part.divides == Divides::Never) {
            part.corners.iter().for_each(|&corner| weights[corner] += part.weight);
        }
        let mut points = Vec::with_capacity(weights.len());
        for (number, weight) in (0..).zip(weights) {
            let at = |number: u32, of: u32| match of {
                1 => 0.0,
                _ => f64::from(number) / f64::from(of - 1) - 0.5,
            };
            let (u, v) = (at(number % columns, columns), at(number / columns, rows));
            points.push(Point { at: if is_round { on_disc(u + ASIDE, v + ASIDE) } else { (u, v) }, weight });
        }
        if !walk.iter().any(|part| part.divides == Divides::WhereCornersDiffer) {
            walk.clear();
        }
        Some(Self { sides: area.sides, orient: area.orient, points: points.into(), parts: walk.into() })
    }

    /// The weight of a point among all points.
    pub(crate) fn weight(&self, number: usize) -> f64 {
        self.points[number].weight
    }

    /// The number of points.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// The parts of an adaptive light; empty if all points are tested.
    pub(crate) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The way from the light's location to one of its points, for points that are lit from some
    /// directions.
    #[inline(always)]
    pub(crate) fn offset(&self, number: usize, to_light: Vec3<F8>) -> Vec3<F8> {
        let (u, v) = self.points[number].at;
        let [first, second] = self.sides;
        if !self.orient {
            return Vec3::<F8>::splat(first * u + second * v);
        }
        // The first side alone gives the size.
        let (across, up) = around(to_light);
        (across * F8::splat(u) + up * F8::splat(v)) * F8::splat(length(first))
    }
}

/// The grid of an area light at some depth.
#[derive(Clone, Copy)]
struct Cells {
    columns: u32,
    depth: u32,
    adaptive: u32,
}

impl Cells {
    /// Adds the part of the grid between two corners, and all parts of it.
    ///
    /// A fact of the scene language: parts with a point in their middle share it, others are split
    /// between two points. A part counts by the mean of its corners.
    fn divide(self, [u1, v1, u2, v2]: [u32; 4], weight: f64, walk: &mut Vec<Part>) {
        let corner = |(u, v): (u32, u32)| (v * self.columns + u) as usize;
        let divides = if u2 <= u1 + 1 && v2 <= v1 + 1 {
            Divides::Never
        } else if self.depth < self.adaptive {
            Divides::Always
        } else {
            Divides::WhereCornersDiffer
        };
        let number = walk.len();
        walk.push(Part {
            corners: [(u1, v1), (u2, v1), (u1, v2), (u2, v2)].map(corner),
            depth: self.depth as usize,
            weight,
            divides,
            next: 0,
        });
        if divides != Divides::Never {
            let below = Self { depth: self.depth + 1, ..self };
            let ([ua, va], [ub, vb]) =
                ([(u1 + u2) / 2, (v1 + v2) / 2], [(u1 + u2).div_ceil(2), (v1 + v2).div_ceil(2)]);
            for part in [[u1, v1, ua, va], [ub, v1, u2, va], [u1, vb, ua, v2], [ub, vb, u2, v2]] {
                below.divide(part, weight * 0.25, walk);
            }
        }
        walk[number].next = walk.len();
    }
}

/// Two unit vectors across a direction and each other; the first one is across z, too.
///
/// A fact of the language: highlights of a smooth floor under POV-Ray's lights show all points.
fn around(d: Vec3<F8>) -> (Vec3<F8>, Vec3<F8>) {
    let along_z = F8::splat(0.99).lt(d.z.abs());
    let helper = along_z.select3(Vec3::<F8>::splat(Vec3::Y), Vec3::<F8>::splat(Vec3::Z));
    let across = cross(d, helper);
    let across = across * (F8::ONE / dot(across, across).sqrt());
    (across, cross(d, across))
}

fn cross(a: Vec3<F8>, b: Vec3<F8>) -> Vec3<F8> {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// The point of a disc for a point of the square around it, in the same direction: squares become
/// circles.
fn on_disc(u: f64, v: f64) -> (f64, f64) {
    let r = u.abs().max(v.abs());
    if r == 0.0 {
        return (0.0, 0.0);
    }
    let shrink = r / (u * u + v * v).sqrt();
    (u * shrink, v * shrink)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(columns: u32, rows: u32, adaptive: Option<u32>) -> Area {
        let area = AreaLight {
            sides: [Vec3::X, Vec3::Y],
            points: [columns, rows],
            circular: false,
            orient: false,
            adaptive,
            illuminates: false,
        };
        Area::new(&area).unwrap()
    }

    #[test]
    fn the_first_side_of_an_oriented_light_is_across_z() {
        for d in [Vec3::Y, Vec3::new(-0.512, 0.768, -0.384), Vec3::new(0.6, 0.0, 0.8)] {
            let (across, up) = around(Vec3::<F8>::splat(d));
            let (across, up) = (across.lane(0), up.lane(0));
            assert_eq!(across.z, 0.0);
            assert!((dot(across, across) - 1.0).abs() < 1e-15);
            assert!(
                dot(across, d).abs() < 1e-15 && dot(up, d).abs() < 1e-15 && dot(up, across).abs() < 1e-15
            );
        }
    }

    /// Weights measured with POV-Ray, by hiding one point after the other.
    #[test]
    fn weights_are_those_of_the_scene_language() {
        let weights = |n: u32| grid(n, 1, None).points.iter().map(|p| p.weight * 8.0).collect::<Vec<_>>();
        assert_eq!(weights(3), [2.0, 4.0, 2.0]);
        assert_eq!(weights(4), [2.0; 4]);
        assert_eq!(weights(5), [1.0, 2.0, 2.0, 2.0, 1.0]);
        assert_eq!(weights(6), [1.0, 2.0, 1.0, 1.0, 2.0, 1.0]);
        assert_eq!(weights(7), [1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn adaptive_lights_are_divided_where_corners_differ() {
        assert!(grid(4, 4, None).parts().is_empty());
        let area = grid(5, 3, Some(1));
        assert_eq!(area.points[0].at, (-0.5, -0.5));
        assert_eq!(area.points.iter().map(|point| point.weight).sum::<f64>(), 1.0);
        let parts = area.parts();
        let first =
            Part { corners: [0, 4, 10, 14], depth: 0, weight: 0.25, divides: Divides::Always, next: 21 };
        assert_eq!((parts.len(), parts[0]), (21, first));
        assert_eq!((parts[1].divides, parts[1].next), (Divides::WhereCornersDiffer, 6));
        assert_eq!((parts[2].divides, parts[2].next), (Divides::Never, 3));
    }

    /// Points measured with POV-Ray, as highlights on a floor under the light, which lie below its points.
    #[test]
    fn points_of_round_lights_are_those_of_the_scene_language() {
        let light = AreaLight {
            sides: [Vec3::X * 3.0, Vec3::Z * 2.0],
            points: [2, 2],
            circular: true,
            orient: false,
            adaptive: None,
            illuminates: true,
        };
        let at = |light: AreaLight, number, from: Vec3| {
            let offset = Area::new(&light).unwrap().offset(number, Vec3::<F8>::splat(from)).lane(0);
            [offset.x, offset.y, offset.z].map(|x| (x * 1e4).round() / 1e4)
        };
        let square = AreaLight { sides: [Vec3::X * 3.0, Vec3::Z * 3.0], ..light };
        assert_eq!(at(square, 0, Vec3::Y), [-1.0585, 0.0, -1.0585]);
        assert_eq!(at(square, 1, Vec3::Y), [1.0649, 0.0, -1.0607]);
        assert_eq!(at(square, 3, Vec3::Y), [1.0628, 0.0, 1.0628]);
        let row = AreaLight { points: [2, 1], circular: false, ..light };
        assert_eq!(at(row, 1, Vec3::Y), [1.5, 0.0, 0.0]);
        // Turned lights are round, and their second side has the length of the first one.
        let turned = AreaLight { circular: false, orient: true, ..light };
        assert_eq!(at(turned, 0, Vec3::Y), [-1.0585, 0.0, 1.0585]);
        assert_eq!(at(turned, 0, Vec3::Z), [1.0585, 1.0585, 0.0]);
    }

    #[test]
    fn squares_become_circles() {
        for (u, v) in [(0.5, 0.5), (-0.5, 0.1), (0.2, -0.5), (0.5, 0.0)] {
            let (x, y) = on_disc(u, v);
            assert!(((x * x + y * y).sqrt() - 0.5).abs() < 1e-12);
            assert!(x * u >= 0.0 && y * v >= 0.0 && (x * v - y * u).abs() < 1e-12);
        }
    }
}
