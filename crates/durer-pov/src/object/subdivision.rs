//! Subdivision surfaces, by words like those of `mesh2`.

use std::sync::Arc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::source::read_bytes;
use durer_math::Point3;
use durer_scene::{self as scene, Boundary, Scheme, SubdivisionData, UvInterpolation};

/// Bytes of a list of corners, besides them.
const LIST: usize = size_of::<Vec<u32>>();

/// How much memory a control mesh takes.
pub(super) fn bytes(data: &SubdivisionData) -> usize {
    let lists = |faces: &[Vec<u32>]| faces.iter().map(|f| LIST + f.len() * 4).sum::<usize>();
    data.vertices.len() * 24 + data.uv.len() * 16 + lists(&data.faces) + lists(&data.uv_faces)
}

impl Parser<'_> {
    /// `"file.obj"`, or lists as in `mesh2`, with `scheme`, `creases`, `corners`, `holes`,
    /// `boundary` and `uv_interpolation` among them in any order.
    pub(super) fn subdivision(&mut self, place: Place) -> Result<Shape> {
        let mut data = SubdivisionData::default();
        let mut found = false;
        loop {
            self.skip_comma()?;
            let word = self.peek_word()?;
            let at = self.here();
            if matches!(self.peek()?, Item::Text(..)) {
                let file = self.control_file()?;
                (data.vertices, data.faces, data.uv, data.uv_faces) =
                    (file.vertices, file.faces, file.uv, file.uv_faces);
                found = true;
                continue;
            }
            match word {
                Some(Keyword::VertexVectors) => {
                    self.next()?;
                    data.vertices = self.counted(24, |r| r.corner().map(Point3::from))?;
                    continue;
                }
                Some(Keyword::UvVectors) => {
                    self.next()?;
                    data.uv = self.counted(16, |r| {
                        let uv = r.vector2()?;
                        r.skip_comma()?;
                        Ok(uv)
                    })?;
                    continue;
                }
                Some(Keyword::FaceIndices) => {
                    self.next()?;
                    data.faces = self.counted(LIST + 16, |r| r.face_corners("a face"))?;
                    found = true;
                    continue;
                }
                Some(Keyword::UvIndices) => {
                    self.next()?;
                    data.uv_faces = self.counted(LIST + 16, |r| r.face_corners("uv_indices"))?;
                    continue;
                }
                _ => {}
            }
            if self.small_word("scheme")? {
                self.peek()?;
                let at = self.here();
                data.scheme = if self.small_word("loop")? {
                    Scheme::Loop
                } else if self.small_word("catmull_clark")? {
                    Scheme::CatmullClark
                } else {
                    return Err(Error::invalid(at, "a scheme is catmull_clark or loop"));
                };
            } else if self.small_word("creases")? {
                data.creases = self.counted(16, |r| {
                    let [a, b, sharpness] = r.crease::<3>("a crease is <vertex, vertex, sharpness>", 2)?;
                    Ok(([a as u32, b as u32], sharpness))
                })?;
            } else if self.small_word("corners")? {
                data.corners = self.counted(16, |r| {
                    let [v, sharpness] = r.crease::<2>("a corner is <vertex, sharpness>", 1)?;
                    Ok((v as u32, sharpness))
                })?;
            } else if self.small_word("holes")? {
                data.holes = self.counted(4, |r| {
                    r.peek()?;
                    let at = r.here();
                    let index = r.float()?;
                    r.skip_comma()?;
                    whole(index, at, "a hole")
                })?;
            } else if self.small_word("boundary")? {
                self.peek()?;
                let at = self.here();
                data.boundary = if self.small_word("smooth")? || self.take_word(Keyword::Smooth)? {
                    Boundary::Smooth
                } else if self.small_word("corners")? {
                    Boundary::Corners
                } else {
                    return Err(Error::invalid(at, "a boundary is smooth or corners"));
                };
            } else if self.small_word("uv_interpolation")? {
                self.peek()?;
                let at = self.here();
                data.uv_interpolation = if self.small_word("smooth")? || self.take_word(Keyword::Smooth)? {
                    UvInterpolation::Smooth
                } else if self.small_word("linear")? {
                    UvInterpolation::Linear
                } else {
                    return Err(Error::invalid(at, "uv_interpolation is linear or smooth"));
                };
            } else if self.small_word("displace")? {
                return Err(Error::invalid(at, "durer does not displace subdivision surfaces"));
            } else {
                break;
            }
            self.check_memory(bytes(&data), at)?;
        }
        if !found {
            return Err(Error::invalid(place, "this subdivision has no face_indices"));
        }
        match data.check() {
            Err(nothing @ scene::SubdivisionError::Nothing(_)) => {
                Ok(self.nothing(&nothing.to_string(), place))
            }
            Err(why) => Err(Error::invalid(place, why.to_string())),
            Ok(()) => Ok(scene::Shape::Subdivision(Arc::new(data)).into()),
        }
    }

    /// The polygons of an OBJ file.
    fn control_file(&mut self) -> Result<SubdivisionData> {
        let name = self.file_name()?;
        let at = self.here();
        let Some(path) = self.library.find(&name) else {
            let folders = self.library.listed();
            return Err(Error::file(Some(at), format!("there is no mesh \"{name}\"; searched: {folders}")));
        };
        let bad = |why: String| Error::file(Some(at), format!("{}: {why}", path.display()));
        if durer_mesh::Format::of(&path) != Some(durer_mesh::Format::Obj) {
            return Err(bad(durer_mesh::ErrorKind::Polygons.to_string()));
        }
        let bytes = read_bytes(&path, &self.options.limits, "a mesh").map_err(bad)?;
        self.check_memory(bytes.len().saturating_mul(2), at)?;
        let (data, warnings) = durer_mesh::control_mesh(&bytes).map_err(|why| bad(why.to_string()))?;
        for warning in warnings {
            self.notice(at, format!("{}: {warning}", path.display()));
        }
        Ok(data)
    }

    /// `<a, b, c>`, up to five of them, or `{ K, i1, ..., iK }`.
    fn face_corners(&mut self, what: &str) -> Result<Vec<u32>> {
        self.peek()?;
        let at = self.here();
        if self.take_mark(Mark::BraceOpen)? {
            let count = self.float()?;
            self.skip_comma()?;
            let count = whole(count, at, what)?;
            let mut corners = Vec::new();
            for n in 0..count {
                self.check_memory(n as usize * 4, at)?;
                let index = self.float()?;
                self.skip_comma()?;
                corners.push(whole(index, at, what)?);
            }
            self.expect(Mark::BraceClose)?;
            self.skip_comma()?;
            return Ok(corners);
        }
        let value = self.expression()?;
        self.skip_comma()?;
        let numbers = value.as_slice();
        if numbers.len() < 3 {
            let text = format!("{what} has 3 numbers at least, here are {}", numbers.len());
            return Err(Error::invalid(at, text));
        }
        numbers.iter().map(|x| whole(*x, at, what)).collect()
    }

    /// A vector of numbers, of which the first `indices` are whole.
    fn crease<const N: usize>(&mut self, what: &str, indices: usize) -> Result<[f64; N]> {
        self.peek()?;
        let at = self.here();
        let value = self.expression()?;
        self.skip_comma()?;
        let numbers: [f64; N] =
            value.as_slice().try_into().map_err(|_| Error::invalid(at, what.to_string()))?;
        for index in &numbers[..indices] {
            whole(*index, at, "a vertex")?;
        }
        Ok(numbers)
    }
}

/// A number as an index.
fn whole(x: f64, at: Place, what: &str) -> Result<u32> {
    if x.fract() != 0.0 || !(0.0..f64::from(u32::MAX)).contains(&x) {
        return Err(Error::invalid(at, format!("{what} has whole numbers from 0 on, not {x}")));
    }
    Ok(x as u32)
}
