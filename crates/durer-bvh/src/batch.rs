//! Batches of rays: while one ray waits for memory, or for its own last step, others proceed.
//!
//! Each step of a ray through a tree depends on the step before. So a single ray leaves most of a
//! CPU idle, and all of it while the data that it needs are not in the cache. Here several rays are
//! in flight. Each takes one step in turn, and the data of its next step are prefetched meanwhile
//! (O. Kocberber, B. Falsafi, B. Grot, "Asynchronous memory access chaining", Proceedings of the
//! VLDB Endowment 9(4), 2015). Whether a step leads to a node or to a leaf is unpredictable; so
//! first all rays that are at nodes take their step, then all that are at leaves, and no branch
//! depends on it. Each ray takes exactly the steps that it takes in a single query.

use crate::kernels::{Abreast, Kernel, Stack, Together};
use crate::node::{ChildRef, Leaf};
use crate::packet::traverse_packet;
use crate::query::{Any, Closest, LeafTest, QueuedFilter, SearchLimit, TreeQuery};
use crate::ray::{ClippedRay, PACKET, Packet32, TWICE, TreeRay};
use crate::traverse::Traversal;
use crate::tree::Bvh;
use crate::triangles::Filter;
use core::marker::PhantomData;
use durer_math::Isa;

/// The greatest number of rays in flight. A word has a bit for each.
const FLIGHTS: usize = 32;

/// A tree of more bytes than this counts as large.
pub(crate) const LARGE: usize = 1 << 24;

/// A batch of rays, by number.
///
/// `R` is the answer of a test: for closest hits the parameter beyond which nothing matters any
/// more; for any hits, whether there was a hit.
pub trait Rays<R> {
    /// The type of one ray.
    type TreeRay: TreeRay;

    /// A ray. It is called once per ray, before the ray's first test; `None` if the ray is to hit
    /// nothing.
    fn sight(&mut self, ray: usize) -> Option<Self::TreeRay>;

    /// Eight consecutive rays in f32, if they are exactly known and may traverse a tree as a
    /// packet. For such rays `sight` is not called.
    fn glances(&mut self, _first: usize) -> Option<Packet32> {
        None
    }

    /// Whether the query accepts a triangle that the ray certainly hits within its range.
    fn admits(&self, ray: usize, triangle: Leaf) -> bool;

    /// Tests a ray against a leaf that it may hit.
    fn test(&mut self, ray: usize, leaf: Leaf) -> R;

    /// The last tests of eight rays, whose answers are not needed any more. Where there is no leaf,
    /// the ray's number is unused.
    fn last_tests(&mut self, rays: &[usize; PACKET], leaves: &[Option<Leaf>; PACKET]) {
        for (&ray, leaf) in rays.iter().zip(leaves) {
            if let Some(leaf) = leaf {
                self.test(ray, *leaf);
            }
        }
    }

    /// For any-hit queries only: the ray has hit something, or certainly hits a triangle.
    fn found(&mut self, ray: usize);
}

impl Bvh {
    /// [`Bvh::closest`] for the rays `0..count`. Each ray gets the same calls in the same order as
    /// in a single query.
    #[inline(always)]
    pub fn closest_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<f64>) {
        self.with_kernel(isa, Many::<_, ForClosest, true> { count, rays, aim: PhantomData });
    }

    /// [`Bvh::any`] for the rays `0..count`. Each ray gets the same calls in the same order as in a
    /// single query.
    #[inline(always)]
    pub fn any_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<bool>) {
        self.with_kernel(isa, Many::<_, ForAny, false> { count, rays, aim: PhantomData });
    }
}

/// The query that all rays of a batch make.
pub(crate) trait QueryKind<const ORDERED: bool> {
    /// The answer of a test.
    type Answer;

    fn query(one: impl LeafTest<Self::Answer>) -> impl TreeQuery<ORDERED>;
}

struct ForClosest;
struct ForAny;

impl QueryKind<true> for ForClosest {
    type Answer = f64;

    #[inline(always)]
    fn query(one: impl LeafTest<f64>) -> impl TreeQuery<true> {
        Closest(one)
    }
}

impl QueryKind<false> for ForAny {
    type Answer = bool;

    #[inline(always)]
    fn query(one: impl LeafTest<bool>) -> impl TreeQuery<false> {
        Any(one)
    }
}

/// One ray of a batch.
pub(crate) struct One<'a, B> {
    pub(crate) rays: &'a mut B,
    pub(crate) ray: usize,
}

impl<R, B: Rays<R>> LeafTest<R> for One<'_, B> {
    #[inline(always)]
    fn admits(&self, triangle: Leaf) -> bool {
        self.rays.admits(self.ray, triangle)
    }

    #[inline(always)]
    fn test(&mut self, leaf: Leaf) -> R {
        self.rays.test(self.ray, leaf)
    }
}

