//! The work per node and block, once per instruction set. `scalar` is the definition. The others
//! return the same bits, but for the setup of a ray: there each may be as generous as its bounds
//! allow.

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

/// Tests a node's boxes against a ray and pushes the children that it meets.
///
/// A kernel for another instruction set is one more implementation, and one more line in
/// `traverse::with_kernel`.
pub(crate) trait Kernel: Copy {
    /// The numbers that node tests need of a ray.
    type Ray;

    /// [`Kernel::Ray`], broadcast to the lanes.
    type Lanes;

    /// Sets up a ray for the tests, clipped to the tree's box or not; `None` if it certainly misses
    /// the box.
    #[inline(always)]
    fn set_up(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)> {
        let nearby = self.nearby(tree, sight);
        if nearby.is_some() { nearby } else { self.afar(tree, sight) }
    }

    /// Sets up a ray from its f32 form; `None` if that does not suffice.
    fn nearby(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)>;

    /// Sets up a ray for which [`Kernel::nearby`] returned `None`.
    fn afar(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Self::Ray, ClippedRay)>;

    /// Broadcasts a ray to the lanes.
    fn spread(self, ray: &Self::Ray) -> Self::Lanes;

    /// Pushes the children whose boxes the ray meets before `t_far`, and pops the last of them, or
    /// the old top of the stack if it meets none. If `ORDERED`, the order is that of the ray's
    /// octant, the farthest first, else that of the node.
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        lanes: &Self::Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef;

    /// Whether [`Kernel::descend`] pushes the child in a slot.
    fn meets(self, node: &Node, slot: usize, lanes: &Self::Lanes, t_far: f32) -> bool;

    /// The filter's verdict on sixteen triangles, for crossings up to `t_far`.
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict;

    /// Runs a closure that few steps need, and calls into the caller's code, compiled apart from
    /// the code around it: else compilers hoist parts of it, which every ray would pay for.
    /// Compiled for the instructions of [`Isa::run`](durer_math::Isa::efloat).
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;

    /// [`Kernel::apart`] for code that is made of this kernel's own steps, compiled for its own
    /// instructions.
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R;

    /// Prefetches what a step into a child will read.
    fn fetch(self, tree: &Bvh, child: ChildRef);
}

/// A kernel for packets of `N` rays.
pub(crate) trait Together<const N: usize>: Kernel {
    /// The rays.
    type Packet;

    /// The numbers that triangle tests need of a packet.
    type Filters;

    /// Whether this kernel has packets of this size.
    const EXISTS: bool = true;

    /// Makes a packet of rays, eight in each element, if they are exactly known, near the tree and
    /// so similar that a packet pays.
    fn gather(self, tree: &Bvh, rays: &[&Packet32]) -> Option<Self::Packet>;

    /// The greatest parameter of each ray of a packet.
    fn ends(self, packet: &Self::Packet) -> [f32; N];

    /// One of a packet's rays: the same numbers as from [`Kernel::set_up`].
    fn one(self, tree: &Bvh, packet: &Self::Packet, ray: usize) -> (Self::Ray, ClippedRay);

    /// The second half of [`Together::one`].
    fn way(self, tree: &Bvh, packet: &Self::Packet, ray: usize) -> ClippedRay;

    /// The mask of rays whose parameter in `row` is not beyond their `t_far`.
    fn awake(self, row: &[f32; N], t_far: &[f32; N]) -> u32;

    /// [`Filter::of_exact`] for each ray.
    fn filters(self, tree: &Bvh, packet: &Self::Packet) -> Self::Filters;

    /// [`Kernel::judge`] for the rays that are `awake`. Returns the mask of rays with a triangle
    /// alive, and writes their verdicts.
    fn judge_together(
        self,
        block: &Block,
        filters: &Self::Filters,
        awake: u32,
        t_far: &[f32; N],
        verdicts: &mut [Verdict; N],
    ) -> u32;

    /// Pushes each child that [`Kernel::descend`] pushes for any of the rays that are awake, with
    /// the parameter at which each ray enters it, or NaN where it does not. No ray searches beyond
    /// `far`.
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node,
        packet: &Self::Packet,
        row: &[f32; N],
        t_far: (&[f32; N], f32),
        rows: &mut Rows<N>,
    );
}

/// A kernel for single rays and for packets of both sizes.
pub(crate) trait Abreast: Kernel + Together<PACKET> + Together<TWICE> {}

impl<K: Kernel + Together<PACKET> + Together<TWICE>> Abreast for K {}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
