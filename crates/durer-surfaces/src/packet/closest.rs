//! The first face that each of eight rays hits.
//!
//! A ray hits a *convex* solid where it enters the last of its faces, if that is before it leaves
//! the first (`convex.rs`). For other surfaces every root of every wall is tested: it counts where
//! no other face is positive.

use super::PacketFilter;
use super::convex::Hull;
use super::implicit::Stream;
use super::kernel::{self, Detail};
use super::quadratic_roots::{Leaving, PlaneRoot, Roots, SlabRoots};
use super::quadric::{FaceKind, QuadricFace8, Seen, Start, taxicab};
use super::rays::{FAR, From8, NEVER, Nearest, RayLanes, SLACK};
use durer_math::{F8, M8, U, Vec3};

/// Eight points, one for each ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) y: Vec3<F8>,
    /// `|y|₁`, and a bound on the error of `y` in that norm.
    pub(super) y1: F8,
    pub(super) e1: F8,
}

/// Working memory for eight rays and one filter. It is kept between calls, so it need not be
/// cleared.
#[derive(Debug, Default)]
pub struct Scratch {
    start: Start,
    pub(super) steps: Steps,
}

/// Results that each step passes to the next.
#[derive(Debug, Default)]
pub(super) struct Steps {
    pub(super) faces: FaceSteps,
    pub(super) hull: Hull,
    pub(super) spot: Spot,
    pub(super) detail: kernel::KernelScratch,
}

/// Working memory for one face, by kind.
#[derive(Debug, Default)]
pub(super) struct FaceSteps {
    pub(super) plane: PlaneRoot,
    slab: SlabRoots,
    pub(super) roots: Roots,
}

/// A query of eight rays to a packet filter.
#[derive(Clone, Copy, Debug)]
pub struct PacketQuery<'a> {
    /// The rays.
    pub rays: &'a RayLanes<'a>,
    /// Data of the rays that start on this very surface, if any do.
    pub from: Option<&'a From8>,
    /// The number under which hits are reported.
    pub number: f64,
    /// Whether only the existence of a crossing matters, not its place.
    pub any: bool,
}

impl PacketFilter {
    /// Passes the first crossing of each ray to `nearest`, under the filter's number.
    pub fn meet(&self, asked: &PacketQuery<'_>, nearest: &mut Nearest, scratch: &mut Scratch) {
        if self.is_passed_by(asked.rays, &mut scratch.start) {
            return;
        }
        if let Some(detail) = &self.detail {
            let is_cut = self.cell(detail, asked, scratch);
            let Scratch { start, steps: Steps { hull, detail: memory, .. } } = scratch;
            detail.first((asked, self.turned), nearest, (start, is_cut.then_some(hull)), memory);
            return;
        }
        // A bounding box has faces of its own, and rays do not start on those.
        let asked = &PacketQuery { from: asked.from.filter(|_| !self.vague), ..*asked };
        // A surface inside one face may be hit before the ray leaves that face.
        if self.convex && (self.vague || self.faces.len() > 1) {
            self.meet_convex(asked, nearest, scratch);
        } else {
            self.meet_walls(asked, nearest, scratch);
        }
    }

    /// Whether several packets should be tested together ([`PacketFilter::meet_together`]) instead
    /// of one after the other.
    #[inline]
    pub fn is_asked_together(&self) -> bool {
        self.detail.as_ref().is_some_and(|detail| detail.kernel.segments().is_some())
    }

