//! Orbits of balls: certain bounds on `|z_n|` on eight stretches of a line at once.
//!
//! Along a stretch `s = mid + half x`, `|x| <= 1`, the orbit's `n`-th point and its derivative by
//! `x` are
//!
//! ```text
//!   z_n  = q + v x + (no longer than r),    z_n' = v + (no longer than d)
//! ```
//!
//! With `δ = v x + e`, `|e| <= r`, the square `(q + δ)² + c` is `q² + c + (q v + v q) x` plus a
//! remainder `q e + e q + δ²`; the cube likewise. Lengths of products are products of lengths, for
//! quaternions as for complex numbers, so the remainders stay of second order in the stretch's
//! length. A point is a stretch of length zero. Hypercomplex numbers are two complex numbers side
//! by side,
//!
//! ```text
//!   a + b i + c j + d k  ->  (a - d) + (b + c) i,  (a + d) + (b - c) i,    |z|² = half the sum of their squares
//! ```
//!
//! each with an orbit of its own.

use super::JuliaPower;
use durer_math::real::{Eight, Real, less, more, real, roundings};
use durer_math::{F8, M8, U};

/// Covers underflow.
pub(super) const TINY: f64 = f64::TINY;

/// A point of an orbit on eight stretches; `C` coordinates, of which the first is the real one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball<T, const C: usize> {
    pub(super) q: [Eight<T>; C],
    pub(super) v: [Eight<T>; C],
    pub(super) r: Eight<T>,
    pub(super) d: Eight<T>,
}

/// The facts that are proven about eight intervals.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StretchSigns8 {
    /// Certainly outside.
    pub(super) out: M8,
    /// Certainly inside.
    pub(super) within: M8,
    /// A single `|z_n|` decides, and it grows; or it shrinks.
    pub(super) rises: M8,
    pub(super) falls: M8,
    /// For the last uncertain `n`: how much `|z_n|` may change from the stretch's length, and from
    /// errors.
    pub(super) spread: F8,
    pub(super) blur: F8,
}

/// The iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rule<T: Real, const M: usize, const C: usize> {
    pub(super) c: [[T; C]; M],
    /// A bound on the error of each `c`, in length.
    pub(super) c_err: T,
    pub(super) c_size: T,
    pub(super) power: JuliaPower,
    pub(super) iterations: u32,
    /// Points outside the ball of this radius are outside the set.
    pub(super) radius: T,
    /// A bound on the error of the radius.
    pub(super) radius_err: T,
    /// Whether an orbit that leaves that ball never returns, so that the last point decides.
    pub(super) escapes: bool,
}

impl<T: Real, const C: usize> Ball<T, C> {
    /// Zero, everywhere.
    pub(super) const ZERO: Self =
        Self { q: [Eight::ZERO; C], v: [Eight::ZERO; C], r: Eight::ZERO, d: Eight::ZERO };

    /// The next point.
    #[inline(always)]
    pub(super) fn step(&mut self, c: &[T; C], power: JuliaPower, c_err: T, c_size: T) {
        match power {
            JuliaPower::Square => self.square(c, c_err, c_size),
            JuliaPower::Cube => self.cube(c, c_err, c_size),
        }
    }

    #[inline(always)]
    fn square(&mut self, c: &[T; C], c_err: T, c_size: T) {
        for k in 0..8 {
            let (q0, v0) = (self.q[0].0[k], self.v[0].0[k]);
            let (mut q2, mut v2, mut qv) = (real(0.0), real(0.0), real(0.0));
            for i in 1..C {
                let (q, v) = (self.q[i].0[k], self.v[i].0[k]);
                q2 = q.mul_add(q, q2);
                v2 = v.mul_add(v, v2);
                qv = q.mul_add(v, qv);
            }
            let (q_all, v_all) = (q0.mul_add(q0, q2), v0.mul_add(v0, v2));
            let (q_size, v_size) = (q_all.sqrt(), v_all.sqrt());
            let (r, d) = (self.r.0[k], self.d.0[k]);
            let way = v_size + r;
            // `8 U (|q|² + |c|)` for the new middle and `16 U |q| |v|` for the new slope; the rest
            // covers this line.
            let rounding = (q_all + c_size + q_size * real(2.0) * v_size).mul_add(roundings(10.0), c_err);
            let rest = (q_size * real(2.0)).mul_add(r, way.mul_add(way, rounding));
            self.r.0[k] = rest * more(32.0) + T::TINY;
            let slope_rounding = (q_size * v_size) * roundings(20.0);
            let slope = way.mul_add(v_size + d, q_size.mul_add(d, slope_rounding));
            self.d.0[k] = slope * real(2.0) * more(32.0) + T::TINY;
            for (i, c) in c.iter().enumerate().skip(1) {
                let (q, v) = (self.q[i].0[k], self.v[i].0[k]);
                self.q[i].0[k] = (q0 * real(2.0)).mul_add(q, *c);
                self.v[i].0[k] = q0.mul_add(v, v0 * q) * real(2.0);
            }
            self.q[0].0[k] = q0.mul_add(q0, c[0] - q2);
            self.v[0].0[k] = q0.mul_add(v0, -qv) * real(2.0);
        }
    }

