//! Functions with vector values: `function { spline { } }`, `function { transform { } }`,
//! `function { pigment { } }`.
//!
//! Inside other functions, a component of the value is named after the call (`F(x, y, z).red`). In
//! expressions the value has all components.

use durer_formula::{Builder, Formula, FormulaError};

use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::formula::check_count;
use crate::keywords::Keyword;
use crate::parser::Parser;
use crate::pattern_function::moved;
use crate::sampled::Called;
use crate::value::Terms;

/// The weights of red, green and blue in grey.
const GRAY: [f64; 3] = [0.297, 0.589, 0.114];

/// The weights of red and green in a height: two digits to the base 256.
const HEIGHT: [f64; 2] = [255.0 / 256.0, 1.0 / 256.0];

/// A function whose value is a vector of two to five components.
#[derive(Clone, Debug)]
pub(crate) struct VectorFunction {
    /// One function for each component, all with the same inputs.
    parts: Vec<Called>,
}

impl VectorFunction {
    pub(crate) fn new(parts: Vec<Called>) -> Self {
        Self { parts }
    }

    /// The number of its arguments.
    pub(crate) fn inputs(&self) -> usize {
        self.parts.first().map_or(0, |part| part.inputs() as usize)
    }

    /// The number of steps of all components.
    pub(crate) fn steps(&self) -> usize {
        self.parts.iter().map(Called::steps).sum()
    }

    /// The bytes that it holds.
    pub(crate) fn held(&self) -> usize {
        self.parts.iter().map(Called::held).sum()
    }

    /// The component for a word after a dot, as a sum of functions with their weights.
    pub(crate) fn part(&self, word: Keyword) -> Option<Vec<(f64, &Called)>> {
        if word == Keyword::Gray {
            let colours = self.parts.get(..3)?;
            return Some(GRAY.into_iter().zip(colours).collect());
        }
        Some(vec![(1.0, self.parts.get(index(word)?)?)])
    }

    /// The height, `.hf`, of a pigment's colour, as a sum of functions with their weights.
    pub(crate) fn height(&self) -> Option<Vec<(f64, &Called)>> {
        Some(HEIGHT.into_iter().zip(self.parts.get(..2)?).collect())
    }
}

/// The index of the component with this name.
fn index(word: Keyword) -> Option<usize> {
    Some(match word {
        Keyword::X | Keyword::U | Keyword::Red => 0,
        Keyword::Y | Keyword::V | Keyword::Green => 1,
        Keyword::Z | Keyword::Blue => 2,
        Keyword::T | Keyword::Filter => 3,
        Keyword::Transmit => 4,
        _ => return None,
    })
}

/// The error of a vector where a float is wanted.
pub(crate) fn wants_part(place: Place) -> Box<Error> {
    Error::invalid(
        place,
        "this function returns a vector: choose a component, as in F(x).y or F(x, y, z).red",
    )
}

impl Parser<'_> {
    /// Reads the body of a function, if it is one with vector values.
    pub(crate) fn vector_function(&mut self, has_parameters: bool) -> Result<Option<VectorFunction>> {
        let Some(word @ (Keyword::Spline | Keyword::Transform | Keyword::Pigment)) = self.peek_word()? else {
            return Ok(None);
        };
        let place = self.here();
        if has_parameters {
            let text = format!(
                "a function of a {0} takes no parameter list: write `function {{ {0} {{ ... }} }}`",
                word.text()
            );
            return Err(Error::invalid(place, text));
        }
        let parts = match word {
            Keyword::Spline => self.spline_function()?.into_iter().map(Called::from).collect(),
            Keyword::Pigment => self.pigment_function()?,
            _ => {
                self.next()?;
                let map = self.nested(Self::transform_block)?;
                let formulas = || -> std::result::Result<Vec<Formula>, FormulaError> {
                    let mut b = Builder::new();
                    let p = [b.input(0)?, b.input(1)?, b.input(2)?];
                    Ok(moved(&mut b, p, &map)?.map(|part| b.finish(part, 3)).to_vec())
                };
                let parts =
                    formulas().map_err(|error| Error::at(place, ErrorKind::Limit, error.to_string()))?;
                parts.into_iter().map(Called::from).collect()
            }
        };
        Ok(Some(VectorFunction::new(parts)))
    }

    /// Evaluates a function that is called in an expression, after its name.
    pub(crate) fn called_vector(&mut self, function: &VectorFunction, place: Place) -> Result<Terms> {
        let arguments = self.float_arguments()?;
        check_count(arguments.len(), function.inputs(), place)?;
        self.count_steps(function.steps() as u64, place)?;
        let values: Vec<f64> = {
            let context = self.texture_context();
            function.parts.iter().map(|part| part.value(&arguments, context)).collect()
        };
        if values.iter().any(|value| value.is_nan()) {
            return Err(Error::invalid(place, "this function is undefined here"));
        }
        Ok(Terms::new(&values))
    }
}
