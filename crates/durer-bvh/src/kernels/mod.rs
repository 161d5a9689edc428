//! What is done for each node and block, once per instruction set. `scalar` is the definition; the
//! others equal it bit for bit, but for how a ray is made ready: there each may be as generous as
//! its bounds allow.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod bins;
#[cfg(target_arch = "x86_64")]
mod packet16;
#[cfg(target_arch = "x86_64")]
mod packet8;
#[cfg(target_arch = "x86_64")]
mod planes;
mod scalar;
mod stack;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;
pub(crate) use bins::{add_centres, fill};
pub(crate) use scalar::Scalar;
pub(crate) use stack::{MAX_DEPTH, Rows, Stack};

use crate::node::{ChildRef, Node};
use crate::ray::{ClippedRay, PACKET, Packet32, TWICE, TreeRay};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, Verdict};

/// Tests a node's boxes against a ray and stacks the children it meets.
///
/// A kernel for another instruction set is one more implementation, and one more line in
/// `traverse::with_kernel`.
pub(crate) trait Kernel: Copy {
    /// What node tests need of a ray.
    type Ray;

    /// The same, spread over the lanes.
    type Lanes;

    /// What the tests need of a ray, clipped to the tree's box or not; `None` if it certainly
    /// misses that.
    #[inline(always)]
    fn set_up(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)> {
        let nearby = self.nearby(tree, sight);
        if nearby.is_some() { nearby } else { self.afar(tree, sight) }
    }

    /// The same at a glance; `None` if that is not enough.
    fn nearby(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)>;

    /// The same of a ray of which a glance did not say it.
    fn afar(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)>;

    /// Brings a ray into the lanes.
    fn spread(self, ray: &Self::Ray) -> Self::Lanes;

    /// Pushes the children whose boxes the ray meets before `t_far`, and takes the last off the
    /// stack, or what was there before if it meets none. In the order of the ray's octant, the
    /// farthest first, or in that of the node.
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        lanes: &Self::Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef;

    /// Whether [`Kernel::descend`] pushes the child in a slot.
    fn meets(self, node: &Node, slot: usize, lanes: &Self::Lanes, t_far: f32) -> bool;

    /// What can be said of sixteen triangles, of crossings up to `t_far`.
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict;

    /// Runs what few steps need, and what is the caller's, compiled apart from the code around it:
    /// else compilers do parts of it ahead, for every ray. For the instructions of
    /// [`Isa::run`](durer_math::Isa::efloat).
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;

    /// The same for what is made of this kernel's own steps, and compiled for its own instructions.
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R;

    /// Asks for what a step into a child will read.
    fn fetch(self, tree: &Bvh, child: ChildRef);
}

/// The same for `N` rays that go through a tree together.
pub(crate) trait Together<const N: usize>: Kernel {
    /// The rays.
    type Packet;

    /// What triangles need to know of them.
    type Filters;

    /// Whether there are such packets at all.
    const EXISTS: bool = true;

    /// Rays, eight in each element, as a packet, if they are exactly known, nearby and so much
    /// alike that it pays.
    fn gather(self, tree: &Bvh, rays: &[&Packet32]) -> Option<Self::Packet>;

    /// How far each ray of a packet looks at most.
    fn ends(self, packet: &Self::Packet) -> [f32; N];

    /// One of a packet's rays: the very numbers that [`Kernel::set_up`] gives.
    fn one(self, tree: &Bvh, packet: &Self::Packet, ray: usize) -> (Self::Ray, ClippedRay);

    /// The second half of that.
    fn way(self, tree: &Bvh, packet: &Self::Packet, ray: usize) -> ClippedRay;

    /// Which rays' parameters in a `row` are not beyond their `t_far`.
    fn awake(self, row: &[f32; N], t_far: &[f32; N]) -> u32;

    /// What [`Filter::of_exact`] gives for each ray.
    fn filters(self, tree: &Bvh, packet: &Self::Packet) -> Self::Filters;

    /// [`Kernel::judge`] for those rays that are `awake`: of whom a triangle is alive, and their
    /// verdicts.
    fn judge_together(
        self,
        block: &Block,
        filters: &Self::Filters,
        awake: u32,
        t_far: &[f32; N],
        verdicts: &mut [Verdict; N],
    ) -> u32;

    /// Pushes the children that [`Kernel::descend`] pushes for any of the rays that are awake, and
    /// where each ray enters them, or NaN where it does not. Beyond `far` none of the rays looks.
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node,
        packet: &Self::Packet,
        row: &[f32; N],
        t_far: (&[f32; N], f32),
        rows: &mut Rows<N>,
    );
}

/// A kernel for rays alone, and for as many together as there are lanes for.
pub(crate) trait Abreast: Kernel + Together<PACKET> + Together<TWICE> {}

impl<K: Kernel + Together<PACKET> + Together<TWICE>> Abreast for K {}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
