//! A parser for formulas as they are written on paper; it makes the steps that surfaces evaluate.
//!
//! ```text
//!   name = sum; name = sum; ... sum
//! ```

use durer_formula::Function;
use durer_formula::{Builder, Formula, NodeId, Op};
use std::f64::consts::PI;

/// Reads one of the table's formulas. These are correct, so no error messages are needed.
pub(super) struct Pen {
    builder: Builder,
    rest: &'static str,
    /// The names defined so far.
    names: Vec<(&'static str, NodeId)>,
}

impl Pen {
    pub(super) fn new(text: &'static str) -> Self {
        Self { builder: Builder::new(), rest: text, names: Vec::new() }
    }

    /// The formula with this root, if all of the text was read.
    pub(super) fn finished(&self, root: NodeId, inputs: u32) -> Option<Formula> {
        self.rest.is_empty().then(|| self.builder.finish(root, inputs))
    }

    /// The parameter with this number.
    pub(super) fn parameter(&mut self, number: u32) -> Option<NodeId> {
        self.builder.input(3 + number).ok()
    }

    pub(super) fn constant(&mut self, value: f64) -> Option<NodeId> {
        self.builder.constant(value).ok()
    }

    pub(super) fn push(&mut self, op: Op) -> Option<NodeId> {
        self.builder.push(op).ok()
    }

    /// `name = sum; ... sum`.
    pub(super) fn formula(&mut self) -> Option<NodeId> {
        while let Some((name, rest)) = self.rest.split_once('=') {
            self.rest = rest;
            let value = self.sum()?;
            self.take(';').then_some(())?;
            self.names.push((name.trim(), value));
        }
        self.sum()
    }

    fn take(&mut self, mark: char) -> bool {
        self.rest = self.rest.trim_start();
        let after = self.rest.strip_prefix(mark);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn sum(&mut self) -> Option<NodeId> {
        let mut left = self.product()?;
        loop {
            if self.take('+') {
                let right = self.product()?;
                left = self.push(Op::Add(left, right))?;
            } else if self.take('-') {
                let right = self.product()?;
                left = self.push(Op::Sub(left, right))?;
            } else {
                return Some(left);
            }
        }
    }

    fn product(&mut self) -> Option<NodeId> {
        let mut left = self.operand()?;
        loop {
            if self.take('*') {
                let right = self.operand()?;
                left = self.push(Op::Mul(left, right))?;
            } else if self.take('/') {
                let right = self.operand()?;
                left = self.push(Op::Div(left, right))?;
            } else {
                return Some(left);
            }
        }
    }

    fn operand(&mut self) -> Option<NodeId> {
        if self.take('-') {
            // The minus applies to the operand before the product. -P3*a as -(P3*a) is the same
            // number.
            let value = self.operand()?;
            return self.push(Op::Neg(value));
        }
        if self.take('(') {
            let value = self.sum()?;
            return self.take(')').then_some(value);
        }
        self.rest = self.rest.trim_start();
        let len =
            self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(len);
        self.rest = rest;
        if let Ok(number) = word.parse() {
            return self.constant(number);
        }
        if let Some(number) = word.strip_prefix('P') {
            return self.parameter(number.parse().ok()?);
        }
        if let Some(axis) = ["x", "y", "z"].iter().position(|&name| name == word) {
            return self.builder.input(axis as u32).ok();
        }
        if word == "pi" {
            return self.constant(PI);
        }
        if let Some(&(_, value)) = self.names.iter().rfind(|(name, _)| *name == word) {
            return Some(value);
        }
        self.take('(').then_some(())?;
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        self.take(')').then_some(())?;
        self.call(word, &arguments)
    }

    fn call(&mut self, word: &str, arguments: &[NodeId]) -> Option<NodeId> {
        match (word, arguments) {
            ("sq", &[a]) => self.push(Op::Sqr(a)),
            ("cube", &[a]) => self.push(Op::Powi(a, 3)),
            ("sqrt", &[a]) => self.push(Op::Sqrt(a)),
            ("abs", &[a]) => self.push(Op::Abs(a)),
            ("floor", &[a]) => self.push(Op::Function(Function::Floor, a)),
            ("sin", &[a]) => self.push(Op::Function(Function::Sin, a)),
            ("cos", &[a]) => self.push(Op::Function(Function::Cos, a)),
            ("exp", &[a]) => self.push(Op::Function(Function::Exp, a)),
            ("min", &[a, ref others @ ..]) => others.iter().try_fold(a, |a, &b| self.push(Op::Min(a, b))),
            ("max", &[a, ref others @ ..]) => others.iter().try_fold(a, |a, &b| self.push(Op::Max(a, b))),
            ("pow", &[a, b]) => self.push(Op::Pow(a, b)),
            ("rem", &[a, b]) => self.push(Op::Rem(a, b)),
            ("atan2", &[a, b]) => self.push(Op::Atan2(a, b)),
            ("noise", &[x, y, z]) => self.push(Op::Noise(None, [x, y, z])),
            ("select", &[c, below, at, above]) => self.push(Op::Select([c, below, at, above])),
            ("u" | "v", &[switch, offset, angle]) => self.revolved(word == "u", [switch, offset, angle]),
            ("section", &[a, b, kind]) => self.section([a, b], kind),
            _ => None,
        }
    }

    /// A coordinate of a plane curve, which is revolved if the switch is above zero.
    fn revolved(&mut self, first: bool, [switch, offset, angle]: [NodeId; 3]) -> Option<NodeId> {
        let axis = [0, 1, 2].map(|axis| self.builder.input(axis).ok());
        let [x, y, z] = [axis[0]?, axis[1]?, axis[2]?];
        let squares = (self.push(Op::Sqr(x))?, self.push(Op::Sqr(z))?);
        let square = self.push(Op::Add(squares.0, squares.1))?;
        let radius = self.push(Op::Sqrt(square))?;
        let away = self.push(Op::Sub(radius, offset))?;
        let degree = self.constant(PI / 180.0)?;
        let angle = self.push(Op::Mul(angle, degree))?;
        let (cos, sin) =
            (self.push(Op::Function(Function::Cos, angle))?, self.push(Op::Function(Function::Sin, angle))?);
        let (straight, turned) = if first {
            let (a, b) = (self.push(Op::Mul(cos, away))?, self.push(Op::Mul(sin, y))?);
            (x, self.push(Op::Sub(a, b))?)
        } else {
            let (a, b) = (self.push(Op::Mul(sin, away))?, self.push(Op::Mul(cos, y))?);
            (y, self.push(Op::Add(a, b))?)
        };
        self.push(Op::Select([switch, straight, straight, turned]))
    }

    /// `(|a|^(2/k) + |b|^(2/k))^(k/2)`, and the larger one for `k = 0`.
    fn section(&mut self, [a, b]: [NodeId; 2], kind: NodeId) -> Option<NodeId> {
        let (a, b) = (self.push(Op::Abs(a))?, self.push(Op::Abs(b))?);
        let two = self.constant(2.0)?;
        let exponent = self.push(Op::Div(two, kind))?;
        let powers = (self.push(Op::Pow(a, exponent))?, self.push(Op::Pow(b, exponent))?);
        let sum = self.push(Op::Add(powers.0, powers.1))?;
        let root = self.push(Op::Div(kind, two))?;
        let round = self.push(Op::Pow(sum, root))?;
        let square = self.push(Op::Max(a, b))?;
        self.push(Op::Select([kind, round, square, round]))
    }
}
