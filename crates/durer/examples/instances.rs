//! A million placements of one mesh: how long they take to build, what they weigh, how long a
//! picture's rays take.
//!
//! ```text
//! cargo run --release -p durer --example instances [-- MESH [COUNT]]
//! ```
//!
//! `MESH` is any mesh file that durer reads; without one, a knotted tube of 70 000 triangles stands
//! in for it. The placements fill a cube, each turned and scaled at random, so that their boxes
//! overlap; the camera looks at the cube from outside.

use durer::geometry::{EVERYTHING, Geometry, ObjectId, PrimitiveId};
use durer::math::elementary::sin_cos;
use durer::math::{Affine, Point3, Ray, Vec3};
use durer::surfaces::{Mesh, MeshData};
use rayon::prelude::*;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const WIDTH: u32 = 1920;
const HEIGHT: u32 = 1080;

/// Numbers that look random: the n-th output of G. L. Steele, D. Lea, C. H. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA (2014), in `[0, 1)`.
fn unit(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// A tube around a trefoil knot, closed: 512 rings of 68 points.
fn knot() -> Result<Mesh, Box<dyn Error>> {
    const RINGS: u32 = 512;
    const AROUND: u32 = 68;
    let axis = |u: f64| {
        let ((sin3, cos3), (sin2, cos2)) = (sin_cos(3.0 * u), sin_cos(2.0 * u));
        Vec3::new((2.0 + cos3) * cos2, (2.0 + cos3) * sin2, sin3)
    };
    let mut data = MeshData::default();
    for i in 0..RINGS {
        let u = f64::from(i) * std::f64::consts::TAU / f64::from(RINGS);
        let (here, next) = (axis(u), axis(u + 1e-3));
        let along = next - here;
        let side = along.cross(Vec3::Z) * (1.0 / along.cross(Vec3::Z).length());
        let up = side.cross(along) * (1.0 / along.length());
        for j in 0..AROUND {
            let v = f64::from(j) * std::f64::consts::TAU / f64::from(AROUND);
            let (sin, cos) = sin_cos(v);
            data.vertices.push((here + side * (0.4 * cos) + up * (0.4 * sin)).to_point());
            let at = |i: u32, j: u32| (i % RINGS) * AROUND + j % AROUND;
            data.faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            data.faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Ok(Mesh::new(data)?)
}

/// How many cells a cube of at least so many has along each side.
fn cells_along(count: u64) -> u64 {
    (1..).find(|n| n * n * n >= count).unwrap_or(1)
}

/// Placement `i` of `count` in a cube of as many cells: turned about an axis at random, and larger
/// than its cell.
fn placement(i: u64, count: u64, size: f64, middle: Point3) -> Result<Affine, Box<dyn Error>> {
    let side = cells_along(count);
    let at = |n: u64| unit(16 * i + n) - 0.5;
    let cell = Vec3::new((i % side) as f64, (i / side % side) as f64, (i / side / side) as f64);
    let scale = (0.8 + 0.4 * unit(16 * i + 7)) / size;
    let turn = Affine::rotation(Vec3::new(at(0), at(1), at(2)), std::f64::consts::TAU * at(3))?;
    let back = Affine::translation(Point3::ORIGIN - middle)?;
    let jitter = Vec3::new(at(4), at(5), at(6));
    Ok(back
        .then(&Affine::scaling(scale, scale, scale)?)?
        .then(&turn)?
        .then(&Affine::translation(cell + jitter)?)?)
}

/// The most memory this process ever held, in bytes, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut builder = Geometry::builder();
    match arguments.next() {
        Some(path) => {
            for group in durer::mesh::read(Path::new(&path))?.groups {
                let data = MeshData {
                    vertices: group.mesh.vertices.clone(),
                    faces: group.mesh.faces.iter().map(|face| face.vertices).collect(),
                    ..MeshData::default()
                };
                builder.add(Mesh::new(data)?);
            }
        }
        None => {
            builder.add(knot()?);
        }
    }
    let count: u64 = arguments.next().map_or(Ok(1_000_000), |n| n.parse())?;
    let start = Instant::now();
    let body = Arc::new(builder.build()?);
    let bounds = body.bounds();
    println!(
        "the mesh: {} triangles, built in {:.2} s",
        body.stats().primitives,
        start.elapsed().as_secs_f64()
    );

    let size = (bounds.max - bounds.min).max_abs();
    let middle = bounds.min + (bounds.max - bounds.min) * 0.5;
    let start = Instant::now();
    let mut builder = Geometry::builder();
    let mut first = 0;
    while first < count {
        let next = count.min(first + (1 << 13));
        let place = |i: u64| placement(i, count, size, middle).map_err(|e| e.to_string());
        let places: Result<Vec<Affine>, String> = (first..next).into_par_iter().map(place).collect();
        for place in places? {
            builder.instance_as(&body, place, ObjectId(0), PrimitiveId(0), EVERYTHING);
        }
        first = next;
    }
    println!("{count} placements computed in {:.2} s", start.elapsed().as_secs_f64());

    let start = Instant::now();
    let world = builder.build()?;
    let stats = world.stats();
    println!(
        "built in {:.2} s; {:.0} MB, {:.0} bytes a placement, of which the tree {:.0}",
        start.elapsed().as_secs_f64(),
        stats.bytes as f64 * 1e-6,
        stats.bytes as f64 / count as f64,
        stats.tree.bytes as f64 / count as f64
    );

    let edge = cells_along(count) as f64;
    let eye = Point3::new(1.9 * edge, 1.5 * edge, -1.2 * edge);
    let ahead = Point3::new(0.5 * edge, 0.45 * edge, 0.5 * edge) - eye;
    let right = Vec3::Y.cross(ahead) * (1.0 / Vec3::Y.cross(ahead).length());
    let up = ahead.cross(right) * (1.0 / ahead.length());
    let reach = 0.5 * ahead.length();
    let start = Instant::now();
    let rows = (0..HEIGHT).into_par_iter().map(|y| {
        let ray = |x: u32| {
            let (u, v) = (
                f64::from(2 * x + 1) / f64::from(WIDTH) - 1.0,
                f64::from(2 * y + 1) / f64::from(HEIGHT) - 1.0,
            );
            let v = v * f64::from(HEIGHT) / f64::from(WIDTH);
            Ray::new(eye, ahead + right * (u * reach) - up * (v * reach))
        };
        (0..WIDTH).filter(|&x| world.closest(&ray(x)).is_some()).count()
    });
    let hits: usize = rows.sum();
    println!("{WIDTH}x{HEIGHT} camera rays in {:.2} s, {hits} hits", start.elapsed().as_secs_f64());
    if let Some(peak) = peak() {
        println!("at most {:.0} MB held", peak * 1e-6);
    }
    Ok(())
}
