//! Tests of triangular patches.

use super::witness::Witness;
use super::{Subject, Tally, aimed, check};
use crate::laws::{TestRng, all_roots, drawn, report};
use crate::patch::net::{FaceNet, Net};
use crate::patch::shell::Shell;
use crate::patch::triangle_net::TriangleNet;
use crate::patch::triangular::LOST;
use crate::patch::{PatchError, TriangularPatch};
use crate::{All, LocalRay, RootKind, Sink};
use durer_math::{Point3, Ray, U, Vec3};
use std::collections::HashMap;

impl Subject for TriangularPatch {
    const IS_TRIANGLE: bool = true;

    fn witness(&self, ray: &Ray) -> Witness {
        Witness::triangular(self.side(), self.points(), ray)
    }

    fn shown(&self) -> String {
        format!("{} {:?}", self.side(), self.points())
    }
}

/// A net of small numbers, now and then with a collapsed side or equal points.
fn net(dice: &mut TestRng, side: usize, weights: bool) -> Vec<[f64; 4]> {
    let wild = dice.once_in(2);
    let mut points = Vec::new();
    for j in 0..side {
        for i in 0..side - j {
            let flat = Vec3::new(i as f64, j as f64, 0.0) * 4.0;
            let p = flat + if wild { dice.lattice(8) } else { dice.vector() * 6.0 };
            let w = if weights { dice.pick(&[1.0, 1.0, 0.5, 2.0, 3.0, 0.25]) } else { 1.0 };
            points.push([p.x * 0.125, p.y * 0.125, p.z * 0.125, w]);
        }
    }
    match dice.below(8) {
        0 => (1..side).for_each(|i| points[i] = points[0]),
        1 => points[1] = points[0],
        _ => {}
    }
    points
}

fn run(seed: u64, count: u64, rays: u64, side: impl Fn(&mut TestRng) -> usize, weights: bool) -> Tally {
    let mut tally = Tally::default();
    for case in drawn(count) {
        let mut dice = crate::laws::dice(seed, case);
        let side = side(&mut dice);
        let points = net(&mut dice, side, weights);
        let Ok(patch) = TriangularPatch::rational(side, &points) else { continue };
        for _ in 0..rays {
            let ray = aimed(&mut dice, &patch);
            if ray.is_valid() {
                check(&patch, &ray, &mut tally);
            }
        }
    }
    report(tally.rays);
    tally
}

#[test]
fn triangular_patches_of_degree_4_have_their_exact_crossings() {
    let mut tally = run(101, 15, 8, |_| 5, false);
    let median = tally.tell();
    assert!(tally.rays > 80 && tally.roots > 80, "{}", tally.rays);
    assert!(median < 64.0, "{median}");
}

#[test]
fn triangular_patches_of_other_degrees_have_their_exact_crossings() {
    let mut tally = run(102, 24, 6, |dice| 2 + dice.below(4) as usize, false);
    tally.tell();
    assert!(tally.rays > 90 && tally.roots > 90);
    let mut tally = run(103, 6, 3, |dice| 7 + dice.below(3) as usize, false);
    tally.tell();
    assert!(tally.roots > 8);
}

#[test]
fn rational_triangular_patches_have_their_exact_crossings() {
    let mut tally = run(104, 20, 6, |dice| 2 + dice.below(3) as usize, true);
    tally.tell();
    assert!(tally.rays > 70 && tally.roots > 70);
}

/// The net of a square is that of the triangle: both agree at points, and along the two short sides
/// the points are the same.
#[test]
fn the_net_over_the_square_is_that_of_the_triangle() {
    let mut dice = crate::laws::dice(105, 0);
    for side in 2..=9 {
        let points = net(&mut dice, side, true);
        let given = Net::new([points.len(), 1], &points).points;
        let triangle = TriangleNet { side, points: given.clone(), lost: 0.0 };
        let square = triangle.over_square();
        for i in 0..side {
            assert_eq!(square.points[i][0].to_f64(), given[i][0].to_f64());
        }
        for _ in 0..20 {
            let uv = [dice.unit(), dice.unit()];
            let part = triangle.part([uv, [1.0, 0.0], [0.0, 1.0]]);
            let end = square.part(uv, [1.0, 1.0]);
            for c in 0..4 {
                let (a, b) = (part.points[0][c].to_f64(), end.points[0][c].to_f64());
                assert!((a - b).abs() < 1e-20 + 1e-13 * a.abs(), "{side} {a} {b}");
            }
        }
    }
}

/// The surface of an octahedron in eight triangles of a degree, each point moved: neighbours share
/// the points along their edges.
fn closed_body(dice: &mut TestRng, degree: usize) -> Vec<Vec<[f64; 4]>> {
    let mut moved = HashMap::new();
    let mut faces = Vec::new();
    for octant in 0..8 {
        let sign = [0, 1, 2].map(|k| if octant >> k & 1 == 0 { 1 } else { -1 });
        // All normals point outward.
        let [a, b] = if sign.iter().product::<i32>() > 0 { [1, 2] } else { [2, 1] };
        let mut points = Vec::new();
        for j in 0..=degree {
            for i in 0..=degree - j {
                let mut at = [0_i32; 3];
                (at[0], at[a], at[b]) = ((degree - i - j) as i32, i as i32, j as i32);
                let at = [0, 1, 2].map(|k| at[k] * sign[k]);
                let p = moved.entry(at).or_insert_with(|| {
                    let p = Vec3::from(at.map(|k| f64::from(k) / degree as f64));
                    p * (dice.between(0.9, 1.1) / p.length()) + dice.vector() * 0.02
                });
                points.push([p.x, p.y, p.z, 1.0]);
            }
        }
        faces.push(points);
    }
    faces
}

