//! Formulas as surfaces against the same surfaces as quadrics, against other formulas of the same
//! set, and against themselves.

#[path = "common/formulas.rs"]
mod formulas;

use durer_formula::Function;
use durer_formula::{Formula, Op};
use durer_math::{Point3, Ray, RaySide, Vec3};
use durer_surfaces::{
    All, AxisBox, Container, Isosurface, LocalPoint, LocalRay, Need, Root, RootKind, Side, Sphere, Surface,
};
use durer_testkit::TestRng;
use durer_testkit::{case_seed, drawn, report};
use formulas::{Pen, all, iso};

/// `(x - a)^2 + y^2 + z^2 - r^2`.
fn sphere(a: f64, r: f64) -> Formula {
    let (mut p, [x, y, z]) = Pen::new();
    let a = p.c(a);
    let x = p.sub(x, a);
    let sum = p.squares(&[x, y, z]);
    let square = p.c(r * r);
    let f = p.sub(sum, square);
    p.done(f)
}

/// `sqrt(x^2 + y^2 + z^2) - r`.
fn distance_sphere(r: f64) -> Formula {
    let (mut p, [x, y, z]) = Pen::new();
    let sum = p.squares(&[x, y, z]);
    let root = p.op(Op::Sqrt(sum));
    let r = p.c(r);
    let f = p.sub(root, r);
    p.done(f)
}

/// `(sqrt(x^2 + z^2) - R)^2 + y^2 - r^2`.
fn torus(major: f64, minor: f64) -> Formula {
    let (mut p, [x, y, z]) = Pen::new();
    let rho = p.squares(&[x, z]);
    let rho = p.op(Op::Sqrt(rho));
    let major = p.c(major);
    let off = p.sub(rho, major);
    let sum = p.squares(&[off, y]);
    let square = p.c(minor * minor);
    let f = p.sub(sum, square);
    p.done(f)
}

/// The torus as a polynomial: `(x^2 + y^2 + z^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + z^2)`.
fn quartic_torus(major: f64, minor: f64) -> Formula {
    let (mut p, [x, y, z]) = Pen::new();
    let sum = p.squares(&[x, y, z]);
    let k = p.c(major * major - minor * minor);
    let left = p.add(sum, k);
    let left = p.sqr(left);
    let rho = p.squares(&[x, z]);
    let factor = p.c(4.0 * major * major);
    let right = p.mul(factor, rho);
    let f = p.sub(left, right);
    p.done(f)
}

/// Rays from anywhere through points near the surface of a unit ball, often almost tangent to it,
/// with all kinds of ranges.
fn ray_at_a_ball(dice: &mut TestRng, radius: f64) -> Ray {
    let direction = dice.vector();
    let across = direction.cross(dice.vector());
    let near = match dice.below(4) {
        0 => 1.0,
        1 => 1.0 + dice.signed() * 1e-12,
        2 => 1.0 + dice.signed() * 1e-6,
        _ => dice.signed() * 1.2,
    };
    let through = across * (radius * near / across.length());
    let back = [0.0, 1.0, 2.0, 3.0, 1e3, 1e6][dice.below(6) as usize] * dice.signed().abs();
    let ray = Ray::new(through.to_point() - direction * back, direction);
    match dice.below(3) {
        0 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
        1 => ray,
        _ => ray.with_range(back * dice.signed().abs(), back * 1.5),
    }
}

/// Each root of one has a root of the other in an overlapping bracket; if one could not separate
/// roots, only the parity counts.
fn same(a: &[Root], b: &[Root]) -> bool {
    let sure = |roots: &[Root]| roots.iter().all(|r| r.kind == RootKind::Simple);
    if sure(a) && sure(b) {
        return a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign);
    }
    // A touch may lie at an end of the range, or outside.
    let net = |roots: &[Root]| roots.iter().map(|r| i32::from(r.sign)).sum::<i32>();
    net(a) == net(b) || a.iter().any(|r| r.kind == RootKind::Cluster && r.sign == 0)
}

