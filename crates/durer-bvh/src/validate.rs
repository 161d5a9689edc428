//! Is this a tree? Every invariant, walked.

use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, Node8, WIDTH};
use crate::tree::Bvh;
use durer_math::Aabb;

/// An invariant that does not hold.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Violation {
    /// A reference leads out of the node array.
    #[error("node {node}: child {slot} refers to a node that does not exist")]
    NoSuchNode {
        /// The node.
        node: usize,
        /// The child.
        slot: usize,
    },
    /// A node has two parents, or none.
    #[error("node {node} is reached {times} times")]
    Reached {
        /// The node.
        node: usize,
        /// How often.
        times: u32,
    },
    /// A child's box is not inside its parent's.
    #[error("node {node}: the box of child {slot} sticks out")]
    SticksOut {
        /// The node.
        node: usize,
        /// The child.
        slot: usize,
    },
    /// A child's box is not finite or has no point.
    #[error("node {node}: the box of child {slot} is no box")]
    NoBox {
        /// The node.
        node: usize,
        /// The child.
        slot: usize,
    },
    /// The orders of a node's children are not permutations.
    #[error("node {node}: octant {octant} does not order all children")]
    Order {
        /// The node.
        node: usize,
        /// The octant.
        octant: u32,
    },
    /// A leaf holds more than one kind, or slots that do not exist.
    #[error("node {node}: leaf {slot} leaves its kind")]
    Kind {
        /// The node.
        node: usize,
        /// The child.
        slot: usize,
    },
    /// A slot is in no leaf or in several.
    #[error("slot {slot} is in {times} leaves")]
    Slot {
        /// The slot.
        slot: usize,
        /// In how many leaves.
        times: u32,
    },
    /// A thing is not inside its leaf's box.
    #[error("kind {kind}, number {index}: sticks out of the box of its leaf")]
    ThingSticksOut {
        /// Its kind.
        kind: u32,
        /// Its position within the kind.
        index: u32,
    },
    /// The traversal's stack could overflow.
    #[error("the tree is deeper than {MAX_DEPTH} levels")]
    TooDeep,
}

impl Bvh {
    /// Checks every invariant; `bounds` gives the box of the thing at a position within its kind.
    pub fn validate(&self, bounds: impl Fn(u32, u32) -> Aabb) -> Result<(), Violation> {
        let mut reached = vec![0_u32; self.nodes.len()];
        let mut held = vec![0_u32; self.len()];
        let mut waiting = Vec::new();
        if !self.is_empty() {
            waiting.push((ChildRef::node(0), 1, (self.lo, self.hi)));
        }
        while let Some((at, depth, outer)) = waiting.pop() {
            let index = at.index();
            reached[index] += 1;
            if depth > MAX_DEPTH {
                return Err(Violation::TooDeep);
            }
            if reached[index] > 1 {
                break;
            }
            let node = &self.nodes[index];
            check_order(index, node)?;
            for slot in node.used() {
                let (lo, hi) = node.bounds(slot);
                if !(0..3).all(|i| lo[i] <= hi[i] && lo[i].abs() <= 1.0 && hi[i].abs() <= 1.0) {
                    return Err(Violation::NoBox { node: index, slot });
                }
                if !(0..3).all(|i| outer.0[i] <= lo[i] && hi[i] <= outer.1[i]) {
                    return Err(Violation::SticksOut { node: index, slot });
                }
                let child = node.child[slot];
                if !child.is_leaf() {
                    if child.index() >= self.nodes.len() {
                        return Err(Violation::NoSuchNode { node: index, slot });
                    }
                    waiting.push((child, depth + 1, (lo, hi)));
                    continue;
                }
                let leaf = self.leaf(child);
                let kind = leaf.kind as usize;
                let end = self.starts[kind] + leaf.first + leaf.count;
                if end > self.starts[kind + 1] {
                    return Err(Violation::Kind { node: index, slot });
                }
                let outer = self.frame.bounds(lo, hi);
                for i in leaf.first..leaf.first + leaf.count {
                    held[(self.starts[kind] + i) as usize] += 1;
                    if !outer.encloses(&bounds(leaf.kind, i)) {
                        return Err(Violation::ThingSticksOut { kind: leaf.kind, index: i });
                    }
                }
            }
        }
        if let Some((node, &times)) = reached.iter().enumerate().find(|(_, n)| **n != 1) {
            return Err(Violation::Reached { node, times });
        }
        match held.iter().enumerate().find(|(_, n)| **n != 1) {
            Some((slot, &times)) => Err(Violation::Slot { slot, times }),
            None => Ok(()),
        }
    }
}

fn check_order(index: usize, node: &Node8) -> Result<(), Violation> {
    for octant in 0..8 {
        let set = node.order.iter().fold(0_u32, |set, w| set | 1 << (w >> (3 * octant) & 7));
        if set != (1 << WIDTH) - 1 {
            return Err(Violation::Order { node: index, octant });
        }
    }
    Ok(())
}
