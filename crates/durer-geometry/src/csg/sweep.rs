//! The sweep along a ray: from the crossings of leaves to those of the CSG solid.

use super::tree::{Tree, Values};
use core::ops::ControlFlow;
use durer_surfaces::Root;

/// A crossing of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) root: Root,
    pub(super) leaf: u32,
    /// The arena of the surface that is crossed.
    pub(super) arena: u32,
    /// Its slot there.
    pub(super) slot: u32,
    /// A running number: it keeps the events of one surface in the exact order of their crossings.
    number: u32,
}

/// A crossing of the CSG solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The crossing of the leaf that causes it.
    pub(super) event: Event,
    /// -1 where the ray enters the solid, +1 where it leaves it, 0 where it touches it.
    pub(super) sign: i8,
    /// Whether it was decided in a tie with crossings of other leaves that matter there.
    pub(super) tied: bool,
}

/// The state of a leaf on a ray.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// The query that last tested its surface.
    asked: u64,
    /// The query that last found a crossing of it.
    query: u64,
    /// Whether the ray starts inside.
    starts: bool,
    /// The step that last counted its crossings.
    step: u64,
    /// The sum of the signs of its crossings in that step.
    net: i32,
    /// How many crossings it has in that step.
    count: u32,
    /// Whether it mattered before that step.
    mattered: bool,
}

/// Reusable memory for the sweep along a ray.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    query: u64,
    events: Vec<Event>,
    /// How many of the events the sweep has passed.
    done: usize,
    /// How many of the events a sweep has included.
    looked_at: usize,
    leaves: Vec<Tally>,
    /// Leaves in which the ray starts.
    starts: Vec<u32>,
    /// How many of them are set in the values.
    started: usize,
    /// Leaves of a tie.
    tied: Vec<u32>,
    /// Events of leaves that coincide.
    together: Vec<Event>,
    values: Values,
}

/// How a leaf's crossings change its state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    /// By the signs of the crossings.
    Sign,
    /// By parity: each crossing changes the state, whatever the orientation of the surface.
    Parity,
}

impl Scratch {
    /// Starts a new ray.
    pub(super) fn begin(&mut self, leaves: usize) {
        self.query += 1;
        self.events.clear();
        self.starts.clear();
        (self.done, self.looked_at, self.started) = (0, 0, 0);
        if self.leaves.len() < leaves {
            self.leaves.resize(leaves, Tally::default());
        }
    }

    /// Whether this ray tests a leaf for the first time.
    pub(super) fn is_new(&mut self, leaf: u32) -> bool {
        let tally = &mut self.leaves[leaf as usize];
        let is_new = tally.asked != self.query;
        tally.asked = self.query;
        is_new
    }

    /// Whether a crossing of the leaf has been added that is not a touch: it decides whether the
    /// ray starts inside.
    pub(super) fn is_crossed(&self, leaf: u32) -> bool {
        self.leaves[leaf as usize].query == self.query
    }

    /// Adds a crossing ahead of the ray's start. Crossings of one surface come in order.
    pub(super) fn push(&mut self, leaf: u32, sense: Sense, (arena, slot): (u32, u32), root: Root) {
        let tally = &mut self.leaves[leaf as usize];
        if tally.query != self.query {
            // The first crossing decides whether the ray starts inside; a touch does not.
            if root.sign != 0 {
                *tally = Tally { asked: tally.asked, query: self.query, ..Tally::default() };
                tally.starts = sense == Sense::Sign && root.sign > 0;
                if tally.starts {
                    self.starts.push(leaf);
                }
            }
        }
        let tally = &mut self.leaves[leaf as usize];
        if sense == Sense::Parity && root.sign != 0 {
            tally.starts ^= true;
            if tally.starts {
                self.starts.push(leaf);
            } else {
                // Its parity may change often: the last value is valid.
                self.starts.retain(|&l| l != leaf);
            }
        }
        let number = self.events.len() as u32;
        self.events.push(Event { root, leaf, arena, slot, number });
    }

    /// Records that the ray starts inside a leaf that it does not cross.
    pub(super) fn start_inside(&mut self, leaf: u32) {
        self.starts.push(leaf);
    }

    /// Whether the ray starts inside the CSG solid.
    pub(super) fn starts_inside(&mut self, tree: &Tree) -> bool {
        self.values.begin(tree);
        self.start_more(tree);
        self.values.holds(tree)
    }

    /// Sets the leaves in which the ray starts and that were tested since the last call. They have
    /// not mattered up to now.
    pub(super) fn start_more(&mut self, tree: &Tree) {
        self.values.next_step();
        for &leaf in &self.starts[self.started..] {
            self.values.set(tree, leaf, true);
        }
        self.started = self.starts.len();
    }

