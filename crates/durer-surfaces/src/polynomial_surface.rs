//! Surfaces that are the zero set of one polynomial: the trait for their authors, and the methods
//! that follow from it.
//!
//! Along a ray the polynomial has one unknown (`roots`). The inside is where it is negative.

use crate::faces::chart::{Chart, Frame, sheared, sphere_chart, tangents};
use crate::point::least_step;
use crate::ray::PREVIEW_WIDTH;
use crate::{CentredRay, End, LocalPoint, LocalRay, Need, RingRay, Root, RootKind, Side, Sink, SurfacePoint};
use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2, two_sum};
use durer_math::{Dd, Dyadic, EFloat, Isa, Point3, RaySide, Ring, U, Vec3};
use durer_roots::exact::ExactRoots;
use durer_roots::polynomial::{Along, Found, Stretch, solve, stays};
use durer_roots::quadratic::{Limits, NARROW, Quadratic};

/// Covers results below the normal range, in units of the surface's size.
const TINY: f64 = durer_math::scale::pow2(-500);

/// A surface `f = 0` in its frame, `f` a polynomial of degree less than `N`.
pub trait PolynomialSurface<const N: usize>: Send + Sync {
    /// Centre, unit of length and reach.
    fn frame(&self) -> Frame;

    /// `f` along a ray in the frame, times any positive factor: the coefficients of the powers of
    /// the ray's parameter, the constant first.
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; N];

    /// [`PolynomialSurface::along`] in f64, for a ray whose origin and direction are known within
    /// `eo` and `ed`. An implementation that counts its roundings by hand is faster than this
    /// default.
    #[inline(always)]
    fn along_in_f64(&self, o: Vec3, d: Vec3, eo: Vec3, ed: Vec3) -> [EFloat; N] {
        self.along(&RingRay { o: within(o, eo), d: within(d, ed), w: EFloat::exact(1.0) })
    }

    /// `f` at the point `p / w`, times any positive factor that depends only on `w` and is 1 for
    /// `w = 1`.
    #[inline(always)]
    fn at<T: Ring>(&self, p: &[T; 3], w: &T) -> T {
        let zero = || T::exact(0.0);
        let [value, ..] =
            &self.along(&RingRay { o: p.clone(), d: [zero(), zero(), zero()], w: w.clone() })[..]
        else {
            return zero();
        };
        value.clone()
    }

    /// The middle and the half length of the part of the ray, in its parameter, that holds the
    /// whole surface strictly inside. `None` if the ray misses, an infinite length if there is no
    /// such part.
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)>;

    /// The gradient at `y`, up to rounding, and a bound on the Hessian's norm within a 64th of a
    /// unit of it.
    fn slopes(&self, y: Vec3) -> (Vec3, f64);

    /// The derivative of the gradient along `v`, up to rounding.
    fn turn(&self, y: Vec3, v: Vec3) -> Vec3;

    /// Surface coordinates at `y` (close to the surface), where the unit normal is `n`.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart;

    /// A direction in which `f` is not flat, for points where the gradient vanishes or is beyond
    /// the range of f64.
    fn tip(&self, y: Vec3) -> Vec3;
}

/// One ray and one surface.
struct RayPolynomial<'a, Z> {
    shape: &'a Z,
    ray: &'a CentredRay<'a>,
    mid: f64,
}

#[inline(always)]
fn moved<T: Ring>(ray: RingRay<T>, mid: f64) -> RingRay<T> {
    if mid == 0.0 {
        return ray;
    }
    let [o, d] = [ray.o, ray.d];
    #[inline(always)]
    fn step<T: Ring>(o: &T, d: &T, mid: f64) -> T {
        o.clone() + T::exact(mid) * d.clone()
    }
    RingRay { o: [step(&o[0], &d[0], mid), step(&o[1], &d[1], mid), step(&o[2], &d[2], mid)], d, w: ray.w }
}

