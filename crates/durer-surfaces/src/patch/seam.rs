//! Edges of faces, and pairs of equal edges.
//!
//! Two sides of faces are one edge if their control points are the same; and, if faces may be
//! [sealed](super::sewn::SewnData::seal), if points along one are near the other. The faces of a
//! solid are oriented so that the two at each edge run along it in opposite directions.

use super::net::{FaceNet, Homogeneous};
use super::nurbs::Parts;
use super::sewn::SewnError;
use super::shell::Shell;
use super::trim::curve::Piece;
use durer_math::{Dd, Point3, Vec3};

/// The number of sample points along an edge.
const PARTS: usize = 16;
/// Control points that differ by less than this, in units, are the same. The error bounds of all
/// cells cover such a difference.
const SAME: f64 = durer_math::scale::pow2(-92);

/// A piece of the edge of a surface. The kept part of the surface is to its left.
pub(super) struct Edge {
    /// The surface, and the edge's name within it.
    surface: usize,
    name: String,
    /// Its number in its loop, and the number of edges in the loop.
    number: [usize; 2],
    curve: Piece,
    /// The control points, if it is a whole side of a patch.
    points: Option<Vec<Homogeneous<Dd>>>,
    /// Points along it, in units.
    samples: Vec<Vec3>,
}

/// The relation of two edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Match {
    Along,
    Against,
}

/// The surfaces whose edges are matched.
pub(super) struct Surfaces<'a> {
    pub(super) parts: &'a [Parts],
    /// The number of the first patch of each surface.
    pub(super) first: &'a [usize],
    pub(super) periodic: &'a [[bool; 2]],
    pub(super) shell: &'a Shell,
}

