//! The axis-aligned box: three slabs.
//!
//! ```text
//!        ┌────────┐ hi        lo_i <= p_i <= hi_i   for i = x, y, z
//!     ───●────────●───▶
//!     lo └────────┘           entry: the last slab entered,  exit: the first slab left
//! ```
//!
//! T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986, made exact: the ratios
//! `(lo_i - o_i) / d_i` are compared as brackets, and where brackets overlap by the sign of
//! `n_i d_j - n_j d_i`. Ties of the entry (the ray comes in through an edge) go to the first axis;
//! a line that only touches an edge or a corner meets the box in one grazing root; a line within a
//! face enters and leaves through the other slabs, since the box is closed.

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::planar::{self, AlongRay, Crossing, Line, PlaneForm, PointLine, Probe};
use crate::point::least_step;
use crate::{
    Accelerate, CentredRay, LocalPoint, LocalRay, Need, PartId, RingRay, Root, RootKind, Side, Sink,
    Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, Isa, Normal3, Point3, RaySide, Ring, U, Vec3};
use durer_roots::quadratic::Quadratic;

/// A solid box with faces across the axes. Face `2 i` is the one at the least coordinate of axis
/// `i`, face `2 i + 1` the opposite one.
///
/// # Invariants
///
/// All coordinates are finite and the box has a width along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBox {
    min: Point3,
    max: Point3,
}

/// Why an [`AxisBox`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AxisBoxError {
    /// A corner is infinite or NaN.
    #[error("box: a corner must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Corner(Point3),
    /// The corners agree in a coordinate.
    #[error("box: the corners must differ in x, y and z, both have {axis} = {at}", axis = ["x", "y", "z"][*axis as usize])]
    Flat {
        /// Which coordinate: 0, 1 or 2.
        axis: u8,
        /// Its value.
        at: f64,
    },
}

/// One face's plane. Its normal is `+axis` for both faces of a slab; the sign is set by
/// [`AxisBox`].
#[derive(Clone, Copy)]
struct SlabPlane {
    axis: usize,
    at: f64,
    centre: f64,
    scale: i32,
}

impl PlaneForm for SlabPlane {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<planar::Quick> {
        let n = Vec3::from(core::array::from_fn(|i| if i == self.axis { 1.0 } else { 0.0 }));
        let level = level(self);
        Some(planar::Quick::new((n, Vec3::ZERO), (ray.o, ray.o_err), (-level, level.abs() * U), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        ray.d[self.axis].clone()
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let level = (T::exact(self.at) - T::exact(self.centre)).scale2(-self.scale);
        Some(ray.o[self.axis].clone() - level * ray.w.clone())
    }
}

/// `s_a - s_b` times the two slopes: which of two crossings comes first.
struct Later(SlabPlane, SlabPlane);

impl AlongRay for Later {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let Self(a, b) = self;
        Some(b.height(ray)? * a.slope(ray) - a.height(ray)? * b.slope(ray))
    }
}

/// The height above a face, for lines along it.
struct Height(SlabPlane);

impl AlongRay for Height {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        self.0.height(ray)
    }
}

/// A ray's entry into a slab, or its exit, in f64: the face and a bracket of the parameter.
#[derive(Clone, Copy)]
struct Passage {
    number: u32,
    s: f64,
    lo: f64,
    hi: f64,
}

/// The filter takes directions of which each component is known this well: then the second order of
/// their error is `STEEP` times the first.
const STEEP: f64 = 1.0 / (1u64 << 20) as f64;

/// The data of the filter.
enum Quick {
    /// The ray misses the box.
    Miss,
    /// The ray enters and leaves through these faces.
    Through(Passage, Passage),
    /// Too close to an edge, a face or a corner, or numbers too wild: to be decided exactly.
    Unsure,
}

/// A ray's entry into a slab, or its exit.
#[derive(Clone, Copy)]
struct Event {
    face: SlabPlane,
    /// The number of the face in the box.
    number: u32,
    crossing: Crossing,
}

