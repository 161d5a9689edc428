//! All crossings of a ray with a sweep: the runs of all pieces that it meets, joined where a run
//! continues from one piece to the next, and united.

use super::line::{Doubt, Line, MOST, PieceLine, RunEnd, Widths};
use super::spline::Basis;
use super::{SphereSweep, exact};
use crate::blob::{Along, Inner};
use crate::{CentredRay, End, LocalRay, PREVIEW_WIDTH, Root, RootKind, Sink};
use arrayvec::ArrayVec;
use core::cell::Cell;
use core::cmp::Ordering;
use durer_math::efloat::Word;
use durer_math::{Isa, RaySide, U};
use durer_roots::quadratic::NARROW;

/// Pieces farther than this from the ray's range, in units of the sweep, are skipped. Any bracket
/// is far narrower.
const ROOM: f64 = 1.0 / 1024.0;

/// An interval of the line inside the solid: one run, or several that overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) from: RunEnd,
    pub(super) to: RunEnd,
    /// Whether it is a single point.
    pub(super) touches: bool,
}

impl Span {
    /// Whether it begins before the other one ends; `None` if uncertain.
    #[inline(always)]
    fn begins_before(&self, other: &Self) -> Option<bool> {
        if self.from.hi <= other.to.lo {
            Some(true)
        } else if self.from.lo > other.to.hi {
            Some(false)
        } else {
            None
        }
    }

    /// The span from the first of two beginnings to the last of two ends.
    #[inline(always)]
    pub(super) fn with(&self, other: &Self) -> Self {
        Self {
            from: joined(&self.from, &other.from, -1.0),
            to: joined(&self.to, &other.to, 1.0),
            touches: self.touches && other.touches,
        }
    }
}

/// The greater (for `sign` 1) or lesser one of two numbers, and its bracket.
#[inline(always)]
fn joined(a: &RunEnd, b: &RunEnd, sign: f64) -> RunEnd {
    let (first, second) = if (b.s - a.s) * sign > 0.0 { (b, a) } else { (a, b) };
    let (lo, hi) =
        if sign > 0.0 { (a.lo.max(b.lo), a.hi.max(b.hi)) } else { (a.lo.min(b.lo), a.hi.min(b.hi)) };
    let s = if sign > 0.0 { first.s.max(second.s) } else { first.s.min(second.s) };
    RunEnd { s: s.max(lo).min(hi), lo, hi, ball: first.ball }
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
struct Lists {
    nodes: Vec<u32>,
    pieces: Vec<u32>,
    spans: Vec<Span>,
}

thread_local! {
    static LISTS: Cell<Lists> = Cell::default();
}

/// Passes all crossings to `sink`, ascending.
#[inline(always)]
pub(super) fn roots<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    ray: &LocalRay<'_>,
    sink: &mut dyn Sink,
) {
    let at = ray.recentre(sweep.centre, sweep.scale).sharp(1.0);
    let mut lists = LISTS.take();
    meet(sweep, &at, &mut lists, sink.limit());
    if !lists.pieces.is_empty() {
        let rough = at.local().rough;
        let (half, most) =
            if rough { (0.25 * PREVIEW_WIDTH, 0.5 * PREVIEW_WIDTH) } else { (4.0 * U, 0.5 * NARROW) };
        let widths = Widths { origin: at.shift(), half, most };
        let Lists { pieces, spans, .. } = &mut lists;
        let mut certain = true;
        let capsule = sweep.capsule.as_ref().and_then(|it| it.span(&at, &widths).ok());
        if let Some(span) = capsule {
            spans.clear();
            spans.extend(span);
        } else if unite(sweep, basis, &at, Precision::Double, pieces, &widths, spans).is_err() {
            certain = unite_exactly(sweep, basis, &at, pieces, &widths, spans);
        }
        show(sweep, basis, &at, (pieces, spans), &widths, certain, sink);
    }
    LISTS.set(lists);
}

