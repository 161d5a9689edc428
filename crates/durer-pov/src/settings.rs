//! Settings of the whole scene: the language's version, gamma, limits of recursion, the background.

use durer_math::elementary;
use durer_scene::NoiseGenerator;

use crate::colour::srgb_decoded;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};

/// How the scene's colour values relate to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Gamma {
    /// Light is the value to this power.
    Power(f64),
    /// The sRGB curve.
    Srgb,
}

/// The settings on which the language itself depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Language {
    /// The current version: 3.7 until a `#version` changes it.
    pub(crate) version: f64,
    /// Whether a `#version` was seen; a scene without any is treated as one of version 3.62.
    pub(crate) version_given: bool,
    pub(crate) gamma: Option<Gamma>,
    /// The generator for noise functions that do not state one.
    noise_generator: Option<NoiseGenerator>,
    /// Whether there are such functions.
    pub(crate) noise_is_used: bool,
}

impl Default for Language {
    fn default() -> Self {
        Self { version: 3.7, version_given: false, gamma: None, noise_generator: None, noise_is_used: false }
    }
}

/// The version that introduced the second noise generator.
const NEW_NOISE: f64 = 3.5;

/// The version since which a declaration of a number must end with a semicolon.
const SEMICOLONS: f64 = 3.5;

/// The version of scenes without any `#version`.
const UNVERSIONED: f64 = 3.62;

impl Language {
    /// The version whose rules apply to shading.
    pub(crate) fn shading_version(&self) -> f64 {
        if self.version_given { self.version } else { UNVERSIONED }
    }

    /// Whether a declaration of a number may end without a semicolon.
    pub(crate) fn may_omit_semicolons(&self) -> bool {
        self.version < SEMICOLONS
    }

    /// The generator for noise functions that do not state one.
    pub(crate) fn noise_generator(&self) -> NoiseGenerator {
        let of_version =
            if self.version < NEW_NOISE { NoiseGenerator::First } else { NoiseGenerator::Second };
        self.noise_generator.unwrap_or(of_version)
    }

    /// Converts an sRGB-encoded value to the scene's own scale.
    pub(crate) fn working_from_srgb(&self, value: f64) -> f64 {
        match self.gamma {
            Some(Gamma::Srgb) => value,
            Some(Gamma::Power(gamma)) if gamma != 1.0 => {
                elementary::pow(srgb_decoded(value).max(0.0), 1.0 / gamma)
            }
            _ => srgb_decoded(value),
        }
    }
}

/// `global_settings`, as far as they matter to this subset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Globals {
    pub(crate) max_trace_level: u32,
    pub(crate) adc_bailout: f64,
    pub(crate) ambient_light: [f64; 3],
    pub(crate) number_of_waves: u32,
}

impl Default for Globals {
    fn default() -> Self {
        Self { max_trace_level: 5, adc_bailout: 1.0 / 255.0, ambient_light: [1.0; 3], number_of_waves: 10 }
    }
}

/// The newest supported version of the language.
const NEWEST: f64 = 3.7;
/// The greatest number of waves that is not refused; scenes use a handful.
const MOST_WAVES: f64 = 1000.0;
/// POV-Ray's limit on `max_trace_level`.
const DEEPEST_TRACE: f64 = 256.0;

