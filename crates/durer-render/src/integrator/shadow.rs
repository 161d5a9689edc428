//! Shadow rays: the fraction of a light that reaches points.

use super::bundle::{Bundle, BundleState, DEEPEST, Paths8, TOGETHER, see};
use super::group::{Piece, cut, sort};
use super::media::Crossing;
use super::shading_point::{Spot, Spots, map_to_chart};
use crate::lanes::Rgb8;
use crate::progress::Progress;
use crate::ray_end::RayEnd;
use crate::stats::RayCounts;
use crate::texture::Around8;
use crate::vector::{dot, length};
use crate::world::{Look, World};
use durer_geometry::{CandidateList, Geometry, Hits8, Rays8, Scratch};
use durer_math::lanes::LANES;
use durer_math::{F8, Isa, M8, Point3};
use durer_scene::mask;

/// References to the light on eight points and to the shadow rays towards it, to be filled in.
pub(super) struct Shade<'a> {
    /// The light if nothing is in between.
    pub(super) light: &'a mut Rgb8,
    pub(super) rays: &'a mut Rays8,
    /// The ends of the rays.
    pub(super) target: &'a mut Point3<F8>,
}

/// The shadow rays of one light, group by group.
#[derive(Default)]
pub(super) struct Shadows<'w> {
    light: Vec<Rgb8>,
    rays: Vec<Rays8>,
    targets: Vec<Point3<F8>>,
    /// The initial paths of the rays, group by group, with the full light.
    starts: Vec<Paths8>,
    /// Rays on their way through transparent surfaces. The factor is the transmittance so far, the
    /// slot the index in `light`.
    clear: Vec<Bundle<'w>>,
    /// Empty bundles for reuse.
    spare: Vec<Bundle<'w>>,
    hits: Vec<Hits8>,
    /// The hits of rays with opaque surfaces, used if it matters which surface is hit.
    blockers: Vec<Hits8>,
    scratch: Box<Scratch>,
    pieces: Vec<Piece>,
    spots: Spots,
}

