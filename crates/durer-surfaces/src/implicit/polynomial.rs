//! Formulas that are polynomials along a line: isolation by Bernstein coefficients.
//!
//! ```text
//!   g(mid + s) = Σ c_k s^k,    each c_k within e_k      (tape/powers.rs)
//! ```
//!
//! Interval arithmetic ignores the dependence between a formula's steps: where a line touches a
//! surface at a point where it crosses itself, the sum of the terms is smaller than the terms by
//! orders of magnitude, and stretches would have to be that short. The polynomial has the terms
//! already added. Its Bernstein coefficients, or those of its slope (`roots/bernstein.rs`), are
//! computed for each half, each half of that, and so on, until they have one sign or are all within
//! their error. In the latter case the polynomial is computed anew about the middle of that part,
//! where its terms are smaller and so is their rounding. If that does not help either, the
//! formula's own steps are evaluated.

use super::isolate::isolate;
use super::line::BoundedLine;
use super::root_isolator::SignInfo;
use durer_formula::{Powers, Tape};
use durer_math::{Isa, U};
use durer_roots::bernstein::{Bernstein, FLOOR};

/// Places must be rounded by less than this part of a stretch, or the polynomial is not used: `(1 +
/// 1/64)^15 < 4/3` bounds the growth of a slope.
const NEAR: f64 = 1.0 / 64.0;

/// Isolates the roots in `[lo, hi]`, as [`isolate`] does, if the formula is a polynomial of at most
/// this degree.
pub(super) fn isolate_powers(
    (line, tape, degree): (&BoundedLine, &Tape, usize),
    ends: (f64, f64),
    passes: &mut u32,
    take: &mut dyn FnMut(f64, f64, SignInfo) -> bool,
) -> bool {
    match degree {
        0..=4 => Halves::<5>::of((line, tape), ends, passes, take),
        5..=8 => Halves::<9>::of((line, tape), ends, passes, take),
        _ => Halves::<{ Powers::LEN }>::of((line, tape), ends, passes, take),
    }
}

impl BoundedLine {
    /// The formula along the line from `mid` on, if it is a polynomial.
    fn powers(&self, tape: &Tape, mid: f64) -> Powers {
        let at = self.point(mid);
        tape.along(&[0, 1, 2].map(|i| Powers::line([at[i], self.d[i]], [self.err[i], self.d_err[i]])))
    }
}

/// A stretch with its middle and half length, and its parts that are decided.
struct Halves<'a, const N: usize> {
    line: &'a BoundedLine,
    tape: &'a Tape,
    lo: f64,
    hi: f64,
    mid: f64,
    half: f64,
}

/// The polynomial and its slope on a part, from `l` to `r` of `[-1, 1]`.
struct PolynomialPart<const N: usize> {
    value: Bernstein<f64, N>,
    slope: Bernstein<f64, N>,
    l: f64,
    r: f64,
}

