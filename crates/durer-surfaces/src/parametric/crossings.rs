//! The crossings that one ray found, each once.

use super::line::Found;
use super::piece::{Face, Unit};
use crate::patch::shell::root_at;
use crate::{CentredRay, Root};
use durer_math::U;
use durer_math::eft::scale2;

/// Whether the box of `a` lies where `b` is the only crossing.
fn is_held(a: &Found, b: &Found) -> bool {
    a.face == b.face
        && (0..2).all(|k| a.uv[k] - a.radius[k] >= b.only[k][0] && a.uv[k] + a.radius[k] <= b.only[k][1])
}

/// Whether two boxes of one map have a point in common.
fn overlap(a: &Found, b: &Found) -> bool {
    a.face == b.face && (0..2).all(|k| (a.uv[k] - b.uv[k]).abs() <= a.radius[k] + b.radius[k])
}

/// Whether a crossing may be at the least and at the greatest value of each parameter.
fn ends(found: &Found, faces: &[Face]) -> [[bool; 2]; 2] {
    let face = &faces[found.face as usize];
    [0, 1].map(|k| {
        let room = 2.0 * (found.radius[k] + face.slack[k]);
        [found.uv[k] <= face.domain[k][0] + room, found.uv[k] >= face.domain[k][1] - room]
    })
}

/// Whether a crossing may be on the border of its domain.
pub(super) fn on_border(found: &Found, faces: &[Face]) -> bool {
    ends(found, faces) != [[false; 2]; 2]
}

/// The maps of a sheet, and where their borders are.
#[derive(Clone, Copy)]
pub(super) struct Edges<'a> {
    pub(super) faces: &'a [Face],
    pub(super) unit: &'a Unit,
    /// Edges that coincide are within this of each other, in units.
    pub(super) gap: f64,
}

impl Edges<'_> {
    /// Whether crossings are one on a border: both may be on borders of their domains, at the same place
    /// of the line. Of several maps it is a common edge, and both go through it in the same direction.
    /// A map that is alone comes back to itself at a seam, perhaps turned over.
    fn are_one(&self, a: &Found, b: &Found) -> bool {
        let [x, y] = [a, b].map(|found| ends(found, self.faces));
        if x == [[false; 2]; 2] || y == [[false; 2]; 2] {
            return false;
        }
        // Edges that should be one are rounded differently. Where nothing is proven, parts may also lie
        // beside each other.
        let unproven = a.sign == 0 && b.sign == 0;
        let room = (a.s_err + b.s_err) * if unproven { 2.0 } else { 1.0 } + self.gap;
        if (a.s - b.s).abs() > room {
            return false;
        }
        if self.faces.len() > 1 {
            return a.turn == b.turn && (a.sign == 0) == (b.sign == 0);
        }
        let sides = [(0, 0), (0, 1), (1, 0), (1, 1)];
        let is_across = sides.iter().any(|&(k, end)| x[k][end] && y[k][1 - end]);
        // Sheets that meet in a common border are met one by one, unless that is like a seam: a line
        // goes through it in one direction. At a pole one of them may be unproven.
        let is_pole =
            || sides.iter().any(|&(k, end)| x[k][end] && y[k][end] && self.is_point(k, end, [a, b]));
        is_across || if a.sign * b.sign == 0 { unproven || is_pole() } else { a.sign == b.sign }
    }

    /// Whether an end of a parameter of the only map is a single point from one crossing to another.
    fn is_point(&self, k: usize, end: usize, [a, b]: [&Found; 2]) -> bool {
        let face = &self.faces[a.face as usize];
        let place = |part: f64| {
            let mut x = [0, 1].map(|k| part.mul_add(b.uv[k] - a.uv[k], a.uv[k]));
            x[k] = face.domain[k][end];
            face.tape.jet(x).map(|jet| scale2(jet.v, -self.unit.scale))
        };
        let here = place(0.0);
        [0.25, 0.5, 0.75, 1.0]
            .into_iter()
            .map(place)
            .all(|p| (0..3).all(|c| (p[c] - here[c]).abs() <= self.gap))
    }
}

