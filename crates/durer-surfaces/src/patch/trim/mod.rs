//! Trims: loops of curves in the plane of the parameters. The part to the left of them is kept.
//!
//! A point is inside if a line from it to the right crosses the loops an odd number of times (M.
//! Shimrat, "Algorithm 112: position of point relative to polygon", *Communications of the ACM* 5
//! (1962) 434). A crossing of a ray and a patch is known as a box; all its points are on one side
//! unless a loop passes through the box. The ends of a stretch of a loop that is to the right of
//! the box decide its crossings, so a loop is a tree of stretches and few of them are visited. A
//! curve near the box is halved until it is apart from the box or as small (the bands of T.
//! Nishita, T. W. Sederberg, M. Kakimoto, "Ray tracing trimmed rational surface patches",
//! *SIGGRAPH* 1990, without their tolerance).
//!
//! Loops do not cross. A loop runs counter-clockwise about a part that is kept, or clockwise about
//! a hole, and the next loop within it runs the other way; so an odd number of crossings is "left
//! of the innermost loop around".

mod check;
pub(super) mod curve;

use super::net::Homogeneous;
use super::nurbs::spans;
use curve::{Box2, Piece};
use durer_math::{Dd, U};

pub use check::TrimError;

/// A closed curve in the parameters of a [`Nurbs`](crate::Nurbs) surface, in the units of its
/// knots.
#[derive(Clone, Debug, PartialEq)]
pub enum TrimLoop {
    /// A polygon; the last point joins the first.
    Polygon(Vec<[f64; 2]>),
    /// Cubic Bezier curves, four points each; each begins where the one before it ends.
    Bezier(Vec<[f64; 2]>),
    /// A closed rational B-spline curve.
    Nurbs {
        /// The degree, 1 to 9.
        degree: usize,
        /// The points and their weights: `[u, v, w]`, with coordinates that are not multiplied by
        /// the weight.
        points: Vec<[f64; 3]>,
        /// The knots: the number of points plus the degree plus one. Empty: uniform, with ends at
        /// the outer points.
        knots: Vec<f64>,
    },
}

/// A stretch of a loop: the pieces from `first` on.
#[derive(Clone, Debug)]
struct Stretch {
    bounds: Box2,
    first: usize,
    count: usize,
    /// Its halves.
    next: Option<[usize; 2]>,
}

/// One loop.
#[derive(Clone, Debug)]
struct Ring {
    pieces: Vec<Piece>,
    /// For each piece, the side of the domain on which it lies: such a piece cuts nothing off.
    border: Vec<Option<Border>>,
    /// The tree of stretches; the first is the whole loop.
    stretches: Vec<Stretch>,
    area: f64,
}

/// Where a piece lies on the border of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Border {
    Right,
    Other,
}

/// The trims of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Trims {
    rings: Vec<Ring>,
    domain: Box2,
    /// Whether points in no loop are kept: then the outermost loops are holes.
    outside: bool,
}

impl Ring {
    fn new(pieces: Vec<Piece>, domain: &Box2) -> Self {
        let border = |p: &Piece| {
            if p.is_at(0, domain.high[0]) {
                return Some(Border::Right);
            }
            let other = p.is_at(0, domain.low[0]) || p.is_at(1, domain.low[1]) || p.is_at(1, domain.high[1]);
            other.then_some(Border::Other)
        };
        let area = pieces.iter().map(Piece::area).sum();
        let mut ring = Self { border: pieces.iter().map(border).collect(), pieces, stretches: vec![], area };
        ring.divide(0, ring.pieces.len());
        ring
    }

    fn divide(&mut self, first: usize, count: usize) -> usize {
        let place = self.stretches.len();
        self.stretches.push(Stretch { bounds: Box2::EMPTY, first, count, next: None });
        if count == 1 {
            self.stretches[place].bounds = self.pieces[first].bounds();
        } else {
            let half = count / 2;
            let next = [self.divide(first, half), self.divide(first + half, count - half)];
            let [a, b] = next.map(|k| self.stretches[k].bounds);
            self.stretches[place].bounds = a.union(&b);
            self.stretches[place].next = Some(next);
        }
        place
    }

