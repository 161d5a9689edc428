//! A formula of three coordinates, ready to run.

use super::fold;
use super::formula::{Formula, NodeId, Op, live};
use super::jumps;
use super::powers::Powers;
use crate::{Dual, Gradient, I8, Number, Sloped};
use durer_math::{F8, Interval, Isa, Point3, Vec3};
use std::cell::Cell;
use std::sync::Arc;
use std::thread::LocalKey;

/// The steps of a formula of `x`, `y` and `z`; shared by all who use them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    ops: Arc<[Op]>,
}

/// A thread's memory for evaluating tapes.
type Registers<T> = LocalKey<Cell<Vec<T>>>;

thread_local! {
    static DUALS: Cell<Vec<Dual<I8>>> = const { Cell::new(Vec::new()) };
    static GRADIENTS: Cell<Vec<Dual<I8, Gradient<I8>>>> = const { Cell::new(Vec::new()) };
    static SLANTS: Cell<Vec<Dual<F8, Gradient<F8>>>> = const { Cell::new(Vec::new()) };
    static BOXES: Cell<Vec<I8>> = const { Cell::new(Vec::new()) };
    static LANES: Cell<Vec<F8>> = const { Cell::new(Vec::new()) };
    static POWERS: Cell<Vec<Powers>> = const { Cell::new(Vec::new()) };
    static NUMBERS: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
}

/// Runs `f` with this thread's reusable memory.
#[inline(always)]
fn with_memory<T: Copy, R>(
    memory: &'static Registers<T>,
    len: usize,
    zero: T,
    f: impl FnOnce(&mut [T]) -> R,
) -> R {
    let mut registers = memory.take();
    if registers.len() < len {
        registers.resize(len, zero);
    }
    let result = f(&mut registers[..len]);
    memory.set(registers);
    result
}

/// Evaluates the steps in order. The result is that of the last one.
#[inline(always)]
fn run<T: Number>(ops: &[Op], inputs: &[T], registers: &mut [T]) -> T {
    run_with(
        ops,
        inputs,
        registers,
        #[inline(always)]
        |_, _, _| {},
    )
}

/// [`run`], with a function that receives each step, the values before it, and its value, and may
/// change that. Values are written in place, which saves a copy.
#[inline(always)]
pub(super) fn run_with<T: Number>(
    ops: &[Op],
    inputs: &[T],
    registers: &mut [T],
    mut amend: impl FnMut(&Op, &[T], &mut T),
) -> T {
    for (i, op) in ops.iter().enumerate() {
        let (before, rest) = registers.split_at_mut(i);
        let at = |id: NodeId| &before[id.0 as usize];
        let value = &mut rest[0];
        match *op {
            Op::Input(i) => *value = inputs[i as usize],
            Op::Constant(c) => *value = T::constant(c),
            Op::Neg(a) => *value = T::neg(at(a)),
            Op::Abs(a) => *value = T::abs(at(a)),
            Op::Sqr(a) => *value = T::sqr(at(a)),
            Op::Sqrt(a) => *value = T::sqrt(at(a)),
            Op::Powi(a, n) => *value = T::powi(at(a), n),
            Op::Function(f, a) => *value = T::function(f, at(a)),
            Op::Add(a, b) => *value = T::add(at(a), at(b)),
            Op::Sub(a, b) => *value = T::sub(at(a), at(b)),
            Op::Mul(a, b) => *value = T::mul(at(a), at(b)),
            Op::Times(k, a) => *value = T::times(k, at(a)),
            Op::MulWhole(a, b) => *value = T::mul_whole(at(a), at(b)),
            Op::Div(a, b) => *value = T::div(at(a), at(b)),
            Op::Min(a, b) => *value = T::min(at(a), at(b)),
            Op::Max(a, b) => *value = T::max(at(a), at(b)),
            Op::Pow(a, b) => *value = T::pow(at(a), at(b)),
            Op::Atan2(a, b) => *value = T::atan2(at(a), at(b)),
            Op::Rem(a, b) => *value = T::rem(at(a), at(b)),
            Op::Noise(table, [a, b, c]) => *value = T::noise(table, [at(a), at(b), at(c)]),
            Op::Nearest(which, [a, b, c]) => *value = T::nearest(*which, [at(a), at(b), at(c)]),
            Op::Compare(c, a, b) => *value = T::compare(c, at(a), at(b)),
            Op::Select([c, x, y, z]) => *value = T::select(at(c), at(x), at(y), at(z)),
            Op::Joined([c, x, y]) => *value = T::joined(at(c), at(x), at(y)),
            Op::Settled(a) => match T::above(at(a)) {
                Some(above) => return above,
                None => *value = *at(a),
            },
        }
        amend(op, before, value);
    }
    registers[ops.len() - 1]
}

