//! Lookup of a formula's cells: two memory accesses find the cell of a point, however deep it lies
//! in the octree.
//!
//! A grid place is as large as the smallest cells. Each place of a coarse grid holds a cell, or a
//! brick of places with a cell for each. A cell is stored as a number with its width: a power of
//! two in the lowest three bits, or all three bits set for a brick.

use super::octree::{Cell, DEEPEST};
use durer_math::lanes::LANES;
use durer_math::{Aabb, F8, M8, Vec3};

/// A brick has two to this power places along each axis.
const BRICK: u32 = 2;
/// The number of places along each axis.
const PLACES: f64 = (1_u32 << DEEPEST) as f64;

/// The facts that are proven in the cell of a point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lookup {
    /// The formula has this sign.
    Sign(bool),
    /// No surface: the formula is undefined or has one sign (`true`: positive).
    Gap(bool),
    /// There may be surface; the number of the leaf.
    Leaf(u32),
}

impl Lookup {
    const GAP: u32 = 0;
    const SIGN: u32 = 2;
    const LEAF: u32 = 4;

    /// The cell as a number.
    fn code(self) -> u32 {
        match self {
            Self::Gap(above) => Self::GAP + u32::from(above),
            Self::Sign(above) => Self::SIGN + u32::from(above),
            Self::Leaf(leaf) => Self::LEAF + leaf,
        }
    }

    #[inline(always)]
    fn of(code: u32) -> Self {
        match code {
            0 => Self::Gap(false),
            1 => Self::Gap(true),
            2 => Self::Sign(false),
            3 => Self::Sign(true),
            leaf => Self::Leaf(leaf - Self::LEAF),
        }
    }
}

/// The grid of places.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// The origin of the grid, the size of a place, and its inverse.
    min: [f64; 3],
    size: [f64; 3],
    over: [f64; 3],
    coarse: Box<[u32]>,
    bricks: Vec<[u32; 1 << (3 * BRICK)]>,
}

/// The index of a place in a grid with two to this power places along each axis.
#[inline(always)]
fn number(at: [u32; 3], power: u32) -> usize {
    (at[0] | at[1] << power | at[2] << (2 * power)) as usize
}

impl Grid {
    const IS_BRICK: u32 = 0b111;

    /// A grid whose cells are not filled yet.
    pub(super) fn new(extent: &Aabb) -> Self {
        let size = (extent.max - extent.min).to_array().map(|x| x / PLACES);
        Self {
            min: extent.min.to_array(),
            size,
            over: size.map(|x| 1.0 / x),
            coarse: vec![0; 1 << (3 * (DEEPEST - BRICK))].into(),
            // A lookup of a place without a brick reads the first brick, which no place uses.
            bricks: vec![[0; 1 << (3 * BRICK)]],
        }
    }

    /// Stores the cells of an octree with this root; inner cells name the first of eight in a list.
    pub(super) fn fill(&mut self, root: Cell, cells: &[Cell]) {
        self.put(cells, root, [0; 3], DEEPEST);
    }

    /// Stores a cell that begins at a place and is two to the power of `shift` places wide, and all
    /// cells below it.
    fn put(&mut self, cells: &[Cell], cell: Cell, at: [u32; 3], shift: u32) {
        let told = match cell {
            Cell::Inner(first) => {
                if shift == BRICK {
                    let brick = self.bricks.len() as u32;
                    self.coarse[number(at.map(|x| x >> BRICK), DEEPEST - BRICK)] =
                        brick << 3 | Self::IS_BRICK;
                    self.bricks.push([0; 1 << (3 * BRICK)]);
                }
                for (half, &cell) in (0_u32..).zip(&cells[first as usize..][..8]) {
                    let bit = |axis: usize| (half >> axis & 1) << (shift - 1);
                    self.put(cells, cell, [at[0] + bit(0), at[1] + bit(1), at[2] + bit(2)], shift - 1);
                }
                return;
            }
            Cell::Gap(above) => Lookup::Gap(above),
            Cell::Sign(above) => Lookup::Sign(above),
            Cell::Leaf(leaf) => Lookup::Leaf(leaf),
        };
        let told = told.code() << 3 | shift;
        let wide = shift.saturating_sub(BRICK);
        let all = 0..1_u32 << (3 * if shift < BRICK { shift } else { wide });
        for k in all {
            if shift < BRICK {
                let axis = |i: usize| at[i] % (1 << BRICK) + (k >> (i as u32 * shift)) % (1 << shift);
                if let Some(brick) = self.bricks.last_mut() {
                    brick[number([axis(0), axis(1), axis(2)], BRICK)] = told;
                }
            } else {
                let axis = |i: usize| (at[i] >> BRICK) + (k >> (i as u32 * wide)) % (1 << wide);
                self.coarse[number([axis(0), axis(1), axis(2)], DEEPEST - BRICK)] = told;
            }
        }
    }

