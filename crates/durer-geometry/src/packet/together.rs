//! Queries of many packets that test each candidate of their bundle together.
//!
//! Most surfaces are tested by one packet at a time, which is faster, since all data of eight rays
//! stay in registers and cache. Filters that classify segments gain more from many packets at once
//! ([`PacketFilter::meet_together`](durer_surfaces::packet::PacketFilter::meet_together)).

use super::rays::slot_number;
use super::{Hits8, Rays8, Scratch, Slots, all_meet, sure};
use crate::bundle::Candidate;
use crate::filter_cache::FilterKind;
use crate::{CandidateList, Geometry};
use arrayvec::ArrayVec;
use durer_math::M8;
use durer_surfaces::packet::{From8, Nearest, PacketQuery, RayLanes};

/// The greatest number of packets in one query.
pub(super) const MANY: usize = 16;

impl Geometry {
    /// Whether a bundle has a candidate that many packets should test together.
    pub(super) fn is_asked_together(&self, beam: &CandidateList, mask: u32) -> bool {
        let is_one = |candidate: &Candidate| {
            let seen = self.seen_of(candidate.arena, candidate.slot);
            matches!(seen, FilterKind::Outline(outline) if outline.is_asked_together())
        };
        beam.candidates.iter().any(|candidate| candidate.mask & mask != 0 && is_one(candidate))
    }

    /// [`Geometry::first_visible8`] of at most [`MANY`] packets.
    pub(super) fn see_together(
        &self,
        beam: &CandidateList,
        rays: &[Rays8],
        mask: u32,
        hits: &mut [Hits8],
        scratch: &mut Scratch,
    ) {
        hits.iter_mut().for_each(Hits8::forget);
        let mut left = ArrayVec::new();
        self.isa.run_in_lanes(
            #[inline(always)]
            || self.see_many(beam, rays, mask, hits, &mut left, scratch),
        );
        for ((left, rays), hits) in left.into_iter().zip(rays).zip(hits) {
            self.see_alone(beam, (rays, left), mask, hits);
        }
    }

    /// [`Geometry::see`] of at most [`MANY`] packets.
    #[inline(always)]
    pub(super) fn see_many(
        &self,
        beam: &CandidateList,
        rays: &[Rays8],
        mask: u32,
        hits: &mut [Hits8],
        left: &mut ArrayVec<M8, MANY>,
        scratch: &mut Scratch,
    ) {
        let lanes = self.lanes_of(rays);
        let mut nearest = ArrayVec::new();
        self.nearest_together::<false>(beam, rays, &lanes, mask, &mut nearest, scratch);
        for (((rays, lanes), nearest), hits) in rays.iter().zip(&lanes).zip(&nearest).zip(hits) {
            let live = rays.live.any();
            left.push(if live { self.take_down(beam, rays, lanes, nearest, hits) } else { M8::NONE });
        }
    }

    /// [`Geometry::any8`] of at most [`MANY`] packets.
    pub(super) fn any_together(
        &self,
        beam: &CandidateList,
        rays: &[Rays8],
        mask: u32,
        met: &mut [M8],
        scratch: &mut Scratch,
    ) {
        let mut left: ArrayVec<M8, MANY> = ArrayVec::new();
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                let lanes = self.lanes_of(rays);
                let mut nearest = ArrayVec::new();
                self.nearest_together::<true>(beam, rays, &lanes, mask, &mut nearest, scratch);
                for ((rays, nearest), met) in rays.iter().zip(&nearest).zip(&mut *met) {
                    let (those, open) = sure(rays, nearest);
                    *met = those;
                    left.push(open);
                }
            },
        );
        for ((left, rays), met) in left.into_iter().zip(rays).zip(met) {
            self.meet_alone(beam, (rays, left), mask, met);
        }
    }

    #[inline(always)]
    fn lanes_of<'r>(&self, rays: &'r [Rays8]) -> ArrayVec<RayLanes<'r>, MANY> {
        let mut lanes = ArrayVec::new();
        for Rays8 { origin, direction, t_max, live, .. } in rays {
            lanes.push(RayLanes::new(self.isa, origin, direction, t_max, live));
        }
        lanes
    }

    /// [`Geometry::nearest`] of some packets, one candidate after the other.
    #[inline(always)]
    fn nearest_together<const ANY: bool>(
        &self,
        beam: &CandidateList,
        rays: &[Rays8],
        lanes: &[RayLanes<'_>],
        mask: u32,
        nearest: &mut ArrayVec<Nearest, MANY>,
        scratch: &mut Scratch,
    ) {
        let mut sources: ArrayVec<Slots, MANY> = ArrayVec::new();
        let mut open: ArrayVec<bool, MANY> = ArrayVec::new();
        for (rays, lanes) in rays.iter().zip(lanes) {
            nearest.push(Nearest::of(lanes));
            open.push(rays.live.any());
            let mut own = Slots::new();
            rays.source.all(&mut own);
            sources.push(own);
        }
        for (number, candidate) in beam.candidates.iter().enumerate() {
            let Candidate { arena, slot, mask: seen_by, .. } = *candidate;
            if seen_by & mask == 0 {
                continue;
            }
            match self.seen_of(arena, slot) {
                FilterKind::Outline(outline) if outline.is_asked_together() => {
                    let mut from: ArrayVec<Option<From8>, MANY> = ArrayVec::new();
                    for (rays, sources) in rays.iter().zip(&sources) {
                        let leaves = sources.contains(&slot_number(arena, slot));
                        from.push(leaves.then(|| rays.source.of(arena, slot, outline)));
                    }
                    let mut asked: ArrayVec<PacketQuery<'_>, MANY> = ArrayVec::new();
                    for (rays, from) in lanes.iter().zip(&from) {
                        asked.push(PacketQuery {
                            rays,
                            from: from.as_ref(),
                            number: number as f64,
                            any: ANY,
                        });
                    }
                    outline.meet_together(&asked, &open, nearest, &mut scratch.outline);
                }
                _ => {
                    for (i, rays) in rays.iter().enumerate().filter(|(i, _)| open[*i]) {
                        self.ask::<ANY>(
                            (candidate, number),
                            (rays, &sources[i]),
                            &lanes[i],
                            &mut nearest[i],
                            scratch,
                        );
                    }
                }
            }
            if ANY {
                for ((open, rays), nearest) in open.iter_mut().zip(rays).zip(&*nearest) {
                    *open &= !all_meet(self.isa, rays, nearest);
                }
            }
        }
    }
}
