//! The number types in which a formula can be evaluated: f64, eight intervals, and dual numbers
//! over either.
//!
//! A formula of a scene is written once and evaluated in several ways: for its value, for bounds on
//! its values on boxes, for its slope along a ray. [`Number`] lists the operations of such
//! formulas; every type with these operations can evaluate all of them.

use crate::noise::{Nearest, NoiseTable};
use crate::{Dual, Joined, noise};
use durer_math::{F8, Interval, elementary};

/// The number types on which formulas are evaluated. Operations take references: the types may be
/// large.
pub trait Number: Copy + Joined {
    /// A number that is known within an interval.
    fn constant(c: Interval) -> Self;
    /// `a + b`.
    fn add(a: &Self, b: &Self) -> Self;
    /// `a - b`.
    fn sub(a: &Self, b: &Self) -> Self;
    /// `a b`.
    fn mul(a: &Self, b: &Self) -> Self;
    /// `a b` for integers: below 2^53 no f64 is rounded.
    #[inline(always)]
    fn mul_whole(a: &Self, b: &Self) -> Self {
        Self::mul(a, b)
    }
    /// `k a`, where `k` is finite and not zero: most products of a formula have a constant factor.
    #[inline(always)]
    fn times(k: f64, a: &Self) -> Self {
        Self::mul(&number(k), a)
    }
    /// `a / b`.
    fn div(a: &Self, b: &Self) -> Self;
    /// `-a`.
    fn neg(a: &Self) -> Self;
    /// `a^2`.
    fn sqr(a: &Self) -> Self;
    /// `|a|`.
    fn abs(a: &Self) -> Self;
    /// The square root.
    fn sqrt(a: &Self) -> Self;
    /// The lesser number.
    fn min(a: &Self, b: &Self) -> Self;
    /// The greater number.
    fn max(a: &Self, b: &Self) -> Self;
    /// `a^n`.
    fn powi(a: &Self, n: i32) -> Self;
    /// `a^b`.
    fn pow(a: &Self, b: &Self) -> Self;
    /// The angle of `(x, y)`.
    fn atan2(y: &Self, x: &Self) -> Self;
    /// The remainder of `a / b` with the sign of `a` (C's `fmod`).
    fn rem(a: &Self, b: &Self) -> Self;
    /// A function of one number.
    fn function(f: Function, a: &Self) -> Self;
    /// The sine and the cosine.
    #[inline(always)]
    fn sine_and_cosine(a: &Self) -> (Self, Self) {
        (Self::function(Function::Sin, a), Self::function(Function::Cos, a))
    }
    /// Noise at a point of space.
    fn noise(table: Option<&NoiseTable>, p: [&Self; 3]) -> Self;
    /// The distance to the nearest of random points, or to the next.
    fn nearest(which: Nearest, p: [&Self; 3]) -> Self;
    /// The result of a comparison, 1 or 0.
    fn compare(c: Comparison, a: &Self, b: &Self) -> Self;
    /// One of three by the sign of `c`: below, at or above zero. If two of them are the same object
    /// (the same step of a formula, by address), there is no jump between them.
    fn select(c: &Self, below: &Self, at: &Self, above: &Self) -> Self;
    /// Whether it is defined and exactly zero.
    fn is_zero(&self) -> bool;
    /// A number known only to be at least `a`, if `a` is certainly above 1.
    fn above(a: &Self) -> Option<Self>;
}

/// A number type that provides the slopes of all functions, so that a [`Dual`] can be made of it.
pub trait Sloped: Number {
    /// Noise at a point of space, and its derivatives along the three axes.
    fn noise_and_slopes(table: Option<&NoiseTable>, p: [&Self; 3]) -> (Self, [Self; 3]);
    /// The distance to the nearest of random points, or to the next, and its slopes along the three
    /// axes.
    fn nearest_and_slopes(which: Nearest, p: [&Self; 3]) -> (Self, [Self; 3]);
}

/// The functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Exp,
    Ln,
    Log10,
    Floor,
    Ceil,
    Trunc,
}

