//! A formula is a list of steps, each of which uses the results of earlier ones.

use super::fold;
use crate::noise::{Nearest, NoiseTable};
use crate::{Comparison, Function};
use durer_math::Interval;
use std::collections::HashMap;

/// The most steps of a formula.
pub const MOST_STEPS: usize = 100_000;

/// A reference to a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// The number of the step, from 0.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    /// The input with this number.
    Input(u32),
    /// A number within an interval; an f64 as it was written is its own interval.
    Constant(Interval),
    /// `-a`.
    Neg(NodeId),
    /// `|a|`.
    Abs(NodeId),
    /// `a^2`.
    Sqr(NodeId),
    /// The square root; undefined below zero.
    Sqrt(NodeId),
    /// An integer power.
    Powi(NodeId, i32),
    /// A function of one number.
    Function(Function, NodeId),
    /// `a + b`.
    Add(NodeId, NodeId),
    /// `a - b`.
    Sub(NodeId, NodeId),
    /// `a b`.
    Mul(NodeId, NodeId),
    /// `a b` of integers. [`Builder::push`] detects whether the operands are integers, and converts
    /// [`Op::Mul`] to this and back.
    MulWhole(NodeId, NodeId),
    /// `k a` with a finite number `k` other than zero. [`Builder::push`] converts products with a
    /// constant to this.
    Times(f64, NodeId),
    /// `a / b`; undefined at zero.
    Div(NodeId, NodeId),
    /// The lesser one.
    Min(NodeId, NodeId),
    /// The greater one.
    Max(NodeId, NodeId),
    /// `a^b`.
    Pow(NodeId, NodeId),
    /// The angle of `(b, a)`.
    Atan2(NodeId, NodeId),
    /// The remainder of `a` divided by `b`, with the sign of `a`.
    Rem(NodeId, NodeId),
    /// Noise at a point of space: durer's own, or that of a table.
    Noise(Option<&'static NoiseTable>, [NodeId; 3]),
    /// The distance from a point of space to the nearest of random points, or to the next.
    Nearest(&'static Nearest, [NodeId; 3]),
    /// 1 or 0.
    Compare(Comparison, NodeId, NodeId),
    /// Selects by the sign of the first operand: one of the three others, for below, at and above
    /// zero.
    Select([NodeId; 4]),
    /// Selects by the sign of the first operand: the second below zero, else the third. The author
    /// guarantees that both are equal where the first is zero.
    Joined([NodeId; 3]),
    /// `a`, with the guarantee that the formula's value is at least `a`. Where `a` exceeds 1, later
    /// steps need no evaluation, because the value is far from zero.
    Settled(NodeId),
}

impl Op {
    /// The step with its operands renamed.
    #[must_use]
    pub fn renamed(self, f: impl Fn(NodeId) -> NodeId) -> Self {
        match self {
            Self::Input(_) | Self::Constant(_) => self,
            Self::Neg(a) => Self::Neg(f(a)),
            Self::Abs(a) => Self::Abs(f(a)),
            Self::Sqr(a) => Self::Sqr(f(a)),
            Self::Sqrt(a) => Self::Sqrt(f(a)),
            Self::Powi(a, n) => Self::Powi(f(a), n),
            Self::Function(g, a) => Self::Function(g, f(a)),
            Self::Add(a, b) => Self::Add(f(a), f(b)),
            Self::Sub(a, b) => Self::Sub(f(a), f(b)),
            Self::Mul(a, b) => Self::Mul(f(a), f(b)),
            Self::MulWhole(a, b) => Self::MulWhole(f(a), f(b)),
            Self::Times(k, a) => Self::Times(k, f(a)),
            Self::Div(a, b) => Self::Div(f(a), f(b)),
            Self::Min(a, b) => Self::Min(f(a), f(b)),
            Self::Max(a, b) => Self::Max(f(a), f(b)),
            Self::Pow(a, b) => Self::Pow(f(a), f(b)),
            Self::Atan2(a, b) => Self::Atan2(f(a), f(b)),
            Self::Rem(a, b) => Self::Rem(f(a), f(b)),
            Self::Noise(table, p) => Self::Noise(table, p.map(f)),
            Self::Nearest(which, p) => Self::Nearest(which, p.map(f)),
            Self::Compare(c, a, b) => Self::Compare(c, f(a), f(b)),
            Self::Select(all) => Self::Select(all.map(f)),
            Self::Joined(all) => Self::Joined(all.map(f)),
            Self::Settled(a) => Self::Settled(f(a)),
        }
    }

    /// Calls `f` with each operand.
    pub(crate) fn operands(&self, mut f: impl FnMut(NodeId)) {
        match *self {
            Self::Input(_) | Self::Constant(_) => {}
            Self::Neg(a)
            | Self::Abs(a)
            | Self::Sqr(a)
            | Self::Sqrt(a)
            | Self::Powi(a, _)
            | Self::Times(_, a)
            | Self::Settled(a)
            | Self::Function(_, a) => f(a),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::MulWhole(a, b)
            | Self::Div(a, b)
            | Self::Min(a, b)
            | Self::Max(a, b)
            | Self::Pow(a, b)
            | Self::Atan2(a, b)
            | Self::Rem(a, b)
            | Self::Compare(_, a, b) => {
                f(a);
                f(b);
            }
            Self::Noise(_, p) | Self::Nearest(_, p) | Self::Joined(p) => p.into_iter().for_each(f),
            Self::Select(all) => all.into_iter().for_each(f),
        }
    }

    /// Whether its value is an integer wherever it is defined, and so are the ends of its bounds.
    /// `is_whole` answers that for its operands.
    fn is_whole(&self, is_whole: impl Fn(NodeId) -> bool) -> bool {
        match *self {
            Self::Constant(c) => c.lo == c.hi && c.lo.fract() == 0.0,
            Self::Function(Function::Floor | Function::Ceil | Function::Trunc, _) | Self::Compare(..) => true,
            Self::Neg(a) | Self::Abs(a) => is_whole(a),
            // Where bounds of sums and products are rounded they are beyond 2^53, where all numbers
            // are integers.
            Self::Add(a, b) | Self::Sub(a, b) | Self::MulWhole(a, b) | Self::Min(a, b) | Self::Max(a, b) => {
                is_whole(a) && is_whole(b)
            }
            Self::Select([_, a, b, c]) => is_whole(a) && is_whole(b) && is_whole(c),
            _ => false,
        }
    }

    /// A key for finding equal steps.
    pub(super) fn key(&self) -> (u8, u64, u64, u64) {
        let two = |tag: u8, a: NodeId, b: NodeId| (tag, u64::from(a.0), u64::from(b.0), 0);
        match *self {
            Self::Input(i) => (0, u64::from(i), 0, 0),
            Self::Constant(c) => (1, c.lo.to_bits(), c.hi.to_bits(), 0),
            Self::Neg(a) => (2, u64::from(a.0), 0, 0),
            Self::Abs(a) => (3, u64::from(a.0), 0, 0),
            Self::Sqr(a) => (4, u64::from(a.0), 0, 0),
            Self::Sqrt(a) => (5, u64::from(a.0), 0, 0),
            Self::Powi(a, n) => (6, u64::from(a.0), n as u64, 0),
            Self::Function(f, a) => (7, u64::from(a.0), f as u64, 0),
            Self::Add(a, b) => two(8, a, b),
            Self::Sub(a, b) => two(9, a, b),
            Self::Mul(a, b) => two(10, a, b),
            Self::Div(a, b) => two(11, a, b),
            Self::Min(a, b) => two(12, a, b),
            Self::Max(a, b) => two(13, a, b),
            Self::Pow(a, b) => two(14, a, b),
            Self::Atan2(a, b) => two(15, a, b),
            Self::Rem(a, b) => two(16, a, b),
            Self::Compare(c, a, b) => (17, u64::from(a.0), u64::from(b.0), c as u64),
            Self::Select([a, b, c, d]) => {
                let pack = |a: NodeId, b: NodeId| u64::from(a.0) << 32 | u64::from(b.0);
                (18, pack(a, b), pack(c, d), 0)
            }
            Self::Settled(a) => (19, u64::from(a.0), 0, 0),
            Self::Noise(table, [a, b, c]) => {
                let table = table.map_or(0, |table| core::ptr::from_ref(table).addr() as u64);
                (20, u64::from(a.0) << 32 | u64::from(b.0), u64::from(c.0), table)
            }
            Self::Joined([a, b, c]) => (21, u64::from(a.0), u64::from(b.0), u64::from(c.0)),
            Self::MulWhole(a, b) => two(22, a, b),
            Self::Times(k, a) => (23, k.to_bits(), u64::from(a.0), 0),
            Self::Nearest(which, [a, b, c]) => {
                let which = core::ptr::from_ref(which).addr() as u64;
                (24, u64::from(a.0) << 32 | u64::from(b.0), u64::from(c.0), which)
            }
        }
    }
}

/// Why a [`Formula`] cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormulaError {
    /// It has too many steps.
    #[error("this formula has more than {MOST_STEPS} steps once all functions in it are written out")]
    TooLong,
}

