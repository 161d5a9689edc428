//! The polygon: a flat sheet within one or more closed outlines.
//!
//! ```text
//!        ┌───────────────┐
//!        │    ┌─────┐    │      winding number of the outlines about the ray:
//!        │    │  0  │  1 │        even-odd: inside where it is odd
//!        │    └─────┘    │        non-zero: inside where it is not zero
//!        └───────────────┘
//! ```
//!
//! A. Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968, counted
//! crossings in the plane; here they are counted about the ray itself. Along the ray's direction,
//! an edge that crosses a fixed half-line from the ray's point counts by its direction. The sign of
//! one 2x2 minor for each vertex, and of `U` for the edges in question, decides which edges cross
//! it: the edge function of the triangles with its rule for ties (see `edges.rs`). So a polygon is
//! watertight against polygons and triangles with the same vertices.
//!
//! The plane goes through three of the vertices. The others may lie off it by the rounding of
//! single-precision numbers, in which many files store them; worse polygons are refused. In that
//! case the ray must still pass through the outline of the stored vertices (so that there is no gap
//! to a neighbour), the crossing is the one with the plane, and it must lie in the bounding box: a
//! ray that skims the plane could otherwise pass the outline far from its crossing with the plane.

use crate::FillRule;
use crate::compose::clip::Algebraic;
use crate::edges::{self, EdgeFilter};
use crate::facet::{self, Facet};
use crate::packet::FilterSource;
use crate::planar::{self, AlongRay, Line, PlaneForm, Probe, ThreePoints};
use crate::{Accelerate, LocalRay, Need, PartId, RingRay, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Dyadic, Isa, Point3, Ring, Vec3};
use durer_roots::quadratic::Quadratic;

/// A flat sheet within closed outlines. Its normal is that of the first outline, counter-clockwise.
///
/// # Invariants
///
/// Every outline has at least three vertices, all finite; not all vertices lie on one line.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// All outlines, one after the other.
    vertices: Vec<Point3>,
    /// Where each outline ends in `vertices`.
    ends: Vec<u32>,
    rule: FillRule,
    /// Three vertices that span the plane.
    plane: Facet,
    /// How far the box exceeds the vertices; `None` if all vertices lie exactly in the plane.
    margin: Option<f64>,
    bounds: Aabb,
}

/// Why a [`Polygon`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// There is no outline.
    #[error("polygon: there is no outline")]
    Empty,
    /// An outline has fewer than three vertices.
    #[error("polygon: outline {outline} has {len} vertices, it needs 3 at least")]
    TooShort {
        /// The outline, from 0.
        outline: usize,
        /// Its number of vertices.
        len: usize,
    },
    /// More vertices than a 32-bit number can count.
    #[error("polygon: {0} vertices are too many")]
    TooMany(usize),
    /// A vertex is infinite or NaN.
    #[error("polygon: a vertex must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Vertex(Point3),
    /// All vertices lie on one line.
    #[error("polygon: the vertices lie on one line")]
    Degenerate,
    /// A vertex lies off the plane of the others.
    #[error("polygon: vertex <{}, {}, {}> is {distance} away from the plane of the others", .vertex.x, .vertex.y, .vertex.z)]
    NotPlanar {
        /// The vertex.
        vertex: Point3,
        /// Its distance from the plane.
        distance: f64,
    },
}

/// The largest distance of a vertex from the plane, relative to the polygon's width: the half ulp
/// of single precision, in which many files store their coordinates.
const PLANARITY: f64 = 1.0 / (1u64 << 24) as f64;

