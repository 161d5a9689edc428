//! Closed meshes do not leak: a ray from inside crosses an odd number of faces, also one aimed at a
//! vertex, at an edge, or along an axis.
//!
//! `DURER_SOAK=N` traces N times as many rays, and `DURER_SOAK_FROM=K` skips the rays of K such
//! runs (`cargo xtask soak`).

mod common;

use durer_geometry::{EVERYTHING, Geometry, Settings};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{Mesh, MeshData};
use durer_testkit::TestRng;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// A closed mesh around the origin.
struct Body {
    data: MeshData,
    /// How far rays may start from the origin, per axis, and still be inside.
    room: f64,
}

/// The surface of the cube `[-n, n]^3`, each face a grid of squares of side 1, cut in two. All
/// coordinates are integers.
fn cube(n: i32) -> Body {
    let mut data = MeshData::default();
    let mut numbers = HashMap::new();
    let mut corner = |data: &mut MeshData, p: [i32; 3]| {
        *numbers.entry(p).or_insert_with(|| {
            data.vertices.push(Point3::from(p.map(f64::from)));
            data.vertices.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        for side in [-n, n] {
            for u in -n..n {
                for v in -n..n {
                    let at = |u: i32, v: i32| {
                        let mut p = [0; 3];
                        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, u, v);
                        p
                    };
                    let square = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
                    let [a, b, c, d] = square.map(|p| corner(&mut data, p));
                    // The diagonal alternates.
                    if (u + v) % 2 == 0 {
                        data.faces.extend([[a, b, c], [a, c, d]]);
                    } else {
                        data.faces.extend([[a, b, d], [b, c, d]]);
                    }
                }
            }
        }
    }
    Body { data, room: f64::from(n) - 1.0 }
}

/// An icosahedron whose faces are subdivided into four `levels` times, each new corner moved onto
/// the sphere of radius 64.
fn icosphere(levels: u32) -> Body {
    const RADIUS: f64 = 64.0;
    let golden = 0.5 + 1.25_f64.sqrt();
    let onto = |v: Vec3| (v * (RADIUS / v.length())).to_point();
    let mut vertices = Vec::new();
    for i in 0..3 {
        for (x, y) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut v = [0.0; 3];
            (v[i], v[(i + 1) % 3]) = (x, y);
            vertices.push(onto(Vec3::from(v)));
        }
    }
    // Its faces are the triples of vertices that are nearest to each other.
    let near = |a: usize, b: usize| (vertices[a] - vertices[b]).length() < 1.1 * RADIUS;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    faces.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    assert_eq!(faces.len(), 20);
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = vertices[a as usize].to_vec() + vertices[b as usize].to_vec();
                vertices.push(onto(sum));
                vertices.len() as u32 - 1
            })
        };
        let cut = |[a, b, c]: [u32; 3]| {
            let (x, y, z) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, x, z], [x, b, y], [z, y, c], [x, y, z]]
        };
        faces = faces.into_iter().flat_map(cut).collect();
    }
    Body { data: MeshData { vertices, faces, ..MeshData::default() }, room: 0.4 * RADIUS }
}

/// An icosphere with some corners pulled far out: long triangles, which get spatial splits, beside
/// small ones.
fn urchin() -> Body {
    let mut body = icosphere(4);
    for v in body.data.vertices.iter_mut().step_by(9) {
        *v = (v.to_vec() * 8.0).to_point();
    }
    body
}

/// The body scaled and moved, each coordinate rounded: neighbours still share their corners.
fn moved(body: &Body, scale: f64, by: f64) -> (MeshData, Point3) {
    let centre = Point3::new(by, -0.5 * by, 0.25 * by);
    let mut data = body.data.clone();
    data.vertices.iter_mut().for_each(|v| *v = centre + v.to_vec() * scale);
    (data, centre)
}

