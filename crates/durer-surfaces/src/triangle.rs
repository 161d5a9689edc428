//! The triangle, flat or with normals that vary over it.
//!
//! ```text
//!            v2               p = v0 + b1 (v1 - v0) + b2 (v2 - v0),   b1, b2 >= 0,  b1 + b2 <= 1
//!           ╱  ╲              n = (v1 - v0) x (v2 - v0)
//!         v0────v1
//! ```
//!
//! The rule of `edges.rs` decides which edges belong to the triangle: for each ray, each edge
//! belongs to exactly one of its two sides.

use crate::compose::clip::Algebraic;
use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::packet::FilterSource;
use crate::planar::{self, Probe};
use crate::swift::{self, Swift};
use crate::{Accelerate, LocalRay, Need, PartId, Root, Sink, Surface, SurfacePoint};
use durer_math::{Aabb, Dyadic, Normal3, Point3};
use durer_roots::quadratic::Quadratic;

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

    /// The triangle with corners that are already known to be finite and not on one line, such as
    /// those of a mesh's face. They are not tested again.
    #[inline(always)]
    pub fn known(vertices: [Point3; 3]) -> Self {
        Self { vertices, normals: None, uv: None }
    }

    /// Adds shading normals, interpolated between these normals (of any length) at the vertices.
    pub fn with_normals(mut self, normals: [Normal3; 3]) -> Result<Self, TriangleError> {
        if let Some(n) = normals.into_iter().find(|n| n.normalized().is_none()) {
            return Err(TriangleError::Normal(n));
        }
        self.normals = Some(Box::new(normals));
        Ok(self)
    }

    /// Sets the texture coordinates at the vertices. The default is (0, 0), (1, 0), (0, 1).
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
        let (centre, size) = planar::middle(&self.bounds());
        Probe::new(ray, centre, size)
    }
}

impl Surface for Triangle {
    fn bounds(&self) -> Aabb {
        Aabb::from_points(self.vertices)
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        match swift::meet(ray, &self.vertices, 0, sink.range()) {
            Swift::Missed => return,
            Swift::Met(root) => {
                let _ = sink.push(root);
                return;
            }
            Swift::Open => {}
        }
        let probe = self.probe(ray);
        if let Some((crossing, tag)) = facet::hit(&probe, &EdgeFilter::new(&probe), &self.vertices)
            && !probe.leaves(&crossing)
            && !crossing.is_outside(sink.range())
            && probe.may_admit(&crossing)
            && probe.admits(&facet::plane(&probe, &self.vertices), &crossing)
        {
            let _ = sink.push(probe.root(&crossing, 0, tag));
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        let varying = Varying { normals: self.normals(), uv: self.uv.as_deref().copied() };
        facet::resolve(&self.probe(ray), &self.vertices, &varying, need)
    }
}

impl Accelerate for Triangle {
    fn name(&self) -> &'static str {
        "triangle"
    }

    fn corners(&self, _part: PartId) -> Option<[Point3; 3]> {
        Some(self.vertices)
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        let flat = FilterSource::flat(self.vertices);
        match &self.normals {
            Some(normals) => flat.with_normals(self.vertices, normals.map(Normal3::to_vec)),
            None => flat,
        }
    }
}

impl Algebraic for Triangle {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_through_along(self.vertices(), ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Crossing, Exact, ExactLine, Feature, Oracle, Surd, TestRng, check_many, exact3};
    use core::cmp::Ordering;
    use durer_math::Vec3;

    /// The triangle by big integers, with ties decided by the rule. It is a separate oracle,
    /// because the edges that belong to it depend on the ray.
    struct ExactTriangle {
        v: [[Exact; 3]; 3],
        n: [Exact; 3],
        size: f64,
    }

    fn minus(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
        [0, 1, 2].map(|i| &a[i] - &b[i])
    }

    fn times(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
    }

    fn by(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
        &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
    }

    impl ExactTriangle {
        fn new(t: &Triangle) -> Self {
            let v = t.vertices.map(|v| exact3(v.to_array()));
            let n = times(&minus(&v[1], &v[0]), &minus(&v[2], &v[0]));
            Self { v, n, size: planar::middle(&t.bounds()).1 }
        }

        /// Moves the line's origin by `2^-3000` and `2^-6000`, far less than the difference of any
        /// two different numbers here, instead of symbolically.
        fn moved(line: &ExactLine) -> ExactLine {
            let size: Vec<Exact> = line.d.iter().map(|d| d.clone().abs()).collect();
            let greater = |i: usize, j: usize| (&size[i] - &size[j]).sign().is_ge();
            let (a, b) = if greater(0, 1) && greater(0, 2) {
                (1, 2)
            } else if greater(1, 2) {
                (0, 2)
            } else {
                (0, 1)
            };
            let mut o = line.o.clone();
            o[a] = &o[a] + &Exact::from(1.0).shifted(-6000);
            o[b] = &o[b] + &Exact::from(1.0).shifted(-16000);
            ExactLine { o, d: line.d.clone() }
        }
    }

