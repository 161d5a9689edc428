//! Meshes: triangles one by one (`mesh`), or over lists of corners (`mesh2`).

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use durer_math::{Point3, Vec3};
use durer_scene::{self as scene, Face, FaceTexture, Mesh};

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::scene_builder::{point, unit, vector};
use crate::texture::Texture;
use crate::transform::length;
use crate::value::Value;

/// The memory of a mesh, with what its lists have room for.
pub(super) fn bytes(mesh: &Mesh) -> usize {
    (mesh.vertices.capacity() + mesh.normals.capacity()) * 24
        + (mesh.uv.capacity() + mesh.uv_faces.capacity()) * 16
        + mesh.faces.capacity() * size_of::<Face>()
}

/// Finds equal corners, so that neighbours share them.
#[derive(Default)]
struct Shared(HashMap<[u64; 3], u32>);

impl Shared {
    fn index<T>(&mut self, v: [f64; 3], list: &mut Vec<T>, item: T) -> u32 {
        // Minus zero is zero.
        let key = v.map(|part| (part + 0.0).to_bits());
        *self.0.entry(key).or_insert_with(|| {
            list.push(item);
            (list.len() - 1) as u32
        })
    }
}

/// Bytes of a [`Shared`] entry, for the memory limit.
const SHARED_ENTRY: usize = 64;
/// Faces between looks at the memory limit.
const OFTEN: usize = 1 << 12;