/// The exact ray and `true`; if it is not exactly known, the ray with the rounded numbers, and
/// `false`.
fn exact_ray(ray: &CentredRay<'_>) -> (RingRay<Dyadic>, bool) {
    match ray.in_ring::<Dyadic>() {
        Some(exact) => (exact, true),
        None => {
            let exact = |v: Vec3| v.to_array().map(Dyadic::from);
            (RingRay { o: exact(ray.o), d: exact(ray.d), w: Dyadic::from(1.0) }, false)
        }
    }
}

#[inline(always)]
fn within(v: Vec3, e: Vec3) -> [EFloat; 3] {
    [EFloat::with_error(v.x, e.x), EFloat::with_error(v.y, e.y), EFloat::with_error(v.z, e.z)]
}

impl<const N: usize, Z: PolynomialSurface<N>> Along<N> for RayPolynomial<'_, Z> {
    #[inline(always)]
    fn double(&self) -> [EFloat; N] {
        let (ray, mid) = (self.ray, self.mid);
        let (mut o, mut e) = (ray.o, ray.o_err);
        if mid != 0.0 {
            o = Vec3::new(mid.mul_add(ray.d.x, o.x), mid.mul_add(ray.d.y, o.y), mid.mul_add(ray.d.z, o.z));
            e = (e + ray.d_err * mid.abs() + o.abs() * U) * (1.0 + 8.0 * U);
        }
        self.shape.along_in_f64(o, ray.d, e, ray.d_err)
    }

    #[inline(always)]
    fn wide(&self) -> Option<[EFloat<Dd>; N]> {
        let ray = moved(self.ray.in_double()?, self.mid);
        // The result may have any common factor: one that makes w about one keeps its high powers
        // in range.
        let k = -exponent(ray.w.value());
        let sized = |x: EFloat<Dd>| x.scale2(k);
        Some(self.shape.along(&RingRay { o: ray.o.map(sized), d: ray.d.map(sized), w: sized(ray.w) }))
    }

    fn exact(&self) -> (Vec<Dyadic>, bool) {
        let (ray, certain) = exact_ray(self.ray);
        (self.shape.along(&moved(ray, self.mid)).to_vec(), certain)
    }
}

/// All crossings in the ray's range, ascending.
pub fn roots<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
    Isa::detect().run(
        #[inline(always)]
        || roots_here(shape, ray, sink),
    );
}

#[inline(always)]
fn roots_here<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
    let frame = shape.frame();
    let at = ray.recentre(frame.centre, frame.scale);
    let (near, far) = sink.range();
    let (lo, hi) = at.window((ray.t_min.max(near), ray.t_max.min(far)));
    if lo > hi {
        return;
    }
    let Some((mid, half)) = shape.stretch(&at).map(|stretch| shorter(stretch, (lo, hi))) else { return };
    if half < f64::INFINITY && leaves(shape, &at, mid + half) {
        return;
    }
    let stretch = if half < f64::INFINITY {
        Stretch::Within { mid, half: eight_bits(half) }
    } else {
        Stretch::Everywhere
    };
    let limits = Limits { lo, hi, origin: at.shift(), width: if ray.rough { PREVIEW_WIDTH } else { NARROW } };
    let mut showing = Showing { shape, ray, at: &at, mid, least: f64::NEG_INFINITY, sink };
    solve(&RayPolynomial { shape, ray: &at, mid }, stretch, &limits, |found: &Found<'_>| showing.show(found));
}

/// Passes roots to a sink, ascending.
struct Showing<'a, Z> {
    shape: &'a Z,
    ray: &'a LocalRay<'a>,
    at: &'a CentredRay<'a>,
    mid: f64,
    /// The last root.
    least: f64,
    sink: &'a mut dyn Sink,
}

