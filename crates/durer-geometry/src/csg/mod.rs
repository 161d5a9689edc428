//! Constructive solid geometry: unions, intersections and differences of solids, nested in any way,
//! as one body.
//!
//! A ray's crossings with all leaves are events on its line: an enclosure, a sign, a leaf. Walking
//! along them, each leaf is in or out, and the Boolean tree of these bits says whether the ray is
//! in the body; where that changes, there is a crossing of the body (R. A. Goldstein, R. Nagel,
//! "3-D visual simulation", Simulation 16(1), 1971; S. D. Roth, "Ray casting for modeling solids",
//! Computer Graphics and Image Processing 18, 1982).
//!
//! Events of different leaves whose enclosures overlap, directly or through others, cannot be put
//! in order. They form a *tie*: all its bits change at once, and only the tree before and after
//! counts. That is the regularised result (R. B. Tilove, "Set membership classification", IEEE
//! Transactions on Computers C-29, 1980): `A - B` has no skin where both have a common face, bodies
//! that touch fuse, and no sheet of zero thickness appears, however deep the nesting. No tolerance
//! is involved.
//!
//! `tree` is the Boolean part, `compound` a body with its leaves, `trace` what a ray asks of them
//! and `sweep` the walk along the answers, `arena` bodies as a geometry holds them, and `lanes`
//! what eight rays see of them at a time.

mod arena;
mod compound;
mod packet;
mod sweep;
mod trace;
mod tree;

pub(crate) use self::arena::{Compounds, same_surface};
pub use self::compound::{Compound, CompoundBuilder, CsgError, Part, Shown};
pub(crate) use self::packet::{Memory, PacketCsg};
