//! From a point of space to the start of its orbit, and from a line to eight stretches of it.

use super::Julia;
use super::orbit::{Ball, TINY};
use crate::CentredRay;
use crate::implicit::CertifiedFunction;
use durer_math::{F8, Interval, Isa, U, Vec3};

use super::orbit::{Rule, StretchSigns8};

/// An affine map from space to `M` numbers of `C` coordinates: `A p + b`, each entry known within
/// an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lift<const M: usize, const C: usize> {
    a: [[Vec3; C]; M],
    b: [[f64; C]; M],
    /// The largest sum of magnitudes in a row of `A`, and the errors.
    size: f64,
    a_err: f64,
    b_err: f64,
}

/// A row of the map in intervals: three factors and a constant.
type Row = [Interval; 4];

/// The rows of the four coordinates of the slice.
fn slice(set: &Julia) -> [Row; 4] {
    let exact = Interval::from;
    let unit = |k: usize| core::array::from_fn(|j| exact(if j == k { 1.0 } else { 0.0 }));
    // w = (distance |n| - n . p) / n_w
    let n = set.normal.map(exact);
    let length = n.iter().fold(exact(0.0), |sum, n| sum + n.square()).sqrt();
    let last = n[3];
    let w = [-n[0] / last, -n[1] / last, -n[2] / last, exact(set.distance) * length / last];
    [unit(0), unit(1), unit(2), w]
}

fn sum(a: &Row, b: &Row) -> Row {
    core::array::from_fn(|j| a[j] + b[j])
}

fn difference(a: &Row, b: &Row) -> Row {
    core::array::from_fn(|j| a[j] - b[j])
}

impl Lift<1, 4> {
    pub(super) fn quaternion(set: &Julia) -> Self {
        Self::new(&[slice(set)])
    }
}

impl Lift<2, 2> {
    pub(super) fn hypercomplex(set: &Julia) -> Self {
        let [a, b, c, d] = slice(set);
        Self::new(&[[difference(&a, &d), sum(&b, &c)], [sum(&a, &d), difference(&b, &c)]])
    }
}

impl<const M: usize, const C: usize> Lift<M, C> {
    fn new(rows: &[[Row; C]; M]) -> Self {
        let a = rows.map(|rows| rows.map(|r| Vec3::new(r[0].mid(), r[1].mid(), r[2].mid())));
        let b = rows.map(|rows| rows.map(|r| r[3].mid()));
        let (mut size, mut a_err, mut b_err) = (0.0_f64, 0.0_f64, 0.0_f64);
        for row in rows.iter().flatten() {
            size = size.max(row[..3].iter().map(|x| x.magnitude()).sum());
            a_err = a_err.max(row[..3].iter().map(|x| x.width()).sum());
            b_err = b_err.max(row[3].width() + row[3].magnitude() * (4.0 * U));
        }
        Self { a, b, size: size * (1.0 + 8.0 * U), a_err: a_err * (1.0 + 8.0 * U), b_err: b_err + TINY }
    }

    /// `A v`.
    #[inline(always)]
    fn turned(&self, v: Vec3) -> [[f64; C]; M] {
        self.a.map(
            #[inline(always)]
            |rows| {
                rows.map(
                    #[inline(always)]
                    |row| row.dot(v),
                )
            },
        )
    }

    /// The image of a point, rounded.
    #[inline(always)]
    pub(super) fn at(&self, p: Vec3) -> [[f64; C]; M] {
        let mut z = self.turned(p);
        for (z, b) in z.iter_mut().flatten().zip(self.b.iter().flatten()) {
            *z += b;
        }
        z
    }

    /// The images of the axes.
    #[inline(always)]
    pub(super) fn axes(&self) -> [[[f64; C]; M]; 3] {
        [Vec3::X, Vec3::Y, Vec3::Z].map(
            #[inline(always)]
            |axis| self.turned(axis),
        )
    }

    /// The greatest factor by which the map lengthens a vector.
    #[inline(always)]
    pub(super) fn stretch(&self) -> f64 {
        self.size * root_of(C as f64)
    }

