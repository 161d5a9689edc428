//! The intersection of one triangle, shared by [`Triangle`](crate::Triangle) and
//! [`Mesh`](crate::Mesh).
//!
//! A ray meets the triangle if it passes its three edges on the same side: `U`, `V`, `W` of
//! `edges.rs` have one sign. Their ratios to the sum are the barycentric coordinates (R. J. Segura,
//! F. R. Feito, "Algorithms to test ray-triangle intersection. Comparative study", WSCG 2001; A.
//! Kensler, P. Shirley, "Optimizing ray-triangle intersection via automated search", RT 2006). The
//! crossing's parameter comes from the plane of the three vertices, whose numbers are exact.

use crate::edges::{self, EdgeFilter};
use crate::planar::{self, Crossing, Line, Probe, Ratios, ThreePoints, cross, dot, seen_from, towards};
use crate::point::least_step;
use crate::{Need, RingRay, SurfacePoint};
use durer_math::eft::exponent;
use durer_math::{Dyadic, EFloat, Isa, Normal3, Point3, Ring, U, Vec3};

/// A triangle by its vertices; the normal is `(v1 - v0) x (v2 - v0)`.
pub(crate) type Facet = [Point3; 3];

/// The attributes that may vary over a triangle.
pub(crate) struct Varying {
    pub(crate) normals: Option<[Normal3; 3]>,
    pub(crate) uv: Option<[[f64; 2]; 3]>,
}

/// A bound on the error of a component of [`unit_normal`]: twice the accepted error (a component
/// replaced by zero is no larger than its error), divided by a length of at least the largest
/// component, and four roundings.
pub(crate) const NORMAL: f64 = 72.0 * U;

/// Whether the triangle has no area, exactly.
pub(crate) fn is_degenerate(v: &Facet) -> bool {
    let (n, err) = normal_and_error(v);
    // One component that is surely not zero settles it.
    if (0..3).any(|i| n[i].abs() > err[i]) {
        return false;
    }
    exact_normal(v).iter().all(Dyadic::is_zero)
}

/// The crossing of the ray with the triangle, and the barycentric coordinates `(b1, b2)`. The ray's
/// range is not checked.
#[inline(always)]
pub(crate) fn hit(probe: &Probe<'_>, filter: &EdgeFilter, v: &Facet) -> Option<(Crossing, [f64; 2])> {
    hit_of(probe, v, &passes(probe, filter, v)?)
}

/// [`hit`] for a ray that is known to pass all edges on one side.
#[inline(always)]
pub(crate) fn hit_of(probe: &Probe<'_>, v: &Facet, passed: &Passed) -> Option<(Crossing, [f64; 2])> {
    let Passed { values, bound, .. } = *passed;
    let crossing = probe.crossing(&plane(probe, v))?;
    let sum = values[0] + values[1] + values[2];
    let tag = if bound < sum.abs() * TAG {
        [values[1] / sum, values[2] / sum]
    } else {
        barycentric(probe, v).map(EFloat::value)
    };
    Some((crossing, tag.map(|b| b.clamp(0.0, 1.0))))
}

/// The relative error up to which the tag comes straight from the filter.
const TAG: f64 = 1.0 / (1u64 << 40) as f64;

/// A line that passes all edges of a triangle on one side.
pub(crate) struct Passed {
    /// `U`, `V`, `W` in f64.
    values: [f64; 3],
    /// A bound on their errors.
    bound: f64,
    /// Their common sign; zero only if an inexact line leaves all of them open.
    pub(crate) side: i8,
}

/// Whether a line passes all edges on one side.
#[inline(always)]
pub(crate) fn passes<L: Line>(line: &L, filter: &EdgeFilter, v: &Facet) -> Option<Passed> {
    let (values, bound) = volumes_within(filter, v);
    let least = values[0].min(values[1]).min(values[2]);
    let most = values[0].max(values[1]).max(values[2]);
    if least < -bound && most > bound {
        return None;
    }
    let side = if least > bound {
        1
    } else if most < -bound {
        -1
    } else {
        common_side(line, v, values, bound)?
    };
    Some(Passed { values, bound, side })
}

