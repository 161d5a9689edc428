//! Crossings of eight rays with the caps of a swept solid.

use super::{PrismScratch, ProfileCurve8, Sweep8, cubic, lowest};
use crate::packet::quadratic_roots::quotient;
use crate::packet::rays::{CLEAR, From8, RayLanes, SLACK};
use crate::packet::sink::Sink8;
use durer_math::{F8, Isa, M8, U};

/// The least and the greatest of four numbers.
#[inline(always)]
pub(super) fn range(v: &[f64; 4]) -> (f64, f64) {
    (v.iter().fold(f64::INFINITY, |m, x| m.min(*x)), v.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)))
}

/// A strip along a curve's chord that contains the curve: between the least and the greatest height
/// `h(p) = dx (z - z0) - dz (x - x0)` of its control points. A point beside the strip has either
/// the whole curve ahead or none of it.
struct Strip {
    way: [f64; 2],
    low: f64,
    high: f64,
    /// Bounds the change of a height with a coordinate, and the errors of heights except for those
    /// of their points.
    slope: f64,
    rounding: f64,
}

impl Strip {
    /// A height takes five roundings of numbers no larger than `|dx| + |dz|` times two coordinates.
    #[inline(always)]
    fn of(curve: &ProfileCurve8) -> Self {
        let [xs, zs] = curve.points;
        let way @ [dx, dz] = [xs[3] - xs[0], zs[3] - zs[0]];
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for i in 1..3 {
            let h = dx * (zs[i] - zs[0]) - dz * (xs[i] - xs[0]);
            (low, high) = (low.min(h), high.max(h));
        }
        let slope = dx.abs() + dz.abs();
        Self { way, low, high, slope, rounding: slope * (curve.slack + curve.reach * (32.0 * U)) }
    }
}

/// Computes where the rays meet the plane of a cap. Returns false if none does where it matters:
/// ahead of the rays, or anywhere on their lines.
#[inline(never)]
pub(super) fn reach<K: Sink8>(
    (rays, from): (&RayLanes<'_>, Option<&From8>),
    (sweep, top): (&Sweep8, bool),
    to: &K,
    memory: &mut PrismScratch,
    ahead: bool,
) -> bool {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, .. } = *memory;
            let height = if top { sweep.high } else { sweep.low };
            let steep = dy.abs().gt(e_d * CLEAR);
            let e_h = e_o + height.abs() * (4.0 * U);
            let (t, e) = quotient(-(oy - height), e_h, F8::ONE / dy, e_d);
            // Rays along the plane are doubts from their start on, unless they stay away from it
            // over the whole range that matters.
            let (t, e) = (steep.keep(t), steep.keep(e));
            let rise = (dy.abs() + e_d) * memory.far + e_h + oy.abs() * U;
            let beside = !steep & (oy - height).abs().gt(rise * SLACK);
            let mut open = *rays.live & !beside;
            if ahead {
                if let Some(from) = from {
                    // Outward is up at the top. Rays that start on the cap start on the side to
                    // which they go.
                    let outward = if top { dy.gt(F8::ZERO) } else { dy.lt(F8::ZERO) };
                    open &= !(from.lanes & steep & (outward & !from.back | !outward & from.back));
                }
                open &= !(steep & ((t + e).lt(F8::ZERO) | (t - e).gt(to.limit(rays))));
            }
            memory.unsure = open & !steep;
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

/// Counts, modulo two, how often the line from the point of a cap along x crosses curves.
pub(super) fn count(isa: Isa, curves: &[ProfileCurve8], memory: &mut PrismScratch) {
    let ahead = ahead(isa, memory);
    for curve in curves {
        // No line comes near the curve.
        if !curve.is_beside(&ahead) {
            count_one(isa, curve, memory);
        }
    }
}

/// A box around these lines.
#[inline(never)]
fn ahead(isa: Isa, memory: &PrismScratch) -> [f64; 4] {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { place: [x, z], open, .. } = *memory;
            let e = memory.e_place * SLACK + (x.abs() + z.abs()) * (4.0 * U);
            [lowest(open, x - e), f64::INFINITY, lowest(open, z - e), -lowest(open, -(z + e))]
        },
    )
}

#[inline(never)]
fn count_one(isa: Isa, curve: &ProfileCurve8, memory: &mut PrismScratch) {
    let work = isa.run_in_lanes(
        #[inline(always)]
        || {
            let ([px, pz], e_place) = (memory.place, memory.e_place);
            let [xs, zs] = curve.points;
            let ((x0, x1), (z0, z1)) = (range(&xs), range(&zs));
            let e = e_place + curve.slack;
            // The curve is above, below or behind: no crossing.
            let none = (-(pz - z0)).gt(e) | (pz - z1).gt(e) | (px - x1).gt(e);
            let mut open = memory.open & !none;
            if !open.any() {
                return false;
            }
            let mut g = [F8::ZERO; 4];
            for i in 0..4 {
                g[i] = -(pz - zs[i]);
            }
            // The whole curve is ahead: an odd number of crossings if its ends are on different
            // sides.
            let (first, last) = (g[0], g[3]);
            let certain = first.abs().gt(e) & last.abs().gt(e);
            let ahead = open & (-(px - x0)).gt(e) & certain;
            let changes = (first * last).lt(F8::ZERO);
            memory.odd = flipped(memory.odd, ahead & changes);
            open &= !ahead;
            if !open.any() {
                return false;
            }
            let Strip { way: [dx, dz], low, high, slope, rounding } = Strip::of(curve);
            let h = F8::splat(dx).mul_add(pz - zs[0], -((px - xs[0]) * dz));
            let e_h = ((e_place + (px.abs() + pz.abs()) * (16.0 * U)) * slope + rounding) * SLACK;
            let (above, below) = ((h - high).gt(e_h), (h - low).lt(-e_h));
            // If the chord rises, points above it have the strip ahead.
            let sees = if dz > 0.0 { above } else { below };
            let beside = open & (above | below) & certain;
            memory.odd = flipped(memory.odd, beside & changes & sees);
            open &= !beside;
            if !open.any() {
                return false;
            }
            memory.poly = cubic(g, e * SLACK);
            memory.poly.begin_at(open, &g, &mut memory.part);
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
                let PrismScratch { part, root, .. } = memory;
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
pub(super) fn flipped(odd: M8, where_: M8) -> M8 {
    odd & !where_ | !odd & where_
}

/// Passes the crossing with a cap to `to`.
#[inline(never)]
pub(super) fn conclude<K: Sink8>(rays: &RayLanes<'_>, face: f64, to: &mut K, memory: &mut PrismScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { t, e, open, odd, unsure, .. } = memory;
            let (t, e) = (*t, *e);
            let within = *open & *odd & !*unsure;
            let sure = within & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
            to.take(sure, (t, e), F8::splat(face));
            let unsure = *unsure | within & !sure;
            if unsure.any() {
                to.doubt(unsure, t - e);
            }
        },
    );
}
