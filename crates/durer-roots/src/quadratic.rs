//! The quadratic `A s² + 2 B s + C`: its real roots in proven brackets, and exact signs at them.
//!
//! Roots are `q / A` and `C / q` with `q = -(B + sign(B) √(B² - AC))`, so that neither suffers
//! cancellation (W. H. Press et al., *Numerical Recipes*, 3rd ed. 2007, section 5.6); the
//! discriminant is formed by Kahan's `ab - cd` (C.-P. Jeannerod, N. Louvet, J.-M. Muller, "Further
//! analysis of Kahan's algorithm", *Mathematics of Computation* 82, 2013).
//!
//! A root is named by what the quadratic does there: it falls ([`Crossing::In`]), rises
//! ([`Crossing::Out`]) or touches zero. That name stays right while `A` passes through zero, where
//! "the lower root" does not.

use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::{Dd, Dyadic, EFloat, Ring, U, eft::difference_of_products};

/// `A s² + 2 B s + C`.
#[derive(Clone, Debug)]
pub struct Quadratic<T> {
    /// The factor of `s²`.
    pub a: T,
    /// Half the factor of `s`.
    pub b: T,
    /// The value at `s = 0`.
    pub c: T,
}

/// The behaviour of a quadratic at a root. It is negative inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// It falls through zero.
    In,
    /// It rises through zero.
    Out,
    /// It touches zero from above: outside, but for a point.
    TouchOutside,
    /// It touches zero from below: inside all along.
    TouchInside,
}

/// A root in its bracket.
#[derive(Clone, Copy, Debug)]
pub struct LineRoot {
    /// The place: a rounded value in the bracket.
    pub s: f64,
    /// The lower end of the bracket.
    pub lo: f64,
    /// The upper end of the bracket.
    pub hi: f64,
    /// How the line crosses or touches the zero set there.
    pub crossing: Crossing,
}

/// The roots that matter, in no order.
#[derive(Clone, Copy, Debug)]
pub struct LineRoots {
    /// The roots.
    pub roots: [Option<LineRoot>; 2],
    /// There is no root, and all of the line is strictly outside.
    pub outside: bool,
}

/// Where roots matter, and how narrow their brackets should be.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Roots below are of no interest.
    pub lo: f64,
    /// Roots above are of no interest.
    pub hi: f64,
    /// `t = 2^k (origin + s)`.
    pub origin: f64,
    /// How wide a bracket may be, relative to `max(|t|, size / |d|)`.
    pub width: f64,
}

/// 24 to 48 ulp: `U |t|` is between half an ulp of `t` and one.
pub const NARROW: f64 = 48.0 * U;

impl Limits {
    /// In units of `s` sizes are about 1, and `|d|` is about 2. For unbounded surfaces the distance
    /// from their centre counts as a size.
    #[inline(always)]
    fn allows(&self, lo: f64, hi: f64, s: f64) -> bool {
        self.width == f64::INFINITY || hi - lo <= self.width * (self.origin + s).abs().max(s.abs()).max(0.5)
    }
}

/// The number `value 2^k` in its enclosure, and its sign if that is certain.
#[derive(Clone, Copy, Debug)]
pub struct SignedEnclosure {
    /// The value, and a bound on its error.
    pub value: EFloat,
    /// The exponent of its factor.
    pub k: i32,
    /// The sign; `None` if it is not certain.
    pub sign: Option<Ordering>,
}

impl From<EFloat> for SignedEnclosure {
    #[inline(always)]
    fn from(value: EFloat) -> Self {
        Self { value, k: 0, sign: value.sign() }
    }
}

impl From<&EFloat<Dd>> for SignedEnclosure {
    fn from(x: &EFloat<Dd>) -> Self {
        let e = (x.v.lo.abs() + x.e) * (1.0 + 4.0 * U);
        Self { value: EFloat::with_error(x.v.hi, e), k: 0, sign: x.sign() }
    }
}

impl From<&Dyadic> for SignedEnclosure {
    fn from(x: &Dyadic) -> Self {
        let (lo, hi) = x.to_bounds();
        Self { value: EFloat::with_error(x.to_f64(), hi - lo), k: 0, sign: x.sign() }
    }
}

impl SignedEnclosure {
    /// The number with an exponent of its own, so that no size is too large or too small.
    pub fn of_any_size(x: &Dyadic) -> Self {
        let k = x.exponent().and_then(|e| i32::try_from(e).ok()).unwrap_or(0);
        Self { k, ..Self::from(&x.clone().scale2(-k)) }
    }
}

