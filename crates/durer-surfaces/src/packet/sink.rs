//! Where the crossings of eight rays go: the first ones to [`Nearest`], all of an operand to [`Crossings`].

use super::crossings::Crossings;
use super::rays::{Nearest, RayLanes};
use durer_math::{F8, M8};

/// Where crossings go.
pub(super) trait Sink8 {
    /// All crossings are asked for, not only the first ones.
    const ALL: bool;
    /// Crossings behind this do not matter.
    fn limit(&self, rays: &RayLanes<'_>) -> F8;
    /// Some rays surely cross a face at `t` within `e`.
    fn take(&mut self, sure: M8, at: (F8, F8), face: F8);
    /// The same of faces that want to know more of a point.
    fn take_at(&mut self, sure: M8, at: (F8, F8), face: F8, tag: F8);
    /// Of some rays nothing is sure from `t` on.
    fn doubt(&mut self, lanes: M8, t: F8);
}

/// The first crossings, under the number of an outline.
pub(super) struct First<'n> {
    pub(super) nearest: &'n mut Nearest,
    pub(super) number: f64,
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
