//! Tests of subdivision surfaces.

mod meshes;
mod naive;
mod sharp;
mod triangles;
mod uv;

use super::*;
use crate::laws::{all_roots, drawn, report};
use crate::{All, Nurbs, NurbsData, RootKind};
use durer_math::{Ray, U, Vec3};
use meshes::*;
use naive::Naive;

fn surface(data: &SubdivisionData) -> SubdivisionSurface {
    SubdivisionSurface::new(data.clone()).unwrap()
}

/// The limits of smooth inner vertices, by the closed form: position and normal.
fn limits(data: &SubdivisionData) -> Vec<Option<(Vec3, Vec3)>> {
    let mut naive = Naive::new(data);
    // The masks are those of quadrilaterals.
    let count = data.vertices.len();
    if data.scheme == Scheme::CatmullClark && data.faces.iter().any(|f| f.len() != 4) {
        naive = naive.refined();
    }
    (0..count as u32).map(|v| naive.limit(v)).collect()
}

/// Whether crossings of a line with a closed body enter and leave it in turn.
fn alternate(roots: &[Root]) -> bool {
    let signs: Vec<i8> = roots.iter().map(|r| r.sign).filter(|s| *s != 0).collect();
    signs.first() == Some(&-1) && signs.len().is_multiple_of(2) && signs.windows(2).all(|w| w[0] != w[1])
}

#[test]
fn a_regular_net_is_a_b_spline() {
    let mut dice = crate::laws::dice(1, 0);
    for closed in [false, true] {
        let n = 6;
        let data = grid(n, n, closed, |i, j| Vec3::new(i as f64, j as f64, 0.0) + dice.vector() * 0.4);
        let it = surface(&data);
        let points: Vec<_> = data.vertices.iter().map(|p| [p.x, p.y, p.z, 1.0]).collect();
        // Without ends the B-spline is that of the faces that have all neighbours.
        let knots = [0, 1].map(|_| (0..n + 4).map(|i| i as f64 - 3.0).collect());
        let spline = NurbsData { degree: [3, 3], size: [n, n], points, knots, ..NurbsData::default() };
        let spline = Nurbs::new(spline).unwrap();
        let mut met = 0;
        for _ in 0..400 {
            let at = Vec3::new(dice.between(1.2, n as f64 - 2.2), dice.between(1.2, n as f64 - 2.2), 0.0);
            let direction = dice.vector() + Vec3::new(0.0, 0.0, 2.0);
            let ray = Ray::new((at - direction * 4.0).to_point(), direction);
            let (a, b) = (all_roots(&it, &ray), all_roots(&spline, &ray));
            let inner: Vec<_> = a
                .iter()
                .filter(|r| {
                    let face = &data.faces[r.face as usize];
                    face.iter().all(|v| {
                        let (i, j) = (*v as usize % n, *v as usize / n);
                        (1..n - 1).contains(&i) && (1..n - 1).contains(&j)
                    })
                })
                .collect();
            assert_eq!(inner.len(), b.len(), "{ray:?} {a:?} {b:?}");
            for (a, b) in inner.iter().zip(&b) {
                assert!(a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign, "{a:?} {b:?}");
                met += 1;
            }
        }
        assert!(met > 300, "{met}");
    }
}

