//! Bundles: rays that share one search through the tree.

use crate::closest::ClosestHit;
use crate::geometry::{Geometry, slots};
use crate::ids::{EVERYTHING, Id};
use crate::query::{any_in, closest_in};
use crate::{Hit, context::RayContext};
use arrayvec::ArrayVec;
use durer_bvh::Leaf;
use durer_math::{Ray, Shaft, Source};
use durer_surfaces::{Need, SurfacePoint};

/// The primitives that the rays of a bundle may hit, in the order of object and primitive.
#[derive(Clone, Debug, Default)]
pub struct CandidateList {
    pub(crate) candidates: ArrayVec<Candidate, { CandidateList::MOST }>,
}

/// A slot that rays may hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) arena: u32,
    pub(crate) slot: u32,
    pub(crate) name: Id,
    pub(crate) mask: u32,
}

impl Candidate {
    fn leaf(self) -> Leaf {
        Leaf::new(self.arena, self.slot, 1)
    }
}

impl CandidateList {
    /// The greatest number of slots. With more, the tree is faster.
    const MOST: usize = 64;
    /// The greatest number of slots for one ray.
    const FEW: usize = 12;
    /// The greatest number of triangles of large meshes: the tree tests sixteen of them at once,
    /// and few rays would share the packet filter of each.
    const TRIANGLES: u32 = 8;
    /// Meshes with more leaves than this count as large.
    const DENSE: usize = 512;

    /// Whether the rays certainly hit nothing.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.candidates.is_empty()
    }

    /// Whether the rays may hit something whose mask has a common bit with `mask`; `false` is
    /// certain.
    pub fn admits(&self, mask: u32) -> bool {
        self.candidates.iter().any(|candidate| candidate.mask & mask != 0)
    }
}

impl Geometry {
    /// The slots that the rays of a bundle may hit; `None` if there are so many that each ray
    /// should search the tree by itself. If there is a `source`, all rays start on the same side of
    /// it.
    pub fn candidates(&self, shaft: &Shaft, source: Option<Source>) -> Option<CandidateList> {
        let mut beam = CandidateList::default();
        let candidates = &mut beam.candidates;
        for beside in &self.beside {
            for slot in slots(&beside.leaf()) {
                let is_source = |s: &Source| (s.arena, s.index) == (beside.arena, slot);
                let missed = self.arenas.get(beside.arena as usize).is_some_and(|arena| {
                    source.filter(is_source).is_some_and(|s| arena.is_left(slot, s.side, shaft))
                        || arena.misses(slot, shaft)
                });
                if !missed {
                    candidates.try_push(self.candidate(beside.arena, slot)).ok()?;
                }
            }
        }
        let dense = self.tree.blocks() > CandidateList::DENSE;
        let mut triangles = 0;
        let full = self.tree.in_shaft(self.isa, shaft, |leaf| {
            if dense && self.tree.is_of_triangles(leaf.kind) {
                triangles += leaf.count;
                if triangles > CandidateList::TRIANGLES {
                    return true;
                }
            }
            slots(&leaf).any(|slot| {
                // For a single slot the tree has already tested the box.
                let missed = leaf.count > 1 && self.slot_misses(leaf.kind, slot, shaft);
                !missed && candidates.try_push(self.candidate(leaf.kind, slot)).is_err()
            })
        });
        // Of two hits with the same `t` the first one tested is kept.
        candidates.sort_unstable_by_key(|c| (c.name.object, c.name.primitive, c.arena, c.slot));
        // A triangle may be in several leaves.
        let mut last = None;
        candidates.retain(|c| last.replace((c.arena, c.slot)) != Some((c.arena, c.slot)));
        (!full).then_some(beam)
    }

    fn candidate(&self, arena: u32, slot: u32) -> Candidate {
        let (name, mask) = match self.arenas.get(arena as usize) {
            Some(a) => (a.name(slot), a.mask(slot)),
            // An instance has no numbers of its own, and is always tested.
            None => (Id { object: u32::MAX, primitive: u32::MAX }, EVERYTHING),
        };
        Candidate { arena, slot, name, mask }
    }

    /// The answer of [`Masked::first_visible`](crate::Masked::first_visible) for a ray of the bundle
    /// that `beam` was made for.
    #[inline]
    pub fn seen_in(
        &self,
        beam: &CandidateList,
        ray: &Ray,
        mask: u32,
        need: Need,
    ) -> Option<(Hit, SurfacePoint)> {
        if beam.is_empty() {
            return None;
        }
        if beam.candidates.len() > CandidateList::FEW {
            return self.masked(mask).first_visible(ray, need);
        }
        self.walk_roughly(
            ray,
            mask,
            #[inline(always)]
            |walk: &RayContext<'_>| {
                let mut best = ClosestHit::least();
                for candidate in &beam.candidates {
                    closest_in(walk, candidate.leaf(), &mut best);
                }
                let hit = best.hit?;
                Some((hit, self.point_of(walk.ray, ray.source(), &hit, need)))
            },
        )?
    }

    /// The answer of [`Masked::any`](crate::Masked::any) for a ray of the bundle that `beam` was made
    /// for.
    #[inline]
    pub fn any_in(&self, beam: &CandidateList, ray: &Ray, mask: u32) -> bool {
        if beam.candidates.len() > CandidateList::FEW {
            return self.masked(mask).any(ray);
        }
        !beam.is_empty()
            && self.walk_roughly(
                ray,
                mask,
                #[inline(always)]
                |walk: &RayContext<'_>| {
                    for candidate in &beam.candidates {
                        if any_in(walk, candidate.leaf()) {
                            return true;
                        }
                    }
                    false
                },
            ) == Some(true)
    }
}
