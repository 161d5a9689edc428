//! Whitted's recursive ray tracing with the scene language's shading.
//!
//! T. Whitted, "An improved illumination model for shaded display", Communications of the ACM 23(6), 1980: at each hit, shadow rays to the
//! lights, one mirrored and one refracted ray. The camera's rays have level 1, mirrored and bent ones one more than the ray before; where the
//! level is `max_trace_level`, and where a ray would count for less than `adc_bailout`, black is seen instead. What passes unbent does not
//! raise the level; so many clear sheets may lie in a row, up to 4096.
//!
//! Layers of paint are worked through from the outermost: each adds its own light, times what the layers above let pass; what all of them
//! let pass is seen behind the surface. Reflections of all layers are added as they are.
//!
//! Rays keep a list of the media they are in. A surface whose medium is in the list is left, any other is entered. The list decides,
//! and not the normal, so that sheets and overlapping bodies have a meaning too.

use super::cells::Cells;
use crate::material::{Finish, Incidence, Mirror, reflectance, refract};
use crate::progress::Progress;
use crate::sampler::random;
use crate::stats::RayCounts;
use crate::texture::Coat;
use crate::vector::{dot, dot_n, length, reflect};
use crate::world::{Look, World};
use core::ops::Range;
use durer_geometry::{Beam, Hit};
use durer_math::{Point3, Ray, Vec3};
use durer_scene::{Rgb, mask};
use durer_surfaces::{Need, SurfacePoint};

/// After so many rays in a row the next ones get a stack of their own.
const HOP: u32 = 128;
/// Its size: 16 KiB for each.
const STACK: usize = HOP as usize * 16 * 1024;
/// Black is seen after so many rays in a row: each keeps a list of the media it is in.
const DEEPEST: u32 = 4096;

/// Traces rays for one thread; keeps its stacks, so that nothing is allocated for a ray.
pub(crate) struct Whitted<'w> {
    pub(super) world: &'w World,
    /// Layers of the surfaces being shaded, the innermost call's last.
    coats: Vec<Lit<'w>>,
    mirrors: Vec<Mirrored<'w>>,
    /// Lists of media, each a range.
    pub(super) media: Vec<u32>,
    pub(super) cells: Cells,
    /// The width of a pixel at distance 1, and at the camera.
    pixel: (f64, f64),
    pub(crate) counts: RayCounts,
    /// What random numbers depend on: the place in the picture, and how many were drawn there.
    seed: (u64, u64),
    /// Whether the caller has had enough.
    stop: Progress<'w>,
}

/// A layer that light changes.
#[derive(Clone, Copy)]
struct Lit<'w> {
    finish: &'w Finish,
    /// What scattered light is multiplied by.
    scattered: Rgb,
    /// What highlights are multiplied by.
    shine: Rgb,
    /// The paint's colour.
    colour: Rgb,
    grain: f64,
}

/// A layer that reflects.
#[derive(Clone, Copy)]
struct Mirrored<'w> {
    mirror: &'w Mirror,
    reflectance: Rgb,
    /// How much it counts: the greatest channel, dimmed by the layers above (which do not dim what is seen).
    importance: f64,
}

/// Where a ray stands in the tree of rays.
#[derive(Debug)]
pub(super) struct Node {
    /// The camera's rays have level 1.
    level: u32,
    /// How many rays lead to it; those that pass unbent do not raise the level.
    depth: u32,
    /// The greatest channel of what its colour will be multiplied by.
    weight: f64,
    /// How long the way from the camera to its start is.
    way: f64,
    /// Which objects it meets.
    mask: u32,
    /// The media it is in, the one entered last at the end.
    pub(super) media: Range<usize>,
}

/// A surface being shaded.
struct Place<'w> {
    point: SurfacePoint,
    look: &'w Look,
    /// The unit direction of sight.
    eye: Vec3,
    /// The unit normal, on the side of the eye.
    normal: Vec3,
    /// The cosine between them.
    cosine: f64,
    /// How far the ray came.
    distance: f64,
    /// How long the way from the camera is.
    way: f64,
    /// The ray only touches the surface.
    grazing: bool,
}

