//! Terrain: heights made on demand by midpoint displacement.
//!
//! Level `l = 1..L` adds the grid points at odd multiples of `s = 2^(L-l)`:
//!
//! ```text
//!     on a row or column      h = (a + b)/2 + e              a, b: the ends of the edge
//!     in a block's middle     h = (h10 + h01)/2 + e          the ends of the diagonal
//!     e = (B 2^(-H (l-1))) (2 r - 1),    r = (mix >> 11) 2^-53
//! ```
//!
//! `mix` is the output function of splitmix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable
//! pseudorandom number generators", OOPSLA 2014) of `S K0 + i K1 + j K2` modulo `2^64`, so a point's
//! displacement depends on its place alone, and neighbours agree bit for bit (A. Fournier, D.
//! Fussell, L. Carpenter, "Computer rendering of stochastic models", *Communications of the ACM*
//! 25(6), 1982). Below a block the heights differ from those of its corners by no more than the sum
//! of the displacements that can still come, a hard bound (compare J. T. Kajiya, "New techniques for
//! ray tracing procedurally defined objects", *ACM Transactions on Graphics* 2(3), 1983).

use super::Sheet;
use super::heights::{Block, Heights};
use durer_math::{U, elementary};

/// A fractal sheet over the unit square, of which nothing is stored.
///
/// ```
/// use durer_surfaces::{Terrain, TerrainData, terrain::Heights};
/// let terrain = Terrain::new(TerrainData { levels: 2, seed: 7, ..TerrainData::default() })?;
/// assert_eq!(terrain.heights().cells(), [4, 4]);
/// # Ok::<(), durer_surfaces::TerrainError>(())
/// ```
pub type Terrain = Sheet<Midpoints>;

/// The most levels.
const MOST_LEVELS: u32 = 15;

/// The numbers that describe a [`Terrain`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainData {
    /// How often edges are halved, from 1 to 15: there are `2^levels` cells a side.
    pub levels: u32,
    /// By which power of two displacements fall from level to level: above 0, up to 1.
    pub roughness: f64,
    /// The greatest displacement of the first level.
    pub amplitude: f64,
    /// Which one of all such terrains.
    pub seed: u64,
    /// The heights at (0, 0), (1, 0), (0, 1) and (1, 1), `[x, z]`.
    pub corners: [f64; 4],
}

impl Default for TerrainData {
    fn default() -> Self {
        Self { levels: 8, roughness: 0.5, amplitude: 0.25, seed: 0, corners: [0.0; 4] }
    }
}

/// Why a [`Terrain`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TerrainError {
    /// There are no levels, or too many.
    #[error("terrain: levels must be a whole number from 1 to {MOST_LEVELS}, got {0}")]
    Levels(u32),
    /// The roughness is not above 0 and up to 1.
    #[error("terrain: the roughness must be above 0 and at most 1, got {0}")]
    Roughness(f64),
    /// The amplitude is negative, NaN or too large.
    #[error("terrain: the amplitude must be finite, not negative and below 1e300, got {0}")]
    Amplitude(f64),
    /// The height of a corner is not finite, or too large.
    #[error("terrain: the height of corner {index} must be finite, below 1e300, got {value}")]
    Corner {
        /// Its number, from 0.
        index: usize,
        /// The height.
        value: f64,
    },
}

/// Heights by midpoint displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Midpoints {
    data: TerrainData,
    /// The greatest displacement in the middle of blocks of each level.
    greatest: [f64; MOST_LEVELS as usize + 1],
    /// Bounds of all that can still be added to the heights of blocks of each level.
    reach: [f64; MOST_LEVELS as usize + 1],
}

