//! `function { pattern { ... } }`: patterns as functions of `x`, `y`, `z`.
//!
//! Patterns that have a formula without noise become that formula:
//!
//! ```text
//!   wave(begun anew(frequency * value(M^-1 p) + phase)),  M: the transforms behind the pattern's word
//! ```
//!
//! The values are those of POV-Ray, to rounding. Patterns with a list of entries have the values 0,
//! 1, ..., and a frequency only if one is given. All others are evaluated as in pigments. The function
//! of a surface needs bounds: there noise patterns are formulas of durer's own noise, and what has no
//! formula is refused.

use std::sync::Arc;

use durer_formula::noise::Nearest;
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_scene::{Crackle, Ramp, TextureSource};

use crate::diagnostics::{self, Error, ErrorKind, Place};
use crate::formulas;
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::noise_pattern;
use crate::parser::Parser;
use crate::sampled::Called;
use crate::scene_builder;
use crate::texture::{Pattern, PatternKind, Wave};
use crate::texture_builder;
use crate::transform::{self, Matrix};

/// The value of a gradient for `P0 x + P1 y + P2 z`; the direction has length 1.
const GRADIENT: &str = "g = x*P0 + y*P1 + z*P2; select(g - 1, g, g, g - floor(g))";

/// A value that goes through a wave repeats a little after 1, so that 1 itself is still the end.
const BEGUN_ANEW: &str = "t = rem(x*P0 + P1, 1.00001); select(t, t + 1, t, t)";
/// The value if the frequency is zero, which means none.
const AS_IT_IS: &str = "select(x, x - floor(x), x, x)";

/// Cells begin slightly before an integer. On each axis the sign alternates from cell to cell; the
/// choices are exact.
const CHECKER: &str = "a = x + 0.0000000001; b = y + 0.0000000001; c = z + 0.0000000001; \
                       u = select(a - 2*floor(a/2) - 1, 1, -1, -1); v = select(b - 2*floor(b/2) - 1, 1, -1, -1); \
                       w = select(c - 2*floor(c/2) - 1, 1, -1, -1); select(u*v*w, 1, 1, 0)";

/// The nearest centre of the hexagons with sides of length 1. The centres form two rectangular
/// lattices, `(3 m, 2 h n)` and `(3 i + 3/2, 2 h j + h)` for integers. The three values alternate
/// along `z`.
const HEXAGON: &str = "h = 0.8660254037844386; m = floor(x/3 + 0.5); n = floor(z/(2*h) + 0.5); i = floor(x/3); j = floor(z/(2*h)); \
                       nearer = sq(x - 3*m) + sq(z - 2*h*n) - sq(x - 3*i - 1.5) - sq(z - 2*h*j - h); \
                       k = select(nearer, n, n, j + 2); max(min(k - 3*floor((k + 0.5)/3), 2), 0)";

/// 0 in mortar, 1 in bricks of `P0` by `P1` by `P2`, of which `P3` is mortar. Every other course
/// along `y` is shifted by half a brick along `x`, the others along `z`. Like the cells of the
/// checker, bricks begin slightly before an integer.
const BRICK: &str = "d = 0.0000000001; b = y/P1; course = floor(b + d); odd = course - 2*floor(course/2); \
                     a = x/P0 + odd/2; c = z/P2 + (1 - odd)/2; \
                     u = select(a - floor(a + d) - (P0 - P3)/P0, 1, 0, 0); \
                     v = select(b - floor(b + d) - (P1 - P3)/P1, 1, 0, 0); \
                     w = select(c - floor(c + d) - (P2 - P3)/P2, 1, 0, 0); u*v*w";

/// The formula of a pattern by its word; `None` if no formula is known.
fn value(word: Keyword) -> Option<&'static str> {
    Some(match word {
        Keyword::Spherical => "max(1 - sqrt(x*x + y*y + z*z), 0)",
        Keyword::Cylindrical => "max(1 - sqrt(x*x + z*z), 0)",
        Keyword::Planar => "max(1 - abs(y), 0)",
        Keyword::Boxed => "max(1 - max(abs(x), abs(y), abs(z)), 0)",
        Keyword::Onion => "r = sqrt(x*x + y*y + z*z); r - floor(r)",
        Keyword::Leopard => "sq((sin(x) + sin(y) + sin(z))/3)",
        Keyword::Radial => "0.25 + (atan2(x, z) + pi)/(2*pi)",
        _ => return None,
    })
}

/// Whether the word is that of a pattern with a map and without numbers of its own.
pub(crate) fn is_written(word: Keyword) -> bool {
    use Keyword::{Cells, Marble, Ripples, Waves, Wood};
    value(word).is_some()
        || noise_pattern::is_noise(word)
        || matches!(word, Marble | Wood | Cells | Ripples | Waves)
}