impl<Z> Showing<'_, Z> {
    #[inline(never)]
    fn show<const N: usize>(&mut self, found: &Found<'_>) -> ControlFlow<()>
    where
        Z: PolynomialSurface<N>,
    {
        Isa::detect().run(
            #[inline(always)]
            || self.show_here(found),
        )
    }

    #[inline(always)]
    fn show_here<const N: usize>(&mut self, found: &Found<'_>) -> ControlFlow<()>
    where
        Z: PolynomialSurface<N>,
    {
        let &mut Self { shape, ray, at, mid, .. } = self;
        let (lo, hi) = at.bracket(outward(found.lo, -1.0), outward(found.hi, 1.0));
        let (near, far) = self.sink.range();
        if lo > far.min(ray.t_max) {
            return ControlFlow::Break(());
        }
        if hi < near.max(ray.t_min) {
            return ControlFlow::Continue(());
        }
        if at.admits(lo, hi) != Some(true) && !in_range(shape, found, at, mid) {
            return ControlFlow::Continue(());
        }
        let t = at.t(found.s).max(lo).min(hi).max(ray.t_min).min(ray.t_max).max(self.least);
        self.least = t;
        let (sign, kind) = match (found.before, found.after) {
            (Greater, Less) => (-1, RootKind::Simple),
            (Less, Greater) => (1, RootKind::Simple),
            _ => (0, RootKind::Grazing),
        };
        let kind = if found.certain { kind } else { RootKind::Cluster };
        self.sink.push(Root { t, lo, hi: hi.max(t), s: found.s, tag: [0.0; 2], face: 0, sign, kind })
    }
}

/// Shortens an infinite interval to a little more than the window in which roots matter. An
/// interval so long that its powers might leave the range of f64 stays infinite.
#[inline(always)]
fn shorter((mid, half): (f64, f64), (lo, hi): (f64, f64)) -> (f64, f64) {
    const LONGEST: f64 = durer_math::scale::pow2(16);
    let (middle, reach) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    // The least length makes an interval even of a window that is a point.
    let reach = reach * 1.125 + lo.abs().max(hi.abs()).max(1.0) * durer_math::scale::pow2(-10);
    if half == f64::INFINITY && middle.abs() < LONGEST && reach < LONGEST {
        (middle, reach)
    } else {
        (mid, half)
    }
}

/// The part of a ray within the ball of radius `reach` about the frame's centre and the slab
/// `low <= o + s d <= high` of one coordinate along it. Both must exceed their contents by at least
/// `margin`, which covers every rounding; the result is no shorter than its square.
#[inline(always)]
pub fn ball_and_slab(
    ray: &CentredRay<'_>,
    reach: f64,
    (o, d): (f64, f64),
    (low, high): (f64, f64),
    margin: f64,
) -> Option<(f64, f64)> {
    let err = (ray.o_err + ray.d_err).max_abs();
    if err >= margin / 64.0 || err.is_nan() {
        return Some((0.0, f64::INFINITY));
    }
    let inverse = ray.inverse_d2();
    let middle = -ray.o.dot(ray.d) * inverse;
    let square = reach.mul_add(reach, -ray.o.dot(ray.o)) * inverse + middle * middle;
    if square <= 0.0 {
        return None;
    }
    let half = square.sqrt();
    // Along the slab, 0 / 0 is no bound; min and max ignore it.
    let (x, y) = ((low - o) / d, (high - o) / d);
    let (lo, hi) = (x.min(y).max(middle - half), x.max(y).min(middle + half));
    if lo > hi || (d == 0.0 && !(low..=high).contains(&o)) {
        return None;
    }
    Some((0.5 * (lo + hi), (0.5 * (hi - lo)).max(margin * margin)))
}

/// The end of a bracket, moved outward where it is so near zero that scaling it might lose bits.
#[inline(always)]
fn outward(s: f64, away: f64) -> f64 {
    if s.abs() >= TINY {
        s
    } else if s * away > 0.0 {
        TINY * away
    } else {
        0.0
    }
}

/// Whether a ray that was spawned on this surface certainly does not meet it again before `end`.
/// The polynomial is taken relative to the start, where the side is known.
#[inline(always)]
fn leaves<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, ray: &CentredRay<'_>, end: f64) -> bool {
    let Some((side, _, start)) = ray.spawned() else { return false };
    let half = 0.5 * (end - start.v) * (1.0 + 4.0 * U);
    if half <= 0.0 {
        return true;
    }
    let (p, e) = ray.point_at_end(End::Min);
    let d = ray.d;
    let o = Vec3::new(half.mul_add(d.x, p.x), half.mul_add(d.y, p.y), half.mul_add(d.z, p.z));
    let e = (e + ray.d_err * half + o.abs() * U) * (1.0 + 8.0 * U);
    stays(&shape.along_in_f64(o, d, e, ray.d_err), half, side == RaySide::Front)
}

