//! Whitted's ray tracing with the scene language's shading, many rays at once.
//!
//! T. Whitted, "An improved illumination model for shaded display", Communications of the ACM
//! 23(6), 1980: at each hit, shadow rays to the lights, one reflected and one refracted ray. The
//! camera's rays have level 1; a reflected or refracted ray has one level more than the ray before
//! it. A hit of a ray with level `max_trace_level` starts no secondary rays, and neither does one
//! whose secondary ray would have a weight below `adc_bailout`; black is seen instead. A ray that
//! passes a surface without refraction does not raise the level, so up to 4096 transparent sheets
//! may lie in a row.
//!
//! Rays are traced in bundles: all rays of a bundle have the same level and are in the same media.
//! Where they hit surfaces with different looks the bundle is split, so that every decision that
//! depends on the look is made once. A ray knows its weight in the picture and the sum to which its
//! colour is added, so nothing waits for it. Bundles lie on a stack, the last one is traced first,
//! and there is no recursion. The colour of a ray does not depend on its bundle or on the other
//! rays in it.

use super::bundle::{Bundle, BundleState, DEEPEST, Paths8, see};
use super::direct_light::Lamps;
use super::group::{Piece, cut, sort};
use super::layers::{Coats, draws};
use super::media::Interface;
use super::record::{RayTree, Record};
use super::secondary::{Onward, Part};
use super::shading_point::{Spot, Spots, face, map_to_chart};
use crate::camera::Camera;
use crate::fog::{Air, Ways, veil};
use crate::lanes::Rgb8;
use crate::material::Mirror;
use crate::progress::Progress;
use crate::sampler::Place;
use crate::stats::RayCounts;
use crate::texture::{Blend, RenderLayer, RenderTexture, Weights};
use crate::vector::length;
use crate::world::World;
use durer_geometry::{Hits8, Rays8, Scratch};
use durer_math::lanes::LANES;
use durer_math::{Aabb, F8, Isa, M8};
use durer_scene::{Rgb, mask};

/// The number of camera rays that are traced to their end before the next ones start. It is large,
/// so that there are still many secondary rays after some reflections.
const CAMERA_RAYS: usize = 128 * LANES;
/// The number of groups that are traced and shaded at a time. Their data should stay in the cache.
const AT_A_TIME: usize = 16;

/// Traces rays for one thread. It keeps its buffers, so that tracing a ray allocates nothing.
pub(crate) struct Whitted<'w> {
    world: &'w World,
    isa: Isa,
    /// The tasks that are left; the last one is next.
    tasks: Vec<Task<'w>>,
    /// The sums of colours, those of the camera's rays first.
    sums: Vec<Rgb>,
    hits: Vec<Hits8>,
    scratch: Box<Scratch>,
    pieces: Vec<Piece>,
    spots: Spots,
    coats: Coats<'w>,
    lamps: Lamps<'w>,
    onward: Onward<'w>,
    pub(crate) counts: RayCounts,
    /// Whether the caller has cancelled the work.
    stop: Progress<'w>,
    /// The record of the rays so far, if requested.
    record: Option<Box<Record>>,
}

