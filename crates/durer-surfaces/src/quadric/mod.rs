//! Quadrics, and solids bounded by them.
//!
//! [`boolean_faces`](crate::faces::boolean_faces) holds the method that all share; each file is one
//! surface.

pub mod axial;
pub mod cone;
pub mod cylinder;
pub mod ellipsoid;
pub mod general;
pub mod hyperboloid;
pub mod paraboloid;
pub mod round;
pub mod sector;
pub mod solid;
#[cfg(test)]
mod tests;
