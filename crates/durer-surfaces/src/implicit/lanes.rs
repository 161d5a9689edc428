//! Packets of rays against the surface of a formula.
//!
//! Each line moves from cell to cell past those in which the formula has one sign (`march.rs`). In
//! a cell with surface the bounds of its gradient bound the slope `[l, h]` along the line:
//!
//! ```text
//!   0 not in [l, h]                 g is monotone: the sign at the end decides
//!   |g(m)| > max(|l|, |h|) w / 2    g has the sign of its value in the middle m of a stretch of length w
//! ```
//!
//! Otherwise bounds of the formula and its slope on the stretch are computed (`subdivide.rs`).
//! Values and stretches are computed for eight lines at once, by a tape that is valid for all of
//! them.
//!
//! Lines are divided where they change cells according to rounded numbers, as for single rays
//! (`octree.rs`, `octree_lookup.rs`): a point is looked up in the cell that is a sixteenth of the
//! margin ahead. Lines whose points have errors above half of that continue as single rays.

use super::Isosurface;
use super::march::Stop;
use super::octree_lookup::Lookup;
use super::subdivide::{Pieces, boxes};
use crate::packet::{Ends, ImplicitKernel, Line8, LineExtent8, Segment8, Skin, Slant, Value8};
use durer_formula::Tape;
use durer_formula::{Dual, I8};
use durer_math::{F8, Isa, M8, U, Vec3};

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

    /// The tape that is right at a point of each of some lines.
    fn tape_of(&self, line: &Line8, s: &F8, lanes: M8) -> &Tape {
        self.tape_at(lanes, |i| at(line, s.0[i], i))
    }

    /// Whether the sign is known in all cells that hold points of some lines.
    fn in_signs(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8) -> bool {
        (value.above, value.below) = (M8::NONE, M8::NONE);
        for i in lanes.lanes() {
            let Lookup::Sign(above) = self.divided().grid().look_up(at(line, s.0[i], i)) else {
                return false;
            };
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

/// The shortest stretch, as a fraction of the container's size.
const SHORTEST: f64 = durer_math::scale::pow2(-24);

impl ImplicitKernel for Isosurface {
    fn reach(&self) -> f64 {
        self.divided().reach()
    }

    fn ends(&self) -> (Ends, f64) {
        let ends = if self.open { Ends::Open } else { Ends::Capped };
        (ends, self.divided().margin() * (1.0 / 32.0))
    }

    fn part(&self, line: &Line8, part: &mut LineExtent8) {
        let margin = self.divided().margin();
        let far = F8::splat(2.0 * self.reach());
        line.isa.run_in_lanes(
            #[inline(always)]
            || part.unsure = !line.error(far).lt(F8::splat(margin * (1.0 / 32.0))),
        );
    }

    fn classify(&self, line: &Line8, told: &mut Segment8) {
        let cells = self.divided();
        let stop = Stop::of(cells, line, told);
        let mut asked = M8::NONE;
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let way = (told.b - told.a).min(told.hint);
                told.a.set_where(told.lanes, stop.a);
                told.b.set_where(told.lanes, stop.b.min(stop.a + way).min(told.last));
                told.seen |= told.lanes;
                let through = told.lanes & stop.a.ge(told.last);
                let positive = told.sign.gt(F8::ZERO);
                told.out |= through & positive;
                told.within |= through & !positive;
                let leaf = stop.leaf & !through;
                let (rises, falls) = (stop.low.gt(F8::ZERO), stop.high.lt(F8::ZERO));
                told.rises |= leaf & rises;
                told.falls |= leaf & !rises & falls;
                asked = leaf & !(rises | falls);
            },
        );
        let (mut tape, mut mixed) = (None, false);
        for i in asked.lanes() {
            mixed |= tape.is_some_and(|tape| tape != stop.tape[i]);
            tape = Some(stop.tape[i]);
        }
        let Some(tape) = tape else { return };
        let tape = if mixed { &self.tape } else { cells.tape(tape) };
        Pieces::new(line, told, asked, &[stop.low, stop.high]).classify(tape, SHORTEST * self.reach(), told);
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
                // Bounds of the gradient are computed in this neighbourhood; a smaller one gives
                // tighter bounds. Whether `off` stays within is checked later
                // (`PacketFilter::points`).
                let room = *e * 16.0 + reach * (1024.0 * U);
                let axis = |y: F8, e: F8| I8::new(y - e - y.abs() * U, y + e + y.abs() * U);
                x = [axis(y.x, *e), axis(y.y, *e), axis(y.z, *e)];
                let all = *e + room;
                wide = [axis(y.x, all), axis(y.y, all), axis(y.z, all)];
                // A cell's tape is right within the margin; a quarter of it covers roundings many
                // times over.
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