#[test]
fn vertices_have_the_limits_of_the_closed_form() {
    for (name, data) in closed_meshes() {
        let it = surface(&data);
        let (mut worst, mut worst_n) = (0.0_f64, 0.0_f64);
        for (v, limit) in limits(&data).iter().enumerate() {
            let Some((p, n)) = limit else { continue };
            let ray = Ray::new((*p + *n * 0.5).to_point(), *n * -1.0);
            let roots = all_roots(&it, &ray);
            let Some(root) = roots.iter().min_by(|a, b| (a.t - 0.5).abs().total_cmp(&(b.t - 0.5).abs()))
            else {
                panic!("{name}: vertex {v} is not met")
            };
            let local = LocalRay::new(&ray);
            let point = it.resolve(&local, root, Need::ALL);
            let size = it.bounds().magnitude();
            let off = (point.p.to_vec() - *p).length();
            let turned = (point.ng.to_vec() - *n).length();
            // The closed form is rounded, and so is the ray through it.
            let known = point.dp.length() + 8.0 * U * size;
            assert!(off <= known, "{name} {v}: {off} of {known}");
            // The ray passes the vertex at this distance. Near it the normal turns by a power of that.
            let most = 16.0 * durer_math::elementary::pow(known / size, turning(&data, v)) + 64.0 * U;
            assert!(turned <= most, "{name} {v}: {turned} of {most}");
            worst = worst.max(off / (U * size));
            worst_n = worst_n.max(turned / U);
            assert!(
                (root.lo..=root.hi).contains(&0.5) || (root.t - 0.5).abs() < 64.0 * U * size,
                "{name} {v} {root:?}"
            );
        }
        println!("{name}: {:?} off by {worst} ulp, normal {worst_n}", it.counts());
        assert!(worst < 64.0, "{name} {worst}");
    }
}

/// By which power of the distance from a vertex the normal turns: with the eigenvalues λ of the
/// tangent plane and μ of the second derivatives, lengths shrink by λ in a step and heights by μ, so
/// slopes by μ / λ (U. Reif, "A unified approach to subdivision algorithms near extraordinary
/// vertices", *Computer Aided Geometric Design* 12, 1995). It is 1 where curvatures are bounded.
fn turning(data: &SubdivisionData, v: usize) -> f64 {
    let n = data.faces.iter().flatten().filter(|&&corner| corner as usize == v).count();
    let cos = |k: f64| durer_math::elementary::cos(2.0 * core::f64::consts::PI * k / n as f64);
    let eigenvalue = |k: f64| match data.scheme {
        Scheme::Loop => 0.375 + 0.25 * cos(k),
        Scheme::CatmullClark => (5.0 + cos(k) + ((cos(k) + 9.0) * (cos(k) + 1.0)).sqrt()) / 16.0,
    };
    let log = |x: f64| durer_math::elementary::ln(x);
    // Three edges have no two waves round the vertex.
    if n == 3 { 1.0 } else { (log(eigenvalue(2.0)) / log(eigenvalue(1.0)) - 1.0).clamp(0.0, 1.0) }
}

#[test]
fn rays_from_inside_leave_closed_meshes_once_in_turn() {
    let mut rays = 0_u64;
    let mut unsure = 0_u64;
    for (name, data) in closed_meshes() {
        let it = surface(&data);
        let limits = limits(&data);
        for case in drawn(20) {
            let mut dice = crate::laws::dice(3, case);
            let inside = inside(&name, &mut dice);
            let k = dice.below(limits.len() as u64) as usize;
            let aim = match (dice.below(4), limits[k]) {
                (0 | 1, Some((p, _))) => p - inside,
                (2, Some((p, _))) => p + dice.vector() * dice.scale(-50, -10) - inside,
                _ => dice.vector(),
            };
            if aim == Vec3::ZERO {
                continue;
            }
            let ray = Ray::new(inside.to_point(), aim);
            let roots = all_roots(&it, &ray);
            let signs: Vec<i8> = roots.iter().map(|r| r.sign).filter(|s| *s != 0).collect();
            let fine = signs.first() == Some(&1)
                && signs.last() == Some(&1)
                && signs.windows(2).all(|w| w[0] != w[1]);
            assert!(fine, "{name} {case}: {ray:?}\n{roots:#?}");
            let line = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(&it, &line);
            assert!(alternate(&roots), "{name} {case}: {line:?}\n{roots:#?}");
            unsure += roots.iter().filter(|r| r.kind != RootKind::Simple).count() as u64;
            rays += 2;
        }
        println!("{name}: {rays} rays so far, {unsure} crossings not proven");
    }
    report(rays);
}

