//! Ends of intervals as exact numbers `(p + e √D) / q`, their order, and narrow brackets.

use super::leaf::{Leaf, Pass};
use super::{System, Word, word_of};
use crate::planar::quotient_bounds;
use crate::{CentredRay, End, LocalRay, RingRay, Root, RootKind};
use core::cell::OnceCell;
use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::{Dd, Dyadic, EFloat, Ring};
use durer_roots::quadratic::{Crossing, Quadratic, SignedEnclosure, sign_at_root as quadratic_sign};

/// An end of the interval of a line in a copy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) pass: Pass,
    pub(super) word: Word,
    /// -1 where the line enters the copy, +1 where it leaves it.
    pub(super) sign: i8,
}

/// The number `(p + e √d) / q`, where `q > 0`; `e` is 0 where there is no root.
#[derive(Clone, Debug)]
pub(super) struct ExactEnd {
    p: Dyadic,
    e: i8,
    d: Dyadic,
    q: Dyadic,
    face: u32,
}

impl ExactEnd {
    fn ratio(p: Dyadic, q: Dyadic, face: u32) -> Self {
        Self { p, e: 0, d: Dyadic::ZERO, q, face }
    }

    fn compare(&self, other: &Self) -> Ordering {
        let x = &(&self.p * &other.q) - &(&other.p * &self.q);
        let b = signed(other.q.clone(), self.e);
        let c = signed(self.q.clone(), -other.e);
        sign_of_two(&x, &b, &self.d, &c, &other.d)
    }

    /// A value and its bracket.
    pub(super) fn bracket(&self) -> (f64, f64, f64) {
        if self.e == 0 {
            let (lo, hi) = quotient_bounds(&self.p, &self.p, &self.q);
            return (0.5 * lo + 0.5 * hi, lo, hi);
        }
        let k = self.q.exponent().and_then(|k| i32::try_from(k).ok()).unwrap_or(0);
        let rounded = |x: &Dyadic, k: i32| SignedEnclosure::from(&x.clone().scale2(-k)).value;
        let root = rounded(&self.d, 2 * k).sqrt();
        let root = if self.e < 0 { -root } else { root };
        let s = (rounded(&self.p, k) + root) / rounded(&self.q, k);
        (s.v, s.lo(), s.hi())
    }
}

fn signed(x: Dyadic, sign: i8) -> Dyadic {
    match sign {
        0 => Dyadic::ZERO,
        1 => x,
        _ => -x,
    }
}

/// The sign of `a + b √d`, where `d >= 0`.
fn sign_of_one(a: &Dyadic, b: &Dyadic, d: &Dyadic) -> Ordering {
    let first = a.exact_sign();
    let second = if d.is_zero() { Equal } else { b.exact_sign() };
    if second == Equal || first == second {
        return first;
    }
    if first == Equal {
        return second;
    }
    match (a * a).cmp(&(&(b * b) * d)) {
        Greater => first,
        Less => second,
        Equal => Equal,
    }
}

/// The sign of `a + b √d + c √e`, where `d >= 0` and `e >= 0`.
fn sign_of_two(a: &Dyadic, b: &Dyadic, d: &Dyadic, c: &Dyadic, e: &Dyadic) -> Ordering {
    let first = sign_of_one(a, b, d);
    let second = if e.is_zero() { Equal } else { c.exact_sign() };
    if second == Equal || first == second {
        return first;
    }
    if first == Equal {
        return second;
    }
    // (a + b √d)^2 - c^2 e.
    let square = &(&(a * a) + &(&(b * b) * d)) - &(&(c * c) * e);
    match sign_of_one(&square, &(a * b).scale2(1), d) {
        Greater => first,
        Less => second,
        Equal => Equal,
    }
}

/// The interval of a line in a leaf, exactly: `None` if it misses.
fn interval(leaf: &Leaf, ray: &RingRay<Dyadic>) -> Option<[ExactEnd; 2]> {
    match leaf {
        Leaf::Polytope(faces) => {
            let (mut entry, mut exit): (Option<ExactEnd>, Option<ExactEnd>) = (None, None);
            for (face, it) in faces.iter().enumerate() {
                let (height, slope) = it.plane.along(ray);
                let face = face as u32;
                match slope.exact_sign() {
                    Less => {
                        let end = ExactEnd::ratio(height, -slope, face);
                        if entry.as_ref().is_none_or(|last| end.compare(last).is_gt()) {
                            entry = Some(end);
                        }
                    }
                    Greater => {
                        let end = ExactEnd::ratio(-height, slope, face);
                        if exit.as_ref().is_none_or(|last| end.compare(last).is_lt()) {
                            exit = Some(end);
                        }
                    }
                    Equal if height.exact_sign().is_gt() => return None,
                    Equal => {}
                }
            }
            let (entry, exit) = (entry?, exit?);
            entry.compare(&exit).is_le().then_some([entry, exit])
        }
        Leaf::Ball(ball) => {
            let [a, b, c] = ball.along(ray);
            let d = &(&b * &b) - &(&a * &c);
            if d.exact_sign().is_lt() {
                return None;
            }
            let end = |e| ExactEnd { p: -b.clone(), e, d: d.clone(), q: a.clone(), face: 0 };
            Some([end(-1), end(1)])
        }
    }
}

