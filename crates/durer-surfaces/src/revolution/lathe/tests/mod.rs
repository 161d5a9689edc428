//! The laws, tested against exact crossings that share no code with the kernel; and the laws of
//! rays through joints, poles and rims.

mod witness;

use super::*;
use crate::RootKind;
use crate::laws::{self, ExactLine, Feature, Oracle, TestRng, aim, all_roots, exact3};
use durer_math::{Ray, Vec3};
use witness::Turned;

/// Profiles that bound solids.
fn solids() -> Vec<(LatheSpline, Vec<[f64; 2]>)> {
    use LatheSpline::{Bezier, Cubic, Linear, Quadratic};
    let ball = [
        [0.0, -2.0],
        [1.125, -2.0],
        [2.0, -1.125],
        [2.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.125],
        [1.125, 2.0],
        [0.0, 2.0],
    ];
    vec![
        (Linear, vec![[0.0, -2.0], [2.0, 0.0], [0.0, 2.0]]),
        (Linear, vec![[0.0, -1.0], [2.0, -1.0], [2.0, 1.0], [0.0, 1.0]]),
        (Linear, vec![[1.0, -1.0], [2.0, 0.5], [1.5, 1.0], [0.5, 2.0], [1.0, -1.0]]),
        // Through the axis, and along it.
        (Linear, vec![[0.0, -2.0], [2.0, -1.0], [-1.0, 1.0], [0.0, 2.0]]),
        (Linear, vec![[0.0, -2.0], [1.0, -2.0], [0.0, -1.0], [0.0, 1.0], [1.0, 2.0], [0.0, 2.0]]),
        (Quadratic, vec![[1.0, 2.0], [0.0, -2.0], [2.0, -1.0], [1.0, 0.0], [0.0, 2.0]]),
        (Quadratic, vec![[1.0, 0.0], [2.0, 1.0], [3.0, 0.0], [2.0, -1.0], [1.0, 0.0], [2.0, 1.0]]),
        (Cubic, vec![[-2.0, -2.0], [0.0, -2.0], [2.0, -1.0], [1.0, 0.5], [2.0, 1.0], [0.0, 2.0], [1.0, 2.0]]),
        (Cubic, vec![[1.0, 1.0], [0.5, -1.0], [3.0, 0.0], [1.0, 1.0], [0.5, -1.0], [3.0, 0.0]]),
        // A profile that crosses itself.
        (Cubic, vec![[2.0, 1.0], [0.5, -1.0], [2.0, -1.0], [0.5, 1.0], [2.0, 1.0], [0.5, -1.0], [2.0, 0.0]]),
        (Bezier, ball.to_vec()),
        (Bezier, vec![[1.0, -1.0], [5.0, 2.0], [-3.0, 2.0], [1.0, -1.0]]),
    ]
}

/// Profiles of sheets.
fn sheets() -> Vec<(LatheSpline, Vec<[f64; 2]>)> {
    use LatheSpline::{Bezier, Cubic, Linear, Quadratic};
    vec![
        (Linear, vec![[1.0, -1.0], [2.0, 0.0], [1.5, 1.0]]),
        (Linear, vec![[0.5, 1.0], [2.0, 1.0]]),
        (Quadratic, vec![[1.0, -2.0], [2.0, -1.0], [0.5, 0.5], [1.0, 2.0]]),
        (Cubic, vec![[1.0, -2.0], [2.0, -1.0], [-1.0, 0.5], [1.0, 2.0], [1.0, 1.0]]),
        (
            Bezier,
            vec![
                [1.0, -1.0],
                [3.0, 0.0],
                [-2.0, 1.0],
                [1.0, 2.0],
                [2.0, 1.0],
                [2.0, 1.5],
                [1.5, 2.0],
                [1.0, 1.0],
            ],
        ),
    ]
}

