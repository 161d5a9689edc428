//! POV-Ray's noise, for those who have its table of 267 numbers.
//!
//! ```text
//!   n(p) = sum of w (T[b]/2 + T[b+1] x + T[b+2] y + T[b+3] z)    over the corners of the lattice's cell
//! ```
//!
//! `(x, y, z)` is the offset from the corner, `w` the product of `3 t^2 - 2 t^3` along the three
//! axes, and `b` a hash of the corner from 0 to 255. The three components of the vector noise have
//! `b`, `b + 4` and `b + 8`. The table is not part of durer: it is measured from an installed
//! POV-Ray.

use durer_math::noise::NoiseTable;
use durer_math::{F8, Point3, Vec3};

/// The length of the table.
const TABLE: usize = 267;

/// Cells are counted from here, modulo the length of the permutation.
const FIRST_CELL: i64 = 10_000;
pub(crate) const PERIOD: usize = 4096;

/// POV-Ray's noise with its table.
#[derive(Clone, PartialEq)]
pub struct LearnedNoise {
    table: Box<[f64]>,
    /// The permutation, twice.
    order: Box<[u16]>,
    /// The same noise for formulas: the scalar noise, which is the first component of the vector
    /// noise, and the other two.
    components: [&'static NoiseTable; 3],
}

impl core::fmt::Debug for LearnedNoise {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("LearnedNoise").finish_non_exhaustive()
    }
}

/// The corners of a cell: each hash, and the weight and the offset of the point from it.
type Corners = [(usize, f64, Vec3); 8];

impl LearnedNoise {
    /// The length of the table.
    pub const TABLE: usize = TABLE;

    /// The noise with a table of [`LearnedNoise::TABLE`] numbers, none of them as great as a
    /// million; `None` for any other.
    pub fn new(table: &[f64]) -> Option<Self> {
        if table.len() != TABLE {
            return None;
        }
        let order = order();
        let once: &[u16; PERIOD] = order.first_chunk()?;
        let component = |shift: usize| {
            let points = core::array::from_fn(|hash| {
                let of = |i: usize| table[hash + shift + i];
                [0.5 * of(0), of(1), of(2), of(3)]
            });
            NoiseTable::shared(&points, once)
        };
        let components = [component(0)?, component(4)?, component(8)?];
        Some(Self { table: table.into(), order, components })
    }

    /// The noise in formulas: the scalar noise, which is the first component of the vector noise,
    /// and the other two.
    pub fn components_in_formulas(&self) -> [&'static NoiseTable; 3] {
        self.components
    }

    /// The hash of the lattice point `(x, 0, 0)`, by which a table is measured.
    pub fn hash_at(x: i64) -> usize {
        let order = order();
        let [x, y, z] = [x, 0, 0].map(cell);
        hash(&order, x, y, z)
    }

    fn corners(&self, p: Point3) -> Corners {
        let (mut cells, mut t) = ([0; 3], [0.0; 3]);
        for (axis, x) in p.to_array().into_iter().enumerate() {
            // Just below a plane of the lattice a point counts as above it.
            let whole = if x < 0.0 { (x - (1.0 - 1e-10)).trunc() } else { x.trunc() };
            // Far away the cells say nothing any more.
            cells[axis] = cell(if whole.abs() < 1e15 { whole as i64 } else { 0 });
            t[axis] = x - whole;
        }
        let smooth = t.map(|t| t * t * (3.0 - 2.0 * t));
        core::array::from_fn(|corner| {
            let far = [corner & 1, corner >> 1 & 1, corner >> 2];
            let along = |axis: usize| if far[axis] == 1 { smooth[axis] } else { 1.0 - smooth[axis] };
            let offset = |axis: usize| t[axis] - far[axis] as f64;
            let hash = hash(&self.order, cells[0] + far[0], cells[1] + far[1], cells[2] + far[2]);
            (hash, along(0) * along(1) * along(2), Vec3::new(offset(0), offset(1), offset(2)))
        })
    }

