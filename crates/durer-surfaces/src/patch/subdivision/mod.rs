//! The subdivision surface: the limit of a polygon mesh under repeated refinement.
//!
//! ```text
//!      ●──────●            ●──●──●           ╭────╮       each step: a point for every face, edge
//!     ╱      ╱│           ╱  ╱  ╱│          ╱     │       and vertex (topology.rs); the limit is
//!    ●──────● │    ──▶   ●──●──● ●   ──▶   │      │       a smooth surface, met as it is and not
//!    │      │ ●          ●──●──●╱│         │      ╱       by way of any step
//!    │      │╱           │  │  │ ●          ╲____╱
//!    ●──────●            ●──●──●╱
//! ```
//!
//! Polygons follow the rules of Catmull and Clark (`topology.rs`), triangles those or Loop's
//! (`triangles.rs`). Where all vertices of a quadrilateral have four edges, the limit is a bicubic
//! B-spline patch, intersected like a [`BezierPatch`](crate::BezierPatch); where those of a
//! triangle have six, a quartic one, intersected like a
//! [`TriangularPatch`](crate::TriangularPatch). A face at another vertex is refined to three
//! patches and a smaller corner; the corner is refined further for rays that come near, down to the
//! size of their rounding errors (`limit.rs`). At the vertex itself the limit and its normal have a
//! closed form (`plan.rs`). Edges that are sharp for some steps only are refined until they are
//! smooth.
//!
//! E. Catmull, J. Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes",
//! *Computer-Aided Design* 10 (1978) 350-355; T. DeRose, M. Kass, T. Truong, "Subdivision surfaces in
//! character animation", *SIGGRAPH* 1998; J. Stam, "Exact evaluation of Catmull-Clark subdivision
//! surfaces at arbitrary parameter values", *SIGGRAPH* 1998; for ray tracing L. Kobbelt, K. Daubert,
//! H.-P. Seidel, "Ray tracing of subdivision surfaces", *Eurographics Workshop on Rendering* 1998, and
//! M. Niessner, C. Loop, M. Meyer, T. DeRose, "Feature-adaptive GPU rendering of Catmull-Clark
//! subdivision surfaces", *ACM Transactions on Graphics* 31:1 (2012).

mod candidates;
mod data;
mod limit;
mod plan;
mod point;
mod sharp_normal;
mod smooth_uv;
mod topology;
mod triangles;

use super::{map_uv, triangular};
use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use data::INFINITELY_SHARP;
use durer_math::{Aabb, Dd, Dyadic, Isa, Point3};
use durer_roots::quadratic::Quadratic;
use limit::{AHEAD, Limit};
use smooth_uv::SmoothUv;
use std::sync::Arc;
use topology::{Adjacency, Topology, apply, edge_of};

pub use data::{Boundary, Scheme, SubdivisionData, SubdivisionError, UvInterpolation};

/// The limit surface of a control mesh under Catmull and Clark's subdivision, or under Loop's.
///
/// A mesh without boundary encloses a solid. Otherwise it is an open surface, whose stored normal
/// follows the winding of the faces. Under Loop's rules a root's face is a triangle of the mesh,
/// and its tag `(u, v)` in that, with `u + v <= 1`. Otherwise it is a quadrilateral, and its tag
/// `(u, v)` in that: a face with four vertices is one, if all faces of the mesh have four;
/// otherwise each face is as many as it has vertices ([`SubdivisionSurface::control_face`]). In a
/// tag a number with a minus sign is that much less than 1, so that both ends are equally sharp.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{Closest, LocalRay, SubdivisionData, SubdivisionSurface, Surface};
/// // A cube becomes a rounded body; its limit at the middle of a face is that of the B-spline rules.
/// let at = |k: u32| Point3::new(f64::from(k >> 2), f64::from(k >> 1 & 1), f64::from(k & 1));
/// let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
/// let data = SubdivisionData {
///     vertices: (0..8).map(at).collect(),
///     faces: faces.iter().map(|f| f.to_vec()).collect(),
///     ..SubdivisionData::default()
/// };
/// let body = SubdivisionSurface::new(data)?;
/// let ray = Ray::new(Point3::new(3.0, 0.5, 0.5), Vec3::new(-1.0, 0.0, 0.0));
/// let mut closest = Closest::default();
/// body.roots(&LocalRay::new(&ray), &mut closest);
/// assert_eq!(closest.root.map(|root| root.sign), Some(-1));
/// # Ok::<(), durer_surfaces::SubdivisionError>(())
/// ```
///
/// # Invariants
///
/// The mesh is a manifold, with or without boundary, whose faces are wound alike; its numbers are
/// finite.
#[derive(Clone, Debug)]
pub struct SubdivisionSurface {
    data: Arc<SubdivisionData>,
    limit: Arc<Limit>,
    /// The face of the control mesh of each quadrilateral or triangle.
    origins: Arc<[u32]>,
    /// Texture coordinates at the corners of each quadrilateral; triangles have an unused fourth.
    /// Empty if the parameters are used.
    uv: Arc<[[[f64; 2]; 4]]>,
    /// Texture coordinates by the rules of the surface, if requested.
    smooth_uv: Option<Arc<SmoothUv>>,
    is_closed: bool,
}

