//! Cameras that stand on surfaces, and lights that lie on them.
//!
//! The oracle is convexity. Take a point on the surface of a convex body. A direction from there
//! leads outside if it is on the outer side of one of the tangent planes at the point. It leads
//! through the body if it is behind all of them, and then it meets the surface once more. So a
//! camera at the point sees the body exactly in the directions behind the planes, and a light there
//! is blocked exactly in those.

use durer_math::{Affine, Point3, Vec3};
use durer_render::camera::Camera;
use durer_render::{Progress, Region, RenderSettings, World, render};
use durer_scene::{
    Background, Colour, Face, Finish, Flags, Interior, Layer, Light, LightKind, Mesh, NamedQuadric, Object,
    Operation, Pigment, Prism, Projection, QuadricKind, Rgb, Scene, Shape, Spline, Sweep, Texture,
};
use durer_testkit::TestRng;
use std::sync::Arc;

const SIZE: (u32, u32) = (24, 18);

/// A point of a convex body's surface, with the outward normals of the faces that meet there.
struct Place {
    name: &'static str,
    body: Object,
    point: Vec3,
    normals: Vec<Vec3>,
}

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A direction of length 1.
fn direction(dice: &mut TestRng) -> Vec3 {
    dice.vector().normalized().unwrap_or(Vec3::X)
}

fn boxed(half: Vec3) -> Shape {
    Shape::Box { a: (-half).to_point(), b: half.to_point() }
}

