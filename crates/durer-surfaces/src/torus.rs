//! The torus: a tube of radius `r` around a circle of radius `R`.
//!
//! ```text
//!   a ▲         ╭───╮
//!   ──┼─────────┤ • ├──▶ ρ = √(|p|² - a²)      f(p) = (|p|² - R² - r²)² + 4R² (a² - r²) <= 0
//!     ├──── R ────┼r┤
//! ```
//!
//! `a` is the coordinate along the axis. `f` equals `((ρ - R)² + a² - r²) ((ρ + R)² + a² - r²)`, in
//! a form that contains no square root and whose terms are no larger than `(2 R r)²` near the
//! surface. Along a ray it is a quartic: S. D. Roth, "Ray casting for modeling solids", *Computer
//! Graphics and Image Processing* 18 (1982). With `r > R` the tube meets itself on the axis (a
//! *spindle*); the part that is inside twice is then outside, by the sign of `f`. `r = R` is a
//! *horn*.

use crate::faces::chart::{Chart, Frame, length};
use crate::faces::form::FLOOR;
use crate::packet::FilterSource;
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::revolution::packet::{RevolutionKernel, RevolutionWall};
use crate::{
    Accelerate, Algebraic, CentredRay, Forward, LocalPoint, LocalRay, Need, PartId, RingRay, Root, Side,
    Sink, Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Affine, Dyadic, EFloat, Point3, Ring, U, Vec3, elementary};
use durer_roots::quadratic::Quadratic;

/// A torus with its inside.
///
/// # Invariants
///
/// The centre is finite; both radii are finite and positive, and so is their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    centre: Point3,
    axis: Axis,
    major: f64,
    minor: f64,
}

/// One of the coordinate axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name is its own description")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// Why a [`Torus`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TorusError {
    /// The centre has an infinite or NaN coordinate.
    #[error("torus: the centre must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Centre(Point3),
    /// The circle's radius is zero, negative, infinite or NaN.
    #[error("torus: the major radius must be finite and positive, got {0}")]
    Major(f64),
    /// The tube's radius is zero, negative, infinite or NaN.
    #[error("torus: the minor radius must be finite and positive, got {0}")]
    Minor(f64),
}

impl Torus {
    /// The torus about `axis` through `centre` whose tube of radius `minor` goes round a circle of
    /// radius `major`.
    pub fn new(centre: Point3, axis: Axis, major: f64, minor: f64) -> Result<Self, TorusError> {
        if !centre.is_finite() {
            return Err(TorusError::Centre(centre));
        }
        if !(major > 0.0 && major < f64::MAX / 4.0) {
            return Err(TorusError::Major(major));
        }
        if !(minor > 0.0 && minor < f64::MAX / 4.0) {
            return Err(TorusError::Minor(minor));
        }
        Ok(Self { centre, axis, major, minor })
    }

    /// The centre.
    pub fn centre(&self) -> Point3 {
        self.centre
    }

    /// The axis.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// The radius of the circle.
    pub fn major(&self) -> f64 {
        self.major
    }

    /// The radius of the tube.
    pub fn minor(&self) -> f64 {
        self.minor
    }

    #[inline(always)]
    fn scale(&self) -> i32 {
        exponent(self.major + self.minor).max(-1000)
    }

    /// The radii in units.
    #[inline(always)]
    fn radii(&self) -> (f64, f64) {
        let scale = self.scale();
        (scale2(self.major, -scale), scale2(self.minor, -scale))
    }

    #[inline(always)]
    fn index(&self) -> usize {
        self.axis as usize
    }

    /// `v` along the axis.
    #[inline(always)]
    fn along_axis(&self, v: Vec3) -> f64 {
        match self.axis {
            Axis::X => v.x,
            Axis::Y => v.y,
            Axis::Z => v.z,
        }
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        polynomial_surface::roots(self, ray, sink);
    }

    fn axis_vector(&self) -> Vec3 {
        [Vec3::X, Vec3::Y, Vec3::Z][self.index()]
    }

    /// The two directions across the axis, so that they and the axis are right-handed.
    fn across(&self) -> (Vec3, Vec3) {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        (axes[(self.index() + 1) % 3], axes[(self.index() + 2) % 3])
    }
}

