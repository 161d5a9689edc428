//! CSG of every kind of solid in the language: the identities of sets, and volumes.

mod identities;
mod same_shape;
#[path = "../support/mod.rs"]
mod support;
mod volumes;

use durer_math::{Point3, Ray, Vec3};
use durer_scene::Lowered;

/// The scene of `text`, prepared for rays.
fn lowered(text: &str) -> Lowered {
    support::scene(text).lower().unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// A pseudorandom sequence, a function of the seed and the count (S. Vigna's SplitMix64).
struct Dice(u64);

impl Dice {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// A number in `[0, 1)`.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A point with coordinates that are multiples of 1/4 between -2 and 2: corners, edges and
    /// faces of the solids lie there.
    fn quarter(&mut self) -> Point3 {
        let mut x = || self.below(17) as f64 * 0.25 - 2.0;
        Point3::new(x(), x(), x())
    }

    /// A point with coordinates of twenty bits, between -2 and 2.
    fn dyadic(&mut self) -> Point3 {
        let mut x = || self.below(1 << 20) as f64 / (1 << 18) as f64 - 2.0;
        Point3::new(x(), x(), x())
    }

    fn axis(&mut self) -> Vec3 {
        let mut d = [0.0; 3];
        d[self.below(3) as usize] = if self.below(2) == 0 { 1.0 } else { -1.0 };
        Vec3::from(d)
    }

    /// A direction of length 1, uniformly distributed.
    fn direction(&mut self) -> Vec3 {
        loop {
            let mut x = || 2.0 * self.unit() - 1.0;
            let v = Vec3::new(x(), x(), x());
            let length = v.length();
            if length <= 1.0 && length > 0.01 {
                return v / length;
            }
        }
    }

    /// A ray with dyadic numbers: from far or near, towards faces and edges or anywhere, often
    /// along an axis or a diagonal.
    fn ray(&mut self) -> Ray {
        let aim = if self.below(3) == 0 { self.dyadic() } else { self.quarter() };
        let d = match self.below(5) {
            0 => self.axis(),
            1 => self.axis() + self.axis() * 0.5,
            2 => self.quarter() - self.quarter(),
            _ => self.dyadic().to_vec(),
        };
        let d = if d == Vec3::ZERO { Vec3::X } else { d };
        let back = [0.0, 4.0, 8.0, 8.0][self.below(4) as usize];
        Ray::new(aim - d * back, d)
    }
}
