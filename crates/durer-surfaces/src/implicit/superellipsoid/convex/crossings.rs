//! Where a line crosses a convex superellipsoid.

use super::Gauge;
use super::gauge::{REST, Sample, VALUE};
use crate::implicit::line::BoundedLine;
use crate::implicit::root_isolator::Found;
use crate::implicit::roots::shown;
use crate::{CentredRay, LocalRay, PREVIEW_WIDTH, RootKind, Sink};
use arrayvec::ArrayVec;
use durer_math::scale::pow2;
use durer_math::{F8, Isa, Point3, RaySide, Vec3};

/// Half the width of a cube that holds the solid with a margin for all rounding, for a ray with
/// errors below [`KNOWN`].
const HALF: f64 = 1.0 + 1.0 / 64.0;
/// The largest error of a ray's points with which it is tested here.
const KNOWN: f64 = pow2(-12);
/// The most passes for a ray that comes near, before the tape decides.
const MOST_PASSES: usize = 8;
/// The most steps for a crossing. Mostly it takes two or three; every other step divides the width
/// by nine.
const MOST_STEPS: usize = 40;

/// A point of the line, with the gauge and its slope there.
#[derive(Clone, Copy, Debug)]
struct GaugeSample {
    s: f64,
    g: f64,
    slope: f64,
}

/// The answer for a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::implicit) enum Answer {
    /// All roots were passed on.
    All,
    /// It is outside except between these two `s`, where rounding leaves it open.
    Between(f64, f64),
    /// Rounding leaves it open.
    Open,
}

/// The proven facts about a line after a few passes.
enum StretchClass {
    /// It misses.
    Misses,
    /// It is outside, inside (the first and the last such sample), outside.
    Meets([GaugeSample; 4]),
    /// Between two places beyond which it is outside, rounding leaves it open.
    Grazes(GaugeSample, GaugeSample),
    /// Rounding leaves it open.
    Open,
}

/// The gauge along a line.
struct Along<'a> {
    gauge: &'a Gauge,
    isa: Isa,
    o: Vec3<F8>,
    d: Vec3<F8>,
    /// Bound on the error of a value near 1, including the error of the point.
    noise: f64,
    /// Bound on the error of the point alone.
    off: f64,
}

impl Gauge {
    /// Passes all roots in the ray's range to `sink`, ascending, if all are certain; else none.
    pub(in crate::implicit) fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) -> Answer {
        if ray.passes_by(Point3::ORIGIN, self.reach) {
            return Answer::All;
        }
        let at = ray.recentre(Point3::ORIGIN, 0).sharp(1.0);
        let known = BoundedLine::new(&at, 4.0).err.iter().sum::<f64>() < KNOWN;
        let near = at.o.max_abs() <= 2.0;
        if !(known && near) {
            return Answer::Open;
        }
        // With a direction of size 1 to 2 the cube's part of the line is within |s| < 4.
        let (mut a, mut b) = (-4.0, 4.0);
        for i in 0..3 {
            let (o, d) = (at.o[i], at.d[i]);
            if d != 0.0 {
                let (near, far) = ((-HALF - o) / d, (HALF - o) / d);
                a = if near < far { near } else { far }.max(a);
                b = if near < far { far } else { near }.min(b);
            } else if o.abs() > HALF {
                return Answer::All;
            }
        }
        let (from, to) = at.window((ray.t_min, ray.t_max));
        // The solid's part of the line is inside that of the larger cube.
        if a >= b || b < from || a > to || at.bracket(a, a).0 > sink.limit() {
            return Answer::All;
        }
        let reach = a.abs().max(b.abs());
        let line = BoundedLine::new(&at, reach);
        let off = line.err.iter().sum::<f64>() * (1.0 + 1.0 / 1024.0) + REST;
        let along = Along {
            gauge: self,
            isa: Isa::detect(),
            o: Vec3::splat(at.o),
            d: Vec3::splat(at.d),
            noise: off + VALUE * (1.0 + 1.0 / 512.0),
            off,
        };
        match along.classify(a, b) {
            StretchClass::Misses => Answer::All,
            // For a ray that was spawned here, the tape decides on which side it starts.
            StretchClass::Grazes(left, right) if at.spawned().is_none() => Answer::Between(left.s, right.s),
            StretchClass::Open | StretchClass::Grazes(..) => Answer::Open,
            StretchClass::Meets(places) => {
                if along.show(&at, (from, to), reach, &places, sink) {
                    Answer::All
                } else {
                    Answer::Open
                }
            }
        }
    }
}

