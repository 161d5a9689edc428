//! Crossings and touches in double-double, at points of the exact ray.
//!
//! Where f64 leaves a stretch undecided, three things at its points decide it: the value of the sum
//! within some `2^-100` of the fields' strengths, the slope along the ray, and a bound on the
//! second derivative. So the sign is known as far around a point as a parabola allows, and a
//! crossing is the only one where the slope outweighs the second derivative.
//!
//! The field of a component is computed from its own numbers, `q = |L⁻¹ (p - c) - a|² / R²`. Where
//! it is uncertain on which side of an axis's end a point lies, `q` differs by no more than `h² /
//! |b - a|²`, with `h` the component along the axis of the vector from that end. A point that is
//! outside the field by less than the error adds no more than the square of the error.

use super::point::ROOM;
use super::{Blob, BlobComponent, BlobShape};
use crate::{CentredRay, End, RingRay};
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use durer_math::{Dd, EFloat, Isa, Point3, Ring, U, Vec3};

/// The most steps in which a bracket is shortened or a sign is followed: next to a tangent a step
/// is about as long as the distance from the tangent's middle.
const MOST_STEPS: u32 = 64;

type Exact = EFloat<Dd>;

/// A crossing between two certain signs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub(super) s: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// The sum rises above the threshold.
    pub(super) rises: bool,
    /// It is the only one there.
    pub(super) alone: bool,
}

/// The classification of a stretch with the same sign before and behind.
#[derive(Clone, Debug)]
pub(super) enum Touch {
    /// Crossings: none, or two.
    Crossings(ArrayVec<Bracket, 2>),
    /// Undecided on this part.
    Open(f64, f64),
}

/// A number in f64, and its error.
fn enclosed(x: Exact) -> (f64, f64) {
    let v = x.value();
    (v, (x.hi() - v).max(v - x.lo()).next_up())
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn difference(a: Point3, b: Point3) -> [Exact; 3] {
    [0, 1, 2].map(|i| Exact::exact(a[i]) - Exact::exact(b[i]))
}

/// A number along a ray, and its rate of change.
#[derive(Clone, Copy)]
struct Moving {
    value: Exact,
    slope: Exact,
}

impl Moving {
    const fn new(value: Exact, slope: Exact) -> Self {
        Self { value, slope }
    }

    fn none() -> Self {
        Self::new(Exact::zero(), Exact::zero())
    }

    fn times(self, factor: Exact) -> Self {
        Self::new(self.value * factor, self.slope * factor)
    }

    fn minus(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.slope - other.slope)
    }

    fn squared(self) -> Self {
        Self::new(self.value * self.value, (self.value * self.slope).scale2(1))
    }

    /// The interval of all that the number may be if it may also be zero.
    fn doubtful(self) -> Self {
        let around = |x: Exact| Exact::with_error(Dd::from(0.0), x.magnitude());
        Self::new(around(self.value), around(self.slope))
    }

    /// The square of its positive part.
    fn positive_squared(self) -> Self {
        match self.value.sign() {
            Some(Ordering::Greater) => self.squared(),
            Some(_) => Self::none(),
            None => self.squared().doubtful(),
        }
    }
}

/// `a . b`, of which `a` moves.
fn along(a: &[Moving; 3], b: &[Exact; 3]) -> Moving {
    Moving::new(dot(&a.map(|a| a.value), b), dot(&a.map(|a| a.slope), b))
}

fn square(a: &[Moving; 3]) -> Moving {
    let (x, way) = (a.map(|a| a.value), a.map(|a| a.slope));
    Moving::new(dot(&x, &x), dot(&x, &way).scale2(1))
}

