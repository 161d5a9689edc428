//! Julia sets against balls, and against exact arithmetic.

#[path = "common/solids.rs"]
mod solids;

use durer_math::{Affine, Dyadic, Point3, Ray, Ring, U, Vec3};
use durer_surfaces::{
    Julia, JuliaAlgebra, JuliaError, JuliaPower, JuliaSet, LocalPoint, LocalRay, Need, Placed, Root,
    RootKind, Side, Surface, superellipsoid,
};
use durer_testkit::TestRng;
use durer_testkit::{case_seed, drawn, report};
use solids::{Draws, Met, all};

fn julia_of(c: [f64; 4], algebra: JuliaAlgebra, power: JuliaPower, iterations: u32) -> Julia {
    Julia { c, algebra, power, iterations, radius: 2.0, normal: [0.0, 0.0, 0.0, 1.0], distance: 0.0 }
}

#[test]
fn a_julia_set_of_zero_is_a_ball() {
    // |z|^(2^N) = 2: the radius is the N-fold square root of 2.
    for (iterations, power, radius) in [
        (0, JuliaPower::Square, 2.0_f64),
        (1, JuliaPower::Square, 2.0_f64.sqrt()),
        (3, JuliaPower::Square, 2.0_f64.sqrt().sqrt().sqrt()),
        (2, JuliaPower::Cube, durer_math::elementary::pow(2.0, 1.0 / 9.0)),
    ] {
        let set = JuliaSet::new(&julia_of([0.0; 4], JuliaAlgebra::Quaternion, power, iterations)).unwrap();
        let (mut dice, mut met) = (TestRng::new(20), Met::default());
        for _ in 0..1_000 {
            let ray = dice.ray();
            let roots = all(&set, &ray);
            for root in &roots {
                // Distance from the origin at both ends of the bracket, in ray parameters times
                // their speed.
                let speed = ray.direction.length();
                let off = |t: f64| (ray.at(t).to_vec().length() - radius).abs();
                let slack = 1e-13 * (1.0 + root.t * speed) + (root.hi - root.lo) * speed;
                assert!(off(root.lo) <= slack && off(root.hi) <= slack, "{ray:?} {root:?}");
            }
            let o = ray.origin.to_vec();
            let apart = o.cross(ray.direction).length() / ray.direction.length();
            if (apart - radius).abs() > 1e-6 * o.length() {
                assert_eq!(roots.len(), if apart < radius { 2 } else { 0 }, "{ray:?}");
            }
            met.add(&roots);
        }
        assert!(met.simple > 500 && met.clusters * 100 < met.simple, "{} {}", met.simple, met.clusters);
    }
}

/// A touch within rounding is no longer than rounding requires: about `√2⁻⁵⁰` of the set.
#[test]
fn a_touch_is_as_short_as_rounding_allows() {
    let set = JuliaSet::new(&julia_of([0.0; 4], JuliaAlgebra::Quaternion, JuliaPower::Square, 0)).unwrap();
    let turn = [[-4.0, 4.0, -7.0], [8.0, 1.0, -4.0], [1.0, 8.0, 4.0]];
    let place = Affine::new(turn, Point3::new(0.0, -7.0, 1000.0)).unwrap();
    let placed = Placed::new(set, place);
    let (mut dice, mut touches) = (TestRng::new(24), 0);
    for _ in 0..300 {
        let d = dice.vector();
        let across = d.cross(dice.vector());
        let at = across * (2.0 / across.length());
        let ray = Ray::new(place.point((at - d * (0.5 / d.length())).to_point()), place.vector(d));
        for root in all(&placed, &ray) {
            let length = (root.hi - root.lo) * d.length();
            assert!(length < 1e-5, "{ray:?}: {root:?}");
            touches += usize::from(root.kind != RootKind::Simple);
        }
    }
    assert!(touches > 100, "{touches}");
}

