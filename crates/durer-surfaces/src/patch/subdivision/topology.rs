//! One step of refinement: the points of a finer mesh as weighted sums of those of a coarser one.
//!
//! ```text
//!   face point     the mean of the face's vertices
//!   edge point     the mean of its two ends and the face points on both sides; sharp: of its ends
//!   vertex point   n - 2     1             1              n edges, other ends e, face points f
//!                  ----- v + --- sum(e) + --- sum(f)
//!                    n       n^2          n^2
//!                  on a crease: 3/4 v + 1/8 (e + e');  at a corner: v
//! ```
//!
//! These are the rules of polygons; those of triangles are in `triangles.rs`.
//!
//! E. Catmull, J. Clark, *Computer-Aided Design* 10 (1978) 350-355; creases and boundaries: T.
//! DeRose, M. Kass, T. Truong, "Subdivision surfaces in character animation", *SIGGRAPH* 1998. A
//! sharpness falls by 1 with each step; between 0 and 1 the sharp and the smooth rule are mixed.
//! Where a vertex's rule changes with the step, the rules before and after are mixed by the mean of
//! the sharpnesses that end. All weights are at least 0 and have the sum 1, so refined meshes stay
//! in the convex hull of the mesh's points.
//!
//! The limit over a face depends on the points of the faces that touch it, and on the sharpness of
//! edges at its own vertices: [`Adjacency::around`] extracts that part.

use super::Scheme;
use super::triangles::{NEAR, OPPOSITE, neighbour_weight};
use durer_math::Dd;
use std::collections::{BTreeMap, HashMap};

/// A point of the finer mesh: points of the coarser one and their weights.
pub(super) type Stencil = Vec<(u32, Dd)>;

/// Faces with sharp edges and vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Topology {
    pub(super) scheme: Scheme,
    /// The number of points.
    pub(super) points: usize,
    pub(super) faces: Vec<Vec<u32>>,
    /// The sharp edges except boundaries, by vertices with the lesser number first.
    pub(super) creases: BTreeMap<[u32; 2], f64>,
    /// The sharp vertices.
    pub(super) corners: BTreeMap<u32, f64>,
}

/// The two ends, ascending.
pub(super) fn edge_of(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The rule of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    Smooth,
    Crease,
    Corner,
}

/// The neighbourhood of a vertex, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Fan {
    /// The other ends of its edges.
    pub(super) ends: Vec<u32>,
    /// The faces: the one at `k` is between the ends `k` and `k + 1`.
    pub(super) faces: Vec<usize>,
    /// The sharpness of the edges; infinite at a boundary.
    pub(super) sharpness: Vec<f64>,
    /// The sharpness of the vertex.
    pub(super) corner: f64,
}

impl Fan {
    /// The rule for these sharpnesses.
    fn rule_of(sharpness: &[f64], corner: f64) -> Rule {
        match sharpness.iter().filter(|s| **s > 0.0).count() {
            _ if corner > 0.0 => Rule::Corner,
            0 | 1 => Rule::Smooth,
            2 => Rule::Crease,
            _ => Rule::Corner,
        }
    }

    pub(super) fn rule(&self) -> Rule {
        Self::rule_of(&self.sharpness, self.corner)
    }

    /// Whether the rule does not change: nothing is sharp only for some steps.
    pub(super) fn is_final(&self) -> bool {
        self.sharpness.iter().chain([&self.corner]).all(|s| *s == 0.0 || s.is_infinite())
    }

    /// Whether the vertex is on a boundary.
    pub(super) fn is_open(&self) -> bool {
        self.ends.len() > self.faces.len()
    }
}

/// A sharpness after a step.
fn less_sharp(sharpness: f64) -> f64 {
    (sharpness - 1.0).max(0.0)
}

/// The adjacency of faces.
pub(super) struct Adjacency<'a> {
    mesh: &'a Topology,
    /// The face on the left of a directed edge, and the edge's place in it.
    pub(super) left: HashMap<[u32; 2], (usize, usize)>,
}

/// The part of a mesh around one face, with the original number of each of its points.
pub(super) struct Part {
    pub(super) mesh: Topology,
    pub(super) points: Vec<u32>,
}

impl<'a> Adjacency<'a> {
    pub(super) fn new(mesh: &'a Topology) -> Self {
        let mut left = HashMap::new();
        for (face, corners) in mesh.faces.iter().enumerate() {
            for (k, &a) in corners.iter().enumerate() {
                left.insert([a, corners[(k + 1) % corners.len()]], (face, k));
            }
        }
        Self { mesh, left }
    }