    impl Oracle for ExactTriangle {
        fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
            let slope = by(&self.n, &line.d);
            let moved = Self::moved(line);
            let seen = self.v.each_ref().map(|v| minus(v, &moved.o));
            let sign = |i: usize, j: usize| by(&line.d, &times(&seen[j], &seen[i])).sign();
            let signs = [sign(1, 2), sign(2, 0), sign(0, 1)];
            if slope.sign().is_eq() || signs[0] != signs[1] || signs[1] != signs[2] || signs[0].is_eq() {
                return vec![];
            }
            let t = Surd::ratio(by(&self.n, &minus(&self.v[0], &line.o)), slope.clone());
            vec![Crossing { t, sign: slope.sign() as i8, grazing: false }]
        }

        fn face_side(&self, _face: u32, point: &[Exact; 3]) -> Ordering {
            by(&self.n, &minus(point, &self.v[0])).sign()
        }

        fn face_normal(&self, _face: u32, _point: &[Exact; 3]) -> Vec3 {
            let n = Vec3::from(self.n.each_ref().map(Exact::to_f64));
            n.scale2(-exponent_of(n))
        }

        fn side(&self, _point: &[Exact; 3]) -> Option<Ordering> {
            None
        }

        fn size(&self) -> f64 {
            self.size
        }

        fn is_convex(&self) -> bool {
            false
        }
    }

    fn exponent_of(n: Vec3) -> i32 {
        durer_math::scale::exponent(n.max_abs().max(f64::MIN_POSITIVE))
    }

    #[test]
    fn triangles_obey_the_laws() {
        let mut roots = 0;
        for seed in 0..80 {
            let mut dice = TestRng::new(seed);
            let unit = dice.power(-40, 40);
            let v = match seed % 4 {
                0 | 1 => core::array::from_fn(|_| (dice.lattice(6) * unit).to_point()),
                2 => core::array::from_fn(|_| (dice.vector() * unit).to_point()),
                _ => {
                    // A needle: the third vertex is almost on the line of the others.
                    let (a, e) = (dice.vector() * unit, dice.vector() * unit);
                    let off = dice.vector() * (unit * dice.power(-50, -10));
                    [a.to_point(), (a + e).to_point(), (a + e * dice.unit() + off).to_point()]
                }
            };
            let Ok(triangle) = Triangle::new(v) else { continue };
            let n = v[0] + ((v[1] - v[0]).cross(v[2] - v[0]) * (1.0 / unit));
            let mut features = vec![];
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let edge = v[b] - v[a];
                features.push(Feature { point: v[a], direction: n - v[0] });
                features.push(Feature { point: v[a], direction: edge });
                features.push(Feature { point: v[a] + edge * 0.5, direction: n - v[0] });
                features.push(Feature { point: v[a] + edge * 0.5, direction: v[3 - a - b] - v[a] });
            }
            roots += check_many(&triangle, &ExactTriangle::new(&triangle), &features, seed, 250).roots;
        }
        assert!(roots > 2000, "{roots}");
    }

    #[test]
    fn normals_and_texture_coordinates_are_interpolated() {
        let v = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Point3::from);
        let normals = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(Normal3::from);
        let triangle = Triangle::new(v).unwrap().with_normals(normals).unwrap();
        let triangle = triangle.with_uv([[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]]).unwrap();
        let ray = durer_math::Ray::new(Point3::new(1.0, 2.0, 5.0), -Vec3::Z);
        let roots = crate::laws::all_roots(&triangle, &ray);
        assert_eq!(roots.iter().map(|r| (r.t, r.tag, r.sign)).collect::<Vec<_>>(), [(5.0, [0.25, 0.5], -1)]);
        let point = triangle.resolve(&LocalRay::new(&ray), &roots[0], Need::ALL);
        assert_eq!(point.p, Point3::new(1.0, 2.0, 0.0));
        assert_eq!(point.uv, [0.5, 1.5]);
        assert_eq!((point.dpdu, point.dpdv), (Vec3::X * 2.0, Vec3::Y * (4.0 / 3.0)));
        let expected = Normal3::new(0.25, 0.5, 1.0).normalized().unwrap();
        assert!((point.ns - expected).abs().max_abs() < 1e-15, "{:?}", point.ns);
    }

    #[test]
    fn a_bad_triangle_is_named() {
        let line = [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]].map(Point3::from);
        assert_eq!(Triangle::new(line), Err(TriangleError::Degenerate));
    }
}
