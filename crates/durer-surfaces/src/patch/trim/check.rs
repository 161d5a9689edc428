//! Whether loops can be trims: closed, within the domain, free of crossings, and directed.

use super::Ring;
use super::curve::{Box2, Piece};
use durer_math::scale::pow2;

/// Curves that are nearer to each other than this, relative to the domain, touch.
const NEAR: f64 = pow2(-30);
/// The most halvings for one pair of curves.
const MOST_STEPS: usize = 100_000;

/// Why a [`TrimLoop`](super::TrimLoop) cannot be a trim.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TrimError {
    /// A point is infinite or NaN.
    #[error("point {point} must be finite, got <{u}, {v}>")]
    Point {
        /// The point, from 1.
        point: usize,
        /// Its u.
        u: f64,
        /// Its v.
        v: f64,
    },
    /// A weight is not positive, infinite or NaN, or much less than another.
    #[error(
        "the weight of point {point} must be positive and finite and not far from the others, got {weight}"
    )]
    Weight {
        /// The point, from 1.
        point: usize,
        /// Its weight.
        weight: f64,
    },
    /// There are too few points.
    #[error("it needs {least} points at least, got {len}")]
    TooFew {
        /// How many it needs.
        least: usize,
        /// How many there are.
        len: usize,
    },
    /// The number of points is not four for each cubic.
    #[error("a bezier_spline has four points for each piece, got {0}")]
    Fours(usize),
    /// The degree is out of range.
    #[error("the degree must be 1 to 9, got {0}")]
    Degree(usize),
    /// The number of knots is wrong.
    #[error("{needed} knots are needed, got {len}")]
    Knots {
        /// How many are needed.
        needed: usize,
        /// How many there are.
        len: usize,
    },
    /// A knot is infinite, NaN, less than the one before it or repeated too often.
    #[error(
        "knots must be finite, must not decrease, and must not occur more often than the degree, but knot {number} is {knot}"
    )]
    Knot {
        /// The knot, from 1.
        number: usize,
        /// Its value.
        knot: f64,
    },
    /// It has no length or no area.
    #[error("it encloses nothing")]
    Nothing,
    /// A curve does not begin where the one before it ends.
    #[error("it is open: a curve ends at <{}, {}> and the next begins at <{}, {}>", end[0], end[1], start[0], start[1])]
    Open {
        /// Where a curve ends.
        end: [f64; 2],
        /// Where the next one begins.
        start: [f64; 2],
    },
    /// It leaves the domain of the surface.
    #[error("it leaves the surface at <{}, {}>", .0[0], .0[1])]
    Leaves([f64; 2]),
    /// It crosses or touches itself.
    #[error("it crosses or touches itself near <{}, {}>", .0[0], .0[1])]
    Itself([f64; 2]),
    /// It crosses or touches another one.
    #[error("it crosses or touches trim {other} near <{}, {}>", at[0], at[1])]
    Another {
        /// The other, from 1.
        other: usize,
        /// Where.
        at: [f64; 2],
    },
    /// It runs the same way round as the loop around it.
    #[error(
        "it runs the same way round as trim {0}, which encloses it: reverse one of them, since a trim keeps what is on its left"
    )]
    SameWay(usize),
    /// Two loops that are side by side run in different ways.
    #[error("it runs the other way round from trim {0}, and neither encloses the other: reverse one of them")]
    OtherWay(usize),
}

/// Checks that all points are finite.
pub(super) fn finite(points: impl Iterator<Item = [f64; 2]>) -> Result<(), TrimError> {
    for (i, [u, v]) in points.enumerate() {
        if !(u.abs() < crate::patch::LARGEST && v.abs() < crate::patch::LARGEST) {
            return Err(TrimError::Point { point: i + 1, u, v });
        }
    }
    Ok(())
}

/// The knots of a curve, after its numbers were checked.
pub(super) fn knots(degree: usize, points: &[[f64; 3]], given: &[f64]) -> Result<Vec<f64>, TrimError> {
    let len = points.len();
    if !(1..=9).contains(&degree) {
        return Err(TrimError::Degree(degree));
    }
    if len < degree + 1 {
        return Err(TrimError::TooFew { least: degree + 1, len });
    }
    let heaviest = points.iter().fold(0.0, |m: f64, p| m.max(p[2]));
    for (i, p) in points.iter().enumerate() {
        if !(p[2] > 0.0 && p[2].is_finite() && heaviest / p[2] <= crate::patch::WEIGHTS) {
            return Err(TrimError::Weight { point: i + 1, weight: p[2] });
        }
    }
    let needed = len + degree + 1;
    if given.is_empty() {
        return Ok((0..needed).map(|i| i.clamp(degree, len) as f64 - degree as f64).collect());
    }
    if given.len() != needed {
        return Err(TrimError::Knots { needed, len: given.len() });
    }
    for (i, &knot) in given.iter().enumerate() {
        let repeated = i > degree && given[i - degree - 1] == knot
            || i >= degree && given[i - degree] == knot && knot != given[0] && knot != given[needed - 1];
        if !knot.is_finite() || i > 0 && knot < given[i - 1] || repeated {
            return Err(TrimError::Knot { number: i + 1, knot });
        }
    }
    if given[degree] >= given[len] {
        return Err(TrimError::Knot { number: len + 1, knot: given[len] });
    }
    Ok(given.to_vec())
}

