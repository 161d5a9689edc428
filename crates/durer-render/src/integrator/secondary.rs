//! Secondary rays: rays that pass through a surface, and rays that it reflects.

use super::bundle::{Bundle, BundleState, Paths8};
use super::layers::Coats;
use super::media::{Crossing, Interface};
use super::shading_point::Spot;
use crate::lanes::Rgb8;
use crate::material::{Mirror, View, refract};
use crate::stats::RayCounts;
use crate::vector::{dot, reflect};
use crate::world::{Look, World};
use durer_geometry::Rays8;
use durer_math::{F8, Isa, M8, Vec3};
use durer_scene::mask;

/// The bundles of secondary rays that start where one bundle hits surfaces.
#[derive(Default)]
pub(super) struct Onward<'w> {
    /// The bundles with their sort key. Contributions to one sum are added in key order, so the sum
    /// does not depend on the other rays of a bundle.
    bundles: Vec<(Order, Bundle<'w>)>,
    /// Empty bundles for reuse.
    spare: Vec<Bundle<'w>>,
}

/// The number of a surface's stack of layers, and the kind of ray: through the surface, totally
/// reflected, or reflected by a numbered layer.
type Order = (u32, u32);
pub(super) const THROUGH: u32 = 0;
pub(super) const TOTAL: u32 = 1;
const FIRST_MIRROR: u32 = 2;

/// Surfaces with the same look that are hit by rays of one bundle.
pub(super) struct Part<'a, 'w> {
    pub(super) look: &'w Look,
    pub(super) border: Interface,
    /// The state of the rays that hit them.
    pub(super) standing: &'a BundleState<'w>,
}

impl<'w> Onward<'w> {
    /// Takes out the bundles. The last one is to be traced first.
    pub(super) fn take(&mut self) -> impl Iterator<Item = Bundle<'w>> {
        self.bundles.sort_by_key(|(order, _)| core::cmp::Reverse(*order));
        self.bundles.drain(..).map(|(_, bundle)| bundle)
    }

    /// An empty bundle.
    pub(super) fn empty(&mut self) -> Bundle<'w> {
        self.spare.pop().unwrap_or_else(Bundle::new)
    }

    /// Returns a bundle for reuse.
    pub(super) fn give_back(&mut self, mut bundle: Bundle<'w>) {
        bundle.clear();
        self.spare.push(bundle);
    }

    /// Finds or makes the bundle for rays with the given key and state.
    fn bundle(
        &mut self,
        order: Order,
        standing: &BundleState<'w>,
        (level, mask, draws): (u32, u32, u32),
        mirror: Option<&'w Mirror>,
        media: &[u32],
    ) -> &mut Bundle<'w> {
        let depth = standing.depth + 1;
        let is_it = |(o, b): &(Order, Bundle<'w>)| {
            let s = &b.standing;
            *o == order
                && (s.level, s.depth, s.mask, s.draws) == (level, depth, mask, draws)
                && s.mirror.map(core::ptr::from_ref) == mirror.map(core::ptr::from_ref)
                && s.media.iter().eq(media)
        };
        let at = self.bundles.iter().position(is_it).unwrap_or_else(|| {
            let mut bundle = self.empty();
            let s = &mut bundle.standing;
            (s.level, s.depth, s.mask, s.draws, s.mirror) = (level, depth, mask, draws, mirror);
            (s.node, s.kind) = (standing.node, order.1);
            s.media.clear();
            s.media.extend_from_slice(media);
            self.bundles.push((order, bundle));
            self.bundles.len() - 1
        });
        &mut self.bundles[at].1
    }

    /// Starts secondary rays at some spots. `stack` is the number of their stack of layers among
    /// those of the surface; `drawn` is the number of random numbers that the stack drew.
    pub(super) fn send(
        &mut self,
        (world, isa): (&'w World, Isa),
        part: &Part<'_, 'w>,
        coats: &Coats<'w>,
        (stack, drawn): (u32, u32),
        spots: &[Spot],
        counts: &mut RayCounts,
    ) {
        let Part { look, border, standing } = part;
        let draws = standing.draws + drawn;
        if standing.level >= world.max_level {
            return;
        }
        if spots.iter().any(|spot| open(world, spot).any()) {
            let bends = border.ratio != 1.0;
            let mut media = Vec::new();
            border.crossing.behind(look.medium, &standing.media, &mut media);
            let as_before = (standing.level + u32::from(bends), standing.mask, draws);
            let through = self.bundle((stack, THROUGH), standing, as_before, None, &media);
            let refraction = F8::splat(world.media[look.medium as usize].refraction);
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for spot in spots {
                        let (direction, lanes) = passing(world, border, spot);
                        let (weight, counts_for_enough) = dimmed(world, spot);
                        let lanes = lanes & counts_for_enough;
                        let factor = spot.paths.factor * spot.passed * faded(world, part, spot) * refraction;
                        send(through, spot, direction, weight, factor, lanes, &mut counts.transmitted);
                    }
                },
            );
            if bends {
                let as_mirror = (standing.level + 1, mask::MIRROR, draws);
                let total = self.bundle((stack, TOTAL), standing, as_mirror, None, &standing.media);
                isa.run_in_lanes(
                    #[inline(always)]
                    || {
                        for (i, spot) in spots.iter().enumerate() {
                            let (weight, counts_for_enough) = dimmed(world, spot);
                            let lanes = totally_reflected(world, border, spot) & counts_for_enough;
                            if lanes.any() {
                                // Nothing passes, so the factor does not contain the layers'
                                // colour. The ray's weight is still that of a ray that passes. The
                                // outermost layer's film changes it (facts of the scene language).
                                let mut factor = spot.paths.factor * faded(world, part, spot) * refraction;
                                let direction = mirrored(&spot.view, coats.plain_view(i));
                                if let Some(film) = coats.film {
                                    let way = way_through_film(&spot.view, direction);
                                    factor = factor * film.interference(spot.hits.p, way, lanes);
                                }
                                send(total, spot, direction, weight, factor, lanes, &mut counts.reflected);
                            }
                        }
                    },
                );
            }
        }
        for (k, mirror) in coats.mirrors.iter().enumerate() {
            let as_mirror = (standing.level + 1, mask::MIRROR, draws);
            let shown = (!mirror.is_plain()).then_some(*mirror);
            let order = (stack, FIRST_MIRROR + k as u32);
            let reflected = self.bundle(order, standing, as_mirror, shown, &standing.media);
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for (i, spot) in spots.iter().enumerate() {
                        let layer = coats.mirrored_at(i, k);
                        let weight = spot.paths.weight * layer.importance;
                        let lanes = spot.live
                            & !layer.reflectance.is_black()
                            & !weight.lt(F8::splat(world.adc_bailout))
                            & !totally_reflected(world, border, spot);
                        if lanes.any() {
                            let factor = spot.paths.factor * layer.reflectance;
                            let direction = match coats.mirror_view(i, k) {
                                Some((view, plain)) => mirrored(view, Some(plain)),
                                None => mirrored(&spot.view, None),
                            };
                            send(reflected, spot, direction, weight, factor, lanes, &mut counts.reflected);
                        }
                    }
                },
            );
        }
    }
}

