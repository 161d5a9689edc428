//! The first crossing of each of eight rays with a level set.
//!
//! Let `s` be the distance along a ray from its closest approach to the solid's centre, in the
//! solid's units, so that `t = t_c + s unit`. The rounded `t_c` and `unit` are taken as exact;
//! their rounding is charged to the line.
//!
//! **The start of a ray** is rounded outward by `8 U (|t_c| |d| + reach)`, which is less than
//! `128 U (reach + |y|)` at the start `y`. Within that distance a start that was moved off the
//! surface (`skin`) keeps its known sign.

use super::container::Held;
use super::{Ends, ImplicitKernel, Line8, LineExtent8, Segment8, Value8};
use crate::packet::closest::PacketQuery;
use crate::packet::convex::Hull;
use crate::packet::local_frame::{Own, dot, largest, on};
use crate::packet::quadric::Start;
use crate::packet::rays::{Nearest, RayLanes, SLACK};
use durer_math::scale::pow2;
use durer_math::{F8, Isa, M8, U, Vec3};

/// The most segments that are examined on one ray.
pub(super) const MOST: u32 = 160;
/// The most values that refine one crossing; every second one at least halves the bracket.
const MOST_VALUES: u32 = 24;
/// The next segment's length relative to one that was passed, and relative to one on which nothing
/// was certain.
const LONGER: f64 = 2.0;
const SHORTER: f64 = 0.3;
/// The lengths of the first and of the shortest segment, relative to the solid's reach.
const FIRST: f64 = 0.25;
const LEAST: f64 = pow2(-24);
/// A crossing's error relative to its parameter: a quarter of what pictures need.
const CLOSE: f64 = crate::PREVIEW_WIDTH / 8.0;
const NEVER: F8 = F8::splat(f64::INFINITY);

/// Working memory for eight rays and one solid.
#[derive(Debug)]
pub(super) struct ImplicitScratch {
    line: Line8,
    part: LineExtent8,
    held: Held,
    /// `t = t_c + s unit`, and a bound on its rounding.
    t_c: F8,
    unit: F8,
    e_t: F8,
    /// The current place on each ray, the end of its range, and the length of the next segment.
    here: F8,
    last: F8,
    step: F8,
    /// The sign at `here`: 1, -1, or 0 if it is unknown.
    sign: F8,
    /// How many segments were examined.
    looks: u32,
    /// Lanes that are active, that reached the end, that are stuck, and that need a value.
    open: M8,
    ended: M8,
    stuck: M8,
    asked: M8,
    /// Lanes with exactly one crossing between two places with opposite signs; these places, and
    /// the values there, multiplied by the sign of the first one.
    found: M8,
    a: F8,
    b: F8,
    g_a: F8,
    g_b: F8,
    told: Segment8,
    value: Value8,
}

impl Default for ImplicitScratch {
    fn default() -> Self {
        let (z, none, zero) = (F8::ZERO, M8::NONE, Vec3::splat(Vec3::ZERO));
        let told = Segment8 {
            lanes: none,
            seen: none,
            a: z,
            b: z,
            last: z,
            out: none,
            within: none,
            rises: none,
            falls: none,
            sign: z,
            hint: z,
            next: z,
        };
        Self {
            line: Line8 { isa: Isa::REFERENCE, o: zero, d: zero, e_o: z, e_d: z },
            part: LineExtent8 { from: z, to: z, unsure: none },
            held: Held::FREE,
            t_c: z,
            unit: z,
            e_t: z,
            here: z,
            last: z,
            step: z,
            sign: z,
            looks: 0,
            open: none,
            ended: none,
            stuck: none,
            asked: none,
            found: none,
            a: z,
            b: z,
            g_a: z,
            g_b: z,
            told,
            value: Value8 { g: z, above: none, below: none },
        }
    }
}

