//! A ray and a cell: the ray is sheared onto an axis, so that a crossing is a zero of two functions
//! of two unknowns (S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", *Journal of
//! Computer Graphics Techniques* 2:1 (2013) 65-82).
//!
//! ```text
//!   F = (X - k_x Z,  Y - k_y Z),   (X, Y, Z) = w (S(u, v) - o),   k_x = d_x / d_z,  |d_z| the largest
//! ```
//!
//! `X`, `Y`, `Z` are polynomials even where `S` is rational. The errors of `F` include those of the
//! ray and every rounding (see [`View::new`]). So a cell is left out only if no ray within these
//! errors meets it, and neighbours need not agree on any rounding.

use super::cell::{Cell, EDGE, MARGIN};
use super::exact::Exact;
use super::net::Homogeneous;
use super::subdivide;
use crate::CentredRay;
use crate::degree::Place;
use crate::steps;
use durer_math::U;
use durer_math::eft::two_diff;
use durer_roots::two_unknowns::{Content, Limits, Local, ROUNDED, Zero};

/// The parameters on which a cell's own limits hold.
const MARGINS: [[f64; 2]; 2] = [[-MARGIN, 1.0 + MARGIN]; 2];

/// A ray whose largest component of direction is the third.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) axes: [usize; 3],
    pub(crate) o: [f64; 3],
    pub(crate) o_err: [f64; 3],
    pub(crate) d_z: f64,
    d_z_err: f64,
    pub(crate) slope: [f64; 2],
    pub(crate) slope_err: [f64; 2],
}

impl Line {
    #[inline(always)]
    pub(crate) fn new(at: &CentredRay<'_>) -> Self {
        let d = at.d.abs();
        // An even permutation: it keeps the sign of determinants.
        let axes = if d.x > d.y && d.x > d.z {
            [1, 2, 0]
        } else if d.y > d.z {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let [o, o_err, d, d_err] = [at.o, at.o_err, at.d, at.d_err].map(|v| axes.map(|axis| v[axis]));
        let slope = [d[0] / d[2], d[1] / d[2]];
        // |d_z| is at least 1. If its error is larger, the quotients get infinite errors.
        let known = (d[2].abs() - d_err[2]).max(0.0);
        let mut slope_err = [0.0; 2];
        for i in 0..2 {
            let size = slope[i].abs();
            slope_err[i] = (size.mul_add(d_err[2], d_err[i]) / known + U * size) * ROUNDED;
        }
        Self { axes, o, o_err, d_z: d[2], d_z_err: d_err[2], slope, slope_err }
    }

    /// The parameter at which the third coordinate relative to the origin is `z`, and a bound on
    /// its error; `z` is known within `z_err`.
    #[inline(always)]
    pub(crate) fn along(&self, z: f64, z_err: f64) -> (f64, f64) {
        let s = z / self.d_z;
        let known = (self.d_z.abs() - self.d_z_err).max(0.0);
        let err = (s.abs().mul_add(self.d_z_err, z_err) / known + U * s.abs()) * ROUNDED;
        (s, err)
    }
}

/// The values of `F` over points that are close together, relative to one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// The least and the greatest value of each function, and bounds on their errors.
    pub(super) f: [[f64; 2]; 2],
    pub(super) e: [f64; 2],
    /// The line's parameters between which the points are, errors included.
    pub(super) s: [f64; 2],
    /// The line's parameters between the two parallel planes that enclose all points; `None` if
    /// `turn` is 0 or the line is nearly parallel to these planes.
    pub(super) plane: Option<[f64; 2]>,
    /// The sign of `S_u x S_v . d` at the corners of the face, 0 if it differs.
    pub(super) turn: i8,
}

impl Sight {
    /// Whether the line provably misses the convex hull of the points.
    #[inline(always)]
    pub(super) fn is_clear(&self) -> bool {
        (0..2).any(|i| self.f[i][0] > self.e[i] || self.f[i][1] < -self.e[i])
    }
}

