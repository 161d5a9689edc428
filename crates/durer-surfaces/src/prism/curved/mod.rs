//! The prism with curved walls: outlines of cubic curves in the xz plane, swept along y, or towards
//! a point.
//!
//! ```text
//!       linear                conic
//!       .--.  top            .--.  top
//!      (    )                 \  /          a point c(u) = <x, z> of an outline sweeps
//!      |`--'|                  \/  apex     <x, y, z>       (linear)
//!      (    )                               <x y, y, z y>   (conic)
//!       `--'  bottom                        for bottom <= y <= top
//! ```
//!
//! A ray and the direction of the sweep, or its apex, span a plane, which cuts the plane of the
//! outlines in a line. Where that line meets an outline, a cubic in `u` vanishes
//! (`profile_hits.rs`), and a quotient of two cubics gives the parameter on the ray
//! (`parameter.rs`). A point is inside where the outlines go round it an odd number of times. A cap
//! is hit where the line has met the outlines an odd number of times before it; this uses the same
//! signs as the walls. So the solid is closed: every line crosses it inward and outward in turn.
//!
//! J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", SIGGRAPH 1983; J.
//! J. van Wijk, "Ray tracing objects defined by sweeping planar cubic splines", *ACM Transactions
//! on Graphics* 3, 1984.

mod compare;
mod crossings;
pub(crate) mod exact;
mod forms;
mod parameter;
mod point;
pub(crate) mod profile_curve;
pub(crate) mod profile_hits;
mod self_intersection;
mod spline;

use super::packet::{ProfileCurve8, Sweep8, Swept};
use super::{PrismError, Sweep};
use crate::packet::FilterSource;
use crate::planar::{self, Line, PointLine, Probe};
use crate::revolution::level::HeightPlane;
use crate::{
    Accelerate, Algebraic, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::{exponent, scale2};
use durer_math::rounding::{mul_down, mul_up};
use durer_math::{Aabb, Dyadic, EFloat, Point3, Vec3};
use durer_roots::quadratic::Quadratic;
use forms::{Coordinate, Cut};
use point::Wall;
pub(crate) use profile_curve::greatest;
use profile_curve::{ProfileCurve, View};
use profile_hits::{Meet, Scan};
pub use spline::{Bezier, Spline};

/// A solid between two planes across y, within curved outlines that are swept from one to the
/// other; without its caps a sheet.
///
/// Faces: 0 the walls, 1 the cap at the bottom, 2 the cap at the top, or a tip in their place.
/// Parts: the walls of the pieces, then the caps. A tangled prism is one part, since its signs
/// alternate along the whole line.
///
/// # Invariants
///
/// Each outline is closed: a piece begins where the one before it ends.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvedPrism {
    pieces: Vec<ProfileCurve>,
    /// For each piece, whether the inside is to its left, with x to the right and z up; `None` if
    /// the outlines may meet themselves or each other, so that no side is certain.
    inside_is_left: Option<Vec<bool>>,
    /// The bottom and the top.
    heights: [f64; 2],
    /// The bounding box of each wall.
    boxes: Vec<Aabb>,
    /// The bounding boxes of the bottom and the top.
    cap_boxes: [Aabb; 2],
    open: bool,
    view: View,
    /// The size, in units.
    size: f64,
    bounds: Aabb,
}

/// Products of larger numbers could leave the range of f64.
const LARGEST: f64 = durer_math::scale::pow2(200);

impl CurvedPrism {
    /// The prism between the heights `bottom` and `top` (in any order) within these outlines. Each
    /// piece must begin where the one before it ends, the first one where the last one ends.
    pub fn linear(outlines: &[impl AsRef<[Bezier]>], bottom: f64, top: f64) -> Result<Self, PrismError> {
        Self::new(outlines, bottom, top, Sweep::Linear)
    }

    /// The conic prism, whose outlines at the height `y` are scaled by `y`: a cone with its apex at
    /// the origin, a frustum, or two cones that meet.
    pub fn conic(outlines: &[impl AsRef<[Bezier]>], bottom: f64, top: f64) -> Result<Self, PrismError> {
        Self::new(outlines, bottom, top, Sweep::Conic)
    }

