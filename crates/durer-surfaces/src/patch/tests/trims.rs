//! Tests of trimmed surfaces.

use crate::laws::{TestRng, all_roots, drawn, report};
use crate::patch::{Nurbs, NurbsData, NurbsError, TrimError, TrimLoop};
use crate::{Root, RootKind};
use durer_math::{Point3, Ray, Vec3};

/// The square from 0 to 1 in the plane z = 0, with knots from 0 to 1 or with more of them.
fn sheet(trims: Vec<TrimLoop>, knots: &[f64]) -> Result<Nurbs, NurbsError> {
    let mut along = vec![0.0];
    along.extend(knots);
    along.push(1.0);
    let n = along.len();
    let points = along.iter().flat_map(|v| along.iter().map(|u| [*u, *v, 0.0, 1.0])).collect();
    let mut full = vec![0.0];
    full.extend(&along);
    full.push(1.0);
    Nurbs::new(NurbsData {
        degree: [1, 1],
        size: [n, n],
        points,
        knots: [full.clone(), full],
        trims,
        ..NurbsData::default()
    })
}

fn down(nurbs: &Nurbs, u: f64, v: f64) -> Vec<Root> {
    all_roots(nurbs, &Ray::new(Point3::new(u, v, 1.0), Vec3::new(0.0, 0.0, -1.0)))
}

fn polygon(points: &[[f64; 2]]) -> TrimLoop {
    TrimLoop::Polygon(points.to_vec())
}

fn square(low: f64, high: f64) -> TrimLoop {
    polygon(&[[low, low], [high, low], [high, high], [low, high]])
}

fn reversed(trim: &TrimLoop) -> TrimLoop {
    let mut trim = trim.clone();
    match &mut trim {
        TrimLoop::Polygon(points) | TrimLoop::Bezier(points) => points.reverse(),
        TrimLoop::Nurbs { points, .. } => points.reverse(),
    }
    trim
}

/// A circle of four rational arcs.
fn circle(x: f64, y: f64, r: f64) -> TrimLoop {
    let h = 0.5_f64.sqrt();
    let ring = [
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
        (-1.0, 0.0),
        (-1.0, -1.0),
        (0.0, -1.0),
        (1.0, -1.0),
    ];
    let at = |k: usize| {
        let (a, b) = ring[k % 8];
        [x + r * a, y + r * b, if k.is_multiple_of(2) { 1.0 } else { h }]
    };
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    TrimLoop::Nurbs { degree: 2, points: (0..9).map(at).collect(), knots }
}

#[test]
fn a_spline_of_degree_one_is_a_polygon() {
    let points = vec![[0.25, 0.25, 1.0], [0.75, 0.25, 1.0], [0.5, 0.75, 1.0], [0.25, 0.25, 1.0]];
    let nurbs = sheet(vec![TrimLoop::Nurbs { degree: 1, points, knots: vec![] }], &[0.5]).unwrap();
    assert_eq!((down(&nurbs, 0.5, 0.375).len(), down(&nurbs, 0.25, 0.5).len()), (1, 0));
}

#[test]
fn a_triangle_is_cut_out_exactly() {
    // Corners are powers of two, so the side a point is on follows from exact products.
    let nurbs = sheet(vec![polygon(&[[0.125, 0.125], [0.875, 0.25], [0.25, 0.75]])], &[0.5]).unwrap();
    let sides =
        [([0.125, 0.125], [0.75, 0.125]), ([0.875, 0.25], [-0.625, 0.5]), ([0.25, 0.75], [-0.125, -0.625])];
    let (mut dice, mut uncertain) = (crate::laws::dice(211, 0), 0);
    for _ in 0..20_000 {
        // Half of the points are on a side or within some ulp of it.
        let p = if dice.once_in(2) {
            let (from, along) = dice.pick(&sides);
            let t = dice.integer(0, 256) / 256.0;
            [0, 1].map(|k| {
                let on = from[k] + t * along[k];
                on + dice.integer(-3, 3) * dice.pick(&[0.0, 1.0]) * f64::EPSILON * on
            })
        } else {
            [dice.unit(), dice.unit()]
        };
        let cross = sides.map(|(from, along)| {
            crate::laws::Exact::from(along[0])
                .times_difference(p[1], from[1])
                .minus(&crate::laws::Exact::from(along[1]).times_difference(p[0], from[0]))
        });
        let is_out = cross.iter().any(|c| *c < 0);
        let is_in = cross.iter().all(|c| *c > 0);
        let roots = down(&nurbs, p[0], p[1]);
        match roots.as_slice() {
            [root] if root.kind == RootKind::Simple => assert!(is_in, "{p:?} {root:?}"),
            [root] => {
                assert_eq!(root.sign, -1);
                uncertain += 1;
                // Within some ulp of a side.
                let near = sides.iter().any(|(from, along)| {
                    let c = along[0] * (p[1] - from[1]) - along[1] * (p[0] - from[0]);
                    c.abs() < 1e-14
                });
                assert!(near, "{p:?} {root:?}");
            }
            [] => assert!(is_out, "{p:?}"),
            _ => panic!("{p:?} {roots:?}"),
        }
    }
    println!("{uncertain} uncertain");
    report(20_000);
}

