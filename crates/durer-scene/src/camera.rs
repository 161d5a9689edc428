//! The camera's block, as its final vectors.

use durer_math::{Aabb, Affine, Point3, U, Vec3};

/// A camera, after all its words have been worked in: the picture is spanned by `right` and `up`,
/// and its middle is seen along `direction`.
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
    /// A box that holds the origins of all its rays.
    pub fn standpoints(&self) -> Aabb {
        match self.projection {
            Projection::Perspective => Aabb::from_points([self.location]),
            Projection::Orthographic => {
                let corner = |a: f64, b: f64| self.location + (self.right * (a * 0.5) + self.up * (b * 0.5));
                let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                let all = Aabb::from_points(corners.map(|(a, b)| corner(a, b)));
                // Origins between the corners are rounded too, by a few units of the coordinates.
                let room = 16.0 * U * all.magnitude();
                all.expanded(Vec3::new(room, room, room))
            }
        }
    }

    /// Moves the camera.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.direction = map.vector(self.direction);
        self.right = map.vector(self.right);
        self.up = map.vector(self.up);
    }
}
