//! The layers of a texture, shaded from the outermost inwards.
//!
//! Each layer adds its own light, times the transmittance of the layers above it. The transmittance
//! of all layers is the factor of the light from behind the surface. Reflections of all layers are
//! added without that factor.
//!
//! Negative `filter` and `transmit` extrapolate: they subtract light from behind. So wherever the
//! transmitted light is compared with `adc_bailout`, magnitudes are compared (a fact of the scene
//! language).

use super::media::Interface;
use super::secondary::{mirrored, way_through_film};
use super::shading_point::Spot;
use crate::lanes::{Colour8, Rgb8};
use crate::material::{Finish, Mirror, View};
use crate::sampler::random;
use crate::texture::{Around8, RenderLayer};
use crate::vector::dot;
use crate::world::World;
use durer_math::{F8, Isa, M8, Vec3};
use durer_scene::Colour;

/// The data for the remaining steps after the layers of some points were applied: direct light and
/// reflections.
#[derive(Default)]
pub(super) struct Coats<'w> {
    /// The finishes of layers that scatter or mirror light of the scene's lights, the outermost
    /// first.
    pub(super) finishes: Vec<&'w Finish>,
    /// The data of these layers at each spot: first all spots of the first layer, then those of the
    /// second, and so on.
    lit: Vec<Lit>,
    /// The mirrors of layers that reflect, the outermost first.
    pub(super) mirrors: Vec<&'w Mirror>,
    /// The data of these layers at each spot, in the same order.
    mirrored: Vec<Mirrored>,
    /// The views of layers that scatter or reflect, in the same orders; empty if no layer has
    /// perturbed normals.
    lit_views: Vec<View>,
    mirror_views: Vec<View>,
    /// The views of the unperturbed surface; empty likewise.
    plain: Vec<View>,
    /// The normals of the outermost layer; for bumpy surfaces only.
    top_normals: Vec<Vec3<F8>>,
    /// The finish of the outermost layer, if it has a thin film.
    pub(super) film: Option<&'w Finish>,
    /// The number of spots.
    spots: usize,
    /// The lanes of each point in which the current layer is visible.
    live: Vec<M8>,
    /// The pigment's colour there.
    paint: Vec<Colour8>,
}

/// A layer that scatters light, at a spot.
#[derive(Clone, Copy)]
pub(super) struct Lit {
    /// The factor of scattered light.
    pub(super) scattered: Rgb8,
    /// The factor of highlights.
    pub(super) shine: Rgb8,
    /// The pigment's colour.
    pub(super) colour: Rgb8,
    pub(super) grain: F8,
}

/// A layer that reflects, at a spot.
#[derive(Clone, Copy)]
pub(super) struct Mirrored {
    /// The factor of the reflected colour; black where nothing is reflected.
    pub(super) reflectance: Rgb8,
    /// The weight of the reflected ray, reduced by the layers above. They do not reduce the
    /// reflected colour itself.
    pub(super) importance: F8,
}

