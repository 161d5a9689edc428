//! All crossings of a ray with a lathe.
//!
//! Each piece's polynomial is solved for its parameter `w` (`forms.rs`). Signs of the polynomial
//! are exact, and zero counts as positive, as if the whole ray were moved away from the axis by an
//! infinitesimal distance. So a ray through the common end of two pieces meets both, one or none
//! of them just as a ray beside it does, and it meets closed profiles an even number of times:
//! inside and outside alternate along the line.

use super::Lathe;
use super::forms::{Equation, Factors, Meeting, Rise};
use super::profile::{Cubic, Piece};
use crate::mesh::Sorted;
use crate::planar::{Crossing, Line, Probe, with_denominator_near_one};
use crate::prism::curved::exact::{Ends, at, turn};
use crate::prism::curved::profile_hits::Meet;
use crate::{LocalRay, PREVIEW_WIDTH, RingRay, Root, RootKind, Sink};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::efloat::Word;
use durer_math::{EFloat, Isa, Ring, U};
use durer_roots::polynomial::{Along, Found, Stretch, solve};
use durer_roots::quadratic::{Limits, NARROW};

/// A crossing of a ray with a piece of the profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossed {
    pub(super) piece: usize,
    pub(super) meet: Meet,
    /// Of a ray at one height: -1 before its point nearest to the axis, 1 behind it, 0 at it. Of
    /// other rays 0.
    pub(super) branch: i8,
    /// On the ray; the sign is that of direction . normal to the right of the profile.
    pub(super) at: Crossing,
}

/// The data that the crossings of one ray share.
pub(super) struct Pass<'a, 'r> {
    pub(super) lathe: &'a Lathe,
    pub(super) probe: &'a Probe<'r>,
    pub(super) equation: Equation,
    factors: Factors<EFloat>,
    /// The sign of the vertical direction.
    rise: i8,
}

/// A bracket wider than this, relative to the lathe's size or to `t`, is computed again.
const ENOUGH: f64 = 128.0 * U;

/// The value of an equation with its error, in a form with few roundings: for slanted rays
/// `P / d_y²`.
#[inline(always)]
fn value<T: Word>(
    equation: Equation,
    ray: &RingRay<EFloat<T>>,
    (r, y): (&Cubic<EFloat<T>>, &Cubic<EFloat<T>>),
    w: EFloat<T>,
) -> EFloat<T> {
    let above = ray.w * Piece::at(y, &w) - ray.o[1];
    match equation {
        Equation::Level => -above,
        Equation::Slanted => {
            let s = above / ray.d[1];
            let x = ray.o[0] + s * ray.d[0];
            let z = ray.o[2] + s * ray.d[2];
            let r = ray.w * Piece::at(r, &w);
            x.square() + z.square() - r.square()
        }
    }
}

/// The value of an equation and its derivative in `w`, rounded.
#[inline(always)]
fn rough_value(equation: Equation, ray: &RingRay<f64>, piece: &Piece, w: f64) -> (f64, f64) {
    let [[r, y], [r1, y1], _] = piece.slopes(w);
    let above = ray.w.mul_add(y, -ray.o[1]);
    match equation {
        Equation::Level => (-above, -ray.w * y1),
        Equation::Slanted => {
            let s = above / ray.d[1];
            let (x, z) = (s.mul_add(ray.d[0], ray.o[0]), s.mul_add(ray.d[2], ray.o[2]));
            let w2 = ray.w * ray.w;
            let f = x.mul_add(x, z * z) - w2 * r * r;
            let slope = (x.mul_add(ray.d[0], z * ray.d[2]) * ray.w * y1 / ray.d[1]) - w2 * r * r1;
            (f, 2.0 * slope)
        }
    }
}

