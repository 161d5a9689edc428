//! Height fields and terrain: sheets of triangles over the unit square, one height per grid point.
//!
//! ```text
//!    y = h(x, z) over 0 <= x, z <= 1                z ▲  p01 ─── p11
//!                                                     │   │ ╲  1  │
//!    cell (i, j): two triangles,                      │   │  ╲    │
//!    {p00, p01, p10} and {p11, p10, p01},             │   │ 0  ╲  │
//!    normals upward                                   │  p00 ─── p10
//!                                                     └──────────────▶ x
//! ```
//!
//! Grid points have `x = i / columns` and `z = j / rows` (of cells), rounded to f64: these rounded
//! numbers are the surface. Heights come from a table ([`HeightField`]) or are made on demand
//! ([`Terrain`]).
//!
//! A ray walks down a quadtree of height bounds, front to back: a block of cells is left out when
//! the part of the ray over it lies above or below all its heights (F. K. Musgrave, "Grid tracing:
//! fast ray tracing for height fields", Yale University research report YALEU/DCS/RR-639, 1988;
//! D. Cohen, A. Shaked, "Photo-realistic imaging of digital terrains", *Computer Graphics Forum*
//! 12(3), 1993; A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable
//! dynamic height field rendering", I3D 2008). The tree only proposes cells; each triangle is
//! decided by the rule of meshes (`edges.rs`), so a ray through a shared edge or vertex meets
//! exactly one of the triangles there. The triangles are never stored.
//!
//! By itself it is an open sheet, which rays meet from both sides. As a [solid](Sheet::solid) it is
//! everything below the sheet, unbounded downward, closed by four walls.

mod column;
mod fractal;
mod heights;
mod samples;
#[cfg(test)]
mod tests;
mod walk;

pub use self::fractal::{Midpoints, Terrain, TerrainData, TerrainError};
pub use self::heights::{Block, Heights};
pub use self::samples::{HeightField, HeightFieldError, MOST_SAMPLES, Samples};

use self::walk::{Entry, Line, Queue, Stack};
use crate::edges::EdgeFilter;
use crate::facet::{self, Facet, Varying};
use crate::planar::{self, AlongRay, Crossing, Line as _, PlaneForm, Probe, ThreePoints};
use crate::swift::{self, Swift};
use crate::{
    Accelerate, Algebraic, LocalPoint, LocalRay, Need, RingRay, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Dyadic, Point3, Ring, Vec3};
use durer_roots::quadratic::Quadratic;

/// A sheet of triangles over the unit square. A root's face is `2 (j columns + i)` for the triangle
/// at p00 of cell (i, j), one more for the other; faces from [`Heights::faces`] on are walls.
///
/// # Invariants
///
/// All heights are finite. There is at least one cell each way.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet<H> {
    heights: H,
    /// The least and the greatest height.
    range: [f64; 2],
    water_level: f64,
    is_smooth: bool,
    /// The map to the space in which normals are interpolated, if it is not the sheet's own.
    shown_in: Option<Affine>,
    is_solid: bool,
}

/// The corners of a cell: p00, p10, p01, p11.
type Corners = [Point3; 4];

/// Both triangles of a cell.
#[inline(always)]
fn facets([p00, p10, p01, p11]: Corners) -> [Facet; 2] {
    [[p00, p01, p10], [p11, p10, p01]]
}

impl<H: Heights> Sheet<H> {
    fn of(heights: H) -> Self {
        let range = heights.range(heights.whole().0, heights.whole().1);
        let water_level = f64::NEG_INFINITY;
        Self { heights, range, water_level, is_smooth: false, shown_in: None, is_solid: false }
    }

    /// Leaves out all parts of the sheet that lie below `level`. A solid does not change.
    #[must_use]
    pub fn with_water_level(mut self, level: f64) -> Self {
        self.water_level = level;
        self
    }

    /// Interpolates normals over the cells, for shading; hits do not change.
    #[must_use]
    pub fn smooth(mut self) -> Self {
        self.is_smooth = true;
        self
    }

    /// Interpolates normals in the space to which the sheet is mapped: there the normals of grid
    /// points have equal weights (a fact of the scene language).
    #[must_use]
    pub fn shown_in(mut self, map: Option<&Affine>) -> Self {
        self.shown_in = map.copied();
        self
    }

