//! Points of a patch, and normals where its slopes vanish.

use super::cell::{MOST, basis, sums};
use super::net::Homogeneous;
use super::shell::{Face, Shell};
use crate::point::least_step;
use crate::{LocalRay, Need, Root, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Isa, Point3, U, Vec3};

/// Covers results below the normal range, in units.
const TINY: f64 = durer_math::scale::pow2(-500);
/// The least distance at which rays start from the surface, in units: far enough for f64 to decide
/// on which side of a crossing's bracket the start is.
const CLEAR: f64 = 256.0 * U;
/// Slopes span no plane if the area between them is at most this, relative to the product of their
/// magnitudes.
const FLAT: f64 = durer_math::scale::pow2(-36);
/// The distance, in parameters, from a point without a tangent plane at which one is evaluated
/// instead.
const ASIDE: f64 = durer_math::scale::pow2(-10);

/// A point of a patch with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) p: Vec3,
    pub(super) pu: Vec3,
    pub(super) pv: Vec3,
    puu: Vec3,
    puv: Vec3,
    pvv: Vec3,
}

impl Jet {
    /// `S_u x S_v`.
    #[inline(always)]
    fn area(&self) -> Vec3 {
        self.pu.cross(self.pv)
    }

    /// The derivative of `S_u x S_v` along a direction of the parameters.
    #[inline(always)]
    fn area_along(&self, [du, dv]: [f64; 2]) -> Vec3 {
        (self.puu.cross(self.pv) + self.pu.cross(self.puv)) * du
            + (self.puv.cross(self.pv) + self.pu.cross(self.pvv)) * dv
    }

    /// A bound on the normal curvatures, twice the largest; infinite without a tangent plane.
    #[inline(always)]
    fn bend(&self, n: Vec3) -> f64 {
        let (e, f, g) = (self.pu.dot(self.pu), self.pu.dot(self.pv), self.pv.dot(self.pv));
        let (l, m, k) = (n.dot(self.puu), n.dot(self.puv), n.dot(self.pvv));
        let det = self.area().length_squared();
        let mean = (e * k - 2.0 * f * m + g * l) / (2.0 * det);
        let gauss = (l * k - m * m) / det;
        let bend = 2.0 * (mean.abs() + (mean * mean - gauss).max(0.0).sqrt());
        if bend.is_finite() { bend } else { f64::INFINITY }
    }
}

impl Face {
    /// The point at `uv` and its derivatives, in units.
    #[inline(always)]
    pub(super) fn jet(&self, uv: [f64; 2]) -> Jet {
        let [nu, nv] = self.size;
        let (bu, bv) = (powers(nu, uv[0]), powers(nv, uv[1]));
        // By the number of times along u and v.
        let mut all = [[[0.0_f64; 4]; 3]; 3];
        for (j, row) in self.net.chunks_exact(nu).enumerate() {
            let mut along = [[0.0_f64; 4]; 3];
            for (i, p) in row.iter().enumerate() {
                for (order, sum) in along.iter_mut().enumerate() {
                    for c in 0..4 {
                        sum[c] = p[c].mul_add(bu[order][i], sum[c]);
                    }
                }
            }
            for a in 0..3 {
                for b in 0..3 - a {
                    for c in 0..4 {
                        all[a][b][c] = along[a][c].mul_add(bv[b][j], all[a][b][c]);
                    }
                }
            }
        }
        let vector = |p: Homogeneous<f64>| Vec3::new(p[0], p[1], p[2]);
        let [[s, sv, svv], [su, suv, _], [suu, ..]] = all;
        let w = 1.0 / s[3];
        let p = vector(s) * w;
        let pu = (vector(su) - p * su[3]) * w;
        let pv = (vector(sv) - p * sv[3]) * w;
        Jet {
            p,
            pu,
            pv,
            puu: (vector(suu) - pu * (2.0 * su[3]) - p * suu[3]) * w,
            puv: (vector(suv) - pu * sv[3] - pv * su[3] - p * suv[3]) * w,
            pvv: (vector(svv) - pv * (2.0 * sv[3]) - p * svv[3]) * w,
        }
    }

    /// The unit normal at `uv`, and a jet of a tangent plane there or close by.
    ///
    /// Where an edge is collapsed to a point, `S_u x S_v` vanishes; its limit from the middle of the
    /// patch is the direction of its own derivative, unless that vanishes too.
    #[inline(always)]
    pub(super) fn normal(&self, uv: [f64; 2], jet: &Jet) -> Option<(Vec3, Jet)> {
        let middle = self.middle();
        let inward = [middle[0] - uv[0], middle[1] - uv[1]];
        let unit = |v: Vec3| Some(v * (1.0 / v.length())).filter(|n| n.is_finite() && *n != Vec3::ZERO);
        let beside = self.jet([ASIDE * inward[0] + uv[0], ASIDE * inward[1] + uv[1]]);
        let most = jet.pu.max_abs().max(beside.pu.max_abs()) * jet.pv.max_abs().max(beside.pv.max_abs());
        let n = jet.area();
        if n.max_abs() > FLAT * most {
            return unit(n).map(|n| (n, *jet));
        }
        let n = jet.area_along(inward);
        if n.max_abs() > FLAT * most {
            return unit(n).map(|n| (n, beside));
        }
        unit(beside.area()).map(|n| (n, beside))
    }
}

