//! The search along a ray: nodes unfold in the order in which they may begin, and the intervals of
//! the copies they end in are united.
//!
//! An interval is final once no node is left that may begin before its end. Nodes that certainly lie
//! beyond an end of the ray's range are left out. If one of them touches an interval, that end of
//! the interval lies beyond the range, too, and is not passed on, by an exact comparison.

use super::exact::{Event, Line};
use super::frame::CellRay;
use super::leaf::{Leaf, Pass, Quick, slabs};
use super::{System, Word, tag};
use crate::{End, LocalRay, PREVIEW_WIDTH, Root, RootKind, Sink};
use core::cell::Cell;
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::{RaySide, U};
use std::collections::BinaryHeap;

/// Half of the largest width of a bracket, relative to `max(|t|, size / |d|)`.
const NARROW: f64 = 24.0 * U;

/// A stretch of the line inside the set.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: Event,
    to: Event,
    /// Whether the beginning has been passed on.
    shown: bool,
    /// It is unknown whether the line meets it, because the line is not exactly known.
    doubtful: bool,
}

/// A node in the queue.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    /// A lower bound on its crossings.
    lo: f64,
    hi: f64,
    word: Word,
    slot: u32,
    levels: u8,
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    /// The heap's greatest node is the one that begins first; of equal ones the deepest.
    fn cmp(&self, other: &Self) -> Ordering {
        let of = |w: &Self| (w.levels, w.word);
        other.lo.total_cmp(&self.lo).then_with(|| of(self).cmp(&of(other)))
    }
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
struct Lists {
    waiting: BinaryHeap<Waiting>,
    cells: Vec<CellRay>,
    free: Vec<u32>,
    spans: Vec<Span>,
}

thread_local! {
    static LISTS: Cell<Lists> = Cell::default();
}

struct Walk<'a, 'k> {
    line: &'a Line<'a>,
    lists: &'a mut Lists,
    sink: &'k mut dyn Sink,
    begin: f64,
    end: f64,
    /// No crossing may be passed on before this parameter of the caller.
    least: f64,
}

/// Passes all crossings to `sink`, ascending.
#[inline(always)]
pub(super) fn roots(system: &System, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
    let at = ray.recentre(system.centre, system.scale).sharp(1.0);
    let line = Line::new(system, &at);
    let mut lists = LISTS.take();
    lists.waiting.clear();
    lists.cells.clear();
    lists.free.clear();
    lists.spans.clear();
    let (begin, end) = at.window((ray.t_min, ray.t_max.min(sink.limit())));
    let walk = Walk { line: &line, lists: &mut lists, sink, begin, end, least: f64::NEG_INFINITY };
    let _ = walk.run();
    LISTS.set(lists);
}

impl Walk<'_, '_> {
    #[inline(always)]
    fn run(mut self) -> ControlFlow<()> {
        let system = self.line.system;
        let ray = CellRay::new(self.line.at);
        self.wait(&ray, f64::NEG_INFINITY, 0, 0);
        while let Some(next) = self.lists.waiting.pop() {
            self.show(next.lo)?;
            if next.lo > self.end {
                break;
            }
            let cell = self.lists.cells[next.slot as usize];
            self.lists.free.push(next.slot);
            if self.is_covered(&next) {
                continue;
            }
            if u32::from(next.levels) == system.depth {
                self.meet_leaf(&cell, &next);
                continue;
            }
            if system.is_lattice && self.is_missed(&cell, &next) {
                continue;
            }
            let maps = system.frames.len();
            for letter in 0..maps {
                let below = system.frames.descend(letter, &cell);
                let word = next.word * maps as Word + letter as Word;
                self.wait(&below, next.lo, word, next.levels + 1);
            }
        }
        self.show(f64::INFINITY)
    }

    /// Adds a node to the queue, if the line may meet it.
    #[inline(always)]
    fn wait(&mut self, cell: &CellRay, least: f64, word: Word, levels: u8) {
        let system = self.line.system;
        let left = system.depth as usize - usize::from(levels);
        let reach = match &system.leaf {
            Leaf::Polytope(_) if system.leaf_holds_all => system.leaf.reach(cell),
            _ => slabs(&system.boxes[left], cell),
        };
        let Some((near, far)) = reach else { return };
        if far < self.begin || near > self.end {
            return;
        }
        let slot = match self.lists.free.pop() {
            Some(slot) => {
                self.lists.cells[slot as usize] = *cell;
                slot
            }
            None => {
                self.lists.cells.push(*cell);
                self.lists.cells.len() as u32 - 1
            }
        };
        self.lists.waiting.push(Waiting { lo: near.max(least), hi: far, word, slot, levels });
    }

