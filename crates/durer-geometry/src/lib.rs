//! The built, immutable world: where does this ray meet all that is in it?
//!
//! ```
//! use durer_geometry::Geometry;
//! use durer_math::{Point3, Ray, Vec3};
//! use durer_surfaces::{Plane, Sphere};
//!
//! let ball = Sphere::new(Point3::new(0.0, 1.0, 0.0), 1.0)?;
//! let ground = Plane::new(Vec3::Y, 0.0)?;
//! let scene = Geometry::builder().add(ball).add(ground).build()?;
//!
//! let ray = Ray::new(Point3::new(0.0, 5.0, 0.0), -Vec3::Y);
//! let hit = scene.closest(&ray).unwrap();
//! assert_eq!((hit.object, hit.t), (0, 3.0)); // the ball's top
//! assert!(hit.t_lo <= hit.t && hit.t <= hit.t_hi); // the exact crossing is in there
//!
//! let all = scene.all(&ray); // every crossing, once, ascending
//! assert_eq!(all.len(), 3);
//!
//! let spans = scene.spans(&ray); // in the ball, then below ground: they touch, so it is one span
//! assert_eq!((spans[0].t_in, spans[0].t_out), (3.0, f64::INFINITY));
//!
//! let point = scene.resolve(&ray, &hit); // position, error bounds, normals, uv ...
//! assert_eq!(point.p, Point3::new(0.0, 2.0, 0.0));
//! let mirrored = point.spawn(Vec3::Y); // a ray that leaves from the proven side: no epsilon
//! assert!(!scene.any(&mirrored));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Builder`] takes surfaces of any type and placements of other geometries; a [`Geometry`] answers. Surfaces live in one
//! array per type, in the order of the leaves of a [`durer_bvh`] tree; what is unbounded is tested beside it. Answers do not depend on
//! the tree, the instruction set or the number of threads.
//!
//! Closest, any and all are in `query`, bundles of rays that share one search in `candidates`, eight rays side by side in `lanes`, stretches inside solids in `spans`, solids made of solids in `csg`, points in `resolve`, many rays in `batch`, surfaces that move in `refit`, and the story of
//! one ray in `explain`.
#![forbid(unsafe_code)]

mod arena;
mod batch;
mod builder;
mod bundle;
mod closest;
mod context;
mod csg;
mod explain;
mod filter_cache;
mod geometry;
mod hit;
mod ids;
mod interleave;
mod packet;
mod query;
mod refit;
mod resolve;
mod spans;
mod stats;

pub use crate::batch::Ragged;
pub use crate::builder::{BuildError, Builder};
pub use crate::bundle::CandidateList;
pub use crate::csg::{Compound, CompoundBuilder, CsgError, Part, Shown};
pub use crate::explain::{Event, Explanation, Verdict};
pub use crate::geometry::Geometry;
pub use crate::hit::{Hit, ObjectId, Span};
pub use crate::ids::EVERYTHING;
pub use crate::packet::{Hits8, Rays8, Scratch, Sources8};
pub use crate::refit::RefitError;
pub use crate::stats::{Inventory, Stats};
pub use durer_bvh::{Quality, Settings};
