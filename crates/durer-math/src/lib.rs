//! Points, vectors, rays and affine maps, and arithmetic that knows its own error.
#![deny(unsafe_code)]

mod aabb;
pub mod affine;
pub mod dd;
mod directions;
pub mod dual;
pub mod dyadic;
pub mod eft;
pub mod elementary;
pub mod expansion;
mod gamma;
pub mod interval;
pub mod kernels;
pub mod ladder;
pub mod predicates;
mod ray;
mod ring;
pub mod rounding;
pub mod run;
mod scalar;
pub mod scale;
mod vector;

pub use crate::aabb::Aabb;
pub use crate::affine::{Affine, AffineError, Matrix3};
pub use crate::dd::Dd;
pub use crate::directions::CombinationError;
pub use crate::dual::Dual;
pub use crate::dyadic::Dyadic;
pub use crate::expansion::Expansion;
pub use crate::gamma::{U, gamma};
pub use crate::interval::Interval;
pub use crate::kernels::{Isa, IsaError};
pub use crate::predicates::{Edge, EdgeRay};
pub use crate::ray::{Ray, RaySide, Source};
pub use crate::ring::Ring;
pub use crate::run::Run;
pub use crate::scalar::Scalar;
pub use crate::vector::{Normal3, Point3, Vec3};
