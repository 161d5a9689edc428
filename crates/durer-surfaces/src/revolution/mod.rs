//! Solids of revolution: the solid that a profile sweeps around the y axis, between two planes
//! across it.
//!
//! ```text
//!      ______  y_n      Between two of the heights y_0 < y_1 < ... < y_n a wall encloses the
//!     (  w_2 )          solid: a surface of revolution, a polynomial on every ray (`profile.rs`).
//!      )----(  y_2      At a height the solids below and above may differ, by rounding or more:
//!     / w_1  \          the part that only one of them has is a flat ring there.
//!    (--------) y_1
//!     \_w_0__/  y_0
//! ```
//!
//! A ray passes the heights in order. Between two of them, the roots of that wall's polynomial
//! count that lie strictly between the heights. At each height the exact sign of a polynomial
//! decides whether the ray is inside just before and just after it, and where these differ there is
//! one crossing. So every line crosses the solid's boundary inward and outward in turn, whatever
//! the numbers are: a crossing exactly at a seam counts once.

pub mod lathe;
pub(crate) mod level;
pub(crate) mod packet;
mod profile;
mod profile_piece;

use self::packet::RevolutionKernel;
use crate::faces::chart::Frame;
use crate::packet::FilterSource;
use crate::planar::{self, Crossing, Line, PlaneForm, PointLine, Probe};
use crate::polynomial_surface;
use crate::{
    Accelerate, Algebraic, CentredRay, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink,
    Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2};
use durer_math::scale::pow2;
use durer_math::{Aabb, Dyadic, Isa, Point3, Ring, U, Vec3};
use durer_roots::quadratic::Quadratic;
use level::HeightPlane;
use profile::{Cubic, Spindle, Stand};
use profile_piece::Wall;

/// A solid of revolution about the y axis; without its ends a sheet.
///
/// Faces: 0 the walls and the rings at seams, 1 the end below, 2 the end above. A root's tag is the
/// number of the wall, or of the height of a flat part.
///
/// # Invariants
///
/// The heights are finite and ascend; there is one wall between each two successive heights.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOfRevolution {
    heights: Vec<f64>,
    walls: Vec<Wall>,
    /// An upper bound of the radius of each wall, in units.
    widths: Vec<f64>,
    open: bool,
    frame: Frame,
    bounds: Aabb,
}

/// A wall, in the author's own numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Profile {
    /// The squared radius as a polynomial of the height above `at`.
    Cubic { at: f64, a: [f64; 4] },
    /// The inner sheet of a torus: the height and the radius of its circle, and the radius of its
    /// tube, which is larger.
    Spindle { at: f64, major: f64, minor: f64 },
}

/// The solid has no points, or its numbers are beyond the range in which it can be described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unfit;

/// Products of larger coefficients could leave the range of f64.
const LARGEST: f64 = pow2(200);

