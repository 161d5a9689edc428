//! Polynomials in Bernstein form: proven bounds on the number of sign changes over an interval.
//!
//! ```text
//!   p(x) = Σ b_j C(n,j) u^j (1-u)^(n-j),    u = (x + 1) / 2,    x in [-1, 1]
//! ```
//!
//! The number of roots in the open interval is at most the number of sign changes among the `b_j`,
//! and differs from it by an even number (J. M. Lane, R. F. Riesenfeld, "Bounds on a polynomial", *BIT*
//! 21, 1981); `b_0` and `b_n` are the values at the ends. The form is the best conditioned one on
//! an interval (R. T. Farouki, V. T. Rajan, "On the numerical condition of polynomials in Bernstein
//! form", *Computer Aided Geometric Design* 4, 1987).

use durer_math::efloat::Word;

/// Covers results below the normal range.
pub const FLOOR: f64 = durer_math::scale::pow2(-1000);

/// `K[k][j]`, the factor of `u^j (1-u)^(n-j)` in `(2u - 1)^k`: whole numbers (M. Krawtchouk, 1929),
/// exact in f64, and `|K[k][j]| <= C(n,j)`.
struct Matrix<const N: usize>;

const fn choose(n: usize, k: usize) -> i64 {
    if k > n {
        return 0;
    }
    let (mut c, mut i) = (1, 0);
    while i < k {
        c = c * (n - i) as i64 / (i + 1) as i64;
        i += 1;
    }
    c
}

impl<const N: usize> Matrix<N> {
    const K: [[f64; N]; N] = {
        let n = N - 1;
        let mut out = [[0.0; N]; N];
        let mut k = 0;
        while k < N {
            let mut j = 0;
            while j < N {
                // i of the k factors (u - (1-u)) give u, and j - i of the n - k factors (u +
                // (1-u)).
                let (mut sum, mut i) = (0, 0);
                while i <= k && i <= j {
                    let term = choose(k, i) * choose(n - k, j - i);
                    sum += if (k - i) % 2 == 0 { term } else { -term };
                    i += 1;
                }
                out[k][j] = sum as f64;
                j += 1;
            }
            k += 1;
        }
        out
    };

    const BINOMIALS: [f64; N] = {
        let (mut out, mut j) = ([0.0; N], 0);
        while j < N {
            out[j] = choose(N - 1, j) as f64;
            j += 1;
        }
        out
    };

    const INVERSES: [f64; N] = {
        let (mut out, mut j) = ([0.0; N], 0);
        while j < N {
            out[j] = 1.0 / choose(N - 1, j) as f64;
            j += 1;
        }
        out
    };
}

/// `N` Bernstein coefficients, each within `e` of the true one.
#[derive(Clone, Copy, Debug)]
pub struct Bernstein<T, const N: usize> {
    /// The coefficients.
    pub b: [T; N],
    /// The bound on their errors.
    pub e: f64,
}

/// The facts that the signs of Bernstein coefficients prove.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// No root, ends included: the sign is the same everywhere.
    None,
    /// Exactly one root, a simple one, strictly inside, where the sign changes from minus to plus.
    Rise,
    /// Exactly one root, a simple one, strictly inside, where the sign changes from plus to minus.
    Fall,
    /// The signs prove nothing.
    Open,
}

impl<T: Word, const N: usize> Bernstein<T, N> {
    /// Converts `Σ c_k x^k`, where the sum of the errors of the `c_k` is at most `slack`.
    ///
    /// `|K[k][j] / C(n,j)| <= 1`, so errors of coefficients at most add up; each `b_j` takes
    /// `n + 1` products and sums and a division.
    #[inline(always)]
    pub fn new(c: &[T; N], slack: f64) -> Self {
        let unit = (N + 1) as f64 * (T::ADD + T::MUL) + T::DIV;
        let size = c.iter().fold(0.0, |sum, c| sum + c.to_f64().abs());
        // Loops: functions of arrays are too large to be inlined, and by themselves would be
        // compiled without fused sums.
        let mut b = [T::from(0.0); N];
        for (j, b) in b.iter_mut().enumerate() {
            for (row, &c) in Matrix::<N>::K.iter().zip(c) {
                *b = *b + T::from(row[j]) * c;
            }
            *b = *b / T::from(Matrix::<N>::BINOMIALS[j]);
        }
        Self { b, e: size.mul_add(unit, slack) * (1.0 + 64.0 * f64::EPSILON) + FLOOR }
    }

    /// The largest magnitude of a coefficient, rounded up.
    #[inline(always)]
    fn size(&self) -> f64 {
        self.b.iter().fold(0.0, |m: f64, b| m.max(b.to_f64().abs())) * (1.0 + 4.0 * f64::EPSILON)
    }

