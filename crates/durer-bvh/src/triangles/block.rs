//! The leaf: sixteen triangles side by side, in f32.

use crate::frame::Frame;
use durer_math::Point3;

/// How many triangles a block holds.
pub(crate) const LANES: usize = 16;

/// How many bits of a lane's tag are its triangle's slot; the others hold the [`Block::size`].
const SLOT_BITS: u32 = 27;
const SLOT: u32 = (1 << SLOT_BITS) - 1;

/// How many low bits of a size are not stored.
const SIZE_SHIFT: u32 = 31 - 10;

/// The least size of a block: with a smaller one the filter's own roundings could underflow.
const SMALLEST: f64 = 1.0 / (1_u128 << 100) as f64;

/// Sixteen triangles in tree units: corners, each coordinate rounded once to f32, and slots. Ten
/// cache lines, all of which a test reads.
///
/// A lane without a triangle holds NaN, for which all comparisons are false.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// `x`, `y`, `z` of `v0`, of `v1`, of `v2`.
    pub(crate) rows: [[f32; LANES]; 9],
    /// The triangle's slot in the lower 27 bits. The upper five bits of the first two lanes are the
    /// first ten bits of [`Block::size`] after the sign.
    tags: [u32; LANES],
}

const _: () = assert!(size_of::<Block>() == 10 * 64 && crate::node::MAX_ENTRIES == 1 << SLOT_BITS);

/// Compares bits, so that empty lanes are equal, too.
impl PartialEq for Block {
    fn eq(&self, other: &Self) -> bool {
        let bits = |block: &Self| block.rows.map(|row| row.map(f32::to_bits));
        self.tags == other.tags && bits(self) == bits(other)
    }
}

/// The corners of a triangle, in the caller's units.
pub type Corners = [Point3; 3];

impl Block {
    /// A block of triangles and their slots, at most sixteen, and whether f32 holds all corners
    /// exactly.
    #[inline(always)]
    pub(crate) fn new(frame: Frame, triangles: impl Iterator<Item = (u32, Corners)>) -> (Self, bool) {
        let mut block = Self { rows: [[f32::NAN; LANES]; 9], tags: [SLOT; LANES] };
        let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let (mut is_held, mut edge) = (true, 0.0_f64);
        for (lane, (slot, corners)) in triangles.enumerate().take(LANES) {
            block.tags[lane] = slot;
            for (i, v) in corners.iter().enumerate() {
                for axis in 0..3 {
                    let (from_centre, lost) = frame.difference(v[axis], axis);
                    let inward = frame.units().inward(from_centre);
                    let x = inward as f32;
                    // Whether neither the difference nor scaling nor rounding has lost anything.
                    is_held &= (f64::from(x) == inward)
                        & (frame.units().outward(inward) == from_centre)
                        & (lost == 0.0);
                    block.rows[3 * i + axis][lane] = x;
                    lo[axis] = if x < lo[axis] { x } else { lo[axis] };
                    hi[axis] = if x > hi[axis] { x } else { hi[axis] };
                }
            }
            let along =
                |i: usize| (f64::from(block.rows[i][lane]) - f64::from(block.rows[i % 3][lane])).abs();
            for row in [3, 6] {
                let sum = along(row) + along(row + 1) + along(row + 2);
                edge = if sum > edge { sum } else { edge };
            }
        }
        let widths: f64 = (0..3).map(|i| f64::from(hi[i]) - f64::from(lo[i])).sum();
        let size = if is_held { edge } else { widths };
        // Keeps two bits of the fraction. The size is rounded by a unit of the 24th bit and more,
        // and increased by one of the third.
        let upper = (size.max(SMALLEST) as f32).to_bits() / (1 << SIZE_SHIFT) + 1;
        block.tags[0] |= (upper & 31) << SLOT_BITS;
        block.tags[1] |= (upper >> 5) << SLOT_BITS;
        (block, is_held)
    }

    /// A bound on the sum of the magnitudes of an edge from a first corner, and, if f32 does not
    /// hold all corners, on the sum of the widths of a box around all triangles.
    #[inline(always)]
    pub(crate) fn size(&self) -> f32 {
        let upper = (self.tags[0] >> SLOT_BITS) | (self.tags[1] >> SLOT_BITS << 5);
        f32::from_bits(upper << SIZE_SHIFT)
    }

    /// How many triangles the block holds.
    pub(crate) fn len(&self) -> usize {
        self.rows[0].iter().take_while(|x| !x.is_nan()).count()
    }

    /// The slot of a lane's triangle.
    #[inline(always)]
    pub(crate) fn slot(&self, lane: usize) -> u32 {
        self.tags[lane & (LANES - 1)] & SLOT
    }

    /// The stored corners of a lane's triangle, relative to the centre, in units of `1 / grow`.
    #[inline(always)]
    pub(crate) fn corners(&self, grow: f64, lane: usize) -> Corners {
        let lane = lane & (LANES - 1);
        let at = |row: usize| f64::from(self.rows[row][lane]) * grow;
        [Point3::new(at(0), at(1), at(2)), Point3::new(at(3), at(4), at(5)), Point3::new(at(6), at(7), at(8))]
    }
}
