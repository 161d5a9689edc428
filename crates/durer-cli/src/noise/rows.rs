//! The 2048 slopes of the third noise generator, and how they are distributed.
//!
//! ```text
//!   N(p) = 0.4925 + 0.795 g(p + s),   g(x, y, z) = sum of w (G[k] . (offset from the corner)),   k = z + b[y + a[x]]
//! ```
//!
//! over the corners of the cell of the unit lattice, whose points repeat after 2048 along each axis. The
//! numbering may start anywhere, so `a[0] = 0` and `b[0] = 0`. On the edge between two corners `g` depends
//! only on their slopes along the edge, so two places there give both: first all of `G`, along the rows
//! with x = y = 0. Then `b[y]` is where the row through `(0, y)` begins, found by its first two slopes
//! along z. The rows through `(x, 0)` and `(x, 1)` begin at `b[a[x]]` and `b[a[x] + 1]`, which together
//! give `a[x]`.

use super::povray::{Asked, float};
use super::{ALLOWED, CHECKED, checked};
use durer::formula::noise::{self, NoiseTable, ROWS_SHIFT};
use durer::math::F8;

const PERIOD: usize = NoiseTable::ROW;
/// The places on an edge at which noise is measured.
const PLACES: [f64; 2] = [0.25, 0.75];
/// `N` is the first of these times `g`, and the second added.
const SCALE: [f64; 2] = [0.795, 0.4925];
/// A bound on the errors of measured slopes. The errors of two numbers of noise make one of at most
/// `1/(a - b)` = 10.7 times the larger in a slope, see [`slopes`]; `N` has below twelve roundings of 1.
const ERROR: f64 = 10.7 / SCALE[0] * 12.0 * 0.5 * f64::EPSILON;

/// The slopes, and `a` and `b`.
pub(super) struct Rows {
    pub(super) slopes: Vec<[f64; 3]>,
    pub(super) starts: [Vec<u16>; 2],
}

/// An edge: a corner, and the axis along which the other one is.
type Edge = ([usize; 3], usize);

/// The measured edges: rows along each axis, then where the rows through other points begin.
fn edges() -> impl Iterator<Item = Edge> {
    let first = (0..3).flat_map(|axis| (0..PERIOD).map(move |z| ([0, 0, z], axis)));
    let starts = |at: fn(usize) -> [usize; 3]| (0..PERIOD).map(move |k| (at(k), 2));
    first.chain(starts(|y| [0, y, 0])).chain(starts(|x| [x, 0, 0])).chain(starts(|x| [x, 1, 0]))
}

const EDGES: usize = 6 * PERIOD;

/// The points at which noise is measured. All are exact, also in single steps of 2^-29, to which POV-Ray
/// rounds shifted points.
fn measured() -> impl Iterator<Item = [f64; 3]> {
    edges().flat_map(|(corner, axis)| {
        PLACES.map(|t| {
            let mut p = corner.map(|x| x as f64 - ROWS_SHIFT);
            p[axis] += t;
            p
        })
    })
}

/// What POV-Ray has to print.
pub(super) fn asked() -> Vec<Asked> {
    let points = measured().chain(checked());
    points.map(|[x, y, z]| float(&format!("f_noise_generator({x}, {y}, {z}, 3)"))).collect()
}

/// The slopes along an edge at both of its corners, from what was printed for its two places.
fn slopes(said: &[f64]) -> [f64; 2] {
    let [near, far] = [0, 1].map(|i| (said[i] - SCALE[1]) / SCALE[0]);
    // With the slopes `p` and `q` and the blend `f`, noise is `(1 - f) t p - f (1 - t) q`. At the second
    // place, `1 - t`, the blend is `1 - f`.
    let t = PLACES[0];
    let f = t * t * (3.0 - 2.0 * t);
    let (a, b) = ((1.0 - f) * t, f * (1.0 - t));
    // near = a p - b q and far = b p - a q.
    let below = a * a - b * b;
    [(a * near - b * far) / below, (b * near - a * far) / below]
}

/// The rows for the printed numbers, and the largest difference at the checked points.
pub(super) fn found(said: &[f64]) -> Option<(Rows, f64)> {
    if said.len() != 2 * EDGES + CHECKED {
        return None;
    }
    let along: Vec<[f64; 2]> = said[..2 * EDGES].chunks_exact(2).map(slopes).collect();
    let part = |k: usize| &along[k * PERIOD..(k + 1) * PERIOD];
    let all: Vec<[f64; 3]> = (0..PERIOD).map(|z| [0, 1, 2].map(|axis| part(axis)[z][0])).collect();
    let is_same = |a: f64, b: f64| (a - b).abs() <= 2.0 * ERROR;
    // Where the row begins that has these two slopes along z.
    let begins = |[p, q]: &[f64; 2]| {
        (0..PERIOD).find(|&k| is_same(all[k][2], *p) && is_same(all[(k + 1) % PERIOD][2], *q))
    };
    let begin = |k: usize| part(k).iter().map(begins).collect::<Option<Vec<usize>>>();
    let (b, beside, next) = (begin(3)?, begin(4)?, begin(5)?);
    let place = |x: usize| (0..PERIOD).find(|&y| b[y] == beside[x] && b[(y + 1) % PERIOD] == next[x]);
    let a = (0..PERIOD).map(place).collect::<Option<Vec<usize>>>()?;
    let starts = [a, b].map(|list| list.into_iter().map(|k| k as u16).collect::<Vec<_>>());
    let table = NoiseTable::of_rows(&all, [&starts[0], &starts[1]])?;
    let seen = &said[2 * EDGES..];
    let difference = |(p, seen): ([f64; 3], &f64)| (value(table, p) - seen).abs();
    let largest = checked().zip(seen).map(difference).fold(0.0, f64::max);
    (largest <= ALLOWED).then_some((Rows { slopes: all, starts }, largest))
}

/// The third generator's noise of a table.
fn value(table: &'static NoiseTable, p: [f64; 3]) -> f64 {
    let [x, y, z] = p.map(|x| F8::splat(x + ROWS_SHIFT));
    (SCALE[0] * noise::values(Some(table), [&x, &y, &z]).0[0] + SCALE[1]).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_found_again_in_their_noise() {
        let slope = |k: usize, step: f64| (k as f64 * step).fract() - 0.5;
        let slopes: Vec<[f64; 3]> =
            (0..PERIOD).map(|k| [0.618_034, 0.414_214, 0.732_051].map(|step| slope(k, step))).collect();
        // Numbers may occur more than once.
        let starts = [1237, 411].map(|factor| {
            (0..PERIOD).map(|k| if k == 1900 { 7 } else { (k * factor % PERIOD) as u16 }).collect::<Vec<_>>()
        });
        let table = NoiseTable::of_rows(&slopes, [&starts[0], &starts[1]]).unwrap();
        let mut said: Vec<f64> = measured().chain(checked()).map(|p| value(table, p)).collect();
        let (rows, difference) = found(&said).unwrap();
        assert!(difference <= ALLOWED && rows.starts == starts, "{difference}");
        for (found, made) in rows.slopes.iter().zip(&slopes) {
            assert!((0..3).all(|i| (found[i] - made[i]).abs() <= ERROR), "{found:?} {made:?}");
        }
        // A single wrong number is noticed.
        said[2 * 3 * PERIOD + 1000] += 1e-6;
        assert!(found(&said).is_none());
    }
}