    /// The cell of a place, with its width. There is no branch on whether the place has a brick, so
    /// that the lookups of eight lines overlap.
    #[inline(always)]
    fn cell(&self, [x, y, z]: [u32; 3]) -> u32 {
        let cell = self.coarse[number([x >> BRICK, y >> BRICK, z >> BRICK], DEEPEST - BRICK)];
        let is_brick = cell & Self::IS_BRICK == Self::IS_BRICK;
        let brick = if is_brick { cell >> 3 } else { 0 };
        let within = (1 << BRICK) - 1;
        let inner = self.bricks[brick as usize][number([x & within, y & within, z & within], BRICK)];
        if is_brick { inner } else { cell }
    }

    /// The index of the place of a coordinate; NaN and coordinates beyond the grid get a place at
    /// the border.
    #[inline(always)]
    fn place(&self, x: f64, axis: usize) -> u32 {
        (((x - self.min[axis]) * self.over[axis]) as i32).clamp(0, (1 << DEEPEST) - 1) as u32
    }

    /// The facts that are proven in the cell of a point.
    pub(super) fn look_up(&self, [x, y, z]: [f64; 3]) -> Lookup {
        Lookup::of(self.cell([self.place(x, 0), self.place(y, 1), self.place(z, 2)]) >> 3)
    }

    /// The cells of points.
    #[inline(always)]
    pub(super) fn find(&self, p: &Vec3<F8>) -> Found {
        let mut at = [[0; LANES]; 3];
        for (axis, (at, x)) in at.iter_mut().zip([&p.x, &p.y, &p.z]).enumerate() {
            for (at, &x) in at.iter_mut().zip(&x.0) {
                *at = self.place(x, axis);
            }
        }
        let mut found = Found { code: [0; LANES], wide: [1; LANES], at };
        for (i, (code, wide)) in found.code.iter_mut().zip(&mut found.wide).enumerate() {
            let cell = self.cell([at[0][i], at[1][i], at[2][i]]);
            (*code, *wide) = (cell >> 3, 1 << (cell & 0b111));
        }
        found
    }

    /// Where lines leave the cells that were found, from their origins and inverse directions.
    /// Cells at the border have no end.
    #[inline(always)]
    pub(super) fn ends(&self, found: &Found, o: &Vec3<F8>, over: &Vec3<F8>) -> F8 {
        let mut end = F8::splat(f64::INFINITY);
        for (axis, (o, over)) in [(&o.x, &over.x), (&o.y, &over.y), (&o.z, &over.z)].into_iter().enumerate() {
            for i in 0..LANES {
                let rises = over.0[i] > 0.0;
                let wide = found.wide[i];
                let first = found.at[axis][i] & 0_u32.wrapping_sub(wide);
                let number = f64::from((first + if rises { wide } else { 0 }) as i32);
                let s = (number * self.size[axis] + self.min[axis] - o.0[i]) * over.0[i];
                // NaN gives no end either.
                let ends = (number != if rises { PLACES } else { 0.0 }) & (s < end.0[i]);
                end.0[i] = if ends { s } else { end.0[i] };
            }
        }
        end
    }
}

/// The cells of eight points.
pub(super) struct Found {
    code: [u32; LANES],
    /// How many places each cell is wide.
    wide: [u32; LANES],
    /// The places of the points.
    at: [[u32; LANES]; 3],
}

impl Found {
    /// Lanes without surface that are outside: the formula is positive where it is defined.
    #[inline(always)]
    pub(super) fn outside(&self) -> M8 {
        self.is(Lookup::SIGN + 1) | self.is(Lookup::GAP + 1)
    }

    /// Lanes where the formula is negative.
    #[inline(always)]
    pub(super) fn within(&self) -> M8 {
        self.is(Lookup::SIGN)
    }

    #[inline(always)]
    fn is(&self, code: u32) -> M8 {
        let mut same = F8::ZERO;
        for i in 0..LANES {
            same.0[i] = if self.code[i] == code { 1.0 } else { 0.0 };
        }
        same.gt(F8::ZERO)
    }

    /// Lanes where there may be surface.
    #[inline(always)]
    pub(super) fn leaf(&self) -> M8 {
        let mut leaf = F8::ZERO;
        for i in 0..LANES {
            leaf.0[i] = if self.code[i] >= Lookup::LEAF { 1.0 } else { 0.0 };
        }
        leaf.gt(F8::ZERO)
    }

    /// The number of the leaf in a lane.
    #[inline(always)]
    pub(super) fn leaf_of(&self, i: usize) -> u32 {
        self.code[i].wrapping_sub(Lookup::LEAF)
    }
}
