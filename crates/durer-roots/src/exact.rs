//! The real roots of a polynomial with exactly known coefficients: their number, their isolating
//! intervals, and signs of other polynomials at them.
//!
//! The last step of the ladder. Multiple roots are made simple first (`residues.rs`). Then, with
//! `n` the degree,
//!
//! ```text
//!   (1 + x)^n p((l + r x) / (1 + x))
//! ```
//!
//! has a positive root for each root of `p` between `l` and `r`. Their number is at most the number
//! of sign changes of the coefficients, and differs from it by an even number (R. Descartes): no
//! change means no root, one change means one. An interval with more is divided (G. E. Collins, A.
//! G. Akritas, "Polynomial real root isolation using Descartes' rule of signs", SYMSAC 1976): this
//! ends, since the roots are simple. Roots that are very close to each other, or to the real line,
//! would take one step for each bit. As long as halving does not separate them, Newton's method for
//! a multiple root proposes a much shorter interval; if that has as many sign changes, there are no
//! roots in the rest (M. Sagraloff, K. Mehlhorn, "Computing real roots of real polynomials",
//! *Journal of Symbolic Computation* 73, 2016).
//!
//! Intervals are halved by the number of f64 numbers in them, not by length: 64 steps reach
//! neighbours at any scale.

use super::residues::{Poly, common_factor};
use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::scale::ldexp;
use durer_math::{Dyadic, Ring};

/// A polynomial, prepared for isolating its real roots.
pub struct ExactRoots {
    /// The polynomial as given.
    whole: Poly,
    /// The polynomial with the same roots, each once.
    simple: Poly,
}

/// An isolated root: the only one between `l` and `r`, which are no roots.
#[derive(Clone, Debug)]
pub struct Isolated {
    l: Dyadic,
    r: Dyadic,
    /// The sign of the polynomial before the root.
    pub before: Ordering,
    /// The sign of the polynomial after the root.
    pub after: Ordering,
    /// The sign, after the root, of the polynomial with simple roots.
    turn: Ordering,
}

impl Isolated {
    /// A number after the root and not after the next one. It is no root as long as the interval
    /// has not been narrowed.
    pub fn end(&self) -> &Dyadic {
        &self.r
    }
}

/// An interval still to examine.
struct DyadicInterval {
    l: Dyadic,
    r: Dyadic,
    /// The sign changes of the interval that it is part of.
    before: usize,
    /// The bits by which a proposal may shorten the interval.
    bits: u32,
}

fn trimmed(mut p: Poly) -> Poly {
    while p.last().is_some_and(Dyadic::is_zero) {
        p.pop();
    }
    p
}

fn derivative(p: &Poly) -> Poly {
    p.iter().enumerate().skip(1).map(|(i, a)| a * &Dyadic::from(i as f64)).collect()
}

fn value(p: &Poly, x: &Dyadic) -> Dyadic {
    p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * x) + a)
}

fn sign_at(p: &Poly, x: &Dyadic) -> Ordering {
    value(p, x).exact_sign()
}

/// A quotient, rounded; NaN or infinite where it is none.
fn ratio(a: &Dyadic, b: &Dyadic) -> f64 {
    let (Some(k), Some(l)) = (a.exponent(), b.exponent()) else { return f64::NAN };
    let near = |x: &Dyadic, e: i64| x.clone().scale2(-e as i32).to_f64();
    ldexp(near(a, k) / near(b, l), (k - l).clamp(-1100, 1100) as i32)
}

