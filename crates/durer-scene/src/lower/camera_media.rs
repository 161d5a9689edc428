//! Solids in which camera rays may start.

use durer_geometry::Compound;
use durer_math::{Aabb, Point3, Ray, Shaft};
use durer_surfaces::{Accelerate, FirstCrossing, LocalPoint, LocalRay, Side};
use std::sync::Arc;

/// A solid that contains the camera or may contain it.
pub(super) trait Enclosure: Send + Sync {
    /// The side on which a point lies.
    fn side(&self, p: Point3) -> Side;

    /// Whether a ray that starts on the solid's surface goes into the solid.
    fn enters(&self, ray: &Ray) -> bool;

    /// Whether a box holds all of it.
    fn is_bounded(&self) -> bool;

    /// Whether all points of a box lie inside it. `None` unless certainly all of them do or none
    /// does.
    fn holds_all(&self, region: &Aabb) -> Option<bool>;

    /// Whether a ray starts inside: at a point inside, or on the surface and into the solid.
    fn holds_start(&self, ray: &Ray) -> bool {
        match self.side(ray.origin) {
            Side::In => true,
            Side::Out => false,
            Side::On => self.enters(ray),
        }
    }
}

/// A solid, or the complement of one.
pub(super) struct Held<S> {
    pub(super) solid: S,
    pub(super) inverse: bool,
}

impl<S: Accelerate> Enclosure for Held<S> {
    fn side(&self, p: Point3) -> Side {
        match self.solid.side(&LocalPoint::new(p)) {
            Side::In if self.inverse => Side::Out,
            Side::Out if self.inverse => Side::In,
            side => side,
        }
    }

    fn enters(&self, ray: &Ray) -> bool {
        let mut first = FirstCrossing::default();
        self.solid.roots(&LocalRay::new(ray), &mut first);
        first.enters() != self.inverse
    }

    fn is_bounded(&self) -> bool {
        !self.inverse && self.solid.bounds().is_bounded()
    }

    /// If the surface does not pass through the box, all points are on the same side.
    fn holds_all(&self, region: &Aabb) -> Option<bool> {
        let is_missed = self.solid.misses(&Shaft::between(*region, *region));
        is_missed.then(|| self.side(region.centre()) == Side::In)
    }
}

impl Enclosure for Arc<Compound> {
    fn side(&self, p: Point3) -> Side {
        Compound::side(self, &LocalPoint::new(p))
    }

    fn enters(&self, ray: &Ray) -> bool {
        Compound::enters(self, &LocalRay::new(ray))
    }

    fn is_bounded(&self) -> bool {
        self.bounds().is_bounded()
    }

    fn holds_all(&self, region: &Aabb) -> Option<bool> {
        self.bounds().intersection(*region).is_empty().then_some(false)
    }
}