impl Parser<'_> {
    /// Applies `#version`.
    pub(crate) fn set_version(&mut self, version: f64, place: Place) -> Result<()> {
        // Old files write 1 or 2; 3.62 or 3.701 are patch levels.
        if version.is_nan() || version >= NEWEST + 0.05 {
            let text = format!(
                "this scene is written for version {version}; durer reads the language up to {NEWEST}"
            );
            return Err(Error::at(place, crate::ErrorKind::Unsupported, text));
        }
        self.language.version = version;
        self.language.version_given = true;
        Ok(())
    }

    /// Reads what stands in braces after `global_settings`.
    pub(crate) fn global_settings(&mut self) -> Result<()> {
        self.expect(Mark::BraceOpen)?;
        loop {
            let lexeme = self.next()?;
            let place = lexeme.place;
            let keyword = match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(()),
                Item::Word(keyword) => *keyword,
                _ => return Err(self.unexpected(&lexeme, "a global setting")),
            };
            match keyword {
                Keyword::AssumedGamma => self.assumed_gamma(place)?,
                Keyword::MaxTraceLevel => {
                    let level = self.float()?;
                    if !(1.0..=DEEPEST_TRACE).contains(&level) {
                        let text = format!("max_trace_level is 1 to {DEEPEST_TRACE}");
                        return Err(Error::invalid(place, text));
                    }
                    self.scene.globals.max_trace_level = level as u32;
                }
                Keyword::AdcBailout => {
                    let bailout = self.float()?;
                    if bailout < 0.0 {
                        return Err(Error::invalid(place, "adc_bailout cannot be negative"));
                    }
                    self.scene.globals.adc_bailout = bailout;
                }
                Keyword::AmbientLight => {
                    let [r, g, b, ..] = self.colour()?;
                    self.scene.globals.ambient_light = [r, g, b];
                }
                // The encoding of texts is detected, and the rest concerns features that are not
                // supported yet.
                Keyword::Charset => {
                    let lexeme = self.next()?;
                    match lexeme.item {
                        Item::Word(Keyword::Ascii | Keyword::Utf8 | Keyword::Sys) => {}
                        _ => return Err(self.unexpected(&lexeme, "ascii, utf8 or sys")),
                    }
                }
                Keyword::NoiseGenerator => self.noise_generator(place)?,
                Keyword::MaxIntersections | Keyword::MmPerUnit => {
                    self.float()?;
                }
                Keyword::NumberOfWaves => {
                    let count = self.float()?;
                    if !(1.0..=MOST_WAVES).contains(&count) {
                        let text = format!("number_of_waves is 1 to {MOST_WAVES}, not {count}");
                        return Err(Error::invalid(place, text));
                    }
                    self.scene.globals.number_of_waves = count as u32;
                }
                Keyword::IridWavelength => drop(self.colour()?),
                Keyword::Photons | Keyword::Radiosity | Keyword::Subsurface => {
                    self.leave_out(keyword, place)?;
                }
                Keyword::HfGray16 => drop(self.switch_value()?),
                _ => return Err(self.unexpected(&lexeme, "a global setting")),
            }
        }
    }

    /// Skips the block of a feature that is left out of the picture, and warns of that.
    pub(crate) fn leave_out(&mut self, keyword: Keyword, place: Place) -> Result<()> {
        self.note_left_out(keyword.text(), place)?;
        let braces = self.braces;
        self.expect(Mark::BraceOpen)?;
        self.skip_to_brace_level(braces)
    }

    /// Warns once of a feature that the picture is rendered without.
    pub(crate) fn note_left_out(&mut self, what: &'static str, place: Place) -> Result<()> {
        if self.options.strict {
            return Err(Error::unsupported(place, what));
        }
        if !self.left_out.contains(&what) {
            self.left_out.push(what);
            self.notice(place, format!("{what} is not supported yet: the picture is rendered without it"));
        }
        Ok(())
    }

    fn noise_generator(&mut self, place: Place) -> Result<()> {
        let before = self.language.noise_generator();
        let generator = self.float()?;
        if !(1.0..4.0).contains(&generator) {
            return Err(Error::invalid(
                place,
                format!("the noise generators are 1, 2 and 3, not {generator}"),
            ));
        }
        let generator = NoiseGenerator::numbered(generator);
        self.language.noise_generator = Some(generator);
        if self.language.noise_is_used && generator != before {
            self.notice(place, "functions of noise that were declared before keep their noise generator");
        }
        Ok(())
    }

    fn assumed_gamma(&mut self, place: Place) -> Result<()> {
        let gamma = if self.take_word(Keyword::Srgb)? {
            Gamma::Srgb
        } else {
            let value = self.float()?;
            if value <= 0.0 {
                return Err(Error::invalid(place, "assumed_gamma must be positive"));
            }
            Gamma::Power(value)
        };
        if self.language.gamma.is_some() {
            self.notice(place, "a second assumed_gamma is ignored");
        } else {
            self.language.gamma = Some(gamma);
        }
        Ok(())
    }

    /// Reads what stands in braces after `background`.
    pub(crate) fn background(&mut self) -> Result<()> {
        self.expect(Mark::BraceOpen)?;
        let mut color = self.colour()?;
        if self.language.version < 3.7 {
            // The background of older scenes is opaque.
            (color[3], color[4]) = (0.0, 0.0);
        }
        self.scene.background = Some(color);
        self.expect(Mark::BraceClose)
    }
}
