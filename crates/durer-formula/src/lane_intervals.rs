//! Eight intervals side by side: one formula on eight boxes, or on eight segments of a ray, at
//! once.
//!
//! Sums, products and quotients are rounded to nearest and then, sums only if they are inexact,
//! widened: by S. M. Rump, P. Zimmermann, S. Boldo, G. Melquiond, "Computing predecessor and
//! successor in rounding to nearest", *BIT* 49 (2009), `fl(x - fl(phi |x|))` with
//! `phi = u (1 + 2u)` is at or below the predecessor of a normal `x`, and so at or below everything
//! that rounds to `x`. Where results may be subnormal a step of `2^-1000` is added. That is
//! branch-free, as vector instructions need it. Sines and cosines are computed in lanes too
//! (`lane_waves.rs`), the other elementary functions are those of [`Interval`], lane by lane.

use crate::lane_waves::{wave, waves};
use crate::noise;
use crate::noise::{Nearest, NoiseTable};
use crate::number::{Comparison, Function, Number, Sloped};
use durer_math::interval::elementary::{Defined, Range};
use durer_math::{F8, Interval, M8};

/// The number of intervals.
const LANES: usize = durer_math::lanes::LANES;
/// `u (1 + 2 u)`.
const PHI: f64 = durer_math::U * (1.0 + f64::EPSILON);
/// Covers results below the normal range, and is a normal number itself.
const TINY: f64 = durer_math::scale::pow2(-1000);
/// All integers below this are f64 numbers: a result that rounds to less is exact.
const ALL_WHOLE: f64 = durer_math::scale::pow2(53);
/// For dividends from here on, no remainder underflows.
const LARGE_ENOUGH: f64 = durer_math::scale::pow2(-900);

/// Eight intervals. No end is NaN, no lower end is `inf`, no upper end `-inf`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct I8 {
    /// The least numbers.
    pub lo: F8,
    /// The greatest numbers.
    pub hi: F8,
    /// Lanes (as bits) where the formula may be undefined somewhere.
    pub partial: u8,
    /// Lanes where it is undefined everywhere; the interval there is meaningless. Such a lane is
    /// also in `partial`.
    pub empty: u8,
    /// Lanes where it may jump.
    pub jump: u8,
}

impl I8 {
    /// The intervals from `lo` to `hi` in each lane. Ends must not be NaN.
    #[inline(always)]
    pub fn new(lo: F8, hi: F8) -> Self {
        Self { lo, hi, partial: 0, empty: 0, jump: 0 }
    }

    /// Every lane holds `x`.
    #[inline(always)]
    pub fn splat(x: Interval) -> Self {
        Self::new(F8::splat(x.lo), F8::splat(x.hi))
    }

    /// The interval of a lane; empty where nothing is defined.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> Interval {
        if self.empty >> i & 1 == 1 {
            Interval::EMPTY
        } else {
            Interval { lo: self.lo.0[i], hi: self.hi.0[i] }
        }
    }

    /// Sets a lane's interval.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, x: Interval) {
        (self.lo.0[i], self.hi.0[i]) = (x.lo, x.hi);
    }

    /// Adds the flags of the operands.
    #[inline(always)]
    pub(crate) fn said(mut self, a: &Self, b: &Self) -> Self {
        self.partial |= a.partial | b.partial;
        self.empty |= a.empty | b.empty;
        self.jump |= a.jump | b.jump;
        self
    }

    /// Applies a function to each lane's interval.
    #[inline(always)]
    fn each(a: &Self, f: impl Fn(Interval) -> Range) -> Self {
        Self::each2(a, a, |x, _| f(x))
    }

    #[inline(always)]
    fn each2(a: &Self, b: &Self, f: impl Fn(Interval, Interval) -> Range) -> Self {
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        for i in 0..LANES {
            if out.empty >> i & 1 == 1 {
                continue;
            }
            let (range, defined) = f(a.lane(i), b.lane(i));
            out.put(i, range, defined);
        }
        out
    }

    /// Sets a lane to a function's range.
    #[inline(always)]
    fn put(&mut self, i: usize, range: Interval, defined: Defined) {
        match defined {
            Defined::Continuous => {}
            Defined::Jumps => self.jump |= 1 << i,
            Defined::Partly => self.partial |= 1 << i,
            Defined::Nowhere => {
                self.partial |= 1 << i;
                self.empty |= 1 << i;
                self.set_lane(i, Interval { lo: 0.0, hi: 0.0 });
                return;
            }
        }
        let lost = range.lo.is_nan() || range.hi.is_nan();
        self.set_lane(i, if lost { Interval::ENTIRE } else { range });
    }
}