/// The number of sign changes of the coefficients of `(1 + x)^n p((l + r x) / (1 + x))`.
fn changes(p: &Poly, l: &Dyadic, r: &Dyadic) -> usize {
    // p(l + (r - l) y), by W. G. Horner's scheme.
    let (mut c, n) = (p.clone(), p.len());
    if !l.is_zero() {
        for i in 0..n {
            for j in (i..n.saturating_sub(1)).rev() {
                if !c[j + 1].is_zero() {
                    c[j] = &c[j] + &(&c[j + 1] * l);
                }
            }
        }
    }
    let width = r - l;
    let mut power = Dyadic::from(1.0);
    for c in &mut c {
        *c = &*c * &power;
        power = &power * &width;
    }
    // With y = x / (1 + x): the coefficients reversed, then x replaced by 1 + x. Each pass
    // completes one coefficient.
    c.reverse();
    let (mut last, mut found) = (Equal, 0);
    for i in 0..n {
        for j in (i..n - 1).rev() {
            c[j] = &c[j] + &c[j + 1];
        }
        let sign = c[i].exact_sign();
        if sign.is_ne() {
            found += usize::from(last.is_ne() && sign != last);
            last = sign;
        }
    }
    found
}

/// A power of two that no root exceeds in magnitude: twice the largest `|a_k / a_n|^(1 / (n - k))`
/// (M. Fujiwara, "Über die obere Schranke des absoluten Betrages der Wurzeln einer algebraischen
/// Gleichung", *Tôhoku Mathematical Journal* 10, 1916), estimated from exponents. `None` if there
/// is no root but zero.
fn reach(p: &[Dyadic]) -> Option<Dyadic> {
    let (lead, rest) = p.split_last()?;
    let top = lead.exponent()?;
    let n = rest.len() as i64;
    let ratios = rest.iter().enumerate().filter_map(|(k, a)| {
        let way = n - k as i64;
        // |a / lead| < 2^(e + 1).
        a.exponent().map(|e| (e - top + 1).div_euclid(way) + 1)
    });
    Some(Dyadic::from(1.0).scale2(i32::try_from(ratios.max()? + 1).ok()?))
}

impl ExactRoots {
    /// The roots of the polynomial with these coefficients, the constant first. `None` if it is
    /// zero everywhere.
    pub fn new(coefficients: Vec<Dyadic>) -> Option<Self> {
        let whole = trimmed(coefficients);
        if whole.is_empty() {
            return None;
        }
        let multiple = if whole.len() > 2 { common_factor(&whole, &derivative(&whole)) } else { None };
        let simple = multiple.map_or_else(|| whole.clone(), |(_, rest)| rest);
        Some(Self { whole, simple })
    }

    /// Isolates the distinct roots strictly between two numbers which are no roots, ascending.
    pub fn isolate(&self, from: &Dyadic, to: &Dyadic) -> Vec<Isolated> {
        let (mut out, mut open) = (vec![], vec![]);
        let far = reach(&self.simple).unwrap_or(Dyadic::from(1.0));
        // Zero is a simple root, if it is one. The magnitudes of the others are at least the
        // inverse of the bound on the roots of the reversed polynomial.
        let zero = usize::from(self.simple[0].is_zero());
        let near =
            reach(&self.simple[zero..].iter().rev().cloned().collect::<Poly>()).and_then(|x| x.exponent());
        let near = near.map_or_else(|| far.clone(), |e| Dyadic::from(1.0).scale2(-e as i32));
        let mut part = |l: Dyadic, r: Dyadic| {
            let (l, r) = (l.max(from.clone()), r.min(to.clone()));
            if l < r {
                open.push((l, r));
            }
        };
        part(near.clone(), far.clone());
        if zero == 1 {
            part(-near.clone(), near.clone());
        }
        part(-far, -near);
        let mut open: Vec<_> =
            open.into_iter().map(|(l, r)| DyadicInterval { l, r, before: 0, bits: 2 }).collect();
        while let Some(DyadicInterval { l, r, before, bits }) = open.pop() {
            let n = changes(&self.simple, &l, &r);
            if n < 2 {
                if n == 1 {
                    out.push(self.named(l, r));
                }
                continue;
            }
            let mut shorter = bits;
            if n == before {
                if let Some((l, r)) = self.proposed(&l, &r, n, bits) {
                    open.push(DyadicInterval { l, r, before: n, bits: (2 * bits).min(40) });
                    continue;
                }
                shorter = (bits / 2).max(2);
            }
            let part = |l, r| DyadicInterval { l, r, before: n, bits: shorter };
            let m = middle(&l, &r);
            if sign_at(&self.simple, &m).is_eq() {
                // `m` is a root itself: the only one within some distance.
                let (a, b) = self.about(&m, &l, &r);
                open.push(part(b.clone(), r));
                open.push(part(a.clone(), b));
                open.push(part(l, a));
            } else {
                open.push(part(m.clone(), r));
                open.push(part(l, m));
            }
        }
        out
    }

