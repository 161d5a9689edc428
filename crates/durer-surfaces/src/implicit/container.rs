//! The container that bounds a formula's surface.

use crate::packet::FilterSource;
use crate::{
    Accelerate, AxisBox, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Sphere, Surface, SurfacePoint,
};
use durer_math::{Aabb, Affine};

/// A box or a ball.
#[derive(Clone, Debug, PartialEq)]
pub enum Container {
    /// A box.
    Box(AxisBox),
    /// A ball.
    Ball(Sphere),
}

impl Container {
    pub(super) fn bounds(&self) -> Aabb {
        match self {
            Self::Box(it) => it.bounds(),
            Self::Ball(it) => Surface::bounds(it),
        }
    }

    pub(super) fn bounds_through(&self, map: &Affine) -> Aabb {
        match self {
            Self::Box(it) => it.bounds_through(map),
            Self::Ball(it) => it.bounds_through(map),
        }
    }

    #[inline(always)]
    pub(super) fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        match self {
            Self::Box(it) => it.roots(ray, sink),
            Self::Ball(it) => it.roots(ray, sink),
        }
    }

    pub(super) fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        match self {
            Self::Box(it) => it.resolve(ray, root, need),
            Self::Ball(it) => it.resolve(ray, root, need),
        }
    }

    pub(super) fn packet_filter(&self) -> FilterSource {
        match self {
            Self::Box(it) => it.packet_filter(PartId(0)),
            Self::Ball(it) => it.packet_filter(PartId(0)),
        }
    }

    pub(super) fn side(&self, point: &LocalPoint<'_>) -> Side {
        match self {
            Self::Box(it) => it.side(point),
            Self::Ball(it) => it.side(point),
        }
    }
}
