//! Rays that belong together share one walk through the tree.

use crate::best::Best;
use crate::geometry::{Geometry, slots};
use crate::query::{any_in, closest_in};
use crate::{Hit, walk::Walk};
use arrayvec::ArrayVec;
use durer_bvh::Leaf;
use durer_math::{Ray, Shaft};
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
    /// What the rays of a bundle may meet; `None` if that is so much that each ray should walk through the tree by itself.
    pub fn beam(&self, shaft: &Shaft) -> Option<Beam> {
        let mut beam = Beam::default();
        for beside in &self.beside {
            for slot in slots(&beside.leaf()) {
                let met = self.arenas.get(beside.arena as usize).is_none_or(|a| !a.misses(slot, shaft));
                if met {
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
