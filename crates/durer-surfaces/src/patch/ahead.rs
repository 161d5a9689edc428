//! Crossings that are passed on before a line has been searched to its end.
//!
//! Pieces come in the order in which the line may meet them. A crossing before the next piece is
//! not found again, and is not joined with a later one: either would have to lie in a later piece's
//! box. So it is passed on, and often the caller wants no more. Unproven crossings need all others
//! on the line, so the first of them ends this.

use super::line::Found;
use super::shell::ROOM;

/// How far a search has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    /// Once the next piece begins beyond this, the first crossings are final.
    pub(super) due: f64,
    /// Crossings up to here have been passed on.
    pub(super) sent: f64,
    is_open: bool,
}

impl Default for Ahead {
    fn default() -> Self {
        Self { due: f64::INFINITY, sent: f64::NEG_INFINITY, is_open: true }
    }
}

impl Ahead {
    /// Passes on nothing more before the end.
    pub(super) fn close(&mut self) {
        (self.due, self.is_open) = (f64::INFINITY, false);
    }

    /// Updates the state for newly found crossings.
    #[inline(always)]
    pub(super) fn note(&mut self, new: &[Found]) {
        if self.is_open {
            self.due = new.iter().fold(self.due, |due, f| due.min(f.s + f.s_err + ROOM));
        }
    }

    /// Sorts crossings along the line. Returns how many of them lie before all pieces from `near` on and
    /// apart from the other crossings. Unproven crossings, and brackets that are not far narrower than
    /// the room, close the search.
    pub(super) fn known(&mut self, found: &mut [Found], near: f64) -> usize {
        if found.iter().any(|f| f.sign == 0 || f.s_err > 0.25 * ROOM) {
            self.close();
            return 0;
        }
        found.sort_by(|a, b| a.s.total_cmp(&b.s));
        let count = found.partition_point(|f| f.s <= near - ROOM);
        let reach = |f: &Found| f.s + f.s_err;
        let end = found[..count].iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
        if found[count..].iter().any(|f| f.s - f.s_err <= end) {
            // They become final together.
            self.due = found.iter().map(reach).fold(self.due, f64::max) + ROOM;
            return 0;
        }
        count
    }

    /// Counts the first crossings as passed on.
    pub(super) fn send(&mut self, found: &mut Vec<Found>, count: usize, near: f64) {
        found.drain(..count);
        (self.sent, self.due) = (near - ROOM, f64::INFINITY);
        self.note(found);
    }
}
