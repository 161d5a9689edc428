//! Texture coordinates of hits: where POV-Ray's surfaces have their `u` and `v`.
//!
//! In the shape's own frame, with `turn(z, x) = atan2(z, x)/(2 pi)`:
//!
//! ```text
//!   sphere   u = turn(z, x) mod 1,   v = 1/2 + asin(y)/pi                   around its centre
//!   torus    u = 1/2 - turn(z, x),   v = 1/2 + turn(y, sqrt(x^2 + z^2) - R)
//!   box      its six sides unfolded to a cross of 4 by 3 rectangles that fills the unit square
//!   mesh     interpolated between the corners; 0 for faces without
//!   sor      u as of a sphere,   v from 0 to 1 along y, with an equal share for each of its pieces;
//!            from -1 to 0 from the axis to the rim of its lower end, from 1 to 2 back to the axis of the upper
//!   lathe    u as of a sphere,   v from 0 to 1 along its segments, each of which has an equal share
//!   others   u = x, v = y of the point in the world
//! ```
//!
//! All were measured from POV-Ray 3.7.

use core::f64::consts::{PI, TAU};
use std::sync::Arc;

use durer_math::{Point3, Vec3, elementary};

use crate::{Mesh, Placement};

/// The texture coordinates of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The kind of the shape.
    pub kind: ChartKind,
    /// From the shape's frame to the world.
    pub placement: Placement,
    /// The number of the shape's first primitive.
    pub first: u32,
}

/// The kinds of shapes by their texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum ChartKind {
    /// Those without coordinates of their own.
    Flat,
    /// A sphere, by its centre.
    Sphere(Point3),
    /// A box, by its lowest and its highest corner.
    Box([Point3; 2]),
    /// A torus around y, by the radius of its middle line.
    Torus(f64),
    /// A mesh.
    Mesh(Arc<Mesh>),
    /// A surface of revolution around y, by the radii and heights of its points. The first and the
    /// last one are not on it.
    Revolution(Arc<[[f64; 2]]>),
    /// A lathe of straight segments, by the radii and heights of its points.
    Lathe(Arc<[[f64; 2]]>),
}

fn turn(y: f64, x: f64) -> f64 {
    elementary::atan2(y, x) / TAU
}

impl Chart {
    /// The texture coordinates of a point of the world on a primitive of the shape.
    pub fn uv(&self, p: Point3, primitive: u32) -> [f64; 2] {
        let own = || self.placement.affine().inverse_point(p);
        match &self.kind {
            ChartKind::Flat => [p.x, p.y],
            ChartKind::Sphere(centre) => {
                let Vec3 { x, y, z } = own() - *centre;
                let u = turn(z, x);
                [u - u.floor(), 0.5 + elementary::atan2(y, (x * x + z * z).sqrt()) / PI]
            }
            ChartKind::Torus(major) => {
                let Point3 { x, y, z } = own();
                [0.5 - turn(z, x), 0.5 + turn(y, (x * x + z * z).sqrt() - major)]
            }
            ChartKind::Box([low, high]) => {
                let (from, to, at) = (low.to_array(), high.to_array(), own().to_array());
                unfolded(core::array::from_fn(|i| 2.0 * (at[i] - from[i]) / (to[i] - from[i]) - 1.0))
            }
            ChartKind::Mesh(mesh) => match primitive.checked_sub(self.first) {
                Some(face) => of_face(mesh, face as usize, own()).unwrap_or([0.0; 2]),
                None => [0.0; 2],
            },
            ChartKind::Revolution(points) => {
                let Point3 { x, y, z } = own();
                let u = turn(z, x);
                [u - u.floor(), climbed(points, [(x * x + z * z).sqrt(), y])]
            }
            ChartKind::Lathe(points) => {
                let Point3 { x, y, z } = own();
                let u = turn(z, x);
                [u - u.floor(), along(points, [(x * x + z * z).sqrt(), y])]
            }
        }
    }
}

/// The point of the unit square for a point on the cube from -1 to 1, or in the direction of it.
///
/// ```text
///            +y
///        -x  +z  +x  -z        four squares wide, three high
///            -y
/// ```
pub fn unfolded([x, y, z]: [f64; 3]) -> [f64; 2] {
    let (a, b, c) = (x.abs(), y.abs(), z.abs());
    if a == 0.0 && b == 0.0 && c == 0.0 {
        return [0.0; 2];
    }
    // The column and the row of the square, and the place in it from -1 to 1.
    let (column, row, u, v) = if b > a && b > c {
        let (up, x, z) = (if y > 0.0 { 2.0 } else { 0.0 }, x / b, z / b);
        (1.0, up, x, if y > 0.0 { -z } else { z })
    } else if a > c {
        if x > 0.0 { (2.0, 1.0, -z / a, y / a) } else { (0.0, 1.0, z / a, y / a) }
    } else if z > 0.0 {
        (1.0, 1.0, x / c, y / c)
    } else {
        (3.0, 1.0, -x / c, y / c)
    };
    [(column + (1.0 + u) / 2.0) / 4.0, (row + (1.0 + v) / 2.0) / 3.0]
}

/// So near to the height of an end, in units of the surface's size, a point counts as one of the flat
/// end. The coordinates of points are known better, and a point of the wall that is as near to the rim
/// has nearly the same coordinate either way.
const NEAR_END: f64 = 1.0 / (1_u64 << 32) as f64;

