//! The plane, and the half-space below it.
//!
//! ```text
//!            n
//!            ^        n . p = h |n|
//!   ─────────┴──────────────────────    the surface
//!   · · · · · · · · · · · · · · · ·     inside: n . p <= h |n|
//! ```
//!
//! The surface is *exactly* this set for the stored normal `n` (of any length) and distance `h`.
//! Where `|n|` is irrational the plane has no rational point, yet every decision is rational:
//! `n . p < h |n|` is a matter of signs and of `(n . p)^2 < h^2 n . n`.

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::planar::{self, PlaneForm, PointLine, Probe, Quick, dot, exact3, scaled_to_one, unit};
use crate::point::least_step;
use crate::{
    Accelerate, CentredRay, HalfSpace, LocalPoint, LocalRay, Need, PartId, RingRay, Root, Side, Sink,
    Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::{Aabb, Dd, Dyadic, EFloat, Interval, Normal3, Point3, RaySide, Ring, Shaft, U, Vec3};
use durer_roots::quadratic::Quadratic;

/// A plane, which is also the boundary of the half-space behind it.
///
/// # Invariants
///
/// The largest component of the normal is in [1, 2) in magnitude (a positive factor of the normal
/// changes nothing), and the distance is finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Vec3,
    /// Signed distance from the origin, along the normal.
    distance: f64,
    /// `h |n|`, with its error.
    offset: EFloat<Dd>,
}

/// The plane relative to a centre, in the frame's own unit of length.
struct Seen<'a> {
    plane: &'a Plane,
    centre: Point3,
}

/// Why a [`Plane`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlaneError {
    /// The normal has no direction.
    #[error("plane: the normal must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Normal(Vec3),
    /// The distance is infinite or NaN.
    #[error("plane: the distance must be finite, got {0}")]
    Distance(f64),
}

impl Plane {
    /// The plane of the points whose distance from the origin along `normal` is `distance`. The
    /// normal may have any length.
    pub fn new(normal: Vec3, distance: f64) -> Result<Self, PlaneError> {
        let n = scaled_to_one(normal).ok_or(PlaneError::Normal(normal))?;
        if !distance.is_finite() {
            return Err(PlaneError::Distance(distance));
        }
        let offset = match rational_length(n) {
            // Only what does not fit in two f64 is rounded.
            Some(length) => rounded(&(Dyadic::exact(distance) * Dyadic::exact(length))),
            None => EFloat::exact(distance) * dot(&exact3::<EFloat<Dd>>(n), &exact3(n)).sqrt(),
        };
        Ok(Self { normal: n, distance, offset })
    }

    /// The normal, scaled by a power of two.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// An interval that holds `h |n|`.
    pub(crate) fn offset_bounds(&self) -> Interval {
        Interval::new(self.offset.lo(), self.offset.hi())
    }

    /// `h |n|` to about 400 bits, and a bound on the error: for rays that are almost parallel.
    fn long_offset(&self) -> (Dyadic, Dyadic) {
        let n = exact3::<Dyadic>(self.normal);
        let square = Ring::square(Dyadic::exact(self.distance)) * dot(&n, &n);
        let mut root = Dyadic::exact(self.offset.v.hi) + Dyadic::exact(self.offset.v.lo);
        let residual = |root: &Dyadic| square.clone() - Ring::square(root.clone());
        let approximate = root.to_f64();
        if approximate == 0.0 || residual(&root).is_zero() {
            return (root, Dyadic::exact(self.offset.e));
        }
        // Newton's steps, each with a correction of 53 bits.
        for _ in 0..6 {
            let rest = residual(&root);
            let Some(k) = rest.exponent().and_then(|k| i32::try_from(k).ok()) else { break };
            let correction = Ring::scale2(rest, -k).to_f64() / (2.0 * approximate);
            root = root + Ring::scale2(Dyadic::exact(correction), k);
        }
        // |sqrt(x) - r| = |x - r^2| / (sqrt(x) + r) <= |x - r^2| / |r|.
        let rest = residual(&root).abs();
        let k = rest.exponent().and_then(|k| i32::try_from(k).ok()).unwrap_or(0);
        let error = 2.0 / approximate.abs() * (1.0 + 8.0 * f64::EPSILON);
        (root, Ring::scale2(Dyadic::exact(error), k))
    }

