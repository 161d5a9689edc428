//! A tape along a line: bounds of `g(s) = f(q + s d)` on stretches of `s`, with every rounding of
//! the ray included.

use super::root_isolator::{CertifiedFunction, interpolated};
use crate::CentredRay;
use durer_formula::Tape;
use durer_formula::{Dual, I8};
use durer_math::eft::two_sum;
use durer_math::{F8, Point3, U, Vec3};

/// Covers underflow.
const TINY: f64 = durer_math::scale::pow2(-1000);

/// The line `q + s d`, each coordinate known within an error, for `|s| <= reach`.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundedLine {
    q: [f64; 3],
    pub(super) d: [f64; 3],
    /// Per-axis bound on the error of the direction.
    pub(super) d_err: [f64; 3],
    /// Per-axis bound on the error of a computed point.
    pub(super) err: [f64; 3],
    /// The spacing of parameters that are worth separating: an ulp of `reach`.
    pub(super) ulp: f64,
}

impl BoundedLine {
    /// The line of a ray that was re-centred with scale 0, as far as `reach`.
    pub(super) fn new(at: &CentredRay<'_>, reach: f64) -> Self {
        let (c, o, d) = (at.centre.to_array(), at.o.to_array(), at.d.to_array());
        let (o_err, d_err) = (at.o_err.to_array(), at.d_err.to_array());
        let mut line = Self { q: [0.0; 3], d, d_err, err: [0.0; 3], ulp: reach * f64::EPSILON + TINY };
        for i in 0..3 {
            let (q, lost) = two_sum(c[i], o[i]);
            line.q[i] = q;
            // One rounding of the point, and two when its error is added and subtracted.
            let size = q.abs() + reach * d[i].abs();
            line.err[i] =
                (lost.abs() + o_err[i] + reach * d_err[i] + 3.0 * U * size) * (1.0 + 16.0 * U) + TINY;
        }
        line
    }

    /// The line moved by `by`; rounding of the move does not matter.
    pub(super) fn beside(&self, by: Vec3) -> Self {
        Self { q: core::array::from_fn(|i| self.q[i] + by[i]), ..*self }
    }

    /// The point at `s`, rounded.
    #[inline(always)]
    pub(super) fn point(&self, s: f64) -> Point3 {
        let x = |i: usize| s * self.d[i] + self.q[i];
        Point3::new(x(0), x(1), x(2))
    }

    /// The middle of the stretch from `a` to `b`, and the greatest distance of the exact line from
    /// it along any axis.
    pub(super) fn around(&self, a: f64, b: f64) -> (Point3, f64) {
        let middle = self.point(0.5 * a + 0.5 * b);
        let reach = (b - a).abs() * Vec3::from(self.d).max_abs();
        // Half of it is enough; the other half covers rounding.
        (middle, reach + 2.0 * Vec3::from(self.err).max_abs())
    }

    /// The direction.
    pub(super) fn direction(&self) -> Vec3 {
        Vec3::from(self.d)
    }

    /// The parameter at which the line reaches `x` along an axis, rounded; not finite if it never
    /// does.
    #[inline(always)]
    pub(super) fn meets(&self, axis: usize, x: f64) -> f64 {
        (x - self.q[axis]) / self.d[axis]
    }

    /// The stretches from `a` to `b`, as boxes.
    #[inline(always)]
    fn boxes(&self, a: &[f64; 8], b: &[f64; 8]) -> [I8; 3] {
        core::array::from_fn(
            #[inline(always)]
            |i| {
                let (mut lo, mut hi) = (F8::ZERO, F8::ZERO);
                for k in 0..8 {
                    // Not fused but rounded twice: the product's error is one of the three that
                    // `err` covers.
                    let (x, y) = (a[k] * self.d[i] + self.q[i], b[k] * self.d[i] + self.q[i]);
                    lo.0[k] = (if x < y { x } else { y }) - self.err[i];
                    hi.0[k] = (if x < y { y } else { x }) + self.err[i];
                }
                I8::new(lo, hi)
            },
        )
    }

    /// Bounds of `g` on eight stretches.
    pub(super) fn bounds(&self, tape: &Tape, a: &[f64; 8], b: &[f64; 8]) -> I8 {
        tape.bounds(&self.boxes(a, b))
    }

