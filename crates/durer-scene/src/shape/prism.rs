//! Prisms.

/// An outline in the xz plane, swept from one height to another; closed by flat caps unless the
/// object is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Closed outlines, `[x, z]` for each point. The inside has an odd winding number.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// How an outline goes through its points. Curves have all the points that their spline needs,
    /// and repeat the first point of the curve as its last.
    pub spline: Spline,
    /// The heights of both ends, in any order.
    pub heights: [f64; 2],
    /// How the outline changes with the height.
    pub sweep: Sweep,
}

/// How an outline goes through its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// By straight lines, also from the last point to the first.
    Linear,
    /// By a curve.
    Curved(durer_surfaces::Spline),
}

/// How an outline changes along its sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// It does not change.
    Linear,
    /// At the height y it is scaled by y.
    Conic,
}
