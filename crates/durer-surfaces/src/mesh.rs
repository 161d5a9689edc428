//! The mesh: triangles that share vertices.
//!
//! Every face is met by the rule of `edges.rs` on *one* ray for the whole mesh, so a ray through a
//! shared edge or vertex crosses exactly one of the faces there, and a closed mesh is crossed an
//! even number of times. Where a ray meets an edge or a vertex and passes on without entering, it
//! has one grazing root: see `contact.rs`. A mesh may be declared solid: a point is inside if a ray
//! from it crosses the faces an odd number of times (J. Arvo, D. Kirk, "A survey of ray tracing
//! acceleration techniques", in A. Glassner (ed.), *An Introduction to Ray Tracing*, 1989; the scene
//! language's `inside_vector`).

mod contact;
mod fans;

use self::contact::{Contact, Report};
use self::fans::LazyFans;
use crate::compose::clip::Algebraic;
use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::packet::FilterSource;
use crate::planar::{self, Crossing, PlaneForm, PointLine, Probe, ThreePoints};
use crate::swift::{self, Swift};
use crate::{
    Accelerate, LocalPoint, LocalRay, Need, PartId, Root, RootKind, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::eft::exponent;
use durer_math::{Aabb, Dyadic, Isa, Normal3, Point3, Vec3};
use durer_roots::quadratic::{self, Quadratic, exact_sign, sign_at_root};

/// The data of a mesh: lists of numbers, and indices into them.
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
    /// Each face's three normals, or [`FLAT`]. Empty: each vertex has the normal of its number.
    pub normal_faces: Vec<[u32; 3]>,
    /// Texture coordinates. Empty: each face has (0, 0), (1, 0), (0, 1).
    pub uv: Vec<[f64; 2]>,
    /// Each face's three texture coordinates. Empty: each vertex has those of its number.
    pub uv_faces: Vec<[u32; 3]>,
    /// One number for each face, for the mesh's owner (its material, say). Empty: all zero.
    pub attributes: Vec<u32>,
}

/// In [`MeshData::normal_faces`]: a face without normals of its own.
pub const FLAT: [u32; 3] = [u32::MAX; 3];

