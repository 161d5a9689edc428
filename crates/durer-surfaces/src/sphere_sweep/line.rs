//! One piece of a sweep and a line: the runs of balls that the line meets, and proven ends of each
//! run's interval. In f64 and, by the same code, in double-double.
#![expect(clippy::needless_range_loop, reason = "several arrays have the same axes and powers")]

use super::SphereSweep;
use super::spline::Basis;
use crate::CentredRay;
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use durer_math::efloat::Word;
use durer_math::{Dd, EFloat, Ring, U};
use durer_roots::bernstein::{Bernstein, Count};

/// The most halvings of a stretch of a piece to find the signs of `D`.
const FINEST: u32 = 40;
/// The most halvings of a stretch of a piece to prove a polynomial positive.
const DEEPEST: u32 = 30;
/// The most runs of a piece: `D` has six roots at most.
pub(super) const MOST: usize = 4;
/// Covers the rounding of a few f64 operations on bounds.
const ROUNDED: f64 = 1.0 + 64.0 * U;

/// Numbers of this precision leave the answer open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubt;

/// A line in the frame of the sweep, in units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<T> {
    o: [EFloat<T>; 3],
    d: [EFloat<T>; 3],
    /// `d²`.
    a: EFloat<T>,
    inverse_d2: f64,
}

impl<T: Word> Line<T> {
    #[inline(always)]
    fn new(o: [EFloat<T>; 3], d: [EFloat<T>; 3], inverse_d2: f64) -> Self {
        Self { o, d, a: dot(&d, &d), inverse_d2 }
    }
}

impl Line<f64> {
    #[inline(always)]
    pub(super) fn double(at: &CentredRay<'_>) -> Self {
        let with = EFloat::<f64>::with_error;
        let o = [with(at.o.x, at.o_err.x), with(at.o.y, at.o_err.y), with(at.o.z, at.o_err.z)];
        let d = [with(at.d.x, at.d_err.x), with(at.d.y, at.d_err.y), with(at.d.z, at.d_err.z)];
        Self::new(o, d, at.inverse_d2())
    }
}

impl Line<Dd> {
    pub(super) fn wide(at: &CentredRay<'_>) -> Option<Self> {
        let ray = at.in_double()?;
        let w = ray.w;
        Some(Self::new(ray.o.map(|x| x / w), ray.d.map(|x| x / w), at.inverse_d2()))
    }
}

#[inline(always)]
fn dot<T: Ring>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
}

/// The value of a polynomial, rounded.
#[inline(always)]
pub(super) fn value<const N: usize>(c: &[f64; N], x: f64) -> f64 {
    let mut sum = 0.0_f64;
    for k in (0..N).rev() {
        sum = sum.mul_add(x, c[k]);
    }
    sum
}

/// The value and the first two derivatives, rounded.
#[inline(always)]
fn slopes<const N: usize>(c: &[f64; N], x: f64) -> (f64, f64, f64) {
    let (mut v, mut v1, mut v2) = (0.0_f64, 0.0_f64, 0.0_f64);
    for k in (0..N).rev() {
        v2 = v2.mul_add(x, 2.0 * v1);
        v1 = v1.mul_add(x, v);
        v = v.mul_add(x, c[k]);
    }
    (v, v1, v2)
}

/// A piece: centre and radius as polynomials in `x`, from -1 to 1, relative to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve<T, const K: usize> {
    pub(super) c: [[EFloat<T>; K]; 3],
    pub(super) r: [EFloat<T>; K],
}

