//! Colours: `rgb` and its variants, `color red 1`, `color Name filter 0.5`.

use durer_math::elementary;

use crate::diagnostics::Result;
use crate::keywords::Keyword;
use crate::parser::{Item, Parser};
use crate::value::{Terms, Value};

/// Red, green, blue, filter, transmit.
pub(crate) type Colour = [f64; 5];

/// Whether `keyword` can begin a colour and nothing else.
pub(crate) fn begins_colour(keyword: Keyword) -> bool {
    use Keyword::*;
    matches!(
        keyword,
        Color
            | Rgb
            | Rgbf
            | Rgbt
            | Rgbft
            | Srgb
            | Srgbf
            | Srgbt
            | Srgbft
            | Red
            | Green
            | Blue
            | Filter
            | Transmit
    )
}

impl Parser<'_> {
    /// Whether a colour can begin here: with one of its words, or with a value that can be a
    /// colour.
    pub(crate) fn starts_colour(&mut self) -> Result<bool> {
        Ok(match self.peek()? {
            Item::Word(keyword) => begins_colour(*keyword),
            Item::Value(Value::Number(terms)) => terms.len() == 5,
            _ => false,
        })
    }

    /// Reads a colour in any of its forms.
    pub(crate) fn colour(&mut self) -> Result<Colour> {
        self.take_word(Keyword::Color)?;
        let mut colour = match self.peek_word()? {
            Some(Keyword::Red | Keyword::Green | Keyword::Blue | Keyword::Filter | Keyword::Transmit) => {
                [0.0; 5]
            }
            Some(keyword) if begins_colour(keyword) => {
                self.next()?;
                let value = self.expression()?;
                self.coloured(keyword, value)
            }
            _ => self.expression()?.all(),
        };
        self.colour_parts(&mut colour)?;
        Ok(colour)
    }

    /// Reads `red 1`, `filter 0.5` and the like, which change components of a colour.
    pub(crate) fn colour_parts(&mut self, colour: &mut Colour) -> Result<()> {
        loop {
            let index = match self.peek_word()? {
                Some(Keyword::Red) => 0,
                Some(Keyword::Green) => 1,
                Some(Keyword::Blue) => 2,
                Some(Keyword::Filter) => 3,
                Some(Keyword::Transmit) => 4,
                _ => break,
            };
            self.next()?;
            colour[index] = self.float()?;
        }
        let place = self.here();
        for part in *colour {
            crate::expression::finite(part, place)?;
        }
        Ok(())
    }

    /// The colour for a word such as `rgb` and the terms after it.
    fn coloured(&self, keyword: Keyword, value: Terms) -> Colour {
        use Keyword::{Rgbf, Rgbft, Rgbt, Srgb, Srgbf, Srgbft, Srgbt};
        let mut colour = if value.len() == 5 {
            value.all()
        } else {
            let wanted = match keyword {
                Rgbf | Rgbt | Srgbf | Srgbt => 4,
                Rgbft | Srgbft => 5,
                _ => 3,
            };
            // Several terms are padded with zeros; a single one has been repeated.
            let [r, g, b, fourth, fifth] = Terms::new(value.promoted(wanted).as_slice()).promoted(5).all();
            match keyword {
                Rgbt | Srgbt => [r, g, b, 0.0, fourth],
                _ => [r, g, b, fourth, fifth],
            }
        };
        if matches!(keyword, Srgb | Srgbf | Srgbt | Srgbft) {
            for part in &mut colour[..3] {
                *part = self.language.working_from_srgb(*part);
            }
        }
        colour
    }
}

/// Decodes the sRGB curve (IEC 61966-2-1).
pub(crate) fn srgb_decoded(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { elementary::pow((value + 0.055) / 1.055, 2.4) }
}
