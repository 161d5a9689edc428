//! Closed outlines in a plane, and how often they go around points of it.
//!
//! The winding number counts the edges that pass a point's level, upward on its one side and downward on the other (`polygon.rs` counts in the same way, about
//! the exact ray). A level is the height along some direction in the plane; both it and the side of an edge are linear.

use super::face::Face;
use super::meet::Spot;
use crate::FillRule;
use durer_math::{F8, M8};

/// Outlines, one after the other, by the linear forms of their edges.
#[derive(Clone, Debug)]
pub(super) struct Loops<F> {
    pub(super) edges: Vec<Edge<F>>,
    /// Where each outline ends.
    pub(super) ends: Vec<usize>,
    pub(super) rule: FillRule,
}

/// An edge.
#[derive(Clone, Debug)]
pub(super) struct Edge<F> {
    /// The height above its start.
    pub(super) level: F,
    /// Positive to its right.
    pub(super) side: F,
}

impl<F> Loops<F> {
    /// The same loops in other numbers.
    pub(super) fn map<G>(self, f: impl Fn(F) -> G) -> Loops<G> {
        let edges = self.edges.into_iter().map(|e| Edge { level: f(e.level), side: f(e.side) });
        Loops { edges: edges.collect(), ends: self.ends, rule: self.rule }
    }

    /// The same, if there are such numbers.
    pub(super) fn try_map<G>(&self, f: impl Fn(&F) -> Option<G>) -> Option<Loops<G>> {
        let edges = self.edges.iter().map(|e| Some(Edge { level: f(&e.level)?, side: f(&e.side)? }));
        Some(Loops { edges: edges.collect::<Option<_>>()?, ends: self.ends.clone(), rule: self.rule })
    }
}

/// The level of a vertex: where points are above it, and where that is not sure.
type Level = (M8, M8);

impl Loops<Face> {
    /// Where points are surely inside, and where they are surely outside.
    #[inline(always)]
    pub(super) fn cut(&self, spot: &Spot, inside: &mut M8, outside: &mut M8) {
        let mut turns = F8::ZERO;
        let mut unsure = M8::NONE;
        let mut start = 0;
        for &end in &self.ends {
            let outline = &self.edges[start..end];
            start = end;
            let Some(first) = outline.first().map(|e| level(e, spot)) else { continue };
            let mut from = first;
            for (i, edge) in outline.iter().enumerate() {
                let to = outline.get(i + 1).map_or(first, |next| level(next, spot));
                let (up, down) = (from.0 & !to.0, !from.0 & to.0);
                let (f, e) = edge.side.at(spot.y, spot.y1, spot.e1);
                unsure |= from.1 | (up | down) & f.abs().le(e);
                let step = (up & f.lt(F8::ZERO)).select(F8::ONE, F8::ZERO)
                    - (down & f.gt(F8::ZERO)).select(F8::ONE, F8::ZERO);
                turns += step;
                from = to;
            }
        }
        let within = match self.rule {
            // Few turns: half of an odd number is not whole.
            FillRule::EvenOdd => {
                let half = turns * 0.5;
                let whole = (half + F8::splat(ROUND)) - F8::splat(ROUND);
                whole.lt(half) | whole.gt(half)
            }
            FillRule::NonZero => turns.abs().gt(F8::ZERO),
        };
        *inside &= within & !unsure;
        *outside |= !within & !unsure;
    }
}

/// Adding and taking away this number rounds to a whole one.
const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

#[inline(always)]
fn level(edge: &Edge<Face>, spot: &Spot) -> Level {
    let (f, e) = edge.level.at(spot.y, spot.y1, spot.e1);
    (f.gt(F8::ZERO), !f.abs().gt(e))
}