impl<T: Word, const K: usize> Curve<T, K> {
    /// Piece `number` in units, relative to `origin(c)`, where `c` is one of the sweep's own points
    /// in units.
    #[inline(always)]
    pub(super) fn new<const M: usize>(
        sweep: &SphereSweep,
        basis: &Basis<K, M>,
        points: &[[f64; 4]; K],
        origin: impl FnOnce(&[EFloat<T>; 3]) -> [EFloat<T>; 3],
    ) -> Self {
        let exact = EFloat::<T>::exact;
        let base = &points[K / 2];
        let k = -sweep.scale;
        let mut at = [exact(0.0); 3];
        let mut c = [[exact(0.0); K]; 3];
        let mut r = [exact(0.0); K];
        for (i, p) in points.iter().enumerate() {
            for axis in 0..3 {
                c[axis][i] = (exact(p[axis]) - exact(base[axis])).scale2(k);
            }
            r[i] = exact(p[3]).scale2(k);
        }
        for axis in 0..3 {
            at[axis] = (exact(base[axis]) - exact(sweep.centre[axis])).scale2(k);
        }
        let third = if basis.weight == 3.0 { Some(exact(1.0) / exact(3.0)) } else { None };
        let from = origin(&at);
        let mut out = Self { c, r };
        for axis in 0..3 {
            out.c[axis] = basis.coefficients(&c[axis]);
        }
        out.r = basis.coefficients(&r);
        if let Some(third) = third {
            for i in 0..K {
                for axis in 0..3 {
                    out.c[axis][i] = out.c[axis][i] * third;
                }
                out.r[i] = out.r[i] * third;
            }
        }
        for axis in 0..3 {
            out.c[axis][0] = out.c[axis][0] - from[axis];
        }
        out
    }

    /// The coefficients of `|c|² - r²` without the terms of `c` and `r` of degrees below `from`.
    #[inline(always)]
    fn square<const M: usize>(&self, from: usize) -> [EFloat<T>; M] {
        let mut out = [EFloat::<T>::exact(0.0); M];
        for i in from..K {
            for j in i..K {
                let (c, r) = (&self.c, &self.r);
                let term = c[0][i] * c[0][j] + c[1][i] * c[1][j] + c[2][i] * c[2][j] - r[i] * r[j];
                out[i + j] = out[i + j] + if i == j { term } else { term.scale2(1) };
            }
        }
        out
    }

    /// The curve in `z`, with `x = at + z`.
    #[inline(always)]
    fn moved(&self, at: f64) -> Self {
        let at = EFloat::<T>::exact(at);
        let mut out = *self;
        for axis in 0..4 {
            let c = if axis < 3 { &mut out.c[axis] } else { &mut out.r };
            for i in 0..K - 1 {
                for j in (i..K - 1).rev() {
                    c[j] = c[j] + at * c[j + 1];
                }
            }
        }
        out
    }

    /// `|c - s d|² - r²`, and its slope in `s` without an error bound; `high` has the terms that do
    /// not depend on `s`.
    #[inline(always)]
    fn around<const M: usize>(
        &self,
        high: &[EFloat<T>; M],
        d: &[EFloat<T>; 3],
        s: f64,
    ) -> ([EFloat<T>; M], f64) {
        let (mut w, s) = ([EFloat::<T>::exact(0.0); 3], EFloat::<T>::exact(s));
        for axis in 0..3 {
            w[axis] = self.c[axis][0] - s * d[axis];
        }
        let mut p = *high;
        p[0] = dot(&w, &w) - self.r[0] * self.r[0];
        for k in 1..K {
            let c = [self.c[0][k], self.c[1][k], self.c[2][k]];
            p[k] = p[k] + (dot(&w, &c) - self.r[0] * self.r[k]).scale2(1);
        }
        let slope = -2.0 * dot(&w, d).value();
        (p, slope)
    }

    /// The sign of the distance from the origin to the union of the piece's balls: positive
    /// outside. `None` if that is not certain.
    #[inline(always)]
    pub(super) fn side<const M: usize>(&self) -> Option<Ordering> {
        let p = self.square::<M>(0);
        match bernstein_positive(&p, -1.0, 1.0) {
            Positive::Yes => Some(Ordering::Greater),
            Positive::NotAt(_) => Some(Ordering::Less),
            Positive::Unknown => None,
        }
    }

    /// `c` and `r` at `x`, and `c'` and `r'`: rounded.
    #[inline(always)]
    pub(super) fn place(&self, x: f64) -> ([f64; 3], f64, [f64; 3], f64) {
        #[inline(always)]
        fn axis<T: Word, const K: usize>(c: &[EFloat<T>; K], x: f64) -> (f64, f64, f64) {
            let mut v = [0.0; K];
            for (v, c) in v.iter_mut().zip(c) {
                *v = c.value();
            }
            slopes(&v, x)
        }
        let [cx, cy, cz] = &self.c;
        let [x, y, z, r] = [axis(cx, x), axis(cy, x), axis(cz, x), axis(&self.r, x)];
        ([x.0, y.0, z.0], r.0, [x.1, y.1, z.1], r.1)
    }

