//! Pieces of trim curves: rational Bezier curves in the plane of the parameters.

use crate::patch::net::Homogeneous;
use arrayvec::ArrayVec;
use durer_math::{Dd, U};

/// The most control points of a piece: degree 9.
pub(super) const MOST: usize = 10;

/// A box in the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box2 {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Box2 {
    pub(super) const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    pub(super) fn with(&self, p: [f64; 2]) -> Self {
        Self {
            low: [0, 1].map(|k: usize| self.low[k].min(p[k])),
            high: [0, 1].map(|k: usize| self.high[k].max(p[k])),
        }
    }

    pub(super) fn union(&self, other: &Self) -> Self {
        self.with(other.low).with(other.high)
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    pub(super) fn size(&self) -> f64 {
        (self.high[0] - self.low[0]).max(self.high[1] - self.low[1])
    }
}

/// A Bezier curve, with its ends and a bound on its error: the exact curve is within `error` of this
/// one, along either parameter.
#[derive(Clone, Debug)]
pub(in crate::patch) struct Piece {
    /// `(u w, v w, w)`.
    points: ArrayVec<[f64; 3], MOST>,
    pub(super) start: [f64; 2],
    pub(super) end: [f64; 2],
    pub(super) error: f64,
}

impl Piece {
    /// The curve of points whose coordinates are multiplied by their weights.
    pub(super) fn new(points: &[Homogeneous<Dd>]) -> Self {
        let points: ArrayVec<_, MOST> =
            points.iter().take(MOST).map(|p| [p[0].to_f64(), p[1].to_f64(), p[3].to_f64()]).collect();
        let mut piece = Self { start: [0.0; 2], end: [0.0; 2], error: 0.0, points };
        piece.start = flat(&piece.points[0]);
        piece.end = flat(&piece.points[piece.points.len() - 1]);
        piece.error = 4.0 * U * piece.large();
        piece
    }

    /// The straight line from one point to another.
    pub(in crate::patch) fn line(start: [f64; 2], end: [f64; 2]) -> Self {
        let points = [start, end].map(|p| [p[0], p[1], 1.0]).into_iter().collect();
        Self { points, start, end, error: 0.0 }
    }

    /// The largest coordinate, times the ratio of the largest weight and the least.
    fn large(&self) -> f64 {
        let (mut most, mut light, mut heavy) = (0.0_f64, f64::INFINITY, 0.0_f64);
        for p in &self.points {
            let [u, v] = flat(p);
            most = most.max(u.abs()).max(v.abs());
            (light, heavy) = (light.min(p[2]), heavy.max(p[2]));
        }
        most * (heavy / light)
    }

    /// Both halves, which share their point in the middle: de Casteljau's algorithm.
    pub(super) fn halves(&self) -> [Self; 2] {
        let n = self.points.len();
        let (mut low, mut high) = (self.clone(), self.clone());
        for level in 1..n {
            for k in 0..n - level {
                for c in 0..3 {
                    high.points[k][c] = 0.5 * (high.points[k][c] + high.points[k + 1][c]);
                }
            }
            low.points[level] = high.points[0];
        }
        let middle = flat(&high.points[0]);
        (low.end, high.start) = (middle, middle);
        let error = self.error + 2.0 * (n as f64) * U * self.large();
        (low.error, high.error) = (error, error);
        [low, high]
    }

    /// A box that holds the exact curve and both ends.
    pub(super) fn bounds(&self) -> Box2 {
        let all = self.hull().fold(Box2::EMPTY, |all, p| all.with(p)).with(self.start).with(self.end);
        all.grown(self.error)
    }

    /// The control points.
    pub(super) fn hull(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.points.iter().map(flat)
    }

    /// Whether it goes forth along its chord all the way: then it does not meet itself.
    pub(super) fn is_forward(&self) -> bool {
        let chord = [0, 1].map(|k: usize| self.end[k] - self.start[k]);
        let points: ArrayVec<[f64; 2], MOST> = self.hull().collect();
        points.windows(2).all(|w| (w[1][0] - w[0][0]) * chord[0] + (w[1][1] - w[0][1]) * chord[1] > 0.0)
    }

    /// Whether all of it is at one value of a parameter, exactly.
    pub(super) fn is_at(&self, along: usize, value: f64) -> bool {
        self.start[along] == value
            && self.end[along] == value
            && self.points.iter().all(|p| p[along] == value * p[2])
    }

    /// The area between it and the origin, counter-clockwise: of the polygon with eight corners a
    /// piece.
    pub(super) fn area(&self) -> f64 {
        let parts = self.halves().into_iter().flat_map(|h| h.halves()).flat_map(|h| h.halves());
        parts.map(|p| 0.5 * (p.start[0] * p.end[1] - p.start[1] * p.end[0])).sum()
    }

    /// The point at a parameter from 0 to 1.
    pub(in crate::patch) fn at(&self, t: f64) -> [f64; 2] {
        let mut points = self.points.clone();
        for level in (1..points.len()).rev() {
            for k in 0..level {
                for c in 0..3 {
                    points[k][c] += t * (points[k + 1][c] - points[k][c]);
                }
            }
        }
        flat(&points[0])
    }

    /// The parameter at which a function of the point is least, and its value there: of 16 parts, the
    /// best one is searched by golden sections.
    pub(in crate::patch) fn nearest(&self, cost: impl Fn([f64; 2]) -> f64) -> (f64, f64) {
        const PARTS: usize = 16;
        /// Golden sections: each leaves 0.618 of the width, so these leave 2^-50.
        const SECTIONS: usize = 72;
        let at = |k: usize| k as f64 / PARTS as f64;
        let value = |t: f64| cost(self.at(t));
        let best = (0..=PARTS).min_by(|a, b| value(at(*a)).total_cmp(&value(at(*b)))).unwrap_or(0);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(PARTS)));
        let [mut p, mut q] = [high - golden * (high - low), low + golden * (high - low)];
        let [mut at_p, mut at_q] = [value(p), value(q)];
        for _ in 0..SECTIONS {
            if at_p <= at_q {
                (high, q, at_q) = (q, p, at_p);
                p = high - golden * (high - low);
                at_p = value(p);
            } else {
                (low, p, at_p) = (p, q, at_q);
                q = low + golden * (high - low);
                at_q = value(q);
            }
        }
        let found = [(at(best), value(at(best))), (p, at_p), (q, at_q)];
        found.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(found[0])
    }
}

fn flat(p: &[f64; 3]) -> [f64; 2] {
    [p[0] / p[2], p[1] / p[2]]
}
