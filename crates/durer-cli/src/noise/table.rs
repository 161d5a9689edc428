//! The table of 267 numbers of the first two noise generators and of vector noise.
//!
//! At a lattice point with the hash `h`, vector noise is `(T[h], T[h + 4], T[h + 8])/2`. The last three
//! numbers of the table are slopes only: they follow from points beside the one with the greatest hash.

use super::povray::{Asked, float, vector};
use super::{ALLOWED, CHECKED, checked};
use durer::math::Point3;
use durer::scene::LearnedNoise;

/// How far the points are from the lattice at which slopes are measured.
const AWAY: f64 = 1.0 / 1024.0;
/// The hash whose slopes stand at the table's end.
const LAST: usize = 255;
/// The lattice points that are searched for all hashes.
const SEARCHED: i64 = 4096;
/// How many vectors are printed, and how many numbers in all.
const VECTORS: usize = LAST + 1 + 3;
pub(super) const NUMBERS: usize = 3 * VECTORS + CHECKED;

/// A lattice point `(x, 0, 0)` for each hash.
fn lattice() -> Option<Vec<i64>> {
    (0..=LAST).map(|hash| (0..SEARCHED).find(|&x| LearnedNoise::hash_at(x) == hash)).collect()
}

/// The points whose vector noise is measured.
fn measured() -> Option<Vec<[f64; 3]>> {
    let lattice = lattice()?;
    let x0 = lattice[LAST] as f64;
    let near = [[x0 + AWAY, 0.0, 0.0], [x0, AWAY, 0.0], [x0, 0.0, AWAY]];
    Some(lattice.iter().map(|&x| [x as f64, 0.0, 0.0]).chain(near).collect())
}

/// What POV-Ray has to print; `None` if not all hashes were found.
pub(super) fn asked() -> Option<Vec<Asked>> {
    let vectors = measured()?.into_iter();
    let vectors = vectors.map(|[x, y, z]| vector(&format!("vturbulence(2, 0.5, 1, <{x}, {y}, {z}>)")));
    Some(vectors.chain(checked().map(|[x, y, z]| float(&format!("f_noise3d({x}, {y}, {z})")))).collect())
}

/// The table for the printed numbers, and the largest difference at the checked points.
pub(super) fn found(said: &[f64]) -> Option<(Vec<f64>, f64)> {
    if said.len() != NUMBERS {
        return None;
    }
    let mut table = [f64::NAN; LearnedNoise::TABLE];
    for (hash, v) in said.chunks_exact(3).take(LAST + 1).enumerate() {
        for (component, value) in v.iter().enumerate() {
            let (held, value) = (&mut table[hash + 4 * component], rounded(2.0 * value));
            // Most numbers are seen three times.
            if *held != value && !held.is_nan() {
                return None;
            }
            *held = value;
        }
    }
    let end = LearnedNoise::TABLE - 3;
    table[end..].fill(0.0);
    let x0 = lattice()?[LAST] as f64;
    let weight = 1.0 - AWAY * AWAY * (3.0 - 2.0 * AWAY);
    let without = LearnedNoise::new(&table)?;
    for axis in 0..3 {
        let mut p = [x0, 0.0, 0.0];
        p[axis] += AWAY;
        let seen = said[3 * (LAST + 1 + axis) + 2];
        let rest = seen - without.vector(Point3::new(p[0], p[1], p[2])).z;
        table[end + axis] = rounded(rest / (weight * AWAY));
    }
    let noise = LearnedNoise::new(&table)?;
    let mut largest = 0.0_f64;
    for ([x, y, z], seen) in checked().zip(&said[3 * VECTORS..]) {
        let own = ((noise.value(Point3::new(x, y, z)) + 1.052_42) * 0.489_855_82).clamp(0.0, 1.0);
        largest = largest.max((own - seen).abs());
    }
    (largest <= ALLOWED).then(|| (table.to_vec(), largest))
}

/// With six significant digits, as the numbers of the table have.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_found_again_in_its_noise() {
        let made: Vec<f64> =
            (0..LearnedNoise::TABLE).map(|i| rounded(((i * 37 % 101) as f64 - 50.0) / 70.0)).collect();
        let noise = LearnedNoise::new(&made).unwrap();
        let points = measured().unwrap();
        let mut said: Vec<f64> =
            points.into_iter().flat_map(|[x, y, z]| noise.vector(Point3::new(x, y, z)).to_array()).collect();
        said.extend(checked().map(|[x, y, z]| {
            ((noise.value(Point3::new(x, y, z)) + 1.052_42) * 0.489_855_82).clamp(0.0, 1.0)
        }));
        let (table, difference) = found(&said).unwrap();
        assert_eq!((table, difference), (made, 0.0));
        // A single wrong number is noticed.
        said[100] += 1e-3;
        assert!(found(&said).is_none());
    }
}
