//! Exact decisions about crossings with a lathe.
//!
//! The root `w` of a piece's equation is an algebraic number, and so is the parameter `s` of the
//! crossing: `s = Y(w) / d_y` on a slanted ray, a root of a quadratic with coefficients in `w` on a
//! level one. The sign of a polynomial in `s` is that of a polynomial in `w`.

use super::crossings::{Crossed, Pass};
use super::forms::{Equation, exact_equation};
use super::profile::Profile;
use crate::planar::{Line, quotient_bounds};
use crate::prism::curved::exact::Exactly;
use crate::prism::curved::profile_hits::Meet;
use crate::{End, RingRay};
use core::cmp::Ordering;
use durer_math::{Dyadic, EFloat, Ring};

/// A polynomial, the constant first.
type Poly = Vec<Dyadic>;

pub(super) fn product(p: &[Dyadic], q: &[Dyadic]) -> Poly {
    let mut out = vec![Dyadic::ZERO; (p.len() + q.len()).saturating_sub(1)];
    for (i, p) in p.iter().enumerate().filter(|(_, p)| !p.is_zero()) {
        for (j, q) in q.iter().enumerate() {
            out[i + j] = &out[i + j] + &(p * q);
        }
    }
    out
}

fn times(x: &Dyadic, p: &[Dyadic]) -> Poly {
    p.iter().map(|p| x * p).collect()
}

fn sum(p: &[Dyadic], q: &[Dyadic]) -> Poly {
    let at = |p: &[Dyadic], i: usize| p.get(i).cloned().unwrap_or(Dyadic::ZERO);
    (0..p.len().max(q.len())).map(|i| &at(p, i) + &at(q, i)).collect()
}

/// A crossing with an exact ray.
struct ExactCrossing<'a> {
    profile: &'a Profile,
    piece: usize,
    equation: Equation,
    branch: i8,
    ray: &'a RingRay<Dyadic>,
    root: Exactly,
}

/// `A`, `B` and `D` of a ray (`forms.rs`).
fn about_axis(ray: &RingRay<Dyadic>) -> [Dyadic; 3] {
    let ([ox, _, oz], [dx, _, dz]) = (&ray.o, &ray.d);
    [&(dx * dx) + &(dz * dz), &(ox * dx) + &(oz * dz), &(ox * dz) - &(oz * dx)]
}

/// `Δ` of a ray and a piece, as a polynomial in `w`.
fn discriminant(profile: &Profile, piece: usize, ray: &RingRay<Dyadic>) -> Poly {
    let [a, _, across] = about_axis(ray);
    let r = profile.powers::<Dyadic>(piece).0.map(|r| &r * &ray.w);
    let mut out = times(&a, &product(&r, &r));
    out[0] = &out[0] - &(&across * &across);
    out
}

impl<'a> ExactCrossing<'a> {
    fn new(
        profile: &'a Profile,
        (piece, meet, equation, branch): (usize, &Meet, Equation, i8),
        ray: &'a RingRay<Dyadic>,
    ) -> Option<Self> {
        let root = Exactly::new(exact_equation(equation, profile, piece, ray), meet)?;
        Some(Self { profile, piece, equation, branch, ray, root })
    }

    /// `Y(w)`.
    fn above(&self) -> Poly {
        let mut y = times(&self.ray.w, &self.profile.powers::<Dyadic>(self.piece).1);
        y[0] = &y[0] - &self.ray.o[1];
        y
    }

