//! The sphere.
//!
//! ```text
//!   f(x) = |x - c|² - r² <= 0
//! ```
//!
//! Along a ray that is re-centred to its closest approach to `c`, `B = d·o` is all but zero, so the discriminant is
//! `r² - |o|²` times `|d|²`: the form of E. Haines, J. Günther, T. Akenine-Möller, "Precision improvements for ray/sphere intersection",
//! *Ray Tracing Gems* (2019), chapter 7, here without a unit direction.

use crate::quadric::body::{Chart, Frame, Shape, View};
use crate::quadric::form::{Form, Rounded};
use crate::roots::quadratic::Quadratic;
use crate::{Flow, Kind, LocalPoint, LocalRay, Need, Root, Side, Sink, Solidity, Surface, SurfacePoint};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Affine, Point3, Ring, Run, U, Vec3, elementary};

/// A sphere with its inside.
///
/// # Invariants
///
/// The centre is finite; the radius is finite and positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: Point3,
    radius: f64,
}

/// Why a [`Sphere`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// The centre has an infinite or NaN coordinate.
    #[error("sphere: the centre must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Centre(Point3),
    /// The radius is zero, negative, infinite or NaN.
    #[error("sphere: the radius must be finite and positive, got {0}")]
    Radius(f64),
}

/// Pays for underflow in sums of products of numbers of size one.
const FLOOR: f64 = 1e-290;

impl Sphere {
    /// The sphere of `radius` about `centre`.
    pub fn new(centre: Point3, radius: f64) -> Result<Self, SphereError> {
        if !centre.is_finite() {
            return Err(SphereError::Centre(centre));
        }
        if !(radius.is_finite() && radius > 0.0) {
            return Err(SphereError::Radius(radius));
        }
        Ok(Self { centre, radius })
    }

    /// The centre.
    pub fn centre(&self) -> Point3 {
        self.centre
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The exponent of the unit of length: the radius is in `[1, 2)` units.
    #[inline(always)]
    fn scale(&self) -> i32 {
        exponent(self.radius).max(-1022)
    }

    /// The roots, as far as f64 knows them well enough.
    #[inline(always)]
    fn quick_roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) -> Reach {
        let scale = self.scale();
        let at = ray.recentre(self.centre, scale);
        let r = scale2(self.radius, -scale);
        let (o, d, eo, ed) = (at.o, at.d, at.o_err, at.d_err);
        let (od, dd) = (o.abs(), d.abs());
        // Dot products of three terms: gamma(3); errors of o and d as for any form (see `Rounded::along`), with Q = 1.
        let (k, up) = (3.0 * U * (1.0 + 16.0 * U), 1.0 + 16.0 * U);
        let a = d.dot(d);
        let e_a = (k * a + ed.dot(dd + dd + ed)) * up;
        let b = o.dot(d);
        let e_b = (k * od.dot(dd) + ed.dot(od) + eo.dot(dd + ed)) * up + FLOOR;
        let oo = o.dot(o);
        let c = (-r).mul_add(r, oo);
        let e_c = (k * oo + U * c.abs() + eo.dot(od + od + eo)) * up + FLOOR;
        let line =
            Quadratic { a: Run::with_error(a, e_a), b: Run::with_error(b, e_b), c: Run::with_error(c, e_c) };
        let disc = line.kahan_discriminant();
        // B is all but zero, so neither root (-B ∓ √disc) / A suffers cancellation, and A is known to a few ulp.
        let inverse = 1.0 / a;
        let (ratio, e_rel) = (disc.e / disc.v, e_a * inverse);
        if disc.v < -disc.e * (1.0 + 4.0 * U) {
            return Reach::Done;
        }
        if !(disc.v > 0.0 && ratio < 0.5 && e_rel < 0.125) {
            return Reach::Nothing;
        }
        // |√x - √v| <= e / (√v (2 - e/v)), and 1 / (2 - r) <= (1 + r) / 2.
        let root = disc.v.sqrt();
        let e_root = root * (0.5 * ratio * (1.0 + ratio) + U);
        let e_top = (e_b + e_root) * inverse;
        // One rounding of the sum, one of 1 / A, one of the product; |A - a| <= e_rel a.
        let solution = |top: f64| {
            let s = top * inverse;
            let e = (e_top + s.abs() * (e_rel + 3.0 * U)) * (1.0 + 2.0 * e_rel) * (1.0 + 32.0 * U) + FLOOR;
            (s, s - e, s + e)
        };
        let origin = at.shift();
        for (sign, top) in [(-1, -b - root), (1, root - b)] {
            let undecided = if sign < 0 { Reach::Nothing } else { Reach::Entry };
            let (s, lo, hi) = solution(top);
            let (near, far) = sink.range();
            let (t_lo, t_hi) = at.bracket(lo.next_down(), hi.next_up());
            if t_lo > far.min(ray.t_max) || t_hi < near.max(ray.t_min) {
                continue;
            }
            let narrow = hi - lo <= 46.0 * U * (origin + s).abs().max(0.5);
            if !narrow || at.admits(t_lo, t_hi) != Some(true) {
                return undecided;
            }
            let t = at.t(s).max(t_lo).min(t_hi);
            let root = Root { t, lo: t_lo, hi: t_hi, s, tag: [0.0; 2], face: 0, sign, kind: Kind::Simple };
            if sink.push(root) == Flow::Stop {
                break;
            }
        }
        Reach::Done
    }