/// Converts a sharpness to the form that the rules use.
fn sharpness_of(given: f64) -> f64 {
    if given >= INFINITELY_SHARP { f64::INFINITY } else { given }
}

/// The control mesh without coordinates.
fn topology(data: &SubdivisionData) -> Topology {
    let mut mesh = Topology {
        scheme: data.scheme,
        points: data.vertices.len(),
        faces: data.faces.clone(),
        ..Topology::default()
    };
    // Of two values for one edge the sharper is used.
    for &([a, b], sharpness) in &data.creases {
        let entry = mesh.creases.entry(edge_of(a, b)).or_insert(0.0);
        *entry = entry.max(sharpness_of(sharpness));
    }
    for &(v, sharpness) in &data.corners {
        let entry = mesh.corners.entry(v).or_insert(0.0);
        *entry = entry.max(sharpness_of(sharpness));
    }
    if data.boundary == Boundary::Corners {
        let mut count = vec![0_u32; data.vertices.len()];
        for &v in data.faces.iter().flatten() {
            count[v as usize] += 1;
        }
        for (v, count) in count.iter().enumerate() {
            // A vertex of a closed mesh has two faces at least.
            if *count == 1 {
                mesh.corners.insert(v as u32, f64::INFINITY);
            }
        }
    }
    mesh
}

/// Six times the volume that a closed mesh encloses, by triangles from the first vertex of each face.
fn volume(data: &SubdivisionData, centre: Point3) -> f64 {
    let at = |v: u32| data.vertices[v as usize] - centre;
    let of = |face: &Vec<u32>| {
        let a = at(face[0]);
        face.windows(2).skip(1).map(|w| a.dot(at(w[0]).cross(at(w[1])))).sum::<f64>()
    };
    data.faces.iter().map(of).sum()
}

impl SubdivisionSurface {
    /// The surface of this control mesh.
    pub fn new(data: SubdivisionData) -> Result<Self, SubdivisionError> {
        Self::made(data, AHEAD)
    }

    /// The surface with fewer steps computed in advance.
    #[cfg(test)]
    fn remade(&self, ahead: u32) -> Self {
        Self::made((*self.data).clone(), ahead).unwrap_or_else(|_| self.clone())
    }

    fn made(data: SubdivisionData, ahead: u32) -> Result<Self, SubdivisionError> {
        data.check()?;
        let used = data.faces.iter().flatten().map(|v| data.vertices[*v as usize]);
        let frame = Limit::frame(used);
        let (centre, scale, _) = frame;
        let unit = |p: &Point3| {
            let about = |x: f64, c: f64| Dd::difference(x, c).scale2(-scale);
            [about(p.x, centre.x), about(p.y, centre.y), about(p.z, centre.z)]
        };
        let mut points: Vec<[Dd; 3]> = data.vertices.iter().map(unit).collect();
        let mut mesh = topology(&data);
        let mut origins: Vec<u32> = (0..mesh.faces.len() as u32).collect();
        let corner_uv = |face: usize, k: usize| data.uv[data.uv_faces[face][k] as usize];
        let is_smooth = data.uv_interpolation == UvInterpolation::Smooth && !data.uv_faces.is_empty();
        let has_uv = !is_smooth && !data.uv_faces.is_empty();
        let control = is_smooth.then(|| mesh.clone());
        let mut uv: Vec<[[f64; 2]; 4]> = vec![];
        if data.scheme == Scheme::Loop {
            if has_uv {
                uv = (0..mesh.faces.len()).map(|f| [0, 1, 2, 0].map(|k| corner_uv(f, k))).collect();
            }
        } else if mesh.faces.iter().all(|face| face.len() == 4) {
            if has_uv {
                uv = (0..mesh.faces.len()).map(|f| [0, 1, 2, 3].map(|k| corner_uv(f, k))).collect();
            }
        } else {
            let finer = Adjacency::new(&mesh).refined(|_| true);
            points = finer.stencils.iter().map(|stencil| apply(stencil, &points)).collect();
            origins = finer.origins.iter().map(|(face, _)| *face as u32).collect();
            if has_uv {
                uv = finer
                    .origins
                    .iter()
                    .map(|&(face, k)| part_uv(data.uv_faces[face].len(), k, |k| corner_uv(face, k)))
                    .collect();
            }
            mesh = finer.mesh;
        }
        let mut is_missing = vec![false; data.faces.len()];
        for hole in &data.holes {
            is_missing[*hole as usize] = true;
        }
        let is_hole: Vec<bool> = origins.iter().map(|face| is_missing[*face as usize]).collect();
        let smooth_uv = control.and_then(|control| SmoothUv::new(&data, &control, &is_hole)).map(Arc::new);
        let is_closed = data.holes.is_empty() && is_closed(&data);
        let limit = Limit::new(&mesh, &points, &is_hole, frame, ahead);
        let mut limit = limit.ok_or(SubdivisionError::Nothing("its faces do not make a surface"))?;
        limit.is_closed = is_closed;
        if is_closed && volume(&data, centre) < 0.0 {
            limit.outward = -1;
        }
        let limit = Arc::new(limit);
        Ok(Self { data: Arc::new(data), limit, origins: origins.into(), uv: uv.into(), smooth_uv, is_closed })
    }

