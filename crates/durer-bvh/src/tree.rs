//! The tree.

use crate::frame::Frame;
use crate::node::{ChildRef, Leaf, Node8};
use crate::ray::{CullRay, Line, Rounding};
use durer_math::Aabb;

/// A tree of boxes: which things might this ray meet?
///
/// Coordinates are f32 and in units that make all of them at most 1; boxes are rounded outward and tests charge every rounding to "may
/// meet", so that no box that the exact ray meets is missed.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh {
    pub(crate) frame: Frame,
    pub(crate) nodes: Vec<Node8>,
    /// The first slot of each kind, and the end.
    pub(crate) starts: Vec<u32>,
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
}

impl Bvh {
    /// A tree over nothing.
    pub fn empty() -> Self {
        Self::assembled(Frame::around(&Aabb::EMPTY), Vec::new(), vec![0])
    }

    pub(crate) fn assembled(frame: Frame, nodes: Vec<Node8>, starts: Vec<u32>) -> Self {
        let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        if let Some(root) = nodes.first() {
            for (a, b) in root.used().map(|slot| root.bounds(slot)) {
                lo = [0, 1, 2].map(|i| lo[i].min(a[i]));
                hi = [0, 1, 2].map(|i| hi[i].max(b[i]));
            }
        }
        Self { frame, nodes, starts, lo, hi }
    }

    /// How many things it holds.
    pub fn len(&self) -> usize {
        self.starts.last().map_or(0, |&n| n as usize)
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A box around everything in it.
    pub fn bounds(&self) -> Aabb {
        if self.is_empty() { Aabb::EMPTY } else { self.frame.bounds(self.lo, self.hi) }
    }

    /// An upper bound of its coordinates.
    #[inline(always)]
    pub fn size(&self) -> f64 {
        self.frame.outward(1.0)
    }

    /// A leaf, from a reference to one.
    #[inline(always)]
    pub(crate) fn leaf(&self, child: ChildRef) -> Leaf {
        let (slot, count) = child.slots();
        // Few kinds: a scan is faster than a search, and with one kind it ends at once.
        let mut kind = 0;
        while kind + 2 < self.starts.len() && self.starts[kind + 1] <= slot {
            kind += 1;
        }
        Leaf { kind: kind as u32, first: slot - self.starts[kind], count }
    }

    #[inline(always)]
    pub(crate) fn cull(&self, line: &Line, rounding: Rounding) -> Option<CullRay> {
        if self.is_empty() {
            return None;
        }
        CullRay::new(line, self.frame, &self.lo, &self.hi, rounding)
    }
}