impl Quadratic<Dyadic> {
    /// Whether one of the two is a multiple of the other.
    pub fn is_parallel_to(&self, o: &Self) -> bool {
        let same = |x: &Dyadic, y: &Dyadic, u: &Dyadic, v: &Dyadic| (&(x * v) - &(y * u)).is_zero();
        same(&self.a, &self.b, &o.a, &o.b)
            && same(&self.b, &self.c, &o.b, &o.c)
            && same(&self.a, &self.c, &o.a, &o.c)
    }
}

impl<T: Ring> Quadratic<T> {
    /// `B² - AC`.
    pub fn discriminant(&self) -> T {
        self.b.clone().square() - self.a.clone() * self.c.clone()
    }

    /// The value at `n / m`, times `m²`.
    pub fn at_ratio(&self, n: &T, m: &T) -> T {
        let (an, bm) = (self.a.clone() * n.clone(), self.b.clone() * m.clone());
        (an + bm.scale2(1)) * n.clone() + self.c.clone() * m.clone().square()
    }

    /// Half the slope at `n / m`, times `m`.
    fn slope_at_ratio(&self, n: &T, m: &T) -> T {
        self.a.clone() * n.clone() + self.b.clone() * m.clone()
    }

    /// Half the derivative, as a quadratic.
    fn derivative(&self) -> Self {
        Self { a: T::exact(0.0), b: self.a.clone().scale2(-1), c: self.b.clone() }
    }
}

impl Quadratic<Dyadic> {
    /// Times the power of two that makes the larger of `|B|` and `√|B² - AC|` about one, so that
    /// f64 can hold what matters.
    #[must_use]
    pub fn at_unit_size(self) -> Self {
        let half = |x: Option<i64>| x.map(|e| e.div_euclid(2));
        let Some(size) = self.b.exponent().max(half(self.discriminant().exponent())) else { return self };
        let k = i32::try_from(-size).unwrap_or(0);
        Self { a: self.a.scale2(k), b: self.b.scale2(k), c: self.c.scale2(k) }
    }
}

impl Quadratic<EFloat> {
    /// The value at `s`.
    #[inline(always)]
    pub fn at(&self, s: EFloat) -> EFloat {
        // Doubling is exact.
        let b = EFloat::with_error(2.0 * self.b.v, 2.0 * self.b.e);
        (self.a * s + b) * s + self.c
    }

    /// `B² - AC` with Kahan's difference.
    #[inline(always)]
    pub fn kahan_discriminant(&self) -> EFloat {
        let (a, b, c) = (self.a, self.b, self.c);
        let v = difference_of_products(b.v, b.v, a.v, c.v);
        let inherited = b.e * (2.0 * b.v.abs() + b.e) + (a.v.abs() * c.e + a.e * (c.v.abs() + c.e));
        // 1.5 ulp of the difference itself; the last term pays for underflow of the residuals.
        let zero = (b.v == 0.0 || b.v.abs() > 1e-140) && (a.v == 0.0 || c.v == 0.0);
        let floor = if zero { 0.0 } else { 1e-290 };
        EFloat::with_error(v, (inherited + 3.0 * U * v.abs()) * (1.0 + 16.0 * U) + floor)
    }
}

/// The square root of a number that is certainly positive: `|√x - √v| = |x - v| / (√x + √v)`, and
/// `√x >= √v (1 - e/v)`.
#[inline(always)]
fn root_of(x: EFloat) -> EFloat {
    let (root, ratio) = (x.v.sqrt(), x.e / x.v);
    // Certain in an exact ring, but not in this enclosure.
    if ratio < 0.9 {
        EFloat::with_error(root, root * (ratio / (2.0 - ratio) + U) * (1.0 + 16.0 * U))
    } else {
        x.sqrt()
    }
}

/// `x 2^k`, where `k` is nearly always a known 0.
#[inline(always)]
fn scaled(x: EFloat, k: i32) -> EFloat {
    if k == 0 { x } else { x.scale2(k) }
}