/// The least and the greatest value of both functions over some points, bounds on their errors, and
/// the numbers they are computed from.
struct Spread {
    f: [[f64; 2]; 2],
    e: [f64; 2],
    /// The range of the third coordinates relative to the origin, and a bound on their errors.
    z: [f64; 2],
    z_err: f64,
    /// The origin relative to the base, and a bound on its error.
    o: [f64; 3],
    o_err: [f64; 3],
    /// The error of a point.
    e_net: f64,
}

impl Line {
    #[inline(always)]
    fn spread(&self, base: [f64; 3], points: &[[f64; 3]], e_points: f64) -> Spread {
        let (mut o, mut o_err) = ([0.0; 3], [0.0; 3]);
        for k in 0..3 {
            let (near, lost) = two_diff(self.o[k], base[self.axes[k]]);
            (o[k], o_err[k]) = (near, (self.o_err[k] + lost.abs()) * ROUNDED);
        }
        let reach = points.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let e_net = (U * reach + e_points) * ROUNDED;
        let size = |k: usize| o[k].abs() + reach;
        let z_size = size(2);
        let mut f = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut zs = [f64::INFINITY, f64::NEG_INFINITY];
        let mut e = [0.0; 2];
        for p in points {
            let z = p[self.axes[2]] - o[2];
            zs = [zs[0].min(z), zs[1].max(z)];
            for i in 0..2 {
                let x = (-self.slope[i]).mul_add(z, p[self.axes[i]] - o[i]);
                f[i] = [f[i][0].min(x), f[i][1].max(x)];
            }
        }
        for i in 0..2 {
            let slope = self.slope[i].abs();
            let given = slope.mul_add(o_err[2], o_err[i]) + self.slope_err[i] * z_size;
            let rounding = U * (2.0 * size(i) + 2.0 * slope * z_size);
            e[i] = (e_net.mul_add(1.0 + slope, given) + rounding) * ROUNDED;
        }
        Spread { f, e, z: zs, z_err: e_net + o_err[2] + U * z_size, o, o_err, e_net }
    }

    /// Whether the line provably misses the convex hull of points relative to `base`. Each point is
    /// rounded, and has an error of at most `e_points` before that.
    #[inline(always)]
    pub(super) fn misses(&self, base: [f64; 3], points: &[[f64; 3]], e_points: f64) -> bool {
        let Spread { f, e, .. } = self.spread(base, points, e_points);
        (0..2).any(|i| f[i][0] > e[i] || f[i][1] < -e[i])
    }

    /// The values over points relative to `base`, with errors as in [`Line::misses`]; the first
    /// `corners` points (three or four) are the corners of a face.
    #[inline(always)]
    pub(super) fn sight(&self, base: [f64; 3], points: &[[f64; 3]], corners: usize, e_points: f64) -> Sight {
        let Spread { f, e, z: zs, z_err, o, o_err, e_net } = self.spread(base, points, e_points);
        let known = (self.d_z.abs() - self.d_z_err).max(0.0);
        let along = |z: f64, z_err: f64| {
            let s = z / self.d_z;
            (s, (s.abs().mul_add(self.d_z_err, z_err) / known + 2.0 * U * s.abs()) * ROUNDED)
        };
        let ends = zs.map(|z| along(z, z_err));
        let s = [
            (ends[0].0 - ends[0].1).min(ends[1].0 - ends[1].1),
            (ends[0].0 + ends[0].1).max(ends[1].0 + ends[1].1),
        ];
        // Signed areas of the corners, in differences of points: the line's place does not matter.
        let flat = |p: &[f64; 3]| {
            let z = p[self.axes[2]];
            [0, 1].map(|i| (-self.slope[i]).mul_add(z, p[self.axes[i]]))
        };
        let mut turns = [0_i8; 4];
        for k in 0..corners {
            let [a, b, c] = [(k + corners - 1) % corners, k, (k + 1) % corners].map(|i| flat(&points[i]));
            let det = (c[0] - b[0]) * (a[1] - b[1]) - (c[1] - b[1]) * (a[0] - b[0]);
            let det = det * self.d_z;
            turns[k] = i8::from(det > 0.0) - i8::from(det < 0.0);
        }
        let turn = if turns[..corners].iter().all(|t| *t == turns[0]) { turns[0] } else { 0 };
        let plane = if turn == 0 { None } else { self.plane(points, corners, (o, o_err), e_net) };
        Sight { f, e, s, plane, turn }
    }

