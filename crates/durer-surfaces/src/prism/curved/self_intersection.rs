//! Whether curves meet themselves or each other, and on which side of each the inside lies.
//!
//! Curves are cut into *arcs* whose directions lie within less than half a turn, so that an arc
//! does not meet itself. Two arcs are apart if their control points' boxes are. Two successive arcs
//! meet only in their common end if some line through it has the control points of one on one side
//! and those of the other on the other side. All other arcs are halved. The answer "they may meet"
//! is always safe, and costs only time.

use super::spline::Bezier;
use crate::prism::outline::Point;
use core::cmp::Ordering;
use durer_math::{Ring, U};

/// With more pairs of arcs than this the curves count as meeting.
const MOST_PAIRS: usize = 1 << 20;
/// Arcs are halved at most this many times.
const DEEPEST: u32 = 40;

/// A part of a curve.
#[derive(Clone, Copy)]
struct Arc {
    b: Bezier,
    /// The curve, the numbers of the arc's ends on it, and how often the arc was halved.
    outline: usize,
    ends: [u64; 2],
    depth: u32,
    /// Whether the derivative vanishes at this end: two control points are equal.
    still: [bool; 2],
}

/// The number of a piece's start on its curve; the numbers up to the next start suffice for all
/// halves.
fn number(piece: usize) -> u64 {
    (piece as u64) << DEEPEST
}

impl Arc {
    fn halves(&self) -> [Self; 2] {
        let b = self.b;
        let mid = |p: Point, q: Point| [0.5 * p[0] + 0.5 * q[0], 0.5 * p[1] + 0.5 * q[1]];
        let (l, m, r) = (mid(b[0], b[1]), mid(b[1], b[2]), mid(b[2], b[3]));
        let (lm, mr) = (mid(l, m), mid(m, r));
        let centre = mid(lm, mr);
        let [from, to] = self.ends;
        // The last end may be the first end of the closed curve.
        let to = if to > from { to } else { from + (1 << (DEEPEST - self.depth)) };
        let half = from + (to - from) / 2;
        let depth = self.depth + 1;
        [
            Self {
                b: [b[0], l, lm, centre],
                ends: [from, half],
                depth,
                still: [self.still[0], false],
                ..*self
            },
            Self {
                b: [centre, mr, r, b[3]],
                ends: [half, self.ends[1]],
                depth,
                still: [false, self.still[1]],
                ..*self
            },
        ]
    }

    /// Whether all directions of the arc certainly lie within less than half a turn, by more than
    /// `room`.
    fn is_simple(&self, room: f64) -> bool {
        let step = |i: usize| minus(self.b[i + 1], self.b[i]);
        let way = minus(self.b[3], self.b[0]);
        let from = usize::from(self.still[0]);
        let to = 3 - usize::from(self.still[1]);
        (from..to).all(|i| dot(step(i), way) > room * (way[0].abs() + way[1].abs()))
    }