/// The comparisons of two numbers. `And` and `Or` take zero as false.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Comparison {
    Less,
    LessEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl Comparison {
    /// The result for two f64.
    #[inline]
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessEqual => a <= b,
            Self::Equal => a == b,
            Self::NotEqual => a != b,
            Self::And => a != 0.0 && b != 0.0,
            Self::Or => a != 0.0 || b != 0.0,
        }
    }
}

impl Function {
    /// The function of an f64.
    pub fn of(self, x: f64) -> f64 {
        match self {
            Self::Sin => elementary::sin(x),
            Self::Cos => elementary::cos(x),
            Self::Tan => elementary::tan(x),
            Self::Asin => elementary::asin(x),
            Self::Acos => elementary::acos(x),
            Self::Atan => elementary::atan(x),
            Self::Sinh => elementary::sinh(x),
            Self::Cosh => elementary::cosh(x),
            Self::Tanh => elementary::tanh(x),
            Self::Asinh => elementary::asinh(x),
            Self::Acosh => elementary::acosh(x),
            Self::Atanh => elementary::atanh(x),
            Self::Exp => elementary::exp(x),
            Self::Ln => elementary::ln(x),
            Self::Log10 => elementary::log10(x),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Trunc => x.trunc(),
        }
    }
}

impl Number for f64 {
    #[inline(always)]
    fn constant(c: Interval) -> Self {
        c.mid()
    }
    #[inline(always)]
    fn add(a: &Self, b: &Self) -> Self {
        a + b
    }
    #[inline(always)]
    fn sub(a: &Self, b: &Self) -> Self {
        a - b
    }
    #[inline(always)]
    fn mul(a: &Self, b: &Self) -> Self {
        a * b
    }
    #[inline(always)]
    fn div(a: &Self, b: &Self) -> Self {
        // Division by zero is undefined, not infinite.
        if *b == 0.0 { Self::NAN } else { a / b }
    }
    #[inline(always)]
    fn neg(a: &Self) -> Self {
        -a
    }
    #[inline(always)]
    fn sqr(a: &Self) -> Self {
        a * a
    }
    #[inline(always)]
    fn abs(a: &Self) -> Self {
        f64::abs(*a)
    }
    #[inline(always)]
    fn sqrt(a: &Self) -> Self {
        f64::sqrt(*a)
    }
    #[inline(always)]
    fn min(a: &Self, b: &Self) -> Self {
        if a.is_nan() || b.is_nan() { Self::NAN } else { f64::min(*a, *b) }
    }
    #[inline(always)]
    fn max(a: &Self, b: &Self) -> Self {
        if a.is_nan() || b.is_nan() { Self::NAN } else { f64::max(*a, *b) }
    }
    #[inline(always)]
    fn powi(a: &Self, n: i32) -> Self {
        // NaN stays NaN, even to the power of zero.
        if a.is_nan() || (*a == 0.0 && n < 0) { Self::NAN } else { elementary::powi(*a, n) }
    }
    #[inline(always)]
    fn pow(a: &Self, b: &Self) -> Self {
        let undefined = a.is_nan() || b.is_nan() || (*a == 0.0 && *b < 0.0);
        if undefined { Self::NAN } else { elementary::pow(*a, *b) }
    }
    #[inline(always)]
    fn atan2(y: &Self, x: &Self) -> Self {
        // -0 counts as 0.
        if *y == 0.0 && *x == 0.0 { Self::NAN } else { elementary::atan2(*y + 0.0, *x) }
    }
    #[inline(always)]
    fn rem(a: &Self, b: &Self) -> Self {
        a % b
    }
    #[inline(always)]
    fn function(f: Function, a: &Self) -> Self {
        let value = f.of(*a);
        // The logarithm of zero and similar values.
        if value.is_infinite()
            && a.is_finite()
            && !matches!(f, Function::Exp | Function::Sinh | Function::Cosh)
        {
            return Self::NAN;
        }
        value
    }
    #[inline(always)]
    fn noise(table: Option<&NoiseTable>, p: [&Self; 3]) -> Self {
        noise::values(table, F8::splats(p.map(|x| *x)).each_ref()).0[0]
    }
    #[inline(always)]
    fn nearest(which: Nearest, p: [&Self; 3]) -> Self {
        which.value(p.map(|x| *x))
    }
    #[inline(always)]
    fn compare(c: Comparison, a: &Self, b: &Self) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self::NAN;
        }
        Self::from(u8::from(c.holds(*a, *b)))
    }
    #[inline(always)]
    fn select(c: &Self, below: &Self, at: &Self, above: &Self) -> Self {
        if *c < 0.0 {
            *below
        } else if *c == 0.0 {
            *at
        } else if *c > 0.0 {
            *above
        } else {
            Self::NAN
        }
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
    #[inline(always)]
    fn above(a: &Self) -> Option<Self> {
        (*a > 1.0).then_some(*a)
    }
}

