//! On which side of an edge does a ray pass? Exactly, and never "on it".
//!
//! For the ray `o + t d` and the edge from `v1` to `v2`, with `a = v1 - o` and `b = v2 - o`, the
//! side is the sign of
//!
//! ```text
//!     U = d . (b x a)
//! ```
//!
//! It is computed in three stages: in f64 with Shewchuk's bound (`orient3d`, stage A); as a sum of
//! exact terms (`exact_sum.rs`); and, only where exponents are so extreme that these could under-
//! or overflow, with [`Dyadic`]. J. R. Shewchuk, "Adaptive precision floating-point arithmetic and
//! fast robust geometric predicates", Discrete & Computational Geometry 18 (1997).
//!
//! **Ties.** If `U = 0`, the ray is moved symbolically to `o + eps x_a + eps^2 x_b`, where `a < b`
//! are the axes other than the first one on which `|d|` is largest (simulation of simplicity: H.
//! Edelsbrunner, E. P. Mücke, ACM Transactions on Graphics 9, 1990). With `e = v2 - v1` the
//! derivatives of `U` are `(e x d)_a` and `(e x d)_b`; the first that is not zero gives the sign.
//! Both are zero only if `e` is parallel to `d` (or is zero). The rule uses coordinates only: two
//! triangles with a common edge get exactly opposite signs, whether or not they share an index. So
//! a ray crosses a closed mesh an even number of times, vertices and edges included.
//!
//! Coordinates must be finite; for others the answers are meaningless, but nothing panics.

use crate::eft::two_diff;
use crate::exact_sum::Terms;
use crate::scale::exponent;
use crate::{Dyadic, Isa, Point3, U, Vec3};
use core::cmp::Ordering;

/// The side on which a ray passes an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// `+1` or `-1`; `0` only if the edge is parallel to the ray's direction or has no length.
    pub sign: i8,
    /// `U` in f64.
    pub value: f64,
    /// A bound on the error of `value`; zero if `U` is exactly zero.
    pub error: f64,
}

/// A ray prepared for testing many edges.
///
/// ```
/// use durer_math::{EdgeRay, Point3, Vec3};
/// let ray = EdgeRay::new(Point3::new(0.0, 0.0, 5.0), Vec3::new(0.0, 0.0, -1.0));
/// let (p, q) = (Point3::new(-1.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0));
/// let (there, back) = (ray.edge(p, q), ray.edge(q, p)); // the ray meets this edge exactly
/// assert_eq!((there.value, back.value), (0.0, 0.0));
/// assert_eq!(there.sign, -back.sign);
/// assert_ne!(there.sign, 0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct EdgeRay {
    o: Point3,
    d: Vec3,
    /// A bound on the underflow error of `U`.
    floor: f64,
}

/// Seven roundings lie between the input and each term of `U` (two differences, product and sum of
/// a minor, three of the dot product); the rest pays for their second order and for the rounding of
/// the permanent and of the bound.
const FILTER: f64 = (7.0 + 72.0 * U) * U;

impl EdgeRay {
    /// The line of the ray from `o` along `d`.
    #[inline(always)]
    pub fn new(o: Point3, d: Vec3) -> Self {
        let m = d.abs();
        // A minor loses at most 2 * 2^-1075, the dot product 3 * 2^-1075. Far more is charged, so
        // that the floor is a normal number: subnormal operands and results cost a microcode
        // assist.
        let tiny = crate::scale::pow2(-1000);
        Self { o, d, floor: tiny.mul_add(m.x + m.y + m.z, tiny) }
    }

    /// The axes of the symbolic displacement: those other than the first on which `|d|` is largest.
    /// Needed for ties alone.
    fn axes(&self) -> [usize; 2] {
        let m = self.d.abs();
        if m.x >= m.y && m.x >= m.z {
            [1, 2]
        } else if m.y >= m.z {
            [0, 2]
        } else {
            [0, 1]
        }
    }

    /// The ray's origin.
    #[inline(always)]
    pub fn origin(&self) -> Point3 {
        self.o
    }

