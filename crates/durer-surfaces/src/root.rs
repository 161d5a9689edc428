//! One crossing of a ray and a surface.

use core::cmp::Ordering;

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

/// The kind of crossing at a root.
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