/// How a line meets a closed triangle.
pub(crate) enum Contact {
    /// It does not meet the triangle.
    Apart,
    /// It meets the interior: it passes all edges on one side. An undecided inexact line counts as
    /// this.
    Inside(Passed),
    /// It meets the border, or lies in the triangle's plane: the sides of the edges opposite to the
    /// vertices, zero where the line meets the edge's line. The others agree.
    Border([i8; 3]),
}

/// How a line meets a triangle, without the displacement by which [`passes`] decides ties.
#[inline(always)]
pub(crate) fn contact<L: Line>(line: &L, filter: &EdgeFilter, v: &Facet) -> Contact {
    let (values, bound) = volumes_within(filter, v);
    let least = values[0].min(values[1]).min(values[2]);
    let most = values[0].max(values[1]).max(values[2]);
    if least < -bound && most > bound {
        Contact::Apart
    } else if least > bound {
        Contact::Inside(Passed { values, bound, side: 1 })
    } else if most < -bound {
        Contact::Inside(Passed { values, bound, side: -1 })
    } else {
        exact_contact(line, v, values, bound)
    }
}

#[cold]
#[inline(never)]
fn exact_contact<L: Line>(line: &L, v: &Facet, values: [f64; 3], bound: f64) -> Contact {
    let mut sides = [0_i8; 3];
    for (i, value) in values.into_iter().enumerate() {
        sides[i] = if value > bound {
            1
        } else if value < -bound {
            -1
        } else {
            match edges::undisplaced_side(line, v[(i + 1) % 3], v[(i + 2) % 3]) {
                Some(side) => side as i8,
                None => {
                    let side = common_side(line, v, values, bound);
                    return side
                        .map_or(Contact::Apart, |side| Contact::Inside(Passed { values, bound, side }));
                }
            }
        };
    }
    let has = |side: i8| sides.contains(&side);
    match (has(-1), has(0), has(1)) {
        (true, _, true) => Contact::Apart,
        (_, true, _) => Contact::Border(sides),
        _ => Contact::Inside(Passed { values, bound, side: sides[0] }),
    }
}

/// `U`, `V`, `W` in f64, and a bound on their errors.
#[inline(always)]
fn volumes_within(filter: &EdgeFilter, v: &Facet) -> ([f64; 3], f64) {
    let (a, b, c) = (filter.seen(v[0]), filter.seen(v[1]), filter.seen(v[2]));
    let bound = filter.bound(a.max_abs().max(b.max_abs()).max(c.max_abs()));
    ([filter.side(b, c), filter.side(c, a), filter.side(a, b)], bound)
}

/// The common sign of all three, exactly, where the filter left some open.
#[cold]
#[inline(never)]
fn common_side<L: Line>(line: &L, v: &Facet, values: [f64; 3], bound: f64) -> Option<i8> {
    Isa::detect().run(
        #[inline(always)]
        || {
            let mut common = 0;
            for (i, value) in values.into_iter().enumerate() {
                let side = if value > bound {
                    Some(1)
                } else if value < -bound {
                    Some(-1)
                } else {
                    edges::exact_side(line, v[(i + 1) % 3], v[(i + 2) % 3])
                };
                // An unknown side (of inexact lines only) agrees with all.
                let Some(side) = side else { continue };
                if side == 0 || side == -common {
                    return None;
                }
                common = side;
            }
            Some(common)
        },
    )
}

/// Whether a point lies in the triangle's plane, exactly.
pub(crate) fn holds_in_plane(v: &Facet, p: Point3) -> bool {
    let q: [Dyadic; 3] = seen_from(p, v[0], 0);
    dot(&exact_normal(v), &q).is_zero()
}

