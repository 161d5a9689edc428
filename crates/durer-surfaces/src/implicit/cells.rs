//! Where the surface is not: an octree over the container, built once.
//!
//! Each cell is asked for bounds of the formula, eight cells in one pass. Cells in which it has one sign are dropped; the others are divided,
//! and keep a tape in which what is decided there is decided (T. Duff 1992; M. Keeter 2020).
//!
//! Bounds are taken of cells grown by a margin. A ray is divided where *rounded* numbers say that it changes cells; as long as its points are
//! known to less than the margin, what is said of a cell holds on its stretch.

use super::line::Line;
use crate::tape::Tape;
use durer_math::{Aabb, F8, I8, Point3};

/// No cell is smaller than the container divided by two to this power.
const DEEPEST: u32 = 6;
/// So many times larger than the margin is the container.
const MARGIN: f64 = 1.0 / (1u64 << 28) as f64;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    /// The formula has this sign.
    Sign(bool),
    /// There is no surface, but the formula is not everywhere defined.
    Gap,
    /// There may be surface; the number of the tape.
    Leaf(u32),
    /// Divided; the number of the first of eight.
    Inner(u32),
}

/// The octree.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    extent: Aabb,
    margin: f64,
    root: Cell,
    cells: Vec<Cell>,
    tapes: Vec<Tape>,
}

/// What a stretch of a ray is in.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place<'a> {
    /// The formula has this sign.
    Sign(bool),
    /// No surface.
    Gap,
    /// Perhaps; this tape says more.
    Open(&'a Tape),
}

impl Cells {
    /// Divides `extent`, which must be bounded.
    pub(super) fn new(tape: &Tape, extent: Aabb) -> Self {
        let reach = extent.max.to_vec().max_abs().max(extent.min.to_vec().max_abs());
        let margin = reach * MARGIN;
        let mut made =
            Self { extent, margin, root: Cell::Leaf(0), cells: Vec::new(), tapes: vec![tape.clone()] };
        made.root = made.divided(&extent, 0, 0);
        made
    }

    /// What becomes of a cell in which there may be surface.
    fn divided(&mut self, bounds: &Aabb, tape: u32, depth: u32) -> Cell {
        if depth == DEEPEST {
            return Cell::Leaf(tape);
        }
        let halves: [Aabb; 8] = core::array::from_fn(|i| octant(bounds, i));
        let grow = self.margin;
        let boxes: [I8; 3] = core::array::from_fn(|axis| {
            let lo = F8(core::array::from_fn(|i| (halves[i].min[axis] - grow).next_down()));
            let hi = F8(core::array::from_fn(|i| (halves[i].max[axis] + grow).next_up()));
            I8::new(lo, hi)
        });
        let is_open = |i: usize, v: &I8| v.empty >> i & 1 == 0 && v.lo.0[i] <= 0.0 && v.hi.0[i] >= 0.0;
        let (v, shorter) = self.tapes[tape as usize].clone().shortened(&boxes, is_open);
        let told: [Option<Cell>; 8] = core::array::from_fn(|i| match () {
            () if is_open(i, &v) => None,
            () if v.partial >> i & 1 == 1 => Some(Cell::Gap),
            () => Some(Cell::Sign(v.lo.0[i] > 0.0)),
        });
        if let Some(first) = told[0]
            && told.iter().all(|&cell| cell == Some(first))
        {
            return first;
        }
        let first = self.cells.len();
        self.cells.extend([Cell::Gap; 8]);
        let tapes = shorter.map(|shorter| {
            shorter.map_or(tape, |shorter| {
                self.tapes.push(shorter);
                self.tapes.len() as u32 - 1
            })
        });
        for i in 0..8 {
            self.cells[first + i] = match told[i] {
                Some(cell) => cell,
                None => self.divided(&halves[i], tapes[i], depth + 1),
            };
        }
        Cell::Inner(first as u32)
    }

    /// What is known of all points within `reach` of `p` along each axis; `None` if that is more than the margin pays for.
    pub(super) fn place(&self, p: Point3, reach: f64) -> Option<Place<'_>> {
        let spare = 0.5 * self.margin;
        let held = (0..3).all(|i| p[i] >= self.extent.min[i] - spare && p[i] <= self.extent.max[i] + spare);
        if !(held && reach < spare) {
            return None;
        }
        let (mut cell, mut bounds) = (self.root, self.extent);
        loop {
            let first = match cell {
                Cell::Sign(sign) => return Some(Place::Sign(sign)),
                Cell::Gap => return Some(Place::Gap),
                Cell::Leaf(tape) => return Some(Place::Open(&self.tapes[tape as usize])),
                Cell::Inner(first) => first,
            };
            let centre = bounds.centre();
            let half = (0..3).fold(0, |half, axis| half | usize::from(p[axis] >= centre[axis]) << axis);
            cell = self.cells[first as usize + half];
            bounds = octant(&bounds, half);
        }
    }

    /// Divides the stretch from `a` to `b` of a line by the cells, in ascending order, without holes, as long as `take` says so.
    pub(super) fn walk<'a>(
        &'a self,
        line: &Line,
        (a, b): (f64, f64),
        take: &mut dyn FnMut(f64, f64, Place<'a>) -> bool,
    ) {
        let known = line.err.iter().all(|&e| e < 0.5 * self.margin);
        if !known {
            // The ray is not known well enough to say which cells it is in.
            take(a, b, Place::Open(&self.tapes[0]));
            return;
        }
        self.visit(self.root, &self.extent, line, (a, b), take);
    }

    fn visit<'a>(
        &'a self,
        cell: Cell,
        bounds: &Aabb,
        line: &Line,
        (a, b): (f64, f64),
        take: &mut dyn FnMut(f64, f64, Place<'a>) -> bool,
    ) -> bool {
        let first = match cell {
            Cell::Sign(sign) => return take(a, b, Place::Sign(sign)),
            Cell::Gap => return take(a, b, Place::Gap),
            Cell::Leaf(tape) => return take(a, b, Place::Open(&self.tapes[tape as usize])),
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

    /// How many cells there may be surface in, and the steps of their tapes on average.
    pub(super) fn open(&self) -> (usize, f64) {
        let tapes = self.cells.iter().filter_map(|cell| match cell {
            Cell::Leaf(tape) => Some(self.tapes[*tape as usize].len()),
            _ => None,
        });
        let (count, steps) = tapes.fold((0, 0), |(n, sum), len| (n + 1, sum + len));
        (count, steps as f64 / count.max(1) as f64)
    }
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
