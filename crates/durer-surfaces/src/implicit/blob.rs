//! Blobs: fields of balls and sausages, added up; the surface is where the sum has one value.
//!
//! ```text
//!   sum of S max(0, 1 - d^2/R^2)^2 = T,  inside: more
//!
//!   d: the distance from the centre of a ball component, or from the segment that is the axis of a cylinder component
//! ```
//!
//! J. F. Blinn, "A generalization of algebraic surface drawing", *ACM Transactions on Graphics* 1(3), 1982, with fields of finite reach: G. Wyvill,
//! C. McPheeters, B. Wyvill, "Data structure for soft objects", *The Visual Computer* 2, 1986. Strengths may be negative: such components dent.
//!
//! A field ends smoothly at its radius, so that in each cell of the octree only the components that reach it stay on the tape: a term whose
//! `max` is decided for zero is gone. With `T > 0` all of the surface lies where a component of positive strength reaches.

use super::{Container, Isosurface, IsosurfaceError};
use crate::tape::{Builder, Formula, FormulaError, NodeId, Op};
use crate::{AxisBox, AxisBoxError, Sphere, SphereError};
use durer_math::{Aabb, Affine, Interval, Point3};

/// What a field's distance is measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlobShape {
    /// A point.
    Ball(Point3),
    /// All points between two.
    Segment(Point3, Point3),
}

/// A term of the sum.
#[derive(Clone, Debug, PartialEq)]
pub struct BlobComponent {
    /// What its field surrounds.
    pub shape: BlobShape,
    /// How far its field reaches; positive.
    pub radius: f64,
    /// How strong it is at distance zero.
    pub strength: f64,
    /// From its own frame to the blob's.
    pub place: Affine,
}

