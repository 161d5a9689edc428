//! The general quadric.
//!
//! ```text
//!   f = A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J <= 0
//! ```
//!
//! Its kind follows from the inertia (how many eigenvalues are positive and negative) of `Q` and of
//! the 4x4 matrix of the homogeneous form. Both matrices are symmetric, so all their eigenvalues
//! are real, and Descartes' rule of signs on the characteristic polynomials counts them exactly;
//! the signs of those polynomials' coefficients are computed in exact arithmetic.

use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::chart::{Chart, Frame, Tip, sheared, sphere_chart};
use crate::faces::extent::QuadricExtent;
use crate::faces::form::Form;
use crate::quadric::solid::QuadricSolid;
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Dd, Dyadic, EFloat, Point3, Ring, Vec3};
use durer_roots::quadratic::exact_sign;

/// The general quadric, as a solid where its polynomial is negative.
pub type Quadric = QuadricSolid<GeneralQuadric>;

/// The coefficients of `x² y² z² xy xz yz x y z 1`.
///
/// # Invariants
///
/// All are finite, and at least one other than the last is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralQuadric {
    coefficients: [f64; 10],
    kind: QuadricKind,
    frame: Frame,
    /// The normal where the gradient vanishes.
    tip: Vec3,
    /// The exponent of the power of two that makes the coefficients about one in the frame.
    gain: i32,
}

/// Why a [`Quadric`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QuadricError {
    /// A coefficient is infinite or NaN.
    #[error("quadric: coefficient {index} must be finite, got {value}")]
    Coefficient {
        /// Its index, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All coefficients but the constant are zero: no surface.
    #[error("quadric: all coefficients but the constant are zero")]
    Constant,
}

/// The kinds of quadric. An "imaginary" one has no real point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name is its own description")]
pub enum QuadricKind {
    Ellipsoid,
    ImaginaryEllipsoid,
    HyperboloidOfOneSheet,
    HyperboloidOfTwoSheets,
    Cone,
    Point,
    EllipticParaboloid,
    HyperbolicParaboloid,
    EllipticCylinder,
    ImaginaryCylinder,
    HyperbolicCylinder,
    ParabolicCylinder,
    IntersectingPlanes,
    Line,
    ParallelPlanes,
    ImaginaryPlanes,
    CoincidentPlanes,
    Plane,
}

impl Quadric {
    /// The quadric with the coefficients of `x² y² z² xy xz yz x y z 1`, in this order.
    pub fn new(coefficients: [f64; 10]) -> Result<Self, QuadricError> {
        if let Some(index) = coefficients.iter().position(|x| !x.is_finite()) {
            return Err(QuadricError::Coefficient { index, value: coefficients[index] });
        }
        if coefficients[..9].iter().all(|&x| x == 0.0) {
            return Err(QuadricError::Constant);
        }
        let kind = classify(&coefficients);
        let (frame, gain, tip) = frame(&coefficients);
        Ok(Self::of(GeneralQuadric { coefficients, kind, frame, tip, gain }))
    }

    /// The coefficients of `x² y² z² xy xz yz x y z 1`.
    pub fn coefficients(&self) -> [f64; 10] {
        self.shape().coefficients
    }

    /// The kind of quadric.
    pub fn kind(&self) -> QuadricKind {
        self.shape().kind
    }
}

/// `Q`, `b` and `c` from the coefficients, in a ring.
fn matrix<T: Ring>(k: &[f64; 10]) -> ([[T; 3]; 3], [T; 3], T) {
    let [xx, yy, zz] = [0, 1, 2].map(|i| T::exact(k[i]));
    let [xy, xz, yz] = [3, 4, 5].map(|i| T::exact(k[i]).scale2(-1));
    let q = [[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]];
    (q, [6, 7, 8].map(|i| T::exact(k[i]).scale2(-1)), T::exact(k[9]))
}

