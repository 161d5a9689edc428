//! The queries of a ray, leaf by leaf.

use crate::kernels::Kernel;
use crate::node::{ChildRef, Leaf};
use crate::ray::{ClippedRay, TreeRay};
use crate::tree::{Bvh, Splits};
use crate::triangles::{Block, Filter, LANES, Verdict};

/// The end of the search, and a triangle that is certainly hit no farther away.
#[derive(Clone, Copy)]
pub(crate) struct SearchLimit {
    /// Nothing beyond this matters. The held triangle is not beyond it.
    pub(crate) t_far: f32,
    pub(crate) held: Candidate,
}

impl SearchLimit {
    /// The limit of a ray that hits nothing.
    pub(crate) const NOWHERE: Self = Self { t_far: f32::NEG_INFINITY, held: Candidate::NOTHING };

    #[inline(always)]
    pub(crate) fn of(way: &ClippedRay) -> Self {
        Self { t_far: way.t_far, held: Candidate::NOTHING }
    }
}

/// A triangle that the ray certainly hits, before any other that was tested.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    leaf: Leaf,
    lo: f32,
}

impl Candidate {
    pub(crate) const NOTHING: Self =
        Self { leaf: Leaf { kind: 0, first: 0, count: 0, place: Leaf::NO_BLOCK }, lo: f32::INFINITY };

    /// Whether it is this triangle.
    #[inline(always)]
    fn is(&self, triangle: &Leaf) -> bool {
        self.lo < f32::INFINITY && (self.leaf.first, self.leaf.kind) == (triangle.first, triangle.kind)
    }

    /// The triangle, if there is one.
    #[inline(always)]
    pub(crate) fn leaf(&self) -> Option<Leaf> {
        (self.lo < f32::INFINITY).then_some(self.leaf)
    }
}

/// The caller's tests of leaves.
pub(crate) trait LeafTest<R> {
    /// Whether the query accepts a triangle that is certainly hit.
    fn admits(&self, triangle: Leaf) -> bool;

    /// Tests a leaf, or one triangle.
    fn test(&mut self, leaf: Leaf) -> R;
}

/// A [`LeafTest`] made of two functions.
pub(crate) struct Callbacks<A, F> {
    pub(crate) admits: A,
    pub(crate) test: F,
}

impl<R, A: Fn(Leaf) -> bool, F: FnMut(Leaf) -> R> LeafTest<R> for Callbacks<A, F> {
    #[inline(always)]
    fn admits(&self, triangle: Leaf) -> bool {
        (self.admits)(triangle)
    }

    #[inline(always)]
    fn test(&mut self, leaf: Leaf) -> R {
        (self.test)(leaf)
    }
}

/// A query; with `ORDERED` near leaves come first.
pub(crate) trait TreeQuery<const ORDERED: bool> {
    /// Tests a leaf; returns whether the search is over.
    #[inline(always)]
    fn leaf<K: Kernel>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        way: &ClippedRay,
        child: ChildRef,
        sieve: &mut impl BlockFilterSource,
        reach: &mut SearchLimit,
    ) -> bool {
        let Some((kind, number)) = tree.block(child) else { return self.shown(way, tree.leaf(child), reach) };
        let block = &tree.blocks[number as usize];
        let filter = sieve.filter(kernel, tree, way);
        let verdict = kernel.judge(block, filter, reach.t_far);
        if verdict.alive == 0 {
            return false;
        }
        // A copy: values to which only this function has a pointer stay in registers.
        let mut here = *reach;
        let is_over = self.judged(kernel, way, (kind, number), block, &verdict, &mut here);
        *reach = here;
        is_over
    }

    /// Tests a leaf that holds no triangles; returns whether the search is over.
    fn shown(&mut self, way: &ClippedRay, leaf: Leaf, reach: &mut SearchLimit) -> bool;

    /// Handles the triangles of a block that may be hit; returns whether the search is over.
    fn judged<K: Kernel>(
        &mut self,
        kernel: K,
        way: &ClippedRay,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        reach: &mut SearchLimit,
    ) -> bool;

    /// Finishes the search when there are no more leaves; returns whether it succeeded.
    fn end<K: Kernel>(&mut self, kernel: K, reach: &SearchLimit) -> bool;
}

/// The closest hit.
pub(crate) struct Closest<T>(pub(crate) T);

impl<T: LeafTest<f64>> TreeQuery<true> for Closest<T> {
    #[inline(always)]
    fn shown(&mut self, way: &ClippedRay, leaf: Leaf, reach: &mut SearchLimit) -> bool {
        reach.t_far = reach.t_far.min(way.shortened(self.0.test(leaf)));
        false
    }

