//! The cost of a ray in CSG solids of 100 and of 10 000 leaves: prints nanoseconds per ray, the
//! least of several runs.
//!
//! `cargo run --release -p durer-geometry --example csg_scaling`

use durer_geometry::{Compound, CompoundBuilder, Geometry, Part};
use durer_math::{Point3, Ray};
use durer_surfaces::{AxisBox, CappedCylinder, Sphere, laws::TestRng};
use std::time::Instant;

const RAYS: usize = 20_000;

fn main() {
    let rays = rays();
    println!("{:<22} {:>12} {:>12} {:>8}", "ns per ray", "100 leaves", "10000 leaves", "ratio");
    for (name, body) in bodies() {
        let scenes = [100, 10_000].map(|leaves| scene(body, leaves));
        let queries: [(&str, Ask); 3] = [
            ("closest", |s, r| usize::from(s.closest(r).is_some())),
            ("any", |s, r| usize::from(s.any(r))),
            ("all", |s, r| s.all(r).len()),
        ];
        for (query, ask) in queries {
            let [few, many] = scenes.each_ref().map(|scene| time(&rays, |ray| ask(scene, ray)));
            let what = format!("{name}, {query}");
            println!("{what:<22} {:>12.0} {:>12.0} {:>8.2}", few.0, many.0, many.0 / few.0);
            println!("{:<22} {:>12} {:>12}", "  crossings", few.1, many.1);
        }
    }
}

/// Rays from all around at points of a cube.
fn rays() -> Vec<Ray> {
    let mut dice = TestRng::new(1);
    let point = |dice: &mut TestRng| {
        loop {
            let v = dice.vector();
            if v.length() <= 1.0 && v.length() > 0.1 {
                return v;
            }
        }
    };
    let one = |_| {
        let v = point(&mut dice);
        let origin = (v * (4.0 / v.length())).to_point();
        Ray::new(origin, dice.vector().to_point() - origin)
    };
    (0..RAYS).map(one).collect()
}

type Ask = fn(&Geometry, &Ray) -> usize;

type Body = fn(&mut CompoundBuilder, u32) -> Part;

fn bodies() -> [(&'static str, Body); 4] {
    [
        ("plate with holes", |csg, count| {
            let side = f64::from(count).sqrt() as u32;
            let at = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
            let plate = block(csg, Point3::new(-1.0, -0.05, -1.0), Point3::new(1.0, 0.05, 1.0));
            let holes = (0..side * side).map(|i| {
                let (x, z) = (at(i % side), at(i / side));
                let r = 0.7 / f64::from(side);
                let hole = CappedCylinder::new(Point3::new(x, -1.0, z), Point3::new(x, 1.0, z), r);
                csg.leaf(hole.expect("a cylinder")).expect("a solid")
            });
            let holes: Vec<Part> = holes.collect();
            csg.difference(plate, holes)
        }),
        ("lattice of hollows", |csg, count| {
            let side = (1..).find(|n: &u32| n.pow(3) >= count).unwrap_or(1);
            let at = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
            let cube = block(csg, Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
            let balls: Vec<Part> = (0..count)
                .map(|i| {
                    let c = Point3::new(at(i % side), at(i / side % side), at(i / side / side));
                    ball(csg, c, 0.9 / f64::from(side))
                })
                .collect();
            csg.difference(cube, balls)
        }),
        ("balls less balls", |csg, count| {
            let mut dice = TestRng::new(5);
            let r = 1.2 / durer_math::elementary::cbrt(f64::from(count));
            let balls = (0..count).map(|_| ball(csg, dice.vector().to_point(), r));
            let mut balls: Vec<Part> = balls.collect();
            let less = balls.split_off(balls.len() / 2);
            let union = csg.union(balls);
            csg.difference(union, less)
        }),
        ("sheets with craters", |csg, count| {
            let mut dice = TestRng::new(6);
            let sheets = (0..count / 2).map(|i| {
                let x = 4.0 * f64::from(i) / f64::from(count) - 1.0;
                block(csg, Point3::new(x, -1.0, -1.0), Point3::new(x + 2.0 / f64::from(count), 1.0, 1.0))
            });
            let sheets: Vec<Part> = sheets.collect();
            let r = 1.2 / durer_math::elementary::cbrt(f64::from(count));
            let craters: Vec<Part> = (0..count / 2).map(|_| ball(csg, dice.vector().to_point(), r)).collect();
            let whole = csg.union(sheets);
            csg.difference(whole, craters)
        }),
    ]
}

fn ball(csg: &mut CompoundBuilder, c: Point3, r: f64) -> Part {
    csg.leaf(Sphere::new(c, r).expect("a ball")).expect("a solid")
}

fn block(csg: &mut CompoundBuilder, a: Point3, b: Point3) -> Part {
    csg.leaf(AxisBox::new(a, b).expect("a box")).expect("a solid")
}

fn scene(body: Body, leaves: u32) -> Geometry {
    let mut csg = Compound::builder();
    let whole = body(&mut csg, leaves);
    let body = csg.build(whole).expect("a body");
    Geometry::builder().with_compound(body).build().expect("a scene")
}

fn time(rays: &[Ray], ask: impl Fn(&Ray) -> usize) -> (f64, usize) {
    let mut best = f64::INFINITY;
    let mut met = 0;
    for _ in 0..5 {
        let start = Instant::now();
        met = rays.iter().map(&ask).sum();
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64);
    }
    (best, met)
}
