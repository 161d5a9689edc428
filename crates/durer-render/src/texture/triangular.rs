//! Triangular columns along y in six colours.
//!
//! Sides have length 1. The triangles stand in rows along x, alternately on a side and on a corner;
//! the corner of one that stands on it is at the origin. Every other row is shifted by 3/2.

use super::cells::BORDER;
use crate::vector::floor;
use durer_math::Point3;

const HEIGHT: f64 = 0.866_025_403_784_438_6; // sqrt(3) / 2

/// The kinds of six triangles in a row, from the one whose corner is at the origin.
const KINDS: [usize; 6] = [1, 0, 3, 4, 5, 2];

/// The kind of the triangle that contains a point.
pub(super) fn kind(p: Point3) -> usize {
    let along = p.z / HEIGHT + BORDER;
    let row = floor(along);
    let up = along - row;
    let is_odd = row * 0.5 != floor(row * 0.5);
    let x = p.x + if is_odd { 1.5 } else { 0.0 } - up * 0.5 + BORDER;
    let whole = floor(x);
    let stands = x - whole < 1.0 - up;
    let number = 2.0 * whole + if stands { 1.0 } else { 2.0 };
    KINDS[((number - 6.0 * floor(number / 6.0)) as usize).min(5)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of POV-Ray in the middle of two rows.
    #[test]
    fn two_rows_have_known_kinds() {
        let row = |z: f64| {
            core::array::from_fn::<_, 9, _>(|k| kind(Point3::new((k as f64 - 4.0) * 0.5, 7.0, z * HEIGHT)))
        };
        assert_eq!(row(0.5), [3, 4, 5, 2, 1, 0, 3, 4, 5]);
        assert_eq!(row(1.5), [2, 1, 0, 3, 4, 5, 2, 1, 0]);
    }
}
