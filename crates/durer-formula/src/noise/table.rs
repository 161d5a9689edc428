//! Noise whose values and slopes are in a table.

use super::permutation::permutation;
use super::{CellNumbers, Grain, Lattice, Sum, number};
use core::f64::consts::TAU;
use durer_math::elementary;
use durer_math::real::Eight;
use durer_math::scale::pow2;
use std::sync::{Mutex, OnceLock};

/// The values and slopes of the points of a lattice, and how these are distributed.
///
/// Tables are shared and live as long as the program: steps of formulas refer to them.
pub struct NoiseTable {
    points: TablePoints,
    /// The greatest of the slopes and of twice the values, and at least 2^-20, so that the bounds
    /// of rounding cover values too small for single precision.
    size: f64,
}

/// The points of a table.
pub(super) enum TablePoints {
    Hashed(Box<Hashed>),
    Rows(Box<Rows>),
}

/// Points with values and slopes, distributed by a permutation `p`: the point `(x, y, z)` has number
/// `p[p[p[x] ^ y] ^ z]` modulo 256, with coordinates relative to -10000, modulo 4096.
#[derive(PartialEq)]
pub(super) struct Hashed {
    /// For each point the value and the three slopes.
    points: [[f64; 4]; Hashed::POINTS],
    /// The permutation, twice.
    order: [u16; 2 * Hashed::PERIOD],
}

impl Hashed {
    /// How many cells along an axis differ; further ones repeat them.
    pub(super) const PERIOD: usize = 4096;
    /// The cell 0 has this number.
    const FIRST: u32 = 10_000;
    /// How many points of the lattice differ.
    pub(super) const POINTS: usize = 256;

    #[inline(always)]
    fn next(&self, at: u32) -> u32 {
        self.order[at as usize % (2 * Self::PERIOD)].into()
    }
}

/// Points with slopes and without values, of which all lines along z hold the same row: the point
/// `(x, y, z)` has number `z + b[y + a[x]]`, all modulo 2048.
#[derive(PartialEq)]
pub(super) struct Rows {
    slopes: [[f64; 3]; Rows::PERIOD],
    /// `a` and `b`.
    starts: [[u16; Rows::PERIOD]; 2],
}

impl Rows {
    /// How many points of the lattice differ, and how many along each axis.
    const PERIOD: usize = 2048;
}

static TABLES: Mutex<Vec<&'static NoiseTable>> = Mutex::new(Vec::new());

impl NoiseTable {
    /// How many points differ in a table of rows, and how many along each axis.
    pub const ROW: usize = Rows::PERIOD;

    /// The table with these points (for each the value and the three slopes) and this permutation `p`:
    /// the point `(x, y, z)` has number `p[p[p[x] ^ y] ^ z]` modulo 256, with coordinates relative to
    /// -10000, modulo 4096. `None` if a number is not finite or too large for single precision, or the
    /// permutation has a number from 4096 on. Equal tables are one.
    pub fn shared(
        points: &[[f64; 4]; Hashed::POINTS],
        order: &[u16; Hashed::PERIOD],
    ) -> Option<&'static Self> {
        if !order.iter().all(|&k| usize::from(k) < Hashed::PERIOD) {
            return None;
        }
        let mut twice = [0; 2 * Hashed::PERIOD];
        twice[..Hashed::PERIOD].copy_from_slice(order);
        twice[Hashed::PERIOD..].copy_from_slice(order);
        let numbers = points.iter().flat_map(|&[v, x, y, z]| [2.0 * v, x, y, z]);
        Self::kept(TablePoints::Hashed(Box::new(Hashed { points: *points, order: twice })), numbers)
    }

    /// The table whose points have these slopes and no values: the point `(x, y, z)` has number
    /// `z + b[y + a[x]]`, all modulo 2048, where `starts` is `[a, b]`. `None` if there are not 2048 of
    /// each, if a slope is not finite or too large for single precision, or if a start is 2048 or
    /// more. Equal tables are one.
    pub fn of_rows(slopes: &[[f64; 3]], [a, b]: [&[u16]; 2]) -> Option<&'static Self> {
        let starts = [*a.first_chunk()?, *b.first_chunk()?];
        let all_are_known = [slopes.len(), a.len(), b.len()] == [Rows::PERIOD; 3];
        if !all_are_known || !starts.iter().flatten().all(|&k| usize::from(k) < Rows::PERIOD) {
            return None;
        }
        let rows = Rows { slopes: *slopes.first_chunk()?, starts };
        Self::kept(TablePoints::Rows(Box::new(rows)), slopes.iter().flatten().copied())
    }

    /// A table of rows with random unit vectors as slopes, for whoever has learned no other.
    pub fn own_rows() -> &'static Self {
        static OWN: OnceLock<&NoiseTable> = OnceLock::new();
        OWN.get_or_init(|| {
            let order = permutation();
            let starts =
                [0, 1].map(|k| core::array::from_fn(|i| order[k * Rows::PERIOD + i] % Rows::PERIOD as u16));
            let numbers = CellNumbers::get();
            let slopes: [[f64; 3]; Rows::PERIOD] = core::array::from_fn(|i| {
                let [u, v, _] = numbers.of([i as f64, 0.0, 0.0]);
                let z = 1.0 - 2.0 * u;
                let (sin, cos) = elementary::sin_cos(TAU * v);
                let r = (1.0 - z * z).sqrt();
                [r * cos, r * sin, z]
            });
            let points = TablePoints::Rows(Box::new(Rows { slopes, starts }));
            Box::leak(Box::new(Self { points, size: 1.0 }))
        })
    }

    /// The table with these points, whose slopes and twice whose values are `numbers`.
    fn kept(points: TablePoints, numbers: impl Iterator<Item = f64>) -> Option<&'static Self> {
        let mut size = pow2(-20);
        for x in numbers {
            if x.is_nan() || x.abs() >= 1e6 {
                return None;
            }
            size = x.abs().max(size);
        }
        let mut tables = TABLES.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let is_same = |table: &&&Self| match (&table.points, &points) {
            (TablePoints::Hashed(one), TablePoints::Hashed(other)) => one == other,
            (TablePoints::Rows(one), TablePoints::Rows(other)) => one == other,
            _ => false,
        };
        if let Some(table) = tables.iter().find(is_same) {
            return Some(table);
        }
        let table: &Self = Box::leak(Box::new(Self { points, size }));
        tables.push(table);
        Some(table)
    }

    #[inline(always)]
    pub(super) fn points(&self) -> &TablePoints {
        &self.points
    }

    #[inline(always)]
    pub(super) fn size(&self) -> f64 {
        self.size
    }
}

