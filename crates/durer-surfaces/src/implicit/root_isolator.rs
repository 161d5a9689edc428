//! Root isolation: from stretches of a line to roots, each once, ascending, in brackets with
//! certain signs at their ends.

use crate::{PREVIEW_WIDTH, RootKind};

/// A function `g` of one number whose roots are wanted.
pub(crate) trait CertifiedFunction {
    /// The form of `g` that is evaluated on a stretch and near it.
    type Form<'a>: Copy;
    /// Whether two forms are the same.
    fn same(a: Self::Form<'_>, b: Self::Form<'_>) -> bool;
    /// The spacing of parameters that are worth separating.
    fn ulp(&self) -> f64;
    /// The rounded value at `s`; NaN where `g` is undefined.
    fn value(&self, form: Self::Form<'_>, s: f64) -> f64;
    /// The sign on each of eight stretches (`true`: positive), if it is certain; `None` also where
    /// `g` may be undefined.
    fn signs(&self, form: Self::Form<'_>, a: &[f64; 8], b: &[f64; 8]) -> [Option<bool>; 8];
    /// Whether one form is so much shorter than the other that one more evaluation saves time.
    fn is_shorter(_form: Self::Form<'_>, _than: Self::Form<'_>) -> bool {
        false
    }
    /// The root of a monotone `g` between two numbers, in a bracket about as wide as `first`, if
    /// there is a quicker way than one value after another.
    fn closed_in(
        &self,
        _form: Self::Form<'_>,
        _ends: (f64, f64),
        _rises: bool,
        _first: f64,
    ) -> Option<(f64, f64, f64)> {
        None
    }
    /// Whether the sign at `s`, which is certain, stays certain with several times the rounding
    /// error.
    fn is_plain(&self, form: Self::Form<'_>, s: f64) -> bool;
    /// The sign at `s`, if it is certain.
    fn sign(&self, form: Self::Form<'_>, s: f64) -> Option<bool> {
        self.signs(form, &[s; 8], &[s; 8])[0]
    }
}

/// The facts about `g` that are proven on an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SignInfo {
    /// It is defined and has this sign (`true`: positive) on all of it.
    Sign(bool),
    /// `g` has no root on the stretch and may be undefined.
    Gap,
    /// `g` is continuous, and strictly rises (`true`) or falls.
    Monotone(bool),
    /// The sign of `g` cannot be separated from zero within the formula's rounding.
    Unresolved,
}

/// A root in `[lo, hi]`; `s` lies in it too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) s: f64,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// +1 where `g` becomes positive, -1 where it becomes negative, 0 where it returns to its sign.
    pub(crate) sign: i8,
    pub(crate) kind: RootKind,
    /// The sign that `g` certainly has both before and behind the root.
    pub(crate) touches: Option<bool>,
}

/// A run of successive stretches in which there may be a root.
#[derive(Clone, Copy)]
struct Run<F> {
    lo: f64,
    hi: f64,
    /// The direction of `g`; `None` if unknown.
    rises: Option<bool>,
    form: F,
    /// The sign behind the run, if its margin is so small that the run may continue.
    past: Option<bool>,
}

/// Takes stretches in ascending order, without gaps, and gives the roots.
pub(crate) struct RootIsolator<'a, C: CertifiedFunction> {
    line: &'a C,
    /// A form that is valid everywhere.
    whole: C::Form<'a>,
    /// The sign before the run, if it is known.
    before: Option<bool>,
    run: Option<Run<C::Form<'a>>>,
    /// Brackets may be wide, except for roots that may be in one of these two intervals: the ends
    /// of the ray's range, within rounding.
    rough: Option<[(f64, f64); 2]>,
}

impl<'a, C: CertifiedFunction> RootIsolator<'a, C> {
    /// Starts where `g` has the sign `before`.
    pub(crate) fn new(
        line: &'a C,
        whole: C::Form<'a>,
        before: Option<bool>,
        rough: Option<[(f64, f64); 2]>,
    ) -> Self {
        Self { line, whole, before, run: None, rough }
    }

    /// The sign where the last stretch ended, if it is known.
    pub(crate) fn settled(&self) -> Option<bool> {
        if self.run.is_none() { self.before } else { None }
    }