impl BlobComponent {
    /// The field at a moving point of the blob's own frame.
    fn added(&self, p: &[Moving; 3]) -> Moving {
        let (adjugate, determinant) = self.place.adjugate::<Exact>();
        let c = self.place.centre();
        let (y, way) = ([0, 1, 2].map(|i| p[i].value - Exact::exact(c[i])), p.map(|p| p.slope));
        let x = adjugate.map(|row| Moving::new(dot(&row, &y) / determinant, dot(&row, &way) / determinant));
        let from = |a: Point3| [0, 1, 2].map(|i| Moving::new(x[i].value - Exact::exact(a[i]), x[i].slope));
        let far = match self.shape {
            BlobShape::Ball(a) => square(&from(a)),
            BlobShape::Segment(a, b) => {
                let (axis, first, last) = (difference(b, a), from(a), from(b));
                let shorter = Exact::exact(1.0) / dot(&axis, &axis);
                // The part of the distance that the axis removes: nothing before its start or
                // behind its end.
                let (h, rest) = (along(&first, &axis), Moving::none().minus(along(&last, &axis)));
                if rest.value.sign() == Some(Ordering::Greater) {
                    square(&first).minus(h.positive_squared().times(shorter))
                } else {
                    square(&last).minus(rest.positive_squared().times(shorter))
                }
            }
        };
        let radius = Exact::exact(self.radius);
        let q = far.times(Exact::exact(1.0) / (radius * radius));
        let left = Moving::new(Exact::exact(1.0), Exact::zero()).minus(q);
        left.positive_squared().times(Exact::exact(self.strength))
    }
}

/// The threshold minus the sum at a point of a ray.
#[derive(Clone, Copy)]
struct RefinedValue {
    value: f64,
    error: f64,
    /// Its rate of change, and the error of that.
    slope: f64,
    doubt: f64,
    /// A bound of the second derivatives along the ray, as far as [`ROOM`].
    bend: f64,
}

impl RefinedValue {
    fn is_out(&self) -> Option<bool> {
        (self.value.abs() > self.error).then_some(self.value > 0.0)
    }
}

/// The points of a ray.
struct Points<'a> {
    blob: &'a Blob,
    /// In f64, known within an error along each axis.
    o: Vec3,
    o_err: Vec3,
    d: Vec3,
    d_err: Vec3,
    /// The exact ray, where f64 does not suffice.
    exact: Option<RingRay<Exact>>,
}

impl<'a> Points<'a> {
    fn rounded(blob: &'a Blob, at: &CentredRay<'_>) -> Self {
        Self { blob, o: at.o, o_err: at.o_err, d: at.d, d_err: at.d_err, exact: None }
    }

    fn exact(blob: &'a Blob, at: &CentredRay<'_>) -> Option<Self> {
        Some(Self { exact: Some(at.in_ring()?), ..Self::rounded(blob, at) })
    }

    /// An upper bound of the direction's length.
    fn length(&self) -> f64 {
        (self.d.length() + 2.0 * self.d_err.max_abs()) * (1.0 + 8.0 * U)
    }

    fn at(&self, s: f64) -> RefinedValue {
        let Self { blob, o, o_err, d, d_err, .. } = *self;
        let length = self.length();
        let y = Vec3::new(s.mul_add(d.x, o.x), s.mul_add(d.y, o.y), s.mul_add(d.z, o.z));
        let e = (o_err + d_err * s.abs() + y.abs() * U).max_abs() * (1.0 + 8.0 * U);
        let near = blob.near(y, e);
        // Each part of the dot product passes three roundings.
        let doubt = near.gradient_err * length + near.gradient.abs().dot(d.abs() * (4.0 * U) + d_err);
        let mut place = RefinedValue {
            value: near.value,
            error: near.error,
            slope: near.gradient.dot(d),
            doubt: doubt * (1.0 + 16.0 * U),
            bend: near.bend * (length * length) + f64::MIN_POSITIVE,
        };
        if let Some(RingRay { o, d, w }) = &self.exact {
            let scaled = |x: Exact| (x / *w).scale2(blob.scale);
            let p = [0, 1, 2].map(|i| {
                let y = scaled(o[i] + d[i] * Exact::exact(s));
                Moving::new(Exact::exact(blob.centre[i]) + y, scaled(d[i]))
            });
            let mut sum = Moving::new(Exact::exact(blob.threshold), Exact::zero());
            blob.tree.near(y, e, |i| sum = sum.minus(blob.components[i].added(&p)));
            let ((value, error), (slope, doubt)) = (enclosed(sum.value), enclosed(sum.slope));
            if error < place.error && doubt < place.doubt {
                place = RefinedValue { value, error, slope, doubt, ..place };
            }
        }
        place
    }