fn zero<T: Number>() -> T {
    T::constant(Interval { lo: 0.0, hi: 0.0 })
}

/// The value of the last of these steps.
pub(super) fn value_of(ops: &[Op], inputs: &[f64]) -> f64 {
    let needed = ops.iter().map(|op| if let Op::Input(i) = op { *i as usize + 1 } else { 0 }).max();
    if needed.is_none_or(|needed| needed > inputs.len()) {
        return f64::NAN;
    }
    run(ops, inputs, &mut vec![0.0; ops.len()])
}

impl Tape {
    /// The tape of a formula of three numbers.
    ///
    /// # Panics
    ///
    /// If the formula takes more than three.
    pub fn new(formula: &Formula) -> Self {
        assert!(formula.inputs() <= 3, "a tape is a function of x, y and z");
        let (ops, root) = live(&formula.ops, formula.root);
        debug_assert_eq!(root.0 as usize + 1, ops.len());
        Self { ops: ops.into() }
    }

    /// How many steps it has.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// A tape always has a step.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// A hash: equal tapes have equal numbers, and others hardly ever.
    pub fn fingerprint(&self) -> u64 {
        // Callers compare the steps of tapes with equal numbers, so the multiplication of rustc's
        // hash suffices.
        self.ops.iter().fold(0, |hash, op| {
            let (tag, a, b, c) = op.key();
            [u64::from(tag), a, b, c].into_iter().fold(hash, |hash: u64, word| {
                (hash.rotate_left(5) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95)
            })
        })
    }

    /// The rounded value at a point; NaN where the formula is undefined.
    pub fn value(&self, p: Point3) -> f64 {
        with_memory(&NUMBERS, self.ops.len(), 0.0, |registers| {
            Isa::detect().run(
                #[inline(always)]
                || run(&self.ops, &p.to_array(), registers),
            )
        })
    }

    /// The rounded values at eight points; NaN where the formula is undefined.
    pub fn values(&self, p: &[F8; 3]) -> F8 {
        with_memory(&LANES, self.ops.len(), F8::ZERO, |registers| {
            Isa::detect().run_in_lanes(
                #[inline(always)]
                || run(&self.ops, p, registers),
            )
        })
    }

    /// Bounds of the values on eight boxes.
    pub fn bounds(&self, x: &[I8; 3]) -> I8 {
        with_memory(&BOXES, self.ops.len(), zero(), |registers| self.bounds_with(x, registers))
    }

    fn bounds_with(&self, x: &[I8; 3], registers: &mut [I8]) -> I8 {
        Isa::detect().run_in_lanes(
            #[inline(always)]
            || run(&self.ops, x, registers),
        )
    }

    /// The sign on a box, which is the same in all lanes, if it is certain on both sides of all
    /// jumps there; positive is `true`.
    pub fn sign_beside_jumps(&self, x: &[I8; 3]) -> Option<bool> {
        with_memory(&BOXES, self.ops.len(), zero(), |registers| {
            Isa::detect().run_in_lanes(
                #[inline(always)]
                || jumps::sign_beside(&self.ops, x, registers),
            )
        })
    }

    /// A normal, of either orientation, of the wall where the formula jumps within `r` of `p`, per
    /// axis: the gradient of the value that selects the side. `None` if nothing jumps.
    pub fn wall(&self, p: Point3, r: f64) -> Option<Vec3> {
        with_memory(&DUALS, self.ops.len(), zero(), |registers| {
            Isa::detect().run_in_lanes(
                #[inline(always)]
                || jumps::wall(&self.ops, p, r, registers),
            )
        })
    }

