//! The part of a line that may meet a cell in which nothing is proven: brackets are no longer than
//! the hull of the cell's control points.
//!
//! A bound on slopes gives a bracket that reaches beyond the patch by the bound's own rounding: far
//! beyond a flat patch that the line passes at a corner, and far along the parameter in which an
//! edge is one point. The hull is shorter. A combination `g` of both functions is zero on the line,
//! and `z` measures along it, so the control points map to points `(g_i, z_i)` of a plane. `g` is
//! the combination along the two control points that are about the farthest apart: then the points
//! of a flat patch spread over that plane. Weights are positive, so all points of the cell are in
//! the convex hull, and a crossing is in the hull's strip `|g| <= e` if the error of every `g_i` is
//! at most `e`. The strip ends where segments between two of the points cross `g = -e` and `g = e`,
//! or at points in it.

use super::exact::Exact;
use super::line::{Found, View};
use super::net::Homogeneous;
use durer_math::U;
use durer_roots::two_unknowns::ROUNDED;

/// An unproven crossing for a box of a cell in which rounding hides whether there is one; `None` if
/// there is certainly none.
#[cold]
#[inline(never)]
pub(super) fn unresolved(
    view: &View<'_>,
    exact: &Exact<'_>,
    (from, width): ([f64; 2], [f64; 2]),
) -> Option<Found> {
    let mut found = view.unresolved(from, width);
    let ends = exact.part(view.cell, from, width).and_then(|net| extent(view, &net));
    ends.is_none_or(|ends| found.is_shortened(ends)).then_some(found)
}

/// Shortens the brackets of unproven crossings of a cell, from index `first` on, to the part of the
/// line that may meet the cell. Removes those that certainly miss it.
#[cold]
#[inline(never)]
pub(super) fn shorten(view: &View<'_>, exact: &Exact<'_>, found: &mut Vec<Found>, first: usize) {
    let cell = view.cell;
    // For a half, use the net of the triangle.
    let half = if cell.is_half { exact.half(cell) } else { None };
    let Some(ends) = extent(view, half.as_deref().unwrap_or(&cell.net)) else { return };
    let mut number = 0;
    found.retain_mut(|f| {
        number += 1;
        number <= first || f.sign != 0 || f.is_shortened(ends)
    });
}

/// The line's parameters between which it may meet the hull of control points with the cell's
/// errors; `None` if they are unknown. If the line certainly misses the hull, the first one is the
/// greater.
fn extent(view: &View<'_>, net: &[Homogeneous<f64>]) -> Option<[f64; 2]> {
    let (mut points, mut e, mut z_err) = (Vec::with_capacity(net.len()), [0.0_f64; 2], 0.0_f64);
    for p in net {
        let (off, z_off) = view.control_errors(p);
        let (f, z) = view.sheared(p);
        points.push((f.map(|f| f / p[3]), z / p[3]));
        e = [0, 1].map(|k| e[k].max(off[k]));
        z_err = z_err.max(z_off);
    }
    let apart = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let far = |d: [f64; 2]| d[0].mul_add(d[0], d[1] * d[1]);
    let farthest = |from: [f64; 2]| {
        points
            .iter()
            .fold(from, |to, &(f, _)| if far(apart(f, from)) > far(apart(to, from)) { f } else { to })
    };
    let one = farthest([0.0; 2]);
    let way = apart(farthest(one), one);
    let length = far(way).sqrt();
    let by = if length > 0.0 { way.map(|d| d / length) } else { [1.0, 0.0] };
    let (mut seen, mut size) = (Vec::with_capacity(points.len()), 0.0_f64);
    for (f, z) in points {
        let terms = [by[0] * f[0], by[1] * f[1]];
        size = size.max(terms[0].abs() + terms[1].abs());
        seen.push((terms[0] + terms[1], z));
    }
    let e = (by[0].abs().mul_add(e[0], by[1].abs() * e[1]) + 4.0 * U * size) * ROUNDED;
    let known = seen.iter().all(|(g, z)| g.is_finite() && z.is_finite()) && (e + z_err).is_finite();
    let [low, high] = strip(&seen, e);
    known.then(|| if low <= high { view.along([low, high], z_err) } else { [low, high] })
}

/// The least and the greatest `z` of the convex hull of points `(g, z)` where `|g| <= e`, rounded
/// outward.
fn strip(points: &[(f64, f64)], e: f64) -> [f64; 2] {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |z: f64, off: f64| ends = [ends[0].min(z - off), ends[1].max(z + off)];
    for &(g, z) in points {
        if g.abs() <= e {
            add(z, 0.0);
        }
        for h in [-e, e] {
            for &(other, far) in if g > h { points } else { &[] } {
                if other < h {
                    // Two differences and a quotient of numbers of one sign, a difference and the sum.
                    let way = far - z;
                    let at = ((g - h) / (g - other)).mul_add(way, z);
                    add(at, 2.0 * U * (2.0 * way.abs() + at.abs()));
                }
            }
        }
    }
    ends
}