    /// The sharpness of an edge; infinite at a boundary.
    fn sharpness(&self, a: u32, b: u32) -> f64 {
        if !(self.left.contains_key(&[a, b]) && self.left.contains_key(&[b, a])) {
            return f64::INFINITY;
        }
        self.mesh.creases.get(&edge_of(a, b)).copied().unwrap_or(0.0)
    }

    /// The vertex that follows `v` in a face, and the one before it.
    fn beside(&self, face: usize, v: u32) -> Option<[u32; 2]> {
        let corners = &self.mesh.faces[face];
        let (at, n) = (corners.iter().position(|c| *c == v)?, corners.len());
        Some([corners[(at + 1) % n], corners[(at + n - 1) % n]])
    }

    /// The face on the left of a directed edge, and its two vertices after the edge's end.
    pub(super) fn across(&self, a: u32, b: u32) -> Option<(usize, [u32; 2])> {
        let &(face, at) = self.left.get(&[a, b])?;
        let corners = &self.mesh.faces[face];
        let n = corners.len();
        Some((face, [corners[(at + 2) % n], corners[(at + 3) % n]]))
    }

    /// The fan of a vertex of a face, which begins with that face, or at the boundary.
    pub(super) fn fan(&self, v: u32, face: usize) -> Option<Fan> {
        // Clockwise as far as there are faces.
        let mut first = face;
        loop {
            let [next, _] = self.beside(first, v)?;
            match self.left.get(&[next, v]) {
                Some(&(other, _)) if other != face => first = other,
                Some(_) => {
                    first = face;
                    break;
                }
                None => break,
            }
        }
        let mut fan =
            Fan { ends: vec![self.beside(first, v)?[0]], faces: vec![], sharpness: vec![], corner: 0.0 };
        let mut now = first;
        loop {
            fan.faces.push(now);
            let [_, before] = self.beside(now, v)?;
            match self.left.get(&[v, before]) {
                Some(&(other, _)) if other == first => break,
                Some(&(other, _)) => now = other,
                None => {
                    fan.ends.push(before);
                    break;
                }
            }
            fan.ends.push(before);
        }
        fan.sharpness = fan.ends.iter().map(|e| self.sharpness(v, *e)).collect();
        fan.corner = self.mesh.corners.get(&v).copied().unwrap_or(0.0);
        Some(fan)
    }

    /// The part of the mesh on which the limit over a face depends. That face is the first of the
    /// part, and its vertices are the first ones.
    pub(super) fn around(&self, face: usize) -> Option<Part> {
        self.around_from(face, 0)
    }

    /// [`Adjacency::around`], with the face's vertices starting from the one at `first`.
    pub(super) fn around_from(&self, face: usize, first: usize) -> Option<Part> {
        let mut points: Vec<u32> = self.mesh.faces[face].clone();
        points.rotate_left(first);
        let own = points.clone();
        let mut faces = vec![face];
        let mut mesh = Topology {
            scheme: self.mesh.scheme,
            faces: vec![(0..points.len() as u32).collect()],
            ..Topology::default()
        };
        let number = |points: &mut Vec<u32>, v: u32| {
            points.iter().position(|p| *p == v).unwrap_or_else(|| {
                points.push(v);
                points.len() - 1
            }) as u32
        };
        for (k, &v) in own.iter().enumerate() {
            let fan = self.fan(v, face)?;
            // From this face on.
            let begin = fan.faces.iter().position(|f| *f == face)?;
            for step in 0..fan.faces.len() {
                let other = fan.faces[(begin + step) % fan.faces.len()];
                if faces.contains(&other) {
                    continue;
                }
                faces.push(other);
                let corners = &self.mesh.faces[other];
                let at = corners.iter().position(|c| *c == v)?;
                let round = (0..corners.len()).map(|i| corners[(at + i) % corners.len()]);
                mesh.faces.push(round.map(|v| number(&mut points, v)).collect());
            }
            for (&end, &sharpness) in fan.ends.iter().zip(&fan.sharpness) {
                let is_inner = self.left.contains_key(&[v, end]) && self.left.contains_key(&[end, v]);
                if sharpness > 0.0 && is_inner {
                    mesh.creases.insert(edge_of(k as u32, number(&mut points, end)), sharpness);
                }
            }
            if fan.corner > 0.0 {
                mesh.corners.insert(k as u32, fan.corner);
            }
        }
        mesh.points = points.len();
        Some(Part { mesh, points })
    }
}

