//! The prism: an outline in the xz plane, swept along y, or towards a point.
//!
//! ```text
//!       linear                conic
//!      ┌──────┐ top         ┌──────┐ top
//!     ╱|     ╱|              ╲    ╱          a point <x, z> of the outline sweeps
//!    ┌──────┐ |               ╲  ╱           <x, y, z>       (linear)
//!    | └────|-┘ bottom         ╲╱  apex      <x y, y, z y>   (conic)
//!    └──────┘                                for bottom <= y <= top
//! ```
//!
//! A point is inside where the outlines go round it an odd number of times. All faces are flat: two
//! triangles for each edge form the walls, and two polygons with the walls' own corners form the
//! caps. Triangles and polygons share one rule for rays that meet an edge or a corner exactly (see
//! `edges.rs`). So the solid is closed: every line crosses it an even number of times. The corners
//! of a conic sweep are products rounded to f64; the rounded corners define the exact solid.
//!
//! J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", SIGGRAPH 1983,
//! sweeps curves; straight edges need no equation other than that of a plane.

pub mod curved;
mod outline;
mod packet;
mod straight_path;

pub use straight_path::{StraightPath, StraightPathError};

use self::packet::{ProfileCurve8, Sweep8, Swept};
use crate::compose::clip::Algebraic;
use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::mesh::{Sorted, may_hold};
use crate::packet::FilterSource;
use crate::planar::{self, AlongRay, Crossing, Line, PlaneForm, PointLine, Probe, ThreePoints};
use crate::{
    Accelerate, FillRule, LocalPoint, LocalRay, Need, PartId, Polygon, PolygonError, RingRay, Root, Side,
    Sink, Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, Point3, Ring, U, Vec3};
use durer_roots::quadratic::{self, Quadratic, exact_sign, sign_at_root};
use outline::Point;

/// A solid between two planes across y, within outlines that are swept from one to the other;
/// without its caps a sheet.
///
/// Faces: 0 the walls, 1 the cap at the bottom, 2 the cap at the top. A root's tag is the number of
/// the wall's triangle. Parts: the walls of the edges, then the caps, so that a ray tests only the
/// parts that it comes near. A tangled prism is one part, since its signs alternate along the whole
/// line.
///
/// # Invariants
///
/// The walls and both caps together are closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    walls: Vec<Wall>,
    caps: Vec<Cap>,
    /// Whether the outlines cross or touch themselves or each other, so that an edge may have the
    /// inside on either side.
    tangled: bool,
    open: bool,
    sweep: Sweep,
    bounds: Aabb,
}

/// A triangle of a wall; unless the outlines are tangled its normal points outward.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wall {
    facet: Facet,
    /// The edges from the bottom to the top at both ends of the wall to which the triangle belongs.
    ribs: [[Point3; 2]; 2],
    uv: [[f64; 2]; 3],
}

#[derive(Clone, Debug, PartialEq)]
struct Cap {
    polygon: Polygon,
    /// Whether the polygon's normal points inward.
    turned: bool,
    /// 1 at the bottom, 2 at the top.
    face: u32,
}

/// Why a [`Prism`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PrismError {
    /// There is no outline.
    #[error("prism: there is no outline")]
    Empty,
    /// An outline has fewer than three different points.
    #[error("prism: outline {outline} has {len} different points, it needs 3 at least")]
    TooShort {
        /// The outline, from 0.
        outline: usize,
        /// Its number of points.
        len: usize,
    },
    /// A piece of a curved outline does not end where the next one, or the first one, begins.
    #[error("prism: piece {piece} of outline {outline} does not end where the next one begins")]
    Gap {
        /// The outline, from 0.
        outline: usize,
        /// The piece, from 0.
        piece: usize,
    },
    /// A point is infinite or NaN.
    #[error("prism: a point of the outline must be finite, got <{x}, {z}>")]
    Point {
        /// Its x.
        x: f64,
        /// Its z.
        z: f64,
    },
    /// The heights are not finite, or equal.
    #[error("prism: the heights must be finite and different, got {0} and {1}")]
    Heights(f64, f64),
    /// A corner of a conic sweep is beyond the range of f64.
    #[error("prism: at the height {0:?} the outline is too large for the range of f64")]
    TooLarge(f64),
    /// A cap cannot exist.
    #[error("prism: all points of the outline lie on one line")]
    Flat,
}