    /// The ray's direction.
    #[inline(always)]
    pub fn direction(&self) -> Vec3 {
        self.d
    }

    /// `U` in f64, and a bound on its error: the filter alone, for kernels that decide the rest
    /// themselves.
    ///
    /// The order of operations is part of the specification; vector kernels repeat it lane by lane.
    #[inline(always)]
    pub fn filter(&self, v1: Point3, v2: Point3) -> (f64, f64) {
        let (a, b, d) = (v1 - self.o, v2 - self.o, self.d);
        let (yz, zx, xy) = (b.z * a.y, b.x * a.z, b.y * a.x);
        let m = Vec3::new(b.y.mul_add(a.z, -yz), b.z.mul_add(a.x, -zx), b.x.mul_add(a.y, -xy));
        let (p, q, r) = (a.abs(), b.abs(), d.abs());
        let n = Vec3::new(q.y.mul_add(p.z, yz.abs()), q.z.mul_add(p.x, zx.abs()), q.x.mul_add(p.y, xy.abs()));
        (d.dot(m), FILTER.mul_add(r.dot(n), self.floor))
    }

    /// On which side the ray passes the edge from `v1` to `v2`.
    #[inline(always)]
    pub fn edge(&self, v1: Point3, v2: Point3) -> Edge {
        let (value, error) = self.filter(v1, v2);
        if value.abs() > error {
            return Edge { sign: if value > 0.0 { 1 } else { -1 }, value, error };
        }
        self.exact_edge(v1, v2)
    }

    /// As [`EdgeRay::edge`], without the filter: for callers that have failed it.
    #[cold]
    #[inline(never)]
    pub fn exact_edge(&self, v1: Point3, v2: Point3) -> Edge {
        Isa::detect().run(
            #[inline(always)]
            || self.exact_edge_here(v1, v2),
        )
    }

    #[inline(always)]
    fn exact_edge_here(&self, v1: Point3, v2: Point3) -> Edge {
        let (order, value, error) = self.exact_value(v1, v2);
        let sign = match order {
            Ordering::Greater => 1,
            Ordering::Less => -1,
            Ordering::Equal => {
                let [a, b] = self.axes();
                let first = self.minor_sign(v1, v2, a);
                if first != 0 { first } else { self.minor_sign(v1, v2, b) }
            }
        };
        Edge { sign, value, error }
    }

    #[inline(always)]
    fn exact_value(&self, v1: Point3, v2: Point3) -> (Ordering, f64, f64) {
        let o = self.o;
        if tame(&[o.x, o.y, o.z, v1.x, v1.y, v1.z, v2.x, v2.y, v2.z, self.d.x, self.d.y, self.d.z]) {
            let (a, b) = (differences(v1, o), differences(v2, o));
            let mut u = Terms::new();
            for (i, j, k) in [(1, 2, 0), (2, 0, 1), (0, 1, 2)] {
                add_triples(&mut u, b[i], a[j], self.d[k]);
                add_triples(&mut u, b[j], a[i], -self.d[k]);
            }
            if let Some(u) = u.sum() {
                return (u.sign, u.value, u.error);
            }
        }
        let a = exact_differences(v1, o);
        let b = exact_differences(v2, o);
        let d = [Dyadic::from(self.d.x), Dyadic::from(self.d.y), Dyadic::from(self.d.z)];
        let term = |i: usize, j: usize, k: usize| &(&(&b[i] * &a[j]) - &(&b[j] * &a[i])) * &d[k];
        let u = &(&term(1, 2, 0) + &term(2, 0, 1)) + &term(0, 1, 2);
        let (lo, hi) = u.to_bounds();
        let value = u.to_f64();
        (u.exact_sign(), value, hi - lo)
    }