impl Polygon {
    /// The polygon within these outlines. Each is closed automatically; a last vertex equal to the
    /// first is dropped.
    pub fn new<L: AsRef<[Point3]>>(outlines: &[L], rule: FillRule) -> Result<Self, PolygonError> {
        let (mut vertices, mut ends) = (Vec::new(), Vec::new());
        for (outline, points) in outlines.iter().enumerate() {
            let points = points.as_ref();
            let points = match points {
                [first, inner @ .., last] if first == last && !inner.is_empty() => {
                    &points[..points.len() - 1]
                }
                _ => points,
            };
            if points.len() < 3 {
                return Err(PolygonError::TooShort { outline, len: points.len() });
            }
            if let Some(v) = points.iter().find(|v| !v.is_finite()) {
                return Err(PolygonError::Vertex(*v));
            }
            vertices.extend_from_slice(points);
            ends.push(u32::try_from(vertices.len()).map_err(|_| PolygonError::TooMany(vertices.len()))?);
        }
        let Some(&first_end) = ends.first() else { return Err(PolygonError::Empty) };
        let bounds = Aabb::from_points(vertices.iter().copied());
        let plane = spanning(&vertices, first_end as usize).ok_or(PolygonError::Degenerate)?;
        let n = facet::unit_normal(&plane);
        let allowed = bounds.widths().max_abs() * PLANARITY;
        for &vertex in &vertices {
            let distance = n.dot(vertex - plane[0]).abs();
            if distance > allowed {
                return Err(PolygonError::NotPlanar { vertex, distance });
            }
        }
        let flat = vertices.iter().all(|&v| facet::holds_in_plane(&plane, v));
        let margin = (!flat).then_some(allowed);
        let bounds = margin.map_or(bounds, |by| bounds.expanded(Vec3::new(by, by, by)));
        Ok(Self { vertices, ends, rule, plane, margin, bounds })
    }

    /// The outlines.
    pub fn outlines(&self) -> impl Iterator<Item = &[Point3]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let outline = &self.vertices[start..end as usize];
            start = end as usize;
            outline
        })
    }

    /// The winding numbers that count as inside.
    pub fn rule(&self) -> FillRule {
        self.rule
    }

    /// Three vertices that span the plane.
    pub(crate) fn spanning(&self) -> Facet {
        self.plane
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        let (centre, size) = planar::middle(&self.bounds);
        Probe::new(ray, centre, size)
    }

    #[inline(always)]
    pub(crate) fn plane(&self, probe: &Probe<'_>) -> ThreePoints {
        facet::plane(probe, &self.plane)
    }

    /// Whether a line passes through the polygon, by its outlines' winding numbers. In the line's
    /// frame the polygon must be within one unit of the centre.
    #[inline(always)]
    pub(crate) fn holds<L: Line>(&self, line: &L) -> bool {
        let winding = Winding::new(line);
        let turns: i64 = self.outlines().map(|outline| winding.of(outline)).sum();
        match self.rule {
            FillRule::EvenOdd => turns & 1 == 1,
            FillRule::NonZero => turns != 0,
        }
    }
}

/// How far the crossing is above the level `at` of an axis, times the slope.
struct FromLevel<'a> {
    plane: &'a ThreePoints,
    axis: usize,
    at: f64,
}

impl AlongRay for FromLevel<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (slope, height) = (self.plane.slope(ray), self.plane.height(ray)?);
        let centre = self.plane.centre[self.axis];
        let level = (T::exact(self.at) - T::exact(centre)).scale2(-self.plane.scale);
        let above = ray.o[self.axis].clone() - level * ray.w.clone();
        Some(above * slope - ray.d[self.axis].clone() * height)
    }
}

/// Whether a crossing with a plane lies in a box, faces included. An inexact ray that cannot be
/// excluded counts as inside.
#[inline(always)]
fn within(probe: &Probe<'_>, plane: &ThreePoints, slope: i8, bounds: &Aabb) -> bool {
    let above = |axis, at| {
        let sign = probe.sign(&FromLevel { plane, axis, at });
        if slope > 0 { sign } else { sign.map(Ordering::reverse) }
    };
    (0..3).all(|axis| {
        above(axis, bounds.min[axis]).is_none_or(Ordering::is_ge)
            && above(axis, bounds.max[axis]).is_none_or(Ordering::is_le)
    })
}

/// Three vertices far from being on one line, in an order in which their normal is that of the
/// first outline.
fn spanning(vertices: &[Point3], first_end: usize) -> Option<Facet> {
    let a = *vertices.first()?;
    let size = vertices.iter().map(|v| (*v - a).max_abs()).fold(0.0, f64::max);
    let k = -exponent(size);
    // All comparisons are in units of the size: any choice is correct, a good one gives tight
    // brackets.
    let from_a = |v: Point3| (v - a).scale2(k);
    let b = *vertices
        .iter()
        .max_by(|v, w| from_a(**v).length_squared().total_cmp(&from_a(**w).length_squared()))?;
    let area = |v: &Point3| from_a(b).cross(from_a(*v)).length_squared();
    let c = *vertices.iter().max_by(|v, w| area(v).total_cmp(&area(w)))?;
    if facet::is_degenerate(&[a, b, c]) {
        return None;
    }
    // The sum of the fan's normals (Newell) gives the direction.
    let newell = vertices[..first_end]
        .windows(2)
        .fold(Vec3::ZERO, |sum, edge| sum + from_a(edge[0]).cross(from_a(edge[1])));
    let n = from_a(b).cross(from_a(c));
    Some(if n.dot(newell) < 0.0 { [a, c, b] } else { [a, b, c] })
}

