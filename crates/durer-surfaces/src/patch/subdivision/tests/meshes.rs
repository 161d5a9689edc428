//! Control meshes.

use super::super::{Boundary, Scheme, SubdivisionData};
use crate::laws::TestRng;
use durer_math::{Point3, Vec3};

pub(super) fn cube() -> SubdivisionData {
    let at = |k: u32| Point3::from([k >> 2, k >> 1 & 1, k & 1].map(|b| f64::from(b) * 2.0 - 1.0));
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    SubdivisionData {
        vertices: (0..8).map(at).collect(),
        faces: faces.iter().map(|f| f.to_vec()).collect(),
        ..SubdivisionData::default()
    }
}

/// Two tips above and below a ring of `n`, in triangles.
pub(super) fn double_pyramid(n: usize) -> SubdivisionData {
    let ring = |k: usize| {
        let (sin, cos) = durer_math::elementary::sin_cos(2.0 * core::f64::consts::PI * k as f64 / n as f64);
        Point3::new(cos, sin, 0.0)
    };
    let mut vertices: Vec<Point3> = (0..n).map(ring).collect();
    vertices.extend([[0.0, 0.0, 1.0], [0.1, 0.0, -1.0]].map(Point3::from));
    let at = |k: usize| (k % n) as u32;
    let (top, bottom) = (n as u32, n as u32 + 1);
    let faces = (0..n).flat_map(|k| [vec![at(k), at(k + 1), top], vec![at(k + 1), at(k), bottom]]).collect();
    SubdivisionData { vertices, faces, ..SubdivisionData::default() }
}

/// A prism over a polygon of `n`: its ends are polygons.
pub(super) fn prism(n: usize) -> SubdivisionData {
    let ring = |k: usize, z: f64| {
        let (sin, cos) = durer_math::elementary::sin_cos(2.0 * core::f64::consts::PI * k as f64 / n as f64);
        Point3::new(cos, sin, z)
    };
    let vertices = (0..n).map(|k| ring(k, -1.0)).chain((0..n).map(|k| ring(k, 1.0))).collect();
    let at = |k: usize, up: usize| (k % n + up * n) as u32;
    let mut faces: Vec<Vec<u32>> =
        (0..n).map(|k| vec![at(k, 0), at(k + 1, 0), at(k + 1, 1), at(k, 1)]).collect();
    faces.push((0..n).rev().map(|k| at(k, 0)).collect());
    faces.push((0..n).map(|k| at(k, 1)).collect());
    SubdivisionData { vertices, faces, ..SubdivisionData::default() }
}

/// A plate of small cubes with three holes through it: genus 3.
pub(super) fn plate() -> SubdivisionData {
    let full = |x: i32, y: i32, z: i32| {
        z == 0 && (0..7).contains(&x) && (0..3).contains(&y) && !(y == 1 && (x == 1 || x == 3 || x == 5))
    };
    let mut numbers = std::collections::BTreeMap::new();
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for x in 0..7 {
        for y in 0..3 {
            if !full(x, y, 0) {
                continue;
            }
            for axis in 0..3 {
                for end in [0, 1] {
                    let mut next = [x, y, 0];
                    next[axis] += 2 * end - 1;
                    if full(next[0], next[1], next[2]) {
                        continue;
                    }
                    let mut face: Vec<u32> = [[0, 0], [1, 0], [1, 1], [0, 1]]
                        .iter()
                        .map(|[a, b]| {
                            let mut p = [x, y, 0];
                            p[axis] += end;
                            p[(axis + 1) % 3] += a;
                            p[(axis + 2) % 3] += b;
                            *numbers.entry(p).or_insert_with(|| {
                                let [x, y, z] = p.map(f64::from);
                                vertices.push(Point3::new((x - 3.5) / 3.0, (y - 1.5) / 3.0, (z - 0.5) / 2.0));
                                vertices.len() as u32 - 1
                            })
                        })
                        .collect();
                    if end == 0 {
                        face.reverse();
                    }
                    faces.push(face);
                }
            }
        }
    }
    SubdivisionData { vertices, faces, ..SubdivisionData::default() }
}

pub(super) fn grid(
    nu: usize,
    nv: usize,
    smooth: bool,
    mut at: impl FnMut(usize, usize) -> Vec3,
) -> SubdivisionData {
    let mut vertices = Vec::new();
    for j in 0..nv {
        for i in 0..nu {
            vertices.push(at(i, j).to_point());
        }
    }
    let v = |i: usize, j: usize| (j * nu + i) as u32;
    let mut faces = Vec::new();
    for j in 0..nv - 1 {
        for i in 0..nu - 1 {
            faces.push(vec![v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)]);
        }
    }
    let boundary = if smooth { Boundary::Smooth } else { Boundary::Corners };
    SubdivisionData { vertices, faces, boundary, ..SubdivisionData::default() }
}

/// The same mesh in triangles from the first vertex of each face, under Loop's rules.
pub(super) fn triangulated(mut data: SubdivisionData) -> SubdivisionData {
    let fan =
        |face: &Vec<u32>| (2..face.len()).map(|k| vec![face[0], face[k - 1], face[k]]).collect::<Vec<_>>();
    data.faces = data.faces.iter().flat_map(fan).collect();
    data.scheme = Scheme::Loop;
    data
}

