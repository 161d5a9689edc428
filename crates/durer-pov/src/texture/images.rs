//! Pictures in textures: `image_map`, `bump_map`, `material_map`, `image_pattern`.

use std::sync::Arc;

use durer_math::elementary;
use durer_scene::{Between, Colour, Image, ImageMap, ImageValue, Layout};

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::picture::colours::{Colours, FileGamma, Pixels};
use crate::picture::{Fault, Format, colours};
use crate::settings::Gamma;

/// A picture with the settings of its block.
pub(crate) struct ReadImage {
    pub(crate) map: Arc<ImageMap>,
    /// The value that a pattern takes from it.
    pub(crate) value: ImageValue,
    /// The value that the scene requests.
    stated: Option<ImageValue>,
    /// The height of its bumps, if given.
    pub(crate) bump_size: Option<f64>,
}

/// Where a picture comes from.
enum Origin {
    /// A file of this name and format.
    File(String, Format),
    /// A function, whose values these are.
    Function(Colours),
}

/// The bytes of a pixel.
const PIXEL: usize = size_of::<[f32; 5]>();

/// The meaning of a file's numbers, as the block or the file states it.
#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    AsTheyAre,
    Power(f64),
    Srgb,
}

impl Parser<'_> {
    /// Reads the block of a picture, and the picture's file.
    pub(super) fn image_block(&mut self) -> Result<ReadImage> {
        self.image_block_with(|_| Ok(false))
    }

    /// The picture of a `bump_map`. Its heights are the file's numbers without conversion: those of
    /// the colours, unless it says `use_index` (facts of the scene language).
    pub(super) fn bump_block(&mut self) -> Result<ReadImage> {
        let read = self.image_block_as(true, |_| Ok(false))?;
        let value = read.stated.unwrap_or(ImageValue::Grey);
        Ok(ReadImage { value, ..read })
    }

    /// [`Parser::image_block`] for blocks with further words: `other` reads the next one, and
    /// returns whether there was one.
    pub(super) fn image_block_with(
        &mut self,
        other: impl FnMut(&mut Self) -> Result<bool>,
    ) -> Result<ReadImage> {
        self.image_block_as(false, other)
    }

    /// [`Parser::image_block_with`]; with `is_raw` the numbers of the file are not converted.
    fn image_block_as(
        &mut self,
        is_raw: bool,
        mut other: impl FnMut(&mut Self) -> Result<bool>,
    ) -> Result<ReadImage> {
        self.expect(Mark::BraceOpen)?;
        let origin = self.image_origin()?;
        let at = self.here();
        let is_file = matches!(origin, Origin::File(..));
        let mut meaning = if is_file { None } else { Some(Meaning::AsTheyAre) };
        let (mut layout, mut once, mut between) = (Layout::Flat, false, Between::Nearest);
        let mut value = None;
        let mut bump_size = None;
        // Whether it is a filter, which entry (`None` for all), and the amount.
        let mut clears: Vec<(bool, Option<usize>, f64)> = Vec::new();
        loop {
            self.skip_comma()?;
            if other(self)? {
                continue;
            }
            let Some(word) = self.peek_word()? else { break };
            let place = self.here();
            self.next()?;
            match word {
                Keyword::Gamma if !is_file => {
                    return Err(Error::invalid(place, "a picture made of a function has no gamma"));
                }
                Keyword::Gamma if self.take_word(Keyword::Srgb)? => meaning = Some(Meaning::Srgb),
                Keyword::Gamma => {
                    let power = self.float()?;
                    if power <= 0.0 {
                        return Err(Error::invalid(place, "the gamma of a picture must be positive"));
                    }
                    meaning = Some(Meaning::Power(power));
                }
                Keyword::Premultiplied => drop(self.switch_value()?),
                Keyword::Once => once = true,
                Keyword::MapType => {
                    let number = self.float()?;
                    layout = match number.trunc() {
                        0.0 => Layout::Flat,
                        1.0 => Layout::Sphere,
                        2.0 => Layout::Cylinder,
                        5.0 => Layout::Torus,
                        _ => {
                            let text = format!("map_type is 0, 1, 2 or 5, not {number}");
                            return Err(Error::invalid(place, text));
                        }
                    };
                }
                Keyword::Interpolate => {
                    between = match self.float()?.trunc() {
                        2.0 => Between::Linear,
                        3.0 => Between::Cubic,
                        4.0 => Between::Distance,
                        _ => Between::Nearest,
                    };
                }
                Keyword::UseIndex => value = Some(ImageValue::Index),
                Keyword::UseColor => value = Some(ImageValue::Grey),
                Keyword::UseAlpha => value = Some(ImageValue::Alpha),
                Keyword::BumpSize => bump_size = Some(self.float()?),
                Keyword::Filter | Keyword::Transmit => {
                    let entry = match self.take_word(Keyword::All)? {
                        true => None,
                        false => {
                            let entry = self.float()?;
                            self.skip_comma()?;
                            Some(entry as usize)
                        }
                    };
                    clears.push((word == Keyword::Filter, entry, self.float()?));
                }
                _ => {
                    let text = format!("expected a part of a picture, found `{}`", word.text());
                    return Err(Error::invalid(place, text));
                }
            }
        }
        self.expect(Mark::BraceClose)?;
        let found = match origin {
            Origin::File(name, format) => self.unpacked(&name, format, at)?,
            Origin::Function(made) => made,
        };
        let meaning = if is_raw { Some(Meaning::AsTheyAre) } else { meaning };
        let image = self.finished_image(found, meaning, &clears);
        let image = image.ok_or_else(|| Error::invalid(at, "this picture has no pixels"))?;
        let stated = value;
        let value = value.unwrap_or(match image.has_palette() {
            true => ImageValue::Index,
            false => ImageValue::Grey,
        });
        let map = Arc::new(ImageMap { image: Arc::new(image), layout, once, between });
        Ok(ReadImage { map, value, stated, bump_size })
    }

    /// Reads the name of a picture's file, with its format, or the function of which it is made.
    fn image_origin(&mut self) -> Result<Origin> {
        if self.take_word(Keyword::Function)? {
            return Ok(Origin::Function(self.function_image()?));
        }
        let mut format = None;
        if let Some(word) = self.peek_word()? {
            let at = self.here();
            format = Format::from_keyword(word).filter(|format| *format != Format::Pot);
            if format.is_some() {
                self.next()?;
            } else if matches!(word, Keyword::Iff | Keyword::Pot | Keyword::Sys) {
                let text = format!("a picture of the type {}", word.text());
                return Err(Error::unsupported(at, &text));
            }
        }
        let name = self.file_name()?;
        let at = self.here();
        let format = format.or_else(|| Format::from_name(&name)).ok_or_else(|| {
            let text = format!(
                "the ending of \"{name}\" does not tell what it is: say png, jpeg, gif, tga, bmp, pgm, ppm, tiff, exr or hdr before it"
            );
            Error::invalid(at, text)
        })?;
        Ok(Origin::File(name, format))
    }

    fn unpacked(&mut self, name: &str, format: Format, at: Place) -> Result<Colours> {
        let path = self.picture_path(name, at)?;
        let may_hold = |[columns, rows]: [usize; 2]| {
            let bytes = columns.saturating_mul(rows).saturating_mul(3 * PIXEL);
            self.check_memory(bytes, at).map_err(Fault::Limit)
        };
        let found = colours::read(&path, format, &self.options.limits, &may_hold);
        let found = found.map_err(|fault| match fault {
            Fault::Limit(error) => error,
            Fault::Text(why) => Error::file(Some(at), format!("{}: {why}", path.display())),
        })?;
        let each = if matches!(found.pixels, Pixels::Indexed(..)) { 1 } else { PIXEL };
        crate::limits::charge_for_good(found.columns * found.rows * each);
        Ok(found)
    }

    /// The path of a picture by its name in the scene.
    pub(crate) fn picture_path(&mut self, name: &str, at: Place) -> Result<std::path::PathBuf> {
        self.library.find(name).ok_or_else(|| {
            let names = self.library.names();
            let near = crate::parser::nearest(name, names.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!(" (did you mean \"{near}\"?)"));
            let folders = self.library.listed();
            Error::file(Some(at), format!("there is no picture \"{name}\"{near}; searched: {folders}"))
        })
    }

    /// Converts a picture to the scene's own colour values.
    fn finished_image(
        &self,
        found: Colours,
        meaning: Option<Meaning>,
        clears: &[(bool, Option<usize>, f64)],
    ) -> Option<Image> {
        let is_new = self.language.shading_version() >= 3.7;
        let has_gamma = is_new || self.language.gamma.is_some();
        let of_file = match found.gamma {
            _ if !has_gamma => Meaning::AsTheyAre,
            FileGamma::Srgb => Meaning::Srgb,
            FileGamma::Power(power) => Meaning::Power(power),
            FileGamma::UsuallySrgb if is_new => Meaning::Srgb,
            FileGamma::UsuallySrgb | FileGamma::Unknown => Meaning::AsTheyAre,
        };
        let meaning = meaning.unwrap_or(of_file);
        let working = self.language.gamma;
        let part = |number: f32| -> f32 {
            let number = f64::from(number);
            let light = match meaning {
                Meaning::AsTheyAre => return number as f32,
                Meaning::Srgb if working == Some(Gamma::Srgb) => return number as f32,
                Meaning::Srgb => crate::colour::srgb_decoded(number),
                Meaning::Power(power) => elementary::pow(number.max(0.0), power),
            };
            (match working {
                Some(Gamma::Power(power)) => elementary::pow(light.max(0.0), 1.0 / power),
                Some(Gamma::Srgb) => srgb_encoded(light),
                None => light,
            }) as f32
        };
        let colour = |[r, g, b, opacity]: [f32; 4], index: Option<usize>| {
            let mut made = [part(r), part(g), part(b), 0.0, 1.0 - opacity];
            for &(is_filter, entry, amount) in clears {
                if entry.is_none() || entry == index {
                    made[if is_filter { 3 } else { 4 }] = amount as f32;
                }
            }
            made
        };
        match found.pixels {
            Pixels::Plain(pixels) => {
                // Neighbours are often equal.
                let mut last = None;
                let colours = pixels.into_iter().map(|pixel| match last {
                    Some((known, made)) if known == pixel => made,
                    _ => {
                        let made = colour(pixel, None);
                        last = Some((pixel, made));
                        made
                    }
                });
                let colours = colours.collect();
                Image::from_colours(found.columns, found.rows, colours)
            }
            Pixels::Indexed(palette, indices) => {
                let palette = palette.into_iter().enumerate().map(|(i, own)| {
                    let made = colour(own, Some(i)).map(f64::from);
                    Colour::from_terms(made)
                });
                Image::from_indices(found.columns, found.rows, palette.collect(), indices)
            }
        }
    }
}

/// The sRGB code of a value of light (IEC 61966-2-1).
fn srgb_encoded(light: f64) -> f64 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * elementary::pow(light, 1.0 / 2.4) - 0.055 }
}
