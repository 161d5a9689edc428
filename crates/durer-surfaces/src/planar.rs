//! The part that all flat surfaces share: the one crossing of a ray and a plane, decided exactly
//! and bracketed tightly.
//!
//! Along a ray `o + s d` the *height* above a plane is `h + s g`, and the crossing is at
//! `s = -h/g`. Every decision about it is a sign: of the slope `g` (0: the ray is parallel to the
//! plane and never crosses it), of the height at an end of the ray's range (is the crossing in
//! it?), and of the polynomials that decide whether the crossing lies in a disc, within edges or
//! between slabs. Each is written once, generic over [`Ring`], and evaluated on the ladder:
//! `EFloat<f64>`, `EFloat<Dd>`, [`Dyadic`]. The first step uses the re-centred ray and includes its
//! rounding (rule W3), so it stands for the exact ray: a sign that is certain there is the sign for
//! the given ray.

mod three_points;
mod vectors;

pub(crate) use three_points::{ThreePoints, plane_along, plane_through_along};
pub(crate) use vectors::{
    cross, cross_and_error, dot, exact3, least_length, middle, minus, origin_from, scaled_to_one, seen_from,
    times, towards, unit,
};

use crate::point::least_step;
use crate::ray::PREVIEW_WIDTH;
use crate::{CentredRay, End, LocalPoint, LocalRay, RingRay, Root, RootKind, Side};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2};
use durer_math::rounding::{add_up, div_down, div_up, sub_down};
use durer_math::{Dd, Dyadic, EFloat, Isa, Point3, RaySide, Ring, U, Vec3};

/// A bracket that is wider than 32 ulp of `max(|t|, size / |d|)` is computed again in
/// double-double; here relative to `size / |d|`, with the smallest value of the ulp.
const NARROW: f64 = 32.0 * U;
/// Coordinates in a plane with this error need no refinement: it only enters `dp`, where it is at
/// most a few hundred times the rounding of the position.
pub(crate) const TIGHT: f64 = 256.0 * U;

/// Covers underflow in numbers of about unit size: far more than needed, so that it and its
/// multiples are normal numbers. On many CPUs an operation with a subnormal operand takes a hundred
/// times as long.
pub(crate) const TINY: f64 = durer_math::scale::pow2(-1000);

/// A plane, by its height function along a ray; the height is zero on the plane and grows along the
/// normal.
///
/// Both numbers may be multiplied by one positive factor, the same for a given ray.
pub(crate) trait PlaneForm {
    /// The derivative of the height by `s`.
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T;

    /// The height at `s = 0`; `None` only if `T` holds exact numbers and the plane's are not exact.
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T>;

    /// Height and slope for a filter, for planes for which one is faster.
    #[inline(always)]
    fn quick(&self, _ray: &CentredRay<'_>) -> Option<Quick> {
        None
    }

    /// The sign of the height at `s = 0`, exactly.
    fn exact_side(&self, ray: &RingRay<Dyadic>) -> Option<Ordering> {
        self.height(ray).map(|h| h.exact_sign())
    }

    /// Bounds of the height at `s = 0`, as tight as possible.
    fn height_bounds(&self, ray: &RingRay<Dyadic>) -> Option<(Dyadic, Dyadic)> {
        self.height(ray).map(|h| (h.clone(), h))
    }
}

/// A plane's height and slope along a ray in plain f64, each with a bound on its error: the filter
/// in front of the ladder.
pub(crate) struct Quick {
    height: f64,
    height_err: f64,
    slope: f64,
    slope_err: f64,
}

impl Quick {
    /// `height = n . q + lift`, `slope = n . d`; each number comes as a value and a bound on its
    /// error.
    ///
    /// In a dot product each term takes at most three roundings; the sum with the lift is one more.
    #[inline(always)]
    pub(crate) fn new(
        (n, n_err): (Vec3, Vec3),
        (q, q_err): (Vec3, Vec3),
        (lift, lift_err): (f64, f64),
        ray: &CentredRay<'_>,
    ) -> Self {
        let size = n.abs();
        let err = |v: Vec3, v_err: Vec3| size.dot(v.abs() * (3.0 * U) + v_err) + n_err.dot(v.abs() + v_err);
        let height = n.dot(q) + lift;
        let pay = |e: f64| e.mul_add(1.0 + 32.0 * U, TINY);
        Self {
            height,
            height_err: pay(height.abs().mul_add(U, err(q, q_err) + lift_err)),
            slope: n.dot(ray.d),
            slope_err: pay(err(ray.d, ray.d_err)),
        }
    }

