//! The roots of a ray: the container's stretch of it, divided by cells, told apart, in one row with the caps.

use super::Isosurface;
use super::along_face;
use super::cells::Place;
use super::isolate::isolate;
use super::line::Line;
use super::tracker::{Curve, Found, Tracker, Verdict};
use crate::{CentredRay, Flow, Kind, LocalRay, Root, Sink};
use arrayvec::ArrayVec;
use durer_math::RaySide;

/// The container's crossings, at most two, or the one point in which a line touches it.
#[derive(Default)]
struct Caps(ArrayVec<Root, 4>);

impl Sink for Caps {
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn push(&mut self, root: Root) -> Flow {
        if self.0.try_push(root).is_err() { Flow::Stop } else { Flow::Continue }
    }
}

impl Isosurface {
    /// Shows all roots to `sink`, ascending.
    pub(super) fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let told = self.gauge.as_ref().is_some_and(|gauge| gauge.roots(ray, sink));
        if !told {
            self.roots_of_the_tape(ray, sink);
        }
    }

    /// The same for any formula.
    pub(super) fn roots_of_the_tape(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let mut whole = *ray;
        (whole.t_min, whole.t_max, whole.source) = (f64::NEG_INFINITY, f64::INFINITY, None);
        // At a rim the formula's sign there decides whether there is anything: for pictures, too.
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
        // A range that begins behind the container, or ends before it, by less than a bracket: exactly.
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
        let at = ray.recentre(self.container.bounds().centre(), 0);
        let (in_lo, in_hi) = at.window((entry.lo, entry.hi));
        let (out_lo, out_hi) = at.window((exit.lo, exit.hi));
        let line = Line::new(&at, in_lo.abs().max(out_hi.abs()));
        let mut query = Query { surface: self, ray, at: &at, line: &line, sink };
        query.run(&[(*entry, in_lo, in_hi), (*exit, out_lo, out_hi)]);
    }
}

impl Isosurface {
    /// Shows where a line only touches the container, if the formula holds there. A regular solid has no such points.
    #[cold]
    #[inline(never)]
    fn touched(&self, ray: &LocalRay<'_>, touch: &Root, sink: &mut dyn Sink) {
        if self.regular || touch.sign != 0 {
            return;
        }
        let at = ray.recentre(self.container.bounds().centre(), 0);
        let stretch = at.window((touch.lo, touch.hi));
        let line = Line::new(&at, stretch.0.abs().max(stretch.1.abs()));
        let told = self.sign_on(&line, stretch);
        if !told.unwrap_or_else(|| self.rounded(&line, stretch)) {
            let kind = if told.is_some() { touch.kind } else { Kind::Cluster };
            let _ = self.cap(ray, &Root { kind, ..*touch }, sink);
        }
    }

    /// Shows a crossing of the container, or a touch, if it is in the ray's range.
    fn cap(&self, ray: &LocalRay<'_>, cap: &Root, sink: &mut dyn Sink) -> Flow {
        if self.open {
            return Flow::Continue;
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
            Some(root) => sink.push(Root { face: root.face + 1, kind: cap.kind, ..*root }),
            None => Flow::Continue,
        }
    }

    /// The one sign of the formula on a short stretch of a line, if it is certain: the cell knows, or its tape.
    fn sign_on(&self, line: &Line, (lo, hi): (f64, f64)) -> Option<bool> {
        let (middle, reach) = line.around(lo, hi);
        match self.divided().place(middle, reach) {
            Some(Place::Sign(sign)) => Some(sign),
            Some(Place::Open(tape) | Place::Slope(tape, _)) => line.sign_on(tape, lo, hi),
            Some(Place::Gap) | None => line.sign_on(&self.tape, lo, hi),
        }
    }

    /// The sign of the rounded value there. Undefined is outside.
    fn rounded(&self, line: &Line, (lo, hi): (f64, f64)) -> bool {
        let within = line.value(&self.tape, 0.5 * lo + 0.5 * hi) < 0.0;
        !within
    }
}

/// A ray's question, half answered.
struct Query<'a> {
    surface: &'a Isosurface,
    ray: &'a LocalRay<'a>,
    at: &'a CentredRay<'a>,
    line: &'a Line,
    sink: &'a mut dyn Sink,
}

