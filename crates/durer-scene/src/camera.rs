//! The camera of a scene, as its final vectors.

use durer_math::{Aabb, Affine, Point3, U, Vec3};

/// A camera after all its statements have been applied. `right` and `up` span the picture, and
/// `direction` leads to its middle.
///
/// The renderer converts it to the form with `s_x = right / 2` and `s_y = -up / 2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// How points of the picture are mapped to rays.
    pub projection: Projection,
    /// The location of the camera.
    pub location: Point3,
    /// The vector to the middle of the picture; its length matters only for perspective.
    pub direction: Vec3,
    /// The width of the picture as a vector, from left to right.
    pub right: Vec3,
    /// The height of the picture as a vector, from bottom to top.
    pub up: Vec3,
}

/// How points of the picture are mapped to rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the location.
    Perspective,
    /// All rays have the same direction.
    Orthographic,
    /// The angle to the direction of view grows with the distance from the middle of the picture;
    /// the parameter is the angle, in radians, across the circle that is seen.
    Fisheye(f64),
    /// Angles grow along both sides of the picture; the parameter is the horizontal angle.
    UltraWideAngle(f64),
    /// Longitude and latitude on an ellipsoid with the camera's vectors as its axes.
    Panoramic,
    /// Longitude and latitude; the parameters are the horizontal and the vertical angle.
    Spherical(f64, f64),
    /// A cylinder around the location.
    Cylinder {
        /// The angle around the axis.
        angle: f64,
        /// Whether the axis is vertical.
        vertical: bool,
        /// Whether rays start on the axis and not at the location.
        moving: bool,
    },
}

impl Default for Camera {
    /// A camera at the origin that looks along z, with a picture 1.33 wide and 1 high.
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
    /// A box that contains the origins of all rays.
    pub fn standpoints(&self) -> Aabb {
        match self.projection {
            Projection::Perspective
            | Projection::Fisheye(_)
            | Projection::UltraWideAngle(_)
            | Projection::Panoramic
            | Projection::Spherical(..)
            | Projection::Cylinder { moving: false, .. } => Aabb::from_points([self.location]),
            Projection::Orthographic | Projection::Cylinder { moving: true, .. } => {
                let corner = |a: f64, b: f64| self.location + (self.right * (a * 0.5) + self.up * (b * 0.5));
                let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                let all = Aabb::from_points(corners.map(|(a, b)| corner(a, b)));
                // The renderer also rounds origins between the corners, by a few ulps of the
                // coordinates.
                let room = 16.0 * U * all.magnitude();
                all.expanded(Vec3::new(room, room, room))
            }
        }
    }

    /// Transforms the camera by `map`.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.direction = map.vector(self.direction);
        self.right = map.vector(self.right);
        self.up = map.vector(self.up);
    }
}