    /// For the origin: the coefficients of `|c|² - r²` in `z`, with `x = at + z`.
    #[inline(always)]
    pub(super) fn about<const M: usize>(&self, at: f64) -> [EFloat<T>; M] {
        self.moved(at).square(0)
    }
}

/// The width of brackets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widths {
    /// `t = 2^k (origin + s)`.
    pub(super) origin: f64,
    /// Half the requested width, and half the largest width that counts as a proof, both relative
    /// to the larger one of `t` and the size.
    pub(super) half: f64,
    pub(super) most: f64,
}

impl Widths {
    /// The unit for widths at `s`.
    #[inline(always)]
    pub(super) fn scale(&self, s: f64) -> f64 {
        (self.origin + s).abs().max(s.abs()).max(0.5)
    }
}

/// The end of the interval of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunEnd {
    pub(super) s: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// The ball, by its piece and `x`.
    pub(super) ball: (u32, f64),
}

/// Consecutive balls of one piece that the line meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// `D` is positive at some `x` in between, and certainly negative at `from` and `to`, except at
    /// ends of the piece at which the run continues.
    from: f64,
    to: f64,
    /// Whether the run holds the first ball of the piece, and the last one.
    pub(super) first: bool,
    pub(super) last: bool,
    /// Two `x` at which `D` is certainly positive.
    sure: [f64; 2],
}

/// A piece relative to a line.
pub(super) struct PieceLine<T, const K: usize, const M: usize> {
    number: u32,
    /// Relative to the line's point at `step`.
    curve: Curve<T, K>,
    line: Line<T>,
    step: f64,
    /// `d·c` and `D`, rounded.
    b: [f64; K],
    disc: [f64; M],
    form: Bernstein<T, M>,
}

impl<T: Word, const K: usize, const M: usize> PieceLine<T, K, M> {
    #[inline(always)]
    pub(super) fn new(
        sweep: &SphereSweep,
        basis: &Basis<K, M>,
        line: &Line<T>,
        number: u32,
        points: &[[f64; 4]; K],
    ) -> Self {
        let mut step = 0.0;
        let curve = Curve::new(
            sweep,
            basis,
            points,
            #[inline(always)]
            |at| {
                let mut way = 0.0;
                for axis in 0..3 {
                    way += (at[axis].value() - line.o[axis].value()) * line.d[axis].value();
                }
                step = way * line.inverse_d2;
                let mut from = *at;
                for axis in 0..3 {
                    let moved = line.o[axis] + EFloat::exact(step) * line.d[axis];
                    from[axis] = moved - at[axis];
                }
                from
            },
        );
        let mut b = [EFloat::<T>::exact(0.0); K];
        for (k, b) in b.iter_mut().enumerate() {
            *b = dot(&line.d, &[curve.c[0][k], curve.c[1][k], curve.c[2][k]]);
        }
        let square = curve.square::<M>(0);
        let mut disc = [EFloat::<T>::exact(0.0); M];
        for i in 0..K {
            for j in i..K {
                let term = b[i] * b[j];
                disc[i + j] = disc[i + j] + if i == j { term } else { term.scale2(1) };
            }
        }
        let (mut values, mut slack) = ([T::from(0.0); M], 0.0);
        let mut rounded = [0.0; M];
        for k in 0..M {
            let it = disc[k] - line.a * square[k];
            (values[k], rounded[k]) = (it.v, it.value());
            slack += it.e;
        }
        let mut b_rounded = [0.0; K];
        for k in 0..K {
            b_rounded[k] = b[k].value();
        }
        let form = Bernstein::new(&values, slack * ROUNDED);
        Self { number, curve, line: *line, step, b: b_rounded, disc: rounded, form }
    }

    /// Whether the line certainly meets none of the balls.
    #[inline(always)]
    pub(super) fn misses(&self) -> bool {
        self.form.one_sign() == Some(false)
    }

