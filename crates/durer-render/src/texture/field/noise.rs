//! Patterns made of noise, and turbulence.
//!
//! ```text
//!   bozo      N(p)                                       dents  N(p)^3
//!   wrinkles  sum of m(2^k p)/2^(k+1),  k from 0 to 9
//!   granite   sum of |1/2 - m(2^(k+2) p)|/2^k,  k from 0 to 5
//!   agate     ((1 + sin(2 pi (1.3 a T(p) + 1.1 z)))/2)^0.77
//!   marble    x + t_x T(p)
//!   wood      |(x + sin(2 pi t_x (x + D_x(p))), y + sin(2 pi t_y (y + D_y(p))))|
//!
//!   T(p) = sum of omega^k m_k(lambda^k p),   D(p) = sum of omega^k (n, n', n'')(lambda^k p)
//! ```
//!
//! `n` is the underlying noise, around zero; `n'` and `n''` are `n` at shifted points. `N` is the
//! noise of a generator, from 0 to 1. For the first generator `m` is `N`, for the others `2 N - 1/2`,
//! clamped to `[0, 1]` (in `T` clamped only in the first octave). `t` is the turbulence. Functions
//! of the scene language use the same formulas.

use crate::texture::{Grains, generator_or_scene};
use crate::vector::floor;
use core::f64::consts::TAU;
use durer_math::{F8, M8, Point3, Vec3, elementary};
use durer_scene::{GrainKind, NoiseGenerator, Turbulence};

/// `N`.
pub(super) fn ranged(grains: &Grains, p: Vec3<F8>, generator: NoiseGenerator) -> F8 {
    let n = match generator {
        NoiseGenerator::First => grains.values(p) + F8::splat(0.5),
        NoiseGenerator::Second => (grains.values(p) + F8::splat(1.05242)) * 0.489_855_82,
        NoiseGenerator::Third => grains.gradient_noise(p) * 0.795 + F8::splat(0.4925),
    };
    n.max(F8::ZERO).min(F8::ONE)
}

/// `m`; without the clamp if `clamped` is false.
fn grain(grains: &Grains, p: Vec3<F8>, generator: NoiseGenerator, clamped: bool) -> F8 {
    let n = ranged(grains, p, generator);
    if generator == NoiseGenerator::First {
        return n;
    }
    let m = n * 2.0 - F8::splat(0.5);
    if clamped { m.max(F8::ZERO).min(F8::ONE) } else { m }
}

/// The values of a pattern at some points.
pub(super) fn values(kind: GrainKind, generator: NoiseGenerator, grains: &Grains, p: Point3<F8>) -> F8 {
    let p = p.to_vec();
    match kind {
        GrainKind::Bozo | GrainKind::Agate(..) => ranged(grains, p, generator),
        GrainKind::Dents => {
            let n = ranged(grains, p, generator);
            n * n * n
        }
        GrainKind::Wrinkles => {
            let (mut sum, mut weight, mut scale) = (F8::ZERO, 0.5, 1.0);
            for _ in 0..10 {
                sum += grain(grains, p * F8::splat(scale), generator, true) * weight;
                (weight, scale) = (weight * 0.5, scale * 2.0);
            }
            sum
        }
        GrainKind::Granite => {
            let (mut sum, mut weight, mut scale) = (F8::ZERO, 1.0, 4.0);
            for _ in 0..6 {
                sum += (F8::splat(0.5) - grain(grains, p * F8::splat(scale), generator, true)).abs() * weight;
                (weight, scale) = (weight * 0.5, scale * 2.0);
            }
            sum
        }
    }
}

/// Turbulence with its octaves precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stir {
    pub(crate) amount: Vec3,
    /// The weight and the scale of each octave.
    octaves: Box<[(f64, f64)]>,
    generator: NoiseGenerator,
    grains: Grains,
}

impl Stir {
    pub(crate) fn new(turbulence: &Turbulence) -> Self {
        // The language stores both in single precision.
        let [omega, lambda] =
            [turbulence.octaves.omega, turbulence.octaves.lambda].map(|v| f64::from(v as f32));
        let octave = |k: u32| (elementary::powi(omega, k as i32), elementary::powi(lambda, k as i32));
        Self {
            amount: turbulence.amount,
            octaves: (0..turbulence.octaves.count).map(octave).collect(),
            generator: generator_or_scene(turbulence.generator),
            grains: Grains::current(),
        }
    }

    /// `T`.
    pub(crate) fn scalar(&self, p: Point3<F8>) -> F8 {
        let mut sum = F8::ZERO;
        for (k, &(weight, scale)) in self.octaves.iter().enumerate() {
            sum += grain(&self.grains, p.to_vec() * F8::splat(scale), self.generator, k == 0) * weight;
        }
        sum
    }

    /// `D` along the first `axes` axes, where the turbulence is not 0; other components are arbitrary.
    fn vector(&self, p: Point3<F8>, axes: usize) -> Vec3<F8> {
        let amounts = self.amount.to_array();
        let wanted = [0, 1, 2].map(|axis| axis < axes && amounts[axis] != 0.0);
        let mut sum = Vec3::splat(Vec3::ZERO);
        for &(weight, scale) in &self.octaves {
            sum += self.grains.vectors(p.to_vec() * F8::splat(scale), wanted) * F8::splat(weight);
        }
        sum
    }

    /// `p + t D(p)`.
    pub(crate) fn moved(&self, p: Point3<F8>) -> Point3<F8> {
        let moved = |way: F8, amount: f64| if amount == 0.0 { F8::ZERO } else { way * amount };
        let (d, t) = (self.vector(p, 3), self.amount);
        p + Vec3::new(moved(d.x, t.x), moved(d.y, t.y), moved(d.z, t.z))
    }
}

pub(super) fn marble(stir: Option<&Stir>, p: Point3<F8>) -> F8 {
    match stir {
        Some(stir) if stir.amount.x != 0.0 => p.x + stir.scalar(p) * stir.amount.x,
        _ => p.x,
    }
}

pub(super) fn wood(stir: Option<&Stir>, p: Point3<F8>, live: M8) -> F8 {
    let Some(stir) = stir else { return (p.x * p.x + p.y * p.y).sqrt() };
    let (d, t) = (stir.vector(p, 2), stir.amount);
    let along = |x: F8, d: F8, t: f64| {
        if t == 0.0 { x } else { x + each((x + d) * (TAU * t), live, elementary::sin) }
    };
    let (x, y) = (along(p.x, d.x, t.x), along(p.y, d.y, t.y));
    (x * x + y * y).sqrt()
}

pub(super) fn agate(amount: f64, stir: &Stir, p: Point3<F8>, live: M8) -> F8 {
    let turns = stir.scalar(p) * (1.3 * amount) + p.z * 1.1;
    each(turns, live, |t| {
        let wave = (1.0 + elementary::sin(TAU * (t - floor(t)))) * 0.5;
        elementary::pow(wave.max(0.0), 0.77)
    })
}

fn each(x: F8, live: M8, f: impl Fn(f64) -> f64) -> F8 {
    let mut values = F8::ZERO;
    for i in live.lanes() {
        values.0[i] = f(x.0[i]);
    }
    values
}
