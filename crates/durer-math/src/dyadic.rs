//! Exact numbers: an integer of any size times a power of two.
//!
//! Sums, differences and products of f64 are such numbers, so every polynomial predicate has an
//! exact value here. This is the last step of the [ladder](crate::ladder): slow (tens to hundreds
//! of nanoseconds an operation), never wrong. Up to 512 bits are stored inside the number, more on
//! the heap. The exponent is an `i64`: nothing overflows or underflows.

use crate::Ring;
use crate::scale::ldexp;
use core::cmp::Ordering;
use core::fmt;
use core::ops::{Add, Mul, Neg, Sub};

/// The number of limbs that need no allocation.
const INLINE: usize = 8;

/// The magnitude's limbs, least significant first.
#[derive(Clone)]
enum Limbs {
    Inline(u8, [u64; INLINE]),
    Heap(Vec<u64>),
}

impl Limbs {
    fn zeros(n: usize) -> Self {
        if n <= INLINE { Self::Inline(n as u8, [0; INLINE]) } else { Self::Heap(vec![0; n]) }
    }

    fn truncate(&mut self, n: usize) {
        match self {
            Self::Inline(len, _) => *len = n as u8,
            Self::Heap(v) => v.truncate(n),
        }
    }
}

impl core::ops::Deref for Limbs {
    type Target = [u64];
    fn deref(&self) -> &[u64] {
        match self {
            Self::Inline(n, a) => &a[..usize::from(*n)],
            Self::Heap(v) => v,
        }
    }
}

impl core::ops::DerefMut for Limbs {
    fn deref_mut(&mut self) -> &mut [u64] {
        match self {
            Self::Inline(n, a) => &mut a[..usize::from(*n)],
            Self::Heap(v) => v,
        }
    }
}

/// The exact number `± magnitude * 2^exponent`.
///
/// # Invariants
///
/// The magnitude is odd or zero, has no leading zero limb, and zero is positive with exponent 0:
/// each number has one form.
///
/// ```
/// use durer_math::{Dyadic, Ring};
/// let tenth = Dyadic::from(0.1);
/// let sum = tenth.clone() + tenth.clone() + tenth; // exact, so not 0.3
/// assert_eq!(sum.cmp(&Dyadic::from(0.3)), core::cmp::Ordering::Greater);
/// assert_eq!((Dyadic::from(1e300) + Dyadic::from(1e-300)).sign(), Some(core::cmp::Ordering::Greater));
/// ```
pub struct Dyadic {
    negative: bool,
    exponent: i64,
    limbs: Limbs,
}

/// Copies and operators are never inlined: the exact steps of all predicates consist of them, and
/// would otherwise be several times as long.
impl Clone for Dyadic {
    #[inline(never)]
    fn clone(&self) -> Self {
        Self { negative: self.negative, exponent: self.exponent, limbs: self.limbs.clone() }
    }
}

impl Dyadic {
    /// Zero.
    pub const ZERO: Self = Self { negative: false, exponent: 0, limbs: Limbs::Inline(0, [0; INLINE]) };

    /// The number `x`, or `None` if it is infinite or NaN.
    pub fn new(x: f64) -> Option<Self> {
        x.is_finite().then(|| Self::from_finite(x))
    }

