//! Surfaces made from surfaces.

pub mod affine;
pub mod clip;
pub mod complement;
pub mod dynamic;
pub(crate) mod flat;
pub mod region;
