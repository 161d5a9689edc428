//! The parameter of a crossing with a curved wall on the ray: a quotient of two cubics in the
//! curve's parameter.
//!
//! ```text
//!   linear   s = d·(c(u) - o) / d·d              o, d without their heights
//!   conic    s = p·C / q·C,  C = (x(u), 1, z(u)),  relative to the apex,
//!            p = (o·d) o - (o·o) d,  q = (o·d) d - (d·d) o
//! ```

use super::Sweep;
use super::exact::Exactly;
use super::forms::{Form, along, value};
use super::profile_curve::ProfileCurve;
use super::profile_hits::{Meet, Scan};
use crate::planar::{Crossing, Line, Probe, dot, quotient_bounds, with_denominator_near_one};
use crate::{End, RingRay};
use core::cmp::Ordering;
use durer_math::{Dd, Dyadic, EFloat, Isa, Ring, U};

/// The forms of the numerator and the denominator. The denominator of a linear sweep is positive.
#[inline(always)]
pub(super) fn quotient<T: Ring>(sweep: Sweep, ray: &RingRay<T>) -> (Form<T>, Form<T>) {
    let (o, d) = (&ray.o, &ray.d);
    match sweep {
        Sweep::Linear => {
            let [x, z] = [d[0].clone(), d[2].clone()];
            let back = o[0].clone() * x.clone() + o[2].clone() * z.clone();
            let w = || ray.w.clone();
            let zero = || T::exact(0.0);
            let num = [w() * x.clone(), -back, w() * z.clone()];
            (num, [zero(), x.square() + z.square(), zero()])
        }
        Sweep::Conic => {
            let (oo, od, dd) = (dot(o, o), dot(o, d), dot(d, d));
            #[inline(always)]
            fn row<T: Ring>(a: &T, x: &T, b: &T, y: &T) -> T {
                a.clone() * x.clone() - b.clone() * y.clone()
            }
            let num = [row(&od, &o[0], &oo, &d[0]), row(&od, &o[1], &oo, &d[1]), row(&od, &o[2], &oo, &d[2])];
            let den = [row(&od, &d[0], &dd, &o[0]), row(&od, &d[1], &dd, &o[1]), row(&od, &d[2], &dd, &o[2])];
            (num, den)
        }
    }
}

/// A ray, and the curves of a prism that it cuts.
pub(super) struct Places<'a, 'r> {
    pub(super) probe: &'a Probe<'r>,
    pub(super) scan: &'a Scan<'a, Probe<'r>>,
}

impl<'a, 'r> Places<'a, 'r> {
    #[inline(always)]
    pub(super) fn new(probe: &'a Probe<'r>, scan: &'a Scan<'a, Probe<'r>>) -> Self {
        Self { probe, scan }
    }

    /// The crossing in the form of a crossing with a plane; its sign is not set.
    #[inline(always)]
    pub(super) fn crossing(&self, piece: &ProfileCurve, meet: &Meet) -> Crossing {
        let c = ProfileCurve::at(&piece.powers, &meet.running());
        let (num, den) = quotient(self.scan.view.sweep, &self.probe.running());
        let s = value(&num, c) / value(&den, c);
        let first = self.probe.bracketed(s.v, s.lo(), s.hi(), Ordering::Equal);
        if self.probe.is_narrow(&first) { first } else { self.crossing_climb(piece, meet).unwrap_or(first) }
    }

    #[cold]
    #[inline(never)]
    fn crossing_climb(&self, piece: &ProfileCurve, meet: &Meet) -> Option<Crossing> {
        Isa::detect().run(
            #[inline(always)]
            || {
                let wide = self.in_double_double(piece, meet);
                match wide {
                    Some(crossing) if self.probe.is_narrow(&crossing) => wide,
                    _ => self.exactly(piece, meet).or(wide),
                }
            },
        )
    }

