//! The oracle: exact arithmetic that shares no code with the kernels (big integers from `dashu`),
//! and exact crossings of a line with everything that is bounded by quadratic polynomials.

use super::real_root::RealRoot;
use core::cell::RefCell;
use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};
use dashu::base::{Abs, BitTest, SquareRoot, UnsignedAbs};
use dashu::integer::IBig;
use durer_math::{Affine, Point3, Ray, Vec3};

/// The exact number `m 2^e`.
#[derive(Clone, Debug)]
pub struct Exact {
    pub(super) m: IBig,
    pub(super) e: i64,
}

impl Exact {
    /// Zero.
    pub fn zero() -> Self {
        Self { m: IBig::ZERO, e: 0 }
    }

    /// The sign: the order of this number and zero.
    pub fn sign(&self) -> Ordering {
        self.m.cmp(&IBig::ZERO)
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        Self { m: self.m.abs(), e: self.e }
    }

    /// `2^k` times this.
    #[must_use]
    pub fn shifted(mut self, k: i64) -> Self {
        self.e += k;
        self
    }

    /// The square.
    #[must_use]
    pub fn squared(&self) -> Self {
        self * self
    }

    /// The integer part (rounded down) of this number times `2^bits`.
    pub(super) fn floor_at(&self, bits: i64) -> IBig {
        let shift = self.e + bits;
        if shift >= 0 { &self.m << (shift as usize) } else { &self.m >> ((-shift) as usize) }
    }

    /// This number as f64, approximately.
    pub fn to_f64(&self) -> f64 {
        let bits = self.m.clone().unsigned_abs_bits();
        let drop = bits.saturating_sub(60);
        let top = &self.m >> drop;
        let top: i128 = i128::try_from(top).unwrap_or(0);
        durer_math::scale::ldexp(top as f64, (self.e + drop as i64).clamp(-5000, 5000) as i32)
    }
}

trait Bits {
    fn unsigned_abs_bits(self) -> usize;
}
impl Bits for IBig {
    fn unsigned_abs_bits(self) -> usize {
        self.abs().bit_len()
    }
}

impl From<f64> for Exact {
    fn from(x: f64) -> Self {
        assert!(x.is_finite(), "an exact number is finite, got {x}");
        let bits = x.to_bits();
        let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field as i64 - 1075) };
        let zeros = if m == 0 { 0 } else { m.trailing_zeros() };
        let m = IBig::from(m >> zeros);
        Self { m: if x.is_sign_negative() { -m } else { m }, e: e + i64::from(zeros) }
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $body:expr) => {
        impl $trait for &Exact {
            type Output = Exact;
            fn $method(self, other: &Exact) -> Exact {
                let ($a, $b) = (self, other);
                $body
            }
        }
        impl $trait for Exact {
            type Output = Exact;
            fn $method(self, other: Exact) -> Exact {
                $trait::$method(&self, &other)
            }
        }
    };
}

fn aligned(a: &Exact, b: &Exact) -> (IBig, IBig, i64) {
    let e = a.e.min(b.e);
    (&a.m << ((a.e - e) as usize), &b.m << ((b.e - e) as usize), e)
}

operator!(Add, add, |a, b| {
    if a.m.is_zero() {
        return b.clone();
    }
    if b.m.is_zero() {
        return a.clone();
    }
    let (x, y, e) = aligned(a, b);
    Exact { m: x + y, e }
});
operator!(Sub, sub, |a, b| a + &-b.clone());
operator!(Mul, mul, |a, b| Exact { m: &a.m * &b.m, e: a.e + b.e });

impl Neg for Exact {
    type Output = Self;
    fn neg(self) -> Self {
        Self { m: -self.m, e: self.e }
    }
}

/// The sign of `u + v √d`, `d >= 0`.
fn surd_sign(u: &Exact, v: &Exact, d: &Exact) -> Ordering {
    let (su, sv) = (u.sign(), if d.sign().is_eq() { Ordering::Equal } else { v.sign() });
    if su == sv || sv.is_eq() {
        return su;
    }
    if su.is_eq() {
        return sv;
    }
    // Opposite signs: the larger square decides.
    let squares = (&u.squared() - &(&v.squared() * d)).sign();
    if su.is_gt() { squares } else { squares.reverse() }
}

/// An exact real number: `(p + k √d) / a`, `k` one of -1, 0, 1, or a root of a polynomial of any
/// degree.
#[derive(Clone, Debug)]
pub struct Surd(Number);