    /// The foot of the perpendicular from the origin, rounded.
    fn foot(&self) -> Point3 {
        let foot = (self.normal * (self.distance / self.normal.length())).to_point();
        foot.map(|x| if x.is_finite() { x } else { 0.0 })
    }

    /// Whether the plane is certainly not ahead of the ray's start, as far as f64 can decide: the
    /// ray was spawned on it and goes away, or it starts on one side and goes away from the plane.
    /// This is the first and cheapest test.
    #[inline(always)]
    fn is_behind(&self, ray: &LocalRay<'_>) -> bool {
        let (n, size) = (self.normal, self.normal.abs());
        let slope = n.dot(ray.d);
        // Three roundings in a dot product.
        let slope_err = size.dot(ray.d.abs() * (4.0 * U) + ray.d_err) + planar::TINY;
        if !(slope.abs() > slope_err && ray.t_min >= 0.0) {
            return false;
        }
        match ray.source {
            Some(side) => (side == RaySide::Front) == (slope > 0.0),
            None => {
                let height = n.dot(ray.o.to_vec()) - self.offset.v.hi;
                let err = size.dot(ray.o.to_vec().abs() * (4.0 * U) + ray.o_err);
                let err =
                    err + (self.offset.v.hi.abs() + height.abs()) * (2.0 * U) + self.offset.e + planar::TINY;
                // The low part of the offset is below an ulp of the high one.
                ray.starts_at_zero() && height.abs() > err && (height > 0.0) == (slope > 0.0)
            }
        }
    }

    /// The signed distance from the origin.
    pub fn distance(&self) -> f64 {
        self.distance
    }
}

/// `|n|` if it is a number that f64 holds.
fn rational_length(n: Vec3) -> Option<f64> {
    let length = n.length();
    let square = dot(&exact3::<Dyadic>(n), &exact3(n));
    (Ring::square(Dyadic::exact(length)) == square).then_some(length)
}

/// Rounds a number to double-double, with a bound on the error.
fn rounded(x: &Dyadic) -> EFloat<Dd> {
    let hi = x.to_f64();
    let rest = x - &Dyadic::exact(hi);
    let lo = rest.to_f64();
    let lost = (&rest - &Dyadic::exact(lo)).to_f64().abs();
    EFloat::with_error(Dd { hi, lo }, if lost > 0.0 { lost.next_up() } else { 0.0 })
}

