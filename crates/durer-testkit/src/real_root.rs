//! The oracle for polynomials of any degree: exact real roots by Sturm's theorem on integers, and
//! surfaces that are the zero set of one polynomial.

use super::exact::{Crossing, Exact, ExactLine, Oracle};
use core::cmp::Ordering;
use dashu::base::{Gcd, Signed};
use dashu::integer::IBig;
use durer_math::Vec3;
use std::sync::Arc;

/// A polynomial with integer coefficients: constant term first, the last one not zero.
type Whole = Vec<IBig>;

fn trimmed(mut p: Whole) -> Whole {
    while p.last().is_some_and(IBig::is_zero) {
        p.pop();
    }
    p
}

/// Divides by the greatest common factor of the coefficients, which is taken as positive.
fn primitive(p: Whole) -> Whole {
    let p = trimmed(p);
    let mut common = IBig::ZERO;
    for x in &p {
        if !x.is_zero() {
            common = if common.is_zero() { x.clone() } else { IBig::from(common.gcd(x.clone())) };
        }
    }
    let common = if common.is_negative() { -common } else { common };
    if common.is_zero() { p } else { p.into_iter().map(|x| x / &common).collect() }
}

/// The remainder of `a` divided by `b`, times a positive number.
fn remainder(a: &Whole, b: &Whole) -> Whole {
    let (mut a, lead) = (a.clone(), b[b.len() - 1].clone());
    while a.len() >= b.len() {
        let top = a[a.len() - 1].clone();
        let shift = a.len() - b.len();
        let (size, top) = if lead.is_negative() { (-lead.clone(), -top) } else { (lead.clone(), top) };
        for x in &mut a {
            *x *= &size;
        }
        for (i, x) in b.iter().enumerate() {
            a[shift + i] -= x * &top;
        }
        a.pop();
        a = trimmed(a);
    }
    primitive(a)
}

fn derivative(p: &Whole) -> Whole {
    trimmed(p.iter().enumerate().skip(1).map(|(i, x)| x * IBig::from(i)).collect())
}

fn chain(p: &Whole) -> Vec<Whole> {
    let mut chain = vec![p.clone(), primitive(derivative(p))];
    while let [.., a, b] = chain.as_slice() {
        if b.len() < 2 {
            break;
        }
        let next: Whole = remainder(a, b).into_iter().map(|x| -x).collect();
        if next.is_empty() {
            break;
        }
        chain.push(next);
    }
    chain.retain(|p| !p.is_empty());
    chain
}

/// The exact quotient of `p` and one of its divisors, times a number.
fn quotient(p: &Whole, d: &Whole) -> Whole {
    let (mut p, lead) = (p.clone(), d[d.len() - 1].clone());
    let mut out = vec![];
    while p.len() >= d.len() {
        let top = p[p.len() - 1].clone();
        let shift = p.len() - d.len();
        for x in p.iter_mut().chain(&mut out) {
            *x *= &lead;
        }
        for (i, x) in d.iter().enumerate() {
            p[shift + i] -= x * &top;
        }
        out.push(top);
        p.pop();
    }
    out.reverse();
    primitive(out)
}

fn sign_at(p: &Whole, x: &Exact) -> Ordering {
    // Σ c_k m^k 2^(e k), times a power of two that makes all terms integers.
    let zero = IBig::ZERO;
    let mut sum = zero.clone();
    for (i, c) in p.iter().rev().enumerate() {
        let shifted = if x.e < 0 { c << (i * x.e.unsigned_abs() as usize) } else { c.clone() };
        let factor = if x.e < 0 { x.m.clone() } else { &x.m << x.e as usize };
        sum = sum * factor + shifted;
    }
    sum.cmp(&zero)
}

/// The greatest common divisor of two polynomials, neither of them zero.
fn common_divisor(a: &Whole, b: &Whole) -> Whole {
    let (mut a, mut b) = if a.len() >= b.len() { (a.clone(), b.clone()) } else { (b.clone(), a.clone()) };
    while !b.is_empty() {
        (a, b) = (b.clone(), remainder(&a, &b));
    }
    a
}

