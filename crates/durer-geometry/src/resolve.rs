//! From a hit to a point of a surface, and the side of all solids on which a point lies.

use crate::Hit;
use crate::csg::same_surface;
use crate::geometry::{Geometry, slots};
use durer_math::{Point3, Ray, RaySide, Source};
use durer_surfaces::{LocalPoint, LocalRay, Need, Side, SurfacePoint};

impl Geometry {
    /// Everything about the point of a hit that one of this geometry's queries returned for this
    /// very ray.
    pub fn resolve(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.resolve_with(ray, hit, Need::ALL)
    }

    /// [`Geometry::resolve`], as far as `need` requires.
    ///
    /// # Panics
    ///
    /// If the hit is not one of this geometry's.
    pub fn resolve_with(&self, ray: &Ray, hit: &Hit, need: Need) -> SurfacePoint {
        self.point_of(&LocalRay::new(ray), ray.source(), hit, need)
    }

    /// The point of a hit on a ray that was spawned from `source`.
    #[inline(always)]
    pub(crate) fn point_of(
        &self,
        local: &LocalRay<'_>,
        source: Option<Source>,
        hit: &Hit,
        need: Need,
    ) -> SurfacePoint {
        let source = source.filter(|s| {
            s.arena == hit.arena && same_surface(s.index, hit.slot) && s.instance == hit.instance
        });
        let (mut point, part) = match source {
            None => self.resolve_in(local, hit.instance, hit, need),
            Some(s) => self.resolve_in(&local.from_side(Some(s.side)), hit.instance, hit, need),
        };
        point.source = Some(Source {
            arena: hit.arena,
            index: hit.slot,
            part,
            face: hit.face,
            instance: hit.instance,
            side: RaySide::Front,
        });
        point
    }

    /// Resolves in this geometry's frame: `placement` is counted from this geometry's own.
    fn resolve_in(&self, ray: &LocalRay<'_>, placement: u32, hit: &Hit, need: Need) -> (SurfacePoint, u32) {
        let Some(instance) = self.instance_of(placement) else {
            let arena = &self.arenas[hit.arena as usize];
            return (arena.resolve(self.isa, hit.slot, ray, &hit.root(), need), arena.part(hit.slot).0);
        };
        let inner = placement - instance.first_placement;
        let mut part = 0;
        let point = ray.resolve_through(&instance.affine, |local| {
            let (point, its) = instance.geometry.resolve_in(local, inner, hit, need);
            part = its;
            point
        });
        (point, part)
    }

    /// The exact side of the union of all solids on which a point lies. A point on the common
    /// border of two solids that touch is [`Side::On`].
    pub fn side(&self, point: Point3) -> Side {
        if !point.is_finite() {
            return Side::Out;
        }
        self.side_of(&LocalPoint::new(point))
    }

    fn side_of(&self, point: &LocalPoint<'_>) -> Side {
        let mut found = Side::Out;
        // Takes one side into account; returns whether the result is final.
        let mut learn = |side: Side| {
            match side {
                Side::In => found = Side::In,
                Side::On if found == Side::Out => found = Side::On,
                _ => {}
            }
            found == Side::In
        };
        let mut test = |leaf: durer_bvh::Leaf| {
            if self.is_instances(&leaf) {
                return slots(&leaf).any(|i| {
                    let instance = self.instance(i);
                    learn(instance.geometry.side_of(&point.through(&instance.affine)))
                });
            }
            let arena = &self.arenas[leaf.kind as usize];
            // The interior of a solid in parts is in no part's box.
            slots(&leaf).filter_map(|slot| arena.whole(slot)).any(|surface| learn(arena.side(surface, point)))
        };
        let done = self.beside.iter().any(|b| test(b.leaf()))
            || self.tree.containing(point.p, point.p_err, &mut test);
        if !done {
            let _ = self.solids_in_parts.iter().any(|solid| {
                solid.bounds.expanded(point.p_err).contains(point.p)
                    && learn(self.arenas[solid.arena as usize].side(solid.surface, point))
            });
        }
        found
    }
}