impl<const N: usize> Halves<'_, N> {
    fn of(
        (line, tape): (&BoundedLine, &Tape),
        (lo, hi): (f64, f64),
        passes: &mut u32,
        take: &mut dyn FnMut(f64, f64, SignInfo) -> bool,
    ) -> bool {
        let mid = 0.5 * lo + 0.5 * hi;
        let half = (hi - mid).max(mid - lo) * (1.0 + 2.0 * U);
        // The rounding of places, in units of `half`, which may be zero.
        let moved = (mid.abs() + half) * (4.0 * U) / half;
        let is_near = moved < NEAR;
        if !is_near {
            return isolate(line, tape, (lo, hi), passes, take);
        }
        let p = line.powers(tape, mid);
        *passes += 1;
        let whole = Isa::detect().run(
            #[inline(always)]
            || PolynomialPart::new(&p, half, moved),
        );
        Halves::<N> { line, tape, lo, hi, mid, half }.classify(&whole, passes, take)
    }

    /// The place on the line, rounded; its error is included in the coefficients.
    fn place(&self, x: f64) -> f64 {
        (self.half * x + self.mid).max(self.lo).min(self.hi)
    }

    fn classify(
        &self,
        node: &PolynomialPart<N>,
        passes: &mut u32,
        take: &mut dyn FnMut(f64, f64, SignInfo) -> bool,
    ) -> bool {
        // The first and last ends are exactly the given ones.
        let a = if node.l == -1.0 { self.lo } else { self.place(node.l) };
        let b = if node.r == 1.0 { self.hi } else { self.place(node.r) };
        if let Some(sign) = node.value.one_sign() {
            return take(a, b, SignInfo::Sign(sign));
        }
        if let Some(rises) = node.slope.one_sign() {
            return take(a, b, SignInfo::Monotone(rises));
        }
        let is_whole = node.r - node.l == 2.0;
        match (node.value.tells(), b - a > self.line.ulp) {
            (true, true) => {}
            (false, true) if !is_whole => {
                return Self::of((self.line, self.tape), (a, b), passes, take);
            }
            _ => return isolate(self.line, self.tape, (a, b), passes, take),
        }
        let [left, right] = Isa::detect().run(
            #[inline(always)]
            || node.halves(),
        );
        self.classify(&left, passes, take) && self.classify(&right, passes, take)
    }
}

impl<const N: usize> PolynomialPart<N> {
    /// All of `half x`, where places are rounded by at most `moved`.
    #[inline(always)]
    fn new(p: &Powers, half: f64, moved: f64) -> Self {
        let (mut c, mut e) = ([0.0_f64; N], [0.0_f64; N]);
        let mut power = 1.0;
        for k in 0..N {
            // Scaled, by k + 1 roundings.
            c[k] = p.c[k] * power;
            e[k] = (p.e[k] * power + c[k].abs() * ((k + 1) as f64 * U)) * (1.0 + 64.0 * U) + FLOOR;
            power *= half;
        }
        let (mut d, mut e_d) = ([0.0_f64; N], 0.0);
        let (mut first, mut second) = (0.0, 0.0);
        for k in 1..N {
            let n = k as f64;
            d[k - 1] = n * c[k];
            e_d += n * (e[k] + c[k].abs() * U);
            first += n * c[k].abs();
            second += n * (n - 1.0) * c[k].abs();
        }
        let slack =
            |errors: f64, steep: f64| (errors + moved * steep * (4.0 / 3.0)) * (1.0 + 64.0 * U) + FLOOR;
        let value = Bernstein::quick(&c, slack(e.iter().sum(), first));
        let slope = Bernstein::quick(&d, slack(e_d, second));
        Self { value, slope, l: -1.0, r: 1.0 }
    }