/// The box as triangles.
fn box_mesh(half: Vec3) -> Shape {
    let corner = |i: u32| {
        let axis = |bit: u32, h: f64| if i >> bit & 1 == 1 { h } else { -h };
        Point3::new(axis(0, half.x), axis(1, half.y), axis(2, half.z))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let face = |vertices| Face { vertices, normals: None, texture: None };
    Shape::Mesh(Arc::new(Mesh {
        vertices: (0..8).map(corner).collect(),
        faces: faces.map(face).collect(),
        inside_vector: Some(v(0.3, 1.0, 0.2)),
        ..Mesh::default()
    }))
}

/// The box as an intersection of half-spaces.
fn box_of_planes(half: Vec3) -> Shape {
    let plane =
        |axis: Vec3, distance| [axis, -axis].map(|normal| Object::new(Shape::Plane { normal, distance }));
    let planes = [plane(Vec3::X, half.x), plane(Vec3::Y, half.y), plane(Vec3::Z, half.z)];
    Shape::Csg(Operation::Intersection, planes.into_iter().flatten().collect())
}

/// The box, cut out of a larger one.
fn cut_box(half: Vec3) -> Shape {
    let larger = Object::new(boxed(half + v(0.0, 1.0, 0.0)));
    let lid = |from: f64, to: f64| {
        Object::new(Shape::Box { a: Point3::new(-9.0, from, -9.0), b: Point3::new(9.0, to, 9.0) })
    };
    Shape::Csg(Operation::Difference, vec![larger, lid(half.y, 9.0), lid(-9.0, -half.y)])
}

/// `x^4 + y^4 + z^4 = 1`.
fn cushion() -> Shape {
    let mut coefficients = vec![0.0; 35];
    (coefficients[0], coefficients[20], coefficients[30], coefficients[34]) = (1.0, 1.0, 1.0, -1.0);
    Shape::Polynomial { order: 4, coefficients: coefficients.into() }
}

/// Places on bodies of all kinds: on faces, edges and corners.
fn places(random: &mut TestRng) -> Vec<Place> {
    let mut all = Vec::new();
    let mut add = |name, shape, point: Vec3, normals: &[Vec3]| {
        all.push(Place { name, body: Object::new(shape), point, normals: normals.to_vec() });
    };
    let half = v(1.1, 1.3, 0.9);
    for (name, shape) in [
        ("box", boxed as fn(Vec3) -> Shape),
        ("mesh", box_mesh),
        ("half-spaces", box_of_planes),
        ("difference", cut_box),
    ] {
        let (x, y, z) = (half.x, half.y, half.z);
        add(name, shape(half), v(0.3, y, -0.2), &[Vec3::Y]);
        add(name, shape(half), v(-x, 0.1, 0.7), &[-Vec3::X]);
        add(name, shape(half), v(x, y, 0.2), &[Vec3::X, Vec3::Y]);
        add(name, shape(half), v(0.1, -y, z), &[-Vec3::Y, Vec3::Z]);
        add(name, shape(half), v(x, y, z), &[Vec3::X, Vec3::Y, Vec3::Z]);
        add(name, shape(half), v(-x, -y, z), &[-Vec3::X, -Vec3::Y, Vec3::Z]);
    }
    for _ in 0..3 {
        let n = direction(random);
        let (centre, radius) = (random.vector(), 1.0 + 0.5 * random.signed());
        add("sphere", Shape::Sphere { centre: centre.to_point(), radius }, centre + n * radius, &[n]);
        // The surface passes through the origin, where the coordinates do not show its size.
        let radius = centre.length();
        add("sphere", Shape::Sphere { centre: centre.to_point(), radius }, Vec3::ZERO, &[-centre]);

        let axes = [1.4, 0.9, 1.1];
        let p = v(n.x * axes[0], n.y * axes[1], n.z * axes[2]);
        let gradient = v(n.x / axes[0], n.y / axes[1], n.z / axes[2]);
        let kind = QuadricKind::Ellipsoid;
        let ellipsoid = Shape::Named(Box::new(NamedQuadric { kind, semi_axes: axes, extent: None }));
        add("ellipsoid", ellipsoid, p, &[gradient]);

        let quartic = |n: Vec3| n.x * n.x * n.x * n.x + n.y * n.y * n.y * n.y + n.z * n.z * n.z * n.z;
        let p = n * (1.0 / quartic(n).sqrt().sqrt());
        let gradient = v(p.x * p.x * p.x, p.y * p.y * p.y, p.z * p.z * p.z);
        add("polynomial", cushion(), p, &[gradient]);
        add("superellipsoid", Shape::Superellipsoid { e: 0.5, n: 0.5 }, p, &[gradient]);

        let round = v(n.x, 0.0, n.z).normalized().unwrap_or(Vec3::X);
        let (base, cap) = (Point3::new(0.0, -1.2, 0.0), Point3::new(0.0, 1.2, 0.0));
        let cylinder = || Shape::Cylinder { base, cap, radius: 0.8 };
        add("cylinder", cylinder(), round * 0.8 + Vec3::Y * (0.9 * n.y), &[round]);
        add("cylinder", cylinder(), round * 0.4 + Vec3::Y * 1.2, &[Vec3::Y]);
        add("cylinder", cylinder(), round * 0.8 + Vec3::Y * 1.2, &[Vec3::Y, round]);
        let cone = Shape::Cone { base, base_radius: 1.5, cap, cap_radius: 0.3 };
        let wall = round * (0.9 - 0.5 * n.y) + Vec3::Y * n.y;
        add("cone", cone, wall, &[round + Vec3::Y * 0.5]);
    }
    let square = vec![vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]];
    let prism = || {
        let heights = [-1.0, 0.7];
        Shape::Prism(Arc::new(Prism {
            outlines: square.clone(),
            spline: Spline::Linear,
            heights,
            sweep: Sweep::Linear,
        }))
    };
    add("prism", prism(), v(0.2, 0.7, -0.3), &[Vec3::Y]);
    add("prism", prism(), v(1.0, 0.3, -0.3), &[Vec3::X]);
    add("prism", prism(), v(1.0, 0.7, -0.3), &[Vec3::X, Vec3::Y]);
    all
}

