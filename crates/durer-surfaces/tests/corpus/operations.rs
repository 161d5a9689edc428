//! Any bytes as one operation of a formula and two intervals: the bounds contain the results of f64
//! and of exact arithmetic.

#[path = "../../../../fuzz/shared/bytes.rs"]
#[allow(clippy::duplicate_mod, reason = "each target stands alone, too; only the tests load them all")]
mod bytes;

use astro_float::{BigFloat, Consts, RoundingMode};
use bytes::Bytes;
use dashu::rational::RBig;
use durer_formula::{Builder, NodeId, Op, Tape};
use durer_formula::{Function, I8};
use durer_math::{Interval, Point3};
use std::cell::RefCell;

/// The precision, in bits, of the oracle for functions that are not rational.
const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

impl Bytes<'_> {
    /// Small numbers, neighbours of integers, multiples of a quarter turn, numbers of any size.
    fn number(&mut self) -> f64 {
        let x = match self.next() % 8 {
            0 => f64::from_bits(self.bits()),
            1 => (f64::from(self.next()) - 128.0).next_up(),
            2 => (f64::from(self.next()) - 128.0).next_down(),
            3 => (f64::from(self.next()) - 128.0) * core::f64::consts::FRAC_PI_2,
            4 => durer_math::scale::ldexp(self.bits() as f64, i32::from(self.next()) - 192),
            5 => -durer_math::scale::ldexp(self.bits() as f64, i32::from(self.next()) - 192),
            _ => (f64::from(self.next()) - 128.0) / 16.0,
        };
        if x.is_finite() { x } else { 0.0 }
    }
}

/// The exact result of an operation at a point where it is defined.
enum Exact {
    Ratio(RBig),
    /// The non-negative number whose square is this.
    Root(RBig),
    /// A value so precise that no f64 lies between it and the exact result, unless that is itself
    /// an f64.
    Near(BigFloat),
}

impl Exact {
    fn is_in(&self, range: Interval) -> bool {
        let (below, above) = (range.lo == f64::NEG_INFINITY, range.hi == f64::INFINITY);
        if !below && !range.lo.is_finite() || !above && !range.hi.is_finite() {
            return false;
        }
        match self {
            Self::Ratio(x) => (below || ratio(range.lo) <= *x) && (above || ratio(range.hi) >= *x),
            Self::Root(x) => {
                let square = |x: f64| ratio(x) * ratio(x);
                (below || range.lo <= 0.0 || square(range.lo) <= *x)
                    && (above || range.hi >= 0.0 && square(range.hi) >= *x)
            }
            Self::Near(x) => {
                (below || big(range.lo).cmp(x).is_some_and(|o| o <= 0))
                    && (above || big(range.hi).cmp(x).is_some_and(|o| o >= 0))
            }
        }
    }
}

fn ratio(x: f64) -> RBig {
    RBig::try_from(x).unwrap_or(RBig::ZERO)
}

fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, P)
}

/// A value of many bits. Its constants are computed once, since that takes longer than everything
/// else.
fn witness(value: impl FnOnce(&mut Consts) -> BigFloat) -> Option<Exact> {
    thread_local! {
        static CONSTANTS: RefCell<Option<Consts>> = RefCell::new(Consts::new().ok());
    }
    CONSTANTS.with_borrow_mut(|constants| constants.as_mut().map(|c| Exact::Near(value(c))))
}

/// An operation of one or two operands, perhaps with an integer power.
type Make = fn([NodeId; 2], i32) -> Op;

/// The exact result for the same arguments; `None` where it is undefined or the oracle cannot
/// compute it.
type Truth = fn(f64, f64, i32) -> Option<Exact>;

