//! Patterns that divide space into cells.

use super::{brick::Brick, checker, hexagon, square, triangular};
use crate::vector::{floor, floor_lanes};
use durer_math::lanes::LANES;
use durer_math::{F8, M8, Point3};
use durer_scene::Cells;

/// A way to divide space into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cutter {
    Checker,
    Hexagon,
    Brick(Brick),
    Square,
    Triangular,
}

impl Cutter {
    pub(crate) fn new(cells: Cells) -> Self {
        match cells {
            Cells::Checker => Self::Checker,
            Cells::Hexagon => Self::Hexagon,
            Cells::Square => Self::Square,
            Cells::Triangular => Self::Triangular,
            Cells::Brick { size, mortar } => Self::Brick(Brick::new(size, mortar)),
        }
    }

    /// The kind of the cell that contains a point.
    #[inline]
    pub(crate) fn kind(&self, p: Point3) -> usize {
        match self {
            Self::Checker => checker::kind(p),
            Self::Hexagon => hexagon::kind(p),
            Self::Brick(brick) => brick.kind(p),
            Self::Square => square::kind(p),
            Self::Triangular => triangular::kind(p),
        }
    }
}

/// The kinds of the cells that contain eight points.
pub(super) enum Kinds {
    /// 1 where the mask is set, 0 elsewhere.
    Two(M8),
    /// 0, 1 or 2.
    Three(F8),
    /// Any number.
    Many([u8; LANES]),
}

impl Cutter {
    /// The kinds of the cells that contain some points.
    #[inline(always)]
    pub(super) fn kinds(&self, p: Point3<F8>) -> Kinds {
        match self {
            Self::Checker => Kinds::Two(checker::odd_lanes(p)),
            Self::Brick(brick) => Kinds::Two(brick.brick_lanes(p)),
            Self::Hexagon => Kinds::Three(hexagon::kinds(p)),
            Self::Square | Self::Triangular => {
                let kind = |i| self.kind(p.to_vec().lane(i).to_point()) as u8;
                Kinds::Many(core::array::from_fn(kind))
            }
        }
    }
}

/// How far below a border the next cell begins. This is a fact of the scene language, not a bound
/// of any geometry: a plane at `y = 0`, say, shows one cell, whatever the last digit of its points.
pub(super) const BORDER: f64 = 1e-10;

/// The index of the cell along one axis.
#[inline(always)]
pub(super) fn cell(x: f64) -> f64 {
    floor(x + BORDER)
}

/// [`cell`] for eight numbers.
#[inline(always)]
pub(super) fn cell_lanes(x: F8) -> F8 {
    floor_lanes(x + F8::splat(BORDER))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Vec3;

    #[test]
    fn lanes_are_cut_as_single_points_are() {
        let brick = Cells::Brick { size: Vec3::new(8.0, 3.0, 4.5), mortar: 0.5 };
        for cells in [Cells::Checker, Cells::Hexagon, Cells::Square, Cells::Triangular, brick] {
            let cutter = Cutter::new(cells);
            for k in 0..500 {
                let x = |a: f64| F8(core::array::from_fn(|i| (f64::from(k * 8 + i as i32) - 1999.0) * a));
                let p = Point3::new(x(0.037), x(0.25), x(-0.113));
                let kinds: [usize; 8] = match cutter.kinds(p) {
                    Kinds::Two(one) => core::array::from_fn(|i| usize::from(one.bits() >> i & 1 == 1)),
                    Kinds::Three(kinds) => kinds.0.map(|k| k as usize),
                    Kinds::Many(kinds) => kinds.map(usize::from),
                };
                for (i, kind) in kinds.into_iter().enumerate() {
                    assert_eq!(kind, cutter.kind(p.to_vec().lane(i).to_point()));
                }
            }
        }
    }
}