    /// A bracket between certain signs, shortened as far as signs at its points allow: Newton's
    /// method, and bisection where that leaves the bracket.
    fn narrow(&self, mut found: Bracket) -> Bracket {
        let mut s = found.s.max(found.lo).min(found.hi);
        let mut reach = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let at = self.at(s);
            reach = 1.25 * at.error / at.slope.abs() + s.abs() * (2.0 * U);
            match at.is_out() {
                Some(out) if out == found.rises => found.lo = s,
                Some(_) => found.hi = s,
                None => break,
            }
            let next = s - at.value / at.slope;
            if (next - s).abs() <= reach {
                s = next;
                break;
            }
            s = if next > found.lo && next < found.hi { next } else { 0.5 * found.lo + 0.5 * found.hi };
        }
        for step in [reach, 4.0 * reach, 16.0 * reach] {
            let (before, after) = (s - step, s + step);
            if before > found.lo && self.at(before).is_out() == Some(found.rises) {
                found.lo = before;
            }
            if after < found.hi && self.at(after).is_out() == Some(!found.rises) {
                found.hi = after;
            }
        }
        found.s = s.max(found.lo).min(found.hi);
        found
    }

    /// Whether a crossing in the inner of two brackets is the only one in both: the sum is monotone
    /// on the inner one and keeps its sign in the rest.
    fn is_alone(&self, inner: &Bracket, whole: &Bracket) -> bool {
        let at = self.at(0.5 * inner.lo + 0.5 * inner.hi);
        let way = 0.5 * (inner.hi - inner.lo) * (1.0 + 8.0 * U) + f64::MIN_POSITIVE;
        // The threshold minus the sum falls where the sum rises.
        let least = if inner.rises { -at.slope } else { at.slope } - at.doubt - at.bend * way;
        way * self.length() < ROOM
            && least > 0.0
            && self.keeps_its_sign((inner.lo, whole.lo), inner.rises)
            && self.keeps_its_sign((inner.hi, whole.hi), !inner.rises)
    }

    /// Whether the threshold minus the sum certainly keeps its sign from one parameter to another.
    /// With a value `v`, a slope of at least `g` and second derivatives of at most `h` it is above
    /// `v + g w - h w²/2` at a distance `w`, and each step goes as far as that is positive.
    fn keeps_its_sign(&self, (from, to): (f64, f64), above: bool) -> bool {
        let away = if to < from { -1.0 } else { 1.0 };
        let sense = if above { 1.0 } else { -1.0 };
        let length = self.length();
        let mut s = from;
        for _ in 0..MOST_STEPS {
            if (to - s) * away <= 0.0 {
                return true;
            }
            let at = self.at(s);
            let (v, g, h) = (at.value * sense - at.error, at.slope * sense * away - at.doubt, at.bend);
            let root = (g * g + 2.0 * h * v).sqrt();
            let reach = if g > 0.0 { (g + root) / h } else { 2.0 * v / (root - g) };
            let next = s + away * (reach * (1.0 - 1.0 / 64.0)).min(ROOM / length * 0.5);
            // A step of a few ulps would measure only rounding.
            let goes_on = v > 0.0 && (next - s).abs() > s.abs() * (256.0 * U);
            if !goes_on {
                return false;
            }
            s = next;
        }
        false
    }

    /// Approximately where the sum is nearest to the threshold, between two places on one side of
    /// it.
    fn turn(&self, (mut lo, mut hi): (f64, f64), out: bool) -> f64 {
        for _ in 0..MOST_STEPS {
            let s = 0.5 * lo + 0.5 * hi;
            if !(s > lo && s < hi) {
                break;
            }
            if (self.at(s).slope > 0.0) == out {
                hi = s;
            } else {
                lo = s;
            }
        }
        0.5 * lo + 0.5 * hi
    }
}