/// How many eigenvalues of a real symmetric matrix are positive and how many negative, from the
/// coefficients of its characteristic polynomial (leading one first): Descartes' rule is exact
/// where all roots are real.
fn inertia(polynomial: &[Dyadic]) -> (usize, usize) {
    let changes = |signs: &mut dyn Iterator<Item = Ordering>| {
        let mut last = Ordering::Equal;
        let mut n = 0;
        for s in signs.filter(|&s| s != Ordering::Equal) {
            n += usize::from(last != Ordering::Equal && s != last);
            last = s;
        }
        n
    };
    let signs = || polynomial.iter().map(exact_sign);
    let alternating = signs().enumerate().map(|(i, s)| if i % 2 == 0 { s } else { s.reverse() });
    (changes(&mut signs()), changes(&mut { alternating }))
}

/// The characteristic polynomial by the Faddeev-LeVerrier recurrence, times positive integers
/// (which divide nothing here: each coefficient is scaled by `k!`, which does not change signs).
fn characteristic<const N: usize>(m: &[[Dyadic; N]; N]) -> Vec<Dyadic> {
    let zero = || Dyadic::from(0.0);
    let product = |a: &[[Dyadic; N]; N], b: &[[Dyadic; N]; N]| -> [[Dyadic; N]; N] {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..N).fold(zero(), |s, k| &s + &(&a[i][k] * &b[k][j])))
        })
    };
    // Newton's identities: k e_k = sum_{i=1..k} (-1)^(i-1) e_{k-i} p_i with power sums p_i = tr
    // M^i; E_k = k! e_k obeys E_k = sum (-1)^(i-1) (k-1)!/(k-i)! E_{k-i} p_i.
    let mut powers = vec![];
    let mut power = m.clone();
    for _ in 0..N {
        powers.push((0..N).fold(zero(), |s, i| &s + &power[i][i]));
        power = product(&power, m);
    }
    let mut e = vec![Dyadic::from(1.0)];
    for k in 1..=N {
        let mut sum = zero();
        let mut falling = 1.0;
        for i in 1..=k {
            let term = &(&e[k - i] * &powers[i - 1]) * &Dyadic::from(falling);
            sum = if i % 2 == 1 { &sum + &term } else { &sum - &term };
            falling *= (k - i) as f64;
        }
        e.push(sum);
    }
    // λ^n - e_1 λ^(n-1) + e_2 λ^(n-2) - ...
    e.into_iter().enumerate().map(|(k, x)| if k % 2 == 1 { -x } else { x }).collect()
}

fn classify(k: &[f64; 10]) -> QuadricKind {
    use QuadricKind as K;
    let (q, b, c) = matrix::<Dyadic>(k);
    let (p3, n3) = inertia(&characteristic(&q));
    let full: [[Dyadic; 4]; 4] = core::array::from_fn(|i| {
        core::array::from_fn(|j| match (i, j) {
            (3, 3) => c.clone(),
            (3, j) => b[j].clone(),
            (i, 3) => b[i].clone(),
            (i, j) => q[i][j].clone(),
        })
    });
    let (p4, n4) = inertia(&characteristic(&full));
    // A matrix and its negative describe the same surface.
    let flip = (n3, n4) > (p3, p4);
    let (p3, n3, p4, n4) = if flip { (n3, p3, n4, p4) } else { (p3, n3, p4, n4) };
    match (p3, n3, p4 + n4) {
        (3, 0, 4) if n4 == 1 => K::Ellipsoid,
        (3, 0, 4) => K::ImaginaryEllipsoid,
        (3, 0, _) => K::Point,
        (2, 1, 4) if n4 == 2 => K::HyperboloidOfOneSheet,
        (2, 1, 4) => K::HyperboloidOfTwoSheets,
        (2, 1, _) => K::Cone,
        (2, 0, 4) => K::EllipticParaboloid,
        (1, 1, 4) => K::HyperbolicParaboloid,
        (2, 0, 3) if n4 == 1 => K::EllipticCylinder,
        (2, 0, 3) => K::ImaginaryCylinder,
        (2, 0, _) => K::Line,
        (1, 1, 3) => K::HyperbolicCylinder,
        (1, 1, _) => K::IntersectingPlanes,
        (1, 0, 3) => K::ParabolicCylinder,
        (1, 0, 2) if n4 == 1 => K::ParallelPlanes,
        (1, 0, 2) => K::ImaginaryPlanes,
        (1, 0, _) => K::CoincidentPlanes,
        _ => K::Plane,
    }
}