    #[inline(always)]
    fn judged<K: Kernel>(
        &mut self,
        kernel: K,
        way: &ClippedRay,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        reach: &mut SearchLimit,
    ) -> bool {
        kernel.apart(
            #[inline(always)]
            || self.sort_out(way, of, block, verdict, reach),
        );
        false
    }

    #[inline(always)]
    fn end<K: Kernel>(&mut self, kernel: K, reach: &SearchLimit) -> bool {
        if let Some(leaf) = reach.held.leaf() {
            kernel.apart(
                #[inline(always)]
                || self.0.test(leaf),
            );
        }
        false
    }
}

impl<T: LeafTest<f64>> Closest<T> {
    /// Updates the limit with the triangles that may be hit. A triangle that is certainly hit
    /// before all others is held; else the caller tests it.
    #[inline(always)]
    fn sort_out(
        &mut self,
        way: &ClippedRay,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        reach: &mut SearchLimit,
    ) {
        let SearchLimit { mut t_far, mut held } = *reach;
        let mut alive = verdict.alive;
        while alive != 0 {
            let lane = first(alive, &verdict.lo);
            alive &= !(1 << lane);
            let (lo, hi) = (verdict.lo[lane], verdict.hi[lane]);
            // The limit may have decreased since the verdict.
            if lo > t_far {
                break;
            }
            let leaf = triangle(of, block, lane);
            let is_sure = verdict.sure >> lane & 1 != 0 && self.0.admits(leaf);
            if is_sure && hi < held.lo {
                held = Candidate { leaf, lo };
                t_far = t_far.min(hi);
                continue;
            }
            // The same triangle in another leaf.
            if held.is(&leaf) {
                continue;
            }
            // In doubt, or its bounds overlap those of the triangle held.
            if is_sure {
                t_far = t_far.min(way.shortened(self.0.test(held.leaf)));
                held = Candidate::NOTHING;
                if lo > t_far {
                    continue;
                }
            }
            t_far = t_far.min(way.shortened(self.0.test(leaf)));
            if held.lo > t_far {
                held = Candidate::NOTHING;
            }
        }
        *reach = SearchLimit { t_far, held };
    }
}

/// The lane with the least `lo` of some lanes: the nearest first may save tests of the others.
#[inline(always)]
fn first(lanes: u32, lo: &[f32; LANES]) -> usize {
    let lane = |lanes: u32| lanes.trailing_zeros() as usize % LANES;
    let (mut first, mut rest) = (lane(lanes), lanes & lanes.wrapping_sub(1));
    while rest != 0 {
        let other = lane(rest);
        rest &= rest - 1;
        first = if lo[other] < lo[first] { other } else { first };
    }
    first
}

/// Any hit.
pub(crate) struct Any<T>(pub(crate) T);

impl<T: LeafTest<bool>> TreeQuery<false> for Any<T> {
    #[inline(always)]
    fn shown(&mut self, _: &ClippedRay, leaf: Leaf, _: &mut SearchLimit) -> bool {
        self.0.test(leaf)
    }

    #[inline(always)]
    fn judged<K: Kernel>(
        &mut self,
        kernel: K,
        _: &ClippedRay,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        _: &mut SearchLimit,
    ) -> bool {
        kernel.apart(
            #[inline(always)]
            || self.is_met(of, block, verdict),
        )
    }

    #[inline(always)]
    fn end<K: Kernel>(&mut self, _: K, _: &SearchLimit) -> bool {
        false
    }
}

impl<T: LeafTest<bool>> Any<T> {
    #[inline(always)]
    fn is_met(&mut self, of: (u32, u32), block: &Block, verdict: &Verdict) -> bool {
        let mut alive = verdict.alive;
        while alive != 0 {
            let lane = alive.trailing_zeros() as usize % LANES;
            alive &= alive - 1;
            let leaf = triangle(of, block, lane);
            let is_sure = verdict.sure >> lane & 1 != 0 && self.0.admits(leaf);
            if is_sure || self.0.test(leaf) {
                return true;
            }
        }
        false
    }
}

/// All entries that may be hit, each once.
pub(crate) struct Each<'a, K: Kernel, F> {
    pub(crate) kernel: K,
    pub(crate) tree: &'a Bvh,
    pub(crate) lanes: &'a K::Lanes,
    pub(crate) test: F,
}

