//! The fast build: leaves of neighbours along a space-filling curve, nodes of sixteen leaves, and a
//! tree over the nodes.
//!
//! Entries are sorted by the Morton codes of their centres, kind by kind (C. Lauterbach, M.
//! Garland, S. Sengupta, D. Luebke, D. Manocha, "Fast BVH construction on GPUs", Eurographics,
//! 2009). In each run of [`RUN`] entries dynamic programming chooses the leaves of least cost, and
//! in each run of leaves the nodes. The [tree](super) over these has some fiftieth of the entries
//! of a full build.

use super::area::Extent;
use super::{Costs, Grown};
use crate::frame::Entry;
use crate::node::{ChildRef, MAX_LEAF, Node, WIDTH};
use durer_math::Isa;
use durer_math::kernels::in_large_pages;
use rayon::prelude::*;

/// The number of successive entries among which groups are chosen at a time.
const RUN: usize = 2048;

/// Bits of a code along each axis.
const BITS: u32 = 20;

/// How many bits of the codes are sorted at once, three times; codes that are equal so far are
/// compared.
const DIGIT: u32 = 11;

/// The cost of one more group beside its own tests, in tests of a group of average size.
const ANOTHER: f32 = 0.5;

/// Builds nodes over `entries`, and sorts these along the curve. Leaves refer to positions.
pub(super) fn build(entries: &mut Vec<Entry>, costs: &Costs<'_>) -> Grown {
    sort(entries);
    let leaf_costs = |run: &[Entry]| {
        let kind = costs.of_range(run);
        let mut of_leaf = [0.0; MAX_LEAF + 1];
        for (count, cost) in of_leaf.iter_mut().enumerate().skip(1) {
            *cost = kind.of_leaf(count);
        }
        (kind.most, of_leaf)
    };
    let leaves = grouped(entries, costs.isa, leaf_costs);
    // The cost of a node does not depend on its number of children.
    let node_costs = |_: &[Entry]| (WIDTH, [1.0; MAX_LEAF + 1]);
    let mut lowest = grouped(&leaves, costs.isa, node_costs);
    let above = Costs { max_leaf: 1, leaf: 0.0, shapes: &[None], ..*costs };
    let len = lowest.len();
    let mut nodes = super::build(&mut lowest, len, &above).listed();
    let first = nodes.len();
    for node in &mut nodes {
        for slot in 0..WIDTH {
            if node.is_used(slot) && node.child[slot].is_leaf() {
                node.child[slot] = ChildRef::node(first + node.child[slot].slots().0 as usize);
            }
        }
    }
    let over_leaves = |range: &Entry| {
        let (first, count) = ChildRef(range.index()).slots();
        let mut node = Node::EMPTY;
        for (slot, leaf) in leaves[first as usize..(first + count) as usize].iter().enumerate() {
            node.set(slot, leaf.lo(), leaf.hi(), ChildRef(leaf.index()));
        }
        node.sort();
        node
    };
    nodes.reserve_exact(lowest.len());
    in_large_pages(&nodes);
    nodes.par_extend(lowest.par_iter().map(over_leaves));
    Grown { nodes, below: Vec::new() }
}

/// Sorts entries by kind, then by the codes of their centres.
fn sort(entries: &mut Vec<Entry>) {
    let coded = |(at, entry): (usize, &Entry)| (code(entry), at as u32);
    let mut codes: Vec<(u64, u32)> = entries.par_iter().enumerate().map(coded).collect();
    let mut other = vec![(0, 0); codes.len()];
    let first = 3 * (BITS - DIGIT);
    for digit in 0..3 {
        by_digit(&codes, &mut other, first + DIGIT * digit);
        core::mem::swap(&mut codes, &mut other);
    }
    for same in codes.chunk_by_mut(|a, b| a.0 >> first == b.0 >> first) {
        same.sort_unstable();
    }
    if entries.iter().any(|entry| entry.kind() != entries[0].kind()) {
        codes.sort_by_key(|&(_, at)| entries[at as usize].kind());
    }
    *entries = codes.par_iter().map(|&(_, at)| entries[at as usize]).collect();
}