/// A line, with its forms in other rings, which are computed at first use.
pub(super) struct Line<'a> {
    pub(super) system: &'a System,
    pub(super) at: &'a CentredRay<'a>,
    exact: OnceCell<Option<RingRay<Dyadic>>>,
    double: OnceCell<Option<RingRay<EFloat<Dd>>>>,
}

impl<'a> Line<'a> {
    pub(super) fn new(system: &'a System, at: &'a CentredRay<'a>) -> Self {
        Self { system, at, exact: OnceCell::new(), double: OnceCell::new() }
    }

    /// The line in the frame of a copy, exactly; `None` if it is not exactly known.
    fn exact_ray(&self, word: Word) -> Option<RingRay<Dyadic>> {
        let ray = self.exact.get_or_init(|| self.at.in_ring()).clone()?;
        Some(self.system.frames.descend_all(&self.system.letters(word), ray))
    }

    fn double_ray(&self, word: Word) -> Option<RingRay<EFloat<Dd>>> {
        let ray = self.double.get_or_init(|| self.at.in_double()).clone()?;
        Some(self.system.frames.descend_all(&self.system.letters(word), ray))
    }

    /// The interval of the line in a copy: `None` if the line is not exactly known, `Some(None)` if
    /// it misses.
    #[cold]
    #[inline(never)]
    pub(super) fn interval(&self, word: Word) -> Option<Option<[Event; 2]>> {
        let ray = self.exact_ray(word)?;
        Some(interval(&self.system.leaf, &ray).map(|ends| {
            let [a, b] = [(&ends[0], -1), (&ends[1], 1)].map(|(end, sign)| {
                let (s, lo, hi) = end.bracket();
                Event { pass: Pass { s, lo, hi, face: end.face, sure: true }, word, sign }
            });
            [a, b]
        }))
    }

    /// Whether the line certainly misses the leaf placed by a node with this many levels above it.
    #[cold]
    #[inline(never)]
    pub(super) fn misses(&self, word: Word, levels: u32) -> bool {
        let Some(ray) = self.exact.get_or_init(|| self.at.in_ring()).clone() else { return false };
        let ray = self.system.frames.descend_all(&self.system.first_letters(word, levels), ray);
        interval(&self.system.leaf, &ray).is_none()
    }

    fn end(&self, event: &Event) -> Option<ExactEnd> {
        let [entry, exit] = interval(&self.system.leaf, &self.exact_ray(event.word)?)?;
        Some(if event.sign < 0 { entry } else { exit })
    }

    /// The face of an end, where f64 cannot decide between faces; `None` if the line is not exactly
    /// known.
    #[cold]
    #[inline(never)]
    pub(super) fn face(&self, event: &Event) -> Option<u32> {
        Some(self.end(event)?.face)
    }

    /// The order of two ends, exactly; `None` if the line is not exactly known.
    #[inline(always)]
    pub(super) fn compare(&self, a: &Event, b: &Event) -> Option<Ordering> {
        if a.pass.hi < b.pass.lo {
            Some(Less)
        } else if a.pass.lo > b.pass.hi {
            Some(Greater)
        } else if a.word == b.word && a.sign == b.sign {
            Some(Equal)
        } else {
            self.compare_exactly(a, b)
        }
    }

    #[cold]
    #[inline(never)]
    fn compare_exactly(&self, a: &Event, b: &Event) -> Option<Ordering> {
        if a.pass.sure
            && b.pass.sure
            && let (Some(first), Some(second)) = (self.plane(a), self.plane(b))
            && first.n == second.n
        {
            // Of parallel planes: the order of their levels, along the line.
            let order = first.level.cmp(&second.level);
            return Some(if first.rises { order } else { order.reverse() });
        }
        Some(self.end(a)?.compare(&self.end(b)?))
    }

    /// The plane of an event as a plane with integers, if it is one.
    fn plane(&self, event: &Event) -> Option<LatticePlane> {
        let Leaf::Polytope(faces) = &self.system.leaf else { return None };
        let (n, h) = faces.get(event.pass.face as usize)?.lattice()?;
        let offset = self.system.frames.offset(&self.system.letters(event.word), n)?;
        let level = offset + h;
        // The first number of n that is not 0 becomes positive.
        let flip = n.iter().find(|&&x| x != 0.0).is_some_and(|&x| x < 0.0);
        let n = n.map(|x| if flip { 0.0 - x } else { x + 0.0 });
        Some(LatticePlane { n, level: if flip { -level } else { level }, rises: (event.sign > 0) != flip })
    }

