//! Which leaves might a ray meet?

use crate::kernels::{Abreast, Kernel, Scalar, Stack};
use crate::node::{ChildRef, Leaf};
use crate::query::{Any, BlockFilterSource, Callbacks, Closest, Each, LazyFilter, SearchLimit, TreeQuery};
use crate::ray::{ClippedRay, TreeRay};
use crate::tree::Bvh;
use durer_math::kernels::Path;
use durer_math::{Isa, Point3, Vec3};

/// An operation on a tree that works with any kernel.
pub(crate) trait Traversal {
    type Answer;
    fn run<K: Abreast>(self, kernel: K, tree: &Bvh) -> Self::Answer;
}

impl Bvh {
    /// Passes what the ray might hit to `test`, front to back as far as the order of octants
    /// allows. `test` returns the parameter beyond which nothing matters any more.
    ///
    /// Every leaf is tested in whose box the exact ray is at some `t` in its range, not beyond the
    /// least limit so far. Of triangles only those are tested, one by one, that the ray may hit
    /// there, without those that are certainly behind another triangle that it certainly hits and
    /// for which `admits` returns true.
    #[inline(always)]
    pub fn closest(
        &self,
        isa: Isa,
        sight: &impl TreeRay,
        admits: impl Fn(Leaf) -> bool,
        test: impl FnMut(Leaf) -> f64,
    ) {
        self.with_kernel(isa, Single::<_, _, true> { sight, quest: Closest(Callbacks { admits, test }) });
    }

    /// Passes what the ray might hit to `test` until it returns true. Returns whether it did, or
    /// whether the ray certainly hits, within its range, a triangle for which `trusts` returns
    /// true.
    ///
    /// Every leaf is tested in whose box the exact ray is at some `t` in its range; of triangles
    /// only those that the ray may hit there, one by one. The order is arbitrary; a triangle in
    /// several leaves may be tested several times.
    #[inline(always)]
    pub fn any(
        &self,
        isa: Isa,
        sight: &impl TreeRay,
        trusts: impl Fn(Leaf) -> bool,
        test: impl FnMut(Leaf) -> bool,
    ) -> bool {
        self.with_kernel(isa, Single::<_, _, false> { sight, quest: Any(Callbacks { admits: trusts, test }) })
    }

    /// [`Bvh::any`] that trusts no triangle and tests each triangle once.
    #[inline(always)]
    pub fn each(&self, isa: Isa, sight: &impl TreeRay, test: impl FnMut(Leaf) -> bool) -> bool {
        self.with_kernel(isa, AllOnce { sight, test })
    }

    /// Passes the leaves whose boxes may hold a point, known within `error` (per axis), to `test`,
    /// until it returns true; returns whether it did. An entry in several leaves may be tested
    /// several times.
    pub fn containing(&self, point: Point3, error: Vec3, mut test: impl FnMut(Leaf) -> bool) -> bool {
        if self.is_empty() {
            return false;
        }
        // Boxes were rounded outward after scaling; so the point may be rounded by less than that
        // and a step.
        let units = self.frame.units();
        let reach = |(x, lost): (f64, f64), e: f64| {
            let e = if lost == 0.0 { e } else { (e + lost.abs()).next_up() };
            let (a, b) = (units.inward((x - e).next_down()), units.inward((x + e).next_up()));
            (a.next_down(), b.next_up())
        };
        let reach = [0, 1, 2].map(|i| reach(self.frame.difference(point[i], i), error[i]));
        let mut waiting = vec![ChildRef::node(0)];
        while let Some(child) = waiting.pop() {
            if child.is_leaf() {
                if self.leaves(child, &mut test) {
                    return true;
                }
                continue;
            }
            let node = &self.nodes[child.index()];
            for slot in node.used() {
                let (lo, hi) = node.bounds(slot);
                if (0..3).all(|i| f64::from(lo[i]) <= reach[i].1 && reach[i].0 <= f64::from(hi[i])) {
                    waiting.push(node.child[slot]);
                }
            }
        }
        false
    }