/// Integers in the ratios of the coefficients.
fn whole_numbers(coefficients: &[Exact]) -> Whole {
    let least = coefficients.iter().filter(|c| c.sign().is_ne()).map(|c| c.e).min().unwrap_or(0);
    primitive(coefficients.iter().map(|c| &c.m << (c.e - least).max(0) as usize).collect())
}

fn bits(x: &IBig) -> i64 {
    dashu::base::BitTest::bit_len(x) as i64
}

/// A real root of a polynomial.
///
/// Internally the unknown is `t / 2^scale`: the polynomial's roots are then about one, whatever the
/// unit of `t` is.
#[derive(Clone, Debug)]
pub struct RealRoot {
    /// A polynomial in which the root is simple.
    simple: Arc<Whole>,
    /// The root is between `l` and `r`; `simple` is not zero at `r` unless the two are equal.
    l: Exact,
    r: Exact,
    /// The sign of `simple` at `r`.
    at_r: Ordering,
    scale: i64,
    /// The sign of the given polynomial before the root and after it.
    pub before: Ordering,
    /// See `before`.
    pub after: Ordering,
}

/// The exponent of the typical size of a polynomial's roots: of the geometric mean of the absolute
/// values of its nonzero roots.
fn scale_of(coefficients: &[Exact]) -> i64 {
    let mut present = coefficients.iter().enumerate().filter(|(_, c)| c.sign().is_ne());
    match (present.next(), present.next_back()) {
        (Some((i, first)), Some((n, last))) => {
            (bits(&first.m) + first.e - bits(&last.m) - last.e).div_euclid((n - i) as i64)
        }
        _ => 0,
    }
}

/// All distinct real roots, ascending, of the polynomial with these coefficients, the constant
/// first.
pub fn real_roots(coefficients: &[Exact]) -> Vec<RealRoot> {
    if coefficients.iter().all(|c| c.sign().is_eq()) {
        return vec![];
    }
    let scale = scale_of(coefficients);
    let whole = whole_numbers(&rescaled(coefficients, scale));
    let first = chain(&whole);
    let common = &first[first.len() - 1];
    let simple = if common.len() > 1 { quotient(&whole, common) } else { whole.clone() };
    let chain = if common.len() > 1 { chain(&simple) } else { first };
    let changes = |x: &Exact| {
        let (mut last, mut n) = (Ordering::Equal, 0);
        for s in chain.iter().map(|p| sign_at(p, x)).filter(|s| s.is_ne()) {
            n += i32::from(last.is_ne() && s != last);
            last = s;
        }
        n
    };
    // A. Cauchy's bound.
    let lead = bits(&whole[whole.len() - 1]);
    let reach = whole.iter().map(|c| bits(c) - lead + 2).max().unwrap_or(0).max(1);
    let one = Exact::from(1.0);
    let (lo, hi) = (-one.clone().shifted(reach), one.shifted(reach));
    let simple = Arc::new(simple);
    let mut out = vec![];
    let (at_lo, at_hi) = (changes(&lo), changes(&hi));
    let mut open = vec![(lo, hi, at_lo, at_hi)];
    while let Some((l, r, at_l, at_r)) = open.pop() {
        match at_l - at_r {
            0 => {}
            1 => {
                let (before, after) = (sign_at(&whole, &l), sign_at(&whole, &r));
                let at_r = sign_at(&simple, &r);
                out.push(RealRoot { simple: simple.clone(), l, r, at_r, scale, before, after });
            }
            _ => {
                let mut m = (&l + &r).shifted(-1);
                while sign_at(&simple, &m).is_eq() {
                    m = (&m + &r).shifted(-1);
                }
                let at_m = changes(&m);
                open.push((m.clone(), r, at_m, at_r));
                open.push((l, m, at_l, at_m));
            }
        }
    }
    out
}

/// The coefficients of `p(2^scale x)`.
fn rescaled(p: &[Exact], scale: i64) -> Vec<Exact> {
    p.iter().enumerate().map(|(k, c)| c.clone().shifted(scale * k as i64)).collect()
}

