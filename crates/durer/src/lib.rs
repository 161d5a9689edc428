//! Where does this ray meet that surface? Every crossing, once, with a proven bound.
//!
//! This crate is the facade: each capability of durer lives in a crate of its own and appears here
//! by name.
//!
//! - [`math`]: points, vectors, rays, affine maps, and arithmetic that knows its own error.
//! - [`surfaces`]: the surfaces; each answers with brackets that provably hold the crossing.
//! - [`bvh`]: the tree over any of them.
//! - [`geometry`]: the built world, and its queries for one ray and for batches.
//! - [`scene`]: a scene as plain data; [`pov`] reads one from POV-Ray's language, [`mesh`] from
//!   mesh files.
//! - [`render`]: cameras, lights, textures and Whitted's recursion.
//!
//! # A tour
//!
//! Surfaces go into a geometry, which answers rays:
//!
//! ```
//! use durer::geometry::Geometry;
//! use durer::math::{Point3, Ray, Vec3};
//! use durer::surfaces::{AxisBox, Sphere};
//!
//! let mut builder = Geometry::builder();
//! builder.add(Sphere::new(Point3::new(0.0, 0.0, 0.0), 1.0)?);
//! builder.add(AxisBox::new(Point3::new(2.0, -1.0, -1.0), Point3::new(3.0, 1.0, 1.0))?);
//! let geometry = builder.build()?;
//!
//! let ray = Ray::new(Point3::new(-5.0, 0.5, 0.0), Vec3::new(1.0, 0.0, 0.0));
//! let hits = geometry.all(&ray);                  // every crossing, in order
//! assert_eq!(hits.len(), 4);
//! assert!(hits.iter().all(|hit| hit.t_lo <= hit.t && hit.t <= hit.t_hi));
//! let spans = geometry.spans(&ray);               // where the ray is inside solids
//! assert_eq!((spans[1].t_in, spans[1].t_out), (7.0, 8.0));
//! let point = geometry.resolve(&ray, &hits[0]);   // position, normals, error bounds
//! let next = point.spawn(point.ng.to_vec());      // starts provably outside the sphere
//! assert!(!geometry.any(&next) && !geometry.contains(next.origin));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A scene file becomes plain data, and the data a picture:
//!
//! ```no_run
//! use durer::render::{Progress, RenderSettings, World, render};
//!
//! let read = durer::pov::read("scene.pov".as_ref(), &durer::pov::ReadOptions::default())?;
//! let world = World::new(&read.scene)?;
//! let film = render(&world, &RenderSettings::default(), &Progress::none())?.film;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub use durer_bvh as bvh;
pub use durer_geometry as geometry;
pub use durer_math as math;
pub use durer_mesh as mesh;
pub use durer_pov as pov;
pub use durer_render as render;
pub use durer_scene as scene;
pub use durer_surfaces as surfaces;

/// The examples of the page about a surface of your own, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/own_surface.md")]
struct OwnSurface;

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
