//! Data of a surface at eight of its points.

use durer_math::{F8, Vec3};

/// Rounded data near a face: `f` and half its gradient.
pub(crate) struct Slant {
    pub(crate) f: F8,
    pub(crate) half: Vec3<F8>,
}

/// Data at a point of a face: `f`, half its gradient, and bounds on their errors.
pub(crate) struct Skin {
    pub(crate) f: F8,
    pub(crate) half: Vec3<F8>,
    pub(crate) e_f: F8,
    pub(crate) e_half: F8,
    /// An upper bound of the Hessian's norm near the point.
    pub(crate) bend: F8,
    /// The distance up to which `bend` holds.
    pub(crate) room: F8,
}

impl Slant {
    /// The value and half the gradient of a skin. Where it is inlined the rest is not computed.
    #[inline(always)]
    pub(crate) fn of(skin: &Skin) -> Self {
        Self { f: skin.f, half: skin.half }
    }
}

impl Skin {
    /// Zeros.
    pub(crate) const NONE: Self = Self {
        f: F8::ZERO,
        half: Vec3::splat(Vec3::ZERO),
        e_f: F8::ZERO,
        e_half: F8::ZERO,
        bend: F8::ZERO,
        room: F8::ZERO,
    };
}
