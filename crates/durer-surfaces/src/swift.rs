//! A triangle met by a ray that is exactly known, in plain f64 and without re-centring: what nearly all rays need, in a tenth of the steps.
//!
//! With `C = v0 - o`, edges `e1`, `e2` from `v0`, `N = e1 x e2`, `R = C x d`:
//!
//! ```text
//!     s = T / D,   T = C . N,   D = d . N,        b1 = U / D,   U = R . e2,      b2 = V / D,   V = -R . e1,      W = D - U - V
//! ```
//!
//! (T. Moeller, B. Trumbore, "Fast, minimum storage ray-triangle intersection", Journal of Graphics Tools 2(1), 1997). Let `u = 2^-53`, `c` and `M` the
//! greatest magnitudes in `C` and `d`, `S` the product and `E` the greater of the edges' sums of magnitudes. Corners and ray are
//! exact; to first order, per component and counted without fused operations,
//!
//! ```text
//!     C   u c        e   u |e|        R   4 u c M + 2 u c M            U, V   (6 + 6 + 2) u c M E
//!     N   4 u S in sum                D   (3 + 4) u M S                W      9 u M S + 34 u c M E
//! ```
//!
//! The quotient alone would carry the error of `N` over the whole way. So it is corrected once: with `p = C - s d`, which errs by `u |C| + u |p|`,
//!
//! ```text
//!     s + N . p / D     errs by  (u sum |N_i C_i| + 8 u S |p|) / |D|  and what D and two roundings do to the correction.
//! ```
//!
//! Near the start that is not enough: `p` is as long as the triangle, `s` is not. There `T / D` is found once more, in double-double, from differences that
//! are exact. Its operations err by `4 u^2` (products), `2 u^2` (by an f64), `3 u^2` (sums) and `15 u^2` (the quotient) of what they give: see [`Dd`]. So
//!
//! ```text
//!     N   (4 + 3) u^2 S in sum        T   (7 + 4 + 6) u^2 c S          D   (7 + 2 + 6) u^2 M S
//!     s   errs by  17 u^2 S (c + |s| M) / |D|  +  15 u^2 |s|,  and by u |s| where it is rounded.
//! ```
//!
//! What is not certain by these bounds, or known less well than it should be, is left to [`facet`](crate::facet).

use crate::facet::Facet;
use crate::planar::TINY;
use crate::{Kind, LocalRay, Root};
use durer_math::rounding::{add_up, sub_down};
use durer_math::{Dd, Isa, Point3, U, Vec3};

/// Second-order terms, and the roundings of the bounds.
const PAYS: f64 = 1.0 + 256.0 * U;
/// A bracket this wide, relative to the parameter or to `size / |d|`, is narrow: 32 ulp at their smallest.
const NARROW: f64 = 32.0 * U;
/// The error of the volumes over their sum up to which tags are taken: they are then within twice this of the exact coordinates.
const TAG: f64 = durer_math::scale::pow2(-32);
/// Products of lengths between these do not leave the range of f64, whatever the direction.
const RANGE: (f64, f64) = (durer_math::scale::pow2(-400), durer_math::scale::pow2(400));

/// The same for the second computation, with low parts of products: what underflow takes from these, below `2^-1071`, moves `s` by less than [`LOST`].
const NEAR: (f64, f64) = (durer_math::scale::pow2(-200), durer_math::scale::pow2(100));
const LOST: f64 = durer_math::scale::pow2(-700);

/// What can be said.
pub(crate) enum Swift {
    /// There is no crossing that matters.
    Missed,
    /// There is one.
    Met(Root),
    /// Something is not certain.
    Open,
}