/// The operation with this number.
fn operation(code: u8) -> (Make, Truth) {
    use Exact::{Ratio, Root};
    type Witness = fn(&BigFloat, &mut Consts) -> BigFloat;
    fn near(x: f64, most: f64, f: Witness) -> Option<Exact> {
        (x.abs() <= most).then(|| witness(|c| f(&big(x), c))).flatten()
    }
    macro_rules! function {
        ($name:ident, $most:expr, $f:expr) => {
            (|[x, _], _| Op::Function(Function::$name, x), |x, _, _| near(x, $most, $f))
        };
    }
    match code % 22 {
        0 => (|[x, y], _| Op::Add(x, y), |x, y, _| Some(Ratio(ratio(x) + ratio(y)))),
        1 => (|[x, y], _| Op::Sub(x, y), |x, y, _| Some(Ratio(ratio(x) - ratio(y)))),
        2 => (|[x, y], _| Op::Mul(x, y), |x, y, _| Some(Ratio(ratio(x) * ratio(y)))),
        3 => (|[x, y], _| Op::Div(x, y), |x, y, _| (y != 0.0).then(|| Ratio(ratio(x) / ratio(y)))),
        4 => (|[x, _], _| Op::Sqr(x), |x, _, _| Some(Ratio(ratio(x) * ratio(x)))),
        5 => (|[x, _], _| Op::Sqrt(x), |x, _, _| (x >= 0.0).then(|| Root(ratio(x)))),
        6 => (|[x, y], _| Op::Min(x, y), |x, y, _| Some(Ratio(ratio(x.min(y))))),
        7 => (
            |[x, _], n| Op::Powi(x, n),
            |x, _, n| {
                let whole = (0..n.unsigned_abs()).fold(RBig::ONE, |p, _| p * ratio(x));
                if n >= 0 { Some(Ratio(whole)) } else { (x != 0.0).then(|| Ratio(RBig::ONE / whole)) }
            },
        ),
        8 => (
            |[x, y], _| Op::Pow(x, y),
            |x, y, _| {
                // If the power itself may be an f64 number the oracle computes more and more of its
                // zeros, without end.
                let tame =
                    (1e-3..1e3).contains(&x) && x != 1.0 && y.abs() < 50.0 && (y * 1024.0).fract() != 0.0;
                tame.then(|| witness(|c| big(x).pow(&big(y), P, RM, c))).flatten()
            },
        ),
        // For larger arguments of these the oracle takes longer and longer.
        9 => function!(Sin, 1e6, |x, c| x.sin(P, RM, c)),
        10 => function!(Cos, 1e6, |x, c| x.cos(P, RM, c)),
        11 => function!(Tan, 1e6, |x, c| x.tan(P, RM, c)),
        12 => function!(Asin, 1.0, |x, c| x.asin(P, RM, c)),
        13 => function!(Acos, 1.0, |x, c| x.acos(P, RM, c)),
        14 => function!(Atan, 1e9, |x, c| x.atan(P, RM, c)),
        15 => function!(Sinh, 700.0, |x, c| x.sinh(P, RM, c)),
        16 => function!(Cosh, 700.0, |x, c| x.cosh(P, RM, c)),
        17 => function!(Tanh, 40.0, |x, c| x.tanh(P, RM, c)),
        18 => function!(Asinh, 1e9, |x, c| x.asinh(P, RM, c)),
        19 => function!(Exp, 700.0, |x, c| x.exp(P, RM, c)),
        20 => (
            |[x, _], _| Op::Function(Function::Ln, x),
            |x, _, _| (x >= 1e-300).then(|| near(x, 1e300, |x, c| x.ln(P, RM, c))).flatten(),
        ),
        _ => (
            |[x, _], _| Op::Function(Function::Log10, x),
            |x, _, _| (x >= 1e-300).then(|| near(x, 1e300, |x, c| x.log10(P, RM, c))).flatten(),
        ),
    }
}

/// Tests the bounds of the operation that the bytes encode.
///
/// # Panics
///
/// If they do not contain a value.
pub(crate) fn check(data: &[u8]) {
    let mut bytes = Bytes(data);
    let code = bytes.next();
    let power = i32::from(bytes.next() % 12) - 4;
    let (op, exact) = operation(code);
    let mut side = || {
        let (a, b) = (bytes.number(), bytes.number());
        let b = if bytes.next() % 2 == 0 { b } else { a + b * 1e-6 };
        let b = if b.is_finite() { b } else { a };
        Interval { lo: a.min(b), hi: a.max(b) }
    };
    let (x, y) = (side(), side());
    let mut builder = Builder::new();
    let Ok(first) = builder.input(0) else { return };
    // A single number is a constant, which is folded, or becomes part of a step.
    let second = if y.lo == y.hi { builder.push(Op::Constant(y.lo.into())) } else { builder.input(1) };
    let Ok(second) = second else { return };
    let Ok(step) = builder.push(op([first, second], power)) else { return };
    let tape = Tape::new(&builder.finish(step, 3));
    let range = tape.bounds(&[I8::splat(x), I8::splat(y), I8::splat(Interval { lo: 0.0, hi: 0.0 })]);
    for i in 0..4 {
        let k = f64::from(bytes.next()) / 255.0;
        let at = |x: Interval, k: f64| match i {
            0 => x.lo,
            1 => x.hi,
            _ => (x.lo + (x.hi - x.lo) * k).clamp(x.lo, x.hi),
        };
        let (x, y) = (at(x, k), at(y, f64::from(bytes.next()) / 255.0));
        if x.is_nan() || y.is_nan() {
            continue; // a width beyond the range of f64
        }
        let range = range.lane(0);
        let value = tape.value(Point3::new(x, y, 0.0));
        let told = || format!("operation {} of {x:e}, {y:e}, power {power}: {range:?}", code % 22);
        assert!(!value.is_finite() || range.contains(value), "{value:e} is not in it: {}", told());
        if let Some(exact) = exact(x, y, power) {
            assert!(exact.is_in(range), "the exact value is not in it: {}", told());
        }
    }
}