    /// Whether the line to the right from `p` crosses the ring an odd number of times; `None` if the
    /// ring may pass through the box about `p`.
    fn crossings(&self, p: [f64; 2], around: &Box2) -> Option<bool> {
        let mut odd = false;
        let mut open = vec![0];
        while let Some(k) = open.pop() {
            let stretch = &self.stretches[k];
            let (first, last) = (stretch.first, stretch.first + stretch.count - 1);
            let ends = [self.pieces[first].start[1], self.pieces[last].end[1]];
            match passes(&stretch.bounds, ends, p, around) {
                Pass::Known(crosses) => odd ^= crosses,
                Pass::Near => match stretch.next {
                    Some(next) => open.extend(next),
                    None => odd ^= self.piece_crossings(first, p, around)?,
                },
            }
        }
        Some(odd)
    }

    fn piece_crossings(&self, number: usize, p: [f64; 2], around: &Box2) -> Option<bool> {
        let piece = &self.pieces[number];
        match self.border[number] {
            Some(Border::Right) => return Some((piece.start[1] > p[1]) != (piece.end[1] > p[1])),
            Some(Border::Other) => return Some(false),
            None => {}
        }
        let least = 0.5 * around.size();
        let mut odd = false;
        let mut open = vec![piece.clone()];
        while let Some(piece) = open.pop() {
            let bounds = piece.bounds();
            match passes(&bounds, [piece.start[1], piece.end[1]], p, around) {
                Pass::Known(crosses) => odd ^= crosses,
                Pass::Near => {
                    if bounds.size() <= least.max(4.0 * piece.error) {
                        return None;
                    }
                    open.extend(piece.halves());
                }
            }
        }
        Some(odd)
    }
}

enum Pass {
    /// Whether the line to the right crosses it an odd number of times.
    Known(bool),
    /// It may pass through the box.
    Near,
}

/// The crossings of a curve that lies in a box and whose ends have these `v`.
fn passes(bounds: &Box2, [start, end]: [f64; 2], p: [f64; 2], around: &Box2) -> Pass {
    if bounds.meets(around) {
        return Pass::Near;
    }
    let is_right = bounds.low[0] > around.high[0];
    Pass::Known(is_right && (start > p[1]) != (end > p[1]))
}

impl Trims {
    /// The trims of a surface whose parameters go from `low` to `high`. The error has the number of
    /// the wrong loop, from 1.
    pub(super) fn new(loops: &[TrimLoop], [low, high]: [[f64; 2]; 2]) -> Result<Self, (usize, TrimError)> {
        let domain = Box2 { low, high };
        let mut rings = Vec::new();
        for (i, given) in loops.iter().enumerate() {
            let pieces = pieces(given).map_err(|why| (i + 1, why))?;
            check::within(&pieces, &domain).map_err(|why| (i + 1, why))?;
            check::alone(&pieces, &domain).map_err(|why| (i + 1, why))?;
            rings.push(Ring::new(pieces, &domain));
        }
        check::apart(&rings, &domain)?;
        let outside = check::directions(&rings)?;
        Ok(Self { rings, domain, outside })
    }

    /// No trims at all.
    pub(super) fn none([low, high]: [[f64; 2]; 2]) -> Self {
        Self { rings: vec![], domain: Box2 { low, high }, outside: true }
    }

    /// The pieces of each loop in order.
    pub(super) fn loops(&self) -> impl Iterator<Item = &[Piece]> {
        self.rings.iter().map(|ring| &ring.pieces[..])
    }

    /// Whether points in no loop are kept.
    pub(super) fn is_open(&self) -> bool {
        self.outside
    }

    /// Whether parameters are beyond the domain by more than a radius.
    pub(super) fn is_beyond(&self, uv: [f64; 2], radius: [f64; 2]) -> bool {
        let Box2 { low, high } = self.domain;
        (0..2).any(|k| uv[k] + radius[k] < low[k] || uv[k] - radius[k] > high[k])
    }

