//! Greatest common divisors of polynomials with exact coefficients, computed modulo primes.
//!
//! Modulo a prime that does not divide the leading coefficient a common divisor stays a common
//! divisor, of the same degree. So if the greatest one modulo one such prime is a constant, it is
//! one exactly: that proves most polynomials free of multiple roots in a few microseconds, whatever
//! the size of their coefficients. Otherwise the divisor is combined from its remainders modulo
//! many primes (Chinese remainder theorem) and then verified by exact division, so the result does
//! not depend on chance (W. S. Brown, "On Euclid's algorithm and the computation of polynomial
//! greatest common divisors", *Journal of the ACM* 18, 1971).

use durer_math::{Dyadic, Ring};
use std::sync::{Mutex, PoisonError};

/// Constant term first; the last one is not zero. Zero is empty.
pub(super) type Poly = Vec<Dyadic>;

/// The first prime: M. Mersenne's ninth.
const FIRST: u64 = (1 << 61) - 1;

/// The primes below the first one that have been found so far.
static PRIMES: Mutex<Vec<u64>> = Mutex::new(Vec::new());

/// The primes up to the first one, descending.
fn primes() -> impl Iterator<Item = u64> {
    (0..).map(|i| {
        let mut known = PRIMES.lock().unwrap_or_else(PoisonError::into_inner);
        while known.len() <= i {
            let mut next = known.last().map_or(FIRST, |last| last - 2);
            while !is_prime(next) {
                next -= 2;
            }
            known.push(next);
        }
        known[i]
    })
}

fn product(a: u64, b: u64, p: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(p)) as u64
}

fn difference(a: u64, b: u64, p: u64) -> u64 {
    if a >= b { a - b } else { a + (p - b) }
}

fn power(mut a: u64, mut n: u64, p: u64) -> u64 {
    let mut out = 1;
    while n > 0 {
        if n & 1 == 1 {
            out = product(out, a, p);
        }
        a = product(a, a, p);
        n >>= 1;
    }
    out
}

/// The inverse of `a` modulo `p`, by P. de Fermat's theorem; `p` is prime and `a` not a multiple of
/// it.
fn inverse(a: u64, p: u64) -> u64 {
    power(a, p - 2, p)
}

/// Whether an odd number above 37 is a prime (G. L. Miller's test with the first twelve primes,
/// which suffice for 64 bits: J. Sorenson, J. Webster, "Strong pseudoprimes to twelve prime bases", *Mathematics
/// of Computation* 86, 2017).
fn is_prime(n: u64) -> bool {
    let twos = (n - 1).trailing_zeros();
    [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37].into_iter().all(|base| {
        let mut x = power(base, (n - 1) >> twos, n);
        x == 1
            || (0..twos).any(|_| {
                let found = x == n - 1;
                x = product(x, x, n);
                found
            })
    })
}

/// The remainders of the coefficients; the last one is not zero.
fn reduced(p: &[Dyadic], prime: u64) -> Vec<u64> {
    trimmed(p.iter().map(|a| a.residue(prime)).collect())
}

fn trimmed(mut p: Vec<u64>) -> Vec<u64> {
    while p.last() == Some(&0) {
        p.pop();
    }
    p
}

/// The greatest common divisor modulo a prime, with leading coefficient 1; empty if both are zero.
fn common_modulo(mut a: Vec<u64>, mut b: Vec<u64>, prime: u64) -> Vec<u64> {
    while let Some((&lead, rest)) = b.split_last() {
        let unit = inverse(lead, prime);
        while a.len() >= b.len() {
            let Some(top) = a.pop() else { break };
            let factor = product(top, unit, prime);
            let at = a.len() - rest.len();
            for (x, y) in a[at..].iter_mut().zip(rest) {
                *x = difference(*x, product(factor, *y, prime), prime);
            }
            a = trimmed(a);
        }
        core::mem::swap(&mut a, &mut b);
    }
    let unit = a.last().map_or(1, |&lead| inverse(lead, prime));
    a.into_iter().map(|x| product(x, unit, prime)).collect()
}

/// Converts an integer of at most 62 bits.
fn whole(x: u64) -> Dyadic {
    let (hi, lo) = ((x >> 32) as f64, (x & u64::from(u32::MAX)) as f64);
    Dyadic::from(hi).scale2(32) + Dyadic::from(lo)
}

