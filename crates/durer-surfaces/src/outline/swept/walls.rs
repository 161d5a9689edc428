//! Where eight rays cross the wall of a swept curve.

use super::{Curve, Memory, Sweep8, cubic};
use crate::outline::meet::Question;
use crate::outline::rays::{CLEAR, Nearest, SLACK};
use crate::outline::roots::quotient;
use durer_math::{F8, M8, U};

/// The cubic that the trace of the rays is along a curve; false if all pass by.
#[inline(never)]
pub(in crate::outline) fn cubic_of(
    asked: &Question<'_>,
    (curve, sweep): (&Curve, &Sweep8),
    nearest: &mut Nearest,
    memory: &mut Memory,
) -> bool {
    asked.rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Memory { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, .. } = *memory;
            let reach = curve.reach;
            let ([x, w, z], e) = if sweep.conic {
                let n = [oy.mul_add(dz, -(oz * dy)), oz.mul_add(dx, -(ox * dz)), ox.mul_add(dy, -(oy * dx))];
                let (o1, d1) = (ox.abs() + oy.abs() + oz.abs(), dx.abs() + dy.abs() + dz.abs());
                (n, (o1 * e_d + d1 * e_o + o1 * d1 * (4.0 * U)) * (1.0 + 2.0 * reach))
            } else {
                let n = [dz, dx.mul_add(oz, -(dz * ox)), -dx];
                let (o1, d1) = (ox.abs() + oz.abs(), dx.abs() + dz.abs());
                (n, d1 * e_o + (o1 + 2.0 * reach) * e_d + o1 * d1 * (4.0 * U))
            };
            let size = x.abs() + z.abs();
            let e = (e + size * curve.slack + (size * reach + w.abs()) * (4.0 * U)) * SLACK;
            let mut g = [F8::ZERO; 4];
            let [xs, zs] = &curve.points;
            for ((g, &px), &pz) in g.iter_mut().zip(xs).zip(zs) {
                *g = x.mul_add(F8::splat(px), z.mul_add(F8::splat(pz), w));
            }
            let least = g[0].min(g[1]).min(g[2].min(g[3]));
            let most = g[0].max(g[1]).max(g[2].max(g[3]));
            let beside = least.gt(e) | most.lt(-e);
            let open = *asked.rays.live & !beside;
            if !open.any() {
                return false;
            }
            memory.poly = cubic(g, e);
            memory.poly.begin(open, &mut memory.part);
            if memory.part.unsure.any() {
                nearest.doubt_from(memory.part.unsure, F8::ZERO);
            }
            memory.part.unsure = M8::NONE;
            true
        },
    )
}

/// The next root of the cubic; false if there is none in any lane.
pub(in crate::outline) fn parted(asked: &Question<'_>, nearest: &mut Nearest, memory: &mut Memory) -> bool {
    let isa = asked.rays.isa;
    memory.poly.isolate(isa, &mut memory.part);
    if memory.part.unsure.any() {
        nearest.doubt_from(memory.part.unsure, F8::ZERO);
        memory.part.unsure = M8::NONE;
    }
    if !memory.part.one.any() {
        return false;
    }
    memory.poly.refine(isa, &memory.part, &mut memory.root);
    true
}

/// Where the rays cross a wall.
pub(in crate::outline) struct Placed8 {
    pub(in crate::outline) t: F8,
    pub(in crate::outline) e: F8,
    /// `t` is within `e`.
    pub(in crate::outline) known: M8,
    /// Surely between the heights, and surely not.
    pub(in crate::outline) inside: M8,
    pub(in crate::outline) outside: M8,
}

/// All crossings with a wall.
pub(super) fn wall(
    asked: &Question<'_>,
    (curve, sweep, left): (&Curve, &Sweep8, bool),
    nearest: &mut Nearest,
    memory: &mut Memory,
) {
    for _ in 0..3 {
        if !parted(asked, nearest, memory) {
            return;
        }
        offer(asked, (curve, sweep, left), nearest, memory);
        memory.poly.go_on(&mut memory.part);
    }
}