/// A root in a narrower bracket, by Newton's method; each end of it has a certain sign, or is an
/// end of the given bracket. The given bracket if that fails.
#[inline(always)]
fn refined<T: Word>(
    equation: Equation,
    ray: &RingRay<EFloat<T>>,
    piece: &Piece,
    powers: (&Cubic<EFloat<T>>, &Cubic<EFloat<T>>),
    meet: Meet,
) -> Meet {
    if meet.turn == 0 || meet.lo == meet.hi {
        return meet;
    }
    let f64s = |a: &[EFloat<T>; 3]| [a[0].value(), a[1].value(), a[2].value()];
    let rough = RingRay { o: f64s(&ray.o), d: f64s(&ray.d), w: ray.w.value() };
    let mut w = meet.y;
    let mut slope = f64::NAN;
    for _ in 0..4 {
        let (f, f1) = rough_value(equation, &rough, piece, w);
        slope = f1;
        let step = f / f1;
        let next = w - step;
        if !(next >= meet.lo && next <= meet.hi) {
            break;
        }
        w = next;
        if step.abs() <= 2.0 * U {
            break;
        }
    }
    let exact = |w: f64| EFloat::<T>::with_error(T::from(w), 0.0);
    let mut here = value(equation, ray, powers, exact(w));
    // Newton's steps end at the noise of the rounded value. Where the value in `T` is more precise,
    // one step more with it ends within a rounding of the root.
    let next = w - here.value() / slope;
    if here.value().abs() > here.e && next != w && next >= meet.lo && next <= meet.hi {
        (w, here) = (next, value(equation, ray, powers, exact(next)));
    }
    let mut room = 2.0 * (here.magnitude() + here.e) / slope.abs() + U;
    for _ in 0..3 {
        if !(room.is_finite() && room < meet.hi - meet.lo) {
            return meet;
        }
        let (lo, hi) = ((w - room).max(meet.lo), (w + room).min(meet.hi));
        #[inline(always)]
        fn holds(sign: Option<Ordering>, turn: i8) -> bool {
            sign.is_some_and(|sign| sign as i8 == turn)
        }
        let first = lo == meet.lo || holds(value(equation, ray, powers, exact(lo)).sign(), -meet.turn);
        let last = hi == meet.hi || holds(value(equation, ray, powers, exact(hi)).sign(), meet.turn);
        if first && last {
            return Meet { y: w.max(lo).min(hi), lo, hi, ..meet };
        }
        room *= 16.0;
    }
    meet
}

/// The root with its error.
#[inline(always)]
fn with_error<T: Word>(meet: &Meet) -> EFloat<T> {
    EFloat::with_error(T::from(meet.y), (meet.hi - meet.y).max(meet.y - meet.lo) * (1.0 + 2.0 * U))
}

/// Where a ray meets a piece, from the root: the parameter and its bounds.
#[inline(always)]
fn place<T: Word>(
    equation: Equation,
    ray: &RingRay<EFloat<T>>,
    (r, y): (&Cubic<EFloat<T>>, &Cubic<EFloat<T>>),
    meet: &Meet,
    branch: i8,
) -> (f64, f64, f64) {
    let w = with_error::<T>(meet);
    let ([ox, oy, oz], [dx, dy, dz]) = (ray.o, ray.d);
    let a = dx.square() + dz.square();
    let b = ox * dx + oz * dz;
    // By the distance from the axis.
    #[inline(always)]
    fn by_radius<T: Word>([a, b, across]: [EFloat<T>; 3], r: EFloat<T>, branch: i8) -> EFloat<T> {
        let h = (a * r.square() - across.square()).sqrt();
        match branch {
            0 => -b / a,
            1.. => (h - b) / a,
            _ => -(h + b) / a,
        }
    }
    match equation {
        Equation::Level => {
            let across = ox * dz - oz * dx;
            let s = by_radius([a, b, across], ray.w * Piece::at(r, &w), branch);
            (s.value(), s.lo(), s.hi())
        }
        Equation::Slanted => {
            // By the height.
            let s = (ray.w * Piece::at(y, &w) - oy) / dy;
            let (lo, hi) = (s.lo(), s.hi());
            // The branch is known where the ray certainly comes nearer to the axis, or leaves it.
            let Some(branch) = (a * s + b).sign().filter(|sign| sign.is_ne()) else {
                return (s.value(), lo, hi);
            };
            let across = ox * dz - oz * dx;
            let t = by_radius([a, b, across], ray.w * Piece::at(r, &w), branch as i8);
            let (t_lo, t_hi) = (t.lo(), t.hi());
            let better = t_hi - t_lo < hi - lo;
            let (lo, hi) = (lo.max(t_lo), hi.min(t_hi));
            let s = if better { t.value() } else { s.value() };
            (s.max(lo).min(hi), lo, hi)
        }
    }
}

