//! Finishes: how a surface reflects and scatters light.

use durer_math::elementary;

use crate::colour::Colour;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::value::Value;

/// The amount of reflection, and how it depends on the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// The amount head-on.
    pub(crate) min: [f64; 3],
    /// The amount at grazing angles.
    pub(crate) max: [f64; 3],
    pub(crate) falloff: f64,
    pub(crate) fresnel: bool,
    pub(crate) exponent: f64,
    pub(crate) metallic: f64,
}

impl Default for Reflection {
    fn default() -> Self {
        Self { min: [0.0; 3], max: [0.0; 3], falloff: 1.0, fresnel: false, exponent: 1.0, metallic: 0.0 }
    }
}

/// A thin film on a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Film {
    pub(crate) amount: f64,
    pub(crate) thickness: f64,
    pub(crate) turbulence: f64,
}

/// How a surface reflects and scatters light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finish {
    pub(crate) ambient: [f64; 3],
    pub(crate) emission: [f64; 3],
    pub(crate) diffuse: f64,
    pub(crate) diffuse_back: f64,
    pub(crate) brilliance: f64,
    pub(crate) phong: f64,
    pub(crate) phong_size: f64,
    pub(crate) specular: f64,
    pub(crate) roughness: f64,
    pub(crate) metallic: f64,
    pub(crate) crand: f64,
    pub(crate) conserve_energy: bool,
    /// The thin film, if there is one.
    pub(crate) irid: Option<Film>,
    pub(crate) reflection: Reflection,
    /// The index of refraction of the inside, in old scenes: it replaces the interior's.
    pub(crate) ior: Option<f64>,
    /// The factor of the light behind the surface, in old scenes.
    pub(crate) refraction: f64,
    /// The caustics of the inside, in old scenes: the exponent of the cosine, unlike the number of
    /// an interior.
    pub(crate) caustics: Option<f64>,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            ambient: [0.1; 3],
            emission: [0.0; 3],
            diffuse: 0.6,
            diffuse_back: 0.0,
            brilliance: 1.0,
            phong: 0.0,
            phong_size: 40.0,
            specular: 0.0,
            roughness: 0.05,
            metallic: 0.0,
            crand: 0.0,
            conserve_energy: false,
            irid: None,
            reflection: Reflection::default(),
            ior: None,
            refraction: 1.0,
            caustics: None,
        }
    }
}

/// Which amounts of a `finish` block are albedos: the total reflected light, not the curve's maximum.
#[derive(Default)]
struct Albedo {
    diffuse: bool,
    phong: bool,
    specular: bool,
}

impl Albedo {
    /// Converts the amounts to maxima, at the end of the block and with the exponents of that time.
    /// Blocks that change an exponent later leave the amounts as they are (a fact of the language).
    fn convert(&self, finish: &mut Finish) {
        if self.diffuse {
            let factor = (finish.brilliance + 1.0) * 0.5;
            finish.diffuse *= factor;
            finish.diffuse_back *= factor;
        }
        if self.phong {
            finish.phong *= (finish.phong_size + 1.0) * 0.5;
        }
        if self.specular {
            let n = 1.0 / finish.roughness;
            finish.specular *= (n + 2.0) / (4.0 * (2.0 - elementary::exp2(-n * 0.5)));
        }
    }
}

fn rgb(colour: Colour) -> [f64; 3] {
    [colour[0], colour[1], colour[2]]
}