    /// A bound on the error, in length, of each number of an image: of a point that is `reach` long
    /// along an axis and known within `e`.
    #[inline(always)]
    pub(super) fn error(&self, reach: f64, e: f64) -> f64 {
        let row = self.size * e + (self.a_err + self.size * (6.0 * U)) * (reach + e) + self.b_err;
        row * root_of(C as f64) * (1.0 + 16.0 * U)
    }

    /// A bound on the error, in length, of each number of the image of a direction.
    #[inline(always)]
    pub(super) fn error_of_way(&self, reach: f64, e: f64) -> f64 {
        let row = self.size * e + (self.a_err + self.size * (6.0 * U)) * (reach + e);
        row * root_of(C as f64) * (1.0 + 16.0 * U) + TINY
    }
}

impl<const M: usize, const C: usize> Lift<M, C> {
    /// `A v` for eight vectors.
    #[inline(always)]
    pub(super) fn turned8(&self, v: Vec3<F8>) -> [[F8; C]; M] {
        let mut z = [[F8::ZERO; C]; M];
        for (z, a) in z.iter_mut().zip(&self.a) {
            for (z, a) in z.iter_mut().zip(a) {
                *z = dot8(*a, v);
            }
        }
        z
    }

    /// The images of eight points, rounded.
    #[inline(always)]
    pub(super) fn at8(&self, p: Vec3<F8>) -> [[F8; C]; M] {
        let mut z = self.turned8(p);
        for (z, b) in z.iter_mut().zip(&self.b) {
            for (z, b) in z.iter_mut().zip(b) {
                *z += F8::splat(*b);
            }
        }
        z
    }

    /// [`Lift::error_of_way`] for eight vectors.
    #[inline(always)]
    pub(super) fn errors_of_way(&self, reach: f64, e: F8) -> F8 {
        let row = e * self.size + (e + reach) * (self.a_err + self.size * (6.0 * U));
        row * (root_of(C as f64) * (1.0 + 16.0 * U)) + TINY
    }

    /// [`Lift::error`] for eight points.
    #[inline(always)]
    pub(super) fn errors(&self, reach: F8, e: F8) -> F8 {
        let row = e * self.size + (reach + e) * (self.a_err + self.size * (6.0 * U)) + self.b_err;
        row * (root_of(C as f64) * (1.0 + 16.0 * U))
    }

    /// The images of the axes in each lane, by numbers.
    #[inline(always)]
    pub(super) fn axes8(&self) -> [[[F8; C]; 3]; M] {
        let mut axes = [[[F8::ZERO; C]; 3]; M];
        for (axes, rows) in axes.iter_mut().zip(&self.a) {
            for (i, row) in rows.iter().enumerate() {
                for (axis, x) in axes.iter_mut().zip([row.x, row.y, row.z]) {
                    axis[i] = F8::splat(x);
                }
            }
        }
        axes
    }
}

#[inline(always)]
fn dot8(a: Vec3, v: Vec3<F8>) -> F8 {
    F8::splat(a.x).mul_add(v.x, F8::splat(a.y).mul_add(v.y, v.z * a.z))
}

/// An upper bound of the root of 2 or 4.
#[inline(always)]
fn root_of(count: f64) -> f64 {
    if count > 2.0 { 2.0 } else { 1.5 }
}

/// A ray's line in the space of the starts of orbits.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmbeddedLine<'a, const M: usize, const C: usize> {
    rule: &'a Rule<f64, M, C>,
    o: [[f64; C]; M],
    d: [[f64; C]; M],
    /// Bounds on the lengths of their errors, and on those of `o`, and of `d`, themselves.
    o_err: f64,
    d_err: f64,
    o_size: f64,
    d_size: f64,
    ulp: f64,
}