/// A number at or below all numbers that round to `x`.
#[inline(always)]
fn below(x: f64) -> f64 {
    let x = if x > f64::MAX { f64::MAX } else { x };
    x - x.abs().mul_add(PHI, TINY)
}

#[inline(always)]
fn above(x: f64) -> f64 {
    let x = if x < f64::MIN { f64::MIN } else { x };
    x + x.abs().mul_add(PHI, TINY)
}

/// A sum rounded down. The sum `s` in f64 is a bound without widening if the exact one is not below
/// it: so sums of integers are exact, and greater operands do not have lower bounds. Let
/// `s = a + b - lost`. Then `s - a` is `b - lost`: in f64 at most `b` if `lost >= 0`, as rounding
/// is monotone; and if `a` is the greater operand in magnitude it is a number (T. J. Dekker, "A
/// floating-point technique for extending the available precision", *Numerische Mathematik* 18
/// (1971)), so above `b` if `lost < 0`. The same holds with `a` and `b` exchanged. Of infinite sums
/// only `-inf` passes both comparisons.
#[inline(always)]
fn sum_below(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let finite = if sum > f64::MAX { f64::MAX } else { sum };
    let is_below = (sum - a <= b) & (sum - b <= a);
    if is_below { sum } else { finite - finite.abs().mul_add(PHI, TINY) }
}

/// A sum rounded up; see [`sum_below`].
#[inline(always)]
fn sum_above(a: f64, b: f64) -> f64 {
    -sum_below(-a, -b)
}

/// Quotients by single numbers, none of which is zero: exact where f64 is.
#[inline(always)]
fn divided_by_points(a: &I8, b: &I8) -> I8 {
    let mut out = I8::new(F8::ZERO, F8::ZERO).said(a, b);
    for i in 0..LANES {
        // a / b = -a / -b
        let (lo, hi, b) = (a.lo.0[i], a.hi.0[i], b.lo.0[i]);
        let positive = b > 0.0;
        let (lo, hi) = (if positive { lo } else { -hi }, if positive { hi } else { -lo });
        out.lo.0[i] = quotient_below(lo, b.abs());
        out.hi.0[i] = -quotient_below(-hi, b.abs());
    }
    out
}

/// A quotient by a positive number, rounded down. The quotient `q` in f64 is a bound without
/// widening if `q b - a`, rounded once, is not above zero: rounding keeps the sign unless the
/// difference underflows. It is a multiple of the last bit of `a` and of the last bits of `q` and
/// `b` together, at least `2^-106 q b`; where `q` is below the normal numbers, `b` is above
/// `2^1022 |a|`, and these are at least `2^-1074 2^-52 b`. So it is 0 or at least `2^-107 |a|`.
#[inline(always)]
fn quotient_below(a: f64, b: f64) -> f64 {
    let q = a / b;
    let certain = (a.abs() >= LARGE_ENOUGH) | (a == 0.0);
    let is_below = certain & (q.mul_add(b, -a) <= 0.0);
    if is_below { q } else { below(q) }
}

/// A product with `0 inf = 0`, since an infinite end is never attained.
#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    let p = a * b;
    if p.is_nan() { 0.0 } else { p }
}

