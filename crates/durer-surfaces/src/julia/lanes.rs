//! Packets of rays against Julia sets whose escaped orbits never return: `g = |z_N|² - R²`.
//!
//! **Far from the set** a point gives a lower bound on its distance to the set (J. C. Hart, D. J.
//! Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH 1989, call it an
//! unbounding sphere; theirs is an estimate). If no point within `ρ` of `z_(n+1)` is inside, then
//! none within
//!
//! ```text
//!   2 |z_n| ρ' + ρ'² = ρ - e,    ρ' = (ρ - e) / (|z_n| + √(|z_n|² + ρ - e))
//! ```
//!
//! of `z_n` is. As `√x <= (x + m²) / 2m` for any `m > 0`, none is within
//! `2 m (ρ - e) / (2 m |z_n| + |z_n|² + m² + ρ - e)` either, which needs no root once the next
//! point's `ρ` is known; `m` is `|z_n|` or 1/2. The rounding of the next point is included:
//! `e = 10 U (|z_n|² + |c|)`, as for balls (`orbit.rs`). Nor is any point inside within
//! `|z_n| - R`. The steps forward and back cost half as much as balls along a stretch, and no
//! length has to be guessed. Cubes have `3 |z_n|² ρ' + 3 |z_n| ρ'² + ρ'³`, for which
//! `ρ' = (ρ - e) / (3 (|z_n| + m)²)` is at most the root for any `m` not less than this `ρ'`: for
//! `(ρ - e) / 3 |z_n|²`, and for the larger of 1 and `ρ - e`. Each of the two numbers of a
//! hypercomplex one may move by `ρ`, which moves the root of their mean square by no more; the
//! longer one is used on the way back.
//!
//! **Near the set** balls around the orbits of eight stretches decide, as for the eight stretches
//! of a single ray. How near, and how long the stretches are at first, depends on the orbit's
//! derivative. After a stretch without a crossing the next one is longer by three tenths, and
//! distances are not computed until the stretches are long, or lead away from the set. The factors
//! were found by experiment.

use super::embed::Lift;
use super::orbit::{Ball, Rule, TINY};
use super::{JuliaPower, Solid};
use crate::packet::{
    FilterSource, ImplicitKernel, Line8, LineExtent8, Segment8, Segments, Skin, Slant, Value8,
};
use durer_math::scale::pow2;
use durer_math::{Aabb, F8, Isa, M8, Point3, U, Vec3};
use std::sync::Arc;

/// Below this distance from the set, in units of the factor from lengths of the orbit to those in
/// space, lines are examined in stretches.
const NEAR: f64 = 4.0;
/// The length of the first stretch, in the same units.
const STRETCH: f64 = 6.0;
/// The factor from one stretch to the next.
const LONGER: f64 = 1.3;
/// The greatest length of a stretch. After a stretch of half this length a point's distance bound
/// is computed.
const LONGEST: f64 = 2.0;
/// Stretches at least this long are computed in f32, whose rounding is small compared with the
/// uncertainty of such a long stretch.
const COARSE: f64 = pow2(-13);
/// An orbit beyond this has certainly escaped.
const GONE: f64 = pow2(40);
/// The number of iterations whose points are stored.
const MOST: usize = 32;
/// Bounds of second derivatives hold up to this distance from a point.
const AROUND: f64 = pow2(-30);

impl<const M: usize, const C: usize> Solid<M, C> {
    /// The packet filter, if the set has one.
    pub(super) fn packet_filter(&self, bounds: Aabb) -> FilterSource {
        let Rule { escapes, iterations, radius, .. } = self.rule;
        let seen = escapes && (iterations as usize) < MOST && radius > 1.0 && 4.0 * radius * radius < GONE;
        if seen {
            FilterSource::kernel(bounds, Segments(Arc::new(self.clone())), Point3::ORIGIN, 0, [0, 1, 2])
        } else {
            FilterSource::vague(bounds)
        }
    }

    /// Balls around points of lines.
    #[inline(always)]
    fn balls(&self, line: &Line8, s: F8, half: F8) -> [Ball<f64, C>; M] {
        let p = line.point(s);
        let far = s.abs() + half;
        let q = self.lift.at8(p);
        let v = self.lift.turned8(Vec3::new(line.d.x * half, line.d.y * half, line.d.z * half));
        let size = sum(line.o) + far * 2.0;
        let e = far.mul_add(line.e_d, line.e_o) + size * (4.0 * U);
        let r = self.lift.errors(size, e) + TINY;
        let d = half * self.lift.errors_of_way(2.0, line.e_d) + TINY;
        let mut balls = [Ball::new(&q[0], &v[0], r, d); M];
        for ((ball, q), v) in balls.iter_mut().zip(q).zip(v).skip(1) {
            *ball = Ball::new(&q, &v, r, d);
        }
        balls
    }

