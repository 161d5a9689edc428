//! Tests of Loop's rules.

use super::super::plan::Plans;
use super::super::topology::{Adjacency, Topology, apply};
use super::super::{topology, triangles};
use super::*;
use crate::TriangularPatch;
use crate::patch::triangle_net::TriangleNet;

/// Meshes with six triangles round each vertex, with creases and boundaries.
fn regular_meshes() -> Vec<SubdivisionData> {
    let flat = |i: usize, j: usize| Vec3::new(i as f64, j as f64, 0.0);
    let sheet = || triangulated(grid(6, 6, false, flat));
    let along = |step: usize, from: usize| (0..5).map(move |k| from + k * step);
    let creases = |edges: Vec<(usize, usize)>| {
        let edges: Vec<_> = edges.iter().map(|&(a, b)| (a as u32, b as u32, 10.0)).collect();
        creased(sheet(), &edges, &[])
    };
    vec![
        sheet(),
        triangulated(grid(6, 6, true, flat)),
        triangulated(grid(2, 2, false, flat)),
        creases(along(1, 12).map(|v| (v, v + 1)).collect()),
        creases(along(6, 3).map(|v| (v, v + 6)).collect()),
        creases(along(7, 0).map(|v| (v, v + 7)).collect()),
        // Two creases that cross: corners of one triangle among them.
        creases(along(1, 12).map(|v| (v, v + 1)).chain(along(7, 0).map(|v| (v, v + 7))).collect()),
        torus(5, 4),
    ]
}

/// 24 times the Bezier net of the first face of a part, without rounding if the points are whole.
fn net(mesh: &Topology, points: &[[Dd; 3]]) -> Option<TriangleNet> {
    let adjacency = Adjacency::new(mesh);
    let fans: Vec<_> = (0..3).map(|v| adjacency.fan(v, 0)).collect::<Option<_>>()?;
    let patch = triangles::regular(mesh, &fans)?;
    let mut net = triangles::bezier(&patch, points)?;
    for p in &mut net.points {
        // Whole numbers come back from their twenty-fourth part.
        for x in &mut p[..3] {
            *x = *x * 24.0;
            *x = Dd::new((x.hi * 65536.0).round() / 65536.0, 0.0);
        }
    }
    Some(net)
}

#[test]
fn the_polynomials_follow_the_rules_exactly() {
    // Halves of a Bezier net by de Casteljau's algorithm are the nets of the finer mesh. With weights
    // of the sum 1 no other polynomials do that.
    let (mut dice, mut seen) = (crate::laws::dice(11, 0), 0);
    for data in regular_meshes() {
        let mesh = topology(&data);
        let whole: Vec<[Dd; 3]> =
            (0..mesh.points).map(|_| [0; 3].map(|_| Dd::from(dice.below(2000) as f64 - 1000.0))).collect();
        let adjacency = Adjacency::new(&mesh);
        for face in 0..mesh.faces.len() {
            let part = adjacency.around(face).unwrap();
            let points: Vec<_> = part.points.iter().map(|p| whole[*p as usize]).collect();
            let Some(all) = net(&part.mesh, &points) else { continue };
            seen += 1;
            let finer = Adjacency::new(&part.mesh).refined(|v| v < 3);
            let finer_points: Vec<_> = finer.stencils.iter().map(|s| apply(s, &points)).collect();
            let within = Adjacency::new(&finer.mesh);
            let halves = [
                [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]],
                [[0.5, 0.0], [1.0, 0.0], [0.5, 0.5]],
                [[0.0, 0.5], [0.5, 0.5], [0.0, 1.0]],
                [[0.5, 0.5], [0.0, 0.5], [0.5, 0.0]],
            ];
            for (k, corners) in halves.iter().enumerate() {
                let quarter = finer.origins.iter().position(|o| *o == (0, k)).unwrap();
                let part = within.around_from(quarter, if k < 3 { (3 - k) % 3 } else { 0 }).unwrap();
                let points: Vec<_> = part.points.iter().map(|p| finer_points[*p as usize]).collect();
                let fine = net(&part.mesh, &points).expect("a part of a regular face is regular");
                assert_eq!(fine.points, all.part(*corners).points, "face {face}, quarter {k}");
            }
        }
    }
    assert!(seen > 250, "{seen}");
}

#[test]
fn weights_of_box_splines_have_the_sum_one() {
    let cube = triangulated(cube());
    let it = surface(&cube);
    assert!(it.counts()[0] > 0);
    for n in 3..60 {
        let weight = triangles::neighbour_weight(n);
        let cos = durer_math::elementary::cos(2.0 * core::f64::consts::PI / n as f64);
        let shrunk = 0.375 + cos / 4.0;
        let near = (0.625 - shrunk * shrunk) / n as f64;
        assert!((weight.to_f64() - near).abs() <= 4.0 * U / n as f64, "{n}");
        assert!(weight > Dd::ZERO && weight * Dd::from(n as f64) < Dd::ONE);
    }
    assert_eq!(triangles::neighbour_weight(6), Dd::from(0.0625));
    assert_eq!(triangles::neighbour_weight(3), Dd::from(0.1875));
    // Twice the angle: cos 2x = 2 cos^2 x - 1 ties the weights of 2 n edges to those of n.
    for n in 5..40 {
        let cosine = |n: usize| {
            let root = (Dd::from(0.625) - triangles::neighbour_weight(n) * Dd::from(n as f64)).sqrt();
            (root - Dd::from(0.375)).scale2(2)
        };
        let twice = cosine(2 * n) * cosine(2 * n);
        let off = (twice.scale2(1) - Dd::ONE - cosine(n)).to_f64();
        assert!(off.abs() < durer_math::scale::pow2(-95), "{n} {off:e}");
    }
}