    /// Whether the line misses a node whose copies lie in its leaf. Where f64 leaves it open, the
    /// exact answer excludes nodes that the line passes within rounding; otherwise all their copies
    /// would need exact decisions.
    #[inline(always)]
    fn is_missed(&self, cell: &CellRay, node: &Waiting) -> bool {
        match self.line.system.leaf.quick(cell) {
            Quick::Miss => true,
            Quick::Through(..) => false,
            Quick::Unsure => self.line.misses(node.word, u32::from(node.levels)),
        }
    }

    /// Whether a node certainly lies within a span, so that it has no effect.
    #[inline(always)]
    fn is_covered(&self, node: &Waiting) -> bool {
        self.lists
            .spans
            .iter()
            .any(|span| !span.doubtful && node.lo > span.from.pass.hi && node.hi < span.to.pass.lo)
    }

    /// The interval of the line in a copy.
    #[inline(always)]
    fn meet_leaf(&mut self, cell: &CellRay, node: &Waiting) {
        let word = node.word;
        let span = match self.line.system.leaf.quick(cell) {
            Quick::Miss => return,
            Quick::Through(from, to) => {
                let (from, to) = (Event { pass: from, word, sign: -1 }, Event { pass: to, word, sign: 1 });
                Span { from, to, shown: false, doubtful: false }
            }
            Quick::Unsure => match self.line.interval(word) {
                Some(None) => return,
                Some(Some([from, to])) => Span { from, to, shown: false, doubtful: false },
                None => {
                    let (lo, hi) = (node.lo, node.hi);
                    let pass = Pass { s: 0.5 * lo + 0.5 * hi, lo, hi, face: 0, sure: false };
                    let event = |sign| Event { pass, word, sign };
                    Span { from: event(-1), to: event(1), shown: false, doubtful: true }
                }
            },
        };
        let mut span = span;
        // The node's bound holds for it, too.
        let pass = &mut span.from.pass;
        pass.lo = pass.lo.max(node.lo).min(pass.hi);
        pass.s = pass.s.max(pass.lo);
        self.unite(span);
    }

    /// Unites a span with those that it touches.
    #[inline(always)]
    fn unite(&mut self, mut span: Span) {
        let line = self.line;
        let spans = &mut self.lists.spans;
        // How many spans end before this one begins.
        let mut before = 0;
        let mut i = 0;
        while i < spans.len() {
            let other = spans[i];
            // Spans whose order is unknown count as touching.
            let ahead = line.compare(&span.from, &other.to).unwrap_or(Ordering::Equal);
            if ahead.is_gt() {
                before = i + 1;
                i += 1;
                continue;
            }
            if line.compare(&other.from, &span.to).unwrap_or(Ordering::Equal).is_gt() {
                i += 1;
                continue;
            }
            let first = line.compare(&other.from, &span.from);
            let last = line.compare(&other.to, &span.to);
            let from = pick(&other.from, &span.from, first, Ordering::Less);
            let to = pick(&other.to, &span.to, last, Ordering::Greater);
            let doubtful = span.doubtful && other.doubtful;
            span = Span { from, to, shown: span.shown || other.shown, doubtful };
            spans.remove(i);
        }
        spans.insert(before, span);
    }

    /// Passes on the crossings that are final if no node in the queue begins before `until`.
    #[inline(always)]
    fn show(&mut self, until: f64) -> ControlFlow<()> {
        while let Some(&span) = self.lists.spans.first() {
            let is_final = span.to.pass.hi < until || until == f64::INFINITY;
            if !span.shown {
                let is_known = span.from.pass.hi < until && span.from.pass.hi < span.to.pass.lo;
                if !is_final && !is_known {
                    return ControlFlow::Continue(());
                }
                let touch = if is_known { None } else { self.line.compare(&span.from, &span.to) };
                if touch == Some(Ordering::Equal) {
                    self.lists.spans.remove(0);
                    self.pass_on(&span.from, 0, RootKind::Grazing)?;
                    continue;
                }
                let kind = if span.doubtful || (!is_known && touch.is_none()) {
                    RootKind::Cluster
                } else {
                    RootKind::Simple
                };
                self.lists.spans[0].shown = true;
                self.pass_on(&span.from, -1, kind)?;
            }
            if !is_final {
                return ControlFlow::Continue(());
            }
            self.lists.spans.remove(0);
            let kind = if span.doubtful { RootKind::Cluster } else { RootKind::Simple };
            self.pass_on(&span.to, 1, kind)?;
        }
        ControlFlow::Continue(())
    }