    /// `(a + w)³ = a (a² - 3 |w|²) + (3 a² - |w|²) w`, and its differential.
    #[inline(always)]
    fn cube(&mut self, c: &[T; C], c_err: T, c_size: T) {
        for k in 0..8 {
            let (q0, v0) = (self.q[0].0[k], self.v[0].0[k]);
            let (mut q2, mut v2, mut qv) = (real(0.0), real(0.0), real(0.0));
            for i in 1..C {
                let (q, v) = (self.q[i].0[k], self.v[i].0[k]);
                q2 = q.mul_add(q, q2);
                v2 = v.mul_add(v, v2);
                qv = q.mul_add(v, qv);
            }
            let (q_all, v_all) = (q0.mul_add(q0, q2), v0.mul_add(v0, v2));
            let (q_size, v_size) = (q_all.sqrt(), v_all.sqrt());
            let (r, d) = (self.r.0[k], self.d.0[k]);
            let way = v_size + r;
            let rounding = (q_all * (q_size + v_size) + c_size).mul_add(roundings(64.0), c_err);
            let rest = way * way * (q_size * real(3.0) + way);
            let rest = (q_all * real(3.0)).mul_add(r, rest + rounding);
            self.r.0[k] = rest * more(64.0) + T::TINY;
            let turned = way * (q_size * real(6.0) + way * real(3.0));
            let slope_rounding = q_all * v_size * roundings(64.0);
            let slope = (q_all * real(3.0)).mul_add(d, turned.mul_add(v_size + d, slope_rounding));
            self.d.0[k] = slope * more(64.0) + T::TINY;
            let s0 = q0 * q0;
            let factor = s0 * real(3.0) - q2;
            let change = q0 * real(6.0) * v0 - qv * real(2.0);
            for (i, c) in c.iter().enumerate().skip(1) {
                let (q, v) = (self.q[i].0[k], self.v[i].0[k]);
                self.q[i].0[k] = factor.mul_add(q, *c);
                self.v[i].0[k] = factor.mul_add(v, change * q);
            }
            self.q[0].0[k] = q0.mul_add(s0 - q2 * real(3.0), c[0]);
            self.v[0].0[k] = ((s0 - q2) * real(3.0)).mul_add(v0, -(q0 * real(6.0) * qv));
        }
    }
}

/// Positive where the points are certainly outside: a part of [`classify`].
#[inline(always)]
fn outside<T: Real, const M: usize, const C: usize>(
    balls: &[Ball<T, C>; M],
    (radius, radius_err): (T, T),
) -> Eight<T> {
    let mut out = Eight::ZERO;
    let share = real(1.0 / M as f32);
    for k in 0..8 {
        let (mut a, mut b, mut c, mut r) = (real(0.0), real(0.0), real(0.0), real::<T>(0.0));
        for ball in balls {
            for i in 0..C {
                let (q, v) = (ball.q[i].0[k], ball.v[i].0[k]);
                a = q.mul_add(q, a);
                b = q.mul_add(v, b);
                c = v.mul_add(v, c);
            }
            r = r.max(ball.r.0[k]);
        }
        (a, b, c) = (a * share, b * share, c * share);
        let rounding = (a + b.abs() * real(2.0) + c) * roundings(16.0);
        let (least, over) = (a - b.abs() * real(2.0) + c.min(b.abs()), radius + (r + radius_err));
        out.0[k] = least - rounding - over * over * more(8.0);
    }
    out
}

/// What the `n`-th points prove about `|z_n|`, as numbers that are positive where something is
/// certain.
struct OrbitSigns<T> {
    out: Eight<T>,
    within: Eight<T>,
    rises: Eight<T>,
    falls: Eight<T>,
    spread: Eight<T>,
    blur: Eight<T>,
}