fn cases(profiles: Vec<(LatheSpline, Vec<[f64; 2]>)>, solid: bool) -> Vec<(Lathe, Turned)> {
    let made = |(spline, points): (LatheSpline, Vec<[f64; 2]>)| {
        let (lathe, oracle) = (Lathe::new(spline, &points).unwrap(), Turned::new(spline, &points));
        assert_eq!((lathe.solidity() == Solidity::Solid, oracle.is_solid), (solid, solid), "{points:?}");
        (lathe, oracle)
    };
    profiles.into_iter().map(made).collect()
}

/// Points of the walls with tangents, parallels and normals; the poles, with the axis.
fn features(oracle: &Turned) -> Vec<Feature> {
    let mut out = vec![];
    for piece in &oracle.pieces {
        for u in [0.0, 0.25, 0.5, 0.625, 1.0] {
            let at = |k: usize| {
                let p: Vec<f64> = piece[k].iter().map(laws::Exact::to_f64).collect();
                let slope = (1..p.len()).rev().fold(0.0, |s, i| s * u + i as f64 * p[i]);
                (p.iter().rev().fold(0.0, |s, a| s * u + a), slope)
            };
            let ((r, r1), (y, y1)) = (at(0), at(1));
            for (c, s) in [(1.0, 0.0), (0.0, -1.0), (0.6, 0.8)] {
                let point = Point3::new(c * r, y, s * r);
                for direction in [
                    Vec3::new(c * r1, y1, s * r1),
                    Vec3::new(-s, 0.0, c),
                    Vec3::new(-s, 0.25, c),
                    Vec3::new(c * y1, -r1, s * y1),
                    Vec3::new(c, 0.0, s),
                    Vec3::Y,
                ] {
                    if direction != Vec3::ZERO {
                        out.push(Feature { point, direction });
                    }
                }
            }
        }
    }
    out
}

/// Tests what the laws say of rays that meet no joint exactly.
fn obey(profiles: Vec<(LatheSpline, Vec<[f64; 2]>)>, solid: bool, count: u64) {
    let (mut rays, mut roots, mut clear, mut widths) = (0, 0, 0, vec![]);
    for (seed, (lathe, oracle)) in cases(profiles, solid).iter().enumerate() {
        let features = features(oracle);
        for i in laws::drawn(count) {
            let ray = aim(&mut laws::dice(seed as u64, i), &features, oracle.size());
            let line = ExactLine::new(&ray);
            if !ray.is_valid() || oracle.met(&line).is_none() {
                continue;
            }
            let broken = |e: laws::Broken| -> Vec<Root> { panic!("{e}\n{seed} {i} {ray:?}\n{lathe:?}") };
            let found = if solid && oracle.is_spread(&line) && oracle.is_clear(&line) {
                clear += 1;
                laws::check(lathe, oracle, &ray).unwrap_or_else(broken)
            } else if solid && oracle.is_spread(&line) {
                laws::roots_are_the_exact_crossings(lathe, oracle, &ray, None).unwrap_or_else(broken)
            } else {
                let all = all_roots(lathe, &ray.with_range(f64::NEG_INFINITY, f64::INFINITY));
                let exact = oracle.crossings(&line);
                assert_eq!(all.len(), exact.len(), "{seed} {i} {ray:?} {all:?}\n{lathe:?}");
                for (root, c) in all.iter().zip(&exact) {
                    let held =
                        c.t.cmp_exact(&root.lo.into()).is_ge() && c.t.cmp_exact(&root.hi.into()).is_le();
                    let kind = if c.grazing { RootKind::Grazing } else { RootKind::Simple };
                    assert!(
                        held && root.kind == kind,
                        "{seed} {i} {ray:?} {root:?} {:?}\n{lathe:?}",
                        c.t.about(80).to_f64()
                    );
                }
                all
            };
            rays += 1;
            roots += found.len();
            widths.extend(found.iter().map(|root| laws::width(lathe, oracle, &ray, root)));
        }
    }
    laws::report(rays);
    widths.sort_by(f64::total_cmp);
    let median = widths[widths.len() / 2];
    assert!(rays > 150 && roots > 150 && median < 100.0, "{rays} {roots} {clear} {median}");
    assert!(!solid || clear > count, "{clear}");
}

