//! Deformed solids against multi-precision values of the same maps in another form, against solids
//! to which they are equal, and against themselves.

#[path = "common/warp_witness.rs"]
mod witness;

use astro_float::BigFloat;
use durer_formula::{Builder, Formula, NodeId, Op};
use durer_math::{Aabb, Affine, Point3, Ray, RaySide, Vec3};
use durer_surfaces::implicit::level_set::primitives;
use durer_surfaces::{
    All, Axis, DeformError, Isosurface, LevelSet, LocalPoint, LocalRay, Need, Root, RootKind, Side, Sphere,
    Surface, Torus, Warp,
};
use durer_testkit::TestRng;
use durer_testkit::{case_seed, drawn, report};
use std::sync::Arc;
use witness::{Real, Solid, was};

/// Sequences of warps, to be applied to each solid.
fn ropes() -> Vec<Vec<Warp>> {
    let twist = |axis: Vec3, degrees: f64, from: f64, to: f64| Warp::Twist { axis, degrees, from, to };
    let taper = |axis: Vec3, factor: f64, from: f64, to: f64| Warp::Taper { axis, factor, from, to };
    let bend = |axis, toward, degrees, from, to| Warp::Bend { axis, toward, degrees, from, to };
    vec![
        vec![twist(Vec3::Z, 200.0, -1.0, 1.5)],
        vec![twist(-Vec3::Y, 75.0, -0.25, 0.125)],
        vec![taper(Vec3::Z, 0.25, -1.0, 1.5)],
        vec![taper(-Vec3::X, 3.0, -0.125, 0.25)],
        vec![bend(Vec3::Z, Vec3::X, 90.0, -1.0, 1.5)],
        vec![bend(Vec3::Z, Vec3::X, 100.0, -0.5, 1.0)],
        vec![bend(-Vec3::Z, Vec3::Y, -30.0, -0.25, 0.25)],
        vec![wave()],
        vec![
            twist(Vec3::Z, 90.0, -1.0, 1.5),
            taper(Vec3::Z, 0.5, -1.0, 1.5),
            bend(Vec3::Z, -Vec3::X, 60.0, -1.0, 1.5),
        ],
    ]
}

/// The warp whose inverse maps `y` to `y - sin(3 x) / 8`.
fn wave() -> Warp {
    let mut b = Builder::new();
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i).unwrap());
    let (three, eighth) = (b.constant(3.0).unwrap(), b.constant(0.125).unwrap());
    let three = b.push(Op::Mul(three, x)).unwrap();
    let sine = b.push(Op::Function(durer_formula::Function::Sin, three)).unwrap();
    let height = b.push(Op::Mul(eighth, sine)).unwrap();
    let y = b.push(Op::Sub(y, height)).unwrap();
    inverse([x, y, z], &b, 2.0)
}

fn inverse(roots: [NodeId; 3], b: &Builder, half: f64) -> Warp {
    let functions = Arc::new(roots.map(|root| b.finish(root, 3)));
    let half = Point3::new(half, half, half);
    Warp::Inverse { functions, within: Aabb::new((-half.to_vec()).to_point(), half) }
}

fn deformed(solid: &LevelSet, warps: &[Warp]) -> LevelSet {
    warps.iter().fold(solid.clone(), |solid, warp| solid.deformed(warp).unwrap())
}

fn surface(solid: &LevelSet) -> Isosurface {
    solid.surface().unwrap().unwrap()
}

fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

/// A ray from outside through the box of a surface, from near and far, along axes too.
fn ray_at(dice: &mut TestRng, bounds: &Aabb) -> Ray {
    let centre = bounds.centre();
    let half = bounds.widths() * 0.45;
    let mut direction = dice.vector();
    let through = dice.vector();
    match dice.below(5) {
        0 => direction[dice.below(3) as usize] = 0.0,
        1 => {
            let axis = dice.below(3) as usize;
            direction = [Vec3::X, Vec3::Y, Vec3::Z][axis] * if dice.below(2) == 0 { 1.0 } else { -1.0 };
        }
        _ => {}
    }
    let back = [8.0, 9.0, 1e3][dice.below(3) as usize] / direction.length();
    let through = Vec3::new(through.x * half.x, through.y * half.y, through.z * half.z);
    Ray::new(centre + through - direction * back, direction)
}

