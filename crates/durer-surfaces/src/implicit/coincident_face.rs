//! Rays along a face that two parts of a solid share.
//!
//! ```text
//!      A  |  B          min(f, g) = 0 on all of the face that A and B share, so no sign proves
//!    -----+----->       that a ray in it is inside. A little to either side both signs are clear.
//! ```
//!
//! A regularised solid (A. A. G. Requicha, "Representations for rigid solids: theory, methods, and
//! systems", *ACM Computing Surveys* 12(4), 1980) contains the points whose neighbourhood is
//! inside, so it contains such a face. The ray is inside where two parallel lines, one on each side
//! of the face, are both certainly inside, and outside where one of them is outside. Their distance
//! starts with the error of a point and grows until something is certain, at most to the length of
//! the stretch in question. The brackets of the crossings are wider by that distance. These
//! crossings are clusters, because no sign of the ray's own proves them.

use super::line::BoundedLine;
use super::root_isolator::{CertifiedFunction, Found};
use crate::RootKind;
use crate::faces::chart::tangents;
use core::ops::ControlFlow;
use durer_formula::Tape;
use durer_math::Vec3;

/// The number of directions across the ray that are tried in half a turn.
const TURNS: usize = 8;
/// Cosines of multiples of a sixteenth of a turn.
const COSINES: [f64; 5] =
    [1.0, 0.923_879_532_511_286_7, core::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8, 0.0];
/// The most passes over eight stretches for one run.
const MOST_LOOKS: u32 = 2_000;

/// Two lines next to a ray, one on each side of the face.
struct Beside<'a> {
    tape: &'a Tape,
    lines: [BoundedLine; 2],
}

impl<'a> Beside<'a> {
    /// The lines on either side of the face, if there is one: at most of eight points of the run,
    /// the state of both lines is certain and one of them is inside.
    fn new(line: &BoundedLine, tape: &'a Tape, (lo, hi): (f64, f64)) -> Option<Self> {
        let (u, v) = tangents(line.direction() * (1.0 / line.direction().length()));
        let at: [f64; 8] = core::array::from_fn(|i| lo + (hi - lo) * ((i as f64 + 0.5) / 8.0));
        let length = (hi - lo) * line.direction().length();
        let nearest = Vec3::from(line.err).max_abs();
        let farther = |away: &f64| (4.0 * away <= length).then_some(4.0 * away);
        core::iter::successors(Some(nearest), farther).find_map(|away| {
            let pairs = (0..TURNS).map(|k| {
                let (cos, sin) =
                    if k <= 4 { (COSINES[k], COSINES[4 - k]) } else { (-COSINES[8 - k], COSINES[k - 4]) };
                let n = (u * cos + v * sin) * away;
                let pair = Self { tape, lines: [line.beside(n), line.beside(-n)] };
                let [x, y] = pair.signs(&at, &at);
                let told = (0..8).filter(|&i| {
                    x[i].is_some() && y[i].is_some() && (x[i] == Some(false) || y[i] == Some(false))
                });
                (told.count(), pair)
            });
            pairs.max_by_key(|(told, _)| *told).filter(|(told, _)| *told > 0).map(|(_, pair)| pair)
        })
    }

    /// The signs of the formula on eight stretches of both lines.
    fn signs(&self, a: &[f64; 8], b: &[f64; 8]) -> [[Option<bool>; 8]; 2] {
        [0, 1].map(|i| self.lines[i].signs(self.tape, a, b))
    }

    /// Whether eight stretches are inside, where that is certain.
    fn states(&self, a: &[f64; 8], b: &[f64; 8]) -> [Option<bool>; 8] {
        let [x, y] = self.signs(a, b);
        core::array::from_fn(|i| match (x[i], y[i]) {
            (Some(true), _) | (_, Some(true)) => Some(false),
            (Some(false), Some(false)) => Some(true),
            _ => None,
        })
    }
}

/// Passes on the crossings in a run without a known sign; `ends` says whether the ray is inside
/// before and behind it. `None` if nothing is certain.
pub(super) fn crossings(
    line: &BoundedLine,
    tape: &Tape,
    run: (f64, f64),
    ends: (bool, bool),
    show: &mut dyn FnMut(&Found) -> ControlFlow<()>,
) -> Option<ControlFlow<()>> {
    let beside = Beside::new(line, tape, run)?;
    let mut known = FaceStretches { at: run.0, inside: ends.0, show };
    let mut looks = 0;
    if beside.walk(run, line.ulp(), &mut looks, &mut known).is_break() {
        return Some(ControlFlow::Break(()));
    }
    Some(known.take(run.1, run.1, ends.1))
}

impl Beside<'_> {
    /// Visits the stretches of a run whose state is certain, in ascending order.
    fn walk(
        &self,
        (lo, hi): (f64, f64),
        ulp: f64,
        looks: &mut u32,
        known: &mut FaceStretches<'_>,
    ) -> ControlFlow<()> {
        let node: [f64; 9] = core::array::from_fn(|i| match i {
            0 => lo,
            8 => hi,
            _ => (lo + (hi - lo) * (i as f64 / 8.0)).max(lo).min(hi),
        });
        let a: [f64; 8] = core::array::from_fn(|i| node[i]);
        let b: [f64; 8] = core::array::from_fn(|i| node[i + 1]);
        *looks += 1;
        for (i, state) in self.states(&a, &b).into_iter().enumerate() {
            let flow = match state {
                Some(inside) => known.take(a[i], b[i], inside),
                None if b[i] - a[i] > 4.0 * ulp && *looks < MOST_LOOKS => {
                    self.walk((a[i], b[i]), ulp, looks, known)
                }
                None => ControlFlow::Continue(()),
            };
            flow?;
        }
        ControlFlow::Continue(())
    }
}

/// The result so far.
struct FaceStretches<'a> {
    /// The end of the last certain stretch, and whether that is inside.
    at: f64,
    inside: bool,
    show: &'a mut dyn FnMut(&Found) -> ControlFlow<()>,
}

impl FaceStretches<'_> {
    /// Takes the next certain stretch.
    fn take(&mut self, a: f64, b: f64, inside: bool) -> ControlFlow<()> {
        let (from, was) = (self.at, self.inside);
        (self.at, self.inside) = (b, inside);
        if inside == was {
            return ControlFlow::Continue(());
        }
        let (lo, hi) = (from.min(a), a);
        let sign = if inside { -1 } else { 1 };
        (self.show)(&Found { s: 0.5 * lo + 0.5 * hi, lo, hi, sign, kind: RootKind::Cluster, touches: None })
    }
}