    /// The runs, ascending.
    #[inline(always)]
    pub(super) fn runs(&self) -> Result<ArrayVec<Run, MOST>, Doubt> {
        let mut runs = ArrayVec::new();
        let mut current: Option<Run> = None;
        let begin =
            |from: f64, first: bool, sure: f64| Run { from, to: 1.0, first, last: false, sure: [sure, sure] };
        let mut open = ArrayVec::<(Bernstein<T, M>, f64, f64, u32), 64>::new();
        open.push((self.form, -1.0, 1.0, 0));
        while let Some((form, l, r, bits)) = open.pop() {
            match form.count() {
                Count::None if form.b[0].to_f64() > 0.0 => {
                    let run = current.get_or_insert_with(|| begin(l, true, l));
                    run.sure[1] = r;
                }
                Count::None => {}
                Count::Rise => current = Some(begin(l, false, r)),
                Count::Fall => {
                    let mut run = current.take().unwrap_or_else(|| begin(l, true, l));
                    (run.to, run.sure[1]) = (r, l);
                    runs.try_push(run).map_err(|_| Doubt)?;
                }
                Count::Open => {
                    if bits > FINEST || !form.tells() {
                        return Err(Doubt);
                    }
                    // Splits where the sign is certain. There is such a point near the middle,
                    // unless all signs are uncertain.
                    let mut split = None;
                    for (part, more) in [(0.5, 1), (0.4375, 4), (0.5625, 4)] {
                        if split.is_none() {
                            let (left, right) = form.split(part);
                            if left.last_is_certain() {
                                split = Some((part, more, left, right));
                            }
                        }
                    }
                    let Some((part, more, left, right)) = split else { return Err(Doubt) };
                    let m = part.mul_add(r - l, l);
                    open.try_push((right, m, r, bits + more)).map_err(|_| Doubt)?;
                    open.try_push((left, l, m, bits + more)).map_err(|_| Doubt)?;
                }
            }
        }
        if let Some(mut run) = current {
            (run.to, run.last) = (1.0, true);
            runs.try_push(run).map_err(|_| Doubt)?;
        }
        Ok(runs)
    }

    /// `±(d·c) + √D` and whether it rises with `x`; `None` where `D < 0`.
    #[inline(always)]
    fn reach(&self, x: f64, sign: f64) -> Option<f64> {
        let disc = value(&self.disc, x);
        (disc >= 0.0).then(|| sign.mul_add(value(&self.b, x), disc.sqrt()))
    }

    /// `x` and its reach, if that is greater than the best one's.
    #[inline(always)]
    fn better(&self, best: (f64, f64), x: f64, sign: f64) -> (f64, f64) {
        match self.reach(x, sign) {
            Some(found) if found > best.1 => (x, found),
            _ => best,
        }
    }

    /// Whether `±(d·c) + √D` rises at `x`, and Newton's step to where it is greatest.
    #[inline(always)]
    fn climb(&self, x: f64, sign: f64) -> (bool, f64) {
        let (disc, disc1, disc2) = slopes(&self.disc, x);
        let (_, b1, b2) = slopes(&self.b, x);
        let root = disc.max(0.0).sqrt();
        let up = (2.0 * sign * b1).mul_add(root, disc1);
        let bend = 2.0 * sign * (b2 * root + 0.5 * b1 * disc1 / root) + disc2;
        (up > 0.0, -up / bend)
    }

    /// Approximates the ball of a run that reaches farthest: `sign` is 1 for the greatest `s`, -1
    /// for the least. `hint` is one more ball to try.
    #[inline(always)]
    fn farthest(&self, run: &Run, sign: f64, hint: Option<f64>) -> f64 {
        let count = if K == 2 {
            3
        } else if hint.is_some() {
            33
        } else {
            7
        };
        let (from, to) = (run.from, run.to);
        let step = (to - from) / f64::from(count + 1);
        // The best one, and those before and after it.
        let sure = run.sure[0];
        let mut best = (sure, self.reach(sure, sign).unwrap_or(f64::NEG_INFINITY));
        best = self.better(best, run.sure[1], sign);
        if run.first {
            best = self.better(best, from, sign);
        }
        if run.last {
            best = self.better(best, to, sign);
        }
        for i in 1..=count {
            best = self.better(best, f64::from(i).mul_add(step, from), sign);
        }
        if let Some(hint) = hint {
            best = self.better(best, hint, sign);
        }
        let start = best.0;
        let (mut l, mut r) = ((start - step).max(from), (start + step).min(to));
        let mut x = start;
        for round in 0..60 {
            let inside = self.reach(x, sign).is_some();
            let (rises, newton) = if inside { self.climb(x, sign) } else { (x < run.sure[0], f64::NAN) };
            if rises {
                l = x;
            } else {
                r = x;
            }
            if r - l < 1e-12 || (rises && x >= to) || (!rises && x <= from) {
                return if x >= to || x <= from { x } else { 0.5 * (l + r) };
            }
            let next = x + newton;
            // Quadratic convergence: the step after this one would be below all errors.
            if newton.abs() < 1e-8 {
                return next.clamp(from, to);
            }
            x = if next > l && next < r && round % 8 != 7 {
                next
            } else if round == 0 && rises && r >= to && run.last {
                to
            } else if round == 0 && !rises && l <= from && run.first {
                from
            } else {
                0.5 * (l + r)
            };
        }
        x
    }

