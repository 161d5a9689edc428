//! Surfaces made from surfaces.

pub mod affine;
pub mod clip;
pub mod complement;
pub mod dynamic;
pub mod region;

#[cfg(test)]
mod flat_tests;
