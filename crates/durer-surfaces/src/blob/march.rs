//! A blob along a ray: fields begin and end, and between two such points the sum is one polynomial.
//!
//! The points are rounded, and nothing is lost by that: `(1 - q)²` has a double zero where the
//! field begins, and so have, along the axis, the differences between a cylinder's segments. An
//! error `δ` of a point adds an error of order `δ²` to the sum, which is included. The same
//! argument helps where a crossing is so near such a point that the sign there is unknown: the
//! stretch is then extended a little beyond it.

use super::Blob;
use super::component::{FieldSegment, REACH};
use super::refine::{Bracket, Touch};
use super::segment::{SegmentRoot, Stretch};
use super::tree::{Inner, is_known};
use crate::{CentredRay, End, PREVIEW_WIDTH, Root, RootKind, Sink};
use core::cell::Cell;
use core::ops::ControlFlow;
use durer_math::{EFloat, Isa, RaySide, U, Vec3};
use durer_roots::quadratic::NARROW;

/// A ray in the frame of a blob, in units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Along {
    pub(crate) o: Vec3,
    pub(crate) d: Vec3,
    pub(crate) inverse: Vec3,
    /// Bounds on the errors along any axis.
    pub(super) o_err: f64,
    pub(super) d_err: f64,
    /// The largest coordinate of `o`.
    pub(super) o_size: f64,
    /// Whether the boxes leave room for the ray's errors.
    pub(crate) known: bool,
}

impl Along {
    #[inline(always)]
    pub(crate) fn new(at: &CentredRay<'_>) -> Self {
        let inverse = Vec3::new(1.0 / at.d.x, 1.0 / at.d.y, 1.0 / at.d.z);
        let (o_err, d_err) = (at.o_err.max_abs(), at.d_err.max_abs());
        let known = is_known(o_err, d_err);
        Self { o: at.o, d: at.d, inverse, o_err, d_err, o_size: at.o.max_abs(), known }
    }
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
struct Lists {
    /// Nodes not yet opened, with their entries.
    nodes: Vec<(f64, u32)>,
    /// All segments found so far.
    pieces: Vec<FieldSegment>,
    /// Segments still ahead, the nearest last.
    waiting: Vec<u32>,
    /// Segments at the current point.
    active: Vec<u32>,
}

impl Lists {
    fn clear(&mut self) {
        self.nodes.clear();
        self.pieces.clear();
        self.waiting.clear();
        self.active.clear();
    }
}

thread_local! {
    static LISTS: Cell<Lists> = Cell::default();
}

/// The state of the march, and the crossings that are not yet reported.
struct CrossingLog {
    /// Whether the sum is above the threshold before `open`.
    before: Option<bool>,
    /// The unresolved stretch.
    open: Option<(f64, f64)>,
    least: f64,
}

struct Query<'a> {
    blob: &'a Blob,
    at: &'a CentredRay<'a>,
    line: Along,
    sink: &'a mut dyn Sink,
    lists: Lists,
    /// A bound on the fields of all segments that are treated as absent, and on its rate of change.
    charge: f64,
    bent: f64,
    /// The ends of the ray's range, each within rounding.
    ends: [(f64, f64); 2],
    /// Crossings beyond this do not matter.
    last: f64,
    /// Nothing before this is examined.
    begin: f64,
    /// For a ray that was spawned on the surface: whether it starts inside, and where.
    start: Option<(bool, EFloat)>,
    tracker: CrossingLog,
    /// An unresolved stretch reaches over the beginning, so the sign before it is unknown: the
    /// whole ray must be examined.
    blind: bool,
}

/// Passes all crossings to `sink`, ascending.
#[inline(always)]
pub(super) fn roots(blob: &Blob, at: &CentredRay<'_>, sink: &mut dyn Sink) {
    let line = Along::new(at);
    let ray = at.local();
    let mut lists = LISTS.take();
    lists.clear();
    let ends = at.ends((ray.t_min, ray.t_max));
    let window = at.window((ray.t_min, ray.t_max.min(sink.limit())));
    let start = at.spawned().map(|(side, _, s)| (side == RaySide::Back, s));
    // A little before the range, where the sign is more likely to be known than at its very start.
    let begin = start.map_or(window.0 - 1.0 / 1024.0, |(_, s)| s.v);
    let mut begin = begin;
    loop {
        let tracker = CrossingLog { before: None, open: None, least: f64::NEG_INFINITY };
        let last = window.1;
        let mut query = Query {
            blob,
            at,
            line,
            sink,
            lists,
            charge: 0.0,
            bent: 0.0,
            ends,
            last,
            begin,
            start,
            tracker,
            blind: false,
        };
        query.meet(0);
        query.run();
        lists = query.lists;
        if !query.blind {
            break;
        }
        begin = f64::NEG_INFINITY;
        lists.clear();
    }
    LISTS.set(lists);
}