    fn range(&self, k: usize) -> (f64, f64) {
        let x = self.b.map(|p| p[k]);
        (x.iter().copied().fold(f64::INFINITY, f64::min), x.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    }

    fn is_apart(&self, other: &Self, room: f64) -> bool {
        (0..2).any(|k| {
            let ((a, b), (c, d)) = (self.range(k), other.range(k));
            b + room < c - room || d + room < a - room
        })
    }

    fn size(&self) -> f64 {
        let width = |k| self.range(k).1 - self.range(k).0;
        width(0).max(width(1))
    }

    /// Whether this arc and the one that follows it meet only in the common end.
    fn is_followed_simply_by(&self, next: &Self, room: f64) -> bool {
        let at = next.b[0];
        let unit = |v: Point| {
            let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
            v.map(|x| x / length)
        };
        // A control point equal to the end gives no direction.
        let last = (0..3).rev().map(|i| minus(at, self.b[i])).find(|v| *v != [0.0; 2]);
        let first = (1..4).map(|i| minus(next.b[i], at)).find(|v| *v != [0.0; 2]);
        let (Some(last), Some(first)) = (last, first) else { return false };
        let (last, first) = (unit(last), unit(first));
        let way = [last[0] + first[0], last[1] + first[1]];
        let room = room * (way[0].abs() + way[1].abs());
        let along = |p: Point| dot(minus(p, at), way);
        let (to, from) = (3 - usize::from(self.still[1]), 1 + usize::from(next.still[0]));
        self.b[..to].iter().all(|&p| along(p) < -room) && next.b[from..].iter().all(|&p| along(p) > room)
    }
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Whether curves certainly meet neither themselves nor each other.
pub(super) fn are_simple(outlines: &[Vec<Bezier>]) -> bool {
    let most = outlines.iter().flatten().flatten().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    // Each halving moves a control point by a few roundings of its size, by at most twice a unit in
    // total; differences and products add their own.
    let room = most * (64.0 * U) * 4.0;
    let mut arcs = Vec::new();
    for (outline, pieces) in outlines.iter().enumerate() {
        let mut open: Vec<Arc> = Vec::new();
        for (i, &b) in pieces.iter().enumerate().rev() {
            let ends = [number(i), number((i + 1) % pieces.len())];
            let still = [b[0] == b[1], b[2] == b[3]];
            open.push(Arc { b, outline, ends, depth: 0, still });
        }
        // At least two halves, so that no two arcs have both ends in common.
        while let Some(arc) = open.pop() {
            if arc.depth > 0 && arc.is_simple(room) {
                arcs.push(arc);
            } else if arc.depth == 10 {
                return false;
            } else {
                let [l, r] = arc.halves();
                open.extend([r, l]);
            }
        }
    }
    if arcs.len() * arcs.len() / 2 > MOST_PAIRS {
        return false;
    }
    let mut left = MOST_PAIRS;
    let mut open = Vec::new();
    for (i, a) in arcs.iter().enumerate() {
        for b in &arcs[..i] {
            open.push((*b, *a));
            while let Some((a, b)) = open.pop() {
                if a.is_apart(&b, room) {
                    continue;
                }
                let follows = |a: &Arc, b: &Arc| a.outline == b.outline && a.ends[1] == b.ends[0];
                if follows(&a, &b) && a.is_followed_simply_by(&b, room)
                    || follows(&b, &a) && b.is_followed_simply_by(&a, room)
                {
                    continue;
                }
                if a.depth.max(b.depth) + 1 >= DEEPEST || left == 0 {
                    return false;
                }
                left -= 1;
                let (large, small) = if a.size() >= b.size() { (a, b) } else { (b, a) };
                open.extend(large.halves().map(|half| (half, small)));
            }
        }
    }
    true
}

/// The sign of the area within a closed curve that does not meet itself, with x to the right and z up:
/// positive if it goes round counter-clockwise. `None` if the numbers leave it open.
///
/// Twice the area is the integral of `x z' - z x'`; the factors are those of the powers of `y`,
/// integrated from -1/2 to 1/2, times 240.
pub(super) fn turn<T: Ring>(powers: impl Iterator<Item = [[T; 2]; 4]>) -> Option<Ordering> {
    let area = powers.fold(T::exact(0.0), |sum, p| {
        let minor = |i: usize, j: usize| {
            let of = |a: usize, b: usize| p[a][0].clone() * p[b][1].clone();
            of(i, j) - of(j, i)
        };
        [(0, 1, 240.0), (0, 3, 60.0), (1, 2, 20.0), (2, 3, 3.0)]
            .iter()
            .fold(sum, |sum, &(i, j, times)| sum + minor(i, j) * T::exact(times))
    });
    area.sign()
}

#[cfg(test)]
mod tests {
    use super::super::spline::Spline;
    use super::*;

    /// An approximate circle of four arcs.
    fn ring(at: Point, r: f64) -> Vec<Bezier> {
        let k = 0.5523 * r;
        let p = |x: f64, z: f64| [at[0] + x, at[1] + z];
        vec![
            [p(r, 0.0), p(r, k), p(k, r), p(0.0, r)],
            [p(0.0, r), p(-k, r), p(-r, k), p(-r, 0.0)],
            [p(-r, 0.0), p(-r, -k), p(-k, -r), p(0.0, -r)],
            [p(0.0, -r), p(k, -r), p(r, -k), p(r, 0.0)],
        ]
    }

    #[test]
    fn curves_that_cross_or_touch_are_noticed() {
        let alone = |outlines: &[Vec<Bezier>]| are_simple(outlines);
        assert!(alone(&[ring([0.0; 2], 1.0)]));
        assert!(alone(&[ring([0.0; 2], 3.0), ring([0.0; 2], 1.0), ring([1e-3, 0.5], 0.25)]));
        assert!(alone(&[ring([0.0; 2], 1.0), ring([2.0 + 1e-9, 0.0], 1.0)]), "nearly touching");
        assert!(!alone(&[ring([0.0; 2], 1.0), ring([2.0, 0.0], 1.0)]), "touching");
        assert!(!alone(&[ring([0.0; 2], 1.0), ring([1.0, 0.0], 1.0)]), "crossing");
        // A curve with a loop, closed by a line.
        let loop_ = [[0.0, 0.0], [4.0, 4.0], [-3.0, 4.0], [1.0, 0.0]];
        let back = [[1.0, 0.0], [0.7, -1.0], [0.3, -1.0], [0.0, 0.0]];
        assert!(!alone(&[vec![loop_, back]]), "a loop");
        let arch = [[0.0, 0.0], [0.0, 4.0], [1.0, 4.0], [1.0, 0.0]];
        assert!(alone(&[vec![arch, back]]), "an arch");
        let cusp = [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]];
        assert!(!alone(&[vec![cusp, back]]), "a cusp");
        assert!(!alone(&[vec![arch, [[1.0, 0.0], [1.0, 4.0], [0.0, 4.0], [0.0, 0.0]]]]), "back on itself");
        let eight = Spline::Cubic.pieces(&[
            [1.0, -1.0],
            [-1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [1.0, -1.0],
            [-1.0, -1.0],
            [1.0, 1.0],
        ]);
        assert!(!alone(&[eight]), "an eight");
        let square = Spline::Bezier.pieces(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [3.0, 3.0],
            [3.0, 3.0],
            [3.0, 3.0],
            [0.0, 0.0],
            [0.0, 0.0],
        ]);
        assert!(alone(&[square]), "straight edges");
    }
}
