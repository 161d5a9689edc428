//! Crossings of eight rays with the wall of a swept curve.

use super::caps::range;
use super::{PrismScratch, ProfileCurve8, Sweep8, cubic, lowest, tag_of};
use crate::packet::quadratic_roots::quotient;
use crate::packet::rays::{CLEAR, From8, RayLanes, SLACK};
use crate::packet::sink::Sink8;
use durer_math::{F8, M8, U};

/// Finds the part of each ray between the two heights, ahead of its start or anywhere on its line,
/// and a box in the plane of the outlines that contains its trace there. Also stores the form of
/// the trace. Returns false if no ray is between the heights.
///
/// Heights and points have the same errors as in `reach` of a cap. A trace is straight, so it lies
/// between its ends. The traces of rays that may pass the apex are not bounded.
#[inline(never)]
pub(super) fn enclose<K: Sink8>(
    rays: &RayLanes<'_>,
    sweep: &Sweep8,
    to: &K,
    memory: &mut PrismScratch,
    ahead: bool,
) -> bool {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, far, .. } = *memory;
            let steep = dy.abs().gt(e_d * CLEAR);
            let inverse = F8::ONE / dy;
            let e_h = e_o + sweep.low.abs().max(sweep.high.abs()) * (4.0 * U);
            let (low, e_low) = quotient(-(oy - sweep.low), e_h, inverse, e_d);
            let (high, e_high) = quotient(-(oy - sweep.high), e_h, inverse, e_d);
            let rises = dy.gt(F8::ZERO);
            let enter = rises.select(low - e_low, high - e_high);
            let leave = rises.select(high + e_high, low + e_low);
            // An unknown end does not bound the part.
            let (mut from, mut till) =
                (steep.select(enter.max(-far), -far), steep.select(leave.min(far), far));
            if ahead {
                (from, till) = (from.max(F8::ZERO), till.min(to.limit(rays)));
            }
            memory.between = *rays.live & !from.gt(till);
            if !memory.between.any() {
                return false;
            }
            let e = (e_o + from.abs().max(till.abs()) * e_d) * SLACK;
            let mut ends = [[F8::ZERO; 2]; 2];
            let mut slip = e;
            let mut bounded = M8::ALL;
            for (end, t) in ends.iter_mut().zip([from, till]) {
                let (mut x, mut z) = (t.mul_add(dx, ox), t.mul_add(dz, oz));
                // The factor covers also the rounding of the last sum below, and of widening a
                // curve's box by its slack.
                let mut e_end = e + (x.abs() + z.abs()) * (4.0 * U);
                if sweep.conic {
                    let y = t.mul_add(dy, oy);
                    let e_y = e_end + (y.abs() + (t * dy).abs()) * (2.0 * U);
                    // Both heights and both ends must be on the same side of the apex.
                    bounded &=
                        (y * sweep.low.signum()).gt(e_y * CLEAR) & M8::splat(sweep.low * sweep.high > 0.0);
                    let inverse = F8::ONE / y;
                    (x, z) = (x * inverse, z * inverse);
                    let size = x.abs() + z.abs();
                    e_end = e_y * (size + 1.0) * inverse.abs() * (CLEAR / (CLEAR - 1.0)) + size * (8.0 * U);
                }
                slip = slip.max(e_end);
                *end = [x, z];
            }
            let slip = slip * SLACK;
            let mut traces = [F8::ZERO; 4];
            for k in 0..2 {
                let (least, most) = (ends[0][k].min(ends[1][k]), ends[0][k].max(ends[1][k]));
                traces[2 * k] = bounded.select(least - slip, F8::splat(f64::NEG_INFINITY));
                traces[2 * k + 1] = bounded.select(most + slip, F8::splat(f64::INFINITY));
            }
            memory.traces = traces;
            memory.form = Form8::of(sweep.conic, memory);
            true
        },
    )
}

/// Stores a box around the traces of all rays.
#[inline(never)]
pub(super) fn enclose_all(rays: &RayLanes<'_>, memory: &mut PrismScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { traces: [x0, x1, z0, z1], between, .. } = *memory;
            memory.around =
                [lowest(between, x0), -lowest(between, -x1), lowest(between, z0), -lowest(between, -z1)];
        },
    );
}

/// Computes the cubic of the rays' traces along a curve. Returns false if all rays miss.
#[inline(never)]
pub(super) fn cubic_of<K: Sink8>(
    rays: &RayLanes<'_>,
    curve: &ProfileCurve8,
    to: &mut K,
    memory: &mut PrismScratch,
) -> bool {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let [xs, zs] = &curve.points;
            let [x_low, x_high, z_low, z_high] = memory.traces;
            let ((x0, x1), (z0, z1), slack) = (range(xs), range(zs), curve.slack);
            let away = x_high.lt(F8::splat(x0 - slack)) | x_low.gt(F8::splat(x1 + slack));
            let away = away | z_high.lt(F8::splat(z0 - slack)) | z_low.gt(F8::splat(z1 + slack));
            let near = memory.between & !away;
            if !near.any() {
                return false;
            }
            let Form8 { n: [x, w, z], size, e, e_reach } = memory.form;
            let e = (e + e_reach * curve.reach + size * slack) * SLACK;
            let mut g = [F8::ZERO; 4];
            for ((g, &px), &pz) in g.iter_mut().zip(xs).zip(zs) {
                *g = x.mul_add(F8::splat(px), z.mul_add(F8::splat(pz), w));
            }
            let least = g[0].min(g[1]).min(g[2].min(g[3]));
            let most = g[0].max(g[1]).max(g[2].max(g[3]));
            let open = near & !(least.gt(e) | most.lt(-e));
            if !open.any() {
                return false;
            }
            memory.poly = cubic(g, e);
            memory.poly.begin_at(open, &g, &mut memory.part);
            if memory.part.unsure.any() {
                to.doubt(memory.part.unsure, F8::ZERO);
            }
            memory.part.unsure = M8::NONE;
            true
        },
    )
}

