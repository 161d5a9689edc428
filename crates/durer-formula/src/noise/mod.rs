//! Noise on the unit lattice: K. Perlin, "An image synthesizer", SIGGRAPH 1985.
//!
//! ```text
//!   n(x, y, z) = sum of w(x - i) w(y - j) w(z - k) (v + g . (x - i, y - j, z - k))
//!                over the corners (i, j, k) of the lattice's cell
//!   w(t) = 1 - f(|t|),  f(t) = 3 t^2 - 2 t^3
//! ```
//!
//! Each point of the lattice has a value `v` and a slope `g` of its own, which are determined by a
//! hash of its three integer coordinates, each taken modulo 2^32: `v` is one of the 256 multiples
//! of 1/256 from -132/256 on, the three components of `g` are odd multiples of 1/256 in (-1, 1).
//! So noise is a polynomial in each cell, with coefficients that f64 holds exactly, and its
//! derivatives are continuous everywhere: the bounds are on that function of real numbers.
//!
//! **Rounding.** With `u` for one rounding of 1, in f64 or in f32, which holds the same numbers
//! exactly: a coordinate in its cell is exact, but for one between -1 and 0, where it errs by
//! `u/2`; all roundings of `f` are `2 u`, of `f'` `4 u`, of a corner's sum `7 u`. A step of the
//! interpolation, of which there are three, adds `21 u` to a value (`2 u` times a difference of at
//! most 7.04, its rounding of `4 u` and the sum's of `2 u`), and to a derivative at most `75 u`, or
//! `180 u` along its own axis. With the effect of the coordinates' errors these are below
//! `VALUE_ROUNDINGS` and `SLOPE_ROUNDINGS`.
//!
//! **Tables.** A [`NoiseTable`] has another hash and other values and slopes, of at most
//! `|v| <= size/2` and `|g| <= size`; the bounds are proportional to that size. In f32 the
//! coefficients of a corner are rounded, too: `4 u` in its sum, which adds `4 u` to a value,
//! `2 * 4 u * 3/2 = 12 u` and the slope's own `u` to a derivative. That is within the two bounds.

mod bounds;
mod cell_numbers;
mod nearest;
pub mod permutation;
mod table;
mod vector;

pub use cell_numbers::CellNumbers;
pub use nearest::Nearest;
pub use table::NoiseTable;
pub use vector::VectorTable;

use crate::I8;
use durer_math::real::{Eight, Real, real};
use durer_math::{F8, Isa};
use table::{TableLattice, TablePoints};

/// How far the third noise generator of the scene language shifts points along each axis before it
/// takes the noise of a table of rows. Measured from POV-Ray 3.7.
pub const ROWS_SHIFT: f64 = 12_432_434.0 / 536_870_912.0;

/// Bound on the rounding errors of a value, in roundings of 1.
const VALUE_ROUNDINGS: f32 = 80.0;
/// Bound on the rounding errors of a derivative, in roundings of 1.
const SLOPE_ROUNDINGS: f32 = 320.0;

/// The values and slopes of the lattice's points.
trait Lattice: Copy {
    /// What a step along an axis adds to a cell's number.
    const STEP: [u32; 3];
    /// The factor of all bounds.
    fn size(self) -> f64;
    /// The number of a cell along an axis.
    fn cell(self, whole: f64, axis: usize) -> u32;
    /// The hash of a point as far as this axis: `before` is that of the axes before it, 0 at first, and
    /// `cell` the number along it.
    fn hash(self, before: u32, cell: u32, axis: usize) -> u32;
    /// Values and slopes of eight points of the lattice.
    fn values<T: Grain>(self, hash: &[u32; 8]) -> Sum<T>;
}

/// durer's own noise.
#[derive(Clone, Copy)]
struct Own;

impl Lattice for Own {
    /// Primes that distinguish the three coordinates in the hash: those of Y. Collet's xxHash.
    const STEP: [u32; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];

