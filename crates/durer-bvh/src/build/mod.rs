//! The builder: binned SAH, straight into sixteen children; near the leaves, [optimal](collapse)
//! ones.
//!
//! Each node of many entries starts as one range and keeps splitting the child with the largest
//! surface until there are sixteen, by the surface area heuristic over bins (I. Wald, "On fast
//! construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive Ray
//! Tracing, 2007; I. Wald, C. Benthin, S. Boulos, "Getting rid of packets", same, 2008, for the
//! wide collapse). A leaf holds one kind of thing only, so that it is one call. The result is a
//! function of the entries and their order alone: threads share out subtrees and merge bins by
//! minima, maxima and counts, which do not depend on order.
//!
//! That is [`Quality::Good`]. [`Quality::Fast`] makes leaves of [neighbours along a curve](curve)
//! and a tree over these; [`Quality::Best`] also cuts triangles [in space](spatial), so that some
//! [stand in several leaves](shared).
//!
//! Depth is bounded: from level [`BALANCED_FROM`] on ranges are halved by count.

mod area;
mod bins;
mod collapse;
mod curve;
mod shared;
pub(crate) mod spatial;
mod split;

use crate::frame::{Entry, Frame};
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, MAX_ENTRIES, MAX_LEAF, Node, WIDTH};
use crate::tree::Bvh;
use crate::triangles::{Block, Corners, LANES};
pub(crate) use area::Extent;
pub(crate) use bins::{BINS, Bins, Filled, INTEGERS};
use core::sync::atomic::{AtomicBool, Ordering};
use durer_math::Isa;
use durer_math::kernels::in_large_pages;
use rayon::prelude::*;
use shared::{Arranged, Placed, Slots};
use split::Split;

/// How much work a tree is worth. Answers do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Built in a fraction of the time; rays take longer.
    Fast,
    /// The surface area heuristic at each step.
    #[default]
    Good,
    /// Triangles may stand in several leaves, a quarter more than there are at most: for scenes
    /// that are built once, with triangles that are large beside others.
    Best,
}

/// What a build weighs. Costs are in units of a node test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How much work the tree is worth.
    pub quality: Quality,
    /// How many things a leaf may hold, 1 to 16; triangles go by the sixteen that are tested
    /// together.
    pub max_leaf: usize,
    /// The cost of one test.
    pub test_cost: f32,
    /// The cost of entering a leaf.
    pub leaf_cost: f32,
}

impl Settings {
    /// Measured on spheres.
    pub const GOOD: Self = Self { quality: Quality::Good, max_leaf: 8, test_cost: 1.0, leaf_cost: 1.0 };

    /// A tree soon.
    pub const FAST: Self = Self { quality: Quality::Fast, ..Self::GOOD };

    /// Rays fast.
    pub const BEST: Self = Self { quality: Quality::Best, ..Self::GOOD };
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
    frame: Frame,
    isa: Isa,
}

/// The same for one kind of things.
#[derive(Clone, Copy, Debug)]
struct KindCosts {
    /// Two to this power things are tested together, at the cost of one test.
    block: u32,
    /// How many a leaf may hold.
    most: usize,
    test: f32,
    leaf: f32,
}

