//! The spans of a line by exact arithmetic.
//!
//! The runs of a piece are those of `D >= 0`, whose roots are isolated. The signs of
//! `g(u) = |x - c(u)|² - r(u)²` at the point `x` of a number `s` decide where `s` lies relative to
//! the interval of a run. `g` is positive where the line does not meet the ball, so if it has a
//! root within the run the point is in a ball; if not, all balls are before the point or all behind
//! it, and one ball decides which. So brackets can be as narrow as f64 allows, and two runs can be
//! compared.
#![expect(clippy::needless_range_loop, reason = "several arrays have the same axes and powers")]

use super::SphereSweep;
use super::line::{RunEnd, Widths};
use super::spline::Basis;
use super::unite::Span;
use crate::{CentredRay, End, RingRay};
use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::{Dyadic, Ring, U};
use durer_roots::exact::{ExactRoots, Isolated};

/// Two runs that are nearer to each other than `2^-MOST_HALVINGS` count as touching.
const MOST_HALVINGS: u32 = 400;
/// No point of the sweep is farther from the line's own origin, in units.
const FAR: f64 = 8.0;

type Poly = Vec<Dyadic>;

fn dot(a: &[Dyadic; 3], b: &[Dyadic; 3]) -> Dyadic {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

fn value(p: &[Dyadic], x: &Dyadic) -> Dyadic {
    p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * x) + a)
}

/// `p += factor q1 q2`.
fn add_product(p: &mut [Dyadic], q1: &[Dyadic], q2: &[Dyadic]) {
    for (i, a) in q1.iter().enumerate() {
        for (j, b) in q2.iter().enumerate() {
            p[i + j] = &p[i + j] + &(a * b);
        }
    }
}

/// A piece and the line: `g(x, s) = a s² - 2 b(x) s + c(x)`, times a positive factor, and
/// `D = b² - a c`.
struct ExactPiece {
    number: u32,
    a: Dyadic,
    b: Poly,
    c: Poly,
    disc: Poly,
}

/// A closed part of a piece where `D >= 0`. It lies between `from` and `to`; `D` is negative on the
/// rest of that interval.
struct ExactRun {
    from: Dyadic,
    to: Dyadic,
    first: bool,
    last: bool,
    /// False if the line only touches it in one point.
    thick: bool,
    /// A ball that the line meets, and its approximate place.
    ball: Ball,
    about: f64,
}

enum Ball {
    At(Dyadic),
    Root(Isolated),
}

/// A run with its piece.
struct Member {
    piece: usize,
    run: ExactRun,
}

/// Runs that continue from piece to piece.
struct Chain {
    members: Vec<Member>,
    span: Span,
}

impl ExactPiece {
    fn new<const K: usize, const M: usize>(
        sweep: &SphereSweep,
        basis: &Basis<K, M>,
        ray: &RingRay<Dyadic>,
        number: u32,
        points: &[[f64; 4]; K],
    ) -> Self {
        let weight = Dyadic::from(basis.weight);
        let axis = |k: usize| {
            let base = if k < 3 { sweep.centre[k] } else { 0.0 };
            let p = points.map(|p| (Dyadic::from(p[k]) - Dyadic::from(base)).scale2(-sweep.scale));
            basis.coefficients(&p).map(|c| &c * &ray.w)
        };
        let d = [0, 1, 2].map(|k| &ray.d[k] * &weight);
        let (mut b, mut c) = (vec![Dyadic::ZERO; K], vec![Dyadic::ZERO; M]);
        for k in 0..3 {
            let mut q = axis(k);
            q[0] = &q[0] - &(&ray.o[k] * &weight);
            for (b, q) in b.iter_mut().zip(&q) {
                *b = &*b + &(&d[k] * q);
            }
            add_product(&mut c, &q, &q);
        }
        let r = axis(3);
        add_product(&mut c, &r, &r.clone().map(|r| -r));
        let a = dot(&d, &d);
        let mut disc: Poly = c.iter().map(|c| -(&a * c)).collect();
        add_product(&mut disc, &b, &b);
        Self { number, a, b, c, disc }
    }