impl Query<'_> {
    /// A ray that was spawned on the formula's own surface starts on a side that is known. Any other one is looked at as the whole line is, as far as its range
    /// reaches, so that it has the same roots whatever its range is: what could not be told across an end of the range is one cluster for both sides of it.
    fn run(&mut self, [entry, exit]: &[(Root, f64, f64); 2]) {
        let (from, to) = self.at.window((self.ray.t_min, self.ray.t_max));
        let within = from > entry.2;
        let (a, before) = match self.ray.source {
            Some(side) if within && self.ray.source_face == 0 && self.ray.t_min == 0.0 => {
                (from, side == RaySide::Front)
            }
            _ => (entry.1, self.declared(entry.1, entry.2)),
        };
        if !within && !before && self.surface.cap(self.ray, &entry.0, self.sink) == Flow::Stop {
            return;
        }
        let slack = 16.0 * self.line.ulp;
        let range = (from - slack, if to < exit.1 { to + slack } else { f64::INFINITY });
        let end = (exit.1, exit.2);
        let after =
            if a < end.1 { self.between(a, end, before, range) } else { Some(self.declared(end.0, end.1)) };
        if after == Some(false) {
            self.surface.cap(self.ray, &exit.0, self.sink);
        }
    }

    /// The formula's sign where the line crosses the container: the certain one, or else that of the rounded value, which then decides for the
    /// cap and for the formula's own surface alike, so that none is lost between them. Undefined is outside.
    fn declared(&self, lo: f64, hi: f64) -> bool {
        let at = (lo, hi);
        self.surface.sign_on(self.line, at).unwrap_or_else(|| self.surface.rounded(self.line, at))
    }

    /// Shows the roots from `a` to the end of the container that may be in `range`. The sign at that end; `None` if it was not asked for.
    fn between(&mut self, a: f64, end: (f64, f64), before: bool, range: (f64, f64)) -> Option<bool> {
        let surface = self.surface;
        let ends = self.ray.rough.then(|| self.at.window((self.ray.t_min, self.ray.t_max)));
        let mut walk = Walk {
            surface,
            line: self.line,
            at: self.at,
            sink: self.sink,
            tracker: Tracker::new(self.line, &surface.tape, Some(before), ends),
            last: range.1,
            passes: 0,
        };
        // Cells before the range that may hold surface, since the last of which it is plain that it does not.
        let mut ahead = Vec::new();
        let mut go_on = true;
        surface.divided().walk(self.line, (a, end.1), &mut |a, b, place| {
            if b >= range.0 {
                go_on = ahead.drain(..).all(|(a, b, place)| walk.take(a, b, place)) && walk.take(a, b, place);
            } else if let Place::Open(_) | Place::Slope(..) = place {
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
        // What the walk has told up to there counts before a rounded value.
        let told = walk.tracker.settled();
        let after =
            surface.sign_on(walk.line, end).or(told).unwrap_or_else(|| surface.rounded(walk.line, end));
        let found = walk.tracker.finish(Some(after));
        if walk.show(found) { Some(after) } else { None }
    }
}

/// A walk along the cells of a ray.
struct Walk<'a, 's> {
    surface: &'a Isosurface,
    line: &'a Line,
    at: &'a CentredRay<'a>,
    sink: &'s mut dyn Sink,
    tracker: Tracker<'a, Line>,
    /// Roots behind this are of no interest.
    last: f64,
    passes: u32,
}

impl<'a> Walk<'a, '_> {
    /// Takes the next cell's stretch; says whether to go on.
    fn take(&mut self, a: f64, b: f64, place: Place<'a>) -> bool {
        if self.tracker.is_idle() && (a > self.last || self.at.bracket(a, a).0 > self.sink.limit()) {
            return false;
        }
        let whole = &self.surface.tape;
        let found = match place {
            Place::Sign(sign) => self.tracker.settle(sign),
            Place::Gap => self.tracker.take(a, b, Verdict::Gap, whole),
            Place::Slope(tape, rises) => self.tracker.take(a, b, Verdict::Monotone(rises), tape),
            Place::Open(tape) => {
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

    /// Shows a root. A touch from outside is none of a regular surface, unless the ray runs along a face that two of its parts share, which is in it.
    fn show(&mut self, found: Option<Found>) -> bool {
        let flow = match found {
            None => Flow::Continue,
            Some(Found { touches: Some(outside), lo, hi, .. }) if self.surface.regular => {
                if outside {
                    self.along_a_face(lo, hi)
                } else {
                    Flow::Continue
                }
            }
            Some(found) => shown(self.at, self.sink, &found),
        };
        flow == Flow::Continue
    }

    #[cold]
    #[inline(never)]
    fn along_a_face(&mut self, lo: f64, hi: f64) -> Flow {
        let (at, sink) = (self.at, &mut *self.sink);
        let told =
            along_face::crossings(self.line, &self.surface.tape, (lo, hi), (false, false), &mut |found| {
                shown(at, sink, found)
            });
        told.unwrap_or(Flow::Continue)
    }
}

/// Shows a root of the formula, unless it is certainly out of the ray's range.
pub(super) fn shown(at: &CentredRay<'_>, sink: &mut dyn Sink, found: &Found) -> Flow {
    let (mut lo, hi) = at.bracket(found.lo.next_down(), found.hi.next_up());
    if at.admits(lo, hi) == Some(false) {
        return Flow::Continue;
    }
    let ray = at.local();
    if ray.source.is_some() && ray.t_min == 0.0 && ray.source_face == 0 {
        lo = lo.max(0.0).min(hi);
    }
    let t = at.t(found.s).max(lo).min(hi);
    sink.push(Root { t, lo, hi, s: found.s, tag: [0.0; 2], face: 0, sign: found.sign, kind: found.kind })
}
