//! The triangular Bezier patch: a surface over a triangle, given by a net of control points.
//!
//! ```text
//!   v ▲  ●                 S(u, v) = Σ  n! / (i! j! k!)  u^i v^j (1 - u - v)^k  P_ij
//!     │  │ ●                       i+j+k=n
//!     │  ●───●
//!     │  │ ● │ ●           with weights: the sum of w_ij B_ij P_ij, divided by that of w_ij B_ij
//!     │  ●───●───● ▶ u
//! ```
//!
//! It is intersected as the lower left half of a patch of the same degree along both parameters
//! (`triangle_net.rs`): cells are squares, and on the long side only the halves in the triangle
//! belong to it. P. de Casteljau's curves over triangles (1959); G. Farin, "Triangular
//! Bernstein-Bezier patches", *Computer Aided Geometric Design* 3 (1986) 83-127; for ray tracing W.
//! Stuerzlinger, "Ray-tracing triangular trimmed free-form surfaces", *IEEE Transactions on
//! Visualization and Computer Graphics* 4 (1998) 202-214.

use super::net::{FaceNet, Net};
use super::shell::Shell;
use super::surface::{Patches, surface_of_patches};
use super::triangle_net::{TriangleNet, count};
use super::{PatchError, check_points};
use crate::{Need, Root, SurfacePoint};
use durer_math::Point3;
use std::sync::Arc;

/// The most points of a side: degree 8.
const MOST_SIDE: usize = 9;
/// The largest ratio of weights: the patch is also computed a little beyond its long side, where
/// weights decrease faster the more they differ.
const WEIGHTS: f64 = 256.0;
/// The error of points in units, and of results computed from them, relative to the size of all.
pub(super) const LOST: f64 = durer_math::scale::pow2(-97);

/// A Bezier patch over a triangle, of degree 1 to 8, with or without weights. An open surface; its
/// stored normal is `S_u x S_v`. A root's tag is `(u, v)`, with `u, v >= 0` and `u + v <= 1`.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{Closest, LocalRay, Surface, TriangularPatch};
/// // z = x y: rows of three points, two and one.
/// let points = [
///     [0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0],
///     [0.0, 0.5, 0.0], [0.5, 0.5, 0.5],
///     [0.0, 1.0, 0.0],
/// ];
/// let patch = TriangularPatch::new(3, &points.map(Point3::from))?;
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
pub struct TriangularPatch {
    side: usize,
    points: Arc<[[f64; 4]]>,
    /// The texture coordinates of the corners (0, 0), (1, 0), (0, 1).
    corners: [[f64; 2]; 3],
    shell: Arc<Shell>,
}

/// Texture coordinates of corners that are the parameters themselves.
const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

impl TriangularPatch {
    /// The patch of a net of control points with `side` points along each side, one more than its
    /// degree: rows along `u` from `v = 0` on, each one point shorter than the one before.
    pub fn new(side: usize, points: &[Point3]) -> Result<Self, PatchError> {
        let points: Vec<_> = points.iter().map(|p| [p.x, p.y, p.z, 1.0]).collect();
        Self::rational(side, &points)
    }

    /// The rational patch of control points and their weights: `[x, y, z, w]`, with coordinates that
    /// are not multiplied by the weight. Weights differ by a factor of 256 at most.
    pub fn rational(side: usize, points: &[[f64; 4]]) -> Result<Self, PatchError> {
        if !(2..=MOST_SIDE).contains(&side) {
            return Err(PatchError::Side(side));
        }
        if points.len() != count(side) {
            return Err(PatchError::TriangleCount { side, needed: count(side), len: points.len() });
        }
        check_points(points, WEIGHTS)?;
        let shell = Shell::new(&[face_net(side, points)]).ok_or(PatchError::Nothing)?;
        Ok(Self { side, points: points.into(), corners: TRIANGLE, shell: Arc::new(shell) })
    }

    /// The patch with texture coordinates that are given at its corners (u, v) = (0, 0), (1, 0) and
    /// (0, 1) and linear between them.
    #[must_use]
    pub fn with_uv(mut self, corners: [[f64; 2]; 3]) -> Self {
        self.corners = corners;
        self
    }

    /// The texture coordinates of the corners.
    pub(crate) fn corners(&self) -> &[[f64; 2]; 3] {
        &self.corners
    }

    /// The control points as a face.
    pub(super) fn net(&self) -> FaceNet {
        face_net(self.side, &self.points)
    }

    /// The number of points along a side: the degree and one.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The control points, row by row, and their weights.
    pub fn points(&self) -> &[[f64; 4]] {
        &self.points
    }
}

fn face_net(side: usize, points: &[[f64; 4]]) -> FaceNet {
    let net = Net::new([points.len(), 1], points);
    FaceNet::Triangle(TriangleNet { side, points: net.points, lost: LOST })
}

/// Patches are equal if their nets and texture coordinates are.
impl PartialEq for TriangularPatch {
    fn eq(&self, other: &Self) -> bool {
        self.side == other.side && self.points == other.points && self.corners == other.corners
    }
}

impl Patches for TriangularPatch {
    const NAME: &'static str = "triangular patch";

    fn shell(&self) -> &Shell {
        &self.shell
    }

    fn map_uv(&self, _root: &Root, point: &mut SurfacePoint, need: Need) {
        if self.corners == TRIANGLE {
            return;
        }
        map_uv(&self.corners, point, need);
    }
}

/// Texture coordinates that are given at the corners (0, 0), (1, 0) and (0, 1) and linear between
/// them, and the slopes by them of a surface with these slopes by the parameters.
pub(crate) fn map_uv(corners: &[[f64; 2]; 3], point: &mut SurfacePoint, need: Need) {
    let ([u, v], [a, b, c]) = (point.uv, corners);
    let [[p, q], [r, s]] = [0, 1].map(|k| [b[k] - a[k], c[k] - a[k]]);
    point.uv = [a[0] + (u * p + v * q), a[1] + (u * r + v * s)];
    point.change_parameters([[p, q], [r, s]], need);
}

surface_of_patches!(TriangularPatch);
