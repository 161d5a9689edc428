//! Triangles: the tree's fast leaf.
//!
//! A leaf of triangles is a [block](block) of sixteen in f32, and a [filter] tells of most of them
//! for certain whether the ray meets them. What f32 cannot tell, and which of two hits comes first
//! where their bounds overlap, is asked of the caller, who knows the triangles' exact corners: so
//! the answers are those of exact arithmetic, at the price of f32. A ray asks about once: for the
//! exact parameter of the triangle that it hits.

mod block;
mod filter;

pub use block::Corners;
pub(crate) use block::{Block, LANES};
pub(crate) use filter::{FAR, FLAT, Filter, NEAR, ROUGH, Verdict};
