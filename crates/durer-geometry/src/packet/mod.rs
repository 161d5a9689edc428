//! Packets of eight rays.
//!
//! A packet tests the packet filters of a bundle's candidates. A ray for which a filter leaves a
//! doubt then tests the surfaces themselves, as a single ray.

mod rays;
mod together;

pub use self::rays::{Hits8, Rays8, Sources8};

use self::rays::slot_number;
use self::together::MANY;
use crate::bundle::Candidate;
use crate::csg::{Memory, PacketCsg};
use crate::filter_cache::FilterKind;
use crate::ids::Id;
use crate::interleave::Abreast;
use crate::{CandidateList, Geometry};
use arrayvec::ArrayVec;
use core::slice;
use durer_math::lanes::LANES;
use durer_math::{Aabb, F8, Isa, M8, Point3, Ray, RaySide, Shaft, Source, Vec3};
use durer_surfaces::packet::{self, Nearest, PacketFilter, PacketQuery, Points8, RayLanes};
use durer_surfaces::{Need, PREVIEW_WIDTH};

/// Reusable memory for packet queries, which need not be cleared.
#[derive(Debug, Default)]
pub struct Scratch {
    outline: packet::Scratch,
    body: Memory,
    abreast: Abreast,
}

/// A face of a packet filter, with the numbers of hits on it.
struct Face<'g> {
    outline: &'g PacketFilter,
    face: u32,
    turned: bool,
    name: Id,
    slot: u64,
    part: u32,
}

/// The slots from which eight rays start.
type Slots = ArrayVec<u64, LANES>;

/// Boxes around points, lane by lane.
struct Bounds8 {
    min: Vec3<F8>,
    max: Vec3<F8>,
}

impl Bounds8 {
    const NONE: Self = Self {
        min: Vec3::splat(Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY)),
        max: Vec3::splat(Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY)),
    };

    #[inline(always)]
    fn take(&mut self, live: M8, p: Vec3<F8>) {
        let (a, b) = (self.min, self.max);
        self.min.set_where(live, Vec3::new(p.x.min(a.x), p.y.min(a.y), p.z.min(a.z)));
        self.max.set_where(live, Vec3::new(p.x.max(b.x), p.y.max(b.y), p.z.max(b.z)));
    }

    /// The box around all lanes.
    fn all(&self) -> Aabb {
        let least = |v: F8| v.0.into_iter().fold(f64::INFINITY, f64::min);
        let most = |v: F8| v.0.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let (a, b) = (self.min, self.max);
        Aabb::new(
            Point3::new(least(a.x), least(a.y), least(a.z)),
            Point3::new(most(b.x), most(b.y), most(b.z)),
        )
    }
}

/// The source of all rays, if they have the same one and start on the same side of it.
fn common_source(isa: Isa, rays: &[Rays8]) -> Option<Source> {
    let source = rays.iter().find_map(|r| r.live.first_set().map(|i| r.source.lane(i)))??;
    let (slot, back) = (slot_number(source.arena, source.index), M8::splat(source.side == RaySide::Back));
    let shared = isa.run_in_lanes(
        #[inline(always)]
        || {
            for Rays8 { live, source: from, .. } in rays {
                let side = from.back & back | !from.back & !back;
                if (*live & !(from.leave(slot) & side)).any() {
                    return false;
                }
            }
            true
        },
    );
    (source.instance == 0 && shared).then_some(source)
}

/// Stores the waiting lanes that have these numbers, and returns their bits.
#[inline(never)]
fn together(isa: Isa, waiting: &M8, (number, n): (&F8, f64), (face, f): (&F8, f64), to: &mut M8) -> u8 {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            *to = *waiting & number.equals(F8::splat(n)) & face.equals(F8::splat(f));
            to.bits()
        },
    )
}

/// Whether each ray certainly hits something.
#[inline(never)]
fn all_meet(isa: Isa, rays: &Rays8, nearest: &Nearest) -> bool {
    isa.run_in_lanes(
        #[inline(always)]
        || (!rays.live | nearest.t.lt(F8::splat(f64::INFINITY))).all(),
    )
}