/// A rotation, a translation and, every other time, a scaling. Body and point are both rounded.
fn moved(random: &mut TestRng, place: Place, turn: usize) -> Place {
    let turned = Affine::rotation(direction(random), 3.0 * random.signed()).unwrap();
    let scaled = match turn % 2 {
        0 => turned,
        _ => Affine::scaling(1.7, 0.6, 1.2).unwrap().then(&turned).unwrap(),
    };
    let map = scaled.then(&Affine::translation(random.vector() * 0.5).unwrap()).unwrap();
    let mut body = place.body;
    body.transform(&map).unwrap();
    let normal = |n: Vec3| map.normal(n.normalized().unwrap().to_normal()).to_vec();
    let normals = place.normals.into_iter().map(normal).collect();
    Place { point: map.point(place.point.to_point()).to_vec(), body, normals, ..place }
}

/// All places as they are, transformed, and transformed with the point some ulps away.
fn all_places() -> Vec<Place> {
    let mut random = TestRng::new(7);
    let mut all = places(&mut random);
    for turn in 0..4 {
        for mut place in places(&mut random) {
            place = moved(&mut random, place, turn);
            if turn > 1 {
                let ulps = |x: f64, n: f64| x + (2.0 * n).round() * f64::EPSILON * x.abs();
                let (p, n) = (place.point, random.vector());
                place.point = v(ulps(p.x, n.x), ulps(p.y, n.y), ulps(p.z, n.z));
            }
            all.push(place);
        }
    }
    all
}

/// Whether a direction from a place leads outside. `None` near the tangent planes.
fn leads_outside(place: &Place, direction: Vec3) -> Option<bool> {
    let d = direction.normalized().unwrap();
    let cosines: Vec<f64> = place.normals.iter().map(|n| n.normalized().unwrap().dot(d)).collect();
    if cosines.iter().any(|c| c.abs() < 1e-5) {
        return None;
    }
    Some(cosines.iter().any(|&c| c > 0.0))
}

fn paint(colour: [f64; 5], ambient: f64, diffuse: f64) -> Texture {
    let finish = Finish { ambient: Rgb::grey(ambient), diffuse, ..Finish::default() };
    Texture::plain(Pigment::solid(Colour::from_terms(colour)), finish)
}

const WHITE: [f64; 5] = [1.0, 1.0, 1.0, 0.0, 0.0];
const HALF_CLEAR: [f64; 5] = [1.0, 1.0, 1.0, 0.0, 0.5];

fn picture(scene: &Scene, region: Option<Region>, threads: usize) -> Vec<[f64; 3]> {
    let world = World::new(scene).unwrap();
    let settings = RenderSettings {
        width: SIZE.0,
        height: SIZE.1,
        region,
        threads: Some(threads),
        ..RenderSettings::default()
    };
    let film = render(&world, &settings, &Progress::none()).unwrap().film;
    (0..SIZE.1)
        .flat_map(|y| (0..SIZE.0).map(move |x| (x, y)))
        .map(|(x, y)| film.light(x, y).unwrap_or_default())
        .collect()
}

/// The directions of the camera's rays, in the order of the picture.
fn directions(scene: &Scene) -> Vec<Vec3> {
    let camera = Camera::new(scene.camera.as_ref().unwrap()).unwrap();
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    pixels.map(|(x, y)| camera.pixel(x, y, SIZE.0, SIZE.1).direction).collect()
}

fn wide_camera(location: Vec3, direction: Vec3) -> durer_scene::Camera {
    let direction = direction.normalized().unwrap();
    let right = direction.cross(v(0.31, 0.83, 0.47)).normalized().unwrap();
    let up = right.cross(direction);
    let (right, up) = (right * 2.5, up * 1.9);
    durer_scene::Camera { location: location.to_point(), direction, right, up, ..Default::default() }
}

