//! STL: single triangles, as text (`solid ... endsolid`, each a group) or binary (80 bytes, a
//! count, then 50 bytes for each triangle).
//!
//! Many binary files begin with `solid` too. Such a file is binary if bytes 80 to 83, where a
//! binary file has its count, contain a character that no text has, or if the file has that many
//! triangles: four characters of text would be a count above 150 million. Bytes after the last
//! triangle are ignored with a warning. Corners with the same coordinates become one vertex. The
//! normals in the file are ignored: the order of the corners determines the side. (3D
//! Systems, *StereoLithography Interface Specification*, 1988.)

use crate::error::{ErrorKind, Location};
use crate::text::{lines, shortened, three, without_mark};
use crate::{Group, Warning};
use durer_math::Point3;
use durer_scene::Face;
use std::collections::HashMap;

const HEADER: usize = 84;
const RECORD: usize = 50;

pub(crate) fn read(bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<Vec<Group>, ErrorKind> {
    let solid = without_mark(bytes).trim_ascii_start();
    let begins_as_text = solid.get(..5).is_some_and(|b| b.eq_ignore_ascii_case(b"solid"));
    let end = |expected| ErrorKind::End { spot: Location::Byte(bytes.len()), expected };
    let Some(count) = bytes.get(80..HEADER).and_then(|b| <[u8; 4]>::try_from(b).ok()) else {
        return match (begins_as_text, bytes.iter().all(|b| may_be_text(*b))) {
            (true, true) => text(without_mark(bytes)),
            (true, false) => Err(end("the rest of a binary header of 84 bytes")),
            _ => {
                let found = shortened(&String::from_utf8_lossy(bytes.get(..16).unwrap_or(bytes)));
                let expected = "'solid' or a binary header";
                Err(ErrorKind::Expected { spot: Location::Byte(0), expected, found })
            }
        };
    };
    let promised = u32::from_le_bytes(count);
    let room = (bytes.len() - HEADER) / RECORD;
    let is_there = room as u64 >= u64::from(promised);
    if begins_as_text && !is_there && count.iter().all(|b| may_be_text(*b)) {
        return text(without_mark(bytes));
    }
    if !is_there {
        let is_begun = !(bytes.len() - HEADER).is_multiple_of(RECORD);
        return Err(ErrorKind::Cut { is_begun, triangle: room as u64 + 1, promised });
    }
    let at = HEADER + RECORD * promised as usize;
    if bytes.len() > at {
        warnings.push(Warning::Trailing { at, triangles: promised, count: bytes.len() - at });
    }
    binary(bytes, promised as usize)
}

/// Whether a byte may occur in text: any but control characters that are not white space.
fn may_be_text(byte: u8) -> bool {
    !byte.is_ascii_control() || matches!(byte, b'\t'..=b'\r')
}

/// Collects triangles and merges equal corners to vertices.
#[derive(Default)]
struct Welder {
    group: Group,
    known: HashMap<[u64; 3], u32>,
}

impl Welder {
    fn triangle(&mut self, corners: [[f64; 3]; 3]) -> Result<(), ErrorKind> {
        let mesh = &mut self.group.mesh;
        let mut vertices = [0; 3];
        for (vertex, corner) in vertices.iter_mut().zip(corners) {
            // Adding zero turns -0 into +0.
            let key = corner.map(|x| (x + 0.0).to_bits());
            *vertex = match self.known.get(&key) {
                Some(&v) => v,
                None => {
                    let v = u32::try_from(mesh.vertices.len()).map_err(|_| ErrorKind::TooMany)?;
                    mesh.vertices.push(Point3::from(corner));
                    self.known.insert(key, v);
                    v
                }
            };
        }
        mesh.faces.push(Face { vertices, normals: None, texture: None });
        Ok(())
    }
}

fn binary(bytes: &[u8], count: usize) -> Result<Vec<Group>, ErrorKind> {
    let mut welder = Welder::default();
    for record in bytes[HEADER..].chunks_exact(RECORD).take(count) {
        let number = |at: usize| f64::from(f32::from_le_bytes(core::array::from_fn(|i| record[at + i])));
        let corner = |i: usize| core::array::from_fn(|axis| number(12 + 12 * i + 4 * axis));
        welder.triangle([corner(0), corner(1), corner(2)])?;
    }
    Ok(if welder.group.mesh.faces.is_empty() { Vec::new() } else { vec![welder.group] })
}

/// The state of the text parser: the construct that the current line is in.
#[derive(Clone, Copy, PartialEq)]
enum Inside {
    File,
    Solid,
    Facet,
    Loop,
    LoopDone,
}

fn text(bytes: &[u8]) -> Result<Vec<Group>, ErrorKind> {
    let mut groups = Vec::new();
    let mut welder = Welder::default();
    let mut inside = Inside::File;
    let mut corners = Vec::with_capacity(3);
    let mut last = 1;
    for (number, line) in lines(bytes) {
        let mut words = line.split_whitespace();
        let Some(word) = words.next() else { continue };
        last = number;
        let spot = Location::Line(number);
        let wrong = |expected| Err(ErrorKind::Expected { spot, expected, found: shortened(line.trim()) });
        let lower = word.to_ascii_lowercase();
        inside = match (inside, lower.as_str()) {
            (Inside::File, "solid") => {
                welder.group.name = line.trim_start()[word.len()..].trim().to_string();
                Inside::Solid
            }
            (Inside::Solid, "facet") => Inside::Facet,
            (Inside::Solid, "endsolid") => {
                let Welder { group, .. } = std::mem::take(&mut welder);
                if !group.mesh.faces.is_empty() {
                    groups.push(group);
                }
                Inside::File
            }
            (Inside::Facet, "outer") => Inside::Loop,
            (Inside::Loop, "vertex") if corners.len() < 3 => {
                corners.push(three(&mut words, number, "three coordinates")?);
                Inside::Loop
            }
            (Inside::Loop, "endloop") => match *corners {
                [a, b, c] => {
                    welder.triangle([a, b, c])?;
                    corners.clear();
                    Inside::LoopDone
                }
                _ => return wrong("'vertex', three times"),
            },
            (Inside::LoopDone, "endfacet") => Inside::Solid,
            (Inside::File, _) => return wrong("'solid'"),
            (Inside::Solid, _) => return wrong("'facet' or 'endsolid'"),
            (Inside::Facet, _) => return wrong("'outer loop'"),
            (Inside::Loop, _) if corners.len() == 3 => return wrong("'endloop'"),
            (Inside::Loop, _) => return wrong("'vertex'"),
            (Inside::LoopDone, _) => return wrong("'endfacet'"),
        };
    }
    match inside {
        Inside::File => Ok(groups),
        _ => Err(ErrorKind::End { spot: Location::Line(last), expected: "'endsolid'" }),
    }
}
