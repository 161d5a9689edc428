//! Formulas' surfaces as lanes see them.
//!
//! Each line goes from cell to cell by itself, past those in which the formula has one sign. In a cell with surface the bounds of its gradient bound the slope `[l, h]` along the line:
//!
//! ```text
//!   0 not in [l, h]                 g goes one way: the sign at the end tells
//!   |g(m)| > max(|l|, |h|) w / 2    g has the sign that it has in the middle m of a stretch of length w
//! ```
//!
//! Else the formula is asked for bounds on the stretch, of the slope too (`pieces.rs`). What it is asked for, a value or a stretch of each line, it is asked eight times at once, by the tape that is right
//! for all of these lines.
//!
//! Lines are divided where rounded numbers say that they change cells, as those of single rays are (`cells.rs`): a point is sought in the cell that is a sixteenth of the margin ahead, and
//! lines whose points are known worse than half of that do without lanes.

use super::Isosurface;
use super::cells::{Cells, Told};
use super::pieces::{Pieces, boxes};
use crate::outline::{Ends, Level, Line8, Part, Skin, Slant, Told8, Value8};
use crate::tape::Tape;
use durer_math::{Dual, F8, I8, Isa, M8, U, Vec3};

impl Isosurface {
    /// The tape that is right at some of eight points, and near them.
    #[inline(always)]
    fn tape_at(&self, lanes: M8, point: impl Fn(usize) -> [f64; 3]) -> &Tape {
        let cells = self.divided();
        let mut number = None;
        for i in lanes.lanes() {
            let own = cells.tape_at(point(i));
            if number.is_some_and(|number| number != own) {
                return &self.tape;
            }
            number = Some(own);
        }
        number.map_or(&self.tape, |number| cells.tape(number))
    }

    /// The same at a point of each of some lines.
    fn tape_of(&self, line: &Line8, s: &F8, lanes: M8) -> &Tape {
        self.tape_at(lanes, |i| at(line, s.0[i], i))
    }

    /// Whether all cells that points of some lines are in know the sign.
    fn in_signs(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8) -> bool {
        (value.above, value.below) = (M8::NONE, M8::NONE);
        for i in lanes.lanes() {
            let Told::Sign(above) = self.divided().told(at(line, s.0[i], i)) else { return false };
            value.g.0[i] = if above { 1.0 } else { -1.0 };
            if above { value.above.set_lane(i, true) } else { value.below.set_lane(i, true) }
        }
        true
    }
}

/// A point of a line, rounded.
#[inline(always)]
fn at(line: &Line8, s: f64, i: usize) -> [f64; 3] {
    let (o, d) = (&line.o, &line.d);
    [s * d.x.0[i] + o.x.0[i], s * d.y.0[i] + o.y.0[i], s * d.z.0[i] + o.z.0[i]]
}

/// Where a line is in the cells, and what is known there.
struct Step {
    /// The formula keeps its sign until here.
    a: f64,
    /// Here the leaf ends.
    b: f64,
    /// There is none if it is not known.
    leaf: Option<Leaf>,
}

/// The number of a leaf's tape, and bounds of the slope along the line.
struct Leaf {
    tape: u32,
    low: f64,
    high: f64,
}

/// Stretches are not asked to be shorter than this part of what holds the solid.
const SHORTEST: f64 = durer_math::scale::pow2(-24);

/// A line that rounding takes out of so many cells as soon as it is in them runs along their faces: it does without lanes.
const GRAZED: u32 = 8;

/// Passes cells in which the formula has the sign that it has, or goes away from zero.
fn forward(line: &Line8, over: &Vec3<F8>, cells: &Cells, told: &Told8, i: usize) -> Step {
    let (o, d, over) = (line.o.lane(i).to_array(), line.d.lane(i).to_array(), over.lane(i).to_array());
    let (last, positive, e) = (told.last.0[i], told.sign.0[i] > 0.0, line.e_d.0[i]);
    let ahead = cells.margin() * (1.0 / 16.0);
    let (mut s, mut grazed) = (told.a.0[i], 0);
    loop {
        let at = s + ahead;
        let p = [at * d[0] + o[0], at * d[1] + o[1], at * d[2] + o[2]];
        let (told, end) = cells.ahead(p, o, over);
        let next = if end > s { end } else { s + ahead };
        match told {
            Told::Sign(above) if above == positive => {}
            // Where the formula is undefined is outside.
            Told::Gap(above) if above && positive => {}
            Told::Leaf(leaf) => {
                let (tape, low, high) = cells.slope(leaf, d, e);
                let away = if positive { low > 0.0 } else { high < 0.0 };
                if !away {
                    return Step { a: s, b: next, leaf: Some(Leaf { tape, low, high }) };
                }
            }
            _ => return Step { a: s, b: end.max(s), leaf: None },
        }
        if next >= last {
            return Step { a: last, b: last, leaf: None };
        }
        // A cell that is grazed at a corner, so that rounding says that it is left at once.
        grazed += u32::from(end <= s);
        if grazed > GRAZED {
            return Step { a: s, b: s, leaf: None };
        }
        s = next;
    }
}

impl Level for Isosurface {
    fn reach(&self) -> f64 {
        self.divided().reach()
    }

    fn ends(&self) -> (Ends, f64) {
        let ends = if self.open { Ends::Open } else { Ends::Capped };
        (ends, self.divided().margin() * (1.0 / 32.0))
    }

