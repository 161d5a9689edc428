//! The shaft: a convex bound of all rays of a bundle.
//!
//! ```text
//!            ╱│            the rays start in a box, and each component of their
//!     ┌─┐ ╱   │            directions is in an interval: at t, the bundle lies
//!     └─┘ ╲   │            in the box  [a_i + t l_i, b_i + t u_i]
//!            ╲│
//! ```
//!
//! A box `[m, M]` can be met only where `a_i + t l_i <= M_i` and `b_i + t u_i >= m_i` on every
//! axis: six linear inequalities for `t`, whose common solutions are an interval. If it is empty,
//! no ray of the bundle meets the box. So neighbouring rays (the pixels of a tile, the rays of a
//! small region to one light) can share one search of the tree. After E. A. Haines, J. R. Wallace,
//! "Shaft culling for efficient ray-traced radiosity", *Eurographics Workshop on Rendering* (1991).

use crate::{Aabb, F8, M8, U, Vec3};

/// A bundle of rays: origins in a box, directions between two bounds per axis, `t` in `[0, t_max]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaft {
    start: Aabb,
    low: Vec3,
    high: Vec3,
    t_max: f64,
}

/// A shaft in the form for tests of eight boxes at a time.
#[derive(Clone, Copy, Debug)]
pub struct Shaft8 {
    /// For each axis the inequality of the boxes' upper planes and that of their lower ones.
    cuts: [[Cut; 2]; 3],
    t_max: f64,
}

/// One of the inequalities for `t`: `t slope <= plane - base`, or with the plane's sign exchanged.
#[derive(Clone, Copy, Debug)]
struct Cut {
    base: f64,
    /// The reciprocal of the slope, rounded.
    inverse: f64,
    kind: CutKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CutKind {
    /// The slope is zero.
    Level,
    /// It is positive: `t` has an upper bound.
    Exit,
    /// It is negative: `t` has a lower bound.
    Enter,
    /// It is NaN, or its reciprocal might have underflowed.
    Nothing,
}

/// More than the roundings of a difference, of a quotient (or of a reciprocal and a product with
/// it) and of the term that is then added.
const WIDEN: f64 = 8.0 * U;
/// Covers underflow in bounds and quotients.
const LOST: f64 = f64::MIN_POSITIVE;

impl Shaft {
    /// The unbounded rays that start in `start` with directions between `low` and `high`.
    pub fn new(start: Aabb, low: Vec3, high: Vec3) -> Self {
        Self { start, low, high, t_max: f64::INFINITY }
    }

    /// The rays with `t` in `[0, 1]` that start in one box and end in another.
    pub fn between(start: Aabb, end: Aabb) -> Self {
        let axis = |a0: f64, a1: f64, b0: f64, b1: f64| {
            // Far more than the roundings of these differences, and of a direction that is itself
            // such a difference.
            let size = a0.abs() + a1.abs() + b0.abs() + b1.abs();
            let slack = size.mul_add(32.0 * U, f64::MIN_POSITIVE);
            ((b0 - a0) - slack, (b1 - a1) + slack)
        };
        let (a, b) = (start, end);
        let (x0, x1) = axis(a.min.x, a.max.x, b.min.x, b.max.x);
        let (y0, y1) = axis(a.min.y, a.max.y, b.min.y, b.max.y);
        let (z0, z1) = axis(a.min.z, a.max.z, b.min.z, b.max.z);
        Self { start, low: Vec3::new(x0, y0, z0), high: Vec3::new(x1, y1, z1), t_max: 1.0 }
    }

    /// A box in which all rays of the bundle end; unbounded if they do not end.
    pub fn end(&self) -> Aabb {
        if self.t_max == f64::INFINITY {
            return Aabb::UNBOUNDED;
        }
        // The sums are rounded once.
        let (a, b) = (self.start.min + self.low, self.start.max + self.high);
        Aabb::new(a, b).expanded((a.to_vec().abs() + b.to_vec().abs()) * (2.0 * U))
    }

