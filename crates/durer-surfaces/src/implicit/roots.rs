//! The roots of a ray: the ray's stretch inside the container, divided by cells, isolated, and
//! merged with the container's own crossings.

use super::Isosurface;
use super::coincident_face;
use super::isolate::{MOST_PASSES, isolate, trimmed};
use super::line::BoundedLine;
use super::octree::CellLookup;
use super::polynomial::isolate_powers;
use super::root_isolator::{CertifiedFunction, Found, RootIsolator, SignInfo};
use super::superellipsoid::convex::Answer;
use crate::{CentredRay, LocalRay, Root, RootKind, Sink};
use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use durer_math::RaySide;

/// The container's crossings, at most two, or the one point in which a line touches it.
#[derive(Default)]
struct Caps(ArrayVec<Root, 4>);

impl Sink for Caps {
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if self.0.try_push(root).is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Passes on roots inside the container. Within rounding a root may seem to lie beyond the
/// container's crossing; it is then moved there, and its bracket is widened if necessary. Nothing
/// depends on earlier roots, so a root is the same for every range.
struct Held<'s> {
    sink: &'s mut dyn Sink,
    from: f64,
    to: f64,
}

impl Sink for Held<'_> {
    fn range(&self) -> (f64, f64) {
        self.sink.range()
    }

    fn limit(&self) -> f64 {
        self.sink.limit()
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        let t = root.t.max(self.from).min(self.to);
        self.sink.push(Root { t, lo: root.lo.min(t), hi: root.hi.max(t), ..root })
    }
}

impl Isosurface {
    /// Passes all roots to `sink`, ascending.
    pub(super) fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        match self.gauge.as_ref().map_or(Answer::Open, |gauge| gauge.roots(ray, sink)) {
            Answer::All => {}
            Answer::Between(lo, hi) => self.roots_between(ray, (lo, hi), sink),
            Answer::Open => self.roots_of_the_tape(ray, sink),
        }
    }

    /// The roots between two parameters beyond which everything is outside.
    #[cold]
    #[inline(never)]
    fn roots_between(&self, ray: &LocalRay<'_>, (lo, hi): (f64, f64), sink: &mut dyn Sink) {
        let at = self.centred(ray);
        let line = BoundedLine::new(&at, lo.abs().max(hi.abs()));
        let ends = ray.rough.then(|| at.ends((ray.t_min, ray.t_max)));
        let mut tracker = RootIsolator::new(&line, &self.tape, Some(true), ends);
        let mut passes = 0;
        let mut show = |found: Option<Found>| found.is_none_or(|it| shown(&at, sink, &it).is_continue());
        let told = isolate(&line, &self.tape, (lo, hi), &mut passes, &mut |a, b, verdict| {
            show(tracker.take(a, b, verdict, &self.tape))
        });
        if told {
            show(tracker.finish(Some(true)));
        }
    }

    /// A ray relative to the container's centre.
    pub(super) fn centred<'a>(&self, ray: &'a LocalRay<'a>) -> CentredRay<'a> {
        let bounds = self.container.bounds();
        ray.recentre(bounds.centre(), 0).sharp(0.5 * (bounds.max - bounds.min).max_abs())
    }

    /// All roots of any formula, by its tape.
    pub(super) fn roots_of_the_tape(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let mut whole = *ray;
        (whole.t_min, whole.t_max, whole.source) = (f64::NEG_INFINITY, f64::INFINITY, None);
        // At a rim the formula's sign decides whether there is a hit, so narrow brackets are needed
        // for pictures, too.
        whole.rough = false;
        let mut caps = Caps::default();
        self.container.roots(&whole, &mut caps);
        let [entry, exit] = match caps.0.as_slice() {
            [entry, exit] => [entry, exit],
            [touch] => return self.touched(ray, touch, sink),
            _ => return,
        };
        if exit.hi < ray.t_min || entry.lo > ray.t_max {
            return;
        }
        // A range that begins behind the container, or ends before it, by less than a bracket:
        // decided exactly.
        let is_within = |t_min: f64, t_max: f64, root: &Root| {
            let mut part = whole;
            (part.t_min, part.t_max) = (t_min, t_max);
            let mut caps = Caps::default();
            self.container.roots(&part, &mut caps);
            caps.0.iter().any(|r| r.sign == root.sign)
        };
        let ends_before = exit.lo < ray.t_min && !is_within(ray.t_min, f64::INFINITY, exit);
        let begins_behind = entry.hi > ray.t_max && !is_within(f64::NEG_INFINITY, ray.t_max, entry);
        if ray.source.is_none() && (ends_before || begins_behind) {
            return;
        }
        let at = self.centred(ray);
        let (in_lo, in_hi) = at.window((entry.lo, entry.hi));
        let (out_lo, out_hi) = at.window((exit.lo, exit.hi));
        let line = BoundedLine::new(&at, in_lo.abs().max(out_hi.abs()));
        let mut held = Held { sink, from: entry.t, to: exit.t };
        let mut query = Query { surface: self, ray, at: &at, line: &line, sink: &mut held };
        query.run(&[(*entry, in_lo, in_hi), (*exit, out_lo, out_hi)]);
    }
}

