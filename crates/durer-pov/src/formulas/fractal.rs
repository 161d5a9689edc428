//! The functions of functions.inc that are made of noise.
//!
//! ```text
//!   f_ridge      sum of w_k |N(l^k p) - r| / max(r, 1 - r) over the sum of the w_k,  then (. - offset)/(1 - offset);   w_k = omega^k
//!   f_ridged_mf  sum of s_k l^(-k H),  s_0 = R_0,  s_k = R_k min(max(gain s_(k-1), 0), 1);                             R_k = (offset - |S(l^k p)|)^2
//!   f_hetero_mf  v_0 = I_0,  v_k = v_(k-1) + I_k l^(-k H) v_(k-1)^T;                                                    I_k = S(l^k p) + offset
//! ```
//!
//! `N` is noise and `S = 2 N - 1`. The second and the third formula are by F. K. Musgrave,
//! "Procedural fractal terrains", in D. S. Ebert et al., *Texturing and Modeling*, 2nd ed., 1998,
//! chapter 14, the third with a power of his. The treatment of fractional octaves, of `T` below 1
//! and of the first one's parameters was found from POV-Ray's values, with POV-Ray's own noise. It
//! agrees with all values that were tried to 1e-11.
//!
//! The formulas are expanded with the greatest number of octaves allowed. Calls that state their
//! number drop the others.

use crate::noise_pattern;
use durer_formula::Function;
use durer_formula::noise::NoiseTable;
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_scene::NoiseGenerator;

/// The number of the function that is plain noise.
pub(crate) const PLAIN: f64 = 76.0;
/// The greatest number of octaves of a function.
pub(super) const MOST_OCTAVES: u32 = 20;

/// By generator, P0: the first for all numbers but those from 2 to 4. P1 is the noise of the third.
const NOISE: &str = "n = noise(x, y, z); old = max(min(n + 0.5, 1), 0); new = max(min((n + 1.05242)*0.48985582, 1), 0); \
                     select(P0 - 2, old, new, select(P0 - 3, new, P1, select(P0 - 4, P1, old, old)))";

/// The noise of a point by generator, with this table for the third.
fn noise(rows: &'static NoiseTable) -> Option<Formula> {
    let (mut b, third) = (Builder::new(), noise_pattern::third(rows)?);
    let [x, y, z, generator] = [b.input(0).ok()?, b.input(1).ok()?, b.input(2).ok()?, b.input(3).ok()?];
    let third = b.call(&third, &[x, y, z]).ok()?;
    let root = b.call(&super::on_paper(NOISE, 2)?, &[x, y, z, generator, third]).ok()?;
    Some(b.finish(root, 4))
}

/// A formula under construction, with the inputs `x`, `y`, `z` and six parameters, of which the
/// last is the noise generator.
struct Draft {
    builder: Builder,
    noise: Formula,
}

type Step = Result<NodeId, FormulaError>;

impl Draft {
    fn new(rows: &'static NoiseTable) -> Option<Self> {
        Some(Self { builder: Builder::new(), noise: noise(rows)? })
    }

    fn p(&mut self, number: u32) -> Step {
        self.builder.input(3 + number)
    }

    fn number(&mut self, x: f64) -> Step {
        self.builder.constant(x)
    }

    fn push(&mut self, op: Op) -> Step {
        self.builder.push(op)
    }

    /// `a` to an integer power.
    fn power(&mut self, a: NodeId, n: u32) -> Step {
        if n == 0 { self.number(1.0) } else { self.push(Op::Powi(a, n as i32)) }
    }

    /// The noise of octave `k`, whose frequency is `l^k`.
    fn noise(&mut self, l: NodeId, k: u32) -> Step {
        let factor = self.power(l, k)?;
        let mut arguments = [factor; 4];
        for axis in 0..3 {
            let x = self.builder.input(axis)?;
            arguments[axis as usize] = self.push(Op::Mul(x, factor))?;
        }
        arguments[3] = self.p(5)?;
        self.builder.call(&self.noise, &arguments)
    }

