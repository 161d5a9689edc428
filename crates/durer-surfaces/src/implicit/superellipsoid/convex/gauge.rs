//! The gauge of a convex superellipsoid and its gradient at eight points, and how far they are from
//! the true ones.
//!
//! All is worked out from binary logarithms `a`, `b` of `max(|x|, |y|)`, `min(|x|, |y|)` and `c` of
//! `|z|`:
//!
//! ```text
//!   w = 2^(p (b - a)),  log N = a + log(1 + w) / p;   v = 2^(q (low - high)) of log N and c,  log G = high + log(1 + v) / q
//!
//!   d log N = (d log max + w d log min) / (1 + w), likewise for G: the gradient's parts are G times such shares, over the coordinate
//! ```
//!
//! **The value.** Logarithms err by `8 u` of themselves, powers by `4 u`, sums `1 + w` by `u`. An
//! error of the exponent `p (b - a)` counts in `log N` with the share of `w`, over `p`:
//! `w |b - a| <= 0.54 / p`, so what is small weighs as little as it errs much. With `1/4 <= G <= 4`
//! the larger of two logarithms is at most 3, `log N` errs by `125 u` (by `80 u` near the surface)
//! and `log G` by `34 u` more: [`VALUE`] bounds what that makes of `G`. A coordinate below
//! [`LEAST`] is taken for that, which moves the point by less than any rounding.
//!
//! **The gradient.** With `|log| <= 66` each exponent errs by at most `p 1222 u` or `q 1972 u`, a
//! share by `ln 2` times that: the parts are known within `1024 p u + 1536 q u + 2048 u` of
//! themselves. For a true gradient `n` the dual norm is 1, and it is absolute: it sees sizes only.
//! So parts within `ε` of themselves have a dual norm of at most `1 + ε`, and
//! `G(y) >= n.y / (1 + ε)` for them.

use durer_formula::lane_logs::{exp2, log2};
use durer_math::scale::pow2;
use durer_math::{F8, Isa, U, Vec3, elementary};

/// Bound on the error of the gauge, relative to it, where it is from 1/4 to 4.
pub(super) const VALUE: f64 = 128.0 * U;
/// A coordinate's least size.
const LEAST: f64 = pow2(-64);
/// A bound of the error by that and by one rounding of each coordinate of a point.
pub(super) const REST: f64 = 8.0 * U;
/// Lower exponents, whose powers count for nothing, are taken for this.
const LOWEST: f64 = -1000.0;
/// Thinner spikes than those of this exponent are left to the tape: the bound of the value grows
/// with it (`../concave.rs`).
const MOST_DENTED: f64 = 8.0;
/// Sharper exponents than this make a box, and are left to the tape.
const SHARPEST: f64 = 1.0 / 128.0;

/// The gauge of the superellipsoid of the exponents `e` and `n`, and what follows from them.
#[derive(Clone, Debug)]
pub(in crate::implicit) struct Gauge {
    /// `2/e` and `2/n`, rounded, and one over those, exactly.
    p: f64,
    q: f64,
    over_p: f64,
    over_q: f64,
    /// Bound on the error of a gradient's part, relative to it.
    pub(super) turn: f64,
    /// A ball of this radius holds the solid.
    pub(super) reach: f64,
    /// A coordinate's least size.
    least: f64,
}

/// The gauge and its gradient at eight points.
#[derive(Debug)]
pub(in crate::implicit) struct Sample {
    pub(in crate::implicit) value: F8,
    pub(in crate::implicit) gradient: Vec3<F8>,
}

/// The gradient's parts as products: `∂N/∂x ∂G/∂N`, `∂N/∂y ∂G/∂N` and `∂G/∂z`.
#[derive(Debug)]
pub(super) struct Factors {
    pub(super) x: F8,
    pub(super) y: F8,
    pub(super) outer: F8,
    pub(super) z: F8,
}

/// The constants of both.
struct Shares {
    /// The logarithms of `N` and of `G`.
    across: F8,
    whole: F8,
    x: F8,
    y: F8,
    /// Shares of `N` and `z` in `G`.
    outer: F8,
    z: F8,
}

