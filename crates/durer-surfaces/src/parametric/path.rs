//! Paths of sweeps and their frames.
//!
//! A path is a row of spans, each a Bezier curve of points and sizes. Its frame is carried from knot
//! to knot by double reflection: W. Wang, B. Juttler, D. Zheng, Y. Liu, "Computation of rotation
//! minimizing frames", *ACM Transactions on Graphics* 27:1 (2008) 2.

use super::sweep::SweepError;
use durer_math::Vec3;
use durer_math::elementary::atan2;
use durer_math::scale::pow2;

/// Tangents of two spans that differ by less than this at their knot are one: that is rounding.
const SMOOTH: f64 = pow2(-48);

/// How points define a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathSpline {
    /// Straight from one point to the next.
    Linear,
    /// Cubics through all points but the first and the last, with the slopes `(p_i+1 - p_i-1) / 2`.
    Cubic,
    /// Uniform cubic B-splines.
    BSpline,
    /// Four control points for each span; a span begins where the one before it ends.
    Bezier,
}

impl PathSpline {
    /// The spline's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear_spline",
            Self::Cubic => "cubic_spline",
            Self::BSpline => "b_spline",
            Self::Bezier => "bezier_spline",
        }
    }

    /// The least number of points.
    pub fn least(self) -> usize {
        if self == Self::Linear { 2 } else { 4 }
    }

    /// The control points of the spans: position and size each.
    pub(super) fn spans(self, points: &[[f64; 4]]) -> Vec<[[f64; 4]; 4]> {
        let mix = |parts: &[(f64, &[f64; 4])], over: f64| {
            [0, 1, 2, 3].map(|k: usize| parts.iter().map(|(w, p)| w * p[k]).sum::<f64>() / over)
        };
        let toward = |p: &[f64; 4], a: &[f64; 4], b: &[f64; 4], part: f64| {
            [0, 1, 2, 3].map(|k: usize| p[k] + (b[k] - a[k]) * part)
        };
        match self {
            Self::Linear => points
                .windows(2)
                .map(|p| {
                    [
                        p[0],
                        toward(&p[0], &p[0], &p[1], 1.0 / 3.0),
                        toward(&p[1], &p[1], &p[0], 1.0 / 3.0),
                        p[1],
                    ]
                })
                .collect(),
            Self::Cubic => points
                .windows(4)
                .map(|p| {
                    [
                        p[1],
                        toward(&p[1], &p[0], &p[2], 1.0 / 6.0),
                        toward(&p[2], &p[3], &p[1], 1.0 / 6.0),
                        p[2],
                    ]
                })
                .collect(),
            Self::BSpline => points
                .windows(4)
                .map(|p| {
                    let knot = |a, b, c| mix(&[(1.0, a), (4.0, b), (1.0, c)], 6.0);
                    let third = |a, b| mix(&[(2.0, a), (1.0, b)], 3.0);
                    [
                        knot(&p[0], &p[1], &p[2]),
                        third(&p[1], &p[2]),
                        third(&p[2], &p[1]),
                        knot(&p[1], &p[2], &p[3]),
                    ]
                })
                .collect(),
            Self::Bezier => points.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
        }
    }
}

/// A part of a path between two knots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Control points of position and size.
    pub(super) points: [[f64; 4]; 4],
    /// The unit tangent and the frame's first axis at the beginning.
    pub(super) t: Vec3,
    pub(super) x: Vec3,
    /// The rest of the turn to the next knot's frame.
    pub(super) turn: f64,
    /// The normals of the planes in which a straight span begins and ends.
    pub(super) mitres: [Vec3; 2],
}

fn place(p: &[f64; 4]) -> Vec3 {
    Vec3::new(p[0], p[1], p[2])
}

/// The unit vector along `v`; `None` if there is none.
pub(super) fn direction(v: Vec3) -> Option<Vec3> {
    let largest = v.max_abs();
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let v = v / largest;
    Some(v / v.length())
}

