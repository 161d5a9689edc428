//! Eight rays against a surface of revolution: their crossings with its walls and ends, and which
//! of their points are inside.

use super::{Bounded, RevolutionKernel, value};
use crate::packet::PacketFilter;
use crate::packet::kernel::{FacePoints, KernelRays, SinkKernel};
use crate::packet::local_frame::Own;
use crate::packet::polynomial_roots::{Part8, Poly8, Root8};
use crate::packet::quadric::Start;
use crate::packet::rays::{CLEAR, RayLanes, SLACK};
use crate::packet::sink::Sink8;
use crate::packet::skin::Skin;
use durer_math::scale::pow2;
use durer_math::{F8, M8, U};

/// Eight rays in the surface's own coordinates.
#[derive(Clone, Copy, Debug, Default)]
struct RevolutionRays8 {
    o: [F8; 3],
    d: [F8; 3],
    e_o: F8,
    e_d: F8,
    /// The sum of the magnitudes of the direction's coordinates.
    d1: F8,
    /// `a t² + 2 b t + c` is the squared distance from the axis; `e` bounds the error of all points
    /// of the ray.
    a: F8,
    b: F8,
    c: F8,
    e: F8,
    /// One over the direction's height, where that is certainly not zero.
    inverse: F8,
    steep: M8,
}

/// Where eight rays pass one height.
#[derive(Clone, Copy, Debug, Default)]
struct HeightCrossing8 {
    t: F8,
    e: F8,
}

/// Working memory for eight rays and one surface.
#[derive(Debug, Default)]
pub(crate) struct RevolutionScratch {
    sight: RevolutionRays8,
    low: HeightCrossing8,
    high: HeightCrossing8,
    from: F8,
    length: F8,
    /// The side of the wall on which a ray passes the height below and the one above: 1 outside, -1
    /// inside, 0 unknown.
    sides: [F8; 2],
    /// The side on which rays start, in the same form.
    start: F8,
    poly: Poly8<5>,
    part: Part8,
    root: Root8,
}

impl SinkKernel for RevolutionKernel {
    type Scratch = RevolutionScratch;

    fn face_of(&self, number: u32) -> u32 {
        number.saturating_sub(self.walls.len() as u32 - 1).min(2)
    }

    fn is_operand(&self) -> bool {
        self.walls.len() + 2 <= PacketFilter::FACES
    }

    /// Passes the crossings of each ray, or only the first one of each wall, and the doubts to
    /// `to`. `leaving` describes rays that start on the surface, and whether the surface is turned.
    fn pass<K: Sink8>(
        &self,
        &KernelRays { own, rays, leaving, start, .. }: &KernelRays<'_>,
        to: &mut K,
        memory: &mut RevolutionScratch,
    ) {
        let isa = rays.isa;
        isa.run_in_lanes(
            #[inline(always)]
            || {
                see(own, rays, start, &mut memory.sight);
                memory.start = match leaving {
                    Some((from, turned)) if self.walls.len() == 1 && !self.closed => from.side(turned),
                    _ => F8::ZERO,
                };
            },
        );
        self.level(rays, 0, memory);
        let mut before = F8::ONE;
        for i in 0..self.walls.len() {
            memory.low = memory.high;
            self.level(rays, i + 1, memory);
            self.cut(rays, i, to, memory);
            // A quartic has at most four roots.
            for _ in 0..4 {
                if !memory.part.open.any() {
                    break;
                }
                memory.poly.isolate(isa, &mut memory.part);
                memory.poly.refine(isa, &memory.part, &mut memory.root);
                self.offer(rays, i, to, memory);
                if !K::ALL {
                    break;
                }
                memory.poly.go_on(&mut memory.part);
            }
            let (low, [below, above]) = (memory.low, memory.sides);
            self.seam(rays, i, &low, &(before, below), to);
            before = above;
        }
        let high = memory.high;
        self.seam(rays, self.walls.len(), &high, &(before, F8::ONE), to);
    }