impl Isosurface {
    /// Passes on the point where a line only touches the container, if the formula holds there. A
    /// regular solid has no such points.
    #[cold]
    #[inline(never)]
    fn touched(&self, ray: &LocalRay<'_>, touch: &Root, sink: &mut dyn Sink) {
        if self.regular || touch.sign != 0 {
            return;
        }
        let at = self.centred(ray);
        let stretch = at.window((touch.lo, touch.hi));
        let line = BoundedLine::new(&at, stretch.0.abs().max(stretch.1.abs()));
        let told = self.sign_on(&line, stretch);
        if !told.unwrap_or_else(|| self.rounded(&line, stretch)) {
            let kind = if told.is_some() { touch.kind } else { RootKind::Cluster };
            let _ = self.cap(ray, &Root { kind, ..*touch }, sink);
        }
    }

    /// Passes on a crossing of the container, or a touch, if it is in the ray's range.
    fn cap(&self, ray: &LocalRay<'_>, cap: &Root, sink: &mut dyn Sink) -> ControlFlow<()> {
        self.cap_or_rim(ray, cap, (f64::INFINITY, f64::NEG_INFINITY), sink)
    }

    /// Passes on a crossing of the container in a bracket that also holds an adjacent stretch.
    fn cap_or_rim(
        &self,
        ray: &LocalRay<'_>,
        cap: &Root,
        beside: (f64, f64),
        sink: &mut dyn Sink,
    ) -> ControlFlow<()> {
        if self.open {
            return ControlFlow::Continue(());
        }
        let mut own = *ray;
        if own.source_face == 0 {
            own.source = None;
        } else {
            own.source_face -= 1;
        }
        let mut caps = Caps::default();
        self.container.roots(&own, &mut caps);
        match caps.0.iter().find(|root| root.sign == cap.sign) {
            Some(root) => {
                let (lo, hi) = (root.lo.min(beside.0), root.hi.max(beside.1));
                sink.push(Root { lo, hi, face: root.face + 1, kind: cap.kind, ..*root })
            }
            None => ControlFlow::Continue(()),
        }
    }

    /// The sign of the formula on a short stretch of a line, if it is certain from the cell or its
    /// tape.
    fn sign_on(&self, line: &BoundedLine, (lo, hi): (f64, f64)) -> Option<bool> {
        let (middle, reach) = line.around(lo, hi);
        match self.divided().place(middle, reach) {
            Some(CellLookup::Sign(sign)) => Some(sign),
            Some(CellLookup::Open(tape) | CellLookup::Slope(tape, _)) => line.sign_on(tape, lo, hi),
            Some(CellLookup::Gap) | None => line.sign_on(&self.tape, lo, hi),
        }
    }

