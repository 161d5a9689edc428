//! Receivers of crossings: [`Nearest`] takes the first ones, [`Crossings`] takes all of an operand.

use super::crossings::Crossings;
use super::rays::{Nearest, RayLanes};
use durer_math::{F8, M8};

/// A receiver of the crossings of eight rays.
pub(crate) trait Sink8 {
    /// Whether all crossings are wanted, not only the first ones.
    const ALL: bool;
    /// The parameter beyond which crossings do not matter.
    fn limit(&self, rays: &RayLanes<'_>) -> F8;
    /// Records that some rays certainly cross a face at `t`, known within `e`.
    fn take(&mut self, sure: M8, at: (F8, F8), face: F8);
    /// Records a certain crossing with data of the face for computing the point later.
    fn take_at(&mut self, sure: M8, at: (F8, F8), face: F8, tag: F8);
    /// Records that nothing is certain from `t` on for some rays.
    fn doubt(&mut self, lanes: M8, t: F8);
}

/// The first crossings, under the number of a filter.
pub(crate) struct First<'n> {
    pub(crate) nearest: &'n mut Nearest,
    pub(crate) number: f64,
}

impl Sink8 for First<'_> {
    const ALL: bool = false;
    #[inline(always)]
    fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        self.nearest.limit(rays)
    }
    #[inline(always)]
    fn take(&mut self, sure: M8, (t, e): (F8, F8), face: F8) {
        self.nearest.take(sure, t, e, self.number, face);
    }
    #[inline(always)]
    fn take_at(&mut self, sure: M8, at: (F8, F8), face: F8, tag: F8) {
        self.nearest.take_at(sure, at, self.number, face, tag);
    }
    #[inline(always)]
    fn doubt(&mut self, lanes: M8, t: F8) {
        self.nearest.doubt_from(lanes, t);
    }
}

impl Sink8 for Crossings {
    const ALL: bool = true;
    #[inline(always)]
    fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        *rays.t_max
    }
    #[inline(always)]
    fn take(&mut self, sure: M8, (t, e): (F8, F8), face: F8) {
        self.push(sure, t, e, (face, F8::ZERO));
    }
    #[inline(always)]
    fn take_at(&mut self, sure: M8, (t, e): (F8, F8), face: F8, tag: F8) {
        self.push(sure, t, e, (face, tag));
    }
    #[inline(always)]
    fn doubt(&mut self, lanes: M8, t: F8) {
        self.doubt_from(lanes, t);
    }
}
