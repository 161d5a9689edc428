//! Crossings of eight rays with an algebraic surface.
//!
//! About a place `t_c` of a ray the line is `y_c + x v`, `v = T d`. It is searched in three pieces,
//!
//! ```text
//!   far before   t = t_c - T / x           0 < x <= 1      x^n f(y_c - v / x)
//!   about        t = t_c + T (2 x - 1)     0 <= x <= 1     f(y_c + (2 x - 1) v)
//!   far behind   t = t_c + T / (1 - x)     0 <= x < 1      (1 - x)^n f(y_c + v / (1 - x))
//! ```
//!
//! whose coefficients all follow from the coefficients `c_k` of `f(y_c + s v)`. The sums of their
//! magnitudes are at most `Σ |c_k|`, `Σ |c_k| 3^k` (in powers of `2 x - 1`, then of `x`) and
//! `Σ |c_k| 2^(n-k)` (in powers of `1 - x`, then of `x`). `F` bounds these sums, and `F₁` bounds
//! the errors. So the coefficients are wrong by no more than
//!
//! ```text
//!   e = r (F₁(M) e_y + 16 N U F(M)),   M = |y_c| + s |v| + e_y
//!
//!   s = 1, r = 1;   s = 3, r = 1;   s = 1/2, r = 2^n
//! ```
//!
//! because the roundings of `f` along a ray (`mod.rs`), of the change of variable, and of
//! everything in `polynomial_roots.rs` are fewer than `12 N`. If the part of the ray that matters
//! is short, the piece about its middle contains it. Otherwise `t_c` is the closest approach to the
//! origin, or the start if that lies behind, and `|v| = 4 + 2 |y_c|`, where sizes are largest
//! coordinates, or half of that for high orders: farther out the leading terms usually decide. (`n`
//! is the order of `f`, not `N - 1`: a leading coefficient of zero would leave the sign at infinity
//! open.)
//!
//! **Refinement.** This proves which roots exist, but locates each only within that error. One step
//! of Newton's method with `f` at the point itself, whose error depends on `|y|` alone, and two
//! certain signs on either side narrow the bracket further, if they lie inside it.
//!
//! **The start of a ray** in a piece, or its end, is rounded outward by `8 U (|t_c| + T)`, and far
//! before by as little: in all by no more than `128 U (1 + |y|)` at the start `y`. Within that
//! distance a start that was moved off the surface (`Terms::skin`) keeps its known sign.

use super::{Sizes, Terms};
use crate::packet::convex::Hull;
use crate::packet::kernel::{FacePoints, KernelRays, SinkKernel};
use crate::packet::local_frame::{Own, dot, largest, on};
use crate::packet::polynomial_roots::{Part8, Poly8, Root8};
use crate::packet::quadric::Start;
use crate::packet::rays::{RayLanes, SLACK};
use crate::packet::sink::Sink8;
use crate::packet::skin::Skin;
use durer_math::scale::pow2;
use durer_math::{F8, M8, U, Vec3};

/// Covers what products may lose to underflow: fewer than `2^17` of `2^-1075`, each times `N - 1`
/// powers of numbers below `2 far`.
const TINY: f64 = pow2(-240);

/// Points with larger coordinates are doubts.
const fn far<const N: usize>() -> f64 {
    if N <= 9 { pow2(100) } else { pow2(50) }
}

/// The three pieces of a ray.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LineThird {
    Before,
    About,
    Behind,
}

/// Working memory for eight rays and one surface.
#[derive(Debug)]
pub(crate) struct PolynomialScratch<const N: usize> {
    /// The rays in the surface's own coordinates.
    o: Vec3<F8>,
    d: Vec3<F8>,
    e_o: F8,
    e_d: F8,
    /// Coefficients of the powers of `s`, and bounds on the errors of the pieces.
    c: [F8; N],
    e: [F8; 3],
    t_c: F8,
    reach: F8,
    /// The part of the ray that is searched, and the parameters between which crossings are
    /// certainly inside what clips the surface.
    from: F8,
    to: F8,
    after: F8,
    before: F8,
    /// Lanes that are not finished.
    open: M8,
    /// The sign at the start of the next piece: 1, -1, or 0 if it is unknown.
    sign: F8,
    poly: Poly8<N>,
    part: Part8,
    root: Root8,
    /// The root's parameter on the ray.
    t: F8,
    e_t: F8,
}

