//! Errors in mesh files.

use std::fmt;
use std::path::PathBuf;

/// Why a mesh file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {kind}", .path.display())]
pub struct MeshError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub kind: ErrorKind,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// A line of text, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
    /// An element of a list: its kind, and its number counted from 0.
    Element(&'static str, usize),
    /// A mesh and one of its primitives, counted from 0.
    Primitive(usize, usize),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Byte(n) => write!(f, "byte {n}"),
            Self::Element(what, n) => write!(f, "{what} {n}"),
            Self::Primitive(mesh, n) => write!(f, "mesh {mesh}, primitive {n}"),
        }
    }
}

/// An error in a mesh file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ErrorKind {
    /// The file's extension is not that of a known format.
    #[error("the ending tells no format that can be read: .obj, .ply, .stl, .gltf or .glb")]
    Format,
    /// Only OBJ files have polygons that can be subdivided.
    #[error("only .obj files can be control meshes of subdivision surfaces")]
    Polygons,
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Read(String),
    /// The file contains no triangle.
    #[error("there are no faces in it")]
    Empty,
    /// Something unexpected stands at a place.
    #[error("{spot}: expected {expected}, found '{found}'")]
    Expected {
        /// The place.
        spot: Location,
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
    },
    /// The file ends too early.
    #[error("{spot}: the file ends where {expected} should follow")]
    End {
        /// The place.
        spot: Location,
        /// What was expected next.
        expected: &'static str,
    },
    /// An index is out of range.
    #[error("{spot}: there is no {what} {index}, there are {count} so far")]
    Index {
        /// The place.
        spot: Location,
        /// What the index refers to.
        what: &'static str,
        /// The index as written.
        index: i64,
        /// The number of items.
        count: usize,
    },
    /// A header declares more than the file has room for.
    #[error("the header promises {promised} {what}, but the file has room for {room}")]
    Promise {
        /// What it declares.
        what: String,
        /// The declared number.
        promised: u64,
        /// The greatest number that fits.
        room: u64,
    },
    /// A binary STL file ends before the last of its triangles.
    #[error("the file ends {} triangle {triangle} of {promised}", if *.is_begun { "in" } else { "before" })]
    Cut {
        /// Whether the file contains a part of that triangle.
        is_begun: bool,
        /// The number of the triangle, counted from 1.
        triangle: u64,
        /// The number of triangles that the header declares.
        promised: u32,
    },
    /// An element of a list declares more than the file has.
    #[error("{spot}: it promises {promised} {what}, but there is room for {room}")]
    Room {
        /// The place.
        spot: Location,
        /// What it declares.
        what: String,
        /// The declared number.
        promised: u64,
        /// The greatest number that fits.
        room: u64,
    },
    /// A small file would become a mesh of any size.
    #[error(
        "the meshes use the same lists over and over: {made} vertices and triangles so far, more than {most}"
    )]
    Repeated {
        /// The number of vertices and triangles so far.
        made: u64,
        /// The greatest number for a file of this size.
        most: u64,
    },
    /// The text of a glTF file is not JSON, or not glTF.
    #[error("JSON, line {line}, column {column}: {said}")]
    Text {
        /// The line, counted from 1.
        line: usize,
        /// The column, counted from 1.
        column: usize,
        /// The message of the JSON parser.
        said: String,
    },
    /// A known feature that is not supported yet.
    #[error("{spot}: not supported yet: {what}")]
    Unsupported {
        /// The place.
        spot: Location,
        /// The feature.
        what: String,
    },
    /// A face is not convex and has too many corners to be divided into triangles.
    #[error("{spot}: a face that is not convex has {count} corners, more than {most}")]
    Corners {
        /// The place.
        spot: Location,
        /// The number of its corners.
        count: usize,
        /// The greatest number that is supported.
        most: usize,
    },
    /// There are more vertices or faces than 32 bits can count.
    #[error("there are more than {} vertices or triangles in a group", u32::MAX)]
    TooMany,
    /// The header is not one of this format; the text is the parser's message.
    #[error("{0}")]
    Header(String),
    /// An element does not agree with the header or the format.
    #[error("{spot}: {said}")]
    Element {
        /// The place.
        spot: Location,
        /// The description of the error.
        said: String,
    },
}
