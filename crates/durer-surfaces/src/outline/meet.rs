//! Which face do eight rays meet first?
//!
//! A *convex* solid is met where the last of its faces is entered, if that is before the first is left (T. L. Kay, J. T. Kajiya, "Ray tracing complex
//! scenes", SIGGRAPH 1986, for any convex faces). Of other surfaces each root of each wall is looked at: it counts where no other face is positive.
//!
//! Every parameter `t` comes with a bound `e` on its error. What is decided with its help is certain; the rest is put down as a doubt, at the least `t`
//! at which it can matter. Comparisons are written so that what is not a number ends as a doubt.

use super::Outline;
use super::face::{Face, FaceKind, Line, Seen, taxicab};
use durer_math::{F8, Isa, M8, Point3, U, Vec3};

/// Eight rays `o + t d` with `t` in `[0, t_max]`, as far as outlines are concerned.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes<'a> {
    pub(super) isa: Isa,
    pub(super) origin: &'a Point3<F8>,
    pub(super) direction: &'a Vec3<F8>,
    t_max: &'a F8,
    live: &'a M8,
    /// `|d|₁` and `d·d`.
    d1: F8,
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
        let (mut d1, mut d2) = (F8::ZERO, F8::ZERO);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let d = direction;
                d1 = taxicab(*d) * SLACK;
                d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            },
        );
        Self { isa, origin, direction, t_max, live, d1, d2 }
    }
}

/// The two roots of a face along eight rays: that at which it is entered (the polynomial falls), and that at which it is left.
#[derive(Default)]
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
#[derive(Default)]
struct PlaneRoot {
    /// The ray surely crosses, going down or up.
    falls: M8,
    rises: M8,
    /// It surely stays above, or surely below, as far as that matters.
    above: M8,
    below: M8,
    t: F8,
    e: F8,
}

/// Rays that leave a surface, as one of its faces sees them.
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
        let (b, e_b, c, e_c) = self.slope(rays);
        let (slope, e_slope) = (b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let mut t = -c / slope;
        let mut e = ((e_c + t.abs() * e_slope) / (size - e_slope) + t.abs() * (2.0 * U)) * SLACK;
        let mut crosses = size.gt(e_slope * CLEAR) & e.lt(F8::splat(FAR));
        let flat = size.le(e_slope * CLEAR);
        let reach = ((size + e_slope) * rays.far + e_c) * SLACK;
        if let Some((lanes, negative)) = from.map(Leaving::lanes) {
            let away = negative.select(-slope, slope);
            crosses &= !lanes | away.gt(e_slope);
            t = lanes.select(F8::splat(BEHIND), t);
            e = lanes.select(F8::ZERO, e);
        }
        let falls = slope.lt(F8::ZERO);
        root.falls = crosses & falls;
        root.rises = crosses & !falls;
        root.above = flat & c.gt(reach);
        root.below = flat & c.lt(-reach);
        root.t = t;
        root.e = e;
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
#[derive(Clone, Copy)]
struct Extreme {
    t: F8,
    e: F8,
    face: F8,
    /// The upper end of all others.
    others: F8,
}

const BEFORE: F8 = F8::splat(f64::NEG_INFINITY);

impl Extreme {
    const NONE: Self = Self { t: BEFORE, e: F8::ZERO, face: F8::ZERO, others: BEFORE };

    #[inline(always)]
    fn take(&mut self, lanes: M8, t: F8, e: F8, face: usize) {
        let better = lanes & t.gt(self.t);
        let loser = better.select(self.t + self.e, t + e);
        self.others = lanes.select(loser.max(self.others), self.others);
        self.t = better.select(t, self.t);
        self.e = better.select(e, self.e);
        self.face = better.select(F8::splat(face as f64), self.face);
    }

    /// The same where nothing was before.
    #[inline(always)]
    fn start(&mut self, lanes: M8, t: F8, e: F8) {
        self.t = lanes.select(t, BEFORE);
        self.e = lanes.select(e, F8::ZERO);
    }
}

/// What the faces of a convex solid say so far.
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
                self.missed |= root.above;
                self.unsure |= !(root.falls | root.rises | root.above | root.below);
                self.add(i, (root.falls, root.t, root.e), (root.rises, -root.t, root.e));
            },
        );
    }

    /// Adds face `i`, a quadric.
    #[inline(never)]
    fn add_quadric(&mut self, isa: Isa, i: usize, roots: &Roots) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (known, none) = (roots.known & roots.opens, roots.none & roots.opens);
                self.missed |= none;
                self.unsure |= !(known | none);
                self.add(i, (known, roots.enter, roots.e_enter), (known, -roots.leave, roots.e_leave));
            },
        );
    }

    #[inline(always)]
    fn add(&mut self, i: usize, enter: (M8, F8, F8), leave: (M8, F8, F8)) {
        if i == 0 {
            self.enter.start(enter.0, enter.1, enter.2);
            self.leave.start(leave.0, leave.1, leave.2);
        } else {
            self.enter.take(enter.0, enter.1, enter.2, i);
            self.leave.take(leave.0, leave.1, leave.2, i);
        }
    }
}

