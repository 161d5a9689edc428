//! A stretch of a ray on which the sum of the fields is one polynomial of degree four: certified
//! sign changes.
//!
//! The polynomial is in Bernstein form ([`Bernstein`]). Coefficients of one sign, the common case,
//! prove that there is no crossing; one change between certain signs proves one simple crossing;
//! otherwise the stretch is divided. All numbers carry one bound of all errors of the sum
//! (rounding, the ray, fields that begin or end slightly beside the stretch's ends), so a certain
//! sign is that of the sum itself.

use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use durer_math::U;
use durer_roots::bernstein::{Bernstein, Count, FLOOR};

/// The shortest part of a stretch that is divided.
const FINEST: u32 = 44;
/// The most parts of a stretch.
const MOST_PARTS: u32 = 4096;

/// `Σ c_k x^k` with `s = mid + half x`, within `slack` of the sum for all `x` in `[-1, 1]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) mid: f64,
    pub(super) half: f64,
    pub(super) c: [f64; 5],
    pub(super) slack: f64,
    /// A bound on the derivative by `x` of the part of the sum that is no polynomial.
    pub(super) bent: f64,
}

/// The classification of a part of a ray, in its parameter.
#[derive(Clone, Copy, Debug)]
pub(super) enum SegmentRoot {
    /// The sum is above the threshold everywhere, or below.
    Sign(bool),
    /// One crossing between certain signs, and whether it is proven to be the only one.
    Root { s: f64, lo: f64, hi: f64, rises: bool, alone: bool },
    /// The sign cannot be decided here, within rounding.
    Unresolved { lo: f64, hi: f64 },
}

struct SegmentPart {
    form: Bernstein<f64, 5>,
    l: f64,
    r: f64,
    bits: u32,
    /// The sign at its start, if it is known from elsewhere.
    first: Option<bool>,
}

impl Stretch {
    /// The polynomial in Bernstein form.
    #[inline(always)]
    pub(super) fn form(&self) -> Bernstein<f64, 5> {
        Bernstein::quick(&self.c, self.slack)
    }

    /// The one sign on all of it, if that is certain.
    #[inline(always)]
    pub(super) fn sign(&self, form: &Bernstein<f64, 5>) -> Option<bool> {
        (form.count() == Count::None).then(|| form.b[0] > 0.0)
    }

    /// The sign at an end, if it is certain.
    #[inline(always)]
    pub(super) fn sign_at_end(&self, form: &Bernstein<f64, 5>) -> Option<bool> {
        let b = form.b[4];
        (b.abs() > form.e * (1.0 + 8.0 * U)).then_some(b > 0.0)
    }

    /// Classifies the stretch in ascending order, without gaps. `first` is the sign at its start,
    /// if it is known from elsewhere; a bracket should be no wider than `widest` in `s`.
    #[inline(always)]
    pub(super) fn classify(
        &self,
        form: Bernstein<f64, 5>,
        first: Option<bool>,
        widest: impl Fn(f64) -> f64,
        mut take: impl FnMut(SegmentRoot) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut open = ArrayVec::<SegmentPart, 64>::new();
        open.push(SegmentPart { form, l: -1.0, r: 1.0, bits: 0, first });
        let mut parts = 0;
        while let Some(node) = open.pop() {
            parts += 1;
            let told = match known(&node) {
                Count::None => Some(SegmentRoot::Sign(node.first.unwrap_or(node.form.b[1] > 0.0))),
                count @ (Count::Rise | Count::Fall) => Some(self.root(&node, count == Count::Rise, &widest)),
                Count::Open if node.bits >= FINEST || parts > MOST_PARTS || !node.form.tells() => {
                    Some(SegmentRoot::Unresolved { lo: self.before(node.l), hi: self.after(node.r) })
                }
                Count::Open => None,
            };
            if let Some(told) = told {
                take(told)?;
                continue;
            }
            // Divided where the sign is certain, if there is such a point near the middle.
            let half = node.form.split(0.5);
            let (part, bits, (left, right)) = if half.0.last_is_certain() {
                (0.5, 1, half)
            } else {
                let tried = [(0.4375, 4), (0.5625, 4)].into_iter().find_map(|(part, bits)| {
                    let parts = node.form.split(part);
                    parts.0.last_is_certain().then_some((part, bits, parts))
                });
                tried.unwrap_or((0.5, 1, half))
            };
            let (m, bits) = ((node.r - node.l).mul_add(part, node.l), node.bits + bits);
            open.push(SegmentPart { form: right, l: m, r: node.r, bits, first: None });
            open.push(SegmentPart { form: left, l: node.l, r: m, bits, first: node.first });
        }
        ControlFlow::Continue(())
    }

