//! The builder: binned SAH, straight into eight children; near the leaves, [optimal](collapse) ones.
//!
//! Each node of many entries starts as one range and keeps splitting the child with the largest surface until there are eight, by the surface area
//! heuristic over bins (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive
//! Ray Tracing, 2007; I. Wald, C. Benthin, S. Boulos, "Getting rid of packets", same, 2008, for the wide collapse). A leaf holds one
//! kind of thing only, so that it is one call. The result is a function of the entries and their order alone: threads share out
//! subtrees and merge bins by minima, maxima and counts, which do not depend on order.
//!
//! Depth is bounded: from level [`BALANCED_FROM`] on ranges are halved by count.

mod area;
mod bins;
mod collapse;
mod split;

use crate::frame::{Entry, Frame};
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, MAX_ENTRIES, MAX_LEAF, Node8, WIDTH};
use crate::tree::Bvh;
use crate::triangles::{Block, Corners, LANES};
pub(crate) use area::Extent;
pub(crate) use bins::{BINS, Bins, Filled, INTEGERS};
use core::sync::atomic::{AtomicBool, Ordering};
use durer_math::Isa;
use durer_math::kernels::in_large_pages;
use rayon::prelude::*;
use split::Split;

/// What a build weighs. Costs are in units of a node test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How many things a leaf may hold, 1 to 16.
    pub max_leaf: usize,
    /// The cost of one test.
    pub test_cost: f32,
    /// The cost of entering a leaf.
    pub leaf_cost: f32,
}

impl Settings {
    /// Measured on spheres.
    pub const GOOD: Self = Self { max_leaf: 8, test_cost: 1.0, leaf_cost: 1.0 };
}

impl Default for Settings {
    fn default() -> Self {
        Self::GOOD
    }
}

/// What leaves cost, in units of a node test.
#[derive(Clone, Copy)]
struct Costs<'a> {
    max_leaf: usize,
    test: f32,
    leaf: f32,
    shapes: &'a [Option<CornersOf<'a>>],
    isa: Isa,
}

/// The same for one kind of things.
#[derive(Clone, Copy, Debug)]
struct KindCosts {
    /// Two to this power things are tested together, at the cost of one test.
    block: u32,
    test: f32,
    leaf: f32,
}

impl<'a> Costs<'a> {
    fn of(settings: &Settings, shapes: &'a [Option<CornersOf<'a>>]) -> Self {
        let Settings { max_leaf, test_cost, leaf_cost } = *settings;
        let most = if shapes.iter().any(Option::is_some) { LANES } else { MAX_LEAF };
        let isa = Isa::detect();
        Self { max_leaf: max_leaf.clamp(1, most), test: test_cost, leaf: leaf_cost, shapes, isa }
    }

    /// Whether a range can be a leaf.
    fn may_be_leaf(&self, entries: &[Entry]) -> bool {
        entries.len() <= self.max_leaf && split::is_one_kind(entries)
    }

    /// What a range costs, as its first entry tells: mostly all of it is of one kind, and a leaf always is.
    fn of_range(&self, entries: &[Entry]) -> KindCosts {
        let is_triangles = entries.first().is_some_and(|e| self.shapes[e.kind() as usize].is_some());
        if is_triangles {
            // A block costs what it costs, full or not.
            KindCosts { block: LANES.ilog2(), test: self.test, leaf: 0.0 }
        } else {
            KindCosts { block: 0, test: self.test, leaf: self.leaf }
        }
    }
}

impl KindCosts {
    /// The cost of a leaf of `count` things.
    fn of_leaf(&self, count: usize) -> f32 {
        self.leaf + self.test * self.tests(count)
    }

    /// How many tests `count` things take.
    #[inline(always)]
    fn tests(&self, count: usize) -> f32 {
        ((count + (1 << self.block) - 1) >> self.block) as f32
    }
}

/// The corners of the triangle with an index, in the caller's units.
pub type CornersOf<'a> = &'a (dyn Fn(u32) -> Corners + Sync);

