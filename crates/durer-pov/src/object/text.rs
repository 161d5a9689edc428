//! `text`: letters of a font as prisms of their outlines.
//!
//! One unit is the font's em. The letters stand on the x axis from the origin, and reach from the
//! plane `z = 0` to `z = thickness`.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use durer_scene::{self as scene, Curve, Prism, Spline, Sweep};
use ttf_parser::{Face, GlyphId, OutlineBuilder, Tag};

use super::{Object, Shape};
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::{Item, Parser};
use crate::shipped;
use crate::source::read_bytes;
use crate::transform::Matrix;

/// The fonts that POV-Ray has by number.
const NUMBERED: [&str; 4] = ["timrom.ttf", "cyrvetic.ttf", "crystal.ttf", "povlogo.ttf"];

/// Outlines are in `x` and `z` of a prism, whose height is the letter's depth.
const UPRIGHT: Matrix = Matrix { rows: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]] };

/// The outlines of a glyph as cubic curves, scaled to the em.
struct Outlines {
    scale: f64,
    done: Vec<Vec<[f64; 2]>>,
    current: Vec<[f64; 2]>,
    start: [f64; 2],
    at: [f64; 2],
}

impl Outlines {
    fn point(&self, x: f32, y: f32) -> [f64; 2] {
        [f64::from(x) * self.scale, f64::from(y) * self.scale]
    }

    fn curve(&mut self, b: [f64; 2], c: [f64; 2], end: [f64; 2]) {
        if b != self.at || c != self.at || end != self.at {
            self.current.extend([self.at, b, c, end]);
            self.at = end;
        }
    }

    fn line(&mut self, end: [f64; 2]) {
        let start = self.at;
        let part = |k: f64| [0, 1].map(|i| start[i] + (end[i] - start[i]) * k);
        if end != start {
            self.curve(part(1.0 / 3.0), part(2.0 / 3.0), end);
        }
    }
}

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        self.start = self.point(x, y);
        self.at = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.line(self.point(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (start, middle, end) = (self.at, self.point(x1, y1), self.point(x, y));
        let towards = |from: [f64; 2]| [0, 1].map(|i| from[i] + (middle[i] - from[i]) * (2.0 / 3.0));
        self.curve(towards(start), towards(end), end);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.curve(self.point(x1, y1), self.point(x2, y2), self.point(x, y));
    }

    fn close(&mut self) {
        self.line(self.start);
        if !self.current.is_empty() {
            self.done.push(std::mem::take(&mut self.current));
        }
    }
}

/// The glyph of a letter; fonts without a table for Unicode have one for the Macintosh or one of
/// symbols.
fn glyph(face: &Face<'_>, letter: char) -> GlyphId {
    let code = u32::from(letter);
    let tables = || face.tables().cmap.iter().flat_map(|cmap| cmap.subtables);
    let any = |code: u32| tables().find_map(|table| table.glyph_index(code));
    let found = face.glyph_index(letter).filter(|id| id.0 != 0);
    found.or_else(|| any(code)).or_else(|| any(code + 0xf000)).unwrap_or(GlyphId(0))
}

/// How much farther apart pairs of glyphs stand than their widths say, in units of the font.
///
/// Old fonts do not sort their pairs, so the table is read from its beginning to its end.
fn kerning(face: &Face<'_>) -> HashMap<[u16; 2], i16> {
    let table = face.raw_face().table(Tag::from_bytes(b"kern")).unwrap_or(&[]);
    let word = |at: usize| {
        let bytes = table.get(at..at + 2)?;
        Some(u16::from_be_bytes([bytes[0], bytes[1]]))
    };
    let mut pairs = HashMap::new();
    // Version 0: the number of subtables, and for each its version, length and coverage.
    let count = if word(0) == Some(0) { word(2).unwrap_or(0) } else { 0 };
    let mut start = 4;
    for _ in 0..count {
        let (Some(length), Some(coverage), Some(length_of_list)) =
            (word(start + 2), word(start + 4), word(start + 6))
        else {
            break;
        };
        // Format 0, horizontal: a list of pairs.
        if coverage >> 8 == 0 && coverage & 1 == 1 {
            for pair in 0..usize::from(length_of_list) {
                let at = start + 14 + 6 * pair;
                let (Some(left), Some(right), Some(way)) = (word(at), word(at + 2), word(at + 4)) else {
                    break;
                };
                pairs.entry([left, right]).or_insert(way as i16);
            }
        }
        start += usize::from(length).max(1);
    }
    pairs
}