impl Sloped for f64 {
    #[inline(always)]
    fn noise_and_slopes(table: Option<&NoiseTable>, p: [&Self; 3]) -> (Self, [Self; 3]) {
        let (v, d) = noise::slants(table, F8::splats(p.map(|x| *x)).each_ref());
        (v.0[0], d.map(|d| d.0[0]))
    }
    #[inline(always)]
    fn nearest_and_slopes(which: Nearest, p: [&Self; 3]) -> (Self, [Self; 3]) {
        which.value_and_slopes(p.map(|x| *x))
    }
}

/// The derivatives of a [`Dual`]: one number, or a [`Gradient`], whose directions share all factors
/// of slopes.
pub trait Slopes<T>: Copy {
    /// The slopes of a constant.
    fn zero() -> Self;
    /// Slopes of which nothing is known.
    fn unknown() -> Self;
    /// `a + b`.
    fn sum(a: &Self, b: &Self) -> Self;
    /// `a - b`.
    fn difference(a: &Self, b: &Self) -> Self;
    /// `-a`.
    fn negated(a: &Self) -> Self;
    /// `k a`.
    fn scaled(k: &T, a: &Self) -> Self;
    /// `k a` for a finite `k` that is not zero.
    fn times(k: f64, a: &Self) -> Self;
    /// `a / k`.
    fn divided(a: &Self, k: &T) -> Self;
    /// One of three by the sign of `c`: below, at and above zero.
    fn selected(c: &T, below: &Self, at: &Self, above: &Self) -> Self;
    /// The slopes, with a mark for each that is exactly zero.
    fn settled(&self) -> Self;
    /// Whether all are known to be exactly zero.
    fn are_zero(&self) -> bool;
}

impl<T: Number> Slopes<T> for T {
    #[inline(always)]
    fn zero() -> Self {
        number(0.0)
    }
    #[inline(always)]
    fn unknown() -> Self {
        T::constant(Interval::ENTIRE)
    }
    #[inline(always)]
    fn sum(a: &Self, b: &Self) -> Self {
        Number::add(a, b)
    }
    #[inline(always)]
    fn difference(a: &Self, b: &Self) -> Self {
        Number::sub(a, b)
    }
    #[inline(always)]
    fn negated(a: &Self) -> Self {
        Number::neg(a)
    }
    #[inline(always)]
    fn scaled(k: &T, a: &Self) -> Self {
        Number::mul(k, a)
    }
    #[inline(always)]
    fn times(k: f64, a: &Self) -> Self {
        Number::times(k, a)
    }
    #[inline(always)]
    fn divided(a: &Self, k: &T) -> Self {
        Number::div(a, k)
    }
    #[inline(always)]
    fn selected(c: &T, below: &Self, at: &Self, above: &Self) -> Self {
        Number::select(c, below, at, above)
    }
    #[inline(always)]
    fn settled(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn are_zero(&self) -> bool {
        Number::is_zero(self)
    }
}

/// Derivatives along three directions, and a mask of those that are not zero: most parts of a
/// formula vary along one or two directions, and zeros are not multiplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<T> {
    /// The derivatives.
    pub d: [T; 3],
    varies: u8,
}