impl AxisBox {
    /// The box between two opposite corners, in any order.
    pub fn new(a: Point3, b: Point3) -> Result<Self, AxisBoxError> {
        for corner in [a, b] {
            if !corner.is_finite() {
                return Err(AxisBoxError::Corner(corner));
            }
        }
        for axis in 0..3u8 {
            let at = a[usize::from(axis)];
            if at == b[usize::from(axis)] {
                return Err(AxisBoxError::Flat { axis, at });
            }
        }
        let Aabb { min, max, .. } = Aabb::from_points([a, b]);
        Ok(Self { min, max })
    }

    /// The least coordinates.
    pub fn min(&self) -> Point3 {
        self.min
    }

    /// The greatest coordinates.
    pub fn max(&self) -> Point3 {
        self.max
    }

    #[inline(always)]
    fn centre(&self) -> Point3 {
        // Halves first: no overflow.
        self.min.map(|x| 0.5 * x) + self.max.map(|x| 0.5 * x).to_vec()
    }

    /// Half the largest width.
    #[inline(always)]
    fn size(&self) -> f64 {
        (self.max.map(|x| 0.5 * x) - self.min.map(|x| 0.5 * x)).max_abs()
    }

    #[inline(always)]
    fn scale(&self) -> i32 {
        exponent(self.size()) + 1
    }

    #[inline(always)]
    fn face(&self, number: u32) -> SlabPlane {
        let axis = (number / 2) as usize;
        let at = if number & 1 == 0 { self.min[axis] } else { self.max[axis] };
        SlabPlane { axis, at, centre: self.centre()[axis], scale: self.scale() }
    }

