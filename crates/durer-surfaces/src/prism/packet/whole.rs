//! Packets against prisms whose outlines may cross themselves. A point is inside where the outlines
//! go round it an odd number of times.
//!
//! All crossings of a ray's line with walls and caps are found. Those before the start decide
//! whether the ray starts inside, and so on which side of the next crossing the solid lies. If one
//! crossing is uncertain, or two cannot be ordered, everything from there on is a doubt. Rays that
//! start on such a solid start so far from it (see `Swept::points`) that the crossing they left is
//! certainly behind them.
//!
//! As CSG operands such prisms report each crossing and the side on which the solid lies, given by
//! the number of crossings before it. For prisms whose outlines do not cross, the side of each
//! curve is known, and only crossings ahead of the rays are needed.
//!
//! A conic sweep may end in its apex, where there is no cap. A ray that passes the apex so closely
//! that its trace is unknown is a doubt.

use super::caps::{conclude, count, flipped, reach};
use super::walls::{Named, cubic_of, enclose, enclose_all, parted, placed, wall};
use super::{PrismScratch, ProfileCurve8, Sweep8, see, side_of, tag_of};
use crate::packet::closest::PacketQuery;
use crate::packet::crossings::Crossings;
use crate::packet::local_frame::Own;
use crate::packet::quadric::Start;
use crate::packet::rays::{CLEAR, From8, Nearest, RayLanes, SLACK};
use crate::packet::sink::{First, Sink8};
use durer_math::{F8, M8, U};

/// The crossings of eight lines found so far.
#[derive(Debug, Default)]
struct Tally {
    inside: M8,
    /// The first crossing ahead: its face, its place on the curve, and whether the trace falls
    /// there.
    t: F8,
    e: F8,
    face: F8,
    tag: F8,
    falls: M8,
}

/// Receives the crossings of eight lines, those before the start included.
trait Line8: Sink8 {
    /// Rays that certainly cross face `i` at `t`, known within `e`; the wall's tag without the
    /// side, and whether the trace falls there.
    fn cross(&mut self, on: M8, at: (F8, F8), face: usize, way: (F8, M8));
}

/// Passes the first crossing of each ray to `nearest`.
pub(super) fn meet(
    own: &Own,
    asked: &PacketQuery<'_>,
    start: &Start,
    (curves, sweep): (&[ProfileCurve8], &Sweep8),
    nearest: &mut Nearest,
    memory: &mut PrismScratch,
) {
    let rays = asked.rays;
    let mut to = Tallied { first: First { nearest, number: asked.number }, tally: Tally::default() };
    to.tally.t = F8::splat(f64::INFINITY);
    each(own, rays, start, (curves, sweep), &mut to, memory);
    let Tallied { first: First { nearest, number }, tally } = to;
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let Tally { inside, t, e, face, tag, falls } = tally;
            let met = *rays.live & t.lt(F8::splat(f64::INFINITY)) & !(t - e).gt(nearest.limit(rays));
            let sure = met & (t + e).le(*rays.t_max);
            // A ray that starts inside leaves here: where the trace falls, the inside is to the
            // left of the curve.
            nearest.take_at(sure, (t, e), number, face, tag_of(tag, left_of(inside, falls)));
            nearest.doubt_from(met & !sure, t - e);
        },
    );
}

/// Whether the inside is to the left of a curve that a ray crosses.
#[inline(always)]
fn left_of(from_inside: M8, falls: M8) -> M8 {
    !flipped(from_inside, falls)
}