/// Triangles that share vertices. A root's face is the triangle's number in [`MeshData::faces`],
/// its tag is `(b1, b2)`.
///
/// # Invariants
///
/// Indices are in range, lists of faces are empty or as long as `faces`. Faces without area or with
/// a vertex that is not finite are *dropped*: they keep their numbers and meet no ray.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    data: MeshData,
    /// Numbers of the dropped faces, ascending.
    dropped: Vec<u32>,
    bounds: Aabb,
    /// If the mesh is solid: the direction of the ray that decides whether a point is inside.
    inside: Option<Vec3>,
    fans: LazyFans,
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
    /// A list with one entry a face has another length.
    #[error("mesh: {what} has {len} entries for {faces} faces")]
    Length {
        /// The list.
        what: &'static str,
        /// Its length.
        len: usize,
        /// The number of faces.
        faces: usize,
    },
    /// More faces than a 32-bit number can count.
    #[error("mesh: {0} faces are too many")]
    TooMany(usize),
    /// The direction of the ray that decides whether a point is inside is zero, infinite or NaN.
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
        let (dropped, fans) = (Vec::new(), LazyFans::default());
        let mut mesh = Self { data, dropped, bounds: Aabb::EMPTY, inside: None, fans };
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

    /// Declares the mesh to be the boundary of a solid. A point is inside if the ray from it along
    /// `direction` crosses an odd number of faces; for a closed mesh the direction makes no
    /// difference.
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

    /// The numbers of the faces that meet no ray, because they have no area or a vertex that is not
    /// finite; ascending.
    pub fn dropped(&self) -> &[u32] {
        &self.dropped
    }

    /// The owner's number for a face.
    pub fn attribute(&self, face: u32) -> u32 {
        self.data.attributes.get(face as usize).copied().unwrap_or(0)
    }

    /// Whether every edge is used equally often in both directions by the faces that are not
    /// dropped (vertices are compared by index): then the mesh bounds a solid.
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
        all.filter(|&number| self.is_live(number))
    }

    /// Whether a face is not dropped.
    fn is_live(&self, number: u32) -> bool {
        self.dropped.is_empty() || self.dropped.binary_search(&number).is_err()
    }

    #[inline(always)]
    pub(crate) fn facet(&self, number: u32) -> Facet {
        self.data.faces[number as usize].map(|i| self.data.vertices[i as usize])
    }

    /// The normals at the corners of a face, if it is not flat.
    #[inline(always)]
    fn corner_normals(&self, number: u32) -> Option<[Normal3; 3]> {
        let data = &self.data;
        let smooth = !data.normals.is_empty() && normal_faces(data)[number as usize] != FLAT;
        smooth.then(|| normal_faces(data)[number as usize].map(|i| data.normals[i as usize]))
    }

    /// The middle of the bounding box, and half its largest width.
    #[inline(always)]
    fn view(&self) -> (Point3, f64) {
        if self.bounds.is_empty() { (Point3::ORIGIN, 1.0) } else { planar::middle(&self.bounds) }
    }

    /// The ray relative to the face's own middle: the error at a small face of a large mesh should
    /// not depend on the mesh's size. The signs are still those of the one exact ray.
    #[inline(always)]
    fn probe<'a>(ray: &'a LocalRay<'a>, facet: &Facet) -> Probe<'a> {
        let (centre, size) = planar::middle(&Aabb::from_points(*facet));
        Probe::new(ray, centre, size)
    }

    #[inline(always)]
    fn face_root(&self, number: u32, ray: &LocalRay<'_>, range: (f64, f64)) -> Option<Root> {
        let facet = self.facet(number);
        match swift::meet(ray, &facet, number, range) {
            Swift::Missed => return None,
            Swift::Met(root) => return Some(root),
            Swift::Open => {}
        }
        let probe = Self::probe(ray, &facet);
        let filter = EdgeFilter::new(&probe);
        let passed = match facet::contact(&probe, &filter, &facet) {
            facet::Contact::Apart => return None,
            facet::Contact::Inside(passed) => passed,
            facet::Contact::Border(sides) => return self.border_root(number, &probe, sides, range),
        };
        let (crossing, tag) = facet::hit_of(&probe, &facet, &passed)?;
        admitted(&probe, &facet::plane(&probe, &facet), &crossing, range)
            .then(|| probe.root(&crossing, number, tag))
    }

    /// The root of a face whose edges the ray passes on these sides, some of them zero.
    #[cold]
    #[inline(never)]
    fn border_root(&self, number: u32, probe: &Probe<'_>, sides: [i8; 3], range: (f64, f64)) -> Option<Root> {
        let facet = self.facet(number);
        let crossed = Isa::detect().run(
            #[inline(always)]
            || facet::hit(probe, &EdgeFilter::new(probe), &facet),
        );
        let contact = Contact { mesh: self, fans: self.fans.of(&self.data), probe };
        match contact.report(number, sides, crossed.is_some()) {
            Some(Report::Nothing) => return None,
            Some(Report::Touch(site)) => {
                if let (Some((crossing, plane)), Some(tag)) =
                    (contact.crossing(site), contact.coordinates(number, site))
                {
                    return admitted(probe, &plane, &crossing, range).then(|| Root {
                        sign: 0,
                        kind: RootKind::Grazing,
                        ..probe.root(&crossing, number, tag)
                    });
                }
            }
            // An inexact ray for which the rule cannot be decided is a displaced one.
            Some(Report::Crossing) | None => {}
        }
        let (crossing, tag) = crossed?;
        admitted(probe, &facet::plane(probe, &facet), &crossing, range)
            .then(|| probe.root(&crossing, number, tag))
    }
}

/// Whether a crossing is in the ray's range and may be in the sink's.
#[inline(always)]
fn admitted<F: PlaneForm>(probe: &Probe<'_>, plane: &F, crossing: &Crossing, range: (f64, f64)) -> bool {
    !crossing.is_outside(range) && probe.may_admit(crossing) && probe.admits(plane, crossing)
}

#[inline(always)]
fn normal_faces(data: &MeshData) -> &[[u32; 3]] {
    if data.normal_faces.is_empty() { &data.faces } else { &data.normal_faces }
}

#[inline(always)]
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

/// Whether the bounding box of a point meets that of a face.
#[inline(always)]
pub(crate) fn may_hold(facet: &Facet, point: &LocalPoint<'_>) -> bool {
    let Aabb { min, max, .. } = Aabb::from_points(*facet).expanded(point.p_err);
    (0..3).all(|i| min[i] <= point.p[i] && point.p[i] <= max[i])
}

/// Roots in the order of their parameter: a few on the stack, many on the heap.
pub(crate) struct Sorted {
    few: ArrayVec<Root, 16>,
    many: Vec<Root>,
}

impl Sorted {
    pub(crate) fn new() -> Self {
        Self { few: ArrayVec::new(), many: Vec::new() }
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, root: Root) {
        if self.many.is_empty() {
            match self.few.try_push(root) {
                Ok(()) => return,
                Err(_) => self.many.extend(self.few.drain(..)),
            }
        }
        self.many.push(root);
    }