    /// Passes on a crossing, if it is in the ray's range.
    #[inline(always)]
    fn pass_on(&mut self, event: &Event, sign: i8, kind: RootKind) -> ControlFlow<()> {
        let at = self.line.at;
        if event.pass.lo > self.end || event.pass.hi < self.begin {
            return ControlFlow::Continue(());
        }
        let (mut lo, mut hi) = at.bracket(event.pass.lo, event.pass.hi);
        if at.admits(lo, hi) == Some(false) {
            return ControlFlow::Continue(());
        }
        let (near, far) = self.sink.range();
        if hi < near || lo > far {
            return ControlFlow::Continue(());
        }
        let mut event = *event;
        let unit = (at.shift() + event.pass.s).abs().max(0.5);
        let most = if at.local().rough { 0.5 * PREVIEW_WIDTH } else { NARROW } * unit;
        let is_wide = |event: &Event| {
            let width = event.pass.hi - event.pass.lo;
            // False if it is NaN.
            let narrow = width <= most;
            !narrow
        };
        if is_wide(&event) {
            event = self.line.refined(&event, most);
            (lo, hi) = at.bracket(event.pass.lo, event.pass.hi);
        }
        match at.admits(lo, hi) {
            Some(false) => return ControlFlow::Continue(()),
            Some(true) => {}
            None if self.is_beyond(&event, (lo, hi), sign) => return ControlFlow::Continue(()),
            None => {}
        }
        // The planes of two faces may be nearer to each other than the bracket is wide.
        if !event.pass.sure
            && let Some(face) = self.line.face(&event)
        {
            event.pass.face = face;
        }
        let ray = at.local();
        let (lo, hi) = (lo.max(ray.t_min), hi.min(ray.t_max));
        let t = at.t(event.pass.s).max(lo).min(hi).max(self.least).clamp(f64::MIN, f64::MAX);
        self.least = t;
        let Pass { s, face, .. } = event.pass;
        let flow = self.sink.push(Root { t, lo, hi: hi.max(t), s, tag: tag(event.word), face, sign, kind });
        self.end = self.end.min(at.window((ray.t_min, ray.t_max.min(self.sink.limit()))).1);
        flow
    }

    /// Whether a crossing whose bracket holds an end of the range lies beyond it.
    #[cold]
    #[inline(never)]
    fn is_beyond(&self, event: &Event, (lo, hi): (f64, f64), sign: i8) -> bool {
        let at = self.line.at;
        let beyond = |end: End, away: Ordering| {
            let value = at.end(end);
            if !(lo <= value && value <= hi) {
                return false;
            }
            match self.line.against(event, end) {
                Some(order) => order == away,
                // For a ray that is not exactly known, only the side of its start may be certain.
                None => match (end, at.spawned()) {
                    (End::Min, Some((RaySide::Front, ..))) => sign > 0,
                    (End::Min, Some((RaySide::Back, ..))) => sign < 0,
                    _ => false,
                },
            }
        };
        beyond(End::Min, Ordering::Less) || beyond(End::Max, Ordering::Greater)
    }
}

/// The first (for `wanted` less) or last of two ends, by the order of `a` and `b`. If the order is
/// unknown, its bracket holds that end for either order.
#[inline(always)]
fn pick(a: &Event, b: &Event, order: Option<Ordering>, wanted: Ordering) -> Event {
    match order {
        Some(order) if order == wanted || order.is_eq() => *a,
        Some(_) => *b,
        None => {
            let (p, q) = (&a.pass, &b.pass);
            let is_a = if wanted.is_lt() { p.s <= q.s } else { p.s >= q.s };
            let mut it = if is_a { *a } else { *b };
            (it.pass.lo, it.pass.hi) = if wanted.is_lt() {
                (p.lo.min(q.lo), p.hi.min(q.hi))
            } else {
                (p.lo.max(q.lo), p.hi.max(q.hi))
            };
            it.pass.sure = false;
            it.pass.s = it.pass.s.max(it.pass.lo).min(it.pass.hi);
            it
        }
    }
}
