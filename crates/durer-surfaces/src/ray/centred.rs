//! A ray relative to a surface's centre, in units of its size, starting at the point nearest to the
//! centre (rules W3 and W4).

use super::{End, LocalRay, ParameterMap, RingRay, TINY, U, relative};
use crate::Root;
use durer_math::eft::{scale2, two_sum};
use durer_math::{Dd, EFloat, Point3, RaySide, Ring, Vec3};

/// A ray with fewer roundings than this stays in f64: the loss is then less than the cost of
/// double-double.
const MANY: f64 = 32.0;

/// A local ray re-centred and rescaled: its points are `centre + 2^scale (o + s d)`, and
/// `t = t0 + 2^k s`.
#[derive(Clone, Copy, Debug)]
pub struct CentredRay<'a> {
    /// The point at `s = 0`, relative to the centre, in units of `2^scale`.
    pub o: Vec3,
    /// The direction; its largest |component| is in `[1, 2)`.
    pub d: Vec3,
    /// Per-axis bound on the error of `o`.
    pub o_err: Vec3,
    /// Per-axis bound on the error of `d`.
    pub d_err: Vec3,
    /// The centre, in the local frame.
    pub centre: Point3,
    /// The exponent of the unit of length.
    pub scale: i32,
    pub(super) step: f64,
    pub(super) clock: ParameterMap,
    pub(super) ray: &'a LocalRay<'a>,
}

impl<'a> CentredRay<'a> {
    /// `1 / d.d`, rounded.
    #[inline(always)]
    pub fn inverse_d2(&self) -> f64 {
        self.ray.inverse_d2
    }

    /// The ray that was re-centred.
    #[inline(always)]
    pub fn local(&self) -> &'a LocalRay<'a> {
        self.ray
    }

    /// The side on which the ray starts, if it was spawned on the very primitive under test.
    #[inline(always)]
    pub fn source(&self) -> Option<RaySide> {
        self.ray.source
    }

    /// For a ray that was spawned on this primitive and whose range starts at `t = 0`: the side,
    /// the face and the `s` of the start.
    #[inline(always)]
    pub fn spawned(&self) -> Option<(RaySide, u32, EFloat)> {
        let side = self.ray.source?;
        if self.ray.t_min != 0.0 {
            return None;
        }
        let s = -self.shift();
        Some((side, self.ray.source_face, EFloat::with_error(s, s.abs().mul_add(4.0 * U, TINY))))
    }

    /// The exact ray in a ring, in this ray's parameter, centre and unit of length.
    pub fn in_ring<T: Ring>(&self) -> Option<RingRay<T>> {
        Some(self.centred(self.ray.in_ring()?))
    }

    /// [`CentredRay::in_ring`] in double-double; uses the local ray's [cache](LocalRay::keeping).
    #[inline(always)]
    pub(crate) fn in_double(&self) -> Option<RingRay<EFloat<Dd>>> {
        Some(self.centred(self.ray.in_double()?))
    }

    /// Converts the local ray to this centre and unit.
    #[inline(always)]
    fn centred<T: Ring>(&self, ray: RingRay<T>) -> RingRay<T> {
        let RingRay { o: [x, y, z], d, w } = ray.moved(self.centre, self.step);
        // Lengths are divided by 2^scale; so is the direction, and the parameter's unit is 2^scale:
        // d stays.
        let k = -self.scale;
        RingRay { o: [x.scale2(k), y.scale2(k), z.scale2(k)], d, w }
    }

    /// The ray with origin and direction rounded from double-double, if its maps have turned one
    /// rounding into more than 32, in a frame in which the surface has the size `size`: a shear
    /// creates large terms that cancel again, but not their roundings.
    #[inline(always)]
    #[must_use]
    pub fn sharp(self, size: f64) -> Self {
        let off = self.o_err.max_abs() + self.d_err.max_abs() * size;
        if off <= (MANY * U) * (self.o.max_abs() + 2.0 * size) {
            return self;
        }
        self.in_double().map_or(self, |exact| self.rounded_from(&exact))
    }

    #[cold]
    #[inline(never)]
    fn rounded_from(self, RingRay { o, d, w }: &RingRay<EFloat<Dd>>) -> Self {
        // Divided by `w`, in f64, and how far off that may be.
        let rounded = |x: &[EFloat<Dd>; 3]| {
            let mut v = [(0.0, 0.0); 3];
            for (v, x) in v.iter_mut().zip(x) {
                let x = *x / *w;
                v.0 = x.value();
                v.1 = (x.hi() - v.0).max(v.0 - x.lo()).next_up();
            }
            (Vec3::new(v[0].0, v[1].0, v[2].0), Vec3::new(v[0].1, v[1].1, v[2].1))
        };
        let ((o, o_err), (d, d_err)) = (rounded(o), rounded(d));
        if o_err.is_finite() && d_err.is_finite() { Self { o, d, o_err, d_err, ..self } } else { self }
    }

    /// The caller's parameter for `s`, rounded, but never infinite.
    #[inline(always)]
    pub fn t(&self, s: f64) -> f64 {
        let (hi, lo, _) = self.clock.shift();
        (hi + (lo + scale2(s, self.clock.k))).clamp(f64::MIN, f64::MAX)
    }

