//! Control meshes: what a subdivision surface is made from, and what is refused.

use durer_math::Point3;
use std::collections::HashMap;

/// How faces are refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Any polygons; the limit is bicubic almost everywhere. E. Catmull, J. Clark, "Recursively
    /// generated B-spline surfaces on arbitrary topological meshes", *Computer-Aided Design* 10
    /// (1978) 350-355.
    #[default]
    CatmullClark,
    /// Triangles; the limit is a quartic box spline almost everywhere. C. Loop, *Smooth subdivision
    /// surfaces based on triangles*, master's thesis, University of Utah 1987.
    Loop,
}

/// The rule at vertices that only one face has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// They are sharp corners.
    #[default]
    Corners,
    /// The boundary goes round them as a smooth curve.
    Smooth,
}

/// How texture coordinates go over a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UvInterpolation {
    /// Linear from corner to corner; in a quadrilateral bilinear.
    #[default]
    Linear,
    /// By the rules of the surface: they are the limit of the mesh that the faces make with their
    /// texture coordinates. Where neighbours give a vertex different ones is a boundary of that
    /// mesh; creases and corners of the surface are creases and corners of it.
    Smooth,
}

/// From this sharpness on an edge or a vertex is sharp for ever.
pub(super) const INFINITELY_SHARP: f64 = 10.0;

/// The input of a [`SubdivisionSurface`](super::SubdivisionSurface). Numbers of vertices and faces
/// count from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubdivisionData {
    /// How faces are refined.
    pub scheme: Scheme,
    /// The control points.
    pub vertices: Vec<Point3>,
    /// The faces: the numbers of their vertices, counter-clockwise seen from where the normal points.
    pub faces: Vec<Vec<u32>>,
    /// Texture coordinates.
    pub uv: Vec<[f64; 2]>,
    /// The numbers of the texture coordinates at the corners of each face; empty if there are none.
    pub uv_faces: Vec<Vec<u32>>,
    /// How they go over a face.
    pub uv_interpolation: UvInterpolation,
    /// Sharp edges: two vertices, and a sharpness; 10 or more is sharp for ever.
    pub creases: Vec<([u32; 2], f64)>,
    /// Sharp vertices, and their sharpness.
    pub corners: Vec<(u32, f64)>,
    /// Faces that take part in the rules and are not there.
    pub holes: Vec<u32>,
    /// The rule of boundaries.
    pub boundary: Boundary,
}

/// The range of the numbers of `count` vertices, for messages.
fn numbers(count: usize) -> String {
    count.checked_sub(1).map_or_else(String::new, |last| format!(" (0 to {last})"))
}

