//! Interiors: the media inside objects.

use crate::Rgb;

/// The medium that fills an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Interior {
    /// The index of refraction; positive.
    pub ior: f64,
    /// The factor of the light behind each surface: `refraction` in old scenes. Shadows do not have it.
    pub refraction: f64,
    /// The depth at which half of the light is left; 0 for no fading. With a negative depth the
    /// formula is evaluated as it stands.
    pub fade_distance: f64,
    /// The exponent of the fading; from 1000 on, light fades exponentially. If it is not positive,
    /// shadows do not fade.
    pub fade_power: f64,
    /// The colour of light that has faded completely.
    pub fade_color: Rgb,
    /// An approximation of caustics: light that passes a surface is multiplied by
    /// `1 + cos^caustics` of the angle to the normal. 0 for none.
    pub caustics: f64,
}

impl Default for Interior {
    fn default() -> Self {
        Self {
            ior: 1.0,
            refraction: 1.0,
            fade_distance: 0.0,
            fade_power: 0.0,
            fade_color: Rgb::BLACK,
            caustics: 0.0,
        }
    }
}