    /// The sign of `a s² + 2 b s + c`.
    fn sign(&self, [a, b, c]: [&Dyadic; 3]) -> Ordering {
        if self.equation == Equation::Slanted {
            let (y, dy) = (self.above(), &self.ray.d[1]);
            let q = sum(&times(a, &product(&y, &y)), &times(&(b * dy).scale2(1), &y));
            let q = sum(&q, &[&(c * dy) * dy]);
            return self.root.sign(&q);
        }
        // With A s² = -2 B s - K and A s = -B + σ √Δ, A² times the value is M + N σ √Δ.
        let [big_a, big_b, _] = about_axis(self.ray);
        let delta = discriminant(self.profile, self.piece, self.ray);
        // A K = B² - Δ.
        let ak = sum(&[&big_b * &big_b], &times(&Dyadic::from(-1.0), &delta));
        let n = (&(b * &big_a) - &(a * &big_b)).scale2(1);
        let m = &(&(c * &big_a) * &big_a) - &(&big_b * &n);
        let m = sum(&[m], &times(&-a.clone(), &ak));
        let is_double = self.branch == 0 || self.root.sign(&delta).is_le();
        let of_m = self.root.sign(&m);
        let of_n = if is_double { Ordering::Equal } else { n.exact_sign() };
        let of_n = if self.branch < 0 { of_n.reverse() } else { of_n };
        match (of_m, of_n) {
            (m, Ordering::Equal) => m,
            (Ordering::Equal, n) => n,
            (m, n) if m == n => m,
            _ => {
                let squares = sum(&product(&m, &m), &times(&-(&n * &n), &delta));
                match self.root.sign(&squares) {
                    Ordering::Greater => of_m,
                    Ordering::Less => of_n,
                    Ordering::Equal => Ordering::Equal,
                }
            }
        }
    }

    /// The key that orders crossings of one branch along the ray: `±Y(w)`, or `±r(w)²`, in an interval.
    fn key(&mut self, bits: i32) -> (Dyadic, Dyadic) {
        let (p, falls) = match self.equation {
            Equation::Slanted => (self.above(), self.ray.d[1].exact_sign().is_lt()),
            Equation::Level => {
                let r = self.profile.powers::<Dyadic>(self.piece).0;
                (product(&r, &r), self.branch < 0)
            }
        };
        let (lo, hi) = self.range(&p, bits);
        if falls { (-hi, -lo) } else { (lo, hi) }
    }

    /// An interval that holds the value of a polynomial at the root.
    fn range(&mut self, p: &[Dyadic], bits: i32) -> (Dyadic, Dyadic) {
        let (l, r) = self.root.narrowed(-bits);
        let v = p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * &l) + a);
        // |w| <= 1/2: the slope of Σ a_k w^k is no more than Σ |a_k|, as k / 2^(k-1) <= 1.
        let slope = p.iter().skip(1).fold(Dyadic::ZERO, |sum, a| &sum + &a.clone().abs());
        let e = &(&r - &l) * &slope;
        (&v - &e, &v + &e)
    }
}

impl Pass<'_, '_> {
    fn exact<'s>(&'s self, crossed: &Crossed, ray: &'s RingRay<Dyadic>) -> Option<ExactCrossing<'s>> {
        let Crossed { piece, meet, branch, .. } = crossed;
        ExactCrossing::new(&self.lathe.profile, (*piece, meet, self.equation, *branch), ray)
    }

    /// The sign of `Δ` at a root of a level ray.
    #[cold]
    #[inline(never)]
    pub(super) fn exact_discriminant(&self, i: usize, meet: &Meet) -> Option<Ordering> {
        let (ray, profile) = (self.probe.exact()?, &self.lathe.profile);
        let root = Exactly::new(exact_equation(self.equation, profile, i, &ray), meet)?;
        Some(root.sign(&discriminant(profile, i, &ray)))
    }

    /// The order of two crossings along the ray; equal if they are at one point, or nearer to each
    /// other than `2^-200`, times the slope of a ray that is almost level, or if the ray is not
    /// exactly known.
    #[cold]
    #[inline(never)]
    pub(super) fn order(&self, a: &Crossed, b: &Crossed) -> Ordering {
        if self.equation == Equation::Level && a.branch != b.branch {
            return a.branch.cmp(&b.branch);
        }
        let Some(ray) = self.probe.exact() else { return a.at.s.total_cmp(&b.at.s) };
        let (Some(mut a), Some(mut b)) = (self.exact(a, &ray), self.exact(b, &ray)) else {
            return Ordering::Equal;
        };
        // The height of a ray that is almost level hardly changes between two crossings: beside the
        // lowest point of a profile, where they are as near as the ray is level, by the square of that.
        let steep = ray.d[1].exponent().map_or(0, |e| i32::try_from(-e).unwrap_or(0).clamp(0, 2200));
        for bits in [80, 250 + steep, 250 + 2 * steep] {
            let ((a_lo, a_hi), (b_lo, b_hi)) = (a.key(bits), b.key(bits));
            if a_hi < b_lo {
                return Ordering::Less;
            }
            if b_hi < a_lo {
                return Ordering::Greater;
            }
        }
        Ordering::Equal
    }

