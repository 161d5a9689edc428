//! Simpler steps for steps: constants folded, and identities that hold wherever both sides are
//! defined, and are defined on the same points.

use super::formula::{NodeId, Op};
use crate::{Comparison, Function, I8, Number};
use durer_math::Interval;
use durer_math::interval::elementary::{Defined, Range};

/// The result of a step.
pub(super) enum Simpler {
    /// The result of another step.
    Same(NodeId),
    /// A step of its own.
    Op(Op),
}

const fn exactly(x: f64) -> Interval {
    Interval { lo: x, hi: x }
}

/// The step `op`, or a simpler one; `at` returns the step of an operand.
pub(super) fn simpler(op: Op, at: impl Fn(NodeId) -> Op) -> Simpler {
    let constant = |id: NodeId| if let Op::Constant(c) = at(id) { Some(c) } else { None };
    if let Some(c) = folded(&op, &constant) {
        return Simpler::Op(Op::Constant(c));
    }
    let is = |id: NodeId, x: f64| constant(id) == Some(exactly(x));
    let ordered = |a: NodeId, b: NodeId| if a <= b { (a, b) } else { (b, a) };
    match op {
        Op::Add(a, b) if is(b, 0.0) => Simpler::Same(a),
        Op::Add(a, b) if is(a, 0.0) => Simpler::Same(b),
        Op::Sub(a, b) if is(b, 0.0) => Simpler::Same(a),
        Op::Sub(a, b) if is(a, 0.0) => simpler(Op::Neg(b), at),
        Op::Mul(a, b) | Op::MulWhole(a, b) if is(b, 1.0) => Simpler::Same(a),
        Op::Mul(a, b) | Op::MulWhole(a, b) if is(a, 1.0) => Simpler::Same(b),
        Op::Div(a, b) if is(b, 1.0) => Simpler::Same(a),
        Op::Mul(a, b) | Op::MulWhole(a, b) if is(b, -1.0) => simpler(Op::Neg(a), at),
        Op::Mul(a, b) | Op::MulWhole(a, b) if is(a, -1.0) => simpler(Op::Neg(b), at),
        Op::Mul(a, b) if a == b => simpler(Op::Sqr(a), at),
        Op::Min(a, b) | Op::Max(a, b) if a == b => Simpler::Same(a),
        Op::Add(a, b) => {
            let (a, b) = ordered(a, b);
            Simpler::Op(Op::Add(a, b))
        }
        Op::Mul(a, b) => match (factor(constant(a)), factor(constant(b))) {
            (Some(k), _) => Simpler::Op(Op::Times(k, b)),
            (_, Some(k)) => Simpler::Op(Op::Times(k, a)),
            _ => {
                let (a, b) = ordered(a, b);
                Simpler::Op(Op::Mul(a, b))
            }
        },
        Op::MulWhole(a, b) => {
            let (a, b) = ordered(a, b);
            Simpler::Op(Op::MulWhole(a, b))
        }
        Op::Neg(a) => match at(a) {
            Op::Neg(b) => Simpler::Same(b),
            Op::Sub(b, c) => simpler(Op::Sub(c, b), at),
            _ => Simpler::Op(op),
        },
        Op::Sqr(a) => match at(a) {
            Op::Neg(b) | Op::Abs(b) => simpler(Op::Sqr(b), at),
            _ => Simpler::Op(op),
        },
        Op::Abs(a) => match at(a) {
            Op::Neg(b) => simpler(Op::Abs(b), at),
            Op::Abs(_) | Op::Sqr(_) | Op::Sqrt(_) => Simpler::Same(a),
            _ => Simpler::Op(op),
        },
        Op::Select([c, below, at, above]) => match constant(c) {
            Some(Interval { hi, .. }) if hi < 0.0 => Simpler::Same(below),
            Some(Interval { lo, .. }) if lo > 0.0 => Simpler::Same(above),
            Some(Interval { lo, hi }) if (lo, hi) == (0.0, 0.0) => Simpler::Same(at),
            _ => Simpler::Op(op),
        },
        Op::Joined([c, below, above]) => match constant(c) {
            Some(Interval { hi, .. }) if hi < 0.0 => Simpler::Same(below),
            Some(Interval { lo, .. }) if lo >= 0.0 => Simpler::Same(above),
            _ => Simpler::Op(op),
        },
        Op::Powi(a, 1) => Simpler::Same(a),
        Op::Powi(a, 2) => simpler(Op::Sqr(a), at),
        Op::Pow(a, b) => match constant(b) {
            Some(Interval { lo, hi }) if lo == hi && lo == 0.5 => Simpler::Op(Op::Sqrt(a)),
            Some(Interval { lo, hi }) if lo == hi && lo.fract() == 0.0 && lo.abs() <= 4096.0 && lo != 0.0 => {
                simpler(Op::Powi(a, lo as i32), at)
            }
            _ => Simpler::Op(op),
        },
        _ => Simpler::Op(op),
    }
}

