//! CSG of every kind of solid in the language: the identities of sets, and volumes.

mod identities;
mod same_shape;
#[path = "../support/mod.rs"]
mod support;
mod volumes;

use durer_math::{Point3, Ray, Vec3};
use durer_scene::Lowered;
use durer_testkit::TestRng;

/// The scene of `text`, prepared for rays.
fn lowered(text: &str) -> Lowered {
    support::scene(text).lower().unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Draws that only these tests need.
trait Draws {
    /// A point with coordinates that are multiples of 1/4 between -2 and 2: corners, edges and
    /// faces of the solids lie there.
    fn quarter(&mut self) -> Point3;
    /// A point with coordinates of twenty bits, between -2 and 2.
    fn dyadic(&mut self) -> Point3;
    fn axis(&mut self) -> Vec3;
    /// A direction of length 1, uniformly distributed.
    fn direction(&mut self) -> Vec3;
    /// A ray with dyadic numbers: from far or near, towards faces and edges or anywhere, often
    /// along an axis or a diagonal.
    fn ray(&mut self) -> Ray;
}

impl Draws for TestRng {
    fn quarter(&mut self) -> Point3 {
        let mut x = || self.below(17) as f64 * 0.25 - 2.0;
        Point3::new(x(), x(), x())
    }

    fn dyadic(&mut self) -> Point3 {
        let mut x = || self.below(1 << 20) as f64 / (1 << 18) as f64 - 2.0;
        Point3::new(x(), x(), x())
    }

    fn axis(&mut self) -> Vec3 {
        let mut d = [0.0; 3];
        d[self.below(3) as usize] = if self.below(2) == 0 { 1.0 } else { -1.0 };
        Vec3::from(d)
    }

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
