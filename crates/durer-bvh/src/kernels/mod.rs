//! The node test, once per instruction set. `scalar` is the definition; the others equal it bit for bit.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod scalar;
mod stack;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
pub(crate) use scalar::Scalar;
pub(crate) use stack::{MAX_DEPTH, Stack};

use crate::node::Node8;
use crate::ray::CullRay;

/// Tests a node's eight boxes against a ray and stacks the children it meets.
///
/// A kernel for another instruction set is one more implementation, and one more line in `traverse::with_kernel`.
pub(crate) trait Kernel: Copy {
    /// The ray, spread over the lanes.
    type Lanes;

    /// Spreads the ray.
    fn lanes(self, ray: &CullRay) -> Self::Lanes;

    /// Pushes the children whose boxes the ray meets before `t_far`, the farthest first in the order of the ray's octant.
    fn push_ordered(self, node: &Node8, lanes: &Self::Lanes, t_far: f32, stack: &mut Stack);

    /// Pushes the children whose boxes the ray meets, in the order of the node.
    fn push_unordered(self, node: &Node8, lanes: &Self::Lanes, t_far: f32, stack: &mut Stack);
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
