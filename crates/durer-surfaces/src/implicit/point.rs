//! The point of a root: its position near the surface, its distance from it, and the surface's
//! curvature.

use super::Isosurface;
use super::line::BoundedLine;
use crate::point::least_step;
use crate::{LocalRay, Need, Root, SurfacePoint};
use durer_formula::{Dual, I8};
use durer_formula::{Tape, seed};
use durer_math::{Interval, Point3, U, Vec3};

/// A point next to the surface.
pub(super) struct Foot {
    pub(super) p: Point3,
    /// The unit normal.
    pub(super) n: Vec3,
    /// The distance along the normal that certainly leaves the surface.
    pub(super) off: f64,
    /// A bound on the curvature.
    pub(super) bend: f64,
}

/// Bounds of the formula near a point.
struct Near {
    value: Interval,
    gradient: [Interval; 3],
}

impl Near {
    /// Bounds within `r` of `p`, per axis, by a tape that is valid there; `None` if they are not
    /// finite or the formula may not be smooth.
    fn new(tape: &Tape, p: Point3, r: f64) -> Option<Self> {
        Self::with_value(tape, p, r).map(|(near, _)| near)
    }

    /// [`Near::new`], with bounds of the value at `p` itself from the fourth lane.
    fn with_value(tape: &Tape, p: Point3, r: f64) -> Option<(Self, Interval)> {
        let p = p.to_array();
        let x = [0, 1, 2].map(|i| {
            let mut v = I8::splat(Interval::around(p[i], r));
            v.set_lane(3, Interval { lo: p[i], hi: p[i] });
            Dual { v, d: seed(i) }
        });
        let g = tape.slopes(&x);
        let gradient = [0, 1, 2].map(|i| g.d.lane(i));
        let defined = (g.v.partial | g.v.jump | g.d.partial) & 7 == 0 && g.v.partial >> 3 & 1 == 0;
        let finite = gradient.iter().all(|d| d.lo.is_finite() && d.hi.is_finite());
        (defined && finite).then(|| (Self { value: g.v.lane(0), gradient }, g.v.lane(3)))
    }

    /// The distance along `n` from `p` that certainly leaves the surface, and a bound on its
    /// curvature; `None` if `r` does not cover the whole step.
    ///
    /// Within `r` of `p` the slope along `n` is at least `m`. So `f(p ± off n)` has the right sign
    /// if `m off` exceeds `|f(p)|`, which is at most `here`, plus the change from rounding the
    /// start: three roundings per axis, each times the largest slope along it.
    fn off(&self, p: Point3, n: Vec3, here: f64, r: f64) -> Option<(f64, f64)> {
        let along = |i: usize| self.gradient[i] * Interval { lo: n[i], hi: n[i] };
        let m = (along(0) + along(1) + along(2)).lo;
        let ulp = p.to_vec().abs() * (4.0 * U) + Vec3::new(1.0, 1.0, 1.0) * least_step(p);
        let stray = (0..3).map(|i| self.gradient[i].magnitude() * (ulp[i] + r * 4.0 * U)).sum::<f64>();
        let off = (here + stray) / m * (1.0 + 16.0 * U);
        let holds = m > 0.0 && off + ulp.max_abs() * 2.0 <= r;
        // Within `r` the gradient changes by at most `turn`, so at a distance `d` the surface has
        // left its tangent plane by at most `turn d`. From one rounding of the position on that is
        // at most `bend / 2 d^2`; below that it does not matter.
        let width = |i: usize| self.gradient[i].width();
        let turn = Vec3::new(width(0), width(1), width(2)).length() / m;
        holds.then(|| (off, 2.0 * turn / ulp.max_abs() * (1.0 + 16.0 * U)))
    }
}

