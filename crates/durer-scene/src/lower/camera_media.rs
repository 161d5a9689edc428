//! Solids in which camera rays may start.

use durer_geometry::Compound;
use durer_math::{Aabb, Point3, Shaft};
use durer_surfaces::{LocalPoint, Side, Surface};
use std::sync::Arc;

/// A solid that contains the camera or may contain it.
pub(super) trait Enclosure: Send + Sync {
    /// Whether a point lies inside it; a point on its surface does not.
    fn holds(&self, p: Point3) -> bool;

    /// Whether all points of a box lie inside it. `None` unless certainly all of them do or none
    /// does.
    fn holds_all(&self, region: &Aabb) -> Option<bool>;
}

/// A solid, or the complement of one.
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

    /// If the surface does not pass through the box, all points are on the same side.
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