impl Parser<'_> {
    /// Reads the block after `finish`, which changes the finish `base`.
    pub(crate) fn finish_block(&mut self, base: &Finish) -> Result<Finish> {
        self.expect(Mark::BraceOpen)?;
        let mut finish = base.clone();
        let mut albedo = Albedo::default();
        loop {
            let lexeme = self.next()?;
            let place = lexeme.place;
            let keyword = match &lexeme.item {
                Item::Mark(Mark::BraceClose) => {
                    albedo.convert(&mut finish);
                    return Ok(finish);
                }
                Item::Value(Value::Finish(known)) => {
                    finish = (**known).clone();
                    continue;
                }
                Item::Word(keyword) => *keyword,
                _ => return Err(self.unexpected(&lexeme, "a part of a finish")),
            };
            match keyword {
                Keyword::Ambient => finish.ambient = rgb(self.colour()?),
                Keyword::Emission => finish.emission = rgb(self.colour()?),
                Keyword::Diffuse => {
                    albedo.diffuse = self.take_word(Keyword::Albedo)?;
                    finish.diffuse = self.float()?;
                    self.skip_comma()?;
                    finish.diffuse_back = self.float_or(0.0)?;
                }
                Keyword::Brilliance => finish.brilliance = self.float()?,
                Keyword::Phong => {
                    albedo.phong = self.take_word(Keyword::Albedo)?;
                    finish.phong = self.float()?;
                }
                Keyword::PhongSize => {
                    finish.phong_size = self.float()?;
                    if finish.phong_size < 0.0 {
                        return Err(Error::invalid(place, "phong_size cannot be negative"));
                    }
                }
                Keyword::Specular => {
                    albedo.specular = self.take_word(Keyword::Albedo)?;
                    finish.specular = self.float()?;
                }
                Keyword::Roughness => {
                    finish.roughness = self.float()?;
                    if finish.roughness <= 0.0 {
                        return Err(Error::invalid(place, "roughness must be positive"));
                    }
                }
                Keyword::Metallic => finish.metallic = self.float_or(1.0)?,
                Keyword::Crand => finish.crand = self.float()?,
                Keyword::ConserveEnergy => finish.conserve_energy = self.switch_value()?,
                Keyword::ReflectionExponent => finish.reflection.exponent = self.exponent()?,
                Keyword::Reflection => self.reflection(&mut finish.reflection)?,
                Keyword::Ior => finish.ior = Some(self.index_of_refraction()?),
                Keyword::Caustics => finish.caustics = Some(self.float()?),
                Keyword::Refraction => finish.refraction = self.float()?,
                Keyword::Irid => self.irid(&mut finish.irid)?,
                Keyword::Subsurface => self.leave_out(keyword, place)?,
                _ => return Err(self.unexpected(&lexeme, "a part of a finish")),
            }
            self.skip_comma()?;
        }
    }

    /// Reads `irid { amount thickness T turbulence V }`.
    fn irid(&mut self, irid: &mut Option<Film>) -> Result<()> {
        self.expect(Mark::BraceOpen)?;
        let mut film = irid.unwrap_or_default();
        film.amount = self.float()?;
        loop {
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => break,
                Item::Word(Keyword::Thickness) => film.thickness = self.float()?,
                // Only the first component of a vector is used (a fact of the language).
                Item::Word(Keyword::Turbulence) => film.turbulence = self.vector()?[0],
                _ => return Err(self.unexpected(&lexeme, "a part of irid")),
            }
        }
        *irid = (film.amount != 0.0).then_some(film);
        Ok(())
    }

    fn exponent(&mut self) -> Result<f64> {
        let exponent = self.float()?;
        if exponent <= 0.0 {
            return Err(Error::invalid(self.here(), "an exponent of reflection must be positive"));
        }
        Ok(exponent)
    }

    /// Reads `reflection 0.5` or `reflection { min, max ... }`. Other words of an earlier
    /// reflection keep their values (a fact of the language).
    fn reflection(&mut self, reflection: &mut Reflection) -> Result<()> {
        if !self.take_mark(Mark::BraceOpen)? {
            let colour = rgb(self.colour()?);
            *reflection = Reflection { min: colour, max: colour, ..*reflection };
            return Ok(());
        }
        let mut is_fresnel = false;
        let first = rgb(self.colour()?);
        self.skip_comma()?;
        let second =
            if self.starts_colour()? || self.starts_number()? { Some(rgb(self.colour()?)) } else { None };
        reflection.min = first;
        reflection.max = second.unwrap_or(first);
        loop {
            self.skip_comma()?;
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => break,
                Item::Word(Keyword::Falloff) => reflection.falloff = self.float()?,
                Item::Word(Keyword::Exponent) => reflection.exponent = self.exponent()?,
                Item::Word(Keyword::Fresnel) => {
                    reflection.fresnel = self.switch_value()?;
                    is_fresnel = reflection.fresnel;
                }
                Item::Word(Keyword::Metallic) => reflection.metallic = self.float_or(1.0)?,
                _ => return Err(self.unexpected(&lexeme, "a part of a reflection")),
            }
        }
        if is_fresnel && second.is_none() {
            reflection.min = [0.0; 3];
        }
        Ok(())
    }
}