    /// The root by Newton's method. Each end of its bracket has a certain sign, or is an end of the
    /// given bracket.
    #[inline(always)]
    fn in_double_double(&self, piece: &ProfileCurve, meet: &Meet) -> Option<Crossing> {
        let ray = with_denominator_near_one(self.probe.double()?);
        let powers = piece.in_powers::<EFloat<Dd>>(self.scan.view);
        let (n, _) = self.scan.forms(&ray)?;
        let g = along(&n, &powers);
        #[inline(always)]
        fn value_at(g: &[EFloat<Dd>; 4], y: Dd) -> EFloat<Dd> {
            let y = EFloat::with_error(y, 0.0);
            ((g[3] * y + g[2]) * y + g[1]) * y + g[0]
        }
        let slope = |y: f64| {
            let [_, a, b, c] = g.map(EFloat::value);
            (3.0 * c * y + 2.0 * b) * y + a
        };
        let mut y = Dd::from(meet.y);
        for _ in 0..3 {
            let step = value_at(&g, y).v / Dd::from(slope(y.hi));
            if step.hi.is_nan() || step.hi.abs() > meet.hi - meet.lo {
                break;
            }
            y = y - step;
        }
        let here = value_at(&g, y);
        let room = 4.0 * (here.magnitude() + here.e) / slope(y.hi).abs();
        if !(room.is_finite() && meet.turn != 0) {
            return None;
        }
        let end = |away: f64, limit: f64| {
            let end = y + Dd::from(away * room);
            let beyond = if away < 0.0 { end.hi <= limit } else { end.hi >= limit };
            if beyond {
                return Some(Dd::from(limit));
            }
            let sign = value_at(&g, end).sign()?;
            ((sign as i8) * meet.turn == if away < 0.0 { -1 } else { 1 }).then_some(end)
        };
        let (lo, hi) = (end(-1.0, meet.lo)?, end(1.0, meet.hi)?);
        // |y| <= 1/2, and a difference rounds by less than 2^-100 of it.
        let most = (y - lo).hi.abs().max((hi - y).hi.abs()) * (1.0 + 4.0 * U) + durer_math::scale::pow2(-100);
        let c = ProfileCurve::at(&powers, &EFloat::with_error(y, most));
        let (num, den) = quotient(self.scan.view.sweep, &ray);
        let s = value(&num, c) / value(&den, c);
        Some(self.probe.bracketed(s.value(), s.lo(), s.hi(), Ordering::Equal))
    }

