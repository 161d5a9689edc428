//! The built geometry.

use crate::arena::AnyArena;
use crate::closest::Placement;
use crate::filter_cache::Outlines;
use crate::{Builder, stats};
use core::ops::Range;
use core::sync::atomic::{AtomicU64, Ordering};
use durer_bvh::{Bvh, Leaf, Settings};
use durer_math::{Aabb, Affine, Isa};
use std::sync::{Arc, OnceLock};

/// The greatest depth of nested instances.
pub(crate) const MAX_NESTING: u32 = 8;

/// Surfaces, objects and instances, built once and then immutable: `Send`, `Sync`, and shared by
/// all threads.
///
/// Surfaces are stored by type, in the order of the tree's leaves. Unbounded ones are stored beside
/// the tree.
pub struct Geometry {
    pub(crate) isa: Isa,
    pub(crate) arenas: Vec<Box<dyn AnyArena>>,
    /// In the order in which they were added, so that their placements ascend.
    instances: Vec<Instance>,
    /// The instance in each slot.
    pub(crate) instance_slots: Vec<u32>,
    pub(crate) tree: Bvh,
    pub(crate) beside: Vec<Beside>,
    pub(crate) solids_in_parts: Vec<SolidInParts>,
    pub(crate) bounds: Aabb,
    /// How the tree is built; `None` if there is none.
    settings: Option<Settings>,
    objects: u32,
    placements: u32,
    depth: u32,
    invalid: AtomicU64,
    /// Made when a packet first needs them.
    pub(crate) outlines: OnceLock<Outlines>,
}

/// A geometry, placed.
pub(crate) struct Instance {
    pub(crate) geometry: Arc<Geometry>,
    pub(crate) affine: Affine,
    pub(crate) object: u32,
    pub(crate) primitive: u32,
    pub(crate) mask: u32,
    /// The number of this placement, counted from its parent's.
    pub(crate) first_placement: u32,
}

impl Instance {
    /// The placement of this instance in a placement of its parent.
    #[inline]
    pub(crate) fn within(&self, parent: &Placement) -> Placement {
        Placement {
            object: parent.object.wrapping_add(self.object),
            primitive: parent.primitive.wrapping_add(self.primitive),
            instance: parent.instance + self.first_placement,
        }
    }
}

/// Slots that are not in the tree.
pub(crate) struct Beside {
    pub(crate) arena: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Beside {
    pub(crate) fn leaf(&self) -> Leaf {
        Leaf::new(self.arena, self.first, self.count)
    }
}

/// A solid whose parts are in the tree one by one: its interior is in no part's box.
pub(crate) struct SolidInParts {
    pub(crate) arena: u32,
    pub(crate) surface: u32,
    pub(crate) bounds: Aabb,
}

/// All solids in parts.
pub(crate) fn solids_in_parts(arenas: &[Box<dyn AnyArena>]) -> Vec<SolidInParts> {
    let mut all = Vec::new();
    for (i, arena) in arenas.iter().enumerate() {
        let solid = |(surface, bounds)| SolidInParts { arena: i as u32, surface, bounds };
        all.extend(arena.solids_in_parts().into_iter().map(solid));
    }
    all
}

/// The slots of a leaf.
#[inline(always)]
pub(crate) fn slots(leaf: &Leaf) -> Range<u32> {
    leaf.first..leaf.first + leaf.count
}

impl Geometry {
    /// Starts a new geometry.
    pub fn builder() -> Builder {
        Builder::default()
    }

    #[expect(clippy::too_many_arguments, reason = "the builder's last line: one value per field")]
    pub(crate) fn assembled(
        isa: Isa,
        arenas: Vec<Box<dyn AnyArena>>,
        instances: Vec<Instance>,
        instance_slots: Vec<u32>,
        tree: Bvh,
        beside: Vec<Beside>,
        solids_in_parts: Vec<SolidInParts>,
        bounds: Aabb,
        settings: Option<Settings>,
        objects: u32,
        placements: u32,
    ) -> Self {
        let depth = instances.iter().map(|i| i.geometry.depth + 1).max().unwrap_or(0);
        let invalid = AtomicU64::new(0);
        Self {
            isa,
            arenas,
            instances,
            instance_slots,
            tree,
            beside,
            solids_in_parts,
            bounds,
            settings,
            objects,
            placements,
            depth,
            invalid,
            outlines: OnceLock::new(),
        }
    }

    /// A builder with the geometry's content.
    pub(crate) fn reopened(self) -> Builder {
        let arenas = self.arenas.into_iter().map(AnyArena::reopen).collect();
        Builder::again(arenas, self.instances, self.objects, self.settings, self.isa)
    }

    /// A box around everything; unbounded if something is, empty if there is nothing.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// One more than the greatest object number.
    pub fn objects(&self) -> u32 {
        self.objects
    }

    /// The number of placements, nested ones included; the geometry's own is the first.
    pub fn placements(&self) -> u32 {
        self.placements
    }

    /// How deeply instances are nested: 0 without any.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// How many queries so far had an invalid ray (not finite, without direction, or with an empty
    /// range); such a ray hits nothing.
    pub fn invalid_rays(&self) -> u64 {
        self.invalid.load(Ordering::Relaxed)
    }

    pub(crate) fn count_invalid(&self) {
        self.invalid.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts, memory and the cost of the tree.
    pub fn stats(&self) -> stats::Stats {
        stats::of(self)
    }

    /// The counts of this geometry and of all that its instances place, at any depth.
    pub fn inventory(&self) -> stats::Inventory {
        stats::Inventory::of(self)
    }

    /// The tree over the bounded surfaces and instances.
    pub fn tree(&self) -> &Bvh {
        &self.tree
    }

    /// The instances, in the order in which they were added.
    pub(crate) fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// The instance in a slot of a leaf.
    #[inline(always)]
    pub(crate) fn instance(&self, slot: u32) -> &Instance {
        &self.instances[self.instance_slots[slot as usize] as usize]
    }

    /// The instance that contains a placement; `None` for the geometry's own.
    pub(crate) fn instance_of(&self, placement: u32) -> Option<&Instance> {
        let after = self.instances.partition_point(|i| i.first_placement <= placement);
        after.checked_sub(1).map(|i| &self.instances[i])
    }

    /// Whether a leaf holds instances. Their kind is one more than the last arena's.
    #[inline(always)]
    pub(crate) fn is_instances(&self, leaf: &Leaf) -> bool {
        leaf.kind as usize == self.arenas.len()
    }
}

impl core::fmt::Debug for Geometry {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Geometry")
            .field("bounds", &self.bounds)
            .field("stats", &self.stats())
            .finish_non_exhaustive()
    }
}
