//! Normals at irregular vertices of creases, by eigenvectors in closed form.

use super::*;
use durer_math::elementary::{cos, sin};

/// A ball of `n` slices, of which the one at angle 0 and the one at `k` are cut sharp: two tips with
/// `k` faces on one side of a crease.
fn slices(n: usize, k: usize) -> SubdivisionData {
    let tip = n as u32;
    let mut data = double_pyramid(n);
    data.creases = [0, k as u32].into_iter().flat_map(|v| [([v, tip], 10.0), ([v, tip + 1], 10.0)]).collect();
    data
}

/// The eigenvalue of the points within a sector of which the `j`-th wave is zero on its sides, and its
/// left eigenvector: the weights of the vertex, of both sides, of the `k - 1` edges within and of
/// the `k` points across faces.
///
/// Within, the rules are those of a smooth vertex, so that eigenvectors are sines with its eigenvalues. The
/// sides follow rules of their own, `A`; with what comes from them within, `B`, the rest of a left
/// eigenvector is `x = y B (λ - A)^-1`.
fn wave(k: usize, j: usize) -> (f64, Vec<f64>) {
    let angle = core::f64::consts::PI * j as f64 / k as f64;
    let c = cos(angle);
    let root = ((c + 9.0) * (c + 1.0)).sqrt();
    let value = (5.0 + c + root) / 16.0;
    let end = |i: usize| sin(angle * i as f64) * (1.0 + c + root);
    let across = |i: usize| sin(angle * i as f64) + sin(angle * (i + 1) as f64);
    // y B: an end takes 3/8 of the vertex and 1/16 of each neighbour, a face point a quarter of each.
    let mut own = 0.0;
    let mut sides = [0.0; 2];
    for i in 1..k {
        own += end(i) * 0.375;
        if i == 1 {
            sides[0] += end(i) / 16.0;
        }
        if i == k - 1 {
            sides[1] += end(i) / 16.0;
        }
    }
    for i in 0..k {
        own += across(i) * 0.25;
        if i == 0 {
            sides[0] += across(i) * 0.25;
        }
        if i == k - 1 {
            sides[1] += across(i) * 0.25;
        }
    }
    // On a crease v' = 3/4 v + 1/8 (a + b), a' = (v + a) / 2, b' = (v + b) / 2. With x = (p, q, r):
    // λ p = 3/4 p + (q + r) / 2 + own,  λ q = p / 8 + q / 2 + sides[0],  λ r = p / 8 + r / 2 + sides[1].
    let half = value - 0.5;
    let p = (own + 0.5 * (sides[0] + sides[1]) / half) / (value - 0.75 - 0.125 / half);
    let [q, r] = sides.map(|s| (p / 8.0 + s) / half);
    let within = (1..k).map(end).chain((0..k).map(across));
    (value, [p, q, r].into_iter().chain(within).collect())
}

#[test]
fn normals_at_creases_are_those_of_eigenvectors() {
    for (n, k) in [(6, 3), (7, 3), (9, 3), (12, 5), (14, 6), (15, 7)] {
        let data = slices(n, k);
        let finer = Naive::new(&data).refined();
        // The corners at the tip of the triangles of one side.
        let at = |v: u32| finer.vertices[v as usize];
        let corners: Vec<&[u32]> = (0..k).map(|i| &finer.faces[3 * (2 * i) + 2][..]).collect();
        let mut points = vec![at(corners[0][1]), at(corners[k - 1][3])];
        points.extend(corners[1..].iter().map(|corner| at(corner[1])));
        points.extend(corners.iter().map(|corner| at(corner[2])));
        let tip = at(corners[0][0]);
        // The weights have the sum 0.
        let apply = |weights: &[f64]| {
            points.iter().zip(&weights[1..]).fold(Vec3::ZERO, |s, (p, w)| s + (*p - tip) * *w)
        };
        let (_, first) = wave(k, 1);
        let (value, second) = wave(k, 2);
        assert!(first.iter().sum::<f64>().abs() < 1e-12, "{n} {k}");
        // Along the crease the eigenvalue is 1/2.
        let along = if value > 0.5 { apply(&second) } else { points[1] - points[0] };
        let normal = apply(&first).cross(along);
        let normal = normal * (1.0 / normal.length());
        let it = surface(&data);
        let mut count = 0;
        for tail in &it.limit.tails {
            let place = tail.node.place;
            let face = it.control_face(place.face).unwrap() as usize;
            let is_tip = place.from == [0.0; 2] && place.face as usize % 3 == 2;
            if !is_tip || !face.is_multiple_of(2) || face / 2 >= k {
                continue;
            }
            count += 1;
            let found = sharp_normal::sharp_normal(&tail.node, &it.limit.plans).unwrap();
            let off = (found - normal).length().min((found + normal).length());
            println!("{n} {k} {face}: {off:e} {}", found.dot(normal));
            assert!(off < 64.0 * U, "{n} {k} {face}: {found:?} {normal:?}");
        }
        assert_eq!(count, k);
    }
}
