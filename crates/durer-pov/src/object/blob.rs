//! `blob { threshold T  sphere { ... }  cylinder { ... }  component ... }`.

use std::rc::Rc;

use durer_math::{Affine, Point3};
use durer_scene::{Blob, BlobComponent, BlobShape};

use super::Shape;
use crate::diagnostics::{Fault, Place, Result};
use crate::emit;
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::reader::Reader;
use crate::transform::Matrix;

/// The threshold of a blob that states none.
const THRESHOLD: f64 = 1.0;

fn point([x, y, z]: [f64; 3]) -> Point3 {
    Point3::new(x, y, z)
}

impl Reader<'_> {
    /// The items of a blob, after its opening brace.
    pub(crate) fn blob(&mut self, place: Place) -> Result<Shape> {
        let mut blob = Blob { threshold: THRESHOLD, components: Vec::new() };
        loop {
            self.skip_comma()?;
            match self.peek_word()? {
                Some(Keyword::Threshold) => {
                    let at = self.here();
                    self.next()?;
                    blob.threshold = self.float()?;
                    if blob.threshold <= 0.0 {
                        return Err(Fault::invalid(
                            at,
                            format!("the threshold of a blob is greater than 0, not {}", blob.threshold),
                        ));
                    }
                }
                Some(Keyword::Sphere) => {
                    self.next()?;
                    self.expect(Mark::BraceOpen)?;
                    let centre = self.corner()?;
                    blob.components.push(self.field(BlobShape::Ball(point(centre)))?);
                }
                Some(Keyword::Cylinder) => {
                    let at = self.here();
                    self.next()?;
                    self.expect(Mark::BraceOpen)?;
                    let (base, cap) = (self.corner()?, self.corner()?);
                    if base == cap {
                        return Err(Fault::invalid(at, "this cylinder's ends are the same point"));
                    }
                    blob.components.push(self.field(BlobShape::Segment(point(base), point(cap)))?);
                }
                Some(Keyword::Component) => {
                    // The form of old scenes: strength, radius, centre.
                    self.next()?;
                    let strength = self.float()?;
                    self.skip_comma()?;
                    let radius = self.reach()?;
                    self.skip_comma()?;
                    let shape = BlobShape::Ball(point(self.vector()?));
                    blob.components.push(BlobComponent { shape, radius, strength, place: Affine::IDENTITY });
                }
                // Roots are certain and cells are made without them.
                Some(Keyword::Sturm | Keyword::Hierarchy) => {
                    self.next()?;
                    self.switch_value()?;
                }
                _ => break,
            }
            self.check_memory(blob.components.len() * size_of::<BlobComponent>(), place)?;
        }
        if blob.components.is_empty() {
            return Err(Fault::invalid(place, "this blob has no components"));
        }
        Ok(Shape::Blob(Rc::new(blob)))
    }

    /// The radius and the strength of a component, its transforms and its closing brace.
    fn field(&mut self, shape: BlobShape) -> Result<BlobComponent> {
        let radius = self.reach()?;
        self.skip_comma()?;
        self.take_word(Keyword::Strength)?;
        let strength = self.float()?;
        let mut matrix = Matrix::IDENTITY;
        loop {
            if let Some(by) = self.transform_item()? {
                matrix = matrix.then(&by);
                continue;
            }
            if let Some(Keyword::Texture | Keyword::Pigment | Keyword::Finish | Keyword::Material) =
                self.peek_word()?
            {
                return Err(Fault::unsupported(self.here(), "the texture of a blob's component"));
            }
            if self.take_mark(Mark::BraceClose)? {
                break;
            }
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "a transform of the component, or `}`"));
        }
        let at = self.here();
        let place = if matrix.is_identity() { Affine::IDENTITY } else { emit::affine(&matrix, at)? };
        Ok(BlobComponent { shape, radius, strength, place })
    }

    /// How far a field reaches.
    fn reach(&mut self) -> Result<f64> {
        self.peek()?;
        let at = self.here();
        let radius = self.float()?;
        if radius <= 0.0 {
            return Err(Fault::invalid(
                at,
                format!("the radius of a blob's component is greater than 0, not {radius}"),
            ));
        }
        Ok(radius)
    }
}