impl<'a, 'r> Pass<'a, 'r> {
    #[inline(always)]
    pub(super) fn new(lathe: &'a Lathe, probe: &'a Probe<'r>) -> Self {
        let running = probe.running();
        // A direction that is not known exactly is not level.
        let rise = match probe.sign(&Rise) {
            Some(sign) => sign as i8,
            None if probe.ray.d.y < 0.0 => -1,
            None => 1,
        };
        let equation = if rise == 0 { Equation::Level } else { Equation::Slanted };
        Self { lathe, probe, equation, factors: Factors::new(&running), rise }
    }

    #[inline(always)]
    fn meeting(&self, i: usize) -> Meeting<'_, Probe<'r>> {
        let factors = (self.equation == Equation::Slanted).then_some(&self.factors);
        Meeting { line: self.probe, profile: &self.lathe.profile, piece: &self.lathe.pieces[i], i, factors }
    }

    /// Passes the crossings with a piece to `f`.
    #[inline(always)]
    pub(super) fn crossings(&self, i: usize, mut f: impl FnMut(Crossed)) {
        let meeting = self.meeting(i);
        meets(
            &meeting,
            &self.lathe.profile,
            #[inline(always)]
            |meet| self.show(i, meet, &mut f),
        );
    }

    /// A root of a piece's equation, as crossings.
    #[inline(always)]
    fn show(&self, i: usize, meet: Meet, f: &mut impl FnMut(Crossed)) {
        let piece = &self.lathe.pieces[i];
        let running = self.probe.running();
        let (r, y) = piece.running();
        let meet = refined(self.equation, &running, piece, (&r, &y), meet);
        if self.equation == Equation::Slanted {
            f(self.crossed(i, meet, 0, meet.turn * self.rise));
            return;
        }
        let w = with_error::<f64>(&meet);
        let ([ox, _, oz], [dx, _, dz]) = (running.o, running.d);
        let across = ox * dz - oz * dx;
        let a = dx.square() + dz.square();
        let sign = (a * (running.w * Piece::at(&r, &w)).square() - across.square()).sign();
        match sign.or_else(|| self.exact_discriminant(i, &meet)).unwrap_or(Ordering::Equal) {
            Ordering::Less => {}
            Ordering::Equal => f(self.crossed(i, meet, 0, 0)),
            // The equation falls where the profile rises.
            Ordering::Greater => {
                f(self.crossed(i, meet, -1, meet.turn));
                f(self.crossed(i, meet, 1, -meet.turn));
            }
        }
    }

    /// A crossing with its place on the ray.
    #[inline(always)]
    fn crossed(&self, i: usize, meet: Meet, branch: i8, sign: i8) -> Crossed {
        let (r, y) = self.lathe.pieces[i].running();
        let (s, lo, hi) = place(self.equation, &self.probe.running(), (&r, &y), &meet, branch);
        let at = self.probe.bracketed(s, lo, hi, sign.cmp(&0));
        let crossed = Crossed { piece: i, meet, branch, at };
        if self.is_enough(&at) || s.is_finite() && !self.probe.may_admit(&at) {
            return crossed;
        }
        self.climb(crossed)
    }

    #[inline(always)]
    fn is_enough(&self, at: &Crossing) -> bool {
        at.s_hi - at.s_lo <= 0.25 * ENOUGH || self.probe.is_narrow(at)
    }

    #[cold]
    #[inline(never)]
    fn climb(&self, crossed: Crossed) -> Crossed {
        Isa::detect().run(
            #[inline(always)]
            || {
                let wide = self.in_double_double(&crossed).unwrap_or(crossed);
                if self.is_enough(&wide.at) { wide } else { self.exactly(&wide).unwrap_or(wide) }
            },
        )
    }

    #[inline(always)]
    fn in_double_double(&self, crossed: &Crossed) -> Option<Crossed> {
        let ray = with_denominator_near_one(self.probe.double()?);
        let Crossed { piece: i, meet, branch, at } = *crossed;
        let (r, y) = self.lathe.profile.powers::<EFloat<durer_math::Dd>>(i);
        let meet = refined(self.equation, &ray, &self.lathe.pieces[i], (&r, &y), meet);
        let (s, lo, hi) = place(self.equation, &ray, (&r, &y), &meet, branch);
        // Both are brackets.
        let (lo, hi) = (lo.max(at.s_lo), hi.min(at.s_hi));
        let s = if s.is_nan() { at.s } else { s };
        let at = self.probe.bracketed(s.max(lo).min(hi), lo, hi, at.sign.cmp(&0));
        Some(Crossed { meet, at, ..*crossed })
    }

