//! Maps of the point at which a pattern is evaluated.

use durer_math::{Point3, Vec3};

use crate::{NoiseGenerator, Octaves, Placement};

/// Octaves of noise that move points, with their strength along the three axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// The strength along each axis.
    pub amount: Vec3,
    /// The octaves.
    pub octaves: Octaves,
    /// The generator of the noise; `None` for that of the scene.
    pub generator: Option<NoiseGenerator>,
}

/// A map of the point at which a pattern is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum PointWarp {
    /// The inverse of a placement.
    Placed(Placement),
    /// Moves points by noise.
    Turbulence(Turbulence),
    /// Repeats a slice of the pattern along an axis.
    Repeat {
        /// The axis: 0, 1 or 2.
        axis: usize,
        /// The width of the slice.
        width: f64,
        /// How far the pattern is moved from each slice to the next.
        offset: Vec3,
        /// The axes along which every other slice is mirrored.
        flip: [bool; 3],
    },
    /// Moves points towards a centre, or away from it.
    BlackHole(BlackHole),
    /// Wraps the plane of a flat pattern around a cylinder, a sphere or a torus about the y axis.
    Wrapped(Wrap),
    /// The sides of cubes around the origin, unfolded to a cross of four by three squares that fills
    /// the unit square of the pattern's plane; `z` is the greatest of the three coordinates there.
    Cubic,
    /// Takes the pattern of a plane and extends it along z.
    Planar {
        /// The plane's normal, of any length but zero.
        normal: Vec3,
        /// The plane's distance from the origin.
        distance: f64,
    },
}

/// A region in which points are moved towards its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlackHole {
    /// The centre.
    pub centre: Point3,
    /// The radius of the region.
    pub radius: f64,
    /// The strength of the displacement.
    pub strength: f64,
    /// The exponent with which the displacement decreases from the centre to the border.
    pub falloff: f64,
    /// Whether points move away from the centre.
    pub inverse: bool,
    /// The distance at which the region is repeated along each axis; 0 for one region.
    pub repeat: Vec3,
    /// The greatest random shift of each repeated region.
    pub scatter: Vec3,
}

/// A flat pattern that is wrapped around a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap {
    /// The body around which it is wrapped.
    pub around: Around,
    /// The direction in which the flat pattern is viewed.
    pub orientation: Vec3,
    /// The exponent of the distance by which the pattern grows with the distance from the axis.
    pub growth: f64,
}

/// A body around which a flat pattern is wrapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Around {
    /// A cylinder about the y axis.
    Cylinder,
    /// A sphere.
    Sphere,
    /// A torus about the y axis with this major radius.
    Torus(f64),
}
