//! Rainbows.

use durer_math::Vec3;

use crate::Colour;

/// An arc of colours around a direction, before all that is seen, in the way of fog.
#[derive(Clone, Debug, PartialEq)]
pub struct Rainbow {
    /// The direction around which it lies, of length 1.
    pub axis: Vec3,
    /// The direction to the middle of the arc, across the axis, of length 1.
    pub up: Vec3,
    /// The angle between the axis and the middle of the band, in radians.
    pub angle: f64,
    /// The width of the band, in radians.
    pub width: f64,
    /// The distance at which the fraction 1/e of the light comes through; positive.
    pub distance: f64,
    /// The colours from the inner edge (0) to the outer edge (1), each with its place.
    pub colours: Vec<(f64, Colour)>,
    /// Half of the arc, in radians.
    pub half_arc: f64,
    /// Half of the part of the arc that has its full colours, in radians.
    pub half_full: f64,
}
