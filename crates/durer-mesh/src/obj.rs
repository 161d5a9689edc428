//! OBJ: text, one statement a line.
//!
//! The reader understands `v`, `vt` (two numbers of up to three), `vn`, and `f` with indices from 1
//! or, if negative, back from the latest item. `o` and `g` each start a group, and a backslash
//! continues a line. Indices of missing texture coordinates and normals are left out with one
//! warning: programs that export only vertices write such files. Points, lines, materials and
//! smoothing groups are ignored. Free-form curves and surfaces are refused.
//! (Alias/Wavefront, *Advanced Visualizer*, appendix B1, 1991.)

use crate::error::{ErrorKind, Location};
use crate::group::{Corner, Groups};
use crate::text::{lines, number, shortened, three};
use crate::{Group, Warning};
use durer_math::{Point3, Vec3};
use durer_scene::SubdivisionData;

/// Statements that are ignored.
const PASSED_OVER: [&str; 15] = [
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

pub(crate) fn read(bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<Vec<Group>, ErrorKind> {
    let mut groups = Groups::default();
    statements(bytes, warnings, &mut groups)?;
    Ok(groups.end())
}

/// The polygons as a control mesh. Groups and normals are ignored. Texture coordinates are kept if
/// all corners have some.
pub(crate) fn control_mesh(bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<SubdivisionData, ErrorKind> {
    let mut polygons = Polygons::default();
    statements(bytes, warnings, &mut polygons)?;
    let Polygons { mut data, lacks_uv, .. } = polygons;
    if data.faces.is_empty() {
        return Err(ErrorKind::Empty);
    }
    if lacks_uv {
        (data.uv, data.uv_faces) = (Vec::new(), Vec::new());
    }
    Ok(data)
}

/// The receiver of the statements.
trait Receiver {
    /// How many vertices, texture coordinates and normals there are so far.
    fn counts(&self) -> [usize; 3];
    fn vertex(&mut self, p: Point3);
    fn normal(&mut self, n: Vec3);
    fn uv(&mut self, uv: [f64; 2]);
    fn face(&mut self, face: &[Corner], spot: Location) -> Result<(), ErrorKind>;
    fn begin(&mut self, name: &str);
}

impl Receiver for Groups {
    fn counts(&self) -> [usize; 3] {
        [self.vertices.len(), self.uv.len(), self.normals.len()]
    }

    fn vertex(&mut self, p: Point3) {
        self.vertices.push(p);
    }

    fn normal(&mut self, n: Vec3) {
        self.normals.push(n);
    }

    fn uv(&mut self, uv: [f64; 2]) {
        self.uv.push(uv);
    }

    fn face(&mut self, face: &[Corner], spot: Location) -> Result<(), ErrorKind> {
        Groups::face(self, face, spot)
    }

    fn begin(&mut self, name: &str) {
        Groups::begin(self, name);
    }
}

#[derive(Default)]
struct Polygons {
    data: SubdivisionData,
    normals: usize,
    lacks_uv: bool,
}

impl Receiver for Polygons {
    fn counts(&self) -> [usize; 3] {
        [self.data.vertices.len(), self.data.uv.len(), self.normals]
    }

    fn vertex(&mut self, p: Point3) {
        self.data.vertices.push(p);
    }

    fn normal(&mut self, _: Vec3) {
        self.normals += 1;
    }

    fn uv(&mut self, uv: [f64; 2]) {
        self.data.uv.push(uv);
    }

    fn face(&mut self, face: &[Corner], _: Location) -> Result<(), ErrorKind> {
        self.data.faces.push(face.iter().map(|corner| corner.vertex).collect());
        let uv: Option<Vec<u32>> = face.iter().map(|corner| corner.uv).collect();
        self.lacks_uv |= uv.is_none();
        self.data.uv_faces.extend(uv);
        Ok(())
    }

    fn begin(&mut self, _: &str) {}
}

fn statements(bytes: &[u8], warnings: &mut Vec<Warning>, to: &mut dyn Receiver) -> Result<(), ErrorKind> {
    let mut dangling = None;
    let mut face = Vec::new();
    let mut continued = String::new();
    for (at, line) in lines(bytes) {
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
            "v" => to.vertex(Point3::from(three(&mut words, at, "three coordinates")?)),
            "vn" => to.normal(Vec3::from(three(&mut words, at, "three components")?)),
            "vt" => to.uv(texture_coordinates(&mut words, at)?),
            "f" => {
                let counts = to.counts();
                face.clear();
                for word in words {
                    face.push(corner(word, counts, Location::Line(at), &mut dangling)?);
                }
                if face.is_empty() {
                    return Err(ErrorKind::End { spot: Location::Line(at), expected: "a face's corners" });
                }
                to.face(&face, Location::Line(at))?;
            }
            "o" | "g" => to.begin(line.trim_start()[word.len()..].trim()),
            _ if PASSED_OVER.contains(&word) => {}
            _ if FREE_FORM.contains(&word) => {
                return Err(ErrorKind::Unsupported { spot: Location::Line(at), what: word.to_string() });
            }
            _ => {
                let found = shortened(word);
                return Err(ErrorKind::Expected { spot: Location::Line(at), expected: "a statement", found });
            }
        }
    }
    warnings.extend(dangling);
    Ok(())
}

/// Reads one or two numbers. A missing second number is zero; a third one, for solid textures, is
/// ignored.
fn texture_coordinates<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    line: usize,
) -> Result<[f64; 2], ErrorKind> {
    const EXPECTED: &str = "texture coordinates";
    let mut words = words.peekable();
    let u = number(&mut words, line, EXPECTED)?;
    Ok([u, if words.peek().is_some() { number(&mut words, line, EXPECTED)? } else { 0.0 }])
}

/// Reads a corner as `v`, `v/vt`, `v//vn` or `v/vt/vn`. Missing texture coordinates and normals are
/// left out and counted in `dangling`.
fn corner(
    word: &str,
    counts: [usize; 3],
    spot: Location,
    dangling: &mut Option<Warning>,
) -> Result<Corner, ErrorKind> {
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
        if number.is_none() && i == 0 {
            return Err(ErrorKind::Index { spot, what: WHAT[i], index, count });
        }
        if number.is_none() {
            let first = Warning::Dangling { spot, what: WHAT[i], index, count, uv: 0, normals: 0 };
            if let Warning::Dangling { uv, normals, .. } = dangling.get_or_insert(first) {
                *(if i == 1 { uv } else { normals }) += 1;
            }
        }
        numbers[i] = number;
    }
    let [vertex, uv, normal] = numbers;
    // The vertex is never missing: an empty word is not a number.
    Ok(Corner { vertex: vertex.unwrap_or_default(), uv, normal })
}
