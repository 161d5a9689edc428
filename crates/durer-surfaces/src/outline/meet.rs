//! Which face do eight rays meet first?
//!
//! A *convex* solid is met where the last of its faces is entered, if that is before the first is left (T. L. Kay, J. T. Kajiya, "Ray tracing complex
//! scenes", SIGGRAPH 1986, for any convex faces). Of other surfaces each root of each wall is looked at: it counts where no other face is positive.
//!
//! Every parameter `t` comes with a bound `e` on its error. What is decided with its help is certain; the rest is put down as a doubt, at the least `t`
//! at which it can matter. Comparisons are written so that what is not a number ends as a doubt.

use super::Outline;
use super::face::{Face, FaceKind, Line, Seen, Start, taxicab};
use durer_math::{F8, Isa, M8, Point3, U, Vec3};

/// Eight rays `o + t d` with `t` in `[0, t_max]`, as far as outlines are concerned.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes<'a> {
    pub(super) isa: Isa,
    pub(super) origin: &'a Point3<F8>,
    pub(super) direction: &'a Vec3<F8>,
    t_max: &'a F8,
    live: &'a M8,
    /// `|d|₁`, one over it, and `d·d`.
    d1: F8,
    inverse_d1: F8,
    d2: F8,
}

/// Rays that leave the very outline under test.
#[derive(Clone, Copy, Debug)]
pub struct From8 {
    /// Which do.
    pub lanes: M8,
    /// From which face, as a number.
    pub face: F8,
    /// Which start behind it, by the normal that hits have.
    pub back: M8,
}

/// The first sure hit so far, and the first doubt.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Where; infinite where there is none.
    pub t: F8,
    /// How far from there the crossing may be.
    pub e: F8,
    /// The outline's number, as the caller gave it.
    pub number: F8,
    /// The face of that outline.
    pub face: F8,
    /// From here on nothing is sure; infinite without a doubt.
    pub doubt: F8,
}

const NEVER: F8 = F8::splat(f64::INFINITY);
/// Pays for the roundings of error bounds.
const SLACK: f64 = 1.0 + 64.0 * U;
/// A divisor is trusted if it is this many times its error.
const CLEAR: f64 = 4.0;
/// Behind the start of a ray, surely.
const BEHIND: f64 = -f64::MIN_POSITIVE;
/// Farther than anything; its products with ordinary numbers are ordinary.
const FAR: f64 = durer_math::scale::pow2(500);

impl Nearest {
    /// Nothing yet.
    pub const NONE: Self = Self { t: NEVER, e: F8::ZERO, number: F8::ZERO, face: F8::ZERO, doubt: NEVER };

    /// No crossing behind this can win.
    #[inline(always)]
    fn limit(&self, rays: &RayLanes<'_>) -> F8 {
        (self.t + self.e).min(*rays.t_max)
    }

    #[inline(always)]
    fn take(&mut self, sure: M8, t: F8, e: F8, number: f64, face: F8) {
        let better = sure & t.lt(self.t);
        self.t = better.select(t, self.t);
        self.e = better.select(e, self.e);
        self.number = better.select(F8::splat(number), self.number);
        self.face = better.select(face, self.face);
    }

    /// Of live rays of which none of these is known nothing is sure.
    #[inline(always)]
    fn doubt_unless(&mut self, live: &M8, known: &[&M8]) {
        let unsure = known.iter().fold(*live, |unsure, known| unsure & !**known);
        if unsure.any() {
            self.doubt_from(unsure, F8::ZERO);
        }
    }

    #[inline(always)]
    fn doubt_from(&mut self, where_: M8, t: F8) {
        // `max` answers zero for what is not a number.
        let from = t.max(F8::ZERO);
        self.doubt = where_.select(from.min(self.doubt), self.doubt);
    }
}