/// A function of a few numbers. Plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    pub(crate) ops: Vec<Op>,
    pub(crate) root: NodeId,
    inputs: u32,
}

impl Formula {
    /// How many numbers it takes.
    pub fn inputs(&self) -> u32 {
        self.inputs
    }

    /// The formula with the noise of a table instead of durer's own.
    #[must_use]
    pub fn with_noise(mut self, table: Option<&'static NoiseTable>) -> Self {
        for op in &mut self.ops {
            if let Op::Noise(of @ None, _) = op {
                *of = table;
            }
        }
        self
    }

    /// Its steps, each of which uses only earlier ones.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// The step whose result is the formula's.
    pub fn root(&self) -> NodeId {
        self.root
    }

    /// Its rounded value; NaN where it is undefined, or if there are too few numbers.
    pub fn value(&self, inputs: &[f64]) -> f64 {
        super::program::value_of(&self.ops, inputs)
    }

    /// The one value of a formula that uses none of its inputs.
    pub fn as_constant(&self) -> Option<Interval> {
        match self.ops[self.root.0 as usize] {
            Op::Constant(c) => Some(c),
            _ => None,
        }
    }
}

/// Builds a [`Formula`]: each new step is folded if it is a constant, and reused if it exists
/// already.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    ops: Vec<Op>,
    /// For each step, whether its value is an integer.
    whole: Vec<bool>,
    known: HashMap<(u8, u64, u64, u64), NodeId>,
}

