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
/// A pixel's colour is that of [`render`](crate::render()), bit for bit, in whatever order the
/// pixels are asked for.
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
        let camera = *world.camera().ok_or(RenderError::NoCamera)?;
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