    #[cold]
    #[inline(never)]
    fn slow_roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.with_view(|v| v.roots(ray, sink));
    }

    fn with_view<R>(&self, f: impl FnOnce(View<'_, Self>) -> R) -> R {
        let form = Rounded::ball(scale2(self.radius, -self.scale()));
        f(View { shape: self, forms: &[form], frame: self.frame(), walls: 1 })
    }
}

impl Shape for Sphere {
    fn frame(&self) -> Frame {
        let scale = self.scale();
        Frame { centre: self.centre, scale, reach: scale2(self.radius, -scale) * (1.0 + 2.0 * U) }
    }

    fn faces(&self) -> usize {
        1
    }

    #[inline(always)]
    fn form<T: Ring>(&self, _: usize) -> Form<T> {
        let one = || T::exact(1.0);
        Form::diagonal([one(), one(), one()], -T::exact(self.radius).scale2(-self.scale()).square())
    }

    fn bounds(&self) -> Aabb {
        Aabb::centred(self.centre, Vec3::new(self.radius, self.radius, self.radius))
    }

    fn chart(&self, _: usize, y: Vec3, _: Vec3) -> Chart {
        sphere_chart(y)
    }
}

/// Longitude and latitude: `u = φ / 2π` from the x axis, `v` from 0 at the pole -z to 1 at +z; so `dpdu x dpdv` points outward.
///
/// At the poles the longitude is taken as 0.
pub(crate) fn sphere_chart(y: Vec3) -> Chart {
    const TURN: f64 = 2.0 * core::f64::consts::PI;
    const HALF: f64 = core::f64::consts::PI;
    let rho = elementary::hypot(y.x, y.y);
    let (cos, sin) = if rho > 0.0 { (y.x / rho, y.y / rho) } else { (1.0, 0.0) };
    let phi = if rho > 0.0 { elementary::atan2(y.y, y.x) } else { 0.0 };
    let u = phi / TURN;
    let latitude = elementary::atan2(y.z, rho);
    Chart {
        uv: [if u < 0.0 { u + 1.0 } else { u }, latitude / HALF + 0.5],
        // At a pole the circle of latitude has no length; a unit step east keeps the frame.
        dpdu: if rho > 0.0 { Vec3::new(-y.y, y.x, 0.0) * TURN } else { Vec3::Y },
        dpdv: Vec3::new(-y.z * cos, -y.z * sin, rho) * HALF,
    }
}

/// How far the quick way came.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// All is said.
    Done,
    /// Nothing was said.
    Nothing,
    /// What is to be said of the entry was said.
    Entry,
}

