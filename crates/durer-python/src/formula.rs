//! Functions of x, y and z, or of u and v, from a list of steps: what Python's side traces from a text or a callable.

use crate::value_error;
use durer::formula::{Builder, Comparison, Formula, Function, NodeId, Op};
use durer::math::Interval;
use pyo3::prelude::*;

/// The name of a step, the numbers of earlier steps that it uses, and its constant if it has one.
pub(crate) type Step = (String, Vec<usize>, f64);

fn function(name: &str) -> Option<Function> {
    Some(match name {
        "sin" => Function::Sin,
        "cos" => Function::Cos,
        "tan" => Function::Tan,
        "asin" => Function::Asin,
        "acos" => Function::Acos,
        "atan" => Function::Atan,
        "sinh" => Function::Sinh,
        "cosh" => Function::Cosh,
        "tanh" => Function::Tanh,
        "asinh" => Function::Asinh,
        "acosh" => Function::Acosh,
        "atanh" => Function::Atanh,
        "exp" => Function::Exp,
        "log" => Function::Ln,
        "log10" => Function::Log10,
        "floor" => Function::Floor,
        "ceil" => Function::Ceil,
        "trunc" => Function::Trunc,
        _ => return None,
    })
}

/// The formula of this many numbers whose value is that of the last step.
pub(crate) fn build(steps: &[Step], inputs: u32) -> PyResult<Formula> {
    let mut builder = Builder::new();
    let mut nodes: Vec<NodeId> = Vec::with_capacity(steps.len());
    for (name, operands, number) in steps {
        let bad = || value_error(format!("formula: a bad step '{name}'"));
        let operand = |i: usize| operands.get(i).and_then(|&k| nodes.get(k).copied()).ok_or_else(bad);
        let node = match &**name {
            "input" if *number < f64::from(inputs) => builder.input(*number as u32),
            "constant" => builder.enclosed(Interval { lo: *number, hi: *number }),
            "neg" => builder.push(Op::Neg(operand(0)?)),
            "abs" => builder.push(Op::Abs(operand(0)?)),
            "sqr" => builder.push(Op::Sqr(operand(0)?)),
            "sqrt" => builder.push(Op::Sqrt(operand(0)?)),
            "powi" => builder.push(Op::Powi(operand(0)?, *number as i32)),
            "add" => builder.push(Op::Add(operand(0)?, operand(1)?)),
            "sub" => builder.push(Op::Sub(operand(0)?, operand(1)?)),
            "mul" => builder.push(Op::Mul(operand(0)?, operand(1)?)),
            "div" => builder.push(Op::Div(operand(0)?, operand(1)?)),
            "min" => builder.push(Op::Min(operand(0)?, operand(1)?)),
            "max" => builder.push(Op::Max(operand(0)?, operand(1)?)),
            "pow" => builder.push(Op::Pow(operand(0)?, operand(1)?)),
            "atan2" => builder.push(Op::Atan2(operand(0)?, operand(1)?)),
            "rem" => builder.push(Op::Rem(operand(0)?, operand(1)?)),
            "less" => builder.push(Op::Compare(Comparison::Less, operand(0)?, operand(1)?)),
            "less_equal" => builder.push(Op::Compare(Comparison::LessEqual, operand(0)?, operand(1)?)),
            "select" => builder.push(Op::Select([operand(0)?, operand(1)?, operand(2)?, operand(3)?])),
            other => builder.push(Op::Function(function(other).ok_or_else(bad)?, operand(0)?)),
        };
        nodes.push(node.map_err(value_error)?);
    }
    let root = *nodes.last().ok_or_else(|| value_error("formula: it has no steps"))?;
    Ok(builder.finish(root, inputs))
}