/// A constant that is exactly a number other than zero.
fn factor(constant: Option<Interval>) -> Option<f64> {
    constant.and_then(|Interval { lo, hi }| (lo == hi && lo.is_finite() && lo != 0.0).then_some(lo))
}

/// The value of a step whose operands are constants, where it is defined and finite.
fn folded(op: &Op, constant: &impl Fn(NodeId) -> Option<Interval>) -> Option<Interval> {
    let sure = |(x, d): Range| (d == Defined::Continuous).then_some(x);
    let value = match *op {
        Op::Input(_) | Op::Constant(_) | Op::Settled(_) | Op::Select(_) | Op::Joined(_) => return None,
        Op::Neg(a) => -constant(a)?,
        Op::Abs(a) => constant(a)?.abs(),
        Op::Sqr(a) => constant(a)?.square(),
        Op::Sqrt(a) => {
            let a = constant(a)?;
            if a.lo < 0.0 {
                return None;
            }
            a.sqrt()
        }
        Op::Powi(a, n) => sure(constant(a)?.powi(n))?,
        Op::Function(f, a) => function(f, constant(a)?)?,
        Op::Add(a, b) => constant(a)? + constant(b)?,
        Op::Sub(a, b) => constant(a)? - constant(b)?,
        Op::Mul(a, b) | Op::MulWhole(a, b) => constant(a)? * constant(b)?,
        Op::Times(k, a) => exactly(k) * constant(a)?,
        Op::Div(a, b) => {
            let (a, b) = (constant(a)?, constant(b)?);
            if b.contains(0.0) {
                return None;
            }
            a / b
        }
        Op::Min(a, b) => constant(a)?.min(constant(b)?),
        Op::Max(a, b) => constant(a)?.max(constant(b)?),
        Op::Pow(a, b) => sure(constant(a)?.pow(constant(b)?))?,
        Op::Atan2(a, b) => sure(constant(a)?.atan2(constant(b)?))?,
        Op::Rem(a, b) => sure(constant(a)?.remainder(constant(b)?))?,
        Op::Noise(table, [a, b, c]) => {
            let p = [constant(a)?, constant(b)?, constant(c)?].map(I8::splat);
            I8::noise(table, p.each_ref()).lane(0)
        }
        Op::Nearest(which, [a, b, c]) => which.bounds([constant(a)?, constant(b)?, constant(c)?]),
        Op::Compare(c, a, b) => {
            let (a, b) = (constant(a)?, constant(b)?);
            let exact = a.lo == a.hi && b.lo == b.hi;
            if !exact {
                return None;
            }
            exactly(f64::from(u8::from(Comparison::holds(c, a.lo, b.lo))))
        }
    };
    (value.lo.is_finite() && value.hi.is_finite()).then_some(value)
}

fn function(f: Function, x: Interval) -> Option<Interval> {
    let (value, defined) = match f {
        Function::Sin => (x.sin(), Defined::Continuous),
        Function::Cos => (x.cos(), Defined::Continuous),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => (x.atan(), Defined::Continuous),
        Function::Sinh => (x.sinh(), Defined::Continuous),
        Function::Cosh => (x.cosh(), Defined::Continuous),
        Function::Tanh => (x.tanh(), Defined::Continuous),
        Function::Asinh => (x.asinh(), Defined::Continuous),
        Function::Acosh => x.acosh(),
        Function::Atanh => x.atanh(),
        Function::Exp => (x.exp(), Defined::Continuous),
        Function::Ln => x.ln(),
        Function::Log10 => x.log10(),
        Function::Floor => x.floor(),
        Function::Ceil => x.ceil(),
        Function::Trunc => x.trunc(),
    };
    (defined == Defined::Continuous).then_some(value)
}