#[test]
fn brackets_hold_changes_of_sign_in_256_bits_and_none_is_missing() {
    let (mut rays, mut met, mut clusters, mut widths) = (0, 0, 0, Vec::new());
    for (n, rope) in ropes().iter().enumerate() {
        for solid in [Solid::Block, Solid::Ball, Solid::Ring, Solid::Shell] {
            let deformed = surface(&deformed(&solid.level_set(), rope));
            let value = |p: [BigFloat; 3]| {
                let q = rope.iter().rev().fold(p, |p, warp| was(warp, &p));
                solid.value(&q)
            };
            let sample =
                |p: Point3| solid.value(&rope.iter().rev().fold(p.to_array(), |p, warp| was(warp, &p)));
            for case in drawn(60) {
                let mut dice = TestRng::new(case_seed(7 + 64 * n as u64 + solid as u64, case));
                let ray = ray_at(&mut dice, &Surface::bounds(&deformed));
                rays += 1;
                let at = |t: f64| {
                    let t = BigFloat::of(t);
                    [0, 1, 2].map(|i| {
                        Real::add(
                            &BigFloat::of(ray.origin[i]),
                            &Real::mul(&t, &BigFloat::of(ray.direction[i])),
                        )
                    })
                };
                let roots = all(&deformed, &ray);
                let story = || format!("rope {n}, {solid:?}, {ray:?}: {roots:?}");
                assert!(roots.windows(2).all(|w| w[0].t <= w[1].t && w[0].sign == -w[1].sign), "{}", story());
                for root in &roots {
                    assert!(root.face == 0 && root.lo <= root.t && root.t <= root.hi, "{}", story());
                    if root.kind == RootKind::Cluster && root.sign == 0 {
                        clusters += 1;
                        continue;
                    }
                    let before = Real::is_negative(&value(at(root.lo)));
                    let after = Real::is_negative(&value(at(root.hi)));
                    assert_eq!((before, after), (root.sign > 0, root.sign < 0), "{}", story());
                    clusters += usize::from(root.kind == RootKind::Cluster);
                    met += 1;
                    widths.push((root.hi - root.lo) / (root.t.abs() * f64::EPSILON));
                }
                // Samples find no more changes than there are, and miss them in pairs.
                let length = ray.direction.length();
                let bounds = Surface::bounds(&deformed);
                let middle = (bounds.centre() - ray.origin).dot(ray.direction) / (length * length);
                let reach = bounds.widths().length() / length;
                let (mut changes, mut before) = (0, false);
                for i in 0..=4000 {
                    let t = middle + reach * (f64::from(i) / 2000.0 - 1.0);
                    let inside = sample(ray.at(t)) < 0.0;
                    changes += usize::from(inside != before);
                    before = inside;
                }
                let real = roots.iter().filter(|r| r.sign != 0).count();
                assert!(
                    real >= changes && (real - changes).is_multiple_of(2),
                    "{changes} changes, {}",
                    story()
                );
            }
        }
    }
    report(rays);
    widths.sort_by(f64::total_cmp);
    let median = widths[widths.len() / 2];
    println!("{met} roots, {clusters} clusters, median width {median:.1} ulp");
    assert!(
        met > 2000 && clusters * 50 < met && median < 200.0,
        "{met} roots, {clusters} clusters, {median} ulp"
    );
}

