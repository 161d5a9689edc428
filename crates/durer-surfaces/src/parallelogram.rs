//! The parallelogram: a flat sheet spanned by two vectors.
//!
//! ```text
//!         ┌─────────────┐
//!      v ╱             ╱        p = c + a u + b v,   0 <= a <= 1,  0 <= b <= 1
//!       └─────────────┘         n = u x v
//!      c       u
//! ```
//!
//! With `q = o - c` Cramer's rule gives `a = q . (v x d) / (n . d)` and
//! `b = q . (d x u) / (n . d)`; whether they lie in `[0, 1]` is the sign of four polynomials,
//! decided exactly. The sheet is closed: its edges belong to it.

use crate::compose::clip::Algebraic;
use crate::edges::EdgeFilter;
use crate::facet;
use crate::packet::FilterSource;
use crate::planar::{self, AlongRay, Line, PlaneForm, Probe, Ratios, cross, dot, seen_from};
use crate::{Accelerate, CentredRay, LocalRay, Need, PartId, RingRay, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use durer_math::eft::scale2;
use durer_math::{Aabb, Dyadic, EFloat, Point3, Ring, U, Vec3};
use durer_roots::quadratic::Quadratic;

/// The sheet `corner + a u + b v` with `a` and `b` in `[0, 1]`. A root's tag is `(a, b)`, and so
/// are the texture coordinates.
///
/// # Invariants
///
/// Corner and edges are finite, and the edges are not parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelogram {
    corner: Point3,
    u: Vec3,
    v: Vec3,
}

/// Why a [`Parallelogram`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ParallelogramError {
    /// The corner is infinite or NaN.
    #[error("parallelogram: the corner must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Corner(Point3),
    /// An edge is infinite or NaN.
    #[error("parallelogram: an edge must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Edge(Vec3),
    /// The edges are parallel, or one of them is zero.
    #[error("parallelogram: the edges must not be parallel")]
    Parallel,
}

impl Parallelogram {
    /// The parallelogram with one vertex at `corner` and the edges `u` and `v` from there.
    pub fn new(corner: Point3, u: Vec3, v: Vec3) -> Result<Self, ParallelogramError> {
        if !corner.is_finite() {
            return Err(ParallelogramError::Corner(corner));
        }
        if let Some(edge) = [u, v].into_iter().find(|e| !e.is_finite()) {
            return Err(ParallelogramError::Edge(edge));
        }
        if facet::is_degenerate(&[Point3::ORIGIN, u.to_point(), v.to_point()]) {
            return Err(ParallelogramError::Parallel);
        }
        Ok(Self { corner, u, v })
    }

    /// The corner from which the edges start.
    pub fn corner(&self) -> Point3 {
        self.corner
    }

    /// The edges.
    #[inline(always)]
    pub fn edges(&self) -> [Vec3; 2] {
        [self.u, self.v]
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        let half = (self.u.abs() + self.v.abs()) * 0.5;
        Probe::new(ray, self.corner + (self.u + self.v) * 0.5, half.max_abs())
    }

    /// The sides on which the ray passes the four edges, in f64.
    #[inline(always)]
    fn quick(&self, probe: &Probe<'_>) -> Quick {
        let filter = EdgeFilter::new(probe);
        let far = self.corner + self.u;
        let corners = [self.corner, far, far + self.v, self.corner + self.v];
        let [a, b, c, d] = corners.map(|p| filter.seen(p));
        // A corner takes at most two roundings.
        let size = (self.corner.to_vec().abs() + self.u.abs() + self.v.abs()).max_abs() * (2.0 * U);
        let reach = a.max_abs().max(b.max_abs()).max(c.max_abs()).max(d.max_abs());
        let bound = filter.bound_about(reach, scale2(size, -probe.ray.scale) * (1.0 + 8.0 * U));
        let sides = [filter.side(a, b), filter.side(b, c), filter.side(c, d), filter.side(d, a)];
        let least = sides[0].min(sides[1]).min(sides[2]).min(sides[3]);
        let most = sides[0].max(sides[1]).max(sides[2]).max(sides[3]);
        if least < -bound && most > bound {
            return Quick::Miss;
        }
        if least > bound || most < -bound {
            // The distances from opposite sides have the same sum; a third side of zero changes
            // nothing.
            let part = |near: f64, far: f64| facet::quotients([far, near, 0.0], bound);
            return Quick::Through(
                part(sides[3], sides[1]).zip(part(sides[0], sides[2])).map(|(u, v)| [u[0], v[0]]),
            );
        }
        Quick::Unsure
    }