impl<'a> RayLanes<'a> {
    /// Eight rays; those that are not live may hold anything.
    #[inline]
    pub fn new(
        isa: Isa,
        origin: &'a Point3<F8>,
        direction: &'a Vec3<F8>,
        t_max: &'a F8,
        live: &'a M8,
    ) -> Self {
        let (mut d1, mut inverse_d1, mut d2) = (F8::ZERO, F8::ZERO, F8::ZERO);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let d = direction;
                d1 = taxicab(*d) * SLACK;
                inverse_d1 = F8::ONE / d1;
                d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            },
        );
        Self { isa, origin, direction, t_max, live, d1, inverse_d1, d2 }
    }
}

/// The two roots of a face along eight rays: that at which it is entered (the polynomial falls), and that at which it is left.
#[derive(Debug, Default)]
struct Roots {
    /// Both are there and both are known.
    known: M8,
    /// There is none: the polynomial has the sign of `A` all along.
    none: M8,
    /// `A` is surely positive.
    opens: M8,
    enter: F8,
    e_enter: F8,
    leave: F8,
    e_leave: F8,
}

/// The root of a plane along eight rays.
#[derive(Debug, Default)]
struct PlaneRoot {
    /// The ray surely crosses.
    crosses: M8,
    /// It goes down.
    falls: M8,
    /// It surely stays above, or surely below, as far as that matters.
    above: M8,
    below: M8,
    t: F8,
    e: F8,
}

/// Where eight rays are inside a slab, that is between two parallel planes.
#[derive(Debug, Default)]
struct SlabRoots {
    /// They surely cross both planes.
    known: M8,
    /// They surely stay outside, or surely inside, as far as that matters.
    outside: M8,
    inside: M8,
    /// They enter by the first plane.
    rises: M8,
    enter: F8,
    e_enter: F8,
    leave: F8,
    e_leave: F8,
}

/// Rays that leave a surface, as one of its faces sees them.
#[derive(Clone, Copy)]
struct Leaving<'a> {
    from: &'a From8,
    face: usize,
    turned: bool,
}

impl Leaving<'_> {
    /// The lanes that start on this face, and where its polynomial is negative at their start.
    #[inline(always)]
    fn lanes(&self) -> (M8, M8) {
        let here = F8::splat(self.face as f64);
        let lanes = self.from.lanes & self.from.face.le(here) & self.from.face.ge(here);
        (lanes, if self.turned { !self.from.back } else { self.from.back })
    }
}

/// `c / slope` with a bound on its error, if `c` is within `e_c` and the slope within `e_slope`; `inverse` is one over the slope, rounded.
#[inline(always)]
fn quotient(c: F8, e_c: F8, inverse: F8, e_slope: F8) -> (F8, F8) {
    let t = c * inverse;
    let far = t.abs();
    // Two roundings, and what exact numbers may differ by: (e_c + |t| e_slope) / (|slope| - e_slope), where that is at most 4/3 of the division by |slope|.
    let e = ((e_c + far * e_slope) * inverse.abs() * (CLEAR / (CLEAR - 1.0)) + far * (4.0 * U)) * SLACK;
    (t, e)
}