    #[inline(always)]
    fn size(self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn cell(self, whole: f64, axis: usize) -> u32 {
        number(whole).wrapping_mul(Self::STEP[axis])
    }

    #[inline(always)]
    fn hash(self, before: u32, cell: u32, _: usize) -> u32 {
        before ^ cell
    }

    #[inline(always)]
    fn values<T: Grain>(self, hash: &[u32; 8]) -> Sum<T> {
        let (value, slope) = (real::<T>(1.0 + 132.0 / 256.0), real::<T>(3.0 - 1.0 / 256.0));
        let mut out = Sum { v: Eight::ZERO, d: [Eight::ZERO; 3] };
        for (i, &hash) in hash.iter().enumerate() {
            let bits = mixed(hash);
            out.v.0[i] = T::eight(bits, real(1.0)) - value;
            out.d[0].0[i] = T::eight(bits >> 8, real(2.0)) - slope;
            out.d[1].0[i] = T::eight(bits >> 16, real(2.0)) - slope;
            out.d[2].0[i] = T::eight(bits >> 24, real(2.0)) - slope;
        }
        out
    }
}

/// A number type for the values of lattice points.
trait Grain: Real {
    /// A number with the lowest eight bits as its fraction: from 1 to 2 by 1/256, or from 2 to 4 by
    /// 1/128.
    fn eight(bits: u32, first: Self) -> Self;
    /// The nearest number of this type.
    fn nearest(x: f64) -> Self;
}

impl Grain for f64 {
    #[inline(always)]
    fn eight(bits: u32, first: Self) -> Self {
        Self::from_bits(first.to_bits() | u64::from(bits & 0xff) << 44)
    }

    #[inline(always)]
    fn nearest(x: f64) -> Self {
        x
    }
}

impl Grain for f32 {
    #[inline(always)]
    fn eight(bits: u32, first: Self) -> Self {
        Self::from_bits(first.to_bits() | (bits & 0xff) << 15)
    }

    #[inline(always)]
    fn nearest(x: f64) -> Self {
        x as f32
    }
}

/// A coordinate: its cell, and its position there.
struct Along<T> {
    /// The numbers of the cell's two corners.
    corner: [[u32; 8]; 2],
    /// The distances from these corners.
    from: [Eight<T>; 2],
    /// The blend and its derivative.
    f: Eight<T>,
    slope: Eight<T>,
}

impl<T: Grain> Along<T> {
    /// The coordinates `t` from 0 to 1 in cells whose lower corners have these numbers.
    #[inline(always)]
    fn new(corner: [u32; 8], t: &Eight<T>, step: u32) -> Self {
        let mut out =
            Self { corner: [corner; 2], from: [*t, *t - real::<T>(1.0)], f: Eight::ZERO, slope: Eight::ZERO };
        for (i, &corner) in corner.iter().enumerate() {
            out.corner[1][i] = corner.wrapping_add(step);
            // Around the cell's middle: 1/2 + s (3/2 - 2 s^2), and 6 (1/4 - s^2).
            let s = t.0[i] - real(0.5);
            out.f.0[i] = (s * s).mul_add(real(-2.0), real(1.5)).mul_add(s, real(0.5));
            out.slope.0[i] = real::<T>(6.0) * (-s).mul_add(s, real(0.25));
        }
        out
    }
}

impl Along<f64> {
    /// The cells and positions of any numbers.
    #[inline(always)]
    fn of<L: Lattice>(lattice: L, x: &F8, axis: usize) -> Self {
        let (mut corner, mut t) = ([0; 8], Eight::ZERO);
        for (i, corner) in corner.iter_mut().enumerate() {
            let whole = x.0[i].floor();
            *corner = lattice.cell(whole, axis);
            t.0[i] = x.0[i] - whole;
        }
        Self::new(corner, &t, L::STEP[axis])
    }
}

/// Whether all lanes are in the same cell.
#[inline(always)]
fn are_one_cell<T>(along: &[Along<T>; 3]) -> bool {
    let mut different = 0;
    for axis in along {
        for &corner in &axis.corner[0] {
            different |= corner ^ axis.corner[0][0];
        }
    }
    different == 0
}

/// An integer modulo 2^32; arbitrary for a number that is no integer.
#[inline(always)]
fn number(whole: f64) -> u32 {
    const TURN: f64 = (1_u64 << 32) as f64;
    // Added to an integer below 2^32, it leaves that in the lowest bits.
    const WHOLE: f64 = (1_u64 << 52) as f64;
    let rest = whole - (whole * (1.0 / TURN)).floor() * TURN;
    (rest + WHOLE).to_bits() as u32
}

/// Mixes the bits of the combined coordinates: the last rounds of A. Appleby's MurmurHash3.
#[inline(always)]
fn mixed(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x85eb_ca6b);
    let x = (x ^ x >> 13).wrapping_mul(0xc2b2_ae35);
    x ^ x >> 16
}

