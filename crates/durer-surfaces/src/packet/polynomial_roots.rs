//! Certified roots of one polynomial for each of eight rays.
//!
//! ```text
//!   p(x) = Σ c_k x^k = Σ b_j C(n,j) x^j (1-x)^(n-j)     0 <= x <= 1, n = N - 1
//! ```
//!
//! The signs of the `b_j` count roots (J. M. Lane, R. F. Riesenfeld, "Bounds on a polynomial",
//! *BIT* 21, 1981; see `roots/bernstein.rs`): no sign change, no root; one sign change, one simple
//! root. A part in which neither is certain is shortened to its first half. Newton's method finds a
//! root, and certain signs on either side enclose it.
//!
//! **Errors.** A value is wrong by at most `e`. This includes the rounding of Taylor's shift to a
//! part (`Σ |c_k|` does not grow while the part is within `[0, 1]`), of the Bernstein coefficients,
//! which are sums of the `c_k` with weights up to one, and of W. G. Horner's scheme: fewer than `6
//! N + 2` successive roundings of numbers no larger than `Σ |c_k|`. The caller that makes a
//! polynomial includes them in `e`.

use super::rays::SLACK;
use durer_math::{F8, Isa, M8};

/// Eight polynomials with `N` coefficients, the constant first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Poly8<const N: usize> {
    pub(crate) c: [F8; N],
    /// Error bounds: of all values, and of the values at the ends.
    pub(crate) e: F8,
    pub(crate) e_first: F8,
    pub(crate) e_last: F8,
}

/// For each polynomial, a part of `[0, 1]` and its classification.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Part8 {
    /// Lanes whose part is not yet classified.
    pub(crate) open: M8,
    /// The part's start. Everything before it is classified, and the sign there is certain.
    pub(crate) l: F8,
    pub(crate) r: F8,
    /// The end of the range to be classified.
    pub(crate) end: F8,
    /// The sign at the part's start: 1 or -1.
    pub(crate) sign: F8,
    /// Lanes with exactly one root in the part, and certain signs at its ends.
    pub(crate) one: M8,
    /// Lanes that cannot be classified from `l` on.
    pub(crate) unsure: M8,
}

/// One root for each polynomial.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Root8 {
    /// Lanes whose root is certainly within `e` of `x`.
    pub(crate) sure: M8,
    pub(crate) x: F8,
    pub(crate) e: F8,
}

/// After this many parts the rest becomes a doubt: a single ray then costs as much as hundreds of
/// parts.
const MOST_PARTS: usize = 64;
/// After a part without a root the next part is this many times as long.
const LONGER: f64 = 2.0;
/// The least number of Newton steps before the first test for convergence, and the greatest number.
const STEPS: (usize, usize) = (1, 24);
/// After a step as short as this, the next step, whose error is its square, reaches f64's
/// precision. Only the running time depends on this number: signs prove the root.
const CONVERGED: f64 = 1.0 / (1u64 << 30) as f64;

impl<const N: usize> Default for Poly8<N> {
    fn default() -> Self {
        Self { c: [F8::ZERO; N], e: F8::ZERO, e_first: F8::ZERO, e_last: F8::ZERO }
    }
}

/// The weight of coefficient `k` of `N` in Bernstein coefficient `j`: `C(j,k) / C(n,k)`.
const fn weight<const N: usize>(j: usize, k: usize) -> f64 {
    let (mut over, mut under) = (1.0, 1.0);
    let mut i = 0;
    while i < k {
        over *= j.saturating_sub(i) as f64;
        under *= (N - 1 - i) as f64;
        i += 1;
    }
    over / under
}

/// Weights of all coefficients in all Bernstein coefficients.
struct Weights<const N: usize>;

impl<const N: usize> Weights<N> {
    const ALL: [[f64; N]; N] = {
        let mut all = [[0.0; N]; N];
        let mut j = 0;
        while j < N {
            let mut k = 0;
            while k <= j {
                all[j][k] = weight::<N>(j, k);
                k += 1;
            }
            j += 1;
        }
        all
    };
}

impl<const N: usize> Poly8<N> {
    /// The value at `x`.
    #[inline(always)]
    fn at(&self, x: F8) -> F8 {
        let mut p = self.c[N - 1];
        for k in (0..N - 1).rev() {
            p = p.mul_add(x, self.c[k]);
        }
        p
    }

    /// The value and the slope at `x`.
    #[inline(always)]
    fn value_and_slope(&self, x: F8) -> (F8, F8) {
        let (mut p, mut q) = (self.c[N - 1], F8::ZERO);
        for k in (0..N - 1).rev() {
            q = q.mul_add(x, p);
            p = p.mul_add(x, self.c[k]);
        }
        (p, q)
    }

    /// The signs at both ends: 1, -1, or 0 where the sign is uncertain.
    #[inline(always)]
    pub(crate) fn ends(&self) -> (F8, F8) {
        (certain(self.c[0], self.e_first), certain(self.at(F8::ONE), self.e_last))
    }

    /// Begins with all of `[0, 1]` for the lanes in `live`.
    #[inline(always)]
    pub(crate) fn begin(&self, live: M8, part: &mut Part8) {
        self.begin_with(live, F8::ZERO, part);
    }

    /// Begins where the sign at the start is known from elsewhere: 1 or -1, or 0 if it is unknown.
    #[inline(always)]
    pub(crate) fn begin_with(&self, live: M8, known: F8, part: &mut Part8) {
        let sign = certain(self.c[0], self.e_first);
        self.go(live, (F8::ZERO, F8::ONE), known.equals(F8::ZERO).select(sign, known), part);
    }