/// A ray in flight.
struct Flight<K: Kernel, S> {
    ray: K::Ray,
    reach: SearchLimit,
    child: ChildRef,
    number: usize,
    way: ClippedRay,
    sight: S,
    filter: Option<Filter>,
    stack: Stack,
}

struct Many<'a, B, M, const ORDERED: bool> {
    count: usize,
    rays: &'a mut B,
    aim: PhantomData<M>,
}

/// The positions of the bits that are set.
#[inline(always)]
pub(crate) fn each(mut bits: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(
        #[inline(always)]
        move || {
            let bit = bits.trailing_zeros();
            bits &= bits.wrapping_sub(1);
            (bit < u32::BITS).then_some(bit as usize)
        },
    )
}

impl<B: Rays<M::Answer>, M: QueryKind<ORDERED>, const ORDERED: bool> Traversal for Many<'_, B, M, ORDERED> {
    type Answer = ();

    #[inline(always)]
    fn run<K: Abreast>(self, kernel: K, tree: &Bvh) {
        let rays = self.rays;
        let mut queue = Queue::of(self.count);
        let most = FLIGHTS.min(self.count);
        let mut flights: Vec<Flight<K, B::TreeRay>> = Vec::new();
        let mut last = Last { rays: [0; PACKET], leaves: [None; PACKET], count: 0 };
        // Bit sets: flights that are at a node, at a leaf, and finished. At first all count as
        // finished.
        let (mut at_nodes, mut at_leaves, mut over) = (0_u32, 0_u32, ((1_u64 << most) - 1) as u32);
        loop {
            for place in each(over) {
                if let Some(flight) = flights.get(place)
                    && let Some(leaf) = flight.reach.held.leaf()
                {
                    last.add(flight.number, leaf);
                    if last.count == PACKET {
                        last.test(kernel, rays);
                    }
                }
                let is_under_way =
                    queue.upcoming::<K, B, M, ORDERED>(kernel, tree, rays, &mut flights, place);
                at_nodes |= u32::from(is_under_way) << place;
            }
            if at_nodes | at_leaves == 0 {
                last.test(kernel, rays);
                return;
            }
            over = 0;
            let (flights, nodes) = (flights.as_mut_slice(), tree.nodes.as_slice());
            for place in each(at_nodes) {
                let flight = &mut flights[place];
                let node = &nodes[flight.child.index()];
                let lanes = kernel.spread(&flight.ray);
                let child = kernel.descend::<ORDERED>(node, &lanes, flight.reach.t_far, &mut flight.stack);
                flight.child = child;
                kernel.fetch(tree, child);
                at_leaves |= u32::from(child.is_leaf()) << place;
                over |= u32::from(child == ChildRef::END) << place;
            }
            at_nodes &= !at_leaves;
            for place in each(at_leaves & !over) {
                let flight = &mut flights[place];
                let child = flight.look::<B, M, ORDERED>(kernel, tree, rays);
                flight.child = child;
                kernel.fetch(tree, child);
                at_nodes |= u32::from(!child.is_leaf()) << place;
                over |= u32::from(child == ChildRef::END) << place;
            }
            at_leaves &= !(at_nodes | over);
        }
    }
}

/// Rays that are finished but for one last exact test of the triangle that they hold.
struct Last {
    rays: [usize; PACKET],
    leaves: [Option<Leaf>; PACKET],
    count: usize,
}

impl Last {
    #[inline(always)]
    fn add(&mut self, ray: usize, leaf: Leaf) {
        (self.rays[self.count % PACKET], self.leaves[self.count % PACKET]) = (ray, Some(leaf));
        self.count += 1;
    }

    /// Makes all last tests.
    #[inline(always)]
    fn test<R>(&mut self, kernel: impl Kernel, rays: &mut impl Rays<R>) {
        if self.count > 0 {
            kernel.apart(
                #[inline(always)]
                || rays.last_tests(&self.rays, &self.leaves),
            );
            (self.leaves, self.count) = ([None; PACKET], 0);
        }
    }
}

/// The rays that have not started.
struct Queue {
    next: usize,
    count: usize,
    /// Rays before this one go singly.
    alone_until: usize,
    /// How many more rays go singly if the next eight do not form a packet either.
    patience: usize,
    /// Results of `glances` with the number of their first ray, for the next eight rays and the
    /// eight after them, so that it is called once for each.
    seen: (usize, Option<Packet32>),
    more: (usize, Option<Packet32>),
}

/// The least and the greatest number of rays that go singly before the next try to form a packet.
const PATIENCE: (usize, usize) = (PACKET, 32 * PACKET);

impl Queue {
    fn of(count: usize) -> Self {
        let nobody = (usize::MAX, None);
        Self { next: 0, count, alone_until: 0, patience: PATIENCE.0, seen: nobody, more: nobody }
    }