/// Brackets are those of the exact placement, however much its inverse magnifies rounding errors.
#[test]
fn a_shear_widens_no_bracket() {
    let shear = [[1.0, 500.0, 0.0], [0.0, 1.0, 500.0], [0.0, 0.0, 1.0]];
    let place = Affine::new(shear, Point3::new(0.125, 125.0, 1000.0)).unwrap();
    let julia = julia_of([-1.125, 0.0, 0.0, 0.125], JuliaAlgebra::Quaternion, JuliaPower::Square, 1);
    let julia = Placed::new(JuliaSet::new(&julia).unwrap(), place);
    let convex = Placed::new(superellipsoid(0.5, 1.0).unwrap(), place);
    let dented = Placed::new(superellipsoid(1.0, 4.0).unwrap(), place);
    let mut dice = TestRng::new(5);
    let (mut widths, mut points, mut worst) = ([const { Vec::new() }; 3], 0, 0.0_f64);
    for _ in 0..200 {
        let (from, to) = (dice.vector() * 4.0, dice.vector() * 0.5);
        let p = |v: Vec3| place.point(v.to_point());
        let ray = Ray::new(p(from), p(to) - p(from));
        for (i, roots) in [all(&julia, &ray), all(&convex, &ray), all(&dented, &ray)].iter().enumerate() {
            widths[i].extend(roots.iter().map(|r| (r.hi - r.lo) / (r.t * f64::EPSILON)));
        }
        for root in all(&convex, &ray) {
            let point = convex.resolve(&LocalRay::new(&ray), &root, Need::ALL);
            // A start is clear of the surface by the rounding of its coordinates, also through the
            // inverse: that moves it by up to |L⁻¹| times as much in the frame, where the height
            // over the tangent plane is |L⁻ᵀ n| times that in the world. 128 covers 16 roundings per
            // axis, the sum of three axes, and four times the height where the surface bends.
            let n = point.ng.to_vec();
            let l = place.linear();
            let lt_n = [0, 1, 2].map(|k| l[0][k] * n.x + l[1][k] * n.y + l[2][k] * n.z);
            let through = place.inverse_norm() * Vec3::new(lt_n[0], lt_n[1], lt_n[2]).length();
            let most = 128.0 * U * point.p.to_vec().length() * (1.0 + through);
            worst = worst.max(point.off / most);
            assert!(point.off <= most, "{ray:?}: {point:?} > {most}");
            points += 1;
        }
    }
    let medians = widths.map(|mut widths| {
        widths.sort_by(f64::total_cmp);
        widths[widths.len() / 2]
    });
    println!("medians {medians:?} ulp, {points} points, starts {worst} of their limit");
    assert!(points > 100 && medians.iter().all(|&median| median < 1000.0), "{medians:?}");
}

/// The product of two quaternions or hypercomplex numbers, from the table of units.
fn times<T: Ring>(algebra: JuliaAlgebra, z: &[T; 4], y: &[T; 4]) -> [T; 4] {
    let quaternion = algebra == JuliaAlgebra::Quaternion;
    let mut out: [T; 4] = core::array::from_fn(|_| T::exact(0.0));
    for (i, z) in z.iter().enumerate() {
        for (j, y) in y.iter().enumerate() {
            // 1 times anything, i i = j j = -1, and the rest by the algebra's rules.
            let minus = match (i, j) {
                (0, _) | (_, 0) => false,
                (1, 1) | (2, 2) => true,
                (3, 3) => quaternion,
                (1, 2) => false,
                (2, 3) | (3, 1) if quaternion => false,
                _ => !matches!((i, j), (2, 1)) || quaternion,
            };
            let term = z.clone() * y.clone();
            let k = i ^ j;
            out[k] = if minus { out[k].clone() - term } else { out[k].clone() + term };
        }
    }
    out
}

/// Whether the point at `t` belongs to the set, in exact numbers.
fn exactly_in(set: &Julia, ray: &Ray, t: f64) -> bool {
    let x = |x: f64| Dyadic::new(x).unwrap();
    let mut z: [Dyadic; 4] = core::array::from_fn(|i| {
        if i < 3 { x(ray.origin[i]) + x(t) * x(ray.direction[i]) } else { x(set.distance) }
    });
    for n in 0..=set.iterations {
        let square = z.iter().fold(-(x(set.radius) * x(set.radius)), |sum, a| sum + a.clone() * a.clone());
        if square.exact_sign().is_gt() {
            return false;
        }
        if n < set.iterations {
            let mut power = times(set.algebra, &z, &z);
            if set.power == JuliaPower::Cube {
                power = times(set.algebra, &z, &power);
            }
            z = core::array::from_fn(|i| power[i].clone() + x(set.c[i]));
        }
    }
    true
}