/// The unit tangent at the beginning of a span, or at its end.
fn tangent(points: &[[f64; 4]; 4], at_end: bool) -> Option<Vec3> {
    let [a, b, c, d] = points.each_ref().map(place);
    direction(if at_end { d - c } else { b - a })
}

/// The part of `v` at right angles to the unit vector `t`, of length 1.
fn across(v: Vec3, t: Vec3) -> Option<Vec3> {
    direction(v - t * v.dot(t))
}

/// `x`, which is across the unit vector `from`, after the smallest rotation of `from` onto `to`.
fn rotated(x: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let sum = from + to;
    x - sum * (x.dot(to) / (1.0 + from.dot(to)))
}

/// The spans of a path with their frames.
pub(super) fn framed(
    spline: PathSpline,
    points: &[[f64; 4]],
    up: Option<Vec3>,
) -> Result<Vec<Span>, SweepError> {
    let spans = spline.spans(points);
    let mut tangents = Vec::with_capacity(spans.len());
    for (k, span) in spans.iter().enumerate() {
        let at = |at_end: bool| tangent(span, at_end).ok_or(SweepError::Tangent(k + usize::from(at_end)));
        tangents.push([at(false)?, at(true)?]);
    }
    for k in 1..spans.len() {
        let (before, after) = (tangents[k - 1][1], tangents[k][0]);
        if spans[k - 1][3] != spans[k][0] {
            return Err(SweepError::Gap(k));
        }
        if before.dot(after) < pow2(-20) - 1.0 {
            return Err(SweepError::Reversal(k));
        }
        if spline != PathSpline::Linear && (after - before).max_abs() > SMOOTH {
            return Err(SweepError::Corner(k));
        }
    }
    let first = tangents[0][0];
    let mut x = match up {
        Some(up) => direction(up.cross(first)).ok_or(SweepError::Up(0))?,
        None if first.z < -1.0 + pow2(-40) => Vec3::X,
        None => rotated(Vec3::X, Vec3::Z, first),
    };
    let mut out = Vec::with_capacity(spans.len());
    for (k, span) in spans.iter().enumerate() {
        let [t, end] = tangents[k];
        let x_here = across(x, t).ok_or(SweepError::Tangent(k))?;
        let is_straight = spline == PathSpline::Linear;
        let (next, turn) = if is_straight {
            (x_here, 0.0)
        } else if let Some(up) = up {
            (direction(up.cross(end)).ok_or(SweepError::Up(k + 1))?, 0.0)
        } else {
            let next = reflected(x_here, t, end, place(&span[3]) - place(&span[0]));
            let next = across(next, end).ok_or(SweepError::Tangent(k + 1))?;
            let straight = rotated(x_here, t, end);
            let turn = atan2(straight.cross(next).dot(end), straight.dot(next));
            (next, turn)
        };
        let mitre = |a: Vec3, b: Vec3| direction(a + b).ok_or(SweepError::Reversal(k));
        let before = if k > 0 { tangents[k - 1][1] } else { t };
        let after = tangents.get(k + 1).map_or(end, |next| next[0]);
        let mitres = [mitre(before, t)?, mitre(end, after)?];
        out.push(Span { points: *span, t, x: x_here, turn, mitres });
        // At a corner the frame turns with the tangent, so that both sides meet in its plane.
        x = rotated(next, end, after);
    }
    Ok(out)
}

/// The axis `x` at the end of a chord, by double reflection.
fn reflected(x: Vec3, t: Vec3, end: Vec3, chord: Vec3) -> Vec3 {
    let mirror = |v: Vec3, n: Vec3| {
        let size = n.dot(n);
        if size > 0.0 { v - n * (2.0 * n.dot(v) / size) } else { v }
    };
    let chord = direction(chord).unwrap_or(Vec3::ZERO);
    let (x, t) = (mirror(x, chord), mirror(t, chord));
    mirror(x, end - t)
}