/// Counts windings about a line.
struct Winding<'a, L> {
    line: &'a L,
    filter: EdgeFilter,
    d: Vec3,
    /// The axis that separates above from below, and the axis along which vertices are moved onto a
    /// plane across it.
    level: usize,
    main: usize,
    /// Bounds for all vertices.
    edge_bound: f64,
    level_bound: f64,
}

/// The component of `((v - o) x d)` whose sign decides whether a vertex is above the ray, viewed
/// along it; times the sign of `d`'s main component.
struct Above {
    vertex: Point3,
    level: usize,
    main: usize,
    centre: Point3,
    scale: i32,
}

impl AlongRay for Above {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let v = planar::seen_from::<T>(self.vertex, self.centre, self.scale);
        let from_ray = |i: usize| v[i].clone() * ray.w.clone() - ray.o[i].clone();
        let (level, main) = (from_ray(self.level), from_ray(self.main));
        Some(level * ray.d[self.main].clone() - main * ray.d[self.level].clone())
    }
}

impl<'a, L: Line> Winding<'a, L> {
    #[inline(always)]
    fn new(line: &'a L) -> Self {
        let filter = EdgeFilter::new(line);
        let ray = line.running();
        let (o, d) = (Vec3::from(ray.o.map(|x| x.v)), Vec3::from(ray.d.map(|x| x.v)));
        let [a, level] = edges::displacement(d);
        // The centre lies in the bounding box, which is less than two units wide.
        let reach = o.max_abs() + 2.0;
        let (edge_bound, level_bound) = (filter.bound(reach), filter.minor_bound(reach));
        Self { line, filter, d, level, main: 3 - a - level, edge_bound, level_bound }
    }

    /// How often an outline goes around the ray.
    #[inline(always)]
    fn of(&self, outline: &[Point3]) -> i64 {
        let Some(&last) = outline.last() else { return 0 };
        let mut turns = 0;
        let mut from = (last, self.above(last));
        for &vertex in outline {
            let to = (vertex, self.above(vertex));
            if from.1 != to.1 {
                // An upward edge counts if it passes the ray on the positive side, a downward edge
                // if on the negative.
                let side = self.side(from.0, to.0);
                if to.1 && side > 0 {
                    turns += 1;
                } else if !to.1 && side < 0 {
                    turns -= 1;
                }
            }
            from = to;
        }
        turns
    }

    /// Whether a vertex is above the ray. A vertex level with the ray counts as below, as if the
    /// ray were moved up by an infinitesimal distance.
    #[inline(always)]
    fn above(&self, v: Point3) -> bool {
        let d = self.d;
        let seen = self.filter.seen(v);
        let minor = seen[self.level].mul_add(d[self.main], -(seen[self.main] * d[self.level]));
        let sign = if minor.abs() > self.level_bound { minor } else { self.exactly_above(v) };
        sign * d[self.main] > 0.0
    }

    #[cold]
    #[inline(never)]
    fn exactly_above(&self, vertex: Point3) -> f64 {
        Isa::detect().run(
            #[inline(always)]
            || {
                let (centre, scale) = self.line.view();
                let form = Above { vertex, level: self.level, main: self.main, centre, scale };
                self.line.sign(&form).map_or(0.0, |sign| f64::from(sign as i8))
            },
        )
    }

    fn side(&self, a: Point3, b: Point3) -> i8 {
        let value = self.filter.side(self.filter.seen(a), self.filter.seen(b));
        if value.abs() > self.edge_bound {
            return if value > 0.0 { 1 } else { -1 };
        }
        edges::exact_side(self.line, a, b).unwrap_or(0)
    }
}