impl Along<'_> {
    /// The gauge at eight points.
    #[inline(always)]
    fn nodes(&self, s: &[f64; 8]) -> [GaugeSample; 8] {
        let at = F8(*s);
        let mut sample = Sample::new();
        self.gauge.sample(self.isa, &(self.d.map(|d| d * at) + self.o), &mut sample);
        let n = &sample.gradient;
        let slope = n.x * self.d.x + n.y * self.d.y + n.z * self.d.z;
        core::array::from_fn(|i| GaugeSample { s: s[i], g: sample.value.0[i], slope: slope.0[i] })
    }

    /// Whether a sample is outside; `None` if uncertain.
    #[inline(always)]
    fn side(&self, node: &GaugeSample) -> Option<bool> {
        if node.g - 1.0 > self.noise {
            Some(true)
        } else if 1.0 - node.g > self.noise {
            Some(false)
        } else {
            None
        }
    }

    /// Classifies the line from `a` to `b`, beyond which it is outside. The samples converge to the
    /// gauge's minimum.
    fn classify(&self, a: f64, b: f64) -> StretchClass {
        let step = (b - a) / 7.0;
        let first = self.nodes(&core::array::from_fn(|i| if i == 7 { b } else { a + step * i as f64 }));
        let mut seen: ArrayVec<GaugeSample, 10> = first.into_iter().collect();
        let (mut left, mut right) = (first[0], first[7]);
        if self.side(&left) != Some(true) || self.side(&right) != Some(true) {
            return StretchClass::Open;
        }
        let mut turns = None;
        for _ in 0..MOST_PASSES {
            let mut inside: Option<(GaugeSample, GaugeSample)> = None;
            for node in &seen {
                match (self.side(node), inside) {
                    (Some(true), None) => left = *node,
                    (Some(true), Some(_)) => {
                        right = *node;
                        break;
                    }
                    (Some(false), None) => inside = Some((*node, *node)),
                    (Some(false), Some((first, _))) => inside = Some((first, *node)),
                    (None, _) => {}
                }
            }
            if let Some((first, last)) = inside {
                return StretchClass::Meets([left, first, last, right]);
            }
            // No sample is inside: `left` is the last one outside, and decides nothing.
            let turn = seen.windows(2).find(|pair| pair[1].slope >= 0.0);
            let Some(&[x, y]) = turn else {
                let Some(last) = seen.last() else { return StretchClass::Open };
                return self.beyond(last, b - a);
            };
            if x.slope >= 0.0 {
                return self.beyond(&x, b - a);
            }
            if self.misses(&x, &y) {
                return StretchClass::Misses;
            }
            turns = Some((x.s, y.s));
            let step = (y.s - x.s) / 9.0;
            if step <= pow2(-40) {
                break;
            }
            let inner = self.nodes(&core::array::from_fn(|i| x.s + step * (i as f64 + 1.0)));
            seen.clear();
            seen.push(x);
            seen.extend(inner);
            seen.push(y);
            (left, right) = (first[0], first[7]);
        }
        turns.map_or(StretchClass::Open, |turns| self.grazed(first[0], first[7], turns))
    }

    /// The stretch around the gauge's minimum that rounding leaves open. Beyond a sample that is
    /// outside, where the gauge certainly rises, everything is outside, too. Narrows the stretch as
    /// far as possible.
    #[cold]
    fn grazed(
        &self,
        mut left: GaugeSample,
        mut right: GaugeSample,
        (mut first, mut last): (f64, f64),
    ) -> StretchClass {
        let sure = 8.0 * self.gauge.turn;
        let outside = |node: &GaugeSample| self.side(node) == Some(true);
        if !(outside(&left) && left.slope < -sure && outside(&right) && right.slope > sure) {
            return StretchClass::Open;
        }
        for _ in 0..MOST_STEPS {
            let (before, behind) = (first - left.s, right.s - last);
            if before <= pow2(-48) && behind <= pow2(-48) {
                break;
            }
            let nodes = self.nodes(&core::array::from_fn(|i| match i {
                0..4 => left.s + before * ((i as f64 + 1.0) / 5.0),
                _ => last + behind * ((i as f64 - 3.0) / 5.0),
            }));
            if nodes.iter().any(|node| self.side(node) == Some(false)) {
                return StretchClass::Open;
            }
            match nodes[..4].iter().position(|node| !(outside(node) && node.slope < -sure)) {
                Some(0) => first = nodes[0].s,
                Some(open) => (left, first) = (nodes[open - 1], nodes[open].s),
                None => left = nodes[3],
            }
            match nodes[4..].iter().rposition(|node| !(outside(node) && node.slope > sure)) {
                Some(3) => last = nodes[7].s,
                Some(open) => (right, last) = (nodes[open + 5], nodes[open + 4].s),
                None => right = nodes[4],
            }
        }
        StretchClass::Grazes(left, right)
    }

    /// The gauge is least at one end of the stretch: that end decides whether it falls below 1.
    fn beyond(&self, end: &GaugeSample, length: f64) -> StretchClass {
        let slack = 8.0 * self.gauge.turn * length + self.noise + 2.0 * self.off + VALUE * end.g;
        if end.g - 1.0 > slack { StretchClass::Misses } else { StretchClass::Open }
    }

    /// Whether the tangents at two samples, falling and rising, meet above 1.
    ///
    /// A tangent's value on the exact line has the value's own error, the point's twice (there and
    /// where it is evaluated), and the slope's, at most `8` times the gradient's for directions of
    /// size below 2.
    fn misses(&self, x: &GaugeSample, y: &GaugeSample) -> bool {
        let sure = 8.0 * self.gauge.turn;
        if !(-x.slope > sure && y.slope > sure) {
            return false;
        }
        let weight = y.slope / (y.slope - x.slope);
        let length = y.s - x.s;
        let least = weight * (x.g + x.slope * length) + (1.0 - weight) * y.g;
        let slack = sure * length + self.noise + 2.0 * self.off + VALUE * (x.g + y.g);
        least - 1.0 > slack
    }

    /// Passes on the crossings between outside, inside and outside that are in the range.
    fn show(
        &self,
        at: &CentredRay<'_>,
        (from, to): (f64, f64),
        reach: f64,
        [left, first, last, right]: &[GaugeSample; 4],
        sink: &mut dyn Sink,
    ) -> bool {
        let (mut enters, mut leaves) = (first.s >= from && left.s <= to, right.s >= from && last.s <= to);
        if let Some((side, 0, start)) = at.spawned() {
            // A ray that starts outside starts before the inside part, or behind it.
            match side {
                RaySide::Back => enters = false,
                RaySide::Front if start.hi() < last.s => {}
                RaySide::Front if start.lo() > first.s => (enters, leaves) = (false, false),
                RaySide::Front => return false,
            }
        }
        let fine = reach * pow2(-50);
        let widest = if at.local().rough { PREVIEW_WIDTH * reach * 0.25 } else { fine };
        // The crossing, ascending; as narrow as possible if the range may end in its bracket.
        let refined = |out: &GaugeSample, inn: &GaugeSample| {
            let ascending = |(s, a, b): (f64, f64, f64)| (s, a.min(b), a.max(b));
            let (s, lo, hi) = ascending(self.refined(*out, *inn, widest));
            let (first, last) = at.bracket(lo, hi);
            if widest > fine && at.admits(first, last).is_none() {
                ascending(self.refined(*out, *inn, fine))
            } else {
                (s, lo, hi)
            }
        };
        if at.bracket(left.s, left.s).0 > sink.limit() {
            return true;
        }
        if enters {
            let (s, lo, hi) = refined(left, first);
            let root = Found { s, lo, hi, sign: -1, kind: RootKind::Simple, touches: None };
            if shown(at, sink, &root).is_break() {
                return true;
            }
        }
        if leaves && at.bracket(last.s, last.s).0 <= sink.limit() {
            let (s, lo, hi) = refined(right, last);
            let _ = shown(at, sink, &Found { s, lo, hi, sign: 1, kind: RootKind::Simple, touches: None });
        }
        true
    }

    /// The crossing between a sample outside and one inside: its approximate place, and two such
    /// samples nearer to each other.
    fn refined(&self, mut out: GaugeSample, mut inn: GaugeSample, widest: f64) -> (f64, f64, f64) {
        let mut even = false;
        for _ in 0..MOST_STEPS {
            let width = inn.s - out.s;
            let fall = (out.g - inn.g) / width.abs();
            let first = (widest / 32.0).max(1.25 * self.noise / fall);
            if width.abs() <= widest.max(4.0 * first) {
                break;
            }
            let (guess, spread) = guess(&out, &inn);
            let at = if even {
                core::array::from_fn(|i| out.s + width * ((i as f64 + 1.0) / 9.0))
            } else {
                let steps = [(0.5, 512.0), (0.125, 64.0), (1.0 / 64.0, 8.0), (1.0 / 512.0, 1.0)];
                let step = |i: usize| (spread * steps[i].0).max(first * steps[i].1).copysign(width);
                let (lo, hi) = (out.s.min(inn.s), out.s.max(inn.s));
                core::array::from_fn(|i| {
                    let s = if i < 4 { guess - step(i) } else { guess + step(7 - i) };
                    s.max(lo).min(hi)
                })
            };
            for node in self.nodes(&at) {
                match self.side(&node) {
                    Some(true) => out = node,
                    Some(false) => {
                        inn = node;
                        break;
                    }
                    None => {}
                }
            }
            even = (inn.s - out.s).abs() > 0.5 * width.abs();
        }
        let (s, _) = guess(&out, &inn);
        (s, out.s, inn.s)
    }
}

