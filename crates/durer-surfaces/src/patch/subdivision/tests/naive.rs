//! The rules once more, as textbooks write them: whole meshes in f64, without stencils or plans.

use super::super::{Boundary, Scheme, SubdivisionData, SubdivisionSurface};
use crate::laws::all_roots;
use durer_math::{Ray, Vec3};
use std::collections::BTreeMap;

pub(super) struct Naive {
    scheme: Scheme,
    pub(super) vertices: Vec<Vec3>,
    pub(super) faces: Vec<Vec<u32>>,
    creases: BTreeMap<(u32, u32), f64>,
    corners: BTreeMap<u32, f64>,
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

fn infinite(s: f64) -> f64 {
    if s >= 10.0 { f64::INFINITY } else { s }
}

fn mix(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    a * (1.0 - t) + b * t
}

fn loop_weight(n: f64) -> f64 {
    let root = 0.375 + durer_math::elementary::cos(2.0 * core::f64::consts::PI / n) / 4.0;
    (0.625 - root * root) / n
}

impl Naive {
    pub(super) fn new(data: &SubdivisionData) -> Self {
        let mut it = Self {
            scheme: data.scheme,
            vertices: data.vertices.iter().map(|p| p.to_vec()).collect(),
            faces: data.faces.clone(),
            creases: data.creases.iter().map(|&([a, b], s)| (key(a, b), infinite(s))).collect(),
            corners: data.corners.iter().map(|&(v, s)| (v, infinite(s))).collect(),
        };
        for (edge, faces) in it.edges() {
            if faces.len() == 1 {
                it.creases.insert(edge, f64::INFINITY);
            }
        }
        for v in 0..it.vertices.len() as u32 {
            if data.boundary == Boundary::Corners && it.faces.iter().filter(|f| f.contains(&v)).count() == 1 {
                it.corners.insert(v, f64::INFINITY);
            }
        }
        it
    }

    fn edges(&self) -> BTreeMap<(u32, u32), Vec<usize>> {
        let mut edges: BTreeMap<_, Vec<usize>> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            for k in 0..face.len() {
                edges.entry(key(face[k], face[(k + 1) % face.len()])).or_default().push(f);
            }
        }
        edges
    }