/// The hashes of the eight corners of the first lanes' cells.
#[inline(always)]
fn hashes<const LANES: usize, T, L: Lattice>(lattice: L, along: &[Along<T>; 3]) -> [[u32; LANES]; 8] {
    let mut hash = [[0; LANES]; 8];
    for (axis, along) in along.iter().enumerate() {
        let before = hash;
        // Bit `axis` of a corner's number is its position along this axis. Corners that differ in the
        // bits above have the same hash so far.
        for corner in 0..2 << axis {
            for lane in 0..LANES {
                let cell = along.corner[corner >> axis][lane];
                hash[corner][lane] = lattice.hash(before[corner % (1 << axis)][lane], cell, axis);
            }
        }
    }
    hash
}

/// An array of the values of an expression for each corner: bit `i` of its number is its position
/// along axis `i`.
macro_rules! each_corner {
    ($c:ident => $each:expr) => {
        [
            each_corner!(0, $c => $each),
            each_corner!(1, $c => $each),
            each_corner!(2, $c => $each),
            each_corner!(3, $c => $each),
            each_corner!(4, $c => $each),
            each_corner!(5, $c => $each),
            each_corner!(6, $c => $each),
            each_corner!(7, $c => $each),
        ]
    };
    ($number:literal, $c:ident => $each:expr) => {{
        let $c: usize = $number;
        $each
    }};
}

/// A sum over some of the corners: its value and its derivatives.
#[derive(Clone, Copy)]
struct Sum<T> {
    v: Eight<T>,
    d: [Eight<T>; 3],
}

impl<T: Grain> Sum<T> {
    /// Blends from `a` to `b` along an axis.
    #[inline(always)]
    fn blended(along: &[Along<T>; 3], axis: usize, a: &Self, b: &Self) -> Self {
        let Along { f, slope, .. } = &along[axis];
        let change = b.v - a.v;
        let mut out = Self { v: f.mul_add(change, a.v), d: [Eight::ZERO; 3] };
        for i in 0..3 {
            out.d[i] = f.mul_add(b.d[i] - a.d[i], a.d[i]);
        }
        out.d[axis] = slope.mul_add(change, out.d[axis]);
        out
    }

    /// The contributions of all corners, with their hashes for each lane.
    #[inline(always)]
    fn corners<L: Lattice>(lattice: L, along: &[Along<T>; 3], hashes: &[[u32; 8]; 8]) -> [Self; 8] {
        each_corner!(c => lattice.values(&hashes[c]).seen(along, c))
    }

    /// The contributions of all corners of the one cell of all lanes, with their hashes.
    #[inline(always)]
    fn corners_of_one<L: Lattice>(lattice: L, along: &[Along<T>; 3], hashes: &[[u32; 1]; 8]) -> [Self; 8] {
        let values = lattice.values(&each_corner!(c => hashes[c][0]));
        each_corner!(c => values.splat(c).seen(along, c))
    }

    /// One lane's value and slopes in all lanes.
    #[inline(always)]
    fn splat(&self, lane: usize) -> Self {
        let [x, y, z] = &self.d;
        Self {
            v: Eight::splat(self.v.0[lane]),
            d: [Eight::splat(x.0[lane]), Eight::splat(y.0[lane]), Eight::splat(z.0[lane])],
        }
    }

    /// The value and the slope that a corner contributes at the points.
    #[inline(always)]
    fn seen(mut self, along: &[Along<T>; 3], corner: usize) -> Self {
        let [gx, gy, gz] = self.d;
        let [x, y, z] =
            [along[0].from[corner & 1], along[1].from[corner >> 1 & 1], along[2].from[corner >> 2]];
        self.v = gz.mul_add(z, gy.mul_add(y, gx.mul_add(x, self.v)));
        self
    }

