//! The gauge of a convex superellipsoid and its gradient at eight points, with bounds on their
//! errors.
//!
//! Everything is computed from the binary logarithms `a`, `b` of `max(|x|, |y|)`, `min(|x|, |y|)`
//! and `c` of `|z|`:
//!
//! ```text
//!   w = 2^(p (b - a)),  log N = a + log(1 + w) / p;   v = 2^(q (low - high)) of log N and c,  log G = high + log(1 + v) / q
//!
//!   d log N = (d log max + w d log min) / (1 + w), likewise for G: the gradient's parts are G times such shares, over the coordinate
//! ```
//!
//! **The value.** Logarithms have relative errors of `8 u`, powers of `4 u`, sums `1 + w` of `u`.
//! An error of the exponent `p (b - a)` enters `log N` times the share of `w`, over `p`:
//! `w |b - a| <= 0.54 / p`, so the larger the error of a small term, the smaller its weight. With
//! `1/4 <= G <= 4` the larger of two logarithms is at most 3, the error of `log N` is `125 u`
//! (`80 u` near the surface) and that of `log G` is `34 u` more: [`VALUE`] bounds the resulting
//! error of `G`. A coordinate below [`LEAST`] is replaced by it, which moves the point by less than
//! any rounding.
//!
//! **The gradient.** With `|log| <= 66` the error of each exponent is at most `p 1222 u` or
//! `q 1972 u`, that of a share `ln 2` times that: the components have relative errors of at most
//! `1024 p u + 1536 q u + 2048 u`. The dual norm of a true gradient `n` is 1, and depends on the
//! components' magnitudes only. So with relative errors of at most `ε` the dual norm is at most
//! `1 + ε`, and `G(y) >= n.y / (1 + ε)`.

use durer_formula::lane_logs::{exp2, log2};
use durer_math::scale::pow2;
use durer_math::{F8, Isa, U, Vec3, elementary};

/// Bound on the error of the gauge, relative to it, where it is from 1/4 to 4.
pub(super) const VALUE: f64 = 128.0 * U;
/// A coordinate's least size.
const LEAST: f64 = pow2(-64);
/// A bound on the error from [`LEAST`] and from one rounding of each coordinate of a point.
pub(super) const REST: f64 = 8.0 * U;
/// Lower exponents are replaced by this; their powers are negligible.
const LOWEST: f64 = -1000.0;
/// Solids with a larger exponent, and thinner spikes, are left to the tape: the bound on the
/// value's error grows with it (`../concave.rs`).
const MOST_DENTED: f64 = 8.0;
/// Solids with smaller exponents are nearly boxes, and are left to the tape.
const SHARPEST: f64 = 1.0 / 128.0;

/// The gauge of the superellipsoid with the exponents `e` and `n`, with derived constants.
#[derive(Clone, Debug)]
pub(in crate::implicit) struct Gauge {
    /// `2/e` and `2/n`, rounded, and one over those, exactly.
    p: f64,
    q: f64,
    over_p: f64,
    over_q: f64,
    /// Bound on the relative error of a gradient's component.
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

/// The gradient's components as products: `∂N/∂x ∂G/∂N`, `∂N/∂y ∂G/∂N` and `∂G/∂z`.
#[derive(Debug)]
pub(super) struct Factors {
    pub(super) x: F8,
    pub(super) y: F8,
    pub(super) outer: F8,
    pub(super) z: F8,
}

/// The logarithms of the gauge, and the shares from which its gradient follows.
struct Shares {
    /// The logarithms of `N` and of `G`.
    across: F8,
    whole: F8,
    x: F8,
    y: F8,
    /// The shares of `N` and `z` in `G`.
    outer: F8,
    z: F8,
}

impl Gauge {
    /// The gauge; `None` if the solid has dents, or edges too sharp for f64.
    pub(in crate::implicit) fn new(e: f64, n: f64) -> Option<Self> {
        if !(SHARPEST..=2.0).contains(&e) || !(SHARPEST..=2.0).contains(&n) {
            return None;
        }
        let (p, q) = (2.0 / e, 2.0 / n);
        // The binary logarithm of the largest ratio of the Euclidean norm of two numbers to their p
        // norm.
        let excess = |over: f64| (0.5 - over).max(0.0);
        let reach = elementary::exp2(excess(0.5 * e) + excess(0.5 * n)) * (1.0 + pow2(-40));
        let turn = (1024.0 * p + 1536.0 * q + 2048.0) * U;
        Some(Self { p, q, over_p: 0.5 * e, over_q: 0.5 * n, turn, reach, least: LEAST })
    }

    /// The function for exponents with which the surface has dents between all axes. It is not a
    /// norm, and has no bound on its gradient (`../concave.rs`).
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

    /// The factors of the gradient's components at eight points, without signs.
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
