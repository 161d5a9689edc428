//! OBJ: text, one statement a line.
//!
//! Read are `v`, `vn`, `f` with indices from 1 or, negative, from the end of what was given so far, `o` and `g` (each begins a group), and lines that a
//! backslash continues. Texture coordinates, points, lines, materials and smoothing groups are passed over: nothing in a scene depends on them yet. Free-form curves
//! and surfaces are refused. (Alias/Wavefront, *Advanced Visualizer*, appendix B1, 1991.)

use crate::Group;
use crate::error::{ErrorKind, Spot};
use crate::group::{Corner, Groups};
use crate::text::{lines, shortened, three};
use durer_math::{Point3, Vec3};

/// Statements about what is passed over.
const PASSED_OVER: [&str; 16] = [
    "vt",
    "p",
    "l",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "call",
];

/// Statements of free-form geometry.
const FREE_FORM: [&str; 16] = [
    "vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
    "end", "con", "ctech",
];

pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Group>, ErrorKind> {
    let mut groups = Groups::default();
    let mut texture_coordinates = 0;
    let mut face = Vec::new();
    let mut continued = String::new();
    for (number, line) in lines(bytes) {
        let line = line.split('#').next().unwrap_or_default();
        if let Some(part) = line.trim_end().strip_suffix('\\') {
            continued.push_str(part);
            continued.push(' ');
            continue;
        }
        let joined;
        let line = if continued.is_empty() {
            line
        } else {
            joined = std::mem::take(&mut continued) + line;
            &joined
        };
        let mut words = line.split_whitespace();
        let Some(word) = words.next() else { continue };
        match word {
            "v" => groups.vertices.push(Point3::from(three(&mut words, number, "three coordinates")?)),
            "vn" => groups.normals.push(Vec3::from(three(&mut words, number, "three components")?)),
            "vt" => texture_coordinates += 1,
            "f" => {
                let counts = [groups.vertices.len(), texture_coordinates, groups.normals.len()];
                face.clear();
                for word in words {
                    face.push(corner(word, counts, Spot::Line(number))?);
                }
                if face.is_empty() {
                    return Err(ErrorKind::End { spot: Spot::Line(number), expected: "a face's corners" });
                }
                groups.face(&face, Spot::Line(number))?;
            }
            "o" | "g" => groups.begin(line.trim_start()[word.len()..].trim()),
            _ if PASSED_OVER.contains(&word) => {}
            _ if FREE_FORM.contains(&word) => {
                return Err(ErrorKind::Unsupported { spot: Spot::Line(number), what: word.to_string() });
            }
            _ => {
                let found = shortened(word);
                return Err(ErrorKind::Expected { spot: Spot::Line(number), expected: "a statement", found });
            }
        }
    }
    Ok(groups.end())
}

/// A corner as `v`, `v/vt`, `v//vn` or `v/vt/vn`.
fn corner(word: &str, counts: [usize; 3], spot: Spot) -> Result<Corner, ErrorKind> {
    const WHAT: [&str; 3] = ["vertex", "texture coordinate", "normal"];
    let mut numbers = [None; 3];
    for (i, part) in word.split('/').enumerate() {
        let wrong = || ErrorKind::Expected { spot, expected: "a corner's indices", found: shortened(word) };
        if i > 2 {
            return Err(wrong());
        }
        if part.is_empty() && i > 0 {
            continue;
        }
        let index: i64 = part.parse().map_err(|_| wrong())?;
        let count = counts[i];
        let number = if index < 0 { index.checked_add(count as i64) } else { index.checked_sub(1) };
        let number = number.and_then(|n| u32::try_from(n).ok()).filter(|n| (*n as usize) < count);
        numbers[i] = Some(number.ok_or(ErrorKind::Index { spot, what: WHAT[i], index, count })?);
    }
    let [vertex, _, normal] = numbers;
    // The first part is never left out: an empty one is no number.
    Ok(Corner { vertex: vertex.unwrap_or_default(), normal })
}