#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Number for I8 {
    #[inline(always)]
    fn constant(c: Interval) -> Self {
        Self::splat(c)
    }

    #[inline(always)]
    fn add(a: &Self, b: &Self) -> Self {
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        for i in 0..LANES {
            out.lo.0[i] = sum_below(a.lo.0[i], b.lo.0[i]);
        }
        for i in 0..LANES {
            out.hi.0[i] = sum_above(a.hi.0[i], b.hi.0[i]);
        }
        out
    }

    #[inline(always)]
    fn sub(a: &Self, b: &Self) -> Self {
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        for i in 0..LANES {
            out.lo.0[i] = sum_below(a.lo.0[i], -b.hi.0[i]);
        }
        for i in 0..LANES {
            out.hi.0[i] = sum_above(a.hi.0[i], -b.lo.0[i]);
        }
        out
    }

    #[inline(always)]
    fn mul(a: &Self, b: &Self) -> Self {
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        for i in 0..LANES {
            let (al, ah, bl, bh) = (a.lo.0[i], a.hi.0[i], b.lo.0[i], b.hi.0[i]);
            let (p, q, r, s) = (times(al, bl), times(al, bh), times(ah, bl), times(ah, bh));
            let lo = below(least(least(p, q), least(r, s)));
            let hi = above(most(most(p, q), most(r, s)));
            // The product of operands with known signs has a known sign, which underflow must not
            // lose.
            let same = (al >= 0.0) & (bl >= 0.0) | (ah <= 0.0) & (bh <= 0.0);
            let opposite = (al >= 0.0) & (bh <= 0.0) | (ah <= 0.0) & (bl >= 0.0);
            out.lo.0[i] = if same & (lo < 0.0) { 0.0 } else { lo };
            out.hi.0[i] = if opposite & (hi > 0.0) { 0.0 } else { hi };
        }
        out
    }

    #[inline(always)]
    fn mul_whole(a: &Self, b: &Self) -> Self {
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        for i in 0..LANES {
            let (al, ah, bl, bh) = (a.lo.0[i], a.hi.0[i], b.lo.0[i], b.hi.0[i]);
            let (p, q, r, s) = (times(al, bl), times(al, bh), times(ah, bl), times(ah, bh));
            let (lo, hi) = (least(least(p, q), least(r, s)), most(most(p, q), most(r, s)));
            let exact = (lo > -ALL_WHOLE) & (hi < ALL_WHOLE);
            out.lo.0[i] = if exact { lo } else { below(lo) };
            out.hi.0[i] = if exact { hi } else { above(hi) };
        }
        out
    }

    #[inline(always)]
    fn times(k: f64, a: &Self) -> Self {
        let mut out = *a;
        for i in 0..LANES {
            let (l, h) = (a.lo.0[i], a.hi.0[i]);
            let (l, h) = if k > 0.0 { (l, h) } else { (-h, -l) };
            let (lo, hi) = (below(k.abs() * l), above(k.abs() * h));
            // Underflow must not lose a sign.
            out.lo.0[i] = if (l >= 0.0) & (lo < 0.0) { 0.0 } else { lo };
            out.hi.0[i] = if (h <= 0.0) & (hi > 0.0) { 0.0 } else { hi };
        }
        out
    }

    #[inline(always)]
    fn div(a: &Self, b: &Self) -> Self {
        // Usually the divisor is a constant.
        if (b.lo.equals(b.hi) & b.lo.abs().gt(F8::ZERO)).all() {
            return divided_by_points(a, b);
        }
        let mut inverse = Self::new(F8::ZERO, F8::ZERO);
        let holed = (b.lo.le(F8::ZERO) & b.hi.ge(F8::ZERO)).bits();
        for i in 0..LANES {
            let (lo, hi) = (b.lo.0[i], b.hi.0[i]);
            let positive = lo > 0.0;
            let apart = positive | (hi < 0.0);
            let (l, h) = (below(1.0 / hi), above(1.0 / lo));
            // A value of one sign keeps it.
            let l = if positive & (l < 0.0) { 0.0 } else { l };
            let h = if !positive & (h > 0.0) { 0.0 } else { h };
            inverse.lo.0[i] = if apart { l } else { f64::NEG_INFINITY };
            inverse.hi.0[i] = if apart { h } else { f64::INFINITY };
        }
        if holed != 0 {
            holes(&mut inverse, b, holed);
        }
        let mut out = Self::mul(a, &inverse);
        out = out.said(b, b);
        out.partial |= holed;
        out.empty |= inverse.empty;
        out
    }

    #[inline(always)]
    fn neg(a: &Self) -> Self {
        Self { lo: -a.hi, hi: -a.lo, ..*a }
    }

    #[inline(always)]
    fn sqr(a: &Self) -> Self {
        let mut out = *a;
        for i in 0..LANES {
            let (l, h) = (a.lo.0[i], a.hi.0[i]);
            let straddles = (l < 0.0) & (h > 0.0);
            let (l, h) = (l * l, h * h);
            let lo = below(least(l, h));
            out.lo.0[i] = if straddles | (lo < 0.0) { 0.0 } else { lo };
            out.hi.0[i] = above(most(l, h));
        }
        out
    }

    #[inline(always)]
    fn abs(a: &Self) -> Self {
        let mut out = *a;
        for i in 0..LANES {
            let (l, h) = (a.lo.0[i], a.hi.0[i]);
            let straddles = (l < 0.0) & (h > 0.0);
            let (l, h) = (l.abs(), h.abs());
            out.lo.0[i] = if straddles { 0.0 } else { least(l, h) };
            out.hi.0[i] = most(l, h);
        }
        out
    }

    #[inline(always)]
    fn sqrt(a: &Self) -> Self {
        let mut out = *a;
        let (partial, empty) = (a.lo.lt(F8::ZERO).bits(), a.hi.lt(F8::ZERO).bits());
        for i in 0..LANES {
            let (l, h) = (a.lo.0[i], a.hi.0[i]);
            let (l, h) = (if l > 0.0 { l } else { 0.0 }, if h > 0.0 { h } else { 0.0 });
            // Square roots are normal numbers. An infinite lower end does not occur.
            let lo = below(l.sqrt());
            out.lo.0[i] = if lo < 0.0 { 0.0 } else { lo };
            out.hi.0[i] = if h == 0.0 { 0.0 } else { above(h.sqrt()) };
        }
        out.partial |= partial;
        out.empty |= empty;
        out
    }

    #[inline(always)]
    fn min(a: &Self, b: &Self) -> Self {
        Self::new(a.lo.min(b.lo), a.hi.min(b.hi)).said(a, b)
    }

    #[inline(always)]
    fn max(a: &Self, b: &Self) -> Self {
        Self::new(a.lo.max(b.lo), a.hi.max(b.hi)).said(a, b)
    }

    #[inline(always)]
    fn powi(a: &Self, n: i32) -> Self {
        match n {
            1 => *a,
            2 => Self::sqr(a),
            3 => cube(a),
            4 => Self::sqr(&Self::sqr(a)),
            5..=64 => product(a, n),
            _ => powers(a, n),
        }
    }

    #[inline(always)]
    fn pow(a: &Self, b: &Self) -> Self {
        pow(a, b)
    }

    #[inline(always)]
    fn atan2(y: &Self, x: &Self) -> Self {
        atan2(y, x)
    }

    #[inline(always)]
    fn rem(a: &Self, b: &Self) -> Self {
        rem(a, b)
    }

    #[inline(always)]
    fn function(f: Function, a: &Self) -> Self {
        match f {
            Function::Sin => wave(a, 0.0),
            Function::Cos => wave(a, 1.0),
            _ => function(f, a),
        }
    }

    #[inline(always)]
    fn sine_and_cosine(a: &Self) -> (Self, Self) {
        waves(a)
    }

    #[inline(always)]
    fn noise(table: Option<&NoiseTable>, p: [&Self; 3]) -> Self {
        noise::bounds(table, p)
    }

    #[inline(always)]
    fn nearest(which: Nearest, p: [&Self; 3]) -> Self {
        which.bounds_in_lanes(p)
    }

    #[inline(always)]
    fn compare(c: Comparison, a: &Self, b: &Self) -> Self {
        #[inline(always)]
        fn truth(x: &I8) -> (M8, M8) {
            let zero = F8::ZERO;
            (x.lo.gt(zero) | x.hi.lt(zero), x.lo.equals(zero) & x.hi.equals(zero))
        }
        let (apart, points) = (a.hi.lt(b.lo) | b.hi.lt(a.lo), a.lo.equals(a.hi) & b.lo.equals(b.hi));
        let equal = points & a.lo.equals(b.lo);
        let ((a_is, a_not), (b_is, b_not)) = (truth(a), truth(b));
        let (yes, no) = match c {
            Comparison::Less => (a.hi.lt(b.lo), a.lo.ge(b.hi)),
            Comparison::LessEqual => (a.hi.le(b.lo), a.lo.gt(b.hi)),
            Comparison::Equal => (equal, apart),
            Comparison::NotEqual => (apart, equal),
            Comparison::And => (a_is & b_is, a_not | b_not),
            Comparison::Or => (a_is | b_is, a_not & b_not),
        };
        let mut out = Self::new(F8::ZERO, F8::ZERO).said(a, b);
        (out.lo, out.hi) = (yes.keep(F8::ONE), (!no).keep(F8::ONE));
        out.jump |= (!yes & !no).bits();
        out
    }

    #[inline(always)]
    fn select(c: &Self, below: &Self, at: &Self, above: &Self) -> Self {
        let may_below = c.lo.lt(F8::ZERO).bits();
        let may_at = (c.lo.le(F8::ZERO) & c.hi.ge(F8::ZERO)).bits();
        let may_above = c.hi.gt(F8::ZERO).bits();
        // Usually the case is the same in all lanes.
        match (may_below, may_at, may_above) {
            (_, 0, 0) => return below.said(c, c),
            (0, 0, _) => return above.said(c, c),
            _ => {}
        }
        let mut out = Self::new(F8::splat(f64::INFINITY), F8::splat(f64::NEG_INFINITY)).said(c, c);
        let mut all_empty = 0xff;
        for (may, x) in [(may_below, below), (may_at, at), (may_above, above)] {
            let use_it = M8::from_bits(may & !x.empty);
            out.lo = use_it.select(out.lo.min(x.lo), out.lo);
            out.hi = use_it.select(out.hi.max(x.hi), out.hi);
            out.partial |= may & x.partial;
            out.jump |= may & x.jump;
            all_empty &= !(may & !x.empty);
        }
        let apart = |x: &Self, y: &Self| if core::ptr::eq(x, y) { 0 } else { 0xff };
        out.jump |= may_below & may_at & apart(below, at);
        out.jump |= may_at & may_above & apart(at, above);
        out.jump |= may_below & may_above & apart(below, above);
        out.empty |= all_empty;
        out.partial |= all_empty;
        let none = M8::from_bits(out.empty);
        out.lo = none.select(F8::ZERO, out.lo);
        out.hi = none.select(F8::ZERO, out.hi);
        out
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        let zero = |x: &F8| x.0.iter().all(|&x| x == 0.0);
        self.partial | self.empty | self.jump == 0 && zero(&self.lo) && zero(&self.hi)
    }

    #[inline(always)]
    fn above(a: &Self) -> Option<Self> {
        let certain = a.partial | a.empty == 0 && a.lo.0.iter().all(|&lo| lo > 1.0);
        certain.then(|| Self { hi: F8::splat(f64::INFINITY), ..*a })
    }
}

