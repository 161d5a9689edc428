//! Polynomials of one number, with bounds on the errors of their coefficients. A formula of sums
//! and products is one along a line.
//!
//! ```text
//!   p(s) = Σ c_k s^k,    each c_k within e_k
//! ```
//!
//! Every operation bounds its own roundings. A result that is no polynomial, or of too high a
//! degree, is [`Powers::UNKNOWN`], and so is everything computed from it.

use crate::noise::{Nearest, NoiseTable};
use crate::{Comparison, Function, Joined, Number};
use durer_math::{Interval, U};
use durer_roots::bernstein::FLOOR;

/// A polynomial of degree up to 16.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Powers {
    /// The coefficients, from the constant up.
    pub c: [f64; Self::LEN],
    /// The bounds on their errors.
    pub e: [f64; Self::LEN],
    /// Coefficients above are zero.
    degree: usize,
}

impl Powers {
    /// How many coefficients there are at most.
    pub const LEN: usize = 17;

    /// Not known to be a polynomial.
    const UNKNOWN: Self = Self { c: [0.0; Self::LEN], e: [0.0; Self::LEN], degree: Self::LEN };
    const ZERO: Self = Self { degree: 0, ..Self::UNKNOWN };

    /// `q + s d`, each within an error.
    pub fn line([q, d]: [f64; 2], [e_q, e_d]: [f64; 2]) -> Self {
        let mut out = Self { degree: 1, ..Self::ZERO };
        (out.c[0], out.c[1], out.e[0], out.e[1]) = (q, d, e_q, e_d);
        out
    }

    /// The degree, or more; `None` if that is too high, or this is no polynomial.
    pub fn degree(&self) -> Option<usize> {
        (self.degree < Self::LEN).then_some(self.degree)
    }

    /// The one number that this is for certain.
    fn as_number(&self) -> Option<f64> {
        (self.degree == 0 && self.e[0] == 0.0).then_some(self.c[0])
    }

    #[inline(always)]
    fn sum(a: &Self, b: &Self, sign: f64) -> Self {
        let degree = a.degree.max(b.degree);
        if degree >= Self::LEN {
            return Self::UNKNOWN;
        }
        let mut out = Self { degree, ..Self::ZERO };
        for k in 0..=degree {
            let c = a.c[k] + sign * b.c[k];
            out.c[k] = c;
            // Sums are exact below the normal range, and of what is zero.
            let rounding = if a.c[k] == 0.0 || b.c[k] == 0.0 { 0.0 } else { c.abs() * U };
            out.e[k] = (a.e[k] + b.e[k] + rounding) * (1.0 + 8.0 * U);
        }
        out
    }
}

impl Joined for Powers {
    fn joined(_: &Self, _: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
}

impl Number for Powers {
    fn constant(c: Interval) -> Self {
        let middle = c.mid();
        let mut out = Self::ZERO;
        out.c[0] = middle;
        out.e[0] = (c.hi - middle).max(middle - c.lo) * (1.0 + 4.0 * U);
        out
    }

    fn add(a: &Self, b: &Self) -> Self {
        Self::sum(a, b, 1.0)
    }

    fn sub(a: &Self, b: &Self) -> Self {
        Self::sum(a, b, -1.0)
    }

    #[inline(always)]
    fn mul(a: &Self, b: &Self) -> Self {
        let degree = a.degree + b.degree;
        if degree >= Self::LEN {
            return Self::UNKNOWN;
        }
        // Products of two, and so many sums of them.
        let roundings = (a.degree.min(b.degree) + 2) as f64 * U;
        let mut out = Self { degree, ..Self::ZERO };
        let mut size = [0.0_f64; Self::LEN];
        for i in 0..=a.degree {
            let (x, e_x) = (a.c[i], a.e[i]);
            for j in 0..=b.degree {
                let (y, e_y) = (b.c[j], b.e[j]);
                out.c[i + j] = x.mul_add(y, out.c[i + j]);
                size[i + j] = x.abs().mul_add(y.abs(), size[i + j]);
                out.e[i + j] += x.abs().mul_add(e_y, (y.abs() + e_y) * e_x);
            }
        }
        for (e, size) in out.e[..=degree].iter_mut().zip(size) {
            *e = size.mul_add(roundings, *e) * (1.0 + 128.0 * U) + FLOOR;
        }
        out
    }