    /// `|x - c(u)|² - r(u)²` at the point `s` of the line.
    fn around(&self, s: &Dyadic) -> Poly {
        let mut p = self.c.clone();
        p[0] = &p[0] + &(&(s * s) * &self.a);
        for (p, b) in p.iter_mut().zip(&self.b) {
            *p = &*p - &(s * b).scale2(1);
        }
        p
    }

    /// The closed parts of the piece in which `D >= 0`.
    fn runs(&self) -> Vec<ExactRun> {
        let [left, right] = [-1.0, 1.0].map(Dyadic::from);
        let all = |thick: bool| ExactRun {
            from: left.clone(),
            to: right.clone(),
            first: true,
            last: true,
            thick,
            ball: Ball::At(left.clone()),
            about: -1.0,
        };
        let Some(roots) = ExactRoots::new(self.disc.clone()) else {
            // The line touches all balls, in one point or along an interval.
            return vec![all(self.b[1..].iter().any(|b| !b.is_zero()))];
        };
        let found = roots.isolate(&roots.beside(-1.0, -1.0), &roots.beside(1.0, 1.0));
        let within =
            |root: &Isolated| roots.compare(&left, root).is_le() && roots.compare(&right, root).is_ge();
        let found: Vec<Isolated> = found.into_iter().filter(within).collect();
        if found.is_empty() {
            return if value(&self.disc, &left).exact_sign().is_gt() { vec![all(true)] } else { vec![] };
        }
        let mut runs = Vec::new();
        let mut current: Option<ExactRun> = None;
        let mut before = left.clone();
        let width = Dyadic::from(U).scale2(-60);
        for (i, root) in found.iter().enumerate() {
            let at_left = roots.compare(&left, root).is_eq();
            let at_right = roots.compare(&right, root).is_eq();
            if i == 0 && !at_left && root.before.is_gt() {
                current = Some(all(true));
            }
            let end = root.end().clone().min(right.clone());
            let run = current.get_or_insert_with(|| ExactRun {
                from: before.clone(),
                to: right.clone(),
                first: at_left,
                last: false,
                thick: false,
                ball: Ball::Root(root.clone()),
                about: roots.narrowed(&mut root.clone(), &width).1.to_f64().clamp(-1.0, 1.0),
            });
            run.last = at_right;
            if !at_right && root.after.is_gt() {
                (run.thick, run.last) = (true, true);
                if matches!(run.ball, Ball::Root(_)) {
                    run.ball = Ball::At(end.clone());
                }
            } else if let Some(mut run) = current.take() {
                run.to = end.clone();
                runs.push(run);
            }
            before = end;
        }
        runs.extend(current);
        runs
    }

    /// Where `s` lies relative to the interval of a run.
    fn place(&self, run: &ExactRun, s: &Dyadic) -> Ordering {
        let g = self.around(s);
        let ends = [&run.from, &run.to].map(|x| value(&g, x).exact_sign());
        if ends.iter().any(|sign| sign.is_le()) {
            return Equal;
        }
        let Some(roots) = ExactRoots::new(g) else { return Equal };
        if !roots.isolate(&run.from, &run.to).is_empty() {
            return Equal;
        }
        // All balls of the run are on one side.
        let mut way: Poly = self.b.iter().map(|b| -b.clone()).collect();
        way[0] = &way[0] + &(&self.a * s);
        match &run.ball {
            Ball::At(x) => value(&way, x).exact_sign(),
            Ball::Root(root) => match ExactRoots::new(self.disc.clone()) {
                Some(roots) => roots.sign_at_root(&way, root),
                None => Equal,
            },
        }
    }
}

/// Where `s` lies relative to the interval of a chain.
fn place(pieces: &[ExactPiece], members: &[Member], s: &Dyadic) -> Ordering {
    let mut told = Equal;
    for Member { piece, run } in members {
        match pieces[*piece].place(run, s) {
            Equal => return Equal,
            side => told = side,
        }
    }
    told
}

