//! The superellipsoid: a ball, a box, a double cone, a cushion or a star, depending on two
//! exponents.
//!
//! ```text
//!   (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1,  e, n > 0
//!
//!   e shapes the sections across z (1: circles, towards 0: squares, 2: diamonds, beyond: stars), n those along z
//! ```
//!
//! With `e <= 2` and `n <= 2` it is convex, and most rays need no interval bounds (`convex/`). With
//! `2 <= e, n <= 8` the outside is convex between the planes of two axes, and packets need no
//! interval bounds outside (`concave.rs`).
//!
//! A. H. Barr, "Superquadrics and angle-preserving transformations", *IEEE Computer Graphics and
//! Applications* 1(1), 1981.
//!
//! Powers rise, so bounds of the formula on a box are as tight as those of `|x|`, `|y|` and `|z|`.
//! Its slope is not: it is unbounded at the planes `x = 0` and `y = 0` for `e > 2`, at `z = 0` for
//! `n > 2`, and on the z axis for `n > e`, where the inner sum is zero. Stretches of a ray there
//! are separated by the bounds alone, down to the rounding of the formula if necessary: no crossing
//! is lost, but one on an edge or at a tip of the surface itself may be reported as a cluster.

pub(super) mod concave;
pub(super) mod convex;

use self::convex::Gauge;
use super::{Container, Isosurface, IsosurfaceError};
use crate::{AxisBox, AxisBoxError};
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_math::eft::two_prod;
use durer_math::{Interval, Point3};

/// Half the width of the container. The surface touches the planes at 1, so that its own sign is
/// plain at this distance: the power of this number exceeds 1 by more than its rounding for
/// exponents up to 1e11.
const HALF: f64 = 1.0 + 1.0 / 64.0;

/// Why a superellipsoid cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SuperellipsoidError {
    /// An exponent is out of range: powers beyond are those of a box or of three lines, to the last
    /// bit.
    #[error("superellipsoid: its exponents must be between 1e-9 and 1e9, got {0}")]
    Exponent(f64),
    /// The formula cannot be had.
    #[error(transparent)]
    Surface(#[from] IsosurfaceError),
    /// The container cannot be had.
    #[error(transparent)]
    Container(#[from] AxisBoxError),
}

/// The solid superellipsoid of the exponents `e` and `n`, within the cube from -1 to 1.
pub fn superellipsoid(e: f64, n: f64) -> Result<Isosurface, SuperellipsoidError> {
    let formula = checked(e, n)?;
    let held = AxisBox::new(Point3::new(-HALF, -HALF, -HALF), Point3::new(HALF, HALF, HALF))?;
    let container = Container::Box(held);
    match Gauge::new(e, n) {
        None => {
            let dented = Gauge::of_dents(e, n);
            Ok(Isosurface { dented, ..Isosurface::new(&formula, 1.0, container)? })
        }
        gauge => Ok(Isosurface { gauge, ..Isosurface::undivided(&formula, 1.0, container)? }),
    }
}

/// The left side of the equation, if the exponents are in range.
pub(super) fn checked(e: f64, n: f64) -> Result<Formula, SuperellipsoidError> {
    for exponent in [e, n] {
        if !(1e-9..=1e9).contains(&exponent) {
            return Err(SuperellipsoidError::Exponent(exponent));
        }
    }
    Ok(formula(e, n).map_err(IsosurfaceError::from)?)
}

/// The left side of the equation.
fn formula(e: f64, n: f64) -> Result<Formula, FormulaError> {
    let mut b = Builder::new();
    let across = b.enclosed(quotient(2.0, e))?;
    let along = b.enclosed(quotient(2.0, n))?;
    let outer = b.enclosed(quotient(e, n))?;
    let mut power = |axis: u32, exponent: NodeId| {
        let x = b.input(axis)?;
        let size = b.push(Op::Abs(x))?;
        b.push(Op::Pow(size, exponent))
    };
    let (x, y, z) = (power(0, across)?, power(1, across)?, power(2, along)?);
    let sum = b.push(Op::Add(x, y))?;
    let disc = b.push(Op::Pow(sum, outer))?;
    let root = b.push(Op::Add(disc, z))?;
    Ok(b.finish(root, 3))
}

/// `a / b` of positive numbers: the number itself if it is one, so that whole powers are seen.
fn quotient(a: f64, b: f64) -> Interval {
    let q = a / b;
    if two_prod(q, b) == (a, 0.0) {
        Interval { lo: q, hi: q }
    } else {
        Interval { lo: q.next_down(), hi: q.next_up() }
    }
}