    /// The least or greatest `s` of a run, in a proven bracket: one end is beyond all balls of the
    /// run, the other within one.
    #[inline(always)]
    pub(super) fn end(&self, run: &Run, sign: f64, widths: &Widths) -> Result<RunEnd, Doubt> {
        let mut hint = None;
        for _ in 0..8 {
            let x = self.farthest(run, sign, hint);
            match self.end_near(run, x, sign, widths) {
                Ok(end) => return Ok(end),
                Err(Some(better)) => hint = Some(better),
                Err(None) => return Err(Doubt),
            }
        }
        Err(Doubt)
    }

    /// [`PieceLine::end`] for an approximate ball. The error may name a ball that reaches farther.
    #[inline(always)]
    fn end_near(&self, run: &Run, x: f64, sign: f64, widths: &Widths) -> Result<RunEnd, Option<f64>> {
        let here = self.curve.moved(x);
        let high = here.square::<M>(1);
        let Some(reach) = self.reach(x, sign) else { return Err(None) };
        let mut s = sign * reach * self.line.inverse_d2;
        let mut off = 0.0;
        for _ in 0..3 {
            let (p, slope) = here.around(&high, &self.line.d, s);
            // The least value near here.
            let (p1, p2) = (p[1].value(), p[2].value());
            let dip = if x > -1.0 && x < 1.0 && p2 > 0.0 { p1 * p1 / (4.0 * p2) } else { 0.0 };
            let least = p[0].value() - dip;
            let newton = least / slope;
            off = (least.abs() + 2.0 * p[0].e + dip) / slope.abs();
            if !(newton.abs() < 1.0 && slope * sign > 0.0) {
                break;
            }
            s -= newton;
            if newton.abs() <= 4.0 * U * s.abs() {
                break;
            }
        }
        let scale = widths.scale(self.step + s);
        let most = widths.most * scale;
        let mut half = (widths.half * scale).max(if off.is_finite() { 1.5 * off } else { 0.0 });
        while half <= most {
            let (within, beyond) = (s - sign * half, s + sign * half);
            let inside = here.around(&high, &self.line.d, within).0[0].sign() == Some(Ordering::Less);
            let there = here.around(&high, &self.line.d, beyond).0;
            let outside = match (inside, self.beyond(&there, run, x)) {
                (true, Positive::NotAt(z)) => return Err(Some((x + z).clamp(-1.0, 1.0))),
                (true, Positive::Yes) => true,
                _ => false,
            };
            if outside {
                let (lo, hi) = (within.min(beyond), within.max(beyond));
                return Ok(RunEnd {
                    s: self.step + s,
                    lo: (self.step + lo).next_down(),
                    hi: (self.step + hi).next_up(),
                    ball: (self.number, x),
                });
            }
            half *= 3.0;
        }
        Err(None)
    }

    /// Whether a polynomial in `z = x' - x` is positive for all balls of a run.
    #[inline(always)]
    fn beyond(&self, p: &[EFloat<T>; M], run: &Run, x: f64) -> Positive {
        positive(p, (run.from - x).next_down(), (run.to - x).next_up(), run.from == x, run.to == x)
    }
}

/// Whether a polynomial is positive over an interval.
#[derive(Clone, Copy, Debug)]
enum Positive {
    Yes,
    /// It is negative here.
    NotAt(f64),
    Unknown,
}

