//! The mesh camera: rays start at the faces of meshes, along their normals.
//!
//! ```text
//!   the n-th face for the pixel in column c and row r of W by H:      n = W r + c
//!   texture coordinates for the place (x, y) in pixels:               u = (x - 1/2) / W,  v = 1 - (y - 1/2) / H
//! ```
//!
//! POV-Ray counts rows from the second, so that the first two show the same faces, and keeps `x`
//! below `W - 1` and `y` above 1. This was found from its pictures and is done likewise here, so
//! that the pictures agree.

use std::sync::Arc;

use durer_math::{Affine, Point3, Ray, Vec3};
use durer_scene::{Distribution, Face, Mesh, MeshCamera};

use super::uv_grid::UvGrid;
use crate::vector::{dot, unit};

/// A camera whose rays start at the faces of meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRays {
    meshes: Vec<(Arc<Mesh>, Affine)>,
    distribution: Distribution,
    /// The way from a face to the start of its ray, in units of the normal.
    offset: f64,
    /// Whether rays run against the normals.
    reversed: bool,
    /// The faces of the first mesh by their texture coordinates.
    by_uv: Option<UvGrid>,
    /// The end of the rays.
    pub(crate) t_max: f64,
}

impl MeshRays {
    /// Prepares a mesh camera, from its meshes and the vectors of the scene's camera.
    pub(super) fn new(camera: &MeshCamera, location: Point3, direction: Vec3) -> Self {
        let meshes: Vec<_> =
            camera.meshes.iter().map(|(mesh, placement)| (Arc::clone(mesh), *placement.affine())).collect();
        let by_uv = match camera.distribution {
            Distribution::Uv { .. } => meshes.first().map(|(mesh, _)| UvGrid::new(mesh)),
            _ => None,
        };
        Self {
            meshes,
            distribution: camera.distribution,
            offset: location.z,
            reversed: direction.z < 0.0,
            by_uv,
            t_max: camera.max_distance.unwrap_or(f64::INFINITY),
        }
    }

    /// The number of rays of each place, with those that have no face.
    pub(crate) fn rays_per_place(&self) -> u32 {
        match self.distribution {
            Distribution::Each(n) | Distribution::Joined(n) => n.max(1),
            Distribution::SideBySide | Distribution::Uv { .. } => 1,
        }
    }

    /// The ray with this number through a place in pixels of a picture; `None` without a face.
    pub(crate) fn ray(&self, x: f64, y: f64, number: u32, (width, height): (u32, u32)) -> Option<Ray> {
        let (w, h) = (f64::from(width), f64::from(height));
        let (x, y) = (x.min(w - 1.0).max(0.0), y.max(1.0));
        let (column, row) = (x as u64, (y - 1.0) as u64);
        let pixel = row * u64::from(width) + column;
        match self.distribution {
            Distribution::Each(_) => {
                let (mesh, place) = self.meshes.get(number as usize)?;
                self.along(mesh, place, mesh.faces.get(usize::try_from(pixel).ok()?)?)
            }
            Distribution::Joined(_) => {
                let picture = u64::from(width) * u64::from(height);
                let mut face = usize::try_from(picture.checked_mul(u64::from(number))? + pixel).ok()?;
                for (mesh, place) in &self.meshes {
                    match mesh.faces.get(face) {
                        Some(own) => return self.along(mesh, place, own),
                        None => face -= mesh.faces.len(),
                    }
                }
                None
            }
            Distribution::SideBySide => {
                let count = self.meshes.len();
                let (mesh, place) = self.meshes.get((x * count as f64 / w) as usize)?;
                let face = row * (u64::from(width) / count as u64) + column;
                self.along(mesh, place, mesh.faces.get(usize::try_from(face).ok()?)?)
            }
            Distribution::Uv { smooth } => {
                let (mesh, place) = self.meshes.first()?;
                let (u, v) = ((x - 0.5) / w, 1.0 - (y - 0.5) / h);
                let (face, weights) = self.by_uv.as_ref()?.find(mesh, u, v)?;
                let face = mesh.faces.get(face)?;
                let normal = match face.normals.filter(|_| smooth) {
                    Some(at) => mixed(at.map(|i| mesh.normals[i as usize]), weights),
                    None => flat(mesh, face),
                };
                let corners = face.vertices.map(|i| mesh.vertices[i as usize].to_vec());
                self.from(place, mixed(corners, weights).to_point(), normal)
            }
        }
    }

    /// The ray of a face: from its centroid along its normal.
    fn along(&self, mesh: &Mesh, place: &Affine, face: &Face) -> Option<Ray> {
        let corners = face.vertices.map(|i| mesh.vertices[i as usize].to_vec());
        self.from(place, mixed(corners, [1.0 / 3.0; 3]).to_point(), flat(mesh, face))
    }

    /// The ray from a point of a mesh along a normal, both in the mesh's own frame.
    fn from(&self, place: &Affine, point: Point3, normal: Vec3) -> Option<Ray> {
        let normal = place.normal(normal.to_normal()).to_vec();
        let square = dot(normal, normal);
        if !(square > 0.0 && square.is_finite()) {
            return None;
        }
        let normal = unit(normal);
        let direction = if self.reversed { -normal } else { normal };
        Some(Ray::new(place.point(point) + normal * self.offset, direction))
    }