/// The roots within the limits; `None` if rounding leaves them open.
///
/// `offset` is added to each root. `disc` may be more accurate than one computed from the
/// coefficients; it and `b` have the exponent 0.
#[inline(always)]
pub fn solve(
    a: SignedEnclosure,
    b: SignedEnclosure,
    c: SignedEnclosure,
    disc: SignedEnclosure,
    offset: f64,
    limits: &Limits,
) -> Option<LineRoots> {
    match disc.sign? {
        Less => {
            // A and C have the same sign, and neither is zero.
            let outside = a.sign == Some(Greater) || c.sign == Some(Greater);
            Some(LineRoots { roots: [None; 2], outside })
        }
        Equal => {
            let crossing = match a.sign? {
                Greater => Crossing::TouchOutside,
                Less => Crossing::TouchInside,
                // B is zero too: the quadratic is the constant C.
                Equal => return Some(LineRoots { roots: [None; 2], outside: c.sign? == Greater }),
            };
            let root = admit(scaled(-b.value / a.value, -a.k), offset, crossing, limits)?;
            Some(LineRoots { roots: [root, None], outside: false })
        }
        Greater => {
            let sqrt = root_of(disc.value);
            let falling = b.value.v >= 0.0;
            let q = if falling { -(b.value + sqrt) } else { sqrt - b.value };
            // The slope is -sign(B) √disc at q / A, and the opposite at C / q.
            let (first, second) =
                if falling { (Crossing::In, Crossing::Out) } else { (Crossing::Out, Crossing::In) };
            let near = admit(scaled(c.value / q, c.k), offset, second, limits)?;
            let far = match a.sign {
                Some(Equal) => None,
                _ => {
                    let least = if a.k != 0 {
                        0.0
                    } else {
                        (q.v.abs() - q.e) / (a.value.v.abs() + a.value.e) * (1.0 - 8.0 * U)
                    };
                    let reach = limits.hi.abs().max(limits.lo.abs());
                    if least - offset.abs() * (1.0 + 4.0 * U) > reach {
                        None
                    } else {
                        a.sign?;
                        admit(scaled(q / a.value, -a.k), offset, first, limits)?
                    }
                }
            };
            Some(LineRoots { roots: [near, far], outside: false })
        }
    }
}

/// A root, if it is within the limits; `None` if its bracket is too wide.
#[inline(always)]
pub fn admit(root: EFloat, offset: f64, crossing: Crossing, limits: &Limits) -> Option<Option<LineRoot>> {
    let root = if offset == 0.0 { root } else { root + EFloat::exact(offset) };
    let (lo, hi) = (root.lo(), root.hi());
    if hi < limits.lo || lo > limits.hi {
        return Some(None);
    }
    if !limits.allows(lo, hi, root.v) {
        return None;
    }
    Some(root.v.is_finite().then_some(LineRoot { s: root.v, lo, hi, crossing }))
}

/// The position of a number relative to a root of a quadratic, from the quadratic's sign (`value`)
/// and slope there and the sign of `A`; `None` if these leave it open.
#[inline(always)]
pub fn locate(
    crossing: Crossing,
    a: Option<Ordering>,
    value: Option<Ordering>,
    slope: Option<Ordering>,
) -> Option<Ordering> {
    match crossing {
        Crossing::Out if slope == Some(Greater) => value,
        Crossing::In if slope == Some(Less) => value.map(Ordering::reverse),
        // On the other side of the vertex, so beyond the other root or between the vertex and it.
        Crossing::Out if slope.is_some() => a.map(Ordering::reverse),
        Crossing::In if slope.is_some() => a,
        Crossing::TouchOutside => slope,
        Crossing::TouchInside => slope.map(Ordering::reverse),
        Crossing::In | Crossing::Out => None,
    }
}

fn times(a: Ordering, b: Ordering) -> Ordering {
    match a {
        Equal => Equal,
        Greater => b,
        Less => b.reverse(),
    }
}

/// The sign of an exact number, which is always certain.
pub fn exact_sign(x: &Dyadic) -> Ordering {
    x.sign().unwrap_or(Equal)
}

/// The exact sign of `q` at a root of `p`.
///
/// With `A_p q - A_q p = 2 l₁ s + l₀`, which has the sign of `A_p q` at the root, the question
/// becomes on which side of the root the rational number `-l₀ / 2 l₁` lies, and the signs of `p`
/// decide that.
pub fn sign_at_root(p: &Quadratic<Dyadic>, root: Crossing, q: &Quadratic<Dyadic>) -> Ordering {
    let sign_a = exact_sign(&p.a);
    if sign_a == Equal {
        return exact_sign(&q.at_ratio(&-p.c.clone(), &p.b.clone().scale2(1)));
    }
    if matches!(root, Crossing::TouchInside | Crossing::TouchOutside) {
        return exact_sign(&q.at_ratio(&-p.b.clone(), &p.a));
    }
    let l1 = &(&p.a * &q.b) - &(&q.a * &p.b);
    let l0 = &(&p.a * &q.c) - &(&q.a * &p.c);
    if l1.is_zero() {
        return times(sign_a, exact_sign(&l0));
    }
    let at = locate_ratio(p, root, &-l0, &l1.clone().scale2(1));
    times(times(sign_a, exact_sign(&l1)), at.reverse())
}

