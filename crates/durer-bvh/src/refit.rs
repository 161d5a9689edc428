//! Refitting: new boxes for an old tree after its entries have moved.

use crate::CornersOf;
use crate::build::Extent;
use crate::frame::{Entry, Frame};
use crate::node::WIDTH;
use crate::tree::Bvh;
use crate::triangles::Block;
use durer_math::Aabb;
use rayon::prelude::*;

/// Why a tree cannot be refitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefitError {
    /// An entry has no bounded box.
    #[error("kind {kind}, number {slot}: has moved to where no bounded box holds it")]
    Unbounded {
        /// Its kind.
        kind: u32,
        /// Its position within the kind.
        slot: u32,
    },
}

impl Bvh {
    /// Computes all boxes anew, from the leaves upwards and rounded outward, and all corners of
    /// triangles; also the tree's units.
    ///
    /// `bounds` gives the box of the entry at a position within its kind, as for [`Bvh::validate`],
    /// and `shapes` the corners of triangles, as for [`Bvh::build`], but by position. Answers are
    /// those of a new tree. A triangle in several leaves (see
    /// [`Quality::Best`](crate::Quality::Best)) then has its whole box in each of them, so that
    /// such a tree loses the gain of its spatial splits. Queries take as long as before while
    /// neighbours stay neighbours; when the cost in [`Bvh::stats`] has grown by half, it pays to
    /// build anew.
    ///
    /// # Errors
    ///
    /// If a box is not bounded, or empty. Then the tree is unchanged.
    ///
    /// # Panics
    ///
    /// If a kind was built of triangles and `shapes` does not give their corners.
    pub fn refit(
        &mut self,
        bounds: impl Fn(u32, u32) -> Aabb + Sync,
        shapes: &[Option<CornersOf<'_>>],
    ) -> Result<(), RefitError> {
        let slots: Vec<(u32, u32)> = (0..self.kinds.len())
            .flat_map(|kind| {
                let count = self.starts[kind + 1] - self.starts[kind];
                (0..count).map(move |slot| (kind as u32, slot))
            })
            .collect();
        let boxes: Vec<Aabb> = slots.par_iter().map(|&(kind, slot)| bounds(kind, slot)).collect();
        let is_lost = |b: &Aabb| !b.is_bounded() || b.is_empty();
        if let Some(lost) = boxes.par_iter().position_first(is_lost) {
            let (kind, slot) = slots[lost];
            return Err(RefitError::Unbounded { kind, slot });
        }
        self.frame = Frame::around(&boxes.par_iter().copied().reduce(|| Aabb::EMPTY, Aabb::union));
        let entry = |(b, &(kind, slot)): (&Aabb, &(u32, u32))| self.frame.entry(b, kind, slot);
        let entries: Vec<Entry> = boxes.par_iter().zip(&slots).map(entry).collect();
        drop((boxes, slots));
        self.refit_blocks(shapes);
        self.refit_nodes(&entries);
        Ok(())
    }

    /// Writes new corners to all blocks.
    fn refit_blocks(&mut self, shapes: &[Option<CornersOf<'_>>]) {
        let frame = self.frame;
        let renew = |corners: CornersOf<'_>, block: &mut Block| {
            let (old, is_held);
            old = *block;
            let triangles = (0..old.len()).map(|lane| (old.slot(lane), corners(old.slot(lane))));
            (*block, is_held) = Block::new(frame, triangles);
            is_held
        };
        self.rounded = false;
        let ends: Vec<u32> = self.kinds.iter().filter_map(|kind| kind.blocks).skip(1).collect();
        let mut ends = ends.into_iter().chain([self.blocks.len() as u32]);
        for (kind, shape) in self.kinds.iter().zip(shapes) {
            let (Some(first), Some(corners)) = (kind.blocks, shape) else {
                assert!(kind.blocks.is_none(), "triangles were built and are to be refitted without corners");
                continue;
            };
            let end = ends.next().unwrap_or(first);
            let blocks = &mut self.blocks[first as usize..end as usize];
            // No short circuit: every block must be renewed.
            self.rounded |=
                blocks.par_iter_mut().map(|block| !renew(corners, block)).reduce(|| false, |a, b| a | b);
        }
    }

    /// Writes new boxes to all nodes. Parents precede their children.
    fn refit_nodes(&mut self, entries: &[Entry]) {
        let mut nodes = core::mem::take(&mut self.nodes);
        for index in (0..nodes.len()).rev() {
            let mut node = nodes[index];
            for slot in (0..WIDTH).filter(|&slot| nodes[index].is_used(slot)) {
                let child = node.child[slot];
                let mut extent = Extent::EMPTY;
                if child.is_leaf() {
                    self.leaves(child, &mut |leaf| {
                        let first = (self.starts[leaf.kind as usize] + leaf.first) as usize;
                        let held = &entries[first..first + leaf.count as usize];
                        held.iter().for_each(|entry| extent.add(entry));
                        false
                    });
                } else {
                    let below = &nodes[child.index()];
                    below.used().for_each(|slot| extent.unite(&Extent::between(below.bounds(slot))));
                }
                node.set(slot, extent.lo(), extent.hi(), child);
            }
            node.sort();
            nodes[index] = node;
        }
        self.set_nodes(nodes);
    }
}
