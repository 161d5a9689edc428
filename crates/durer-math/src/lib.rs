//! Points, vectors, rays and affine maps, and arithmetic that knows its own error.
#![deny(unsafe_code)]

pub mod eft;
mod ray;
mod ring;
mod scalar;
mod vector;

pub use crate::ray::{Ray, RaySide, Source};
pub use crate::ring::Ring;
pub use crate::scalar::Scalar;
pub use crate::vector::{Normal3, Point3, Vec3};
