//! The intersection of a triangle and an exactly known ray in plain f64, without re-centring. It
//! decides nearly all rays, in a tenth of the steps.
//!
//! With `C = v0 - o`, edges `e1`, `e2` from `v0`, `N = e1 x e2`, `R = C x d`:
//!
//! ```text
//!     s = T / D,   T = C . N,   D = d . N
//!     b1 = U / D,   U = R . e2,      b2 = V / D,   V = -R . e1,      W = D - U - V
//! ```
//!
//! (T. Moeller, B. Trumbore, "Fast, minimum storage ray-triangle intersection", Journal of Graphics
//! Tools 2(1), 1997). Let `u = 2^-53`, `c` and `M` the greatest magnitudes in `C` and `d`, `S` the
//! product and `E` the greater of the edges' sums of magnitudes. Corners and ray are exact. To
//! first order, per component and without fused operations, the errors are
//!
//! ```text
//!     C   u c        e   u |e|        R   4 u c M + 2 u c M            U, V   (6 + 6 + 2) u c M E
//!     N   4 u S in sum                D   (3 + 4) u M S                W      9 u M S + 34 u c M E
//! ```
//!
//! The quotient alone would have the error of `N` times the whole distance. So it is corrected
//! once: with `p = C - s d`, whose error is `u |C| + u |p|`,
//!
//! ```text
//!     s + N . p / D     has the error  (u sum |N_i C_i| + 8 u S |p|) / |D|
//!                       and the error of D and of two roundings in the correction.
//! ```
//!
//! Near the start that is not enough: `p` is as long as the triangle, `s` is not. There `T / D` is
//! computed once more, in double-double, from differences that are exact. The relative errors of
//! its operations are `4 u^2` (products), `2 u^2` (by an f64), `3 u^2` (sums) and `15 u^2` (the
//! quotient): see [`Dd`]. So the errors are
//!
//! ```text
//!     N   (4 + 3) u^2 S in sum        T   (7 + 4 + 6) u^2 c S          D   (7 + 2 + 6) u^2 M S
//!     s   17 u^2 S (c + |s| M) / |D|  +  15 u^2 |s|,  and u |s| where it is rounded.
//! ```
//!
//! If these bounds leave something uncertain, or less precise than it should be,
//! [`facet`](crate::facet) decides.

use crate::facet::Facet;
use crate::planar::TINY;
use crate::{LocalRay, Root, RootKind};
use durer_math::lanes::{F8, M8};
use durer_math::rounding::{add_up, sub_down};
use durer_math::{Dd, Isa, Point3, U, Vec3};

/// Covers second-order terms, and the rounding of the bounds.
const PAYS: f64 = 1.0 + 256.0 * U;
/// A bracket is narrow up to this width, relative to the parameter or to `size / |d|`: 32 ulp at
/// their smallest.
const NARROW: f64 = 32.0 * U;
/// The largest error of the volumes, relative to their sum, for which tags are used: they are then
/// within twice this of the exact coordinates.
const TAG: f64 = durer_math::scale::pow2(-32);
/// Products of lengths in this range do not leave the range of f64, whatever the direction.
const RANGE: (f64, f64) = (durer_math::scale::pow2(-400), durer_math::scale::pow2(400));

/// The range of lengths for the second computation, with low parts of products: what underflow
/// takes from these, below `2^-1071`, moves `s` by less than [`LOST`].
const NEAR: (f64, f64) = (durer_math::scale::pow2(-200), durer_math::scale::pow2(100));
const LOST: f64 = durer_math::scale::pow2(-700);

/// The result for one ray and one triangle.
pub(crate) enum Swift {
    /// There is no crossing that matters.
    Missed,
    /// There is a crossing.
    Met(Root),
    /// The result is not certain.
    Open,
}

