//! A component in its own frame: its field at a point, and its segments along a ray.
//!
//! ```text
//!   w = W (y - m)                y: the blob's frame, in units; w: the component's, in units of its radius
//!   q = |w|²                     of a ball; of a cylinder's axis from 0 to l along w_z: |w_x, w_y, w_z - clamp(w_z, 0, l)|²
//!   field: S max(0, 1 - q)²
//! ```
//!
//! Along a ray `q = m + v (2 b + n v)` with `v = s - at`, relative to the component's own closest
//! approach. All of these are at most about one where `q < 1`, so nothing cancels, however small
//! the component is relative to the blob. A cylinder has three such segments, which meet where
//! `w_z` is 0 or `l`.

use super::BlobShape;
use super::packet::Field;
use super::{BlobComponent, march::Along};
use crate::faces::chart::tangents;
use crate::{Accelerate, SphereError};
use durer_math::eft::{scale2, two_diff};
use durer_math::{Aabb, Affine, Point3, U, Vec3};

/// Covers underflow.
const TINY: f64 = durer_math::scale::pow2(-900);
/// The part of a ray that is examined, in its parameter: the blob is within `√3` of its centre, in
/// units.
pub(super) const REACH: f64 = 2.0;

/// A component in units of the blob's frame.
#[derive(Clone, Debug)]
pub(super) struct Component {
    /// The rows of `W`.
    rows: [Vec3; 3],
    /// The factor if `W` is a multiple of the identity; else zero.
    plain: f64,
    /// `m`, and its error along any axis.
    centre: Vec3,
    centre_err: f64,
    /// The largest sum of magnitudes in a row of `W`, and the errors.
    size: f64,
    size_err: f64,
    /// The length of the axis; zero for a ball.
    length: f64,
    strength: f64,
    /// An upper bound of the norm of the field's second derivatives.
    pub(super) bend: f64,
}

/// The field along a part of a ray: `strength (1 - m - v (2 b + n v))²`, `v = s - at`, from `from`
/// to `to`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldSegment {
    pub(super) at: f64,
    pub(super) m: f64,
    pub(super) b: f64,
    pub(super) n: f64,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) strength: f64,
    /// An upper bound of the field; zero where it is negative.
    pub(super) peak: f64,
    /// The sum of the errors of its coefficients over any part of the stretch, scaled to `[-1, 1]`.
    pub(super) slack: f64,
    /// An upper bound of the sum of the magnitudes of those coefficients.
    pub(super) size: f64,
    /// An upper bound of `|1 - q|` at the computed ends of the field.
    pub(super) seam: f64,
    /// The magnitude of the derivative of `w_z` by `s` at each end that joins another segment of
    /// its component; else zero.
    pub(super) joint: [f64; 2],
    /// A bound on the magnitude of the derivative of `w` by `s`.
    pub(super) speed: f64,
}

/// The part of a ray on which a component has one of its segments.
struct Segment {
    /// The height of the axis point from which distances are measured; `None` if they are measured
    /// from the axis.
    lift: Option<f64>,
    low: f64,
    high: f64,
    /// See [`FieldSegment::joint`].
    joint: [f64; 2],
    /// The error of `w_z` at ends that depend on it.
    doubt: f64,
}

/// The field at a point, with its error and gradient.
pub(super) struct Added {
    pub(super) value: f64,
    pub(super) error: f64,
    pub(super) gradient: Vec3,
    pub(super) gradient_err: f64,
}

impl BlobComponent {
    /// A box around the reach of the field.
    pub(super) fn bounds(&self) -> Result<Aabb, SphereError> {
        let ball = |centre| Ok(crate::Sphere::new(centre, self.radius)?.bounds_through(&self.place));
        match self.shape {
            BlobShape::Ball(centre) => ball(centre),
            // The hull of two balls.
            BlobShape::Segment(a, b) => Ok(ball(a)?.union(ball(b)?)),
        }
    }
}