// Each step below is a function of its own that takes from memory and puts into memory what eight lanes hold. In one large function the compiler would
// mix lanes of different numbers, which costs several times as much as the loads and stores.
impl Face {
    /// Roots of `A t² + 2 B t + C` by the stable formula, with bounds.
    ///
    /// Of the rays that start on this face the near root is the one they left: it lies behind if they go away from the surface.
    #[inline(never)]
    fn roots(&self, isa: Isa, rays: &Seen<'_>, from: Option<&Leaving<'_>>, roots: &mut Roots) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.roots_here(rays, from, roots),
        );
    }

    #[inline(always)]
    fn roots_here(&self, rays: &Seen<'_>, from: Option<&Leaving<'_>>, roots: &mut Roots) {
        let Line { a, b, c, e_a, e_b, e_c } = self.along(rays);
        let (size_a, size_b, size_c) = (a.abs(), b.abs(), c.abs());
        let ac = a * c;
        let disc = b.mul_add(b, -ac);
        let e_disc = ((size_b * 2.0 + e_b) * e_b
            + (size_a + e_a) * e_c
            + size_c * e_a
            + (b * b + ac.abs()) * (4.0 * U))
            * SLACK;
        let some = disc.gt(e_disc);
        let root = some.select(disc, F8::ONE).sqrt();
        let q = -(b + root.copysign(b));
        let size_q = q.abs();
        let e_q = (e_b + e_disc / root + size_q * (2.0 * U)) * SLACK;
        let (far, near) = (q / a, c / q);
        let e_far = ((e_q + far.abs() * e_a) / (size_a - e_a) + far.abs() * (2.0 * U)) * SLACK;
        let e_near = ((e_c + near.abs() * e_q) / (size_q - e_q) + near.abs() * (2.0 * U)) * SLACK;
        let mut known =
            some & size_a.gt(e_a * CLEAR) & size_q.gt(e_q * CLEAR) & (e_far + e_near).lt(F8::splat(FAR));
        let (mut near, mut e_near) = (near, e_near);
        if let Some((lanes, negative)) = from.map(Leaving::lanes) {
            let away = negative.select(-b, b);
            known &= !lanes | away.gt(e_b);
            near = lanes.select(F8::splat(BEHIND), near);
            e_near = lanes.select(F8::ZERO, e_near);
        }
        // The slope at the far root has the sign of -B.
        let falls = b.gt(F8::ZERO);
        roots.known = known;
        roots.none = disc.lt(-e_disc);
        roots.opens = a.gt(e_a * CLEAR);
        roots.enter = falls.select(far, near);
        roots.e_enter = falls.select(e_far, e_near);
        roots.leave = falls.select(near, far);
        roots.e_leave = falls.select(e_near, e_far);
    }

    /// The crossing of a plane.
    #[inline(never)]
    fn crossing(&self, isa: Isa, rays: &Seen<'_>, from: Option<&Leaving<'_>>, root: &mut PlaneRoot) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.crossing_here(rays, from, root),
        );
    }

    #[inline(always)]
    fn crossing_here(&self, rays: &Seen<'_>, from: Option<&Leaving<'_>>, root: &mut PlaneRoot) {
        let (b, e_b, c) = self.slope(rays);
        let (constant, e_c) = self.height(rays);
        let (c, slope, e_slope) = (c + constant, b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let inverse = F8::ONE / slope;
        let (mut t, mut e) = quotient(-c, e_c, inverse, e_slope);
        let steep = size.gt(e_slope * CLEAR);
        let mut crosses = steep & e.lt(F8::splat(FAR));
        if let Some((lanes, negative)) = from.map(Leaving::lanes) {
            crosses &= !lanes | negative.select(-slope, slope).gt(e_slope);
            t = lanes.select(F8::splat(BEHIND), t);
            e = lanes.select(F8::ZERO, e);
        }
        let reach = ((size + e_slope) * rays.start.far + e_c) * SLACK;
        root.crosses = crosses;
        root.falls = slope.lt(F8::ZERO);
        root.above = !steep & c.gt(reach);
        root.below = !steep & c.lt(-reach);
        root.t = t;
        root.e = e;
    }

    /// The crossings of two parallel planes that look away from each other.
    #[inline(never)]
    fn slab(
        &self,
        opposite: &Self,
        isa: Isa,
        rays: &Seen<'_>,
        from: [Option<&Leaving<'_>>; 2],
        roots: &mut SlabRoots,
    ) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.slab_here(opposite, rays, from, roots),
        );
    }

    #[inline(always)]
    fn slab_here(
        &self,
        opposite: &Self,
        rays: &Seen<'_>,
        from: [Option<&Leaving<'_>>; 2],
        roots: &mut SlabRoots,
    ) {
        // Along the second plane's normal.
        let (b, e_b, c) = opposite.slope(rays);
        let ((first, e_first), (second, e_second)) = (self.height(rays), opposite.height(rays));
        let (slope, e_slope) = (b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let inverse = F8::ONE / slope;
        let (c0, c1) = (-c + first, c + second);
        let (mut t0, mut e0) = quotient(c0, e_first, inverse, e_slope);
        let (mut t1, mut e1) = quotient(-c1, e_second, inverse, e_slope);
        let steep = size.gt(e_slope * CLEAR);
        let mut known = steep & (e0 + e1).lt(F8::splat(FAR));
        let [from0, from1] = from;
        if let Some((lanes, negative)) = from0.map(Leaving::lanes) {
            known &= !lanes | negative.select(slope, -slope).gt(e_slope);
            t0 = lanes.select(F8::splat(BEHIND), t0);
            e0 = lanes.select(F8::ZERO, e0);
        }
        if let Some((lanes, negative)) = from1.map(Leaving::lanes) {
            known &= !lanes | negative.select(-slope, slope).gt(e_slope);
            t1 = lanes.select(F8::splat(BEHIND), t1);
            e1 = lanes.select(F8::ZERO, e1);
        }
        let reach = ((size + e_slope) * rays.start.far + e_first.max(e_second)) * SLACK;
        let rises = slope.gt(F8::ZERO);
        roots.known = known;
        roots.outside = !steep & (c0.gt(reach) | c1.gt(reach));
        roots.inside = !steep & c0.lt(-reach) & c1.lt(-reach);
        roots.rises = rises;
        roots.enter = rises.select(t0, t1);
        roots.e_enter = rises.select(e0, e1);
        roots.leave = rises.select(t1, t0);
        roots.e_leave = rises.select(e1, e0);
    }

    /// Where this face cuts off points, and where it surely does not.
    #[inline(never)]
    fn cut(&self, isa: Isa, at: &Spot, inside: &mut M8, outside: &mut M8) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (f, e_f) = self.at(at.y, at.y1, at.e1);
                *inside &= f.lt(-e_f);
                *outside |= f.gt(e_f);
            },
        );
    }
}