    /// Whether the bundle may meet a box; `false` is certain.
    #[inline(always)]
    pub fn may_meet(&self, bounds: &Aabb) -> bool {
        let (mut enter, mut exit) = (0.0, self.t_max);
        let (a, b) = (self.start.min, self.start.max);
        let mut axis = |a: f64, b: f64, low: f64, high: f64, min: f64, max: f64| {
            // a + t low <= max, and -b - t high <= -min.
            clip(max - a, low, &mut enter, &mut exit);
            clip(b - min, -high, &mut enter, &mut exit);
        };
        axis(a.x, b.x, self.low.x, self.high.x, bounds.min.x, bounds.max.x);
        axis(a.y, b.y, self.low.y, self.high.y, bounds.min.y, bounds.max.y);
        axis(a.z, b.z, self.low.z, self.high.z, bounds.min.z, bounds.max.z);
        // Neither is ever NaN: a comparison with NaN cuts nothing.
        enter <= exit
    }

    /// The form for tests of eight boxes at a time.
    pub fn lanes(&self) -> Shaft8 {
        let (a, b) = (self.start.min, self.start.max);
        let axis = |i: usize| [Cut::new(a[i], self.low[i]), Cut::new(-b[i], -self.high[i])];
        Shaft8 { cuts: [axis(0), axis(1), axis(2)], t_max: self.t_max }
    }

