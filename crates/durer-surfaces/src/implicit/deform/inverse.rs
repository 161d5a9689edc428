//! Maps whose inverse is given by formulas.
//!
//! Let W map a point of the deformed solid to its undeformed place. The following proves that W
//! never maps two points of a box to one. Between any two points p and q of the box, which is
//! convex, W(p) - W(q) = M (p - q) by the mean value theorem, row by row, with a matrix M whose
//! entries lie between bounds of W's slopes over the box. If no such matrix is singular, the two
//! images differ. The determinant is linear in each entry, so its extremes over all matrices
//! between the bounds are at some of the 2^9 corners, which are all computed (regularity of
//! interval matrices: A. Neumaier, *Interval Methods for Systems of Equations*, Cambridge 1990). A
//! positive determinant at every *point* would not suffice: a map may go round.

use super::DeformError;
use crate::implicit::level_set::{LevelSet, boxes, primitives};
use durer_formula::Dual;
use durer_formula::{Formula, Tape};
use durer_math::{Aabb, Interval, Point3};

/// The number of pieces along each axis into which the box is divided to bound the slopes.
const PIECES: usize = 16;

/// A matrix of bounds.
type Bounds = [[Interval; 3]; 3];

/// The part in `within` of the solid whose inverse image is `solid`.
pub(super) fn deformed(
    solid: &LevelSet,
    functions: &[Formula; 3],
    within: Aabb,
) -> Result<LevelSet, DeformError> {
    if let Some(wrong) = functions.iter().find(|f| f.inputs() != 3) {
        return Err(DeformError::Arguments(wrong.inputs()));
    }
    if !within.is_bounded() || (0..3).any(|i| within.min[i] >= within.max[i]) {
        return Err(DeformError::Within(within));
    }
    let determinant = determinants(&slopes(functions, within)?);
    if determinant.contains(0.0) || !(determinant.lo.is_finite() && determinant.hi.is_finite()) {
        return Err(DeformError::Injective(determinant));
    }
    let image = solid.pulled_back(within, |pen, p| {
        Ok([pen.call(&functions[0], p)?, pen.call(&functions[1], p)?, pen.call(&functions[2], p)?])
    })?;
    let held = LevelSet::new(primitives::cuboid(within.min, within.max)?, within);
    Ok(LevelSet::intersection(&[image, held])?)
}

/// Bounds of the slopes of three functions over a box: row by row, one function each.
fn slopes(functions: &[Formula; 3], within: Aabb) -> Result<Bounds, DeformError> {
    let mut bounds = [[None::<Interval>; 3]; 3];
    let tapes = functions.each_ref().map(Tape::new);
    for i in 0..PIECES {
        for j in 0..PIECES {
            for k in (0..PIECES).step_by(8) {
                let pieces: [Aabb; 8] = core::array::from_fn(|n| piece(&within, [i, j, k + n]));
                let x = boxes(&pieces);
                for (row, tape) in bounds.iter_mut().zip(&tapes) {
                    let Dual { v, d } = tape.gradients(&x);
                    for (entry, d) in row.iter_mut().zip(&d.d) {
                        let rough = v.partial | v.jump | d.partial;
                        for (lane, piece) in pieces.iter().enumerate() {
                            let slope = d.lane(lane);
                            if rough >> lane & 1 == 1 || !(slope.lo.is_finite() && slope.hi.is_finite()) {
                                return Err(DeformError::Rough(piece.centre()));
                            }
                            *entry = Some(entry.map_or(slope, |known| known.hull(slope)));
                        }
                    }
                }
            }
        }
    }
    Ok(bounds.map(|row| row.map(|entry| entry.unwrap_or(Interval::ENTIRE))))
}

/// One of the pieces of a box. Neighbours share the numbers of their common faces.
fn piece(within: &Aabb, at: [usize; 3]) -> Aabb {
    let node = |axis: usize, n: usize| {
        let t = n as f64 / PIECES as f64;
        if n == PIECES { within.max[axis] } else { within.min[axis] * (1.0 - t) + within.max[axis] * t }
    };
    let corner =
        |step: usize| Point3::new(node(0, at[0] + step), node(1, at[1] + step), node(2, at[2] + step));
    Aabb::new(corner(0), corner(1))
}

/// Bounds of the determinants of all matrices between these bounds.
fn determinants(m: &Bounds) -> Interval {
    let mut all: Option<Interval> = None;
    for corner in 0..1_u32 << 9 {
        let at = |i: usize, j: usize| {
            let entry = m[i][j];
            Interval::from(if corner >> (3 * i + j) & 1 == 0 { entry.lo } else { entry.hi })
        };
        let minor = |i: usize, j: usize| at(1, i) * at(2, j) - at(1, j) * at(2, i);
        let d = at(0, 0) * minor(1, 2) - at(0, 1) * minor(0, 2) + at(0, 2) * minor(0, 1);
        all = Some(all.map_or(d, |known| known.hull(d)));
    }
    all.unwrap_or(Interval::ENTIRE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(m: [[f64; 3]; 3], r: f64) -> Bounds {
        m.map(|row| row.map(|x| Interval { lo: x - r, hi: x + r }))
    }

    #[test]
    fn the_extremes_of_determinants_are_found() {
        let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // With E = all entries 1, the nearest singular matrices are I - E / 3 and such: up to that,
        // none is.
        assert!(!determinants(&around(one, 0.333)).contains(0.0));
        assert!(determinants(&around(one, 0.334)).contains(0.0));
        let far = determinants(&around(one, 0.25));
        // (1 - 3/4) at the one end; (1 + 1/4)^3 and three products of a diagonal entry with two of
        // different signs at the other.
        assert_eq!(far.lo, 0.25);
        assert_eq!(far.hi, 1.953_125 + 3.0 * 1.25 * 0.0625);
    }
}
