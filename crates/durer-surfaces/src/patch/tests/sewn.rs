//! Tests of surfaces that are sewn together.

use super::{round, sphere_data};
use crate::laws::{TestRng, all_roots, drawn, report};
use crate::patch::{NurbsData, Sewn, SewnData, SewnError, TrimLoop};
use crate::{LocalPoint, RootKind, Side, Solidity, Surface};
use durer_math::{Point3, Ray, Vec3};

fn closed(surfaces: Vec<NurbsData>, seal: f64) -> Sewn {
    Sewn::new(SewnData { surfaces, seal, closed: true }).unwrap()
}

/// A bilinear face through four corners that go round.
fn quad(corners: [[f64; 3]; 4]) -> NurbsData {
    let [a, b, c, d] = corners.map(|[x, y, z]| [x, y, z, 1.0]);
    NurbsData { degree: [1, 1], size: [2, 2], points: vec![a, b, d, c], ..NurbsData::default() }
}

/// The six faces of the cube from -1 to 1, with corners moved; some of them face inward.
fn cube(moved: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<NurbsData> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        for end in [-1.0, 1.0] {
            let at = |a: f64, b: f64| {
                let mut p = [end; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (a, b);
                moved(p)
            };
            faces.push(quad([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]));
        }
    }
    faces
}

/// Rational arcs about the y axis through these radii, heights and weights, of degree 2 along `v` with
/// double knots.
fn turned(profile: &[[f64; 3]]) -> NurbsData {
    let rows: Vec<_> = profile.iter().map(|[r, y, w]| round(*r, *y, *w)).collect();
    let n = (profile.len() - 1) / 2;
    let mut knots = vec![0.0];
    knots.extend((0..=n).flat_map(|k| [k as f64; 2]));
    knots.push(n as f64);
    NurbsData {
        degree: [2, 2],
        size: [9, profile.len()],
        points: rows.concat(),
        knots: [vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0], knots],
        ..NurbsData::default()
    }
}

fn torus_data(r: f64) -> NurbsData {
    let h = 0.5_f64.sqrt();
    turned(&[
        [1.0 + r, 0.0, 1.0],
        [1.0 + r, r, h],
        [1.0, r, 1.0],
        [1.0 - r, r, h],
        [1.0 - r, 0.0, 1.0],
        [1.0 - r, -r, h],
        [1.0, -r, 1.0],
        [1.0 + r, -r, h],
        [1.0 + r, 0.0, 1.0],
    ])
}

/// Every ray from a point inside leaves one time more often than it enters, and entries and exits
/// alternate.
fn leaves(solid: &Sewn, ray: &Ray) -> bool {
    let roots = all_roots(solid, ray);
    let mut inside = true;
    for root in roots.iter().filter(|r| r.sign != 0) {
        assert_eq!(root.sign > 0, inside, "{ray:?} {roots:?}");
        inside = !inside;
    }
    assert!(!inside, "{ray:?} escapes: {roots:?}");
    roots.iter().all(|r| r.kind == RootKind::Simple)
}

#[test]
fn no_ray_escapes_from_a_box_of_six_faces() {
    let mut proven = 0;
    for case in drawn(20) {
        let mut dice = crate::laws::dice(301, case);
        let mut corners = std::collections::HashMap::new();
        let mut moves = Vec::new();
        for k in 0..8 {
            let p = [0, 1, 2].map(|i| if k >> i & 1 == 0 { -1.0 } else { 1.0 });
            let off = if case == 0 { Vec3::ZERO } else { dice.vector() * 0.2 };
            corners.insert(k, [p[0] + off.x, p[1] + off.y, p[2] + off.z]);
            moves.push(corners[&k]);
        }
        let number = |p: [f64; 3]| (0..3).map(|i| usize::from(p[i] > 0.0) << i).sum::<usize>();
        let solid = closed(cube(|p| moves[number(p)]), 0.0);
        assert_eq!(solid.solidity(), Solidity::Solid);
        for _ in 0..1000 {
            let origin = if dice.once_in(2) { Vec3::ZERO } else { dice.vector() * 0.3 };
            let corner = |dice: &mut TestRng| Vec3::from(moves[dice.below(8) as usize]);
            let target = match dice.below(4) {
                0 => corner(&mut dice),
                1 => {
                    let (k, i) = (dice.below(8) as usize, dice.below(3) as usize);
                    let (a, b) = (Vec3::from(moves[k]), Vec3::from(moves[k ^ (1 << i)]));
                    let t = dice.pick(&[0.5, 0.25, 0.3]);
                    a + (b - a) * t
                }
                _ => dice.vector() + origin,
            };
            proven += u64::from(leaves(&solid, &Ray::new(origin.to_point(), target - origin)));
        }
    }
    println!("{proven} of 20000 proven");
    report(20_000);
}