    fn new(
        outlines: &[impl AsRef<[Bezier]>],
        bottom: f64,
        top: f64,
        sweep: Sweep,
    ) -> Result<Self, PrismError> {
        let (low, high) = super::ascending(bottom, top)?;
        let outlines = closed(outlines)?;
        // The box of a piece swept between two heights, rounded outward.
        let swept = |b: &Bezier, [low, high]: [f64; 2]| {
            let [x, z] = profile_curve::extent(b).map(|[min, max]| match sweep {
                Sweep::Linear => [min, max],
                Sweep::Conic => {
                    let pairs = [(min, low), (min, high), (max, low), (max, high)];
                    [
                        pairs.iter().fold(f64::INFINITY, |m, &(x, y)| m.min(mul_down(x, y))),
                        pairs.iter().fold(f64::NEG_INFINITY, |m, &(x, y)| m.max(mul_up(x, y))),
                    ]
                }
            });
            Aabb::new(Point3::new(x[0], low, z[0]), Point3::new(x[1], high, z[1]))
        };
        let boxes: Vec<Aabb> = outlines.iter().flatten().map(|b| swept(b, [low, high])).collect();
        let cap_boxes = [low, high]
            .map(|y| outlines.iter().flatten().map(|b| swept(b, [y, y])).fold(Aabb::EMPTY, Aabb::union));
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let wide = outlines.iter().flatten().flatten().flatten().any(|x| x.abs() >= LARGEST);
        let too_large = || PrismError::TooLarge(if low.abs() > high.abs() { low } else { high });
        if !bounds.is_bounded() || bounds.magnitude() >= LARGEST || wide {
            return Err(too_large());
        }
        let (centre, size) = match sweep {
            Sweep::Linear => planar::middle(&bounds),
            Sweep::Conic => (Point3::ORIGIN, bounds.magnitude()),
        };
        let view = View { sweep, centre, scale: exponent(size) + 1 };
        let pieces: Vec<ProfileCurve> =
            outlines.iter().flatten().map(|&b| ProfileCurve::new(b, &view)).collect();
        let size = scale2(planar::middle(&bounds).1, -view.scale);
        let mut prism = Self {
            pieces,
            inside_is_left: None,
            heights: [low, high],
            boxes,
            cap_boxes,
            open: false,
            view,
            size,
            bounds,
        };
        prism.inside_is_left = prism.sides(&outlines);
        Ok(prism)
    }

    /// For each piece, whether the inside is to its left.
    fn sides(&self, outlines: &[Vec<Bezier>]) -> Option<Vec<bool>> {
        if !self_intersection::are_simple(outlines) {
            return None;
        }
        let mut left = Vec::with_capacity(self.pieces.len());
        for outline in outlines {
            let own = left.len()..left.len() + outline.len();
            let pieces = &self.pieces[own.clone()];
            let powers = |piece: &ProfileCurve| piece.in_powers::<EFloat>(&self.view);
            let exact = |piece: &ProfileCurve| piece.in_powers::<Dyadic>(&self.view);
            let turn = self_intersection::turn(pieces.iter().map(powers))
                .or_else(|| self_intersection::turn(pieces.iter().map(exact)))?;
            // Without an area, the outline has no inside.
            if turn.is_eq() {
                return None;
            }
            let turns_left = turn.is_gt();
            // Is it within an odd number of the others?
            let [x, z] = outline[0][0];
            let start = LocalPoint::new(Point3::new(x, 1.0, z));
            let line = PointLine::new(&start, Vec3::ZERO, self.view.centre, self.view.scale);
            let scan = Scan::new(&line, &self.view, Cut::Start { positive: true });
            let others = self.pieces.iter().enumerate().filter(|(i, _)| !own.contains(i));
            let within = others.fold(false, |odd, (_, piece)| odd ^ scan.is_odd_behind(piece));
            left.extend(outline.iter().map(|_| turns_left != within));
        }
        Some(left)
    }

    /// Removes the caps.
    #[must_use]
    pub fn without_caps(mut self) -> Self {
        self.open = true;
        self
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        Probe::with_scale(ray, self.view.centre, self.view.scale, self.size)
    }