impl Surfaces<'_> {
    /// The point of a surface at parameters in the units of its knots.
    fn point(&self, surface: usize, uv: [f64; 2]) -> Vec3 {
        let parts = &self.parts[surface];
        let at = [0, 1].map(|k: usize| {
            let ends = &parts.ends[k];
            ends.partition_point(|t| *t <= uv[k]).clamp(1, ends.len() - 1) - 1
        });
        let face = at[1] * parts.grid()[0] + at[0];
        let [from, width] = parts.span(face);
        let local = [0, 1].map(|k: usize| (uv[k] - from[k]) / width[k]);
        self.shell.faces[self.first[surface] + face].jet(local).p
    }

    fn edge(&self, surface: usize, name: String, number: [usize; 2], curve: Piece) -> Edge {
        let at = |k: usize| self.point(surface, curve.at(k as f64 / PARTS as f64));
        Edge { surface, name, number, samples: (0..=PARTS).map(at).collect(), curve, points: None }
    }

    /// The edges of all surfaces.
    pub(super) fn edges(&self) -> Vec<Edge> {
        let mut edges = Vec::new();
        for (surface, parts) in self.parts.iter().enumerate() {
            let trims = parts.trims.as_ref();
            for (n, pieces) in trims.iter().flat_map(|trims| trims.loops()).enumerate() {
                for (k, piece) in pieces.iter().enumerate() {
                    let name = format!("trim {}", n + 1);
                    edges.push(self.edge(surface, name, [k, pieces.len()], piece.clone()));
                }
            }
            if trims.is_none_or(|trims| trims.is_open()) {
                self.sides(surface, &mut edges);
            }
        }
        // Pieces of length zero are no edges.
        edges.retain(|e| {
            let same = |p: &Homogeneous<Dd>, q: &Homogeneous<Dd>| (0..3).all(|c| p[c] * q[3] == q[c] * p[3]);
            match &e.points {
                Some(points) => !points.iter().all(|p| same(p, &points[0])),
                None => e.samples.iter().any(|p| *p != e.samples[0]),
            }
        });
        edges
    }

    /// The four sides of a surface, patch by patch.
    fn sides(&self, surface: usize, edges: &mut Vec<Edge>) {
        let parts = &self.parts[surface];
        let [nu, nv] = parts.grid();
        let [low, high] = parts.domain();
        for (along, at_end) in [(0, false), (1, true), (0, true), (1, false)] {
            let across = 1 - along;
            if self.periodic[surface][across] {
                continue;
            }
            let count = [nu, nv][along];
            let fixed = if at_end { high[across] } else { low[across] };
            let name = format!("side {} = {fixed}", ['u', 'v'][across]);
            for k in 0..count {
                let place = [(0, k), (1, k)].map(|(c, k)| {
                    if c == across { [0, [nu, nv][across] - 1][usize::from(at_end)] } else { k }
                });
                let at = |axis: usize| if axis == along { k } else { place[across] };
                let FaceNet::Square(net) = &parts.nets[at(1) * nu + at(0)] else { continue };
                let [pu, pv] = net.size;
                let line = if at_end { [pu, pv][across] - 1 } else { 0 };
                let mut points: Vec<_> = (0..[pu, pv][along])
                    .map(|i| if along == 0 { net.points[line * pu + i] } else { net.points[i * pu + line] })
                    .collect();
                let mut ends = [parts.ends[along][k], parts.ends[along][k + 1]].map(|t| {
                    let mut p = [fixed; 2];
                    p[along] = t;
                    p
                });
                // Counter-clockwise: along u below, along v on the right, and back.
                if (along == 0) == at_end {
                    points.reverse();
                    ends.reverse();
                }
                let [from, to] = ends;
                let mut edge = self.edge(surface, name.clone(), [k, usize::MAX], Piece::line(from, to));
                edge.points = Some(points);
                edges.push(edge);
            }
        }
    }

    /// Whether control points are the same, and in which order.
    fn same_points(&self, a: &Edge, b: &Edge) -> Option<Match> {
        let (p, q) = (a.points.as_ref()?, b.points.as_ref()?);
        if p.len() != q.len() {
            return None;
        }
        let room = durer_math::scale::ldexp(SAME, self.shell.scale);
        let near = |p: &Homogeneous<Dd>, q: &Homogeneous<Dd>| {
            (0..4).all(|c| (p[c] - q[c]).to_f64().abs() <= if c == 3 { SAME } else { room * p[3].to_f64() })
        };
        if p.iter().zip(q.iter().rev()).all(|(p, q)| near(p, q)) {
            return Some(Match::Against);
        }
        p.iter().zip(q).all(|(p, q)| near(p, q)).then_some(Match::Along)
    }

    /// The edge that is near all of edge `i`, and its direction relative to it.
    fn near(&self, edges: &[Edge], i: usize, seal: f64) -> Option<(usize, Match)> {
        let edge = &edges[i];
        let mut middle = None;
        for (k, p) in edge.samples.iter().enumerate() {
            let length = |q: Vec3| (q - *p).length_squared();
            let is_next = |other: &Edge| {
                let [a, n] = edge.number;
                let [b, _] = other.number;
                other.surface == edge.surface
                    && other.name == edge.name
                    && n > 2
                    && ((a + 1) % n == b || (b + 1) % n == a)
            };
            let mut best: Vec<(f64, usize)> = (0..edges.len())
                .filter(|&j| j != i && !is_next(&edges[j]))
                .map(|j| (edges[j].samples.iter().map(|q| length(*q)).fold(f64::INFINITY, f64::min), j))
                .collect();
            best.sort_by(|a, b| a.0.total_cmp(&b.0));
            let refined = best.iter().take(4).map(|&(_, j)| {
                let other = &edges[j];
                let (t, square) = other.curve.nearest(|uv| length(self.point(other.surface, uv)));
                (square, j, t)
            });
            let (square, j, t) = refined.min_by(|a, b| a.0.total_cmp(&b.0))?;
            if square.sqrt() > seal {
                return None;
            }
            if k == PARTS / 2 {
                middle = Some((j, t));
            }
        }
        let (j, t) = middle?;
        let other = &edges[j];
        let step = 1.0 / 64.0;
        let at = |t: f64| self.point(other.surface, other.curve.at(t.clamp(0.0, 1.0)));
        let along =
            (at(t + step) - at(t - step)).dot(edge.samples[PARTS / 2 + 1] - edge.samples[PARTS / 2 - 1]);
        Some((j, if along > 0.0 { Match::Along } else { Match::Against }))
    }

    fn error(&self, edge: &Edge) -> SewnError {
        let place = |p: Vec3| self.shell.centre + p.map(|x| durer_math::scale::ldexp(x, self.shell.scale));
        let [from, to]: [Point3; 2] = [place(edge.samples[0]), place(edge.samples[PARTS])];
        SewnError::Edge { surface: edge.surface + 1, edge: edge.name.clone(), from, to }
    }

    /// For each surface, its connected group and whether its orientation must be reversed.
    pub(super) fn joined(&self, seal: f64) -> Result<Vec<(usize, bool)>, SewnError> {
        let edges = self.edges();
        let mut links = Vec::new();
        for (i, edge) in edges.iter().enumerate() {
            let same = (0..edges.len()).filter(|&j| j != i);
            let mut partners: Vec<_> =
                same.filter_map(|j| Some((j, self.same_points(edge, &edges[j])?))).collect();
            if partners.is_empty() && seal > 0.0 {
                partners.extend(self.near(&edges, i, seal));
            }
            match partners[..] {
                [] => return Err(self.error(edge)),
                [(j, how)] => links.push((edge.surface, edges[j].surface, how)),
                _ => {
                    let SewnError::Edge { surface, edge, from, to } = self.error(edge) else { continue };
                    return Err(SewnError::Many { surface, edge, from, to, count: partners.len() + 1 });
                }
            }
        }
        let mut groups: Vec<Option<(usize, bool)>> = vec![None; self.parts.len()];
        for start in 0..groups.len() {
            if groups[start].is_some() {
                continue;
            }
            groups[start] = Some((start, false));
            let mut open = vec![(start, false)];
            while let Some((now, turned)) = open.pop() {
                for &(a, b, how) in &links {
                    let other = match (a == now, b == now) {
                        (true, _) => b,
                        (_, true) => a,
                        _ => continue,
                    };
                    let wanted = turned ^ (how == Match::Along);
                    match groups[other] {
                        None => {
                            groups[other] = Some((start, wanted));
                            open.push((other, wanted));
                        }
                        Some((_, known)) if known != wanted => {
                            return Err(SewnError::Sides { a: now + 1, b: other + 1 });
                        }
                        Some(_) => {}
                    }
                }
            }
        }
        Ok(groups.into_iter().flatten().collect())
    }
}