impl Blob {
    /// The crossing in a narrower bracket, if it is wider than `enough` or not yet proven to be the
    /// only one.
    #[inline(never)]
    pub(super) fn narrowed(
        &self,
        at: &CentredRay<'_>,
        found: Bracket,
        enough: impl Fn(f64) -> f64,
    ) -> Bracket {
        Isa::detect().run(
            #[inline(always)]
            || {
                let mut found = found;
                if found.alone {
                    found = Points::rounded(self, at).narrow(found);
                    if found.hi - found.lo <= enough(found.s) {
                        return found;
                    }
                }
                let Some(points) = Points::exact(self, at) else { return found };
                let inner = points.narrow(found);
                let alone = found.alone || points.is_alone(&inner, &found);
                if alone { Bracket { alone, ..inner } } else { found }
            },
        )
    }

    /// An undecided stretch whose sign is certain, and the same, at both ends.
    #[inline(never)]
    pub(super) fn touched(&self, at: &CentredRay<'_>, (lo, hi): (f64, f64), out: bool) -> Touch {
        Isa::detect().run(
            #[inline(always)]
            || {
                let Some(points) = Points::exact(self, at) else { return Touch::Open(lo, hi) };
                let s = points.turn((lo, hi), out);
                let Some(side) = points.at(s).is_out() else { return points.open_around(s, (lo, hi), out) };
                if side == out {
                    let held = points.keeps_its_sign((s, lo), out) && points.keeps_its_sign((s, hi), out);
                    return if held { Touch::Crossings(ArrayVec::new()) } else { Touch::Open(lo, hi) };
                }
                let sides = [(lo, s, out), (s, hi, !out)].map(|(lo, hi, rises)| {
                    let whole = Bracket { s: 0.5 * lo + 0.5 * hi, lo, hi, rises, alone: false };
                    let inner = points.narrow(whole);
                    Bracket { alone: points.is_alone(&inner, &whole), ..inner }
                });
                let told = sides.iter().all(|side| side.alone);
                if told { Touch::Crossings(sides.into_iter().collect()) } else { Touch::Open(lo, hi) }
            },
        )
    }
}

impl Blob {
    /// Whether the ray is outside at a finite end of its range, if that is certain.
    #[cold]
    #[inline(never)]
    pub(super) fn is_out_at(&self, at: &CentredRay<'_>, end: End) -> Option<bool> {
        let RingRay { o, d, w } = at.in_ring::<Exact>()?;
        let s = at.end_in_ring::<Exact>(end);
        let y = [0, 1, 2].map(|i| (o[i] + d[i] * s) / w);
        let p = [0, 1, 2]
            .map(|i| Moving::new(Exact::exact(self.centre[i]) + y[i].scale2(self.scale), Exact::zero()));
        let [(x, ex), (v, ev), (z, ez)] = y.map(enclosed);
        let mut sum = Exact::exact(self.threshold);
        self.tree.near(Vec3::new(x, v, z), ex.max(ev).max(ez), |i| {
            sum = sum - self.components[i].added(&p).value;
        });
        sum.sign().filter(|sign| sign.is_ne()).map(Ordering::is_gt)
    }
}

impl Points<'_> {
    /// The shortest stretch around a place that stays undecided, beyond which the sign is certain.
    #[cold]
    fn open_around(&self, s: f64, (lo, hi): (f64, f64), out: bool) -> Touch {
        let mut way = (s.abs() + 1.0) * (64.0 * U);
        while way < hi - lo {
            let (a, b) = ((s - way).max(lo), (s + way).min(hi));
            if self.keeps_its_sign((a, lo), out) && self.keeps_its_sign((b, hi), out) {
                return Touch::Open(a, b);
            }
            way *= 4.0;
        }
        Touch::Open(lo, hi)
    }
}