#[test]
fn the_surface_on_which_the_camera_stands_is_not_seen() {
    for (i, place) in all_places().iter().enumerate() {
        let ahead = place.normals[0].cross(v(0.2, -0.5, 0.7)).normalized().unwrap();
        for view in [ahead, -ahead] {
            let scene = Scene {
                objects: vec![place.body.clone().with_texture(paint(WHITE, 1.0, 0.0))],
                camera: Some(wide_camera(place.point, view)),
                ..Scene::default()
            };
            let (picture, directions) = (picture(&scene, None, 1), directions(&scene));
            for (seen, d) in picture.iter().zip(directions) {
                if let Some(outside) = leads_outside(place, d) {
                    assert_eq!(seen[0] == 0.0, outside, "{i}: {} at {:?}, {d:?}", place.name, place.point);
                }
            }
        }
    }
}

/// A white ball around everything, lit by a light at a place of the body, which the camera does not
/// see.
fn lit_from(place: &Place, location: Vec3, colour: [f64; 5]) -> Scene {
    let around = Shape::Sphere { centre: Point3::ORIGIN, radius: 20.0 };
    let mut body = place.body.clone().with_texture(paint(colour, 0.0, 0.0));
    body.flags = Flags { no_image: true, ..body.flags };
    Scene {
        objects: vec![Object::new(around).with_texture(paint(WHITE, 0.0, 1.0)), body],
        camera: Some(wide_camera(Vec3::ZERO, place.normals[0].cross(v(0.2, -0.5, 0.7)))),
        lights: vec![Light::point(location.to_point(), Rgb::WHITE)],
        ..Scene::default()
    }
}

/// The fraction of the light that reaches each pixel, and the point on the surrounding ball.
fn arriving(scene: &Scene) -> Vec<(f64, Vec3)> {
    let mut free = scene.clone();
    free.lights[0].shadowless = true;
    let (with, without) = (picture(scene, None, 1), picture(&free, None, 1));
    let on_ball = directions(scene).into_iter().map(|d| d * (20.0 / d.length()));
    with.iter().zip(without).map(|(a, b)| a[0] / b[0]).zip(on_ball).collect()
}

#[test]
fn the_surface_on_which_a_light_lies_does_not_shadow_it() {
    for (i, place) in all_places().iter().enumerate() {
        for (colour, behind) in [(WHITE, 0.0), (HALF_CLEAR, 0.5)] {
            for (part, p) in arriving(&lit_from(place, place.point, colour)) {
                if let Some(outside) = leads_outside(place, p - place.point) {
                    let want = if outside { 1.0 } else { behind };
                    let what = format!("{i}: {} at {:?}: {part} at {p:?}", place.name, place.point);
                    assert!((part - want).abs() < 1e-9, "{what} instead of {want}");
                }
            }
        }
    }
}

#[test]
fn a_billionth_beside_the_surface_is_not_on_it() {
    for place in all_places().iter().filter(|place| place.normals.len() == 1) {
        let n = place.normals[0].normalized().unwrap();
        for (away, behind) in [(1e-9, [0.0, 0.25]), (-1e-9, [0.0, 0.5])] {
            let location = place.point + n * away;
            for (colour, behind) in [WHITE, HALF_CLEAR].into_iter().zip(behind) {
                for (part, p) in arriving(&lit_from(place, location, colour)) {
                    let steep = n.dot((p - location).normalized().unwrap());
                    let outside = if colour == WHITE { 0.0 } else { 0.5 };
                    // A ray inward from outside crosses both walls; a ray outward from inside
                    // crosses one.
                    let want = match (steep > 0.1, steep < -0.1) {
                        (true, _) => {
                            if away > 0.0 {
                                1.0
                            } else {
                                outside
                            }
                        }
                        (_, true) => behind,
                        _ => continue,
                    };
                    let what = format!("{} at {:?}: {part} at {p:?}", place.name, place.point);
                    assert!((part - want).abs() < 1e-9, "{what} instead of {want}, {away}");
                }
            }
            let scene = Scene {
                objects: vec![place.body.clone().with_texture(paint(WHITE, 1.0, 0.0))],
                camera: Some(wide_camera(location, n * away)),
                ..Scene::default()
            };
            // The camera looks away from the wall. From inside it sees the opposite wall, from
            // outside nothing.
            for (seen, d) in picture(&scene, None, 1).iter().zip(directions(&scene)) {
                if n.dot(d.normalized().unwrap()).abs() > 0.1 {
                    let sees = away < 0.0 || n.dot(d) < 0.0;
                    assert_eq!(seen[0] > 0.0, sees, "{} at {:?}, {d:?}, {away}", place.name, place.point);
                }
            }
        }
    }
}

