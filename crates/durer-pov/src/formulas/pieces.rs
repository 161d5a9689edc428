//! Piecewise functions of one number: one piece between each two neighbouring knots.
//!
//! ```text
//!   c0 + s (c1 + s (c2 + s c3)),  s = x - knot
//! ```
//!
//! A tree of choices finds the piece. Where two pieces meet in one value the choice is
//! [`Op::Joined`]: the function is continuous there, and its slopes are those of the two pieces.
//! The argument of a piece is clamped to the piece and its neighbours. Only bounds over boxes that
//! reach farther evaluate it there, and far from its knots the bounds of a cubic would be useless.

use durer_formula::{Builder, FormulaError, NodeId, Op};
use durer_math::Interval;

/// A knot, with the value of the function there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Knot {
    /// Both sides have the same value.
    Meets(f64),
    /// The sides may differ; the knot itself belongs to the piece before it.
    Jumps(f64),
    /// The sides may differ; the knot itself belongs to the piece after it.
    Begins(f64),
}

impl Knot {
    fn at(self) -> f64 {
        match self {
            Self::Meets(x) | Self::Jumps(x) | Self::Begins(x) => x,
        }
    }
}

/// Chooses the part that contains `x`, one of `n + 1` parts for `n` ascending knots.
pub(crate) fn chosen(
    b: &mut Builder,
    x: NodeId,
    knots: &[Knot],
    parts: &[NodeId],
) -> Result<NodeId, FormulaError> {
    if knots.is_empty() {
        return Ok(parts[0]);
    }
    let middle = knots.len() / 2;
    let below = chosen(b, x, &knots[..middle], &parts[..=middle])?;
    let above = chosen(b, x, &knots[middle + 1..], &parts[middle + 1..])?;
    let at = b.constant(knots[middle].at())?;
    let c = b.push(Op::Sub(x, at))?;
    b.push(match knots[middle] {
        Knot::Meets(_) => Op::Joined([c, below, above]),
        Knot::Jumps(_) => Op::Select([c, below, below, above]),
        Knot::Begins(_) => Op::Select([c, below, above, above]),
    })
}

/// `x`, clamped to `[from, to]`.
pub(crate) fn clamped(b: &mut Builder, x: NodeId, from: f64, to: f64) -> Result<NodeId, FormulaError> {
    let (from, to) = (b.constant(from)?, b.constant(to)?);
    let x = b.push(Op::Max(x, from))?;
    b.push(Op::Min(x, to))
}

/// The continuous function with these knots, of which there are at least two, and these pieces
/// between them. Beyond the ends it is constant.
pub(crate) fn continuous(
    b: &mut Builder,
    x: NodeId,
    knots: &[f64],
    pieces: &[[Interval; 4]],
) -> Result<NodeId, FormulaError> {
    let last = knots.len() - 1;
    let x = clamped(b, x, knots[0], knots[last])?;
    let mut parts = Vec::with_capacity(last);
    for (i, piece) in pieces.iter().enumerate() {
        let (from, to) = (knots[i.saturating_sub(1)], knots[last.min(i + 2)]);
        let near = if last > 2 { clamped(b, x, from, to)? } else { x };
        let start = b.constant(knots[i])?;
        let s = b.push(Op::Sub(near, start))?;
        let degree = piece.iter().rposition(|c| (c.lo, c.hi) != (0.0, 0.0)).unwrap_or(0);
        let mut value = b.enclosed(piece[degree])?;
        for &c in piece[..degree].iter().rev() {
            let (c, term) = (b.enclosed(c)?, b.push(Op::Mul(s, value))?);
            value = b.push(Op::Add(c, term))?;
        }
        parts.push(value);
    }
    let inner: Vec<Knot> = knots[1..last].iter().map(|&at| Knot::Meets(at)).collect();
    chosen(b, x, &inner, &parts)
}