impl PlaneForm for Seen<'_> {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<Quick> {
        let (n, offset, c) = (self.plane.normal, self.plane.offset, self.centre.to_vec());
        // Three roundings in the dot product, one in the difference, one for the offset's low part.
        let lift = n.dot(c) - offset.v.hi;
        let size = n.abs().dot(c.abs()) * (3.0 * U) + (lift.abs() + offset.v.hi.abs()) * U;
        Some(Quick::new((n, Vec3::ZERO), (ray.o, ray.o_err), (lift, size + offset.e), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        dot(&exact3(self.plane.normal), &ray.d)
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (n, offset) = (exact3::<T>(self.plane.normal), self.plane.offset);
        let lift = dot(&n, &exact3(self.centre.to_vec())) - T::exact(offset.v.hi);
        let lift = lift - T::within(offset.v.lo, offset.e)?;
        Some(dot(&n, &ray.o) + lift * ray.w.clone())
    }

    fn exact_side(&self, ray: &RingRay<Dyadic>) -> Option<Ordering> {
        // n . p against h |n|, times w: by sign, and if the signs agree by the squares.
        let n = exact3::<Dyadic>(self.plane.normal);
        let reach = dot(&n, &ray.o) + dot(&n, &exact3(self.centre.to_vec())) * ray.w.clone();
        let h = Dyadic::exact(self.plane.distance);
        let (left, right) = (reach.exact_sign(), h.exact_sign());
        if left != right {
            return Some(left.cmp(&right));
        }
        let squares = Ring::square(reach).cmp(&(Ring::square(h * ray.w.clone()) * dot(&n, &n)));
        Some(if left.is_lt() { squares.reverse() } else { squares })
    }

    fn height_bounds(&self, ray: &RingRay<Dyadic>) -> Option<(Dyadic, Dyadic)> {
        let n = exact3::<Dyadic>(self.plane.normal);
        let (offset, error) = self.plane.long_offset();
        let lift = dot(&n, &exact3(self.centre.to_vec())) - offset;
        let at = |lift: Dyadic| dot(&n, &ray.o) + lift * ray.w.clone();
        Some((at(lift.clone() - error.clone()), at(lift + error)))
    }
}

impl Surface for Plane {
    fn bounds(&self) -> Aabb {
        Aabb::UNBOUNDED
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        // Relative to the ray's own origin, so that a near crossing is as precise as a far one: a
        // plane has no middle, and no size but its distance from the origin.
        if self.is_behind(ray) {
            return;
        }
        let probe = Probe::of(ray.unmoved(), self.distance.abs());
        let seen = Seen { plane: self, centre: ray.o };
        if let Some(crossing) = probe.crossing_within(&seen, sink.range())
            && probe.admits(&seen, &crossing)
        {
            let _ = sink.push(probe.root(&crossing, 0, [0.0; 2]));
        }
    }

    /// Texture coordinates are lengths along two axes across the normal.
    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let (n, offset, s) = (self.normal, self.offset, root.s);
        let n2 = n.length_squared();
        let length = n2.sqrt();
        let x =
            Vec3::new(s.mul_add(ray.d.x, ray.o.x), s.mul_add(ray.d.y, ray.o.y), s.mul_add(ray.d.z, ray.o.z));
        // Moved onto the plane: along the ray within the bracket, which undoes the rounding of a
        // far start's parameter; then along the normal.
        let height = |x: Vec3| n.dot(x) - offset.v.hi;
        let width = ray.unmoved().width(root);
        let step = height(x) / n.dot(ray.d);
        let step = if step.abs() <= width { step } else { 0.0 };
        let x = x - ray.d * step;
        let p = x - n * (height(x) / n2);
        let dp = ray.o_err
            + ray.d_err * s.abs()
            + ray.d.abs() * (width + step.abs())
            + (x - p).abs()
            + (x.abs() + p.abs()) * (2.0 * U);
        // The height over the plane: three roundings in the dot product, one in the difference, and
        // the part of the offset that f64 does not hold.
        let height = n.dot(p) - offset.v.hi;
        let err = n.abs().dot(p.abs()) * (3.0 * U)
            + (height.abs() + offset.v.hi.abs()) * U
            + offset.v.lo.abs()
            + offset.e;
        let off = (height.abs() + err) / length * (1.0 + 64.0 * U) + least_step(p.to_point());
        let dp = dp.map(|x| x * (1.0 + 16.0 * U) + f64::MIN_POSITIVE);
        let ng = (n * (1.0 / length)).to_normal();
        let mut point = SurfacePoint::new(p.to_point(), dp, off, ng);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (a, b) = ng.to_vec().orthonormal_basis();
            point.uv = [a.dot(p), b.dot(p)];
            (point.dpdu, point.dpdv) = (a, b);
        }
        point
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        let centre = self.foot();
        let seen = Seen { plane: self, centre };
        planar::below_is_in(PointLine::new(point, Vec3::ZERO, centre, 0).side_of(&seen))
    }
}

