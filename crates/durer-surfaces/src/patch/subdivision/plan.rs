//! Plans: the refinement of a face and its neighbourhood, step by step, without coordinates.
//!
//! A quadrilateral whose own vertices all follow the rules of B-splines is a bicubic patch, and a
//! triangle whose vertices follow those of box splines a quartic one. Any other is refined to four.
//! Faces with equal neighbourhoods share one plan, and after some steps the corner at an
//! extraordinary vertex has the plan of the corner before, so there are few plans, and a step is a
//! fixed list of sums (W. Brainerd, T. Foley, M. Kraemer, H. Moreton, M. Niessner, "Efficient GPU
//! rendering of subdivision surfaces using adaptive quadtrees", *SIGGRAPH* 2016). That a boundary
//! or a crease is that of a B-spline with points mirrored in it: J. M. Lane, R. F. Riesenfeld, "A
//! theoretical development for the computer generation and display of piecewise polynomial
//! surfaces", *IEEE PAMI* 2 (1980) 35-46, end conditions.

use super::Scheme;
use super::topology::{Adjacency, Fan, Rule, Stencil, Topology, apply};
use super::triangles;
use crate::patch::net::{FaceNet, Homogeneous, Net};
use durer_math::Dd;
use durer_math::elementary;
use std::collections::HashMap;

/// A quarter of a face: its plan, and the points of the finer mesh that it uses.
#[derive(Clone, Debug)]
pub(super) struct Quarter {
    pub(super) plan: u32,
    pub(super) points: Box<[u32]>,
}

/// A smooth interior vertex: its own point, the ends of its edges and, except for triangles, the
/// opposite points of its faces, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Wheel {
    pub(super) centre: u32,
    pub(super) ends: Box<[u32]>,
    pub(super) across: Box<[u32]>,
}

/// How a face is intersected.
#[derive(Clone, Debug)]
pub(super) enum Plan {
    /// A bicubic B-spline patch: the points of its net, row by row from v = -1 on; without those
    /// that are mirrored.
    Regular(Box<[Option<u32>; 16]>),
    /// A quartic box spline over a triangle.
    Triangle(Box<triangles::Patch>),
    /// Four faces: at (0, 0), (1, 0), (1, 1) and (0, 1); of a triangle at (0, 0), (1, 0), (0, 1) and
    /// in the middle.
    Split {
        stencils: Box<[Stencil]>,
        quarters: Box<[Quarter; 4]>,
        /// The corners that are smooth and not on a boundary.
        wheels: Box<[Wheel]>,
    },
}

/// All plans, without duplicates.
#[derive(Default)]
pub(super) struct Plans {
    pub(super) all: Vec<Plan>,
    known: HashMap<Vec<u64>, u32>,
}

/// A key that is equal for equal neighbourhoods.
fn key(mesh: &Topology) -> Vec<u64> {
    let mut key = vec![mesh.points as u64, mesh.faces.len() as u64];
    key.extend(mesh.faces.iter().flat_map(|f| f.iter().map(|v| u64::from(*v))));
    for (&[a, b], sharpness) in &mesh.creases {
        key.extend([u64::from(a) << 32 | u64::from(b), sharpness.to_bits()]);
    }
    key.push(u64::MAX);
    for (&v, sharpness) in &mesh.corners {
        key.extend([u64::from(v), sharpness.to_bits()]);
    }
    key
}

/// The points of the B-spline net of a face, if it has one.
fn regular(mesh: &Topology, fans: &[Fan]) -> Option<[Option<u32>; 16]> {
    let adjacency = Adjacency::new(mesh);
    let corner = |k: usize| (k % 4) as u32;
    // The sharpness of the edge from corner k to the next one.
    let edge = |k: usize| {
        let fan = &fans[k];
        let at = fan.ends.iter().position(|e| *e == corner(k + 1))?;
        Some(fan.sharpness[at])
    };
    let sharp = [edge(0)?, edge(1)?, edge(2)?, edge(3)?].map(|s| s > 0.0);
    for k in 0..4 {
        let fan = &fans[k];
        if !fan.is_final() {
            return None;
        }
        let fits = match (sharp[k], sharp[(k + 3) % 4]) {
            (false, false) => {
                fan.rule() == Rule::Smooth
                    && fan.sharpness.iter().all(|s| *s == 0.0)
                    && !fan.is_open()
                    && fan.faces.len() == 4
            }
            // Of the two faces on this side of the crease, one follows the other.
            (true, false) | (false, true) => fan.rule() == Rule::Crease && side_of_crease(fan, 0) == 2,
            (true, true) => fan.rule() == Rule::Corner,
        };
        if !fits {
            return None;
        }
    }
    let mut net = [None; 16];
    let place = [[1, 1], [2, 1], [2, 2], [1, 2]];
    let mut set = |[i, j]: [usize; 2], v: u32| net[j * 4 + i] = Some(v);
    for k in 0..4 {
        set(place[k], k as u32);
    }
    for k in 0..4 {
        // Outward of the edge from corner k, as steps of the net.
        let out = [[0_isize, -1], [1, 0], [0, 1], [-1, 0]][k];
        let step = |[i, j]: [usize; 2]| [i.wrapping_add_signed(out[0]), j.wrapping_add_signed(out[1])];
        let next = (k + 1) % 4;
        if !sharp[k] {
            // Across the edge, that face goes from the next corner to this one.
            let (_, [after, before]) = adjacency.across(corner(next), corner(k))?;
            set(step(place[k]), after);
            set(step(place[next]), before);
        }
        if !sharp[k] && !sharp[(k + 3) % 4] {
            // Across the corner.
            let fan = &fans[k];
            let own = fan.faces.iter().position(|f| *f == 0)?;
            let opposite = fan.faces[(own + 2) % 4];
            let corners = &mesh.faces[opposite];
            let at = corners.iter().position(|v| *v == corner(k))?;
            let [i, j] = place[k];
            set([if i == 1 { 0 } else { 3 }, if j == 1 { 0 } else { 3 }], corners[(at + 2) % 4]);
        }
    }
    Some(net)
}

