//! Where polynomials of degree four along eight rays have their roots, with proof.
//!
//! ```text
//!   p(x) = Σ c_k x^k = Σ b_j C(4,j) x^j (1-x)^(4-j)     0 <= x <= 1
//! ```
//!
//! Signs of the `b_j` count roots (J. M. Lane, R. F. Riesenfeld, "Bounds on a polynomial", *BIT* 21, 1981; see `roots/bernstein.rs`): all of one sign, none; one change, one
//! simple root. A part of which neither can be told is shortened to its first half. A root is found by Newton's method and shut in by
//! certain signs on either side.
//!
//! **Errors.** A value is wrong by `e` at most. That includes the rounding of Taylor's shift to a part (`Σ |c_k|` does not grow by it while the part is within `[0, 1]`), of the
//! Bernstein coefficients, which are means of sums of the `c_k` with weights up to one, and of W. G. Horner's scheme: fewer than 32 roundings of numbers no larger than
//! `Σ |c_k|`, for which whoever makes a polynomial pays.

use super::rays::SLACK;
use durer_math::{F8, Isa, M8};

/// Eight polynomials.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Poly8 {
    pub(super) c: [F8; 5],
    /// Bounds on the errors: of all values, and of those at the ends.
    pub(super) e: F8,
    pub(super) e_first: F8,
    pub(super) e_last: F8,
}

/// A part of each, and what is known of it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part8 {
    /// Lanes that are to be told.
    pub(super) open: M8,
    /// The part. Before it all is told; the sign at its start is certain.
    pub(super) l: F8,
    pub(super) r: F8,
    /// The sign there: 1 or -1.
    pub(super) sign: F8,
    /// Lanes with exactly one root in the part, and certain signs at its ends.
    pub(super) one: M8,
    /// Lanes in which nothing can be told from `l` on.
    pub(super) unsure: M8,
}

/// A root of each.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Root8 {
    /// Where it is surely within `e` of `x`.
    pub(super) sure: M8,
    pub(super) x: F8,
    pub(super) e: F8,
}

/// A part that is halved more often is a doubt.
const MOST_PARTS: usize = 16;
/// Newton's steps at least before the first look whether all lanes are done, and at most.
const STEPS: (usize, usize) = (3, 24);
/// After a step as short as this the next one, which squares it, is at the end of f64. Only time depends on it: signs prove the root.
const CONVERGED: f64 = 1.0 / (1u64 << 30) as f64;

impl Poly8 {
    /// The value.
    #[inline(always)]
    fn at(&self, x: F8) -> F8 {
        let [a, b, c, d, e] = self.c;
        e.mul_add(x, d).mul_add(x, c).mul_add(x, b).mul_add(x, a)
    }

    /// Value and slope.
    #[inline(always)]
    fn value_and_slope(&self, x: F8) -> (F8, F8) {
        let [a, b, c, d, e] = self.c;
        let p = e.mul_add(x, d);
        let q = e.mul_add(x, p);
        let p2 = p.mul_add(x, c);
        let q2 = q.mul_add(x, p2);
        let p1 = p2.mul_add(x, b);
        let q1 = q2.mul_add(x, p1);
        (p1.mul_add(x, a), q1)
    }

    /// The signs at both ends: 1, -1, or 0 where it is not certain.
    #[inline(always)]
    pub(super) fn ends(&self) -> (F8, F8) {
        (certain(self.c[0], self.e_first), certain(self.at(F8::ONE), self.e_last))
    }

    /// Begins with all of the lanes in `live`.
    #[inline(always)]
    pub(super) fn begin(&self, live: M8, part: &mut Part8) {
        self.begin_with(live, F8::ZERO, part);
    }

    /// The same where the sign at the start is known for other reasons: 1 or -1, or 0 if it is not.
    #[inline(always)]
    pub(super) fn begin_with(&self, live: M8, known: F8, part: &mut Part8) {
        let sign = certain(self.c[0], self.e_first);
        part.sign = known.equals(F8::ZERO).select(sign, known);
        part.unsure = live & part.sign.equals(F8::ZERO);
        part.open = live & !part.unsure;
        (part.l, part.r) = (F8::ZERO, F8::ONE);
        part.one = M8::NONE;
    }

    /// Goes on behind the root in the part.
    #[inline(always)]
    pub(super) fn go_on(&self, part: &mut Part8) {
        part.open = part.one & part.r.lt(F8::ONE);
        part.l = part.open.select(part.r, part.l);
        part.r = part.open.select(F8::ONE, part.r);
        part.sign = part.open.select(-part.sign, part.sign);
        part.one = M8::NONE;
    }

    /// Shortens the part until it is told in each lane whether there is a root, and which part holds it.
    #[inline(never)]
    pub(super) fn isolate(&self, isa: Isa, part: &mut Part8) {
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
            let is_last = part.r.ge(F8::ONE);
            let e_last = is_last.select(self.e_last, self.e);
            let (mut seen, mut fails) = (M8::NONE, M8::NONE);
            for (j, b) in b.iter().enumerate() {
                let q = *b * part.sign;
                let e = if j == 3 { e_last } else { self.e };
                fails |= seen & !q.lt(-e);
                seen |= !q.gt(e);
            }
            let one = part.open & seen & !fails & (b[3] * part.sign).lt(-e_last);
            let none = part.open & !seen;
            part.one |= one;
            part.open &= !(one | none & is_last);
            let (l, r) = (part.l, part.r);
            let half = (l + r) * 0.5;
            let next = part.open & none;
            part.l = next.select(r, l);
            part.r = next.select(F8::ONE, part.open.select(half, r));
        }
        part.unsure |= part.open;
        part.open = M8::NONE;
    }

    /// All Bernstein coefficients on a part but the first, the value at its start.
    #[inline(always)]
    fn bernstein(&self, l: F8, r: F8) -> [F8; 4] {
        let [mut a, mut b, mut c, mut d, e] = self.c;
        // Shifted to `l`.
        d = e.mul_add(l, d);
        c = d.mul_add(l, c);
        b = c.mul_add(l, b);
        a = b.mul_add(l, a);
        d = e.mul_add(l, d);
        c = d.mul_add(l, c);
        b = c.mul_add(l, b);
        d = e.mul_add(l, d);
        c = d.mul_add(l, c);
        d = e.mul_add(l, d);
        let w = r - l;
        let w2 = w * w;
        let (b, c, d, e) = (b * w, c * w2, d * (w2 * w), e * (w2 * w2));
        let (quarter, sixth) = (F8::splat(0.25), F8::splat(1.0 / 6.0));
        let (half, three) = (F8::splat(0.5), F8::splat(0.75));
        [
            b.mul_add(quarter, a),
            c.mul_add(sixth, b.mul_add(half, a)),
            d.mul_add(quarter, c.mul_add(half, b.mul_add(three, a))),
            a + b + c + d + e,
        ]
    }

    /// The root in the part of each lane with one.
    #[inline(never)]
    pub(super) fn refine(&self, isa: Isa, part: &Part8, root: &mut Root8) {
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
            // Where it has converged the next one is an end.
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