impl<'a, const M: usize, const C: usize> EmbeddedLine<'a, M, C> {
    /// The line of a ray, as far as `reach`.
    #[inline(always)]
    pub(super) fn new(rule: &'a Rule<f64, M, C>, lift: &Lift<M, C>, at: &CentredRay<'_>, reach: f64) -> Self {
        let (o, d) = (lift.at(at.o), lift.turned(at.d));
        let length = |z: &[f64; C]| z.iter().map(|x| x.abs()).sum::<f64>();
        let longest = |z: &[[f64; C]; M]| z.iter().fold(0.0, |most: f64, z| most.max(length(z)));
        Self {
            rule,
            o_size: longest(&o),
            d_size: longest(&d),
            o,
            d,
            o_err: lift.error(at.o.max_abs(), at.o_err.max_abs()),
            d_err: lift.error_of_way(at.d.max_abs(), at.d_err.max_abs()),
            ulp: reach * f64::EPSILON + TINY,
        }
    }

    /// The facts that are proven about eight intervals.
    #[inline(never)]
    pub(super) fn known(&self, mid: &F8, half: &F8) -> StretchSigns8 {
        Isa::detect().run(
            #[inline(always)]
            || {
                let mut balls = [Ball::ZERO; M];
                for (m, ball) in balls.iter_mut().enumerate() {
                    for i in 0..C {
                        let (o, d) = (self.o[m][i], self.d[m][i]);
                        for k in 0..8 {
                            ball.q[i].0[k] = mid.0[k].mul_add(d, o);
                            ball.v[i].0[k] = half.0[k] * d;
                        }
                    }
                    for k in 0..8 {
                        let (s, h) = (mid.0[k].abs(), half.0[k]);
                        let far = s + h;
                        let rounding = far.mul_add(self.d_size, self.o_size) * (4.0 * U);
                        ball.r.0[k] = far.mul_add(self.d_err, self.o_err + rounding) + TINY;
                        ball.d.0[k] = h * (self.d_err + self.d_size * (4.0 * U)) + TINY;
                    }
                }
                self.rule.known(balls)
            },
        )
    }

    /// What is certain about eight stretches from `a` to `b`, and their half lengths.
    #[inline(always)]
    pub(super) fn between(&self, a: &[f64; 8], b: &[f64; 8]) -> StretchSigns8 {
        let (mut mid, mut half) = (F8::ZERO, F8::ZERO);
        for k in 0..8 {
            mid.0[k] = 0.5 * (a[k] + b[k]);
            half.0[k] = 0.5 * (b[k] - a[k]) * (1.0 + 4.0 * U) + mid.0[k].abs() * (2.0 * U);
        }
        self.known(&mid, &half)
    }

    /// The facts that are proven at eight points.
    #[inline(always)]
    pub(super) fn at(&self, s: &[f64; 8]) -> StretchSigns8 {
        self.known(&F8(*s), &F8::ZERO)
    }
}

impl<const M: usize, const C: usize> CertifiedFunction for EmbeddedLine<'_, M, C> {
    type Form<'a> = ();

    fn same((): (), (): ()) -> bool {
        true
    }

    fn ulp(&self) -> f64 {
        self.ulp
    }

    fn value(&self, (): (), s: f64) -> f64 {
        Isa::detect().run(
            #[inline(always)]
            || {
                let z = core::array::from_fn(
                    #[inline(always)]
                    |m| {
                        core::array::from_fn(
                            #[inline(always)]
                            |i| s.mul_add(self.d[m][i], self.o[m][i]),
                        )
                    },
                );
                self.rule.value(z)
            },
        )
    }

    fn is_plain(&self, (): (), s: f64) -> bool {
        // The same line, known sixteen times worse.
        let o_err = 16.0 * (self.o_err + self.o_size * U);
        let d_err = 16.0 * (self.d_err + self.d_size * U);
        Self { o_err, d_err, ..*self }.sign((), s).is_some()
    }

    fn signs(&self, (): (), a: &[f64; 8], b: &[f64; 8]) -> [Option<bool>; 8] {
        let known = if a == b { self.at(a) } else { self.between(a, b) };
        core::array::from_fn(|k| match () {
            () if known.out.lane(k) => Some(true),
            () if known.within.lane(k) => Some(false),
            () => None,
        })
    }
}
