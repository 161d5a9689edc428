//! Tests of sweeps: those along straight spans are held to prisms, the others to what every solid
//! keeps.

use super::*;
use crate::laws::dice;
use crate::{LocalPoint, Prism, Side, Solidity};

fn square(half: f64) -> Vec<crate::Bezier> {
    SweepData::edges(&[[-half, -half], [half, -half], [half, half], [-half, half]])
}

fn swept(spline: PathSpline, path: &[[f64; 4]], twist: f64) -> PathSweep {
    PathSweep::new(SweepData { outlines: vec![square(0.5)], spline, path: path.to_vec(), twist, up: None })
        .unwrap()
}

/// An L: two square beams that meet in a corner.
fn corner() -> (PathSweep, Prism) {
    let path = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 3.0, 1.0], [3.0, 0.0, 3.0, 1.0]];
    let outline = [[-0.5, 0.0], [0.5, 0.0], [0.5, 2.5], [3.0, 2.5], [3.0, 3.5], [-0.5, 3.5]];
    (swept(PathSpline::Linear, &path, 0.0), Prism::linear(&[outline.to_vec()], -0.5, 0.5).unwrap())
}

#[test]
fn a_corner_is_mitred() {
    let (ours, exact) = corner();
    let mut tally = Tally::default();
    for case in drawn(600) {
        let mut dice = dice(21, case);
        let from = Vec3::new(dice.between(-3.0, 6.0), dice.between(-3.0, 3.0), dice.between(-3.0, 6.0));
        let to = Vec3::new(dice.between(-0.5, 3.0), dice.between(-0.6, 0.6), dice.between(0.0, 3.5));
        let ray = Ray::new(from.to_point(), to - from).with_range(-1e9, 1e9);
        if !ray.is_valid() {
            continue;
        }
        compare(&ours, &exact, &ray, &mut tally);
        let signs = |s: &dyn TestSurface| all_roots(s, &ray).iter().map(|r| r.sign).collect::<Vec<_>>();
        assert_eq!(signs(&ours), signs(&exact), "{ray:?}");
        let point = LocalPoint::new(to.to_point());
        assert_eq!(ours.side(&point), exact.side(&point), "{to:?}");
    }
    tally.tell();
    assert_eq!(ours.solidity(), Solidity::Solid);
}

/// Curved, twisted, of changing size, with holes.
fn curved() -> Vec<PathSweep> {
    let wave = [
        [-2.0, 0.0, 0.0, 1.0],
        [-1.0, 0.5, 0.0, 0.8],
        [0.0, -0.3, 0.4, 0.5],
        [1.0, 0.4, -0.2, 0.7],
        [2.0, 0.0, 0.3, 1.0],
        [3.0, 0.2, 0.0, 1.0],
    ]
    .map(|[x, y, z, size]| [x, y, z, 0.5 * size]);
    let ring = |r: f64, k: f64| {
        let c = 0.5522847498 * r;
        vec![
            [[r, 0.0], [r, c * k], [c, r * k], [0.0, r * k]],
            [[0.0, r * k], [-c, r * k], [-r, c * k], [-r, 0.0]],
            [[-r, 0.0], [-r, -c * k], [-c, -r * k], [0.0, -r * k]],
            [[0.0, -r * k], [c, -r * k], [r, -c * k], [r, 0.0]],
        ]
    };
    let bow = [[0.0, 0.0, 0.0, 0.5], [0.0, 2.0, 0.0, 0.5], [2.0, 2.0, 0.5, 0.25], [2.0, 0.0, 1.0, 0.25]];
    let data = |outlines, spline, path: &[[f64; 4]], twist, up| SweepData {
        outlines,
        spline,
        path: path.to_vec(),
        twist,
        up,
    };
    vec![
        PathSweep::new(data(vec![square(0.5)], PathSpline::Cubic, &wave, 0.0, None)).unwrap(),
        PathSweep::new(data(vec![square(0.5)], PathSpline::BSpline, &wave, 2.0, None)).unwrap(),
        PathSweep::new(data(vec![ring(0.5, 1.0), ring(0.3, 1.0)], PathSpline::Bezier, &bow, 0.0, None))
            .unwrap(),
        PathSweep::new(data(vec![ring(0.5, -1.0)], PathSpline::Cubic, &wave, 0.0, Some(Vec3::Y))).unwrap(),
    ]
}

