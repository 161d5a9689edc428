//! The scene as a whole, and its settings.

use std::sync::Arc;

use crate::{
    Camera, Colour, Fog, LearnedNoise, Light, LightGroup, NoiseGenerator, Object, Pigment, Rainbow, Rgb,
};

/// A whole scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The visible objects, in the order of the text.
    pub objects: Vec<Object>,
    /// The light sources.
    pub lights: Vec<Light>,
    /// The camera. Pictures need it, rays do not.
    pub camera: Option<Camera>,
    /// The colour that rays without a hit see.
    pub background: Background,
    /// The sky in front of the background, for rays without a hit.
    pub sky: Option<SkySphere>,
    /// All fog.
    pub fogs: Vec<Fog>,
    /// All rainbows. They are in front of hits and background, and seen through fog.
    pub rainbows: Vec<Rainbow>,
    /// The light groups, to which lights and objects refer by their numbers.
    pub light_groups: Vec<LightGroup>,
    /// The scene's own settings.
    pub settings: Settings,
    /// The noise of textures, if it is not durer's own.
    pub noise: Option<Arc<LearnedNoise>>,
}

/// The colour that rays without a hit see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background(pub Colour);

impl Default for Background {
    /// Black and clear.
    fn default() -> Self {
        Self(Colour { rgb: Rgb::BLACK, filter: 0.0, transmit: 1.0 })
    }
}

/// Pigments at an infinite distance: the point of a pigment that a ray sees is its direction, scaled
/// to length 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SkySphere {
    /// The layers, the lowest first. A layer transmits light from behind like a layer of a surface.
    pub pigments: Vec<Pigment>,
    /// The factor of their colours.
    pub emission: Rgb,
}

/// The scene's own settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the scene's colour values relate to light.
    pub assumed_gamma: AssumedGamma,
    /// The version of the language that the scene is written in, such as 3.7. Before 3.7 a
    /// filtering layer is more opaque.
    pub version: f64,
    /// The greatest level of rays. Camera rays have level 1, their reflections level 2, and so on.
    pub max_trace_level: u32,
    /// Rays with a smaller weight than this are not traced.
    pub adc_bailout: f64,
    /// The light that is everywhere.
    pub ambient_light: Rgb,
    /// The number of centres of the waves of `ripples` and `waves`.
    pub number_of_waves: u32,
    /// The generator of noise that names none of its own.
    pub noise_generator: NoiseGenerator,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            assumed_gamma: AssumedGamma::Power(1.0),
            version: 3.7,
            max_trace_level: 5,
            adc_bailout: 1.0 / 255.0,
            ambient_light: Rgb::WHITE,
            number_of_waves: 10,
            noise_generator: NoiseGenerator::default(),
        }
    }
}

/// How the scene's colour values relate to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssumedGamma {
    /// The values are written into files unchanged.
    None,
    /// Light is the value to this power; 1 if the values are light.
    Power(f64),
    /// The values are encoded as in sRGB.
    Srgb,
}