trait Signs {
    fn times_difference(&self, a: f64, b: f64) -> crate::laws::Exact;
    fn minus(&self, other: &crate::laws::Exact) -> i32;
}

impl Signs for crate::laws::Exact {
    fn times_difference(&self, a: f64, b: f64) -> Self {
        self * &(&Self::from(a) - &Self::from(b))
    }

    fn minus(&self, other: &Self) -> i32 {
        (self - other).sign() as i32
    }
}

#[test]
fn holes_and_islands_alternate() {
    let loops = vec![
        square(0.0, 1.0),
        reversed(&circle(0.5, 0.5, 0.375)),
        circle(0.5, 0.5, 0.25),
        reversed(&square(0.4375, 0.5625)),
    ];
    let hole_only = loops[1..2].to_vec();
    let (all, hole) = (sheet(loops, &[0.25, 0.5]).unwrap(), sheet(hole_only, &[0.3]).unwrap());
    let mut dice = crate::laws::dice(213, 0);
    for _ in 0..20_000 {
        let (u, v) = (dice.unit(), dice.unit());
        let r = ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5)).sqrt();
        if (r - 0.375).abs() < 1e-12 || (r - 0.25).abs() < 1e-12 {
            continue;
        }
        let box_ = (u - 0.5).abs().max((v - 0.5).abs());
        let want = r > 0.375 || r < 0.25 && box_ > 0.0625;
        assert_eq!(down(&all, u, v).len(), usize::from(want), "{u} {v}");
        assert_eq!(down(&hole, u, v).len(), usize::from(r > 0.375), "{u} {v}");
    }
    // Along the border of the domain and at its corners.
    for (u, v) in
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.5), (1.0, 0.3), (0.7, 1.0), (0.2, 0.0)]
    {
        for nurbs in [&all, &hole] {
            let roots = down(nurbs, u, v);
            assert!(roots.len() == 1 && roots[0].kind == RootKind::Simple, "{u} {v} {roots:?}");
        }
    }
}

#[test]
fn cubic_loops_keep_what_is_left_of_them() {
    // A drop with its tip at the origin of the curve, of two cubics.
    let drop = TrimLoop::Bezier(vec![
        [0.5, 0.125],
        [0.75, 0.25],
        [0.875, 0.875],
        [0.5, 0.875],
        [0.5, 0.875],
        [0.125, 0.875],
        [0.25, 0.25],
        [0.5, 0.125],
    ]);
    let point = |s: f64, p: [f64; 4]| {
        let r = 1.0 - s;
        p[0] * r * r * r + 3.0 * p[1] * r * r * s + 3.0 * p[2] * r * s * s + p[3] * s * s * s
    };
    let nurbs = sheet(vec![drop], &[]).unwrap();
    let mut dice = crate::laws::dice(217, 0);
    for _ in 0..20_000 {
        let s = dice.unit();
        let edge = [point(s, [0.5, 0.75, 0.875, 0.5]), point(s, [0.125, 0.25, 0.875, 0.875])];
        let off = dice.scale(-16, -3) * dice.pick(&[-1.0, 1.0]);
        let (u, v) = (edge[0] + off, edge[1]);
        if !(0.5..=1.0).contains(&u) {
            continue;
        }
        // The right half is one function of v. What is nearer than the rounding may be uncertain.
        let roots = down(&nurbs, u, v);
        let near = off.abs() < 1e-14 && roots.iter().all(|r| r.kind != RootKind::Simple);
        assert!(near || roots.len() == usize::from(off < 0.0), "{u} {v} {off} {roots:?}");
    }
}