impl Builder {
    /// A builder without steps.
    pub fn new() -> Self {
        Self::default()
    }

    /// The steps so far.
    pub(super) fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// The input with this number.
    pub fn input(&mut self, number: u32) -> Result<NodeId, FormulaError> {
        self.push(Op::Input(number))
    }

    /// The number `x`, which must be finite.
    pub fn constant(&mut self, x: f64) -> Result<NodeId, FormulaError> {
        // -0 is 0.
        self.push(Op::Constant(Interval { lo: x + 0.0, hi: x + 0.0 }))
    }

    /// A number that is known within an interval, such as pi.
    pub fn enclosed(&mut self, x: Interval) -> Result<NodeId, FormulaError> {
        self.push(Op::Constant(x))
    }

    /// A step; the operands must be this builder's.
    pub fn push(&mut self, op: Op) -> Result<NodeId, FormulaError> {
        if let Op::Times(k, a) = op {
            // Converts it to a product again, which may now be one of integers.
            let k = self.constant(k)?;
            return self.push(Op::Mul(k, a));
        }
        let is_whole = |id: NodeId| self.whole[id.0 as usize];
        let op = match op {
            Op::Mul(a, b) if a != b && is_whole(a) && is_whole(b) => Op::MulWhole(a, b),
            Op::MulWhole(a, b) if !(is_whole(a) && is_whole(b)) => Op::Mul(a, b),
            other => other,
        };
        let op = match fold::simpler(op, |id| self.ops[id.0 as usize]) {
            fold::Simpler::Same(id) => return Ok(id),
            fold::Simpler::Op(op) => op,
        };
        if let Some(&id) = self.known.get(&op.key()) {
            return Ok(id);
        }
        if self.ops.len() >= MOST_STEPS {
            return Err(FormulaError::TooLong);
        }
        let id = NodeId(self.ops.len() as u32);
        self.whole.push(op.is_whole(|id| self.whole[id.0 as usize]));
        self.ops.push(op);
        self.known.insert(op.key(), id);
        Ok(id)
    }

