//! Julia sets of quaternions and hypercomplex numbers, for a fixed number of iterations.
//!
//! ```text
//!   z_0 = the point in its slice of four dimensions,  z_(n+1) = z_n^k + c,  k = 2 or 3
//!
//!   the solid: { p : |z_n| <= R for n = 0 .. N }
//! ```
//!
//! A. Norton, "Generation and display of geometric fractals in 3-D", SIGGRAPH 1982; J. C. Hart, D.
//! J. Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH 1989. Those march
//! by an estimate of the distance. Here the surface is exactly its definition, the zero set of `max
//! |z_n|² - R²`, and certain signs bracket its crossings: balls enclose the orbits of stretches of
//! the ray (`orbit.rs`).
//!
//! **Escape.** For quaternions, where `|z^k| = |z|^k`, an orbit that leaves the ball of radius
//! `R >= 1` never returns if `R² - R >= |c|`: then `|z| > R` makes
//! `|z^k + c| >= |z|² - |c| > R² - |c| >= R`. The surface is then `|z_N| = R`; in general it is
//! not. Of the two complex numbers of a hypercomplex one outside the ball, the longer is longer
//! than `R`, and its successor is longer than `√2 R`, so that their mean square exceeds `R²` again,
//! if `R² - √2 R >= |c|` for the `c` of each.
//!
//! **The extent.** A point is no longer than it is in its slice. For quaternions `|z_(n+1)| <= ρ`
//! needs `|z_n|^k <= ρ + |c|`, so `N` roots give a smaller ball than `n = 0` does. The same holds
//! for the two complex numbers of a hypercomplex one, which are at most `√2` times as long.

mod embed;
mod lanes;
mod orbit;
mod point;
mod roots;
mod single_precision;
#[cfg(test)]
mod tests;

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use durer_math::{Aabb, Affine, Dyadic, Interval, Point3, Vec3, elementary};
use durer_roots::quadratic::Quadratic;
use embed::Lift;
use orbit::{Rule, TINY};
use std::sync::Arc;

/// The algebra of the four coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JuliaAlgebra {
    /// `ij = k = -ji`, `i² = j² = k² = -1`.
    Quaternion,
    /// `ij = ji = k`, `i² = j² = -1`, `k² = 1`.
    Hypercomplex,
}

/// The iterated power, to which `c` is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JuliaPower {
    /// `z²`.
    Square,
    /// `z³`.
    Cube,
}

/// The parameters of a Julia set, not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Julia {
    /// The constant: 1, i, j, k.
    pub c: [f64; 4],
    /// The algebra.
    pub algebra: JuliaAlgebra,
    /// The power.
    pub power: JuliaPower,
    /// The number of iterations.
    pub iterations: u32,
    /// `R`: inside, no point of the orbit is farther from zero; positive.
    pub radius: f64,
    /// The normal of the slice, `x y z w`; `w` is not zero.
    pub normal: [f64; 4],
    /// The slice is `normal . q = distance |normal|`.
    pub distance: f64,
}

/// Why a Julia set cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum JuliaError {
    /// A number is infinite or NaN.
    #[error("julia_fractal: its numbers must be finite, got {0}")]
    Number(f64),
    /// The slice contains the fourth axis.
    #[error("julia_fractal: the fourth component of the slice's normal must not be zero")]
    Slice,
    /// The radius is not positive, or larger than 2^100.
    #[error("julia_fractal: the radius of escape must be positive, got {0}")]
    Radius(f64),
    /// More iterations than make sense in f64.
    #[error("julia_fractal: it can be iterated {MOST_ITERATIONS} times at most, not {0}")]
    Iterations(u32),
}

/// The greatest number of iterations.
pub const MOST_ITERATIONS: u32 = 1000;

/// The margin between the solid and the ball that is examined.
const ROOM: f64 = 1.0 / 64.0;

/// A solid Julia set. One face.
#[derive(Clone, Debug)]
pub struct JuliaSet(Arc<Algebra>);

/// A set, in the numbers of its algebra.
#[derive(Clone, Debug)]
enum Algebra {
    Quaternion(Solid<1, 4>),
    Hypercomplex(Solid<2, 2>),
}

/// A set of `M` numbers with `C` coordinates each.
#[derive(Clone, Debug)]
struct Solid<const M: usize, const C: usize> {
    rule: Rule<f64, M, C>,
    /// The iteration in f32, for packets.
    coarse: Rule<f32, M, C>,
    lift: Lift<M, C>,
    /// The radius of a ball about the origin that strictly holds the set.
    radius: f64,
}