impl Accelerate for Plane {
    fn name(&self) -> &'static str {
        "plane"
    }

    fn inner_bounds(&self) -> Aabb {
        let mut inner = Aabb::UNBOUNDED;
        let n = self.normal;
        let mut entries = (0..3).filter(|&axis| n[axis] != 0.0);
        let (Some(axis), None) = (entries.next(), entries.next()) else { return Aabb::EMPTY };
        if n[axis] > 0.0 {
            inner.max[axis] = self.distance;
        } else {
            inner.min[axis] = -self.distance;
        }
        inner
    }

    fn half_space(&self) -> Option<HalfSpace> {
        let n = self.normal();
        Some(HalfSpace::new([n.x, n.y, n.z].map(Interval::from), self.offset_bounds()))
    }

    fn misses(&self, shaft: &Shaft) -> bool {
        let offset = self.offset;
        !shaft.may_cross(self.normal, offset.v.hi, offset.v.lo.abs() + offset.e)
    }

    /// A half-space is convex: a segment that starts and ends in it stays in it.
    fn is_left(&self, side: RaySide, shaft: &Shaft) -> bool {
        let (n, end) = (self.normal, shaft.end());
        let (mut least, mut most, mut size) = (0.0, 0.0, self.offset.v.hi.abs());
        for i in 0..3 {
            let (a, b) = (n[i] * end.min[i], n[i] * end.max[i]);
            least += a.min(b);
            most += a.max(b);
            size += a.abs().max(b.abs());
        }
        // Three products, three sums, the offset's low part.
        let err = size * (8.0 * U) + self.offset.e + planar::TINY;
        match side {
            RaySide::Front => least - self.offset.v.hi > err,
            RaySide::Back => most - self.offset.v.hi < -err,
        }
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::half_space(Point3::ORIGIN, self.normal, self.offset)
    }
}

impl Algebraic for Plane {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let (n, h) = (exact3::<Dyadic>(self.normal()), self.distance());
        if h == 0.0 {
            return planar::plane_along(&n, Point3::ORIGIN, ray);
        }
        let ray = ray.in_ring::<Dyadic>()?;
        let (at, slope) = (dot(&n, &ray.o), dot(&n, &ray.d));
        let far = Ring::square(Dyadic::exact(h) * ray.w) * dot(&n, &n);
        let (a, b, c) = (Ring::square(slope.clone()), at.clone() * slope, Ring::square(at) - far);
        // Between the two planes it is negative; behind this one, if it is the first along the
        // normal, positive.
        Some(if h > 0.0 { Quadratic { a, b, c } } else { Quadratic { a: -a, b: -b, c: -c } })
    }
}

impl From<Plane> for Normal3 {
    /// The unit normal.
    fn from(plane: Plane) -> Self {
        unit(plane.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Crossing, Exact, ExactLine, Feature, Oracle, Surd, TestRng, check_many, exact3};

    /// `n . p = h sqrt(n . n)` by big integers.
    struct ExactPlane {
        n: [Exact; 3],
        h: Exact,
        size: f64,
    }

    impl ExactPlane {
        fn new(plane: &Plane) -> Self {
            let n = exact3(plane.normal.to_array());
            Self { n, h: plane.distance.into(), size: plane.distance.abs() }
        }

        fn dot(&self, v: &[Exact; 3]) -> Exact {
            &(&(&self.n[0] * &v[0]) + &(&self.n[1] * &v[1])) + &(&self.n[2] * &v[2])
        }

        /// `h^2 n . n`.
        fn radicand(&self) -> Exact {
            &self.h.squared() * &self.dot(&self.n)
        }
    }

    impl Oracle for ExactPlane {
        fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
            let slope = self.dot(&line.d);
            if slope.sign().is_eq() {
                return vec![];
            }
            let t = Surd::with_root(-self.dot(&line.o), self.h.sign() as i8, self.radicand(), slope.clone());
            // Beyond the range of f64 there is no parameter or point to report.
            let reach = line.d.iter().map(|d| d.clone().abs().to_f64()).fold(1.0, f64::max);
            let most = f64::MAX / reach;
            let far = t.cmp_exact(&most.into()).is_gt() || t.cmp_exact(&(-most).into()).is_lt();
            if far { vec![] } else { vec![Crossing { t, sign: slope.sign() as i8, grazing: false }] }
        }

        fn face_side(&self, _face: u32, point: &[Exact; 3]) -> Ordering {
            let t = Surd::with_root(Exact::zero(), self.h.sign() as i8, self.radicand(), Exact::from(1.0));
            t.cmp_exact(&self.dot(point)).reverse()
        }

        fn face_normal(&self, _face: u32, _point: &[Exact; 3]) -> Vec3 {
            Vec3::from(self.n.each_ref().map(Exact::to_f64))
        }

        fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
            Some(self.face_side(0, point))
        }

