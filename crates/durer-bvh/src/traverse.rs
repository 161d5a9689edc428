//! Which leaves might a ray meet?

use crate::kernels::{Kernel, Scalar, Stack};
use crate::node::{ChildRef, Leaf};
use crate::ray::{CullRay, Line, Rounding};
use crate::tree::Bvh;
use durer_math::kernels::Path;
use durer_math::{Isa, Point3, Vec3};

/// What is done with a ray, for any kernel.
trait Traversal {
    type Answer;
    fn run<K: Kernel>(self, kernel: K, tree: &Bvh, ray: &CullRay) -> Self::Answer;
}

impl Bvh {
    /// Shows the leaves that the ray might meet to `test`, front to back as far as the order of octants tells; `test` returns the parameter
    /// beyond which nothing matters any more.
    ///
    /// Every leaf in whose box the exact ray is at some `t` in its range, not beyond the least limit so far, is shown.
    #[inline(always)]
    pub fn closest(&self, isa: Isa, line: &Line, test: impl FnMut(Leaf) -> f64) {
        self.with_kernel(isa, line, Closest(test));
    }

    /// Shows the leaves that the ray might meet to `test`, until it says that it has found what it looked for; says whether it did.
    ///
    /// Every leaf in whose box the exact ray is at some `t` in its range is shown, in no particular order.
    #[inline(always)]
    pub fn any(&self, isa: Isa, line: &Line, test: impl FnMut(Leaf) -> bool) -> bool {
        self.with_kernel(isa, line, Any(test)).unwrap_or(false)
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
                || {
                    let ray = self.cull(line, Rounding::Fused)?;
                    Some(traversal.run(kernel, self, &ray))
                },
            );
        }
        if isa.path() == Path::Unfused {
            let ray = self.cull(line, Rounding::Unfused)?;
            return Some(traversal.run(Scalar::<false>, self, &ray));
        }
        let ray = self.cull(line, Rounding::Fused)?;
        Some(traversal.run(Scalar::<true>, self, &ray))
    }
}

struct Closest<F>(F);

impl<F: FnMut(Leaf) -> f64> Traversal for Closest<F> {
    type Answer = ();

    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K, tree: &Bvh, ray: &CullRay) {
        let lanes = kernel.lanes(ray);
        let mut stack = Stack::new();
        let mut t_far = ray.t_far;
        let mut child = ChildRef::node(0);
        loop {
            if child.is_leaf() {
                t_far = t_far.min(ray.shortened((self.0)(tree.leaf(child))));
            } else {
                kernel.push_ordered(&tree.nodes[child.index()], &lanes, t_far, &mut stack);
            }
            child = loop {
                match stack.pop() {
                    None => return,
                    Some((child, near)) if near <= t_far => break child,
                    Some(_) => {}
                }
            };
        }
    }
}

struct Any<F>(F);

impl<F: FnMut(Leaf) -> bool> Traversal for Any<F> {
    type Answer = bool;

    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K, tree: &Bvh, ray: &CullRay) -> bool {
        let lanes = kernel.lanes(ray);
        let mut stack = Stack::new();
        let mut child = ChildRef::node(0);
        loop {
            if child.is_leaf() {
                if (self.0)(tree.leaf(child)) {
                    return true;
                }
            } else {
                kernel.push_unordered(&tree.nodes[child.index()], &lanes, ray.t_far, &mut stack);
            }
            match stack.pop() {
                None => return false,
                Some((next, _)) => child = next,
            }
        }
    }
}
