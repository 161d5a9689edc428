//! Stretches of some of eight lines, divided into pieces so that no lane is empty.
//!
//! A pass over a tape costs the same for one lane as for eight, and lines that advance at their own
//! pace seldom need it all at once. If `n` lines need it, each of their stretches is divided into
//! `8 / n` pieces. A piece is more likely to be decided than the whole, and a line advances as far
//! as its first pieces keep the sign.
//!
//! ```text
//!   |g(m)| > max(|l|, |h|) w / 2     on a piece of length w with the middle m, where the slope is in [l, h]
//! ```
//!
//! first with the slope in the whole cell, then, with the same value, with the slope on the piece
//! itself, which also decides whether `g` is monotone.

use crate::packet::{Line8, Segment8};
use durer_formula::Tape;
use durer_formula::{Dual, I8};
use durer_math::{F8, M8, U, Vec3};

/// A point of each line within an error, or a stretch of it, as boxes.
#[inline(always)]
pub(super) fn boxes(line: &Line8, (a, b): (&F8, &F8), e: F8) -> [I8; 3] {
    let axis = |o: F8, d: F8| {
        let (x, y) = (a.mul_add(d, o), b.mul_add(d, o));
        I8::new(x.min(y) - e, x.max(y) + e)
    };
    [axis(line.o.x, line.d.x), axis(line.o.y, line.d.y), axis(line.o.z, line.d.z)]
}

/// Pieces of stretches, those of one line side by side.
pub(super) struct Pieces {
    /// The active lines, as bits, and the number of pieces of each.
    asking: u8,
    each: usize,
    /// The line of each piece. Unused lanes repeat the last piece.
    line: Line8,
    a: F8,
    b: F8,
    /// Bounds of the slope in the cell.
    low: F8,
    high: F8,
}

/// The facts that are proven about pieces.
#[derive(Clone, Copy)]
struct Certain {
    out: M8,
    within: M8,
    rises: M8,
    falls: M8,
}

impl Pieces {
    /// Divides the stretches of the active lines, at least one, with bounds of the slope in their
    /// cells.
    #[inline(never)]
    pub(super) fn new(line: &Line8, told: &Segment8, asking: M8, slope: &[F8; 2]) -> Self {
        let zero = Vec3::new(F8::ZERO, F8::ZERO, F8::ZERO);
        let mut out = Self {
            asking: asking.bits(),
            each: 1,
            line: Line8 { o: zero, d: zero, e_o: F8::ZERO, e_d: F8::ZERO, ..*line },
            a: F8::ZERO,
            b: F8::ZERO,
            low: F8::ZERO,
            high: F8::ZERO,
        };
        out.each = 8 / out.asking.count_ones().max(1) as usize;
        let (mut lane, mut last) = (0, 0);
        for i in asking.lanes() {
            let (a, b) = (told.a.0[i], told.b.0[i]);
            let part = (b - a) * (1.0 / out.each as f64);
            let mut from = a;
            for k in 1..=out.each {
                let to = if k == out.each { b } else { (a + part * k as f64).max(from).min(b) };
                (out.a.0[lane], out.b.0[lane]) = (from, to);
                out.put(lane, line, slope, i);
                from = to;
                lane += 1;
            }
            last = i;
        }
        for lane in lane..8 {
            (out.a.0[lane], out.b.0[lane]) = (out.a.0[lane - 1], out.b.0[lane - 1]);
            out.put(lane, line, slope, last);
        }
        out
    }

    /// Puts a line into a lane.
    #[inline(always)]
    fn put(&mut self, lane: usize, line: &Line8, slope: &[F8; 2], i: usize) {
        let Line8 { o, d, e_o, e_d, .. } = &mut self.line;
        (o.x.0[lane], o.y.0[lane], o.z.0[lane]) = (line.o.x.0[i], line.o.y.0[i], line.o.z.0[i]);
        (d.x.0[lane], d.y.0[lane], d.z.0[lane]) = (line.d.x.0[i], line.d.y.0[i], line.d.z.0[i]);
        (e_o.0[lane], e_d.0[lane]) = (line.e_o.0[i], line.e_d.0[i]);
        (self.low.0[lane], self.high.0[lane]) = (slope[0].0[i], slope[1].0[i]);
    }

    /// Classifies the stretches of the active lines, by a tape that is valid on all of them. No
    /// stretch becomes shorter than `least`.
    pub(super) fn classify(&self, tape: &Tape, least: f64, told: &mut Segment8) {
        let certain = self.certain(tape, told);
        self.take(&certain, least, told);
    }

