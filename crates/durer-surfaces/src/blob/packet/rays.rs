//! Crossings of eight rays with a blob.
//!
//! Let `s` be the distance along a ray from its closest approach to the blob's centre, in the
//! blob's units. Along the ray a field is a piece `S (1 - m - v (2 b + n v))²`, `v = s - at`, from
//! its start to its end; a cylinder has three such pieces. The kernel steps from one such start or
//! end to the next. In between the sum is a polynomial of degree four (`polynomial_roots.rs`).
//!
//! **Errors** of pieces are those of `blob/component.rs`. Polynomials are formed on `[0, 1]` in
//! place of `[-1, 1]`, where the sum of the magnitudes of the coefficients of `q` is at most nine
//! times as large. Pieces start and end at rounded places. What a piece could add outside of them
//! is charged to the whole ray. Intervals overlap by more than the rounding of their ends, `8 U`;
//! for this the charge of a piece counts `4` more in the sum of the places.
//!
//! **The start of a ray** is rounded outward by `8 U (|t_c| |d| + 2)`, which is less than
//! `128 U (1 + |y|)` at the start `y`. Within that distance a start that was moved off the surface
//! (`Fields::skin`) keeps its known sign.

use super::groups::Group;
use super::{Field, Fields, TINY};
use crate::packet::kernel::{FacePoints, KernelRays, SinkKernel};
use crate::packet::local_frame::{Own, dot, largest, on};
use crate::packet::polynomial_roots::{Part8, Poly8, Root8};
use crate::packet::quadric::Start;
use crate::packet::rays::{RayLanes, SLACK};
use crate::packet::sink::Sink8;
use crate::packet::skin::Skin;
use arrayvec::ArrayVec;
use durer_math::{F8, Isa, M8, U, Vec3};

/// The most pieces that are stored for eight rays; with more, all rays are doubts.
const MOST: usize = 64;
/// The blob is within `√3` of its centre, in units.
const REACH: f64 = 2.0;
const NEVER: F8 = F8::splat(f64::INFINITY);

/// One piece along each ray; for a ray that misses it, it starts at infinity.
#[derive(Clone, Copy, Debug)]
struct Piece8 {
    from: F8,
    to: F8,
    at: F8,
    m: F8,
    b: F8,
    n: F8,
    strength: f64,
    /// An upper bound of the field; zero where it is negative.
    peak: F8,
    /// The sum of the errors of its coefficients.
    slack: F8,
}

/// Eight rays in the blob's units, relative to their closest approach to its centre.
#[derive(Clone, Copy, Debug)]
struct BlobRays8 {
    o: Vec3<F8>,
    d: Vec3<F8>,
    e_o: F8,
    e_d: F8,
    o_size: F8,
    /// `t = t_c + s unit`.
    t_c: F8,
    unit: F8,
    e_t: F8,
}

/// Working memory for eight rays and one blob.
#[derive(Debug)]
pub(crate) struct BlobScratch {
    sight: BlobRays8,
    pieces: ArrayVec<Piece8, MOST>,
    charge: F8,
    /// The current place on each ray, the end of the current interval, the end of the whole range,
    /// and the sign at the current place: 1, -1, or 0 if it is unknown.
    here: F8,
    next: F8,
    last: F8,
    sign: F8,
    /// Lanes that are not finished.
    open: M8,
    poly: Poly8<5>,
    part: Part8,
    root: Root8,
}

impl Default for BlobScratch {
    fn default() -> Self {
        let z = F8::ZERO;
        let none = Vec3::splat(Vec3::ZERO);
        let sight = BlobRays8 { o: none, d: none, e_o: z, e_d: z, o_size: z, t_c: z, unit: z, e_t: z };
        Self {
            sight,
            pieces: ArrayVec::new(),
            charge: z,
            here: z,
            next: z,
            last: z,
            sign: z,
            open: M8::NONE,
            poly: Poly8::default(),
            part: Part8::default(),
            root: Root8::default(),
        }
    }
}

/// `w` relative to the point of the axis at `lift`, or to the axis.
#[inline(always)]
fn placed(w: Vec3<F8>, lift: Option<F8>) -> Vec3<F8> {
    let z = match lift {
        Some(lift) => w.z - lift,
        None => F8::ZERO,
    };
    Vec3::new(w.x, w.y, z)
}

/// The part of each ray on which a field has one of its pieces. Distances are measured from a point
/// of its axis, or from the axis.
#[derive(Clone, Copy)]
struct Segment {
    lift: Option<F8>,
    low: F8,
    high: F8,
    /// The error of `w_z`, if the ends of the piece depend on it.
    doubt: F8,
}

