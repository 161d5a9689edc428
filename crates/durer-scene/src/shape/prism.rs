//! Prisms.

/// An outline in the xz plane, swept from one height to another; closed by flat caps unless the
/// object is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Closed outlines, `[x, z]` for each point. Inside is what they go round an odd number of
    /// times.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// How an outline goes through its points; curves have all the points that their spline asks
    /// for, the first one of the curve again as its last.
    pub spline: Spline,
    /// The heights of both ends, in any order.
    pub heights: [f64; 2],
    /// How the outline changes with the height.
    pub sweep: Sweep,
}

/// How an outline goes through its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// Straight from one to the next, and from the last to the first.
    Linear,
    /// On a curve.
    Curved(durer_surfaces::Spline),
}

/// How an outline changes along its sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// Not at all.
    Linear,
    /// At the height y it is y times as large.
    Conic,
}
