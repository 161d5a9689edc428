//! Surfaces made from surfaces.

pub mod affine;
pub mod clip;
mod flat;
pub mod inverse;
