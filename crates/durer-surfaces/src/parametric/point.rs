//! Points of a sheet, and normals where its slopes vanish.

use super::piece::Face;
use super::sheet::Sheet;
use crate::point::least_step;
use crate::{LocalRay, Root, SurfacePoint};
use durer_formula::lanes;
use durer_math::eft::{scale2, two_sum};
use durer_math::scale::pow2;
use durer_math::{Point3, U, Vec3};

/// Covers results below the normal range, in units.
const TINY: f64 = pow2(-500);
/// The least distance at which rays start from the surface, in units: far enough for f64 to decide
/// on which side of a crossing's bracket the start is.
const CLEAR: f64 = 256.0 * U;
/// Slopes span no plane if the area between them is at most this, relative to the product of their
/// magnitudes.
const FLAT: f64 = pow2(-36);
/// The distance to neighbouring samples, in widths of the domain: for second derivatives, which
/// need not be accurate, and for the limit of normals at a pole.
const ASIDE: f64 = pow2(-18);

/// A point and its slopes, in units, by parameters from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct Jet {
    p: Vec3,
    pu: Vec3,
    pv: Vec3,
}

impl Jet {
    /// `S_u x S_v`.
    fn area(&self) -> Vec3 {
        self.pu.cross(self.pv)
    }

    fn unit_normal(&self) -> Option<Vec3> {
        let n = self.area();
        Some(n * (1.0 / n.length())).filter(|n| n.is_finite() && *n != Vec3::ZERO)
    }

    /// Whether the slopes span a plane; `most` is the area of the largest ones near by.
    fn is_regular(&self, most: f64) -> bool {
        self.area().max_abs() > FLAT * most
    }
}

impl Sheet {
    fn jet(&self, face: &Face, uv: [f64; 2]) -> Jet {
        let jets = face.tape.jet(uv);
        let back = |x: f64| scale2(x, -self.unit.scale);
        let slope = |k: usize| {
            let width = face.domain[k][1] - face.domain[k][0];
            let of = |c: usize| back(jets[c].d.d[k]) * width;
            Vec3::new(of(0), of(1), of(2))
        };
        let p = |c: usize| back(jets[c].v - self.unit.centre[c]);
        Jet { p: Vec3::new(p(0), p(1), p(2)), pu: slope(0), pv: slope(1) }
    }

    /// How far the rounded point of these parameters is from the exact one, in units.
    fn error(&self, face: &Face, uv: [f64; 2]) -> f64 {
        let points = face.tape.bounds(&lanes(&[uv.map(|x| [x, x]); 8]));
        (0..3).map(|c| scale2(points[c].hi.0[0] - points[c].lo.0[0], -self.unit.scale)).sum::<f64>() + 4.0 * U
    }