    /// Takes a stretch on which `g` certainly has one sign. A run ends before it.
    pub(crate) fn settle(&mut self, sign: bool) -> Option<Found> {
        let found = self.close(Some(sign));
        self.before = Some(sign);
        found
    }

    /// Takes the next stretch. `form` is valid on and near it.
    ///
    /// Near a tangent the sign flickers between known and unknown. Once unknown it stays so until
    /// it is known with a margin.
    pub(crate) fn take(&mut self, a: f64, b: f64, verdict: SignInfo, form: C::Form<'a>) -> Option<Found> {
        match verdict {
            SignInfo::Sign(sign) if self.run.is_some_and(|run| run.rises.is_none()) => {
                self.hold(sign, b, form)
            }
            SignInfo::Sign(sign) => self.settle(sign),
            SignInfo::Gap => {
                // The run ends at a point of its own, where the formula is still defined, or jumps.
                let found = self.run.and_then(|run| {
                    let end = run.past.or_else(|| self.line.sign(run.form, run.hi));
                    self.close(end)
                });
                self.before = None;
                found
            }
            SignInfo::Monotone(rises) => self.go_on(a, b, Some(rises), form),
            SignInfo::Unresolved => self.go_on(a, b, None, form),
        }
    }

    fn go_on(&mut self, a: f64, b: f64, rises: Option<bool>, form: C::Form<'a>) -> Option<Found> {
        let Some(run) = &mut self.run else {
            if self.before.is_none() {
                self.before = self.line.sign(form, a);
            }
            self.run = Some(Run { lo: a, hi: b, rises, form, past: None });
            return None;
        };
        if run.rises.is_none() && rises.is_some() {
            return self.leave(a, b, rises, form);
        }
        run.past = None;
        let same = C::same(run.form, form);
        // Where the whole container's form is much longer, one evaluation at the border saves many
        // evaluations of it.
        let worth = !same && C::is_shorter(form, self.whole);
        let own = form;
        let form = if same { form } else { self.whole };
        if run.rises == rises && !(worth && rises.is_some()) {
            (run.hi, run.form) = (b, form);
            return None;
        }
        let border = if worth { self.line.sign(own, a) } else { None };
        if run.rises == rises && border.is_none() {
            (run.hi, run.form) = (b, form);
            return None;
        }
        let form = if border.is_some() { own } else { form };
        if let Some(sign) = border.or_else(|| self.line.sign(self.whole, a)) {
            let found = self.settle(sign);
            self.run = Some(Run { lo: a, hi: b, rises, form, past: None });
            return found;
        }
        self.turn(a, b, rises)
    }

    /// From an unresolved stretch to one on which `g` is monotone.
    fn leave(&mut self, a: f64, b: f64, rises: Option<bool>, form: C::Form<'a>) -> Option<Found> {
        let past = self.run.and_then(|run| run.past);
        let Some(sign) = past.or_else(|| self.line.sign(form, a)) else { return self.turn(a, b, rises) };
        match (self.line.sign(form, b), &mut self.run) {
            (Some(after), _) if after == sign => return self.hold(sign, b, form),
            // The sign's margin is too small.
            (None, Some(run)) if !self.line.is_plain(form, a) => {
                (run.hi, run.form, run.past) = (b, self.whole, None);
                return None;
            }
            _ => {}
        }
        let found = self.settle(sign);
        self.run = Some(Run { lo: a, hi: b, rises, form, past: None });
        found
    }

    /// A turn between the run and the next stretch cannot be separated from a root: all of it is
    /// one cluster, without the parts that certainly hold no root.
    fn turn(&mut self, a: f64, b: f64, rises: Option<bool>) -> Option<Found> {
        let (line, whole) = (self.line, self.whole);
        let run = self.run.as_mut()?;
        let lo = if run.rises.is_some() { plain_until(line, whole, run.lo, run.hi) } else { run.lo };
        let hi = if rises.is_some() { plain_until(line, whole, b, a) } else { b };
        *run = Run { lo, hi: hi.max(lo), rises: None, form: whole, past: None };
        let sign = rises.and_then(|_| line.sign(whole, b))?;
        self.hold(sign, b, whole)
    }

    /// Behind an unresolved stretch `g` has this sign as far as `b`. If the sign has a margin
    /// there, the run ends.
    fn hold(&mut self, sign: bool, b: f64, form: C::Form<'a>) -> Option<Found> {
        if self.line.is_plain(form, b) {
            return self.settle(sign);
        }
        self.run.as_mut()?.past = Some(sign);
        None
    }