enum Task<'w> {
    /// Traces the rays of a bundle and shades their hits.
    Follow(Bundle<'w>),
    /// Adds the colours reflected by a mirror that changes colours. The sums from `first` on belong
    /// to it. `node` is the mirrored ray's number in a record.
    Show { mirror: &'w Mirror, first: usize, to: Vec<(u32, Rgb)>, node: u32 },
}

impl<'w> Whitted<'w> {
    /// Makes a tracer for a world.
    pub(crate) fn new(world: &'w World) -> Self {
        Self {
            world,
            isa: Isa::detect(),
            tasks: Vec::new(),
            sums: Vec::new(),
            hits: Vec::new(),
            scratch: Box::default(),
            pieces: Vec::new(),
            spots: Spots::default(),
            coats: Coats::default(),
            lamps: Lamps::default(),
            onward: Onward::default(),
            counts: RayCounts::default(),
            stop: Progress::none(),
            record: None,
        }
    }

    /// Stops tracing, also within a pixel, once this is cancelled.
    #[must_use]
    pub(crate) fn stopped_by(self, stop: &Progress<'w>) -> Self {
        Self { stop: *stop, ..self }
    }

    /// Traces the ray through one point of a picture of the given size, and records all rays that
    /// follow from it. Returns `None` if the work was cancelled.
    pub(crate) fn record(&mut self, camera: &Camera, picture: (u32, u32), place: Place) -> Option<RayTree> {
        self.record = Some(Box::default());
        let mut colours = Vec::new();
        let done = self.look_once(camera, picture, (&[place], &[]), &mut colours);
        let record = self.record.take();
        done?;
        Some(record?.finish(*colours.first()?))
    }

    /// Computes the colours of one ray for each of some points of a picture of the given size, in
    /// order. The rays have these numbers, or 0 if none are given. Returns `None` if the work was
    /// cancelled.
    pub(super) fn look_once(
        &mut self,
        camera: &Camera,
        picture: (u32, u32),
        (places, numbers): (&[Place], &[u32]),
        colours: &mut Vec<Rgb>,
    ) -> Option<()> {
        colours.clear();
        for (part, places) in places.chunks(CAMERA_RAYS).enumerate() {
            let numbers = numbers.get(part * CAMERA_RAYS..).unwrap_or_default();
            let sums = &mut self.sums;
            self.isa.run_in_lanes(
                #[inline(always)]
                || {
                    sums.clear();
                    sums.resize(places.len(), Rgb::BLACK);
                },
            );
            for (i, places) in places.chunks(AT_A_TIME * LANES).enumerate() {
                let first = i * AT_A_TIME * LANES;
                let numbers = numbers.get(first..).unwrap_or_default();
                self.start(camera, picture, first, (places, numbers));
            }
            self.tasks.extend(self.onward.take().map(Task::Follow));
            while let Some(task) = self.tasks.pop() {
                if self.stop.is_cancelled() {
                    self.tasks.clear();
                    return None;
                }
                match task {
                    Task::Follow(bundle) => self.begin(bundle),
                    Task::Show { mirror, first, to, node } => {
                        for (i, (slot, factor)) in to.into_iter().enumerate() {
                            let seen = mirror.shown(self.sums[first + i]);
                            self.sums[slot as usize] += seen * factor;
                            if let Some(record) = &mut self.record {
                                record.show(node, seen * factor);
                            }
                        }
                        self.sums.truncate(first);
                    }
                }
            }
            // Colours of cancelled rays are incomplete.
            if self.stop.is_cancelled() {
                return None;
            }
            colours.extend_from_slice(&self.sums);
        }
        Some(())
    }

    /// Starts the camera's rays for some points; their sums begin at `slot`. They form one bundle
    /// if all start in the same media.
    fn start(
        &mut self,
        camera: &Camera,
        picture: (u32, u32),
        slot: usize,
        (places, numbers): (&[Place], &[u32]),
    ) {
        self.counts.camera += places.len() as u64;
        let mut all = self.onward.empty();
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                for (group, places) in places.chunks(LANES).enumerate() {
                    let (mut x, mut y) = (F8::splat(places[0].x), F8::splat(places[0].y));
                    let mut paths = Paths8::NONE;
                    let mut of_lanes = [0; LANES];
                    for (i, place) in places.iter().enumerate() {
                        (x.0[i], y.0[i]) = (place.x, place.y);
                        // All bits of the position in the picture identify the ray.
                        paths.seed[i] = place.x.to_bits().rotate_left(32) ^ place.y.to_bits();
                        if let Some(&number) = numbers.get(group * LANES + i) {
                            of_lanes[i] = number;
                            paths.seed[i] = paths.seed[i].wrapping_add(u64::from(number));
                        }
                        paths.slot[i] = (slot + group * LANES + i) as u32;
                    }
                    let (origin, direction) = camera.rays((x, y, of_lanes), picture);
                    let (t_max, source) = (F8::splat(camera.t_max()), Rays8::NONE.source);
                    // Where the picture shows nothing, rays have no direction.
                    let size = direction.x.abs() + direction.y.abs() + direction.z.abs();
                    let live = M8::first(places.len()) & (F8::ZERO).lt(size);
                    all.rays.push(Rays8 { origin, direction, t_max, live, source });
                    all.paths.push(paths);
                }
            },
        );
        let first = BundleState {
            level: 1,
            depth: 0,
            mask: mask::CAMERA,
            draws: 0,
            mirror: None,
            media: Vec::new(),
            node: 0,
            kind: 0,
        };
        match self.standing(&all.rays) {
            Some(media) => {
                all.standing = BundleState { media, ..first };
                self.begin_record(&mut all);
                self.follow(&all);
            }
            None => self.start_apart(&all, &first),
        }
        self.onward.give_back(all);
    }

    /// The media in which the camera's rays start, if these are certainly the same for all.
    fn standing(&self, rays: &[Rays8]) -> Option<Vec<u32>> {
        let origins = || rays.iter().flat_map(|rays| rays.live.lanes().map(|i| rays.lane(i).origin));
        self.world.standing(|| Aabb::from_points(origins()))
    }

    /// Starts rays that may begin in different media, in one bundle for each list of media.
    #[cold]
    fn start_apart(&mut self, all: &Bundle<'w>, first: &BundleState<'w>) {
        let mut apart: Vec<Bundle<'w>> = Vec::new();
        // Compared element by element: the library's comparison of slices is slow when both are
        // empty.
        let mut media = Vec::new();
        for (rays, paths) in all.rays.iter().zip(&all.paths) {
            let mut of = [0; LANES];
            for i in rays.live.lanes() {
                media.clear();
                self.world.media_of(&rays.lane(i), &mut media);
                let known = apart.iter().position(|b| b.standing.media.iter().eq(&media));
                of[i] = known.unwrap_or_else(|| {
                    let mut bundle = self.onward.empty();
                    bundle.standing = BundleState { media: media.clone(), ..first.clone() };
                    apart.push(bundle);
                    apart.len() - 1
                });
            }
            let mut left = rays.live;
            while let Some(first) = left.first_set() {
                let same = left & M8::from_fn(|i| of[i] == of[first]);
                apart[of[first]].add(rays, paths, same);
                left &= !same;
            }
        }
        for mut bundle in apart {
            self.begin_record(&mut bundle);
            self.follow(&bundle);
            self.onward.give_back(bundle);
        }
    }

    /// Traces the rays of a bundle, unless they already have too many rays before them.
    fn begin(&mut self, mut bundle: Bundle<'w>) {
        if bundle.standing.depth >= DEEPEST {
            self.onward.give_back(bundle);
            return;
        }
        self.begin_record(&mut bundle);
        if let Some(mirror) = bundle.standing.mirror.take() {
            // The reflected colours are first summed up separately.
            let first = self.sums.len();
            let mut to = Vec::new();
            for (rays, paths) in bundle.rays.iter().zip(&mut bundle.paths) {
                for i in rays.live.lanes() {
                    to.push((paths.slot[i], paths.factor.lane(i)));
                    paths.slot[i] = (first + to.len() - 1) as u32;
                }
                paths.factor = Rgb8::WHITE;
            }
            self.sums.resize(first + to.len(), Rgb::BLACK);
            self.tasks.push(Task::Show { mirror, first, to, node: bundle.standing.node });
        }
        self.follow(&bundle);
        self.tasks.extend(self.onward.take().map(Task::Follow));
        self.onward.give_back(bundle);
    }

    /// Numbers the ray of a bundle in the record, if there is one.
    fn begin_record(&mut self, bundle: &mut Bundle<'w>) {
        if let Some(record) = &mut self.record {
            bundle.standing.node = record.begin(bundle);
        }
    }

    /// Adds the colours that the rays of a bundle find, and puts their secondary rays into
    /// `onward`.
    fn follow(&mut self, bundle: &Bundle<'w>) {
        for (rays, paths) in bundle.rays.chunks(AT_A_TIME).zip(bundle.paths.chunks(AT_A_TIME)) {
            self.follow_some((rays, paths), &bundle.standing);
        }
    }

    /// [`Whitted::follow`] for some groups of a bundle.
    fn follow_some(&mut self, (rays, paths): (&[Rays8], &[Paths8]), standing: &BundleState<'w>) {
        self.see((rays, paths), standing);
        let pieces = core::mem::take(&mut self.pieces);
        let mut spots = core::mem::take(&mut self.spots);
        for part in pieces.chunk_by(Piece::is_like) {
            if self.stop.is_cancelled() {
                break;
            }
            let spots = spots.gather(self.isa, part, (rays, paths), &self.hits);
            face(self.isa, spots);
            let world = self.world;
            self.see_through_fog(world.air_in(&standing.media), standing.node, spots);
            let look = part[0].look(world);
            if let Some(chart) = look.chart {
                map_to_chart(&world.charts[chart as usize], spots);
            }
            let border = Interface::new(world, &standing.media, look.medium, part[0].is_grazing());
            let part = Part { look, border, standing };
            self.paint(&part, &world.paints[look.paint as usize], spots, &mut 0);
        }
        (self.pieces, self.spots) = (pieces, spots);
    }

    /// Finds the first hits of rays: fills `hits`, and `pieces` with the lanes to be shaded
    /// together. Rays without a hit add the background.
    fn see(&mut self, (rays, paths): (&[Rays8], &[Paths8]), standing: &BundleState<'w>) {
        let world = self.world;
        self.pieces.clear();
        // Hits of earlier rays are overwritten.
        self.hits.resize(rays.len(), Hits8::NONE);
        see(world.geometry(), rays, standing.mask, &mut self.hits, &mut self.scratch);
        if let Some(camera) = world.camera_end.filter(|_| standing.depth == 0) {
            camera.see_beyond(world.geometry(), standing.mask, rays, &mut self.hits);
        }
        let air = world.air_in(&standing.media);
        if let Some(record) = &mut self.record {
            let beyond = |rays: &Rays8, missed| beyond(world, air, rays, missed);
            record.see(standing.node, rays, &self.hits, paths, beyond);
        }
        let (hits, sums, pieces) = (&self.hits, &mut self.sums, &mut self.pieces);
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                for (group, hits) in hits.iter().enumerate() {
                    let missed = rays[group].live & !hits.hit;
                    if missed.any() {
                        let seen = beyond(world, air, &rays[group], missed);
                        add(sums, &paths[group], seen, missed);
                    }
                    cut(world, group, &rays[group], hits, pieces);
                }
            },
        );
        sort(&mut self.pieces);
    }

    /// Adds the light of fog and rainbows before shading points, and dims the light behind.
    fn see_through_fog(&mut self, air: Air<'_>, node: u32, spots: &mut [Spot]) {
        if air.is_clear() {
            return;
        }
        for spot in spots {
            let (direction, distance) = (spot.view.eye, spot.distance);
            let origin = spot.hits.p - direction * distance;
            let ways = Ways { origin, direction, distance, live: spot.live };
            if let Some(veil) = veil(&air, &ways) {
                add(&mut self.sums, &spot.paths, veil.added, spot.live);
                if let Some(record) = &mut self.record {
                    record.add(node, spot, veil.added);
                }
                spot.paths.factor = spot.paths.factor * veil.passed;
            }
        }
    }

    /// Shades points with a texture, in whose space `inside` is given; `stack` counts the surface's
    /// stacks of layers.
    fn paint(&mut self, part: &Part<'_, 'w>, paint: &'w RenderTexture, spots: &mut [Spot], stack: &mut u32) {
        match paint {
            RenderTexture::Layers(layers) => {
                self.shade(part, layers, spots, *stack);
                *stack += 1;
            }
            RenderTexture::Pattern(place, blend) => {
                for spot in &mut *spots {
                    spot.inside = place.inside_lanes(spot.inside, &spot.around());
                }
                self.blend(part, blend, spots, stack);
            }
            RenderTexture::Fields(weights) => self.weigh(part, weights, spots, stack),
        }
    }

    /// Shades points with each texture whose fields reach them.
    fn weigh(&mut self, part: &Part<'_, 'w>, weights: &'w Weights, spots: &[Spot], stack: &mut u32) {
        let (mut shown, mut shares) = (Vec::new(), Vec::new());
        for (group, spot) in spots.iter().enumerate() {
            let p = spot.inside.to_vec();
            for i in spot.live.lanes() {
                weights.shown(p.lane(i).to_point(), &mut shown);
                shares.extend(shown.iter().map(|&(texture, weight)| (texture, group, i, weight)));
            }
        }
        shares.sort_unstable_by_key(|&(texture, group, i, _)| (texture, group, i));
        let (mut weighed, mut some) = (Vec::new(), Spots::default());
        for of_texture in shares.chunk_by(|a, b| a.0 == b.0) {
            weighed.clear();
            let mut lists = Vec::new();
            for of_group in of_texture.chunk_by(|a, b| a.1 == b.1) {
                let (mut weight, mut lanes) = (F8::ZERO, M8::NONE);
                for &(_, _, i, share) in of_group {
                    weight.0[i] = share;
                    lanes.set_lane(i, true);
                }
                let mut spot = spots[of_group[0].1];
                spot.paths.factor = spot.paths.factor * weight;
                lists.push((weighed.len(), lanes.bits()));
                weighed.push(spot);
            }
            let some = some.gather_again(self.isa, lists.into_iter(), &weighed);
            self.paint(part, weights.texture(of_texture[0].0), some, stack);
        }
    }

    /// Shades points with each texture that a pattern selects there.
    fn blend(
        &mut self,
        part: &Part<'_, 'w>,
        blend: &'w Blend<RenderTexture>,
        spots: &[Spot],
        stack: &mut u32,
    ) {
        let mut shown = Vec::new();
        for spot in spots {
            shown.push(blend.at_lanes(spot.inside, &spot.around(), spot.live));
        }
        let mut some = Spots::default();
        for entry in 0..blend.len() {
            let weights = |group: usize| shown[group].map(|s| s.map_or(0.0, |s| blend.part(s, entry)));
            let mut weighed = spots.to_vec();
            let mut lists = Vec::new();
            for (group, spot) in weighed.iter_mut().enumerate() {
                let weight = F8(weights(group));
                let lanes = spot.live & !weight.equals(F8::ZERO);
                spot.paths.factor = spot.paths.factor * weight;
                lists.push((group, lanes.bits()));
            }
            let some = some.gather_again(self.isa, lists.into_iter(), &weighed);
            if !some.is_empty() {
                self.paint(part, blend.entry(entry), some, stack);
            }
        }
    }

    /// Shades points with a stack of layers.
    fn shade(&mut self, part: &Part<'_, 'w>, layers: &'w [RenderLayer], spots: &mut [Spot], stack: u32) {
        let (world, isa, standing) = (self.world, self.isa, part.standing);
        self.coats.lay((world, isa), layers, &part.border, standing.draws, spots);
        if !self.coats.finishes.is_empty() {
            let how = (&self.coats, part.look);
            let (state, watch) = ((&standing.media[..], standing.node), (&self.stop, &mut self.record));
            self.lamps.light((world, isa), how, state, spots, watch, &mut self.counts);
        }
        if let Some(record) = &mut self.record {
            record.shade(standing.node, spots);
        }
        let sums = &mut self.sums;
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for spot in &*spots {
                    add(sums, &spot.paths, spot.sum, spot.live);
                }
            },
        );
        let stack = (stack, draws(layers));
        self.onward.send((world, isa), part, &self.coats, stack, spots, &mut self.counts);
    }
}

