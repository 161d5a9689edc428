//! A query that reports each of its steps.

use crate::kernels::Scalar;
use crate::node::{ChildRef, Leaf, SLOT_BITS, WIDTH};
use crate::ray::{Ray64, Rounding};
use crate::tree::Bvh;
use durer_math::Aabb;

/// A step of a ray through a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A node's box was entered and its children were tested.
    Node {
        /// Its number.
        node: u32,
        /// Its level, 0 for the root.
        level: u32,
        /// Its box, in the caller's units.
        bounds: Aabb,
        /// The least parameter at which the ray may enter it.
        t: f64,
        /// How many children it has.
        children: u32,
        /// How many of their boxes the ray may meet.
        met: u32,
    },
    /// A leaf's box was entered.
    Leaf {
        /// The leaf.
        leaf: Leaf,
        /// Its level.
        level: u32,
        /// Its box, in the caller's units.
        bounds: Aabb,
        /// The least parameter at which the ray may enter it.
        t: f64,
    },
    /// A box that the ray meets, but behind the closest hit found since.
    Skipped {
        /// Its level.
        level: u32,
        /// Its box, in the caller's units.
        bounds: Aabb,
        /// The least parameter at which the ray may enter it.
        t: f64,
    },
}

impl Bvh {
    /// Reports the steps of [`Bvh::closest`] in the same order, but with whole leaves of triangles,
    /// piece by piece if they hold triangles that are in other leaves too. After a leaf the result
    /// of `tell` is the new limit; otherwise it is ignored. Returns whether the ray meets the
    /// tree's own box.
    pub fn trace(&self, line: &Ray64, mut tell: impl FnMut(&Step) -> f64) -> bool {
        let Some(ray) = self.cull(&self.local_line(line), Rounding::Fused) else { return false };
        let mut t_far = ray.way.t_far;
        let mut waiting = vec![(ChildRef::node(0), 0.0_f32, 0_u32, self.bounds())];
        while let Some((child, near, level, bounds)) = waiting.pop() {
            let t = ray.way.caller_t(near);
            if near > t_far {
                tell(&Step::Skipped { level, bounds, t });
            } else if child.is_leaf() {
                self.leaves(child, &mut |leaf| {
                    let limit = tell(&Step::Leaf { leaf, level, bounds, t });
                    t_far = t_far.min(ray.way.shortened(limit));
                    false
                });
            } else {
                let node = &self.nodes[child.index()];
                let slabs = Scalar::<true>.slabs(node, &ray, t_far);
                let before = waiting.len();
                for word in node.order {
                    let slot = (word >> (SLOT_BITS * ray.octant)) as usize % WIDTH;
                    if slabs.met[slot] {
                        let (lo, hi) = node.bounds(slot);
                        waiting.push((
                            node.child[slot],
                            slabs.near[slot],
                            level + 1,
                            self.frame.bounds(lo, hi),
                        ));
                    }
                }
                let (children, met) = (node.used().count() as u32, (waiting.len() - before) as u32);
                tell(&Step::Node { node: child.index() as u32, level, bounds, t, children, met });
            }
        }
        true
    }
}
