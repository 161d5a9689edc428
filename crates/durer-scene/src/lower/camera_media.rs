//! Solids in which camera rays may start.

use std::sync::Arc;

use durer_geometry::Compound;
use durer_math::{Aabb, Point3, Ray, Shaft};
use durer_surfaces::{Accelerate, DynSurface, FirstCrossing, LocalPoint, LocalRay, Side, Surface};

/// A solid that contains the camera or may contain it.
pub(super) enum Enclosure {
    /// A solid of one surface.
    Solid(DynSurface),
    /// The complement of one.
    Complement(DynSurface),
    /// A solid made of solids.
    Compound(Arc<Compound>),
}

impl Enclosure {
    /// The side on which a point lies.
    pub(super) fn side(&self, p: Point3) -> Side {
        let p = LocalPoint::new(p);
        match self {
            Self::Solid(solid) => solid.side(&p),
            Self::Complement(solid) => match solid.side(&p) {
                Side::In => Side::Out,
                Side::Out => Side::In,
                Side::On => Side::On,
            },
            Self::Compound(solid) => solid.side(&p),
        }
    }

    /// Whether a ray that starts on the solid's surface goes into the solid.
    fn enters(&self, ray: &Ray) -> bool {
        let ray = LocalRay::new(ray);
        let enters_surface = |solid: &DynSurface| {
            let mut first = FirstCrossing::default();
            solid.roots(&ray, &mut first);
            first.enters()
        };
        match self {
            Self::Solid(solid) => enters_surface(solid),
            Self::Complement(solid) => !enters_surface(solid),
            Self::Compound(solid) => solid.enters(&ray),
        }
    }

    /// Whether a box holds all of it.
    pub(super) fn is_bounded(&self) -> bool {
        match self {
            Self::Solid(solid) => solid.bounds().is_bounded(),
            Self::Complement(_) => false,
            Self::Compound(solid) => solid.bounds().is_bounded(),
        }
    }

    /// Whether all points of a box lie inside it. `None` unless certainly all of them do or none
    /// does.
    pub(super) fn holds_all(&self, region: &Aabb) -> Option<bool> {
        match self {
            // If the surface does not pass through the box, all points are on the same side.
            Self::Solid(solid) | Self::Complement(solid) => {
                let is_missed = solid.misses(&Shaft::between(*region, *region));
                is_missed.then(|| self.side(region.centre()) == Side::In)
            }
            Self::Compound(solid) => solid.bounds().intersection(*region).is_empty().then_some(false),
        }
    }

    /// Whether a ray starts inside: at a point inside, or on the surface and into the solid.
    pub(super) fn holds_start(&self, ray: &Ray) -> bool {
        match self.side(ray.origin) {
            Side::In => true,
            Side::Out => false,
            Side::On => self.enters(ray),
        }
    }
}
