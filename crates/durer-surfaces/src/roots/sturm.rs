//! The real roots of a polynomial whose coefficients are exactly known: how many there are, where, and on which side of what.
//!
//! The last step of the ladder. A chain of remainders (J. C. F. Sturm, "Mémoire sur la résolution des équations numériques", 1835) is formed without
//! fractions: each pseudo-remainder is divided by the factor that J. F. Traub and W. S. Brown's subresultants have in common (D. E.
//! Knuth, *The Art of Computer Programming*, vol. 2, section 4.6.1, algorithm C), in absolute value, so that signs stay those of Sturm's
//! chain. Its last member is the greatest common divisor of the polynomial and its derivative; without it all roots are simple.
//!
//! Intervals are halved in the order of the f64 numbers, not in their values: 64 steps reach neighbours at any scale.

use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::{Dyadic, Ring};

/// Constant term first; the last one is not zero. Zero is empty.
type Poly = Vec<Dyadic>;

/// A polynomial and what is known of its real roots.
pub(crate) struct Sturm {
    /// As it was given.
    whole: Poly,
    /// The same roots, each once.
    simple: Poly,
    chain: Vec<Poly>,
}

/// One root by itself: the only one between `l` and `r`, which are no roots.
#[derive(Clone, Debug)]
pub(crate) struct Isolated {
    l: Dyadic,
    r: Dyadic,
    /// The sign of the polynomial before and after.
    pub(crate) before: Ordering,
    pub(crate) after: Ordering,
    /// The sign, after the root, of the polynomial that has it once.
    turn: Ordering,
}

fn trimmed(mut p: Poly) -> Poly {
    while p.last().is_some_and(Dyadic::is_zero) {
        p.pop();
    }
    p
}

fn whole_number(n: usize) -> Dyadic {
    Dyadic::from(n as f64)
}

fn derivative(p: &Poly) -> Poly {
    p.iter().enumerate().skip(1).map(|(i, a)| a * &whole_number(i)).collect()
}

fn value(p: &Poly, x: &Dyadic) -> Dyadic {
    p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * x) + a)
}

fn sign_at(p: &Poly, x: &Dyadic) -> Ordering {
    value(p, x).exact_sign()
}

/// `quotient` and `remainder` with `|lead b|^(deg a - deg b + 1) a = quotient b + remainder`, for `deg a >= deg b`.
fn pseudo_division(a: &Poly, b: &Poly) -> (Poly, Poly) {
    let Some((lead, rest)) = b.split_last() else { return (vec![], a.clone()) };
    let steps = (a.len() + 1).saturating_sub(b.len());
    let (mut remainder, mut quotient) = (a.clone(), vec![Dyadic::ZERO; steps]);
    let size = lead.clone().abs();
    let negative = lead.exact_sign().is_lt();
    for step in (0..steps).rev() {
        let top = remainder.pop().unwrap_or(Dyadic::ZERO);
        let factor = if negative { -top } else { top };
        for x in remainder.iter_mut().chain(&mut quotient) {
            *x = &*x * &size;
        }
        for (i, x) in rest.iter().enumerate() {
            remainder[step + i] = &remainder[step + i] - &(x * &factor);
        }
        quotient[step] = &quotient[step] + &factor;
    }
    (trimmed(quotient), trimmed(remainder))
}

fn power(x: &Dyadic, n: usize) -> Dyadic {
    (0..n).fold(Dyadic::from(1.0), |p, _| &p * x)
}

/// Sturm's chain of `p`, each member times a positive number.
fn sturm_chain(p: &Poly) -> Vec<Poly> {
    let mut chain = vec![p.clone(), derivative(p)];
    let (mut g, mut h) = (Dyadic::from(1.0), Dyadic::from(1.0));
    loop {
        let [.., a, b] = chain.as_slice() else { return chain };
        if b.len() < 2 {
            break;
        }
        let delta = a.len() - b.len();
        let (_, remainder) = pseudo_division(a, b);
        if remainder.is_empty() {
            break;
        }
        let divisor = &g * &power(&h, delta);
        // Divisible by theory; were it not, the undivided remainder would serve as well.
        let divided: Option<Poly> = remainder.iter().map(|x| x.exact_quotient(&divisor)).collect();
        let next: Poly = divided.unwrap_or(remainder).into_iter().map(|x| -x).collect();
        g = b.last().cloned().unwrap_or(Dyadic::ZERO).abs();
        h = match delta {
            0 => h,
            1 => g.clone(),
            _ => power(&g, delta).exact_quotient(&power(&h, delta - 1)).unwrap_or(h),
        };
        chain.push(next);
    }
    chain.retain(|p| !p.is_empty());
    chain
}