    /// The point of a root: with its bounds and its normal, and slopes along the parameters.
    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root) -> SurfacePoint {
        let Some(face) = self.faces.get(root.face as usize) else {
            return SurfacePoint::unknown(self.centre);
        };
        let at = ray.recentre(self.centre, self.unit.scale).sharp(1.0);
        let s = root.s;
        let q = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_q = at.o_err + at.d_err * s.abs() + q.abs() * U;
        let jet = self.jet(face, root.tag);
        let y = if jet.p.is_finite() { jet.p } else { q };

        // In the surface's own frame; the rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, self.back(y));
        let ((px, lx), (py, ly), (pz, lz)) =
            (axis(self.centre.x, y.x), axis(self.centre.y, y.y), axis(self.centre.z, y.z));
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -self.unit.scale) + TINY);
        // The exact crossing is on the ray, within its bracket.
        let width = at.width(root);
        let dp = ((y - q).abs() + e_q + at.d.abs() * width + lost) * (1.0 + 16.0 * U);

        let (n, bend) = self.normal(face, root.tag, &jet);
        let n = n.map(|n| if self.is_turned(root.face) { -n } else { n });
        let n = n.unwrap_or_else(|| at.d * (-1.0 / at.d.length()));
        let tau = scale2(p.to_vec().max_abs(), -self.unit.scale) * (6.0 * U) + TINY;
        let eta = lost.x + lost.y + lost.z + self.error(face, root.tag);
        let clear = CLEAR * (1.0 + y.max_abs());
        let off = 2.0 * eta + clear + bend.min(1.0 / tau) * tau * tau;
        let is_tip = (bend * off).is_nan() || bend * off > 1.0 / 64.0;
        let mut point = SurfacePoint::new(
            p,
            dp.map(|x| self.back(x) + f64::MIN_POSITIVE),
            self.back(off) + least_step(p),
            n.to_normal(),
        );
        (point.bend, point.slack) = if is_tip {
            (f64::INFINITY, self.back(off / 64.0))
        } else {
            (scale2(bend, -self.unit.scale), 0.0)
        };
        point.uv = root.tag;
        let slope =
            |d: Vec3, k: usize| d.map(|x| self.back(x)) * (1.0 / (face.domain[k][1] - face.domain[k][0]));
        point.dpdu = slope(jet.pu, 0);
        point.dpdv = slope(jet.pv, 1);
        point
    }

    /// The unit normal, and twice the largest normal curvature there or close by; infinite without a
    /// tangent plane.
    ///
    /// Where `S_u x S_v` vanishes, at a pole, it is the limit from the middle of the domain: that of
    /// two places, one twice as far as the other, extrapolated.
    fn normal(&self, face: &Face, uv: [f64; 2], jet: &Jet) -> (Option<Vec3>, f64) {
        let width = [0, 1].map(|k: usize| face.domain[k][1] - face.domain[k][0]);
        // Towards the middle, where the formula is known.
        let inward = [0, 1].map(|k: usize| {
            let middle = 0.5 * face.domain[k][0] + 0.5 * face.domain[k][1];
            if uv[k] > middle { -ASIDE } else { ASIDE }
        });
        let beside = |a: f64, b: f64| {
            let x = [uv[0] + a * inward[0] * width[0], uv[1] + b * inward[1] * width[1]];
            self.jet(face, x)
        };
        let (far_u, far_v) = (beside(1.0, 0.0), beside(0.0, 1.0));
        let near = beside(1.0, 1.0);
        let longest = |d: fn(&Jet) -> Vec3| d(jet).max_abs().max(d(&near).max_abs());
        let most = longest(|j| j.pu) * longest(|j| j.pv);
        if jet.is_regular(most)
            && let Some(n) = jet.unit_normal()
        {
            let along = |far: &Jet, by: f64| ((far.pu - jet.pu) * (1.0 / by), (far.pv - jet.pv) * (1.0 / by));
            let ((puu, puv), (_, pvv)) = (along(&far_u, inward[0]), along(&far_v, inward[1]));
            return (Some(n), bend(jet, n, [puu, puv, pvv]));
        }
        let limit = match (near.unit_normal(), beside(2.0, 2.0).unit_normal()) {
            (Some(near), Some(far)) => {
                let n = near * 2.0 - far;
                Some(n * (1.0 / n.length()))
            }
            (near, far) => near.or(far),
        };
        (limit, f64::INFINITY)
    }
}

/// Twice the largest normal curvature.
fn bend(jet: &Jet, n: Vec3, [puu, puv, pvv]: [Vec3; 3]) -> f64 {
    let (e, f, g) = (jet.pu.dot(jet.pu), jet.pu.dot(jet.pv), jet.pv.dot(jet.pv));
    let (l, m, k) = (n.dot(puu), n.dot(puv), n.dot(pvv));
    let det = jet.area().length_squared();
    let mean = (e * k - 2.0 * f * m + g * l) / (2.0 * det);
    let gauss = (l * k - m * m) / det;
    let bend = 2.0 * (mean.abs() + (mean * mean - gauss).max(0.0).sqrt());
    if bend.is_finite() { bend } else { f64::INFINITY }
}
