//! A point of a sweep's surface, and on which side of it a point is.
#![expect(clippy::needless_range_loop, reason = "several arrays have the same axes and powers")]

use super::SphereSweep;
use super::line::Curve;
use super::spline::Basis;
use crate::faces::chart::tangents;
use crate::point::least_step;
use crate::{CentredRay, End, LocalPoint, LocalRay, Need, Root, Side, SurfacePoint};
use core::cmp::Ordering;
use durer_math::eft::{scale2, two_sum};
use durer_math::{Dyadic, EFloat, Isa, Point3, Ring, U, Vec3, elementary};
use durer_roots::exact::ExactRoots;

/// Covers results below the normal range, in units.
const TINY: f64 = durer_math::scale::pow2(-500);
/// The least distance at which rays start from the surface, in units: far enough for f64 to decide
/// on which side of a crossing's bracket the start is.
const CLEAR: f64 = 256.0 * U;

/// How far a double tip may be from the origin of the frame it is placed in, in units: within that rays
/// start on the requested side.
const FAR: f64 = durer_math::scale::pow2(10);
/// No start from a tip is farther from it than this, in units.
const FARTHEST: f64 = durer_math::scale::pow2(-20);

/// How rays leave a point `y` of the surface, in units: to `y + off n` and to `y - off n`, and from any
/// place within `slack` of `y`.
#[derive(Clone, Copy, Debug)]
struct Leave {
    y: Vec3,
    n: Vec3,
    off: f64,
    slack: f64,
}

/// By how much a polynomial in `z` differs at `z` from its value at zero. Without the constant
/// coefficient the sign is right also for a small `z`.
#[inline(always)]
fn rise<const M: usize>(p: &[EFloat; M], z: f64) -> EFloat {
    let z = EFloat::with_error(z, U * z.abs());
    let mut sum = EFloat::zero();
    for k in (1..M).rev() {
        sum = sum * z + p[k];
    }
    sum * z
}

