//! Which leaves lie in a shaft?

use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, Leaf, WIDTH};
use crate::tree::Bvh;
use durer_math::Shaft;

impl Bvh {
    /// Shows the leaves that a bundle of rays may meet to `visit`, in no particular order, until it says that it has seen enough; says
    /// whether it did. Every leaf that a ray of the bundle meets is shown.
    pub fn in_shaft(&self, shaft: &Shaft, mut visit: impl FnMut(Leaf) -> bool) -> bool {
        if self.is_empty() {
            return false;
        }
        let mut waiting = [ChildRef::node(0); MAX_DEPTH * WIDTH];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let child = waiting[count];
            if child.is_leaf() {
                if visit(self.leaf(child)) {
                    return true;
                }
                continue;
            }
            let node = &self.nodes[child.index()];
            for slot in node.used() {
                let (lo, hi) = node.bounds(slot);
                if shaft.may_meet(&self.frame.bounds(lo, hi)) {
                    waiting[count] = node.child[slot];
                    count += 1;
                }
            }
        }
        false
    }
}
