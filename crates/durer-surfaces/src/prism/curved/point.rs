//! The point of a root on a curved wall: its bounds, normal and derivatives.

use super::Sweep;
use super::profile_curve::{ProfileCurve, View};
use crate::point::least_step;
use crate::{LocalRay, Need, Root, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{EFloat, Isa, Point3, Ring, U, Vec3};

/// Covers results below the normal range, in units of the prism's size.
const TINY: f64 = durer_math::scale::pow2(-500);
/// The least distance at which rays start from the surface, in units of the prism's size: far
/// enough for f64 to decide on which side of a crossing's bracket the start is. At a grazing ray
/// the bracket is wider by as much as the path from the surface to the start is longer.
const CLEAR: f64 = 256.0 * U;

/// The piece that contains a root, with its place among the outlines, and the heights.
pub(super) struct Wall<'a> {
    pub(super) view: &'a View,
    pub(super) piece: &'a ProfileCurve,
    /// Whether the inside is to the left of the piece, seen from above.
    pub(super) inside_is_left: bool,
    /// The number of the piece, and the number of pieces.
    pub(super) number: (usize, usize),
    /// The bottom and the top, in the prism's own coordinates.
    pub(super) heights: [f64; 2],
}

impl Wall<'_> {
    pub(super) fn resolve(&self, ray: &LocalRay<'_>, root: &Root, y: f64, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.resolve_here(ray, root, y, need),
        )
    }

    /// The parameter near `y` at which the curve is nearest to a point: one step of Newton's
    /// method, if it is a small one.
    #[inline(always)]
    fn nearest(&self, [x, z]: [f64; 2], y: f64) -> f64 {
        let [cx, cz] = ProfileCurve::at(&self.piece.powers, &EFloat::exact(y)).map(|c| c.v);
        let ([x1, z1], _) = self.piece.slopes(self.view, y);
        let step = ((x - cx) * x1 + (z - cz) * z1) / (x1 * x1 + z1 * z1);
        let moved = (y + step).clamp(-0.5, 0.5);
        if step.abs() < durer_math::scale::pow2(-20) { moved } else { y }
    }

    #[inline(always)]
    fn resolve_here(&self, ray: &LocalRay<'_>, root: &Root, y: f64, need: Need) -> SurfacePoint {
        let View { sweep, centre, scale } = *self.view;
        let at = ray.recentre(centre, scale);
        let s = root.s;
        let q = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_q = at.o_err + at.d_err * s.abs() + q.abs() * U;

        // The point on the f64 curve at the ray's height, nearest to the ray's own point: the
        // root's bracket is more precise than `u`.
        let height = if sweep == Sweep::Conic { q.y } else { 1.0 };
        let y = self.nearest([q.x / height, q.z / height], y);
        let [x, z] =
            ProfileCurve::at(&self.piece.powers, &EFloat::exact(y)).map(|c| c * EFloat::exact(height));
        let p = Vec3::new(x.v, q.y, z.v);

        // In the surface's own frame; the rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
        let ((px, lx), (py, ly), (pz, lz)) = (axis(centre.x, p.x), axis(centre.y, p.y), axis(centre.z, p.z));
        let place = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);
        let width = at.width(root);
        let dp = (e_q + at.d.abs() * width + (p - q).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

        let ([x1, z1], [x2, z2]) = self.piece.slopes(self.view, y);
        let [cx, cz] = [x.v / height, z.v / height];
        // The right of the curve, and the outward side of the wall; c' x C for a conic sweep.
        let side = if self.inside_is_left { 1.0 } else { -1.0 };
        let side = if height < 0.0 { -side } else { side };
        let (right, turn, ruling) = match sweep {
            Sweep::Linear => (Vec3::new(z1, 0.0, -x1), Vec3::new(z2, 0.0, -x2), Vec3::Y),
            Sweep::Conic => (
                Vec3::new(z1, x1 * cz - z1 * cx, -x1),
                Vec3::new(z2, x2 * cz - z2 * cx, -x2),
                Vec3::new(cx, 1.0, cz),
            ),
        };
        let scaled = right.max_abs();
        let plain = scaled > TINY && scaled.is_finite();
        // At a cusp of the curve there is no normal: use the one across the chord.
        let [a, b] = [self.piece.points[0], self.piece.points[3]];
        let fallback = Vec3::new(b[1] - a[1], 0.0, a[0] - b[0]);
        let across = if plain {
            right * (1.0 / scaled)
        } else if fallback.max_abs() > 0.0 {
            fallback * (1.0 / fallback.max_abs())
        } else {
            Vec3::X
        };
        let length = across.length();
        let normal = across * (side / length);
        // Along the ruling a wall is straight. Across it the curvature is c''·n G / (E G - F²),
        // with E, F, G the first fundamental form of (u, height): the cross product of the tangents
        // is `right` times the height, its square E G - F².
        let size = length * scaled;
        let bend = if plain {
            let second = x2 * normal.x + z2 * normal.z;
            second.abs() * ruling.length_squared() / (size * size * height.abs()) * (1.0 + 1.0 / 256.0)
        } else {
            f64::INFINITY
        };

        let tau = scale2(place.to_vec().max_abs(), -scale) * (6.0 * U) + TINY;
        let eta = x.e + z.e + lost.x + lost.y + lost.z;
        let off = 2.0 * eta + CLEAR * (1.0 + p.abs().max_abs()) + bend.min(1.0 / tau) * tau * tau;
        let back = |x: f64| scale2(x, scale);
        let tip = bend.is_nan() || bend * off > 1.0 / 64.0;
        let mut point = SurfacePoint::new(
            place,
            dp.map(|x| back(x) + f64::MIN_POSITIVE),
            back(off) + least_step(place),
            normal.to_normal(),
        );
        (point.bend, point.slack) =
            if tip { (f64::INFINITY, back(off / 64.0)) } else { (scale2(bend, -scale), 0.0) };

        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (i, n) = (self.number.0 as f64, self.number.1 as f64);
            let [low, high] = self.heights;
            let v = ((place.y - low) / (high - low)).clamp(0.0, 1.0);
            point.uv = [(i + (0.5 + y).clamp(0.0, 1.0)) / n, v];
            if need.contains(Need::DERIVATIVES) {
                let along = Vec3::new(x1, 0.0, z1) * (n * height);
                (point.dpdu, point.dpdv) = (along.map(back), ruling * (high - low));
                // The normal changes with `right`; along the ruling it is constant.
                let dn = turn * (side * n / size);
                let dn = dn - normal * normal.dot(dn);
                point.dndu = if dn.is_finite() { dn } else { Vec3::ZERO };
            }
        }
        point
    }
}