    fn div(a: &Self, b: &Self) -> Self {
        let (y, e_y) = (b.c[0], b.e[0]);
        if b.degree > 0 || a.degree >= Self::LEN || y.abs() <= 2.0 * e_y {
            return Self::UNKNOWN;
        }
        let mut out = Self { degree: a.degree, ..Self::ZERO };
        for k in 0..=a.degree {
            let c = a.c[k] / y;
            out.c[k] = c;
            // |x / y - x' / y'| <= (e_x + |c| e_y) / |y'| for any x', y' within the errors.
            let spread = (a.e[k] + c.abs() * e_y) / (y.abs() - e_y);
            out.e[k] = (spread + c.abs() * U) * (1.0 + 16.0 * U) + FLOOR;
        }
        out
    }

    fn neg(a: &Self) -> Self {
        Self { c: a.c.map(|c| -c), ..*a }
    }

    fn sqr(a: &Self) -> Self {
        Self::mul(a, a)
    }

    fn powi(a: &Self, n: i32) -> Self {
        match u32::try_from(n) {
            // A value that is not defined everywhere is not 1.
            Ok(0) if a.degree < Self::LEN => Self::constant(Interval { lo: 1.0, hi: 1.0 }),
            Ok(n @ 1..) if n < Self::LEN as u32 => (1..n).fold(*a, |power, _| Self::mul(&power, a)),
            _ => Self::UNKNOWN,
        }
    }

    fn pow(a: &Self, b: &Self) -> Self {
        match b.as_number() {
            Some(n) if n.fract() == 0.0 && (0.0..Self::LEN as f64).contains(&n) => Self::powi(a, n as i32),
            _ => Self::UNKNOWN,
        }
    }

    fn is_zero(&self) -> bool {
        self.as_number() == Some(0.0)
    }

