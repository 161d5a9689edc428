//! The light of lamps on surfaces.

use super::coats::Coats;
use super::shadow::{Shade, Shadows};
use super::spot::Spot;
use crate::lanes::Rgb8;
use crate::light::Lamp;
use crate::material::Incidence;
use crate::progress::Progress;
use crate::stats::RayCounts;
use crate::vector::dot;
use crate::world::World;
use durer_geometry::Rays8;
use durer_math::{F8, Isa, M8};

/// Lights some spots.
#[derive(Default)]
pub(super) struct Lamps<'w> {
    shadows: Shadows<'w>,
}

impl<'w> Lamps<'w> {
    /// Adds the light of all lamps on layers to the spots. `double` tells that light from behind counts like light from the front; the rays
    /// came in `media`.
    pub(super) fn light(
        &mut self,
        (world, isa): (&'w World, Isa),
        (coats, double): (&Coats<'_>, bool),
        media: &[u32],
        spots: &mut [Spot],
        stop: &Progress<'_>,
        counts: &mut RayCounts,
    ) {
        let behind = double || coats.finishes.iter().any(|f| f.lit_from_behind());
        for lamp in &world.lamps {
            if stop.is_cancelled() {
                return;
            }
            self.shadows.clear();
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for (i, spot) in spots.iter().enumerate() {
                        let shade = shine(lamp, coats, i, spot, (double, behind));
                        self.shadows.push(shade);
                    }
                },
            );
            self.shadows.cast((world, isa), media, stop, counts);
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for (spot, light) in spots.iter_mut().zip(self.shadows.light()) {
                        spot.sum += *light;
                    }
                },
            );
        }
    }
}

/// What a lamp adds to a spot if nothing is between, and the rays that look for it.
#[inline(always)]
fn shine(lamp: &Lamp, coats: &Coats<'_>, i: usize, spot: &Spot, (double, behind): (bool, bool)) -> Shade {
    let beamed = lamp.at(spot.hits.p, spot.live);
    let cosine = dot(beamed.to_light, spot.view.normal);
    let lit = if behind { beamed.lit } else { beamed.lit & !cosine.le(F8::ZERO) };
    let lit = lit & !beamed.strength.eq(F8::ZERO);
    if !lit.any() {
        return Shade::NONE;
    }
    let highlit = match (lamp.shadowless, double) {
        (true, _) => M8::NONE,
        (false, true) => lit,
        (false, false) => lit & (F8::ZERO).lt(cosine),
    };
    let at = Incidence { live: lit, to_light: beamed.to_light, cosine, double };
    let shiny = Incidence { live: highlit, ..at };
    let mut shown = Rgb8::BLACK;
    for (finish, coat) in coats.lit_at(i) {
        shown += coat.scattered * finish.scattered(&at, coat.grain);
        if finish.shines() && !lamp.shadowless {
            let shine = finish.highlight(&shiny, &spot.view, coat.colour);
            shown += (coat.shine * shine).kept(highlit);
        }
    }
    let needed = lit & !shown.is_black();
    let light = (Rgb8::splat(lamp.colour) * beamed.strength * shown).kept(needed);
    let (origin, back) = spot.hits.start_towards(beamed.target - spot.hits.p);
    let rays = Rays8 {
        origin,
        direction: beamed.target - origin,
        t_max: F8::ONE,
        live: needed & beamed.blockable,
        source: spot.hits.sources(back),
    };
    Shade { light, rays, target: beamed.target }
}
