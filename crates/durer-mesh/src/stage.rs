//! A mesh file as a scene: framed and lit.

use crate::{Format, Model, Topology};
use durer_math::{Aabb, Point3, Vec3};
use durer_scene::{
    Background, Camera, Colour, Finish, Light, Object, Pigment, Projection, Rgb, Scene, Shape, Texture,
};
use std::sync::Arc;

/// Half the smaller side of the picture at distance one: 20 degrees.
const SLOPE: f64 = 0.364;

/// The direction that tells inside from outside of closed meshes: any will do; along no axis, and in no plane of two, few edges of modelled parts are met exactly.
const INSIDE: Vec3 = Vec3::new(0.48, 0.6, 0.64);

impl Model {
    /// A box that holds all vertices that are finite.
    pub fn bounds(&self) -> Aabb {
        let vertices = self.groups.iter().flat_map(|g| &g.mesh.vertices).copied();
        Aabb::from_points(vertices.filter(|v: &Point3| v.is_finite()))
    }

    /// The groups as objects in a plain light grey, in their order. Groups that are closed, as [`Topology`] has it, are solids.
    pub fn into_objects(self) -> Vec<Object> {
        let grey = Pigment::solid(Colour::opaque(Rgb::new(0.8, 0.8, 0.8)));
        let texture = Arc::new(Texture::plain(grey, Finish { diffuse: 0.9, ..Finish::default() }));
        let object = |group: crate::Group| {
            let mut mesh = group.mesh;
            mesh.inside_vector = Topology::of(&mesh).is_closed.then_some(INSIDE);
            Object::new(Shape::Mesh(Arc::new(mesh))).with_texture(Arc::clone(&texture))
        };
        self.groups.into_iter().map(object).collect()
    }

    /// The objects with a camera that sees all of them and a light behind its left shoulder. The camera is right-handed: nothing is mirrored. Up is +y; in
    /// [STL](Format::Stl) files, which machines make, +z. `width` and `height` are the picture's.
    pub fn into_scene(self, width: u32, height: u32) -> Scene {
        let bounds = self.bounds();
        let (centre, half) = if bounds.is_bounded() && !bounds.is_empty() {
            (bounds.centre(), bounds.widths() * 0.5)
        } else {
            (Point3::ORIGIN, Vec3::ZERO)
        };
        let radius = half.length();
        let radius = if radius > 0.0 { radius } else { 1.0 };
        // From the front, a little from the right and from above; `back` points to the viewer.
        let (front, side, top) = match self.format {
            Format::Stl => (-Vec3::Y, Vec3::X, Vec3::Z),
            _ => (Vec3::Z, Vec3::X, Vec3::Y),
        };
        let back = unit(front + side * 0.45 + top * 0.35);
        let right = unit(top.cross(back));
        let up = back.cross(right);
        let (width, height) = (f64::from(width.max(1)), f64::from(height.max(1)));
        let unit_of = 2.0 * SLOPE / width.min(height);
        // The ball around everything touches the picture's sides: 1 / sin of an angle by its tangent.
        let distance = radius * SLOPE.mul_add(SLOPE, 1.0).sqrt() / SLOPE;
        let location = centre + back * distance;
        let camera = Camera {
            projection: Projection::Perspective,
            location,
            direction: -back,
            right: right * (unit_of * width),
            up: up * (unit_of * height),
        };
        let lamp = location + (up * 0.6 - right * 0.8) * distance;
        Scene {
            objects: self.into_objects(),
            lights: vec![Light::point(lamp, Rgb::WHITE)],
            camera: Some(camera),
            background: Background(Colour::opaque(Rgb::new(0.25, 0.28, 0.32))),
            ..Scene::default()
        }
    }
}

fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length())
}
