//! Stretches of some of eight lines, divided into pieces until no lane is empty.
//!
//! A pass over a tape costs the same for one lane as for eight, and lines that go through space at their own pace seldom ask all together. Where `n` lines ask, each stretch is told in `8 / n` pieces: of a
//! piece less is asked than of the whole, and a line goes on as far as its first pieces keep the sign.
//!
//! ```text
//!   |g(m)| > max(|l|, |h|) w / 2     on a piece of length w with the middle m, where the slope is in [l, h]
//! ```
//!
//! first with the slope in the whole cell, and then, with the same value, with that on the piece itself, which also tells whether `g` goes one way.

use crate::outline::{Line8, Told8};
use crate::tape::Tape;
use durer_math::{Dual, F8, I8, M8, U, Vec3};

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
    /// The lines that ask, as bits, and how many pieces each of them has.
    asking: u8,
    each: usize,
    /// The line of each piece. Lanes that are left stand in for the last one.
    line: Line8,
    a: F8,
    b: F8,
    /// Bounds of the slope in the cell.
    low: F8,
    high: F8,
}

/// What is certain of pieces.
#[derive(Clone, Copy)]
struct Certain {
    out: M8,
    within: M8,
    rises: M8,
    falls: M8,
}

impl Pieces {
    /// Of the stretches of the lines that ask, of which there must be one, with bounds of the slope in their cells.
    #[inline(never)]
    pub(super) fn new(line: &Line8, told: &Told8, asking: M8, slope: &[F8; 2]) -> Self {
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

    /// Tells the lines that ask what is certain of their stretches, by a tape that is right on all of them. No stretch is asked to be shorter than `least`.
    pub(super) fn tell(&self, tape: &Tape, least: f64, told: &mut Told8) {
        let certain = self.certain(tape, told);
        self.take(&certain, least, told);
    }

    fn certain(&self, tape: &Tape, told: &Told8) -> Certain {
        let Self { line, a, b, low, high, .. } = self;
        let isa = line.isa;
        let (mut x, mut e, mut half) = ([I8::new(F8::ZERO, F8::ZERO); 3], F8::ZERO, F8::ZERO);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                e = line.error(a.abs().max(b.abs()));
                let mid = (*a + *b) * 0.5;
                x = boxes(line, (&mid, &mid), e);
                // Half of it, and the middle's rounding.
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

    /// Whether each line goes on over its first piece at least: then slopes, which cost three times as much as values, are not asked for.
    fn all_go_on(&self, certain: &Certain, told: &Told8) -> bool {
        let (out, within) = (certain.out.bits(), certain.within.bits());
        let mut firsts = durer_math::lanes::set_bits(self.asking).enumerate();
        firsts.all(|(rank, i)| {
            let kept = if told.sign.0[i] > 0.0 { out } else { within };
            kept >> (rank * self.each) & 1 == 1
        })
    }

    /// Each line goes on over the pieces that keep its sign. If `g` goes one way towards zero behind these, that is what is told; else the next stretch is no longer than the piece that could not be told.
    fn take(&self, certain: &Certain, least: f64, told: &mut Told8) {
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