    /// The slabs in f64, each quotient with its error.
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Quick {
        let none = |s: f64| Passage { number: 0, s, lo: s, hi: s };
        let (mut entry, mut exit) = (none(f64::NEG_INFINITY), none(f64::INFINITY));
        // The next brackets beside them, which must not overlap theirs.
        let (mut entry_rival, mut exit_rival) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (o, o_err, d, d_err) = (ray.o[axis], ray.o_err[axis], ray.d[axis], ray.d_err[axis]);
            let gap = |at: f64| {
                let level = scale2(at - ray.centre[axis], -ray.scale);
                let gap = level - o;
                // One rounding of the level, one of the gap.
                (gap, (level.abs() + gap.abs()).mul_add(U, o_err))
            };
            let (low, high) = (gap(self.min[axis]), gap(self.max[axis]));
            if d == 0.0 && d_err == 0.0 {
                // Twice the bound pays for its own rounding.
                if low.0 < -2.0 * low.1 && high.0 > 2.0 * high.1 {
                    continue;
                }
                return Quick::Unsure;
            }
            let inverse = 1.0 / d;
            let turn = d_err * inverse.abs();
            let passage = |number: u32, (gap, err): (f64, f64)| {
                let s = gap * inverse;
                // The direction's error, and three roundings: of the inverse, of the product and of
                // the ends below.
                let err = err.mul_add(inverse.abs(), s.abs() * (turn + 3.0 * U));
                let err = err.mul_add(1.0 + 4.0 * STEEP, planar::TINY);
                Passage { number, s, lo: s - err, hi: s + err }
            };
            let number = 2 * axis as u32;
            let (low, high) = (passage(number, low), passage(number + 1, high));
            let (near, far) = if d > 0.0 { (low, high) } else { (high, low) };
            let tame = near.lo.is_finite() && near.hi.is_finite() && far.lo.is_finite() && far.hi.is_finite();
            if !(turn <= STEEP && tame) {
                return Quick::Unsure;
            }
            if near.lo > entry.lo {
                entry_rival = entry_rival.max(entry.hi);
                entry = near;
            } else {
                entry_rival = entry_rival.max(near.hi);
            }
            if far.hi < exit.hi {
                exit_rival = exit_rival.min(exit.lo);
                exit = far;
            } else {
                exit_rival = exit_rival.min(far.lo);
            }
        }
        if entry.lo > exit.hi {
            Quick::Miss
        } else if entry.hi < exit.lo && entry.lo > entry_rival && exit.hi < exit_rival && entry.s.is_finite()
        {
            Quick::Through(entry, exit)
        } else {
            Quick::Unsure
        }
    }

    /// The ray's entry and exit, if it meets the box at all, and whether they are the same point.
    #[inline(always)]
    fn span(&self, probe: &Probe<'_>) -> Option<(Event, Event, bool)> {
        match self.quick(&probe.ray) {
            Quick::Miss => None,
            Quick::Through(entry, exit) => {
                let event = |passage: Passage, sign: i8| {
                    let face = self.face(passage.number);
                    let crossing = probe.refined(&face, passage.s, passage.lo, passage.hi, sign)?;
                    Some(Event { face, number: passage.number, crossing })
                };
                let sign = |p: &Passage| if probe.ray.d[(p.number / 2) as usize] > 0.0 { 1 } else { -1 };
                Some((event(entry, sign(&entry))?, event(exit, sign(&exit))?, false))
            }
            Quick::Unsure => self.exact_span(probe),
        }
    }

    #[cold]
    #[inline(never)]
    fn exact_span(&self, probe: &Probe<'_>) -> Option<(Event, Event, bool)> {
        Isa::detect().run(
            #[inline(always)]
            || {
                let mut span: Option<(Event, Event)> = None;
                for axis in 0..3 {
                    let (low, high) = (2 * axis, 2 * axis + 1);
                    let event = |number| {
                        let face = self.face(number);
                        Some(Event { face, number, crossing: probe.crossing(&face)? })
                    };
                    let Some(first) = event(low) else {
                        if self.lies_between(probe, low) {
                            continue;
                        }
                        return None;
                    };
                    let second = event(high)?;
                    let (near, far) = if first.crossing.sign > 0 { (first, second) } else { (second, first) };
                    span = Some(match span {
                        None => (near, far),
                        Some((entry, exit)) => (
                            if later(probe, &near, &entry).is_gt() { near } else { entry },
                            if later(probe, &far, &exit).is_lt() { far } else { exit },
                        ),
                    });
                }
                let (entry, exit) = span?;
                match later(probe, &entry, &exit) {
                    Ordering::Less => Some((entry, exit, false)),
                    Ordering::Equal => Some((entry, exit, true)),
                    Ordering::Greater => None,
                }
            },
        )
    }

    /// Whether a line across an axis runs within that axis's slab, faces included.
    #[cold]
    #[inline(never)]
    fn lies_between(&self, probe: &Probe<'_>, low: u32) -> bool {
        Isa::detect().run(
            #[inline(always)]
            || {
                probe.sign(&Height(self.face(low))).is_none_or(Ordering::is_ge)
                    && probe.sign(&Height(self.face(low + 1))).is_none_or(Ordering::is_le)
            },
        )
    }
}

/// The order of two crossings along the ray, exactly.
#[inline(always)]
fn later(probe: &Probe<'_>, a: &Event, b: &Event) -> Ordering {
    if a.crossing.s_lo > b.crossing.s_hi {
        return Ordering::Greater;
    }
    if a.crossing.s_hi < b.crossing.s_lo {
        return Ordering::Less;
    }
    if a.number == b.number {
        return Ordering::Equal;
    }
    later_climb(probe, a, b)
}

#[cold]
#[inline(never)]
fn later_climb(probe: &Probe<'_>, a: &Event, b: &Event) -> Ordering {
    Isa::detect().run(
        #[inline(always)]
        || {
            match probe.sign(&Later(a.face, b.face)) {
                Some(order) if a.crossing.sign == b.crossing.sign => order,
                Some(order) => order.reverse(),
                // Only for rays that are not exactly known: the line may touch the edge between the
                // two faces.
                None => Ordering::Equal,
            }
        },
    )
}