/// Prepares the rays. `cell` is the container's cell if the solid has a container; `turned` is
/// whether the surface is turned.
pub(super) fn prepare(
    level: &dyn ImplicitKernel,
    own: &Own,
    (asked, turned): (&PacketQuery<'_>, bool),
    (start, cell): (&Start, Option<&Hull>),
    nearest: &mut Nearest,
    memory: &mut ImplicitScratch,
) {
    let rays = asked.rays;
    memory.looks = 0;
    see(level.reach(), own, rays, start, memory);
    level.part(&memory.line, &mut memory.part);
    match cell {
        None => memory.held = Held::FREE,
        Some(cell) => {
            let ImplicitScratch { held, part, t_c, unit, .. } = &mut *memory;
            held.put(rays.isa, cell, level.ends(), (t_c, unit), part);
        }
    }
    begin((asked, turned), level.reach(), nearest, memory);
    if has_unknown(rays.isa, memory) {
        let line = Line8 { e_o: memory.line.e_o + memory.held.e_s, ..memory.line };
        level.values(&line, &memory.here, memory.asked, &mut memory.value);
        know(asked, nearest, memory);
    }
}

/// Examines one segment of each active ray.
#[inline(always)]
pub(super) fn look(level: &dyn ImplicitKernel, memory: &mut ImplicitScratch) {
    let isa = memory.line.isa;
    level.classify(&memory.line, &mut memory.told);
    if against(isa, memory) {
        level.values(&memory.line, &memory.told.b, memory.asked, &mut memory.value);
    }
    go_on(isa, level.reach(), memory);
    memory.looks += 1;
}

/// Passes the first crossing of each ray to `nearest`.
pub(super) fn conclude(
    level: &dyn ImplicitKernel,
    asked: &PacketQuery<'_>,
    nearest: &mut Nearest,
    memory: &mut ImplicitScratch,
) {
    end(asked, nearest, memory);
    if asked.any {
        take_roughly(asked, nearest, memory);
    }
    if memory.found.any() {
        close_in(level, asked, nearest, memory);
    }
}

/// Computes the rays in the solid's units.
#[inline(never)]
fn see(reach: f64, own: &Own, rays: &RayLanes<'_>, start: &Start, memory: &mut ImplicitScratch) {
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let (o, d) = (own.point(start.h), own.vector(*rays.direction));
            let (e_o, e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
            let unit = F8::ONE / dot(d, d).sqrt();
            let t_c = -dot(o, d) * unit * unit;
            let way = t_c.abs() * largest(d);
            let d8 = Vec3::new(d.x * unit, d.y * unit, d.z * unit);
            memory.line = Line8 {
                isa: rays.isa,
                o: on(o, t_c, d),
                d: d8,
                e_o: e_o + t_c.abs() * e_d + (largest(o) + way) * (4.0 * U),
                e_d: e_d * unit + 4.0 * U,
            };
            (memory.t_c, memory.unit) = (t_c, unit);
            memory.e_t = (t_c.abs() + unit * reach) * (8.0 * U);
        },
    );
}

/// Computes the range of each ray that is searched, and the sign at its start.
#[inline(never)]
fn begin(
    (asked, turned): (&PacketQuery<'_>, bool),
    reach: f64,
    nearest: &mut Nearest,
    memory: &mut ImplicitScratch,
) {
    let rays = asked.rays;
    rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch {
                part,
                held,
                t_c,
                unit,
                e_t,
                here,
                last,
                step,
                sign,
                open,
                ended,
                stuck,
                found,
                told,
                ..
            } = &mut *memory;
            let out = (t_c.abs() / *unit + reach) * (8.0 * U);
            let start = -*t_c / *unit - out;
            let within = start.gt(part.from);
            *here = within.select(start, part.from);
            *last = ((nearest.limit(rays) - *t_c) / *unit + out).min(part.to);
            // NaN stays open, and ends as a doubt.
            *open = *rays.live & !last.le(*here);
            let side = asked.from.map_or(
                F8::ZERO,
                #[inline(always)]
                |from| from.side(turned),
            );
            *sign = match held.ends {
                // Everything before the part is outside.
                Ends::Free => within.select(side, F8::ONE),
                // The side of a container's face does not determine the side of the solid's own
                // surface.
                Ends::Capped | Ends::Open => {
                    let own = asked.from.map_or(
                        M8::NONE,
                        #[inline(always)]
                        |from| from.face.equals(F8::ZERO),
                    );
                    (own & held.after.lt(F8::ZERO)).keep(side)
                }
            };
            let unsure = *open & part.unsure;
            if unsure.any() {
                nearest.doubt_from(unsure, here.mul_add(*unit, *t_c) - *e_t);
                *open &= !unsure;
            }
            (*found, *ended, *stuck) = (M8::NONE, M8::NONE, M8::NONE);
            *step = F8::splat(FIRST * reach);
            told.hint = NEVER;
            ask(*open, (*here, *last), *step, *sign, told);
        },
    );
}

/// Marks active rays with an unknown sign at the start, and returns whether there are any.
#[inline(never)]
fn has_unknown(isa: Isa, memory: &mut ImplicitScratch) -> bool {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            memory.asked = memory.open & memory.sign.equals(F8::ZERO);
            memory.asked.any()
        },
    )
}

