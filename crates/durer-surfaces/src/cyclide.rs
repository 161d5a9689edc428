//! Dupin's cyclide: what a sphere sweeps whose centre goes round an ellipse and whose radius
//! changes evenly with the way along its major axis.
//!
//! ```text
//!   centre (a cos t, 0, b sin t), radius d - c cos t;  b² = a² - c²
//!
//!                  z ▲   ╭───────────╮
//!                    │ ╭─╯  ╭─────╮  │         f(p) = (|p|² - b² - d²)² + 4 b² y² - 4 (a d - c x)² <= 0
//!   ─────────────────┼─┼────┼─────┼──┼──▶ x
//! ```
//!
//! With c = 0 it is the torus about the y axis. Otherwise: a *ring* for c < d < a, thick on the
//! side of -x; a *horn* for d <= c, two crescents that meet in two points; a *spindle* for d >= a,
//! in which what is inside twice is outside, as the sign of `f` has it. All its lines of curvature
//! are circles. C. Dupin, *Applications de géométrie et de mécanique*, Paris 1822; its equation as
//! J. C. Maxwell, "On the cyclide", *Quarterly Journal of Pure and Applied Mathematics* 9, 1868,
//! derives it from focal conics. The plane y = 0 cuts it in circles of radii a + d about (-c, 0)
//! and |a - d| about (c, 0), the plane z = 0 in circles of radii d - c about (a, 0) and d + c about
//! (-a, 0).

use crate::faces::chart::{Chart, Frame, tangents};
use crate::packet::FilterSource;
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::{
    Accelerate, Algebraic, CentredRay, Forward, LocalPoint, LocalRay, Need, PartId, RingRay, Root, Side,
    Sink, Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Affine, Dyadic, Interval, Point3, Ring, U, Vec3, elementary};
use durer_roots::quadratic::Quadratic;

/// A Dupin cyclide with its inside, in its own frame.
///
/// # Invariants
///
/// `0 <= c < a`, `0 < d`, and all are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cyclide {
    a: f64,
    c: f64,
    d: f64,
}

/// Why a [`Cyclide`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CyclideError {
    /// The ellipse's semi-axis is zero, negative, infinite or NaN.
    #[error("cyclide: the semi-axis a must be finite and positive, got {0}")]
    SemiAxis(f64),
    /// The ellipse's focal distance is negative, or not less than its semi-axis.
    #[error("cyclide: the focal distance c must be at least 0 and less than the semi-axis a = {a}, got {c}")]
    Focal {
        /// The semi-axis.
        a: f64,
        /// The focal distance.
        c: f64,
    },
    /// The mean radius is zero, negative, infinite or NaN.
    #[error("cyclide: the mean radius d must be finite and positive, got {0}")]
    Radius(f64),
}

impl Cyclide {
    /// The cyclide of the ellipse with semi-axis `a` and focal distance `c`, and spheres of the
    /// mean radius `d`.
    pub fn new(a: f64, c: f64, d: f64) -> Result<Self, CyclideError> {
        if !(a > 0.0 && a < f64::MAX / 8.0) {
            return Err(CyclideError::SemiAxis(a));
        }
        if !(0.0..a).contains(&c) {
            return Err(CyclideError::Focal { a, c });
        }
        if !(d > 0.0 && d < f64::MAX / 8.0) {
            return Err(CyclideError::Radius(d));
        }
        Ok(Self { a, c, d })
    }

    /// The semi-axis along x of the ellipse of centres.
    pub fn semi_axis(&self) -> f64 {
        self.a
    }

    /// The distance of the foci of the ellipse from its centre.
    pub fn focal_distance(&self) -> f64 {
        self.c
    }

    /// The radius of the spheres between the greatest and the least one.
    pub fn radius(&self) -> f64 {
        self.d
    }

    #[inline(always)]
    fn scale(&self) -> i32 {
        exponent(self.a + self.c + self.d).max(-1000)
    }

    /// a, c, d in units.
    #[inline(always)]
    fn numbers(&self) -> (f64, f64, f64) {
        let scale = self.scale();
        (scale2(self.a, -scale), scale2(self.c, -scale), scale2(self.d, -scale))
    }

    /// b² in units, rounded.
    #[inline(always)]
    fn b2(&self) -> f64 {
        let (a, c, _) = self.numbers();
        (a - c) * (a + c)
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        polynomial_surface::roots(self, ray, sink);
    }