/// A bracket, as narrow as requested or as f64 allows, of the number at which `is_behind` changes
/// from false to true.
fn bracket(guess: f64, widths: &Widths, is_behind: impl Fn(&Dyadic) -> bool) -> (f64, f64) {
    let behind = |s: f64| is_behind(&Dyadic::from(s));
    let guess = if guess.is_finite() { guess.clamp(-FAR, FAR) } else { 0.0 };
    let (mut lo, mut hi) = (-FAR, FAR);
    let mut step = 4.0 * U * guess.abs().max(0.5);
    if behind(guess) {
        hi = guess;
        while hi > -FAR && step < FAR {
            let next = guess - step;
            if !behind(next) {
                lo = next;
                break;
            }
            (hi, step) = (next, step * 64.0);
        }
    } else {
        lo = guess;
        while lo < FAR && step < FAR {
            let next = guess + step;
            if behind(next) {
                hi = next;
                break;
            }
            (lo, step) = (next, step * 64.0);
        }
    }
    while hi - lo > 2.0 * widths.half * widths.scale(lo) && lo.next_up() < hi {
        let m = (0.5 * (lo + hi)).max(lo.next_up()).min(hi.next_down());
        if behind(m) {
            hi = m;
        } else {
            lo = m;
        }
    }
    (lo, hi)
}

/// The order of the intervals of two chains: `Equal` if they meet.
fn order(pieces: &[ExactPiece], a: &Chain, b: &Chain) -> Ordering {
    if a.span.to.hi < b.span.from.lo {
        return Less;
    }
    if b.span.to.hi < a.span.from.lo {
        return Greater;
    }
    if a.span.from.hi <= b.span.to.lo && b.span.from.hi <= a.span.to.lo {
        return Equal;
    }
    let mut lo = Dyadic::from(a.span.from.lo.min(b.span.from.lo));
    let mut hi = Dyadic::from(a.span.to.hi.max(b.span.to.hi));
    for _ in 0..MOST_HALVINGS {
        let m = (&lo + &hi).scale2(-1);
        match (place(pieces, &a.members, &m), place(pieces, &b.members, &m)) {
            (Equal, Equal) => return Equal,
            (Greater, Less) => return Less,
            (Less, Greater) => return Greater,
            (Less, _) | (_, Less) => lo = m,
            _ => hi = m,
        }
    }
    Equal
}

/// The runs of the line, in groups that overlap, ascending.
struct Groups {
    pieces: Vec<ExactPiece>,
    groups: Vec<Vec<Chain>>,
    /// False if the ray is not exactly known; then these are the runs of a nearby ray.
    certain: bool,
}

/// Finds the spans of the line, ascending. Returns false if the ray is not exactly known; then the
/// spans are those of a nearby ray.
pub(super) fn unite<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    numbers: &[u32],
    widths: &Widths,
    spans: &mut Vec<Span>,
) -> bool {
    let Groups { groups, certain, .. } = grouped(sweep, basis, at, numbers, widths);
    spans.clear();
    spans.extend(groups.iter().filter_map(|group| {
        let all = group.iter().map(|chain| chain.span);
        all.reduce(|a, b| a.with(&b))
    }));
    certain
}

/// A step along the line, in units: far less than the distance between the ends of a span.
const STEP: f64 = durer_math::scale::pow2(-300);

/// The position of an end of the range, moved by `steps` [`STEP`]s, relative to the span with this
/// number; `None` if unknown.
#[cold]
#[inline(never)]
pub(super) fn place_of_end<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    numbers: &[u32],
    widths: &Widths,
    (span, end, steps): (usize, End, f64),
) -> Option<Ordering> {
    let Groups { pieces, groups, certain } = grouped(sweep, basis, at, numbers, widths);
    let s = &at.end_in_ring::<Dyadic>(end) + &Dyadic::from(steps * STEP);
    let places = groups.get(span)?.iter().map(|chain| place(&pieces, &chain.members, &s));
    let told = places.reduce(|a, b| if a == b { a } else { Equal })?;
    certain.then_some(told)
}

