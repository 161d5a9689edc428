//! Direct light: the light of the scene's lights on surfaces.

use super::layers::{Coats, Lit};
use super::record::Record;
use super::shading_point::Spot;
use super::shadow::{Shade, Shadows};
use crate::lanes::Rgb8;
use crate::light::{Area, Beamed, Divides, RenderLight};
use crate::material::{Finish, Incidence, View};
use crate::progress::Progress;
use crate::stats::RayCounts;
use crate::vector::dot;
use crate::world::{Look, World};
use durer_math::{F8, Isa, M8, Point3, Vec3};

/// Computes the direct light on shading points.
#[derive(Default)]
pub(super) struct Lamps<'w> {
    shadows: Shadows<'w>,
    /// How the current light falls on each group of points.
    falling: Vec<Falling>,
    /// The light before shadows, and its target; kept for records only.
    unblocked: Vec<(Rgb8, Point3<F8>)>,
}

/// The views of a layer with perturbed normals, and of the unperturbed surface.
type Bent<'a> = (&'a [View], &'a [View]);

/// How a light falls on eight points.
#[derive(Clone, Copy)]
struct Falling {
    at: Incidence,
    /// The points that the light can reach according to its beam and the unperturbed surface.
    lit: M8,
    /// The factor of the light's colour.
    strength: F8,
    /// The points whose light objects can block.
    blockable: M8,
}

/// The lit layers; whether light falls on both sides of the surface; and whether it falls on the
/// side away from the eye.
type LitCoats<'a, 'c> = (&'a Coats<'c>, (bool, bool));