#[test]
fn a_sphere_as_a_formula_is_the_sphere() {
    let mut rays = 0;
    for (formula, r) in [(sphere(0.0, 1.0), 1.0), (distance_sphere(1.0), 1.0), (sphere(0.0, 0.75), 0.75)] {
        let formula = iso(&formula, 1.5);
        let exact = Sphere::new(Point3::ORIGIN, r).unwrap();
        let (mut met, mut unsure, mut widths) = (0, 0, Vec::new());
        for case in drawn(20_000) {
            let ray = ray_at_a_ball(&mut TestRng::new(case_seed(1, case)), r);
            rays += 1;
            let (a, b) = (all(&formula, &ray), all(&exact, &ray));
            assert!(same(&a, &b), "{ray:?}\n formula {a:?}\n sphere {b:?}");
            assert!(a.windows(2).all(|w| w[0].t <= w[1].t));
            met += a.len();
            unsure += a.iter().filter(|r| r.kind == RootKind::Cluster).count();
            let unit = ray.direction.length();
            // The width of a bracket grows with the crossing's condition number: only rays that do
            // not graze are measured.
            let o = ray.origin.to_vec();
            let apart = o.cross(ray.direction).length() / unit;
            if apart > 0.9 * r {
                continue;
            }
            widths.extend(a.iter().map(|r| (r.hi - r.lo) / (r.t.abs().max(1.0 / unit) * f64::EPSILON)));
        }
        widths.sort_by(f64::total_cmp);
        let median = widths[widths.len() / 2];
        println!("{met} roots, {unsure} clusters, median width {median:.1} ulp");
        assert!(met > 10_000 && median < 100.0, "{met} roots, median width {median} ulp");
        // A quarter of the rays is aimed at tangents within rounding.
        assert!(unsure < met / 4, "{unsure} of {met} unsure");
    }
    report(rays);
}

/// Waves that only some cells separate, with edges where the planes of `max` meet them.
fn wavy() -> Formula {
    let (mut p, [x, y, z]) = Pen::new();
    let nine = p.c(9.0);
    let waves = [x, y, z].map(|x| {
        let x = p.mul(x, nine);
        p.op(Op::Function(Function::Sin, x))
    });
    let sum = p.add(waves[0], waves[1]);
    let sum = p.add(sum, waves[2]);
    let angle = p.op(Op::Atan2(y, x));
    let sum = p.op(Op::Max(sum, angle));
    let level = p.c(0.4);
    let f = p.sub(sum, level);
    p.done(f)
}

/// Rays of preview precision need wider brackets: they have the same roots, in brackets about the
/// narrow ones that are no wider than allowed.
#[test]
fn who_looks_roughly_sees_the_same_roots() {
    let mut dice = TestRng::new(40);
    for formula in [sphere(0.25, 1.0), distance_sphere(1.0), torus(0.7, 0.3), quartic_torus(0.7, 0.3), wavy()]
    {
        let surface = iso(&formula, 1.5);
        let (mut met, mut wide) = (0, 0);
        for _ in 0..2_000 {
            let ray = ray_at_a_ball(&mut dice, 1.0);
            let narrow = all(&surface, &ray);
            let mut sink = All::default();
            surface.roots(&LocalRay::new(&ray).roughly(), &mut sink);
            let rough = sink.roots;
            assert!(same(&narrow, &rough), "{ray:?}\n narrow {narrow:?}\n rough {rough:?}");
            for root in rough.iter().filter(|r| r.kind == RootKind::Simple) {
                met += 1;
                let most = durer_surfaces::PREVIEW_WIDTH * root.t.abs().max(3.0 / ray.direction.length());
                // Where the ray itself has a larger error, or is almost tangent, no bracket can be
                // that narrow.
                let clear = |r: &Root| r.hi - r.lo < most / 1024.0 && r.lo <= root.hi && root.lo <= r.hi;
                wide += usize::from(narrow.iter().any(clear) && root.hi - root.lo > 2.0 * most);
            }
        }
        println!("{wide} of {met} brackets are too wide");
        assert!(met > 300 && wide == 0, "{wide} of {met} brackets are too wide");
    }
}