/// The wave that the word of a pattern sets.
pub(crate) fn own_wave(word: Keyword) -> Option<Wave> {
    matches!(word, Keyword::Marble | Keyword::Wood).then_some(Wave::Triangle)
}

/// The formula of a wave for `x`, and its parameter.
fn bent(wave: Wave) -> (&'static str, Option<f64>) {
    match wave {
        Wave::Ramp => ("x", None),
        // Without the limit, only the value 2 of hexagons would give less than zero.
        Wave::Triangle => ("max(1 - abs(2*x - 1), 0)", None),
        Wave::Sine => ("(1 + sin(2*pi*x))/2", None),
        Wave::Scallop => ("abs(sin(pi*x))", None),
        Wave::Cubic => ("x*x*(3 - 2*x)", None),
        Wave::Poly(exponent) => ("pow(x, P0)", Some(exponent)),
    }
}

impl Parser<'_> {
    /// Reads `pattern { ... }`, including the word.
    pub(crate) fn pattern_function(&mut self) -> diagnostics::Result<Called> {
        let place = self.here();
        self.next()?;
        self.expect(Mark::BraceOpen)?;
        let function = self.nested(|r| r.pattern_function_items(place))?;
        self.expect(Mark::BraceClose)?;
        Ok(function)
    }

    fn pattern_function_items(&mut self, place: Place) -> diagnostics::Result<Called> {
        let Some(kind) = self.pattern_kind(None)? else {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "a pattern"));
        };
        if let PatternKind::Ramp(ramp, at) = &kind
            && matches!(**ramp, Ramp::Slope(_) | Ramp::Aoi)
        {
            return Err(Error::invalid(*at, "this pattern belongs to a surface and cannot be a function"));
        }
        let mut pattern = self.plain_pattern(kind);
        while !self.at_mark(Mark::BraceClose)? {
            if let Some(by) = self.transform_item()? {
                pattern.modifiers.transform(&by);
            } else if !self.pattern_modifier(Some(&mut pattern.kind), &mut pattern.modifiers)? {
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, "a transform, or what changes the pattern's value"));
            }
        }
        let formula = || {
            let mut b = Builder::new();
            let p = [b.input(0).ok()?, b.input(1).ok()?, b.input(2).ok()?];
            let own = moved(&mut b, p, &pattern.modifiers.place.inverse()?).ok()?;
            let own = noise_pattern::warped(&mut b, &pattern, own)?;
            let root = written(&mut b, &pattern, own)?;
            Some(b.finish(root, 3))
        };
        if pattern.modifiers.place.inverse().is_none() {
            return Err(Error::invalid(place, NOT_INVERTIBLE));
        }
        let exact = formula();
        self.language.noise_is_used |= exact.as_ref().is_some_and(has_noise);
        match exact {
            Some(formula) if !is_made_of_chance(&formula) => Ok(formula.into()),
            exact => {
                let source = TextureSource::Pattern {
                    placement: scene_builder::placement(&pattern.modifiers.place, place)?,
                    warps: texture_builder::warps_of(&pattern, place)?,
                    value: texture_builder::value_of(&pattern, place)?,
                };
                let made = Called::texture(&Arc::new(source), 0, exact);
                made.map_err(|error| Error::at(place, ErrorKind::Limit, error.to_string()))
            }
        }
    }
}

/// The message for a pattern whose placement is not invertible.
pub(crate) const NOT_INVERTIBLE: &str = "the pattern's transforms cannot be inverted";

/// The message for a texture in the function of a surface, for which no formula is known.
pub(crate) fn lacking(place: Place) -> Box<Error> {
    let text = "not supported yet: this pattern or pigment in the function of a surface: durer cannot bound its values over a box, as exact intersections require";
    Error::at(place, ErrorKind::Unsupported, text)
}

/// Whether the formula depends on noise.
pub(crate) fn has_noise(formula: &Formula) -> bool {
    formula.ops().iter().any(|op| matches!(op, Op::Noise(..)))
}

/// Whether the formula depends on noise or random points: textures evaluate these faster.
fn is_made_of_chance(formula: &Formula) -> bool {
    formula.ops().iter().any(|op| matches!(op, Op::Noise(..) | Op::Nearest(..)))
}

/// The value of a pattern at a point in its own space with its warps; `None` if no formula is known.
pub(crate) fn written(b: &mut Builder, pattern: &Pattern, own: [NodeId; 3]) -> Option<NodeId> {
    let value = match pattern.kind {
        PatternKind::Checker => called(b, CHECKER, own, &[])?,
        PatternKind::Gradient(along) => {
            let length = transform::length(along);
            called(b, GRADIENT, own, &along.map(|part| part / length))?
        }
        PatternKind::Written(word, _) => match value(word) {
            Some(text) => called(b, text, own, &[])?,
            None => noise_pattern::value(b, pattern, own)?,
        },
        PatternKind::Hexagon => called(b, HEXAGON, own, &[])?,
        PatternKind::Brick { size: [x, y, z], mortar } => called(b, BRICK, own, &[x, y, z, mortar])?,
        PatternKind::Ramp(ref ramp, _) => match **ramp {
            Ramp::Crackle(crackle) => distances(b, crackle, own)?,
            _ => return None,
        },
        PatternKind::Square
        | PatternKind::Triangular
        | PatternKind::GreyOf(_)
        | PatternKind::Inside(..)
        | PatternKind::Materials(_)
        | PatternKind::Average => return None,
    };
    changed(b, pattern, value)
}