#[inline(always)]
fn sum(v: Vec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Two roundings per component, where [`Vec3::cross`] spends more on fewer.
#[inline(always)]
fn cross(a: Vec3, b: Vec3) -> Vec3 {
    let minor = |i: usize, j: usize| a[i].mul_add(b[j], -(a[j] * b[i]));
    Vec3::new(minor(1, 2), minor(2, 0), minor(0, 1))
}

/// `T / D` in double-double, rounded.
#[inline(never)]
fn sharper(o: Point3, d: Vec3, v: &Facet) -> f64 {
    Isa::detect().run(
        #[inline(always)]
        || {
            let exact = |to: Point3, from: Point3| {
                let axis = |i: usize| Dd::difference(to[i], from[i]);
                [axis(0), axis(1), axis(2)]
            };
            let (c, e1, e2) = (exact(v[0], o), exact(v[1], v[0]), exact(v[2], v[0]));
            let minor = |i: usize, j: usize| e1[i] * e2[j] - e1[j] * e2[i];
            let n = [minor(1, 2), minor(2, 0), minor(0, 1)];
            let way = c[0] * n[0] + c[1] * n[1] + c[2] * n[2];
            let along = n[0] * d.x + n[1] * d.y + n[2] * d.z;
            (way / along).to_f64()
        },
    )
}

/// The crossing of a ray and a triangle, as far as it matters for a sink's range.
#[inline(always)]
pub(crate) fn meet(ray: &LocalRay<'_>, facet: &Facet, face: u32, range: (f64, f64)) -> Swift {
    let plain =
        ray.starts_at_zero() && ray.source.is_none() && ray.o_err == Vec3::ZERO && ray.d_err == Vec3::ZERO;
    if !plain {
        return Swift::Open;
    }
    let [v0, v1, v2] = *facet;
    let (c, e1, e2, d) = (v0 - ray.o, v1 - v0, v2 - v0, ray.d);
    let (n, r) = (cross(e1, e2), cross(c, d));
    let (u, v, along) = (r.dot(e2), -r.dot(e1), d.dot(n));
    let w = (along - u) - v;
    let (l1, l2) = (sum(e1), sum(e2));
    let (reach, m, edge, area) = (c.max_abs(), d.max_abs(), l1.max(l2), l1 * l2);
    // Not so if one of them is NaN.
    if !(area > RANGE.0 && edge.max(reach) < RANGE.1) {
        return Swift::Open;
    }
    let bound = (34.0 * reach).mul_add(edge, 9.0 * area) * (U * m * PAYS);
    let (least, most) = (u.min(v).min(w), u.max(v).max(w));
    if least < -bound && most > bound {
        return Swift::Missed;
    }
    if least <= bound && most >= -bound {
        return Swift::Open;
    }
    // All three have one sign, and so has their sum.
    let slack = 7.0 * U * m * area * PAYS;
    let sure = along.abs() - slack;
    if !(sure > slack && bound <= TAG * sure) {
        return Swift::Open;
    }
    let inverse = 1.0 / along;
    let s = c.dot(n) * inverse;
    // What is left of the way to the plane; now the error of N counts only as far as the corners are from there.
    let p = Vec3::new((-s).mul_add(d.x, c.x), (-s).mul_add(d.y, c.y), (-s).mul_add(d.z, c.z));
    let step = p.dot(n) * inverse;
    let s = s + step;
    let spread = (c.x * n.x).abs() + (c.y * n.y).abs() + (c.z * n.z).abs();
    let err = (8.0 * area).mul_add(p.max_abs(), spread) * U;
    let err = step.abs().mul_add((3.0 * U).mul_add(sure, slack), err) / sure;
    let err = s.abs().mul_add(U, err).mul_add(PAYS, TINY);
    // Half the largest width is a sixth of the longer edge's sum at least, and |d| is below 4.
    let size = edge / 24.0;
    let narrow = |s: f64, err: f64| err <= 0.5 * NARROW * s.abs().max(size);
    let (s, err) = if narrow(s, err) {
        (s, err)
    } else {
        if !(area > NEAR.0 && edge.max(reach) < NEAR.1) {
            return Swift::Open;
        }
        let s = sharper(ray.o, d, facet);
        let err = (17.0 * U * U) * (s.abs().mul_add(m, reach) * area / sure);
        let err = s.abs().mul_add(U, err).mul_add(PAYS, LOST);
        if !narrow(s, err) {
            return Swift::Open;
        }
        (s, err)
    };
    let Some([lo, t, hi]) = ray.caller_t([sub_down(s, err), s, add_up(s, err)]) else { return Swift::Open };
    if hi < range.0 || lo > range.1 || hi < ray.t_min || lo > ray.t_max {
        return Swift::Missed;
    }
    if lo < ray.t_min || hi > ray.t_max {
        return Swift::Open;
    }
    let tag = [(u * inverse).clamp(0.0, 1.0), (v * inverse).clamp(0.0, 1.0)];
    let sign = if along > 0.0 { 1 } else { -1 };
    Swift::Met(Root { t, lo, hi, s, tag, face, sign, kind: Kind::Simple })
}