impl<'w> Whitted<'w> {
    /// `pixel` is the width of a pixel at distance 1, and at the camera.
    pub(crate) fn new(world: &'w World, pixel: (f64, f64)) -> Self {
        Self {
            world,
            coats: Vec::new(),
            mirrors: Vec::new(),
            media: Vec::new(),
            cells: Cells::new(),
            pixel,
            counts: RayCounts::default(),
            seed: (0, 0),
            stop: Progress::none(),
        }
    }

    /// Follows no further ray once this is cancelled, also within one pixel; what is answered then is no colour.
    #[must_use]
    pub(crate) fn stopped_by(self, stop: &Progress<'w>) -> Self {
        Self { stop: *stop, ..self }
    }

    /// The colour seen along a ray of the camera; `seed` names its place in the picture, `beam` holds what it may meet, if that is known.
    pub(crate) fn camera_ray(&mut self, ray: &Ray, seed: u64, beam: Option<&Beam>) -> Rgb {
        self.seed = (seed, 0);
        self.counts.camera += 1;
        self.media.clear();
        self.world.media_around(ray.origin, &mut self.media);
        let media = 0..self.media.len();
        let node = Node { level: 1, depth: 0, weight: 1.0, way: 0.0, mask: mask::CAMERA, media };
        let geometry = self.world.geometry();
        let seen = match beam {
            Some(beam) => geometry.seen_in(beam, ray, node.mask, Need::SHADING_NORMAL),
            None => geometry.seen(ray, node.mask, Need::SHADING_NORMAL),
        };
        self.seen(ray, seen, node)
    }

    /// The colour seen along a ray.
    fn look(&mut self, ray: &Ray, node: Node) -> Rgb {
        if self.stop.is_cancelled() {
            return Rgb::BLACK;
        }
        if node.depth > 0 && node.depth.is_multiple_of(HOP) {
            return self.look_on_a_new_stack(ray, node);
        }
        let seen = self.world.geometry().seen(ray, node.mask, Need::SHADING_NORMAL);
        self.seen(ray, seen, node)
    }

    /// Thousands of clear sheets in a row make recursions that no thread's stack would hold.
    #[cold]
    fn look_on_a_new_stack(&mut self, ray: &Ray, node: Node) -> Rgb {
        if node.depth >= DEEPEST {
            return Rgb::BLACK;
        }
        std::thread::scope(|scope| {
            let thread = std::thread::Builder::new().stack_size(STACK);
            let look = || {
                let seen = self.world.geometry().seen(ray, node.mask, Need::SHADING_NORMAL);
                self.seen(ray, seen, node)
            };
            match thread.spawn_scoped(scope, look) {
                Ok(work) => work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
                // No more threads: as deep as this system goes.
                Err(_) => Rgb::BLACK,
            }
        })
    }

    /// The colour of what a ray meets first.
    fn seen(&mut self, ray: &Ray, seen: Option<(Hit, SurfacePoint)>, node: Node) -> Rgb {
        let world = self.world;
        let Some((hit, point)) = seen else { return world.background };
        let speed = length(ray.direction);
        let eye = ray.direction * (1.0 / speed);
        let slope = dot_n(point.ns, eye);
        let normal = if slope > 0.0 { -point.ns.to_vec() } else { point.ns.to_vec() };
        let place = Place {
            look: world.look_of(hit.object, hit.primitive),
            eye,
            normal,
            cosine: slope.abs().min(1.0),
            distance: hit.t * speed,
            way: node.way + hit.t * speed,
            grazing: hit.sign == 0,
            point,
        };
        let mut sum = Rgb::BLACK;
        let paint = &world.paints[place.look.paint as usize];
        paint.each(place.point.p, 1.0, &mut |coats, weight, p| {
            let seen = self.shade(&place, coats, p, &node);
            sum += if weight == 1.0 { seen } else { seen * weight };
        });
        sum
    }

