//! The roots of a ray: the container's stretch of it, divided by cells, told apart, in one row with the caps.

use super::Isosurface;
use super::cells::Place;
use super::isolate::isolate;
use super::line::Line;
use super::tracker::{Curve, Found, Tracker, Verdict};
use crate::{CentredRay, Flow, LocalRay, Root, Sink};
use arrayvec::ArrayVec;
use durer_math::RaySide;

/// The container's crossings: at most two.
#[derive(Default)]
struct Caps(ArrayVec<Root, 4>);

impl Sink for Caps {
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn push(&mut self, root: Root) -> Flow {
        if root.sign != 0 && self.0.try_push(root).is_err() { Flow::Stop } else { Flow::Continue }
    }
}

/// How a stretch of the ray begins or ends.
#[derive(Clone, Copy)]
enum Border {
    /// At the container's face.
    Face(Root),
    /// Where the ray's range does.
    Range,
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
        let mut caps = Caps::default();
        self.container.roots(&whole, &mut caps);
        let [entry, exit] = caps.0.as_slice() else { return };
        if exit.hi < ray.t_min || entry.lo > ray.t_max {
            return;
        }
        let at = ray.recentre(self.container.bounds().centre(), 0);
        let (in_lo, in_hi) = at.window((entry.lo, entry.hi));
        let (out_lo, out_hi) = at.window((exit.lo, exit.hi));
        let line = Line::new(&at, in_lo.abs().max(out_hi.abs()));
        let mut query = Query { surface: self, ray, at: &at, line: &line, sink, passes: 0 };
        query.run(&[(*entry, in_lo, in_hi), (*exit, out_lo, out_hi)]);
    }
}

/// A ray's question, half answered.
struct Query<'a> {
    surface: &'a Isosurface,
    ray: &'a LocalRay<'a>,
    at: &'a CentredRay<'a>,
    line: &'a Line,
    sink: &'a mut dyn Sink,
    passes: u32,
}

impl Query<'_> {
    fn run(&mut self, [entry, exit]: &[(Root, f64, f64); 2]) {
        let (from, to) = self.at.window((self.ray.t_min, self.ray.t_max));
        let slack = 16.0 * self.line.ulp;
        // The stretch, its borders and the signs of the formula there.
        let (a, first, before) = if from > entry.2 {
            let (a, sign) = self.start(from, slack, entry.1);
            (a, Border::Range, sign)
        } else {
            (entry.1, Border::Face(entry.0), Some(self.declared(entry.1, entry.2)))
        };
        let (b, last) = if to < exit.1 {
            (self.beyond(to, slack, exit.2), Border::Range)
        } else {
            (exit.2, Border::Face(exit.0))
        };
        if let (Border::Face(cap), Some(false)) = (first, before)
            && self.cap(&cap) == Flow::Stop
        {
            return;
        }
        let after = match last {
            Border::Face(_) => Some(self.declared(exit.1, exit.2)),
            Border::Range => self.sign_on(b, b),
        };
        if a < b && self.between(a, b, before, after) == Flow::Stop {
            return;
        }
        if let (Border::Face(cap), Some(false)) = (last, after) {
            self.cap(&cap);
        }
    }

    /// The formula's sign where the line crosses the container: the certain one, or else that of the rounded value, which then decides for the
    /// cap and for the formula's own surface alike, so that none is lost between them. Undefined is outside.
    fn declared(&self, lo: f64, hi: f64) -> bool {
        self.sign_on(lo, hi).unwrap_or_else(|| {
            let within = self.line.value(&self.surface.tape, 0.5 * lo + 0.5 * hi) < 0.0;
            !within
        })
    }

    /// The one sign of the formula on a short stretch, if it is certain: the cell knows, or its tape.
    fn sign_on(&self, lo: f64, hi: f64) -> Option<bool> {
        let (middle, reach) = self.line.around(lo, hi);
        match self.surface.divided().place(middle, reach) {
            Some(Place::Sign(sign)) => Some(sign),
            Some(Place::Open(tape) | Place::Slope(tape, _)) => self.line.sign_on(tape, lo, hi),
            Some(Place::Gap) | None => self.line.sign_on(&self.surface.tape, lo, hi),
        }
    }

    /// Where to begin for a ray that starts inside the container, and the sign there.
    fn start(&self, from: f64, slack: f64, least: f64) -> (f64, Option<bool>) {
        if self.ray.source_face == 0
            && self.ray.t_min == 0.0
            && let Some(side) = self.ray.source
        {
            return (from, Some(side == RaySide::Front));
        }
        let mut back = slack;
        for _ in 0..24 {
            let a = (from - back).max(least);
            let sign = self.sign_on(a, a);
            if sign.is_some() || a == least {
                return (a, sign);
            }
            back *= 4.0;
        }
        ((from - slack).max(least), None)
    }

    /// Where to end for a ray whose range ends inside.
    fn beyond(&self, to: f64, slack: f64, most: f64) -> f64 {
        let mut on = slack;
        for _ in 0..24 {
            let b = (to + on).min(most);
            if b == most || self.sign_on(b, b).is_some() {
                return b;
            }
            on *= 4.0;
        }
        (to + slack).min(most)
    }

    /// Shows a crossing of the container, if it is in the ray's range.
    fn cap(&mut self, cap: &Root) -> Flow {
        if self.surface.open {
            return Flow::Continue;
        }
        let mut own = *self.ray;
        if own.source_face == 0 {
            own.source = None;
        } else {
            own.source_face -= 1;
        }
        let mut caps = Caps::default();
        self.surface.container.roots(&own, &mut caps);
        match caps.0.iter().find(|root| root.sign == cap.sign) {
            Some(root) => self.sink.push(Root { face: root.face + 1, ..*root }),
            None => Flow::Continue,
        }
    }

    fn between(&mut self, a: f64, b: f64, before: Option<bool>, after: Option<bool>) -> Flow {
        let (line, surface) = (self.line, self.surface);
        let mut tracker = Tracker::new(line, &surface.tape, before, self.ray.rough);
        let mut flow = Flow::Continue;
        let mut passes = self.passes;
        surface.divided().walk(line, (a, b), &mut |a, b, place| {
            if tracker.is_idle() && self.at.bracket(a, a).0 > self.sink.limit() {
                flow = Flow::Stop;
                return false;
            }
            let mut take = |a: f64, b: f64, verdict: Verdict, tape| {
                if let Some(found) = tracker.take(a, b, verdict, tape)
                    && !(surface.regular && found.touches)
                {
                    flow = shown(self.at, self.sink, &found);
                }
                flow == Flow::Continue
            };
            match place {
                Place::Sign(sign) => take(a, b, Verdict::Sign(sign), &surface.tape),
                Place::Gap => take(a, b, Verdict::Gap, &surface.tape),
                Place::Slope(tape, rises) => take(a, b, Verdict::Monotone(rises), tape),
                Place::Open(tape) => {
                    isolate(line, tape, (a, b), &mut passes, &mut |a, b, verdict| take(a, b, verdict, tape))
                }
            }
        });
        self.passes = passes;
        if flow == Flow::Continue
            && let Some(found) = tracker.finish(after)
            && !(surface.regular && found.touches)
        {
            flow = shown(self.at, self.sink, &found);
        }
        flow
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
