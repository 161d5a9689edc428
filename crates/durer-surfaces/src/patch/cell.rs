//! Cells: parts of a patch that are so flat that a ray which is not nearly tangent meets them at
//! most once, and finds that crossing by Newton's method.
//!
//! W. Martin, E. Cohen, R. Fish, P. Shirley, "Practical ray tracing of trimmed NURBS surfaces",
//! *Journal of Graphics Tools* 5 (2000) 27-52. What they test by the angle of normals is here a
//! bound on `I - Y F'` for a ray along the normal: second derivatives, divided by slopes.

use super::net::{FaceNet, Homogeneous, Net, half, relative, steepest, widened};
use super::triangle_net::lower_half;
use durer_math::{Aabb, Isa, Point3, U, Vec3};

/// How far beyond its borders a cell's bounds hold, in widths of the cell.
pub(super) const MARGIN: f64 = 1.0 / 16.0;
/// How far beyond its borders a cell is evaluated, in widths of the cell.
pub(super) const EDGE: f64 = durer_math::scale::pow2(-8);
/// A cell is flat if slopes change relatively by less than this, seen along the normal.
const FLAT: f64 = 0.25;
/// No cell is halved more often than this along one parameter.
const FINEST: u32 = 4;
/// Bounds are not less than those of a patch of this size, in units.
const SMALL: f64 = durer_math::scale::pow2(-38);
/// The most points of a row or a column.
pub(super) const MOST: usize = 16;

/// How trims affect a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trimmed {
    /// All of it is kept.
    Not,
    /// Trims pass through it.
    Across,
    /// All of it is cut off.
    Off,
}

/// A part of a patch.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// The patch.
    pub(super) face: u32,
    /// Whether only its lower left half belongs to the patch, a triangle.
    pub(super) is_half: bool,
    pub(super) trimmed: Trimmed,
    /// The least parameters, in the patch.
    pub(super) from: [f64; 2],
    /// The widths of the ranges of parameters.
    pub(super) width: [f64; 2],
    /// The origin of the net's coordinates, in units.
    pub(super) base: [f64; 3],
    pub(super) size: [usize; 2],
    pub(super) net: Box<[Homogeneous<f64>]>,
    /// The point in the middle and its slopes along the parameters.
    pub(super) middle: [Homogeneous<f64>; 3],
    /// Bounds on the slopes, also in the margin.
    pub(super) first: [Homogeneous<f64>; 2],
    /// Bounds on the second derivatives, also in the margin: along u, mixed, along v.
    pub(super) second: [Homogeneous<f64>; 3],
    /// Bounds on the error of a point of the net, and of an evaluation, slopes included. Relative
    /// to the largest local coordinate they also bound errors of weights, relative to the largest
    /// weight.
    pub(super) e_net: f64,
    pub(super) e_point: f64,
    pub(super) e_slope: f64,
    /// The largest weight, also in the margin, and the least one in the cell.
    pub(super) weights: [f64; 2],
    /// The largest local coordinate.
    pub(super) reach: f64,
}

/// The error of an evaluation, in roundings of the sum of `|B| |P|`.
///
/// A cubic's Bernstein polynomials have five roundings: `1 - t`, three products, the factor. Each
/// further degree adds three. Each sum of `n` products rounds `n` times.
pub(super) fn sums(size: [usize; 2]) -> f64 {
    let along = |n: usize| if n == 4 { 9.0 } else { 4.0 * n as f64 };
    along(size[0]) + along(size[1])
}

pub(super) fn power(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |p, _| p * x)
}

/// The Bernstein polynomials of `n` points at `t`, and their derivatives.
#[inline(always)]
pub(super) fn basis(n: usize, t: f64) -> ([f64; MOST], [f64; MOST]) {
    let (mut b, mut d) = ([0.0; MOST], [0.0; MOST]);
    let s = 1.0 - t;
    if n == 4 {
        let (ss, st, tt) = (s * s, s * t, t * t);
        (b[0], b[1], b[2], b[3]) = (ss * s, 3.0 * ss * t, 3.0 * s * tt, tt * t);
        (d[0], d[1], d[2], d[3]) = (-3.0 * ss, 3.0 * (ss - 2.0 * st), 3.0 * (2.0 * st - tt), 3.0 * tt);
        return (b, d);
    }
    b[0] = 1.0;
    for k in 1..n {
        if k + 1 == n {
            let factor = k as f64;
            for i in 0..n {
                let before = if i > 0 { b[i - 1] } else { 0.0 };
                let here = if i < k { b[i] } else { 0.0 };
                d[i] = factor * (before - here);
            }
        }
        for i in (0..=k).rev() {
            let before = if i > 0 { b[i - 1] } else { 0.0 };
            b[i] = s.mul_add(b[i], t * before);
        }
    }
    (b, d)
}

