//! Many rays at once: while one waits for memory, or for its own last step, others go on.
//!
//! Each step of a ray through a tree depends on the one before, so that a single ray leaves most of a CPU idle, and all of it while what
//! it needs is not in the cache. Here some rays are under way at a time, each takes one step in turn, and what its next step will read is fetched
//! meanwhile (O. Kocberber, B. Falsafi, B. Grot, "Asynchronous memory access chaining", Proceedings of the VLDB Endowment 9(4), 2015). Each
//! ray takes the very steps that it takes alone.

use crate::kernels::{Kernel, Stack};
use crate::node::{ChildRef, Leaf};
use crate::quest::{Answers, Any, Closest, Late, Quest, Reach};
use crate::ray::{Glances, Line, PACKET, Way};
use crate::together::together;
use crate::traverse::Errand;
use crate::tree::Bvh;
use crate::triangles::Filter;
use core::marker::PhantomData;
use durer_math::Isa;

/// How many rays are under way in trees that a cache near the CPU holds, and in larger ones, where each step takes longer.
const FLIGHTS: (usize, usize) = (8, 16);

/// A tree of more bytes than this is large.
pub(crate) const LARGE: usize = 1 << 24;

/// Rays by their numbers.
///
/// `R` is what a test says: for the closest hit the parameter beyond which nothing matters any more; for any hit, whether it was one.
pub trait Rays<R> {
    /// The line of a ray, asked for once, before its first test; `None` if it is to meet nothing.
    fn line(&mut self, ray: usize) -> Option<Line>;

    /// Eight rays from this one on as f32 sees them, if they are exactly known and may go through a tree together: such rays are not asked for their lines.
    fn glances(&mut self, _first: usize) -> Option<Glances> {
        None
    }

    /// Whether a triangle that a ray certainly meets within its range counts.
    fn admits(&self, ray: usize, triangle: Leaf) -> bool;

    /// Tests what a ray may meet.
    fn test(&mut self, ray: usize, leaf: Leaf) -> R;

    /// The last tests of eight rays from this one on that went together: what they say does not matter any more.
    fn last_tests(&mut self, first: usize, leaves: &[Option<Leaf>; PACKET]) {
        for (i, leaf) in leaves.iter().enumerate() {
            if let Some(leaf) = leaf {
                self.test(first + i, *leaf);
            }
        }
    }

    /// The ray has found what it looked for, or a triangle that it certainly meets: only of any hit.
    fn found(&mut self, ray: usize);
}

impl Bvh {
    /// [`Bvh::closest`] of the rays `0..count`, each shown the same, in the same order, as if it were alone.
    #[inline(always)]
    pub fn closest_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<f64>) {
        self.with_kernel(isa, Many::<_, ForClosest, true> { count, rays, aim: PhantomData });
    }

    /// [`Bvh::any`] of the rays `0..count`, each shown the same, in the same order, as if it were alone.
    #[inline(always)]
    pub fn any_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<bool>) {
        self.with_kernel(isa, Many::<_, ForAny, false> { count, rays, aim: PhantomData });
    }
}

/// What all rays look for.
pub(crate) trait Aim<const ORDERED: bool> {
    /// What a test says.
    type Said;

    fn quest(one: impl Answers<Self::Said>) -> impl Quest<ORDERED>;
}

struct ForClosest;
struct ForAny;

impl Aim<true> for ForClosest {
    type Said = f64;

    #[inline(always)]
    fn quest(one: impl Answers<f64>) -> impl Quest<true> {
        Closest(one)
    }
}

impl Aim<false> for ForAny {
    type Said = bool;

    #[inline(always)]
    fn quest(one: impl Answers<bool>) -> impl Quest<false> {
        Any(one)
    }
}

/// One of many rays.
pub(crate) struct One<'a, B> {
    pub(crate) rays: &'a mut B,
    pub(crate) ray: usize,
}

impl<R, B: Rays<R>> Answers<R> for One<'_, B> {
    #[inline(always)]
    fn admits(&self, triangle: Leaf) -> bool {
        self.rays.admits(self.ray, triangle)
    }

    #[inline(always)]
    fn test(&mut self, leaf: Leaf) -> R {
        self.rays.test(self.ray, leaf)
    }
}

/// A ray under way.
struct Flight<K: Kernel> {
    number: usize,
    line: Line,
    way: Way,
    lanes: K::Lanes,
    filter: Option<Filter>,
    reach: Reach,
    child: ChildRef,
    stack: Stack,
}

struct Many<'a, B, M, const ORDERED: bool> {
    count: usize,
    rays: &'a mut B,
    aim: PhantomData<M>,
}

