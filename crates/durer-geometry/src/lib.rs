//! A built, immutable scene of surfaces: where does a ray hit it?
//!
//! ```
//! use durer_geometry::Geometry;
//! use durer_math::{Point3, Ray, Vec3};
//! use durer_surfaces::{Plane, Sphere};
//!
//! let ball = Sphere::new(Point3::new(0.0, 1.0, 0.0), 1.0)?;
//! let ground = Plane::new(Vec3::Y, 0.0)?;
//! let scene = Geometry::builder().with(ball).with(ground).build()?;
//!
//! let ray = Ray::new(Point3::new(0.0, 5.0, 0.0), -Vec3::Y);
//! let hit = scene.closest(&ray).unwrap();
//! assert_eq!((hit.object.0, hit.t), (0, 3.0)); // the ball's top
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
//! A [`Builder`] takes surfaces of any type and instances of other geometries; a [`Geometry`]
//! answers queries. Surfaces live in one array per type, in the order of the leaves of a
//! [`durer_bvh`] tree; unbounded surfaces are tested beside the tree. Answers do not depend on the
//! tree, the instruction set or the number of threads.
//!
//! | module | what it holds |
//! |---|---|
//! | `query` | closest, any and all for one ray |
//! | `spans` | intervals inside solids |
//! | `batch` | the same for arrays of rays |
//! | `bundle` | the candidates of a bundle of rays that share one search |
//! | `packet` | eight rays at a time |
//! | `csg` | solids made of solids |
//! | `resolve` | hit points: position, bounds, normals, uv |
//! | `refit` | surfaces that move |
//! | `explain` | a report of every step of one ray |
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

pub use crate::batch::{Batch, Ragged};
pub use crate::builder::{BuildError, Builder};
pub use crate::bundle::CandidateList;
pub use crate::csg::{Compound, CompoundBuilder, CsgError, Part, Shown};
pub use crate::explain::{Event, Explanation, MOST_CROSSINGS, SurfaceCounts, Verdict};
pub use crate::geometry::Geometry;
pub use crate::hit::{Hit, LeafId, ObjectId, ObjectSpan, PrimitiveId, Span};
pub use crate::ids::EVERYTHING;
pub use crate::packet::{Hits8, Rays8, Scratch, Sources8};
pub use crate::query::Masked;
pub use crate::refit::RefitError;
pub use crate::stats::{Inventory, Stats};
pub use durer_bvh::{Quality, Settings};