impl Surface for AxisBox {
    fn bounds(&self) -> Aabb {
        Aabb::new(self.min, self.max)
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        // A ray that was spawned on a face and goes away from it has left the box.
        let spawned = ray.source.filter(|_| ray.t_min == 0.0);
        if spawned == Some(RaySide::Front) {
            let axis = (ray.source_face / 2 % 3) as usize;
            let away = if ray.source_face & 1 == 0 { -ray.d[axis] } else { ray.d[axis] };
            if away > ray.d_err[axis] {
                return;
            }
        }
        let probe = Probe::new(ray, self.centre(), self.size());
        let Some((mut entry, mut exit, touches)) = self.span(&probe) else { return };
        // The entry is known to come first: brackets that overlap are told so, and with them the
        // numbers within.
        if entry.crossing.s_hi >= exit.crossing.s_lo {
            let (e, x) = (&mut entry.crossing, &mut exit.crossing);
            (x.s_lo, e.s_hi) = (x.s_lo.max(e.s_lo), e.s_hi.min(x.s_hi));
            (x.lo, e.hi) = (x.lo.max(e.lo), e.hi.min(x.hi));
            e.s = e.s.max(e.s_lo).min(e.s_hi);
            x.s = x.s.max(x.s_lo).min(x.s_hi).max(e.s);
        }
        for (event, sign) in [(entry, -1), (exit, 1)] {
            let crossing = &event.crossing;
            if sign < 0 && !touches && spawned == Some(RaySide::Back) && event.number == ray.source_face {
                // It came in before it was spawned.
                continue;
            }
            if probe.may_admit(crossing)
                && !crossing.is_outside(sink.range())
                && probe.admits(&event.face, crossing)
            {
                let root = probe.root(crossing, event.number, [0.0; 2]);
                let root = if touches {
                    Root { sign: 0, kind: RootKind::Grazing, ..root }
                } else {
                    Root { sign, ..root }
                };
                if sink.push(root).is_break() {
                    return;
                }
            }
            if touches {
                return;
            }
        }
    }

    /// Texture coordinates run from 0 to 1 over each face, along the two other axes in cyclic
    /// order.
    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let probe = Probe::new(ray, self.centre(), self.size());
        let face = self.face(root.face);
        let (axis, outward) = (face.axis, if root.face & 1 == 0 { -1.0 } else { 1.0 });
        let along = |i: usize| if i == axis { 1.0 } else { 0.0 };
        let normal = Vec3::new(along(0), along(1), along(2));
        let (p, dp) = planar::foot_point(&probe, &face, normal, 1.0, -level(&face));
        // On the face exactly, and within it: moving a point into a convex set brings it no farther
        // from the set's points.
        let (low, high) = (self.min, self.max);
        let mut p =
            Point3::new(p.x.max(low.x).min(high.x), p.y.max(low.y).min(high.y), p.z.max(low.z).min(high.z));
        p[axis] = face.at;
        let mut dp = dp;
        dp[axis] = 0.0;
        // The face is a plane of numbers: the next one lies off it.
        let off = least_step(p);
        let ng = (normal * outward).to_normal();
        let mut point = SurfacePoint::new(p, dp, off, ng);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let width = |i: usize| self.max[i] - self.min[i];
            point.uv = [(p[a] - self.min[a]) / width(a), (p[b] - self.min[b]) / width(b)];
            point.dpdu[a] = width(a);
            point.dpdv[b] = width(b);
        }
        point
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        let point = PointLine::new(point, Vec3::ZERO, self.centre(), self.scale());
        let mut on = false;
        for number in 0..6 {
            let side = point.side_of(&self.face(number));
            let inward = if number & 1 == 0 { side } else { side.map(Ordering::reverse) };
            match inward {
                Some(Ordering::Less) => return Side::Out,
                Some(Ordering::Greater) => {}
                Some(Ordering::Equal) | None => on = true,
            }
        }
        if on { Side::On } else { Side::In }
    }
}

impl Accelerate for AxisBox {
    fn name(&self) -> &'static str {
        "box"
    }

    fn inner_bounds(&self) -> Aabb {
        self.bounds()
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::axis_box(self.min, self.max)
    }
}

impl Algebraic for AxisBox {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let corner = if face & 1 == 0 { self.min() } else { self.max() };
        planar::plane_along(&planar::exact3(Self::normal(face).to_vec()), corner, ray)
    }
}

/// The face's place relative to the centre, rounded.
#[inline(always)]
fn level(face: &SlabPlane) -> f64 {
    scale2(face.at - face.centre, -face.scale)
}