    /// The line's parameters between two parallel planes that enclose all points. The planes are
    /// parallel to both diagonals of four corners, or to the plane of three.
    #[inline(always)]
    fn plane(
        &self,
        points: &[[f64; 3]],
        corners: usize,
        (o, o_err): ([f64; 3], [f64; 3]),
        e_net: f64,
    ) -> Option<[f64; 2]> {
        let turned = |p: &[f64; 3]| self.axes.map(|axis| p[axis]);
        let less = |i: usize, k: usize| {
            let (p, q) = (turned(&points[i]), turned(&points[k]));
            [0, 1, 2].map(|k| p[k] - q[k])
        };
        let (p, q) = if corners == 3 { (less(1, 0), less(2, 0)) } else { (less(2, 0), less(3, 1)) };
        let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        let most = n.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let n = n.map(|x| x / most);
        let dot = |a: &[f64; 3]| (n[0] * a[0], n[1] * a[1], n[2] * a[2]);
        let sum = |(x, y, z): (f64, f64, f64)| (x + y + z, (x.abs() + y.abs() + z.abs()) * (4.0 * U));
        let mut h = [f64::INFINITY, f64::NEG_INFINITY];
        for point in points {
            let (height, err) = sum(dot(&turned(point)));
            h = [h[0].min(height - err), h[1].max(height + err)];
        }
        let (start, start_err) = sum(dot(&o));
        let err = start_err + n.iter().zip(o_err).map(|(n, e)| n.abs() * (e + e_net)).sum::<f64>();
        // The direction is d_z times (slopes, 1).
        let (speed, speed_err) = sum(dot(&[self.slope[0], self.slope[1], 1.0]));
        let speed_err = speed_err + n[0].abs() * self.slope_err[0] + n[1].abs() * self.slope_err[1];
        let known = speed.abs() - speed_err;
        if known.is_nan() || known <= 1.0 / 1024.0 {
            return None;
        }
        let z = h.map(|h| (h - start) / speed);
        let off = |z: f64| ((err + z.abs() * speed_err) / known + 4.0 * U * z.abs()) * ROUNDED;
        let along = |z: f64, z_err: f64| {
            let (s, known) = (z / self.d_z, (self.d_z.abs() - self.d_z_err).max(0.0));
            (s, (s.abs().mul_add(self.d_z_err, z_err) / known + 2.0 * U * s.abs()) * ROUNDED)
        };
        let ends = z.map(|z| along(z, off(z)));
        let low = (ends[0].0 - ends[0].1).min(ends[1].0 - ends[1].1);
        let high = (ends[0].0 + ends[0].1).max(ends[1].0 + ends[1].1);
        (low <= high).then_some([low, high])
    }
}

/// A line relative to a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) cell: &'a Cell,
    pub(super) rational: bool,
    /// Whether the surface has a border. Where it has, `turn` takes folds beside a box into account.
    pub(super) is_open: bool,
    line: &'a Line,
    /// The origin relative to the cell's base, and bounds on its error.
    o: [f64; 3],
    o_err: [f64; 3],
    /// In the cell's parameters from 0 to 1.
    pub(super) limits: Limits,
    /// Bounds on the errors of control points: the errors without those of an evaluation.
    pub(super) e_control: [f64; 2],
}

/// A proven or possible crossing of a line and a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) face: u32,
    /// The parameters in the patch, and bounds on their errors.
    pub(super) uv: [f64; 2],
    pub(super) radius: [f64; 2],
    /// No other crossing is within this distance; 0 if nothing is proven.
    pub(super) alone: [f64; 2],
    pub(super) s: f64,
    pub(super) s_err: f64,
    /// The sign of `S_u x S_v . d`; 0 if nothing is proven.
    pub(super) sign: i8,
    /// If nothing is proven: the sum of the signs of what is there, or, if that is unknown, that sign
    /// at some points nearby, 0 if they differ.
    pub(super) turn: i8,
    /// Whether it may be on a trim.
    pub(super) on_trim: bool,
    /// Whether it stands for crossings with several faces.
    pub(super) is_shared: bool,
    /// Whether the line certainly meets the surface of the patch there, perhaps beyond an edge or a
    /// trim, in the direction of `turn`.
    pub(super) is_zero: bool,
}

