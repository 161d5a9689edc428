//! The point of a root: a point near the surface, its distance from it, and the surface's curvature
//! there.

use super::Gauge;
use super::gauge::{Factors, REST, Sample, VALUE};
use crate::implicit::point::Foot;
use crate::point::least_step;
use crate::{LocalPoint, Side};
use durer_math::scale::pow2;
use durer_math::{F8, Isa, Point3, U, Vec3};

/// The depths below the point at which the solid is sampled.
const DEPTHS: [f64; 8] = [0.25, pow2(-4), pow2(-6), pow2(-8), pow2(-10), pow2(-12), pow2(-16), pow2(-20)];

/// The point, moved onto each plane between octants within `fold`: the surface may have an edge or
/// a tip there.
fn unfolded(p: Point3, fold: f64) -> Point3 {
    p.map(|x| if x.abs() <= fold { 0.0 } else { x })
}

/// The gradient `m` at `p` without the components whose sign is undefined there. The gauge is even
/// in each coordinate: where one is zero, zero is a valid component, and `m.p` does not change.
fn level(p: Point3, m: Vec3) -> Vec3 {
    Vec3::from([0, 1, 2].map(|i| if p[i] == 0.0 { 0.0 } else { m[i] }))
}

impl Gauge {
    /// On which side of the solid a point is, if that is certain.
    pub(in crate::implicit) fn side(&self, point: &LocalPoint<'_>) -> Option<Side> {
        let e = point.p_err;
        let noise = (e.x + e.y + e.z) * (1.0 + 4.0 * U) + REST + VALUE * (1.0 + 1.0 / 512.0);
        let near = noise < pow2(-12) && point.p.to_vec().max_abs() <= 1.25;
        if !near {
            return None;
        }
        let mut sample = Sample::new();
        self.sample(Isa::detect(), &Vec3::splat(point.p.to_vec()), &mut sample);
        let g = sample.value.0[0];
        if g - 1.0 > noise { Some(Side::Out) } else { (1.0 - g > noise).then_some(Side::In) }
    }

    /// The point next to `p0`, at most `reach` away, in which the normal there meets the surface;
    /// `None` if f64 leaves it open. A point within `fold` of a plane between octants is moved onto
    /// it.
    ///
    /// With the gradient `m` at `p` the gauge is at least `m.y` everywhere: outward, it exceeds 1
    /// as soon as `m.y` does. Inward, it is at most the value of the chord from `p` to a point
    /// further down where it is known.
    pub(in crate::implicit) fn foot(&self, p0: Point3, (fold, reach): (f64, f64)) -> Option<Foot> {
        let isa = Isa::detect();
        let mut sample = Sample::new();
        let p0 = unfolded(p0, fold);
        self.sample(isa, &Vec3::splat(p0.to_vec()), &mut sample);
        let m = level(p0, sample.gradient.lane(0));
        let step = m * ((1.0 - sample.value.0[0]) / m.dot(m));
        let near = step.max_abs() <= reach;
        if !near {
            return None;
        }
        let p = unfolded(p0 + step, fold);
        let n = m * (1.0 / m.length());
        let at = |i: usize| F8(core::array::from_fn(|k| if k == 0 { p[i] } else { p[i] - DEPTHS[k] * n[i] }));
        self.sample(isa, &Vec3::new(at(0), at(1), at(2)), &mut sample);
        let (g, m) = (sample.value.0[0], level(p, sample.gradient.lane(0)));
        let ulp = p.to_vec().abs() * (4.0 * U) + Vec3::new(1.0, 1.0, 1.0) * least_step(p);
        // The error by the rounding of a start, and the errors of the place and of the value.
        let lost = ulp.x + ulp.y + ulp.z + REST + VALUE * (1.0 + 1.0 / 64.0);
        let along = m.dot(n) - 4.0 * self.turn * (m.abs().dot(n.abs()));
        let outward = ((1.0 - g).max(0.0) + lost) / along;
        let above = (g - 1.0).max(0.0) + 2.0 * lost;
        let inward = (1..8)
            .filter_map(|k| {
                let fall = (g - sample.value.0[k]) - 2.0 * lost;
                let off = DEPTHS[k] * above / fall;
                (fall > 0.0 && off <= DEPTHS[k]).then_some(off)
            })
            .fold(f64::INFINITY, f64::min);
        let off = outward.max(inward) * (1.0 + 16.0 * U);
        let settled = along > 0.0 && off < pow2(-16) && (g - 1.0).abs() < pow2(-16);
        settled.then(|| Foot { p, n, off, bend: self.bend(isa, p, off, ulp.max_abs()) / m.length() })
    }

    /// A bound on the curvature times the gradient's length: the surface leaves its tangent plane
    /// by at most what the gradient turns on the way, times the way (it is below that plane, and
    /// the plane of each of its points is above `p`). Each factor of the gradient's parts goes one
    /// way with each coordinate: the corners of a box have its extremes.
    fn bend(&self, isa: Isa, p: Point3, off: f64, ulp: f64) -> f64 {
        let r = 4096.0 * U + 2.0 * off;
        let size = p.to_vec().abs();
        let (less, more) = (size.map(|x| (x - r).max(0.0)), size.map(|x| x + r));
        // The extremes of the factors of x and y; of N against z, for the other two.
        let corners = [
            Vec3::new(more.x, less.y, size.z),
            Vec3::new(less.x, more.y, size.z),
            Vec3::new(more.x, more.y, less.z),
            Vec3::new(less.x, less.y, more.z),
        ];
        let mut x = Vec3::splat(size);
        for (i, corner) in corners.into_iter().enumerate() {
            x.set_lane(i, corner);
        }
        let mut factors = Factors::new();
        self.factors(isa, &x, &mut factors);
        let Factors { x, y, outer, z } = &factors;
        let width = |least: f64, most: f64| most * (1.0 + 2.0 * self.turn) - least * (1.0 - 2.0 * self.turn);
        // Where a coordinate may have either sign, so may its part.
        let turn = |i: usize, least: f64, most: f64| {
            if less[i] == 0.0 { 2.0 * most * (1.0 + 2.0 * self.turn) } else { width(least, most) }
        };
        let turn = Vec3::new(
            turn(0, x.0[1] * outer.0[3], x.0[0] * outer.0[2]),
            turn(1, y.0[0] * outer.0[3], y.0[1] * outer.0[2]),
            turn(2, z.0[2], z.0[3]),
        );
        2.0 * turn.length() / ulp * (1.0 + 16.0 * U)
    }
}
