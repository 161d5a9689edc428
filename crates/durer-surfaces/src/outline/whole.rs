//! Swept solids whose outlines may cross themselves, as lanes see them: inside is where the outlines go round an odd number of times.
//!
//! All crossings of a ray's line with walls and caps are told. Those behind the start say whether it is inside, and that says on which side of the first one ahead
//! the solid lies. Where one of them is in doubt, and where two cannot be put in order, there is a doubt from there on. Rays that leave such a solid
//! start so far from it (see `Swept::spot`) that the crossing they left is surely behind.

use super::face::Start;
use super::meet::Question;
use super::own::Own;
use super::rays::{Nearest, SLACK};
use super::swept::{Curve, Memory, Sweep8, count, cubic_of, parted, placed, reach, see};
use durer_math::{F8, M8};

/// What is known of eight lines so far.
#[derive(Debug, Default)]
pub(super) struct Tally {
    inside: M8,
    /// The first crossing ahead: the face, its place round the curve, and whether the trace falls there.
    t: F8,
    e: F8,
    face: F8,
    tag: F8,
    falls: M8,
}

/// Offers the first crossing of each ray to `nearest`.
pub(super) fn meet(
    own: &Own,
    asked: &Question<'_>,
    start: &Start,
    (curves, sweep): (&[Curve], &Sweep8),
    nearest: &mut Nearest,
    memory: &mut Memory,
) {
    let isa = asked.rays.isa;
    isa.run_in_lanes(
        #[inline(always)]
        || {
            see(own, asked, start, memory);
            memory.tally.inside = M8::NONE;
            memory.tally.t = F8::splat(f64::INFINITY);
            memory.tally.e = F8::ZERO;
        },
    );
    for (i, curve) in curves.iter().enumerate() {
        if !cubic_of(asked, (curve, sweep), nearest, memory) {
            continue;
        }
        for _ in 0..3 {
            if !parted(asked, nearest, memory) {
                break;
            }
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    let at = placed((curve, sweep), memory);
                    let on = memory.part.one & at.known & at.inside;
                    let unsure = memory.part.one & !(at.known & (at.inside | at.outside));
                    let (falls, tag) = (memory.part.sign.gt(F8::ZERO), memory.root.x);
                    let from = at.known.select(at.t - at.e, F8::ZERO);
                    take(
                        (on, unsure, from),
                        (at.t, at.e),
                        F8::splat(i as f64),
                        (tag, falls),
                        nearest,
                        memory,
                    );
                },
            );
            memory.poly.go_on(&mut memory.part);
        }
    }
    for top in [false, true] {
        if !reach(asked, (sweep, top), nearest, memory, false) {
            continue;
        }
        for curve in curves {
            count(asked, curve, memory);
        }
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let Memory { t, e, open, odd, unsure, .. } = &*memory;
                let (t, e, on, unsure) = (*t, *e, *open & *odd & !*unsure, *unsure);
                let face = F8::splat((curves.len() + usize::from(top)) as f64);
                take((on, unsure, t - e), (t, e), face, (F8::ZERO, M8::NONE), nearest, memory);
            },
        );
    }
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let rays = asked.rays;
            let Tally { inside, t, e, face, tag, falls } = &memory.tally;
            let (t, e) = (*t, *e);
            let met = *rays.live & t.lt(F8::splat(f64::INFINITY)) & !(t - e).gt(nearest.limit(rays));
            let sure = met & (t + e).le(*rays.t_max);
            // From inside it is left: where the trace falls the inside is to the left of the curve.
            let left = *inside & *falls | !*inside & !*falls;
            let tag = *tag + left.select(F8::splat(2.0), F8::ZERO);
            nearest.take_at(sure, (t, e), asked.number, *face, tag);
            nearest.doubt_from(met & !sure, t - e);
        },
    );
}

/// Counts a crossing, of the lanes on which it surely is one.
#[inline(always)]
fn take(
    (on, unsure, from): (M8, M8, F8),
    (t, e): (F8, F8),
    face: F8,
    (tag, falls): (F8, M8),
    nearest: &mut Nearest,
    memory: &mut Memory,
) {
    let tally = &mut memory.tally;
    let behind = on & (t + e).lt(F8::ZERO);
    let ahead = on & (t - e).gt(F8::ZERO);
    let inside = tally.inside;
    tally.inside = inside & !behind | !inside & behind;
    // Two of which either may be the first.
    let tied = ahead & (t - tally.t).abs().le((e + tally.e) * SLACK);
    let better = ahead & t.lt(tally.t);
    tally.t = better.select(t, tally.t);
    tally.e = better.select(e, tally.e);
    tally.face = better.select(face, tally.face);
    tally.tag = better.select(tag, tally.tag);
    tally.falls = better & falls | !better & tally.falls;
    if (unsure | on & !(behind | ahead)).any() {
        nearest.doubt_from(unsure | on & !(behind | ahead), from);
    }
    if tied.any() {
        nearest.doubt_from(tied, (t - e).min(tally.t - tally.e));
    }
}
