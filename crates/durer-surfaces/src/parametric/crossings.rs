//! The crossings that one ray found, each once.

use super::line::Found;
use super::piece::Face;
use crate::patch::shell::root_at;
use crate::{CentredRay, Root};
use durer_math::U;

/// Whether the box of `a` lies where `b` is the only crossing.
fn is_held(a: &Found, b: &Found) -> bool {
    a.face == b.face
        && (0..2).all(|k| a.uv[k] - a.radius[k] >= b.only[k][0] && a.uv[k] + a.radius[k] <= b.only[k][1])
}

/// Whether two boxes of one map have a point in common.
fn overlap(a: &Found, b: &Found) -> bool {
    a.face == b.face && (0..2).all(|k| (a.uv[k] - b.uv[k]).abs() <= a.radius[k] + b.radius[k])
}

/// Whether a crossing may be on the border of its domain.
pub(super) fn on_border(found: &Found, faces: &[Face]) -> bool {
    let face = &faces[found.face as usize];
    (0..2).any(|k| {
        let room = 2.0 * (found.radius[k] + face.slack[k]);
        found.uv[k] <= face.domain[k][0] + room || found.uv[k] >= face.domain[k][1] - room
    })
}

/// Whether crossings are one on a border: both may be on borders of their domains, at the same place
/// of the line. Of a map that is alone that is a seam, where it comes back to itself, perhaps turned
/// over. Of several it is a common edge, and both go through it in the same direction.
fn is_shared(a: &Found, b: &Found, (faces, gap): (&[Face], f64)) -> bool {
    let alike = faces.len() == 1 || a.turn == b.turn && (a.sign == 0) == (b.sign == 0);
    // Edges that should be one are rounded differently. Where nothing is proven, parts may also lie
    // beside each other.
    let unproven = a.sign == 0 && b.sign == 0;
    let room = (a.s_err + b.s_err) * if unproven { 2.0 } else { 1.0 } + gap;
    alike && (a.s - b.s).abs() <= room && on_border(a, faces) && on_border(b, faces)
}

/// Joins duplicates: a crossing found in two pieces, on their common border or on a seam, and
/// unproven parts that touch each other. Edges that coincide are within `gap`.
pub(super) fn distinct(found: &mut Vec<Found>, faces: &[Face], gap: f64) {
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
        let same = |old: &Found| held(old) || overlap(&new, old) || is_shared(&new, old, (faces, gap));
        match found[..kept].iter().position(same) {
            Some(k) => {
                let old = &mut found[k];
                let known = held(old) || is_shared(&new, old, (faces, gap));
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
    join_all(found, (faces, gap));
}

/// Joins unproven parts until none touches another, also across a seam.
fn join_all(found: &mut Vec<Found>, edges: (&[Face], f64)) {
    let mut i = 0;
    while i < found.len() {
        let touching = (i + 1..found.len()).find(|&j| {
            let (a, b) = (&found[i], &found[j]);
            a.sign == 0 && b.sign == 0 && (overlap(a, b) || is_shared(a, b, edges))
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
