//! What a blob is at a point: the sum of the fields, its gradient, and how it bends.

use super::Blob;
use crate::point::least_step;
use crate::quadric::body::tangents;
use crate::{CentredRay, LocalPoint, LocalRay, Need, RingRay, Root, Side, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Dd, Isa, Point3, Ring, Run, U, Vec3};

/// What is said of the surroundings of a point holds as far from it, along any axis, in units.
const ROOM: f64 = durer_math::scale::pow2(-16);
/// Pays for results below the normal range.
const TINY: f64 = durer_math::scale::pow2(-500);

/// The threshold without the sum of the fields: less inside.
struct Near {
    value: f64,
    error: f64,
    gradient: Vec3,
    gradient_err: f64,
    /// A bound on the norm of the second derivatives within [`ROOM`].
    bend: f64,
}

/// A crossing between two certain signs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub(super) s: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// It is the only one there.
    pub(super) alone: bool,
}

/// The points of a ray.
struct Points {
    d: Vec3,
    /// Along any axis.
    d_err: f64,
    from: From,
}

/// Where they are counted from.
enum From {
    /// In f64, within an error along each axis.
    Rounded(Vec3, Vec3, Vec3),
    Exact(RingRay<Run<Dd>>),
}

impl Points {
    #[inline(always)]
    fn rounded(at: &CentredRay<'_>) -> Self {
        Self { d: at.d, d_err: at.d_err.max_abs(), from: From::Rounded(at.o, at.o_err, at.d_err) }
    }

    fn exact(at: &CentredRay<'_>) -> Option<Self> {
        let ray = at.in_ring::<Run<Dd>>()?;
        let [x, y, z] = &ray.d;
        let along = |d: &Run<Dd>| enclosed(*d / ray.w);
        let ((x, ex), (y, ey), (z, ez)) = (along(x), along(y), along(z));
        let (d, d_err) = (Vec3::new(x, y, z), ex.max(ey).max(ez));
        d_err.is_finite().then_some(Self { d, d_err, from: From::Exact(ray) })
    }

    /// Of the direction, no less than it is.
    fn length(&self) -> f64 {
        (self.d.length() + 2.0 * self.d_err) * (1.0 + 8.0 * U)
    }

    /// How fast the threshold without the sum grows along the ray, within an error: each part of the dot product passes three roundings.
    fn slope(&self, near: &Near) -> (f64, f64) {
        let wrong = self.d.abs() * (4.0 * U) + Vec3::new(self.d_err, self.d_err, self.d_err);
        let doubt = near.gradient_err * self.length() + near.gradient.abs().dot(wrong);
        (near.gradient.dot(self.d), doubt * (1.0 + 16.0 * U))
    }

    /// The point at `s`, and how far off it may be along any axis.
    #[inline(always)]
    fn place(&self, s: f64) -> (Vec3, f64) {
        match &self.from {
            From::Rounded(o, o_err, d_err) => {
                let d = self.d;
                let y = Vec3::new(s.mul_add(d.x, o.x), s.mul_add(d.y, o.y), s.mul_add(d.z, o.z));
                (y, (*o_err + *d_err * s.abs() + y.abs() * U).max_abs() * (1.0 + 8.0 * U))
            }
            From::Exact(RingRay { o: [ox, oy, oz], d: [dx, dy, dz], w }) => {
                let along = |o: &Run<Dd>, d: &Run<Dd>| enclosed((*o + *d * Run::exact(s)) / *w);
                let ((x, ex), (y, ey), (z, ez)) = (along(ox, dx), along(oy, dy), along(oz, dz));
                (Vec3::new(x, y, z), ex.max(ey).max(ez))
            }
        }
    }
}

/// A number in f64, and how far off it may be.
#[inline(always)]
fn enclosed(x: Run<Dd>) -> (f64, f64) {
    let v = x.value();
    (v, (x.hi() - v).max(v - x.lo()).next_up())
}

impl Blob {
    /// At `y`, each coordinate of which is known within `e`.
    #[inline(always)]
    fn near(&self, y: Vec3, e: f64) -> Near {
        let mut sum =
            Near { value: self.threshold, error: 0.0, gradient: Vec3::ZERO, gradient_err: 0.0, bend: 0.0 };
        let (mut size, mut count) = (self.threshold, 4.0);
        self.tree.near(
            y,
            e + ROOM,
            #[inline(always)]
            |i| {
                let part = &self.parts[i];
                let added = part.added(y, e);
                sum.value -= added.value;
                sum.error += added.error;
                sum.gradient -= added.gradient;
                sum.gradient_err += added.gradient_err;
                sum.bend += part.bend;
                size += added.value.abs();
                count += 1.0;
            },
        );
        sum.error = (count * U).mul_add(size, sum.error) * (1.0 + (count + 8.0) * U);
        sum.bend *= 1.0 + count * U;
        sum
    }