/// Checks that a loop is in the domain.
pub(super) fn within(pieces: &[Piece], domain: &Box2) -> Result<(), TrimError> {
    for piece in pieces {
        let mut open = vec![piece.clone()];
        while let Some(piece) = open.pop() {
            let room = domain.grown(2.0 * piece.error);
            let is_in = |p: [f64; 2]| (0..2).all(|k| p[k] >= room.low[k] && p[k] <= room.high[k]);
            if let Some(out) = [piece.start, piece.end].into_iter().find(|p| !is_in(*p)) {
                return Err(TrimError::Leaves(out));
            }
            let bounds = piece.bounds();
            if !piece.hull().all(is_in) && bounds.size() > NEAR * domain.size() {
                open.extend(piece.halves());
            }
        }
    }
    Ok(())
}

/// Checks that a loop does not cross itself.
pub(super) fn alone(pieces: &[Piece], domain: &Box2) -> Result<(), TrimError> {
    let mut search = Search { least: NEAR * domain.size(), steps: 0 };
    if let [one] = pieces {
        // Its ends meet.
        let [a, b] = one.halves();
        return match search.itself(&a).or_else(|| search.itself(&b)).or_else(|| search.both_ends(&a, &b)) {
            Some(at) => Err(TrimError::Itself(at)),
            None => Ok(()),
        };
    }
    for piece in pieces {
        if let Some(at) = search.itself(piece) {
            return Err(TrimError::Itself(at));
        }
    }
    let n = pieces.len();
    for i in 0..n {
        for j in i + 1..n {
            let (a, b) = (&pieces[i], &pieces[j]);
            let joined = match (j == i + 1, i == 0 && j == n - 1) {
                // Two pieces have both ends in common.
                (true, true) => search.both_ends(a, b),
                (true, false) => search.joined(a, b),
                (false, true) => search.joined(b, a),
                _ => search.cross(a, b),
            };
            if let Some(at) = joined {
                return Err(TrimError::Itself(at));
            }
        }
    }
    Ok(())
}

/// Checks that no loop crosses another. The error has the number of the loop, from 1.
pub(super) fn apart(rings: &[Ring], domain: &Box2) -> Result<(), (usize, TrimError)> {
    let mut search = Search { least: NEAR * domain.size(), steps: 0 };
    for (j, b) in rings.iter().enumerate() {
        for (i, a) in rings[..j].iter().enumerate() {
            if !a.stretches[0].bounds.meets(&b.stretches[0].bounds) {
                continue;
            }
            for p in &a.pieces {
                for q in &b.pieces {
                    if let Some(at) = search.cross(p, q) {
                        return Err((j + 1, TrimError::Another { other: i + 1, at }));
                    }
                }
            }
        }
    }
    Ok(())
}

/// Checks that each loop runs the other way than the one around it, and all outermost ones the same
/// way. Returns whether points in no loop are kept.
pub(super) fn directions(rings: &[Ring]) -> Result<bool, (usize, TrimError)> {
    let around = |i: usize| {
        let p = rings[i].pieces[0].start;
        let point = Box2 { low: p, high: p };
        let holds = |k: usize| k != i && rings[k].crossings(p, &point) == Some(true);
        let all = (0..rings.len()).filter(|&k| holds(k));
        all.min_by(|a, b| rings[*a].area.abs().total_cmp(&rings[*b].area.abs()))
    };
    let mut first = None;
    for (i, ring) in rings.iter().enumerate() {
        if ring.area == 0.0 || ring.area.is_nan() {
            return Err((i + 1, TrimError::Nothing));
        }
        let left = ring.area > 0.0;
        match around(i) {
            Some(k) if (rings[k].area > 0.0) == left => return Err((i + 1, TrimError::SameWay(k + 1))),
            Some(_) => {}
            None => match first {
                Some((k, other)) if other != left => return Err((i + 1, TrimError::OtherWay(k + 1))),
                _ => first = first.or(Some((i, left))),
            },
        }
    }
    Ok(first.is_some_and(|(_, left)| !left))
}