impl Found {
    pub(super) fn place(&self) -> Place {
        let &Self { face, uv, radius, s, s_err, sign, .. } = self;
        Place { face, uv, radius, s, s_err, sign }
    }

    /// Unites one crossing that was found on two patches. The result is the one that is certainly
    /// within its patch; if both may be beyond an edge, its bracket holds both.
    pub(super) fn united(&self, other: &Self, is_on_edge: impl Fn(&Self) -> bool) -> Self {
        match (is_on_edge(self), is_on_edge(other)) {
            (false, true) => *self,
            (true, false) => *other,
            (false, false) => *if other.s_err < self.s_err { other } else { self },
            (true, true) => Self { sign: self.sign, alone: self.alone, ..self.joined(other) },
        }
    }

    /// An unproven crossing whose box holds both boxes.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let (a, b, mut out, wider) = (self, other, *self, 1.0 + 4.0 * U);
        // Parameters of different patches do not mix.
        for k in 0..if a.face == b.face { 2 } else { 0 } {
            let low = (a.uv[k] - a.radius[k]).min(b.uv[k] - b.radius[k]);
            let high = (a.uv[k] + a.radius[k]).max(b.uv[k] + b.radius[k]);
            (out.uv[k], out.radius[k]) = (0.5 * (low + high), 0.5 * (high - low) * wider + U);
        }
        let (low, high) = ((a.s - a.s_err).min(b.s - b.s_err), (a.s + a.s_err).max(b.s + b.s_err));
        (out.s, out.s_err) = (0.5 * (low + high), 0.5 * (high - low) * wider + U * (low.abs() + high.abs()));
        (out.sign, out.alone) = (0, [0.0; 2]);
        out.turn = if a.turn == b.turn { a.turn } else { 0 };
        out.on_trim = a.on_trim || b.on_trim;
        out.is_shared = a.is_shared || b.is_shared || a.face != b.face;
        out.is_zero = a.is_zero && b.is_zero && a.turn == b.turn;
        out
    }

    /// Intersects the bracket with another one; `false` if they are disjoint.
    pub(super) fn is_shortened(&mut self, [low, high]: [f64; 2]) -> bool {
        let (low, high) = (low.max(self.s - self.s_err), high.min(self.s + self.s_err));
        if low > high {
            return false;
        }
        let (s, half) = (0.5 * (low + high), 0.5 * (high - low));
        (self.s, self.s_err) = (s, half * (1.0 + 4.0 * U) + U * s.abs());
        true
    }

    /// Whether it may be in the triangle `u + v <= 1`.
    #[inline(always)]
    fn reaches_triangle(&self) -> bool {
        self.uv[0] + self.uv[1] <= 1.0 + (self.radius[0] + self.radius[1] + U)
    }
}