/// Joins duplicates: a crossing found in two pieces, on their common border or on a seam, and
/// unproven parts that touch each other.
pub(super) fn distinct(found: &mut Vec<Found>, edges: Edges<'_>) {
    if found.len() < 2 {
        return;
    }
    // Proven ones first; of those of a seam, the one of the least parameters.
    found.sort_by(|a, b| {
        (a.sign == 0, a.face)
            .cmp(&(b.sign == 0, b.face))
            .then(a.uv[0].total_cmp(&b.uv[0]))
            .then(a.uv[1].total_cmp(&b.uv[1]))
    });
    let mut kept = 0;
    for i in 0..found.len() {
        let new = found[i];
        let held = |old: &Found| is_held(&new, old) || is_held(old, &new);
        let same = |old: &Found| held(old) || overlap(&new, old) || edges.are_one(&new, old);
        match found[..kept].iter().position(same) {
            Some(k) => {
                let old = &mut found[k];
                let known = held(old) || edges.are_one(&new, old);
                if old.sign == 0 || !known {
                    // Nothing says whether that is one crossing or two.
                    *old = joined(old, &new);
                } else if new.sign != 0 && new.s_err < old.s_err && held(old) {
                    // Of two proofs the sharper one is kept.
                    *old = new;
                }
            }
            None => {
                found[kept] = new;
                kept += 1;
            }
        }
    }
    found.truncate(kept);
    join_all(found, edges);
}

/// Joins unproven parts until none touches another, also across a seam.
fn join_all(found: &mut Vec<Found>, edges: Edges<'_>) {
    let mut i = 0;
    while i < found.len() {
        let touching = (i + 1..found.len()).find(|&j| {
            let (a, b) = (&found[i], &found[j]);
            a.sign == 0 && b.sign == 0 && (overlap(a, b) || edges.are_one(a, b))
        });
        match touching {
            Some(j) => {
                found[i] = joined(&found[i], &found[j]);
                found.swap_remove(j);
                // It is larger now, and may touch earlier ones.
                i = 0;
            }
            None => i += 1,
        }
    }
}

/// A box that holds two others, in which nothing is proven.
fn joined(a: &Found, b: &Found) -> Found {
    if overlap(a, b) { united(a, b) } else { joined_across(a, b, 2.0) }
}

/// A box that holds two others on different maps or on both sides of a seam, in which nothing is
/// proven. Enlarged to `size` times their radii, both boxes meet at the seam. Parameters of
/// different sides do not mix: the box is that of `a`, continued beyond the seam as far as `b`.
pub(super) fn joined_across(a: &Found, b: &Found, size: f64) -> Found {
    let reach =
        |k: usize| if a.face == b.face { size * (a.radius[k] + b.radius[k]) + b.radius[k] } else { 0.0 };
    let radius = [0, 1].map(|k| reach(k).max(a.radius[k]) * (1.0 + 4.0 * U));
    Found { uv: a.uv, radius, ..united(a, b) }
}

/// A box that holds two others of one map, in which nothing is proven.
pub(super) fn united(a: &Found, b: &Found) -> Found {
    let (mut out, wider) = (*a, 1.0 + 4.0 * U);
    for k in 0..2 {
        let low = (a.uv[k] - a.radius[k]).min(b.uv[k] - b.radius[k]);
        let high = (a.uv[k] + a.radius[k]).max(b.uv[k] + b.radius[k]);
        (out.uv[k], out.radius[k]) =
            (0.5 * (low + high), 0.5 * (high - low) * wider + U * low.abs().max(high.abs()));
    }
    let (low, high) = ((a.s - a.s_err).min(b.s - b.s_err), (a.s + a.s_err).max(b.s + b.s_err));
    (out.s, out.s_err) = (0.5 * (low + high), 0.5 * (high - low) * wider + U * (low.abs() + high.abs()));
    (out.sign, out.only) = (0, [[f64::INFINITY, f64::NEG_INFINITY]; 2]);
    out.turn = if a.turn == b.turn { a.turn } else { 0 };
    out
}

/// A crossing in the caller's parameter; `None` if it is not in the ray's range.
pub(super) fn root(at: &CentredRay<'_>, found: &Found) -> Option<Root> {
    root_at(at, (found.s, found.s_err), (found.face, found.uv), (found.sign, found.turn))
}
