//! Where heights come from: a quadtree of blocks of cells, with bounds.

use core::fmt::Debug;

/// A block of `2^level` by `2^level` cells, as far as the grid goes: from cell
/// `(i, j) 2^level` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Its level; 0 is a cell.
    pub level: u32,
    /// Its number along x.
    pub i: u32,
    /// Its number along z.
    pub j: u32,
}

impl Block {
    /// One of its quarters: bit 0 selects the half along x, bit 1 that along z.
    #[inline(always)]
    #[must_use]
    pub fn quarter(self, k: usize) -> Self {
        let k = k as u32;
        Self { level: self.level - 1, i: 2 * self.i + (k & 1), j: 2 * self.j + (k >> 1) }
    }
}

/// Heights at the points of a grid, and bounds for blocks of it.
pub trait Heights: Clone + Debug + Send + Sync {
    /// The name of the surface.
    const NAME: &'static str;

    /// Whether normals for shading are rounded as POV-Ray rounds them.
    const ROUNDS_NORMALS: bool;

    /// Bounds of a block.
    type Data: Copy;

    /// How many cells there are along x and along z; at least one.
    fn cells(&self) -> [u32; 2];

    /// The block that holds all cells.
    fn whole(&self) -> (Block, Self::Data);

    /// The data of the quarters of a block above level 0; those of quarters outside the grid are
    /// not used.
    fn quarters(&self, block: Block, data: Self::Data) -> [Self::Data; 4];

    /// Numbers between which all heights of a block lie.
    fn range(&self, block: Block, data: Self::Data) -> [f64; 2];

    /// The heights of a cell's corners: p00, p10, p01, p11.
    fn corners(&self, cell: Block, data: Self::Data) -> [f64; 4];

    /// The height of a grid point.
    fn height(&self, i: u32, j: u32) -> f64;

    /// The number of triangles.
    #[inline(always)]
    fn faces(&self) -> u32 {
        let [columns, rows] = self.cells();
        2 * columns * rows
    }
}

/// The coordinate of a grid point.
#[inline(always)]
pub(super) fn at(i: u32, cells: u32) -> f64 {
    f64::from(i) / f64::from(cells)
}