    /// Points at `t`, known within `e`, that are certainly inside, and those that are certainly
    /// outside, as bit masks; for rays relative to the filter's centre.
    #[inline(never)]
    fn sides(&self, &KernelRays { own, rays, start, .. }: &KernelRays<'_>, (t, e): (F8, F8)) -> (u8, u8) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let mut sight = RevolutionRays8::default();
                see(own, rays, start, &mut sight);
                let RevolutionRays8 { o, d, e_o, e_d, d1, .. } = sight;
                let (x, y, z) = (t.mul_add(d[0], o[0]), t.mul_add(d[1], o[1]), t.mul_add(d[2], o[2]));
                let (mut inside, mut outside) = (M8::ALL, M8::ALL);
                let n = x.mul_add(x, z * z);
                let e_point = e_o + t.abs() * e_d + e * d1;
                for (i, Bounded { wall, near, slack, .. }) in self.walls.iter().enumerate() {
                    let e = (e_point + (*slack + wall.radius * (4.0 * U))) * SLACK;
                    let known = e.lt(F8::splat(wall.radius * pow2(-12)));
                    let (low, high) = (y - wall.slab[0], y - wall.slab[1]);
                    let (below, above) = (low.lt(-e), high.gt(e));
                    if i == 0 {
                        inside &= low.gt(e);
                    }
                    if i + 1 == self.walls.len() {
                        inside &= high.lt(-e);
                    }
                    let beside = below | above;
                    // Beyond the cylinder, up to which `near` is valid.
                    let far = known & n.gt(F8::splat(wall.radius * wall.radius * (1.0 + pow2(-8))));
                    let f = value(wall, n, y - wall.at);
                    let e_f = e * (2.0 * near.slope) + 16.0 * U * near.f;
                    inside &= beside | known & !far & f.lt(-e_f);
                    outside &= beside | far | known & f.gt(e_f);
                }
                (inside.bits(), outside.bits())
            },
        )
    }

    #[inline(always)]
    fn points(&self, own: &Own, at: &FacePoints) -> Skin {
        self.skin(own, at.face, at.h, at.h1)
    }
}