impl<'a> View<'a> {
    /// Computes the error bounds. With `X = x - o_x W`, `Z = z - o_z W` and `f = X - k Z`,
    ///
    /// * control points have the error `e_net`, the origin has `o_err` and the rounding of
    ///   `o - base`;
    /// * `k` has the error `slope_err`, which is multiplied by `|Z|`;
    /// * `X`, `Z` and `f` round once each, by `U` of their size, and an evaluation has the error
    ///   `e_point`.
    #[inline(always)]
    pub(super) fn new(line: &'a Line, cell: &'a Cell, rational: bool) -> Self {
        let (mut o, mut o_err) = ([0.0; 3], [0.0; 3]);
        for k in 0..3 {
            let (near, lost) = two_diff(line.o[k], cell.base[line.axes[k]]);
            (o[k], o_err[k]) = (near, (line.o_err[k] + lost.abs()) * ROUNDED);
        }
        let [heaviest, _] = cell.weights;
        // The ratio of a weight's error to a coordinate's.
        let weight_err = if rational { heaviest / cell.reach.max(f64::MIN_POSITIVE) } else { 0.0 };
        let mut view = Self {
            cell,
            rational,
            is_open: false,
            line,
            o,
            o_err,
            limits: Limits { e: [0.0; 2], e_j: [0.0; 2], h: [[0.0; 3]; 2] },
            e_control: [0.0; 2],
        };
        let size = |k: usize| o[k].abs().mul_add(heaviest, cell.reach);
        let times = |k: usize| 1.0 + o[k].abs() * weight_err;
        let z = size(2);
        for i in 0..2 {
            let slope = line.slope[i].abs();
            let both = slope.mul_add(times(2), times(i));
            let given = heaviest * slope.mul_add(o_err[2], o_err[i]) + line.slope_err[i] * z;
            let rounding = U * (2.0 * size(i) + 2.0 * slope * z);
            view.e_control[i] = (cell.e_net.mul_add(both, given) + rounding) * ROUNDED;
            view.limits.e[i] = cell.e_point.mul_add(both, view.e_control[i]) * ROUNDED;
            let steep = |h: &Homogeneous<f64>, k: usize| o[k].abs().mul_add(h[3], h[line.axes[k]]);
            let first = |d: &Homogeneous<f64>| {
                2.0 * U * slope.mul_add(steep(d, 2), steep(d, i))
                    + line.slope_err[i] * steep(d, 2)
                    + d[3] * slope.mul_add(o_err[2], o_err[i])
            };
            let slopes = first(&cell.first[0]).max(first(&cell.first[1]));
            view.limits.e_j[i] = (2.0 * cell.e_slope).mul_add(both, slopes) * ROUNDED;
            for k in 0..3 {
                let h = &cell.second[k];
                view.limits.h[i][k] = slope.mul_add(steep(h, 2), steep(h, i)) * ROUNDED;
            }
        }
        view
    }

    /// Bounds on the errors of a control point's functions and third coordinate, divided by its
    /// weight. Each of its numbers is rounded, and has the cell's errors.
    pub(super) fn control_errors(&self, p: &Homogeneous<f64>) -> ([f64; 2], f64) {
        let (cell, (f, z)) = (self.cell, self.sheared(p));
        let weight_err =
            if self.rational { cell.weights[0] / cell.reach.max(f64::MIN_POSITIVE) } else { 0.0 };
        let rounded = U * p[0].abs().max(p[1].abs()).max(p[2].abs());
        // The weight in the denominator has an error, too.
        let quotient = |x: f64| {
            if self.rational { (weight_err * cell.e_net / p[3] + 3.0 * U) * x.abs() / p[3] } else { 0.0 }
        };
        let e = [0, 1].map(|i| {
            let own = rounded * (1.0 + self.line.slope[i].abs());
            ((self.e_control[i] + own) / p[3] + quotient(f[i])) * ROUNDED
        });
        let z_err = (cell.e_net * (1.0 + self.o[2].abs() * weight_err) + rounded + U * z.abs()) / p[3];
        (e, (z_err + self.o_err[2] + quotient(z)) * ROUNDED)
    }

    /// The line's parameters between which the third coordinate relative to the origin is in a
    /// range whose ends are known within `z_err`.
    pub(super) fn along(&self, z: [f64; 2], z_err: f64) -> [f64; 2] {
        let [a, b] = z.map(|z| self.line.along(z, z_err));
        [(a.0 - a.1).min(b.0 - b.1), (a.0 + a.1).max(b.0 + b.1)]
    }

    /// The functions at a homogeneous point (or of a derivative), and its third coordinate.
    #[inline(always)]
    pub(super) fn sheared(&self, p: &Homogeneous<f64>) -> ([f64; 2], f64) {
        let axes = &self.line.axes;
        let of = |k: usize| (-self.o[k]).mul_add(p[3], p[axes[k]]);
        let (x, y, z) = (of(0), of(1), of(2));
        let [kx, ky] = self.line.slope;
        ([(-kx).mul_add(z, x), (-ky).mul_add(z, y)], z)
    }