    /// All crossings on the whole line, in their order along it.
    #[inline(always)]
    pub(super) fn all(&self) -> Vec<Crossed> {
        let mut all: Vec<Crossed> = Vec::new();
        self.lathe.boxes.visit(
            &self.probe.ray,
            #[inline(always)]
            |i| {
                if self.lathe.pieces[i].is_surface {
                    self.crossings(
                        i,
                        #[inline(always)]
                        |crossed| all.push(crossed),
                    );
                }
            },
        );
        all.sort_by(|a, b| a.at.s.total_cmp(&b.at.s));
        if all.windows(2).any(|w| w[1].at.s_lo <= w[0].at.s_hi) {
            self.order_exactly(&mut all);
        }
        all
    }

    /// Orders crossings whose brackets overlap.
    #[cold]
    #[inline(never)]
    fn order_exactly(&self, all: &mut [Crossed]) {
        // Insertion: what is compared may be equal, so it is no total order.
        for i in 1..all.len() {
            let mut k = i;
            while k > 0 && all[k].at.s_lo <= all[k - 1].at.s_hi && self.order(&all[k], &all[k - 1]).is_lt() {
                all.swap(k, k - 1);
                k -= 1;
            }
        }
    }

    /// The roots in the ray's range.
    #[inline(always)]
    fn roots(&self, sink: &mut dyn Sink) {
        let mut roots = Sorted::new();
        let solid = self.lathe.profile.is_closed;
        let mut inside = false;
        for crossed in &self.all() {
            let at = crossed.at;
            // The side of the profile on which the normal is.
            let right = if solid && at.sign != 0 {
                inside = !inside;
                (at.sign < 0) == inside
            } else {
                !solid || self.lathe.outside_is_right
            };
            if at.is_outside(sink.range()) || !self.probe.may_admit(&at) {
                continue;
            }
            if self.probe.ray.admits(at.lo, at.hi).unwrap_or_else(|| self.is_in_range(crossed)) {
                roots.push(self.root(crossed, right));
            }
        }
        let _ = roots.pour_in_turn(sink);
    }

    #[inline(always)]
    fn root(&self, crossed: &Crossed, right: bool) -> Root {
        let Crossed { piece, meet, at, .. } = crossed;
        let kind = match meet {
            Meet { certain: false, .. } => RootKind::Cluster,
            _ if at.sign == 0 => RootKind::Grazing,
            _ => RootKind::Simple,
        };
        let tag = [(2 * piece + usize::from(right)) as f64, meet.y];
        let sign = if right { at.sign } else { -at.sign };
        Root { sign, kind, ..self.probe.root(at, 0, tag) }
    }
}

/// Passes the roots of an equation on a piece to `f`, in the order of `w`.
#[inline(always)]
pub(super) fn meets<L: Line>(
    meeting: &Meeting<'_, L>,
    profile: &super::profile::Profile,
    mut f: impl FnMut(Meet),
) {
    // The signs at both ends, at which neighbours agree.
    let quick = match (meeting.equation(), meeting.piece.degree) {
        (Equation::Level, _) => end_signs::<4, _>(meeting),
        (Equation::Slanted, 1) => end_signs::<3, _>(meeting),
        (Equation::Slanted, 2) => end_signs::<5, _>(meeting),
        (Equation::Slanted, _) => end_signs::<7, _>(meeting),
    };
    if !(quick[0] && quick[1]) {
        return exact_meets(meeting, profile, &mut f);
    }
    let limits = Limits { lo: -1.0, hi: 1.0, origin: 0.0, width: PREVIEW_WIDTH };
    let stretch = Stretch::Within { mid: 0.0, half: 0.5 };
    #[inline(always)]
    fn found(f: &mut impl FnMut(Meet), found: &Found<'_>) -> ControlFlow<()> {
        let turn = turn(found.before, found.after);
        f(Meet { y: found.s, lo: found.lo.max(-0.5), hi: found.hi.min(0.5), turn, certain: found.certain });
        ControlFlow::Continue(())
    }
    match (meeting.equation(), meeting.piece.degree) {
        (Equation::Level, _) => solve::<4, _>(
            meeting,
            stretch,
            &limits,
            #[inline(always)]
            |x| found(&mut f, x),
        ),
        (Equation::Slanted, 1) => solve::<3, _>(
            meeting,
            stretch,
            &limits,
            #[inline(always)]
            |x| found(&mut f, x),
        ),
        (Equation::Slanted, 2) => solve::<5, _>(
            meeting,
            stretch,
            &limits,
            #[inline(always)]
            |x| found(&mut f, x),
        ),
        (Equation::Slanted, _) => solve::<7, _>(
            meeting,
            stretch,
            &limits,
            #[inline(always)]
            |x| found(&mut f, x),
        ),
    }
}

