//! Sweeps along a straight path, translational and conical.
//!
//! ```text
//! S(u, v) = c(u) + size(u) (a(v) X + b(v) Y),   c(u) = (1 - u) from + u to,   size(u) = (1 - u) s0 + u s1
//! ```
//!
//! Source: James T. Kajiya, "New Techniques for Ray Tracing Procedurally Defined Objects", ACM
//! Transactions on Graphics 2(3), 1983.
//!
//! Such a sweep is the affine image of a prism whose outlines lie in the (a, b) plane. If the size
//! is constant, the prism has the heights 0 and 1, and its axis becomes `to - from`. Otherwise the
//! prism is conic with the heights s0 and s1, and its axis becomes `(to - from) / (s1 - s0)`.

use durer_math::{Affine, AffineError, Point3, Vec3};

/// A straight path with the frame and the size of a profile that moves along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightPath {
    heights: [f64; 2],
    is_conic: bool,
    placement: Affine,
}

/// Why a [`StraightPath`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StraightPathError {
    /// Both ends are one point.
    #[error("sweep: both ends of the path are <{0}, {1}, {2}>")]
    NoLength(f64, f64, f64),
    /// A size is not positive and finite.
    #[error("sweep: a size must be positive and finite, got {0:?}")]
    Size(f64),
    /// The vector that shows upward has no direction across the path.
    #[error("sweep: up, <{0}, {1}, {2}>, must not be parallel to the path")]
    Up(f64, f64, f64),
    /// The placement is beyond the range of f64.
    #[error("sweep: {0}")]
    Placement(AffineError),
}

impl StraightPath {
    /// The path from `from` to `to`, on which a profile has the sizes `sizes` at the ends.
    ///
    /// The profile's second axis points to the side of `up`. Without `up`, the smallest rotation
    /// of z onto the path turns x and y into the profile's axes; for a path along -z they are x and
    /// -y.
    ///
    /// The ends of a conic sweep are within a few `2^-53 |to - from| max(s0, s1) / |s1 - s0|` of
    /// the given points, because the apex of the cone is rounded.
    pub fn new(
        from: Point3,
        to: Point3,
        sizes: [f64; 2],
        up: Option<Vec3>,
    ) -> Result<Self, StraightPathError> {
        if let Some(&size) = sizes.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
            return Err(StraightPathError::Size(size));
        }
        let along = to - from;
        let Some(tangent) = direction(along) else {
            return Err(StraightPathError::NoLength(from.x, from.y, from.z));
        };
        let (x, y) = match up {
            None => rotated_from_z(tangent),
            Some(up) => {
                let wrong = StraightPathError::Up(up.x, up.y, up.z);
                let up = direction(up).ok_or(wrong)?;
                let x = direction(up.cross(tangent)).ok_or(wrong)?;
                (x, tangent.cross(x))
            }
        };
        let [start, end] = sizes;
        let (axis, origin, scale, heights) = if start == end {
            (along, from, start, [0.0, 1.0])
        } else {
            let axis = along / (end - start);
            (axis, from - axis * start, 1.0, sizes)
        };
        let rows = [0, 1, 2].map(|i| [x[i] * scale, axis[i], y[i] * scale]);
        let placement = Affine::new(rows, origin).map_err(StraightPathError::Placement)?;
        Ok(Self { heights, is_conic: start != end, placement })
    }

    /// The heights of the prism.
    pub fn heights(&self) -> [f64; 2] {
        self.heights
    }

    /// Whether the prism is conic.
    pub fn is_conic(&self) -> bool {
        self.is_conic
    }

    /// The map that places the prism.
    pub fn placement(&self) -> &Affine {
        &self.placement
    }
}

/// The unit vector along `v`; `None` if there is none. `v` may have any size.
fn direction(v: Vec3) -> Option<Vec3> {
    let largest = v.max_abs();
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let v = v / largest;
    Some(v / v.length())
}