    /// Bounds of the values on eight boxes, and of the derivatives that follow from the inputs'
    /// derivatives.
    pub fn slopes(&self, x: &[Dual<I8>; 3]) -> Dual<I8> {
        with_memory(&DUALS, self.ops.len(), zero(), |registers| {
            Isa::detect().run_in_lanes(
                #[inline(always)]
                || run(&self.ops, x, registers),
            )
        })
    }

    /// Bounds of the values on eight boxes and of the gradients there.
    pub fn gradients(&self, x: &[I8; 3]) -> Dual<I8, Gradient<I8>> {
        self.gradients_with(x, &GRADIENTS)
    }

    /// The rounded values and gradients at eight points; NaN where they are undefined.
    pub fn slants(&self, p: &[F8; 3]) -> Dual<F8, Gradient<F8>> {
        self.gradients_with(p, &SLANTS)
    }

    #[inline(always)]
    fn gradients_with<T: Sloped>(
        &self,
        x: &[T; 3],
        memory: &'static Registers<Dual<T, Gradient<T>>>,
    ) -> Dual<T, Gradient<T>> {
        with_memory(memory, self.ops.len(), zero(), |registers| {
            Isa::detect().run_in_lanes(
                #[inline(always)]
                || {
                    let [x, y, z] = *x;
                    let inputs = [(x, 0), (y, 1), (z, 2)];
                    run(&self.ops, &inputs.map(|(v, i)| Dual { v, d: Gradient::of_axis(i) }), registers)
                },
            )
        })
    }

    /// The polynomial that results from these coordinates.
    pub fn along(&self, x: &[Powers; 3]) -> Powers {
        with_memory(&POWERS, self.ops.len(), zero(), |registers| {
            Isa::detect().run(
                #[inline(always)]
                || run(&self.ops, x, registers),
            )
        })
    }

    /// The value in any kind of number.
    pub fn eval<T: Number>(&self, x: &[T; 3]) -> T {
        let mut registers = vec![zero(); self.ops.len()];
        run(&self.ops, x, &mut registers)
    }

    /// Bounds on eight boxes, and for each box that `wanted` names a shorter tape with the same
    /// exact values there, if there is one. `wanted` must not name boxes on which the formula is
    /// positive: there it may not be fully evaluated.
    pub fn shortened(&self, x: &[I8; 3], wanted: impl Fn(usize, &I8) -> bool) -> (I8, [Option<Self>; 8]) {
        with_memory(&BOXES, self.ops.len(), zero(), |registers| {
            let bounds = self.bounds_with(x, registers);
            let shorter = core::array::from_fn(|lane| {
                if wanted(lane, &bounds) { self.shorter(registers, lane) } else { None }
            });
            (bounds, shorter)
        })
    }

    /// Bounds on eight boxes, as in [`Tape::shortened`]. For each box that `wanted` names and that
    /// decides a step, `take` receives the decisions as words, which determine the shorter tape,
    /// and a function that builds it.
    pub fn decided_on(
        &self,
        x: &[I8; 3],
        wanted: impl Fn(usize, &I8) -> bool,
        mut take: impl FnMut(usize, &[u64], &dyn Fn() -> Option<Self>),
    ) -> I8 {
        with_memory(&BOXES, self.ops.len(), zero(), |registers| {
            let bounds = self.bounds_with(x, registers);
            let mut words = Vec::new();
            for lane in (0..8).filter(|&lane| wanted(lane, &bounds)) {
                words.clear();
                for (step, op) in (0_u64..).zip(self.ops.iter()).filter(|(_, op)| is_decidable(op)) {
                    match decided(op, registers, lane) {
                        Some(Decided::Same(id)) => words.extend([step, u64::from(id.0)]),
                        Some(Decided::Op(op)) => {
                            let (tag, a, b, c) = op.key();
                            words.extend([step, 1 << 32 | u64::from(tag), a, b, c]);
                        }
                        None => {}
                    }
                }
                if !words.is_empty() {
                    take(lane, &words, &|| self.shorter(registers, lane));
                }
            }
            bounds
        })
    }