    fn part(&self, line: &Line8, part: &mut Part) {
        let margin = self.divided().margin();
        let far = F8::splat(2.0 * self.reach());
        line.isa.run_in_lanes(
            #[inline(always)]
            || part.unsure = !line.error(far).lt(F8::splat(margin * (1.0 / 32.0))),
        );
    }

    fn tell(&self, line: &Line8, told: &mut Told8) {
        let cells = self.divided();
        let mut slope = [F8::ZERO; 2];
        let mut asked = M8::NONE;
        let mut tape = None;
        let mut mixed = false;
        let mut over = Vec3::splat(Vec3::ZERO);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                over = Vec3::new(F8::ONE / line.d.x, F8::ONE / line.d.y, F8::ONE / line.d.z);
            },
        );
        for i in told.lanes.lanes() {
            let step = forward(line, &over, cells, told, i);
            let way = (told.b.0[i] - told.a.0[i]).min(told.hint.0[i]);
            told.a.0[i] = step.a;
            told.b.0[i] = step.b.min(step.a + way).min(told.last.0[i]);
            told.seen.set_lane(i, true);
            if step.a >= told.last.0[i] {
                let all = if told.sign.0[i] > 0.0 { &mut told.out } else { &mut told.within };
                all.set_lane(i, true);
                continue;
            }
            let Some(Leaf { tape: number, low, high }) = step.leaf else { continue };
            if low > 0.0 {
                told.rises.set_lane(i, true);
            } else if high < 0.0 {
                told.falls.set_lane(i, true);
            } else {
                asked.set_lane(i, true);
                (slope[0].0[i], slope[1].0[i]) = (low, high);
                mixed |= tape.is_some_and(|tape| tape != number);
                tape = Some(number);
            }
        }
        let Some(tape) = tape else { return };
        let tape = if mixed { &self.tape } else { cells.tape(tape) };
        Pieces::new(line, told, asked, &slope).tell(tape, SHORTEST * self.reach(), told);
    }

    fn values(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8) {
        if self.in_signs(line, s, lanes, value) {
            return;
        }
        let tape = self.tape_of(line, s, lanes);
        let mut x = [I8::new(F8::ZERO, F8::ZERO); 3];
        line.isa.run_in_lanes(
            #[inline(always)]
            || x = boxes(line, (s, s), line.error(s.abs())),
        );
        let v = tape.bounds(&x);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let defined = !M8::from_bits(v.partial | v.empty);
                value.g = v.lo * 0.5 + v.hi * 0.5;
                value.above = defined & v.lo.gt(F8::ZERO);
                value.below = defined & v.hi.lt(F8::ZERO);
            },
        );
    }

    fn about(&self, line: &Line8, s: &F8, lanes: M8, g: &mut F8) {
        let tape = self.tape_of(line, s, lanes);
        let mut p = [F8::ZERO; 3];
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let Vec3 { x, y, z } = line.point(*s);
                p = [x, y, z];
            },
        );
        *g = tape.values(&p);
    }

    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        let tape = self.tape_at(M8::ALL, |i| y.lane(i).to_array());
        let Dual { v, d } = tape.slants(&[y.x, y.y, y.z]);
        let [x, y, z] = d.d;
        isa.run_in_lanes(
            #[inline(always)]
            || *slant = Slant { f: v, half: Vec3::new(x * 0.5, y * 0.5, z * 0.5) },
        );
    }

    fn skin(&self, isa: Isa, (y, e): (&Vec3<F8>, &F8), skin: &mut Skin) {
        let reach = self.reach();
        let cells = self.divided();
        let (mut x, mut wide, mut near) =
            ([I8::new(F8::ZERO, F8::ZERO); 3], [I8::new(F8::ZERO, F8::ZERO); 3], M8::NONE);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                // So far around bounds of the gradient are asked for. Whether `off` stays within is looked at afterwards (`Outline::points`); the nearer, the tighter.
                let room = *e * 16.0 + reach * (1024.0 * U);
                let axis = |y: F8, e: F8| I8::new(y - e - y.abs() * U, y + e + y.abs() * U);
                x = [axis(y.x, *e), axis(y.y, *e), axis(y.z, *e)];
                let all = *e + room;
                wide = [axis(y.x, all), axis(y.y, all), axis(y.z, all)];
                // A cell's tape is right as far as the margin from it; a quarter pays for roundings many times over.
                near = all.lt(F8::splat(cells.margin() * 0.25));
                skin.room = near.select(room, F8::ZERO);
            },
        );
        let tape = self.tape_at(near, |i| y.lane(i).to_array());
        let v = tape.bounds(&x);
        let around = tape.gradients(&wide);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let mut rough = v.partial | v.empty | around.v.partial | around.v.jump;
                let (mut half, mut e_half) = ([F8::ZERO; 3], F8::ZERO);
                for (half, d) in half.iter_mut().zip(&around.d.d) {
                    rough |= d.partial;
                    *half = d.lo * 0.25 + d.hi * 0.25;
                    e_half = e_half.max((d.hi - d.lo) * 0.25 + half.abs() * (4.0 * U));
                }
                let [a, b, c] = half;
                skin.half = Vec3::new(a, b, c);
                skin.f = v.lo * 0.5 + v.hi * 0.5;
                skin.e_f =
                    (v.hi - v.lo) * (0.5 * (1.0 + 4.0 * U)) + skin.f.abs() * (2.0 * U) + f64::MIN_POSITIVE;
                skin.e_half = M8::from_bits(rough).select(F8::splat(f64::INFINITY), e_half);
                skin.bend = F8::ZERO;
            },
        );
    }
}