#[derive(Clone, Debug)]
enum Number {
    Quadratic { p: Exact, k: i8, d: Exact, a: Exact },
    Root(RealRoot),
}

impl From<RealRoot> for Surd {
    fn from(root: RealRoot) -> Self {
        Self(Number::Root(root))
    }
}

impl Surd {
    /// The number `n / m`.
    pub fn ratio(n: Exact, m: Exact) -> Self {
        Self::with_root(n, 0, Exact::zero(), m)
    }

    /// The number `(p + k √d) / a`, `k` one of -1, 0, 1.
    pub fn with_root(p: Exact, k: i8, d: Exact, a: Exact) -> Self {
        Self(Number::Quadratic { p, k, d, a })
    }

    /// The order of this number and an exact number.
    pub fn cmp_exact(&self, x: &Exact) -> Ordering {
        let (p, k, d, a) = match &self.0 {
            Number::Quadratic { p, k, d, a } => (p, *k, d, a),
            Number::Root(root) => return root.cmp_exact(x),
        };
        let u = p - &(a * x);
        let sign = surd_sign(&u, &Exact::from(f64::from(k)), d);
        if a.sign().is_lt() { sign.reverse() } else { sign }
    }

    /// The sign of a polynomial at this number.
    pub fn sign_of(&self, q: &Poly) -> Ordering {
        let (p, k, d, a) = match &self.0 {
            Number::Quadratic { p, k, d, a } => (p, *k, d, a),
            Number::Root(root) => return root.sign_of(&[q.c.clone(), q.b.clone().shifted(1), q.a.clone()]),
        };
        let two = |x: Exact| x.shifted(1);
        let u = &(&(&q.a * &(&p.squared() + d)) + &two(&(&q.b * a) * p)) + &(&q.c * &a.squared());
        let v = two(&(&q.a * p) + &(&q.b * a));
        let v = if k < 0 { -v } else { v };
        if k == 0 { u.sign() } else { surd_sign(&u, &v, d) }
    }

    /// An exact number within `2^-bits` of this one.
    pub fn about(&self, bits: i64) -> Exact {
        let (p, k, d, a) = match &self.0 {
            Number::Quadratic { p, k, d, a } => (p, *k, d, a),
            Number::Root(root) => return root.about(bits),
        };
        // Enough digits to keep the quotient's error below the bound.
        let top = |x: &Exact| x.m.clone().unsigned_abs_bits() as i64 + x.e;
        let extra = bits + 16 + (-top(a)).max(0) * 2 + top(p).max(top(d)).max(0);
        let radicand = d.floor_at(2 * extra);
        let root = IBig::from(radicand.unsigned_abs().sqrt());
        let n = p.floor_at(extra) + IBig::from(k) * root;
        let a = a.floor_at(extra);
        Exact { m: (n << (bits + 8) as usize) / a, e: -(bits + 8) }
    }

    /// The order of this number and another root.
    pub fn compare(&self, other: &Self, equal: bool) -> Ordering {
        if equal {
            return Ordering::Equal;
        }
        for bits in [200, 1000, 4000, 16000] {
            let gap = &self.about(bits) - &other.about(bits);
            let slack = Exact::from(4.0).shifted(-bits);
            if (&gap.clone().abs() - &slack).sign().is_gt() {
                return gap.sign();
            }
        }
        Ordering::Equal
    }
}

/// `a t² + 2 b t + c`.
#[derive(Clone, Debug)]
pub struct Poly {
    /// The coefficient of `t²`.
    pub a: Exact,
    /// Half the coefficient of `t`.
    pub b: Exact,
    /// The constant.
    pub c: Exact,
}

impl Poly {
    /// Whether it is zero for all t.
    fn is_zero(&self) -> bool {
        self.a.sign().is_eq() && self.b.sign().is_eq() && self.c.sign().is_eq()
    }

    fn at(&self, t: &Exact) -> Ordering {
        (&(&(&(&self.a * t) + &self.b.clone().shifted(1)) * t) + &self.c).sign()
    }

    /// Its distinct real roots, in no order.
    #[inline(always)]
    fn roots(&self) -> Vec<Surd> {
        if self.a.sign().is_eq() {
            let b = self.b.clone().shifted(1);
            return if b.sign().is_eq() { vec![] } else { vec![Surd::ratio(-self.c.clone(), b)] };
        }
        let d = &self.b.squared() - &(&self.a * &self.c);
        let root = |k| Surd::with_root(-self.b.clone(), k, d.clone(), self.a.clone());
        match d.sign() {
            Ordering::Less => vec![],
            Ordering::Equal => vec![root(0)],
            Ordering::Greater => vec![root(-1), root(1)],
        }
    }
}