/// Stores all crossings. For prisms whose outlines do not cross, the side of each curve is known.
pub(super) fn crossings(
    own: &Own,
    (rays, leaving): (&RayLanes<'_>, Option<(&From8, bool)>),
    start: &Start,
    (curves, sweep, left): (&[ProfileCurve8], &Sweep8, Option<&[bool]>),
    to: &mut Crossings,
    memory: &mut PrismScratch,
) {
    let Some(left) = left else {
        each(own, rays, start, (curves, sweep), to, memory);
        return settle(rays, to);
    };
    see_in_lanes(own, rays, start, memory);
    if !enclose(rays, sweep, to, memory, true) {
        return;
    }
    enclose_all(rays, memory);
    for (i, (curve, &left)) in curves.iter().zip(left).enumerate() {
        if !curve.is_beside(&memory.around) && cubic_of(rays, curve, to, memory) {
            let named = Named { face: i as f64, left };
            wall((rays, leaves(leaving, i).as_ref()), (curve, sweep, named), to, memory);
        }
    }
    for (face, top) in (curves.len()..).zip([false, true]) {
        if !sweep.has_tip(top)
            && reach((rays, leaves(leaving, face).as_ref()), (sweep, top), to, memory, true)
        {
            count(rays.isa, curves, memory);
            conclude(rays, face as f64, to, memory);
        }
    }
}

/// The rays that start on a face.
#[inline(always)]
fn leaves(leaving: Option<(&From8, bool)>, face: usize) -> Option<From8> {
    let (from, turned) = leaving?;
    let lanes = from.lanes & from.face.equals(F8::splat(face as f64));
    lanes.any().then_some(From8 { lanes, ..from.by_own_normals(turned) })
}

/// For the `asked` rays, as bit masks: points at `t`, known within `e`, that are certainly inside
/// the solid, and those that are certainly outside.
pub(super) fn holds(
    own: &Own,
    rays: &RayLanes<'_>,
    start: &Start,
    ((t, e), asked): ((F8, F8), u8),
    (curves, sweep): (&[ProfileCurve8], &Sweep8),
    memory: &mut PrismScratch,
) -> (u8, u8) {
    see_in_lanes(own, rays, start, memory);
    let (mut between, mut beyond) = (M8::NONE, M8::NONE);
    let open = rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { o: [ox, oy, oz], d: [dx, dy, dz], e_o, e_d, .. } = *memory;
            let (mut x, y, mut z) = (t.mul_add(dx, ox), t.mul_add(dy, oy), t.mul_add(dz, oz));
            let d1 = dx.abs() + dy.abs() + dz.abs();
            let size = x.abs() + y.abs() + z.abs();
            let mut e = (e_o + t.abs() * e_d + e * d1 + size * (4.0 * U)) * SLACK;
            let e_y = e + sweep.low.abs().max(sweep.high.abs()) * (4.0 * U);
            let (low, high) = (y - sweep.low, y - sweep.high);
            between = low.gt(e_y) & high.lt(-e_y);
            beyond = low.lt(-e_y) | high.gt(e_y);
            let mut known = e.lt(F8::splat(f64::INFINITY));
            if sweep.conic {
                // `(e + |x / y| e) / (|y| - e)`, and two roundings.
                known &= y.abs().gt(e * CLEAR);
                let inverse = F8::ONE / y;
                (x, z) = (x * inverse, z * inverse);
                let far = x.abs() + z.abs();
                e = (e * (far + 1.0) * inverse.abs() * (CLEAR / (CLEAR - 1.0)) + far * (8.0 * U)) * SLACK;
            }
            (memory.place, memory.e_place) = ([x, z], e);
            memory.unsure = !known;
            memory.open = M8::from_bits(asked) & known & !beyond;
            memory.odd = M8::NONE;
            memory.open.any()
        },
    );
    if open {
        count(rays.isa, curves, memory);
    }
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let counted = memory.open & !memory.unsure;
            ((counted & memory.odd & between).bits(), (beyond | counted & !memory.odd).bits())
        },
    )
}

#[inline(never)]
fn see_in_lanes(own: &Own, rays: &RayLanes<'_>, start: &Start, memory: &mut PrismScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || see(own, rays, start, memory),
    );
}

/// Passes all crossings of eight lines to `lines`.
fn each<L: Line8>(
    own: &Own,
    rays: &RayLanes<'_>,
    start: &Start,
    (curves, sweep): (&[ProfileCurve8], &Sweep8),
    to: &mut L,
    memory: &mut PrismScratch,
) {
    see_in_lanes(own, rays, start, memory);
    if !enclose(rays, sweep, to, memory, false) {
        return;
    }
    enclose_all(rays, memory);
    for (i, curve) in curves.iter().enumerate() {
        if curve.is_beside(&memory.around) || !cubic_of(rays, curve, to, memory) {
            continue;
        }
        for _ in 0..3 {
            if !parted(rays, to, memory) {
                break;
            }
            show_wall(rays, (curve, sweep, i), to, memory);
            memory.poly.go_on(&mut memory.part);
        }
    }
    for (face, top) in (curves.len()..).zip([false, true]) {
        if sweep.has_tip(top) || !reach((rays, None), (sweep, top), to, memory, false) {
            continue;
        }
        count(rays.isa, curves, memory);
        show_cap(rays, face, to, memory);
    }
}

