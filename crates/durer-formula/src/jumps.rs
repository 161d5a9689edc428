//! The sign of a formula on both sides of a jump.
//!
//! ```text
//!   floor(x) on [k - h, k + h] is k - 1 or k, and nothing between
//! ```
//!
//! Bounds of a step that jumps include all values between its sides, and so may bounds of the
//! formula, however small the box is: `|x - floor(x) - 1/2|` is 1/2 at an integer, from both sides,
//! but bounds give 0 to 1/2. So each of the first three choices on a box halves the eight lanes:
//! one half takes one side, the other one the other, and steps that depend on the same sign take
//! the same side. At each point of the box every step is on one of its sides, so some lane's bounds
//! hold its value there (by induction over the steps); the formula has a sign on the box if it has
//! it in all lanes.

use super::formula::{NodeId, Op};
use super::program::run_with;
use super::seed;
use crate::{Dual, Function, I8, Number};
use arrayvec::ArrayVec;
use durer_math::{Interval, Point3, Vec3};

/// The number of choices whose sides are distinguished: two to this power is the number of lanes.
const MOST_JUMPS: usize = 3;

/// The value that decides the side of a step.
#[derive(Clone, Copy, PartialEq)]
enum Choice {
    /// The sign of this step, for all that take zero to the same side: below, above.
    Sign(NodeId, [bool; 2]),
    /// The step's own value.
    Own,
}

impl Choice {
    fn of(op: &Op) -> Self {
        match *op {
            Op::Select([c, below, zero, above]) => Self::Sign(c, [zero == below, zero == above]),
            _ => Self::Own,
        }
    }
}

/// The sign on a box, the same in all lanes of `x`, if it is certain on both sides of all jumps.
#[inline(always)]
pub(super) fn sign_beside(ops: &[Op], x: &[I8; 3], registers: &mut [I8]) -> Option<bool> {
    let mut known: ArrayVec<Choice, MOST_JUMPS> = ArrayVec::new();
    let v = run_with(
        ops,
        x,
        registers,
        #[inline(always)]
        |op, before, value| {
            let choice = Choice::of(op);
            let bit = known.iter().position(|&it| choice != Choice::Own && it == choice);
            if bit.is_none() && known.is_full() {
                return;
            }
            let Some(side) = halved(op, before, value, bit.unwrap_or(known.len())) else { return };
            if bit.is_none() {
                known.push(choice);
            }
            *value = side;
        },
    );
    if v.partial != 0 {
        return None;
    }
    if v.lo.0.iter().all(|&lo| lo > 0.0) {
        Some(true)
    } else if v.hi.0.iter().all(|&hi| hi < 0.0) {
        Some(false)
    } else {
        None
    }
}

