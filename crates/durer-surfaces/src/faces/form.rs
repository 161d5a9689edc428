//! The quadratic form `f(x) = x·Qx + 2 b·x + c`, and its restriction to a ray.

use crate::RingRay;
use durer_math::{Dd, Dyadic, EFloat, Ring, U, Vec3};
use durer_roots::quadratic::Quadratic;

/// Covers underflow in sums of products of numbers of size one.
pub(crate) const FLOOR: f64 = 1e-290;

/// `f(x) = x·Qx + 2 b·x + c` with coefficients in a ring. Negative inside.
#[derive(Clone, Debug)]
pub struct Form<T> {
    /// `xx, yy, zz, xy, xz, yz` of the symmetric `Q`.
    pub q: [T; 6],
    /// Half the linear part.
    pub b: [T; 3],
    /// The constant.
    pub c: T,
}

impl<T: Ring> Form<T> {
    /// A form without mixed terms and without a linear part.
    pub fn diagonal(q: [T; 3], c: T) -> Self {
        let zero = || T::exact(0.0);
        let [x, y, z] = q;
        Self { q: [x, y, z, zero(), zero(), zero()], b: [zero(), zero(), zero()], c }
    }

    /// The half-space `normal2 · x + c <= 0`, with twice `b` given.
    pub fn half_space(twice_b: [T; 3], c: T) -> Self {
        let zero = || T::exact(0.0);
        let q = [zero(), zero(), zero(), zero(), zero(), zero()];
        Self { q, b: twice_b.map(|x| x.scale2(-1)), c }
    }

    /// The negated form: inside and outside are exchanged.
    #[must_use]
    pub fn negated(self) -> Self {
        Self { q: self.q.map(|x| -x), b: self.b.map(|x| -x), c: -self.c }
    }

    /// The form relative to `p`: `f(y + p)`.
    #[must_use]
    pub fn seen_from(self, p: &[T; 3]) -> Self {
        let c = self.at(p, &T::exact(1.0));
        let qp = self.times(p);
        let [x, y, z] = qp;
        let [bx, by, bz] = self.b;
        Self { q: self.q, b: [bx + x, by + y, bz + z], c }
    }

    #[inline(always)]
    fn times(&self, v: &[T; 3]) -> [T; 3] {
        #[inline(always)]
        fn row<T: Ring>(a: &T, b: &T, c: &T, v: &[T; 3]) -> T {
            a.clone() * v[0].clone() + b.clone() * v[1].clone() + c.clone() * v[2].clone()
        }
        let [xx, yy, zz, xy, xz, yz] = &self.q;
        [row(xx, xy, xz, v), row(xy, yy, yz, v), row(xz, yz, zz, v)]
    }

    /// `f w²` along the points `(o + s d) / w`.
    #[inline(always)]
    pub fn along(&self, ray: &RingRay<T>) -> Quadratic<T> {
        let qd = self.times(&ray.d);
        let wb = self.b.each_ref().map(|b| b.clone() * ray.w.clone());
        let a = dot(&qd, &ray.d);
        let b = dot(&qd, &ray.o) + dot(&wb, &ray.d);
        Quadratic { a, b, c: self.at(&ray.o, &ray.w) }
    }

    /// `f w²` at the point `p / w`.
    #[inline(always)]
    pub fn at(&self, p: &[T; 3], w: &T) -> T {
        let qp = self.times(p);
        let wb = self.b.each_ref().map(|b| b.clone() * w.clone());
        dot(&qp, p) + dot(&wb, p).scale2(1) + self.c.clone() * w.clone().square()
    }
}

#[inline(always)]
fn dot<T: Ring>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
}

/// `a v_x + b v_y + c v_z`.
#[inline(always)]
fn row(a: f64, b: f64, c: f64, v: Vec3) -> f64 {
    a.mul_add(v.x, b.mul_add(v.y, c * v.z))
}