#[inline(always)]
fn classify<T: Real, const M: usize, const C: usize>(
    balls: &[Ball<T, C>; M],
    (radius, radius_err): (T, T),
) -> OrbitSigns<T> {
    let mut told = OrbitSigns {
        out: Eight::ZERO,
        within: Eight::ZERO,
        rises: Eight::ZERO,
        falls: Eight::ZERO,
        spread: Eight::ZERO,
        blur: Eight::ZERO,
    };
    let share = real(1.0 / M as f32);
    for k in 0..8 {
        let (mut a, mut b, mut c, mut r2, mut d2) = (real(0.0), real(0.0), real(0.0), real(0.0), real(0.0));
        for ball in balls {
            for i in 0..C {
                let (q, v) = (ball.q[i].0[k], ball.v[i].0[k]);
                a = q.mul_add(q, a);
                b = q.mul_add(v, b);
                c = v.mul_add(v, c);
            }
            r2 = ball.r.0[k].mul_add(ball.r.0[k], r2);
            d2 = ball.d.0[k].mul_add(ball.d.0[k], d2);
        }
        (a, b, c) = (a * share, b * share, c * share);
        // The mean square of the parts; of a single one, its own size.
        let size = |x: T| (x * share).sqrt() * more(8.0);
        let (r, d) = if M == 1 { (balls[0].r.0[k], balls[0].d.0[k]) } else { (size(r2), size(d2)) };
        let rounding = (a + b.abs() * real(2.0) + c) * roundings(16.0);
        // `|q + v x|² = a + 2 b x + c x²` is least where `x = -b / c`, if that is in reach: no less
        // than `a - |b|` there.
        let least = a - b.abs() * real(2.0) + c.min(b.abs());
        let most = a + b.abs() * real(2.0) + c;
        let blur = r + radius_err;
        let (over, under) = (radius + blur, (radius - blur).max(real(0.0)));
        told.out.0[k] = least - rounding - over * over * more(8.0);
        told.within.0[k] = under * under * less(8.0) - (most + rounding);
        // `z · z' = (q + v x + e) · (v + ε)`.
        let (q_size, v_size) = (a.sqrt(), c.sqrt());
        let doubt = (c + q_size * d + v_size * (d + r) + r * d) * more(64.0) + rounding + T::TINY;
        told.rises.0[k] = b - doubt;
        told.falls.0[k] = -b - doubt;
        // Across the orbit's point, as at a tangent, it changes by the square of the distance.
        told.spread.0[k] = ((b.abs() * real(2.0) + c) / q_size).min(v_size);
        told.blur.0[k] = r;
    }
    told
}

impl<T: Real, const M: usize, const C: usize> Rule<T, M, C> {
    /// What is certain about eight stretches that begin as `balls`. Where a lane is outside its
    /// other flags mean nothing.
    #[inline(always)]
    pub(super) fn known(&self, mut balls: [Ball<T, C>; M]) -> StretchSigns8 {
        let radius = (self.radius, self.radius_err);
        let mut known = StretchSigns8::default();
        let (mut one, mut many, mut rises, mut falls) = (M8::NONE, M8::NONE, M8::NONE, M8::NONE);
        // Positive where a lane is outside.
        let mut out = Eight::ZERO;
        for n in 0..=self.iterations {
            if self.escapes && n < self.iterations {
                if self.may_leave(&balls, &out) {
                    out.raise(&outside(&balls, radius));
                    if out.are_all_positive() {
                        return StretchSigns8 { out: M8::ALL, ..known };
                    }
                }
            } else {
                let told = classify(&balls, radius);
                out.raise(&told.out);
                known.out = out.are_positive();
                if known.out.all() {
                    return known;
                }
                let open = !(told.within.are_positive() | known.out);
                many |= one & open;
                one |= open;
                rises |= open & told.rises.are_positive();
                falls |= open & told.falls.are_positive();
                known.spread = open.select(told.spread.widened(), known.spread);
                known.blur = open.select(told.blur.widened(), known.blur);
            }
            if n < self.iterations {
                for (ball, c) in balls.iter_mut().zip(&self.c) {
                    ball.step(c, self.power, self.c_err, self.c_size);
                }
            }
        }
        known.within = !(known.out | one);
        let alone = one & !many & !known.out;
        (known.rises, known.falls) = (alone & rises, alone & falls);
        known
    }

    /// Whether the middle of any undecided stretch is beyond the radius. Otherwise [`outside`],
    /// which costs three times as much, can prove nothing new.
    #[inline(always)]
    fn may_leave(&self, balls: &[Ball<T, C>; M], out: &Eight<T>) -> bool {
        let mut may = false;
        let share = real(1.0 / M as f32);
        let level = self.radius * self.radius;
        for k in 0..8 {
            let mut a = real(0.0);
            for ball in balls {
                for q in &ball.q {
                    a = q.0[k].mul_add(q.0[k], a);
                }
            }
            may |= (a * share > level) & (out.0[k] <= T::ZERO);
        }
        may
    }
}

