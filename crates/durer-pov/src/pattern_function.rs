//! `function { pattern { ... } }`: patterns that have a formula, as functions of `x`, `y`, `z`.
//!
//! ```text
//!   wave(begun anew(frequency * value(M^-1 p) + phase)),  M: the transforms behind the pattern's word
//! ```
//!
//! Values are those of POV-Ray, to rounding.

use durer_scene::tape::{Builder, Formula, NodeId, Op};

use crate::diagnostics::{Fault, FaultKind, Place, Result};
use crate::formulas;
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::reader::Reader;
use crate::texture::{Pattern, PatternKind, Wave};
use crate::transform::{self, Matrix};

/// What a gradient says of `P0 x + P1 y + P2 z`, of which the direction has length 1.
const GRADIENT: &str = "g = x*P0 + y*P1 + z*P2; select(g - 1, g, g, g - floor(g))";

/// A value that is bent begins anew a little behind 1, so that 1 itself is still the end.
const BEGUN_ANEW: &str = "t = rem(x*P0 + P1, 1.00001); select(t, t + 1, t, t)";
/// The same where the frequency is zero, which means none.
const AS_IT_IS: &str = "select(x, x - floor(x), x, x)";

/// The value of a pattern by its word, and the wave that it has by itself; `None` where no formula is known here.
fn value(word: Keyword) -> Option<(&'static str, Wave)> {
    let text = match word {
        // Cells begin a little before a whole number. Each axis changes the sign from one to the next; what it chooses is exact.
        Keyword::Checker => {
            "a = x + 0.0000000001; b = y + 0.0000000001; c = z + 0.0000000001; \
             u = select(a - 2*floor(a/2) - 1, 1, -1, -1); v = select(b - 2*floor(b/2) - 1, 1, -1, -1); \
             w = select(c - 2*floor(c/2) - 1, 1, -1, -1); select(u*v*w, 1, 1, 0)"
        }
        Keyword::Spherical => "max(1 - sqrt(x*x + y*y + z*z), 0)",
        Keyword::Cylindrical => "max(1 - sqrt(x*x + z*z), 0)",
        Keyword::Planar => "max(1 - abs(y), 0)",
        Keyword::Boxed => "max(1 - max(abs(x), abs(y), abs(z)), 0)",
        Keyword::Onion => "r = sqrt(x*x + y*y + z*z); r - floor(r)",
        Keyword::Leopard => "sq((sin(x) + sin(y) + sin(z))/3)",
        Keyword::Radial => "0.25 + (atan2(x, z) + pi)/(2*pi)",
        Keyword::Marble => return Some(("x", Wave::Triangle)),
        _ => return None,
    };
    Some((text, Wave::Ramp))
}

/// How a wave bends `x`.
fn bent(wave: Wave) -> (&'static str, Option<f64>) {
    match wave {
        Wave::Ramp => ("x", None),
        Wave::Triangle => ("1 - abs(2*x - 1)", None),
        Wave::Sine => ("(1 + sin(2*pi*x))/2", None),
        Wave::Scallop => ("abs(sin(pi*x))", None),
        Wave::Cubic => ("x*x*(3 - 2*x)", None),
        Wave::Poly(exponent) => ("pow(x, P0)", Some(exponent)),
    }
}

impl Reader<'_> {
    /// `pattern { ... }`, the word included.
    pub(crate) fn pattern_function(&mut self) -> Result<Formula> {
        let place = self.here();
        self.next()?;
        self.expect(Mark::BraceOpen)?;
        let formula = self.nested(|r| r.pattern_function_items(place))?;
        self.expect(Mark::BraceClose)?;
        Ok(formula)
    }

    fn pattern_function_items(&mut self, place: Place) -> Result<Formula> {
        let mut direction = Vec::new();
        let known = match self.peek_word()? {
            Some(Keyword::Gradient) => {
                if let Some(PatternKind::Gradient(along)) = self.pattern_kind()? {
                    let length = transform::length(along);
                    direction = along.map(|part| part / length).to_vec();
                }
                Some((GRADIENT, Wave::Ramp))
            }
            Some(word) => {
                let known = value(word);
                if known.is_some() {
                    self.next()?;
                }
                known
            }
            None => None,
        };
        let Some((text, wave)) = known else { return Err(lacking(place)) };
        // Which kind it is says what its modifiers may be: those of a brick belong to no other.
        let mut pattern = Pattern { wave, ..Pattern::new(PatternKind::Checker) };
        while !self.at_mark(Mark::BraceClose)? {
            if let Some(by) = self.transform_item()? {
                pattern.transform(&by);
            } else if !self.pattern_modifier(&mut pattern)? {
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, "a transform, or what changes the pattern's value"));
            }
        }
        let Some(back) = pattern.place.inverse() else {
            return Err(Fault::invalid(place, "the pattern's transforms cannot be undone"));
        };
        written(text, &direction, &pattern, &back).ok_or_else(|| lacking(place))
    }
}