    fn from_finite(x: f64) -> Self {
        debug_assert!(x.is_finite());
        let bits = x.to_bits();
        let field = (bits >> 52) & 0x7ff;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field as i64 - 1075) };
        if mantissa == 0 {
            return Self::ZERO;
        }
        let zeros = mantissa.trailing_zeros();
        let mut limbs = [0; INLINE];
        limbs[0] = mantissa >> zeros;
        Self {
            negative: bits >> 63 == 1,
            exponent: exponent + i64::from(zeros),
            limbs: Limbs::Inline(1, limbs),
        }
    }

    /// Normalizes a number.
    fn normalized(negative: bool, mut exponent: i64, mut limbs: Limbs) -> Self {
        let Some(top) = limbs.iter().rposition(|&l| l != 0) else {
            return Self::ZERO;
        };
        let bottom = limbs.iter().position(|&l| l != 0).unwrap_or(0);
        let shift = limbs[bottom].trailing_zeros();
        exponent += 64 * bottom as i64 + i64::from(shift);
        let n = top - bottom + 1;
        for i in 0..n {
            let low = limbs[bottom + i] >> shift;
            let high = if shift != 0 && bottom + i < top { limbs[bottom + i + 1] << (64 - shift) } else { 0 };
            limbs[i] = low | high;
        }
        let n = if limbs[n - 1] == 0 { n - 1 } else { n };
        limbs.truncate(n);
        Self { negative, exponent, limbs }
    }

    /// Whether this is zero.
    pub fn is_zero(&self) -> bool {
        self.limbs.is_empty()
    }

    /// The comparison with zero, which [`Ring::sign`] wraps in `Some`.
    pub fn exact_sign(&self) -> Ordering {
        if self.is_zero() {
            Ordering::Equal
        } else if self.negative {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(mut self) -> Self {
        self.negative = false;
        self
    }

    /// The number of bits of the magnitude.
    fn bits(&self) -> i64 {
        match self.limbs.last() {
            Some(top) => 64 * self.limbs.len() as i64 - i64::from(top.leading_zeros()),
            None => 0,
        }
    }

    /// The `e` with `2^e <= |x| < 2^(e+1)`; `None` for zero.
    pub fn exponent(&self) -> Option<i64> {
        (!self.is_zero()).then(|| self.exponent + self.bits() - 1)
    }

    /// The magnitude shifted left by `shift` bits.
    fn shifted(&self, shift: u64) -> Limbs {
        let (words, bits) = ((shift / 64) as usize, (shift % 64) as u32);
        let mut out = Limbs::zeros(self.limbs.len() + words + 1);
        for (i, &l) in self.limbs.iter().enumerate() {
            out[i + words] |= l << bits;
            if bits != 0 {
                out[i + words + 1] = l >> (64 - bits);
            }
        }
        out
    }

    fn sum(a: &Self, b: &Self, negate_b: bool) -> Self {
        let b_negative = b.negative ^ negate_b;
        if b.is_zero() {
            return a.clone();
        }
        if a.is_zero() {
            return Self { negative: b_negative, ..b.clone() };
        }
        let exponent = a.exponent.min(b.exponent);
        let x = a.shifted((a.exponent - exponent) as u64);
        let y = b.shifted((b.exponent - exponent) as u64);
        if a.negative == b_negative {
            return Self::normalized(a.negative, exponent, add_limbs(&x, &y));
        }
        match compare_limbs(&x, &y) {
            Ordering::Equal => Self::ZERO,
            Ordering::Greater => Self::normalized(a.negative, exponent, subtract_limbs(&x, &y)),
            Ordering::Less => Self::normalized(b_negative, exponent, subtract_limbs(&y, &x)),
        }
    }

    fn product(a: &Self, b: &Self) -> Self {
        if a.is_zero() || b.is_zero() {
            return Self::ZERO;
        }
        let mut out = Limbs::zeros(a.limbs.len() + b.limbs.len());
        for (i, &x) in a.limbs.iter().enumerate() {
            let mut carry = 0;
            for (j, &y) in b.limbs.iter().enumerate() {
                let t = u128::from(x) * u128::from(y) + u128::from(out[i + j]) + carry;
                out[i + j] = t as u64;
                carry = t >> 64;
            }
            out[i + b.limbs.len()] = carry as u64;
        }
        Self::normalized(a.negative != b.negative, a.exponent + b.exponent, out)
    }

    /// The quotient if it is exact: an integer times a power of two. `None` otherwise.
    ///
    /// Computed from the low end: both magnitudes are odd, so each limb of the quotient follows
    /// from the lowest remaining limb, modulo `2^64` (T. Jebelean, "An algorithm for exact
    /// division", *Journal of Symbolic Computation* 15, 1993).
    pub fn exact_quotient(&self, divisor: &Self) -> Option<Self> {
        if divisor.is_zero() {
            return None;
        }
        if self.is_zero() {
            return Some(Self::ZERO);
        }
        let n = (self.limbs.len() + 1).checked_sub(divisor.limbs.len())?;
        let inverse = odd_inverse(divisor.limbs[0]);
        let mut rest: Vec<u64> = self.limbs[..n.min(self.limbs.len())].to_vec();
        rest.resize(n, 0);
        let mut quotient = Limbs::zeros(n);
        for i in 0..n {
            let q = rest[i].wrapping_mul(inverse);
            quotient[i] = q;
            let (mut carry, mut borrow) = (0_u128, false);
            for (j, x) in rest[i..].iter_mut().enumerate() {
                let d = divisor.limbs.get(j).copied().unwrap_or(0);
                let product = u128::from(q) * u128::from(d) + carry;
                carry = product >> 64;
                let (y, b1) = x.overflowing_sub(product as u64);
                let (y, b2) = y.overflowing_sub(u64::from(borrow));
                *x = y;
                borrow = b1 || b2;
            }
        }
        let negative = self.negative != divisor.negative;
        let quotient = Self::normalized(negative, self.exponent - divisor.exponent, quotient);
        (&quotient * divisor == *self).then_some(quotient)
    }

    /// The `e` of the lowest bit that is set: this number is an odd one times `2^e`; `None` for
    /// zero.
    pub fn lowest_bit(&self) -> Option<i64> {
        (!self.is_zero()).then_some(self.exponent)
    }

    /// The remainder modulo an odd number, not negative, where `2^-1` is the inverse of 2: a
    /// homomorphism of rings.
    ///
    /// # Panics
    ///
    /// If the modulus is even or above `2^63`.
    pub fn residue(&self, modulus: u64) -> u64 {
        assert!(modulus % 2 == 1 && modulus < 1 << 63, "an odd modulus below 2^63");
        let product = |a: u64, b: u64| (u128::from(a) * u128::from(b) % u128::from(modulus)) as u64;
        let rest = self.limbs.iter().rev().fold(0, |rest: u64, &limb| {
            ((u128::from(rest) << 64 | u128::from(limb)) % u128::from(modulus)) as u64
        });
        let (mut base, mut n) =
            (if self.exponent < 0 { modulus / 2 + 1 } else { 2 % modulus }, self.exponent.unsigned_abs());
        let mut power = 1 % modulus;
        while n > 0 {
            if n & 1 == 1 {
                power = product(power, base);
            }
            base = product(base, base);
            n >>= 1;
        }
        let rest = product(rest, power);
        if self.negative && rest != 0 { modulus - rest } else { rest }
    }

    /// The nearest f64, ties to even; infinite if it is too large.
    pub fn to_f64(&self) -> f64 {
        let Some(e) = self.exponent() else { return 0.0 };
        let magnitude = if e > 1023 {
            f64::INFINITY
        } else {
            // The place value of the last bit kept: 53 bits, fewer in the subnormal range.
            let last = (e - 52).max(-1074);
            let drop = last - self.exponent;
            if drop <= 0 {
                // At most 53 bits: no rounding.
                ldexp(self.limbs[0] as f64, self.exponent as i32)
            } else {
                let (kept, half, rest) = self.split_at_bit(drop as u64);
                let rounded = kept + u64::from(half && (rest || kept & 1 == 1));
                ldexp(rounded as f64, last as i32)
            }
        };
        if self.negative { -magnitude } else { magnitude }
    }

    /// The bits from `n` upward (at most 53), bit `n - 1`, and whether any bit below that is set.
    fn split_at_bit(&self, n: u64) -> (u64, bool, bool) {
        let limb = |i: u64| self.limbs.get(i as usize).copied().unwrap_or(0);
        let (word, bit) = (n / 64, n % 64);
        let kept = if bit == 0 { limb(word) } else { limb(word) >> bit | limb(word + 1) << (64 - bit) };
        let (word, bit) = ((n - 1) / 64, (n - 1) % 64);
        let half = limb(word) >> bit & 1 == 1;
        let rest =
            limb(word) & ((1 << bit) - 1) != 0 || self.limbs.iter().take(word as usize).any(|&l| l != 0);
        (kept, half, rest)
    }

    /// The tightest two f64 that enclose the number.
    pub fn to_bounds(&self) -> (f64, f64) {
        let nearest = self.to_f64();
        let order = match Self::new(nearest) {
            Some(n) => self.cmp(&n),
            // Rounded to an infinity, which is greater in magnitude.
            None if nearest > 0.0 => Ordering::Less,
            None => Ordering::Greater,
        };
        match order {
            Ordering::Less => (nearest.next_down(), nearest),
            Ordering::Equal => (nearest, nearest),
            Ordering::Greater => (nearest, nearest.next_up()),
        }
    }

    /// `(hi, lo, k)` with `|x 2^-k - (hi + lo)| <= 2^-106 |x 2^-k|` and `hi` in `[1, 2]` in
    /// magnitude (all zero for zero).
    pub(crate) fn to_scaled_dd(&self) -> (crate::Dd, i64) {
        let Some(k) = self.exponent() else { return (crate::Dd::ZERO, 0) };
        let scaled = Self { exponent: self.exponent - k, ..self.clone() };
        let hi = scaled.to_f64();
        let lo = (&scaled - &Self::from_finite(hi)).to_f64();
        (crate::Dd { hi, lo }, k)
    }
}

/// The inverse of an odd number modulo `2^64`, by Newton's iteration: three bits are right at
/// first, and each step doubles their number.
fn odd_inverse(x: u64) -> u64 {
    (0..5).fold(x, |y, _| y.wrapping_mul(2_u64.wrapping_sub(x.wrapping_mul(y))))
}

fn add_limbs(x: &[u64], y: &[u64]) -> Limbs {
    let (x, y) = if x.len() >= y.len() { (x, y) } else { (y, x) };
    let mut out = Limbs::zeros(x.len() + 1);
    let mut carry = false;
    for (i, &l) in x.iter().enumerate() {
        let (s, c1) = l.overflowing_add(y.get(i).copied().unwrap_or(0));
        let (s, c2) = s.overflowing_add(u64::from(carry));
        out[i] = s;
        carry = c1 || c2;
    }
    out[x.len()] = u64::from(carry);
    out
}

/// `x - y` for `x >= y`.
fn subtract_limbs(x: &[u64], y: &[u64]) -> Limbs {
    let mut out = Limbs::zeros(x.len());
    let mut borrow = false;
    for (i, &l) in x.iter().enumerate() {
        let (d, b1) = l.overflowing_sub(y.get(i).copied().unwrap_or(0));
        let (d, b2) = d.overflowing_sub(u64::from(borrow));
        out[i] = d;
        borrow = b1 || b2;
    }
    out
}

fn compare_limbs(x: &[u64], y: &[u64]) -> Ordering {
    for i in (0..x.len().max(y.len())).rev() {
        let order = x.get(i).unwrap_or(&0).cmp(y.get(i).unwrap_or(&0));
        if order != Ordering::Equal {
            return order;
        }
    }
    Ordering::Equal
}

impl From<f64> for Dyadic {
    /// The number `x`, exactly. An infinity or NaN, which [`Dyadic::new`] refuses, becomes zero.
    fn from(x: f64) -> Self {
        Self::new(x).unwrap_or(Self::ZERO)
    }
}

impl fmt::Debug for Dyadic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}0x", if self.negative { "-" } else { "" })?;
        match self.limbs.split_last() {
            None => write!(f, "0")?,
            Some((top, rest)) => {
                write!(f, "{top:x}")?;
                for l in rest.iter().rev() {
                    write!(f, "{l:016x}")?;
                }
            }
        }
        write!(f, "p{}", self.exponent)
    }
}

