//! The shaft: all that a bundle of rays can reach.
//!
//! ```text
//!            ╱│            the rays start in a box, and each component of their directions is in an interval:
//!     ┌─┐ ╱   │            at t, the bundle lies in the box  [a_i + t l_i, b_i + t u_i]
//!     └─┘ ╲   │
//!            ╲│
//! ```
//!
//! A box `[m, M]` can be met only where `a_i + t l_i <= M_i` and `b_i + t u_i >= m_i` on every axis: six linear inequalities for `t`, whose common
//! solutions are an interval. If it is empty, no ray of the bundle meets the box. Neighbouring rays (the pixels of a tile, the rays of a small
//! region to one lamp) can so share one walk through the tree. After E. A. Haines, J. R. Wallace, "Shaft culling for efficient ray-traced
//! radiosity", *Eurographics Workshop on Rendering* (1991).

use crate::{Aabb, Ray, U, Vec3};

/// A bundle of rays: origins in a box, directions between two bounds per axis, `t` in `[0, t_max]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaft {
    start: Aabb,
    low: Vec3,
    high: Vec3,
    t_max: f64,
}

/// A slope below this has no reciprocal worth dividing by: it gives no bound.
const LEAST_SLOPE: f64 = 1.0 / (1_u128 << 100) as f64 / (1_u128 << 100) as f64;
/// More than the roundings of a difference, of a reciprocal and of their product.
const WIDEN: f64 = 8.0 * U;

impl Shaft {
    /// The rays that start in `start` with directions between `low` and `high`, however far they go.
    pub fn new(start: Aabb, low: Vec3, high: Vec3) -> Self {
        Self { start, low, high, t_max: f64::INFINITY }
    }

    /// The rays with `t` in `[0, 1]` that start in one box and end in another.
    pub fn between(start: Aabb, end: Aabb) -> Self {
        // Far more than the roundings of this difference and of those by which `holds` keeps clear of the border.
        let slack = |a: f64, b: f64| (a.abs() + b.abs()) * (16.0 * U) + f64::MIN_POSITIVE;
        let low = |a: f64, b: f64| (b - a) - slack(a, b);
        let high = |a: f64, b: f64| (b - a) + slack(a, b);
        let (a, b) = (start, end);
        Self {
            start,
            low: Vec3::new(low(a.min.x, b.min.x), low(a.min.y, b.min.y), low(a.min.z, b.min.z)),
            high: Vec3::new(high(a.max.x, b.max.x), high(a.max.y, b.max.y), high(a.max.z, b.max.z)),
            t_max: 1.0,
        }
    }

    /// Whether a ray belongs to the bundle: `true` is certain.
    #[inline(always)]
    pub fn holds(&self, ray: &Ray) -> bool {
        let Aabb { min: a, max: b } = self.start;
        let (o, d) = (ray.origin, ray.direction);
        if self.t_max == f64::INFINITY {
            return ray.t_min >= 0.0
                && (a.x <= o.x && a.y <= o.y && a.z <= o.z && o.x <= b.x && o.y <= b.y && o.z <= b.z)
                && (self.low.x <= d.x && self.low.y <= d.y && self.low.z <= d.z)
                && (d.x <= self.high.x && d.y <= self.high.y && d.z <= self.high.z);
        }
        // Linear in t, so both ends tell. The sums are rounded; `within` keeps clear of the border by more than that.
        ray.t_min >= 0.0
            && ray.t_max <= self.t_max
            && within([a.x, b.x], [self.low.x, self.high.x], o.x, d.x)
            && within([a.y, b.y], [self.low.y, self.high.y], o.y, d.y)
            && within([a.z, b.z], [self.low.z, self.high.z], o.z, d.z)
    }

    /// Whether the bundle may meet a box: `false` is certain.
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
        // Neither is ever a NaN: what is not a number cuts nothing.
        enter <= exit
    }

    /// Whether the bundle may meet the plane of the points with `normal . p = offset`, of which the offset is known within `error`: `false` is
    /// certain.
    pub fn may_cross(&self, normal: Vec3, offset: f64, error: f64) -> bool {
        let n = normal;
        // The least and the greatest height over the start, and how it changes.
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
        let rounded = (least.abs() + lowest.abs()).min(f64::MAX) * (4.0 * U);
        let rounded = rounded + (most.abs() + highest.abs()).min(f64::MAX) * (4.0 * U);
        // Where something is not a number, nothing is disproved.
        let above = lowest > rounded;
        let below = highest < -rounded;
        !above && !below
    }
}

/// Whether `o + t d` is between `a + t low` and `b + t high` for all `t` in `[0, 1]`, surely.
#[inline(always)]
fn within([a, b]: [f64; 2], [low, high]: [f64; 2], o: f64, d: f64) -> bool {
    let end = o + d;
    let slack = (o.abs() + d.abs()) * (2.0 * U);
    let (least, most) =
        ((a + low) + (a.abs() + low.abs()) * (2.0 * U), (b + high) - (b.abs() + high.abs()) * (2.0 * U));
    a <= o && o <= b && end - slack >= least && end + slack <= most
}

/// Cuts `[enter, exit]` to the `t` with `t slope <= room`; never too much.
#[inline(always)]
fn clip(room: f64, slope: f64, enter: &mut f64, exit: &mut f64) {
    if slope.abs() < LEAST_SLOPE {
        if slope == 0.0 && room < 0.0 {
            *exit = f64::NEG_INFINITY;
        }
        return;
    }
    let t = room / slope;
    // Comparisons with NaN keep what there was.
    if slope > 0.0 {
        let t = t + t.abs() * WIDEN;
        if t < *exit {
            *exit = t;
        }
    } else {
        let t = t - t.abs() * WIDEN;
        if t > *enter {
            *enter = t;
        }
    }
}