    /// The crossing's parameter, a bound on its error, and the sign of the slope, if that is
    /// certain.
    #[inline(always)]
    fn crossing(&self) -> Option<(f64, f64, Ordering)> {
        let least = self.slope.abs() - self.slope_err;
        // False if it is NaN.
        if least > 0.0 {
            let s = -self.height / self.slope;
            let err = s.abs().mul_add(self.slope_err, self.height_err) / least;
            let err = s.abs().mul_add(U, err).mul_add(1.0 + 16.0 * U, TINY);
            return Some((s, err, if self.slope > 0.0 { Ordering::Greater } else { Ordering::Less }));
        }
        None
    }
}

/// A polynomial of a ray's coordinates, whose sign is to be decided.
pub(crate) trait AlongRay {
    /// The polynomial's value. `None` only where `T` cannot hold the inputs.
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T>;
}

/// A re-centred ray for the steps of the ladder, and the size of a surface.
pub(crate) struct Probe<'a> {
    pub(crate) ray: CentredRay<'a>,
    /// The surface's size in units of `2^scale`.
    size: f64,
}

/// An oriented line on each step of the ladder, relative to a centre, in units of `2^scale`.
pub(crate) trait Line {
    /// The line in f64, with its error.
    fn running(&self) -> RingRay<EFloat<f64>>;
    /// The line in double-double.
    fn double(&self) -> Option<RingRay<EFloat<Dd>>>;
    /// The exact line; `None` if it is not exactly known.
    fn exact(&self) -> Option<RingRay<Dyadic>>;
    /// A point of the exact line and its direction, in the surface's own frame, if they fit in f64.
    fn given(&self) -> Option<(Point3, Vec3)>;
    /// The centre and the scale of the line's coordinates.
    fn view(&self) -> (Point3, i32);

    /// The sign of a polynomial. `None` only if the line is not exactly known and its error leaves
    /// the sign open.
    #[inline(always)]
    fn sign<P: AlongRay>(&self, p: &P) -> Option<Ordering> {
        match p.eval(&self.running()).and_then(|x| x.sign()) {
            None => self.sign_climb(p),
            sign => sign,
        }
    }

    #[cold]
    #[inline(never)]
    fn sign_climb<P: AlongRay>(&self, p: &P) -> Option<Ordering> {
        let dd = Isa::detect().run(
            #[inline(always)]
            || self.double().and_then(|ray| p.eval(&ray)?.sign()),
        );
        dd.or_else(|| p.eval(&self.exact()?)?.sign())
    }
}

impl Line for Probe<'_> {
    #[inline(always)]
    fn running(&self) -> RingRay<EFloat<f64>> {
        #[inline(always)]
        fn run(v: Vec3, e: Vec3) -> [EFloat; 3] {
            [EFloat::with_error(v.x, e.x), EFloat::with_error(v.y, e.y), EFloat::with_error(v.z, e.z)]
        }
        let ray = &self.ray;
        RingRay { o: run(ray.o, ray.o_err), d: run(ray.d, ray.d_err), w: EFloat::exact(1.0) }
    }
    #[inline(always)]
    fn double(&self) -> Option<RingRay<EFloat<Dd>>> {
        self.ray.in_double()
    }
    fn exact(&self) -> Option<RingRay<Dyadic>> {
        self.ray.in_ring()
    }
    fn given(&self) -> Option<(Point3, Vec3)> {
        let local = self.ray.local();
        (local.o_err == Vec3::ZERO && local.d_err == Vec3::ZERO).then_some((local.o, local.d))
    }
    #[inline(always)]
    fn view(&self) -> (Point3, i32) {
        (self.ray.centre, self.ray.scale)
    }
}

/// The crossing of a ray and a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// The local parameter, and its bracket.
    pub(crate) s: f64,
    pub(crate) s_lo: f64,
    pub(crate) s_hi: f64,
    /// The bracket in the caller's parameter.
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// The sign of normal . direction.
    pub(crate) sign: i8,
}

