//! Layers of paint, worked through from the outermost.
//!
//! Each adds its own light, times what the layers above let pass; what all of them let pass is seen behind the surface. Reflections of all
//! layers are added as they are.

use super::media::Border;
use super::spot::Spot;
use crate::lanes::Rgb8;
use crate::material::{Finish, Mirror};
use crate::sampler::random;
use crate::texture::Coat;
use crate::world::World;
use durer_math::{F8, Isa};

/// What the layers of some spots leave to be done.
#[derive(Default)]
pub(super) struct Coats<'w> {
    /// The finishes of layers that light changes, the outermost first.
    pub(super) finishes: Vec<&'w Finish>,
    /// The same layers at each spot, all of the first spot first.
    lit: Vec<Lit>,
    /// The mirrors of layers that reflect.
    pub(super) mirrors: Vec<&'w Mirror>,
    /// The same layers at each spot.
    mirrored: Vec<Mirrored>,
}

/// A layer that light changes, at a spot.
#[derive(Clone, Copy)]
pub(super) struct Lit {
    /// What scattered light is multiplied by.
    pub(super) scattered: Rgb8,
    /// What highlights are multiplied by.
    pub(super) shine: Rgb8,
    /// The paint's colour.
    pub(super) colour: Rgb8,
    pub(super) grain: F8,
}

/// A layer that reflects, at a spot.
#[derive(Clone, Copy)]
pub(super) struct Mirrored {
    /// Black where there is nothing to be seen.
    pub(super) reflectance: Rgb8,
    /// How much it counts: the greatest channel, dimmed by the layers above (which do not dim what is seen).
    pub(super) importance: F8,
}

impl<'w> Coats<'w> {
    /// Lays the layers, the innermost first, on the spots. `draws` is how many random numbers were drawn before.
    pub(super) fn lay(
        &mut self,
        (world, isa): (&'w World, Isa),
        layers: &'w [Coat],
        border: &Border,
        draws: u32,
        spots: &mut [Spot],
    ) {
        let finishes = || layers.iter().rev().map(|coat| &coat.finish);
        self.finishes.clear();
        self.finishes.extend(finishes().filter(|f| f.is_lit));
        self.mirrors.clear();
        self.mirrors.extend(finishes().filter_map(|f| f.mirror.as_deref()));
        self.lit.clear();
        self.mirrored.clear();
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for spot in spots {
                    self.lay_on(world, layers, border, draws, spot);
                }
            },
        );
    }

    #[inline(always)]
    fn lay_on(&mut self, world: &World, layers: &[Coat], border: &Border, mut draws: u32, spot: &mut Spot) {
        let mut live = spot.live;
        let mut passed = Rgb8::WHITE;
        let mut sum = Rgb8::BLACK;
        for coat in layers.iter().rev() {
            live &= !passed.luminance().le(F8::splat(world.adc_bailout));
            let paint = coat.pigment.colours(spot.inside, live);
            let finish = &coat.finish;
            let colour = paint.rgb;
            let filtering =
                if world.filter_by_colour { paint.filter * colour.greatest() } else { paint.filter };
            let body = (passed * colour * (F8::ONE - filtering - paint.transmit)).kept(live);
            sum += (body * Rgb8::splat(finish.own_light)).kept(live);
            if finish.is_lit {
                let mut grain = F8::ZERO;
                if finish.crand > 0.0 {
                    draws += 1;
                    for i in live.lanes() {
                        grain.0[i] = random(spot.paths.seed[i], u64::from(draws), 2) * finish.crand;
                    }
                }
                self.lit.push(Lit { scattered: body, shine: passed.kept(live), colour, grain });
            }
            let mut left = passed * paint.passed();
            if let Some(mirror) = finish.mirror.as_deref() {
                let cosine = spot.view.cosine;
                let fresnel = if mirror.fresnel { border.fresnel(cosine) } else { F8::ZERO };
                let reflectance = mirror.reflectance(cosine, colour, live, fresnel).kept(live);
                let importance = passed.luminance() * reflectance.greatest();
                self.mirrored.push(Mirrored { reflectance, importance });
                if finish.conserve_energy {
                    left = left
                        * reflectance.map(
                            #[inline(always)]
                            |r| F8::ONE - r.min(F8::ONE),
                        );
                }
            }
            passed = left.or(live, passed);
        }
        (spot.sum, spot.passed) = (sum, passed);
    }

    /// The layers at spot `i` that light changes, with their finishes.
    #[inline(always)]
    pub(super) fn lit_at(&self, i: usize) -> impl Iterator<Item = (&'w Finish, &Lit)> {
        let count = self.finishes.len();
        self.finishes.iter().copied().zip(&self.lit[i * count..(i + 1) * count])
    }

    /// The `k`th layer that reflects, at spot `i`.
    #[inline(always)]
    pub(super) fn mirrored_at(&self, i: usize, k: usize) -> &Mirrored {
        &self.mirrored[i * self.mirrors.len() + k]
    }
}

/// How many random numbers layers draw.
pub(super) fn draws(layers: &[Coat]) -> u32 {
    layers.iter().filter(|coat| coat.finish.is_lit && coat.finish.crand > 0.0).count() as u32
}
