//! The trait that every surface implements, and the types of its answers.

use crate::packet::FilterSource;
use crate::{HalfSpace, LocalPoint, LocalRay, Sink, SurfacePoint};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Point3, RaySide, Shaft};

/// A surface in its own frame. It answers one question: *where does this ray meet you?*
///
/// The closest hit, any hit, all hits and spans are [`Sink`]s over the one method
/// [`roots`](Surface::roots), so they cannot disagree.
pub trait Surface: Send + Sync {
    /// What the surface is called in explanations and statistics, in the singular.
    fn name(&self) -> &'static str {
        "surface"
    }

    /// A box that provably holds the surface and, for a solid, its inside; [`Aabb::UNBOUNDED`] if
    /// none does.
    fn bounds(&self) -> Aabb;

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

    /// Pushes every crossing in the ray's closed range, once, ascending. Each pushed bracket holds
    /// a crossing of the exact surface with the exact ray.
    ///
    /// An implementation may use [`Sink::range`] to skip a whole root or to stop. The range must
    /// not enter arithmetic, so that results do not depend on the order of visits.
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S)
    where
        Self: Sized;

    /// The point of a root of this surface and this ray, with the data that `need` names.
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;

    /// Whether the surface bounds a solid.
    fn solidity(&self) -> Solidity {
        Solidity::Open
    }

    /// The side of the solid on which a point lies, exactly. It matters only for solids; an open
    /// surface returns [`Side::Out`].
    fn side(&self, _point: &LocalPoint<'_>) -> Side {
        Side::Out
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
    /// the box falls back to [`part_roots`](Surface::part_roots).
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

/// One crossing of a ray and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// The crossing in the caller's parameter, somewhere in `[lo, hi]`.
    pub t: f64,
    /// The exact crossing is not less than this (caller's parameter).
    pub lo: f64,
    /// The exact crossing is not greater than this (caller's parameter).
    pub hi: f64,
    /// The crossing in the kernel's re-centred parameter. `resolve` starts from it, because `t` has
    /// lost digits.
    pub s: f64,
    /// Data of the kernel for `resolve` (triangle: barycentric b1, b2).
    pub tag: [f64; 2],
    /// Which face of the surface (cap, wall, side of a box, face of a mesh).
    pub face: u32,
    /// The sign of (outward or stored normal) . direction: -1 entering, +1 leaving, 0 grazing.
    pub sign: i8,
    /// How sure the count is.
    pub kind: RootKind,
}

impl Root {
    /// By `t`, then by face: an order for crossings whose exact order is unknown, those of
    /// different faces of a mesh.
    pub fn order(&self, other: &Self) -> Ordering {
        self.t.total_cmp(&other.t).then(self.face.cmp(&other.face))
    }
}

/// What kind of crossing a root is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum RootKind {
    /// The ray passes from one side to the other.
    Simple = 0,
    /// The ray touches the surface and stays on its side (an exact tangent).
    Grazing = 1,
    /// Several crossings that rounding cannot separate. Never used where exact arithmetic can
    /// decide.
    Cluster = 2,
}

/// Whether a surface bounds a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solidity {
    /// A sheet: no inside.
    Open,
    /// A surface with an inside, which may be unbounded; a line may cross its boundary an odd
    /// number of times.
    Solid,
}

/// The side of a solid on which a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Strictly inside.
    In,
    /// Strictly outside.
    Out,
    /// On the boundary.
    On,
}

/// The data that [`Surface::resolve`] must compute. Position, `dp`, `off` and `ng` always come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Need(u8);

impl Need {
    /// Position, bounds and geometric normal only.
    pub const POINT: Self = Self(0);
    /// The shading normal.
    pub const SHADING_NORMAL: Self = Self(1);
    /// Texture coordinates.
    pub const UV: Self = Self(2);
    /// `dpdu dpdv dndu dndv`.
    pub const DERIVATIVES: Self = Self(4);
    /// Everything.
    pub const ALL: Self = Self(7);

    /// Whether this need includes all of `other`.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Both needs.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}
