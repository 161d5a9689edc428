//! Which face do eight rays meet first?
//!
//! A *convex* solid is met where the last of its faces is entered, if that is before the first is left (T. L. Kay, J. T. Kajiya, "Ray tracing complex
//! scenes", SIGGRAPH 1986, for any convex faces). Of other surfaces each root of each wall is looked at: it counts where no other face is positive.
//!
//! Every parameter `t` comes with a bound `e` on its error. What is decided with its help is certain; the rest is put down as a doubt, at the least `t`
//! at which it can matter. Comparisons are written so that what is not a number ends as a doubt.

use super::Outline;
use super::face::{Face, FaceKind, Line, Seen, taxicab};
use durer_math::{F8, M8, Point3, U, Vec3};

/// Eight rays, as far as outlines are concerned.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes {
    origin: Point3<F8>,
    pub(super) direction: Vec3<F8>,
    t_max: F8,
    live: M8,
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
    fn limit(&self, rays: &RayLanes) -> F8 {
        (self.t + self.e).min(rays.t_max)
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

impl RayLanes {
    /// Rays `o + t d` with `t` in `[0, t_max]`.
    #[inline(always)]
    pub fn new(origin: Point3<F8>, direction: Vec3<F8>, t_max: F8, live: M8) -> Self {
        let d = direction;
        let d2 = d.x * d.x + d.y * d.y + d.z * d.z;
        Self { origin, direction, t_max, live, d1: taxicab(d) * SLACK, d2 }
    }

    #[inline(always)]
    pub(super) fn origin(&self) -> Point3<F8> {
        self.origin
    }

    #[inline(always)]
    fn seen_from(&self, centre: Point3) -> Seen {
        let o = self.origin;
        let h = Vec3::new(o.x - centre.x, o.y - centre.y, o.z - centre.z);
        Seen { h, h1: taxicab(h) * SLACK, d: self.direction, d1: self.d1 }
    }
}

/// The two roots of a face along eight rays: that at which it is entered (the polynomial falls), and that at which it is left.
struct Roots {
    /// Both are there and both are known.
    known: M8,
    /// There is none: the polynomial has the sign of `A` all along.
    none: M8,
    enter: (F8, F8),
    leave: (F8, F8),
}

impl Line {
    /// Roots by the stable formula, with bounds.
    ///
    /// `from` holds the lanes that start on this face, and whether the polynomial is negative there. Of these the near root is the one the ray left:
    /// it lies behind if the ray goes away from the surface.
    #[inline(always)]
    fn roots(&self, from: Option<(M8, M8)>) -> Roots {
        let Self { a, b, c, e_a, e_b, e_c } = *self;
        let (size_a, size_b, size_c) = (a.abs(), b.abs(), c.abs());
        let ac = a * c;
        let disc = b.mul_add(b, -ac);
        let e_disc = ((size_b * 2.0 + e_b) * e_b
            + (size_a + e_a) * e_c
            + size_c * e_a
            + (b * b + ac.abs()) * (4.0 * U))
            * SLACK;
        let none = disc.lt(-e_disc);
        let some = disc.gt(e_disc);
        let root = some.select(disc, F8::ONE).sqrt();
        let q = -(b + root.copysign(b));
        let size_q = q.abs();
        let e_q = (e_b + e_disc / root + size_q * (2.0 * U)) * SLACK;
        let (far, near) = (q / a, c / q);
        let e_far = ((e_q + far.abs() * e_a) / (size_a - e_a) + far.abs() * (2.0 * U)) * SLACK;
        let e_near = ((e_c + near.abs() * e_q) / (size_q - e_q) + near.abs() * (2.0 * U)) * SLACK;
        let mut known = some & size_a.gt(e_a * CLEAR) & size_q.gt(e_q * CLEAR);
        let (mut near, mut e_near) = (near, e_near);
        if let Some((lanes, negative)) = from {
            let away = negative.select(-b, b);
            known &= !lanes | away.gt(e_b);
            near = lanes.select(F8::splat(BEHIND), near);
            e_near = lanes.select(F8::ZERO, e_near);
        }
        // The slope at the far root has the sign of -B.
        let falls = b.gt(F8::ZERO);
        Roots {
            known,
            none,
            enter: (falls.select(far, near), falls.select(e_far, e_near)),
            leave: (falls.select(near, far), falls.select(e_near, e_far)),
        }
    }
}

/// The root of a plane along eight rays.
struct PlaneRoot {
    /// The ray surely crosses.
    crosses: M8,
    /// The ray surely stays above, or surely below, as far as it matters.
    above: M8,
    below: M8,
    /// It goes down.
    falls: M8,
    t: F8,
    e: F8,
}

impl Face {
    /// The crossing of a plane; `far` bounds every `t` that matters.
    #[inline(always)]
    fn crossing(&self, rays: &Seen, far: F8, from: Option<(M8, M8)>) -> PlaneRoot {
        let (b, e_b, c, e_c) = self.slope(rays);
        let (slope, e_slope) = (b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let mut crosses = size.gt(e_slope * CLEAR);
        let t = -c / slope;
        let e = ((e_c + t.abs() * e_slope) / (size - e_slope) + t.abs() * (2.0 * U)) * SLACK;
        let reach = ((size + e_slope) * far + e_c) * SLACK;
        let (above, below) = (c.gt(reach), c.lt(-reach));
        let (mut t, mut e) = (t, e);
        if let Some((lanes, negative)) = from {
            let away = negative.select(-slope, slope);
            crosses &= !lanes | away.gt(e_slope);
            t = lanes.select(F8::splat(BEHIND), t);
            e = lanes.select(F8::ZERO, e);
        }
        PlaneRoot { crosses, above, below, falls: slope.lt(F8::ZERO), t, e }
    }
}

/// The greatest of the entries, or with signs exchanged the least of the exits, so far.
struct Extreme {
    t: F8,
    e: F8,
    face: F8,
    /// The upper end of all others.
    others: F8,
}

impl Extreme {
    const NONE: Self = Self {
        t: F8::splat(f64::NEG_INFINITY),
        e: F8::ZERO,
        face: F8::ZERO,
        others: F8::splat(f64::NEG_INFINITY),
    };

    #[inline(always)]
    fn take(&mut self, lanes: M8, t: F8, e: F8, face: usize) {
        let better = lanes & t.gt(self.t);
        let loser = better.select(self.t + self.e, t + e);
        self.others = lanes.select(loser.max(self.others), self.others);
        self.t = better.select(t, self.t);
        self.e = better.select(e, self.e);
        self.face = better.select(F8::splat(face as f64), self.face);
    }
}

impl Outline {
    /// Offers the first crossing of each ray to `nearest`, under a number. `from` holds the rays that leave this very surface, if there are any.
    #[inline(always)]
    pub fn meet(&self, rays: &RayLanes, from: Option<&From8>, number: f64, nearest: &mut Nearest) {
        let seen = rays.seen_from(self.centre);
        if self.reach < f64::INFINITY && self.faces.len() > 1 && self.is_passed_by(rays, &seen) {
            return;
        }
        if self.convex {
            self.meet_convex(rays, &seen, from, number, nearest);
        } else {
            self.meet_walls(rays, &seen, from, number, nearest);
        }
    }

    /// Whether every ray surely passes the ball that holds the surface, or has left it behind.
    #[inline(always)]
    fn is_passed_by(&self, rays: &RayLanes, seen: &Seen) -> bool {
        let (h, d) = (seen.h, seen.d);
        let hd = h.x * d.x + h.y * d.y + h.z * d.z;
        let h2 = h.x * h.x + h.y * h.y + h.z * h.z;
        let size = seen.h1 * seen.h1;
        // |h|² - R², less than three roundings of |h|₁² and one of R².
        let outside = h2 - self.reach * self.reach - (size + self.reach * self.reach) * (8.0 * U);
        // The distance of the line is above R where (|h|² - R²) d² > (h·d)².
        let clear = (outside * rays.d2).gt((hd * hd + size * rays.d2 * (16.0 * U)) * SLACK);
        let behind = outside.gt(F8::ZERO) & hd.gt(seen.h1 * seen.d1 * (8.0 * U));
        (clear | behind | !rays.live).all()
    }

    /// A bound on every `t` at which the surface can be met.
    #[inline(always)]
    fn farthest(&self, rays: &RayLanes, seen: &Seen) -> F8 {
        if self.reach == f64::INFINITY {
            return rays.t_max.min(F8::splat(FAR));
        }
        // |t d| <= |h| + R, and √3 |d| >= |d|₁.
        ((seen.h1 + self.reach) * (1.75 * SLACK) / seen.d1).min(F8::splat(FAR))
    }

    /// The lanes of `from` that leave face `i`, and where its polynomial is negative at their start.
    #[inline(always)]
    fn leaving(&self, from: Option<&From8>, i: usize) -> Option<(M8, M8)> {
        from.map(|f| {
            let here = F8::splat(i as f64);
            let lanes = f.lanes & f.face.le(here) & f.face.ge(here);
            (lanes, if self.turned { !f.back } else { f.back })
        })
    }

    #[inline(always)]
    fn meet_convex(
        &self,
        rays: &RayLanes,
        seen: &Seen,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
    ) {
        // The latest entry, and the earliest exit by its negative.
        let (mut enter, mut leave) = (Extreme::NONE, Extreme::NONE);
        let (mut missed, mut unsure) = (!rays.live, M8::NONE);
        let far = self.farthest(rays, seen);
        for (i, face) in self.faces.iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                let root = face.crossing(seen, far, from);
                let known = root.crosses & root.e.lt(F8::splat(FAR));
                missed |= !root.crosses & root.above;
                unsure |= !known & !(!root.crosses & (root.above | root.below));
                enter.take(known & root.falls, root.t, root.e, i);
                leave.take(known & !root.falls, -root.t, root.e, i);
            } else {
                let line = face.along(seen);
                let roots = line.roots(from);
                let opens = line.a.gt(line.e_a * CLEAR);
                missed |= roots.none & opens;
                let ((t0, e0), (t1, e1)) = (roots.enter, roots.leave);
                let known = roots.known & opens & (e0 + e1).lt(F8::splat(FAR));
                unsure |= !known & !(roots.none & opens);
                enter.take(known, t0, e0, i);
                leave.take(known, -t1, e1, i);
            }
        }
        let limit = nearest.limit(rays);
        let earliest = enter.t - enter.e;
        let latest = leave.e - leave.t;
        missed |= earliest.gt(latest) | latest.lt(F8::ZERO) | earliest.gt(limit);
        let entered = (enter.t + enter.e).max(enter.others);
        let left = -((leave.t + leave.e).max(leave.others));
        let open = !(missed | unsure);
        let outside = open & entered.lt(left) & earliest.gt(F8::ZERO) & earliest.gt(enter.others);
        let inside = open & entered.lt(F8::ZERO) & left.gt(F8::ZERO) & (leave.t - leave.e).gt(leave.others);
        // From within, what is left is met.
        let t = outside.select(enter.t, -leave.t);
        let e = outside.select(enter.e, leave.e);
        let face = outside.select(enter.face, leave.face);
        // What is never left is not met again from within.
        missed |= open & entered.lt(F8::ZERO) & left.ge(NEVER) | inside & (t - e).gt(limit);
        let sure = (outside | inside) & !missed & (t + e).le(rays.t_max);
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

    #[inline(always)]
    fn meet_walls(
        &self,
        rays: &RayLanes,
        seen: &Seen,
        from: Option<&From8>,
        number: f64,
        nearest: &mut Nearest,
    ) {
        let far = self.farthest(rays, seen);
        for (i, face) in self.faces[..self.walls].iter().enumerate() {
            let from = self.leaving(from, i);
            if face.kind == FaceKind::Plane {
                let root = face.crossing(seen, far, from);
                let apart = !root.crosses & (root.above | root.below);
                let unsure = rays.live & !(root.crosses | apart);
                if unsure.any() {
                    nearest.doubt_from(unsure, F8::ZERO);
                }
                self.meet_wall(rays, seen, i, rays.live & root.crosses, (root.t, root.e), number, nearest);
            } else {
                let roots = face.along(seen).roots(from);
                let unsure = rays.live & !(roots.known | roots.none);
                if unsure.any() {
                    nearest.doubt_from(unsure, F8::ZERO);
                }
                let known = rays.live & roots.known;
                self.meet_wall(rays, seen, i, known, roots.enter, number, nearest);
                self.meet_wall(rays, seen, i, known, roots.leave, number, nearest);
            }
        }
    }

    /// Offers a root of one wall, where the others do not cut it off.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a loop body that two kinds of faces share")]
    fn meet_wall(
        &self,
        rays: &RayLanes,
        seen: &Seen,
        wall: usize,
        lanes: M8,
        (t, e): (F8, F8),
        number: f64,
        nearest: &mut Nearest,
    ) {
        let limit = nearest.limit(rays);
        let apart = (t + e).lt(F8::ZERO) | (t - e).gt(limit);
        let open = lanes & !apart;
        if !open.any() {
            return;
        }
        let (h, d) = (seen.h, seen.d);
        let y = Vec3::new(t.mul_add(d.x, h.x), t.mul_add(d.y, h.y), t.mul_add(d.z, h.z));
        let y1 = taxicab(y) * SLACK;
        // One rounding of h, one of y, and the error of t.
        let e1 = ((seen.h1 + y1) * (2.0 * U) + e * seen.d1) * SLACK;
        let (mut inside, mut outside) = (M8::ALL, M8::NONE);
        for (j, other) in self.faces.iter().enumerate() {
            if j == wall {
                continue;
            }
            let (f, e_f) = other.at(y, y1, e1);
            inside &= f.lt(-e_f);
            outside |= f.gt(e_f);
        }
        let sure = open & inside & (t - e).gt(F8::ZERO) & (t + e).le(rays.t_max);
        let unsure = open & !(sure | outside);
        self.put_down(sure, unsure, (t, e, F8::splat(wall as f64)), t - e, number, nearest);
    }
}