    /// The colour of a stack of layers at a point `p` of its space.
    fn shade(&mut self, place: &Place<'w>, layers: &'w [Coat], p: Point3, node: &Node) -> Rgb {
        let world = self.world;
        let (first_coat, first_mirror) = (self.coats.len(), self.mirrors.len());
        let mut sum = Rgb::BLACK;
        let mut passed = Rgb::WHITE;
        // Opaque, dull surfaces need none.
        let mut border = None;
        for coat in layers.iter().rev() {
            if passed.luminance() <= world.adc_bailout {
                break;
            }
            let paint = coat.pigment.at(p);
            let finish = &coat.finish;
            let colour = paint.rgb;
            let filtering =
                if world.filter_by_colour { paint.filter * colour.greatest() } else { paint.filter };
            let body = passed * colour * (1.0 - filtering - paint.transmit);
            sum += body * finish.own_light;
            if finish.is_lit {
                let grain = if finish.crand > 0.0 { self.random() * finish.crand } else { 0.0 };
                self.coats.push(Lit { finish, scattered: body, shine: passed, colour, grain });
            }
            let mut mirrored = Rgb::BLACK;
            if let Some(mirror) = finish.mirror.as_deref() {
                mirrored = mirror.reflectance(place.cosine, colour, || {
                    border.get_or_insert_with(|| Border::new(self, place, node)).fresnel(place.cosine)
                });
                if !mirrored.is_black() {
                    let importance = passed.luminance() * mirrored.greatest();
                    self.mirrors.push(Mirrored { mirror, reflectance: mirrored, importance });
                }
            }
            passed = passed * paint.passed();
            if finish.conserve_energy {
                passed = passed * mirrored.map(|r| 1.0 - r.min(1.0));
            }
        }
        if self.coats.len() > first_coat {
            sum += self.light(place, first_coat, node);
            self.coats.truncate(first_coat);
        }
        let mut total_reflection = false;
        if !passed.is_black() {
            let border = border.unwrap_or_else(|| Border::new(self, place, node));
            let (seen, total) = self.behind(place, &border, passed, node);
            sum += seen;
            total_reflection = total;
        }
        if self.mirrors.len() > first_mirror {
            if !total_reflection {
                for i in first_mirror..self.mirrors.len() {
                    sum += self.reflection(place, self.mirrors[i], node);
                }
            }
            self.mirrors.truncate(first_mirror);
        }
        sum
    }

    /// The light of all lamps on the layers from `first` on.
    fn light(&mut self, place: &Place<'w>, first: usize, node: &Node) -> Rgb {
        let world = self.world;
        let mirrored = reflect(place.eye, place.normal);
        let double = place.look.double_illuminate;
        let behind = double || self.coats[first..].iter().any(|c| c.finish.lit_from_behind());
        let mut sum = Rgb::BLACK;
        // The cubes that shadow rays share are some pixels wide.
        let cell = 8.0 * (self.pixel.0 * place.way + self.pixel.1);
        for (number, lamp) in world.lamps.iter().enumerate() {
            let Some(beamed) = lamp.at(place.point.p) else { continue };
            let cosine = dot(beamed.to_light, place.normal);
            if cosine <= 0.0 && !behind {
                continue;
            }
            let at = Incidence { to_light: beamed.to_light, cosine, double };
            let highlights = !lamp.shadowless && (cosine > 0.0 || double);
            let mut shown = Rgb::BLACK;
            for coat in &self.coats[first..] {
                shown += coat.scattered * coat.finish.scattered(&at, coat.grain);
                if highlights && coat.finish.shines() {
                    let shine = coat.finish.highlight(&at, place.eye, mirrored, place.normal, coat.colour);
                    shown += coat.shine * shine;
                }
            }
            if shown.is_black() || beamed.strength == 0.0 {
                continue;
            }
            let mut light = lamp.colour * beamed.strength;
            if let Some(target) = beamed.target {
                let left = self.through(&place.point, target, (number, lamp.parallel), cell, node);
                if left.is_black() {
                    continue;
                }
                light = light * left;
            }
            sum += light * shown;
        }
        sum
    }

    /// What is seen through the surface, already multiplied by what it lets pass; and whether it was totally reflected instead. Either fades in
    /// the medium that is left.
    fn behind(&mut self, place: &Place<'w>, border: &Border, passed: Rgb, node: &Node) -> (Rgb, bool) {
        let world = self.world;
        let faded = match border.crossing {
            Crossing::Leave { .. } => world.media[place.look.medium as usize].left_after(place.distance),
            Crossing::Enter | Crossing::Touch => Rgb::WHITE,
        };
        let direction = if border.ratio == 1.0 {
            place.eye
        } else if let Some(bent) = refract(place.eye, place.normal, border.ratio) {
            bent
        } else {
            // Total reflection: nothing passes, so the paint does not colour it.
            return (self.mirrored_ray(place, node, node.weight) * faded, true);
        };
        let weight = node.weight * passed.luminance();
        if node.level >= world.max_level || weight <= world.adc_bailout {
            return (Rgb::BLACK, false);
        }
        let media = self.media_behind(border.crossing, place.look.medium, &node.media);
        let level = node.level + u32::from(border.ratio != 1.0);
        let base = media.start;
        self.counts.transmitted += 1;
        let ray = place.point.spawn(direction);
        let depth = node.depth + 1;
        let seen = self.look(&ray, Node { level, depth, weight, way: place.way, mask: node.mask, media });
        self.media.truncate(base);
        (seen * passed * faded, false)
    }

