//! The polynomial that a piece of a lathe's profile and a ray have in common.
//!
//! The ray's points are `(o + s d) / W`. Where the ray is not horizontal it passes the height
//! `y(w)` at `s = Y / d_y`, `Y = W y(w) - o_y`. It meets the piece there if its distance from the
//! axis is `|r(w)|`:
//!
//! ```text
//!   P(w) = (d_x Y + d_y o_x)² + (d_z Y + d_y o_z)² - (W d_y r(w))² = 0
//!        = α y² + β y + γ - δ r²
//! ```
//!
//! of degree 6 at most. Where the ray is horizontal it meets the piece at the roots of
//! `o_y - W y(w)`, a cubic, before and behind its point nearest to the axis:
//!
//! ```text
//!   s = (-B ± √Δ) / A,   A = d_x² + d_z²,   B = o_x d_x + o_z d_z,
//!   Δ = A (W r(w))² - D²,                   D = o_x d_z - o_z d_x
//! ```

use super::profile::{Cubic, Piece, Profile};
use crate::RingRay;
use crate::planar::{AlongRay, Line, exact_line, with_denominator_near_one};
use durer_math::{Dd, Dyadic, EFloat, Ring, U};
use durer_roots::polynomial::Along;

/// Covers results below the normal range.
const FLOOR: f64 = durer_math::scale::pow2(-900);

/// The factors of a ray's polynomial.
#[derive(Clone)]
pub(super) struct Factors<T> {
    alpha: T,
    beta: T,
    gamma: T,
    delta: T,
}

impl<T: Ring> Factors<T> {
    #[inline(always)]
    pub(super) fn new(ray: &RingRay<T>) -> Self {
        let ([ox, oy, oz], [dx, dy, dz], w) = (ray.o.clone(), ray.d.clone(), ray.w.clone());
        let mx = dy.clone() * ox - oy.clone() * dx.clone();
        let mz = dy.clone() * oz - oy * dz.clone();
        let a = dx.clone().square() + dz.clone().square();
        Self {
            alpha: a * w.clone().square(),
            beta: ((dx * mx.clone() + dz * mz.clone()) * w.clone()).scale2(1),
            gamma: mx.square() + mz.square(),
            delta: (dy * w).square(),
        }
    }

    /// `P` at a point `[r, y]`.
    #[inline(always)]
    pub(super) fn at(&self, [r, y]: [T; 2]) -> T {
        let Self { alpha, beta, gamma, delta } = self.clone();
        (alpha * y.clone() + beta) * y + gamma - delta * r.square()
    }

    /// The coefficients of `P` for a piece of degree `(N - 1) / 2`.
    #[inline(always)]
    pub(super) fn along<const N: usize>(&self, r: &Cubic<T>, y: &Cubic<T>) -> [T; N] {
        let terms = N.div_ceil(2);
        core::array::from_fn(
            #[inline(always)]
            |k| {
                let mut sum = if k == 0 { self.gamma.clone() } else { T::exact(0.0) };
                if k < terms {
                    sum = sum + self.beta.clone() * y[k].clone();
                }
                for i in (k + 1).saturating_sub(terms)..=k.min(terms - 1) {
                    sum = sum + self.alpha.clone() * (y[i].clone() * y[k - i].clone())
                        - self.delta.clone() * (r[i].clone() * r[k - i].clone());
                }
                sum
            },
        )
    }
}

impl Factors<EFloat> {
    /// [`Factors::along`] in f64, its roundings counted for all coefficients at once.
    ///
    /// With `S` the sum of a polynomial's coefficients and `e` their errors, a coefficient of its
    /// square is wrong by `3 S e` and rounds by `5 U S²`. The sum of the four terms rounds by `U`
    /// times its terms' magnitudes four times.
    #[inline(always)]
    pub(super) fn along_piece<const N: usize>(&self, piece: &Piece) -> [EFloat; N] {
        let Self { alpha, beta, gamma, delta } = self;
        let (r, y) = (&piece.r, &piece.y);
        let (sy, sr) = (piece.y_sum, piece.r_sum);
        let (sy2, sr2) = (sy * sy, sr * sr);
        let square = |s2: f64, s: f64, e: f64| s2.mul_add(9.0 * U, 3.0 * s * e);
        let (a, b, c, d) = (alpha.magnitude(), beta.magnitude(), gamma.magnitude(), delta.magnitude());
        let own = a.mul_add(square(sy2, sy, piece.y_err), d * square(sr2, sr, piece.r_err));
        let own = b.mul_add(sy.mul_add(4.0 * U, piece.y_err), own) + c * (4.0 * U);
        let ray = alpha.e.mul_add(sy2, beta.e.mul_add(sy, delta.e.mul_add(sr2, gamma.e)));
        let e = (own + ray) * (1.0 + 64.0 * U) + FLOOR;
        let terms = N.div_ceil(2);
        let mut out = [EFloat::zero(); N];
        for k in 0..N {
            let (mut y2, mut r2) = (0.0_f64, 0.0_f64);
            for i in (k + 1).saturating_sub(terms)..=k.min(terms - 1) {
                y2 = y[i].mul_add(y[k - i], y2);
                r2 = r[i].mul_add(r[k - i], r2);
            }
            let mut v = alpha.v.mul_add(y2, -delta.v * r2);
            if k < terms {
                v = beta.v.mul_add(y[k], v);
            }
            if k == 0 {
                v += gamma.v;
            }
            out[k] = EFloat::with_error(v, e);
        }
        out
    }
}

