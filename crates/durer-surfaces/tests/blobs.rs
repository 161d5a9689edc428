//! Blobs against spheres, against the same sum as a formula on the interval tape, and against exact
//! arithmetic.

#[path = "common/blob_formula.rs"]
mod formula;
#[path = "common/solid_laws.rs"]
mod laws;
#[path = "common/solids.rs"]
mod solids;

use durer_math::{Affine, Dyadic, Point3, Ray, Vec3};
use durer_surfaces::{
    All, Blob, BlobComponent, BlobError, BlobShape, LocalRay, Need, Placed, Root, RootKind, Sphere, Surface,
};
use durer_testkit::TestRng;
use durer_testkit::{case_seed, drawn, report};
use laws::{holds_together, polynomial, same};
use solids::{Draws, Met, all};

fn ball(centre: Point3, radius: f64, strength: f64) -> BlobComponent {
    BlobComponent { shape: BlobShape::Ball(centre), radius, strength, place: Affine::IDENTITY }
}

#[test]
fn a_blob_of_one_ball_is_a_ball() {
    // (1 - d^2/4)^2 = 1/4 where d^2 = 2.
    let one = Blob::new(0.25, &[ball(Point3::ORIGIN, 2.0, 1.0)]).unwrap();
    let exact = polynomial(2, &[([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0), ([0; 3], -2.0)]);
    let (mut met, mut rays) = (Met::default(), 0);
    for case in drawn(6_000) {
        rays += 1;
        let ray = TestRng::new(case_seed(14, case)).ray();
        let (a, b) = (all(&one, &ray), all(&exact, &ray));
        assert!(same(&a, &b), "{ray:?}\n blob {a:?}\n ball {b:?}");
        met.add(&a);
    }
    report(rays);
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    assert!(met.simple > 6_000 && met.clusters * 1000 < met.simple && met.median() < 1000.0);
}

/// Brackets are those of the exact placement, however much its inverse magnifies rounding errors.
/// The crossings near a tangent are simple ones.
#[test]
fn a_shear_widens_no_bracket() {
    let one = Blob::new(0.25, &[ball(Point3::ORIGIN, 2.0, 1.0)]).unwrap();
    let exact = polynomial(2, &[([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0), ([0; 3], -2.0)]);
    let shear = [[1.0, 500.0, 0.0], [0.0, 1.0, 500.0], [0.0, 0.0, 1.0]];
    let place = Affine::new(shear, Point3::new(0.125, 125.0, 1000.0)).unwrap();
    let (one, exact) = (Placed::new(one, place), Placed::new(exact, place));
    let (mut dice, mut widths, mut clusters, mut met) = (TestRng::new(21), vec![], 0, 0);
    for i in 0..1000 {
        // Half of them pass within 2^-22 of the ball's size from its rim.
        let d = dice.vector();
        let across = d.cross(dice.vector());
        let beside = if i % 2 == 0 { 1.0 - durer_math::scale::pow2(-20 - (i % 3)) } else { 0.5 };
        let at = across * (beside * 2.0_f64.sqrt() / across.length());
        let ray = Ray::new(place.point((at - d * 4.0).to_point()), place.vector(d));
        let (a, b) = (all(&one, &ray), all(&exact, &ray));
        assert!(same(&a, &b), "{ray:?}\n blob {a:?}\n ball {b:?}");
        clusters += a.iter().filter(|r| r.kind != RootKind::Simple).count();
        if i % 2 == 1 {
            widths.extend(a.iter().map(|r| (r.hi - r.lo) / (r.t * f64::EPSILON)));
        }
        met += a.len();
    }
    widths.sort_by(f64::total_cmp);
    let median = widths[widths.len() / 2];
    println!("{met} crossings, {clusters} clusters, median {median:.1} ulp");
    assert!(met > 1900 && clusters == 0 && median < 1000.0, "{clusters} of {met}: {median}");
}

/// Double-double decides what f64 cannot decide about the sum of placed fields: rays that miss a
/// surface, or cut it, by a millionth of a millionth of its size.
#[test]
fn next_to_a_tangent_there_are_two_crossings_or_none() {
    let squeeze = [[4.0, 0.0, -3.0], [0.0, 5.0, 0.0], [3.0, 0.0, 4.0]];
    let place = Affine::new(squeeze, Point3::new(-1.0, 0.5, 1000.0)).unwrap();
    // Far from the middle of the region that both reach, so that its strength has a large error in
    // f64; alone it is a ball of radius 1.
    let small = BlobComponent { place, ..ball(Point3::new(0.0, 0.0, -200.0), 2.0_f64.sqrt(), 4.0) };
    let parts = [small, ball(Point3::new(-900.0, 0.0, 0.0), 500.0, 1.0)];
    let blob = Blob::new(1.0, &parts).unwrap();
    let (mut dice, mut two, mut none) = (TestRng::new(23), 0, 0);
    for i in 0..400 {
        let d = dice.vector();
        let across = d.cross(dice.vector());
        let beside = 1.0 + f64::from(i % 2 * 2 - 1) * durer_math::scale::pow2(-36 - (i / 2 % 8));
        let at = across * (beside / across.length());
        let p = |v: Vec3| place.point((v - Vec3::Z * 200.0).to_point());
        let ray = Ray::new(p(at - d * 4.0), place.vector(d));
        let roots = all(&blob, &ray);
        assert!(roots.iter().all(|r| r.kind == RootKind::Simple), "{ray:?} {beside}: {roots:?}");
        match roots.len() {
            0 => none += 1,
            2 => two += 1,
            _ => panic!("{ray:?} {beside}: {roots:?}"),
        }
    }
    assert!(two > 150 && none > 150, "{two} {none}");
}

/// A crossing between the end of a range and the next number is in the range that continues from
/// there and in no other, of whatever length.
#[test]
fn a_crossing_next_to_an_end_is_on_one_side_of_it() {
    let blob = Blob::new(9.0, &[ball(Point3::ORIGIN, 18.0, 16.0)]).unwrap();
    let line = Ray::new(Point3::new(-9.0, 0.0, -1.998_401_444_325_281_8e-7), Vec3::X * -9.0);
    let signs = |from, to| all(&blob, &line.with_range(from, to)).iter().map(|r| r.sign).collect::<Vec<_>>();
    assert_eq!(signs(f64::NEG_INFINITY, f64::INFINITY), [-1, 1]);
    assert_eq!(signs(-2.0, -1.0), [-1]);
    for from in [f64::NEG_INFINITY, -4.0, -2.0_f64.next_up(), -2.0] {
        assert_eq!(signs(from, -2.0), [], "{from}");
    }
}

#[test]
fn pictures_know_as_well_on_which_side_of_an_end_a_crossing_is() {
    let one = Blob::new(0.25, &[ball(Point3::ORIGIN, 2.0, 1.0)]).unwrap();
    let shear = [[1.0, 16.0, 0.0], [0.0, 1.0, 16.0], [0.0, 0.0, 1.0]];
    let one = Placed::new(one, Affine::new(shear, Point3::new(0.125, 125.0, 1000.0)).unwrap());
    let (mut dice, mut met) = (TestRng::new(22), 0);
    for _ in 0..1000 {
        let (from, to) = (dice.vector() * 4.0, dice.vector());
        let place = |v: Vec3| one.map().point(v.to_point());
        let mut ray = Ray::new(place(from), place(to) - place(from));
        for root in all(&one, &ray) {
            for k in -60..-20 {
                let end = root.t * (1.0 + durer_math::scale::pow2(k) * f64::from(k % 3 - 1));
                let mut sum = 0;
                for (from, to) in [(f64::NEG_INFINITY, end), (end, f64::INFINITY)] {
                    (ray.t_min, ray.t_max) = (from, to);
                    let mut rough = All::default();
                    one.roots(&LocalRay::new(&ray).roughly(), &mut rough);
                    let told = all(&one, &ray).len();
                    assert_eq!(rough.roots.len(), told, "{ray:?}");
                    sum += told;
                }
                // Each crossing is on one side of the end.
                assert_eq!(sum, 2, "{ray:?}");
                met += sum;
            }
            (ray.t_min, ray.t_max) = (0.0, f64::INFINITY);
        }
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn a_blob_of_one_sausage_is_a_cylinder_with_round_ends() {
    let segment = BlobShape::Segment(Point3::new(-1.0, 0.5, 0.25), Point3::new(0.5, -0.25, 0.5));
    let one = Blob::new(
        0.25,
        &[BlobComponent { shape: segment, radius: 1.0, strength: 1.0, place: Affine::IDENTITY }],
    )
    .unwrap();
    let BlobShape::Segment(a, b) = segment else { unreachable!() };
    let (u, r) = (b - a, 0.5_f64.sqrt());
    let ends = [Sphere::new(a, r).unwrap(), Sphere::new(b, r).unwrap()];
    let (mut dice, mut met) = (TestRng::new(15), Met::default());
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
        // A ray that hits an end's ball hits the sausage.
        if ends
            .iter()
            .any(|end| all(end, &ray).iter().all(|r| r.kind == RootKind::Simple) && all(end, &ray).len() == 2)
        {
            assert_eq!(roots.len(), 2, "{ray:?}");
        }
        met.add(&roots);
    }
    assert!(met.simple > 1_000 && met.clusters * 100 < met.simple, "{} {}", met.simple, met.clusters);
}

/// The sign of `sum of S (1 - d^2/R^2)^2 - T` at `o + t d`, all in exact numbers; radii are powers
/// of two.
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
    let (mut met, mut rays) = (Met::default(), 0);
    for case in drawn(12) {
        let mut dice = TestRng::new(case_seed(16, case));
        let parts: Vec<_> = (0..2 + dice.below(8))
            .map(|i| {
                let strength =
                    if i > 0 && dice.below(3) == 0 { -1.0 } else { 1.0 } * (1.0 + dice.signed().abs());
                ball((dice.vector() * 0.75).to_point(), [0.25, 0.5, 1.0][dice.below(3) as usize], strength)
            })
            .collect();
        let surface = Blob::new(0.375, &parts).unwrap();
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
            rays += 1;
            holds_together(&surface, &ray, &roots, value);
            for root in roots.iter().filter(|r| r.kind == RootKind::Simple) {
                let (lo, hi) =
                    (exact_sign(&parts, 0.375, &ray, root.lo), exact_sign(&parts, 0.375, &ray, root.hi));
                // Inside, the sum exceeds the threshold.
                let inside = if root.sign < 0 { hi } else { lo };
                let outside = if root.sign < 0 { lo } else { hi };
                assert!(inside.is_ge() && outside.is_le(), "{ray:?}: {root:?} {lo:?} {hi:?}");
            }
            met.add(&roots);
        }
    }
    report(rays);
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    assert!(met.simple > 2_000 && met.clusters * 1000 < met.simple && met.median() < 1000.0);
}

#[test]
fn a_component_is_placed_like_an_object() {
    let rows = [[1.5, 0.25, 0.0], [-0.25, 0.5, 0.125], [0.0, 0.5, 1.0]];
    let place = Affine::new(rows, Point3::new(0.25, -0.5, 0.125)).unwrap();
    let part = BlobComponent { place, ..ball(Point3::ORIGIN, 1.0, 1.0) };
    let moved = Blob::new(0.25, &[part]).unwrap();
    let exact = Placed::new(Sphere::new(Point3::ORIGIN, 0.5_f64.sqrt()).unwrap(), place);
    let (mut dice, mut met) = (TestRng::new(17), 0);
    for _ in 0..3_000 {
        let ray = dice.ray();
        let (a, b) = (all(&moved, &ray), all(&exact, &ray));
        // The radius of the sphere is rounded, that of the blob is not.
        if a.iter().chain(&b).all(|r| r.kind == RootKind::Simple) && a.len() == b.len() {
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
fn normals_point_out_of_blobs() {
    let surface =
        Blob::new(0.5, &[ball(Point3::ORIGIN, 1.0, 1.0), ball(Point3::new(0.8, 0.0, 0.0), 1.0, 1.0)])
            .unwrap();
    let mut dice = TestRng::new(18);
    for _ in 0..500 {
        let ray = dice.ray();
        for root in all(&surface, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
            let point = surface.resolve(&LocalRay::new(&ray), root, Need::ALL);
            let along = point.ng.to_vec().dot(ray.direction) / ray.direction.length();
            assert!(along * f64::from(root.sign) > -1e-6, "{ray:?} {point:?}");
        }
    }
}

#[test]
fn what_makes_no_blob_is_named() {
    let one = [ball(Point3::ORIGIN, 1.0, 1.0)];
    assert!(matches!(Blob::new(0.0, &one), Err(BlobError::Threshold(_))));
    assert!(matches!(Blob::new(f64::NAN, &one), Err(BlobError::Threshold(_))));
    assert!(matches!(Blob::new(0.5, &[]), Err(BlobError::Nothing)));
    assert!(matches!(Blob::new(0.5, &[ball(Point3::ORIGIN, 1.0, -1.0)]), Err(BlobError::Nothing)));
    assert!(matches!(Blob::new(0.5, &[ball(Point3::ORIGIN, 0.0, 1.0)]), Err(BlobError::Component(_))));
    assert!(matches!(Blob::new(0.5, &[ball(Point3::ORIGIN, 1.0, f64::NAN)]), Err(BlobError::Strength(_))));
    // Strength below the threshold: the blob exists, and is empty.
    assert!(all(&Blob::new(2.0, &one).unwrap(), &Ray::new(Point3::new(0.0, 0.0, -3.0), Vec3::Z)).is_empty());
}

/// The blob has the same crossings as the formula, as far as both are certain.
fn agrees(parts: &[BlobComponent], threshold: f64, rays: &[Ray]) -> Met {
    let (blob, formula) = (Blob::new(threshold, parts).unwrap(), formula::blob(threshold, parts));
    let mut met = Met::default();
    for ray in rays {
        let (a, b) = (all(&blob, ray), all(&formula, ray));
        assert!(same(&a, &b), "{ray:?}\n blob {a:?}\n formula {b:?}");
        met.add(&a);
    }
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    met
}

/// A ray through a point, from near or far.
fn through(dice: &mut TestRng, p: Point3, direction: Vec3) -> Ray {
    let back = [2.0, 4.0, 1e2, 1e6][dice.below(4) as usize] / direction.length();
    Ray::new(p - direction * back, direction)
}

#[test]
fn where_fields_begin_and_end_nothing_is_lost() {
    // Small numbers, so that rays pass exactly through places where fields begin, along their
    // tangents, and through points where the sum is the threshold.
    let mut dice = TestRng::new(19);
    let mut met = (0, 0);
    for case in 0..24 {
        let quarter = |dice: &mut TestRng| (dice.below(9) as f64 - 4.0) * 0.25;
        let mut parts: Vec<_> = (0..2 + dice.below(6))
            .map(|i| {
                let c = Point3::new(quarter(&mut dice), quarter(&mut dice), quarter(&mut dice));
                let strength =
                    if i > 0 && dice.below(3) == 0 { -0.5 } else { [0.5, 1.0, 2.0][dice.below(3) as usize] };
                let radius = [0.25, 0.5, 1.0][dice.below(3) as usize];
                let d = Vec3::new(quarter(&mut dice), quarter(&mut dice), quarter(&mut dice));
                let shape =
                    if dice.below(3) == 0 { BlobShape::Segment(c, c + d) } else { BlobShape::Ball(c) };
                BlobComponent { shape, radius, strength, place: Affine::IDENTITY }
            })
            .collect();
        if case % 3 == 0 {
            // The first component once more, and once with the opposite strength.
            parts.push(parts[0].clone());
            parts.push(BlobComponent { strength: -parts[0].strength, ..parts[0].clone() });
        }
        let rays: Vec<_> = (0..120)
            .map(|i| {
                let p = Point3::new(quarter(&mut dice), quarter(&mut dice), quarter(&mut dice));
                let d = match i % 3 {
                    0 => [Vec3::X, Vec3::Y, Vec3::Z][dice.below(3) as usize],
                    1 => Vec3::new(quarter(&mut dice), quarter(&mut dice), 0.25),
                    _ => dice.vector(),
                };
                through(&mut dice, p, d)
            })
            .collect();
        let threshold = [0.25, 0.5625, 0.3, 1e-3][case % 4];
        let found = agrees(&parts, threshold, &rays);
        met = (met.0 + found.simple, met.1 + found.clusters);
    }
    println!("{} simple, {} clusters", met.0, met.1);
    assert!(met.0 > 1_500 && met.1 * 20 < met.0, "{met:?}");
}

#[test]
fn a_crossing_where_another_field_begins_is_one_simple_crossing() {
    // The surface of the first ball, at a distance of 0.5 from its centre, passes exactly through
    // the point at which the field of the second begins.
    let parts = [ball(Point3::ORIGIN, 1.0, 1.0), ball(Point3::new(1.5, 0.0, 0.0), 1.0, 1.0)];
    let blob = Blob::new(0.5625, &parts).unwrap();
    for (d, count) in
        [(Vec3::X, 4), (Vec3::new(-3.0, 0.0, 0.0), 4), (Vec3::new(1.0, 1e-3, 0.0), 4), (Vec3::Y, 2)]
    {
        for back in [3.0, 1e3, 1e6] {
            let ray = Ray::new(Point3::new(0.5, 0.0, 0.0) - d * back, d);
            let roots = all(&blob, &ray);
            if d == Vec3::Y {
                // A tangent there.
                assert!(roots.len() <= 2, "{roots:?}");
                continue;
            }
            assert_eq!(roots.len(), count, "{d:?} {back}: {roots:?}");
            assert!(roots.iter().all(|r| r.kind == RootKind::Simple), "{d:?} {back}: {roots:?}");
            for root in &roots {
                let (lo, hi) =
                    (exact_sign(&parts, 0.5625, &ray, root.lo), exact_sign(&parts, 0.5625, &ray, root.hi));
                assert!(lo != hi, "{root:?}");
            }
        }
    }
}

#[test]
fn of_thousands_of_components_each_ray_asks_its_own() {
    let mut dice = TestRng::new(5);
    let parts: Vec<_> = (0..3_000)
        .map(|i| {
            let strength = if i % 5 == 0 { -0.5 } else { 1.0 };
            ball((dice.vector() * 4.0).to_point(), 0.25 + 0.125 * dice.signed(), strength)
        })
        .collect();
    let blob = Blob::new(0.375, &parts).unwrap();
    let mut met = Met::default();
    let radii: Vec<_> = parts.iter().map(|p| (p.shape, p.radius, p.strength)).collect();
    let value = |p: Point3| {
        let add = |&(shape, radius, strength): &(BlobShape, f64, f64)| {
            let BlobShape::Ball(c) = shape else { unreachable!() };
            let w = p - c;
            let left = (1.0 - w.dot(w) / (radius * radius)).max(0.0);
            strength * left * left
        };
        0.375 - radii.iter().map(add).sum::<f64>()
    };
    for i in 0..200 {
        let d = dice.vector();
        let ray = Ray::new((dice.vector() * 4.0).to_point() - d * (12.0 / d.length()), d);
        let roots = all(&blob, &ray);
        if i < 40 {
            holds_together(&blob, &ray, &roots, value);
        }
        met.add(&roots);
    }
    println!("{} simple, {} clusters, median {:.1} ulp", met.simple, met.clusters, met.median());
    // About 990 of any 200 rays.
    assert!(met.simple > 750 && met.clusters * 500 < met.simple);
}

#[test]
fn rays_that_leave_the_surface_do_not_meet_it_again_at_once() {
    let parts = [
        ball(Point3::ORIGIN, 1.0, 1.0),
        ball(Point3::new(0.8, 0.0, 0.0), 1.0, 1.0),
        ball(Point3::new(0.3, 0.5, 0.0), 0.5, -1.5),
    ];
    let blob = Blob::new(0.5, &parts).unwrap();
    let (mut dice, mut left) = (TestRng::new(22), 0);
    for _ in 0..2_000 {
        let ray = dice.ray();
        for root in all(&blob, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
            let point = blob.resolve(&LocalRay::new(&ray), root, Need::POINT);
            let outward = dice.vector();
            let outward = if outward.dot(point.ng.to_vec()) < 0.0 { -outward } else { outward };
            let next = point.spawn(outward);
            let side = blob.side(&durer_surfaces::LocalPoint::new(next.origin));
            assert_eq!(side, durer_surfaces::Side::Out, "{ray:?} {point:?}");
            let local = LocalRay::new(&next).from_side(Some(durer_math::RaySide::Front));
            let mut again = All::default();
            blob.roots(&local, &mut again);
            let first: Option<&Root> = again.roots.first();
            if let Some(first) = first {
                assert!(first.sign < 0 || first.kind == RootKind::Cluster, "{next:?} {:?}", again.roots);
            }
            left += 1;
        }
    }
    assert!(left > 1_000);
}