/// Points of eight rays.
pub(super) struct Spot {
    pub(super) y: Vec3<F8>,
    /// `|y|₁`, and a bound on the error of `y` in that norm.
    pub(super) y1: F8,
    pub(super) e1: F8,
}

/// The greatest of the entries, or with signs exchanged the least of the exits, so far.
#[derive(Clone, Copy, Debug, Default)]
struct Extreme {
    t: F8,
    e: F8,
    face: F8,
    /// The upper end of all others.
    others: F8,
}

const BEFORE: F8 = F8::splat(f64::NEG_INFINITY);

impl Extreme {
    #[inline(always)]
    fn take(&mut self, is_first: bool, lanes: M8, t: F8, e: F8, face: F8) {
        if is_first {
            self.t = lanes.select(t, BEFORE);
            self.e = lanes.keep(e);
            self.face = face;
            self.others = BEFORE;
            return;
        }
        let better = lanes & t.gt(self.t);
        let loser = better.select(self.t + self.e, t + e);
        self.others = lanes.select(loser.max(self.others), self.others);
        self.t = better.select(t, self.t);
        self.e = better.select(e, self.e);
        self.face = better.select(face, self.face);
    }
}

/// What the faces of a convex solid say so far.
#[derive(Clone, Copy, Debug, Default)]
struct Hull {
    /// The latest entry.
    enter: Extreme,
    /// The earliest exit, by its negative.
    leave: Extreme,
    missed: M8,
    unsure: M8,
}

impl Hull {
    /// Adds face `i`, a plane.
    #[inline(never)]
    fn add_plane(&mut self, isa: Isa, i: usize, root: &PlaneRoot) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.add_doubts(i, root.above, root.crosses | root.below);
                let face = F8::splat(i as f64);
                self.enter.take(i == 0, root.crosses & root.falls, root.t, root.e, face);
                self.leave.take(i == 0, root.crosses & !root.falls, -root.t, root.e, face);
            },
        );
    }

    /// Adds the faces `i` and `i + 1`, two planes that bound a slab.
    #[inline(never)]
    fn add_slab(&mut self, isa: Isa, i: usize, roots: &SlabRoots) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.add_doubts(i, roots.outside, roots.known | roots.inside);
                let (first, second) = (F8::splat(i as f64), F8::splat((i + 1) as f64));
                let (enter, leave) = (roots.rises.select(first, second), roots.rises.select(second, first));
                self.enter.take(i == 0, roots.known, roots.enter, roots.e_enter, enter);
                self.leave.take(i == 0, roots.known, -roots.leave, roots.e_leave, leave);
            },
        );
    }

    /// Adds face `i`, a quadric.
    #[inline(never)]
    fn add_quadric(&mut self, isa: Isa, i: usize, roots: &Roots) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let known = roots.known & roots.opens;
                self.add_doubts(i, roots.none & roots.opens, known);
                let face = F8::splat(i as f64);
                self.enter.take(i == 0, known, roots.enter, roots.e_enter, face);
                self.leave.take(i == 0, known, -roots.leave, roots.e_leave, face);
            },
        );
    }

    #[inline(always)]
    fn add_doubts(&mut self, i: usize, missed: M8, known: M8) {
        let unsure = !(missed | known);
        if i == 0 {
            (self.missed, self.unsure) = (missed, unsure);
        } else {
            self.missed |= missed;
            self.unsure |= unsure;
        }
    }
}