    /// Traverses the packets that come next, then starts the next single ray that may hit
    /// something, at `place`. Returns whether there was one.
    #[inline(always)]
    fn upcoming<K: Abreast, B: Rays<M::Answer>, M: QueryKind<ORDERED>, const ORDERED: bool>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        rays: &mut B,
        flights: &mut Vec<Flight<K, B::TreeRay>>,
        place: usize,
    ) -> bool {
        while self.next < self.count {
            if self.next >= self.alone_until && self.next + PACKET <= self.count && !tree.is_empty() {
                let went = kernel.apart(
                    #[inline(always)]
                    || self.go_together::<K, B, M, ORDERED>(kernel, tree, rays),
                );
                if went > 0 {
                    self.next += went;
                    self.patience = PATIENCE.0;
                    continue;
                }
                self.alone_until = self.next + self.patience;
                self.patience = (2 * self.patience).min(PATIENCE.1);
            }
            let number = self.next;
            self.next += 1;
            let Some(sight) = rays.sight(number) else { continue };
            if tree.is_empty() {
                continue;
            }
            // The call of `seat` occurs twice, so that the compiler does not merge both results
            // into a temporary and copy that.
            if let Some(ready) = kernel.nearby(tree, &sight) {
                seat(flights, place, number, sight, ready);
                return true;
            }
            if let Some(ready) = kernel.afar(tree, &sight) {
                seat(flights, place, number, sight, ready);
                return true;
            }
        }
        false
    }

    /// Traverses the tree with the next sixteen or eight rays as a packet, if they are similar.
    /// Returns how many rays that were.
    #[inline(always)]
    fn go_together<K: Abreast, B: Rays<M::Answer>, M: QueryKind<ORDERED>, const ORDERED: bool>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        rays: &mut B,
    ) -> usize {
        let first = self.next;
        let next = first + PACKET;
        let may_be_more = <K as Together<TWICE>>::EXISTS && next + PACKET <= self.count;
        if self.seen.0 != first {
            self.seen.1 = rays.glances(first);
        }
        self.more.0 = usize::MAX;
        if may_be_more && self.seen.1.is_some() {
            self.more = (next, rays.glances(next));
        }
        let (eight, more) = (&self.seen.1, &self.more.1);
        let went = match (eight, more) {
            (Some(eight), Some(more)) if self.more.0 == next => kernel.apart_in_lanes(
                #[inline(always)]
                || {
                    let packet = Together::<TWICE>::gather(kernel, tree, &[eight, more]);
                    if let Some(packet) = &packet {
                        traverse_packet::<K, B, M, ORDERED, TWICE>(kernel, tree, rays, first, packet);
                    }
                    if packet.is_some() { TWICE } else { 0 }
                },
            ),
            _ => 0,
        };
        if went > 0 {
            return went;
        }
        let went = match eight {
            Some(eight) => kernel.apart_in_lanes(
                #[inline(always)]
                || {
                    let packet = Together::<PACKET>::gather(kernel, tree, &[eight]);
                    if let Some(packet) = &packet {
                        traverse_packet::<K, B, M, ORDERED, PACKET>(kernel, tree, rays, first, packet);
                    }
                    if packet.is_some() { PACKET } else { 0 }
                },
            ),
            None => 0,
        };
        core::mem::swap(&mut self.seen, &mut self.more);
        went
    }
}

/// Starts a ray: puts it at `place`, which is free or the end of the list.
#[inline(always)]
fn seat<K: Kernel, S>(
    flights: &mut Vec<Flight<K, S>>,
    place: usize,
    number: usize,
    sight: S,
    (ray, way): (K::Ray, ClippedRay),
) {
    let (reach, child) = (SearchLimit::of(&way), ChildRef::node(0));
    if let Some(flight) = flights.get_mut(place) {
        flight.ray = ray;
        flight.way = way;
        flight.number = number;
        flight.sight = sight;
        flight.reach = reach;
        flight.child = child;
        flight.filter = None;
        flight.stack.clear();
    } else {
        // Allocated late: if all rays go in packets, nothing is needed.
        if flights.is_empty() {
            flights.reserve_exact(FLIGHTS);
        }
        flights.push(Flight { ray, reach, child, number, way, sight, filter: None, stack: Stack::new() });
    }
}

impl<K: Kernel, S: TreeRay> Flight<K, S> {
    /// Tests a leaf; returns the next child to visit.
    #[inline(always)]
    fn look<B: Rays<M::Answer>, M: QueryKind<ORDERED>, const ORDERED: bool>(
        &mut self,
        kernel: K,
        tree: &Bvh,
        rays: &mut B,
    ) -> ChildRef {
        let before = self.reach.t_far;
        let mut quest = M::query(One { rays, ray: self.number });
        let mut sieve = QueuedFilter { sight: &self.sight, filter: &mut self.filter };
        let found = quest.leaf(kernel, tree, &self.way, self.child, &mut sieve, &mut self.reach);
        drop(quest);
        if found {
            rays.found(self.number);
            return ChildRef::END;
        }
        if self.reach.t_far < before {
            self.stack.prune(self.reach.t_far);
        }
        self.stack.pop()
    }
}
