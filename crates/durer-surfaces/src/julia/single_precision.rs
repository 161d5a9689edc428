//! Orbits in f32, for stretches that are long compared with its rounding.
//!
//! Eight f32 fill one AVX2 register; the ten numbers of an orbit's step, eight times in f64, do not
//! fit into all of them.

use super::orbit::{Ball, Rule};
use durer_math::F8;
use durer_math::lanes::LANES;
use durer_math::real::{Eight, Real, more};
use durer_math::scale::pow2;

/// Rounds to the nearest f32; too large numbers become infinite.
#[inline(always)]
fn nearest(x: &Eight<f64>) -> Eight<f32> {
    let mut near = Eight::ZERO;
    for k in 0..LANES {
        near.0[k] = x.0[k] as f32;
    }
    near
}

/// Rounds a number that is not negative upward.
#[inline(always)]
fn no_less(x: f64) -> f32 {
    (x as f32) * more::<f32>(4.0) + f32::TINY
}

impl<const C: usize> Ball<f64, C> {
    /// Middles, slopes, and the errors of both.
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

    /// The stretches in f32, slightly wider: the rounding of middles and slopes is added to their
    /// errors.
    #[inline(always)]
    pub(super) fn rounded(&self) -> Ball<f32, C> {
        // Each sum of magnitudes is rounded by less than a millionth of it, and no root of a sum of
        // squares is longer.
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
    /// The rule in f32.
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
