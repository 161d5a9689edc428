//! The camera's block, as its final vectors.

use durer_math::{Affine, Point3, Vec3};

/// A camera, after all its words have been worked in: the picture is spanned by `right` and `up`, and its middle is seen along `direction`.
///
/// The lecture's forms with `s_x = right / 2`, `s_y = -up / 2` are built from it by the renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// How points of the picture become rays.
    pub projection: Projection,
    /// Where it stands.
    pub location: Point3,
    /// To the middle of the picture; its length matters to perspective only.
    pub direction: Vec3,
    /// Across the whole picture, from left to right.
    pub right: Vec3,
    /// Along the whole picture, from bottom to top.
    pub up: Vec3,
}

/// How points of the picture become rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// All rays start at the location.
    Perspective,
    /// All rays have the same direction.
    Orthographic,
}

impl Default for Camera {
    /// At the origin, looking along z, 1.33 wide and 1 high.
    fn default() -> Self {
        Self {
            projection: Projection::Perspective,
            location: Point3::ORIGIN,
            direction: Vec3::Z,
            right: Vec3::new(1.33, 0.0, 0.0),
            up: Vec3::Y,
        }
    }
}

impl Camera {
    /// Moves the camera.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.direction = map.vector(self.direction);
        self.right = map.vector(self.right);
        self.up = map.vector(self.up);
    }
}