    #[inline(always)]
    fn level(&self, top: bool) -> HeightPlane {
        HeightPlane {
            height: self.heights[usize::from(top)],
            centre: self.view.centre.y,
            scale: self.view.scale,
        }
    }

    /// Whether the sweep ends at the top (or bottom) in its apex instead of a cap.
    #[inline(always)]
    fn has_tip(&self, top: bool) -> bool {
        self.view.sweep == Sweep::Conic && self.heights[usize::from(top)] == 0.0
    }
}

/// Checks the outlines, and removes pieces that are single points.
fn closed(outlines: &[impl AsRef<[Bezier]>]) -> Result<Vec<Vec<Bezier>>, PrismError> {
    if outlines.is_empty() {
        return Err(PrismError::Empty);
    }
    let clean = |(outline, pieces): (usize, &[Bezier])| {
        if let Some(&[x, z]) = pieces.iter().flatten().find(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(PrismError::Point { x, z });
        }
        let after = pieces.iter().cycle().skip(1);
        if let Some(piece) = pieces.iter().zip(after).position(|(a, b)| a[3] != b[0]) {
            return Err(PrismError::Gap { outline, piece });
        }
        let pieces: Vec<Bezier> = pieces.iter().filter(|b| b.iter().any(|p| *p != b[0])).copied().collect();
        if pieces.is_empty() {
            return Err(PrismError::TooShort { outline, len: 1 });
        }
        Ok(pieces)
    };
    outlines.iter().map(AsRef::as_ref).enumerate().map(clean).collect()
}

impl Surface for CurvedPrism {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if ray.within(&self.bounds).is_some() {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    /// Texture coordinates: on the walls from 0 to 1 round all outlines, piece by piece, and from
    /// the bottom to the top; on the caps lengths.
    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        if root.face == 0 {
            let number = root.tag[0] as usize;
            let Some(piece) = self.pieces.get(number / 2) else {
                return SurfacePoint::unknown(self.view.centre);
            };
            let wall = Wall {
                view: &self.view,
                piece,
                inside_is_left: number % 2 == 1,
                number: (number / 2, self.pieces.len()),
                heights: self.heights,
            };
            return wall.resolve(ray, root, root.tag[1], need);
        }
        let (probe, top) = (self.probe(ray), root.face == 2);
        let level = self.level(top);
        let lift = scale2(level.centre - level.height, -level.scale);
        let (p, dp) = planar::foot_point(&probe, &level, Vec3::Y, 1.0, lift);
        // Exactly at the height: the projection onto the plane has rounded.
        let p = Point3::new(p.x, level.height, p.z);
        let off = planar::clearance(&level, p, self.view.centre, self.view.scale, 1.0);
        let n = if top { Vec3::Y } else { -Vec3::Y };
        let mut point = SurfacePoint::new(p, dp, off, n.to_normal());
        if self.has_tip(top) {
            point.bend = f64::INFINITY;
        }
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
        let line = PointLine::new(point, Vec3::ZERO, self.view.centre, self.view.scale);
        let above = |top: bool| line.side_of(&self.level(top)).unwrap_or(Ordering::Equal);
        let (bottom, top) = (above(false), above(true));
        if bottom.is_lt() || top.is_gt() {
            return Side::Out;
        }
        let positive = match self.view.sweep {
            Sweep::Linear => true,
            Sweep::Conic => match line.sign(&self.level_at_apex()).unwrap_or(Ordering::Equal) {
                Ordering::Greater => true,
                Ordering::Less => false,
                // At the apex's height the solid is only the apex.
                Ordering::Equal => {
                    let on_axis =
                        [0, 2].iter().all(|&i| line.sign(&Coordinate(i)).is_none_or(Ordering::is_eq));
                    return if on_axis { Side::On } else { Side::Out };
                }
            },
        };
        let scan = Scan::new(&line, &self.view, Cut::Start { positive });
        if self.pieces.iter().any(|piece| scan.touches(piece)) {
            return Side::On;
        }
        match self.pieces.iter().fold(false, |odd, piece| odd ^ scan.is_odd_behind(piece)) {
            false => Side::Out,
            true if bottom.is_eq() || top.is_eq() => Side::On,
            true => Side::In,
        }
    }
}

