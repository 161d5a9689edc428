//! `parametric`: a surface of three functions of u and v.

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;
use durer_formula::{Builder, Formula, FormulaError, Op};
use durer_math::Point3;
use durer_scene::{self as scene, Container, Parametric};
use std::sync::Arc;

impl Parser<'_> {
    /// `function, function, function <u1, v1>, <u2, v2>`, then settings.
    pub(super) fn parametric(&mut self, place: Place) -> Result<Shape> {
        let mut functions = Vec::with_capacity(3);
        while self.peek_word()? == Some(Keyword::Function) {
            let at = self.here();
            let formula = self.exact_function_block()?;
            let formula = of_two(&formula).map_err(|wrong| match wrong {
                Wrong::Count(count) => Error::invalid(
                    at,
                    format!(
                        "the functions of a parametric have two parameters, u and v; this one has {count}"
                    ),
                ),
                Wrong::Third => {
                    Error::invalid(at, "the functions of a parametric are of u and v; this one uses z")
                }
                Wrong::Formula(error) => Error::invalid(at, error.to_string()),
            })?;
            functions.push(Arc::new(formula));
            self.skip_comma()?;
        }
        let count = functions.len();
        let functions: [Arc<Formula>; 3] = functions.try_into().map_err(|_| {
            Error::invalid(place, format!("a parametric has three functions, this one has {count}"))
        })?;
        self.peek()?;
        let at = self.here();
        let from = self.vector2()?;
        self.skip_comma()?;
        let to = self.vector2()?;
        for (k, name) in ['u', 'v'].into_iter().enumerate() {
            if from[k] >= to[k] {
                let text =
                    format!("{name} of this parametric goes from {} to {}; it must ascend", from[k], to[k]);
                return Err(Error::invalid(at, text));
            }
        }
        let mut container = Container::Box(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
        loop {
            self.skip_comma()?;
            match self.peek_word()? {
                Some(Keyword::ContainedBy) => {
                    self.next()?;
                    container = self.container()?;
                }
                // Crossings are certain without these settings.
                Some(Keyword::Accuracy | Keyword::MaxGradient) => {
                    self.next()?;
                    self.float()?;
                }
                Some(Keyword::Precompute) => {
                    self.next()?;
                    self.float()?;
                    self.skip_comma()?;
                    while matches!(self.peek_word()?, Some(Keyword::X | Keyword::Y | Keyword::Z)) {
                        self.next()?;
                        self.skip_comma()?;
                    }
                }
                _ => break,
            }
        }
        let domain = [0, 1].map(|k| [from[k], to[k]]);
        let surface = Parametric { functions, domain, container: Some(container) };
        Ok(scene::Shape::Parametric(Arc::new(surface)).into())
    }
}

/// Why a function is not one of u and v.
enum Wrong {
    Count(u32),
    Third,
    Formula(FormulaError),
}

/// A function without a list of parameters is one of three, of which u and v are the first.
fn of_two(formula: &Formula) -> std::result::Result<Formula, Wrong> {
    match formula.inputs() {
        2 => return Ok(formula.clone()),
        3 => {}
        count => return Err(Wrong::Count(count)),
    }
    if formula.ops().contains(&Op::Input(2)) {
        return Err(Wrong::Third);
    }
    let mut builder = Builder::new();
    let mut of_two = || {
        let (u, v) = (builder.input(0)?, builder.input(1)?);
        let root = builder.call(formula, &[u, v, u])?;
        Ok(builder.finish(root, 2))
    };
    of_two().map_err(Wrong::Formula)
}
