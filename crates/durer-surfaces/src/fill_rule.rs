//! Which points are inside of outlines.

/// The winding numbers that count as inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// Odd numbers: an outline within another is a hole, whatever its direction.
    #[default]
    EvenOdd,
    /// All but zero: overlapping outlines of one direction form a union, and one of the opposite
    /// direction is a hole.
    NonZero,
}