    /// Whether no run is open.
    pub(crate) fn is_idle(&self) -> bool {
        self.run.is_none()
    }

    /// Takes the end of the line, where `g` has the sign `after`.
    pub(crate) fn finish(&mut self, after: Option<bool>) -> Option<Found> {
        self.close(after)
    }

    fn close(&mut self, after: Option<bool>) -> Option<Found> {
        let run = self.run.take()?;
        let (before, after) = (self.before, after.or(run.past));
        match (run.rises, before, after) {
            // A rising `g` that meets zero comes from negative and becomes positive.
            (Some(rises), before, after) => {
                let (start, end) = (before.unwrap_or(!rises), after.unwrap_or(rises));
                if start == end || start == rises {
                    return None;
                }
                let polished = |rough| polished(self.line, run.form, run.lo, run.hi, rises, rough);
                let (mut s, mut lo, mut hi) = polished(self.rough.is_some());
                if self.rough.is_some_and(|ends| ends.iter().any(|end| lo <= end.1 && end.0 <= hi)) {
                    (s, lo, hi) = polished(false);
                }
                // If one sign is unknown, the root may lie on an end, or not exist: it cannot be
                // disproved.
                let kind =
                    if before.is_some() && after.is_some() { RootKind::Simple } else { RootKind::Cluster };
                Some(Found { s, lo, hi, sign: if rises { 1 } else { -1 }, kind, touches: None })
            }
            (None, before, after) => {
                let sign = match (before, after) {
                    (Some(false), Some(true)) => 1,
                    (Some(true), Some(false)) => -1,
                    _ => 0,
                };
                let s = (0.5 * run.lo + 0.5 * run.hi).max(run.lo).min(run.hi);
                let touches = before.filter(|_| before == after);
                Some(Found { s, lo: run.lo, hi: run.hi, sign, kind: RootKind::Cluster, touches })
            }
        }
    }
}

/// The root of a monotone `g` in `[lo, hi]`, in a bracket with certain signs at its ends where
/// there are any.
fn polished<C: CertifiedFunction>(
    line: &C,
    form: C::Form<'_>,
    lo: f64,
    hi: f64,
    rises: bool,
    rough: bool,
) -> (f64, f64, f64) {
    let sense = if rises { 1.0 } else { -1.0 };
    let g = |s: f64| sense * line.value(form, s);
    let widest = if rough { PREVIEW_WIDTH * (line.ulp() / f64::EPSILON) * 0.25 } else { line.ulp() };
    // Steps on both sides until the signs are certain.
    let first = if rough { 0.03125 * widest } else { 2.0 * widest };
    if rough && let Some(found) = line.closed_in(form, (lo, hi), rises, first) {
        return found;
    }
    let s = guess(g, lo, hi, 0.125 * widest);
    let steps = [first, 8.0 * first, 64.0 * first, 512.0 * first];
    let at: [f64; 8] = core::array::from_fn(|i| if i < 4 { s - steps[i] } else { s + steps[i - 4] });
    let sign = line.signs(form, &at, &at);
    let usable = if rough { 3 } else { 4 };
    let left = (0..usable).find(|&i| sign[i] == Some(!rises)).map(|i| at[i]);
    let right = (4..4 + usable).find(|&i| sign[i] == Some(rises)).map(|i| at[i]);
    if let (Some(left), Some(right)) = (left, right) {
        return (s, left, right);
    }
    let (a, b) = sectioned(line, form, lo, hi, rises);
    let (a, b) = (left.unwrap_or(a), right.unwrap_or(b));
    let (a, b) = if a <= b { (a, b) } else { (lo, hi) };
    (s.max(a).min(b), a, b)
}

