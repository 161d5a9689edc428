//! Noise whose values and slopes are in a table.

use super::{Grain, Lattice, Sum, number};
use durer_math::real::Eight;
use durer_math::scale::pow2;
use std::sync::Mutex;

/// How many cells along an axis differ; further ones repeat them.
const PERIOD: usize = 4096;
/// The cell 0 has this number.
const FIRST: u32 = 10_000;
/// How many points of the lattice differ.
const POINTS: usize = 256;

/// The values and slopes of the points of a lattice, and the permutation `p` that distributes them:
/// the point `(x, y, z)` has number `p[p[p[x] ^ y] ^ z]` modulo 256, with coordinates relative to
/// -10000, modulo 4096.
///
/// Tables are shared and live as long as the program: steps of formulas refer to them.
pub struct NoiseTable {
    /// For each point the value and the three slopes.
    points: Box<[[f64; 4]; POINTS]>,
    /// The permutation, twice.
    order: Box<[u16; 2 * PERIOD]>,
    /// The greatest of the slopes and of twice the values, and at least 2^-20, so that the bounds
    /// of rounding cover values too small for single precision.
    size: f64,
}

static TABLES: Mutex<Vec<&'static NoiseTable>> = Mutex::new(Vec::new());

impl NoiseTable {
    /// The table with these points and this permutation; `None` if a number is not finite or too
    /// large for single precision, or the permutation has a number from 4096 on. Equal tables are
    /// one.
    pub fn shared(points: &[[f64; 4]; POINTS], order: &[u16; PERIOD]) -> Option<&'static Self> {
        let all = || points.iter().flatten().map(|x| x.abs());
        let fits = all().all(|x| x < 1e6) && order.iter().all(|&k| usize::from(k) < PERIOD);
        if !fits {
            return None;
        }
        let mut tables = TABLES.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let is_same = |table: &&&Self| *table.points == *points && table.order[..PERIOD] == *order;
        if let Some(table) = tables.iter().find(is_same) {
            return Some(table);
        }
        let size = points.iter().flat_map(|[v, g @ ..]| g.iter().copied().chain([2.0 * v]));
        let size = size.fold(pow2(-20), |size, x| size.max(x.abs()));
        let mut twice = Box::new([0; 2 * PERIOD]);
        twice[..PERIOD].copy_from_slice(order);
        twice[PERIOD..].copy_from_slice(order);
        let table: &Self = Box::leak(Box::new(Self { points: Box::new(*points), order: twice, size }));
        tables.push(table);
        Some(table)
    }

    #[inline(always)]
    fn next(&self, at: u32) -> u32 {
        self.order[at as usize % (2 * PERIOD)].into()
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

impl Lattice for &NoiseTable {
    // Cells may reach 4097: the permutation goes on as it begins there, and so do the numbers that
    // are combined with it.
    const STEP: [u32; 3] = [1; 3];

    #[inline(always)]
    fn size(self) -> f64 {
        self.size
    }

    #[inline(always)]
    fn cell(self, whole: f64, _: usize) -> u32 {
        number(whole).wrapping_add(FIRST) % PERIOD as u32
    }

    #[inline(always)]
    fn hash(self, [x, y, z]: [u32; 3]) -> u32 {
        self.next(self.next(self.next(x) ^ y) ^ z)
    }

    #[inline(always)]
    fn values<T: Grain>(self, hash: &[u32; 8]) -> Sum<T> {
        let mut out = Sum { v: Eight::ZERO, d: [Eight::ZERO; 3] };
        for (i, &hash) in hash.iter().enumerate() {
            let [v, x, y, z] = self.points[hash as usize % POINTS];
            out.v.0[i] = T::nearest(v);
            (out.d[0].0[i], out.d[1].0[i], out.d[2].0[i]) = (T::nearest(x), T::nearest(y), T::nearest(z));
        }
        out
    }
}
