//! Unit cubes in two colours, like a chess board in space.

use super::cells::{cell, cell_lanes};
use crate::vector::floor_lanes;
use durer_math::{F8, M8, Point3};

/// 0 where the cube's coordinates have an even sum, else 1.
#[inline(always)]
pub(super) fn kind(p: Point3) -> usize {
    let sum = cell(p.x) + cell(p.y) + cell(p.z);
    // Half of an odd number is not an integer. Far beyond 2^53 all numbers are even.
    usize::from(sum * 0.5 != crate::vector::floor(sum * 0.5))
}

/// The lanes where the kind is 1.
#[inline(always)]
pub(super) fn odd_lanes(p: Point3<F8>) -> M8 {
    let half = (cell_lanes(p.x) + cell_lanes(p.y) + cell_lanes(p.z)) * 0.5;
    !half.equals(floor_lanes(half))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_differ() {
        let at = |x, y, z| kind(Point3::new(x, y, z));
        assert_eq!(at(0.5, 0.5, 0.5), 0);
        assert_eq!([at(1.5, 0.5, 0.5), at(0.5, -0.5, 0.5), at(-0.5, -0.5, -0.5)], [1, 1, 1]);
        assert_eq!(at(1.5, 1.5, 0.5), 0);
    }

    #[test]
    fn a_border_belongs_to_the_upper_cell_and_a_little_more() {
        let at = |y| kind(Point3::new(0.5, y, 0.5));
        assert_eq!([at(0.0), at(-1e-11), at(-1e-9)], [0, 0, 1]);
    }
}
