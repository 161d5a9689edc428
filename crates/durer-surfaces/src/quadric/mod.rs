//! Quadrics, and solids bounded by them.
//!
//! [`boolean_faces`] holds the method that all share; [`form`] the arithmetic of one quadric along
//! one ray; each other file one surface.

pub mod axial;
pub mod boolean_faces;
pub mod cone;
pub mod cylinder;
pub mod ellipsoid;
pub mod extent;
pub mod form;
pub mod general;
pub mod hyperboloid;
pub mod paraboloid;
pub mod round;
pub mod sector;
pub mod solid;
#[cfg(test)]
mod tests;
