//! Integrators: how much light comes along a ray.

mod cells;
mod shadow;
mod whitted;

pub(crate) use self::whitted::Whitted;