/// Compared with the half-spaces `n . p <= d` that bound it, in exact fractions.
#[test]
fn a_tapered_block_is_a_piece_of_a_pyramid() {
    use durer_math::Dyadic;
    // |x|, |y| <= 1 - z / 2 for z from 0 to 1.
    let block = {
        let (a, b) = (Point3::new(-1.0, -1.0, 0.0), Point3::new(1.0, 1.0, 1.0));
        LevelSet::new(primitives::cuboid(a, b).unwrap(), Aabb::new(a, b))
    };
    let pyramid =
        surface(&deformed(&block, &[Warp::Taper { axis: Vec3::Z, factor: 0.5, from: 0.0, to: 1.0 }]));
    let planes: [([f64; 3], f64); 6] = [
        ([1.0, 0.0, 0.5], 1.0),
        ([-1.0, 0.0, 0.5], 1.0),
        ([0.0, 1.0, 0.5], 1.0),
        ([0.0, -1.0, 0.5], 1.0),
        ([0.0, 0.0, 1.0], 1.0),
        ([0.0, 0.0, -1.0], 0.0),
    ];
    let mut dice = TestRng::new(11);
    let mut met = 0;
    for _ in 0..5000 {
        let ray = ray_at(&mut dice, &Surface::bounds(&pyramid));
        let dot = |n: &[f64; 3], v: [f64; 3]| {
            (0..3).fold(Dyadic::from(0.0), |sum, i| &sum + &(&Dyadic::from(n[i]) * &Dyadic::from(v[i])))
        };
        // Each plane's crossing as top / bottom with a positive bottom, and whether it is an entry.
        let (mut first, mut last) = (None::<(Dyadic, Dyadic)>, None::<(Dyadic, Dyadic)>);
        let mut beside = false;
        for (n, d) in &planes {
            let top = &Dyadic::from(*d) - &dot(n, ray.origin.to_array());
            let bottom = dot(n, ray.direction.to_array());
            let less = |a: &(Dyadic, Dyadic), b: &(Dyadic, Dyadic)| {
                (&(&a.0 * &b.1) - &(&b.0 * &a.1)).exact_sign().is_lt()
            };
            match bottom.exact_sign() {
                core::cmp::Ordering::Equal => beside |= top.exact_sign().is_le(),
                core::cmp::Ordering::Greater => {
                    let at = (top, bottom);
                    if last.as_ref().is_none_or(|known| less(&at, known)) {
                        last = Some(at);
                    }
                }
                core::cmp::Ordering::Less => {
                    let at = (&Dyadic::from(0.0) - &top, &Dyadic::from(0.0) - &bottom);
                    if first.as_ref().is_none_or(|known| less(known, &at)) {
                        first = Some(at);
                    }
                }
            }
        }
        let roots = all(&pyramid, &ray);
        let (Some(first), Some(last)) = (first, last) else { continue };
        let within = |t: &(Dyadic, Dyadic), root: &Root| {
            let above = (&t.0 - &(&Dyadic::from(root.lo) * &t.1)).exact_sign().is_ge();
            let below = (&t.0 - &(&Dyadic::from(root.hi) * &t.1)).exact_sign().is_le();
            above && below
        };
        let order = (&(&first.0 * &last.1) - &(&last.0 * &first.1)).exact_sign();
        if order.is_lt() && !beside {
            let [a, b] = roots.as_slice() else { panic!("{ray:?}: {roots:?}") };
            assert!(
                within(&first, a) && within(&last, b) && (a.sign, b.sign) == (-1, 1),
                "{ray:?}: {roots:?}"
            );
            met += 1;
        } else {
            assert!(roots.iter().all(|r| r.sign == 0), "{ray:?}: {roots:?}");
        }
    }
    assert!(met > 2000, "{met}");
}

/// Each root of one has a root of the other in an overlapping bracket; if one is uncertain, only
/// the sums of signs count.
fn same(a: &[Root], b: &[Root]) -> bool {
    let sure = |roots: &[Root]| roots.iter().all(|r| r.kind == RootKind::Simple);
    if sure(a) && sure(b) {
        let overlap = |(a, b): (&Root, &Root)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign;
        return a.len() == b.len() && a.iter().zip(b).all(overlap);
    }
    let net = |roots: &[Root]| roots.iter().map(|r| i32::from(r.sign)).sum::<i32>();
    net(a) == net(b)
}

