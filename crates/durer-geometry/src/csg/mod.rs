//! Constructive solid geometry: unions, intersections and differences of solids, nested in any way,
//! as one solid.
//!
//! A ray's crossings with all leaves are events on its line: a bracket, a sign, a leaf. In a sweep
//! along them each leaf is in or out, and the Boolean tree of these bits decides whether the ray is
//! in the CSG solid; where that changes, there is a crossing of the solid (R. A. Goldstein, R.
//! Nagel, "3-D visual simulation", Simulation 16(1), 1971; S. D. Roth, "Ray casting for modeling
//! solids", Computer Graphics and Image Processing 18, 1982).
//!
//! Events of different leaves whose brackets overlap, directly or through others, cannot be put in
//! order. They form a *tie*: all its bits change at once, and only the tree before and after
//! counts. That is the regularised result (R. B. Tilove, "Set membership classification", IEEE
//! Transactions on Computers C-29, 1980): `A - B` has no skin where both have a common face, solids
//! that touch fuse, and no sheet of zero thickness appears, however deep the nesting. No tolerance
//! is involved.
//!
//! `tree` is the Boolean part, `compound` a solid with its leaves, `trace` the search for a ray's
//! crossings and `sweep` the sweep along them, `arena` the CSG solids of a geometry, and `packet`
//! the filter for eight rays at a time.

mod arena;
mod compound;
mod packet;
mod sweep;
mod trace;
mod tree;

pub(crate) use self::arena::{Compounds, same_surface};
pub use self::compound::{Compound, CompoundBuilder, CsgError, Part, Shown};
pub(crate) use self::packet::{Memory, PacketCsg};
