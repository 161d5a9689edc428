//! Texture coordinates by the rules of the surface.
//!
//! The faces make a second mesh, in the plane, with their texture coordinates in place of vertices.
//! Corners of two faces are one point of it if both name the same coordinates at both ends of the
//! edge between them; other edges are seams, which are boundaries of this mesh. Its limit is that of
//! the same rules, found over each face by the same parameters (T. DeRose, M. Kass, T. Truong,
//! "Subdivision surfaces in character animation", *SIGGRAPH* 1998, section 4: scalar fields).

use super::Scheme;
use super::data::{Boundary, SubdivisionData};
use super::limit::{Node, Place, Refined};
use super::plan::{Plan, Plans};
use super::topology::{Adjacency, Topology, apply, edge_of};
use durer_math::{Dd, U};
use std::sync::atomic::AtomicUsize;

/// A corner is not refined more often.
const MOST_STEPS: u32 = 100;

/// The limit of texture coordinates over the faces of a surface.
#[derive(Debug)]
pub(super) struct SmoothUv {
    plans: Box<[Plan]>,
    /// For each face of the limit surface; none for holes.
    faces: Box<[Option<Refined>]>,
    is_triangles: bool,
    /// A corner of this size is one point.
    point: f64,
    kept: AtomicUsize,
}

/// The mesh of texture coordinates, and those of its points.
fn uv_mesh(data: &SubdivisionData, mesh: &Topology) -> (Topology, Vec<[f64; 2]>) {
    let first: Vec<usize> = data
        .faces
        .iter()
        .scan(0, |count, face| Some(core::mem::replace(count, *count + face.len())))
        .collect();
    let adjacency = Adjacency::new(mesh);
    // Each corner of a face points to one that it is the same as, itself in the end.
    let mut same: Vec<usize> = (0..data.faces.iter().map(Vec::len).sum()).collect();
    let root = |same: &[usize], mut k: usize| {
        while same[k] != k {
            k = same[k];
        }
        k
    };
    // The corners on the other side of the edge from corner k, if it is not a seam.
    let beyond = |face: usize, k: usize| {
        let (corners, uv) = (&data.faces[face], &data.uv_faces[face]);
        let next = (k + 1) % corners.len();
        let &(other, at) = adjacency.left.get(&[corners[next], corners[k]])?;
        let after = (at + 1) % data.faces[other].len();
        let other_uv = &data.uv_faces[other];
        let is_same = uv[k] == other_uv[after] && uv[next] == other_uv[at];
        is_same.then_some([first[other] + after, first[other] + at])
    };
    for face in 0..data.faces.len() {
        for k in 0..data.faces[face].len() {
            let Some(others) = beyond(face, k) else { continue };
            let own = [k, (k + 1) % data.faces[face].len()].map(|k| first[face] + k);
            for (a, b) in own.into_iter().zip(others) {
                let (a, b) = (root(&same, a), root(&same, b));
                same[a.max(b)] = a.min(b);
            }
        }
    }
    let mut number = vec![u32::MAX; same.len()];
    let (mut values, mut count, mut vertex) = (vec![], vec![], vec![]);
    let mut uv = Topology { scheme: mesh.scheme, ..Topology::default() };
    for (face, corners) in data.faces.iter().enumerate() {
        let mut own = Vec::with_capacity(corners.len());
        for (k, &v) in corners.iter().enumerate() {
            let root = root(&same, first[face] + k);
            if number[root] == u32::MAX {
                number[root] = values.len() as u32;
                values.push(data.uv[data.uv_faces[face][k] as usize]);
                count.push(0_u32);
                vertex.push(v);
            }
            count[number[root] as usize] += 1;
            own.push(number[root]);
        }
        uv.faces.push(own);
    }
    uv.points = values.len();
    for (face, corners) in data.faces.iter().enumerate() {
        for (k, &a) in corners.iter().enumerate() {
            let next = (k + 1) % corners.len();
            if let Some(&sharpness) = mesh.creases.get(&edge_of(a, corners[next]))
                && beyond(face, k).is_some()
            {
                let [a, b] = [k, next].map(|k| uv.faces[face][k]);
                uv.creases.insert(edge_of(a, b), sharpness);
            }
        }
    }
    for (point, (&v, &count)) in vertex.iter().zip(&count).enumerate() {
        if data.boundary == Boundary::Corners && count == 1 {
            uv.corners.insert(point as u32, f64::INFINITY);
        } else if let Some(&sharpness) = mesh.corners.get(&v) {
            uv.corners.insert(point as u32, sharpness);
        }
    }
    (uv, values)
}