impl Sloped for I8 {
    #[inline(always)]
    fn noise_and_slopes(table: Option<&NoiseTable>, p: [&Self; 3]) -> (Self, [Self; 3]) {
        noise::slopes(table, p)
    }

    #[inline(always)]
    fn nearest_and_slopes(which: Nearest, p: [&Self; 3]) -> (Self, [Self; 3]) {
        which.slopes_in_lanes(p)
    }
}

/// Reciprocals where the divisor has a zero.
#[cold]
#[inline(never)]
fn holes(inverse: &mut I8, b: &I8, lanes: u8) {
    for i in durer_math::lanes::set_bits(lanes) {
        let (lo, hi) = (b.lo.0[i], b.hi.0[i]);
        if lo == 0.0 && hi == 0.0 {
            inverse.empty |= 1 << i;
            (inverse.lo.0[i], inverse.hi.0[i]) = (0.0, 0.0);
        } else if lo == 0.0 {
            inverse.lo.0[i] = below(1.0 / hi).max(0.0);
        } else if hi == 0.0 {
            inverse.hi.0[i] = above(1.0 / lo).min(0.0);
        }
    }
}

#[inline(always)]
fn cube(a: &I8) -> I8 {
    let mut out = *a;
    for i in 0..LANES {
        let (l, h) = (a.lo.0[i], a.hi.0[i]);
        // Two products, each widened towards the same side.
        out.lo.0[i] =
            if l >= 0.0 { most(below(most(below(l * l), 0.0) * l), 0.0) } else { below(above(l * l) * l) };
        out.hi.0[i] =
            if h <= 0.0 { least(above(most(below(h * h), 0.0) * h), 0.0) } else { above(above(h * h) * h) };
    }
    out
}