    /// Begins where all Bernstein coefficients are known within `e`.
    #[inline(always)]
    pub(crate) fn begin_at(&self, live: M8, b: &[F8; N], part: &mut Part8) {
        self.begin(live, part);
        self.classify(b, part);
    }

    /// Begins with the part between two places other than 0 and 1.
    #[inline(always)]
    pub(crate) fn begin_within(&self, live: M8, (l, end): (F8, F8), known: F8, part: &mut Part8) {
        let sign = certain(self.at(l), self.e);
        self.go(live, (l, end), known.equals(F8::ZERO).select(sign, known), part);
    }

    #[inline(always)]
    fn go(&self, live: M8, (l, end): (F8, F8), sign: F8, part: &mut Part8) {
        part.sign = sign;
        part.unsure = live & sign.equals(F8::ZERO);
        part.open = live & !part.unsure;
        (part.l, part.r, part.end) = (l, end, end);
        part.one = M8::NONE;
    }

    /// Continues after the root in the part.
    #[inline(always)]
    pub(crate) fn go_on(&self, part: &mut Part8) {
        part.sign.set_where(part.one, -part.sign);
        part.open = part.one & part.r.lt(part.end);
        part.l.set_where(part.open, part.r);
        part.r.set_where(part.open, part.end);
        part.one = M8::NONE;
    }

    /// Shortens the part until each lane either has one root in it or none at all.
    #[inline(never)]
    pub(crate) fn isolate(&self, isa: Isa, part: &mut Part8) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.isolate_here(part),
        );
    }

    #[inline(always)]
    fn isolate_here(&self, part: &mut Part8) {
        for _ in 0..MOST_PARTS {
            if !part.open.any() {
                return;
            }
            let b = self.bernstein(part.l, part.r);
            self.classify(&b, part);
        }
        part.unsure |= part.open;
        part.open = M8::NONE;
    }

    /// Classifies a part by its Bernstein coefficients except the first, and chooses the next part.
    #[inline(always)]
    fn classify(&self, b: &[F8; N], part: &mut Part8) {
        let is_last = part.r.ge(part.end);
        let e_last = is_last.select(self.e_last, self.e);
        let (mut seen, mut fails) = (M8::NONE, M8::NONE);
        for (j, b) in b.iter().enumerate().skip(1) {
            let q = *b * part.sign;
            let e = if j == N - 1 { e_last } else { self.e };
            fails |= seen & !q.lt(-e);
            seen |= !q.gt(e);
        }
        let one = part.open & seen & !fails & (b[N - 1] * part.sign).lt(-e_last);
        let none = part.open & !seen;
        part.one |= one;
        part.open &= !(one | none & is_last);
        let (l, r) = (part.l, part.r);
        let half = (l + r) * 0.5;
        let next = part.open & none;
        part.l.set_where(next, r);
        let longer = (r - l).mul_add(F8::splat(LONGER), r).min(part.end);
        part.r.set_where(part.open, next.select(longer, half));
    }

    /// All Bernstein coefficients on a part; the first, the value at its start, must not be used.
    #[inline(always)]
    fn bernstein(&self, l: F8, r: F8) -> [F8; N] {
        // Shifted to `l`.
        let mut a = self.c;
        for first in 0..N - 1 {
            for k in (first..N - 1).rev() {
                a[k] = a[k + 1].mul_add(l, a[k]);
            }
        }
        let w = r - l;
        let mut power = w;
        for c in &mut a[1..] {
            *c = *c * power;
            power = power * w;
        }
        let mut b = [F8::ZERO; N];
        for (j, b) in b.iter_mut().enumerate().skip(1) {
            *b = a[0];
            for (a, weight) in a.iter().zip(&Weights::<N>::ALL[j]).skip(1).take(j) {
                *b = a.mul_add(F8::splat(*weight), *b);
            }
        }
        b
    }

    /// The root in the part of each lane that has one.
    #[inline(never)]
    pub(crate) fn refine(&self, isa: Isa, part: &Part8, root: &mut Root8) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.refine_here(part, root),
        );
    }

    #[inline(always)]
    fn refine_here(&self, part: &Part8, root: &mut Root8) {
        let (mut lo, mut hi) = (part.l, part.r);
        let (first, last) = (self.at(lo), self.at(hi));
        let mut x = (hi - lo).mul_add(first / (first - last), lo);
        for i in 0..STEPS.1 {
            let (value, slope) = self.value_and_slope(x);
            let behind = (value * part.sign).lt(F8::ZERO);
            hi = behind.select(x, hi);
            lo = behind.select(lo, x);
            let next = x - value / slope;
            // After convergence the next step may land on an end.
            let fits = next.ge(lo) & next.le(hi);
            let next = fits.select(next, (lo + hi) * 0.5);
            let way = (next - x).abs();
            x = next;
            if i >= STEPS.0 && !(part.one & way.gt(F8::splat(CONVERGED))).any() {
                break;
            }
        }
        let (value, slope) = self.value_and_slope(x);
        let e = (value.abs() + self.e * 2.0) / slope.abs() * 1.25 + durer_math::scale::pow2(-51);
        let (a, b) = (x - e, x + e);
        let (at_a, at_b) = (self.at(a) * part.sign, self.at(b) * part.sign);
        let before = a.le(part.l) | at_a.gt(self.e);
        let after = b.ge(part.r) | at_b.lt(-self.e);
        root.sure = part.one & before & after;
        root.x = x;
        root.e = e * SLACK;
    }
}

/// 1 or -1 where the sign is certain, else 0.
#[inline(always)]
fn certain(x: F8, e: F8) -> F8 {
    x.gt(e).select(F8::ONE, x.lt(-e).select(F8::splat(-1.0), F8::ZERO))
}
