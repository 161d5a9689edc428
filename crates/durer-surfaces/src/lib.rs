//! Exact surfaces. Each answers one question: *where does this ray meet you?*
#![forbid(unsafe_code)]

mod local;
mod point;
mod sink;
mod surface;

pub use crate::local::{CentredRay, End, LocalPoint, LocalRay, RingRay};
pub use crate::point::SurfacePoint;
pub use crate::sink::{All, Any, Closest, Flow, Sink};
pub use crate::surface::{Kind, Need, PartId, Root, Side, Solidity, Surface};