/// `x^n` by repeated squaring of non-negative numbers, each product widened up or down.
#[inline(always)]
fn widened(x: &[f64; LANES], n: i32, up: bool) -> [f64; LANES] {
    let (mut result, mut base, mut left) = ([1.0; LANES], *x, n);
    loop {
        for i in 0..LANES {
            let (r, b) = (result[i] * base[i], base[i] * base[i]);
            if left & 1 == 1 {
                result[i] = if up { above(r) } else { most(below(r), 0.0) };
            }
            base[i] = if up { above(b) } else { most(below(b), 0.0) };
        }
        left >>= 1;
        if left == 0 {
            return result;
        }
    }
}

/// `a^n`: powers of the magnitudes of the ends of `a`, rounded down or up, and then the sign.
#[inline(always)]
fn product(a: &I8, n: i32) -> I8 {
    let odd = n & 1 == 1;
    // If the power is even, the ends nearer to zero and farther from it; else the lower and the
    // upper end.
    let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        let (l, h) = (a.lo.0[i], a.hi.0[i]);
        let straddles = (l < 0.0) & (h > 0.0);
        let near = if straddles { 0.0 } else { least(l.abs(), h.abs()) };
        (x[i], y[i]) = if odd { (l.abs(), h.abs()) } else { (near, most(l.abs(), h.abs())) };
    }
    let (x_down, y_up) = (widened(&x, n, false), widened(&y, n, true));
    let mut out = *a;
    if !odd {
        (out.lo, out.hi) = (F8(x_down), F8(y_up));
        return out;
    }
    let (x_up, y_down) = (widened(&x, n, true), widened(&y, n, false));
    for i in 0..LANES {
        out.lo.0[i] = if a.lo.0[i] >= 0.0 { x_down[i] } else { -x_up[i] };
        out.hi.0[i] = if a.hi.0[i] >= 0.0 { y_up[i] } else { -y_down[i] };
    }
    out
}

