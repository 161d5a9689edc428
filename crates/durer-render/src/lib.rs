//! This crate renders pictures: cameras, lights, textures, films and Whitted's recursive ray
//! tracing.
//!
//! A [`World`] is a [`Scene`](durer_scene::Scene) prepared for rendering. [`render`] makes a
//! [`Film`](film::Film) from it, and the film can be saved as a file.
//!
//! ```
//! use durer_math::Point3;
//! use durer_render::{Progress, RenderSettings, World, render};
//! use durer_scene::{Camera, Colour, Finish, Light, Object, Pigment, Rgb, Scene, Shape, Texture};
//!
//! let red = Pigment::solid(Colour::opaque(Rgb::new(1.0, 0.0, 0.0)));
//! let scene = Scene {
//!     objects: vec![
//!         Object::new(Shape::Sphere { centre: Point3::new(0.0, 0.0, 5.0), radius: 1.0 })
//!             .with_texture(Texture::plain(red, Finish::default())),
//!     ],
//!     lights: vec![Light::point(Point3::new(0.0, 0.0, -100.0), Rgb::WHITE)],
//!     camera: Some(Camera::default()),
//!     ..Scene::default()
//! };
//! let world = World::new(&scene)?;
//! let settings = RenderSettings { width: 5, height: 5, ..RenderSettings::default() };
//! let film = render(&world, &settings, &Progress::none())?.film;
//! let middle = film.light(2, 2).unwrap();
//! assert!((middle[0] - 0.7).abs() < 1e-9 && middle[1] == 0.0); // ambient 0.1, diffuse 0.6
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! No epsilons are used: a secondary ray starts at a point that
//! [`SurfacePoint`](durer_surfaces::SurfacePoint) proves to be on the right side of the surface.
#![forbid(unsafe_code)]

pub mod camera;
pub mod film;
mod fog;
mod function_values;
mod integrator;
mod interactive;
mod lanes;
mod light;
mod material;
mod medium;
mod pigment_colours;
mod power;
mod progress;
mod rainbow;
mod ray_end;
mod render;
mod sampler;
mod settings;
mod sky;
mod stats;
mod texture;
mod vector;
mod world;

pub use crate::function_values::FunctionValues;
pub use crate::integrator::{RayKind, RayTree, ShadowRay, TracedRay};
pub use crate::interactive::PixelTracer;
pub use crate::pigment_colours::PigmentColours;
pub use crate::progress::{Progress, Status};
pub use crate::render::{RenderError, Rendered, render};
pub use crate::settings::{AntiAliasing, Region, RenderSettings};
pub use crate::stats::RayCounts;
pub use crate::world::{World, WorldError};
