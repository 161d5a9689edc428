//! An octree over the container that records where the surface is not.
//!
//! Bounds of the formula are computed for eight cells in one pass. Cells in which it has one sign
//! are dropped. The others are divided and keep a shorter tape in which decided branches are fixed
//! (T. Duff 1992; M. Keeter 2020).
//!
//! The smallest cells also have bounds of the gradient. Where these prove that the formula rises or
//! falls along a ray's direction, a stretch in the cell with the same sign at both ends holds no
//! root.
//!
//! Bounds are taken of cells enlarged by a margin. A ray is divided where it changes cells
//! according to *rounded* numbers. As long as its points' errors are below the margin, the bounds
//! of a cell hold on its stretch.

use super::line::BoundedLine;
use super::octree_lookup::{Grid, Lookup};
use durer_formula::Tape;
use durer_formula::{Dual, I8, Number};
use durer_math::{Aabb, F8, Interval, Point3, Scalar, U};
use std::collections::HashMap;
use std::sync::OnceLock;

/// The depth of the smallest cells: the container is divided by two this many times.
pub(super) const DEEPEST: u32 = 6;
/// The margin, as a fraction of the container's size.
const MARGIN: f64 = 1.0 / (1u64 << 28) as f64;

/// The facts that are proven about a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cell {
    /// The formula has this sign in all of it.
    Sign(bool),
    /// There is no surface, but the formula may be undefined; the flag is whether it is positive
    /// where defined.
    Gap(bool),
    /// There may be surface; the number of the leaf.
    Leaf(u32),
    /// The cell is divided; the number of the first of its eight parts.
    Inner(u32),
}

/// A cell in which there may be surface.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    /// The number of the cell's tape.
    tape: u32,
    /// The cell's place, in multiples of its size.
    at: [u8; 3],
}

/// Bounds of the gradient, rounded outward; infinite where the gradient may not exist.
#[derive(Clone, Copy, Debug)]
struct Gradient {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Gradient {
    const UNKNOWN: Self = Self { lo: [f32::NEG_INFINITY; 3], hi: [f32::INFINITY; 3] };

    fn new(of: [Interval; 3]) -> Self {
        Self { lo: of.map(|x| (x.lo as f32).next_down()), hi: of.map(|x| (x.hi as f32).next_up()) }
    }

    /// Whether the formula rises (`true`) or falls along a line, if that is certain.
    fn rises(&self, line: &BoundedLine) -> Option<bool> {
        let (lo, hi) = slope_along(self.lo.map(f64::from), self.hi.map(f64::from), line.d, line.d_err);
        if lo > 0.0 { Some(true) } else { (hi < 0.0).then_some(false) }
    }
}

/// Bounds of the slope along a direction `d` that is known within `e`, for a gradient between
/// `least` and `most`; for one line, or for eight. Infinite bounds carry no information.
#[inline(always)]
pub(super) fn slope_along<T: Scalar + Number>(least: [T; 3], most: [T; 3], d: [T; 3], e: [T; 3]) -> (T, T) {
    let zero = T::from(0.0);
    // Covers underflow.
    let (mut lo, mut hi, mut unsure) = (zero, zero, T::from(durer_math::scale::pow2(-1000)));
    for axis in 0..3 {
        let (a, b) = (least[axis] * d[axis], most[axis] * d[axis]);
        lo = lo + T::min(&a, &b);
        hi = hi + T::max(&a, &b);
        let steepest = T::max(&Scalar::abs(least[axis]), &Scalar::abs(most[axis]));
        // The product's rounding, those of the sums, and the error of the direction.
        let off = Scalar::abs(d[axis]) * T::from(8.0 * U) + e[axis] * T::from(1.0 + 8.0 * U);
        unsure = unsure + steepest * off;
    }
    // One more rounding.
    let unsure = unsure + (Scalar::abs(lo) + Scalar::abs(hi)) * T::from(2.0 * U);
    (lo - unsure, hi + unsure)
}

/// The octree.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    extent: Aabb,
    margin: f64,
    /// The container's greatest distance from the origin.
    reach: f64,
    root: Cell,
    cells: Vec<Cell>,
    grid: Grid,
    /// Groups of eight leaves with one tape each. A group with fewer leaves repeats its last one.
    leaves: Vec<Leaf>,
    /// Gradients of each group of eight leaves, computed when one of them is first needed.
    gradients: Box<[OnceLock<[Gradient; 8]>]>,
    tapes: Vec<Tape>,
    /// The number of leaves, and the mean length of their tapes.
    open: (usize, f64),
}

