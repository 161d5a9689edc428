//! A surface behind a pointer: for the rarer kinds and combinations, which are not worth an array (and its code) of their own.

use durer_math::{Aabb, Affine, Isa};
use durer_surfaces::outline::Sketch;
use durer_surfaces::{
    Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint,
};
use std::sync::Arc;

/// Any surface. What it answers is what the surface within answers.
#[derive(Clone)]
pub(super) struct Erased {
    surface: Arc<dyn Dynamic>,
    /// The code within is entered through the feature door too.
    isa: Isa,
}

/// [`Surface`] without its generic methods.
trait Dynamic: Surface {
    fn roots_dyn(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink);
    fn part_roots_dyn(&self, isa: Isa, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink);
    fn resolve_dyn(&self, isa: Isa, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;
}

impl<S: Surface> Dynamic for S {
    fn roots_dyn(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        isa.run(
            #[inline(always)]
            || self.roots(ray, sink),
        );
    }

    fn part_roots_dyn(&self, isa: Isa, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
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

impl Erased {
    pub(super) fn new<S: Surface + 'static>(surface: S) -> Self {
        Self { surface: Arc::new(surface), isa: Isa::detect() }
    }
}

impl Surface for Erased {
    fn bounds(&self) -> Aabb {
        self.surface.bounds()
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        self.surface.bounds_through(map)
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

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        self.surface.parts(f);
    }

    fn sketch(&self, part: PartId) -> Sketch {
        self.surface.sketch(part)
    }

    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        self.surface.part_roots_dyn(self.isa, part, ray, &mut Forward(sink));
    }
}