    fn sum(&self, corners: &Corners, shift: usize) -> f64 {
        corners.iter().fold(0.0, |sum, &(hash, weight, v)| {
            let b = hash + shift;
            let t = |i: usize| self.table[b + i];
            sum + weight * (0.5 * t(0) + t(1) * v.x + t(2) * v.y + t(3) * v.z)
        })
    }

    /// The noise at a point, about zero.
    pub fn value(&self, p: Point3) -> f64 {
        self.sum(&self.corners(p), 0)
    }

    /// The vector noise at a point.
    pub fn vector(&self, p: Point3) -> Vec3 {
        let corners = self.corners(p);
        Vec3::new(self.sum(&corners, 0), self.sum(&corners, 4), self.sum(&corners, 8))
    }

    /// A component of the vector noise at eight points: 0, 1 or 2.
    pub fn components(&self, [x, y, z]: [&F8; 3], axis: usize) -> F8 {
        F8(core::array::from_fn(|i| {
            self.sum(&self.corners(Point3::new(x.0[i], y.0[i], z.0[i])), 4 * axis.min(2))
        }))
    }

    /// The noise at eight points.
    pub fn values(&self, [x, y, z]: [&F8; 3]) -> F8 {
        F8(core::array::from_fn(|i| self.value(Point3::new(x.0[i], y.0[i], z.0[i]))))
    }
}

fn cell(whole: i64) -> usize {
    (whole + FIRST_CELL).rem_euclid(PERIOD as i64) as usize
}

fn hash(order: &[u16], x: usize, y: usize, z: usize) -> usize {
    wide_hash(order, x, y, z) & 0xff
}

/// The hash before all but its lowest eight bits are dropped: 0 to 4095.
pub(crate) fn wide_hash(order: &[u16], x: usize, y: usize, z: usize) -> usize {
    let one = usize::from(order[x]) ^ y;
    let two = usize::from(order[one]) ^ z;
    usize::from(order[two])
}

/// The permutation: numbers exchanged by a linear congruential generator.
pub(crate) fn order() -> Box<[u16]> {
    let mut order: Vec<u16> = (0..PERIOD as u16).collect();
    let mut seed = 0_u32;
    for i in (0..PERIOD).rev() {
        seed = seed.wrapping_mul(1_812_433_253).wrapping_add(12_345);
        order.swap(i, (seed >> 16 & 0x7fff) as usize % PERIOD);
    }
    order.extend_from_within(..);
    order.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise() -> LearnedNoise {
        // Any table will do: these are not POV-Ray's numbers.
        let table: Vec<f64> = (0..TABLE).map(|i| ((i * 37 % 101) as f64 - 50.0) / 50.0).collect();
        LearnedNoise::new(&table).unwrap()
    }

    #[test]
    fn the_order_is_a_permutation() {
        let order = order();
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
            let wanted = [h, h + 4, h + 8].map(|i| noise.table[i] / 2.0);
            assert_eq!(v.to_array(), wanted);
        }
    }

    #[test]
    fn formulas_have_the_same_noise() {
        let noise = noise();
        let [scalar, ..] = noise.components_in_formulas();
        for k in 0..4096 {
            let [x, y, z] = [0.37, -0.21, 17.11].map(|step| step * f64::from(k) - 1000.0);
            let p = Point3::new(x, y, z);
            let lanes = [x, y, z].map(F8::splat);
            let in_formulas = |table| durer_math::noise::values(Some(table), lanes.each_ref()).0[0];
            // Both are within 80 roundings.
            let near = |a: f64, b: f64| (a - b).abs() <= 160.0 * durer_math::U;
            assert!(near(in_formulas(scalar), noise.value(p)), "{p:?}");
            let vector = noise.vector(p).to_array();
            for (table, wanted) in noise.components_in_formulas().into_iter().zip(vector) {
                assert!(near(in_formulas(table), wanted), "{p:?}");
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
