//! Assigns entries to leaves and slots.
//!
//! Entries of a kind have successive slots in the order of the leaves. Triangles in several leaves
//! have the last slots. For each of them the tree records all places, so that a query that reports
//! each triangle once can decide which of its leaves reports it (see [`Splits`]).

use crate::frame::Entry;
use crate::node::{Node, WIDTH};
use crate::tree::{Bvh, Splits};
use durer_math::kernels::in_large_pages;
use rayon::prelude::*;

/// The leaves, and the slots of the entries.
pub(super) struct Arranged {
    /// For each kind the indices of the entries, slot by slot.
    pub(super) order: Vec<Vec<u32>>,
    /// All leaves in the order of the nodes.
    pub(super) leaves: Vec<Placed>,
    /// The contents of the leaves, if triangles may be in several.
    pub(super) listed: Option<Listed>,
}

/// A leaf: a range of slots, or of positions in [`Listed::slots`].
#[derive(Clone, Copy)]
pub(super) struct Placed {
    pub(super) kind: u32,
    pub(super) first: u32,
    pub(super) count: u32,
}

/// For each kind, the slots of its leaves, concatenated, and how many slots are in one leaf only.
pub(super) struct Listed {
    pub(super) slots: Vec<Vec<u32>>,
    pub(super) whole: Vec<u32>,
}

/// First position and count of the leaves, in the order of the nodes.
fn positions(nodes: &[Node]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let leaves = |node: &'_ Node| {
        let child = node.child;
        let leaves: [bool; WIDTH] = core::array::from_fn(|slot| node.is_used(slot) && child[slot].is_leaf());
        (0..WIDTH).filter(move |&slot| leaves[slot]).map(move |slot| child[slot].slots())
    };
    nodes.iter().flat_map(leaves).map(|(first, count)| (first as usize, count as usize))
}

impl Arranged {
    /// For leaves that refer to positions of entries, each of which is in one leaf.
    pub(super) fn by_position(nodes: &[Node], slots: Slots) -> Self {
        let leaf = |(first, count): (usize, usize)| {
            let slot = slots.places.get(first).copied().unwrap_or(first as u32);
            let kind = slots.starts[1..].partition_point(|&start| start <= slot);
            Placed { kind: kind as u32, first: slot - slots.starts[kind], count: count as u32 }
        };
        let leaves = positions(nodes).map(leaf).collect();
        Self { order: slots.order, leaves, listed: None }
    }

    /// For leaves that refer to positions of references. A triangle may be in several leaves, or
    /// several times in one, and positions between leaves may be unused.
    pub(super) fn sharing(nodes: &[Node], entries: &[Entry], kinds: usize) -> Self {
        let mut leaves = Vec::new();
        // For each kind and index the number of leaves that hold it.
        let mut times: Vec<Vec<u8>> = vec![Vec::new(); kinds];
        // The indices of all leaves, concatenated, each index once per leaf.
        let mut indices: Vec<u32> = Vec::with_capacity(entries.len());
        for (first, count) in positions(nodes) {
            let kind = entries[first].kind();
            let (times, begin) = (&mut times[kind as usize], indices.len());
            for entry in &entries[first..first + count] {
                let index = entry.index();
                if indices[begin..].contains(&index) {
                    continue;
                }
                indices.push(index);
                if times.len() <= index as usize {
                    times.resize(index as usize + 1, 0);
                }
                times[index as usize] = times[index as usize].saturating_add(1);
            }
            leaves.push(Placed { kind, first: begin as u32, count: (indices.len() - begin) as u32 });
        }
        let ones = |times: &Vec<u8>| times.iter().filter(|&&n| n == 1).count() as u32;
        let all = |times: &Vec<u8>| times.iter().filter(|&&n| n > 0).count() as u32;
        let whole: Vec<u32> = times.iter().map(ones).collect();
        let counts: Vec<u32> = times.iter().map(all).collect();
        let mut order: Vec<Vec<u32>> = counts.iter().map(|&n| vec![0; n as usize]).collect();
        let mut slots: Vec<Vec<u32>> = vec![Vec::new(); kinds];
        // The next slot for an entry in one leaf, and for one in several; and the slots that the
        // latter got.
        let mut next: Vec<(u32, u32)> = whole.iter().map(|&n| (0, n)).collect();
        let mut given: Vec<Vec<u32>> = times
            .iter()
            .map(|times| vec![u32::MAX; if all(times) == ones(times) { 0 } else { times.len() }])
            .collect();
        for leaf in &mut leaves {
            let kind = leaf.kind as usize;
            let (order, slots, next) = (&mut order[kind], &mut slots[kind], &mut next[kind]);
            let first = slots.len() as u32;
            for &index in &indices[leaf.first as usize..(leaf.first + leaf.count) as usize] {
                let slot = if times[kind][index as usize] == 1 {
                    next.0 += 1;
                    next.0 - 1
                } else {
                    let given = &mut given[kind][index as usize];
                    if *given == u32::MAX {
                        *given = next.1;
                        next.1 += 1;
                    }
                    *given
                };
                order[slot as usize] = index;
                slots.push(slot);
            }
            leaf.first = first;
        }
        Self { order, leaves, listed: Some(Listed { slots, whole }) }
    }