/// A ray past an edge, or nearly in the plane of a face beside it: whatever the faces tell by themselves,
/// the ray enters and leaves alternately, and is outside at both ends.
#[test]
fn a_line_at_an_edge_enters_and_leaves_in_turn() {
    let solid = closed(cube(|p| p), 0.0);
    let found = [
        // It left before it entered.
        [
            0.3278359872046709,
            2.5506564107340948,
            0.34458440127290957,
            0.33608200639766456,
            -0.7753282053670473,
            -0.43918248402792015,
        ],
        // It entered once, and never left.
        [
            0.9999999999999966,
            2.1738276275480075,
            0.28685799543810764,
            1.7427319901556143e-15,
            -0.5869138137740039,
            -0.14701897217741777,
        ],
        // It entered twice.
        [
            1.000000000000027,
            3.559519218744533,
            3.9084996263569125,
            -6.751855225660978e-15,
            -0.6398798046861333,
            -0.7982506012083666,
        ],
    ];
    let found = found.map(|[x, y, z, a, b, c]| Ray::new(Point3::new(x, y, z), Vec3::new(a, b, c)));
    let random = drawn(3000).map(|case| {
        let mut dice = crate::laws::dice(83, case);
        let at = Point3::new(1.0, 1.0, dice.between(-0.9, 0.9));
        let tilt = dice.scale(-50, 0);
        let d = Vec3::new(dice.pick(&[1.0, -1.0]) * tilt, -dice.between(0.1, 1.0), dice.between(-1.0, 1.0));
        Ray::new(at - d * dice.pick(&[1.0, 2.0, 4.0]), d)
    });
    for ray in found.into_iter().chain(random) {
        let ray = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
        let signs: Vec<i8> = all_roots(&solid, &ray).iter().map(|r| r.sign).filter(|s| *s != 0).collect();
        assert!(signs.is_empty() || signs == [-1, 1], "{ray:?} {signs:?}");
    }
}

#[test]
fn no_ray_escapes_from_a_rational_sphere_and_torus() {
    let solids = [closed(vec![sphere_data()], 0.0), closed(vec![torus_data(0.25)], 0.0)];
    let (mut rays, mut proven) = (0, 0);
    for case in drawn(8000) {
        let mut dice = crate::laws::dice(303, case);
        let k = dice.below(2) as usize;
        let (sin, cos) = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][dice.below(4) as usize];
        let middle = if k == 0 { Vec3::ZERO } else { Vec3::new(cos, 0.0, sin) };
        let origin = if dice.once_in(2) { middle } else { middle + dice.vector() * 0.1 };
        let aim = match dice.below(5) {
            // At seams: through the axis, and in the planes between patches.
            0 => Vec3::new(0.0, dice.pick(&[-1.0, 1.0]), 0.0),
            1 => Vec3::new(dice.between(-1.0, 1.0), 0.0, dice.between(-1.0, 1.0)),
            2 => Vec3::new(cos * dice.between(-1.5, 1.5), 1.0, sin * dice.between(-1.5, 1.5)),
            _ => dice.vector(),
        };
        if aim == Vec3::ZERO {
            continue;
        }
        proven += u64::from(leaves(&solids[k], &Ray::new(origin.to_point(), aim)));
        rays += 1;
    }
    println!("{proven} of {rays} proven");
    report(rays);
}

/// A pot: a wall of rational arcs, closed by a bottom and a lid that is pointed.
fn pot() -> Vec<NurbsData> {
    vec![
        turned(&[[0.5, -1.0, 1.0], [1.25, -0.75, 0.5], [1.0, 0.0, 1.0], [0.75, 0.5, 2.0], [0.75, 1.0, 1.0]]),
        turned(&[[0.0, -1.0, 1.0], [0.25, -1.0, 1.0], [0.5, -1.0, 1.0]]),
        turned(&[[0.0, 1.5, 1.0], [0.25, 1.0, 1.0], [0.75, 1.0, 1.0]]),
    ]
}

