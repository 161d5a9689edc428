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
#![forbid(unsafe_code)]

pub use durer_bvh as bvh;
pub use durer_geometry as geometry;
pub use durer_math as math;
pub use durer_mesh as mesh;
pub use durer_pov as pov;
pub use durer_render as render;
pub use durer_scene as scene;
pub use durer_surfaces as surfaces;

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
