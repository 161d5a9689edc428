//! The ray in a surface's frame: re-centred, rescaled, with bounds on its rounding, and exact on
//! demand.
//!
//! Every kernel starts with one step, [`LocalRay::recentre`]: the parameter moves to the closest
//! approach to the surface's centre and lengths are scaled by a power of two, so that the numbers
//! in a kernel have the magnitude of the surface's size and not of the distance to the eye. The
//! step is not exact, but its error is bounded ([`CentredRay::o_err`]): about two roundings of the
//! *local* size. The ray keeps its origin and maps, so that a doubtful decision can be repeated in
//! any [`Ring`], up to exact arithmetic ([`CentredRay::in_ring`]).

mod centred;
mod point;

pub use self::centred::CentredRay;
pub use self::point::LocalPoint;

use core::cell::OnceCell;
use durer_math::affine::Matrix3;
use durer_math::eft::{exponent, scale2, two_diff, two_sum};
use durer_math::{Aabb, Affine, Dd, EFloat, Isa, Point3, Ray, RaySide, Ring, Vec3};

/// Half an ulp of 1.
const U: f64 = 1.0 / (1u64 << 53) as f64;
/// Covers results below the normal range. It is far larger than needed, so that it and its
/// multiples are normal numbers: on many CPUs a subnormal operand costs a hundred times the
/// operation itself.
const TINY: f64 = durer_math::scale::pow2(-1000);

/// The least step worth taking: `2^-600`.
const LEAST_STEP: f64 = f64::from_bits((1023 - 600) << 52);

/// A ray in a surface's frame: `o + s d`, where the caller's parameter is `t = t0 + 2^k s`.
///
/// The largest |component| of `d` is in `[1, 2)`. `o` and `d` are within `o_err` and `d_err` (per
/// axis) of the exact ones.
#[derive(Clone, Copy, Debug)]
pub struct LocalRay<'a> {
    /// The point at `s = 0`.
    pub o: Point3,
    /// The direction, scaled by a power of two.
    pub d: Vec3,
    /// Per-axis bound on the error of `o`.
    pub o_err: Vec3,
    /// Per-axis bound on the error of `d`.
    pub d_err: Vec3,
    /// The least admitted `t`, in the caller's parameter.
    pub t_min: f64,
    /// The greatest admitted `t`, in the caller's parameter.
    pub t_max: f64,
    /// The side on which the ray starts, if it was spawned on the very primitive under test.
    pub source: Option<RaySide>,
    /// The face it was spawned on, if there is a source.
    pub source_face: u32,
    /// Whether brackets may be as wide as [`PREVIEW_WIDTH`]: enough to see by.
    pub rough: bool,
    /// Whether `o_err` has been widened to find a tip: see [`LocalRay::resolve_through`].
    pub(crate) is_widened: bool,
    /// `1 / d.d`, for the closest approach.
    inverse_d2: f64,
    clock: ParameterMap,
    lineage: Lineage<'a>,
    kept: Option<&'a WideCache>,
}

/// A cache for a ray in double-double, which is computed at first use: see [`LocalRay::keeping`].
#[derive(Debug, Default)]
pub struct WideCache(OnceCell<Option<RingRay<EFloat<Dd>>>>);

impl WideCache {
    /// An empty cache.
    #[inline(always)]
    pub fn new() -> Self {
        Self(OnceCell::new())
    }
}

/// How a local ray came to be.
#[derive(Clone, Copy, Debug)]
enum Lineage<'a> {
    /// `o` was given, and this direction (within `d_err`), which was scaled by `2^k`.
    Given { k: i32, direction: Vec3, d_err: Vec3 },
    /// The parent's ray, moved on by `step`, through the inverse of an affine map; then scaled by
    /// `2^k`.
    Placed { parent: &'a LocalRay<'a>, affine: &'a Affine, step: f64, k: i32 },
}

/// `t = (sum of terms) + 2^k s`, exactly.
#[derive(Clone, Copy, Debug)]
struct ParameterMap {
    terms: [f64; 4],
    len: u8,
    k: i32,
}