#[inline(always)]
fn sum(v: Vec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// The cross product with two roundings per component; [`Vec3::cross`] is slower and more precise.
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

/// The crossing of a ray and a triangle, if it matters for a sink's range.
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
    // False if one of them is NaN.
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
    // All three have one sign, and their sum has the same.
    let slack = 7.0 * U * m * area * PAYS;
    let sure = along.abs() - slack;
    if !(sure > slack && bound <= TAG * sure) {
        return Swift::Open;
    }
    let inverse = 1.0 / along;
    let s = c.dot(n) * inverse;
    // The remaining distance to the plane; here the error of N counts only in proportion to the
    // distance of the corners from this point.
    let p = Vec3::new((-s).mul_add(d.x, c.x), (-s).mul_add(d.y, c.y), (-s).mul_add(d.z, c.z));
    let step = p.dot(n) * inverse;
    let s = s + step;
    let spread = (c.x * n.x).abs() + (c.y * n.y).abs() + (c.z * n.z).abs();
    let err = (8.0 * area).mul_add(p.max_abs(), spread) * U;
    let err = step.abs().mul_add((3.0 * U).mul_add(sure, slack), err) / sure;
    let err = s.abs().mul_add(U, err).mul_add(PAYS, TINY);
    // Half the largest width is at least a sixth of the longer edge's sum, and |d| is below 4.
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
    Swift::Met(Root { t, lo, hi, s, tag, face, sign, kind: RootKind::Simple })
}

#[inline(always)]
fn sum_of_each(v: Vec3<F8>) -> F8 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

#[inline(always)]
fn most_of_each(v: Vec3<F8>) -> F8 {
    v.x.abs().max(v.y.abs()).max(v.z.abs())
}

/// [`cross`] for eight vectors.
#[inline(always)]
fn cross_of_each(a: Vec3<F8>, b: Vec3<F8>) -> Vec3<F8> {
    Vec3::new(a.y.mul_add(b.z, -(a.z * b.y)), a.z.mul_add(b.x, -(a.x * b.z)), a.x.mul_add(b.y, -(a.y * b.x)))
}

/// The crossings of eight rays, each with a triangle of its own.
#[derive(Clone, Copy, Debug)]
pub struct Crossings {
    /// The parameters, bit for bit those of [`Triangle::roots`](crate::Surface::roots).
    pub s: F8,
    /// Rays that certainly cross their triangle, within their range.
    pub met: M8,
    /// Rays for which nothing is certain; they must be tested alone. A ray in neither set misses
    /// its triangle.
    pub open: M8,
}

