//! Surfaces made from surfaces.

pub mod affine;
pub mod clip;
pub mod erased;
mod flat;
pub mod inverse;
pub mod region;
