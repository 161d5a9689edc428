//! Finishes: how a surface reflects and scatters light.

use crate::{NoiseGenerator, Rgb};

/// How a layer of a texture reflects and scatters light.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// The fraction of its colour that it shows in the scene's ambient light.
    pub ambient: Rgb,
    /// The fraction of its colour that it shows without any light.
    pub emission: Rgb,
    /// The fraction of light from the front that is scattered diffusely.
    pub diffuse: f64,
    /// The fraction of light from behind that is scattered diffusely.
    pub diffuse_back: f64,
    /// The exponent of the cosine of the angle of incidence.
    pub brilliance: f64,
    /// The strength of Phong's highlight.
    pub phong: f64,
    /// The exponent of Phong's highlight.
    pub phong_size: f64,
    /// The strength of Blinn's highlight.
    pub specular: f64,
    /// The reciprocal of the exponent of Blinn's highlight; positive.
    pub roughness: f64,
    /// How much highlights take the pigment's colour, from 0 to 1.
    pub metallic: f64,
    /// The greatest random darkening of diffuse light.
    pub crand: f64,
    /// The reflection, if there is one.
    pub reflection: Option<Box<Reflection>>,
    /// The interference of a thin film, if there is one.
    pub irid: Option<Irid>,
    /// Whether reflected light is subtracted from the light that passes.
    pub conserve_energy: bool,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            ambient: Rgb::grey(0.1),
            emission: Rgb::BLACK,
            diffuse: 0.6,
            diffuse_back: 0.0,
            brilliance: 1.0,
            phong: 0.0,
            phong_size: 40.0,
            specular: 0.0,
            roughness: 0.05,
            metallic: 0.0,
            crand: 0.0,
            reflection: None,
            irid: None,
            conserve_energy: false,
        }
    }
}

/// A thin film on a surface: light that is scattered is multiplied by
/// `1 + amount cos(2 pi thickness (cos a + cos b) / wavelength)` for the angles of the light and of
/// the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irid {
    /// The strength.
    pub amount: f64,
    /// The thickness, in the unit of the wavelengths.
    pub thickness: f64,
    /// The wavelengths of red, green and blue light.
    pub wavelength: Rgb,
    /// How much the thickness varies from place to place: it is multiplied by
    /// `1 + turbulence (2 T - 1)`, where `T` is five octaves of noise at the point in space.
    pub turbulence: f64,
    /// The generator of that noise; `None` for that of the scene.
    pub generator: Option<NoiseGenerator>,
}

/// How a surface reflects its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    /// The fraction reflected head-on.
    pub min: Rgb,
    /// The fraction reflected at grazing angles.
    pub max: Rgb,
    /// The interpolation from `min` to `max` is `(1 - cos)^falloff`.
    pub falloff: f64,
    /// Whether the interpolation is instead Fresnel's reflectance for the interior's index of
    /// refraction.
    pub fresnel: bool,
    /// The reflected colour is raised to the reciprocal of this.
    pub exponent: f64,
    /// How much the reflected light takes the pigment's colour, from 0 to 1.
    pub metallic: f64,
}

impl Reflection {
    /// A reflection that is the same at every angle.
    pub fn constant(colour: Rgb) -> Self {
        Self { min: colour, max: colour, falloff: 1.0, fresnel: false, exponent: 1.0, metallic: 0.0 }
    }
}
