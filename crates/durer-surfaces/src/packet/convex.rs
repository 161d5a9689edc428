//! The part of each of eight rays inside all faces of a convex solid: after the last entry and
//! before the first exit (T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986, for
//! any convex faces).

use super::quadratic_roots::{PlaneRoot, Roots, SlabRoots};
use durer_math::{F8, Isa, M8};

/// The greatest entry so far; with the signs exchanged, the least exit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extreme {
    pub(crate) t: F8,
    pub(crate) e: F8,
    pub(crate) face: F8,
    /// The upper end of all other entries.
    pub(crate) others: F8,
}

pub(crate) const BEFORE: F8 = F8::splat(f64::NEG_INFINITY);

impl Extreme {
    #[inline(always)]
    pub(crate) fn take(&mut self, is_first: bool, lanes: M8, t: F8, e: F8, face: F8) {
        if is_first {
            self.t = lanes.select(t, BEFORE);
            self.e = lanes.keep(e);
            self.face = face;
            self.others = BEFORE;
            return;
        }
        let better = lanes & t.gt(self.t);
        let loser = better.select(self.t + self.e, t + e);
        self.others.set_where(lanes, loser.max(self.others));
        self.t.set_where(better, t);
        self.e.set_where(better, e);
        self.face.set_where(better, face);
    }
}

/// Entry and exit from the faces seen so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hull {
    /// The latest entry.
    pub(crate) enter: Extreme,
    /// The earliest exit, negated.
    pub(crate) leave: Extreme,
    pub(crate) missed: M8,
    pub(crate) unsure: M8,
}

impl Hull {
    /// Adds face `i`, a plane.
    #[inline(never)]
    pub(super) fn add_plane(&mut self, isa: Isa, i: usize, root: &PlaneRoot) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.add_doubts(i, root.above, root.crosses | root.below);
                let face = F8::splat(i as f64);
                self.enter.take(i == 0, root.crosses & root.falls, root.t, root.e, face);
                self.leave.take(i == 0, root.crosses & !root.falls, -root.t, root.e, face);
            },
        );
    }

    /// Adds the faces `i` and `i + 1`, two planes that bound a slab.
    #[inline(never)]
    pub(super) fn add_slab(&mut self, isa: Isa, i: usize, roots: &SlabRoots) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.add_doubts(i, roots.outside, roots.known | roots.inside);
                let (first, second) = (F8::splat(i as f64), F8::splat((i + 1) as f64));
                let (enter, leave) = (roots.rises.select(first, second), roots.rises.select(second, first));
                self.enter.take(i == 0, roots.known, roots.enter, roots.e_enter, enter);
                self.leave.take(i == 0, roots.known, -roots.leave, roots.e_leave, leave);
            },
        );
    }

    /// Adds face `i`, a quadric.
    #[inline(never)]
    pub(super) fn add_quadric(&mut self, isa: Isa, i: usize, roots: &Roots) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let known = roots.known & roots.opens;
                self.add_doubts(i, roots.none & roots.opens, known);
                let face = F8::splat(i as f64);
                self.enter.take(i == 0, known, roots.enter, roots.e_enter, face);
                self.leave.take(i == 0, known, -roots.leave, roots.e_leave, face);
            },
        );
    }

    #[inline(always)]
    pub(super) fn add_doubts(&mut self, i: usize, missed: M8, known: M8) {
        let unsure = !(missed | known);
        if i == 0 {
            (self.missed, self.unsure) = (missed, unsure);
        } else {
            self.missed |= missed;
            self.unsure |= unsure;
        }
    }
}