    /// Whether the bracket of an event that no sweep has included yet contains this parameter.
    pub(super) fn is_split_at(&self, t: f64) -> bool {
        self.events[self.looked_at..].iter().any(|e| e.root.lo <= t && t <= e.root.hi)
    }

    /// Passes the solid's crossings to `show`, in their order; returns `false` if `show` returned
    /// [`ControlFlow::Break`]. [`Scratch::starts_inside`] must be called before. Continues from the
    /// last call up to `until`, before which no event is missing.
    pub(super) fn sweep(
        &mut self,
        tree: &Tree,
        until: f64,
        sense: impl Fn(u32) -> Sense,
        is_shown: impl Fn(&Event) -> bool,
        mut show: impl FnMut(&Crossing) -> ControlFlow<()>,
    ) -> bool {
        let mut events = core::mem::take(&mut self.events);
        self.looked_at = events.len();
        let mut rest = &mut events[self.done..];
        in_order(rest);
        let mut go_on = true;
        while go_on && !rest.is_empty() {
            let (count, reach) = overlapping(&rest[0], &rest[1..]);
            if reach >= until && until < f64::INFINITY {
                break;
            }
            self.done += count;
            let (group, others) = rest.split_at_mut(count);
            rest = others;
            let leaf = group[0].leaf;
            if group.iter().all(|e| e.leaf == leaf) {
                in_leafs_order(group, &sense);
                go_on = group.chunks(1).all(|event| self.step(tree, event, &sense, &is_shown, &mut show));
            } else if let Some(leaves) = copies(group, &sense) {
                // All leaves have the same crossings, whose order is known: each crossing is one
                // step for all of them.
                let count = group.len() / leaves;
                let mut together = core::mem::take(&mut self.together);
                for i in 0..count {
                    together.clear();
                    together.extend((0..leaves).map(|leaf| group[leaf * count + i]));
                    go_on = go_on && self.step(tree, &together, &sense, &is_shown, &mut show);
                }
                self.together = together;
            } else {
                go_on = self.step(tree, group, &sense, &is_shown, &mut show);
            }
        }
        self.events = events;
        go_on
    }

    /// Applies all events of a tie at once.
    fn step(
        &mut self,
        tree: &Tree,
        group: &[Event],
        sense: &impl Fn(u32) -> Sense,
        is_shown: &impl Fn(&Event) -> bool,
        show: &mut impl FnMut(&Crossing) -> ControlFlow<()>,
    ) -> bool {
        let before = self.values.holds(tree);
        let step = self.values.next_step();
        let touches = group.iter().all(|e| e.root.sign == 0);
        let mut tied = core::mem::take(&mut self.tied);
        tied.clear();
        for event in group.iter().filter(|e| touches || e.root.sign != 0) {
            let tally = &mut self.leaves[event.leaf as usize];
            if tally.step != step {
                (tally.step, tally.net, tally.count) = (step, 0, 0);
                tied.push(event.leaf);
            }
            tally.net += i32::from(event.root.sign);
            tally.count += 1;
        }
        let several = tied.len() > 1;
        if several {
            for &leaf in &tied {
                self.leaves[leaf as usize].mattered = self.values.matters(tree, leaf);
            }
        }
        for &leaf in &tied {
            let Tally { net, count, .. } = self.leaves[leaf as usize];
            let is = self.values.leaf(leaf);
            let then = match sense(leaf) {
                // Where a ray touches a leaf, the leaf holds (or fails) for one point.
                _ if touches => !is,
                Sense::Parity => is ^ (count % 2 == 1),
                Sense::Sign if net == 0 => is,
                Sense::Sign => net < 0,
            };
            self.values.set(tree, leaf, then);
        }
        let after = self.values.holds(tree);
        let mut go_on = true;
        if before != after {
            // The leaf with the least number among those that cause the change.
            let reason = |e: &&Event| {
                is_shown(e) && (touches || e.root.sign != 0) && self.values.explains(tree, e.leaf)
            };
            let fits = |e: &Event| {
                let entered = self.values.leaf(e.leaf);
                sense(e.leaf) == Sense::Parity || touches || (e.root.sign < 0) == entered
            };
            let first = group.iter().filter(reason).filter(|e| fits(e)).min_by_key(|e| (e.leaf, e.number));
            if let Some(&event) = first {
                let sign = if touches {
                    0
                } else if after {
                    -1
                } else {
                    1
                };
                let matter = |l: &&u32| self.leaves[**l as usize].mattered || self.values.matters(tree, **l);
                let tied = several && tied.iter().filter(matter).count() > 1;
                go_on = show(&Crossing { event, sign, tied }).is_continue();
            }
        }
        if before && after && tree.has_inner_faces() && !touches {
            go_on = self.show_inner_faces(tree, group, sense, is_shown, show);
        }
        if touches {
            for &leaf in &tied {
                let is = self.values.leaf(leaf);
                self.values.set(tree, leaf, !is);
            }
        }
        self.tied = tied;
        go_on
    }

