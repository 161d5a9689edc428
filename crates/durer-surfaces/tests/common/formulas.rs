//! Formulas in the notation of paper, and their surfaces.

use durer_formula::{Builder, Formula, NodeId, Op};
use durer_math::{Point3, Ray};
use durer_surfaces::{All, AxisBox, Container, Isosurface, LocalRay, Root, Surface};

/// Builds formulas in the notation of paper.
pub(crate) struct Pen(pub(crate) Builder);

impl Pen {
    pub(crate) fn new() -> (Self, [NodeId; 3]) {
        let mut b = Builder::new();
        let inputs = [0, 1, 2].map(|i| b.input(i).unwrap());
        (Self(b), inputs)
    }
    pub(crate) fn c(&mut self, x: f64) -> NodeId {
        self.0.constant(x).unwrap()
    }
    pub(crate) fn op(&mut self, op: Op) -> NodeId {
        self.0.push(op).unwrap()
    }
    pub(crate) fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Add(a, b))
    }
    pub(crate) fn sub(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Sub(a, b))
    }
    pub(crate) fn mul(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Mul(a, b))
    }
    pub(crate) fn sqr(&mut self, a: NodeId) -> NodeId {
        self.op(Op::Sqr(a))
    }
    pub(crate) fn squares(&mut self, of: &[NodeId]) -> NodeId {
        let first = self.sqr(of[0]);
        of[1..].iter().fold(first, |sum, &x| {
            let square = self.sqr(x);
            self.add(sum, square)
        })
    }
    pub(crate) fn done(&self, root: NodeId) -> Formula {
        self.0.finish(root, 3)
    }
}

pub(crate) fn cube(half: f64) -> Container {
    Container::Box(AxisBox::new(Point3::new(-half, -half, -half), Point3::new(half, half, half)).unwrap())
}

pub(crate) fn iso(formula: &Formula, half: f64) -> Isosurface {
    Isosurface::new(formula, 0.0, cube(half)).unwrap()
}

pub(crate) fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}