/// A point of a patch by de Casteljau's algorithm.
fn point(points: &[[f64; 4]], side: usize, [u, v]: [f64; 2]) -> Vec3 {
    let mut rows: Vec<Vec<Vec3>> = vec![];
    let mut rest = points;
    for j in 0..side {
        let (row, more) = rest.split_at(side - j);
        rows.push(row.iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect());
        rest = more;
    }
    for left in (1..side).rev() {
        rows = (0..left)
            .map(|j| {
                (0..left - j)
                    .map(|i| rows[j][i] * (1.0 - u - v) + rows[j][i + 1] * u + rows[j + 1][i] * v)
                    .collect()
            })
            .collect();
    }
    rows[0][0]
}

#[test]
fn rays_from_inside_a_closed_body_leave_it_once() {
    let (mut rays, mut uncertain) = (0_u64, 0_u64);
    for case in drawn(24) {
        let mut dice = crate::laws::dice(107, case);
        let degree = 1 + dice.below(5) as usize;
        let faces = closed_body(&mut dice, degree);
        let nets: Vec<_> = faces
            .iter()
            .map(|points| {
                let points = Net::new([points.len(), 1], points).points;
                FaceNet::Triangle(TriangleNet { side: degree + 1, points, lost: LOST })
            })
            .collect();
        let shell = Shell::new(&nets).unwrap();
        for _ in 0..800 {
            let face = &faces[dice.below(8) as usize];
            let along = dice.unit();
            // Half of the rays aim at sides and corners.
            let uv = match dice.below(8) {
                0 => [0.0, along],
                1 => [along, 0.0],
                2 => [along, 1.0 - along],
                3 => dice.pick(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5], [0.5, 0.0]]),
                _ => [along, dice.unit() * (1.0 - along)],
            };
            let target = point(face, degree + 1, uv);
            let origin = if dice.once_in(2) { Vec3::ZERO } else { dice.vector() * 0.05 };
            let ray = Ray::new(origin.to_point(), target - origin);
            let mut all = All::default();
            shell.all_roots(&LocalRay::new(&ray), &mut all as &mut dyn Sink);
            assert!(all.roots.len() == 1, "{ray:?} of body {case} meets {:?}", all.roots);
            assert!(all.roots[0].sign != -1, "{ray:?} of body {case} meets {:?}", all.roots);
            uncertain += u64::from(all.roots[0].kind != RootKind::Simple);
            rays += 1;
        }
    }
    println!("{rays} rays, {uncertain} uncertain");
    report(rays);
}

#[test]
fn bad_triangles_are_named() {
    let flat: Vec<_> = (0..6).map(|i| [f64::from(i), f64::from(i * i), 0.0, 1.0]).collect();
    assert!(TriangularPatch::rational(3, &flat).is_ok());
    assert_eq!(TriangularPatch::rational(1, &flat[..1]), Err(PatchError::Side(1)));
    assert_eq!(TriangularPatch::rational(41, &flat), Err(PatchError::Side(41)));
    let error = TriangularPatch::rational(4, &flat).unwrap_err();
    assert_eq!(error.to_string(), "patch: a triangle with 4 points along each side has 10 points, got 6");
    let same = vec![Point3::new(1.0, 2.0, 3.0); 3];
    assert_eq!(TriangularPatch::new(2, &same), Err(PatchError::Nothing));
    let with = |k: usize, p: [f64; 4]| {
        let mut all = flat.clone();
        all[k] = p;
        TriangularPatch::rational(3, &all).unwrap_err().to_string()
    };
    assert_eq!(with(3, [0.0, 0.0, f64::NAN, 1.0]), "patch: point 4 must be finite, got <0, 0, NaN>");
    assert!(with(1, [0.0, 0.0, 0.0, -1.0]).contains("weight of point 2 must be positive"));
    assert!(with(1, [0.0, 0.0, 0.0, 1e5]).contains("too much"));
}

#[test]
fn texture_coordinates_and_slopes_follow_the_corners() {
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
    let patch = TriangularPatch::new(2, &corners.map(Point3::from)).unwrap();
    let patch = patch.with_uv([[0.25, 0.5], [0.75, 0.5], [0.25, 1.0]]);
    let ray = Ray::new(Point3::new(1.0, 0.75, 4.0), Vec3::new(0.0, 0.0, -1.0));
    let roots = all_roots(&patch, &ray);
    let p = crate::Surface::resolve(&patch, &LocalRay::new(&ray), &roots[0], crate::Need::ALL);
    assert!((p.uv[0] - 0.5).abs() < 8.0 * U && (p.uv[1] - 0.625).abs() < 8.0 * U, "{:?}", p.uv);
    assert!((p.dpdu - Vec3::new(4.0, 0.0, 0.0)).length() < 1e-14, "{:?}", p.dpdu);
    assert!((p.dpdv - Vec3::new(0.0, 6.0, 0.0)).length() < 1e-14, "{:?}", p.dpdv);
}