impl<'a> Probe<'a> {
    /// The ray relative to `centre`, in units of a power of two just above `size`, the surface's
    /// size.
    #[inline(always)]
    pub(crate) fn new(ray: &'a LocalRay<'a>, centre: Point3, size: f64) -> Self {
        let scale = exponent(size) + 1;
        Self::with_scale(ray, centre, scale, scale2(size, -scale))
    }

    /// The ray relative to `centre`, in units of `2^scale`; `size` is the surface's size in these
    /// units.
    #[inline(always)]
    pub(crate) fn with_scale(ray: &'a LocalRay<'a>, centre: Point3, scale: i32, size: f64) -> Self {
        Self::of(ray.recentre(centre, scale), size)
    }

    /// A re-centred ray, with the surface's size in its units.
    #[inline(always)]
    pub(crate) fn of(ray: CentredRay<'a>, size: f64) -> Self {
        Self { ray, size }
    }

    /// The crossing with a plane, anywhere on the line; `None` if the slope is exactly zero, so
    /// that there is none. A crossing beyond the range of f64 has an infinite `s`.
    #[inline(always)]
    pub(crate) fn crossing<F: PlaneForm>(&self, plane: &F) -> Option<Crossing> {
        if let Some((s, err, sign)) = plane.quick(&self.ray).and_then(|quick| quick.crossing()) {
            let crossing = self.bracketed(s, sub_down(s, err), add_up(s, err), sign);
            if self.is_narrow(&crossing) {
                return Some(crossing);
            }
        }
        self.crossing_climb(plane)
    }

    /// [`Probe::crossing`], but only if the crossing may matter: not where the ray was spawned, not
    /// certainly outside its range or the sink's. A crossing that f64 can dismiss needs no narrow
    /// bracket.
    #[inline(always)]
    pub(crate) fn crossing_within<F: PlaneForm>(&self, plane: &F, range: (f64, f64)) -> Option<Crossing> {
        let matters = |c: &Crossing| !self.leaves(c) && !c.is_outside(range) && self.may_admit(c);
        if let Some((s, err, sign)) = plane.quick(&self.ray).and_then(|quick| quick.crossing()) {
            if self.departs(sign as i8) {
                return None;
            }
            let crossing = self.bracketed(s, sub_down(s, err), add_up(s, err), sign);
            if s.is_finite() && !matters(&crossing) {
                return None;
            }
            if self.is_narrow(&crossing) {
                return Some(crossing);
            }
        }
        self.crossing_climb(plane).filter(matters)
    }

    /// [`Probe::crossing`], but only as narrow as the error of a position needs.
    #[inline(always)]
    fn crossing_for_a_point<F: PlaneForm>(&self, plane: &F) -> Option<Crossing> {
        if let Some((s, err, sign)) = plane.quick(&self.ray).and_then(|quick| quick.crossing())
            && err <= TIGHT * (s.abs() + self.size)
        {
            return Some(self.bracketed(s, sub_down(s, err), add_up(s, err), sign));
        }
        self.crossing(plane)
    }

    /// A crossing with a known bracket: that one if it is narrow, else a better one.
    #[inline(always)]
    pub(crate) fn refined<F: PlaneForm>(
        &self,
        plane: &F,
        s: f64,
        s_lo: f64,
        s_hi: f64,
        sign: i8,
    ) -> Option<Crossing> {
        let crossing = self.bracketed(s, s_lo, s_hi, sign.cmp(&0));
        if self.is_narrow(&crossing) { Some(crossing) } else { self.crossing_climb(plane) }
    }

    #[cold]
    #[inline(never)]
    fn crossing_climb<F: PlaneForm>(&self, plane: &F) -> Option<Crossing> {
        let in_double = Isa::detect().run(
            #[inline(always)]
            || self.crossing_in_double(plane),
        );
        let best = match in_double {
            ControlFlow::Break(crossing) => return crossing,
            ControlFlow::Continue(best) => best,
        };
        // The remaining cases: rays that are almost parallel, numbers at the ends of the range of
        // f64, inexact rays.
        let Some(ray) = self.ray.in_ring::<Dyadic>() else { return best };
        let slope = plane.slope(&ray);
        let Some((low, high)) = plane.height_bounds(&ray) else { return best };
        if slope.is_zero() {
            return None;
        }
        let most = Dyadic::exact(f64::MAX) * slope.clone().abs();
        let beyond = low.clone().abs() > most && high.clone().abs() > most;
        let (lo, hi) = quotient_bounds(&-high, &-low, &slope);
        let middle = 0.5 * lo + 0.5 * hi;
        // Only a crossing that is certainly beyond the range of f64 is reported there.
        let s = if beyond { middle } else { middle.clamp(f64::MIN, f64::MAX) };
        Some(self.bracketed(s, lo, hi, slope.exact_sign()))
    }

