//! `blob { threshold T  sphere { ... }  cylinder { ... }  component ... }`.

use std::rc::Rc;
use std::sync::Arc;

use durer_math::Affine;
use durer_scene::{self as scene, Blob, BlobComponent, BlobShape};

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::scene_builder::{affine, point};
use crate::texture::{Layer, Texture};
use crate::transform::Matrix;

/// The threshold of a blob that states none.
const THRESHOLD: f64 = 1.0;

/// The parameters of a component, without its texture.
const EACH: usize = size_of::<BlobComponent>() + size_of::<Option<Rc<Texture>>>();

impl Parser<'_> {
    /// The items of a blob, after its opening brace.
    pub(crate) fn blob(&mut self, place: Place) -> Result<Shape> {
        let (mut threshold, mut has_components, mut bytes) = (THRESHOLD, false, 0);
        let (mut components, mut textures) = (Vec::new(), Vec::new());
        loop {
            self.skip_comma()?;
            let added = match self.peek_word()? {
                Some(Keyword::Threshold) => {
                    let at = self.here();
                    self.next()?;
                    threshold = self.float()?;
                    if threshold <= 0.0 {
                        return Err(Error::invalid(
                            at,
                            format!("the threshold of a blob is greater than 0, not {threshold}"),
                        ));
                    }
                    None
                }
                Some(Keyword::Sphere) => {
                    self.next()?;
                    self.expect(Mark::BraceOpen)?;
                    let centre = self.corner()?;
                    Some(self.field(BlobShape::Ball(point(centre)))?)
                }
                Some(Keyword::Cylinder) => {
                    let at = self.here();
                    self.next()?;
                    self.expect(Mark::BraceOpen)?;
                    let (base, cap) = (self.corner()?, self.corner()?);
                    if base == cap {
                        return Err(Error::invalid(at, "this cylinder's ends are the same point"));
                    }
                    Some(self.field(BlobShape::Segment(point(base), point(cap)))?)
                }
                Some(Keyword::Component) => {
                    // The form of old scenes: strength, radius, centre.
                    self.next()?;
                    let strength = self.float()?;
                    self.skip_comma()?;
                    let radius = self.reach()?;
                    self.skip_comma()?;
                    let shape = BlobShape::Ball(point(self.vector()?));
                    Some((BlobComponent { shape, radius, strength, place: Affine::IDENTITY }, None))
                }
                // Roots are certain and cells are made without them.
                Some(Keyword::Sturm | Keyword::Hierarchy) => {
                    self.next()?;
                    self.switch_value()?;
                    None
                }
                _ => break,
            };
            has_components |= added.is_some();
            if let Some((component, texture)) = added.filter(|(component, _)| component.radius != 0.0) {
                bytes += EACH + texture.as_ref().map_or(0, |texture| texture.size() * size_of::<Layer>());
                components.push(component);
                textures.push(texture);
            }
            self.check_memory(bytes, place)?;
        }
        if !has_components {
            return Err(Error::invalid(place, "this blob has no components"));
        }
        if components.is_empty() {
            return Ok(self.nothing("no component of this blob has a field", place));
        }
        let blob = Blob { threshold, components, textures: Vec::new() };
        Ok(Shape::textured(scene::Shape::Blob(Arc::new(blob)), textures))
    }

    /// The radius and the strength of a component, its transforms, its texture and its closing
    /// brace.
    fn field(&mut self, shape: BlobShape) -> Result<(BlobComponent, Option<Rc<Texture>>)> {
        let radius = self.reach()?;
        self.skip_comma()?;
        self.take_word(Keyword::Strength)?;
        let strength = self.float()?;
        let (mut matrix, mut texture) = (Matrix::IDENTITY, None);
        loop {
            if let Some(by) = self.transform_item()? {
                matrix = matrix.then(&by);
                Self::move_texture(&mut texture, &by);
                continue;
            }
            if self.texture_item(&mut texture)? {
                continue;
            }
            if self.take_mark(Mark::BraceClose)? {
                break;
            }
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "a transform or the texture of the component, or `}`"));
        }
        let at = self.here();
        let place = if matrix.is_identity() { Affine::IDENTITY } else { affine(&matrix, at)? };
        Ok((BlobComponent { shape, radius, strength, place }, texture))
    }

    /// How far a field reaches. One that reaches nowhere is left out.
    fn reach(&mut self) -> Result<f64> {
        self.peek()?;
        let at = self.here();
        let radius = self.size()?;
        if radius == 0.0 {
            self.notice(at, "a component of the radius 0 is left out");
        }
        Ok(radius)
    }
}