impl Parser<'_> {
    /// Reads the contents of `text { ... }` up to the modifiers.
    pub(super) fn text(&mut self, place: Place) -> Result<Shape> {
        let name = self.font_name()?;
        let at = self.here();
        self.skip_comma()?;
        let text = self.string("the text")?;
        self.skip_comma()?;
        self.peek()?;
        let thickness_at = self.here();
        let thickness = self.float()?;
        self.skip_comma()?;
        let offset = if self.starts_number()? {
            let terms = self.expression()?;
            // A single number is the offset along x.
            terms.float().map_or(terms.xyz(), |x| [x, 0.0, 0.0])
        } else {
            [0.0; 3]
        };
        if thickness == 0.0 {
            return Ok(self.nothing("this text has no thickness", thickness_at));
        }
        let (path, bytes) = self.font(&name, at)?;
        let face = Face::parse(&bytes, 0).map_err(|why| {
            let path = path.display();
            Error::file(Some(at), format!("{path}: not a font that can be read: {why}"))
        })?;
        self.letters(&face, &text, thickness, offset, place)
    }

    /// The path of a font's file and its contents. The ending may be left out.
    fn font(&mut self, name: &str, at: Place) -> Result<(PathBuf, Cow<'static, [u8]>)> {
        if let Some(path) = self.library.find(name).or_else(|| self.library.find(&format!("{name}.ttf"))) {
            return match read_bytes(&path, &self.options.limits, "a font") {
                Ok(bytes) => Ok((path, Cow::Owned(bytes))),
                Err(why) => Err(Error::file(Some(at), format!("{}: {why}", path.display()))),
            };
        }
        if let Some(font) = shipped::font(name) {
            let text = "this font comes with POV-Ray, which is not installed: Liberation Serif is used";
            self.notice(at, text);
            return Ok((PathBuf::from(name), Cow::Borrowed(font)));
        }
        let folders = self.library.listed();
        Err(Error::file(Some(at), format!("there is no font \"{name}\"; searched: {folders}")))
    }

    /// The name of the font's file.
    fn font_name(&mut self) -> Result<String> {
        let lexeme = self.next()?;
        match lexeme.item {
            Item::Word(Keyword::Ttf) => self.file_name(),
            Item::Word(Keyword::Internal) => {
                self.peek()?;
                let at = self.here();
                let number = self.float()?;
                let known = (0.0..4.0).contains(&number) && number.fract() == 0.0;
                match NUMBERED.get(number as usize).filter(|_| known) {
                    Some(name) => Ok((*name).to_owned()),
                    None => Err(Error::invalid(at, format!("internal fonts are 0 to 3, not {number}"))),
                }
            }
            _ => Err(self.unexpected(&lexeme, "ttf or internal")),
        }
    }

    /// The prisms of all letters.
    fn letters(
        &mut self,
        face: &Face<'_>,
        text: &str,
        thickness: f64,
        offset: [f64; 3],
        place: Place,
    ) -> Result<Shape> {
        let scale = 1.0 / f64::from(face.units_per_em());
        let pairs = kerning(face);
        let mut pen = [0.0; 3];
        let mut before = None;
        let mut parts = Vec::new();
        for letter in text.chars() {
            let id = glyph(face, letter);
            match before {
                Some(GlyphId(before)) => {
                    pen[0] += f64::from(*pairs.get(&[before, id.0]).unwrap_or(&0)) * scale;
                }
                // The first letter itself begins at the origin (a fact of the language).
                None => {
                    let left = face.glyph_bounding_box(id).map_or(0, |bounds| bounds.x_min);
                    pen[0] -= f64::from(left) * scale;
                }
            }
            let mut outlines =
                Outlines { scale, done: Vec::new(), current: Vec::new(), start: [0.0; 2], at: [0.0; 2] };
            if face.outline_glyph(id, &mut outlines).is_some() && !outlines.done.is_empty() {
                let points: usize = outlines.done.iter().map(Vec::len).sum();
                self.check_memory(points * 16, place)?;
                self.count_steps(points as u64, place)?;
                let prism = Prism {
                    outlines: outlines.done,
                    spline: Spline::Curved(Curve::Bezier),
                    heights: [0.0, thickness],
                    sweep: Sweep::Linear,
                };
                let mut part = Object::new(scene::Shape::Prism(Arc::new(prism)).into(), place);
                part.place = UPRIGHT.then(&Matrix::translation(pen));
                parts.push(Rc::new(part));
            }
            let width = face.glyph_hor_advance(id).unwrap_or(0);
            pen[0] += f64::from(width) * scale;
            for (pen, offset) in pen.iter_mut().zip(offset) {
                *pen += offset;
            }
            before = Some(id);
        }
        if parts.is_empty() {
            return Ok(self.nothing("this text has no visible letters", place));
        }
        Ok(Shape::Union(parts))
    }
}
