//! How often a line crosses a map within a box in which rounding hides the single crossings.
//!
//! Along the border of a box of parameters, `F` turns around zero as many times as the signs of its
//! zeros in the box add up to: its degree, for any number of zeros (R. B. Kearfott, "An efficient
//! degree-computation method for a generalized method of bisection", *Numerische Mathematik* 32
//! (1979) 109-127). So the border decides what is hidden inside: 0 beside a tangent, whether the
//! line meets the map twice there or misses it, and 1 or -1 where it leads through.
//!
//! The border has to be so far away that `F` is certainly not zero there: the box is doubled until it
//! is. The border is cut into stretches on each of which one of two combinations of both functions has
//! a certain sign, so that `F` stays in a half plane: the one that changes most slowly, and the one
//! across it. The half planes of neighbours have a point in common, so their directions differ by
//! less than half a turn, and these differences add up to the turns.

use super::crossings::{joined_across, united};
use super::line::{Found, View};
use super::piece::{Domain, Piece, halves};
use super::subdivide::{Reach, slowest};

/// By how much the box is enlarged. Twice as large, `F` beside a tangent is four times as large as
/// in the unproven box.
const SIZES: [f64; 4] = [2.0, 4.0, 8.0, 16.0];
/// The most stretches of a border without a certain half plane, and how often they are halved.
const MOST_OPEN: usize = 128;
const HALVINGS: usize = 16;

/// The signs of the crossings that one unproven crossing represents.
pub(super) enum Sum {
    /// The sum of the signs of all crossings there; 0 where the line may touch a border.
    Of(i8),
    /// The unproven crossing of this index is too near for a sum of its own; this one holds both.
    Near(usize, Found),
    Unknown,
}

/// The sum of the signs of the crossings that the unproven one `found[i]` represents. `turned` says
/// whether signs are those of the map with the opposite normal. At a seam the map goes on beyond its
/// domain, at a border it ends.
#[cold]
#[inline(never)]
pub(super) fn sum_of_signs(view: &View<'_>, found: &[Found], i: usize, turned: bool) -> Sum {
    let own = &found[i];
    let others = || found.iter().enumerate().filter(|&(j, other)| j != i && other.face == own.face);
    let domain = view.face.domain;
    for size in SIZES {
        let enlarged = |found: &Found| enlarged(found, size);
        let mut around = enlarged(own);
        for k in (0..2).filter(|&k| !view.face.has_seam[k]) {
            around[k] = [around[k][0].max(domain[k][0]), around[k][1].min(domain[k][1])];
        }
        if (0..2).any(|k| around[k][0] >= around[k][1]) {
            break;
        }
        let beyond = [0, 1]
            .map(|k: usize| [(domain[k][0] - around[k][0]).max(0.0), (around[k][1] - domain[k][1]).max(0.0)]);
        let Some(degree) = degree(view, &around) else { continue };
        // Whether another one's box is in this one, made smaller by a part of the other's radius.
        let holds = |other: &Found, part: f64| {
            (0..2).all(|k: usize| {
                let ([from, to], room) = (around[k], part * other.radius[k]);
                from + room <= other.uv[k] && other.uv[k] <= to - room
            })
        };
        // Whether another one, as much enlarged, reaches this box across a seam.
        let is_across = |other: &Found| {
            let box_of_other = enlarged(other);
            let reaches = |k: usize| {
                let ([low, high], [from, to], [first, last]) = (beyond[k], box_of_other[k], domain[k]);
                low > 0.0 && to >= last - low || high > 0.0 && from <= first + high
            };
            (reaches(0) || reaches(1)) && (own.s - other.s).abs() <= size * (own.s_err + other.s_err)
        };
        let mut unproven = others().filter(|(_, other)| other.sign == 0);
        if let Some((j, other)) = unproven.clone().find(|(_, other)| holds(other, -1.0)) {
            return Sum::Near(j, united(own, other));
        }
        if let Some((j, other)) = unproven.find(|(_, other)| is_across(other)) {
            return Sum::Near(j, joined_across(own, other, size));
        }
        let is_unclear =
            |other: &Found| if holds(other, -1.0) { !holds(other, 1.0) } else { is_across(other) };
        if others().any(|(_, other)| is_unclear(other)) {
            continue;
        }
        let proven: i32 =
            others().filter(|(_, other)| holds(other, 1.0)).map(|(_, other)| i32::from(other.sign)).sum();
        let sum = if (view.line.d_z < 0.0) == turned { degree } else { -degree } - proven;
        return match i8::try_from(sum) {
            Ok(sum @ -1..=1) => Sum::Of(sum),
            _ => Sum::Unknown,
        };
    }
    // Rounding hides whether a crossing at a border is on the map. If the map, continued beyond its
    // borders, has none or as many in either direction, the line may touch the border.
    let is_touch = |size: f64| {
        let around = enlarged(own, size);
        let holds =
            |other: &Found| (0..2).all(|k| around[k][0] <= other.uv[k] && other.uv[k] <= around[k][1]);
        degree(view, &around) == Some(0) && !others().any(|(_, other)| holds(other))
    };
    if SIZES.into_iter().any(is_touch) { Sum::Of(0) } else { Sum::Unknown }
}