impl ParameterMap {
    /// The map of a parameter `s'` with `s = step + 2^k s'`.
    #[inline(always)]
    fn then(mut self, step: f64, k: i32) -> Self {
        let term = scale2(step, self.k);
        if term != 0.0 {
            // Four steps are more than the levels there are (instance, placement, operand,
            // surface).
            self.terms[usize::from(self.len).min(3)] += term;
            self.len = (self.len + 1).min(4);
        }
        self.k += k;
        self
    }

    /// The shift as an unevaluated sum, and a bound on the rest.
    #[inline(always)]
    fn shift(&self) -> (f64, f64, f64) {
        match self.len {
            0 => (0.0, 0.0, 0.0),
            1 => (self.terms[0], 0.0, 0.0),
            _ => {
                let (mut hi, mut lo) = two_sum(self.terms[0], self.terms[1]);
                let mut err = 0.0;
                for &term in &self.terms[2..usize::from(self.len)] {
                    let (h, l) = two_sum(hi, term);
                    let (m, e) = two_sum(lo, l);
                    (hi, lo) = two_sum(h, m);
                    err += e.abs() * (1.0 + 4.0 * U);
                }
                (hi, lo, err)
            }
        }
    }
}

/// The largest width of a bracket for pictures, relative to `max(|t|, size / |d|)`: about a
/// millionth of a pixel. Decisions are exact nevertheless.
pub const PREVIEW_WIDTH: f64 = 1.0 / (1u64 << 30) as f64;

/// An end of a ray's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// `t_min`.
    Min,
    /// `t_max`.
    Max,
}

/// `p - centre` with a bound on its error.
#[inline(always)]
fn relative(p: Point3, err: Vec3, centre: Point3) -> (Vec3, Vec3) {
    #[inline(always)]
    fn axis(p: f64, c: f64, err: f64) -> (f64, f64) {
        let (x, lost) = two_diff(p, c);
        (x, (lost.abs() + err) * (1.0 + 4.0 * U))
    }
    let (x, ex) = axis(p.x, centre.x, err.x);
    let (y, ey) = axis(p.y, centre.y, err.y);
    let (z, ez) = axis(p.z, centre.z, err.z);
    (Vec3::new(x, y, z), Vec3::new(ex, ey, ez))
}

/// Maps a vector, known within `e`, through the inverse of an affine map's linear part. Returns a
/// bound on the result's error, too.
#[inline(always)]
pub(crate) fn through_inverse(affine: &Affine, v: Vec3, e: Vec3) -> (Vec3, Vec3) {
    let (inverse, slack) = (affine.inverse_linear(), affine.inverse_error());
    #[inline(always)]
    fn row(m: Vec3, s: Vec3, v: Vec3, e: Vec3) -> (f64, f64) {
        let x = m.dot(v);
        // gamma_3 for the dot product, |Linv| times the error of v, and |Linv - L^-1| (|v| +
        // error).
        let size = m.abs().dot(v.abs());
        let err = size.mul_add(3.0 * U * (1.0 + 4.0 * U), m.abs().dot(e) + s.dot(v.abs() + e));
        // A row that meets only zeros gives exactly zero.
        (
            x,
            if size == 0.0 && err == 0.0 && x == 0.0 && vanishes(m, s, v, e) {
                0.0
            } else {
                err.mul_add(1.0 + 16.0 * U, TINY)
            },
        )
    }
    #[inline(always)]
    fn rows(m: Matrix3, s: Matrix3, v: Vec3, e: Vec3) -> [(f64, f64); 3] {
        [
            row(m[0].into(), s[0].into(), v, e),
            row(m[1].into(), s[1].into(), v, e),
            row(m[2].into(), s[2].into(), v, e),
        ]
    }
    let [(x, ex), (y, ey), (z, ez)] = rows(inverse, slack, v, e);
    (Vec3::new(x, y, z), Vec3::new(ex, ey, ez))
}