/// A [`Form`] rounded to f64: each coefficient within the factor `1 ± rel` of the exact one, zeros
/// exact.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    q: [f64; 6],
    b: [f64; 3],
    c: f64,
    /// The relative error of the coefficients.
    rel: f64,
    /// An upper bound of the largest entry of `Q`.
    largest: f64,
    /// An upper bound of the spectral norm of the Hessian `2 Q`.
    pub(crate) bend: f64,
}

impl Rounded {
    /// Rounds a form that is given in `EFloat<Dd>`. Coefficients that this leaves uncertain are
    /// computed exactly.
    pub(crate) fn new(rough: &Form<EFloat<Dd>>, exact: impl Fn() -> Form<Dyadic>) -> Self {
        let coefficients = |f: &Form<EFloat<Dd>>| -> Option<[f64; 11]> {
            let mut out = [0.0; 11];
            for (i, x) in f.q.iter().chain(&f.b).chain([&f.c]).enumerate() {
                x.sign()?;
                out[i] = x.v.hi;
                let e = x.v.lo.abs() + x.e;
                if e > 0.0 {
                    out[10] = f64::max(out[10], e / x.v.hi.abs());
                }
            }
            (out[10] < 2.0 * U).then_some(out)
        };
        let all = coefficients(rough).unwrap_or_else(|| {
            let f = exact();
            let mut out = [0.0; 11];
            for (i, x) in f.q.iter().chain(&f.b).chain([&f.c]).enumerate() {
                out[i] = x.to_f64();
            }
            out[10] = U;
            out
        });
        let [xx, yy, zz, xy, xz, yz, bx, by, bz, c, rel] = all;
        let q = [xx, yy, zz, xy, xz, yz];
        let largest = q.iter().fold(0.0_f64, |m, x| m.max(x.abs())) * (1.0 + 8.0 * U);
        let squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
        let bend = if largest > 0.0 { 2.0 * (squares.sqrt() * (1.0 + 16.0 * U) + FLOOR) } else { 0.0 };
        Self { q, b: [bx, by, bz], c, rel: rel * (1.0 + 8.0 * U), largest, bend }
    }