impl<const N: usize> Default for PolynomialScratch<N> {
    fn default() -> Self {
        let z = F8::ZERO;
        Self {
            o: Vec3::splat(Vec3::ZERO),
            d: Vec3::splat(Vec3::ZERO),
            e_o: z,
            e_d: z,
            c: [z; N],
            e: [z; 3],
            t_c: z,
            reach: z,
            from: z,
            to: z,
            after: z,
            before: z,
            open: M8::NONE,
            sign: z,
            poly: Poly8::default(),
            part: Part8::default(),
            root: Root8::default(),
            t: z,
            e_t: z,
        }
    }
}

impl<const N: usize> SinkKernel for Terms<N> {
    type Scratch = PolynomialScratch<N>;

    fn is_unbounded(&self) -> bool {
        true
    }

    /// Passes the crossings of each ray, or only the first one, and the doubts to `to`. Only
    /// crossings inside the faces of `cell` count. `leaving` describes rays that start on the
    /// surface, and whether the surface is turned.
    fn pass<K: Sink8>(
        &self,
        &KernelRays { own, rays, leaving, start, cell }: &KernelRays<'_>,
        to: &mut K,
        memory: &mut PolynomialScratch<N>,
    ) {
        let isa = rays.isa;
        isa.run_in_lanes(
            #[inline(always)]
            || {
                range(rays, cell, to, memory);
                let side = leaving.map_or(F8::ZERO, |(from, turned)| from.side(turned));
                memory.sign = memory.from.le(F8::ZERO).keep(side);
            },
        );
        if !memory.open.any() {
            return;
        }
        self.see(own, rays, start, memory);
        for piece in [LineThird::Before, LineThird::About, LineThird::Behind] {
            if !begin((piece, self.order as usize), rays, to, memory) {
                continue;
            }
            for _ in 0..N {
                if !memory.part.open.any() {
                    break;
                }
                memory.poly.isolate(isa, &mut memory.part);
                if (memory.part.one | memory.part.unsure).any() {
                    memory.poly.refine(isa, &memory.part, &mut memory.root);
                    self.close_in(piece, rays, memory);
                    offer(piece, rays, to, memory);
                }
                if !K::ALL {
                    break;
                }
            }
            isa.run_in_lanes(
                #[inline(always)]
                || memory.sign = memory.open.keep(memory.part.sign),
            );
        }
    }

    /// Points at `t`, known within `e`, that are certainly inside, and those that are certainly
    /// outside, as bit masks; for rays relative to the filter's centre.
    #[inline(never)]
    fn sides(&self, &KernelRays { own, rays, start, .. }: &KernelRays<'_>, (t, e): (F8, F8)) -> (u8, u8) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (o, d) = (own.point(start.h), own.vector(*rays.direction));
                let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
                let y = on(o, t, d);
                let e_y = e_o + t.abs() * e_d + e * largest(d) + (largest(o) + largest(y)) * (4.0 * U);
                let e_f = self.error(largest(y), e_y);
                let (f, _) = self.at(y);
                (f.lt(-e_f).bits(), f.gt(e_f).bits())
            },
        )
    }

    #[inline(always)]
    fn points(&self, own: &Own, at: &FacePoints) -> Skin {
        self.skin(own, at.h, at.h1)
    }
}

impl<const N: usize> Terms<N> {
    /// A bound on the error of `f` at points with coordinates up to `m` that are known within `e`;
    /// infinite if they are too far away.
    #[inline(always)]
    fn error(&self, m: F8, e: F8) -> F8 {
        let m = m + e;
        let Sizes { f, slope, .. } = self.sizes(m);
        let error = (slope * e + f * (16.0 * N as f64 * U) + TINY) * SLACK;
        m.lt(F8::splat(far::<N>())).select(error, F8::splat(f64::INFINITY))
    }