    /// The facts that the signs prove.
    #[inline(always)]
    pub fn count(&self) -> Count {
        // For double-doubles |hi + lo| >= |hi| (1 - U).
        let e = self.e * (1.0 + 4.0 * f64::EPSILON);
        let (mut plus, mut minus) = (0_u32, 0_u32);
        for (j, b) in self.b.iter().enumerate() {
            let b = b.to_f64();
            plus |= u32::from(b > e) << j;
            minus |= u32::from(b < -e) << j;
        }
        let all = (1_u32 << N) - 1;
        if plus == all || minus == all {
            return Count::None;
        }
        // All low coefficients have one sign and all high ones the other, with at most one open
        // between them: for any sign of the open one there is one change.
        let turn = |low: u32, high: u32| {
            let (a, b) = (low.trailing_ones(), (!high & all).leading_zeros());
            low != 0
                && high != 0
                && low == (1 << a) - 1
                && high == all & !((1_u64 << (32 - b)) - 1) as u32
                && 32 - b - a <= 1
        };
        if turn(minus, plus) {
            Count::Rise
        } else if turn(plus, minus) {
            Count::Fall
        } else {
            Count::Open
        }
    }

    /// The sign of the polynomial (plus is `true`), if it is certainly the same on all of the
    /// interval, ends included.
    #[inline(always)]
    pub fn one_sign(&self) -> Option<bool> {
        (self.count() == Count::None).then(|| self.b[0].to_f64() > 0.0)
    }

    /// Whether any coefficient's sign is certain.
    #[inline(always)]
    pub fn tells(&self) -> bool {
        self.size() > self.e * (1.0 + 8.0 * f64::EPSILON)
    }

    /// Whether the sign at the point of a split is certain; the sign of either end is.
    #[inline(always)]
    pub fn last_is_certain(&self) -> bool {
        self.b[N - 1].to_f64().abs() > self.e * (1.0 + 4.0 * f64::EPSILON)
    }

    /// The two parts on either side of `u = part`, by P. de Casteljau's scheme: each new
    /// coefficient is a mean of two, so errors add up over its `n` levels and do not grow.
    #[inline(always)]
    pub fn split(&self, part: f64) -> (Self, Self) {
        let e = (N - 1) as f64 * (T::ADD + 2.0 * T::MUL);
        let e =
            self.size().mul_add(e * (1.0 + 64.0 * f64::EPSILON), self.e) * (1.0 + 4.0 * f64::EPSILON) + FLOOR;
        let (mut left, mut right) = (*self, *self);
        (left.e, right.e) = (e, e);
        let (part, rest) = (T::from(part), T::from(1.0 - part));
        for level in 1..N {
            for j in 0..N - level {
                right.b[j] = rest * right.b[j] + part * right.b[j + 1];
            }
            left.b[level] = right.b[0];
        }
        (left, right)
    }
}

impl<const N: usize> Bernstein<f64, N> {
    /// [`Bernstein::new`] with a rounded inverse instead of the division (one more rounding) and
    /// fused sums.
    #[inline(always)]
    pub fn quick(c: &[f64; N], slack: f64) -> Self {
        let unit = (N + 3) as f64 * f64::ADD;
        let size = c.iter().fold(0.0, |sum, c| sum + c.abs());
        let mut b = [0.0_f64; N];
        for (j, b) in b.iter_mut().enumerate() {
            for (row, &c) in Matrix::<N>::K.iter().zip(c) {
                *b = row[j].mul_add(c, *b);
            }
            *b *= Matrix::<N>::INVERSES[j];
        }
        Self { b, e: size.mul_add(unit, slack) * (1.0 + 64.0 * f64::EPSILON) + FLOOR }
    }

    /// Whether all coefficients but the first certainly have this sign, and the first does not
    /// certainly have the other. If the first is known to have this sign, too, there is no root.
    #[inline(always)]
    pub fn stays(&self, positive: bool) -> bool {
        let sign = if positive { 1.0 } else { -1.0 };
        let e = self.e * (1.0 + 4.0 * f64::EPSILON);
        self.b[1..].iter().fold(self.b[0] * sign >= -e, |all, b| all & (b * sign > e))
    }

    /// The crossing of the control polygon with zero, if there is only one: a good estimate of the
    /// root.
    #[inline(always)]
    pub fn guess(&self) -> f64 {
        let first = self.b[0] > 0.0;
        let turn = self.b.iter().position(|b| (*b > 0.0) != first).unwrap_or(N - 1).max(1);
        let (a, b) = (self.b[turn - 1], self.b[turn]);
        ((turn - 1) as f64 + a / (a - b)) / (N - 1) as f64
    }
}