/// How many faces are between the two sharp edges of a crease, on the side of a face.
pub(super) fn side_of_crease(fan: &Fan, face: usize) -> usize {
    let n = fan.faces.len();
    let Some(own) = fan.faces.iter().position(|f| *f == face) else { return 0 };
    let is_sharp = |end: usize| fan.sharpness.get(end % fan.ends.len()).is_some_and(|s| *s > 0.0);
    let mut count = 1;
    // Counter-clockwise over the end behind each face, then clockwise over the one before.
    let mut now = own;
    while !is_sharp(now + 1) && count <= n {
        now += 1;
        count += 1;
    }
    let mut now = own + n;
    while !is_sharp(if fan.is_open() { now - n } else { now % n }) && count <= n {
        now -= 1;
        count += 1;
    }
    count
}

impl Plans {
    /// The plan of a face and its neighbourhood; `None` only if that is not a part of a valid mesh.
    pub(super) fn of(&mut self, mesh: &Topology) -> Option<u32> {
        let key = key(mesh);
        if let Some(&plan) = self.known.get(&key) {
            return Some(plan);
        }
        let adjacency = Adjacency::new(mesh);
        let sides = mesh.faces.first()?.len();
        let fans: Vec<Fan> = (0..sides as u32).map(|v| adjacency.fan(v, 0)).collect::<Option<_>>()?;
        let number = self.all.len() as u32;
        self.known.insert(key, number);
        let patch = match mesh.scheme {
            Scheme::CatmullClark => regular(mesh, &fans).map(|net| Plan::Regular(Box::new(net))),
            Scheme::Loop => triangles::regular(mesh, &fans).map(|net| Plan::Triangle(Box::new(net))),
        };
        if let Some(patch) = patch {
            self.all.push(patch);
            return Some(number);
        }
        // A placeholder, for corners whose plan is this one again.
        self.all.push(Plan::Regular(Box::new([None; 16])));
        let finer = adjacency.refined(|v| (v as usize) < sides);
        let wheel = |(k, fan): (usize, &Fan)| {
            let is_smooth = fan.is_final() && fan.rule() == Rule::Smooth && !fan.is_open();
            if !is_smooth || fan.sharpness.iter().any(|s| *s > 0.0) {
                return None;
            }
            if mesh.scheme == Scheme::Loop {
                return Some(Wheel { centre: k as u32, ends: fan.ends.clone().into(), across: [].into() });
            }
            let across = fan.faces.iter().map(|face| {
                let corners = &mesh.faces[*face];
                let at = corners.iter().position(|v| *v == k as u32)?;
                Some(corners[(at + 2) % corners.len()])
            });
            let across: Option<Vec<u32>> = across.collect();
            Some(Wheel { centre: k as u32, ends: fan.ends.clone().into(), across: across?.into() })
        };
        let wheels = fans.iter().enumerate().filter_map(wheel).collect();
        let mut quarters = Vec::with_capacity(4);
        let within = Adjacency::new(&finer.mesh);
        for k in 0..4 {
            let face = finer.origins.iter().position(|origin| *origin == (0, k))?;
            // Each begins at its own corner; its parameters are to run along those of the whole, and in
            // the middle of a triangle against them.
            let part = within.around_from(face, if k < sides { (sides - k) % sides } else { 0 })?;
            let plan = self.of(&part.mesh)?;
            quarters.push(Quarter { plan, points: part.points.into() });
        }
        let quarters = Box::new(<[Quarter; 4]>::try_from(quarters).ok()?);
        self.all[number as usize] = Plan::Split { stencils: finer.stencils.into(), quarters, wheels };
        Some(number)
    }
}

/// The points of the finer mesh.
pub(super) fn refine(stencils: &[Stencil], points: &[[Dd; 3]]) -> Vec<[Dd; 3]> {
    stencils.iter().map(|stencil| apply(stencil, points)).collect()
}