    /// Picks the kernel once and runs a traversal, compiled for its instructions.
    #[inline(always)]
    pub(crate) fn with_kernel<E: Traversal>(&self, isa: Isa, errand: E) -> E::Answer {
        #[cfg(target_arch = "x86_64")]
        if let Some(kernel) = crate::kernels::Avx512::of(isa) {
            return isa.run_in_lanes(
                #[inline(always)]
                || errand.run(kernel, self),
            );
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(kernel) = crate::kernels::Avx2::of(isa) {
            return isa.run(
                #[inline(always)]
                || errand.run(kernel, self),
            );
        }
        if isa.path() == Path::Unfused {
            return errand.run(Scalar::<false>, self);
        }
        errand.run(Scalar::<true>, self)
    }
}

/// A query of one ray. The answer is whether it found what it looked for.
struct Single<'a, S, Q, const ORDERED: bool> {
    sight: &'a S,
    quest: Q,
}

impl<S: TreeRay, Q: TreeQuery<ORDERED>, const ORDERED: bool> Traversal for Single<'_, S, Q, ORDERED> {
    type Answer = bool;

    #[inline(always)]
    fn run<K: Abreast>(self, kernel: K, tree: &Bvh) -> bool {
        if tree.is_empty() {
            return false;
        }
        let Some((ray, way)) = kernel.set_up(tree, self.sight) else { return false };
        let lanes = kernel.spread(&ray);
        let (mut filter, mut reach, mut quest) = (None, SearchLimit::of(&way), self.quest);
        let mut sieve = LazyFilter { sight: self.sight, filter: &mut filter };
        follow(kernel, tree, &lanes, &way, ChildRef::node(0), &mut sieve, &mut reach, &mut quest)
            || quest.end(kernel, &reach)
    }
}

/// A query of one ray for everything that it may hit.
struct AllOnce<'a, S, F> {
    sight: &'a S,
    test: F,
}

impl<S: TreeRay, F: FnMut(Leaf) -> bool> Traversal for AllOnce<'_, S, F> {
    type Answer = bool;

    #[inline(always)]
    fn run<K: Abreast>(self, kernel: K, tree: &Bvh) -> bool {
        if tree.is_empty() {
            return false;
        }
        let Some((ray, way)) = kernel.set_up(tree, self.sight) else { return false };
        let lanes = kernel.spread(&ray);
        let (mut filter, mut reach) = (None, SearchLimit::of(&way));
        let mut sieve = LazyFilter { sight: self.sight, filter: &mut filter };
        let mut quest = Each { kernel, tree, lanes: &lanes, test: self.test };
        follow(kernel, tree, &lanes, &way, ChildRef::node(0), &mut sieve, &mut reach, &mut quest)
    }
}

/// Traverses the subtree of a child; returns whether the search is over.
#[inline(always)]
#[expect(
    clippy::too_many_arguments,
    reason = "what a ray is, in the parts that a search changes and does not change"
)]
pub(crate) fn follow<K: Kernel, Q: TreeQuery<ORDERED>, const ORDERED: bool>(
    kernel: K,
    tree: &Bvh,
    lanes: &K::Lanes,
    way: &ClippedRay,
    mut child: ChildRef,
    sieve: &mut impl BlockFilterSource,
    reach: &mut SearchLimit,
    quest: &mut Q,
) -> bool {
    let mut stack = Stack::new();
    loop {
        while !child.is_leaf() {
            child = kernel.descend::<ORDERED>(&tree.nodes[child.index()], lanes, reach.t_far, &mut stack);
        }
        if child == ChildRef::END {
            return false;
        }
        let before = reach.t_far;
        if quest.leaf(kernel, tree, way, child, sieve, reach) {
            return true;
        }
        if reach.t_far < before {
            stack.prune(reach.t_far);
        }
        child = stack.pop();
    }
}
