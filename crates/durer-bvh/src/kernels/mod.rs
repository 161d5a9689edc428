//! The node test, once per instruction set. `scalar` is the definition; the others equal it bit for bit.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod scalar;
mod stack;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
pub(crate) use scalar::Scalar;
pub(crate) use stack::{MAX_DEPTH, Stack};

use crate::node::{ChildRef, Node8};
use crate::ray::{CullRay, Line};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, Verdict};

/// Tests a node's eight boxes against a ray and stacks the children it meets.
///
/// A kernel for another instruction set is one more implementation, and one more line in `traverse::with_kernel`.
pub(crate) trait Kernel: Copy {
    /// The ray, spread over the lanes.
    type Lanes;
    /// The ray as triangles see it, spread over the lanes.
    type Sight;

    /// Clips a line to the box of a tree; `None` if it certainly misses it.
    fn cull(self, tree: &Bvh, line: &Line) -> Option<CullRay>;

    /// Spreads the ray.
    fn lanes(self, ray: &CullRay) -> Self::Lanes;

    /// Pushes the children whose boxes the ray meets before `t_far`, all but the last, which is the answer; `None` if it meets none. In the order
    /// of the ray's octant, the farthest first, or in that of the node.
    fn descend<const ORDERED: bool>(
        self,
        node: &Node8,
        lanes: &Self::Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> Option<ChildRef>;

    /// Spreads the ray.
    fn sight(self, filter: &Filter) -> Self::Sight;

    /// What can be said of eight triangles, of crossings up to `t_far`.
    fn judge(self, block: &Block, filter: &Filter, sight: &Self::Sight, t_far: f32) -> Verdict;
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
