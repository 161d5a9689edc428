//! Meshes: triangles one by one (`mesh`), or over lists of corners (`mesh2`).

use std::collections::HashMap;
use std::rc::Rc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::limits::Charge;
use crate::parser::{Item, Parser};
use crate::texture::Texture;
use crate::transform::length;
use crate::value::Value;
use durer_scene::FaceTexture;

/// A triangle of a mesh: numbers of corners, of their normals, of its texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Face {
    pub(crate) vertices: [u32; 3],
    pub(crate) normals: Option<[u32; 3]>,
    pub(crate) texture: Option<FaceTexture>,
    /// The numbers of the texture coordinates at its corners.
    pub(crate) uv: Option<[u32; 3]>,
}

/// Triangles over shared corners.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) faces: Vec<Face>,
    /// The texture coordinates that faces may refer to.
    pub(crate) uv: Vec<[f64; 2]>,
    pub(crate) textures: Vec<Rc<Texture>>,
    pub(crate) inside_vector: Option<[f64; 3]>,
    charge: Charge,
}

impl Mesh {
    fn new() -> Self {
        Self {
            vertices: Vec::new(),
            normals: Vec::new(),
            faces: Vec::new(),
            uv: Vec::new(),
            textures: Vec::new(),
            inside_vector: None,
            charge: Charge::new(size_of::<Self>()),
        }
    }

    fn bytes(&self) -> usize {
        (self.vertices.capacity() + self.normals.capacity()) * 24
            + self.uv.capacity() * 16
            + self.faces.capacity() * size_of::<Face>()
    }
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
        let mut mesh = Mesh::new();
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
            let mut face =
                Face { vertices: [0; 3], normals: smooth.then_some([0; 3]), texture: None, uv: None };
            for i in 0..3 {
                face.vertices[i] = {
                    let corner = self.corner()?;
                    corners.index(corner, &mut mesh.vertices, corner)
                };
                if let Some(at) = &mut face.normals {
                    let normal = self.normal("a normal of the triangle")?;
                    at[i] = normals.index(normal, &mut mesh.normals, normal);
                }
            }
            if self.take_word(Keyword::UvVectors)? {
                let mut at = [0; 3];
                for corner in &mut at {
                    let uv = self.vector2()?;
                    *corner = coordinates.index([uv[0], uv[1], 0.0], &mut mesh.uv, uv);
                    self.skip_comma()?;
                }
                face.uv = Some(at);
            }
            if self.take_word(Keyword::Texture)? {
                let texture = self.nested(Self::texture_block)?;
                let texture = Rc::new(texture);
                face.texture = Some(FaceTexture::One(texture_index(&mut mesh.textures, texture)));
            } else if self.take_word(Keyword::TextureList)? {
                self.expect(Mark::BraceOpen)?;
                let mut at = [0; 3];
                for corner in &mut at {
                    let texture = self.listed_texture()?;
                    *corner = texture_index(&mut mesh.textures, texture);
                }
                self.expect(Mark::BraceClose)?;
                face.texture = Some(FaceTexture::Corners(at));
            }
            self.expect(Mark::BraceClose)?;
            mesh.faces.push(face);
            if mesh.faces.len().is_multiple_of(OFTEN) {
                let index =
                    (corners.0.capacity() + normals.0.capacity() + coordinates.0.capacity()) * SHARED_ENTRY;
                self.check_memory(mesh.bytes() + index, place)?;
            }
        }
        self.finish_mesh(mesh)
    }

    /// `mesh2 { vertex_vectors { } ... face_indices { } ... }` up to its modifiers.
    pub(super) fn mesh2(&mut self) -> Result<Shape> {
        let mut mesh = Mesh::new();
        let mut found = false;
        while let Some(keyword) = self.peek_word()? {
            let here = self.here();
            match keyword {
                Keyword::VertexVectors => {
                    self.next()?;
                    mesh.vertices = self.counted(24, Self::corner)?;
                }
                Keyword::NormalVectors => {
                    self.next()?;
                    mesh.normals = self.counted(24, Self::corner)?;
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
                    mesh.textures = self.counted(8, Self::listed_texture)?;
                }
                Keyword::FaceIndices => {
                    self.next()?;
                    found = true;
                    self.face_indices(&mut mesh)?;
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
                    for (face, list) in mesh.faces.iter_mut().zip(lists) {
                        face.uv = Some(list);
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
        if mesh.faces.iter().all(|face| face.uv.is_none()) {
            let count = mesh.uv.len();
            for face in &mut mesh.faces {
                let is_known = face.vertices.iter().all(|&i| (i as usize) < count);
                face.uv = is_known.then_some(face.vertices);
            }
        }
        // A normal without length makes its face flat.
        let sound: Vec<bool> = mesh.normals.iter().map(|n| length(*n) > 0.0).collect();
        for face in &mut mesh.faces {
            face.normals = face.normals.filter(|list| list.iter().all(|&n| sound[n as usize]));
        }
        self.finish_mesh(mesh)
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

    fn face_indices(&mut self, mesh: &mut Mesh) -> Result<()> {
        let count = mesh.vertices.len();
        let textures = mesh.textures.len();
        mesh.faces = self.counted(size_of::<Face>(), |r| {
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
            Ok(Face { vertices, normals: None, texture, uv: None })
        })?;
        Ok(())
    }

    fn finish_mesh(&mut self, mut mesh: Mesh) -> Result<Shape> {
        let place: Place = self.here();
        if mesh.faces.is_empty() {
            return Err(Error::invalid(place, "this mesh has no triangles"));
        }
        if self.take_word(Keyword::InsideVector)? {
            mesh.inside_vector = Some(self.normal("the inside vector")?);
        }
        mesh.vertices.shrink_to_fit();
        mesh.normals.shrink_to_fit();
        mesh.faces.shrink_to_fit();
        mesh.uv.shrink_to_fit();
        mesh.charge.resize(mesh.bytes());
        self.check_memory(0, place)?;
        Ok(Shape::Mesh(Rc::new(mesh)))
    }
}

/// The number of `texture` among the mesh's; the last few are compared, since neighbours mostly share one.
fn texture_index(textures: &mut Vec<Rc<Texture>>, texture: Rc<Texture>) -> u32 {
    const COMPARED: usize = 8;
    let first = textures.len().saturating_sub(COMPARED);
    let known = textures[first..].iter().position(|t| *t == texture).map(|i| first + i);
    known.unwrap_or_else(|| {
        textures.push(texture);
        textures.len() - 1
    }) as u32
}