/// A polynomial of degree two in space, negative inside: `x·Qx + 2 b·x + c`.
#[derive(Clone, Debug)]
pub struct ExactForm {
    /// `Q`, symmetric.
    pub q: [[Exact; 3]; 3],
    /// Half the linear part.
    pub b: [Exact; 3],
    /// The constant.
    pub c: Exact,
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// A point or vector, exactly.
pub fn exact3(x: [f64; 3]) -> [Exact; 3] {
    x.map(Exact::from)
}

impl ExactForm {
    /// From the coefficients of `x² y² z² xy xz yz x y z 1`.
    pub fn new(k: [Exact; 10]) -> Self {
        let half = |x: &Exact| x.clone().shifted(-1);
        let [xx, yy, zz, xy, xz, yz, x, y, z, c] = &k;
        Self {
            q: [
                [xx.clone(), half(xy), half(xz)],
                [half(xy), yy.clone(), half(yz)],
                [half(xz), half(yz), zz.clone()],
            ],
            b: [half(x), half(y), half(z)],
            c: c.clone(),
        }
    }

    /// From coefficients in f64.
    pub fn from_f64(k: [f64; 10]) -> Self {
        Self::new(k.map(Exact::from))
    }

    /// The negated form: inside and outside are exchanged.
    #[must_use]
    pub fn negated(self) -> Self {
        Self { q: self.q.map(|r| r.map(|x| -x)), b: self.b.map(|x| -x), c: -self.c }
    }

    /// The half-space `n·x <= n·p`.
    pub fn half_space(n: [Exact; 3], p: [Exact; 3]) -> Self {
        let zero = Exact::zero;
        let row = || [zero(), zero(), zero()];
        let c = -dot(&n, &p);
        Self { q: [row(), row(), row()], b: n.map(|x| x.shifted(-1)), c }
    }

    /// This form moved by `v`.
    #[must_use]
    pub fn translated(&self, v: &[Exact; 3]) -> Self {
        // f(x - v).
        let minus = v.clone().map(|x| -x);
        let qv = self.times(&minus);
        let b = [0, 1, 2].map(|i| &self.b[i] + &qv[i]);
        Self { q: self.q.clone(), b, c: self.value(&minus) }
    }

    /// This form placed by a map: `f(L⁻¹(x - c))`, times `det²`.
    #[must_use]
    pub fn placed(&self, map: &Affine) -> Self {
        let l = map.linear().map(exact3);
        let minor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            &(&l[a][c] * &l[b][d]) - &(&l[a][d] * &l[b][c])
        };
        // adj[i][j] = cofactor[j][i].
        let adj: [[Exact; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| minor(j, i)));
        let det = (0..3).fold(Exact::zero(), |s, j| &s + &(&l[0][j] * &minor(0, j)));
        // Q' = adjᵀ Q adj, b' = det adjᵀ b, c' = det² c.
        let qa: [[Exact; 3]; 3] = core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..3).fold(Exact::zero(), |s, k| &s + &(&self.q[i][k] * &adj[k][j])))
        });
        let q = core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..3).fold(Exact::zero(), |s, k| &s + &(&adj[k][i] * &qa[k][j])))
        });
        let b = core::array::from_fn(|i| {
            &(0..3).fold(Exact::zero(), |s, k| &s + &(&adj[k][i] * &self.b[k])) * &det
        });
        let c = &self.c * &det.squared();
        Self { q, b, c }.translated(&exact3(map.centre().to_array()))
    }

    fn times(&self, v: &[Exact; 3]) -> [Exact; 3] {
        self.q.each_ref().map(|row| dot(row, v))
    }

    /// The value at a point.
    pub fn value(&self, x: &[Exact; 3]) -> Exact {
        &(&dot(&self.times(x), x) + &dot(&self.b, x).shifted(1)) + &self.c
    }

    /// Half the gradient at a point.
    pub fn half_gradient(&self, x: &[Exact; 3]) -> [Exact; 3] {
        let qx = self.times(x);
        [0, 1, 2].map(|i| &qx[i] + &self.b[i])
    }

    /// The polynomial along a line.
    pub fn along(&self, line: &ExactLine) -> Poly {
        let qd = self.times(&line.d);
        Poly { a: dot(&qd, &line.d), b: &dot(&qd, &line.o) + &dot(&self.b, &line.d), c: self.value(&line.o) }
    }
}

