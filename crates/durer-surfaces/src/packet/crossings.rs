//! All crossings of eight rays with a solid, and the side on which points of the rays lie.
//!
//! CSG needs this of each operand (S. D. Roth, "Ray casting for modeling solids", *Computer
//! Graphics and Image Processing* 18, 1982). A solid is the set where all its faces are negative,
//! or the complement of that set.

use super::PacketFilter;
use super::closest::{FaceSteps, Scratch, Spot, Steps};
use super::convex::Hull;
use super::kernel::{Detail, KernelRays};
use super::quadric::{FaceKind, Seen, Start};
use super::rays::{FAR, From8, NEVER, RayLanes};
use arrayvec::ArrayVec;
use durer_math::{F8, Isa, M8};

/// Eight rays in the coordinates of one packet filter.
#[derive(Debug, Default)]
pub struct SolidState8 {
    start: Start,
    /// For convex solids: the part of each ray inside.
    hull: Hull,
    stay: Stay,
}

/// The part of each of eight rays inside a convex solid.
#[derive(Debug, Default)]
struct Stay {
    /// The part, if there is one, begins between these two,
    earliest: F8,
    entered: F8,
    /// and ends between these two.
    left: F8,
    latest: F8,
    /// Rays with no such part, or with none ahead of them.
    missed: M8,
    /// Rays for which some clipping face is not known well enough.
    unsure: M8,
}

/// One crossing for each of eight rays.
#[derive(Clone, Copy, Debug)]
pub struct Crossing8 {
    /// Rays that certainly cross here, from one side to the other.
    pub sure: M8,
    /// The parameter, known within `e`. It may lie before the ray's start or after its end.
    pub t: F8,
    /// The bound on the error of `t`.
    pub e: F8,
    /// The face.
    pub face: F8,
    /// The face's own data for computing the point later.
    pub tag: F8,
}

/// All crossings of eight rays with a solid, in no order.
#[derive(Debug)]
pub struct Crossings {
    list: ArrayVec<Crossing8, { Crossings::MOST }>,
    /// From this parameter on there may be other crossings; infinite if there are certainly none.
    pub doubt: F8,
}

impl Default for Crossings {
    fn default() -> Self {
        Self { list: ArrayVec::new(), doubt: NEVER }
    }
}

impl Crossings {
    /// The most crossings that are stored: two for each of six faces, or those of a solid with
    /// eight walls above each other.
    const MOST: usize = 24;
    /// Number of faces for which two crossings each are stored.
    const FACES: usize = 6;

    /// The stored crossings.
    pub fn iter(&self) -> core::slice::Iter<'_, Crossing8> {
        self.list.iter()
    }

    /// The stored crossings, mutable.
    pub(crate) fn all(&mut self) -> &mut [Crossing8] {
        &mut self.list
    }

    /// Adds a crossing, in one slot with crossings of other rays where possible. If no slot is free
    /// the crossing becomes a doubt.
    #[inline(always)]
    pub(crate) fn push(&mut self, sure: M8, t: F8, e: F8, (face, tag): (F8, F8)) {
        if !sure.any() {
            return;
        }
        for c in &mut self.list {
            if !(c.sure & sure).any() {
                (c.t, c.e) = (sure.select(t, c.t), sure.select(e, c.e));
                (c.face, c.tag) = (sure.select(face, c.face), sure.select(tag, c.tag));
                c.sure |= sure;
                return;
            }
        }
        if self.list.try_push(Crossing8 { sure, t, e, face, tag }).is_err() {
            self.doubt_from(sure, t - e);
        }
    }

    /// Marks everything from `t` on as uncertain for these lanes.
    #[inline(always)]
    pub(crate) fn doubt_from(&mut self, lanes: M8, t: F8) {
        // `max` returns zero for NaN.
        self.doubt.set_where(lanes, t.max(F8::ZERO).min(self.doubt));
    }
}

impl SolidState8 {
    #[inline(always)]
    fn seen<'a>(&'a self, rays: &'a RayLanes<'_>) -> Seen<'a> {
        Seen { d: rays.direction, d1: &rays.d1, start: &self.start }
    }
}

impl Stay {
    #[inline(always)]
    fn of(rays: &RayLanes<'_>, hull: &Hull) -> Self {
        let Hull { enter, leave, missed, unsure } = hull;
        let (earliest, latest) = (enter.t - enter.e, leave.e - leave.t);
        Self {
            earliest,
            entered: (enter.t + enter.e).max(enter.others),
            left: -((leave.t + leave.e).max(leave.others)),
            latest,
            missed: *missed | !*rays.live | earliest.gt(latest) | latest.lt(F8::ZERO),
            unsure: *unsure,
        }
    }