/// Sets unknown signs from the values; without a certain sign the ray is a doubt. A ray that enters
/// the container where the sign is that of the inside hits the container's face.
#[inline(never)]
fn know(asked: &PacketQuery<'_>, nearest: &mut Nearest, memory: &mut ImplicitScratch) {
    asked.rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch { held, here, sign, open, t_c, unit, e_t, told, value, .. } = &mut *memory;
            let unknown = *open & sign.equals(F8::ZERO);
            let told_sign = value.above.keep(F8::ONE) - value.below.keep(F8::ONE);
            sign.set_where(unknown, told_sign);
            let unsure = unknown & sign.equals(F8::ZERO);
            if unsure.any() {
                nearest.doubt_from(unsure, here.mul_add(*unit, *t_c) - *e_t);
                *open &= !unsure;
            }
            // A ray that starts inside the container does not enter it.
            let covered = unknown & *open & sign.lt(F8::ZERO) & !held.after.lt(F8::ZERO);
            if held.ends == Ends::Capped && covered.any() {
                let (t, e) = (held.t_in, held.e_in);
                let sure = covered & held.enters & (t + e).le(*asked.rays.t_max);
                nearest.take(sure, t, e, asked.number, held.face_in + F8::ONE);
                nearest.doubt_from(covered & !sure, t - e);
                *open &= !covered;
            }
            (told.lanes, told.sign) = (*open, *sign);
        },
    );
}

impl ImplicitScratch {
    pub(super) fn isa(&self) -> Isa {
        self.line.isa
    }

    /// How many segments were examined.
    pub(super) fn looks(&self) -> u32 {
        self.looks
    }

    /// The active lanes.
    pub(super) fn open(&self) -> M8 {
        self.open
    }

    /// Stops a ray; from its current place on it is a doubt.
    pub(super) fn give_up(&mut self, lane: usize) {
        self.open.set_lane(lane, false);
        self.stuck.set_lane(lane, true);
    }

    /// Removes all rays.
    pub(super) fn clear(&mut self, isa: Isa) {
        self.line.isa = isa;
        (self.open, self.ended, self.stuck, self.found) = (M8::NONE, M8::NONE, M8::NONE, M8::NONE);
    }

    /// Copies ray `j` of `from` to lane `i` and continues it there.
    pub(super) fn take_over(&mut self, i: usize, from: &Self, j: usize) {
        let (to, line) = (&mut self.line, &from.line);
        to.o.set_lane(i, line.o.lane(j));
        to.d.set_lane(i, line.d.lane(j));
        (to.e_o.0[i], to.e_d.0[i]) = (line.e_o.0[j], line.e_d.0[j]);
        (self.here.0[i], self.last.0[i], self.step.0[i]) = (from.here.0[j], from.last.0[j], from.step.0[j]);
        (self.sign.0[i], self.told.hint.0[i]) = (from.sign.0[j], from.told.hint.0[j]);
        self.open.set_lane(i, true);
    }

    /// Copies the result of the finished ray `i` to lane `j` of `to`.
    pub(super) fn give_back(&mut self, i: usize, to: &mut Self, j: usize) {
        (to.here.0[j], to.a.0[j], to.b.0[j], to.g_b.0[j]) =
            (self.here.0[i], self.a.0[i], self.b.0[i], self.g_b.0[i]);
        to.open.set_lane(j, false);
        let bits = [
            (&mut self.found, &mut to.found),
            (&mut self.ended, &mut to.ended),
            (&mut self.stuck, &mut to.stuck),
        ];
        for (own, theirs) in bits {
            theirs.set_lane(j, own.lane(i));
            own.set_lane(i, false);
        }
    }

    /// Sets the next segments, also for rays that were taken over.
    #[inline(never)]
    pub(super) fn ask_all(&mut self) {
        let Self { line, here, last, step, sign, open, told, .. } = self;
        line.isa.run_in_lanes(
            #[inline(always)]
            || ask(*open, (*here, *last), *step, *sign, told),
        );
    }
}

/// Sets the next segments.
#[inline(always)]
fn ask(open: M8, (here, last): (F8, F8), step: F8, sign: F8, told: &mut Segment8) {
    (told.lanes, told.seen) = (open, M8::NONE);
    (told.a, told.b, told.last, told.sign) = (here, (here + step).min(last), last, sign);
    (told.out, told.within, told.rises, told.falls) = (M8::NONE, M8::NONE, M8::NONE, M8::NONE);
    told.next = NEVER;
}