fn grouped<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    numbers: &[u32],
    widths: &Widths,
) -> Groups {
    let known = at.in_ring::<Dyadic>();
    let certain = known.is_some();
    let ray = known.unwrap_or_else(|| RingRay {
        o: at.o.to_array().map(Dyadic::from),
        d: at.d.to_array().map(Dyadic::from),
        w: Dyadic::from(1.0),
    });
    let mut pieces = Vec::new();
    let mut open: Vec<Vec<Member>> = Vec::new();
    for &number in numbers {
        let Some(points) = sweep.piece::<K>(number as usize) else { continue };
        let piece = ExactPiece::new(sweep, basis, &ray, number, points);
        let index = pieces.len();
        for run in piece.runs() {
            let goes_on = |last: &Vec<Member>| {
                last.last().is_some_and(|it| {
                    let other: &ExactPiece = &pieces[it.piece];
                    it.run.last && it.piece < index && other.number + 1 == number
                })
            };
            let member = Member { piece: index, run };
            match open.last_mut() {
                Some(last) if member.run.first && goes_on(last) => last.push(member),
                _ => open.push(vec![member]),
            }
        }
        pieces.push(piece);
    }
    let mut chains: Vec<Chain> = open.into_iter().map(|members| chain(&pieces, members, widths)).collect();
    chains.sort_by(|a, b| a.span.from.lo.total_cmp(&b.span.from.lo));
    // Chains that meet form one group, transitively.
    let mut groups: Vec<Vec<Chain>> = Vec::new();
    for chain in chains {
        let (meeting, apart): (Vec<_>, Vec<_>) = groups
            .into_iter()
            .partition(|group: &Vec<Chain>| group.iter().any(|other| order(&pieces, &chain, other).is_eq()));
        groups = apart;
        let mut group = vec![chain];
        group.extend(meeting.into_iter().flatten());
        groups.push(group);
    }
    groups.sort_by(|a, b| order(&pieces, &a[0], &b[0]));
    Groups { pieces, groups, certain }
}

/// A chain with its span.
fn chain(pieces: &[ExactPiece], members: Vec<Member>, widths: &Widths) -> Chain {
    // The approximate places of its balls, and which one reaches farthest.
    let guess = |sign: f64| {
        let mut best = (f64::NEG_INFINITY, (0, 0.0));
        for Member { piece, run } in &members {
            let piece = &pieces[*piece];
            let a = piece.a.to_f64();
            let (from, to) = (run.from.to_f64().max(-1.0), run.to.to_f64().min(1.0));
            let at = |p: &[Dyadic], x: f64| value(p, &Dyadic::from(x)).to_f64();
            let reach = |x: f64| {
                let disc = value(&piece.disc, &Dyadic::from(x));
                if disc.exact_sign().is_lt() {
                    return f64::NEG_INFINITY;
                }
                (sign * at(&piece.b, x) + disc.to_f64().sqrt()) / a
            };
            let mut x = run.about;
            for i in 0..=16 {
                let next = from + (to - from) * f64::from(i) / 16.0;
                if reach(next) > reach(x) {
                    x = next;
                }
            }
            // A run may be narrower than the spacing of f64 numbers.
            if best.0 == f64::NEG_INFINITY {
                best = (sign * at(&piece.b, x) / a, (piece.number, x));
            }
            // Ternary search.
            let step = (to - from) / 16.0;
            let (mut l, mut r) = ((x - step).max(from), (x + step).min(to));
            for _ in 0..60 {
                let (p, q) = (l + (r - l) / 3.0, r - (r - l) / 3.0);
                if reach(p) < reach(q) { l = p } else { r = q }
            }
            for x in [x, l, r] {
                if reach(x) > best.0 {
                    best = (reach(x), (piece.number, x));
                }
            }
        }
        (sign * best.0, best.1)
    };
    let end = |sign: f64, is_behind: &dyn Fn(&Dyadic) -> bool| {
        let (s, ball) = guess(sign);
        let (lo, hi) = bracket(s, widths, is_behind);
        RunEnd { s: s.max(lo).min(hi), lo, hi, ball }
    };
    let from = end(-1.0, &|s| place(pieces, &members, s).is_ge());
    let to = end(1.0, &|s| place(pieces, &members, s).is_gt());
    let touches = members.iter().all(|it| !it.run.thick);
    Chain { span: Span { from, to, touches }, members }
}