/// Why a blob cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BlobError {
    /// The threshold is not positive, or infinite.
    #[error("blob: its threshold must be finite and positive, got {0}")]
    Threshold(f64),
    /// A strength is infinite or NaN.
    #[error("blob: the strength of a component must be finite, got {0}")]
    Strength(f64),
    /// No component has a positive strength: the sum is nowhere the threshold.
    #[error("blob: none of its components has a positive strength, so it has no surface")]
    Nothing,
    /// The radius or the centre of a component is none.
    #[error("blob: {0}")]
    Component(#[from] SphereError),
    /// Its components reach too far or nowhere.
    #[error("blob: {0}")]
    Container(#[from] AxisBoxError),
    /// There are too many components.
    #[error(transparent)]
    Surface(#[from] IsosurfaceError),
}

/// Where the solid is, and minus its field, if all numbers are in order.
pub(super) fn checked(threshold: f64, components: &[BlobComponent]) -> Result<(Aabb, Formula), BlobError> {
    if !(threshold > 0.0 && threshold.is_finite()) {
        return Err(BlobError::Threshold(threshold));
    }
    let mut bounds = Aabb::EMPTY;
    for part in components {
        if !part.strength.is_finite() {
            return Err(BlobError::Strength(part.strength));
        }
        let reach = part.reach()?;
        if part.strength > 0.0 {
            bounds = bounds.union(reach);
        }
    }
    if bounds.is_empty() {
        return Err(BlobError::Nothing);
    }
    let formula = missing(components).map_err(IsosurfaceError::from)?;
    Ok((bounds, formula))
}

/// The solid in which the fields of `components` add up to more than `threshold`.
pub fn blob(threshold: f64, components: &[BlobComponent]) -> Result<Isosurface, BlobError> {
    let (bounds, formula) = checked(threshold, components)?;
    let held = AxisBox::new(bounds.min, bounds.max)?;
    Ok(Isosurface::new(&formula, -threshold, Container::Box(held))?)
}

impl BlobComponent {
    /// A box around all that its field reaches.
    fn reach(&self) -> Result<Aabb, SphereError> {
        let ball =
            |centre| Ok(crate::Surface::bounds_through(&Sphere::new(centre, self.radius)?, &self.place));
        match self.shape {
            BlobShape::Ball(centre) => ball(centre),
            // The hull of two balls.
            BlobShape::Segment(a, b) => Ok(ball(a)?.union(ball(b)?)),
        }
    }

    /// The square of the distance of its own point `p`, in units of its radius.
    fn distance(&self, b: &mut Builder, p: [NodeId; 3]) -> Result<NodeId, FormulaError> {
        let (from, to) = match self.shape {
            BlobShape::Ball(centre) => (centre, centre),
            BlobShape::Segment(from, to) => (from, to),
        };
        let radius = b.constant(self.radius)?;
        let radius2 = b.push(Op::Sqr(radius))?;
        let one = b.constant(1.0)?;
        let w = minus(b, p, from)?;
        if from == to {
            let square = squares(b, w)?;
            let scale = b.push(Op::Div(one, radius2))?;
            return b.push(Op::Mul(square, scale));
        }
        // With u from one end to the other and h = w . u, the point is |w x u| / |u| beside the axis, and beyond its ends by what -h or
        // h - u^2 says, times 1 / |u|. Beside and beyond share no coordinate of the point, so their bounds are tight.
        let start = [from.x, from.y, from.z];
        let mut u = [radius; 3];
        for (axis, part) in u.iter_mut().enumerate() {
            let (x, x0) = (b.constant(to[axis])?, b.constant(start[axis])?);
            *part = b.push(Op::Sub(x, x0))?;
        }
        let mut beside = w;
        for (axis, part) in beside.iter_mut().enumerate() {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let (l, r) = (times(b, w[j], u[k])?, times(b, w[k], u[j])?);
            *part = b.push(Op::Sub(l, r))?;
        }
        let mut along = b.constant(0.0)?;
        for axis in 0..3 {
            let term = times(b, w[axis], u[axis])?;
            along = b.push(Op::Add(along, term))?;
        }
        let length2 = squares(b, u)?;
        let (before, after) = (b.push(Op::Neg(along))?, b.push(Op::Sub(along, length2))?);
        let beyond = b.push(Op::Max(before, after))?;
        let zero = b.constant(0.0)?;
        let beyond = b.push(Op::Max(beyond, zero))?;
        let (beside, beyond) = (squares(b, beside)?, b.push(Op::Sqr(beyond))?);
        let sum = b.push(Op::Add(beside, beyond))?;
        let scale = b.push(Op::Mul(length2, radius2))?;
        let scale = b.push(Op::Div(one, scale))?;
        b.push(Op::Mul(sum, scale))
    }
}

/// Minus the sum of all fields: less inside, as formulas have it.
fn missing(components: &[BlobComponent]) -> Result<Formula, FormulaError> {
    let mut b = Builder::new();
    let p = [b.input(0)?, b.input(1)?, b.input(2)?];
    let (zero, one) = (b.constant(0.0)?, b.constant(1.0)?);
    let mut sum = zero;
    for part in components {
        let own = undone(&mut b, p, &part.place)?;
        let distance = part.distance(&mut b, own)?;
        let left = b.push(Op::Sub(one, distance))?;
        let left = b.push(Op::Max(left, zero))?;
        let square = b.push(Op::Sqr(left))?;
        let weight = b.constant(-part.strength)?;
        let term = b.push(Op::Mul(weight, square))?;
        sum = b.push(Op::Add(sum, term))?;
    }
    Ok(b.finish(sum, 3))
}

/// `L^-1 (p - c)`, with the inverse matrix known within its error.
fn undone(b: &mut Builder, p: [NodeId; 3], place: &Affine) -> Result<[NodeId; 3], FormulaError> {
    if *place == Affine::IDENTITY {
        return Ok(p);
    }
    let w = minus(b, p, place.centre())?;
    let (inverse, error) = (place.inverse_linear(), place.inverse_error());
    let mut own = p;
    for (i, part) in own.iter_mut().enumerate() {
        let mut sum = b.constant(0.0)?;
        for j in 0..3 {
            let entry = b.enclosed(Interval::around(inverse[i][j], error[i][j]))?;
            let term = times(b, w[j], entry)?;
            sum = b.push(Op::Add(sum, term))?;
        }
        *part = sum;
    }
    Ok(own)
}

fn minus(b: &mut Builder, p: [NodeId; 3], q: Point3) -> Result<[NodeId; 3], FormulaError> {
    let mut w = p;
    for (axis, part) in w.iter_mut().enumerate() {
        let x = b.constant(q[axis])?;
        *part = b.push(Op::Sub(*part, x))?;
    }
    Ok(w)
}

fn squares(b: &mut Builder, v: [NodeId; 3]) -> Result<NodeId, FormulaError> {
    let [x, y, z] = v;
    let (x, y, z) = (b.push(Op::Sqr(x))?, b.push(Op::Sqr(y))?, b.push(Op::Sqr(z))?);
    let sum = b.push(Op::Add(x, y))?;
    b.push(Op::Add(sum, z))
}

/// `x` times a constant; zero times anything here is zero, since what is multiplied is finite.
fn times(b: &mut Builder, x: NodeId, constant: NodeId) -> Result<NodeId, FormulaError> {
    let zero = b.constant(0.0)?;
    if constant == zero { Ok(zero) } else { b.push(Op::Mul(x, constant)) }
}