impl RealRoot {
    /// The order of this root and an exact number.
    pub fn cmp_exact(&self, x: &Exact) -> Ordering {
        self.compare(&x.clone().shifted(-self.scale))
    }

    /// The order of this root and a number in the unit of `l` and `r`.
    fn compare(&self, x: &Exact) -> Ordering {
        if (&self.l - x).sign().is_ge() {
            return if self.is_exact() { (&self.l - x).sign() } else { Ordering::Greater };
        }
        if (&self.r - x).sign().is_le() {
            return Ordering::Less;
        }
        match sign_at(&self.simple, x) {
            Ordering::Equal => Ordering::Equal,
            s if s == self.at_r => Ordering::Less,
            _ => Ordering::Greater,
        }
    }

    fn is_exact(&self) -> bool {
        (&self.l - &self.r).sign().is_eq()
    }

    fn halve(&mut self) {
        let m = (&self.l + &self.r).shifted(-1);
        match self.compare(&m) {
            Ordering::Equal => (self.l, self.r) = (m.clone(), m),
            Ordering::Less => self.r = m,
            Ordering::Greater => self.l = m,
        }
    }

    /// An exact number within `2^-bits` of this root.
    pub fn about(&self, bits: i64) -> Exact {
        let mut at = self.clone();
        at.narrow(bits + self.scale);
        at.l.shifted(self.scale)
    }

    /// Narrows the interval to a width of `2^-digits` in its own unit.
    fn narrow(&mut self, digits: i64) {
        loop {
            let width = &self.r - &self.l;
            if (&width.clone().shifted(digits) - &Exact::from(1.0)).sign().is_le() {
                return;
            }
            // Newton's method doubles the digits, as soon as it converges; its interval is accepted
            // if the signs at its ends prove it.
            let known = -(bits(&width.m) + width.e);
            if !self.newton((2 * known - 8).min(digits + 2)) {
                self.halve();
            }
        }
    }

    /// Tries an interval of width `2^-bits` about the result of one step of Newton's method from
    /// the middle. Returns whether the signs prove it.
    fn newton(&mut self, bits: i64) -> bool {
        let m = (&self.l + &self.r).shifted(-1);
        let exact = |p: &Whole| -> Vec<Exact> { p.iter().map(|c| Exact { m: c.clone(), e: 0 }).collect() };
        let value = |p: &[Exact]| p.iter().rev().fold(Exact::zero(), |sum, c| &(&sum * &m) + c);
        let (f, slope) = (value(&exact(&self.simple)), value(&exact(&derivative(&self.simple))));
        let shift = f.e - slope.e + bits + 4;
        if slope.sign().is_eq() || shift < 0 {
            return false;
        }
        let step = Exact { m: (f.m << shift as usize) / slope.m, e: -bits - 4 };
        let to = &m - &step;
        let to = Exact { m: to.floor_at(bits + 4), e: -bits - 4 };
        let half = Exact::from(0.5).shifted(-bits);
        let (l, r) = (&to - &half, &to + &half);
        let inside = (&l - &self.l).sign().is_gt() && (&self.r - &r).sign().is_gt();
        // The sign of `simple` must be `at_r` at the upper end and the opposite at the lower end.
        if !inside
            || sign_at(&self.simple, &l) != self.at_r.reverse()
            || sign_at(&self.simple, &r) != self.at_r
        {
            return false;
        }
        (self.l, self.r) = (l, r);
        true
    }

    /// The sign of another polynomial at this root, the constant first.
    pub fn sign_of(&self, q: &[Exact]) -> Ordering {
        if q.iter().all(|c| c.sign().is_eq()) {
            return Ordering::Equal;
        }
        let q = rescaled(q, self.scale);
        let value = |x: &Exact| q.iter().rev().fold(Exact::zero(), |sum, c| &(&sum * x) + c);
        let mut at = self.clone();
        let mut digits = 4;
        loop {
            at.narrow(digits);
            let l = value(&at.l);
            if at.is_exact() {
                return l.sign();
            }
            let width = &at.r - &at.l;
            // |q'| over the interval.
            let size = &at.l.clone().abs() + &width;
            let slope = q.iter().enumerate().skip(1).rev().fold(Exact::zero(), |sum, (i, c)| {
                &(&sum * &size) + &(&c.clone().abs() * &Exact::from(i as f64))
            });
            let change = &slope * &width;
            if (&l.clone().abs() - &change).sign().is_gt() {
                return l.sign();
            }
            // It is zero if the two polynomials have a common divisor with this root.
            if digits == 64 {
                let common = common_divisor(&self.simple, &whole_numbers(&q));
                if common.len() > 1 && sign_at(&common, &at.l) != sign_at(&common, &at.r) {
                    return Ordering::Equal;
                }
            }
            digits *= 2;
        }
    }
}