/// Whether the start of a line, which lies in the triangle's plane, lies in the closed triangle.
/// True for an undecided inexact line.
#[inline(always)]
pub(crate) fn holds_start<L: Line>(line: &L, v: &Facet) -> bool {
    let Some(start) = line.exact() else { return true };
    let (centre, scale) = line.view();
    // The line across the plane.
    let across = ThreePoints { points: *v, centre, scale }.normal().1;
    let [v1, v2, sum] = volumes(v, &RingRay { d: across, ..start }, centre, scale);
    let v0 = sum - v1.clone() - v2.clone();
    let signs = [v0, v1, v2].map(|x| x.exact_sign());
    signs.iter().all(|s| s.is_ge()) || signs.iter().all(|s| s.is_le())
}

#[inline(always)]
pub(crate) fn plane(probe: &Probe<'_>, v: &Facet) -> ThreePoints {
    ThreePoints { points: *v, centre: probe.ray.centre, scale: probe.ray.scale }
}

/// `d . (q x p)`.
#[inline(always)]
fn volume<T: Ring>(ray: &RingRay<T>, p: &[T; 3], q: &[T; 3]) -> T {
    dot(&ray.d, &cross(q, p))
}

/// `(V, W, U + V + W)`: the second and third barycentric coordinates and their divisor.
#[inline(always)]
fn volumes<T: Ring>(v: &Facet, ray: &RingRay<T>, centre: Point3, scale: i32) -> [T; 3] {
    let [a, b, c] = *v;
    let (a, b, c) =
        (towards(ray, a, centre, scale), towards(ray, b, centre, scale), towards(ray, c, centre, scale));
    let (u, v, w) = (volume(ray, &b, &c), volume(ray, &c, &a), volume(ray, &a, &b));
    [v.clone(), w.clone(), u + v + w]
}

/// `(b1, b2)` of the point where the ray meets the triangle's plane, with bounds.
#[inline(always)]
fn barycentric(probe: &Probe<'_>, v: &Facet) -> [EFloat; 2] {
    barycentric_within(probe, v, planar::TIGHT).unwrap_or_else(|| exact_barycentric(probe, v))
}

/// [`barycentric`] in f64, if no error is above `tight`.
#[inline(always)]
fn barycentric_within(probe: &Probe<'_>, v: &Facet, tight: f64) -> Option<[EFloat; 2]> {
    let (values, bound) = volumes_within(&EdgeFilter::new(probe), v);
    quotients_within(values, bound, tight)
}

/// `V` and `W` divided by `U + V + W`, if the errors are small enough; the error of each volume is
/// at most `bound`.
#[inline(always)]
pub(crate) fn quotients(values: [f64; 3], bound: f64) -> Option<[EFloat; 2]> {
    quotients_within(values, bound, planar::TIGHT)
}

#[inline(always)]
fn quotients_within([u, v, w]: [f64; 3], bound: f64, tight: f64) -> Option<[EFloat; 2]> {
    let sum = u + v + w;
    // Two roundings in the sum.
    let rounding = 3.0 * U * (u.abs() + v.abs() + w.abs());
    let least = sum.abs() - 4.0 * bound - rounding;
    let quotient = |x: f64| {
        let b = x / sum;
        EFloat::with_error(
            b,
            ((bound + rounding) * (1.0 + 3.0 * b.abs()) / least + U * b.abs()) * (1.0 + 16.0 * U),
        )
    };
    let b = [quotient(v), quotient(w)];
    (least > 0.0 && b.iter().all(|b| b.e <= tight)).then_some(b)
}

#[cold]
#[inline(never)]
fn exact_barycentric(probe: &Probe<'_>, v: &Facet) -> [EFloat; 2] {
    Isa::detect().run(
        #[inline(always)]
        || {
            struct Volumes<'a>(&'a Facet, Point3, i32);
            impl Ratios for Volumes<'_> {
                #[inline(always)]
                fn eval<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
                    volumes(self.0, ray, self.1, self.2)
                }
            }
            planar::ratios(probe, &Volumes(v, probe.ray.centre, probe.ray.scale))
        },
    )
}

/// The normal times a power of two that brings it to about unit size, if possible, and a bound on
/// its error per component.
#[inline(always)]
fn normal_and_error(v: &Facet) -> (Vec3, Vec3) {
    let (e1, e2) = (v[1] - v[0], v[2] - v[0]);
    let one = |e: Vec3| e.scale2(-exponent(e.max_abs()));
    planar::cross_and_error(one(e1), one(e2))
}