    /// Refines the roots' parameters on the rays.
    #[inline(never)]
    fn close_in(&self, piece: LineThird, rays: &RayLanes<'_>, memory: &mut PolynomialScratch<N>) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let PolynomialScratch { o, d, e_o, e_d, root, part, .. } = *memory;
                let (t, e) = at(piece, (root.x, root.e), memory.t_c, memory.reach);
                let (f, g) = self.at(on(o, t, d));
                let slope = dot(g, d);
                let next = t - f / slope;
                let y = on(o, next, d);
                let (f, _) = self.at(y);
                let size = largest(d);
                // The bounds must hold for points up to `e` away, too.
                let way = next.abs() + e;
                let e_y = e_o + way * e_d + (largest(o) + way * size) * (4.0 * U);
                let e_f = self.error(largest(y) + e * size, e_y);
                let close = (f.abs() + e_f * 2.0) / slope.abs() * 1.25 + next.abs() * (4.0 * U);
                let (a, b) = (next - close, next + close);
                let (before, _) = self.at(on(o, a, d));
                let (after, _) = self.at(on(o, b, d));
                let within = a.ge(t - e) & b.le(t + e);
                let proven = (before * part.sign).gt(e_f) & (after * part.sign).lt(-e_f);
                let better = root.sure & within & proven;
                memory.t = better.select(next, t);
                memory.e_t = better.select(close * SLACK, e);
            },
        );
    }

    /// Computes the polynomial along the rays.
    #[inline(never)]
    fn see(&self, own: &Own, rays: &RayLanes<'_>, start: &Start, memory: &mut PolynomialScratch<N>) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (o, d) = (own.point(start.h), own.vector(*rays.direction));
                let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
                let size = largest(d);
                let closest = (-dot(o, d) / dot(d, d)).max(memory.from);
                let share = if N <= 9 { 2.0 } else { 1.0 };
                let reach = (largest(on(o, closest, d)) * share + 2.0 * share) / size;
                let half = (memory.to - memory.from) * 0.5;
                let short = half.le(reach);
                let t_c = short.select(memory.from + half, closest);
                let reach = short.select(half, reach);
                let y = on(o, t_c, d);
                let v = Vec3::new(d.x * reach, d.y * reach, d.z * reach);
                let length = reach * size;
                let way = t_c.abs() + reach * 3.0;
                let e_y = e_o + way * e_d + (largest(o) + way * size) * (4.0 * U);
                let far_behind = pow2(self.order as i32);
                for (e, (s, r)) in memory.e.iter_mut().zip([(1.0, 1.0), (3.0, 1.0), (0.5, far_behind)]) {
                    *e = self.error(largest(y) + length * s, e_y) * r;
                }
                (memory.t_c, memory.reach) = (t_c, reach);
                (memory.o, memory.d, memory.e_o, memory.e_d) = (o, d, e_o, e_d);
                memory.c = self.along(y, v);
            },
        );
    }
}

/// Computes the part of each ray that is searched.
#[inline(always)]
fn range<K: Sink8, const N: usize>(
    rays: &RayLanes<'_>,
    cell: Option<&Hull>,
    to: &mut K,
    memory: &mut PolynomialScratch<N>,
) {
    let limit = to.limit(rays);
    (memory.from, memory.to) = (F8::ZERO, limit);
    (memory.after, memory.before) = (F8::ZERO, F8::splat(f64::INFINITY));
    memory.open = *rays.live;
    if let Some(Hull { enter, leave, missed, unsure }) = cell {
        let (earliest, latest) = (enter.t - enter.e, leave.e - leave.t);
        memory.from = earliest.max(F8::ZERO);
        memory.to = latest.min(limit);
        memory.after = (enter.t + enter.e).max(enter.others).max(F8::ZERO);
        memory.before = -((leave.t + leave.e).max(leave.others));
        let unknown = memory.open & *unsure & !*missed;
        if unknown.any() {
            to.doubt(unknown, F8::ZERO);
        }
        memory.open &= !(*missed | *unsure);
    }
    // NaN stays open, and ends as a doubt.
    memory.open &= !memory.to.le(memory.from);
}

/// Computes the polynomial of a piece, and the part of the piece that is searched. Returns false if
/// that is empty for all rays.
#[inline(never)]
fn begin<K: Sink8, const N: usize>(
    (piece, order): (LineThird, usize),
    rays: &RayLanes<'_>,
    to: &mut K,
    memory: &mut PolynomialScratch<N>,
) -> bool {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || begin_here((piece, order), to, memory),
    )
}