impl Sheet<Midpoints> {
    /// The terrain of these numbers.
    pub fn new(data: TerrainData) -> Result<Self, TerrainError> {
        const MOST: f64 = 1e300;
        if !(1..=MOST_LEVELS).contains(&data.levels) {
            return Err(TerrainError::Levels(data.levels));
        }
        if !(data.roughness > 0.0 && data.roughness <= 1.0) {
            return Err(TerrainError::Roughness(data.roughness));
        }
        if !(data.amplitude >= 0.0 && data.amplitude <= MOST) {
            return Err(TerrainError::Amplitude(data.amplitude));
        }
        if let Some(index) = data.corners.iter().position(|h| h.is_nan() || h.abs() > MOST) {
            return Err(TerrainError::Corner { index, value: data.corners[index] });
        }
        let (mut greatest, mut reach) = ([0.0; MOST_LEVELS as usize + 1], [0.0; MOST_LEVELS as usize + 1]);
        for level in 1..=data.levels {
            let (step, at) = (f64::from(data.levels - level), level as usize);
            greatest[at] = data.amplitude * elementary::exp2(-data.roughness * step);
            // At most fifteen additions, each off by `u` of the sum.
            reach[at] = (reach[at - 1] + greatest[at]) * (1.0 + 4.0 * U);
        }
        Ok(Self::of(Midpoints { data, greatest, reach }))
    }

    /// The numbers it was made from.
    pub fn data(&self) -> &TerrainData {
        &self.heights().data
    }
}

/// The output function of splitmix64.
#[inline(always)]
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Midpoints {
    /// The displacement of a grid point in the middle of blocks of a level.
    #[inline(always)]
    fn displacement(&self, level: u32, i: u32, j: u32) -> f64 {
        let place = self.data.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let place = place.wrapping_add(u64::from(i).wrapping_mul(0xBF58_476D_1CE4_E5B9));
        let place = place.wrapping_add(u64::from(j).wrapping_mul(0x94D0_49BB_1331_11EB));
        let r = (mix(place) >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
        self.greatest[level as usize] * (2.0 * r - 1.0)
    }
}

impl Heights for Midpoints {
    const NAME: &'static str = "terrain";

    const ROUNDS_NORMALS: bool = false;

    type Data = [f64; 4];

    #[inline(always)]
    fn cells(&self) -> [u32; 2] {
        [1 << self.data.levels; 2]
    }

    #[inline(always)]
    fn whole(&self) -> (Block, [f64; 4]) {
        (Block { level: self.data.levels, i: 0, j: 0 }, self.data.corners)
    }

    #[inline(always)]
    fn quarters(&self, block: Block, [h00, h10, h01, h11]: [f64; 4]) -> [[f64; 4]; 4] {
        let (level, half) = (block.level, 1 << (block.level - 1));
        let (i, j) = (block.i << level, block.j << level);
        let between = |a: f64, b: f64, i: u32, j: u32| (a + b) / 2.0 + self.displacement(level, i, j);
        let south = between(h00, h10, i + half, j);
        let west = between(h00, h01, i, j + half);
        let east = between(h10, h11, i + 2 * half, j + half);
        let north = between(h01, h11, i + half, j + 2 * half);
        let middle = between(h10, h01, i + half, j + half);
        [
            [h00, south, west, middle],
            [south, h10, middle, east],
            [west, middle, h01, north],
            [middle, east, north, h11],
        ]
    }

    /// A height is a mean of two, within their range, and a displacement; both sums round by `u` of
    /// their sizes, at most fifteen times.
    #[inline(always)]
    fn range(&self, block: Block, [a, b, c, d]: [f64; 4]) -> [f64; 2] {
        let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        if block.level == 0 {
            return [low, high];
        }
        let reach = self.reach[block.level as usize];
        let reach = (low.abs().max(high.abs()) + reach).mul_add(64.0 * U, reach);
        [low - reach, high + reach]
    }

    #[inline(always)]
    fn corners(&self, _: Block, data: [f64; 4]) -> [f64; 4] {
        data
    }

    fn height(&self, i: u32, j: u32) -> f64 {
        let last = (1 << self.data.levels) - 1;
        let (cell_i, cell_j) = (i.min(last), j.min(last));
        let (mut block, mut data) = self.whole();
        while block.level > 0 {
            let level = block.level - 1;
            let k = (cell_i >> level & 1 | (cell_j >> level & 1) << 1) as usize;
            (data, block) = (self.quarters(block, data)[k], block.quarter(k));
        }
        data[((i - cell_i) | (j - cell_j) << 1) as usize]
    }
}
