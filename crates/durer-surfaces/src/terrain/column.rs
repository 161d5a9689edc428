//! The solid under a sheet: its walls and its inside.
//!
//! A wall is a plane over a border of the unit square. Below each edge `p q` of the sheet's border
//! it has a piece, unbounded downward, between the verticals through `p` and `q`:
//!
//! ```text
//!        p ──── q           The three lines, p q and both verticals, are passed by a ray by the
//!        │      │           rule of `edges.rs`, and neighbours share them with the sheet and with
//!        ▼      ▼           each other: so the solid has no gap.
//! ```

use super::Sheet;
use super::heights::{Heights, at};
use super::walk::{Found, Line, Queue};
use crate::edges::{self, EdgeFilter};
use crate::facet::{self, Facet};
use crate::planar::{self, AlongRay, Line as _, PlaneForm, PointLine, Probe, ThreePoints};
use crate::point::least_step;
use crate::{LocalPoint, LocalRay, RingRay, Root, Side, Sink, SurfacePoint};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use core::ops::Range;
use durer_math::rounding::{add_up, sub_down, sub_up};
use durer_math::{Dyadic, Point3, Ring, Vec3};

/// A piece of a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    /// The upper edge.
    p: Point3,
    q: Point3,
    /// The axis across it: 0 or 2.
    axis: usize,
    /// Whether it stands at 1, and not at 0.
    far: bool,
}

/// A point on the vertical through `p`, below it.
#[inline(always)]
fn below(p: Point3) -> Point3 {
    Point3::new(p.x, p.y - (1.0 + p.y.abs()), p.z)
}

impl Wall {
    /// A triangle in its plane, seen from outside.
    #[inline(always)]
    pub(super) fn facet(&self) -> Facet {
        let down = below(self.p);
        if (self.axis == 0) == self.far { [self.p, self.q, down] } else { [self.p, down, self.q] }
    }

    fn normal(&self) -> Vec3 {
        let sign = if self.far { 1.0 } else { -1.0 };
        if self.axis == 0 { Vec3::X * sign } else { Vec3::Z * sign }
    }

    /// Whether the line passes the upper edge and both verticals on the same side.
    #[inline(always)]
    fn is_passed(&self, probe: &Probe<'_>, filter: &EdgeFilter) -> bool {
        let lines = [[self.p, self.q], [self.q, below(self.q)], [below(self.p), self.p]];
        let mut common = 0;
        for [a, b] in lines {
            let seen = [filter.seen(a), filter.seen(b)];
            let bound = filter.bound(seen[0].max_abs().max(seen[1].max_abs()));
            let value = filter.side(seen[0], seen[1]);
            let side = if value.abs() > bound {
                Some(if value > 0.0 { 1 } else { -1 })
            } else {
                edges::exact_side(probe, a, b)
            };
            // A side that is not known (inexact lines only) agrees with all.
            let Some(side) = side else { continue };
            if side == 0 || side == -common {
                return false;
            }
            common = side;
        }
        true
    }
}

/// Heights `h` and slopes `g` of two planes along a ray: `g1 h2 - g2 h1`.
struct Apart<'a>(&'a ThreePoints, &'a ThreePoints);

impl AlongRay for Apart<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let Self(p, q) = self;
        Some(p.slope(ray) * q.height(ray)? - q.slope(ray) * p.height(ray)?)
    }
}

impl<H: Heights> Sheet<H> {
    /// The borders: the axis across, whether it is the far one, and the number of edges.
    #[inline(always)]
    fn borders(&self) -> [(usize, bool, u32); 4] {
        let [columns, rows] = self.heights().cells();
        [(0, false, rows), (0, true, rows), (2, false, columns), (2, true, columns)]
    }

    /// The piece of a wall below an edge of a border.
    #[inline(always)]
    fn piece(&self, axis: usize, far: bool, n: u32) -> Wall {
        let cells = self.heights().cells();
        let mut ends = [Point3::ORIGIN; 2];
        for (end, n) in ends.iter_mut().zip([n, n + 1]) {
            let [i, j] = match (axis, far) {
                (0, false) => [0, n],
                (0, true) => [cells[0], n],
                (_, false) => [n, 0],
                (_, true) => [n, cells[1]],
            };
            *end = Point3::new(at(i, cells[0]), self.heights().height(i, j), at(j, cells[1]));
        }
        let [p, q] = ends;
        Wall { p, q, axis, far }
    }

    /// The wall of a face.
    pub(super) fn wall(&self, face: u32) -> Option<Wall> {
        let mut n = face.checked_sub(self.heights().faces())?;
        for (axis, far, edges) in self.borders() {
            if n < edges {
                return Some(self.piece(axis, far, n));
            }
            n -= edges;
        }
        None
    }