impl<T: Number> Gradient<T> {
    /// The gradient of a coordinate in space, that of axis number `axis`.
    #[inline(always)]
    pub fn of_axis(axis: usize) -> Self {
        let mut d = [number(0.0); 3];
        d[axis] = number(1.0);
        Self { d, varies: 1 << axis }
    }

    #[inline(always)]
    fn varies(&self, axis: usize) -> bool {
        self.varies >> axis & 1 == 1
    }

    /// Applies a function that maps zero to zero to each derivative.
    #[inline(always)]
    fn each(&self, f: impl Fn(&T) -> T) -> Self {
        let mut out = *self;
        for (axis, out) in out.d.iter_mut().enumerate() {
            if self.varies(axis) {
                *out = f(out);
            }
        }
        out
    }
}

impl<T: Number> Slopes<T> for Gradient<T> {
    #[inline(always)]
    fn zero() -> Self {
        Self { d: [number(0.0); 3], varies: 0 }
    }
    #[inline(always)]
    fn unknown() -> Self {
        Self { d: [T::constant(Interval::ENTIRE); 3], varies: 0b111 }
    }
    #[inline(always)]
    fn sum(a: &Self, b: &Self) -> Self {
        let mut out = *a;
        out.varies |= b.varies;
        for axis in 0..3 {
            if b.varies(axis) {
                out.d[axis] = if a.varies(axis) { T::add(&a.d[axis], &b.d[axis]) } else { b.d[axis] };
            }
        }
        out
    }
    #[inline(always)]
    fn difference(a: &Self, b: &Self) -> Self {
        let mut out = *a;
        out.varies |= b.varies;
        for axis in 0..3 {
            if b.varies(axis) {
                let d = &b.d[axis];
                out.d[axis] = if a.varies(axis) { T::sub(&a.d[axis], d) } else { T::neg(d) };
            }
        }
        out
    }
    #[inline(always)]
    fn negated(a: &Self) -> Self {
        a.each(
            #[inline(always)]
            |d| T::neg(d),
        )
    }
    #[inline(always)]
    fn scaled(k: &T, a: &Self) -> Self {
        a.each(
            #[inline(always)]
            |d| T::mul(k, d),
        )
    }
    #[inline(always)]
    fn times(k: f64, a: &Self) -> Self {
        a.each(
            #[inline(always)]
            |d| T::times(k, d),
        )
    }
    #[inline(always)]
    fn divided(a: &Self, k: &T) -> Self {
        a.each(
            #[inline(always)]
            |d| T::div(d, k),
        )
    }
    #[inline(always)]
    fn selected(c: &T, below: &Self, at: &Self, above: &Self) -> Self {
        let mut out = Self { d: below.d, varies: below.varies | at.varies | above.varies };
        for axis in 0..3 {
            if out.varies(axis) {
                out.d[axis] = T::select(c, &below.d[axis], &at.d[axis], &above.d[axis]);
            }
        }
        out
    }
    #[inline(always)]
    fn settled(&self) -> Self {
        let mut out = *self;
        for (axis, d) in self.d.iter().enumerate() {
            out.varies &= !(u8::from(d.is_zero()) << axis);
        }
        out
    }
    #[inline(always)]
    fn are_zero(&self) -> bool {
        self.varies == 0
    }
}

impl<T: Number, D: Slopes<T>> Dual<T, D> {
    /// A value whose derivative is `slope` times that of `a`.
    #[inline(always)]
    fn chain(v: T, slope: &T, a: &Self) -> Self {
        Self { v, d: D::scaled(slope, &a.d) }
    }
}

#[inline(always)]
fn number<T: Number>(x: f64) -> T {
    T::constant(Interval { lo: x, hi: x })
}