/// A clipped ball: rays of preview precision hit its rim, also if they cut off less than their
/// precision.
#[test]
fn pictures_see_as_much_of_a_rim() {
    let held = AxisBox::new(Point3::new(-2.0, -2.0, -2.0), Point3::new(2.0, 0.5, 2.0)).unwrap();
    let surface = Isosurface::new(&sphere(0.0, 1.0), 0.0, Container::Box(held)).unwrap();
    let mut rays = vec![
        Ray::new(
            Point3::new(-2.421971852550793, 0.38233291942200814, -2.949871629503013),
            Vec3::new(0.6051118760075633, 0.03922236019266394, 0.7772720728278901),
        ),
        Ray::new(
            Point3::new(3.1048177793872296, 0.639127910690781, -1.2331864892610374),
            Vec3::new(-1.0371295351417038, -0.04637597023026035, 0.6997289883843476),
        ),
    ];
    let mut dice = TestRng::new(31);
    for _ in 0..4000 {
        let a = dice.vector();
        let rim =
            Vec3::new(a.x, 0.0, a.z) * (0.75_f64.sqrt() / (a.x * a.x + a.z * a.z).sqrt()) + Vec3::Y * 0.5;
        let (d, off) = (dice.vector(), dice.vector() * durer_math::scale::pow2(-30 - dice.below(24) as i32));
        rays.push(Ray::new((rim + off - d * 3.0).to_point(), d));
    }
    let mut met = 0;
    for ray in rays {
        let [fine, rough] = [LocalRay::new(&ray), LocalRay::new(&ray).roughly()].map(|local| {
            let mut all = All::default();
            surface.roots(&local, &mut all);
            all.roots.iter().map(|r| (r.face, r.sign)).collect::<Vec<_>>()
        });
        assert_eq!(rough, fine, "{ray:?}");
        met += fine.len();
    }
    assert!(met > 2000, "{met}");
}

#[test]
fn two_formulas_of_a_torus_agree() {
    let (a, b) = (iso(&torus(1.0, 0.25), 1.5), iso(&quartic_torus(1.0, 0.25), 1.5));
    let (mut rays, mut met, mut unsure) = (0, 0, 0);
    for case in drawn(20_000) {
        let mut dice = TestRng::new(case_seed(2, case));
        rays += 1;
        let radius = [1.25, 0.75, 1.0][dice.below(3) as usize];
        let ray = ray_at_a_ball(&mut dice, radius);
        let (x, y) = (all(&a, &ray), all(&b, &ray));
        assert!(same(&x, &y), "{ray:?}\n one {x:?}\n other {y:?}");
        met += x.len();
        unsure += x.iter().filter(|r| r.kind != RootKind::Simple).count();
    }
    report(rays);
    println!("{met} roots, {unsure} clusters");
    assert!(met > 10_000 && unsure * 100 < met, "{met} roots, {unsure} unsure");
}

#[test]
fn a_container_closes_what_it_cuts() {
    // A ball of radius 1.2 in a cube of half-width 1: a rounded cube whose faces are partly the
    // container's.
    let closed = iso(&sphere(0.0, 1.2), 1.0);
    let open = iso(&sphere(0.0, 1.2), 1.0).without_caps();
    let (ball, block) = (
        Sphere::new(Point3::ORIGIN, 1.2).unwrap(),
        AxisBox::new(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0)).unwrap(),
    );
    let mut rays = 0;
    for case in drawn(20_000) {
        let mut dice = TestRng::new(case_seed(3, case));
        rays += 1;
        let d = dice.vector();
        let ray = Ray::new((dice.vector() * 1.5).to_point(), d).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let (x, y) = (all(&ball, &ray), all(&block, &ray));
        let roots = all(&closed, &ray);
        // The intersection of two convex solids.
        let span = match (x.as_slice(), y.as_slice()) {
            ([a, b], [c, d]) => Some((a.t.max(c.t), b.t.min(d.t))).filter(|(s, e)| s < e),
            _ => None,
        };
        let size = |t: f64| 1e-12 / d.length() + t.abs() * 1e-14;
        match span {
            Some((s, e)) if e - s > 2.0 * size(e) => {
                let [a, b] = roots.as_slice() else { panic!("{ray:?}: {roots:?}") };
                assert!(
                    (a.t - s).abs() <= size(s) && (b.t - e).abs() <= size(e),
                    "{ray:?}: {roots:?}, {span:?}"
                );
                assert_eq!((a.sign, b.sign), (-1, 1));
            }
            Some(_) => {}
            None => assert!(roots.is_empty(), "{ray:?}: {roots:?}"),
        }
        let walls: Vec<_> = roots.iter().filter(|r| r.face == 0).copied().collect();
        let sheet = all(&open, &ray);
        assert_eq!(walls.len(), sheet.len(), "{ray:?}");
        let p = ray.origin;
        let side = closed.side(&LocalPoint::new(p));
        let within =
            ball.side(&LocalPoint::new(p)) == Side::In && block.side(&LocalPoint::new(p)) == Side::In;
        assert_eq!(side == Side::In, within, "{p:?}");
    }
    report(rays);
}