impl Accelerate for CurvedPrism {
    fn name(&self) -> &'static str {
        "prism"
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        self.inside_is_left.is_some()
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        if self.inside_is_left.is_none() {
            return f(self.bounds, PartId(0));
        }
        let caps = self.cap_boxes.into_iter().filter(|_| !self.open);
        for (bounds, number) in self.boxes.iter().copied().chain(caps).zip(0..) {
            f(bounds, PartId(number));
        }
    }

    fn packet_filter(&self, PartId(part): PartId) -> FilterSource {
        let View { centre, scale, .. } = self.view;
        let sweep = self.sweep_for_lanes();
        let number = part as usize;
        let Some(left) = &self.inside_is_left else { return self.solid_packet_filter().0 };
        let mut boxes = self.boxes.iter().chain(&self.cap_boxes);
        let Some(&bounds) = boxes.nth(number) else { return FilterSource::vague(self.bounds) };
        let part = match number.checked_sub(self.pieces.len()) {
            None => Swept::Wall { curve: self.pieces[number].for_lanes(), sweep, left: left[number] },
            // A tip is a point.
            Some(cap) if self.has_tip(cap > 0) => return FilterSource::vague(bounds),
            Some(cap) => Swept::Cap { curves: self.curves_for_lanes(), sweep, top: cap > 0 },
        };
        FilterSource::kernel(bounds, part, centre, scale, [0, 1, 2])
    }

    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        // The filter would have to count the missing caps, too.
        if self.open {
            return (FilterSource::vague(self.bounds), vec![PartId(0)]);
        }
        let left = self.inside_is_left.as_deref().map(Box::from);
        let faces = if left.is_some() { self.pieces.len() as u32 + 2 } else { 1 };
        let whole = Swept::Whole { curves: self.curves_for_lanes(), sweep: self.sweep_for_lanes(), left };
        let View { centre, scale, .. } = self.view;
        (FilterSource::kernel(self.bounds, whole, centre, scale, [0, 1, 2]), (0..faces).map(PartId).collect())
    }

    #[inline(always)]
    fn part_roots<S: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut S) {
        self.roots_of_part(part, ray, &mut Forward(sink));
    }
}

impl CurvedPrism {
    fn curves_for_lanes(&self) -> Box<[ProfileCurve8]> {
        self.pieces.iter().map(ProfileCurve::for_lanes).collect()
    }

    fn sweep_for_lanes(&self) -> Sweep8 {
        let View { sweep, centre, scale } = self.view;
        let [low, high] = self.heights.map(|y| scale2(y - centre.y, -scale));
        Sweep8 { conic: sweep == Sweep::Conic, low, high }
    }

    fn level_at_apex(&self) -> HeightPlane {
        HeightPlane { height: 0.0, centre: self.view.centre.y, scale: self.view.scale }
    }
}

impl Algebraic for CurvedPrism {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let exact = ray.in_ring_from::<Dyadic>(self.view.centre, self.view.scale)?;
        if root.face == 0 {
            let piece = self.pieces.get(root.tag[0] as usize / 2)?;
            let probe = self.probe(ray);
            let scan = Scan::new(&probe, &self.view, Cut::Ray);
            // Find the crossing again: the same numbers give the same root; if this ray has other
            // errors, take the nearest.
            let mut found: Option<Meet> = None;
            scan.meets(piece, |meet| {
                let way = |m: &Meet| (m.y - root.tag[1]).abs();
                if found.as_ref().is_none_or(|best| way(&meet) < way(best)) {
                    found = Some(meet);
                }
            });
            // The centre and its unit are the same, the parameter is the ray's own, and the curve's
            // parameter does not depend on it.
            return parameter::sign_at(&scan, &exact, piece, &found?, [&q.a, &q.b, &q.c]);
        }
        self.level(root.face == 2).sign_at_root(&exact, q)
    }
}

#[cfg(test)]
mod tests;
