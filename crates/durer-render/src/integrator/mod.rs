//! Integrators: the light that comes along rays.

mod bundle;
mod direct_light;
mod group;
mod layers;
mod media;
mod record;
mod secondary;
mod shading_point;
mod shadow;
mod view;
mod whitted;

pub use self::record::{RayKind, RayTree, ShadowRay, TracedRay};
pub(crate) use self::whitted::Whitted;
