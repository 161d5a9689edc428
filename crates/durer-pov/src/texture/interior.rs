//! Interiors and materials: the media inside objects.

use std::rc::Rc;

use super::Texture;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::transform::Matrix;
use crate::value::Value;

/// The medium inside an object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Interior {
    pub(crate) ior: f64,
    pub(crate) fade_distance: f64,
    pub(crate) fade_power: f64,
    pub(crate) fade_color: [f64; 3],
    pub(crate) caustics: f64,
}

impl Default for Interior {
    fn default() -> Self {
        Self { ior: 1.0, fade_distance: 0.0, fade_power: 0.0, fade_color: [0.0; 3], caustics: 0.0 }
    }
}

/// A texture and an interior under one name.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Material {
    pub(crate) texture: Option<Texture>,
    pub(crate) interior: Option<Rc<Interior>>,
}

impl Parser<'_> {
    /// Reads an index of refraction; 0 counts as 1 (a fact of the language).
    pub(crate) fn index_of_refraction(&mut self) -> Result<f64> {
        let place = self.here();
        let ior = self.float()?;
        match ior {
            0.0 => Ok(1.0),
            _ if ior > 0.0 => Ok(ior),
            _ => Err(Error::invalid(place, format!("an index of refraction is not negative, as {ior} is"))),
        }
    }

    /// Reads what stands in braces after `interior`.
    pub(crate) fn interior_block(&mut self) -> Result<Rc<Interior>> {
        self.expect(Mark::BraceOpen)?;
        let mut interior = Interior::default();
        loop {
            // Transformations have no effect on an interior without media.
            if self.transform_item()?.is_some() {
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(Rc::new(interior)),
                Item::Value(Value::Interior(known)) => interior = (**known).clone(),
                Item::Word(Keyword::Ior) => {
                    interior.ior = self.index_of_refraction()?;
                }
                Item::Word(Keyword::FadeDistance) => interior.fade_distance = self.float()?,
                Item::Word(Keyword::FadePower) => interior.fade_power = self.float()?,
                Item::Word(Keyword::FadeColor) => {
                    let [r, g, b, ..] = self.colour()?;
                    interior.fade_color = [r, g, b];
                }
                Item::Word(Keyword::Caustics) => interior.caustics = self.float()?,
                Item::Word(Keyword::Media) => self.leave_out(Keyword::Media, lexeme.place)?,
                // The samples of dispersion have no effect without dispersion.
                Item::Word(Keyword::DispersionSamples) => drop(self.float()?),
                Item::Word(Keyword::Dispersion) => {
                    if self.float()? != 1.0 {
                        return Err(Error::unsupported(lexeme.place, "dispersion"));
                    }
                }
                _ => return Err(self.unexpected(&lexeme, "a part of an interior")),
            }
        }
    }

    /// Reads what stands in braces after `material`.
    pub(crate) fn material_block(&mut self) -> Result<Material> {
        self.expect(Mark::BraceOpen)?;
        let mut material = Material::default();
        loop {
            if let Some(by) = self.transform_item()? {
                if let Some(texture) = &mut material.texture {
                    texture.transform(&by);
                }
                continue;
            }
            if self.peek_word()? == Some(Keyword::Texture) {
                let next = self.texture_value()?;
                material.texture = Some(match material.texture.take() {
                    None => next,
                    Some(below) => self.laid_on(below, next)?,
                });
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(material),
                Item::Value(Value::Material(known)) => material = (**known).clone(),
                Item::Word(Keyword::Interior) => material.interior = Some(self.nested(Self::interior_block)?),
                _ => return Err(self.unexpected(&lexeme, "a part of a material")),
            }
        }
    }

    /// Transforms the texture of a material. In this language subset, an interior has nothing to
    /// transform.
    pub(crate) fn move_texture(texture: &mut Option<Rc<Texture>>, by: &Matrix) {
        if let Some(texture) = texture {
            Rc::make_mut(texture).transform(by);
        }
    }
}
