//! What surrounds the objects: the sky.

use std::rc::Rc;

use crate::diagnostics::Result;
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::texture::Pigment;
use crate::transform::Matrix;
use crate::value::Value;

/// Pigments at an infinite distance in every direction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SkySphere {
    /// The layers, the lowest first.
    pub(crate) pigments: Vec<Pigment>,
    /// The factor of their colours.
    pub(crate) emission: [f64; 3],
}

impl SkySphere {
    fn transform(&mut self, by: &Matrix) {
        self.pigments.iter_mut().for_each(|pigment| pigment.transform(by));
    }
}

impl Parser<'_> {
    /// Reads what stands in braces after `sky_sphere`.
    pub(crate) fn sky_sphere_block(&mut self) -> Result<Rc<SkySphere>> {
        self.expect(Mark::BraceOpen)?;
        let mut sky = SkySphere { pigments: Vec::new(), emission: [1.0; 3] };
        loop {
            if let Some(by) = self.transform_item()? {
                sky.transform(&by);
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(Rc::new(sky)),
                Item::Value(Value::SkySphere(known)) => sky = (**known).clone(),
                Item::Value(Value::Pigment(known)) => sky.pigments.push((**known).clone()),
                Item::Word(Keyword::Pigment) => {
                    let base = self.defaults.clone();
                    sky.pigments.push(self.nested(|r| r.pigment_block(&base.pigment))?);
                }
                Item::Word(Keyword::Emission) => {
                    let [r, g, b, ..] = self.colour()?;
                    sky.emission = [r, g, b];
                }
                _ => return Err(self.unexpected(&lexeme, "a part of a sky sphere")),
            }
        }
    }

    /// Reads a `sky_sphere` statement; the word comes next. The last one counts.
    pub(crate) fn sky_sphere_statement(&mut self) -> Result<()> {
        self.next()?;
        let place = self.here();
        let sky = self.nested(Self::sky_sphere_block)?;
        if self.scene.sky.replace((sky, place)).is_some() {
            self.notice(place, "the scene has more than one sky_sphere: this one counts");
        }
        Ok(())
    }
}