#[inline(never)]
fn powers(a: &I8, n: i32) -> I8 {
    I8::each(a, |x| x.powi(n))
}

#[inline(never)]
fn pow(a: &I8, b: &I8) -> I8 {
    or_by_itself(a, b, crate::lane_powers::pow(a, b), Interval::pow)
}

/// Completes a packet result: computes the lanes in `left` one by one.
#[inline(always)]
fn or_by_itself(a: &I8, b: &I8, (out, left): (I8, u8), f: impl Fn(Interval, Interval) -> Range) -> I8 {
    let mut out = out.said(a, b);
    for i in durer_math::lanes::set_bits(left & !out.empty) {
        let (range, defined) = f(a.lane(i), b.lane(i));
        out.put(i, range, defined);
    }
    out
}

#[inline(never)]
fn atan2(y: &I8, x: &I8) -> I8 {
    or_by_itself(y, x, crate::lane_angles::atan2(y, x), Interval::atan2)
}

#[inline(never)]
fn rem(a: &I8, b: &I8) -> I8 {
    I8::each2(a, b, Interval::remainder)
}

#[inline(never)]
fn function(f: Function, a: &I8) -> I8 {
    fn whole(f: impl Fn(Interval) -> Interval) -> impl Fn(Interval) -> Range {
        move |x| (f(x), Defined::Continuous)
    }
    match f {
        Function::Sin => I8::each(a, whole(Interval::sin)),
        Function::Cos => I8::each(a, whole(Interval::cos)),
        Function::Tan => I8::each(a, Interval::tan),
        Function::Asin => I8::each(a, Interval::asin),
        Function::Acos => I8::each(a, Interval::acos),
        Function::Atan => I8::each(a, whole(Interval::atan)),
        Function::Sinh => I8::each(a, whole(Interval::sinh)),
        Function::Cosh => I8::each(a, whole(Interval::cosh)),
        Function::Tanh => I8::each(a, whole(Interval::tanh)),
        Function::Asinh => I8::each(a, whole(Interval::asinh)),
        Function::Acosh => I8::each(a, Interval::acosh),
        Function::Atanh => I8::each(a, Interval::atanh),
        Function::Exp => I8::each(a, whole(Interval::exp)),
        Function::Ln => I8::each(a, Interval::ln),
        Function::Log10 => I8::each(a, Interval::log10),
        Function::Floor => I8::each(a, Interval::floor),
        Function::Ceil => I8::each(a, Interval::ceil),
        Function::Trunc => I8::each(a, Interval::trunc),
    }
}
