//! Eight rays, and the first of what they meet.
//!
//! Every parameter `t` comes with a bound `e` on its error. What is decided with its help is certain; the rest is put down as a doubt, at the least `t`
//! at which it can matter. Comparisons are written so that what is not a number ends as a doubt.

use super::quadric::taxicab;
use durer_math::{F8, Isa, M8, Point3, U, Vec3};

/// Eight rays `o + t d` with `t` in `[0, t_max]`, as far as outlines are concerned.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes<'a> {
    pub(super) isa: Isa,
    pub(super) origin: &'a Point3<F8>,
    pub(super) direction: &'a Vec3<F8>,
    pub(super) t_max: &'a F8,
    pub(super) live: &'a M8,
    /// `|d|₁`, one over it, and `d·d`.
    pub(super) d1: F8,
    pub(super) inverse_d1: F8,
    pub(super) d2: F8,
}

/// Rays that leave the very outline under test.
#[derive(Clone, Copy, Debug)]
pub struct From8 {
    /// Which do.
    pub lanes: M8,
    /// From which face, as a number.
    pub face: F8,
    /// Which start behind it, by the normal that hits have.
    pub back: M8,
}

impl From8 {
    /// On which side of a solid that is negative inside they start: -1 inside, 1 outside, 0 where they leave something else. `turned` if the solid is inside out.
    #[inline(always)]
    pub(super) fn side(&self, turned: bool) -> F8 {
        let inside = if turned { !self.back } else { self.back };
        self.lanes.keep(inside.select(F8::splat(-1.0), F8::ONE))
    }
}

/// The first sure hit so far, and the first doubt.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Where; infinite where there is none.
    pub t: F8,
    /// How far from there the crossing may be.
    pub e: F8,
    /// The outline's number, as the caller gave it.
    pub number: F8,
    /// The face of that outline.
    pub face: F8,
    /// What the face wants to know of the point when that is asked for.
    pub tag: F8,
    /// From here on nothing is sure; infinite without a doubt.
    pub doubt: F8,
}

pub(super) const NEVER: F8 = F8::splat(f64::INFINITY);
/// Pays for the roundings of error bounds.
pub(super) const SLACK: f64 = 1.0 + 64.0 * U;
/// A divisor is trusted if it is this many times its error.
pub(super) const CLEAR: f64 = 4.0;
/// Behind the start of a ray, surely.
pub(super) const BEHIND: f64 = -f64::MIN_POSITIVE;
/// Farther than anything; its products with ordinary numbers are ordinary.
pub(super) const FAR: f64 = durer_math::scale::pow2(500);

/// Directions are shorter than this, and longer than one over it, or their products could leave the range in which error bounds hold. A face adds what products
/// of its own and of these may lose below the normal numbers (`quadric.rs`).
const LONGEST: f64 = durer_math::scale::pow2(200);

impl Nearest {
    /// Nothing is met yet; of rays with directions too long or too short for lanes nothing is sure.
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

    /// No crossing behind this can win.
    #[inline(always)]
    pub fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        (self.t + self.e).min(*rays.t_max)
    }

    /// Some rays surely cross a face at `t` within `e`.
    #[inline(always)]
    pub fn take(&mut self, sure: M8, t: F8, e: F8, number: f64, face: F8) {
        let better = sure & t.lt(self.t);
        self.t.set_where(better, t);
        self.e.set_where(better, e);
        self.number.set_where(better, F8::splat(number));
        self.face.set_where(better, face);
    }

    /// The same of faces that want to know more of a point.
    #[inline(always)]
    pub fn take_at(&mut self, sure: M8, (t, e): (F8, F8), number: f64, face: F8, tag: F8) {
        let better = sure & t.lt(self.t);
        self.tag.set_where(better, tag);
        self.take(sure, t, e, number, face);
    }

    /// Of live rays of which none of these is known nothing is sure.
    #[inline(always)]
    pub(super) fn doubt_unless(&mut self, live: &M8, known: &[&M8]) {
        let unsure = known.iter().fold(*live, |unsure, known| unsure & !**known);
        if unsure.any() {
            self.doubt_from(unsure, F8::ZERO);
        }
    }

    /// Of some rays nothing is sure from `t` on.
    #[inline(always)]
    pub fn doubt_from(&mut self, where_: M8, t: F8) {
        // `max` answers zero for what is not a number.
        let from = t.max(F8::ZERO);
        self.doubt.set_where(where_ & from.lt(self.doubt), from);
    }
}

impl<'a> RayLanes<'a> {
    /// Eight rays; those that are not live may hold anything.
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