/// A ray's line, exactly.
#[derive(Clone, Debug)]
pub struct ExactLine {
    /// The point at `t = 0`.
    pub o: [Exact; 3],
    /// The direction.
    pub d: [Exact; 3],
}

impl ExactLine {
    /// The line of a ray.
    pub fn new(ray: &Ray) -> Self {
        Self { o: exact3(ray.origin.to_array()), d: exact3(ray.direction.to_array()) }
    }

    /// The point at `t`.
    pub fn at(&self, t: &Exact) -> [Exact; 3] {
        [0, 1, 2].map(|i| &self.o[i] + &(t * &self.d[i]))
    }
}

impl ExactLine {
    /// Whether two lines have the same numbers.
    fn is_same(&self, other: &Self) -> bool {
        let numbers = |line: &Self| line.o.clone().into_iter().chain(line.d.clone());
        numbers(self).zip(numbers(other)).all(|(a, b)| a.m == b.m && a.e == b.e)
    }
}

/// The answers for the last lines: the laws use the same line again and again, and exact answers
/// take long.
#[derive(Clone, Debug)]
pub struct LineCache<T>(RefCell<Vec<(ExactLine, T)>>);

impl<T> Default for LineCache<T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<T: Clone> LineCache<T> {
    /// Enough for a ray, and two that leave each of a few crossings.
    const LINES: usize = 16;

    /// The answer for a line; `find` computes it if the line is not among the last ones.
    pub fn get(&self, line: &ExactLine, find: impl FnOnce() -> T) -> T {
        let known = self.0.borrow().iter().find(|(l, _)| l.is_same(line)).map(|(_, found)| found.clone());
        known.unwrap_or_else(|| {
            let found = find();
            let mut last = self.0.borrow_mut();
            if last.len() == Self::LINES {
                last.remove(0);
            }
            last.push((line.clone(), found.clone()));
            found
        })
    }
}

/// An oracle that computes the crossings of each line once.
pub struct Cached<'a> {
    oracle: &'a dyn Oracle,
    crossings: LineCache<Vec<Crossing>>,
}

impl<'a> Cached<'a> {
    /// Wraps an oracle.
    pub fn new(oracle: &'a dyn Oracle) -> Self {
        Self { oracle, crossings: LineCache::default() }
    }
}

impl Oracle for Cached<'_> {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        self.crossings.get(line, || self.oracle.crossings(line))
    }

    fn knows(&self, line: &ExactLine) -> bool {
        self.oracle.knows(line)
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        self.oracle.face_side(face, point)
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        self.oracle.face_normal(face, point)
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        self.oracle.side(point)
    }

    fn size(&self) -> f64 {
        self.oracle.size()
    }

    fn is_convex(&self) -> bool {
        self.oracle.is_convex()
    }
}

/// One exact crossing.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The parameter.
    pub t: Surd,
    /// -1 entering, +1 leaving, 0 grazing.
    pub sign: i8,
    /// Whether the ray only touches.
    pub grazing: bool,
}

/// An exact description of a surface.
pub trait Oracle {
    /// All crossings with a line, ascending, each once.
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing>;

    /// Whether `crossings` is known for this line.
    fn knows(&self, _: &ExactLine) -> bool {
        true
    }

    /// The side of a face (numbered as in `Root::face`) on which a point lies: `Greater` where its
    /// normal points.
    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering;

    /// The face's normal at a point on it, of any length.
    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3;

    /// Whether a point is inside a solid (`Less`), on its boundary or outside; `None` for open
    /// surfaces.
    fn side(&self, point: &[Exact; 3]) -> Option<Ordering>;

    /// The surface's size.
    fn size(&self) -> f64;

    /// Whether it is a convex solid.
    fn is_convex(&self) -> bool;
}

/// The solid `{ x : f_i(x) <= 0 for all i }`, or, if not all faces are walls, the part of the walls
/// in it.
#[derive(Clone, Debug)]
pub struct ExactBody {
    /// The faces.
    pub faces: Vec<ExactForm>,
    /// The number of faces that are part of the surface; these come first.
    pub walls: usize,
    /// The size.
    pub size: f64,
    /// Whether it is a convex solid.
    pub convex: bool,
}

impl ExactBody {
    /// A solid.
    pub fn solid(faces: Vec<ExactForm>, size: f64, convex: bool) -> Self {
        Self { walls: faces.len(), faces, size, convex }
    }

