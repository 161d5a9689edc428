//! Julia sets of quaternions and hypercomplex numbers, to a number of iterations.
//!
//! ```text
//!   z_0 = the point in its slice of four dimensions,  z_(n+1) = z_n^k + c,  k = 2 or 3
//!
//!   the solid: { p : |z_n|^2 <= 4 for n = 0 .. N }
//! ```
//!
//! A. Norton, "Generation and display of geometric fractals in 3-D", SIGGRAPH 1982; J. C. Hart, D. J. Sandin, L. H. Kauffman, "Ray tracing
//! deterministic 3-D fractals", SIGGRAPH 1989. Those march by an estimate of the distance. Here the surface is what it is defined to be, the
//! zero set of `max |z_n|^2 - 4`, and its crossings are bracketed by certain signs like those of any formula. For quaternions with `|c| <= 2`
//! an orbit that leaves the ball of radius 2 never returns, so that this is `|z_N| = 2`; in general it is not.
//!
//! **Nothing overflows.** Each coordinate of each `z_n` is clamped to `[-K, K]`, `K = 4`. If no clamp acts up to `n`, all is as defined. If
//! one does, at the first such `n` a coordinate is `K` or `-K`, so `|z_n|^2 >= 16`, and the true `z_n` has a coordinate that is larger still: by
//! the formula as by the definition the point is outside, whatever later iterations make of it. So both have the same sign everywhere, and
//! their values agree wherever that matters, near zero. For the same reason evaluation [stops](Op::Settled) where all points at
//! hand have left.
//!
//! **The container.** `n = 0` says `|z_0| <= 2`, and a point is no longer than it is in its slice: all is in the ball of radius 2.

use super::{Container, Isosurface, IsosurfaceError};
use crate::tape::{Builder, Formula, FormulaError, NodeId, Op};
use crate::{Sphere, SphereError};
use durer_math::Point3;

/// The algebra of the four coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JuliaAlgebra {
    /// `ij = k = -ji`, `i^2 = j^2 = k^2 = -1`.
    Quaternion,
    /// `ij = ji = k`, `i^2 = j^2 = -1`, `k^2 = 1`.
    Hypercomplex,
}

/// What is iterated, besides adding `c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JuliaPower {
    /// `z^2`.
    Square,
    /// `z^3`.
    Cube,
}

/// A Julia set, not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Julia {
    /// The constant: 1, i, j, k.
    pub c: [f64; 4],
    /// The algebra.
    pub algebra: JuliaAlgebra,
    /// The power.
    pub power: JuliaPower,
    /// How often it is iterated.
    pub iterations: u32,
    /// The normal of the slice, `x y z w`; `w` is not zero.
    pub normal: [f64; 4],
    /// The slice is `normal . q = distance |normal|`.
    pub distance: f64,
}