impl SphereSweep {
    /// How rays leave the tip of a cone that opens by `sine`, the sine of half its angle. The way out is
    /// along the axis, unless there is another cone on the other side of the tip: the radius changes its
    /// sign, or two pieces meet there.
    ///
    /// Then there is no direction that leads out of both cones while its opposite leads into one.
    /// Rays start from a point within, on the axis at a distance `L`, and from one outside, across
    /// the axis at `L`. Their distances from the cone are `L sine` and `L cosine`, eight times the
    /// error of starts. Their sides are decided exactly.
    #[cold]
    #[inline(never)]
    fn past_tip<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        tip: Leave,
        sine: f64,
        room: f64,
    ) -> Leave {
        let is = |p: Vec3, side: Ordering| {
            let exact = [p.x, p.y, p.z].map(Dyadic::from);
            self.exact_side(basis, &exact, &Dyadic::from(1.0), (p, Vec3::ZERO)) == side
        };
        if is(tip.y + tip.n * tip.off, Ordering::Greater) {
            return tip;
        }
        let (e1, e2) = tangents(tip.n);
        let slack = (16.0 * U * FAR).max(tip.slack).max(room);
        let open = sine.min((1.0 - sine * sine).sqrt());
        let mut way = tip.off.max(8.0 * slack / open);
        while way <= FARTHEST {
            let inside = tip.y - tip.n * way;
            if is(inside, Ordering::Less) {
                for tilt in [0.0, 0.5, -0.5] {
                    for (a, b) in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)] {
                        let across = e1 * f64::from(a) + e2 * f64::from(b) + tip.n * tilt;
                        let outside = tip.y + across * (way / across.length());
                        if is(outside, Ordering::Greater) {
                            let apart = outside - inside;
                            let length = apart.length();
                            let (y, n) = (inside + apart * 0.5, apart * (1.0 / length));
                            return Leave { y, n, off: 0.5 * length, slack };
                        }
                    }
                }
            }
            way *= 4.0;
        }
        tip
    }

    /// The side of a point in units, each coordinate of which is known within `e`: the sign of the
    /// least `|y - c|² - r²`, if it is certain.
    #[inline(always)]
    fn side_in_f64<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        y: Vec3,
        e: Vec3,
    ) -> Option<Ordering> {
        let mut told = Some(Ordering::Greater);
        self.tree.near(
            y,
            e.max_abs(),
            #[inline(always)]
            |i| {
                if told == Some(Ordering::Less) {
                    return;
                }
                let Some(points) = self.piece::<K>(self.order[i] as usize) else { return };
                let curve = Curve::<f64, K>::new(
                    self,
                    basis,
                    points,
                    #[inline(always)]
                    |at| {
                        let mut from = *at;
                        for axis in 0..3 {
                            from[axis] = EFloat::with_error(y[axis], e[axis]) - at[axis];
                        }
                        from
                    },
                );
                match curve.side::<M>() {
                    Some(Ordering::Greater) => {}
                    Some(_) => told = Some(Ordering::Less),
                    None => told = None,
                }
            },
        );
        told
    }

    /// The side of the exact point `p / w`, in units.
    #[cold]
    #[inline(never)]
    fn exact_side<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        p: &[Dyadic; 3],
        w: &Dyadic,
        (y, e): (Vec3, Vec3),
    ) -> Ordering {
        let mut told = Ordering::Greater;
        let weight = Dyadic::from(basis.weight);
        let [left, right] = [-1.0, 1.0].map(Dyadic::from);
        self.tree.near(y, e.max_abs(), |i| {
            let Some(points) = self.piece::<K>(self.order[i] as usize) else { return };
            if told == Ordering::Less {
                return;
            }
            let mut g = vec![Dyadic::ZERO; M];
            for k in 0..4 {
                let base = if k < 3 { self.centre[k] } else { 0.0 };
                let at = points.map(|p| (Dyadic::from(p[k]) - Dyadic::from(base)).scale2(-self.scale));
                let mut q = basis.coefficients(&at).map(|c| &c * w);
                if k < 3 {
                    q[0] = &q[0] - &(&p[k] * &weight);
                }
                for (i, a) in q.iter().enumerate() {
                    for (j, b) in q.iter().enumerate() {
                        let term = a * b;
                        g[i + j] = if k < 3 { &g[i + j] + &term } else { &g[i + j] - &term };
                    }
                }
            }
            let value = |x: &Dyadic| g.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * x) + a).exact_sign();
            let ends = [value(&left), value(&right)];
            told = told.min(ends[0]).min(ends[1]);
            let Some(roots) = ExactRoots::new(g.clone()) else {
                told = told.min(Ordering::Equal);
                return;
            };
            for root in roots.isolate(&roots.beside(-1.0, 1.0), &roots.beside(1.0, -1.0)) {
                told = told.min(Ordering::Equal).min(root.before).min(root.after);
            }
        });
        told
    }

    pub(super) fn side_of<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        point: &LocalPoint<'_>,
    ) -> Side {
        let (y, e) = point.relative_to(self.centre, self.scale);
        let told = Isa::detect().run(
            #[inline(always)]
            || self.side_in_f64(basis, y, e),
        );
        let told = told.unwrap_or_else(|| {
            let Some((p, w)) = point.in_ring::<Dyadic>() else { return Ordering::Equal };
            let p = [0, 1, 2].map(|k| (&p[k] - &(&Dyadic::from(self.centre[k]) * &w)).scale2(-self.scale));
            self.exact_side(basis, &p, &w, (y, e))
        });
        match told {
            Ordering::Less => Side::In,
            Ordering::Equal => Side::On,
            Ordering::Greater => Side::Out,
        }
    }

    /// The side of a ray's point at an end of its range; `None` if that is not known.
    pub(super) fn side_at<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        at: &CentredRay<'_>,
        end: End,
    ) -> Option<Ordering> {
        let (y, e) = at.point_at_end(end);
        let told = Isa::detect().run(
            #[inline(always)]
            || self.side_in_f64(basis, y, e),
        );
        told.or_else(|| {
            let ray = at.in_ring::<Dyadic>()?;
            let s = at.end_in_ring::<Dyadic>(end);
            let p = [0, 1, 2].map(|k| &ray.o[k] + &(&ray.d[k] * &s));
            Some(self.exact_side(basis, &p, &ray.w, (y, e)))
        })
    }

    #[inline(always)]
    pub(super) fn point<const K: usize, const M: usize>(
        &self,
        basis: &Basis<K, M>,
        ray: &LocalRay<'_>,
        root: &Root,
        need: Need,
    ) -> SurfacePoint {
        let number = root.tag[0] as usize;
        let Some(points) = self.piece::<K>(number) else { return SurfacePoint::unknown(self.centre) };
        let at = ray.recentre(self.centre, self.scale).sharp(1.0);
        let (s, mut x) = (root.s, root.tag[1]);
        let q = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_q = at.o_err + at.d_err * s.abs() + q.abs() * U;

        // The curve relative to the ray's point.
        let curve = Curve::<f64, K>::new(
            self,
            basis,
            points,
            #[inline(always)]
            |c| {
                let mut from = *c;
                for axis in 0..3 {
                    from[axis] = EFloat::exact(q[axis]) - c[axis];
                }
                from
            },
        );
        // The ball that touches the surface here is the one with the least |y - c|² - r². Newton's
        // method finds it if its steps are small. Where it does not, as next to an end towards which
        // the value falls without a minimum, an end without a greater value is nearer: of balls that
        // touch each other here from within, the largest.
        for _ in 0..2 {
            let p = curve.about::<M>(x);
            let step = -0.5 * p[1].v / p[2].v;
            if p[2].lo() > 0.0 && step.abs() < 1.0 / 64.0 {
                x = (x + step).clamp(-1.0, 1.0);
                continue;
            }
            let [left, right] = [rise(&p, -1.0 - x), rise(&p, 1.0 - x)];
            let radius = |x: f64| curve.place(x).1.abs();
            let is_left = match (left - right).sign() {
                Some(Ordering::Less) => true,
                Some(Ordering::Greater) => false,
                _ => radius(-1.0) > radius(1.0),
            };
            let (end, above) = if is_left { (-1.0, left) } else { (1.0, right) };
            if above.lo() <= 0.0 {
                x = end;
            }
        }
        let (c, signed, c1, r1) = curve.place(x);
        let (c, c1, r) = (Vec3::from(c), Vec3::from(c1), signed.abs());
        // How |r| changes.
        let r1 = if signed < 0.0 { -r1 } else { r1 };
        // From the centre of the ball.
        let out = -c;
        let length = out.length();
        let n = out * (1.0 / length);
        let n = if n.is_finite() && length > 0.0 { n } else { at.d * (-1.0 / at.d.length()) };
        let moved = c + n * r;
        let y = q + moved;

        // In the surface's own frame; the rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, self.scale));
        let ((px, lx), (py, ly), (pz, lz)) =
            (axis(self.centre.x, y.x), axis(self.centre.y, y.y), axis(self.centre.z, y.z));
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -self.scale) + TINY);
        let width = at.width(root);
        let dp = (e_q + at.d.abs() * width + moved.abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

        // By how much another ball may hold more than this one: p1² / (4 p2), over 2 r. Near an end
        // of the sweep, and on a ball that touches the surface from inside in one point only by
        // chance, the surface is not known to be smooth: then it is a tip.
        let near = curve.about::<M>(x);
        let (p1, p2) = (near[1], near[2]);
        let within = x > -1.0 && x < 1.0;
        let turned = p2.lo();
        let dip = if within && turned > 0.0 { p1.v * p1.v / turned / r.max(TINY) } else { 0.0 };
        // Curvatures: that of the ball, 1 / r, and along the sweep (1 - |c'|² / p2) / r at most.
        let along = (c1 - n * c1.dot(n)).length_squared();
        let bend = if turned > 0.0 {
            (along / turned - 1.0).abs().max(1.0) / r
        } else if within {
            f64::INFINITY
        } else {
            1.0 / r
        };
        let bend = bend * (1.0 + 1.0 / 64.0);
        let tau = scale2(p.to_vec().max_abs(), -self.scale) * (6.0 * U) + TINY;
        let eta = lost.x + lost.y + lost.z + 16.0 * U * (1.0 + y.abs().max_abs());
        let clear = (CLEAR * (1.0 + y.abs().max_abs())).min(r / 128.0);
        let off = 2.0 * eta + clear + bend.min(1.0 / tau) * tau * tau + 2.0 * dip;
        // Next to the tip of a cone the way out is along the axis, and the way in is as long as the
        // cone must be to be wider than all errors.
        let (way, opens) = (c1.length(), r1.abs());
        let mut leave = Leave { y, n, off, slack: off / 64.0 };
        if r <= 64.0 * off && opens > 0.0 && opens < way {
            let off = (off + 8.0 * (eta + tau + r) * (way / opens)).min(durer_math::scale::pow2(-20));
            let n = c1 * (if r1 > 0.0 { -1.0 } else { 1.0 } / way);
            leave = self.past_tip(basis, Leave { y, n, off, slack: off / 64.0 }, opens / way, eta + tau);
        }
        let Leave { y: start, n, off, slack } = leave;
        let back = |x: f64| scale2(x, self.scale);
        let is_tip = (bend * off).is_nan() || bend * off > 1.0 / 64.0;
        let mut point = SurfacePoint::new(
            p,
            dp.map(|x| back(x) + f64::MIN_POSITIVE),
            back(off) + least_step(p),
            n.to_normal(),
        );
        (point.bend, point.slack) =
            if is_tip { (f64::INFINITY, back(slack)) } else { (scale2(bend, -self.scale), 0.0) };
        point.aside = (start - y).map(back);

        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            const TURN: f64 = 2.0 * core::f64::consts::PI;
            let count = self.pieces() as f64;
            // Round the direction of the sweep.
            let k = if way > 0.0 { c1 * (1.0 / way) } else { Vec3::Y };
            let (e1, e2) = tangents(k);
            let phi = elementary::atan2(n.dot(e2), n.dot(e1)) / TURN;
            point.uv = [
                (number as f64 + (0.5 + 0.5 * x).clamp(0.0, 1.0)) / count,
                if phi < 0.0 { phi + 1.0 } else { phi },
            ];
            let around = k.cross(n);
            let around = if around.length() > 0.0 { around } else { e1 };
            let along = around.cross(n);
            let unit = |v: Vec3| v * (1.0 / v.length().max(f64::MIN_POSITIVE));
            let along = unit(along) * if along.dot(k) < 0.0 { -1.0 } else { 1.0 };
            point.dpdu = along.map(|x| back(x * 2.0 * count * way.max(r)));
            point.dpdv = unit(around).map(|x| back(x * TURN * r));
        }
        point
    }
}
