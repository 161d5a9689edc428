//! Eight rays, and the first hit of each.
//!
//! Every parameter `t` comes with a bound `e` on its error. What the bounds decide is certain;
//! everything else is recorded as a doubt, at the least `t` at which it can matter. Comparisons are
//! written so that NaN ends as a doubt.

use super::quadric::taxicab;
use durer_math::{F8, Isa, M8, Point3, U, Vec3};

/// Eight rays `o + t d`, `t` in `[0, t_max]`, as packet filters use them.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes<'a> {
    pub(crate) isa: Isa,
    pub(crate) origin: &'a Point3<F8>,
    pub(crate) direction: &'a Vec3<F8>,
    pub(crate) t_max: &'a F8,
    pub(crate) live: &'a M8,
    /// `|d|₁`, one over it, and `d·d`.
    pub(crate) d1: F8,
    pub(crate) inverse_d1: F8,
    pub(crate) d2: F8,
}

/// Rays that start on the very surface under test.
#[derive(Clone, Copy, Debug)]
pub struct From8 {
    /// The lanes of these rays.
    pub lanes: M8,
    /// The face on which each starts, as a number.
    pub face: F8,
    /// The rays that start behind the face, by the normal of hits.
    pub back: M8,
}

impl From8 {
    /// Converts the rays' sides to those of the surface's own normals, which are opposite to those
    /// of hits if the surface is `turned`.
    #[inline(always)]
    pub(crate) fn by_own_normals(&self, turned: bool) -> Self {
        Self { back: if turned { !self.back } else { self.back }, ..*self }
    }

    /// The side of a solid on which the rays start: -1 inside, 1 outside, 0 for rays that start
    /// elsewhere. The solid is negative inside, or the complement of that set if `turned`.
    #[inline(always)]
    pub(crate) fn side(&self, turned: bool) -> F8 {
        let inside = if turned { !self.back } else { self.back };
        self.lanes.keep(inside.select(F8::splat(-1.0), F8::ONE))
    }
}

/// The first certain hit so far, and the first doubt.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// The hit's parameter; infinite if there is no hit.
    pub t: F8,
    /// The bound on the error of `t`.
    pub e: F8,
    /// The filter's number, as the caller gave it.
    pub number: F8,
    /// The face of the filter.
    pub face: F8,
    /// The face's own data for computing the point later.
    pub tag: F8,
    /// From this parameter on nothing is certain; infinite without a doubt.
    pub doubt: F8,
}

pub(crate) const NEVER: F8 = F8::splat(f64::INFINITY);
/// Covers the roundings of error bounds.
pub(crate) const SLACK: f64 = 1.0 + 64.0 * U;
/// A divisor is used only if it is this many times its error.
pub(crate) const CLEAR: f64 = 4.0;
/// A parameter certainly before the start of a ray.
pub(crate) const BEHIND: f64 = -f64::MIN_POSITIVE;
/// Farther than any crossing; its products with ordinary numbers are ordinary.
pub(crate) const FAR: f64 = durer_math::scale::pow2(500);

/// Directions are shorter than this and longer than its inverse; other products could leave the
/// range in which the error bounds hold. A face adds what its own products with these may lose to
/// underflow (`quadric.rs`).
const LONGEST: f64 = durer_math::scale::pow2(200);

impl Nearest {
    /// No hit yet. Rays whose directions are too long or too short for packets are doubts.
    #[inline]
    pub fn of(rays: &RayLanes<'_>) -> Self {
        let mut doubt = NEVER;
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let ordinary = rays.d1.lt(F8::splat(LONGEST)) & rays.d1.gt(F8::splat(1.0 / LONGEST));
                doubt = ordinary.select(NEVER, F8::ZERO);
            },
        );
        Self { t: NEVER, e: F8::ZERO, number: F8::ZERO, face: F8::ZERO, tag: F8::ZERO, doubt }
    }

    /// The parameter beyond which no crossing can be the first.
    #[inline(always)]
    pub fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        (self.t + self.e).min(*rays.t_max)
    }

    /// Records that some rays certainly cross a face at `t`, known within `e`.
    #[inline(always)]
    pub fn take(&mut self, sure: M8, t: F8, e: F8, number: f64, face: F8) {
        let better = sure & t.lt(self.t);
        self.t.set_where(better, t);
        self.e.set_where(better, e);
        self.number.set_where(better, F8::splat(number));
        self.face.set_where(better, face);
    }

    /// Records a certain crossing with data of the face for computing the point later.
    #[inline(always)]
    pub fn take_at(&mut self, sure: M8, (t, e): (F8, F8), number: f64, face: F8, tag: F8) {
        let better = sure & t.lt(self.t);
        self.tag.set_where(better, tag);
        self.take(sure, t, e, number, face);
    }

    /// Records a doubt for those live rays of which none of these is known.
    #[inline(always)]
    pub(crate) fn doubt_unless(&mut self, live: &M8, known: &[&M8]) {
        let unsure = known.iter().fold(*live, |unsure, known| unsure & !**known);
        if unsure.any() {
            self.doubt_from(unsure, F8::ZERO);
        }
    }

    /// Records that nothing is certain from `t` on for some rays.
    #[inline(always)]
    pub fn doubt_from(&mut self, where_: M8, t: F8) {
        // `max` returns zero for NaN.
        let from = t.max(F8::ZERO);
        self.doubt.set_where(where_ & from.lt(self.doubt), from);
    }
}

impl<'a> RayLanes<'a> {
    /// Eight rays; lanes that are not live may hold anything.
    #[inline]
    pub fn new(
        isa: Isa,
        origin: &'a Point3<F8>,
        direction: &'a Vec3<F8>,
        t_max: &'a F8,
        live: &'a M8,
    ) -> Self {
        let (mut d1, mut inverse_d1, mut d2) = (F8::ZERO, F8::ZERO, F8::ZERO);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let d = direction;
                d1 = taxicab(*d) * SLACK;
                inverse_d1 = F8::ONE / d1;
                d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            },
        );
        Self { isa, origin, direction, t_max, live, d1, inverse_d1, d2 }
    }
}
