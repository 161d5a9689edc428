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
//! use durer::surfaces::{AxisBox, Sphere};
//! use durer::{Geometry, Point3, Ray, Vec3};
//!
//! let geometry = Geometry::builder()
//!     .with(Sphere::new(Point3::ORIGIN, 1.0)?)
//!     .with(AxisBox::new(Point3::new(2.0, -1.0, -1.0), Point3::new(3.0, 1.0, 1.0))?)
//!     .build()?;
//!
//! let ray = Ray::new(Point3::new(-5.0, 0.5, 0.0), Vec3::X);
//! let hits = geometry.all(&ray);                  // every crossing, in order
//! assert_eq!(hits.len(), 4);
//! assert!(hits.iter().all(|hit| hit.t_lo <= hit.t && hit.t <= hit.t_hi));
//! let first = geometry.closest(&ray).unwrap();    // the first of them
//! assert_eq!((first, first.object.0), (hits[0], 0));
//! let spans = geometry.spans(&ray);               // where the ray is inside solids
//! assert_eq!((spans[1].t_in, spans[1].t_out), (7.0, 8.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A hit gives the parameter on the ray. Its point gives the rest, and rays spawned from it start
//! on a proven side of the surface:
//!
//! ```
//! # use durer::surfaces::Sphere;
//! # use durer::{Geometry, Point3, Ray, Vec3};
//! # let geometry = Geometry::builder().with(Sphere::new(Point3::ORIGIN, 1.0)?).build()?;
//! # let ray = Ray::new(Point3::new(-5.0, 0.5, 0.0), Vec3::X);
//! # let hit = geometry.closest(&ray).unwrap();
//! let point = geometry.resolve(&ray, &hit);       // position, normals, uv, error bounds
//! assert!(point.off < 1e-15);                     // how far from the exact sphere it may be
//! let next = point.spawn(point.ng.to_vec());
//! assert!(!geometry.any(&next) && !geometry.contains(next.origin));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Any surface can be placed by a map. Masks select the rays that can hit it, and a batch traces
//! many rays at once, on all processors:
//!
//! ```
//! use durer::geometry::{ObjectId, PrimitiveId};
//! use durer::surfaces::{Axis, Place, Torus};
//! use durer::{Affine, Geometry, Point3, Ray, Vec3};
//!
//! let ring = Torus::new(Point3::ORIGIN, Axis::Y, 2.0, 0.5)?;
//! let turn = Affine::rotation_x(0.3)?.then(&Affine::translation(Vec3::new(0.0, 1.0, 0.0))?)?;
//! let mut builder = Geometry::builder();
//! builder.add_as(ring.clone(), ObjectId(0), PrimitiveId(0), 0b01);
//! builder.add_as(ring.placed(turn), ObjectId(1), PrimitiveId(0), 0b10);
//! let geometry = builder.build()?;
//!
//! let rays: Vec<Ray> =
//!     (-30..30).map(|i| Ray::new(Point3::new(0.1 * f64::from(i), 9.0, 0.0), -Vec3::Y)).collect();
//! let both = geometry.batch(&rays).all();         // the hits of ray i are both.of(i)
//! let second = geometry.masked(0b10).batch(&rays).threads(1).closest();
//! assert_eq!(both.offsets.len(), rays.len() + 1);
//! assert!(second.iter().flatten().all(|hit| hit.object == ObjectId(1)));
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

pub use durer_geometry::{Geometry, Hit, Span};
pub use durer_math::{Affine, Point3, Ray, Vec3};
pub use durer_surfaces::{Accelerate, Surface, SurfacePoint};

pub use durer_bvh as bvh;
pub use durer_formula as formula;
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
