//! The answers of queries.

use core::fmt;
use durer_surfaces::{Root, RootKind};

/// The number of an object, as given by the caller: in a scene, the top-level objects count from 0
/// in the order of the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ObjectId(pub u32);

/// The number of a primitive within its object, as in a [`Hit`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId(pub u32);

impl fmt::Display for ObjectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for PrimitiveId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl PrimitiveId {
    /// The number of a primitive within a compound whose first primitive is `first`.
    /// [`Builder::add_compound_as`](crate::Builder::add_compound_as) adds `first` again.
    ///
    /// `None` if the primitive comes before the compound.
    pub fn within(self, first: Self) -> Option<LeafId> {
        self.0.checked_sub(first.0).map(LeafId)
    }
}

/// The number of a primitive within a [`Compound`](crate::Compound). It does not depend on the
/// object that the compound is added to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LeafId(pub u32);

/// One crossing of a ray and a surface of a [`Geometry`](crate::Geometry).
///
/// The exact crossing of the exact ray and the exact surface lies in `[t_lo, t_hi]`, which also
/// holds `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The crossing's parameter, in units of the ray's direction.
    pub t: f64,
    /// A lower bound on the exact parameter.
    pub t_lo: f64,
    /// An upper bound on the exact parameter.
    pub t_hi: f64,
    /// The kernel's own coordinates (triangle: barycentric b1, b2). Texture coordinates are the
    /// `uv` of the point that [`Geometry::resolve`](crate::Geometry::resolve) returns.
    pub tag: [f64; 2],
    /// The object.
    pub object: ObjectId,
    /// The primitive within the object.
    pub primitive: PrimitiveId,
    /// The placement: 0 for the geometry's own surfaces; then its instances in the order in which
    /// they were added, each followed by those nested in it.
    pub instance: u32,
    /// The face of the primitive (cap, wall, side of a box).
    pub face: u32,
    /// The sign of (outward or stored normal) . direction: -1 entering, +1 leaving, 0 grazing.
    pub sign: i8,
    /// How sure the count is.
    pub kind: RootKind,
    /// The crossing in the kernel's own parameter: `resolve` starts from it, as `t` has lost
    /// digits.
    pub(crate) s: f64,
    /// The arena of the primitive.
    pub(crate) arena: u32,
    /// Its slot there.
    pub(crate) slot: u32,
}

impl Hit {
    /// The kernel's root, without loss.
    #[inline]
    pub fn root(&self) -> Root {
        Root {
            t: self.t,
            lo: self.t_lo,
            hi: self.t_hi,
            s: self.s,
            tag: self.tag,
            face: self.face,
            sign: self.sign,
            kind: self.kind,
        }
    }

    /// The order of hits along a ray: by `t`, then object and primitive. Hits that are equal in all
    /// these are ordered by placement and storage.
    ///
    /// Two crossings of one surface may round to the same `t`. They are equal here, and every query
    /// keeps the order in which the surface reported them, which is their exact one. So a solid is
    /// entered before it is left.
    #[inline]
    pub fn order(&self, other: &Self) -> core::cmp::Ordering {
        let key = |h: &Self| (h.object, h.primitive, h.instance, h.arena, h.slot);
        self.t.total_cmp(&other.t).then_with(|| key(self).cmp(&key(other)))
    }
}

/// An interval of a ray inside solids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Its begin.
    pub t_in: f64,
    /// Its end.
    pub t_out: f64,
    /// The object whose surface is entered; `None` if the ray's range begins inside.
    pub object_in: Option<ObjectId>,
    /// The object whose surface is left; `None` if the ray's range ends inside.
    pub object_out: Option<ObjectId>,
}

/// An interval of a ray inside one object; see
/// [`Geometry::spans_by_object`](crate::Geometry::spans_by_object).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectSpan {
    /// The object that the ray is in.
    pub object: ObjectId,
    /// From where to where. Its objects are this one, or `None` where the ray's range begins or
    /// ends inside.
    pub span: Span,
}