impl SmoothUv {
    /// The limit of a control mesh's texture coordinates, over the faces of `mesh` or, if these are no
    /// quadrilaterals, over those of its first step; `None` only for a mesh that is not valid.
    pub(super) fn new(data: &SubdivisionData, mesh: &Topology, is_hole: &[bool]) -> Option<Self> {
        let is_triangles = data.scheme == Scheme::Loop;
        let (mut uv, values) = uv_mesh(data, mesh);
        let mut points: Vec<[Dd; 3]> = values.iter().map(|&[u, v]| [u, v, 0.0].map(Dd::from)).collect();
        if !is_triangles && uv.faces.iter().any(|face| face.len() != 4) {
            let finer = Adjacency::new(&uv).refined(|_| true);
            points = finer.stencils.iter().map(|stencil| apply(stencil, &points)).collect();
            uv = finer.mesh;
        }
        let adjacency = Adjacency::new(&uv);
        let mut plans = Plans::default();
        let mut nodes = Vec::with_capacity(uv.faces.len());
        for (face, is_hole) in is_hole.iter().enumerate() {
            if *is_hole {
                nodes.push(None);
                continue;
            }
            let part = adjacency.around(face)?;
            let place = Place::of(face as u32, is_triangles);
            let points = part.points.iter().map(|p| points[*p as usize]).collect();
            nodes.push(Some(Node { plan: plans.of(&part.mesh)?, place, depth: 0, points }));
        }
        let plans: Box<[Plan]> = plans.all.into();
        let faces = nodes.into_iter().map(|node| node.map(|node| Refined::new(node, &plans))).collect();
        let largest = values.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        Some(Self { plans, faces, is_triangles, point: U * largest, kept: AtomicUsize::new(0) })
    }

    /// The texture coordinates at a root's tag, and their slopes along the parameters of the face;
    /// `None` for a face that is not there.
    pub(super) fn at(&self, face: u32, tag: [f64; 2]) -> Option<([f64; 2], [[f64; 2]; 2])> {
        Some(self.in_part(self.faces.get(face as usize)?.as_ref()?, tag))
    }

    fn in_part(&self, part: &Refined, tag: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        let tail = match part {
            Refined::Patch(patch) => {
                let leaf = &patch.leaf;
                let jet = leaf.face.jet(leaf.place.inner(tag)).moved(leaf.base.into(), leaf.place.width);
                return ([jet.p.x, jet.p.y], [[jet.pu.x, jet.pv.x], [jet.pu.y, jet.pv.y]]);
            }
            Refined::Tail(tail) => tail,
        };
        let node = &tail.node;
        let reach = tail.relative.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        if reach > self.point && node.depth < MOST_STEPS {
            let mut spare = None;
            if let Some(finer) = tail.finer(&self.plans, &self.kept, &mut spare) {
                return self.in_part(&finer[node.place.quarter_at(tag)], tag);
            }
        }
        // All of it is one point.
        let p = &node.points;
        let by = 1.0 / node.place.width;
        let slope = |to: usize, c: usize| (p[to][c] - p[0][c]).to_f64() * by;
        let last = if self.is_triangles { 2 } else { 3 };
        let at = p[node.vertex(&self.plans).unwrap_or(0)];
        ([0, 1].map(|c| at[c].to_f64()), [0, 1].map(|c| [slope(1, c), slope(last, c)]))
    }
}