/// From this level on ranges are halved by count. Halving reaches single things in `log8(2^27) = 9` levels, and
/// the kinds of a last range of 16 need two more; so no tree is deeper than 35, and [`MAX_DEPTH`] is 40.
const BALANCED_FROM: usize = 24;

const _: () = assert!(LANES.is_power_of_two());

const _: () = assert!(BALANCED_FROM + 9 + 2 < MAX_DEPTH && MAX_ENTRIES == 1 << 27 && MAX_LEAF == 16);

/// Ranges with fewer entries are one thread's.
const PARALLEL: usize = 4096;

/// Nodes over `entries`, which are put into leaf order. The first node is the root. Leaves refer to positions.
fn build(entries: &mut [Entry], costs: &Costs<'_>) -> Grown {
    if entries.is_empty() {
        return Grown { nodes: Vec::new(), below: Vec::new() };
    }
    let whole = Range { first: 0, len: entries.len(), extent: split::extent(entries), closed: false };
    grow(entries, 0, &whole, 0, costs)
}

/// Nodes that are still in several lists: those of a subtree that one thread has made, or one node and those below it.
struct Grown {
    nodes: Vec<Node8>,
    /// In which slot of the one node each of these begins.
    below: Vec<(usize, Self)>,
}

impl Grown {
    /// All of them in one list, as nodes before those below them.
    fn listed(mut self) -> Vec<Node8> {
        if self.below.is_empty() {
            self.nodes.shrink_to_fit();
            return self.nodes;
        }
        let mut nodes = Vec::with_capacity(self.count());
        in_large_pages(&nodes);
        self.append_to(&mut nodes);
        nodes
    }

    fn count(&self) -> usize {
        self.nodes.len() + self.below.iter().map(|(_, grown)| grown.count()).sum::<usize>()
    }

    fn append_to(self, nodes: &mut Vec<Node8>) {
        let this = nodes.len();
        nodes.extend(self.nodes.into_iter().map(|mut node| {
            move_by(&mut node, this);
            node
        }));
        for (slot, grown) in self.below {
            nodes[this].child[slot] = ChildRef::node(nodes.len());
            grown.append_to(nodes);
        }
    }
}

/// A range of entries on its way to becoming a child.
#[derive(Clone, Copy, Debug)]
struct Range {
    /// Counted within the slice of its parent.
    first: usize,
    len: usize,
    extent: Extent,
    /// It is to be a leaf.
    closed: bool,
}

impl Range {
    fn of<'a>(&self, entries: &'a mut [Entry]) -> &'a mut [Entry] {
        &mut entries[self.first..self.first + self.len]
    }
}

/// The node over all of `entries`, and those below it; `base` is the position of the first entry.
fn grow(entries: &mut [Entry], base: usize, whole: &Range, level: usize, costs: &Costs<'_>) -> Grown {
    if whole.len < collapse::COLLAPSED && level < collapse::BALANCED_FROM {
        let mut nodes = Vec::new();
        collapse::subtree(entries, base, &whole.extent, level, costs, &mut nodes);
        nodes.shrink_to_fit();
        return Grown { nodes, below: Vec::new() };
    }
    let mut ranges = [*whole; WIDTH];
    ranges[0].first = 0;
    let mut count = 1;
    while count < WIDTH {
        let open = (0..count).filter(|&i| !ranges[i].closed && ranges[i].len > 1);
        let by_size = |&a: &usize, &b: &usize| {
            let (a, b) = (&ranges[a], &ranges[b]);
            if level < BALANCED_FROM {
                a.extent.half_area().total_cmp(&b.extent.half_area()).then(a.len.cmp(&b.len))
            } else {
                a.len.cmp(&b.len)
            }
        };
        // The first of the largest, as `max_by` would give the last.
        let Some(widest) = open.rev().max_by(by_size) else { break };
        let range = ranges[widest];
        match split(range.of(entries), &range.extent, level, costs) {
            Some(Split { at, left, right }) => {
                ranges[widest] = Range { len: at, extent: left, ..range };
                ranges[count] =
                    Range { first: range.first + at, len: range.len - at, extent: right, closed: false };
                count += 1;
            }
            None => ranges[widest].closed = true,
        }
    }
    let ranges = &mut ranges[..count];
    // Neighbours in space stay neighbours in memory.
    ranges.sort_unstable_by_key(|r| r.first);
    for range in ranges.iter_mut().filter(|r| !r.closed) {
        range.closed = range.len == 1 || split::is_better_as_leaf(range.of(entries), &range.extent, costs);
    }

    let mut node = Node8::EMPTY;
    let mut below = Vec::new();
    let mut rest = entries;
    for (slot, range) in ranges.iter().enumerate() {
        let (mine, tail) = rest.split_at_mut(range.len);
        rest = tail;
        let child = if range.closed {
            ChildRef::leaf(base + range.first, range.len)
        } else {
            below.push((slot, mine, range));
            ChildRef::node(0)
        };
        node.set(slot, range.extent.lo(), range.extent.hi(), child);
    }
    node.sort();
    let subtree = |(slot, mine, range): (usize, &mut [Entry], &Range)| {
        (slot, grow(mine, base + range.first, range, level + 1, costs))
    };
    let below = if whole.len < PARALLEL {
        below.into_iter().map(subtree).collect()
    } else {
        below.into_par_iter().with_max_len(1).map(subtree).collect()
    };
    Grown { nodes: vec![node], below }
}