    fn abs(_: &Self) -> Self {
        Self::UNKNOWN
    }
    fn sqrt(_: &Self) -> Self {
        Self::UNKNOWN
    }
    fn min(_: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn max(_: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn atan2(_: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn rem(_: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn function(_: Function, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn noise(_: Option<&NoiseTable>, _: [&Self; 3]) -> Self {
        Self::UNKNOWN
    }
    fn nearest(_: Nearest, _: [&Self; 3]) -> Self {
        Self::UNKNOWN
    }
    fn compare(_: Comparison, _: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn select(_: &Self, _: &Self, _: &Self, _: &Self) -> Self {
        Self::UNKNOWN
    }
    fn above(_: &Self) -> Option<Self> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Builder, Op, Tape};
    use durer_math::Dyadic;
    use durer_testkit::TestRng;

    /// What is formed of three lines by sums and products is within the bounds of what exact
    /// numbers, anywhere within theirs, form.
    #[test]
    fn coefficients_are_within_their_bounds() {
        let mut b = Builder::new();
        let mut op = |op| b.push(op).unwrap();
        let [x, y, z] = [0, 1, 2].map(|i| op(Op::Input(i)));
        let k = op(Op::Constant(0.1.into()));
        let third = op(Op::Constant(3.0.into()));
        let (cube, square) = (op(Op::Powi(x, 3)), op(Op::Sqr(y)));
        let product = op(Op::Mul(cube, square));
        let part = op(Op::Div(z, third));
        let left = op(Op::Add(product, part));
        let turned = op(Op::Neg(k));
        let sum = op(Op::Sub(left, turned));
        let root = op(Op::Mul(sum, y));
        let tape = Tape::new(&b.finish(root, 3));
        let tenth = Dyadic::from(0.1);
        let exactly = |[x, y, z]: [Dyadic; 3]| {
            let cube = &(&x * &x) * &x;
            let three = Dyadic::from(3.0);
            // Three times the formula.
            let left = &(&(&cube * &(&y * &y)) * &three) + &z;
            &(&left + &(&tenth * &three)) * &y
        };
        let mut dice = TestRng::new(5);
        for _ in 0..2000 {
            let size = dice.power(-40, 40);
            let mut line = || [dice.unit() * size, dice.unit()];
            let at = [line(), line(), line()];
            let e = dice.power(-60, -30);
            let shifts = [0, 1, 2].map(|_| [dice.unit() * e, dice.unit() * e]);
            let p = tape.along(&at.map(|at| Powers::line(at, [e, e])));
            assert_eq!(p.degree(), Some(6));
            for s in [0.0, 0.5, -1.0, 3.0, dice.unit()] {
                let place = |i: usize| {
                    let [q, d] = [0, 1].map(|k| &Dyadic::from(at[i][k]) + &Dyadic::from(shifts[i][k]));
                    &q + &(&d * &Dyadic::from(s))
                };
                let exact = exactly([place(0), place(1), place(2)]);
                let (mut value, mut bound, mut power) = (Dyadic::ZERO, Dyadic::ZERO, Dyadic::from(1.0));
                for k in 0..=6 {
                    value = &value + &(&Dyadic::from(p.c[k]) * &power);
                    let size = if s < 0.0 && k % 2 == 1 { -p.e[k] } else { p.e[k] };
                    bound = &bound + &(&Dyadic::from(size) * &power);
                    power = &power * &Dyadic::from(s);
                }
                let three = Dyadic::from(3.0);
                let off = &exact - &(&value * &three);
                let most = &bound * &three;
                assert!((&most - &off).exact_sign().is_ge() && (&most + &off).exact_sign().is_ge());
            }
            // Of lines without errors: some roundings of what all terms measure together.
            let exact = tape.along(&at.map(|at| Powers::line(at, [0.0; 2])));
            let sizes = tape.along(&at.map(|at| Powers::line(at.map(f64::abs), [0.0; 2])));
            assert!((0..=6).all(|k| exact.e[k] <= 64.0 * U * sizes.c[k] + 1e3 * FLOOR), "{exact:?}");
        }
    }

    #[test]
    fn what_is_no_polynomial_is_not_known() {
        let degree = |f: &dyn Fn(&mut Builder, [crate::NodeId; 3]) -> crate::NodeId| {
            let mut b = Builder::new();
            let inputs = [0, 1, 2].map(|i| b.input(i).unwrap());
            let root = f(&mut b, inputs);
            let line = Powers::line([0.0, 1.0], [0.0; 2]);
            Tape::new(&b.finish(root, 3)).along(&[line; 3]).degree()
        };
        assert_eq!(degree(&|b, [x, ..]| b.push(Op::Powi(x, 16)).unwrap()), Some(16));
        assert_eq!(degree(&|b, [x, ..]| b.push(Op::Powi(x, 17)).unwrap()), None);
        assert_eq!(degree(&|b, [x, ..]| b.push(Op::Sqrt(x)).unwrap()), None);
        assert_eq!(degree(&|b, [x, y, _]| b.push(Op::Div(x, y)).unwrap()), None);
        assert_eq!(Powers::powi(&Powers::UNKNOWN, 0), Powers::UNKNOWN);
        let hidden = |b: &mut Builder, [x, y, _]: [crate::NodeId; 3]| {
            let least = b.push(Op::Min(x, y)).unwrap();
            let square = b.push(Op::Sqr(least)).unwrap();
            b.push(Op::Sub(square, x)).unwrap()
        };
        assert_eq!(degree(&hidden), None);
    }
}