/// Two proven crossings less than a rounding apart, behind a third one.
#[test]
fn crossings_whose_brackets_overlap_come_in_turn() {
    let mut data = creased(cube(), &[(1, 5, 10.0), (0, 2, 3.0)], &[(1, 10.0)]);
    data.vertices = [
        [-0.9818017863365034, -0.9571054398799983, -0.9643599433603245],
        [-0.9509010355131184, -0.9828726457837482, 0.966309962197107],
        [-0.9639362466883732, 1.046463294730906, -0.9595304015487763],
        [-0.9930892496525676, 1.0213817020174198, 0.9711124983675599],
        [1.0331607930273354, -0.9926467647648716, -1.0215042538013794],
        [0.956346057714523, -0.964605751157732, 1.048980601492158],
        [0.9588518093109728, 1.0300595321257502, -1.0089538172654091],
        [0.965076537445281, 0.9793891246819062, 1.0268791887277344],
    ]
    .map(Point3::from)
    .to_vec();
    let ray = Ray::new(
        Point3::new(0.054793915315445856, 0.08400674545142284, 0.006977800057410226),
        Vec3::new(-1.0056949508285642, -1.066879391235171, 0.9593321621396967),
    );
    let signs: Vec<i8> = all_roots(&surface(&data), &ray).iter().map(|root| root.sign).collect();
    assert_eq!(signs, [1, -1, 1]);
}

/// A ray that passes a tip within its rounding meets some of the faces beside it for certain, and has
/// candidates on others.
#[test]
fn rays_past_sharp_tips_leave_in_turn() {
    let mut unsure = 0;
    for is_loop in [false, true] {
        let data = creased(cube(), &[], &[(5, 10.0), (2, 10.0)]);
        let data = if is_loop { triangulated(data) } else { data };
        let it = surface(&data);
        for case in drawn(1500) {
            let mut dice = crate::laws::dice(17, case);
            let inside = dice.vector() * 0.12;
            // The limit of a sharp vertex is the vertex.
            let tip = data.vertices[dice.pick(&[5, 2])].to_vec();
            let ray = Ray::new(inside.to_point(), tip + dice.vector() * dice.scale(-60, -48) - inside);
            let line = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(&it, &line);
            assert!(alternate(&roots), "{is_loop} {case}: {line:?}\n{roots:#?}");
            let signs: Vec<i8> =
                all_roots(&it, &ray).iter().map(|root| root.sign).filter(|sign| *sign != 0).collect();
            assert!(signs.len() % 2 == 1 && signs[0] == 1, "{is_loop} {case}: {ray:?} {signs:?}");
            unsure += all_roots(&it, &ray).iter().filter(|root| root.kind != RootKind::Simple).count();
        }
    }
    assert!(unsure > 100, "{unsure}");
}

/// How much of the distance to the limit a step leaves, at most.
///
/// Of a closed mesh of quadrilaterals with four edges or three at each vertex it is a quarter, as of
/// B-splines. Elsewhere all differences shrink at least like the mesh itself, by the largest eigenvalue
/// below 1 (A. A. Ball, D. J. T. Storry, "Conditions for tangent plane continuity over recursively
/// generated B-spline surfaces", *ACM TOG* 7, 1988). A fifth more pays for what dies away faster.
fn rate(data: &SubdivisionData) -> f64 {
    let mut edges = vec![0_u32; data.vertices.len()];
    data.faces.iter().flatten().for_each(|v| edges[*v as usize] += 1);
    // A face of other than four edges has a vertex of as many in its middle after a step.
    let valences = edges.iter().copied().chain(data.faces.iter().map(|face| face.len() as u32));
    let most = valences.fold(4, u32::max);
    let is_plain = data.creases.is_empty() && data.corners.is_empty() && data.holes.is_empty();
    let count =
        data.faces.iter().flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]));
    let sides: std::collections::HashSet<[u32; 2]> = count.collect();
    let is_closed = sides.iter().all(|&[a, b]| sides.contains(&[b, a]));
    if data.scheme == Scheme::CatmullClark && is_plain && is_closed && most == 4 {
        return 1.2 * 0.25;
    }
    let cos = |k: f64| durer_math::elementary::cos(2.0 * core::f64::consts::PI * k / f64::from(most));
    let c = cos(1.0);
    if data.scheme == Scheme::Loop {
        // Of smooth closed meshes the part in the tangent plane changes no distance; the next
        // eigenvalues are those of two waves round the vertex and of none.
        let slow = 0.375 + c / 4.0;
        let next = (slow * slow).max(0.375 + cos(2.0) / 4.0).max(0.25);
        return 1.2 * if is_plain && is_closed { next } else { slow.max(0.5) };
    }
    1.2 * (5.0 + c + ((c + 9.0) * (c + 1.0)).sqrt()) / 16.0
}

