//! What may follow a shape's numbers: transforms, looks, habits, clips.

use std::rc::Rc;

use durer_scene::{Operation, Shape as Leaf};

use super::{Object, Shape};
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::texture::Texture;
use crate::value::Value;

impl Parser<'_> {
    /// Modifiers up to the closing brace.
    pub(crate) fn modifiers(&mut self, object: &mut Object) -> Result<()> {
        let mut on_chart = false;
        loop {
            if let Some(by) = self.transform_item()? {
                object.transform(&by);
                continue;
            }
            let is_look = self.look(object)?;
            let chart = if is_look { None } else { self.uv_mapping()? };
            on_chart = chart.unwrap_or(on_chart);
            if is_look || chart.is_some() {
                if on_chart && let Some(texture) = &mut object.texture {
                    Rc::make_mut(texture).put_on_chart();
                }
                continue;
            }
            if self.starts_colour()? {
                let place = self.here();
                self.colour()?;
                self.notice(place, "a colour outside of a pigment has no effect");
                continue;
            }
            let lexeme = self.next()?;
            let keyword = match &lexeme.item {
                Item::Mark(Mark::BraceClose)
                    if object.interior_texture.is_some() && object.texture.is_none() =>
                {
                    let text = "an object with an interior_texture needs a texture";
                    return Err(Error::invalid(lexeme.place, text));
                }
                Item::Mark(Mark::BraceClose) => return Ok(()),
                Item::Word(keyword) => *keyword,
                _ => return Err(self.unexpected(&lexeme, "a modifier of the object, or `}`")),
            };
            let habits = &mut object.habits;
            match keyword {
                Keyword::NoShadow => habits.no_shadow = true,
                Keyword::NoImage => habits.no_image = true,
                Keyword::NoReflection => habits.no_reflection = true,
                Keyword::CutawayTextures => {
                    let (Shape::Csg(Operation::Intersection | Operation::Difference, _) | Shape::Nothing) =
                        object.shape
                    else {
                        let text = "cutaway_textures is for an intersection or a difference";
                        return Err(Error::invalid(lexeme.place, text));
                    };
                    object.cutaway_textures = self.switch_value()?;
                }
                Keyword::Inverse => habits.inverse = !habits.inverse,
                Keyword::Hollow => object.habits.hollow = self.switch_value()?,
                Keyword::GlobalLights if habits.light_group.is_some() => {
                    habits.light_group = Some(self.switch_value()?);
                }
                Keyword::DoubleIlluminate => object.habits.double_illuminate = self.switch_value()?,
                Keyword::Open
                    if matches!(
                        object.shape,
                        Shape::Nothing
                            | Shape::Leaf(
                                Leaf::Cylinder { .. }
                                    | Leaf::Cone { .. }
                                    | Leaf::Named(_)
                                    | Leaf::Isosurface(_)
                                    | Leaf::Prism(_)
                                    | Leaf::StraightSweep(_)
                                    | Leaf::PathSweep(_)
                                    | Leaf::Sor(_)
                                    | Leaf::Lemon { .. }
                            )
                    ) =>
                {
                    habits.open = true;
                }
                // No radiosity, no photons, better roots anyway, our own trees: nothing to do.
                Keyword::NoRadiosity | Keyword::Sturm | Keyword::Hierarchy | Keyword::SplitUnion => {
                    self.switch_value()?;
                }
                Keyword::Photons => self.skip_photons()?,
                // It matters only in scenes with radiosity, which warn of that.
                Keyword::Radiosity => {
                    let braces = self.braces;
                    self.expect(Mark::BraceOpen)?;
                    self.skip_to_brace_level(braces)?;
                }
                Keyword::ClippedBy => {
                    let parts = self.cutters(&object.bounds, Keyword::BoundedBy)?;
                    object.clips.extend(parts);
                }
                Keyword::BoundedBy => {
                    let parts = self.cutters(&object.clips, Keyword::ClippedBy)?;
                    object.bounds.extend(parts);
                }
                _ => return Err(self.unexpected(&lexeme, "a modifier of the object, or `}`")),
            }
        }
    }

    /// Skips the settings of an object for photon mapping, which durer does not have yet.
    pub(crate) fn skip_photons(&mut self) -> Result<()> {
        let braces = self.braces;
        self.expect(Mark::BraceOpen)?;
        self.skip_to_brace_level(braces)
    }

    /// The objects of a `clipped_by` or `bounded_by`, or those of the other one.
    fn cutters(&mut self, others: &[Rc<Object>], other: Keyword) -> Result<Vec<Rc<Object>>> {
        self.expect(Mark::BraceOpen)?;
        if self.take_word(other)? {
            self.expect(Mark::BraceClose)?;
            return Ok(others.to_vec());
        }
        let mut parts = Vec::new();
        while self.starts_object()? {
            let part = self.object()?;
            if matches!(part.shape, Shape::Light(_)) {
                return Err(Error::invalid(part.at, "a light cuts nothing off"));
            }
            parts.push(part);
        }
        if parts.is_empty() {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "an object"));
        }
        self.expect(Mark::BraceClose)?;
        Ok(parts)
    }

    /// A texture or a part of one, an interior, a material.
    fn look(&mut self, object: &mut Object) -> Result<bool> {
        if self.texture_item(&mut object.texture)? {
            return Ok(true);
        }
        match self.peek()? {
            Item::Word(Keyword::InteriorTexture) => {
                self.next()?;
                let next = self.nested(Self::texture_block)?;
                let below = object.interior_texture.take().map(Rc::unwrap_or_clone);
                object.interior_texture = Some(Rc::new(match below {
                    None => next,
                    Some(below) => self.laid_on(below, next)?,
                }));
            }
            Item::Word(Keyword::Interior) => {
                self.next()?;
                object.interior = Some(self.nested(Self::interior_block)?);
            }
            Item::Word(Keyword::Material) => {
                self.next()?;
                let material = self.nested(Self::material_block)?;
                if let Some(texture) = material.texture {
                    object.texture = Some(Rc::new(texture));
                }
                if material.interior.is_some() {
                    object.interior = material.interior;
                }
            }
            Item::Value(Value::Interior(_)) => {
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, "a modifier such as interior { NAME }"));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Texture statements that an object may hold: a texture, another one on it, or a pigment,
    /// normal or finish.
    pub(super) fn texture_item(&mut self, texture: &mut Option<Rc<Texture>>) -> Result<bool> {
        match self.peek()? {
            Item::Word(Keyword::Texture) => {
                let next = self.texture_value()?;
                let below = texture.take().map(Rc::unwrap_or_clone);
                *texture = Some(Rc::new(match below {
                    None => next,
                    Some(below) => self.laid_on(below, next)?,
                }));
            }
            Item::Word(Keyword::Pigment | Keyword::Normal | Keyword::Finish) => {
                let base = || Rc::new(Texture::single((*self.defaults).clone()));
                let mut changed = texture.take().unwrap_or_else(base);
                self.layer_item(Rc::make_mut(&mut changed))?;
                *texture = Some(changed);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}
