//! Which leaves might a ray meet?

use crate::kernels::{Kernel, Scalar, Stack};
use crate::node::{ChildRef, Leaf};
use crate::ray::{CullRay, Line};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter};
use durer_math::kernels::Path;
use durer_math::{Isa, Point3, Vec3};

/// What is done with a ray, for any kernel.
trait Traversal {
    type Answer;
    fn run<K: Kernel>(self, kernel: K, tree: &Bvh, line: &Line, ray: &CullRay) -> Self::Answer;
}

impl Bvh {
    /// Shows what the ray might meet to `test`, front to back as far as the order of octants tells; `test` returns the parameter
    /// beyond which nothing matters any more.
    ///
    /// Every leaf in whose box the exact ray is at some `t` in its range, not beyond the least limit so far, is shown; of
    /// triangles those alone that the ray may meet there, one by one, and not one that is certainly behind another that it certainly meets
    /// and that `admits` admits.
    #[inline(always)]
    pub fn closest(
        &self,
        isa: Isa,
        line: &Line,
        admits: impl Fn(Leaf) -> bool,
        test: impl FnMut(Leaf) -> f64,
    ) {
        self.with_kernel(isa, line, Closest { admits, test });
    }

    /// Shows what the ray might meet to `test`, until it says that it has found what it looked for; says whether it did, or
    /// whether the ray certainly meets a triangle within its range that `trusts` says is it.
    ///
    /// Every leaf in whose box the exact ray is at some `t` in its range is shown, of triangles those alone that the ray may
    /// meet there, one by one, all in no particular order.
    #[inline(always)]
    pub fn any(
        &self,
        isa: Isa,
        line: &Line,
        trusts: impl Fn(Leaf) -> bool,
        test: impl FnMut(Leaf) -> bool,
    ) -> bool {
        self.with_kernel(isa, line, Any { trusts, test }).unwrap_or(false)
    }

