//! Surfaces that are written as formulas (superellipsoids, blobs, Julia sets) against the same surfaces in other kernels, and against exact arithmetic.

mod common;

use common::Dice;
use durer_math::{Affine, Dyadic, Point3, Ray, Ring, Vec3};
use durer_surfaces::algebraic::{coefficient_count, place_of};
use durer_surfaces::{
    AlgebraicSurface, All, BlobComponent, BlobError, BlobShape, Isosurface, Julia, JuliaAlgebra, JuliaError,
    JuliaPower, Kind, LocalPoint, LocalRay, Need, Root, Side, Sphere, SuperellipsoidError, Surface, blob,
    julia, superellipsoid,
};

impl Dice {
    /// Through the cube around the origin, from near and far; often along an axis, in a plane between octants, or through the origin.
    fn ray(&mut self) -> Ray {
        let mut through = self.vector();
        let mut direction = self.vector();
        match self.below(6) {
            0 => through[self.below(3) as usize] = 0.0,
            1 => {
                let axis = self.below(3) as usize;
                (through[axis], direction[axis]) = (0.0, 0.0);
            }
            2 => direction[self.below(3) as usize] = 0.0,
            3 => through = Vec3::ZERO,
            _ => {}
        }
        let back = [4.0, 5.0, 1e2, 1e6][self.below(4) as usize] / direction.length();
        Ray::new(through.to_point() - direction * back, direction)
    }
}

fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

/// Counts of roots, to see that the tests meet something.
#[derive(Default)]
struct Met {
    simple: usize,
    clusters: usize,
    widths: Vec<f64>,
}

impl Met {
    fn add(&mut self, roots: &[Root]) {
        for root in roots {
            self.simple += usize::from(root.kind == Kind::Simple);
            self.clusters += usize::from(root.kind != Kind::Simple);
            self.widths.push((root.hi - root.lo) / (root.t.abs() * f64::EPSILON));
        }
    }

    fn median(&self) -> f64 {
        let mut widths = self.widths.clone();
        widths.sort_by(f64::total_cmp);
        widths[widths.len() / 2]
    }
}

/// Brackets overlap one by one where all roots are certain; else the signs add up to the same.
fn same(a: &[Root], b: &[Root]) -> bool {
    let sure = |roots: &[Root]| roots.iter().all(|r| r.kind == Kind::Simple);
    if sure(a) && sure(b) {
        return a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign);
    }
    let net = |roots: &[Root]| roots.iter().map(|r| i32::from(r.sign)).sum::<i32>();
    net(a) == net(b)
}

/// A polynomial by its terms.
fn polynomial(order: u32, terms: &[([u32; 3], f64)]) -> AlgebraicSurface {
    let mut list = vec![0.0; coefficient_count(order)];
    for &(powers, value) in terms {
        list[place_of(order, powers)] = value;
    }
    AlgebraicSurface::new(order, &list).unwrap()
}

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
    let mut dice = Dice(11);
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
    let (mut dice, mut met) = (Dice(12), Met::default());
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

/// Chords alternate, and samples of the rounded formula see no change of sign that has no root.
fn holds_together(surface: &Isosurface, ray: &Ray, roots: &[Root], value: impl Fn(Point3) -> f64) {
    let signs: Vec<_> = roots.iter().filter(|r| r.sign != 0).map(|r| r.sign).collect();
    assert!(
        signs.iter().enumerate().all(|(i, &s)| s == if i % 2 == 0 { -1 } else { 1 }),
        "{ray:?}: {roots:?}"
    );
    assert_eq!(signs.len() % 2, 0, "{ray:?}: {roots:?}");
    let middle = roots.iter().map(|r| r.t).sum::<f64>() / roots.len().max(1) as f64;
    let middle = if roots.is_empty() {
        -ray.origin.to_vec().dot(ray.direction) / ray.direction.dot(ray.direction)
    } else {
        middle
    };
    let reach = 3.0 / ray.direction.length();
    for i in 0..400 {
        let t = middle + reach * (f64::from(i) / 200.0 - 1.0);
        let p = ray.at(t);
        let v = value(p);
        // Rounding of the point and of the value.
        if t < 0.0 || v.abs() < 1e-6 || ray.origin.to_vec().length() > 1e3 {
            continue;
        }
        let crossed = roots.iter().filter(|r| r.t < t).map(|r| i32::from(r.sign)).sum::<i32>();
        let near = roots.iter().any(|r| (r.t - t).abs() * ray.direction.length() < 1e-9);
        assert!(near || (crossed < 0) == (v < 0.0), "{ray:?} at {t}: {v}, {roots:?}");
        let side = surface.side(&LocalPoint::new(p));
        assert_eq!(side, if v < 0.0 { Side::In } else { Side::Out }, "{p:?}");
    }
}