impl Surface for Polygon {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        let plane = self.plane(&probe);
        if let Some(crossing) = probe.crossing_within(&plane, sink.range())
            && self.holds(&probe)
            && (self.margin.is_none() || within(&probe, &plane, crossing.sign, &self.bounds))
            && probe.admits(&plane, &crossing)
        {
            let _ = sink.push(probe.root(&crossing, 0, [0.0; 2]));
        }
    }

    /// Texture coordinates are lengths along two axes across the normal, from the first vertex.
    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        let probe = self.probe(ray);
        let plane = self.plane(&probe);
        let ng = facet::unit_normal(&self.plane);
        let (first, n) = plane.normal();
        let lift = -ng.dot(Vec3::from(first.map(|x: durer_math::EFloat| x.v)));
        let (p, dp) = planar::foot_point(&probe, &plane, ng.to_vec(), 1.0, lift);
        let off = planar::clearance(&plane, p, plane.centre, plane.scale, planar::least_length(n));
        let off = facet::along_rounded_normal(off);
        let mut point = SurfacePoint::new(p, dp, off, ng);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (a, b) = ng.to_vec().orthonormal_basis();
            let q = p - self.vertices[0];
            point.uv = [a.dot(q), b.dot(q)];
            (point.dpdu, point.dpdv) = (a, b);
        }
        point
    }
}

impl Accelerate for Polygon {
    fn name(&self) -> &'static str {
        "polygon"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::polygon(self.plane, self.bounds, self.outlines(), self.rule, self.margin)
    }
}

