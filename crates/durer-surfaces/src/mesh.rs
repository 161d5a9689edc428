//! The mesh: triangles that share vertices.
//!
//! Every face is met by the rule of [`edges`](crate::edges) on *one* ray for the whole mesh, so a ray through a shared edge or vertex meets
//! exactly one of the faces there (or none, or two, at a silhouette), and a closed mesh is crossed an even number of times. A mesh may be
//! declared solid: a point is inside if a ray from it crosses the faces an odd number of times (J. Arvo, D. Kirk, "A survey of ray
//! tracing acceleration techniques", in A. Glassner (ed.), *An Introduction to Ray Tracing*, 1989; the scene language's `inside_vector`).

use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::planar::{PointLine, Probe, ThreePoints};
use crate::{Flow, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint};
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Normal3, Point3, Vec3};

/// What a mesh is made of: lists of numbers, and indices into them.
///
/// ```
/// use durer_math::Point3;
/// use durer_surfaces::{Mesh, MeshData};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = Mesh::new(MeshData {
///     vertices: corners.map(Point3::from).to_vec(),
///     faces: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
///     ..MeshData::default()
/// })?;
/// assert!(mesh.is_closed());
/// # Ok::<(), durer_surfaces::MeshError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// The vertices.
    pub vertices: Vec<Point3>,
    /// Each face's three vertices. Its normal is `(v1 - v0) x (v2 - v0)`.
    pub faces: Vec<[u32; 3]>,
    /// Normals for shading, of any length. Empty: all faces are flat.
    pub normals: Vec<Normal3>,
    /// Each face's three normals, or [`FLAT`]. Empty: the normals go with the vertices.
    pub normal_faces: Vec<[u32; 3]>,
    /// Texture coordinates. Empty: each face has (0, 0), (1, 0), (0, 1).
    pub uv: Vec<[f64; 2]>,
    /// Each face's three texture coordinates. Empty: they go with the vertices.
    pub uv_faces: Vec<[u32; 3]>,
    /// One number for each face, for the mesh's owner (its material, say). Empty: all zero.
    pub attributes: Vec<u32>,
}

/// In [`MeshData::normal_faces`]: a face without normals of its own.
pub const FLAT: [u32; 3] = [u32::MAX; 3];

/// Triangles that share vertices. A root's face is the triangle's number in [`MeshData::faces`], its tag is `(b1, b2)`.
///
/// # Invariants
///
/// Indices are in range, lists of faces are empty or as long as `faces`. Faces without area or with a vertex that is
/// not finite are *dropped*: they keep their numbers and meet no ray.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    data: MeshData,
    /// Numbers of the dropped faces, ascending.
    dropped: Vec<u32>,
    bounds: Aabb,
    /// If the mesh is solid: where the ray goes that tells inside from outside.
    inside: Option<Vec3>,
}

/// Why a [`Mesh`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// An index is out of range.
    #[error("mesh: face {face} uses {what} {index}, but there are {len}")]
    Index {
        /// The list: "vertex", "normal" or "uv".
        what: &'static str,
        /// The face.
        face: usize,
        /// The index.
        index: u32,
        /// The list's length.
        len: usize,
    },
    /// A list that goes with the faces has another length.
    #[error("mesh: {what} has {len} entries for {faces} faces")]
    Length {
        /// The list.
        what: &'static str,
        /// Its length.
        len: usize,
        /// The number of faces.
        faces: usize,
    },
    /// More faces than 32 bits count.
    #[error("mesh: {0} faces are too many")]
    TooMany(usize),
    /// The direction that tells inside from outside is zero, infinite or NaN.
    #[error("mesh: the inside vector must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Inside(Vec3),
}