/// Whether each term of `m.v` is exactly zero (and did not just underflow).
#[cold]
fn vanishes(m: Vec3, slack: Vec3, v: Vec3, e: Vec3) -> bool {
    (0..3).all(|i| (m[i] == 0.0 && slack[i] == 0.0) || (v[i] == 0.0 && e[i] == 0.0))
}

/// A ray whose points are `(o + s d) / w` in some ring; `w > 0`.
#[derive(Clone, Debug)]
pub struct RingRay<T> {
    /// The point at `s = 0`, times `w`.
    pub o: [T; 3],
    /// The direction, times `w`.
    pub d: [T; 3],
    /// The common denominator, positive.
    pub w: T,
}

impl LocalRay<'static> {
    /// The ray in the frame in which it is given. It must be valid ([`Ray::is_valid`]).
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        Self::with_errors(ray, Vec3::ZERO, Vec3::ZERO)
    }

    /// A ray whose origin and direction are known only within errors (per axis).
    #[inline(always)]
    pub fn with_errors(ray: &Ray, o_err: Vec3, d_err: Vec3) -> Self {
        let k = -exponent(ray.direction.max_abs());
        let d = ray.direction.map(|x| scale2(x, k));
        let given = d_err;
        let d_err = if d_err == Vec3::ZERO { d_err } else { d_err.map(|x| scale2(x, k)) };
        Self {
            o: ray.origin,
            d,
            o_err,
            // A component far below the largest may lose bits to underflow.
            d_err: Vec3::new(
                loss(ray.direction.x, d.x, d_err.x),
                loss(ray.direction.y, d.y, d_err.y),
                loss(ray.direction.z, d.z, d_err.z),
            ),
            t_min: ray.t_min,
            t_max: ray.t_max,
            source: None,
            source_face: ray.source().map_or(0, |s| s.face),
            rough: false,
            is_widened: false,
            inverse_d2: 1.0 / d.length_squared(),
            clock: ParameterMap { terms: [0.0; 4], len: 0, k },
            lineage: Lineage::Given { k, direction: ray.direction, d_err: given },
            kept: None,
        }
    }
}

/// The error of a component after scaling: subnormal results may have lost bits.
#[inline(always)]
fn loss(before: f64, after: f64, err: f64) -> f64 {
    if after.abs() < f64::MIN_POSITIVE && before != 0.0 { err + TINY } else { err }
}

impl<'a> LocalRay<'a> {
    /// The ray, marked to start on `side` of the surface that is tested next.
    #[inline(always)]
    #[must_use]
    pub fn from_side(mut self, side: Option<RaySide>) -> Self {
        self.source = side;
        self
    }

    /// Whether the parameter is the caller's times a factor, so that `o` is the point at `t = 0`.
    #[inline(always)]
    pub fn starts_at_zero(&self) -> bool {
        self.clock.len == 0
    }

    /// The ray with brackets of the preview width, for pictures: see [`LocalRay::rough`].
    #[inline(always)]
    #[must_use]
    pub fn roughly(mut self) -> Self {
        self.rough = true;
        self
    }