/// Tables are the same if they are one, see [`NoiseTable::shared`].
impl PartialEq for NoiseTable {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self, other)
    }
}

impl core::fmt::Debug for NoiseTable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("NoiseTable").finish_non_exhaustive()
    }
}

/// Points of a table, and the table's size.
pub(super) struct TableLattice<'a, T>(pub(super) &'a T, pub(super) f64);

impl<T> Copy for TableLattice<'_, T> {}

impl<T> Clone for TableLattice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl Lattice for TableLattice<'_, Hashed> {
    // Cells may reach 4097: the permutation goes on as it begins there, and so do the numbers that
    // are combined with it.
    const STEP: [u32; 3] = [1; 3];

    #[inline(always)]
    fn size(self) -> f64 {
        self.1
    }

    #[inline(always)]
    fn cell(self, whole: f64, _: usize) -> u32 {
        number(whole).wrapping_add(Hashed::FIRST) % Hashed::PERIOD as u32
    }

    #[inline(always)]
    fn hash(self, before: u32, cell: u32, _: usize) -> u32 {
        self.0.next(before ^ cell)
    }

    #[inline(always)]
    fn values<T: Grain>(self, hash: &[u32; 8]) -> Sum<T> {
        gathered(hash, |hash| self.0.points[hash as usize % Hashed::POINTS])
    }
}

impl Lattice for TableLattice<'_, Rows> {
    const STEP: [u32; 3] = [1; 3];

    #[inline(always)]
    fn size(self) -> f64 {
        self.1
    }

    #[inline(always)]
    fn cell(self, whole: f64, _: usize) -> u32 {
        number(whole)
    }

    #[inline(always)]
    fn hash(self, before: u32, cell: u32, axis: usize) -> u32 {
        let along = before.wrapping_add(cell);
        // Along z, the numbers go on.
        self.0.starts.get(axis).map_or(along, |starts| starts[along as usize % Rows::PERIOD].into())
    }

    #[inline(always)]
    fn values<T: Grain>(self, hash: &[u32; 8]) -> Sum<T> {
        gathered(hash, |hash| {
            let [x, y, z] = self.0.slopes[hash as usize % Rows::PERIOD];
            [0.0, x, y, z]
        })
    }
}

/// The values and slopes of eight points: `point` gives those of a hash.
#[inline(always)]
fn gathered<T: Grain>(hash: &[u32; 8], point: impl Fn(u32) -> [f64; 4]) -> Sum<T> {
    let mut out = Sum { v: Eight::ZERO, d: [Eight::ZERO; 3] };
    for (i, &hash) in hash.iter().enumerate() {
        let [v, x, y, z] = point(hash);
        out.v.0[i] = T::nearest(v);
        (out.d[0].0[i], out.d[1].0[i], out.d[2].0[i]) = (T::nearest(x), T::nearest(y), T::nearest(z));
    }
    out
}
