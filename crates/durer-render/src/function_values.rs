//! The values of a function that depends on textures.

use std::sync::Arc;

use durer_math::AffineError;
use durer_scene::{LearnedNoise, SampledFunction, Settings};

use crate::texture::{Grains, Sampled, building_with};

/// A function that depends on textures, prepared for evaluation.
#[derive(Clone, Debug)]
pub struct FunctionValues(Sampled);

impl FunctionValues {
    /// Prepares a function of a scene with this noise (`None` for durer's own) and these settings.
    pub fn new(
        function: &SampledFunction,
        noise: Option<&Arc<LearnedNoise>>,
        settings: &Settings,
    ) -> Result<Self, AffineError> {
        let grains = noise.map_or(Grains::Own, |noise| Grains::Learned(noise.clone()));
        building_with(grains, settings.into(), || Sampled::new(function)).map(Self)
    }

    /// The value for some inputs; NaN where it is undefined, or if there are too few.
    pub fn value(&self, inputs: &[f64]) -> f64 {
        self.0.value(inputs)
    }
}