    /// Converts the sheet to the solid below it, unbounded downward, closed by walls over the
    /// borders of the unit square. No part is left out below a water level.
    #[must_use]
    pub fn solid(mut self) -> Self {
        self.is_solid = true;
        self
    }

    /// The heights.
    pub fn heights(&self) -> &H {
        &self.heights
    }

    /// Bounds of all heights.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Parts below this height are left out.
    pub fn water_level(&self) -> f64 {
        self.water_level
    }

    /// Whether normals are interpolated.
    pub fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    /// The box of the sheet.
    fn sheet_bounds(&self) -> Aabb {
        let [low, high] = self.range;
        let low = if self.is_solid { low } else { low.max(self.water_level) };
        if low > high {
            return Aabb::EMPTY;
        }
        Aabb { min: Point3::new(0.0, low, 0.0), max: Point3::new(1.0, high, 1.0) }
    }

    #[inline(always)]
    fn cell_corners(&self, block: Block, [h00, h10, h01, h11]: [f64; 4]) -> Corners {
        let [columns, rows] = self.heights.cells();
        let (x0, x1) = (heights::at(block.i, columns), heights::at(block.i + 1, columns));
        let (z0, z1) = (heights::at(block.j, rows), heights::at(block.j + 1, rows));
        let point = Point3::new;
        [point(x0, h00, z0), point(x1, h10, z0), point(x0, h01, z1), point(x1, h11, z1)]
    }

    /// The triangle of a face, if it is one of the sheet's.
    #[inline(always)]
    fn facet(&self, face: u32) -> Option<Facet> {
        if face >= self.heights.faces() {
            return None;
        }
        let [columns, _] = self.heights.cells();
        let block = Block { level: 0, i: (face >> 1) % columns, j: (face >> 1) / columns };
        let at = |i: u32, j: u32| self.heights.height(block.i + i, block.j + j);
        let corners = self.cell_corners(block, [at(0, 0), at(1, 0), at(0, 1), at(1, 1)]);
        Some(facets(corners)[face as usize & 1])
    }

    /// Three points of the plane of a face.
    fn plane_of(&self, face: u32) -> Option<Facet> {
        self.facet(face).or_else(|| Some(self.wall(face)?.facet()))
    }

    /// The ray relative to the facet's own middle, as in a mesh: the error at a small triangle
    /// should not depend on the size of the sheet.
    #[inline(always)]
    fn probe<'a>(ray: &'a LocalRay<'a>, facet: &Facet) -> Probe<'a> {
        let (centre, size) = planar::middle(&Aabb::from_points(*facet));
        Probe::new(ray, centre, size)
    }

    /// Whether a crossing is not below the water level, exactly.
    #[inline(always)]
    fn is_dry(&self, ray: &LocalRay<'_>, facet: &Facet) -> bool {
        let level = self.water_level;
        let (low, high) =
            (facet[0].y.min(facet[1].y).min(facet[2].y), facet[0].y.max(facet[1].y).max(facet[2].y));
        if self.is_solid || low >= level {
            return true;
        }
        high >= level && {
            let probe = Self::probe(ray, facet);
            let plane = facet::plane(&probe, facet);
            let depth = Depth { plane: &plane, level };
            // An unknown side (of inexact rays only) counts as dry.
            probe.sign(&depth).is_none_or(Ordering::is_ge)
        }
    }

    #[inline(always)]
    fn face_root(&self, facet: &Facet, face: u32, ray: &LocalRay<'_>, range: (f64, f64)) -> Option<Root> {
        match swift::meet(ray, facet, face, range) {
            Swift::Missed => return None,
            Swift::Met(root) => return self.is_dry(ray, facet).then_some(root),
            Swift::Open => {}
        }
        let probe = Self::probe(ray, facet);
        let (crossing, tag) = facet::hit(&probe, &EdgeFilter::new(&probe), facet)?;
        let here = self.may_count(&probe, &crossing, face, range)
            && probe.admits(&facet::plane(&probe, facet), &crossing)
            && self.is_dry(ray, facet);
        here.then(|| probe.root(&crossing, face, tag))
    }

    /// Whether a crossing may matter: it is not where the ray was spawned, and not certainly
    /// outside the ray's or the sink's range.
    #[inline(always)]
    fn may_count(&self, probe: &Probe<'_>, crossing: &Crossing, face: u32, range: (f64, f64)) -> bool {
        let is_left = probe.ray.local().source_face == face && probe.leaves(crossing);
        !is_left && !crossing.is_outside(range) && probe.may_admit(crossing)
    }

