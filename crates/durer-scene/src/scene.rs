//! The scene itself.

use crate::{Camera, Colour, Light, Object, Rgb};

/// A whole scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// What can be seen, in the order of the text.
    pub objects: Vec<Object>,
    /// What shines.
    pub lights: Vec<Light>,
    /// Who looks; pictures need it, rays do not.
    pub camera: Option<Camera>,
    /// What is seen where nothing is.
    pub background: Background,
    /// The scene's own settings.
    pub settings: Settings,
}

/// What is seen where nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background(pub Colour);

impl Default for Background {
    /// Black and clear.
    fn default() -> Self {
        Self(Colour { rgb: Rgb::BLACK, filter: 0.0, transmit: 1.0 })
    }
}

/// The scene's own settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the scene's numbers relate to light.
    pub assumed_gamma: AssumedGamma,
    /// The version of the language the scene is written in, 3.7 say. Before 3.7 a filtering layer
    /// is more opaque.
    pub version: f64,
    /// How deep rays may follow each other; the camera's has level 1.
    pub max_trace_level: u32,
    /// Rays that count for less than this are not followed.
    pub adc_bailout: f64,
    /// The light that is everywhere.
    pub ambient_light: Rgb,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            assumed_gamma: AssumedGamma::Power(1.0),
            version: 3.7,
            max_trace_level: 5,
            adc_bailout: 1.0 / 255.0,
            ambient_light: Rgb::WHITE,
        }
    }
}

/// How the scene's numbers relate to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssumedGamma {
    /// They are written into files as they are.
    None,
    /// Light is the number to this power; 1 for numbers that are light.
    Power(f64),
    /// They are encoded as sRGB has it.
    Srgb,
}
