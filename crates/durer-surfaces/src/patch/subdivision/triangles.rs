//! Loop's rules for triangles.
//!
//! ```text
//!   each triangle becomes four        edge point     3/8 (a + b) + 1/8 (c + d)
//!          2                                         a, b its ends; c, d opposite to it on both sides
//!         ╱ ╲                         vertex point   (1 - n w) v + w sum(e),  n edges, other ends e,
//!        ●───●                                       w = (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n
//!       ╱ ╲ ╱ ╲                       creases and corners as in `topology.rs`
//!      0───●───1
//! ```
//!
//! All weights are at least 0 and have the sum 1. Where all vertices have six edges, the limit is a
//! box spline of three directions, each twice: quartic over each triangle, by 12 points. On a crease or
//! a boundary it is that of points mirrored in it: across the edge of `a` and `b` from `c` the point is
//! `a + b - c`, and at a corner of one triangle the net is symmetric about the corner. Both rules of the
//! mirrored mesh are those of creases and corners, so that the limits are the same.
//!
//! C. Loop, *Smooth subdivision surfaces based on triangles*, master's thesis, University of Utah 1987;
//! creases and limits: H. Hoppe, T. DeRose, T. Duchamp, M. Halstead, H. Jin, J. McDonald, J. Schweitzer,
//! W. Stuetzle, "Piecewise smooth surface reconstruction", *SIGGRAPH* 1994; sharpness: T. DeRose,
//! M. Kass, T. Truong, "Subdivision surfaces in character animation", *SIGGRAPH* 1998; the polynomials:
//! J. Stam, "Evaluation of Loop subdivision surfaces", *SIGGRAPH* 1998 (course notes), and M.-J. Lai,
//! "Fortran subroutines for B-nets of box splines on three- and four-directional meshes", *Numerical
//! Algorithms* 2 (1992) 33-38.

use super::plan::{Wheel, side_of_crease};
use super::topology::{Adjacency, Fan, Rule, Topology, apply};
use crate::patch::triangle_net::TriangleNet;
use durer_math::Dd;
use durer_math::elementary;

/// The weights of an edge point: of each end, and of each vertex opposite to the edge.
pub(super) const NEAR: f64 = 0.375;
pub(super) const OPPOSITE: f64 = 0.125;

/// The weight of each neighbour of a smooth vertex with `n` edges.
pub(super) fn neighbour_weight(n: usize) -> Dd {
    let root = Dd::from(0.375) + cosine(n).scale2(-2);
    (Dd::from(0.625) - root * root) / Dd::from(n as f64)
}

/// `cos(2 pi / n)`.
fn cosine(n: usize) -> Dd {
    match n {
        1 => return Dd::ONE,
        2 => return Dd::from(-1.0),
        3 => return Dd::from(-0.5),
        4 => return Dd::ZERO,
        6 => return Dd::from(0.5),
        _ => {}
    }
    // 2 pi to 107 bits; the angle is at most 1.26, so that 17 terms leave out less than 2^-115.
    let angle = Dd { hi: core::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 } / Dd::from(n as f64);
    let square = -(angle * angle);
    let (mut sum, mut term) = (Dd::ONE, Dd::ONE);
    for k in 1..17 {
        term = term * square / Dd::from(f64::from((2 * k - 1) * (2 * k)));
        sum = sum + term;
    }
    sum
}

/// The 12 points that a triangle's box spline depends on, those of them that are in the mesh: its
/// corners; across the edge from each corner to the next; and beside each corner two more, next to the
/// point across that edge and next to the one across the edge before.
pub(super) type Patch = [Option<u32>; 12];

/// The points of the box spline of the first face, if it has one.
pub(super) fn regular(mesh: &Topology, fans: &[Fan]) -> Option<Patch> {
    let adjacency = Adjacency::new(mesh);
    let corner = |k: usize| (k % 3) as u32;
    let place_of = |fan: &Fan, v: u32| fan.ends.iter().position(|e| *e == v);
    // Whether the edge from corner k to the next one is sharp.
    let mut sharp = [false; 3];
    for k in 0..3 {
        sharp[k] = fans[k].sharpness[place_of(&fans[k], corner(k + 1))?] > 0.0;
    }
    let mut net = [None; 12];
    for k in 0..3 {
        net[k] = Some(corner(k));
        if !sharp[k] {
            let (_, [opposite, _]) = adjacency.across(corner(k + 1), corner(k))?;
            net[3 + k] = Some(opposite);
        }
    }
    for k in 0..3 {
        let fan = &fans[k];
        let before = (k + 2) % 3;
        let is_crease = || fan.rule() == Rule::Crease && side_of_crease(fan, 0) == 3;
        if !fan.is_final() {
            return None;
        }
        // The ends that are next to the points across both edges.
        let beside = |across: Option<u32>, step: usize| {
            let n = fan.ends.len();
            Some(fan.ends[(place_of(fan, across?)? + step) % n])
        };
        match (sharp[k], sharp[before]) {
            (false, false) if is_crease() => {}
            (false, false) => {
                let is_smooth = fan.rule() == Rule::Smooth && fan.sharpness.iter().all(|s| *s == 0.0);
                if !is_smooth || fan.is_open() || fan.faces.len() != 6 {
                    return None;
                }
                net[6 + 2 * k] = Some(beside(net[3 + k], 5)?);
                net[7 + 2 * k] = Some(beside(net[3 + before], 1)?);
            }
            (true, false) if is_crease() => net[7 + 2 * k] = Some(beside(net[3 + before], 1)?),
            (false, true) if is_crease() => {
                let n = fan.ends.len();
                net[6 + 2 * k] = Some(beside(net[3 + k], n - 1)?);
            }
            (true, true) if fan.rule() == Rule::Corner => {}
            _ => return None,
        }
    }
    Some(net)
}