    /// An interval `2^bits` times shorter than that from `l` to `r` with as many sign changes, `n`,
    /// so that there are no roots in the rest; `None` if the proposal fails.
    fn proposed(&self, l: &Dyadic, r: &Dyadic, n: usize, bits: u32) -> Option<(Dyadic, Dyadic)> {
        let slope = derivative(&self.simple);
        let width = r - l;
        // The results of Newton's step for a root of multiplicity n, from either end.
        let step = |x: &Dyadic| -(n as f64) * ratio(&value(&self.simple, x), &(&value(&slope, x) * &width));
        let grid = (4_u64 << bits) as f64;
        [step(l), 1.0 + step(r)].into_iter().filter(|at| *at > 0.0 && *at < 1.0).find_map(|at| {
            let at = (at * grid).round().clamp(2.0, grid - 2.0);
            let place = |k: f64| l + &(&width * &Dyadic::from(k / grid));
            let (a, b) = (place(at - 2.0), place(at + 2.0));
            let ends = [&a, &b].iter().all(|x| sign_at(&self.simple, x).is_ne());
            (ends && changes(&self.simple, &a, &b) == n).then_some((a, b))
        })
    }

    /// The one root between `l` and `r`.
    fn named(&self, l: Dyadic, r: Dyadic) -> Isolated {
        let (before, after) = (sign_at(&self.whole, &l), sign_at(&self.whole, &r));
        let turn = sign_at(&self.simple, &r);
        Isolated { l, r, before, after, turn }
    }

    /// Numbers on either side of a root, within `l` and `r`, between which there is no other.
    fn about(&self, root: &Dyadic, l: &Dyadic, r: &Dyadic) -> (Dyadic, Dyadic) {
        let mut way = (root - l).min(r - root).scale2(-1);
        let mut less = 1;
        loop {
            let (a, b) = (root - &way, root + &way);
            let clear = sign_at(&self.simple, &a).is_ne() && sign_at(&self.simple, &b).is_ne();
            if clear && changes(&self.simple, &a, &b) == 1 {
                return (a, b);
            }
            way = way.scale2(-less);
            less *= 2;
        }
    }

    /// A number near `x` which is no root, not above it (`away` is -1) or not below it (+1).
    pub fn beside(&self, x: f64, away: f64) -> Dyadic {
        self.beside_exact(Dyadic::from(x), away)
    }

    /// [`ExactRoots::beside`] for an exact number.
    pub fn beside_exact(&self, mut at: Dyadic, away: f64) -> Dyadic {
        let mut step = Dyadic::from(away);
        if let Some(e) = at.exponent() {
            step = step.scale2((e - 60) as i32);
        } else {
            step = step.scale2(-1100);
        }
        while sign_at(&self.simple, &at).is_eq() {
            at = &at + &step;
        }
        at
    }

    /// One step: half of the interval of a root.
    fn halve(&self, root: &mut Isolated) {
        let m = middle(&root.l, &root.r);
        match sign_at(&self.simple, &m) {
            Equal => (root.l, root.r) = (m.clone(), m),
            sign if sign == root.turn => root.r = m,
            _ => root.l = m,
        }
    }

    /// Narrows a root's interval until `enough` accepts its bracket in f64, or until f64 allows no
    /// narrower one.
    pub fn bracket(&self, root: &mut Isolated, enough: impl Fn(f64, f64) -> bool) -> (f64, f64) {
        loop {
            let (lo, hi) = (root.l.to_bounds().0, root.r.to_bounds().1);
            if lo == hi || enough(lo, hi) || (lo.next_up() >= hi && lo.is_finite() && hi.is_finite()) {
                return (lo, hi);
            }
            self.halve(root);
        }
    }