    /// A parameter not above that of `x`.
    #[inline(always)]
    fn before(&self, x: f64) -> f64 {
        self.half.mul_add(x, self.mid).next_down()
    }

    /// A parameter not below that of `x`.
    #[inline(always)]
    fn after(&self, x: f64) -> f64 {
        self.half.mul_add(x, self.mid).next_up()
    }

    /// The value at `x`, and the slope.
    #[inline(always)]
    pub(super) fn at(&self, x: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0_f64, 0.0_f64);
        for c in self.c.iter().rev() {
            slope = slope.mul_add(x, value);
            value = value.mul_add(x, *c);
        }
        (value, slope)
    }

    /// A bound on the error of a value for `|x| <= 1`: Horner's scheme rounds each coefficient's
    /// share at most nine times.
    #[inline(always)]
    pub(super) fn doubt(&self) -> f64 {
        let size = self.c.iter().fold(0.0, |sum, c| sum + c.abs());
        size.mul_add(10.0 * U, self.slack) * (1.0 + 16.0 * U) + FLOOR
    }

    /// The crossing of a part with one change of sign.
    #[inline(always)]
    fn root(&self, node: &SegmentPart, rises: bool, widest: &impl Fn(f64) -> f64) -> SegmentRoot {
        let (l, r) = (node.l, node.r);
        let eta = self.doubt();
        let sense = if rises { 1.0 } else { -1.0 };
        // Newton's method, halving where it would leave the part.
        let (mut a, mut b) = (l, r);
        let mut x = node.form.guess().mul_add(r - l, l);
        let (mut value, mut slope) = self.at(x);
        for _ in 0..60 {
            if value * sense > 0.0 {
                b = x;
            } else {
                a = x;
            }
            let next = x - value / slope;
            let next = if next > a && next < b { next } else { 0.5 * (a + b) };
            let step = (next - x).abs();
            (x, (value, slope)) = (next, self.at(next));
            if step < 1e-9 * (r - l) || value.abs() <= 0.25 * eta {
                break;
            }
        }
        let rate = slope.abs();
        let reach = (value.abs() + 2.0 * eta) / rate * (1.0 + 1.0 / 16.0);
        let certain = |x: f64, sign: f64| self.at(x).0 * sign > eta;
        // The signs at the ends of the part are certain.
        let lower = |x: f64| x <= l || certain(x, -sense);
        let upper = |x: f64| x >= r || certain(x, sense);
        let (mut lo, mut hi) = (x - reach, x + reach);
        if lower(lo) && upper(hi) {
            (lo, hi) = (lo.max(l), hi.min(r));
        } else {
            (lo, hi) = self.halved((l, r), sense, eta, widest(self.half.mul_add(x, self.mid)) / self.half);
            x = x.max(lo).min(hi);
        }
        // With `|p″| <= bend` the slope keeps its sign in the bracket, whatever part of the sum is
        // no polynomial.
        let bend = 2.0 * self.c[2].abs() + 6.0 * self.c[3].abs() + 12.0 * self.c[4].abs();
        let alone = self.at(x).1.abs() - bend * (hi - lo) * (1.0 + 16.0 * U) > 6.0 * eta + self.bent;
        let s = self.half.mul_add(x, self.mid);
        let (lo, hi) = (self.before(lo), self.after(hi));
        SegmentRoot::Root { s: s.max(lo).min(hi), lo, hi, rises, alone }
    }

    /// Certain signs as near to the crossing as bisection and a search around its end can bring
    /// them.
    #[inline(always)]
    fn halved(&self, (mut a, mut b): (f64, f64), sense: f64, eta: f64, most: f64) -> (f64, f64) {
        for _ in 0..60 {
            let x = 0.5 * (a + b);
            if !(x > a && x < b) || b - a <= 0.5 * most {
                break;
            }
            let value = self.at(x).0 * sense;
            if value > eta {
                b = x;
            } else if value < -eta {
                a = x;
            } else {
                let mut way = 8.0 * U;
                let (mut low, mut high) = (false, false);
                while !(low && high) {
                    if !low && (x - way <= a || self.at(x - way).0 * sense < -eta) {
                        (a, low) = (a.max(x - way), true);
                    }
                    if !high && (x + way >= b || self.at(x + way).0 * sense > eta) {
                        (b, high) = (b.min(x + way), true);
                    }
                    way *= 2.0;
                }
                break;
            }
        }
        (a, b)
    }
}

/// The result of the signs of a part, given the sign at its start.
#[inline(always)]
fn known(node: &SegmentPart) -> Count {
    match node.first {
        Some(up) if node.form.b[0].abs() <= node.form.e * (1.0 + 8.0 * U) => {
            let mut form = node.form;
            form.b[0] = if up { 4.0 } else { -4.0 } * form.e;
            form.count()
        }
        _ => node.form.count(),
    }
}