    /// Whether a crossing whose bracket straddles an end of the ray's range is in the range.
    #[cold]
    #[inline(never)]
    pub(super) fn is_in_range(&self, crossed: &Crossed) -> bool {
        let Some(ray) = self.probe.exact() else { return true };
        let Some(exact) = self.exact(crossed, &ray) else { return true };
        let holds = |end: End| {
            let (t, at) = (self.probe.ray.end(end), crossed.at);
            let (surely, never) = match end {
                End::Min => (at.lo >= t, at.hi < t),
                End::Max => (at.hi <= t, at.lo > t),
            };
            if surely || never {
                return surely;
            }
            let s = self.probe.ray.end_in_ring::<Dyadic>(end);
            let past = exact.sign([&Dyadic::ZERO, &Dyadic::from(0.5), &-s]);
            if end == End::Min { past.is_ge() } else { past.is_le() }
        };
        holds(End::Min) && holds(End::Max)
    }

    /// The bracket by exact arithmetic, until it is narrow enough.
    pub(super) fn exactly(&self, crossed: &Crossed) -> Option<Crossed> {
        let ray = self.probe.exact()?;
        let mut exact = self.exact(crossed, &ray)?;
        let mut best = None;
        for bits in [120, 240, 480, 960, 1920, 3840] {
            let (s, lo, hi) = match self.equation {
                Equation::Slanted => {
                    let above = exact.above();
                    let (n0, n1) = exact.range(&above, bits);
                    let (lo, hi) = quotient_bounds(&n0, &n1, &ray.d[1]);
                    (0.5 * lo + 0.5 * hi, lo, hi)
                }
                Equation::Level => {
                    let delta = discriminant(&self.lathe.profile, crossed.piece, &ray);
                    let (d0, d1) = exact.range(&delta, bits);
                    let run = |x: &Dyadic| {
                        let (lo, hi) = x.to_bounds();
                        EFloat::with_error(0.5 * lo + 0.5 * hi, hi - lo)
                    };
                    // The numbers may have a common factor beyond the range of f64.
                    let [a, b, _] = about_axis(&ray);
                    let k = i32::try_from(a.exponent().unwrap_or(0)).unwrap_or(0) & !1;
                    let [a, b] = [a, b].map(|x| run(&x.scale2(-k)));
                    let (h0, h1) = (run(&d0.scale2(-2 * k)).sqrt(), run(&d1.scale2(-2 * k)).sqrt());
                    let zero = EFloat::zero();
                    let h0 = if h0.v.is_nan() { zero } else { h0 };
                    let (near, far) = match crossed.branch {
                        0 => (zero, zero),
                        1.. => (h0, h1),
                        _ => (-h1, -h0),
                    };
                    let (lo, hi) = (((near - b) / a).lo(), ((far - b) / a).hi());
                    (0.5 * lo + 0.5 * hi, lo, hi)
                }
            };
            let at = self.probe.bracketed(s.clamp(f64::MIN, f64::MAX), lo, hi, crossed.at.sign.cmp(&0));
            best = Some(Crossed { at, ..*crossed });
            if self.probe.is_narrow(&at) {
                break;
            }
        }
        best
    }
}

/// The exact sign of `a t² + 2 b t + c` at a crossing; `t` is the ray's own parameter.
pub(super) fn sign_at(
    pass: &Pass<'_, '_>,
    crossed: &Crossed,
    ray: &RingRay<Dyadic>,
    q: [&Dyadic; 3],
) -> Option<Ordering> {
    Some(pass.exact(crossed, ray)?.sign(q))
}