    /// For points at `t`, known within `e` and not before the start: which are certainly inside the
    /// faces, and which certainly outside.
    #[inline(always)]
    fn holds(&self, t: F8, e: F8) -> (M8, M8) {
        let (first, last) = (t - e, t + e);
        let within = !(self.missed | self.unsure) & first.gt(self.entered) & last.lt(self.left);
        (within, self.missed | last.lt(self.earliest) | first.gt(self.latest))
    }
}

impl PacketFilter {
    /// The greatest number of numbered faces of an operand.
    pub const FACES: usize = 128;

    /// Whether the filter describes the solid completely. Faces that only clip a surface do not
    /// bound its inside.
    pub fn is_operand(&self) -> bool {
        let told = self.faces.len() <= Crossings::FACES;
        told && self.loops.is_none() && self.holes.is_empty() && self.own_face.is_none()
    }

    /// The kernel that describes the operand in addition to its faces, if there is one.
    fn as_detail(&self) -> Option<&Detail> {
        self.detail.as_deref().filter(|detail| detail.kernel.is_operand())
    }

    /// Whether the solid is the complement of the set inside the faces.
    pub fn is_turned(&self) -> bool {
        self.turned
    }

    /// Whether the solid is the set inside some faces or its complement, so that a ray is inside on
    /// one interval.
    #[inline]
    pub fn is_convex(&self) -> bool {
        self.convex && self.as_detail().is_none()
    }

    /// Whether the surface is unbounded, so that it pays to know which part of a ray matters.
    pub fn is_endless(&self) -> bool {
        self.as_detail().is_some_and(|detail| detail.kernel.is_unbounded())
    }

    /// Computes the rays in the filter's coordinates. Returns whether every ray certainly misses
    /// the solid or has left it behind.
    pub fn sight(&self, rays: &RayLanes<'_>, sight: &mut SolidState8) -> bool {
        self.is_passed_by(rays, &mut sight.start)
    }

