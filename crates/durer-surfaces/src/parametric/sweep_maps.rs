//! The formulas of a sweep's walls and caps (`sweep.rs`): one map of the unit square for each piece of
//! the profile along each span of the path.

use super::path::{PathSpline, Span};
use super::piece::Face;
use crate::prism::curved::Bezier;
use durer_formula::Function;
use durer_formula::{Builder, FormulaError, NodeId, Op, VectorTape};
use durer_math::Vec3;

/// The maps of the walls and caps of a sweep: what all of them have in common.
pub(super) struct Maps {
    pub(super) spline: PathSpline,
    pub(super) up: Option<Vec3>,
    /// The twist of a span.
    pub(super) twist: f64,
}

/// How far faces reach beyond their borders: more than the frames of neighbours differ by.
pub(super) const OVERLAP: f64 = durer_math::scale::pow2(-44);

/// A vector of formulas.
type Vector = [NodeId; 3];

/// Writes the formulas of one map.
struct Pen(Builder);

type Written<T> = Result<T, FormulaError>;

impl Pen {
    fn number(&mut self, x: f64) -> Written<NodeId> {
        self.0.constant(x)
    }

    fn constant(&mut self, v: Vec3) -> Written<Vector> {
        Ok([self.number(v.x)?, self.number(v.y)?, self.number(v.z)?])
    }

