//! Where eight rays cross the caps of a swept solid.

use super::{Curve, Memory, Sweep8, cubic};
use crate::outline::meet::Question;
use crate::outline::rays::{CLEAR, Nearest, SLACK};
use crate::outline::roots::quotient;
use durer_math::{F8, M8, U};

/// The least and the greatest of some numbers.
fn range(v: &[f64; 4]) -> (f64, f64) {
    (v.iter().fold(f64::INFINITY, |m, x| m.min(*x)), v.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)))
}

/// Where the rays reach the plane of a cap; false if none does where it matters, which is everywhere on the line or only ahead.
#[inline(never)]
pub(in crate::outline) fn reach(
    asked: &Question<'_>,
    (sweep, top): (&Sweep8, bool),
    nearest: &mut Nearest,
    memory: &mut Memory,
    ahead: bool,
) -> bool {
    asked.rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Memory { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, .. } = *memory;
            let height = if top { sweep.high } else { sweep.low };
            let steep = dy.abs().gt(e_d * CLEAR);
            let e_h = e_o + height.abs() * (4.0 * U);
            let (t, e) = quotient(-(oy - height), e_h, F8::ONE / dy, e_d);
            // Of rays along the plane nothing is known from their start on.
            let (t, e) = (steep.keep(t), steep.keep(e));
            let mut open = *asked.rays.live;
            memory.unsure = open & !steep;
            if ahead {
                if let Some(from) = asked.from {
                    // Outward is up at the top; they left it on the side to which they go.
                    let outward = if top { dy.gt(F8::ZERO) } else { dy.lt(F8::ZERO) };
                    open &= !(from.lanes & steep & (outward & !from.back | !outward & from.back));
                }
                open &= !(steep & ((t + e).lt(F8::ZERO) | (t - e).gt(nearest.limit(asked.rays))));
                memory.unsure = open & !(steep & (t - e).gt(F8::ZERO));
            }
            if !open.any() {
                return false;
            }
            memory.open = open & !memory.unsure;
            let (mut x, mut z) = (t.mul_add(dx, ox), t.mul_add(dz, oz));
            let mut e_place = e_o + t.abs() * e_d + e * (dx.abs() + dz.abs());
            e_place = (e_place + (x.abs() + z.abs()) * (4.0 * U)) * SLACK;
            if sweep.conic {
                let inverse = 1.0 / height;
                (x, z) = (x * inverse, z * inverse);
                e_place = e_place * inverse.abs() + (x.abs() + z.abs()) * (8.0 * U);
            }
            (memory.t, memory.e, memory.place, memory.e_place) = (t, e, [x, z], e_place);
            memory.odd = M8::NONE;
            true
        },
    )
}

/// How often a line from the point of a cap along x crosses a curve, modulo two.
#[inline(never)]
pub(in crate::outline) fn count(asked: &Question<'_>, curve: &Curve, memory: &mut Memory) {
    let isa = asked.rays.isa;
    let work = isa.run_in_lanes(
        #[inline(always)]
        || {
            let ([px, pz], e_place) = (memory.place, memory.e_place);
            let [xs, zs] = curve.points;
            let ((x0, x1), (z0, z1)) = (range(&xs), range(&zs));
            let e = e_place + curve.slack;
            // Above, below, or behind: none.
            let none = (-(pz - z0)).gt(e) | (pz - z1).gt(e) | (px - x1).gt(e);
            let mut open = memory.open & !none;
            if !open.any() {
                return false;
            }
            let mut g = [F8::ZERO; 4];
            for i in 0..4 {
                g[i] = -(pz - zs[i]);
            }
            // All ahead: once if its ends are on different sides.
            let (first, last) = (g[0], g[3]);
            let certain = first.abs().gt(e) & last.abs().gt(e);
            let ahead = open & (-(px - x0)).gt(e) & certain;
            let changes = (first * last).lt(F8::ZERO);
            memory.odd = flipped(memory.odd, ahead & changes);
            open &= !ahead;
            if !open.any() {
                return false;
            }
            memory.poly = cubic(g, e * SLACK);
            memory.poly.begin(open, &mut memory.part);
            true
        },
    );
    if !work {
        return;
    }
    for _ in 0..3 {
        memory.poly.isolate(isa, &mut memory.part);
        memory.unsure |= memory.part.unsure;
        memory.part.unsure = M8::NONE;
        if !memory.part.one.any() {
            return;
        }
        memory.poly.refine(isa, &memory.part, &mut memory.root);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let Memory { part, root, .. } = memory;
                let ([x, _], slope) = curve.at(root.x);
                let (_, turn) = curve.speed();
                let speed = slope[0].abs() + root.e * turn + curve.reach * (32.0 * U);
                let e = (root.e * speed + curve.rounding() + memory.e_place) * SLACK;
                let way = x - memory.place[0];
                let (ahead, behind) = (way.gt(e), way.lt(-e));
                let known = root.sure & (ahead | behind);
                memory.unsure |= part.one & !known;
                memory.odd = flipped(memory.odd, part.one & ahead);
            },
        );
        memory.poly.go_on(&mut memory.part);
    }
}

#[inline(always)]
fn flipped(odd: M8, where_: M8) -> M8 {
    odd & !where_ | !odd & where_
}

/// Offers the crossing with a cap.
#[inline(never)]
pub(super) fn conclude(asked: &Question<'_>, nearest: &mut Nearest, memory: &mut Memory) {
    let rays = asked.rays;
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Memory { t, e, open, odd, unsure, .. } = memory;
            let (t, e) = (*t, *e);
            let within = *open & *odd & !*unsure;
            let sure = within & (t + e).le(*rays.t_max);
            nearest.take(sure, t, e, asked.number, F8::ZERO);
            let unsure = *unsure | within & !sure;
            if unsure.any() {
                nearest.doubt_from(unsure, t - e);
            }
        },
    );
}
