//! Warnings: what a reader leaves out of a mesh file.

use crate::error::Location;

/// Something that the reader left out; the rest of the file is read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Warning {
    /// Faces refer to missing texture coordinates or normals. There is one such warning for each
    /// file.
    #[error(
        "{spot}: there is no {what} {index}, there are {count} so far; {} that are not there are left out",
        missing(*.uv, *.normals)
    )]
    Dangling {
        /// The place of the first one.
        spot: Location,
        /// What the first index refers to.
        what: &'static str,
        /// The first index as written.
        index: i64,
        /// The number of items at that place of the file.
        count: usize,
        /// The number of indices of texture coordinates that are left out.
        uv: usize,
        /// The number of indices of normals that are left out.
        normals: usize,
    },
    /// Bytes follow the last triangle of a binary STL file.
    #[error("byte {at}: the last of {triangles} triangles ends here; the {count} bytes after it are ignored")]
    Trailing {
        /// The place where they begin.
        at: usize,
        /// The number of triangles that the header declares.
        triangles: u32,
        /// The number of these bytes.
        count: usize,
    },
    /// A node of a glTF file shows faces, but its transform makes them flat.
    #[error(
        "node {node}: {how} flattens it, so its faces have no area: it is left out with all nodes below it"
    )]
    Flat {
        /// The number of the node, from 0.
        node: usize,
        /// What makes the faces flat.
        how: String,
    },
}

/// The numbers of both kinds of indices, in words.
fn missing(uv: usize, normals: usize) -> String {
    let some = |n: usize, what: &str| (n > 0).then(|| format!("{n} {what}"));
    let uv =
        some(uv, if uv == 1 { "index of texture coordinates" } else { "indices of texture coordinates" });
    let normals = some(normals, if normals == 1 { "index of normals" } else { "indices of normals" });
    [uv, normals].into_iter().flatten().collect::<Vec<_>>().join(" and ")
}