/// The least number with 8 significant bits that is at least `x`.
#[inline(always)]
fn eight_bits(x: f64) -> f64 {
    let mask = (1_u64 << 45) - 1;
    f64::from_bits((x.to_bits() + mask) & !mask)
}

/// Whether a crossing whose bracket straddles an end of the range is in the range.
#[cold]
#[inline(never)]
fn in_range<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    found: &Found<'_>,
    ray: &CentredRay<'_>,
    mid: f64,
) -> bool {
    let (lo, hi) = ray.bracket(found.lo, found.hi);
    let inside = |end: End, outer: bool| {
        let at = ray.end(end);
        !at.is_finite()
            || outer
            || end_against_root_in_door(shape, end, found, ray, mid) != {
                if end == End::Min { Greater } else { Less }
            }
    };
    inside(End::Min, lo >= ray.end(End::Min)) && inside(End::Max, hi <= ray.end(End::Max))
}

#[inline(never)]
fn end_against_root_in_door<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    end: End,
    found: &Found<'_>,
    ray: &CentredRay<'_>,
    mid: f64,
) -> Ordering {
    Isa::detect().run(
        #[inline(always)]
        || end_against_root(shape, end, found, ray, mid),
    )
}

/// The order of an end of the range and a crossing.
#[inline(always)]
fn end_against_root<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    end: End,
    found: &Found<'_>,
    ray: &CentredRay<'_>,
    mid: f64,
) -> Ordering {
    let t = ray.end(end);
    let (lo, hi) = ray.window((t, t));
    if hi < found.lo {
        return Less;
    }
    if lo > found.hi {
        return Greater;
    }
    // The polynomial at the end's own point, which does not have the rounding of the closest
    // approach. Rays that were spawned on this surface start where its sign is certain.
    if lo >= found.alone.0 && hi <= found.alone.1 {
        let (p, e) = ray.point_at_end(end);
        let value =
            shape.at(&within(p, e), &EFloat::exact(1.0)).sign().or_else(|| match (ray.source(), end) {
                (Some(side), End::Min) if t == 0.0 => {
                    Some(if side == RaySide::Front { Greater } else { Less })
                }
                _ => None,
            });
        match value {
            Some(sign) if sign == found.before => return Less,
            Some(sign) if sign == found.after => return Greater,
            _ => {}
        }
    }
    exact_end_against_root(shape, end, found, ray, mid)
}

#[cold]
#[inline(never)]
fn exact_end_against_root<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    end: End,
    found: &Found<'_>,
    ray: &CentredRay<'_>,
    mid: f64,
) -> Ordering {
    let y = |s: Dyadic| &s - &Dyadic::from(mid);
    let x = y(ray.end_in_ring::<Dyadic>(end));
    if let Some((exact, root)) = found.exact {
        return exact.compare(&x, root);
    }
    let Some(exact) = ExactRoots::new(RayPolynomial { shape, ray, mid }.exact().0) else { return Equal };
    // Before they were rounded outward, the bracket's ends were certainly no roots.
    let from = exact.beside_exact(y(found.lo.into()), -1.0);
    let to = exact.beside_exact(y(found.hi.into()), 1.0);
    exact.isolate(&from, &to).first().map_or(Equal, |root| exact.compare(&x, root))
}

