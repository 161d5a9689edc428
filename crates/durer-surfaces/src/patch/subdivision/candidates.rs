//! Joins crossings that are found twice, and decides what unproven candidates are.
//!
//! Patches share edges, so two of them may find the same crossing. A corner that the ray cannot tell
//! from a point is an unproven candidate at its vertex. Candidates that may be the same crossing are
//! joined. A line enters and leaves a closed surface alternately; that decides what the remaining
//! candidates are, and the order of crossings whose brackets overlap.

use super::limit::{Extra, Limit, Lists};
use crate::patch::line::Found;
use crate::patch::shell::{is_held, is_on_edge, joined, overlap};

/// Sorts crossings along the line. Returns whether the alternation of a closed surface has to decide
/// some of them: unproven ones, or the order of two whose brackets overlap.
pub(super) fn is_in_doubt(found: &mut [Found]) -> bool {
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    found.iter().any(|f| f.sign == 0) || found.windows(2).any(|pair| touch(&pair[0], &pair[1]))
}

fn touch(a: &Found, b: &Found) -> bool {
    (a.s - b.s).abs() <= a.s_err + b.s_err
}

/// Exchanges neighbours along a whole line whose brackets overlap and which enter and leave a closed
/// surface in the wrong order.
pub(super) fn in_turn(found: &mut [Found], outward: i8) {
    let mut inside = false;
    for i in 0..found.len() {
        let enters = |f: &Found| f.turn * outward < 0;
        if let Some(next) = found.get(i + 1).copied()
            && [found[i], next].iter().all(|f| f.sign != 0)
            && touch(&found[i], &next)
            && enters(&found[i]) == inside
            && enters(&next) != inside
        {
            found.swap(i, i + 1);
        }
        // An unproven candidate counts if it fits.
        if found[i].turn != 0 && (found[i].sign != 0 || enters(&found[i]) != inside) {
            inside = enters(&found[i]);
        }
    }
}

/// A crossing on a way through all of them, as a sign, and the side from which the line comes.
#[derive(Clone, Copy)]
struct Step {
    sign: i8,
    from_inside: bool,
}

/// Decides the directions of unproven candidates, which are sorted along a whole line: a line enters
/// and leaves a closed surface alternately, and both ends of the line are outside.
///
/// A candidate at a vertex stands for the faces beside it, whether the line meets the vertex or passes
/// it within the rounding; its direction is that in which the line crosses these faces. Of all choices
/// that alternate, this takes one with the fewest changes: a candidate loses its direction (the line
/// passes the vertex), or, at a higher price, has another one. Proven crossings stay as they are.
pub(super) fn alternate(found: &mut [Found], outward: i8) {
    /// The price of two proven crossings in the same direction, as of a surface that crosses itself:
    /// more than all candidates cost together.
    const CONTRADICTION: u64 = 1 << 32;
    // The least cost to be outside, and inside, and the last step on the way there.
    let mut costs = [0, CONTRADICTION << 20];
    let mut steps: Vec<[Step; 2]> = Vec::with_capacity(found.len());
    for crossing in &*found {
        let turn = crossing.turn * outward;
        let mut next = [u64::MAX; 2];
        let mut step = [Step { sign: 0, from_inside: false }; 2];
        for (from_inside, cost) in [(false, costs[0]), (true, costs[1])] {
            let mut reach = |sign: i8, price: u64| {
                let inside = if sign == 0 { from_inside } else { sign < 0 };
                if cost + price < next[usize::from(inside)] {
                    next[usize::from(inside)] = cost + price;
                    step[usize::from(inside)] = Step { sign, from_inside };
                }
            };
            let across = if from_inside { 1 } else { -1 };
            if crossing.sign != 0 {
                reach(turn, if turn == across { 0 } else { CONTRADICTION });
            } else {
                reach(0, u64::from(turn != 0));
                reach(across, if turn == across { 0 } else { 2 });
            }
        }
        // A proven crossing ends on one side only.
        costs = next.map(|cost| cost.min(CONTRADICTION << 20));
        steps.push(step);
    }
    let mut inside = false;
    for (crossing, step) in found.iter_mut().zip(&steps).rev() {
        let Step { sign, from_inside } = step[usize::from(inside)];
        if crossing.sign == 0 {
            crossing.turn = sign * outward;
        }
        inside = from_inside;
    }
}

impl Limit {
    /// How far along the line the same crossing may be found beside this one.
    fn room(&self, found: &Found, extra: &[Extra]) -> f64 {
        extra.get((found.face as usize).wrapping_sub(self.leaves.len())).map_or(0.0, |extra| extra.room)
    }

    /// Whether two may be the same crossing.
    ///
    /// Within a patch: boxes that touch, or one where the other's proof says that it is alone. In
    /// different ones: on an edge, or in a corner beside it, at the same place of the line and in the
    /// same direction; what has no direction goes with any.
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

    /// Joins what is the same crossing.
    pub(super) fn join(&self, lists: &mut Lists) {
        let Lists { found, extra, .. } = lists;
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
                found[i] = Found { turn, ..joined(&a, &b) };
                if is_same_patch && a.turn != b.turn {
                    found[i].turn = 0;
                }
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

    /// Sorts along the line, and joins unproven candidates that may be at the same place; if their
    /// directions differ, the joined one has none.
    pub(super) fn join_unproven(&self, lists: &mut Lists) {
        let Lists { found, extra, .. } = lists;
        found.sort_by(|a, b| a.s.total_cmp(&b.s));
        let mut i = 0;
        while i < found.len() {
            let mut turns = [found[i].turn < 0, found[i].turn > 0];
            while let Some(&b) = found.get(i + 1) {
                let a = found[i];
                let room = self.room(&a, extra) + self.room(&b, extra);
                if a.sign != 0 || b.sign != 0 || b.s - a.s > a.s_err + b.s_err + room {
                    break;
                }
                turns = [turns[0] || b.turn < 0, turns[1] || b.turn > 0];
                let turn = i8::from(turns[1]) - i8::from(turns[0]);
                found[i] = Found { turn, ..joined(&a, &b) };
                found.remove(i + 1);
            }
            i += 1;
        }
    }
}
