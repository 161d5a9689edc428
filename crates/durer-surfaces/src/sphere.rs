//! The sphere.
//!
//! ```text
//!   f(x) = |x - c|² - r² <= 0
//! ```
//!
//! Along a ray that is re-centred to its closest approach to `c`, `B = d·o` is almost zero, so the
//! discriminant is `r² - |o|²` times `|d|²`: the form of E. Haines, J. Günther, T. Akenine-Möller,
//! "Precision improvements for ray/sphere intersection", *Ray Tracing Gems* (2019), chapter 7, here
//! without a unit direction.

use crate::compose::clip::{Algebraic, exact_along, wide_along};
use crate::faces::boolean_faces::{QuadricFaces, View};
use crate::faces::chart::{Chart, Frame, length, sphere_chart};
use crate::faces::form::{Form, Rounded};
use crate::packet::FilterSource;
use crate::ray::PREVIEW_WIDTH;
use crate::{
    Accelerate, LocalPoint, LocalRay, Need, PartId, Root, RootKind, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2, two_sum};
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Point3, RaySide, Ring, U, Vec3};
use durer_roots::quadratic::Quadratic;

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

/// Covers underflow in sums of products of numbers of size one.
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

    /// Pushes the roots for which f64 is precise enough.
    #[inline(always)]
    fn quick_roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) -> Reach {
        let scale = self.scale();
        let at = ray.recentre(self.centre, scale);
        let r = scale2(self.radius, -scale);
        let (o, d, eo, ed) = (at.o, at.d, at.o_err, at.d_err);
        let (od, dd) = (o.abs(), d.abs());
        // Dot products of three terms: gamma(3); errors of o and d as for any form (see
        // `Rounded::along`), with Q = 1.
        let (k, up) = (3.0 * U * (1.0 + 16.0 * U), 1.0 + 16.0 * U);
        let a = d.dot(d);
        let inverse = at.inverse_d2();
        let e_a = (k * a + ed.dot(dd + dd + ed)) * up;
        let b = o.dot(d);
        let e_b = (k * od.dot(dd) + ed.dot(od) + eo.dot(dd + ed)) * up + FLOOR;
        let origin = at.shift();
        // A ray that was spawned here certainly starts outside or inside. If it leaves from outside
        // there is no root ahead, and from inside only the exit.
        let spawned = at.spawned();
        if let Some((side, ..)) = spawned
            && side == RaySide::Front
        {
            let slope = b - a * origin;
            if slope > (e_b + origin.abs() * (e_a + 8.0 * U * a) + b.abs() * U) * (1.0 + 16.0 * U) {
                return Reach::Done;
            }
        }
        let within = spawned.is_some_and(|(side, ..)| side == RaySide::Back);
        let oo = o.dot(o);
        let c = (-r).mul_add(r, oo);
        let e_c = (k * oo + U * c.abs() + eo.dot(od + od + eo)) * up + FLOOR;
        let line = Quadratic {
            a: EFloat::with_error(a, e_a),
            b: EFloat::with_error(b, e_b),
            c: EFloat::with_error(c, e_c),
        };
        let disc = line.kahan_discriminant();
        // B is almost zero, so neither root (-B ∓ √disc) / A suffers cancellation, and A is known
        // to a few ulp.
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
        let widest = if ray.rough { PREVIEW_WIDTH } else { 46.0 * U };
        for (sign, top) in [(-1, -b - root), (1, root - b)] {
            if within && sign < 0 {
                continue;
            }
            let undecided = if sign < 0 { Reach::Nothing } else { Reach::Entry };
            let (s, lo, hi) = solution(top);
            let (near, far) = sink.range();
            let (t_lo, t_hi) = at.bracket(lo.next_down(), hi.next_up());
            let t_lo = if within { t_lo.max(ray.t_min) } else { t_lo };
            let t_hi = t_hi.max(t_lo);
            if t_lo > far.min(ray.t_max) || t_hi < near.max(ray.t_min) {
                continue;
            }
            let narrow = hi - lo <= widest * (origin + s).abs().max(0.5);
            if !narrow || at.admits(t_lo, t_hi) != Some(true) {
                return undecided;
            }
            let t = at.t(s).max(t_lo).min(t_hi);
            let root =
                Root { t, lo: t_lo, hi: t_hi, s, tag: [0.0; 2], face: 0, sign, kind: RootKind::Simple };
            if sink.push(root).is_break() {
                break;
            }
        }
        Reach::Done
    }

    /// The point of a root, if the sphere is not far away and the error of f is small: the result
    /// of [`View::resolve`] with the gradient `2 y` and the Hessian `2 I`.
    #[inline(always)]
    fn quick_point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> Option<SurfacePoint> {
        let scale = self.scale();
        let at = ray.recentre(self.centre, scale);
        let (r, s) = (scale2(self.radius, -scale), root.s);
        let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;
        // One step of Newton's method along the gradient.
        let y1 = y * (1.0 - (-r).mul_add(r, y.dot(y)) * (0.5 / (r * r)));
        let (c, back) = (self.centre, |x: f64| scale2(x, scale));
        let (px, lx) = two_sum(c.x, back(y1.x));
        let (py, ly) = two_sum(c.y, back(y1.y));
        let (pz, lz) = two_sum(c.z, back(y1.z));
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + FLOOR);
        // f at y1: three products and sums, and the coordinates themselves.
        let square = y1.dot(y1);
        let f = (-r).mul_add(r, square);
        let e_f = (5.0 * square + r * r) * U;
        // See `View::off`: rays start at p ± off n, with each coordinate moved by at most 3 U more.
        let tau = scale2(p.x.abs() + p.y.abs() + p.z.abs(), -scale) * (4.0 * U) + FLOOR;
        let away = 2.0 * (2.0 * y1.abs().dot(lost) + 2.0 * (lost.dot(lost) + tau * tau));
        let eta = f.abs() + 2.0 * e_f + away;
        // off = 2 η / (G + √(G² - 4 h η)) with h = 2 and G = 2 |y1| >= 2 - ..., where 1 - √(1 - x)
        // <= x for x <= 1.
        if !(square > 0.75 && eta < 1.0 / (1u64 << 20) as f64 && scale > -900) {
            return None;
        }
        let length = square.sqrt();
        let off = eta / (2.0 * length) * (1.0 + 4.0 * eta) * (1.0 + 64.0 * U);
        let n = y1 * (1.0 / length);
        let width = at.width(root);
        let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);
        let mut point = SurfacePoint::new(
            p,
            dp.map(|x| back(x) + f64::MIN_POSITIVE),
            back(off) + f64::MIN_POSITIVE,
            n.to_normal(),
        );
        point.bend = scale2(1.0 / length, -scale) * (1.0 + 4.0 * U);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let chart = sphere_chart(y1);
            point.uv = chart.uv;
            if need.contains(Need::DERIVATIVES) {
                (point.dpdu, point.dpdv) = (chart.dpdu.map(back), chart.dpdv.map(back));
                (point.dndu, point.dndv) = (chart.dpdu * (1.0 / length), chart.dpdv * (1.0 / length));
            }
        }
        Some(point)
    }

    #[cold]
    #[inline(never)]
    fn slow_roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.with_view(|v| v.roots(ray, sink));
    }

    fn with_view<R>(&self, f: impl FnOnce(View<'_>) -> R) -> R {
        let form = Rounded::ball(scale2(self.radius, -self.scale()));
        f(View { shape: self, forms: &[form], frame: self.frame(), walls: 1 })
    }
}