    #[inline(always)]
    pub(crate) fn pour<S: Sink + ?Sized>(mut self, sink: &mut S) -> ControlFlow<()> {
        let roots = if self.many.is_empty() { self.few.as_mut_slice() } else { &mut self.many };
        roots.sort_unstable_by(Root::order);
        show(roots, sink)
    }

    /// Passes on roots that were pushed in their exact order along the line: no parameter may be
    /// less than an earlier one.
    pub(crate) fn pour_in_turn<S: Sink + ?Sized>(mut self, sink: &mut S) -> ControlFlow<()> {
        let roots = if self.many.is_empty() { self.few.as_mut_slice() } else { &mut self.many };
        // A crossing is not beyond the upper end of any later one, and not before an earlier one.
        // Both hold for the exact parameters, so each `t` stays in its bracket.
        let mut last = f64::INFINITY;
        for root in roots.iter_mut().rev() {
            last = last.min(root.hi);
            root.t = root.t.min(last);
        }
        let mut first = f64::NEG_INFINITY;
        for root in roots.iter_mut() {
            first = first.max(root.t);
            root.t = first;
        }
        show(roots, sink)
    }
}

#[inline(always)]
fn show<S: Sink + ?Sized>(roots: &[Root], sink: &mut S) -> ControlFlow<()> {
    roots.iter().try_for_each(|root| sink.push(*root))
}

impl Surface for Mesh {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let mut roots = Sorted::new();
        for number in self.live() {
            if let Some(root) = self.face_root(number, ray, sink.range()) {
                roots.push(root);
            }
        }
        let _ = roots.pour(sink);
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let face = root.face as usize;
        let data = &self.data;
        let corners = |faces: &[[u32; 3]]| faces[face].map(|i| i as usize);
        let varying = Varying {
            normals: self.corner_normals(root.face),
            uv: (!data.uv.is_empty()).then(|| corners(uv_faces(data)).map(|i| data.uv[i])),
        };
        let facet = self.facet(root.face);
        if root.kind == RootKind::Grazing {
            return facet::resolve_at(root.tag, &facet, &varying, need);
        }
        facet::resolve(&Self::probe(ray, &facet), &facet, &varying, need)
    }

    fn solidity(&self) -> Solidity {
        if self.inside.is_some() { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        let Some(direction) = self.inside else { return Side::Out };
        let (centre, size) = self.view();
        let scale = exponent(size) + 1;
        let line = PointLine::new(point, direction, centre, scale);
        let filter = EdgeFilter::new(&line);
        let mut odd = false;
        for number in self.live() {
            let facet = self.facet(number);
            let plane = ThreePoints { points: facet, centre, scale };
            if may_hold(&facet, point)
                // The side is open only for an inexact point.
                && line.side_of(&plane).is_none_or(Ordering::is_eq)
                && facet::holds_start(&line, &facet)
            {
                return Side::On;
            }
            // Ahead of the point if it lies above the plane and the line goes down (all sides
            // positive), or below and up.
            if let Some(passed) = facet::passes(&line, &filter, &facet)
                && line.side_of(&plane).is_some_and(|height| height as i8 == passed.side)
            {
                odd = !odd;
            }
        }
        if odd { Side::In } else { Side::Out }
    }
}

impl Accelerate for Mesh {
    fn name(&self) -> &'static str {
        "mesh"
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        let vertices = self.facet(part.0);
        let flat = FilterSource::flat(vertices).on_face(part.0);
        match self.corner_normals(part.0) {
            Some(normals) => flat.with_normals(vertices, normals.map(Normal3::to_vec)),
            None => flat,
        }
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        true
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        for number in self.live() {
            f(Aabb::from_points(self.facet(number)), PartId(number));
        }
    }

    #[inline(always)]
    fn primitive_of(&self, part: PartId) -> u32 {
        part.0
    }

    fn corners(&self, part: PartId) -> Option<[Point3; 3]> {
        Some(self.facet(part.0))
    }

    #[inline(always)]
    fn part_roots<S: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut S) {
        if let Some(root) = self.face_root(part.0, ray, sink.range()) {
            let _ = sink.push(root);
        }
    }
}

impl Algebraic for Mesh {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_through_along(self.facet(face), ray)
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let p = self.polynomial(root.face, ray)?;
        // A grazing root does not tell it; a face that is touched edge-on has no crossing.
        let crossing = match exact_sign(&p.b) {
            Ordering::Greater => quadratic::Crossing::Out,
            Ordering::Less => quadratic::Crossing::In,
            Ordering::Equal => return None,
        };
        Some(sign_at_root(&p, crossing, q))
    }
}

#[cfg(test)]
mod tests;
