//! The real roots of a polynomial of degree up to 16 along a ray, each in a proven bracket, in
//! ascending order.
//!
//! The solver is a ladder: f64 with proven errors, then double-double, then exact. Results of a
//! step are final; where it is in doubt, the next step continues from a point at which the sign is
//! certain. The first two steps:
//!
//! 1. The polynomial is put into Bernstein form ([`Bernstein`]) over the stretch of the line where
//!    roots may be. If all coefficients have one sign there is no root. This is the most frequent
//!    case.
//! 2. Exactly one change of sign means one simple root. Otherwise the stretch is halved, the first
//!    half first.
//! 3. A root is found by Newton's method and its bracket proven: by the size of the polynomial and
//!    of its slope (Kantorovich), or by certain signs on either side.
//!
//! The last step, [`ExactRoots`], counts the roots with their multiplicities.
//!
//! For an unbounded surface the line is cut at `s = -1` and `s = 1`; the outer parts are solved in
//! `σ = 1 / s`.

use crate::bernstein::{Bernstein, Count, FLOOR};
use crate::exact::{ExactRoots, Isolated};
use crate::quadratic::Limits;
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use core::cmp::Ordering::{Greater, Less};
use core::ops::ControlFlow;
use durer_math::efloat::Word;
use durer_math::{Dd, Dyadic, EFloat, Isa, Ring, U};

/// A polynomial along a line, in `y = s - mid`, at every step of the ladder; its first coefficient
/// is the constant.
pub trait Along<const N: usize> {
    /// In f64.
    fn double(&self) -> [EFloat; N];
    /// In double-double, times any positive number.
    fn wide(&self) -> Option<[EFloat<Dd>; N]>;
    /// Exactly, times any positive number. The flag is false if that is only a line near the given
    /// one.
    fn exact(&self) -> (Vec<Dyadic>, bool);
}

/// The part of the line where roots may be.
#[derive(Clone, Copy, Debug)]
pub enum Stretch {
    /// Strictly within `half` of `mid`. `half` has at most 8 significant bits.
    Within {
        /// The middle.
        mid: f64,
        /// Half of the width.
        half: f64,
    },
    /// Anywhere.
    Everywhere,
}

/// A root.
pub struct Found<'a> {
    /// The place: a rounded value in the bracket.
    pub s: f64,
    /// The lower end of the bracket.
    pub lo: f64,
    /// The upper end of the bracket.
    pub hi: f64,
    /// There is no other root between these two numbers, so `before` and `after` are the signs of
    /// the polynomial on either side of the root up to there.
    pub alone: (f64, f64),
    /// The sign before the root.
    pub before: Ordering,
    /// The sign after the root.
    pub after: Ordering,
    /// False if the ray's error is too large for certainty.
    pub certain: bool,
    /// How the root was found, if f64 and double-double could not.
    pub exact: Option<(&'a ExactRoots, &'a Isolated)>,
}

/// The map from `x` in `[-1, 1]` to the line.
#[derive(Clone, Copy)]
enum PartToLine {
    /// `s = mid + half x`.
    Linear { mid: f64, half: f64 },
    /// `s = 1 / x`.
    Inverse,
}

impl PartToLine {
    #[inline(always)]
    fn s(self, x: f64) -> f64 {
        match self {
            Self::Linear { mid, half } => half.mul_add(x, mid),
            Self::Inverse => 1.0 / x,
        }
    }

    /// The ends of the image of `[l, r]`, ascending, each with one rounding.
    #[inline(always)]
    fn ends(self, l: f64, r: f64) -> (f64, f64) {
        match self {
            Self::Linear { .. } => (self.s(l), self.s(r)),
            // An end at zero is an end at infinity, on the side of the other.
            Self::Inverse if r > 0.0 => (1.0 / r, 1.0 / l.abs()),
            Self::Inverse => (-1.0 / r.abs(), 1.0 / l),
        }
    }

