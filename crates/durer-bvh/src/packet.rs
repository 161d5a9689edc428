//! Packet traversal: eight similar rays of a batch traverse the tree with one stack, or sixteen
//! where the lanes suffice.
//!
//! Each ray visits the same leaves in the same order as in a single query: for each ray the
//! decision where to go is made with the arithmetic of a single ray. When one ray of a packet is
//! left, it continues as a single ray.

use crate::batch::{LARGE, One, QueryKind, Rays, each};
use crate::kernels::{Rows, Together};
use crate::node::ChildRef;
use crate::query::{ExactRayData, SearchLimit, TreeQuery};
use crate::ray::PACKET;
use crate::traverse::follow;
use crate::tree::Bvh;
use crate::triangles::{Block, Verdict};
use core::marker::PhantomData;

/// A packet under traversal.
struct Group<'a, K: Together<N>, B, M, const N: usize> {
    kernel: K,
    tree: &'a Bvh,
    rays: &'a mut B,
    /// The number of the first ray.
    first: usize,
    packet: &'a K::Packet,
    /// The limit of each ray. NaN if its search is over: then no comparison with it is true.
    t_far: [f32; N],
    /// The greatest of `t_far` that is a number.
    far: f32,
    /// The limits without NaN, and the triangle that each ray holds.
    reaches: &'a mut [SearchLimit; N],
    aim: PhantomData<M>,
}

/// Traverses the tree with a packet whose first ray has the number `first`.
#[inline(always)]
pub(crate) fn traverse_packet<
    K: Together<N>,
    B: Rays<M::Answer>,
    M: QueryKind<ORDERED>,
    const ORDERED: bool,
    const N: usize,
>(
    kernel: K,
    tree: &Bvh,
    rays: &mut B,
    first: usize,
    packet: &K::Packet,
) {
    let t_far = kernel.ends(packet);
    // Not a member of the group, which is moved: a move right after piecewise stores would stall.
    let mut reaches = [SearchLimit::NOWHERE; N];
    for (reach, &t_far) in reaches.iter_mut().zip(&t_far) {
        reach.t_far = t_far;
    }
    let mut group: Group<'_, K, B, M, N> = Group {
        kernel,
        tree,
        rays,
        first,
        packet,
        t_far,
        far: greatest(&t_far),
        reaches: &mut reaches,
        aim: PhantomData,
    };
    let mut for_triangles = None;
    let is_large = tree.held() > LARGE;
    let mut rows = Rows::new();
    rows.push_if(true, ChildRef::node(0), [f32::NEG_INFINITY; N]);
    while let Some((child, row)) = rows.pop() {
        let awake = kernel.awake(&row, &group.t_far);
        let is_alone = awake & awake.wrapping_sub(1) == 0;
        if !child.is_leaf() && !is_alone {
            let node = &tree.nodes[child.index()];
            let limits = (&group.t_far, group.far);
            let before = rows.len();
            kernel.descend_together::<ORDERED>(node, packet, &row, limits, &mut rows);
            if is_large {
                for at in before..rows.len() {
                    kernel.fetch(tree, rows.child(at));
                }
            }
            continue;
        }
        let block = if child.is_leaf() { tree.block(child) } else { None };
        let Some(of) = block else {
            for ray in each(awake) {
                group.advance(ray, child, None);
            }
            continue;
        };
        let block = &tree.blocks[of.1 as usize];
        let (filters, verdicts) = for_triangles.get_or_insert_with(
            #[inline(always)]
            || (kernel.filters(tree, packet), [Verdict::NOTHING; N]),
        );
        let alive = kernel.judge_together(block, filters, awake, &group.t_far, verdicts);
        for ray in each(alive) {
            group.advance(ray, child, Some((of, block, &verdicts[ray])));
        }
    }
    for (number, eight) in group.reaches.chunks_exact(PACKET).enumerate() {
        let (mut leaves, mut are_any) = ([None; PACKET], false);
        for (leaf, reach) in leaves.iter_mut().zip(eight) {
            *leaf = reach.held.leaf();
            are_any |= leaf.is_some();
        }
        if are_any {
            let first = first + PACKET * number;
            group.rays.last_tests(&[0, 1, 2, 3, 4, 5, 6, 7].map(|i| first + i), &leaves);
        }
    }
}

/// The greatest element that is not NaN.
#[inline(always)]
fn greatest<const N: usize>(t_far: &[f32; N]) -> f32 {
    let pick = |a: f32, b: f32| if b > a { b } else { a };
    let mut most = [f32::NEG_INFINITY; N];
    for (most, &t_far) in most.iter_mut().zip(t_far) {
        // A comparison with NaN is false, so NaN is not picked.
        *most = pick(*most, t_far);
    }
    let mut half = N / 2;
    while half > 0 {
        for i in 0..half {
            most[i] = pick(most[i], most[i + half]);
        }
        half /= 2;
    }
    most[0]
}

impl<K: Together<N>, B, M, const N: usize> Group<'_, K, B, M, N> {
    /// Continues one ray: with the verdict on a block, or else with everything below a child.
    #[inline(always)]
    fn advance<const ORDERED: bool>(
        &mut self,
        ray: usize,
        child: ChildRef,
        judged: Option<((u32, u32), &Block, &Verdict)>,
    ) where
        M: QueryKind<ORDERED>,
        B: Rays<M::Answer>,
    {
        let Self { kernel, tree, packet, .. } = *self;
        let number = self.first + ray;
        let reach = &mut self.reaches[ray];
        let before = reach.t_far;
        let mut quest = M::query(One { rays: self.rays, ray: number });
        let found = if let Some((of, block, verdict)) = judged {
            quest.judged(kernel, &kernel.way(tree, packet, ray), of, block, verdict, reach)
        } else {
            let (ray, way) = kernel.one(tree, packet, ray);
            let lanes = kernel.spread(&ray);
            let mut sieve = ExactRayData { filter: None };
            follow(kernel, tree, &lanes, &way, child, &mut sieve, reach, &mut quest)
        };
        drop(quest);
        let after = reach.t_far;
        if found {
            self.rays.found(number);
            self.shorten(ray, f32::NAN);
        } else if after < before {
            self.shorten(ray, after);
        }
    }

    /// Writes all elements: a vector load right after a store of one element would stall.
    #[inline(always)]
    fn shorten(&mut self, ray: usize, t_far: f32) {
        let mut all = self.t_far;
        for (i, one) in all.iter_mut().enumerate() {
            *one = if i == ray { t_far } else { *one };
        }
        self.t_far = all;
        self.far = greatest(&all);
    }
}
