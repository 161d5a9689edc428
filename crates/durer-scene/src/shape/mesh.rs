//! Triangle meshes.

use std::sync::Arc;

use durer_math::{Point3, Vec3};

use crate::Texture;

/// Triangles over shared corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<Point3>,
    /// The normals that faces may refer to, of any length.
    pub normals: Vec<Vec3>,
    /// The triangles.
    pub faces: Vec<Face>,
    /// The texture coordinates that faces may refer to.
    pub uv: Vec<[f64; 2]>,
    /// The numbers of the texture coordinates at each face's corners, if it has any; as many as
    /// there are faces, or none for all. The coordinates of hits are interpolated between them; on
    /// other faces the corners have (0, 0), (1, 0) and (0, 1).
    pub uv_faces: Vec<Option<[u32; 3]>>,
    /// The textures that faces may refer to, placed in the mesh's own frame.
    pub textures: Vec<Arc<Texture>>,
    /// A direction that decides what is inside: points from which it crosses the mesh an odd number
    /// of times. Without it the mesh is a sheet.
    pub inside_vector: Option<Vec3>,
}

/// A triangle of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// The numbers of its corners.
    pub vertices: [u32; 3],
    /// The numbers of the normals at its corners; flat without them.
    pub normals: Option<[u32; 3]>,
    /// Its texture; the object's without it.
    pub texture: Option<FaceTexture>,
}

/// The numbers of a face's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceTexture {
    /// One texture.
    One(u32),
    /// A texture for each corner, mixed by the point's barycentric coordinates.
    Corners([u32; 3]),
}