    /// The sign of the threshold without the sum, if it is certain.
    #[inline(always)]
    fn is_out(&self, y: Vec3, e: f64) -> Option<bool> {
        let near = self.near(y, e);
        (near.value.abs() > near.error).then_some(near.value > 0.0)
    }

    /// The bracket `(s, lo, hi)` of a crossing with certain signs at its ends, narrower where the sum's own sign at points of the ray says so: its error there is a few
    /// roundings, and not the largest of a whole stretch. Where that is not as narrow as `enough`, or the crossing is not yet known to be `alone`, the points are those
    /// of the exact ray, by double-double, so that its map may turn lengths as it likes.
    #[inline(never)]
    pub(super) fn narrowed(
        &self,
        at: &CentredRay<'_>,
        mut found: Bracket,
        rises: bool,
        enough: impl Fn(f64) -> f64,
    ) -> Bracket {
        Isa::detect().run(
            #[inline(always)]
            || {
                if found.alone {
                    self.narrow(&Points::rounded(at), &mut found, rises);
                }
                if (!found.alone || found.hi - found.lo > enough(found.s))
                    && let Some(points) = Points::exact(at)
                {
                    let mut inner = found;
                    self.narrow(&points, &mut inner, rises);
                    if found.alone || self.is_alone(&points, &inner, &found, rises) {
                        found = Bracket { alone: true, ..inner };
                    }
                }
                found
            },
        )
    }

    #[inline(always)]
    fn narrow(&self, points: &Points, found: &mut Bracket, rises: bool) {
        let Bracket { s, lo, hi, .. } = found;
        let mut reach = f64::INFINITY;
        for _ in 0..2 {
            let (y, e) = points.place(*s);
            let near = self.near(y, e);
            let slope = near.gradient.dot(points.d);
            *s = (*s - near.value / slope).max(*lo).min(*hi);
            reach = 1.25 * near.error / slope.abs();
        }
        for step in [reach, 4.0 * reach] {
            let (before, after) = (*s - step, *s + step);
            if before > *lo {
                let (y, e) = points.place(before);
                if self.is_out(y, e) == Some(rises) {
                    *lo = before;
                }
            }
            if after < *hi {
                let (y, e) = points.place(after);
                if self.is_out(y, e) == Some(!rises) {
                    *hi = after;
                }
            }
        }
    }

    /// Whether a crossing in the inner of two brackets is the only one in both: the sum rises all over the inner one, or falls, and keeps its sign in the rest.
    fn is_alone(&self, points: &Points, inner: &Bracket, whole: &Bracket, rises: bool) -> bool {
        let (y, e) = points.place(0.5 * inner.lo + 0.5 * inner.hi);
        let near = self.near(y, e);
        let (slope, doubt) = points.slope(&near);
        let way = 0.5 * (inner.hi - inner.lo) * (1.0 + 8.0 * U) + f64::MIN_POSITIVE;
        let length = points.length();
        // The threshold without the sum falls where that rises.
        let least = if rises { -slope } else { slope } - doubt - near.bend * way * (length * length);
        way * length < ROOM
            && least > 0.0
            && self.keeps_its_sign(points, (inner.lo, whole.lo), rises)
            && self.keeps_its_sign(points, (inner.hi, whole.hi), !rises)
    }

    /// Whether the threshold without the sum is certainly above zero, or below, from one parameter to another: with a value `v`, a growth of at least `g` and second derivatives
    /// of at most `h` it is above `v + g w - h w²/2` a way `w` further on, so that each step goes as far as that is above zero.
    fn keeps_its_sign(&self, points: &Points, (from, to): (f64, f64), above: bool) -> bool {
        let away = if to < from { -1.0 } else { 1.0 };
        let sense = if above { 1.0 } else { -1.0 };
        let length = points.length();
        let mut s = from;
        // Next to a tangent a step goes about as far as the tangent's middle is.
        for _ in 0..64 {
            if (to - s) * away <= 0.0 {
                return true;
            }
            let (y, e) = points.place(s);
            let near = self.near(y, e);
            let (slope, doubt) = points.slope(&near);
            let (v, g, h) = (
                near.value * sense - near.error,
                slope * sense * away - doubt,
                near.bend * (length * length) + f64::MIN_POSITIVE,
            );
            let root = (g * g + 2.0 * h * v).sqrt();
            let reach = if g > 0.0 { (g + root) / h } else { 2.0 * v / (root - g) };
            let next = s + away * (reach * (1.0 - 1.0 / 64.0)).min(ROOM / length * 0.5);
            // A step of some units in the last place would be one of roundings.
            let goes_on = v > 0.0 && (next - s).abs() > s.abs() * (256.0 * U);
            if !goes_on {
                return false;
            }
            s = next;
        }
        false
    }

