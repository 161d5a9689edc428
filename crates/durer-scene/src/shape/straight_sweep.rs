//! Sweeps along a straight path.

use durer_math::{Point3, Vec3};
use durer_surfaces::{StraightPath, StraightPathError};

use crate::Spline;

/// A profile that moves along a straight path, closed by flat caps unless the object is open.
#[derive(Clone, Debug, PartialEq)]
pub struct StraightSweep {
    /// Closed outlines in the plane across the path. The inside has an odd winding number.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// How an outline goes through its points, as in [`Prism::spline`](crate::Prism::spline).
    pub spline: Spline,
    /// The ends of the path.
    pub path: [Point3; 2],
    /// The sizes of the profile at the ends, positive; linear between them.
    pub sizes: [f64; 2],
    /// The profile's second axis points to this side. For the frame without it see
    /// [`StraightPath::new`](durer_surfaces::StraightPath::new).
    pub up: Option<Vec3>,
}

impl StraightSweep {
    /// The path with the frame and the sizes of the profile.
    pub fn straight_path(&self) -> Result<StraightPath, StraightPathError> {
        let [from, to] = self.path;
        StraightPath::new(from, to, self.sizes, self.up)
    }
}