impl Ord for Dyadic {
    fn cmp(&self, b: &Self) -> Ordering {
        let signs = self.exact_sign().cmp(&b.exact_sign());
        if signs != Ordering::Equal || self.is_zero() {
            return signs;
        }
        let tops = self.exponent().cmp(&b.exponent());
        if tops != Ordering::Equal {
            return if self.negative { tops.reverse() } else { tops };
        }
        Self::sum(self, b, true).exact_sign()
    }
}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, b: &Self) -> Option<Ordering> {
        Some(self.cmp(b))
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, b: &Self) -> bool {
        self.cmp(b) == Ordering::Equal
    }
}

impl Eq for Dyadic {}

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $body:expr) => {
        impl $trait for &Dyadic {
            type Output = Dyadic;
            #[inline(never)]
            fn $method(self, other: &Dyadic) -> Dyadic {
                let ($a, $b) = (self, other);
                $body
            }
        }
        impl $trait for Dyadic {
            type Output = Self;
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (&self, &other);
                $body
            }
        }
    };
}

operator!(Add, add, |a, b| Dyadic::sum(a, b, false));
operator!(Sub, sub, |a, b| Dyadic::sum(a, b, true));
operator!(Mul, mul, |a, b| Dyadic::product(a, b));

impl Neg for Dyadic {
    type Output = Self;
    fn neg(mut self) -> Self {
        self.negative = !self.negative && !self.is_zero();
        self
    }
}

impl Ring for Dyadic {
    fn exact(x: f64) -> Self {
        Self::from(x)
    }

    fn within(x: f64, error: f64) -> Option<Self> {
        if error == 0.0 { Self::new(x) } else { None }
    }

    fn scale2(mut self, exponent: i32) -> Self {
        if !self.is_zero() {
            self.exponent += i64::from(exponent);
        }
        self
    }

    fn sign(&self) -> Option<Ordering> {
        Some(self.exact_sign())
    }
}
