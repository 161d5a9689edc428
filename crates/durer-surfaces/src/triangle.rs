//! The triangle, flat or with normals that vary over it.
//!
//! ```text
//!            v2               p = v0 + b1 (v1 - v0) + b2 (v2 - v0),   b1, b2 >= 0,  b1 + b2 <= 1
//!           ╱  ╲              n = (v1 - v0) x (v2 - v0)
//!         v0────v1
//! ```
//!
//! Which edges belong to the triangle is told by the rule of [`edges`](crate::edges): each edge to exactly one of its two sides, for each ray.

use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::planar::Probe;
use crate::{Flow, LocalRay, Need, Root, Sink, Surface, SurfacePoint};
use durer_math::eft::exponent;
use durer_math::{Aabb, Normal3, Point3};

/// A triangle, by its vertices. A root's tag is `(b1, b2)`.
///
/// # Invariants
///
/// The vertices are finite and not on one line. Normals, if given, are finite and not zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    vertices: Facet,
    normals: Option<Box<[Normal3; 3]>>,
    uv: Option<Box<[[f64; 2]; 3]>>,
}

/// Why a [`Triangle`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TriangleError {
    /// A vertex is infinite or NaN.
    #[error("triangle: a vertex must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Vertex(Point3),
    /// The vertices lie on one line.
    #[error("triangle: the vertices lie on one line")]
    Degenerate,
    /// A normal has no direction.
    #[error("triangle: a normal must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Normal(Normal3),
    /// Texture coordinates are infinite or NaN.
    #[error("triangle: texture coordinates must be finite, got <{}, {}>", .0[0], .0[1])]
    Uv([f64; 2]),
}

impl Triangle {
    /// The flat triangle with these vertices.
    pub fn new(vertices: [Point3; 3]) -> Result<Self, TriangleError> {
        if let Some(v) = vertices.into_iter().find(|v| !v.is_finite()) {
            return Err(TriangleError::Vertex(v));
        }
        if facet::is_degenerate(&vertices) {
            return Err(TriangleError::Degenerate);
        }
        Ok(Self { vertices, normals: None, uv: None })
    }

    /// The same triangle, shaded with normals that are interpolated between these at the vertices (of any length).
    pub fn with_normals(mut self, normals: [Normal3; 3]) -> Result<Self, TriangleError> {
        if let Some(n) = normals.into_iter().find(|n| n.normalized().is_none()) {
            return Err(TriangleError::Normal(n));
        }
        self.normals = Some(Box::new(normals));
        Ok(self)
    }

    /// The same triangle with these texture coordinates at the vertices. Without, they are (0, 0), (1, 0), (0, 1).
    pub fn with_uv(mut self, uv: [[f64; 2]; 3]) -> Result<Self, TriangleError> {
        if let Some(bad) = uv.into_iter().find(|uv| !uv.iter().all(|x| x.is_finite())) {
            return Err(TriangleError::Uv(bad));
        }
        self.uv = Some(Box::new(uv));
        Ok(self)
    }

    /// The vertices.
    pub fn vertices(&self) -> [Point3; 3] {
        self.vertices
    }

    /// The normals at the vertices, if they were given.
    pub fn normals(&self) -> Option<[Normal3; 3]> {
        self.normals.as_deref().copied()
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        let bounds = self.bounds();
        let half = bounds.max.map(|x| 0.5 * x) - bounds.min.map(|x| 0.5 * x);
        Probe::new(
            ray,
            bounds.min.map(|x| 0.5 * x) + bounds.max.map(|x| 0.5 * x).to_vec(),
            exponent(half.max_abs()) + 1,
        )
    }
}

impl Surface for Triangle {
    fn bounds(&self) -> Aabb {
        Aabb::from_points(self.vertices)
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        if let Some((crossing, tag)) = facet::hit(&probe, &EdgeFilter::new(&probe), &self.vertices)
            && !probe.leaves(&crossing)
            && !crossing.is_outside(sink.range())
            && probe.may_admit(&crossing)
            && probe.admits(&facet::plane(&probe, &self.vertices), &crossing)
        {
            let _: Flow = sink.push(probe.root(&crossing, 0, tag));
        }
    }

    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        let varying = Varying { normals: self.normals(), uv: self.uv.as_deref().copied() };
        facet::resolve(&self.probe(ray), &self.vertices, &varying, need)
    }
}