    /// The crossings with the walls.
    #[inline(always)]
    pub(super) fn wall_roots(
        &self,
        ray: &LocalRay<'_>,
        range: (f64, f64),
        line: &Line<'_>,
        queue: &mut Queue,
    ) {
        let mut first = self.heights().faces();
        for (axis, far, edges) in self.borders() {
            for n in self.edges_near(line, range, (axis, far), edges) {
                let face = first + n;
                if let Some(root) = self.wall_root(&self.piece(axis, far, n), face, ray, range) {
                    queue.push(root, line);
                }
            }
            first += edges;
        }
    }

    /// The edges of a border below which a line may pass the wall, at a place in a range of `t`.
    #[inline(always)]
    fn edges_near(
        &self,
        line: &Line<'_>,
        range: (f64, f64),
        (axis, far): (usize, bool),
        edges: u32,
    ) -> Range<u32> {
        let Some(place) = line.place(axis, f64::from(u8::from(far))) else { return 0..edges };
        let (low, high) = line.across(&place, 2 - axis);
        let is_over = line.is_above(&place, self.range()[1]);
        if is_over || high < 0.0 || low > 1.0 || !line.may_reach(&place, range) {
            return 0..0;
        }
        let of = |at: f64| ((at * f64::from(edges)).max(0.0) as u32).min(edges - 1);
        // One more each way pays for roundings.
        of(low).saturating_sub(1)..(of(high) + 2).min(edges)
    }

    #[inline(always)]
    fn wall_root(&self, wall: &Wall, face: u32, ray: &LocalRay<'_>, range: (f64, f64)) -> Option<Root> {
        let facet = wall.facet();
        let probe = Self::probe(ray, &facet);
        if !wall.is_passed(&probe, &EdgeFilter::new(&probe)) {
            return None;
        }
        let plane = facet::plane(&probe, &facet);
        let crossing = probe.crossing(&plane)?;
        let here = self.may_count(&probe, &crossing, face, range) && probe.admits(&plane, &crossing);
        here.then(|| probe.root(&crossing, face, [0.0; 2]))
    }

    /// Passes on the crossings that come before all others from `next` on.
    #[inline(always)]
    pub(super) fn pour<S: Sink + ?Sized>(
        &self,
        next: f64,
        ray: &LocalRay<'_>,
        queue: &mut Queue,
        sink: &mut S,
    ) -> ControlFlow<()> {
        queue.pour(next, sink, |found, before| {
            if found.len() > 1 {
                found.sort_unstable_by(|a, b| a.root.order(&b.root));
            }
            self.put_in_turn(ray, found, before);
        })
    }

    /// Puts crossings in their exact order, behind one of the sign `before` (0 if there is none). Of
    /// two at one point the one comes first that leaves the solid, if the ray is inside.
    fn put_in_turn(&self, ray: &LocalRay<'_>, found: &mut [Found], mut before: i8) {
        for group in found.chunk_by_mut(|a, b| a.root.hi >= b.root.lo).filter(|group| group.len() > 1) {
            group.sort_by(|a, b| self.exact_order(ray, &a.root, &b.root));
        }
        if !self.is_solid {
            return;
        }
        for n in 1..found.len() {
            let (here, next) = (found[n - 1].root, found[n].root);
            if here.sign != next.sign && here.hi >= next.lo && self.exact_order(ray, &here, &next).is_eq() {
                if before == 0 {
                    before = if self.starts_inside(ray) { -1 } else { 1 };
                }
                if before == here.sign {
                    found.swap(n - 1, n);
                }
            }
            before = found[n - 1].root.sign;
        }
    }

    /// Whether a ray starts inside, within rounding.
    #[cold]
    fn starts_inside(&self, ray: &LocalRay<'_>) -> bool {
        let start = ray.point_at_start();
        if !start.is_finite() {
            // Far away it is inside only straight below.
            return ray.t_min < 0.0 && ray.d.x == 0.0 && ray.d.z == 0.0 && ray.d.y > 0.0;
        }
        self.column_side(&LocalPoint::new(start)) == Side::In
    }

    /// The order of two crossings; equal if they are at one point, or if the ray is not exactly
    /// known.
    #[cold]
    #[inline(never)]
    fn exact_order(&self, ray: &LocalRay<'_>, a: &Root, b: &Root) -> Ordering {
        let (Some(p), Some(q)) = (self.plane_of(a.face), self.plane_of(b.face)) else {
            return Ordering::Equal;
        };
        let probe = Self::probe(ray, &p);
        let (p, q) = (facet::plane(&probe, &p), facet::plane(&probe, &q));
        let apart = probe.sign(&Apart(&p, &q)).unwrap_or(Ordering::Equal);
        if a.sign == b.sign { apart } else { apart.reverse() }
    }

    pub(super) fn resolve_wall(&self, ray: &LocalRay<'_>, root: &Root) -> SurfacePoint {
        let Some(wall) = self.wall(root.face) else { return SurfacePoint::unknown(ray.o) };
        let (facet, normal) = (wall.facet(), wall.normal());
        let probe = Self::probe(ray, &facet);
        let (mut p, mut dp) = planar::foot_point(&probe, &facet::plane(&probe, &facet), normal, 1.0, 0.0);
        // The coordinate across the wall is known.
        p[wall.axis] = f64::from(u8::from(wall.far));
        dp[wall.axis] = 0.0;
        let mut point = SurfacePoint::new(p, dp, least_step(p), normal.to_normal());
        point.uv = [p.x, p.z];
        point
    }