impl<'a> Costs<'a> {
    fn of(settings: &Settings, frame: Frame, shapes: &'a [Option<CornersOf<'a>>]) -> Self {
        let Settings { max_leaf, test_cost, leaf_cost, .. } = *settings;
        let isa = Isa::detect();
        let max_leaf = max_leaf.clamp(1, MAX_LEAF);
        Self { max_leaf, test: test_cost, leaf: leaf_cost, shapes, frame, isa }
    }

    /// The triangle of an entry in the tree's units, if it is one and that loses nothing.
    fn scaled(&self, entry: &Entry) -> Option<spatial::Scaled> {
        let corners = self.shapes[entry.kind() as usize]?;
        spatial::scaled(self.frame, &corners(entry.index()))
    }

    /// Whether a range can be a leaf.
    fn may_be_leaf(&self, entries: &[Entry]) -> bool {
        entries.len() <= self.of_range(entries).most && split::is_one_kind(entries)
    }

    /// What a range costs, as its first entry tells: mostly all of it is of one kind, and a leaf
    /// always is.
    fn of_range(&self, entries: &[Entry]) -> KindCosts {
        let is_triangles = entries.first().is_some_and(|e| self.shapes[e.kind() as usize].is_some());
        if is_triangles {
            // A block costs what it costs, full or not.
            KindCosts { block: LANES.ilog2(), most: LANES, test: self.test, leaf: 0.0 }
        } else {
            KindCosts { block: 0, most: self.max_leaf, test: self.test, leaf: self.leaf }
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

/// From this level on ranges are halved by count. Halving reaches single things in
/// `log16(2^27) < 7` levels, and the kinds of a last range of 16 need two more; so no tree is
/// deeper than 33, with nodes made along a [curve] below it than 34, and [`MAX_DEPTH`] is 40.
const BALANCED_FROM: usize = 24;

const _: () = assert!(LANES.is_power_of_two() && LANES <= MAX_LEAF);

const _: () = assert!(BALANCED_FROM + 7 + 2 + 1 < MAX_DEPTH && MAX_ENTRIES == 1 << 27 && MAX_LEAF == 16);

/// Ranges with fewer entries are one thread's.
const PARALLEL: usize = 4096;

/// Nodes over the first `len` of `entries`, which are put into leaf order; the others are room. The
/// first node is the root. Leaves refer to positions.
fn build(entries: &mut [Entry], len: usize, costs: &Costs<'_>) -> Grown {
    if len == 0 {
        return Grown { nodes: Vec::new(), below: Vec::new() };
    }
    let extent = split::extent(&entries[..len]);
    let whole = Range { first: 0, len, room: entries.len() - len, extent, closed: false };
    grow(entries, 0, &whole, 0, costs)
}

/// Nodes that are still in several lists: those of a subtree that one thread has made, or one node
/// and those below it.
struct Grown {
    nodes: Vec<Node>,
    /// In which slot of the one node each of these begins.
    below: Vec<(usize, Self)>,
}

impl Grown {
    /// All of them in one list, as nodes before those below them.
    fn listed(mut self) -> Vec<Node> {
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

    fn append_to(self, nodes: &mut Vec<Node>) {
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
    /// How many entries there may be behind these.
    room: usize,
    extent: Extent,
    /// It is to be a leaf.
    closed: bool,
}

impl Range {
    /// Its entries, and its room.
    fn of<'a>(&self, entries: &'a mut [Entry]) -> &'a mut [Entry] {
        &mut entries[self.first..self.first + self.len + self.room]
    }

    fn held<'a>(&self, entries: &'a [Entry]) -> &'a [Entry] {
        &entries[self.first..self.first + self.len]
    }
}

/// A range cut in two: the second half begins behind the room of the first.
struct Divided {
    left: Half,
    right: Half,
}

#[derive(Clone, Copy)]
struct Half {
    len: usize,
    room: usize,
    extent: Extent,
}

impl Divided {
    /// Halves with their shares of some room: by number and surface, as what a cut in space may
    /// gain grows with both.
    fn sharing(room: usize, left: (usize, Extent), right: (usize, Extent)) -> Self {
        let weight = |(len, extent): &(usize, Extent)| f64::from(extent.half_area()) * *len as f64;
        let (a, b) = (weight(&left), weight(&right));
        let share = a / (a + b);
        let first = if share.is_finite() { (room as f64 * share) as usize } else { room / 2 }.min(room);
        let half = |(len, extent): (usize, Extent), room: usize| Half { len, room, extent };
        Self { left: half(left, first), right: half(right, room - first) }
    }

    /// Gives both halves of the first `len` entries their shares of the room behind them; what may
    /// be a leaf after all stays together.
    fn of(entries: &mut [Entry], len: usize, may_be_leaf: bool, Split { at, left, right }: Split) -> Self {
        let room = entries.len() - len;
        if may_be_leaf {
            return Self {
                left: Half { len: at, room: 0, extent: left },
                right: Half { len: len - at, room, extent: right },
            };
        }
        let divided = Self::sharing(room, (at, left), (len - at, right));
        // As many of the second half as have to go move to its other end.
        let moved = divided.left.room.min(len - at);
        entries.copy_within(at..at + moved, len + divided.left.room - moved);
        divided
    }
}

