//! How the tree, CSG and packets of rays find a surface faster. No answer depends on it.

use crate::packet::FilterSource;
use crate::{HalfSpace, LocalRay, Sink, Surface};
use durer_math::{Aabb, Affine, Point3, RaySide, Shaft};

/// How a surface is found faster: its parts, its packet filters, tighter bounds, and tests for
/// bundles of rays. Every method has a default, so `impl Accelerate for Mine {}` is enough.
pub trait Accelerate: Surface {
    /// The surface's name in explanations and statistics, in the singular.
    fn name(&self) -> &'static str {
        "surface"
    }

    /// A box that provably holds the surface after `map` has moved it. The default is the box of
    /// the moved box; a surface with a tighter one returns that.
    fn bounds_through(&self, map: &Affine) -> Aabb {
        map.bounds(&self.bounds())
    }

    /// A box that the solid provably holds, possibly unbounded; empty if none is known.
    fn inner_bounds(&self) -> Aabb {
        Aabb::EMPTY
    }

    /// The solid as a half-space, if it is one.
    fn half_space(&self) -> Option<HalfSpace> {
        None
    }

    /// Whether no ray of a bundle meets the surface. `true` is certain, `false` is not.
    fn misses(&self, shaft: &Shaft) -> bool {
        !shaft.may_meet(&self.bounds())
    }

    /// Whether no ray of a bundle that starts strictly on `side` of the surface meets it again.
    /// `true` is certain, `false` is not.
    fn is_left(&self, _side: RaySide, _shaft: &Shaft) -> bool {
        false
    }

    /// Whether the surface may have more than one part.
    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        false
    }

    /// Calls `f` for each part that a tree may hold by itself, with a box that provably holds the
    /// part.
    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        f(self.bounds(), PartId(0));
    }

    /// The offset from a surface's number to the primitive number of one of its parts. Faces of a
    /// mesh are primitives of their own; walls of a prism are not.
    #[inline(always)]
    fn primitive_of(&self, _part: PartId) -> u32 {
        0
    }

    /// The corners of a part, if it is a flat, uncut triangle whose edges follow the edge rule of
    /// meshes. Either all parts of all surfaces of a type have corners, or none has.
    fn corners(&self, _part: PartId) -> Option<[Point3; 3]> {
        None
    }

    /// The packet filter of one part. The default knows only the bounds, so every ray that may hit
    /// the box falls back to [`part_roots`](Accelerate::part_roots).
    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds())
    }

    /// The packet filter of a whole solid, for CSG, and the part on which each of the filter's
    /// faces lies.
    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        let part = PartId(0);
        (
            if self.is_in_parts() { FilterSource::vague(self.bounds()) } else { self.packet_filter(part) },
            vec![part],
        )
    }

    /// Pushes the crossings of one part. The union over all parts is what [`roots`](Surface::roots)
    /// pushes.
    #[inline(always)]
    fn part_roots<S: Sink + ?Sized>(&self, _part: PartId, ray: &LocalRay<'_>, sink: &mut S)
    where
        Self: Sized,
    {
        self.roots(ray, sink);
    }
}

/// The number of a part of a surface: a face of a mesh, a wall of a prism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartId(pub u32);