    /// The root by bisection in exact numbers, until the quotient is narrow enough.
    fn exactly(&self, piece: &ProfileCurve, meet: &Meet) -> Option<Crossing> {
        let ray = self.probe.exact()?;
        let powers = piece.in_powers::<Dyadic>(self.scan.view);
        let (n, _) = self.scan.forms(&ray)?;
        let mut found = Exactly::new(along(&n, &powers).to_vec(), meet)?;
        let (num, den) = quotient(self.scan.view.sweep, &ray);
        let [num, den] = [num, den].map(|f| along(&f, &powers));
        // |y| <= 1/2: the slope of Σ a_k y^k is no more than Σ |a_k|, as k / 2^(k-1) <= 1.
        let slope = |p: &[Dyadic; 4]| p[1..].iter().fold(Dyadic::ZERO, |sum, a| &sum + &a.clone().abs());
        let mut best = None;
        for bits in [120, 240, 480, 960, 1920, 3840] {
            let (l, r) = found.narrowed(-bits);
            let width = &r - &l;
            let about = |p: &[Dyadic; 4]| {
                let v = p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * &l) + a);
                let e = &width * &slope(p);
                (&v - &e, &v + &e)
            };
            let ((n0, n1), (d0, d1)) = (about(&num), about(&den));
            if d0.exact_sign() != d1.exact_sign() || d0.is_zero() {
                continue;
            }
            let ((a, b), (c, d)) = (quotient_bounds(&n0, &n1, &d0), quotient_bounds(&n0, &n1, &d1));
            let (lo, hi) = (a.min(c), b.max(d));
            let s = (0.5 * lo + 0.5 * hi).clamp(f64::MIN, f64::MAX);
            let crossing = self.probe.bracketed(s, lo, hi, Ordering::Equal);
            best = Some(crossing);
            if self.probe.is_narrow(&crossing) || l == r {
                break;
            }
        }
        best
    }

    /// [`Places::is_in_range`] in f64, relative to the ends of the range: their points do not have
    /// the rounding of the closest approach.
    #[inline(always)]
    fn is_surely_in_range(&self, piece: &ProfileCurve, meet: &Meet, crossing: &Crossing) -> Option<bool> {
        let c = ProfileCurve::at(&piece.powers, &meet.running());
        let mut all = true;
        for end in [End::Min, End::Max] {
            let t = self.probe.ray.end(end);
            let (surely, never) = match end {
                End::Min => (crossing.lo >= t, crossing.hi < t),
                End::Max => (crossing.hi <= t, crossing.lo > t),
            };
            if never {
                return Some(false);
            }
            if surely {
                continue;
            }
            let (p, e) = self.probe.ray.point_at_end(end);
            let o =
                [EFloat::with_error(p.x, e.x), EFloat::with_error(p.y, e.y), EFloat::with_error(p.z, e.z)];
            let (num, den) = quotient(
                self.scan.view.sweep,
                &RingRay { o, d: self.probe.running().d, w: EFloat::exact(1.0) },
            );
            let after = match (value(&num, c).sign()?, value(&den, c).sign()?) {
                (Ordering::Equal, _) | (_, Ordering::Equal) => return None,
                (num, den) => num == den,
            };
            all &= after == (end == End::Min);
        }
        Some(all)
    }

    /// Whether a crossing whose bracket straddles an end of the ray's range is in the range.
    #[inline(never)]
    pub(super) fn is_in_range(&self, piece: &ProfileCurve, meet: &Meet, crossing: &Crossing) -> bool {
        let holds = Isa::detect().run(
            #[inline(always)]
            || self.is_surely_in_range(piece, meet, crossing),
        );
        holds.unwrap_or_else(|| self.is_exactly_in_range(piece, meet, crossing))
    }

    #[cold]
    #[inline(never)]
    fn is_exactly_in_range(&self, piece: &ProfileCurve, meet: &Meet, crossing: &Crossing) -> bool {
        let Some(ray) = self.probe.exact() else { return true };
        let powers = piece.in_powers::<Dyadic>(self.scan.view);
        let found = self.scan.forms(&ray).and_then(|(n, _)| Exactly::new(along(&n, &powers).to_vec(), meet));
        let Some(found) = found else { return true };
        let (num, den) = quotient(self.scan.view.sweep, &ray);
        let positive = found.sign(&along(&den, &powers)).is_gt();
        let holds = |end: End| {
            let at = self.probe.ray.end(end);
            let (surely, never) = match end {
                End::Min => (crossing.lo >= at, crossing.hi < at),
                End::Max => (crossing.hi <= at, crossing.lo > at),
            };
            if surely || never {
                return surely;
            }
            let s = self.probe.ray.end_in_ring::<Dyadic>(end);
            let past = [0, 1, 2].map(|i: usize| &num[i] - &(&den[i] * &s));
            let past = found.sign(&along(&past, &powers));
            match (end == End::Min, positive) {
                (true, true) | (false, false) => past.is_ge(),
                _ => past.is_le(),
            }
        };
        holds(End::Min) && holds(End::Max)
    }
}

/// The exact sign of `a t² + 2 b t + c` at a crossing; `t` is the ray's own parameter.
pub(super) fn sign_at<L: Line>(
    scan: &Scan<'_, L>,
    ray: &RingRay<Dyadic>,
    piece: &ProfileCurve,
    meet: &Meet,
    [a, b, c]: [&Dyadic; 3],
) -> Option<Ordering> {
    let powers = piece.in_powers::<Dyadic>(scan.view);
    let (n, _) = scan.forms(ray)?;
    let found = Exactly::new(along(&n, &powers).to_vec(), meet)?;
    let (num, den) = quotient(scan.view.sweep, ray);
    let [num, den] = [num, den].map(|f| along(&f, &powers));
    let (nn, nd, dd) = (product(&num, &num), product(&num, &den), product(&den, &den));
    let terms = nn.iter().zip(&nd).zip(&dd);
    let q: Vec<_> = terms.map(|((x, y), z)| &(&(a * x) + &(b * y).scale2(1)) + &(c * z)).collect();
    Some(found.sign(&q))
}

/// The product of two polynomials.
pub(super) fn product(p: &[Dyadic], q: &[Dyadic]) -> Vec<Dyadic> {
    let mut out = vec![Dyadic::ZERO; p.len() + q.len() - 1];
    for (i, p) in p.iter().enumerate() {
        for (j, q) in q.iter().enumerate() {
            out[i + j] = &out[i + j] + &(p * q);
        }
    }
    out
}