#[test]
fn a_regular_mesh_is_its_bezier_patches() {
    let mut dice = crate::laws::dice(12, 0);
    for creases in [false, true] {
        let mut data =
            triangulated(grid(6, 6, false, |i, j| Vec3::new(i as f64, j as f64, 0.0) + dice.vector() * 0.3));
        if creases {
            data.creases = (0..5).map(|k| ([12 + k, 13 + k], 10.0)).collect();
        }
        let it = surface(&data);
        let mesh = topology(&data);
        let points: Vec<_> = data.vertices.iter().map(|p| [p.x, p.y, p.z].map(Dd::from)).collect();
        let adjacency = Adjacency::new(&mesh);
        let mut met = 0;
        for face in 0..mesh.faces.len() {
            let part = adjacency.around(face).unwrap();
            let own: Vec<_> = part.points.iter().map(|p| points[*p as usize]).collect();
            let fans: Vec<_> = (0..3).map(|v| Adjacency::new(&part.mesh).fan(v, 0).unwrap()).collect();
            let Some(patch) = triangles::regular(&part.mesh, &fans) else { continue };
            let net = triangles::bezier(&patch, &own).unwrap();
            let net: Vec<_> =
                net.points.iter().map(|p| Point3::new(p[0].to_f64(), p[1].to_f64(), p[2].to_f64())).collect();
            let patch = TriangularPatch::new(5, &net).unwrap();
            let middle = net.iter().fold(Vec3::ZERO, |s, p| s + p.to_vec()) * (1.0 / 15.0);
            for _ in 0..20 {
                let direction = dice.vector() + Vec3::new(0.0, 0.0, 2.0);
                let at = middle + Vec3::new(dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), 0.0);
                let ray = Ray::new((at - direction * 4.0).to_point(), direction);
                let (a, b) = (all_roots(&it, &ray), all_roots(&patch, &ray));
                let a: Vec<_> = a.iter().filter(|r| r.face as usize == face).collect();
                // Near an edge the crossing may be that of the neighbour.
                let is_inner = |r: &&Root| {
                    let [u, v] = r.tag;
                    u > 1e-9 && v > 1e-9 && u + v < 1.0 - 1e-9
                };
                let (a, b): (Vec<_>, Vec<_>) =
                    (a.into_iter().filter(is_inner).collect(), b.iter().filter(is_inner).collect());
                assert_eq!(a.len(), b.len(), "{ray:?} {a:?} {b:?}");
                for (a, b) in a.iter().zip(&b) {
                    let room = 64.0 * U * 10.0;
                    assert!(a.lo <= b.hi + room && b.lo <= a.hi + room && a.sign == b.sign, "{a:?} {b:?}");
                    assert!((0..2).all(|k| (a.tag[k] - b.tag[k]).abs() < 1e-9), "{a:?} {b:?}");
                    met += 1;
                }
            }
        }
        assert!(met > 200, "{met}");
    }
}

#[test]
fn creases_and_corners_have_the_limits_of_curves() {
    for (name, data) in closed_meshes() {
        if data.scheme != Scheme::Loop {
            continue;
        }
        let (it, naive) = (surface(&data), Naive::new(&data));
        let mut dice = crate::laws::dice(13, 0);
        let size = it.bounds().magnitude();
        for v in 0..data.vertices.len() as u32 {
            let Some(p) = naive.sharp_limit(v) else { continue };
            let from = inside(&name, &mut dice);
            let ray = Ray::new(from.to_point(), p - from);
            let roots = all_roots(&it, &ray);
            let off = roots.iter().fold(f64::INFINITY, |m, r| m.min((r.t - 1.0).abs()));
            assert!(off < 4096.0 * U * size, "{name} {v} {off:e} {roots:?}");
        }
    }
}

#[test]
fn regular_meshes_need_no_refinement() {
    let it = surface(&torus(6, 5));
    assert_eq!(it.counts(), [60, 0]);
    let mut plans = Plans::default();
    let mesh = topology(&torus(6, 5));
    let adjacency = Adjacency::new(&mesh);
    for face in 0..60 {
        plans.of(&adjacency.around(face).unwrap().mesh).unwrap();
    }
    assert_eq!(plans.all.len(), 1);
}

#[test]
fn texture_coordinates_are_linear_in_triangles() {
    let mut data = triangulated(cube());
    data.uv = vec![[0.0, 0.0], [2.0, 0.0], [0.5, 3.0]];
    data.uv_faces = vec![vec![0, 1, 2]; 12];
    let it = surface(&data);
    let mut dice = crate::laws::dice(14, 0);
    for _ in 0..100 {
        let ray = Ray::new((dice.vector() * 0.1).to_point(), dice.vector());
        let local = LocalRay::new(&ray);
        let root = all_roots(&it, &ray)[0];
        let point = it.resolve(&local, &root, Need::ALL);
        let [u, v] = limit::parameters(true, root.tag);
        assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 + 4.0 * U, "{root:?}");
        assert!((point.uv[0] - (2.0 * u + 0.5 * v)).abs() < 1e-14, "{point:?}");
        assert!((point.uv[1] - 3.0 * v).abs() < 1e-14, "{point:?}");
    }
}
