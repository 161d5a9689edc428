//! Pixels on request: for pictures that form step by step, in an order that the caller chooses.

use crate::integrator::{RayTree, Whitted};
use crate::progress::Progress;
use crate::render::RenderError;
use crate::sampler::{Place, sample_tile};
use crate::settings::{AntiAliasing, Region};
use crate::stats::RayCounts;
use crate::world::World;
use durer_scene::Rgb;

/// Computes the colours of chosen pixels; one for each thread.
///
/// A pixel's colour is that of [`render`](crate::render()), bit for bit, whatever the order of the
/// calls.
///
/// ```
/// use durer_render::{AntiAliasing, PixelTracer, Progress, RenderSettings, World, render};
/// use durer_math::Point3;
/// use durer_scene::{Camera, Light, Object, Rgb, Scene, Shape};
///
/// let scene = Scene {
///     objects: vec![Object::new(Shape::Sphere { centre: Point3::new(0.0, 0.0, 5.0), radius: 1.0 })],
///     lights: vec![Light::point(Point3::new(0.0, 9.0, 0.0), Rgb::WHITE)],
///     camera: Some(Camera::default()),
///     ..Scene::default()
/// };
/// let world = World::new(&scene)?;
/// let size = (8, 6);
/// let mut tracer = PixelTracer::new(&world, size, Progress::none())?;
/// let mut colours = Vec::new();
/// assert!(tracer.pixels(&[(4, 3), (0, 0)], &mut colours));
///
/// let settings = RenderSettings { width: 8, height: 6, ..RenderSettings::default() };
/// let film = render(&world, &settings, &Progress::none())?.film;
/// assert_eq!(film.pixel(4, 3).unwrap().rgb, colours[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PixelTracer<'w> {
    tracer: Whitted<'w>,
    camera: crate::camera::Camera,
    size: (u32, u32),
    places: Vec<Place>,
}

impl<'w> PixelTracer<'w> {
    /// A tracer for pictures of `size` (columns and rows). It stops where `stop` is cancelled.
    pub fn new(world: &'w World, size: (u32, u32), stop: Progress<'w>) -> Result<Self, RenderError> {
        let camera = world.camera().ok_or(RenderError::NoCamera)?.clone();
        Ok(Self { tracer: Whitted::new(world).stopped_by(&stop), camera, size, places: Vec::new() })
    }

    /// Sets `colours` to the colours of these pixels (column and row), one ray through the middle
    /// of each. Returns false if the work was cancelled; `colours` are then incomplete.
    pub fn pixels(&mut self, pixels: &[(u32, u32)], colours: &mut Vec<Rgb>) -> bool {
        self.places.clear();
        let middle = |(x, y): &(u32, u32)| Place { x: f64::from(*x) + 0.5, y: f64::from(*y) + 0.5 };
        self.places.extend(pixels.iter().map(middle));
        self.tracer.look(&self.camera, self.size, &self.places, colours).is_some()
    }

    /// The colours of a part of the picture with anti-aliasing, row by row; `None` if the work was
    /// cancelled.
    pub fn tile(&mut self, how: AntiAliasing, tile: Region) -> Option<Vec<Rgb>> {
        let (camera, size, tracer) = (&self.camera, self.size, &mut self.tracer);
        let tile = tile.within(size.0, size.1);
        let pixels =
            sample_tile(how, tile, size, |places, colours| tracer.look(camera, size, places, colours));
        (pixels.len() as u64 == tile.pixels()).then_some(pixels)
    }

    /// All rays that the ray through the middle of a pixel leads to, with what each adds to the
    /// pixel's colour. `None` if the work was cancelled.
    pub fn ray_tree(&mut self, (x, y): (u32, u32)) -> Option<RayTree> {
        let place = Place { x: f64::from(x) + 0.5, y: f64::from(y) + 0.5 };
        self.tracer.record(&self.camera, self.size, place)
    }

    /// The rays traced so far.
    pub fn counts(&self) -> RayCounts {
        self.tracer.counts
    }
}