#[test]
fn no_ray_escapes_from_a_pot_with_a_lid() {
    let solid = closed(pot(), 0.0);
    let (mut rays, mut proven) = (0, 0);
    for case in drawn(6000) {
        let mut dice = crate::laws::dice(305, case);
        let origin = if dice.once_in(2) { Vec3::ZERO } else { dice.vector() * 0.25 };
        let turn = dice.unit() * std::f64::consts::TAU;
        let (sin, cos) = (durer_math::elementary::sin(turn), durer_math::elementary::cos(turn));
        let target = match dice.below(6) {
            0 => Vec3::new(0.0, dice.pick(&[1.5, -1.0]), 0.0),
            1 => Vec3::new(0.5 * cos, -1.0, 0.5 * sin),
            2 => Vec3::new(0.75 * cos, 1.0, 0.75 * sin),
            3 => {
                dice.pick(&[Vec3::new(0.75, 1.0, 0.0), Vec3::new(0.0, -1.0, -0.5), Vec3::new(1.0, 0.0, 0.0)])
            }
            _ => dice.vector() + origin,
        };
        if target == origin {
            continue;
        }
        proven += u64::from(leaves(&solid, &Ray::new(origin.to_point(), target - origin)));
        rays += 1;
    }
    println!("{proven} of {rays} proven");
    report(rays);
}

#[test]
fn points_are_inside_or_outside() {
    let solids = [closed(vec![sphere_data()], 0.0), closed(vec![torus_data(0.25)], 0.0)];
    let mut dice = crate::laws::dice(307, 0);
    for _ in 0..2000 {
        let p = dice.vector() * 1.5;
        let round = (p.x * p.x + p.z * p.z).sqrt();
        let off = [p.length() - 1.0, ((round - 1.0) * (round - 1.0) + p.y * p.y).sqrt() - 0.25];
        for (solid, off) in solids.iter().zip(off) {
            if off.abs() > 1e-12 {
                let want = if off < 0.0 { Side::In } else { Side::Out };
                assert_eq!(solid.side(&LocalPoint::new(p.to_point())), want, "{p:?}");
            }
        }
    }
    assert_eq!(solids[0].side(&LocalPoint::new(Point3::new(1.0, 0.0, 0.0))), Side::On);
}

/// A cube of trimmed faces that are too large, cut by loops that leave gaps and overlaps of up to
/// `off`.
fn loose_cube(dice: &mut TestRng, off: f64) -> Vec<NurbsData> {
    let mut faces = cube(|p| p);
    for face in &mut faces {
        for p in &mut face.points {
            // The coordinate that is the same for the whole face stays.
            let fixed = (0..3).find(|k| p[*k].abs() > 1.5).unwrap_or(3);
            assert_eq!(fixed, 3);
        }
        let fixed = (0..3).find(|k| face.points.iter().all(|p| p[*k] == face.points[0][*k])).unwrap();
        for p in &mut face.points {
            for k in 0..3 {
                p[k] *= if k == fixed { 1.0 } else { 2.0 };
            }
        }
        let mut corner =
            |u: f64, v: f64| [u + dice.between(-off, off) * 0.25, v + dice.between(-off, off) * 0.25];
        let loop_ = vec![corner(0.25, 0.25), corner(0.75, 0.25), corner(0.75, 0.75), corner(0.25, 0.75)];
        face.trims = vec![TrimLoop::Polygon(loop_)];
    }
    faces
}

#[test]
fn no_ray_escapes_through_sealed_gaps() {
    let mut proven = 0;
    for case in drawn(12) {
        let mut dice = crate::laws::dice(309, case);
        let off = 1e-4;
        let solid = closed(loose_cube(&mut dice, off), 4.0 * off);
        for _ in 0..1500 {
            let origin = dice.vector() * 0.5;
            // Half of the rays aim at edges and corners, within the gaps and beside them.
            let mut target = [0, 1, 2].map(|_| dice.pick(&[-1.0, 1.0]));
            if dice.once_in(2) {
                target[dice.below(3) as usize] = dice.between(-1.0, 1.0);
            }
            if dice.once_in(2) {
                target[dice.below(3) as usize] = dice.between(-1.0, 1.0);
            }
            let target = Vec3::from(target) + dice.vector() * (off * dice.pick(&[0.0, 0.25, 1.0]));
            proven += u64::from(leaves(&solid, &Ray::new(origin.to_point(), target - origin)));
        }
    }
    println!("{proven} of 18000 proven");
    report(18_000);
}