    /// Passes the inner faces of unions among the events of a step to `show`, after the step's
    /// values are set: there the solid's value does not change.
    fn show_inner_faces(
        &self,
        tree: &Tree,
        group: &[Event],
        sense: &impl Fn(u32) -> Sense,
        is_shown: &impl Fn(&Event) -> bool,
        show: &mut impl FnMut(&Crossing) -> ControlFlow<()>,
    ) -> bool {
        group.iter().enumerate().all(|(i, event)| {
            let holds = self.values.leaf(event.leaf);
            let Tally { net, count, .. } = self.leaves[event.leaf as usize];
            let is_cause = match sense(event.leaf) {
                Sense::Sign => net != 0 && (event.root.sign < 0) == holds,
                // Of several crossings of one leaf only the first is reported.
                Sense::Parity => count % 2 == 1 && group[..i].iter().all(|e| e.leaf != event.leaf),
            };
            if !is_cause || !is_shown(event) || !self.values.is_visible(tree, event.leaf) {
                return true;
            }
            let sign = if holds != tree.is_inverted(event.leaf) { -1 } else { 1 };
            show(&Crossing { event: *event, sign, tied: false }).is_continue()
        })
    }
}

/// Sorts events by leaf, and those of a leaf in the order of their crossings.
fn in_leafs_order(group: &mut [Event], sense: &impl Fn(u32) -> Sense) {
    group.sort_unstable_by(|a, b| {
        a.leaf.cmp(&b.leaf).then_with(|| match sense(a.leaf) {
            Sense::Sign => a.number.cmp(&b.number),
            Sense::Parity => a.root.order(&b.root),
        })
    });
}

/// If the events are several crossings of each of some leaves, equal for all leaves to the last
/// bit: the number of leaves; the events are then sorted. This happens near a tangent of surfaces
/// that coincide.
fn copies(group: &mut [Event], sense: &impl Fn(u32) -> Sense) -> Option<usize> {
    if group.len() < 4 || group.iter().any(|e| e.root.sign == 0) {
        return None;
    }
    in_leafs_order(group, sense);
    let mut leaves = group.chunk_by(|a, b| a.leaf == b.leaf);
    let first = leaves.next()?;
    let key = |e: &Event| (e.root.lo.to_bits(), e.root.hi.to_bits(), e.root.t.to_bits(), e.root.sign);
    let same = |leaf: &[Event]| leaf.iter().map(key).eq(first.iter().map(key));
    (first.len() > 1 && leaves.all(same)).then(|| group.len() / first.len())
}

/// Sorts events by the lower ends of their brackets.
fn in_order(events: &mut [Event]) {
    events.sort_unstable_by(|a, b| {
        a.root
            .lo
            .total_cmp(&b.root.lo)
            .then_with(|| a.root.t.total_cmp(&b.root.t))
            .then(a.number.cmp(&b.number))
    });
}

/// How many of the events, sorted by their lower ends, form a group with the first whose brackets
/// overlap transitively, and the upper end of the group.
fn overlapping(first: &Event, rest: &[Event]) -> (usize, f64) {
    let mut reach = first.root.hi;
    let touches = |e: &&Event| {
        let touches = e.root.lo <= reach;
        if touches {
            reach = reach.max(e.root.hi);
        }
        touches
    };
    (1 + rest.iter().take_while(touches).count(), reach)
}

/// The events whose brackets overlap, transitively, with that of a given event, without that event.
pub(super) fn partners<'a>(
    scratch: &'a mut Scratch,
    is_it: &'a dyn Fn(&Event) -> bool,
) -> impl Iterator<Item = &'a Event> {
    in_order(&mut scratch.events);
    let mut rest = scratch.events.as_slice();
    let mut groups = core::iter::from_fn(move || {
        let first = rest.first()?;
        let (group, others) = rest.split_at(overlapping(first, &rest[1..]).0);
        rest = others;
        Some(group)
    });
    let group = groups.find(|group| group.iter().any(is_it)).unwrap_or(&[]);
    group.iter().filter(move |e| !is_it(e))
}
