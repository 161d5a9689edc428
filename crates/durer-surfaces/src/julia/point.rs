//! A Julia set at a point: its side, and the surface near it.

use super::Solid;
use super::orbit::{Ball, Rule, TINY};
use crate::faces::chart::tangents;
use crate::point::least_step;
use crate::{LocalPoint, LocalRay, Need, Root, Side, SurfacePoint};
use core::cmp::Ordering::Less;
use durer_math::{Isa, Point3, U, Vec3};

impl<const M: usize, const C: usize> Solid<M, C> {
    /// Whether points are outside, where that is certain for all points within `e` of each along
    /// any axis.
    #[inline(never)]
    fn are_out(&self, points: &[Vec3; 8], e: &[f64; 8]) -> [Option<bool>; 8] {
        Isa::detect().run(
            #[inline(always)]
            || {
                let mut balls = [Ball::ZERO; M];
                for k in 0..8 {
                    let z = self.lift.at(points[k]);
                    for (ball, z) in balls.iter_mut().zip(&z) {
                        for (q, z) in ball.q.iter_mut().zip(z) {
                            q.0[k] = *z;
                        }
                        ball.r.0[k] = self.lift.error(points[k].max_abs(), e[k]) + TINY;
                    }
                }
                let known = self.rule.known(balls);
                core::array::from_fn(|k| match () {
                    () if known.out.lane(k) => Some(true),
                    () if known.within.lane(k) => Some(false),
                    () => None,
                })
            },
        )
    }

    pub(super) fn side(&self, point: &LocalPoint<'_>) -> Side {
        match self.are_out(&[point.p.to_vec(); 8], &[point.p_err.max_abs(); 8])[0] {
            Some(true) => Side::Out,
            Some(false) => Side::In,
            None => Side::On,
        }
    }

    /// The value, the gradient, and a bound of the second derivatives within `r`.
    #[inline(never)]
    fn near(&self, p: Vec3, r: f64) -> (f64, Vec3, f64) {
        Isa::detect().run(
            #[inline(always)]
            || {
                let z = self.lift.at(p);
                let (g, bend) = self.rule.gradient(z, self.lift.axes(), r, self.lift.stretch());
                (self.rule.value(z), Vec3::from(g), bend)
            },
        )
    }

    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.point_here(ray, root, need),
        )
    }

    #[inline(always)]
    fn point_here(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let at = ray.recentre(Point3::ORIGIN, 0).sharp(1.0);
        let s = root.s;
        let p0 = Vec3::new(at.o.x + s * at.d.x, at.o.y + s * at.d.y, at.o.z + s * at.d.z);
        let e = at.o_err + at.d_err * s.abs() + (at.o.abs() + at.d.abs() * s.abs()) * (2.0 * U);
        let width = at.width(root);
        let (p, g, bend) = self.nearer(p0, 64.0 * (width + 4.0 * U));
        let length = g.x.mul_add(g.x, g.y.mul_add(g.y, g.z * g.z)).sqrt();
        let n = g * (1.0 / length);
        let n = if n.is_finite() { n } else { at.d * (-1.0 / at.d.max_abs()) };
        let dp = (e + at.d.abs() * width + (p - p0).abs() + p.abs() * (2.0 * U)) * (1.0 + 16.0 * U);
        let slack = least_step(p.to_point());
        let dp = dp + Vec3::new(slack, slack, slack);
        let (off, plain) = self.leave(p, n);
        let mut point = SurfacePoint::new(p.to_point(), dp, off + slack, n.to_normal());
        if let Some(shading) = self.next_normal(p)
            && need.contains(Need::SHADING_NORMAL)
            && shading.x * n.x + shading.y * n.y + shading.z * n.z > 0.0
        {
            point.ns = shading.to_normal();
        }
        let bend = bend / length * (1.0 + 1.0 / 1024.0);
        (point.bend, point.slack) =
            if plain && bend.is_finite() { (bend, 0.0) } else { (f64::INFINITY, off / 64.0) };
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (u, v) = tangents(n);
            let along = |t: Vec3| t.x * p.x + t.y * p.y + t.z * p.z;
            point.uv = [along(u), along(v)];
            (point.dpdu, point.dpdv) = (u, v);
        }
        point
    }

    /// The unit normal of the surface that one more iteration would give, at the same point. It
    /// shows the finer folds that the surface itself does not have yet, and POV-Ray shades with it.
    #[inline(never)]
    fn next_normal(&self, p: Vec3) -> Option<Vec3> {
        let rule = Rule { iterations: self.rule.iterations + 1, escapes: true, ..self.rule };
        let (g, _) = Isa::detect().run(
            #[inline(always)]
            || rule.gradient(self.lift.at(p), self.lift.axes(), 0.0, self.lift.stretch()),
        );
        let g = Vec3::from(g);
        let size = g.max_abs();
        let g = g * (1.0 / size);
        let n = g * (1.0 / (g.x * g.x + g.y * g.y + g.z * g.z).sqrt());
        n.is_finite().then_some(n)
    }

    /// A point at most `reach` away whose value is nearer to zero, by a few steps of Newton's
    /// method along the gradient; and the gradient there, with a bound of the second derivatives
    /// around.
    fn nearer(&self, mut p: Vec3, reach: f64) -> (Vec3, Vec3, f64) {
        /// The neighbourhood, in the set's own frame, where everything is of order one.
        const AROUND: f64 = durer_math::scale::pow2(-30);
        let (mut f, mut g, mut bend) = self.near(p, AROUND);
        for _ in 0..3 {
            let square = g.x * g.x + g.y * g.y + g.z * g.z;
            let step = g * (-f / square);
            // NaN is no step.
            if f == 0.0 || step.max_abs().partial_cmp(&reach) != Some(Less) {
                break;
            }
            let there = self.near(p + step, AROUND);
            if there.0.abs().partial_cmp(&f.abs()) != Some(Less) {
                break;
            }
            p += step;
            (f, g, bend) = there;
        }
        (p, g, bend)
    }

    /// The distance along `n` that is certainly outside, and against `n` certainly inside, whatever
    /// rounding does to the place; and whether both hold, not only some certain side.
    fn leave(&self, p: Vec3, n: Vec3) -> (f64, bool) {
        let least = 8.0 * U * p.max_abs() + TINY;
        let mut way = 4.0 * least;
        let mut certain = None;
        for _ in 0..12 {
            let ways: [f64; 4] = core::array::from_fn(|i| way * [1.0, 4.0, 16.0, 64.0][i]);
            let places = core::array::from_fn(|k| p + n * if k < 4 { ways[k] } else { -ways[k - 4] });
            let slack = core::array::from_fn(|k| least + ways[k % 4] * (1.0 / 64.0));
            let out = self.are_out(&places, &slack);
            if let Some(k) = (0..4).find(|&k| out[k] == Some(true) && out[k + 4] == Some(false)) {
                return (ways[k], true);
            }
            let some = (0..4).find(|&k| out[k].is_some() && out[k + 4].is_some());
            certain = certain.or(some.map(|k| ways[k]));
            way *= 256.0;
            if way > 1.0 {
                break;
            }
        }
        (certain.unwrap_or(4096.0 * least), false)
    }
}
