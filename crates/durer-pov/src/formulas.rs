//! The functions that functions.inc names, by the numbers it uses.
//!
//! Each is written as on paper; `P0`, `P1`, ... are the parameters behind `x`, `y`, `z`. They were found from the manual's descriptions, the surfaces' known
//! equations and POV-Ray's values (`tests/formulas.rs` holds some of those), and agree with it to 1e-9 (the rounded box to 1e-6, by
//! which POV-Ray's is larger than its description). Functions with a *field strength* are
//! kept between -10 and 10, as POV-Ray does.

use durer_math::Function;
use durer_scene::tape::{Builder, Formula, FormulaError, NodeId, Op};

/// Why a number has no formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lacking {
    /// No function has it.
    Unknown,
    /// Its function has no formula here, for this reason.
    NotYet(&'static str),
}

/// A function's number, how many parameters it has behind `x`, `y`, `z`, whether it is a field times its strength, and its formula.
type Row = (u32, u32, bool, &'static str);

const TABLE: &[Row] = &[
    (4, 2, true, "-(sq(x*x + z*z + 2*P1*y - P1*P1) - y*y*(P1*P1 - x*x - z*z))"),
    (5, 2, true, "-(sq(x*x + y*y + z*z) - P1*(x*x + z*z)*y)"),
    (11, 1, true, "x*x*z*z - y"),
    (12, 1, true, "-(x*x*x - y*y*y - z)"),
    (13, 1, true, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    (14, 1, true, "-(sq(x*x + z*z) - 0.36*x*x - sq(y*y) + 0.25*y*y)"),
    (17, 3, false, "sqrt(sq(x*P0) + sq(y*P1) + sq(z*P2))"),
    (22, 1, true, "-(y*y + z*z - 0.5*sq(x*x)*x - 0.5*sq(x*x))"),
    (23, 1, true, "-(cube(2*x*x + y*y + z*z - 1) - 0.1*x*x*cube(z) - y*y*cube(z))"),
    (31, 3, true, "-(sq(x*x + y*y - z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x - z*z))"),
    (33, 3, true, "-(y*y + z*z - P2*P2*sq(x*x) + P2*P2*P1*P1*x*x)"),
    (
        35,
        1,
        true,
        "-((x*x + y*y + z*z + 2*y - 1)*(sq(x*x + y*y + z*z - 2*y - 1) - 8*z*z) + 16*x*z*(x*x + y*y + z*z - 2*y - 1))",
    ),
    (36, 1, true, "-(sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z - x*x*y*y - y*y*z*z - z*z*x*x + 1)"),
    (38, 1, true, "-(sq(x*x) - x*x + y*y + z*z)"),
    (41, 1, true, "-(4*x*x*(x*x + y*y + z*z) - y*y*(1 - y*y - z*z))"),
    (42, 1, true, "-(cube(y) + cube(z) - 6*y*z)"),
    (43, 1, true, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    (44, 4, true, "-(sq(x*x + y*y + z*z + P1*P1) - P3*P1*P1*(x*x + z*z) - P2*P2)"),
    (45, 1, true, "y - x*x - z*z"),
    (47, 0, false, "atan2(sqrt(x*x + z*z), y)"),
    (48, 1, true, "sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z"),
    (49, 1, true, "sq(x*x) - cube(x) + y*y + z*z"),
    (51, 5, false, "sqrt(x*x + z*z) - (P0 + P1*y + P2*y*y + P3*cube(y) + P4*sq(y*y))"),
    (54, 1, true, "y - sq(x*x) - sq(z*z)"),
    (55, 1, true, "y - sq(x*x) + sq(z*z)"),
    (56, 3, true, "-((x*x + z*z)*y*y + P2*P2*(x*x + z*z) - P1*P1*P2*P2)"),
    (57, 0, false, "sqrt(x*x + y*y + z*z)"),
    (
        60,
        4,
        false,
        "sqrt(sq(max(abs(x) - (P1 - P0), 0)) + sq(max(abs(y) - (P2 - P0), 0)) + sq(max(abs(z) - (P3 - P0), 0))) - P0",
    ),
    (61, 1, false, "sqrt(x*x + y*y + z*z) - P0"),
    (63, 4, false, "y - P0*cos(P1*x)*cos(P2*z)*exp(-P3*(x*x + z*z))"),
    (65, 1, true, "-(x*x*y*y + x*x*z*z + y*y*z*z + x*y*z)"),
    (68, 2, false, "1 - pow(pow(pow(abs(x), 2/P0) + pow(abs(y), 2/P0), P0/P1) + pow(abs(z), 2/P1), P1/2)"),
    (69, 0, false, "atan2(x, z)"),
    (70, 2, false, "sqrt(sq(sqrt(x*x + z*z) - P0) + y*y) - P1"),
    (71, 3, true, "-(sq(x*x + y*y + z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x + z*z))"),
    (73, 1, true, "y*z*z - x*x"),
    (74, 2, true, "-(P1*(y - 1) + (x*x + z*z)*y)"),
];

/// The functions that rest on POV-Ray's noise.
const NOISE: [f64; 5] = [29.0, 58.0, 59.0, 76.0, 78.0];

/// The formula of `internal(number)`.
pub(crate) fn internal(number: f64) -> Result<Formula, Lacking> {
    if NOISE.contains(&number) {
        return Err(Lacking::NotYet("no bound of noise over a box is known, which an exact root needs"));
    }
    let Some(row) = TABLE.iter().find(|row| f64::from(row.0) == number) else {
        let known = number.fract() == 0.0 && (0.0..=78.0).contains(&number);
        return Err(if known { Lacking::NotYet("its formula is not known here") } else { Lacking::Unknown });
    };
    written(row).ok_or(Lacking::NotYet("its formula is not known here"))
}

fn written(&(_, parameters, field, text): &Row) -> Option<Formula> {
    let mut pen = Pen { builder: Builder::new(), rest: text };
    let mut root = pen.sum()?;
    if field {
        let strength = pen.builder.input(3).ok()?;
        root = pen.push(Op::Mul(strength, root))?;
        let (low, high) = (pen.builder.constant(-10.0).ok()?, pen.builder.constant(10.0).ok()?);
        root = pen.push(Op::Max(root, low))?;
        root = pen.push(Op::Min(root, high))?;
    }
    pen.rest.is_empty().then(|| pen.builder.finish(root, 3 + parameters))
}

/// Reads one of the formulas above. They are right, so that it need not say what is wrong with them.
struct Pen {
    builder: Builder,
    rest: &'static str,
}

impl Pen {
    fn push(&mut self, op: Op) -> Option<NodeId> {
        self.builder.push(op).ok()
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
            // Of products: -P3*a is -(P3*a), which is the same number.
            let value = self.operand()?;
            return self.push(Op::Neg(value));
        }
        if self.take('(') {
            let value = self.sum()?;
            return self.take(')').then_some(value);
        }
        let len =
            self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(len);
        self.rest = rest;
        if let Ok(number) = word.parse() {
            return self.builder.constant(number).ok();
        }
        if let Some(number) = word.strip_prefix('P') {
            return self.builder.input(3 + number.parse::<u32>().ok()?).ok();
        }
        if let Some(axis) = ["x", "y", "z"].iter().position(|&name| name == word) {
            return self.builder.input(axis as u32).ok();
        }
        self.take('(').then_some(())?;
        let a = self.sum()?;
        let b = if self.take(',') { Some(self.sum()?) } else { None };
        self.take(')').then_some(())?;
        let result: Result<NodeId, FormulaError> = match (word, b) {
            ("sq", None) => self.builder.push(Op::Sqr(a)),
            ("cube", None) => self.builder.push(Op::Powi(a, 3)),
            ("sqrt", None) => self.builder.push(Op::Sqrt(a)),
            ("abs", None) => self.builder.push(Op::Abs(a)),
            ("cos", None) => self.builder.push(Op::Function(Function::Cos, a)),
            ("exp", None) => self.builder.push(Op::Function(Function::Exp, a)),
            ("max", Some(b)) => self.builder.push(Op::Max(a, b)),
            ("pow", Some(b)) => self.builder.push(Op::Pow(a, b)),
            ("atan2", Some(b)) => self.builder.push(Op::Atan2(a, b)),
            _ => return None,
        };
        result.ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_can_be_read() {
        for row in TABLE {
            let formula = written(row).unwrap_or_else(|| panic!("{row:?}"));
            assert_eq!(formula.inputs(), 3 + row.1);
            let value = formula.value(&[0.3, 0.2, 0.4, 1.5, 0.7, 0.6, 0.5, 0.8][..formula.inputs() as usize]);
            assert!(value.is_finite(), "{row:?}");
        }
    }

    #[test]
    fn noise_and_unknown_numbers_are_told_apart() {
        assert!(matches!(internal(76.0), Err(Lacking::NotYet(why)) if why.contains("noise")));
        assert_eq!(internal(79.0), Err(Lacking::Unknown));
        assert_eq!(internal(1.5), Err(Lacking::Unknown));
    }
}