/// A point of a net and its slopes.
#[inline(always)]
fn combine<const NU: usize>(
    net: &[Homogeneous<f64>],
    nu: usize,
    (bu, du): &([f64; MOST], [f64; MOST]),
    (bv, dv): &([f64; MOST], [f64; MOST]),
) -> [Homogeneous<f64>; 3] {
    let nu = if NU > 0 { NU } else { nu };
    let mut out = [[0.0_f64; 4]; 3];
    for (j, row) in net.chunks_exact(nu).enumerate() {
        let (mut p, mut pu) = ([0.0_f64; 4], [0.0_f64; 4]);
        for i in 0..nu {
            for c in 0..4 {
                p[c] = row[i][c].mul_add(bu[i], p[c]);
                pu[c] = row[i][c].mul_add(du[i], pu[c]);
            }
        }
        for c in 0..4 {
            out[0][c] = p[c].mul_add(bv[j], out[0][c]);
            out[1][c] = pu[c].mul_add(bv[j], out[1][c]);
            out[2][c] = p[c].mul_add(dv[j], out[2][c]);
        }
    }
    out
}

/// A point of a net and its slopes; the point's error is at most [`sums`] roundings.
#[inline(always)]
pub(super) fn point_of(net: &[Homogeneous<f64>], size: [usize; 2], x: [f64; 2]) -> [Homogeneous<f64>; 3] {
    let (u, v) = (basis(size[0], x[0]), basis(size[1], x[1]));
    if size[0] == 4 { combine::<4>(net, 4, &u, &v) } else { combine::<0>(net, size[0], &u, &v) }
}

impl Cell {
    /// The part of a patch in a box of parameters, and a box that holds it, in units: the convex hull
    /// of its control points does.
    #[inline(always)]
    fn new(
        patch: &FaceNet,
        own: &Net,
        rational: bool,
        face: u32,
        from: [f64; 2],
        width: [f64; 2],
    ) -> (Self, Aabb) {
        let to = [from[0] + width[0], from[1] + width[1]];
        let size = own.size;
        let plain = own.relative([0.0; 3]);
        let at = point_of(&plain, size, [0.5, 0.5])[0];
        let base = [0, 1, 2].map(|k| at[k] / at[3]);
        let mut net = own.relative(base);
        // Beyond the cell; a part of a triangle is costly, and f64 will do.
        let (far, far_err) = if patch.is_triangle() {
            widened(&net, size, MARGIN)
        } else {
            let beyond = [0, 1].map(|k| MARGIN * width[k]);
            let (low, high) = ([0, 1].map(|k| from[k] - beyond[k]), [0, 1].map(|k| to[k] + beyond[k]));
            (patch.part(low, high).relative(base), 0.0)
        };
        let most =
            |net: &[Homogeneous<f64>]| net.iter().flat_map(|p| &p[..3]).fold(0.0, |m: f64, x| m.max(x.abs()));
        let reach = most(&net);
        let wide_reach = reach.max(most(&far));
        let most_weight = far.iter().fold(0.0, |m: f64, p| m.max(p[3].abs()));
        let least = |net: &[Homogeneous<f64>]| net.iter().fold(f64::INFINITY, |m: f64, p| m.min(p[3]));
        let least_weight = least(&net);
        let weights = [most_weight, least_weight * (1.0 - 4.0 * U)];
        if !rational {
            net.iter_mut().for_each(|p| p[3] = 1.0);
        }
        let mut middle = point_of(&net, size, [0.5, 0.5]);
        if !rational {
            (middle[0][3], middle[1][3], middle[2][3]) = (1.0, 0.0, 0.0);
        }
        // Derivatives by the cell's own parameters; the net beyond is wider by its margins.
        let stretch = 1.0 / (1.0 + 2.0 * MARGIN);
        let degrees = [(size[0] - 1) as f64, (size[1] - 1) as f64];
        // Also covers the errors of the points of very small patches, deep in a subdivision
        // surface.
        let rounding =
            (16.0 + far_err) * U * wide_reach.max(if rational { weights[0] } else { 0.0 }).max(SMALL);
        let bound = |along: [usize; 2]| {
            let mut most = steepest(&far, size, along);
            let mut scale = 1.0;
            for k in 0..2 {
                for n in 0..along[k] {
                    scale *= stretch * (degrees[k] - n as f64).max(0.0);
                }
            }
            let (factor, slack) = (power(stretch, along[0] + along[1]), scale * 4.0 * rounding);
            for (c, m) in most.iter_mut().enumerate() {
                *m = if c == 3 && !rational { 0.0 } else { (*m * factor + slack) * (1.0 + 64.0 * U) };
            }
            most
        };
        // The sum of the |Bernstein polynomials| as far as the cell is evaluated.
        let spread = power(1.0 + 2.0 * EDGE, size[0] + size[1] - 2);
        let e_point = sums(size) * U * spread * reach;
        // Of a half, the net of the triangle is nearer.
        let is_half = patch.is_triangle() && to[0] + to[1] > 1.0;
        let mut room = 0.0;
        let hull = match patch {
            FaceNet::Triangle(_) if is_half && !rational => {
                let (half, err) = lower_half(&net, size[0]);
                room = err * U * reach;
                half.iter().map(|&[x, y, z]| [x, y, z, 1.0]).collect()
            }
            FaceNet::Triangle(all) if is_half => relative(&all.part(half(from, to)).points, base),
            _ => net.clone(),
        };
        let place = |p: &Homogeneous<f64>| {
            Point3::new(p[0] / p[3] + base[0], p[1] / p[3] + base[1], p[2] / p[3] + base[2])
        };
        let room = 8.0 * U * (1.0 + most(&hull) / least(&hull)) + room;
        let bounds = Aabb::from_points(hull.iter().map(place)).expanded(Vec3::new(room, room, room));
        let cell = Self {
            face,
            is_half,
            trimmed: Trimmed::Not,
            from,
            width,
            base,
            size,
            first: [bound([1, 0]), bound([0, 1])],
            second: [bound([2, 0]), bound([1, 1]), bound([0, 2])],
            middle,
            e_net: (U * reach).mul_add(1.0 + 8.0 * U, patch.lost()) * spread,
            e_point,
            e_slope: 2.0 * degrees[0].max(degrees[1]) * e_point,
            weights,
            reach,
            net: net.into(),
        };
        (cell, bounds)
    }

