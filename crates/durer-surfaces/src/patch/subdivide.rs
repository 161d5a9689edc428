//! A cell that a ray meets nearly at a tangent, or whose slopes vanish at a collapsed edge: halved
//! until every part is empty, holds one proven crossing, or is as small as the errors.
//!
//! T. Nishita, T. W. Sederberg, M. Kakimoto, "Ray tracing trimmed rational surface patches",
//! *SIGGRAPH* 1990, clip the hull of the control points of `F`; A. Efremov, V. Havran, H.-P.
//! Seidel, "Robust and numerically efficient Bezier clipping", *Spring Conference on Computer
//! Graphics* 2005, list how clipping loses and doubles roots. Here the hull only excludes parts,
//! with its rounding included; the rest is halved or proven by Krawczyk's test. A zero on the
//! border of two parts is recognised later, because each proof holds in a wider box.

use super::cell::{MARGIN, basis, power};
use super::exact::Exact;
use super::line::{Found, View, touches};
use super::strip::{shorten, unresolved};
use core::ops::{Add, Mul, Sub};
use durer_math::{Dd, Isa, U};
use durer_roots::two_unknowns::{Content, Limits, Local, ROUNDED, Zero, inverse};

/// The most parts of a cell that are examined for one ray; the rest stays unresolved. A tangent
/// needs a few hundred.
const MOST_STEPS: usize = 4096;
/// A part on which all values are within this many errors of zero is not halved further.
const NOISE: f64 = 8.0;
/// The least width of a part, in parameters of its cell.
const LEAST: f64 = durer_math::scale::pow2(-48);

/// The most parts of a cell that are examined in double-double for one ray.
const MOST_DOUBLE: usize = 64;
/// A touch leaves at most as many parts open as meet in one point, twice. If there are more, a
/// curve of the patch lies on the ray, such as a collapsed edge, and double-double does not help.
const MOST_OPEN: usize = 8;

/// The arithmetic of control values: f64, and double-double where f64 does not decide.
trait Word: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {
    /// A bound on the relative error of a sum and of a product.
    const UNIT: f64;

    fn value(self) -> f64;
}

impl Word for f64 {
    const UNIT: f64 = U;

    fn value(self) -> f64 {
        self
    }
}

/// M. Joldes, J.-M. Muller, V. Popescu (see [`Dd`]): 3 U² for a sum, 2 U² for a product with an f64.
impl Word for Dd {
    const UNIT: f64 = 4.0 * U * U;

    fn value(self) -> f64 {
        self.to_f64()
    }
}

/// A part of a cell: the control values of `F`, with errors of at most `e`.
struct Part<T> {
    f: Vec<[T; 2]>,
    e: [f64; 2],
    from: [f64; 2],
    width: [f64; 2],
}

/// The least and the greatest control value of a combination of both functions.
#[inline(always)]
fn range<T: Word>(f: &[[T; 2]], [a, b]: [f64; 2]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for [x, y] in f {
        let value = (*x * a + *y * b).value();
        (low, high) = (low.min(value), high.max(value));
    }
    (low, high)
}

/// Whether a combination of the functions has certainly no zero in the hull of control values with
/// errors of at most `e`.
#[inline(always)]
fn is_clear_of<T: Word>(f: &[[T; 2]], e: [f64; 2], by: [f64; 2]) -> bool {
    let (low, high) = range(f, by);
    let terms = |[x, y]: &[T; 2]| (by[0] * x.value()).abs() + (by[1] * y.value()).abs();
    let largest = f.iter().map(terms).fold(0.0, f64::max);
    let e = (by[0].abs() * e[0] + by[1].abs() * e[1]) * ROUNDED + 4.0 * T::UNIT * largest;
    low.abs().max(high.abs()) > 0.0 && (low > e || high < -e)
}

impl<T: Word> Part<T> {
    /// Whether a combination of the functions has certainly no zero in the part.
    #[inline(always)]
    fn is_clear_of(&self, by: [f64; 2]) -> bool {
        is_clear_of(&self.f, self.e, by)
    }