    /// Whether the bundle may meet the plane `normal . p = offset`, whose offset is known within
    /// `error`; `false` is certain.
    pub fn may_cross(&self, normal: Vec3, offset: f64, error: f64) -> bool {
        let n = normal;
        // The least and the greatest height over the start box, and its change along the rays.
        let (mut least, mut most, mut size) = (0.0, 0.0, offset.abs());
        let (mut falls, mut climbs, mut steep) = (0.0_f64, 0.0_f64, 0.0);
        for i in 0..3 {
            let (a, b) = (n[i] * self.start.min[i], n[i] * self.start.max[i]);
            let (l, h) = (n[i] * self.low[i], n[i] * self.high[i]);
            least += a.min(b);
            most += a.max(b);
            size += a.abs().max(b.abs());
            falls += l.min(h);
            climbs += l.max(h);
            steep += l.abs().max(h.abs());
        }
        let slack = size * (16.0 * U) + error + f64::MIN_POSITIVE;
        let (least, most) = (least - offset - slack, most - offset + slack);
        let slope = steep * (16.0 * U);
        let (falls, climbs) = (falls - slope, climbs + slope);
        let lowest = if falls < 0.0 { least + self.t_max * falls * (1.0 + 16.0 * U) } else { least };
        let highest = if climbs > 0.0 { most + self.t_max * climbs * (1.0 + 16.0 * U) } else { most };
        // The last sum was rounded at the size of its operands before they cancel. With NaN both
        // comparisons are false.
        let above = lowest > (least.abs() + lowest.abs()) * (4.0 * U);
        let below = highest < -((most.abs() + highest.abs()) * (4.0 * U));
        !above && !below
    }
}

impl Shaft8 {
    /// The mask of boxes that the bundle may meet; a bit that is not set is certain. Like
    /// [`Shaft::may_meet`] up to a few ulps.
    #[inline(always)]
    pub fn may_meet(&self, min: &Vec3<F8>, max: &Vec3<F8>) -> M8 {
        let (mut enter, mut exit, mut met) = (F8::ZERO, F8::splat(self.t_max), M8::ALL);
        let [[x1, x0], [y1, y0], [z1, z0]] = &self.cuts;
        for (cut, plane) in [(x1, max.x), (x0, -min.x), (y1, max.y), (y0, -min.y), (z1, max.z), (z0, -min.z)]
        {
            let room = (plane - cut.base) + LOST;
            let t = room * cut.inverse;
            let slack = t.abs() * WIDEN + LOST;
            // Comparisons with NaN leave the bound unchanged.
            match cut.kind {
                CutKind::Level => met &= !room.lt(F8::ZERO),
                CutKind::Exit => exit = (t + slack).lt(exit).select(t + slack, exit),
                CutKind::Enter => enter = (t - slack).gt(enter).select(t - slack, enter),
                CutKind::Nothing => {}
            }
        }
        met & enter.le(exit)
    }
}

impl Cut {
    fn new(base: f64, slope: f64) -> Self {
        const STEEP: f64 = 1.0 / LOST;
        let kind = if slope == 0.0 {
            CutKind::Level
        } else if slope > 0.0 && slope < STEEP {
            CutKind::Exit
        } else if slope < 0.0 && slope > -STEEP {
            CutKind::Enter
        } else {
            CutKind::Nothing
        };
        Self { base, inverse: 1.0 / slope, kind }
    }
}

/// Cuts `[enter, exit]` to the `t` with `t slope <= room`; never too much.
#[inline(always)]
fn clip(room: f64, slope: f64, enter: &mut f64, exit: &mut f64) {
    let room = room + LOST;
    if slope == 0.0 {
        if room < 0.0 {
            *exit = f64::NEG_INFINITY;
        }
        return;
    }
    let t = room / slope;
    let slack = t.abs() * WIDEN + LOST;
    // Comparisons with NaN leave the bound unchanged.
    if slope > 0.0 {
        if t + slack < *exit {
            *exit = t + slack;
        }
    } else if t - slack > *enter {
        *enter = t - slack;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Point3, Ray};
    use durer_testkit::TestRng;

    /// Draws that only these tests need.
    trait Draws {
        fn about(&mut self, n: u64) -> f64;
        fn lattice_point(&mut self, n: u64) -> Point3;
        /// A box, mostly with a width of zero on some axis.
        fn bounds(&mut self, n: u64) -> Aabb;
        fn corner(&mut self, b: &Aabb) -> Point3;
    }

    impl Draws for TestRng {
        fn about(&mut self, n: u64) -> f64 {
            self.below(2 * n + 1) as f64 - n as f64
        }

        fn lattice_point(&mut self, n: u64) -> Point3 {
            Point3::new(self.about(n), self.about(n), self.about(n))
        }

        fn bounds(&mut self, n: u64) -> Aabb {
            let (a, b) = (self.lattice_point(n), self.lattice_point(n));
            let keep = self.below(8);
            let b = Point3::from([0, 1, 2].map(|i| if keep >> i & 1 == 1 { a[i] } else { b[i] }));
            Aabb::from_points([a, b])
        }

        fn corner(&mut self, b: &Aabb) -> Point3 {
            Point3::from([0, 1, 2].map(|i| if self.below(2) == 0 { b.min[i] } else { b.max[i] }))
        }
    }

    #[test]
    fn no_box_that_a_ray_of_the_bundle_meets_is_missed() {
        let (mut met, mut missed, mut missed_by_lanes) = (0, 0, 0);
        let mut dice = TestRng::new(1);
        for _ in 0..20_000 {
            let start = dice.bounds(9);
            let toward = dice.bounds(9);
            let (shaft, ray, far) = if dice.below(2) == 0 {
                let (low, high) = (toward.min.to_vec(), toward.max.to_vec());
                let ray = Ray::new(dice.corner(&start), dice.corner(&toward).to_vec());
                (Shaft::new(start, low, high), ray, dice.below(9) as f64)
            } else {
                let o = dice.corner(&start);
                let ray = Ray::new(o, dice.corner(&toward) - o).with_range(0.0, 1.0);
                (Shaft::between(start, toward), ray, dice.below(5) as f64 / 4.0)
            };
            if ray.direction == Vec3::ZERO {
                continue;
            }
            // A box that the ray touches in this exact point, at least.
            let p = ray.at(far);
            let side = dice.bounds(3).max.to_vec().abs();
            let bounds = Aabb::new(p - if dice.below(2) == 0 { side } else { Vec3::ZERO }, p + side);
            assert!(shaft.may_meet(&bounds), "{shaft:?} {ray:?} {bounds:?}");
            met += 1;
            // And any box: one that is excluded contains no point of the ray.
            let other = dice.bounds(20);
            let eight = |i: usize| if i.is_multiple_of(2) { &bounds } else { &other };
            let corner = |f: fn(&Aabb) -> Vec3| {
                let axis = |k: usize| F8(core::array::from_fn(|i| f(eight(i))[k]));
                Vec3::new(axis(0), axis(1), axis(2))
            };
            let lanes = shaft.lanes().may_meet(&corner(|b| b.min.to_vec()), &corner(|b| b.max.to_vec()));
            assert!([0, 2, 4, 6].iter().all(|&i| lanes.lane(i)), "{shaft:?} {ray:?} {bounds:?}");
            assert!([1, 3, 5, 7].iter().all(|&i| lanes.lane(i) == lanes.lane(1)));
            missed_by_lanes += usize::from(!lanes.lane(1));
            if !shaft.may_meet(&other) || !lanes.lane(1) {
                missed += 1;
                for k in 0..=8 {
                    let t = if ray.t_max == 1.0 { f64::from(k) / 8.0 } else { f64::from(k) };
                    assert!(!other.contains(ray.at(t)), "{shaft:?} {ray:?} {other:?}");
                }
            }
        }
        assert!(met > 15_000 && missed > 5_000, "{met} {missed}");
        assert!(missed_by_lanes * 1000 > missed * 999, "{missed_by_lanes} {missed}");
    }

    #[test]
    fn no_plane_that_a_ray_of_the_bundle_crosses_is_missed() {
        let (mut crossed, mut missed) = (0, 0);
        let mut dice = TestRng::new(2);
        for _ in 0..20_000 {
            let (start, end) = (dice.bounds(9), dice.bounds(9));
            let shaft = Shaft::between(start, end);
            let (a, b) = (dice.corner(&start), dice.corner(&end));
            let n = dice.lattice_point(4).to_vec();
            let on = a + (b - a) * (dice.below(5) as f64 / 4.0);
            assert!(shaft.may_cross(n, n.dot(on.to_vec()), 0.0), "{shaft:?} {n:?} {on:?}");
            crossed += 1;
            let h = dice.about(60);
            if !shaft.may_cross(n, h, 0.0) {
                missed += 1;
                let (low, high) = (n.dot(a.to_vec()) - h, n.dot(b.to_vec()) - h);
                assert!(low * high > 0.0, "{shaft:?} {n:?} {h}");
            }
        }
        assert!(crossed == 20_000 && missed > 5_000, "{missed}");
    }

    #[test]
    fn no_plane_ahead_of_endless_rays_is_missed() {
        let (mut crossed, mut missed) = (0, 0);
        let mut dice = TestRng::new(3);
        for _ in 0..20_000 {
            let (start, way) = (dice.bounds(9), dice.bounds(9));
            let shaft = Shaft::new(start, way.min.to_vec(), way.max.to_vec());
            let (o, d) = (dice.corner(&start), dice.corner(&way).to_vec());
            let (n, h) = (dice.lattice_point(4).to_vec(), dice.about(60));
            let (height, slope) = (n.dot(o.to_vec()) - h, n.dot(d));
            if height * slope < 0.0 || height == 0.0 {
                crossed += 1;
                assert!(shaft.may_cross(n, h, 0.0), "{shaft:?} {n:?} {h}");
            }
            missed += usize::from(!shaft.may_cross(n, h, 0.0));
        }
        assert!(crossed > 5_000 && missed > 1_000, "{crossed} {missed}");
    }
}
