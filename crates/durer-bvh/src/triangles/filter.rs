//! The filter: f32 arithmetic that decides for most triangles with certainty whether a ray hits
//! them, and bounds the parameter.
//!
//! With `C = v0 - o`, edges `e1`, `e2` from `v0`, `N = e1 x e2` and `R = C x d` the ray `o + t d`
//! meets the triangle's plane at
//!
//! ```text
//!     t = T / D,  T = C . N,  D = d . N,    b1 = U / D,  U = R . e2,    b2 = V / D,  V = -R . e1,
//! ```
//!
//! and it passes through the triangle if `U`, `V` and `W = D - U - V` have one sign (T. Moeller, B.
//! Trumbore, "Fast, minimum storage ray-triangle intersection", Journal of Graphics Tools 2(1),
//! 1997, in the form with one cross product for `U` and `V`).
//!
//! # The error in f32
//!
//! Let `u = 2^-24`, all coordinates of the tree at most 1, those of `o` at most `O` and known
//! within `e`, those of `d` at most `M` and known within `g`; `c = 1 + O`; and `E` the size of the
//! block, which bounds the sum of the magnitudes of every edge from a `v0` in it. To first order,
//! per component, for the triangle as it is stored:
//!
//! ```text
//!     C    o is rounded, and so is the difference            2 u c + e         |C| <= c
//!     d    is rounded                                        u M + g           |d| <= M
//!     e1   is rounded                                        u |e1|
//!     R    three roundings, 4 u c M;
//!          C and d: 2 ((2uc + e) M + c (uM + g))             10 u c M + 2 k    |R| <= 2 c M,
//!                                                                              k = e M + c g
//!     U    three roundings, 6 u c M E;
//!          R and e2: (10 u c M + 2 k + 2 u c M) E            (18 u c M + 2 k) E
//!     N    the four products |e1_j e2_k| + ... sum to E^2 at most over all axes:
//!          two roundings and the edges: 4 u of them
//!     D    three roundings, N and d                          (8 u M + g) E^2
//!     W    D, U, V and two roundings of at most M E^2 + 2 c M E, M E^2 + 4 c M E
//!                                                            (42 u c M + 4 k) E + (10 u M + g) E^2
//! ```
//!
//! counted without fused operations, which round less. The last is the largest, so it serves for
//! `U`, `V` and `W`.
//!
//! Where f32 does not hold the corners they are within `u` of the exact ones. A volume
//! `d . (b2 x b1)` of two corners relative to `o` does not change when they move along `d`. So each
//! corner's error is multiplied by the distance of the other from the *ray*, not from `o`: at most
//! `E`, which then bounds the widths of a box around the block too, plus what rounding and the
//! boxes' tests have grown them by on three axes, less than `10 u c + 2 e`, since the ray meets the
//! block's box. That is `3 u M` times this for either, and twice as much is charged. In sum `U`,
//! `V` and `W` err by
//!
//! ```text
//!     A E + B E^2 + G,   A = 42 u c M + 4 k (+ 12 u M),
//!                        B = 10 u M + g,   G = (12 u M (10 u c + 2 e)),
//! ```
//!
//! with the terms in brackets for rounded corners. Second-order terms are below 2^-9 of the
//! first-order ones, since `e` and `g / M` are at most [`ROUGH`] (for a ray with larger errors
//! every triangle is in doubt); the factor [`PAYS`] pays for them and for the roundings of the
//! bounds themselves. Underflow loses less than 2^-145, far below `A E >= 2^-118`, as `E` is at
//! least 2^-100.
//!
//! For `t = T / D` let `|D|` be greater than `2 (8 u M + g) E^2 + 2^-100` and four times the bound
//! above. Then the exact `D` is at least half as large, and `b0`, `b1`, `b2` of a triangle that is
//! not surely missed have magnitudes that sum to at most 2. So `C = t d - b1 e1 - b2 e2` is at most
//! `|t| M + 2 E`, errs by `u O + e` and one rounding of that, and the rounding of the corners moves
//! the crossing by at most `2 u` off the plane. With `S = |e1| |e2|`, sums of magnitudes, in place
//! of `E^2` in the bounds of `T` and `D`,
//!
//! ```text
//!     |error of t| <= 2 S / |D| (8 u (|t| M + 2 E) + u O + e + (2 u) + |t| (8 u M + g))
//!                     + 4 u |t| + s,
//! ```
//!
//! where `s` separates hits whose rounded f64 parameters may be in another order than the exact
//! ones.

use super::block::LANES;
use crate::ray::{ClippedRay, Ray64};

/// Half an ulp of 1 in f32.
const U: f32 = 1.0 / (1 << 24) as f32;
/// The largest error of a ray, in tree units and relative to its direction, with which f32 is of
/// use.
pub(crate) const ROUGH: f32 = 1.0 / (1 << 10) as f32;
/// Covers second-order terms, and the roundings of bounds and of their constituents.
const PAYS: f32 = 1.0 + 1.0 / 64.0;
/// Parts of the bound of `t` that all rays share: see [`Filter::s`].
pub(crate) const NEAR: f32 = 32.0 * U * PAYS;
pub(crate) const FAR: f32 = 4.0 * U * PAYS;
/// A smaller `D` is not distinguished from zero. This is many times the loss by underflow.
pub(crate) const FLAT: f32 = 1.0 / (1_u128 << 100) as f32;

