//! Fog.

use durer_math::Vec3;

use crate::{Colour, Turbulence};

/// Fog outside of objects that are not hollow.
#[derive(Clone, Debug, PartialEq)]
pub struct Fog {
    /// Its colour. At least the fraction `transmit` of the light from behind comes through; of that
    /// light, the fraction `filter` takes the fog's colour.
    pub colour: Colour,
    /// The distance at which the fraction 1/e of the light comes through; not zero.
    pub distance: f64,
    /// The layer on the ground; `None` for fog that is the same everywhere.
    pub ground: Option<GroundFog>,
    /// Stirs the distance.
    pub turbulence: Option<Turbulence>,
    /// The factor of the distance along the ray at which turbulence is looked up.
    pub turbulence_depth: f64,
}

/// Fog whose density decreases with the height: `1/(1 + ((h - offset)/fade)^2)` at a height `h`
/// above `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundFog {
    /// The direction upwards, of length 1.
    pub up: Vec3,
    /// The height up to which all of it is there.
    pub offset: f64,
    /// The height above `offset` at which half of it is there.
    pub fade: f64,
}