impl<'w> Shadows<'w> {
    /// References for the light on `groups` groups of points. Their contents are unspecified.
    pub(super) fn places(&mut self, groups: usize) -> impl Iterator<Item = Shade<'_>> {
        self.light.resize(groups, Rgb8::BLACK);
        self.rays.resize(groups, Rays8::NONE);
        self.targets.resize(groups, Rays8::NONE.origin);
        let both = self.light.iter_mut().zip(&mut self.rays).zip(&mut self.targets);
        both.map(
            #[inline(always)]
            |((light, rays), target)| Shade { light, rays, target },
        )
    }

    /// The rays towards the light, with their ends.
    pub(super) fn rays_mut(&mut self) -> (&mut [Rays8], &mut [Point3<F8>]) {
        (&mut self.rays, &mut self.targets)
    }

    /// The light that reaches the points, to be changed.
    pub(super) fn light_mut(&mut self) -> &mut [Rgb8] {
        &mut self.light
    }

    /// The light that reaches the points.
    pub(super) fn light(&self) -> &[Rgb8] {
        &self.light
    }

    /// Removes the light from points whose rays do not hit the object through which a light shines,
    /// and ends the rays of the others there. Points behind a parallel light have no rays, and so no
    /// light (a fact of the scene language). A light without shadows keeps no rays.
    pub(super) fn project(&mut self, through: &Geometry, shadowless: bool) {
        // The sources of the rays belong to another geometry.
        let rays: Vec<Rays8> =
            self.rays.iter().map(|rays| Rays8 { source: Rays8::NONE.source, ..*rays }).collect();
        let mut hits = vec![Hits8::NONE; rays.len()];
        see(through, &rays, mask::SHAPE, &mut hits, &mut self.scratch);
        let ends = self.rays.iter_mut().zip(&mut self.targets);
        for (((rays, target), light), hits) in ends.zip(&mut self.light).zip(&hits) {
            *light = light.kept(rays.live & hits.hit);
            rays.live &= hits.hit;
            // A copy of the object in the scene, at the same place, throws no shadow: the ray is the
            // same, so both crossings lie within the error bound of the exact one.
            let before = (hits.t - hits.t_error * 2.0).max(F8::ZERO);
            let end = rays.origin + rays.direction * before;
            for i in rays.live.lanes() {
                (target.x.0[i], target.y.0[i], target.z.0[i]) = (end.x.0[i], end.y.0[i], end.z.0[i]);
                rays.t_max.0[i] = before.0[i].next_down().max(0.0);
            }
            if shadowless {
                rays.live = M8::NONE;
            }
        }
    }

    /// Reduces the light by the surfaces in between: opaque ones block it, transparent ones
    /// multiply it by their transmittance. They do not refract shadow rays. Surfaces that pass
    /// through `end` throw no shadow.
    pub(super) fn cast(
        &mut self,
        (world, isa): (&'w World, Isa),
        end: Option<&RayEnd>,
        media: &[u32],
        stop: &Progress<'_>,
        counts: &mut RayCounts,
    ) {
        let clear = world.has_clear_shadows;
        self.hits.resize(if clear { self.rays.len() } else { 0 }, Hits8::NONE);
        for hits in &mut self.hits {
            hits.hit = M8::NONE;
        }
        let chunks = self.rays.chunks_mut(TOGETHER).zip(self.light.chunks_mut(TOGETHER));
        for (chunk, (rays, light)) in chunks.enumerate() {
            let count = count(isa, rays);
            if count == 0 {
                continue;
            }
            counts.shadow += count as u64;
            let beam = world.geometry().bundle_candidates(rays);
            if beam.as_ref().is_some_and(CandidateList::is_empty) {
                continue;
            }
            let (beam, scratch) = (beam.as_ref(), &mut self.scratch);
            let met = &mut [M8::NONE; TOGETHER][..rays.len()];
            match end {
                None => world.geometry().any8(beam, rays, mask::SHADOW, met, scratch),
                Some(end) => {
                    self.blockers.resize(rays.len(), Hits8::NONE);
                    let hits = &mut self.blockers;
                    world.geometry().first_visible8(beam, rays, mask::SHADOW, hits, scratch);
                    for ((rays, hits), met) in rays.iter().zip(hits).zip(&mut *met) {
                        *met = end.blocked(world.geometry(), mask::SHADOW, rays, hits);
                    }
                }
            }
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for ((rays, light), met) in rays.iter_mut().zip(light).zip(&*met) {
                        if met.any() {
                            *light = light.kept(!*met);
                            rays.live &= !*met;
                        }
                    }
                },
            );
            if clear {
                let hits = &mut self.hits[chunk * TOGETHER..][..rays.len()];
                world.geometry().first_visible8(beam, rays, mask::CLEAR_SHADOW, hits, scratch);
                if let Some(end) = end {
                    end.see_before(world.geometry(), mask::CLEAR_SHADOW, rays, hits);
                }
            }
        }
        if self.hits.iter().any(|h| h.hit.any()) {
            self.go_through_clear((world, isa), end, media, stop, counts);
        }
    }

    /// Traces the rays that hit transparent surfaces through all of these.
    fn go_through_clear(
        &mut self,
        (world, isa): (&'w World, Isa),
        end: Option<&RayEnd>,
        media: &[u32],
        stop: &Progress<'_>,
        counts: &mut RayCounts,
    ) {
        self.starts.extend((self.starts.len()..self.rays.len()).map(|group| Paths8 {
            slot: core::array::from_fn(|i| (group * LANES + i) as u32),
            ..Paths8::NONE
        }));
        let (rays, starts) = (core::mem::take(&mut self.rays), core::mem::take(&mut self.starts));
        self.cross((world, isa), (&rays, &starts), media, 1);
        (self.rays, self.starts) = (rays, starts);
        while let Some(bundle) = self.clear.pop() {
            if stop.is_cancelled() {
                self.spare.push(bundle);
                continue;
            }
            if bundle.standing.depth >= DEEPEST {
                for (rays, paths) in bundle.rays.iter().zip(&bundle.paths) {
                    settle(&mut self.light, &Paths8 { factor: Rgb8::BLACK, ..*paths }, rays.live);
                }
                self.spare.push(bundle);
                continue;
            }
            self.hits.resize(bundle.rays.len(), Hits8::NONE);
            counts.shadow += bundle.rays.iter().map(|rays| rays.live.count() as u64).sum::<u64>();
            see(world.geometry(), &bundle.rays, mask::CLEAR_SHADOW, &mut self.hits, &mut self.scratch);
            if let Some(end) = end {
                end.see_before(world.geometry(), mask::CLEAR_SHADOW, &bundle.rays, &mut self.hits);
            }
            for ((rays, paths), hits) in bundle.rays.iter().zip(&bundle.paths).zip(&self.hits) {
                settle(&mut self.light, paths, rays.live & !hits.hit);
            }
            let BundleState { media, depth, .. } = &bundle.standing;
            self.cross((world, isa), (&bundle.rays, &bundle.paths), media, depth + 1);
            self.spare.push(bundle);
        }
    }

    /// Continues rays, which are in `media`, behind the surfaces that they hit, and aims them at
    /// the light again. Every step leaves one surface behind, and a ray that has passed the light
    /// has arrived. So all rays arrive, unless they hit more surfaces than [`DEEPEST`]. `depth`
    /// counts the surfaces so far.
    fn cross(
        &mut self,
        (world, isa): (&'w World, Isa),
        rays: (&[Rays8], &[Paths8]),
        media: &[u32],
        depth: u32,
    ) {
        self.pieces.clear();
        for (group, hits) in self.hits.iter().enumerate() {
            cut(world, group, &rays.0[group], hits, &mut self.pieces);
        }
        sort(&mut self.pieces);
        for part in self.pieces.chunk_by(Piece::is_like) {
            let look = part[0].look(world);
            let crossing = Crossing::new(media, look.medium, part[0].is_grazing());
            let spots = self.spots.gather(isa, part, rays, &self.hits);
            let mut behind = self.spare.pop().unwrap_or_else(Bundle::new);
            behind.clear();
            crossing.behind(look.medium, media, &mut behind.standing.media);
            behind.standing.depth = depth;
            let (light, targets) = (&mut self.light, &self.targets);
            isa.run_in_lanes(
                #[inline(always)]
                || {
                    for spot in spots {
                        let goes_on = pass(world, look, crossing, spot);
                        let target = targets_of(spot, targets);
                        let (origin, back) = spot.hits.start_towards(target - spot.hits.p);
                        let goes_on = goes_on & F8::ZERO.lt(dot(target - origin, spot.view.eye));
                        settle(light, &spot.paths, spot.live & !goes_on);
                        let rays = Rays8 {
                            origin,
                            direction: target - origin,
                            t_max: F8::ONE,
                            live: M8::NONE,
                            source: spot.hits.sources(back),
                        };
                        behind.add(&rays, &spot.paths, goes_on);
                    }
                },
            );
            if behind.rays.is_empty() { &mut self.spare } else { &mut self.clear }.push(behind);
        }
    }
}

/// Reduces the light of some rays by the surfaces that they hit. Returns the lanes where light
/// remains.
#[inline(always)]
fn pass(world: &World, look: &Look, crossing: Crossing, spot: &mut Spot) -> M8 {
    let direction = spot.view.eye;
    let ng = spot.hits.ng;
    // Patterns and bumps use the normal on the side from which the ray comes.
    let facing = F8::ZERO.lt(dot(ng, direction)).select3(ng * F8::splat(-1.0), ng);
    if let Some(chart) = look.chart {
        map_to_chart(&world.charts[chart as usize], core::slice::from_mut(spot));
    }
    let around = Around8 { points: spot.hits.p, normals: facing, rays: direction, uv: spot.uv };
    let paint = &world.paints[look.paint as usize];
    let mut left = spot.paths.factor * paint.passed(spot.hits.p, &around, spot.live);
    let goes_on = spot.live & !left.is_black();
    let speed = length(direction);
    let medium = &world.media[look.medium as usize];
    if matches!(crossing, Crossing::Leave { .. }) {
        left = left * medium.shadow_after(spot.hits.t * speed, goes_on);
    }
    if let Some(power) = medium.caustics {
        let normal = paint.top_normal(spot.hits.p, &around, goes_on);
        let cosine = dot(normal, direction).abs() / speed;
        left = left * (F8::ONE + power.lanes(cosine, goes_on));
    }
    spot.paths.factor = left;
    goes_on
}

/// The number of active rays.
fn count(isa: Isa, rays: &[Rays8]) -> usize {
    let mut count = 0;
    isa.run_in_lanes(
        #[inline(always)]
        || {
            for rays in rays {
                count += rays.live.count();
            }
        },
    );
    count
}

/// The ends of some rays.
#[inline(always)]
fn targets_of(spot: &Spot, targets: &[Point3<F8>]) -> Point3<F8> {
    let mut target = spot.hits.p;
    for i in spot.live.lanes() {
        let slot = spot.paths.slot[i] as usize;
        let (from, j) = (&targets[slot / LANES], slot % LANES);
        (target.x.0[i], target.y.0[i], target.z.0[i]) = (from.x.0[j], from.y.0[j], from.z.0[j]);
    }
    target
}

/// Finishes rays that have arrived, or that carry no more light: multiplies the light by their
/// factor.
#[inline(always)]
fn settle(light: &mut [Rgb8], paths: &Paths8, lanes: M8) {
    for i in lanes.lanes() {
        let slot = paths.slot[i] as usize;
        let (group, j) = (&mut light[slot / LANES], slot % LANES);
        group.set_lane(j, group.lane(j) * paths.factor.lane(i));
    }
}