    #[inline(always)]
    fn local(&self, [p, pu, pv]: &[Homogeneous<f64>; 3]) -> Local {
        let (f, a, b) = (self.sheared(p).0, self.sheared(pu).0, self.sheared(pv).0);
        Local { f, j: [[a[0], b[0]], [a[1], b[1]]] }
    }

    /// The functions and their slopes in the middle of the cell.
    #[inline(always)]
    pub(super) fn middle(&self) -> Local {
        self.local(&self.cell.middle)
    }

    /// Appends the crossings of the line and the cell, also those within `room` beyond its edges.
    #[inline(always)]
    pub(super) fn meet(&self, exact: &Exact<'_>, out: &mut Vec<Found>, room: f64) {
        match self.limits.content(&self.middle(), 0.5, 0.5 + MARGIN) {
            Content::Nothing => {}
            Content::AtMostOne([du, dv]) => match self.zero([0.5 + du, 0.5 + dv], &self.limits, &MARGINS) {
                Some(zero) => {
                    if touches(&zero, [-room; 2], [2.0f64.mul_add(room, 1.0); 2]) {
                        out.extend(self.found(&zero));
                    }
                }
                None => subdivide::meet(self, exact, out),
            },
            Content::Unknown => subdivide::meet(self, exact, out),
        }
    }

    /// The zero near `x` in the cell, proven by limits that hold in `region`.
    #[inline(always)]
    pub(super) fn zero(&self, x: [f64; 2], limits: &Limits, region: &[[f64; 2]; 2]) -> Option<Zero> {
        // Errors are bounded up to the cell's edge.
        let within = region.map(|[from, to]| [from.max(-EDGE), to.min(1.0 + EDGE)]);
        let mut evaluations = 0;
        let zero = limits.zero(
            x,
            (region, &within),
            #[inline(always)]
            |x| {
                evaluations += 1;
                self.local(&self.cell.at(self.rational, x))
            },
        );
        steps::evaluated(evaluations, zero.is_some());
        zero
    }

    /// Converts a parameter of the cell to one of the patch.
    #[inline(always)]
    fn in_patch(&self, k: usize, x: f64) -> f64 {
        x.mul_add(self.cell.width[k], self.cell.from[k])
    }

    /// A proven zero as a crossing, if it may be on the patch.
    #[inline(always)]
    pub(super) fn found(&self, zero: &Zero) -> Option<Found> {
        let (cell, z_axis) = (self.cell, self.line.axes[2]);
        let [p, pu, pv] = cell.at(self.rational, zero.x);
        let w = p[3];
        let z = (-self.o[2]).mul_add(w, p[z_axis]) / w;
        // Of S, by the quotient rule.
        let slope = |d: &Homogeneous<f64>| ((p[z_axis] / w).abs() * d[3].abs() + d[z_axis].abs()) / w;
        let bend = |h: &Homogeneous<f64>| (cell.reach / w) * h[3] + h[z_axis];
        let [ru, rv] = zero.radius;
        let rest = bend(&cell.second[0]) * ru * ru
            + 2.0 * bend(&cell.second[1]) * ru * rv
            + bend(&cell.second[2]) * rv * rv;
        let weight_err = if self.rational {
            self.o[2].abs() * cell.weights[0] / cell.reach.max(f64::MIN_POSITIVE)
        } else {
            0.0
        };
        let z_err = slope(&pu) * ru
            + slope(&pv) * rv
            + 2.0 * rest / w
            + (cell.e_net + cell.e_point + cell.e_slope * (ru + rv)) * (1.0 + weight_err) / w
            + self.o_err[2]
            + 2.0 * U * (z.abs() + self.o[2].abs() + (p[z_axis] / w).abs());
        let (s, s_err) = self.line.along(z, z_err * ROUNDED);
        let sign = if self.line.d_z < 0.0 { -zero.sign } else { zero.sign };
        let found = Found {
            face: cell.face,
            uv: [self.in_patch(0, zero.x[0]), self.in_patch(1, zero.x[1])],
            radius: [0, 1].map(|k| (zero.radius[k] * cell.width[k] + U) * ROUNDED),
            alone: [0, 1].map(|k| zero.alone * cell.width[k]),
            s,
            s_err,
            sign,
            turn: sign,
            on_trim: false,
            is_shared: false,
            is_zero: true,
        };
        (!cell.is_half || found.reaches_triangle()).then_some(found)
    }

