//! Cutting a map into pieces, ahead of all rays: until each is so flat that a ray which is not
//! nearly tangent meets it at most once, and finds that crossing by Newton's method.
//!
//! Pieces outside of the container are left out. So are parts in which nothing is defined, and the
//! rest around a pole of the formula, where it has no bounds, after fifty halvings or once there
//! are too many pieces.

use super::Bounds;
use super::piece::{Face, Piece, Unit};
use std::collections::VecDeque;

/// A piece is flat if its slopes change relatively by less than this, seen along the normal.
const FLAT: f64 = 0.25;
/// The most halvings of a piece along one parameter, unless it has no bounds.
const FINEST: u32 = 10;
/// A part that has no bounds after this many halvings along one parameter is left out.
const UNBOUNDED: u32 = 50;
/// The approximate number of pieces of all maps of a sheet together, if that is more than [`LEAST`]
/// each.
const MOST: usize = 1 << 14;
/// The number of pieces into which each map may be cut, however many maps there are.
const LEAST: usize = 1 << 9;
/// A piece that may jump and is cut as finely as possible is at most this large, relative to the
/// whole, unless it does jump.
const TORN: f64 = 1.0 / 64.0;

/// Why there are no pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refused {
    /// The map is torn near this place.
    Jump([f64; 2]),
    /// It is unbounded, and no container bounds it.
    Unbounded([f64; 2]),
}

struct Open {
    piece: Piece,
    halved: [u32; 2],
}

/// The pieces of all maps, in their own units. An error says which map is refused.
pub(super) fn all_pieces(faces: &[Face], bounds: &Bounds) -> Result<Vec<Piece>, (u32, Refused)> {
    let most = (MOST / faces.len().max(1)).max(LEAST);
    let mut all = Vec::new();
    for (number, face) in (0_u32..).zip(faces) {
        pieces(face, number, bounds, most, &mut all).map_err(|refused| (number, refused))?;
    }
    Ok(all)
}

/// The pieces of a map, about `most`, in its own units.
fn pieces(
    face: &Face,
    number: u32,
    bounds: &Bounds,
    most: usize,
    out: &mut Vec<Piece>,
) -> Result<(), Refused> {
    let first = out.len();
    let mut made = Vec::new();
    face.pieces(number, &[face.domain], &Unit::OWN, &mut made);
    let mut open: VecDeque<Open> = made.into_iter().map(|piece| Open { piece, halved: [0; 2] }).collect();
    let mut torn = Vec::new();
    while let Some(Open { piece, halved }) = open.pop_front() {
        if bounds.are_missed_by(&piece.hull) {
            continue;
        }
        let (most, finest) = if piece.is_bounded() { (most, FINEST) } else { (MOST, UNBOUNDED) };
        let is_full = out.len() - first + open.len() > most;
        let may = [0, 1].map(|k| halved[k] < finest && piece.has_halves(k));
        if !piece.is_bounded() {
            if is_full || may != [true; 2] {
                if bounds.are_none() {
                    return Err(Refused::Unbounded(piece.middle));
                }
                continue;
            }
        } else if piece.bend() <= FLAT || may == [false; 2] || is_full {
            if piece.jumps {
                torn.push(out.len());
            }
            out.push(piece);
            continue;
        }
        let mut boxes = piece.halves(0).to_vec();
        boxes.extend(piece.halves(1));
        let mut kids = Vec::with_capacity(4);
        face.pieces(number, &boxes, &Unit::OWN, &mut kids);
        let along = |k: usize| kids.iter().filter(move |kid| kid.width[k] < piece.width[k]);
        let costs: [f64; 2] = [0, 1].map(|k| along(k).map(|kid| cost(kid, bounds)).sum());
        let change = piece.change();
        let second = if costs[0] != costs[1] {
            costs[1] < costs[0]
        } else if piece.is_bounded() {
            change[1] > change[0]
        } else {
            // One halving may not be enough for bounds: parameters take turns.
            halved[1] < halved[0]
        };
        let k = if may == [true; 2] { usize::from(second) } else { usize::from(may[1]) };
        let mut halved = halved;
        halved[k] += 1;
        open.extend(along(k).map(|kid| Open { piece: *kid, halved }));
    }
    // A jump of the formula would be a gap: such a map is no sheet.
    let whole = size(&out[first..]);
    for at in torn {
        let piece = &out[at];
        if size(&out[at..=at]) > TORN * whole {
            return Err(Refused::Jump(piece.middle));
        }
    }
    Ok(())
}

/// The priority for cutting a piece: its deviation from flat; parts without bounds come first.
fn cost(piece: &Piece, bounds: &Bounds) -> f64 {
    if bounds.are_missed_by(&piece.hull) {
        0.0
    } else if piece.is_bounded() {
        piece.bend().min(1e6)
    } else {
        1e12
    }
}

/// The longest edge of a box around pieces.
fn size(pieces: &[Piece]) -> f64 {
    (0..3).fold(0.0, |most: f64, c| {
        let low = pieces.iter().fold(f64::INFINITY, |low: f64, piece| low.min(piece.hull[c].lo));
        let high = pieces.iter().fold(f64::NEG_INFINITY, |high: f64, piece| high.max(piece.hull[c].hi));
        most.max(high - low)
    })
}