/// A search for places where curves meet.
struct Search {
    /// Curves smaller than this that no line separates meet.
    least: f64,
    steps: usize,
}

impl Search {
    /// Where two curves that have no end in common meet.
    fn cross(&mut self, a: &Piece, b: &Piece) -> Option<[f64; 2]> {
        self.steps += 1;
        if is_apart(a, b) || self.steps > MOST_STEPS {
            return None;
        }
        let (wide, narrow) = if a.bounds().size() >= b.bounds().size() { (a, b) } else { (b, a) };
        if wide.bounds().size() < self.least {
            return Some(wide.start);
        }
        let [low, high] = wide.halves();
        self.cross(&low, narrow).or_else(|| self.cross(&high, narrow))
    }

    /// Where two curves meet apart from their common point, the end of one and the start of the
    /// other.
    fn joined(&mut self, a: &Piece, b: &Piece) -> Option<[f64; 2]> {
        self.steps += 1;
        let small = a.bounds().size().max(b.bounds().size()) < self.least;
        if is_split(a, b) || small || self.steps > MOST_STEPS {
            return None;
        }
        let ([a, mid_a], [mid_b, b]) = (a.halves(), b.halves());
        self.cross(&a, &mid_b)
            .or_else(|| self.cross(&a, &b))
            .or_else(|| self.cross(&mid_a, &b))
            .or_else(|| self.joined(&mid_a, &mid_b))
    }

    /// Where two curves that have both ends in common meet elsewhere.
    fn both_ends(&mut self, a: &Piece, b: &Piece) -> Option<[f64; 2]> {
        let ([a, mid_a], [mid_b, b]) = (a.halves(), b.halves());
        self.joined(&mid_a, &mid_b)
            .or_else(|| self.joined(&b, &a))
            .or_else(|| self.cross(&a, &mid_b))
            .or_else(|| self.cross(&mid_a, &b))
    }

    /// Where a curve meets itself.
    fn itself(&mut self, piece: &Piece) -> Option<[f64; 2]> {
        if piece.is_forward() || piece.bounds().size() < self.least {
            return None;
        }
        let [a, b] = piece.halves();
        self.itself(&a).or_else(|| self.itself(&b)).or_else(|| self.joined(&a, &b))
    }
}

/// The directions along which curves may be separated: the axes, and along and across their chords.
fn directions_of(a: &Piece, b: &Piece) -> [[f64; 2]; 6] {
    let chord = |p: &Piece| {
        let [x, y] = [p.end[0] - p.start[0], p.end[1] - p.start[1]];
        let length = (x * x + y * y).sqrt();
        if length > 0.0 { [x / length, y / length] } else { [1.0, 0.0] }
    };
    let ([ax, ay], [bx, by]) = (chord(a), chord(b));
    [[1.0, 0.0], [0.0, 1.0], [-ay, ax], [-by, bx], [ax, ay], [bx, by]]
}

fn range(piece: &Piece, [x, y]: [f64; 2]) -> (f64, f64) {
    let along = |p: [f64; 2]| p[0] * x + p[1] * y;
    piece
        .hull()
        .chain([piece.start, piece.end])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(along(p)), high.max(along(p))))
}

/// The rounding of projections, and the errors of both curves.
fn room(a: &Piece, b: &Piece) -> f64 {
    let size = [a, b].iter().fold(0.0, |m: f64, p| {
        let Box2 { low, high } = p.bounds();
        low.iter().chain(&high).fold(m, |m: f64, x| m.max(x.abs()))
    });
    2.0 * (a.error + b.error) + 16.0 * durer_math::U * size
}

/// Whether a line separates two curves.
fn is_apart(a: &Piece, b: &Piece) -> bool {
    let room = room(a, b);
    directions_of(a, b).into_iter().any(|n| {
        let ((a_low, a_high), (b_low, b_high)) = (range(a, n), range(b, n));
        a_high + room < b_low || b_high + room < a_low
    })
}

/// Whether a line through the common end of `a` and start of `b` separates them elsewhere.
fn is_split(a: &Piece, b: &Piece) -> bool {
    let room = room(a, b);
    directions_of(a, b).into_iter().any(|n| {
        let at = a.end[0] * n[0] + a.end[1] * n[1];
        let ((a_low, a_high), (b_low, b_high)) = (range(a, n), range(b, n));
        // They are on different sides of the line.
        a_high <= at + room && b_low >= at - room && (a_low < at - room || b_high > at + room)
            || b_high <= at + room && a_low >= at - room && (b_low < at - room || a_high > at + room)
    })
}