impl SurfaceOfRevolution {
    /// The solid whose profile between `heights[i]` and `heights[i + 1]` is `profiles[i]`; `widest`
    /// is approximately its largest radius.
    pub(crate) fn of(heights: Vec<f64>, profiles: &[Profile], widest: f64) -> Result<Self, Unfit> {
        let (low, high) = match heights[..] {
            [low, .., high] if heights.windows(2).all(|h| h[0] < h[1]) => (low, high),
            _ => return Err(Unfit),
        };
        let half = 0.5 * (high - low);
        let size = half.max(widest);
        // The fourth power of the size, and its inverse, are well within range.
        if !(low.is_finite() && high.is_finite() && size < 1e70 && half > 1e-70) {
            return Err(Unfit);
        }
        let (centre, scale) = (profile::on_axis(0.5 * low + 0.5 * high), exponent(size) + 1);
        let unit = |y: f64| scale2(y - centre.y, -scale);
        let mut frame = Frame { centre, scale, reach: f64::INFINITY };
        let (mut walls, mut widths) =
            (Vec::with_capacity(profiles.len()), Vec::with_capacity(profiles.len()));
        let mut reach = 0.0_f64;
        for (profile, slab) in profiles.iter().zip(heights.windows(2)) {
            let stand = |at| Stand {
                frame,
                at,
                slab: [unit(slab[0]), unit(slab[1])],
                extent: [unit(low), unit(high)],
            };
            let (wall, widest) = match *profile {
                Profile::Cubic { at, a } => {
                    let a = [0, 1, 2, 3].map(|k| scale2(a[k], scale * (k as i32 - 2)));
                    let wall = Cubic { stand: stand(at), a };
                    if !a.iter().all(|a| a.abs() < LARGEST) {
                        return Err(Unfit);
                    }
                    (Wall::Cubic(wall), wall.widest())
                }
                Profile::Spindle { at, major, minor } => {
                    let [major, minor] = [major, minor].map(|r| scale2(r, -scale));
                    if !(major > 0.0 && minor > major && minor < LARGEST) {
                        return Err(Unfit);
                    }
                    let wall = Spindle { stand: stand(at), major, minor };
                    (Wall::Spindle(wall), wall.widest())
                }
            };
            if widest.is_nan() || widest >= LARGEST {
                return Err(Unfit);
            }
            reach = reach.max(widest);
            walls.push(wall);
            widths.push(widest);
        }
        let radius = scale2(reach, scale);
        let bounds = Aabb::new(Point3::new(-radius, low, -radius), Point3::new(radius, high, radius));
        let half = unit(high).abs().max(unit(low).abs());
        frame.reach = (reach * reach + half * half).sqrt() * (1.0 + 1.0 / 1024.0);
        for wall in &mut walls {
            match wall {
                Wall::Cubic(w) => w.stand.frame = frame,
                Wall::Spindle(w) => w.stand.frame = frame,
            }
        }
        Ok(Self { heights, walls, widths, open: false, frame, bounds })
    }

    /// The walls alone, without their rims.
    #[must_use]
    pub fn without_ends(mut self) -> Self {
        self.open = true;
        self
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        Probe::with_scale(ray, self.frame.centre, self.frame.scale, 1.0)
    }