    /// The crossing in double-double: `Break` if it is decided, else the best bracket so far.
    #[inline(always)]
    fn crossing_in_double<F: PlaneForm>(&self, plane: &F) -> ControlFlow<Option<Crossing>, Option<Crossing>> {
        // A slope of zero is certain already in f64 if each of its terms is zero.
        if plane.slope(&self.running()).sign() == Some(Ordering::Equal) {
            return ControlFlow::Break(None);
        }
        let Some(ray) = self.ray.in_double() else { return ControlFlow::Continue(None) };
        let slope = plane.slope(&ray);
        let (Some(sign), Some(height)) = (slope.sign(), plane.height(&ray)) else {
            return ControlFlow::Continue(None);
        };
        if sign.is_eq() {
            return ControlFlow::Break(None);
        }
        let s = -(height / slope);
        let crossing = self.bracketed(s.value(), s.lo(), s.hi(), sign);
        if self.is_narrow(&crossing) {
            ControlFlow::Break(Some(crossing))
        } else {
            ControlFlow::Continue(Some(crossing))
        }
    }

    /// Whether a bracket is narrow enough.
    #[inline(always)]
    pub(crate) fn is_narrow(&self, c: &Crossing) -> bool {
        let (width, t) = (c.s_hi - c.s_lo, c.lo.abs().min(c.hi.abs()));
        if self.ray.local().rough {
            // A bracket without information has two infinite ends.
            return width <= PREVIEW_WIDTH * self.size
                || (t < f64::INFINITY && c.hi - c.lo <= PREVIEW_WIDTH * t);
        }
        // |d| < 4; the exact length is computed only where it matters.
        width <= NARROW * 0.25 * self.size
            || c.hi - c.lo <= 32.0 * (t.next_up() - t)
            || width * self.ray.d.length() <= NARROW * self.size
    }

    /// A crossing at `s`, within a bracket of `s`, and the sign of the slope.
    #[inline(always)]
    pub(crate) fn bracketed(&self, s: f64, s_lo: f64, s_hi: f64, slope: Ordering) -> Crossing {
        let (lo, hi) = self.ray.bracket(s_lo, s_hi);
        Crossing { s, s_lo, s_hi, lo, hi, sign: slope as i8 }
    }

    /// Whether a crossing's bracket meets the ray's range at all.
    #[inline(always)]
    pub(crate) fn may_admit(&self, crossing: &Crossing) -> bool {
        // A parameter beyond the range of f64 is in no range.
        crossing.s.is_finite()
            && crossing.lo < f64::INFINITY
            && crossing.hi > f64::NEG_INFINITY
            && self.ray.admits(crossing.lo, crossing.hi) != Some(false)
    }

    /// Whether a crossing is in the ray's closed range, exactly. If the ray is not exactly known, a
    /// crossing that cannot be excluded counts as in the range.
    #[inline(always)]
    pub(crate) fn admits<F: PlaneForm>(&self, plane: &F, crossing: &Crossing) -> bool {
        match self.ray.admits(crossing.lo, crossing.hi) {
            Some(admitted) => admitted,
            None => self.admits_climb(plane, crossing),
        }
    }

    #[cold]
    #[inline(never)]
    fn admits_climb<F: PlaneForm>(&self, plane: &F, crossing: &Crossing) -> bool {
        [End::Min, End::Max].into_iter().all(|end| {
            let at = self.ray.end(end);
            let (surely, never) = match end {
                End::Min => (crossing.lo >= at, crossing.hi < at),
                End::Max => (crossing.hi <= at, crossing.lo > at),
            };
            if surely || never {
                return surely;
            }
            let Some(height) = self.height_at_end(plane, end) else { return true };
            // Before the crossing the height has the sign opposite to the slope's.
            let ahead = if crossing.sign > 0 { height.reverse() } else { height };
            match end {
                End::Min => ahead.is_ge(),
                End::Max => ahead.is_le(),
            }
        })
    }