/// `factor p / q`, if that is a polynomial whose coefficients are integers times powers of two.
fn exact_quotient(p: &[Dyadic], factor: &Dyadic, q: &[Dyadic]) -> Option<Poly> {
    let (lead, rest) = q.split_last()?;
    let mut left: Poly = p.iter().map(|a| a * factor).collect();
    let steps = (left.len() + 1).checked_sub(q.len())?;
    let mut quotient = vec![Dyadic::ZERO; steps];
    for step in (0..steps).rev() {
        let top = left.pop()?;
        if top.is_zero() {
            continue;
        }
        let digit = top.exact_quotient(lead)?;
        for (x, y) in left[step..].iter_mut().zip(rest) {
            *x = &*x - &(y * &digit);
        }
        quotient[step] = digit;
    }
    left.iter().all(Dyadic::is_zero).then_some(quotient)
}

/// The greatest common divisor of two polynomials, and the first one divided by it, each up to a
/// constant factor; `None` if the divisor is a constant. Neither polynomial is zero everywhere.
pub(super) fn common_factor(a: &[Dyadic], b: &[Dyadic]) -> Option<(Poly, Poly)> {
    // With integer coefficients, the divisor scaled to the leading coefficient of `a` has integer
    // coefficients (C. F. Gauss).
    let lowest = a.iter().filter_map(Dyadic::lowest_bit).min()?;
    let lead = a.last()?.clone().scale2(i32::try_from(-lowest).ok()?);
    let mut found: Poly = vec![];
    let mut modulus = Dyadic::from(1.0);
    for prime in primes() {
        let factor = lead.residue(prime);
        if factor == 0 {
            continue;
        }
        let image = common_modulo(reduced(a, prime), reduced(b, prime), prime);
        if image.len() == 1 {
            return None;
        }
        if !found.is_empty() && image.len() > found.len() {
            continue;
        }
        if image.len() != found.len() {
            // All primes before this were unlucky.
            (found, modulus) = (vec![Dyadic::ZERO; image.len()], Dyadic::from(1.0));
        }
        let unit = inverse(modulus.residue(prime), prime);
        let mut settled = true;
        for (x, &image) in found.iter_mut().zip(&image) {
            let wanted = product(image, factor, prime);
            let digit = product(difference(wanted, x.residue(prime), prime), unit, prime);
            if digit != 0 {
                settled = false;
                let digit = if digit > prime / 2 { -whole(prime - digit) } else { whole(digit) };
                *x = &*x + &(&modulus * &digit);
            }
        }
        modulus = &modulus * &whole(prime);
        if settled
            && let Some(rest) = exact_quotient(a, &lead, &found)
            && exact_quotient(b, &lead, &found).is_some()
        {
            return Some((found, rest));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_testkit::TestRng;

    fn times(p: &[Dyadic], q: &[Dyadic]) -> Poly {
        let mut out = vec![Dyadic::ZERO; p.len() + q.len() - 1];
        for (i, a) in p.iter().enumerate() {
            for (j, b) in q.iter().enumerate() {
                out[i + j] = &out[i + j] + &(a * b);
            }
        }
        out
    }

    fn random(dice: &mut TestRng, degree: usize) -> Poly {
        (0..=degree).map(|_| Dyadic::from(dice.between(-1.0, 1.0) * dice.scale(-60, 60))).collect()
    }

    #[test]
    fn the_greatest_common_divisor_is_what_was_put_in() {
        for seed in 0..60 {
            let mut dice = TestRng::new(seed);
            let (a, b) = (random(&mut dice, 5), random(&mut dice, 4));
            assert!(common_factor(&a, &b).is_none());
            let mut common = vec![Dyadic::from(1.0)];
            for _ in 0..1 + seed % 5 {
                let factor = random(&mut dice, 1 + (seed % 2) as usize);
                common = times(&common, &factor);
            }
            let (p, q) = (times(&a, &common), times(&b, &common));
            let (found, rest) = common_factor(&p, &q).unwrap();
            assert_eq!(found.len(), common.len());
            for (x, y) in [(&found, &common), (&rest, &a)] {
                // The same but for a number.
                let (k, l) = (x.last().unwrap(), y.last().unwrap());
                assert!(x.iter().zip(y).all(|(x, y)| x * l == y * k));
            }
        }
    }

    #[test]
    fn primes_are_primes_and_fall() {
        let first: Vec<u64> = primes().take(20).collect();
        assert_eq!(first[0], FIRST);
        assert!(first.windows(2).all(|w| w[1] < w[0]));
        // 2^61 - 31 is the next one below.
        assert_eq!(first[1], FIRST - 30);
        assert!(!is_prime(3_215_031_751) && !is_prime(341_550_071_728_321) && is_prime(1_000_000_007));
    }
}