/// Eigenvalues and vectors of a symmetric matrix by Jacobi's rotations (H. Rutishauser, "The Jacobi
/// method for real symmetric matrices", *Numerische Mathematik* 9, 1966). They only choose a frame,
/// so rounding does no harm.
fn eigen(mut m: [[f64; 3]; 3]) -> ([f64; 3], [Vec3; 3]) {
    let mut v = [Vec3::X, Vec3::Y, Vec3::Z];
    for _ in 0..12 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if m[i][j] == 0.0 {
                continue;
            }
            let theta = (m[j][j] - m[i][i]) / (2.0 * m[i][j]);
            let t = 1.0_f64.copysign(theta) / (theta.abs() + theta.mul_add(theta, 1.0).sqrt());
            let c = 1.0 / t.mul_add(t, 1.0).sqrt();
            let s = t * c;
            for row in &mut m {
                (row[i], row[j]) = (c * row[i] - s * row[j], s * row[i] + c * row[j]);
            }
            let (a, b) = (m[i], m[j]);
            for k in 0..3 {
                (m[i][k], m[j][k]) = (c * a[k] - s * b[k], s * a[k] + c * b[k]);
            }
            (v[i], v[j]) = (v[i] * c - v[j] * s, v[i] * s + v[j] * c);
        }
    }
    ([m[0][0], m[1][1], m[2][2]], v)
}

/// For the choice of a centre, a curvature below this fraction of the largest counts as zero.
const NEARLY_PARABOLIC: f64 = 1.0 / 64.0;

/// A frame for re-centring rays: the centre or vertex, and the surface's size there. Any numbers
/// are correct; these give small errors.
fn frame(k: &[f64; 10]) -> (Frame, i32, Vec3) {
    let k_max = k.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let unit = |x: f64| durer_math::eft::scale2(x, -exponent(k_max));
    let k = k.map(unit);
    let half = |x: f64| 0.5 * x;
    let q = [[k[0], half(k[3]), half(k[4])], [half(k[3]), k[1], half(k[5])], [half(k[4]), half(k[5]), k[2]]];
    let b = Vec3::new(half(k[6]), half(k[7]), half(k[8]));
    let (values, vectors) = eigen(q);
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    // The centre, from the directions in which the surface curves more than this.
    let centre_without = |weak: f64| {
        let strong = values.iter().zip(&vectors).filter(|(value, _)| value.abs() > weak * largest);
        strong.fold(Vec3::ZERO, |c, (value, &v)| c - v * (b.dot(v) / value))
    };
    let qv = |v: Vec3| Vec3::new(Vec3::from(q[0]).dot(v), Vec3::from(q[1]).dot(v), Vec3::from(q[2]).dot(v));
    let f = |x: Vec3| x.dot(qv(x) + b * 2.0) + k[9];
    // A paraboloid's vertex: along the part of the gradient that Q cannot move.
    let vertex = |c: Vec3, g: Vec3| (c - g * (f(c) / (2.0 * g.length_squared())), 2.0 * g.length() / largest);
    let mut c = centre_without(1e-12);
    let mut size = 0.0;
    if largest > 0.0 {
        let g = qv(c) + b;
        (c, size) =
            if g.length() > 1e-9 * b.length() { vertex(c, g) } else { (c, (f(c).abs() / largest).sqrt()) };
        // A surface that is almost a paraboloid has its centre far away from the surface. Then its
        // vertex is used, if that is nearer and on the surface.
        let near = centre_without(NEARLY_PARABOLIC);
        let (near, near_size) = vertex(near, qv(near) + b);
        let slope = qv(near) + b;
        if near.length() < 0.5 * c.length() && f(near).abs() <= near_size * slope.length() {
            (c, size) = (near, near_size);
        }
    } else {
        c = b * (-0.5 * k[9] / b.length_squared());
    }
    let usable = |x: f64| x.is_finite() && x > 1e-140 && x < 1e140;
    let centre = if c.is_finite() && c.max_abs() < 1e140 { c.to_point() } else { Point3::ORIGIN };
    let scale = if usable(size) { exponent(size) } else { 0 };
    let gain = -exponent(k_max) - if largest > 0.0 { 2 * scale } else { scale };
    // The axis of a cone belongs to the eigenvalue whose sign is unique. For other quadrics the
    // form must not vanish along the axis; the more it changes the better.
    let product = values[0] * values[1] * values[2];
    let positive = values.iter().filter(|&&x| x > 0.0).count();
    let tip = (0..3)
        .filter(|&i| product == 0.0 || positive % 3 == 0 || (values[i] > 0.0) == (positive == 1))
        .max_by(|&i, &j| values[i].abs().total_cmp(&values[j].abs()))
        .map_or(Vec3::Z, |i| vectors[i]);
    (Frame { centre, scale, reach: f64::INFINITY }, gain, tip * (1.0 / tip.length()))
}