impl<B: Rays<M::Said>, M: Aim<ORDERED>, const ORDERED: bool> Errand for Many<'_, B, M, ORDERED> {
    type Answer = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K, tree: &Bvh) {
        let rays = self.rays;
        let mut queue = Queue::of(self.count);
        let most = if tree.held() > LARGE { FLIGHTS.1 } else { FLIGHTS.0 };
        let mut flights: Vec<Flight<K>> = Vec::with_capacity(most.min(self.count));
        while flights.len() < most
            && let Some((number, line, (lanes, way))) = queue.upcoming::<K, B, M, ORDERED>(kernel, tree, rays)
        {
            flights.push(Flight {
                number,
                line,
                way,
                lanes,
                filter: None,
                reach: Reach::of(&way),
                child: ChildRef::node(0),
                stack: Stack::new(),
            });
        }
        let mut at = 0;
        while !flights.is_empty() {
            if at >= flights.len() {
                at = 0;
            }
            let flight = &mut flights[at];
            if !flight.is_over_after_step::<B, M, ORDERED>(kernel, tree, rays) {
                at += 1;
                continue;
            }
            match queue.upcoming::<K, B, M, ORDERED>(kernel, tree, rays) {
                Some((number, line, (lanes, way))) => {
                    (flight.number, flight.line, flight.way) = (number, line, way);
                    flight.lanes = lanes;
                    flight.filter = None;
                    flight.reach = Reach::of(&way);
                    flight.child = ChildRef::node(0);
                    flight.stack.clear();
                    at += 1;
                }
                None => drop(flights.swap_remove(at)),
            }
        }
    }
}

/// The rays that are not yet under way.
struct Queue {
    next: usize,
    count: usize,
    /// Up to here rays go alone.
    alone_until: usize,
    /// For how many rays more that will be so if the next eight cannot go together either.
    patience: usize,
}

/// Rays that go alone, at least and at most, before eight are asked again whether they could go together.
const PATIENCE: (usize, usize) = (PACKET, 32 * PACKET);

impl Queue {
    fn of(count: usize) -> Self {
        Self { next: 0, count, alone_until: 0, patience: PATIENCE.0 }
    }

    /// The next ray that goes alone and does not certainly miss everything; before that, all that go together.
    #[inline(always)]
    fn upcoming<K: Kernel, B: Rays<M::Said>, M: Aim<ORDERED>, const ORDERED: bool>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        rays: &mut B,
    ) -> Option<(usize, Line, (K::Lanes, Way))> {
        while self.next < self.count {
            if self.next >= self.alone_until && self.next + PACKET <= self.count && !tree.is_empty() {
                let first = self.next;
                let went = kernel.apart(
                    #[inline(always)]
                    || {
                        let packet = rays.glances(first).and_then(
                            #[inline(always)]
                            |glances| kernel.gather(tree, &glances),
                        );
                        if let Some(packet) = &packet {
                            together::<K, B, M, ORDERED>(kernel, tree, rays, first, packet);
                        }
                        packet.is_some()
                    },
                );
                if went {
                    self.next += PACKET;
                    self.patience = PATIENCE.0;
                    continue;
                }
                self.alone_until = first + self.patience;
                self.patience = (2 * self.patience).min(PATIENCE.1);
            }
            let number = self.next;
            self.next += 1;
            if let Some(line) = rays.line(number)
                && !tree.is_empty()
                && let Some(ready) = kernel.ready(tree, &line)
            {
                return Some((number, line, ready));
            }
        }
        None
    }
}

impl<K: Kernel> Flight<K> {
    /// Goes through one node, or looks at one leaf; says whether that was all.
    #[inline(always)]
    fn is_over_after_step<B: Rays<M::Said>, M: Aim<ORDERED>, const ORDERED: bool>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        rays: &mut B,
    ) -> bool {
        self.child = if self.child.is_leaf() {
            let before = self.reach.t_far;
            let mut quest = M::quest(One { rays, ray: self.number });
            let mut sieve = Late { sight: &self.line, filter: &mut self.filter };
            let found = quest.leaf(kernel, tree, &self.way, self.child, &mut sieve, &mut self.reach);
            drop(quest);
            if found {
                rays.found(self.number);
                return true;
            }
            if self.reach.t_far < before {
                self.stack.prune(self.reach.t_far);
            }
            self.stack.pop()
        } else {
            let node = &tree.nodes[self.child.index()];
            kernel.descend::<ORDERED>(node, &self.lanes, self.reach.t_far, &mut self.stack)
        };
        if self.child == ChildRef::END {
            M::quest(One { rays, ray: self.number }).end(&self.reach);
            return true;
        }
        kernel.fetch(tree, self.child);
        false
    }
}