#[test]
fn no_crossing_of_a_superellipsoid_is_lost() {
    let mut dice = Dice(13);
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

fn ball(centre: Point3, radius: f64, strength: f64) -> BlobComponent {
    BlobComponent { shape: BlobShape::Ball(centre), radius, strength, place: Affine::IDENTITY }
}

#[test]
fn a_blob_of_one_ball_is_a_ball() {
    // (1 - d^2/4)^2 = 1/4 where d^2 = 2.
    let one = blob(0.25, &[ball(Point3::ORIGIN, 2.0, 1.0)]).unwrap();
    let exact = polynomial(2, &[([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0), ([0; 3], -2.0)]);
    let (mut dice, mut met) = (Dice(14), Met::default());
    for _ in 0..6_000 {
        let ray = dice.ray();
        let (a, b) = (all(&one, &ray), all(&exact, &ray));
        assert!(same(&a, &b), "{ray:?}\n blob {a:?}\n ball {b:?}");
        met.add(&a);
    }
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    assert!(met.simple > 6_000 && met.clusters * 1000 < met.simple && met.median() < 1000.0);
}

#[test]
fn a_blob_of_one_sausage_is_a_cylinder_with_round_ends() {
    let segment = BlobShape::Segment(Point3::new(-1.0, 0.5, 0.25), Point3::new(0.5, -0.25, 0.5));
    let one =
        blob(0.25, &[BlobComponent { shape: segment, radius: 1.0, strength: 1.0, place: Affine::IDENTITY }])
            .unwrap();
    let BlobShape::Segment(a, b) = segment else { unreachable!() };
    let (u, r) = (b - a, 0.5_f64.sqrt());
    let ends = [Sphere::new(a, r).unwrap(), Sphere::new(b, r).unwrap()];
    let (mut dice, mut met) = (Dice(15), Met::default());
    for _ in 0..3_000 {
        let ray = dice.ray();
        let roots = all(&one, &ray);
        for root in &roots {
            let p = ray.at(root.t);
            let h = ((p - a).dot(u) / u.dot(u)).clamp(0.0, 1.0);
            let off = (p - a - u * h).length() - r;
            assert!(
                off.abs() < 1e-9 * root.t.abs().max(1.0) * ray.direction.length(),
                "{ray:?}: {root:?}, {off}"
            );
        }
        // What meets an end's ball meets the sausage.
        if ends
            .iter()
            .any(|end| all(end, &ray).iter().all(|r| r.kind == Kind::Simple) && all(end, &ray).len() == 2)
        {
            assert_eq!(roots.len(), 2, "{ray:?}");
        }
        met.add(&roots);
    }
    assert!(met.simple > 1_000 && met.clusters * 100 < met.simple, "{} {}", met.simple, met.clusters);
}

/// The sign of `sum of S (1 - d^2/R^2)^2 - T` at `o + t d`, all in exact numbers; radii are powers of two.
fn exact_sign(parts: &[BlobComponent], threshold: f64, ray: &Ray, t: f64) -> std::cmp::Ordering {
    let x = |x: f64| Dyadic::new(x).unwrap();
    let p: [Dyadic; 3] = core::array::from_fn(|i| x(ray.origin[i]) + x(t) * x(ray.direction[i]));
    let mut sum = -x(threshold);
    for part in parts {
        let BlobShape::Ball(c) = part.shape else { panic!("balls only") };
        let mut left = x(1.0);
        for i in 0..3 {
            let w = p[i].clone() - x(c[i]);
            left = left - w.clone() * w * x(1.0 / (part.radius * part.radius));
        }
        if left.exact_sign().is_gt() {
            sum = sum + x(part.strength) * left.clone() * left;
        }
    }
    sum.exact_sign()
}

#[test]
fn brackets_of_blobs_have_the_signs_of_exact_arithmetic_at_their_ends() {
    let mut dice = Dice(16);
    let mut met = Met::default();
    for _ in 0..12 {
        let parts: Vec<_> = (0..2 + dice.below(8))
            .map(|i| {
                let strength =
                    if i > 0 && dice.below(3) == 0 { -1.0 } else { 1.0 } * (1.0 + dice.unit().abs());
                ball((dice.vector() * 0.75).to_point(), [0.25, 0.5, 1.0][dice.below(3) as usize], strength)
            })
            .collect();
        let surface = blob(0.375, &parts).unwrap();
        let value = |p: Point3| {
            0.375
                - parts
                    .iter()
                    .map(|part| {
                        let BlobShape::Ball(c) = part.shape else { unreachable!() };
                        let w = p - c;
                        let left = (1.0 - w.dot(w) / (part.radius * part.radius)).max(0.0);
                        part.strength * left * left
                    })
                    .sum::<f64>()
        };
        for _ in 0..400 {
            let ray = dice.ray();
            let roots = all(&surface, &ray);
            holds_together(&surface, &ray, &roots, value);
            for root in roots.iter().filter(|r| r.kind == Kind::Simple) {
                let (lo, hi) =
                    (exact_sign(&parts, 0.375, &ray, root.lo), exact_sign(&parts, 0.375, &ray, root.hi));
                // Inside there is more than the threshold.
                let inside = if root.sign < 0 { hi } else { lo };
                let outside = if root.sign < 0 { lo } else { hi };
                assert!(inside.is_ge() && outside.is_le(), "{ray:?}: {root:?} {lo:?} {hi:?}");
            }
            met.add(&roots);
        }
    }
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    assert!(met.simple > 2_000 && met.clusters * 1000 < met.simple && met.median() < 1000.0);
}

#[test]
fn a_component_is_placed_like_an_object() {
    let rows = [[1.5, 0.25, 0.0], [-0.25, 0.5, 0.125], [0.0, 0.5, 1.0]];
    let place = Affine::new(rows, Point3::new(0.25, -0.5, 0.125)).unwrap();
    let part = BlobComponent { place, ..ball(Point3::ORIGIN, 1.0, 1.0) };
    let moved = blob(0.25, &[part]).unwrap();
    let exact = durer_surfaces::Placed::new(Sphere::new(Point3::ORIGIN, 0.5_f64.sqrt()).unwrap(), place);
    let (mut dice, mut met) = (Dice(17), 0);
    for _ in 0..3_000 {
        let ray = dice.ray();
        let (a, b) = (all(&moved, &ray), all(&exact, &ray));
        // The radius of the sphere is rounded, that of the blob is not.
        if a.iter().chain(&b).all(|r| r.kind == Kind::Simple) && a.len() == b.len() {
            for (a, b) in a.iter().zip(&b) {
                let slack = 1e-7 * (a.hi - a.lo + b.hi - b.lo).max(1e-8);
                assert!(
                    a.lo - slack <= b.hi + 1e-9 * b.t.abs()
                        && b.lo <= a.hi + 1e-9 * b.t.abs()
                        && a.sign == b.sign
                );
                met += 1;
            }
        } else {
            let chord = b.iter().map(|r| r.t * f64::from(r.sign)).sum::<f64>();
            assert!(
                chord.abs() < 1e-4 * ray.direction.length().recip() + 1e-9 * b[0].t,
                "{ray:?}: {a:?} {b:?}"
            );
        }
    }
    assert!(met > 1_000, "{met}");
}

#[test]
fn only_what_reaches_a_cell_stays_on_its_tape() {
    let parts: Vec<_> = (0..64)
        .map(|i| ball(Point3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)), 0.75, 1.0))
        .collect();
    let (open, steps, whole) = blob(0.3, &parts).unwrap().cells();
    println!("{open} cells, {steps:.1} of {whole} steps");
    assert!(open > 100 && steps * 10.0 < whole as f64, "{open} cells, {steps} of {whole} steps");
}