    /// The tape with the decisions of one lane's box applied.
    fn shorter(&self, registers: &[I8], lane: usize) -> Option<Self> {
        // Mostly no step is decided.
        let first =
            self.ops.iter().position(|op| is_decidable(op) && decided(op, registers, lane).is_some())?;
        let (before, rest) = self.ops.split_at(first);
        let mut names: Vec<NodeId> = (0..first as u32).map(NodeId).collect();
        let mut ops = before.to_vec();
        for op in rest {
            let kept = match decided(op, registers, lane) {
                Some(Decided::Same(id)) => {
                    names.push(names[id.0 as usize]);
                    continue;
                }
                Some(Decided::Op(op)) => op,
                None => *op,
            };
            // Decisions may turn later steps into constants: a term of a sum that is zero here
            // disappears.
            match fold::simpler(kept.renamed(|id| names[id.0 as usize]), |id| ops[id.0 as usize]) {
                fold::Simpler::Same(id) => names.push(id),
                fold::Simpler::Op(op) => {
                    names.push(NodeId(ops.len() as u32));
                    ops.push(op);
                }
            }
        }
        let (ops, _) = live(&ops, *names.last()?);
        Some(Self { ops: ops.into() })
    }
}

/// The result of a step on a box.
enum Decided {
    Same(NodeId),
    Op(Op),
}

/// Whether a box may decide a step.
fn is_decidable(op: &Op) -> bool {
    use crate::Function::{Ceil, Floor, Trunc};
    match op {
        Op::Min(..) | Op::Max(..) | Op::Abs(_) | Op::Select(_) | Op::Joined(_) | Op::Compare(..) => true,
        Op::Function(f, _) => matches!(f, Floor | Ceil | Trunc),
        _ => false,
    }
}

fn decided(op: &Op, registers: &[I8], lane: usize) -> Option<Decided> {
    let bit = 1_u8 << lane;
    let at = |id: NodeId| {
        let r = &registers[id.0 as usize];
        // Where an operand may be undefined, so may the step, so it is not decided.
        (r.partial & bit == 0).then(|| r.lane(lane))
    };
    let constant = |x: f64| Decided::Op(Op::Constant(Interval { lo: x, hi: x }));
    Some(match *op {
        Op::Min(a, b) | Op::Max(a, b) => {
            let (x, y) = (at(a)?, at(b)?);
            let least = matches!(op, Op::Min(..));
            if x.hi <= y.lo {
                Decided::Same(if least { a } else { b })
            } else if y.hi <= x.lo {
                Decided::Same(if least { b } else { a })
            } else {
                return None;
            }
        }
        Op::Abs(a) => {
            let x = at(a)?;
            if x.lo >= 0.0 {
                Decided::Same(a)
            } else if x.hi <= 0.0 {
                Decided::Op(Op::Neg(a))
            } else {
                return None;
            }
        }
        Op::Select([c, below, zero, above]) => {
            let c = at(c)?;
            if c.hi < 0.0 || c.hi <= 0.0 && zero == below {
                Decided::Same(below)
            } else if c.lo > 0.0 || c.lo >= 0.0 && zero == above {
                Decided::Same(above)
            } else if c.lo == 0.0 && c.hi == 0.0 {
                Decided::Same(zero)
            } else {
                return None;
            }
        }
        Op::Joined([c, below, above]) => {
            let c = at(c)?;
            if c.hi <= 0.0 {
                Decided::Same(below)
            } else if c.lo >= 0.0 {
                Decided::Same(above)
            } else {
                return None;
            }
        }
        Op::Compare(_, a, b) => {
            at(a).and(at(b))?;
            let answer = answer(op, registers, lane)?;
            constant(answer)
        }
        Op::Function(f, a) => {
            let x = at(a)?;
            let (range, defined) = match f {
                crate::Function::Floor => x.floor(),
                crate::Function::Ceil => x.ceil(),
                crate::Function::Trunc => x.trunc(),
                _ => return None,
            };
            if defined != durer_math::interval::elementary::Defined::Continuous {
                return None;
            }
            constant(range.lo)
        }
        _ => return None,
    })
}

/// The certain answer of a comparison.
fn answer(op: &Op, registers: &[I8], lane: usize) -> Option<f64> {
    let Op::Compare(c, a, b) = *op else { return None };
    let said = I8::compare(c, &registers[a.0 as usize], &registers[b.0 as usize]).lane(lane);
    (said.lo == said.hi).then_some(said.lo)
}
