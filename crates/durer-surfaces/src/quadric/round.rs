//! Cylinders and cones between two arbitrary points: solids of revolution with two discs as ends.
//!
//! ```text
//!        ╭───────────╮           y = x - base,  a = cap - base,  h = y·a  in [0, |a|²]
//!   base ●─ ─ ─ a ─ ─▶ cap       cylinder  |a|²|y|² - h² - r²|a|²                        <= 0
//!        ╰───────────╯           cone      |a|⁴|y|² - |a|²h² - (r₀|a|² + (r₁ - r₀) h)²   <= 0
//! ```
//!
//! The polynomials hold exactly for the numbers given: no axis is rotated, nothing is normalised,
//! and the cone's radius is linear from one end to the other. J. M. Cychosz, W. N. Waggenspack,
//! "Intersecting a ray with a cylinder", *Graphics Gems IV* (1994), treat the cylinder by vectors
//! in the same way.

use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::chart::{Chart, Frame, Tip, sheared, tangents};
use crate::faces::form::Form;
use crate::quadric::solid::QuadricSolid;
use durer_math::eft::exponent;
use durer_math::{Aabb, Dd, EFloat, Point3, Ring, U, Vec3, elementary};

/// A cylinder between two points, capped or open.
pub type CappedCylinder = QuadricSolid<CylinderShape>;
/// A cone between two points with a radius at each, capped or open; a full cone if one radius is
/// zero.
pub type Frustum = QuadricSolid<FrustumShape>;

/// Face numbers of [`CappedCylinder`] and [`Frustum`].
pub const WALL: u32 = 0;
/// The disc at the base point.
pub const BASE: u32 = 1;
/// The disc at the cap point.
pub const CAP: u32 = 2;

/// Why a [`CappedCylinder`] or [`Frustum`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RoundError {
    /// An end has an infinite or NaN coordinate.
    #[error("{what}: an end must be finite, got <{}, {}, {}>", end.x, end.y, end.z)]
    End {
        /// The solid.
        what: &'static str,
        /// The end.
        end: Point3,
    },
    /// Both ends are the same point.
    #[error("{what}: the ends must differ, both are <{}, {}, {}>", end.x, end.y, end.z)]
    NoAxis {
        /// The solid.
        what: &'static str,
        /// Both ends.
        end: Point3,
    },
    /// A radius is negative, infinite or NaN, or zero where that leaves no solid.
    #[error("{what}: the radius must be finite and positive, got {radius}")]
    Radius {
        /// The solid.
        what: &'static str,
        /// The radius.
        radius: f64,
    },
}

/// An axis between two different points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    base: Point3,
    cap: Point3,
    scale: i32,
    /// The exponent of the axis' length in units of `2^scale`.
    thin: i32,
}

impl Axis {
    fn new(what: &'static str, base: Point3, cap: Point3, radius: f64) -> Result<Self, RoundError> {
        for end in [base, cap] {
            if !end.is_finite() {
                return Err(RoundError::End { what, end });
            }
        }
        if base == cap {
            return Err(RoundError::NoAxis { what, end: base });
        }
        // Half of each, so that the difference cannot overflow.
        let half = (Vec3::new(0.5 * cap.x, 0.5 * cap.y, 0.5 * cap.z)
            - Vec3::new(0.5 * base.x, 0.5 * base.y, 0.5 * base.z))
        .max_abs();
        let length = exponent(half) + 1;
        let scale = length.max(exponent(radius));
        Ok(Self { base, cap, scale, thin: length - scale })
    }

    /// `a` in units of the axis' own size; the wall's polynomial is homogeneous in it.
    fn unit<T: Ring>(&self) -> [T; 3] {
        let k = -self.scale - self.thin;
        [0, 1, 2].map(|i| (T::exact(self.cap[i]) - T::exact(self.base[i])).scale2(k))
    }

    fn half_space<T: Ring>(&self, face: u32) -> Form<T> {
        let a = self.unit::<T>();
        if face == BASE {
            return Form::half_space(a.map(|x| -x), T::exact(0.0));
        }
        // y·â <= |a|² = 2^thin |â|², both sides over 2^thin.
        let aa = square(&a).scale2(self.thin);
        Form::half_space(a, -aa)
    }