    /// [`PacketFilter::meet`] for those packets that are `open`.
    pub fn meet_together(
        &self,
        asked: &[PacketQuery<'_>],
        open: &[bool],
        nearest: &mut [Nearest],
        scratch: &mut Scratch,
    ) {
        let Some((detail, level)) =
            self.detail.as_ref().and_then(|detail| Some((detail, detail.kernel.segments()?)))
        else {
            for ((asked, nearest), _) in asked.iter().zip(nearest).zip(open).filter(|(_, open)| **open) {
                self.meet(asked, nearest, scratch);
            }
            return;
        };
        scratch.steps.detail.of::<Stream>().clear();
        for (i, ((asked, nearest), &open)) in asked.iter().zip(&mut *nearest).zip(open).enumerate() {
            if !open || self.is_passed_by(asked.rays, &mut scratch.start) {
                continue;
            }
            let is_cut = self.cell(detail, asked, scratch);
            let Scratch { start, steps: Steps { hull, detail: memory, .. } } = scratch;
            let held = (&*start, is_cut.then_some(&*hull));
            memory.of::<Stream>().add(i, (level, &detail.own, self.turned), asked, held, nearest);
        }
        scratch.steps.detail.of::<Stream>().meet(level, asked, nearest);
    }

    /// The part of each ray inside the convex cell that clips or contains the surface, if there is
    /// one.
    fn cell(&self, detail: &Detail, asked: &PacketQuery<'_>, scratch: &mut Scratch) -> bool {
        let is_contained = detail.is_contained();
        let is_cut = is_contained || detail.kernel.is_unbounded() && !self.faces.is_empty();
        if is_cut {
            let Scratch { start, steps } = scratch;
            let seen = &Seen { d: asked.rays.direction, d1: &asked.rays.d1, start };
            // The clipping faces are not the face that a ray starts on.
            let Steps { hull, faces, .. } = steps;
            self.hull(asked.rays, asked.from.filter(|_| is_contained), seen, (faces, hull));
        }
        is_cut
    }

    /// Computes the rays relative to the centre. Returns whether every ray certainly misses the
    /// ball that holds the surface, or has left it behind.
    #[inline(never)]
    pub(super) fn is_passed_by(&self, rays: &RayLanes<'_>, start: &mut Start) -> bool {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.is_passed_by_here(rays, start),
        )
    }

    #[inline(always)]
    fn is_passed_by_here(&self, rays: &RayLanes<'_>, start: &mut Start) -> bool {
        let (o, c, d) = (rays.origin, self.centre, rays.direction);
        let h = Vec3::new(o.x - c.x, o.y - c.y, o.z - c.z);
        let h1 = taxicab(h) * SLACK;
        (start.h, start.h1) = (h, h1);
        if self.reach == f64::INFINITY {
            start.far = rays.t_max.min(F8::splat(FAR));
            return false;
        }
        // |t d| <= |h| + R, and √3 |d| >= |d|₁.
        start.far = ((h1 + self.reach) * (1.75 * SLACK) * rays.inverse_d1).min(F8::splat(FAR));
        let hd = h.x * d.x + h.y * d.y + h.z * d.z;
        let h2 = h.x * h.x + h.y * h.y + h.z * h.z;
        let size = h1 * h1;
        // |h|² - R², less than three roundings of |h|₁² and one of R².
        let square = self.reach * self.reach;
        let outside = h2 - square - (size + square) * (8.0 * U);
        // The distance of the line is above R where (|h|² - R²) d² > (h·d)².
        let clear = (outside * rays.d2).gt((hd * hd + size * rays.d2 * (16.0 * U)) * SLACK);
        let behind = outside.gt(F8::ZERO) & hd.gt(h1 * rays.d1 * (8.0 * U));
        (clear | behind | !*rays.live).all()
    }

