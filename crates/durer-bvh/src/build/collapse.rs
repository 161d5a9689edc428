//! Which cuts of a binary tree become nodes of sixteen? The best choice, by dynamic programming.
//!
//! For each range of a binary tree and each number of children from one to sixteen the least cost
//! of what is below is found from those of its two halves: after H. Ylitie, T. Karras, S. Laine,
//! "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", High Performance
//! Graphics (2017). Done for small ranges, which are nearly all of a tree; above them the largest
//! range is cut first.

use super::area::Extent;
use super::{Costs, Divided, Half, Range};
use crate::frame::Entry;
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, MAX_LEAF, Node, WIDTH};

/// Below this many entries a range is worth it.
pub(super) const COLLAPSED: usize = 4096;

/// From this level on ranges are halved by count, until 16 are left. Of these each two cuts by kind
/// at least halve the part that is of several kinds, and so do cuts by count. So eight and eight
/// more levels follow, even if each cut makes a node.
pub(super) const BALANCED_FROM: usize = 20;

const _: () = assert!(BALANCED_FROM + 8 + 8 + 1 < MAX_DEPTH && COLLAPSED == 16 << 8 && MAX_LEAF == 16);

/// A range of a binary tree.
struct Part {
    range: Range,
    /// Its halves.
    halves: Option<(u32, u32)>,
    /// The least cost of at most `i + 1` children that hold all of it.
    costs: [f32; WIDTH],
    /// How many of `i + 1` children the first half gets; 0 if it is better to make do with one
    /// child less.
    shares: [u8; WIDTH],
    /// How many of sixteen children the first half gets, if it becomes a node.
    share_of_node: u8,
}

/// A binary tree over a range of entries.
struct Binary<'a> {
    parts: Vec<Part>,
    costs: &'a Costs<'a>,
}

/// Appends the node over all of a range, of which these are the entries and the room, and those
/// below it; `base` is the position of the first entry.
pub(super) fn subtree(
    entries: &mut [Entry],
    base: usize,
    whole: &Range,
    level: usize,
    costs: &Costs<'_>,
    nodes: &mut Vec<Node>,
) {
    let mut binary = Binary { parts: Vec::with_capacity(entries.len() / 2), costs };
    let root = binary.grow(entries, Range { first: 0, ..*whole }, level);
    nodes.reserve(binary.parts.len() / 8);
    binary.emit(root, base, nodes);
}

impl Binary<'_> {
    /// Cuts a range as long as it pays or has to be, and adds up costs.
    fn grow(&mut self, entries: &mut [Entry], range: Range, level: usize) -> u32 {
        let Range { first, len, extent, .. } = range;
        let held = &entries[..len];
        let kind = self.costs.of_range(held);
        let may_be_leaf = self.costs.may_be_leaf(held);
        let area = extent.half_area();
        let leaf = if may_be_leaf { area * kind.of_leaf(len) } else { f32::INFINITY };
        let halves = cut(entries, len, &extent, level, self.costs).map(|Divided { left, right }| {
            let at = left.len + left.room;
            let (a, b) = entries.split_at_mut(at);
            let half = |first, half: Half| Range {
                first,
                len: half.len,
                room: half.room,
                extent: half.extent,
                closed: false,
            };
            (self.grow(a, half(first, left), level + 1), self.grow(b, half(first + at, right), level + 1))
        });
        let mut part = Part {
            range: Range { closed: true, ..range },
            halves,
            costs: [leaf; WIDTH],
            shares: [0; WIDTH],
            share_of_node: 0,
        };
        if let Some((a, b)) = halves {
            let (a, b) = (&self.parts[a as usize].costs, &self.parts[b as usize].costs);
            let (mut least, mut shares) = ([f32::INFINITY; WIDTH + 1], [1; WIDTH + 1]);
            for count in 2..=WIDTH {
                for share in 1..count {
                    let cost = a[share - 1] + b[count - share - 1];
                    if cost < least[count] {
                        (least[count], shares[count]) = (cost, share as u8);
                    }
                }
            }
            let node = area + least[WIDTH];
            part.share_of_node = shares[WIDTH];
            if !may_be_leaf || node < leaf {
                part.costs = [node; WIDTH];
                part.range.closed = false;
            }
            for count in 2..=WIDTH {
                if least[count] < part.costs[count - 2] {
                    (part.costs[count - 1], part.shares[count - 1]) = (least[count], shares[count]);
                } else {
                    part.costs[count - 1] = part.costs[count - 2];
                }
            }
        }
        self.parts.push(part);
        (self.parts.len() - 1) as u32
    }

    /// Appends the node over a range, and those below.
    fn emit(&self, part: u32, base: usize, nodes: &mut Vec<Node>) {
        let this = nodes.len();
        nodes.push(Node::EMPTY);
        let (mut children, mut count) = ([part; WIDTH], 0);
        let whole = &self.parts[part as usize];
        match whole.halves {
            Some((a, b)) => {
                let share = usize::from(whole.share_of_node);
                self.gather(a, share, &mut children, &mut count);
                self.gather(b, WIDTH - share, &mut children, &mut count);
            }
            None => count = 1,
        }
        let mut node = Node::EMPTY;
        for (slot, &child) in children[..count].iter().enumerate() {
            let range = &self.parts[child as usize].range;
            let reference = if range.closed {
                ChildRef::leaf(base + range.first, range.len)
            } else {
                ChildRef::node(nodes.len())
            };
            node.set(slot, range.extent.lo(), range.extent.hi(), reference);
            if !range.closed {
                self.emit(child, base, nodes);
            }
        }
        node.sort();
        nodes[this] = node;
    }

    /// The at most `count` children that hold a range at the least cost.
    fn gather(&self, part: u32, mut count: usize, children: &mut [u32; WIDTH], found: &mut usize) {
        let whole = &self.parts[part as usize];
        while count > 1 && whole.shares[count - 1] == 0 {
            count -= 1;
        }
        match whole.halves {
            Some((a, b)) if count > 1 => {
                let share = usize::from(whole.shares[count - 1]);
                self.gather(a, share, children, found);
                self.gather(b, count - share, children, found);
            }
            _ => {
                children[*found] = part;
                *found += 1;
            }
        }
    }
}

/// Cuts the first `len` entries in two, if that is more than one and it may pay.
fn cut(
    entries: &mut [Entry],
    len: usize,
    extent: &Extent,
    level: usize,
    costs: &Costs<'_>,
) -> Option<Divided> {
    if len < 2 {
        return None;
    }
    super::split(entries, len, extent, level + (super::BALANCED_FROM - BALANCED_FROM), costs)
}