    /// Bounds of `g` and of its slope on eight stretches.
    pub(super) fn slopes(&self, tape: &Tape, a: &[f64; 8], b: &[f64; 8]) -> Dual<I8> {
        let v = self.boxes(a, b);
        let slope =
            |i: usize| I8::new(F8::splat(self.d[i] - self.d_err[i]), F8::splat(self.d[i] + self.d_err[i]));
        // Rounded once, by less than the next number, where there is an error at all.
        let d = [0, 1, 2].map(|i| {
            let mut d = slope(i);
            if self.d_err[i] > 0.0 {
                d = I8::new(d.lo.map(f64::next_down), d.hi.map(f64::next_up));
            }
            d
        });
        tape.slopes(&[0, 1, 2].map(|i| Dual { v: v[i], d: d[i] }))
    }

    /// The sign of `g` from `a` to `b` apart from its jumps, if it is certain.
    pub(super) fn sign_beside_jumps(&self, tape: &Tape, a: f64, b: f64) -> Option<bool> {
        tape.sign_beside_jumps(&self.boxes(&[a; 8], &[b; 8]))
    }

    /// The sign of `g` from `a` to `b`, if it is certain.
    pub(super) fn sign_on(&self, tape: &Tape, a: f64, b: f64) -> Option<bool> {
        CertifiedFunction::signs(self, tape, &[a; 8], &[b; 8])[0]
    }
}

impl CertifiedFunction for BoundedLine {
    type Form<'a> = &'a Tape;

    fn same(a: &Tape, b: &Tape) -> bool {
        std::ptr::eq(a, b)
    }

    fn ulp(&self) -> f64 {
        self.ulp
    }

    fn value(&self, tape: &Tape, s: f64) -> f64 {
        tape.value(self.point(s))
    }

    fn signs(&self, tape: &Tape, a: &[f64; 8], b: &[f64; 8]) -> [Option<bool>; 8] {
        let v = self.bounds(tape, a, b);
        let mut told = signs(&v);
        if v.jump != 0 {
            for (i, told) in told.iter_mut().enumerate() {
                if told.is_none() && v.jump >> i & 1 == 1 {
                    *told = self.sign_beside_jumps(tape, a[i], b[i]);
                }
            }
        }
        told
    }

    fn is_plain(&self, tape: &Tape, s: f64) -> bool {
        // The bounds are as far apart as rounding makes them.
        let v = self.bounds(tape, &[s; 8], &[s; 8]);
        let (lo, hi) = (v.lo.0[0], v.hi.0[0]);
        v.partial & 1 == 0 && lo.max(-hi) > 8.0 * (hi - lo)
    }

    fn is_shorter(tape: &Tape, than: &Tape) -> bool {
        than.len() > 2 * tape.len()
    }

    fn closed_in(&self, tape: &Tape, ends: (f64, f64), rises: bool, first: f64) -> Option<(f64, f64, f64)> {
        closed_in(self, tape, ends, rises, first)
    }
}

/// The root of a monotone `g` in `[lo, hi]`, and places with certain signs around it, at most 128
/// times `first` apart, by eight values at a time. `None` if that does not converge at once.
fn closed_in(
    line: &BoundedLine,
    tape: &Tape,
    (lo, hi): (f64, f64),
    rises: bool,
    first: f64,
) -> Option<(f64, f64, f64)> {
    let sense = if rises { 1.0 } else { -1.0 };
    let mut at: [f64; 8] =
        core::array::from_fn(|i| if i == 7 { hi } else { lo + (hi - lo) * (i as f64 / 7.0) });
    let mut about = 0.5 * lo + 0.5 * hi;
    for _ in 0..4 {
        let v = line.bounds(tape, &at, &at);
        let sign = signs(&v);
        let before = sign.iter().rposition(|&sign| sign == Some(!rises));
        let after = sign.iter().position(|&sign| sign == Some(rises));
        if let (Some(before), Some(after)) = (before, after) {
            let (a, b) = (at[before], at[after]);
            if a <= b && b - a <= 128.0 * first {
                return Some((about.max(a).min(b), a, b));
            }
        }
        let g: [f64; 8] = core::array::from_fn(|i| sense * (0.5 * v.lo.0[i] + 0.5 * v.hi.0[i]));
        let (s, doubt) = interpolated(&at, &g)?;
        if doubt > 0.25 * (hi - lo) {
            return None;
        }
        about = s;
        let step = first.max(doubt / 16.0);
        at = [-64.0, -16.0, -4.0, -1.0, 1.0, 4.0, 16.0, 64.0].map(|k| s + k * step);
    }
    None
}

/// The certain signs of eight bounds.
pub(super) fn signs(v: &I8) -> [Option<bool>; 8] {
    core::array::from_fn(|i| {
        if v.partial >> i & 1 == 1 {
            None
        } else if v.lo.0[i] > 0.0 {
            Some(true)
        } else if v.hi.0[i] < 0.0 {
            Some(false)
        } else {
            None
        }
    })
}