/// `weight` times a stencil, added to a sum.
fn add(sum: &mut BTreeMap<u32, Dd>, stencil: &[(u32, Dd)], weight: Dd) {
    for &(point, w) in stencil {
        let entry = sum.entry(point).or_insert(Dd::ZERO);
        *entry = *entry + w * weight;
    }
}

fn whole(n: usize) -> Dd {
    Dd::from(n as f64)
}

fn finish(sum: BTreeMap<u32, Dd>) -> Stencil {
    sum.into_iter().filter(|(_, w)| *w != Dd::ZERO).collect()
}

/// A finer mesh and the sources of its points. Each face is replaced by one for each of its
/// corners, in order, which begins there; for a triangle the one in the middle follows.
pub(super) struct Finer {
    pub(super) mesh: Topology,
    pub(super) stencils: Vec<Stencil>,
    /// For each finer face, its original face and corner; 3 for the middle of a triangle.
    pub(super) origins: Vec<(usize, usize)>,
}

impl Adjacency<'_> {
    fn face_stencil(&self, face: usize) -> Stencil {
        let corners = &self.mesh.faces[face];
        let weight = Dd::ONE / whole(corners.len());
        corners.iter().map(|v| (*v, weight)).collect()
    }

    fn edge_stencil(&self, a: u32, b: u32) -> Stencil {
        let mut sum = BTreeMap::new();
        let sharp = self.sharpness(a, b).min(1.0);
        let (sharp, smooth) = (Dd::from(sharp), Dd::difference(1.0, sharp));
        let ends = [(a, Dd::ONE), (b, Dd::ONE)];
        add(&mut sum, &ends, sharp.scale2(-1));
        if smooth != Dd::ZERO && self.mesh.scheme == Scheme::Loop {
            add(&mut sum, &ends, smooth * NEAR);
            for [a, b] in [[a, b], [b, a]] {
                if let Some((_, [opposite, _])) = self.across(a, b) {
                    add(&mut sum, &[(opposite, Dd::ONE)], smooth * OPPOSITE);
                }
            }
        } else if smooth != Dd::ZERO {
            add(&mut sum, &ends, smooth.scale2(-2));
            for edge in [[a, b], [b, a]] {
                if let Some((face, _)) = self.left.get(&edge) {
                    add(&mut sum, &self.face_stencil(*face), smooth.scale2(-2));
                }
            }
        }
        finish(sum)
    }

    fn add_rule(
        &self,
        sum: &mut BTreeMap<u32, Dd>,
        v: u32,
        fan: &Fan,
        (rule, sharpness): (Rule, &[f64]),
        by: Dd,
    ) {
        let own = [(v, Dd::ONE)];
        match rule {
            Rule::Corner => add(sum, &own, by),
            Rule::Crease => {
                add(sum, &own, by * Dd::from(0.75));
                for (end, sharpness) in fan.ends.iter().zip(sharpness) {
                    if *sharpness > 0.0 {
                        add(sum, &[(*end, Dd::ONE)], by.scale2(-3));
                    }
                }
            }
            Rule::Smooth if self.mesh.scheme == Scheme::Loop => {
                let weight = neighbour_weight(fan.ends.len());
                add(sum, &own, by * (Dd::ONE - weight * whole(fan.ends.len())));
                for end in &fan.ends {
                    add(sum, &[(*end, Dd::ONE)], by * weight);
                }
            }
            Rule::Smooth => {
                let n = fan.faces.len();
                let (one, square) = (by / whole(n), by / whole(n * n));
                add(sum, &own, one * Dd::from(n as f64 - 2.0));
                for end in &fan.ends {
                    add(sum, &[(*end, Dd::ONE)], square);
                }
                for face in &fan.faces {
                    add(sum, &self.face_stencil(*face), square);
                }
            }
        }
    }

    fn vertex_stencil(&self, v: u32, fan: &Fan) -> Stencil {
        let after: Vec<f64> = fan.sharpness.iter().map(|s| less_sharp(*s)).collect();
        let corner = less_sharp(fan.corner);
        let rules = [fan.rule(), Fan::rule_of(&after, corner)];
        let mut sum = BTreeMap::new();
        if rules[0] == rules[1] {
            self.add_rule(&mut sum, v, fan, (rules[0], &fan.sharpness), Dd::ONE);
            return finish(sum);
        }
        // The sharpnesses that end with this step.
        let all = fan.sharpness.iter().chain([&fan.corner]);
        let ending: Vec<f64> = all.copied().filter(|s| *s > 0.0 && less_sharp(*s) == 0.0).collect();
        let part = Dd::from(ending.iter().sum::<f64>()) / whole(ending.len().max(1));
        let part = if part.hi > 1.0 { Dd::ONE } else { part };
        self.add_rule(&mut sum, v, fan, (rules[0], &fan.sharpness), part);
        self.add_rule(&mut sum, v, fan, (rules[1], &after), Dd::ONE - part);
        finish(sum)
    }

    /// The finer mesh: the corners of faces that `wanted` accepts, except those whose fan is
    /// unknown, and the middles of triangles with two such corners.
    pub(super) fn refined(&self, wanted: impl Fn(u32) -> bool) -> Finer {
        let is_loop = self.mesh.scheme == Scheme::Loop;
        let mut step = Step {
            coarse: self,
            mesh: Topology { scheme: self.mesh.scheme, ..Topology::default() },
            stencils: vec![],
            vertices: HashMap::new(),
            edges: HashMap::new(),
        };
        let mut origins = vec![];
        for (face, corners) in self.mesh.faces.iter().enumerate() {
            if !corners.iter().any(|v| wanted(*v)) {
                continue;
            }
            let middle = if is_loop { None } else { Some(step.point(self.face_stencil(face))) };
            let n = corners.len();
            let mut within = Vec::with_capacity(n);
            for (k, &v) in corners.iter().enumerate() {
                if !wanted(v) {
                    continue;
                }
                let Some(fan) = self.fan(v, face) else { continue };
                let own = step.vertex(v, &fan);
                let next = step.edge(v, own, corners[(k + 1) % n]);
                let before = step.edge(v, own, corners[(k + n - 1) % n]);
                step.mesh.faces.push([own, next].into_iter().chain(middle).chain([before]).collect());
                origins.push((face, k));
                within.push(k);
            }
            if is_loop && within.len() >= 2 {
                let edge = |k: usize| step.edges.get(&edge_of(corners[k], corners[(k + 1) % n])).copied();
                if let (Some(a), Some(b), Some(c)) = (edge(1), edge(2), edge(0)) {
                    step.mesh.faces.push(vec![a, b, c]);
                    origins.push((face, 3));
                }
            }
        }
        let Step { mut mesh, stencils, .. } = step;
        mesh.points = stencils.len();
        Finer { mesh, stencils, origins }
    }
}