/// What a ray's parameter at a point of a wall follows from, beside one coordinate.
#[derive(Clone, Copy)]
struct Known {
    oy: F8,
    dy: F8,
    e_c: F8,
    e_o: F8,
    e_d: F8,
}

impl Known {
    /// Numerator and denominator of the parameter, each with its error.
    #[inline(always)]
    fn ratio(&self, conic: bool, x: F8, o: F8, d: F8) -> (F8, F8, F8, F8) {
        let Self { oy, dy, e_c, e_o, e_d } = *self;
        if !conic {
            return (x - o, e_c + e_o + (x.abs() + o.abs()) * U, d, e_d);
        }
        let (num, den) = (x.mul_add(oy, -o), (-x).mul_add(dy, d));
        let far = x.abs() + 1.0;
        let e_num = e_c * (oy.abs() + e_o) + far * e_o + ((x * oy).abs() + o.abs()) * (2.0 * U);
        let e_den = e_c * (dy.abs() + e_d) + far * e_d + ((x * dy).abs() + d.abs()) * (2.0 * U);
        (num, e_num, den, e_den)
    }
}

/// Where the roots of the cubic are on the rays.
#[inline(always)]
pub(in crate::outline) fn placed((curve, sweep): (&Curve, &Sweep8), memory: &Memory) -> Placed8 {
    let Memory { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, root, .. } = *memory;
    let ([x, z], slope) = curve.at(root.x);
    // The slope changes by less than `turn e` on the way.
    let (_, turn) = curve.speed();
    let speed = slope[0].abs().max(slope[1].abs()) + root.e * turn + curve.reach * (32.0 * U);
    let e_c = (root.e * speed + curve.rounding()) * SLACK;
    let known = Known { oy, dy, e_c, e_o, e_d };
    let (by_x, by_z) = (known.ratio(sweep.conic, x, ox, dx), known.ratio(sweep.conic, z, oz, dz));
    let wide = by_x.2.abs().gt(by_z.2.abs());
    let num = wide.select(by_x.0, by_z.0);
    let e_num = wide.select(by_x.1, by_z.1) * SLACK;
    let den = wide.select(by_x.2, by_z.2);
    let e_den = wide.select(by_x.3, by_z.3) * SLACK;
    let (t, e) = quotient(num, e_num, F8::ONE / den, e_den);
    let known = den.abs().gt(e_den * CLEAR) & root.sure;
    let y = t.mul_add(dy, oy);
    let e_y = (e_o + t.abs() * e_d + e * dy.abs() + y.abs() * (2.0 * U)) * SLACK
        + (sweep.low.abs().max(sweep.high.abs()) * (4.0 * U));
    let inside = (y - sweep.low).gt(e_y) & (-(y - sweep.high)).gt(e_y);
    let outside = (y - sweep.low).lt(-e_y) | (y - sweep.high).gt(e_y);
    Placed8 { t, e, known, inside, outside }
}

#[inline(never)]
fn offer(
    asked: &Question<'_>,
    (curve, sweep, left): (&Curve, &Sweep8, bool),
    nearest: &mut Nearest,
    memory: &mut Memory,
) {
    let rays = asked.rays;
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Placed8 { t, e, known: steep, inside, outside } = placed((curve, sweep), memory);
            let Memory { part, root, .. } = memory;
            let away = steep & ((t + e).lt(F8::ZERO) | (t - e).gt(nearest.limit(rays)));
            let falls = part.sign.gt(F8::ZERO);
            let leaves = if left { falls } else { !falls };
            let own = asked.from.map_or(M8::NONE, |from| {
                from.lanes & steep & t.abs().le(e) & (leaves & !from.back | !leaves & from.back)
            });
            let open = part.one & !(steep & outside | away | own);
            let sure = open & steep & inside & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
            nearest.take_at(sure, (t, e), asked.number, F8::ZERO, root.x);
            let unsure = open & !sure;
            if unsure.any() {
                let from = steep.select(t - e, F8::ZERO);
                nearest.doubt_from(unsure, from);
            }
        },
    );
}