/// The side of the surface on which a point lies.
pub fn side<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, point: &LocalPoint<'_>) -> Side {
    let Frame { centre, scale, .. } = shape.frame();
    let (p, e) = point.relative_to(centre, scale);
    let sign = Isa::detect().run(
        #[inline(always)]
        || shape.at(&within(p, e), &EFloat::exact(1.0)).sign(),
    );
    let sign = sign.or_else(|| {
        let (q, w) = point.in_ring::<Dyadic>()?;
        let c = centre.to_array().map(Dyadic::from);
        let relative = [0, 1, 2].map(|k| (&q[k] - &(&c[k] * &w)).scale2(-scale));
        shape.at(&relative, &w).sign()
    });
    match sign {
        Some(Greater) => Side::Out,
        Some(Less) => Side::In,
        _ => Side::On,
    }
}

/// The point of a root: projected onto the surface by Newton's method, with its bounds.
pub fn resolve<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    ray: &LocalRay<'_>,
    root: &Root,
    need: Need,
) -> SurfacePoint {
    Isa::detect().run(
        #[inline(always)]
        || resolve_here(shape, ray, root, need),
    )
}

#[inline(always)]
fn value<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, y: Vec3, e: Vec3) -> EFloat {
    shape.at(&within(y, e), &EFloat::exact(1.0))
}

#[inline(always)]
fn resolve_here<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    ray: &LocalRay<'_>,
    root: &Root,
    need: Need,
) -> SurfacePoint {
    let Frame { centre, scale, .. } = shape.frame();
    let at = ray.recentre(centre, scale);
    let s = root.s;
    let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
    let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;
    let (y1, f, g, bend) = project(shape, y);
    // Far out the square of the gradient may leave the range of f64. A multiple of f has the same
    // zeros.
    let far = Some(exponent(g.max_abs())).filter(|k| *k > 500 && g.is_finite()).unwrap_or(0);
    let part = |x: f64| scale2(x, -far);
    let (f, g, bend) = (EFloat { v: part(f.v), e: part(f.e) + TINY }, g.map(part), part(bend));

    // The world's coordinates; their rounding is known exactly.
    let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
    let ((px, lx), (py, ly), (pz, lz)) = (axis(centre.x, y1.x), axis(centre.y, y1.y), axis(centre.z, y1.z));
    let p = Point3::new(px, py, pz);
    let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);
    let width = at.width(root);
    let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);

    // A start at p ± off n + τ, τ what rounding adds away from the surface, has |f| >= off |G| - h
    // (off² + |τ|²) - η; see `off` of quadrics. The gradient is made a little shorter to cover its
    // own rounding.
    let tau = scale2(p.to_vec().max_abs(), -scale) * (6.0 * U) + TINY;
    let length = g.length();
    let sure = length * (1.0 - 1.0 / (1u64 << 20) as f64);
    let away = 2.0 * (g.abs().dot(lost) + bend * (lost.dot(lost) + tau * tau));
    let eta = f.v.abs() + 2.0 * f.e + away;
    let square = sure * sure - 4.0 * bend * eta;
    let back = |x: f64| scale2(x, scale);
    // A ray that is widened to find a tip is known within `err`; the point is about `|G| / h` from a
    // tip, if there is one. Three times `err` leaves room for a placement.
    let err = if at.local().is_widened { e_y.x + e_y.y + e_y.z } else { 0.0 };
    let sheet = length.is_finite()
        && square > 0.0
        && bend * (2.0 * eta) < sure * sure / 64.0
        && length > 16.0 * bend * err;
    let (leave, tip) = if sheet {
        let off = 2.0 * eta / (sure + square.sqrt()) * (1.0 + 64.0 * U);
        (Leave { normal: g * (1.0 / length), off, aside: Vec3::ZERO }, false)
    } else {
        let n = if length > 0.0 && length.is_finite() {
            // Near a tip its squares may be below the normal numbers.
            let g = g.map(|x| scale2(x, -exponent(g.max_abs())));
            g * (1.0 / g.length())
        } else {
            shape.tip(y1)
        };
        let e = tau + 3.0 * err;
        (leave(shape, y1, n, lost + Vec3::new(e, e, e)), true)
    };
    let Leave { normal, off, aside } = leave;
    let least = if tip { least_step(p) } else { f64::MIN_POSITIVE };
    let mut point =
        SurfacePoint::new(p, dp.map(|x| back(x) + f64::MIN_POSITIVE), back(off) + least, normal.to_normal());
    (point.bend, point.slack) = match tip {
        true => (f64::INFINITY, back(off / 64.0)),
        false => (scale2(bend / length * (1.0 + 1.0 / 1024.0), -scale), 0.0),
    };
    point.aside = aside.map(back);
    if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
        let chart = shape.chart(y1, normal);
        point.uv = chart.uv;
        if need.contains(Need::DERIVATIVES) {
            // The normal is G / |G|, so it changes with v by (H v - n (n·H v)) / |G|.
            let length = length.max(TINY);
            let turn = |v: Vec3| {
                let hv = shape.turn(y1, v).map(part);
                let dn = (hv - normal * normal.dot(hv)) * (1.0 / length);
                if dn.is_finite() { dn } else { Vec3::ZERO }
            };
            (point.dpdu, point.dpdv) = (chart.dpdu.map(back), chart.dpdv.map(back));
            (point.dndu, point.dndv) = (turn(chart.dpdu), turn(chart.dpdv));
        }
    }
    point
}