    /// Blends all corners.
    #[inline(always)]
    fn of(along: &[Along<T>; 3], c: &[Self; 8]) -> Self {
        let near = Self::blended(
            along,
            1,
            &Self::blended(along, 0, &c[0], &c[1]),
            &Self::blended(along, 0, &c[2], &c[3]),
        );
        let far = Self::blended(
            along,
            1,
            &Self::blended(along, 0, &c[4], &c[5]),
            &Self::blended(along, 0, &c[6], &c[7]),
        );
        Self::blended(along, 2, &near, &far)
    }
}

impl Sum<f64> {
    /// The noise at eight points.
    #[inline(always)]
    fn at<L: Lattice>(lattice: L, p: [&F8; 3]) -> Self {
        let along = positions(lattice, p);
        if are_one_cell(&along) {
            Self::of(&along, &Self::corners_of_one(lattice, &along, &hashes(lattice, &along)))
        } else {
            Self::of(&along, &Self::corners(lattice, &along, &hashes(lattice, &along)))
        }
    }
}

/// The cells and positions of eight points along the axes.
#[inline(always)]
fn positions<L: Lattice>(lattice: L, [x, y, z]: [&F8; 3]) -> [Along<f64>; 3] {
    [Along::of(lattice, x, 0), Along::of(lattice, y, 1), Along::of(lattice, z, 2)]
}

/// The value of an expression with the lattice of a table, or durer's own.
macro_rules! with_lattice {
    ($table:expr, $lattice:ident => $value:expr) => {
        match $table.map(|table| (table.points(), table.size())) {
            None => {
                let $lattice = Own;
                $value
            }
            Some((TablePoints::Hashed(points), size)) => {
                let $lattice = TableLattice(&**points, size);
                $value
            }
            Some((TablePoints::Rows(points), size)) => {
                let $lattice = TableLattice(&**points, size);
                $value
            }
        }
    };
}

/// The noise of eight points, rounded: about zero, from -1 to 1. It is durer's own without a table.
#[inline(always)]
pub fn values(table: Option<&NoiseTable>, p: [&F8; 3]) -> F8 {
    with_lattice!(table, lattice => values_of(lattice, p))
}

/// The noise of eight points and its derivatives, rounded.
#[inline(always)]
pub(crate) fn slants(table: Option<&NoiseTable>, p: [&F8; 3]) -> (F8, [F8; 3]) {
    with_lattice!(table, lattice => slants_of(lattice, p))
}

/// Bounds of noise on eight boxes.
#[inline(always)]
pub(crate) fn bounds(table: Option<&NoiseTable>, p: [&I8; 3]) -> I8 {
    with_lattice!(table, lattice => bounds_of(lattice, p))
}

/// Bounds on noise and its derivatives on eight boxes.
#[inline(always)]
pub(crate) fn slopes(table: Option<&NoiseTable>, p: [&I8; 3]) -> (I8, [I8; 3]) {
    with_lattice!(table, lattice => slopes_of(lattice, p))
}

#[inline(never)]
fn values_of<L: Lattice>(lattice: L, p: [&F8; 3]) -> F8 {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || F8(Sum::at(lattice, p).v.0),
    )
}

#[inline(never)]
fn slants_of<L: Lattice>(lattice: L, p: [&F8; 3]) -> (F8, [F8; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let Sum { v, d } = Sum::at(lattice, p);
            (F8(v.0), [F8(d[0].0), F8(d[1].0), F8(d[2].0)])
        },
    )
}

#[inline(never)]
fn bounds_of<L: Lattice>(lattice: L, p: [&I8; 3]) -> I8 {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || bounds::bounds_in_cell(lattice, p).0,
    )
}

#[inline(never)]
fn slopes_of<L: Lattice>(lattice: L, p: [&I8; 3]) -> (I8, [I8; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || bounds::bounds_in_cell(lattice, p),
    )
}

#[cfg(test)]
mod tests;
