//! One face in f64: `f(y) = y·Qy + 2 b·y + c`, negative inside, with bounds on its coefficients'
//! errors.
//!
//! **Errors.** Coefficients are within `e_Q`, `e_b`, `e_c` of the exact ones. With `|h|₁`, `|d|₁`
//! the sums of absolute values, `M = max |Q_ij|` and `B = max |b_i|`, every formula below takes at
//! most 10 roundings (`h = o - centre` included), so that
//!
//! ```text
//!   |δA| <= |d|₁² k_Q                        k_Q = 16 U M + e_Q
//!   |δB| <= |d|₁ (|h|₁ k_Q + k_b)            k_b = 16 U B + e_b
//!   |δC| <= |h|₁ (|h|₁ k_Q + 2 k_b) + k_c    k_c = 16 U |c| + e_c
//! ```
//!
//! where the 16 includes the second order and the rounding of these bounds themselves.
//!
//! **Underflow.** Forms are scaled so that `max(M, B)` is between 1 and 2, and `|d|₁` is between
//! `2^-200` and its inverse (`rays.rs`). `TINY = 2^-550` is added to `k_c`, so the error of the
//! discriminant is at least `|δA| |δC| >= 2^-450 2^-550` where `M >= 1`, and at least `|δB|² >=
//! 2^-500` where `B >= 1`: far above the `2^-1074` that a product may lose to underflow. Where `A`
//! itself is that small, its far root is beyond `FAR`.

use crate::faces::form::Form;
use durer_math::{Dd, EFloat, F8, U, Vec3};

/// See the head of this file.
const TINY: f64 = durer_math::scale::pow2(-550);

/// A face in f64.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuadricFace8 {
    pub(crate) kind: FaceKind,
    /// `xx, yy, zz, xy, xz, yz`.
    q: [f64; 6],
    b: [f64; 3],
    c: f64,
    k_q: f64,
    k_b: f64,
    k_c: f64,
    /// `M` and `B`.
    largest: (f64, f64),
    /// The error of the entries of `b` alone.
    e_b: f64,
    /// An upper bound of the norm of the Hessian `2 Q`.
    pub(crate) bend: f64,
}

/// Which terms a form has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaceKind {
    /// No `Q`.
    Plane,
    /// `Q` is a multiple of the identity, and `b` is zero.
    Ball,
    /// All terms.
    Quadric,
}

/// `A t² + 2 B t + C` along eight rays, with bounds on the errors.
#[derive(Clone, Copy)]
pub(crate) struct Quadratic8 {
    pub(crate) a: F8,
    pub(crate) b: F8,
    pub(crate) c: F8,
    pub(crate) e_a: F8,
    pub(crate) e_b: F8,
    pub(crate) e_c: F8,
}

/// Eight rays relative to the filter's centre.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub(crate) d: &'a Vec3<F8>,
    /// `|d|₁`.
    pub(crate) d1: &'a F8,
    pub(crate) start: &'a Start,
}

/// The starts of eight rays relative to the filter's centre.
#[derive(Debug)]
pub(crate) struct Start {
    pub(crate) h: Vec3<F8>,
    /// `|h|₁`.
    pub(crate) h1: F8,
    /// A bound on every `t` at which a ray can meet the surface.
    pub(crate) far: F8,
}

impl Default for Start {
    fn default() -> Self {
        Self { h: Vec3::splat(Vec3::ZERO), h1: F8::ZERO, far: F8::ZERO }
    }
}

/// The sum of absolute values, rounded.
#[inline(always)]
pub(crate) fn taxicab(v: Vec3<F8>) -> F8 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// `a·v` for one vector and eight.
#[inline(always)]
fn dot(a: [f64; 3], v: Vec3<F8>) -> F8 {
    let [x, y, z] = F8::splats(a);
    x.mul_add(v.x, y.mul_add(v.y, z * v.z))
}

#[inline(always)]
fn dot8(a: Vec3<F8>, v: Vec3<F8>) -> F8 {
    a.x.mul_add(v.x, a.y.mul_add(v.y, a.z * v.z))
}