    /// The noise of octave `k`, scaled to the range from -1 to 1.
    fn signed(&mut self, l: NodeId, k: u32) -> Step {
        let noise = self.noise(l, k)?;
        let (two, one) = (self.number(2.0)?, self.number(1.0)?);
        let twice = self.push(Op::Mul(two, noise))?;
        self.push(Op::Sub(twice, one))
    }

    /// `l^(-k H)`.
    fn weight(&mut self, l: NodeId, h: NodeId, k: u32) -> Step {
        let (factor, exponent) = (self.power(l, k)?, self.push(Op::Neg(h))?);
        self.push(Op::Pow(factor, exponent))
    }

    fn ridge(&mut self) -> Step {
        let [l, octaves, omega, offset, ridge] = [self.p(0)?, self.p(1)?, self.p(2)?, self.p(3)?, self.p(4)?];
        let (zero, one) = (self.number(0.0)?, self.number(1.0)?);
        // Below one octave there is one full octave and the fraction in addition.
        let (below, whole) =
            (self.push(Op::Sub(octaves, one))?, self.push(Op::Function(Function::Floor, octaves))?);
        let part = self.push(Op::Sub(octaves, whole))?;
        let more = self.push(Op::Add(one, part))?;
        let octaves = self.push(Op::Select([below, more, octaves, octaves]))?;
        let rest = self.push(Op::Sub(one, ridge))?;
        let size = self.push(Op::Max(ridge, rest))?;
        let (mut sum, mut weights) = (zero, zero);
        for k in 0..=MOST_OCTAVES {
            let noise = self.noise(l, k)?;
            let away = self.push(Op::Sub(noise, ridge))?;
            let away = self.push(Op::Abs(away))?;
            let number = self.number(f64::from(k))?;
            let left = self.push(Op::Sub(octaves, number))?;
            let part = self.push(Op::Min(left, one))?;
            let omega = self.power(omega, k)?;
            let weight = self.push(Op::Mul(omega, part))?;
            let term = self.push(Op::Mul(weight, away))?;
            let (term, weight) = (
                self.push(Op::Select([left, zero, zero, term]))?,
                self.push(Op::Select([left, zero, zero, weight]))?,
            );
            (sum, weights) = (self.push(Op::Add(sum, term))?, self.push(Op::Add(weights, weight))?);
        }
        let below = self.push(Op::Mul(weights, size))?;
        let mean = self.push(Op::Div(sum, below))?;
        let (top, rest) = (self.push(Op::Sub(mean, offset))?, self.push(Op::Sub(one, offset))?);
        self.push(Op::Div(top, rest))
    }

    fn ridged_multifractal(&mut self) -> Step {
        let [h, l, octaves, offset, gain] = [self.p(0)?, self.p(1)?, self.p(2)?, self.p(3)?, self.p(4)?];
        let (zero, one) = (self.number(0.0)?, self.number(1.0)?);
        let (mut sum, mut signal) = (zero, one);
        for k in 0..MOST_OCTAVES {
            let noise = self.signed(l, k)?;
            let away = self.push(Op::Abs(noise))?;
            let rise = self.push(Op::Sub(offset, away))?;
            let own = self.push(Op::Sqr(rise))?;
            if k == 0 {
                (sum, signal) = (own, own);
                continue;
            }
            let gained = self.push(Op::Mul(signal, gain))?;
            let gained = self.push(Op::Max(gained, zero))?;
            let gained = self.push(Op::Min(gained, one))?;
            signal = self.push(Op::Mul(own, gained))?;
            let weight = self.weight(l, h, k)?;
            let term = self.push(Op::Mul(signal, weight))?;
            let number = self.number(f64::from(k))?;
            let left = self.push(Op::Sub(octaves, number))?;
            let term = self.push(Op::Select([left, zero, zero, term]))?;
            sum = self.push(Op::Add(sum, term))?;
        }
        Ok(sum)
    }

