//! Convex superellipsoids in packets of eight rays.
//!
//! Each of eight rays is sampled at two parameters, `a` and `r` behind it (see `mod.rs` for why
//! that suffices):
//!
//! ```text
//!   outside, and g rises at a              it is outside from there on
//!   g(r) < 1, or g falls at r              at most one crossing between them
//!   g falls at a and rises at r            outside from a on, if the tangents meet above 1; else r moves to where they meet
//!   inside                                 at most one crossing ahead
//! ```

use super::Gauge;
use super::gauge::{Factors, REST, Sample, VALUE};
use crate::packet::{ImplicitKernel, Line8, LineExtent8, Segment8, Skin, Slant, Value8};
use durer_math::scale::pow2;
use durer_math::{F8, Isa, M8, U, Vec3};

/// A ball enlarged by this holds the solid with a margin for all rounding, for a line with errors
/// below [`KNOWN`].
const ROOM: f64 = 1.0 / 64.0;
/// The largest error of a line's points with which it is classified.
const KNOWN: f64 = pow2(-12);
const NEVER: F8 = F8::splat(f64::INFINITY);

/// The gauge and its slope at a point of each line.
#[derive(Clone, Copy)]
struct Node8 {
    g: F8,
    slope: F8,
}

/// The errors of a sample and of a point of a line, as values of the gauge: for a vector at most
/// the sum of its components' magnitudes.
#[inline(always)]
fn off(line: &Line8, far: F8) -> F8 {
    line.error(far) * (3.0 * (1.0 + 1.0 / 1024.0)) + REST
}

impl Gauge {
    #[inline(always)]
    fn node(&self, line: &Line8, s: &F8, sample: &mut Sample) -> Node8 {
        let mut p = Vec3::splat(Vec3::ZERO);
        line.isa.run_in_lanes(
            #[inline(always)]
            || p = line.point(*s),
        );
        self.sample(line.isa, &p, sample);
        let mut slope = F8::ZERO;
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (n, d) = (&sample.gradient, &line.d);
                slope = n.x * d.x + n.y * d.y + n.z * d.z;
            },
        );
        Node8 { g: sample.value, slope }
    }
}

impl ImplicitKernel for Gauge {
    fn reach(&self) -> f64 {
        self.reach * (1.0 + ROOM)
    }