fn wrong(trims: Vec<TrimLoop>) -> String {
    sheet(trims, &[]).unwrap_err().to_string()
}

#[test]
fn bad_trims_are_named() {
    let bow = polygon(&[[0.1, 0.1], [0.9, 0.9], [0.9, 0.1], [0.1, 0.9]]);
    assert!(wrong(vec![bow]).starts_with("nurbs: trim 1: it crosses or touches itself near"));
    assert!(wrong(vec![square(0.1, 0.6), square(0.4, 0.9)]).contains("trim 2: it crosses or touches trim 1"));
    assert!(wrong(vec![square(0.1, 1.5)]).contains("trim 1: it leaves the surface at <1.5, 0.1>"));
    assert!(
        wrong(vec![square(0.1, 0.9), square(0.2, 0.8)])
            .contains("trim 2: it runs the same way round as trim 1")
    );
    assert!(
        wrong(vec![polygon(&[[0.1, 0.1], [0.9, f64::NAN], [0.5, 0.5]])]).contains("point 2 must be finite")
    );
    assert!(wrong(vec![polygon(&[[0.1, 0.1], [0.9, 0.2]])]).contains("it needs 3 points at least, got 2"));
    let open = TrimLoop::Bezier(vec![[0.1, 0.1], [0.2, 0.1], [0.3, 0.2], [0.4, 0.4]]);
    assert!(
        wrong(vec![open])
            .contains("it is open: a curve ends at <0.4, 0.4> and the next begins at <0.1, 0.1>")
    );
    let looping = TrimLoop::Bezier(vec![[0.5, 0.1], [1.0, 0.9], [0.0, 0.9], [0.5, 0.1]]);
    assert!(sheet(vec![looping.clone()], &[]).is_ok(), "{:?}", sheet(vec![looping], &[]));
    let crossing = TrimLoop::Bezier(vec![
        [0.25, 0.25],
        [1.0, 0.75],
        [0.0, 0.75],
        [0.75, 0.25],
        [0.75, 0.25],
        [0.75, 0.125],
        [0.25, 0.125],
        [0.25, 0.25],
    ]);
    assert!(wrong(vec![crossing]).contains("crosses or touches itself"));
    let flat = polygon(&[[0.1, 0.1], [0.9, 0.1], [0.5, 0.1]]);
    assert!(sheet(vec![flat], &[]).is_err());
    let mut round = circle(0.5, 0.5, 0.25);
    if let TrimLoop::Nurbs { points, .. } = &mut round {
        points[3][2] = -1.0;
    }
    assert!(wrong(vec![round]).contains("the weight of point 4 must be positive"));
    let short = TrimLoop::Nurbs { degree: 3, points: vec![[0.1, 0.1, 1.0]; 4], knots: vec![0.0; 7] };
    assert!(wrong(vec![short]).contains("8 knots are needed, got 7"));
}

#[test]
fn random_star_polygons_are_kept_inside() {
    for case in drawn(40) {
        let mut dice = crate::laws::dice(219, case);
        let n = 3 + dice.below(40) as usize;
        let spoke = |k: usize, r: f64| {
            let a = k as f64 / n as f64 * std::f64::consts::TAU;
            [0.5 + r * durer_math::elementary::cos(a), 0.5 + r * durer_math::elementary::sin(a)]
        };
        let corners: Vec<_> = (0..n).map(|k| spoke(k, dice.between(0.1, 0.49))).collect();
        let nurbs = sheet(vec![polygon(&corners)], &[0.5]).unwrap();
        for _ in 0..200 {
            check_star(&mut dice, &nurbs, &corners);
        }
    }
}

/// Even-odd by all edges, away from them.
fn check_star(dice: &mut TestRng, nurbs: &Nurbs, corners: &[[f64; 2]]) {
    let (u, v) = (dice.unit(), dice.unit());
    let mut odd = false;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if (a[1] > v) != (b[1] > v) {
            let x = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            if (x - u).abs() < 1e-9 {
                return;
            }
            odd ^= x > u;
        }
    }
    assert_eq!(down(nurbs, u, v).len(), usize::from(odd), "{u} {v} {corners:?}");
}

#[test]
fn errors_are_plain_values() {
    let error = sheet(vec![polygon(&[])], &[]).unwrap_err();
    assert_eq!(error, NurbsError::Trim { number: 1, why: TrimError::TooFew { least: 3, len: 0 } });
}
