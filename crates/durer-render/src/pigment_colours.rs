//! The colours of a pigment without a surface.

use std::sync::Arc;

use durer_math::{Affine, AffineError, Point3};
use durer_scene::{Colour, LearnedNoise, Pigment, Settings};

use crate::texture::{Around, Grains, RenderPigment, building_with};

/// A pigment, prepared for evaluating its colour at points.
///
/// ```
/// use durer_math::Point3;
/// use durer_render::PigmentColours;
/// use durer_scene::{Colour, Pigment, Rgb, Settings};
///
/// let grey = Pigment::solid(Colour::opaque(Rgb::grey(0.5)));
/// let colours = PigmentColours::new(&grey, None, &Settings::default())?;
/// assert_eq!(colours.at(Point3::ORIGIN).rgb, Rgb::grey(0.5));
/// # Ok::<(), durer_math::AffineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PigmentColours(RenderPigment);

impl PigmentColours {
    /// Prepares a pigment of a scene with this noise (`None` for durer's own) and these settings.
    pub fn new(
        pigment: &Pigment,
        noise: Option<&Arc<LearnedNoise>>,
        settings: &Settings,
    ) -> Result<Self, AffineError> {
        let grains = noise.map_or(Grains::Own, |noise| Grains::Learned(noise.clone()));
        let build = || RenderPigment::new(pigment, &Affine::IDENTITY);
        building_with(grains, settings.number_of_waves, build).map(Self)
    }

    /// The colour at a point.
    pub fn at(&self, p: Point3) -> Colour {
        self.0.at(p, Around::NOWHERE)
    }
}