    /// The side of the solid on which a point lies, if f64 decides it: outside of the column, above
    /// or below all heights of its cells.
    fn column_side_in_doubles(&self, point: &LocalPoint<'_>) -> Option<Side> {
        let (p, e) = (point.p, point.p_err);
        let within = [strictly_within(p.x, e.x), strictly_within(p.z, e.z)];
        if within.contains(&Some(false)) {
            return Some(Side::Out);
        }
        let [low, high] = self.range();
        // Rounded outward.
        let (bottom, top) = (sub_down(p.y, e.y), add_up(p.y, e.y));
        if bottom > high {
            return Some(Side::Out);
        }
        if within != [Some(true); 2] {
            return None;
        }
        if top < low {
            return Some(Side::In);
        }
        let [columns, rows] = self.heights().cells();
        let i = cell_around(sub_down(p.x, e.x), add_up(p.x, e.x), columns)?;
        let j = cell_around(sub_down(p.z, e.z), add_up(p.z, e.z), rows)?;
        let height = |a: u32, b: u32| self.heights().height(i + a, j + b);
        let corners = [height(0, 0), height(1, 0), height(0, 1), height(1, 1)];
        if corners.iter().all(|h| bottom > *h) {
            Some(Side::Out)
        } else if corners.iter().all(|h| top < *h) {
            Some(Side::In)
        } else {
            None
        }
    }

    /// The side of the solid on which a point lies.
    pub(super) fn column_side(&self, point: &LocalPoint<'_>) -> Side {
        if let Some(side) = self.column_side_in_doubles(point) {
            return side;
        }
        let [columns, rows] = self.heights().cells();
        let exact = point.in_ring::<Dyadic>();
        let ([x, y, z], w) =
            exact.unwrap_or_else(|| (point.p.to_array().map(Dyadic::exact), Dyadic::exact(1.0)));
        let from = |x: &Dyadic, at: f64| (x.clone() - Dyadic::exact(at) * w.clone()).exact_sign();
        let ends = [from(&x, 0.0), from(&x, 1.0).reverse(), from(&z, 0.0), from(&z, 1.0).reverse()];
        if ends.contains(&Ordering::Less) {
            return Side::Out;
        }
        let (i, j) =
            (cell_of(point.p.x, columns, |at| from(&x, at)), cell_of(point.p.z, rows, |at| from(&z, at)));
        let (x1, z0) = (at(i + 1, columns), at(j, rows));
        // On which side of the diagonal from p10 to p01? Of (x - x1)(z1 - z0) + (z - z0)(x1 - x0) the
        // sign, that is: at p00 it is negative.
        let (ex, ez) = (
            Dyadic::exact(x1) - Dyadic::exact(at(i, columns)),
            Dyadic::exact(at(j + 1, rows)) - Dyadic::exact(z0),
        );
        let over = (x - Dyadic::exact(x1) * w.clone()) * ez + (z - Dyadic::exact(z0) * w.clone()) * ex;
        let face = 2 * (j * columns + i) + u32::from(over.exact_sign().is_gt());
        let Some(points) = self.facet(face) else { return Side::Out };
        let [low, high] = self.range();
        let height = if from(&y, high).is_gt() {
            Ordering::Greater
        } else if from(&y, low).is_lt() {
            Ordering::Less
        } else {
            let plane = ThreePoints { points, centre: points[0], scale: 0 };
            let line = PointLine::new(point, Vec3::ZERO, points[0], 0);
            line.side_of(&plane).unwrap_or(Ordering::Equal)
        };
        match height {
            Ordering::Greater => Side::Out,
            Ordering::Less if !ends.contains(&Ordering::Equal) => Side::In,
            _ => Side::On,
        }
    }
}

/// Whether a coordinate is between 0 and 1, if that is certain.
fn strictly_within(at: f64, error: f64) -> Option<bool> {
    if at > error && sub_down(1.0, at) > error {
        Some(true)
    } else if at < -error || sub_up(1.0, at) < -error {
        Some(false)
    } else {
        None
    }
}

/// The cell that holds a coordinate, from about where it is and on which side of other coordinates.
fn cell_of(about: f64, cells: u32, from: impl Fn(f64) -> Ordering) -> u32 {
    let mut n = ((about * f64::from(cells)) as u32).min(cells - 1);
    while n > 0 && from(at(n, cells)).is_lt() {
        n -= 1;
    }
    while n + 1 < cells && from(at(n + 1, cells)).is_gt() {
        n += 1;
    }
    n
}

/// The cell that holds an interval of coordinates, if that is one.
fn cell_around(low: f64, high: f64, cells: u32) -> Option<u32> {
    let n = ((low * f64::from(cells)).max(0.0) as u32).min(cells - 1);
    (at(n, cells) <= low && high <= at(n + 1, cells)).then_some(n)
}