/// How the outline changes with the height.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sweep {
    Linear,
    Conic,
}

impl Sweep {
    /// The position of a point of the outline at the height `y`.
    fn at(self, [x, z]: Point, y: f64) -> Point3 {
        match self {
            Self::Linear => Point3::new(x, y, z),
            Self::Conic => Point3::new(x * y, y, z * y),
        }
    }

    /// How many triangles of a wall form one part: both if they lie exactly in one plane.
    fn together(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::Conic => 1,
        }
    }
}

/// The heights of a sweep in order.
fn ascending(bottom: f64, top: f64) -> Result<(f64, f64), PrismError> {
    let (low, high) = (bottom.min(top), bottom.max(top));
    let fits = bottom.is_finite() && top.is_finite() && low < high && (high - low).is_finite();
    if fits { Ok((low, high)) } else { Err(PrismError::Heights(bottom, top)) }
}

/// A part of a prism.
enum PrismPart<'a> {
    /// Triangles, and the number of the first one.
    Walls(&'a [Wall], usize),
    Cap(&'a Cap),
}

impl Prism {
    /// The prism between the heights `bottom` and `top` (in any order) within these outlines,
    /// `[x, z]` each. An outline is closed automatically; a last point equal to the first is
    /// dropped.
    pub fn linear(outlines: &[impl AsRef<[Point]>], bottom: f64, top: f64) -> Result<Self, PrismError> {
        Self::new(outlines, bottom, top, Sweep::Linear)
    }

    /// The conic prism, whose outlines at the height `y` are `y` times as large: a pyramid with its
    /// apex at the origin, the part of one between the heights, or two that meet.
    pub fn conic(outlines: &[impl AsRef<[Point]>], bottom: f64, top: f64) -> Result<Self, PrismError> {
        Self::new(outlines, bottom, top, Sweep::Conic)
    }

    fn new(
        outlines: &[impl AsRef<[Point]>],
        bottom: f64,
        top: f64,
        sweep: Sweep,
    ) -> Result<Self, PrismError> {
        let (low, high) = ascending(bottom, top)?;
        let outlines = outline::cleaned(outlines)?;
        let edges = outline::edges(&outlines);
        let inside_is_left = outline::inside_is_left(&edges);
        let levels = if sweep == Sweep::Conic && low < 0.0 && high > 0.0 {
            vec![[low, 0.0], [0.0, high]]
        } else {
            vec![[low, high]]
        };
        let mut walls = Vec::with_capacity(2 * levels.len() * edges.len());
        for [y0, y1] in levels {
            for (i, &[a, b]) in edges.iter().enumerate() {
                let left = inside_is_left.as_ref().is_none_or(|left| left[i]);
                let (a, b) = if left { (a, b) } else { (b, a) };
                let [a0, a1] = [y0, y1].map(|y| sweep.at(a, y));
                let [b0, b1] = [y0, y1].map(|y| sweep.at(b, y));
                let u = [i as f64 / edges.len() as f64, (i + 1) as f64 / edges.len() as f64];
                let [ua, ub] = if left { u } else { [u[1], u[0]] };
                let v = [y0, y1].map(|y| (y - low) / (high - low));
                let ribs = [[a0, a1], [b0, b1]];
                walls.push(Wall { ribs, facet: [a0, b1, b0], uv: [[ua, v[0]], [ub, v[1]], [ub, v[0]]] });
                walls.push(Wall { ribs, facet: [a0, a1, b1], uv: [[ua, v[0]], [ua, v[1]], [ub, v[1]]] });
            }
        }
        let bounds = Aabb::from_points(walls.iter().flat_map(|w| w.facet));
        if !bounds.is_bounded() || !bounds.widths().is_finite() {
            return Err(PrismError::TooLarge(if low.abs() > high.abs() { low } else { high }));
        }
        // Triangles without area meet no ray: two of three corners may be at an apex.
        walls.retain(|w| !facet::is_degenerate(&w.facet));
        let mut caps = Vec::with_capacity(2);
        for (y, face) in [(low, 1), (high, 2)] {
            if sweep == Sweep::Conic && y == 0.0 {
                continue;
            }
            let swept: Vec<Vec<Point3>> =
                outlines.iter().map(|points| points.iter().map(|&p| sweep.at(p, y)).collect()).collect();
            let polygon = Polygon::new(&swept, FillRule::EvenOdd).map_err(|e| match e {
                PolygonError::TooMany(_) => PrismError::TooLarge(y),
                _ => PrismError::Flat,
            })?;
            let up = facet::unit_normal(&polygon.spanning()).y > 0.0;
            caps.push(Cap { polygon, turned: up != (face == 2), face });
        }
        Ok(Self { walls, caps, tangled: inside_is_left.is_none(), open: false, sweep, bounds })
    }

    /// The walls alone.
    #[must_use]
    pub fn without_caps(mut self) -> Self {
        self.open = true;
        self
    }

    #[inline(always)]
    fn view(&self) -> (Point3, f64) {
        planar::middle(&self.bounds)
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        let (centre, size) = self.view();
        Probe::new(ray, centre, size)
    }

    /// Three points of the plane of a root's face.
    pub(crate) fn plane_of(&self, root: &Root) -> Option<Facet> {
        match root.face {
            0 => self.walls.get(root.tag[0] as usize).map(|w| w.facet),
            face => self.caps.iter().find(|c| c.face == face).map(|c| c.polygon.spanning()),
        }
    }

    fn part(&self, PartId(part): PartId) -> Option<PrismPart<'_>> {
        let (part, together) = (part as usize, self.sweep.together());
        let walls = self.walls.len() / together;
        match part.checked_sub(walls) {
            None => {
                let first = part * together;
                Some(PrismPart::Walls(&self.walls[first..first + together], first))
            }
            Some(cap) => self.caps.get(cap).map(PrismPart::Cap),
        }
    }

    /// The packet filter of the whole prism, with its edges as curves. `None` if triangles that are
    /// parts by themselves would have to be distinguished, or if the rounding of corners is too
    /// large.
    fn whole_for_lanes(&self) -> Option<FilterSource> {
        let [low, high] = [self.bounds.min.y, self.bounds.max.y];
        let conic = self.sweep == Sweep::Conic;
        // With an apex each wall is one triangle; otherwise the walls of a conic sweep are two.
        let apex = low == 0.0 || high == 0.0;
        let steep = low.abs().max(high.abs()) > 64.0 * low.abs().min(high.abs());
        let told = if self.tangled { !steep && low * high > 0.0 } else { apex };
        if self.open || conic && !told {
            return None;
        }
        let each = if conic && apex { 1 } else { 2 };
        let (centre, size) = if conic { (Point3::ORIGIN, self.bounds.magnitude()) } else { self.view() };
        let scale = exponent(size) + 1;
        let seen = |p: Point3| {
            if conic {
                [p.x / p.y, p.z / p.y]
            } else {
                [scale2(p.x - centre.x, -scale), scale2(p.z - centre.z, -scale)]
            }
        };
        let outer = |[a, b]: [Point3; 2]| if a.y.abs() > b.y.abs() { a } else { b };
        let edges = self.walls.chunks(each).map(|wall| wall[0].ribs.map(|rib| seen(outer(rib))));
        let reach =
            |e: &[Point; 2]| e.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs())) * (1.0 + 4.0 * U);
        let curve = |e: [Point; 2]| {
            let [a, b] = e;
            let along = |k: usize| {
                let step = (b[k] - a[k]) * (1.0 / 3.0);
                [a[k], a[k] + step, b[k] - step, b[k]]
            };
            // Each corner is rounded by U of its size at each height, and the triangles lie between
            // them; here it is divided, and a third of the edge rounds by 4 U.
            ProfileCurve8::new([along(0), along(1)], reach(&e) * (8.0 * U), reach(&e) * (1.0 + 8.0 * U))
        };
        let curves: Box<[ProfileCurve8]> = edges.map(curve).collect();
        // Walls are oriented so that the inside is to their left.
        let left = (!self.tangled).then(|| vec![true; curves.len()].into());
        let [low, high] = [low, high].map(|y| scale2(y - centre.y, -scale));
        let sweep = Sweep8 { conic, low, high };
        Some(FilterSource::kernel(
            self.bounds,
            Swept::Whole { curves, sweep, left },
            centre,
            scale,
            [0, 1, 2],
        ))
    }

    /// Calls `f` for every crossing of the line with a face, in no order: the crossing, its plane,
    /// its face and tag, and whether the sign is to be reversed.
    #[inline(always)]
    fn each_crossing(&self, probe: &Probe<'_>, mut f: impl FnMut(Crossing, ThreePoints, u32, f64, bool)) {
        self.wall_crossings(probe, (&self.walls, 0), &mut f);
        for cap in &self.caps {
            cap_crossing(probe, cap, &mut f);
        }
    }

    /// Crossings with some triangles of the walls; `first` is the number of the first one.
    #[inline(always)]
    fn wall_crossings(
        &self,
        probe: &Probe<'_>,
        (walls, first): (&[Wall], usize),
        f: &mut impl FnMut(Crossing, ThreePoints, u32, f64, bool),
    ) {
        let filter = EdgeFilter::new(probe);
        // The prism lies within one unit of its centre.
        let bound = filter.bound(probe.ray.o.max_abs() + 2.0);
        // Neighbours share ribs: the last two are kept.
        let mut known = [([Point3::ORIGIN; 2], 0.0); 2];
        for (i, wall) in walls.iter().enumerate() {
            let sides = wall.ribs.map(|rib| match known.iter().find(|k| k.0 == rib) {
                Some(known) => known.1,
                None => filter.side(filter.seen(rib[0]), filter.seen(rib[1])),
            });
            known = [(wall.ribs[0], sides[0]), (wall.ribs[1], sides[1])];
            // A ray that certainly passes both ribs on the same side misses the wall.
            if sides[0] > bound && sides[1] > bound || sides[0] < -bound && sides[1] < -bound {
                continue;
            }
            if facet::passes(probe, &filter, &wall.facet).is_some() {
                let plane = facet::plane(probe, &wall.facet);
                if let Some(crossing) = probe.crossing(&plane) {
                    f(crossing, plane, 0, (first + i) as f64, false);
                }
            }
        }
    }
}