#[test]
fn normals_point_out_of_blobs() {
    let surface =
        blob(0.5, &[ball(Point3::ORIGIN, 1.0, 1.0), ball(Point3::new(0.8, 0.0, 0.0), 1.0, 1.0)]).unwrap();
    let mut dice = Dice(18);
    for _ in 0..500 {
        let ray = dice.ray();
        for root in all(&surface, &ray).iter().filter(|r| r.kind == Kind::Simple) {
            let point = surface.resolve(&LocalRay::new(&ray), root, Need::ALL);
            let along = point.ng.to_vec().dot(ray.direction) / ray.direction.length();
            assert!(along * f64::from(root.sign) > -1e-6, "{ray:?} {point:?}");
        }
    }
}

#[test]
fn what_makes_no_blob_is_named() {
    let one = [ball(Point3::ORIGIN, 1.0, 1.0)];
    assert!(matches!(blob(0.0, &one), Err(BlobError::Threshold(_))));
    assert!(matches!(blob(f64::NAN, &one), Err(BlobError::Threshold(_))));
    assert!(matches!(blob(0.5, &[]), Err(BlobError::Nothing)));
    assert!(matches!(blob(0.5, &[ball(Point3::ORIGIN, 1.0, -1.0)]), Err(BlobError::Nothing)));
    assert!(matches!(blob(0.5, &[ball(Point3::ORIGIN, 0.0, 1.0)]), Err(BlobError::Component(_))));
    assert!(matches!(blob(0.5, &[ball(Point3::ORIGIN, 1.0, f64::NAN)]), Err(BlobError::Strength(_))));
    // Strength below the threshold: it is there, and empty.
    assert!(all(&blob(2.0, &one).unwrap(), &Ray::new(Point3::new(0.0, 0.0, -3.0), Vec3::Z)).is_empty());
}

