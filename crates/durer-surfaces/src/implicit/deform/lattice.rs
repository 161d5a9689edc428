//! Free-form deformation: the content of a box moves with a lattice of control points.
//!
//! ```text
//!   D(p) = p + sum of B_i(s) B_j(t) B_k(r) M_ijk,       (s, t, r) = (p - min) / (max - min)
//! ```
//!
//! `B` are Bernstein polynomials, and `M_ijk` is the displacement of the control point `(i, j, k)`
//! from its place in the regular lattice. T. W. Sederberg, S. R. Parry, "Free-form deformation of
//! solid geometric models", *SIGGRAPH* 1986, 151-160. Outside the box `(s, t, r)` is clamped to its
//! border: a point moves like the nearest point of the box, so the map is continuous, and points
//! beyond a side whose control points do not move stay in place.

use super::DeformError;
use crate::implicit::level_set::expr::ExprBuilder;
use durer_formula::{FormulaError, NodeId, Op};
use durer_math::{Aabb, Vec3};
use durer_roots::bernstein::binomial;

/// The most points along an axis.
const MOST: usize = 8;

/// A box and the displacements of its control points.
///
/// ```
/// use durer_math::{Aabb, Point3, Vec3};
/// use durer_surfaces::Lattice;
/// let cube = Aabb::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0));
/// let mut lattice = Lattice::new(cube, [2, 2, 3])?;
/// lattice.shift([1, 1, 2], Vec3::new(0.5, 0.0, 0.0))?;
/// # Ok::<(), durer_surfaces::DeformError>(())
/// ```
///
/// # Invariants
///
/// The box is finite and not flat, there are 2 to 8 points along each axis, and all moves are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    pub(crate) bounds: Aabb,
    pub(crate) size: [usize; 3],
    /// The moves: x first, then y, then z.
    pub(crate) moves: Vec<Vec3>,
}

impl Lattice {
    /// The lattice of a box with these numbers of points along the axes, without displacements.
    pub fn new(bounds: Aabb, size: [usize; 3]) -> Result<Self, DeformError> {
        let is_wide = |i: usize| bounds.min[i] < bounds.max[i] && (bounds.max[i] - bounds.min[i]).is_finite();
        if !(0..3).all(is_wide) {
            return Err(DeformError::LatticeBox(bounds));
        }
        if size.iter().any(|n| !(2..=MOST).contains(n)) {
            return Err(DeformError::LatticeSize(size));
        }
        Ok(Self { bounds, size, moves: vec![Vec3::ZERO; size.iter().product()] })
    }

    /// Adds to the displacement of a control point. Indices start at 0.
    pub fn shift(&mut self, point: [usize; 3], by: Vec3) -> Result<(), DeformError> {
        let Self { size, .. } = *self;
        if (0..3).any(|i| point[i] >= size[i]) {
            return Err(DeformError::LatticePoint { point, size });
        }
        let place = &mut self.moves[(point[2] * size[1] + point[1]) * size[0] + point[0]];
        let sum = *place + by;
        if !sum.is_finite() {
            return Err(DeformError::LatticeMove(by));
        }
        *place = sum;
        Ok(())
    }

    /// The box of the undisplaced control points.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How many control points there are along each axis.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Appends the image of a point to the formula.
    pub(super) fn applied(&self, pen: &mut ExprBuilder, p: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let mut basis = [vec![], vec![], vec![]];
        for i in 0..3 {
            let (low, high) = (pen.number(self.bounds.min[i])?, pen.number(self.bounds.max[i])?);
            let held = pen.max(p[i], low)?;
            let held = pen.min(held, high)?;
            let (along, length) = (pen.sub(held, low)?, pen.sub(high, low)?);
            let t = pen.div(along, length)?;
            basis[i] = bernstein(pen, self.size[i] - 1, t)?;
        }
        let mut out = p;
        for (number, by) in self.moves.iter().enumerate() {
            if *by == Vec3::ZERO {
                continue;
            }
            let [nx, ny, _] = self.size;
            let weight = pen.mul(basis[0][number % nx], basis[1][number / nx % ny])?;
            let weight = pen.mul(weight, basis[2][number / (nx * ny)])?;
            for (i, part) in out.iter_mut().enumerate() {
                let by = pen.number(by[i])?;
                let moved = pen.mul(weight, by)?;
                *part = pen.add(*part, moved)?;
            }
        }
        Ok(out)
    }
}

/// The Bernstein polynomials of a degree at `t`.
pub(crate) fn bernstein(
    pen: &mut ExprBuilder,
    degree: usize,
    t: NodeId,
) -> Result<Vec<NodeId>, FormulaError> {
    let one = pen.number(1.0)?;
    let rest = pen.sub(one, t)?;
    let mut power = |x: NodeId, n: usize| match n {
        0 => Ok(one),
        1 => Ok(x),
        n => pen.0.push(Op::Powi(x, n as i32)),
    };
    let mut powers = Vec::with_capacity(degree + 1);
    for i in 0..=degree {
        powers.push((power(t, i)?, power(rest, degree - i)?));
    }
    let mut out = Vec::with_capacity(degree + 1);
    for (i, (a, b)) in powers.into_iter().enumerate() {
        let product = if a == one {
            b
        } else if b == one {
            a
        } else {
            pen.mul(a, b)?
        };
        let factor = pen.number(binomial(degree, i))?;
        out.push(pen.mul(factor, product)?);
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Point3;

    fn cube() -> Aabb {
        Aabb::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0))
    }

    #[test]
    fn a_lattice_says_what_is_wrong() {
        let flat = Aabb::new(Point3::ORIGIN, Point3::new(1.0, 0.0, 1.0));
        assert!(matches!(Lattice::new(flat, [2; 3]), Err(DeformError::LatticeBox(_))));
        assert_eq!(Lattice::new(cube(), [2, 9, 2]), Err(DeformError::LatticeSize([2, 9, 2])));
        let mut lattice = Lattice::new(cube(), [2; 3]).unwrap();
        let missing = DeformError::LatticePoint { point: [0, 2, 0], size: [2; 3] };
        assert_eq!(lattice.shift([0, 2, 0], Vec3::X), Err(missing));
        assert!(lattice.shift([0, 1, 0], Vec3::new(f64::NAN, 0.0, 0.0)).is_err());
        assert_eq!(lattice.shift([0, 1, 0], Vec3::X), Ok(()));
    }

    #[test]
    fn the_polynomials_of_a_degree_add_up_to_one() {
        for degree in 1..8 {
            let (mut pen, [x, ..]) = ExprBuilder::new().unwrap();
            let all = bernstein(&mut pen, degree, x).unwrap();
            let sum = all.into_iter().reduce(|a, b| pen.add(a, b).unwrap()).unwrap();
            let value = durer_formula::Tape::new(&pen.done(sum)).value(Point3::new(0.3, 0.0, 0.0));
            // Each of at most 8 positive terms has fewer than 20 roundings; they add up to 1.
            assert!((value - 1.0).abs() < 32.0 * durer_math::U, "{degree}: {value}");
        }
    }
}