/// Data needed only while cells are divided.
#[derive(Default)]
struct OctreeBuild {
    /// The tapes so far, by a hash of their operations, so that equal tapes are shared.
    tapes: HashMap<u64, Vec<u32>>,
    /// The shorter tape for each tape and set of decisions, so that each is made once.
    shorter: HashMap<u32, HashMap<Box<[u64]>, u32>>,
}

/// The kind of cell that holds an interval of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) enum CellLookup<'a> {
    /// The formula has this sign.
    Sign(bool),
    /// No surface.
    Gap,
    /// There may be surface; this tape decides.
    Open(&'a Tape),
    /// There may be surface; the formula, with this tape, strictly rises (`true`) or falls along
    /// the line.
    Slope(&'a Tape, bool),
}

impl Cells {
    /// Divides `extent`, which must be bounded.
    pub(super) fn new(tape: &Tape, extent: Aabb) -> Self {
        let reach = extent.max.to_vec().max_abs().max(extent.min.to_vec().max_abs());
        let margin = reach * MARGIN;
        let mut made = Self {
            extent,
            margin,
            reach: extent.reach_from(Point3::ORIGIN),
            root: Cell::Gap(false),
            cells: Vec::new(),
            grid: Grid::new(&extent),
            leaves: Vec::new(),
            gradients: Box::default(),
            tapes: vec![tape.clone()],
            open: (0, 0.0),
        };
        made.root = made.divided(&extent, ([0; 3], 0), 0, &mut OctreeBuild::default());
        let steps: usize = made.leaves.iter().map(|leaf| made.tapes[leaf.tape as usize].len()).sum();
        made.open = (made.leaves.len(), steps as f64 / made.leaves.len().max(1) as f64);
        made.bring_together();
        made.grid.fill(made.root, &made.cells);
        made
    }

    /// Divides a cell in which there may be surface, or makes it a leaf; `at` is its place, in
    /// multiples of its size.
    fn divided(
        &mut self,
        bounds: &Aabb,
        (at, depth): ([u8; 3], u32),
        tape: u32,
        known: &mut OctreeBuild,
    ) -> Cell {
        let halves: [Aabb; 8] = core::array::from_fn(|i| octant(bounds, i));
        let grow = self.margin;
        let boxes = grown(&halves, grow);
        let is_open = |i: usize, v: &I8| v.empty >> i & 1 == 0 && v.lo.0[i] <= 0.0 && v.hi.0[i] >= 0.0;
        let whole = self.tapes[tape as usize].clone();
        let mut tapes = [tape; 8];
        let v = whole.decided_on(&boxes, is_open, |i, decided, make| {
            let same = known.shorter.get(&tape).and_then(|all| all.get(decided)).copied();
            tapes[i] = same.unwrap_or_else(|| {
                let number = make().map_or(tape, |shorter| self.shared(shorter, known));
                known.shorter.entry(tape).or_default().insert(decided.into(), number);
                number
            });
        });
        let told: [Option<Cell>; 8] = core::array::from_fn(|i| match () {
            () if is_open(i, &v) && v.jump >> i & 1 == 1 => {
                whole.sign_beside_jumps(&boxes.each_ref().map(|x| I8::splat(x.lane(i)))).map(Cell::Sign)
            }
            () if is_open(i, &v) => None,
            () if v.partial >> i & 1 == 1 => Some(Cell::Gap(v.empty >> i & 1 == 1 || v.lo.0[i] > 0.0)),
            () => Some(Cell::Sign(v.lo.0[i] > 0.0)),
        });
        if let Some(first) = told[0]
            && told.iter().all(|&cell| cell == Some(first))
        {
            return first;
        }
        let first = self.cells.len();
        self.cells.extend([Cell::Gap(false); 8]);
        for i in 0..8 {
            let at = [0, 1, 2].map(|axis| at[axis] << 1 | (i >> axis & 1) as u8);
            self.cells[first + i] = match told[i] {
                Some(cell) => cell,
                None if depth + 1 == DEEPEST => {
                    self.leaves.push(Leaf { tape: tapes[i], at });
                    Cell::Leaf(self.leaves.len() as u32 - 1)
                }
                None => self.divided(&halves[i], (at, depth + 1), tapes[i], known),
            };
        }
        Cell::Inner(first as u32)
    }

    /// Sorts leaves into groups of eight with one tape each.
    fn bring_together(&mut self) {
        let mut order: Vec<(u32, usize)> = self.leaves.iter().map(|leaf| leaf.tape).zip(0..).collect();
        order.sort_unstable();
        let (mut together, mut number) = (Vec::with_capacity(order.len()), vec![0; order.len()]);
        for alike in order.chunk_by(|a, b| a.0 == b.0) {
            for &(_, leaf) in alike {
                number[leaf] = together.len() as u32;
                together.push(self.leaves[leaf]);
            }
            let last = self.leaves[alike[alike.len() - 1].1];
            together.resize(together.len().next_multiple_of(8), last);
        }
        for cell in &mut self.cells {
            if let Cell::Leaf(leaf) = cell {
                *leaf = number[*leaf as usize];
            }
        }
        self.gradients = (0..together.len() / 8).map(|_| OnceLock::new()).collect();
        self.leaves = together;
    }

    /// Bounds of the gradient in a leaf.
    #[inline(always)]
    fn gradient(&self, leaf: u32) -> &Gradient {
        let eight = leaf as usize / 8;
        &self.gradients[eight].get_or_init(|| self.bounded(eight))[leaf as usize % 8]
    }

    /// Bounds of the gradient in eight leaves.
    #[cold]
    fn bounded(&self, eight: usize) -> [Gradient; 8] {
        let leaves = &self.leaves[8 * eight..][..8];
        let cells: [Aabb; 8] = core::array::from_fn(|i| self.bounds_of(leaves[i].at));
        gradients(&self.tapes[leaves[0].tape as usize], &grown(&cells, self.margin))
    }

    /// The box of a cell of the smallest size, as dividing made it.
    fn bounds_of(&self, at: [u8; 3]) -> Aabb {
        (0..DEEPEST).rev().fold(self.extent, |bounds, shift| {
            octant(&bounds, (0..3).fold(0, |half, axis| half | usize::from(at[axis] >> shift & 1) << axis))
        })
    }

    /// The number of a tape: that of an equal one, if there is one.
    fn shared(&mut self, tape: Tape, known: &mut OctreeBuild) -> u32 {
        let alike = known.tapes.entry(tape.fingerprint()).or_default();
        if let Some(&same) = alike.iter().find(|&&other| self.tapes[other as usize] == tape) {
            return same;
        }
        self.tapes.push(tape);
        alike.push(self.tapes.len() as u32 - 1);
        self.tapes.len() as u32 - 1
    }

    fn tape_of(&self, leaf: u32) -> &Tape {
        &self.tapes[self.leaves[leaf as usize].tape as usize]
    }

    /// The facts that hold for all points within `reach` of `p` along each axis; `None` if `reach`
    /// exceeds the margin.
    pub(super) fn place(&self, p: Point3, reach: f64) -> Option<CellLookup<'_>> {
        let spare = 0.5 * self.margin;
        let held = (0..3).all(|i| p[i] >= self.extent.min[i] - spare && p[i] <= self.extent.max[i] + spare);
        if !(held && reach < spare) {
            return None;
        }
        Some(match self.grid.look_up(p.to_array()) {
            Lookup::Sign(sign) => CellLookup::Sign(sign),
            Lookup::Gap(_) => CellLookup::Gap,
            Lookup::Leaf(leaf) => CellLookup::Open(self.tape_of(leaf)),
        })
    }

    /// See the field.
    pub(super) fn reach(&self) -> f64 {
        self.reach
    }

    /// The distance around a cell within which its bounds hold.
    pub(super) fn margin(&self) -> f64 {
        self.margin
    }

    /// The number of a tape that is valid in and near the cell of a point; the whole formula's
    /// where there is no surface.
    pub(super) fn tape_at(&self, p: [f64; 3]) -> u32 {
        match self.grid.look_up(p) {
            Lookup::Leaf(leaf) => self.leaves[leaf as usize].tape,
            Lookup::Sign(_) | Lookup::Gap(_) => 0,
        }
    }

    /// A tape by its number.
    pub(super) fn tape(&self, number: u32) -> &Tape {
        &self.tapes[number as usize]
    }

    /// The number of a leaf's tape, and bounds of the gradient in it, along each axis.
    #[inline(always)]
    pub(super) fn leaf(&self, leaf: u32) -> (u32, &[f32; 3], &[f32; 3]) {
        let Gradient { lo, hi } = self.gradient(leaf);
        (self.leaves[leaf as usize].tape, lo, hi)
    }

    /// See the field.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Divides the stretch from `a` to `b` of a line by the cells, in ascending order, without
    /// gaps, until `take` returns false.
    pub(super) fn walk<'a>(
        &'a self,
        line: &BoundedLine,
        (a, b): (f64, f64),
        take: &mut dyn FnMut(f64, f64, CellLookup<'a>) -> bool,
    ) {
        let known = line.err.iter().all(|&e| e < 0.5 * self.margin);
        if !known {
            // The ray's error is too large to locate it in cells.
            take(a, b, CellLookup::Open(&self.tapes[0]));
            return;
        }
        self.visit(self.root, &self.extent, line, (a, b), take);
    }

    fn visit<'a>(
        &'a self,
        cell: Cell,
        bounds: &Aabb,
        line: &BoundedLine,
        (a, b): (f64, f64),
        take: &mut dyn FnMut(f64, f64, CellLookup<'a>) -> bool,
    ) -> bool {
        let first = match cell {
            Cell::Sign(sign) => return take(a, b, CellLookup::Sign(sign)),
            Cell::Gap(_) => return take(a, b, CellLookup::Gap),
            Cell::Leaf(leaf) => {
                let tape = self.tape_of(leaf);
                let place = match self.gradient(leaf).rises(line) {
                    Some(rises) => CellLookup::Slope(tape, rises),
                    None => CellLookup::Open(tape),
                };
                return take(a, b, place);
            }
            Cell::Inner(first) => first,
        };
        let centre = bounds.centre();
        let d = line.direction();
        // Where the line crosses the planes between the halves; and the half it is in before.
        let mut at = [f64::INFINITY; 3];
        let mut half = 0_usize;
        for axis in 0..3 {
            let s = line.meets(axis, centre[axis]);
            let upper = if d[axis] == 0.0 || !s.is_finite() {
                line.point(a)[axis] >= centre[axis]
            } else if s <= a {
                // Crossed before.
                d[axis] > 0.0
            } else {
                at[axis] = s;
                d[axis] < 0.0
            };
            half |= usize::from(upper) << axis;
        }
        let mut from = a;
        loop {
            let axis = (0..3).fold(0, |best, axis| if at[axis] < at[best] { axis } else { best });
            let to = at[axis].min(b);
            if to > from || (from == a && to == b) {
                let child = self.cells[first as usize + half];
                if !self.visit(child, &octant(bounds, half), line, (from, to), take) {
                    return false;
                }
                from = to;
            }
            if at[axis] >= b {
                return true;
            }
            half ^= 1 << axis;
            at[axis] = f64::INFINITY;
        }
    }

    /// The number of cells that may hold surface, and the mean length of their tapes.
    pub(super) fn open(&self) -> (usize, f64) {
        self.open
    }
}