        fn size(&self) -> f64 {
            self.size
        }

        fn is_convex(&self) -> bool {
            true
        }
    }

    #[test]
    fn planes_obey_the_laws() {
        let mut roots = 0;
        for seed in 0..60 {
            let mut dice = TestRng::new(seed);
            // Lengths that are integers, half-integers, and irrational numbers.
            let n = match seed % 4 {
                0 => {
                    dice.pick(&[[0.0, 1.0, 0.0], [2.0, -1.0, 2.0], [0.0, 3.0, -4.0], [8.0, 4.0, 1.0]]).into()
                }
                1 | 2 => dice.lattice(5),
                _ => dice.vector(),
            };
            let h = match seed % 5 {
                0 => 0.0,
                1 | 2 => dice.integer(-9, 9),
                3 => dice.between(-1.0, 1.0) * dice.power(-40, 40),
                _ => dice.power(-200, 200),
            };
            let plane = Plane::new(n * dice.power(-300, 300), h).unwrap();
            let (a, b) = unit(plane.normal).to_vec().orthonormal_basis();
            let unit = if h == 0.0 { 1.0 } else { h.abs() };
            let on = Point3::from(n.cross(Vec3::new(1.0, 2.0, -1.0)).to_array().map(|x| x * unit));
            let features = [
                Feature { point: plane.foot(), direction: a * unit },
                Feature { point: plane.foot() + b * unit, direction: b * unit },
                Feature { point: on, direction: n.cross(Vec3::X) * unit },
                Feature { point: on, direction: plane.normal * unit },
            ];
            let oracle = ExactPlane { size: unit, ..ExactPlane::new(&plane) };
            roots += check_many(&plane, &oracle, &features, seed, 300).roots;
        }
        assert!(roots > 4000, "{roots}");
    }

    #[test]
    fn the_plane_is_that_of_the_scaled_normal() {
        // |n| = 3: the plane x + 2y + 2z = 6 is 2 away from the origin.
        let plane = Plane::new(Vec3::new(1.0, 2.0, 2.0), 2.0).unwrap();
        let on = Point3::new(6.0, 0.0, 0.0);
        assert_eq!(plane.side(&LocalPoint::new(on)), Side::On);
        assert_eq!(plane.side(&LocalPoint::new(Point3::new(6.0_f64.next_down(), 0.0, 0.0))), Side::In);
        assert_eq!(plane.side(&LocalPoint::new(Point3::new(6.0_f64.next_up(), 0.0, 0.0))), Side::Out);
    }

    #[test]
    fn a_bad_plane_is_named() {
        assert_eq!(Plane::new(Vec3::ZERO, 1.0), Err(PlaneError::Normal(Vec3::ZERO)));
        assert!(matches!(Plane::new(Vec3::X, f64::NAN), Err(PlaneError::Distance(_))));
    }
}