    /// Whether a solid's formula is defined and may be zero where the line crosses the container.
    fn is_rim(&self, line: &BoundedLine, (lo, hi): (f64, f64)) -> bool {
        let v = line.bounds(&self.tape, &[lo; 8], &[hi; 8]);
        let defined = (v.partial | v.empty) & 1 == 0;
        !self.open && defined && v.lo.0[0] <= 0.0 && v.hi.0[0] >= 0.0
    }

    /// The sign of the rounded value there. Undefined counts as outside.
    fn rounded(&self, line: &BoundedLine, (lo, hi): (f64, f64)) -> bool {
        let within = line.value(&self.tape, 0.5 * lo + 0.5 * hi) < 0.0;
        !within
    }
}

/// A query of a ray in progress.
struct Query<'a> {
    surface: &'a Isosurface,
    ray: &'a LocalRay<'a>,
    at: &'a CentredRay<'a>,
    line: &'a BoundedLine,
    sink: &'a mut dyn Sink,
}

impl Query<'_> {
    /// A ray that was spawned on the formula's own surface starts on a known side. Any other ray is
    /// treated as the whole line up to the end of its range, so it has the same roots for every
    /// range: an unresolved stretch across an end of the range is one cluster for both sides of it.
    fn run(&mut self, [entry, exit]: &[(Root, f64, f64); 2]) {
        let (from, to) = self.at.window((self.ray.t_min, self.ray.t_max));
        let within = from > entry.2;
        let start = match self.ray.source {
            Some(side) if within && self.ray.source_face == 0 && self.ray.t_min == 0.0 => {
                Start { at: from, before: side == RaySide::Front, rim: None }
            }
            _ => self.start(entry.1, entry.2),
        };
        let enters = !within && !start.before && start.rim.is_none();
        if enters && self.surface.cap(self.ray, &entry.0, self.sink).is_break() {
            return;
        }
        let slack = 16.0 * self.line.ulp;
        let range = (from - slack, if to < exit.1 { to + slack } else { f64::INFINITY });
        let end = (exit.1, exit.2);
        let after = match start.rim {
            _ if start.at < end.1 => {
                self.between(&start, end, range, [(!within).then_some(&entry.0), Some(&exit.0)])
            }
            // The line has nothing but the container's edge.
            Some(lo) => {
                let (hi, kind) = (end.1, RootKind::Cluster);
                let s = (0.5 * lo + 0.5 * hi).max(lo).min(hi);
                let _ = shown(self.at, self.sink, &Found { s, lo, hi, sign: 0, kind, touches: None });
                None
            }
            None => Some(self.declared(end.0, end.1)),
        };
        if after == Some(false) {
            let _ = self.surface.cap(self.ray, &exit.0, self.sink);
        }
    }

    /// The start of the line inside the container, between two places. If the formula's sign is
    /// unknown there, its surface may meet the container's face in a rim; then the line begins
    /// outside with that unresolved stretch. A sheet has no such face.
    fn start(&self, lo: f64, hi: f64) -> Start {
        match self.surface.sign_on(self.line, (lo, hi)) {
            Some(before) => Start { at: lo, before, rim: None },
            None if self.surface.is_rim(self.line, (lo, hi)) => Start { at: hi, before: true, rim: Some(lo) },
            None => Start { at: lo, before: self.declared(lo, hi), rim: None },
        }
    }

    /// The formula's sign where the line crosses the container: the certain one, or else that of
    /// the rounded value. Undefined counts as outside.
    fn declared(&self, lo: f64, hi: f64) -> bool {
        let at = (lo, hi);
        self.surface.sign_on(self.line, at).unwrap_or_else(|| self.surface.rounded(self.line, at))
    }

    /// Passes on the roots from the start to the end of the container that may be in `range`.
    /// Returns the sign at that end; `None` if it was not needed, or is that of a rim, which was
    /// passed on.
    fn between(
        &mut self,
        start: &Start,
        end: (f64, f64),
        range: (f64, f64),
        [entry, exit]: [Option<&Root>; 2],
    ) -> Option<bool> {
        let surface = self.surface;
        let ends = self.ray.rough.then(|| self.at.ends((self.ray.t_min, self.ray.t_max)));
        let mut walk = Walk {
            surface,
            line: self.line,
            at: self.at,
            sink: self.sink,
            tracker: RootIsolator::new(self.line, &surface.tape, Some(start.before), ends),
            last: range.1,
            passes: 0,
            rim: start.rim.map(|_| entry),
        };
        let a = start.at;
        if let Some(rim) = start.rim {
            let _ = walk.tracker.take(rim, a, SignInfo::Unresolved, &surface.tape);
        }
        if let Some(degree) = surface.degree {
            return if walk.all(degree, (a, end.1)) { walk.end(end, exit) } else { None };
        }
        // The cells before the range that may hold surface, after the last one that certainly holds
        // none.
        let mut ahead = Vec::new();
        let mut go_on = true;
        surface.divided().walk(self.line, (a, end.1), &mut |a, b, place| {
            if b >= range.0 {
                go_on = ahead.drain(..).all(|(a, b, place)| walk.take(a, b, place)) && walk.take(a, b, place);
            } else if let CellLookup::Open(_) | CellLookup::Slope(..) = place {
                ahead.push((a, b, place));
            } else {
                ahead.clear();
                go_on = walk.take(a, b, place);
            }
            go_on
        });
        if !(go_on && ahead.drain(..).all(|(a, b, place)| walk.take(a, b, place))) {
            return None;
        }
        walk.end(end, exit)
    }
}

