//! The Bezier patch: a surface over the unit square, given by a net of control points.
//!
//! ```text
//!    13 ●────●────●────● 16                    n  m
//!       │    │    │    │           S(u, v) =   Σ  Σ  B_i(u) B_j(v) P_ij
//!     9 ●────●────●────● 12                   i=0 j=0
//!       │    │    │    │
//!   v ▲ ●────●────●────● 8         B_i(u) = (n over i) u^i (1 - u)^(n-i)
//!     │ │    │    │    │
//!     1 ●────●────●────● 4         with weights: the sum of w_ij B_i B_j P_ij,
//!         ▶ u                      divided by that of w_ij B_i B_j
//! ```
//!
//! A ray meets it where two functions of `u` and `v` vanish. The patch is cut into cells in advance
//! (`cell.rs`). A line leaves out the cells that it provably misses, and elsewhere finds its crossing
//! by Newton's method and proves it by Krawczyk's (`line.rs`, `roots/two_unknowns.rs`). Near a
//! silhouette and near a collapsed edge a cell is halved further (`subdivide.rs`). What is then as
//! small as the rounding errors and still open is reported as [`RootKind::Grazing`] or
//! [`RootKind::Cluster`].
//!
//! T. Whitted, "An improved illumination model for shaded display", *Communications of the ACM* 23
//! (1980) 343-349, halved patches until they were as small as a pixel; J. T. Kajiya, "Ray tracing
//! parametric patches", *SIGGRAPH* 1982, eliminated an unknown, which leaves a polynomial of degree
//! 18; D. L. Toth, "On ray tracing parametric surfaces", *SIGGRAPH* 1985, used Newton's method with a
//! proof of its start. P. Bezier, *Numerical Control: Mathematics and Applications*, 1972.
//!
//! [`RootKind::Grazing`]: crate::RootKind::Grazing
//! [`RootKind::Cluster`]: crate::RootKind::Cluster
#![expect(clippy::needless_range_loop, reason = "several arrays have the same axes")]

mod ahead;
mod alternation;
mod cell;
pub(crate) mod composed;
mod degree;
mod exact;
pub(crate) mod line;
pub(crate) mod net;
mod nurbs;
mod point;
mod seal;
mod seam;
mod sewn;
pub(crate) mod shell;
mod strip;
mod subdivide;
mod subdivision;
mod surface;
mod triangle_net;
pub(crate) mod triangular;
mod trim;

use crate::{Need, Root, SurfacePoint};
use durer_math::Point3;
use net::{FaceNet, Net};
use shell::Shell;
use std::sync::Arc;
use surface::{Patches, surface_of_patches};

pub(crate) use composed::{Nets, Source, shells};

pub use nurbs::{Nurbs, NurbsData, NurbsError};
pub use sewn::{Sewn, SewnData, SewnError};
pub use subdivision::{
    Boundary, Scheme, SubdivisionData, SubdivisionError, SubdivisionSurface, UvInterpolation,
};
pub use triangular::TriangularPatch;
pub use trim::{TrimError, TrimLoop};

/// Why a [`BezierPatch`] or a [`TriangularPatch`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Rows or columns have too few or too many points.
    #[error("patch: rows and columns have 2 to 16 points, got {} by {}", .0[0], .0[1])]
    Size([usize; 2]),
    /// The sides of a triangle have too few or too many points.
    #[error("patch: a side of a triangle has 2 to 9 points, got {0}")]
    Side(usize),
    /// The number of points is not that of a triangle with such sides.
    #[error("patch: a triangle with {side} points along each side has {needed} points, got {len}")]
    TriangleCount {
        /// The points along a side.
        side: usize,
        /// How many points that makes.
        needed: usize,
        /// How many points there are.
        len: usize,
    },
    /// The number of points is not that of a net of this size.
    #[error("patch: a net of {} by {} has {} points, got {len}", size[0], size[1], size[0] * size[1])]
    Count {
        /// The points of a row, and the rows.
        size: [usize; 2],
        /// How many points there are.
        len: usize,
    },
    /// A point is infinite or NaN.
    #[error("patch: point {point} must be finite, got <{x}, {y}, {z}>")]
    Point {
        /// The point, from 1.
        point: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its z.
        z: f64,
    },
    /// A weight is not positive, infinite or NaN.
    #[error("patch: the weight of point {point} must be positive and finite, got {weight}")]
    Weight {
        /// The point, from 1.
        point: usize,
        /// Its weight.
        weight: f64,
    },
    /// The weights differ by more than can be computed with.
    #[error("patch: the largest weight is {0} times the least, which is too much")]
    Weights(f64),
    /// A number is too large.
    #[error("patch: the coordinate {0:?} is too large; the limit is 1.6e60")]
    TooLarge(f64),
    /// All points are the same.
    #[error("patch: all its points are the same, so it has no surface")]
    Nothing,
}

/// Products of larger numbers could leave the range of f64.
const LARGEST: f64 = durer_math::scale::pow2(200);
/// Weights may differ by this factor.
const WEIGHTS: f64 = durer_math::scale::pow2(40);