impl Sturm {
    /// The roots of the polynomial with these coefficients, the constant first. `None` if it is zero everywhere.
    pub(crate) fn new(coefficients: Vec<Dyadic>) -> Option<Self> {
        let whole = trimmed(coefficients);
        if whole.is_empty() {
            return None;
        }
        let mut chain = sturm_chain(&whole);
        let mut simple = whole.clone();
        if let Some(common) = chain.last().filter(|p| p.len() > 1) {
            simple = pseudo_division(&whole, common).0;
            chain = sturm_chain(&simple);
        }
        Some(Self { whole, simple, chain })
    }

    /// How often the chain's sign changes at `x`.
    fn changes(&self, x: &Dyadic) -> usize {
        let (mut last, mut n) = (Equal, 0);
        for sign in self.chain.iter().map(|p| sign_at(p, x)).filter(|s| s.is_ne()) {
            n += usize::from(last.is_ne() && sign != last);
            last = sign;
        }
        n
    }

    /// The distinct roots strictly between two numbers which are no roots, ascending, each by itself.
    pub(crate) fn isolate(&self, from: &Dyadic, to: &Dyadic) -> Vec<Isolated> {
        let mut out = vec![];
        if from >= to {
            return out;
        }
        let mut open = vec![(from.clone(), to.clone(), self.changes(from), self.changes(to))];
        while let Some((l, r, at_l, at_r)) = open.pop() {
            match at_l.saturating_sub(at_r) {
                0 => {}
                1 => out.push(self.named(l, r)),
                _ => {
                    let m = middle(&l, &r);
                    if sign_at(&self.simple, &m).is_eq() {
                        // A root itself: alone within some distance.
                        let (a, b, at_a, at_b) = self.about(&m, &l, &r);
                        open.push((b.clone(), r, at_b, at_r));
                        open.push((a.clone(), b, at_a, at_b));
                        open.push((l, a, at_l, at_a));
                    } else {
                        let at_m = self.changes(&m);
                        open.push((m.clone(), r, at_m, at_r));
                        open.push((l, m, at_l, at_m));
                    }
                }
            }
        }
        out
    }

    /// The one root between `l` and `r`.
    fn named(&self, l: Dyadic, r: Dyadic) -> Isolated {
        let (before, after) = (sign_at(&self.whole, &l), sign_at(&self.whole, &r));
        let turn = sign_at(&self.simple, &r);
        Isolated { l, r, before, after, turn }
    }

    /// Numbers on either side of a root, within `l` and `r`, between which there is no other, and how often the chain changes there.
    fn about(&self, root: &Dyadic, l: &Dyadic, r: &Dyadic) -> (Dyadic, Dyadic, usize, usize) {
        let mut way = (root - l).min(r - root).scale2(-1);
        let mut less = 1;
        loop {
            let (a, b) = (root - &way, root + &way);
            let (at_a, at_b) = (self.changes(&a), self.changes(&b));
            let clear = sign_at(&self.simple, &a).is_ne() && sign_at(&self.simple, &b).is_ne();
            if clear && at_a == at_b + 1 {
                return (a, b, at_a, at_b);
            }
            way = way.scale2(-less);
            less *= 2;
        }
    }

    /// A number near `x` which is no root, not above it (`away` is -1) or not below it (+1).
    pub(crate) fn beside(&self, x: f64, away: f64) -> Dyadic {
        self.beside_exact(Dyadic::from(x), away)
    }

