//! Closed outlines in a plane, and their winding numbers about points.
//!
//! The winding number counts the edges that pass a point's level, upward on one side of the point
//! and downward on the other; `polygon.rs` counts the same way for the exact ray. A level is the
//! height along some direction in the plane. Both the level and the side of an edge are linear.
//!
//! Vertices of a polygon may lie off its plane by a small distance `δ`, and the exact ray is tested
//! against the edges between the stored vertices. Moved into the plane along the ray, a vertex is
//! at most `δ / cos θ` from its perpendicular foot, with `θ` the angle between ray and normal. The
//! same holds for points of the moved edges and of the edges between the feet, which `level` and
//! `side` describe. A point that is farther than that from a level, or from the line of an edge
//! that passes its level, is on the same side of both.

use super::closest::Spot;
use super::quadric::{QuadricFace8, Seen};
use crate::FillRule;
use durer_math::{F8, M8, U};

/// Outlines, one after the other, by the linear forms of their edges.
#[derive(Clone, Debug)]
pub(super) struct Loops<F> {
    pub(super) edges: Vec<Edge<F>>,
    /// Where each outline ends.
    pub(super) ends: Vec<usize>,
    pub(super) rule: FillRule,
    /// The vertices' distance from the plane; `None` if all lie in it exactly.
    pub(super) off: Option<Off>,
}

/// How far vertices lie off the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    /// The greatest distance.
    pub(super) distance: f64,
    /// Points of the plane within this distance of the projected outlines lie in the polygon's box.
    pub(super) room: f64,
}

/// An edge.
#[derive(Clone, Debug)]
pub(super) struct Edge<F> {
    /// The height above the edge's start.
    pub(super) level: F,
    /// Positive to the right of the edge.
    pub(super) side: F,
}

impl<F> Loops<F> {
    /// Maps each form by `f`.
    pub(super) fn map<G>(self, f: impl Fn(F) -> G) -> Loops<G> {
        let edges = self.edges.into_iter().map(|e| Edge { level: f(e.level), side: f(e.side) });
        Loops { edges: edges.collect(), ends: self.ends, rule: self.rule, off: self.off }
    }

    /// Maps each form by `f`; `None` if `f` fails for one of them.
    pub(super) fn try_map<G>(&self, f: impl Fn(&F) -> Option<G>) -> Option<Loops<G>> {
        let edges = self.edges.iter().map(|e| Some(Edge { level: f(&e.level)?, side: f(&e.side)? }));
        let edges = edges.collect::<Option<_>>()?;
        Some(Loops { edges, ends: self.ends.clone(), rule: self.rule, off: self.off })
    }
}

/// For each of eight rays: whether a vertex is above the point, and whether that is uncertain.
type VertexSide8 = (M8, M8);

impl Loops<QuadricFace8> {
    /// For eight points: which are certainly inside, and which certainly outside.
    #[inline(always)]
    pub(super) fn cut(
        &self,
        plane: &QuadricFace8,
        rays: &Seen<'_>,
        spot: &Spot,
        inside: &mut M8,
        outside: &mut M8,
    ) {
        let mut turns = F8::ZERO;
        let (slip, mut unsure) = match &self.off {
            Some(off) => off.slip(plane, rays),
            None => (F8::ZERO, M8::NONE),
        };
        let spot = &Spot { e1: spot.e1 + slip, ..*spot };
        let mut start = 0;
        for &end in &self.ends {
            let outline = &self.edges[start..end];
            start = end;
            let Some(first) = outline.first() else { continue };
            let first = level(first, spot);
            let mut from = first;
            for (i, edge) in outline.iter().enumerate() {
                let to = match outline.get(i + 1) {
                    Some(next) => level(next, spot),
                    None => first,
                };
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
            // Half of an odd number is not an integer; winding numbers are small.
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

impl Off {
    /// How far vertices move, as a sum of absolute values, when they are moved into the plane along
    /// eight rays; and for which rays that may be too far.
    #[inline(always)]
    fn slip(&self, plane: &QuadricFace8, rays: &Seen<'_>) -> (F8, M8) {
        let slope = plane.slope_at_least(rays);
        // `cos θ >= |b·d| / (|b|₁ |d|₁)`; a length of one is at most √3 as a sum of absolute
        // values.
        let slip = *rays.d1 * (plane.b1() * self.distance) / slope * (1.0 + 16.0 * U);
        let near = slope.gt(F8::ZERO) & slip.le(F8::splat(self.room));
        (near.keep(slip) * 1.75, !near)
    }
}

/// Adding and subtracting this number rounds to an integer.
const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

#[inline(always)]
fn level(edge: &Edge<QuadricFace8>, spot: &Spot) -> VertexSide8 {
    let (f, e) = edge.level.at(spot.y, spot.y1, spot.e1);
    (f.gt(F8::ZERO), !f.abs().gt(e))
}