impl SinkKernel for Fields {
    type Scratch = BlobScratch;

    /// Passes the crossings of each ray, or only the first one, and the doubts to `to`. `leaving`
    /// describes rays that start on the surface, and whether the surface is turned.
    fn pass<K: Sink8>(
        &self,
        &KernelRays { own, rays, leaving, start, .. }: &KernelRays<'_>,
        to: &mut K,
        memory: &mut BlobScratch,
    ) {
        let isa = rays.isa;
        isa.run_in_lanes(
            #[inline(always)]
            || {
                begin(own, rays, start, to, memory);
                memory.sign = leaving.map_or(F8::ZERO, |(from, turned)| from.side(turned));
            },
        );
        memory.pieces.clear();
        memory.charge = F8::ZERO;
        if !self.pieces(isa, memory) {
            to.doubt(memory.open, F8::ZERO);
            return;
        }
        // Each piece has a start and an end.
        for _ in 0..=2 * memory.pieces.len() {
            if !memory.open.any() {
                return;
            }
            self.stretch(rays, to, memory);
            // A quartic has at most four roots.
            for _ in 0..4 {
                if !memory.part.open.any() {
                    break;
                }
                memory.poly.isolate(isa, &mut memory.part);
                if (memory.part.one | memory.part.unsure).any() {
                    memory.poly.refine(isa, &memory.part, &mut memory.root);
                    offer(rays, to, memory);
                }
                if !K::ALL {
                    break;
                }
            }
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    memory.sign = memory.part.sign;
                    memory.here = memory.next;
                    memory.open &= memory.here.lt(memory.last);
                },
            );
        }
        to.doubt(memory.open, F8::ZERO);
    }

    /// Bit masks of the points at `t` that are certainly inside, and of those certainly outside;
    /// `t` is known within `e`, and rays are relative to the filter's centre.
    #[inline(never)]
    fn sides(&self, &KernelRays { own, rays, start, .. }: &KernelRays<'_>, (t, e): (F8, F8)) -> (u8, u8) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (o, d) = (own.point(start.h), own.vector(*rays.direction));
                let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
                let y = on(o, t, d);
                let e_y = e_o + t.abs() * e_d + e * largest(d) + (largest(o) + largest(y)) * (4.0 * U);
                let Skin { f, e_f, .. } = self.at(y, e_y);
                (f.lt(-e_f).bits(), f.gt(e_f).bits())
            },
        )
    }

    #[inline(always)]
    fn points(&self, own: &Own, at: &FacePoints) -> Skin {
        self.skin(own, at.h, at.h1)
    }
}

impl Fields {
    /// Stores the pieces of all fields that the rays may meet, and adds up what the others could
    /// contribute. Returns false if there is no room.
    fn pieces(&self, isa: Isa, memory: &mut BlobScratch) -> bool {
        let BlobScratch { sight, here, last, open, pieces, charge, .. } = memory;
        let mut i = 0;
        while let Some(Group { centre, radius, fields, next }) = self.groups.get(i) {
            if sight.passes_by(isa, (*centre, *radius), (here, last), open) {
                i = *next;
                continue;
            }
            i += 1;
            if !self.fields[fields.clone()].iter().all(|field| field.pieces(isa, sight, charge, pieces)) {
                return false;
            }
        }
        true
    }

