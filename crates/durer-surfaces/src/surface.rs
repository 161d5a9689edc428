//! The trait that every surface implements, and the types of its answers.

use crate::{LocalPoint, LocalRay, Root, Sink, SurfacePoint};
use durer_math::Aabb;

/// A surface in its own frame. It answers one question: *where does this ray meet the surface?*
///
/// The closest hit, any hit, all hits and spans are [`Sink`]s over the one method
/// [`roots`](Surface::roots), so they cannot disagree. [`Accelerate`](crate::Accelerate) has the
/// methods that only make a surface faster in a tree.
pub trait Surface: Send + Sync {
    /// A box that provably holds the surface and, for a solid, its inside; [`Aabb::UNBOUNDED`] if
    /// none does.
    fn bounds(&self) -> Aabb;

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