/// The light of the background, through fog and rainbows, for rays that hit nothing.
#[inline(always)]
fn beyond(world: &World, air: Air<'_>, rays: &Rays8, missed: M8) -> Rgb8 {
    let seen = world.sky.seen(rays.direction, missed);
    if air.is_clear() {
        return seen;
    }
    let direction = rays.direction * (F8::ONE / length(rays.direction));
    let ways = Ways { origin: rays.origin, direction, distance: F8::splat(f64::INFINITY), live: missed };
    veil(&air, &ways).map_or(seen, |veil| seen * veil.passed + veil.added)
}

/// Adds colours to their sums.
#[inline(always)]
fn add(sums: &mut [Rgb], paths: &Paths8, colour: Rgb8, lanes: M8) {
    let colour = colour * paths.factor;
    let (first, mut gaps) = (paths.slot[0], 0);
    for i in 0..LANES {
        gaps |= paths.slot[i] ^ first.wrapping_add(i as u32);
    }
    let at = first as usize;
    match sums.get_mut(at..at + LANES) {
        // Adjacent slots, as for the camera's rays. Adding zero changes no sum: each began with 0,
        // so none is -0.
        Some(sums) if gaps == 0 => {
            let colour = colour.kept(lanes);
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum += colour.lane(i);
            }
        }
        _ => {
            for i in lanes.lanes() {
                sums[paths.slot[i] as usize] += colour.lane(i);
            }
        }
    }
}
