//! The colours of a pigment without a surface.

use std::sync::Arc;

use durer_math::{Affine, AffineError, F8, Isa, M8, Point3};
use durer_scene::{Colour, LearnedNoise, Pigment, Settings};

use crate::lanes::Colour8;
use crate::texture::{Around, Around8, Grains, RenderPigment, building_with};

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
        building_with(grains, settings.into(), build).map(Self)
    }

    /// The colour at a point.
    pub fn at(&self, p: Point3) -> Colour {
        self.0.at(p, Around::NOWHERE)
    }

    /// The brightness at eight points: [`Rgb::luminance`](durer_scene::Rgb::luminance), but for rounding.
    pub fn luminances(&self, p: Point3<F8>) -> F8 {
        let mut shown = [Colour8::splat(Colour::default())];
        let points = core::iter::once((p, Around8::NOWHERE, M8::ALL));
        self.0.show(Isa::detect(), points, &mut shown);
        let [Colour8 { rgb, .. }] = shown;
        F8(core::array::from_fn(|i| rgb.lane(i).luminance()))
    }
}
