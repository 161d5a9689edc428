//! The ray `r(t) = o + t d`.

use crate::{Point3, Vec3};

/// A ray `r(t) = origin + t * direction` with `t` in the closed range `[t_min, t_max]`.
///
/// The direction has any length but zero; `t` is in its units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where `t = 0` is.
    pub origin: Point3,
    /// The displacement for one unit of `t`.
    pub direction: Vec3,
    /// The least admitted parameter.
    pub t_min: f64,
    /// The greatest admitted parameter; may be infinite.
    pub t_max: f64,
    source: Option<Source>,
}

/// The primitive from which a secondary ray starts, and the side of it on which its origin provably
/// lies.
///
/// `arena`, `index` and `part` say where the geometry keeps the primitive; they mean nothing
/// outside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Which arena holds the primitive.
    pub arena: u32,
    /// Its place in the arena.
    pub index: u32,
    /// Its part, for surfaces with many.
    pub part: u32,
    /// The face of the primitive.
    pub face: u32,
    /// The instance it belongs to.
    pub instance: u32,
    /// The side of the surface on which the origin lies.
    pub side: RaySide,
}

/// A side of a surface, by its outward (or stored) normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RaySide {
    /// Where the normal points.
    Front,
    /// The other side.
    Back,
}

impl Ray {
    /// The ray from `origin` along `direction` with `t` in `[0, inf]`.
    pub const fn new(origin: Point3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f64::INFINITY, source: None }
    }

    /// Returns this ray with another range.
    #[must_use]
    pub const fn with_range(mut self, t_min: f64, t_max: f64) -> Self {
        self.t_min = t_min;
        self.t_max = t_max;
        self
    }

    /// Returns this ray, known to start at `side` of a primitive, as `SurfacePoint::spawn` has
    /// proven.
    #[doc(hidden)]
    #[must_use]
    pub const fn spawned_from(mut self, source: Option<Source>) -> Self {
        self.source = source;
        self
    }

    /// The primitive this ray was spawned from, if any.
    pub const fn source(&self) -> Option<Source> {
        self.source
    }

    /// Whether the ray can meet anything: finite origin and direction, a direction that is not
    /// zero, and a range that holds at least one number.
    #[inline(always)]
    pub fn is_valid(&self) -> bool {
        self.origin.is_finite()
            && self.direction.is_finite()
            && self.direction != Vec3::ZERO
            && self.t_min <= self.t_max
    }

    /// The point at `t`, rounded: for display. Hit points come from `resolve`, which does not lose
    /// the low digits.
    pub fn at(&self, t: f64) -> Point3 {
        Point3::new(
            t.mul_add(self.direction.x, self.origin.x),
            t.mul_add(self.direction.y, self.origin.y),
            t.mul_add(self.direction.z, self.origin.z),
        )
    }
}
