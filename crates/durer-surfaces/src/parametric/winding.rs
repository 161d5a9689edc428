//! Solids whose maps form closed surfaces with an orientation: inside is where their winding number
//! is not 0. A ray adds up the signs of all crossings on its line; a crossing counts where the sum
//! leaves 0 or comes back to it.

use super::crossings::{on_border, root};
use super::line::Found;
use super::piece::Face;
use super::sheet::Sheet;
use crate::mesh::Sorted;
use crate::{CentredRay, LocalPoint, LocalRay, Root, RootKind, Side, Sink, SurfacePoint};
use durer_math::{Ray, Vec3};

/// How far a point that starts a ray may be from where the ray is thought to start: the roundings of
/// three coordinates relative to the centre and of the place along the ray, as a part of the largest.
const START: f64 = 8.0 * durer_math::U;

/// A crossing that changes the winding number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) found: Found,
    /// The sign of the normal along the line; then that of the solid: -1 enters it.
    pub(super) sign: i8,
    /// By how much the number changes.
    pub(super) weight: i32,
}

impl Turn {
    pub(super) fn new(found: &Found) -> Self {
        let sign = if found.sign == 0 { found.turn } else { found.sign };
        Self { found: *found, sign, weight: i32::from(sign) }
    }
}

/// Keeps of the crossings of a whole line, ascending, those where the winding number leaves 0 or
/// comes back to it.
pub(super) fn kept_turns(mut all: Vec<Turn>, faces: &[Face]) -> Vec<Turn> {
    close(&mut all, faces);
    let mut count = 0;
    all.retain_mut(|turn| {
        let before = count;
        // Normals point outward: a crossing against them goes into one more turn.
        count -= turn.weight;
        turn.sign = match (before, count) {
            (0, 0) if turn.weight == 0 => 0,
            (0, after) if after != 0 => -1,
            (_, 0) if before != 0 => 1,
            _ => return false,
        };
        true
    });
    all
}

/// The winding number is 0 far away on both sides. If it is not, one crossing is there that may
/// as well be a miss, or one tangent may cross: the first that is within its error of an edge of
/// a face, or unproven, is changed.
fn close(all: &mut Vec<Turn>, faces: &[Face]) {
    let missing: i32 = -all.iter().map(|turn| turn.weight).sum::<i32>();
    if missing == 0 {
        return;
    }
    if let Some(turn) = all.iter_mut().find(|turn| turn.weight == 0) {
        turn.weight = missing;
        return;
    }
    let at = all
        .iter()
        .position(|turn| turn.weight == -missing && (turn.found.sign == 0 || on_border(&turn.found, faces)));
    if let Some(at) = at {
        all.remove(at);
    }
}

/// Passes the crossings of a solid to `sink`.
pub(super) fn pour(at: &CentredRay<'_>, turns: &[Turn], sink: &mut dyn Sink) {
    let mut roots = Sorted::new();
    for Turn { found, sign, .. } in turns {
        if let Some(root) = root(at, found) {
            let kind = match (sign, root.kind) {
                (0, _) => RootKind::Grazing,
                (_, RootKind::Grazing) => RootKind::Cluster,
                (_, kind) => kind,
            };
            roots.push(Root { sign: *sign, kind, ..root });
        }
    }
    // Going in stays before coming out, also where both are at one place.
    let _ = roots.pour_in_turn(sink);
}

/// Turns normals to the outside, which may be behind them where the surface overlaps itself.
pub(super) fn face_outside(point: &mut SurfacePoint, ray: &LocalRay<'_>, root: &Root) {
    let along = point.ng.to_vec().dot(ray.d);
    if root.sign != 0 && along != 0.0 && (along > 0.0) != (root.sign > 0) {
        (point.ng, point.ns) = (-point.ng, -point.ns);
    }
}

/// Whether a point is inside.
pub(super) fn side(sheet: &Sheet, point: &LocalPoint<'_>, turns: impl Fn(&[Found]) -> Vec<Turn>) -> Side {
    let held = sheet.bounds.expanded(point.p_err);
    if !(0..3).all(|k| held.min[k] <= point.p[k] && point.p[k] <= held.max[k]) {
        return Side::Out;
    }
    // Any direction will do; this one is parallel to no likely face.
    let ray = Ray::new(point.p, Vec3::new(0.351, 0.637, 0.686));
    let mut side = Side::Out;
    sheet.with_all(&LocalRay::new(&ray), |at, found| {
        let start = -at.shift();
        let room = sheet.in_units(2.0 * point.p_err.max_abs() + START * point.p.to_vec().max_abs());
        for turn in turns(found) {
            if (turn.found.s - start).abs() <= turn.found.s_err + room {
                side = Side::On;
                return;
            }
            if turn.found.s > start {
                break;
            }
            match turn.sign {
                -1 => side = Side::In,
                1 => side = Side::Out,
                _ => {}
            }
        }
    });
    side
}