/// Memory for what is known of eight rays and one outline on the way: kept, so that it need not be cleared for each.
#[derive(Debug)]
pub struct Scratch {
    start: Start,
    plane: PlaneRoot,
    slab: SlabRoots,
    roots: Roots,
    hull: Hull,
}

impl Default for Scratch {
    fn default() -> Self {
        let start = Start { h: Vec3::splat(Vec3::ZERO), h1: F8::ZERO, far: F8::ZERO };
        Self {
            start,
            plane: PlaneRoot::default(),
            slab: SlabRoots::default(),
            roots: Roots::default(),
            hull: Hull::default(),
        }
    }
}

impl Outline {
    /// Offers the first crossing of each ray to `nearest`, under a number. `from` holds the rays that leave this very surface, if there are any.
    pub fn meet(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        if self.is_passed_by(rays, &mut scratch.start) {
            return;
        }
        if self.convex && self.faces.len() > 1 {
            self.meet_convex(rays, from, number, nearest, scratch);
        } else {
            self.meet_walls(rays, from, number, nearest, scratch);
        }
    }

    /// Sees the rays from the centre; says whether every one surely passes the ball that holds the surface, or has left it behind.
    #[inline(never)]
    fn is_passed_by(&self, rays: &RayLanes<'_>, start: &mut Start) -> bool {
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
    fn leaving<'a>(&self, from: Option<&'a From8>, face: usize) -> Option<Leaving<'a>> {
        from.map(|from| Leaving { from, face, turned: self.turned })
    }

    fn meet_convex(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        let Scratch { start, plane, slab, roots, hull } = scratch;
        let seen = Seen { d: rays.direction, d1: &rays.d1, start };
        let mut i = 0;
        while let Some(face) = self.faces.get(i) {
            let leaving = self.leaving(from, i);
            if self.slabs[i] {
                let opposite = &self.faces[i + 1];
                let next = self.leaving(from, i + 1);
                face.slab(opposite, rays.isa, &seen, [leaving.as_ref(), next.as_ref()], slab);
                hull.add_slab(rays.isa, i, slab);
                i += 2;
                continue;
            }
            if face.kind == FaceKind::Plane {
                face.crossing(rays.isa, &seen, leaving.as_ref(), plane);
                hull.add_plane(rays.isa, i, plane);
            } else {
                face.roots(rays.isa, &seen, leaving.as_ref(), roots);
                hull.add_quadric(rays.isa, i, roots);
            }
            i += 1;
        }
        self.conclude(rays, hull, number, nearest);
    }

    /// What entries and exits come to.
    #[inline(never)]
    fn conclude(&self, rays: &RayLanes<'_>, hull: &Hull, number: f64, nearest: &mut Nearest) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.conclude_here(rays, hull, number, nearest),
        );
    }

    #[inline(always)]
    fn conclude_here(&self, rays: &RayLanes<'_>, hull: &Hull, number: f64, nearest: &mut Nearest) {
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
        // From within, what is left is met.
        let t = outside.select(enter.t, -leave.t);
        let e = outside.select(enter.e, leave.e);
        let face = outside.select(enter.face, leave.face);
        // What is never left is not met again from within.
        missed |= within & left.ge(NEVER) | inside & (t - e).gt(limit);
        let sure = (outside | inside) & !missed & (t + e).le(*rays.t_max);
        let unsure = !(missed | sure);
        self.put_down(sure, unsure, (t, e, face), earliest, number, nearest);
    }

    /// Sure hits of a vague outline are doubts.
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

    fn meet_walls(
        &self,
        rays: &RayLanes<'_>,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        let Scratch { start, plane, roots, .. } = scratch;
        let seen = &Seen { d: rays.direction, d1: &rays.d1, start };
        for (i, face) in self.faces[..self.walls].iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                face.crossing(rays.isa, seen, from.as_ref(), plane);
                nearest.doubt_unless(rays.live, &[&plane.crosses, &plane.above, &plane.below]);
                self.meet_wall(rays, seen, i, &plane.crosses, (&plane.t, &plane.e), number, nearest);
            } else {
                face.roots(rays.isa, seen, from.as_ref(), roots);
                nearest.doubt_unless(rays.live, &[&roots.known, &roots.none]);
                self.meet_wall(rays, seen, i, &roots.known, (&roots.enter, &roots.e_enter), number, nearest);
                self.meet_wall(rays, seen, i, &roots.known, (&roots.leave, &roots.e_leave), number, nearest);
            }
        }
    }

    /// Offers a root of one wall, where the others do not cut it off.
    #[expect(clippy::too_many_arguments, reason = "a loop body that two kinds of faces share")]
    fn meet_wall(
        &self,
        rays: &RayLanes<'_>,
        seen: &Seen<'_>,
        wall: usize,
        lanes: &M8,
        (t, e): (&F8, &F8),
        number: f64,
        nearest: &mut Nearest,
    ) {
        if self.faces.len() == 1 && self.loops.is_none() {
            self.meet_only_wall(rays, lanes, (t, e), number, nearest);
            return;
        }
        let mut open = M8::NONE;
        let Some(spot) = rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let limit = nearest.limit(rays);
                open = *rays.live & *lanes & !((*t + *e).lt(F8::ZERO) | (*t - *e).gt(limit));
                open.any().then(|| Spot::on(seen, *t, *e))
            },
        ) else {
            return;
        };
        let (mut inside, mut outside) = (M8::ALL, M8::NONE);
        for (j, other) in self.faces.iter().enumerate() {
            if j != wall {
                other.cut(rays.isa, &spot, &mut inside, &mut outside);
            }
        }
        if let Some(loops) = &self.loops {
            rays.isa.run_in_lanes(
                #[inline(always)]
                || loops.cut(&spot, &mut inside, &mut outside),
            );
        }
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (t, e) = (*t, *e);
                let sure = open & inside & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
                let unsure = open & !(sure | outside);
                self.put_down(sure, unsure, (t, e, F8::splat(wall as f64)), t - e, number, nearest);
            },
        );
    }
}

impl Outline {
    /// Offers a root of a surface with one face.
    #[inline(never)]
    fn meet_only_wall(
        &self,
        rays: &RayLanes<'_>,
        lanes: &M8,
        (t, e): (&F8, &F8),
        number: f64,
        nearest: &mut Nearest,
    ) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (t, e) = (*t, *e);
                let (first, last) = (t - e, t + e);
                let open = *rays.live & *lanes & !(last.lt(F8::ZERO) | first.gt(nearest.limit(rays)));
                let sure = open & first.gt(F8::ZERO) & last.le(*rays.t_max);
                self.put_down(sure, open & !sure, (t, e, F8::ZERO), first, number, nearest);
            },
        );
    }
}

impl Spot {
    #[inline(always)]
    fn on(seen: &Seen<'_>, t: F8, e: F8) -> Self {
        let (h, d) = (seen.start.h, seen.d);
        let y = Vec3::new(t.mul_add(d.x, h.x), t.mul_add(d.y, h.y), t.mul_add(d.z, h.z));
        let y1 = taxicab(y) * SLACK;
        // One rounding of h, one of y, and the error of t.
        Self { y, y1, e1: ((seen.start.h1 + y1) * (2.0 * U) + e * *seen.d1) * SLACK }
    }
}