    /// The first slot of each kind, and the end.
    pub(super) fn starts(&self) -> Vec<u32> {
        let mut starts = vec![0];
        let mut end = 0;
        for order in &self.order {
            end += order.len() as u32;
            starts.push(end);
        }
        starts
    }
}

/// The slot of each position; slots are counted kind by kind.
pub(super) struct Slots {
    /// The first slot of each kind, and the end.
    starts: Vec<u32>,
    /// For each kind the indices of the entries, slot by slot.
    order: Vec<Vec<u32>>,
    /// The slot at each position. Empty if there is one kind: then positions are slots.
    places: Vec<u32>,
}

impl Slots {
    pub(super) fn of(entries: &[Entry], kinds: usize) -> Self {
        let mut starts = vec![0_u32; kinds + 1];
        for entry in entries {
            starts[entry.kind() as usize + 1] += 1;
        }
        let mut order: Vec<Vec<u32>> = starts[1..].iter().map(|&n| Vec::with_capacity(n as usize)).collect();
        order.iter().for_each(in_large_pages);
        for kind in 0..kinds {
            starts[kind + 1] += starts[kind];
        }
        let mut places = Vec::new();
        if let Some(kind) = (0..kinds).find(|&k| (starts[k + 1] - starts[k]) as usize == entries.len()) {
            order[kind].par_extend(entries.par_iter().map(Entry::index));
        } else {
            places.reserve_exact(entries.len());
            for entry in entries {
                let kind = entry.kind() as usize;
                places.push(starts[kind] + order[kind].len() as u32);
                order[kind].push(entry.index());
            }
        }
        Self { starts, order, places }
    }
}

impl Bvh {
    /// Records the places of triangles that are in several leaves of these nodes.
    pub(super) fn share(&mut self, nodes: &[Node], listed: &Listed) {
        let mut splits = Splits::default();
        let mut starts: Vec<u32> = Vec::new();
        for (kind, &whole) in listed.whole.iter().enumerate() {
            splits.kinds.push((whole, starts.len() as u32));
            starts.resize(starts.len() + self.count(kind as u32) - whole as usize, 0);
        }
        if starts.is_empty() {
            return;
        }
        // First counts, then ends, which become starts as places are filled in from the last.
        let all = |visit: &mut dyn FnMut(u32, u32)| {
            for (index, node) in nodes.iter().enumerate().rev() {
                for slot in (0..WIDTH).rev().filter(|&slot| node.is_used(slot) && node.child[slot].is_leaf())
                {
                    let Some((kind, number)) = self.block(node.child[slot]) else { continue };
                    let block = &self.blocks[number as usize];
                    for lane in 0..block.len() {
                        if let Some(split) = splits.number(kind, block.slot(lane)) {
                            visit(split, Splits::place(index, slot));
                        }
                    }
                }
            }
        };
        all(&mut |split, _| starts[split as usize] += 1);
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        let mut places = vec![0; end as usize];
        all(&mut |split, place| {
            starts[split as usize] -= 1;
            places[starts[split as usize] as usize] = place;
        });
        starts.push(end);
        (splits.starts, splits.places) = (starts, places);
        self.splits = splits;
    }
}
