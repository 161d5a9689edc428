//! Meshes: all primitives of a mesh, combined into one group.

use super::accessor::Accessors;
use super::buffers::Buffers;
use super::{item, material, wrong};
use crate::Group;
use crate::error::{ErrorKind, Location};
use durer_math::{Point3, Vec3};
use durer_scene::{Face, FaceTexture, Mesh};
use gltf::json::Root;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::HashMap;

/// The greatest number of triangles for each byte of a file. Each index takes at least one byte and
/// starts at most one triangle, so this refuses only files that use the same indices more often.
/// Without a limit, a small file could fill any memory.
const MOST_OF_A_BYTE: u64 = 16;

/// Builds meshes from the file's lists.
pub(super) struct Assembly<'a> {
    root: &'a Root,
    accessors: Accessors<'a>,
    /// The number of vertices and triangles in all groups.
    made: u64,
}

/// The lists of a group, and the positions in them of the accessors that were already read.
#[derive(Default)]
struct Lists {
    mesh: Mesh,
    vertices: HashMap<usize, u32>,
    normals: HashMap<usize, u32>,
    uv: HashMap<usize, u32>,
    textures: HashMap<usize, u32>,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(root: &'a Root, buffers: Buffers<'a>) -> Self {
        let accessors = Accessors { list: &root.accessors, views: &root.buffer_views, buffers };
        Self { root, accessors, made: 0 }
    }

    /// Builds the mesh with this index.
    pub(super) fn mesh(&mut self, number: usize) -> Result<Group, ErrorKind> {
        let mesh = &self.root.meshes[number];
        let mut lists = Lists::default();
        for (part, primitive) in mesh.primitives.iter().enumerate() {
            self.primitive(primitive, &mut lists, Location::Primitive(number, part))?;
        }
        let mut group = Group { name: mesh.name.clone().unwrap_or_default(), mesh: lists.mesh };
        group.end();
        Ok(group)
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        lists: &mut Lists,
        spot: Location,
    ) -> Result<(), ErrorKind> {
        let Checked::Valid(mode) = primitive.mode else { return wrong(spot, "its mode is unknown") };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let list =
            |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(gltf::json::Index::value);
        let Some(positions) = list(Semantic::Positions) else { return wrong(spot, "it has no POSITION") };
        let count = self.accessors.count(positions, spot)?;
        let mesh = &mut lists.mesh;
        let vertices =
            self.list(positions, count, &mut mesh.vertices, &mut lists.vertices, Point3::from, spot)?;
        let normals = list(Semantic::Normals);
        let normals = normals
            .map(|n| self.list(n, count, &mut mesh.normals, &mut lists.normals, Vec3::from, spot))
            .transpose()?;
        let uv = list(Semantic::TexCoords(0));
        let uv = uv.map(|n| self.list(n, count, &mut mesh.uv, &mut lists.uv, |uv| uv, spot)).transpose()?;
        let texture = self.texture(primitive, lists, spot)?;
        let mesh = &mut lists.mesh;
        let corners = match primitive.indices {
            Some(indices) => {
                let (indices, place) = (indices.value(), Location::Element("accessor", indices.value()));
                let corners = self.accessors.indices(indices, spot)?;
                if let Some(&index) = corners.iter().find(|&&i| u64::from(i) >= count) {
                    let (index, count) = (i64::from(index), count as usize);
                    return Err(ErrorKind::Index { spot: place, what: "vertex", index, count });
                }
                corners
            }
            // The list has been read, so its length fits 32 bits.
            None => (0..count as u32).collect(),
        };
        if mode == Mode::Triangles && !corners.len().is_multiple_of(3) {
            return wrong(spot, format!("{} corners are not those of whole triangles", corners.len()));
        }
        let triangles =
            if mode == Mode::Triangles { corners.len() / 3 } else { corners.len().saturating_sub(2) };
        self.make(triangles)?;
        if u32::try_from(mesh.faces.len() + triangles).is_err() {
            return Err(ErrorKind::TooMany);
        }
        mesh.faces.reserve(triangles);
        for i in 0..triangles {
            let corner = match mode {
                Mode::TriangleStrip => [i, i + 1 + i % 2, i + 2 - i % 2],
                Mode::TriangleFan => [i + 1, i + 2, 0],
                _ => [3 * i, 3 * i + 1, 3 * i + 2],
            };
            let corner = corner.map(|c| corners[c]);
            let from = |first: u32| corner.map(|c| first + c);
            mesh.faces.push(Face {
                vertices: from(vertices),
                normals: normals.map(from),
                texture: texture.map(FaceTexture::One),
            });
            if let Some(uv) = uv {
                mesh.uv_faces.resize(mesh.faces.len() - 1, None);
                mesh.uv_faces.push(Some(from(uv)));
            }
        }
        Ok(())
    }

    /// The position in the group's list where an attribute's elements begin. Reads them if they are
    /// not there yet.
    fn list<T, const N: usize>(
        &mut self,
        number: usize,
        count: u64,
        all: &mut Vec<T>,
        known: &mut HashMap<usize, u32>,
        make: impl Fn([f64; N]) -> T,
        spot: Location,
    ) -> Result<u32, ErrorKind> {
        let there = self.accessors.count(number, spot)?;
        if there != count {
            let said = format!("the primitive has {count} positions, but {there} of these");
            return wrong(Location::Element("accessor", number), said);
        }
        if let Some(&first) = known.get(&number) {
            return Ok(first);
        }
        let read = self.accessors.vectors(number, spot)?;
        self.make(read.len())?;
        let first = u32::try_from(all.len()).map_err(|_| ErrorKind::TooMany)?;
        all.extend(read.into_iter().map(make));
        u32::try_from(all.len()).map_err(|_| ErrorKind::TooMany)?;
        known.insert(number, first);
        Ok(first)
    }

    fn texture(
        &self,
        primitive: &Primitive,
        lists: &mut Lists,
        spot: Location,
    ) -> Result<Option<u32>, ErrorKind> {
        let Some(number) = primitive.material.map(|m| m.value()) else { return Ok(None) };
        if let Some(&known) = lists.textures.get(&number) {
            return Ok(Some(known));
        }
        let texture = material::texture(item(&self.root.materials, number, "material", spot)?, number)?;
        let place = u32::try_from(lists.mesh.textures.len()).map_err(|_| ErrorKind::TooMany)?;
        lists.mesh.textures.push(texture);
        lists.textures.insert(number, place);
        Ok(Some(place))
    }

    /// Adds to the count of vertices and triangles, and checks it against the limit for a file of
    /// this size.
    fn make(&mut self, count: usize) -> Result<(), ErrorKind> {
        self.made = self.made.saturating_add(count as u64);
        let most = (self.accessors.buffers.there as u64).saturating_mul(MOST_OF_A_BYTE);
        if self.made <= most { Ok(()) } else { Err(ErrorKind::Repeated { made: self.made, most }) }
    }
}