impl Gauge {
    /// The gauge; `None` where the solid has dents, or edges too sharp for f64.
    pub(in crate::implicit) fn new(e: f64, n: f64) -> Option<Self> {
        if !(SHARPEST..=2.0).contains(&e) || !(SHARPEST..=2.0).contains(&n) {
            return None;
        }
        let (p, q) = (2.0 / e, 2.0 / n);
        // The Euclidean norm of two numbers is at most so many times their p norm.
        let excess = |over: f64| (0.5 - over).max(0.0);
        let reach = elementary::exp2(excess(0.5 * e) + excess(0.5 * n)) * (1.0 + pow2(-40));
        let turn = (1024.0 * p + 1536.0 * q + 2048.0) * U;
        Some(Self { p, q, over_p: 0.5 * e, over_q: 0.5 * n, turn, reach, least: LEAST })
    }

    /// The same function for exponents that make dents between all axes, if these are such: no
    /// norm, and without a bound for gradients (`../concave.rs`).
    pub(in crate::implicit) fn of_dents(e: f64, n: f64) -> Option<Self> {
        let with_dents = 2.0..=MOST_DENTED;
        let gauge = Self {
            p: 2.0 / e,
            q: 2.0 / n,
            over_p: 0.5 * e,
            over_q: 0.5 * n,
            turn: 0.0,
            reach: 1.0,
            least: pow2(-1000),
        };
        (with_dents.contains(&e) && with_dents.contains(&n)).then_some(gauge)
    }

    /// `1/p` and `1/q`.
    pub(in crate::implicit) fn over_exponents(&self) -> (f64, f64) {
        (self.over_p, self.over_q)
    }

    #[inline(always)]
    fn sizes(&self, x: &Vec3<F8>) -> Vec3<F8> {
        let least = F8::splat(self.least);
        Vec3::new(x.x.abs().max(least), x.y.abs().max(least), x.z.abs().max(least))
    }

    #[inline(always)]
    fn shares(&self, size: Vec3<F8>) -> Shares {
        let (most, least) = (size.x.max(size.y), size.x.min(size.y));
        let (a, b, c) = (log2(most), log2(least), log2(size.z));
        let lowest = F8::splat(LOWEST);
        let w = exp2(((b - a) * self.p).max(lowest));
        let sum = w + F8::ONE;
        let across = a + log2(sum) * self.over_p;
        let major = F8::ONE / sum;
        let minor = w * major;
        let wide = size.x.ge(size.y);
        let (high, low) = (across.max(c), across.min(c));
        let v = exp2(((low - high) * self.q).max(lowest));
        let sum = v + F8::ONE;
        let whole = high + log2(sum) * self.over_q;
        let first = F8::ONE / sum;
        let second = v * first;
        let flat = across.ge(c);
        Shares {
            across,
            whole,
            x: wide.select(major, minor),
            y: wide.select(minor, major),
            outer: flat.select(first, second),
            z: flat.select(second, first),
        }
    }

    /// The gauge at eight points.
    #[inline(never)]
    pub(in crate::implicit) fn values(&self, isa: Isa, x: &Vec3<F8>, out: &mut F8) {
        isa.run_in_lanes(
            #[inline(always)]
            || *out = exp2(self.shares(self.sizes(x)).whole),
        );
    }

    /// The gauge and its gradient at eight points.
    #[inline(never)]
    pub(in crate::implicit) fn sample(&self, isa: Isa, x: &Vec3<F8>, out: &mut Sample) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let size = self.sizes(x);
                let shares = self.shares(size);
                let value = exp2(shares.whole);
                let outer = value * shares.outer;
                out.value = value;
                out.gradient = Vec3::new(
                    (outer * shares.x / size.x).copysign(x.x),
                    (outer * shares.y / size.y).copysign(x.y),
                    (value * shares.z / size.z).copysign(x.z),
                );
            },
        );
    }

    /// The factors of the gradient's parts at eight points, without signs.
    #[inline(never)]
    pub(super) fn factors(&self, isa: Isa, x: &Vec3<F8>, out: &mut Factors) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let size = self.sizes(x);
                let shares = self.shares(size);
                let (across, value) = (exp2(shares.across), exp2(shares.whole));
                out.x = across * shares.x / size.x;
                out.y = across * shares.y / size.y;
                out.outer = value * shares.outer / across;
                out.z = value * shares.z / size.z;
            },
        );
    }
}

impl Sample {
    pub(in crate::implicit) fn new() -> Self {
        Self { value: F8::ZERO, gradient: Vec3::splat(Vec3::ZERO) }
    }
}

impl Factors {
    pub(super) fn new() -> Self {
        Self { x: F8::ZERO, y: F8::ZERO, outer: F8::ZERO, z: F8::ZERO }
    }
}