    /// Lower bounds of the distance from points of lines to the set, along the lines; and the
    /// factor from lengths of the orbit to those in space.
    #[inline(never)]
    fn clearance(&self, line: &Line8, s: &F8, room: &mut F8, stretch: &mut F8) {
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let count = self.rule.iterations as usize;
                let balls = self.balls(line, *s, F8::ZERO);
                let r = F8(balls[0].r.0);
                let mut z = points(&balls);
                let mut squares = [[F8::ZERO; M]; MOST];
                for squares in &mut squares[..count] {
                    *squares = self.forward(&mut z);
                }
                let over = self.rule.radius * (1.0 + 16.0 * U);
                let size = mean(&squared(&z)).sqrt() * (1.0 - 16.0 * U);
                let mut free = (size - over).max(F8::ZERO);
                let mut slope = [F8::ONE; M];
                for squares in squares[..count].iter().rev() {
                    self.back(squares, over, &mut free, &mut slope);
                }
                let speed = most(&squared(&self.lift.turned8(line.d))).sqrt() * (1.0 + 16.0 * U)
                    + self.lift.errors_of_way(2.0, line.e_d);
                *room = ((free - r) / speed * (1.0 - 16.0 * U)).max(F8::ZERO);
                *stretch = F8::ONE / most(&slope);
            },
        );
    }

    /// The next points of orbits, and their `|z|²`. Escaped points stay where they are, so that
    /// nothing overflows.
    #[inline(always)]
    fn forward(&self, z: &mut [[F8; C]; M]) -> [F8; M] {
        let (mut rests, mut squares) = ([F8::ZERO; M], [F8::ZERO; M]);
        for ((rest, square), q) in rests.iter_mut().zip(&mut squares).zip(&*z) {
            *rest = beside(q);
            *square = q[0].mul_add(q[0], *rest);
        }
        let goes_on = mean(&squares).le(F8::splat(GONE));
        for ((q, c), rest) in z.iter_mut().zip(&self.rule.c).zip(rests) {
            let x = q[0];
            let (real, factor) = match self.rule.power {
                JuliaPower::Square => (x * x - rest, x * 2.0),
                JuliaPower::Cube => (x * (x * x - rest * 3.0), x * x * 3.0 - rest),
            };
            q[0].set_where(goes_on, real + c[0]);
            for (q, c) in q.iter_mut().zip(c).skip(1) {
                q.set_where(goes_on, factor.mul_add(*q, F8::splat(*c)));
            }
        }
        squares
    }

    /// Converts a ball around the next point that contains no point of the set to one around this
    /// point; and updates the orbit's stretching from here, as long as the orbit is near.
    #[inline(always)]
    fn back(&self, squares: &[F8; M], over: f64, free: &mut F8, slope: &mut [F8; M]) {
        let rule = &self.rule;
        let mean = mean(squares);
        let own = mean.sqrt() * (1.0 - 16.0 * U) - over;
        let square = most(squares);
        let size = square.sqrt();
        let back = match rule.power {
            JuliaPower::Square => {
                let e = (square + rule.c_size) * (16.0 * U) + rule.c_err;
                let left = (*free - e).max(F8::ZERO);
                // `√x <= (x + m²) / 2m` for any `m`; what does not depend on `left` is computed
                // before it.
                let twice = size.max(F8::splat(0.5)) * 2.0;
                let rest = twice.mul_add(size, twice.mul_add(twice * 0.25, square));
                twice * left / (rest + left)
            }
            JuliaPower::Cube => {
                let e = (square * size + rule.c_size) * (64.0 * U) + rule.c_err;
                let left = (*free - e).max(F8::ZERO);
                let far = size + left.max(F8::ONE).min(left / (square * 3.0));
                left / (far * far * 3.0 + TINY)
            }
        };
        *free = own.max(back * (1.0 - 16.0 * U));
        let near = mean.lt(F8::splat(2.0 * rule.radius * rule.radius));
        for (slope, square) in slope.iter_mut().zip(squares) {
            let by = match rule.power {
                JuliaPower::Square => square.sqrt() * 2.0,
                JuliaPower::Cube => *square * 3.0,
            };
            *slope = near.select(*slope * by, F8::ONE);
        }
    }

    /// `|z_N|²`, the last points and the balls around them; escaped points are anywhere far out.
    #[inline(always)]
    fn last(&self, balls: &mut [Ball<f64, C>; M]) -> F8 {
        let Rule { power, c_err, c_size, .. } = self.rule;
        let mut gone = M8::NONE;
        let mut square = F8::ZERO;
        for n in 0..=self.rule.iterations {
            let now = mean(&squared(&points(balls)));
            let r = widest(balls);
            square = gone.select(square, now);
            gone |= now.gt(F8::splat(GONE)) & (r * r * 4.0).lt(now);
            if n == self.rule.iterations {
                break;
            }
            for (ball, c) in balls.iter_mut().zip(&self.rule.c) {
                ball.step(c, power, c_err, c_size);
                if gone.any() {
                    // Its place no longer matters, and must not overflow.
                    for q in &mut ball.q {
                        q.0 = gone.select(F8::ZERO, F8(q.0)).0;
                    }
                    ball.r.0 = gone.select(F8::ZERO, F8(ball.r.0)).0;
                }
            }
        }
        square
    }
}

