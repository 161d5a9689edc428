//! The camera of a scene, as its final vectors.

use std::sync::Arc;

use durer_math::{Aabb, Affine, Point3, U, Vec3};

use crate::{Mesh, Normal, Pigment, Placement};

/// A camera after all its statements have been applied. `right` and `up` span the picture, and
/// `direction` leads to its middle.
///
/// The renderer converts it to the form with `s_x = right / 2` and `s_y = -up / 2`.
#[derive(Clone, Debug, PartialEq)]
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
    /// The lens, for focal blur; `None` for a pinhole.
    pub lens: Option<Lens>,
    /// Perturbs the unit directions of rays, as if they were normals. The point of a ray is `(u, v,
    /// 0)`: its place in the picture, from -1/2 to 1/2, to the right and up.
    pub normal: Option<Arc<Normal>>,
}

/// A lens: rays start at points of it, and those of one place of the picture meet where they cross
/// the plane of focus. The colour is their mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Lens {
    /// The size of the lens: its radius is a quarter of this.
    pub aperture: f64,
    /// The distance of the plane of focus along the direction of view.
    pub focus: f64,
    /// The fewest and the most rays of a place.
    pub samples: [u32; 2],
    /// The probability with which the mean must be near enough before no more rays are sent.
    pub confidence: f64,
    /// The square of the deviation of the mean that is near enough.
    pub variance: f64,
    /// The shape of the lens: the brightness of a pigment in the unit square of x and y, from the
    /// lower left of the lens.
    pub bokeh: Option<Arc<Pigment>>,
}

/// A camera whose rays start at the faces of meshes, along their normals.
///
/// `Camera::location.z` moves the starts along the normals, and a negative `Camera::direction.z`
/// turns the rays round. The other vectors have no meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCamera {
    /// The meshes, each with its placement in the world.
    pub meshes: Vec<(Arc<Mesh>, Placement)>,
    /// How rays are distributed over the faces.
    pub distribution: Distribution,
    /// Rays see no farther than this.
    pub max_distance: Option<f64>,
}

/// How the rays of a [`MeshCamera`] are distributed over the faces of its meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Each pixel has a face of its number in each of the first meshes, as many as this. Its colour
    /// is the mean of theirs.
    Each(u32),
    /// The faces of all meshes form one list. Each pixel has as many of its faces as this, a whole
    /// picture apart. Its colour is the mean of theirs.
    Joined(u32),
    /// The picture is divided into columns, one for each mesh.
    SideBySide,
    /// The place in the picture is looked up among the texture coordinates of the first mesh.
    Uv {
        /// Whether directions are interpolated between the normals at the corners.
        smooth: bool,
    },
}

/// How points of the picture are mapped to rays.
#[derive(Clone, Debug, PartialEq)]
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
    /// The fisheye of Omnimax theatres, down to 45 degrees below the direction of view.
    Omnimax,
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
    /// Rays start at the faces of meshes.
    Mesh(Arc<MeshCamera>),
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
            lens: None,
            normal: None,
        }
    }
}

impl Camera {
    /// A box that contains the origins of all rays.
    pub fn standpoints(&self) -> Aabb {
        let all = match &self.projection {
            Projection::Perspective
            | Projection::Omnimax
            | Projection::Fisheye(_)
            | Projection::UltraWideAngle(_)
            | Projection::Panoramic
            | Projection::Spherical(..)
            | Projection::Cylinder { moving: false, .. } => Aabb::from_points([self.location]),
            Projection::Orthographic | Projection::Cylinder { moving: true, .. } => {
                let corner = |a: f64, b: f64| self.location + (self.right * (a * 0.5) + self.up * (b * 0.5));
                let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                Aabb::from_points(corners.map(|(a, b)| corner(a, b)))
            }
            Projection::Mesh(camera) => {
                let corners = camera.meshes.iter().flat_map(|(mesh, placement)| {
                    mesh.vertices.iter().map(|&corner| placement.affine().point(corner))
                });
                let off = self.location.z.abs();
                Aabb::from_points(corners).expanded(Vec3::new(off, off, off))
            }
        };
        let lens = self.lens.as_ref().map_or(0.0, |lens| 0.5 * lens.aperture.abs());
        if matches!(
            self.projection,
            Projection::Orthographic | Projection::Cylinder { moving: true, .. } | Projection::Mesh(_)
        ) || lens > 0.0
        {
            // The renderer also rounds origins, by a few ulps of the coordinates.
            let room = lens + 16.0 * U * (all.magnitude() + lens);
            return all.expanded(Vec3::new(room, room, room));
        }
        all
    }

    /// Transforms the camera by `map`.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.direction = map.vector(self.direction);
        self.right = map.vector(self.right);
        self.up = map.vector(self.up);
    }
}