impl Mesh {
    /// The mesh of these faces; a sheet, until it is declared [solid](Mesh::solid).
    pub fn new(data: MeshData) -> Result<Self, MeshError> {
        let faces = data.faces.len();
        if u32::try_from(faces).is_err() {
            return Err(MeshError::TooMany(faces));
        }
        let lists = [
            ("normal_faces", data.normal_faces.len()),
            ("uv_faces", data.uv_faces.len()),
            ("attributes", data.attributes.len()),
        ];
        if let Some((what, len)) = lists.into_iter().find(|&(_, len)| len != 0 && len != faces) {
            return Err(MeshError::Length { what, len, faces });
        }
        check_indices("vertex", &data.faces, data.vertices.len())?;
        if !data.normals.is_empty() || !data.normal_faces.is_empty() {
            check_indices("normal", normal_faces(&data), data.normals.len())?;
        }
        if !data.uv.is_empty() || !data.uv_faces.is_empty() {
            check_indices("uv", uv_faces(&data), data.uv.len())?;
        }
        let mut mesh = Self { data, dropped: Vec::new(), bounds: Aabb::EMPTY, inside: None };
        for number in 0..faces as u32 {
            let facet = mesh.facet(number);
            if facet.iter().all(|v| v.is_finite()) && !facet::is_degenerate(&facet) {
                mesh.bounds = mesh.bounds.union(Aabb::from_points(facet));
            } else {
                mesh.dropped.push(number);
            }
        }
        Ok(mesh)
    }

    /// The same mesh as the boundary of a solid. A point is inside if the ray from it along `direction` crosses an odd number of faces;
    /// for a closed mesh the direction makes no difference.
    pub fn solid(mut self, direction: Vec3) -> Result<Self, MeshError> {
        if !direction.is_finite() || direction == Vec3::ZERO {
            return Err(MeshError::Inside(direction));
        }
        self.inside = Some(direction);
        Ok(self)
    }

    /// The lists the mesh was made from.
    pub fn data(&self) -> &MeshData {
        &self.data
    }

    /// The numbers of the faces that meet no ray, because they have no area or a vertex that is not finite; ascending.
    pub fn dropped(&self) -> &[u32] {
        &self.dropped
    }

    /// The owner's number for a face.
    pub fn attribute(&self, face: u32) -> u32 {
        self.data.attributes.get(face as usize).copied().unwrap_or(0)
    }

    /// Whether every edge is used equally often in both directions by the faces that are not dropped (vertices are compared by index):
    /// then the mesh bounds a solid.
    pub fn is_closed(&self) -> bool {
        let mut edges: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * self.data.faces.len());
        for number in self.live() {
            let [a, b, c] = self.data.faces[number as usize];
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), a < b)));
        }
        edges.sort_unstable();
        edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)).all(|group| {
            let forward = group.iter().filter(|e| e.2).count();
            2 * forward == group.len()
        })
    }

    fn live(&self) -> impl Iterator<Item = u32> {
        let all = 0..self.data.faces.len() as u32;
        all.filter(|number| self.dropped.is_empty() || self.dropped.binary_search(number).is_err())
    }

    #[inline(always)]
    fn facet(&self, number: u32) -> Facet {
        self.data.faces[number as usize].map(|i| self.data.vertices[i as usize])
    }

    /// From where the mesh is seen, and in which unit.
    #[inline(always)]
    fn view(&self) -> (Point3, i32) {
        let Aabb { min, max, .. } = self.bounds;
        if self.bounds.is_empty() {
            return (Point3::ORIGIN, 0);
        }
        let half = max.map(|x| 0.5 * x) - min.map(|x| 0.5 * x);
        (min.map(|x| 0.5 * x) + max.map(|x| 0.5 * x).to_vec(), exponent(half.max_abs()) + 1)
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        let (centre, scale) = self.view();
        Probe::new(ray, centre, scale)
    }

    #[inline(always)]
    fn face_root(
        &self,
        number: u32,
        probe: &Probe<'_>,
        filter: &EdgeFilter,
        range: (f64, f64),
    ) -> Option<Root> {
        let facet = self.facet(number);
        let (crossing, tag) = facet::hit(probe, filter, &facet)?;
        let here = !crossing.is_outside(range)
            && probe.may_admit(&crossing)
            && probe.admits(&facet::plane(probe, &facet), &crossing);
        here.then(|| probe.root(&crossing, number, tag))
    }
}