impl<'w> Lamps<'w> {
    /// Adds the light of all lights that light surfaces with this look, scattered by the layers, to
    /// the spots. The rays came in `media`; `node` is their number in the record.
    pub(super) fn light(
        &mut self,
        (world, isa): (&'w World, Isa),
        (coats, look): (&Coats<'_>, &Look),
        (media, node): (&[u32], u32),
        spots: &mut [Spot],
        (stop, record): (&Progress<'_>, &mut Option<Box<Record>>),
        counts: &mut RayCounts,
    ) {
        let double = look.double_illuminate;
        let behind = double || coats.finishes.iter().any(|f| f.lit_from_behind());
        for (number, lamp) in world.lamps.iter().enumerate() {
            if stop.is_cancelled() {
                return;
            }
            if !world.lights(number, look) {
                continue;
            }
            if let Some(area) = lamp.area.as_ref().filter(|_| lamp.illuminates) {
                let how = ((world, isa), (coats, (double, behind)), media);
                self.light_from_all(how, (lamp, area), spots, stop, counts);
                if let Some(record) = record {
                    record.light(node, number, spots, &self.unblocked, self.shadows.light());
                }
                self.collect(isa, spots);
                continue;
            }
            // The steps are small, and each leaves its results in memory: in large steps the
            // compiler mixes the lanes.
            self.fall(isa, lamp, None, (double, behind), spots);
            self.shine(isa, lamp, None, (coats, behind), spots);
            self.aim(isa, lamp, spots);
            if record.is_some() {
                self.unblocked.clear();
                let places = self.shadows.places(spots.len());
                self.unblocked.extend(places.map(|to| (*to.light, *to.target)));
            }
            match &lamp.area {
                None => {
                    if let Some(through) = &lamp.through {
                        self.shadows.project(&through.geometry, lamp.shadowless);
                    }
                    self.shadows.cast((world, isa), lamp.end.as_ref(), media, stop, counts);
                }
                Some(area) => self.soften((world, isa), (lamp, area), media, spots, stop, counts),
            }
            if let Some(record) = record {
                record.light(node, number, spots, &self.unblocked, self.shadows.light());
            }
            self.collect(isa, spots);
        }
    }

    /// Computes the light that all layers scatter from a light at the shading points, without its
    /// colour. For one point of an area light `to_middle` has the directions to the light's
    /// location.
    fn shine(
        &mut self,
        isa: Isa,
        lamp: &RenderLight,
        to_middle: Option<&[Vec3<F8>]>,
        (coats, behind): (&Coats<'_>, bool),
        spots: &[Spot],
    ) {
        for (k, finish) in coats.finishes.iter().enumerate() {
            if let Some((views, _)) = coats.bent(k) {
                self.turn(views, behind);
            }
            let before: Vec<Rgb8> = match finish.irid {
                Some(_) => self.shadows.places(spots.len()).map(|to| *to.light).collect(),
                None => Vec::new(),
            };
            self.scatter(isa, finish, coats.lit(k));
            if finish.shines() && !lamp.shadowless {
                self.highlight(isa, finish, (coats.lit(k), coats.bent(k)), spots);
            }
            if finish.irid.is_some() {
                self.iridesce(finish, (&before, to_middle), coats.bent(k), spots);
            }
        }
    }

    /// Computes the light of an area light that lights surfaces from all its points: the mean of
    /// their light, in the shadows of any area light (a fact of the scene language).
    fn light_from_all(
        &mut self,
        ((world, isa), how, media): ((&'w World, Isa), LitCoats<'_, '_>, &[u32]),
        (lamp, area): (&RenderLight, &Area),
        spots: &mut [Spot],
        stop: &Progress<'_>,
        counts: &mut RayCounts,
    ) {
        let mut sums = vec![Rgb8::BLACK; spots.len()];
        let weight = F8::splat(1.0 / area.len() as f64);
        let to_middle: Vec<_> = spots.iter().map(|spot| lamp.at(spot.hits.p, spot.live).to_light).collect();
        for number in 0..area.len() {
            self.fall(isa, lamp, Some((area, number)), how.1, spots);
            self.shine(isa, lamp, Some(&to_middle), (how.0, how.1.1), spots);
            self.aim(isa, lamp, spots);
            for (sum, light) in sums.iter_mut().zip(self.shadows.light()) {
                *sum += *light * weight;
            }
        }
        self.fall(isa, lamp, None, how.1, spots);
        // Outside the beam of the light's middle, too, the light of its points can be blocked.
        if !lamp.shadowless || lamp.through.is_some() {
            self.falling.iter_mut().for_each(|falling| falling.blockable = M8::ALL);
        }
        self.unblocked.clear();
        let places = self.shadows.places(spots.len());
        for (((to, light), falling), spot) in places.zip(sums).zip(&self.falling).zip(&*spots) {
            self.unblocked.push((light, *to.target));
            *to.light = light;
            send(to, spot, !light.is_black() & spot.live & falling.blockable);
        }
        self.soften((world, isa), (lamp, area), media, spots, stop, counts);
    }

    /// Adds the current light's contributions to the shading points.
    fn collect(&self, isa: Isa, spots: &mut [Spot]) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (spot, light) in spots.iter_mut().zip(self.shadows.light()) {
                    spot.sum += *light;
                }
            },
        );
    }

    /// Reduces the light by the shadows of the points of an area light.
    fn soften(
        &mut self,
        (world, isa): (&'w World, Isa),
        (lamp, area): (&RenderLight, &Area),
        media: &[u32],
        spots: &[Spot],
        stop: &Progress<'_>,
        counts: &mut RayCounts,
    ) {
        let full: Vec<Rgb8> = self.shadows.light().to_vec();
        let (rays, _) = self.shadows.rays_mut();
        let needed: Vec<M8> = rays.iter().map(|rays| rays.live).collect();
        // The light of one point of the area in its shadows.
        let mut shaded = |lamps: &mut Self, number: usize, needed: &[M8]| {
            lamps.shadows.light_mut().copy_from_slice(&full);
            let (rays, targets) = lamps.shadows.rays_mut();
            for (i, (rays, target)) in rays.iter_mut().zip(&mut *targets).enumerate() {
                rays.live = needed[i];
                if !rays.live.any() {
                    continue;
                }
                let (to, way, blockable) =
                    lamp.target((area, number), spots[i].hits.p, lamps.falling[i].at.to_light);
                (*target, rays.live) = (to, rays.live & blockable);
                let (origin, back) = spots[i].hits.start_towards(way);
                let direction = if lamp.parallel { way } else { *target - origin };
                (rays.origin, rays.direction) = (origin, direction);
                (rays.t_max, rays.source) = (F8::ONE, spots[i].hits.sources(back));
            }
            if let Some(through) = &lamp.through {
                lamps.shadows.project(&through.geometry, lamp.shadowless);
            }
            lamps.shadows.cast((world, isa), None, media, stop, counts);
        };
        let sums = if area.parts().is_empty() {
            let mut sums = vec![Rgb8::BLACK; full.len()];
            for number in 0..area.len() {
                shaded(self, number, &needed);
                let weight = F8::splat(area.weight(number));
                for ((sum, light), needed) in sums.iter_mut().zip(self.shadows.light()).zip(&needed) {
                    *sum += light.kept(*needed) * weight;
                }
            }
            sums
        } else {
            self.soften_adaptively(area, &full, &needed, &mut shaded)
        };
        let blockable: Vec<M8> = self.falling.iter().map(|falling| falling.blockable).collect();
        for (i, light) in self.shadows.light_mut().iter_mut().enumerate() {
            *light = sums[i].or(blockable[i] & !full[i].is_black(), full[i]);
        }
    }

    /// The light of an adaptive area light. Parts of its grid are divided only where the shadows of
    /// their corners differ. `shaded` computes the light of one point of the area.
    fn soften_adaptively(
        &mut self,
        area: &Area,
        full: &[Rgb8],
        needed: &[M8],
        shaded: &mut impl FnMut(&mut Self, usize, &[M8]),
    ) -> Vec<Rgb8> {
        let parts = area.parts();
        let depths = parts.iter().map(|part| part.depth + 1).max().unwrap_or(0);
        let mut sums = vec![Rgb8::BLACK; full.len()];
        // The lanes that examine the parts of each depth.
        let mut looking = vec![vec![M8::NONE; full.len()]; depths + 1];
        looking[0].copy_from_slice(needed);
        // For each point of the area, the lanes for which its light is computed, and that light.
        let mut known: Vec<Vec<(M8, Rgb8)>> = vec![Vec::new(); area.len()];
        let mut missing = vec![M8::NONE; full.len()];
        let mut number = 0;
        while let Some(part) = parts.get(number) {
            let (above, below) = looking.split_at_mut(part.depth + 1);
            let (looks, divided) = (&above[part.depth], &mut below[0]);
            if part.divides == Divides::Always {
                divided.copy_from_slice(looks);
                number += 1;
                continue;
            }
            if !looks.iter().any(|lanes| lanes.any()) {
                number = part.next;
                continue;
            }
            for corner in part.corners {
                let known = &mut known[corner];
                known.resize(full.len(), (M8::NONE, Rgb8::BLACK));
                for ((missing, looks), (have, _)) in missing.iter_mut().zip(looks).zip(&*known) {
                    *missing = *looks & !*have;
                }
                if !missing.iter().any(|missing| missing.any()) {
                    continue;
                }
                shaded(self, corner, &missing);
                for ((missing, light), (have, kept)) in
                    missing.iter().zip(self.shadows.light()).zip(&mut *known)
                {
                    (*have, *kept) = (*have | *missing, light.or(*missing, *kept));
                }
            }
            for (i, looks) in looks.iter().enumerate() {
                let corners = part.corners.map(|corner| known[corner][i].1);
                let brightness = corners.map(Rgb8::luminance);
                let most = brightness.into_iter().reduce(F8::max).unwrap_or(F8::ZERO);
                let least = brightness.into_iter().reduce(F8::min).unwrap_or(F8::ZERO);
                // The language compares the shadows of corners with this bound.
                let differ = (full[i].luminance() * 0.1).lt(most - least);
                divided[i] = if part.divides == Divides::Never { M8::NONE } else { *looks & differ };
                for corner in corners {
                    sums[i] += corner.kept(*looks & !divided[i]) * F8::splat(part.weight);
                }
            }
            number = if divided.iter().any(|lanes| lanes.any()) { number + 1 } else { part.next };
        }
        sums
    }

    /// Computes how a light, or one point of its area, falls on the shading points, before
    /// scattering.
    fn fall(
        &mut self,
        isa: Isa,
        lamp: &RenderLight,
        point: Option<(&Area, usize)>,
        (double, behind): (bool, bool),
        spots: &[Spot],
    ) {
        let falling = &mut self.falling;
        falling.clear();
        let places = self.shadows.places(spots.len());
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (spot, to) in spots.iter().zip(places) {
                    let beamed = match point {
                        None => lamp.at(spot.hits.p, spot.live),
                        Some((area, number)) => lamp.at_from_point(area, number, spot.hits.p, spot.live),
                    };
                    let Beamed { lit, to_light, strength, target, blockable } = beamed;
                    let cosine = dot(to_light, spot.view.normal);
                    let lit = lit & !strength.equals(F8::ZERO);
                    let live = if behind { lit } else { lit & !cosine.le(F8::ZERO) };
                    let at = Incidence { live, to_light, cosine, double };
                    falling.push(Falling { at, lit, strength, blockable });
                    (*to.light, *to.target) = (Rgb8::BLACK, target);
                }
            },
        );
    }

    /// Computes how the light falls on the perturbed surface of a layer. Light from behind the
    /// unperturbed surface counts if nothing blocks it (a fact of the scene language).
    fn turn(&mut self, views: &[View], behind: bool) {
        for (falling, view) in self.falling.iter_mut().zip(views) {
            let at = &mut falling.at;
            at.cosine = dot(at.to_light, view.normal);
            at.live = falling.lit & (M8::splat(behind) | !at.cosine.le(F8::ZERO));
        }
    }

    /// Computes the light that a layer scatters.
    fn scatter(&mut self, isa: Isa, finish: &Finish, lit: &[Lit]) {
        let (falling, places) = (&self.falling, self.shadows.places(lit.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((Falling { at, .. }, lit), to) in falling.iter().zip(lit).zip(places) {
                    *to.light += (lit.scattered * finish.scattered(at, lit.grain)).kept(at.live);
                }
            },
        );
    }

    /// Adds the highlights of a layer; on both sides if light from behind counts like light from
    /// the front.
    fn highlight(
        &mut self,
        isa: Isa,
        finish: &Finish,
        (lit, bent): (&[Lit], Option<Bent<'_>>),
        spots: &[Spot],
    ) {
        let (falling, places) = (&self.falling, self.shadows.places(lit.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for (i, (((Falling { at, .. }, lit), spot), to)) in
                    falling.iter().zip(lit).zip(spots).zip(places).enumerate()
                {
                    let view = bent.map_or(&spot.view, |(views, _)| &views[i]);
                    let live = if at.double { at.live } else { at.live & (F8::ZERO).lt(at.cosine) };
                    let shine = finish.highlight(&Incidence { live, ..*at }, view, lit.colour);
                    *to.light += (lit.shine * shine).kept(live);
                }
            },
        );
    }

    /// Multiplies the light that a layer added by the interference of a thin film. For an area
    /// light the film uses the light's location, not its points (a fact of the scene language).
    fn iridesce(
        &mut self,
        finish: &Finish,
        (before, to_middle): (&[Rgb8], Option<&[Vec3<F8>]>),
        bent: Option<Bent<'_>>,
        spots: &[Spot],
    ) {
        let (falling, places) = (&self.falling, self.shadows.places(spots.len()));
        for (i, ((Falling { at, .. }, to), before)) in falling.iter().zip(places).zip(before).enumerate() {
            let view = bent.map_or(&spots[i].view, |(views, _)| &views[i]);
            let mut light = *to.light;
            let cosine = to_middle.map_or(at.cosine, |to_middle| dot(to_middle[i], view.normal));
            let way = cosine.abs() + view.cosine.abs();
            let factor = finish.interference(spots[i].hits.p, way, at.live);
            for lane in at.live.lanes() {
                let (old, new) = (before.lane(lane), light.lane(lane));
                light.set_lane(lane, old + (new + old * -1.0) * factor.lane(lane));
            }
            *to.light = light;
        }
    }

    /// Multiplies by the light's colour, and aims shadow rays at the light from the points that
    /// scatter any.
    fn aim(&mut self, isa: Isa, lamp: &RenderLight, spots: &[Spot]) {
        let (falling, places) = (&self.falling, self.shadows.places(spots.len()));
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((Falling { lit, strength, blockable, .. }, spot), to) in
                    falling.iter().zip(spots).zip(places)
                {
                    let needed = *lit & !to.light.is_black();
                    *to.light = (Rgb8::splat(lamp.colour) * *strength * *to.light).kept(needed);
                    send(to, spot, needed & *blockable);
                }
            },
        );
    }
}

/// Aims shadow rays from a shading point at the target.
#[inline(always)]
fn send(to: Shade<'_>, spot: &Spot, live: M8) {
    let rays = to.rays;
    rays.live = live;
    if live.any() {
        let (origin, back) = spot.hits.start_towards(*to.target - spot.hits.p);
        (rays.origin, rays.direction) = (origin, *to.target - origin);
        (rays.t_max, rays.source) = (F8::ONE, spot.hits.sources(back));
    }
}