/// The binomial coefficient `n` over `k`, exact while it is below 2^53.
pub fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::{Dd, Dyadic};
    use durer_testkit::TestRng;

    /// The Bernstein coefficients of the part between `l` and `r`, times `C(n,j)`, exactly: by
    /// substituting and expanding.
    fn exact<const N: usize>(c: &[f64; N], l: f64, r: f64) -> [Dyadic; N] {
        let (l, r) = (Dyadic::from(l), Dyadic::from(r));
        // x = l (1-u) + r u: the factors of u^j (1-u)^(k-j) in x^k, then times ((1-u) + u)^(n-k).
        let mut out: [Dyadic; N] = core::array::from_fn(|_| Dyadic::ZERO);
        for (k, &ck) in c.iter().enumerate() {
            let mut row = vec![Dyadic::from(ck)];
            for step in 0..N - 1 {
                let (a, b) =
                    if step < k { (l.clone(), r.clone()) } else { (Dyadic::from(1.0), Dyadic::from(1.0)) };
                let mut next = vec![Dyadic::ZERO; row.len() + 1];
                for (j, x) in row.iter().enumerate() {
                    next[j] = &next[j] + &(x * &a);
                    next[j + 1] = &next[j + 1] + &(x * &b);
                }
                row = next;
            }
            for (sum, x) in out.iter_mut().zip(&row) {
                *sum = &*sum + x;
            }
        }
        out
    }

    fn is_within<T: Word, const N: usize>(
        found: &Bernstein<T, N>,
        parts: impl Fn(T) -> (f64, f64),
        exact: &[Dyadic; N],
    ) {
        for (j, exact) in exact.iter().enumerate() {
            let (hi, lo) = parts(found.b[j]);
            let c = Dyadic::from(choose(N - 1, j) as f64);
            let error = &(&(&Dyadic::from(hi) + &Dyadic::from(lo)) * &c) - exact;
            assert!(error.abs() <= &Dyadic::from(found.e) * &c, "coefficient {j} of {N}");
        }
    }

    fn bounds_hold<const N: usize>(seed: u64) {
        let mut dice = TestRng::new(seed);
        let c: [f64; N] = core::array::from_fn(|_| dice.between(-1.0, 1.0) * dice.scale(-30, 4));
        let whole = exact(&c, -1.0, 1.0);
        let (quick, plain) = (Bernstein::quick(&c, 0.0), Bernstein::<f64, N>::new(&c, 0.0));
        let wide = Bernstein::<Dd, N>::new(&c.map(Dd::from), 0.0);
        is_within(&quick, |x| (x, 0.0), &whole);
        is_within(&plain, |x| (x, 0.0), &whole);
        is_within(&wide, |x| (x.hi, x.lo), &whole);
        assert!(wide.e < plain.e * 1e-12);
        for part in [0.5, 0.4375, 0.5625] {
            let at = 2.0 * part - 1.0;
            let (l, r) = quick.split(part);
            is_within(&l, |x| (x, 0.0), &exact(&c, -1.0, at));
            is_within(&r, |x| (x, 0.0), &exact(&c, at, 1.0));
            let (l, r) = wide.split(part);
            is_within(&l, |x| (x.hi, x.lo), &exact(&c, -1.0, at));
            is_within(&r, |x| (x.hi, x.lo), &exact(&c, at, 1.0));
        }
    }

    #[test]
    fn coefficients_are_within_their_bound_of_the_exact_ones() {
        for seed in 0..200 {
            bounds_hold::<5>(seed);
            bounds_hold::<9>(seed);
            bounds_hold::<17>(seed);
        }
    }

    #[test]
    fn counts_are_proven_only_where_every_choice_of_open_signs_agrees() {
        let count = |b: [f64; 5]| Bernstein { b, e: 0.5 }.count();
        assert_eq!(count([1.0, 2.0, 3.0, 1.0, 0.6]), Count::None);
        assert_eq!(count([-1.0, -2.0, -3.0, -1.0, -0.6]), Count::None);
        assert_eq!(count([-1.0, 2.0, 3.0, 1.0, 0.6]), Count::Rise);
        assert_eq!(count([-1.0, -1.0, 0.4, 1.0, 0.6]), Count::Rise);
        assert_eq!(count([1.0, -0.5, -1.0, -1.0, -0.6]), Count::Fall);
        assert_eq!(count([1.0, 1.0, 1.0, 1.0, -0.6]), Count::Fall);
        for open in [
            [1.0, 0.4, 1.0, 1.0, 1.0],
            [1.0, 0.4, 0.4, -1.0, -1.0],
            [0.4, 1.0, 1.0, 1.0, 1.0],
            [1.0, 1.0, 1.0, 1.0, 0.5],
            [0.0; 5],
            [1.0, -1.0, 1.0, -1.0, -1.0],
            [-1.0, 1.0, 1.0, 1.0, -1.0],
            [1.0, 1.0, -1.0, 0.2, -1.0],
        ] {
            assert_eq!(count(open), Count::Open, "{open:?}");
        }
    }
}