    pub(super) fn side_of(&self, point: &LocalPoint<'_>) -> Side {
        let (y, e) = point.relative_to(self.centre, self.scale);
        // Also for points far from what the boxes hold.
        let out = Isa::detect().run(
            #[inline(always)]
            || self.is_out(y, e.max_abs()),
        );
        match out {
            Some(true) => Side::Out,
            Some(false) => Side::In,
            None => Side::On,
        }
    }

    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.point_here(ray, root, need),
        )
    }

    #[inline(always)]
    fn point_here(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let at = ray.recentre(self.centre, self.scale);
        let s = root.s;
        let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;
        let (y1, near) = self.projected(y);
        // The frame's numbers; what their rounding loses is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, self.scale));
        let ((px, lx), (py, ly), (pz, lz)) =
            (axis(self.centre.x, y1.x), axis(self.centre.y, y1.y), axis(self.centre.z, y1.z));
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -self.scale) + TINY);
        let width = at.width(root.lo, root.hi);
        let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

        // A start at p ± off n + τ, τ what rounding adds away from the surface, has |f| >= off |G| - h (off² + |τ|²) - η; see `off` of quadrics.
        let tau = scale2(p.to_vec().max_abs(), -self.scale) * (6.0 * U) + TINY;
        let g = near.gradient;
        let length = g.length();
        let sure = length * (1.0 - 1.0 / (1u64 << 20) as f64) - 2.0 * near.gradient_err;
        let away = 2.0 * (g.abs().dot(lost) + near.bend * (lost.dot(lost) + tau * tau));
        let eta = near.value.abs() + 2.0 * near.error + away;
        let square = sure * sure - 4.0 * near.bend * eta;
        let back = |x: f64| scale2(x, self.scale);
        let off = 2.0 * eta / (sure + square.max(0.0).sqrt()) * (1.0 + 64.0 * U);
        let plain = sure > 0.0 && near.bend * (2.0 * eta) < sure * sure / 64.0 && off + tau < ROOM / 4.0;
        let n = g * (1.0 / length);
        let n = if n.is_finite() { n } else { at.d * (-1.0 / at.d.length()) };
        let off = if plain { off } else { self.leave(y1, n, lost.max_abs() + tau) };
        let least = if plain { f64::MIN_POSITIVE } else { least_step(p) };
        let dp = dp.map(|x| back(x) + f64::MIN_POSITIVE);
        let mut point = SurfacePoint::new(p, dp, back(off) + least, n.to_normal());
        (point.bend, point.slack) = if plain {
            (scale2(near.bend / sure * (1.0 + 1.0 / 1024.0), -self.scale), 0.0)
        } else {
            (f64::INFINITY, back(off / 64.0))
        };
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let (u, v) = tangents(n);
            point.uv = [u.dot(p.to_vec()), v.dot(p.to_vec())];
            (point.dpdu, point.dpdv) = (u, v);
        }
        point
    }

    /// `y` moved onto the surface by Newton's method along the gradient, as long as that helps.
    #[inline(always)]
    fn projected(&self, mut y: Vec3) -> (Vec3, Near) {
        let mut near = self.near(y, 0.0);
        for _ in 0..16 {
            if near.value.abs() <= 2.0 * near.error {
                break;
            }
            let step = near.gradient * (near.value / near.gradient.dot(near.gradient));
            let moved = y - step;
            if !(moved.is_finite() && step.max_abs() < 0.25) {
                break;
            }
            let there = self.near(moved, 0.0);
            if there.value.abs() >= near.value.abs() {
                break;
            }
            (y, near) = (moved, there);
        }
        (y, near)
    }

    /// How far to go along `n`, either way, until the sign is certain, also for all points within `e` and a 64th of the way.
    #[inline(always)]
    fn leave(&self, y: Vec3, n: Vec3, e: f64) -> f64 {
        let mut way = 64.0 * (e + U * y.max_abs());
        for _ in 0..120 {
            let e = e + way * (1.0 / 32.0);
            if self.is_out(y + n * way, e).is_some() && self.is_out(y - n * way, e).is_some() {
                break;
            }
            way *= 2.0;
        }
        way
    }
}
