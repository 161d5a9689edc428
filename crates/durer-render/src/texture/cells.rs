//! Patterns that cut space into cells.

use super::{brick::Brick, checker, hexagon};
use crate::vector::floor;
use durer_math::Point3;
use durer_scene::Cells;

/// A way to cut space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cutter {
    Checker,
    Hexagon,
    Brick(Brick),
}

impl Cutter {
    pub(crate) fn new(cells: Cells) -> Self {
        match cells {
            Cells::Checker => Self::Checker,
            Cells::Hexagon => Self::Hexagon,
            Cells::Brick { size, mortar } => Self::Brick(Brick::new(size, mortar)),
        }
    }

    /// The kind of the cell in which a point lies.
    #[inline]
    pub(crate) fn kind(&self, p: Point3) -> usize {
        match self {
            Self::Checker => checker::kind(p),
            Self::Hexagon => hexagon::kind(p),
            Self::Brick(brick) => brick.kind(p),
        }
    }
}

/// How far below a border the next cell begins: a fact of the scene language (so that a plane at `y = 0`, say, shows one
/// cell, whatever the last digit of its points), and no bound of any geometry.
pub(super) const BORDER: f64 = 1e-10;

/// The number of the cell along one axis.
#[inline(always)]
pub(super) fn cell(x: f64) -> f64 {
    floor(x + BORDER)
}
