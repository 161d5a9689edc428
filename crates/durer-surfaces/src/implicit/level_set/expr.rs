//! A builder that writes formulas almost as on paper.

use durer_formula::Function;
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_math::{Affine, Interval, Point3, Vec3};

/// A step, or too many of them.
pub(crate) type Step = Result<NodeId, FormulaError>;

/// A builder with short names.
pub(crate) struct ExprBuilder(pub(crate) Builder);

impl ExprBuilder {
    /// A builder for a formula of a point, and the point.
    pub(crate) fn new() -> Result<(Self, [NodeId; 3]), FormulaError> {
        let mut b = Builder::new();
        let p = [b.input(0)?, b.input(1)?, b.input(2)?];
        Ok((Self(b), p))
    }

    /// The formula of a point whose value is that of `root`.
    pub(crate) fn done(&self, root: NodeId) -> Formula {
        self.0.finish(root, 3)
    }

    pub(crate) fn number(&mut self, x: f64) -> Step {
        self.0.constant(x)
    }

    pub(crate) fn enclosed(&mut self, x: Interval) -> Step {
        self.0.enclosed(x)
    }

    pub(crate) fn neg(&mut self, a: NodeId) -> Step {
        self.0.push(Op::Neg(a))
    }

    pub(crate) fn add(&mut self, a: NodeId, b: NodeId) -> Step {
        self.0.push(Op::Add(a, b))
    }

    pub(crate) fn sub(&mut self, a: NodeId, b: NodeId) -> Step {
        self.0.push(Op::Sub(a, b))
    }

    /// A product of finite numbers: zero times anything is zero.
    pub(crate) fn mul(&mut self, a: NodeId, b: NodeId) -> Step {
        let zero = self.number(0.0)?;
        if a == zero || b == zero { Ok(zero) } else { self.0.push(Op::Mul(a, b)) }
    }

    pub(crate) fn div(&mut self, a: NodeId, b: NodeId) -> Step {
        self.0.push(Op::Div(a, b))
    }

    pub(crate) fn sqr(&mut self, a: NodeId) -> Step {
        self.0.push(Op::Sqr(a))
    }

    pub(crate) fn sqrt(&mut self, a: NodeId) -> Step {
        self.0.push(Op::Sqrt(a))
    }

    pub(crate) fn min(&mut self, a: NodeId, b: NodeId) -> Step {
        self.0.push(Op::Min(a, b))
    }

    pub(crate) fn max(&mut self, a: NodeId, b: NodeId) -> Step {
        self.0.push(Op::Max(a, b))
    }

    pub(crate) fn of(&mut self, f: Function, a: NodeId) -> Step {
        self.0.push(Op::Function(f, a))
    }

    pub(crate) fn atan2(&mut self, y: NodeId, x: NodeId) -> Step {
        self.0.push(Op::Atan2(y, x))
    }

    /// `below` where `c < 0`, otherwise `above`.
    pub(crate) fn select(&mut self, c: NodeId, below: NodeId, above: NodeId) -> Step {
        if below == above { Ok(below) } else { self.0.push(Op::Select([c, below, above, above])) }
    }

    /// Numbers for the three coordinates.
    pub(crate) fn numbers(&mut self, v: [f64; 3]) -> Result<[NodeId; 3], FormulaError> {
        Ok([self.number(v[0])?, self.number(v[1])?, self.number(v[2])?])
    }

    pub(crate) fn minus(&mut self, a: [NodeId; 3], b: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        Ok([self.sub(a[0], b[0])?, self.sub(a[1], b[1])?, self.sub(a[2], b[2])?])
    }

    pub(crate) fn dot(&mut self, a: [NodeId; 3], b: [NodeId; 3]) -> Step {
        let mut sum = self.mul(a[0], b[0])?;
        for axis in 1..3 {
            let term = self.mul(a[axis], b[axis])?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }

    pub(crate) fn cross(&mut self, a: [NodeId; 3], b: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let mut out = a;
        for (axis, part) in out.iter_mut().enumerate() {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let (left, right) = (self.mul(a[j], b[k])?, self.mul(a[k], b[j])?);
            *part = self.sub(left, right)?;
        }
        Ok(out)
    }

    /// `v . v`.
    pub(crate) fn square_of(&mut self, v: [NodeId; 3]) -> Step {
        self.dot(v, v)
    }

    /// `L v`, with the matrix's entries as constants.
    fn rows(
        &mut self,
        v: [NodeId; 3],
        entry: impl Fn(usize, usize) -> Interval,
    ) -> Result<[NodeId; 3], FormulaError> {
        let mut out = v;
        for (i, part) in out.iter_mut().enumerate() {
            let row = [self.enclosed(entry(i, 0))?, self.enclosed(entry(i, 1))?, self.enclosed(entry(i, 2))?];
            *part = self.dot(v, row)?;
        }
        Ok(out)
    }

    /// `L p + c`.
    pub(crate) fn placed(&mut self, p: [NodeId; 3], place: &Affine) -> Result<[NodeId; 3], FormulaError> {
        let linear = place.linear();
        let v = self.rows(p, |i, j| Interval { lo: linear[i][j] + 0.0, hi: linear[i][j] + 0.0 })?;
        let c = self.numbers(place.centre().to_array())?;
        Ok([self.add(v[0], c[0])?, self.add(v[1], c[1])?, self.add(v[2], c[2])?])
    }

    /// `L^-1 (p - c)`, with the inverse matrix known within its error.
    pub(crate) fn undone(&mut self, p: [NodeId; 3], place: &Affine) -> Result<[NodeId; 3], FormulaError> {
        if *place == Affine::IDENTITY {
            return Ok(p);
        }
        let c = self.numbers(place.centre().to_array())?;
        let w = self.minus(p, c)?;
        let (inverse, error) = (place.inverse_linear(), place.inverse_error());
        self.rows(w, |i, j| match error[i][j] {
            0.0 => Interval { lo: inverse[i][j] + 0.0, hi: inverse[i][j] + 0.0 },
            error => Interval::around(inverse[i][j], error),
        })
    }

    /// A vector's length, as a constant.
    pub(crate) fn length(&mut self, v: Vec3) -> Step {
        let v = self.numbers([v.x, v.y, v.z])?;
        let square = self.square_of(v)?;
        self.sqrt(square)
    }

    /// The vector from `a` to `b`, as constants.
    pub(crate) fn between(&mut self, a: Point3, b: Point3) -> Result<[NodeId; 3], FormulaError> {
        let (a, b) = (self.numbers(a.to_array())?, self.numbers(b.to_array())?);
        self.minus(b, a)
    }

    /// The value of a formula at a point.
    ///
    /// A guarantee about a whole formula ([`Op::Settled`]) does not hold for the formula that it
    /// becomes a part of, so it is left out.
    pub(crate) fn call(&mut self, formula: &Formula, p: [NodeId; 3]) -> Step {
        let mut here: Vec<NodeId> = Vec::with_capacity(formula.ops().len());
        for &op in formula.ops() {
            here.push(match op {
                Op::Input(i) => p[i as usize],
                Op::Settled(a) => here[a.index()],
                op => self.0.push(op.renamed(|id| here[id.index()]))?,
            });
        }
        Ok(here[formula.root().index()])
    }
}
