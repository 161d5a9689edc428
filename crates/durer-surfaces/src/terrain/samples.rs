//! Height fields: heights from a table.

use super::Sheet;
use super::heights::{Block, Heights};
use std::sync::Arc;

/// A height field: a sheet over the unit square through heights on a grid.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{Closest, HeightField, LocalRay, Surface};
/// // Two rows of three heights, that at z = 1 first.
/// let field = HeightField::new([3, 2], vec![0.0, 0.5, 0.0, 0.0, 0.25, 1.0])?;
/// let down = Ray::new(Point3::new(0.5, 2.0, 0.0), -Vec3::Y);
/// let mut closest = Closest::default();
/// field.roots(&LocalRay::new(&down), &mut closest);
/// assert_eq!(closest.root.map(|root| root.t), Some(1.75));
/// # Ok::<(), durer_surfaces::HeightFieldError>(())
/// ```
pub type HeightField = Sheet<Samples>;

/// The most samples on a side of a height field.
pub const MOST_SAMPLES: usize = 65_536;

/// The most samples of a height field: triangles and walls have numbers of 32 bits.
const MOST: usize = (1 << 31) - (1 << 18);

/// Why a [`HeightField`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum HeightFieldError {
    /// There are fewer than two samples on a side, or more than [`MOST_SAMPLES`].
    #[error("height field: a side must have from 2 to {MOST_SAMPLES} samples, got {columns} x {rows}")]
    Size {
        /// The number of columns.
        columns: usize,
        /// The number of rows.
        rows: usize,
    },
    /// The number of samples is too large.
    #[error("height field: {columns} x {rows} samples are too many")]
    TooMany {
        /// The number of columns.
        columns: usize,
        /// The number of rows.
        rows: usize,
    },
    /// The table has the wrong length.
    #[error("height field: {wanted} heights are needed, got {found}")]
    Count {
        /// How many there should be.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// A height is infinite, NaN, or so large that a step along the sheet could leave the range of
    /// f64.
    #[error(
        "height field: the height in column {column} of row {row} must be finite, below 1e300, got {value}"
    )]
    Height {
        /// The column, from 0.
        column: usize,
        /// The row, from 0 at z = 1.
        row: usize,
        /// The height.
        value: f64,
    },
}

/// A table of heights, with bounds for blocks of cells.
#[derive(Clone, PartialEq)]
pub struct Samples {
    columns: u32,
    rows: u32,
    table: Table,
    /// Bounds by level, level 1 first.
    levels: Arc<[Level]>,
}

impl core::fmt::Debug for Samples {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Samples")
            .field("columns", &self.columns)
            .field("rows", &self.rows)
            .finish_non_exhaustive()
    }
}

/// Heights by rows, that at z = 1 first.
#[derive(Clone, PartialEq)]
enum Table {
    /// In units of `2^-16`.
    Words(Arc<[u16]>),
    Numbers(Arc<[f64]>),
}

/// Bounds of the heights of all blocks of a level.
#[derive(Clone, PartialEq)]
struct Level {
    columns: u32,
    /// The least and the greatest height, rounded outward.
    bounds: Box<[[f32; 2]]>,
}

/// The exact value of a 16-bit height.
#[inline(always)]
fn of_word(word: u16) -> f64 {
    f64::from(word) * (1.0 / 65536.0)
}

impl Sheet<Samples> {
    /// The field of some columns and rows of heights; the row at z = 1 comes first, each from x = 0
    /// to x = 1.
    pub fn new([columns, rows]: [usize; 2], heights: Vec<f64>) -> Result<Self, HeightFieldError> {
        check([columns, rows], heights.len())?;
        if let Some(n) = heights.iter().position(|h| h.is_nan() || h.abs() > 1e300) {
            let (row, column, value) = (n / columns, n % columns, heights[n]);
            return Err(HeightFieldError::Height { column, row, value });
        }
        Ok(Self::of(Samples::new([columns, rows], Table::Numbers(heights.into()))))
    }

    /// [`new`](Self::new) for heights in units of `2^-16`, as in pictures.
    pub fn from_words([columns, rows]: [usize; 2], heights: Vec<u16>) -> Result<Self, HeightFieldError> {
        check([columns, rows], heights.len())?;
        Ok(Self::of(Samples::new([columns, rows], Table::Words(heights.into()))))
    }

    /// How many columns and rows of heights there are.
    pub fn size(&self) -> [usize; 2] {
        let [columns, rows] = self.heights().cells();
        [columns as usize + 1, rows as usize + 1]
    }

    /// How many bytes the table and its bounds take.
    pub fn bytes(&self) -> usize {
        let table = match &self.heights().table {
            Table::Words(words) => words.len() * 2,
            Table::Numbers(numbers) => numbers.len() * 8,
        };
        table + self.heights().levels.iter().map(|level| level.bounds.len() * 8).sum::<usize>()
    }
}