    /// Shows the leaves whose boxes may hold a point, known within `error` (per axis), to `test`, until it says that it
    /// has found what it looked for; says whether it did.
    pub fn containing(&self, point: Point3, error: Vec3, mut test: impl FnMut(Leaf) -> bool) -> bool {
        if self.is_empty() {
            return false;
        }
        // Boxes were rounded outward after scaling; so the point may be rounded by less than that and a step.
        let reach = |x: f64, e: f64| {
            let (a, b) = (self.frame.inward((x - e).next_down()), self.frame.inward((x + e).next_up()));
            (a.next_down(), b.next_up())
        };
        let reach = [0, 1, 2].map(|i| reach(point[i], error[i]));
        let mut waiting = vec![ChildRef::node(0)];
        while let Some(child) = waiting.pop() {
            if child.is_leaf() {
                if test(self.leaf(child)) {
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

    /// Picks the kernel once and enters it through the one door.
    #[inline(always)]
    fn with_kernel<T: Traversal>(&self, isa: Isa, line: &Line, traversal: T) -> Option<T::Answer> {
        #[cfg(target_arch = "x86_64")]
        if let Some(kernel) = crate::kernels::Avx2::of(isa) {
            return isa.run(
                #[inline(always)]
                || self.enter(kernel, line, traversal),
            );
        }
        if isa.path() == Path::Unfused {
            return self.enter(Scalar::<false>, line, traversal);
        }
        self.enter(Scalar::<true>, line, traversal)
    }

    #[inline(always)]
    fn enter<K: Kernel, T: Traversal>(&self, kernel: K, line: &Line, traversal: T) -> Option<T::Answer> {
        if self.is_empty() {
            return None;
        }
        let ray = kernel.cull(self, line)?;
        Some(traversal.run(kernel, self, line, &ray))
    }
}

/// A triangle that the ray certainly meets, before any other that has been shown.
#[derive(Clone, Copy)]
struct Held {
    leaf: Leaf,
    lo: f32,
}

impl Held {
    const NOTHING: Self = Self { leaf: Leaf { kind: 0, first: 0, count: 0 }, lo: f32::INFINITY };
}

struct Closest<A, F> {
    admits: A,
    test: F,
}

impl<A: Fn(Leaf) -> bool, F: FnMut(Leaf) -> f64> Traversal for Closest<A, F> {
    type Answer = ();

    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K, tree: &Bvh, line: &Line, ray: &CullRay) {
        let lanes = kernel.lanes(ray);
        let mut sight = None;
        let mut stack = Stack::new();
        // Nothing beyond `t_far` matters; a triangle held is not beyond it.
        let mut t_far = ray.t_far;
        let mut held = Held::NOTHING;
        let mut child = ChildRef::node(0);
        'ray: loop {
            while !child.is_leaf() {
                let node = &tree.nodes[child.index()];
                match kernel.descend::<true>(node, &lanes, t_far, &mut stack) {
                    Some(next) => child = next,
                    None => match stack.pop_before(t_far) {
                        Some(next) => child = next,
                        None => break 'ray,
                    },
                }
            }
            match tree.block(child) {
                None => t_far = t_far.min(ray.shortened((self.test)(tree.leaf(child)))),
                Some((kind, block)) => {
                    let (filter, sight) = sight.get_or_insert_with(
                        #[inline(always)]
                        || see(kernel, tree, line, ray),
                    );
                    let verdict = kernel.judge(block, filter, sight, t_far);
                    let mut alive = verdict.alive;
                    while alive != 0 {
                        let lane = alive.trailing_zeros() as usize & 7;
                        alive &= alive - 1;
                        let (lo, hi) = (verdict.lo[lane], verdict.hi[lane]);
                        // The limit may have come nearer since.
                        if lo > t_far {
                            continue;
                        }
                        let leaf = triangle(kind, block, lane);
                        let is_sure = verdict.sure >> lane & 1 != 0 && (self.admits)(leaf);
                        if is_sure && hi < held.lo {
                            held = Held { leaf, lo };
                            t_far = t_far.min(hi);
                            continue;
                        }
                        // In doubt, or too near to the one held.
                        if is_sure {
                            t_far = t_far.min(ray.shortened((self.test)(held.leaf)));
                            held = Held::NOTHING;
                            if lo > t_far {
                                continue;
                            }
                        }
                        t_far = t_far.min(ray.shortened((self.test)(leaf)));
                        if held.lo > t_far {
                            held = Held::NOTHING;
                        }
                    }
                }
            }
            match stack.pop_before(t_far) {
                Some(next) => child = next,
                None => break,
            }
        }
        if held.lo < f32::INFINITY {
            (self.test)(held.leaf);
        }
    }
}

/// What triangles need to know of a ray: many rays come to none.
#[inline(always)]
fn see<K: Kernel>(kernel: K, tree: &Bvh, line: &Line, ray: &CullRay) -> (Filter, K::Sight) {
    let filter = Filter::new(line, ray, tree.rounded);
    let sight = kernel.sight(&filter);
    (filter, sight)
}

/// A triangle of a block.
#[inline(always)]
fn triangle(kind: u32, block: &Block, lane: usize) -> Leaf {
    Leaf { kind, first: block.slot(lane), count: 1 }
}

struct Any<A, F> {
    trusts: A,
    test: F,
}

impl<A: Fn(Leaf) -> bool, F: FnMut(Leaf) -> bool> Traversal for Any<A, F> {
    type Answer = bool;

    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K, tree: &Bvh, line: &Line, ray: &CullRay) -> bool {
        let lanes = kernel.lanes(ray);
        let mut sight = None;
        let mut stack = Stack::new();
        let mut child = ChildRef::node(0);
        loop {
            while !child.is_leaf() {
                let node = &tree.nodes[child.index()];
                match kernel.descend::<false>(node, &lanes, ray.t_far, &mut stack) {
                    Some(next) => child = next,
                    None => match stack.pop() {
                        Some((next, _)) => child = next,
                        None => return false,
                    },
                }
            }
            match tree.block(child) {
                None => {
                    if (self.test)(tree.leaf(child)) {
                        return true;
                    }
                }
                Some((kind, block)) => {
                    let (filter, sight) = sight.get_or_insert_with(
                        #[inline(always)]
                        || see(kernel, tree, line, ray),
                    );
                    let verdict = kernel.judge(block, filter, sight, ray.t_far);
                    let mut alive = verdict.alive;
                    while alive != 0 {
                        let lane = alive.trailing_zeros() as usize & 7;
                        alive &= alive - 1;
                        let leaf = triangle(kind, block, lane);
                        let is_sure = verdict.sure >> lane & 1 != 0 && (self.trusts)(leaf);
                        if is_sure || (self.test)(leaf) {
                            return true;
                        }
                    }
                }
            }
            match stack.pop() {
                Some((next, _)) => child = next,
                None => return false,
            }
        }
    }
}