    /// Narrows a root's interval until it is no wider than `width`, and returns it.
    pub fn narrowed(&self, root: &mut Isolated, width: &Dyadic) -> (Dyadic, Dyadic) {
        while &root.r - &root.l > *width {
            self.halve(root);
        }
        (root.l.clone(), root.r.clone())
    }

    /// Where a number lies relative to a root.
    pub fn compare(&self, x: &Dyadic, root: &Isolated) -> Ordering {
        if root.l == root.r {
            return x.cmp(&root.l);
        }
        if *x <= root.l {
            return Less;
        }
        if *x >= root.r {
            return Greater;
        }
        match sign_at(&self.simple, x) {
            Equal => Equal,
            sign if sign == root.turn => Greater,
            _ => Less,
        }
    }

    /// The sign of another polynomial (constant term first) at a root.
    pub fn sign_at_root(&self, q: &[Dyadic], root: &Isolated) -> Ordering {
        let q = trimmed(q.to_vec());
        let mut root = root.clone();
        if root.l == root.r {
            return sign_at(&q, &root.l);
        }
        if q.is_empty() {
            return Equal;
        }
        // The root is common if the greatest common divisor changes its sign with it: as a divisor
        // of `simple` it has only simple roots.
        if let Some((common, _)) = common_factor(&self.simple, &q)
            && sign_at(&common, &root.l) != sign_at(&common, &root.r)
        {
            return Equal;
        }
        loop {
            if root.l == root.r {
                return sign_at(&q, &root.l);
            }
            let sign = sign_at(&q, &root.l);
            if sign.is_ne() && sign == sign_at(&q, &root.r) && changes(&q, &root.l, &root.r) == 0 {
                return sign;
            }
            self.halve(&mut root);
        }
    }
}