/// A torus of triangles, six round each vertex.
pub(super) fn torus(n: usize, m: usize) -> SubdivisionData {
    let turn = |k: usize, n: usize| {
        durer_math::elementary::sin_cos(2.0 * core::f64::consts::PI * k as f64 / n as f64)
    };
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let ((sa, ca), (sb, cb)) = (turn(i, n), turn(j, m));
            let r = 1.0 + 0.45 * cb;
            vertices.push(Point3::new(r * ca, r * sa, 0.45 * sb));
            let at = |a: usize, b: usize| ((i + a) % n * m + (j + b) % m) as u32;
            faces.push(vec![at(0, 0), at(1, 0), at(1, 1)]);
            faces.push(vec![at(0, 0), at(1, 1), at(0, 1)]);
        }
    }
    SubdivisionData { scheme: Scheme::Loop, vertices, faces, ..SubdivisionData::default() }
}

pub(super) fn creased(
    mut data: SubdivisionData,
    creases: &[(u32, u32, f64)],
    corners: &[(u32, f64)],
) -> SubdivisionData {
    data.creases = creases.iter().map(|&(a, b, s)| ([a, b], s)).collect();
    data.corners = corners.to_vec();
    data
}

pub(super) fn closed_meshes() -> Vec<(String, SubdivisionData)> {
    let mut all = vec![("cube".to_string(), cube()), ("plate".to_string(), plate())];
    for n in [3, 4, 5, 7, 12, 50] {
        all.push((format!("pyramid {n}"), double_pyramid(n)));
    }
    for n in [3, 5, 9] {
        all.push((format!("prism {n}"), prism(n)));
    }
    all.push(("cube, one edge".into(), creased(cube(), &[(0, 1, 2.5)], &[])));
    all.push(("cube, sharp edge".into(), creased(cube(), &[(0, 1, 10.0)], &[])));
    let ring = [(0, 1), (1, 3), (3, 2), (2, 0)];
    let with = |s: f64| ring.map(|(a, b)| (a, b, s));
    all.push(("cube, sharp face".into(), creased(cube(), &with(10.0), &[])));
    all.push(("cube, less sharp face".into(), creased(cube(), &with(1.25), &[])));
    all.push((
        "cube, mixed".into(),
        creased(cube(), &[(0, 1, 0.5), (1, 3, 2.25), (3, 2, 10.0), (2, 6, 1.0)], &[(7, 1.5), (5, 10.0)]),
    ));
    let edges: Vec<_> =
        (0..8_u32).flat_map(|a| [1, 2, 4].map(|b| (a, a ^ b, 10.0))).filter(|(a, b, _)| a < b).collect();
    all.push(("cube, all sharp".into(), creased(cube(), &edges, &[])));
    let quads = std::mem::take(&mut all);
    // Triangles have no need of the many that take longest.
    let kept = ["plate", "cube, sharp edge", "cube, sharp face", "cube, mixed", "cube, all sharp"];
    for (name, data) in &quads {
        if kept.contains(&name.as_str()) || name.starts_with("pyramid") || name == "prism 5" {
            all.push((format!("{LOOP}{name}"), triangulated(data.clone())));
        }
    }
    all.push((format!("{LOOP}torus"), torus(5, 4)));
    let ring: Vec<_> = (0..5).map(|i| (4 * i, 4 * ((i + 1) % 5), 10.0)).collect();
    all.push((format!("{LOOP}torus, sharp ring"), creased(torus(5, 4), &ring, &[])));
    let ring: Vec<_> = ring.iter().map(|&(a, b, _)| (a, b, 1.75)).collect();
    all.push((format!("{LOOP}torus, less sharp"), creased(torus(5, 4), &ring, &[(2, 10.0), (7, 1.5)])));
    quads.into_iter().chain(all).collect()
}

/// How names of meshes under Loop's rules begin.
const LOOP: &str = "loop: ";

pub(super) fn all_meshes() -> Vec<(String, SubdivisionData)> {
    let mut all = closed_meshes();
    let wave = |i: usize, j: usize| {
        let (x, y) = (i as f64 / 2.0 - 1.0, j as f64 / 2.0 - 1.0);
        Vec3::new(x, y, 0.4 * x * y + 0.3 * x * x)
    };
    all.push(("sheet".into(), grid(5, 5, false, wave)));
    all.push(("smooth sheet".into(), grid(5, 5, true, wave)));
    all.push(("one face".into(), grid(2, 2, false, wave)));
    all.push(("one smooth face".into(), grid(2, 2, true, wave)));
    let mut open = cube();
    open.faces.truncate(5);
    all.push(("open cube".into(), open));
    let mut open = prism(5);
    open.faces.pop();
    open.boundary = Boundary::Smooth;
    all.push(("open prism".into(), open));
    for smooth in [false, true] {
        let name = format!("{LOOP}sheet{}", if smooth { ", smooth" } else { "" });
        all.push((name, triangulated(grid(5, 5, smooth, wave))));
    }
    for smooth in [false, true] {
        let mut one = triangulated(grid(2, 2, smooth, wave));
        one.faces.truncate(1);
        all.push((format!("{LOOP}one face{}", if smooth { ", smooth" } else { "" }), one));
    }
    let mut open = triangulated(cube());
    open.faces.truncate(9);
    all.push((format!("{LOOP}open cube"), open));
    all
}

/// A point inside.
pub(super) fn inside(name: &str, dice: &mut TestRng) -> Vec3 {
    if name.ends_with("plate") {
        // Within the rim.
        return Vec3::new(dice.between(-1.0, 1.0), -0.333, 0.0) + dice.vector() * 0.02;
    }
    if name.contains("torus") {
        // In the middle of the tube.
        return Vec3::new(0.9, 0.0, 0.0) + dice.vector() * 0.03;
    }
    dice.vector() * 0.12
}
