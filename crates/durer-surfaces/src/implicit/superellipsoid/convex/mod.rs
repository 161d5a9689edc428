//! Superellipsoids without dents: at most two crossings, found in f64 and proven by convexity.
//!
//! ```text
//!   N(x, y) = (|x|^p + |y|^p)^(1/p),   G(x, y, z) = (N^q + |z|^q)^(1/q),   p = 2/e >= 1,  q = 2/n >= 1
//!
//!   { G <= 1 } is the superellipsoid; G = n.x with the gradient n, and G(y) >= n.y for every y
//! ```
//!
//! For `p >= 1` the power sum `N` is a norm (H. Minkowski, *Geometrie der Zahlen*, 1896), and `G`
//! is the same of `N` and `|z|`, which rises with both: a norm too, the gauge of the solid. So it
//! is convex, and along a ray `g(s) = G(o + s d)` is convex:
//!
//! - Where `g > 1` at `a`, `g < 1` at `b > a`, there is exactly one crossing between, and none
//!   before `a`: what is below 1 is an interval.
//! - Two tangents, falling at one place and rising at a later one, bound `g` from below by the
//!   value where they meet: above 1, the ray misses.
//!
//! Both ask for signs of `g - 1` and for tangents at a few places, eight in one go, and nothing is
//! said that the bounds of their errors (`gauge.rs`) do not bear out. A ray for which that is not
//! enough asks the tape: one that touches, mostly, of the short stretch that is left.

mod crossings;
mod foot;
mod gauge;
mod lanes;
#[cfg(test)]
pub(super) mod tests;

pub(in crate::implicit) use crossings::Answer;
pub(in crate::implicit) use gauge::{Gauge, Sample};