/// All 12 points: those that are not in the mesh are mirror images.
fn complete<T: Copy>(net: &[Option<T>; 12], mirror: impl Fn(T, T, T) -> T) -> Option<[T; 12]> {
    let [a, b, c] = [net[0]?, net[1]?, net[2]?];
    let own = [a, b, c];
    let mut all = [a; 12];
    for k in 0..3 {
        let (next, before) = ((k + 1) % 3, (k + 2) % 3);
        all[k] = own[k];
        all[3 + k] = net[3 + k].unwrap_or_else(|| mirror(own[k], own[next], own[before]));
    }
    for k in 0..3 {
        let (next, before) = ((k + 1) % 3, (k + 2) % 3);
        let v = own[k];
        let (ahead, behind) = (all[3 + k], all[3 + before]);
        let tips = match (net[6 + 2 * k], net[7 + 2 * k]) {
            (Some(p), Some(q)) => [p, q],
            // A crease along the edge to the next corner, or along the one before.
            (None, Some(q)) => [mirror(q, v, behind), q],
            (Some(p), None) => [p, mirror(p, v, ahead)],
            // A corner, or a crease that only touches the triangle there.
            (None, None) if net[3 + k].is_none() => [mirror(v, v, own[before]), mirror(v, v, own[next])],
            (None, None) => [mirror(v, ahead, own[next]), mirror(v, behind, own[before])],
        };
        [all[6 + 2 * k], all[7 + 2 * k]] = tips;
    }
    Some(all)
}

/// 24 times the weight of one of the 12 points in a Bezier point of a triangle, which is its blossom at
/// each corner as often as `times` says.
fn weight(point: usize, times: [usize; 3]) -> u8 {
    let k = if point < 6 { point % 3 } else { (point - 6) / 2 };
    let [own, next, before] = [0, 1, 2].map(|i| times[(k + i) % 3]);
    // Of the corner's own points, by how evenly the rest is shared.
    let far = |a: usize, b: usize| [2, 3, 4][a.min(b)];
    match point {
        0..3 => match (own, next.min(before)) {
            (3 | 4, _) => 12,
            (2, 0) => 8,
            (2, _) => 10,
            (1, 0) => 4,
            (1, _) => 6,
            _ => far(next, before),
        },
        3..6 => match before {
            0 => far(own, next),
            1 => 1,
            _ => 0,
        },
        _ => {
            let beside = if point.is_multiple_of(2) { next } else { before };
            match (own, beside) {
                (4, _) => 2,
                (3, 1) => 1,
                _ => 0,
            }
        }
    }
}

/// The Bezier net of a triangle that has one; `None` without its corners.
///
/// Mirror images and sums make the errors of points less than four times as large.
pub(super) fn bezier(net: &Patch, points: &[[Dd; 3]]) -> Option<TriangleNet> {
    let given = net.map(|v| v.map(|v| points[v as usize]));
    let all = complete(&given, |a, b, c| [0, 1, 2].map(|i| a[i] + b[i] - c[i]))?;
    let by = Dd::ONE / Dd::from(24.0);
    let mut out = Vec::with_capacity(15);
    for v in 0..5 {
        for u in 0..5 - v {
            let times = [4 - u - v, u, v];
            let mut sum = [Dd::ZERO; 3];
            for (k, p) in all.iter().enumerate() {
                let weight = weight(k, times);
                if weight > 0 {
                    sum = [0, 1, 2].map(|c| sum[c] + p[c] * f64::from(weight));
                }
            }
            let [x, y, z] = sum.map(|x| x * by);
            out.push([x, y, z, Dd::ONE]);
        }
    }
    Some(TriangleNet { side: 5, points: out, lost: durer_math::scale::pow2(-91) })
}

/// The limit of a smooth vertex and two tangents there, of which `first x second` is the normal.
///
/// Hoppe et al. 1994, appendix A: the position is `(3 v / (8 w) + sum(e)) / (3 / (8 w) + n)`, the
/// tangents are `sum(cos(2 pi k / n) e_k)`, beginning at one end or at the next.
pub(super) fn limit(wheel: &Wheel, points: &[[Dd; 3]]) -> [[Dd; 3]; 3] {
    let n = wheel.ends.len();
    let centre = Dd::from(0.375) / neighbour_weight(n);
    let mut all = vec![(wheel.centre, centre)];
    all.extend(wheel.ends.iter().map(|e| (*e, Dd::ONE)));
    let by = Dd::ONE / (centre + Dd::from(n as f64));
    let position = apply(&all, points).map(|x| x * by);
    // Relative to the vertex, so that nothing is lost however small the wheel is.
    let own = points[wheel.centre as usize];
    let relative: Vec<[Dd; 3]> = points.iter().map(|p| [0, 1, 2].map(|c| p[c] - own[c])).collect();
    let tangent = |first: usize| {
        let cos = |k: usize| elementary::cos(2.0 * core::f64::consts::PI * k as f64 / n as f64);
        let all: Vec<_> = (0..n).map(|k| (wheel.ends[(first + k) % n], Dd::from(cos(k)))).collect();
        apply(&all, &relative)
    };
    [position, tangent(0), tangent(1)]
}