#[inline(never)]
fn show_wall<L: Line8>(
    rays: &RayLanes<'_>,
    (curve, sweep, face): (&ProfileCurve8, &Sweep8, usize),
    to: &mut L,
    memory: &PrismScratch,
) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let at = placed((curve, sweep), memory);
            let on = memory.part.one & at.known & at.inside;
            let unsure = memory.part.one & !(at.known & (at.inside | at.outside));
            if unsure.any() {
                to.doubt(unsure, at.known.select(at.t - at.e, F8::ZERO));
            }
            to.cross(on, (at.t, at.e), face, (memory.root.x, memory.part.sign.gt(F8::ZERO)));
        },
    );
}

#[inline(never)]
fn show_cap<L: Line8>(rays: &RayLanes<'_>, face: usize, to: &mut L, memory: &PrismScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PrismScratch { t, e, open, odd, unsure, .. } = memory;
            if unsure.any() {
                to.doubt(*unsure, *t - *e);
            }
            to.cross(*open & *odd & !*unsure, (*t, *e), face, (F8::ZERO, M8::NONE));
        },
    );
}

/// The first crossing ahead.
struct Tallied<'n> {
    first: First<'n>,
    tally: Tally,
}

impl Sink8 for Tallied<'_> {
    const ALL: bool = true;
    #[inline(always)]
    fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        self.first.limit(rays)
    }
    #[inline(always)]
    fn take(&mut self, sure: M8, at: (F8, F8), face: F8) {
        self.first.take(sure, at, face);
    }
    #[inline(always)]
    fn take_at(&mut self, sure: M8, at: (F8, F8), face: F8, tag: F8) {
        self.first.take_at(sure, at, face, tag);
    }
    #[inline(always)]
    fn doubt(&mut self, lanes: M8, t: F8) {
        self.first.doubt(lanes, t);
    }
}

impl Line8 for Tallied<'_> {
    #[inline(always)]
    fn cross(&mut self, on: M8, (t, e): (F8, F8), face: usize, (tag, falls): (F8, M8)) {
        let tally = &mut self.tally;
        let behind = on & (t + e).lt(F8::ZERO);
        let ahead = on & (t - e).gt(F8::ZERO);
        tally.inside = flipped(tally.inside, behind);
        // Either of the two may be the first.
        let tied = ahead & (t - tally.t).abs().le((e + tally.e) * SLACK);
        let tied_from = (t - e).min(tally.t - tally.e);
        let better = ahead & t.lt(tally.t);
        tally.t.set_where(better, t);
        tally.e.set_where(better, e);
        tally.face.set_where(better, F8::splat(face as f64));
        tally.tag.set_where(better, tag);
        tally.falls = better & falls | !better & tally.falls;
        let here = on & !(behind | ahead);
        if here.any() {
            self.doubt(here, t - e);
        }
        if tied.any() {
            self.doubt(tied, tied_from);
        }
    }
}

impl Line8 for Crossings {
    /// Until all crossings are known, the tag stores whether the trace falls.
    #[inline(always)]
    fn cross(&mut self, on: M8, (t, e): (F8, F8), face: usize, (tag, falls): (F8, M8)) {
        self.push(on, t, e, (F8::splat(face as f64), tag_of(tag, falls)));
    }
}

/// Finds the side of each crossing on which the solid lies, and pairs of crossings that cannot be
/// ordered.
#[inline(never)]
fn settle(rays: &RayLanes<'_>, to: &mut Crossings) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            for i in 0..to.all().len() {
                let this = to.all()[i];
                let mut inside = M8::NONE;
                for j in 0..to.all().len() {
                    let other = to.all()[j];
                    let both = this.sure & other.sure;
                    let apart = (this.t - other.t).abs().gt((this.e + other.e) * SLACK);
                    inside = flipped(inside, both & apart & other.t.lt(this.t));
                    let behind = (this.t + this.e).max(other.t + other.e).lt(F8::ZERO);
                    let tied = both & !(apart | behind);
                    if i < j && tied.any() {
                        to.doubt(tied, (this.t - this.e).min(other.t - other.e));
                    }
                }
                let (tag, falls) = side_of(this.tag);
                to.all()[i].tag = tag_of(tag, left_of(inside, falls));
            }
        },
    );
}