impl<'w> Coats<'w> {
    /// Applies the layers, given innermost first, to the spots. `draws` is the number of random
    /// numbers drawn before.
    pub(super) fn lay(
        &mut self,
        (world, isa): (&'w World, Isa),
        layers: &'w [RenderLayer],
        border: &Interface,
        mut draws: u32,
        spots: &mut [Spot],
    ) {
        let finishes = || layers.iter().rev().map(|coat| &coat.finish);
        self.finishes.clear();
        self.finishes.extend(finishes().filter(|f| f.is_lit));
        self.mirrors.clear();
        self.mirrors.extend(finishes().filter_map(|f| f.mirror.as_deref()));
        self.film = layers.last().map(|coat| &coat.finish).filter(|finish| finish.irid.is_some());
        self.lit.clear();
        self.mirrored.clear();
        self.lit_views.clear();
        self.mirror_views.clear();
        self.plain.clear();
        self.top_normals.clear();
        let is_bumpy = layers.iter().any(|coat| coat.normal.is_some());
        if is_bumpy {
            self.plain.extend(spots.iter().map(|spot| spot.view));
        }
        self.spots = spots.len();
        self.live.resize(spots.len(), M8::NONE);
        self.paint.resize(spots.len(), Colour8::splat(Colour::default()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (live, spot) in self.live.iter_mut().zip(&mut *spots) {
                    *live = spot.live;
                    (spot.sum, spot.passed) = (Rgb8::BLACK, Rgb8::WHITE);
                }
            },
        );
        for coat in layers.iter().rev() {
            // The steps are small, and each leaves its results in memory: in large steps the
            // compiler mixes the lanes.
            let bailout = F8::splat(world.adc_bailout);
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for (live, spot) in self.live.iter_mut().zip(&*spots) {
                        *live &= !spot.passed.luminance().abs().le(bailout);
                    }
                },
            );
            if is_bumpy {
                self.bend(coat, spots);
                if self.top_normals.is_empty() {
                    self.top_normals.extend(spots.iter().map(|spot| spot.view.normal));
                }
            }
            let top_normals = &self.top_normals;
            let seen = |(i, (spot, &live)): (usize, (&Spot, &M8))| {
                // The patterns of all layers use the normals of the outermost one (a fact of the
                // scene language).
                let normals = top_normals.get(i).copied().unwrap_or(spot.view.normal);
                (spot.inside, Around8 { normals, ..spot.around() }, live)
            };
            coat.pigment.show(isa, spots.iter().zip(&self.live).enumerate().map(seen), &mut self.paint);
            self.lay_on((world, isa), &coat.finish, spots);
            if coat.finish.is_lit && coat.finish.crand > 0.0 {
                draws += 1;
                self.grind(coat.finish.crand, draws, spots);
            }
            match coat.finish.mirror.as_deref() {
                Some(mirror) => {
                    self.mirror(isa, (mirror, coat.finish.conserve_energy), border, spots);
                    if coat.finish.irid.is_some() {
                        self.iridesce((&coat.finish, mirror), spots);
                    }
                }
                None => self.pass(isa, spots),
            }
        }
        // The normals of the outermost layer refract transmitted light.
        if let Some(top) = layers.last().filter(|_| is_bumpy) {
            for ((spot, plain), live) in spots.iter_mut().zip(&self.plain).zip(&mut self.live) {
                (spot.view, *live) = (*plain, spot.live);
            }
            self.perturb(top, spots);
        }
    }

    /// Gives the spots the normals of a layer, and records their views.
    fn bend(&mut self, coat: &RenderLayer, spots: &mut [Spot]) {
        for (spot, plain) in spots.iter_mut().zip(&self.plain) {
            spot.view = *plain;
        }
        self.perturb(coat, spots);
        if coat.finish.is_lit {
            self.lit_views.extend(spots.iter().map(|spot| spot.view));
        }
        if coat.finish.mirror.is_some() {
            self.mirror_views.extend(spots.iter().map(|spot| spot.view));
        }
    }

    /// Perturbs the normals of the spots.
    fn perturb(&self, coat: &RenderLayer, spots: &mut [Spot]) {
        let Some(normal) = &coat.normal else { return };
        for (spot, &live) in spots.iter_mut().zip(&self.live) {
            let around = spot.around();
            let view = &mut spot.view;
            view.normal = normal.perturbed(spot.inside, &around, live);
            // It is negative where the perturbed normal points away from the eye.
            view.cosine = (-dot(view.normal, view.eye)).max(-F8::ONE).min(F8::ONE);
        }
    }

    /// The views of scattering layer `k`, and of the unperturbed surface, if normals are perturbed.
    pub(super) fn bent(&self, k: usize) -> Option<(&[View], &[View])> {
        let views = self.lit_views.get(k * self.spots..(k + 1) * self.spots)?;
        (!self.plain.is_empty()).then_some((views, &self.plain))
    }

    /// The view of reflecting layer `k` at spot `i`, and of the unperturbed surface, if normals are
    /// perturbed.
    #[inline(always)]
    pub(super) fn mirror_view(&self, i: usize, k: usize) -> Option<(&View, &View)> {
        self.mirror_views.get(k * self.spots + i).zip(self.plain.get(i))
    }

    /// The view of the unperturbed surface at spot `i`, if normals are perturbed.
    #[inline(always)]
    pub(super) fn plain_view(&self, i: usize) -> Option<&View> {
        self.plain.get(i)
    }

    /// Adds the layer's own light, and records what direct light needs.
    fn lay_on(&mut self, (world, isa): (&World, Isa), finish: &Finish, spots: &mut [Spot]) {
        let own_light = Rgb8::splat(finish.own_light);
        let (live, paint, lit) = (&self.live, &self.paint, &mut self.lit);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((spot, paint), &live) in spots.iter_mut().zip(paint).zip(live) {
                    let (passed, colour) = (spot.passed, paint.rgb);
                    let filtering =
                        if world.filter_by_colour { paint.filter * colour.greatest() } else { paint.filter };
                    let body = (passed * colour * (F8::ONE - filtering - paint.transmit)).kept(live);
                    spot.sum += (body * own_light).kept(live);
                    if finish.is_lit {
                        lit.push(Lit { scattered: body, shine: passed.kept(live), colour, grain: F8::ZERO });
                    }
                }
            },
        );
    }

    /// Draws the random grain of the layer that was applied last.
    fn grind(&mut self, crand: f64, draws: u32, spots: &[Spot]) {
        let first = self.lit.len() - self.spots;
        for ((lit, spot), live) in self.lit[first..].iter_mut().zip(spots).zip(&self.live) {
            for i in live.lanes() {
                lit.grain.0[i] = random(spot.paths.seed[i], u64::from(draws), 2) * crand;
            }
        }
    }

    /// Multiplies the transmittance by the layer's.
    fn pass(&self, isa: Isa, spots: &mut [Spot]) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((spot, paint), &live) in spots.iter_mut().zip(&self.paint).zip(&self.live) {
                    spot.passed = (spot.passed * paint.passed()).or(live, spot.passed);
                }
            },
        );
    }

    /// [`Coats::pass`] for a layer that reflects; also records the reflection.
    fn mirror(
        &mut self,
        isa: Isa,
        (mirror, conserve_energy): (&Mirror, bool),
        border: &Interface,
        spots: &mut [Spot],
    ) {
        let (live, paint, mirrored) = (&self.live, &self.paint, &mut self.mirrored);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((spot, paint), &live) in spots.iter_mut().zip(paint).zip(live) {
                    let (passed, cosine) = (spot.passed, spot.view.cosine);
                    let fresnel = if mirror.fresnel { border.fresnel(cosine) } else { F8::ZERO };
                    let (reflectance, counts) = mirror.reflectance(cosine, paint.rgb, live, fresnel);
                    let reflectance = reflectance.kept(live);
                    let importance = passed.luminance().abs() * counts;
                    mirrored.push(Mirrored { reflectance, importance });
                    let mut left = passed * paint.passed();
                    if conserve_energy {
                        left = left
                            * reflectance.map(
                                #[inline(always)]
                                |r| F8::ONE - r.min(F8::ONE),
                            );
                    }
                    spot.passed = left.or(live, passed);
                }
            },
        );
    }

    /// Multiplies the reflection that was recorded last by the interference of a thin film. The
    /// mirror's exponent changes the interference, too (a fact of the scene language).
    fn iridesce(&mut self, (finish, mirror): (&Finish, &Mirror), spots: &[Spot]) {
        let first = self.mirrored.len() - self.spots;
        for (i, (reflection, spot)) in self.mirrored[first..].iter_mut().zip(spots).enumerate() {
            let way = way_through_film(&spot.view, mirrored(&spot.view, self.plain.get(i)));
            let live = &self.live[i];
            let mut factor = finish.interference(spot.hits.p, way, *live);
            if !mirror.is_plain() {
                live.lanes().for_each(|i| factor.set_lane(i, mirror.shown(factor.lane(i))));
            }
            reflection.reflectance = reflection.reflectance * factor;
        }
    }

    /// The data of scattering layer `k` at each spot.
    pub(super) fn lit(&self, k: usize) -> &[Lit] {
        &self.lit[k * self.spots..(k + 1) * self.spots]
    }

    /// The data of reflecting layer `k` at spot `i`.
    #[inline(always)]
    pub(super) fn mirrored_at(&self, i: usize, k: usize) -> &Mirrored {
        &self.mirrored[k * self.spots + i]
    }
}

/// The number of random numbers that these layers draw.
pub(super) fn draws(layers: &[RenderLayer]) -> u32 {
    layers.iter().filter(|coat| coat.finish.is_lit && coat.finish.crand > 0.0).count() as u32
}