#[test]
fn a_twist_by_nothing_and_a_twist_undone_change_nothing() {
    let mut dice = TestRng::new(13);
    let twist = |degrees: f64| Warp::Twist { axis: Vec3::Y, degrees, from: -0.5, to: 0.75 };
    let bend = |degrees: f64| Warp::Bend { axis: Vec3::Z, toward: Vec3::X, degrees, from: -1.0, to: 1.0 };
    for solid in [Solid::Block, Solid::Ball, Solid::Ring, Solid::Shell] {
        let own = surface(&solid.level_set());
        for rope in [vec![twist(0.0)], vec![bend(0.0)], vec![twist(150.0), twist(-150.0)]] {
            let rope = surface(&deformed(&solid.level_set(), &rope));
            let mut met = 0;
            for _ in 0..400 {
                let ray = ray_at(&mut dice, &Surface::bounds(&own));
                let (a, b) = (all(&own, &ray), all(&rope, &ray));
                assert!(same(&a, &b), "{solid:?} {ray:?}\n {a:?}\n {b:?}");
                met += a.len();
            }
            assert!(met > 200, "{met}");
        }
    }
}

#[test]
fn a_twist_of_what_is_round_and_a_taper_by_one_change_nothing() {
    let mut dice = TestRng::new(17);
    let ring = Torus::new(Point3::ORIGIN, Axis::Y, 0.5, 0.2).unwrap();
    for warp in [
        Warp::Twist { axis: Vec3::Y, degrees: 1000.0, from: -0.1, to: 0.15 },
        Warp::Taper { axis: Vec3::new(1.0, 2.0, 2.0), factor: 1.0, from: 0.0, to: 1.0 },
    ] {
        let same_ring = surface(&deformed(&Solid::Ring.level_set(), &[warp]));
        let mut met = 0;
        for _ in 0..2000 {
            let ray = ray_at(&mut dice, &ring.bounds());
            let (a, b) = (all(&ring, &ray), all(&same_ring, &ray));
            assert!(same(&a, &b), "{ray:?}\n {a:?}\n {b:?}");
            met += a.len();
        }
        assert!(met > 2000, "{met}");
    }
}

#[test]
fn a_deformed_union_is_the_union_of_the_deformed() {
    let mut dice = TestRng::new(19);
    for rope in ropes() {
        let parts = [Solid::Block, Solid::Ring].map(Solid::level_set);
        let whole = surface(&deformed(&LevelSet::union(&parts).unwrap(), &rope));
        let parts = parts.map(|part| surface(&deformed(&part, &rope)));
        let mut met = 0;
        for _ in 0..200 {
            let ray = ray_at(&mut dice, &Surface::bounds(&whole));
            let mut events: Vec<Root> = parts.iter().flat_map(|part| all(part, &ray)).collect();
            events.sort_by(|a, b| a.t.total_cmp(&b.t));
            // If brackets of both overlap, the order is unknown.
            if events.windows(2).any(|w| w[1].lo <= w[0].hi) {
                continue;
            }
            let mut depth = 0;
            let mut expected = Vec::new();
            for root in events {
                let before = depth;
                depth -= i32::from(root.sign);
                if (before == 0) != (depth == 0) {
                    expected.push(root);
                }
            }
            let roots = all(&whole, &ray);
            assert!(same(&roots, &expected), "{ray:?}\n {roots:?}\n {expected:?}");
            met += roots.len();
        }
        assert!(met > 100, "{met}");
    }
}

