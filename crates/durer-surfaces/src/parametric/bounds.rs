//! The bounds that cut a sheet: a box or a ball.

use super::piece::Unit;
use crate::Container;
use durer_math::eft::scale2;
use durer_math::{Aabb, Interval, Point3, U};

/// Covers a few roundings of bounds.
const ROUNDED: f64 = 1.0 + 32.0 * U;

/// A box, which may be unbounded, and a ball if there is one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
    ball: Option<([f64; 3], f64)>,
}

impl Bounds {
    /// No bounds.
    pub(super) const NONE: Self = Self { low: [f64::NEG_INFINITY; 3], high: [f64::INFINITY; 3], ball: None };

    /// Whether there are none.
    pub(super) fn are_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The bounds of a container.
    pub(super) fn of(container: &Container) -> Self {
        match container {
            Container::Box(it) => {
                let (low, high) = (it.min(), it.max());
                Self { low: low.to_array(), high: high.to_array(), ball: None }
            }
            Container::Ball(it) => {
                let (c, r) = (it.centre().to_array(), it.radius());
                let low = c.map(|x| (x - r).next_down());
                Self { low, high: c.map(|x| (x + r).next_up()), ball: Some((c, r)) }
            }
        }
    }

    /// A box that holds them.
    pub(super) fn hull(&self) -> Aabb {
        let point = |[x, y, z]: [f64; 3]| Point3::new(x, y, z);
        Aabb::new(point(self.low), point(self.high))
    }

    /// Whether a box is certainly outside.
    pub(super) fn are_missed_by(&self, hull: &[Interval; 3]) -> bool {
        if (0..3).any(|c| hull[c].lo > self.high[c] || hull[c].hi < self.low[c]) {
            return true;
        }
        self.ball.is_some_and(|(centre, radius)| {
            let distance = (0..3).fold(0.0, |sum: f64, c| {
                let gap = (hull[c].lo - centre[c]).max(centre[c] - hull[c].hi).max(0.0);
                gap.mul_add(gap, sum)
            });
            distance > radius * radius * ROUNDED
        })
    }

    /// Whether a box is certainly within them.
    pub(super) fn hold(&self, hull: &[Interval; 3]) -> bool {
        if !(0..3).all(|c| self.low[c] <= hull[c].lo && hull[c].hi <= self.high[c]) {
            return false;
        }
        self.ball.is_none_or(|(centre, radius)| {
            let distance = (0..3).fold(0.0, |sum: f64, c| {
                let far = (hull[c].hi - centre[c]).max(centre[c] - hull[c].lo);
                far.mul_add(far, sum)
            });
            distance * ROUNDED <= radius * radius
        })
    }

    /// The bounds in units, rounded outward.
    pub(super) fn in_units(&self, unit: &Unit) -> Self {
        let mut out = self.clone();
        let mut moved = 0.0_f64;
        for c in 0..3 {
            let size = |x: f64| 2.0 * U * (x.abs() + unit.centre[c].abs());
            let to = |x: f64| if x.is_finite() { scale2(x, -unit.scale) } else { x };
            out.low[c] = to(self.low[c] - unit.centre[c] - size(self.low[c]));
            out.high[c] = to(self.high[c] - unit.centre[c] + size(self.high[c]));
            if let (Some((from, _)), Some((centre, _))) = (&self.ball, &mut out.ball) {
                centre[c] = to(from[c] - unit.centre[c]);
                moved += to(size(from[c]));
            }
        }
        if let Some((_, radius)) = &mut out.ball {
            *radius = (scale2(*radius, -unit.scale) + moved) * ROUNDED;
        }
        out
    }
}