#[test]
fn rays_past_a_sealed_cube_meet_it_evenly() {
    for case in drawn(6) {
        let mut dice = crate::laws::dice(311, case);
        let off = 1e-4;
        let solid = closed(loose_cube(&mut dice, off), 4.0 * off);
        for _ in 0..1500 {
            let mut aim = [0, 1, 2].map(|_| dice.pick(&[-1.0, 1.0]));
            aim[dice.below(3) as usize] = dice.between(-1.2, 1.2);
            let aim = Vec3::from(aim) + dice.vector() * off;
            let direction = dice.vector();
            let ray = Ray::new((aim - direction * 5.0).to_point(), direction).with_range(-1e9, 1e9);
            let roots = all_roots(&solid, &ray);
            let sum: i32 = roots.iter().map(|r| i32::from(r.sign)).sum();
            assert_eq!(sum, 0, "{ray:?} {roots:?}");
        }
    }
}

#[test]
fn a_sheet_needs_no_partners() {
    let mut faces = cube(|p| p);
    faces.truncate(4);
    let sheet = Sewn::new(SewnData { surfaces: faces, ..SewnData::default() }).unwrap();
    assert_eq!(sheet.solidity(), Solidity::Open);
    // An edge that two of them share is met once.
    let ray = Ray::new(Point3::new(5.0, 5.0, 0.0), Vec3::new(-1.0, -1.0, 0.0));
    let roots = all_roots(&sheet, &ray);
    assert!(roots.len() == 2 || roots.len() == 4, "{roots:?}");
}

#[test]
fn what_is_not_closed_is_named() {
    let error = |surfaces: Vec<NurbsData>, seal: f64| {
        Sewn::new(SewnData { surfaces, seal, closed: true }).unwrap_err()
    };
    let mut faces = cube(|p| p);
    faces.pop();
    let text = error(faces, 0.0).to_string();
    assert!(text.starts_with("sewn: it is not closed: side "), "{text}");
    assert!(text.contains("has no partner"), "{text}");
    assert_eq!(error(vec![], 0.0), SewnError::Empty);
    assert_eq!(error(cube(|p| p), -1.0), SewnError::Seal(-1.0));
    let mut bad = cube(|p| p);
    bad[2].points[0][3] = 0.0;
    assert!(
        error(bad, 0.0).to_string().starts_with("sewn: surface 3: nurbs: the weight of point 1 of row 1")
    );
    let mut twice = cube(|p| p);
    twice.push(twice[0].clone());
    assert!(matches!(error(twice, 0.0), SewnError::Many { .. }));
    // Gaps wider than the seal.
    let mut dice = crate::laws::dice(313, 0);
    let loose = loose_cube(&mut dice, 1e-3);
    assert!(matches!(error(loose, 1e-7), SewnError::Edge { .. }));
}

/// A net whose left and right sides are the same curve, in opposite directions: a bottle of Klein.
#[test]
fn a_surface_with_one_side_has_no_inside() {
    let (n, m) = (4_usize, 4_usize);
    let mut dice = crate::laws::dice(315, 0);
    let mut points = vec![[0.0, 0.0, 0.0, 1.0]; (n + 1) * (m + 1)];
    for p in &mut points {
        let v = dice.vector();
        *p = [v.x, v.y, v.z, 1.0];
    }
    let at = |i: usize, j: usize| j * (n + 1) + i;
    for j in 0..=m {
        points[at(n, j)] = points[at(0, (m - j) % m)];
    }
    for i in 0..=n {
        points[at(i, m)] = points[at(i, 0)];
    }
    points[at(n, m)] = points[at(0, 0)];
    let bottle = NurbsData { degree: [1, 1], size: [n + 1, m + 1], points, ..NurbsData::default() };
    let made = Sewn::new(SewnData { surfaces: vec![bottle], seal: 0.0, closed: true });
    assert_eq!(made.unwrap_err(), SewnError::Sides { a: 1, b: 1 });
}
