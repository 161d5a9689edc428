//! The disc: a flat, round sheet.
//!
//! ```text
//!          n
//!          ^           n . (p - c) = 0,   |p - c| <= r
//!     ─────┴─────
//!       r  c
//! ```
//!
//! The line `o + s d` (relative to `c`) meets the plane at `p = (n x (o x d)) / (n . d)`, so
//! whether it meets the disc is the sign of `|n x (o x d)|^2 - r^2 (n . d)^2`: a polynomial,
//! decided exactly; the rim belongs to the disc.

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::planar::{
    self, AlongRay, Crossing, Line, PlaneForm, Probe, Quick, cross, dot, exact3, scaled_to_one, unit,
};
use crate::{Accelerate, CentredRay, LocalRay, Need, PartId, RingRay, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use core::f64::consts::TAU;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, Point3, Ring, U, Vec3, elementary};
use durer_roots::quadratic::Quadratic;

/// A round sheet about `centre`, in the plane across `normal`.
///
/// # Invariants
///
/// Centre, normal and radius are finite, the normal is not zero, the radius is positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    sheet: RoundSheet,
}

/// Why a [`Disc`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DiscError {
    /// The centre is infinite or NaN.
    #[error("disc: the centre must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Centre(Point3),
    /// The normal has no direction.
    #[error("disc: the normal must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Normal(Vec3),
    /// The radius is zero, negative, infinite or NaN.
    #[error("disc: the radius must be finite and positive, got {0}")]
    Radius(f64),
}

impl Disc {
    /// The disc of radius `radius` about `centre`; the normal has any length.
    pub fn new(centre: Point3, normal: Vec3, radius: f64) -> Result<Self, DiscError> {
        if !centre.is_finite() {
            return Err(DiscError::Centre(centre));
        }
        let n = scaled_to_one(normal).ok_or(DiscError::Normal(normal))?;
        if !(radius.is_finite() && radius > 0.0) {
            return Err(DiscError::Radius(radius));
        }
        Ok(Self { sheet: RoundSheet::new(centre, n, radius) })
    }

    /// The centre.
    pub fn centre(&self) -> Point3 {
        self.sheet.centre
    }

    /// The normal, scaled by a power of two.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        self.sheet.normal
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.sheet.radius
    }
}

impl Surface for Disc {
    fn bounds(&self) -> Aabb {
        self.sheet.bounds()
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.sheet.probe(ray);
        // An inexact ray that cannot be kept off the disc meets it.
        if let Some(crossing) = self.sheet.crossing(&probe, sink.range())
            && self.sheet.beyond(&probe, &crossing, self.sheet.radius).is_none_or(Ordering::is_le)
            && probe.admits(&self.sheet, &crossing)
        {
            let _ = sink.push(probe.root(&crossing, 0, [0.0; 2]));
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        self.sheet.resolve(ray, need, 0.0)
    }
}

impl Accelerate for Disc {
    fn name(&self) -> &'static str {
        "disc"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::ring(self.centre(), self.normal(), 0.0, self.radius())
    }
}

impl Algebraic for Disc {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_along(&exact3(self.normal()), self.centre(), ray)
    }
}

/// The plane in which discs and annuli lie, with their centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RoundSheet {
    pub(crate) centre: Point3,
    /// Largest component in [1, 2) in magnitude.
    pub(crate) normal: Vec3,
    /// The outer radius.
    pub(crate) radius: f64,
    /// It is in `[1/2, 1)` units of `2^scale`.
    scale: i32,
}

/// How far the crossing is from a circle's rim: negative inside.
struct Rim {
    normal: Vec3,
    /// In units of `2^scale`.
    radius: f64,
}

impl AlongRay for Rim {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let n = exact3::<T>(self.normal);
        let [x, y, z] = cross(&n, &cross(&ray.o, &ray.d));
        let reach = T::exact(self.radius) * (ray.w.clone() * dot(&n, &ray.d));
        Some(x.square() + y.square() + z.square() - reach.square())
    }
}