/// The exact sign of the slope of `q` at a root of `p`.
pub fn slope_at_root(p: &Quadratic<Dyadic>, root: Crossing, q: &Quadratic<Dyadic>) -> Ordering {
    sign_at_root(p, root, &q.derivative())
}

/// Where `n / m` lies relative to a root of `p`, exactly.
fn locate_ratio(p: &Quadratic<Dyadic>, root: Crossing, n: &Dyadic, m: &Dyadic) -> Ordering {
    let value = exact_sign(&p.at_ratio(n, m));
    let slope = times(exact_sign(m), exact_sign(&p.slope_at_ratio(n, m)));
    locate(root, p.a.sign(), Some(value), Some(slope)).unwrap_or(Equal)
}

/// Where the exact number `s` lies relative to a root of `p`.
pub fn locate_exact(p: &Quadratic<Dyadic>, root: Crossing, s: &Dyadic) -> Ordering {
    locate_ratio(p, root, s, &Dyadic::from(1.0))
}

/// Compares a root of `p` with a root of `q`, exactly.
pub fn compare_roots(
    (p, p_root): (&Quadratic<Dyadic>, Crossing),
    (q, q_root): (&Quadratic<Dyadic>, Crossing),
) -> Ordering {
    let (value, slope) = (sign_at_root(p, p_root, q), slope_at_root(p, p_root, q));
    locate(q_root, q.a.sign(), Some(value), Some(slope)).unwrap_or(Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(a: f64, b: f64, c: f64) -> Quadratic<Dyadic> {
        Quadratic { a: a.into(), b: b.into(), c: c.into() }
    }

    #[test]
    fn signs_at_roots_are_those_of_the_roots_distances() {
        // (s - r)(s - x) for small integers, both signs of A, against (s - y) and (s - y)(s - z).
        for r in -3..=3 {
            for x in -3..=3 {
                for k in [-2, 1] {
                    let (k, r, x) = (f64::from(k), f64::from(r), f64::from(x));
                    let p = exact(k, -0.5 * k * (r + x), k * r * x);
                    let rising = if k > 0.0 { r.max(x) } else { r.min(x) };
                    let falling = r + x - rising;
                    let names = if r == x {
                        let touch = if k > 0.0 { Crossing::TouchOutside } else { Crossing::TouchInside };
                        [(touch, r), (touch, r)]
                    } else {
                        [(Crossing::In, falling), (Crossing::Out, rising)]
                    };
                    for y in -4..=4 {
                        for z in -4..=4 {
                            let (y, z) = (f64::from(y), f64::from(z));
                            for m in [-3.0, 1.0] {
                                let q = exact(m, -0.5 * m * (y + z), m * y * z);
                                for (name, at) in names {
                                    let value = m * (at - y) * (at - z);
                                    assert_eq!(Some(sign_at_root(&p, name, &q)), value.partial_cmp(&0.0));
                                }
                            }
                            let line = exact(0.0, 0.5, -y);
                            for (name, at) in names {
                                assert_eq!(Some(sign_at_root(&p, name, &line)), at.partial_cmp(&y));
                                assert_eq!(
                                    Some(compare_roots((&p, name), (&line, Crossing::Out))),
                                    at.partial_cmp(&y)
                                );
                                assert_eq!(Some(locate_exact(&p, name, &y.into())), y.partial_cmp(&at));
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_vanishing_leading_coefficient_keeps_the_finite_root() {
        let limits = Limits { lo: -10.0, hi: 10.0, origin: 0.0, width: NARROW };
        for a in [0.0, 1e-300, -1e-300, 1e-17] {
            let p =
                Quadratic::<EFloat> { a: EFloat::exact(a), b: EFloat::exact(0.5), c: EFloat::exact(-2.0) };
            let disc = p.kahan_discriminant();
            let roots = solve(p.a.into(), p.b.into(), p.c.into(), disc.into(), 0.0, &limits).unwrap();
            let found: Vec<_> = roots.roots.iter().flatten().collect();
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].crossing, Crossing::Out);
            assert!(found[0].lo <= 2.0 && found[0].hi >= 2.0 - 1e-15);
        }
    }
}