/// A finer mesh under construction.
struct Step<'a> {
    coarse: &'a Adjacency<'a>,
    mesh: Topology,
    stencils: Vec<Stencil>,
    /// The points of vertices and edges.
    vertices: HashMap<u32, u32>,
    edges: HashMap<[u32; 2], u32>,
}

impl Step<'_> {
    fn point(&mut self, stencil: Stencil) -> u32 {
        self.stencils.push(stencil);
        self.stencils.len() as u32 - 1
    }

    fn vertex(&mut self, v: u32, fan: &Fan) -> u32 {
        let own = match self.vertices.get(&v) {
            Some(&own) => own,
            None => self.point(self.coarse.vertex_stencil(v, fan)),
        };
        self.vertices.insert(v, own);
        let corner = less_sharp(fan.corner);
        if corner > 0.0 {
            self.mesh.corners.insert(own, corner);
        }
        own
    }

    /// The point of the edge from a vertex, whose point is `own`, to another one.
    fn edge(&mut self, v: u32, own: u32, other: u32) -> u32 {
        let coarse = self.coarse;
        let point = match self.edges.get(&edge_of(v, other)) {
            Some(&point) => point,
            None => self.point(coarse.edge_stencil(v, other)),
        };
        self.edges.insert(edge_of(v, other), point);
        let is_inner = coarse.left.contains_key(&[v, other]) && coarse.left.contains_key(&[other, v]);
        let sharpness = less_sharp(coarse.sharpness(v, other));
        if is_inner && sharpness > 0.0 {
            self.mesh.creases.insert(edge_of(own, point), sharpness);
        }
        point
    }
}

/// A weighted sum of points, by halves, so that its error grows with the logarithm of their number.
pub(super) fn apply(stencil: &[(u32, Dd)], points: &[[Dd; 3]]) -> [Dd; 3] {
    if stencil.len() > 8 {
        let (a, b) = stencil.split_at(stencil.len() / 2);
        let (a, b) = (apply(a, points), apply(b, points));
        return [0, 1, 2].map(|c| a[c] + b[c]);
    }
    let mut sum = [Dd::ZERO; 3];
    for &(point, weight) in stencil {
        let p = &points[point as usize];
        for c in 0..3 {
            sum[c] = sum[c] + p[c] * weight;
        }
    }
    sum
}