/// Marks lanes where `g` moves towards zero, so that its sign at the segment's end is needed.
/// Returns whether there are any.
#[inline(never)]
fn against(isa: Isa, memory: &mut ImplicitScratch) -> bool {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let Segment8 { seen, out, within, rises, falls, .. } = memory.told;
            let positive = memory.sign.gt(F8::ZERO);
            memory.asked = seen & !(out | within) & (positive & falls | !positive & rises);
            memory.asked.any()
        },
    )
}

/// Updates the rays from the classification of their segments.
#[inline(never)]
fn go_on(isa: Isa, reach: f64, memory: &mut ImplicitScratch) {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch {
                here,
                last,
                step,
                sign,
                open,
                ended,
                stuck,
                found,
                a,
                b,
                g_b,
                told,
                value,
                ..
            } = &mut *memory;
            let positive = sign.gt(F8::ZERO);
            let seen = told.seen & *open;
            let kept = positive & (told.out | told.rises) | !positive & (told.within | told.falls);
            let against = !kept & (positive & told.falls | !positive & told.rises);
            let same = against & (positive & value.above | !positive & value.below);
            let crossed = seen & against & (positive & value.below | !positive & value.above);
            a.set_where(crossed, told.a);
            b.set_where(crossed, told.b);
            g_b.set_where(crossed, value.g * *sign);
            *found |= crossed;
            let passed = seen & (kept | same);
            let way = told.b - told.a;
            let next = passed.select(step.max(way * LONGER), way * SHORTER);
            step.set_where(seen, next);
            here.set_where(seen, passed.select(told.b, told.a));
            told.hint.set_where(passed, told.next);
            let short = *open & !crossed & here.lt(*last) & !step.ge(F8::splat(LEAST * reach));
            *stuck |= short;
            *ended |= *open & !(crossed | short) & !here.lt(*last);
            *open &= !(crossed | short) & here.lt(*last);
            ask(*open, (*here, *last), *step, *sign, told);
        },
    );
}

/// Records doubts, and hits where rays leave the container.
#[inline(never)]
fn end(asked: &PacketQuery<'_>, nearest: &mut Nearest, memory: &mut ImplicitScratch) {
    asked.rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch { part, held, here, sign, open, ended, stuck, t_c, unit, e_t, .. } = &*memory;
            // NaN is not the end.
            let unsure = *stuck | *open | *ended & !here.ge(memory.last);
            if unsure.any() {
                nearest.doubt_from(unsure, here.mul_add(*unit, *t_c) - *e_t);
            }
            // A ray that is inside up to the end hits the container's face where it leaves it.
            let left = *ended & !sign.gt(F8::ZERO) & here.ge(memory.last);
            let left = left & !held.before.gt(nearest.limit(asked.rays));
            if held.ends == Ends::Capped && left.any() {
                let (t, e) = (held.t_out, held.e_out);
                let ahead = (t - e).gt(F8::ZERO) & (t + e).le(*asked.rays.t_max);
                let sure = left & here.ge(part.to) & held.leaves & ahead;
                nearest.take(sure, t, e, asked.number, held.face_out + F8::ONE);
                nearest.doubt_from(left & !sure, t - e);
            }
        },
    );
}

/// Passes crossings to `nearest` without refinement, for queries that do not need their place; the
/// signs on either side are certain.
#[inline(never)]
fn take_roughly(asked: &PacketQuery<'_>, nearest: &mut Nearest, memory: &mut ImplicitScratch) {
    asked.rays.isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch { held, found, a, b, t_c, unit, e_t, .. } = &mut *memory;
            let t = ((*a + *b) * 0.5).mul_add(*unit, *t_c);
            let e = ((*b - *a) * 0.5 * *unit + *e_t) * SLACK;
            let (first, last) = (t - e, t + e);
            let ahead = first.gt(F8::ZERO) & last.le(*asked.rays.t_max);
            let met = *found & ahead & first.gt(held.after) & last.lt(held.before);
            nearest.take(met, t, e, asked.number, F8::ZERO);
            *found &= !met;
        },
    );
}

/// Refines the crossings that were found, proves them, and passes them to `nearest`.
#[inline(never)]
fn close_in(
    level: &dyn ImplicitKernel,
    asked: &PacketQuery<'_>,
    nearest: &mut Nearest,
    memory: &mut ImplicitScratch,
) {
    let rays = asked.rays;
    let isa = rays.isa;
    level.about(&memory.line, &memory.a, memory.found, &mut memory.value.g);
    let (mut x, mut done, mut stayed) = (F8::ZERO, M8::NONE, F8::ZERO);
    isa.run_in_lanes(
        #[inline(always)]
        || {
            memory.g_a = memory.value.g * memory.sign;
            x = next(memory, 0);
            done = !memory.found;
            memory.asked = memory.found;
        },
    );
    for near in [64.0, 0.25] {
        converge(level, near, (&mut x, &mut done, &mut stayed), memory);
        prove(level, asked, &x, nearest, memory);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                memory.asked = memory.found;
                done = !memory.found;
            },
        );
    }
    nearest.doubt_from(memory.found, memory.here.mul_add(memory.unit, memory.t_c) - memory.e_t);
}

