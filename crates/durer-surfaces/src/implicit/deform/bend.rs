//! Bends: a piece of the axis becomes an arc, and the space around it moves with it.
//!
//! ```text
//!          z ▲                  angle a(z) = (z - from) / R within the stretch, with R = length / angle;
//!        to  ┤                  x -> R - (R - x) cos a
//!            │   x              z -> from + (R - x) sin a;   beyond the stretch rigid
//!       from ┤───▶── • centre (R, from)
//! ```
//!
//! A. H. Barr, "Global and local deformations of solid primitives", SIGGRAPH 1984. In polar
//! coordinates about the centre, with u = R - x and v = z - from, the inverse is x = R - r and z =
//! from + R a in the bent part, the turn back by the whole angle beyond it. A determinant does not
//! prove that the map is one to one (it is (R - x) / R however far the bend goes round), but angles
//! do: the bent part of a solid with x < R covers those from 0 to the whole angle, each rigid part
//! those between it and an arc tangent. As long as all of them together are less than a turn, they
//! are distinct: the polar angle is taken from half a turn before their middle to half a turn
//! behind it. No part of the solid is where it jumps, but bounds of the inverse would be useless
//! there: in a wedge about that half-plane the formula is replaced by a positive number.

use super::{DeformError, Map, Stretch, columns, direction};
use crate::implicit::level_set::expr::{ExprBuilder, Step};
use durer_formula::Function;
use durer_formula::{FormulaError, NodeId};
use durer_math::{Aabb, Affine, Interval, Vec3, elementary};

/// The least angle between the ends of a bent solid, across the gap: the cosine of the gap's edge
/// differs from -1 by about half of this squared.
const LEAST_GAP: f64 = 1.0 / (1 << 20) as f64;

/// The least sine of the angle between a bend's axis and direction. Both are rounded unit vectors,
/// so the direction's component across the axis has an error of about `8 U`: with this sine it is
/// perpendicular within a millionth.
const LEAST_SINE: f64 = 1.0 / (1 << 30) as f64;

/// A bend towards x.
pub(super) struct Bend {
    turn: Interval,
    stretch: Stretch,
    radius: Interval,
    /// The middle of the solid's polar angles.
    middle: f64,
    /// The cosine of the angle from `middle` beyond which no part of the solid is.
    edge: f64,
    /// Whether parts of the solid lie below, within and above the stretch.
    below: bool,
    between: bool,
    above: bool,
}

/// The frame with the axis for z and the direction for x: exact if both are coordinate axes, else
/// rounded to f64.
pub(super) fn frame(axis: Vec3, toward: Vec3) -> Result<Affine, DeformError> {
    let z = direction(axis).ok_or(DeformError::Axis { warp: "bend", axis })?;
    let unit = direction(toward).ok_or(DeformError::Toward(toward))?;
    let across = unit - z * z.dot(unit);
    if across.length() < LEAST_SINE {
        return Err(DeformError::Toward(toward));
    }
    let x = direction(across).ok_or(DeformError::Toward(toward))?;
    columns(x, z.cross(x), z)
}

/// `atan(a / b)` for `b > 0`.
fn seen(a: Interval, b: Interval) -> Interval {
    (a / b).atan()
}

impl Bend {
    /// A bend by a positive angle of a solid within `held`.
    pub(super) fn new(turn: Interval, stretch: Stretch, held: Aabb) -> Result<Self, DeformError> {
        let radius = stretch.length() / turn;
        if held.is_empty() {
            return Ok(Self {
                turn,
                stretch,
                radius,
                middle: 0.0,
                edge: 0.0,
                below: false,
                between: true,
                above: false,
            });
        }
        let nearest = radius - Interval::from(held.max.x);
        if nearest.lo <= 0.0 {
            return Err(DeformError::Centre { reach: held.max.x, radius: radius.mid() });
        }
        let (low, high) = (Interval::from(held.min.z), Interval::from(held.max.z));
        let (from, to) = (Interval::from(stretch.from), Interval::from(stretch.to));
        let (below, above) = (held.min.z < stretch.from, held.max.z > stretch.to);
        let within = |z: Interval| (z.max(from).min(to) - from) / radius;
        let first = if below { -seen(from - low, nearest) } else { within(low) };
        let last = if above { turn + seen(high - to, nearest) } else { within(high) };
        let round = last - first;
        let whole = Interval::PI + Interval::PI;
        let told = round.hi < whole.lo - LEAST_GAP;
        if !told {
            return Err(DeformError::Round { degrees: round.to_degrees().hi });
        }
        let middle = ((first + last) * Interval::from(0.5)).mid();
        // Half way from the last angle to half a turn.
        let edge = elementary::cos(0.25 * round.hi + core::f64::consts::FRAC_PI_2);
        let between = held.max.z > stretch.from && held.min.z < stretch.to;
        Ok(Self { turn, stretch, radius, middle, edge, below, between, above })
    }
}