impl Component {
    /// A component relative to `origin`, in units of `2^scale`.
    pub(super) fn new(it: &BlobComponent, origin: Point3, scale: i32) -> Self {
        let (start, axis) = match it.shape {
            BlobShape::Ball(c) => (c, Vec3::ZERO),
            BlobShape::Segment(a, b) => (a, b - a),
        };
        let unmoved = it.place == Affine::IDENTITY;
        // The factor that divides lengths by the radius.
        let factor = scale2(1.0 / it.radius, scale);
        let (inverse, slack) = (it.place.inverse_linear(), it.place.inverse_error());
        let mut rows = inverse.map(|row| Vec3::from(row) * factor);
        let error = |i: usize| {
            let wrong: f64 = slack[i].iter().map(|e| e * factor).sum();
            let rounded: f64 = rows[i].to_array().iter().map(|x| x.abs() * (3.0 * U)).sum();
            (wrong + rounded) * (1.0 + 32.0 * U) + TINY
        };
        let errors = [error(0), error(1), error(2)];
        let size = |rows: &[Vec3; 3]| {
            rows.iter().fold(0.0, |most: f64, r| most.max(r.x.abs() + r.y.abs() + r.z.abs()))
        };
        let mut size_err = errors[0].max(errors[1]).max(errors[2]);
        let mut length = 0.0;
        if axis != Vec3::ZERO {
            let long = (axis.x * axis.x + axis.y * axis.y + axis.z * axis.z).sqrt();
            length = long / it.radius;
            let up = axis * (1.0 / long);
            let (u, v) = tangents(up);
            let turned = |e: Vec3| rows[0] * e.x + rows[1] * e.y + rows[2] * e.z;
            let total: f64 = rows.iter().map(|r| r.x.abs() + r.y.abs() + r.z.abs()).sum();
            rows = [turned(u), turned(v), turned(up)];
            // The three are orthonormal but for 16 roundings each; three products and sums.
            size_err = (errors[0] + errors[1] + errors[2]) * 2.0 + total * (24.0 * U);
        }
        let size = size(&rows) * (1.0 + 4.0 * U);
        let p = if unmoved { start } else { it.place.point(start) };
        let apart = |axis: usize| {
            let (x, lost) = two_diff(p[axis], origin[axis]);
            let matrix = it.place.linear()[axis];
            let moved = if unmoved {
                0.0
            } else {
                let terms: f64 = (0..3).map(|k| (matrix[k] * start[k]).abs()).sum();
                (terms + it.place.centre()[axis].abs()) * (6.0 * U)
            };
            (scale2(x, -scale), scale2((lost.abs() + moved) * (1.0 + 8.0 * U), -scale) + TINY)
        };
        let ((x, ex), (y, ey), (z, ez)) = (apart(0), apart(1), apart(2));
        // `|D²(1 - q)²| <= 8 |W|²`, as the square of a distance to a convex set has second
        // derivatives between 0 and 2.
        let norm: f64 = rows.iter().map(|r| r.x * r.x + r.y * r.y + r.z * r.z).sum();
        let plain = if unmoved && length == 0.0 { factor } else { 0.0 };
        let norm = if plain > 0.0 { plain * plain } else { norm };
        Self {
            rows,
            plain,
            centre: Vec3::new(x, y, z),
            centre_err: ex.max(ey).max(ez),
            size,
            size_err,
            length,
            strength: it.strength,
            bend: 8.0 * it.strength.abs() * norm * (1.0 + 1.0 / 1024.0),
        }
    }

    /// The field for packets of eight rays.
    pub(super) fn for_lanes(&self) -> Field {
        let Self { rows, centre, centre_err, size, size_err, length, strength, bend, .. } = *self;
        Field { rows, size, size_err, centre, centre_err, length, strength, bend }
    }

    /// `W v`.
    #[inline(always)]
    fn turned(&self, v: Vec3) -> Vec3 {
        if self.plain > 0.0 {
            return v * self.plain;
        }
        Vec3::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }

    /// The segments along a ray. The possible field of a component that almost misses the ray is
    /// added to `charge`.
    #[inline(always)]
    pub(super) fn pieces(&self, ray: &Along, charge: &mut f64, mut show: impl FnMut(FieldSegment)) {
        let r = ray.o - self.centre;
        let a = self.turned(ray.d);
        let whole = Segment { lift: Some(0.0), low: -REACH, high: REACH, joint: [0.0; 2], doubt: 0.0 };
        if self.length == 0.0 {
            self.piece(ray, (r, a), &whole, charge, &mut show);
            return;
        }
        // `w_z` along the ray, within `doubt` everywhere.
        let (height, rate) = (self.rows[2].dot(r), a.z);
        let doubt = self.error_at(ray, r.max_abs(), REACH)
            + REACH * self.rate_error(ray)
            + (height.abs() + REACH * rate.abs() + self.length) * (16.0 * U);
        let (low, high) = (-height / rate, (self.length - height) / rate);
        // The parameters at which the ray passes the ends of the axis, in order; the ray may be
        // between them, or beyond one, everywhere.
        let within = |s: f64| s.clamp(-REACH, REACH);
        let (enter, leave) = if rate == 0.0 {
            match height {
                h if h < 0.0 => (REACH, REACH),
                h if h > self.length => (-REACH, -REACH),
                _ => (-REACH, REACH),
            }
        } else {
            (within(low.min(high)), within(low.max(high)))
        };
        let (first, last) = if rate < 0.0 { (self.length, 0.0) } else { (0.0, self.length) };
        let joint = |s: f64| if s.abs() < REACH { rate.abs() } else { 0.0 };
        let ends = [joint(enter), joint(leave)];
        if enter > -REACH {
            let before = Segment { lift: Some(first), high: enter, joint: [0.0, ends[0]], doubt, ..whole };
            self.piece(ray, (r, a), &before, charge, &mut show);
        }
        if leave > enter {
            let tube = Segment { lift: None, low: enter, high: leave, joint: ends, doubt };
            self.piece(ray, (r, a), &tube, charge, &mut show);
        }
        if leave < REACH {
            let behind = Segment { lift: Some(last), low: leave, joint: [ends[1], 0.0], doubt, ..whole };
            self.piece(ray, (r, a), &behind, charge, &mut show);
        }
    }