/// The crossing with a cap.
#[inline(always)]
fn cap_crossing(probe: &Probe<'_>, cap: &Cap, f: &mut impl FnMut(Crossing, ThreePoints, u32, f64, bool)) {
    let plane = cap.polygon.plane(probe);
    let Some(crossing) = probe.crossing(&plane) else { return };
    // The prism lies within one unit of its centre: farther crossings do not need the outline.
    let (at, err) = probe.place(&crossing);
    if at.max_abs() <= 1.0 + err.max_abs() && cap.polygon.holds(probe) {
        f(crossing, plane, cap.face, 0.0, cap.turned);
    }
}

/// Heights `h` and slopes `g` of two planes along a ray: `g₁ h₂ - g₂ h₁`.
struct Apart<'a>(&'a ThreePoints, &'a ThreePoints);

impl AlongRay for Apart<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let Self(p, q) = self;
        Some(p.slope(ray) * q.height(ray)? - q.slope(ray) * p.height(ray)?)
    }
}

/// The order of two crossings `s = -h / g`: equal if they are at one point, or if the ray is not
/// exactly known.
#[cold]
#[inline(never)]
fn order(
    probe: &Probe<'_>,
    (a, p): (&Crossing, &ThreePoints),
    (b, q): (&Crossing, &ThreePoints),
) -> Ordering {
    let apart = probe.sign(&Apart(p, q)).unwrap_or(Ordering::Equal);
    if a.sign == b.sign { apart } else { apart.reverse() }
}