/// The node over all of `entries`, and those below it; `base` is the position of the first entry.
fn grow(entries: &mut [Entry], base: usize, whole: &Range, level: usize, costs: &Costs<'_>) -> Grown {
    if whole.len + whole.room < collapse::COLLAPSED && level < collapse::BALANCED_FROM {
        let mut nodes = Vec::new();
        collapse::subtree(entries, base, whole, level, costs, &mut nodes);
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
        match split(range.of(entries), range.len, &range.extent, level, costs) {
            Some(Divided { left, right }) => {
                ranges[widest] = Range { len: left.len, room: left.room, extent: left.extent, ..range };
                let (first, Half { len, room, extent }) = (range.first + left.len + left.room, right);
                ranges[count] = Range { first, len, room, extent, closed: false };
                count += 1;
            }
            None => ranges[widest].closed = true,
        }
    }
    let ranges = &mut ranges[..count];
    // Neighbours in space stay neighbours in memory.
    ranges.sort_unstable_by_key(|r| r.first);
    for range in ranges.iter_mut().filter(|r| !r.closed) {
        range.closed = range.len == 1 || split::is_better_as_leaf(range.held(entries), &range.extent, costs);
    }

    let mut node = Node::EMPTY;
    let mut below = Vec::new();
    let mut rest = entries;
    for (slot, range) in ranges.iter().enumerate() {
        let (mine, tail) = rest.split_at_mut(range.len + range.room);
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
fn move_by(node: &mut Node, offset: usize) {
    for slot in 0..WIDTH {
        if node.is_used(slot) && !node.child[slot].is_leaf() {
            node.child[slot] = ChildRef::node(node.child[slot].index() + offset);
        }
    }
}

/// Splits the first `len` entries in two; `None` if it is better, and possible, to make them a
/// leaf.
fn split(
    entries: &mut [Entry],
    len: usize,
    extent: &Extent,
    level: usize,
    costs: &Costs<'_>,
) -> Option<Divided> {
    let held = &mut entries[..len];
    let one_kind = split::is_one_kind(held);
    let kind = costs.of_range(held);
    let may_be_leaf = one_kind && len <= kind.most;
    if level >= BALANCED_FROM {
        if may_be_leaf {
            return None;
        }
        let halves = split::halve_by_kind(held);
        return Some(Divided::of(entries, len, false, halves));
    }
    if may_be_leaf && kind.block > 1 {
        // One test does for all of them: parts would cost as much each, and as much memory.
        return None;
    }
    if !one_kind {
        // Where centres coincide kinds part.
        held.sort_by_key(Entry::kind);
    }
    let best = split::best_plane(held, &kind, costs.isa);
    if may_be_leaf {
        let leaf = kind.of_leaf(len);
        let whole = extent.half_area();
        // In this node another child costs no other node test.
        let pays = best.as_ref().is_some_and(|b| b.cost(&kind) < leaf * whole);
        if !pays {
            return None;
        }
    }
    if let Some(divided) = spatial::divide(entries, len, extent, best.as_ref(), (&kind, costs)) {
        return Some(divided);
    }
    let held = &mut entries[..len];
    let halves = match best {
        Some(best) => split::by_plane(held, &best, costs.isa),
        None if one_kind => split::halve(held),
        None => split::halve_by_kind(held),
    };
    Some(Divided::of(entries, len, may_be_leaf, halves))
}

impl Bvh {
    /// Builds a tree over `entries`, all [bounded](Entry::is_bounded) and made by `frame`, of as
    /// many kinds as `shapes` has elements: for a kind of triangles the corners of each, in the
    /// caller's units and within its entry's box.
    ///
    /// Also gives, for each kind, the indices of its entries in the order of the leaves:
    /// [`Leaf`](crate::Leaf)s refer to positions in these lists. The tree does not depend on the
    /// number of threads.
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
        let (costs, kinds, len) = (Costs::of(settings, *frame, shapes), shapes.len(), entries.len());
        let by_position = |entries: Vec<Entry>, grown: Grown| {
            let slots = Slots::of(&entries, kinds);
            // Before there is a second copy of the nodes.
            drop(entries);
            let nodes = grown.listed();
            let arranged = Arranged::by_position(&nodes, slots);
            (nodes, arranged)
        };
        let (nodes, arranged) = match settings.quality {
            Quality::Fast => {
                let grown = curve::build(&mut entries, &costs);
                by_position(entries, grown)
            }
            Quality::Good => {
                let grown = build(&mut entries, len, &costs);
                by_position(entries, grown)
            }
            Quality::Best => {
                let room = (len / spatial::BUDGET).min(MAX_ENTRIES - len);
                if let Some(&filler) = entries.first() {
                    entries.resize(len + room, filler);
                }
                let nodes = build(&mut entries, len, &costs).listed();
                let arranged = Arranged::sharing(&nodes, &entries, kinds);
                (nodes, arranged)
            }
        };
        Self::of_nodes(*frame, nodes, arranged, shapes)
    }

    /// The tree of these nodes, whose leaves stand in the order of `arranged`.
    fn of_nodes(
        frame: Frame,
        mut nodes: Vec<Node>,
        arranged: Arranged,
        shapes: &[Option<CornersOf<'_>>],
    ) -> (Self, Vec<Vec<u32>>) {
        let mut tree = Self::assembled(frame, arranged.starts());
        tree.keep_triangles(&arranged, shapes);
        let mut next: Vec<u32> = tree.kinds.iter().map(|kind| kind.first).collect();
        let mut leaves = arranged.leaves.iter();
        for node in &mut nodes {
            for slot in 0..WIDTH {
                if !node.is_used(slot) || !node.child[slot].is_leaf() {
                    continue;
                }
                let Some(&Placed { kind, first, count }) = leaves.next() else { break };
                let kind = kind as usize;
                let reference = if shapes[kind].is_some() {
                    next[kind] += 1;
                    next[kind] - 1
                } else {
                    tree.kinds[kind].first + first
                };
                node.child[slot] = ChildRef::leaf(reference as usize, count as usize);
            }
        }
        if let Some(listed) = arranged.listed {
            tree.share(&nodes, &listed);
        }
        (tree.with_nodes(nodes), arranged.order)
    }

    /// Makes a block of each leaf of triangles, kind by kind, and says where references to leaves
    /// lead.
    fn keep_triangles(&mut self, arranged: &Arranged, shapes: &[Option<CornersOf<'_>>]) {
        let frame = self.frame;
        let is_block = |leaf: &&Placed| shapes[leaf.kind as usize].is_some();
        self.blocks.reserve_exact(arranged.leaves.iter().filter(is_block).count());
        in_large_pages(&self.blocks);
        let mut first = 0;
        for (kind, corners) in shapes.iter().enumerate() {
            self.kinds[kind].first = first;
            let order = &arranged.order[kind];
            let Some(corners) = corners else {
                first += order.len() as u32;
                continue;
            };
            let rounded = AtomicBool::new(false);
            let listed = arranged.listed.as_ref().map(|listed| &listed.slots[kind]);
            let block = |&Placed { first, count, .. }: &Placed| {
                let slots = (first..first + count).map(|at| listed.map_or(at, |slots| slots[at as usize]));
                let (block, is_held) =
                    Block::new(frame, slots.map(|slot| (slot, corners(order[slot as usize]))));
                if !is_held {
                    rounded.store(true, Ordering::Relaxed);
                }
                block
            };
            let leaves: Vec<Placed> =
                arranged.leaves.iter().filter(|leaf| leaf.kind as usize == kind).copied().collect();
            self.kinds[kind].blocks = Some(self.blocks.len() as u32);
            self.blocks.par_extend(leaves.par_iter().map(block));
            self.rounded |= rounded.into_inner();
            first += leaves.len() as u32;
        }
        self.blocks.shrink_to_fit();
        self.is_all_triangles = shapes.len() == 1 && shapes[0].is_some();
    }
}
