//! The components that a ray or a point can meet: a binary tree of boxes, divided at the median.
//!
//! Boxes are enlarged by far more than the rounding of a ray, so skipped components add exactly
//! nothing.

use super::march::Along;
use arrayvec::ArrayVec;
use durer_math::{Aabb, Vec3};

/// The number of components in a leaf.
const LEAF: usize = 4;
/// The enlargement of boxes, in units.
pub(crate) const MARGIN: f64 = durer_math::scale::pow2(-20);

/// A box and its content.
#[derive(Clone, Debug)]
struct BoxNode {
    low: Vec3,
    high: Vec3,
    /// With a count, the first component; else the first of two nodes.
    first: u32,
    count: u32,
}

/// The tree; component numbers are those of its own order.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<BoxNode>,
}

/// The content of a node.
pub(crate) enum Inner {
    /// Components from the first number to before the second.
    Leaf(usize, usize),
    /// Two nodes.
    Nodes(u32, u32),
}

impl Tree {
    /// Builds the tree from boxes in the units of the frame. Returns the tree and the order of its
    /// components.
    pub(crate) fn new(boxes: &[Aabb]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = vec![Self::around(boxes, &order, 0)];
        let mut open = vec![(0_usize, 0_usize, boxes.len())];
        while let Some((node, from, to)) = open.pop() {
            if to - from <= LEAF {
                (nodes[node].first, nodes[node].count) = (from as u32, (to - from) as u32);
                continue;
            }
            let part = &mut order[from..to];
            let twice = |i: u32| {
                let b = &boxes[i as usize];
                b.min.to_vec() + b.max.to_vec()
            };
            let (mut low, mut high) = (twice(part[0]), twice(part[0]));
            for &i in part.iter() {
                let c = twice(i);
                for axis in 0..3 {
                    (low[axis], high[axis]) = (low[axis].min(c[axis]), high[axis].max(c[axis]));
                }
            }
            let wide = high - low;
            let axis = (0..3).fold(0, |best, axis| if wide[axis] > wide[best] { axis } else { best });
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |&a, &b| {
                twice(a)[axis].total_cmp(&twice(b)[axis]).then(a.cmp(&b))
            });
            let (middle, first) = (from + half, nodes.len());
            nodes.push(Self::around(boxes, &order[from..middle], 0));
            nodes.push(Self::around(boxes, &order[middle..to], 0));
            (nodes[node].first, nodes[node].count) = (first as u32, 0);
            open.push((first, from, middle));
            open.push((first + 1, middle, to));
        }
        (Self { nodes }, order)
    }

    fn around(boxes: &[Aabb], which: &[u32], first: u32) -> BoxNode {
        let all = which.iter().fold(Aabb::EMPTY, |all, &i| all.union(boxes[i as usize]));
        let room = Vec3::new(MARGIN, MARGIN, MARGIN);
        BoxNode { low: all.min.to_vec() - room, high: all.max.to_vec() + room, first, count: 0 }
    }

    /// Where a ray enters and leaves a node, in its parameter; `None` if it misses it.
    #[inline(always)]
    pub(crate) fn entry(&self, node: u32, ray: &Along) -> Option<(f64, f64)> {
        if !ray.known {
            return Some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let node = &self.nodes[node as usize];
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            // A direction without this axis gives infinity, or NaN, which is no bound.
            let a = (node.low[axis] - ray.o[axis]) * ray.inverse[axis];
            let b = (node.high[axis] - ray.o[axis]) * ray.inverse[axis];
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some((near, far))
    }

    /// The content of a node.
    #[inline(always)]
    pub(crate) fn inner(&self, node: u32) -> Inner {
        let node = &self.nodes[node as usize];
        if node.count > 0 || self.nodes.len() == 1 {
            Inner::Leaf(node.first as usize, (node.first + node.count) as usize)
        } else {
            Inner::Nodes(node.first, node.first + 1)
        }
    }

    /// Calls `take` for the components near a point: all whose boxes are within `e` of it along
    /// each axis.
    #[inline(always)]
    pub(crate) fn near(&self, y: Vec3, e: f64, mut take: impl FnMut(usize)) {
        let mut open = ArrayVec::<u32, 64>::new();
        open.push(0);
        while let Some(i) = open.pop() {
            let node = &self.nodes[i as usize];
            let meets = (0..3).all(|k| y[k] + e >= node.low[k] && y[k] - e <= node.high[k]);
            if !meets {
                continue;
            }
            match self.inner(i) {
                // A loop: `for_each` would call `take` compiled for the least processor.
                Inner::Leaf(from, to) => {
                    for i in from..to {
                        take(i);
                    }
                }
                // The depth is at most the number of binary digits of the number of components.
                Inner::Nodes(a, b) => open.extend([b, a]),
            }
        }
    }
}

/// Whether the rounding of a ray is far below the enlargement of boxes.
#[inline(always)]
pub(super) fn is_known(o_err: f64, d_err: f64) -> bool {
    o_err + 4.0 * d_err < MARGIN / 16.0
}