#[test]
fn a_bent_cylinder_is_a_piece_of_a_torus() {
    // 180 degrees along 2: R = 2 / pi, which is no f64, so that roots agree to rounding times their
    // condition number.
    let pipe = {
        let (a, b) = (Point3::new(0.0, 0.0, 0.0), Point3::new(0.0, 0.0, 2.0));
        let bounds = Aabb::new(Point3::new(-0.25, -0.25, 0.0), Point3::new(0.25, 0.25, 2.0));
        LevelSet::new(primitives::frustum(a, 0.25, b, 0.25).unwrap(), bounds)
    };
    let arc = surface(&deformed(
        &pipe,
        &[Warp::Bend { axis: Vec3::Z, toward: Vec3::X, degrees: 180.0, from: 0.0, to: 2.0 }],
    ));
    let radius = 2.0 / core::f64::consts::PI;
    let ring = Torus::new(Point3::new(radius, 0.0, 0.0), Axis::Y, radius, 0.25).unwrap();
    let mut dice = TestRng::new(23);
    let mut met = 0;
    for _ in 0..5000 {
        let ray = ray_at(&mut dice, &Surface::bounds(&arc));
        let roots = all(&arc, &ray);
        for root in all(&ring, &ray) {
            let point = ring.resolve(&LocalRay::new(&ray), &root, Need::POINT);
            let slope = point.ng.to_vec().dot(ray.direction).abs();
            let z = point.p.z;
            if z.abs() < 1e-6 || slope < 0.05 * ray.direction.length() {
                continue;
            }
            let close = 1e-14 * (10.0 / ray.direction.length() + root.t.abs()) / 0.05;
            let found = roots.iter().any(|r| (r.t - root.t).abs() <= close && r.sign == root.sign);
            assert_eq!(found, z > 0.0, "{ray:?} {root:?}: {roots:?}");
            met += usize::from(found);
        }
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn rays_leave_deformed_solids() {
    let mut dice = TestRng::new(29);
    let (mut spawned, mut untold) = (0, 0);
    for rope in ropes() {
        for solid in [Solid::Ball, Solid::Shell] {
            let deformed = surface(&deformed(&solid.level_set(), &rope));
            for _ in 0..60 {
                let ray = ray_at(&mut dice, &Surface::bounds(&deformed));
                for root in all(&deformed, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
                    let point = deformed.resolve(&LocalRay::new(&ray), root, Need::ALL);
                    assert!(
                        (point.ng.to_vec().length() - 1.0).abs() < 1e-12 && point.off < 1e-9,
                        "{point:?}"
                    );
                    let along = point.ng.to_vec().dot(ray.direction);
                    assert!(along * f64::from(root.sign) >= 0.0, "{ray:?} {root:?} {point:?}");
                    for (side, way) in [(RaySide::Front, 1.0), (RaySide::Back, -1.0)] {
                        let out = point.spawn_from(side, point.ng.to_vec() * way);
                        let exact = rope
                            .iter()
                            .rev()
                            .fold(out.origin.to_array().map(BigFloat::of), |p, warp| was(warp, &p));
                        let inside = Real::is_negative(&solid.value(&exact));
                        assert_eq!(inside, side == RaySide::Back, "{ray:?} {out:?} {point:?} {rope:?}");
                        let told = deformed.side(&LocalPoint::new(out.origin));
                        let wrong = if inside { Side::Out } else { Side::In };
                        assert_ne!(told, wrong, "{ray:?} {out:?} {point:?} {rope:?}");
                        untold += usize::from(told == Side::On);
                        spawned += 1;
                    }
                }
            }
        }
    }
    println!("{spawned} rays, {untold} of them from where rounding leaves the side open");
    assert!(spawned > 1000 && untold * 20 < spawned, "{spawned}, {untold}");
}

#[test]
fn any_axis_will_do() {
    // About a slanted axis: the rotated twist about z.
    let turn = Affine::rotation(Vec3::new(1.0, -2.0, 0.5), 0.7).unwrap();
    let axis = turn.vector(Vec3::Z);
    let warp = |axis: Vec3| Warp::Twist { axis, degrees: 120.0, from: -1.0, to: 1.0 };
    let upright = deformed(&Solid::Block.level_set(), &[warp(Vec3::Z)]).placed(&turn).unwrap();
    let slanted = deformed(&Solid::Block.level_set().placed(&turn).unwrap(), &[warp(axis * 3.0)]);
    let (a, b) = (surface(&upright), surface(&slanted));
    let mut dice = TestRng::new(31);
    let mut met = 0;
    for _ in 0..500 {
        let ray = ray_at(&mut dice, &Surface::bounds(&a));
        let (x, y) = (all(&a, &ray), all(&b, &ray));
        let close =
            |(x, y): (&Root, &Root)| (x.t - y.t).abs() <= 1e-9 * (1.0 + x.t.abs()) && x.sign == y.sign;
        let grazes = |roots: &[Root]| roots.windows(2).any(|w| w[1].t - w[0].t < 1e-4);
        if grazes(&x) || grazes(&y) {
            continue;
        }
        assert!(x.len() == y.len() && x.iter().zip(&y).all(close), "{ray:?}\n {x:?}\n {y:?}");
        met += x.len();
    }
    assert!(met > 300, "{met}");
}

#[test]
fn what_is_not_one_to_one_is_refused() {
    let block = Solid::Block.level_set();
    let refused = |warp: Warp| block.deformed(&warp).unwrap_err();
    let bend =
        |degrees: f64, from: f64, to: f64| Warp::Bend { axis: Vec3::Z, toward: Vec3::X, degrees, from, to };
    // The centre at 0.2, the block up to 0.25.
    let near = (2.0_f64 / 0.2).to_degrees();
    assert!(matches!(refused(bend(near, -1.0, 1.0)), DeformError::Centre { .. }));
    // Thin enough to come round: the piece of 2.5 by 360 degrees has R = 0.398. By 320 degrees its
    // ends are certainly apart.
    assert!(matches!(refused(bend(360.0, -1.0, 1.5)), DeformError::Round { .. }));
    assert!(block.deformed(&bend(320.0, -1.0, 1.5)).is_ok());
    assert!(matches!(refused(bend(10.0, 1.0, 1.0)), DeformError::Stretch { warp: "bend", .. }));
    assert!(matches!(refused(bend(f64::NAN, 0.0, 1.0)), DeformError::Angle { .. }));
    for toward in [Vec3::Z, Vec3::ZERO, -Vec3::Z] {
        let warp = Warp::Bend { axis: Vec3::Z, toward, degrees: 10.0, from: 0.0, to: 1.0 };
        assert!(matches!(refused(warp), DeformError::Toward(_)));
    }
    for factor in [0.0, -1.0, f64::INFINITY] {
        let warp = Warp::Taper { axis: Vec3::Z, factor, from: 0.0, to: 1.0 };
        assert_eq!(refused(warp), DeformError::Factor(factor));
    }
    let warp = Warp::Twist { axis: Vec3::ZERO, degrees: 10.0, from: 0.0, to: 1.0 };
    assert!(matches!(refused(warp), DeformError::Axis { warp: "twist", .. }));
    let space = LevelSet::new(primitives::half_space(Vec3::X, 0.0).unwrap(), Aabb::UNBOUNDED);
    let twist = Warp::Twist { axis: Vec3::X, degrees: 10.0, from: 0.0, to: 1.0 };
    assert_eq!(space.deformed(&twist).unwrap_err(), DeformError::Unbounded);
}

fn formula_map(write: impl FnOnce(&mut Builder, [NodeId; 3]) -> [NodeId; 3], half: f64) -> Warp {
    let mut b = Builder::new();
    let p = [0, 1, 2].map(|i| b.input(i).unwrap());
    let roots = write(&mut b, p);
    inverse(roots, &b, half)
}

#[test]
fn formulas_without_an_inverse_are_refused() {
    let block = Solid::Block.level_set();
    let refused = |warp: &Warp| block.deformed(warp).unwrap_err();
    // x^2: folds.
    let folded = formula_map(|b, [x, y, z]| [b.push(Op::Sqr(x)).unwrap(), y, z], 1.0);
    assert!(matches!(refused(&folded), DeformError::Injective(d) if d.contains(0.0)));
    // Flattens.
    let flat = formula_map(|_, [x, y, _]| [x, y, y], 1.0);
    assert!(matches!(refused(&flat), DeformError::Injective(_)));
    // A turn about z by an angle that grows with x: its determinant at a point is never zero where
    // it turns little, but over a box its bounds contain zero.
    let turning = |rate: f64| {
        move |b: &mut Builder, [x, y, z]: [NodeId; 3]| {
            let rate = b.constant(rate).unwrap();
            let a = b.push(Op::Mul(rate, z)).unwrap();
            let s = b.push(Op::Function(durer_formula::Function::Sin, a)).unwrap();
            let c = b.push(Op::Function(durer_formula::Function::Cos, a)).unwrap();
            let mut mul = |p, q| b.push(Op::Mul(p, q)).unwrap();
            let (xc, ys, xs, yc) = (mul(x, c), mul(y, s), mul(x, s), mul(y, c));
            [b.push(Op::Sub(xc, ys)).unwrap(), b.push(Op::Add(xs, yc)).unwrap(), z]
        }
    };
    assert!(block.deformed(&formula_map(turning(0.2), 1.5)).is_ok());
    // It is one to one (as a twist is), but bounds of its slopes over the whole box do not prove
    // it.
    assert!(matches!(refused(&formula_map(turning(4.0), 1.5)), DeformError::Injective(_)));
    // Jumps, holes and infinite slopes.
    let jumps = formula_map(
        |b, [x, y, z]| [b.push(Op::Function(durer_formula::Function::Floor, x)).unwrap(), y, z],
        1.0,
    );
    assert!(matches!(refused(&jumps), DeformError::Rough(_)));
    let roots = formula_map(|b, [x, y, z]| [b.push(Op::Sqrt(x)).unwrap(), y, z], 1.0);
    assert!(matches!(refused(&roots), DeformError::Rough(_)));
    let wrong = Warp::Inverse {
        functions: Arc::new([0, 1, 2].map(|_| constant(2))),
        within: Aabb::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)),
    };
    assert_eq!(refused(&wrong), DeformError::Arguments(2));
}