impl core::fmt::Debug for PixelTracer<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("PixelTracer").field("size", &self.size).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{RayKind, RenderSettings, render};
    use durer_math::{Point3, Vec3};
    use durer_scene::{Camera, Colour, Finish, Light, Object, Pigment, Reflection, Scene, Shape, Texture};

    /// A mirror and a clear ball above a floor, with two lights.
    fn scene() -> Scene {
        let plain = |rgb, finish| Texture::plain(Pigment::solid(Colour::opaque(rgb)), finish);
        let clear = Colour { transmit: 0.8, ..Colour::opaque(Rgb::grey(0.9)) };
        let reflection = Some(Box::new(Reflection::constant(Rgb::grey(0.6))));
        let mirror = Finish { reflection, ..Finish::default() };
        let ball = |x: f64, texture: Texture| {
            let centre = Point3::new(x, 0.0, 5.0);
            Object::new(Shape::Sphere { centre, radius: 1.0 }).with_texture(texture)
        };
        Scene {
            objects: vec![
                Object::new(Shape::Plane { normal: Vec3::Y, distance: -1.0 })
                    .with_texture(plain(Rgb::new(0.3, 0.6, 0.2), Finish::default())),
                ball(-1.1, plain(Rgb::grey(0.2), mirror)),
                ball(1.1, Texture::plain(Pigment::solid(clear), Finish::default())),
            ],
            lights: vec![
                Light::point(Point3::new(9.0, 9.0, -9.0), Rgb::WHITE),
                Light::point(Point3::new(-9.0, 5.0, -9.0), Rgb::grey(0.4)),
            ],
            camera: Some(Camera::default()),
            ..Scene::default()
        }
    }

    #[test]
    fn pixels_and_tiles_are_those_of_the_whole_picture() {
        let world = World::new(&scene()).unwrap();
        let size = (40, 30);
        for aa in [AntiAliasing::Off, AntiAliasing::Method2 { threshold: 0.1, depth: 2 }] {
            let settings =
                RenderSettings { width: 40, height: 30, anti_aliasing: aa, ..RenderSettings::default() };
            let film = render(&world, &settings, &Progress::none()).unwrap().film;
            let mut tracer = PixelTracer::new(&world, size, Progress::none()).unwrap();
            let tile = Region { x0: 10, y0: 7, x1: 33, y1: 90 };
            let colours = tracer.tile(aa, tile).unwrap();
            let places = (7..30).flat_map(|y| (10..33).map(move |x| (x, y)));
            for ((x, y), colour) in places.zip(colours) {
                assert_eq!(film.pixel(x, y).unwrap().rgb, colour);
            }
        }
        let film = render(
            &world,
            &RenderSettings { width: 40, height: 30, ..RenderSettings::default() },
            &Progress::none(),
        );
        let film = film.unwrap().film;
        let pixels: Vec<_> =
            (0..30).rev().step_by(3).flat_map(|y| (0..40).step_by(7).map(move |x| (x, y))).collect();
        let (mut tracer, mut colours) =
            (PixelTracer::new(&world, size, Progress::none()).unwrap(), Vec::new());
        assert!(tracer.pixels(&pixels, &mut colours));
        for ((x, y), colour) in pixels.into_iter().zip(colours) {
            assert_eq!(film.pixel(x, y).unwrap().rgb, colour);
        }
    }

    #[test]
    fn the_rays_of_a_pixel_add_up_to_its_colour() {
        let world = World::new(&scene()).unwrap();
        let mut tracer = PixelTracer::new(&world, (40, 30), Progress::none()).unwrap();
        let mut kinds = Vec::new();
        for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
            let mut colours = Vec::new();
            assert!(tracer.pixels(&[(x, y)], &mut colours));
            let tree = tracer.ray_tree((x, y)).unwrap();
            assert_eq!(tree.colour, colours[0]);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            let (got, want) = (tree.rays[0].total, tree.colour);
            assert!(near(got.r, want.r) && near(got.g, want.g) && near(got.b, want.b), "{got:?} {want:?}");
            for (i, ray) in tree.rays.iter().enumerate() {
                assert_eq!(ray.parent.is_none(), i == 0);
                assert!(ray.parent.is_none_or(|p| p < i && tree.rays[p].hit.is_some()));
                assert!(ray.shadows.iter().all(|s| s.arrived.g <= s.unblocked.g && s.light < 2));
                kinds.push(ray.kind);
            }
        }
        for kind in [RayKind::Camera, RayKind::Reflected, RayKind::Transmitted] {
            assert!(kinds.contains(&kind), "{kind:?}");
        }
    }

    #[test]
    fn a_new_camera_gives_the_picture_of_a_new_world() {
        let mut scene = scene();
        let mut world = World::new(&scene).unwrap();
        // Inside the clear ball.
        let camera = Camera { location: Point3::new(1.1, 0.1, 5.2), ..Camera::default() };
        world.set_camera(&camera).unwrap();
        scene.camera = Some(camera.clone());
        let settings = RenderSettings { width: 20, height: 15, ..RenderSettings::default() };
        let picture = |world: &World| render(world, &settings, &Progress::none()).unwrap().film;
        assert_eq!(picture(&world), picture(&World::new(&scene).unwrap()));
        assert!(world.set_camera(&Camera { right: Vec3::ZERO, ..camera }).is_err());
    }
}