impl QuadricFaces for Sphere {
    fn name(&self) -> &'static str {
        "sphere"
    }

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

/// How much the f64 path has decided.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// Everything.
    Done,
    /// Nothing.
    Nothing,
    /// The entry.
    Entry,
}

/// Passes on only roots at which the ray leaves.
struct Leaving<'k, K: ?Sized>(&'k mut K);

impl<K: Sink + ?Sized> Sink for Leaving<'_, K> {
    fn range(&self) -> (f64, f64) {
        self.0.range()
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if root.sign > 0 { self.0.push(root) } else { ControlFlow::Continue(()) }
    }
}

impl Surface for Sphere {
    fn bounds(&self) -> Aabb {
        QuadricFaces::bounds(self)
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

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.quick_point(ray, root, need).unwrap_or_else(|| self.with_view(|v| v.resolve(ray, root, need)))
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    #[inline(always)]
    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.with_view(|v| v.side(point))
    }
}

impl Accelerate for Sphere {
    fn name(&self) -> &'static str {
        "sphere"
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        // The image is an ellipsoid: its half-widths are r times the lengths of L's rows.
        let centre = map.bounds(&Aabb::new(self.centre, self.centre));
        let rows = Vec3::from(map.linear().map(length));
        centre.expanded(rows * (self.radius * (1.0 + 16.0 * U)))
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::of_shape(self)
    }
}

impl Algebraic for Sphere {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        exact_along(self, self.frame(), face, ray)
    }

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        wide_along(self, self.frame(), face, ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{ExactBody, ExactForm, Feature, TestRng, check_many, exact3};

    fn exact(sphere: &Sphere) -> ExactBody {
        let r = sphere.radius;
        let form = ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let form = ExactForm { c: -crate::laws::Exact::from(r).squared(), ..form };
        let form = form.translated(&exact3(sphere.centre.to_array()));
        ExactBody::solid(vec![form], r, true)
    }

    /// Points of the sphere of radius 9 with integer coordinates, and tangents there.
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
            let mut dice = TestRng::new(seed);
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