/// Sorts by [`DIGIT`] bits from `first` on; the sort is stable.
fn by_digit(from: &[(u64, u32)], to: &mut [(u64, u32)], first: u32) {
    let digit = |code: u64| (code >> first) as usize & ((1 << DIGIT) - 1);
    let mut next = vec![0_usize; 1 << DIGIT];
    from.iter().for_each(|&(code, _)| next[digit(code)] += 1);
    let mut before = 0;
    for next in &mut next {
        before += core::mem::replace(next, before);
    }
    for &one in from {
        let next = &mut next[digit(one.0)];
        to[*next] = one;
        *next += 1;
    }
}

/// The Morton code of an entry's centre: the bits of the three coordinates, interleaved.
/// Coordinates of the tree are at most 1.
#[inline]
fn code(entry: &Entry) -> u64 {
    let scale = (1_u32 << (BITS - 2)) as f32;
    let part = |axis: usize| {
        let x = (entry.centre2(axis) + 2.0) * scale;
        spread(u64::from((x as u32).min((1 << BITS) - 1)))
    };
    part(0) << 2 | part(1) << 1 | part(2)
}

/// Inserts two zeros between a number's bits.
#[inline]
fn spread(mut x: u64) -> u64 {
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Groups of neighbours, of one kind each: their boxes, and in place of indices their ranges of
/// positions, as references to leaves. `costs` returns for a run the greatest size of a group, and
/// the cost of groups of each size.
fn grouped(
    entries: &[Entry],
    isa: Isa,
    costs: impl Fn(&[Entry]) -> (usize, [f32; MAX_LEAF + 1]) + Sync,
) -> Vec<Entry> {
    let run = |(number, run): (usize, &[Entry])| {
        let mut first = RUN * number;
        let mut groups = Vec::with_capacity(run.len() / 4);
        for part in run.chunk_by(|a, b| a.kind() == b.kind()) {
            let (most, of_size) = costs(part);
            let chosen = isa.run(
                #[inline(always)]
                || choose(part, most, &of_size),
            );
            for (extent, count) in chosen {
                groups.push(Entry::of_extent(&extent, 0, ChildRef::leaf(first, count).0));
                first += count;
            }
        }
        groups
    };
    let groups: Vec<Vec<Entry>> = entries.par_chunks(RUN).enumerate().map(run).collect();
    groups.concat()
}

/// The groups of least cost of a run, with at most `most` entries each: boxes and counts.
#[inline(always)]
fn choose(run: &[Entry], most: usize, of_size: &[f32; MAX_LEAF + 1]) -> Vec<(Extent, usize)> {
    let (mut sum, mut groups) = (0.0, 0.0);
    for group in run.chunks(most) {
        sum += all(group).half_area();
        groups += 1.0;
    }
    let another = ANOTHER * of_size[most] * sum / groups;
    // The least cost of the entries before each one, and the size of the last group.
    let mut least = [(0.0_f32, 0_usize); RUN + 1];
    for end in 1..=run.len() {
        let (mut extent, mut best) = (Extent::EMPTY, (f32::INFINITY, 1));
        for count in 1..=most.min(end) {
            extent.unite(&Extent::of(&run[end - count]));
            let cost = least[end - count].0 + extent.half_area() * of_size[count] + another;
            if cost < best.0 {
                best = (cost, count);
            }
        }
        least[end] = best;
    }
    let mut chosen = Vec::with_capacity(run.len() / most + 1);
    let mut end = run.len();
    while end > 0 {
        let count = least[end].1;
        chosen.push((all(&run[end - count..end]), count));
        end -= count;
    }
    chosen.reverse();
    chosen
}

#[inline(always)]
fn all(entries: &[Entry]) -> Extent {
    let mut extent = Extent::EMPTY;
    for entry in entries {
        extent.unite(&Extent::of(entry));
    }
    extent
}
