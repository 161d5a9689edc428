//! Zeros of two functions of two unknowns, with proof.
//!
//! ```text
//!   F(x) = 0,  x in a box X about m      K(X) = m - Y F(m) + (I - Y F'(X)) (X - m)
//! ```
//!
//! `Y` is any matrix near the inverse of `F'(m)`. Every zero in `X` is also in `K(X)`. So a box is
//! empty if `K` and `X` have no point in common; `X` holds at most one zero if the norm of
//! `I - Y F'(X)` is less than 1, and exactly one if also `K` lies inside `X` (R. Krawczyk,
//! "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", *Computing* 4 (1969)
//! 187-201; R. E. Moore, "A test for existence of solutions to nonlinear systems", *SIAM Journal on
//! Numerical Analysis* 14 (1977) 611-615; for ray tracing D. L. Toth, "On ray tracing parametric
//! surfaces", *SIGGRAPH* 1985).
//!
//! A function is known by its value and slopes at one point, with bounds on their errors, and by
//! bounds on its second derivatives in a box. The change of a slope over a box of half-width `r` is
//! then at most `(|F_uu| + |F_uv|) r`. Each bound is a sum of products of about thirty non-negative
//! numbers; [`ROUNDED`] covers their rounding.
#![expect(clippy::needless_range_loop, reason = "several arrays have the same rows and columns")]

use durer_math::U;

/// Covers the rounding of a few dozen f64 operations on bounds.
pub const ROUNDED: f64 = 1.0 + 128.0 * U;
/// The most steps of Newton's method: from a start in its basin, six give all digits.
const NEWTON: usize = 10;
/// A zero is accepted where the relative change of slopes is less than this.
const STEADY: f64 = 0.5;

/// Both functions near a point.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// The values at the point.
    pub f: [f64; 2],
    /// The slopes there: of function `i` along unknown `k`.
    pub j: [[f64; 2]; 2],
}

/// Bounds of both functions in a box, for each function.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Bounds on the errors of the values.
    pub e: [f64; 2],
    /// Bounds on the errors of the slopes.
    pub e_j: [f64; 2],
    /// Bounds on the second derivatives: along the first unknown, mixed, along the second.
    pub h: [[f64; 3]; 2],
}

/// The possible content of a box.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// No zero.
    Nothing,
    /// At most one zero; if there is one it is near this place, relative to the middle.
    AtMostOne([f64; 2]),
    /// Unknown.
    Unknown,
}

/// A proven zero.
#[derive(Clone, Copy, Debug)]
pub struct Zero {
    /// The zero, rounded.
    pub x: [f64; 2],
    /// The exact zero is within this distance of `x`, in each unknown.
    pub radius: [f64; 2],
    /// There is no other zero within this distance of `x`.
    pub alone: f64,
    /// The sign of the determinant of the slopes there.
    pub sign: i8,
}

