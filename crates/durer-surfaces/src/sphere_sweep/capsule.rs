//! The capsule: the sweep of a ball along a straight line.
//!
//! ```text
//!        .-───────────-.           w = x - A,  h = w·a,  a = B - A
//!       ( A ●─ ─ a ─ ─▶● B )       h <= 0: |w|² - r²;  h >= a²: |w - a|² - r²;
//!        `-───────────-´           between them: |w|² - h² / a² - r²
//! ```
//!
//! The solid is convex: of a line that meets it, it holds one interval. Its ends are those of the
//! infinite cylinder's interval, or lie on the ball beyond whose centre these are. An end is proven
//! by a point of the line outside and one inside, on either side of it, in f64 with running errors.
//! Where that leaves a doubt, the line is taken as that of any sweep.

use super::line::{Doubt, RunEnd, Widths};
use super::unite::Span;
use crate::CentredRay;
use core::cmp::Ordering;
use durer_math::{EFloat, Ring, Vec3};

/// The numbers of a capsule, in units of the sweep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capsule {
    /// A, relative to the sweep's centre.
    base: [EFloat; 3],
    axis: [EFloat; 3],
    /// `a²`.
    aa: EFloat,
    /// `r²`.
    rr: EFloat,
}

#[inline(always)]
fn dot(a: &[EFloat; 3], b: &[EFloat; 3]) -> EFloat {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn rounded(a: &[EFloat; 3]) -> Vec3 {
    Vec3::from(a.map(EFloat::value))
}

#[inline(always)]
fn is_positive(x: EFloat) -> bool {
    x.sign() == Some(Ordering::Greater)
}

#[inline(always)]
fn is_negative(x: EFloat) -> bool {
    x.sign() == Some(Ordering::Less)
}

/// A line relative to A.
struct CapsuleLine<'a> {
    capsule: &'a Capsule,
    m: [EFloat; 3],
    d: [EFloat; 3],
    dd: EFloat,
    /// `d·a`.
    da: EFloat,
}

impl Capsule {
    /// The sweep from one ball to another of the same size, about `centre` in units of `2^scale`;
    /// `None` for other balls, and where they have one centre. Radii of different signs are of
    /// different sizes between the two.
    pub(super) fn new([one, other]: &[[f64; 4]; 2], centre: [f64; 3], scale: i32) -> Option<Self> {
        let exact = EFloat::<f64>::exact;
        let relative =
            |p: &[f64; 4], from: [f64; 3]| [0, 1, 2].map(|k| (exact(p[k]) - exact(from[k])).scale2(-scale));
        let base = relative(one, centre);
        let axis = relative(other, [one[0], one[1], one[2]]);
        let (aa, rr) = (dot(&axis, &axis), exact(one[3]).scale2(-scale).square());
        (one[3] == other[3] && is_positive(aa) && is_positive(rr)).then_some(Self { base, axis, aa, rr })
    }

    /// The interval of the line inside; `None` if it certainly misses.
    #[inline(always)]
    pub(super) fn span(&self, at: &CentredRay<'_>, widths: &Widths) -> Result<Option<Span>, Doubt> {
        let with = |x: Vec3, e: Vec3| [0, 1, 2].map(|k| EFloat::<f64>::with_error(x[k], e[k]));
        let (o, d) = (with(at.o, at.o_err), with(at.d, at.d_err));
        let m = [o[0] - self.base[0], o[1] - self.base[1], o[2] - self.base[2]];
        let line = CapsuleLine { capsule: self, m, d, dd: dot(&d, &d), da: dot(&d, &self.axis) };
        if line.misses() {
            return Ok(None);
        }
        let [from, to] = line.ends().ok_or(Doubt)?;
        let from = line.end(from, -1.0, widths).ok_or(Doubt)?;
        let to = line.end(to, 1.0, widths).ok_or(Doubt)?;
        Ok(Some(Span { from, to, touches: false }))
    }
}

