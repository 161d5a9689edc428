//! POV-Ray's noise, for those who have its tables.
//!
//! ```text
//!   n(p) = sum of w (T[b]/2 + T[b+1] x + T[b+2] y + T[b+3] z)    over the corners of the lattice's cell
//! ```
//!
//! `(x, y, z)` is the offset from the corner, `w` the product of `3 t^2 - 2 t^3` along the three
//! axes, and `b` a hash of the corner from 0 to 255. The three components of the vector noise have
//! `b`, `b + 4` and `b + 8`.
//!
//! The third noise generator is gradient noise instead: each corner has one of 2048 unit vectors `g`
//! as slope and no value, and its points are shifted ([`durer_formula::noise::ROWS_SHIFT`]).
//!
//! The numbers are not part of durer: they are measured from an installed POV-Ray.

use durer_formula::noise::permutation::{PERIOD, permutation, wide_hash};
use durer_formula::noise::{self, NoiseTable, VectorTable};
use durer_math::{F8, Point3, Vec3};

/// The length of the table.
const TABLE: usize = 267;

/// Cells are counted from here, modulo the length of the permutation.
const FIRST_CELL: i64 = 10_000;

/// POV-Ray's noise with its table.
#[derive(Clone, PartialEq)]
pub struct LearnedNoise {
    /// The scalar noise, which is the first component of the vector noise, and the other two.
    vector: VectorTable,
    /// The table of the third noise generator.
    rows: &'static NoiseTable,
}

impl core::fmt::Debug for LearnedNoise {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("LearnedNoise").finish_non_exhaustive()
    }
}

impl LearnedNoise {
    /// The length of the table.
    pub const TABLE: usize = TABLE;

    /// The noise with a table of [`LearnedNoise::TABLE`] numbers, none of them as great as a
    /// million; `None` for any other.
    pub fn new(table: &[f64]) -> Option<Self> {
        if table.len() != TABLE {
            return None;
        }
        let order = permutation();
        let once: &[u16; PERIOD] = order.first_chunk()?;
        let points = [0, 4, 8].map(|shift: usize| {
            core::array::from_fn(|hash| {
                let of = |i: usize| table[hash + shift + i];
                [0.5 * of(0), of(1), of(2), of(3)]
            })
        });
        let vector = VectorTable::shared(points.each_ref(), once)?;
        Some(Self { vector, rows: NoiseTable::own_rows() })
    }

    /// With the slopes of the third noise generator and how they are distributed, see
    /// [`NoiseTable::of_rows`]; without them that generator is durer's own. `None` if these make no table.
    pub fn with_rows(self, slopes: &[[f64; 3]], starts: [&[u16]; 2]) -> Option<Self> {
        Some(Self { rows: NoiseTable::of_rows(slopes, starts)?, ..self })
    }

    /// The table of the third noise generator.
    pub fn rows(&self) -> &'static NoiseTable {
        self.rows
    }

    /// The scalar noise, which is the first component of the vector noise, and the other two.
    pub fn components(&self) -> [&'static NoiseTable; 3] {
        self.vector.components()
    }

    /// The hash of the lattice point `(x, 0, 0)`, by which a table is measured.
    pub fn hash_at(x: i64) -> usize {
        let order = permutation();
        let [x, y, z] = [x, 0, 0].map(cell);
        hash(&order, x, y, z)
    }

    /// The noise at a point, about zero.
    pub fn value(&self, p: Point3) -> f64 {
        self.component(0, p.to_array().map(F8::splat).each_ref()).0[0]
    }

    /// The vector noise at a point.
    pub fn vector(&self, p: Point3) -> Vec3 {
        let lanes = p.to_array().map(F8::splat);
        let [x, y, z] = self.vectors(lanes.each_ref()).map(|component| component.0[0]);
        Vec3::new(x, y, z)
    }

    /// The vector noise at eight points.
    pub fn vectors(&self, p: [&F8; 3]) -> [F8; 3] {
        self.vector.values(p)
    }

    /// A component of the vector noise at eight points: 0, which is the scalar noise, 1 or 2.
    pub fn component(&self, axis: usize, p: [&F8; 3]) -> F8 {
        noise::values(Some(self.components()[axis.min(2)]), p)
    }
}