/// `|z|²` of each number.
#[inline(always)]
fn squared<const M: usize, const C: usize>(z: &[[F8; C]; M]) -> [F8; M] {
    let mut squares = [F8::ZERO; M];
    for (square, q) in squares.iter_mut().zip(z) {
        *square = q[0].mul_add(q[0], beside(q));
    }
    squares
}

/// `|z|²` without the real part.
#[inline(always)]
fn beside<const C: usize>(q: &[F8; C]) -> F8 {
    let mut square = q[C - 1] * q[C - 1];
    for q in q[1..C - 1].iter().rev() {
        square = q.mul_add(*q, square);
    }
    square
}

#[inline(always)]
fn rounded<const M: usize, const C: usize>(balls: &[Ball<f64, C>; M]) -> [Ball<f32, C>; M] {
    let mut less = [balls[0].rounded(); M];
    for (less, ball) in less.iter_mut().zip(balls).skip(1) {
        *less = ball.rounded();
    }
    less
}

#[inline(always)]
fn points<const M: usize, const C: usize>(balls: &[Ball<f64, C>; M]) -> [[F8; C]; M] {
    let mut z = [[F8::ZERO; C]; M];
    for (z, ball) in z.iter_mut().zip(balls) {
        *z = ball.points();
    }
    z
}

/// The mean of `M` numbers, which is one of them or half the sum of two.
#[inline(always)]
fn mean<const M: usize>(x: &[F8; M]) -> F8 {
    let mut sum = x[0];
    for x in &x[1..] {
        sum += *x;
    }
    if M == 1 { sum } else { sum * (1.0 / M as f64) }
}

#[inline(always)]
fn most<const M: usize>(x: &[F8; M]) -> F8 {
    let mut most = x[0];
    for x in &x[1..] {
        most = most.max(*x);
    }
    most
}

#[inline(always)]
fn widest<const M: usize, const C: usize>(balls: &[Ball<f64, C>; M]) -> F8 {
    let mut r = F8(balls[0].r.0);
    for ball in &balls[1..] {
        r = r.max(F8(ball.r.0));
    }
    r
}

#[inline(always)]
fn sum(v: Vec3<F8>) -> F8 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

impl<const M: usize, const C: usize> ImplicitKernel for Solid<M, C> {
    fn reach(&self) -> f64 {
        self.radius
    }

