//! Three formulas of two parameters as one tape: a map from a plane into space.

use super::formula::{Builder, Formula, FormulaError, NodeId, Op};
use super::program::run_with;
use crate::{Dual, Gradient, I8, Number};
use durer_math::{F8, Interval, Isa};
use std::cell::Cell;
use std::sync::Arc;
use std::thread::LocalKey;

/// A value and its slopes along both parameters. A [`Gradient`] has room for a third, which stays
/// zero.
pub(crate) type Jet<T> = Dual<T, Gradient<T>>;

/// The steps of three formulas of `u` and `v`, each step once; shared by all who use them.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorTape {
    ops: Arc<[Op]>,
    outputs: [NodeId; 3],
}

/// Memory of a thread for a run of a tape.
type Registers<T> = LocalKey<Cell<Vec<T>>>;

thread_local! {
    static BOXES: Cell<Vec<I8>> = const { Cell::new(Vec::new()) };
    static JETS: Cell<Vec<Jet<I8>>> = const { Cell::new(Vec::new()) };
    static NUMBERS: Cell<Vec<Jet<f64>>> = const { Cell::new(Vec::new()) };
}

impl VectorTape {
    /// The tape of the formulas of `x`, `y` and `z`, each of which takes two numbers.
    ///
    /// # Panics
    ///
    /// If one takes more than two.
    pub fn new(formulas: [&Formula; 3]) -> Result<Self, FormulaError> {
        assert!(formulas.iter().all(|f| f.inputs() <= 2), "these are functions of u and v");
        let mut builder = Builder::new();
        let inputs = [builder.input(0)?, builder.input(1)?];
        let mut roots = [inputs[0]; 3];
        for (root, formula) in roots.iter_mut().zip(formulas) {
            *root = builder.call(formula, &inputs)?;
        }
        Ok(Self::of(&builder, roots))
    }

    /// The tape of three steps of a builder, whose inputs are `u` and `v`.
    pub fn of(builder: &Builder, roots: [NodeId; 3]) -> Self {
        let ops = builder.ops();
        let mut used = vec![false; ops.len()];
        for root in roots {
            used[root.0 as usize] = true;
        }
        for i in (0..ops.len()).rev() {
            if used[i] {
                ops[i].operands(|id| used[id.0 as usize] = true);
            }
        }
        let mut names = vec![NodeId(0); ops.len()];
        let mut kept = Vec::new();
        for (i, &op) in ops.iter().enumerate().filter(|(i, _)| used[*i]) {
            names[i] = match op {
                // A promise about a level set, which has no meaning here.
                Op::Settled(a) => names[a.0 as usize],
                op => {
                    kept.push(op.renamed(|id| names[id.0 as usize]));
                    NodeId(kept.len() as u32 - 1)
                }
            };
        }
        Self { ops: kept.into(), outputs: roots.map(|root| names[root.0 as usize]) }
    }

    /// Writes the steps of the tape down again, for inputs that are steps of the builder.
    pub fn written(&self, builder: &mut Builder, inputs: [NodeId; 2]) -> Result<[NodeId; 3], FormulaError> {
        let mut here: Vec<NodeId> = Vec::with_capacity(self.ops.len());
        for &op in &*self.ops {
            here.push(match op {
                Op::Input(i) => inputs[i as usize],
                op => builder.push(op.renamed(|id| here[id.0 as usize]))?,
            });
        }
        Ok(self.outputs.map(|id| here[id.0 as usize]))
    }

    /// Bounds of the values on eight boxes.
    pub fn bounds(&self, x: &[I8; 2]) -> [I8; 3] {
        self.run(x, &BOXES)
    }

    /// Bounds of the values on eight boxes, and of the slopes there.
    pub fn jets(&self, x: &[I8; 2]) -> [Jet<I8>; 3] {
        let [u, v] = *x;
        self.run(&[(u, 0), (v, 1)].map(|(v, axis)| Dual { v, d: Gradient::of_axis(axis) }), &JETS)
    }

    /// The rounded values and slopes at a point; NaN where they are undefined.
    pub fn jet(&self, [u, v]: [f64; 2]) -> [Jet<f64>; 3] {
        self.run(&[(u, 0), (v, 1)].map(|(v, axis)| Dual { v, d: Gradient::of_axis(axis) }), &NUMBERS)
    }

    #[inline(always)]
    fn run<T: Number>(&self, x: &[T; 2], memory: &'static Registers<T>) -> [T; 3] {
        let mut registers = memory.take();
        if registers.len() < self.ops.len() {
            registers.resize(self.ops.len(), T::constant(Interval { lo: 0.0, hi: 0.0 }));
        }
        let values = &mut registers[..self.ops.len()];
        Isa::detect().run_in_lanes(
            #[inline(always)]
            || {
                run_with(
                    &self.ops,
                    x,
                    values,
                    #[inline(always)]
                    |_, _, _| {},
                )
            },
        );
        let out = self.outputs.map(|id| values[id.0 as usize]);
        memory.set(registers);
        out
    }
}

/// Eight boxes of parameters, or eight points.
pub fn lanes(boxes: &[[[f64; 2]; 2]; 8]) -> [I8; 2] {
    [0, 1].map(|k| {
        let end = |e: usize| F8(boxes.map(|b| b[k][e]));
        I8::new(end(0), end(1))
    })
}
