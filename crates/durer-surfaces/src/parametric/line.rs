//! A ray and a piece: the ray is sheared onto an axis as for patches, so that a crossing is a zero of
//! two functions of two unknowns.
//!
//! ```text
//!   F = (X - k_x Z,  Y - k_y Z),   (X, Y, Z) = S(u, v) - o,   k_x = d_x / d_z,  |d_z| the largest
//! ```
//!
//! The errors of `F` include those of the ray and every rounding. So a piece is left out only if no
//! ray within these errors meets it, and neighbours need not agree on any rounding.

use super::Bounds;
use super::piece::{Domain, Face, Piece, Unit, around, lane_of, slope_of};
use crate::degree::Place;
use crate::patch::line::Line;
use durer_formula::lanes;
use durer_math::eft::scale2;
use durer_math::{Interval, U};
use durer_roots::two_unknowns::{Content, Limits, Local, ROUNDED, inverse, zero_in};

/// The most steps of Newton's method: from a start in its basin, six give all digits.
const NEWTON: usize = 8;
/// After a step below this, relative to a piece's width, the next one is below the rounding errors.
const NEAR: f64 = durer_math::scale::pow2(-24);
/// Half-widths of the boxes, in widths of the piece, in which a zero is proven. The least one that
/// succeeds gives the narrowest bracket.
const RADII: [f64; 8] = [0.0, pow2(-51), pow2(-48), pow2(-45), pow2(-41), pow2(-36), pow2(-30), pow2(-22)];

const fn pow2(n: i32) -> f64 {
    durer_math::scale::pow2(n)
}

/// A line relative to a map.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) line: &'a Line,
    pub(super) face: &'a Face,
    pub(super) unit: &'a Unit,
    pub(super) cut: &'a Bounds,
}

/// A proven or possible crossing of a line and a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) face: u32,
    /// The parameters, and bounds on their errors.
    pub(super) uv: [f64; 2],
    pub(super) radius: [f64; 2],
    /// A box in which it is the only crossing; empty if nothing is proven.
    pub(super) only: Domain,
    pub(super) s: f64,
    pub(super) s_err: f64,
    /// The sign of `S_u x S_v . d`; 0 if nothing is proven.
    pub(super) sign: i8,
    /// If nothing is proven: the sum of the signs of what is there, or, if that is unknown, that sign
    /// at some points nearby, 0 if they differ.
    pub(super) turn: i8,
}

impl Found {
    pub(super) fn place(&self) -> Place {
        let &Self { face, uv, radius, s, s_err, sign, .. } = self;
        Place { face, uv, radius, s, s_err, sign }
    }
}

/// The empty box.
pub(super) const NOWHERE: Domain = [[f64::INFINITY, f64::NEG_INFINITY]; 2];