    pub(super) fn refined(&self) -> Self {
        let count = self.vertices.len();
        let middle = |f: &Vec<u32>| {
            f.iter().fold(Vec3::ZERO, |s, v| s + self.vertices[*v as usize]) * (1.0 / f.len() as f64)
        };
        let middles: Vec<Vec3> = self.faces.iter().map(middle).collect();
        let edges = self.edges();
        let sharp = |e: &(u32, u32)| self.creases.get(e).copied().unwrap_or(0.0);
        let mut vertices = Vec::new();
        let mut of_vertex = vec![vec![]; count];
        for edge in edges.keys() {
            of_vertex[edge.0 as usize].push(*edge);
            of_vertex[edge.1 as usize].push(*edge);
        }
        let mut faces_of = vec![vec![]; count];
        for (f, face) in self.faces.iter().enumerate() {
            face.iter().for_each(|v| faces_of[*v as usize].push(f));
        }
        let mut creases = BTreeMap::new();
        let mut corners = BTreeMap::new();
        for v in 0..count {
            let p = self.vertices[v];
            let ends: Vec<Vec3> = of_vertex[v]
                .iter()
                .map(|e| self.vertices[if e.0 as usize == v { e.1 } else { e.0 } as usize])
                .collect();
            let now: Vec<f64> = of_vertex[v].iter().map(sharp).collect();
            let then: Vec<f64> = now.iter().map(|s| (s - 1.0).max(0.0)).collect();
            let corner = self.corners.get(&(v as u32)).copied().unwrap_or(0.0);
            let corner_then = (corner - 1.0).max(0.0);
            if corner_then > 0.0 {
                corners.insert(v as u32, corner_then);
            }
            let rule = |s: &[f64], corner: f64| -> (u32, Vec3) {
                let at: Vec<usize> = (0..s.len()).filter(|k| s[*k] > 0.0).collect();
                if corner > 0.0 || at.len() > 2 {
                    (2, p)
                } else if at.len() == 2 {
                    (1, p * 0.75 + (ends[at[0]] + ends[at[1]]) * 0.125)
                } else if faces_of[v].is_empty() {
                    (0, p)
                } else if self.scheme == Scheme::Loop {
                    let n = faces_of[v].len() as f64;
                    let w = loop_weight(n);
                    (0, p * (1.0 - n * w) + ends.iter().fold(Vec3::ZERO, |s, e| s + *e) * w)
                } else {
                    // The classic form: (F + 2 R + (n - 3) P) / n.
                    let n = faces_of[v].len() as f64;
                    let f = faces_of[v].iter().fold(Vec3::ZERO, |s, f| s + middles[*f]) * (1.0 / n);
                    let r = ends.iter().fold(Vec3::ZERO, |s, e| s + (*e + p) * 0.5) * (1.0 / n);
                    (0, (f + r * 2.0 + p * (n - 3.0)) * (1.0 / n))
                }
            };
            let (a, b) = (rule(&now, corner), rule(&then, corner_then));
            vertices.push(if a.0 == b.0 {
                a.1
            } else {
                let ending: Vec<f64> = now
                    .iter()
                    .zip(&then)
                    .chain([(&corner, &corner_then)])
                    .filter(|(a, b)| **a > 0.0 && **b == 0.0)
                    .map(|(a, _)| *a)
                    .collect();
                mix(b.1, a.1, (ending.iter().sum::<f64>() / ending.len() as f64).min(1.0))
            });
        }
        let mut number = BTreeMap::new();
        for (edge, faces) in &edges {
            let (a, b) = (self.vertices[edge.0 as usize], self.vertices[edge.1 as usize]);
            let s = sharp(edge);
            let half = (a + b) * 0.5;
            let smooth = if faces.len() == 2 && self.scheme == Scheme::Loop {
                // Three times the middle of a triangle is the sum of its corners.
                let both = (middles[faces[0]] + middles[faces[1]]) * 3.0;
                (a + b) * 0.375 + (both - (a + b) * 2.0) * 0.125
            } else if faces.len() == 2 {
                (a + b + middles[faces[0]] + middles[faces[1]]) * 0.25
            } else {
                half
            };
            let n = vertices.len() as u32;
            vertices.push(mix(smooth, half, s.min(1.0)));
            number.insert(*edge, n);
            if s > 1.0 {
                creases.insert(key(edge.0, n), s - 1.0);
                creases.insert(key(edge.1, n), s - 1.0);
            }
        }
        let mut faces = Vec::new();
        for (f, face) in self.faces.iter().enumerate() {
            if self.scheme == Scheme::Loop {
                let [a, b, c] = [face[0], face[1], face[2]];
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| number[&key(a, b)]);
                faces.extend([vec![a, ab, ca], vec![ab, b, bc], vec![ca, bc, c], vec![ab, bc, ca]]);
                continue;
            }
            let m = vertices.len() as u32;
            vertices.push(middles[f]);
            for k in 0..face.len() {
                let n = face.len();
                let (v, next, before) = (face[k], face[(k + 1) % n], face[(k + n - 1) % n]);
                faces.push(vec![v, number[&key(v, next)], m, number[&key(v, before)]]);
            }
        }
        Self { scheme: self.scheme, vertices, faces, creases, corners }
    }

    /// The limit of a vertex on a crease that is sharp for ever, or that is a corner for ever.
    pub(super) fn sharp_limit(&self, v: u32) -> Option<Vec3> {
        let corner = self.corners.get(&v).copied().unwrap_or(0.0);
        let sharp: Vec<_> = self.creases.iter().filter(|(e, _)| e.0 == v || e.1 == v).collect();
        let p = self.vertices[v as usize];
        if corner.is_infinite() || corner == 0.0 && sharp.len() > 2 && sharp.iter().all(|s| s.1.is_infinite())
        {
            return Some(p);
        }
        if corner > 0.0 || sharp.len() != 2 || sharp.iter().any(|s| s.1.is_finite()) {
            return None;
        }
        let ends = sharp.iter().map(|(e, _)| self.vertices[if e.0 == v { e.1 } else { e.0 } as usize]);
        Some(ends.fold(p * (4.0 / 6.0), |s, e| s + e * (1.0 / 6.0)))
    }

    /// The limit position and normal of a vertex with quadrilaterals or triangles round it, if it is
    /// smooth and not on a boundary.
    pub(super) fn limit(&self, v: u32) -> Option<(Vec3, Vec3)> {
        let mine: Vec<_> = self.faces.iter().filter(|f| f.contains(&v)).collect();
        if self.corners.contains_key(&v) || self.creases.keys().any(|e| e.0 == v || e.1 == v) {
            return None;
        }
        // Round the vertex: each face's last corner is the first of the next.
        let parts: Vec<[u32; 3]> = mine
            .iter()
            .map(|f| {
                let k = f.iter().position(|c| *c == v).unwrap();
                // A triangle has a next corner and one before, but none across.
                let steps = if f.len() == 3 { [1, 1, 2] } else { [1, 2, 3] };
                steps.map(|i| f[(k + i) % f.len()])
            })
            .collect();
        let mut round = vec![*parts.first()?];
        while round.len() < parts.len() {
            let last = round[round.len() - 1][2];
            round.push(*parts.iter().find(|p| p[0] == last)?);
        }
        let n = round.len() as f64;
        let p = self.vertices[v as usize];
        let at = |k: u32| self.vertices[k as usize];
        let sum = |i: usize| round.iter().fold(Vec3::ZERO, |s, r| s + at(r[i]));
        if self.scheme == Scheme::Loop {
            let w = 3.0 / (8.0 * loop_weight(n));
            let limit = (p * w + sum(0)) * (1.0 / (w + n));
            let wave = |shift: f64| {
                round.iter().enumerate().fold(Vec3::ZERO, |s, (i, r)| {
                    let angle = 2.0 * core::f64::consts::PI * (i as f64 - shift) / n;
                    s + (at(r[0]) - p) * durer_math::elementary::cos(angle)
                })
            };
            let normal = wave(0.0).cross(wave(1.0));
            return Some((limit, normal * (1.0 / normal.length())));
        }
        let limit = (p * (n * n) + sum(0) * 4.0 + sum(1)) * (1.0 / (n * (n + 5.0)));
        let cos = |k: f64| durer_math::elementary::cos(2.0 * core::f64::consts::PI * k / n);
        let a = 1.0 + cos(1.0) + cos(0.5) * (2.0 * (9.0 + cos(1.0))).sqrt();
        let tangent = |shift: f64| {
            round.iter().enumerate().fold(Vec3::ZERO, |s, (i, r)| {
                let k = i as f64 - shift;
                s + (at(r[0]) - p) * (a * cos(k)) + (at(r[1]) - p) * (cos(k) + cos(k + 1.0))
            })
        };
        let normal = tangent(0.0).cross(tangent(1.0));
        Some((limit, normal * (1.0 / normal.length())))
    }

    /// How far middles of faces are from a surface at most, along their normals.
    pub(super) fn distance(&self, surface: &SubdivisionSurface) -> f64 {
        let mut most = 0.0_f64;
        let step = self.faces.len().div_ceil(700);
        for face in self.faces.iter().step_by(step) {
            let p: Vec<Vec3> = face.iter().map(|v| self.vertices[*v as usize]).collect();
            let middle = p.iter().fold(Vec3::ZERO, |s, p| s + *p) * (1.0 / p.len() as f64);
            let n = (p[2] - p[0]).cross(p[p.len() - 1] - p[1]);
            if n.length() < 1e-12 {
                continue;
            }
            let n = n * (1.0 / n.length());
            let line = Ray::new(middle.to_point(), n).with_range(-10.0, 10.0);
            let near = all_roots(surface, &line).iter().fold(f64::INFINITY, |m, r| m.min(r.t.abs()));
            // Beyond the edge of a sheet there is nothing.
            if near < 0.5 || surface.is_closed() {
                most = most.max(near);
            }
        }
        most
    }
}