impl JuliaSet {
    /// The solid Julia set.
    pub fn new(set: &Julia) -> Result<Self, JuliaError> {
        if let Some(&bad) = set.c.iter().chain(&set.normal).chain([&set.distance]).find(|x| !x.is_finite()) {
            return Err(JuliaError::Number(bad));
        }
        if set.normal[3] == 0.0 {
            return Err(JuliaError::Slice);
        }
        if !(set.radius > 0.0 && set.radius < durer_math::scale::pow2(100)) {
            return Err(JuliaError::Radius(set.radius));
        }
        if set.iterations > MOST_ITERATIONS {
            return Err(JuliaError::Iterations(set.iterations));
        }
        let [a, b, c, d] = set.c;
        let (power, iterations, radius) = (set.power, set.iterations, set.radius);
        let square = set.c.iter().fold(Interval::from(0.0), |sum, &x| sum + Interval::from(x).square());
        let size = square.sqrt().hi;
        let algebra = match set.algebra {
            JuliaAlgebra::Quaternion => {
                let escapes =
                    radius >= 1.0 && (radius * radius - radius) * (1.0 - 8.0 * durer_math::U) >= size;
                let rule = Rule {
                    c: [set.c],
                    c_err: 0.0,
                    c_size: size,
                    power,
                    iterations,
                    radius,
                    radius_err: 0.0,
                    escapes,
                };
                Algebra::Quaternion(Solid {
                    rule,
                    coarse: rule.rounded(),
                    lift: Lift::quaternion(set),
                    radius: least_ball(set, radius, size),
                })
            }
            JuliaAlgebra::Hypercomplex => {
                // For `a + b i + c j + d k`: `(a - d)² + (b + c)²` and `(a + d)² + (b - c)²`.
                let square = |x: f64, y: f64| {
                    let sums = Interval::from(x).square() + Interval::from(y).square();
                    sums.sqrt().hi * (1.0 + 8.0 * durer_math::U)
                };
                let c_size = square(a - d, b + c).max(square(a + d, b - c)) + TINY;
                // Each sum is rounded once.
                let c_err = c_size * (4.0 * durer_math::U) + TINY;
                // More than √2.
                let escapes = radius >= 1.0
                    && (radius * radius - 1.4375 * radius) * (1.0 - 8.0 * durer_math::U) >= c_size;
                let rule = Rule {
                    c: [[a - d, b + c], [a + d, b - c]],
                    c_err,
                    c_size,
                    power,
                    iterations,
                    radius,
                    radius_err: 0.0,
                    escapes,
                };
                Algebra::Hypercomplex(Solid {
                    rule,
                    coarse: rule.rounded(),
                    lift: Lift::hypercomplex(set),
                    radius: least_ball(set, 1.5 * radius, c_size).min(radius + ROOM),
                })
            }
        };
        Ok(Self(Arc::new(algebra)))
    }

    fn radius(&self) -> f64 {
        match &*self.0 {
            Algebra::Quaternion(set) => set.radius,
            Algebra::Hypercomplex(set) => set.radius,
        }
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        match &*self.0 {
            Algebra::Quaternion(set) => set.roots(ray, sink),
            Algebra::Hypercomplex(set) => set.roots(ray, sink),
        }
    }
}

/// The radius of a ball that strictly holds a set, with [`ROOM`] to spare. `most` bounds the length
/// of any point of an orbit inside, `size` that of `c`.
fn least_ball(set: &Julia, most: f64, size: f64) -> f64 {
    let mut radius = most;
    for _ in 0..set.iterations {
        let next = match set.power {
            JuliaPower::Square => (radius + size).sqrt(),
            JuliaPower::Cube => elementary::cbrt(radius + size),
        };
        // Far more than the rounding of a root.
        let next = next * (1.0 + 1.0 / (1u64 << 40) as f64);
        if next.partial_cmp(&radius) != Some(core::cmp::Ordering::Less) {
            break;
        }
        radius = next;
    }
    radius + ROOM
}

impl Surface for JuliaSet {
    fn bounds(&self) -> Aabb {
        let radius = self.radius();
        Aabb::centred(Point3::ORIGIN, Vec3::new(radius, radius, radius))
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(Point3::ORIGIN, self.radius()) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        match &*self.0 {
            Algebra::Quaternion(set) => set.point(ray, root, need),
            Algebra::Hypercomplex(set) => set.point(ray, root, need),
        }
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        match &*self.0 {
            Algebra::Quaternion(set) => set.side(point),
            Algebra::Hypercomplex(set) => set.side(point),
        }
    }
}

impl Accelerate for JuliaSet {
    fn name(&self) -> &'static str {
        "Julia set"
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        match crate::Sphere::new(Point3::ORIGIN, self.radius()) {
            Ok(ball) => ball.bounds_through(map),
            Err(_) => map.bounds(&self.bounds()),
        }
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        match &*self.0 {
            Algebra::Quaternion(set) => set.packet_filter(self.bounds()),
            Algebra::Hypercomplex(set) => set.packet_filter(self.bounds()),
        }
    }
}

impl Algebraic for JuliaSet {
    /// None: its degree is far beyond those that can be solved.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }
}