/// The approximate place where the gauge is 1 between a sample outside and one inside, and the
/// distance between the estimates by tangents and by the chord.
fn guess(out: &GaugeSample, inn: &GaugeSample) -> (f64, f64) {
    let width = inn.s - out.s;
    let share = (out.g - 1.0) / (out.g - inn.g);
    let chord = share * width;
    // By convexity the crossing is between the later of the two tangents' estimates and the
    // chord's, up to rounding.
    let before = |x: f64| if x / width > 0.0 && x.abs() <= chord.abs() { x } else { 0.0 };
    let falls = inn.slope / out.slope > 0.0;
    let (first, second) = ((1.0 - out.g) / out.slope, width + (1.0 - inn.g) / inn.slope);
    let (first, second) = (before(first), if falls { before(second) } else { 0.0 });
    let tangent = if first.abs() > second.abs() { first } else { second };
    // The cubic with the values and slopes of the inverse at both samples (C. Hermite). If it
    // leaves that interval, there is an edge between, and a tangent describes the surface.
    let (x, rest) = (share, 1.0 - share);
    let run = inn.g - out.g;
    let cubic = width * x * x * (3.0 - 2.0 * x) + x * rest * run * (rest / out.slope - x / inn.slope);
    let fits = falls && cubic / width > 0.0 && cubic.abs() <= chord.abs() && cubic.abs() >= tangent.abs();
    let way = if fits {
        cubic
    } else if falls {
        tangent
    } else {
        0.5 * (chord + tangent)
    };
    let (lo, hi) = (out.s.min(inn.s), out.s.max(inn.s));
    ((out.s + way).max(lo).min(hi), (chord - tangent).abs())
}