impl From<AxisBox> for Aabb {
    fn from(b: AxisBox) -> Self {
        Self::new(b.min, b.max)
    }
}

impl AxisBox {
    /// The outward unit normal of face `number`.
    #[inline(always)]
    pub fn normal(number: u32) -> Normal3 {
        let outward = if number & 1 == 0 { -1.0 } else { 1.0 };
        let axis = (number / 2) as usize;
        Normal3::from(core::array::from_fn(|i| if i == axis { outward } else { 0.0 }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{ExactBody, ExactForm, Feature, TestRng, all_roots, check_many, exact3};
    use durer_math::Ray;

    fn exact(b: &AxisBox) -> ExactBody {
        let face = |i: u32| {
            let n = AxisBox::normal(i).to_vec().to_array();
            let p = if i & 1 == 0 { b.min } else { b.max };
            ExactForm::half_space(exact3(n), exact3(p.to_array()))
        };
        ExactBody::solid((0..6).map(face).collect(), b.size(), true)
    }

    /// Corners, middles of edges and of faces, with directions along the edges there.
    fn features(b: &AxisBox) -> Vec<Feature> {
        let mut out = vec![];
        for i in 0..27 {
            let part = |axis: u32| i / 3_usize.pow(axis) % 3;
            let at = core::array::from_fn(|axis| match part(axis as u32) {
                0 => b.min[axis],
                1 => b.max[axis],
                _ => 0.5 * b.min[axis] + 0.5 * b.max[axis],
            });
            let mut along = [0.0; 3];
            let axis = i % 3;
            along[axis] = b.max[axis] - b.min[axis];
            out.push(Feature::new(at, along));
            out.push(Feature::new(at, (b.max - b.min).to_array()));
        }
        out
    }

    #[test]
    fn boxes_obey_the_laws() {
        let (mut roots, mut grazing) = (0, 0);
        for seed in 0..60 {
            let mut dice = TestRng::new(seed);
            let (a, w) = match seed % 3 {
                0 => (dice.lattice(4), Vec3::new(1.0, 2.0, 4.0) * dice.power(-2, 2)),
                1 => (dice.vector(), dice.vector()),
                _ => {
                    let k = dice.power(-300, 300);
                    (dice.lattice(9) * k, dice.vector() * k * dice.power(-10, 3))
                }
            };
            let Ok(b) = AxisBox::new(a.to_point(), a.to_point() + w) else { continue };
            let tally = check_many(&b, &exact(&b), &features(&b), seed, 300);
            roots += tally.roots;
            grazing += tally.grazing;
        }
        assert!(roots > 8000 && grazing > 100, "{roots} {grazing}");
    }

    #[test]
    fn a_ray_in_a_face_enters_and_leaves_and_one_that_touches_an_edge_grazes() {
        let b = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)).unwrap();
        let within = Ray::new(Point3::new(-1.0, 0.5, 1.0), Vec3::X);
        let roots = all_roots(&b, &within);
        assert_eq!(
            roots.iter().map(|r| (r.t, r.face, r.sign)).collect::<Vec<_>>(),
            [(1.0, 0, -1), (2.0, 1, 1)]
        );
        let edge = Ray::new(Point3::new(-1.0, 1.0, 0.5), Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(all_roots(&b, &edge), []);
        let edge = Ray::new(Point3::new(-1.0, 0.0, 0.5), Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(
            all_roots(&b, &edge).iter().map(|r| (r.t, r.sign, r.kind)).collect::<Vec<_>>(),
            [(1.0, 0, RootKind::Grazing)]
        );
        // Through two opposite corners: the first axis names the faces.
        let diagonal = Ray::new(Point3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0));
        assert_eq!(all_roots(&b, &diagonal).iter().map(|r| r.face).collect::<Vec<_>>(), [0, 1]);
    }

    #[test]
    fn a_flat_box_is_named() {
        let made = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 0.0, 1.0));
        assert_eq!(made, Err(AxisBoxError::Flat { axis: 1, at: 0.0 }));
    }
}