    /// Whether a bracket is narrow enough: its greatest width in `x`.
    #[inline(always)]
    fn widest(self, x: f64, limits: &Limits) -> f64 {
        match self {
            Self::Linear { half, .. } => {
                let s = self.s(x);
                limits.width * (limits.origin + s).abs().max(s.abs()).max(0.5) / half * (1.0 - 8.0 * U)
            }
            Self::Inverse => limits.width * x.abs() * 0.5,
        }
    }
}

/// The most halvings of a stretch.
const FINEST: u32 = 40;

/// A polynomial in `x` over `[-1, 1]`, with the bound of each coefficient's error.
#[derive(Clone, Copy)]
struct Scaled<T, const N: usize> {
    c: [T; N],
    e: [f64; N],
    /// Coefficients above are zero for certain.
    degree: usize,
}

/// A part `l..r` of the stretch and the polynomial on it. The sign at `l` is certain, unless it is
/// the stretch's own end.
struct BernsteinPart<T, const N: usize> {
    form: Bernstein<T, N>,
    l: f64,
    r: f64,
    /// `l` and `r` are multiples of `2^-bits`.
    bits: u32,
}

/// A doubt: everything up to this `x` is decided.
struct Doubt(f64);

impl<T: Word, const N: usize> Scaled<T, N> {
    /// `a(half x)`.
    #[inline(always)]
    fn new(a: &[EFloat<T>; N], half: f64) -> Self {
        let (h, size) = (T::from(half), half.abs());
        let (mut power, mut big) = (T::from(1.0), 1.0);
        let (mut c, mut e) = ([T::from(0.0); N], [0.0; N]);
        for k in 0..N {
            (c[k], e[k]) = (a[k].v, a[k].e);
        }
        let degree = (0..N).rev().find(|&k| a[k].value() != 0.0 || a[k].e != 0.0).unwrap_or(0);
        for k in 1..N {
            power = power * h;
            big *= size * (1.0 + 2.0 * f64::EPSILON);
            c[k] = c[k] * power;
            // k roundings, of the power and of the product.
            e[k] = e[k].mul_add(big, c[k].to_f64().abs() * (k as f64 * T::MUL) * (1.0 + 64.0 * f64::EPSILON))
                * (1.0 + 8.0 * f64::EPSILON)
                + FLOOR;
        }
        Self { c, e, degree }
    }

    /// The polynomial whose roots are the inverses.
    #[inline(always)]
    fn reversed(&self) -> Self {
        let mut out = Self { c: [T::from(0.0); N], e: [0.0; N], degree: self.degree };
        for k in 0..=self.degree {
            (out.c[k], out.e[k]) = (self.c[self.degree - k], self.e[self.degree - k]);
        }
        out
    }

    /// The part from `l` to 1, again over `[-1, 1]`: shifted (W. G. Horner's scheme), then scaled.
    #[inline(always)]
    fn from(&self, l: f64) -> Self {
        let (mid, half) = (0.5 + 0.5 * l, 0.5 - 0.5 * l);
        let (mut c, mut e, mut big) = (self.c, self.e, [0.0; N]);
        for k in 0..N {
            big[k] = c[k].to_f64().abs();
        }
        for i in 0..N - 1 {
            for j in (i..N - 1).rev() {
                c[j] = c[j] + T::from(mid) * c[j + 1];
                big[j] += mid.abs() * big[j + 1];
                e[j] += mid.abs() * e[j + 1];
            }
        }
        // Two roundings a step, at most N steps a coefficient.
        let unit = 2.0 * N as f64 * (T::ADD + T::MUL);
        let mut a = [EFloat::exact(0.0); N];
        for k in 0..N {
            a[k] =
                EFloat::with_error(c[k], big[k].mul_add(unit, e[k]) * (1.0 + 128.0 * f64::EPSILON) + FLOOR);
        }
        Self::new(&a, half)
    }

