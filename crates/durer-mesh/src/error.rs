//! What can be wrong with a mesh file.

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
    /// A line of text, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
    /// An element of a list, from 0: its kind and its number.
    Element(&'static str, usize),
    /// A mesh, from 0, and a primitive of it.
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

/// What is wrong with a mesh file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ErrorKind {
    /// The file's ending is none that can be read.
    #[error("the ending tells no format that can be read: .obj, .ply, .stl, .gltf or .glb")]
    Format,
    /// The file cannot be read at all.
    #[error("cannot be read: {0}")]
    Read(String),
    /// There is no triangle in it.
    #[error("there are no faces in it")]
    Empty,
    /// Something else should stand at a place.
    #[error("{spot}: expected {expected}, found '{found}'")]
    Expected {
        /// Where.
        spot: Location,
        /// What should be there.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// The file ends too early.
    #[error("{spot}: the file ends where {expected} should follow")]
    End {
        /// Where.
        spot: Location,
        /// What should follow.
        expected: &'static str,
    },
    /// An index names nothing.
    #[error("{spot}: there is no {what} {index}, there are {count} so far")]
    Index {
        /// Where.
        spot: Location,
        /// What the index should name.
        what: &'static str,
        /// The index as it is written.
        index: i64,
        /// How many there are.
        count: usize,
    },
    /// A header promises more than the file has room for.
    #[error("the header promises {promised} {what}, but the file has room for {room}")]
    Promise {
        /// Of what.
        what: String,
        /// How many.
        promised: u64,
        /// How many there can be.
        room: u64,
    },
    /// A binary STL file ends before all of its triangles are there.
    #[error("the file ends {} triangle {triangle} of {promised}", if *.is_begun { "in" } else { "before" })]
    Cut {
        /// Whether some of the triangle is there.
        is_begun: bool,
        /// Its number, from 1.
        triangle: u64,
        /// How many triangles the header promises.
        promised: u32,
    },
    /// An element of a list promises more than there is.
    #[error("{spot}: it promises {promised} {what}, but there is room for {room}")]
    Room {
        /// Where.
        spot: Location,
        /// Of what.
        what: String,
        /// How many.
        promised: u64,
        /// How many there can be.
        room: u64,
    },
    /// Few bytes that would fill any memory.
    #[error(
        "the meshes use the same lists over and over: {made} vertices and triangles so far, more than {most}"
    )]
    Repeated {
        /// How many there would be.
        made: u64,
        /// How many a file of this size may have.
        most: u64,
    },
    /// The text of a glTF file is no JSON, or not of this format.
    #[error("JSON, line {line}, column {column}: {said}")]
    Text {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What the reader says.
        said: String,
    },
    /// Something known that cannot be read yet.
    #[error("{spot}: not supported yet: {what}")]
    Unsupported {
        /// Where.
        spot: Location,
        /// What.
        what: String,
    },
    /// A face is not convex and has too many corners to be cut into triangles.
    #[error("{spot}: a face that is not convex has {count} corners, more than {most}")]
    Corners {
        /// Where.
        spot: Location,
        /// Its corners.
        count: usize,
        /// How many can be dealt with.
        most: usize,
    },
    /// More vertices or faces than 32 bits count.
    #[error("there are more than {} vertices or triangles in a group", u32::MAX)]
    TooMany,
    /// The header is not one of this format: what its reader says.
    #[error("{0}")]
    Header(String),
    /// An element is not what the header declares: what the reader says.
    #[error("{spot}: {said}")]
    Element {
        /// Where.
        spot: Location,
        /// What is wrong.
        said: String,
    },
}