    /// The value and slopes in the middle and bounds on second derivatives, by the part's own
    /// parameters from 0 to 1.
    #[inline(always)]
    fn local(&self, [nu, nv]: [usize; 2]) -> (Local, Limits) {
        let ((bu, du), (bv, dv)) = (basis(nu, 0.5), basis(nv, 0.5));
        let mut local = Local { f: [0.0; 2], j: [[0.0; 2]; 2] };
        let (degree_u, degree_v) = ((nu - 1) as f64, (nv - 1) as f64);
        let wide = power(1.0 + 2.0 * MARGIN, nu + nv - 2);
        let mut limits = Limits { e: [0.0; 2], e_j: [0.0; 2], h: [[0.0; 3]; 2] };
        for i in 0..2 {
            let mut most = 0.0_f64;
            let mut h = [0.0_f64; 3];
            let mut sums: Option<[T; 3]> = None;
            for (v, row) in self.f.chunks_exact(nu).enumerate() {
                for u in 0..nu {
                    let f = row[u][i];
                    most = most.max(f.value().abs());
                    let terms = [f * (bu[u] * bv[v]), f * (du[u] * bv[v]), f * (bu[u] * dv[v])];
                    sums = Some(sums.map_or(terms, |s| [0, 1, 2].map(|k| s[k] + terms[k])));
                    let at = |a: usize, b: usize| self.f[(v + b) * nu + u + a][i];
                    if u + 2 < nu {
                        h[0] = h[0].max(((at(2, 0) - at(1, 0)) - (at(1, 0) - f)).value().abs());
                    }
                    if u + 1 < nu && v + 1 < nv {
                        h[1] = h[1].max(((at(1, 1) - at(1, 0)) - (at(0, 1) - f)).value().abs());
                    }
                    if v + 2 < nv {
                        h[2] = h[2].max(((at(0, 2) - at(0, 1)) - (at(0, 1) - f)).value().abs());
                    }
                }
            }
            if let Some([f, a, b]) = sums {
                (local.f[i], local.j[i]) = (f.value(), [a.value(), b.value()]);
            }
            // Control values have the error `e`, second differences four times that and their
            // roundings.
            let slack = 4.0 * self.e[i] + 8.0 * T::UNIT * most;
            let factors = [degree_u * (degree_u - 1.0), degree_u * degree_v, degree_v * (degree_v - 1.0)];
            for k in 0..3 {
                limits.h[i][k] =
                    if factors[k] > 0.0 { factors[k] * (h[k] + slack) * wide * ROUNDED } else { 0.0 };
            }
            // In the middle the Bernstein polynomials are exact; one sum of all terms rounds.
            limits.e[i] = ((nu * nv + 2) as f64).mul_add(T::UNIT * most, self.e[i]) * ROUNDED;
            let steepest = local.j[i][0].abs().max(local.j[i][1].abs());
            limits.e_j[i] = 2.0 * degree_u.max(degree_v) * limits.e[i] + U * steepest;
        }
        (local, limits)
    }

    /// Whether it is too small to be halved, or a combination of the functions is within rounding
    /// of zero on all of it.
    #[inline(always)]
    fn is_noise(&self, by: [f64; 2]) -> bool {
        let (low, high) = range(&self.f, by);
        let e = by[0].abs() * self.e[0] + by[1].abs() * self.e[1];
        self.width[0].max(self.width[1]) < LEAST || low.abs().max(high.abs()) <= NOISE * e
    }

    /// The point of the net at `x`, by de Casteljau's algorithm, and its slopes.
    fn at(&self, nu: usize, [x, y]: [f64; 2]) -> Local {
        let nv = self.f.len() / nu;
        let ((bu, du), (bv, dv)) = (basis(nu, x), basis(nv, y));
        let mut local = Local { f: [0.0; 2], j: [[0.0; 2]; 2] };
        let mut column = Vec::with_capacity(nv);
        for (v, row) in self.f.chunks_exact(nu).enumerate() {
            for (u, f) in row.iter().enumerate() {
                for i in 0..2 {
                    let f = f[i].value();
                    local.j[i][0] += f * (du[u] * bv[v]);
                    local.j[i][1] += f * (bu[u] * dv[v]);
                }
            }
            column.push(reduced(row, x));
        }
        local.f = reduced(&column, y).map(T::value);
        local
    }