    /// The distance of parameters from the edge of the kept part, where a step `(u, v)` has the
    /// squared length `a u² + 2 b u v + c v²`.
    pub(super) fn distance(&self, uv: [f64; 2], [a, b, c]: [f64; 3]) -> f64 {
        let length = |p: [f64; 2]| {
            let [u, v] = [p[0] - uv[0], p[1] - uv[1]];
            a * u * u + 2.0 * b * u * v + c * v * v
        };
        let Box2 { low, high } = self.domain;
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let border = (0..4).map(|i| Piece::line(corners[i], corners[(i + 1) % 4]));
        let border: Vec<Piece> = if self.outside { border.collect() } else { vec![] };
        let pieces = border.iter().chain(self.rings.iter().flat_map(|ring| &ring.pieces));
        pieces.map(|piece| piece.nearest(length).1).fold(f64::INFINITY, f64::min).max(0.0).sqrt()
    }

    /// Whether parameters within `radius` of a point are kept; `None` if only some may be.
    pub(super) fn keeps(&self, uv: [f64; 2], radius: [f64; 2]) -> Option<bool> {
        let around = Box2 {
            low: [0, 1].map(|k: usize| uv[k] - radius[k]),
            high: [0, 1].map(|k: usize| uv[k] + radius[k]),
        };
        // A point beyond the domain is moved to its border; a line along its upper side crosses
        // nothing.
        let Box2 { low, high } = self.domain;
        let p = [uv[0].clamp(low[0], high[0]), uv[1].min(high[1].next_down()).max(low[1])];
        let around = around.with(p);
        let mut odd = self.outside;
        for ring in &self.rings {
            odd ^= ring.crossings(p, &around)?;
        }
        Some(odd)
    }
}

/// The pieces of a loop, each beginning exactly where the one before it ends.
fn pieces(given: &TrimLoop) -> Result<Vec<Piece>, TrimError> {
    let mut pieces: Vec<Piece> = match given {
        TrimLoop::Polygon(points) => {
            check::finite(points.iter().copied())?;
            if points.len() < 3 {
                return Err(TrimError::TooFew { least: 3, len: points.len() });
            }
            let next = |i: usize| points[(i + 1) % points.len()];
            let all = (0..points.len()).map(|i| (points[i], next(i)));
            // The first point may be repeated at the end.
            all.filter(|(a, b)| a != b).map(|(a, b)| Piece::line(a, b)).collect()
        }
        TrimLoop::Bezier(points) => {
            check::finite(points.iter().copied())?;
            if points.is_empty() || points.len() % 4 != 0 {
                return Err(TrimError::Fours(points.len()));
            }
            let exact = |p: &[f64; 2]| [Dd::from(p[0]), Dd::from(p[1]), Dd::ZERO, Dd::ONE];
            points
                .chunks_exact(4)
                .map(|four| Piece::new(&four.iter().map(exact).collect::<Vec<_>>()))
                .collect()
        }
        TrimLoop::Nurbs { degree, points, knots } => {
            check::finite(points.iter().map(|p| [p[0], p[1]]))?;
            let knots = check::knots(*degree, points, knots)?;
            let times = |p: &[f64; 3]| -> Homogeneous<Dd> {
                [Dd::product(p[0], p[2]), Dd::product(p[1], p[2]), Dd::ZERO, Dd::from(p[2])]
            };
            let curve: Vec<_> = points.iter().map(times).collect();
            let (net, _) = spans(&curve, &knots, *degree);
            (0..(net.len() - 1) / degree).map(|k| Piece::new(&net[k * degree..=(k + 1) * degree])).collect()
        }
    };
    // Curves without length.
    pieces.retain(|p| p.bounds().size() > 2.0 * p.error);
    if pieces.is_empty() {
        return Err(TrimError::Nothing);
    }
    for i in 0..pieces.len() {
        let k = (i + 1) % pieces.len();
        let (end, start) = (pieces[i].end, pieces[k].start);
        let room = pieces[i].error + pieces[k].error + 4.0 * U * end[0].abs().max(end[1].abs());
        if (0..2).any(|c| (end[c] - start[c]).abs() > room) {
            return Err(TrimError::Open { end, start });
        }
        if end != start {
            pieces[k].start = end;
            pieces[k].error += room;
        }
    }
    Ok(pieces)
}