    /// The polynomial up to the next start or end of a piece.
    #[inline(never)]
    fn stretch<K: Sink8>(&self, rays: &RayLanes<'_>, to: &mut K, memory: &mut BlobScratch) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let BlobScratch { sight, pieces, charge, here, next, last, sign, open, poly, part, .. } =
                    &mut *memory;
                *next = *last;
                for piece in &*pieces {
                    next.set_where(piece.from.gt(*here) & piece.from.lt(*next), piece.from);
                    next.set_where(piece.to.gt(*here) & piece.to.lt(*next), piece.to);
                }
                let count = self.fields.len() as f64 + 40.0;
                let (mut e, mut most) = (*charge, *charge);
                for piece in &*pieces {
                    let on = piece.from.le(*here) & piece.to.gt(*here);
                    e += on.keep(piece.slack);
                    most += on.keep(piece.peak);
                }
                // The fields here do not add up to the threshold, with the same margin as in the
                // scalar kernel.
                let outside = (most * (1.0 + 1.0 / 1024.0)).lt(F8::splat(self.threshold));
                let live = *open & !outside;
                if !live.any() {
                    (part.open, part.sign) = (M8::NONE, F8::ONE);
                    return;
                }
                let width = (*next - *here) * (1.0 + 4.0 * U) + 8.0 * U;
                let mut c = [F8::splat(self.threshold), F8::ZERO, F8::ZERO, F8::ZERO, F8::ZERO];
                for piece in &*pieces {
                    let on = piece.from.le(*here) & piece.to.gt(*here);
                    piece.add(on, *here, width, &mut c);
                }
                let size = self.threshold + self.strength;
                let e = (e + count * U * size + TINY) * SLACK;
                *poly = Poly8 { c, e, e_first: e, e_last: e };
                poly.begin_with(live, *sign, part);
                part.sign = outside.select(F8::ONE, part.sign);
                if part.unsure.any() {
                    to.doubt(part.unsure, sight.t(*here).0);
                    *open &= !part.unsure;
                    part.unsure = M8::NONE;
                }
            },
        );
    }
}

/// Computes the rays in the blob's units, and the range of each that is searched.
#[inline(always)]
fn begin<K: Sink8>(own: &Own, rays: &RayLanes<'_>, start: &Start, to: &mut K, memory: &mut BlobScratch) {
    let (o, d) = (own.point(start.h), own.vector(*rays.direction));
    let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
    let unit = F8::ONE / dot(d, d).sqrt();
    let t_c = -dot(o, d) * unit * unit;
    let way = t_c.abs() * largest(d);
    let centre = on(o, t_c, d);
    memory.sight = BlobRays8 {
        o: centre,
        d: Vec3::new(d.x * unit, d.y * unit, d.z * unit),
        e_o: e_o + t_c.abs() * e_d + (largest(o) + way) * (4.0 * U),
        e_d: e_d * unit + 4.0 * U,
        o_size: largest(centre),
        t_c,
        unit,
        e_t: (t_c.abs() + unit * REACH) * (8.0 * U),
    };
    let out = (t_c.abs() / unit + REACH) * (8.0 * U);
    let reach = F8::splat(REACH);
    memory.here = (-t_c / unit - out).max(-reach);
    memory.last = ((to.limit(rays) - t_c) / unit + out).min(reach);
    // NaN stays open, and ends as a doubt.
    memory.open = *rays.live & !memory.last.le(memory.here);
}

impl BlobRays8 {
    /// The parameter of the ray at `s`, and its error.
    #[inline(always)]
    fn t(&self, s: F8) -> (F8, F8) {
        (s.mul_add(self.unit, self.t_c), self.e_t)
    }

    /// Whether all rays certainly miss a ball, or meet it only before `here` or beyond `last`.
    #[inline(never)]
    fn passes_by(
        &self,
        isa: Isa,
        (centre, radius): (Vec3, f64),
        (here, last): (&F8, &F8),
        open: &M8,
    ) -> bool {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let m = Vec3::splat(centre);
                let r = Vec3::new(self.o.x - m.x, self.o.y - m.y, self.o.z - m.z);
                let (square, along) = (dot(r, r), dot(r, self.d));
                // The error of a point of a ray, and that from rounding these numbers: fewer than
                // 16 roundings of the squared distance, where |d| is one up to 4 roundings.
                let e =
                    (self.e_o + self.e_d * REACH) * 2.0 + (self.o_size + centre.max_abs() + 4.0) * (32.0 * U);
                let reach = (e + radius) * SLACK;
                let beside = (square * (1.0 - 32.0 * U) - along * along).gt(reach * reach * SLACK);
                let (first, end) = (-along - reach, reach - along);
                (beside | end.lt(*here) | first.gt(*last) | !*open).all()
            },
        )
    }
}

