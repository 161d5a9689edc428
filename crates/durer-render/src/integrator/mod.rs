//! Integrators: how much light comes along rays.

mod bundle;
mod coats;
mod lamps;
mod media;
mod onward;
mod shadow;
mod split;
mod spot;
mod whitted;

pub(crate) use self::whitted::Whitted;