/// Why a Julia set cannot be had.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum JuliaError {
    /// A number is infinite or NaN.
    #[error("julia_fractal: its numbers must be finite, got {0}")]
    Number(f64),
    /// The slice contains the fourth axis.
    #[error("julia_fractal: the fourth component of the slice's normal must not be zero")]
    Slice,
    /// More iterations than make sense in f64.
    #[error("julia_fractal: it can be iterated {MOST_ITERATIONS} times at most, not {0}")]
    Iterations(u32),
    /// The formula cannot be had.
    #[error(transparent)]
    Surface(#[from] IsosurfaceError),
    /// The container cannot be had.
    #[error(transparent)]
    Container(#[from] SphereError),
}

/// More iterations than this no Julia set may have.
pub const MOST_ITERATIONS: u32 = 1000;

/// Where coordinates are clamped; its square exceeds 4 by far more than rounding.
const CLAMP: f64 = 4.0;

/// The radius of the container: so much above 2 that the sign on it is plain.
const RADIUS: f64 = 2.0 + 1.0 / 64.0;

/// The solid Julia set.
pub fn julia(set: &Julia) -> Result<Isosurface, JuliaError> {
    if let Some(&bad) = set.c.iter().chain(&set.normal).chain([&set.distance]).find(|x| !x.is_finite()) {
        return Err(JuliaError::Number(bad));
    }
    if set.normal[3] == 0.0 {
        return Err(JuliaError::Slice);
    }
    if set.iterations > MOST_ITERATIONS {
        return Err(JuliaError::Iterations(set.iterations));
    }
    let formula = formula(set).map_err(IsosurfaceError::from)?;
    let held = Sphere::new(Point3::ORIGIN, RADIUS)?;
    Ok(Isosurface::new(&formula, 0.0, Container::Ball(held))?)
}

/// `max |z_n|^2 - 4`.
fn formula(set: &Julia) -> Result<Formula, FormulaError> {
    let mut b = Builder::new();
    let p = [b.input(0)?, b.input(1)?, b.input(2)?];
    // w = (distance |n| - n . p) / n_w
    let mut length2 = b.constant(0.0)?;
    for x in set.normal {
        let x = b.constant(x)?;
        let square = b.push(Op::Sqr(x))?;
        length2 = b.push(Op::Add(length2, square))?;
    }
    let length = b.push(Op::Sqrt(length2))?;
    let distance = b.constant(set.distance)?;
    let mut w = b.push(Op::Mul(distance, length))?;
    for (x, normal) in p.into_iter().zip(set.normal) {
        if normal != 0.0 {
            let n = b.constant(normal)?;
            let term = b.push(Op::Mul(n, x))?;
            w = b.push(Op::Sub(w, term))?;
        }
    }
    let last = b.constant(set.normal[3])?;
    let w = b.push(Op::Div(w, last))?;
    let mut z = [p[0], p[1], p[2], w];
    let mut most = None;
    for n in 0..=set.iterations {
        z = clamped(&mut b, z)?;
        let excess = excess(&mut b, z)?;
        let here = match most {
            None => excess,
            Some(most) => b.push(Op::Max(most, excess))?,
        };
        most = Some(b.push(Op::Settled(here))?);
        if n < set.iterations {
            let power = match (set.algebra, set.power) {
                (JuliaAlgebra::Quaternion, JuliaPower::Square) => squared(&mut b, z)?,
                (JuliaAlgebra::Quaternion, JuliaPower::Cube) => cubed(&mut b, z)?,
                (JuliaAlgebra::Hypercomplex, JuliaPower::Square) => product(&mut b, z, z)?,
                (JuliaAlgebra::Hypercomplex, JuliaPower::Cube) => {
                    let square = product(&mut b, z, z)?;
                    product(&mut b, z, square)?
                }
            };
            for i in 0..4 {
                let c = b.constant(set.c[i])?;
                z[i] = b.push(Op::Add(power[i], c))?;
            }
        }
    }
    let root = most.unwrap_or(p[0]);
    Ok(b.finish(root, 3))
}

fn clamped(b: &mut Builder, z: [NodeId; 4]) -> Result<[NodeId; 4], FormulaError> {
    let (low, high) = (b.constant(-CLAMP)?, b.constant(CLAMP)?);
    let mut all = z;
    for x in &mut all {
        let above = b.push(Op::Max(*x, low))?;
        *x = b.push(Op::Min(above, high))?;
    }
    Ok(all)
}

/// `|z|^2 - 4`.
fn excess(b: &mut Builder, z: [NodeId; 4]) -> Result<NodeId, FormulaError> {
    let mut sum = b.constant(-4.0)?;
    for x in z {
        let square = b.push(Op::Sqr(x))?;
        sum = b.push(Op::Add(sum, square))?;
    }
    Ok(sum)
}

/// `(a + v)^2 = a^2 - |v|^2 + 2 a v`.
fn squared(b: &mut Builder, z: [NodeId; 4]) -> Result<[NodeId; 4], FormulaError> {
    let [s0, s1, s2, s3] = squares(b, z)?;
    let real = b.push(Op::Sub(s0, s1))?;
    let real = b.push(Op::Sub(real, s2))?;
    let real = b.push(Op::Sub(real, s3))?;
    let twice = b.push(Op::Add(z[0], z[0]))?;
    let mut part = |i: usize| b.push(Op::Mul(twice, z[i]));
    Ok([real, part(1)?, part(2)?, part(3)?])
}

/// `(a + v)^3 = a (a^2 - 3 |v|^2) + (3 a^2 - |v|^2) v`.
fn cubed(b: &mut Builder, z: [NodeId; 4]) -> Result<[NodeId; 4], FormulaError> {
    let [s0, s1, s2, s3] = squares(b, z)?;
    let v2 = b.push(Op::Add(s1, s2))?;
    let v2 = b.push(Op::Add(v2, s3))?;
    let three = b.constant(3.0)?;
    let (v6, a6) = (b.push(Op::Mul(three, v2))?, b.push(Op::Mul(three, s0))?);
    let (left, right) = (b.push(Op::Sub(s0, v6))?, b.push(Op::Sub(a6, v2))?);
    let real = b.push(Op::Mul(z[0], left))?;
    let mut part = |i: usize| b.push(Op::Mul(right, z[i]));
    Ok([real, part(1)?, part(2)?, part(3)?])
}

fn squares(b: &mut Builder, z: [NodeId; 4]) -> Result<[NodeId; 4], FormulaError> {
    let mut square = |i: usize| b.push(Op::Sqr(z[i]));
    Ok([square(0)?, square(1)?, square(2)?, square(3)?])
}

/// The hypercomplex product.
fn product(b: &mut Builder, z: [NodeId; 4], y: [NodeId; 4]) -> Result<[NodeId; 4], FormulaError> {
    // Four terms a coordinate: with which sign, of which factors.
    const TERMS: [[(bool, usize, usize); 4]; 4] = [
        [(true, 0, 0), (false, 1, 1), (false, 2, 2), (true, 3, 3)],
        [(true, 0, 1), (true, 1, 0), (false, 2, 3), (false, 3, 2)],
        [(true, 0, 2), (true, 2, 0), (false, 1, 3), (false, 3, 1)],
        [(true, 0, 3), (true, 3, 0), (true, 1, 2), (true, 2, 1)],
    ];
    let mut out = z;
    for (coordinate, terms) in out.iter_mut().zip(TERMS) {
        let mut sum = None;
        for (plus, i, j) in terms {
            let term = b.push(Op::Mul(z[i], y[j]))?;
            sum = Some(match (sum, plus) {
                // The first one is added to nothing.
                (None, _) => term,
                (Some(sum), true) => b.push(Op::Add(sum, term))?,
                (Some(sum), false) => b.push(Op::Sub(sum, term))?,
            });
        }
        *coordinate = sum.unwrap_or(*coordinate);
    }
    Ok(out)
}
