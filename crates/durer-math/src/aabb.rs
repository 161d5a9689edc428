//! Axis-aligned boxes.

use crate::rounding::{add_up, mul_up, sub_down, sub_up};
use crate::{Point3, U, Vec3};

/// The box of all points between `min` and `max`, both included. Ends may be infinite; empty if
/// `min > max` on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinates.
    pub min: Point3,
    /// The greatest coordinates.
    pub max: Point3,
}

impl Default for Aabb {
    /// The empty box.
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Aabb {
    /// No point at all; the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };
    /// All of space.
    pub const UNBOUNDED: Self = Self { min: Self::EMPTY.max, max: Self::EMPTY.min };

    /// From the least to the greatest coordinates.
    #[inline(always)]
    pub const fn new(min: Point3, max: Point3) -> Self {
        Self { min, max }
    }

    /// The least box that holds all `points`.
    pub fn from_points(points: impl IntoIterator<Item = Point3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// The box of half-widths `half` about `centre`, rounded outward.
    pub fn centred(centre: Point3, half: Vec3) -> Self {
        Self { min: centre, max: centre }.expanded(half)
    }

    /// The least box that holds this one and `p`.
    #[inline]
    #[must_use]
    pub fn with_point(self, p: Point3) -> Self {
        self.union(Self { min: p, max: p })
    }

    /// The least box that holds both.
    #[inline]
    #[must_use]
    pub fn union(self, b: Self) -> Self {
        Self { min: zip(self.min, b.min, f64::min), max: zip(self.max, b.max, f64::max) }
    }

    /// The points in both; perhaps none.
    #[inline]
    #[must_use]
    pub fn intersection(self, b: Self) -> Self {
        Self { min: zip(self.min, b.min, f64::max), max: zip(self.max, b.max, f64::min) }
    }

    /// Whether there is no point in it. A NaN makes it empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Whether all its coordinates are finite; also false if it is empty.
    #[inline]
    pub fn is_bounded(&self) -> bool {
        self.min.is_finite() && self.max.is_finite() && !self.is_empty()
    }

    /// Whether `p` lies in it, faces included.
    #[inline]
    pub fn contains(&self, p: Point3) -> bool {
        (0..3).all(|i| self.min[i] <= p[i] && p[i] <= self.max[i])
    }

    /// Whether all of `b` lies in it.
    #[inline]
    pub fn encloses(&self, b: &Self) -> bool {
        b.is_empty() || (0..3).all(|i| self.min[i] <= b.min[i] && b.max[i] <= self.max[i])
    }

    /// The middle of a bounded box, up to rounding.
    #[inline]
    pub fn centre(&self) -> Point3 {
        zip(self.min, self.max, |a, b| 0.5 * a + 0.5 * b)
    }

    /// The widths along the axes, rounded up; zero if it is empty.
    #[inline]
    pub fn widths(&self) -> Vec3 {
        if self.is_empty() {
            return Vec3::ZERO;
        }
        zip(self.max, self.min, sub_up).to_vec()
    }

    /// Half its surface's area (the SAH needs no more), rounded; zero if it is empty.
    #[inline]
    pub fn half_area(&self) -> f64 {
        let w = self.widths();
        // A flat side of an unbounded box has no area: 0 * inf is 0 here.
        let face = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        face(w.x, w.y) + face(w.y, w.z) + face(w.z, w.x)
    }

    /// The box grown by `by >= 0` on each side, rounded outward.
    #[inline]
    #[must_use]
    pub fn expanded(self, by: Vec3) -> Self {
        Self {
            min: zip(self.min, by.to_point(), |a, b| if b == 0.0 { a } else { sub_down(a, b) }),
            max: zip(self.max, by.to_point(), |a, b| if b == 0.0 { a } else { add_up(a, b) }),
        }
    }

    /// The corners.
    pub fn corners(&self) -> [Point3; 8] {
        core::array::from_fn(|i| {
            let pick = |bit: usize, a: f64, b: f64| if i >> bit & 1 == 0 { a } else { b };
            Point3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// An upper bound of the largest absolute coordinate.
    #[inline]
    pub fn magnitude(&self) -> f64 {
        self.min.abs().max_abs().max(self.max.abs().max_abs())
    }

    /// An upper bound of the distance from `p` to the farthest point of the box.
    pub fn reach_from(&self, p: Point3) -> f64 {
        let far = |i: usize| sub_up(p[i], self.min[i]).max(sub_up(self.max[i], p[i])).max(0.0);
        let squares = [far(0), far(1), far(2)].map(|x| mul_up(x, x));
        crate::rounding::sqrt_up(add_up(add_up(squares[0], squares[1]), squares[2]))
    }

    /// The parameters `t` in `[t_min, t_max]` at which the line `o + t d` may be in the box,
    /// rounded outward; `None` only if it certainly is not.
    ///
    /// Slabs: T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH (1986); signed zeros:
    /// A. Williams, S. Barrus, R. K. Morley, P. Shirley, "An efficient and robust ray-box
    /// intersection algorithm", Journal of Graphics Tools 10 (2005); the widening: T. Ize, "Robust
    /// BVH ray traversal", Journal of Computer Graphics Techniques 2(2), 2013. Each plane's `t`
    /// carries two roundings (difference, quotient) and is widened by four units and the least
    /// normal number. An axis with `d = 0`, of either sign, is decided without dividing, so no NaN
    /// arises from a finite ray.
    #[inline]
    pub fn slabs(&self, o: Point3, d: Vec3, t_min: f64, t_max: f64) -> Option<(f64, f64)> {
        /// Two roundings, and those of the widening itself.
        const WIDEN: f64 = 4.0 * U;
        if self.is_empty() {
            return None;
        }
        let (mut enter, mut leave) = (t_min, t_max);
        for i in 0..3 {
            if d[i] == 0.0 {
                if !(self.min[i] <= o[i] && o[i] <= self.max[i]) {
                    return None;
                }
                continue;
            }
            let (near, far) =
                if d[i] > 0.0 { (self.min[i], self.max[i]) } else { (self.max[i], self.min[i]) };
            // A quotient that overflows belongs to a finite plane: it bounds from below no further
            // than the greatest number.
            let near = ((near - o[i]) / d[i]).min(f64::MAX);
            let far = ((far - o[i]) / d[i]).max(f64::MIN);
            let near = near - (WIDEN * near.abs() + f64::MIN_POSITIVE);
            let far = far + (WIDEN * far.abs() + f64::MIN_POSITIVE);
            if near > enter {
                enter = near;
            }
            if far < leave {
                leave = far;
            }
        }
        (enter <= leave).then_some((enter, leave))
    }
}

#[inline(always)]
fn zip(a: Point3, b: Point3, f: impl Fn(f64, f64) -> f64) -> Point3 {
    Point3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z))
}