    /// This body placed by a map that stretches by about `stretch`.
    #[must_use]
    pub fn placed(&self, map: &Affine) -> Self {
        let faces = self.faces.iter().map(|f| f.placed(map)).collect();
        Self { faces, size: self.size * map.linear_norm(), ..self.clone() }
    }
}

impl Oracle for ExactBody {
    /// The roots of all faces cut the line into pieces; each piece is inside or outside as its
    /// middle is.
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        let polys: Vec<Poly> = self.faces.iter().map(|f| f.along(line)).collect();
        let all = |t: &Surd| polys.iter().all(|p| t.sign_of(p).is_le());
        let considered = &polys[..self.walls];
        let mut roots: Vec<(Surd, usize)> = considered
            .iter()
            .enumerate()
            .flat_map(|(i, p)| p.roots().into_iter().map(move |r| (r, i)))
            .collect();
        let same = |x: &(Surd, usize), y: &(Surd, usize)| {
            x.1 != y.1
                && x.0.sign_of(&polys[y.1]).is_eq()
                && y.0.sign_of(&polys[x.1]).is_eq()
                && (&x.0.about(300) - &y.0.about(300)).abs().shifted(280).to_f64() < 1.0
        };
        roots.sort_by(|x, y| x.0.compare(&y.0, same(x, y)));
        let mut distinct: Vec<(Surd, usize)> = vec![];
        for r in roots {
            if distinct.last().is_none_or(|l| !same(l, &r)) {
                distinct.push(r);
            }
        }
        // A point in each gap.
        let one = Exact::from(1.0);
        let mut gaps = vec![];
        for i in 0..=distinct.len() {
            let x = match (i.checked_sub(1).map(|j| &distinct[j].0), distinct.get(i).map(|r| &r.0)) {
                (None, None) => Exact::zero(),
                (None, Some(r)) => &r.about(64) - &one,
                (Some(l), None) => &l.about(64) + &one,
                (Some(l), Some(r)) => {
                    let mut bits = 64;
                    loop {
                        let m = (&l.about(bits) + &r.about(bits)).shifted(-1);
                        if l.cmp_exact(&m).is_lt() && r.cmp_exact(&m).is_gt() || bits > 40000 {
                            break m;
                        }
                        bits *= 2;
                    }
                }
            };
            gaps.push(considered.iter().all(|p| p.at(&x).is_le()));
        }
        let mut out = vec![];
        for (i, (t, face)) in distinct.into_iter().enumerate() {
            if !all(&t) || polys[face].is_zero() {
                continue;
            }
            let (sign, grazing) = match (gaps[i], gaps[i + 1]) {
                (true, false) => (1, false),
                (false, true) => (-1, false),
                _ => (0, true),
            };
            out.push(Crossing { t, sign, grazing });
        }
        out
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        self.faces[face as usize].value(point).sign()
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        let g = self.faces[face as usize].half_gradient(point);
        // Scaled by a power of two to about one, so that any size is in range.
        let nonzero = g.iter().filter(|x| x.sign().is_ne());
        let top = nonzero.map(|x| x.m.clone().unsigned_abs_bits() as i64 + x.e).max().unwrap_or(0);
        Vec3::from(g.map(|x| x.shifted(-top).to_f64()))
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        (self.walls == self.faces.len())
            .then(|| self.faces.iter().map(|f| f.value(point).sign()).max().unwrap_or(Ordering::Less))
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn is_convex(&self) -> bool {
        self.convex
    }
}

/// The part of a surface where some polynomials are not positive: a sheet.
#[derive(Clone, Debug)]
pub struct Clipped<O> {
    /// The surface.
    pub whole: O,
    /// The polynomials.
    pub cuts: Vec<ExactForm>,
}

impl<O: Oracle> Oracle for Clipped<O> {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        let cuts: Vec<Poly> = self.cuts.iter().map(|f| f.along(line)).collect();
        let mut all = self.whole.crossings(line);
        all.retain(|c| cuts.iter().all(|q| c.t.sign_of(q).is_le()));
        all
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        self.whole.face_side(face, point)
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        self.whole.face_normal(face, point)
    }

    fn side(&self, _: &[Exact; 3]) -> Option<Ordering> {
        None
    }

    fn size(&self) -> f64 {
        self.whole.size()
    }

    fn is_convex(&self) -> bool {
        false
    }
}

/// The point of a line nearest to `t`, in f64: for messages.
pub fn near(line: &ExactLine, t: &Surd) -> Point3 {
    Point3::from(line.at(&t.about(200)).map(|x| x.to_f64()))
}
