//! The plane, and the half-space below it.
//!
//! ```text
//!            n
//!            ^        n . p = h |n|
//!   ─────────┴──────────────────────    the surface
//!   · · · · · · · · · · · · · · · ·     inside: n . p <= h |n|
//! ```
//!
//! The surface is *exactly* this set for the stored normal `n` (of any length) and distance `h`. Where `|n|` is irrational the
//! plane has no rational point, yet every decision is rational: `n . p < h |n|` is a matter of signs and of `(n . p)^2 < h^2 n . n`.

use crate::planar::{self, PlaneForm, PointLine, Probe, dot, exact3, scaled_to_one, unit};
use crate::{Flow, LocalPoint, LocalRay, Need, RingRay, Root, Side, Sink, Solidity, Surface, SurfacePoint};
use core::cmp::Ordering;
use durer_math::{Aabb, Dd, Dyadic, Normal3, Point3, Ring, Run, Vec3};

/// A plane, which is also the boundary of the half-space behind it.
///
/// # Invariants
///
/// The normal's largest component is in [1, 2) in magnitude (a positive factor of the normal changes nothing), and the
/// distance is finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Vec3,
    /// Signed distance from the origin, along the normal.
    distance: f64,
    /// The foot of the perpendicular from the origin, rounded: the centre for re-centring.
    foot: Point3,
    /// `n . foot - h |n|`, by its value and error: small, and not zero because the foot is rounded.
    lift: Run<Dd>,
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
    /// The plane of the points whose distance from the origin along `normal` is `distance`. The normal has any length.
    pub fn new(normal: Vec3, distance: f64) -> Result<Self, PlaneError> {
        let n = scaled_to_one(normal).ok_or(PlaneError::Normal(normal))?;
        if !distance.is_finite() {
            return Err(PlaneError::Distance(distance));
        }
        let foot = (n * (distance / n.length())).to_point();
        let foot = foot.map(|x| if x.is_finite() { x } else { 0.0 });
        let reach = dot(&exact3::<Run<Dd>>(n), &exact3(foot.to_vec()));
        let lift = match rational_length(n) {
            // All of it is exact; only what two f64 cannot hold is rounded.
            Some(length) => rounded(
                &(dot(&exact3::<Dyadic>(n), &exact3(foot.to_vec()))
                    - Dyadic::exact(distance) * Dyadic::exact(length)),
            ),
            None => {
                let squared = dot(&exact3::<Run<Dd>>(n), &exact3(n));
                reach - Run::exact(distance) * squared.sqrt()
            }
        };
        Ok(Self { normal: n, distance, foot, lift })
    }

    /// The normal, scaled by a power of two.
    pub fn normal(&self) -> Vec3 {
        self.normal
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

/// A number as a double-double, with a bound on what was lost.
fn rounded(x: &Dyadic) -> Run<Dd> {
    let hi = x.to_f64();
    let rest = x - &Dyadic::exact(hi);
    let lo = rest.to_f64();
    let lost = (&rest - &Dyadic::exact(lo)).to_f64().abs();
    Run::with_error(Dd { hi, lo }, if lost > 0.0 { lost.next_up() } else { 0.0 })
}

impl PlaneForm for Plane {
    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        dot(&exact3(self.normal), &ray.d)
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let lift = T::exact(self.lift.v.hi) + T::within(self.lift.v.lo, self.lift.e)?;
        Some(dot(&exact3(self.normal), &ray.o) + lift * ray.w.clone())
    }

    fn exact_side(&self, ray: &RingRay<Dyadic>) -> Option<Ordering> {
        // n . p against h |n| w, with p = o + foot w: by sign, and where the signs agree by the squares.
        let reach = dot(&exact3::<Dyadic>(self.normal), &ray.o)
            + dot(&exact3::<Dyadic>(self.normal), &exact3(self.foot.to_vec())) * ray.w.clone();
        let h = Dyadic::exact(self.distance);
        let (left, right) = (reach.exact_sign(), h.exact_sign());
        if left != right {
            return Some(left.cmp(&right));
        }
        let length2 = dot(&exact3::<Dyadic>(self.normal), &exact3(self.normal));
        let squares = Ring::square(reach).cmp(&(Ring::square(h * ray.w.clone()) * length2));
        Some(if left.is_lt() { squares.reverse() } else { squares })
    }

    fn height_bounds(&self, ray: &RingRay<Dyadic>) -> Option<(Dyadic, Dyadic)> {
        let at = |error: f64| {
            let lift = Dyadic::exact(self.lift.v.hi) + Dyadic::exact(self.lift.v.lo) + Dyadic::exact(error);
            dot(&exact3::<Dyadic>(self.normal), &ray.o) + lift * ray.w.clone()
        };
        Some((at(-self.lift.e), at(self.lift.e)))
    }
}

impl Surface for Plane {
    fn bounds(&self) -> Aabb {
        Aabb::UNBOUNDED
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = Probe::new(ray, self.foot, 0);
        if let Some(crossing) = probe.crossing(self)
            && !probe.leaves(&crossing)
            && !crossing.is_outside(sink.range())
            && probe.admits(self, &crossing)
        {
            let _: Flow = sink.push(probe.root(&crossing, 0, [0.0; 2]));
        }
    }

    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        let probe = Probe::new(ray, self.foot, 0);
        let n2 = self.normal.length_squared();
        let ng = unit(self.normal);
        let lift = self.lift.value();
        let (p, dp) = planar::foot_point(&probe, self, self.normal, n2, lift);
        let off = planar::clearance(self, p, self.foot, 0, n2.sqrt());
        let mut point = SurfacePoint::new(p, dp, off, ng);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (a, b) = ng.to_vec().orthonormal_basis();
            point.uv = [a.dot(p.to_vec()), b.dot(p.to_vec())];
            (point.dpdu, point.dpdv) = (a, b);
        }
        point
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        planar::below_is_in(PointLine::new(point, Vec3::ZERO, self.foot, 0).side_of(self))
    }
}

impl From<Plane> for Normal3 {
    /// The unit normal.
    fn from(plane: Plane) -> Self {
        unit(plane.normal)
    }
}
