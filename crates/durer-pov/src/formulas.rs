//! The functions that functions.inc names, by the numbers it uses.

use durer_scene::tape::{Builder, Formula, FormulaError, NodeId, Op};

/// Why a number has no formula.
pub(crate) enum Lacking {
    /// No function has it.
    Unknown,
    /// Its function has no formula here, for this reason.
    NotYet(&'static str),
}

struct Sketch {
    b: Builder,
}

type Step = Result<NodeId, FormulaError>;

impl Sketch {
    fn p(&mut self, i: u32) -> Step {
        self.b.input(i)
    }
    fn sqr(&mut self, a: NodeId) -> Step {
        self.b.push(Op::Sqr(a))
    }
    fn add(&mut self, a: NodeId, b: NodeId) -> Step {
        self.b.push(Op::Add(a, b))
    }
    fn sub(&mut self, a: NodeId, b: NodeId) -> Step {
        self.b.push(Op::Sub(a, b))
    }
    fn sqrt(&mut self, a: NodeId) -> Step {
        self.b.push(Op::Sqrt(a))
    }
    fn length(&mut self) -> Step {
        let (x, y, z) = (self.p(0)?, self.p(1)?, self.p(2)?);
        let (x, y, z) = (self.sqr(x)?, self.sqr(y)?, self.sqr(z)?);
        let s = self.add(x, y)?;
        let s = self.add(s, z)?;
        self.sqrt(s)
    }
}

/// The formula of `internal(number)`.
pub(crate) fn internal(number: f64) -> Result<Formula, Lacking> {
    let mut s = Sketch { b: Builder::new() };
    let built = match number {
        57.0 => s.length().map(|root| s.b.finish(root, 3)),
        61.0 => s.length().and_then(|r| {
            let p = s.p(3)?;
            let root = s.sub(r, p)?;
            Ok(s.b.finish(root, 4))
        }),
        n if (0.0..=78.0).contains(&n) => return Err(Lacking::NotYet("its formula is not known here")),
        _ => return Err(Lacking::Unknown),
    };
    built.map_err(|_| Lacking::Unknown)
}