/// The value of `crackle`: the sum of the distances to the nearest three random points, each times
/// its part of the form, between 0 and 1.
fn distances(b: &mut Builder, crackle: Crackle, own: [NodeId; 3]) -> Option<NodeId> {
    // The noise of the nearest point jumps from one cell to the next.
    if crackle.solid {
        return None;
    }
    let mut sum = b.constant(0.0).ok()?;
    for (rank, part) in crackle.form.to_array().into_iter().enumerate().filter(|(_, part)| *part != 0.0) {
        let nearest = Nearest::shared(rank, crackle.metric, crackle.offset)?;
        let distance = b.push(Op::Nearest(nearest, own)).ok()?;
        let part = b.constant(part).ok()?;
        let term = b.push(Op::Mul(part, distance)).ok()?;
        sum = b.push(Op::Add(sum, term)).ok()?;
    }
    called(b, "min(max(x, 0), 1)", [sum; 3], &[])
}

/// The index into a list after frequency, phase and wave have changed `number`. The entry with this
/// index is shown, or a mixture of the two entries next to it.
pub(crate) fn changed_number(pattern: &Pattern, number: usize) -> Option<f64> {
    let mut b = Builder::new();
    let value = b.constant(number as f64).ok()?;
    let root = changed(&mut b, pattern, value)?;
    Some(b.finish(root, 0).value(&[]))
}

/// Applies frequency, phase and wave to a pattern's value.
fn changed(b: &mut Builder, pattern: &Pattern, value: NodeId) -> Option<NodeId> {
    // The language stores these two in single precision.
    let [frequency, phase] =
        [pattern.modifiers.frequency, pattern.modifiers.phase].map(|v| f64::from(v as f32));
    let value = if frequency == 0.0 {
        called(b, AS_IT_IS, [value; 3], &[])?
    } else {
        called(b, BEGUN_ANEW, [value; 3], &[frequency, phase])?
    };
    let (wave, exponent) = bent(pattern.modifiers.wave);
    called(b, wave, [value; 3], exponent.as_slice())
}

/// The value of a formula as on paper at a point, with these parameters.
fn called(b: &mut Builder, text: &'static str, place: [NodeId; 3], parameters: &[f64]) -> Option<NodeId> {
    let mut inputs = place.to_vec();
    for &parameter in parameters {
        inputs.push(b.constant(parameter).ok()?);
    }
    b.call(&formulas::on_paper(text, parameters.len() as u32)?, &inputs).ok()
}

/// The image of a point.
pub(crate) fn moved(b: &mut Builder, p: [NodeId; 3], by: &Matrix) -> Result<[NodeId; 3], FormulaError> {
    let offset = by.point([0.0; 3]);
    let columns =
        [by.direction([1.0, 0.0, 0.0]), by.direction([0.0, 1.0, 0.0]), by.direction([0.0, 0.0, 1.0])];
    let mut image = p;
    for axis in 0..3 {
        let mut sum = b.constant(offset[axis])?;
        for (x, column) in p.into_iter().zip(columns).filter(|(_, column)| column[axis] != 0.0) {
            let factor = b.constant(column[axis])?;
            let term = b.push(Op::Mul(x, factor))?;
            sum = b.push(Op::Add(sum, term))?;
        }
        image[axis] = sum;
    }
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_formula_can_be_read() {
        use Keyword::{Boxed, Cylindrical, Leopard, Onion, Planar, Radial, Spherical};
        let words = [Spherical, Cylindrical, Planar, Boxed, Onion, Leopard, Radial];
        for word in words {
            assert!(value(word).and_then(|text| formulas::on_paper(text, 0)).is_some(), "{word:?}");
        }
        let waves = [Wave::Ramp, Wave::Triangle, Wave::Sine, Wave::Scallop, Wave::Cubic, Wave::Poly(2.0)];
        for wave in waves {
            let (text, exponent) = bent(wave);
            assert!(formulas::on_paper(text, exponent.iter().len() as u32).is_some(), "{wave:?}");
        }
        let others = [(CHECKER, 0), (HEXAGON, 0), (BRICK, 4), (GRADIENT, 3), (BEGUN_ANEW, 2), (AS_IT_IS, 0)];
        for (text, parameters) in others {
            assert!(formulas::on_paper(text, parameters).is_some(), "{text}");
        }
    }
}
