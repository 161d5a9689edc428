//! Sheets over the unit square: `height_field` and durer's own `terrain`.

use durer_formula::{Formula, Tape};
use durer_math::{F8, Point3};
use durer_scene::{self as scene, HeightField, MOST_SAMPLES, Terrain, TerrainData};

use super::Shape;
use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::pattern_function::NOT_INVERTIBLE;
use crate::picture::{self, Fault, Format};
use crate::texture::Pigment;

/// How many values of a function count as a step.
const VALUES_A_STEP: usize = 64;

impl Parser<'_> {
    /// `[TYPE] "file" [gamma G] [premultiplied B] | function NX, NZ { }`, then
    /// `smooth`, `water_level L` and `hierarchy B`.
    pub(super) fn height_field(&mut self, place: Place) -> Result<Shape> {
        let mut field = if self.take_word(Keyword::Function)? {
            self.sampled_function(place)?
        } else {
            self.height_picture(place)?
        };
        let mut water_level = 0.0;
        loop {
            if self.take_word(Keyword::Smooth)? {
                if self.switch_value()? {
                    field = field.smooth();
                }
            } else if self.take_word(Keyword::WaterLevel)? {
                water_level = self.float()?;
            } else if self.take_word(Keyword::Hierarchy)? {
                // There always is one.
                self.switch_value()?;
            } else {
                break;
            }
            self.skip_comma()?;
        }
        if field.range()[1] < water_level {
            return Ok(self.nothing("all of this height_field lies below its water level", place));
        }
        Ok(scene::Shape::HeightField(Box::new(field.with_water_level(water_level))).into())
    }

    /// Reads the picture of a height field: its type, unless the name's extension gives it, and its
    /// name.
    fn height_picture(&mut self, place: Place) -> Result<HeightField> {
        let mut format = None;
        if let Some(word) = self.peek_word()? {
            let at = self.here();
            format = Format::from_keyword(word).filter(|_| !is_other_format(word));
            if format.is_some() {
                self.next()?;
            } else if is_other_format(word) {
                return Err(unread(at, word.text()));
            }
        }
        let name = self.file_name()?;
        let at = self.here();
        while let Some(Keyword::Gamma | Keyword::Premultiplied) = self.peek_word()? {
            // Heights are the numbers that stand in the file.
            self.next()?;
            if !self.take_word(Keyword::Srgb)? {
                self.float()?;
            }
        }
        let Some(format) = format.or_else(|| Format::from_name(&name)) else {
            let text = format!(
                "the ending of \"{name}\" does not tell what it is: say png, tga, gif, pot, bmp, jpeg, pgm or ppm before it"
            );
            return Err(Error::invalid(at, text));
        };
        let path = self.picture_path(&name, at)?;
        let may_hold = |size: [usize; 2]| match check_size(size) {
            Some(text) => Err(Fault::Text(text)),
            None => self.check_memory(bytes_of(size, 2), at).map_err(Fault::Limit),
        };
        let read = picture::read(&path, format, &self.options.limits, &may_hold);
        let picture = read.map_err(|fault| match fault {
            Fault::Limit(error) => error,
            Fault::Text(why) => Error::file(Some(at), format!("{}: {why}", path.display())),
        })?;
        HeightField::from_words([picture.columns, picture.rows], picture.words)
            .map_err(|error| Error::invalid(place, error.to_string()))
    }

    /// The field of a function: how many columns and rows, and the function.
    fn sampled_function(&mut self, place: Place) -> Result<HeightField> {
        let at = self.here();
        let columns = self.sample_count()?;
        self.skip_comma()?;
        let rows = self.sample_count()?;
        self.skip_comma()?;
        let size = [columns, rows];
        if let Some(text) = check_size(size) {
            return Err(Error::invalid(at, format!("this height_field {text}")));
        }
        self.check_memory(bytes_of(size, 8), at)?;
        self.expect(Mark::BraceOpen)?;
        let (heights, outside) = if self.take_word(Keyword::Pigment)? {
            self.sampled_pigment(size, place)?
        } else {
            let function = self.function_behind_brace()?;
            if let Some(formula) = function.plain() {
                self.count_steps((columns * rows / VALUES_A_STEP) as u64, place)?;
                sampled(formula, size)
            } else {
                self.count_steps((columns * rows) as u64, place)?;
                let Some(values) = function.prepared(self.texture_context()) else {
                    return Err(Error::invalid(place, NOT_INVERTIBLE));
                };
                heights_of(size, |x, y| F8(x.0.map(|x| values.value(&[x, y, 0.0]))))
            }
        };
        if outside > 0 {
            let all = columns * rows;
            let text = format!(
                "of the {all} heights of this height_field {outside} are not between 0 and 1: they are moved there"
            );
            self.notice(place, text);
        }
        HeightField::new(size, heights).map_err(|error| Error::invalid(place, error.to_string()))
    }

    /// The grey values of a pigment, behind its word.
    fn sampled_pigment(&mut self, size: [usize; 2], place: Place) -> Result<(Vec<f64>, usize)> {
        let own = self.nested(|r| r.pigment_block(&Pigment::default()))?;
        self.expect(Mark::BraceClose)?;
        self.count_steps((size[0] * size[1]) as u64, place)?;
        let colours = self.pigment_colours(&own, place)?;
        Ok(heights_of(size, |x, y| colours.luminances(Point3 { x, y: F8::splat(y), z: F8::ZERO })))
    }

    /// The number of columns or rows.
    fn sample_count(&mut self) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        // POV-Ray takes the whole part.
        if !(2.0..=MOST_SAMPLES as f64).contains(&count.trunc()) {
            let text = format!("a height_field has from 2 to {MOST_SAMPLES} samples a side, not {count}");
            return Err(Error::invalid(at, text));
        }
        Ok(count as usize)
    }

    /// `levels L roughness H amplitude B seed S corners <a, b, c, d> water_level W smooth`, in any
    /// order.
    pub(super) fn terrain(&mut self, place: Place) -> Result<Shape> {
        let mut data = TerrainData { levels: 0, ..TerrainData::default() };
        let (mut water_level, mut is_smooth, mut has_levels) = (f64::NEG_INFINITY, false, false);
        loop {
            if self.small_word("levels")? {
                data.levels = self.whole("levels", 15.0)? as u32;
                has_levels = true;
            } else if self.take_word(Keyword::Roughness)? {
                data.roughness = self.float()?;
            } else if self.small_word("amplitude")? {
                data.amplitude = self.float()?;
            } else if self.small_word("seed")? || self.take_word(Keyword::Seed)? {
                data.seed = self.whole("the seed", 9_007_199_254_740_992.0)?;
            } else if self.small_word("corners")? {
                data.corners = self.vector4()?;
            } else if self.take_word(Keyword::WaterLevel)? {
                water_level = self.float()?;
            } else if self.take_word(Keyword::Smooth)? {
                is_smooth = self.switch_value()?;
            } else {
                break;
            }
            self.skip_comma()?;
        }
        if !has_levels {
            let text = "say how often the edges of this terrain are halved: `levels 1` to `levels 15`";
            return Err(Error::invalid(place, text));
        }
        let terrain = Terrain::new(data).map_err(|error| Error::invalid(place, error.to_string()))?;
        if terrain.range()[1] < water_level {
            return Ok(self.nothing("all of this terrain lies below its water level", place));
        }
        let terrain = if is_smooth { terrain.smooth() } else { terrain };
        Ok(scene::Shape::Terrain(Box::new(terrain.with_water_level(water_level))).into())
    }

    /// An integer from 0 to `most`.
    fn whole(&mut self, what: &str, most: f64) -> Result<u64> {
        self.peek()?;
        let at = self.here();
        let number = self.float()?;
        if number.fract() != 0.0 || !(0.0..=most).contains(&number) {
            let text = format!("{what} of a terrain: a whole number from 0 to {most}, not {number}");
            return Err(Error::invalid(at, text));
        }
        Ok(number as u64)
    }
}