    /// The error of each coordinate of `w` at `s`, where `y - m` is `size` long along an axis.
    #[inline(always)]
    fn error_at(&self, ray: &Along, size: f64, s: f64) -> f64 {
        let own = ray.o_err + s.abs() * ray.d_err + self.centre_err;
        self.size * (own + (ray.o_size + self.centre.max_abs() + size) * (2.0 * U))
            + (self.size_err + self.size * (4.0 * U)) * size
            + self.length * (8.0 * U)
            + TINY
    }

    /// The error of each coordinate of `W d`.
    #[inline(always)]
    fn rate_error(&self, ray: &Along) -> f64 {
        self.size * ray.d_err + (self.size_err + self.size * (4.0 * U)) * 2.0 + TINY
    }

    /// One segment. `r` is the ray's start relative to the component, and `a` is `W d`.
    #[inline(always)]
    fn piece(
        &self,
        ray: &Along,
        (r, a): (Vec3, Vec3),
        segment: &Segment,
        charge: &mut f64,
        show: &mut impl FnMut(FieldSegment),
    ) {
        let &Segment { lift, low, high, joint, doubt } = segment;
        let placed = |w: Vec3| match lift {
            Some(lift) => Vec3::new(w.x, w.y, w.z - lift),
            None => Vec3::new(w.x, w.y, 0.0),
        };
        let a = if lift.is_some() { a } else { Vec3::new(a.x, a.y, 0.0) };
        let n = a.dot(a);
        // The closest approach, rounded; any number will do. NaN becomes an end.
        let at = (-placed(self.turned(r)).dot(a) / n).max(low).min(high);
        let y = Vec3::new(at.mul_add(ray.d.x, r.x), at.mul_add(ray.d.y, r.y), at.mul_add(ray.d.z, r.z));
        let w = placed(self.turned(y));
        let (m, b) = (w.dot(w), w.dot(a));
        // This is a miss if the errors are far below one, as they mostly are.
        let (e_w, e_a) = (self.error_at(ray, y.max_abs(), at), self.rate_error(ray));
        let top = if n > 0.0 { (-b / n).max(low - at).min(high - at) } else { 0.0 };
        let most = 1.0 - m - top * (2.0 * b + n * top);
        if most < -0.125 && e_w + (2.0 * REACH) * e_a < 1.0 / 1024.0 {
            return;
        }
        // `q = 1` at `v = (-b ± √(b² + n (1 - m))) / n`, without cancellation.
        let square_root = b.mul_add(b, n * (1.0 - m)).max(0.0).sqrt();
        let (first, last) = if b > 0.0 {
            let sum = -b - square_root;
            (sum / n, (m - 1.0) / sum)
        } else {
            let sum = square_root - b;
            ((m - 1.0) / sum, sum / n)
        };
        let (from, to) = ((at + first).max(low).min(high), (at + last).min(high).max(low));
        let far = (from - at).abs().max((to - at).abs()).max(top.abs());
        // `|q exact - q| <= 2√3 G E + 3 E²` with `G² <= 2 (m + n V²)`, `E = e_w + V e_a`; and the
        // roundings of `q`.
        let extent = far.mul_add(far * n, m);
        let whole = (2.0 * far).mul_add(b.abs(), extent);
        let e = far.mul_add(e_a, e_w);
        let e_q = (3.5 * (0.5 + extent) + 3.0 * e).mul_add(e, (whole + 2.0 * extent + 1.0) * (16.0 * U))
            + doubt * doubt;
        if most <= 16.0 * e_q || from >= to {
            let left = (most + 2.0 * e_q).max(0.0) + e_q;
            let left = if most <= 16.0 * e_q { left } else { 2.0 * e_q };
            *charge += self.strength.abs() * (left * left);
            return;
        }
        let speed = a.x.abs() + a.y.abs() + a.z.abs();
        let size = self.strength.abs() * ((1.0 + whole) * (1.0 + whole));
        let seam = doubt + 2.0 * e_q + (4.0 + (from.abs() + to.abs() + at.abs()) * speed) * (16.0 * U);
        *charge += self.strength.abs() * (seam * seam);
        let slack = (self.strength.abs() * ((2.0 + 2.0 * whole + e_q) * e_q) + size * (16.0 * U))
            * (1.0 + 1.0 / 64.0);
        let peak = (most + e_q) * (most + e_q) * (1.0 + 16.0 * U);
        show(FieldSegment {
            at,
            m,
            b,
            n,
            from,
            to,
            strength: self.strength,
            peak: if self.strength > 0.0 { self.strength * peak } else { 0.0 },
            slack,
            size,
            seam,
            joint: [if from > low { 0.0 } else { joint[0] }, if to < high { 0.0 } else { joint[1] }],
            speed,
        });
    }