    fn part(&self, line: &Line8, part: &mut LineExtent8) {
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let o = line.o;
                let away = o.x.mul_add(o.x, o.y.mul_add(o.y, o.z * o.z));
                // The solid lies well within this: half of the margin of its ball.
                let radius = self.radius - 0.5 * super::ROOM;
                let room = F8::splat(radius * radius) - away;
                // The direction has length 1, up to its rounding.
                let half = room.max(F8::ZERO).sqrt();
                let far = F8::splat(2.0 * self.radius);
                part.unsure = !line.error(far).lt(F8::splat(super::ROOM / 64.0));
                // A line with a large error bound is uncertain from in front of the solid.
                part.from = part.unsure.select(-far, -half);
                part.to = part.unsure.select(far, room.gt(F8::ZERO).select(half, -half - F8::ONE));
            },
        );
    }

    fn classify(&self, line: &Line8, told: &mut Segment8) {
        let mut far = M8::NONE;
        let is_far = line.isa.run_in_lanes(
            #[inline(always)]
            || {
                far = told.lanes & told.sign.gt(F8::ZERO) & told.hint.equals(F8::splat(f64::INFINITY));
                far.any()
            },
        );
        if is_far {
            let (mut room, mut stretch) = (F8::ZERO, F8::ZERO);
            self.clearance(line, &told.a, &mut room, &mut stretch);
            line.isa.run_in_lanes(
                #[inline(always)]
                || {
                    told.seen = far & room.gt(stretch.min(F8::ONE) * NEAR);
                    told.out = told.seen;
                    told.b.set_where(told.seen, told.a + room);
                    told.hint.set_where(far, stretch * STRETCH);
                },
            );
            return;
        }
        told.seen = told.lanes;
        let known = line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let reach = told.a + told.hint.min(F8::splat(LONGEST));
                told.b.set_where(reach.lt(told.b), reach);
                let mid = (told.a + told.b) * 0.5;
                let half = (told.b - told.a) * (0.5 * (1.0 + 4.0 * U)) + mid.abs() * (2.0 * U);
                let mut balls = self.balls(line, mid, half);
                // Inactive lanes must not delay the others.
                for ball in &mut balls {
                    ball.q[0].0 = told.lanes.select(F8(ball.q[0].0), F8::splat(4.0 * self.rule.radius)).0;
                }
                // For points far apart f32 suffices.
                let is_fine = (told.lanes & (told.b - told.a).lt(F8::splat(COARSE))).any();
                if is_fine { self.rule.known(balls) } else { self.coarse.known(rounded(&balls)) }
            },
        );
        (told.out, told.within) = (known.out, known.within);
        (told.rises, told.falls) = (known.rises, known.falls);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let way = told.b - told.a;
                let goes_on = !told.rises & way.lt(F8::splat(0.5 * LONGEST));
                told.next.set_where(goes_on, way * LONGER);
            },
        );
    }

    fn values(&self, line: &Line8, s: &F8, _lanes: M8, value: &mut Value8) {
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let mut balls = self.balls(line, *s, F8::ZERO);
                let square = self.last(&mut balls);
                let r = widest(&balls);
                let level = self.rule.radius * self.rule.radius;
                let size = square.sqrt();
                let e = (size * 2.0 + r) * r + (square + level) * (32.0 * U);
                let g = square - level;
                // A value with the same sign, but less steep far out.
                value.g = g / (square + level);
                (value.above, value.below) = (g.gt(e), g.lt(-e));
            },
        );
    }

    fn about(&self, line: &Line8, s: &F8, _lanes: M8, g: &mut F8) {
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let mut z = self.lift.at8(line.point(*s));
                for _ in 0..self.rule.iterations {
                    self.forward(&mut z);
                }
                let square = mean(&squared(&z));
                let level = self.rule.radius * self.rule.radius;
                *g = (square - level) / (square + level);
            },
        );
    }

    fn skin(&self, isa: Isa, (y, e): (&Vec3<F8>, &F8), skin: &mut Skin) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let gradient = gradient8(&self.rule, &self.lift, self.rule.iterations, y, e);
                let Gradient { square, e_square, half, e_half, bend } = gradient;
                let level = self.rule.radius * self.rule.radius;
                skin.f = square - level;
                skin.e_f = e_square + (square + level) * (32.0 * U);
                (skin.half, skin.e_half, skin.bend) = (half, e_half, bend);
                skin.room = F8::splat(AROUND);
            },
        );
    }

    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                // Only the requested data are computed.
                let gradient = gradient8(&self.rule, &self.lift, self.rule.iterations, y, &F8::ZERO);
                let Gradient { square, half, .. } = gradient;
                *slant = Slant { f: square - self.rule.radius * self.rule.radius, half };
            },
        );
    }

    /// The surface that one more iteration would give, at the same point: see `point.rs`.
    fn shading(&self, isa: Isa, y: &Vec3<F8>, g: &mut Vec3<F8>) -> bool {
        isa.run_in_lanes(
            #[inline(always)]
            || *g = gradient8(&self.rule, &self.lift, self.rule.iterations + 1, y, &F8::ZERO).half,
        );
        true
    }
}

/// `|z_N|²`, half its gradient by the point, and their errors.
struct Gradient {
    square: F8,
    /// The error from the balls around the last points.
    e_square: F8,
    half: Vec3<F8>,
    e_half: F8,
    bend: F8,
}

