//! The state of a ray during its traversal of trees and instances.

use crate::arena::Filter;
use crate::closest::Placement;
use crate::geometry::{Geometry, Instance};
use durer_bvh::{Leaf, Ray64};
use durer_math::eft::{exponent, scale2};
use durer_math::{Ray, Source, U};
use durer_surfaces::{LocalRay, WideCache};

/// The relation of the caller's parameter `t` to a local ray's parameter `s`, which culling needs:
/// `t = shift + 2^k s`, within `err`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    shift: f64,
    err: f64,
    k: i32,
}

impl Clock {
    /// The relation for a ray in its own frame.
    #[inline(always)]
    pub(crate) fn of(ray: &Ray) -> Self {
        Self { shift: 0.0, err: 0.0, k: -exponent(ray.direction.max_abs()) }
    }

    /// The relation for a ray that an affine map has transformed.
    #[inline(always)]
    fn then(self, ray: &LocalRay<'_>) -> Self {
        let Some((step, k)) = ray.parent_clock() else { return self };
        let shift = self.shift + scale2(step, self.k);
        Self { shift, err: self.err + 2.0 * U * shift.abs(), k: self.k + k }
    }

    /// An upper bound on the `s` of `t`.
    #[inline(always)]
    pub(crate) fn above(&self, t: f64) -> f64 {
        self.bound(t, 1.0)
    }

    /// A lower bound on the `s` of `t`.
    #[inline(always)]
    fn below(&self, t: f64) -> f64 {
        self.bound(t, -1.0)
    }

    #[inline(always)]
    fn bound(&self, t: f64, away: f64) -> f64 {
        if t.is_infinite() {
            return t;
        }
        // Exact without a shift; else there is one rounding of the difference, and one of the
        // slack.
        let moved = if self.shift == 0.0 && self.err == 0.0 {
            t
        } else {
            away.mul_add((t.abs() + self.shift.abs()).mul_add(4.0 * U, self.err * 2.0), t - self.shift)
        };
        let s = scale2(moved, -self.k);
        if s == 0.0 && moved != 0.0 { away * f64::MIN_POSITIVE } else { s }
    }
}

/// A ray in one geometry's frame, and what it can hit there.
pub(crate) struct RayContext<'a> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) ray: &'a LocalRay<'a>,
    pub(crate) clock: Clock,
    pub(crate) placement: Placement,
    pub(crate) mask: u32,
    pub(crate) source: Option<Source>,
}

impl<'a> RayContext<'a> {
    #[inline(always)]
    pub(crate) fn new(geometry: &'a Geometry, ray: &Ray, local: &'a LocalRay<'a>, mask: u32) -> Self {
        Self {
            geometry,
            ray: local,
            clock: Clock::of(ray),
            placement: Placement::default(),
            mask,
            source: ray.source(),
        }
    }

    /// The primitives of an arena that the ray can hit.
    #[inline(always)]
    pub(crate) fn filter(&self, arena: u32) -> Filter {
        let source = self.source.filter(|s| s.arena == arena && s.instance == self.placement.instance);
        Filter { mask: self.mask, source: source.map(|s| (s.index, s.side)) }
    }

    /// Whether the mask lets the ray hit a triangle.
    #[inline(always)]
    pub(crate) fn admits(&self, triangle: Leaf) -> bool {
        self.geometry.arenas[triangle.kind as usize].mask(triangle.first) & self.mask != 0
    }

    /// The ray in the tree's form.
    #[inline(always)]
    pub(crate) fn line(&self) -> Ray64 {
        let r = self.ray;
        Ray64 {
            origin: r.o,
            direction: r.d,
            origin_error: r.o_err,
            direction_error: r.d_err,
            t_min: self.clock.below(r.t_min),
            t_max: self.clock.above(r.t_max),
            inner: (self.clock.above(r.t_min), self.clock.below(r.t_max)),
        }
    }

    /// A bound, in the tree's parameter, on all crossings that could be less than a hit with this
    /// upper end.
    ///
    /// A bracket is at most 32 ulp of `max(|t|, size / |d|)` wide on either side of the exact
    /// crossing (wider ones are computed again in double-double), so a rounded `t` can precede the
    /// exact one by no more: twice that is added.
    #[inline(always)]
    pub(crate) fn limit(&self, t_hi: f64) -> f64 {
        let s = self.clock.above(t_hi);
        let t = scale2(t_hi.abs(), -self.clock.k);
        (t + self.geometry.tree.size()).mul_add(128.0 * U, s)
    }

    /// Calls `f` with the ray in an instance's frame, if the mask lets it hit the instance.
    #[inline(always)]
    pub(crate) fn enter<R>(&self, instance: &Instance, f: impl FnOnce(&RayContext<'_>) -> R) -> Option<R> {
        if instance.mask & self.mask == 0 {
            return None;
        }
        Some(self.geometry.isa.run(
            #[inline(always)]
            || {
                let kept = WideCache::new();
                let ray = self.ray.through(&instance.affine).keeping(&kept);
                f(&RayContext {
                    geometry: &instance.geometry,
                    ray: &ray,
                    clock: self.clock.then(&ray),
                    placement: instance.within(&self.placement),
                    mask: self.mask,
                    source: self.source,
                })
            },
        ))
    }
}
