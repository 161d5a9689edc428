//! Solids as formulas: `f(p) < 0` inside.
//!
//! ```text
//!   union: min(f, g)    intersection: max(f, g)    complement: -f    moved by D: f(D^-1(p))
//! ```
//!
//! A. Ricci, "A constructive geometry for computer graphics", *The Computer Journal* 16(2), 1973.
//! So every CSG solid is a formula, and on a box where one of two operands is known to decide, the
//! tape omits the other.

mod blob;
pub(crate) mod expr;
pub mod primitives;

use super::{Container, Isosurface, IsosurfaceError};
use crate::AxisBox;
use durer_formula::I8;
use durer_formula::{Formula, FormulaError, NodeId, Tape};
use durer_math::{Aabb, Affine, F8, Vec3};
use expr::ExprBuilder;

/// The margin of a level set's container on each side, relative to its size: the formula's sign is
/// certain there.
const ROOM: f64 = 1.0 / 64.0;
/// The container of a solid is divided this many times for its bounds.
const DEPTH: u32 = 4;

/// A solid: a formula of a point that is negative inside, and a box that provably holds the inside.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSet {
    formula: Formula,
    bounds: Aabb,
    /// Whether it combines several solids, whose faces may coincide.
    combined: bool,
}

impl LevelSet {
    /// The points with `formula < 0`, all of which must lie in `bounds`; [`Aabb::UNBOUNDED`] if
    /// there is no box.
    ///
    /// # Panics
    ///
    /// If the formula does not take three numbers.
    pub fn new(formula: Formula, bounds: Aabb) -> Self {
        assert_eq!(formula.inputs(), 3, "a level set is a function of x, y and z");
        Self { formula, bounds, combined: false }
    }

    /// The formula.
    pub fn formula(&self) -> &Formula {
        &self.formula
    }

    /// A box around it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The points whose images under the steps of `inverse` lie in this solid; all of them in
    /// `bounds`.
    pub(crate) fn pulled_back(
        &self,
        bounds: Aabb,
        inverse: impl FnOnce(&mut ExprBuilder, [NodeId; 3]) -> Result<[NodeId; 3], FormulaError>,
    ) -> Result<Self, FormulaError> {
        let (mut pen, p) = ExprBuilder::new()?;
        let q = inverse(&mut pen, p)?;
        let f = pen.call(&self.formula, q)?;
        Ok(Self { formula: pen.done(f), bounds, combined: self.combined })
    }

    /// The solid with another formula and box.
    pub(crate) fn rewritten(&self, formula: Formula, bounds: Aabb) -> Self {
        Self { formula, bounds, ..*self }
    }

    /// The solid placed by a map.
    pub fn placed(&self, place: &Affine) -> Result<Self, FormulaError> {
        self.placed_within(place, place.bounds(&self.bounds))
    }

    /// [`LevelSet::placed`] with a tighter box.
    pub fn placed_within(&self, place: &Affine, bounds: Aabb) -> Result<Self, FormulaError> {
        if *place == Affine::IDENTITY {
            return Ok(Self { bounds, ..self.clone() });
        }
        self.pulled_back(bounds, |pen, p| pen.undone(p, place))
    }

    /// The union; empty if there are no parts.
    pub fn union(parts: &[Self]) -> Result<Self, FormulaError> {
        let bounds = parts.iter().fold(Aabb::EMPTY, |all, part| all.union(part.bounds));
        Self::joined(parts, bounds, 1.0, ExprBuilder::min)
    }

    /// The intersection; the whole space if there are no parts.
    pub fn intersection(parts: &[Self]) -> Result<Self, FormulaError> {
        let bounds = parts.iter().fold(Aabb::UNBOUNDED, |all, part| all.intersection(part.bounds));
        Self::joined(parts, bounds, -1.0, ExprBuilder::max)
    }

    /// The complement.
    pub fn complement(&self) -> Result<Self, FormulaError> {
        let (mut pen, p) = ExprBuilder::new()?;
        let f = pen.call(&self.formula, p)?;
        let f = pen.neg(f)?;
        Ok(Self { formula: pen.done(f), bounds: Aabb::UNBOUNDED, combined: self.combined })
    }

    fn joined(
        parts: &[Self],
        bounds: Aabb,
        of_none: f64,
        join: impl Fn(&mut ExprBuilder, NodeId, NodeId) -> expr::Step,
    ) -> Result<Self, FormulaError> {
        let (mut pen, p) = ExprBuilder::new()?;
        let mut whole = None;
        for part in parts {
            let f = pen.call(&part.formula, p)?;
            whole = Some(match whole {
                None => f,
                Some(whole) => join(&mut pen, whole, f)?,
            });
        }
        let f = match whole {
            Some(f) => f,
            None => pen.number(of_none)?,
        };
        let combined = parts.len() > 1 || parts.iter().any(|part| part.combined);
        Ok(Self { formula: pen.done(f), bounds, combined })
    }

    /// Boxes that provably hold all of it, small ones where possible. Its own box must be bounded.
    pub(crate) fn cells(&self) -> Vec<Aabb> {
        let tape = Tape::new(&self.formula);
        let mut cells = vec![self.bounds];
        for _ in 0..DEPTH {
            let mut next = Vec::with_capacity(2 * cells.len());
            for cell in cells {
                let parts: [Aabb; 8] = core::array::from_fn(|i| super::octree::octant(&cell, i));
                let v = tape.bounds(&boxes(&parts));
                next.extend((0..8).filter(|i| v.empty >> i & 1 == 0 && v.lo.0[*i] <= 0.0).map(|i| parts[i]));
            }
            cells = next;
        }
        cells
    }

    /// Its surface, without skins where faces of its parts coincide; `None` if it is certainly
    /// empty. Its box must be bounded.
    pub fn surface(&self) -> Result<Option<Isosurface>, IsosurfaceError> {
        let bounds = self.cells().iter().fold(Aabb::EMPTY, |all, cell| all.union(*cell));
        if bounds.is_empty() {
            return Ok(None);
        }
        let room = bounds.widths().max_abs() * ROOM + f64::MIN_POSITIVE;
        let held = bounds.expanded(Vec3::new(room, room, room));
        let held = AxisBox::new(held.min, held.max)?;
        let surface = Isosurface::new(&self.formula, 0.0, Container::Box(held))?;
        Ok(Some(if self.combined { surface.regular() } else { surface }))
    }
}

/// Eight boxes side by side.
pub(crate) fn boxes(parts: &[Aabb; 8]) -> [I8; 3] {
    core::array::from_fn(|axis| {
        I8::new(
            F8(core::array::from_fn(|i| parts[i].min[axis])),
            F8(core::array::from_fn(|i| parts[i].max[axis])),
        )
    })
}