#[test]
fn each_ray_of_an_orthographic_camera_stands_where_it_starts() {
    // All rays start on the upper face of the box: those that look down see its floor, those that
    // look up see nothing.
    for (up_or_down, sees) in [(-1.0, true), (1.0, false)] {
        for tilt in [0.0, 0.3, 20.0] {
            let scene = Scene {
                objects: vec![Object::new(boxed(v(3.0, 1.1, 3.0))).with_texture(paint(WHITE, 1.0, 0.0))],
                camera: Some(durer_scene::Camera {
                    projection: Projection::Orthographic,
                    location: Point3::new(0.1, 1.1, 0.2),
                    direction: v(tilt, up_or_down, 0.1),
                    right: v(3.7, 0.0, 0.4),
                    up: v(0.3, 0.0, 3.1),
                    ..durer_scene::Camera::default()
                }),
                ..Scene::default()
            };
            assert!(picture(&scene, None, 1).iter().all(|seen| (seen[0] == 1.0) == sees), "{tilt} {sees}");
        }
    }
}

#[test]
fn a_parallel_light_is_not_shadowed_by_a_surface_in_its_plane() {
    let wall = |distance, normal: Vec3| {
        Object::new(Shape::Plane { normal, distance }).with_texture(paint(WHITE, 0.0, 1.0))
    };
    let mut random = TestRng::new(3);
    for turn in 0..20 {
        let map = match turn {
            0 => Affine::scaling(1.0, 1.0, 1.0).unwrap(),
            _ => Affine::rotation(direction(&mut random), 3.0 * random.signed()).unwrap(),
        };
        for kind in [LightKind::Point, LightKind::Cylinder { radius: 9.0, falloff: 10.0, tightness: 0.0 }] {
            let n = map.normal(Vec3::Y.to_normal()).to_vec();
            let at = |p: Vec3| map.point(p.to_point());
            let mut light = Light {
                kind,
                point_at: at(v(0.3, -1.0, 0.2)),
                parallel: true,
                ..Light::point(at(v(0.3, 1.3, 0.2)), Rgb::WHITE)
            };
            let ceiling = |distance| {
                let mut ceiling = wall(distance, n);
                ceiling.flags.no_image = true;
                ceiling
            };
            let mut scene = Scene {
                objects: vec![wall(-1.0, n), ceiling(1.3)],
                camera: Some(wide_camera(Vec3::ZERO, -n)),
                lights: vec![light.clone()],
                ..Scene::default()
            };
            let lit = picture(&scene, None, 1);
            light.shadowless = true;
            scene.lights[0] = light.clone();
            assert_eq!(lit, picture(&scene, None, 1), "{turn}");
            assert!(lit.iter().any(|seen| seen[0] > 0.5));
            // A ceiling a billionth below the light is between.
            light.shadowless = false;
            (scene.lights[0], scene.objects[1]) = (light, ceiling(1.3 - 1e-9));
            assert!(picture(&scene, None, 1).iter().all(|seen| seen[0] == 0.0), "{turn}");
        }
    }
}

