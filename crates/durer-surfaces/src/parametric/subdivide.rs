//! A piece that a ray meets nearly at a tangent, or whose slopes vanish at a pole: cut into eight
//! again and again until every part is empty, holds one proven crossing, or is as small as the
//! errors.

use super::line::{Found, View};
use super::piece::{Domain, Piece, halves};
use durer_math::U;
use durer_math::scale::pow2;
use durer_roots::two_unknowns::{Content, Limits, Local, ROUNDED};

/// The most times that parts of a piece are cut for one ray; the rest stays unresolved. A tangent
/// needs some dozens.
const MOST_CUTS: usize = 1024;
/// A part on which all values are within this many errors of zero is not cut further.
const NOISE: f64 = 8.0;
/// The least width of a part, relative to the domain's.
const LEAST: f64 = pow2(-48);

/// Appends the crossings of a line and a piece, and the parts of it in which crossing and miss
/// cannot be distinguished.
pub(super) fn meet(view: &View<'_>, piece: &Piece, out: &mut Vec<Found>) {
    let mut open = vec![*piece];
    let (mut boxes, mut parts) = (Vec::<Domain>::with_capacity(8), Vec::with_capacity(8));
    let mut cuts = 0;
    while let Some(piece) = open.pop() {
        let widths = [0, 1].map(|k| {
            let [from, to] = view.face.domain[k];
            piece.width[k] / (to - from)
        });
        // The values of both functions: along a line of the surface they change only across it.
        let mut change = view.change(&piece);
        if change.iter().any(|c| !c.is_finite()) {
            change = widths;
        }
        boxes.clear();
        boxes.push(piece.own);
        // Where the parameter along which they change most is as narrow as can be, the other one
        // decides nothing: along an edge that is one point.
        for _ in 0..if cuts < MOST_CUTS { 3 } else { 0 } {
            let k = usize::from(change[1] > change[0]);
            if widths[k] <= LEAST {
                break;
            }
            change[k] *= 0.5;
            for i in 0..boxes.len() {
                let [low, high] = halves(&boxes[i], k);
                boxes[i] = low;
                boxes.push(high);
            }
        }
        if boxes.len() == 1 {
            // Without bounds there is no place for a crossing.
            if piece.is_bounded() {
                out.push(view.unresolved(&piece));
            }
            continue;
        }
        cuts += 1;
        crate::steps::cut();
        boxes.retain(|own| own.iter().all(|[from, to]| from < to));
        parts.clear();
        view.face.pieces(piece.face, &boxes, view.unit, &mut parts);
        for part in &parts {
            if view.is_cut_off(&part.hull) {
                continue;
            }
            match view.content(part) {
                Content::Nothing => continue,
                Content::AtMostOne(start) if view.meet_at_most_one(part, start, out) => continue,
                _ => {}
            }
            match along_slowest(view, part) {
                Slow::Clear => {}
                Slow::Noise => out.push(view.unresolved(part)),
                Slow::Unknown => open.push(*part),
            }
        }
    }
}

/// The bounds of the combination of both functions that changes most slowly on a part.
enum Slow {
    /// It vanishes nowhere.
    Clear,
    /// It is as good as zero everywhere.
    Noise,
    Unknown,
}

fn along_slowest(view: &View<'_>, part: &Piece) -> Slow {
    let local = view.local(part);
    let reach = Reach::new(slowest(&local.0.j), &local, part.half());
    if reach.sign() != 0 {
        Slow::Clear
    } else if (reach.value.abs() + reach.change) * ROUNDED <= NOISE * (reach.noise + reach.rounding) {
        Slow::Noise
    } else {
        Slow::Unknown
    }
}

/// The values of a combination of both functions on a piece.
pub(super) struct Reach {
    /// The value in the middle.
    value: f64,
    /// A bound on how far other values are from it, rounding included.
    change: f64,
    /// A bound on the error of the values, and on the rounding of the combination.
    noise: f64,
    rounding: f64,
}

impl Reach {
    /// On a piece with this local data and this half of its width.
    pub(super) fn new(by: [f64; 2], (local, limits): &(Local, Limits), half: f64) -> Self {
        let sum = |x: [f64; 2]| by[0].abs() * x[0].abs() + by[1].abs() * x[1].abs();
        let value = by[0].mul_add(local.f[0], by[1] * local.f[1]);
        let change: f64 = (0..2).map(|k| by[0].mul_add(local.j[0][k], by[1] * local.j[1][k]).abs()).sum();
        // The combination itself rounds.
        let rounding =
            4.0 * U * (sum(local.f) + sum([0, 1].map(|i: usize| local.j[i][0].abs() + local.j[i][1].abs())));
        let change = half * (change + 2.0 * sum(limits.e_j)) + rounding;
        Self { value, change, noise: sum(limits.e), rounding }
    }

    /// The sign of all values, 0 if it is not certain.
    pub(super) fn sign(&self) -> i8 {
        let far = (self.change + self.noise) * ROUNDED;
        i8::from(self.value > far) - i8::from(self.value < -far)
    }
}

/// The combination of both functions that changes most slowly: the left singular vector of the
/// slopes.
pub(super) fn slowest(j: &[[f64; 2]; 2]) -> [f64; 2] {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0].mul_add(b[0], a[1] * b[1]);
    let (p, q, r) = (dot(j[0], j[0]), dot(j[0], j[1]), dot(j[1], j[1]));
    // The direction of the larger eigenvalue of J J'.
    let half = 0.5 * (p - r);
    let root = half.mul_add(half, q * q).sqrt();
    let [a, b] = if half >= 0.0 { [half + root, q] } else { [q, root - half] };
    let length = a.mul_add(a, b * b).sqrt();
    if length > 0.0 && length.is_finite() { [-b / length, a / length] } else { [0.0, 1.0] }
}