/// Takes roots at which a ray leaves, and only those.
struct Leaving<'k, K: ?Sized>(&'k mut K);

impl<K: Sink + ?Sized> Sink for Leaving<'_, K> {
    fn range(&self) -> (f64, f64) {
        self.0.range()
    }

    fn push(&mut self, root: Root) -> Flow {
        if root.sign > 0 { self.0.push(root) } else { Flow::Continue }
    }
}

/// The length of a vector, at most 4 roundings below it; no over- or underflow on the way.
pub(crate) fn length(v: [f64; 3]) -> f64 {
    let v = Vec3::from(v);
    let k = exponent(v.max_abs()).max(-1000);
    durer_math::scale::ldexp(v.map(|x| scale2(x, -k)).length(), k)
}

impl Surface for Sphere {
    fn bounds(&self) -> Aabb {
        Shape::bounds(self)
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        if ray.passes_by(self.centre, self.radius) {
            return;
        }
        match self.quick_roots(ray, sink) {
            Reach::Done => {}
            Reach::Nothing => self.slow_roots(ray, sink),
            Reach::Entry => self.slow_roots(ray, &mut Leaving(sink)),
        }
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        // The image is an ellipsoid: its half-widths are r times the lengths of L's rows.
        let centre = map.bounds(&Aabb::new(self.centre, self.centre));
        let rows = Vec3::from(map.linear().map(length));
        centre.expanded(rows * (self.radius * (1.0 + 16.0 * U)))
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.with_view(|v| v.resolve(ray, root, need))
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.with_view(|v| v.side(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Dice, ExactBody, ExactForm, Feature, check_many, exact3};

    fn exact(sphere: &Sphere) -> ExactBody {
        let r = sphere.radius;
        let form = ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let form = ExactForm { c: -crate::laws::Exact::from(r).squared(), ..form };
        let form = form.translated(&exact3(sphere.centre.to_array()));
        ExactBody::solid(vec![form], r, true)
    }

    /// Points of the sphere of radius 9 with whole coordinates, and tangents there.
    fn features(sphere: &Sphere) -> Vec<Feature> {
        let k = sphere.radius / 9.0;
        let on = [[9.0, 0.0, 0.0], [0.0, 0.0, -9.0], [1.0, 4.0, 8.0], [-4.0, 4.0, 7.0], [3.0, -6.0, 6.0]];
        let mut out = vec![Feature::new(sphere.centre.to_array(), [0.0; 3])];
        for p in on {
            let p = Vec3::from(p);
            for across in [Vec3::X, Vec3::Z, Vec3::new(1.0, -2.0, 1.0)] {
                let tangent = p.cross(across);
                out.push(Feature { point: sphere.centre + p * k, direction: tangent * (k / 8.0) });
            }
        }
        out
    }

    #[test]
    fn spheres_obey_the_laws() {
        let mut grazing = 0;
        for seed in 0..40 {
            let mut dice = Dice::new(seed);
            let (r, c) = match seed % 4 {
                0 => (9.0, Point3::ORIGIN),
                1 => (9.0 * dice.power(-300, 300), Point3::ORIGIN),
                2 => (9.0 * dice.power(-10, 10), dice.lattice(1000).to_point()),
                _ => (dice.scale(-40, 40), (dice.vector() * dice.scale(-10, 10)).to_point()),
            };
            let sphere = Sphere::new(c, r).unwrap();
            let mut tally = check_many(&sphere, &exact(&sphere), &features(&sphere), seed, 400);
            assert!(tally.roots > 100);
            assert!(tally.median_width() < 32.0);
            grazing += tally.grazing;
        }
        assert!(grazing > 100, "only {grazing} tangents");
    }

    #[test]
    fn bad_numbers_are_named() {
        assert_eq!(Sphere::new(Point3::ORIGIN, 0.0), Err(SphereError::Radius(0.0)));
        assert!(Sphere::new(Point3::new(0.0, f64::NAN, 0.0), 1.0).is_err());
    }
}