/// The way along a surface of revolution to a radius and a height: from 0 to 1 along its pieces, less on
/// the lower end, more on the upper one.
fn climbed(points: &[[f64; 2]], [r, y]: [f64; 2]) -> f64 {
    let pieces = points.len().saturating_sub(3);
    let [Some(&lower), Some(&upper)] = [points.get(1), points.get(pieces + 1)] else { return 0.0 };
    let size = points.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    let is_on = |[rim, height]: [f64; 2]| r < rim && (y - height).abs() <= NEAR_END * size;
    if is_on(lower) {
        return r / lower[0] - 1.0;
    }
    if is_on(upper) {
        return 2.0 - r / upper[0];
    }
    for number in 0..pieces {
        let (from, to) = (points[number + 1][1], points[number + 2][1]);
        if y <= to || number + 1 == pieces {
            return (number as f64 + (y - from) / (to - from)) / pieces as f64;
        }
    }
    0.0
}

/// The way along segments to the one of their points that is nearest to `p`, from 0 to 1.
fn along(points: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let (mut nearest, mut way) = (f64::INFINITY, 0.0);
    for (number, ends) in points.windows(2).enumerate() {
        let (from, to) = (ends[0], ends[1]);
        let d = [to[0] - from[0], to[1] - from[1]];
        let square = d[0] * d[0] + d[1] * d[1];
        if square == 0.0 {
            continue;
        }
        let t = ((p[0] - from[0]) * d[0] + (p[1] - from[1]) * d[1]) / square;
        let t = t.clamp(0.0, 1.0);
        let off = [from[0] + t * d[0] - p[0], from[1] + t * d[1] - p[1]];
        let distance = off[0] * off[0] + off[1] * off[1];
        if distance < nearest {
            (nearest, way) = (distance, number as f64 + t);
        }
    }
    way / (points.len().max(2) - 1) as f64
}

/// The coordinates of a point of a face, between those of its corners; `None` if it has none.
fn of_face(mesh: &Mesh, face: usize, p: Point3) -> Option<[f64; 2]> {
    let named = mesh.uv_faces.get(face).copied().flatten()?;
    let corner = |i: usize| mesh.vertices.get(mesh.faces.get(face)?.vertices[i] as usize).copied();
    let uv = |i: usize| mesh.uv.get(named[i] as usize).copied();
    let (o, a, b) = (corner(0)?, corner(1)? - corner(0)?, corner(2)? - corner(0)?);
    let n = a.cross(b);
    let square = n.dot(n);
    let d = p - o;
    let (s, t) = (d.cross(b).dot(n) / square, a.cross(d).dot(n) / square);
    let (o, a, b) = (uv(0)?, uv(1)?, uv(2)?);
    Some([0, 1].map(|k| o[k] + (a[k] - o[k]) * s + (b[k] - o[k]) * t))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(kind: ChartKind, p: [f64; 3]) -> [f64; 2] {
        let chart = Chart { kind, placement: Placement::IDENTITY, first: 0 };
        chart.uv(Point3::new(p[0], p[1], p[2]), 0)
    }

    fn close(a: [f64; 2], b: [f64; 2]) {
        assert!((a[0] - b[0]).abs() < 2e-4 && (a[1] - b[1]).abs() < 2e-4, "{a:?} instead of {b:?}");
    }

    /// Values of POV-Ray.
    #[test]
    fn coordinates_are_those_of_the_scene_language() {
        let y: f64 = 16.0 / 9.0;
        let z = -(4.0 - y * y).sqrt();
        close(at(ChartKind::Sphere(Point3::ORIGIN), [0.0, y, z]), [0.75, 0.8485]);
        close(at(ChartKind::Sphere(Point3::ORIGIN), [y, 0.0, z]), [0.9243, 0.5]);
        let sides = [Point3::new(-2.0, -2.0, -2.0), Point3::new(2.0, 2.0, 2.0)];
        close(at(ChartKind::Box(sides), [-y, 0.0, -2.0]), [0.9862, 0.5]);
        close(at(ChartKind::Box(sides), [0.0, 0.0, -2.0]), [0.875, 0.5]);
        close(at(ChartKind::Torus(1.2), [4.0 / 3.0, 0.482, 0.0]), [0.5, 0.707]);
        close(at(ChartKind::Torus(1.2), [0.0, 0.3915, 8.0 / 9.0]), [0.25, 0.8569]);
        let lathe = Arc::from([[1.0, -2.0], [1.8, 0.0], [1.0, 2.0]]);
        close(at(ChartKind::Lathe(lathe), [0.0, y, -1.0889]), [0.75, 0.9444]);
        let sor = Arc::from([[1.0, -3.0], [1.0, -2.0], [1.8, 1.0], [1.0, 2.0], [1.0, 3.0]]);
        close(at(ChartKind::Revolution(Arc::clone(&sor)), [0.0, 4.0 / 9.0, -1.0]), [0.75, 0.4074]);
        close(at(ChartKind::Revolution(Arc::clone(&sor)), [0.0, -2.0, -0.25]), [0.75, -0.75]);
        close(at(ChartKind::Revolution(sor), [0.0, 2.0, 0.25]), [0.25, 1.75]);
        close(at(ChartKind::Flat, [1.0, 2.0, 3.0]), [1.0, 2.0]);
    }

    /// Values of POV-Ray's cubic warp.
    #[test]
    fn cubes_are_unfolded_to_a_cross() {
        let values = [
            ([-1.4625, 1.3897, 1.0551], [0.21518, 0.65837]),
            ([0.6064, 1.1549, -1.6246], [0.82834, 0.61848]),
            ([1.0491, -1.9916, -0.2185], [0.44085, 0.14839]),
            ([0.8862, -1.085, 1.7811], [0.43719, 0.39847]),
            ([0.1656, 1.7566, -0.4752], [0.38679, 0.87842]),
            ([1.3503, 0.2258, 0.5692], [0.57231, 0.52787]),
        ];
        for (p, uv) in values {
            close(unfolded(p), uv);
        }
    }
}