    /// The sign of `((v2 - v1) x d)_axis`.
    #[inline(always)]
    fn minor_sign(&self, v1: Point3, v2: Point3, axis: usize) -> i8 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let (dj, dk) = (self.d[j], self.d[k]);
        if tame(&[v1[j], v1[k], v2[j], v2[k], dj, dk]) {
            let (ej, ek) = (two_diff(v2[j], v1[j]), two_diff(v2[k], v1[k]));
            let mut minor = Terms::new();
            for (e, d) in [(ej.1, dk), (ek.1, -dj), (ej.0, dk), (ek.0, -dj)] {
                minor.add_product(e, d);
            }
            if let Some(minor) = minor.sum() {
                return minor.sign as i8;
            }
        }
        let ej = Dyadic::from(v2[j]) - Dyadic::from(v1[j]);
        let ek = Dyadic::from(v2[k]) - Dyadic::from(v1[k]);
        (ej * Dyadic::from(dk) - ek * Dyadic::from(dj)).exact_sign() as i8
    }

    /// On which side of the plane of a triangle the origin lies: the sign of `n . (o - v0)`,
    /// `n = (v1 - v0) x (v2 - v0)`.
    ///
    /// An origin exactly in the plane is moved by the same symbolic displacement as in
    /// [`EdgeRay::edge`], and then by `eps^3 d`. Zero only for triangles without area. The plane is
    /// met at `t > 0` exactly if this sign is that of the triangle's edges `(v1, v2)`, `(v2, v0)`,
    /// `(v0, v1)`, where these agree.
    pub fn side(&self, v0: Point3, v1: Point3, v2: Point3) -> i8 {
        // n . (o - v0) = (v0 - o) . ((v2 - o) x (v1 - o)).
        let towards = Self::new(self.o, v0 - self.o);
        let (value, error) = towards.filter(v1, v2);
        // The direction is rounded here: one more relative error of every term.
        if value.abs() > error * (1.0 + 1.0 / 4.0) {
            return if value > 0.0 { 1 } else { -1 };
        }
        self.exact_side(v0, v1, v2)
    }

    #[cold]
    #[inline(never)]
    fn exact_side(&self, v0: Point3, v1: Point3, v2: Point3) -> i8 {
        let [q, r] = [v1, v2].map(|v| exact_differences(v, v0));
        let minor = |i: usize, j: usize| &(&q[i] * &r[j]) - &(&q[j] * &r[i]);
        let n = [minor(1, 2), minor(2, 0), minor(0, 1)];
        let o = exact_differences(self.o, v0);
        let d = [Dyadic::from(self.d.x), Dyadic::from(self.d.y), Dyadic::from(self.d.z)];
        let dot = |v: &[Dyadic; 3]| &(&(&n[0] * &v[0]) + &(&n[1] * &v[1])) + &(&n[2] * &v[2]);
        let [a, b] = self.axes();
        let terms = [dot(&o).exact_sign(), n[a].exact_sign(), n[b].exact_sign(), dot(&d).exact_sign()];
        terms.into_iter().find(|s| *s != Ordering::Equal).unwrap_or(Ordering::Equal) as i8
    }
}

/// Whether products of three of these numbers, or of their differences, neither overflow nor have
/// bits below `2^-1074`.
#[inline(always)]
fn tame(numbers: &[f64]) -> bool {
    // The least bit of a difference is at least 2^(-300 - 52); three such factors: 2^-1056.
    numbers.iter().all(|&x| x == 0.0 || (-300..=300).contains(&exponent(x)))
}

/// `v - o`, exactly: each axis as a number and what its rounding left.
#[inline(always)]
fn differences(v: Point3, o: Point3) -> [(f64, f64); 3] {
    [two_diff(v.x, o.x), two_diff(v.y, o.y), two_diff(v.z, o.z)]
}

/// Adds `a b c`, where `a` and `b` are sums of two numbers.
#[inline(always)]
fn add_triples(terms: &mut Terms, a: (f64, f64), b: (f64, f64), c: f64) {
    for (x, y) in [(a.1, b.1), (a.1, b.0), (a.0, b.1)] {
        if x != 0.0 && y != 0.0 {
            terms.add_triple(x, y, c);
        }
    }
    terms.add_triple(a.0, b.0, c);
}

fn exact_differences(v: Point3, o: Point3) -> [Dyadic; 3] {
    [0, 1, 2].map(|i| Dyadic::from(v[i]) - Dyadic::from(o[i]))
}