    fn add(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Add(a, b))
    }

    fn sub(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Sub(a, b))
    }

    fn mul(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Mul(a, b))
    }

    fn sum(&mut self, a: Vector, b: Vector) -> Written<Vector> {
        Ok([self.add(a[0], b[0])?, self.add(a[1], b[1])?, self.add(a[2], b[2])?])
    }

    fn times(&mut self, k: NodeId, a: Vector) -> Written<Vector> {
        Ok([self.mul(k, a[0])?, self.mul(k, a[1])?, self.mul(k, a[2])?])
    }

    fn dot(&mut self, a: Vector, b: Vector) -> Written<NodeId> {
        let mut sum = self.mul(a[0], b[0])?;
        for k in 1..3 {
            let term = self.mul(a[k], b[k])?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }

    fn cross(&mut self, a: Vector, b: Vector) -> Written<Vector> {
        let mut out = a;
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (p, q) = (self.mul(a[i], b[j])?, self.mul(a[j], b[i])?);
            out[k] = self.sub(p, q)?;
        }
        Ok(out)
    }

    fn unit(&mut self, a: Vector) -> Written<Vector> {
        let square = self.dot(a, a)?;
        let length = self.0.push(Op::Sqrt(square))?;
        let mut out = a;
        for x in &mut out {
            *x = self.0.push(Op::Div(*x, length))?;
        }
        Ok(out)
    }

    /// A Bezier curve at `t`; its coefficients are rounded once, alike for equal points.
    fn bezier(&mut self, points: [f64; 4], t: NodeId) -> Written<NodeId> {
        let one = self.number(1.0)?;
        let s = self.sub(one, t)?;
        let (ss, tt) = (self.0.push(Op::Sqr(s))?, self.0.push(Op::Sqr(t))?);
        let three = self.number(3.0)?;
        let (a, d) = (self.mul(ss, s)?, self.mul(tt, t)?);
        let (b, c) = (self.mul(ss, t)?, self.mul(s, tt)?);
        let (b, c) = (self.mul(three, b)?, self.mul(three, c)?);
        let mut sum = self.number(0.0)?;
        for (weight, p) in [a, b, c, d].into_iter().zip(points) {
            let p = self.number(p)?;
            let term = self.mul(weight, p)?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }

    /// The slope of a Bezier curve, divided by 3.
    fn slope(&mut self, p: [f64; 4], t: NodeId) -> Written<NodeId> {
        let one = self.number(1.0)?;
        let s = self.sub(one, t)?;
        let (ss, tt, st) = (self.0.push(Op::Sqr(s))?, self.0.push(Op::Sqr(t))?, self.mul(s, t)?);
        let two = self.number(2.0)?;
        let st = self.mul(two, st)?;
        let mut sum = self.number(0.0)?;
        for (weight, k) in [ss, st, tt].into_iter().zip(0..) {
            let (a, b) = (self.number(p[k])?, self.number(p[k + 1])?);
            let step = self.sub(b, a)?;
            let term = self.mul(weight, step)?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }
}

/// A coordinate of control points.
fn coordinate(points: &[[f64; 4]; 4], k: usize) -> [f64; 4] {
    points.map(|p| p[k])
}

impl Maps {
    /// The point of the profile's plane with these coordinates, at `u` of a span.
    fn point(
        &self,
        pen: &mut Pen,
        (number, span): (usize, &Span),
        ab: [NodeId; 2],
        u: NodeId,
    ) -> Written<Vector> {
        if self.spline == PathSpline::Linear {
            return self.straight(pen, (number, span), ab, u);
        }
        let mut c = [u; 3];
        let mut slope = [u; 3];
        for k in 0..3 {
            c[k] = pen.bezier(coordinate(&span.points, k), u)?;
            slope[k] = pen.slope(coordinate(&span.points, k), u)?;
        }
        let t = pen.unit(slope)?;
        let x = match self.up {
            Some(up) => {
                let up = pen.constant(up)?;
                let x = pen.cross(up, t)?;
                pen.unit(x)?
            }
            None => {
                // The smallest rotation of the first tangent onto this one.
                let (first, x) = (pen.constant(span.t)?, pen.constant(span.x)?);
                let sum = pen.sum(first, t)?;
                let (over, under, one) = (pen.dot(x, t)?, pen.dot(first, t)?, pen.number(-1.0)?);
                let under = pen.sub(one, under)?;
                let by = pen.0.push(Op::Div(over, under))?;
                let back = pen.times(by, sum)?;
                pen.sum(x, back)?
            }
        };
        let off = self.offset(pen, (number, span), (x, t), ab, u)?;
        let size = pen.bezier(coordinate(&span.points, 3), u)?;
        let off = pen.times(size, off)?;
        pen.sum(c, off)
    }

    /// `a X + b Y` after the turn and the twist at `u`.
    fn offset(
        &self,
        pen: &mut Pen,
        (number, span): (usize, &Span),
        (x, t): (Vector, Vector),
        [a, b]: [NodeId; 2],
        u: NodeId,
    ) -> Written<Vector> {
        let y = pen.cross(t, x)?;
        let (start, turn) = (self.twist * number as f64, self.twist + span.turn);
        let (mut a, mut b) = (a, b);
        if start != 0.0 || turn != 0.0 {
            let (start, turn) = (pen.number(start)?, pen.number(turn)?);
            let angle = pen.mul(turn, u)?;
            let angle = pen.add(start, angle)?;
            let s = pen.0.push(Op::Function(Function::Sin, angle))?;
            let c = pen.0.push(Op::Function(Function::Cos, angle))?;
            let (ac, bs, sa, cb) = (pen.mul(a, c)?, pen.mul(b, s)?, pen.mul(a, s)?, pen.mul(b, c)?);
            (a, b) = (pen.sub(ac, bs)?, pen.add(sa, cb)?);
        }
        let (x, y) = (pen.times(a, x)?, pen.times(b, y)?);
        pen.sum(x, y)
    }

    /// The map of a piece of the profile along a straight span, between the planes that halve its
    /// corners.
    fn straight(&self, pen: &mut Pen, at: (usize, &Span), ab: [NodeId; 2], u: NodeId) -> Written<Vector> {
        let span = at.1;
        let (x, t) = (pen.constant(span.x)?, pen.constant(span.t)?);
        let one = pen.number(1.0)?;
        let rest = pen.sub(one, u)?;
        let [from, to] = [span.points[0], span.points[3]];
        let mut size = pen.number(0.0)?;
        let mut sum = [size; 3];
        // How far along the tangent the ends are moved.
        let mut along = size;
        for (end, (weight, p)) in [(rest, from), (u, to)].into_iter().enumerate() {
            let place = pen.constant(Vec3::new(p[0], p[1], p[2]))?;
            let place = pen.times(weight, place)?;
            sum = pen.sum(sum, place)?;
            let own = pen.number(p[3])?;
            let part = pen.mul(weight, own)?;
            size = pen.add(size, part)?;
            let mitre = pen.constant(span.mitres[end])?;
            let here = pen.number(end as f64)?;
            let off = self.offset(pen, at, (x, t), ab, here)?;
            let (over, under) = (pen.dot(off, mitre)?, pen.dot(t, mitre)?);
            let by = pen.0.push(Op::Div(over, under))?;
            let by = pen.mul(part, by)?;
            along = pen.sub(along, by)?;
        }
        let off = self.offset(pen, at, (x, t), ab, u)?;
        let (off, along) = (pen.times(size, off)?, pen.times(along, t)?);
        let sum = pen.sum(sum, off)?;
        pen.sum(sum, along)
    }

    /// A piece of the profile along a span: parameters along the profile and along the span.
    pub(super) fn wall(&self, number: usize, span: &Span, piece: &Bezier) -> Written<Face> {
        let mut pen = Pen(Builder::new());
        let (v, u) = (pen.0.input(0)?, pen.0.input(1)?);
        let ab = profile(&mut pen, piece, v)?;
        let roots = self.point(&mut pen, (number, span), ab, u)?;
        Ok(Face::new(VectorTape::of(&pen.0, roots), [[0.0, 1.0]; 2]).reaching(OVERLAP))
    }

    /// The part of a cap between a piece of the profile and the point `q`. Its normal points outward,
    /// away from the path.
    pub(super) fn cap(
        &self,
        number: usize,
        span: &Span,
        piece: &Bezier,
        q: [f64; 2],
        at_end: bool,
    ) -> Written<Face> {
        let mut pen = Pen(Builder::new());
        let inputs = [pen.0.input(0)?, pen.0.input(1)?];
        let [v, r] = if at_end { [inputs[1], inputs[0]] } else { inputs };
        let mut ab = profile(&mut pen, piece, v)?;
        for (x, q) in ab.iter_mut().zip(q) {
            let q = pen.number(q)?;
            let by = pen.sub(*x, q)?;
            let by = pen.mul(r, by)?;
            *x = pen.add(q, by)?;
        }
        let u = pen.number(if at_end { 1.0 } else { 0.0 })?;
        let roots = self.point(&mut pen, (number, span), ab, u)?;
        Ok(Face::new(VectorTape::of(&pen.0, roots), [[0.0, 1.0]; 2]).reaching(OVERLAP))
    }
}

/// A point of the profile.
fn profile(pen: &mut Pen, piece: &Bezier, v: NodeId) -> Written<[NodeId; 2]> {
    let of = |pen: &mut Pen, k: usize| -> Written<NodeId> {
        let [a, _, _, d] = piece.map(|p| p[k]);
        if is_straight(piece) {
            let (a, d) = (pen.number(a)?, pen.number(d)?);
            let one = pen.number(1.0)?;
            let rest = pen.sub(one, v)?;
            let (a, d) = (pen.mul(rest, a)?, pen.mul(v, d)?);
            return pen.add(a, d);
        }
        pen.bezier(piece.map(|p| p[k]), v)
    };
    Ok([of(pen, 0)?, of(pen, 1)?])
}

/// A straight edge has its own ends as its inner control points.
fn is_straight(piece: &Bezier) -> bool {
    piece[0] == piece[1] && piece[2] == piece[3]
}