impl QuadricFaces for GeneralQuadric {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn faces(&self) -> usize {
        1
    }

    #[inline(always)]
    fn form<T: Ring>(&self, _: usize) -> Form<T> {
        // x = p + 2^s y: Q' = 4^s Q, b' = 2^s (Q p + b), c' = f(p), all times 2^gain.
        let (q, b, c) = matrix::<T>(&self.coefficients);
        let (s, gain) = (self.frame.scale, self.gain);
        let p = self.frame.centre.to_array().map(T::exact);
        let dot = |a: &[T; 3], b: &[T; 3]| {
            a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
        };
        let qp = q.each_ref().map(|row| dot(row, &p));
        let at = dot(&qp, &p) + dot(&b, &p).scale2(1) + c;
        let linear = [0, 1, 2].map(|i| (qp[i].clone() + b[i].clone()).scale2(s + gain));
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = q;
        Form { q: [xx, yy, zz, xy, xz, yz].map(|x| x.scale2(2 * s + gain)), b: linear, c: at.scale2(gain) }
    }

    fn bounds(&self) -> Aabb {
        self.ellipsoid_bounds().unwrap_or(Aabb::UNBOUNDED)
    }

    fn bounds_within(&self, slab: &Aabb) -> Aabb {
        // Each of the two solids contains the surface.
        QuadricExtent::of_both_sides(&self.coefficients)
            .iter()
            .fold(self.bounds().intersection(*slab), |bounds, solid| solid.bounds_within(&bounds))
    }

    fn tip(&self, _: usize) -> Option<Tip> {
        use QuadricKind as K;
        let singular = [K::Cone, K::Point, K::IntersectingPlanes, K::Line, K::CoincidentPlanes];
        let is_double = matches!(self.kind, K::Cone | K::IntersectingPlanes);
        singular.contains(&self.kind).then_some(Tip { normal: self.tip, is_double })
    }

    /// Longitude and latitude about the centre.
    fn chart(&self, _: usize, y: Vec3, n: Vec3) -> Chart {
        let Chart { uv, dpdu, dpdv } = sphere_chart(y);
        // The tangents of the sphere through y, moved along y onto the surface.
        Chart { uv, dpdu: sheared(dpdu, y, n), dpdv: sheared(dpdv, y, n) }
    }
}