    /// The point and its slopes at `x`, in the cell's parameters from 0 to 1.
    #[inline(always)]
    pub(super) fn at(&self, rational: bool, x: [f64; 2]) -> [Homogeneous<f64>; 3] {
        let mut out = point_of(&self.net, self.size, x);
        if !rational {
            (out[0][3], out[1][3], out[2][3]) = (1.0, 0.0, 0.0);
        }
        out
    }

    /// The relative change of slopes in the cell, along each parameter.
    fn bend(&self) -> [f64; 2] {
        let vector = |p: &Homogeneous<f64>| Vec3::new(p[0], p[1], p[2]);
        let (a, b) = (vector(&self.middle[1]), vector(&self.middle[2]));
        let n = a.cross(b);
        let [uu, uv, vv] = self.second.map(|h| vector(&h).length());
        // The rows of Y for a ray along the normal.
        let (yu, yv) = (b.length() / n.length(), a.length() / n.length());
        let along = |h: f64, mixed: f64| 0.5 * yu.max(yv) * (h + mixed);
        let bend = [along(uu, uv), along(vv, uv)];
        if bend.iter().all(|b| b.is_finite()) { bend } else { [uu + uv, vv + uv].map(|h| h * 1e30) }
    }
}

/// The cells of a patch, and boxes that hold them.
pub(super) fn cells(patch: &FaceNet, rational: bool, face: u32, out: &mut Vec<(Cell, Aabb)>) {
    Isa::detect().run(
        #[inline(always)]
        || cut_up(patch, rational, face, out),
    );
}

#[inline(always)]
fn cut_up(patch: &FaceNet, rational: bool, face: u32, out: &mut Vec<(Cell, Aabb)>) {
    // Of triangles each square comes from the one before, others from the whole.
    let first = patch.is_triangle().then(|| patch.part([0.0; 2], [1.0; 2]));
    let mut open = vec![([0.0; 2], [0_u32; 2], first)];
    while let Some((from, halved, own)) = open.pop() {
        if patch.is_triangle() && from[0] + from[1] >= 1.0 {
            continue;
        }
        let width = halved.map(|n| durer_math::scale::pow2(-(n as i32)));
        let own = own.unwrap_or_else(|| patch.part(from, [from[0] + width[0], from[1] + width[1]]));
        let (cell, bounds) = Cell::new(patch, &own, rational, face, from, width);
        let [u, v] = cell.bend();
        let may = [0, 1].map(|k| halved[k] < FINEST);
        let is_flat = u + v <= FLAT || may == [false; 2] || (u + v).is_nan();
        // Beyond the triangle a weight may not be positive, unless the half is small.
        let is_light = cell.is_half && cell.weights[1] <= 0.0;
        if is_flat && !is_light {
            out.push((cell, bounds));
            continue;
        }
        if patch.is_triangle() {
            // In four, so that squares on the long side stay in halves.
            let halved = halved.map(|n| n + 1);
            let half = 0.5 * width[0];
            let [x, y] = from;
            let [low, high] = own.halves(1);
            let ([a, b], [c, d]) = (low.halves(0), high.halves(0));
            let corners = [([x + half, y + half], d), ([x, y + half], c), ([x + half, y], b), (from, a)];
            open.extend(corners.map(|(from, own)| (from, halved, Some(own))));
            continue;
        }
        let k = if may == [true; 2] { usize::from(v > u) } else { usize::from(may[1]) };
        // A parameter along which nothing changes is not worth halving.
        if [u, v][k] <= FLAT / 8.0 {
            out.push((cell, bounds));
            continue;
        }
        let (mut halved, mut second) = (halved, from);
        halved[k] += 1;
        second[k] += 0.5 * width[k];
        open.extend([(second, halved, None), (from, halved, None)]);
    }
}
