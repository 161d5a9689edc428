//! This crate reads mesh files as scene data: OBJ, PLY (as text and in both binary orders), STL (as
//! text and binary) and glTF 2.0 (as text and binary).
//!
//! [`read`] returns a [`Model`]: groups of triangles in the file's order, and the placements at
//! which they are shown. Coordinates are f64 if the file has that many digits. Hits of rays report
//! the file's texture coordinates; no texture uses them yet. [`Model::into_scene`] adds a camera
//! and a light, and [`Topology`] says whether the meshes are closed.
//!
//! Nothing in a file is trusted: counts in headers reserve no memory, indices are checked, and
//! errors name the place. Defects that other programs commonly write, and that can be left out
//! without harm to the rest, are left out with a [`Warning`].
//!
//! ```
//! use durer_mesh::{Format, read_bytes};
//! let model = read_bytes(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", Format::Obj)?;
//! assert_eq!(model.groups[0].mesh.faces.len(), 2);
//! # Ok::<(), durer_mesh::ErrorKind>(())
//! ```
#![forbid(unsafe_code)]

mod default_view;
mod error;
mod gltf;
mod group;
mod obj;
mod ply;
mod polygon;
mod stl;
mod text;
mod topology;
mod warning;

pub use crate::default_view::subdivided_scene;
pub use crate::error::{ErrorKind, Location, MeshError};
pub use crate::topology::Topology;
pub use crate::warning::Warning;

use durer_math::Affine;
use durer_scene::{Mesh, SubdivisionData};
use std::path::Path;

/// The contents of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The groups in the file's order. There is at least one, and each has a triangle.
    pub groups: Vec<Group>,
    /// The placements of the groups; at least one. In formats without transforms each group has one
    /// instance, with the identity.
    pub instances: Vec<Instance>,
    /// The format of the file.
    pub format: Format,
    /// Warnings about what was left out.
    pub warnings: Vec<Warning>,
}

/// Triangles that form one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// The name in the file; may be empty.
    pub name: String,
    /// The triangles. Polygons are divided into triangles, in the order of the file.
    pub mesh: Mesh,
}

/// A group with a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The index of the group.
    pub group: usize,
    /// From the group's own frame to the world.
    pub placement: Affine,
}

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront's text format, OBJ.
    Obj,
    /// PLY, Stanford's polygon file format.
    Ply,
    /// STL, the format of stereolithography.
    Stl,
    /// glTF, Khronos' format, as text or binary.
    Gltf,
}

impl Format {
    /// The format for a file's extension, in upper or lower case.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// Reads a mesh file. Its extension decides the format.
pub fn read(path: &Path) -> Result<Model, MeshError> {
    let fail = |kind| MeshError { path: path.to_path_buf(), kind };
    let format = Format::of(path).ok_or_else(|| fail(ErrorKind::Format))?;
    let bytes = bytes_of(path).map_err(fail)?;
    read_beside(&bytes, format, path.parent()).map_err(fail)
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, ErrorKind> {
    let failed = |e: std::io::Error| ErrorKind::Read(e.to_string());
    // A pipe is not opened, because that could wait forever.
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(ErrorKind::Read("it is no file".into()));
    }
    std::fs::read(path).map_err(failed)
}

/// Reads the polygons of an OBJ file as the control mesh of a subdivision surface, whatever groups
/// they are in, and warnings about what was left out.
pub fn read_control_mesh(path: &Path) -> Result<(SubdivisionData, Vec<Warning>), MeshError> {
    let fail = |kind| MeshError { path: path.to_path_buf(), kind };
    if Format::of(path) != Some(Format::Obj) {
        return Err(fail(ErrorKind::Polygons));
    }
    control_mesh(&bytes_of(path).map_err(fail)?).map_err(fail)
}

/// What [`read_control_mesh`] reads, from memory.
pub fn control_mesh(bytes: &[u8]) -> Result<(SubdivisionData, Vec<Warning>), ErrorKind> {
    let mut warnings = Vec::new();
    let data = obj::control_mesh(text::without_mark(bytes), &mut warnings)?;
    Ok((data, warnings))
}

/// Reads a mesh file from memory. It cannot refer to other files.
pub fn read_bytes(bytes: &[u8], format: Format) -> Result<Model, ErrorKind> {
    read_beside(bytes, format, None)
}

fn read_beside(bytes: &[u8], format: Format, folder: Option<&Path>) -> Result<Model, ErrorKind> {
    let mut warnings = Vec::new();
    let groups = match format {
        Format::Obj => obj::read(text::without_mark(bytes), &mut warnings),
        Format::Ply => ply::read(text::without_mark(bytes)),
        Format::Stl => stl::read(bytes, &mut warnings),
        Format::Gltf => {
            let (groups, instances) = gltf::read(text::without_mark(bytes), folder, &mut warnings)?;
            return if groups.is_empty() {
                Err(ErrorKind::Empty)
            } else {
                Ok(Model { groups, instances, format, warnings })
            };
        }
    }?;
    if groups.is_empty() {
        return Err(ErrorKind::Empty);
    }
    let instances = (0..groups.len()).map(|group| Instance { group, placement: Affine::IDENTITY }).collect();
    Ok(Model { groups, instances, format, warnings })
}