    fn frame(&self, radius: f64) -> Frame {
        let a = self.unit::<EFloat<Dd>>();
        let length = square(&a).sqrt().scale2(self.thin);
        let r = EFloat::<Dd>::exact(radius).scale2(-self.scale);
        let reach = (length.square() + r.square()).sqrt().hi();
        Frame { centre: self.base, scale: self.scale, reach }
    }

    /// The box of the discs of radius `r0` and `r1`: half-widths `r √(1 - aᵢ²/|a|²)`.
    fn bounds(&self, r0: f64, r1: f64) -> Aabb {
        let a = self.unit::<EFloat<Dd>>();
        let aa = square(&a);
        let share = |i: usize| {
            let (b, c) = (a[(i + 1) % 3], a[(i + 2) % 3]);
            (((b * b + c * c) / aa).sqrt().hi()).min(1.0)
        };
        let shares = Vec3::new(share(0), share(1), share(2)) * (1.0 + 2.0 * U);
        Aabb::centred(self.base, shares * r0).union(Aabb::centred(self.cap, shares * r1))
    }

    /// The unit axis and `a`, in units.
    fn direction(&self) -> (Vec3, Vec3) {
        let a = Vec3::from(self.unit::<EFloat<Dd>>().map(|x| x.v.hi));
        (a * (1.0 / a.length()), a * durer_math::scale::ldexp(1.0, self.thin))
    }

    /// `u` around the axis, `v` along it (walls), or from the rim inward (discs of radius `disc`).
    fn chart(&self, y: Vec3, n: Vec3, disc: Option<f64>) -> Chart {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let (k, a) = self.direction();
        let h = y.dot(k);
        // Orthogonal to k to the last bits near the axis, too: there the difference is rounding error,
        // which a second projection removes or shows to be all of it ("twice is enough": B. N.
        // Parlett, The Symmetric Eigenvalue Problem, 1980, section 6.9).
        let once = y - k * h;
        let twice = once - k * once.dot(k);
        let out = if twice.length() > 0.5 * once.length() { twice } else { Vec3::ZERO };
        let (e1, e2) = tangents(k);
        let rho = out.length();
        let radial = if rho > 0.0 { out * (1.0 / rho) } else { e1 };
        let phi = elementary::atan2(radial.dot(e2), radial.dot(e1));
        let u = if phi < 0.0 { phi / TURN + 1.0 } else { phi / TURN };
        let around = k.cross(radial);
        let dpdu = around * (if rho > 0.0 { rho } else { 1.0 } * TURN);
        match disc {
            None => Chart { uv: [u, h / a.length()], dpdu, dpdv: sheared(a, radial, n) },
            Some(radius) => {
                Chart { uv: [u, 1.0 - rho / radius], dpdu, dpdv: (radial - n * n.dot(radial)) * -radius }
            }
        }
    }
}

fn square<T: Ring>(a: &[T; 3]) -> T {
    a[0].clone().square() + a[1].clone().square() + a[2].clone().square()
}

/// `p I - q a aᵀ` as `xx yy zz xy xz yz`.
fn spread<T: Ring>(p: &T, q: &T, a: &[T; 3]) -> [T; 6] {
    let m = |i: usize, j: usize| -(q.clone() * a[i].clone() * a[j].clone());
    [p.clone() + m(0, 0), p.clone() + m(1, 1), p.clone() + m(2, 2), m(0, 1), m(0, 2), m(1, 2)]
}

/// The numbers of a [`CappedCylinder`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderShape {
    axis: Axis,
    radius: f64,
    open: bool,
}

impl CappedCylinder {
    /// The solid cylinder of `radius` from `base` to `cap`.
    pub fn new(base: Point3, cap: Point3, radius: f64) -> Result<Self, RoundError> {
        Self::build(base, cap, radius, false)
    }

    /// The wall alone of such a cylinder, rims included.
    pub fn open(base: Point3, cap: Point3, radius: f64) -> Result<Self, RoundError> {
        Self::build(base, cap, radius, true)
    }

