//! The point of a root: near it, how far from the surface, and how the surface bends there.

use super::Isosurface;
use super::line::Line;
use crate::point::least_step;
use crate::{LocalRay, Need, Root, SurfacePoint};
use durer_math::{Dual, F8, I8, Interval, Point3, U, Vec3};

/// A point next to the surface.
pub(super) struct Foot {
    pub(super) p: Point3,
    /// The normal, of length 1.
    pub(super) n: Vec3,
    /// How far along it one must go to leave the surface for certain.
    pub(super) off: f64,
    /// A bound on the curvature.
    pub(super) bend: f64,
}

/// What is known of the formula near a point.
struct Near {
    value: Interval,
    gradient: [Interval; 3],
}

/// The unit vectors in the first lanes: what `axis` contributes to each.
fn seed(axis: usize) -> I8 {
    let mut d = I8::new(F8::ZERO, F8::ZERO);
    d.set_lane(axis, Interval { lo: 1.0, hi: 1.0 });
    d
}

impl Isosurface {
    /// Bounds of the formula and of its gradient within `r` of `p`, per axis; `None` where they are not finite or it may not be smooth.
    fn near(&self, p: Point3, r: f64) -> Option<Near> {
        // Rounding the ends of the boxes outward is charged to the reach.
        let tape = self.tape_near(p, 2.0 * r + least_step(p));
        let p = p.to_array();
        let x = [0, 1, 2].map(|i| {
            let around = Interval::around(p[i], r);
            Dual { v: I8::splat(around), d: seed(i) }
        });
        let g = tape.slopes(&x);
        let gradient = [0, 1, 2].map(|i| g.d.lane(i));
        let defined = (g.v.partial | g.v.jump | g.d.partial) & 7 == 0;
        let finite = gradient.iter().all(|d| d.lo.is_finite() && d.hi.is_finite());
        (defined && finite).then(|| Near { value: g.v.lane(0), gradient })
    }

    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        if root.face > 0 {
            let mut own = *ray;
            if own.source_face == 0 {
                own.source = None;
            } else {
                own.source_face -= 1;
            }
            return self.container.resolve(&own, &Root { face: root.face - 1, ..*root }, need);
        }
        let at = ray.recentre(self.container.bounds().centre(), 0);
        let line = Line::new(&at, root.s.abs());
        let p0 = line.point(root.s);
        let size = p0.to_vec().max_abs();
        let width = at.width(root.lo, root.hi);
        let direction = line.direction();
        let reach = 64.0 * (width + size * U) + f64::MIN_POSITIVE;
        let foot = self.gauge.as_ref().and_then(|gauge| gauge.foot(p0, reach));
        let Foot { p, n, off, bend } = foot.unwrap_or_else(|| self.foot(p0, direction, reach, width));
        let moved = (p - p0).abs();
        let slack = least_step(p);
        let err = Vec3::from(line.err);
        let dp = (err * 2.0 + direction.abs() * width + moved + Vec3::new(size, size, size) * (2.0 * U))
            * (1.0 + 16.0 * U)
            + Vec3::new(slack, slack, slack);
        let mut point = SurfacePoint::new(p, dp, off + slack, n.to_normal());
        point.bend = bend;
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (u, v) = crate::quadric::body::tangents(n);
            point.uv = [u.dot(p.to_vec()), v.dot(p.to_vec())];
            (point.dpdu, point.dpdv) = (u, v);
        }
        point
    }

    /// The point next to `p0` for any formula: towards the surface along the gradient, until rounding stops it.
    fn foot(&self, p0: Point3, direction: Vec3, reach: f64, width: f64) -> Foot {
        let (p, ng) = self.nearer(p0, reach);
        let ng = ng.unwrap_or(-direction);
        let n = ng * (1.0 / ng.length());
        let n = if n.is_finite() { n } else { direction * (-1.0 / direction.length()) };
        let (off, bend) = self.off(p, n, p0.to_vec().max_abs() * U, width);
        Foot { p, n, off, bend }
    }

    /// A point at most `reach` away whose value is nearer to zero, by a few steps of Newton's along the gradient; and the gradient there.
    ///
    /// Not inlined: where it was, the optimiser lost a coordinate of the point.
    #[inline(never)]
    fn nearer(&self, mut p: Point3, reach: f64) -> (Point3, Option<Vec3>) {
        let (mut f, mut slope) = (self.tape_near(p, 0.0).value(p), self.slope(p));
        for _ in 0..3 {
            let Some(g) = slope else { break };
            let step = g * (-f / g.dot(g));
            let moved = p + step;
            let value = self.tape_near(moved, 0.0).value(moved);
            // NaN is not nearer.
            let nearer = value.abs() < f.abs() && step.max_abs() <= reach;
            if !nearer {
                break;
            }
            (p, f, slope) = (moved, value, self.slope(moved));
        }
        (p, slope)
    }

    /// The gradient at a point, rounded; `None` where it has none.
    fn slope(&self, p: Point3) -> Option<Vec3> {
        let near = self.near(p, 0.0)?;
        let g = Vec3::from(near.gradient.map(Interval::mid));
        (g.is_finite() && g != Vec3::ZERO).then_some(g)
    }

    /// How far along `n` one must go from `p` to leave the surface for certain, and a bound on its curvature there.
    ///
    /// Within `r` of `p` the slope along `n` is at least `m`. So `f(p ± off n)` is on its side of zero if `m off` exceeds `|f(p)|` and what
    /// rounding the start moves it: three roundings per axis, each times the largest slope along it. `r` must hold the whole way.
    fn off(&self, p: Point3, n: Vec3, scale: f64, width: f64) -> (f64, f64) {
        let here = self.near(p, 0.0).map_or(f64::INFINITY, |near| near.value.magnitude());
        let mut r = 64.0 * scale + least_step(p);
        for _ in 0..16 {
            if let Some(near) = self.near(p, r) {
                let along = |i: usize| near.gradient[i] * Interval { lo: n[i], hi: n[i] };
                let m = (along(0) + along(1) + along(2)).lo;
                let ulp = p.to_vec().abs() * (4.0 * U) + Vec3::new(1.0, 1.0, 1.0) * least_step(p);
                let stray =
                    (0..3).map(|i| near.gradient[i].magnitude() * (ulp[i] + r * 4.0 * U)).sum::<f64>();
                let off = (here + stray) / m * (1.0 + 16.0 * U);
                if m > 0.0 && off + ulp.max_abs() * 2.0 <= r {
                    // Within r the gradient turns by at most `turn`, so that at a distance d the surface has left its tangent plane by at most
                    // `turn d`: no more than `bend / 2 d^2` from one rounding of the place on, and nothing that counts below that.
                    let width = |i: usize| near.gradient[i].width();
                    let turn = Vec3::new(width(0), width(1), width(2)).length() / m;
                    return (off, 2.0 * turn / ulp.max_abs() * (1.0 + 16.0 * U));
                }
            }
            r *= 4.0;
        }
        // A point without a normal (a tip, a seam, a cluster): some way off, in the scale of the coordinates and of what is not known.
        (4096.0 * scale + 4.0 * width, 0.0)
    }
}