#[test]
fn tessellations_come_nearer_at_their_rate() {
    for (name, data) in all_meshes() {
        let it = surface(&data);
        let mut naive = Naive::new(&data);
        let size = it.bounds().magnitude();
        let mut before = f64::INFINITY;
        for level in 1..=5 {
            naive = naive.refined();
            let far = naive.distance(&it) / size;
            println!("{name} {level}: {far:.3e}");
            if level > 3 {
                // A flat mesh is its own limit, up to the rounding of the points compared.
                assert!(
                    far <= (before * rate(&data)).max(8.0 * f64::EPSILON),
                    "{name} {level}: {far} after {before}"
                );
            }
            before = far;
        }
        assert!(before < 2e-3, "{name} {before}");
    }
}

#[test]
fn what_is_made_ahead_changes_no_bit() {
    for (name, data) in all_meshes() {
        let it = surface(&data);
        let less = it.remade(1);
        let mut dice = crate::laws::dice(5, 0);
        let limits = limits(&data);
        for _ in 0..20 {
            let k = dice.below(limits.len() as u64) as usize;
            let target = match limits[k] {
                Some((p, _)) if dice.once_in(2) => p + dice.vector() * dice.scale(-40, -1),
                _ => dice.vector(),
            };
            let from = dice.vector() * 3.0;
            let ray = Ray::new(from.to_point(), target - from);
            assert_eq!(all_roots(&it, &ray), all_roots(&less, &ray), "{name} {ray:?}");
        }
    }
}