/// Whether a polynomial in `z` is positive from `l` to `r`; zero is in between, and the value at
/// zero may be arbitrarily small.
///
/// Near zero, within `ρ`, it is at least `p_0 - |p_1 z| + κ z²` with
/// `κ = p_2 - Σ_(k>2) |p_k| ρ^(k-2)`; the Bernstein form decides the rest.
#[inline(always)]
fn positive<T: Word, const M: usize>(
    p: &[EFloat<T>; M],
    l: f64,
    r: f64,
    at_left: bool,
    at_right: bool,
) -> Positive {
    let least = p[0].lo();
    if p[0].hi() < 0.0 {
        return Positive::NotAt(0.0);
    }
    if least.partial_cmp(&0.0) != Some(Ordering::Greater) {
        return Positive::Unknown;
    }
    // How fast it may fall to either side, and how fast it certainly rises if there is only one
    // side.
    let (to_left, to_right) = (p[1].hi(), -p[1].lo());
    let (fall, rise) = match (at_left, at_right) {
        (true, _) => (to_right, -to_right),
        (_, true) => (to_left, -to_left),
        _ => (to_left.max(to_right), 0.0),
    };
    let (fall, rise) = (fall.max(0.0), rise.max(0.0));
    let mut rho = l.abs().max(r);
    let mut clear = false;
    for _ in 0..24 {
        let mut tail = 0.0;
        for k in (3..M).rev() {
            tail = (tail + p[k].magnitude()) * rho * ROUNDED;
        }
        let kappa = p[2].lo() - tail * ROUNDED;
        let margin = 1.0 - 1.0 / 1024.0;
        clear = if kappa > 0.0 {
            fall * fall <= 4.0 * kappa * least * margin
        } else {
            rise * margin >= -kappa * rho || fall.mul_add(rho, -kappa * rho * rho) <= least * margin
        };
        if clear {
            break;
        }
        rho *= 0.25;
    }
    if !clear {
        return bernstein_positive(p, l, r);
    }
    // The ends of the piece are exact.
    let rho = rho * (1.0 - 4.0 * U);
    for (a, b) in [(l, -rho), (rho, r)] {
        if a < b {
            match bernstein_positive(p, a, b) {
                Positive::Yes => {}
                other => return other,
            }
        }
    }
    Positive::Yes
}

/// Whether a polynomial is positive from `a` to `b`, by its Bernstein form.
#[inline(always)]
fn bernstein_positive<T: Word, const M: usize>(p: &[EFloat<T>; M], a: f64, b: f64) -> Positive {
    let mid = 0.5 * (a + b);
    let half = (b - mid).max(mid - a).next_up();
    let (at, mut c) = (EFloat::<T>::exact(mid), *p);
    if mid != 0.0 {
        for i in 0..M - 1 {
            for j in (i..M - 1).rev() {
                c[j] = c[j] + at * c[j + 1];
            }
        }
    }
    let (mut values, mut slack) = ([T::from(0.0); M], 0.0);
    let (mut power, half_exact) = (EFloat::<T>::exact(1.0), EFloat::<T>::exact(half));
    for k in 0..M {
        let it = if k == 0 { c[0] } else { c[k] * power };
        power = power * half_exact;
        values[k] = it.v;
        slack += it.e;
    }
    let mut open = ArrayVec::<(Bernstein<T, M>, f64, f64, u32), 64>::new();
    open.push((Bernstein::new(&values, slack * ROUNDED), -1.0, 1.0, 0));
    while let Some((form, l, r, depth)) = open.pop() {
        match form.one_sign() {
            Some(true) => continue,
            Some(false) => return Positive::NotAt(half.mul_add(0.5 * (l + r), mid)),
            None => {}
        }
        let e = form.e * (1.0 + 4.0 * f64::EPSILON);
        if form.b[0].to_f64() < -e {
            return Positive::NotAt(half.mul_add(l, mid));
        }
        if form.b[M - 1].to_f64() < -e {
            return Positive::NotAt(half.mul_add(r, mid));
        }
        if depth >= DEEPEST || !form.tells() {
            return Positive::Unknown;
        }
        let (left, right) = form.split(0.5);
        let m = 0.5 * (l + r);
        if open.try_push((right, m, r, depth + 1)).is_err() || open.try_push((left, l, m, depth + 1)).is_err()
        {
            return Positive::Unknown;
        }
    }
    Positive::Yes
}
