//! Interiors: what light meets between the surfaces of an object.

use crate::Rgb;

/// What fills an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Interior {
    /// The index of refraction; positive.
    pub ior: f64,
    /// The depth at which light has faded half way; 0 is never. With a negative one the formula is
    /// taken at its word.
    pub fade_distance: f64,
    /// How sharply light fades; from 1000 on exponentially. If it is not positive shadows do not
    /// fade.
    pub fade_power: f64,
    /// What light fades to.
    pub fade_color: Rgb,
    /// A likeness of caustics: light that passes a surface is multiplied by `1 + cos^caustics` of
    /// the angle to the normal. 0 for none.
    pub caustics: f64,
}

impl Default for Interior {
    fn default() -> Self {
        Self { ior: 1.0, fade_distance: 0.0, fade_power: 0.0, fade_color: Rgb::BLACK, caustics: 0.0 }
    }
}