    /// The caller's bracket for the bracket `[lo, hi]` of `s`, rounded outward.
    #[inline(always)]
    pub fn bracket(&self, lo: f64, hi: f64) -> (f64, f64) {
        #[inline(always)]
        fn outward(x: f64, away: f64) -> f64 {
            if away < 0.0 { x.next_down() } else { x.next_up() }
        }
        // A product beyond the range of f64 is at least the greatest number: the sum with the shift may
        // be within the range again.
        #[inline(always)]
        fn within_range(x: f64, away: f64) -> f64 {
            match away < 0.0 {
                true if x > f64::MAX => f64::MAX,
                false if x < f64::MIN => f64::MIN,
                _ => x,
            }
        }
        // A rounding is at most half an ulp: stepping outward keeps the enclosure.
        #[inline(always)]
        fn sum(a: f64, b: f64, away: f64) -> f64 {
            let (sum, e) = two_sum(a, b);
            if e == 0.0 || !sum.is_finite() || (e > 0.0) != (away > 0.0) { sum } else { outward(sum, away) }
        }
        #[inline(always)]
        fn end(s: f64, k: i32, away: f64, (shift_hi, shift_lo, err): (f64, f64, f64)) -> f64 {
            let scaled = scale2(s, k);
            let scaled =
                if scaled.abs() < f64::MIN_POSITIVE && s != 0.0 { outward(scaled, away) } else { scaled };
            let low = sum(shift_lo, within_range(scaled, away), away);
            let low = if err > 0.0 { outward(away.mul_add(err, low), away) } else { low };
            sum(shift_hi, low, away)
        }
        let shift = self.clock.shift();
        (end(lo, self.clock.k, -1.0, shift), end(hi, self.clock.k, 1.0, shift))
    }

    /// Whether a crossing in the caller's bracket `[lo, hi]` is in the ray's closed range; `None`
    /// if the bracket straddles an end. A crossing that is not less than the greatest f64 is not.
    #[inline(always)]
    pub fn admits(&self, lo: f64, hi: f64) -> Option<bool> {
        let (t_min, t_max) = (self.ray.t_min, self.ray.t_max);
        let beyond = lo >= f64::MAX || hi <= f64::MIN;
        if lo >= t_min && hi <= t_max && !beyond {
            Some(true)
        } else if hi < t_min || lo > t_max || beyond {
            Some(false)
        } else {
            None
        }
    }

    /// Numbers `(lo, hi)` such that an `s` outside `[lo, hi]` has its `t` outside the caller's
    /// range `[t_lo, t_hi]`.
    #[inline(always)]
    pub fn window(&self, (t_lo, t_hi): (f64, f64)) -> (f64, f64) {
        let (shift_hi, shift_lo, err) = self.clock.shift();
        let slack = |t: f64| (t.abs() + shift_hi.abs()).mul_add(8.0 * U, err);
        let lo = (t_lo - shift_hi) - shift_lo - slack(t_lo);
        let hi = (t_hi - shift_hi) - shift_lo + slack(t_hi);
        let back = |x: f64| scale2(x, -self.clock.k);
        // An infinite end minus an infinite slack is NaN, and gives no bound.
        let bound = |x: f64, none: f64| if x.is_nan() { none } else { x };
        (bound(back(lo) - TINY, f64::NEG_INFINITY), bound(back(hi) + TINY, f64::INFINITY))
    }

    /// For each end of a range of `t`, numbers `(lo, hi)` such that brackets of `s` outside
    /// `[lo, hi]` have brackets of `t` that do not hold that end.
    pub fn ends(&self, (t_lo, t_hi): (f64, f64)) -> [(f64, f64); 2] {
        // The slack of a window exceeds the rounding of a bracket, which is an error of the
        // parameter map and three units in the last place.
        let end = |t: f64| if t.is_finite() { self.window((t, t)) } else { (t, t) };
        [end(t_lo), end(t_hi)]
    }

    /// The negated `s` of `t = 0`, rounded: `t = 2^k (origin + s)`.
    #[inline(always)]
    pub fn shift(&self) -> f64 {
        scale2(self.clock.shift().0, -self.clock.k)
    }

    /// A bound on the distance in `s` between a root's `s` and its exact crossing: the length of the
    /// root's bracket. A bracket that an end of the ray's range cuts short may not hold `s`.
    #[inline(always)]
    pub fn width(&self, root: &Root) -> f64 {
        let (lo, hi) = self.bracket(root.s, root.s);
        let length = root.hi.max(hi) - root.lo.min(lo);
        scale2(length * (1.0 + 4.0 * U), -self.clock.k) + TINY
    }

    /// The ray's point at an end of its range, relative to the centre, in units of `2^scale`, with
    /// a bound on its error. Unlike `o + s d` it does not carry the rounding of the closest
    /// approach: where rays start on a surface, this is the sharper form.
    #[inline(always)]
    pub fn point_at_end(&self, end: End) -> (Vec3, Vec3) {
        let (p, err) = self.ray.point_at(self.end(end));
        let (x, e) = relative(p, err, self.centre);
        (x.map(|x| scale2(x, -self.scale)), e.map(|x| scale2(x, -self.scale) + TINY))
    }

    /// An end of the caller's range.
    #[inline(always)]
    pub fn end(&self, end: End) -> f64 {
        match end {
            End::Min => self.ray.t_min,
            End::Max => self.ray.t_max,
        }
    }

    /// The exact `s` of an end of the range, in a ring. The end must be finite.
    pub fn end_in_ring<T: Ring>(&self, end: End) -> T {
        let shift = self.clock.terms[..usize::from(self.clock.len)]
            .iter()
            .fold(T::exact(self.end(end)), |sum, &term| sum - T::exact(term));
        shift.scale2(-self.clock.k)
    }
}