/// The numbers of the pieces whose boxes the ray meets in its range, ascending.
#[inline(always)]
fn meet(sweep: &SphereSweep, at: &CentredRay<'_>, lists: &mut Lists, limit: f64) {
    let along = Along::new(at);
    let ray = at.local();
    let (begin, end) = at.window((ray.t_min, ray.t_max.min(limit)));
    let (begin, end) = (begin - ROOM, end + ROOM);
    let Lists { nodes, pieces, .. } = lists;
    nodes.clear();
    pieces.clear();
    nodes.push(0);
    while let Some(node) = nodes.pop() {
        let Some((near, far)) = sweep.tree.entry(node, &along) else { continue };
        if far < begin || near > end {
            continue;
        }
        match sweep.tree.inner(node) {
            Inner::Nodes(a, b) => {
                nodes.push(a);
                nodes.push(b);
            }
            Inner::Leaf(from, to) => pieces.extend_from_slice(&sweep.order[from..to]),
        }
    }
    pieces.sort_unstable();
}

/// A run of a piece as an interval of the line, and whether it holds the piece's first and last ball.
type Stretch = (Span, [bool; 2]);

/// The runs of one piece.
type Stretches = ArrayVec<Stretch, MOST>;

/// The runs of a piece that the line meets.
#[inline(always)]
fn stretches<T: Word, const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    line: &Line<T>,
    (number, points): (u32, &[[f64; 4]; K]),
    widths: &Widths,
) -> Result<Stretches, Doubt> {
    let mut found = Stretches::new();
    let piece = PieceLine::<T, K, M>::new(sweep, basis, line, number, points);
    if piece.misses() {
        return Ok(found);
    }
    for run in &piece.runs()? {
        let [from, to] = [piece.end(run, -1.0, widths)?, piece.end(run, 1.0, widths)?];
        found.push((Span { from, to, touches: false }, [run.first, run.last]));
    }
    Ok(found)
}

/// The runs of a piece that the line meets, in double-double.
#[cold]
#[inline(never)]
fn stretches_in_double_double<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    piece: (u32, &[[f64; 4]; K]),
    widths: &Widths,
) -> Result<Stretches, Doubt> {
    let wide = Line::wide(at).ok_or(Doubt)?;
    Isa::detect().run(
        #[inline(always)]
        || stretches(sweep, basis, &wide, piece, widths),
    )
}

/// The precision in which runs are computed first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Precision {
    /// In f64, and in double-double for the pieces for which f64 is not enough.
    Double,
    DoubleDouble,
}

/// Finds the spans of the line, ascending and disjoint.
#[inline(always)]
fn unite<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    precision: Precision,
    pieces: &[u32],
    widths: &Widths,
    spans: &mut Vec<Span>,
) -> Result<(), Doubt> {
    spans.clear();
    let line = Line::double(at);
    // The piece whose last ball the last span holds.
    let mut goes_on = None;
    for &number in pieces {
        let Some(points) = sweep.piece::<K>(number as usize) else { continue };
        let piece = (number, points);
        let in_double = match precision {
            Precision::Double => stretches(sweep, basis, &line, piece, widths),
            Precision::DoubleDouble => Err(Doubt),
        };
        let found = match in_double {
            Ok(found) => found,
            Err(Doubt) => stretches_in_double_double(sweep, basis, at, piece, widths)?,
        };
        for (span, [first, last]) in &found {
            match spans.last_mut() {
                Some(before) if *first && number > 0 && goes_on == Some(number - 1) => {
                    *before = before.with(span);
                }
                _ => spans.push(*span),
            }
            goes_on = last.then_some(number);
        }
    }
    merge(spans)
}

/// Unites spans that overlap.
#[inline(always)]
fn merge(spans: &mut Vec<Span>) -> Result<(), Doubt> {
    if spans.len() < 2 {
        return Ok(());
    }
    spans.sort_unstable_by(|a, b| a.from.lo.total_cmp(&b.from.lo));
    let mut kept = 0;
    for i in 1..spans.len() {
        let (last, next) = (spans[kept], spans[i]);
        // They meet if each begins before the other ends. The first one may begin after the second,
        // but only by less than the width of their brackets.
        match (next.begins_before(&last), last.begins_before(&next)) {
            (Some(true), Some(true)) => spans[kept] = last.with(&next),
            (Some(false), Some(true)) => {
                kept += 1;
                spans[kept] = next;
            }
            _ => return Err(Doubt),
        }
    }
    spans.truncate(kept + 1);
    Ok(())
}

