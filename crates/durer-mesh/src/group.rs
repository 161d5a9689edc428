//! Groups of faces while a file is read.

use crate::Group;
use crate::error::{ErrorKind, Location};
use crate::polygon;
use durer_math::{Point3, Vec3};
use durer_scene::Face;

/// A corner of a face: the indices of its vertex, its texture coordinates and its normal in the
/// file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) vertex: u32,
    pub(crate) uv: Option<u32>,
    pub(crate) normal: Option<u32>,
}

/// All vertices, texture coordinates and normals of a file, and the current group.
#[derive(Default)]
pub(crate) struct Groups {
    pub(crate) vertices: Vec<Point3>,
    pub(crate) uv: Vec<[f64; 2]>,
    pub(crate) normals: Vec<Vec3>,
    done: Vec<Group>,
    now: Group,
    /// The indices in the group of the file's vertices, texture coordinates and normals; [`NONE`]
    /// for those that the group does not use.
    vertex_here: Vec<u32>,
    uv_here: Vec<u32>,
    normal_here: Vec<u32>,
    /// A buffer for one face.
    corners: Vec<Point3>,
}

const NONE: u32 = u32::MAX;

/// The index in a group of an item of the file. New items are added.
fn here<T: Copy>(map: &mut Vec<u32>, all: &[T], used: &mut Vec<T>, number: u32) -> Result<u32, ErrorKind> {
    if map.len() < all.len() {
        map.resize(all.len(), NONE);
    }
    let place = &mut map[number as usize];
    if *place == NONE {
        *place = u32::try_from(used.len()).ok().filter(|n| *n != NONE).ok_or(ErrorKind::TooMany)?;
        used.push(all[number as usize]);
    }
    Ok(*place)
}

impl Group {
    /// Ends the group: if one face has texture coordinates, `uv_faces` gets an entry for each face.
    pub(crate) fn end(&mut self) {
        if !self.mesh.uv_faces.is_empty() {
            self.mesh.uv_faces.resize(self.mesh.faces.len(), None);
        }
    }
}

impl Groups {
    /// Starts another group.
    pub(crate) fn begin(&mut self, name: &str) {
        self.finish();
        self.now.name = name.to_string();
    }

    fn finish(&mut self) {
        let mut group = std::mem::take(&mut self.now);
        group.end();
        if !group.mesh.faces.is_empty() {
            self.vertex_here.fill(NONE);
            self.uv_here.fill(NONE);
            self.normal_here.fill(NONE);
            self.done.push(group);
        }
    }

    /// Adds a face whose indices are in range. Points and lines are ignored.
    pub(crate) fn face(&mut self, face: &[Corner], spot: Location) -> Result<(), ErrorKind> {
        if face.len() < 3 {
            return Ok(());
        }
        self.corners.clear();
        self.corners.extend(face.iter().map(|c| self.vertices[c.vertex as usize]));
        let Some(triangles) = polygon::triangles(&self.corners) else {
            return Err(ErrorKind::Corners { spot, count: face.len(), most: polygon::MOST });
        };
        let mesh = &mut self.now.mesh;
        for triangle in triangles {
            let mut vertices = [0; 3];
            let mut uv = [0; 3];
            let mut normals = [0; 3];
            let mut mapped = true;
            let mut smooth = true;
            for (i, corner) in triangle.map(|i| face[i]).into_iter().enumerate() {
                vertices[i] = here(&mut self.vertex_here, &self.vertices, &mut mesh.vertices, corner.vertex)?;
                match corner.uv {
                    Some(n) => uv[i] = here(&mut self.uv_here, &self.uv, &mut mesh.uv, n)?,
                    None => mapped = false,
                }
                match corner.normal {
                    Some(n) => {
                        normals[i] = here(&mut self.normal_here, &self.normals, &mut mesh.normals, n)?;
                    }
                    None => smooth = false,
                }
            }
            if mesh.faces.len() >= NONE as usize {
                return Err(ErrorKind::TooMany);
            }
            mesh.faces.push(Face { vertices, normals: smooth.then_some(normals), texture: None });
            if mapped {
                mesh.uv_faces.resize(mesh.faces.len() - 1, None);
                mesh.uv_faces.push(Some(uv));
            }
        }
        Ok(())
    }

    /// All groups that have faces.
    pub(crate) fn end(mut self) -> Vec<Group> {
        self.finish();
        self.done
    }
}