    /// An end with a narrower bracket.
    #[cold]
    #[inline(never)]
    pub(super) fn refined(&self, event: &Event, most: f64) -> Event {
        let mut best = *event;
        let mut take = |s: f64, lo: f64, hi: f64| {
            let pass = &mut best.pass;
            (pass.lo, pass.hi) = (pass.lo.max(lo), pass.hi.min(hi));
            pass.s = s.max(pass.lo).min(pass.hi);
            pass.hi - pass.lo <= most
        };
        if let Some(s) =
            self.double_ray(event.word).and_then(|ray| in_double(&self.system.leaf, &ray, event.sign))
            && take(s.0, s.1, s.2)
        {
            return best;
        }
        if let Some(end) = self.end(event) {
            let (s, lo, hi) = end.bracket();
            take(s, lo, hi);
        }
        best
    }

    /// The order of an event and an end of the ray's range; `None` if the line is not exactly known.
    #[cold]
    #[inline(never)]
    pub(super) fn against(&self, event: &Event, end: End) -> Option<Ordering> {
        if event.pass.sure
            && let Leaf::Polytope(faces) = &self.system.leaf
            && let Some(face) = faces.get(event.pass.face as usize)
            && let Some(ray) = self.double_ray(event.word)
        {
            let (height, slope) = face.plane.along(&ray);
            let s: EFloat<Dd> = self.at.end_in_ring(end);
            // Heights grow where the line leaves: below the plane the crossing is ahead.
            if let Some(side) = (height + slope * s).sign() {
                return Some(if event.sign > 0 { side.reverse() } else { side });
            }
        }
        let at = ExactEnd::ratio(self.at.end_in_ring(end), Dyadic::from(1.0), 0);
        Some(self.end(event)?.compare(&at))
    }
}

/// The plane `n.x = level / q^N`.
struct LatticePlane {
    n: [f64; 3],
    level: i64,
    /// Whether the line goes along `n`.
    rises: bool,
}

/// An end of the interval in double-double: a value and its bracket. The line meets the leaf.
fn in_double(leaf: &Leaf, ray: &RingRay<EFloat<Dd>>, sign: i8) -> Option<(f64, f64, f64)> {
    match leaf {
        Leaf::Polytope(faces) => {
            let mut best = (f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
            for face in faces {
                let (height, slope) = face.plane.along(ray);
                match slope.sign()? {
                    Equal => {}
                    side if (side == Greater) != (sign > 0) => {}
                    _ => {
                        let s = -(height / slope);
                        let (v, lo, hi) = (s.value(), s.lo(), s.hi());
                        // The greatest entry, the least exit.
                        let (v, lo, hi) = if sign < 0 { (v, lo, hi) } else { (-v, -hi, -lo) };
                        best = (best.0.max(v), best.1.max(lo), best.2.max(hi));
                    }
                }
            }
            Some(if sign < 0 { best } else { (-best.0, -best.2, -best.1) })
        }
        Leaf::Ball(ball) => {
            let [a, b, c] = ball.along(ray);
            let disc = b.square() - a * c;
            if disc.sign()?.is_lt() {
                return None;
            }
            let root = disc.sqrt();
            let s = (if sign < 0 { -root } else { root } - b) / a;
            Some((s.value(), s.lo(), s.hi()))
        }
    }
}

/// The exact sign of a polynomial in the ray's own parameter at a root.
pub(super) fn sign_at_root(
    system: &System,
    ray: &LocalRay<'_>,
    root: &Root,
    q: &Quadratic<Dyadic>,
) -> Option<Ordering> {
    let line = ray.in_ring_from::<Dyadic>(system.centre, system.scale)?;
    let line = system.frames.descend_all(&system.letters(word_of(root.tag)), line);
    let [entry, exit] = interval(&system.leaf, &line)?;
    let end = if root.sign > 0 { exit } else { entry };
    let (p, is_touch) = match &system.leaf {
        Leaf::Polytope(faces) => {
            let (height, slope) = faces.get(end.face as usize)?.plane.along(&line);
            (Quadratic { a: Dyadic::ZERO, b: slope.scale2(-1), c: height }, false)
        }
        Leaf::Ball(ball) => {
            let [a, b, c] = ball.along(&line);
            (Quadratic { a, b, c }, root.kind == RootKind::Grazing && end.d.is_zero())
        }
    };
    let crossing = match root.sign {
        _ if is_touch => Crossing::TouchOutside,
        1 => Crossing::Out,
        _ => Crossing::In,
    };
    Some(quadratic_sign(&p, crossing, q))
}
