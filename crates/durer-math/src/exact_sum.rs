//! Distillation: a few f64 are summed until the sign of their exact sum is certain.
//!
//! One pass carries a running sum through the terms and replaces each term by the rounding error
//! that it made (VecSum): the sum of all does not change, but nearly all of it gathers in one
//! number. As soon as that is larger than all the rest together, its sign is the sum's. T. Ogita,
//! S. M. Rump, S. Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26 (2005); W. Kahan,
//! "A survey of error analysis", IFIP Congress (1971). Exact barring overflow.

use crate::U;
use crate::eft::{two_prod, two_sum};
use core::cmp::Ordering;

/// The greatest number of terms.
const MOST: usize = 96;
/// After this many passes the caller uses [`Dyadic`](crate::Dyadic), which always decides but takes
/// longer. A pass removes some 50 bits of cancellation.
const PASSES: usize = 24;

/// The terms of a sum.
pub(crate) struct Terms {
    len: usize,
    terms: [f64; MOST],
}

/// The result of an exact summation.
pub(crate) struct Sum {
    /// The exact sign.
    pub(crate) sign: Ordering,
    /// The sum in f64, and a bound on its error.
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Terms {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { len: 0, terms: [0.0; MOST] }
    }

    #[inline(always)]
    fn push(&mut self, x: f64) {
        if x != 0.0 {
            self.terms[self.len] = x;
            self.len += 1;
        }
    }

    /// Adds `a b`: at most two terms. Exact if the product's least bit is at least `2^-1074`.
    #[inline(always)]
    pub(crate) fn add_product(&mut self, a: f64, b: f64) {
        let (p, e) = two_prod(a, b);
        self.push(e);
        self.push(p);
    }

    /// Adds `a b c`: at most four terms. Exact if the product's least bit is at least `2^-1074`.
    #[inline(always)]
    pub(crate) fn add_triple(&mut self, a: f64, b: f64, c: f64) {
        let (p, e) = two_prod(a, b);
        if e != 0.0 {
            self.add_product(e, c);
        }
        self.add_product(p, c);
    }

    /// The exact sum's sign and approximate value; `None` if all passes left the sign unknown.
    #[inline(always)]
    pub(crate) fn sum(mut self) -> Option<Sum> {
        let terms = &mut self.terms[..self.len];
        for _ in 0..PASSES {
            let (mut sum, mut rest) = (0.0, 0.0);
            for x in terms.iter_mut() {
                let (s, e) = two_sum(sum, *x);
                (sum, *x) = (s, e);
                rest += e.abs();
            }
            // A sum of at most 96 magnitudes errs by less than 128 u of it.
            let error = rest * (1.0 + 128.0 * U);
            if sum.abs() > error || rest == 0.0 {
                let sign = sum.partial_cmp(&0.0)?;
                return Some(Sum { sign, value: sum, error });
            }
            // The first error is that of a sum with zero: its place is free. The sum goes to the
            // end, where the next pass adds it to the rest.
            terms.rotate_left(1);
            *terms.last_mut()? = sum;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dyadic;

    /// Terms that cancel again and again, compared with exact arithmetic.
    #[test]
    fn the_sign_is_that_of_the_exact_sum() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let mut seen = [0; 3];
        for _ in 0..20_000 {
            let mut numbers = Vec::new();
            for _ in 0..next() % 20 {
                let x = next() as f64 * crate::scale::pow2((next() % 240) as i32 - 120);
                let x = if next() % 2 == 0 { x } else { -x };
                numbers.push(x);
                // Most terms meet their negative, or nearly so.
                match next() % 4 {
                    0 => numbers.push(-x.next_up()),
                    1 | 2 => numbers.insert((next() % numbers.len() as u64) as usize, -x),
                    _ => {}
                }
            }
            let mut terms = Terms::new();
            numbers.iter().for_each(|&x| terms.push(x));
            let sum = terms.sum().expect("few passes do");
            let exact = numbers.iter().fold(Dyadic::from(0.0), |sum, &x| &sum + &Dyadic::from(x));
            assert_eq!(sum.sign, exact.exact_sign(), "{numbers:?}");
            let off = (&exact - &Dyadic::from(sum.value)).abs();
            assert!(!(&off - &Dyadic::from(sum.error)).exact_sign().is_gt(), "{numbers:?}");
            seen[(sum.sign as i8 + 1) as usize] += 1;
        }
        assert!(seen.iter().all(|&n| n > 1000), "{seen:?}");
    }
}