impl PlaneForm for RoundSheet {
    #[inline(always)]
    fn quick(&self, ray: &CentredRay<'_>) -> Option<Quick> {
        Some(Quick::new((self.normal, Vec3::ZERO), (ray.o, ray.o_err), (0.0, 0.0), ray))
    }

    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        dot(&exact3(self.normal), &ray.d)
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(dot(&exact3(self.normal), &ray.o))
    }
}

impl RoundSheet {
    /// The sheet of radius `radius`; `normal` is scaled.
    pub(crate) fn new(centre: Point3, normal: Vec3, radius: f64) -> Self {
        Self { centre, normal, radius, scale: exponent(radius) + 1 }
    }

    #[inline(always)]
    pub(crate) fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        Probe::new(ray, self.centre, self.radius)
    }

    /// Whether a crossing lies beyond a circle about the centre (`Greater`), on it, or within.
    #[inline(always)]
    pub(crate) fn beyond(&self, probe: &Probe<'_>, crossing: &Crossing, radius: f64) -> Option<Ordering> {
        let radius = scale2(radius, -self.scale);
        let (x, err) = probe.place(crossing);
        let gap = x.length_squared() - radius * radius;
        // Each square errs by 2 |x| err + err^2 and passes through three roundings; so does r^2,
        // through one, and the difference.
        let spread = (x.abs() * 2.0 + err).dot(err);
        let bound = (x.length_squared() + radius * radius).mul_add(5.0 * U, spread) * (1.0 + 32.0 * U);
        if gap.abs() > bound + planar::TINY {
            return Some(if gap > 0.0 { Ordering::Greater } else { Ordering::Less });
        }
        probe.sign(&Rim { normal: self.normal, radius })
    }

    /// The crossing with the plane, unless it certainly does not matter.
    #[inline(always)]
    pub(crate) fn crossing(&self, probe: &Probe<'_>, range: (f64, f64)) -> Option<Crossing> {
        probe.crossing_within(self, range)
    }

    /// The half-width along an axis is `r sqrt(1 - n_i^2)` for a unit normal.
    pub(crate) fn bounds(&self) -> Aabb {
        let n2 = self.normal.map(|x| x * x);
        let all = n2.x + n2.y + n2.z;
        let half = |a: f64, b: f64| {
            if a + b == 0.0 {
                0.0
            } else {
                self.radius.mul_add(((a + b) / all).sqrt() * (1.0 + 16.0 * U), f64::MIN_POSITIVE)
            }
        };
        Aabb::centred(self.centre, Vec3::new(half(n2.y, n2.z), half(n2.z, n2.x), half(n2.x, n2.y)))
    }

    /// Polar texture coordinates: `u` is the angle over a full turn, `v` runs from the inner to the
    /// outer radius.
    #[inline(always)]
    pub(crate) fn resolve(&self, ray: &LocalRay<'_>, need: Need, inner: f64) -> SurfacePoint {
        let (probe, outer) = (self.probe(ray), self.radius);
        let n2 = self.normal.length_squared();
        let ng = unit(self.normal);
        let (p, dp) = planar::foot_point(&probe, self, self.normal, n2, 0.0);
        let off = planar::clearance(self, p, self.centre, self.scale, n2.sqrt());
        let mut point = SurfacePoint::new(p, dp, off, ng);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (a, b) = ng.to_vec().orthonormal_basis();
            let q = p - self.centre;
            let (x, y) = (a.dot(q), b.dot(q));
            let rho = elementary::hypot(x, y);
            let turn = elementary::atan2(y, x) / TAU;
            point.uv = [if turn < 0.0 { turn + 1.0 } else { turn }, (rho - inner) / (outer - inner)];
            // At the centre the angle is taken as zero.
            let (cos, sin) = if rho > 0.0 { (x / rho, y / rho) } else { (1.0, 0.0) };
            point.dpdu = (b * cos - a * sin) * (TAU * rho);
            point.dpdv = (a * cos + b * sin) * (outer - inner);
        }
        point
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::laws::{Exact, ExactBody, ExactForm, Feature, TestRng, check_many, exact3};

    /// The ball `|p - c|^2 <= r^2`.
    pub(crate) fn ball(centre: Point3, radius: f64) -> ExactForm {
        let form = ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let form = ExactForm { c: -Exact::from(radius).squared(), ..form };
        form.translated(&exact3(centre.to_array()))
    }

    fn exact(disc: &Disc) -> ExactBody {
        let plane = ExactForm::half_space(exact3(disc.normal().to_array()), exact3(disc.centre().to_array()));
        let faces = vec![plane, ball(disc.centre(), disc.radius())];
        ExactBody { faces, walls: 1, size: disc.radius(), convex: false }
    }

    /// A normal, and two vectors of the same length, all perpendicular to each other and with
    /// integer coordinates.
    pub(crate) const FRAMES: [[[f64; 3]; 3]; 4] = [
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]],
        [[-2.0, 6.0, 3.0], [3.0, -2.0, 6.0], [6.0, 3.0, -2.0]],
        [[0.0, 3.0, -4.0], [5.0, 0.0, 0.0], [0.0, 4.0, 3.0]],
    ];

    /// Points at the circle's radius `5 |a|` (all exact), with tangents, and the centre.
    pub(crate) fn features(centre: Point3, [n, a, b]: [Vec3; 3], unit: f64) -> Vec<Feature> {
        let mut out = vec![Feature { point: centre, direction: n * unit }];
        for (x, y) in [(5.0, 0.0), (3.0, 4.0), (-4.0, 3.0), (0.0, -5.0)] {
            let rim = (a * x + b * y) * unit;
            let tangent = (b * x - a * y) * unit;
            out.push(Feature { point: centre + rim, direction: n * unit });
            out.push(Feature { point: centre + rim, direction: tangent });
            out.push(Feature { point: centre + rim, direction: n * unit + tangent });
        }
        out
    }

    #[test]
    fn discs_obey_the_laws() {
        let (mut roots, mut widths) = (0, vec![]);
        for seed in 0..60 {
            let mut dice = TestRng::new(seed);
            let frame = dice.pick(&FRAMES).map(Vec3::from);
            let unit = if seed % 3 == 0 { dice.power(-300, 300) } else { dice.power(-3, 3) };
            let centre = if seed % 2 == 0 { Point3::ORIGIN } else { (dice.lattice(100) * unit).to_point() };
            let radius = 5.0 * frame[1].length() * unit;
            let disc = if seed % 5 == 4 {
                Disc::new(centre, dice.vector(), radius * dice.unit()).unwrap()
            } else {
                Disc::new(centre, frame[0] * dice.power(-20, 20), radius).unwrap()
            };
            let mut tally = check_many(&disc, &exact(&disc), &features(centre, frame, unit), seed, 300);
            roots += tally.roots;
            widths.push(tally.median_width());
        }
        assert!(roots > 3000, "{roots}");
        assert!(widths.iter().all(|w| *w <= 32.0), "{widths:?}");
    }

    #[test]
    fn the_rim_belongs_to_the_disc_and_the_plane_does_not() {
        let disc = Disc::new(Point3::ORIGIN, Vec3::new(1.0, 2.0, 2.0), 15.0).unwrap();
        let rim = Point3::new(14.0, -5.0, -2.0);
        let down = Vec3::new(-3.0, -1.0, -2.0);
        let ray = durer_math::Ray::new(rim - down * 7.0, down);
        assert_eq!(crate::laws::all_roots(&disc, &ray).len(), 1);
        let beside = Disc::new(Point3::ORIGIN, Vec3::new(1.0, 2.0, 2.0), 15.0_f64.next_down()).unwrap();
        assert_eq!(crate::laws::all_roots(&beside, &ray), []);
        let within = durer_math::Ray::new(rim, Vec3::new(-14.0, 5.0, 2.0));
        assert_eq!(crate::laws::all_roots(&disc, &within), []);
    }

    #[test]
    fn a_bad_disc_is_named() {
        assert_eq!(Disc::new(Point3::ORIGIN, Vec3::Y, -1.0), Err(DiscError::Radius(-1.0)));
        assert_eq!(Disc::new(Point3::ORIGIN, Vec3::ZERO, 1.0), Err(DiscError::Normal(Vec3::ZERO)));
    }
}