#[test]
fn solid_lathes_obey_the_laws_off_their_joints() {
    obey(solids(), true, 45);
}

#[test]
fn open_lathes_are_met_where_exact_arithmetic_says() {
    obey(sheets(), false, 45);
}

#[test]
fn where_the_profile_crosses_itself_both_walls_are_met() {
    let bow_tie = vec![[1.0, -1.0], [3.0, 1.0], [3.0, -1.0], [1.0, 1.0], [1.0, -1.0]];
    let lathe = Lathe::new(LatheSpline::Linear, &bow_tie).unwrap();
    let met = |origin: [f64; 3], direction: [f64; 3]| -> Vec<(f64, i8)> {
        let ray = Ray::new(Point3::from(origin), Vec3::from(direction));
        all_roots(&lathe, &ray).iter().map(|root| (root.t, root.sign)).collect()
    };
    let through = [(1.0, -1), (2.0, 1), (2.0, -1), (3.0, 1)];
    assert_eq!(met([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), through);
    assert_eq!(met([0.0, -1.0, 0.0], [1.0, 0.5, 0.0]), through);
    assert_eq!(met([0.0, 1.0, 0.0], [1.0, -0.5, 0.0]), through);
    assert_eq!(met([2.0, -1.0, 0.0], [0.0, 1.0, 0.0]), [(1.0, -1), (1.0, 1)]);
}

/// An almost level ray leaves through the lowest point of a ring, which it enters `2^-1050` before.
#[test]
fn crossings_beside_the_lowest_point_are_in_order() {
    let points = [[1.0, 1.0], [2.0, -1.0], [4.0, 1.0], [2.0, 3.0], [1.0, 1.0], [2.0, -1.0], [4.0, 1.0]];
    let ring = Lathe::new(LatheSpline::Cubic, &points).unwrap();
    for slope in [-5e-324, -1e-300, -1e-30, 1e-30, 1e-300, 5e-324] {
        let ray = Ray::new(Point3::new(0.0, -1.0, 2.0), Vec3::new(0.0, slope, -1.0));
        let roots = all_roots(&ring, &ray.with_range(-1.0, 1.0));
        let [enters, leaves] = &roots[..] else { panic!("{slope}: {roots:?}") };
        assert_eq!((enters.sign, leaves.sign), (-1, 1), "{slope}: {roots:?}");
        let (at_start, other) = if slope < 0.0 { (leaves, enters) } else { (enters, leaves) };
        assert!(at_start.lo <= 0.0 && at_start.hi >= 0.0, "{slope}: {roots:?}");
        assert!(if slope < 0.0 { other.lo < 0.0 } else { other.hi > 0.0 }, "{slope}: {roots:?}");
    }
}

#[test]
fn rays_through_joints_and_poles_go_in_as_often_as_out() {
    let mut through = 0;
    for (seed, (lathe, oracle)) in cases(solids(), true).iter().enumerate() {
        let features = features(oracle);
        let mut dice = TestRng::new(100 + seed as u64);
        for _ in 0..300 {
            let f = dice.pick(&features);
            let target = if dice.once_in(4) { dice.lattice(3).to_point() } else { f.point };
            let direction = match dice.below(3) {
                0 => f.direction,
                1 => dice.pick(&features).point - target,
                _ => dice.lattice(4),
            };
            if direction == Vec3::ZERO {
                continue;
            }
            let back = dice.pick(&[4.0, 1024.0, 1048576.0]);
            let ray =
                Ray::new(target - direction * back, direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(lathe, &ray);
            let (ins, outs) =
                (roots.iter().filter(|r| r.sign < 0).count(), roots.iter().filter(|r| r.sign > 0).count());
            assert!(
                ins == outs && roots.iter().all(|r| (r.sign == 0) == (r.kind == RootKind::Grazing)),
                "{roots:?} for {ray:?} and {lathe:?}"
            );
            through += usize::from(ins > 0);
            // From the inside outward.
            let from = (dice.lattice(6) * 0.5).to_point();
            let at = exact3(from.to_array());
            let side = lathe.side(&LocalPoint::new(from));
            let exact = match oracle.side(&at) {
                Some(Ordering::Less) => Side::In,
                Some(Ordering::Equal) => Side::On,
                _ => Side::Out,
            };
            assert_eq!(side, exact, "{from:?} {lathe:?}");
            let outward = Ray::new(from, f.point - from);
            if side != Side::On && outward.is_valid() {
                let met = all_roots(lathe, &outward).iter().filter(|r| r.sign != 0).count();
                assert_eq!(met % 2 == 1, side == Side::In, "{met} of {outward:?}: {lathe:?}");
            }
        }
    }
    assert!(through > 1000, "{through}");
}

#[test]
fn a_cylinder_and_a_cone_are_met_where_the_quadrics_are() {
    use crate::{CappedCylinder, Frustum};
    let (base, cap) = (Point3::new(0.0, -1.0, 0.0), Point3::new(0.0, 1.0, 0.0));
    let cylinder =
        Lathe::new(LatheSpline::Linear, &[[0.0, -1.0], [0.5, -1.0], [0.5, 1.0], [0.0, 1.0]]).unwrap();
    let cone = Lathe::new(LatheSpline::Linear, &[[0.0, -1.0], [1.0, -1.0], [0.25, 1.0], [0.0, 1.0]]).unwrap();
    let (quadric, frustum) =
        (CappedCylinder::new(base, cap, 0.5).unwrap(), Frustum::new(base, 1.0, cap, 0.25).unwrap());
    let mut dice = TestRng::new(5);
    let mut met = 0;
    for _ in 0..4000 {
        let target = (dice.vector() * 0.8).to_point();
        let d = dice.vector();
        if d == Vec3::ZERO {
            continue;
        }
        let ray = Ray::new(target - d * dice.pick(&[0.5, 8.0, 1e6]), d);
        let pairs: [(&dyn laws::TestSurface, &dyn laws::TestSurface); 2] =
            [(&cylinder, &quadric), (&cone, &frustum)];
        for (a, b) in pairs {
            let (a, b) = (all_roots(a, &ray), all_roots(b, &ray));
            assert_eq!(a.len(), b.len(), "{ray:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!(a.sign == b.sign && a.lo <= b.hi && b.lo <= a.hi, "{a:?} {b:?}");
                met += 1;
            }
        }
    }
    assert!(met > 4000, "{met}");
}

#[test]
fn bad_profiles_are_named() {
    let made = |spline, points: &[[f64; 2]]| Lathe::new(spline, points).unwrap_err();
    assert_eq!(made(LatheSpline::Linear, &[[1.0, 0.0]]), LatheError::TooFew { least: 2, got: 1 });
    assert_eq!(made(LatheSpline::Cubic, &[[1.0, 0.0]; 3]), LatheError::TooFew { least: 4, got: 3 });
    assert_eq!(made(LatheSpline::Bezier, &[[1.0, 0.0]; 6]), LatheError::NotFours(6));
    assert!(matches!(
        made(LatheSpline::Linear, &[[1.0, 0.0], [f64::NAN, 1.0]]),
        LatheError::Point { number: 2, height: 1.0, .. }
    ));
    assert_eq!(made(LatheSpline::Linear, &[[0.0, 0.0], [0.0, 1.0]]), LatheError::Empty);
    assert_eq!(made(LatheSpline::Linear, &[[1.0, 1.0], [1.0, 1.0]]), LatheError::Empty);
    assert_eq!(made(LatheSpline::Linear, &[[1.0, 0.0], [1e200, 1.0]]), LatheError::Range);
    assert_eq!(
        made(LatheSpline::Cubic, &[[1.0, 0.0], [1.0, 1.0], [1e308, 1.0], [-1e308, 1e308]]),
        LatheError::Range
    );
}
