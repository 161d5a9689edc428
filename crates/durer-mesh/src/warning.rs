//! What is left out of a mesh file that is read.

use crate::error::Location;

/// Something in a mesh file that is left out; the rest is read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Warning {
    /// Faces name texture coordinates or normals that are not there. There is one such warning for
    /// each file.
    #[error(
        "{spot}: there is no {what} {index}, there are {count} so far; {} that are not there are left out",
        missing(*.uv, *.normals)
    )]
    Dangling {
        /// Where the first one is.
        spot: Location,
        /// What the first one should name.
        what: &'static str,
        /// The first index as it is written.
        index: i64,
        /// How many there are at that place.
        count: usize,
        /// How many indices of texture coordinates are left out.
        uv: usize,
        /// How many indices of normals are left out.
        normals: usize,
    },
    /// Bytes follow the last triangle of a binary STL file.
    #[error("byte {at}: the last of {triangles} triangles ends here; the {count} bytes after it are ignored")]
    Trailing {
        /// Where they begin.
        at: usize,
        /// How many triangles the header promises.
        triangles: u32,
        /// How many bytes there are.
        count: usize,
    },
    /// A node of a glTF file shows faces that its transform flattens.
    #[error(
        "node {node}: {how} flattens it, so its faces have no area: it is left out with all nodes below it"
    )]
    Flat {
        /// Its number, from 0.
        node: usize,
        /// What flattens it.
        how: String,
    },
}

/// How many indices of each kind, in words.
fn missing(uv: usize, normals: usize) -> String {
    let some = |n: usize, what: &str| (n > 0).then(|| format!("{n} {what}"));
    let uv =
        some(uv, if uv == 1 { "index of texture coordinates" } else { "indices of texture coordinates" });
    let normals = some(normals, if normals == 1 { "index of normals" } else { "indices of normals" });
    [uv, normals].into_iter().flatten().collect::<Vec<_>>().join(" and ")
}
