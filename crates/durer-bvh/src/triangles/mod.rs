//! Triangles: the tree's fast leaf.
//!
//! A leaf of triangles is a [block](block) of sixteen in f32, and a [filter] decides for most of
//! them with certainty whether the ray hits them. Where f32 cannot decide, and where the bounds of
//! two hits overlap, the caller decides, who knows the triangles' exact corners. So the answers are
//! those of exact arithmetic at the price of f32. A ray needs about one exact test: that for the
//! parameter of the triangle that it hits.

mod block;
mod filter;

pub use block::Corners;
pub(crate) use block::{Block, LANES};
pub(crate) use filter::{FAR, FLAT, Filter, NEAR, ROUGH, Verdict};