#[test]
fn rays_leave_what_they_were_spawned_on() {
    let mut dice = TestRng::new(4);
    for formula in [sphere(0.0, 1.0), distance_sphere(1.0)] {
        let surface = iso(&formula, 1.5);
        let mut spawned = 0;
        for _ in 0..5_000 {
            let ray = ray_at_a_ball(&mut dice, 0.9);
            for root in all(&surface, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
                let point = surface.resolve(&LocalRay::new(&ray), root, Need::ALL);
                let truth = point.p.to_vec() * (1.0 / point.p.to_vec().length());
                assert!(
                    (point.ng.to_vec() - truth).length() < 1e-6,
                    "{point:?} {ray:?} {root:?} {:?}",
                    ray.at(root.t)
                );
                assert!(point.off < 1e-12, "{point:?}");
                for (side, way) in [(RaySide::Front, 1.0), (RaySide::Back, -1.0)] {
                    let out = point.spawn_from(side, point.ng.to_vec() * way + dice.vector() * 0.9);
                    let on = surface.side(&LocalPoint::new(out.origin));
                    assert_eq!(on == Side::In, side == RaySide::Back, "{point:?}");
                    let along = out.direction.dot(point.ng.to_vec()) * way;
                    if along > 0.0 {
                        let local = LocalRay::new(&out).from_side(Some(side));
                        let mut met = All::default();
                        surface.roots(&local, &mut met);
                        let expected = usize::from(side == RaySide::Back);
                        assert_eq!(met.roots.len(), expected, "{out:?} from {point:?}: {:?}", met.roots);
                        spawned += 1;
                    }
                }
            }
        }
        assert!(spawned > 5_000);
    }
}