    /// The greatest sum of the magnitudes of a start's coordinates.
    pub(super) fn start_size(&self) -> f64 {
        let sizes = self.meshes.iter().flat_map(|(mesh, place)| {
            mesh.vertices.iter().map(|&corner| {
                let p = place.point(corner);
                p.x.abs() + p.y.abs() + p.z.abs()
            })
        });
        sizes.fold(0.0, f64::max) + self.offset.abs()
    }
}

/// The normal of a face, of any length: towards the side from which its corners run clockwise in a
/// left-handed frame.
fn flat(mesh: &Mesh, face: &Face) -> Vec3 {
    let [a, b, c] = face.vertices.map(|i| mesh.vertices[i as usize]);
    let (e, f) = (c - a, b - a);
    Vec3::new(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x)
}

fn mixed(of: [Vec3; 3], weights: [f64; 3]) -> Vec3 {
    of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Placement;

    /// Triangles in the plane z = 0, centred at (0, row), (1, row) ..., seen along -z.
    fn triangles(count: usize, row: f64) -> Arc<Mesh> {
        let mut mesh = Mesh {
            vertices: Vec::new(),
            normals: Vec::new(),
            faces: Vec::new(),
            uv: Vec::new(),
            uv_faces: Vec::new(),
            textures: Vec::new(),
            inside_vector: None,
        };
        for i in 0..count {
            let first = mesh.vertices.len() as u32;
            for (x, y) in [(-0.25, -0.25), (0.5, -0.25), (-0.25, 0.5)] {
                mesh.vertices.push(Point3::new(i as f64 + x, row + y, 0.0));
            }
            mesh.faces.push(Face { vertices: [first, first + 1, first + 2], normals: None, texture: None });
        }
        Arc::new(mesh)
    }

    fn camera(distribution: Distribution, meshes: &[Arc<Mesh>]) -> MeshRays {
        let meshes = meshes.iter().map(|mesh| (Arc::clone(mesh), Placement::IDENTITY)).collect();
        let camera = MeshCamera { meshes, distribution, max_distance: None };
        MeshRays::new(&camera, Point3::new(0.0, 0.0, 0.5), Vec3::Z)
    }

    /// The places of the faces that a row of the picture shows.
    /// The whole numbers next to where the rays of a row start, which tell the faces.
    fn row(camera: &MeshRays, y: u32, number: u32, picture: (u32, u32)) -> Vec<Option<(f64, f64)>> {
        let ray = |x: u32| camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, number, picture);
        (0..picture.0).map(|x| ray(x).map(|ray| (ray.origin.x.round(), ray.origin.y.round()))).collect()
    }

    #[test]
    fn rays_run_along_normals() {
        let camera = camera(Distribution::Each(1), &[triangles(1, 0.0)]);
        let ray = camera.ray(0.5, 0.5, 0, (1, 1)).unwrap();
        assert_eq!((ray.origin, ray.direction), (Point3::new(0.0, 0.0, -0.5), Vec3::new(0.0, 0.0, -1.0)));
    }

    #[test]
    fn pixels_have_faces_of_their_number() {
        let meshes = [triangles(7, 0.0), triangles(5, 1.0)];
        let each = camera(Distribution::Each(2), &meshes);
        let at = |x: f64, y: f64| Some((x, y));
        let first = vec![at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0)];
        assert_eq!(row(&each, 0, 0, (3, 3)), first);
        assert_eq!(row(&each, 1, 0, (3, 3)), first);
        assert_eq!(row(&each, 2, 1, (3, 3)), [at(3.0, 1.0), at(4.0, 1.0), None]);
        let joined = camera(Distribution::Joined(2), &meshes);
        assert_eq!(row(&joined, 0, 1, (3, 2)), [at(6.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)]);
        assert_eq!(row(&joined, 0, 2, (3, 2)), [None, None, None]);
        let both = camera(Distribution::SideBySide, &meshes);
        assert_eq!(row(&both, 0, 0, (4, 2)), [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 1.0), at(3.0, 1.0)]);
    }

    #[test]
    fn texture_coordinates_lead_to_points() {
        let mut mesh = (*triangles(2, 0.0)).clone();
        mesh.uv = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        mesh.uv_faces = vec![Some([0, 1, 2]), Some([1, 3, 2])];
        mesh.normals = vec![Vec3::X, Vec3::Y, Vec3::Z];
        mesh.faces[0].normals = Some([0, 1, 2]);
        let camera = camera(Distribution::Uv { smooth: true }, &[Arc::new(mesh)]);
        // u = 1/4, v = 1/2.
        let ray = camera.ray(1.5, 2.5, 0, (4, 4)).unwrap();
        let normal = unit(Vec3::new(1.0, 1.0, 2.0));
        assert!((ray.direction - normal).max_abs() < 1e-15);
        let start = Vec3::new(-0.25 + 0.25 * 0.75, -0.25 + 0.5 * 0.75, 0.0) + normal * 0.5;
        assert!((ray.origin.to_vec() - start).max_abs() < 1e-15);
        assert!(camera.ray(3.5, 0.5, 0, (4, 4)).unwrap().origin.x > 0.5);
    }
}
