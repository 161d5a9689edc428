//! Twists and tapers: heights do not change, and each height is turned or scaled by an amount of
//! its own.
//!
//! ```text
//!   twist: (x, y) -> R(a(z)) (x, y),  inverse R(-a(z));   a: 0 below, all above, linear between
//!   taper: (x, y) -> s(z) (x, y),     inverse 1 / s(z);   s: 1 below, the factor above, linear between
//! ```
//!
//! A. H. Barr, "Global and local deformations of solid primitives", SIGGRAPH 1984. Both are one to
//! one: the map within a height depends on the height alone, which does not change, and it has an
//! inverse, since s > 0.

use super::{Map, Stretch};
use crate::implicit::level_set::expr::{ExprBuilder, Step};
use durer_formula::Function;
use durer_formula::{FormulaError, NodeId};
use durer_math::Interval;

const UNIT: Interval = Interval { lo: 0.0, hi: 1.0 };

impl Stretch {
    /// How far along the stretch a height is: 0 to 1.
    fn ratio(self, z: Interval) -> Interval {
        let t = (z - Interval::from(self.from)) / self.length();
        // Both ends of what is outside come to the same end of [0, 1].
        t.max(Interval::from(0.0)).min(Interval::from(1.0))
    }

    fn ratio_of(self, pen: &mut ExprBuilder, z: NodeId) -> Step {
        let (from, length) = (pen.number(self.from)?, pen.enclosed(self.length())?);
        let above = pen.sub(z, from)?;
        let t = pen.div(above, length)?;
        let (zero, one) = (pen.number(UNIT.lo)?, pen.number(UNIT.hi)?);
        let t = pen.max(t, zero)?;
        pen.min(t, one)
    }
}

/// Turns by `turn` radians from one end of the stretch to the other.
pub(super) struct Twist {
    pub(super) turn: Interval,
    pub(super) stretch: Stretch,
}

impl Map for Twist {
    fn applied(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let (t, turn) = (self.stretch.ratio_of(pen, z)?, pen.enclosed(self.turn)?);
        let a = pen.mul(turn, t)?;
        let (s, c) = (pen.of(Function::Sin, a)?, pen.of(Function::Cos, a)?);
        let (xc, ys, yc, xs) = (pen.mul(x, c)?, pen.mul(y, s)?, pen.mul(y, c)?, pen.mul(x, s)?);
        Ok([pen.sub(xc, ys)?, pen.add(xs, yc)?, z])
    }

    fn image(&self, [x, y, z]: [Interval; 3]) -> [Interval; 3] {
        let a = self.turn * self.stretch.ratio(z);
        let (s, c) = (a.sin(), a.cos());
        [x * c - y * s, x * s + y * c, z]
    }

    fn undone(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let (t, turn) = (self.stretch.ratio_of(pen, z)?, pen.enclosed(self.turn)?);
        let a = pen.mul(turn, t)?;
        let (s, c) = (pen.of(Function::Sin, a)?, pen.of(Function::Cos, a)?);
        let (xc, ys, yc, xs) = (pen.mul(x, c)?, pen.mul(y, s)?, pen.mul(y, c)?, pen.mul(x, s)?);
        Ok([pen.add(xc, ys)?, pen.sub(yc, xs)?, z])
    }
}

/// Scales by 1 at one end of the stretch and by `factor` at the other.
pub(super) struct Taper {
    pub(super) factor: f64,
    pub(super) stretch: Stretch,
}

impl Taper {
    fn grows(&self) -> Interval {
        Interval::from(self.factor) - Interval::from(1.0)
    }
}

impl Map for Taper {
    fn applied(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let t = self.stretch.ratio_of(pen, z)?;
        let (one, grows) = (pen.number(1.0)?, pen.enclosed(self.grows())?);
        let grown = pen.mul(grows, t)?;
        let s = pen.add(one, grown)?;
        Ok([pen.mul(x, s)?, pen.mul(y, s)?, z])
    }

    fn image(&self, [x, y, z]: [Interval; 3]) -> [Interval; 3] {
        let s = Interval::from(1.0) + self.grows() * self.stretch.ratio(z);
        [x * s, y * s, z]
    }

    fn undone(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let t = self.stretch.ratio_of(pen, z)?;
        // 1 + (factor - 1) t: the lesser of its ends is positive, and bounds never reach zero.
        let (one, grows) = (pen.number(1.0)?, pen.enclosed(self.grows())?);
        let grown = pen.mul(grows, t)?;
        let s = pen.add(one, grown)?;
        let least = pen.number(0.5 * self.factor.min(1.0))?;
        let s = pen.max(s, least)?;
        Ok([pen.div(x, s)?, pen.div(y, s)?, z])
    }
}
