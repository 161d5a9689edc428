//! Finishes: how a surface answers to light.

use crate::Rgb;

/// How a layer of paint answers to light.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// The part of its colour it shows in the scene's ambient light.
    pub ambient: Rgb,
    /// The part of its colour it shows without any light.
    pub emission: Rgb,
    /// The part of the light from the front that is scattered evenly.
    pub diffuse: f64,
    /// The part of the light from behind that is scattered evenly.
    pub diffuse_back: f64,
    /// `diffuse` is the albedo: it is multiplied by `(brilliance + 1) / 2`.
    pub diffuse_albedo: bool,
    /// The exponent of the cosine of the angle of incidence.
    pub brilliance: f64,
    /// The strength of Phong's highlight.
    pub phong: f64,
    /// `phong` is the albedo: it is multiplied by `(phong_size + 1) / 2`.
    pub phong_albedo: bool,
    /// The exponent of Phong's highlight.
    pub phong_size: f64,
    /// The strength of Blinn's highlight.
    pub specular: f64,
    /// `specular` is the albedo: it is multiplied by `(n + 2) / (4 (2 - 2^(-n/2)))`,
    /// `n = 1 / roughness`.
    pub specular_albedo: bool,
    /// One over the exponent of Blinn's highlight; positive.
    pub roughness: f64,
    /// How far highlights take the pigment's colour, from 0 to 1.
    pub metallic: f64,
    /// The greatest random darkening of diffuse light.
    pub crand: f64,
    /// The mirror, if there is one.
    pub reflection: Option<Box<Reflection>>,
    /// What is reflected does not pass.
    pub conserve_energy: bool,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            ambient: Rgb::grey(0.1),
            emission: Rgb::BLACK,
            diffuse: 0.6,
            diffuse_back: 0.0,
            diffuse_albedo: false,
            brilliance: 1.0,
            phong: 0.0,
            phong_albedo: false,
            phong_size: 40.0,
            specular: 0.0,
            specular_albedo: false,
            roughness: 0.05,
            metallic: 0.0,
            crand: 0.0,
            reflection: None,
            conserve_energy: false,
        }
    }
}

/// How a mirror reflects.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    /// The part reflected head-on.
    pub min: Rgb,
    /// The part reflected at grazing angles.
    pub max: Rgb,
    /// The way from `min` to `max` is `(1 - cos)^falloff`.
    pub falloff: f64,
    /// The way from `min` to `max` is Fresnel's reflectance of the interior's index of refraction.
    pub fresnel: bool,
    /// The reflected colour is raised to one over this.
    pub exponent: f64,
    /// How far the reflected light takes the pigment's colour, from 0 to 1.
    pub metallic: f64,
}

impl Reflection {
    /// The same at every angle.
    pub fn constant(colour: Rgb) -> Self {
        Self { min: colour, max: colour, falloff: 1.0, fresnel: false, exponent: 1.0, metallic: 0.0 }
    }
}