/// A room with a camera in its wall, and lights on its ceiling and on a glass ball.
fn room() -> Scene {
    let glass = paint([1.0, 0.9, 0.8, 0.8, 0.1], 0.1, 0.3);
    let ball = Shape::Sphere { centre: Point3::new(0.1, 0.2, 0.3), radius: 0.7 };
    let interior = Interior { ior: 1.3, fade_distance: 1.0, fade_power: 1.0, ..Interior::default() };
    let mirror = Shape::Torus { major: 1.2, minor: 0.3 };
    Scene {
        objects: vec![
            Object::new(boxed(v(2.1, 1.3, 3.2))).with_texture(paint(WHITE, 0.1, 0.7)),
            Object::new(ball).with_texture(glass).with_interior(interior),
            Object::new(mirror).with_texture(paint(WHITE, 0.2, 0.5)),
        ],
        camera: Some(wide_camera(v(2.1, 0.4, -0.9), v(-1.0, -0.1, 0.4))),
        lights: vec![
            Light::point(Point3::new(0.3, 1.3, -1.2), Rgb::grey(0.5)),
            Light::point(Point3::new(0.1, 0.2 + 0.7, 0.3), Rgb::new(0.5, 0.2, 0.1)),
            Light::point(Point3::new(1.5, 0.0, 0.0), Rgb::new(0.1, 0.2, 0.5)),
        ],
        background: Background(Colour::opaque(Rgb::new(0.0, 1.0, 0.0))),
        ..Scene::default()
    }
}

#[test]
fn the_picture_does_not_depend_on_how_rays_are_bundled() {
    let scene = room();
    let all = picture(&scene, None, 1);
    assert!(
        all.iter().all(|seen| seen[0] > 0.0),
        "the wall in which the camera stands is not seen, the others are"
    );
    assert_eq!(all, picture(&scene, None, 3));
    // Single pixels go through other kernels than bundles.
    for (x, y) in [(0, 0), (5, 7), (12, 9), (23, 17), (17, 3), (8, 12)] {
        let region = Region { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        let i = (y * SIZE.0 + x) as usize;
        assert_eq!(all[i], picture(&scene, Some(region), 1)[i], "{x}, {y}");
    }
}

#[test]
fn many_sheets_at_a_light_let_it_pass_and_as_many_before_it_do_not() {
    let sheet = |z: f64| {
        Object::new(Shape::Disc { centre: Point3::new(0.0, 0.0, z), normal: Vec3::Z, radius: 9.0, hole: 0.0 })
            .with_texture(paint(HALF_CLEAR, 0.0, 0.0))
    };
    let wall =
        Object::new(Shape::Plane { normal: Vec3::Z, distance: 3.0 }).with_texture(paint(WHITE, 0.0, 1.0));
    let lit = |sheets: Vec<Object>| {
        let scene = Scene {
            objects: core::iter::once(wall.clone()).chain(sheets).collect(),
            camera: Some(wide_camera(v(0.0, 0.0, 2.0), Vec3::Z)),
            lights: vec![Light::point(Point3::new(0.0, 0.0, 1.0), Rgb::WHITE)],
            ..Scene::default()
        };
        picture(&scene, None, 1)
    };
    let free = lit(Vec::new());
    assert_eq!(free, lit((0..20).map(|_| sheet(1.0)).collect()));
    let dim = lit(vec![sheet(1.0), sheet(1.5), sheet(1.0)]);
    assert!(free.iter().zip(dim).all(|(free, dim)| (dim[0] - 0.5 * free[0]).abs() < 1e-12 * free[0]));
}

#[test]
fn layers_of_a_texture_do_not_change_what_lies_on_a_light() {
    let texture = Texture::layers(
        [HALF_CLEAR, [0.5, 1.0, 1.0, 1.0, 0.0]]
            .map(|colour| Layer {
                pigment: Pigment::solid(Colour::from_terms(colour)),
                normal: None,
                finish: Arc::new(Finish::default()),
            })
            .into(),
    );
    for place in all_places().iter().take(30) {
        let mut scene = lit_from(place, place.point, WHITE);
        scene.objects[1].texture = Some(Arc::new(texture.clone()));
        for (part, p) in arriving(&scene) {
            if let Some(outside) = leads_outside(place, p - place.point) {
                let want = if outside { 1.0 } else { 0.25 };
                assert!((part - want).abs() < 1e-9, "{} at {:?}: {part}, {want}", place.name, place.point);
            }
        }
    }
}
