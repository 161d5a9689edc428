//! The formulas of single solids: negative inside.
//!
//! A formula may be any positive multiple of a distance or of its square. A number that is not in
//! the text (a length, a difference) is a constant within an interval, so the set is that of the
//! text's numbers.

use super::LevelSet;
use super::expr::{ExprBuilder, Step};
use crate::BlobComponent;
use crate::algebraic::powers;
use crate::implicit::{Container, IsosurfaceError, SuperellipsoidError};
use durer_formula::{Formula, FormulaError, NodeId, Op};
use durer_math::{Aabb, Point3, Vec3};

type Made = Result<Formula, FormulaError>;

/// `n . p - d |n|`: behind the plane.
pub fn half_space(normal: Vec3, distance: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let n = pen.numbers([normal.x, normal.y, normal.z])?;
    let (height, length) = (pen.dot(n, p)?, pen.length(normal)?);
    let distance = pen.number(distance)?;
    let level = pen.mul(distance, length)?;
    let f = pen.sub(height, level)?;
    Ok(pen.done(f))
}

/// `|p - c|^2 - r^2`.
pub fn ball(centre: Point3, radius: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let c = pen.numbers(centre.to_array())?;
    let w = pen.minus(p, c)?;
    let (square, radius) = (pen.square_of(w)?, pen.number(radius)?);
    let radius2 = pen.sqr(radius)?;
    let f = pen.sub(square, radius2)?;
    Ok(pen.done(f))
}

/// The greatest of `a - p` and `p - b` over the axes, for the lesser and the greater corner.
pub fn cuboid(a: Point3, b: Point3) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let mut f = None;
    for (axis, x) in p.into_iter().enumerate() {
        let side = slab(&mut pen, x, a[axis].min(b[axis]), a[axis].max(b[axis]))?;
        f = Some(match f {
            None => side,
            Some(f) => pen.max(f, side)?,
        });
    }
    Ok(pen.done(f.unwrap_or(p[0])))
}

fn slab(pen: &mut ExprBuilder, x: NodeId, low: f64, high: f64) -> Step {
    let (low, high) = (pen.number(low)?, pen.number(high)?);
    let (under, over) = (pen.sub(low, x)?, pen.sub(x, high)?);
    pen.max(under, over)
}

/// A cylinder (equal radii), a cone or a frustum between two points, with its ends: with u the
/// axis, w from the base and h = w . u it is `|w x u|^2 <= (r0 |u| + (r1 - r0) h / |u|)^2` and
/// `0 <= h <= |u|^2`.
pub fn frustum(base: Point3, base_radius: f64, cap: Point3, cap_radius: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let start = pen.numbers(base.to_array())?;
    let (w, u) = (pen.minus(p, start)?, pen.between(base, cap)?);
    let (h, length2) = (pen.dot(w, u)?, pen.square_of(u)?);
    let beside = pen.cross(w, u)?;
    let beside = pen.square_of(beside)?;
    let (r0, r1) = (pen.number(base_radius)?, pen.number(cap_radius)?);
    let grows = pen.sub(r1, r0)?;
    let length = pen.sqrt(length2)?;
    let (first, slope) = (pen.mul(r0, length)?, pen.div(grows, length)?);
    let grown = pen.mul(h, slope)?;
    let radius = pen.add(first, grown)?;
    let radius2 = pen.sqr(radius)?;
    let wall = pen.sub(beside, radius2)?;
    let (under, over) = (pen.neg(h)?, pen.sub(h, length2)?);
    let ends = pen.max(under, over)?;
    let f = pen.max(wall, ends)?;
    Ok(pen.done(f))
}

/// The general quadric: coefficients of x², y², z², xy, xz, yz, x, y, z, 1.
pub fn quadric([a, b, c, d, e, f, g, h, i, j]: [f64; 10]) -> Made {
    polynomial(2, &[a, d, e, g, b, f, h, c, i, j])
}

/// A polynomial of this order: coefficients by falling powers of x, then of y, then of z. The
/// missing ones are zero.
///
/// In powers, not in Horner's form: bounds of an even power on a box are never negative.
pub fn polynomial(order: u32, coefficients: &[f64]) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let mut sum = pen.number(0.0)?;
    for (powers, &c) in powers(order).zip(coefficients).filter(|(_, c)| **c != 0.0) {
        let mut term = pen.number(c)?;
        for (x, n) in p.into_iter().zip(powers).filter(|(_, n)| *n > 0) {
            let power = pen.0.push(Op::Powi(x, n as i32))?;
            term = pen.mul(term, power)?;
        }
        sum = pen.add(sum, term)?;
    }
    Ok(pen.done(sum))
}

/// `(|p|^2 - R^2 - r^2)^2 + 4 R^2 (y^2 - r^2)`: about the y axis. What is inside twice, in a
/// spindle, is outside.
pub fn torus(major: f64, minor: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let (major, minor) = (pen.number(major)?, pen.number(minor)?);
    let (big, small) = (pen.sqr(major)?, pen.sqr(minor)?);
    let (square, radii) = (pen.square_of(p)?, pen.add(big, small)?);
    let q = pen.sub(square, radii)?;
    let (q2, y2) = (pen.sqr(q)?, pen.sqr(p[1])?);
    let flat = pen.sub(y2, small)?;
    let four = pen.number(4.0)?;
    let weight = pen.mul(four, big)?;
    let term = pen.mul(weight, flat)?;
    let f = pen.add(q2, term)?;
    Ok(pen.done(f))
}