    #[inline(always)]
    pub(super) fn leaving<'a>(&self, from: Option<&'a From8>, face: usize) -> Option<Leaving<'a>> {
        let face = face + self.first_face();
        from.map(|from| Leaving { from, face, turned: self.turned })
    }

    fn meet_convex(&self, asked: &PacketQuery<'_>, nearest: &mut Nearest, scratch: &mut Scratch) {
        let &PacketQuery { rays, from, .. } = asked;
        let Scratch { start, steps } = scratch;
        let Steps { hull, faces, .. } = steps;
        self.hull(rays, from, &Seen { d: rays.direction, d1: &rays.d1, start }, (faces, hull));
        self.conclude(asked, hull, nearest);
    }

    /// Entries and exits of the faces of a convex solid.
    pub(super) fn hull(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        seen: &Seen<'_>,
        (faces, hull): (&mut FaceSteps, &mut Hull),
    ) {
        let FaceSteps { plane, slab, roots } = faces;
        let mut i = 0;
        while let Some(face) = self.faces.get(i) {
            let leaving = self.leaving(from, i);
            if self.slabs[i] {
                let opposite = &self.faces[i + 1];
                let next = self.leaving(from, i + 1);
                face.slab(opposite, rays.isa, seen, [leaving.as_ref(), next.as_ref()], slab);
                hull.add_slab(rays.isa, i, slab);
                i += 2;
                continue;
            }
            if face.kind == FaceKind::Plane {
                face.crossing(rays.isa, seen, leaving.as_ref(), plane);
                hull.add_plane(rays.isa, i, plane);
            } else {
                face.roots(rays.isa, seen, leaving.as_ref(), roots);
                hull.add_quadric(rays.isa, i, roots);
            }
            i += 1;
        }
    }

    /// The hits and misses that follow from the entries and exits.
    #[inline(never)]
    fn conclude(&self, asked: &PacketQuery<'_>, hull: &Hull, nearest: &mut Nearest) {
        asked.rays.isa.run_in_lanes(
            #[inline(always)]
            || self.conclude_here(asked, hull, nearest),
        );
    }

    #[inline(always)]
    fn conclude_here(&self, asked: &PacketQuery<'_>, hull: &Hull, nearest: &mut Nearest) {
        let rays = asked.rays;
        let Hull { enter, leave, missed, unsure } = hull;
        let mut missed = *missed | !*rays.live;
        let limit = nearest.limit(rays);
        let earliest = enter.t - enter.e;
        let latest = leave.e - leave.t;
        missed |= earliest.gt(latest) | latest.lt(F8::ZERO) | earliest.gt(limit);
        let entered = (enter.t + enter.e).max(enter.others);
        let left = -((leave.t + leave.e).max(leave.others));
        let open = !(missed | *unsure);
        let outside = open & entered.lt(left) & earliest.gt(F8::ZERO) & earliest.gt(enter.others);
        let within = open & entered.lt(F8::ZERO);
        let inside = within & left.gt(F8::ZERO) & (leave.t - leave.e).gt(leave.others);
        // A ray that starts inside hits the face through which it leaves.
        let t = outside.select(enter.t, -leave.t);
        let e = outside.select(enter.e, leave.e);
        let face = outside.select(enter.face, leave.face);
        // A ray that starts inside and never leaves has no further hit. A surface that is known
        // only by a bound may be hit before the ray leaves the bound.
        missed |= M8::splat(!self.vague) & (within & left.ge(NEVER) | inside & (t - e).gt(limit));
        let sure = (outside | inside) & !missed & (t + e).le(*rays.t_max);
        let unsure = !(missed | sure);
        self.put_down(sure, unsure, (t, e, face), earliest, asked.number, nearest);
    }

    /// A certain hit of a bound is only a possible hit of the surface in it.
    #[inline(always)]
    fn put_down(
        &self,
        sure: M8,
        unsure: M8,
        (t, e, face): (F8, F8, F8),
        earliest: F8,
        number: f64,
        nearest: &mut Nearest,
    ) {
        if self.vague {
            nearest.doubt_from(unsure | sure, earliest);
        } else {
            nearest.take(sure, t, e, number, face);
            if unsure.any() {
                nearest.doubt_from(unsure, earliest);
            }
        }
    }

    fn meet_walls(&self, asked: &PacketQuery<'_>, nearest: &mut Nearest, scratch: &mut Scratch) {
        let &PacketQuery { rays, from, .. } = asked;
        let Scratch { start, steps: Steps { faces: FaceSteps { plane, roots, .. }, spot, .. } } = scratch;
        let seen = &Seen { d: rays.direction, d1: &rays.d1, start };
        for (i, face) in self.faces[..self.walls].iter().enumerate() {
            if self.cutters.get(i).is_some_and(Option::is_none) {
                continue;
            }
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                face.crossing(rays.isa, seen, from.as_ref(), plane);
                nearest.doubt_unless(rays.live, &[&plane.crosses, &plane.above, &plane.below]);
                self.meet_wall(asked, (seen, spot), i, &plane.crosses, (&plane.t, &plane.e), nearest);
            } else {
                face.roots(rays.isa, seen, from.as_ref(), roots);
                nearest.doubt_unless(rays.live, &[&roots.known, &roots.none]);
                self.meet_wall(asked, (seen, spot), i, &roots.known, (&roots.enter, &roots.e_enter), nearest);
                self.meet_wall(asked, (seen, spot), i, &roots.known, (&roots.leave, &roots.e_leave), nearest);
            }
        }
    }

    /// Passes a root of one wall to `nearest`, unless another face cuts it off.
    fn meet_wall(
        &self,
        asked: &PacketQuery<'_>,
        (seen, spot): (&Seen<'_>, &mut Spot),
        wall: usize,
        lanes: &M8,
        (t, e): (&F8, &F8),
        nearest: &mut Nearest,
    ) {
        if self.faces.len() == 1 && self.loops.is_none() && self.holes.is_empty() {
            self.meet_only_wall(asked, lanes, (t, e), nearest);
            return;
        }
        let rays = asked.rays;
        let (mut open, mut inside, mut outside) = (M8::NONE, M8::ALL, M8::NONE);
        let is_reached = rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let limit = nearest.limit(rays);
                open = *rays.live & *lanes & !((*t + *e).lt(F8::ZERO) | (*t - *e).gt(limit));
                spot.put(seen, *t, *e);
                open.any()
            },
        );
        if !is_reached {
            return;
        }
        if !self.cut_by_others(rays, wall, (spot, &open), &mut inside, &mut outside) {
            return;
        }
        for hole in &self.holes {
            let (mut within, mut beside) = (M8::ALL, M8::NONE);
            let is_within = |face: &QuadricFace8| face.cut(rays.isa, spot, &open, &mut within, &mut beside);
            // A point that is certainly outside one face of the hole is kept, whatever the signs
            // of its other faces.
            hole.iter().all(is_within);
            inside &= beside;
            outside |= within & !beside;
        }
        if let Some(loops) = &self.loops {
            rays.isa.run_in_lanes(
                #[inline(always)]
                || loops.cut(&self.faces[wall], seen, spot, &mut inside, &mut outside),
            );
        }
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (t, e) = (*t, *e);
                let sure = open & inside & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
                let unsure = open & !(sure | outside);
                self.put_down(sure, unsure, (t, e, F8::splat(wall as f64)), t - e, asked.number, nearest);
            },
        );
    }

    /// Where other faces certainly cut off points of a wall, and where they certainly do not.
    /// Returns whether any open point may remain.
    pub(super) fn cut_by_others(
        &self,
        rays: &RayLanes<'_>,
        wall: usize,
        (spot, open): (&Spot, &M8),
        inside: &mut M8,
        outside: &mut M8,
    ) -> bool {
        let mut may_stay = |j: usize| self.faces[j].cut(rays.isa, spot, open, inside, outside);
        match self.cutters.get(wall) {
            None => (0..self.faces.len()).all(|j| j == wall || may_stay(j)),
            Some(None) => false,
            Some(Some(others)) => others.iter().all(|&j| may_stay(j as usize)),
        }
    }

    /// Passes a root of a surface with a single face to `nearest`.
    #[inline(never)]
    fn meet_only_wall(&self, asked: &PacketQuery<'_>, lanes: &M8, (t, e): (&F8, &F8), nearest: &mut Nearest) {
        let rays = asked.rays;
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (t, e) = (*t, *e);
                let (first, last) = (t - e, t + e);
                let open = *rays.live & *lanes & !(last.lt(F8::ZERO) | first.gt(nearest.limit(rays)));
                let sure = open & first.gt(F8::ZERO) & last.le(*rays.t_max);
                self.put_down(sure, open & !sure, (t, e, F8::ZERO), first, asked.number, nearest);
            },
        );
    }
}

impl Spot {
    /// Sets the points to those at `t`, which is known within `e`.
    #[inline(always)]
    pub(super) fn put(&mut self, seen: &Seen<'_>, t: F8, e: F8) {
        let (h, d) = (seen.start.h, seen.d);
        let y = Vec3::new(t.mul_add(d.x, h.x), t.mul_add(d.y, h.y), t.mul_add(d.z, h.z));
        self.y = y;
        self.y1 = taxicab(y) * SLACK;
        // One rounding of `h`, one of `y`, and the error of `t`.
        self.e1 = ((seen.start.h1 + self.y1) * (2.0 * U) + e * *seen.d1) * SLACK;
    }
}

impl Default for Spot {
    fn default() -> Self {
        Self { y: Vec3::splat(Vec3::ZERO), y1: F8::ZERO, e1: F8::ZERO }
    }
}