#[test]
fn brackets_of_julia_sets_have_the_signs_of_exact_arithmetic_at_their_ends() {
    let mut rays = 0;
    let cases = [
        (JuliaAlgebra::Quaternion, JuliaPower::Square, [-0.083, 0.0, -0.83, -0.025], 5),
        (JuliaAlgebra::Quaternion, JuliaPower::Square, [-1.5, 0.25, 0.0, 0.0], 4),
        (JuliaAlgebra::Quaternion, JuliaPower::Cube, [-0.25, 0.5, 0.125, 0.5], 3),
        (JuliaAlgebra::Hypercomplex, JuliaPower::Square, [-0.5, 0.25, 0.5, -0.125], 4),
        (JuliaAlgebra::Hypercomplex, JuliaPower::Cube, [0.25, 0.5, -0.25, 0.0], 3),
    ];
    // Radii from which orbits never return, and others.
    let radii = [2.0, 1.875, 1.25, 4.0, 0.875];
    for (i, (algebra, power, c, iterations)) in cases.into_iter().cycle().take(2 * cases.len()).enumerate() {
        let radius = if i < cases.len() { 2.0 } else { radii[i % radii.len()] };
        let data = Julia { distance: 0.125, radius, ..julia_of(c, algebra, power, iterations) };
        let surface = JuliaSet::new(&data).unwrap();
        let mut met = Met::default();
        for case in drawn(60) {
            let mut dice = TestRng::new(case_seed(21 + i as u64, case));
            rays += 1;
            let through = (dice.vector() * 0.7).to_point();
            let direction = dice.vector();
            let ray = Ray::new(through - direction * (4.0 / direction.length()), direction);
            let roots = all(&surface, &ray);
            let signs: Vec<_> = roots.iter().filter(|r| r.sign != 0).map(|r| r.sign).collect();
            assert!(
                signs.iter().enumerate().all(|(i, &s)| s == if i % 2 == 0 { -1 } else { 1 }),
                "{ray:?}: {roots:?}"
            );
            for root in roots.iter().filter(|r| r.kind == RootKind::Simple) {
                let (lo, hi) = (exactly_in(&data, &ray, root.lo), exactly_in(&data, &ray, root.hi));
                assert_eq!((lo, hi), (root.sign > 0, root.sign < 0), "{data:?} {ray:?} {root:?}");
            }
            // Between roots every point is on the same side.
            for i in 0..200 {
                let t = (2.0 + f64::from(i) / 50.0) / ray.direction.length();
                if roots.iter().all(|r| t < r.lo || t > r.hi) {
                    let crossed: i32 = roots.iter().filter(|r| r.hi < t).map(|r| i32::from(r.sign)).sum();
                    assert_eq!(crossed < 0, exactly_in(&data, &ray, t), "{data:?} {ray:?} at {t}: {roots:?}");
                }
            }
            met.add(&roots);
        }
        println!(
            "{algebra:?} {power:?}: {} simple, {} clusters, median {:.1} ulp",
            met.simple,
            met.clusters,
            met.median()
        );
        assert!(met.simple > 20 && met.clusters * 100 <= met.simple, "{} {}", met.simple, met.clusters);
    }
    report(rays);
}

#[test]
fn what_makes_no_julia_set_is_named() {
    let good = julia_of([0.0; 4], JuliaAlgebra::Quaternion, JuliaPower::Square, 3);
    assert!(matches!(JuliaSet::new(&Julia { normal: [1.0, 0.0, 0.0, 0.0], ..good }), Err(JuliaError::Slice)));
    assert!(matches!(JuliaSet::new(&Julia { c: [f64::NAN; 4], ..good }), Err(JuliaError::Number(_))));
    assert!(matches!(JuliaSet::new(&Julia { iterations: 1001, ..good }), Err(JuliaError::Iterations(1001))));
}

#[test]
fn normals_and_starts_are_on_their_sides() {
    let mut dice = TestRng::new(23);
    for (algebra, power, c, iterations) in [
        (JuliaAlgebra::Quaternion, JuliaPower::Square, [-0.083, 0.0, -0.83, -0.025], 8),
        (JuliaAlgebra::Quaternion, JuliaPower::Cube, [-0.25, 0.5, 0.125, 0.5], 3),
        (JuliaAlgebra::Hypercomplex, JuliaPower::Square, [-0.5, 0.25, 0.5, -0.125], 4),
    ] {
        let set = julia_of(c, algebra, power, iterations);
        let surface = JuliaSet::new(&set).unwrap();
        let (mut left, mut blocked) = (0, 0);
        for _ in 0..400 {
            let (to, d) = ((dice.vector() * 0.5).to_point(), dice.vector());
            let ray = Ray::new(to - d * ([3.0, 1e4][dice.below(2) as usize] / d.length()), d);
            for root in all(&surface, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
                let point = surface.resolve(&LocalRay::new(&ray), root, Need::POINT);
                let along = point.ng.to_vec().dot(d) / d.length();
                assert!(along * f64::from(root.sign) > -1e-4, "{ray:?} {point:?}");
                for side in [durer_math::RaySide::Front, durer_math::RaySide::Back] {
                    let start = point.spawn_from(side, d).origin;
                    let expected = if side == durer_math::RaySide::Front { Side::Out } else { Side::In };
                    assert_eq!(surface.side(&LocalPoint::new(start)), expected, "{ray:?} {point:?}");
                    assert_eq!(exactly_in(&set, &Ray::new(start, d), 0.0), expected == Side::In, "{point:?}");
                }
                // A ray straight away from the surface does not hit it again at once.
                let away = point.spawn(point.ng.to_vec());
                let local = LocalRay::new(&away).from_side(Some(durer_math::RaySide::Front));
                let mut again = durer_surfaces::All::default();
                surface.roots(&local, &mut again);
                let first: Option<&Root> = again.roots.first();
                blocked += usize::from(first.is_some_and(|r| r.kind != RootKind::Simple || r.sign > 0));
                left += 1;
            }
        }
        assert!(left > 200 && blocked == 0, "{left} {blocked}");
    }
}