/// Moves `y` onto the surface by Newton's method along the gradient. Returns the point with `f`,
/// the gradient and the bound of the Hessian there.
#[inline(always)]
fn project<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, mut y: Vec3) -> (Vec3, EFloat, Vec3, f64) {
    let mut f = value(shape, y, Vec3::ZERO);
    let (mut g, mut bend) = shape.slopes(y);
    for _ in 0..64 {
        // On the surface within the error of f64: a step would follow rounding.
        if f.v.abs() <= 2.0 * f.e {
            break;
        }
        let step = g * (f.v / g.dot(g));
        let next = y - step;
        // Where the gradient almost vanishes a step may overshoot; then it is not taken.
        if !(next.is_finite() && step.max_abs() < 1.0) {
            break;
        }
        let f1 = value(shape, next, Vec3::ZERO);
        if f1.v.abs().partial_cmp(&f.v.abs()) != Some(Less) {
            break;
        }
        (y, f) = (next, f1);
        (g, bend) = shape.slopes(y);
    }
    (y, f, g, bend)
}

/// How rays leave a point: from `aside + off normal` and from `aside - off normal`, counted from it.
struct Leave {
    normal: Vec3,
    off: f64,
    aside: Vec3,
}

/// Starts on both sides of a point `y` without a tangent plane, at the same distance, where the sign
/// of `f` is certain, also for all points within `e` and a 32nd of the distance.
///
/// They lie along `n`, unless `f` has the same sign in both directions (two bodies meet there, or two
/// gaps) or no certain sign however far. Then they lie along any two of `n`, `-n` and the directions
/// of a cube. If all that have a sign have the same (the zeros of a square), no side is known.
#[cold]
#[inline(never)]
fn leave<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, y: Vec3, n: Vec3, e: Vec3) -> Leave {
    let sign = |v: Vec3, way: f64| {
        let slack = way * (1.0 / 32.0);
        value(shape, y + v * way, e + Vec3::new(slack, slack, slack)).sign().filter(|sign| sign.is_ne())
    };
    let first = 64.0 * (e.max_abs() + U * y.max_abs());
    let ways = || (0..120).map(|round| scale2(first, round));
    let mut along_n = None;
    for way in ways() {
        if let (Some(plus), Some(minus)) = (sign(n, way), sign(-n, way)) {
            if plus != minus {
                let normal = if plus == Greater { n } else { -n };
                return Leave { normal, off: way, aside: Vec3::ZERO };
            }
            along_n = Some(way);
            break;
        }
    }
    // The surface's size is about one: farther away nothing belongs to the point, if it is known.
    for way in ways().take_while(|&way| along_n.is_none() || way <= 1.0) {
        let candidates = || [n, -n].into_iter().chain(directions().flat_map(|v| [v, -v]));
        let with = |wanted| candidates().find(|&v| sign(v, way) == Some(wanted));
        let (Some(outside), Some(inside)) = (with(Greater), with(Less)) else {
            continue;
        };
        let apart = outside - inside;
        let length = apart.length();
        return Leave {
            normal: apart * (1.0 / length),
            off: 0.5 * way * length * (1.0 + 8.0 * U),
            aside: (inside + outside) * (0.5 * way),
        };
    }
    Leave { normal: n, off: along_n.unwrap_or_else(|| scale2(first, 120)), aside: Vec3::ZERO }
}