    /// The sign of the height at an end of the range.
    fn height_at_end<F: PlaneForm>(&self, plane: &F, end: End) -> Option<Ordering> {
        let dd = Isa::detect().run(
            #[inline(always)]
            || {
                let ray = advanced(self.ray.in_double()?, &self.ray.end_in_ring(end));
                plane.height(&ray)?.sign()
            },
        );
        if dd.is_some() {
            return dd;
        }
        let ray = self.ray.in_ring::<Dyadic>()?;
        plane.exact_side(&advanced(ray, &self.ray.end_in_ring(end)))
    }

    /// Whether the ray was spawned on this very plane, from the side towards which it goes, and its
    /// range starts at or after its start: then there is no crossing, and this needs no exact
    /// arithmetic.
    #[inline(always)]
    pub(crate) fn leaves(&self, crossing: &Crossing) -> bool {
        self.departs(crossing.sign)
    }

    /// [`Probe::leaves`] by the sign of normal . direction alone.
    #[inline(always)]
    fn departs(&self, sign: i8) -> bool {
        match self.ray.source() {
            Some(RaySide::Front) => sign > 0 && self.ray.end(End::Min) >= 0.0,
            Some(RaySide::Back) => sign < 0 && self.ray.end(End::Min) >= 0.0,
            None => false,
        }
    }

    /// The point of a crossing relative to the centre, in units of `2^scale`, and a bound on its
    /// error per axis.
    #[inline(always)]
    pub(crate) fn place(&self, crossing: &Crossing) -> (Vec3, Vec3) {
        let half = (crossing.s_hi - crossing.s).max(crossing.s - crossing.s_lo);
        let axis = |i: usize| {
            let (o, d) = (self.ray.o[i], self.ray.d[i]);
            let x = crossing.s.mul_add(d, o);
            let from_s = d.abs().mul_add(half, crossing.s.abs() * self.ray.d_err[i]);
            let err = x.abs().mul_add(U, self.ray.o_err[i] + from_s + half * self.ray.d_err[i]);
            (x, err.mul_add(1.0 + 16.0 * U, TINY))
        };
        let ((x, ex), (y, ey), (z, ez)) = (axis(0), axis(1), axis(2));
        (Vec3::new(x, y, z), Vec3::new(ex, ey, ez))
    }

    /// A root for a crossing that is in the range.
    #[inline(always)]
    pub(crate) fn root(&self, crossing: &Crossing, face: u32, tag: [f64; 2]) -> Root {
        // The crossing is in the range, so the range bounds it too.
        let lo = crossing.lo.max(self.ray.end(End::Min));
        let hi = crossing.hi.min(self.ray.end(End::Max));
        let t = self.ray.t(crossing.s).max(lo).min(hi).clamp(f64::MIN, f64::MAX);
        Root { t, lo, hi, s: crossing.s, tag, face, sign: crossing.sign, kind: RootKind::Simple }
    }
}

impl Crossing {
    /// Whether a sink's range excludes this crossing.
    #[inline(always)]
    pub(crate) fn is_outside(&self, (lo, hi): (f64, f64)) -> bool {
        self.hi < lo || self.lo > hi
    }
}

/// The ray with its parameter advanced by `step`.
#[inline(always)]
fn advanced<T: Ring>(ray: RingRay<T>, step: &T) -> RingRay<T> {
    let [a, b, c] = ray.o;
    let [x, y, z] = ray.d.clone();
    let o = [a + step.clone() * x, b + step.clone() * y, c + step.clone() * z];
    RingRay { o, ..ray }
}

/// The line with its denominator near one, for which high powers stay in range.
#[inline(always)]
pub(crate) fn with_denominator_near_one(ray: RingRay<EFloat<Dd>>) -> RingRay<EFloat<Dd>> {
    let k = -exponent(ray.w.value());
    RingRay { o: ray.o.map(|x| x.scale2(k)), d: ray.d.map(|x| x.scale2(k)), w: ray.w.scale2(k) }
}