    #[inline(always)]
    fn level(&self, i: usize) -> HeightPlane {
        HeightPlane { height: self.heights[i], centre: self.frame.centre.y, scale: self.frame.scale }
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || self.all_roots_here(ray, sink),
        );
    }

    #[inline(always)]
    fn all_roots_here(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        // It is unknown on which wall a ray was spawned; it starts where the sign of that wall's
        // polynomial is certain.
        let ray = &ray.from_side(None);
        let probe = self.probe(ray);
        let mut out = Out { sink, least: f64::NEG_INFINITY, stopped: false };
        let last = self.walls.len();
        let Some(first) = probe.crossing(&self.level(0)) else {
            // Across the axis: the whole ray is at one height. A seam belongs to the part above it.
            let above = |i: usize| probe.sign(&self.level(i)).is_none_or(Ordering::is_ge);
            if let Some(i) = (0..last).rev().find(|&i| above(i))
                && !above(last)
            {
                self.wall_roots(i, ray, &probe, None, &mut out);
            }
            return;
        };
        let up = first.sign > 0;
        // Heights and walls in the order in which the ray passes them.
        let height = |k: usize| if up { k } else { last - k };
        let wall = |k: usize| if up { k } else { last - 1 - k };
        let crossing = |k: usize| match height(k) {
            0 => Some(first),
            i => probe.crossing(&self.level(i)),
        };
        let axis = Axial::new(&probe.ray);
        let Some(mut entry) = crossing(0) else { return };
        // The wall behind, unless the ray certainly misses all of it.
        let mut behind = None;
        for k in 0..=last {
            let exit = if k < last { crossing(k + 1) } else { None };
            let ahead = match &exit {
                Some(exit) if axis.misses(self.widths[wall(k)], &entry, exit) => None,
                Some(_) => Some(wall(k)),
                None => None,
            };
            self.seam(height(k), (behind, ahead), &probe, &entry, &mut out);
            let Some(exit) = exit else { return };
            let (near, far) = out.sink.range();
            if out.stopped || entry.lo > far.min(ray.t_max) {
                return;
            }
            if let Some(wall) = ahead
                && exit.hi >= near.max(ray.t_min)
            {
                self.wall_roots(wall, ray, &probe, Some((&entry, &exit)), &mut out);
                if out.stopped {
                    return;
                }
            }
            (behind, entry) = (ahead, exit);
        }
    }

    /// Pushes the crossing at a height, if the ray is inside just before and outside just after it,
    /// or the other way round. Next to a wall that the ray misses it is outside.
    #[inline(always)]
    fn seam(
        &self,
        i: usize,
        (behind, ahead): (Option<usize>, Option<usize>),
        probe: &Probe<'_>,
        crossing: &Crossing,
        out: &mut Out<'_>,
    ) {
        if crossing.is_outside(out.sink.range()) || !probe.may_admit(crossing) {
            return;
        }
        let before = behind.is_some_and(|wall| self.is_inside(wall, i, probe, crossing, false));
        let after = ahead.is_some_and(|wall| self.is_inside(wall, i, probe, crossing, true));
        if before != after {
            self.at_height(i, after, probe, crossing, out);
        }
    }

    /// Pushes a crossing at a height, where the ray goes inside or outside.
    #[inline(never)]
    fn at_height(&self, i: usize, inward: bool, probe: &Probe<'_>, crossing: &Crossing, out: &mut Out<'_>) {
        let face = match i {
            0 => 1,
            i if i == self.walls.len() => 2,
            _ => 0,
        };
        if self.open && face > 0 || !probe.admits(&self.level(i), crossing) {
            return;
        }
        let sign = if inward { -1 } else { 1 };
        // If the ray goes in, the normal points towards its origin.
        let faces_up = (crossing.sign > 0) != inward;
        let tag = [i as f64, if faces_up { 1.0 } else { -1.0 }];
        let root = Root { sign, ..probe.root(crossing, face, tag) };
        // A rim, or a ray exactly through a seam: the wall contains the point, and the root is
        // reported on the wall.
        let wall = (0..self.walls.len())
            .filter(|&w| w == i || w + 1 == i)
            .find(|&w| self.meets(w, i, probe, crossing));
        let _ = match wall {
            Some(w) if face == 0 => out.push(Root { tag: [w as f64, 0.0], ..root }),
            _ => out.push(root),
        };
    }

    /// Whether the ray passes a height exactly at a wall.
    fn meets(&self, wall: usize, height: usize, probe: &Probe<'_>, crossing: &Crossing) -> bool {
        let (at, err) = probe.place(crossing);
        if self.walls[wall].rough(at, err).is_some() {
            return false;
        }
        let Some(ray) = self.level(height).passing(probe) else { return false };
        self.walls[wall].polynomial(&ray).first().is_some_and(Dyadic::is_zero)
    }

    /// Whether the ray is inside a wall just after (`ahead`) or just before it passes a height.
    #[inline(always)]
    fn is_inside(
        &self,
        wall: usize,
        height: usize,
        probe: &Probe<'_>,
        crossing: &Crossing,
        ahead: bool,
    ) -> bool {
        let (at, err) = probe.place(crossing);
        match self.walls[wall].rough(at, err) {
            Some(inside) => inside,
            None => self.is_exactly_inside(&self.walls[wall], height, probe, ahead),
        }
    }

    #[cold]
    #[inline(never)]
    fn is_exactly_inside(&self, wall: &Wall, height: usize, probe: &Probe<'_>, ahead: bool) -> bool {
        Isa::detect().run(
            #[inline(always)]
            || {
                let Some(ray) = self.level(height).passing(probe) else { return false };
                let beside = |mut p: Vec<Dyadic>| {
                    if !ahead {
                        p.iter_mut().skip(1).step_by(2).for_each(|a| *a = -a.clone());
                    }
                    p.iter().map(Dyadic::exact_sign).find(|s| s.is_ne()).unwrap_or(Ordering::Equal).is_lt()
                };
                beside(wall.polynomial(&ray)) && wall.sheet(&ray).is_none_or(beside)
            },
        )
    }

    /// Pushes the roots of a wall strictly between two heights.
    fn wall_roots(
        &self,
        i: usize,
        ray: &LocalRay<'_>,
        probe: &Probe<'_>,
        between: Option<(&Crossing, &Crossing)>,
        out: &mut Out<'_>,
    ) {
        let wall = &self.walls[i];
        let keeps = |root: &Root| {
            let after = |c: &Crossing, later: bool| {
                if root.lo > c.hi {
                    return later;
                }
                if root.hi < c.lo {
                    return !later;
                }
                // Decides by the exact sign of the root's height above the plane.
                let level =
                    if core::ptr::eq(c, between.map_or(c, |b| b.0)) == (c.sign > 0) { i } else { i + 1 };
                let Some(ray) = ray.in_ring_from::<Dyadic>(self.frame.centre, self.frame.scale) else {
                    return true;
                };
                let level = self.level(level);
                let Some(height) = level.height(&ray) else { return true };
                let q = Quadratic { a: Dyadic::exact(0.0), b: level.slope(&ray).scale2(-1), c: height };
                match wall.sign_at_root(probe.ray.local(), root, &q) {
                    Some(sign) => {
                        sign == if later == (c.sign > 0) { Ordering::Greater } else { Ordering::Less }
                    }
                    None => true,
                }
            };
            between.is_none_or(|(entry, exit)| after(entry, true) && after(exit, false))
                && wall.holds(probe, root)
        };
        let mut keeping = Keeping { out, keeps: &keeps, wall: i };
        match wall {
            Wall::Cubic(w) => polynomial_surface::roots(w, ray, &mut keeping),
            Wall::Spindle(w) => polynomial_surface::roots(w, ray, &mut keeping),
        }
    }
}

