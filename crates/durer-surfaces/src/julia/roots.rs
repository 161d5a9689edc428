//! The roots of a ray: stretches classified by the balls around their orbits, in ascending order.

use super::Solid;
use super::embed::EmbeddedLine;
use crate::implicit::{CertifiedFunction, Found, RootIsolator, SignInfo};
use crate::{CentredRay, LocalRay, Root, Sink};
use core::ops::ControlFlow;
use durer_math::{Isa, Point3, RaySide};

/// After this many passes over eight stretches for one ray the rest counts as unresolved, so the
/// work for a ray is bounded.
const MOST_PASSES: u32 = 20_000;

struct Query<'a, const M: usize, const C: usize> {
    line: &'a EmbeddedLine<'a, M, C>,
    ray: &'a LocalRay<'a>,
    at: &'a CentredRay<'a>,
    sink: &'a mut dyn Sink,
    /// Roots beyond this do not matter.
    last: f64,
    tracker: RootIsolator<'a, EmbeddedLine<'a, M, C>>,
    passes: u32,
}

impl<const M: usize, const C: usize> Solid<M, C> {
    /// Passes all roots to `sink`, ascending.
    pub(super) fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || self.roots_here(ray, sink),
        );
    }

    #[inline(always)]
    fn roots_here(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let at = ray.recentre(Point3::ORIGIN, 0).sharp(1.0);
        let Some((first, last)) = self.stretch(&at) else { return };
        let (from, to) = at.window((ray.t_min, ray.t_max.min(sink.limit())));
        if from > last || to < first {
            return;
        }
        let line = EmbeddedLine::new(&self.rule, &self.lift, &at, first.abs().max(last.abs()));
        // Everything outside the ball is outside. A ray that was spawned on the surface starts on a
        // known side. Any other ray is examined as a whole, so that it has the same roots for every
        // range.
        let (a, before) = match ray.source {
            Some(side) if ray.t_min == 0.0 && from > first => (from, Some(side == RaySide::Front)),
            _ => (first, Some(true)),
        };
        let ends = ray.rough.then(|| at.ends((ray.t_min, ray.t_max)));
        let tracker = RootIsolator::new(&line, (), before, ends);
        let mut query = Query { line: &line, ray, at: &at, sink, last: to, tracker, passes: 0 };
        if a < last
            && query.isolate(a, last).is_continue()
            && let Some(found) = query.tracker.finish(Some(true))
        {
            let _ = query.show(&found);
        }
    }

    /// The part of a ray within the ball that holds the solid; the largest possible part if the
    /// ray's error is large.
    #[inline(always)]
    fn stretch(&self, at: &CentredRay<'_>) -> Option<(f64, f64)> {
        let (mid, half) = crate::polynomial_surface::ball_and_slab(
            at,
            self.radius,
            (0.0, 0.0),
            (-1.0, 1.0),
            super::ROOM / 2.0,
        )?;
        // The direction is no shorter than one.
        let far = 2.0 * self.radius;
        Some(if half < f64::INFINITY { (mid - half, mid + half) } else { (-far, far) })
    }
}

impl<const M: usize, const C: usize> Query<'_, M, C> {
    /// Classifies the stretch from `lo` to `hi`, and passes on the roots on it that are complete.
    fn isolate(&mut self, lo: f64, hi: f64) -> ControlFlow<()> {
        let node: [f64; 9] = core::array::from_fn(|i| match i {
            0 => lo,
            8 => hi,
            _ => (lo + (hi - lo) * (i as f64 / 8.0)).max(lo).min(hi),
        });
        let a: [f64; 8] = core::array::from_fn(|i| node[i]);
        let b: [f64; 8] = core::array::from_fn(|i| node[i + 1]);
        let known = self.line.between(&a, &b);
        self.passes += 1;
        let told = (known.out | known.within | known.rises | known.falls).bits();
        let width = (hi - lo) * 0.0625;
        let mut murky = 0_u8;
        if told != u8::MAX {
            if width <= 4.0 * self.line.ulp() || self.passes >= MOST_PASSES {
                murky = !told;
            } else if width < durer_math::scale::pow2(-20) {
                // Even a point's side is unknown, and no more certain than the stretch's.
                let middle: [f64; 8] = core::array::from_fn(|i| 0.5 * (a[i] + b[i]));
                let points = self.line.at(&middle);
                self.passes += 1;
                let told = told | (points.out | points.within).bits();
                for i in 0..8 {
                    let open = told >> i & 1 == 0;
                    let lost = known.spread.0[i] <= 4.0 * points.blur.0[i];
                    murky |= u8::from(open && lost) << i;
                }
            }
        }
        for i in 0..8 {
            let verdict = match () {
                () if known.out.lane(i) => SignInfo::Sign(true),
                () if known.within.lane(i) => SignInfo::Sign(false),
                () if known.rises.lane(i) => SignInfo::Monotone(true),
                () if known.falls.lane(i) => SignInfo::Monotone(false),
                () if murky >> i & 1 == 1 => SignInfo::Unresolved,
                () => {
                    self.isolate(a[i], b[i])?;
                    continue;
                }
            };
            let found = self.tracker.take(a[i], b[i], verdict, ());
            if let Some(found) = found
                && self.show(&found).is_break()
            {
                return ControlFlow::Break(());
            }
            if self.tracker.is_idle() && b[i] > self.last {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }

    /// Passes on a root, unless it is certainly out of the ray's range.
    #[inline(never)]
    fn show(&mut self, found: &Found) -> ControlFlow<()> {
        Isa::detect().run(
            #[inline(always)]
            || self.show_here(found),
        )
    }

    #[inline(always)]
    fn show_here(&mut self, found: &Found) -> ControlFlow<()> {
        let (mut lo, hi) = self.at.bracket(found.lo.next_down(), found.hi.next_up());
        if self.at.admits(lo, hi) == Some(false) {
            return ControlFlow::Continue(());
        }
        if self.ray.source.is_some() && self.ray.t_min == 0.0 {
            lo = lo.max(0.0).min(hi);
        }
        let t = self.at.t(found.s).max(lo).min(hi);
        let root = Root { t, lo, hi, s: found.s, tag: [0.0; 2], face: 0, sign: found.sign, kind: found.kind };
        let flow = self.sink.push(root);
        let limit = self.sink.limit();
        if limit < f64::INFINITY {
            self.last = self.last.min(self.at.window((limit, limit)).1);
        }
        flow
    }
}