    fn hetero_multifractal(&mut self) -> Step {
        let [h, l, octaves, offset, t] = [self.p(0)?, self.p(1)?, self.p(2)?, self.p(3)?, self.p(4)?];
        let (zero, one) = (self.number(0.0)?, self.number(1.0)?);
        let whole = self.push(Op::Function(Function::Trunc, octaves))?;
        let rest = self.push(Op::Sub(octaves, whole))?;
        let t = self.push(Op::Function(Function::Trunc, t))?;
        let noise = self.signed(l, 0)?;
        let mut value = self.push(Op::Add(noise, offset))?;
        for k in 1..=MOST_OCTAVES {
            let noise = self.signed(l, k)?;
            let own = self.push(Op::Add(noise, offset))?;
            let weight = self.weight(l, h, k)?;
            let own = self.push(Op::Mul(own, weight))?;
            let power = self.push(Op::Pow(value, t))?;
            let power = self.push(Op::Select([t, one, one, power]))?;
            let full = self.push(Op::Mul(own, power))?;
            // The octave after the last full one counts partly; that part does not use T.
            let part = self.push(Op::Mul(own, rest))?;
            let part = self.push(Op::Mul(part, value))?;
            let number = self.number(f64::from(k))?;
            let (beyond, last) = (self.push(Op::Sub(number, octaves))?, self.number(f64::from(k - 1))?);
            let before = self.push(Op::Sub(octaves, last))?;
            let part = self.push(Op::Select([before, zero, zero, part]))?;
            let term = self.push(Op::Select([beyond, full, zero, part]))?;
            value = self.push(Op::Add(value, term))?;
        }
        Ok(value)
    }
}

/// The formula of a function by its number, with this table for the third generator; `None` if it is
/// not made of noise.
pub(super) fn internal(number: f64, generator: NoiseGenerator, rows: &'static NoiseTable) -> Option<Formula> {
    let made = |write: fn(&mut Draft) -> Step| {
        let mut draft = Draft::new(rows)?;
        let root = write(&mut draft).ok()?;
        Some(draft.builder.finish(root, 9))
    };
    match number {
        PLAIN => {
            let generator = match generator {
                NoiseGenerator::First => 1.0,
                NoiseGenerator::Second => 2.0,
                NoiseGenerator::Third => 3.0,
            };
            let mut b = Builder::new();
            let arguments =
                [b.input(0).ok()?, b.input(1).ok()?, b.input(2).ok()?, b.constant(generator).ok()?];
            let root = b.call(&noise(rows)?, &arguments).ok()?;
            Some(b.finish(root, 3))
        }
        78.0 => noise(rows),
        29.0 => made(Draft::hetero_multifractal),
        58.0 => made(Draft::ridge),
        59.0 => made(Draft::ridged_multifractal),
        _ => None,
    }
}

/// Checks the arguments of a call of one of these functions. `None` stands for an argument that is
/// not known when the call is read.
pub(super) fn check(number: u32, arguments: &[Option<f64>]) -> Result<(), String> {
    let known = |index: usize, what: &str| match arguments.get(index) {
        Some(Some(value)) => Ok(*value),
        _ => Err(format!("not supported yet: {what} that is not known when the call is read")),
    };
    let octaves = match number {
        58 => Some(4),
        29 | 59 => Some(5),
        _ => None,
    };
    if let Some(index) = octaves {
        let octaves = known(index, "a number of octaves")?;
        if octaves > f64::from(MOST_OCTAVES) {
            return Err(format!(
                "not supported yet: {octaves} octaves; at most {MOST_OCTAVES} are supported"
            ));
        }
    }
    known(arguments.len() - 1, "a noise generator")?;
    Ok(())
}
