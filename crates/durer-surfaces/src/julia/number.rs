//! What orbits are counted in: f64, and f32 where stretches are long beside its roundings.
//!
//! Eight f32 fill one register of AVX2, where the ten numbers of an orbit's step, eight times in f64, do not fit into all of them. What is said with either is certain: each charges its own roundings.

use super::orbit::{Ball, Rule};
use core::ops::{Add, Div, Mul, Neg, Sub};
use durer_math::lanes::LANES;
use durer_math::scale::pow2;
use durer_math::{F8, M8};

/// A number of either kind.
pub(super) trait Real:
    Copy
    + PartialOrd
    + From<f32>
    + Into<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    const ZERO: Self;
    /// The bound on the relative error of one rounding.
    const U: Self;
    /// Pays for results below the normal range.
    const TINY: Self;
    fn mul_add(self, a: Self, b: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// `other` where one is not a number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// `other` where one is not a number.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

/// A number that both kinds have.
#[inline(always)]
pub(super) fn real<T: Real>(x: f32) -> T {
    T::from(x)
}

/// So many roundings of 1.
#[inline(always)]
pub(super) fn roundings<T: Real>(count: f32) -> T {
    T::from(count) * T::U
}

/// 1, and so many roundings more.
#[inline(always)]
pub(super) fn more<T: Real>(count: f32) -> T {
    T::from(1.0) + roundings(count)
}

/// 1, less so many roundings.
#[inline(always)]
pub(super) fn less<T: Real>(count: f32) -> T {
    T::from(1.0) - roundings(count)
}

macro_rules! impl_real {
    ($number:ty, $tiny:expr) => {
        impl Real for $number {
            const ZERO: Self = 0.0;
            const U: Self = 0.5 * <$number>::EPSILON;
            const TINY: Self = $tiny;
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self.mul_add(a, b)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
        }
    };
}

impl_real!(f64, pow2(-900));
impl_real!(f32, pow2(-110) as f32);

/// Eight of them.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Eight<T>(pub(super) [T; LANES]);

impl<T: Real> Eight<T> {
    pub(super) const ZERO: Self = Self([T::ZERO; LANES]);

    /// In f64, exactly.
    #[inline(always)]
    pub(super) fn widened(&self) -> F8 {
        let mut wide = F8::ZERO;
        for k in 0..LANES {
            wide.0[k] = self.0[k].into();
        }
        wide
    }

    /// The greater ones of these and others.
    #[inline(always)]
    pub(super) fn raise(&mut self, others: &Self) {
        for k in 0..LANES {
            self.0[k] = others.0[k].max(self.0[k]);
        }
    }

    #[inline(always)]
    pub(super) fn are_all_positive(&self) -> bool {
        let mut all = true;
        for k in 0..LANES {
            all &= self.0[k] > T::ZERO;
        }
        all
    }

    /// Where they are positive.
    #[inline(always)]
    pub(super) fn are_positive(&self) -> M8 {
        self.widened().gt(F8::ZERO)
    }
}

/// To the nearest f32; too large ones become infinite.
#[inline(always)]
fn nearest(x: &Eight<f64>) -> Eight<f32> {
    let mut near = Eight::ZERO;
    for k in 0..LANES {
        near.0[k] = x.0[k] as f32;
    }
    near
}

/// No less than a number that is not negative.
#[inline(always)]
fn no_less(x: f64) -> f32 {
    (x as f32) * more::<f32>(4.0) + f32::TINY
}

impl<const C: usize> Ball<f64, C> {
    /// Middles, slopes, and what is not known of both.
    #[inline(always)]
    pub(super) fn new(q: &[F8; C], v: &[F8; C], r: F8, d: F8) -> Self {
        let mut ball = Self { r: Eight(r.0), d: Eight(d.0), ..Self::ZERO };
        for i in 0..C {
            (ball.q[i], ball.v[i]) = (Eight(q[i].0), Eight(v[i].0));
        }
        ball
    }

    /// The middles of the stretches.
    #[inline(always)]
    pub(super) fn points(&self) -> [F8; C] {
        let mut points = [F8::ZERO; C];
        for (point, q) in points.iter_mut().zip(&self.q) {
            *point = F8(q.0);
        }
        points
    }

    /// The same stretches in f32, a bit wider: middles and slopes are rounded, which is charged to their errors.
    #[inline(always)]
    pub(super) fn rounded(&self) -> Ball<f32, C> {
        // Each sum of magnitudes is rounded by less than a millionth of it, and no root of a sum of squares is longer.
        let u = f64::from(f32::U) * (1.0 + pow2(-20));
        let mut less = Ball::ZERO;
        for i in 0..C {
            (less.q[i], less.v[i]) = (nearest(&self.q[i]), nearest(&self.v[i]));
        }
        for k in 0..LANES {
            let (mut q, mut v) = (0.0, 0.0);
            for i in 0..C {
                (q, v) = (q + self.q[i].0[k].abs(), v + self.v[i].0[k].abs());
            }
            less.r.0[k] = no_less(self.r.0[k] + (q + v) * u);
            less.d.0[k] = no_less(self.d.0[k] + v * u);
        }
        less
    }
}

impl<const M: usize, const C: usize> Rule<f64, M, C> {
    /// The same in f32.
    pub(super) fn rounded(&self) -> Rule<f32, M, C> {
        let off = |x: f64| (x - f64::from(x as f32)).abs();
        let c_off = self.c.iter().map(|c| c.iter().map(|&x| off(x)).sum()).fold(0.0, f64::max);
        Rule {
            c: self.c.map(|c| c.map(|x| x as f32)),
            c_err: no_less(self.c_err + c_off),
            c_size: no_less(self.c_size),
            power: self.power,
            iterations: self.iterations,
            radius: self.radius as f32,
            radius_err: no_less(self.radius_err + off(self.radius)),
            escapes: self.escapes,
        }
    }
}