impl<T: Sloped, D: Slopes<T>> Number for Dual<T, D> {
    #[inline(always)]
    fn constant(c: Interval) -> Self {
        Self { v: T::constant(c), d: D::zero() }
    }
    #[inline(always)]
    fn add(a: &Self, b: &Self) -> Self {
        Self { v: T::add(&a.v, &b.v), d: D::sum(&a.d, &b.d) }
    }
    #[inline(always)]
    fn sub(a: &Self, b: &Self) -> Self {
        Self { v: T::sub(&a.v, &b.v), d: D::difference(&a.d, &b.d) }
    }
    #[inline(always)]
    fn mul(a: &Self, b: &Self) -> Self {
        let (l, r) = (D::scaled(&a.v, &b.d), D::scaled(&b.v, &a.d));
        Self { v: T::mul(&a.v, &b.v), d: D::sum(&l, &r) }
    }
    #[inline(always)]
    fn mul_whole(a: &Self, b: &Self) -> Self {
        let (l, r) = (D::scaled(&a.v, &b.d), D::scaled(&b.v, &a.d));
        Self { v: T::mul_whole(&a.v, &b.v), d: D::sum(&l, &r) }
    }
    #[inline(always)]
    fn times(k: f64, a: &Self) -> Self {
        Self { v: T::times(k, &a.v), d: D::times(k, &a.d) }
    }
    #[inline(always)]
    fn div(a: &Self, b: &Self) -> Self {
        let v = T::div(&a.v, &b.v);
        let top = D::difference(&a.d, &D::scaled(&v, &b.d));
        Self { v, d: D::divided(&top, &b.v) }
    }
    #[inline(always)]
    fn neg(a: &Self) -> Self {
        Self { v: T::neg(&a.v), d: D::negated(&a.d) }
    }
    #[inline(always)]
    fn sqr(a: &Self) -> Self {
        Self::chain(T::sqr(&a.v), &T::add(&a.v, &a.v), a)
    }
    /// At zero the slopes are all those between -1 and 1, as for an interval around it.
    #[inline(always)]
    fn abs(a: &Self) -> Self {
        let back = D::negated(&a.d);
        Self { v: T::abs(&a.v), d: D::selected(&a.v, &back, &a.d, &a.d) }
    }
    #[inline(always)]
    fn sqrt(a: &Self) -> Self {
        let v = T::sqrt(&a.v);
        Self { v, d: D::divided(&a.d, &T::add(&v, &v)) }
    }
    #[inline(always)]
    fn min(a: &Self, b: &Self) -> Self {
        let d = D::selected(&T::sub(&a.v, &b.v), &a.d, &a.d, &b.d);
        Self { v: T::min(&a.v, &b.v), d }
    }
    #[inline(always)]
    fn max(a: &Self, b: &Self) -> Self {
        let d = D::selected(&T::sub(&a.v, &b.v), &b.d, &a.d, &a.d);
        Self { v: T::max(&a.v, &b.v), d }
    }
    #[inline(always)]
    fn powi(a: &Self, n: i32) -> Self {
        let slope = T::mul(&number(f64::from(n)), &T::powi(&a.v, n.saturating_sub(1)));
        Self::chain(T::powi(&a.v, n), &slope, a)
    }
    #[inline(always)]
    fn pow(a: &Self, b: &Self) -> Self {
        // (a^b)' = b a^(b - 1) a' + a^b ln(a) b'
        let v = T::pow(&a.v, &b.v);
        let less = T::pow(&a.v, &T::sub(&b.v, &number(1.0)));
        let along = D::scaled(&T::mul(&b.v, &less), &a.d);
        // If the exponent is constant the logarithm, which would be undefined at a = 0, is not
        // needed.
        let power = b.d.settled();
        if power.are_zero() {
            return Self { v, d: along };
        }
        let turn = D::scaled(&T::mul(&v, &T::function(Function::Ln, &a.v)), &power);
        Self { v, d: D::sum(&along, &turn) }
    }
    #[inline(always)]
    fn atan2(y: &Self, x: &Self) -> Self {
        // (x y' - y x') / (x^2 + y^2)
        let top = D::difference(&D::scaled(&x.v, &y.d), &D::scaled(&y.v, &x.d));
        let square = T::add(&T::sqr(&x.v), &T::sqr(&y.v));
        Self { v: T::atan2(&y.v, &x.v), d: D::divided(&top, &square) }
    }
    #[inline(always)]
    fn rem(a: &Self, b: &Self) -> Self {
        // Between its jumps it is a - b trunc(a / b), with a constant factor.
        let v = T::rem(&a.v, &b.v);
        let whole = T::function(Function::Trunc, &T::div(&a.v, &b.v));
        Self { v, d: D::difference(&a.d, &D::scaled(&whole, &b.d)) }
    }
    #[inline(always)]
    fn function(f: Function, a: &Self) -> Self {
        let one = number(1.0);
        // A sine's slope is the cosine, and both take the work of one.
        let (v, other) = match f {
            Function::Sin => T::sine_and_cosine(&a.v),
            Function::Cos => {
                let (sine, cosine) = T::sine_and_cosine(&a.v);
                (cosine, sine)
            }
            _ => (T::function(f, &a.v), one),
        };
        let slope = match f {
            Function::Sin => other,
            Function::Cos => T::neg(&other),
            Function::Tan => T::add(&one, &T::sqr(&v)),
            Function::Asin => T::div(&one, &T::sqrt(&T::sub(&one, &T::sqr(&a.v)))),
            Function::Acos => T::neg(&T::div(&one, &T::sqrt(&T::sub(&one, &T::sqr(&a.v))))),
            Function::Atan => T::div(&one, &T::add(&one, &T::sqr(&a.v))),
            Function::Sinh => T::function(Function::Cosh, &a.v),
            Function::Cosh => T::function(Function::Sinh, &a.v),
            Function::Tanh => T::sub(&one, &T::sqr(&v)),
            Function::Asinh => T::div(&one, &T::sqrt(&T::add(&T::sqr(&a.v), &one))),
            Function::Acosh => T::div(&one, &T::sqrt(&T::sub(&T::sqr(&a.v), &one))),
            Function::Atanh => T::div(&one, &T::sub(&one, &T::sqr(&a.v))),
            Function::Exp => v,
            Function::Ln => T::div(&one, &a.v),
            Function::Log10 => {
                // 1 / ln 10, rounded down and up.
                let k = core::f64::consts::LOG10_E;
                T::div(&T::constant(Interval { lo: k.next_down(), hi: k.next_up() }), &a.v)
            }
            Function::Floor | Function::Ceil | Function::Trunc => return Self { v, d: D::zero() },
        };
        Self::chain(v, &slope, a)
    }
    #[inline(always)]
    fn noise(table: Option<&NoiseTable>, [x, y, z]: [&Self; 3]) -> Self {
        let (v, [dx, dy, dz]) = T::noise_and_slopes(table, [&x.v, &y.v, &z.v]);
        let d = D::sum(&D::scaled(&dx, &x.d), &D::scaled(&dy, &y.d));
        Self { v, d: D::sum(&d, &D::scaled(&dz, &z.d)) }
    }
    #[inline(always)]
    fn nearest(which: Nearest, [x, y, z]: [&Self; 3]) -> Self {
        let (v, [dx, dy, dz]) = T::nearest_and_slopes(which, [&x.v, &y.v, &z.v]);
        let d = D::sum(&D::scaled(&dx, &x.d), &D::scaled(&dy, &y.d));
        Self { v, d: D::sum(&d, &D::scaled(&dz, &z.d)) }
    }
    #[inline(always)]
    fn compare(c: Comparison, a: &Self, b: &Self) -> Self {
        Self { v: T::compare(c, &a.v, &b.v), d: D::zero() }
    }
    #[inline(always)]
    fn select(c: &Self, below: &Self, at: &Self, above: &Self) -> Self {
        Self {
            v: T::select(&c.v, &below.v, &at.v, &above.v),
            d: D::selected(&c.v, &below.d, &at.d, &above.d),
        }
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.v.is_zero() && self.d.are_zero()
    }
    #[inline(always)]
    fn above(a: &Self) -> Option<Self> {
        T::above(&a.v).map(|v| Self { v, d: D::unknown() })
    }
}