    fn part(&self, line: &Line8, part: &mut LineExtent8) {
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let o = line.o;
                let radius = self.reach * (1.0 + 0.5 * ROOM);
                let room = F8::splat(radius * radius) - o.x.mul_add(o.x, o.y.mul_add(o.y, o.z * o.z));
                let half = room.max(F8::ZERO).sqrt();
                let far = F8::splat(2.0 * self.reach);
                part.unsure = !off(line, far).lt(F8::splat(KNOWN));
                // Of a line that is known badly the doubt begins before all of the solid.
                part.from = part.unsure.select(-far, -half);
                part.to = part.unsure.select(far, room.gt(F8::ZERO).select(half, -half - F8::ONE));
            },
        );
    }

    fn classify(&self, line: &Line8, told: &mut Segment8) {
        let mut sample = Sample::new();
        let (mut r, mut first) = (F8::ZERO, M8::NONE);
        let any = line.isa.run_in_lanes(
            #[inline(always)]
            || {
                // Inside there is one crossing ahead at most, on all of the rest.
                let within = told.lanes & told.sign.lt(F8::ZERO);
                (told.seen, told.rises) = (within, within);
                first = told.lanes & !within;
                let behind = told.hint.lt(told.last) & told.hint.gt(told.a);
                // Where it is closest to the centre it is mostly about as deep as it ever is.
                let middle = told.a.lt(F8::splat(-pow2(-10))) & told.last.gt(F8::ZERO);
                r = behind.select(told.hint, middle.select(F8::ZERO, told.last));
                told.b = first.select(r, told.last);
                first.any()
            },
        );
        if !any {
            return;
        }
        let a = self.node(line, &told.a, &mut sample);
        let b = self.node(line, &r, &mut sample);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let off = off(line, told.a.abs().max(told.last.abs()));
                let noise = off + VALUE * (1.0 + 1.0 / 512.0);
                let sure = F8::splat(8.0 * self.turn);
                let rises = first & a.slope.gt(sure);
                let inside = (F8::ONE - b.g).gt(noise);
                let falls = first & !rises & (inside | b.slope.lt(-sure));
                let both = first & !(rises | falls) & a.slope.lt(-sure) & b.slope.gt(sure);
                // As for single rays (`crossings.rs`).
                let length = r - told.a;
                let weight = b.slope / (b.slope - a.slope);
                let least = weight * (a.g + a.slope * length) + (F8::ONE - weight) * b.g;
                let slack = sure * length + noise + off * 2.0 + (a.g + b.g) * VALUE;
                let misses = both & (least - 1.0).gt(slack);
                let over = told.a + (b.g - a.g - b.slope * length) / (a.slope - b.slope);
                let narrowed =
                    both & !misses & over.gt(told.a) & over.lt(r) & length.gt(F8::splat(pow2(-30)));
                told.rises |= rises;
                told.out |= misses;
                told.falls |= falls;
                told.b = (rises | misses).select(told.last, told.b);
                told.hint = narrowed.select(over, NEVER);
                // The rest can only be tried again in shorter intervals.
                told.seen |= first & !narrowed;
            },
        );
    }

    fn values(&self, line: &Line8, s: &F8, _lanes: M8, value: &mut Value8) {
        let mut sample = Sample::new();
        let node = self.node(line, s, &mut sample);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let noise =
                    off(line, s.abs()) + (node.g + 1.0 / 512.0).max(F8::ONE) * (VALUE * (1.0 + 1.0 / 512.0));
                value.g = node.g - 1.0;
                value.above = value.g.gt(noise);
                value.below = value.g.lt(-noise);
            },
        );
    }

    fn about(&self, line: &Line8, s: &F8, _lanes: M8, g: &mut F8) {
        let mut sample = Sample::new();
        let node = self.node(line, s, &mut sample);
        line.isa.run_in_lanes(
            #[inline(always)]
            || *g = node.g - 1.0,
        );
    }

    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        let mut sample = Sample::new();
        self.sample(isa, y, &mut sample);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let g = &sample.gradient;
                *slant = Slant { f: sample.value - 1.0, half: Vec3::new(g.x * 0.5, g.y * 0.5, g.z * 0.5) };
            },
        );
    }

    /// Each factor of the gradient's parts goes one way with each coordinate: the corners of a box
    /// have its extremes (`foot.rs`).
    fn skin(&self, isa: Isa, (y, e): (&Vec3<F8>, &F8), skin: &mut Skin) {
        let mut sample = Sample::new();
        self.sample(isa, y, &mut sample);
        let mut corners = [Vec3::splat(Vec3::ZERO); 4];
        let mut flat = [M8::NONE; 3];
        isa.run_in_lanes(
            #[inline(always)]
            || {
                skin.room = *e * 64.0 + 8192.0 * U;
                let r = skin.room + *e + 8.0 * U;
                let size = y.map(F8::abs);
                let less = size.map(|x| (x - r).max(F8::ZERO));
                let more = size.map(|x| x + r);
                flat = [less.x, less.y, less.z].map(|x| x.equals(F8::ZERO));
                corners = [
                    Vec3::new(more.x, less.y, size.z),
                    Vec3::new(less.x, more.y, size.z),
                    Vec3::new(more.x, more.y, less.z),
                    Vec3::new(less.x, less.y, more.z),
                ];
            },
        );
        let mut factors = [Factors::new(), Factors::new(), Factors::new(), Factors::new()];
        for (corner, factors) in corners.iter().zip(&mut factors) {
            self.factors(isa, corner, factors);
        }
        let [c0, c1, c2, c3] = &factors;
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (up, down) = (1.0 + 2.0 * self.turn, 1.0 - 2.0 * self.turn);
                let part = |least: F8, most: F8, y: F8, flat: M8| {
                    let (least, most) = (flat.select(most * -up, least * down), most * up);
                    (((least + most) * 0.25).copysign(y), (most - least) * 0.25)
                };
                // Where a coordinate may have either sign its part is zero in the middle.
                let (x, e_x) = part(c1.x * c3.outer, c0.x * c2.outer, y.x, flat[0]);
                let (v, e_v) = part(c0.y * c3.outer, c1.y * c2.outer, y.y, flat[1]);
                let (z, e_z) = part(c2.z, c3.z, y.z, flat[2]);
                skin.half = Vec3::new(x, v, z);
                skin.e_half =
                    (e_x.max(e_v).max(e_z) + crate::packet::largest(skin.half) * (8.0 * U)) * (1.0 + 8.0 * U);
                skin.f = sample.value - 1.0;
                skin.e_f = *e * (3.0 * (1.0 + 8.0 * U)) + (REST + VALUE * (1.0 + 1.0 / 64.0));
                skin.bend = F8::ZERO;
            },
        );
    }
}