    /// The sign of `S_u x S_v . d` in a box, if it is the same at four points of it.
    #[inline(always)]
    pub(super) fn turn(&self, from: [f64; 2], width: [f64; 2]) -> i8 {
        self.turn_beyond([0.0; 2], from, width)
    }

    /// Likewise, if it is certain where the slopes of both functions have these errors.
    #[inline(always)]
    fn turn_beyond(&self, [e_a, e_b]: [f64; 2], from: [f64; 2], width: [f64; 2]) -> i8 {
        let signs = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(|at| {
            let x = [0, 1].map(|k| f64::mul_add(at[k], width[k], from[k]));
            let [a, b] = self.local(&self.cell.at(self.rational, x)).j;
            let det = a[0].mul_add(b[1], -(a[1] * b[0])) * self.line.d_z;
            let room = ((a[0].abs() + a[1].abs()) * e_b + (b[0].abs() + b[1].abs() + 2.0 * e_b) * e_a)
                * self.line.d_z.abs()
                * ROUNDED;
            i8::from(det > room) - i8::from(det < -room)
        });
        if signs.iter().all(|s| *s == signs[0]) { signs[0] } else { 0 }
    }

    /// The sign of an unproven crossing in a box. A line may touch an open surface where it folds at
    /// its border, and the box ends there: of such a surface, the points are half the box's width
    /// beyond its corners, and the sign is 0 if rounding may have made it.
    #[inline(always)]
    fn turn_near(&self, from: [f64; 2], width: [f64; 2]) -> i8 {
        if self.is_open {
            let from = [0, 1].map(|k| f64::mul_add(-1.5, width[k], from[k]));
            self.turn_beyond(self.limits.e_j, from, width.map(|w| 4.0 * w))
        } else {
            self.turn(from, width)
        }
    }

    /// An unproven crossing: a box in the cell in which rounding hides whether there is one.
    #[inline(always)]
    pub(super) fn unresolved(&self, from: [f64; 2], width: [f64; 2]) -> Found {
        let (cell, z_axis) = (self.cell, self.line.axes[2]);
        let half = width.map(|w| 0.5 * w);
        let x = [from[0] + half[0], from[1] + half[1]];
        let [p, ..] = cell.at(self.rational, x);
        let z = (-self.o[2]).mul_add(p[3], p[z_axis]) / p[3];
        let slope =
            |d: &Homogeneous<f64>| ((cell.reach / cell.weights[1]) * d[3] + d[z_axis]) / cell.weights[1];
        let z_err = slope(&cell.first[0]) * half[0]
            + slope(&cell.first[1]) * half[1]
            + 4.0 * (cell.e_net + cell.e_point) / cell.weights[1] * (1.0 + self.o[2].abs() / cell.weights[1])
            + self.o_err[2]
            + 2.0 * U * (z.abs() + self.o[2].abs() + cell.reach);
        let (s, s_err) = self.line.along(z, z_err * ROUNDED);
        Found {
            face: cell.face,
            uv: [self.in_patch(0, x[0]), self.in_patch(1, x[1])],
            radius: [0, 1].map(|k| half[k] * cell.width[k] + U),
            alone: [0.0; 2],
            s,
            s_err,
            sign: 0,
            turn: self.turn_near(from, width),
            on_trim: false,
            is_shared: false,
            is_zero: false,
        }
    }
}

/// Whether a zero may be in a closed box.
#[inline(always)]
pub(super) fn touches(zero: &Zero, from: [f64; 2], width: [f64; 2]) -> bool {
    (0..2).all(|k| zero.x[k] + zero.radius[k] >= from[k] && zero.x[k] - zero.radius[k] <= from[k] + width[k])
}