impl Query<'_> {
    /// Adds a node to the list, if the ray meets it.
    #[inline(always)]
    fn meet(&mut self, node: u32) {
        if let Some((near, far)) = self.blob.tree.entry(node, &self.line)
            && far >= self.begin
        {
            self.lists.nodes.push((near, node));
        }
    }

    /// Opens nodes until all segments that begin before `s` are known, or the next one that begins.
    /// Returns where it begins.
    #[inline(always)]
    fn reveal(&mut self, s: f64) -> f64 {
        loop {
            let next =
                self.lists.waiting.last().map_or(f64::INFINITY, |&i| self.lists.pieces[i as usize].from);
            let nearest = (0..self.lists.nodes.len())
                .reduce(|a, b| if self.lists.nodes[b].0 < self.lists.nodes[a].0 { b } else { a });
            match nearest {
                Some(i) if self.lists.nodes[i].0 < next.min(s) => {
                    let (_, node) = self.lists.nodes.swap_remove(i);
                    self.open(node);
                }
                _ => return next,
            }
        }
    }

    #[inline(always)]
    fn open(&mut self, node: u32) {
        match self.blob.tree.inner(node) {
            Inner::Nodes(a, b) => {
                self.meet(a);
                self.meet(b);
            }
            Inner::Leaf(from, to) => {
                let (lists, bent) = (&mut self.lists, &mut self.bent);
                let begin = self.begin;
                for part in &self.blob.parts[from..to] {
                    part.pieces(
                        &self.line,
                        &mut self.charge,
                        #[inline(always)]
                        |piece| {
                            *bent += piece.strength.abs() * piece.seam * piece.speed;
                            if piece.to < begin {
                                return;
                            }
                            let behind = |&i: &u32| lists.pieces[i as usize].from > piece.from;
                            let place = lists.waiting.iter().rposition(behind).map_or(0, |i| i + 1);
                            lists.waiting.insert(place, lists.pieces.len() as u32);
                            lists.pieces.push(piece);
                        },
                    );
                }
            }
        }
    }

    #[inline(always)]
    fn run(&mut self) {
        let mut here = -REACH;
        loop {
            let leave = self
                .lists
                .active
                .iter()
                .fold(f64::INFINITY, |least: f64, &i| least.min(self.lists.pieces[i as usize].to));
            // Segments that begin within a stretch must be known, also beyond the part that
            // matters.
            let ahead = if self.lists.active.is_empty() { self.last } else { leave };
            let next = self.reveal(ahead).min(leave);
            if (here > self.last && self.tracker.open.is_none()) || next == f64::INFINITY {
                break;
            }
            if self.lists.active.is_empty() {
                if self.report(SegmentRoot::Sign(false)).is_break() {
                    return;
                }
                here = next;
            } else if next <= self.begin {
                self.tracker.before = None;
                here = next;
            } else {
                match self.stretch(here, next) {
                    Some(end) => here = end,
                    None => return,
                }
            }
            let lists = &mut self.lists;
            let pieces = &lists.pieces;
            lists.active.retain(|&i| pieces[i as usize].to > here);
            while let Some(&i) = lists.waiting.last()
                && pieces[i as usize].from <= here
            {
                lists.waiting.pop();
                if pieces[i as usize].to > here {
                    lists.active.push(i);
                }
            }
        }
        // Behind the last field the sum is zero. A ray that ends within a field may leave an
        // unresolved stretch open.
        let after = self.lists.active.is_empty().then_some(false);
        let _ = self.close(after);
    }

    /// The polynomial on a stretch.
    #[inline(always)]
    fn sum(&self, lo: f64, hi: f64) -> Stretch {
        let mid = 0.5 * (lo + hi);
        let half = (0.5 * (hi - lo)).mul_add(1.0 + 4.0 * U, mid.abs() * (2.0 * U) + f64::MIN_POSITIVE);
        let mut c = [-self.blob.threshold, 0.0, 0.0, 0.0, 0.0];
        let (mut slack, mut size, mut count) = (self.charge, self.blob.threshold, 4.0);
        for &i in &self.lists.active {
            let piece = &self.lists.pieces[i as usize];
            piece.add(mid, half, &mut c);
            slack += piece.slack;
            size += piece.size;
            count += 1.0;
        }
        let slack = (count * U).mul_add(size, slack) * (1.0 + (count + 16.0) * U);
        Stretch { mid, half, c, slack, bent: 5.0 * half * self.bent }
    }

    /// Classifies a stretch. Returns its end, `hi` or a little beyond; `None` if nothing more is
    /// wanted.
    #[inline(always)]
    fn stretch(&mut self, lo: f64, hi: f64) -> Option<f64> {
        let most = self.lists.active.iter().fold(0.0, |sum, &i| sum + self.lists.pieces[i as usize].peak);
        if (most + self.charge) * (1.0 + 1.0 / 1024.0) < self.blob.threshold {
            return (self.report(SegmentRoot::Sign(false)).is_continue()).then_some(hi);
        }
        // The previous stretch's result at its end is certain for the sum itself, though rounding
        // may hide it here.
        let told = if self.tracker.open.is_none() { self.tracker.before } else { None };
        // So is the start of a ray that was spawned on the surface.
        let (mut lo, mut first, mut late) = (lo, told, 0.0);
        if lo < self.begin {
            (lo, first) = (self.begin, None);
            if let Some((within, s)) = self.start {
                (first, late) = (Some(within), s.e);
            }
            (self.tracker.before, self.tracker.open) = (first, None);
        }
        let delayed = |mut it: Stretch| {
            if late > 0.0 {
                let size = it.c.iter().fold(0.0, |sum, c| sum + c.abs());
                it.slack += 5.0 * size * (late / it.half).min(1.0);
            }
            it
        };
        let mut stretch = delayed(self.sum(lo, hi));
        let mut form = stretch.form();
        if let Some(sign) = stretch.sign(&form) {
            return (self.report(SegmentRoot::Sign(sign)).is_continue()).then_some(hi);
        }
        let mut end = hi;
        if stretch.sign_at_end(&form).is_none() {
            let speed = self
                .lists
                .active
                .iter()
                .fold(0.0, |most: f64, &i| most.max(self.lists.pieces[i as usize].speed));
            for k in [-46, -42, -38, -34, -31, -28] {
                let beyond = hi + durer_math::eft::scale2(1.0, k) / speed;
                self.reveal(beyond + (beyond - hi));
                let mut longer = delayed(self.sum(lo, beyond));
                let (wrong, rate) = self.lists.pieces.iter().fold((0.0, 0.0), |(w, r), piece| {
                    let (wrong, rate) = piece.overrun(hi, beyond);
                    (w + wrong, r + rate)
                });
                longer.slack = (longer.slack + wrong) * (1.0 + 64.0 * U);
                longer.bent += rate * longer.half * (1.0 + 64.0 * U);
                let longer_form = longer.form();
                if longer.sign_at_end(&longer_form).is_some() {
                    (stretch, form, end) = (longer, longer_form, beyond);
                    break;
                }
            }
        }
        let (ends, scale) = (self.ends, self.scale());
        let rough = self.at.local().rough;
        // Pictures, too, must know on which side of an end of the range a crossing lies.
        let widest = |s: f64| {
            let away = |(lo, hi): (f64, f64)| (lo - s).max(s - hi);
            let rough = rough && away(ends[0]).min(away(ends[1])) > 4.0 * PREVIEW_WIDTH * scale(s);
            if rough { PREVIEW_WIDTH * scale(s) } else { NARROW * scale(s) }
        };
        let flow = stretch.classify(
            form,
            first,
            widest,
            #[inline(always)]
            |told| self.report(told),
        );
        (flow.is_continue()).then_some(end)
    }

    #[inline(always)]
    fn report(&mut self, told: SegmentRoot) -> ControlFlow<()> {
        match told {
            SegmentRoot::Sign(sign) => {
                let flow = if self.tracker.open.is_some() {
                    self.close(Some(sign))
                } else {
                    ControlFlow::Continue(())
                };
                self.tracker.before = Some(sign);
                flow
            }
            SegmentRoot::Root { s, lo, hi, rises, alone } => {
                if self.tracker.open.is_some() {
                    self.close(Some(!rises))?;
                }
                self.tracker.before = Some(rises);
                self.crossing(Bracket { s, lo, hi, rises, alone })
            }
            SegmentRoot::Unresolved { .. }
                if self.tracker.before.is_none()
                    && self.tracker.open.is_none()
                    && self.start.is_none()
                    && self.begin > f64::NEG_INFINITY =>
            {
                self.blind = true;
                ControlFlow::Break(())
            }
            SegmentRoot::Unresolved { lo, hi } => {
                let (from, to) = self.tracker.open.unwrap_or((lo, hi));
                self.tracker.open = Some((from, to.max(hi)));
                ControlFlow::Continue(())
            }
        }
    }

    /// The unit for widths of brackets.
    #[inline(always)]
    fn scale(&self) -> impl Fn(f64) -> f64 + use<> {
        let origin = self.at.shift();
        move |s: f64| (origin + s).abs().max(s.abs()).max(0.5)
    }

    /// Reports a crossing between certain signs, in the narrowest bracket; for pictures only where
    /// it may lie on either side of an end of the range.
    fn crossing(&mut self, found: Bracket) -> ControlFlow<()> {
        let (lo, hi) = self.at.bracket(found.lo, found.hi);
        let found = if self.at.local().rough && self.at.admits(lo, hi).is_some() {
            found
        } else {
            let scale = self.scale();
            self.blob.narrowed(self.at, found, |s| NARROW * scale(s))
        };
        let kind = if found.alone { RootKind::Simple } else { RootKind::Cluster };
        self.show(found.s, (found.lo, found.hi), if found.rises { -1 } else { 1 }, kind)
    }

    /// The unresolved stretch ends where the sign is `after`.
    fn close(&mut self, after: Option<bool>) -> ControlFlow<()> {
        let Some((lo, hi)) = self.tracker.open.take() else { return ControlFlow::Continue(()) };
        let s = (0.5 * lo + 0.5 * hi).max(lo).min(hi);
        match (self.tracker.before, after) {
            (Some(before), Some(after)) if before != after => {
                self.crossing(Bracket { s, lo, hi, rises: after, alone: false })
            }
            (Some(within), Some(_)) if self.start.is_none() => self.touch((lo, hi), !within),
            _ => self.show(s, (lo, hi), 0, RootKind::Cluster),
        }
    }

    /// The unresolved stretch ends on the side on which it began.
    #[cold]
    fn touch(&mut self, stretch: (f64, f64), out: bool) -> ControlFlow<()> {
        match self.blob.touched(self.at, stretch, out) {
            Touch::Crossings(found) => {
                for Bracket { s, lo, hi, rises, .. } in found {
                    if self.show(s, (lo, hi), if rises { -1 } else { 1 }, RootKind::Simple).is_break() {
                        return ControlFlow::Break(());
                    }
                }
                ControlFlow::Continue(())
            }
            Touch::Open(lo, hi) => {
                let s = (0.5 * lo + 0.5 * hi).max(lo).min(hi);
                self.show(s, (lo, hi), 0, RootKind::Cluster)
            }
        }
    }

    /// Whether a crossing whose bracket holds an end of the range lies beyond it, decided by the
    /// sign at the end. So the crossing is in exactly one of two ranges that meet there, whatever
    /// its bracket.
    #[cold]
    fn is_beyond(&self, (lo, hi): (f64, f64), sign: i8) -> bool {
        let within = |end: f64| end.is_finite() && lo <= end && end <= hi;
        let leaves = Some(sign > 0);
        self.start.is_none()
            && (within(self.at.end(End::Min)) && self.blob.is_out_at(self.at, End::Min) == leaves
                || within(self.at.end(End::Max)) && self.blob.is_out_at(self.at, End::Max) == Some(sign < 0))
    }

    /// Passes on a root, unless it is certainly out of the ray's range.
    #[inline(never)]
    fn show(&mut self, s: f64, ends: (f64, f64), sign: i8, kind: RootKind) -> ControlFlow<()> {
        Isa::detect().run(
            #[inline(always)]
            || self.show_here(s, ends, sign, kind),
        )
    }

    #[inline(always)]
    fn show_here(&mut self, s: f64, (lo, hi): (f64, f64), sign: i8, kind: RootKind) -> ControlFlow<()> {
        let (mut lo, hi) = self.at.bracket(lo, hi);
        let admitted = self.at.admits(lo, hi);
        if admitted == Some(false)
            || admitted.is_none() && kind == RootKind::Simple && self.is_beyond((lo, hi), sign)
        {
            return ControlFlow::Continue(());
        }
        if self.start.is_some() {
            lo = lo.max(0.0).min(hi);
        }
        let t = self.at.t(s).max(lo).min(hi).max(self.tracker.least);
        self.tracker.least = t;
        let root = Root { t, lo, hi: hi.max(t), s, tag: [0.0; 2], face: 0, sign, kind };
        let flow = self.sink.push(root);
        let limit = self.sink.limit();
        if limit < f64::INFINITY {
            self.last = self.last.min(self.at.window((limit, limit)).1);
        }
        flow
    }
}
