//! The point of a root on a lathe: its bounds, normal and derivatives.

use super::Lathe;
use super::profile::Piece;
use crate::point::least_step;
use crate::{LocalRay, Need, Root, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{EFloat, Isa, Point3, U, Vec3, elementary};

/// Covers results below the normal range, in units of the lathe's size.
const TINY: f64 = durer_math::scale::pow2(-500);
/// The least distance at which rays start from the surface, in units of the lathe's size: far
/// enough for f64 to decide on which side of a crossing's bracket the start is.
const CLEAR: f64 = 256.0 * U;
/// Once round the axis.
const TURN: f64 = 2.0 * core::f64::consts::PI;

impl Lathe {
    pub(super) fn resolve_root(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let number = root.tag[0] as usize;
        match self.pieces.get(number / 2) {
            Some(piece) => Isa::detect().run(
                #[inline(always)]
                || self.point(ray, root, need, (number / 2, piece), number % 2 == 1),
            ),
            // Not a root of this surface: nothing can be computed.
            None => SurfacePoint::unknown(self.centre()),
        }
    }

    /// The parameter near `w` at which the profile is nearest to a point `[r, y]`: one step of
    /// Newton's method, if it comes nearer. The bound of the position holds for any parameter.
    #[inline(always)]
    fn nearest(piece: &Piece, [r, y]: [f64; 2], w: f64) -> f64 {
        let from = |w: f64| {
            let [[cr, cy], [r1, y1], _] = piece.slopes(w);
            let (cr, r1) = if cr < 0.0 { (-cr, -r1) } else { (cr, r1) };
            ([r - cr, y - cy], [r1, y1])
        };
        let ([dr, dy], [r1, y1]) = from(w);
        let step = (dr * r1 + dy * y1) / (r1 * r1 + y1 * y1);
        let moved = (w + step).clamp(-0.5, 0.5);
        let ([er, ey], _) = from(moved);
        if er * er + ey * ey < dr * dr + dy * dy { moved } else { w }
    }

    #[inline(always)]
    fn point(
        &self,
        ray: &LocalRay<'_>,
        root: &Root,
        need: Need,
        (i, piece): (usize, &Piece),
        outside_is_right: bool,
    ) -> SurfacePoint {
        let (centre, scale) = (self.centre(), self.profile.scale);
        let at = ray.recentre(centre, scale);
        let s = root.s;
        let q = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_q = at.o_err + at.d_err * s.abs() + q.abs() * U;

        // The profile's point nearest to the ray's, in the half plane of that: the root's bracket
        // is more precise than `w`.
        let rho = elementary::hypot(q.x, q.z);
        let (ox, oz) = if rho > 0.0 { (q.x / rho, q.z / rho) } else { (1.0, 0.0) };
        let w = Self::nearest(piece, [rho, q.y], root.tag[1]);
        let (powers_r, powers_y) = piece.running();
        let exact = EFloat::with_error(w, 0.0);
        let (r, y) = (Piece::at(&powers_r, &exact), Piece::at(&powers_y, &exact));
        let lobe = if r.v < 0.0 { -1.0 } else { 1.0 };
        let radius = r.v.abs();
        let p = Vec3::new(ox * radius, y.v, oz * radius);

        // In the surface's own frame; the rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
        let ((px, lx), (py, ly), (pz, lz)) = (axis(centre.x, p.x), axis(centre.y, p.y), axis(centre.z, p.z));
        let place = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);
        let width = at.width(root);
        let dp = (e_q + at.d.abs() * width + (p - q).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

        // The right of the profile: (y', -r').
        let [_, [r1, y1], [r2, y2]] = piece.slopes(w);
        let (r1, r2) = (lobe * r1, lobe * r2);
        let side = if outside_is_right { 1.0 } else { -1.0 };
        let speed = r1.abs().max(y1.abs());
        let plain = speed > TINY && speed.is_finite();
        // At a cusp of the profile there is no normal: use the one across the chord.
        let (nr, ny) = if plain { (y1 / speed, -r1 / speed) } else { self.across_chord(i, lobe) };
        let length = elementary::hypot(nr, ny);
        let (nr, ny) = (side * nr / length, side * ny / length);
        let size = length * speed;

        // Curvatures: along the profile, and round the axis.
        let along = (nr * r2 + ny * y2).abs() / (size * size);
        let round = if nr == 0.0 {
            0.0
        } else if radius > 0.0 {
            nr.abs() / radius
        } else {
            f64::INFINITY
        };
        // At a smooth pole both become equal.
        let round = if radius < durer_math::scale::pow2(-20) && y1.abs() <= along * size * radius * 4.0 {
            along
        } else {
            round
        };
        let bend = if plain { along.max(round) * (1.0 + 1.0 / 256.0) } else { f64::INFINITY };

        let tau = scale2(place.to_vec().max_abs(), -scale) * (6.0 * U) + TINY;
        let eta = r.e + y.e + 8.0 * U * radius + lost.x + lost.y + lost.z;
        let off = 2.0 * eta + CLEAR * (1.0 + p.abs().max_abs()) + bend.min(1.0 / tau) * tau * tau;
        let tip = bend.is_nan() || bend * off > 1.0 / 64.0;
        let mut normal = Vec3::new(nr * ox, ny, nr * oz);
        let mut off = off;
        if tip && radius < 64.0 * off && ny != 0.0 {
            // The tip of a cone is left along the axis.
            normal = Vec3::new(0.0, 1.0_f64.copysign(ny), 0.0);
            off *= 2.0 / ny.abs().max(durer_math::scale::pow2(-10));
        }
        let back = |x: f64| scale2(x, scale);
        let mut point = SurfacePoint::new(
            place,
            dp.map(|x| back(x) + f64::MIN_POSITIVE),
            back(off) + least_step(place),
            normal.to_normal(),
        );
        (point.bend, point.slack) =
            if tip { (f64::INFINITY, back(off / 64.0)) } else { (scale2(bend, -scale), 0.0) };

        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let count = self.profile.len() as f64;
            let longitude = if rho > 0.0 { elementary::atan2(q.z, q.x) / TURN } else { 0.0 };
            let longitude = if longitude < 0.0 { longitude + 1.0 } else { longitude };
            point.uv = [longitude, ((i as f64 + (0.5 + w).clamp(0.0, 1.0)) / count).min(1.0)];
            if need.contains(Need::DERIVATIVES) {
                let east = Vec3::new(-oz, 0.0, ox);
                let round = TURN * if radius > 0.0 { radius } else { 1.0 };
                point.dpdu = (east * round).map(back);
                point.dpdv = Vec3::new(ox * r1, y1, oz * r1).map(|x| back(x * count));
                point.dndu = east * (TURN * nr);
                let turn = Vec3::new(ox * y2, -r2, oz * y2) * (side * count / size);
                let turn = turn - normal * normal.dot(turn);
                point.dndv = if turn.is_finite() { turn } else { Vec3::ZERO };
            }
        }
        point
    }

    /// A vector to the right of a piece's chord, not zero.
    fn across_chord(&self, i: usize, lobe: f64) -> (f64, f64) {
        let (a, b) = (self.profile.end(i, false), self.profile.end(i, true));
        let (nr, ny) = (b[1] - a[1], -lobe * (b[0] - a[0]));
        let size = nr.abs().max(ny.abs());
        if size > 0.0 && size.is_finite() { (nr / size, ny / size) } else { (1.0, 0.0) }
    }
}