#[inline(always)]
fn begin_here<K: Sink8, const N: usize>(
    (piece, order): (LineThird, usize),
    to: &mut K,
    memory: &mut PolynomialScratch<N>,
) -> bool {
    let PolynomialScratch { c, e, t_c, reach, from, to: until, .. } = *memory;
    let (first, last) = (t_c - reach, t_c + reach);
    let matters = match piece {
        LineThird::Before => from.lt(first),
        LineThird::About => !(until.lt(first) | from.gt(last)),
        LineThird::Behind => until.gt(last),
    };
    let live = memory.open & matters;
    if !live.any() {
        return false;
    }
    let n = order.min(N - 1);
    let mut p = [F8::ZERO; N];
    let (l, end) = match piece {
        LineThird::Before => {
            for k in 0..=n {
                p[k] = if (n - k) % 2 == 0 { c[n - k] } else { -c[n - k] };
            }
            let l = reach / (t_c - from) * (1.0 - 8.0 * U);
            let end = until.lt(first).select(reach / (t_c - until) * (1.0 + 8.0 * U), F8::ONE);
            (l, end.min(F8::ONE))
        }
        LineThird::About => {
            // In powers of `2 x - 1`, then shifted.
            p = c;
            let mut power = 1.0;
            for p in &mut p {
                *p = *p * power;
                power *= 2.0;
            }
            shift(&mut p, -0.5);
            let width = reach * 2.0;
            let out = (t_c.abs() + reach) * (8.0 * U);
            let l = ((from - first - out) / width).max(F8::ZERO);
            let end = ((until - first + out) / width).min(F8::ONE);
            (l, end)
        }
        LineThird::Behind => {
            for k in 0..=n {
                p[k] = c[n - k];
            }
            // In powers of `1 - x`: shifted, then `x` is replaced by `-x`.
            shift(&mut p, 1.0);
            for (k, p) in p.iter_mut().enumerate() {
                if k % 2 == 1 {
                    *p = -*p;
                }
            }
            let end = F8::ONE - reach / (until - t_c) * (1.0 - 8.0 * U) + 2.0 * U;
            (F8::ZERO, end.min(F8::ONE))
        }
    };
    let e = e[piece as usize];
    memory.poly = Poly8 { c: p, e, e_first: e, e_last: e };
    let PolynomialScratch { poly, part, sign, open, .. } = &mut *memory;
    poly.begin_within(live, (l, end), *sign, part);
    part.sign = live.select(part.sign, *sign);
    if part.unsure.any() {
        let (t, e) = at(piece, (l, F8::ZERO), t_c, reach);
        to.doubt(part.unsure, t - e);
        *open &= !part.unsure;
        part.unsure = M8::NONE;
    }
    true
}

/// Passes the root found in a piece to `to`, and continues after it.
#[inline(never)]
fn offer<K: Sink8, const N: usize>(
    piece: LineThird,
    rays: &RayLanes<'_>,
    to: &mut K,
    memory: &mut PolynomialScratch<N>,
) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let PolynomialScratch { t_c, reach, after, before, poly, part, root, open, t, e_t, .. } =
                &mut *memory;
            let (t, e) = (*t, *e_t);
            let sure = root.sure & (t - e).gt(*after) & (t + e).lt(*before) & (t + e).le(*rays.t_max);
            to.take(sure, (t, e), F8::ZERO);
            let unsure = part.unsure | part.one & !sure;
            if unsure.any() {
                // Everything from here on is uncertain.
                let (l, e) = at(piece, (part.l, F8::ZERO), *t_c, *reach);
                to.doubt(unsure, l - e);
                *open &= !unsure;
                part.unsure = M8::NONE;
            }
            if !K::ALL {
                *open &= !part.one;
            }
            poly.go_on(part);
            part.open &= *open;
        },
    );
}

/// The parameter of the ray at `x` in a piece, where `x` is known within `e`, and its error; the
/// error is infinite if the parameter could be anything.
#[inline(always)]
fn at(piece: LineThird, (x, e): (F8, F8), t_c: F8, reach: F8) -> (F8, F8) {
    // T / (y - e) - T / y <= 2 T e / y²
    let far = |y: F8| {
        let way = reach / y;
        (way, y.gt(e * 2.0).select(way / y * e * 2.0, F8::splat(f64::INFINITY)))
    };
    let (t, e) = match piece {
        LineThird::Before => {
            let (way, e) = far(x);
            (t_c - way, e)
        }
        LineThird::About => (reach.mul_add(x * 2.0 - F8::ONE, t_c), reach * 2.0 * e),
        LineThird::Behind => {
            let (way, e) = far(F8::ONE - x);
            (t_c + way, e)
        }
    };
    (t, (e + (t_c.abs() + (t - t_c).abs()) * (8.0 * U)) * SLACK)
}

/// The polynomial in powers of `x - by`.
#[inline(always)]
fn shift<const N: usize>(p: &mut [F8; N], by: f64) {
    for first in 0..N - 1 {
        for k in (first..N - 1).rev() {
            p[k] = p[k + 1].mul_add(F8::splat(by), p[k]);
        }
    }
}