#[test]
fn lines_enter_and_leave_in_turn_and_rays_from_inside_come_out() {
    let mut seen = 0;
    for (k, body) in curved().iter().enumerate() {
        let held = body.bounds();
        for case in drawn(150) {
            let mut dice = dice(22 + k as u64, case);
            let at = |t: [f64; 3]| {
                let size = held.max - held.min;
                held.min.to_vec() + Vec3::new(size.x * t[0], size.y * t[1], size.z * t[2])
            };
            let from = at([dice.unit(), dice.unit(), dice.unit()]);
            let ray = Ray::new(from.to_point(), dice.vector()).with_range(-1e9, 1e9);
            if !ray.is_valid() {
                continue;
            }
            let mut roots = all_roots(body, &ray);
            roots.retain(|r| r.sign != 0);
            let signs: Vec<_> = roots.iter().map(|r| r.sign).collect();
            assert!(signs.len() % 2 == 0, "{k}: {ray:?} {roots:?}");
            assert!(signs.chunks(2).all(|s| s == [-1, 1]), "{k}: {ray:?} {roots:?}");
            seen += signs.len();
            // The side agrees with what lies on the line.
            let behind = roots.iter().filter(|r| r.t < 0.0).count();
            let side = body.side(&LocalPoint::new(from.to_point()));
            assert_eq!(side == Side::In, behind % 2 == 1, "{k}: {ray:?} {roots:?} {side:?}");
            // Normals point outward.
            let local = LocalRay::new(&ray);
            for root in roots.iter().filter(|r| r.kind == RootKind::Simple) {
                let p = body.resolve(&local, root, Need::ALL);
                let along = p.ng.to_vec().dot(ray.direction);
                assert!(along * f64::from(root.sign) >= -1e-9, "{k}: {ray:?} {root:?} {p:?}");
            }
        }
    }
    assert!(seen > 200, "{seen}");
}

#[test]
fn knots_and_edges_let_nothing_through() {
    for (k, body) in curved().iter().enumerate() {
        for case in drawn(120) {
            let mut dice = dice(31 + k as u64, case);
            let face = &body.sheet.faces[dice.below(body.walls as u64) as usize];
            let place = |tag: [f64; 2]| {
                let jets = face.tape.jet(tag);
                Vec3::new(jets[0].v, jets[1].v, jets[2].v)
            };
            let any = dice.unit();
            let border = [dice.pick(&[0.0, 1.0, any]), dice.pick(&[0.0, 1.0])];
            let (target, other) = (place(border), place([dice.unit(), dice.unit()]));
            let ray =
                Ray::new((other + (other - target) * dice.pick(&[0.0, 0.5])).to_point(), target - other)
                    .with_range(-1e9, 1e9);
            if ray.is_valid() && (target - other).length() > 1e-3 {
                let mut roots = all_roots(body, &ray);
                roots.retain(|r| r.sign != 0);
                let signs: Vec<_> = roots.iter().map(|r| r.sign).collect();
                assert!(signs.chunks(2).all(|s| s == [-1, 1]), "{k}: {ray:?} {roots:?}");
            }
        }
    }
}

#[test]
fn bad_sweeps_are_named() {
    let with = |spline, path: &[[f64; 4]], up| {
        let data = SweepData { outlines: vec![square(0.5)], spline, path: path.to_vec(), twist: 0.0, up };
        PathSweep::new(data).unwrap_err()
    };
    let p = |x: f64, y: f64| [x, y, 0.0, 1.0];
    assert_eq!(
        with(PathSpline::Cubic, &[p(0.0, 0.0); 3], None),
        SweepError::Points { what: "cubic_spline", least: 4, len: 3 }
    );
    assert_eq!(
        with(PathSpline::Linear, &[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 0.0)], None),
        SweepError::Tangent(1)
    );
    assert_eq!(
        with(PathSpline::Linear, &[p(0.0, 0.0), p(1.0, 0.0), p(0.5, 0.0)], None),
        SweepError::Reversal(1)
    );
    assert_eq!(
        with(PathSpline::Linear, &[p(0.0, 0.0), p(1.0, f64::NAN)], None),
        SweepError::Finite("the path")
    );
    assert_eq!(with(PathSpline::Linear, &[p(0.0, 0.0), p(0.0, 1.0)], Some(Vec3::Y)), SweepError::Up(0));
    assert_eq!(with(PathSpline::Linear, &[p(0.0, 0.0), [0.0, 1.0, 0.0, -1.0]], None), SweepError::Size(-1.0));
    let corner = [
        p(0.0, 0.0),
        p(1.0, 0.0),
        p(2.0, 0.0),
        p(3.0, 0.0),
        p(3.0, 0.0),
        p(3.0, 1.0),
        p(3.0, 2.0),
        p(3.0, 3.0),
    ];
    assert_eq!(with(PathSpline::Bezier, &corner, None), SweepError::Corner(1));
}