/// The direction of mirror reflection. Where the normal is perturbed, a direction into the surface
/// is mirrored again, by the unperturbed normal; if the perturbed normal points away from the eye,
/// only the unperturbed one is used then (facts of the scene language).
#[inline(always)]
pub(super) fn mirrored(view: &View, plain: Option<&View>) -> Vec3<F8> {
    let direction = reflect(view.eye, view.normal);
    let Some(plain) = plain else { return direction };
    let enters = dot(direction, plain.normal).lt(F8::ZERO);
    let turned_away = F8::ZERO.lt(dot(view.eye, view.normal));
    let again = reflect(turned_away.select3(view.eye, direction), plain.normal);
    enters.select3(again, direction)
}

/// The sum of the cosines of the angles of incidence and reflection of mirrored light at a thin
/// film.
#[inline(always)]
pub(super) fn way_through_film(view: &View, direction: Vec3<F8>) -> F8 {
    view.cosine.abs() + dot(direction, view.normal).abs()
}

/// The lanes where the layers let enough light pass for a ray behind them.
#[inline(always)]
fn open(world: &World, spot: &Spot) -> M8 {
    spot.live & !spot.passed.luminance().abs().le(F8::splat(world.adc_bailout))
}

/// The weights of rays behind the layers, and the lanes where the weight is large enough.
#[inline(always)]
fn dimmed(world: &World, spot: &Spot) -> (F8, M8) {
    let weight = spot.paths.weight * spot.passed.greatest_magnitude();
    (weight, !weight.lt(F8::splat(world.adc_bailout)))
}

/// The normal at which rays are bent: a perturbed normal that points away from the eye is turned
/// round. A bent ray may then come back to the side of the eye (facts of the scene language).
#[inline(always)]
fn facing(spot: &Spot) -> Vec3<F8> {
    let turned_away = F8::ZERO.lt(dot(spot.view.eye, spot.view.normal));
    turned_away.select3(spot.view.normal * F8::splat(-1.0), spot.view.normal)
}

/// The direction behind the surface, and the lanes where light passes.
#[inline(always)]
fn passing(world: &World, border: &Interface, spot: &Spot) -> (Vec3<F8>, M8) {
    let open = open(world, spot);
    if border.ratio == 1.0 {
        return (spot.view.eye, open);
    }
    let (bent, passes) = refract(spot.view.eye, facing(spot), border.ratio);
    (bent, open & passes)
}

/// The lanes of total reflection.
#[inline(always)]
fn totally_reflected(world: &World, border: &Interface, spot: &Spot) -> M8 {
    if border.ratio == 1.0 {
        return M8::NONE;
    }
    let (_, passes) = refract(spot.view.eye, facing(spot), border.ratio);
    open(world, spot) & !passes
}

/// The transmittance of the medium that the ray leaves here.
#[inline(always)]
fn faded(world: &World, part: &Part<'_, '_>, spot: &Spot) -> Rgb8 {
    match part.border.crossing {
        Crossing::Leave { .. } => world.media[part.look.medium as usize].left_after(spot.distance, spot.live),
        Crossing::Enter | Crossing::Touch => Rgb8::WHITE,
    }
}

/// Adds rays that start at a spot to a bundle.
#[inline(always)]
fn send(
    bundle: &mut Bundle<'_>,
    spot: &Spot,
    direction: Vec3<F8>,
    weight: F8,
    factor: Rgb8,
    lanes: M8,
    count: &mut u64,
) {
    let bits = lanes.bits();
    if bits == 0 {
        return;
    }
    *count += u64::from(bits.count_ones());
    let (origin, back) = spot.hits.start_towards(direction);
    let rays = Rays8 {
        origin,
        direction,
        t_max: F8::splat(f64::INFINITY),
        live: M8::NONE,
        source: spot.hits.sources(back),
    };
    bundle.add(&rays, &Paths8 { weight, factor, ..spot.paths }, lanes);
}