    /// The crossings with a cell's triangles.
    #[inline(always)]
    fn cell_roots(
        &self,
        (block, heights): (Block, [f64; 4]),
        ray: &LocalRay<'_>,
        filter: &EdgeFilter,
        range: (f64, f64),
        queue: &mut Queue,
        line: &Line<'_>,
    ) {
        let corners = self.cell_corners(block, heights);
        let [p00, p10, p01, p11] = corners.map(|p| filter.seen(p));
        let reach = |v: Vec3| v.max_abs();
        let bound = filter.bound(reach(p00).max(reach(p10)).max(reach(p01)).max(reach(p11)));
        // Both triangles share the diagonal.
        let diagonal = filter.side(p10, p01);
        let sides = [
            [-diagonal, filter.side(p10, p00), filter.side(p00, p01)],
            [diagonal, filter.side(p01, p11), filter.side(p11, p10)],
        ];
        let [columns, _] = self.heights.cells();
        let first = 2 * (block.j * columns + block.i);
        for (half, (facet, [u, v, w])) in facets(corners).iter().zip(sides).enumerate() {
            if u.min(v).min(w) < -bound && u.max(v).max(w) > bound {
                continue;
            }
            if let Some(root) = self.face_root(facet, first + half as u32, ray, range) {
                queue.push(root, line);
            }
        }
    }

    /// The shading normal of a point of a face, and its derivatives: the normals of the cell's four
    /// corners are interpolated bilinearly, also across the diagonal (a fact of the scene
    /// language).
    fn shade(&self, face: u32, point: &mut SurfacePoint) {
        let [columns, rows] = self.heights.cells();
        let (i, j) = ((face >> 1) % columns, (face >> 1) / columns);
        let (columns, rows) = (f64::from(columns), f64::from(rows));
        let u = (point.p.x * columns - f64::from(i)).clamp(0.0, 1.0);
        let v = (point.p.z * rows - f64::from(j)).clamp(0.0, 1.0);
        let normal = |a: u32, b: u32| {
            let n = self.vertex_normal(i + a, j + b).to_normal();
            let outer = self.shown_in.map_or(n, |map| map.normal(n));
            let unit = outer.normalized().unwrap_or(outer);
            self.shown_in.map_or(unit, |map| map.inverse_normal(unit)).to_vec()
        };
        let [n00, n10, n01, n11] = [normal(0, 0), normal(1, 0), normal(0, 1), normal(1, 1)];
        let (south, north) = (n10 - n00, n11 - n01);
        let sum = (n00 + south * u) * (1.0 - v) + (n01 + north * u) * v;
        let Some(unit) = sum.to_normal().normalized() else { return };
        let side = if unit.dot(point.ng.to_vec()) < 0.0 { -1.0 } else { 1.0 };
        point.ns = unit * side;
        // The change of the unit normal is the change of the sum across it, over the sum's length.
        let length = sum.length();
        let across = |x: Vec3| {
            let x = x * (side / length);
            x.to_normal() - point.ns * point.ns.dot(x)
        };
        let dndu = across((south * (1.0 - v) + north * v) * columns);
        let dndv = across(((n01 - n00) * (1.0 - u) + (n11 - n10) * u) * rows);
        (point.dndu, point.dndv) = (dndu.to_vec(), dndv.to_vec());
    }

    /// The normal for shading at a grid point, of about unit length where cells and heights are
    /// counted as follows.
    ///
    /// Facts of the scene language: it is the mean of the unit normals of the four triangles that
    /// the point makes with its neighbours along x and z, where cells are one unit wide and heights
    /// are counted in units of `2^-16`. The components of the normal of a height field are rounded
    /// towards zero to multiples of `1/32767`. On steep slopes the component upward is only a few
    /// of these steps.
    fn vertex_normal(&self, i: u32, j: u32) -> Vec3 {
        const UNITS: f64 = 65536.0;
        const STEPS: f64 = 32767.0;
        let [columns, rows] = self.heights.cells();
        let here = self.heights.height(i, j);
        let rise = |i: u32, j: u32| (self.heights.height(i, j) - here) * UNITS;
        let east = (i < columns).then(|| rise(i + 1, j));
        let west = (i > 0).then(|| -rise(i - 1, j));
        let north = (j < rows).then(|| rise(i, j + 1));
        let south = (j > 0).then(|| -rise(i, j - 1));
        let mut sum = Vec3::ZERO;
        for x in [east, west].into_iter().flatten() {
            for z in [north, south].into_iter().flatten() {
                let n = Vec3::new(-x, 1.0, -z);
                sum += n / n.length();
            }
        }
        // Each of the vectors has a positive y, so the sum is not zero.
        let mut n = sum / sum.length();
        if H::ROUNDS_NORMALS {
            n = Vec3::new((n.x * STEPS).trunc(), (n.y * STEPS).trunc(), (n.z * STEPS).trunc()) / STEPS;
        }
        Vec3::new(n.x * f64::from(columns), n.y * UNITS, n.z * f64::from(rows))
    }
}