fn lacking(place: Place) -> Box<Fault> {
    let text = "not supported yet: this pattern as a function: no bound of its values over a box is known, which an exact root needs";
    Fault::at(place, FaultKind::Unsupported, text)
}

/// The whole formula.
fn written(text: &'static str, direction: &[f64], pattern: &Pattern, back: &Matrix) -> Option<Formula> {
    let mut b = Builder::new();
    let p = [b.input(0).ok()?, b.input(1).ok()?, b.input(2).ok()?];
    let own = moved(&mut b, p, back)?;
    let value = called(&mut b, text, own, direction)?;
    // The language keeps these two in single precision.
    let [frequency, phase] = [pattern.frequency, pattern.phase].map(|v| f64::from(v as f32));
    let value = if frequency == 0.0 {
        called(&mut b, AS_IT_IS, [value; 3], &[])?
    } else {
        called(&mut b, BEGUN_ANEW, [value; 3], &[frequency, phase])?
    };
    let (wave, exponent) = bent(pattern.wave);
    let root = called(&mut b, wave, [value; 3], exponent.as_slice())?;
    Some(b.finish(root, 3))
}

/// The value of a formula on paper at a place, with these parameters.
fn called(b: &mut Builder, text: &'static str, place: [NodeId; 3], parameters: &[f64]) -> Option<NodeId> {
    let mut inputs = place.to_vec();
    for &parameter in parameters {
        inputs.push(b.constant(parameter).ok()?);
    }
    b.call(&formulas::on_paper(text, parameters.len() as u32)?, &inputs).ok()
}

/// The image of a point.
fn moved(b: &mut Builder, p: [NodeId; 3], by: &Matrix) -> Option<[NodeId; 3]> {
    let offset = by.point([0.0; 3]);
    let columns =
        [by.direction([1.0, 0.0, 0.0]), by.direction([0.0, 1.0, 0.0]), by.direction([0.0, 0.0, 1.0])];
    let mut image = p;
    for axis in 0..3 {
        let mut sum = b.constant(offset[axis]).ok()?;
        for (x, column) in p.into_iter().zip(columns).filter(|(_, column)| column[axis] != 0.0) {
            let factor = b.constant(column[axis]).ok()?;
            let term = b.push(Op::Mul(x, factor)).ok()?;
            sum = b.push(Op::Add(sum, term)).ok()?;
        }
        image[axis] = sum;
    }
    Some(image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_formula_can_be_read() {
        use Keyword::{Boxed, Checker, Cylindrical, Leopard, Marble, Onion, Planar, Radial, Spherical};
        let words = [Checker, Spherical, Cylindrical, Planar, Boxed, Onion, Leopard, Radial, Marble];
        for word in words {
            assert!(value(word).and_then(|(text, _)| formulas::on_paper(text, 0)).is_some(), "{word:?}");
        }
        let waves = [Wave::Ramp, Wave::Triangle, Wave::Sine, Wave::Scallop, Wave::Cubic, Wave::Poly(2.0)];
        for wave in waves {
            let (text, exponent) = bent(wave);
            assert!(formulas::on_paper(text, exponent.iter().len() as u32).is_some(), "{wave:?}");
        }
        for (text, parameters) in [(GRADIENT, 3), (BEGUN_ANEW, 2), (AS_IT_IS, 0)] {
            assert!(formulas::on_paper(text, parameters).is_some(), "{text}");
        }
    }
}