/// An approximate inverse of the slopes.
#[inline(always)]
pub fn inverse(j: &[[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let det = j[0][0].mul_add(j[1][1], -(j[0][1] * j[1][0]));
    let by = 1.0 / det;
    let y = [[j[1][1] * by, -j[0][1] * by], [-j[1][0] * by, j[0][0] * by]];
    y.iter().flatten().all(|y| y.is_finite()).then_some(y)
}

/// `|Y| e`.
#[inline(always)]
fn sized(y: &[f64; 2], e: &[f64; 2]) -> f64 {
    y[0].abs().mul_add(e[0], y[1].abs() * e[1])
}

/// The sum of bounds on the entries of a row of `I - Y F'(m)`.
#[inline(always)]
fn residual(y: &[f64; 2], row: usize, j: &[[f64; 2]; 2], e_j: &[f64; 2]) -> f64 {
    let mut sum = 0.0;
    for k in 0..2 {
        let (a, b) = (y[0] * j[0][k], y[1] * j[1][k]);
        let one = if k == row { 1.0 } else { 0.0 };
        sum += (one - (a + b)).abs() + 4.0 * U * (one + a.abs() + b.abs());
    }
    sum + 2.0 * sized(y, e_j)
}

impl Limits {
    /// A bound on the change of a row of `Y F'` per unit of a box's half-width, summed over both
    /// unknowns.
    #[inline(always)]
    fn turning(&self, y: &[f64; 2]) -> f64 {
        let all = |h: &[f64; 3]| h[0] + 2.0 * h[1] + h[2];
        sized(y, &[all(&self.h[0]), all(&self.h[1])])
    }

    /// The content of the box of half-width `half` about the point of `at`. It is
    /// [`Content::AtMostOne`] only if that also holds for the half-width `wide`.
    #[inline(always)]
    pub fn content(&self, at: &Local, half: f64, wide: f64) -> Content {
        let mut rest = [0.0; 2];
        for i in 0..2 {
            let h = &self.h[i];
            rest[i] = (0.5 * half * half).mul_add(h[0] + 2.0 * h[1] + h[2], self.e[i]);
            let slopes = at.j[i][0].abs() + at.j[i][1].abs() + 2.0 * self.e_j[i];
            if at.f[i].abs() > half.mul_add(slopes, rest[i]) * ROUNDED {
                return Content::Nothing;
            }
        }
        let Some(y) = inverse(&at.j) else { return Content::Unknown };
        let mut x = [0.0; 2];
        let mut one = true;
        for i in 0..2 {
            let step = y[i][0].mul_add(at.f[0], y[i][1] * at.f[1]);
            let rounding = 4.0 * U * sized(&y[i], &[at.f[0].abs(), at.f[1].abs()]);
            let off = residual(&y[i], i, &at.j, &self.e_j);
            if step.abs() > (half + off.mul_add(half, sized(&y[i], &rest)) + rounding) * ROUNDED {
                return Content::Nothing;
            }
            one &= wide.mul_add(self.turning(&y[i]), off) < 1.0 / ROUNDED;
            x[i] = -step;
        }
        if one { Content::AtMostOne(x) } else { Content::Unknown }
    }

    /// The zero near `x`, found by Newton's method and proven; `None` if nothing can be proven.
    /// `region` is the box in which the limits hold, from the least to the greatest value of each
    /// unknown; `within` is the box in which the errors hold, so that the functions may be
    /// evaluated.
    #[inline(always)]
    pub fn zero(
        &self,
        mut x: [f64; 2],
        (region, within): (&[[f64; 2]; 2], &[[f64; 2]; 2]),
        mut at: impl FnMut([f64; 2]) -> Local,
    ) -> Option<Zero> {
        for _ in 0..NEWTON {
            for k in 0..2 {
                x[k] = x[k].max(within[k][0]).min(within[k][1]);
            }
            let local = at(x);
            let y = inverse(&local.j)?;
            let (mut step, mut noise) = ([0.0; 2], [0.0; 2]);
            for i in 0..2 {
                step[i] = y[i][0].mul_add(local.f[0], y[i][1] * local.f[1]);
                noise[i] = sized(&y[i], &self.e) * ROUNDED
                    + 4.0 * U * (sized(&y[i], &[local.f[0].abs(), local.f[1].abs()]) + x[i].abs());
            }
            let moved = [x[0] - step[0], x[1] - step[1]];
            if (0..2).all(|i| step[i].abs() <= 2.0 * noise[i] + U) {
                return self.proven(&local, &y, (x, moved), (step, noise), region);
            }
            // Once the rest after a step is far below the errors, another step does not help; the
            // proof covers the rest.
            let r = 4.0 * (step[0].abs() + noise[0]).max(step[1].abs() + noise[1]);
            if (0..2).all(|i| r * r * self.turning(&y[i]) <= 0.25 * noise[i])
                && let Some(zero) = self.proven(&local, &y, (x, moved), (step, noise), region)
            {
                return Some(zero);
            }
            x = moved;
        }
        None
    }

    #[inline(always)]
    fn proven(
        &self,
        local: &Local,
        y: &[[f64; 2]; 2],
        (x, moved): ([f64; 2], [f64; 2]),
        (step, noise): ([f64; 2], [f64; 2]),
        region: &[[f64; 2]; 2],
    ) -> Option<Zero> {
        let far = |i: usize| step[i].abs() + noise[i];
        let r = 4.0 * far(0).max(far(1)) + U;
        let (mut radius, mut alone) = ([0.0; 2], f64::INFINITY);
        for i in 0..2 {
            if x[i] - r < region[i][0] || x[i] + r > region[i][1] {
                return None;
            }
            let (off, turning) = (residual(&y[i], i, &local.j, &self.e_j), self.turning(&y[i]));
            let change = r.mul_add(turning, off) * ROUNDED;
            // With the step a quarter and the change a half of r, K is inside X.
            if change.is_nan() || change > STEADY {
                return None;
            }
            radius[i] = r.mul_add(change, noise[i]) * ROUNDED;
            // Also relative to the moved point.
            alone = alone.min((0.875 - off) / (turning + f64::MIN_POSITIVE) - 2.0 * r);
            alone = alone.min(x[i] - region[i][0] - r).min(region[i][1] - x[i] - r);
        }
        let det = local.j[0][0].mul_add(local.j[1][1], -(local.j[0][1] * local.j[1][0]));
        let sign = if det > 0.0 { 1 } else { -1 };
        Some(Zero { x: moved, radius, alone: alone.max(0.0), sign })
    }
}

/// The zero in the box of half-width `r` about a point, if it can be proven. `at` has the values at
/// the point, with errors of at most `e`, and slopes, with errors of at most `e_j` anywhere in the
/// box.
///
/// This form needs no second derivatives. It is for functions with bounds on slopes, such as
/// interval bounds of formulas.
#[inline(always)]
pub fn zero_in(at: &Local, (e, e_j): (&[f64; 2], &[f64; 2]), r: f64) -> Option<Zero> {
    let y = inverse(&at.j)?;
    let (mut x, mut radius) = ([0.0; 2], [0.0; 2]);
    for i in 0..2 {
        let step = y[i][0].mul_add(at.f[0], y[i][1] * at.f[1]);
        let noise = sized(&y[i], e) + 4.0 * U * sized(&y[i], &[at.f[0].abs(), at.f[1].abs()]);
        radius[i] = residual(&y[i], i, &at.j, e_j).mul_add(r, noise) * ROUNDED;
        if (step.abs() + radius[i]) * ROUNDED < r {
            x[i] = -step;
        } else {
            return None;
        }
    }
    let det = at.j[0][0].mul_add(at.j[1][1], -(at.j[0][1] * at.j[1][0]));
    Some(Zero { x, radius, alone: r, sign: if det > 0.0 { 1 } else { -1 } })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two circles of radius 1 about (-c, 0) and (c, 0): they meet in (0, +-sqrt(1 - c^2)).
    fn circles(c: f64) -> impl Fn([f64; 2]) -> Local {
        move |[u, v]| {
            let (a, b) = (u + c, u - c);
            Local {
                f: [a.mul_add(a, v.mul_add(v, -1.0)), b.mul_add(b, v.mul_add(v, -1.0))],
                j: [[2.0 * a, 2.0 * v], [2.0 * b, 2.0 * v]],
            }
        }
    }

    const ALL: [[f64; 2]; 2] = [[-2.0, 2.0]; 2];
    const LIMITS: Limits = Limits { e: [8.0 * U; 2], e_j: [8.0 * U; 2], h: [[2.0, 0.0, 2.0]; 2] };

    #[test]
    fn a_zero_is_found_and_proven() {
        let zero = LIMITS.zero([0.1, 0.9], (&ALL, &ALL), circles(0.6)).unwrap();
        assert!(zero.x[0].abs() <= zero.radius[0] && (zero.x[1] - 0.8).abs() <= zero.radius[1]);
        assert!(zero.radius[0].max(zero.radius[1]) < 64.0 * U, "{zero:?}");
        assert!(zero.alone > 0.1, "{zero:?}");
    }

    #[test]
    fn a_zero_is_proven_by_slopes_on_a_box() {
        let (at, r) = (circles(0.6)([0.0, 0.8 + 1e-6]), 1e-4);
        // The slopes change by 2 r.
        let zero = zero_in(&at, (&LIMITS.e, &[2.0 * r; 2]), r).unwrap();
        assert!(zero.x[0].abs() <= zero.radius[0] && (zero.x[1] + 1e-6).abs() <= zero.radius[1]);
        assert!(zero.radius[1] < 1e-7, "{zero:?}");
        assert!(zero_in(&circles(0.6)([0.0, 0.81]), (&LIMITS.e, &[2.0 * r; 2]), r).is_none());
        let at = circles(1.0)([0.0, 0.0]);
        assert!(zero_in(&at, (&LIMITS.e, &[2.0 * r; 2]), r).is_none());
    }

    #[test]
    fn a_double_zero_is_not_proven() {
        assert!(LIMITS.zero([0.0, 0.1], (&ALL, &ALL), circles(1.0)).is_none());
    }

    #[test]
    fn boxes_without_zeros_are_known() {
        let at = circles(0.6);
        assert!(matches!(LIMITS.content(&at([0.0, 0.25]), 0.125, 0.125), Content::Nothing));
        assert!(matches!(LIMITS.content(&at([0.05, 0.75]), 0.125, 0.125), Content::AtMostOne(_)));
        assert!(matches!(LIMITS.content(&at([0.0, 0.0]), 1.0, 1.0), Content::Unknown));
    }
}