/// The thirteen directions of a cube: to its faces, edges and vertices, without their opposites.
fn directions() -> impl Iterator<Item = Vec3> {
    (14..27).map(|code| {
        let axis = |p: u32| f64::from(code / p % 3) - 1.0;
        let v = Vec3::new(axis(9), axis(3), axis(1));
        v * (1.0 / v.length())
    })
}

/// The exact sign of a quadratic in the ray's own parameter at a root of the surface, for clipping;
/// `None` if the ray is not exactly known.
pub fn sign_at_root<const N: usize, Z: PolynomialSurface<N>>(
    shape: &Z,
    ray: &LocalRay<'_>,
    root: &Root,
    q: &Quadratic<Dyadic>,
) -> Option<Ordering> {
    let Frame { centre, scale, .. } = shape.frame();
    let exact = ExactRoots::new(shape.along(&ray.in_ring_from::<Dyadic>(centre, scale)?).to_vec())?;
    let at = ray.unmoved();
    let (lo, hi) = at.window((root.lo, root.hi));
    let (from, to) = (exact.beside(lo.max(f64::MIN), -1.0), exact.beside(hi.min(f64::MAX), 1.0));
    let roots = exact.isolate(&from, &to);
    // If `t` does not separate several roots, the one with the sign of the given root.
    let goes = |before: Ordering, after: Ordering| match (before, after) {
        (Greater, Less) => -1,
        (Less, Greater) => 1,
        _ => 0,
    };
    let found = roots.iter().find(|r| goes(r.before, r.after) == root.sign).or(roots.first())?;
    Some(exact.sign_at_root(&[q.c.clone(), q.b.clone().scale2(1), q.a.clone()], found))
}

/// Surface coordinates for a surface without any of its own: longitude and latitude as seen from
/// the frame's centre.
pub fn longitude_and_latitude(y: Vec3, n: Vec3) -> Chart {
    if y == Vec3::ZERO {
        let (dpdu, dpdv) = tangents(n);
        return Chart { uv: [0.0; 2], dpdu, dpdv };
    }
    let Chart { uv, dpdu, dpdv } = sphere_chart(y);
    Chart { uv, dpdu: sheared(dpdu, y, n), dpdv: sheared(dpdv, y, n) }
}

/// Of the thirteen directions of a cube, the one along which the polynomial leaves zero most.
#[inline(always)]
pub fn steepest<const N: usize, Z: PolynomialSurface<N>>(shape: &Z, y: Vec3) -> Vec3 {
    let mut best = (Vec3::Z, -1.0);
    for v in directions() {
        let value =
            |y: Vec3| shape.at(&y.to_array().map(EFloat::<f64>::exact), &EFloat::exact(1.0)).value().abs();
        let least = value(y + v * (1.0 / 1024.0)).min(value(y - v * (1.0 / 1024.0)));
        if least > best.1 {
            best = (v, least);
        }
    }
    best.0
}
