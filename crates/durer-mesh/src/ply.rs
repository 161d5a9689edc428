//! PLY: a header that declares elements and their properties in any order, then the elements as
//! text or as binary numbers in either byte order. (G. Turk, "The PLY polygon file format",
//! Stanford 1994.)
//!
//! The reader uses `x y z`, `nx ny nz` and `u v` (or `s t`, `texture_u texture_v`) of `vertex`, and
//! the lists `vertex_indices` or `vertex_index` of `face` and of `tristrips`. It ignores everything
//! else.
//!
//! In a strip, every three consecutive vertices form a triangle, and every second triangle is
//! reversed; -1 ends a strip and begins another. A triangle that names a vertex twice connects two
//! parts of a strip. It is left out, but counts for the alternation.

use crate::Group;
use crate::error::{ErrorKind, Location};
use crate::group::{Corner, Groups};
use crate::text::{one_line, shortened};
use durer_math::{Point3, Vec3};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType};
use std::io::BufRead;

/// The useful properties of one element of the file.
#[derive(Default)]
struct Item {
    position: [f64; 3],
    normal: [f64; 3],
    uv: [f64; 2],
    corners: Vec<i64>,
}

impl PropertyAccess for Item {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let number = match value {
            Property::Char(x) => f64::from(x),
            Property::UChar(x) => f64::from(x),
            Property::Short(x) => f64::from(x),
            Property::UShort(x) => f64::from(x),
            Property::Int(x) => f64::from(x),
            Property::UInt(x) => f64::from(x),
            Property::Float(x) => f64::from(x),
            Property::Double(x) => x,
            list => return self.set_corners(name, list),
        };
        let place = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            "u" | "s" | "texture_u" => &mut self.uv[0],
            "v" | "t" | "texture_v" => &mut self.uv[1],
            _ => return PropertyAccessResult::Ignored,
        };
        *place = number;
        PropertyAccessResult::Set
    }
}

/// The names of texture coordinates.
const UV: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];

fn is_corners(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

fn wide<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
    list.into_iter().map(Into::into).collect()
}

impl Item {
    fn set_corners(&mut self, name: &str, list: Property) -> PropertyAccessResult {
        if !is_corners(name) {
            return PropertyAccessResult::Ignored;
        }
        self.corners = match list {
            Property::ListChar(list) => wide(list),
            Property::ListUChar(list) => wide(list),
            Property::ListShort(list) => wide(list),
            Property::ListUShort(list) => wide(list),
            Property::ListInt(list) => wide(list),
            Property::ListUInt(list) => wide(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The name of an element in messages.
fn kind(name: &str) -> &'static str {
    match name {
        "vertex" => "vertex",
        "face" => "face",
        "tristrips" => "strip",
        _ => "element",
    }
}

/// The least number of bytes of an element.
fn least_size(element: &ElementDef, encoding: Encoding) -> usize {
    let size = |property: &PropertyType| match (encoding, property) {
        (Encoding::Ascii, _) => 2,
        (_, PropertyType::Scalar(scalar) | PropertyType::List(scalar, _)) => {
            use ply_rs_bw::ply::ScalarType::{Char, Double, Float, Int, Short, UChar, UInt, UShort};
            match scalar {
                Char | UChar => 1,
                Short | UShort => 2,
                Int | UInt | Float => 4,
                Double => 8,
            }
        }
    };
    element.properties.values().map(|p| size(&p.data_type)).sum::<usize>().max(1)
}

pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Group>, ErrorKind> {
    let parser = Parser::<Item>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(|e| ErrorKind::Header(one_line(&e.to_string())))?;
    let mut groups = Groups::default();
    let mut has_normals = false;
    let mut has_uv = false;
    // The file's order is kept, but faces may come before their vertices.
    let mut faces: Vec<(Vec<i64>, Location)> = Vec::new();
    for element in header.elements.values() {
        let left = reader.get_ref().len();
        let room = (left + 1) / least_size(element, header.encoding);
        if element.count > room {
            let what = shortened(&format!("elements '{}'", element.name));
            return Err(ErrorKind::Promise { what, promised: element.count as u64, room: room as u64 });
        }
        let has = |names: &[&str]| names.iter().all(|name| element.properties.contains_key(*name));
        let is_vertices = element.name == "vertex";
        if is_vertices && !has(&["x", "y", "z"]) {
            return Err(ErrorKind::End {
                spot: Location::Element("vertex", 0),
                expected: "the properties x, y and z",
            });
        }
        has_normals |= is_vertices && has(&["nx", "ny", "nz"]);
        has_uv |= is_vertices && UV.iter().any(|names| has(names));
        for number in 0..element.count {
            let spot = Location::Element(kind(&element.name), number);
            let item = next(&parser, &mut reader, element, header.encoding, spot)?;
            match element.name.as_str() {
                "vertex" => {
                    groups.vertices.push(Point3::from(item.position));
                    if has_normals {
                        groups.normals.push(Vec3::from(item.normal));
                    }
                    if has_uv {
                        groups.uv.push(item.uv);
                    }
                }
                "face" | "tristrips" => faces.push((item.corners, spot)),
                _ => {}
            }
        }
    }
    let count = groups.vertices.len();
    let corner = |index: i64, spot: Location| {
        let vertex = u32::try_from(index).ok().filter(|v| (*v as usize) < count);
        let vertex = vertex.ok_or(ErrorKind::Index { spot, what: "vertex", index, count })?;
        Ok(Corner { vertex, uv: has_uv.then_some(vertex), normal: has_normals.then_some(vertex) })
    };
    let mut face = Vec::new();
    for (indices, spot) in faces {
        let is_strips = matches!(spot, Location::Element("strip", _));
        for part in indices.split(|&index| is_strips && is_end_of_strip(index)) {
            face.clear();
            for &index in part {
                face.push(corner(index, spot)?);
            }
            if is_strips {
                strip(&mut groups, &face, spot)?;
            } else {
                groups.face(&face, spot)?;
            }
        }
    }
    Ok(groups.end())
}

/// Whether an index is -1, also if it was read from an unsigned list.
fn is_end_of_strip(index: i64) -> bool {
    index == -1 || index == i64::from(u32::MAX)
}

/// Adds the triangles of a strip.
fn strip(groups: &mut Groups, corners: &[Corner], spot: Location) -> Result<(), ErrorKind> {
    for (i, triangle) in corners.windows(3).enumerate() {
        if let &[a, b, c] = triangle
            && a.vertex != b.vertex
            && b.vertex != c.vertex
            && c.vertex != a.vertex
        {
            groups.face(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] }, spot)?;
        }
    }
    Ok(())
}

fn next(
    parser: &Parser<Item>,
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    encoding: Encoding,
    spot: Location,
) -> Result<Item, ErrorKind> {
    let item = match encoding {
        Encoding::Ascii => {
            let mut line = Vec::new();
            let length = reader.get_mut().read_until(b'\n', &mut line);
            if length.is_err() || line.is_empty() {
                return Err(ErrorKind::End { spot, expected: "an element" });
            }
            parser.read_ascii_element(&String::from_utf8_lossy(&line), element)
        }
        Encoding::BinaryBigEndian => parser.read_big_endian_element(reader.get_mut(), element),
        Encoding::BinaryLittleEndian => parser.read_little_endian_element(reader.get_mut(), element),
    };
    item.map_err(|e| ErrorKind::Element { spot, said: one_line(&e.to_string()) })
}