impl PolynomialSurface<5> for Torus {
    #[inline(always)]
    fn frame(&self) -> Frame {
        let (major, minor) = self.radii();
        Frame { centre: self.centre, scale: self.scale(), reach: (major + minor) * (1.0 + 4.0 * U) }
    }

    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; 5] {
        let (o, d) = (&ray.o, &ray.d);
        let dot = |a: &[T; 3], b: &[T; 3]| {
            a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
        };
        let (major, minor) = self.radii();
        let w2 = ray.w.clone().square();
        let (big, small) = (T::exact(major).square() * w2.clone(), T::exact(minor).square() * w2);
        // Q = q2 s² + 2 q1 s + q0, a = a1 s + a0: f = Q² + 4 R² (a² - r²).
        let (q2, q1) = (dot(d, d), dot(o, d));
        let q0 = o[0].clone().square() + o[1].clone().square() + o[2].clone().square()
            - (big.clone() + small.clone());
        let (a1, a0) = (d[self.index()].clone(), o[self.index()].clone());
        let big = big.scale2(2);
        [
            q0.clone().square() + big.clone() * (a0.clone().square() - small),
            (q1.clone() * q0.clone()).scale2(2) + (big.clone() * a0 * a1.clone()).scale2(1),
            (q2.clone() * q0).scale2(1) + q1.clone().square().scale2(2) + big * a1.square(),
            (q2.clone() * q1).scale2(2),
            q2.square(),
        ]
    }

    #[inline(always)]
    fn along_in_f64(&self, o: Vec3, d: Vec3, eo: Vec3, ed: Vec3) -> [EFloat; 5] {
        let (major, minor) = self.radii();
        let (big, small) = (major * major, minor * minor);
        let (od, dd) = (o.abs() + eo, d.abs() + ed);
        // Dot products of three terms round three times. The errors of the inputs enter to first
        // order, times upper bounds of the other factors.
        let (q2, q1, oo) = (d.dot(d), o.dot(d), o.dot(o));
        let q0 = oo - (big + small);
        let e2 = (3.0 * U).mul_add(q2, 2.0 * ed.dot(dd));
        let e1 = (3.0 * U).mul_add(od.dot(dd), ed.dot(od) + eo.dot(dd));
        let e0 = (3.0 * U).mul_add(oo + big + small, 2.0 * eo.dot(od) + U * q0.abs());
        let (a0, a1, ea0, ea1) =
            (self.along_axis(o), self.along_axis(d), self.along_axis(eo), self.along_axis(ed));
        let big = 4.0 * big;
        // Upper bounds of the magnitudes, errors included.
        let (m2, m1, m0) = (q2 + e2, q1.abs() + e1, q0.abs() + e0);
        let (b0, b1) = (a0.abs() + ea0, a1.abs() + ea1);
        let flat = a0.mul_add(a0, -small);
        let c = [
            q0.mul_add(q0, big * flat),
            (4.0 * q1).mul_add(q0, 2.0 * big * (a0 * a1)),
            (2.0 * q2).mul_add(q0, (4.0 * q1).mul_add(q1, big * (a1 * a1))),
            4.0 * (q2 * q1),
            q2 * q2,
        ];
        // At most five roundings of each term, including 4 R².
        let e = [
            2.0 * m0 * e0 + 2.0 * big * b0 * ea0 + (5.0 * U) * (m0 * m0 + big * (b0 * b0 + small)),
            4.0 * (m1 * e0 + m0 * e1)
                + 2.0 * big * (b0 * ea1 + b1 * ea0)
                + (5.0 * U) * (4.0 * m1 * m0 + 2.0 * big * (b0 * b1)),
            2.0 * (m2 * e0 + m0 * e2)
                + 8.0 * m1 * e1
                + 2.0 * big * (b1 * ea1)
                + (5.0 * U) * (2.0 * m2 * m0 + 4.0 * (m1 * m1) + big * (b1 * b1)),
            4.0 * (m2 * e1 + m1 * e2) + (5.0 * U) * (4.0 * m2 * m1),
            2.0 * m2 * e2 + (5.0 * U) * (m2 * m2),
        ];
        let mut out = [EFloat::exact(0.0); 5];
        for (out, (c, e)) in out.iter_mut().zip(c.into_iter().zip(e)) {
            *out = EFloat::with_error(c, f64::mul_add(e, 1.0 + 64.0 * U, FLOOR));
        }
        out
    }

    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        let (_, minor) = self.radii();
        let thick = minor * (1.0 + MARGIN) + MARGIN;
        let along = (self.along_axis(ray.o), self.along_axis(ray.d));
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
        let (major, minor) = self.radii();
        let (big, small) = (major * major, minor * minor);
        let (square, a) = (y.dot(y), self.along_axis(y));
        let q = square - (big + small);
        let g = y * (4.0 * q) + self.axis_vector() * (8.0 * big * a);
        // H = 4 Q I + 8 y yᵀ + 8 R² e eᵀ, a 64th further out.
        let far = (square.sqrt() + 1.0 / 64.0) * (1.0 + 1.0 / 1024.0);
        let bend = 4.0 * (far * far - big - small).abs().max(q.abs() + 0.125 * far) + 8.0 * (far * far + big);
        (g, bend * (1.0 + 1.0 / 1024.0))
    }

    fn turn(&self, y: Vec3, v: Vec3) -> Vec3 {
        let (major, minor) = self.radii();
        let q = y.dot(y) - (major * major + minor * minor);
        v * (4.0 * q) + y * (8.0 * y.dot(v)) + self.axis_vector() * (8.0 * major * major * self.along_axis(v))
    }

    /// `u` once round the axis, `v` once round the tube, from its inner side over the top.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let (e, f) = self.across();
        let (major, _) = self.radii();
        let (px, py, a) = (y.dot(e), y.dot(f), self.along_axis(y));
        let rho = elementary::hypot(px, py);
        let out = if rho > 0.0 { (e * px + f * py) * (1.0 / rho) } else { e };
        let turns = |x: f64| {
            let t = x / TURN;
            if t < 0.0 { t + 1.0 } else { t }
        };
        let longitude = if rho > 0.0 { turns(elementary::atan2(py, px)) } else { 0.0 };
        // On the inner part of a spindle the tube has passed through the axis.
        let through = if n.dot(out) * (rho - major) < 0.0 { -1.0 } else { 1.0 };
        let from_tube = through * rho - major;
        let round = turns(elementary::atan2(-a, -from_tube));
        let east = (f * out.dot(e) - e * out.dot(f)) * (if rho > 0.0 { rho } else { 1.0 } * TURN);
        // Round the tube: across both the normal and the direction east.
        let north = n.cross(east);
        let north = north * (1.0 / north.length().max(f64::MIN_POSITIVE));
        let reach = elementary::hypot(from_tube, a);
        Chart { uv: [longitude, round], dpdu: east, dpdv: north * (reach * TURN) }
    }

    fn tip(&self, _: Vec3) -> Vec3 {
        self.axis_vector()
    }
}

