//! Rays that belong together share one walk through the tree.

use crate::best::Best;
use crate::geometry::{Beside, Geometry, slots};
use crate::query::{any_in, closest_in};
use crate::{Hit, walk::Walk};
use arrayvec::ArrayVec;
use durer_bvh::Leaf;
use durer_math::{Ray, Shaft, Source};
use durer_surfaces::{Need, SurfacePoint};

/// What the rays of a bundle may meet: leaves of the tree, and what is beside it.
#[derive(Clone, Debug, Default)]
pub struct Beam {
    leaves: ArrayVec<Leaf, { Beam::MOST }>,
}

impl Beam {
    /// With more leaves than this the tree is the faster way.
    const MOST: usize = 6;

    /// Whether the rays meet nothing.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.leaves.is_empty()
    }
}

impl Geometry {
    /// The surface that a ray leaves, if it is one that no tree holds.
    #[inline]
    pub fn unbounded_source(&self, ray: &Ray) -> Option<Source> {
        let source = ray.source().filter(|s| s.instance == 0)?;
        let holds = |b: &Beside| b.arena == source.arena && slots(&b.leaf()).contains(&source.index);
        self.beside.iter().any(holds).then_some(source)
    }

    /// What the rays of a bundle may meet; `None` if that is so much that each ray should walk through the tree by itself. They all come from
    /// the same side of `source` ([`Geometry::unbounded_source`]), if there is one.
    pub fn beam(&self, shaft: &Shaft, source: Option<Source>) -> Option<Beam> {
        let mut beam = Beam::default();
        for beside in &self.beside {
            for slot in slots(&beside.leaf()) {
                let is_source = |s: &Source| (s.arena, s.index) == (beside.arena, slot);
                let missed = self.arenas.get(beside.arena as usize).is_some_and(|arena| {
                    source.filter(is_source).is_some_and(|s| arena.is_left(slot, s.side, shaft))
                        || arena.misses(slot, shaft)
                });
                if !missed {
                    beam.leaves.try_push(Leaf { kind: beside.arena, first: slot, count: 1 }).ok()?;
                }
            }
        }
        let full = self.tree.in_shaft(shaft, |leaf| beam.leaves.try_push(leaf).is_err());
        (!full).then_some(beam)
    }

    /// As [`Geometry::seen`], of a ray of the bundle that `beam` was made for: the same answer.
    #[inline]
    pub fn seen_in(&self, beam: &Beam, ray: &Ray, mask: u32, need: Need) -> Option<(Hit, SurfacePoint)> {
        if beam.is_empty() {
            return None;
        }
        self.walk_roughly(
            ray,
            mask,
            #[inline(always)]
            |walk: &Walk<'_>| {
                let mut best = Best::least();
                for leaf in &beam.leaves {
                    closest_in(walk, *leaf, &mut best);
                }
                let hit = best.hit?;
                Some((hit, self.point_of(walk.ray, ray.source(), &hit, need)))
            },
        )?
    }

    /// As [`Geometry::any_masked`], of a ray of the bundle that `beam` was made for: the same answer.
    #[inline]
    pub fn any_in(&self, beam: &Beam, ray: &Ray, mask: u32) -> bool {
        !beam.is_empty()
            && self.walk_roughly(
                ray,
                mask,
                #[inline(always)]
                |walk: &Walk<'_>| {
                    for leaf in &beam.leaves {
                        if any_in(walk, *leaf) {
                            return true;
                        }
                    }
                    false
                },
            ) == Some(true)
    }
}