/// A ray from inside: half of them are aimed at vertices and at points of edges, and some along an
/// axis.
fn ray(dice: &mut TestRng, data: &MeshData, centre: Point3, room: f64) -> Ray {
    let place = if dice.below(2) == 0 {
        // Some start in one plane with corners of the mesh.
        let mut x = || (dice.below(9) as f64 - 4.0) * 0.125 * room;
        centre + Vec3::new(x(), x(), x())
    } else {
        centre + (dice.vector() * (0.57 * room))
    };
    let face = data.faces[dice.below(data.faces.len() as u64) as usize];
    let corner = |i: usize| data.vertices[face[i] as usize];
    match dice.below(8) {
        0..2 => Ray::new(place, corner(0) - place),
        2..4 => Ray::new(place, corner(0) + (corner(1) - corner(0)) * (dice.below(5) as f64 * 0.25) - place),
        4 => {
            let axis = [Vec3::X, Vec3::Y, Vec3::Z][dice.below(3) as usize];
            Ray::new(place, if dice.below(2) == 0 { axis } else { -axis })
        }
        _ => Ray::new(place, dice.vector()),
    }
}

/// Traces so many times a thousand rays from inside, the first of them with this number: none
/// escapes, and each crosses an odd number of times.
///
/// For each ray all crossings are counted; one ray in four also makes the closest-hit query, and
/// another one the any-hit query, which take as long.
fn shoot(world: &Geometry, data: &MeshData, centre: Point3, room: f64, thousands: Range<u64>, name: &str) {
    thousands.into_par_iter().for_each(|seed| {
        let mut dice = TestRng::new(seed << 32);
        for i in 0..1000 {
            let ray = ray(&mut dice, data, centre, room);
            let all = world.all(&ray);
            let crossings = all.iter().filter(|hit| hit.sign != 0).count();
            assert!(crossings % 2 == 1, "{name}: {crossings} crossings of {ray:?}");
            match i % 4 {
                0 => {
                    let first = all.first().map(|hit| hit.t);
                    assert_eq!(world.closest(&ray).map(|hit| hit.t), first, "{name}: {ray:?}");
                }
                1 => assert!(world.any(&ray), "{name}: {ray:?} gets out"),
                _ => {}
            }
        }
    });
}

#[test]
fn closed_meshes_leak_nowhere() {
    leak_nowhere(&[("cube", cube(12)), ("icosphere", icosphere(4))], &Settings::GOOD);
}

#[test]
fn closed_meshes_leak_nowhere_in_trees_that_were_built_fast() {
    leak_nowhere(&[("urchin", urchin())], &Settings::FAST);
}

#[test]
fn closed_meshes_leak_nowhere_where_triangles_stand_in_several_leaves() {
    let shared = leak_nowhere(&[("urchin", urchin())], &Settings::BEST);
    assert!(shared > 500, "{shared} more references than triangles");
}

/// Returns how many more references than triangles there were.
fn leak_nowhere(bodies: &[(&str, Body)], settings: &Settings) -> u64 {
    let variable = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    let (soak, from) = (variable("DURER_SOAK"), variable("DURER_SOAK_FROM").unwrap_or(0));
    let part = |thousands: u64| thousands * from..thousands * (from + soak.unwrap_or(1));
    let (mut shared, mut rays) = (0, 0);
    for (name, body) in bodies {
        for (scale, by) in [(1.0, 0.0), (1.0, 1e5), (1.0, 1e6), (1e-6, 0.0), (1e-6, 1.0)] {
            let (data, centre) = moved(body, scale, by);
            let room = body.room * scale;
            let mesh = Mesh::new(data.clone()).unwrap();
            let world = Geometry::builder().settings(*settings).with(mesh).build().unwrap();
            let stats = world.stats();
            shared += stats.tree.entries as u64 - stats.primitives;
            shoot(&world, &data, centre, room, part(32), &format!("{name} times {scale} at {by}"));
            rays += 1000 * soak.unwrap_or(1) * (32 + 8);
            // The same mesh, placed: now the rays have errors, and take several times as long.
            let place = Affine::rotation(Vec3::new(1.0, 2.0, -0.5), 0.7).unwrap();
            let placed =
                Geometry::builder().with_instance(&Arc::new(world), place, EVERYTHING).build().unwrap();
            let mut data = data;
            data.vertices.iter_mut().for_each(|v| *v = place.point(*v));
            shoot(
                &placed,
                &data,
                place.point(centre),
                room,
                part(8),
                &format!("placed {name} times {scale} at {by}"),
            );
        }
    }
    if soak.is_some() {
        // The soak adds up these lines.
        println!("soaked: {} {rays}", std::thread::current().name().unwrap_or("leaks"));
    }
    shared
}
