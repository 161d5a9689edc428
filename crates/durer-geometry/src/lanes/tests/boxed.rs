//! A surface behind a pointer, so that every placement is compiled once and not for every surface.

use durer_math::{Aabb, Affine, RaySide, Shaft};
use durer_surfaces::outline::Sketch;
use durer_surfaces::{
    Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint,
};
use std::sync::Arc;

/// Any surface. What it answers is what the surface within answers.
#[derive(Clone)]
pub(super) struct Boxed(Arc<dyn Dynamic>);

/// [`Surface`] without its generic methods.
trait Dynamic: Surface {
    fn roots_dyn(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink);
    fn part_roots_dyn(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink);
}

impl<S: Surface> Dynamic for S {
    fn roots_dyn(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        self.roots(ray, sink);
    }

    fn part_roots_dyn(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        self.part_roots(part, ray, sink);
    }
}

impl Boxed {
    pub(super) fn new<S: Surface + 'static>(surface: S) -> Self {
        Self(Arc::new(surface))
    }
}

impl Surface for Boxed {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        self.0.bounds_through(map)
    }

    fn misses(&self, shaft: &Shaft) -> bool {
        self.0.misses(shaft)
    }

    fn is_left(&self, side: RaySide, shaft: &Shaft) -> bool {
        self.0.is_left(side, shaft)
    }

    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.0.roots_dyn(ray, &mut Forward(sink));
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.0.resolve(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        self.0.solidity()
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.0.side(point)
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        self.0.parts(f);
    }

    fn sketch(&self, part: PartId) -> Sketch {
        self.0.sketch(part)
    }

    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        self.0.part_roots_dyn(part, ray, &mut Forward(sink));
    }
}