impl Algebraic for Polygon {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_through_along(self.spanning(), ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{self, Crossing, Exact, ExactLine, Feature, Oracle, Surd, TestRng, all_roots, exact3};
    use crate::{Mesh, MeshData, RootKind};
    use durer_math::Ray;

    /// Points of a plane with integer coordinates, from points of the xy plane.
    fn tilted(points: &[[f64; 2]], [a, b]: [Vec3; 2], at: Vec3) -> Vec<Point3> {
        points.iter().map(|[x, y]| (at + a * *x + b * *y).to_point()).collect()
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    const HOLE: [[f64; 2]; 4] = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
    const STAR: [[f64; 2]; 5] = [[0.0, 0.0], [4.0, 3.0], [-1.0, 3.0], [3.0, 0.0], [1.0, 5.0]];
    const COMB: [[f64; 2]; 8] =
        [[0.0, 0.0], [6.0, 0.0], [6.0, 3.0], [4.0, 1.0], [3.0, 3.0], [2.0, 1.0], [1.0, 3.0], [0.0, 1.0]];

    /// Crossings of a half-line in the plane's own (exact) coordinates. Shares no code with the
    /// kernel.
    struct ExactPolygon {
        /// Each outline's vertices by `(x, y)`.
        outlines: Vec<Vec<[f64; 2]>>,
        rule: FillRule,
        axes: [Vec3; 2],
        at: Vec3,
        flip: bool,
    }

    impl ExactPolygon {
        fn normal(&self) -> [Exact; 3] {
            let n = exact3(self.axes[0].cross(self.axes[1]).to_array());
            if self.flip { n.map(|x| -x) } else { n }
        }

        fn by(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
            &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
        }

        fn above(&self, p: &[Exact; 3]) -> Exact {
            let at = exact3(self.at.to_array());
            Self::by(&self.normal(), &[0, 1, 2].map(|i| &p[i] - &at[i]))
        }

        /// The winding number at a point of the plane, `(x, y)` times `w > 0`; `None` on an
        /// outline.
        fn winding(&self, x: &Exact, y: &Exact, w: &Exact) -> Option<i64> {
            let mut turns = 0;
            for outline in &self.outlines {
                for (i, q) in outline.iter().enumerate() {
                    let p = outline[(i + outline.len() - 1) % outline.len()];
                    let scaled = |v: f64| &Exact::from(v) * w;
                    let (px, py) = (&scaled(p[0]) - x, &scaled(p[1]) - y);
                    let (qx, qy) = (&scaled(q[0]) - x, &scaled(q[1]) - y);
                    let cross = (&(&px * &qy) - &(&py * &qx)).sign();
                    let inner = (&(&px * &qx) + &(&py * &qy)).sign();
                    if cross.is_eq() && inner.is_le() {
                        return None;
                    }
                    let (up, down) =
                        (py.sign().is_le() && qy.sign().is_gt(), py.sign().is_gt() && qy.sign().is_le());
                    turns += i64::from(up && cross.is_gt()) - i64::from(down && cross.is_lt());
                }
            }
            Some(turns)
        }

        /// Whether the line meets the polygon; `None` if it meets an outline.
        fn holds(&self, line: &ExactLine) -> Option<bool> {
            let slope = Self::by(&self.normal(), &line.d);
            let height = self.above(&line.o);
            // slope * (o - at) - height * d, then by Cramer's rule along the axes, which are
            // perpendicular here.
            let at = exact3(self.at.to_array());
            let p = [0, 1, 2].map(|i| &(&(&line.o[i] - &at[i]) * &slope) - &(&line.d[i] * &height));
            let axes = self.axes.map(|a| exact3(a.to_array()));
            let n = |a: &[Exact; 3]| Self::by(a, a);
            let (mut x, mut y) =
                (&Self::by(&p, &axes[0]) * &n(&axes[1]), &Self::by(&p, &axes[1]) * &n(&axes[0]));
            let mut w = &(&slope * &n(&axes[0])) * &n(&axes[1]);
            if w.sign().is_lt() {
                (x, y, w) = (-x, -y, -w);
            }
            let turns = self.winding(&x, &y, &w)?;
            Some(if self.rule == FillRule::EvenOdd { turns % 2 != 0 } else { turns != 0 })
        }
    }

    impl Oracle for ExactPolygon {
        fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
            let slope = Self::by(&self.normal(), &line.d);
            if slope.sign().is_eq() || self.holds(line) != Some(true) {
                return vec![];
            }
            let t = Surd::ratio(-self.above(&line.o), slope.clone());
            vec![Crossing { t, sign: slope.sign() as i8, grazing: false }]
        }

        fn face_side(&self, _face: u32, point: &[Exact; 3]) -> Ordering {
            self.above(point).sign()
        }

        fn face_normal(&self, _face: u32, _point: &[Exact; 3]) -> Vec3 {
            Vec3::from(self.normal().map(|x| x.to_f64()))
        }

        fn side(&self, _point: &[Exact; 3]) -> Option<Ordering> {
            None
        }

        fn size(&self) -> f64 {
            self.axes[0].max_abs().max(self.axes[1].max_abs()) * 2.0
        }

        fn is_convex(&self) -> bool {
            false
        }
    }

    const AXES: [[[f64; 3]; 2]; 3] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[2.0, 1.0, -2.0], [2.0, -2.0, 1.0]],
        [[0.0, -4.0, 3.0], [5.0, 0.0, 0.0]],
    ];

    fn cases() -> Vec<(Polygon, ExactPolygon)> {
        let mut out = vec![];
        let sets: [&[&[[f64; 2]]]; 4] = [&[&SQUARE, &HOLE], &[&STAR], &[&COMB], &[&SQUARE, &STAR]];
        for (i, set) in sets.into_iter().enumerate() {
            for (j, axes) in AXES.iter().enumerate() {
                for rule in [FillRule::EvenOdd, FillRule::NonZero] {
                    let axes = axes.map(Vec3::from);
                    let at = Vec3::new(i as f64, -3.0, 7.0 * j as f64);
                    let outlines: Vec<_> = set.iter().map(|o| tilted(o, axes, at)).collect();
                    let polygon = Polygon::new(&outlines, rule).unwrap();
                    assert!(polygon.margin.is_none());
                    let n = facet::unit_normal(&polygon.plane);
                    let flip = n.dot(axes[0].cross(axes[1])) < 0.0;
                    let outlines = set.iter().map(|o| o.to_vec()).collect();
                    out.push((polygon, ExactPolygon { outlines, rule, axes, at, flip }));
                }
            }
        }
        out
    }

    #[test]
    fn polygons_obey_the_laws_off_their_outlines() {
        let (mut rays, mut roots) = (0, 0);
        for (seed, (polygon, oracle)) in cases().iter().enumerate() {
            // Points beside the vertices and edges by few-bit distances, by one ulp, by any
            // distance.
            let mut features = vec![];
            for v in &polygon.vertices {
                for off in [[0.25, 0.5], [-0.5, 0.25], [1.0 / 1024.0, -1.0 / 4096.0]] {
                    let p = *v + oracle.axes[0] * off[0] + oracle.axes[1] * off[1];
                    features.push(Feature { point: p, direction: oracle.axes[0].cross(oracle.axes[1]) });
                    features.push(Feature { point: p, direction: Vec3::new(1.0, 2.0, -3.0) });
                }
            }
            for i in laws::drawn(150) {
                let ray = laws::aim(&mut laws::dice(seed as u64, i), &features, oracle.size());
                // The next test covers rays that meet an outline exactly.
                if ray.is_valid() && oracle.holds(&ExactLine::new(&ray)).is_some() {
                    let met = laws::check(polygon, oracle, &ray);
                    roots += met.unwrap_or_else(|e| panic!("{e}\n{seed} {i} {ray:?}\n{polygon:?}")).len();
                    rays += 1;
                }
            }
        }
        assert!(rays > 2500 && roots > 500, "{rays} {roots}");
        laws::report(rays);
    }

    #[test]
    fn polygons_are_watertight_against_triangles_and_each_other() {
        // A square with a square hole, the hole filled by two triangles, the rest around it filled
        // by another polygon.
        for axes in AXES {
            let axes = axes.map(Vec3::from);
            let at = Vec3::new(1.0, 2.0, 3.0);
            let frame =
                Polygon::new(&[tilted(&SQUARE, axes, at), tilted(&HOLE, axes, at)], FillRule::EvenOdd)
                    .unwrap();
            let plug = Mesh::new(MeshData {
                vertices: tilted(&HOLE, axes, at),
                faces: vec![[0, 1, 2], [0, 2, 3]],
                ..MeshData::default()
            })
            .unwrap();
            let outer = [[-2.0, -2.0], [6.0, -2.0], [6.0, 6.0], [-2.0, 6.0]];
            let around =
                Polygon::new(&[tilted(&outer, axes, at), tilted(&SQUARE, axes, at)], FillRule::EvenOdd)
                    .unwrap();
            let mut dice = TestRng::new(9);
            let mut on_edges = 0;
            for _ in 0..4000 {
                let (x, y) = (dice.integer(-1, 5), dice.integer(-1, 5));
                let (x, y) = if dice.once_in(3) { (x, dice.between(-1.0, 5.0)) } else { (x, y) };
                let direction = dice.lattice(3);
                let origin = (at + axes[0] * x + axes[1] * y).to_point() - direction * 5.0;
                let ray = Ray::new(origin, direction);
                if axes[0].cross(axes[1]).dot(direction) == 0.0 {
                    continue;
                }
                // A mesh touches the lines through its border, a polygon crosses them or not.
                let plugged = all_roots(&plug, &ray);
                let touches = plugged.iter().filter(|root| root.kind == RootKind::Grazing).count();
                let crossings =
                    all_roots(&frame, &ray).len() + all_roots(&around, &ray).len() + plugged.len() - touches;
                let is_on_border = [x, y].iter().all(|c| (1.0..=3.0).contains(c))
                    && [x, y].iter().any(|c| *c == 1.0 || *c == 3.0);
                // Where `y` has many digits, the rounded ray may pass beside the edge.
                let is_exact = y.fract() == 0.0;
                assert!(
                    touches == usize::from(is_on_border) || is_on_border && !is_exact && touches == 0,
                    "{touches} at ({x}, {y}) along {direction:?}"
                );
                assert!(
                    crossings == 1 || crossings == 0 && touches == 1,
                    "{crossings} at ({x}, {y}) along {direction:?}"
                );
                on_edges += u32::from([0.0, 1.0, 3.0, 4.0].contains(&x));
            }
            assert!(on_edges > 1000);
        }
    }

    #[test]
    fn vertices_off_the_plane_are_refused_unless_by_rounding() {
        let with = |z: f64| {
            Polygon::new(
                &[[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, z], [0.0, 1.0, 0.0]].map(Point3::from)],
                FillRule::EvenOdd,
            )
        };
        assert!(with(1e-9).is_ok_and(|p| p.margin.is_some()));
        assert!(matches!(with(1e-3), Err(PolygonError::NotPlanar { .. })));
        // A ray that skims the plane meets it within the bounds or not at all.
        let polygon = with(1e-9).unwrap();
        for slope in [1e-6, 1e-8, 1e-9, 1e-10, 1e-12] {
            for y in [0.25, 0.5, 0.75] {
                let ray = Ray::new(Point3::new(-3.0, y, 1e-9), Vec3::new(1.0, 0.0, -slope));
                for root in all_roots(&polygon, &ray) {
                    let x = root.t - 3.0;
                    assert!((-1e-7..=1.0 + 1e-7).contains(&x), "{root:?}");
                }
            }
        }
    }

    #[test]
    fn bad_polygons_are_named() {
        let none: [Vec<Point3>; 0] = [];
        assert_eq!(Polygon::new(&none, FillRule::EvenOdd), Err(PolygonError::Empty));
        let line = [[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]].map(Point3::from);
        assert_eq!(Polygon::new(&[line], FillRule::EvenOdd), Err(PolygonError::Degenerate));
        assert_eq!(
            Polygon::new(&[&line[..2]], FillRule::EvenOdd),
            Err(PolygonError::TooShort { outline: 0, len: 2 })
        );
    }
}