fn exact_normal(v: &Facet) -> [Dyadic; 3] {
    let edge = |to: Point3| {
        let axis = |i: usize| Dyadic::exact(to[i]) - Dyadic::exact(v[0][i]);
        [axis(0), axis(1), axis(2)]
    };
    cross(&edge(v[1]), &edge(v[2]))
}

/// The unit normal, each component within [`NORMAL`] of the exact one; one that is not zero has the
/// exact one's sign.
///
/// So a step along it never leads back through the plane, however the coordinates are rounded.
#[inline(always)]
pub(crate) fn unit_normal(v: &Facet) -> Normal3 {
    let (n, err) = normal_and_error(v);
    let size = n.max_abs();
    // Slivers lose digits to cancellation; they, and numbers near the ends of the range of f64, are
    // computed exactly.
    if size > 1e-280 && size < 1e280 && err.max_abs() <= 32.0 * U * size {
        let n = Vec3::from(core::array::from_fn(|i| if n[i].abs() > err[i] { n[i] } else { 0.0 }));
        return planar::unit(n.scale2(-durer_math::scale::exponent(size)));
    }
    let exact = exact_normal(v);
    let Some(k) = exact.iter().filter_map(Dyadic::exponent).max() else {
        return Normal3::new(0.0, 0.0, 1.0);
    };
    let k = i32::try_from(-k).unwrap_or(0);
    let [x, y, z] = exact.map(|x| Ring::scale2(x, k).to_f64());
    planar::unit(Vec3::new(x, y, z))
}

/// Position, errors, normals, texture coordinates and derivatives where the ray meets the triangle.
#[inline(always)]
pub(crate) fn resolve(probe: &Probe<'_>, v: &Facet, varying: &Varying, need: Need) -> SurfacePoint {
    resolve_from(barycentric(probe, v), v, varying, need)
}

/// [`resolve`] for a triangle that is small relative to its distance from the origin: its
/// barycentric coordinates are refined only if their error moves the point by more than a few
/// hundred roundings of its position.
#[inline(always)]
pub(crate) fn resolve_far(probe: &Probe<'_>, v: &Facet, varying: &Varying, need: Need) -> SurfacePoint {
    let edge = (v[1] - v[0]).max_abs().max((v[2] - v[0]).max_abs());
    let tight = planar::TIGHT * (v[0].to_vec().max_abs() / edge).clamp(1.0, 1e6);
    let quick = barycentric_within(probe, v, tight);
    resolve_from(quick.unwrap_or_else(|| exact_barycentric(probe, v)), v, varying, need)
}

/// [`resolve`] for coordinates `(b1, b2)` on the triangle's border that are known within a few
/// roundings more than [`planar::TIGHT`].
#[inline(always)]
pub(crate) fn resolve_at(b: [f64; 2], v: &Facet, varying: &Varying, need: Need) -> SurfacePoint {
    resolve_from(b.map(|b| EFloat::with_error(b, 2.0 * planar::TIGHT)), v, varying, need)
}

#[inline(always)]
fn resolve_from(b: [EFloat; 2], v: &Facet, varying: &Varying, need: Need) -> SurfacePoint {
    let (e1, e2) = (v[1] - v[0], v[2] - v[0]);
    let mut point = settle(v[0], [e1, e2], b, unit_normal(v));
    vary(&mut point, v, varying, b.map(|b| b.v.clamp(0.0, 1.0)), need);
    point
}

