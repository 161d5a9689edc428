//! Arenas during the build of a geometry: parts are listed, boxes become entries of a tree, and
//! slots are sorted into the order of its leaves.

use super::{AnyArena, Arena, PartRef};
use durer_bvh::{Entry, Frame};
use durer_math::{Aabb, Point3};
use durer_surfaces::{Accelerate, PartId};
use rayon::prelude::*;

/// The builder's view of an arena.
pub(crate) trait Arrange: AnyArena {
    /// Lists the parts. No surface may be added afterwards.
    fn seal(&mut self);
    /// The box of all bounded slots, each clipped by its object's limit, if there is one.
    fn extent(&self, limits: &[Aabb]) -> Aabb;
    /// Appends the bounded slots, clipped in the same way, as entries of the given kind, to
    /// `entries`, and returns the others.
    fn entries(&self, frame: &Frame, kind: u32, limits: &[Aabb], entries: &mut Vec<Entry>) -> Unsorted;
    /// The corners of a triangle, by its number in [`Arrange::entries`].
    fn corners(&self, index: u32) -> [Point3; 3];
    /// Reorders the slots: the new slot `i` is the old `order[i]`. Consumes the array.
    fn arrange(&mut self, order: Vec<u32>);
    /// Converts to the arena of a finished geometry.
    fn finish(self: Box<Self>) -> Box<dyn AnyArena>;
}

/// Slots that are not in the tree.
#[derive(Debug, Default)]
pub(crate) struct Unsorted {
    /// Unbounded slots, and slots whose box has a NaN: every ray tests them.
    pub(crate) beside: Vec<u32>,
    /// Empty slots: no ray hits them.
    pub(crate) nothing: Vec<u32>,
}

impl Unsorted {
    /// Appends bounded boxes, numbered in their order, as entries of a kind, and returns the
    /// others.
    pub(crate) fn beside(
        entries: &mut Vec<Entry>,
        frame: &Frame,
        kind: u32,
        boxes: impl IndexedParallelIterator<Item = Aabb>,
    ) -> Self {
        let first = entries.len();
        entries.par_extend(boxes.enumerate().map(|(i, b)| frame.entry(&b, kind, i as u32)));
        let mut unsorted = Self::default();
        entries[first..].iter().for_each(|e| unsorted.take(e));
        if !unsorted.is_empty() {
            let mut at = 0;
            entries.retain(|e| {
                at += 1;
                at <= first || e.is_bounded()
            });
        }
        unsorted
    }

    fn take(&mut self, entry: &Entry) {
        if entry.is_empty() {
            self.nothing.push(entry.index());
        } else if !entry.is_bounded() {
            self.beside.push(entry.index());
        }
    }

    fn is_empty(&self) -> bool {
        self.beside.is_empty() && self.nothing.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.beside.len() + self.nothing.len()
    }
}

impl<S: Accelerate> Arena<S> {
    fn slot_boxes(&self, limits: &[Aabb]) -> impl IndexedParallelIterator<Item = Aabb> {
        let count = self.parts.as_ref().map_or(self.surfaces.len(), Vec::len);
        (0..count).into_par_iter().map(|i| {
            let (surface, bounds) = match &self.parts {
                Some(parts) => (parts[i].0.surface as usize, parts[i].1),
                None => (i, self.surfaces[i].bounds()),
            };
            match limits.get(self.ids.name(surface).object as usize) {
                Some(limit) => bounds.intersection(*limit),
                None => bounds,
            }
        })
    }
}

impl<S: Accelerate + 'static> Arrange for Arena<S> {
    fn seal(&mut self) {
        self.surfaces.shrink_to_fit();
        self.ids.shrink();
        if !self.surfaces.iter().any(Accelerate::is_in_parts) {
            return;
        }
        let mut parts = Vec::new();
        for (i, s) in self.surfaces.iter().enumerate() {
            let (surface, whole, first) = (i as u32, false, parts.len());
            s.parts(&mut |bounds, part| parts.push((PartRef { surface, part: part.0, whole }, bounds)));
            if let [(part, _)] = &mut parts[first..] {
                part.whole = true;
            }
        }
        self.parts = Some(parts);
    }

    fn extent(&self, limits: &[Aabb]) -> Aabb {
        let bounded = |b: Aabb| if b.is_bounded() { b } else { Aabb::EMPTY };
        self.slot_boxes(limits).map(bounded).reduce(|| Aabb::EMPTY, Aabb::union)
    }

    fn entries(&self, frame: &Frame, kind: u32, limits: &[Aabb], entries: &mut Vec<Entry>) -> Unsorted {
        Unsorted::beside(entries, frame, kind, self.slot_boxes(limits))
    }

    fn corners(&self, index: u32) -> [Point3; 3] {
        let corners = match &self.parts {
            Some(parts) => {
                let part = &parts[index as usize].0;
                self.surfaces[part.surface as usize].corners(PartId(part.part))
            }
            None => self.surfaces[index as usize].corners(PartId(0)),
        };
        corners.unwrap_or([Point3::ORIGIN; 3])
    }

    fn arrange(&mut self, mut order: Vec<u32>) {
        // Left over from before, if the arena is arranged anew.
        self.placed = Vec::new();
        if let Some(parts) = self.parts.take() {
            self.placed = order.iter().map(|&i| parts[i as usize].0).collect();
            return;
        }
        // Follows the permutation's cycles, in place: surfaces need not be `Clone`, and no second
        // arena is allocated.
        for start in 0..order.len() {
            let mut to = start;
            loop {
                let from = order[to] as usize;
                order[to] = to as u32;
                if from == start {
                    break;
                }
                self.surfaces.swap(to, from);
                self.ids.swap(to, from);
                to = from;
            }
        }
    }

    fn finish(self: Box<Self>) -> Box<dyn AnyArena> {
        self
    }
}