    fn build(base: Point3, cap: Point3, radius: f64, open: bool) -> Result<Self, RoundError> {
        if !(radius.is_finite() && radius > 0.0) {
            return Err(RoundError::Radius { what: "cylinder", radius });
        }
        let axis = Axis::new("cylinder", base, cap, radius)?;
        Ok(Self::of(CylinderShape { axis, radius, open }))
    }
}

impl QuadricFaces for CylinderShape {
    fn name(&self) -> &'static str {
        "cylinder"
    }

    fn frame(&self) -> Frame {
        self.axis.frame(self.radius)
    }

    fn faces(&self) -> usize {
        3
    }

    fn walls(&self) -> usize {
        if self.open { 1 } else { 3 }
    }

    #[inline(always)]
    fn form<T: Ring>(&self, face: usize) -> Form<T> {
        if face as u32 != WALL {
            return self.axis.half_space(face as u32);
        }
        let a = self.axis.unit::<T>();
        let aa = square(&a);
        let r = T::exact(self.radius).scale2(-self.axis.scale);
        let zero = || T::exact(0.0);
        Form { q: spread(&aa, &T::exact(1.0), &a), b: [zero(), zero(), zero()], c: -(r.square() * aa) }
    }

    fn bounds(&self) -> Aabb {
        self.axis.bounds(self.radius, self.radius)
    }

    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart {
        let r = durer_math::scale::ldexp(self.radius, -self.axis.scale);
        self.axis.chart(y, n, (face as u32 != WALL).then_some(r))
    }
}

/// The numbers of a [`Frustum`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrustumShape {
    axis: Axis,
    radii: [f64; 2],
    open: bool,
}

impl Frustum {
    /// The solid between the discs of `base_radius` about `base` and of `cap_radius` about `cap`.
    pub fn new(base: Point3, base_radius: f64, cap: Point3, cap_radius: f64) -> Result<Self, RoundError> {
        Self::build(base, base_radius, cap, cap_radius, false)
    }

    /// The wall alone of such a solid, rims included.
    pub fn open(base: Point3, base_radius: f64, cap: Point3, cap_radius: f64) -> Result<Self, RoundError> {
        Self::build(base, base_radius, cap, cap_radius, true)
    }

    fn build(base: Point3, r0: f64, cap: Point3, r1: f64, open: bool) -> Result<Self, RoundError> {
        for r in [r0, r1] {
            if !(r.is_finite() && r >= 0.0) {
                return Err(RoundError::Radius { what: "cone", radius: r });
            }
        }
        if r0 == 0.0 && r1 == 0.0 {
            return Err(RoundError::Radius { what: "cone", radius: 0.0 });
        }
        let axis = Axis::new("cone", base, cap, r0.max(r1))?;
        Ok(Self::of(FrustumShape { axis, radii: [r0, r1], open }))
    }
}