/// A root, before it is known whether it lies in the range.
fn root(probe: &Probe<'_>, crossing: &Crossing, face: u32, wall: f64, turned: bool) -> Root {
    let root = probe.root(crossing, face, [wall, f64::from(u8::from(turned))]);
    Root { sign: if turned { -root.sign } else { root.sign }, ..root }
}

impl Surface for Prism {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.probe(ray);
        let mut roots = Sorted::new();
        let is_shown = |face: u32| !self.open || face == 0;
        let range = sink.range();
        let admitted = |crossing: &Crossing, plane: &ThreePoints| {
            !crossing.is_outside(range) && probe.may_admit(crossing) && probe.admits(plane, crossing)
        };
        if self.tangled {
            // Inside and outside alternate along the line.
            let mut all = Vec::new();
            self.each_crossing(&probe, |crossing, plane, face, wall, _| {
                all.push((crossing, plane, face, wall));
            });
            all.sort_by(|a, b| a.0.s.total_cmp(&b.0.s));
            // Where an outline crosses itself, crossings that f64 cannot order are ordered exactly.
            for group in all.chunk_by_mut(|(a, ..), (b, ..)| a.s_hi >= b.s_lo).filter(|g| g.len() > 1) {
                group.sort_by(|(a, p, ..), (b, q, ..)| order(&probe, (a, p), (b, q)));
            }
            for (i, (crossing, plane, face, wall)) in all.iter().enumerate() {
                let sign = if i % 2 == 0 { -1 } else { 1 };
                if is_shown(*face) && admitted(crossing, plane) {
                    roots.push(root(&probe, crossing, *face, *wall, crossing.sign != sign));
                }
            }
            let _ = roots.pour_in_turn(sink);
        } else {
            self.each_crossing(&probe, |crossing, plane, face, wall, turned| {
                if is_shown(face) && admitted(&crossing, &plane) {
                    roots.push(root(&probe, &crossing, face, wall, turned));
                }
            });
            let _ = roots.pour(sink);
        }
    }

    /// Texture coordinates: on the walls once round all outlines, edge by edge, and from the bottom
    /// to the top; on the caps lengths.
    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let point = match self.walls.get(root.tag[0] as usize) {
            Some(wall) if root.face == 0 => {
                let varying = Varying { normals: None, uv: Some(wall.uv) };
                facet::resolve(&self.probe(ray), &wall.facet, &varying, need)
            }
            _ => match self.caps.iter().find(|c| c.face == root.face) {
                Some(cap) => cap.polygon.resolve(ray, root, need),
                // Not a root of this surface: nothing can be computed.
                None => SurfacePoint::new(
                    self.view().0,
                    Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
                    f64::INFINITY,
                    Vec3::Y.to_normal(),
                ),
            },
        };
        if root.tag[1] == 0.0 {
            return point;
        }
        SurfacePoint { ng: -point.ng, ns: -point.ns, dndu: -point.dndu, dndv: -point.dndv, ..point }
    }

    fn solidity(&self) -> Solidity {
        if self.open { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.open {
            return Side::Out;
        }
        let (centre, size) = self.view();
        let scale = exponent(size) + 1;
        let line = PointLine::new(point, Vec3::Y, centre, scale);
        let filter = EdgeFilter::new(&line);
        let mut odd = false;
        for Wall { facet, .. } in &self.walls {
            let plane = ThreePoints { points: *facet, centre, scale };
            if may_hold(facet, point)
                // The side is open only for an inexact point.
                && line.side_of(&plane).is_none_or(Ordering::is_eq)
                && facet::holds_start(&line, facet)
            {
                return Side::On;
            }
            // The wall is ahead of the point if the point lies above the plane and the line goes
            // down, or below and up; no line crosses a wall along y.
            if let Some(passed) = facet::passes(&line, &filter, facet)
                && line.side_of(&plane).is_some_and(|height| height as i8 == passed.side)
            {
                odd = !odd;
            }
        }
        for Cap { polygon, turned, face } in &self.caps {
            let plane = ThreePoints { points: polygon.spanning(), centre, scale };
            // The rims belong to the walls, which have been tested.
            if !polygon.holds(&line) {
                continue;
            }
            // Above the plane, as y grows.
            let up = *turned != (*face == 2);
            match line.side_of(&plane) {
                Some(Ordering::Equal) | None => return Side::On,
                Some(height) if (height == Ordering::Greater) != up => odd = !odd,
                Some(_) => {}
            }
        }
        if odd { Side::In } else { Side::Out }
    }
}

