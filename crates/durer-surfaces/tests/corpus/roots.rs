//! Any bytes as a polynomial in x, y and z and a ray: the solver finds as many roots as Sturm's
//! theorem on integers counts.

#[path = "../../../../fuzz/shared/bytes.rs"]
#[allow(clippy::duplicate_mod, reason = "each target stands alone, too; only the tests load them all")]
mod bytes;

use bytes::Bytes;
use durer_math::{Point3, Ray, Vec3};
use durer_surfaces::AlgebraicSurface;
use durer_surfaces::algebraic::{coefficient_count, place_of, powers};
use durer_surfaces::laws::{self, Exact, ZeroOracle};

impl Bytes<'_> {
    /// Usually a small round number, sometimes one of any size, sometimes one next to a round one.
    fn number(&mut self) -> f64 {
        let x = match self.next() {
            0 => f64::from_bits(self.bits()),
            1 => ((f64::from(self.next()) - 128.0) / 8.0).next_up(),
            2 => ((f64::from(self.next()) - 128.0) / 8.0).next_down(),
            3 => durer_math::scale::ldexp(f64::from(self.next()) - 128.0, i32::from(self.next()) - 128),
            n => (f64::from(n) - 128.0) / 16.0,
        };
        // Limited so that products of sixteen factors stay in range.
        if x.is_finite() && (x == 0.0 || (1e-12..1e12).contains(&x.abs())) { x } else { 1.0 }
    }
}

/// A product of `count` linear forms `x + a y + b z + c`, expanded in f64: its roots are close to
/// each other, or equal.
fn product(bytes: &mut Bytes<'_>, order: u32, count: u32) -> Vec<f64> {
    let mut all = vec![0.0; coefficient_count(order)];
    all[place_of(order, [0; 3])] = 1.0;
    let repeat = bytes.next() % 4;
    let mut form = [1.0, 0.0, 0.0, 0.0];
    for i in 0..count {
        if i == 0 || repeat == 0 || i % u32::from(repeat) == 0 {
            form = [1.0, bytes.number(), bytes.number(), bytes.number()];
        }
        let mut next = vec![0.0; all.len()];
        for (place, n) in powers(order).enumerate().filter(|(_, n)| n.iter().sum::<u32>() < order) {
            let c = all[place];
            for (axis, k) in form.into_iter().enumerate() {
                let mut to = n;
                if axis < 3 {
                    to[axis] += 1;
                }
                next[place_of(order, to)] += c * k;
            }
        }
        all = next;
    }
    all
}

/// The laws of roots. The laws of points and of the width of brackets apply only to surfaces of a
/// known size.
fn solved(surface: &AlgebraicSurface, oracle: &ZeroOracle, ray: &Ray) -> Result<(), laws::Broken> {
    let roots = laws::roots_are_the_exact_crossings(surface, oracle, ray, None)?;
    laws::closest_is_the_first_of_all(surface, ray, &roots)?;
    laws::a_reversed_ray_meets_the_same(surface, ray, &roots)?;
    laws::powers_of_two_change_nothing(surface, ray, &roots)
}

/// Tests the laws of roots for the surface and the ray that the bytes encode.
///
/// # Panics
///
/// If one does not hold.
pub(crate) fn check(data: &[u8]) {
    let mut bytes = Bytes(data);
    let order = u32::from(bytes.next() % 7) + 2;
    let how = bytes.next();
    let mut coefficients = if how % 2 == 0 {
        let count = u32::from(how / 2) % order + 1;
        product(&mut bytes, order, count)
    } else {
        vec![0.0; coefficient_count(order)]
    };
    for _ in 0..bytes.next() % 12 {
        let place = usize::from(bytes.next()) % coefficients.len();
        coefficients[place] = bytes.number();
    }
    if coefficients.iter().any(|c| !c.is_finite()) {
        return;
    }
    let Ok(surface) = AlgebraicSurface::new(order, &coefficients) else { return };
    let terms = coefficients.iter().zip(powers(order)).filter(|(c, _)| **c != 0.0);
    let terms = terms.map(|(&c, n)| (Exact::from(c), n.map(|n| n as usize)));
    let oracle = ZeroOracle { terms: terms.collect(), size: 2.0 };
    for _ in 0..2 {
        let mut three = || [bytes.number(), bytes.number(), bytes.number()];
        let ray = Ray::new(Point3::from(three()), Vec3::from(three()));
        let ray = if bytes.next() % 2 == 0 { ray.with_range(f64::NEG_INFINITY, f64::INFINITY) } else { ray };
        if ray.is_valid()
            && let Err(broken) = solved(&surface, &oracle, &ray)
        {
            panic!("{broken}\n  {ray:?}\n  order {order}, {coefficients:?}");
        }
    }
}