impl QuadricFaces for FrustumShape {
    fn name(&self) -> &'static str {
        "cone"
    }

    fn frame(&self) -> Frame {
        self.axis.frame(self.radii[0].max(self.radii[1]))
    }

    fn faces(&self) -> usize {
        3
    }

    fn walls(&self) -> usize {
        if self.open { 1 } else { 3 }
    }

    #[inline(always)]
    fn form<T: Ring>(&self, face: usize) -> Form<T> {
        if face as u32 != WALL {
            return self.axis.half_space(face as u32);
        }
        // With a = 2^m â: |a|⁴|y|² - (|a|² + δ²) h² - 2 r₀ δ |a|² h - r₀²|a|⁴, over 2^4m:
        // |â|⁴|y|² - (|â|² + δ'²)(y·â)² - 2 r₀ δ' |â|² (y·â) - r₀²|â|⁴ with δ' = δ 2^-m.
        // This is large if δ' is above one.
        let a = self.axis.unit::<T>();
        let aa = square(&a);
        let unit = |x: f64| T::exact(x).scale2(-self.axis.scale);
        let (r0, r1) = (unit(self.radii[0]), unit(self.radii[1]));
        let delta = (r1 - r0.clone()).scale2(-self.axis.thin);
        // Divided by 2^2j where δ' is about 2^j.
        let j = 2 * self.axis.thin.min(0);
        let aa2 = aa.clone().square();
        let linear = r0.clone() * delta.clone() * aa.clone();
        let q = spread(&aa2, &(aa + delta.square()), &a);
        let form = Form { q, b: a.map(|x| -(linear.clone() * x)), c: -(r0.square() * aa2) };
        Form { q: form.q.map(|x| x.scale2(j)), b: form.b.map(|x| x.scale2(j)), c: form.c.scale2(j) }
    }

    fn bounds(&self) -> Aabb {
        self.axis.bounds(self.radii[0], self.radii[1])
    }

    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart {
        let r = match face as u32 {
            WALL => return self.axis.chart(y, n, None),
            BASE => self.radii[0],
            _ => self.radii[1],
        };
        let r = durer_math::scale::ldexp(r, -self.axis.scale);
        let r = if r > 0.0 { r } else { 1.0 };
        self.axis.chart(y, n, Some(r))
    }

    /// The tip of a full cone points away from the disc.
    fn tip(&self, face: usize) -> Option<Tip> {
        let (k, _) = self.axis.direction();
        let is_pointed = self.radii.contains(&0.0);
        let normal = if self.radii[0] < self.radii[1] { -k } else { k };
        (face as u32 == WALL && is_pointed).then_some(Tip { normal, is_double: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Exact, ExactBody, ExactForm, Feature, TestRng, check_many, exact3};
    use crate::{Placed, Surface};

    /// `|y|²|a|^2n - ...`, written out from the definition.
    fn exact(base: Point3, r0: f64, cap: Point3, r1: f64, open: bool) -> ExactBody {
        let b = exact3(base.to_array());
        let a = [0, 1, 2].map(|i| &Exact::from(cap[i]) - &b[i]);
        let aa = a.iter().fold(Exact::zero(), |s, x| &s + &x.squared());
        let (r0e, delta) = (Exact::from(r0), &Exact::from(r1) - &Exact::from(r0));
        // (|y|² |a|² - (y·a)²) |a|² - (r0 |a|² + δ y·a)².
        let entry = |i: usize, j: usize| {
            let diagonal = if i == j { aa.squared() } else { Exact::zero() };
            &diagonal - &(&(&a[i] * &a[j]) * &(&aa + &delta.squared()))
        };
        let linear = [0, 1, 2].map(|i| -(&(&(&r0e * &delta) * &aa) * &a[i]));
        let wall = ExactForm {
            q: core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j))),
            b: linear,
            c: -(&r0e.squared() * &aa.squared()),
        }
        .translated(&b);
        let faces = vec![
            wall,
            ExactForm::half_space(a.clone().map(|x| -x), b),
            ExactForm::half_space(a, exact3(cap.to_array())),
        ];
        let size = (cap - base).length().max(r0).max(r1);
        ExactBody { walls: if open { 1 } else { 3 }, faces, size, convex: !open }
    }

    /// Rims, the axis, generators and tangents. `e` has integer vectors across the axis of the same
    /// length.
    fn features(base: Point3, r: [f64; 2], cap: Point3, e: [Vec3; 2]) -> Vec<Feature> {
        let a = cap - base;
        let length = e[0].length();
        let mut out = vec![
            Feature { point: base, direction: a },
            Feature { point: cap, direction: e[0] },
            Feature { point: base + a * 0.5, direction: a },
        ];
        for (x, y) in [(1.0, 0.0), (0.0, -1.0), (0.6, 0.8)] {
            let out_of = (e[0] * x + e[1] * y) * (1.0 / length);
            let across = (e[1] * x - e[0] * y) * (1.0 / length);
            let (p, q) = (base + out_of * r[0], cap + out_of * r[1]);
            for d in [q - p, across, out_of, a, a + across, Vec3::ZERO] {
                out.push(Feature { point: p, direction: d });
                out.push(Feature { point: q, direction: d });
                out.push(Feature { point: p + (q - p) * 0.25, direction: d });
            }
        }
        out
    }

    /// Axes of integer length, each with integer vectors across.
    const AXES: [[[f64; 3]; 3]; 4] = [
        [[0.0, 0.0, 4.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]],
        [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]],
        [[-2.0, 3.0, 6.0], [3.0, 6.0, -2.0], [6.0, -2.0, 3.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    ];

    fn round(seed: u64, wild: bool) -> (Point3, Point3, [f64; 2], [Vec3; 2]) {
        let mut dice = TestRng::new(seed);
        let [a, e, f] = dice.pick(&AXES).map(Vec3::from);
        let k = if wild && dice.once_in(4) { dice.power(-250, 250) } else { dice.power(-4, 4) };
        let mut base = (dice.lattice(6) * k).to_point();
        let mut cap = base + a * (k * dice.pick(&[1.0, 0.125, 16.0, 4096.0, 0.00390625]));
        let mut radii = [dice.integer(1, 8) * 0.5 * k, dice.integer(0, 8) * 0.5 * k];
        if dice.once_in(3) {
            base = base + dice.vector() * k;
            cap = cap + dice.vector() * k;
            radii = [dice.unit() * k, dice.unit() * k];
        }
        if dice.once_in(2) {
            radii = [radii[1], radii[0]];
        }
        (base, cap, radii, [e, f])
    }

    #[test]
    fn cylinders_obey_the_laws() {
        let mut grazing = 0;
        for seed in 0..40 {
            let (base, cap, [r, s], e) = round(seed, true);
            let r = r.max(s);
            let open = seed % 3 == 0;
            let cylinder =
                if open { CappedCylinder::open(base, cap, r) } else { CappedCylinder::new(base, cap, r) };
            let oracle = exact(base, r, cap, r, open);
            let mut tally =
                check_many(&cylinder.unwrap(), &oracle, &features(base, [r, r], cap, e), seed, 150);
            assert!(tally.roots > 20, "{seed}");
            assert!(tally.median_width() < 32.0);
            grazing += tally.grazing;
        }
        assert!(grazing > 50, "only {grazing} tangents");
    }

    #[test]
    fn cones_obey_the_laws() {
        let mut grazing = 0;
        for seed in 0..40 {
            let (base, cap, r, e) = round(seed, true);
            let open = seed % 3 == 0;
            let cone =
                if open { Frustum::open(base, r[0], cap, r[1]) } else { Frustum::new(base, r[0], cap, r[1]) };
            let oracle = exact(base, r[0], cap, r[1], open);
            let mut tally = check_many(&cone.unwrap(), &oracle, &features(base, r, cap, e), seed, 150);
            assert!(tally.roots > 20, "{seed}");
            assert!(tally.median_width() < 32.0);
            grazing += tally.grazing;
        }
        assert!(grazing > 50, "only {grazing} tangents");
    }

    #[test]
    fn a_cap_has_tangents_on_its_axis() {
        let (base, cap) = (Point3::new(2.0, -2.0, -1.0), Point3::new(10.0, 14.0, 15.0));
        let axis = Vec3::new(0.0018440873328452049, 0.0036881746656904097, 0.0036881746656904097);
        let ray = durer_math::Ray::new(Point3::new(6.0, 6.0, 7.0), axis)
            .with_range(f64::NEG_INFINITY, f64::INFINITY);
        let oracle = exact(base, 0.5, cap, 0.5, false);
        crate::laws::check(&CappedCylinder::new(base, cap, 0.5).unwrap(), &oracle, &ray).unwrap();
    }

    #[test]
    fn placed_cones_obey_the_laws() {
        for seed in 0..40 {
            let map = TestRng::new(seed + 1000).map();
            let (base, cap, r, e) = round(seed, false);
            let cone = Placed::new(Frustum::new(base, r[0], cap, r[1]).unwrap(), map);
            let oracle = exact(base, r[0], cap, r[1], false).placed(&map);
            let features: Vec<_> = features(base, r, cap, e).into_iter().map(|f| f.placed(&map)).collect();
            check_many(&cone, &oracle, &features, seed, 100);
        }
    }

    #[test]
    fn bounds_touch_the_rims() {
        let b = CappedCylinder::new(Point3::ORIGIN, Point3::new(0.0, 0.0, 2.0), 1.0).unwrap().bounds();
        assert!(b.max.x < 1.0 + 1e-14 && b.max.x >= 1.0 && b.min.z <= 0.0 && b.min.z > -1e-14);
    }
}