/// At points known within `e` along each axis: means over the numbers.
#[inline(always)]
fn gradient8<const M: usize, const C: usize>(
    rule: &Rule<f64, M, C>,
    lift: &Lift<M, C>,
    iterations: u32,
    y: &Vec3<F8>,
    e: &F8,
) -> Gradient {
    let r = lift.errors(sum(*y), *e) + TINY;
    let (q, axes) = (lift.at8(*y), lift.axes8());
    let mut all = gradient_of(rule, lift, iterations, (&q[0], &axes[0], r), &rule.c[0]);
    for ((q, axes), c) in q.iter().zip(&axes).zip(&rule.c).skip(1) {
        let one = gradient_of(rule, lift, iterations, (q, axes, r), c);
        all.square += one.square;
        all.e_square += one.e_square;
        all.half = Vec3::new(all.half.x + one.half.x, all.half.y + one.half.y, all.half.z + one.half.z);
        (all.e_half, all.bend) = (all.e_half + one.e_half, all.bend + one.bend);
    }
    if M > 1 {
        let share = 1.0 / M as f64;
        let slack = share * (1.0 + 4.0 * U);
        all.square = all.square * share;
        all.half = Vec3::new(all.half.x * share, all.half.y * share, all.half.z * share);
        let size = sum(all.half) * (4.0 * U);
        (all.e_square, all.e_half) = (all.e_square * slack, all.e_half * slack + size);
        all.bend = all.bend * slack;
    }
    all
}

/// The gradient of one number, whose start is known within `r`. `|t|` is the size of the largest
/// tangent, `d` a bound on the error of each, like `v` and `d` for stretches (`orbit.rs`); `slope`
/// and `curve` bound the first and second derivatives of the last point up to `AROUND` from the
/// point.
#[inline(always)]
fn gradient_of<const M: usize, const C: usize>(
    rule: &Rule<f64, M, C>,
    lift: &Lift<M, C>,
    iterations: u32,
    (q, axes, r): (&[F8; C], &[[F8; C]; 3], F8),
    c: &[f64; C],
) -> Gradient {
    let zero = F8::ZERO;
    let mut ball = Ball::new(q, &[zero; C], r, zero);
    let mut tangents = *axes;
    let mut d = F8::splat(lift.error_of_way(1.0, 0.0));
    let mut slope = F8::splat(lift.stretch());
    let (mut curve, mut reach) = (zero, r + lift.stretch() * (2.0 * AROUND));
    for _ in 0..iterations {
        let q = ball.points();
        let [square] = squared(&[q]);
        let size = square.sqrt();
        let far = (size + reach) * (1.0 + 64.0 * U);
        let (l, h) = match rule.power {
            JuliaPower::Square => (far * 2.0, F8::splat(2.0)),
            JuliaPower::Cube => (far * far * 3.0, far * 6.0),
        };
        // The error of a tangent's direction: the change of the differential within `r`, and its
        // rounding.
        d = (l * d + h * F8(ball.r.0) * (slope + d) + l * slope * (32.0 * U)) * (1.0 + 16.0 * U);
        curve = (l * curve + h * slope * slope) * (1.0 + 16.0 * U);
        slope = l * slope * (1.0 + 16.0 * U);
        reach = l * reach + rule.c_err + (square * size.max(F8::ONE) + rule.c_size) * (64.0 * U);
        for t in &mut tangents {
            let mut turned = q[C - 1] * t[C - 1];
            for i in (1..C - 1).rev() {
                turned = q[i].mul_add(t[i], turned);
            }
            let (a, t0) = (q[0], t[0]);
            let (real, factor, change) = match rule.power {
                JuliaPower::Square => ((a * t0 - turned) * 2.0, a * 2.0, t0 * 2.0),
                JuliaPower::Cube => {
                    let rest = square - a * a;
                    let factor = a * a * 3.0 - rest;
                    ((a * a - rest) * 3.0 * t0 - a * turned * 6.0, factor, a * t0 * 6.0 - turned * 2.0)
                }
            };
            t[0] = real;
            for (t, q) in t.iter_mut().zip(q).skip(1) {
                *t = factor.mul_add(*t, change * q);
            }
        }
        ball.step(c, rule.power, rule.c_err, rule.c_size);
    }
    let (q, r) = (ball.points(), F8(ball.r.0));
    let [square] = squared(&[q]);
    let size = square.sqrt();
    let mut half = [zero; 3];
    for (half, t) in half.iter_mut().zip(&tangents) {
        *half = q[C - 1] * t[C - 1];
        for i in (0..C - 1).rev() {
            *half = q[i].mul_add(t[i], *half);
        }
    }
    let e_half = (size * d + r * (slope + d) + size * slope * (16.0 * U)) * (1.0 + 16.0 * U) + TINY;
    let far = size + reach;
    let bend = (slope * slope + far * curve) * (2.0 * (1.0 + 1.0 / 1024.0));
    let e_square = (size * 2.0 + r) * r;
    Gradient { square, e_square, half: Vec3::from(half), e_half, bend }
}