/// [`unite`] with all pieces in double-double, then exactly. Returns whether the spans are certain.
#[cold]
#[inline(never)]
fn unite_exactly<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    pieces: &[u32],
    widths: &Widths,
    spans: &mut Vec<Span>,
) -> bool {
    unite(sweep, basis, at, Precision::DoubleDouble, pieces, widths, spans).is_ok()
        || exact::unite(sweep, basis, at, pieces, widths, spans)
}

/// Passes on the crossings that are in the ray's range.
#[inline(always)]
fn show<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    (pieces, spans): (&[u32], &[Span]),
    widths: &Widths,
    certain: bool,
    sink: &mut dyn Sink,
) {
    let mut least = f64::NEG_INFINITY;
    let spawned = at.spawned().is_some();
    for (number, span) in spans.iter().enumerate() {
        let ends: &[(&RunEnd, i8)] =
            if span.touches { &[(&span.from, 0)] } else { &[(&span.from, -1), (&span.to, 1)] };
        for &(end, sign) in ends {
            let (mut lo, hi) = at.bracket(end.lo, end.hi);
            let admitted = at.admits(lo, hi);
            if admitted == Some(false)
                || admitted.is_none()
                    && is_beyond(sweep, basis, at, (pieces, spans), widths, (number, (lo, hi), sign))
            {
                continue;
            }
            if spawned {
                lo = lo.max(0.0).min(hi);
            }
            let t = at.t(end.s).max(lo).min(hi).max(least);
            least = t;
            let (piece, x) = end.ball;
            let kind = match (certain, sign) {
                (false, _) => RootKind::Cluster,
                (true, 0) => RootKind::Grazing,
                _ => RootKind::Simple,
            };
            let tag = [f64::from(piece), x];
            let root = Root { t, lo, hi: hi.max(t), s: end.s, tag, face: 0, sign, kind };
            if sink.push(root).is_break() {
                return;
            }
        }
    }
}

/// Whether a crossing whose bracket holds an end of the range lies beyond it. So the crossing is in
/// exactly one of two ranges that meet there, whatever its bracket.
///
/// The side of the surface on which the end lies decides, if no other crossing may be nearby.
#[cold]
#[inline(never)]
fn is_beyond<const K: usize, const M: usize>(
    sweep: &SphereSweep,
    basis: &Basis<K, M>,
    at: &CentredRay<'_>,
    (pieces, spans): (&[u32], &[Span]),
    widths: &Widths,
    (number, (lo, hi), sign): (usize, (f64, f64), i8),
) -> bool {
    let near = |it: &RunEnd| {
        let (l, h) = at.bracket(it.lo, it.hi);
        usize::from(l <= hi && lo <= h)
    };
    let from = number.saturating_sub(1);
    let crowd: usize =
        spans[from..].iter().take(number - from + 2).map(|span| near(&span.from) + near(&span.to)).sum();
    let is_past = |end: End| {
        let t = at.end(end);
        if !(t.is_finite() && lo <= t && t <= hi) {
            return false;
        }
        if crowd > 1 {
            let place =
                |steps: f64| exact::place_of_end(sweep, basis, at, pieces, widths, (number, end, steps));
            match place(0.0) {
                Some(Ordering::Less) => return end == End::Max,
                Some(Ordering::Greater) => return end == End::Min,
                // If an end of the range is the only point of the span in the range, the span's
                // other end is beyond it.
                Some(Ordering::Equal) => match (end, place(if end == End::Min { 1.0 } else { -1.0 })) {
                    (End::Min, Some(Ordering::Greater)) => return sign < 0,
                    (End::Max, Some(Ordering::Less)) => return sign > 0,
                    _ => {}
                },
                None => {}
            }
        }
        if sign == 0 {
            // A touch is never proven to be beyond.
            return false;
        }
        // Also for a ray that leaves the surface: next to a double tip its recorded side may be
        // wrong.
        let side = sweep.side_at(basis, at, end);
        let is_out = match (side, end, at.spawned()) {
            (Some(Ordering::Greater), ..) => true,
            (Some(Ordering::Less), ..) => false,
            (_, End::Min, Some((side, ..))) => side == RaySide::Front,
            _ => return false,
        };
        is_out == ((sign > 0) == (end == End::Min))
    };
    is_past(End::Min) || is_past(End::Max)
}