    /// Inserts `formula` with these steps as its inputs; their number must match.
    pub fn call(&mut self, formula: &Formula, arguments: &[NodeId]) -> Result<NodeId, FormulaError> {
        let mut here: Vec<NodeId> = Vec::with_capacity(formula.ops.len());
        for &op in &formula.ops {
            here.push(match op {
                Op::Input(i) => arguments[i as usize],
                op => self.push(op.renamed(|id| here[id.0 as usize]))?,
            });
        }
        Ok(here[formula.root.0 as usize])
    }

    /// The formula of `inputs` numbers with the value of `root`. Steps that do not affect it are
    /// removed.
    pub fn finish(&self, root: NodeId, inputs: u32) -> Formula {
        let (ops, root) = live(&self.ops, root);
        Formula { ops, root, inputs }
    }
}

/// The steps that affect `root`, renumbered.
pub(super) fn live(ops: &[Op], root: NodeId) -> (Vec<Op>, NodeId) {
    let mut used = vec![false; root.0 as usize + 1];
    used[root.0 as usize] = true;
    for i in (0..=root.0 as usize).rev() {
        if used[i] {
            ops[i].operands(|id| used[id.0 as usize] = true);
        }
    }
    let mut names = vec![NodeId(0); used.len()];
    let mut kept = Vec::with_capacity(used.len());
    for (i, &op) in ops[..used.len()].iter().enumerate() {
        if used[i] {
            names[i] = NodeId(kept.len() as u32);
            kept.push(op.renamed(|id| names[id.0 as usize]));
        }
    }
    (kept, names[root.0 as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function that is called with something says what its text says of that: of whole numbers
    /// that products are whole.
    #[test]
    fn calls_are_what_their_text_is() {
        let mut b = Builder::new();
        let (p, three) = (b.input(0).unwrap(), b.constant(3.0).unwrap());
        let product = b.push(Op::Mul(three, p)).unwrap();
        let triple = b.finish(product, 1);
        assert!(matches!(triple.ops(), [Op::Input(0), Op::Times(3.0, _)]), "{triple:?}");
        let arguments: [fn(NodeId) -> Op; 3] =
            [|x| Op::Function(Function::Floor, x), Op::Sqr, |_| Op::Constant(0.5.into())];
        for (argument, is_whole) in arguments.into_iter().zip([true, false, false]) {
            let both = [true, false].map(|is_called| {
                let mut b = Builder::new();
                let (x, three) = (b.input(0).unwrap(), b.constant(3.0).unwrap());
                let a = b.push(argument(x)).unwrap();
                let root = if is_called { b.call(&triple, &[a]) } else { b.push(Op::Mul(three, a)) };
                b.finish(root.unwrap(), 1)
            });
            assert_eq!(both[0], both[1]);
            let last = both[0].ops().last();
            assert_eq!(matches!(last, Some(Op::MulWhole(..))), is_whole, "{last:?}");
        }
    }
}
