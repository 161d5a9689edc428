//! Expansions: exact sums of a few f64 that do not overlap, on the stack.
//!
//! J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", Discrete &
//! Computational Geometry 18 (1997) 305-363. Components are stored by increasing magnitude and zeros are dropped, so the
//! sign of the number is the sign of its last component. Exact barring overflow and underflow: callers must know that the
//! least bit of every product is at least `2^-1074` (as [`predicates`](crate::predicates) does).

use crate::eft::{fast_two_sum, two_diff, two_prod, two_sum};
use core::cmp::Ordering;

/// The exact sum of at most `N` non-overlapping f64.
///
/// ```
/// use durer_math::Expansion;
/// let x = Expansion::<2>::difference(1e20, 1e-20); // exact
/// let y = Expansion::<2>::difference(1.0, 1e-20);
/// let p: Expansion<8> = x.product(&y);
/// assert_eq!(p.sign(), core::cmp::Ordering::Greater);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Expansion<const N: usize> {
    len: usize,
    parts: [f64; N],
}

impl<const N: usize> Expansion<N> {
    /// Zero.
    pub const ZERO: Self = Self { len: 0, parts: [0.0; N] };

    #[inline(always)]
    fn push(&mut self, x: f64) {
        if x != 0.0 {
            self.parts[self.len] = x;
            self.len += 1;
        }
    }

    /// The number `x`.
    #[inline]
    pub fn new(x: f64) -> Self {
        const { assert!(N >= 1) };
        let mut out = Self::ZERO;
        out.push(x);
        out
    }

    /// `a + b` for any two f64.
    #[inline]
    pub fn sum_of(a: f64, b: f64) -> Self {
        const { assert!(N >= 2) };
        let (s, e) = two_sum(a, b);
        let mut out = Self::ZERO;
        out.push(e);
        out.push(s);
        out
    }

    /// `a - b` for any two f64.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        const { assert!(N >= 2) };
        let (s, e) = two_diff(a, b);
        let mut out = Self::ZERO;
        out.push(e);
        out.push(s);
        out
    }

    /// `a b` for any two f64.
    #[inline]
    pub fn product_of(a: f64, b: f64) -> Self {
        const { assert!(N >= 2) };
        let (p, e) = two_prod(a, b);
        let mut out = Self::ZERO;
        out.push(e);
        out.push(p);
        out
    }

    /// The parts, by increasing magnitude; none is zero.
    #[inline]
    pub fn parts(&self) -> &[f64] {
        &self.parts[..self.len]
    }

    /// The sign, exactly.
    #[inline]
    pub fn sign(&self) -> Ordering {
        match self.parts().last() {
            Some(&x) if x > 0.0 => Ordering::Greater,
            Some(_) => Ordering::Less,
            None => Ordering::Equal,
        }
    }

    /// The number in f64, and a bound on the error of that: `gamma(len)` times the sum of the parts' magnitudes.
    #[inline]
    pub fn estimate(&self) -> (f64, f64) {
        let value = self.parts().iter().sum();
        let magnitude: f64 = self.parts().iter().map(|x| x.abs()).sum();
        (value, crate::gamma(2 * N as u32) * magnitude)
    }

    /// The negative.
    #[inline]
    #[must_use]
    pub fn negated(mut self) -> Self {
        for x in &mut self.parts[..self.len] {
            *x = -*x;
        }
        self
    }

    /// This plus one f64. `K >= N + 1`.
    ///
    /// By [`Expansion::sum`], not by GROW-EXPANSION, whose result FAST-EXPANSION-SUM could not take further.
    #[inline]
    pub fn grow<const K: usize>(&self, b: f64) -> Expansion<K> {
        self.sum(&Expansion::<1>::new(b))
    }

    /// The sum (FAST-EXPANSION-SUM with zero elimination). `K >= N + M`.
    pub fn sum<const M: usize, const K: usize>(&self, other: &Expansion<M>) -> Expansion<K> {
        const { assert!(K >= N + M) };
        let mut out = Expansion::<K>::ZERO;
        let (mut a, mut b) = (self.parts(), other.parts());
        // Merge by magnitude, and carry the running sum through.
        let mut next = || -> Option<f64> {
            match (a.split_first(), b.split_first()) {
                (Some((&x, rest)), Some((&y, _))) if x.abs() <= y.abs() => {
                    a = rest;
                    Some(x)
                }
                (_, Some((&y, rest))) => {
                    b = rest;
                    Some(y)
                }
                (Some((&x, rest)), None) => {
                    a = rest;
                    Some(x)
                }
                (None, None) => None,
            }
        };
        let Some(mut q) = next() else { return out };
        while let Some(x) = next() {
            let (s, e) = two_sum(q, x);
            out.push(e);
            q = s;
        }
        out.push(q);
        out
    }

    /// The product with one f64 (SCALE-EXPANSION with zero elimination). `K >= 2 N`.
    pub fn scale<const K: usize>(&self, b: f64) -> Expansion<K> {
        const { assert!(K >= 2 * N) };
        let mut out = Expansion::<K>::ZERO;
        let Some((&first, rest)) = self.parts().split_first() else { return out };
        let (mut q, e) = two_prod(first, b);
        out.push(e);
        for &x in rest {
            let (t, t_low) = two_prod(x, b);
            let (s, e) = two_sum(q, t_low);
            out.push(e);
            let (s, e) = fast_two_sum(t, s);
            out.push(e);
            q = s;
        }
        out.push(q);
        out
    }

    /// The product. `K >= 2 N M`.
    pub fn product<const M: usize, const K: usize>(&self, other: &Expansion<M>) -> Expansion<K> {
        const { assert!(K >= 2 * N * M) };
        // Grown part by part, in place of Shewchuk's balanced tree: N and M are small here. Growing from zero keeps the
        // parts non-adjacent, so the result may enter FAST-EXPANSION-SUM.
        let mut out = Expansion::<K>::ZERO;
        for &y in other.parts() {
            for &x in self.parts() {
                let (p, e) = two_prod(x, y);
                out = out.plus(e).plus(p);
            }
        }
        out
    }

    /// GROW-EXPANSION into the same capacity, which the caller knows to suffice.
    #[inline]
    fn plus(&self, b: f64) -> Self {
        let mut out = Self::ZERO;
        let mut q = b;
        for &x in self.parts() {
            let (s, e) = two_sum(q, x);
            out.push(e);
            q = s;
        }
        out.push(q);
        out
    }
}