/// The Bernstein polynomials of `n` points at `t` and their first two derivatives.
#[inline(always)]
fn powers(n: usize, t: f64) -> [[f64; MOST]; 3] {
    let (b, d) = basis(n, t);
    let mut dd = [0.0; MOST];
    if n > 2 {
        let (_, lower) = basis(n - 1, t);
        for i in 0..n {
            let before = if i > 0 { lower[i - 1] } else { 0.0 };
            let here = if i + 1 < n { lower[i] } else { 0.0 };
            dd[i] = (n - 1) as f64 * (before - here);
        }
    }
    [b, d, dd]
}

impl Jet {
    /// A point with slopes, without second derivatives.
    pub(super) fn flat(p: Vec3, pu: Vec3, pv: Vec3) -> Self {
        let unknown = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
        Self { p, pu, pv, puu: unknown, puv: unknown, pvv: unknown }
    }

    /// The jet of the surface moved by `base`, for parameters that are `width` times the present
    /// ones.
    pub(super) fn moved(self, base: Vec3, width: f64) -> Self {
        let (by, by2) = (1.0 / width, 1.0 / (width * width));
        Self {
            p: base + self.p,
            pu: self.pu * by,
            pv: self.pv * by,
            puu: self.puu * by2,
            puv: self.puv * by2,
            pvv: self.pvv * by2,
        }
    }
}

/// The point of a root, with its bounds, normal and slopes along the parameters. `jet` is the
/// surface there, in units of `2^scale` about a centre, with the error `eta`; the normal is that of
/// a jet there or close by.
#[inline(always)]
pub(super) fn located(
    (centre, scale): (Point3, i32),
    (ray, root): (&LocalRay<'_>, &Root),
    jet: &Jet,
    normal: Option<(Vec3, Jet)>,
    eta: f64,
) -> SurfacePoint {
    let at = ray.recentre(centre, scale).sharp(1.0);
    let s = root.s;
    let q = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
    let e_q = at.o_err + at.d_err * s.abs() + q.abs() * U;
    let y = jet.p;

    // In the surface's own frame; the rounding is known exactly.
    let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
    let ((px, lx), (py, ly), (pz, lz)) = (axis(centre.x, y.x), axis(centre.y, y.y), axis(centre.z, y.z));
    let p = Point3::new(px, py, pz);
    let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);
    // The exact crossing is on the ray, within its bracket.
    let width = at.width(root);
    let dp = ((y - q).abs() + e_q + at.d.abs() * width + lost) * (1.0 + 16.0 * U);

    let (n, tangent) = match normal {
        Some((n, near)) => (n, Some(near)),
        None => (at.d * (-1.0 / at.d.length()), None),
    };
    let bend = tangent.map_or(f64::INFINITY, |jet| jet.bend(n));
    let tau = scale2(p.to_vec().max_abs(), -scale) * (6.0 * U) + TINY;
    let eta = lost.x + lost.y + lost.z + eta;
    let clear = CLEAR * (1.0 + y.max_abs());
    let off = 2.0 * eta + clear + bend.min(1.0 / tau) * tau * tau;
    let back = |x: f64| scale2(x, scale);
    let is_tip = (bend * off).is_nan() || bend * off > 1.0 / 64.0;
    let mut point = SurfacePoint::new(
        p,
        dp.map(|x| back(x) + f64::MIN_POSITIVE),
        back(off) + least_step(p),
        n.to_normal(),
    );
    (point.bend, point.slack) =
        if is_tip { (f64::INFINITY, back(off / 64.0)) } else { (scale2(bend, -scale), 0.0) };
    point.uv = root.tag;
    point.dpdu = jet.pu.map(back);
    point.dpdv = jet.pv.map(back);
    point
}

impl Shell {
    /// The point of a root: with its bounds and its normal, and slopes along the parameters.
    #[inline(never)]
    pub(crate) fn point(&self, ray: &LocalRay<'_>, root: &Root) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.point_here(ray, root),
        )
    }

    #[inline(always)]
    fn point_here(&self, ray: &LocalRay<'_>, root: &Root) -> SurfacePoint {
        let Some(face) = self.faces.get(root.face as usize) else {
            return SurfacePoint::unknown(self.centre);
        };
        let jet = face.jet(root.tag);
        // The evaluation, and the rounding of the control points.
        let eta = (2.0 * sums(face.size) + 8.0) * U * face.largest / face.lightest;
        let normal = face.normal(root.tag, &jet);
        let normal = normal.map(|(n, near)| (if face.is_turned { -n } else { n }, near));
        located((self.centre, self.scale), (ray, root), &jet, normal, eta)
    }
}

impl SurfacePoint {
    /// Replaces slopes along the parameters by those along other coordinates, whose slopes along
    /// the parameters are given.
    pub(crate) fn change_parameters(&mut self, [[p, q], [r, s]]: [[f64; 2]; 2], need: Need) {
        let det = p * s - q * r;
        if need.contains(Need::DERIVATIVES) && det != 0.0 {
            let (du, dv, by) = (self.dpdu, self.dpdv, 1.0 / det);
            self.dpdu = (du * s - dv * r) * by;
            self.dpdv = (dv * p - du * q) * by;
        }
    }
}