    fn certain(&self, tape: &Tape, told: &Segment8) -> Certain {
        let Self { line, a, b, low, high, .. } = self;
        let isa = line.isa;
        let (mut x, mut e, mut half) = ([I8::new(F8::ZERO, F8::ZERO); 3], F8::ZERO, F8::ZERO);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                e = line.error(a.abs().max(b.abs()));
                let mid = (*a + *b) * 0.5;
                x = boxes(line, (&mid, &mid), e);
                // Half the length, and the rounding of the middle.
                half = (*b - *a) * (0.5 * (1.0 + 8.0 * U)) + (a.abs() + b.abs()) * (2.0 * U);
            },
        );
        let v = tape.bounds(&x);
        let mut certain = Certain { out: M8::NONE, within: M8::NONE, rises: M8::NONE, falls: M8::NONE };
        let mut middle = M8::NONE;
        let done = isa.run_in_lanes(
            #[inline(always)]
            || {
                middle = !M8::from_bits(v.partial | v.empty | v.jump);
                let spread = (-*low).max(*high) * half * (1.0 + 8.0 * U) + f64::MIN_POSITIVE;
                certain.out = middle & v.lo.gt(spread);
                certain.within = middle & v.hi.lt(-spread);
                (certain.out | certain.within).all()
            },
        );
        if done || self.all_go_on(&certain, told) {
            return certain;
        }
        let mut d = [I8::new(F8::ZERO, F8::ZERO); 3];
        isa.run_in_lanes(
            #[inline(always)]
            || {
                x = boxes(line, (a, b), e);
                let axis = |d: F8| I8::new(d - line.e_d - d.abs() * U, d + line.e_d + d.abs() * U);
                d = [axis(line.d.x), axis(line.d.y), axis(line.d.z)];
            },
        );
        let g = tape.slopes(&[0, 1, 2].map(|i| Dual { v: x[i], d: d[i] }));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let defined = !M8::from_bits(g.v.partial | g.v.empty);
                let smooth = defined & !M8::from_bits(g.v.jump | g.d.partial);
                let steepest = (-g.d.lo).max(g.d.hi);
                let spread = steepest * half * (1.0 + 8.0 * U) + f64::MIN_POSITIVE;
                let middle = middle & smooth;
                certain.out |= defined & g.v.lo.gt(F8::ZERO) | middle & v.lo.gt(spread);
                certain.within |= defined & g.v.hi.lt(F8::ZERO) | middle & v.hi.lt(-spread);
                certain.rises = smooth & g.d.lo.gt(F8::ZERO);
                certain.falls = smooth & g.d.hi.lt(F8::ZERO);
            },
        );
        certain
    }

    /// Whether each line advances over its first piece at least. Slopes, which cost three times as
    /// much as values, are then not needed.
    fn all_go_on(&self, certain: &Certain, told: &Segment8) -> bool {
        let (out, within) = (certain.out.bits(), certain.within.bits());
        let mut firsts = durer_math::lanes::set_bits(self.asking).enumerate();
        firsts.all(|(rank, i)| {
            let kept = if told.sign.0[i] > 0.0 { out } else { within };
            kept >> (rank * self.each) & 1 == 1
        })
    }

    /// Each line advances over the pieces that keep its sign. If `g` is monotone towards zero
    /// behind them, that is the result; otherwise the next stretch is no longer than the undecided
    /// piece.
    fn take(&self, certain: &Certain, least: f64, told: &mut Segment8) {
        let (out, within) = (certain.out.bits(), certain.within.bits());
        let (rises, falls) = (certain.rises.bits(), certain.falls.bits());
        for (rank, i) in durer_math::lanes::set_bits(self.asking).enumerate() {
            let positive = told.sign.0[i] > 0.0;
            let (kept, against) = if positive { (out | rises, falls) } else { (within | falls, rises) };
            let first = rank * self.each;
            let end = first + self.each;
            let is = |bits: u8, lane: usize| lane < end && bits >> lane & 1 == 1;
            let mut open = first;
            while is(kept, open) {
                open += 1;
            }
            if is(against, open) {
                let mut last = open;
                while is(against, last + 1) {
                    last += 1;
                }
                (told.a.0[i], told.b.0[i]) = (self.a.0[open], self.b.0[last]);
                let way = if positive { &mut told.falls } else { &mut told.rises };
                way.set_lane(i, true);
            } else if open > first {
                told.b.0[i] = self.b.0[open - 1];
                let side = if positive { &mut told.out } else { &mut told.within };
                side.set_lane(i, true);
                if open < end {
                    told.next.0[i] = (self.b.0[open] - self.a.0[open]).max(least);
                }
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::laws::TestRng;
    use durer_formula::{Builder, Op};
    use durer_math::{Dyadic, Isa};

    /// `x^3 - 2 x + y z + c`, as a tape and exactly.
    pub(in crate::implicit) fn cubic(c: f64) -> Tape {
        let mut b = Builder::new();
        let mut op = |op| b.push(op).unwrap();
        let [x, y, z] = [0, 1, 2].map(|i| op(Op::Input(i)));
        let cube = op(Op::Powi(x, 3));
        let twice = op(Op::Add(x, x));
        let product = op(Op::Mul(y, z));
        let constant = op(Op::Constant(c.into()));
        let (left, right) = (op(Op::Sub(cube, twice)), op(Op::Add(product, constant)));
        let root = op(Op::Add(left, right));
        Tape::new(&b.finish(root, 3))
    }

    pub(in crate::implicit) fn exactly(c: f64, line: &Line8, i: usize, s: f64) -> Dyadic {
        let at = |o: F8, d: F8| &Dyadic::from(o.0[i]) + &(&Dyadic::from(s) * &Dyadic::from(d.0[i]));
        let (o, d) = (line.o, line.d);
        let [x, y, z] = [at(o.x, d.x), at(o.y, d.y), at(o.z, d.z)];
        let cube = &(&x * &x) * &x;
        &(&cube - &(&x + &x)) + &(&(&y * &z) + &Dyadic::from(c))
    }

    /// For any number of lines that ask: where the sign is reported as kept it is, where `g` is
    /// reported as monotone it is, nothing is reported beyond the stretch, and the sign at the
    /// start stays the same.
    #[test]
    fn what_is_told_of_stretches_is_so() {
        let (mut kept, mut shortened, mut ways, mut moved) = (0, 0, 0, 0);
        for (seed, isa) in (0..3000).flat_map(|seed| Isa::available().map(move |isa| (seed, isa))) {
            let mut dice = TestRng::new(seed);
            let c = 4.0 * dice.unit() - 2.0;
            let tape = cubic(c);
            let zero = Vec3::new(F8::ZERO, F8::ZERO, F8::ZERO);
            let mut line = Line8 { isa, o: zero, d: zero, e_o: F8::ZERO, e_d: F8::ZERO };
            let (mut a, mut b, mut sign, mut asking) = (F8::ZERO, F8::ZERO, F8::ONE, M8::NONE);
            for i in 0..8 {
                let (o, d) = (dice.vector(), dice.vector());
                (line.o.x.0[i], line.o.y.0[i], line.o.z.0[i]) = (o.x, o.y, o.z);
                (line.d.x.0[i], line.d.y.0[i], line.d.z.0[i]) = (d.x, d.y, d.z);
                a.0[i] = dice.unit() - 1.0;
                b.0[i] = a.0[i] + 1.5 * dice.unit() * dice.unit();
                let start = exactly(c, &line, i, a.0[i]).exact_sign();
                sign.0[i] = if start.is_gt() { 1.0 } else { -1.0 };
                asking.set_lane(i, start.is_ne() && dice.below(3) == 0);
            }
            if !asking.any() {
                continue;
            }
            let x = boxes(&line, (&a, &b), line.error(F8::splat(2.0)));
            let d = [line.d.x, line.d.y, line.d.z].map(|d| I8::new(d, d));
            let g = tape.slopes(&[0, 1, 2].map(|i| Dual { v: x[i], d: d[i] }));
            // As if cells were larger, sometimes much larger.
            let far = F8::splat(dice.power(0, 6));
            let slope = [g.d.lo - far, g.d.hi + far];
            let (none, never) = (M8::NONE, F8::splat(f64::INFINITY));
            let before = Segment8 {
                lanes: asking,
                seen: asking,
                a,
                b,
                last: b,
                out: none,
                within: none,
                rises: none,
                falls: none,
                sign,
                hint: never,
                next: never,
            };
            let mut told = before;
            Pieces::new(&line, &told, asking, &slope).classify(&tape, 0.0, &mut told);
            for i in asking.lanes() {
                let (from, to) = (told.a.0[i], told.b.0[i]);
                assert!(a.0[i] <= from && from <= to && to <= b.0[i], "{seed} {i}: {from} {to}");
                let mut places: Vec<f64> =
                    (0..=16).map(|k| ((to - from) * f64::from(k) / 16.0 + from).min(to)).collect();
                places.dedup();
                let values: Vec<Dyadic> = places.iter().map(|&s| exactly(c, &line, i, s)).collect();
                let is = |mask: M8| mask.lane(i);
                let at_start = values[0].exact_sign();
                assert_eq!(if at_start.is_gt() { 1.0 } else { -1.0 }, told.sign.0[i], "{seed} {i}");
                assert!(!(is(told.out) && is(told.within)), "{seed} {i}");
                for v in &values {
                    assert!(!is(told.out) || v.exact_sign().is_gt(), "{seed} {i}");
                    assert!(!is(told.within) || v.exact_sign().is_lt(), "{seed} {i}");
                }
                for pair in values.windows(2) {
                    let step = (&pair[1] - &pair[0]).exact_sign();
                    assert!(!is(told.rises) || step.is_gt(), "{seed} {i}");
                    assert!(!is(told.falls) || step.is_lt(), "{seed} {i}");
                }
                kept += usize::from(is(told.out) || is(told.within));
                shortened += usize::from((is(told.out) || is(told.within)) && to < b.0[i]);
                ways += usize::from(is(told.rises) || is(told.falls));
                moved += usize::from((is(told.rises) || is(told.falls)) && from > a.0[i]);
            }
        }
        // Counted once for each instruction set.
        let paths = Isa::available().count();
        assert!(
            kept > 1250 * paths && shortened > 125 * paths && ways > 125 * paths && moved > 50 * paths,
            "{paths}: {kept} {shortened} {ways} {moved}"
        );
    }
}
