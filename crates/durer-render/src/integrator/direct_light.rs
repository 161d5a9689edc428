//! Direct light: the light of the scene's lights on surfaces.

use super::layers::{Coats, Lit};
use super::record::Record;
use super::shading_point::Spot;
use super::shadow::Shadows;
use crate::lanes::Rgb8;
use crate::light::{Beamed, RenderLight};
use crate::material::{Finish, Incidence};
use crate::progress::Progress;
use crate::stats::RayCounts;
use crate::vector::dot;
use crate::world::World;
use durer_math::{F8, Isa, M8, Point3};

/// Computes the direct light on shading points.
#[derive(Default)]
pub(super) struct Lamps<'w> {
    shadows: Shadows<'w>,
    /// How the current light falls on each group of points.
    falling: Vec<Falling>,
    /// The light and its target before anything is in the way; kept for records only.
    unblocked: Vec<(Rgb8, Point3<F8>)>,
}

/// How a light falls on eight points.
#[derive(Clone, Copy)]
struct Falling {
    at: Incidence,
    /// The factor of the light's colour.
    strength: F8,
    /// The points whose way to the light can be blocked.
    blockable: M8,
}

impl<'w> Lamps<'w> {
    /// Adds the light of all lights, scattered by the layers, to the spots. If `double` is set,
    /// light from behind counts like light from the front. The rays came in `media`;
    /// `node` is their number in the record.
    pub(super) fn light(
        &mut self,
        (world, isa): (&'w World, Isa),
        (coats, double): (&Coats<'_>, bool),
        (media, node): (&[u32], u32),
        spots: &mut [Spot],
        (stop, record): (&Progress<'_>, &mut Option<Box<Record>>),
        counts: &mut RayCounts,
    ) {
        let behind = double || coats.finishes.iter().any(|f| f.lit_from_behind());
        for (number, lamp) in world.lamps.iter().enumerate() {
            if stop.is_cancelled() {
                return;
            }
            // The steps are small, and each leaves its results in memory: in large steps the
            // compiler mixes the lanes.
            self.fall(isa, lamp, (double, behind), spots);
            for (k, finish) in coats.finishes.iter().enumerate() {
                self.scatter(isa, finish, coats.lit(k));
                if finish.shines() && !lamp.shadowless {
                    self.highlight(isa, finish, coats.lit(k), spots);
                }
            }
            self.aim(isa, lamp, spots);
            if record.is_some() {
                self.unblocked.clear();
                let places = self.shadows.places(spots.len());
                self.unblocked.extend(places.map(|to| (*to.light, *to.target)));
            }
            self.shadows.cast((world, isa), lamp.end.as_ref(), media, stop, counts);
            if let Some(record) = record {
                record.light(node, number, spots, &self.unblocked, self.shadows.light());
            }
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

    /// Computes how a light falls on spots, before anything is scattered.
    fn fall(&mut self, isa: Isa, lamp: &RenderLight, (double, behind): (bool, bool), spots: &[Spot]) {
        let falling = &mut self.falling;
        falling.clear();
        let places = self.shadows.places(spots.len());
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (spot, to) in spots.iter().zip(places) {
                    let Beamed { lit, to_light, strength, target, blockable } =
                        lamp.at(spot.hits.p, spot.live);
                    let cosine = dot(to_light, spot.view.normal);
                    let lit = if behind { lit } else { lit & !cosine.le(F8::ZERO) };
                    let live = lit & !strength.equals(F8::ZERO);
                    let at = Incidence { live, to_light, cosine, double };
                    falling.push(Falling { at, strength, blockable });
                    (*to.light, *to.target) = (Rgb8::BLACK, target);
                }
            },
        );
    }

    /// Computes the part that a layer scatters.
    fn scatter(&mut self, isa: Isa, finish: &Finish, lit: &[Lit]) {
        let (falling, places) = (&self.falling, self.shadows.places(lit.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((Falling { at, .. }, lit), to) in falling.iter().zip(lit).zip(places) {
                    *to.light += lit.scattered * finish.scattered(at, lit.grain);
                }
            },
        );
    }

    /// Adds the highlights of a layer; on both sides if light from behind counts like light from
    /// the front.
    fn highlight(&mut self, isa: Isa, finish: &Finish, lit: &[Lit], spots: &[Spot]) {
        let (falling, places) = (&self.falling, self.shadows.places(lit.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (((Falling { at, .. }, lit), spot), to) in falling.iter().zip(lit).zip(spots).zip(places)
                {
                    let live = if at.double { at.live } else { at.live & (F8::ZERO).lt(at.cosine) };
                    let shine = finish.highlight(&Incidence { live, ..*at }, &spot.view, lit.colour);
                    *to.light += (lit.shine * shine).kept(live);
                }
            },
        );
    }

    /// Multiplies by the light's colour, and aims shadow rays at the light from the points that
    /// scatter any.
    fn aim(&mut self, isa: Isa, lamp: &RenderLight, spots: &[Spot]) {
        let (falling, places) = (&self.falling, self.shadows.places(spots.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((Falling { at, strength, blockable }, spot), to) in falling.iter().zip(spots).zip(places)
                {
                    let needed = at.live & !to.light.is_black();
                    *to.light = (Rgb8::splat(lamp.colour) * *strength * *to.light).kept(needed);
                    let rays = to.rays;
                    rays.live = needed & *blockable;
                    if rays.live.any() {
                        let (origin, back) = spot.hits.start_towards(*to.target - spot.hits.p);
                        (rays.origin, rays.direction) = (origin, *to.target - origin);
                        (rays.t_max, rays.source) = (F8::ONE, spot.hits.sources(back));
                    }
                }
            },
        );
    }
}