impl Parser<'_> {
    /// `mesh { triangle { } smooth_triangle { } ... }` up to its modifiers.
    pub(super) fn mesh(&mut self) -> Result<Shape> {
        let (mut mesh, mut textures) = (Mesh::default(), Vec::new());
        let (mut corners, mut normals) = (Shared::default(), Shared::default());
        let mut coordinates = Shared::default();
        loop {
            let smooth = match self.peek_word()? {
                Some(Keyword::Triangle) => false,
                Some(Keyword::SmoothTriangle) => true,
                _ => break,
            };
            self.next()?;
            let place = self.here();
            self.expect(Mark::BraceOpen)?;
            let mut face = Face { vertices: [0; 3], normals: smooth.then_some([0; 3]), texture: None };
            for i in 0..3 {
                face.vertices[i] = {
                    let corner = self.corner()?;
                    corners.index(corner, &mut mesh.vertices, point(corner))
                };
                if let Some(at) = &mut face.normals {
                    let normal = self.normal("a normal of the triangle")?;
                    at[i] = normals.index(normal, &mut mesh.normals, vector(normal));
                }
            }
            if self.take_word(Keyword::UvVectors)? {
                let mut at = [0; 3];
                for corner in &mut at {
                    let uv = self.vector2()?;
                    *corner = coordinates.index([uv[0], uv[1], 0.0], &mut mesh.uv, uv);
                    self.skip_comma()?;
                }
                mesh.uv_faces.resize(mesh.faces.len(), None);
                mesh.uv_faces.push(Some(at));
            }
            if self.take_word(Keyword::Texture)? {
                let texture = self.nested(Self::texture_block)?;
                let texture = Rc::new(texture);
                face.texture = Some(FaceTexture::One(texture_index(&mut textures, texture)));
            } else if self.take_word(Keyword::TextureList)? {
                self.expect(Mark::BraceOpen)?;
                let mut at = [0; 3];
                for corner in &mut at {
                    let texture = self.listed_texture()?;
                    *corner = texture_index(&mut textures, texture);
                }
                self.expect(Mark::BraceClose)?;
                face.texture = Some(FaceTexture::Corners(at));
            }
            self.expect(Mark::BraceClose)?;
            mesh.faces.push(face);
            if mesh.faces.len().is_multiple_of(OFTEN) {
                let index =
                    (corners.0.capacity() + normals.0.capacity() + coordinates.0.capacity()) * SHARED_ENTRY;
                self.check_memory(bytes(&mesh) + index, place)?;
            }
        }
        self.finish_mesh(mesh, textures)
    }

    /// `mesh2 { vertex_vectors { } ... face_indices { } ... }` up to its modifiers.
    pub(super) fn mesh2(&mut self) -> Result<Shape> {
        let (mut mesh, mut textures, mut found) = (Mesh::default(), Vec::new(), false);
        while let Some(keyword) = self.peek_word()? {
            let here = self.here();
            match keyword {
                Keyword::VertexVectors => {
                    self.next()?;
                    mesh.vertices = self.counted(24, |r| r.corner().map(Point3::from))?;
                }
                Keyword::NormalVectors => {
                    self.next()?;
                    mesh.normals = self.counted(24, |r| r.corner().map(Vec3::from))?;
                }
                Keyword::UvVectors => {
                    self.next()?;
                    mesh.uv = self.counted(16, |r| {
                        let uv = r.vector2()?;
                        r.skip_comma()?;
                        Ok(uv)
                    })?;
                }
                Keyword::TextureList => {
                    self.next()?;
                    textures = self.counted(8, Self::listed_texture)?;
                }
                Keyword::FaceIndices => {
                    self.next()?;
                    found = true;
                    mesh.faces = self.face_indices(mesh.vertices.len(), textures.len())?;
                    mesh.uv_faces.clear();
                }
                Keyword::NormalIndices => {
                    self.next()?;
                    let count = mesh.normals.len();
                    let lists = self.counted(12, |r| r.indices(count, "normal"))?;
                    if lists.len() > mesh.faces.len() {
                        return Err(Error::invalid(here, "more normal indices than faces"));
                    }
                    for (face, list) in mesh.faces.iter_mut().zip(lists) {
                        face.normals = Some(list);
                    }
                }
                Keyword::UvIndices => {
                    self.next()?;
                    let count = mesh.uv.len();
                    let lists = self.counted(12, |r| r.indices(count, "uv"))?;
                    mesh.uv_faces.resize(mesh.faces.len(), None);
                    for (uv, list) in mesh.uv_faces.iter_mut().zip(lists) {
                        *uv = Some(list);
                    }
                }
                _ => break,
            }
        }
        if !found {
            return Err(Error::invalid(self.here(), "this mesh2 has no face_indices"));
        }
        // A list as long as that of the corners goes with them.
        if mesh.normals.len() == mesh.vertices.len() {
            for face in &mut mesh.faces {
                face.normals = face.normals.or(Some(face.vertices));
            }
        }
        if mesh.uv_faces.iter().all(Option::is_none) {
            let is_known = |corners: &[u32; 3]| corners.iter().all(|&i| (i as usize) < mesh.uv.len());
            let corners = mesh.faces.iter().map(|face| face.vertices);
            mesh.uv_faces = corners.map(|corners| Some(corners).filter(is_known)).collect();
        }
        // A normal without length makes its face flat.
        let sound: Vec<bool> = mesh.normals.iter().map(|n| length(n.to_array()) > 0.0).collect();
        for face in &mut mesh.faces {
            face.normals = face.normals.filter(|list| list.iter().all(|&n| sound[n as usize]));
        }
        self.finish_mesh(mesh, textures)
    }

    /// `{ n, item, item, ... }`.
    pub(super) fn counted<T>(
        &mut self,
        bytes: usize,
        mut item: impl FnMut(&mut Self) -> Result<T>,
    ) -> Result<Vec<T>> {
        self.expect(Mark::BraceOpen)?;
        let place = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if !(0.0..f64::from(u32::MAX)).contains(&count) {
            return Err(Error::invalid(place, format!("a list cannot have {count} entries")));
        }
        let count = count as usize;
        self.check_memory(count.saturating_mul(bytes), place)?;
        let mut items = Vec::new();
        for _ in 0..count {
            items.push(item(self)?);
        }
        self.expect(Mark::BraceClose)?;
        Ok(items)
    }

    /// `<i, j, k>` below `count`.
    fn indices(&mut self, count: usize, what: &str) -> Result<[u32; 3]> {
        self.peek()?;
        let place = self.here();
        let list = self.corner()?;
        let known = |&v: &f64| v >= 0.0 && v < count as f64 && v < f64::from(u32::MAX);
        if let Some(wrong) = list.iter().find(|v| !known(v)) {
            return Err(Error::invalid(place, format!("there is no {what} number {wrong}")));
        }
        Ok(list.map(|v| v as u32))
    }

    /// A texture of a list, by its name or in braces, and a comma.
    fn listed_texture(&mut self) -> Result<Rc<Texture>> {
        self.take_word(Keyword::Texture)?;
        let texture = match self.peek()? {
            Item::Value(Value::Texture(known)) => {
                let known = known.clone();
                self.next()?;
                known
            }
            _ => Rc::new(self.nested(Self::texture_block)?),
        };
        self.skip_comma()?;
        Ok(texture)
    }

    /// Faces over `count` corners, with numbers of `textures` textures.
    fn face_indices(&mut self, count: usize, textures: usize) -> Result<Vec<Face>> {
        self.counted(size_of::<Face>(), |r| {
            let place = r.here();
            let vertices = r.indices(count, "vertex")?;
            let mut texture = None;
            // Textures follow as one number, or one for each corner.
            let mut more = Vec::new();
            while textures > 0 && r.starts_number()? && !r.at_mark(Mark::Less)? && more.len() < 3 {
                let index = r.float()?;
                r.skip_comma()?;
                if !(index >= 0.0 && index < textures as f64) {
                    return Err(Error::invalid(place, format!("there is no texture number {index}")));
                }
                more.push(index as u32);
            }
            if let Some(&first) = more.first() {
                // Corners without a number of their own have the first one.
                let at =
                    [first, more.get(1).copied().unwrap_or(first), more.get(2).copied().unwrap_or(first)];
                texture =
                    Some(if at == [first; 3] { FaceTexture::One(first) } else { FaceTexture::Corners(at) });
            }
            Ok(Face { vertices, normals: None, texture })
        })
    }

    fn finish_mesh(&mut self, mut mesh: Mesh, textures: Vec<Rc<Texture>>) -> Result<Shape> {
        let place: Place = self.here();
        if mesh.faces.is_empty() {
            return Err(Error::invalid(place, "this mesh has no triangles"));
        }
        if self.take_word(Keyword::InsideVector)? {
            mesh.inside_vector = Some(vector(self.normal("the inside vector")?));
        }
        for normal in &mut mesh.normals {
            *normal = unit(normal.to_array());
        }
        if mesh.uv_faces.iter().all(Option::is_none) {
            mesh.uv_faces.clear();
        } else {
            mesh.uv_faces.resize(mesh.faces.len(), None);
        }
        mesh.vertices.shrink_to_fit();
        mesh.normals.shrink_to_fit();
        mesh.faces.shrink_to_fit();
        mesh.uv.shrink_to_fit();
        mesh.uv_faces.shrink_to_fit();
        self.check_memory(bytes(&mesh), place)?;
        Ok(Shape::textured(scene::Shape::Mesh(Arc::new(mesh)), textures.into_iter().map(Some).collect()))
    }
}

/// The number of `texture` among the mesh's; the last few are compared, since neighbours mostly
/// share one.
fn texture_index(textures: &mut Vec<Rc<Texture>>, texture: Rc<Texture>) -> u32 {
    const COMPARED: usize = 8;
    let first = textures.len().saturating_sub(COMPARED);
    let known = textures[first..].iter().position(|t| *t == texture).map(|i| first + i);
    known.unwrap_or_else(|| {
        textures.push(texture);
        textures.len() - 1
    }) as u32
}
