//! The functions that functions.inc gives names to, by their numbers.

use std::borrow::Cow;

use durer_formula::noise::NoiseTable;

use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::formulas::{self, Lacking};
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::sampled::Called;

impl Parser<'_> {
    /// `internal(n)`: one of the functions that functions.inc gives names to.
    pub(crate) fn internal_function(&mut self) -> Result<Called> {
        self.next()?;
        let place = self.here();
        self.expect(Mark::ParenOpen)?;
        let number = self.float()?;
        self.expect(Mark::ParenClose)?;
        self.made_internal_function(number, place)
    }

    /// A function that the scene calls; the noise itself follows the scene's generator.
    pub(crate) fn as_of_now<'c>(&mut self, called: &'c Called, place: Place) -> Result<Cow<'c, Called>> {
        match called.scene_noise {
            Some(made) if made != self.language.noise_generator() => {
                self.made_internal_function(formulas::PLAIN_NOISE, place).map(Cow::Owned)
            }
            _ => Ok(Cow::Borrowed(called)),
        }
    }

    /// The internal function with this number, of the scene's noise generator.
    fn made_internal_function(&mut self, number: f64, place: Place) -> Result<Called> {
        let is_plain = number == formulas::PLAIN_NOISE;
        let tables = self.noise_tables();
        let rows = tables.map_or_else(NoiseTable::own_rows, |tables| tables.rows);
        let generator = self.language.noise_generator();
        match formulas::internal(number, generator, rows) {
            Ok((formula, noisy)) => {
                let table = tables.map(|tables| tables.components[0]);
                let mut called = Called::from(formula.with_noise(table));
                called.noisy = noisy;
                called.scene_noise = is_plain.then_some(generator);
                Ok(called)
            }
            Err(Lacking::Unknown) => {
                Err(Error::invalid(place, format!("there is no internal function {number}")))
            }
            Err(Lacking::NotYet(why)) => Err(Error::at(
                place,
                ErrorKind::Unsupported,
                format!("not supported yet: internal({number}): {why}"),
            )),
        }
    }
}