    /// The field at `y`, each coordinate known within `e`.
    #[inline(always)]
    pub(super) fn added(&self, y: Vec3, e: f64) -> Added {
        let z = y - self.centre;
        let w = self.turned(z);
        let beyond = w.z.min(0.0) + (w.z - self.length).max(0.0);
        let w = if self.length > 0.0 { Vec3::new(w.x, w.y, beyond) } else { w };
        let size = z.max_abs();
        let e_w = self.size * (e + self.centre_err + (y.max_abs() + self.centre.max_abs()) * U)
            + (self.size_err + self.size * (4.0 * U)) * size
            + self.length * (8.0 * U)
            + TINY;
        let q = w.dot(w);
        let e_q = (2.0 * (w.x.abs() + w.y.abs() + w.z.abs()) + 3.0 * e_w) * e_w + (q + 1.0) * (8.0 * U);
        let left = 1.0 - q;
        let strength = self.strength.abs();
        if left <= 0.0 {
            let over = (left + e_q).max(0.0);
            let error = strength * (over * over) + TINY;
            let gradient_err = 12.0 * strength * self.size * over;
            return Added { value: 0.0, error, gradient: Vec3::ZERO, gradient_err };
        }
        let value = left * left;
        let error = strength * ((2.0 * left + e_q) * e_q + value * (4.0 * U)) * (1.0 + 16.0 * U) + TINY;
        let back = if self.plain > 0.0 {
            w * self.plain
        } else {
            self.rows[0] * w.x + self.rows[1] * w.y + self.rows[2] * w.z
        };
        let gradient = back * (-4.0 * self.strength * left);
        // -4 S (1 - q) Wᵀ w, where |w| <= 1.
        let gradient_err = 12.0 * strength * self.size * (e_q + 2.0 * e_w + 8.0 * U);
        Added { value: self.strength * value, error, gradient, gradient_err }
    }
}

impl FieldSegment {
    /// Adds its coefficients over `mid ± half`, the constant first.
    #[inline(always)]
    pub(super) fn add(&self, mid: f64, half: f64, c: &mut [f64; 5]) {
        let u = mid - self.at;
        let slope = self.n.mul_add(u, self.b);
        let g0 = 1.0 - (self.b + slope).mul_add(u, self.m);
        let (q1, q2) = (2.0 * half * slope, self.n * (half * half));
        let s = self.strength;
        let (sg, sq) = (s * g0, s * q2);
        c[0] = sg.mul_add(g0, c[0]);
        c[1] = (-2.0 * sg).mul_add(q1, c[1]);
        c[2] = (s * q1).mul_add(q1, (-2.0 * sg).mul_add(q2, c[2]));
        c[3] = (2.0 * sq).mul_add(q1, c[3]);
        c[4] = sq.mul_add(q2, c[4]);
    }

    /// A bound on the error between `border` and `s` beyond it, if the segment is used past the
    /// border where it begins or ends; and a bound on the growth of that error.
    #[inline(always)]
    pub(super) fn overrun(&self, border: f64, s: f64) -> (f64, f64) {
        let strength = self.strength.abs();
        let end = |end: f64, joint: f64| {
            if end < border || end > s {
                return (0.0, 0.0);
            }
            let way = (s - end) * (1.0 + 8.0 * U);
            if joint > 0.0 {
                // The squares of the distances differ by `w_z²` there; each of the two segments is
                // charged.
                let off = joint.mul_add(way, self.seam);
                return (4.0 * strength * (off * off), 8.0 * strength * off * joint);
            }
            // |d(1 - q)| <= 2 √q |dw| <= (2 + way) way.
            let way = way * self.speed;
            let off = (2.0 + way).mul_add(way, 2.0 * self.seam);
            (strength * (off * off), 2.0 * strength * off * (2.0 + 2.0 * way) * self.speed)
        };
        let (from, to) = (end(self.from, self.joint[0]), end(self.to, self.joint[1]));
        (from.0 + to.0, from.1 + to.1)
    }
}