/// Steps towards the crossings until the last step was at most `near` times `close`.
#[inline(never)]
fn converge(
    level: &dyn ImplicitKernel,
    near: f64,
    (x, done, stayed): (&mut F8, &mut M8, &mut F8),
    memory: &mut ImplicitScratch,
) {
    let isa = memory.line.isa;
    for i in 1..MOST_VALUES {
        if !memory.asked.any() {
            return;
        }
        level.about(&memory.line, x, memory.asked, &mut memory.value.g);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let ImplicitScratch { a, b, g_a, g_b, sign, value, .. } = &mut *memory;
                let g = value.g * *sign;
                let (before, beyond) = (g.gt(F8::ZERO), g.lt(F8::ZERO));
                let known = before | beyond;
                let moving = !*done & known;
                let (first, second) = (moving & before, moving & !before);
                // An end that stays a second time gets less weight (N. Anderson, A. Bjorck, 1973).
                let share = F8::ONE - g / before.select(*g_a, *g_b);
                let share = share.gt(F8::ZERO).select(share, F8::splat(0.5));
                g_b.set_where(first & stayed.gt(F8::ZERO), *g_b * share);
                g_a.set_where(second & stayed.lt(F8::ZERO), *g_a * share);
                *stayed = before.select(F8::ONE, -F8::ONE);
                a.set_where(first, *x);
                g_a.set_where(first, g);
                b.set_where(second, *x);
                g_b.set_where(second, g);
                let to = next(memory, i);
                let moved = (to - *x).abs();
                let moved = moved * memory.unit;
                *done |= moved.le(close(memory, to) * near) | !known;
                x.set_where(moving, to);
                memory.asked = !*done;
            },
        );
    }
}

/// The precision that is wanted at `x`, in the ray's parameter.
#[inline(always)]
fn close(memory: &ImplicitScratch, x: F8) -> F8 {
    x.mul_add(memory.unit, memory.t_c).abs() * CLOSE
}

/// The next place to evaluate: the zero of the chord, and every eighth time the middle.
#[inline(always)]
fn next(memory: &ImplicitScratch, turn: u32) -> F8 {
    let ImplicitScratch { a, b, g_a, g_b, .. } = memory;
    let chord = *a + (*b - *a) * (*g_a / (*g_a - *g_b));
    let between = chord.gt(*a) & chord.lt(*b);
    let middle = *a * 0.5 + *b * 0.5;
    if turn % 8 == 7 { middle } else { between.select(chord, middle) }
}

/// Passes crossings with certain signs on either side to `nearest`.
#[inline(never)]
fn prove(
    level: &dyn ImplicitKernel,
    asked: &PacketQuery<'_>,
    x: &F8,
    nearest: &mut Nearest,
    memory: &mut ImplicitScratch,
) {
    if !memory.found.any() {
        return;
    }
    let rays = asked.rays;
    let isa = rays.isa;
    let (mut low, mut high, mut width, mut sure) = (F8::ZERO, F8::ZERO, F8::ZERO, M8::NONE);
    isa.run_in_lanes(
        #[inline(always)]
        || {
            width = close(memory, *x);
            let way = width / memory.unit;
            (low, high) = (*x - way, *x + way);
        },
    );
    level.values(&memory.line, &low, memory.found, &mut memory.value);
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let positive = memory.sign.gt(F8::ZERO);
            sure = positive & memory.value.above | !positive & memory.value.below;
        },
    );
    level.values(&memory.line, &high, memory.found, &mut memory.value);
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let ImplicitScratch { held, sign, found, value, unit, t_c, e_t, .. } = &mut *memory;
            let positive = sign.gt(F8::ZERO);
            let t = x.mul_add(*unit, *t_c);
            let e = (width + *e_t) * SLACK;
            let within = (t - e).gt(held.after) & (t + e).lt(held.before);
            let sure = *found & sure & within & (positive & value.below | !positive & value.above);
            let open = *found & !(t - e).gt(nearest.limit(rays));
            let met = open & sure & (t - e).gt(F8::ZERO) & (t + e).le(*rays.t_max);
            nearest.take(met, t, e, asked.number, F8::ZERO);
            *found &= !(met | sure & (t - e).gt(nearest.limit(rays)));
        },
    );
}