impl Accelerate for Prism {
    fn name(&self) -> &'static str {
        "prism"
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        !self.tangled
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        if self.tangled {
            return f(self.bounds, PartId(0));
        }
        let together = self.sweep.together();
        let walls = self.walls.chunks(together).map(|w| Aabb::from_points(w.iter().flat_map(|w| w.facet)));
        let caps = self.caps.iter().filter(|_| !self.open).map(|cap| cap.polygon.bounds());
        for (bounds, number) in walls.chain(caps).zip(0..) {
            f(bounds, PartId(number));
        }
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        match self.part(part) {
            _ if self.tangled => self.solid_packet_filter().0,
            Some(PrismPart::Walls(&[Wall { ribs: [[a0, a1], [b0, b1]], .. }, _], _)) => {
                FilterSource::flat([a0, a1, b1, b0]).on_face(0)
            }
            Some(PrismPart::Walls(&[Wall { facet, .. }], _)) => FilterSource::flat(facet).on_face(0),
            Some(PrismPart::Cap(cap)) => {
                let sketch = cap.polygon.packet_filter(PartId(0)).on_face(cap.face);
                if cap.turned { sketch.turned() } else { sketch }
            }
            _ => FilterSource::vague(self.bounds),
        }
    }

    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        let Some(sketch) = self.whole_for_lanes() else {
            return (FilterSource::vague(self.bounds), vec![PartId(0)]);
        };
        if self.tangled {
            return (sketch, vec![PartId(0)]);
        }
        // The parts of the walls, the bottom, the top. An apex has no face, so any part is correct.
        let walls = self.walls.len() / self.sweep.together();
        let cap = |face: u32| self.caps.iter().position(|c| c.face == face).map_or(0, |i| walls + i);
        (sketch, (0..walls).chain([cap(1), cap(2)]).map(|part| PartId(part as u32)).collect())
    }

    #[inline(always)]
    fn part_roots<S: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut S) {
        if self.tangled {
            return self.roots(ray, sink);
        }
        let probe = self.probe(ray);
        let range = sink.range();
        let mut roots = Sorted::new();
        let mut take = |crossing: Crossing, plane: ThreePoints, face, wall, turned| {
            if !crossing.is_outside(range) && probe.may_admit(&crossing) && probe.admits(&plane, &crossing) {
                roots.push(root(&probe, &crossing, face, wall, turned));
            }
        };
        match self.part(part) {
            Some(PrismPart::Walls(walls, first)) => self.wall_crossings(&probe, (walls, first), &mut take),
            Some(PrismPart::Cap(cap)) => cap_crossing(&probe, cap, &mut take),
            None => {}
        }
        let _ = roots.pour(sink);
    }
}

impl Algebraic for Prism {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let p = planar::plane_through_along(self.plane_of(root)?, ray)?;
        let crossing =
            if exact_sign(&p.b).is_gt() { quadratic::Crossing::Out } else { quadratic::Crossing::In };
        Some(sign_at_root(&p, crossing, q))
    }
}

#[cfg(test)]
mod tests;