/// A term of a polynomial in space: the coefficient of `x^i y^j z^k`.
pub type Term = (Exact, [usize; 3]);

/// The zero set of a polynomial in space, as a solid where it is negative.
#[derive(Clone, Debug)]
pub struct ZeroOracle {
    /// The polynomial.
    pub terms: Vec<Term>,
    /// The surface's size.
    pub size: f64,
}

/// The product of two polynomials in one unknown.
fn times(a: &[Exact], b: &[Exact]) -> Vec<Exact> {
    let mut out = vec![Exact::zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    out
}

impl ZeroOracle {
    /// The value at a point.
    pub fn value(&self, p: &[Exact; 3]) -> Exact {
        let power = |x: &Exact, n: usize| (0..n).fold(Exact::from(1.0), |a, _| &a * x);
        self.terms.iter().fold(Exact::zero(), |sum, (c, [i, j, k])| {
            &sum + &(&(c * &power(&p[0], *i)) * &(&power(&p[1], *j) * &power(&p[2], *k)))
        })
    }

    /// The derivative along an axis.
    fn slope(&self, axis: usize, p: &[Exact; 3]) -> Exact {
        let terms = self.terms.iter().filter(|(_, n)| n[axis] > 0).map(|(c, n)| {
            let mut less = *n;
            less[axis] -= 1;
            (c * &Exact::from(n[axis] as f64), less)
        });
        Self { terms: terms.collect(), size: 0.0 }.value(p)
    }

    /// The polynomial along a line, the constant first.
    pub fn along(&self, line: &ExactLine) -> Vec<Exact> {
        let degree = self.terms.iter().map(|(_, n)| n.iter().sum::<usize>()).max().unwrap_or(0);
        let powers: Vec<Vec<Vec<Exact>>> = (0..3)
            .map(|a| {
                let linear = vec![line.o[a].clone(), line.d[a].clone()];
                let mut all = vec![vec![Exact::from(1.0)]];
                for n in 0..degree {
                    all.push(times(&all[n], &linear));
                }
                all
            })
            .collect();
        let mut out = vec![Exact::zero(); degree + 1];
        for (c, [i, j, k]) in &self.terms {
            let product = times(&times(&powers[0][*i], &powers[1][*j]), &powers[2][*k]);
            for (sum, x) in out.iter_mut().zip(&product) {
                *sum = &*sum + &(x * c);
            }
        }
        out
    }
}

impl Oracle for ZeroOracle {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        let found = real_roots(&self.along(line));
        let named = found.into_iter().map(|root| {
            let sign = match (root.before, root.after) {
                (Ordering::Less, Ordering::Greater) => 1,
                (Ordering::Greater, Ordering::Less) => -1,
                _ => 0,
            };
            Crossing { t: root.into(), sign, grazing: sign == 0 }
        });
        named.collect()
    }

    fn face_side(&self, _: u32, point: &[Exact; 3]) -> Ordering {
        self.value(point).sign()
    }

    fn face_normal(&self, _: u32, point: &[Exact; 3]) -> Vec3 {
        let g = [0, 1, 2].map(|axis| self.slope(axis, point));
        let bits = |x: &Exact| dashu::base::BitTest::bit_len(&x.m) as i64 + x.e;
        let top = g.iter().filter(|x| x.sign().is_ne()).map(bits).max().unwrap_or(0);
        Vec3::from(g.map(|x| x.shifted(-top).to_f64()))
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        Some(self.value(point).sign())
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn is_convex(&self) -> bool {
        false
    }
}