#[test]
fn no_root_is_lost_where_a_formula_is_wild() {
    // sin(40 x) sin(40 y) sin(40 z) + 0.1: hundreds of sheets. Samples must not find a sheet that
    // the surface misses.
    let (mut p, xyz) = Pen::new();
    let forty = p.c(40.0);
    let waves = xyz.map(|x| {
        let x = p.mul(forty, x);
        p.op(Op::Function(Function::Sin, x))
    });
    let product = p.mul(waves[0], waves[1]);
    let product = p.mul(product, waves[2]);
    let lift = p.c(0.1);
    let f = p.add(product, lift);
    let formula = p.done(f);
    let surface = iso(&formula, 1.0);
    let mut dice = TestRng::new(5);
    let mut met = 0;
    for _ in 0..300 {
        let ray = Ray::new((dice.vector() * 0.9).to_point(), dice.vector()).with_range(0.0, 0.8);
        let roots: Vec<Root> = all(&surface, &ray).into_iter().filter(|r| r.face == 0).collect();
        assert!(roots.windows(2).all(|w| w[0].sign == -w[1].sign), "{ray:?}: {roots:?}");
        // Samples find a subset of the changes of sign.
        let mut changes = 0;
        let mut before = None;
        for i in 0..=20_000 {
            let t = 0.8 * f64::from(i) / 20_000.0;
            let p = ray.at(t);
            if p.to_vec().max_abs() > 1.0 {
                break;
            }
            let value = formula.value(&p.to_array());
            changes += usize::from(before.is_some_and(|b: bool| b != (value > 0.0)));
            before = Some(value > 0.0);
        }
        assert!(
            roots.len() >= changes && (roots.len() - changes).is_multiple_of(2),
            "{} roots, {changes} changes",
            roots.len()
        );
        met += roots.len();
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn cells_shorten_tapes() {
    // The union of nine balls: in most cells one or two remain.
    let (mut p, [x, y, z]) = Pen::new();
    let mut union = None;
    for i in 0..9 {
        let c = p.c(f64::from(i) * 0.2 - 0.8);
        let moved = p.sub(x, c);
        let sum = p.squares(&[moved, y, z]);
        let r = p.c(0.05);
        let ball = p.sub(sum, r);
        union = Some(union.map_or(ball, |u| p.op(Op::Min(u, ball))));
    }
    let surface = iso(&p.done(union.unwrap()), 1.0);
    let (open, steps, whole) = surface.cells();
    assert!(open > 50 && steps * 3.0 < whole as f64, "{open} cells, {steps} of {whole} steps");
}

/// If a line only touches the container, and the point is inside the formula's solid, it touches
/// the solid.
#[test]
fn touches_of_the_container_are_told() {
    let plane = |at: f64| {
        let (mut p, [x, _, _]) = Pen::new();
        let at = p.c(at);
        let f = p.sub(x, at);
        p.done(f)
    };
    let ball = || Container::Ball(Sphere::new(Point3::ORIGIN, 3.0).unwrap());
    let cube =
        || Container::Box(AxisBox::new(Point3::new(-3.0, -3.0, -3.0), Point3::new(3.0, 3.0, 3.0)).unwrap());
    let pole = Ray::new(Point3::new(3.0, -1.0, 0.0), Vec3::Y);
    let edge = Ray::new(Point3::new(2.0, 4.0, 0.0), Vec3::new(1.0, -1.0, 0.0));
    for (container, line) in [(ball(), pole), (cube(), edge)] {
        let of = |at: f64| Isosurface::new(&plane(at), 0.0, container.clone()).unwrap();
        let met = |surface: &Isosurface, ray: &Ray| {
            let mut all = All::default();
            surface.roots(&LocalRay::new(ray), &mut all);
            all.roots.iter().map(|r| (r.t, r.sign, r.kind, r.face > 0)).collect::<Vec<_>>()
        };
        assert_eq!(met(&of(5.0), &line), [(1.0, 0, RootKind::Grazing, true)]);
        assert_eq!(met(&of(5.0), &line.with_range(0.0, 0.5)), []);
        assert_eq!(met(&of(5.0), &line.with_range(1.0, 1.0)).len(), 1);
        // Outside the formula's solid, without caps, or of a regular solid: nothing.
        assert_eq!(met(&of(1.0), &line), []);
        assert_eq!(met(&of(5.0).without_caps(), &line), []);
        assert_eq!(met(&of(5.0).regular(), &line), []);
    }
}

/// Near its pole the ball lies within the cushion by less than any bracket: a ray that starts
/// outside the ball and goes away hits nothing.
#[test]
fn a_start_outside_the_container_is_outside() {
    let (mut p, [x, y, z]) = Pen::new();
    let squares = [x, y, z].map(|x| p.sqr(x));
    let fourths = squares.map(|x| p.sqr(x));
    let sum = p.squares(&fourths);
    let f = p.done(sum);
    let ball = Sphere::new(Point3::ORIGIN, 1.0).unwrap();
    let surface = Isosurface::new(&f, 1.0, Container::Ball(ball)).unwrap();
    let direction = Vec3::new(-1.679595787263737e-05, 3.5129019819569826e-06, 1.1005548190928143e-05);
    let start = |z: f64| Ray::new(Point3::new(0.0, 0.0, z), direction);
    let met = |ray: &Ray| {
        let mut all = All::default();
        surface.roots(&LocalRay::new(ray), &mut all);
        all.roots.iter().map(|r| r.sign).collect::<Vec<_>>()
    };
    assert_eq!(met(&start(1.0_f64.next_up())), []);
    assert_eq!(met(&start(1.0_f64.next_down())), [1]);
    let back = start(1.0_f64.next_up());
    assert_eq!(met(&Ray::new(back.origin, -direction)), [-1, 1]);
}

/// At a rim a formula's surface meets its container. A ray that passes there within rounding
/// touches it at most once, or is inside for longer than that.
#[test]
fn a_rim_within_rounding_is_one_touch() {
    let (mut p, [x, y, _]) = Pen::new();
    let half = p.c(0.5);
    let sum = p.add(x, y);
    let f = p.add(sum, half);
    let surface = iso(&p.done(f), 1.0);
    let (mut dice, mut touches) = (TestRng::new(32), 0);
    for _ in 0..2000 {
        // Through the rim at x = 1/2, y = -1, from below one face to beyond the other.
        let rim = Vec3::new(0.5, -1.0, 0.5 * dice.signed());
        let d = Vec3::new(dice.signed() - 0.25, dice.signed(), dice.signed());
        let d = if d.x + d.y > 0.1 && d.y > 0.1 { d } else { Vec3::new(0.3, 0.7, 0.1) };
        let roots = all(&surface, &Ray::new((rim - d * (1.0 + 3.0 * dice.signed())).to_point(), d));
        let signs: Vec<_> = roots.iter().map(|r| (r.sign, r.kind)).collect();
        assert!(matches!(signs.as_slice(), [] | [(0, RootKind::Cluster)]), "{d:?} {roots:?}");
        assert!(roots.iter().all(|r| r.hi - r.lo < 1e-12), "{d:?} {roots:?}");
        touches += roots.len();
    }
    assert!(touches > 200, "{touches}");
}

/// Along a line of a cone, within rounding, nothing is certain. The resulting cluster contains the
/// entry into the ball and the exit from it, where the formula's sign is certain by chance.
#[test]
fn a_cluster_holds_the_rims_at_its_ends() {
    let (mut p, inputs) = Pen::new();
    let [x, y, z] = inputs.map(|i| {
        let square = p.sqr(i);
        p.mul(square, i)
    });
    let sum = p.add(x, y);
    let f = p.sub(sum, z);
    let ball = Container::Ball(Sphere::new(Point3::ORIGIN, 3.0).unwrap());
    let surface = Isosurface::new(&p.done(f), 0.0, ball).unwrap();
    let o = Point3::new(2.0662256623722506 - 1.0, 125.0 - 123.03311283118613, 2.0662256623722506);
    let d = Vec3::new(-0.00026030899960260013, -0.0004801970626986999, -0.0005044496246026003);
    let roots = all(&surface, &Ray::new(o, d));
    // The part of the line in the ball: |o + t d| = 3.
    let (enters, leaves) = (61.12941187261574, 8130.8705881273745);
    assert!(matches!(roots.as_slice(), [Root { sign: 0, kind: RootKind::Cluster, .. }]), "{roots:?}");
    assert!(roots[0].lo <= enters && leaves <= roots[0].hi, "{roots:?}");
}

/// Near a wall that is a plane within rounding, where the formula cannot be distinguished from zero
/// in the container's own face: the root before that is reported separately.
#[test]
fn a_root_before_a_rim_is_told() {
    let (mut p, [x, y, z]) = Pen::new();
    let one = p.c(1.0);
    let [xx, yy, zz] = [x, y, z].map(|i| p.sqr(i));
    let (a, b) = (p.mul(xx, z), p.mul(yy, z));
    let sum = p.add(xx, yy);
    let sum = p.sub(sum, a);
    let sum = p.add(sum, b);
    let sum = p.add(sum, zz);
    let f = p.sub(sum, one);
    let held = AxisBox::new(Point3::new(-1.0, -2.0, -2.0), Point3::new(3.0, 2.0, 2.0)).unwrap();
    let surface = Isosurface::new(&p.done(f), 0.0, Container::Box(held)).unwrap();
    // Almost in the plane z = -1, where it is x² = 0: (1 + z) (y² + z - 1) + x² (1 - z).
    let o = Point3::new(124.99999999999999 - 125.0, -35.00000000000001, 998.9999999999999 - 1000.0);
    let roots = all(&surface, &Ray::new(o, Vec3::new(0.0, 0.0009765625, 0.0)));
    let signs: Vec<_> = roots.iter().map(|r| r.sign).collect();
    assert_eq!(signs, [-1, 1, -1, 1], "{roots:?}");
    // |y| = 2 at the walls, and y² = 1 - z = 2 between, to five decimals.
    for (root, t) in roots.iter().zip([33792.0, 34391.84531, 37288.15469, 37888.0]) {
        assert!(root.lo - 1e-5 <= t && t <= root.hi + 1e-5, "{root:?}");
    }
}