    /// The form of a ball about the origin, `x·x - radius²`: the result of [`Rounded::new`],
    /// computed directly.
    #[inline(always)]
    pub(crate) fn ball(radius: f64) -> Self {
        /// Twice the Frobenius norm of the identity, rounded up.
        const BEND: f64 = 3.464_101_615_137_755_6;
        let (q, b) = ([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [0.0; 3]);
        Self { q, b, c: -(radius * radius), rel: U * (1.0 + 8.0 * U), largest: 1.0, bend: BEND }
    }

    /// Whether the form is that of a half-space.
    #[inline(always)]
    pub(crate) fn is_linear(&self) -> bool {
        self.largest == 0.0
    }

    /// `Q v`.
    #[inline(always)]
    pub(crate) fn times(&self, v: Vec3) -> Vec3 {
        let [xx, yy, zz, xy, xz, yz] = self.q;
        Vec3::new(row(xx, xy, xz, v), row(xy, yy, yz, v), row(xz, yz, zz, v))
    }

    /// `|Q| v`, for `v >= 0`.
    #[inline(always)]
    fn times_abs(&self, v: Vec3) -> Vec3 {
        let [xx, yy, zz, xy, xz, yz] = self.q.map(f64::abs);
        Vec3::new(row(xx, xy, xz, v), row(xy, yy, yz, v), row(xz, yz, zz, v))
    }

    /// `A`, `B`, `C` along `o + s d`, with `o` within `eo` and `d` within `ed`.
    ///
    /// `Qd` and `Qo + b` take at most 4 roundings a coordinate, the dot products 4 more, and the
    /// coefficients have the error `rel`: so `gamma(9) + rel` of the sums of absolute values covers
    /// rounding. Errors of the inputs enter through the exact differences,
    /// `|δ(d·Qd)| <= |δd|·|Q|(2|d| + |δd|)`, `|δ(d·(Qo+b))| <= |δd|·|Qo+b| + |δo|·|Q|(|d| + |δd|)`,
    /// `|δf| <= 2|δo|·|Qo+b| + |δo|·|Q||δo|`.
    #[inline(always)]
    pub(crate) fn along(&self, o: Vec3, d: Vec3, eo: Vec3, ed: Vec3) -> Quadratic<EFloat> {
        let k = (9.0 * U + self.rel) * (1.0 + 64.0 * U);
        let linear = Vec3::from(self.b);
        let (od, dd) = (o.abs(), d.abs());
        let (mut a, mut e_a) = (0.0, 0.0);
        let mut reach = Vec3::ZERO;
        if !self.is_linear() {
            let size = self.times_abs(dd);
            a = self.times(d).dot(d);
            e_a = k * size.dot(dd);
            reach = size;
            if ed != Vec3::ZERO {
                let more = self.times_abs(ed);
                e_a += ed.dot(size + size + more) * (1.0 + 16.0 * U);
                reach += more;
            }
            e_a = if e_a == 0.0 && self.vanishes_along(d) { 0.0 } else { e_a + FLOOR };
        }
        let (b, e_b, c, e_c) = self.rest(o, d, eo, ed, (linear, od, dd), (k, reach));
        Quadratic {
            a: EFloat::with_error(a, e_a),
            b: EFloat::with_error(b, e_b),
            c: EFloat::with_error(c, e_c),
        }
    }

    /// `B`, its error, `C`, its error.
    #[inline(always)]
    fn rest(
        &self,
        o: Vec3,
        d: Vec3,
        eo: Vec3,
        ed: Vec3,
        (linear, od, dd): (Vec3, Vec3, Vec3),
        (k, reach): (f64, Vec3),
    ) -> (f64, f64, f64, f64) {
        let (qo, size_o) = (self.times(o), self.times_abs(od));
        let (g, size) = (qo + linear, size_o + linear.abs());
        let slack = 1.0 + 32.0 * U;
        let b = g.dot(d);
        let e_b = (k * size.dot(dd) + ed.dot(size) + eo.dot(reach)) * slack;
        let e_b = if e_b == 0.0 && self.vanishes_across(o, d) { 0.0 } else { e_b + FLOOR };
        let c = (g + linear).dot(o) + self.c;
        // Uses |Qo + b| itself, not the sum of absolute values: near the surface it is the factor
        // of errors of o.
        let gradient = g.abs() + size * k;
        let spread = eo.x + eo.y + eo.z;
        let e_c = k * ((size + linear.abs()).dot(od) + self.c.abs())
            + 2.0 * eo.dot(gradient)
            + self.largest * spread * spread;
        (b, e_b, c, e_c * slack + FLOOR)
    }

    /// Whether each term of `d·Qd` is exactly zero.
    #[cold]
    fn vanishes_along(&self, d: Vec3) -> bool {
        const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        PAIRS.iter().zip(self.q).all(|(&(i, j), q)| q == 0.0 || d[i] == 0.0 || d[j] == 0.0)
    }

    /// Whether each term of `d·(Qo + b)` is exactly zero.
    #[cold]
    fn vanishes_across(&self, o: Vec3, d: Vec3) -> bool {
        let [xx, yy, zz, xy, xz, yz] = self.q;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        (0..3).all(|i| d[i] == 0.0 || (self.b[i] == 0.0 && (0..3).all(|j| rows[i][j] == 0.0 || o[j] == 0.0)))
    }

    /// `f(p)` and `grad f(p) / 2` with `p` within `ep`.
    #[inline(always)]
    pub(crate) fn at(&self, p: Vec3, ep: Vec3) -> (EFloat, Vec3) {
        let k = (9.0 * U + self.rel) * (1.0 + 64.0 * U);
        let linear = Vec3::from(self.b);
        let (_, _, c, e_c) =
            self.rest(p, Vec3::ZERO, ep, Vec3::ZERO, (linear, p.abs(), Vec3::ZERO), (k, Vec3::ZERO));
        (EFloat::with_error(c, e_c), self.times(p) + linear)
    }
}
