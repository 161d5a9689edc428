//! Gaps between the faces of a closed shell.
//!
//! Trimmed faces that share an edge do not agree on it: one ends a little before the other begins,
//! or both overlap. Along any line entries into a solid and exits from it alternate. Where they do
//! not, the fewest changes are made so that they do: a crossing with the continuation of a face,
//! within the seal beyond its edge, is added, or a crossing within the seal of an edge is removed.
//! Distances are measured in the tangent plane. A line that enters through one gap and leaves
//! through another is inside between them if they are farther apart than four seals; two
//! continuations at one edge never are. Added crossings are reported as uncertain. If no such
//! changes help, none is made.

use super::cell::Cell;
use super::line::Found;
use super::shell::{Lists, Shell};
use crate::CentredRay;
use core::ops::ControlFlow;

/// The costs of adding a crossing and of removing one. Removal is the last resort, so that a line
/// through an overlap and a gap is not lost.
const ADD: u32 = 1;
const LEAVE: u32 = 4;
/// A cost above that of all changes of a line together.
const NEVER: u32 = 1 << 20;

/// The choices for a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// It is a certain crossing.
    Kept,
    /// It may be removed, because it is near an edge.
    Near,
    /// It may be added.
    Off,
}

fn sign(f: &Found) -> i8 {
    if f.sign == 0 { f.turn } else { f.sign }
}

/// Whether entries and exits alternate.
fn alternate(found: &[Found]) -> bool {
    let mut inside = false;
    found.iter().map(sign).filter(|s| *s != 0).all(|s| {
        inside = !inside;
        (s < 0) == inside
    }) && !inside
}

/// The crossings that alternate after the fewest changes, ascending; `None` if none do.
fn repaired(all: &[(Found, Role)]) -> Option<Vec<Found>> {
    // The least costs of being outside and inside, and for each crossing whether it was used to get
    // there.
    let mut cost = [0, NEVER];
    let mut used = Vec::with_capacity(all.len());
    for (f, role) in all {
        let skip = match role {
            Role::Kept => NEVER,
            Role::Near => LEAVE,
            Role::Off => 0,
        };
        let s = sign(f);
        let add = if *role == Role::Off { ADD } else { 0 };
        if s == 0 {
            // It touches and changes nothing.
            used.push([*role != Role::Off; 2]);
            continue;
        }
        let to = usize::from(s < 0);
        let mut next = cost.map(|c| (c + skip).min(NEVER));
        let mut now = [false; 2];
        if cost[1 - to] + add < next[to] {
            (next[to], now[to]) = (cost[1 - to] + add, true);
        }
        used.push(now);
        cost = next;
    }
    if cost[0] >= NEVER {
        return None;
    }
    let (mut state, mut out) = (0, Vec::new());
    for ((f, role), used) in all.iter().zip(&used).rev() {
        if used[state] {
            out.push(if *role == Role::Off { added(*f) } else { *f });
            if sign(f) != 0 {
                state = 1 - state;
            }
        }
    }
    out.reverse();
    Some(out)
}

/// Adds pairs of missing crossings where the line is on the other side between them for longer than
/// `far`: it passes through two gaps.
fn with_pairs(used: Vec<Found>, off: &[Found], far: f64) -> Vec<Found> {
    let mut out: Vec<Found> = Vec::with_capacity(used.len());
    let mut state = -1;
    let mut from = f64::NEG_INFINITY;
    for end in used.iter().map(Some).chain([None]) {
        let to = end.map_or(f64::INFINITY, |f| f.s);
        let between = |f: &&Found| f.s > from && f.s < to;
        let first = off.iter().filter(between).find(|f| sign(f) == state);
        let last = off.iter().filter(between).rev().find(|f| sign(f) == -state);
        if let (Some(a), Some(b)) = (first, last)
            && b.s - a.s > far
        {
            out.extend([a, b].map(|f| added(*f)));
        }
        if let Some(f) = end {
            out.push(*f);
            if sign(f) != 0 {
                state = -sign(f);
            }
            from = f.s;
        }
    }
    out
}

/// A crossing that is added.
fn added(f: Found) -> Found {
    Found { turn: sign(&f), sign: 0, ..f }
}

impl Shell {
    /// Removes crossings, from index `first` on, that are not on the face; those within the seal of
    /// its edge go to `off`.
    pub(super) fn sort_out(&self, cell: &Cell, found: &mut Vec<Found>, first: usize, off: &mut Vec<Found>) {
        let Some(trim) = &self.faces[cell.face as usize].trim else { return };
        let mut kept = first;
        for i in first..found.len() {
            let mut f = found[i];
            let (at, radius) = trim.as_knots(f.uv, f.radius);
            let is_beyond = trim.trims.is_beyond(at, radius);
            let is_in_cell = (0..2).all(|k| {
                f.uv[k] + f.radius[k] >= cell.from[k] && f.uv[k] - f.radius[k] <= cell.from[k] + cell.width[k]
            });
            match trim.trims.keeps(at, radius) {
                _ if !is_in_cell && !is_beyond => continue,
                Some(true) if !is_beyond => {}
                None if !is_beyond => (f.on_trim, f.sign, f.alone) = (true, 0, [0.0; 2]),
                _ => {
                    if self.is_near_edge(&f) {
                        off.push(f);
                    }
                    continue;
                }
            }
            found[kept] = f;
            kept += 1;
        }
        found.truncate(kept);
    }

    /// Whether a crossing is within the seal of an edge of its face.
    fn is_near_edge(&self, f: &Found) -> bool {
        let face = &self.faces[f.face as usize];
        let Some(trim) = &face.trim else { return false };
        let jet = face.jet(f.uv);
        let (pu, pv) = (jet.pu * (1.0 / trim.width[0]), jet.pv * (1.0 / trim.width[1]));
        let (at, _) = trim.as_knots(f.uv, f.radius);
        trim.trims.distance(at, [pu.dot(pu), pu.dot(pv), pv.dot(pv)]) <= self.seal
    }

    /// All crossings of a line and a closed shell with gaps.
    pub(super) fn meet_sealed(&self, at: &CentredRay<'_>, lists: &mut Lists) {
        lists.ahead.close();
        let line = (f64::NEG_INFINITY, f64::INFINITY);
        let _ = self.meet::<true>(at, lists, line, |_, _| ControlFlow::Continue(f64::INFINITY));
        let Lists { found, off, .. } = lists;
        self.distinct(found);
        self.distinct(off);
        found.sort_by(|a, b| a.s.total_cmp(&b.s));
        off.sort_by(|a, b| a.s.total_cmp(&b.s));
        if !alternate(found) {
            let role = |f: &Found| if f.on_trim || self.is_near_edge(f) { Role::Near } else { Role::Kept };
            let mut both: Vec<_> = found.iter().map(|f| (*f, role(f))).collect();
            both.extend(off.iter().map(|f| (*f, Role::Off)));
            both.sort_by(|a, b| a.0.s.total_cmp(&b.0.s));
            let Some(used) = repaired(&both) else { return };
            *found = used;
        }
        if off.len() > 1 {
            // A line is near one edge for at most four times the seal.
            let far = 4.0 * self.seal / at.d.length();
            *found = with_pairs(core::mem::take(found), off, far);
        }
    }
}