    /// How far it reaches along a row of a map: of the sphere at t that is row . centre + |row|
    /// radius, with either sign of the radius, whose greatest value over t is that of a cosine.
    fn reach(&self, row: [f64; 3]) -> f64 {
        let [x, y, z] = row.map(Interval::from);
        let (a, c, d) = (Interval::from(self.a), Interval::from(self.c), Interval::from(self.d));
        let length = (x.square() + y.square() + z.square()).sqrt();
        let across = (a - c) * (a + c) * z.square();
        let way = |c: Interval| ((a * x - length * c).square() + across).sqrt();
        (way(c) + length * d).hi.max((way(-c) - length * d).hi)
    }
}

impl PolynomialSurface<5> for Cyclide {
    #[inline(always)]
    fn frame(&self) -> Frame {
        let (a, c, d) = self.numbers();
        Frame { centre: Point3::ORIGIN, scale: self.scale(), reach: (a + c + d) * (1.0 + 4.0 * U) }
    }

    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; 5] {
        let (o, v) = (&ray.o, &ray.d);
        let dot = |a: &[T; 3], b: &[T; 3]| {
            a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
        };
        let (a, c, d) = self.numbers();
        let (a, c, d) = (T::exact(a), T::exact(c), T::exact(d));
        let w = ray.w.clone();
        let w2 = w.clone().square();
        let b2 = (a.clone() - c.clone()) * (a.clone() + c.clone()) * w2.clone();
        // Q = q2 s² + 2 q1 s + q0, y = y1 s + y0, e = e1 s + e0: f = Q² + 4 b² y² - 4 e².
        let (q2, q1) = (dot(v, v), dot(o, v));
        let q0 = o[0].clone().square() + o[1].clone().square() + o[2].clone().square()
            - (b2.clone() + d.clone().square() * w2);
        let (y1, y0) = (v[1].clone(), o[1].clone());
        let e0 = (a * d * w.clone() - c.clone() * o[0].clone()) * w.clone();
        let e1 = -(c * v[0].clone() * w);
        [
            q0.clone().square() + (b2.clone() * y0.clone().square() - e0.clone().square()).scale2(2),
            (q1.clone() * q0.clone()).scale2(2) + (b2.clone() * y0 * y1.clone() - e0 * e1.clone()).scale2(3),
            (q2.clone() * q0).scale2(1) + (q1.clone().square() + b2 * y1.square() - e1.square()).scale2(2),
            (q2.clone() * q1).scale2(2),
            q2.square(),
        ]
    }

    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        let (_, c, d) = self.numbers();
        let thick = (d + c) * (1.0 + MARGIN) + MARGIN;
        let along = (ray.o.y, ray.d.y);
        polynomial_surface::ball_and_slab(
            ray,
            self.frame().reach * (1.0 + MARGIN),
            along,
            (-thick, thick),
            MARGIN,
        )
    }

    #[inline(always)]
    fn slopes(&self, y: Vec3) -> (Vec3, f64) {
        let ((a, c, d), b2) = (self.numbers(), self.b2());
        let (square, radii) = (y.dot(y), b2 + d * d);
        let q = square - radii;
        let g = y * (4.0 * q) + Vec3::Y * (8.0 * b2 * y.y) + Vec3::X * (8.0 * c * (a * d - c * y.x));
        // H = 4 Q I + 8 y yᵀ + 8 b² e eᵀ - 8 c² h hᵀ with e across h and b, c < a; a 64th further
        // out.
        let far = (square.sqrt() + 1.0 / 64.0) * (1.0 + 1.0 / 1024.0);
        let bend = 4.0 * (far * far - radii).abs().max(q.abs() + 0.125 * far) + 8.0 * (far * far + a * a);
        (g, bend * (1.0 + 1.0 / 1024.0))
    }

    fn turn(&self, y: Vec3, v: Vec3) -> Vec3 {
        let ((_, c, d), b2) = (self.numbers(), self.b2());
        let q = y.dot(y) - (b2 + d * d);
        v * (4.0 * q) + y * (8.0 * y.dot(v)) + Vec3::Y * (8.0 * b2 * v.y) - Vec3::X * (8.0 * c * c * v.x)
    }

    /// Once round the ellipse, and once round the circle in which the sphere there touches, from
    /// its inner side over the top.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let (a, c, d) = self.numbers();
        let b = self.b2().sqrt();
        // p = centre + radius n for one of the normal's directions: that whose centre is on the
        // ellipse. Of x: X (1 - c n / a) = x - d n.
        let sphere = |n: Vec3| {
            let cos = (y.x - d * n.x) / (a - c * n.x);
            let radius = d - c * cos;
            let sin = (y.z - radius * n.z) / b;
            (cos, sin, radius, (cos * cos + sin * sin - 1.0).abs() + (y.y - radius * n.y).abs())
        };
        let (one, other) = (sphere(n), sphere(-n));
        let ((cos, sin, radius, _), out) = if one.3 <= other.3 { (one, n) } else { (other, -n) };
        let turns = |x: f64| {
            let t = x / TURN;
            if t < 0.0 { t + 1.0 } else { t }
        };
        let along = Vec3::new(-a * sin, 0.0, b * cos);
        let outward = Vec3::Y.cross(along);
        let outward = outward * (1.0 / outward.length().max(f64::MIN_POSITIVE));
        // Round that circle lines of curvature are spaced as a planet's eccentric anomalies are by
        // the true ones, with the eccentricity k.
        let k = c / a * cos.clamp(-1.0, 1.0);
        let (up, inner) = (-out.y, -out.dot(outward));
        let squeeze = (1.0 - k * k).max(0.0).sqrt();
        let size = elementary::hypot(up, inner).max(f64::MIN_POSITIVE);
        let (up, inner) = (up / size, inner / size);
        let (u, v) = (turns(elementary::atan2(sin, cos)), turns(elementary::atan2(squeeze * up, inner + k)));
        // The lines of constant v are lines of curvature: dn = bend dp, so that dp (1 - radius
        // bend) = centre' + radius' n.
        let east = along + out * (c * sin);
        let east = east - n * n.dot(east);
        let length = east.length();
        // On the surface it is b long; a point of which this is not true is no such point (beside a
        // tip).
        let is_told = length > 0.5 * b;
        if !is_told {
            let (u_way, v_way) = tangents(n);
            return Chart { uv: [u, v], dpdu: u_way, dpdv: v_way };
        }
        let unit = east * (1.0 / length);
        let (g, _) = self.slopes(y);
        let bend = unit.dot(self.turn(y, unit)) / g.length().max(f64::MIN_POSITIVE) * n.dot(out);
        let stretch = 1.0 / (1.0 - radius * bend);
        let east = east * (if stretch.is_finite() { stretch } else { 1.0 } * TURN);
        let slant = c * sin / along.length().max(f64::MIN_POSITIVE);
        let small = radius.abs() * (1.0 - slant * slant).max(0.0).sqrt();
        // The true anomaly's change with the eccentric one is squeeze / (1 - k cos), which is (1 +
        // k cos of the true one) / squeeze.
        let small = small * (1.0 + k * inner) / squeeze.max(f64::MIN_POSITIVE);
        Chart { uv: [u, v], dpdu: east, dpdv: n.cross(unit) * (small * TURN) }
    }

    fn tip(&self, y: Vec3) -> Vec3 {
        // A horn's tips lie in the plane of the ellipse, and its surface is across their direction
        // there; a spindle's lie across that plane.
        if y.y.abs() > y.z.abs() { Vec3::Y } else { Vec3::X }
    }
}

/// By how much the body is taken larger than it is, in units, so that no rounding matters.
const MARGIN: f64 = 1.0 / 256.0;

impl Surface for Cyclide {
    fn bounds(&self) -> Aabb {
        self.bounds_through(&Affine::IDENTITY)
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        let reach = (self.a + self.c + self.d) * (1.0 + 4.0 * U);
        if !ray.passes_by(Point3::ORIGIN, reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        polynomial_surface::resolve(self, ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        polynomial_surface::side(self, point)
    }
}

impl Accelerate for Cyclide {
    fn name(&self) -> &'static str {
        "cyclide"
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        let centre = map.centre();
        let (mut min, mut max) = (centre, centre);
        for (axis, row) in map.linear().into_iter().enumerate() {
            let c = Interval::from(centre[axis]);
            max[axis] = (c + Interval::from(self.reach(row))).hi;
            min[axis] = (c - Interval::from(self.reach(row.map(|x| -x)))).lo;
        }
        Aabb::new(min, max)
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds())
    }
}

impl Algebraic for Cyclide {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        polynomial_surface::sign_at_root(self, ray, root, q)
    }
}

#[cfg(test)]
mod tests;
