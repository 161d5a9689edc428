//! Random numbers and rays that aim at difficult cases.

use durer_math::scale::{exponent, ldexp};
use durer_math::{Affine, Point3, Ray, Vec3};

/// A counter-based generator (S. Vigna's SplitMix64): the same numbers everywhere.
#[derive(Clone, Copy, Debug)]
pub struct TestRng(u64);

impl TestRng {
    /// The generator with this seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd129_0cb3_7f4a_7c15))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer in `[0, n)`.
    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// An index below `n`.
    pub fn index(&mut self, n: usize) -> usize {
        self.below(n as u64) as usize
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// A number in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (f64::EPSILON / 2.0)
    }

    /// A number in `[-1, 1)`.
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * f64::EPSILON - 1.0
    }

    /// A number in `[lo, hi)`.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// An integer in `[lo, hi]`.
    pub fn integer(&mut self, lo: i64, hi: i64) -> f64 {
        (lo + self.below((hi - lo + 1) as u64) as i64) as f64
    }

    /// One of `choices`.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len() as u64) as usize]
    }

    /// A positive number whose logarithm is uniform over `2^lo .. 2^hi`.
    pub fn scale(&mut self, lo: i32, hi: i32) -> f64 {
        ldexp(1.0 + self.unit(), lo + self.below((hi - lo) as u64) as i32)
    }

    /// A power of two in `2^lo ..= 2^hi`.
    pub fn power(&mut self, lo: i32, hi: i32) -> f64 {
        ldexp(1.0, lo + self.below((hi - lo + 1) as u64) as i32)
    }

    /// `x`, or one of its neighbours up to `k` ulp away.
    pub fn nudge(&mut self, x: f64, k: u64) -> f64 {
        let n = self.below(2 * k + 1) as i64 - k as i64;
        let step = |x: f64| if n > 0 { x.next_up() } else { x.next_down() };
        (0..n.abs()).fold(x, |x, _| step(x))
    }

    /// A vector of small integers, not zero.
    pub fn lattice(&mut self, reach: i64) -> Vec3 {
        loop {
            let v = Vec3::new(
                self.integer(-reach, reach),
                self.integer(-reach, reach),
                self.integer(-reach, reach),
            );
            if v != Vec3::ZERO {
                return v;
            }
        }
    }

    /// A vector with components in `[-1, 1]`.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A point with coordinates in `[-size, size)`.
    pub fn point(&mut self, size: f64) -> Point3 {
        Point3::new(self.signed() * size, self.signed() * size, self.signed() * size)
    }

    /// A map with few-bit entries, sheared, stretched or mirrored; sometimes one with full-width
    /// entries.
    pub fn map(&mut self) -> Affine {
        loop {
            let wild = self.once_in(4);
            let stretch = if self.once_in(3) { self.power(-12, 12) } else { 1.0 };
            let mut entry = || {
                let x = if wild { self.between(-2.0, 2.0) } else { self.integer(-8, 8) * 0.25 };
                x * stretch
            };
            let rows =
                [[entry(), entry(), entry()], [entry(), entry(), entry()], [entry(), entry(), entry()]];
            let far = self.once_in(3);
            let c = if far { self.vector() * self.scale(0, 20) } else { self.lattice(16) * 0.5 };
            if let Ok(map) = Affine::new(rows, c.to_point()) {
                return map;
            }
        }
    }
}

/// A point of a surface where errors are likely, and a direction that makes them more likely (a
/// tangent, an axis, a generator).
#[derive(Clone, Copy, Debug)]
pub struct Feature {
    /// The point.
    pub point: Point3,
    /// The direction; zero if any direction is suitable.
    pub direction: Vec3,
}

impl Feature {
    /// A feature with this point and direction.
    pub fn new(point: impl Into<[f64; 3]>, direction: impl Into<[f64; 3]>) -> Self {
        Self { point: Point3::from(point.into()), direction: Vec3::from(direction.into()) }
    }

    /// This feature on the placed surface, up to rounding (none, for few-bit numbers).
    #[must_use]
    pub fn placed(self, map: &Affine) -> Self {
        Self { point: map.point(self.point), direction: map.vector(self.direction) }
    }
}

/// A ray that aims at one of the features, or at two of them in a line, or anywhere; exactly, or
/// missing by an ulp or a little more.
///
/// `size` is the surface's size: origins lie 0 to `2^30` sizes away (sometimes `2^50`), directions
/// are `2^-330` to `2^330` long.
pub fn aim(dice: &mut TestRng, features: &[Feature], size: f64) -> Ray {
    let mut f = dice.pick(features);
    if f.direction != Vec3::ZERO {
        // Scaled by a power of two to about the surface's size.
        let k = exponent(size) - exponent(f.direction.max_abs());
        f.direction = f.direction.map(|x| ldexp(x, k));
    }
    let mut direction = match dice.below(8) {
        0..=2 if f.direction != Vec3::ZERO => f.direction,
        3 => dice.lattice(6) * size,
        4 => dice.vector() * size,
        5 => {
            // Along one axis, so that components vanish.
            let mut d = [0.0; 3];
            d[dice.below(3) as usize] = dice.pick(&[-1.0, 1.0]);
            Vec3::from(d) * size
        }
        6 => {
            // Nearly the feature's direction.
            let v = f.direction + dice.vector() * (f.direction.max_abs() * dice.scale(-50, -1));
            if v == Vec3::ZERO { dice.lattice(3) * size } else { v }
        }
        _ => {
            let g = dice.pick(features);
            let v = g.point - f.point;
            if v == Vec3::ZERO { dice.lattice(3) * size } else { v }
        }
    };
    let mut target = f.point;
    match dice.below(8) {
        0 => target = target + dice.vector() * size,
        1 => target = target + dice.vector() * (size * dice.scale(-52, -3)),
        2 => {
            // Exactly beside the feature, by a few-bit distance.
            target = target + dice.lattice(2) * (size * dice.power(-24, -1));
        }
        _ => {}
    }
    let back = match dice.below(10) {
        0 => 0.0,
        1..=4 => dice.integer(-3, 4),
        5 | 6 => dice.power(0, 6),
        7 | 8 => dice.power(6, 22),
        _ => dice.power(20, 40),
    };
    let mut origin = target - direction * back;
    if dice.once_in(3) {
        origin = Point3::new(dice.nudge(origin.x, 2), dice.nudge(origin.y, 2), dice.nudge(origin.z, 2));
    }
    if dice.once_in(4) {
        direction =
            Vec3::new(dice.nudge(direction.x, 2), dice.nudge(direction.y, 2), dice.nudge(direction.z, 2));
    }
    let length = match dice.below(6) {
        0 => dice.power(-330, 330),
        1 | 2 => dice.power(-20, 20),
        3 => dice.scale(-20, 20),
        _ => 1.0,
    };
    let scaled = direction * length;
    let direction = if scaled.is_finite() && scaled != Vec3::ZERO { scaled } else { direction };
    let ray = Ray::new(origin, direction);
    match dice.below(4) {
        0 => ray,
        1 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
        2 => ray.with_range(f64::NEG_INFINITY, 0.0),
        _ => {
            // The range ends at crossings.
            let at = back / length;
            let ends = [at, dice.nudge(at, 1), at * dice.between(0.0, 2.0), f64::INFINITY, 0.0, -at];
            let (a, b) = (dice.pick(&ends), dice.pick(&ends));
            if a.is_nan() || b.is_nan() || a.min(b) == f64::INFINITY {
                ray
            } else {
                ray.with_range(a.min(b), a.max(b))
            }
        }
    }
}