/// A number between `l` and `r`: the middle in the order of f64 numbers while these separate the
/// two, then the mean.
fn middle(l: &Dyadic, r: &Dyadic) -> Dyadic {
    let rank = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN.wrapping_sub(bits) } else { bits }
    };
    let number = |k: i64| f64::from_bits((if k < 0 { i64::MIN.wrapping_sub(k) } else { k }) as u64);
    let clamp = |x: f64| x.clamp(f64::MIN, f64::MAX);
    let (a, b) = (rank(clamp(l.to_bounds().1)), rank(clamp(r.to_bounds().0)));
    let m = Dyadic::from(number((i128::from(a) + i128::from(b)).div_euclid(2) as i64));
    if m > *l && m < *r { m } else { (l + r).scale2(-1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The product of `(x - r)` over the roots, times `(x² + 1)^extra`.
    fn with_roots(roots: &[f64], extra: usize) -> Poly {
        let times = |p: Poly, q: [f64; 3]| {
            let mut out = vec![Dyadic::ZERO; p.len() + 2];
            for (i, a) in p.iter().enumerate() {
                for (j, &b) in q.iter().enumerate() {
                    out[i + j] = &out[i + j] + &(a * &Dyadic::from(b));
                }
            }
            out
        };
        let p = roots.iter().fold(vec![Dyadic::from(-3.0)], |p, &r| times(p, [-r, 1.0, 0.0]));
        (0..extra).fold(p, |p, _| times(p, [1.0, 0.0, 1.0]))
    }

    #[test]
    fn every_distinct_root_is_found_once_with_its_signs() {
        let near = 1.0_f64.next_up();
        let cases: [&[f64]; 10] = [
            &[],
            &[0.0],
            &[0.0, 0.0],
            &[1.0, near],
            &[1.0, 1.0, near],
            &[-2.5, -2.5, -2.5, 0.0, 7.0],
            &[1e-300, 1e300, -1e-300],
            &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0],
            &[0.5, 0.5, 0.5, 0.5, 1.5, 1.5, -1.0, -1.0, -1.0],
            &[0.0, -5e-324, -5e-324, 5e-324],
        ];
        for roots in cases {
            for extra in 0..3 {
                let exact = ExactRoots::new(with_roots(roots, extra)).unwrap();
                let mut distinct = roots.to_vec();
                distinct.sort_by(f64::total_cmp);
                distinct.dedup();
                let (lo, hi) = (Dyadic::from(f64::MIN), Dyadic::from(f64::MAX));
                let mut found = exact.isolate(&lo, &hi);
                assert_eq!(found.len(), distinct.len());
                let mut sign = if roots.len() % 2 == 0 { Less } else { Greater };
                for (root, x) in found.iter_mut().zip(&distinct) {
                    let multiplicity = roots.iter().filter(|&r| r == x).count();
                    assert_eq!(root.before, sign);
                    if multiplicity % 2 == 1 {
                        sign = sign.reverse();
                    }
                    assert_eq!(root.after, sign);
                    assert_eq!(exact.compare(&Dyadic::from(*x), root), Equal);
                    assert_eq!(exact.compare(&Dyadic::from(x.next_down()), root), Less);
                    assert_eq!(exact.compare(&Dyadic::from(x.next_up()), root), Greater);
                    assert_eq!(exact.bracket(root, |_, _| false), (*x, *x));
                }
            }
        }
    }

    /// The product of polynomials of degree two at most, and of a sum of single terms, in any
    /// numbers.
    fn product<T>(factors: &[[f64; 3]], sparse: &[(usize, f64)]) -> Vec<T>
    where
        T: Clone + From<f64> + core::ops::Add<Output = T> + core::ops::Mul<Output = T>,
    {
        let mut p = vec![T::from(0.0); sparse.iter().map(|s| s.0).max().unwrap_or(0) + 1];
        for &(k, c) in sparse {
            p[k] = p[k].clone() + T::from(c);
        }
        factors.iter().fold(p, |p, q| {
            let mut out = vec![T::from(0.0); p.len() + 2];
            for (i, a) in p.iter().enumerate() {
                for (j, &b) in q.iter().enumerate() {
                    out[i + j] = out[i + j].clone() + a.clone() * T::from(b);
                }
            }
            out
        })
    }

    #[test]
    fn roots_are_those_of_sturms_theorem() {
        use durer_testkit::{Exact, TestRng, real_roots};
        let mut met = 0;
        for seed in 0..300 {
            let mut dice = TestRng::new(seed);
            let mut factors = vec![];
            for _ in 0..seed % 6 {
                let at = dice.between(-2.0, 2.0);
                let at = if seed % 3 == 0 { (at * 16.0).round() / 16.0 } else { at };
                let near = [at, at.next_up(), at + 1e-9, -at][(dice.bits() % 4) as usize];
                factors.push(match dice.bits() % 4 {
                    0 => [-at, 1.0, 0.0],
                    // All but a double root: two real ones, or none.
                    1 => [at * at - dice.scale(-300, -20), -2.0 * at, 1.0],
                    2 => [(at * at).next_up(), -2.0 * at, 1.0],
                    _ => [at * near, -(at + near), 1.0],
                });
            }
            let mut sparse = vec![(0, 1.0)];
            if seed % 2 == 0 {
                let c = |dice: &mut TestRng| dice.between(-1.0, 1.0) * dice.scale(-200, 40);
                sparse = vec![(0, c(&mut dice)), (2, c(&mut dice)), (4 + (seed % 3) as usize, c(&mut dice))];
            }
            let witness = real_roots(&product::<Exact>(&factors, &sparse));
            let roots = ExactRoots::new(product::<Dyadic>(&factors, &sparse)).unwrap();
            let (lo, hi) = (roots.beside(f64::MIN, -1.0), roots.beside(f64::MAX, 1.0));
            let mut found = roots.isolate(&lo, &hi);
            assert_eq!(found.len(), witness.len(), "{seed}: {factors:?} {sparse:?}");
            for (root, exact) in found.iter_mut().zip(&witness) {
                assert_eq!((root.before, root.after), (exact.before, exact.after), "{seed}");
                let (lo, hi) = roots.bracket(root, |_, _| false);
                assert!(exact.cmp_exact(&lo.into()).is_ge() && exact.cmp_exact(&hi.into()).is_le(), "{seed}");
                assert!(hi <= lo.next_up());
                met += 1;
            }
        }
        assert!(met > 600, "{met}");
    }

    #[test]
    fn roots_nearer_than_any_number_can_tell_are_parted() {
        // Three roots 2^-300 apart at 1, and at 2^-40 a pair of complex ones as near to the real
        // line.
        let tiny = durer_math::scale::pow2(-600);
        let at = durer_math::scale::pow2(-40);
        let p = product::<Dyadic>(&[[0.0, 1.0, 0.0], [-tiny, 0.0, 1.0]], &[(0, 1.0)]);
        // Moved to 1 by W. G. Horner's scheme.
        let mut moved = p.clone();
        for i in 0..moved.len() {
            for j in (i..moved.len() - 1).rev() {
                moved[j] = &moved[j] - &moved[j + 1];
            }
        }
        let complex =
            [&Dyadic::from(at * at) + &Dyadic::from(tiny), Dyadic::from(-2.0 * at), Dyadic::from(1.0)];
        let mut whole = vec![Dyadic::ZERO; moved.len() + 2];
        for (i, a) in moved.iter().enumerate() {
            for (j, b) in complex.iter().enumerate() {
                whole[i + j] = &whole[i + j] + &(a * b);
            }
        }
        let roots = ExactRoots::new(whole).unwrap();
        let found = roots.isolate(&Dyadic::from(-4.0), &Dyadic::from(4.0));
        assert_eq!(found.len(), 3);
        assert_eq!(roots.compare(&Dyadic::from(1.0), &found[1]), Equal);
        assert_eq!(roots.compare(&Dyadic::from(1.0), &found[0]), Greater);
        assert_eq!(roots.compare(&Dyadic::from(1.0), &found[2]), Less);
    }

    #[test]
    fn signs_at_roots_are_exact() {
        // At √2 and -√2: x² - 2 vanishes, and so does its square times anything.
        let p = vec![Dyadic::from(-2.0), Dyadic::ZERO, Dyadic::from(1.0)];
        let exact = ExactRoots::new(p.clone()).unwrap();
        let roots = exact.isolate(&Dyadic::from(-4.0), &Dyadic::from(4.0));
        let near = core::f64::consts::SQRT_2;
        for (root, sign) in roots.iter().zip([Less, Greater]) {
            assert_eq!(exact.sign_at_root(&p, root), Equal);
            assert_eq!(exact.sign_at_root(&[Dyadic::ZERO, Dyadic::from(1.0)], root), sign);
        }
        // The f64 nearest to √2 is above it.
        let line = |c: f64| [Dyadic::from(-c), Dyadic::from(1.0)];
        assert_eq!(exact.sign_at_root(&line(near), &roots[1]), Less);
        assert_eq!(exact.sign_at_root(&line(near.next_down()), &roots[1]), Greater);
        let square =
            vec![Dyadic::from(4.0), Dyadic::ZERO, Dyadic::from(-4.0), Dyadic::ZERO, Dyadic::from(1.0)];
        assert_eq!(exact.sign_at_root(&square, &roots[0]), Equal);
    }

    #[test]
    fn the_zero_polynomial_has_no_roots_to_name() {
        assert!(ExactRoots::new(vec![Dyadic::ZERO; 4]).is_none());
        let constant = ExactRoots::new(vec![Dyadic::from(2.0), Dyadic::ZERO]).unwrap();
        assert!(constant.isolate(&Dyadic::from(-1.0), &Dyadic::from(1.0)).is_empty());
    }
}