fn constant(inputs: u32) -> Formula {
    let mut b = Builder::new();
    let one = b.constant(1.0).unwrap();
    b.finish(one, inputs)
}

#[test]
fn nothing_stays_nothing() {
    // Two balls that do not meet.
    let ball = |x: f64| {
        let it = Sphere::new(Point3::new(x, 0.0, 0.0), 0.5).unwrap();
        LevelSet::new(primitives::ball(it.centre(), it.radius()).unwrap(), Surface::bounds(&it))
    };
    let both = LevelSet::intersection(&[ball(0.0), ball(0.9)]).unwrap();
    let none = LevelSet::intersection(&[ball(0.0), ball(2.0)]).unwrap();
    let twist = Warp::Twist { axis: Vec3::Z, degrees: 90.0, from: -1.0, to: 1.0 };
    assert!(deformed(&both, core::slice::from_ref(&twist)).surface().unwrap().is_some());
    assert!(deformed(&none, &[twist]).surface().unwrap().is_none());
}

#[test]
fn coincident_faces_leave_no_skin() {
    let block = |low: [f64; 3], high: [f64; 3]| {
        let (a, b) = (Point3::from(low), Point3::from(high));
        LevelSet::new(primitives::cuboid(a, b).unwrap(), Aabb::new(a, b))
    };
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 50.0, from: 0.0, to: 1.0 };
    let whole = block([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
    // Two halves, and the whole without its upper half: coincident faces inside and on top.
    let (low, high) = (block([-0.5, 0.0, -0.5], [0.5, 0.5, 0.5]), block([-0.5, 0.5, -0.5], [0.5, 1.0, 0.5]));
    let both = LevelSet::union(&[low.clone(), high.clone()]).unwrap();
    let rest = LevelSet::intersection(&[whole.clone(), high.complement().unwrap()]).unwrap();
    let mut dice = TestRng::new(37);
    for (made, same_as) in [(both, whole), (rest, low)] {
        let [made, same_as] =
            [made, same_as].map(|solid| surface(&deformed(&solid, core::slice::from_ref(&twist))));
        let mut met = 0;
        for _ in 0..1000 {
            let ray = ray_at(&mut dice, &Surface::bounds(&same_as));
            let (a, b) = (all(&made, &ray), all(&same_as, &ray));
            let overlap = |(a, b): (&Root, &Root)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign;
            // Only some formulas report rays that touch edges.
            let b: Vec<Root> = b.into_iter().filter(|r| r.sign != 0).collect();
            assert!(a.len() == b.len() && a.iter().zip(&b).all(overlap), "{ray:?}\n {a:?}\n {b:?}");
            met += a.len();
        }
        assert!(met > 800, "{met}");
    }
}

#[test]
fn a_formulas_box_gives_an_end() {
    let ground = LevelSet::new(primitives::half_space(Vec3::Y, 0.0).unwrap(), Aabb::UNBOUNDED);
    let waves = surface(&ground.deformed(&wave()).unwrap());
    let down = Ray::new(Point3::new(0.25, 5.0, 0.5), -Vec3::Y);
    let roots = all(&waves, &down);
    let height = 0.125 * durer_math::elementary::sin(0.75);
    assert!(roots.len() == 2 && (roots[0].t - (5.0 - height)).abs() < 1e-14, "{roots:?}");
}

#[test]
fn a_ray_in_a_face_that_two_parts_share_is_inside() {
    let block = |low: [f64; 3], high: [f64; 3]| {
        let (a, b) = (Point3::from(low), Point3::from(high));
        LevelSet::new(primitives::cuboid(a, b).unwrap(), Aabb::new(a, b))
    };
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 50.0, from: 0.0, to: 1.0 };
    let low = block([-0.5, 0.0, -0.5], [0.5, 0.5, 0.5]);
    // The upper part covers all of it, a half, or two separate quarters; `through` has just this as
    // its section at 0.5.
    let upper: [&[LevelSet]; 3] = [
        &[block([-0.5, 0.5, -0.5], [0.5, 1.0, 0.5])],
        &[block([0.0, 0.5, -0.5], [0.5, 1.0, 0.5])],
        &[block([-0.5, 0.5, -0.5], [-0.25, 1.0, 0.5]), block([0.25, 0.5, -0.5], [0.5, 1.0, 0.5])],
    ];
    let through: [&[LevelSet]; 3] = [
        &[block([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5])],
        &[block([0.0, 0.0, -0.5], [0.5, 1.0, 0.5])],
        &[block([-0.5, 0.0, -0.5], [-0.25, 1.0, 0.5]), block([0.25, 0.0, -0.5], [0.5, 1.0, 0.5])],
    ];
    let mut dice = TestRng::new(41);
    for (upper, through) in upper.into_iter().zip(through) {
        let parts: Vec<LevelSet> = upper.iter().cloned().chain([low.clone()]).collect();
        let (made, section) = (LevelSet::union(&parts).unwrap(), LevelSet::union(through).unwrap());
        for warps in [&[][..], core::slice::from_ref(&twist)] {
            let [made, section] = [&made, &section].map(|solid| surface(&deformed(solid, warps)));
            let (mut met, mut missed) = (0, 0);
            for _ in 0..300 {
                let mut aside = |size: f64| size * (dice.signed() - 0.5);
                let (o, to) =
                    (Point3::new(aside(8.0), 0.5, aside(8.0)), Point3::new(aside(1.2), 0.5, aside(1.2)));
                let ray = Ray::new(o, to - o);
                let (a, b) = (all(&made, &ray), all(&section, &ray));
                let b: Vec<Root> = b.into_iter().filter(|r| r.sign != 0).collect();
                if b.windows(2).any(|w| w[1].t - w[0].t < 1e-6) {
                    continue;
                }
                let same = |(a, b): (&Root, &Root)| {
                    a.lo <= b.hi + 1e-11 && b.lo <= a.hi + 1e-11 && a.hi - a.lo < 1e-10 && a.sign == b.sign
                };
                assert!(a.len() == b.len() && a.iter().zip(&b).all(same), "{ray:?}\n {a:?}\n {b:?}");
                met += a.len();
                missed += usize::from(a.is_empty());
            }
            assert!(met > 150 && missed > 10, "{met}, {missed}");
        }
    }
    // A face that is shared with nothing, or with a part that is subtracted, is not inside.
    let none = LevelSet::intersection(&[low.clone(), low.complement().unwrap()]).unwrap();
    for solid in [LevelSet::union(&[low.clone(), low]).unwrap(), none] {
        let Some(made) = deformed(&solid, core::slice::from_ref(&twist)).surface().unwrap() else { continue };
        let ray = Ray::new(Point3::new(-3.0, 0.5, 0.125), Vec3::new(1.0, 0.0, 0.0625));
        assert!(all(&made, &ray).is_empty());
    }
}
