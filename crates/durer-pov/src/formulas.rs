//! The functions that functions.inc names, by the numbers it uses.
//!
//! Each is written as on paper; `P0`, `P1`, ... are the parameters behind `x`, `y`, `z`. They were found from the manual's descriptions, the surfaces' known
//! equations and POV-Ray's values (`tests/formulas.rs` holds some of those), and agree with it to 1e-9 (the rounded box to 1e-6, by
//! which POV-Ray's is larger than its description). Functions with a *field strength* are
//! kept between -10 and 10, as POV-Ray does.

use durer_math::Function;
use durer_scene::tape::{Builder, Formula, NodeId, Op};
use std::f64::consts::PI;

/// Why a number has no formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lacking {
    /// No function has it.
    Unknown,
    /// Its function has no formula here, for this reason.
    NotYet(&'static str),
}

/// What becomes of a formula's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kept {
    /// It is the function's.
    Plain,
    /// It is a field: times the strength `P0`, and between -10 and 10.
    Field,
    /// A field kept between `-P1` and `P1`.
    Limited,
}
use Kept::{Field, Limited, Plain};

/// A function's number, how many parameters it has behind `x`, `y`, `z`, what becomes of its value, and its formula.
type Row = (u32, u32, Kept, &'static str);

/// `u(switch, offset, angle)` and `v(switch, offset, angle)` are the coordinates of a plane curve: `x` and `y`, or where the switch is above zero those of a
/// section through the y axis, moved by the offset and turned by the angle, so that the curve is revolved. `section(a, b, type)` tells how far from the axis of a
/// tube: 0 a square, 1 a circle, 2 a diamond, 3 a star, and all between.
const TABLE: &[Row] = &[
    (0, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); b*b + cube(abs(a)) - a*a"),
    (
        1,
        5,
        Limited,
        "a = u(P2, P3, P4); b = v(P2, P3, P4); -(2*sq(a*a) - 3*a*a*b + b*b - 2*cube(b) + sq(b*b))",
    ),
    (2, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); -(sq(a*a) + a*a*b*b - 2*a*a*b - a*b*b + b*b)"),
    (3, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); -(sq(a*a + b*b) + 3*a*a*b - cube(b))"),
    (4, 2, Field, "-(sq(x*x + z*z + 2*P1*y - P1*P1) - y*y*(P1*P1 - x*x - z*z))"),
    (5, 2, Field, "-(sq(x*x + y*y + z*z) - P1*(x*x + z*z)*y)"),
    (
        6,
        5,
        Plain,
        "r = y*y + z*z; a = max(1 - sq(P2)*(sq(x + P0/2) + r), 0); b = max(1 - sq(P4)*(sq(x - P0/2) + r), 0); -(P1*a*a + P3*b*b)",
    ),
    (7, 4, Plain, "r = y*y + z*z; P3 - P2*(exp(-P1*(x*x + r)) + exp(-P1*(sq(x - P0) + r)))"),
    (
        8,
        2,
        Field,
        "w = 1 - z; r = x*x + y*y; k = sqrt(2); \
         P1*(64*cube(w)*cube(z) - 48*w*w*z*z*(3*r + 2*z*z) + 12*w*z*(27*r*r - 24*z*z*r + 36*k*y*z*(y*y - 3*x*x) + 4*sq(z*z)) + (9*r \
         - 2*z*z)*(-81*r*r - 72*z*z*r + 108*k*x*z*(x*x - 3*y*y) + 4*sq(z*z)))",
    ),
    (
        10,
        4,
        Plain,
        "P3 - P2*exp(max(-P1*(x*x + P0*(y*y + z*z)), -P1*(y*y + P0*(x*x + z*z)), -P1*(z*z + P0*(x*x + y*y))))",
    ),
    (11, 1, Field, "x*x*z*z - y"),
    (12, 1, Field, "-(x*x*x - y*y*y - z)"),
    (13, 1, Field, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    (14, 1, Field, "-(sq(x*x + z*z) - 0.36*x*x - sq(y*y) + 0.25*y*y)"),
    (15, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b*(P2*P2 - b*b) - a*a*(P1*P1 - a*a))"),
    (
        16,
        6,
        Field,
        "k = P5*P5; s = x*x + y*y + z*z; m = P3*P3 + P4*P4 + P1*P1 - P2*P2; \
         -(sq(k*k - 2*k*(P3*x + P4*y) + m*s) - 4*P1*P1*(sq(k*x - P3*s) + sq(k*z)) \
         + 8*k*(P1*P1 - P2*P2)*P4*y*s)",
    ),
    (17, 3, Plain, "sqrt(sq(x*P0) + sq(y*P1) + sq(z*P2))"),
    (
        18,
        1,
        Field,
        "w = select(abs(z) - 0.2, 0.2, z, z); d = y*y - x*x; -(cube(d/(2*w) + 2*z*z/9) - 6*sq(d/(4*w)))",
    ),
    (
        19,
        4,
        Plain,
        "P3 - P2*(exp(-P1*(x*x + P0*(y*y + z*z))) + exp(-P1*(y*y + P0*(x*x + z*z))) + exp(-P1*(z*z + P0*(x*x + y*y))))",
    ),
    (20, 3, Field, "(y*y + z*z)*(1 + x*(P2 - 4*P1)) + x*x*(1 + P2)"),
    (21, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b*(1 + a*(P2 - 4*P1)) + a*a*(1 + P2))"),
    (22, 1, Field, "-(y*y + z*z - 0.5*sq(x*x)*x - 0.5*sq(x*x))"),
    (23, 1, Field, "-(cube(2*x*x + y*y + z*z - 1) - 0.1*x*x*cube(z) - y*y*cube(z))"),
    (
        25,
        7,
        Plain,
        "r = sqrt(x*x + z*z); t = (atan2(z, x) + P1*y)*P0/(2*pi); a = r - P3; b = (t - floor(t) - 0.5)*2*pi/(P0*P1*P4); \
         c = cos(P6*pi/180); s = sin(P6*pi/180); min(section(a*c - b*s, a*s + b*c, P5), r + P3) - P2",
    ),
    (26, 7, Plain, "a = P1*y; section(x*cos(a) + z*sin(a) - P3, z*cos(a) - x*sin(a), P5) - P2"),
    (
        27,
        1,
        Plain,
        "h = sqrt(0.75); i = x - 2*h*floor(x/(2*h) + 0.5); j = y - 3*floor(y/3 + 0.5); k = x - h*(2*floor(x/(2*h)) + 1); \
         l = y - 3*floor(y/3) - 1.5; m = max(abs(i), abs(i)/2 + h*abs(j)); n = max(abs(k), abs(k)/2 + h*abs(l)); min(m, n)",
    ),
    (
        28,
        1,
        Plain,
        "h = sqrt(0.75); i = x - 2*h*floor(x/(2*h) + 0.5); j = y - 3*floor(y/3 + 0.5); k = x - h*(2*floor(x/(2*h)) + 1); \
         l = y - 3*floor(y/3) - 1.5; m = max(abs(i), abs(i)/2 + h*abs(j)); n = max(abs(k), abs(k)/2 + h*abs(l)); \
         a = select(m - n, abs(i), abs(k), abs(k)); b = select(m - n, abs(j), abs(l), abs(l)); \
         select(a/2 - h*b, abs(h*a - b/2), b, b)",
    ),
    (30, 1, Field, "-(4*cube(x*x + y*y + z*z - 13) + 27*sq(3*x*x + y*y - 4*z*z - 12))"),
    (31, 3, Field, "-(sq(x*x + y*y - z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x - z*z))"),
    (
        32,
        4,
        Plain,
        "P3 - P2*exp(min(-P1*(x*x + P0*(y*y + z*z)), -P1*(y*y + P0*(x*x + z*z)), -P1*(z*z + P0*(x*x + y*y))))",
    ),
    (33, 3, Field, "-(y*y + z*z - P2*P2*sq(x*x) + P2*P2*P1*P1*x*x)"),
    (34, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b - P2*P2*a*a*(a*a - P1*P2))"),
    (
        35,
        1,
        Field,
        "-((x*x + y*y + z*z + 2*y - 1)*(sq(x*x + y*y + z*z - 2*y - 1) - 8*z*z) + 16*x*z*(x*x + y*y + z*z - 2*y - 1))",
    ),
    (36, 1, Field, "-(sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z - x*x*y*y - y*y*z*z - z*z*x*x + 1)"),
    (
        37,
        4,
        Field,
        "-(sq(x*x) + sq(y*y) + sq(z*z) + P1*(x*x + y*y + z*z) + P2*(x*x*y*y + x*x*z*z + y*y*z*z) + P3*x*y*z - 1)",
    ),
    (38, 1, Field, "-(sq(x*x) - x*x + y*y + z*z)"),
    (39, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(P2*P2*a*a*(a*a - P1*P1) + b*b)"),
    (
        40,
        5,
        Plain,
        "i = floor(x/P0); j = floor(z/P1); a = P3*cos(pi*z/P1)*cos(pi*i); b = P3*cos(pi*x/P0)*cos(pi*j); \
         sqrt(min(sq(P2*(x - i*P0)) + sq(P4*(y + a)), sq(P2*(x - (i + 1)*P0)) + sq(P4*(y - a)), sq(P2*(z - j*P1)) + sq(P4*(y - b)), \
         sq(P2*(z - (j + 1)*P1)) + sq(P4*(y + b))))",
    ),
    (41, 1, Field, "-(4*x*x*(x*x + y*y + z*z) - y*y*(1 - y*y - z*z))"),
    (42, 1, Field, "-(cube(y) + cube(z) - 6*y*z)"),
    (43, 1, Field, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    (44, 4, Field, "-(sq(x*x + y*y + z*z + P1*P1) - P3*P1*P1*(x*x + z*z) - P2*P2)"),
    (45, 1, Field, "y - x*x - z*z"),
    (46, 3, Field, "c = P1*P1 - P2*P2; -(sq(x*x + y*y - z) - (P1*P1 + P2*P2)*(x*x - z) + c*y*y + c*c)"),
    (47, 0, Plain, "atan2(sqrt(x*x + z*z), y)"),
    (48, 1, Field, "sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z"),
    (49, 1, Field, "sq(x*x) - cube(x) + y*y + z*z"),
    (50, 7, Field, "a = u(P4, P5, P6); b = v(P4, P5, P6); -(b*b - P3*P3*cube(a)*(P1 + P2*a))"),
    (51, 5, Plain, "sqrt(x*x + z*z) - (P0 + P1*y + P2*y*y + P3*cube(y) + P4*sq(y*y))"),
    (
        52,
        6,
        Plain,
        "p = P1 + P2*y + P3*y*y + P4*cube(y) + P5*sq(y*y); t = (atan2(x, z) + select(p, pi, 0, 0))*P0/(2*pi); \
         d = (t - floor(t + 0.5))*2*pi/P0; r = sqrt(x*x + z*z); sqrt(max(sq(r - abs(p)) + 4*r*abs(p)*sq(sin(d/2)), 0))",
    ),
    (53, 1, Plain, "1.2 - 1.6*exp(-1.33333332*sqrt(x*x + y*y + z*z))*sq(2*y*y - x*x - z*z)"),
    (54, 1, Field, "y - sq(x*x) - sq(z*z)"),
    (55, 1, Field, "y - sq(x*x) + sq(z*z)"),
    (56, 3, Field, "-((x*x + z*z)*y*y + P2*P2*(x*x + z*z) - P1*P1*P2*P2)"),
    (57, 0, Plain, "sqrt(x*x + y*y + z*z)"),
    (
        60,
        4,
        Plain,
        "sqrt(sq(max(abs(x) - (P1 - P0), 0)) + sq(max(abs(y) - (P2 - P0), 0)) + sq(max(abs(z) - (P3 - P0), 0))) - P0",
    ),
    (61, 1, Plain, "sqrt(x*x + y*y + z*z) - P0"),
    (
        62,
        5,
        Plain,
        "P2*(exp(-P1*(x*x + P0*(y*y + z*z))) + exp(-P1*(y*y + P0*(x*x + z*z))) + exp(-P1*(z*z + P0*(x*x + y*y))) - P4*exp(-P3*(x*x + y*y + z*z)))",
    ),
    (63, 4, Plain, "y - P0*cos(P1*x)*cos(P2*z)*exp(-P3*(x*x + z*z))"),
    (
        64,
        6,
        Plain,
        "r = sqrt(x*x + z*z); m = sqrt(x*x + y*y + z*z); t = r/P0 + atan2(z, x)/(2*pi) + 0.5; d = (t - floor(t))*P0; \
         w = select(r - d, m, section(d, y, P5), section(d, y, P5)); max(min(m, section(P0 - d, y, P5), w) - P1, m - P2)",
    ),
    (65, 1, Field, "-(x*x*y*y + x*x*z*z + y*y*z*z + x*y*z)"),
    (66, 4, Field, "(x - P2)*(y*y + z*z) + P3*P3*x*x*(P1 + x)"),
    (67, 7, Field, "a = u(P4, P5, P6); b = v(P4, P5, P6); (a - P2)*b*b + P3*P3*a*a*(P1 + a)"),
    (68, 2, Plain, "1 - pow(pow(pow(abs(x), 2/P0) + pow(abs(y), 2/P0), P0/P1) + pow(abs(z), 2/P1), P1/2)"),
    (69, 0, Plain, "atan2(x, z)"),
    (70, 2, Plain, "sqrt(sq(sqrt(x*x + z*z) - P0) + y*y) - P1"),
    (71, 3, Field, "-(sq(x*x + y*y + z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x + z*z))"),
    (72, 1, Field, "-(4*(sq(x*x) + sq(y*y + z*z)) + 17*x*x*(y*y + z*z) - 20*(x*x + y*y + z*z) + 17)"),
    (73, 1, Field, "y*z*z - x*x"),
    (74, 2, Field, "-(P1*(y - 1) + (x*x + z*z)*y)"),
    (75, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(P1*P1*b + a*a*b - P2)"),
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

fn written(&(_, parameters, kept, text): &Row) -> Option<Formula> {
    let mut pen = Pen { builder: Builder::new(), rest: text, names: Vec::new() };
    let mut root = pen.formula()?;
    if kept != Plain {
        let strength = pen.builder.input(3).ok()?;
        root = pen.push(Op::Mul(strength, root))?;
        let high =
            if kept == Field { pen.builder.constant(10.0).ok()? } else { pen.builder.input(4).ok()? };
        let low = pen.push(Op::Neg(high))?;
        root = pen.push(Op::Max(root, low))?;
        root = pen.push(Op::Min(root, high))?;
    }
    pen.rest.is_empty().then(|| pen.builder.finish(root, 3 + parameters))
}

/// Reads one of the formulas above. They are right, so that it need not say what is wrong with them.
struct Pen {
    builder: Builder,
    rest: &'static str,
    /// What has been named so far.
    names: Vec<(&'static str, NodeId)>,
}

impl Pen {
    fn push(&mut self, op: Op) -> Option<NodeId> {
        self.builder.push(op).ok()
    }

    /// `name = sum; ... sum`.
    fn formula(&mut self) -> Option<NodeId> {
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
            // Of products: -P3*a is -(P3*a), which is the same number.
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
            return self.builder.constant(number).ok();
        }
        if let Some(number) = word.strip_prefix('P') {
            return self.builder.input(3 + number.parse::<u32>().ok()?).ok();
        }
        if let Some(axis) = ["x", "y", "z"].iter().position(|&name| name == word) {
            return self.builder.input(axis as u32).ok();
        }
        if word == "pi" {
            return self.builder.constant(PI).ok();
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
            ("atan2", &[a, b]) => self.push(Op::Atan2(a, b)),
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
        let degree = self.builder.constant(PI / 180.0).ok()?;
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
        let two = self.builder.constant(2.0).ok()?;
        let exponent = self.push(Op::Div(two, kind))?;
        let powers = (self.push(Op::Pow(a, exponent))?, self.push(Op::Pow(b, exponent))?);
        let sum = self.push(Op::Add(powers.0, powers.1))?;
        let root = self.push(Op::Div(kind, two))?;
        let round = self.push(Op::Pow(sum, root))?;
        let square = self.push(Op::Max(a, b))?;
        self.push(Op::Select([kind, round, square, round]))
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
            let value = formula
                .value(&[0.3, 0.2, 0.4, 1.5, 0.7, 0.6, 0.5, 0.8, 0.9, 1.1][..formula.inputs() as usize]);
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