/// Shifts a node's references to nodes.
fn move_by(node: &mut Node8, offset: usize) {
    for slot in 0..WIDTH {
        if node.is_used(slot) && !node.child[slot].is_leaf() {
            node.child[slot] = ChildRef::node(node.child[slot].index() + offset);
        }
    }
}

/// Splits a range in two; `None` if it is better, and possible, to make it a leaf.
fn split(entries: &mut [Entry], extent: &Extent, level: usize, costs: &Costs<'_>) -> Option<Split> {
    let one_kind = split::is_one_kind(entries);
    let may_be_leaf = one_kind && entries.len() <= costs.max_leaf;
    if level >= BALANCED_FROM {
        return (!may_be_leaf).then(|| split::halve_by_kind(entries));
    }
    let kind = costs.of_range(entries);
    if may_be_leaf && kind.block > 1 {
        // One test does for all of them: parts would cost as much each, and as much memory.
        return None;
    }
    if !one_kind {
        // Where centres coincide kinds part.
        entries.sort_by_key(Entry::kind);
    }
    let best = split::best_plane(entries, &kind, costs.isa);
    if may_be_leaf {
        let leaf = kind.of_leaf(entries.len());
        let whole = extent.half_area();
        // In this node another child costs no other node test.
        let pays = best.as_ref().is_some_and(|b| b.cost(&kind) < leaf * whole);
        if !pays {
            return None;
        }
    }
    match best {
        Some(best) => Some(split::by_plane(entries, &best, costs.isa)),
        None if one_kind => Some(split::halve(entries)),
        None => Some(split::halve_by_kind(entries)),
    }
}