impl<const M: usize, const C: usize> Rule<f64, M, C> {
    /// The largest `|z_n|² - R²`, rounded; large as soon as it is certainly positive.
    #[inline(always)]
    pub(super) fn value(&self, mut z: [[f64; C]; M]) -> f64 {
        let (mut most, level) = (f64::NEG_INFINITY, self.radius * self.radius);
        for n in 0..=self.iterations {
            let size = z.iter().flatten().fold(0.0, |sum: f64, x| x.mul_add(*x, sum)) / M as f64;
            most = if self.escapes { size - level } else { most.max(size - level) };
            if n == self.iterations || most > 1e12 {
                break;
            }
            for (z, c) in z.iter_mut().zip(&self.c) {
                *z = self.next(z, c);
            }
        }
        most
    }

    #[inline(always)]
    fn next(&self, z: &[f64; C], c: &[f64; C]) -> [f64; C] {
        let a = z[0];
        let w2 = z[1..].iter().fold(0.0, |sum: f64, x| x.mul_add(*x, sum));
        let (real, factor) = match self.power {
            JuliaPower::Square => (a * a - w2, 2.0 * a),
            JuliaPower::Cube => (a * (a * a - 3.0 * w2), 3.0 * a * a - w2),
        };
        core::array::from_fn(|i| if i == 0 { real + c[0] } else { factor.mul_add(z[i], c[i]) })
    }

    /// The gradient of the largest `|z_n|²` along `tangents`, rounded; and a bound on the second
    /// derivatives in a ball of radius `r` about the point. `stretch` bounds the factor by which
    /// the embedding lengthens a vector.
    #[inline(always)]
    pub(super) fn gradient(
        &self,
        mut z: [[f64; C]; M],
        mut tangents: [[[f64; C]; M]; 3],
        r: f64,
        stretch: f64,
    ) -> ([f64; 3], f64) {
        let mut found = ([0.0; 3], 0.0);
        let mut most = f64::NEG_INFINITY;
        let (mut ball, mut slope, mut bend) = ([r * stretch; M], [stretch; M], [0.0_f64; M]);
        for n in 0..=self.iterations {
            let share = 2.0 / M as f64;
            let sizes: [f64; M] =
                core::array::from_fn(|m| z[m].iter().fold(0.0, |sum: f64, x| x.mul_add(*x, sum)));
            let size: f64 = sizes.iter().sum::<f64>() / M as f64;
            if n == self.iterations || (!self.escapes && size > most) {
                most = size;
                let along = |t: &[[f64; C]; M]| {
                    let terms = t.iter().flatten().zip(z.iter().flatten());
                    terms.fold(0.0, |sum: f64, (t, z)| t.mul_add(*z, sum)) * share
                };
                let second = (0..M).map(|m| {
                    let far = sizes[m].sqrt() + ball[m];
                    slope[m] * slope[m] + far * bend[m]
                });
                let bound = second.sum::<f64>() * share * (1.0 + 1.0 / 1024.0);
                found = (core::array::from_fn(|i| along(&tangents[i])), bound);
            }
            if n == self.iterations || size > 1e12 {
                break;
            }
            for m in 0..M {
                let far = (sizes[m].sqrt() + ball[m]) * (1.0 + 1.0 / 4096.0);
                let (l, h) = match self.power {
                    JuliaPower::Square => (2.0 * far, 2.0),
                    JuliaPower::Cube => (3.0 * far * far, 6.0 * far),
                };
                bend[m] = l * bend[m] + h * (slope[m] * slope[m]);
                (slope[m], ball[m]) =
                    (l * slope[m], l * ball[m] + self.c_err + far * far * far.max(1.0) * (64.0 * U));
                let (a, w2) = (z[m][0], z[m][1..].iter().fold(0.0, |sum: f64, x| x.mul_add(*x, sum)));
                for t in &mut tangents {
                    let t = &mut t[m];
                    let wt = (1..C).fold(0.0, |sum: f64, i| z[m][i].mul_add(t[i], sum));
                    let (real, factor, change) = match self.power {
                        JuliaPower::Square => (2.0 * (a * t[0] - wt), 2.0 * a, 2.0 * t[0]),
                        JuliaPower::Cube => (
                            3.0 * (a * a - w2) * t[0] - 6.0 * a * wt,
                            3.0 * a * a - w2,
                            6.0 * a * t[0] - 2.0 * wt,
                        ),
                    };
                    for i in 1..C {
                        t[i] = factor.mul_add(t[i], change * z[m][i]);
                    }
                    t[0] = real;
                }
                z[m] = self.next(&z[m], &self.c[m]);
            }
        }
        found
    }
}