    /// A range of `t` (caller's parameter) that holds all points of the ray in a box; `None` if
    /// there are certainly none.
    ///
    /// Slabs (T. L. Kay, J. T. Kajiya, SIGGRAPH 1986). On an axis on which the direction's relative
    /// error is at most `2^-20`, the relative error of the ends' parameters is below `2^-19`: that,
    /// the origin's error and its rounding are added. Other axes give no bound.
    #[inline(always)]
    pub fn within(&self, bounds: &Aabb) -> Option<(f64, f64)> {
        const SURE: f64 = durer_math::scale::pow2(-20);
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (self.o[axis], self.d[axis]);
            let room = self.o_err[axis] + o.abs() * (4.0 * U);
            let (lo, hi) = (bounds.min[axis] - o, bounds.max[axis] - o);
            let (lo, hi) = (lo - room - lo.abs() * (4.0 * U), hi + room + hi.abs() * (4.0 * U));
            if self.d_err[axis] <= d.abs() * SURE && d != 0.0 {
                let (a, b) = (lo / d, hi / d);
                let (a, b) = (a.min(b), a.max(b));
                near = near.max(a - a.abs() * (2.0 * SURE) - TINY);
                far = far.min(b + b.abs() * (2.0 * SURE) + TINY);
            }
        }
        // NaN is no bound, and compares with nothing.
        if near > far {
            return None;
        }
        let (near, far) = self.unmoved().bracket(near, far);
        let end = |t: f64, none: f64| if t.is_nan() { none } else { t };
        Some((end(near, f64::NEG_INFINITY), end(far, f64::INFINITY)))
    }

    /// Whether the line passes the ball of `radius` about `centre` at a distance that leaves no
    /// doubt: the first and cheapest test.
    ///
    /// With `h = c - o` and `e = t₀ d - h` the distance is at least `|e| - δ`: `h`, `t₀ d` and `e`
    /// round to `3 U |h|` together, moving `t₀` by its error of `8 U |h| / |d|` moves `e` by as
    /// much, and the ray's own errors add theirs. `(r + δ)² <= r² (1 + 2⁻²⁰) + δ² (1 + 2²⁰)` avoids
    /// the root.
    #[inline(always)]
    pub fn passes_by(&self, centre: Point3, radius: f64) -> bool {
        /// `2²⁰`.
        const SPLIT: f64 = (1u64 << 20) as f64;
        let h = centre - self.o;
        let t0 = h.dot(self.d) * self.inverse_d2;
        let e = Vec3::new(t0.mul_add(self.d.x, -h.x), t0.mul_add(self.d.y, -h.y), t0.mul_add(self.d.z, -h.z));
        let own = t0
            .abs()
            .mul_add(self.d_err.x + self.d_err.y + self.d_err.z, self.o_err.x + self.o_err.y + self.o_err.z);
        // δ = 16 U |h| + own, and δ² <= 2 (16 U |h|)² + 2 own², rounded up; the constant pays for
        // underflow.
        let slack = own.mul_add(own * (2.0 * SPLIT + 4.0), 1e-300);
        let slack = h.dot(h).mul_add(512.0 * U * U * (SPLIT + 2.0), slack);
        e.dot(e) > (radius * (1.0 + 2.0 / SPLIT)).mul_add(radius, slack)
    }

    /// The parameter of the closest approach to `c`, rounded: any number will do.
    #[inline(always)]
    fn closest_approach(&self, c: Point3) -> f64 {
        let t = (c - self.o).dot(self.d) * self.inverse_d2;
        // A step so small that scaling might lose bits of it is replaced by zero.
        if t.abs() >= LEAST_STEP && t.abs() < f64::INFINITY { t } else { 0.0 }
    }

    /// `o + step d - c` with a bound on its error.
    #[inline(always)]
    fn moved(&self, c: Point3, step: f64) -> (Vec3, Vec3) {
        #[inline(always)]
        fn axis(step: f64, [o, d, c]: [f64; 3], o_err: f64, d_err: f64) -> (f64, f64) {
            let (h, l) = two_diff(o, c);
            let r = step.mul_add(d, h);
            let x = r + l;
            // One rounding of size |r|, one of size |x|; and the error the ray came with.
            let err = (r.abs() + x.abs()).mul_add(U, step.abs().mul_add(d_err, o_err));
            (x, err.mul_add(1.0 + 8.0 * U, TINY))
        }
        let (x, ex) = axis(step, [self.o.x, self.d.x, c.x], self.o_err.x, self.d_err.x);
        let (y, ey) = axis(step, [self.o.y, self.d.y, c.y], self.o_err.y, self.d_err.y);
        let (z, ez) = axis(step, [self.o.z, self.d.z, c.z], self.o_err.z, self.d_err.z);
        (Vec3::new(x, y, z), Vec3::new(ex, ey, ez))
    }

    /// The point at which the range begins, rounded.
    pub fn point_at_start(&self) -> Point3 {
        self.point_at(self.t_min).0
    }

    /// The point at the caller's parameter `t`, with a bound on its error, computed without
    /// re-centring.
    fn point_at(&self, t: f64) -> (Point3, Vec3) {
        match self.lineage {
            Lineage::Given { k, .. } => {
                let s = scale2(t, -k);
                let (x, e) = self.moved(Point3::ORIGIN, s);
                if s == 0.0 { (self.o, self.o_err) } else { (x.to_point(), e) }
            }
            Lineage::Placed { parent, affine, .. } => {
                let (p, e) = parent.point_at(t);
                let (x, e) = relative(p, e, affine.centre());
                let (x, e) = through_inverse(affine, x, e);
                (x.to_point(), e)
            }
        }
    }

    /// The exact ray in a ring, in this ray's own parameter, relative to `centre`, in units of
    /// `2^scale`: unlike [`CentredRay::in_ring`] the parameter does not depend on the centre, so
    /// that two surfaces can share it.
    pub fn in_ring_from<T: Ring>(&self, centre: Point3, scale: i32) -> Option<RingRay<T>> {
        let at = self.in_ring::<T>()?.moved(centre, 0.0);
        Some(RingRay { o: at.o.map(|x| x.scale2(-scale)), d: at.d.map(|x| x.scale2(-scale)), w: at.w })
    }

    /// The caller's parameters of some of a ray's own that
    /// [starts at zero](LocalRay::starts_at_zero), which is exact; `None` if f64 cannot hold one.
    #[inline(always)]
    pub(crate) fn caller_t(&self, s: [f64; 3]) -> Option<[f64; 3]> {
        let [a, b, c] = s;
        let k = self.clock.k;
        let t = [scale2(a, k), scale2(b, k), scale2(c, k)];
        let holds = |s: f64, t: f64| s == 0.0 || t.is_normal();
        (holds(a, t[0]) && holds(b, t[1]) && holds(c, t[2])).then_some(t)
    }

    /// Bounds of the caller's parameter of one of the ray's own.
    pub fn caller_bounds(&self, s: f64) -> (f64, f64) {
        let (hi, lo, lost) = self.clock.shift();
        let x = scale2(s, self.clock.k);
        let t = hi + (lo + x);
        // Two roundings, of numbers no larger than this sum up to rounding, and the loss by
        // scaling.
        let err = (hi.abs() + lo.abs() + x.abs()).mul_add(4.0 * U, lost * 2.0) + TINY;
        (t - err, t + err)
    }

    /// `(step, k)` with `parent's parameter = step + 2^k s`; `None` for a ray that was given.
    pub fn parent_clock(&self) -> Option<(f64, i32)> {
        match self.lineage {
            Lineage::Given { .. } => None,
            Lineage::Placed { step, k, .. } => Some((step, k)),
        }
    }

    /// The ray relative to `centre`, with lengths in units of `2^scale`, for kernels (rules W3 and
    /// W4).
    ///
    /// `scale` should make the surface's size about one.
    #[inline(always)]
    pub fn recentre(&'a self, centre: Point3, scale: i32) -> CentredRay<'a> {
        let step = self.closest_approach(centre);
        let (o, o_err) = self.moved(centre, step);
        CentredRay {
            o: o.map(|x| scale2(x, -scale)),
            d: self.d,
            o_err: o_err.map(|x| scale2(x, -scale) + TINY),
            d_err: self.d_err,
            centre,
            scale,
            step,
            clock: self.clock.then(step, scale),
            ray: self,
        }
    }

    /// The ray relative to its own point at `s = 0`, in its own units: for surfaces without a
    /// centre.
    #[inline(always)]
    pub fn unmoved(&'a self) -> CentredRay<'a> {
        CentredRay {
            o: Vec3::ZERO,
            d: self.d,
            o_err: self.o_err,
            d_err: self.d_err,
            centre: self.o,
            scale: 0,
            step: 0.0,
            clock: self.clock,
            ray: self,
        }
    }

    /// The ray in the frame of a surface that `affine` places: re-centred on the map's centre, then
    /// mapped by the inverse (rules W3 and W5), with the inverse's own error added.
    #[inline(always)]
    pub fn through(&'a self, affine: &'a Affine) -> LocalRay<'a> {
        let c = affine.centre();
        let step = self.closest_approach(c);
        let (o, o_err) = self.moved(c, step);
        let (o, o_err) = through_inverse(affine, o, o_err);
        let (d, d_err) = through_inverse(affine, self.d, self.d_err);
        let k = -exponent(d.max_abs());
        let d = d.map(|x| scale2(x, k));
        LocalRay {
            o: o.to_point(),
            d,
            o_err,
            d_err: d_err.map(|x| scale2(x, k) + TINY),
            t_min: self.t_min,
            t_max: self.t_max,
            source: self.source,
            source_face: self.source_face,
            rough: self.rough,
            is_widened: self.is_widened,
            inverse_d2: 1.0 / d.length_squared(),
            clock: self.clock.then(step, k),
            lineage: Lineage::Placed { parent: self, affine, step, k },
            kept: None,
        }
    }

    /// The ray with a cache for its double-double form, which many surfaces may need.
    #[inline(always)]
    #[must_use]
    pub fn keeping(self, kept: &'a WideCache) -> Self {
        Self { kept: Some(kept), ..self }
    }

    /// The exact ray in double-double, as [`LocalRay::in_ring`] has it.
    #[inline(always)]
    pub(crate) fn in_double(&self) -> Option<RingRay<EFloat<Dd>>> {
        match self.kept {
            Some(kept) => kept.0.get_or_init(|| self.in_ring()).clone(),
            None => self.in_ring(),
        }
    }

    /// The exact ray in a ring, in this ray's parameter; `None` if `T` holds exact numbers only and
    /// the ray is not exactly known.
    #[inline(never)]
    pub fn in_ring<T: Ring>(&self) -> Option<RingRay<T>> {
        Isa::detect().run(
            #[inline(always)]
            || self.in_ring_here(),
        )
    }

    #[inline(always)]
    fn in_ring_here<T: Ring>(&self) -> Option<RingRay<T>> {
        match self.lineage {
            Lineage::Given { k, direction, d_err } => {
                let o = [
                    T::within(self.o.x, self.o_err.x)?,
                    T::within(self.o.y, self.o_err.y)?,
                    T::within(self.o.z, self.o_err.z)?,
                ];
                // Scaled in the ring: no bits of tiny components are lost.
                let d = [
                    T::within(direction.x, d_err.x)?.scale2(k),
                    T::within(direction.y, d_err.y)?.scale2(k),
                    T::within(direction.z, d_err.z)?.scale2(k),
                ];
                Some(RingRay { o, d, w: T::exact(1.0) })
            }
            Lineage::Placed { parent, affine, step, k } => {
                let at = parent.in_ring::<T>()?.moved(affine.centre(), step);
                let (adjugate, determinant) = affine.adjugate::<T>();
                let [x, y, z] = times(&adjugate, &at.d);
                let d = [x.scale2(k), y.scale2(k), z.scale2(k)];
                Some(RingRay { o: times(&adjugate, &at.o), d, w: at.w * determinant })
            }
        }
    }
}

/// `m v`.
#[inline(always)]
fn times<T: Ring>(m: &[[T; 3]; 3], v: &[T; 3]) -> [T; 3] {
    #[inline(always)]
    fn dot<T: Ring>(a: &[T; 3], b: &[T; 3]) -> T {
        a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
    }
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

impl<T: Ring> RingRay<T> {
    /// The ray relative to `c`, with its parameter moved on by `step`.
    #[inline(always)]
    fn moved(self, c: Point3, step: f64) -> Self {
        let step = T::exact(step);
        #[inline(always)]
        fn axis<T: Ring>(o: &T, d: &T, w: &T, c: f64, step: &T) -> T {
            o.clone() - T::exact(c) * w.clone() + step.clone() * d.clone()
        }
        let o = [
            axis(&self.o[0], &self.d[0], &self.w, c.x, &step),
            axis(&self.o[1], &self.d[1], &self.w, c.y, &step),
            axis(&self.o[2], &self.d[2], &self.w, c.z, &step),
        ];
        Self { o, ..self }
    }
}
