//! A piece that a ray meets nearly at a tangent, or whose slopes vanish at a pole: cut into eight
//! again and again until every part is empty, holds one proven crossing, or is as small as the
//! errors.

use super::line::{Found, View};
use super::piece::{Domain, Piece, halves};
use crate::patch::line::Line;
use durer_math::U;
use durer_math::scale::pow2;
use durer_roots::two_unknowns::{Content, Limits, Local, ROUNDED};

/// The most times that parts of a piece are cut for one ray; the rest stays unresolved. A tangent
/// needs some dozens. A surface has up to a thousand pieces, and a line within it may meet them all.
const MOST_CUTS: usize = 256;
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
    let reach = view.reach(slowest(&local.0.j), &local, part);
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

impl View<'_> {
    /// The values of a combination of both functions on a piece with this local data. The combination is
    /// one of the coordinates of the point, whose slopes it bounds: their errors cancel in it where a
    /// line is almost in the surface, but not in the two functions.
    pub(super) fn reach(&self, by: [f64; 2], (local, limits): &(Local, Limits), piece: &Piece) -> Reach {
        let Line { axes, slope, slope_err, .. } = self.line;
        let sum = |x: [f64; 2]| by[0].abs() * x[0].abs() + by[1].abs() * x[1].abs();
        let value = by[0].mul_add(local.f[0], by[1] * local.f[1]);
        let c = [by[0], by[1], -by[0].mul_add(slope[0], by[1] * slope[1])];
        let c_err = (sum(*slope_err) + 2.0 * U * sum(*slope)) * ROUNDED;
        // The combination itself rounds.
        let mut rounding = sum(local.f);
        let mut change = 0.0;
        for k in 0..2 {
            let (mut along, mut err, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
            for i in 0..3 {
                let (s, e) = (piece.slope[axes[i]][k], piece.slope_err[axes[i]][k]);
                along = c[i].mul_add(s, along);
                size += (c[i] * s).abs();
                err += c[i].abs() * e + if i == 2 { c_err * (s.abs() + e) } else { 0.0 };
            }
            rounding += size;
            change += along.abs() + err;
        }
        let rounding = 4.0 * U * rounding;
        let change = piece.half() * (change + rounding) * ROUNDED + rounding;
        // An unbounded slope has an infinite error, not NaN.
        let change = if change.is_nan() { f64::INFINITY } else { change };
        Reach { value, change, noise: sum(limits.e), rounding }
    }
}

impl Reach {
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