impl View<'_> {
    /// Both functions at a point, and bounds on the errors of their values.
    #[inline(always)]
    fn values(&self, p: &[f64; 3], err: &[f64; 3]) -> ([f64; 2], [f64; 2]) {
        let Line { axes, o, o_err, slope, slope_err, .. } = self.line;
        let of = |k: usize| p[axes[k]] - o[k];
        let off = |k: usize| err[axes[k]] + o_err[k];
        let z = of(2);
        let (mut f, mut e) = ([0.0; 2], [0.0; 2]);
        for i in 0..2 {
            let x = of(i);
            f[i] = (-slope[i]).mul_add(z, x);
            let k = slope[i].abs();
            let given = k.mul_add(off(2), off(i)) + slope_err[i] * (z.abs() + off(2));
            e[i] = (given + 2.0 * U * k.mul_add(z.abs(), x.abs())) * ROUNDED;
        }
        (f, e)
    }

    /// The slopes of both functions, and for each function a bound on the errors by both
    /// parameters.
    #[inline(always)]
    fn slopes(&self, j: &[[f64; 2]; 3], err: &[[f64; 2]; 3]) -> ([[f64; 2]; 2], [f64; 2]) {
        let Line { axes, slope, slope_err, .. } = self.line;
        let (mut out, mut e) = ([[0.0; 2]; 2], [0.0_f64; 2]);
        for i in 0..2 {
            let size = slope[i].abs();
            for k in 0..2 {
                let (x, z) = (j[axes[i]][k], j[axes[2]][k]);
                out[i][k] = (-slope[i]).mul_add(z, x);
                let (ex, ez) = (err[axes[i]][k], err[axes[2]][k]);
                let given = size.mul_add(ez, ex) + slope_err[i] * (z.abs() + ez);
                let off = (given + 2.0 * U * size.mul_add(z.abs(), x.abs())) * ROUNDED;
                // An unbounded slope has an infinite error, not NaN.
                e[i] = e[i].max(if off.is_nan() { f64::INFINITY } else { off });
            }
        }
        (out, e)
    }

    /// Whether both functions may vanish in a box of points.
    #[inline(always)]
    fn may_vanish(&self, hull: &[Interval; 3]) -> bool {
        if hull.iter().any(|x| !(x.lo.is_finite() && x.hi.is_finite())) {
            return true;
        }
        let p = hull.map(|x| 0.5 * x.lo + 0.5 * x.hi);
        let half = [0, 1, 2].map(|c: usize| (hull[c].hi - p[c]).max(p[c] - hull[c].lo) * ROUNDED);
        let (f, e) = self.values(&p, &half);
        (0..2).all(|i| f[i].abs() <= e[i])
    }

    /// The data of a piece for Krawczyk's test.
    #[inline(always)]
    pub(super) fn local(&self, piece: &Piece) -> (Local, Limits) {
        let (f, e) = self.values(&piece.p, &piece.p_err);
        let (j, e_j) = self.slopes(&piece.slope, &piece.slope_err);
        (Local { f, j }, Limits { e, e_j, h: [[0.0; 3]; 2] })
    }

    /// A bound on the change of both functions along each parameter of a piece, but for rounding: it only
    /// chooses what is cut.
    pub(super) fn change(&self, piece: &Piece) -> [f64; 2] {
        let Line { axes, slope, .. } = self.line;
        [0, 1].map(|k: usize| {
            let of = |c: usize| (piece.slope[axes[c]][k], piece.slope_err[axes[c]][k]);
            let (z, z_err) = of(2);
            let along = |i: usize| {
                let (x, x_err) = of(i);
                (-slope[i]).mul_add(z, x).abs() + slope[i].abs().mul_add(z_err, x_err)
            };
            along(0).max(along(1))
        })
    }

    /// Whether a piece holds no crossing, at most one (then near a known place), or an unknown
    /// number.
    #[inline(always)]
    pub(super) fn content(&self, piece: &Piece) -> Content {
        if !self.may_vanish(&piece.hull) {
            return Content::Nothing;
        }
        let (local, limits) = self.local(piece);
        // Slopes are bounded on the wide box, so the result holds there.
        limits.content(&local, piece.half(), 1.0)
    }

    /// Searches for the one crossing that a piece may hold, near `start`, which is relative to its
    /// middle, in widths. Returns whether that is decided.
    pub(super) fn meet_at_most_one(&self, piece: &Piece, start: [f64; 2], out: &mut Vec<Found>) -> bool {
        let mut x = [0, 1].map(|k| start[k].mul_add(piece.width[k], piece.middle[k]));
        let mut tries = 0;
        for _ in 0..NEWTON {
            for k in 0..2 {
                x[k] = x[k].max(piece.wide[k][0]).min(piece.wide[k][1]);
            }
            let Some(step) = self.step(piece, x) else { return false };
            x = [0, 1].map(|k| x[k] - step[k]);
            if (0..2).all(|k| step[k].abs() <= NEAR * piece.width[k]) {
                let proven = self.proven(piece, x);
                crate::steps::evaluated(1, proven.is_some());
                if let Some(found) = proven {
                    // If this one is outside the box, another one may be in it.
                    let within = |k: usize| {
                        let ([from, to], [at, off]) = (piece.wide[k], [found.0.uv[k], found.0.radius[k]]);
                        from <= at - off && at + off <= to
                    };
                    if !(within(0) && within(1)) {
                        return false;
                    }
                    if self.belongs(piece, &found) && !self.is_cut_off(&found.1) {
                        out.push(found.0);
                    }
                    return true;
                }
                tries += 1;
                if tries == 2 {
                    return false;
                }
            }
        }
        false
    }

    /// A step of Newton's method.
    #[inline(always)]
    fn step(&self, piece: &Piece, x: [f64; 2]) -> Option<[f64; 2]> {
        crate::steps::evaluated(1, false);
        let jets = self.face.tape.jet(x);
        let p = [0, 1, 2].map(|c: usize| scale2(jets[c].v - self.unit.centre[c], -self.unit.scale));
        let j = [0, 1, 2]
            .map(|c: usize| [0, 1].map(|k: usize| scale2(jets[c].d.d[k], -self.unit.scale) * piece.width[k]));
        let f = self.values(&p, &[0.0; 3]).0;
        let y = inverse(&self.slopes(&j, &[[0.0; 2]; 3]).0)?;
        let step = [0, 1].map(|i: usize| y[i][0].mul_add(f[0], y[i][1] * f[1]) * piece.width[i]);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// A crossing near `x`, with proof, and a box in space that holds it.
    fn proven(&self, piece: &Piece, x: [f64; 2]) -> Option<(Found, [Interval; 3])> {
        let boxes = RADII.map(|r| around(x, piece.width, r));
        let jets = self.face.tape.jets(&lanes(&boxes));
        let (mut p, mut p_err) = ([0.0; 3], [0.0; 3]);
        for c in 0..3 {
            lane_of(&jets[c].v, 0)?;
            (p[c], p_err[c]) = self.unit.place(jets[c].v.lane(0), c);
        }
        let (f, e) = self.values(&p, &p_err);
        for (lane, &r) in RADII.iter().enumerate().skip(1) {
            let (mut j, mut j_err) = ([[0.0; 2]; 3], [[0.0; 2]; 3]);
            for c in 0..3 {
                for k in 0..2 {
                    lane_of(&jets[c].v, lane)?;
                    let (slope, err) = slope_of(&jets[c].d.d[k], lane)?;
                    let by = |x: f64| scale2(x, -self.unit.scale) * piece.width[k];
                    j[c][k] = by(slope);
                    j_err[c][k] = by(err) * ROUNDED + U * by(slope).abs() + f64::MIN_POSITIVE;
                }
            }
            let (rows, e_j) = self.slopes(&j, &j_err);
            let Some(zero) = zero_in(&Local { f, j: rows }, (&e, &e_j), r) else { continue };
            // The crossing's place in space.
            let mut hull = [Interval::ENTIRE; 3];
            for c in 0..3 {
                let (mut at, mut err) = (p[c], p_err[c]);
                for k in 0..2 {
                    at = j[c][k].mul_add(zero.x[k], at);
                    err += j[c][k].abs() * zero.radius[k] + j_err[c][k] * (zero.x[k].abs() + zero.radius[k]);
                    err += U * (at.abs() + (j[c][k] * zero.x[k]).abs());
                }
                hull[c] = Interval::around(at, err * ROUNDED);
            }
            let z_axis = self.line.axes[2];
            let (z, z_err) = self.depth(&hull[z_axis]);
            let (s, s_err) = self.line.along(z, z_err);
            let sign = if self.line.d_z < 0.0 { -zero.sign } else { zero.sign };
            let uv = [0, 1].map(|k: usize| zero.x[k].mul_add(piece.width[k], x[k]));
            let radius = [0, 1].map(|k: usize| (zero.radius[k] * piece.width[k] + U * uv[k].abs()) * ROUNDED);
            let face = piece.face;
            return Some((Found { face, uv, radius, only: piece.wide, s, s_err, sign, turn: sign }, hull));
        }
        None
    }

    /// The third coordinate of a box in space, relative to the line's origin, and its error.
    fn depth(&self, x: &Interval) -> (f64, f64) {
        let middle = 0.5 * x.lo + 0.5 * x.hi;
        let half = (x.hi - middle).max(middle - x.lo);
        let z = middle - self.line.o[2];
        (z, (half + self.line.o_err[2] + U * z.abs()) * ROUNDED)
    }

    /// Whether a crossing may be in a piece's own box, including the slack beyond the domain.
    fn belongs(&self, piece: &Piece, (found, _): &(Found, [Interval; 3])) -> bool {
        (0..2).all(|k| {
            let ([from, to], [first, last]) = (piece.own[k], self.face.domain[k]);
            let room = |is_end: bool| found.radius[k] + if is_end { self.face.slack[k] } else { 0.0 };
            found.uv[k] >= from - room(from == first) && found.uv[k] <= to + room(to == last)
        })
    }

    /// Whether a box in space is certainly cut off.
    pub(super) fn is_cut_off(&self, hull: &[Interval; 3]) -> bool {
        self.cut.are_missed_by(hull)
    }

    /// An unproven crossing: a piece in which rounding hides whether there is one.
    pub(super) fn unresolved(&self, piece: &Piece) -> Found {
        let (z, z_err) = self.depth(&piece.hull[self.line.axes[2]]);
        let (s, s_err) = self.line.along(z, z_err);
        let uv = piece.middle;
        let radius = [0, 1].map(|k: usize| {
            (piece.own[k][1] - uv[k]).max(uv[k] - piece.own[k][0]) * ROUNDED + U * uv[k].abs()
        });
        Found { face: piece.face, uv, radius, only: NOWHERE, s, s_err, sign: 0, turn: self.turn(piece) }
    }

    /// The slopes of both functions at a point, by parameters divided by `width`, rounded.
    pub(super) fn slopes_at(&self, x: [f64; 2], width: [f64; 2]) -> [[f64; 2]; 2] {
        let jets = self.face.tape.jet(x);
        let slope = |c: usize, k: usize| scale2(jets[c].d.d[k], -self.unit.scale) * width[k];
        self.slopes(&[0, 1, 2].map(|c| [0, 1].map(|k| slope(c, k))), &[[0.0; 2]; 3]).0
    }

    /// The sign of `S_u x S_v . d` in a piece, if it is the same at four points of it.
    fn turn(&self, piece: &Piece) -> i8 {
        let signs = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(|at: [f64; 2]| {
            let x = [0, 1].map(|k: usize| at[k].mul_add(piece.width[k], piece.own[k][0]));
            let [a, b] = self.slopes_at(x, piece.width);
            let det = a[0].mul_add(b[1], -(a[1] * b[0])) * self.line.d_z;
            i8::from(det > 0.0) - i8::from(det < 0.0)
        });
        if signs.iter().all(|s| *s == signs[0]) { signs[0] } else { 0 }
    }
}