impl GeneralQuadric {
    /// The box of a solid ellipsoid: centre `-Q⁻¹b`, half-widths `√(K (Q⁻¹)ᵢᵢ)` with
    /// `K = b·Q⁻¹b - c`.
    fn ellipsoid_bounds(&self) -> Option<Aabb> {
        if self.kind != QuadricKind::Ellipsoid || self.coefficients[0] < 0.0 {
            return None;
        }
        type N = EFloat<Dd>;
        let form = self.form::<N>(0);
        let [xx, yy, zz, xy, xz, yz] = form.q;
        let adjugate = [
            [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy],
            [xz * yz - xy * zz, xx * zz - xz * xz, xy * xz - xx * yz],
            [xy * yz - xz * yy, xy * xz - xx * yz, xx * yy - xy * xy],
        ];
        let determinant = xx * adjugate[0][0] + xy * adjugate[0][1] + xz * adjugate[0][2];
        let dot = |a: [N; 3], b: [N; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let solved = adjugate.map(|row| dot(row, form.b) / determinant);
        let level = dot(solved, form.b) - form.c;
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let half = (level * adjugate[i][i] / determinant).sqrt();
            let ends = [-solved[i] - half, half - solved[i]]
                .map(|y| N::exact(self.frame.centre[i]) + y.scale2(self.frame.scale));
            (min[i], max[i]) = (ends[0].lo(), ends[1].hi());
        }
        let bounds = Aabb::new(min.into(), max.into());
        let sane = min.iter().chain(&max).all(|x| x.is_finite());
        sane.then_some(bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{ExactBody, ExactForm, Feature, TestRng, check_many};
    use crate::{Placed, Surface};
    use QuadricKind as K;

    const NAMED: [([f64; 10], QuadricKind); 18] = [
        ([1.0, 4.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], K::Ellipsoid),
        ([1.0, 4.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0], K::ImaginaryEllipsoid),
        ([1.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], K::HyperboloidOfOneSheet),
        ([1.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0], K::HyperboloidOfTwoSheets),
        ([1.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], K::Cone),
        ([1.0, 4.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], K::Point),
        ([1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0], K::EllipticParaboloid),
        ([1.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0], K::HyperbolicParaboloid),
        ([1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], K::EllipticCylinder),
        ([1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0], K::ImaginaryCylinder),
        ([1.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], K::HyperbolicCylinder),
        ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], K::ParabolicCylinder),
        ([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], K::IntersectingPlanes),
        ([1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], K::Line),
        ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], K::ParallelPlanes),
        ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0], K::ImaginaryPlanes),
        ([1.0, 1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], K::CoincidentPlanes),
        ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, -9.0], K::Plane),
    ];

    #[test]
    fn each_kind_is_known_by_its_inertia_in_any_place() {
        for (k, kind) in NAMED {
            assert_eq!(Quadric::new(k).unwrap().kind(), kind);
            assert_eq!(Quadric::new(k.map(|x| -x)).unwrap().kind(), kind);
            let [a, b, c, d, e, f, g, h, i, j] = k;
            // x -> z -> y -> x, and moved by (3, -2, 0): f(x - 3, y + 2, z).
            assert_eq!(Quadric::new([b, c, a, f, d, e, h, i, g, j]).unwrap().kind(), kind);
            let moved = [
                a,
                b,
                c,
                d,
                e,
                f,
                g - 6.0 * a + 2.0 * d,
                h + 4.0 * b - 3.0 * d,
                i - 3.0 * e + 2.0 * f,
                j + 9.0 * a + 4.0 * b - 6.0 * d - 3.0 * g + 2.0 * h,
            ];
            assert_eq!(Quadric::new(moved).unwrap().kind(), kind);
        }
    }

    /// The vertices of a quadric in canonical position, and directions in which it is flat or
    /// asymptotic.
    fn features() -> Vec<Feature> {
        let mut out = vec![];
        for p in [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 2.0],
            [-2.0, 0.0, 0.0],
            [2.0, 1.0, 2.0],
            [2.0, -1.0, -2.0],
            [1.0, 4.0, 0.0],
            [2.0, 0.0, 4.0],
            [0.0, 0.0, -2.0],
            [2.0, 1.0, 0.0],
            [4.0, 0.0, 1.0],
        ] {
            for d in [
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
                [0.0, 1.0, 2.0],
                [2.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [2.0, -1.0, 4.0],
            ] {
                out.push(Feature::new(p, d));
            }
        }
        out
    }

    #[test]
    fn quadrics_obey_the_laws() {
        let mut grazing = 0;
        for (n, (k, kind)) in NAMED.into_iter().enumerate() {
            for seed in 0..4 {
                let mut dice = TestRng::new(seed + 100 * n as u64);
                let k = match seed {
                    0 => k,
                    1 => k.map(|x| -x),
                    // A size far from one, together with the whole frame.
                    2 => k.map(|x| x * dice.power(-3, 3) * 0.5),
                    _ => k.map(|x| x + if x == 0.0 { 0.0 } else { dice.between(-0.25, 0.25) }),
                };
                let quadric = Quadric::new(k).unwrap();
                let convex = kind == K::Ellipsoid && k[0] > 0.0;
                let oracle = ExactBody::solid(vec![ExactForm::from_f64(k)], 1.0, convex);
                let tally = check_many(&quadric, &oracle, &features(), seed + 100 * n as u64, 200);
                grazing += tally.grazing;
            }
        }
        assert!(grazing > 100, "only {grazing} tangents");
    }

    #[test]
    fn placed_quadrics_obey_the_laws() {
        for (n, (k, _)) in NAMED.into_iter().enumerate() {
            for seed in 0..4 {
                let map = TestRng::new(seed + 10 * n as u64).map();
                let quadric = Placed::new(Quadric::new(k).unwrap(), map);
                let oracle = ExactBody::solid(vec![ExactForm::from_f64(k)], 1.0, false).placed(&map);
                let features: Vec<_> = features().into_iter().map(|f| f.placed(&map)).collect();
                check_many(&quadric, &oracle, &features, seed + 100 * n as u64, 100);
            }
        }
    }

    #[test]
    fn an_ellipsoids_box_is_tight() {
        let b = Quadric::new(NAMED[0].0).unwrap().bounds();
        assert!(b.max.x >= 2.0 && b.max.x < 2.0 + 1e-14 && b.max.y >= 1.0 && b.max.y < 1.0 + 1e-14);
        assert_eq!(Quadric::new(NAMED[2].0).unwrap().bounds(), Aabb::UNBOUNDED);
    }

    /// Eigenvalues -2.78, 0.0026 and 4.78: the centre lies 770 away, the surface at the origin.
    #[test]
    fn nearly_parabolic_quadrics_are_bracketed_as_narrowly_as_others() {
        let k = [
            -1.761_590_687_233_151_3,
            2.851_397_615_184_67,
            0.918_960_358_388_875_9,
            3.888_426_133_993_613_5,
            3.251_953_448_049_5,
            3.359_998_088_976_735_4,
            3.642_265_064_905_554,
            -3.387_228_737_948_286,
            1.973_905_839_528_787_8,
            1.0,
        ];
        let quadric = Quadric::new(k).unwrap();
        let oracle = ExactBody::solid(vec![ExactForm::from_f64(k)], 1.0, false);
        let mut dice = TestRng::new(7);
        let mut widths = vec![];
        for _ in 0..600 {
            let (o, p) = (dice.vector() * 5.0, dice.vector() * 5.0);
            let ray = durer_math::Ray::new(o.to_point(), p - o);
            let roots = crate::laws::check(&quadric, &oracle, &ray).unwrap();
            widths.extend(roots.iter().map(|root| crate::laws::width(&quadric, &oracle, &ray, root)));
        }
        widths.sort_by(f64::total_cmp);
        assert!(widths.len() > 400 && widths[widths.len() / 2] < 100.0, "{:?}", widths[widths.len() / 2]);
    }
}
