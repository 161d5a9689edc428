//! Lenses of cameras: the words of focal blur.

use std::rc::Rc;
use std::sync::Arc;

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::texture::Pigment;
use crate::texture_builder::pigment;

/// The lens of a camera; a pinhole as long as it has no aperture and no samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lens {
    aperture: f64,
    pub(crate) focal_point: [f64; 3],
    /// The fewest rays of a point, if given, and the most.
    samples: (Option<u32>, u32),
    confidence: f64,
    variance: f64,
    bokeh: Option<(Rc<Pigment>, Place)>,
}

impl Default for Lens {
    fn default() -> Self {
        Self {
            aperture: 0.0,
            focal_point: [0.0; 3],
            samples: (None, 0),
            confidence: 0.9,
            variance: 1e-4,
            bokeh: None,
        }
    }
}

/// The most rays of a place.
const MOST_SAMPLES: f64 = 1_000_000.0;

impl Lens {
    /// As data of the scene, with the distance of its plane of focus; `None` for a pinhole.
    pub(crate) fn scene(&self, focus: f64) -> Result<Option<durer_scene::Lens>> {
        let (fewest, most) = self.samples;
        if self.aperture == 0.0 || most == 0 {
            return Ok(None);
        }
        let bokeh = match &self.bokeh {
            Some((own, at)) => Some(Arc::new(pigment(own, *at)?)),
            None => None,
        };
        let fewest = fewest.unwrap_or(if most < 7 { 4 } else { 7 }).min(most);
        Ok(Some(durer_scene::Lens {
            aperture: self.aperture,
            focus,
            samples: [fewest, most],
            confidence: self.confidence,
            variance: self.variance,
            bokeh,
        }))
    }
}

impl Parser<'_> {
    /// Reads what follows one of the words of focal blur; `false` for another word.
    pub(crate) fn lens_item(&mut self, word: Keyword, lens: &mut Lens, place: Place) -> Result<bool> {
        let invalid = |text: String| Err(Error::invalid(place, text));
        match word {
            Keyword::Aperture => {
                lens.aperture = self.float()?;
                if !(0.0..f64::INFINITY).contains(&lens.aperture) {
                    return invalid(format!(
                        "an aperture is not negative, but this one is {}",
                        lens.aperture
                    ));
                }
            }
            Keyword::FocalPoint => lens.focal_point = self.vector()?,
            Keyword::BlurSamples => {
                let first = self.blur_samples(place)?;
                self.skip_comma()?;
                lens.samples = if self.starts_number()? {
                    (Some(first), self.blur_samples(place)?)
                } else {
                    (None, first)
                };
            }
            Keyword::Confidence => {
                lens.confidence = self.float()?;
                if !(0.0..1.0).contains(&lens.confidence) {
                    return invalid(format!("a confidence is from 0 to below 1, not {}", lens.confidence));
                }
            }
            Keyword::Variance => {
                lens.variance = self.float()?;
                if !(0.0..=1.0).contains(&lens.variance) {
                    return invalid(format!("a variance is from 0 to 1, not {}", lens.variance));
                }
            }
            Keyword::Bokeh => {
                self.expect(Mark::BraceOpen)?;
                if !self.take_word(Keyword::Pigment)? {
                    let lexeme = self.next()?;
                    return Err(self.unexpected(&lexeme, "the pigment of the bokeh"));
                }
                let shape = self.nested(|r| r.pigment_block(&Pigment::default()))?;
                lens.bokeh = Some((Rc::new(shape), place));
                self.expect(Mark::BraceClose)?;
            }
            _ => return Ok(false),
        }
        self.skip_comma()?;
        Ok(true)
    }

    fn blur_samples(&mut self, place: Place) -> Result<u32> {
        let count = self.float()?;
        if (0.0..=MOST_SAMPLES).contains(&count) {
            Ok(count as u32)
        } else {
            Err(Error::invalid(place, format!("blur_samples are at most {MOST_SAMPLES}, not {count}")))
        }
    }
}