/// Passes the root found in an interval to `to`, and continues after it.
#[inline(never)]
fn offer<K: Sink8>(rays: &RayLanes<'_>, to: &mut K, memory: &mut BlobScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let BlobScratch { sight, here, next, open, poly, part, root, .. } = &mut *memory;
            let width = (*next - *here) * (1.0 + 4.0 * U) + 8.0 * U;
            let (t, e) = sight.t(root.x.mul_add(width, *here));
            let e = (root.e * width * sight.unit + e) * SLACK;
            let sure = root.sure & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
            to.take(sure, (t, e), F8::ZERO);
            let unsure = part.unsure | part.one & !sure;
            if unsure.any() {
                // Everything from here on is uncertain.
                let (t, e) = sight.t(part.l.mul_add(width, *here));
                to.doubt(unsure, t - e);
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

impl Field {
    /// Adds the field's pieces along the rays, and to `charge` what it could contribute where it
    /// barely misses them. Returns false if there is no room.
    #[inline(never)]
    fn pieces(
        &self,
        isa: Isa,
        sight: &BlobRays8,
        charge: &mut F8,
        pieces: &mut ArrayVec<Piece8, MOST>,
    ) -> bool {
        let zero = Vec3::splat(Vec3::ZERO);
        let (mut r, mut a) = (zero, zero);
        let reach = F8::splat(REACH);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let m = Vec3::splat(self.centre);
                r = Vec3::new(sight.o.x - m.x, sight.o.y - m.y, sight.o.z - m.z);
                a = self.turned(sight.d);
            },
        );
        if self.length == 0.0 {
            let ball = Segment { lift: Some(F8::ZERO), low: -reach, high: reach, doubt: F8::ZERO };
            return self.piece(isa, (sight, &r, &a), &ball, charge, pieces);
        }
        let mut segments = [Segment { lift: None, low: -reach, high: reach, doubt: F8::ZERO }; 3];
        isa.run_in_lanes(
            #[inline(always)]
            || {
                // w_z along the rays, within `doubt` on all of it.
                let height = dot(Vec3::splat(self.rows[2]), r);
                let rate = a.z;
                let doubt = self.error_at(sight, largest(r), reach)
                    + self.rate_error(sight) * REACH
                    + (height.abs() + rate.abs() * REACH + self.length) * (16.0 * U);
                // Where the rays pass the ends of the axis, in the order of the ray. A ray across
                // the axis is between the ends, or beyond one of them, along its whole length.
                let (low, high) = (-height / rate, -(height - self.length) / rate);
                let level = rate.equals(F8::ZERO);
                let (below, above) = (level & height.lt(F8::ZERO), level & height.gt(F8::splat(self.length)));
                let enter = level.select(-reach, low.min(high).max(-reach).min(reach));
                let leave = level.select(reach, low.max(high).max(-reach).min(reach));
                let enter = below.select(reach, enter);
                let leave = below.select(reach, above.select(-reach, leave));
                let falls = rate.lt(F8::ZERO);
                let length = F8::splat(self.length);
                let (first, last) = (falls.select(length, F8::ZERO), falls.select(F8::ZERO, length));
                let [before, tube, behind] = &mut segments;
                *before = Segment { lift: Some(first), low: -reach, high: enter, doubt };
                *tube = Segment { lift: None, low: enter, high: leave, doubt };
                *behind = Segment { lift: Some(last), low: leave, high: reach, doubt };
            },
        );
        segments.iter().all(|segment| self.piece(isa, (sight, &r, &a), segment, charge, pieces))
    }

    /// The error of each coordinate of `w` at `s`, where `y - m` is `size` long along an axis.
    #[inline(always)]
    fn error_at(&self, sight: &BlobRays8, size: F8, s: F8) -> F8 {
        let own = sight.e_o + s.abs() * sight.e_d + self.centre_err;
        (own + (sight.o_size + self.centre.max_abs() + size) * (2.0 * U)) * self.size
            + size * (self.size_err + self.size * (4.0 * U))
            + self.length * (8.0 * U)
            + TINY
    }

    /// The error of each coordinate of `W d`.
    #[inline(always)]
    fn rate_error(&self, sight: &BlobRays8) -> F8 {
        sight.e_d * self.size + ((self.size_err + self.size * (4.0 * U)) * 2.0 + TINY)
    }

    /// One piece. `r` is the ray's origin relative to the field, and `a` is `W d`.
    #[inline(never)]
    fn piece(
        &self,
        isa: Isa,
        (sight, r, a): (&BlobRays8, &Vec3<F8>, &Vec3<F8>),
        segment: &Segment,
        charge: &mut F8,
        pieces: &mut ArrayVec<Piece8, MOST>,
    ) -> bool {
        isa.run_in_lanes(
            #[inline(always)]
            || self.piece_here(sight, (*r, *a), segment, charge, pieces),
        )
    }

    #[inline(always)]
    fn piece_here(
        &self,
        sight: &BlobRays8,
        (r, a): (Vec3<F8>, Vec3<F8>),
        segment: &Segment,
        charge: &mut F8,
        pieces: &mut ArrayVec<Piece8, MOST>,
    ) -> bool {
        let &Segment { lift, low, high, doubt } = segment;
        let a = Vec3::new(a.x, a.y, if lift.is_some() { a.z } else { F8::ZERO });
        let n = dot(a, a);
        // The closest approach, approximately; any number would do. NaN becomes an end.
        let at = (-dot(placed(self.turned(r), lift), a) / n).max(low).min(high);
        let y = on(r, at, sight.d);
        let w = placed(self.turned(y), lift);
        let (m, b) = (dot(w, w), dot(w, a));
        let (e_w, e_a) = (self.error_at(sight, largest(y), at), self.rate_error(sight));
        let top = n.gt(F8::ZERO).keep((-b / n).max(low - at).min(high - at));
        let most = -((b * 2.0 + n * top).mul_add(top, m) - 1.0);
        // Certainly missed, if the errors are far below one, as they usually are.
        let passed = most.lt(F8::splat(-0.125)) & (e_w + e_a * (2.0 * REACH)).lt(F8::splat(1.0 / 1024.0));
        let some = high.gt(low);
        if (passed | !some).all() {
            return true;
        }
        // q = 1 at v = (-b ± √(b² + n (1 - m))) / n, without cancellation.
        let root = b.mul_add(b, n * (F8::ONE - m)).max(F8::ZERO).sqrt();
        let rises = b.gt(F8::ZERO);
        let sum = rises.select(-b - root, root - b);
        let (outer, inner) = (sum / n, (m - 1.0) / sum);
        let (first, last) = (rises.select(outer, inner), rises.select(inner, outer));
        let (from, to) = ((at + first).max(low).min(high), (at + last).min(high).max(low));
        let far = (from - at).abs().max((to - at).abs()).max(top.abs());
        // The error |q exact - q| is at most 2√3 G E + 3 E² with G² <= 2 (m + n V²),
        // E = e_w + V e_a; plus the rounding
        // of q when it is evaluated.
        let extent = far.mul_add(far * n, m);
        let whole = (far * 2.0).mul_add(b.abs(), extent);
        let e = far.mul_add(e_a, e_w);
        let e_q = ((extent + 0.5) * 3.5 + e * 3.0).mul_add(e, (whole + extent * 2.0 + 1.0) * (16.0 * U))
            + doubt * doubt;
        let strength = self.strength.abs();
        let touched = most.le(e_q * 16.0);
        let missed = !some | passed | touched | from.ge(to);
        let speed = a.x.abs() + a.y.abs() + a.z.abs();
        let ends = (from.abs() + to.abs() + at.abs() + 4.0) * speed + 4.0;
        let seam = doubt + e_q * 2.0 + ends * (16.0 * U);
        let over = touched.select((most + e_q * 2.0).max(F8::ZERO) + e_q, e_q * 2.0);
        let left = missed.select(over, seam);
        *charge += (some & !passed).keep(left * left * strength);
        if missed.all() {
            return true;
        }
        let slack = (((whole * 18.0 + 2.0 + e_q) * e_q)
            + (whole * 9.0 + 1.0) * (whole * 9.0 + 1.0) * (96.0 * U))
            * (strength * (1.0 + 1.0 / 64.0));
        let peak = (most + e_q) * (most + e_q) * (self.strength.max(0.0) * SLACK);
        let piece = Piece8 {
            from: missed.select(NEVER, from),
            to: missed.select(-NEVER, to),
            at,
            m,
            b,
            n,
            strength: self.strength,
            peak,
            slack,
        };
        pieces.try_push(piece).is_ok()
    }
}

impl Piece8 {
    /// Subtracts its coefficients over `here + x width` in the lanes `on`.
    #[inline(always)]
    fn add(&self, on: M8, here: F8, width: F8, c: &mut [F8; 5]) {
        let u = here - self.at;
        let slope = self.n.mul_add(u, self.b);
        let g0 = on.keep(-((self.b + slope).mul_add(u, self.m) - 1.0));
        let q1 = on.keep(width * slope * 2.0);
        let q2 = on.keep(self.n * (width * width));
        let s = -self.strength;
        let (sg, sq) = (g0 * s, q2 * s);
        c[0] = sg.mul_add(g0, c[0]);
        c[1] = (sg * -2.0).mul_add(q1, c[1]);
        c[2] = (q1 * s).mul_add(q1, (sg * -2.0).mul_add(q2, c[2]));
        c[3] = (sq * 2.0).mul_add(q1, c[3]);
        c[4] = sq.mul_add(q2, c[4]);
    }
}
