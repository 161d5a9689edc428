//! Many rays at once: while one waits for memory, or for its own last step, others go on.
//!
//! Each step of a ray through a tree depends on the one before, so that a single ray leaves most of
//! a CPU idle, and all of it while what it needs is not in the cache. Here some rays are under way
//! at a time, each takes one step in turn, and what its next step will read is fetched meanwhile
//! (O. Kocberber, B. Falsafi, B. Grot, "Asynchronous memory access chaining", Proceedings of the
//! VLDB Endowment 9(4), 2015). Whether a step leads to a node or to a leaf nobody can foresee; so
//! first all rays that are at nodes take their step, then all that are at leaves, and no branch
//! depends on it. Each ray takes the very steps that it takes alone.

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

/// How many rays are under way. A word has a bit for each.
const FLIGHTS: usize = 32;

/// A tree of more bytes than this is large.
pub(crate) const LARGE: usize = 1 << 24;

/// Rays by their numbers.
///
/// `R` is what a test says: for the closest hit the parameter beyond which nothing matters any
/// more; for any hit, whether it was one.
pub trait Rays<R> {
    /// A ray as it is asked about.
    type TreeRay: TreeRay;

    /// A ray, asked for once, before its first test; `None` if it is to meet nothing.
    fn sight(&mut self, ray: usize) -> Option<Self::TreeRay>;

    /// Eight rays from this one on as f32 sees them, if they are exactly known and may go through a
    /// tree together: such rays are not asked for their lines.
    fn glances(&mut self, _first: usize) -> Option<Packet32> {
        None
    }

    /// Whether a triangle that a ray certainly meets within its range counts.
    fn admits(&self, ray: usize, triangle: Leaf) -> bool;

    /// Tests what a ray may meet.
    fn test(&mut self, ray: usize, leaf: Leaf) -> R;

    /// The last tests of eight rays: what they say does not matter any more. A ray without a leaf
    /// may be any.
    fn last_tests(&mut self, rays: &[usize; PACKET], leaves: &[Option<Leaf>; PACKET]) {
        for (&ray, leaf) in rays.iter().zip(leaves) {
            if let Some(leaf) = leaf {
                self.test(ray, *leaf);
            }
        }
    }

    /// The ray has found what it looked for, or a triangle that it certainly meets: only of any
    /// hit.
    fn found(&mut self, ray: usize);
}

impl Bvh {
    /// [`Bvh::closest`] of the rays `0..count`, each shown the same, in the same order, as if it
    /// were alone.
    #[inline(always)]
    pub fn closest_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<f64>) {
        self.with_kernel(isa, Many::<_, ForClosest, true> { count, rays, aim: PhantomData });
    }

    /// [`Bvh::any`] of the rays `0..count`, each shown the same, in the same order, as if it were
    /// alone.
    #[inline(always)]
    pub fn any_of_each(&self, isa: Isa, count: usize, rays: &mut impl Rays<bool>) {
        self.with_kernel(isa, Many::<_, ForAny, false> { count, rays, aim: PhantomData });
    }
}

/// What all rays look for.
pub(crate) trait QueryKind<const ORDERED: bool> {
    /// What a test says.
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

/// One of many rays.
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

/// A ray under way.
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

/// The bits that are set.
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
        // Who comes to a node next, to a leaf, and who is over: at first all places.
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

/// Rays that are over, each with a triangle that it still has to ask about.
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

    /// Asks for all.
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

/// The rays that are not yet under way.
struct Queue {
    next: usize,
    count: usize,
    /// Up to here rays go alone.
    alone_until: usize,
    /// For how many rays more that will be so if the next eight cannot go together either.
    patience: usize,
    /// Eight rays that were asked for a glance, by the number of the first, and the eight after
    /// them: nobody is asked twice.
    seen: (usize, Option<Packet32>),
    more: (usize, Option<Packet32>),
}

/// Rays that go alone, at least and at most, before eight are asked again whether they could go
/// together.
const PATIENCE: (usize, usize) = (PACKET, 32 * PACKET);

impl Queue {
    fn of(count: usize) -> Self {
        let nobody = (usize::MAX, None);
        Self { next: 0, count, alone_until: 0, patience: PATIENCE.0, seen: nobody, more: nobody }
    }

    /// Gives a place to the next ray that goes alone and does not certainly miss everything, if
    /// there is one; before that, all go that go together.
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
            // Twice the same, so that compilers do not bring both ways together first and the ray
            // into its place then.
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

    /// Shows the tree to the next rays together, if they are alike: sixteen or eight. Says how
    /// many.
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

/// A ray takes a place that is free, or the next one.
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
        // Where all rays go together none takes a place.
        if flights.is_empty() {
            flights.reserve_exact(FLIGHTS);
        }
        flights.push(Flight { ray, reach, child, number, way, sight, filter: None, stack: Stack::new() });
    }
}

impl<K: Kernel, S: TreeRay> Flight<K, S> {
    /// Looks at a leaf; says to which child to turn.
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