/// The start of the walk, and the formula's sign there.
struct Start {
    at: f64,
    before: bool,
    /// If the sign is unknown from here on: where the container's face begins.
    rim: Option<f64>,
}

/// A walk along the cells of a ray.
struct Walk<'a, 's> {
    surface: &'a Isosurface,
    line: &'a BoundedLine,
    at: &'a CentredRay<'a>,
    sink: &'s mut dyn Sink,
    tracker: RootIsolator<'a, BoundedLine>,
    /// Roots beyond this do not matter.
    last: f64,
    passes: u32,
    /// If set, the next root lies at a rim with this crossing of the container; the inner `None` is
    /// a crossing out of the ray's range.
    rim: Option<Option<&'a Root>>,
}

impl<'a> Walk<'a, '_> {
    /// Isolates the roots on a whole stretch of a polynomial formula. Returns whether to continue.
    fn all(&mut self, degree: usize, ends: (f64, f64)) -> bool {
        let (line, tape, mut passes) = (self.line, &self.surface.tape, self.passes);
        let go_on = isolate_powers((line, tape, degree), ends, &mut passes, &mut |a, b, verdict| {
            if self.is_beyond(a) {
                return false;
            }
            let found = self.tracker.take(a, b, verdict, tape);
            self.show(found)
        });
        self.passes = passes;
        go_on
    }

    /// Whether no root from `a` on matters.
    fn is_beyond(&self, a: f64) -> bool {
        self.tracker.is_idle() && (a > self.last || self.at.bracket(a, a).0 > self.sink.limit())
    }

    /// The sign where the container ends; `None` if a rim there was passed on, or if no more roots
    /// are wanted.
    fn end(&mut self, end: (f64, f64), exit: Option<&'a Root>) -> Option<bool> {
        let surface = self.surface;
        // The walk's own result takes precedence over a rounded value.
        let told = self.tracker.settled();
        let after = surface.sign_on(self.line, end).or(told);
        if after.is_none() && surface.is_rim(self.line, end) {
            // A root found before that is separate.
            let found = self.tracker.take(end.0, end.1, SignInfo::Unresolved, &surface.tape);
            if !self.show(found) {
                return None;
            }
            let found = self.tracker.finish(Some(true));
            self.rim = Some(exit);
            self.show(found);
            return None;
        }
        let after = after.unwrap_or_else(|| surface.rounded(self.line, end));
        let found = self.tracker.finish(Some(after));
        if self.show(found) { Some(after) } else { None }
    }

    /// Isolates the roots in the next cell's stretch. Returns whether to continue.
    fn take(&mut self, a: f64, b: f64, place: CellLookup<'a>) -> bool {
        if self.is_beyond(a) {
            return false;
        }
        let whole = &self.surface.tape;
        let found = match place {
            CellLookup::Sign(sign) => self.tracker.settle(sign),
            CellLookup::Gap => self.tracker.take(a, b, SignInfo::Gap, whole),
            CellLookup::Slope(tape, rises) => self.tracker.take(a, b, SignInfo::Monotone(rises), tape),
            CellLookup::Open(tape) => {
                let (line, mut passes) = (self.line, self.passes);
                let go_on = isolate(line, tape, (a, b), &mut passes, &mut |a, b, verdict| {
                    let found = self.tracker.take(a, b, verdict, tape);
                    self.show(found) && !(self.tracker.is_idle() && b > self.last)
                });
                self.passes = passes;
                return go_on;
            }
        };
        self.show(found)
    }

    /// Passes on a root. A touch from outside does not belong to a regular surface, unless the ray
    /// runs along a face that two of its parts share, which is inside.
    fn show(&mut self, found: Option<Found>) -> bool {
        let rim = if found.is_some() { self.rim.take() } else { None };
        let flow = match found {
            None => ControlFlow::Continue(()),
            Some(found) if rim.is_some() && found.sign != 0 => match rim.flatten() {
                Some(cap) => self.show_rim(cap, &found),
                None => ControlFlow::Continue(()),
            },
            Some(Found { touches: Some(outside), lo, hi, .. }) if self.surface.regular => {
                if outside {
                    self.along_a_face(lo, hi)
                } else {
                    ControlFlow::Continue(())
                }
            }
            // When the passes are used up, the rest may be much longer than the unresolved part.
            Some(found) if found.kind == RootKind::Cluster && self.passes >= MOST_PASSES => {
                shown(self.at, self.sink, &trimmed(self.line, &self.surface.tape, found))
            }
            Some(found) => shown(self.at, self.sink, &found),
        };
        flow.is_continue()
    }

    /// Passes on a crossing at a rim, on the container's face or next to it: one crossing, reported
    /// as the container's.
    #[cold]
    #[inline(never)]
    fn show_rim(&mut self, cap: &Root, found: &Found) -> ControlFlow<()> {
        let (lo, hi) = self.at.bracket(found.lo.next_down(), found.hi.next_up());
        let ray = self.at.local();
        let lo = if ray.source.is_some() && ray.t_min == 0.0 { lo.max(0.0) } else { lo };
        self.surface.cap_or_rim(ray, cap, (lo, hi), self.sink)
    }

    #[cold]
    #[inline(never)]
    fn along_a_face(&mut self, lo: f64, hi: f64) -> ControlFlow<()> {
        let (at, sink) = (self.at, &mut *self.sink);
        let told = coincident_face::crossings(
            self.line,
            &self.surface.tape,
            (lo, hi),
            (false, false),
            &mut |found| shown(at, sink, found),
        );
        told.unwrap_or(ControlFlow::Continue(()))
    }
}

/// Passes on a root of the formula, unless it is certainly out of the ray's range.
pub(super) fn shown(at: &CentredRay<'_>, sink: &mut dyn Sink, found: &Found) -> ControlFlow<()> {
    let (mut lo, hi) = at.bracket(found.lo.next_down(), found.hi.next_up());
    if at.admits(lo, hi) == Some(false) {
        return ControlFlow::Continue(());
    }
    let ray = at.local();
    if ray.source.is_some() && ray.t_min == 0.0 && ray.source_face == 0 {
        lo = lo.max(0.0).min(hi);
    }
    let t = at.t(found.s).max(lo).min(hi);
    sink.push(Root { t, lo, hi, s: found.s, tag: [0.0; 2], face: 0, sign: found.sign, kind: found.kind })
}