    /// Both halves along a parameter.
    #[inline(always)]
    fn halves(&self, nu: usize, along: usize) -> [Self; 2] {
        let nv = self.f.len() / nu;
        let (n, step, lines, next) = if along == 0 { (nu, 1, nv, nu) } else { (nv, nu, nu, 1) };
        let (mut low, mut high) = (self.f.clone(), self.f.clone());
        for line in 0..lines {
            let at = |k: usize| line * next + k * step;
            // De Casteljau: `high` holds one level after the other.
            for level in 1..n {
                for k in 0..n - level {
                    let (a, b) = (high[at(k)], high[at(k + 1)]);
                    high[at(k)] = [(a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5];
                }
                low[at(level)] = high[at(0)];
            }
        }
        let mut e = self.e;
        for (i, e) in e.iter_mut().enumerate() {
            let most = self.f.iter().fold(0.0, |m: f64, f| m.max(f[i].value().abs()));
            *e = (n as f64).mul_add(T::UNIT * most, *e) * ROUNDED;
        }
        let mut width = self.width;
        width[along] *= 0.5;
        let mut from = self.from;
        from[along] += width[along];
        [Self { f: low, e, from: self.from, width }, Self { f: high, e, from, width }]
    }
}

/// The point of a curve.
fn reduced<T: Word>(curve: &[[T; 2]], t: f64) -> [T; 2] {
    let mut now = curve.to_vec();
    for level in (1..now.len()).rev() {
        for k in 0..level {
            now[k] = [0, 1].map(|c| now[k][c] + (now[k + 1][c] - now[k][c]) * t);
        }
    }
    now[0]
}

/// Appends the crossings of a line and a part of a cell, in double-double; `false` if that does not
/// help.
#[cold]
#[inline(never)]
fn in_double(
    view: &View<'_>,
    exact: &Exact<'_>,
    (from, width): ([f64; 2], [f64; 2]),
    out: &mut Vec<Found>,
) -> bool {
    let cell = view.cell;
    let low = [0, 1].map(|k| from[k].mul_add(cell.width[k], cell.from[k]));
    let high = [0, 1].map(|k| (from[k] + width[k]).mul_add(cell.width[k], cell.from[k]));
    let Some((f, e)) = exact.net(cell.face, low, high) else { return false };
    let [nu, nv] = cell.size;
    let mut open = vec![Part { f, e, from, width }];
    let (mut steps, mut left, first) = (0, 0, out.len());
    while let Some(part) = open.pop() {
        if cell.is_half && part.from[0] + part.from[1] >= 1.0 {
            continue;
        }
        if part.is_clear_of([1.0, 0.0]) || part.is_clear_of([0.0, 1.0]) {
            continue;
        }
        let (local, mut limits) = part.local([nu, nv]);
        let [slow, fast] = singular(&local.j);
        if part.is_clear_of(slow) || part.is_clear_of(fast) {
            continue;
        }
        let start = match limits.content(&local, 0.5, 0.5 + MARGIN) {
            Content::Nothing => continue,
            Content::AtMostOne(x) => Some(x),
            Content::Unknown => None,
        };
        if let Some([x, y]) = start {
            // De Casteljau's algorithm rounds three times a level, slopes as an f64.
            let degree = (nu + nv) as f64;
            let wide = power(1.0 + 2.0 * MARGIN, nu + nv - 2);
            for i in 0..2 {
                let most = part.f.iter().fold(0.0, |m: f64, f| m.max(f[i].to_f64().abs()));
                limits.e[i] = (3.0 * degree).mul_add(Dd::UNIT * most, part.e[i]) * wide * ROUNDED;
                limits.e_j[i] = (2.0 * degree).mul_add(limits.e[i], 16.0 * degree * degree * U * most * wide);
            }
            let region = [[-MARGIN, 1.0 + MARGIN]; 2];
            let mut evaluations = 0;
            let zero = limits.zero([0.5 + x, 0.5 + y], (&region, &region), |x| {
                evaluations += 1;
                part.at(nu, x)
            });
            crate::steps::evaluated(evaluations, zero.is_some());
            if let Some(zero) = zero {
                if touches(&zero, [0.0; 2], [1.0; 2]) {
                    let in_cell = |k: usize| zero.x[k].mul_add(part.width[k], part.from[k]);
                    out.extend(view.found(&Zero {
                        x: [in_cell(0), in_cell(1)],
                        radius: [0, 1].map(|k| (zero.radius[k] * part.width[k] + U) * ROUNDED),
                        alone: (zero.alone * part.width[0].min(part.width[1]) - U).max(0.0),
                        sign: zero.sign,
                    }));
                }
                continue;
            }
        }
        steps += 1;
        crate::steps::cut();
        if part.is_noise(slow) || steps > MOST_STEPS {
            left += 1;
            if left > MOST_OPEN {
                out.truncate(first);
                return false;
            }
            out.extend(unresolved(view, exact, (part.from, part.width)));
            continue;
        }
        let along = usize::from(part.change(nu, 1) > part.change(nu, 0));
        let along = if part.width[along] < LEAST { 1 - along } else { along };
        let [low, high] = part.halves(nu, along);
        open.push(high);
        open.push(low);
    }
    if left > 0 && view.turn(from, width) != 0 {
        // The surface does not turn back there, so an open part is no touch, and the sign of the
        // crossing is known better from farther away.
        out.truncate(first);
        return false;
    }
    true
}

/// The combinations of both functions that change most slowly and fastest from the middle: the
/// left singular vectors of the slopes.
#[inline(always)]
fn singular(j: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0].mul_add(b[0], a[1] * b[1]);
    let (p, q, r) = (dot(j[0], j[0]), dot(j[0], j[1]), dot(j[1], j[1]));
    // The direction of the larger eigenvalue of J J'.
    let half = 0.5 * (p - r);
    let root = half.mul_add(half, q * q).sqrt();
    let [a, b] = if half >= 0.0 { [half + root, q] } else { [q, root - half] };
    let length = a.mul_add(a, b * b).sqrt();
    if length > 0.0 && length.is_finite() {
        let [a, b] = [a / length, b / length];
        [[-b, a], [a, b]]
    } else {
        [[0.0, 1.0], [1.0, 0.0]]
    }
}