    /// The list of media behind a surface, as a new range at the end of the stack.
    pub(super) fn media_behind(
        &mut self,
        crossing: Crossing,
        medium: u32,
        media: &Range<usize>,
    ) -> Range<usize> {
        let start = self.media.len();
        self.media.extend_from_within(media.clone());
        match crossing {
            Crossing::Enter => self.media.push(medium),
            Crossing::Leave { at } => {
                self.media.remove(start + at);
            }
            Crossing::Touch => {}
        }
        start..self.media.len()
    }

    /// What a reflecting layer shows.
    fn reflection(&mut self, place: &Place<'w>, layer: Mirrored<'w>, node: &Node) -> Rgb {
        let weight = node.weight * layer.importance;
        if weight < self.world.adc_bailout {
            return Rgb::BLACK;
        }
        let seen = self.mirrored_ray(place, node, weight);
        layer.mirror.shown(seen) * layer.reflectance
    }

    /// What is seen in the mirror direction.
    fn mirrored_ray(&mut self, place: &Place<'w>, node: &Node, weight: f64) -> Rgb {
        if node.level >= self.world.max_level {
            return Rgb::BLACK;
        }
        let level = node.level + 1;
        self.counts.reflected += 1;
        let ray = place.point.spawn(reflect(place.eye, place.normal));
        let (depth, media) = (node.depth + 1, node.media.clone());
        self.look(&ray, Node { level, depth, weight, way: place.way, mask: mask::MIRROR, media })
    }

    fn random(&mut self) -> f64 {
        self.seed.1 += 1;
        random(self.seed.0, self.seed.1, 2)
    }
}

/// What a surface does to a list of media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    Enter,
    Leave {
        /// Which of the list is left.
        at: usize,
    },
    /// The ray stays where it is.
    Touch,
}

impl Crossing {
    pub(super) fn new(media: &[u32], medium: u32, grazing: bool) -> Self {
        if grazing {
            return Self::Touch;
        }
        media.iter().rposition(|&m| m == medium).map_or(Self::Enter, |at| Self::Leave { at })
    }
}

/// The border between two media.
#[derive(Clone, Copy, Debug)]
struct Border {
    crossing: Crossing,
    /// The index of refraction before the surface over that behind it.
    ratio: f64,
    /// The same as Fresnel's formula takes it. A fact of the scene language: behind the surface is always its own medium, save where a ray is in
    /// that alone and leaves it.
    fresnel_ratio: f64,
}

impl Border {
    fn new(tracer: &Whitted<'_>, place: &Place<'_>, node: &Node) -> Self {
        let world = tracer.world;
        let list = &tracer.media[node.media.clone()];
        let index = |medium: Option<&u32>| medium.map_or(1.0, |&m| world.media[m as usize].ior);
        let crossing = Crossing::new(list, place.look.medium, place.grazing);
        let ratio = match crossing {
            Crossing::Enter => index(list.last()) / index(Some(&place.look.medium)),
            // Only what was entered last bends the ray when it is left.
            Crossing::Leave { at } if at + 1 == list.len() => {
                index(Some(&place.look.medium)) / index(list[..at].last())
            }
            Crossing::Leave { .. } | Crossing::Touch => 1.0,
        };
        let own = index(Some(&place.look.medium));
        let fresnel_ratio = if *list == [place.look.medium] { own } else { index(list.last()) / own };
        Self { crossing, ratio, fresnel_ratio }
    }

    fn fresnel(&self, cosine: f64) -> f64 {
        if self.fresnel_ratio == 1.0 { 0.0 } else { reflectance(self.fresnel_ratio, cosine) }
    }
}