/// The exact line and `true`; if it is not exactly known, the line with the rounded numbers, and
/// `false`.
pub(crate) fn exact_line<L: Line>(line: &L) -> (RingRay<Dyadic>, bool) {
    match line.exact() {
        Some(exact) => (exact, true),
        None => {
            let RingRay { o, d, w } = line.running();
            let exact = |x: EFloat| Dyadic::new(x.v).unwrap_or(Dyadic::ZERO);
            (RingRay { o: o.map(exact), d: d.map(exact), w: exact(w) }, false)
        }
    }
}

/// Bounds in f64 of every `n / d` with `low <= n <= high`; `d` is not zero.
pub(crate) fn quotient_bounds(low: &Dyadic, high: &Dyadic, d: &Dyadic) -> (f64, f64) {
    // First into the range of f64: only the quotient matters.
    let k = i32::try_from(-d.exponent().unwrap_or(0)).unwrap_or(0);
    let scaled = |x: &Dyadic| Ring::scale2(x.clone(), k).to_bounds();
    let ((n0, _), (_, n1), (d0, d1)) = (scaled(low), scaled(high), scaled(d));
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in [n0, n1] {
        for d in [d0, d1] {
            lo = lo.min(div_down(n, d));
            hi = hi.max(div_up(n, d));
        }
    }
    (lo, hi)
}

/// A point on each step of the ladder, as the start of a line in a fixed direction, relative to a
/// centre.
pub(crate) struct PointLine<'a> {
    point: &'a LocalPoint<'a>,
    direction: Vec3,
    centre: Point3,
    scale: i32,
    run: RingRay<EFloat<f64>>,
}

impl<'a> PointLine<'a> {
    /// The line from `point` along `direction`, which may be zero.
    pub(crate) fn new(point: &'a LocalPoint<'a>, direction: Vec3, centre: Point3, scale: i32) -> Self {
        let (p, e) = (point.p, point.p_err);
        let p = core::array::from_fn(|i| EFloat::with_error(p[i], e[i]));
        let run = point_line((p, EFloat::exact(1.0)), direction, centre, scale);
        Self { point, direction, centre, scale, run }
    }

    /// The exact side of a plane on which the point lies: above (`Greater`), on it, or below.
    #[inline(always)]
    pub(crate) fn side_of<F: PlaneForm>(&self, plane: &F) -> Option<Ordering> {
        if let Some(sign) = plane.height(&self.run).and_then(|h| h.sign()) {
            return Some(sign);
        }
        let dd = self.double().and_then(|ray| plane.height(&ray)?.sign());
        dd.or_else(|| plane.exact_side(&self.exact()?))
    }
}

#[inline(always)]
fn point_line<T: Ring>((p, w): ([T; 3], T), direction: Vec3, centre: Point3, scale: i32) -> RingRay<T> {
    let [x, y, z] = minus(p, times(exact3(centre.to_vec()), &w));
    let o = [x.scale2(-scale), y.scale2(-scale), z.scale2(-scale)];
    RingRay { o, d: times(exact3(direction), &w), w }
}

impl Line for PointLine<'_> {
    #[inline(always)]
    fn running(&self) -> RingRay<EFloat<f64>> {
        self.run.clone()
    }
    #[inline(always)]
    fn double(&self) -> Option<RingRay<EFloat<Dd>>> {
        Some(point_line(self.point.in_ring()?, self.direction, self.centre, self.scale))
    }
    fn exact(&self) -> Option<RingRay<Dyadic>> {
        Some(point_line(self.point.in_ring()?, self.direction, self.centre, self.scale))
    }
    fn given(&self) -> Option<(Point3, Vec3)> {
        None
    }
    #[inline(always)]
    fn view(&self) -> (Point3, i32) {
        (self.centre, self.scale)
    }
}

/// The side of a solid whose inside is below, from the side of a plane.
#[inline(always)]
pub(crate) fn below_is_in(side: Option<Ordering>) -> Side {
    match side {
        Some(Ordering::Less) => Side::In,
        Some(Ordering::Greater) => Side::Out,
        // Only an inexact point has no certain side; it may lie on the boundary.
        Some(Ordering::Equal) | None => Side::On,
    }
}