/// The first of the two computations above for eight rays at once, each with a triangle of its own;
/// the largest component of each `d` must be in `[1, 2)`. Compiled for packets by
/// [`Isa::run_in_lanes`].
///
/// A crossing counts if three times its error is within the range: once for itself, once for the
/// rounding of `s + 3 err`, which is below `u |s| + 3 u err` and so below `1.01 err`.
#[inline(always)]
pub fn meet_eight(o: Vec3<F8>, d: Vec3<F8>, range: (F8, F8), corners: [Vec3<F8>; 3]) -> Crossings {
    let all = F8::splat;
    let [v0, v1, v2] = corners;
    let (c, e1, e2) = (v0 - o, v1 - v0, v2 - v0);
    let (n, r) = (cross_of_each(e1, e2), cross_of_each(c, d));
    let (u, v, along) = (r.dot(e2), -r.dot(e1), d.dot(n));
    let w = (along - u) - v;
    let (l1, l2) = (sum_of_each(e1), sum_of_each(e2));
    let (reach, m, edge, area) = (most_of_each(c), most_of_each(d), l1.max(l2), l1 * l2);
    let fits = area.gt(all(RANGE.0)) & edge.max(reach).lt(all(RANGE.1));
    let bound = (all(34.0) * reach).mul_add(edge, all(9.0) * area) * (all(U) * m * all(PAYS));
    let (low, high) = (u.min(v).min(w), u.max(v).max(w));
    let missed = fits & low.lt(-bound) & high.gt(bound);
    let through = low.gt(bound) | high.lt(-bound);
    let slack = all(7.0) * all(U) * m * area * all(PAYS);
    let sure = along.abs() - slack;
    let inverse = F8::ONE / along;
    let s = c.dot(n) * inverse;
    let p = Vec3::new((-s).mul_add(d.x, c.x), (-s).mul_add(d.y, c.y), (-s).mul_add(d.z, c.z));
    let step = p.dot(n) * inverse;
    let s = s + step;
    let spread = (c.x * n.x).abs() + (c.y * n.y).abs() + (c.z * n.z).abs();
    let err = (all(8.0) * area).mul_add(most_of_each(p), spread) * all(U);
    let err = step.abs().mul_add(all(3.0 * U).mul_add(sure, slack), err) / sure;
    let err = s.abs().mul_add(all(U), err).mul_add(all(PAYS), all(TINY));
    let size = edge / all(24.0);
    let narrow = err.le(all(0.5 * NARROW) * s.abs().max(size));
    let three = all(3.0) * err;
    let within = (s - three).ge(range.0) & (s + three).le(range.1);
    let met = fits & through & sure.gt(slack) & bound.le(all(TAG) * sure) & narrow & within;
    Crossings { s, met, open: !(met | missed) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::TestRng;
    use durer_math::Ray;

    fn eight(v: impl Fn(usize) -> Vec3) -> Vec3<F8> {
        let axis = |axis: usize| F8(core::array::from_fn(|i| v(i)[axis]));
        Vec3::new(axis(0), axis(1), axis(2))
    }

    #[test]
    fn eight_rays_meet_what_each_meets_alone() {
        let (mut met, mut missed, mut open) = (0, 0, 0);
        for seed in 0..2000 {
            let mut dice = TestRng::new(seed);
            let cases: Vec<(Ray, Facet)> = (0..8)
                .map(|_| {
                    let facet = [dice.vector(), dice.vector(), dice.vector()].map(Vec3::to_point);
                    let [a, b, c] = facet;
                    let (p, q) = (dice.unit(), dice.unit());
                    // Through the triangle, near it, or through one of its edges, from far and from
                    // near.
                    let at = match dice.below(3) {
                        0 => a + (b - a) * (0.4 * p) + (c - a) * (0.4 * q),
                        1 => a + (b - a) * (2.0 * p) + (c - a) * (2.0 * q),
                        _ => a + (b - a) * p,
                    };
                    let back = dice.power(-2, 10);
                    let d = dice.vector();
                    let d = d.scale2(-durer_math::scale::exponent(d.max_abs()));
                    let t_max = if dice.below(4) > 0 { f64::INFINITY } else { 2.0 * dice.unit() * back };
                    (Ray::new(at - d * back, d).with_range(0.0, t_max), facet)
                })
                .collect();
            let corner = |n: usize| eight(|i| cases[i].1[n] - Point3::ORIGIN);
            let range = (F8::ZERO, F8(core::array::from_fn(|i| cases[i].0.t_max)));
            let origins = eight(|i| cases[i].0.origin - Point3::ORIGIN);
            let directions = eight(|i| cases[i].0.direction);
            for isa in Isa::available() {
                let together = isa.run_in_lanes(
                    #[inline(always)]
                    || meet_eight(origins, directions, range, [corner(0), corner(1), corner(2)]),
                );
                for (i, (ray, facet)) in cases.iter().enumerate() {
                    let alone = meet(&LocalRay::new(ray), facet, 0, (f64::NEG_INFINITY, f64::INFINITY));
                    match (together.met.lane(i), together.open.lane(i), alone) {
                        (true, false, Swift::Met(root)) => {
                            assert_eq!(root.s.to_bits(), together.s.0[i].to_bits());
                            met += 1;
                        }
                        (false, false, Swift::Missed) => missed += 1,
                        (false, true, _) => open += 1,
                        (is_met, is_open, _) => {
                            panic!("{isa:?} {seed} {i}: met {is_met}, open {is_open}, alone not so")
                        }
                    }
                }
            }
        }
        assert!(met > 5000 && missed > 5000 && open > 5000 && open < met + missed, "{met} {missed} {open}");
    }
}
