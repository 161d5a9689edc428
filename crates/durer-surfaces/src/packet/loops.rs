//! Closed outlines in a plane, and how often they go around points of it.
//!
//! The winding number counts the edges that pass a point's level, upward on its one side and downward on the other (`polygon.rs` counts in the same way, about
//! the exact ray). A level is the height along some direction in the plane; both it and the side of an edge are linear.
//!
//! Vertices of a polygon may lie off its plane by a small distance `δ`, and the ray passes the edges between the stored ones. Moved into the plane along the ray,
//! a vertex is at most `δ / cos θ` from its foot, `θ` the angle of ray and normal; so are the points of moved edges from those of the edges between feet, of which
//! `level` and `side` tell. A point that is farther than that from a level, or from the line of an edge that passes its level, is above or beside it in both.

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
    /// `None` if all vertices lie in the plane, exactly.
    pub(super) off: Option<Off>,
}

/// How far vertices lie off the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    /// At most so far.
    pub(super) distance: f64,
    /// Points of the plane that are at most so far outside the feet of the outlines still lie in the polygon's box.
    pub(super) room: f64,
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
        Loops { edges: edges.collect(), ends: self.ends, rule: self.rule, off: self.off }
    }

    /// The same, if there are such numbers.
    pub(super) fn try_map<G>(&self, f: impl Fn(&F) -> Option<G>) -> Option<Loops<G>> {
        let edges = self.edges.iter().map(|e| Some(Edge { level: f(&e.level)?, side: f(&e.side)? }));
        let edges = edges.collect::<Option<_>>()?;
        Some(Loops { edges, ends: self.ends.clone(), rule: self.rule, off: self.off })
    }
}

/// The level of a vertex: where points are above it, and where that is not sure.
type VertexSide8 = (M8, M8);

impl Loops<QuadricFace8> {
    /// Where points of a plane are surely inside, and where they are surely outside.
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

impl Off {
    /// How far vertices move that are moved into the plane along eight rays, as a sum of absolute values; and where that may be too far.
    #[inline(always)]
    fn slip(&self, plane: &QuadricFace8, rays: &Seen<'_>) -> (F8, M8) {
        let slope = plane.slope_at_least(rays);
        // cos θ >= |b·d| / (|b|₁ |d|₁); a length of one is at most √3 as a sum of absolute values.
        let slip = *rays.d1 * (plane.b1() * self.distance) / slope * (1.0 + 16.0 * U);
        let near = slope.gt(F8::ZERO) & slip.le(F8::splat(self.room));
        (near.keep(slip) * 1.75, !near)
    }
}

/// Adding and taking away this number rounds to a whole one.
const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

#[inline(always)]
fn level(edge: &Edge<QuadricFace8>, spot: &Spot) -> VertexSide8 {
    let (f, e) = edge.level.at(spot.y, spot.y1, spot.e1);
    (f.gt(F8::ZERO), !f.abs().gt(e))
}