impl RevolutionKernel {
    /// Computes where the rays pass height `i`.
    #[inline(never)]
    fn level(&self, rays: &RayLanes<'_>, i: usize, memory: &mut RevolutionScratch) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (wall, end) = if i == 0 { (0, 0) } else { (i - 1, 1) };
                let Bounded { wall, slack, .. } = &self.walls[wall];
                let RevolutionRays8 { o, e_o, e_d, inverse, .. } = memory.sight;
                let way = -(o[1] - wall.slab[end]);
                let t = way * inverse;
                let e = (e_o + *slack + t.abs() * e_d) * inverse.abs() * (CLEAR / (CLEAR - 1.0))
                    + t.abs() * (4.0 * U);
                memory.high = HeightCrossing8 { t, e: e * SLACK };
            },
        );
    }

    /// Computes the part of each ray on which a wall must be searched, and the polynomial there.
    #[inline(never)]
    fn cut<K: Sink8>(&self, rays: &RayLanes<'_>, i: usize, to: &mut K, memory: &mut RevolutionScratch) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.cut_here(rays, i, to, memory),
        );
    }

    #[inline(always)]
    fn cut_here<K: Sink8>(&self, rays: &RayLanes<'_>, i: usize, out: &mut K, memory: &mut RevolutionScratch) {
        let Bounded { wall, near, wide, slack, .. } = &self.walls[i];
        let RevolutionScratch { sight, low, high, .. } = memory;
        let RevolutionRays8 { o, d, e_o, e_d, d1, a, b, c, e, inverse, steep } = *sight;
        let square = wall.radius * wall.radius;
        // Rays whose errors fit into the room between the wall and the wider cylinder.
        let known = steep & (c * (16.0 * U)).lt(F8::splat(square * pow2(-11)));
        let known = known & e.lt(F8::splat(wall.radius * pow2(-12)));
        let disc = b.mul_add(b, -(a * (c - square * (1.0 + pow2(-8)))));
        let missed = disc.lt(F8::ZERO);
        let root = disc.max(F8::ZERO).sqrt();
        let (near_side, far_side) = ((-b - root) / a, (root - b) / a);
        let up = inverse.gt(F8::ZERO);
        let (enter, leave) = (up.select(low.t, high.t), up.select(high.t, low.t));
        let (e_enter, e_leave) = (up.select(low.e, high.e), up.select(high.e, low.e));
        // `max` and `min` return the second operand where one is NaN.
        let from = near_side.max(enter).max(F8::ZERO);
        let limit = out.limit(rays);
        let to = far_side.min(leave).min(limit);
        let live = *rays.live & known & !missed & !to.le(from);
        let unknown = *rays.live & !known;
        if unknown.any() {
            out.doubt(unknown, F8::ZERO);
        }
        // A ray that passes a height outside the cylinder is outside there.
        let room = F8::splat(wall.radius * pow2(-12));
        let clear_enter = missed | (near_side.gt(enter) | far_side.lt(enter)) & (e_enter * d1).lt(room);
        let clear_leave = missed | (near_side.gt(leave) | far_side.lt(leave)) & (e_leave * d1).lt(room);
        let mut sides = (clear_enter.keep(F8::ONE), clear_leave.keep(F8::ONE));
        memory.sides = [up.select(sides.0, sides.1), up.select(sides.1, sides.0)];
        memory.part.open = live;
        if !live.any() {
            return;
        }
        let length = to - from;
        (memory.from, memory.length) = (from, length);
        // The point at the start of the part, and the vector from there to its end.
        let (x, y, z) = (from.mul_add(d[0], o[0]), from.mul_add(d[1], o[1]), from.mul_add(d[2], o[2]));
        let v = y - wall.at;
        let (dx, dv, dz) = (length * d[0], length * d[1], length * d[2]);
        let n0 = x.mul_add(x, z * z);
        let n1 = x.mul_add(dx, z * dz) * 2.0;
        let n2 = dx.mul_add(dx, dz * dz);
        let [p0, p1, p2, p3] = F8::splats(wall.p);
        let dv2 = dv * dv;
        let value = p3.mul_add(v, p2).mul_add(v, p1).mul_add(v, p0);
        let slope = (p3 * 3.0).mul_add(v, p2 * 2.0).mul_add(v, p1);
        let bend = (p3 * 3.0).mul_add(v, p2);
        let beta = F8::splat(wall.beta);
        let mut k = [
            beta.mul_add(n0, -value),
            beta.mul_add(n1, -(slope * dv)),
            beta.mul_add(n2, -(bend * dv2)),
            -(p3 * (dv2 * dv)),
            F8::ZERO,
        ];
        if wall.alpha != 0.0 {
            let q0 = v.mul_add(v, n0) + wall.kappa;
            let q1 = (v * dv).mul_add(F8::splat(2.0), n1);
            let q2 = n2 + dv2;
            let alpha = F8::splat(wall.alpha);
            k[0] = alpha.mul_add(q0 * q0, k[0]);
            k[1] = alpha.mul_add(q0 * q1 * 2.0, k[1]);
            k[2] = alpha.mul_add(q1.mul_add(q1, q0 * q2 * 2.0), k[2]);
            k[3] = alpha.mul_add(q1 * q2 * 2.0, k[3]);
            k[4] = alpha * (q2 * q2);
        }
        // The rounding of the formulas, including that of the heights and of the points.
        let of_points = *slack + wall.radius * (4.0 * U);
        let (rounding, at_point) = (64.0 * U * wide.f + 2.0 * wide.slope * of_points, 16.0 * U * near.f);
        let (e_from, e_to) = (e_o + from * e_d, e_o + to * e_d);
        // Where a part ends at a height, that end has an error of its own.
        let (at_enter, at_leave) = (enter.ge(from), leave.le(to));
        let e_first = e_from + of_points + at_enter.keep(e_enter) * d1;
        let e_last = e_to + at_leave.keep(e_leave) * d1;
        let whole = e_to * (2.0 * wide.slope) + rounding;
        memory.poly = Poly8 {
            c: k,
            e: whole,
            e_first: e_first * (2.0 * near.slope) + at_point,
            e_last: e_last * (2.0 * wide.slope) + rounding,
        };
        // The sizes are valid in this range; rays along the axis may leave it.
        let most = F8::splat(wall.radius * (1.0 + 1.0 / 64.0));
        let within = n0.lt(most * most) & (x + dx).abs().lt(most) & (z + dz).abs().lt(most);
        let open = live & within;
        let (first, last) = memory.poly.ends();
        sides.0 = (open & at_enter).select(first, sides.0);
        sides.1 = (open & at_leave).select(last, sides.1);
        memory.sides = [up.select(sides.0, sides.1), up.select(sides.1, sides.0)];
        // If a ray starts on the only wall, its side is known.
        let start = memory.start;
        let known = (from.le(F8::ZERO)).select(start, F8::ZERO);
        memory.poly.begin_with(open, known, &mut memory.part);
        let unsure = live & !within | memory.part.unsure;
        if unsure.any() {
            out.doubt(unsure, from);
        }
        memory.part.unsure = M8::NONE;
    }

    /// Passes the root found on a wall to `to`.
    #[inline(never)]
    fn offer<K: Sink8>(&self, rays: &RayLanes<'_>, i: usize, to: &mut K, memory: &mut RevolutionScratch) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let RevolutionScratch { from, length, part, root, .. } = memory;
                let t = root.x.mul_add(*length, *from);
                let e = (root.e * *length + t * (2.0 * U)) * SLACK;
                let sure = root.sure & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
                to.take(sure, (t, e), F8::splat(i as f64));
                let unsure = part.unsure | part.one & !sure;
                // Everything beyond is uncertain.
                part.unsure = M8::NONE;
                if unsure.any() {
                    to.doubt(unsure, part.l.mul_add(*length, *from) * (1.0 - 4.0 * U));
                }
            },
        );
    }

    /// Compares the sides of a ray just below and just above height `i`. Opposite sides are a hit
    /// at a flat end, correct at an open end, and a doubt at an inner height. An unknown side is a
    /// doubt.
    #[inline(never)]
    fn seam<K: Sink8>(
        &self,
        rays: &RayLanes<'_>,
        i: usize,
        level: &HeightCrossing8,
        sides: &(F8, F8),
        to: &mut K,
    ) {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || {
                let product = sides.0 * sides.1;
                let HeightCrossing8 { t, e } = *level;
                let matters = *rays.live & !((t + e).lt(F8::ZERO) | (t - e).gt(to.limit(rays)));
                let open = matters & !product.gt(F8::ZERO);
                if !open.any() {
                    return;
                }
                let end = i == 0 || i == self.walls.len();
                let mut unsure = open;
                if end {
                    let passes = open & product.lt(F8::ZERO);
                    let sure = if self.closed {
                        let sure = passes & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
                        let face = self.walls.len() + usize::from(i > 0);
                        to.take(sure, (t, e), F8::splat(face as f64));
                        sure
                    } else {
                        passes
                    };
                    unsure &= !sure;
                }
                to.doubt(unsure, t - e);
            },
        );
    }
}

/// Computes the rays in the surface's own coordinates.
#[inline(always)]
fn see(own: &Own, rays: &RayLanes<'_>, start: &Start, sight: &mut RevolutionRays8) {
    let (o, d) = (own.point(start.h), own.vector(*rays.direction));
    let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
    (sight.o, sight.d) = ([o.x, o.y, o.z], [d.x, d.y, d.z]);
    (sight.e_o, sight.e_d) = (e_o, e_d);
    sight.d1 = d.x.abs() + d.y.abs() + d.z.abs();
    sight.a = d.x.mul_add(d.x, d.z * d.z);
    sight.b = o.x.mul_add(d.x, o.z * d.z);
    sight.c = o.x.mul_add(o.x, o.z * o.z);
    sight.e = (e_o + start.far * e_d) * 2.0;
    sight.inverse = F8::ONE / d.y;
    sight.steep = d.y.abs().gt(e_d * CLEAR);
}
