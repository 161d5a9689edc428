//! How often `F` turns around zero along the border of a box of parameters (`crate::degree`).
//!
//! The border is cut into stretches on each of which one of two combinations of both functions has
//! a certain sign, so that `F` stays in a half plane: the one that changes most slowly, and the one
//! across it. The half planes of neighbours have a point in common, so their directions differ by
//! less than half a turn, and these differences add up to the turns.

use super::line::View;
use super::piece::{Piece, halves};
use super::subdivide::slowest;
use crate::degree::{self, Domain, turns};

/// The most stretches of a border without a certain half plane, and how often they are halved.
const MOST_OPEN: usize = 128;
const HALVINGS: usize = 16;

/// How many times `F` turns around zero along the border of a box, by the orientation of the
/// parameters; `None` if it may be zero there.
pub(super) fn turns_around(view: &View<'_>, around: &Domain) -> Option<i32> {
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
    let sign = |by| view.reach(by, &local, piece).sign();
    degree::eighth((sign([slow[1], -slow[0]]), sign(slow)))
}