impl CapsuleLine<'_> {
    /// Whether the line certainly meets no ball. The ball at `A + u a` is met where
    /// `D(u) = (d·w)² - d² (|w|² - r²)` is not negative, with `w = m - u a`; `D` is concave.
    #[inline(always)]
    fn misses(&self) -> bool {
        let Capsule { axis: a, aa, rr, .. } = self.capsule;
        let (m, d) = (&self.m, &self.d);
        let n = [d[1] * a[2] - d[2] * a[1], d[2] * a[0] - d[0] * a[2], d[0] * a[1] - d[1] * a[0]];
        // The line's distance from the axis.
        if is_positive(dot(m, &n).square() - *rr * dot(&n, &n)) {
            return true;
        }
        let (md, ma) = (dot(m, d), dot(m, a));
        // D' / 2 at u = 0; D'' / 2 is d² a² - (d·a)², with the other sign.
        let rise = self.dd * ma - md * self.da;
        if is_negative(rise) {
            return is_negative(md.square() - self.dd * (dot(m, m) - *rr));
        }
        let fall = self.dd * (*aa - ma) + (md - self.da) * self.da;
        if is_negative(fall) {
            let w = [m[0] - a[0], m[1] - a[1], m[2] - a[2]];
            let wd = dot(&w, d);
            return is_negative(wd.square() - self.dd * (dot(&w, &w) - *rr));
        }
        false
    }

    /// Where the interval begins and ends, about: the ball from 0 to 1 and `s`.
    #[inline(always)]
    fn ends(&self) -> Option<[(f64, f64); 2]> {
        /// Nearer to the axis' direction the cylinder's ends are far off.
        const ALONG: f64 = 1.0 / (1_u64 << 30) as f64;
        let (m, d, a) = (rounded(&self.m), rounded(&self.d), rounded(&self.capsule.axis));
        let (aa, rr, dd, da) =
            (self.capsule.aa.value(), self.capsule.rr.value(), self.dd.value(), self.da.value());
        let (md, ma) = (m.dot(d), m.dot(a));
        let (p, q) = (aa * dd - da * da, aa * md - da * ma);
        let disc = q * q - p * (aa * (m.dot(m) - rr) - ma * ma);
        let ball = |x: f64, sign: f64| {
            let w = m - a * x;
            let wd = w.dot(d);
            let disc = wd * wd - dd * (w.dot(w) - rr);
            (disc >= 0.0).then(|| (x, sign.mul_add(disc.sqrt(), -wd) / dd))
        };
        let end = |sign: f64| {
            if p <= ALONG * aa * dd {
                return ball(if da * sign > 0.0 { 1.0 } else { 0.0 }, sign);
            }
            if disc < 0.0 {
                return None;
            }
            let s = sign.mul_add(disc.sqrt(), -q) / p;
            let x = (ma + s * da) / aa;
            if x <= 0.0 {
                ball(0.0, sign)
            } else if x >= 1.0 {
                ball(1.0, sign)
            } else {
                Some((x, s))
            }
        };
        Some([end(-1.0)?, end(1.0)?])
    }

    /// The line's point at `s`, relative to the centre of the ball at `x`; its product with the
    /// axis.
    #[inline(always)]
    fn point(&self, x: f64, s: f64) -> ([EFloat; 3], EFloat) {
        let (x, s, a) = (EFloat::exact(x), EFloat::exact(s), &self.capsule.axis);
        let w = [0, 1, 2].map(|k| self.m[k] + s * self.d[k] - x * a[k]);
        let h = dot(&w, a);
        (w, h)
    }

    /// What the point at `s` is outside by, in squares, if that is positive.
    #[inline(always)]
    fn beyond(&self, x: f64, s: f64) -> EFloat {
        let (w, h) = self.point(x, s);
        let ball = dot(&w, &w) - self.capsule.rr;
        let is_past = (x == 0.0 && h.hi() <= 0.0) || (x == 1.0 && h.lo() >= 0.0);
        if is_past { ball } else { ball - h.square() / self.capsule.aa }
    }

    /// The end at the ball `x`, near `s`, in a proven bracket.
    #[inline(always)]
    fn end(&self, (x, mut s): (f64, f64), sign: f64, widths: &Widths) -> Option<RunEnd> {
        let mut off = 0.0;
        for _ in 0..2 {
            let (w, h) = self.point(x, s);
            let is_wall = x > 0.0 && x < 1.0;
            let share = if is_wall { h / self.capsule.aa } else { EFloat::exact(0.0) };
            let value = dot(&w, &w) - self.capsule.rr - share * h;
            let slope = 2.0 * share.value().mul_add(-self.da.value(), dot(&w, &self.d).value());
            let newton = value.value() / slope;
            off = (value.value().abs() + 2.0 * value.e) / slope.abs();
            if !(newton.abs() < 1.0 && slope * sign > 0.0) {
                return None;
            }
            s -= newton;
        }
        let scale = widths.scale(s);
        let most = widths.most * scale;
        let mut half = (widths.half * scale).max(1.5 * off);
        while half <= most {
            let (within, beyond) = (s - sign * half, s + sign * half);
            let w = self.point(x, within).0;
            if is_negative(dot(&w, &w) - self.capsule.rr) && is_positive(self.beyond(x, beyond)) {
                let (lo, hi) = (within.min(beyond), within.max(beyond));
                return Some(RunEnd { s, lo, hi, ball: (0, x.mul_add(2.0, -1.0)) });
            }
            half *= 3.0;
        }
        None
    }
}