impl Isosurface {
    /// Bounds of the formula and of its gradient within `r` of `p`, per axis; `None` if they are
    /// not finite or the formula may not be smooth.
    fn near(&self, p: Point3, r: f64) -> Option<Near> {
        // The reach includes the outward rounding of the boxes.
        Near::new(self.tape_near(p, 2.0 * r + least_step(p)), p, r)
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
        let at = self.centred(ray);
        let line = BoundedLine::new(&at, root.s.abs());
        let p0 = line.point(root.s);
        let size = p0.to_vec().max_abs();
        let width = at.width(root);
        let direction = line.direction();
        let reach = 64.0 * (width + size * U) + f64::MIN_POSITIVE;
        // The crossing is within this distance along any axis, so it may lie on a plane within it.
        let fold = (width * direction.max_abs() + Vec3::from(line.err).max_abs()) * (1.0 + 8.0 * U);
        let foot = self.gauge.as_ref().and_then(|gauge| gauge.foot(p0, (fold, reach)));
        let Foot { p, n, off, bend } =
            foot.unwrap_or_else(|| self.foot(p0, direction, (reach, width), root.sign));
        let moved = (p - p0).abs();
        let slack = least_step(p);
        let err = Vec3::from(line.err);
        let dp = (err * 2.0 + direction.abs() * width + moved + Vec3::new(size, size, size) * (2.0 * U))
            * (1.0 + 16.0 * U)
            + Vec3::new(slack, slack, slack);
        let mut point = SurfacePoint::new(p, dp, off + slack, n.to_normal());
        point.bend = bend;
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (u, v) = crate::faces::chart::tangents(n);
            point.uv = [u.dot(p.to_vec()), v.dot(p.to_vec())];
            (point.dpdu, point.dpdv) = (u, v);
        }
        point
    }

    /// The point next to `p0` for any formula: towards the surface along the gradient, until
    /// rounding stops it.
    fn foot(&self, p0: Point3, direction: Vec3, (reach, width): (f64, f64), sign: i8) -> Foot {
        if let Some(foot) = self.quick_foot(p0, reach) {
            return foot;
        }
        let back = if sign > 0 { direction } else { -direction };
        let (p, ng) = match self.tape_near(p0, reach).wall(p0, reach) {
            Some(wall) => {
                // Next to a jump that is no wall, because the formula jumps back or not across
                // zero, the surface continues.
                let aside = wall * (4.0 * reach / wall.length());
                if let Some(foot) =
                    [aside, -aside].iter().find_map(|&aside| self.quick_foot(p0 + aside, 16.0 * reach))
                {
                    return foot;
                }
                // The ray decides which way is outward.
                (p0, if wall.dot(back) < 0.0 { -wall } else { wall })
            }
            None => {
                let (p, slope) = self.nearer(p0, reach);
                (p, slope.unwrap_or(back))
            }
        };
        let n = ng * (1.0 / ng.length());
        let n = if n.is_finite() { n } else { back * (1.0 / back.length()) };
        let (off, bend) = self.off(p, n, p0.to_vec().max_abs() * U, width);
        Foot { p, n, off, bend }
    }

    /// [`Isosurface::foot`] from two evaluations of the formula; `None` where one step of Newton's
    /// method is not enough.
    fn quick_foot(&self, p0: Point3, reach: f64) -> Option<Foot> {
        let r = 256.0 * (p0.to_vec().max_abs() * U) + least_step(p0);
        let tape = self.tape_near(p0, reach + 4.0 * r);
        let here = Near::new(tape, p0, 0.0)?;
        let g = Vec3::from(here.gradient.map(Interval::mid));
        let step = g * (-here.value.mid() / g.dot(g));
        let near = step.max_abs() <= reach;
        if !near {
            return None;
        }
        let p = p0 + step;
        let (near, value) = Near::with_value(tape, p, r)?;
        let g = Vec3::from(near.gradient.map(Interval::mid));
        let n = g * (1.0 / g.length());
        let (off, bend) = near.off(p, n, value.magnitude(), r)?;
        Some(Foot { p, n, off, bend })
    }

    /// A point at most `reach` away whose value is nearer to zero, by a few steps of Newton's
    /// method along the gradient; and the gradient there.
    ///
    /// Not inlined: when it was, the optimiser lost a coordinate of the point.
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

    /// The gradient at a point, rounded; `None` where it does not exist.
    fn slope(&self, p: Point3) -> Option<Vec3> {
        let near = self.near(p, 0.0)?;
        let g = Vec3::from(near.gradient.map(Interval::mid));
        (g.is_finite() && g != Vec3::ZERO).then_some(g)
    }

    /// The distance along `n` from `p` that certainly leaves the surface, and a bound on its
    /// curvature there.
    fn off(&self, p: Point3, n: Vec3, scale: f64, width: f64) -> (f64, f64) {
        let here = self.near(p, 0.0).map_or(f64::INFINITY, |near| near.value.magnitude());
        let mut r = 64.0 * scale + least_step(p);
        for _ in 0..16 {
            if let Some(told) = self.near(p, r).and_then(|near| near.off(p, n, here, r)) {
                return told;
            }
            r *= 4.0;
        }
        // A point without a normal (a tip, a seam, a cluster): some distance away, in the scale of
        // the coordinates and of their errors.
        (4096.0 * scale + 4.0 * width, 0.0)
    }
}