fn julia_of(c: [f64; 4], algebra: JuliaAlgebra, power: JuliaPower, iterations: u32) -> Julia {
    Julia { c, algebra, power, iterations, normal: [0.0, 0.0, 0.0, 1.0], distance: 0.0 }
}

#[test]
fn a_julia_set_of_zero_is_a_ball() {
    // |z|^(2^N) = 2: the radius is the root of 2 that N square roots give.
    for (iterations, power, radius) in [
        (0, JuliaPower::Square, 2.0_f64),
        (1, JuliaPower::Square, 2.0_f64.sqrt()),
        (3, JuliaPower::Square, 2.0_f64.sqrt().sqrt().sqrt()),
        (2, JuliaPower::Cube, durer_math::elementary::pow(2.0, 1.0 / 9.0)),
    ] {
        let set = julia(&julia_of([0.0; 4], JuliaAlgebra::Quaternion, power, iterations)).unwrap();
        let (mut dice, mut met) = (Dice(20), Met::default());
        for _ in 0..1_000 {
            let ray = dice.ray();
            let roots = all(&set, &ray);
            for root in &roots {
                // Distance from the origin at both ends of the bracket, in ray parameters times their speed.
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

/// The product of two quaternions or hypercomplex numbers, from the table of units.
fn times<T: Ring>(algebra: JuliaAlgebra, z: &[T; 4], y: &[T; 4]) -> [T; 4] {
    let quaternion = algebra == JuliaAlgebra::Quaternion;
    let mut out: [T; 4] = core::array::from_fn(|_| T::exact(0.0));
    for (i, z) in z.iter().enumerate() {
        for (j, y) in y.iter().enumerate() {
            // 1 times anything, i i = j j = -1, and then as the algebra has it.
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
        let square = z.iter().fold(x(-4.0), |sum, a| sum + a.clone() * a.clone());
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
    let mut dice = Dice(21);
    let cases = [
        (JuliaAlgebra::Quaternion, JuliaPower::Square, [-0.083, 0.0, -0.83, -0.025], 5),
        (JuliaAlgebra::Quaternion, JuliaPower::Square, [-1.5, 0.25, 0.0, 0.0], 4),
        (JuliaAlgebra::Quaternion, JuliaPower::Cube, [-0.25, 0.5, 0.125, 0.5], 3),
        (JuliaAlgebra::Hypercomplex, JuliaPower::Square, [-0.5, 0.25, 0.5, -0.125], 4),
        (JuliaAlgebra::Hypercomplex, JuliaPower::Cube, [0.25, 0.5, -0.25, 0.0], 3),
    ];
    for (algebra, power, c, iterations) in cases {
        let data = Julia { distance: 0.125, ..julia_of(c, algebra, power, iterations) };
        let surface = julia(&data).unwrap();
        let mut met = Met::default();
        for _ in 0..60 {
            let through = (dice.vector() * 0.7).to_point();
            let direction = dice.vector();
            let ray = Ray::new(through - direction * (4.0 / direction.length()), direction);
            let roots = all(&surface, &ray);
            let signs: Vec<_> = roots.iter().filter(|r| r.sign != 0).map(|r| r.sign).collect();
            assert!(
                signs.iter().enumerate().all(|(i, &s)| s == if i % 2 == 0 { -1 } else { 1 }),
                "{ray:?}: {roots:?}"
            );
            for root in roots.iter().filter(|r| r.kind == Kind::Simple) {
                let (lo, hi) = (exactly_in(&data, &ray, root.lo), exactly_in(&data, &ray, root.hi));
                assert_eq!((lo, hi), (root.sign > 0, root.sign < 0), "{data:?} {ray:?} {root:?}");
            }
            // Between roots all is in or out.
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
        assert!(met.simple > 40 && met.clusters * 100 <= met.simple, "{} {}", met.simple, met.clusters);
    }
}

#[test]
fn what_makes_no_julia_set_is_named() {
    let good = julia_of([0.0; 4], JuliaAlgebra::Quaternion, JuliaPower::Square, 3);
    assert!(matches!(julia(&Julia { normal: [1.0, 0.0, 0.0, 0.0], ..good }), Err(JuliaError::Slice)));
    assert!(matches!(julia(&Julia { c: [f64::NAN; 4], ..good }), Err(JuliaError::Number(_))));
    assert!(matches!(julia(&Julia { iterations: 1001, ..good }), Err(JuliaError::Iterations(1001))));
}