/// A ray and the axis: their squared distance is `a s² + 2 b s + c`, in units.
struct Axial<'a> {
    ray: &'a CentredRay<'a>,
    a: f64,
    b: f64,
    c: f64,
}

impl<'a> Axial<'a> {
    #[inline(always)]
    fn new(ray: &'a CentredRay<'a>) -> Self {
        let (o, d) = (ray.o, ray.d);
        Self { ray, a: d.x * d.x + d.z * d.z, b: o.x * d.x + o.z * d.z, c: o.x * o.x + o.z * o.z }
    }

    /// Whether the ray certainly misses a wall of this radius between the two heights that bound
    /// it: everywhere there it is farther from the axis.
    ///
    /// With `p >= |o| + |s| |d|` the sums are wrong by `5 U p²` at most, and by less than a
    /// rounding since `s` is not exactly the least point; coordinates that are wrong by `e` change
    /// the square by `2 (p + e) e` at most.
    #[inline(always)]
    fn misses(&self, reach: f64, entry: &Crossing, exit: &Crossing) -> bool {
        let (low, high) = (entry.s_lo.min(exit.s_lo), entry.s_hi.max(exit.s_hi));
        let s = (-self.b / self.a).max(low).min(high);
        let square = (self.a * s + 2.0 * self.b) * s + self.c;
        let sum = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
        let p = sum(self.ray.o) + s.abs() * sum(self.ray.d);
        let e = sum(self.ray.o_err) + s.abs() * sum(self.ray.d_err);
        square - (p * p * (16.0 * U) + (p + e) * e * 4.0) > reach * reach * (1.0 + 4.0 * U)
    }
}

/// Passes roots on to a sink, in order.
struct Out<'k> {
    sink: &'k mut dyn Sink,
    least: f64,
    stopped: bool,
}

impl Out<'_> {
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        let t = root.t.max(self.least);
        self.least = t;
        let flow = self.sink.push(Root { t, hi: root.hi.max(t), ..root });
        self.stopped = flow.is_break();
        flow
    }
}

