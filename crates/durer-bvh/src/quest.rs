//! What a ray looks for, leaf by leaf.

use crate::kernels::Kernel;
use crate::node::{ChildRef, Leaf};
use crate::ray::{Sight, Way};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, LANES, Verdict};

/// How far to look, and a triangle that is certainly met no farther away.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    /// Nothing beyond matters; a triangle held is not beyond it.
    pub(crate) t_far: f32,
    held: Held,
}

impl Reach {
    #[inline(always)]
    pub(crate) fn of(way: &Way) -> Self {
        Self { t_far: way.t_far, held: Held::NOTHING }
    }
}

/// A triangle that the ray certainly meets, before any other that has been shown.
#[derive(Clone, Copy)]
struct Held {
    leaf: Leaf,
    lo: f32,
}

impl Held {
    const NOTHING: Self =
        Self { leaf: Leaf { kind: 0, first: 0, count: 0, place: Leaf::NO_BLOCK }, lo: f32::INFINITY };
}

/// What the caller knows of leaves.
pub(crate) trait Answers<R> {
    /// Whether a triangle that is certainly met counts.
    fn admits(&self, triangle: Leaf) -> bool;

    /// Asks about a leaf, or about one triangle.
    fn test(&mut self, leaf: Leaf) -> R;
}

/// Two functions.
pub(crate) struct Pair<A, F> {
    pub(crate) admits: A,
    pub(crate) test: F,
}

impl<R, A: Fn(Leaf) -> bool, F: FnMut(Leaf) -> R> Answers<R> for Pair<A, F> {
    #[inline(always)]
    fn admits(&self, triangle: Leaf) -> bool {
        (self.admits)(triangle)
    }

    #[inline(always)]
    fn test(&mut self, leaf: Leaf) -> R {
        (self.test)(leaf)
    }
}

/// The aim of a search; `ORDERED` says whether near leaves should come first.
pub(crate) trait Quest<const ORDERED: bool> {
    /// Looks at a leaf; says whether the search is over.
    #[expect(
        clippy::too_many_arguments,
        reason = "what a ray is, in the parts that a search changes and does not change"
    )]
    fn leaf<K: Kernel>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        sight: &impl Sight,
        way: &Way,
        child: ChildRef,
        filter: &mut Option<Filter>,
        reach: &mut Reach,
    ) -> bool;

    /// There are no more leaves; says whether there was what it looked for.
    fn end(&mut self, reach: &Reach) -> bool;
}

/// The closest hit.
pub(crate) struct Closest<T>(pub(crate) T);

impl<T: Answers<f64>> Quest<true> for Closest<T> {
    #[inline(always)]
    fn leaf<K: Kernel>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        sight: &impl Sight,
        way: &Way,
        child: ChildRef,
        filter: &mut Option<Filter>,
        reach: &mut Reach,
    ) -> bool {
        let Some((kind, number)) = tree.block(child) else {
            reach.t_far = reach.t_far.min(way.shortened(self.0.test(tree.leaf(child))));
            return false;
        };
        let block = &tree.blocks[number as usize];
        let filter = filter_of(kernel, tree, sight, way, filter);
        let verdict = kernel.judge(block, filter, reach.t_far);
        if verdict.alive != 0 {
            let before = *reach;
            *reach = kernel.apart(
                #[inline(always)]
                || self.sort_out(way, (kind, number), block, &verdict, before),
            );
        }
        false
    }

    #[inline(always)]
    fn end(&mut self, reach: &Reach) -> bool {
        if reach.held.lo < f32::INFINITY {
            self.0.test(reach.held.leaf);
        }
        false
    }
}

impl<T: Answers<f64>> Closest<T> {
    /// What triangles that may be met do to how far to look: one is held if it is certainly met before all others, else the caller is asked.
    #[inline(always)]
    fn sort_out(
        &mut self,
        way: &Way,
        of: (u32, u32),
        block: &Block,
        verdict: &Verdict,
        before: Reach,
    ) -> Reach {
        let Reach { mut t_far, mut held } = before;
        let mut alive = verdict.alive;
        while alive != 0 {
            let lane = alive.trailing_zeros() as usize & 7;
            alive &= alive - 1;
            let (lo, hi) = (verdict.lo[lane], verdict.hi[lane]);
            // The limit may have come nearer since.
            if lo > t_far {
                continue;
            }
            let leaf = triangle(of, block, lane);
            let is_sure = verdict.sure >> lane & 1 != 0 && self.0.admits(leaf);
            if is_sure && hi < held.lo {
                held = Held { leaf, lo };
                t_far = t_far.min(hi);
                continue;
            }
            // In doubt, or too near to the one held.
            if is_sure {
                t_far = t_far.min(way.shortened(self.0.test(held.leaf)));
                held = Held::NOTHING;
                if lo > t_far {
                    continue;
                }
            }
            t_far = t_far.min(way.shortened(self.0.test(leaf)));
            if held.lo > t_far {
                held = Held::NOTHING;
            }
        }
        Reach { t_far, held }
    }
}

/// Any hit.
pub(crate) struct Any<T>(pub(crate) T);

impl<T: Answers<bool>> Quest<false> for Any<T> {
    #[inline(always)]
    fn leaf<K: Kernel>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        sight: &impl Sight,
        way: &Way,
        child: ChildRef,
        filter: &mut Option<Filter>,
        reach: &mut Reach,
    ) -> bool {
        let Some((kind, number)) = tree.block(child) else { return self.0.test(tree.leaf(child)) };
        let block = &tree.blocks[number as usize];
        let filter = filter_of(kernel, tree, sight, way, filter);
        let verdict = kernel.judge(block, filter, reach.t_far);
        verdict.alive != 0
            && kernel.apart(
                #[inline(always)]
                || self.is_met((kind, number), block, &verdict),
            )
    }

    #[inline(always)]
    fn end(&mut self, _: &Reach) -> bool {
        false
    }
}

impl<T: Answers<bool>> Any<T> {
    #[inline(always)]
    fn is_met(&mut self, of: (u32, u32), block: &Block, verdict: &Verdict) -> bool {
        let mut alive = verdict.alive;
        while alive != 0 {
            let lane = alive.trailing_zeros() as usize & 7;
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

/// What triangles need to know of a ray: many rays come to none, so nothing of it is done before.
#[inline(always)]
fn filter_of<'a, K: Kernel>(
    kernel: K,
    tree: &Bvh,
    sight: &impl Sight,
    way: &Way,
    filter: &'a mut Option<Filter>,
) -> &'a Filter {
    filter.get_or_insert_with(
        #[inline(always)]
        || {
            kernel.apart(
                #[inline(always)]
                || Filter::new(sight, way, tree.rounded),
            )
        },
    )
}

/// A triangle of a block, by its kind and the number of the block.
#[inline(always)]
fn triangle((kind, number): (u32, u32), block: &Block, lane: usize) -> Leaf {
    Leaf { kind, first: block.slot(lane), count: 1, place: number * LANES as u32 + lane as u32 }
}