impl Map for Bend {
    fn applied(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let (from, to) = (pen.number(self.stretch.from)?, pen.number(self.stretch.to)?);
        let radius = pen.enclosed(self.radius)?;
        let above = pen.max(z, from)?;
        let held = pen.min(above, to)?;
        let (along, beyond, u) = (pen.sub(held, from)?, pen.sub(z, held)?, pen.sub(radius, x)?);
        let a = pen.div(along, radius)?;
        let (s, c) = (pen.of(Function::Sin, a)?, pen.of(Function::Cos, a)?);
        let (uc, us) = (pen.mul(u, c)?, pen.mul(u, s)?);
        let (bs, bc) = (pen.mul(beyond, s)?, pen.mul(beyond, c)?);
        let (x, z) = (pen.sub(radius, uc)?, pen.add(from, us)?);
        Ok([pen.add(x, bs)?, y, pen.add(z, bc)?])
    }

    fn image(&self, [x, y, z]: [Interval; 3]) -> [Interval; 3] {
        let (from, to) = (Interval::from(self.stretch.from), Interval::from(self.stretch.to));
        let held = z.max(from).min(to);
        let (a, beyond) = ((held - from) / self.radius, z - held);
        let (s, c) = (a.sin(), a.cos());
        let u = self.radius - x;
        [self.radius - u * c + beyond * s, y, from + u * s + beyond * c]
    }

    fn undone(&self, pen: &mut ExprBuilder, [x, y, z]: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError> {
        let (from, to) = (pen.number(self.stretch.from)?, pen.number(self.stretch.to)?);
        let (radius, turn) = (pen.enclosed(self.radius)?, pen.enclosed(self.turn)?);
        let (u, v) = (pen.sub(radius, x)?, pen.sub(z, from)?);
        let far = far(pen, u, v)?;
        let [turned_u, turned_v] = self.turned(pen, u, v)?;
        let (middle, from_middle) = (pen.number(self.middle)?, pen.atan2(turned_v, turned_u)?);
        let angle = pen.add(middle, from_middle)?;
        let bent = {
            let along = pen.mul(radius, angle)?;
            (pen.sub(radius, far)?, pen.add(from, along)?)
        };
        let below = (x, z);
        let above = {
            let (s, c) = (pen.enclosed(self.turn.sin())?, pen.enclosed(self.turn.cos())?);
            let (uc, vs, us, vc) = (pen.mul(u, c)?, pen.mul(v, s)?, pen.mul(u, s)?, pen.mul(v, c)?);
            let (u, beyond) = (pen.add(uc, vs)?, pen.sub(vc, us)?);
            (pen.sub(radius, u)?, pen.add(to, beyond)?)
        };
        let mut was = match (self.between, self.below) {
            (true, _) => bent,
            (false, true) => below,
            (false, false) => above,
        };
        if self.between && self.below {
            was = (pen.select(angle, below.0, was.0)?, pen.select(angle, below.1, was.1)?);
        }
        if self.between && self.above {
            let past = pen.sub(angle, turn)?;
            was = (pen.select(past, was.0, above.0)?, pen.select(past, was.1, above.1)?);
        }
        Ok([was.0, y, was.1])
    }

    fn nothing(&self, pen: &mut ExprBuilder, [x, _, z]: [NodeId; 3]) -> Result<Option<NodeId>, FormulaError> {
        let (from, radius) = (pen.number(self.stretch.from)?, pen.enclosed(self.radius)?);
        let (u, v) = (pen.sub(radius, x)?, pen.sub(z, from)?);
        let (far, edge) = (far(pen, u, v)?, pen.number(self.edge)?);
        let [turned_u, _] = self.turned(pen, u, v)?;
        let least = pen.mul(far, edge)?;
        Ok(Some(pen.sub(turned_u, least)?))
    }
}

impl Bend {
    /// (u, v), turned so that the middle angle is zero.
    fn turned(&self, pen: &mut ExprBuilder, u: NodeId, v: NodeId) -> Result<[NodeId; 2], FormulaError> {
        let middle = Interval::from(self.middle);
        let (s, c) = (pen.enclosed(middle.sin())?, pen.enclosed(middle.cos())?);
        let (uc, vs, us, vc) = (pen.mul(u, c)?, pen.mul(v, s)?, pen.mul(u, s)?, pen.mul(v, c)?);
        Ok([pen.add(uc, vs)?, pen.sub(vc, us)?])
    }
}

/// The distance from the centre.
fn far(pen: &mut ExprBuilder, u: NodeId, v: NodeId) -> Step {
    let (u2, v2) = (pen.sqr(u)?, pen.sqr(v)?);
    let square = pen.add(u2, v2)?;
    pen.sqrt(square)
}