/// Keeps the roots of a wall's polynomial that are on the solid.
struct Keeping<'a, 'k> {
    out: &'a mut Out<'k>,
    keeps: &'a dyn Fn(&Root) -> bool,
    wall: usize,
}

impl Sink for Keeping<'_, '_> {
    fn range(&self) -> (f64, f64) {
        self.out.sink.range()
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if (self.keeps)(&root) {
            self.out.push(Root { tag: [self.wall as f64, 0.0], ..root })
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl Surface for SurfaceOfRevolution {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.frame.centre, scale2(self.frame.reach, self.frame.scale)) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        if root.tag[1] == 0.0 {
            return match self.walls.get(root.tag[0] as usize) {
                Some(Wall::Cubic(w)) => polynomial_surface::resolve(w, ray, root, need),
                Some(Wall::Spindle(w)) => polynomial_surface::resolve(w, ray, root, need),
                // Not a root of this surface: nothing can be computed.
                None => SurfacePoint::unknown(self.frame.centre),
            };
        }
        let i = (root.tag[0] as usize).min(self.walls.len());
        let (probe, level) = (self.probe(ray), self.level(i));
        let n = Vec3::Y * root.tag[1];
        let lift = scale2(level.centre - level.height, -level.scale);
        let (p, dp) = planar::foot_point(&probe, &level, Vec3::Y, 1.0, lift);
        // Exactly at the height: the projection onto the plane has rounded.
        let p = Point3::new(p.x, level.height, p.z);
        let off = planar::clearance(&level, p, self.frame.centre, self.frame.scale, 1.0);
        let mut point = SurfacePoint::new(p, dp, off, n.to_normal());
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            (point.uv, point.dpdu, point.dpdv) = ([p.x, p.z], Vec3::X, Vec3::Z);
        }
        point
    }

    fn solidity(&self) -> Solidity {
        if self.open { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.open {
            return Side::Out;
        }
        let last = self.walls.len();
        let line = PointLine::new(point, Vec3::ZERO, self.frame.centre, self.frame.scale);
        let above = |i: usize| line.side_of(&self.level(i));
        let Some(i) = (0..=last).rev().find(|&i| above(i).is_none_or(Ordering::is_ge)) else {
            return Side::Out;
        };
        let at_height = above(i).is_none_or(Ordering::is_eq);
        if i == last && !at_height {
            return Side::Out;
        }
        let side = |i: usize| self.walls.get(i).map_or(Side::Out, |w| w.side(point));
        let upper = side(i);
        if !at_height {
            return upper;
        }
        let lower = if i == 0 { Side::Out } else { side(i - 1) };
        if upper == lower { upper } else { Side::On }
    }
}

impl Accelerate for SurfaceOfRevolution {
    fn name(&self) -> &'static str {
        "surface of revolution"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        let walls = self.walls.iter().zip(&self.widths);
        let reach = self.widths.iter().copied().fold(0.0, f64::max);
        // A wall that is almost a line is treated as a wider one.
        let walls: Option<Vec<_>> =
            walls.map(|(wall, &width)| wall.for_lanes(width.max(reach * pow2(-10)))).collect();
        match walls {
            Some(walls) => {
                let lathe = RevolutionKernel::new(&walls, !self.open);
                FilterSource::kernel(self.bounds, lathe, self.frame.centre, self.frame.scale, [0, 1, 2])
            }
            None => FilterSource::vague(self.bounds),
        }
    }
}

impl Algebraic for SurfaceOfRevolution {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        if root.tag[1] == 0.0 {
            return self.walls.get(root.tag[0] as usize)?.sign_at_root(ray, root, q);
        }
        let level = self.level((root.tag[0] as usize).min(self.walls.len()));
        let exact = ray.in_ring_from::<Dyadic>(self.frame.centre, self.frame.scale)?;
        level.sign_at_root(&exact, q)
    }
}

#[cfg(test)]
mod tests;