/// The box of a crossing, enlarged.
fn enlarged(found: &Found, size: f64) -> Domain {
    [0, 1].map(|k| {
        let by = size * found.radius[k];
        [found.uv[k] - by, found.uv[k] + by]
    })
}

/// How many times `F` turns around zero along the border of a box, by the orientation of the
/// parameters; `None` if it may be zero there.
fn degree(view: &View<'_>, around: &Domain) -> Option<i32> {
    if !view.face.knows(around) {
        return None;
    }
    let middle = around.map(|[from, to]| 0.5 * from + 0.5 * to);
    let width = around.map(|[from, to]| to - from);
    let slow = slowest(&view.slopes_at(middle, width));
    let mut border: Vec<Stretch> = SIDES.iter().map(|side| side.of(around)).collect();
    let (mut boxes, mut pieces) = (Vec::new(), Vec::new());
    for _ in 0..HALVINGS {
        border = border.into_iter().flat_map(Stretch::halves).flatten().collect();
        boxes.clear();
        boxes.extend(border.iter().filter(|stretch| stretch.eighth.is_none()).map(|stretch| stretch.own));
        if boxes.is_empty() {
            return turns(border.iter().filter_map(|stretch| stretch.eighth));
        }
        pieces.clear();
        view.face.pieces(0, &boxes, view.unit, &mut pieces);
        if boxes.len() > MOST_OPEN || pieces.len() < boxes.len() {
            return None;
        }
        let open = border.iter_mut().filter(|stretch| stretch.eighth.is_none());
        for (stretch, piece) in open.zip(&pieces) {
            stretch.eighth = eighth(view, slow, piece);
        }
    }
    None
}

/// A stretch of the border of a box.
#[derive(Clone, Copy)]
struct Stretch {
    own: Domain,
    /// The parameter that changes, and whether it falls on the way around the box.
    along: usize,
    falls: bool,
    /// The direction in whose half plane `F` stays, in eighths of a turn.
    eighth: Option<i32>,
}

/// A side of a box: the parameter that changes, the end at which the other one is, and whether the
/// former falls.
struct BoxSide(usize, usize, bool);

/// The way around a box, the first parameter growing first.
const SIDES: [BoxSide; 4] =
    [BoxSide(0, 0, false), BoxSide(1, 1, false), BoxSide(0, 1, true), BoxSide(1, 0, true)];

impl BoxSide {
    fn of(&self, around: &Domain) -> Stretch {
        let Self(along, end, falls) = *self;
        let mut own = *around;
        own[1 - along] = [around[1 - along][end]; 2];
        Stretch { own, along, falls, eighth: None }
    }
}

impl Stretch {
    /// Itself, or both halves if its half plane is unknown, in their order.
    fn halves(self) -> [Option<Self>; 2] {
        if self.eighth.is_some() {
            return [Some(self), None];
        }
        let [mut first, mut second] = halves(&self.own, self.along);
        if self.falls {
            (first, second) = (second, first);
        }
        [first, second].map(|own| Some(Self { own, ..self }))
    }
}

/// The direction of a half plane, or a quarter, that holds `F` on a piece of the border, in eighths of
/// a turn: the combination `slow` is the second coordinate, that across it the first.
fn eighth(view: &View<'_>, slow: [f64; 2], piece: &Piece) -> Option<i32> {
    let local = view.local(piece);
    let sign = |by| Reach::new(by, &local, piece.half()).sign();
    match (sign([slow[1], -slow[0]]), sign(slow)) {
        (1, 0) => Some(0),
        (1, 1) => Some(1),
        (0, 1) => Some(2),
        (-1, 1) => Some(3),
        (-1, 0) => Some(4),
        (-1, -1) => Some(5),
        (0, -1) => Some(6),
        (1, -1) => Some(7),
        _ => None,
    }
}

/// How often a closed curve turns around the origin, by the directions of half planes, each of which
/// holds a stretch of it, in eighths of a turn.
fn turns(eighths: impl Iterator<Item = i32> + Clone) -> Option<i32> {
    let next = eighths.clone().skip(1).chain(eighths.clone().take(1));
    let mut sum = 0;
    for (from, to) in eighths.zip(next) {
        let by = (to - from).rem_euclid(8);
        if by == 4 {
            // Opposite half planes have no point in common.
            return None;
        }
        sum += if by > 4 { by - 8 } else { by };
    }
    Some(sum / 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turns_of(eighths: &[i32]) -> Option<i32> {
        turns(eighths.iter().copied())
    }

    #[test]
    fn turns_of_curves_around_the_origin() {
        assert_eq!(turns_of(&[0, 1, 2, 3, 4, 5, 6, 7]), Some(1));
        assert_eq!(turns_of(&[7, 6, 5, 4, 3, 2, 1, 0]), Some(-1));
        assert_eq!(turns_of(&[0, 3, 6, 1, 4, 7, 2, 5]), Some(3));
        assert_eq!(turns_of(&[0, 2, 4, 6]), Some(1));
        // Beside the origin, and past it both ways.
        assert_eq!(turns_of(&[7, 0, 1, 2, 1]), Some(0));
        assert_eq!(turns_of(&[6, 4, 2, 4]), Some(0));
        assert_eq!(turns_of(&[0, 4]), None);
    }
}
