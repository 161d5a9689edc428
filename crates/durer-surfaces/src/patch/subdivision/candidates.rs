//! Joins crossings that are found twice, and decides the kind of unproven candidates.
//!
//! Patches share edges, so two of them may find the same crossing. A corner that is within the
//! ray's error a single point is an unproven candidate at its vertex. Candidates that may be the
//! same crossing are joined. Alternation decides the others (`alternation.rs`).

use super::limit::{Extra, Limit};
use crate::patch::line::Found;
use crate::patch::shell::{is_held, is_on_edge, overlap};

impl Limit {
    /// How far along the line the same crossing may be found beside this one.
    pub(super) fn room(&self, found: &Found, extra: &[Extra]) -> f64 {
        extra.get((found.face as usize).wrapping_sub(self.leaves.len())).map_or(0.0, |extra| extra.room)
    }

    /// Whether two may be the same crossing.
    ///
    /// Within a patch: their boxes touch, or one is where the other is proven to be the only
    /// crossing. In different ones: they are on an edge, or in a corner next to it, at the same
    /// place of the line and in the same direction; an unknown direction matches any.
    fn is_same(&self, a: &Found, b: &Found, extra: &[Extra]) -> bool {
        if a.face == b.face {
            return is_held(a, b) || is_held(b, a) || overlap(a, b);
        }
        let rooms = [self.room(a, extra), self.room(b, extra)];
        let on_edge = |f: &Found| is_on_edge(self.is_triangles, f);
        // One of them may be in the other's patch as well; that other one may surely be in its own.
        let may_be = rooms.iter().any(|r| *r > 0.0) || on_edge(a) || on_edge(b);
        let is_alike = a.turn == b.turn || a.turn == 0 || b.turn == 0;
        may_be && is_alike && (a.s - b.s).abs() <= a.s_err + b.s_err + rooms[0] + rooms[1]
    }

    /// Joins duplicates of one crossing.
    pub(super) fn join(&self, found: &mut Vec<Found>, extra: &[Extra]) {
        if found.len() < 2 {
            return;
        }
        // Proven ones first; an order that does not depend on when patches were made.
        let by_place = |f: &Found| {
            let place = self.place(f, extra);
            (place.face, place.from.map(f64::to_bits), f.uv.map(f64::to_bits))
        };
        found.sort_by(|a, b| {
            let first = (a.sign == 0).cmp(&(b.sign == 0)).then((a.turn == 0).cmp(&(b.turn == 0)));
            first.then(a.s.total_cmp(&b.s)).then_with(|| by_place(a).cmp(&by_place(b)))
        });
        let mut i = 0;
        while i < found.len() {
            let Some(j) = (i + 1..found.len()).find(|&j| self.is_same(&found[i], &found[j], extra)) else {
                i += 1;
                continue;
            };
            let (a, b) = (found[i], found[j]);
            let is_same_patch = a.face == b.face;
            let is_known = !is_same_patch || is_held(&a, &b) || is_held(&b, &a);
            if a.sign == 0 || !is_known {
                // Nothing says whether that is one crossing or two.
                let turn = if a.turn == 0 { b.turn } else { a.turn };
                found[i] = Found { turn, ..a.joined(&b) };
                if is_same_patch && a.turn != b.turn {
                    found[i].turn = 0;
                }
            } else if b.sign != 0 && !is_same_patch {
                found[i] = a.united(&b, |f| is_on_edge(self.is_triangles, f));
            } else if b.sign != 0 && b.s_err < a.s_err {
                // Of two proofs the sharper one is kept.
                found[i] = b;
            }
            // Not by swapping: the order stays.
            found.remove(j);
            // What was apart from it may touch it now.
            i = 0;
        }
    }
}
