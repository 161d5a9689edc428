//! The bounding volume hierarchy: which surfaces might this ray hit?
//!
//! Boxes are f32 and rays are f64. The tree never misses a box that the exact ray hits: boxes are
//! rounded outward, and the node test counts each of its own rounding errors as a possible hit. The
//! conservative test takes as many instructions as an unsafe one.
//!
//! ```
//! use durer_bvh::{Bvh, Frame, Leaf, Ray64, Settings};
//! use durer_math::{Aabb, Isa, Point3, Vec3};
//!
//! // A row of unit boxes along x.
//! let boxes: Vec<Aabb> = (0..100)
//!     .map(|i| Aabb::centred(Point3::new(2.0 * f64::from(i), 0.0, 0.0), Vec3::new(0.5, 0.5, 0.5)))
//!     .collect();
//! let extent = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
//! let frame = Frame::around(&extent);
//! let entries = boxes.iter().enumerate().map(|(i, b)| frame.entry(b, 0, i as u32)).collect();
//! let (tree, order) = Bvh::build(&frame, entries, &[None], &Settings::GOOD);
//!
//! let down = Ray64 {
//!     origin: Point3::new(42.0, 0.0, 9.0),
//!     direction: -Vec3::Z,
//!     origin_error: Vec3::ZERO,
//!     direction_error: Vec3::ZERO,
//!     t_min: 0.0,
//!     t_max: f64::INFINITY,
//!     inner: (0.0, f64::INFINITY),
//! };
//! let is_it = |slot: u32| order[0][slot as usize] == 21;
//! let test = |leaf: Leaf| (leaf.first..leaf.first + leaf.count).any(is_it);
//! let found = tree.any(Isa::detect(), &down, |_| false, test);
//! assert!(found);
//! ```
//!
//! [`Frame`] chooses the units and makes an [`Entry`] of each box. [`Bvh::build`] sorts entries
//! into nodes of sixteen children. Queries pass the [`Leaf`]s that matter to the caller:
//! [`Bvh::closest`] and [`Bvh::any`] for a ray ([`TreeRay`]), [`Bvh::in_shaft`] for a bundle,
//! [`Bvh::containing`] for a point. [`Bvh::trace`] reports each step of a query, [`Bvh::refit`]
//! follows surfaces that move, and [`Bvh::validate`] and [`Bvh::stats`] inspect the result.
//!
//! A tree knows boxes, numbers, and the f32 corners of triangles. What the numbers mean is the
//! caller's business.
#![deny(unsafe_code)]

mod batch;
mod build;
mod frame;
mod kernels;
mod node;
mod packet;
mod query;
mod ray;
mod refit;
mod shaft;
mod stats;
mod trace;
mod traverse;
mod tree;
mod triangles;
mod validate;

pub use crate::batch::Rays;
pub use crate::build::{CornersOf, Quality, Settings};
pub use crate::frame::{Entry, Frame};
pub use crate::node::{Leaf, MAX_ENTRIES};
pub use crate::ray::{PACKET, Packet32, Ray32, Ray64, TreeRay};
pub use crate::refit::RefitError;
pub use crate::stats::Stats;
pub use crate::trace::Step;
pub use crate::tree::Bvh;
pub use crate::triangles::Corners;
pub use crate::validate::Violation;
