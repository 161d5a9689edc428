//! Superellipsoids against the same surfaces in other kernels, and against exact arithmetic.

#[path = "common/solid_laws.rs"]
mod laws;
#[path = "common/solids.rs"]
mod solids;

use durer_math::{Point3, Ray, Vec3};
use durer_surfaces::{SuperellipsoidError, superellipsoid};
use durer_testkit::TestRng;
use laws::{holds_together, polynomial, same};
use solids::{Draws, Met, all};

#[test]
fn with_exponents_that_make_polynomials_it_is_their_surface() {
    let unit = |order, terms: &[([u32; 3], f64)]| {
        let mut terms = terms.to_vec();
        terms.push(([0; 3], -1.0));
        polynomial(order, &terms)
    };
    let squares = [([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0)];
    let fourths = [([4, 0, 0], 1.0), ([0, 4, 0], 1.0), ([0, 0, 4], 1.0)];
    let eighths = [([8, 0, 0], 1.0), ([0, 8, 0], 1.0), ([0, 0, 8], 1.0)];
    let coin = [([4, 0, 0], 1.0), ([2, 2, 0], 2.0), ([0, 4, 0], 1.0), ([0, 0, 4], 1.0)];
    let cases = [
        (1.0, 1.0, unit(2, &squares)),
        (0.5, 0.5, unit(4, &fourths)),
        (0.25, 0.25, unit(8, &eighths)),
        (1.0, 0.5, unit(4, &coin)),
    ];
    let mut dice = TestRng::new(11);
    for (e, n, exact) in cases {
        let formula = superellipsoid(e, n).unwrap();
        let mut met = Met::default();
        for _ in 0..4_000 {
            let ray = dice.ray();
            let (a, b) = (all(&formula, &ray), all(&exact, &ray));
            assert!(same(&a, &b), "{e} {n} {ray:?}\n formula {a:?}\n polynomial {b:?}");
            met.add(&a);
        }
        println!(
            "e {e}, n {n}: {} simple, {} clusters, median {:.1} ulp",
            met.simple,
            met.clusters,
            met.median()
        );
        assert!(met.simple > 3_000 && met.clusters * 100 < met.simple, "{} {}", met.simple, met.clusters);
        assert!(met.median() < 1000.0);
    }
}

#[test]
fn an_octahedron_has_eight_faces() {
    // |x| + |y| + |z| = 1: along a ray the middle of eight slabs' ends.
    let formula = superellipsoid(2.0, 2.0).unwrap();
    let (mut dice, mut met) = (TestRng::new(12), Met::default());
    for _ in 0..4_000 {
        let ray = dice.ray();
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for face in 0..8 {
            let sign = |bit: u32| if face >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let n = Vec3::new(sign(0), sign(1), sign(2));
            let (a, b) = (n.dot(ray.direction), 1.0 - n.dot(ray.origin.to_vec()));
            match b / a {
                _ if a == 0.0 => {}
                t if a < 0.0 => from = from.max(t),
                t => to = to.min(t),
            }
        }
        let roots = all(&formula, &ray);
        let slack = to.abs() * 1e-12;
        if to - from > slack {
            let [a, b] = roots.as_slice() else { panic!("{ray:?}: {roots:?}, {from} {to}") };
            assert!((a.t - from).abs() <= slack && (b.t - to).abs() <= slack, "{ray:?}: {roots:?}");
            assert_eq!((a.sign, b.sign), (-1, 1));
        } else if from - to > slack {
            assert!(roots.is_empty(), "{ray:?}: {roots:?}");
        }
        met.add(&roots);
    }
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    assert!(met.simple > 3_000, "{} {}", met.simple, met.clusters);
}

#[test]
fn no_crossing_of_a_superellipsoid_is_lost() {
    let mut dice = TestRng::new(13);
    for (e, n) in
        [(0.3, 1.7), (1.7, 0.3), (3.0, 2.5), (2.5, 4.0), (0.1, 0.1), (0.2, 1.0), (1.0, 0.05), (8.0, 1.0)]
    {
        let surface = superellipsoid(e, n).unwrap();
        let value = |p: Point3| {
            let pow = durer_math::elementary::pow;
            let across = pow(p.x.abs(), 2.0 / e) + pow(p.y.abs(), 2.0 / e);
            pow(across, e / n) + pow(p.z.abs(), 2.0 / n) - 1.0
        };
        let mut met = Met::default();
        for _ in 0..400 {
            let ray = dice.ray();
            let roots = all(&surface, &ray);
            holds_together(&surface, &ray, &roots, value);
            met.add(&roots);
        }
        println!(
            "e {e}, n {n}: {} simple, {} clusters, median {:.1} ulp",
            met.simple,
            met.clusters,
            met.median()
        );
        assert!(met.simple + met.clusters > 40);
        assert!(met.median() < 1000.0);
    }
}

#[test]
fn exponents_out_of_range_are_named() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-10, 1e10] {
        assert!(matches!(superellipsoid(bad, 1.0), Err(SuperellipsoidError::Exponent(_))));
        assert!(matches!(superellipsoid(1.0, bad), Err(SuperellipsoidError::Exponent(_))));
    }
}

/// Beyond the part of a high-order tangent, or of a straight line in the surface, that rounding
/// leaves open, the sign is certain, and no cluster extends there.
#[test]
fn clusters_end_where_rounding_does() {
    let met = |(e, n): (f64, f64), o: [f64; 3], d: [f64; 3]| {
        all(&superellipsoid(e, n).unwrap(), &Ray::new(Vec3::from(o).to_point(), Vec3::from(d)))
    };
    // |y|^4 / 4 above the surface.
    let [touch] = met((0.5, 2.0), [-0.25, -0.25, 1.25], [0.75, 0.25, -0.75])[..] else { panic!() };
    assert!(touch.lo < 1.0 && 1.0 < touch.hi && touch.hi - touch.lo < 0.01, "{touch:?}");
    // From the tip of a cone to its rim, at t = 2; of a star's, at t = 1.134.
    let cone = met((1.0, 2.0), [-0.6, -0.8, 2.0], [0.6, 0.8, -1.0]);
    assert!(cone.iter().all(|r| r.lo > 0.9999 && r.hi < 2.0001), "{cone:?}");
    let direction = [0.118_146_029_604_788_11, -0.354_438_088_814_364_34, -0.881_853_970_395_211_9];
    let origin = [-0.708_876_177_628_728_7, 2.126_628_532_886_186, 6.291_123_822_371_271];
    let star = met((4.0, 2.0), origin, direction);
    assert!(star.iter().all(|r| r.lo > 5.9999 && r.hi < 6.0 + 1.0 / 0.8818), "{star:?}");
}
