//! The builder: binned SAH, straight into eight children.
//!
//! Each node starts as one range and keeps splitting the child with the largest surface until there are eight, by the surface area
//! heuristic over bins (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive
//! Ray Tracing, 2007; I. Wald, C. Benthin, S. Boulos, "Getting rid of packets", same, 2008, for the wide collapse). A leaf holds one
//! kind of thing only, so that it is one call. The result is a function of the entries and their order alone: threads share out
//! subtrees and merge bins by minima, maxima and counts, which do not depend on order.
//!
//! Depth is bounded: from level [`BALANCED_FROM`] on ranges are halved by count.

mod area;
mod split;

use crate::frame::{Entry, Frame};
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, MAX_ENTRIES, MAX_LEAF, Node8, WIDTH};
use crate::tree::Bvh;
use area::Extent;
use split::Split;

/// What a build weighs. Costs are in units of a node test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How many things a leaf may hold, 1 to 16.
    pub max_leaf: usize,
    /// The cost of testing one thing.
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

/// From this level on ranges are halved by count. Halving reaches single things in `log8(2^27) = 9` levels, and
/// the kinds of a last range of 16 need two more; so no tree is deeper than 35, and [`MAX_DEPTH`] is 40.
const BALANCED_FROM: usize = 24;

const _: () = assert!(BALANCED_FROM + 9 + 2 < MAX_DEPTH && MAX_ENTRIES == 1 << 27 && MAX_LEAF == 16);

/// Ranges with fewer entries are one thread's.
const PARALLEL: usize = 4096;

/// Nodes over `entries`, which are put into leaf order. The first node is the root. Leaves refer to positions.
pub(crate) fn build(entries: &mut [Entry], settings: &Settings) -> Vec<Node8> {
    let settings = Settings { max_leaf: settings.max_leaf.clamp(1, MAX_LEAF), ..*settings };
    let mut nodes = Vec::new();
    if !entries.is_empty() {
        let whole = Range { first: 0, len: entries.len(), extent: split::extent(entries), closed: false };
        subtree(entries, 0, &whole, 0, &settings, &mut nodes);
    }
    nodes
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

/// Appends the node over all of `entries`, and those below it; `base` is the position of the first entry.
fn subtree(
    entries: &mut [Entry],
    base: usize,
    whole: &Range,
    level: usize,
    settings: &Settings,
    nodes: &mut Vec<Node8>,
) {
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
        match split(range.of(entries), &range.extent, level, settings) {
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
        range.closed = range.len == 1 || split::is_better_as_leaf(range.of(entries), &range.extent, settings);
    }

    let this = nodes.len();
    nodes.push(Node8::EMPTY);
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
    if whole.len < PARALLEL {
        for (slot, mine, range) in below {
            node.child[slot] = ChildRef::node(nodes.len());
            subtree(mine, base + range.first, range, level + 1, settings, nodes);
        }
    } else {
        use rayon::prelude::*;
        let grown: Vec<_> = below
            .into_par_iter()
            .with_max_len(1)
            .map(|(slot, mine, range)| {
                let mut nodes = Vec::new();
                subtree(mine, base + range.first, range, level + 1, settings, &mut nodes);
                (slot, nodes)
            })
            .collect();
        nodes.reserve_exact(grown.iter().map(|(_, subtree)| subtree.len()).sum());
        for (slot, mut subtree) in grown {
            let offset = nodes.len();
            node.child[slot] = ChildRef::node(offset);
            subtree.iter_mut().for_each(|n| move_by(n, offset));
            nodes.append(&mut subtree);
        }
    }
    node.sort();
    nodes[this] = node;
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
fn split(entries: &mut [Entry], extent: &Extent, level: usize, settings: &Settings) -> Option<Split> {
    let one_kind = split::is_one_kind(entries);
    let may_be_leaf = one_kind && entries.len() <= settings.max_leaf;
    if level >= BALANCED_FROM {
        return (!may_be_leaf).then(|| split::halve_by_kind(entries));
    }
    let best = split::best_plane(entries);
    if may_be_leaf {
        let leaf = settings.leaf_cost + settings.test_cost * entries.len() as f32;
        let whole = extent.half_area();
        // In this node another child costs no other node test.
        let pays = best.as_ref().is_some_and(|b| b.cost(settings) < leaf * whole);
        if !pays {
            return None;
        }
    }
    match best {
        Some(best) => Some(split::by_plane(entries, &best)),
        None if one_kind => Some(split::halve(entries)),
        None => Some(split::halve_by_kind(entries)),
    }
}

impl Bvh {
    /// Builds a tree over `entries`, all [bounded](Entry::is_bounded) and made by `frame`, of `kinds` kinds.
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
        kinds: usize,
        settings: &Settings,
    ) -> (Self, Vec<Vec<u32>>) {
        assert!(entries.len() <= MAX_ENTRIES, "at most {MAX_ENTRIES} entries, got {}", entries.len());
        let mut nodes = build(&mut entries, settings);
        nodes.shrink_to_fit();
        let mut starts = vec![0_u32; kinds + 1];
        for entry in &entries {
            starts[entry.kind() as usize + 1] += 1;
        }
        let mut order: Vec<Vec<u32>> = starts[1..].iter().map(|&n| Vec::with_capacity(n as usize)).collect();
        for kind in 0..kinds {
            starts[kind + 1] += starts[kind];
        }
        if order.iter().filter(|o| o.capacity() > 0).count() == 1 {
            let kind = entries[0].kind() as usize;
            order[kind].extend(entries.iter().map(Entry::index));
        } else {
            // Positions of all leaves become slots, which are sorted by kind.
            let mut slots = Vec::with_capacity(entries.len());
            for entry in &entries {
                let kind = entry.kind() as usize;
                slots.push(starts[kind] + order[kind].len() as u32);
                order[kind].push(entry.index());
            }
            for node in &mut nodes {
                for slot in 0..WIDTH {
                    if node.is_used(slot) && node.child[slot].is_leaf() {
                        let (first, count) = node.child[slot].slots();
                        node.child[slot] = ChildRef::leaf(slots[first as usize] as usize, count as usize);
                    }
                }
            }
        }
        (Self::assembled(*frame, nodes, starts), order)
    }
}
