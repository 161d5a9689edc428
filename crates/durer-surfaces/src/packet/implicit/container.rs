//! The part of each of eight rays inside the container of a solid.
//!
//! A ray is inside a convex container at the latest after `max(t_i + e_i)` of the faces that it
//! enters, and it enters not before `t_i - e_i` of any of them; the same holds for the exit. The
//! face of entry is certain if its bracket lies behind those of all others (`convex.rs`).

use super::{Ends, LineExtent8};
use crate::packet::convex::Hull;
use durer_math::{F8, Isa, M8, U};

const NEVER: F8 = F8::splat(f64::INFINITY);

/// The part of each ray inside a convex container: from the last face that is entered to the first
/// that is left.
#[derive(Debug)]
pub(super) struct Held {
    pub(super) ends: Ends,
    /// Rays whose face of entry, or of exit, is certain, and the numbers of these faces.
    pub(super) enters: M8,
    pub(super) leaves: M8,
    pub(super) face_in: F8,
    pub(super) face_out: F8,
    /// The parameters of entry and exit, with their errors.
    pub(super) t_in: F8,
    pub(super) e_in: F8,
    pub(super) t_out: F8,
    pub(super) e_out: F8,
    /// Between these parameters the rays are certainly inside.
    pub(super) after: F8,
    pub(super) before: F8,
    /// A bound on the distance of the entry from `s = here`.
    pub(super) e_s: F8,
}

impl Held {
    /// No container.
    pub(super) const FREE: Self = Self {
        ends: Ends::Free,
        enters: M8::NONE,
        leaves: M8::NONE,
        face_in: F8::ZERO,
        face_out: F8::ZERO,
        t_in: F8::ZERO,
        e_in: F8::ZERO,
        t_out: F8::ZERO,
        e_out: F8::ZERO,
        after: F8::splat(f64::NEG_INFINITY),
        before: NEVER,
        e_s: F8::ZERO,
    };
    /// Computes the part inside the hull of the container's faces for rays with `t = t_c + s unit`.
    /// The part that is searched is widened by the rounding errors. The solid is described up to
    /// `slack` beyond the container.
    #[inline(never)]
    pub(super) fn put(
        &mut self,
        isa: Isa,
        cell: &Hull,
        (ends, slack): (Ends, f64),
        (t_c, unit): (&F8, &F8),
        part: &mut LineExtent8,
    ) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (t_c, unit) = (*t_c, *unit);
                let Hull { enter, leave, missed, unsure } = cell;
                let (t_in, t_out) = (enter.t, -leave.t);
                let (first, last) = (t_in - enter.e, t_out + leave.e);
                let missed = *missed | first.gt(last) | last.lt(F8::ZERO);
                let unsure = *unsure & !missed;
                let after = (t_in + enter.e).max(enter.others);
                let before = -((leave.t + leave.e).max(leave.others));
                // Three roundings of each.
                let pad_in = (first.abs() + t_c.abs()) / unit * (8.0 * U);
                let pad_out = (last.abs() + t_c.abs()) / unit * (8.0 * U);
                let (from, to) = ((first - t_c) / unit - pad_in, (last - t_c) / unit + pad_out);
                let wide = enter.e.max(leave.e) / unit * 2.0 + pad_in.max(pad_out) * 2.0;
                part.unsure |= !missed & (unsure | !wide.lt(F8::splat(slack)));
                part.from = missed.select(F8::ZERO, unsure.select(-NEVER, from));
                part.to = missed.select(-F8::ONE, unsure.select(NEVER, to));
                *self = Self {
                    ends,
                    enters: first.gt(F8::ZERO) & first.gt(enter.others) & after.lt(before),
                    leaves: (leave.t - leave.e).gt(leave.others) & after.lt(before),
                    face_in: enter.face,
                    face_out: leave.face,
                    t_in,
                    e_in: enter.e,
                    t_out,
                    e_out: leave.e,
                    after,
                    before,
                    e_s: after.lt(F8::ZERO).select(F8::ZERO, wide),
                };
            },
        );
    }
}
