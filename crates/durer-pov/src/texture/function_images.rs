//! Pictures made of a function or a pigment: `image_map { function 400, 300 { ... } }`.
//!
//! Facts of the scene language: the picture shows the unit square, its first column is at `x = 0` and its last one
//! at `x = 1`, its top row at `y = 0` and its bottom row at `y = 1`. Colours are kept in 16 bits, from 0 to 1, and
//! `filter` is dropped. The values of a function are grey; of values beyond 0 to 1 the fraction counts.

use durer_math::Point3;
use durer_scene::Rgb;

use super::Pigment;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::pattern_function::NOT_INVERTIBLE;
use crate::picture::colours::{Colours, FileGamma, Pixels};

/// The greatest number of columns or rows.
const MOST_PIXELS: f64 = 16384.0;

/// The levels of a channel of 16 bits.
const LEVELS: f64 = 65535.0;

/// A channel in 16 bits.
fn rounded(value: f64) -> f32 {
    ((value.clamp(0.0, 1.0) * LEVELS).round() / LEVELS) as f32
}

fn grey(value: f64) -> [f32; 4] {
    let within = if (0.0..=1.0).contains(&value) { value } else { value - value.floor() };
    let level = rounded(within);
    [level, level, level, 1.0]
}

impl Parser<'_> {
    /// Reads what follows the word `function`: the number of columns, the number of rows, and the block.
    pub(super) fn function_image(&mut self) -> Result<Colours> {
        let place = self.here();
        let columns = self.pixel_count()?;
        self.skip_comma()?;
        let rows = self.pixel_count()?;
        self.skip_comma()?;
        self.check_memory(columns * rows * size_of::<[f32; 4]>(), place)?;
        self.count_steps((columns * rows) as u64, place)?;
        self.expect(Mark::BraceOpen)?;
        let pixels = if self.take_word(Keyword::Pigment)? {
            let own = self.nested(|r| r.pigment_block(&Pigment::default()))?;
            self.expect(Mark::BraceClose)?;
            let colours = self.pigment_colours(&own, place)?;
            sampled([columns, rows], |[x, y]| {
                let colour = colours.at(Point3::new(x, y, 0.0));
                let Rgb { r, g, b } = colour.rgb;
                [r, g, b, 1.0 - colour.transmit].map(rounded)
            })
        } else {
            let function = self.function_behind_brace()?;
            match function.plain() {
                Some(formula) => sampled([columns, rows], |[x, y]| grey(formula.value(&[x, y, 0.0]))),
                None => {
                    let values = function.prepared(self.texture_context());
                    let values = values.ok_or_else(|| Error::invalid(place, NOT_INVERTIBLE))?;
                    sampled([columns, rows], |[x, y]| grey(values.value(&[x, y, 0.0])))
                }
            }
        };
        Ok(Colours { columns, rows, pixels: Pixels::Plain(pixels), gamma: FileGamma::Unknown })
    }

    fn pixel_count(&mut self) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        if !(1.0..=MOST_PIXELS).contains(&count.trunc()) {
            let text = format!("a picture has from 1 to {MOST_PIXELS} pixels a side, not {count}");
            return Err(Error::invalid(at, text));
        }
        Ok(count as usize)
    }
}

/// A value for each pixel, in rows from the top.
fn sampled([columns, rows]: [usize; 2], value: impl Fn([f64; 2]) -> [f32; 4]) -> Vec<[f32; 4]> {
    let at = |number: usize, count: usize| if count == 1 { 0.0 } else { number as f64 / (count - 1) as f64 };
    let places =
        (0..rows).flat_map(|row| (0..columns).map(move |column| [at(column, columns), at(row, rows)]));
    places.map(value).collect()
}