/// The point of a ray's crossing with a plane, moved onto the plane along its normal, and a bound
/// on its error per axis.
///
/// `n` is the normal, `n2` its squared length, `lift` the height of the centre above the plane, all
/// in the form's units.
#[inline(always)]
pub(crate) fn foot_point<F: PlaneForm>(
    probe: &Probe<'_>,
    plane: &F,
    n: Vec3,
    n2: f64,
    lift: f64,
) -> (Point3, Vec3) {
    let Some(crossing) = probe.crossing_for_a_point(plane) else {
        // Not a crossing of this ray: nothing can be computed.
        let unknown = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
        return (probe.ray.centre, unknown);
    };
    let (x, err) = probe.place(&crossing);
    let shift = n * ((n.dot(x) + lift) / n2);
    let moved = x - shift;
    let c = probe.ray.centre;
    let unit = |v: f64| scale2(v, probe.ray.scale);
    let axis = |i: usize| {
        let p = c[i] + unit(moved[i]);
        let err = unit(err[i] + shift[i].abs() + moved[i].abs() * U) + p.abs() * U;
        (p, err.mul_add(1.0 + 16.0 * U, f64::MIN_POSITIVE))
    };
    let ((x, ex), (y, ey), (z, ez)) = (axis(0), axis(1), axis(2));
    (Point3::new(x, y, z), Vec3::new(ex, ey, ez))
}

/// A bound on the distance of `p` (a point given in f64) from the plane, such that a step of that
/// length along the rounded unit normal provably leaves the plane; see
/// [`SurfacePoint::off`](crate::SurfacePoint::off).
///
/// `length` is a lower bound of the normal's length in the units of the form's height.
#[inline(always)]
pub(crate) fn clearance<F: PlaneForm>(plane: &F, p: Point3, centre: Point3, scale: i32, length: f64) -> f64 {
    let c = centre.to_array();
    let q = p.to_array();
    let o = core::array::from_fn(|i| (EFloat::<f64>::exact(q[i]) - EFloat::exact(c[i])).scale2(-scale));
    let zero = || EFloat::exact(0.0);
    let at = RingRay { o, d: [zero(), zero(), zero()], w: EFloat::exact(1.0) };
    let height = plane.height(&at).map_or(f64::INFINITY, EFloat::magnitude);
    // A step `off` along the rounded unit normal moves by at least `off (1 - 8u)` along the exact
    // one.
    scale2(height / length, scale).mul_add(1.0 + 32.0 * U, least_step(p))
}

/// Two quotients with a common denominator: the coordinates in a plane of the point where a ray
/// crosses it.
pub(crate) trait Ratios {
    /// Both numerators, then the denominator.
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3];
}

/// Both quotients with bounds: in f64 if that is tight, else further up the ladder.
#[inline(always)]
pub(crate) fn ratios<R: Ratios>(probe: &Probe<'_>, r: &R) -> [EFloat; 2] {
    let [a, b, d] = r.eval(&probe.running());
    let first = [a / d, b / d];
    let tight = |x: &[EFloat; 2]| x.iter().all(|x| x.e <= TIGHT);
    if tight(&first) { first } else { ratios_climb(probe, r).unwrap_or(first) }
}

#[cold]
#[inline(never)]
fn ratios_climb<R: Ratios>(probe: &Probe<'_>, r: &R) -> Option<[EFloat; 2]> {
    let dd = Isa::detect().run(
        #[inline(always)]
        || {
            let [a, b, d] = r.eval(&probe.double()?);
            #[inline(always)]
            fn nearest(x: EFloat<Dd>) -> EFloat {
                EFloat::with_error(x.v.hi, (x.e + x.v.lo.abs()) * (1.0 + 8.0 * U))
            }
            Some([nearest(a / d), nearest(b / d)])
        },
    )?;
    if dd.iter().all(|x| x.e <= TIGHT) {
        return Some(dd);
    }
    let Some(ray) = probe.exact() else { return Some(dd) };
    let [a, b, d] = r.eval(&ray);
    if d.is_zero() {
        return None;
    }
    Some([a, b].map(|n| {
        let (lo, hi) = quotient_bounds(&n, &n, &d);
        EFloat::with_error(0.5 * lo + 0.5 * hi, (hi - lo) * (1.0 + 8.0 * U))
    }))
}