impl Geometry {
    /// What the rays of some packets may hit; `None` if that is so much that each ray should search
    /// by itself.
    pub fn bundle_candidates(&self, rays: &[Rays8]) -> Option<CandidateList> {
        let (mut start, mut ahead) = (Bounds8::NONE, Bounds8::NONE);
        let mut longer = M8::NONE;
        // The bounds are in memory between these steps, since the compiler mixes the lanes of
        // larger closures.
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                for Rays8 { origin, t_max, live, .. } in rays {
                    start.take(*live, origin.to_vec());
                    longer |= *live & !t_max.le(F8::ONE);
                }
            },
        );
        // The shaft of the longer rays, of which only the directions matter, contains the shorter
        // ones.
        let shaft = if longer.any() {
            self.isa.run_in_lanes(
                #[inline(always)]
                || {
                    for Rays8 { direction, live, .. } in rays {
                        ahead.take(*live, *direction);
                    }
                },
            );
            let way = ahead.all();
            Shaft::new(start.all(), way.min.to_vec(), way.max.to_vec())
        } else {
            self.isa.run_in_lanes(
                #[inline(always)]
                || {
                    for Rays8 { origin, direction, live, .. } in rays {
                        let (o, d) = (origin.to_vec(), *direction);
                        ahead.take(*live, Vec3::new(o.x + d.x, o.y + d.y, o.z + d.z));
                    }
                },
            );
            Shaft::between(start.all(), ahead.all())
        };
        self.candidates(&shaft, common_source(self.isa, rays))
    }

    /// Stores the first hit of each ray of some packets, with the answers of
    /// [`Masked::first_visible`](crate::Masked::first_visible). `beam` lists the surfaces that these
    /// rays may hit, if that is known. The contents of `scratch` do not matter.
    pub fn first_visible8(
        &self,
        beam: Option<&CandidateList>,
        rays: &[Rays8],
        mask: u32,
        hits: &mut [Hits8],
        scratch: &mut Scratch,
    ) {
        if let Some(beam) = beam
            && self.is_asked_together(beam, mask)
        {
            for (rays, hits) in rays.chunks(MANY).zip(hits.chunks_mut(MANY)) {
                self.see_together(beam, rays, mask, hits, scratch);
            }
            return;
        }
        for (rays, hits) in rays.iter().zip(hits) {
            self.see_eight(beam, rays, mask, hits, scratch);
        }
    }

    fn see_eight(
        &self,
        beam: Option<&CandidateList>,
        rays: &Rays8,
        mask: u32,
        hits: &mut Hits8,
        scratch: &mut Scratch,
    ) {
        hits.forget();
        if !rays.live.any() || beam.is_some_and(CandidateList::is_empty) {
            return;
        }
        let mut own = None;
        let beam = beam.or_else(|| {
            own = self.bundle_candidates(slice::from_ref(rays));
            own.as_ref()
        });
        let Some(beam) = beam else {
            let (alone, lanes) = one_by_one(rays);
            let put = |i: usize, seen| hits.set_lane(lanes[i], seen);
            return self.seen_abreast(&alone, mask, Need::SHADING_NORMAL, &mut scratch.abreast, put);
        };
        // Compiled for these instructions, as it also fills and copies whole packets.
        let left = self.isa.run_in_lanes(
            #[inline(always)]
            || self.see(beam, rays, mask, hits, scratch),
        );
        self.see_alone(beam, (rays, left), mask, hits);
    }

    /// Computes the hits of rays with a doubt as single rays.
    fn see_alone(&self, beam: &CandidateList, (rays, left): (&Rays8, M8), mask: u32, hits: &mut Hits8) {
        for i in left.lanes() {
            hits.set_lane(i, self.seen_in(beam, &rays.lane(i), mask, Need::SHADING_NORMAL));
        }
    }

    /// Stores the hits that are certain, and returns the rays with a doubt. Works in lanes, like
    /// [`Geometry::nearest`].
    #[inline(always)]
    fn see(
        &self,
        beam: &CandidateList,
        rays: &Rays8,
        mask: u32,
        hits: &mut Hits8,
        scratch: &mut Scratch,
    ) -> M8 {
        let lanes = RayLanes::new(self.isa, &rays.origin, &rays.direction, &rays.t_max, &rays.live);
        let mut nearest = Nearest::of(&lanes);
        self.nearest::<false>(beam, rays, &lanes, mask, &mut nearest, scratch);
        self.take_down(beam, rays, &lanes, &nearest, hits)
    }

    /// Stores the nearest hits that are certain, and returns the rays with a doubt.
    #[inline(always)]
    fn take_down(
        &self,
        beam: &CandidateList,
        rays: &Rays8,
        lanes: &RayLanes<'_>,
        nearest: &Nearest,
        hits: &mut Hits8,
    ) -> M8 {
        let Nearest { t, e, doubt, number, face, tag } = nearest;
        let never = F8::splat(f64::INFINITY);
        // Known within the preview width, and before every doubt.
        let clear = t.lt(never) & doubt.gt(*t + *e) & e.le(*t * (0.5 * PREVIEW_WIDTH));
        let mut left = rays.live & !(clear | t.ge(never) & doubt.ge(never));
        let mut waiting = clear.bits();
        (hits.t, hits.t_error) = (*t, *e);
        let (mut is_first, mut these) = (true, M8::NONE);
        while waiting != 0 {
            let i = waiting.trailing_zeros() as usize;
            let (n, f) = (number.0[i], face.0[i]);
            waiting &= !together(self.isa, &clear, (number, n), (face, f), &mut these);
            let candidate = &beam.candidates[n as usize];
            let Some(met) = self.face(candidate, f) else { continue };
            let Hits8 { p, ng, ns, off, .. } = &mut *hits;
            let to = Points8 { p, ng, ns, off };
            let sure = met.outline.points(met.face as usize, lanes, (t, tag), &these, to);
            left |= these & !sure;
            hits.hit |= sure;
            if met.turned {
                hits.ng.set_where(sure, -hits.ng);
                hits.ns.set_where(sure, -hits.ns);
            }
            let face = met.outline.face_of(met.face);
            let lanes = if is_first { u8::MAX } else { sure.bits() };
            hits.name(lanes, met.name, (met.slot, met.part, face));
            is_first = false;
        }
        left
    }

    /// The face that a packet filter denotes by a number.
    #[inline(always)]
    fn face(&self, candidate: &Candidate, face: f64) -> Option<Face<'_>> {
        let Candidate { arena, slot, name, .. } = *candidate;
        match self.seen_of(arena, slot) {
            FilterKind::Outline(outline) => {
                let part = self.arenas[arena as usize].part(slot).0;
                let (face, slot) = (face as u32, slot_number(arena, slot));
                Some(Face { outline, face, turned: false, name, slot, part })
            }
            FilterKind::Body(body) => {
                let skin = body.skin(face);
                let (name, slot) = (PacketCsg::name(name, &skin), slot_number(arena, skin.slot));
                let (outline, face, turned) = (skin.outline, skin.face, skin.turned);
                Some(Face { outline, face, turned, name, slot, part: 0 })
            }
            FilterKind::Nothing => None,
        }
    }

    /// The first certain hit of each ray among the candidates, and the first doubt. If `ANY` hit
    /// suffices it may be another hit, and the search ends when each ray has one.
    #[inline(always)]
    fn nearest<const ANY: bool>(
        &self,
        beam: &CandidateList,
        rays: &Rays8,
        lanes: &RayLanes<'_>,
        mask: u32,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        let mut sources = ArrayVec::new();
        rays.source.all(&mut sources);
        for (number, candidate) in beam.candidates.iter().enumerate() {
            if candidate.mask & mask == 0 {
                continue;
            }
            self.ask::<ANY>((candidate, number), (rays, &sources), lanes, nearest, scratch);
            if ANY && all_meet(self.isa, rays, nearest) {
                return;
            }
        }
    }

    /// Tests one of the candidates.
    #[inline(always)]
    fn ask<const ANY: bool>(
        &self,
        (candidate, number): (&Candidate, usize),
        (rays, sources): (&Rays8, &Slots),
        lanes: &RayLanes<'_>,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        let Candidate { arena, slot, .. } = *candidate;
        let number = number as f64;
        match self.seen_of(arena, slot) {
            FilterKind::Outline(outline) => {
                let leaves = sources.contains(&slot_number(arena, slot));
                let from = leaves.then(|| rays.source.of(arena, slot, outline));
                let asked = PacketQuery { rays: lanes, from: from.as_ref(), number, any: ANY };
                outline.meet(&asked, nearest, &mut scratch.outline);
            }
            FilterKind::Body(body) => {
                let memory = (&mut scratch.outline, &mut scratch.body);
                body.meet(self.isa, (arena, number), (rays, lanes), nearest, memory);
            }
            FilterKind::Nothing => nearest.doubt = F8::ZERO,
        }
    }

    /// Stores which rays of some packets hit anything, with the answers of
    /// [`Masked::any`](crate::Masked::any).
    pub fn any8(
        &self,
        beam: Option<&CandidateList>,
        rays: &[Rays8],
        mask: u32,
        met: &mut [M8],
        scratch: &mut Scratch,
    ) {
        if let Some(beam) = beam
            && self.is_asked_together(beam, mask)
        {
            for (rays, met) in rays.chunks(MANY).zip(met.chunks_mut(MANY)) {
                self.any_together(beam, rays, mask, met, scratch);
            }
            return;
        }
        for (rays, met) in rays.iter().zip(met) {
            *met = self.any_of_eight(beam, rays, mask, scratch);
        }
    }

    fn any_of_eight(
        &self,
        beam: Option<&CandidateList>,
        rays: &Rays8,
        mask: u32,
        scratch: &mut Scratch,
    ) -> M8 {
        if !rays.live.any() || beam.is_some_and(CandidateList::is_empty) {
            return M8::NONE;
        }
        let mut own = None;
        let beam = beam.or_else(|| {
            own = self.bundle_candidates(slice::from_ref(rays));
            own.as_ref()
        });
        let mut met = M8::NONE;
        let Some(beam) = beam else {
            let (alone, lanes) = one_by_one(rays);
            self.any_abreast(&alone, mask, &mut scratch.abreast, |i, is_met| met.set_lane(lanes[i], is_met));
            return met;
        };
        let mut left = M8::NONE;
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                let lanes = RayLanes::new(self.isa, &rays.origin, &rays.direction, &rays.t_max, &rays.live);
                let mut nearest = Nearest::of(&lanes);
                self.nearest::<true>(beam, rays, &lanes, mask, &mut nearest, scratch);
                (met, left) = sure(rays, &nearest);
            },
        );
        self.meet_alone(beam, (rays, left), mask, &mut met);
        met
    }

    /// Decides for rays with a doubt, as single rays, whether they hit anything.
    fn meet_alone(&self, beam: &CandidateList, (rays, left): (&Rays8, M8), mask: u32, met: &mut M8) {
        for i in left.lanes() {
            met.set_lane(i, self.any_in(beam, &rays.lane(i), mask));
        }
    }
}

/// The rays of a packet, and their lanes.
fn one_by_one(rays: &Rays8) -> (ArrayVec<Ray, LANES>, ArrayVec<usize, LANES>) {
    rays.live.lanes().map(|i| (rays.lane(i), i)).unzip()
}

/// Which rays certainly hit something, and for which it is in doubt.
#[inline(always)]
fn sure(rays: &Rays8, nearest: &Nearest) -> (M8, M8) {
    let never = F8::splat(f64::INFINITY);
    let met = nearest.t.lt(never) & rays.live;
    (met, rays.live & !(met | nearest.doubt.ge(never)))
}

#[cfg(test)]
mod tests;