/// The zero of `g` by cubic inverse interpolation through the four points around it (E. H.
/// Neville's scheme), and its distance from the quadratic one. `None` if the values do not rise, or
/// there is no zero between.
pub(super) fn interpolated(at: &[f64; 8], g: &[f64; 8]) -> Option<(f64, f64)> {
    let above = g.iter().position(|&g| g > 0.0).filter(|&above| above > 0)?;
    let first = above.saturating_sub(2).min(4);
    let mut s: [f64; 4] = core::array::from_fn(|i| at[first + i]);
    let mut lower = [0.0; 2];
    for k in 1..4 {
        if k == 3 {
            lower = [s[0], s[1]];
        }
        for i in 0..4 - k {
            let (a, b) = (g[first + i], g[first + i + k]);
            let rises = a < b;
            if !rises {
                return None;
            }
            s[i] = (s[i] * b - s[i + 1] * a) / (b - a);
        }
    }
    let between = s[0] >= at[above - 1] && s[0] <= at[above];
    between.then(|| (s[0], (s[0] - lower[0]).abs().max((s[0] - lower[1]).abs())))
}

/// A root of a rising `g` in `[lo, hi]` at f64's precision: false position that halves the weight
/// of an end that stays (M. Dowell, P. Jarratt, "A modified regula falsi method for computing the
/// root of an equation", *BIT* 11, 1971), with bisection where that is slow.
fn guess(g: impl Fn(f64) -> f64, lo: f64, hi: f64, close: f64) -> f64 {
    let (mut a, mut b) = (lo, hi);
    let (mut ga, mut gb) = (g(a), g(b));
    if ga >= 0.0 {
        return a;
    }
    if gb <= 0.0 {
        return b;
    }
    let mut stayed = 0_i32;
    for step in 0..100 {
        let middle = 0.5 * a + 0.5 * b;
        let secant = b - gb * ((b - a) / (gb - ga));
        let s = if step % 4 == 3 || !(secant > a && secant < b) { middle } else { secant };
        if !(s > a && s < b) || b - a <= close {
            return s.max(a).min(b);
        }
        let gs = g(s);
        if gs == 0.0 {
            return s;
        }
        if gs < 0.0 {
            if (s - a).abs() <= close && stayed < 0 {
                return s;
            }
            (a, ga) = (s, gs);
            if stayed < 0 {
                gb *= gb / (gb - gs);
            }
            stayed = -1;
        } else {
            if (b - s).abs() <= close && stayed > 0 {
                return s;
            }
            // NaN goes with the upper end: one step of bisection.
            (b, gb) = (s, gs);
            if stayed > 0 {
                ga *= ga / (ga - gs);
            }
            stayed = 1;
        }
    }
    0.5 * a + 0.5 * b
}

/// The narrowest part of `[lo, hi]` with certain signs at its ends, by division into eight.
fn sectioned<C: CertifiedFunction>(line: &C, form: C::Form<'_>, lo: f64, hi: f64, rises: bool) -> (f64, f64) {
    let (mut a, mut b) = (lo, hi);
    loop {
        let at: [f64; 8] = core::array::from_fn(|i| a + (b - a) * ((i as f64 + 1.0) / 9.0));
        let sign = line.signs(form, &at, &at);
        let before = (0..8).rev().find(|&i| sign[i] == Some(!rises)).map_or(a, |i| at[i]);
        let after = (0..8).find(|&i| sign[i] == Some(rises)).map_or(b, |i| at[i]);
        let gained = after - before < 0.75 * (b - a);
        if before <= after {
            (a, b) = (before, after);
        }
        if !gained || before > after {
            return (a, b);
        }
    }
}

/// The point, going from `far` towards `near`, up to which the sign of a monotone `g` certainly
/// equals that at `far`. If it does at a point, it does at all points before it.
fn plain_until<C: CertifiedFunction>(line: &C, form: C::Form<'_>, far: f64, near: f64) -> f64 {
    let Some(sign) = line.sign(form, far) else { return far };
    let (mut known, mut open) = (far, near);
    loop {
        let at: [f64; 8] = core::array::from_fn(|i| known + (open - known) * ((i as f64 + 1.0) / 9.0));
        let signs = line.signs(form, &at, &at);
        let held = signs.iter().take_while(|&&s| s == Some(sign)).count();
        let next = (if held > 0 { at[held - 1] } else { known }, if held < 8 { at[held] } else { open });
        let gained = (next.1 - next.0).abs() < 0.5 * (open - known).abs();
        (known, open) = next;
        // The rest may be a part of the unresolved stretch beyond, but no more than that.
        if !gained || (open - known).abs() <= 0.25 * (near - open).abs().max(16.0 * line.ulp()) {
            return known;
        }
    }
}