    #[inline(always)]
    fn halves(&self) -> [Self; 2] {
        let (value, slope) = (self.value.split(0.5), self.slope.split(0.5));
        let m = 0.5 * self.l + 0.5 * self.r;
        [
            Self { value: value.0, slope: slope.0, l: self.l, r: m },
            Self { value: value.1, slope: slope.1, l: m, r: self.r },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LocalRay;
    use crate::laws::TestRng;
    use durer_formula::{Builder, NodeId, Op};
    use durer_math::scale::pow2;
    use durer_math::{Dyadic, Point3, Ray, Vec3};

    /// J. Steiner's Roman surface, `x²y² + y²z² + z²x² - 2xyz`, which crosses itself along the
    /// axes.
    fn roman() -> Tape {
        let mut b = Builder::new();
        let mut op = |op| b.push(op).unwrap();
        let [x, y, z] = [0, 1, 2].map(|i| op(Op::Input(i)));
        let squares: [NodeId; 3] = [x, y, z].map(|i| op(Op::Sqr(i)));
        let [xy, yz, zx] = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| op(Op::Mul(squares[i], squares[j])));
        let (product, two) = (op(Op::Mul(x, y)), op(Op::Constant(2.0.into())));
        let product = op(Op::Mul(product, z));
        let product = op(Op::Mul(two, product));
        let sum = op(Op::Add(xy, yz));
        let sum = op(Op::Add(sum, zx));
        let root = op(Op::Sub(sum, product));
        Tape::new(&b.finish(root, 3))
    }

    fn exactly(ray: &Ray, s: f64) -> Dyadic {
        let at = |o: f64, d: f64| &Dyadic::from(o) + &(&Dyadic::from(d) * &Dyadic::from(s));
        let (o, d) = (ray.origin, ray.direction);
        let [x, y, z] = [at(o.x, d.x), at(o.y, d.y), at(o.z, d.z)];
        let [xx, yy, zz] = [&x * &x, &y * &y, &z * &z];
        let sum = &(&(&xx * &yy) + &(&yy * &zz)) + &(&zz * &xx);
        &sum - &(&(&(&x * &y) * &z) * &Dyadic::from(2.0))
    }

    /// What is reported of stretches is true, the stretches cover the line, and next to points
    /// where the surface crosses itself little stays undecided.
    #[test]
    fn what_is_told_of_stretches_is_so() {
        let tape = roman();
        let (mut signs, mut ways, mut passes) = (0, 0, 0);
        for seed in 0..2000 {
            let mut dice = TestRng::new(seed);
            let on = [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0; 3], [0.5, 0.5, 0.75]][dice.below(4) as usize];
            let ways_along = [[1.0, 1.0, 1.0], [0.5, -0.25, 0.25], [1.0, 0.0, 0.5], [-0.25, 1.0, 0.75]];
            let d = Vec3::from(ways_along[dice.below(4) as usize]);
            let d = if dice.below(3) == 0 { dice.vector() } else { d };
            let back = if dice.below(2) == 0 { 0.0 } else { dice.unit() };
            let ray = Ray::new(Point3::from(on) - d * back, d);
            let local = LocalRay::new(&ray);
            let at = local.recentre(Point3::ORIGIN, 0);
            let line = BoundedLine::new(&at, 4.0);
            let (lo, hi) = (-2.0 * dice.unit().abs() - 0.5, 2.0 * dice.unit().abs() + 0.5);
            let mut here = lo;
            let mut open = 0.0;
            let all = isolate_powers((&line, &tape, 4), (lo, hi), &mut passes, &mut |a, b, verdict| {
                assert!(a == here && b >= a, "{seed}: {a} {b} {here}");
                here = b;
                // The point of the exact line at the same parameter of the ray.
                let of_ray = |s: f64| at.t(s);
                let places: Vec<f64> = (0..=8).map(|k| ((b - a) * f64::from(k) / 8.0 + a).min(b)).collect();
                let values: Vec<Dyadic> = places.iter().map(|&s| exactly(&ray, of_ray(s))).collect();
                match verdict {
                    SignInfo::Sign(sign) => {
                        signs += 1;
                        assert!(values.iter().all(|v| v.exact_sign().is_gt() == sign), "{seed}: {a} {b}");
                    }
                    SignInfo::Monotone(rises) => {
                        ways += 1;
                        // Places that the ray's own parameter cannot separate prove nothing.
                        for pair in values.windows(2).filter(|_| b - a > pow2(-30)) {
                            let step = (&pair[1] - &pair[0]).exact_sign();
                            assert!(if rises { step.is_gt() } else { step.is_lt() }, "{seed}: {a} {b}");
                        }
                    }
                    SignInfo::Gap => panic!("{seed}: a polynomial is defined everywhere"),
                    SignInfo::Unresolved => open += b - a,
                }
                true
            });
            assert!(all && here == hi);
            // Where a triple root is below the roundings of the terms, which are few and below 8:
            // `|s|³ <= 2^-45`.
            assert!(open < pow2(-14), "{seed}: {open}");
        }
        assert!(signs > 5000 && ways > 1000, "{signs} {ways} {passes}");
    }
}