/// Why a [`SubdivisionSurface`](super::SubdivisionSurface) cannot exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SubdivisionError {
    /// There are no faces.
    #[error("subdivision: it has no faces")]
    NoFaces,
    /// There are more vertices or faces than can be numbered.
    #[error("subdivision: {0} vertices or faces are too many")]
    TooMany(usize),
    /// A vertex is infinite, NaN or too large.
    #[error("subdivision: vertex {vertex} must be finite and less than 2^200, got <{x}, {y}, {z}>")]
    Vertex {
        /// The vertex.
        vertex: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its z.
        z: f64,
    },
    /// A face has fewer than three vertices.
    #[error("subdivision: face {face} has {len} vertices, it needs 3 at least")]
    FaceSize {
        /// The face.
        face: usize,
        /// How many it has.
        len: usize,
    },
    /// A face is no triangle, as Loop's rules need it.
    #[error("subdivision: face {face} has {len} vertices, Loop's rules are for triangles")]
    NotTriangle {
        /// The face.
        face: usize,
        /// How many vertices it has.
        len: usize,
    },
    /// A face names a vertex that is not there.
    #[error("subdivision: face {face} names vertex {vertex}, there are {count}{}", numbers(*count))]
    Index {
        /// The face.
        face: usize,
        /// The number that it gives.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// A face names a vertex twice.
    #[error("subdivision: face {face} has vertex {vertex} twice")]
    Twice {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: u32,
    },
    /// More than two faces share an edge.
    #[error(
        "subdivision: the edge of vertices {a} and {b} has more than two faces: {}, {} and {}",
        faces[0], faces[1], faces[2]
    )]
    EdgeFaces {
        /// One end of the edge.
        a: u32,
        /// The other end.
        b: u32,
        /// Three of the faces.
        faces: [usize; 3],
    },
    /// Two faces that share an edge are wound against each other.
    #[error("subdivision: faces {} and {} both go from vertex {a} to {b}; one of them must be turned round", faces[0], faces[1])]
    Winding {
        /// Where the edge begins in both.
        a: u32,
        /// Where it ends.
        b: u32,
        /// The faces.
        faces: [usize; 2],
    },
    /// The faces of a vertex do not make one fan.
    #[error("subdivision: the faces at vertex {vertex} do not form a single fan: faces {} and {} are not connected by edges at this vertex", faces[0], faces[1])]
    Fans {
        /// The vertex.
        vertex: u32,
        /// Faces of different fans.
        faces: [usize; 2],
    },
    /// A crease is no edge of a face.
    #[error("subdivision: crease {crease} is no edge: no face has vertices {a} and {b} next to each other")]
    Crease {
        /// The crease, from 0.
        crease: usize,
        /// Its vertices.
        a: u32,
        /// The other one.
        b: u32,
    },
    /// A sharpness is not positive.
    #[error("subdivision: the sharpness of {what} {number} must be positive, got {sharpness}")]
    Sharpness {
        /// A crease or a corner.
        what: &'static str,
        /// Its number, from 0.
        number: usize,
        /// The value.
        sharpness: f64,
    },
    /// A corner or a hole is not there.
    #[error("subdivision: {what} {number} names {kind} {index}, there are {count}")]
    Missing {
        /// A corner or a hole.
        what: &'static str,
        /// Its number, from 0.
        number: usize,
        /// A vertex or a face.
        kind: &'static str,
        /// The number that it gives.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// The faces' texture coordinates do not fit them.
    #[error("subdivision: face {face} has {len} vertices, but {uv} texture coordinates")]
    UvFace {
        /// The face.
        face: usize,
        /// How many vertices it has.
        len: usize,
        /// How many texture coordinates.
        uv: usize,
    },
    /// Texture coordinates are to be smooth, and there are none.
    #[error("subdivision: smooth texture coordinates are asked for, but there are none")]
    NoUv,
    /// A face names texture coordinates that are not there.
    #[error("subdivision: face {face} names texture coordinates {index}, there are {count}")]
    UvIndex {
        /// The face.
        face: usize,
        /// The number that it gives.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// Texture coordinates are infinite or NaN.
    #[error("subdivision: texture coordinates {number} must be finite, got <{u}, {v}>")]
    Uv {
        /// Their number, from 0.
        number: usize,
        /// The first.
        u: f64,
        /// The second.
        v: f64,
    },
    /// All faces are holes, or all points are the same: nothing is there.
    #[error("subdivision: {0}, so it has no surface")]
    Nothing(&'static str),
}

/// Products of larger numbers could leave the range of f64.
const LARGEST: f64 = durer_math::scale::pow2(200);

impl SubdivisionData {
    /// Whether these numbers make a surface, before it is built.
    pub fn check(&self) -> Result<(), SubdivisionError> {
        type Error = SubdivisionError;
        let count = self.vertices.len();
        let most = count.max(self.faces.len()).max(self.uv.len());
        if most > (u32::MAX / 64) as usize {
            return Err(Error::TooMany(most));
        }
        if self.faces.is_empty() {
            return Err(Error::NoFaces);
        }
        for (vertex, p) in self.vertices.iter().enumerate() {
            if !p.to_vec().to_array().iter().all(|x| x.abs() < LARGEST) {
                return Err(Error::Vertex { vertex, x: p.x, y: p.y, z: p.z });
            }
        }
        for (face, corners) in self.faces.iter().enumerate() {
            if corners.len() < 3 {
                return Err(Error::FaceSize { face, len: corners.len() });
            }
            if self.scheme == Scheme::Loop && corners.len() != 3 {
                return Err(Error::NotTriangle { face, len: corners.len() });
            }
            if let Some(&vertex) = corners.iter().find(|v| **v as usize >= count) {
                return Err(Error::Index { face, vertex, count });
            }
            let mut sorted = corners.clone();
            sorted.sort_unstable();
            if let Some(w) = sorted.windows(2).find(|w| w[0] == w[1]) {
                return Err(Error::Twice { face, vertex: w[0] });
            }
        }
        self.check_uv()?;
        let edges = self.check_edges()?;
        self.check_fans(&edges)?;
        for (crease, &([a, b], sharpness)) in self.creases.iter().enumerate() {
            if !edges.contains_key(&[a, b]) && !edges.contains_key(&[b, a]) {
                return Err(Error::Crease { crease, a, b });
            }
            if sharpness.is_nan() || sharpness <= 0.0 {
                return Err(Error::Sharpness { what: "crease", number: crease, sharpness });
            }
        }
        for (number, &(index, sharpness)) in self.corners.iter().enumerate() {
            if index as usize >= count {
                return Err(Error::Missing { what: "corner", number, kind: "vertex", index, count });
            }
            if sharpness.is_nan() || sharpness <= 0.0 {
                return Err(Error::Sharpness { what: "corner", number, sharpness });
            }
        }
        let count = self.faces.len();
        let mut is_hole = vec![false; count];
        for (number, &index) in self.holes.iter().enumerate() {
            match is_hole.get_mut(index as usize) {
                Some(is_hole) => *is_hole = true,
                None => return Err(Error::Missing { what: "hole", number, kind: "face", index, count }),
            }
        }
        if is_hole.iter().all(|hole| *hole) {
            return Err(Error::Nothing("all its faces are holes"));
        }
        let mut used = self.faces.iter().flatten().map(|v| self.vertices[*v as usize]);
        let first = used.next();
        if used.all(|p| Some(p) == first) {
            return Err(Error::Nothing("all its points are the same"));
        }
        Ok(())
    }

    fn check_uv(&self) -> Result<(), SubdivisionError> {
        type Error = SubdivisionError;
        for (number, &[u, v]) in self.uv.iter().enumerate() {
            if !(u.is_finite() && v.is_finite()) {
                return Err(Error::Uv { number, u, v });
            }
        }
        if self.uv_faces.is_empty() {
            let is_smooth = self.uv_interpolation == UvInterpolation::Smooth;
            return if is_smooth { Err(Error::NoUv) } else { Ok(()) };
        }
        for face in 0..self.faces.len().max(self.uv_faces.len()) {
            let len = self.faces.get(face).map_or(0, Vec::len);
            let uv = self.uv_faces.get(face).map_or(0, Vec::len);
            if len != uv {
                return Err(Error::UvFace { face, len, uv });
            }
            let count = self.uv.len();
            if let Some(&index) = self.uv_faces[face].iter().find(|k| **k as usize >= count) {
                return Err(Error::UvIndex { face, index, count });
            }
        }
        Ok(())
    }

    /// The face on the left of each directed edge.
    fn check_edges(&self) -> Result<HashMap<[u32; 2], usize>, SubdivisionError> {
        let mut edges = HashMap::new();
        for (face, corners) in self.faces.iter().enumerate() {
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                let Some(before) = edges.insert([a, b], face) else { continue };
                let is_on = |corners: &[u32]| {
                    (0..corners.len()).any(|k| {
                        let edge = [corners[k], corners[(k + 1) % corners.len()]];
                        edge == [a, b] || edge == [b, a]
                    })
                };
                let all: Vec<usize> = (0..self.faces.len()).filter(|f| is_on(&self.faces[*f])).collect();
                return Err(match all[..] {
                    [p, q, r, ..] => SubdivisionError::EdgeFaces { a, b, faces: [p, q, r] },
                    _ => SubdivisionError::Winding { a, b, faces: [before, face] },
                });
            }
        }
        Ok(edges)
    }

    /// Whether the faces of each vertex follow one another round it.
    fn check_fans(&self, edges: &HashMap<[u32; 2], usize>) -> Result<(), SubdivisionError> {
        let mut faces_of = vec![Vec::new(); self.vertices.len()];
        for (face, corners) in self.faces.iter().enumerate() {
            for &v in corners {
                faces_of[v as usize].push(face);
            }
        }
        for (vertex, faces) in faces_of.iter().enumerate() {
            let Some(&first) = faces.first() else { continue };
            let vertex = vertex as u32;
            let beside = |face: usize, step: usize| {
                let corners = &self.faces[face];
                let at = corners.iter().position(|v| *v == vertex)?;
                let other = corners[(at + step) % corners.len()];
                let edge = if step == 1 { [other, vertex] } else { [vertex, other] };
                edges.get(&edge).copied()
            };
            let mut seen = vec![first];
            for forward in [false, true] {
                let mut now = first;
                loop {
                    let step = if forward { 1 } else { self.faces[now].len() - 1 };
                    match beside(now, step) {
                        Some(next) if !seen.contains(&next) => {
                            seen.push(next);
                            now = next;
                        }
                        _ => break,
                    }
                }
            }
            if let Some(&other) = faces.iter().find(|f| !seen.contains(f)) {
                return Err(SubdivisionError::Fans { vertex, faces: [first, other] });
            }
        }
        Ok(())
    }
}