impl Outline {
    /// Offers the first crossing of each ray to `nearest`, under a number. `from` holds the rays that leave this very surface, if there are any.
    pub fn meet(&self, rays: &RayLanes<'_>, from: Option<&From8>, number: f64, nearest: &mut Nearest) {
        let mut seen =
            Seen { h: Vec3::splat(Vec3::ZERO), h1: F8::ZERO, d: rays.direction, d1: &rays.d1, far: F8::ZERO };
        if self.is_passed_by(rays, &mut seen) {
            return;
        }
        if self.convex {
            self.meet_convex(rays, &seen, from, number, nearest);
        } else {
            self.meet_walls(rays, &seen, from, number, nearest);
        }
    }

    /// Sees the rays from the centre; says whether every one surely passes the ball that holds the surface, or has left it behind.
    #[inline(never)]
    fn is_passed_by(&self, rays: &RayLanes<'_>, seen: &mut Seen<'_>) -> bool {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.is_passed_by_here(rays, seen),
        )
    }

    #[inline(always)]
    fn is_passed_by_here(&self, rays: &RayLanes<'_>, seen: &mut Seen<'_>) -> bool {
        let (o, c, d) = (rays.origin, self.centre, rays.direction);
        let h = Vec3::new(o.x - c.x, o.y - c.y, o.z - c.z);
        let h1 = taxicab(h) * SLACK;
        (seen.h, seen.h1) = (h, h1);
        if self.reach == f64::INFINITY {
            seen.far = rays.t_max.min(F8::splat(FAR));
            return false;
        }
        // |t d| <= |h| + R, and √3 |d| >= |d|₁.
        seen.far = ((h1 + self.reach) * (1.75 * SLACK) / rays.d1).min(F8::splat(FAR));
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
        seen: &Seen<'_>,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
    ) {
        let mut hull =
            Hull { enter: Extreme::NONE, leave: Extreme::NONE, missed: !*rays.live, unsure: M8::NONE };
        for (i, face) in self.faces.iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                let mut root = PlaneRoot::default();
                face.crossing(rays.isa, seen, from.as_ref(), &mut root);
                hull.add_plane(rays.isa, i, &root);
            } else {
                let mut roots = Roots::default();
                face.roots(rays.isa, seen, from.as_ref(), &mut roots);
                hull.add_quadric(rays.isa, i, &roots);
            }
        }
        self.conclude(rays, &hull, number, nearest);
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
        let Hull { enter, leave, mut missed, unsure } = *hull;
        let limit = nearest.limit(rays);
        let earliest = enter.t - enter.e;
        let latest = leave.e - leave.t;
        missed |= earliest.gt(latest) | latest.lt(F8::ZERO) | earliest.gt(limit);
        let entered = (enter.t + enter.e).max(enter.others);
        let left = -((leave.t + leave.e).max(leave.others));
        let open = !(missed | unsure);
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
            nearest.doubt_from(unsure, earliest);
        }
    }

    fn meet_walls(
        &self,
        rays: &RayLanes<'_>,
        seen: &Seen<'_>,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
    ) {
        for (i, face) in self.faces[..self.walls].iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                let mut root = PlaneRoot::default();
                face.crossing(rays.isa, seen, from.as_ref(), &mut root);
                let crosses = *rays.live & (root.falls | root.rises);
                let unsure = *rays.live & !(crosses | root.above | root.below);
                if unsure.any() {
                    nearest.doubt_from(unsure, F8::ZERO);
                }
                self.meet_wall(rays, seen, i, crosses, (&root.t, &root.e), number, nearest);
            } else {
                let mut roots = Roots::default();
                face.roots(rays.isa, seen, from.as_ref(), &mut roots);
                let known = *rays.live & roots.known;
                let unsure = *rays.live & !(roots.known | roots.none);
                if unsure.any() {
                    nearest.doubt_from(unsure, F8::ZERO);
                }
                self.meet_wall(rays, seen, i, known, (&roots.enter, &roots.e_enter), number, nearest);
                self.meet_wall(rays, seen, i, known, (&roots.leave, &roots.e_leave), number, nearest);
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
        lanes: M8,
        (t, e): (&F8, &F8),
        number: f64,
        nearest: &mut Nearest,
    ) {
        let mut open = M8::NONE;
        let Some(spot) = rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let limit = nearest.limit(rays);
                open = lanes & !((*t + *e).lt(F8::ZERO) | (*t - *e).gt(limit));
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

impl Spot {
    #[inline(always)]
    fn on(seen: &Seen<'_>, t: F8, e: F8) -> Self {
        let (h, d) = (seen.h, seen.d);
        let y = Vec3::new(t.mul_add(d.x, h.x), t.mul_add(d.y, h.y), t.mul_add(d.z, h.z));
        let y1 = taxicab(y) * SLACK;
        // One rounding of h, one of y, and the error of t.
        Self { y, y1, e1: ((seen.h1 + y1) * (2.0 * U) + e * *seen.d1) * SLACK }
    }
}