/// A Bezier patch of any degree up to 15 along both parameters, with or without weights. An open
/// surface; its stored normal is `S_u x S_v`. A root's tag is `(u, v)`.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{BezierPatch, Closest, LocalRay, Surface};
/// // A saddle: z = x y.
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
/// let patch = BezierPatch::new([2, 2], &corners.map(Point3::from))?;
/// let ray = Ray::new(Point3::new(0.5, 0.25, 2.0), Vec3::new(0.0, 0.0, -1.0));
/// let mut closest = Closest::default();
/// patch.roots(&LocalRay::new(&ray), &mut closest);
/// let root = closest.root.expect("the ray meets the middle");
/// assert!(root.lo <= 1.875 && 1.875 <= root.hi && root.hi - root.lo < 1e-14);
/// # Ok::<(), durer_surfaces::PatchError>(())
/// ```
///
/// # Invariants
///
/// All points are finite, not all of them are the same, and all weights are positive.
#[derive(Clone, Debug)]
pub struct BezierPatch {
    size: [usize; 2],
    points: Arc<[[f64; 4]]>,
    /// The texture coordinates of the corners (0, 0), (1, 0), (1, 1), (0, 1).
    corners: [[f64; 2]; 4],
    shell: Arc<Shell>,
}

/// The texture coordinates of corners that are the parameters themselves.
const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

impl BezierPatch {
    /// The patch of a net of control points: `size[1]` rows of `size[0]` points each, `u` along the
    /// rows. A size is a degree and one.
    pub fn new(size: [usize; 2], points: &[Point3]) -> Result<Self, PatchError> {
        let points: Vec<_> = points.iter().map(|p| [p.x, p.y, p.z, 1.0]).collect();
        Self::rational(size, &points)
    }

    /// The rational patch of control points and their weights: `[x, y, z, w]`, with coordinates that
    /// are not multiplied by the weight.
    pub fn rational(size: [usize; 2], points: &[[f64; 4]]) -> Result<Self, PatchError> {
        check(size, points)?;
        let shell = Shell::new(&[FaceNet::Square(Net::new(size, points))]).ok_or(PatchError::Nothing)?;
        Ok(Self { size, points: points.into(), corners: SQUARE, shell: Arc::new(shell) })
    }

    /// The patch with texture coordinates that are given at its corners (u, v) = (0, 0), (1, 0),
    /// (1, 1) and (0, 1) and bilinear between them.
    #[must_use]
    pub fn with_uv(mut self, corners: [[f64; 2]; 4]) -> Self {
        self.corners = corners;
        self
    }

    /// The texture coordinates of the corners.
    pub(crate) fn corners(&self) -> &[[f64; 2]; 4] {
        &self.corners
    }

    /// The number of points in a row, and of rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The control points, row by row, and their weights.
    pub fn points(&self) -> &[[f64; 4]] {
        &self.points
    }
}

/// Texture coordinates that are given at the corners of a patch and bilinear between them, and the
/// slopes by them of a surface with these slopes by the parameters.
pub(crate) fn map_uv(corners: &[[f64; 2]; 4], point: &mut SurfacePoint, need: Need) {
    let ([u, v], [a, b, c, d]) = (point.uv, corners);
    let mut jacobian = [[0.0; 2]; 2];
    for k in 0..2 {
        let (low, high) = (a[k] + u * (b[k] - a[k]), d[k] + u * (c[k] - d[k]));
        point.uv[k] = low + v * (high - low);
        jacobian[k] = [(b[k] - a[k]) + v * ((c[k] - d[k]) - (b[k] - a[k])), high - low];
    }
    point.change_parameters(jacobian, need);
}

/// Checks that a net is valid for a patch.
fn check(size: [usize; 2], points: &[[f64; 4]]) -> Result<(), PatchError> {
    if size.iter().any(|n| !(2..=cell::MOST).contains(n)) {
        return Err(PatchError::Size(size));
    }
    if points.len() != size[0] * size[1] {
        return Err(PatchError::Count { size, len: points.len() });
    }
    check_points(points, WEIGHTS)
}

/// Checks that all points are in the solver's range, and that the ratio of weights is within a
/// factor.
fn check_points(points: &[[f64; 4]], factor: f64) -> Result<(), PatchError> {
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for (i, &[x, y, z, weight]) in points.iter().enumerate() {
        let point = i + 1;
        if ![x, y, z].iter().all(|x| x.is_finite()) {
            return Err(PatchError::Point { point, x, y, z });
        }
        if let Some(&large) = [x, y, z].iter().find(|x| x.abs() >= LARGEST) {
            return Err(PatchError::TooLarge(large));
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(PatchError::Weight { point, weight });
        }
        (least, most) = (least.min(weight), most.max(weight));
    }
    if most / least > factor {
        return Err(PatchError::Weights(most / least));
    }
    Ok(())
}

/// Patches are equal if their nets and texture coordinates are.
impl PartialEq for BezierPatch {
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size && self.points == other.points && self.corners == other.corners
    }
}

impl Patches for BezierPatch {
    const NAME: &'static str = "patch";

    fn shell(&self) -> &Shell {
        &self.shell
    }

    fn map_uv(&self, _root: &Root, point: &mut SurfacePoint, need: Need) {
        if self.corners == SQUARE {
            return;
        }
        map_uv(&self.corners, point, need);
    }
}

surface_of_patches!(BezierPatch);

#[cfg(test)]
mod tests;