impl<L: Kernel, F: FnMut(Leaf) -> bool> TreeQuery<false> for Each<'_, L, F> {
    #[inline(always)]
    fn shown(&mut self, _: &ClippedRay, leaf: Leaf, _: &mut SearchLimit) -> bool {
        (self.test)(leaf)
    }

    #[inline(always)]
    fn judged<K: Kernel>(
        &mut self,
        kernel: K,
        _: &ClippedRay,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        reach: &mut SearchLimit,
    ) -> bool {
        let t_far = reach.t_far;
        kernel.apart(
            #[inline(always)]
            || {
                let mut alive = verdict.alive;
                while alive != 0 {
                    let lane = alive.trailing_zeros() as usize % LANES;
                    alive &= alive - 1;
                    let leaf = triangle(of, block, lane);
                    if self.is_first(of.1, &leaf, t_far) && (self.test)(leaf) {
                        return true;
                    }
                }
                false
            },
        )
    }

    #[inline(always)]
    fn end<K: Kernel>(&mut self, _: K, _: &SearchLimit) -> bool {
        false
    }
}

impl<K: Kernel, F> Each<'_, K, F> {
    /// Whether a block is the one that reports a triangle of it: see
    /// [`Splits`](crate::tree::Splits).
    #[inline(always)]
    fn is_first(&self, block: u32, triangle: &Leaf, t_far: f32) -> bool {
        let tree = self.tree;
        let Some(split) = tree.splits.number(triangle.kind, triangle.first) else { return true };
        for &place in tree.splits.places(split) {
            let (node, slot) = Splits::child(place);
            let node = &tree.nodes[node];
            if tree.block(node.child[slot]).is_some_and(|(_, number)| number == block) {
                return true;
            }
            if self.kernel.meets(node, slot, self.lanes, t_far) {
                return false;
            }
        }
        true
    }
}

/// The source of a ray's triangle filter.
pub(crate) trait BlockFilterSource {
    fn filter<K: Kernel>(&mut self, kernel: K, tree: &Bvh, way: &ClippedRay) -> &Filter;
}

/// For single rays: builds the filter at the first triangle, since many rays reach none.
pub(crate) struct LazyFilter<'a, S> {
    pub(crate) sight: &'a S,
    pub(crate) filter: &'a mut Option<Filter>,
}

impl<S: TreeRay> BlockFilterSource for LazyFilter<'_, S> {
    #[inline(always)]
    fn filter<K: Kernel>(&mut self, kernel: K, tree: &Bvh, way: &ClippedRay) -> &Filter {
        let (sight, filter) = (self.sight, &mut *self.filter);
        if filter.is_none() {
            // Written in place: a copy right after piecewise stores would stall.
            kernel.apart(
                #[inline(always)]
                || *filter = Some(Filter::new(|| tree.local_line(sight), way, tree.rounded)),
            );
        }
        filter.get_or_insert(Filter::NOTHING)
    }
}

/// For batched rays: builds the filter at the first triangle.
pub(crate) struct QueuedFilter<'a, S> {
    pub(crate) sight: &'a S,
    pub(crate) filter: &'a mut Option<Filter>,
}

impl<S: TreeRay> BlockFilterSource for QueuedFilter<'_, S> {
    #[inline(always)]
    fn filter<K: Kernel>(&mut self, kernel: K, tree: &Bvh, way: &ClippedRay) -> &Filter {
        let sight = self.sight;
        self.filter.get_or_insert_with(
            #[inline(always)]
            || {
                if way.is_exact {
                    return Filter::of_exact(way, tree.rounded);
                }
                kernel.apart(
                    #[inline(always)]
                    || Filter::new(|| tree.local_line(sight), way, tree.rounded),
                )
            },
        )
    }
}

/// For exactly known rays: builds the filter at the first triangle.
pub(crate) struct ExactRayData {
    pub(crate) filter: Option<Filter>,
}

impl BlockFilterSource for ExactRayData {
    #[inline(always)]
    fn filter<K: Kernel>(&mut self, _: K, tree: &Bvh, way: &ClippedRay) -> &Filter {
        self.filter.get_or_insert_with(
            #[inline(always)]
            || Filter::of_exact(way, tree.rounded),
        )
    }
}

/// One triangle of a block, from its kind and the number of the block.
#[inline(always)]
fn triangle((kind, number): (u32, u32), block: &Block, lane: usize) -> Leaf {
    Leaf { kind, first: block.slot(lane), count: 1, place: number * LANES as u32 + lane as u32 }
}