/// How far above a level a ray crosses a plane, times a positive factor.
struct Depth<'a> {
    plane: &'a ThreePoints,
    level: f64,
}

impl AlongRay for Depth<'_> {
    /// The crossing is at `s = -h / g`, so `y - level = ((o - level) g - h d) / g`.
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let ThreePoints { centre, scale, .. } = self.plane;
        let level = (T::exact(self.level) - T::exact(centre.y)).scale2(-scale);
        let (height, slope) = (self.plane.height(ray)?, self.plane.slope(ray));
        let over = ray.o[1].clone() - level * ray.w.clone();
        Some((over * slope.clone() - height * ray.d[1].clone()) * slope)
    }
}

impl<H: Heights> Surface for Sheet<H> {
    fn bounds(&self) -> Aabb {
        if self.is_solid { Aabb::UNBOUNDED } else { self.sheet_bounds() }
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let bounds = self.sheet_bounds();
        if bounds.is_empty() {
            return;
        }
        let (centre, size) = planar::middle(&bounds);
        let probe = Probe::with_scale(ray, centre, 0, size);
        let line = Line::new(probe.ray, &bounds);
        let mut queue = Queue::new();
        if self.is_solid {
            self.wall_roots(ray, sink.range(), &line, &mut queue);
        }
        let Some(span) = line.within(sink.range()) else {
            let _ = self.pour(f64::INFINITY, ray, &mut queue, sink);
            return;
        };
        let filter = EdgeFilter::new(&probe);
        let lowest = if self.is_solid { f64::NEG_INFINITY } else { self.water_level };
        let cells = self.heights.cells();
        let (mut stack, mut limit) = (Stack::new(), f64::INFINITY);
        let (block, data) = self.heights.whole();
        stack.push(Entry { block, data, span });
        while let Some(Entry { block, data, span }) = stack.pop() {
            if queue.may_pour(span.0) {
                let next = stack.iter().fold(span.0, |least, entry| least.min(entry.span.0));
                if self.pour(next, ray, &mut queue, sink).is_break() {
                    return;
                }
                limit = line.latest(sink.range());
            }
            if span.0 > limit {
                continue;
            }
            if block.level == 0 {
                let cell = (block, self.heights.corners(block, data));
                self.cell_roots(cell, ray, &filter, sink.range(), &mut queue, &line);
                continue;
            }
            let quarters = self.heights.quarters(block, data);
            line.split(
                block,
                span,
                cells,
                #[inline(always)]
                |k, part, span| {
                    let range = self.heights.range(part, quarters[k]);
                    if range[1] >= lowest && line.passes(range, span) {
                        stack.push(Entry { block: part, data: quarters[k], span });
                    }
                },
            );
        }
        let _ = self.pour(f64::INFINITY, ray, &mut queue, sink);
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let Some(facet) = self.facet(root.face) else { return self.resolve_wall(ray, root) };
        let varies = need.contains(Need::SHADING_NORMAL) || need.contains(Need::DERIVATIVES);
        let uv = facet.map(|p| [p.x, p.z]);
        let varying = Varying { normals: None, uv: Some(uv) };
        let mut point = facet::resolve_far(&Self::probe(ray, &facet), &facet, &varying, need);
        if self.is_smooth && varies {
            self.shade(root.face, &mut point);
        }
        point
    }

    fn solidity(&self) -> Solidity {
        if self.is_solid { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.is_solid { self.column_side(point) } else { Side::Out }
    }
}

impl<H: Heights> Accelerate for Sheet<H> {
    fn name(&self) -> &'static str {
        H::NAME
    }
}

impl<H: Heights + 'static> Algebraic for Sheet<H> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_through_along(self.plane_of(face)?, ray)
    }
}
