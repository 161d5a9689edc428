//! Superellipsoids without dents: at most two crossings, found in f64 and proven by convexity.
//!
//! ```text
//!   N(x, y) = (|x|^p + |y|^p)^(1/p),   G(x, y, z) = (N^q + |z|^q)^(1/q),   p = 2/e >= 1,  q = 2/n >= 1
//!
//!   { G <= 1 } is the superellipsoid; G = n.x with the gradient n, and G(y) >= n.y for every y
//! ```
//!
//! For `p >= 1` the power sum `N` is a norm (H. Minkowski, *Geometrie der Zahlen*, 1896), and `G`
//! is such a sum of `N` and `|z|`, which rises with both: a norm, too, the gauge of the solid. So
//! it is convex, and along a ray `g(s) = G(o + s d)` is convex:
//!
//! - Where `g > 1` at `a`, `g < 1` at `b > a`, there is exactly one crossing between, and none
//!   before `a`: the points below 1 form an interval.
//! - Two tangents, falling at one point and rising at a later one, bound `g` from below by the
//!   value where they meet: if that is above 1, the ray misses.
//!
//! Both need signs of `g - 1` and tangents at a few points, eight at a time, and every conclusion
//! includes the bounds of their errors (`gauge.rs`). If that does not suffice, the tape decides:
//! mostly for a ray that touches, on the short remaining stretch.

mod crossings;
mod foot;
mod gauge;
mod lanes;
#[cfg(test)]
pub(super) mod tests;

pub(in crate::implicit) use crossings::Answer;
pub(in crate::implicit) use gauge::{Gauge, Sample};
