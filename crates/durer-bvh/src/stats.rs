//! Statistics of a tree.

use crate::build::Settings;
use crate::node::{ChildRef, Node};
use crate::tree::{Bvh, KindOfLeaf};
use crate::triangles::Block;

/// Counts, memory and expected cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Inner nodes.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Entries in leaves; one in several leaves counts in each.
    pub entries: usize,
    /// Levels, leaves not counted: 1 for a root with leaves only.
    pub depth: usize,
    /// Bytes on the heap.
    pub bytes: usize,
    /// The cost by the surface area heuristic: what a random ray that meets the tree's box is
    /// expected to cost, in node tests.
    pub sah: f64,
}

impl Bvh {
    /// Traverses the whole tree and computes its statistics.
    pub fn stats(&self) -> Stats {
        let mut stats = Stats {
            bytes: self.nodes.capacity() * size_of::<Node>()
                + self.blocks.capacity() * size_of::<Block>()
                + self.starts.capacity() * size_of::<u32>()
                + (self.splits.starts.capacity() + self.splits.places.capacity()) * size_of::<u32>()
                + self.splits.kinds.capacity() * size_of::<(u32, u32)>()
                + self.kinds.capacity() * size_of::<KindOfLeaf>(),
            ..Stats::default()
        };
        if self.is_empty() {
            return stats;
        }
        let half_area = |lo: [f32; 3], hi: [f32; 3]| {
            let w = |i: usize| f64::from(hi[i]) - f64::from(lo[i]);
            w(0) * w(1) + w(1) * w(2) + w(2) * w(0)
        };
        let whole = half_area(self.lo, self.hi);
        let share = |area: f64| if whole > 0.0 { area / whole } else { 1.0 };
        let costs = Settings::GOOD;
        stats.sah = 1.0;
        let mut waiting = vec![(ChildRef::node(0), 1_usize)];
        while let Some((child, depth)) = waiting.pop() {
            stats.nodes += 1;
            stats.depth = stats.depth.max(depth);
            let node = &self.nodes[child.index()];
            for slot in node.used() {
                let (lo, hi) = node.bounds(slot);
                let share = share(half_area(lo, hi));
                let child = node.child[slot];
                if child.is_leaf() {
                    let count = child.slots().1;
                    stats.leaves += 1;
                    stats.entries += count as usize;
                    stats.sah += share * f64::from(costs.leaf_cost + costs.test_cost * count as f32);
                } else {
                    stats.sah += share;
                    waiting.push((child, depth + 1));
                }
            }
        }
        stats
    }
}
