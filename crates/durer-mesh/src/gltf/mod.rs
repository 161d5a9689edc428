//! glTF 2.0: JSON text with separate buffers (`.gltf`) or a binary chunk (`.glb`). (The Khronos
//! Group, *glTF 2.0 Specification*, 2021.)
//!
//! The reader uses the nodes of the default scene. If no scene is named, it uses the first one; if
//! there is no scene, all nodes that are nobody's children; if there are no nodes, all meshes. It
//! reads the transforms of nodes. Of meshes it reads `POSITION`, `NORMAL` and `TEXCOORD_0`,
//! indices, strips and fans, all component types, sparse accessors, and the base colours of
//! materials. Each mesh becomes one group, however many primitives it has. It is stored once,
//! however many nodes show it.
//!
//! Coordinates and transforms are f32 in these files; transforms are composed in f64. Points,
//! lines, vertex colours, images, all other properties of materials, cameras, lights, skins, morph
//! targets and animations are ignored. Files that require an extension that changes how their
//! triangles are stored are refused.

mod accessor;
mod buffers;
mod container;
mod material;
mod nodes;
mod primitive;

use crate::error::{ErrorKind, Location};
use crate::text::shortened;
use crate::{Group, Instance, Warning};
use buffers::Buffers;
use primitive::Assembly;
use std::path::Path;

/// Extensions that a file may require. The reader implements them, or can ignore them without harm
/// to the triangles.
const UNDERSTOOD: [&str; 3] = ["KHR_mesh_quantization", "KHR_texture_transform", "KHR_lights_punctual"];

/// The greatest number of clear faces. Each object that light passes is a solid of its own, with a
/// look for each face, so without this limit a small file could fill any memory.
const MOST_CLEAR: usize = 1 << 26;

/// Reads a file from memory; `folder` contains its separate buffers.
pub(crate) fn read(
    bytes: &[u8],
    folder: Option<&Path>,
    warnings: &mut Vec<Warning>,
) -> Result<(Vec<Group>, Vec<Instance>), ErrorKind> {
    let (text, chunk) = container::split(bytes)?;
    let root = container::parse(text)?;
    let major = root.asset.version.split('.').next();
    if major != Some("2") {
        let what = format!("version {} of glTF", shortened(&root.asset.version));
        return Err(ErrorKind::Unsupported { spot: Location::Element("asset", 0), what });
    }
    for (number, name) in root.extensions_required.iter().enumerate() {
        if !UNDERSTOOD.contains(&name.as_str()) && !name.starts_with("KHR_materials_") {
            let spot = Location::Element("extensionsRequired", number);
            return Err(ErrorKind::Unsupported { spot, what: shortened(name) });
        }
    }
    let shown = nodes::shown(&root, warnings)?;
    let mut groups = Vec::new();
    let mut instances = Vec::new();
    let mut clear = 0;
    let mut known: Vec<Option<Option<usize>>> = vec![None; root.meshes.len()];
    let mut assembly = Assembly::new(&root, Buffers::new(&root.buffers, chunk, folder, bytes.len()));
    for (mesh, placement) in shown {
        let group = match known[mesh] {
            Some(group) => group,
            None => {
                let read = assembly.mesh(mesh)?;
                // Points and lines give no faces.
                let group = (!read.mesh.faces.is_empty()).then(|| {
                    groups.push(read);
                    groups.len() - 1
                });
                known[mesh] = Some(group);
                group
            }
        };
        instances.extend(group.map(|group| Instance { group, placement }));
        clear += group.map_or(0, |group| clear_faces(&groups[group]));
        if clear > MOST_CLEAR {
            let what = format!("{clear} clear faces, counted as often as they are shown");
            return Err(ErrorKind::Unsupported { spot: Location::Element("mesh", mesh), what });
        }
    }
    match warnings.first() {
        // Nothing else is shown. This reason is more useful than "there are no faces".
        Some(Warning::Flat { node, how }) if groups.is_empty() => wrong(
            Location::Element("node", *node),
            format!("{how} flattens it, so its faces have no area, and there are no others"),
        ),
        _ => Ok((groups, instances)),
    }
}

/// The number of faces of a mesh, or 0 if no light passes any of them.
fn clear_faces(group: &Group) -> usize {
    if group.mesh.textures.iter().all(|t| t.is_opaque()) { 0 } else { group.mesh.faces.len() }
}

/// The item of a list that an index refers to.
fn item<'a, T>(list: &'a [T], index: usize, what: &'static str, spot: Location) -> Result<&'a T, ErrorKind> {
    let missing = ErrorKind::Index { spot, what, index: index as i64, count: list.len() };
    list.get(index).ok_or(missing)
}

/// An error: the file violates the format.
fn wrong<T>(spot: Location, said: impl Into<String>) -> Result<T, ErrorKind> {
    Err(ErrorKind::Element { spot, said: said.into() })
}
