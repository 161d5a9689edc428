//! Points, vectors, rays and affine maps, and arithmetic with proven error bounds.
//!
//! Everything that durer claims about a hit rests on two questions that this crate answers: *how
//! far can this number be from the true one?* and *what is the sign of this expression, exactly?* A
//! formula is written once, generic over [`Ring`], and evaluated ever more precisely until its sign
//! is certain:
//!
//! ```
//! use core::cmp::Ordering;
//! use durer_math::ladder::{self, Predicate};
//! use durer_math::{Point3, Ray, Ring, EFloat, Vec3};
//!
//! /// Does the line of `ray` meet the unit sphere? The discriminant `(o.d)^2 - d.d (o.o - 1)`.
//! struct MeetsUnitSphere(Ray);
//!
//! impl Predicate for MeetsUnitSphere {
//!     fn eval<T: Ring>(&self) -> Option<T> {
//!         let o = self.0.origin.to_array().map(T::exact);
//!         let d = self.0.direction.to_array().map(T::exact);
//!         let dot = |a: &[T; 3], b: &[T; 3]| {
//!             let term = |i: usize| a[i].clone() * b[i].clone();
//!             term(0) + term(1) + term(2)
//!         };
//!         Some(dot(&o, &d).square() - dot(&d, &d) * (dot(&o, &o) - T::exact(1.0)))
//!     }
//! }
//!
//! let aimed_at = |y: f64| MeetsUnitSphere(Ray::new(Point3::new(1e6, y, 0.0), Vec3::new(-3.0, 0.0, 0.0)));
//! assert_eq!(ladder::sign(&aimed_at(1.0)), Some(Ordering::Equal)); // tangent, exactly
//! assert_eq!(ladder::sign(&aimed_at(1.0_f64.next_down())), Some(Ordering::Greater)); // one ulp lower it meets
//! assert_eq!(ladder::sign(&aimed_at(1.0_f64.next_up())), Some(Ordering::Less)); // one ulp higher it does not
//!
//! // f64 alone cannot know that, and says so:
//! let in_f64: EFloat = aimed_at(1.0_f64.next_up()).eval().unwrap();
//! assert_eq!(in_f64.sign(), None);
//! ```
//!
//! **Geometry.** [`Point3`], [`Vec3`] and [`Normal3`] are three types, generic over a [`Scalar`]:
//! f64, [`Interval`] or a dual number. [`Ray`] is `o + t d` with a direction of any length; [`Affine`]
//! is `c + L x` with a proven bound on its rounded inverse; [`Aabb`] a box, and a conservative
//! bound.
//!
//! **Numbers, by rising cost.** [`eft`] gives sums and products with their exact errors; [`EFloat`]
//! a value with its running error; [`rounding`] and [`Interval`] directed rounding; [`Dd`] 106
//! bits; [`Dyadic`] is exact. [`ladder`] goes from one to the next, and [`predicates`] holds the
//! one decision that must be faster than that: on which side a ray passes an edge.
//!
//! **The same bits everywhere.** [`elementary`] replaces the C library's functions, and
//! [`Isa::run`] is the only access to the CPU's vector and fused instructions; `unsafe` is confined
//! to its module.
//!
//! Deliberately absent: surfaces, colour, files, and allocation on any hot path ([`Dyadic`] alone
//! may allocate, at the end of the ladder).
#![deny(unsafe_code)]

mod aabb;
pub mod affine;
pub mod dd;
mod directions;
pub mod dyadic;
pub mod efloat;
pub mod eft;
pub mod elementary;
mod exact_sum;
mod gamma;
pub mod interval;
pub mod kernels;
pub mod ladder;
pub mod lanes;
pub mod predicates;
mod ray;
pub mod real;
mod ring;
pub mod rounding;
mod scalar;
pub mod scale;
mod shaft;
mod vector;

pub use crate::aabb::Aabb;
pub use crate::affine::{Affine, AffineError, Matrix3};
pub use crate::dd::Dd;
pub use crate::directions::CombinationError;
pub use crate::dyadic::Dyadic;
pub use crate::efloat::EFloat;
pub use crate::gamma::{U, gamma};
pub use crate::interval::Interval;
pub use crate::kernels::{Isa, IsaError};
pub use crate::lanes::{F8, M8};
pub use crate::predicates::{Edge, EdgeRay};
pub use crate::ray::{Ray, RaySide, Source};
pub use crate::ring::Ring;
pub use crate::scalar::Scalar;
pub use crate::shaft::{Shaft, Shaft8};
pub use crate::vector::{Normal3, Point3, Vec3};