/// The form `n·(x, 1, z)` that vanishes on the traces of eight rays, with a bound on its slope and
/// the bound `e + e_reach R` on the errors of its values at points of size `R`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Form8 {
    n: [F8; 3],
    size: F8,
    e: F8,
    e_reach: F8,
}

impl Form8 {
    #[inline(always)]
    fn of(conic: bool, memory: &PrismScratch) -> Self {
        let PrismScratch { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, .. } = *memory;
        let (n, e, e_reach) = if conic {
            let n = [oy.mul_add(dz, -(oz * dy)), oz.mul_add(dx, -(ox * dz)), ox.mul_add(dy, -(oy * dx))];
            let (o1, d1) = (ox.abs() + oy.abs() + oz.abs(), dx.abs() + dy.abs() + dz.abs());
            let e = o1 * e_d + d1 * e_o + o1 * d1 * (4.0 * U);
            (n, e, e * 2.0)
        } else {
            let n = [dz, dx.mul_add(oz, -(dz * ox)), -dx];
            let (o1, d1) = (ox.abs() + oz.abs(), dx.abs() + dz.abs());
            (n, d1 * e_o + o1 * e_d + o1 * d1 * (4.0 * U), e_d * 2.0)
        };
        let [x, w, z] = n;
        let size = x.abs() + z.abs();
        Self { n, size, e: e + w.abs() * (4.0 * U), e_reach: e_reach + size * (4.0 * U) }
    }
}

/// Finds the next root of the cubic. Returns false if no lane has one.
pub(super) fn parted<K: Sink8>(rays: &RayLanes<'_>, to: &mut K, memory: &mut PrismScratch) -> bool {
    let isa = rays.isa;
    memory.poly.isolate(isa, &mut memory.part);
    if memory.part.unsure.any() {
        to.doubt(memory.part.unsure, F8::ZERO);
        memory.part.unsure = M8::NONE;
    }
    if !memory.part.one.any() {
        return false;
    }
    memory.poly.refine(isa, &memory.part, &mut memory.root);
    true
}

/// Crossings of the rays with a wall.
pub(super) struct Placed8 {
    pub(super) t: F8,
    pub(super) e: F8,
    /// Lanes in which `t` is known within `e`.
    pub(super) known: M8,
    /// Lanes certainly between the heights, and lanes certainly not.
    pub(super) inside: M8,
    pub(super) outside: M8,
}

/// A wall: the number of its face, and whether the inside is to the left of its curve.
#[derive(Clone, Copy)]
pub(super) struct Named {
    pub(super) face: f64,
    pub(super) left: bool,
}

/// Passes all crossings with a wall to `to`; `from` describes rays that start on it.
pub(super) fn wall<K: Sink8>(
    (rays, from): (&RayLanes<'_>, Option<&From8>),
    (curve, sweep, named): (&ProfileCurve8, &Sweep8, Named),
    to: &mut K,
    memory: &mut PrismScratch,
) {
    for _ in 0..3 {
        if !parted(rays, to, memory) {
            return;
        }
        offer((rays, from), (curve, sweep, named), to, memory);
        memory.poly.go_on(&mut memory.part);
    }
}

/// The data from which a ray's parameter at a point of a wall is computed, in addition to one
/// coordinate.
#[derive(Clone, Copy)]
struct WallPoint {
    oy: F8,
    dy: F8,
    e_c: F8,
    e_o: F8,
    e_d: F8,
}

impl WallPoint {
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

/// The roots of the cubic as parameters on the rays.
#[inline(always)]
pub(super) fn placed((curve, sweep): (&ProfileCurve8, &Sweep8), memory: &PrismScratch) -> Placed8 {
    let PrismScratch { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, root, .. } = *memory;
    let ([x, z], slope) = curve.at(root.x);
    // Within the root's error the slope changes by less than `turn e`.
    let (_, turn) = curve.speed();
    let speed = slope[0].abs().max(slope[1].abs()) + root.e * turn + curve.reach * (32.0 * U);
    let e_c = (root.e * speed + curve.rounding()) * SLACK;
    let known = WallPoint { oy, dy, e_c, e_o, e_d };
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
fn offer<K: Sink8>(
    (rays, from): (&RayLanes<'_>, Option<&From8>),
    (curve, sweep, Named { face, left }): (&ProfileCurve8, &Sweep8, Named),
    to: &mut K,
    memory: &mut PrismScratch,
) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Placed8 { t, e, known: steep, inside, outside } = placed((curve, sweep), memory);
            let PrismScratch { part, root, .. } = memory;
            let away = steep & ((t + e).lt(F8::ZERO) | (t - e).gt(to.limit(rays)));
            let falls = part.sign.gt(F8::ZERO);
            let leaves = if left { falls } else { !falls };
            let own = match from {
                Some(from) => {
                    from.lanes & steep & t.abs().le(e) & (leaves & !from.back | !leaves & from.back)
                }
                None => M8::NONE,
            };
            let open = part.one & !(steep & outside | away | own);
            let sure = open & steep & inside & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
            to.take_at(sure, (t, e), F8::splat(face), tag_of(root.x, M8::splat(left)));
            let unsure = open & !sure;
            if unsure.any() {
                let from = steep.select(t - e, F8::ZERO);
                to.doubt(unsure, from);
            }
        },
    );
}