/// Appends the crossings of a line and a cell, and the boxes of the cell in which crossing and miss
/// cannot be distinguished.
#[inline(never)]
pub(super) fn meet(view: &View<'_>, exact: &Exact<'_>, out: &mut Vec<Found>) {
    Isa::detect().run(
        #[inline(always)]
        || meet_here(view, exact, out),
    );
}

#[inline(always)]
fn meet_here(view: &View<'_>, exact: &Exact<'_>, out: &mut Vec<Found>) {
    let cell = view.cell;
    let [nu, nv] = cell.size;
    let f: Vec<[f64; 2]> = cell.net.iter().map(|p| view.sheared(p).0).collect();
    // Most lines that come here cross the surface just beyond the cell. Times the inverse of the slopes,
    // the functions are nearly the distances of both parameters from the crossing, and their control
    // values exclude it.
    let rows = inverse(&view.middle().j);
    if rows.is_some_and(|rows| rows.into_iter().any(|row| is_clear_of(&f, view.e_control, row))) {
        return;
    }
    let mut open = vec![Part { f, e: view.e_control, from: [0.0; 2], width: [1.0; 2] }];
    let (mut steps, mut double, first) = (0, 0, out.len());
    while let Some(part) = open.pop() {
        // Beyond the patch; sums of such fractions are exact.
        if cell.is_half && part.from[0] + part.from[1] >= 1.0 {
            continue;
        }
        if part.is_clear_of([1.0, 0.0]) || part.is_clear_of([0.0, 1.0]) {
            continue;
        }
        let (local, limits) = part.local([nu, nv]);
        let [slow, fast] = singular(&local.j);
        if part.is_clear_of(slow) || part.is_clear_of(fast) {
            continue;
        }
        let start = match limits.content(&local, 0.5, 0.5 + MARGIN) {
            Content::Nothing => continue,
            Content::AtMostOne(x) => Some(x),
            Content::Unknown => None,
        };
        if inverse(&local.j).is_some_and(|rows| rows.into_iter().any(|row| part.is_clear_of(row))) {
            continue;
        }
        if let Some([x, y]) = start {
            let at = [0.5 + x, 0.5 + y];
            let [w, h] = part.width;
            let x = [f64::mul_add(at[0], w, part.from[0]), f64::mul_add(at[1], h, part.from[1])];
            // The limits of the part by the cell's parameters; they hold in the part's own margin.
            let mut own = view.limits;
            for i in 0..2 {
                let [a, b] = part.width;
                let by = [a * a, a * b, b * b];
                for k in 0..3 {
                    own.h[i][k] = own.h[i][k].min(limits.h[i][k] / by[k] * ROUNDED);
                }
            }
            let region = [0, 1].map(|k| {
                let beyond = MARGIN * part.width[k];
                [part.from[k] - beyond, part.from[k] + part.width[k] + beyond]
            });
            if let Some(zero) = view.zero(x, &own, &region) {
                if touches(&zero, part.from, part.width) {
                    out.extend(view.found(&zero));
                }
                continue;
            }
        }
        steps += 1;
        crate::steps::cut();
        if part.is_noise(slow) || steps > MOST_STEPS {
            double += 1;
            let place = (part.from, part.width);
            if double > MOST_DOUBLE {
                out.push(view.unresolved(part.from, part.width));
            } else if !in_double(view, exact, place, out) {
                out.extend(unresolved(view, exact, place));
            }
            continue;
        }
        let along = usize::from(part.change(nu, 1) > part.change(nu, 0));
        let along = if part.width[along] < LEAST { 1 - along } else { along };
        let [low, high] = part.halves(nu, along);
        open.push(high);
        open.push(low);
    }
    if out[first..].iter().any(|f| f.sign == 0) {
        shorten(view, exact, out, first);
    }
}

impl<T: Word> Part<T> {
    /// By how much the functions change along a parameter.
    #[inline(always)]
    fn change(&self, nu: usize, along: usize) -> f64 {
        let nv = self.f.len() / nu;
        let mut most = 0.0_f64;
        for v in 0..nv {
            for u in 0..nu {
                let (a, b) = if along == 0 { (u, 0) } else { (0, v) };
                let first = if along == 0 { v * nu } else { u };
                if a + b > 0 {
                    let (p, q) = (self.f[v * nu + u], self.f[first]);
                    most = most.max((p[0] - q[0]).value().abs()).max((p[1] - q[1]).value().abs());
                }
            }
        }
        most
    }
}