/// One side of a step in the lanes whose number has this bit, the other side in the others; `None`
/// if it does not have two sides.
#[inline(never)]
fn halved(op: &Op, before: &[I8], value: &I8, bit: usize) -> Option<I8> {
    let upper = |lane: usize| lane >> bit & 1 == 1;
    match *op {
        Op::Function(Function::Floor | Function::Ceil | Function::Trunc, _) | Op::Compare(..) => {
            one_of_two(value, upper)
        }
        // The remainder of a divided by b: a - b trunc(a/b).
        Op::Rem(a, b) => {
            let (a, b) = (&before[a.0 as usize], &before[b.0 as usize]);
            let whole = I8::function(Function::Trunc, &I8::div(a, b));
            let left = I8::sub(a, &I8::mul(b, &one_of_two(&whole, upper)?));
            let mut out = *value;
            for lane in (0..8).filter(|&lane| whole.partial >> lane & 1 == 0) {
                let (told, held) = (left.lane(lane), value.lane(lane));
                let (lo, hi) = (told.lo.max(held.lo), told.hi.min(held.hi));
                // This side does not exist, so any value is valid.
                if lo <= hi {
                    (out.lo.0[lane], out.hi.0[lane]) = (lo, hi);
                }
            }
            Some(out)
        }
        // The angle goes from pi to -pi where the point crosses the negative half of the axis.
        Op::Atan2(y, x) => {
            let (y, x) = (&before[y.0 as usize], &before[x.0 as usize]);
            let crosses = |lane: usize| {
                let known = (y.partial | x.partial) >> lane & 1 == 0;
                known && x.hi.0[lane] < 0.0 && y.lo.0[lane] < 0.0 && y.hi.0[lane] >= 0.0
            };
            if !(0..8).any(crosses) {
                return None;
            }
            // The other side is the mirror image.
            let mut upward = *y;
            for lane in (0..8).filter(|&lane| crosses(lane)) {
                let hi = if upper(lane) { y.hi.0[lane] } else { -y.lo.0[lane] };
                upward.set_lane(lane, Interval { lo: 0.0, hi });
            }
            let angle = I8::atan2(&upward, x);
            let mut out = *value;
            for lane in (0..8).filter(|&lane| crosses(lane)) {
                let side = angle.lane(lane);
                out.set_lane(lane, if upper(lane) { side } else { -side });
            }
            Some(out)
        }
        Op::Select([c, below, zero, above]) => {
            let c = &before[c.0 as usize];
            let mut out = *value;
            let mut any = false;
            for lane in (0..8).filter(|&lane| c.partial >> lane & 1 == 0) {
                let (lo, hi) = (c.lo.0[lane], c.hi.0[lane]);
                let (side, other) = match (lo < 0.0, hi > 0.0) {
                    (true, true) if upper(lane) => (above, below),
                    (true, true) => (below, above),
                    // Only one side and zero.
                    (true, false) if hi == 0.0 && zero != below => {
                        (if upper(lane) { zero } else { below }, zero)
                    }
                    (false, true) if lo == 0.0 && zero != above => {
                        (if upper(lane) { above } else { zero }, zero)
                    }
                    _ => continue,
                };
                any = true;
                let mut x = before[side.0 as usize];
                // Zero is on this side, on the other one, or else with both.
                if zero != side && zero != other {
                    let zero = &before[zero.0 as usize];
                    (x.lo, x.hi) = (x.lo.min(zero.lo), x.hi.max(zero.hi));
                    x.partial |= zero.partial;
                }
                (out.lo.0[lane], out.hi.0[lane]) = (x.lo.0[lane], x.hi.0[lane]);
                out.partial = out.partial & !(1 << lane) | x.partial & 1 << lane;
                out.empty = out.empty & !(1 << lane) | x.empty & 1 << lane;
            }
            any.then_some(out)
        }
        _ => None,
    }
}

/// The gradient of the value that selects the side of the last step that jumps by itself within `r`
/// of `p`.
#[inline(always)]
pub(super) fn wall(ops: &[Op], p: Point3, r: f64, registers: &mut [Dual<I8>]) -> Option<Vec3> {
    let p = p.to_array();
    let x = [0, 1, 2].map(|axis| Dual { v: I8::splat(Interval::around(p[axis], r)), d: seed(axis) });
    let mut found = None;
    run_with(
        ops,
        &x,
        registers,
        #[inline(always)]
        |op, before, value| {
            let mut jumped = 0;
            op.operands(|id| jumped |= before[id.0 as usize].v.jump);
            if value.v.jump & !jumped & 1 == 1
                && let Some(normal) = chooser(op, before, value)
            {
                found = Some(normal);
            }
        },
    );
    found
}

/// The gradient of the value that selects the side of a step; `None` where it is zero or unknown.
#[inline(never)]
fn chooser(op: &Op, before: &[Dual<I8>], value: &Dual<I8>) -> Option<Vec3> {
    let at = |id: NodeId| &before[id.0 as usize].d;
    let slopes = match *op {
        Op::Function(_, a) | Op::Select([a, ..]) | Op::Atan2(a, _) => *at(a),
        Op::Compare(_, a, b) => I8::sub(at(a), at(b)),
        // a - b k: its gradient is b times that of a/b where a/b is the integer k.
        Op::Rem(..) => value.d,
        _ => return None,
    };
    let normal = Vec3::from([0, 1, 2].map(|axis| slopes.lane(axis).mid()));
    (normal.is_finite() && normal != Vec3::ZERO).then_some(normal)
}

/// The lesser or, where `upper` returns true for the lane, the greater of two consecutive integers;
/// `None` if no lane has two.
fn one_of_two(x: &I8, upper: impl Fn(usize) -> bool) -> Option<I8> {
    let mut out = *x;
    let mut any = false;
    for lane in 0..8 {
        let (lo, hi) = (x.lo.0[lane], x.hi.0[lane]);
        if hi - lo == 1.0 {
            any = true;
            let side = if upper(lane) { hi } else { lo };
            (out.lo.0[lane], out.hi.0[lane]) = (side, side);
        }
    }
    any.then_some(out)
}