    /// The same for an exact number.
    pub(crate) fn beside_exact(&self, mut at: Dyadic, away: f64) -> Dyadic {
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

    /// Narrows a root's interval until `enough` says so of its bracket in f64, or until f64 can do no better.
    pub(crate) fn bracket(&self, root: &mut Isolated, enough: impl Fn(f64, f64) -> bool) -> (f64, f64) {
        loop {
            let (lo, hi) = (root.l.to_bounds().0, root.r.to_bounds().1);
            if lo == hi || enough(lo, hi) || (lo.next_up() >= hi && lo.is_finite() && hi.is_finite()) {
                return (lo, hi);
            }
            self.halve(root);
        }
    }

    /// Narrows a root's interval until it is no wider than `width`, and shows it.
    pub(crate) fn narrowed(&self, root: &mut Isolated, width: &Dyadic) -> (Dyadic, Dyadic) {
        while &root.r - &root.l > *width {
            self.halve(root);
        }
        (root.l.clone(), root.r.clone())
    }

    /// Where a number lies relative to a root.
    pub(crate) fn compare(&self, x: &Dyadic, root: &Isolated) -> Ordering {
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
    pub(crate) fn sign_at_root(&self, q: &[Dyadic], root: &Isolated) -> Ordering {
        let q = trimmed(q.to_vec());
        let mut root = root.clone();
        if root.l == root.r {
            return sign_at(&q, &root.l);
        }
        if q.is_empty() {
            return Equal;
        }
        // The root is common if the greatest common divisor changes its sign with it: as a divisor of `simple` it has only simple roots.
        let common = common_divisor(&self.simple, &q);
        if common.len() > 1 && sign_at(&common, &root.l) != sign_at(&common, &root.r) {
            return Equal;
        }
        let Some(other) = Self::new(q.clone()) else { return Equal };
        loop {
            if root.l == root.r {
                return sign_at(&q, &root.l);
            }
            let (l, r) = (sign_at(&q, &root.l), sign_at(&q, &root.r));
            if l.is_ne() && l == r && other.changes(&root.l) == other.changes(&root.r) {
                return l;
            }
            self.halve(&mut root);
        }
    }
}

/// The greatest common divisor, times a number.
fn common_divisor(a: &Poly, b: &Poly) -> Poly {
    let (mut a, mut b) = if a.len() >= b.len() { (a.clone(), b.clone()) } else { (b.clone(), a.clone()) };
    let (mut g, mut h) = (Dyadic::from(1.0), Dyadic::from(1.0));
    while b.len() > 1 {
        let delta = a.len() - b.len();
        let (_, remainder) = pseudo_division(&a, &b);
        if remainder.is_empty() {
            return b;
        }
        let divisor = &g * &power(&h, delta);
        let divided: Option<Poly> = remainder.iter().map(|x| x.exact_quotient(&divisor)).collect();
        g = b.last().cloned().unwrap_or(Dyadic::ZERO).abs();
        h = match delta {
            0 => h,
            1 => g.clone(),
            _ => power(&g, delta).exact_quotient(&power(&h, delta - 1)).unwrap_or(h),
        };
        (a, b) = (b, divided.unwrap_or(remainder));
    }
    b
}

/// A number between `l` and `r`: half way in the order of the f64 numbers while they can tell the two apart, in value after that.
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
                let sturm = Sturm::new(with_roots(roots, extra)).unwrap();
                let mut distinct = roots.to_vec();
                distinct.sort_by(f64::total_cmp);
                distinct.dedup();
                let (lo, hi) = (Dyadic::from(f64::MIN), Dyadic::from(f64::MAX));
                let mut found = sturm.isolate(&lo, &hi);
                assert_eq!(found.len(), distinct.len());
                let mut sign = if roots.len() % 2 == 0 { Less } else { Greater };
                for (root, x) in found.iter_mut().zip(&distinct) {
                    let multiplicity = roots.iter().filter(|&r| r == x).count();
                    assert_eq!(root.before, sign);
                    if multiplicity % 2 == 1 {
                        sign = sign.reverse();
                    }
                    assert_eq!(root.after, sign);
                    assert_eq!(sturm.compare(&Dyadic::from(*x), root), Equal);
                    assert_eq!(sturm.compare(&Dyadic::from(x.next_down()), root), Less);
                    assert_eq!(sturm.compare(&Dyadic::from(x.next_up()), root), Greater);
                    assert_eq!(sturm.bracket(root, |_, _| false), (*x, *x));
                }
            }
        }
    }

    #[test]
    fn signs_at_roots_are_exact() {
        // At √2 and -√2: x² - 2 vanishes, and so does its square times anything.
        let p = vec![Dyadic::from(-2.0), Dyadic::ZERO, Dyadic::from(1.0)];
        let sturm = Sturm::new(p.clone()).unwrap();
        let roots = sturm.isolate(&Dyadic::from(-4.0), &Dyadic::from(4.0));
        let near = core::f64::consts::SQRT_2;
        for (root, sign) in roots.iter().zip([Less, Greater]) {
            assert_eq!(sturm.sign_at_root(&p, root), Equal);
            assert_eq!(sturm.sign_at_root(&[Dyadic::ZERO, Dyadic::from(1.0)], root), sign);
        }
        // The f64 nearest to √2 is above it.
        let line = |c: f64| [Dyadic::from(-c), Dyadic::from(1.0)];
        assert_eq!(sturm.sign_at_root(&line(near), &roots[1]), Less);
        assert_eq!(sturm.sign_at_root(&line(near.next_down()), &roots[1]), Greater);
        let square =
            vec![Dyadic::from(4.0), Dyadic::ZERO, Dyadic::from(-4.0), Dyadic::ZERO, Dyadic::from(1.0)];
        assert_eq!(sturm.sign_at_root(&square, &roots[0]), Equal);
    }

    #[test]
    fn the_zero_polynomial_has_no_roots_to_name() {
        assert!(Sturm::new(vec![Dyadic::ZERO; 4]).is_none());
        let constant = Sturm::new(vec![Dyadic::from(2.0), Dyadic::ZERO]).unwrap();
        assert!(constant.isolate(&Dyadic::from(-1.0), &Dyadic::from(1.0)).is_empty());
    }
}