fn normal_faces(data: &MeshData) -> &[[u32; 3]] {
    if data.normal_faces.is_empty() { &data.faces } else { &data.normal_faces }
}

fn uv_faces(data: &MeshData) -> &[[u32; 3]] {
    if data.uv_faces.is_empty() { &data.faces } else { &data.uv_faces }
}

fn check_indices(what: &'static str, faces: &[[u32; 3]], len: usize) -> Result<(), MeshError> {
    for (face, corners) in faces.iter().enumerate() {
        if what == "normal" && *corners == FLAT {
            continue;
        }
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= len) {
            return Err(MeshError::Index { what, face, index, len });
        }
    }
    Ok(())
}

/// Whether a point's box meets a face's.
fn may_hold(facet: &Facet, point: &LocalPoint<'_>) -> bool {
    let Aabb { min, max, .. } = Aabb::from_points(*facet).expanded(point.p_err);
    (0..3).all(|i| min[i] <= point.p[i] && point.p[i] <= max[i])
}

/// Roots in the order of their parameter: a few on the stack, many on the heap.
struct Sorted {
    few: ArrayVec<Root, 16>,
    many: Vec<Root>,
}

impl Sorted {
    fn push(&mut self, root: Root) {
        if self.many.is_empty() {
            match self.few.try_push(root) {
                Ok(()) => return,
                Err(_) => self.many.extend(self.few.drain(..)),
            }
        }
        self.many.push(root);
    }

    fn pour<S: Sink + ?Sized>(mut self, sink: &mut S) {
        let roots = if self.many.is_empty() { self.few.as_mut_slice() } else { &mut self.many };
        roots.sort_unstable_by(Root::order);
        for root in roots {
            if sink.push(*root) == Flow::Stop {
                return;
            }
        }
    }
}

impl Surface for Mesh {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        let filter = EdgeFilter::new(&probe);
        let mut roots = Sorted { few: ArrayVec::new(), many: Vec::new() };
        for number in self.live() {
            if let Some(root) = self.face_root(number, &probe, &filter, sink.range()) {
                roots.push(root);
            }
        }
        roots.pour(sink);
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let face = root.face as usize;
        let data = &self.data;
        let corners = |faces: &[[u32; 3]]| faces[face].map(|i| i as usize);
        let smooth = !data.normals.is_empty() && normal_faces(data)[face] != FLAT;
        let varying = Varying {
            normals: smooth.then(|| corners(normal_faces(data)).map(|i| data.normals[i])),
            uv: (!data.uv.is_empty()).then(|| corners(uv_faces(data)).map(|i| data.uv[i])),
        };
        facet::resolve(&self.probe(ray), &self.facet(root.face), &varying, need)
    }

    fn solidity(&self) -> Solidity {
        if self.inside.is_some() { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        let Some(direction) = self.inside else { return Side::Out };
        let (centre, scale) = self.view();
        let line = PointLine::new(point, direction, centre, scale);
        let filter = EdgeFilter::new(&line);
        let mut odd = false;
        for number in self.live() {
            let facet = self.facet(number);
            let plane = ThreePoints { points: facet, centre, scale };
            if may_hold(&facet, point)
                // Only an inexact point leaves the height open.
                && line.side_of(&plane).is_none_or(Ordering::is_eq)
                && facet::holds_start(&line, &facet)
            {
                return Side::On;
            }
            // Ahead of the point if it lies above the plane and the line goes down (all sides positive), or below and up.
            if let Some(passed) = facet::passes(&line, &filter, &facet)
                && line.side_of(&plane).is_some_and(|height| height as i8 == passed.side)
            {
                odd = !odd;
            }
        }
        if odd { Side::In } else { Side::Out }
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        for number in self.live() {
            f(Aabb::from_points(self.facet(number)), PartId(number));
        }
    }

    fn part_roots<S: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        if let Some(root) = self.face_root(part.0, &probe, &EdgeFilter::new(&probe), sink.range()) {
            let _: Flow = sink.push(root);
        }
    }
}
