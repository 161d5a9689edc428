//! A blob at a point: the sum of the fields, its gradient, and bounds of its second derivatives.

use super::Blob;
use crate::faces::chart::tangents;
use crate::point::least_step;
use crate::{LocalPoint, LocalRay, Need, Root, Side, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Isa, Point3, U, Vec3};

/// Bounds around a point hold up to this distance along any axis, in units.
pub(super) const ROOM: f64 = durer_math::scale::pow2(-16);
/// Covers underflow.
const TINY: f64 = durer_math::scale::pow2(-500);

/// The threshold minus the sum of the fields: negative inside.
pub(super) struct Near {
    pub(super) value: f64,
    pub(super) error: f64,
    pub(super) gradient: Vec3,
    pub(super) gradient_err: f64,
    /// A bound on the norm of the second derivatives within [`ROOM`].
    pub(super) bend: f64,
}

impl Blob {
    /// The values at `y`, each coordinate of which is known within `e`.
    #[inline(always)]
    pub(super) fn near(&self, y: Vec3, e: f64) -> Near {
        let mut sum =
            Near { value: self.threshold, error: 0.0, gradient: Vec3::ZERO, gradient_err: 0.0, bend: 0.0 };
        let (mut size, mut count) = (self.threshold, 4.0);
        self.tree.near(
            y,
            e + ROOM,
            #[inline(always)]
            |i| {
                let part = &self.parts[i];
                let added = part.added(y, e);
                sum.value -= added.value;
                sum.error += added.error;
                sum.gradient -= added.gradient;
                sum.gradient_err += added.gradient_err;
                sum.bend += part.bend;
                size += added.value.abs();
                count += 1.0;
            },
        );
        sum.error = (count * U).mul_add(size, sum.error) * (1.0 + (count + 8.0) * U);
        sum.bend *= 1.0 + count * U;
        sum
    }

    /// The fields that reach a point of the blob's own frame near its surface: for each the
    /// component's number in the caller's list, and the rounded value of its field.
    pub fn fields_at(&self, p: Point3, mut take: impl FnMut(usize, f64)) {
        let y = (p - self.centre).map(|x| scale2(x, -self.scale));
        Isa::detect().run(
            #[inline(always)]
            || {
                self.tree.near(
                    y,
                    ROOM,
                    #[inline(always)]
                    |i| {
                        let value = self.parts[i].added(y, 0.0).value;
                        if value != 0.0 {
                            take(self.numbers[i] as usize, value);
                        }
                    },
                );
            },
        );
    }

    /// The sign of the threshold minus the sum, if it is certain.
    #[inline(always)]
    fn is_out(&self, y: Vec3, e: f64) -> Option<bool> {
        let near = self.near(y, e);
        (near.value.abs() > near.error).then_some(near.value > 0.0)
    }

    pub(super) fn side_of(&self, point: &LocalPoint<'_>) -> Side {
        let (y, e) = point.relative_to(self.centre, self.scale);
        // Also for points far outside the boxes.
        let out = Isa::detect().run(
            #[inline(always)]
            || self.is_out(y, e.max_abs()),
        );
        match out {
            Some(true) => Side::Out,
            Some(false) => Side::In,
            None => Side::On,
        }
    }

    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.point_here(ray, root, need),
        )
    }

    #[inline(always)]
    fn point_here(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let at = ray.recentre(self.centre, self.scale).sharp(1.0);
        let s = root.s;
        let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;
        let (y1, near) = self.projected(y);
        // The frame's numbers; their rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, self.scale));
        let ((px, lx), (py, ly), (pz, lz)) =
            (axis(self.centre.x, y1.x), axis(self.centre.y, y1.y), axis(self.centre.z, y1.z));
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -self.scale) + TINY);
        let width = at.width(root);
        let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

        // A start at `p ± off n + τ`, with `τ` the rounding away from the surface, has `|f| >= off
        // |G| - h (off² + |τ|²) - η`; see `off` of quadrics.
        let tau = scale2(p.to_vec().max_abs(), -self.scale) * (6.0 * U) + TINY;
        let g = near.gradient;
        let length = g.length();
        let sure = length * (1.0 - 1.0 / (1u64 << 20) as f64) - 2.0 * near.gradient_err;
        let away = 2.0 * (g.abs().dot(lost) + near.bend * (lost.dot(lost) + tau * tau));
        let eta = near.value.abs() + 2.0 * near.error + away;
        let square = sure * sure - 4.0 * near.bend * eta;
        let back = |x: f64| scale2(x, self.scale);
        let off = 2.0 * eta / (sure + square.max(0.0).sqrt()) * (1.0 + 64.0 * U);
        let plain = sure > 0.0 && near.bend * (2.0 * eta) < sure * sure / 64.0 && off + tau < ROOM / 4.0;
        let n = g * (1.0 / length);
        let n = if n.is_finite() { n } else { at.d * (-1.0 / at.d.length()) };
        let off = if plain { off } else { self.leave(y1, n, lost.max_abs() + tau) };
        let least = if plain { f64::MIN_POSITIVE } else { least_step(p) };
        let dp = dp.map(|x| back(x) + f64::MIN_POSITIVE);
        let mut point = SurfacePoint::new(p, dp, back(off) + least, n.to_normal());
        (point.bend, point.slack) = if plain {
            (scale2(near.bend / sure * (1.0 + 1.0 / 1024.0), -self.scale), 0.0)
        } else {
            (f64::INFINITY, back(off / 64.0))
        };
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (u, v) = tangents(n);
            point.uv = [u.dot(p.to_vec()), v.dot(p.to_vec())];
            (point.dpdu, point.dpdv) = (u, v);
        }
        point
    }

    /// `y` moved onto the surface by Newton's method along the gradient, as long as that helps.
    #[inline(always)]
    fn projected(&self, mut y: Vec3) -> (Vec3, Near) {
        let mut near = self.near(y, 0.0);
        for _ in 0..16 {
            if near.value.abs() <= 2.0 * near.error {
                break;
            }
            let step = near.gradient * (near.value / near.gradient.dot(near.gradient));
            let moved = y - step;
            if !(moved.is_finite() && step.max_abs() < 0.25) {
                break;
            }
            let there = self.near(moved, 0.0);
            if there.value.abs() >= near.value.abs() {
                break;
            }
            (y, near) = (moved, there);
        }
        (y, near)
    }

    /// The distance along `n`, either way, at which the sign is certain, also for all points within
    /// `e` and a 64th of the way.
    #[inline(always)]
    fn leave(&self, y: Vec3, n: Vec3, e: f64) -> f64 {
        let mut way = 64.0 * (e + U * y.max_abs());
        for _ in 0..120 {
            let e = e + way * (1.0 / 32.0);
            if self.is_out(y + n * way, e).is_some() && self.is_out(y - n * way, e).is_some() {
                break;
            }
            way *= 2.0;
        }
        way
    }
}
