//! The look of the sky: rays that hit nothing see it in front of the background.

use crate::lanes::{Colour8, Rgb8};
use crate::texture::{Around8, RenderPigment};
use crate::vector::length;
use durer_math::{Affine, AffineError, F8, M8, Vec3};
use durer_scene::{Rgb, Scene};

/// A sky in front of a background.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    background: Rgb,
    /// The layers of the sky, the lowest first.
    layers: Box<[RenderPigment]>,
    emission: Rgb,
    /// Whether a layer filters all channels alike, as in scenes before version 3.7.
    filters_grey: bool,
}

impl Sky {
    /// Prepares the background and the sky of a scene.
    pub(crate) fn new(scene: &Scene, filters_grey: bool) -> Result<Self, AffineError> {
        let background = scene.background.0;
        let sky = scene.sky.as_ref();
        let pigments = sky.map_or(&[][..], |sky| &sky.pigments);
        let layers = pigments.iter().map(|own| RenderPigment::new(own, &Affine::IDENTITY));
        Ok(Self {
            // Nothing lies behind the background, so its transparent part is black.
            background: background.rgb * (1.0 - background.transmit),
            layers: layers.collect::<Result<_, _>>()?,
            emission: sky.map_or(Rgb::WHITE, |sky| sky.emission),
            filters_grey,
        })
    }

    /// The colours in some directions of any length.
    #[inline(always)]
    pub(crate) fn seen(&self, direction: Vec3<F8>, live: M8) -> Rgb8 {
        let background = Rgb8::splat(self.background);
        if self.layers.is_empty() { background } else { self.seen_through(direction, live) }
    }

    fn seen_through(&self, direction: Vec3<F8>, live: M8) -> Rgb8 {
        let p = (direction * (F8::ONE / length(direction))).to_point();
        let emission = Rgb8::splat(self.emission);
        let mut seen = Rgb8::splat(self.background);
        for layer in &self.layers {
            let colour: Colour8 = layer.colours(p, &Around8::NOWHERE, live);
            let clear = colour.filter + colour.transmit;
            let own = colour.rgb * emission * (F8::ONE - clear);
            seen = own + if self.filters_grey { seen * clear } else { seen * colour.passed() };
        }
        seen
    }
}