/// `(|p|^2 - b^2 - d^2)^2 + 4 b^2 y^2 - 4 (a d - c x)^2` with `b^2 = a^2 - c^2`: see
/// [`Cyclide`](crate::Cyclide).
pub fn cyclide(a: f64, c: f64, d: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let (a, c, d) = (pen.number(a)?, pen.number(c)?, pen.number(d)?);
    let (less, more) = (pen.sub(a, c)?, pen.add(a, c)?);
    let (b2, d2) = (pen.mul(less, more)?, pen.sqr(d)?);
    let (square, radii) = (pen.square_of(p)?, pen.add(b2, d2)?);
    let q = pen.sub(square, radii)?;
    let (ad, cx) = (pen.mul(a, d)?, pen.mul(c, p[0])?);
    let e = pen.sub(ad, cx)?;
    let (q2, y2, e2) = (pen.sqr(q)?, pen.sqr(p[1])?, pen.sqr(e)?);
    let flat = pen.mul(b2, y2)?;
    let (flat, four) = (pen.sub(flat, e2)?, pen.number(4.0)?);
    let term = pen.mul(four, flat)?;
    let f = pen.add(q2, term)?;
    Ok(pen.done(f))
}

/// A quadric in its principal frame: with X = x / a, Y = y / b, Z = z / c it is
/// `s . (X², Y², Z²) + l . (X, Y, Z) + k`; the part between two heights, if there are any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// The semi-axes a, b, c.
    pub semi_axes: [f64; 3],
    /// The factors s of the squares.
    pub squares: [f64; 3],
    /// The factors l of the coordinates.
    pub linear: [f64; 3],
    /// The constant k.
    pub constant: f64,
    /// The range of z.
    pub extent: Option<[f64; 2]>,
}

/// See [`Principal`].
pub fn principal(it: &Principal) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let mut f = pen.number(it.constant)?;
    for (axis, x) in p.into_iter().enumerate() {
        let semi_axis = pen.number(it.semi_axes[axis])?;
        let ratio = pen.div(x, semi_axis)?;
        let square = pen.sqr(ratio)?;
        for (factor, of) in [(it.squares[axis], square), (it.linear[axis], ratio)] {
            let factor = pen.number(factor)?;
            let term = pen.mul(factor, of)?;
            f = pen.add(f, term)?;
        }
    }
    if let Some([from, to]) = it.extent {
        let ends = slab(&mut pen, p[2], from, to)?;
        f = pen.max(f, ends)?;
    }
    Ok(pen.done(f))
}

/// The part of a ball within an angle of an axis, given by its cosine: `cos |w| - w . a / |a|` and
/// the ball.
pub fn sector(centre: Point3, radius: f64, axis: Vec3, cosine: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let c = pen.numbers(centre.to_array())?;
    let w = pen.minus(p, c)?;
    let square = pen.square_of(w)?;
    let radius = pen.number(radius)?;
    let radius2 = pen.sqr(radius)?;
    let ball = pen.sub(square, radius2)?;
    let (a, length) = (pen.numbers([axis.x, axis.y, axis.z])?, pen.length(axis)?);
    let along = pen.dot(w, a)?;
    let along = pen.div(along, length)?;
    let cosine = pen.number(cosine)?;
    let far = pen.sqrt(square)?;
    let cone = pen.mul(cosine, far)?;
    let cone = pen.sub(cone, along)?;
    let f = pen.max(ball, cone)?;
    Ok(pen.done(f))
}

/// The superellipsoid of two exponents.
pub fn superellipsoid(e: f64, n: f64) -> Result<LevelSet, SuperellipsoidError> {
    let formula = crate::implicit::superellipsoid::checked(e, n)?;
    let f = below(&formula, 1.0).map_err(IsosurfaceError::from)?;
    Ok(LevelSet::new(f, Aabb::centred(Point3::ORIGIN, Vec3::new(1.0, 1.0, 1.0))))
}

/// The blob in which the fields of these components add up to more than a threshold, within its
/// bounds.
pub fn blob(threshold: f64, components: &[BlobComponent], bounds: Aabb) -> Result<LevelSet, FormulaError> {
    Ok(LevelSet::new(below(&super::blob::missing(components)?, -threshold)?, bounds))
}

/// The points of a container where a function is below a value.
pub fn isosurface(
    function: &Formula,
    threshold: f64,
    container: &Container,
) -> Result<LevelSet, IsosurfaceError> {
    if !threshold.is_finite() {
        return Err(IsosurfaceError::Threshold(threshold));
    }
    if function.inputs() != 3 {
        return Err(IsosurfaceError::Arguments(function.inputs()));
    }
    let own = LevelSet::new(below(function, threshold)?, Aabb::UNBOUNDED);
    let held = match container {
        Container::Box(it) => cuboid(it.min(), it.max())?,
        Container::Ball(it) => ball(it.centre(), it.radius())?,
    };
    Ok(LevelSet::intersection(&[own, LevelSet::new(held, container.bounds())])?)
}

fn below(function: &Formula, threshold: f64) -> Made {
    let (mut pen, p) = ExprBuilder::new()?;
    let (value, threshold) = (pen.call(function, p)?, pen.number(threshold)?);
    let f = pen.sub(value, threshold)?;
    Ok(pen.done(f))
}
