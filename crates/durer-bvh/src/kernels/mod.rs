//! What is done for each node and block, once per instruction set. `scalar` is the definition; the others equal it bit for bit, but for how a ray
//! is made ready: there each may be as generous as its bounds allow.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod bins;
mod scalar;
mod stack;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
pub(crate) use bins::{add_centres, fill};
pub(crate) use scalar::Scalar;
pub(crate) use stack::{MAX_DEPTH, Stack};

use crate::node::{ChildRef, Node8};
use crate::ray::{Sight, Way};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, Verdict};

/// Tests a node's eight boxes against a ray and stacks the children it meets.
///
/// A kernel for another instruction set is one more implementation, and one more line in `traverse::with_kernel`.
pub(crate) trait Kernel: Copy {
    /// The ray, spread over the lanes.
    type Lanes;

    /// What the tests need of a ray, clipped to the tree's box or not; `None` if it certainly misses that.
    fn ready(self, tree: &Bvh, sight: &impl Sight) -> Option<(Self::Lanes, Way)>;

    /// Pushes the children whose boxes the ray meets before `t_far`, and takes the last off the stack, or what was there before if it meets none. In
    /// the order of the ray's octant, the farthest first, or in that of the node.
    fn descend<const ORDERED: bool>(
        self,
        node: &Node8,
        lanes: &Self::Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef;

    /// What can be said of eight triangles, of crossings up to `t_far`.
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict;

    /// Runs what few steps need, compiled for the same instructions but apart from the code around it: else compilers do parts of it
    /// ahead, for every ray.
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;

    /// Asks for what a step into a child will read.
    fn fetch(self, tree: &Bvh, child: ChildRef);
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