    #[inline(always)]
    fn spanned<'a>(&'a self, probe: &Probe<'_>) -> Spanned<'a> {
        Spanned { sheet: self, centre: probe.ray.centre, scale: probe.ray.scale }
    }
}

/// The result of the filter.
enum Quick {
    /// The ray misses the sheet.
    Miss,
    /// The line meets the sheet, at these coordinates if they are precise enough.
    Through(Option<[EFloat; 2]>),
    /// Too close to an edge, or edge-on: must be decided exactly.
    Unsure,
}

/// The parallelogram relative to a centre.
struct Spanned<'a> {
    sheet: &'a Parallelogram,
    centre: Point3,
    scale: i32,
}

impl Spanned<'_> {
    /// `u` and `v` in units of `2^scale`.
    #[inline(always)]
    fn edges<T: Ring>(&self) -> [[T; 3]; 2] {
        [self.sheet.u, self.sheet.v].map(|e| e.to_array().map(|x| T::exact(x).scale2(-self.scale)))
    }

    #[inline(always)]
    fn normal<T: Ring>(&self) -> [T; 3] {
        let [u, v] = self.edges();
        cross(&u, &v)
    }

    /// The ray's origin relative to the corner.
    #[inline(always)]
    fn relative_origin<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let [x, y, z] = seen_from::<T>(self.sheet.corner, self.centre, self.scale).map(|x| x * ray.w.clone());
        let [a, b, c] = ray.o.clone();
        [a - x, b - y, c - z]
    }
}

impl PlaneForm for Spanned<'_> {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<planar::Quick> {
        let [u, v] = [self.sheet.u, self.sheet.v].map(|e| e.map(|x| scale2(x, -self.scale)));
        let n = planar::cross_and_error(u, v);
        Some(planar::Quick::new(n, planar::origin_from(ray, self.sheet.corner), (0.0, 0.0), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        dot(&self.normal(), &ray.d)
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(dot(&self.normal(), &self.relative_origin(ray)))
    }
}

impl Ratios for Spanned<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let ([u, v], q) = (self.edges(), self.relative_origin(ray));
        [dot(&q, &cross(&v, &ray.d)), dot(&q, &cross(&ray.d, &u)), self.slope(ray) * ray.w.clone()]
    }
}

/// How far the crossing is from one of the four edges, times the slope: `a`, `b`, `a - 1`, `b - 1`.
struct FromEdge<'a> {
    spanned: &'a Spanned<'a>,
    which: usize,
    far: bool,
}

impl AlongRay for FromEdge<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let [a, b, whole] = self.spanned.eval(ray);
        let part = if self.which == 0 { a } else { b };
        Some(if self.far { part - whole } else { part })
    }
}

/// Whether the crossing lies between two opposite edges. An inexact ray that cannot be excluded
/// counts as between.
#[inline(always)]
fn between(probe: &Probe<'_>, spanned: &Spanned<'_>, which: usize, slope: i8) -> bool {
    let along = |far| {
        let sign = probe.sign(&FromEdge { spanned, which, far });
        if slope > 0 { sign } else { sign.map(Ordering::reverse) }
    };
    along(false).is_none_or(Ordering::is_ge) && along(true).is_none_or(Ordering::is_le)
}

