//! Decides on which side of a solid a ray starts.

use super::ALL;
use core::ops::ControlFlow;
use durer_math::RaySide;
use durer_math::eft::{exponent, scale2};
use durer_math::scale::pow2;
use durer_surfaces::{Accelerate, LocalPoint, LocalRay, Root, Side, Sink};

/// Whether a ray starts (at `t_min`) inside a solid, for solids whose crossings within the range do
/// not decide it; `start` is some point of its line.
///
/// A crossing exactly at the start belongs to the range, and its sign decides. Else the crossings
/// before and behind the range decide. If the line crosses the solid nowhere, and the solid is
/// unbounded, the exact side of a point of the line decides; this point must not be where the line
/// enters and leaves the solid within rounding. A point may be proven inside though no chord is
/// known there: where a tangent touches a formula's solid within rounding.
pub(super) fn starts_inside<S: Accelerate>(surface: &S, ray: &LocalRay<'_>, start: &LocalPoint<'_>) -> bool {
    if let Some(side) = ray.source {
        return side == RaySide::Back;
    }
    let mut pairs = Hull::default();
    let mut signs = |t_min: f64, t_max: f64| {
        let mut part_of_line = *ray;
        (part_of_line.t_min, part_of_line.t_max) = (t_min, t_max);
        let mut ends = Ends::default();
        surface.roots::<dyn Sink>(&part_of_line, &mut ends);
        let ends = ends.closed();
        pairs.add(ends.pairs);
        ends
    };
    if let Some(sign) = signs(ray.t_min, ray.t_min).first {
        return sign > 0;
    }
    if let Some(sign) = signs(f64::NEG_INFINITY, ray.t_min).last {
        return sign < 0;
    }
    // A crossing exactly at the end belongs to the range, too. The state behind it is the state at
    // the start, as the crossings of the range cancel.
    if let Some(sign) = signs(ray.t_max, ray.t_max).last {
        return sign < 0;
    }
    if let Some(sign) = signs(ray.t_max, f64::INFINITY).first {
        return sign > 0;
    }
    if surface.bounds().is_bounded() {
        // The line comes from outside, leaves to the outside, and does not cross the solid between.
        return false;
    }
    match side_beside(surface, ray, start, pairs) {
        Side::In => true,
        Side::Out => false,
        Side::On => runs_inside(surface, ray),
    }
}

/// The side of the line apart from touches and pairs of crossings, which are all within `pairs`;
/// `On` if it is not found.
fn side_beside<S: Accelerate>(surface: &S, ray: &LocalRay<'_>, start: &LocalPoint<'_>, pairs: Hull) -> Side {
    let Some((low, high)) = pairs.0 else { return surface.side(start) };
    // At growing distances from the origin of the ray's own parameter, which is near the surface's
    // middle.
    let places = (0..128).flat_map(|j| [pow2(j), -pow2(j)]);
    let beside = places.filter(|&s| {
        let (before, after) = ray.caller_bounds(s);
        after < low || high < before
    });
    beside
        .take(16)
        .map(|s| surface.side(&LocalPoint::along(ray, s)))
        .find(|&side| side != Side::On)
        .unwrap_or(Side::On)
}

/// The least interval that contains some brackets.
#[derive(Clone, Copy, Default)]
struct Hull(Option<(f64, f64)>);

impl Hull {
    fn add(&mut self, other: Self) {
        self.0 = match (self.0, other.0) {
            (Some((a, b)), Some((c, d))) => Some((a.min(c), b.max(d))),
            (a, b) => a.or(b),
        };
    }
}

/// Whether a line lies in a closed solid that it does not cross, though it may touch it in single
/// points.
///
/// All its other points lie on one side. Solids with quadric faces, of which there are six at most,
/// are touched in at most twelve points; a line in a face of a solid of many faces has left the
/// face where it has left the box. If no point is found off the boundary, the line lies in the
/// boundary, and so in the closed solid.
fn runs_inside<S: Accelerate>(surface: &S, ray: &LocalRay<'_>) -> bool {
    let bounds = surface.bounds();
    let far = bounds.max.to_vec().max_abs().max(bounds.min.to_vec().max_abs()).max(ray.o.to_vec().max_abs());
    let beyond = if far.is_finite() { scale2(1.0, (exponent(far) + 2).min(1000)) } else { 1.0 };
    let near = (1..=7).map(f64::from);
    let mut sides =
        near.chain([beyond]).flat_map(|s| [s, -s]).map(|s| surface.side(&LocalPoint::along(ray, s)));
    sides.find(|&side| side != Side::On) != Some(Side::Out)
}

/// The signs of the first and the last crossing that changes sides. Crossings whose brackets
/// overlap count as one, by their sum: where the line touches an edge, it enters and leaves at one
/// point, or leaves and enters, and their order has no meaning.
#[derive(Default)]
struct Ends {
    first: Option<i32>,
    last: Option<i32>,
    /// The crossings that overlap the last one: their sum, and the ends of their common interval.
    group: Option<(i32, (f64, f64))>,
    /// Touches, and groups that cancel.
    pairs: Hull,
}

impl Ends {
    /// Ends the group.
    fn closed(mut self) -> Self {
        match self.group.take() {
            Some((0, ends)) => self.pairs.add(Hull(Some(ends))),
            Some((sum, _)) => {
                self.first = self.first.or(Some(sum));
                self.last = Some(sum);
            }
            None => {}
        }
        self
    }
}

impl Sink for Ends {
    fn range(&self) -> (f64, f64) {
        ALL
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        let sign = i32::from(root.sign);
        if sign == 0 {
            self.pairs.add(Hull(Some((root.lo, root.hi))));
            return ControlFlow::Continue(());
        }
        *self = match self.group {
            Some((sum, (from, reach))) if root.lo <= reach => {
                let ends = (from.min(root.lo), reach.max(root.hi));
                Self { group: Some((sum + sign, ends)), ..core::mem::take(self) }
            }
            _ => Self { group: Some((sign, (root.lo, root.hi))), ..core::mem::take(self).closed() },
        };
        ControlFlow::Continue(())
    }
}
