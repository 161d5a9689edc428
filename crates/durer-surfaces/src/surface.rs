//! What a surface is: the one query an author writes, and what it answers with.

use crate::packet::FilterSource;
use crate::{LocalPoint, LocalRay, Sink, SurfacePoint};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Point3, RaySide, Shaft};

/// A surface, in its own frame. Its one question: *where does this ray meet you?*
///
/// Closest, any, all and spans are [`Sink`]s over the one [`roots`](Surface::roots), so they cannot disagree.
pub trait Surface: Send + Sync {
    /// A box that provably holds the surface (and, for a solid, its inside); [`Aabb::UNBOUNDED`] if there is none.
    fn bounds(&self) -> Aabb;

    /// A box that provably holds the surface after `map` has moved it. A surface that can do better than the box of its box does.
    fn bounds_through(&self, map: &Affine) -> Aabb {
        map.bounds(&self.bounds())
    }

    /// Whether no ray of a bundle meets the surface: `true` is certain.
    fn misses(&self, shaft: &Shaft) -> bool {
        !shaft.may_meet(&self.bounds())
    }

    /// Whether no ray of a bundle that starts strictly on `side` of the surface ever comes back to it: `true` is certain.
    fn is_left(&self, _side: RaySide, _shaft: &Shaft) -> bool {
        false
    }

    /// Pushes every crossing in the ray's closed range, once, ascending; the exact surface's crossings with the exact ray
    /// lie in the pushed brackets.
    ///
    /// [`Sink::range`] may be used to skip a whole root or to stop; it never enters arithmetic, so that the bits
    /// do not depend on the order of visits.
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S)
    where
        Self: Sized;

    /// The point of a root of this surface and this ray, as far as `need` asks.
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;

    /// Whether the surface bounds a solid.
    fn solidity(&self) -> Solidity {
        Solidity::Open
    }

    /// On which side of the solid a point lies: exact. Asked of solids only; an open surface answers [`Side::Out`].
    fn side(&self, _point: &LocalPoint<'_>) -> Side {
        Side::Out
    }

    /// Whether there may be more parts than one.
    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        false
    }

    /// Calls `f` for each part that a tree may hold by itself, with a box that provably holds the part.
    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        f(self.bounds(), PartId(0));
    }

    /// By how much the number of a part, as a primitive, is above the surface's own: the faces of a mesh are primitives by themselves, the
    /// walls of a prism are not.
    #[inline(always)]
    fn primitive_of(&self, _part: PartId) -> u32 {
        0
    }

    /// The corners of a part, if it is a flat triangle to which edges belong by the one rule of all triangles, and which nothing cuts. All parts of
    /// all surfaces of a type have corners, or none has.
    fn corners(&self, _part: PartId) -> Option<[Point3; 3]> {
        None
    }

    /// One part as lanes see it. Without more than its box, every ray that may meet that asks the surface itself.
    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds())
    }

    /// All of a solid as lanes see it, for bodies made of several, and the part on which each of its faces is, by the numbers that lanes have for them.
    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        let part = PartId(0);
        (
            if self.is_in_parts() { FilterSource::vague(self.bounds()) } else { self.packet_filter(part) },
            vec![part],
        )
    }

    /// The crossings of one part; the union over all parts is what [`roots`](Surface::roots) pushes.
    #[inline(always)]
    fn part_roots<S: Sink + ?Sized>(&self, _part: PartId, ray: &LocalRay<'_>, sink: &mut S)
    where
        Self: Sized,
    {
        self.roots(ray, sink);
    }
}

/// Names a part of a surface: a face of a mesh, a cell of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartId(pub u32);

/// One crossing of a ray and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// The crossing in the caller's parameter, somewhere in `[lo, hi]`.
    pub t: f64,
    /// The exact crossing is not below this (caller's parameter).
    pub lo: f64,
    /// The exact crossing is not above this (caller's parameter).
    pub hi: f64,
    /// The crossing in the kernel's own re-centred parameter: what `resolve` starts from, without the digits that `t` lost.
    pub s: f64,
    /// The kernel's own tag (triangle: b1, b2).
    pub tag: [f64; 2],
    /// Which face of the surface (cap, wall, side of a box, face of a mesh).
    pub face: u32,
    /// The sign of (outward or stored normal) . direction: -1 entering, +1 leaving, 0 grazing.
    pub sign: i8,
    /// How sure the count is.
    pub kind: RootKind,
}

impl Root {
    /// By `t`, then by face: the order of crossings whose exact order is not known, those of different faces of a mesh.
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
    /// Several crossings that could not be told apart; counted, and never used where exact arithmetic can decide.
    Cluster = 2,
}

/// Whether a surface bounds a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solidity {
    /// A sheet: no inside.
    Open,
    /// An inside is defined. It may be unbounded, and a line may cross its boundary an odd number of times.
    Solid,
}

/// Where a point lies with respect to a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Strictly inside.
    In,
    /// Strictly outside.
    Out,
    /// On the boundary.
    On,
}

/// What [`Surface::resolve`] is asked for; position, `dp`, `off` and `ng` always come.
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

    /// Whether all of `other` is asked for.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Both needs.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}