    /// Stores the part of each ray inside a convex solid. Returns the rays that certainly have no
    /// such part. `from` describes rays that start on the solid's own surface.
    pub fn stay(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        sight: &mut SolidState8,
        scratch: &mut Scratch,
    ) -> u8 {
        // A bounding box has faces of its own, and rays do not start on those.
        let from = from.filter(|_| !self.vague);
        let SolidState8 { start, hull, stay } = sight;
        self.hull(
            rays,
            from,
            &Seen { d: rays.direction, d1: &rays.d1, start },
            (&mut scratch.steps.faces, hull),
        );
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                *stay = Stay::of(rays, hull);
                stay.missed.bits()
            },
        )
    }

    /// Stores all crossings of the solid; of an unbounded one, those inside the convex solid
    /// `within`. `from` describes rays that start on the solid's own surface. The part inside a
    /// convex solid must be known.
    pub fn crossings(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        (sight, within): (&SolidState8, Option<&SolidState8>),
        scratch: &mut Scratch,
        to: &mut Crossings,
    ) {
        to.list.clear();
        to.doubt = NEVER;
        if let Some(detail) = self.as_detail() {
            let leaving = from.map(|from| (from, self.turned));
            let cell = within.map(|sight| &sight.hull);
            let seen = KernelRays { own: &detail.own, rays, leaving, start: &sight.start, cell };
            detail.kernel.crossings(&seen, to, &mut scratch.steps.detail);
        } else if self.convex {
            self.both_ends(rays, sight, to);
        } else {
            self.each_wall(rays, from, &sight.seen(rays), &mut scratch.steps, to);
        }
    }

    /// The entry into a convex solid and the exit from it.
    #[inline(never)]
    fn both_ends(&self, rays: &RayLanes<'_>, sight: &SolidState8, to: &mut Crossings) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.both_ends_here(sight, to),
        );
    }

    #[inline(always)]
    fn both_ends_here(&self, sight: &SolidState8, to: &mut Crossings) {
        let SolidState8 { hull: Hull { enter, leave, .. }, stay, .. } = sight;
        let Stay { earliest, entered, left, missed, unsure, .. } = *stay;
        let through = !(missed | unsure) & entered.lt(left);
        if self.vague {
            to.doubt_from(!missed, earliest);
            return;
        }
        // Crossings before the start do not matter; half-spaces have only one end.
        let ahead = !entered.lt(F8::ZERO);
        let ends = !left.ge(NEVER);
        let enters = through & ahead & earliest.gt(enter.others);
        let leaves = through & ends & (leave.t - leave.e).gt(leave.others);
        to.doubt_from(!(missed | through), earliest);
        to.doubt_from(through & ahead & !enters, earliest);
        to.doubt_from(through & ends & !leaves, left);
        let tag = F8::ZERO;
        to.list.push(Crossing8 { sure: enters, t: enter.t, e: enter.e, face: enter.face, tag });
        to.list.push(Crossing8 { sure: leaves, t: -leave.t, e: leave.e, face: leave.face, tag });
    }

    /// The roots of each wall where the other faces are negative.
    fn each_wall(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        seen: &Seen<'_>,
        steps: &mut Steps,
        to: &mut Crossings,
    ) {
        let Steps { faces: FaceSteps { plane, roots, .. }, spot, .. } = steps;
        for (i, face) in self.faces[..self.walls].iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                face.crossing(rays.isa, seen, from.as_ref(), plane);
                to.doubt_from(*rays.live & !(plane.crosses | plane.above | plane.below), F8::ZERO);
                self.wall(rays, (seen, spot), i, plane.crosses, (plane.t, plane.e), to);
            } else {
                face.roots(rays.isa, seen, from.as_ref(), roots);
                to.doubt_from(*rays.live & !(roots.known | roots.none), F8::ZERO);
                self.wall(rays, (seen, spot), i, roots.known, (roots.enter, roots.e_enter), to);
                self.wall(rays, (seen, spot), i, roots.known, (roots.leave, roots.e_leave), to);
            }
        }
    }

    /// One root of a wall.
    fn wall(
        &self,
        rays: &RayLanes<'_>,
        (seen, spot): (&Seen<'_>, &mut Spot),
        wall: usize,
        known: M8,
        (t, e): (F8, F8),
        to: &mut Crossings,
    ) {
        let (mut open, mut inside, mut outside) = (M8::NONE, M8::ALL, M8::NONE);
        let is_reached = rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                open = *rays.live & known & !(t + e).lt(F8::ZERO);
                spot.put(seen, t, e);
                open.any()
            },
        );
        if !is_reached {
            return;
        }
        if !self.cut_by_others(rays, wall, (spot, &open), &mut inside, &mut outside) {
            return;
        }
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let sure = open & inside & t.lt(F8::splat(FAR));
                to.doubt_from(open & !(sure | outside), t - e);
                to.list.push(Crossing8 { sure, t, e, face: F8::splat(wall as f64), tag: F8::ZERO });
            },
        );
    }

    /// For the `asked` rays, as bit masks: points at `t`, known within `e`, that are certainly
    /// inside the solid, and those that are certainly outside.
    pub fn holds(
        &self,
        rays: &RayLanes<'_>,
        sight: &SolidState8,
        (t, e, asked): (&F8, &F8, u8),
        scratch: &mut Scratch,
    ) -> (u8, u8) {
        let (inside, outside) = match self.as_detail() {
            Some(detail) => {
                let start = &sight.start;
                let seen = KernelRays { own: &detail.own, rays, leaving: None, start, cell: None };
                let memory = &mut scratch.steps.detail;
                let (inside, outside) = detail.kernel.holds(&seen, (*t, *e), asked, memory);
                (inside & asked, outside & asked)
            }
            None if self.convex => {
                let (inside, outside) = self.holds_by_stay(rays.isa, &sight.stay, (t, e, asked));
                let open = asked & !(inside | outside);
                if open == 0 {
                    (inside, outside)
                } else {
                    let left = (t, e, open);
                    let (also, beside) = self.holds_by_faces(rays, sight, left, &mut scratch.steps.spot);
                    (inside | also, outside | beside)
                }
            }
            None => self.holds_by_faces(rays, sight, (t, e, asked), &mut scratch.steps.spot),
        };
        if self.turned { (outside, inside) } else { (inside, outside) }
    }

    /// [`PacketFilter::holds`] from the part of each ray inside a convex solid.
    #[inline(never)]
    fn holds_by_stay(&self, isa: Isa, stay: &Stay, (t, e, asked): (&F8, &F8, u8)) -> (u8, u8) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (within, beside) = stay.holds(*t, *e);
                (if self.vague { 0 } else { within.bits() & asked }, beside.bits() & asked)
            },
        )
    }

    /// [`PacketFilter::holds`] from the signs of the faces at the points.
    #[inline(always)]
    fn holds_by_faces(
        &self,
        rays: &RayLanes<'_>,
        sight: &SolidState8,
        (t, e, asked): (&F8, &F8, u8),
        spot: &mut Spot,
    ) -> (u8, u8) {
        let seen = sight.seen(rays);
        rays.isa.run_in_lanes(
            #[inline(always)]
            || spot.put(&seen, *t, *e),
        );
        let (mut inside, mut outside) = (if self.vague { 0 } else { asked }, 0);
        // A point outside one face is outside, whatever the signs of the other faces.
        for face in &self.faces {
            let (below, above) = face.sides(rays.isa, spot);
            inside &= below;
            outside |= above & asked;
            if outside == asked {
                break;
            }
        }
        (inside, outside)
    }
}