/// Whether the equation certainly does not vanish at the first end of the piece, and at the last.
///
/// The errors and roundings of `a_k (±1/2)^k` add up to less than those of all coefficients and
/// `2 N U` times the sum of the terms' magnitudes.
#[inline(always)]
fn end_signs<const N: usize, L: Line>(meeting: &Meeting<'_, L>) -> [bool; 2] {
    let a: [EFloat; N] = meeting.double();
    let (mut sums, mut size, mut e, mut power) = ([0.0_f64; 2], 0.0_f64, 0.0_f64, 1.0_f64);
    for (k, a) in a.iter().enumerate() {
        let term = a.v * power;
        sums[k % 2] += term;
        size += term.abs();
        e = a.e.mul_add(power, e);
        power *= 0.5;
    }
    let room = size.mul_add(2.0 * N as f64 * U, e) * (1.0 + 32.0 * U);
    [(sums[0] - sums[1]).abs() > room, (sums[0] + sums[1]).abs() > room]
}

/// [`meets`] where the equation vanishes at an end of the piece, or so nearly that f64 cannot
/// decide.
///
/// A joint at which the equation is negative on one side only is crossed. Otherwise the ray
/// touches it: a grazing hit, once.
#[cold]
#[inline(never)]
fn exact_meets<L: Line>(
    meeting: &Meeting<'_, L>,
    profile: &super::profile::Profile,
    f: &mut dyn FnMut(Meet),
) {
    let (p, certain) = meeting.exactly();
    let zeros = [-0.5, 0.5].map(|w| at(&p, w).is_zero());
    let Some(own) = Ends::new(p) else { return };
    // Whether the equation is negative on the other side of a joint; `None` for a free end, and
    // where the other side is the axis.
    let beyond = |last: bool| -> Option<Option<bool>> {
        let other = profile.joined(meeting.i, last)?;
        let piece = profile.piece(other);
        if !piece.is_surface {
            return None;
        }
        let (p, _) =
            Meeting { line: meeting.line, profile, piece: &piece, i: other, factors: meeting.factors }
                .exactly();
        Some(Ends::new(p).map(|ends| if last { ends.first } else { ends.last }))
    };
    let at_end = |w: f64, turn: i8| Meet { y: w, lo: w, hi: w, turn, certain };
    // A free end of a sheet is part of it; one on the axis is the tip of a solid.
    let free = |last: bool, negative: bool| -> i8 {
        let on_axis = profile.end(meeting.i, last)[0] == 0.0;
        match (negative, last) {
            (true, false) => -1,
            (true, true) => 1,
            _ if on_axis => 0,
            (false, false) => 1,
            (false, true) => -1,
        }
    };
    if zeros[0] {
        match beyond(false) {
            None => f(at_end(-0.5, free(false, own.first))),
            // The ray runs along the other piece, and counts as outside of it.
            Some(None) if own.first => f(at_end(-0.5, -1)),
            Some(None) => {}
            Some(Some(before)) if own.first && !before => f(at_end(-0.5, -1)),
            Some(Some(before)) if own.first == before => f(at_end(-0.5, 0)),
            Some(Some(_)) => {}
        }
    }
    for mut root in own.isolated(-0.5, 0.5) {
        let enough = |lo: f64, hi: f64| hi - lo <= NARROW * 0.25;
        let (lo, hi) = own.exact.bracket(&mut root, enough);
        let y = (lo + 0.5 * (hi - lo)).clamp(lo, hi);
        f(Meet { y, lo, hi, turn: own.turn(&root), certain });
    }
    if zeros[1] {
        match beyond(true) {
            None => f(at_end(0.5, free(true, own.last))),
            Some(None | Some(false)) if own.last => f(at_end(0.5, 1)),
            Some(_) => {}
        }
    }
}

impl Lathe {
    #[inline(never)]
    pub(super) fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || {
                // It is unknown on which piece a ray was spawned.
                let ray = &ray.from_side(None);
                let probe = self.probe(ray);
                Pass::new(self, &probe).roots(sink);
            },
        );
    }
}