/// A ray, with the error bounds of its triangle tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Filter {
    /// Where it enters the tree's box.
    pub(crate) o: [f32; 4],
    pub(crate) d: [f32; 4],
    /// `U`, `V`, `W` err by `E (a + b E) + g` at most.
    pub(crate) a: f32,
    pub(crate) b: f32,
    pub(crate) g: f32,
    /// `D` errs by `flat E^2 / 2` at most.
    pub(crate) flat: f32,
    /// `t` errs by `S / |D| (p + q |t| + NEAR E) + FAR |t| + s` at most.
    pub(crate) p: f32,
    pub(crate) q: f32,
    pub(crate) s: f32,
    /// The least parameter that matters.
    pub(crate) t_near: f32,
    /// A crossing between these is certainly in the ray's range.
    pub(crate) first: f32,
    pub(crate) last: f32,
}

impl Filter {
    /// The filter of a ray from its entry on; `rounded` tells that f32 does not hold the corners.
    #[inline(always)]
    pub(crate) fn new(line: impl FnOnce() -> Ray64, way: &ClippedRay, rounded: bool) -> Self {
        if way.is_exact {
            Self::of_exact(way, rounded)
        } else {
            Self::known_within(&line(), way, Self::of_corners(rounded))
        }
    }

    /// The filter of a ray that is [exactly known](ClippedRay::is_exact).
    #[inline(always)]
    pub(crate) fn of_exact(way: &ClippedRay, rounded: bool) -> Self {
        Self::exact(way, Self::of_corners(rounded))
    }

    /// A bound on the distance of corners from their stored values.
    #[inline(always)]
    pub(crate) fn of_corners(rounded: bool) -> f32 {
        if rounded { U } else { 0.0 }
    }

    /// Factors for exactly known rays: of `c M` in `a`, of `M` in `b`, of `O` in `p`; `s`; and in
    /// `a` and `p` those for rounded corners.
    pub(crate) const A: f32 = 42.0 * U * PAYS;
    pub(crate) const B: f32 = 10.0 * U * PAYS;
    pub(crate) const P: f32 = 2.0 * U * PAYS;
    pub(crate) const S: f32 = 8.0 * 128.0 * U * U * PAYS;
    pub(crate) const ROUNDED_A: f32 = 12.0 * PAYS;
    pub(crate) const ROUNDED_P: f32 = 4.0 * PAYS;

    /// The formulas above with `e = g = 0`.
    #[inline(always)]
    fn exact(way: &ClippedRay, w: f32) -> Self {
        let (size, m) = (most(&way.start), most(&way.direction));
        let c = 1.0 + size;
        let b = Self::B * m;
        let (first, last) = way.inside();
        Self {
            o: way.start,
            d: way.direction,
            a: Self::A.mul_add(c, Self::ROUNDED_A * w) * m,
            b,
            g: w * c * (12.0 * b),
            flat: 2.0 * b,
            p: Self::P.mul_add(size, Self::ROUNDED_P * w),
            q: 4.0 * b,
            s: Self::S,
            t_near: way.t_near,
            first,
            last,
        }
    }

    #[inline(always)]
    fn known_within(line: &Ray64, way: &ClippedRay, w: f32) -> Self {
        let (o, d) = (way.start, way.direction);
        let (size, m) = (most(&o), most(&d));
        let g = line.direction_error.max_abs() as f32;
        // The start was rounded once more than the box tests account for, by 2^-53 of itself.
        let e = (way.error as f32).mul_add(PAYS, U * U * size);
        let c = 1.0 + size;
        // Negated, so that a NaN counts as too large.
        if !(e <= ROUGH && g <= ROUGH * m) {
            return Self::NOTHING;
        }
        let k = e.mul_add(m, c * g);
        let slope = (8.0 * U).mul_add(m, g);
        // Rounded parameters are within 32 ulp of `max(|t|, size / |d|)`; twice that, for each of
        // two.
        let s = (128.0 * U * U) * (way.entry().abs() as f32 + 8.0);
        let (first, last) = way.inner(line.inner);
        Self {
            o,
            d,
            a: (42.0 * U).mul_add(c, 12.0 * w).mul_add(m, 4.0 * k) * PAYS,
            b: (10.0 * U).mul_add(m, g) * PAYS,
            g: 12.0 * w * m * (10.0 * U).mul_add(c, 2.0 * e) * PAYS,
            flat: 2.0 * slope * PAYS,
            p: 2.0 * U.mul_add(size, 2.0_f32.mul_add(w, e)) * PAYS,
            q: 2.0 * (8.0 * U).mul_add(m, slope) * PAYS,
            s: s * PAYS,
            t_near: way.t_near,
            first,
            last,
        }
    }

    /// The filter of a ray for which f32 is of no use: every triangle is in doubt.
    pub(crate) const NOTHING: Self = Self {
        o: [0.0; 4],
        d: [0.0; 4],
        a: f32::INFINITY,
        b: 0.0,
        g: 0.0,
        flat: f32::INFINITY,
        p: 0.0,
        q: 0.0,
        s: 0.0,
        t_near: f32::NEG_INFINITY,
        first: f32::INFINITY,
        last: f32::NEG_INFINITY,
    };
}

/// The greatest magnitude of three.
#[inline(always)]
fn most(v: &[f32; 4]) -> f32 {
    let max = |a: f32, b: f32| if a > b { a } else { b };
    max(max(v[0].abs(), v[1].abs()), v[2].abs())
}

/// The filter's verdict on a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Verdict {
    /// The mask of lanes that the ray may hit within its limit: bit `i` is lane `i`.
    pub(crate) alive: u32,
    /// The mask of those lanes that it certainly hits, within its range.
    pub(crate) sure: u32,
    /// Bounds of the crossing's parameter, from the entry, of the lanes alive.
    pub(crate) lo: [f32; LANES],
    pub(crate) hi: [f32; LANES],
}

impl Verdict {
    /// A verdict that all triangles are missed.
    pub(crate) const NOTHING: Self = Self { alive: 0, sure: 0, lo: [0.0; LANES], hi: [0.0; LANES] };
}