/// Eight cells, larger by a margin.
fn grown(cells: &[Aabb; 8], margin: f64) -> [I8; 3] {
    core::array::from_fn(|axis| {
        let lo = F8(core::array::from_fn(|i| (cells[i].min[axis] - margin).next_down()));
        let hi = F8(core::array::from_fn(|i| (cells[i].max[axis] + margin).next_up()));
        I8::new(lo, hi)
    })
}

/// Bounds of the gradient on eight boxes.
fn gradients(tape: &Tape, boxes: &[I8; 3]) -> [Gradient; 8] {
    let Dual { v, d } = tape.gradients(boxes);
    let d = d.d;
    let rough = d.iter().fold(v.partial | v.jump, |bits, d| bits | d.partial);
    core::array::from_fn(|lane| {
        if rough >> lane & 1 == 1 {
            Gradient::UNKNOWN
        } else {
            Gradient::new(d.each_ref().map(|d| d.lane(lane)))
        }
    })
}

/// One of the eight halves of a box: bit `i` of `number` says which along axis `i`.
pub(super) fn octant(bounds: &Aabb, number: usize) -> Aabb {
    let centre = bounds.centre();
    let mut half = *bounds;
    for axis in 0..3 {
        if number >> axis & 1 == 1 {
            half.min[axis] = centre[axis];
        } else {
            half.max[axis] = centre[axis];
        }
    }
    half
}