    /// The sum of all errors.
    #[inline(always)]
    fn slack(&self) -> f64 {
        self.e.iter().sum::<f64>() * (1.0 + 16.0 * f64::EPSILON)
    }

    /// The value at `x` and a bound on its error: Horner's scheme takes `2 N` roundings.
    #[inline(always)]
    fn at(&self, x: f64) -> EFloat<T> {
        let (t, size) = (T::from(x), x.abs());
        let unit = 2.0 * N as f64 * (T::ADD + T::MUL);
        let (mut v, mut e) = (T::from(0.0), 0.0);
        for k in (0..N).rev() {
            v = v * t + self.c[k];
            e = f64::mul_add(e, size, self.c[k].to_f64().abs().mul_add(unit, self.e[k]));
        }
        EFloat::with_error(v, e * (1.0 + 64.0 * f64::EPSILON) + FLOOR)
    }

    /// The slope at `x`, without an error bound.
    #[inline(always)]
    fn slope(&self, x: f64) -> f64 {
        (1..N).rev().fold(0.0_f64, |sum, k| sum.mul_add(x, k as f64 * self.c[k].to_f64()))
    }

    /// The value at `x`, and whether `x` is behind the root, if that is certain.
    #[inline(always)]
    fn side(&self, x: f64, rising: bool) -> (f64, Option<bool>) {
        let value = self.at(x);
        let sign = value.sign().filter(|s| s.is_ne());
        (value.value(), sign.map(|s| (s == Greater) == rising))
    }

    /// The root between `a` and `b`, where the signs are certain and opposite, in a bracket no
    /// wider than `widest`.
    #[inline(always)]
    fn refine(
        &self,
        (mut a, mut b): (f64, f64),
        rising: bool,
        start: f64,
        widest: impl Fn(f64) -> f64,
    ) -> Option<(f64, f64, f64)> {
        let mut x = start;
        for round in 0..200 {
            if !(x > a && x < b) || round % 4 == 3 {
                x = 0.5 * (a + b);
            }
            let w = widest(x);
            if b - a <= w {
                return Some((self.polished(a, b, rising), a, b));
            }
            let (value, above) = self.side(x, rising);
            let step = value / self.slope(x);
            match above {
                // Newton's step, and a little more, so that the next point is on the other side.
                Some(true) => (b, x) = (x, x - step - 0.25 * w),
                Some(false) => (a, x) = (x, x - step + 0.25 * w),
                None => {
                    let (l, r) = ((x - 0.4 * w).max(a), (x + 0.4 * w).min(b));
                    let low = l <= a || self.side(l, rising).1 == Some(false);
                    let high = r >= b || self.side(r, rising).1 == Some(true);
                    return (low && high).then_some((x, l, r));
                }
            }
        }
        None
    }

    /// The root between `a` and `b`, where the signs are certain, as accurate as possible: the
    /// point stays accurate where far origins allow wide brackets. Newton's steps from the middle
    /// while they shrink, bisection where one would leave the interval.
    #[inline(always)]
    fn polished(&self, mut a: f64, mut b: f64, rising: bool) -> f64 {
        let (mut x, mut last) = (0.5 * (a + b), f64::INFINITY);
        loop {
            let value = self.at(x).value();
            if (value > 0.0) == rising {
                b = x;
            } else {
                a = x;
            }
            let step = value / self.slope(x);
            let newton = x - step;
            let next = if newton >= a && newton <= b { newton } else { 0.5 * (a + b) };
            let way = (next - x).abs();
            if way.partial_cmp(&last) != Some(Less) {
                return x;
            }
            (x, last) = (next, 0.75 * way);
        }
    }