fn cell(whole: i64) -> usize {
    (whole + FIRST_CELL).rem_euclid(PERIOD as i64) as usize
}

fn hash(order: &[u16], x: usize, y: usize, z: usize) -> usize {
    wide_hash(order, x, y, z) & 0xff
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any table will do: these are not POV-Ray's numbers.
    fn table() -> Vec<f64> {
        (0..TABLE).map(|i| ((i * 37 % 101) as f64 - 50.0) / 50.0).collect()
    }

    fn noise() -> LearnedNoise {
        LearnedNoise::new(&table()).unwrap()
    }

    #[test]
    fn the_order_is_a_permutation() {
        let order = permutation();
        let mut seen = order[..PERIOD].to_vec();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(i, &n)| i == usize::from(n)));
        assert_eq!(order[..PERIOD], order[PERIOD..]);
    }

    #[test]
    fn at_a_point_of_the_lattice_the_table_is_seen() {
        let noise = noise();
        for x in -20..20 {
            let h = LearnedNoise::hash_at(x);
            let v = noise.vector(Point3::new(x as f64, 0.0, 0.0));
            let wanted = [h, h + 4, h + 8].map(|i| table()[i] / 2.0);
            assert_eq!(v.to_array(), wanted);
        }
    }

    /// The definition, term by term.
    fn defined(order: &[u16], table: &[f64], p: [f64; 3], shift: usize) -> f64 {
        let whole = p.map(f64::floor);
        let mut sum = 0.0;
        for corner in 0..8 {
            let far = [corner & 1, corner >> 1 & 1, corner >> 2];
            let at = |axis: usize| cell(whole[axis] as i64) + far[axis];
            let b = shift + hash(order, at(0), at(1), at(2));
            let (mut weight, mut value) = (1.0, table[b] / 2.0);
            for axis in 0..3 {
                let t = p[axis] - whole[axis];
                let smooth = t * t * (3.0 - 2.0 * t);
                weight *= if far[axis] == 1 { smooth } else { 1.0 - smooth };
                value += table[b + 1 + axis] * (t - far[axis] as f64);
            }
            sum += weight * value;
        }
        sum
    }

    #[test]
    fn it_is_the_noise_of_the_definition() {
        let (noise, order, table) = (noise(), permutation(), table());
        for k in 0..4096 {
            let p = [0.37, -0.21, 17.11].map(|step| step * f64::from(k) - 1000.0);
            let point = Point3::from(p);
            // Both err by less than 80 roundings of 1, since no number of the table is above 1.
            let near = |a: f64, b: f64| (a - b).abs() <= 160.0 * durer_math::U;
            assert!(near(noise.value(point), defined(&order, &table, p, 0)), "{p:?}");
            for (axis, value) in noise.vector(point).to_array().into_iter().enumerate() {
                assert!(near(value, defined(&order, &table, p, 4 * axis)), "{p:?}");
            }
        }
        // One table, however often it is read.
        assert_eq!(noise, self::noise());
    }

    #[test]
    fn noise_is_continuous_and_finite() {
        let noise = noise();
        for k in 0..200 {
            let p = Point3::new(0.37 * f64::from(k) - 30.0, -0.21 * f64::from(k), 0.11 * f64::from(k));
            let near = p + Vec3::new(1e-9, -1e-9, 1e-9);
            assert!((noise.value(p) - noise.value(near)).abs() < 1e-7);
        }
        for x in [1e300, -1e300, f64::INFINITY, f64::NAN] {
            let _ = noise.value(Point3::new(x, 0.0, x));
        }
        assert!(LearnedNoise::new(&[0.0; 5]).is_none() && LearnedNoise::new(&[f64::NAN; TABLE]).is_none());
    }
}
