//! What a geometry consists of and what it costs.

use crate::geometry::{Geometry, Instance};

/// Counts and memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Stats {
    /// Each type of surface with the number of its surfaces or parts, in the order in which the types were first added.
    pub kinds: Vec<(&'static str, u32)>,
    /// Surfaces and parts, instances not counted.
    pub primitives: u64,
    /// Instances.
    pub instances: usize,
    /// What is tested beside the tree, by every ray.
    pub beside: u64,
    /// The tree.
    pub tree: durer_bvh::Stats,
    /// Bytes on the heap: surfaces (without what they own in turn), numbers and masks, the tree. What instances share is not counted.
    pub bytes: usize,
}

pub(crate) fn of(geometry: &Geometry) -> Stats {
    let kinds: Vec<_> = geometry.arenas.iter().map(|a| (a.type_name(), a.len())).collect();
    let tree = geometry.tree.stats();
    Stats {
        primitives: kinds.iter().map(|k| u64::from(k.1)).sum(),
        instances: geometry.instances().len(),
        beside: geometry.beside.iter().map(|b| u64::from(b.count)).sum(),
        bytes: geometry.arenas.iter().map(|a| a.bytes()).sum::<usize>()
            + geometry.instances().len() * (size_of::<Instance>() + size_of::<u32>())
            + tree.bytes,
        tree,
        kinds,
    }
}