    /// Decides the stretch in ascending order: passes each part with one root to `visit`, until
    /// that stops or is in doubt. Parts for which `skips` returns true are skipped.
    #[inline(always)]
    fn walk(
        &self,
        from: f64,
        cut: bool,
        skips: impl Fn(f64, f64) -> bool,
        mut visit: impl FnMut(&BernsteinPart<T, N>, bool) -> Result<ControlFlow<()>, Doubt>,
    ) -> Result<ControlFlow<()>, Doubt> {
        let slack = self.slack();
        let whole = BernsteinPart { form: Bernstein::new(&self.c, slack), l: from, r: 1.0, bits: 0 };
        let mut open = ArrayVec::<BernsteinPart<T, N>, 64>::new();
        open.push(whole);
        while let Some(node) = open.pop() {
            let across_cut = cut && node.l < 0.0 && node.r > 0.0;
            match node.form.count() {
                Count::None => continue,
                count @ (Count::Rise | Count::Fall) if !across_cut => {
                    if !skips(node.l, node.r) && visit(&node, count == Count::Rise)?.is_break() {
                        return Ok(ControlFlow::Break(()));
                    }
                    continue;
                }
                _ if skips(node.l, node.r) => continue,
                _ => {}
            }
            if node.bits > FINEST || !node.form.tells() {
                return Err(Doubt(node.l));
            }
            // Splits where the sign is certain. There is such a point near the middle, unless all
            // signs are uncertain.
            let parts: &[(f64, u32)] =
                if across_cut { &[(0.5, 1)] } else { &[(0.5, 1), (0.4375, 4), (0.5625, 4)] };
            let split = parts.iter().find_map(|&(part, bits)| {
                let (left, right) = node.form.split(part);
                left.last_is_certain().then_some((part, bits, left, right))
            });
            let Some((part, bits, left, right)) = split else { return Err(Doubt(node.l)) };
            let (m, bits) = (part.mul_add(node.r - node.l, node.l), node.bits + bits);
            open.push(BernsteinPart { form: right, l: m, r: node.r, bits });
            open.push(BernsteinPart { form: left, l: node.l, r: m, bits });
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl<const N: usize> Scaled<f64, N> {
    /// [`Scaled::refine`] without certain signs. Let `|p(x)| <= η`, let the slope at `x` be `g`
    /// within `g / 256`, and let `|p''| <= H` everywhere. If `H δ <= g / 256`, the slope is at
    /// least `g (1 - 1/64)` within `δ = 33/32 η / g` of `x`. So there is one root there, and if
    /// that interval is between `a` and `b` it is the root sought.
    #[inline(always)]
    fn newton(&self, (a, b): (f64, f64), start: f64, widest: impl Fn(f64) -> f64) -> Option<(f64, f64, f64)> {
        let mut x = start;
        let mut last = f64::INFINITY;
        for _ in 0..8 {
            let (mut v, mut slope) = (0.0_f64, 0.0_f64);
            for k in (0..N).rev() {
                slope = slope.mul_add(x, v);
                v = v.mul_add(x, self.c[k]);
            }
            let step = v / slope;
            let next = x - step;
            if !(next > a && next < b) {
                return None;
            }
            x = next;
            // Quadratic convergence: after a step this short the next would be below all errors.
            if step.abs() < 1e-9 || step.abs() >= last {
                break;
            }
            last = 0.5 * step.abs();
        }
        let value = self.at(x);
        let slope = self.slope(x).abs();
        let (mut bend, mut doubt) = (0.0, 0.0);
        for k in 1..N {
            let k_f = k as f64;
            bend += k_f * (k_f - 1.0) * (self.c[k].abs() + self.e[k]);
            doubt += k_f * self.c[k].abs().mul_add(2.0 * N as f64 * U, self.e[k]);
        }
        let eta = value.v.abs() + value.e;
        let delta = eta / slope * (1.0 + 1.0 / 32.0);
        let (l, r) = ((x - delta).next_down(), (x + delta).next_up());
        let proven = bend * delta <= slope / 256.0 && doubt <= slope / 256.0 && l >= a && r <= b;
        (proven && 2.0 * delta <= widest(x)).then_some((x, l, r))
    }
}

/// Whether a polynomial in `y` has no root on `[-half, half]`, where its sign at `-half` is known.
#[inline(always)]
pub fn stays<const N: usize>(a: &[EFloat; N], half: f64, positive: bool) -> bool {
    let scaled = Scaled::<f64, N>::new(a, half);
    Bernstein::quick(&scaled.c, scaled.slack()).stays(positive)
}

/// The state of solving an equation.
struct Work<'w, L: ?Sized, F: ?Sized, const N: usize> {
    line: &'w L,
    limits: &'w Limits,
    emit: &'w mut F,
}

/// The state in the rare steps. Their code is long, so all lines of a degree share one copy of it.
type RareWork<'w, const N: usize> =
    Work<'w, dyn Along<N> + 'w, dyn FnMut(&Found<'_>) -> ControlFlow<()> + 'w, N>;

/// Passes every root of the line to `emit`, ascending, until that stops. Roots outside the limits
/// may be left out.
#[inline(always)]
pub fn solve<const N: usize, L: Along<N>>(
    line: &L,
    stretch: Stretch,
    limits: &Limits,
    mut emit: impl FnMut(&Found<'_>) -> ControlFlow<()>,
) {
    let a = line.double();
    match stretch {
        Stretch::Within { mid, half } => {
            let scaled = Scaled::<f64, N>::new(&a, half);
            // The common case: no root at all.
            if Bernstein::quick(&scaled.c, scaled.slack()).count() == Count::None {
                return;
            }
            Work::<_, _, N> { line, limits, emit: &mut emit }.within(&scaled, mid, half);
        }
        Stretch::Everywhere => {
            RareWork::<N> { line, limits, emit: &mut emit }.everywhere(&a);
        }
    }
}

impl<L: Along<N>, F: FnMut(&Found<'_>) -> ControlFlow<()>, const N: usize> Work<'_, L, F, N> {
    /// Solves within `half` of `mid`.
    #[inline(always)]
    fn within(&mut self, scaled: &Scaled<f64, N>, mid: f64, half: f64) {
        let place = PartToLine::Linear { mid, half };
        if let Err(Doubt(x)) = self.settle_double(scaled, place) {
            RareWork { line: self.line, limits: self.limits, emit: self.emit }.climb(place, x);
        }
    }
}

impl<L, F, const N: usize> Work<'_, L, F, N>
where
    L: Along<N> + ?Sized,
    F: FnMut(&Found<'_>) -> ControlFlow<()> + ?Sized,
{
    /// Solves a stretch in f64, from its start.
    #[inline(always)]
    fn settle_double(
        &mut self,
        scaled: &Scaled<f64, N>,
        place: PartToLine,
    ) -> Result<ControlFlow<()>, Doubt> {
        let (limits, emit) = (self.limits, &mut self.emit);
        scaled.walk(
            -1.0,
            false,
            #[inline(always)]
            |l, r| is_skipped(place, limits, l, r),
            #[inline(always)]
            |node, rising| {
                let ends = (node.l, node.r);
                let start = node.form.guess().mul_add(node.r - node.l, node.l);
                // Each closure here is a caller's argument, or it would be compiled by itself,
                // without fused sums.
                let newton = scaled.newton(
                    ends,
                    start,
                    #[inline(always)]
                    |x| place.widest(x, limits),
                );
                let found = match newton {
                    None => scaled.refine(
                        ends,
                        rising,
                        start,
                        #[inline(always)]
                        |x| place.widest(x, limits),
                    ),
                    found => found,
                };
                let found = found.ok_or(Doubt(node.l))?;
                Ok(emit(&named(place, ends, found, rising)))
            },
        )
    }
}

impl<const N: usize> RareWork<'_, N> {
    /// Continues after f64, from `x` on.
    #[cold]
    #[inline(never)]
    fn climb(&mut self, place: PartToLine, x: f64) {
        let PartToLine::Linear { mid, half } = place else { return };
        let doubt = Isa::detect().run(
            #[inline(always)]
            || match self.line.wide() {
                Some(a) => self.settle(&Scaled::new(&a, half), x, place).err(),
                None => Some(Dyadic::from(x)),
            },
        );
        if let Some(x) = doubt {
            self.exactly(mid, &x * &Dyadic::from(half), half);
        }
    }

    /// Solves a stretch from `from` on. The place of a doubt is exact, because f64 might round it
    /// beyond a root that is not found yet.
    #[inline(always)]
    fn settle<T: Word>(
        &mut self,
        scaled: &Scaled<T, N>,
        from: f64,
        place: PartToLine,
    ) -> Result<ControlFlow<()>, Dyadic> {
        let (limits, emit) = (self.limits, &mut self.emit);
        let part = if from > -1.0 { scaled.from(from) } else { *scaled };
        let walked = part.walk(
            -1.0,
            false,
            #[inline(always)]
            |l, r| is_skipped(place, limits, back(from, l), back(from, r)),
            #[inline(always)]
            |node, rising| {
                let ends = (back(from, node.l), back(from, node.r));
                let start = 0.5 * (ends.0 + ends.1);
                let found = scaled.refine(
                    ends,
                    rising,
                    start,
                    #[inline(always)]
                    |x| place.widest(x, limits),
                );
                let found = found.ok_or(Doubt(node.l))?;
                Ok(emit(&named(place, ends, found, rising)))
            },
        );
        walked.map_err(|Doubt(x)| exactly_back(from, x))
    }

    /// Solves the whole line: the parts left of -1, between, and right of 1.
    #[inline(never)]
    fn everywhere(&mut self, a: &[EFloat; N]) {
        let doubt = Isa::detect().run(
            #[inline(always)]
            || self.everywhere_but_exactly(&Scaled::new(a, 1.0)),
        );
        if let Some(from) = doubt {
            self.exactly(0.0, from, f64::MAX);
        }
    }

    /// Solves the whole line; returns the place of the first doubt, if there is one.
    #[inline(always)]
    fn everywhere_but_exactly(&mut self, scaled: &Scaled<f64, N>) -> Option<Dyadic> {
        let tails = match self.tails(scaled) {
            Some(tails) => Some(tails),
            None => self.line.wide().and_then(|a| self.tails(&Scaled::new(&a, 1.0))),
        };
        let Some(tails) = tails else {
            return Some(Dyadic::from(f64::MIN));
        };
        for &(ends, found, rising) in tails.iter().rev().filter(|t| t.0.1 <= 0.0) {
            if (self.emit)(&named(PartToLine::Inverse, ends, found, rising)).is_break() {
                return None;
            }
        }
        let place = PartToLine::Linear { mid: 0.0, half: 1.0 };
        match self.settle_double(scaled, place) {
            Ok(ControlFlow::Break(())) => return None,
            Ok(ControlFlow::Continue(())) => {}
            Err(Doubt(x)) => {
                let wide = self.line.wide().map(|a| Scaled::new(&a, 1.0));
                match wide.map_or_else(|| Err(Dyadic::from(x)), |wide| self.settle(&wide, x, place)) {
                    Ok(ControlFlow::Break(())) => return None,
                    Ok(ControlFlow::Continue(())) => {}
                    Err(x) => return Some(x),
                }
            }
        }
        for &(ends, found, rising) in tails.iter().rev().filter(|t| t.0.0 >= 0.0) {
            if (self.emit)(&named(PartToLine::Inverse, ends, found, rising)).is_break() {
                break;
            }
        }
        None
    }

    /// The roots beyond -1 and 1, as inverses, ascending; `None` if there is a doubt.
    #[inline(always)]
    fn tails<T: Word>(&self, scaled: &Scaled<T, N>) -> Option<ArrayVec<Tail, 32>> {
        let reversed = scaled.reversed();
        let mut out = ArrayVec::new();
        let limits = self.limits;
        let skips = |l: f64, r: f64| {
            !(l < 0.0 && r > 0.0) && {
                let (lo, hi) = PartToLine::Inverse.ends(l, r);
                hi.next_up() < limits.lo || lo.next_down() > limits.hi
            }
        };
        let walked = reversed.walk(
            -1.0,
            true,
            skips,
            #[inline(always)]
            |node, rising| {
                let ends = (node.l, node.r);
                let widest = |x: f64| PartToLine::Inverse.widest(x, limits);
                let found =
                    reversed.refine(ends, rising, 0.5 * (node.l + node.r), widest).ok_or(Doubt(node.l))?;
                // p(s) = s^n q(1 / s): on the negative side an odd degree turns the sign; and σ
                // falls as s rises.
                let turned = ends.1 <= 0.0 && scaled.degree % 2 == 1;
                out.push((ends, found, rising == turned));
                Ok(ControlFlow::Continue(()))
            },
        );
        walked.is_ok().then_some(out)
    }

    /// Solves exactly, between `from` and `to` of `y = s - mid`.
    #[cold]
    #[inline(never)]
    fn exactly(&mut self, mid: f64, from: Dyadic, to: f64) {
        let (coefficients, certain) = self.line.exact();
        let Some(exact) = ExactRoots::new(coefficients) else { return };
        let (from, to) = (exact.beside_exact(from, -1.0), exact.beside(to, 1.0));
        let width = if self.limits.width < 1.0 { self.limits.width } else { U };
        for mut root in exact.isolate(&from, &to) {
            let enough = |lo: f64, hi: f64| {
                let s = mid + lo;
                hi - lo <= 0.5 * width * s.abs().max(0.5)
            };
            let (lo, hi) = exact.bracket(&mut root, enough);
            let (lo, hi) = if mid == 0.0 { (lo, hi) } else { ((mid + lo).next_down(), (mid + hi).next_up()) };
            let alone = (f64::INFINITY, f64::NEG_INFINITY);
            let (before, after) = (root.before, root.after);
            let s = if lo == hi { lo } else { (lo + 0.5 * (hi - lo)).clamp(lo, hi) };
            let exact = Some((&exact, &root));
            let found = Found { s, lo, hi, alone, before, after, certain, exact };
            if (self.emit)(&found).is_break() {
                return;
            }
        }
    }
}

/// Ends, root with its bracket, whether the polynomial rises with `s`.
type Tail = ((f64, f64), (f64, f64, f64), bool);

/// Whether a part of a stretch is outside the limits.
#[inline(always)]
fn is_skipped(place: PartToLine, limits: &Limits, l: f64, r: f64) -> bool {
    let (lo, hi) = place.ends(l, r);
    hi.next_up() < limits.lo || lo.next_down() > limits.hi
}

/// Converts `x` in `[-1, 1]` over the part of a stretch from `from` on to the whole stretch:
/// `from + (1 - from)(x + 1) / 2`.
#[inline(always)]
fn back(from: f64, x: f64) -> f64 {
    (0.5 - 0.5 * from).mul_add(x + 1.0, from)
}

/// [`back`], exactly.
fn exactly_back(from: f64, x: f64) -> Dyadic {
    let (from, one) = (Dyadic::from(from), Dyadic::from(1.0));
    let part = &(&one - &from) * &(&Dyadic::from(x) + &one);
    &from + &part.scale2(-1)
}

/// Converts a root to the line's parameter.
#[inline(always)]
fn named<'a>(place: PartToLine, ends: (f64, f64), (x, a, b): (f64, f64, f64), rising: bool) -> Found<'a> {
    let (lo, hi) = place.ends(a, b);
    let (l, r) = place.ends(ends.0, ends.1);
    let (lo, hi) = (lo.next_down(), hi.next_up());
    let (before, after) = if rising { (Less, Greater) } else { (Greater, Less) };
    let alone = (l.next_up(), r.next_down());
    Found { s: place.s(x).clamp(lo, hi), lo, hi, alone, before, after, certain: true, exact: None }
}