fn check([columns, rows]: [usize; 2], found: usize) -> Result<(), HeightFieldError> {
    let fits = |n: usize| (2..=MOST_SAMPLES).contains(&n);
    if !fits(columns) || !fits(rows) {
        return Err(HeightFieldError::Size { columns, rows });
    }
    if columns * rows > MOST {
        return Err(HeightFieldError::TooMany { columns, rows });
    }
    let wanted = columns * rows;
    if found == wanted { Ok(()) } else { Err(HeightFieldError::Count { wanted, found }) }
}

impl Samples {
    fn new([columns, rows]: [usize; 2], table: Table) -> Self {
        let (columns, rows) = (columns as u32 - 1, rows as u32 - 1);
        let mut made = Self { columns, rows, table, levels: Arc::new([]) };
        let mut levels: Vec<Level> = Vec::new();
        let mut cells = [columns, rows];
        while cells[0] > 1 || cells[1] > 1 {
            let halves = cells.map(|n| n.div_ceil(2));
            let bounds = match (levels.last(), &made.table) {
                (Some(below), _) => above(below, cells, halves),
                (None, Table::Words(words)) => made.lowest(halves, words, |h| [of_word(h) as f32; 2]),
                (None, Table::Numbers(numbers)) => made.lowest(halves, numbers, outward),
            };
            levels.push(Level { columns: halves[0], bounds });
            cells = halves;
        }
        made.levels = levels.into();
        made
    }

    /// Bounds of blocks of two by two cells: three by three heights.
    fn lowest<T: Copy>(
        &self,
        halves: [u32; 2],
        table: &[T],
        outward: impl Fn(T) -> [f32; 2],
    ) -> Box<[[f32; 2]]> {
        let width = self.columns as usize + 1;
        let mut bounds = Vec::with_capacity(halves[0] as usize * halves[1] as usize);
        // Of three rows, column by column.
        let mut columns = vec![[0.0_f32; 2]; width];
        for j in 0..halves[1] {
            let rows = self.rows - (2 * j + 2).min(self.rows)..=self.rows - 2 * j;
            for (k, row) in rows.enumerate() {
                let row = &table[row as usize * width..][..width];
                for (column, &height) in columns.iter_mut().zip(row) {
                    let height = outward(height);
                    *column = if k == 0 { height } else { join(*column, height) };
                }
            }
            for i in 0..halves[0] as usize {
                let three = &columns[2 * i..(2 * i + 3).min(width)];
                bounds.push(three.iter().copied().reduce(join).unwrap_or([0.0; 2]));
            }
        }
        bounds.into()
    }

    #[inline(always)]
    fn index(&self, i: u32, j: u32) -> usize {
        (self.rows - j) as usize * (self.columns as usize + 1) + i as usize
    }

    #[inline(always)]
    fn at(&self, index: usize) -> f64 {
        match &self.table {
            Table::Words(words) => of_word(words[index]),
            Table::Numbers(numbers) => numbers[index],
        }
    }
}

/// Bounds of blocks from those of their quarters.
fn above(below: &Level, cells: [u32; 2], halves: [u32; 2]) -> Box<[[f32; 2]]> {
    let mut bounds = Vec::with_capacity(halves[0] as usize * halves[1] as usize);
    for j in 0..halves[1] {
        for i in 0..halves[0] {
            let mut all = [f32::INFINITY, f32::NEG_INFINITY];
            for j in 2 * j..(2 * j + 2).min(cells[1]) {
                for i in 2 * i..(2 * i + 2).min(cells[0]) {
                    all = join(all, below.bounds[j as usize * below.columns as usize + i as usize]);
                }
            }
            bounds.push(all);
        }
    }
    bounds.into()
}

#[inline(always)]
fn join(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// A number, rounded down and up.
fn outward(x: f64) -> [f32; 2] {
    let near = x as f32;
    let (below, above) = (f64::from(near) <= x, f64::from(near) >= x);
    [if below { near } else { near.next_down() }, if above { near } else { near.next_up() }]
}

impl Heights for Samples {
    const NAME: &'static str = "height field";

    const ROUNDS_NORMALS: bool = true;

    type Data = ();

    #[inline(always)]
    fn cells(&self) -> [u32; 2] {
        [self.columns, self.rows]
    }

    #[inline(always)]
    fn whole(&self) -> (Block, ()) {
        (Block { level: self.levels.len() as u32, i: 0, j: 0 }, ())
    }

    #[inline(always)]
    fn quarters(&self, _: Block, (): ()) -> [(); 4] {
        [(); 4]
    }

    #[inline(always)]
    fn range(&self, block: Block, (): ()) -> [f64; 2] {
        if block.level == 0 {
            let [a, b, c, d] = self.corners(block, ());
            return [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))];
        }
        let level = &self.levels[block.level as usize - 1];
        level.bounds[block.j as usize * level.columns as usize + block.i as usize].map(f64::from)
    }

    #[inline(always)]
    fn corners(&self, cell: Block, (): ()) -> [f64; 4] {
        let above = self.index(cell.i, cell.j + 1);
        let below = above + self.columns as usize + 1;
        [self.at(below), self.at(below + 1), self.at(above), self.at(above + 1)]
    }

    #[inline(always)]
    fn height(&self, i: u32, j: u32) -> f64 {
        self.at(self.index(i, j))
    }
}