impl Surface for Parallelogram {
    fn bounds(&self) -> Aabb {
        // One coordinate at a time: the corner plus the negative, or the positive, parts of the
        // edges.
        let part = |clip: fn(f64) -> f64| self.u.map(clip) + self.v.map(clip);
        let low = part(|x| x.min(0.0)).map(f64::next_down);
        let high = part(|x| x.max(0.0)).map(f64::next_up);
        Aabb::new((self.corner + low).map(f64::next_down), (self.corner + high).map(f64::next_up))
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        let spanned = self.spanned(&probe);
        let (certain, tag) = match self.quick(&probe) {
            Quick::Miss => return,
            Quick::Through(tag) => (true, tag),
            Quick::Unsure => (false, None),
        };
        let Some(crossing) = probe.crossing_within(&spanned, sink.range()) else { return };
        let inside = certain || (0..2).all(|which| between(&probe, &spanned, which, crossing.sign));
        if inside && probe.admits(&spanned, &crossing) {
            let tag = tag.unwrap_or_else(|| planar::ratios(&probe, &spanned)).map(|x| x.v.clamp(0.0, 1.0));
            let _ = sink.push(probe.root(&crossing, 0, tag));
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        let probe = self.probe(ray);
        let spanned = self.spanned(&probe);
        let ng = facet::unit_normal(&[Point3::ORIGIN, self.u.to_point(), self.v.to_point()]);
        let b = match self.quick(&probe) {
            Quick::Through(Some(b)) => b,
            _ => planar::ratios(&probe, &spanned),
        };
        let mut point = facet::settle(self.corner, [self.u, self.v], b, ng);
        if need.contains(Need::UV) {
            point.uv = b.map(|b| b.v.clamp(0.0, 1.0));
        }
        if need.contains(Need::DERIVATIVES) {
            (point.dpdu, point.dpdv) = (self.u, self.v);
        }
        point
    }
}

impl Accelerate for Parallelogram {
    fn name(&self) -> &'static str {
        "parallelogram"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::parallelogram(self.corner, self.u, self.v)
    }
}

impl Algebraic for Parallelogram {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let [u, v] = self.edges().map(planar::exact3);
        planar::plane_along(&cross(&u, &v), self.corner(), ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{ExactBody, ExactForm, Feature, TestRng, check_many, exact3};

    /// `a x b`, exact for numbers with few bits.
    fn across(a: Vec3, b: Vec3) -> Vec3 {
        a.cross(b)
    }

    /// The plane, and four half-spaces across it along the edges.
    fn exact(p: &Parallelogram) -> ExactBody {
        let n = across(p.u, p.v);
        let half = |n: Vec3, at: Point3| ExactForm::half_space(exact3(n.to_array()), exact3(at.to_array()));
        let far = p.corner + p.u + p.v;
        let (left, front) = (across(n, p.v), across(p.u, n));
        let faces = vec![
            half(n, p.corner),
            half(left, p.corner),
            half(-left, far),
            half(front, p.corner),
            half(-front, far),
        ];
        ExactBody { faces, walls: 1, size: p.u.abs().max_abs().max(p.v.max_abs()), convex: false }
    }

    #[test]
    fn parallelograms_obey_the_laws() {
        let mut roots = 0;
        for seed in 0..40 {
            let mut dice = TestRng::new(seed);
            let unit = dice.power(-60, 60);
            let (corner, u, v) = (dice.lattice(20), dice.lattice(4), dice.lattice(4));
            let Ok(p) = Parallelogram::new((corner * unit).to_point(), u * unit, v * unit) else { continue };
            let mut features = vec![];
            for (a, b) in
                [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.0), (1.0, 0.25), (0.5, 0.5)]
            {
                for direction in [p.u, p.v, p.u + p.v, across(u, v) * unit] {
                    features.push(Feature { point: p.corner + p.u * a + p.v * b, direction });
                }
            }
            roots += check_many(&p, &exact(&p), &features, seed, 300).roots;
        }
        assert!(roots > 2000, "{roots}");
    }

    #[test]
    fn parallel_edges_are_refused() {
        let made = Parallelogram::new(Point3::ORIGIN, Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.2, 0.4, 0.6));
        assert_eq!(made, Err(ParallelogramError::Parallel));
    }
}