impl Bvh {
    /// Builds a tree over `entries`, all [bounded](Entry::is_bounded) and made by `frame`, of as many kinds as `shapes`
    /// has elements: for a kind of triangles the corners of each, in the caller's units and within its entry's box.
    ///
    /// Also gives, for each kind, the indices of its entries in the order of the leaves: [`Leaf`](crate::Leaf)s
    /// refer to positions in these lists. The tree does not depend on the number of threads.
    ///
    /// # Panics
    ///
    /// If there are more than [`MAX_ENTRIES`] entries.
    pub fn build(
        frame: &Frame,
        mut entries: Vec<Entry>,
        shapes: &[Option<CornersOf<'_>>],
        settings: &Settings,
    ) -> (Self, Vec<Vec<u32>>) {
        assert!(entries.len() <= MAX_ENTRIES, "at most {MAX_ENTRIES} entries, got {}", entries.len());
        let kinds = shapes.len();
        let grown = build(&mut entries, &Costs::of(settings, shapes));
        let mut starts = vec![0_u32; kinds + 1];
        for entry in &entries {
            starts[entry.kind() as usize + 1] += 1;
        }
        let mut order: Vec<Vec<u32>> = starts[1..].iter().map(|&n| Vec::with_capacity(n as usize)).collect();
        order.iter().for_each(in_large_pages);
        for kind in 0..kinds {
            starts[kind + 1] += starts[kind];
        }
        // Positions of all leaves become slots, which are counted kind by kind. Of one kind, they are slots.
        let mut slots = Vec::new();
        if let Some(kind) = (0..kinds).find(|&k| (starts[k + 1] - starts[k]) as usize == entries.len()) {
            order[kind].par_extend(entries.par_iter().map(Entry::index));
        } else {
            slots.reserve_exact(entries.len());
            for entry in &entries {
                let kind = entry.kind() as usize;
                slots.push(starts[kind] + order[kind].len() as u32);
                order[kind].push(entry.index());
            }
        }
        // Before there is a second copy of the nodes.
        drop(entries);
        let mut nodes = grown.listed();
        let place = |position: u32| {
            let slot = slots.get(position as usize).copied().unwrap_or(position);
            let kind = starts[1..].partition_point(|&start| start <= slot);
            (kind, slot - starts[kind])
        };
        let mut tree = Self::assembled(*frame, starts.clone());
        let leaves = leaves_of_triangles(&nodes, place, shapes);
        tree.keep_triangles(&leaves, &order, shapes);
        let mut next: Vec<u32> = tree.kinds.iter().map(|kind| kind.first).collect();
        for node in &mut nodes {
            for slot in 0..WIDTH {
                if !node.is_used(slot) || !node.child[slot].is_leaf() {
                    continue;
                }
                let (first, count) = node.child[slot].slots();
                let (kind, first) = place(first);
                let reference = if shapes[kind].is_some() {
                    next[kind] += 1;
                    next[kind] - 1
                } else {
                    tree.kinds[kind].first + first
                };
                node.child[slot] = ChildRef::leaf(reference as usize, count as usize);
            }
        }
        (tree.with_nodes(nodes), order)
    }

    /// Makes a block of each leaf of triangles, kind by kind, and says where references to leaves lead.
    fn keep_triangles(
        &mut self,
        leaves: &[Vec<(u32, u32)>],
        order: &[Vec<u32>],
        shapes: &[Option<CornersOf<'_>>],
    ) {
        let frame = self.frame;
        self.blocks.reserve_exact(leaves.iter().map(Vec::len).sum());
        in_large_pages(&self.blocks);
        let mut first = 0;
        for (kind, corners) in shapes.iter().enumerate() {
            self.kinds[kind].first = first;
            let Some(corners) = corners else {
                first += order[kind].len() as u32;
                continue;
            };
            let rounded = AtomicBool::new(false);
            let block = |&(first, count): &(u32, u32)| {
                let triangles = order[kind][first as usize..(first + count) as usize].iter();
                let (block, is_held) = Block::new(frame, first, triangles.map(|&index| corners(index)));
                if !is_held {
                    rounded.store(true, Ordering::Relaxed);
                }
                block
            };
            self.kinds[kind].blocks = Some(self.blocks.len() as u32);
            self.blocks.par_extend(leaves[kind].par_iter().map(block));
            self.rounded |= rounded.into_inner();
            first += leaves[kind].len() as u32;
        }
        self.blocks.shrink_to_fit();
        self.is_all_triangles = shapes.len() == 1 && shapes[0].is_some();
    }
}

/// First slot and count of the leaves of each kind of triangles, in the order of the nodes.
fn leaves_of_triangles(
    nodes: &[Node8],
    place: impl Fn(u32) -> (usize, u32),
    shapes: &[Option<CornersOf<'_>>],
) -> Vec<Vec<(u32, u32)>> {
    let mut leaves = vec![Vec::new(); shapes.len()];
    for node in nodes {
        for slot in node.used().filter(|&slot| node.child[slot].is_leaf()) {
            let (first, count) = node.child[slot].slots();
            let (kind, first) = place(first);
            if shapes[kind].is_some() {
                leaves[kind].push((first, count));
            }
        }
    }
    leaves
}