/// x and y after the smallest rotation of z onto the unit vector `t`:
/// `x - t.x (t + z) / (1 + t.z)`, and likewise y.
fn rotated_from_z(t: Vec3) -> (Vec3, Vec3) {
    let across = t.x * t.x + t.y * t.y;
    // 1 + t.z without cancellation.
    let from_back = if t.z < 0.0 { across / (1.0 - t.z) } else { 1.0 + t.z };
    if from_back == 0.0 {
        return (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, -1.0, 0.0));
    }
    let (p, q) = (t.x / from_back, t.y / from_back);
    (Vec3::new(1.0 - p * t.x, -p * t.y, -t.x), Vec3::new(-q * t.x, 1.0 - q * t.y, -t.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::TestRng;

    /// Whether vectors agree to the rounding of a few operations on numbers up to `size`.
    fn are_near(a: Vec3, b: Vec3, size: f64) -> bool {
        (a - b).max_abs() <= 16.0 * f64::EPSILON * size
    }

    #[test]
    fn the_frame_is_a_rotation_that_carries_the_profile() {
        let mut random = TestRng::new(5);
        for n in 0..2000 {
            let tiny = if n % 3 == 0 { 1e-9 } else { 1.0 };
            let t = Vec3::new(
                random.between(-1.0, 1.0) * tiny,
                random.between(-1.0, 1.0) * tiny,
                random.between(-1.0, 1.0),
            );
            let (from, to) = (Point3::ORIGIN, t.to_point());
            let up = (n % 2 == 0).then(|| {
                Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0))
            });
            let path = StraightPath::new(from, to, [2.0, 2.0], up).unwrap();
            let rows = path.placement().linear();
            let column = |j: usize| Vec3::new(rows[0][j], rows[1][j], rows[2][j]);
            let (x, axis, y) = (column(0) / 2.0, column(1), column(2) / 2.0);
            let unit = direction(axis).unwrap();
            assert!(are_near(axis, t, 1.0));
            assert!(are_near(x.cross(y), unit, 1.0), "{t:?}: {:?}", x.cross(y));
            assert!((x.dot(y)).abs() <= 16.0 * f64::EPSILON);
            if let Some(up) = up {
                assert!(y.dot(up) >= -16.0 * f64::EPSILON);
                assert!(x.dot(up).abs() <= 16.0 * f64::EPSILON * up.length());
            }
        }
    }

    #[test]
    fn a_conic_path_has_its_sizes_at_its_ends() {
        let (from, to) = (Point3::new(1.0, 2.0, 3.0), Point3::new(-2.0, 5.0, 4.0));
        let path = StraightPath::new(from, to, [0.5, 2.0], None).unwrap();
        assert!(path.is_conic());
        let map = path.placement();
        for (h, end) in [(0.5, from), (2.0, to)] {
            let centre = map.point(Point3::new(0.0, h, 0.0));
            assert!(are_near(centre - end, Vec3::new(0.0, 0.0, 0.0), 16.0));
            // The outline at the height h is h times as large.
            let edge = map.point(Point3::new(h, h, 0.0)) - centre;
            assert!((edge.length() - h).abs() <= 64.0 * f64::EPSILON);
        }
    }

    #[test]
    fn what_is_no_path_is_refused() {
        let (o, z) = (Point3::ORIGIN, Point3::new(0.0, 0.0, 1.0));
        let refused = |to, sizes, up| StraightPath::new(o, to, sizes, up).unwrap_err();
        assert_eq!(refused(o, [1.0, 1.0], None), StraightPathError::NoLength(0.0, 0.0, 0.0));
        assert_eq!(refused(z, [1.0, 0.0], None), StraightPathError::Size(0.0));
        assert!(matches!(refused(z, [f64::NAN, 1.0], None), StraightPathError::Size(_)));
        let along = Vec3::new(0.0, 0.0, -3.0);
        assert_eq!(refused(z, [1.0, 1.0], Some(along)), StraightPathError::Up(0.0, 0.0, -3.0));
        assert!(StraightPath::new(o, Point3::new(0.0, 0.0, -1.0), [1.0, 1.0], None).is_ok());
    }
}
