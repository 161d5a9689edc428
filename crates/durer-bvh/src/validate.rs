//! Validation: every invariant of a tree.

use crate::build::spatial::{Bounds, is_covered};
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, Leaf, Node, SLOT_BITS, WIDTH};
use crate::tree::{Bvh, Splits};
use crate::triangles::Corners;
use durer_math::{Aabb, Point3};

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
    /// A child's box is not finite, or it is empty.
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
    /// A slot is in no leaf, or in another number of leaves than the tree records.
    #[error("slot {slot} is in {times} leaves, not in {known}")]
    Slot {
        /// The slot.
        slot: usize,
        /// In how many leaves.
        times: u32,
        /// In how many by the tree's record.
        known: u32,
    },
    /// A recorded place of a triangle in several leaves is none of its leaves, or is recorded
    /// twice.
    #[error("kind {kind}, number {index}: is not in all leaves in which it should be, once each")]
    Place {
        /// Its kind.
        kind: u32,
        /// Its position within the kind.
        index: u32,
    },
    /// An entry is not inside its leaf's box; if it is in several leaves, not inside the union of
    /// their boxes, as far as f64 can decide.
    #[error("kind {kind}, number {index}: sticks out of the box of its leaf, or of its leaves")]
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
    /// Checks every invariant; `bounds` gives the box of the entry at a position within its kind.
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
                let outer = self.frame.bounds(lo, hi);
                let mut wrong = None;
                self.leaves(child, &mut |leaf| {
                    wrong = self.check_leaf(&leaf, &outer, &mut held, &bounds);
                    wrong.is_some()
                });
                match wrong {
                    Some(Wrong::Leaf) => return Err(Violation::Kind { node: index, slot }),
                    Some(Wrong::Thing(index)) => {
                        let kind = self.leaf(child).kind;
                        return Err(Violation::ThingSticksOut { kind, index });
                    }
                    None => {}
                }
            }
        }
        if let Some((node, &times)) = reached.iter().enumerate().find(|(_, n)| **n != 1) {
            return Err(Violation::Reached { node, times });
        }
        for kind in 0..self.kinds.len() as u32 {
            for index in 0..self.count(kind) as u32 {
                let slot = (self.starts[kind as usize] + index) as usize;
                let split = self.splits.number(kind, index);
                let known = split.map_or(1, |split| self.splits.places(split).len() as u32);
                if held[slot] != known {
                    return Err(Violation::Slot { slot, times: held[slot], known });
                }
                if let Some(split) = split {
                    self.check_split(kind, index, self.splits.places(split), &bounds(kind, index))?;
                }
            }
        }
        Ok(())
    }

    fn check_leaf(
        &self,
        leaf: &Leaf,
        outer: &Aabb,
        held: &mut [u32],
        bounds: &impl Fn(u32, u32) -> Aabb,
    ) -> Option<Wrong> {
        let kind = leaf.kind as usize;
        if self.starts[kind] + leaf.first + leaf.count > self.starts[kind + 1] {
            return Some(Wrong::Leaf);
        }
        for i in leaf.first..leaf.first + leaf.count {
            held[(self.starts[kind] + i) as usize] += 1;
            if self.splits.number(leaf.kind, i).is_none() && !outer.encloses(&bounds(leaf.kind, i)) {
                return Some(Wrong::Thing(i));
            }
        }
        None
    }

    /// Checks that a triangle in several leaves is in each of its places, and that their boxes
    /// cover it.
    fn check_split(&self, kind: u32, index: u32, places: &[u32], bounds: &Aabb) -> Result<(), Violation> {
        let mut boxes = Vec::new();
        let (mut whole, mut corners) = (Aabb::EMPTY, None);
        let is_new = |i: usize| !places[..i].contains(&places[i]);
        for (i, &place) in places.iter().enumerate() {
            let (node, slot) = Splits::child(place);
            let parent = self.nodes.get(node).filter(|node| node.is_used(slot) && node.child[slot].is_leaf());
            let block = parent.and_then(|node| self.block(node.child[slot]));
            let (Some(parent), Some((_, number))) = (parent, block.filter(|of| of.0 == kind && is_new(i)))
            else {
                return Err(Violation::Place { kind, index });
            };
            let block = &self.blocks[number as usize];
            let Some(lane) = (0..block.len()).find(|&lane| block.slot(lane) == index) else {
                return Err(Violation::Place { kind, index });
            };
            let (lo, hi) = parent.bounds(slot);
            whole = whole.union(self.frame.bounds(lo, hi));
            boxes.push(Bounds { lo: lo.map(f64::from), hi: hi.map(f64::from) });
            corners = Some(block.corners(1.0, lane));
        }
        // The stored corners may be rounded; the entry's box may be cut by the bounds of its
        // object.
        let is_covered = |corners: Corners| {
            let inward = |p: Point3| {
                core::array::from_fn(|i| self.frame.units().inward(self.frame.difference(p[i], i).0))
            };
            let bounds = Bounds { lo: inward(bounds.min), hi: inward(bounds.max) };
            self.rounded || is_covered(&corners.map(Point3::to_array), &bounds, &boxes)
        };
        if whole.encloses(bounds) && corners.is_some_and(is_covered) {
            Ok(())
        } else {
            Err(Violation::ThingSticksOut { kind, index })
        }
    }
}

/// The violations of a leaf.
enum Wrong {
    Leaf,
    Thing(u32),
}

fn check_order(index: usize, node: &Node) -> Result<(), Violation> {
    for octant in 0..8 {
        let set =
            node.order.iter().fold(0_u32, |set, w| set | 1 << ((w >> (SLOT_BITS * octant)) as usize % WIDTH));
        if set != (1 << WIDTH) - 1 {
            return Err(Violation::Order { node: index, octant });
        }
    }
    Ok(())
}