/// The equation of a ray and a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Equation {
    /// `P(w) = 0`.
    Slanted,
    /// `o_y - W y(w) = 0`: for rays at one height, and for points.
    Level,
}

/// The coefficients of the exact equation.
pub(super) fn exact_equation(
    equation: Equation,
    profile: &Profile,
    i: usize,
    ray: &RingRay<Dyadic>,
) -> Vec<Dyadic> {
    let (r, y) = profile.powers::<Dyadic>(i);
    match equation {
        Equation::Slanted => Factors::new(ray).along::<7>(&r, &y).to_vec(),
        Equation::Level => level(ray, &y).to_vec(),
    }
}

/// `o_y - W y(w)`.
#[inline(always)]
pub(super) fn level<T: Ring>(ray: &RingRay<T>, y: &Cubic<T>) -> [T; 4] {
    let minus = |k: usize| -(ray.w.clone() * y[k].clone());
    [ray.o[1].clone() + minus(0), minus(1), minus(2), minus(3)]
}

/// One line and one piece.
pub(super) struct Meeting<'a, L> {
    pub(super) line: &'a L,
    pub(super) profile: &'a Profile,
    pub(super) piece: &'a Piece,
    pub(super) i: usize,
    /// The line's own factors, for [`Equation::Slanted`].
    pub(super) factors: Option<&'a Factors<EFloat>>,
}

impl<L: Line> Meeting<'_, L> {
    pub(super) fn equation(&self) -> Equation {
        if self.factors.is_some() { Equation::Slanted } else { Equation::Level }
    }

    /// The exact equation, and whether the line is exactly known.
    pub(super) fn exactly(&self) -> (Vec<Dyadic>, bool) {
        let (ray, certain) = exact_line(self.line);
        (exact_equation(self.equation(), self.profile, self.i, &ray), certain)
    }

    /// The value of the equation at an end of the piece.
    #[inline(always)]
    pub(super) fn at_end(&self, last: bool) -> AtEnd<'_> {
        AtEnd { equation: self.equation(), profile: self.profile, point: self.profile.end(self.i, last) }
    }
}

impl<const N: usize, L: Line> Along<N> for Meeting<'_, L> {
    #[inline(always)]
    fn double(&self) -> [EFloat; N] {
        match self.factors {
            Some(factors) => factors.along_piece(self.piece),
            None => {
                let all = level(&self.line.running(), &self.piece.running().1);
                core::array::from_fn(
                    #[inline(always)]
                    |k| all.get(k).copied().unwrap_or(EFloat::zero()),
                )
            }
        }
    }

    #[inline(always)]
    fn wide(&self) -> Option<[EFloat<Dd>; N]> {
        let ray = with_denominator_near_one(self.line.double()?);
        let (r, y) = self.profile.powers::<EFloat<Dd>>(self.i);
        Some(match self.factors {
            Some(_) => Factors::new(&ray).along(&r, &y),
            None => {
                let all = level(&ray, &y);
                core::array::from_fn(
                    #[inline(always)]
                    |k| all.get(k).copied().unwrap_or(EFloat::zero()),
                )
            }
        })
    }

    fn exact(&self) -> (Vec<Dyadic>, bool) {
        self.exactly()
    }
}

/// An equation at the end of a piece: the same number for all pieces that are joined there.
pub(super) struct AtEnd<'a> {
    equation: Equation,
    profile: &'a Profile,
    point: [f64; 2],
}

impl AlongRay for AtEnd<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let [r, y] = self.profile.point::<T>(self.point);
        Some(match self.equation {
            Equation::Slanted => Factors::new(ray).at([r, y]),
            Equation::Level => ray.o[1].clone() - ray.w.clone() * y,
        })
    }
}

/// The vertical component of a line's direction.
pub(super) struct Rise;

impl AlongRay for Rise {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(ray.d[1].clone())
    }
}