    /// The input that it was made from.
    pub fn data(&self) -> &SubdivisionData {
        &self.data
    }

    /// Whether the mesh has no boundary and no holes: then it is a solid.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The face of the control mesh that a root's face is a part of.
    pub fn control_face(&self, face: u32) -> Option<u32> {
        self.origins.get(face as usize).copied()
    }

    /// The number of patches, and of corners that are refined on demand, that are built in advance.
    pub fn counts(&self) -> [usize; 2] {
        self.limit.counts()
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || self.limit.roots(ray, sink),
        );
    }
}

/// Whether each edge has two faces.
fn is_closed(data: &SubdivisionData) -> bool {
    let mut edges = std::collections::HashSet::new();
    for face in &data.faces {
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            if !edges.remove(&[b, a]) {
                edges.insert([a, b]);
            }
        }
    }
    edges.is_empty()
}

/// The texture coordinates of the quadrilateral at a corner of a face: at that corner, the middles of
/// its edges and the middle of the face.
fn part_uv(n: usize, k: usize, at: impl Fn(usize) -> [f64; 2]) -> [[f64; 2]; 4] {
    let (own, next, before) = (at(k), at((k + 1) % n), at((k + n - 1) % n));
    let half = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| 0.5 * (a[i] + b[i]));
    let middle = [0, 1].map(|i| (0..n).map(|k| at(k)[i]).sum::<f64>() / n as f64);
    [own, half(own, next), middle, half(own, before)]
}

/// Surfaces are equal if they are made from equal data.
impl PartialEq for SubdivisionSurface {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

impl Surface for SubdivisionSurface {
    fn bounds(&self) -> Aabb {
        self.limit.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.limit.centre, self.limit.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    /// Texture coordinates: those given at the corners of faces, by the rules of the surface, or bilinear
    /// between them and linear in triangles; without any the parameters of the face.
    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let mut point = Isa::detect().run(
            #[inline(always)]
            || self.limit.point(ray, root),
        );
        if let Some((uv, slopes)) = self.smooth_uv.as_ref().and_then(|uv| uv.at(root.face, root.tag)) {
            point.uv = uv;
            point.change_parameters(slopes, need);
        } else if let Some(corners) = self.uv.get(root.face as usize) {
            match self.data.scheme {
                Scheme::CatmullClark => map_uv(corners, &mut point, need),
                Scheme::Loop => {
                    let [a, b, c, _] = *corners;
                    triangular::map_uv(&[a, b, c], &mut point, need);
                }
            }
        }
        point
    }

    fn solidity(&self) -> Solidity {
        if self.is_closed { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.is_closed { self.limit.side(point) } else { Side::Out }
    }
}

impl Accelerate for SubdivisionSurface {
    fn name(&self) -> &'static str {
        "subdivision surface"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.limit.bounds)
    }
}

impl Algebraic for SubdivisionSurface {
    /// The surface has no polynomial of low degree along a ray.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }
}

#[cfg(test)]
mod tests;