#[test]
fn points_are_within_their_bounds_and_rays_leave_them() {
    for (name, data) in all_meshes() {
        let it = surface(&data);
        let limits = limits(&data);
        for case in drawn(20) {
            let mut dice = crate::laws::dice(7, case);
            let k = dice.below(limits.len() as u64) as usize;
            let target = match limits[k] {
                Some((p, _)) if dice.once_in(2) => p + dice.vector() * dice.scale(-40, -1),
                _ => dice.vector(),
            };
            let from = dice.vector() * 3.0;
            let ray = Ray::new(from.to_point(), target - from);
            let local = LocalRay::new(&ray);
            let mut all = All::default();
            it.roots(&local, &mut all);
            for root in all.roots.iter().filter(|r| r.kind == RootKind::Simple) {
                let p = it.resolve(&local, root, Need::ALL);
                assert!(p.ng.to_vec().length() > 0.999 && p.dp.is_finite(), "{name} {p:?}");
                let away = (p.p - ray.at(root.t)).abs() - p.dp;
                assert!((0..3).all(|k| away[k] < 64.0 * U * 10.0), "{name} {p:?} {root:?} {ray:?}");
                let facing = p.ng.to_vec().dot(ray.direction);
                let sure = facing.abs() > 1e-6 * ray.direction.length();
                assert!(!sure || (facing > 0.0) == (root.sign > 0), "{name} {p:?} {root:?}");
                if data.creases.is_empty() && data.corners.is_empty() {
                    for sign in [1.0, -1.0] {
                        let out = p.spawn(p.ng.to_vec() * sign);
                        let near = all_roots(&it, &out);
                        let first = near.first().map_or(f64::INFINITY, |r| r.lo);
                        assert!(p.bend.is_infinite() || first > 2.0 * p.off, "{name} {p:?} {near:?} {ray:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn closed_meshes_are_solids() {
    for (name, data) in closed_meshes() {
        let it = surface(&data);
        assert_eq!(it.solidity(), Solidity::Solid);
        let mut dice = crate::laws::dice(9, 0);
        for _ in 0..50 {
            let p = inside(&name, &mut dice);
            assert_eq!(it.side(&LocalPoint::new(p.to_point())), Side::In, "{name} {p:?}");
            let far = dice.vector();
            let far = far * (10.0 / far.length());
            assert_eq!(it.side(&LocalPoint::new(far.to_point())), Side::Out, "{name} {far:?}");
        }
        let mut turned = data.clone();
        turned.faces.iter_mut().for_each(|f| f.reverse());
        let turned = surface(&turned);
        let p = inside(&name, &mut dice);
        assert_eq!(turned.side(&LocalPoint::new(p.to_point())), Side::In, "{name}");
        let ray = Ray::new(Vec3::new(8.0, 0.1, 0.2).to_point(), p - Vec3::new(8.0, 0.1, 0.2));
        assert_eq!(all_roots(&turned, &ray)[0].sign, -1);
    }
}

#[test]
fn bad_meshes_are_named() {
    let plain = cube();
    let with = |change: &dyn Fn(&mut SubdivisionData)| {
        let mut data = plain.clone();
        change(&mut data);
        SubdivisionSurface::new(data).unwrap_err().to_string()
    };
    assert_eq!(with(&|d| d.faces.clear()), "subdivision: it has no faces");
    assert_eq!(with(&|d| d.faces[2][1] = 8), "subdivision: face 2 names vertex 8, there are 8 (0 to 7)");
    assert_eq!(with(&|d| d.vertices.clear()), "subdivision: face 0 names vertex 0, there are 0");
    assert_eq!(with(&|d| d.faces[1][2] = d.faces[1][0]), "subdivision: face 1 has vertex 4 twice");
    assert_eq!(with(&|d| d.faces[0].truncate(2)), "subdivision: face 0 has 2 vertices, it needs 3 at least");
    assert_eq!(
        with(&|d| d.scheme = Scheme::Loop),
        "subdivision: face 0 has 4 vertices, Loop's rules are for triangles"
    );
    assert_eq!(
        with(&|d| d.vertices[3].y = f64::NAN),
        "subdivision: vertex 3 must be finite and less than 2^200, got <-1, NaN, 1>"
    );
    assert_eq!(
        with(&|d| d.faces[0].reverse()),
        "subdivision: faces 0 and 2 both go from vertex 1 to 0; one of them must be turned round"
    );
    assert_eq!(
        with(&|d| d.faces.push(vec![0, 1, 6])),
        "subdivision: the edge of vertices 0 and 1 has more than two faces: 0, 2 and 6"
    );
    assert_eq!(
        with(&|d| {
            d.vertices.extend([[5.0, 5.0, 5.0], [5.0, 6.0, 5.0]].map(Point3::from));
            d.faces.push(vec![0, 8, 9]);
        }),
        "subdivision: the faces at vertex 0 do not form a single fan: faces 0 and 6 are not connected by edges at this vertex"
    );
    assert_eq!(
        with(&|d| d.creases.push(([0, 7], 1.0))),
        "subdivision: crease 0 is no edge: no face has vertices 0 and 7 next to each other"
    );
    assert_eq!(
        with(&|d| d.creases.push(([0, 1], -1.0))),
        "subdivision: the sharpness of crease 0 must be positive, got -1"
    );
    assert_eq!(with(&|d| d.corners.push((9, 1.0))), "subdivision: corner 0 names vertex 9, there are 8");
    assert_eq!(with(&|d| d.holes.push(6)), "subdivision: hole 0 names face 6, there are 6");
    assert_eq!(
        with(&|d| d.holes = (0..6).collect()),
        "subdivision: all its faces are holes, so it has no surface"
    );
    assert_eq!(
        with(&|d| d.vertices = vec![Point3::ORIGIN; 8]),
        "subdivision: all its points are the same, so it has no surface"
    );
    assert_eq!(
        with(&|d| d.uv_faces = vec![vec![0, 0, 0, 0]; 5]),
        "subdivision: face 0 names texture coordinates 0, there are 0"
    );
}
