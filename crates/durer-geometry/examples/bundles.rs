//! The cost of a camera ray by itself, with a search shared by its neighbours, and in a packet:
//! prints nanoseconds for small worlds.
//!
//! `cargo run --release -p durer-geometry --example bundles`

use durer_geometry::{EVERYTHING, Geometry, Hits8, Rays8, Scratch};
use durer_math::{Affine, M8, Point3, Ray, Vec3};
use durer_surfaces::{AxisBox, CappedCylinder, Ellipsoid, Frustum, Need, Placed, Plane, Sphere};
use std::hint::black_box;
use std::time::Instant;

/// Pixels per side.
const SIZE: usize = 512;
/// Blocks are squares of this many pixels.
const BLOCK: usize = 8;

fn worlds() -> Vec<(&'static str, Geometry)> {
    let o = Point3::ORIGIN;
    let turn = Affine::rotation_x(0.7).expect("an angle").then(&Affine::rotation_z(-0.4).expect("an angle"));
    let turn = turn.expect("two turns are a turn");
    let ground = Plane::new(Vec3::Y, -1.0).expect("a plane");
    let world = |builder: durer_geometry::Builder| builder.build().expect("a small world");
    let with = |add: &dyn Fn(&mut durer_geometry::Builder)| {
        let mut builder = Geometry::builder();
        builder.add(ground);
        add(&mut builder);
        world(builder)
    };
    vec![
        ("plane", with(&|_| {})),
        (
            "sphere",
            with(&|b| {
                b.add(Sphere::new(o, 1.0).expect("a sphere"));
            }),
        ),
        (
            "box",
            with(&|b| {
                let (min, max) = (Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
                b.add(Placed::new(AxisBox::new(min, max).expect("a box"), turn));
            }),
        ),
        (
            "cylinder",
            with(&|b| {
                let (base, cap) = (Point3::new(0.0, -1.0, 0.0), Point3::new(0.3, 1.0, 0.2));
                b.add(CappedCylinder::new(base, cap, 0.7).expect("a cylinder"));
            }),
        ),
        (
            "cone",
            with(&|b| {
                let (base, cap) = (Point3::new(0.0, -1.0, 0.0), Point3::new(0.3, 1.0, 0.2));
                b.add(Frustum::new(base, 1.0, cap, 0.3).expect("a cone"));
            }),
        ),
        (
            "ellipsoid",
            with(&|b| {
                b.add(Placed::new(Ellipsoid::new(1.2, 0.8, 0.6).expect("an ellipsoid"), turn));
            }),
        ),
        (
            "spheres",
            with(&|b| {
                for i in 0..49 {
                    let (x, y) = (f64::from(i % 7) - 3.0, f64::from(i / 7) - 3.0);
                    b.add(Sphere::new(Point3::new(x * 0.5, y * 0.5, 0.0), 0.3).expect("a sphere"));
                }
            }),
        ),
    ]
}

fn ray(x: usize, y: usize) -> Ray {
    let at = |i: usize| (i as f64 + 0.5) / SIZE as f64 - 0.5;
    Ray::new(Point3::new(0.0, 0.5, -4.0), Vec3::new(at(x), -at(y), 1.0))
}

fn main() {
    println!("{:>10}{:>10}{:>10}{:>10}", "world", "alone", "shared", "lanes");
    let mut scratch = Scratch::default();
    for (name, world) in worlds() {
        let mut times = [f64::INFINITY; 3];
        for _ in 0..5 {
            for (way, time) in times.iter_mut().enumerate() {
                let start = Instant::now();
                for block in 0..(SIZE / BLOCK) * (SIZE / BLOCK) {
                    let (bx, by) = (block % (SIZE / BLOCK) * BLOCK, block / (SIZE / BLOCK) * BLOCK);
                    trace(&world, way, (bx, by), &mut scratch);
                }
                *time = time.min(start.elapsed().as_secs_f64() * 1e9 / (SIZE * SIZE) as f64);
            }
        }
        println!("{name:>10}{:>10.1}{:>10.1}{:>10.1}", times[0], times[1], times[2]);
    }
}

fn trace(world: &Geometry, way: usize, (bx, by): (usize, usize), scratch: &mut Scratch) {
    let mut rays = [Rays8::NONE; BLOCK];
    for (y, eight) in rays.iter_mut().enumerate() {
        for x in 0..8 {
            let ray = ray(bx + x, by + y);
            eight.direction.set_lane(x, ray.direction);
            (eight.origin.x.0[x], eight.origin.y.0[x], eight.origin.z.0[x]) =
                (ray.origin.x, ray.origin.y, ray.origin.z);
            eight.t_max.0[x] = f64::INFINITY;
        }
        eight.live = M8::ALL;
    }
    let beam = if way > 0 { world.bundle_candidates(&rays) } else { None };
    if way == 2 {
        let mut hits = [Hits8::NONE; BLOCK];
        world.first_visible8(beam.as_ref(), &rays, EVERYTHING, &mut hits, scratch);
        black_box(&hits);
        return;
    }
    for y in 0..rays.len() {
        for x in 0..8 {
            let ray = ray(bx + x, by + y);
            black_box(match &beam {
                Some(beam) => world.seen_in(beam, &ray, EVERYTHING, Need::SHADING_NORMAL),
                None => world.masked(EVERYTHING).first_visible(&ray, Need::SHADING_NORMAL),
            });
        }
    }
}