/// By how much the torus is enlarged, in units, so that no rounding matters.
const MARGIN: f64 = 1.0 / 256.0;

impl Surface for Torus {
    fn bounds(&self) -> Aabb {
        let far = (self.major + self.minor).next_up();
        let mut half = [far; 3];
        half[self.index()] = self.minor;
        Aabb::centred(self.centre, half.into())
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        let reach = (self.major + self.minor) * (1.0 + 4.0 * U);
        if !ray.passes_by(self.centre, reach) {
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

impl Accelerate for Torus {
    fn name(&self) -> &'static str {
        "torus"
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        // The sum of the images of a circle and a ball: the half-widths of the ellipsoid are r
        // times the lengths of L's rows, those of the ellipse R times the lengths of the rows'
        // parts across the axis.
        let centre = map.bounds(&Aabb::new(self.centre, self.centre));
        let half = map.linear().map(|row| {
            let mut flat = row;
            flat[self.index()] = 0.0;
            self.major * length(flat) + self.minor * length(row)
        });
        centre.expanded(Vec3::from(half) * (1.0 + 16.0 * U))
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        let (major, minor) = self.radii();
        let (big, small) = (major * major, minor * minor);
        // (n + v² - R² - r²)² - 4R² (r² - v²), between planes that it does not touch.
        let wall = RevolutionWall {
            alpha: 1.0,
            kappa: -(big + small),
            beta: 0.0,
            p: [4.0 * big * small, 0.0, -4.0 * big, 0.0],
            at: 0.0,
            slab: [-minor * (1.0 + MARGIN), minor * (1.0 + MARGIN)],
            radius: (major + minor) * (1.0 + 4.0 * U),
            kappa_size: big + small,
        };
        let (i, lathe) = (self.index(), RevolutionKernel::new(&[wall], false));
        FilterSource::kernel(self.bounds(), lathe, self.centre, self.scale(), [(i + 1) % 3, i, (i + 2) % 3])
    }
}

impl Algebraic for Torus {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        polynomial_surface::sign_at_root(self, ray, root, q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Exact, Feature, TestRng, ZeroOracle, check_many};

    /// `(x² + y² + z² - R² - r²)² + 4R² (a² - r²)`, moved to the centre, expanded.
    fn oracle(torus: &Torus) -> ZeroOracle {
        let (big, small) = (Exact::from(torus.major).squared(), Exact::from(torus.minor).squared());
        let c = torus.centre.to_array().map(Exact::from);
        let one = || Exact::from(1.0);
        // |p - c|² - R² - r².
        let mut q = vec![];
        let mut constant = -(&big + &small);
        for axis in 0..3 {
            let mut n = [0; 3];
            n[axis] = 2;
            q.push((one(), n));
            n[axis] = 1;
            q.push((-c[axis].clone().shifted(1), n));
            constant = &constant + &c[axis].squared();
        }
        q.push((constant, [0; 3]));
        let mut terms = vec![];
        for (x, [i, j, k]) in &q {
            for (y, [l, m, n]) in &q {
                terms.push((x * y, [i + l, j + m, k + n]));
            }
        }
        let (axis, big) = (torus.axis as usize, big.shifted(2));
        let mut n = [0; 3];
        n[axis] = 2;
        terms.push((big.clone(), n));
        n[axis] = 1;
        terms.push((-(&big * &c[axis]).shifted(1), n));
        terms.push((&big * &(&c[axis].squared() - &small), [0; 3]));
        ZeroOracle { terms, size: torus.major + torus.minor }
    }

    /// Points with integer coordinates for R = 5 k and r = 3 k, and tangents there: circles of
    /// latitude, of the tube, Villarceau's.
    fn features(torus: &Torus) -> Vec<Feature> {
        let k = torus.major / 5.0;
        let (e, f) = torus.across();
        let a = torus.axis_vector();
        let at = |x: f64, y: f64, z: f64| e * x + f * y + a * z;
        let mut out = vec![Feature::new(torus.centre.to_array(), [0.0; 3])];
        let mut add = |p: Vec3, d: Vec3| {
            out.push(Feature { point: torus.centre + p * k, direction: d * (k / 4.0) });
        };
        for d in
            [at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0), at(3.0, 4.0, 0.0), at(1.0, 2.0, 2.0)]
        {
            // The equators, and the top, where a plane rests on it along a circle.
            for p in [at(8.0, 0.0, 0.0), at(0.0, 2.0, 0.0), at(5.0, 0.0, 3.0), at(0.0, -5.0, -3.0)] {
                add(p, d);
            }
        }
        // Lines in the plane that touches it twice: sin = r / R = 3/5; they touch at ρ = 4 R / 5
        // and a = ± 4 r / 5.
        let (touch, other) = (at(3.2, 0.0, 2.4), at(-3.2, 0.0, -2.4));
        add(touch, touch - other);
        add(touch, at(0.0, 1.0, 0.0));
        add(at(0.0, 3.0, 0.0), touch);
        out
    }

    #[test]
    fn tori_obey_the_laws() {
        let (mut grazing, mut widths) = (0, vec![]);
        for seed in 0..24 {
            let mut dice = TestRng::new(seed);
            let axis = dice.pick(&[Axis::X, Axis::Y, Axis::Z]);
            let (k, c) = match seed % 4 {
                0 => (1.0, Point3::ORIGIN),
                1 => (dice.power(-60, 60), Point3::ORIGIN),
                2 => (dice.power(-10, 10), dice.lattice(1000).to_point()),
                _ => (dice.scale(-10, 10), (dice.vector() * dice.scale(-10, 10)).to_point()),
            };
            let torus = Torus::new(c, axis, 5.0 * k, 3.0 * k).unwrap();
            let mut tally = check_many(&torus, &oracle(&torus), &features(&torus), seed, 40);
            assert!(tally.roots > 20);
            widths.push(tally.median_width());
            grazing += tally.grazing;
        }
        assert!(grazing > 50, "only {grazing} tangents");
        assert!(widths.iter().all(|w| *w < 48.0), "{widths:?}");
    }

    #[test]
    fn coefficients_are_within_their_bounds() {
        let mut tight = 0;
        for seed in 0..3000 {
            let mut dice = TestRng::new(seed);
            let axis = dice.pick(&[Axis::X, Axis::Y, Axis::Z]);
            let torus = Torus::new(Point3::ORIGIN, axis, dice.scale(-4, 4), dice.scale(-4, 4)).unwrap();
            let size = if seed % 3 == 0 { 0.0 } else { dice.scale(-60, -20) };
            let (o, d) = (dice.vector() * dice.scale(-8, 2), dice.vector());
            let spread = |dice: &mut TestRng| Vec3::new(dice.unit(), dice.unit(), dice.unit()) * size;
            let (eo, ed) = (spread(&mut dice), spread(&mut dice));
            // A ray within the errors; its sums are exact.
            let at = |x: f64, e: f64, part: f64| Dyadic::from(x) + Dyadic::from(e) * Dyadic::from(part);
            let mut ring =
                |x: Vec3, e: Vec3| [0, 1, 2].map(|i| at(x[i], e[i], dice.pick(&[-1.0, 0.0, 0.5, 1.0])));
            let exact = RingRay { o: ring(o, eo), d: ring(d, ed), w: Dyadic::from(1.0) };
            let (exact, found) = (torus.along(&exact), torus.along_in_f64(o, d, eo, ed));
            for (x, run) in exact.iter().zip(found) {
                let error = (x - &Dyadic::from(run.v)).abs();
                assert!(error <= Dyadic::from(run.e), "seed {seed}: {run:?}");
                tight += usize::from(error.to_f64() * 100.0 > run.e);
            }
        }
        assert!(tight > 5000, "{tight}");
    }

    /// Through a horn's tip, where the squared gradient is below the normal numbers.
    #[test]
    fn normals_at_a_tip_have_unit_length() {
        let radius = 0.000_309_944_152_832_031_25;
        let torus = Torus::new(Point3::ORIGIN, Axis::Y, radius, radius).unwrap();
        for y in [0.0, 5e-324, 1e-200, 1e-165, 1e-160, 1e-155] {
            let origin = Point3::new(-0.001_464_843_75, -y, -0.001_953_125);
            let ray = durer_math::Ray::new(origin, Vec3::new(96.0, 0.0, 128.0));
            let local = LocalRay::new(&ray);
            let mut met = crate::All::default();
            torus.roots(&local, &mut met);
            assert!(met.roots.len() >= 2, "{y:e}: {:?}", met.roots);
            for root in &met.roots {
                let n = torus.resolve(&local, root, Need::ALL).ng.to_vec();
                assert!((n.length() - 1.0).abs() < 4e-16, "{y:e}: {n:?}");
            }
        }
    }

    #[test]
    fn bad_radii_are_named() {
        let o = Point3::ORIGIN;
        assert_eq!(Torus::new(o, Axis::Z, -1.0, 0.5), Err(TorusError::Major(-1.0)));
        assert_eq!(Torus::new(o, Axis::Z, 1.0, 0.0), Err(TorusError::Minor(0.0)));
        assert!(Torus::new(o, Axis::Z, f64::NAN, 1.0).is_err());
    }
}