/// The Bezier net of a face that has one.
pub(super) fn net(plan: &Plan, points: &[[Dd; 3]]) -> Option<FaceNet> {
    match plan {
        Plan::Regular(net) => Some(FaceNet::Square(bezier(net, points))),
        Plan::Triangle(net) => triangles::bezier(net, points).map(FaceNet::Triangle),
        Plan::Split { .. } => None,
    }
}

/// The Bezier net of a regular quadrilateral.
///
/// A point beyond a boundary or a crease is the mirror image of that within: `2 a - b`. A B-spline's
/// pieces have the Bezier points `(a + 4 b + c) / 6`, `(2 b + c) / 3`, `(b + 2 c) / 3`,
/// `(b + 4 c + d) / 6`.
fn bezier(net: &[Option<u32>; 16], points: &[[Dd; 3]]) -> Net {
    let mut p = [[[Dd::ZERO; 3]; 4]; 4];
    let has = |i: usize, j: usize| net[j * 4 + i].is_some();
    for j in 0..4 {
        for i in 0..4 {
            if let Some(k) = net[j * 4 + i] {
                p[j][i] = points[k as usize];
            }
        }
    }
    let mirror = |a: [Dd; 3], b: [Dd; 3]| [0, 1, 2].map(|c| a[c] + a[c] - b[c]);
    for j in 0..4 {
        for (out, a, b) in [(0, 1, 2), (3, 2, 1)] {
            if has(a, j) && !has(out, j) {
                p[j][out] = mirror(p[j][a], p[j][b]);
            }
        }
    }
    for (out, a, b) in [(0, 1, 2), (3, 2, 1)] {
        if !has(1, out) {
            for i in 0..4 {
                p[out][i] = mirror(p[a][i], p[b][i]);
            }
        }
    }
    let third = Dd::ONE / Dd::from(3.0);
    let piece = |[a, b, c, d]: [Dd; 4]| {
        let (bc, cb) = ((b + b + c) * third, (b + c + c) * third);
        let (ab, cd) = ((a + b + b) * third, (c + c + d) * third);
        [(ab + bc).scale2(-1), bc, cb, (cb + cd).scale2(-1)]
    };
    let mut out = vec![[Dd::ZERO, Dd::ZERO, Dd::ZERO, Dd::ONE]; 16];
    for c in 0..3 {
        let rows = [0, 1, 2, 3].map(|j| piece([0, 1, 2, 3].map(|i| p[j][i][c])));
        for i in 0..4 {
            let column = piece([0, 1, 2, 3].map(|j| rows[j][i]));
            for j in 0..4 {
                out[j * 4 + i][c] = column[j];
            }
        }
    }
    Net { size: [4, 4], points: out as Vec<Homogeneous<Dd>> }
}

/// The limit of a smooth vertex and two tangents there, of which `first x second` is the normal.
///
/// M. Halstead, M. Kass, T. DeRose, "Efficient, fair interpolation using Catmull-Clark surfaces",
/// *SIGGRAPH* 1993, appendices A and B; J. Stam, "Exact evaluation of Catmull-Clark subdivision
/// surfaces at arbitrary parameter values", *SIGGRAPH* 1998.
pub(super) fn limit(wheel: &Wheel, points: &[[Dd; 3]]) -> [[Dd; 3]; 3] {
    let n = wheel.ends.len();
    if wheel.across.is_empty() {
        return triangles::limit(wheel, points);
    }
    let (ends, across) = (&wheel.ends, &wheel.across);
    let weights = |own: f64, end: f64, across_weight: f64| {
        let mut all = vec![(wheel.centre, Dd::from(own))];
        all.extend(ends.iter().map(|e| (*e, Dd::from(end))));
        all.extend(across.iter().map(|f| (*f, Dd::from(across_weight))));
        all
    };
    let count = n as f64;
    let by = Dd::ONE / Dd::from(count * (count + 5.0));
    let position = apply(&weights(count * count, 4.0, 1.0), points).map(|x| x * by);
    let cos = |k: f64| elementary::cos(2.0 * core::f64::consts::PI * k / count);
    let root = (2.0 * (9.0 + cos(1.0))).sqrt();
    let a = 1.0 + cos(1.0) + cos(0.5) * root;
    // Relative to the vertex, so that no digits are lost however small the wheel is.
    let relative: Vec<[Dd; 3]> =
        points.iter().map(|p| [0, 1, 2].map(|c| p[c] - points[wheel.centre as usize][c])).collect();
    let tangent = |shift: usize| {
        let mut all = Vec::new();
        for i in 0..n {
            let k = (i + n - shift) % n;
            let (here, next) = (cos(k as f64), cos((k + 1) as f64));
            all.push((ends[i], Dd::from(a * here)));
            all.push((across[i], Dd::from(here + next)));
        }
        apply(&all, &relative)
    };
    [position, tangent(0), tangent(1)]
}