/// The point `base + b1 e1 + b2 e2` of a plane, `b1` and `b2` in `[0, 1]` known within bounds; the
/// edges are rounded at most once, and `ng` is as [`unit_normal`] makes it.
#[inline(always)]
pub(crate) fn settle(base: Point3, [e1, e2]: [Vec3; 2], [b1, b2]: [EFloat; 2], ng: Normal3) -> SurfacePoint {
    // Within the sheet, as the exact point is.
    let (x1, x2) = (b1.v.clamp(0.0, 1.0), b2.v.clamp(0.0, 1.0));
    let least = least_step(base);
    let axis = |i: usize| {
        let p = x1.mul_add(e1[i], x2.mul_add(e2[i], base[i]));
        let (m1, m2) = (x1 * e1[i].abs(), x2 * e2[i].abs());
        // Edges are rounded once; two fused steps, the inner one of size |base| + m2 at most.
        let rounding = (base[i].abs() + p.abs()).mul_add(U, (m1 + 2.0 * m2) * (2.0 * U));
        let rounding = rounding.mul_add(1.0 + 32.0 * U, least);
        let along = e1[i].abs().mul_add(b1.e, e2[i].abs() * b2.e);
        (p, rounding, along.mul_add(1.0 + 32.0 * U, rounding))
    };
    let [(x, rx, dx), (y, ry, dy), (z, rz, dz)] = [axis(0), axis(1), axis(2)];
    // Before rounding, the point lay in the plane, whatever the coordinates b: only the rounding
    // along the normal leads off it.
    let n = ng.to_vec().abs() + Vec3::new(NORMAL, NORMAL, NORMAL);
    let off = n.dot(Vec3::new(rx, ry, rz)) * (1.0 + 8.0 * U);
    SurfacePoint::new(Point3::new(x, y, z), Vec3::new(dx, dy, dz), along_rounded_normal(off), ng)
}

/// A step along [`unit_normal`] that moves by `off` along the exact normal at least: the cosine of
/// their angle is above `1 - 2 NORMAL`.
#[inline(always)]
pub(crate) fn along_rounded_normal(off: f64) -> f64 {
    off.mul_add(1.0 + 4.0 * NORMAL, f64::MIN_POSITIVE)
}

/// Shading normal, texture coordinates and derivatives at the barycentric coordinates `(b1, b2)`.
#[inline(always)]
fn vary(point: &mut SurfacePoint, v: &Facet, varying: &Varying, [b1, b2]: [f64; 2], need: Need) {
    let (e1, e2) = (v[1] - v[0], v[2] - v[0]);
    // Without texture coordinates of its own, a triangle has (0, 0), (1, 0), (0, 1).
    let uv = varying.uv.unwrap_or([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let (du1, dv1) = (uv[1][0] - uv[0][0], uv[1][1] - uv[0][1]);
    let (du2, dv2) = (uv[2][0] - uv[0][0], uv[2][1] - uv[0][1]);
    if need.contains(Need::UV) {
        point.uv = [b1.mul_add(du1, b2.mul_add(du2, uv[0][0])), b1.mul_add(dv1, b2.mul_add(dv2, uv[0][1]))];
    }
    // Change with (u, v) of something that changes by x1 and x2 along the two edges; zero if the
    // texture map is singular.
    let determinant = durer_math::eft::difference_of_products(du1, dv2, dv1, du2);
    let by_uv = |x1: Vec3, x2: Vec3| {
        if determinant == 0.0 {
            return (Vec3::ZERO, Vec3::ZERO);
        }
        ((x1 * dv2 - x2 * dv1) / determinant, (x2 * du1 - x1 * du2) / determinant)
    };
    if need.contains(Need::DERIVATIVES) {
        (point.dpdu, point.dpdv) = by_uv(e1, e2);
    }
    let Some([n0, n1, n2]) = varying.normals else { return };
    if !need.contains(Need::SHADING_NORMAL) && !need.contains(Need::DERIVATIVES) {
        return;
    }
    let sum = n0 * (1.0 - b1 - b2) + n1 * b1 + n2 * b2;
    let Some(unit) = sum.normalized() else { return };
    let side = if unit.dot(point.ng.to_vec()) < 0.0 { -1.0 } else { 1.0 };
    point.ns = unit * side;
    if need.contains(Need::DERIVATIVES) {
        // The change of the unit normal is the change of the sum across it, over the sum's length.
        let length = sum.to_vec().length();
        let across = |x: Normal3| {
            let x = x.to_vec() * (side / length);
            x - point.ns.to_vec() * point.ns.dot(x)
        };
        (point.dndu, point.dndv) = by_uv(across(n1 - n0), across(n2 - n0));
    }
}
