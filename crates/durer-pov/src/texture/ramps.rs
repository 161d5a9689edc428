//! Patterns with numbers of their own: spirals, fractals, crackle and others.

use std::rc::Rc;
use std::sync::Arc;

use durer_math::{Point3, Vec3};
use durer_scene::{CornerLook, Crackle, Fractal, FractalMap, GridBetween, Pavement, Ramp, Slope, SlopeTo};

use super::PatternKind;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::value::Value;

/// POV-Ray's limits on the exponent of a fractal.
const EXPONENTS: std::ops::RangeInclusive<f64> = 2.0..=33.0;

/// The greatest number of iterations of a fractal that is not refused.
const MOST_ITERATIONS: f64 = 1e9;

impl Parser<'_> {
    /// Reads the word of a pattern with numbers of its own, and the numbers that follow it.
    pub(super) fn ramp_kind(&mut self) -> Result<Option<PatternKind>> {
        let Some(word) = self.peek_word()? else { return Ok(None) };
        let place = self.here();
        let ramp = match word {
            Keyword::Spiral1 | Keyword::Spiral2 => {
                self.next()?;
                Ramp::Spiral { arms: self.float()?, double: word == Keyword::Spiral2, turbulence: None }
            }
            Keyword::Quilted => {
                self.next()?;
                Ramp::Quilted(1.0, 1.0)
            }
            Keyword::Crackle => {
                self.next()?;
                let form = Vec3::new(-1.0, 1.0, 0.0);
                Ramp::Crackle(Crackle { form, metric: 2.0, offset: 0.0, solid: false, generator: None })
            }
            Keyword::Mandel | Keyword::Julia => Ramp::Fractal(self.fractal(FractalMap::Power(2))?),
            Keyword::Magnet => {
                self.next()?;
                let number = self.float()?;
                let map = match number {
                    1.0 => FractalMap::Magnet1,
                    2.0 => FractalMap::Magnet2,
                    _ => return Err(Error::invalid(place, format!("magnet is 1 or 2, not {number}"))),
                };
                Ramp::Fractal(self.fractal(map)?)
            }
            Keyword::Slope => {
                self.next()?;
                Ramp::Slope(self.nested(Self::slope)?)
            }
            Keyword::Tiling => {
                self.next()?;
                let number = self.float()?;
                if !(1.0..28.0).contains(&number) {
                    return Err(Error::invalid(
                        place,
                        format!("tilings have numbers from 1 to 27, not {number}"),
                    ));
                }
                Ramp::Tiling(number as u8)
            }
            Keyword::Pavement => {
                self.next()?;
                Ramp::Pavement(Pavement {
                    sides: 3,
                    tiles: 1,
                    pattern: 1,
                    exterior: CornerLook::Sharp,
                    interior: CornerLook::Sharp,
                    form: Some(CornerLook::Sharp),
                })
            }
            Keyword::Aoi => {
                self.next()?;
                Ramp::Aoi
            }
            Keyword::Function => return self.function_kind(place).map(Some),
            Keyword::ImagePattern => {
                self.next()?;
                let read = self.image_block()?;
                Ramp::Image(read.map, read.value)
            }
            Keyword::DensityFile => {
                self.next()?;
                Ramp::Density(self.density_grid()?, GridBetween::Nearest)
            }
            Keyword::PigmentPattern => {
                self.next()?;
                let pigment = self.nested(|r| r.pigment_block(&super::Pigment::default()))?;
                self.check_map_depth(1 + pigment.depth())?;
                return Ok(Some(PatternKind::GreyOf(Rc::new(pigment))));
            }
            _ => return Ok(None),
        };
        Ok(Some(PatternKind::Ramp(Rc::new(ramp), place)))
    }

    /// Reads `function { ... }` as a pattern.
    fn function_kind(&mut self, place: Place) -> Result<PatternKind> {
        match self.function_block()? {
            Value::Function(called) if called.inputs() <= 3 => {
                let ramp = match called.plain() {
                    Some(formula) => Ramp::Formula(Arc::new(formula.clone())),
                    None => Ramp::Sampled(Arc::new(called.scene())),
                };
                Ok(PatternKind::Ramp(Rc::new(ramp), place))
            }
            _ => Err(Error::invalid(place, "the function of a pattern gives one number for x, y and z")),
        }
    }

    /// Reads `{ DIRECTION [, LOW, HIGH] [altitude AXIS [, LOW, HIGH]] }` or `{ point_at POINT [, LOW, HIGH] }`.
    ///
    /// The braces may be left out, as in scenes of older versions.
    fn slope(&mut self) -> Result<Slope> {
        let has_braces = self.take_mark(Mark::BraceOpen)?;
        let is_point = self.take_word(Keyword::PointAt)?;
        self.peek()?;
        let place = self.here();
        let [x, y, z] = self.vector()?;
        let to = if is_point {
            SlopeTo::Point(Point3::new(x, y, z))
        } else if [x, y, z] == [0.0; 3] {
            return Err(Error::invalid(place, "a slope needs a direction that is not zero"));
        } else {
            SlopeTo::Direction(Vec3::new(x, y, z))
        };
        let range = self.slope_range(has_braces)?;
        let mut altitude = None;
        if !is_point && self.take_word(Keyword::Altitude)? {
            let [x, y, z] = self.vector()?;
            if [x, y, z] == [0.0; 3] {
                return Err(Error::invalid(
                    place,
                    "the altitude of a slope needs a direction that is not zero",
                ));
            }
            altitude = Some((Vec3::new(x, y, z), self.slope_range(has_braces)?));
        }
        if has_braces {
            self.expect(Mark::BraceClose)?;
        }
        Ok(Slope { to, range, altitude })
    }

    /// Reads two different numbers, if a comma or a number follows; 0 and 1 if not.
    fn slope_range(&mut self, has_braces: bool) -> Result<[f64; 2]> {
        // Without braces a number is the amount of a normal.
        let has_comma = self.take_mark(Mark::Comma)?;
        if !(has_comma || has_braces) || !self.starts_number()? {
            return Ok([0.0, 1.0]);
        }
        self.peek()?;
        let place = self.here();
        let low = self.float()?;
        self.skip_comma()?;
        let high = self.float()?;
        if low == high {
            let text = format!("a range of slopes or heights from {low} to {high} is empty");
            return Err(Error::invalid(place, text));
        }
        Ok([low, high])
    }

    /// Reads `mandel N` or `julia <re, im>, N`.
    fn fractal(&mut self, map: FractalMap) -> Result<Fractal> {
        let lexeme = self.next()?;
        let constant = match lexeme.item {
            crate::parser::Item::Word(Keyword::Mandel) => None,
            crate::parser::Item::Word(Keyword::Julia) => {
                let [re, im, ..] = self.vector()?;
                self.skip_comma()?;
                Some((re, im))
            }
            _ => return Err(self.unexpected(&lexeme, "mandel or julia")),
        };
        let place = self.here();
        let count = self.float()?;
        if !(1.0..=MOST_ITERATIONS).contains(&count) {
            let text = format!("a fractal has 1 to {MOST_ITERATIONS} iterations, not {count}");
            return Err(Error::invalid(place, text));
        }
        let (exterior, interior) = ((1, 1.0), (0, 1.0));
        Ok(Fractal { map, constant, iterations: count as u32, exterior, interior })
    }

    /// Reads a modifier that belongs to a pattern with numbers of its own.
    pub(super) fn ramp_modifier(&mut self, kind: Option<&mut PatternKind>) -> Result<bool> {
        let Some(word) = self.peek_word()? else { return Ok(false) };
        let place = self.here();
        let Some(PatternKind::Ramp(ramp, _)) = kind else { return Ok(false) };
        match (word, Rc::make_mut(ramp)) {
            (Keyword::Interpolate, Ramp::Density(_, between)) => {
                self.next()?;
                let kind = self.float()?;
                *between = match kind {
                    0.0 => GridBetween::Nearest,
                    1.0 => GridBetween::Linear,
                    2.0 => GridBetween::Cubic,
                    _ => {
                        let text = format!("interpolate of a density_file is 0, 1 or 2, not {kind}");
                        return Err(Error::invalid(place, text));
                    }
                };
            }
            (Keyword::Control0, Ramp::Quilted(bottom, _)) => {
                self.next()?;
                *bottom = self.float()?;
            }
            (Keyword::Control1, Ramp::Quilted(_, top)) => {
                self.next()?;
                *top = self.float()?;
            }
            (Keyword::Form, Ramp::Crackle(crackle)) => {
                self.next()?;
                let [x, y, z] = self.vector()?;
                crackle.form = Vec3::new(x, y, z);
            }
            (Keyword::Metric, Ramp::Crackle(crackle)) => {
                self.next()?;
                let metric = self.float()?;
                if metric <= 0.0 {
                    let text = format!("the metric of crackle must be positive, not {metric}");
                    return Err(Error::invalid(place, text));
                }
                crackle.metric = metric;
            }
            (Keyword::Offset, Ramp::Crackle(crackle)) => {
                self.next()?;
                crackle.offset = self.float()?;
            }
            (Keyword::Solid, Ramp::Crackle(crackle)) => {
                self.next()?;
                crackle.solid = self.switch_value()?;
            }
            (Keyword::Exponent, Ramp::Fractal(set)) => {
                self.next()?;
                let exponent = self.float()?;
                if !EXPONENTS.contains(&exponent) || !matches!(set.map, FractalMap::Power(_)) {
                    let text = format!("the exponent of mandel or julia is 2 to 33, not {exponent}");
                    return Err(Error::invalid(place, text));
                }
                set.map = FractalMap::Power(exponent as u32);
            }
            (Keyword::Exterior | Keyword::Interior, Ramp::Fractal(set)) => {
                self.next()?;
                let kind = self.float()?;
                if !(0.0..=6.0).contains(&kind) {
                    let text = format!("{} of a fractal is 0 to 6, not {kind}", word.text());
                    return Err(Error::invalid(place, text));
                }
                self.skip_comma()?;
                let both = (kind as u8, self.float()?);
                if word == Keyword::Exterior { set.exterior = both } else { set.interior = both }
            }
            (_, Ramp::Pavement(pavement)) => return self.pavement_modifier(word, pavement),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Reads a modifier of a pavement. Numbers lose their fractions (a fact of the language).
    fn pavement_modifier(&mut self, word: Keyword, pavement: &mut Pavement) -> Result<bool> {
        use Keyword::{Exterior, Form, Interior, NumberOfSides, NumberOfTiles, Pattern};
        if !matches!(word, Exterior | Form | Interior | NumberOfSides | NumberOfTiles | Pattern) {
            return Ok(false);
        }
        self.next()?;
        let place = self.here();
        let number = self.float()?.trunc();
        // The last two bits count (a fact of the language).
        let look = match number as i64 & 3 {
            1 => Some(CornerLook::Cut),
            2 => Some(CornerLook::Round),
            3 => None,
            _ => Some(CornerLook::Sharp),
        };
        match word {
            Exterior => pavement.exterior = look.unwrap_or(CornerLook::Sharp),
            Interior => pavement.interior = look.unwrap_or(CornerLook::Sharp),
            Form => pavement.form = look,
            NumberOfSides if ![3.0, 4.0, 6.0].contains(&number) => {
                let text = format!("the cells of a pavement have 3, 4 or 6 sides, not {number}");
                return Err(Error::invalid(place, text));
            }
            NumberOfSides => pavement.sides = number as u8,
            // `as` rounds a number beyond 255 to 255, which `Pavement` refuses, too.
            NumberOfTiles => pavement.tiles = number as u8,
            _ => pavement.pattern = number as u8,
        }
        Ok(true)
    }
}
