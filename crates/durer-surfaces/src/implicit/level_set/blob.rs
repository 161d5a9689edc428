//! The formula of a blob: see [`Blob`](crate::blob::Blob), which meets rays without one.

use crate::{BlobComponent, BlobShape};
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_math::{Affine, Interval, Point3};

/// The square of the distance of its own point `p`, in units of its radius.
fn distance(part: &BlobComponent, b: &mut Builder, p: [NodeId; 3]) -> Result<NodeId, FormulaError> {
    let (from, to) = match part.shape {
        BlobShape::Ball(centre) => (centre, centre),
        BlobShape::Segment(from, to) => (from, to),
    };
    let radius = b.constant(part.radius)?;
    let radius2 = b.push(Op::Sqr(radius))?;
    let one = b.constant(1.0)?;
    let w = minus(b, p, from)?;
    if from == to {
        let square = squares(b, w)?;
        let scale = b.push(Op::Div(one, radius2))?;
        return b.push(Op::Mul(square, scale));
    }
    // With u from one end to the other and h = w . u, the point's distance from the axis is |w x u|
    // / |u|, and its distance beyond an end -h / |u| or (h - u^2) / |u|. The two share no
    // coordinate of the point, so their bounds are tight.
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

/// Minus the sum of all fields, so that it is smaller inside.
pub(super) fn missing(components: &[BlobComponent]) -> Result<Formula, FormulaError> {
    let mut b = Builder::new();
    let p = [b.input(0)?, b.input(1)?, b.input(2)?];
    let (zero, one) = (b.constant(0.0)?, b.constant(1.0)?);
    let mut sum = zero;
    for part in components {
        let own = undone(&mut b, p, &part.place)?;
        let distance = distance(part, &mut b, own)?;
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