/// Formats of pictures that POV-Ray reads and durer does not.
fn is_other_format(word: Keyword) -> bool {
    use Keyword::*;
    matches!(word, Exr | Hdr | Iff | Sys | Tiff)
}

fn unread(at: Place, format: &str) -> Box<Error> {
    let text = format!(
        "not supported yet: a picture of type {format}: durer reads png, tga, gif, pot, bmp, jpeg, pgm and ppm"
    );
    Error::at(at, ErrorKind::Unsupported, text)
}

/// Describes why a picture's size cannot be used.
fn check_size([columns, rows]: [usize; 2]) -> Option<String> {
    let fits = |n: usize| (2..=MOST_SAMPLES).contains(&n);
    (!fits(columns) || !fits(rows) || columns * rows > 1 << 30).then(|| {
        format!(
            "has {columns} x {rows} samples: from 2 x 2 to {MOST_SAMPLES} a side and 2^30 in all are read"
        )
    })
}

/// The memory, in bytes, of a field with this many samples and of their bounds.
fn bytes_of([columns, rows]: [usize; 2], each: usize) -> usize {
    columns * rows * (each + 3)
}

/// A function's values by rows, moved between 0 and 1, and how many had to be. The first row is at
/// y = 0.
fn sampled(formula: &Formula, size: [usize; 2]) -> (Vec<f64>, usize) {
    let tape = Tape::new(formula);
    heights_of(size, |x, y| tape.values(&[x, F8::splat(y), F8::ZERO]))
}

/// [`sampled`] for values at eight `x` and one `y`.
fn heights_of([columns, rows]: [usize; 2], values: impl Fn(F8, f64) -> F8) -> (Vec<f64>, usize) {
    let (mut heights, mut outside) = (Vec::with_capacity(columns * rows), 0);
    let at = |n: usize, count: usize| n.min(count - 1) as f64 / (count - 1) as f64;
    for row in 0..rows {
        let y = at(row, rows);
        for first in (0..columns).step_by(8) {
            let x = F8(std::array::from_fn(|k| at(first + k, columns)));
            for value in values(x, y).0.into_iter().take(columns - first) {
                let height = if value > 0.0 { value.min(1.0) } else { 0.0 };
                outside += usize::from(height != value);
                heights.push(height);
            }
        }
    }
    (heights, outside)
}
