//! A surface behind a pointer, for rare kinds and combinations that do not justify an arena of
//! their own, with its code.

use crate::compose::clip::Algebraic;
use crate::compose::region::Region;
use crate::packet::FilterSource;
use crate::{
    Accelerate, Forward, HalfSpace, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Isa, RaySide, Shaft};
use durer_roots::quadratic::Quadratic;
use std::sync::Arc;

/// A surface of any type, with the same answers as the surface it wraps.
///
/// ```
/// use durer_math::{Affine, Point3, Vec3};
/// use durer_surfaces::{AxisBox, DynSurface, Placed, Sphere, Surface};
///
/// // Two kinds in one array, and one type for both where they are placed.
/// let unit = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0))?;
/// let both = [DynSurface::new(Sphere::new(Point3::ORIGIN, 1.0)?), DynSurface::new(unit)];
/// let map = Affine::translation(Vec3::X)?;
/// let moved = both.map(|s| Placed::new(s, map));
/// assert_eq!(moved[1].bounds().max, Point3::new(2.0, 1.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct DynSurface {
    surface: Arc<dyn Dynamic>,
    /// The instruction set with which the wrapped surface's methods run.
    isa: Isa,
}

/// [`Algebraic`] without its generic methods.
trait Dynamic: Algebraic {
    fn roots_dyn(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink);
    fn part_roots_dyn(&self, isa: Isa, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink);
    fn resolve_dyn(&self, isa: Isa, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;
}

impl<S: Algebraic> Dynamic for S {
    fn roots_dyn(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        isa.run(
            #[inline(always)]
            || self.roots(ray, sink),
        );
    }

    fn part_roots_dyn(&self, isa: Isa, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        // A surface of one part needs no second copy of the code.
        if !self.is_in_parts() {
            return self.roots_dyn(isa, ray, sink);
        }
        isa.run(
            #[inline(always)]
            || self.part_roots(part, ray, sink),
        );
    }

    fn resolve_dyn(&self, isa: Isa, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        isa.run(
            #[inline(always)]
            || self.resolve(ray, root, need),
        )
    }
}

impl DynSurface {
    /// `surface` behind a pointer.
    pub fn new<S: Algebraic + 'static>(surface: S) -> Self {
        Self { surface: Arc::new(surface), isa: Isa::detect() }
    }
}

impl Surface for DynSurface {
    fn bounds(&self) -> Aabb {
        self.surface.bounds()
    }

    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.surface.roots_dyn(self.isa, ray, &mut Forward(sink));
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.surface.resolve_dyn(self.isa, ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        self.surface.solidity()
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.surface.side(point)
    }
}

impl Accelerate for DynSurface {
    fn name(&self) -> &'static str {
        self.surface.name()
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        self.surface.bounds_through(map)
    }

    fn inner_bounds(&self) -> Aabb {
        self.surface.inner_bounds()
    }

    fn half_space(&self) -> Option<HalfSpace> {
        self.surface.half_space()
    }

    fn misses(&self, shaft: &Shaft) -> bool {
        self.surface.misses(shaft)
    }

    fn is_left(&self, side: RaySide, shaft: &Shaft) -> bool {
        self.surface.is_left(side, shaft)
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        self.surface.parts(f);
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        self.surface.packet_filter(part)
    }

    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        self.surface.solid_packet_filter()
    }

    fn is_in_parts(&self) -> bool {
        self.surface.is_in_parts()
    }

    fn primitive_of(&self, part: PartId) -> u32 {
        self.surface.primitive_of(part)
    }

    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        self.surface.part_roots_dyn(self.isa, part, ray, &mut Forward(sink));
    }
}

impl Algebraic for DynSurface {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        self.surface.polynomial(face, ray)
    }

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        self.surface.wide_polynomial(face, ray)
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        self.surface.sign_at_root(ray, root, q)
    }

    fn bounds_among(&self, regions: &[Region], map: Option<&Affine>) -> Aabb {
        self.surface.bounds_among(regions, map)
    }
}

/// Equal if both are the same surface in memory; their numbers are not compared.
impl PartialEq for DynSurface {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
    }
}

impl core::fmt::Debug for DynSurface {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("DynSurface").field("bounds", &self.bounds()).finish_non_exhaustive()
    }
}
