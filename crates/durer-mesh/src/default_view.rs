//! The default view of a mesh file: a scene with a camera and a light.

use crate::{Format, Instance, Model, Topology};
use durer_math::{Aabb, Affine, Point3, Vec3};
use durer_scene::{
    Background, Camera, Colour, Finish, Light, Mesh, Object, Pigment, Projection, Rgb, Scene, Shape,
    SubdivisionData, Texture,
};
use std::sync::Arc;

/// Half of the smaller side of the picture at distance one: the tangent of 20 degrees.
const SLOPE: f64 = 0.364;

/// The direction of the rays that decide between inside and outside of closed meshes. Any direction
/// works. This one lies along no axis and in no coordinate plane, so it rarely meets an edge of a
/// modelled part exactly.
const INSIDE: Vec3 = Vec3::new(0.48, 0.6, 0.64);

impl Model {
    /// A box that contains all finite vertices.
    pub fn bounds(&self) -> Aabb {
        let of = |group: &crate::Group| {
            let vertices = group.mesh.vertices.iter().copied();
            Aabb::from_points(vertices.filter(|v: &Point3| v.is_finite()))
        };
        let groups: Vec<Aabb> = self.groups.iter().map(of).collect();
        let placed = |instance: &Instance| match (groups[instance.group], instance.placement) {
            (bounds, map) if bounds.is_empty() || map == Affine::IDENTITY => bounds,
            (bounds, map) => map.bounds(&bounds),
        };
        self.instances.iter().map(placed).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Makes an object for each instance, in their order. Instances of one group share one mesh.
    /// Objects are light grey if the file has no colours. Groups that are closed according to
    /// [`Topology`] become solids.
    pub fn into_objects(self) -> Vec<Object> {
        let texture = Arc::new(paint(Colour::opaque(Rgb::new(0.8, 0.8, 0.8))));
        let mesh = |group: crate::Group| {
            let mut mesh = group.mesh;
            mesh.inside_vector = Topology::of(&mesh).is_closed.then_some(INSIDE);
            Arc::new(mesh)
        };
        let meshes: Vec<Arc<Mesh>> = self.groups.into_iter().map(mesh).collect();
        let object = |instance: Instance| {
            let mesh = Arc::clone(&meshes[instance.group]);
            let object = Object::new(Shape::Mesh(mesh)).with_texture(Arc::clone(&texture));
            Object { placement: instance.placement.into(), ..object }
        };
        self.instances.into_iter().map(object).collect()
    }

    /// Makes a scene: the objects, a camera that sees all of them, and a light behind its left
    /// shoulder. The camera is right-handed, so nothing is mirrored. Up is +y; in
    /// [STL](Format::Stl) files, which come from machines, it is +z. `width` and `height` are those
    /// of the picture.
    pub fn into_scene(self, width: u32, height: u32) -> Scene {
        let (bounds, format) = (self.bounds(), self.format);
        scene_of(self.into_objects(), bounds, format, [width, height])
    }
}

/// A scene of one subdivision surface, seen and lit as a mesh is ([`Model::into_scene`]).
pub fn subdivided_scene(data: SubdivisionData, width: u32, height: u32) -> Scene {
    let used = data.faces.iter().flatten().filter_map(|v| data.vertices.get(*v as usize)).copied();
    let bounds = Aabb::from_points(used.filter(|p: &Point3| p.is_finite()));
    let texture = Arc::new(paint(Colour::opaque(Rgb::new(0.8, 0.8, 0.8))));
    let object = Object::new(Shape::Subdivision(Arc::new(data))).with_texture(texture);
    scene_of(vec![object], bounds, Format::Obj, [width, height])
}

fn scene_of(objects: Vec<Object>, bounds: Aabb, format: Format, [width, height]: [u32; 2]) -> Scene {
    let (centre, half) = if bounds.is_bounded() && !bounds.is_empty() {
        (bounds.centre(), bounds.widths() * 0.5)
    } else {
        (Point3::ORIGIN, Vec3::ZERO)
    };
    let radius = half.length();
    let radius = if radius > 0.0 { radius } else { 1.0 };
    // The view is from the front, a little from the right and from above; `back` points to the
    // viewer.
    let (front, side, top) = match format {
        Format::Stl => (-Vec3::Y, Vec3::X, Vec3::Z),
        _ => (Vec3::Z, Vec3::X, Vec3::Y),
    };
    let back = unit(front + side * 0.45 + top * 0.35);
    let right = unit(top.cross(back));
    let up = back.cross(right);
    let (width, height) = (f64::from(width.max(1)), f64::from(height.max(1)));
    let unit_of = 2.0 * SLOPE / width.min(height);
    // The ball around everything touches the sides of the picture. Its distance is
    // `radius / sin` of the angle whose tangent is `SLOPE`.
    let distance = radius * SLOPE.mul_add(SLOPE, 1.0).sqrt() / SLOPE;
    let location = centre + back * distance;
    let camera = Camera {
        projection: Projection::Perspective,
        location,
        direction: -back,
        right: right * (unit_of * width),
        up: up * (unit_of * height),
        lens: None,
        normal: None,
    };
    let lamp = location + (up * 0.6 - right * 0.8) * distance;
    Scene {
        objects,
        lights: vec![Light::point(lamp, Rgb::WHITE)],
        camera: Some(camera),
        background: Background(Colour::opaque(Rgb::new(0.25, 0.28, 0.32))),
        ..Scene::default()
    }
}

/// A matt texture of one colour.
pub(crate) fn paint(colour: Colour) -> Texture {
    Texture::plain(Pigment::solid(colour), Finish { diffuse: 0.9, ..Finish::default() })
}

fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length())
}