impl QuadricFace8 {
    /// Rounds a form; `None` if its numbers are too large or too small for f64 packets.
    pub(crate) fn new(form: &Form<EFloat<Dd>>) -> Option<Self> {
        let most = |part: &[EFloat<Dd>]| part.iter().map(|x| x.value().abs()).fold(0.0, f64::max);
        // In this range products of coefficients, squares of coordinates and their errors stay
        // normal numbers.
        let scale = most(&form.q).max(most(&form.b));
        let k = -durer_math::eft::exponent(scale);
        if !(scale > 0.0 && scale < f64::INFINITY && k.abs() < 900) {
            return None;
        }
        let mut lost = [0.0_f64; 3];
        let mut round = |x: &EFloat<Dd>, part: usize| {
            let x = durer_math::Ring::scale2(*x, k);
            lost[part] = lost[part].max((x.v.lo.abs() + x.e) * (1.0 + 8.0 * U));
            x.v.hi
        };
        let q: [f64; 6] = core::array::from_fn(|i| round(&form.q[i], 0));
        let b: [f64; 3] = core::array::from_fn(|i| round(&form.b[i], 1));
        let c = round(&form.c, 2);
        let [e_q, e_b, e_c] = lost;
        let fold = |part: &[f64]| part.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let (m, big) = (fold(&q), fold(&b));
        let all = [m, big, c.abs(), e_q, e_b, e_c];
        if !all.iter().all(|x| *x < super::source::LARGEST * super::source::LARGEST) {
            return None;
        }
        let [xx, yy, zz, xy, xz, yz] = q;
        let off_diagonal = [xy, xz, yz].iter().all(|&x| x == 0.0);
        let kind = if m == 0.0 && e_q == 0.0 {
            FaceKind::Plane
        } else if off_diagonal && xx == yy && yy == zz && xx > 0.0 && big == 0.0 && e_b == 0.0 {
            FaceKind::Ball
        } else {
            FaceKind::Quadric
        };
        let frobenius = (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz)).sqrt();
        Some(Self {
            kind,
            q,
            b,
            c,
            k_q: 16.0 * U * m + e_q,
            k_b: 16.0 * U * big + e_b,
            k_c: 16.0 * U * c.abs() + e_c + TINY,
            largest: (m, big),
            e_b,
            bend: 2.0 * (frobenius * (1.0 + 16.0 * U) + 3.0 * e_q),
        })
    }

    /// `Q v`.
    #[inline(always)]
    fn times(&self, v: Vec3<F8>) -> Vec3<F8> {
        let [xx, yy, zz, xy, xz, yz] = self.q;
        Vec3::new(dot([xx, xy, xz], v), dot([xy, yy, yz], v), dot([xz, yz, zz], v))
    }

    /// `B`, a bound on its error, and `C` without the constant, along eight rays, of a plane: `2 B
    /// t + C`.
    ///
    /// The error of `B` is computed coefficient by coefficient, so a ray parallel to the plane has
    /// exactly `B = 0`.
    #[inline(always)]
    pub(crate) fn slope(&self, rays: &Seen<'_>) -> (F8, F8, F8) {
        let b = dot(self.b, *rays.d);
        let size = dot(self.b.map(f64::abs), rays.d.abs());
        let e_b = size * (8.0 * U) + *rays.d1 * self.e_b;
        let c = dot(self.b, rays.start.h) * 2.0;
        (b, e_b, c)
    }

    /// The constant, and a bound on the error of `C` along eight rays, of a plane.
    #[inline(always)]
    pub(crate) fn height(&self, rays: &Seen<'_>) -> (f64, F8) {
        (self.c, rays.start.h1 * (2.0 * self.k_b) + self.k_c)
    }

    /// A lower bound of `|b·d|` along eight rays; not positive if there is none.
    #[inline(always)]
    pub(crate) fn slope_at_least(&self, rays: &Seen<'_>) -> F8 {
        let (b, e_b, _) = self.slope(rays);
        b.abs() - e_b * (1.0 + 4.0 * U)
    }

    /// An upper bound of `|b|₁`.
    pub(crate) fn b1(&self) -> f64 {
        (self.b.iter().map(|b| b.abs()).sum::<f64>() + 3.0 * self.e_b) * (1.0 + 8.0 * U)
    }

    /// Whether two faces are parallel planes with opposite normals.
    pub(crate) fn is_opposite(&self, other: &Self) -> bool {
        let planes = self.kind == FaceKind::Plane && other.kind == FaceKind::Plane;
        planes && (0..3).all(|i| self.b[i] == -other.b[i]) && self.e_b == other.e_b
    }

    /// The polynomial along eight rays.
    #[inline(always)]
    pub(crate) fn along(&self, rays: &Seen<'_>) -> Quadratic8 {
        let (h, h1, d, d1) = (rays.start.h, rays.start.h1, *rays.d, *rays.d1);
        let e_a = d1 * d1 * self.k_q;
        if self.kind == FaceKind::Ball {
            let m = self.q[0];
            return Quadratic8 {
                a: dot8(d, d) * m,
                b: dot8(h, d) * m,
                c: dot8(h, h) * m + self.c,
                e_a,
                e_b: d1 * h1 * self.k_q,
                e_c: h1 * h1 * self.k_q + self.k_c,
            };
        }
        let linear = Vec3::splat(Vec3::from(self.b));
        let qd = self.times(d);
        let qh = self.times(h);
        let g = Vec3::new(qh.x + linear.x, qh.y + linear.y, qh.z + linear.z);
        let twice = Vec3::new(g.x + linear.x, g.y + linear.y, g.z + linear.z);
        Quadratic8 {
            a: dot8(qd, d),
            b: dot8(g, d),
            c: dot8(twice, h) + self.c,
            e_a,
            e_b: d1 * (h1 * self.k_q + self.k_b),
            e_c: h1 * (h1 * self.k_q + 2.0 * self.k_b) + self.k_c,
        }
    }

    /// `f` at points `y`, with a bound on the error if these are within `e1` (in the sum of
    /// absolute values) of the exact ones; `y1` is `|y|₁`.
    #[inline(always)]
    pub(crate) fn at(&self, y: Vec3<F8>, y1: F8, e1: F8) -> (F8, F8) {
        let (m, big) = self.largest;
        if self.kind == FaceKind::Plane {
            let f = dot(self.b, y) * 2.0 + self.c;
            return (f, (y1 * self.k_b + e1 * big) * 2.0 + self.k_c);
        }
        let (f, _) = self.value_and_half_gradient(y);
        // `|f(y + δ) - f(y)| <= |δ|₁ (2 (M |y|₁ + B) + M |δ|₁)`.
        let drift = e1 * ((y1 * m + big) * 2.0 + e1 * m);
        (f, y1 * (y1 * self.k_q + 2.0 * self.k_b) + self.k_c + drift * (1.0 + 16.0 * U))
    }

    /// A bound on the error of each entry of half the gradient at points with this `|y|₁`.
    #[inline(always)]
    pub(crate) fn gradient_error(&self, y1: F8) -> F8 {
        y1 * self.k_q + self.k_b
    }

    /// `f` and half its gradient.
    #[inline(always)]
    pub(crate) fn value_and_half_gradient(&self, y: Vec3<F8>) -> (F8, Vec3<F8>) {
        let linear = Vec3::splat(Vec3::from(self.b));
        if self.kind == FaceKind::Plane {
            return (dot(self.b, y) * 2.0 + self.c, linear);
        }
        let qy = self.times(y);
        let g = Vec3::new(qy.x + linear.x, qy.y + linear.y, qy.z + linear.z);
        let twice = Vec3::new(g.x + linear.x, g.y + linear.y, g.z + linear.z);
        (dot8(twice, y) + self.c, g)
    }
}
