//! The walk along a ray: from the crossings of leaves to those of the body.

use super::tree::{Tree, Values};
use durer_surfaces::{Flow, Root};

/// A crossing of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) root: Root,
    pub(super) leaf: u32,
    /// Where the surface that is crossed is kept.
    pub(super) arena: u32,
    /// Its slot there.
    pub(super) slot: u32,
    /// Events of one surface come in the exact order of their crossings: this counts them.
    number: u32,
}

/// A crossing of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The crossing of the leaf that is the reason for it.
    pub(super) event: Event,
    /// -1 where the body is entered, +1 where it is left, 0 where it is touched.
    pub(super) sign: i8,
    /// Whether it was decided together with crossings of other leaves, which matter there.
    pub(super) tied: bool,
}

/// What is known of a leaf on a ray.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// The query in which its surface was asked.
    asked: u64,
    /// The query in which it was met.
    query: u64,
    /// Whether the ray starts inside.
    starts: bool,
    /// The step that counted it last.
    step: u64,
    /// The sum of the signs of its crossings in that step.
    net: i32,
    /// How many crossings it has in that step.
    count: u32,
    /// Whether it mattered before that step.
    mattered: bool,
}

/// Memory for the walk along a ray, to be used again.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    query: u64,
    events: Vec<Event>,
    /// How many of the events have been walked past.
    done: usize,
    /// How many of the events have been in a walk.
    looked_at: usize,
    leaves: Vec<Tally>,
    /// Leaves in which the ray starts.
    starts: Vec<u32>,
    /// How many of them the values know.
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
    /// By their signs.
    Sign,
    /// Each crossing changes it, whichever way the surface is turned.
    Parity,
}

impl Scratch {
    /// Begins with a new ray.
    pub(super) fn begin(&mut self, leaves: usize) {
        self.query += 1;
        self.events.clear();
        self.starts.clear();
        (self.done, self.looked_at, self.started) = (0, 0, 0);
        if self.leaves.len() < leaves {
            self.leaves.resize(leaves, Tally::default());
        }
    }

    /// Whether a leaf is asked for the first time.
    pub(super) fn is_new(&mut self, leaf: u32) -> bool {
        let tally = &mut self.leaves[leaf as usize];
        let is_new = tally.asked != self.query;
        tally.asked = self.query;
        is_new
    }

    /// Whether a crossing of the leaf has been taken, one that is no touch: it tells where the ray
    /// starts.
    pub(super) fn is_crossed(&self, leaf: u32) -> bool {
        self.leaves[leaf as usize].query == self.query
    }

    /// Takes a crossing ahead of the ray's start. Those of a surface come in their order.
    pub(super) fn push(&mut self, leaf: u32, sense: Sense, (arena, slot): (u32, u32), root: Root) {
        let tally = &mut self.leaves[leaf as usize];
        if tally.query != self.query {
            // The first crossing tells where the ray starts; a touch does not.
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
                // Its parity may change often: the last word counts.
                self.starts.retain(|&l| l != leaf);
            }
        }
        let number = self.events.len() as u32;
        self.events.push(Event { root, leaf, arena, slot, number });
    }

    /// Says that the ray starts inside a leaf that it does not cross.
    pub(super) fn start_inside(&mut self, leaf: u32) {
        self.starts.push(leaf);
    }

    /// Whether the ray starts inside the body.
    pub(super) fn starts_inside(&mut self, tree: &Tree) -> bool {
        self.values.begin(tree);
        self.start_more(tree);
        self.values.holds(tree)
    }

    /// Takes it in that the ray starts inside leaves that were asked since. What they are up to now
    /// has not mattered so far.
    pub(super) fn start_more(&mut self, tree: &Tree) {
        self.values.next_step();
        for &leaf in &self.starts[self.started..] {
            self.values.set(tree, leaf, true);
        }
        self.started = self.starts.len();
    }

    /// Whether an event that no walk has seen yet may belong before and behind this parameter.
    pub(super) fn is_split_at(&self, t: f64) -> bool {
        self.events[self.looked_at..].iter().any(|e| e.root.lo <= t && t <= e.root.hi)
    }

    /// Shows the body's crossings, in their order; `false` if it was told to stop.
    /// [`Scratch::starts_inside`] comes first. Goes on from where it was before, no further than
    /// `until`: before that no event is missing.
    pub(super) fn sweep(
        &mut self,
        tree: &Tree,
        until: f64,
        sense: impl Fn(u32) -> Sense,
        is_shown: impl Fn(&Event) -> bool,
        mut show: impl FnMut(&Crossing) -> Flow,
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
                // The same crossings of each, whose order is known: they take place together, one
                // after the other.
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

    /// Takes all events of a tie at once.
    fn step(
        &mut self,
        tree: &Tree,
        group: &[Event],
        sense: &impl Fn(u32) -> Sense,
        is_shown: &impl Fn(&Event) -> bool,
        show: &mut impl FnMut(&Crossing) -> Flow,
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
                // Where it is touched a leaf begins or ends, for a point.
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
            // The first-named leaf that is a reason for it.
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
                go_on = show(&Crossing { event, sign, tied }) == Flow::Continue;
            }
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
}

/// Puts events into the order of leaves, and those of a leaf into the order in which they take
/// place.
fn in_leafs_order(group: &mut [Event], sense: &impl Fn(u32) -> Sense) {
    group.sort_unstable_by(|a, b| {
        a.leaf.cmp(&b.leaf).then_with(|| match sense(a.leaf) {
            Sense::Sign => a.number.cmp(&b.number),
            Sense::Parity => a.root.order(&b.root),
        })
    });
}

/// If the events are several crossings of each of some leaves, the same of all to the last bit, how
/// many leaves there are; the events are in their order then. Surfaces that coincide near a tangent
/// are such.
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

/// Puts events into the order in which their enclosures begin.
fn in_order(events: &mut [Event]) {
    events.sort_unstable_by(|a, b| {
        a.root
            .lo
            .total_cmp(&b.root.lo)
            .then_with(|| a.root.t.total_cmp(&b.root.t))
            .then(a.number.cmp(&b.number))
    });
}

/// How many of the events form a group with the first whose enclosures overlap transitively, and
/// how far it reaches; they ascend by their lower ends.
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

/// The events whose enclosures overlap, transitively, with that of a given one, itself left out.
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
