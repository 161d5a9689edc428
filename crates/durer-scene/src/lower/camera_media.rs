//! Solids that rays of the camera may start in.

use durer_geometry::Compound;
use durer_math::{Aabb, Point3, Shaft};
use durer_surfaces::{LocalPoint, Side, Surface};
use std::sync::Arc;

/// A solid around the camera, or near it.
pub(super) trait Enclosure: Send + Sync {
    /// Whether a point lies in it; what is on its surface does not.
    fn holds(&self, p: Point3) -> bool;

    /// Whether all points of a box lie in it, if certainly either all do or none.
    fn holds_all(&self, region: &Aabb) -> Option<bool>;
}

/// A solid, or what is left of space without it.
pub(super) struct Held<S> {
    pub(super) solid: S,
    pub(super) inverse: bool,
}

impl<S: Surface> Enclosure for Held<S> {
    fn holds(&self, p: Point3) -> bool {
        match self.solid.side(&LocalPoint::new(p)) {
            Side::In => !self.inverse,
            Side::Out => self.inverse,
            Side::On => false,
        }
    }

    /// Where the surface does not pass between points they are all on one side.
    fn holds_all(&self, region: &Aabb) -> Option<bool> {
        self.solid.misses(&Shaft::between(*region, *region)).then(|| self.holds(region.centre()))
    }
}

impl Enclosure for Arc<Compound> {
    fn holds(&self, p: Point3) -> bool {
        self.side(&LocalPoint::new(p)) == Side::In
    }

    fn holds_all(&self, region: &Aabb) -> Option<bool> {
        self.bounds().intersection(*region).is_empty().then_some(false)
    }
}
