//! Classification of stretches of a line: certainly no root, at most one root, or undecided.
//!
//! R. E. Moore, *Interval Analysis*, Prentice-Hall 1966; D. P. Mitchell, "Robust ray intersection
//! with interval arithmetic", Graphics Interface 1990; here with eight stretches of one ray in each
//! pass over the tape.

use super::line::{BoundedLine, signs};
use super::root_isolator::{CertifiedFunction, Found, SignInfo};
use durer_formula::I8;
use durer_formula::Tape;

/// After this many passes over a tape for one ray the rest counts as unresolved, so the work for a
/// ray is bounded.
pub(super) const MOST_PASSES: u32 = 40_000;

/// Classifies `[lo, hi]`. `take` gets the stretches in ascending order, without gaps, and returns
/// whether to continue.
pub(super) fn isolate(
    line: &BoundedLine,
    tape: &Tape,
    (lo, hi): (f64, f64),
    passes: &mut u32,
    take: &mut dyn FnMut(f64, f64, SignInfo) -> bool,
) -> bool {
    let node: [f64; 9] = core::array::from_fn(|i| match i {
        0 => lo,
        8 => hi,
        _ => (lo + (hi - lo) * (i as f64 / 8.0)).max(lo).min(hi),
    });
    let a: [f64; 8] = core::array::from_fn(|i| node[i]);
    let b: [f64; 8] = core::array::from_fn(|i| node[i + 1]);
    // Most stretches of a cell with surface have no root; bounds of the values alone prove that at
    // a third of the cost.
    let v = line.bounds(tape, &a, &b);
    *passes += 1;
    let plain = sign_infos(&v);
    if plain.iter().all(Option::is_some) {
        return (0..8).all(|i| plain[i].is_none_or(|verdict| take(a[i], b[i], verdict)));
    }
    let g = line.slopes(tape, &a, &b);
    *passes += 1;
    let mut verdict = sign_infos(&g.v);
    let smooth = !(g.v.partial | g.v.jump | g.d.partial);
    for (i, verdict) in
        verdict.iter_mut().enumerate().filter(|(i, verdict)| verdict.is_none() && smooth >> i & 1 == 1)
    {
        if g.d.lo.0[i] > 0.0 {
            *verdict = Some(SignInfo::Monotone(true));
        } else if g.d.hi.0[i] < 0.0 {
            *verdict = Some(SignInfo::Monotone(false));
        }
    }
    for (i, verdict) in verdict.iter_mut().enumerate() {
        if verdict.is_none() && g.v.jump >> i & 1 == 1 {
            *verdict = line.sign_beside_jumps(tape, a[i], b[i]).map(SignInfo::Sign);
            *passes += 1;
        }
    }
    if verdict.iter().any(Option::is_none) {
        let middle: [f64; 8] = core::array::from_fn(|i| 0.5 * a[i] + 0.5 * b[i]);
        let m = line.bounds(tape, &middle, &middle);
        *passes += 1;
        for i in 0..8 {
            if verdict[i].is_none() {
                let slope = g.d.lo.0[i].abs().max(g.d.hi.0[i].abs());
                let slope = (smooth >> i & 1 == 1).then_some(slope);
                let reach = (middle[i] - a[i]).max(b[i] - middle[i]);
                verdict[i] = by_mean_value(line, &m, i, slope, reach, *passes);
            }
        }
    }
    for i in 0..8 {
        let go_on = match verdict[i] {
            Some(verdict) => take(a[i], b[i], verdict),
            None => isolate(line, tape, (a[i], b[i]), passes, take),
        };
        if !go_on {
            return false;
        }
    }
    true
}

/// The facts that bounds of the values alone prove.
fn sign_infos(v: &I8) -> [Option<SignInfo>; 8] {
    let sign = signs(v);
    core::array::from_fn(|i| match sign[i] {
        Some(sign) => Some(SignInfo::Sign(sign)),
        None if v.empty >> i & 1 == 1 || v.lo.0[i] > 0.0 || v.hi.0[i] < 0.0 => Some(SignInfo::Gap),
        None => None,
    })
}

/// The facts that the value in the middle and bounds of the slope prove about a stretch; `None` if
/// it must be divided.
fn by_mean_value(
    line: &BoundedLine,
    middle: &I8,
    i: usize,
    slope: Option<f64>,
    reach: f64,
    passes: u32,
) -> Option<SignInfo> {
    if let Some(slope) = slope {
        let spread = slope * reach * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        let (lo, hi) = (middle.lo.0[i], middle.hi.0[i]);
        if lo > spread {
            return Some(SignInfo::Sign(true));
        }
        if hi < -spread {
            return Some(SignInfo::Sign(false));
        }
        // The value at the middle cannot be separated from zero, and the stretch adds no more than
        // its rounding.
        if lo <= 0.0 && hi >= 0.0 && spread <= hi - lo {
            return Some(SignInfo::Unresolved);
        }
    }
    (reach <= line.ulp || passes >= MOST_PASSES).then_some(SignInfo::Unresolved)
}

/// The most passes for each part of a cluster when its sign is checked.
const PASSES_OF_A_PART: u32 = 256;
/// The most parts that are checked at each end.
const MOST_PARTS: u32 = 128;

/// Shortens a cluster at its ends by parts that certainly have the sign before or behind it. This
/// is for rays whose budget of passes was used up.
#[cold]
pub(super) fn trimmed(line: &BoundedLine, tape: &Tape, mut found: Found) -> Found {
    // A cluster that begins with another sign, as where a container's face meets the surface, has a
    // crossing there.
    let (before, after) = match found.sign {
        0 => (found.touches, found.touches),
        sign => (Some(sign < 0), Some(sign > 0)),
    };
    let end = |from: f64, to: f64, beyond: Option<bool>| {
        let Some(sign) = line.sign(tape, from) else { return from };
        if beyond.is_some_and(|it| it != sign) {
            return from;
        }
        let (mut known, mut part) = (from, 0.5 * (to - from));
        for _ in 0..MOST_PARTS {
            if part.abs() <= 4.0 * line.ulp {
                break;
            }
            let next = known + part;
            let is_beyond = (to - next) * part <= 0.0;
            if !is_beyond && has_sign(line, tape, (known.min(next), known.max(next)), sign) {
                known = next;
            } else {
                part *= 0.5;
            }
        }
        known
    };
    let (lo, hi) = (end(found.lo, found.hi, before), end(found.hi, found.lo, after));
    if lo <= hi {
        (found.lo, found.hi) = (lo, hi);
        found.s = (0.5 * lo + 0.5 * hi).max(lo).min(hi);
    }
    found
}

/// Whether a stretch certainly has this sign, with bounded effort.
fn has_sign(line: &BoundedLine, tape: &Tape, (lo, hi): (f64, f64), sign: bool) -> bool {
    let mut passes = MOST_PASSES - PASSES_OF_A_PART;
    isolate(line, tape, (lo, hi), &mut passes, &mut |a, b, verdict| match verdict {
        SignInfo::Sign(it) => it == sign,
        // A rising `g` is least at its start.
        SignInfo::Monotone(rises) => line.sign(tape, if rises == sign { a } else { b }) == Some(sign),
        SignInfo::Gap | SignInfo::Unresolved => false,
    })
}
