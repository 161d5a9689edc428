//! Formulas as surfaces against the same surfaces as quadrics, against other formulas of the same set, and against themselves.

mod common;

use common::Dice;
use durer_math::{Comparison, Function, I8, Interval, Point3, Ray, RaySide, Vec3};
use durer_surfaces::tape::{Builder, Formula, NodeId, Op, Tape};
use durer_surfaces::{
    All, AxisBox, Container, Isosurface, Kind, LocalPoint, LocalRay, Need, Root, Side, Sphere, Surface,
};

/// Writes formulas as one would on paper.
struct Pen(Builder);

impl Pen {
    fn new() -> (Self, [NodeId; 3]) {
        let mut b = Builder::new();
        let inputs = [0, 1, 2].map(|i| b.input(i).unwrap());
        (Self(b), inputs)
    }
    fn c(&mut self, x: f64) -> NodeId {
        self.0.constant(x).unwrap()
    }
    fn op(&mut self, op: Op) -> NodeId {
        self.0.push(op).unwrap()
    }
    fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Add(a, b))
    }
    fn sub(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Sub(a, b))
    }
    fn mul(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Mul(a, b))
    }
    fn sqr(&mut self, a: NodeId) -> NodeId {
        self.op(Op::Sqr(a))
    }
    fn squares(&mut self, of: &[NodeId]) -> NodeId {
        let first = self.sqr(of[0]);
        of[1..].iter().fold(first, |sum, &x| {
            let square = self.sqr(x);
            self.add(sum, square)
        })
    }
    fn done(&self, root: NodeId) -> Formula {
        self.0.finish(root, 3)
    }
}

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

fn cube(half: f64) -> Container {
    Container::Box(AxisBox::new(Point3::new(-half, -half, -half), Point3::new(half, half, half)).unwrap())
}

fn iso(formula: &Formula, half: f64) -> Isosurface {
    Isosurface::new(formula, 0.0, cube(half)).unwrap()
}

fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

/// Rays from anywhere through points near the surface of a unit ball, often all but tangent to it, with all kinds of ranges.
fn ray_at_a_ball(dice: &mut Dice, radius: f64) -> Ray {
    let direction = dice.vector();
    let across = direction.cross(dice.vector());
    let near = match dice.below(4) {
        0 => 1.0,
        1 => 1.0 + dice.unit() * 1e-12,
        2 => 1.0 + dice.unit() * 1e-6,
        _ => dice.unit() * 1.2,
    };
    let through = across * (radius * near / across.length());
    let back = [0.0, 1.0, 2.0, 3.0, 1e3, 1e6][dice.below(6) as usize] * dice.unit().abs();
    let ray = Ray::new(through.to_point() - direction * back, direction);
    match dice.below(3) {
        0 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
        1 => ray,
        _ => ray.with_range(back * dice.unit().abs(), back * 1.5),
    }
}

/// Each root of one has a root of the other in an overlapping bracket; where one could not tell roots apart only the parity counts.
fn same(a: &[Root], b: &[Root]) -> bool {
    let sure = |roots: &[Root]| roots.iter().all(|r| r.kind == Kind::Simple);
    if sure(a) && sure(b) {
        return a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign);
    }
    // A touch may lie at an end of the range, or may not.
    let net = |roots: &[Root]| roots.iter().map(|r| i32::from(r.sign)).sum::<i32>();
    net(a) == net(b) || a.iter().any(|r| r.kind == Kind::Cluster && r.sign == 0)
}

#[test]
fn a_sphere_as_a_formula_is_the_sphere() {
    let mut dice = Dice(1);
    for (formula, r) in [(sphere(0.0, 1.0), 1.0), (distance_sphere(1.0), 1.0), (sphere(0.0, 0.75), 0.75)] {
        let formula = iso(&formula, 1.5);
        let exact = Sphere::new(Point3::ORIGIN, r).unwrap();
        let (mut met, mut unsure, mut widths) = (0, 0, Vec::new());
        for _ in 0..20_000 {
            let ray = ray_at_a_ball(&mut dice, r);
            let (a, b) = (all(&formula, &ray), all(&exact, &ray));
            assert!(same(&a, &b), "{ray:?}\n formula {a:?}\n sphere {b:?}");
            assert!(a.windows(2).all(|w| w[0].t <= w[1].t));
            met += a.len();
            unsure += a.iter().filter(|r| r.kind == Kind::Cluster).count();
            let unit = ray.direction.length();
            // Brackets are as wide as the crossing is ill-conditioned: those of rays that do not graze are looked at.
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
}

/// Waves that cells tell apart only here and there, with edges where the planes of `max` meet them.
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

/// Rays that look ask less of a bracket: the same roots, in brackets about the narrow ones, no wider than they may be.
#[test]
fn who_looks_roughly_sees_the_same_roots() {
    let mut dice = Dice(40);
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
            for root in rough.iter().filter(|r| r.kind == Kind::Simple) {
                met += 1;
                let most = durer_surfaces::ROUGH * root.t.abs().max(3.0 / ray.direction.length());
                // Where the ray is not known better, or is all but tangent, no bracket can be that narrow.
                let clear = |r: &Root| r.hi - r.lo < most / 1024.0 && r.lo <= root.hi && root.lo <= r.hi;
                wide += usize::from(narrow.iter().any(clear) && root.hi - root.lo > 2.0 * most);
            }
        }
        println!("{wide} of {met} brackets are too wide");
        assert!(met > 300 && wide == 0, "{wide} of {met} brackets are too wide");
    }
}

#[test]
fn two_formulas_of_a_torus_agree() {
    let mut dice = Dice(2);
    let (a, b) = (iso(&torus(1.0, 0.25), 1.5), iso(&quartic_torus(1.0, 0.25), 1.5));
    let (mut met, mut unsure) = (0, 0);
    for _ in 0..20_000 {
        let radius = [1.25, 0.75, 1.0][dice.below(3) as usize];
        let ray = ray_at_a_ball(&mut dice, radius);
        let (x, y) = (all(&a, &ray), all(&b, &ray));
        assert!(same(&x, &y), "{ray:?}\n one {x:?}\n other {y:?}");
        met += x.len();
        unsure += x.iter().filter(|r| r.kind != Kind::Simple).count();
    }
    println!("{met} roots, {unsure} clusters");
    assert!(met > 10_000 && unsure * 100 < met, "{met} roots, {unsure} unsure");
}

#[test]
fn a_container_closes_what_it_cuts() {
    // A ball of radius 1.2 in a cube of half-width 1: a rounded cube whose faces are partly the container's.
    let closed = iso(&sphere(0.0, 1.2), 1.0);
    let open = iso(&sphere(0.0, 1.2), 1.0).without_caps();
    let (ball, block) = (
        Sphere::new(Point3::ORIGIN, 1.2).unwrap(),
        AxisBox::new(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0)).unwrap(),
    );
    let mut dice = Dice(3);
    for _ in 0..20_000 {
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
}

#[test]
fn rays_leave_what_they_were_spawned_on() {
    let mut dice = Dice(4);
    for formula in [sphere(0.0, 1.0), distance_sphere(1.0)] {
        let surface = iso(&formula, 1.5);
        let mut spawned = 0;
        for _ in 0..5_000 {
            let ray = ray_at_a_ball(&mut dice, 0.9);
            for root in all(&surface, &ray).iter().filter(|r| r.kind == Kind::Simple) {
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
    // sin(40 x) sin(40 y) sin(40 z) + 0.1: hundreds of sheets, none of which a sample may find that we do not.
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
    let mut dice = Dice(5);
    let mut met = 0;
    for _ in 0..300 {
        let ray = Ray::new((dice.vector() * 0.9).to_point(), dice.vector()).with_range(0.0, 0.8);
        let roots: Vec<Root> = all(&surface, &ray).into_iter().filter(|r| r.face == 0).collect();
        assert!(roots.windows(2).all(|w| w[0].sign == -w[1].sign), "{ray:?}: {roots:?}");
        // Samples see a subset of the changes of sign.
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
fn jumps_are_walls_and_undefined_is_nothing() {
    // select(x, -1, 1): all that is below x = 0.
    let (mut p, [x, _, z]) = Pen::new();
    let (below, above) = (p.c(-1.0), p.c(1.0));
    let step = p.op(Op::Select([x, below, above, above]));
    let half = iso(&p.done(step), 1.0);
    let ray = Ray::new(Point3::new(-3.0, 0.25, 0.1), Vec3::X);
    let roots = all(&half, &ray);
    assert_eq!(roots.iter().map(|r| r.sign).collect::<Vec<_>>(), [-1, 1], "{roots:?}");
    assert!(roots[0].face > 0 && roots[1].face == 0 && (roots[1].t - 3.0).abs() < 1e-14);
    // sqrt(x) - 0.5: nothing where x < 0.
    let root = p.op(Op::Sqrt(x));
    let c = p.c(0.5);
    let f = p.sub(root, c);
    let sheet = iso(&p.done(f), 1.0).without_caps();
    let roots = all(&sheet, &ray);
    assert_eq!(roots.len(), 1, "{roots:?}");
    assert!(roots[0].lo <= 3.25 && 3.25 <= roots[0].hi && roots[0].kind == Kind::Simple);
    // A comparison is a formula too: x < z.
    let less = p.op(Op::Compare(Comparison::Less, x, z));
    let c = p.c(0.5);
    let f = p.sub(c, less);
    let slanted = iso(&p.done(f), 1.0);
    let roots = all(&slanted, &ray);
    assert!(roots.len() == 2 && (roots[1].t - 3.1).abs() < 1e-14, "{roots:?}");
}

/// Where two that have one value meet nothing jumps: rays that cross there, or go along it, cross simply.
#[test]
fn what_is_joined_is_no_wall() {
    let (mut p, [x, y, _]) = Pen::new();
    let (half, two, level) = (p.c(-0.5), p.c(2.0), p.c(0.25));
    let (below, above) = (p.mul(half, x), p.mul(two, x));
    let (below, above) = (p.add(level, below), p.add(level, above));
    let bent = p.op(Op::Joined([x, below, above]));
    let f = p.sub(bent, y);
    let roof = iso(&p.done(f), 1.0).without_caps();
    let told = [
        // Through the bend, along it, beside it.
        (Point3::new(-0.5, 0.75, 0.1), Vec3::new(1.0, -1.0, 0.0), 0.5),
        (Point3::new(0.0, 3.0, 0.1), Vec3::new(0.0, -1.0, 0.0), 2.75),
        (Point3::new(0.0, 3.0, 0.1), Vec3::new(0.0, -2.0, 0.1), 1.375),
        (Point3::new(-0.125, 3.0, 0.1), Vec3::new(0.0, -1.0, 0.0), 2.6875),
        (Point3::new(0.125, 3.0, 0.1), Vec3::new(0.0, -1.0, 0.0), 2.5),
    ];
    for (i, (origin, way, t)) in told.into_iter().enumerate() {
        let roots = all(&roof, &Ray::new(origin, way));
        let [root] = roots.as_slice() else { panic!("{origin:?}: {roots:?}") };
        assert!(root.kind == Kind::Simple && root.lo <= t && t <= root.hi, "{origin:?}: {root:?}");
        // Across the bend Newton's steps know the slope from 1/2 to 3.
        assert!(root.hi - root.lo < if i == 0 { 1e-10 } else { 1e-14 }, "{root:?}");
    }
    // Cells on either side are shorter by the choice.
    let tape = Tape::new(&p.done(f));
    let across = [Interval::new(-1.0, 0.0), Interval::new(0.0, 1.0)];
    for side in across {
        let boxed = [I8::splat(side), I8::splat(Interval::new(0.0, 1.0)), I8::splat(Interval::new(0.0, 1.0))];
        let (_, shorter) = tape.shortened(&boxed, |lane, _| lane == 0);
        assert!(shorter[0].as_ref().is_some_and(|shorter| shorter.len() + 3 <= tape.len()), "{side:?}");
    }
}

/// Sums of whole numbers are exact: of `mod(floor(x) + floor(y) + 10, 2) = 1/2`, a checker, the walls are met, and nothing between them.
#[test]
fn sums_of_whole_numbers_are_whole() {
    let (mut p, [x, y, _]) = Pen::new();
    let (two, ten, half) = (p.c(2.0), p.c(10.0), p.c(0.5));
    let (across, up) = (p.op(Op::Function(Function::Floor, x)), p.op(Op::Function(Function::Floor, y)));
    let sum = p.add(across, up);
    let sum = p.add(sum, ten);
    let colour = p.op(Op::Rem(sum, two));
    let f = p.sub(colour, half);
    let checker = iso(&p.done(f), 3.25);
    for (y, slope) in [(0.25, 0.0), (-1.5, 1e-3), (0.125, 0.03)] {
        let ray = Ray::new(Point3::new(-4.0, y, 0.1), Vec3::new(1.0, 0.0, slope));
        let found = all(&checker, &ray);
        let walls: Vec<&Root> = found.iter().filter(|root| root.face == 0).collect();
        assert_eq!(walls.len(), 7, "{y}: {walls:?}");
        for (root, wall) in walls.iter().zip(1..) {
            let t = f64::from(wall);
            assert!(root.lo <= t && t <= root.hi && root.hi - root.lo < 1e-14, "{y}: {root:?}");
            assert_eq!(root.sign, -walls[0].sign * (1 - 2 * (wall % 2) as i8), "{y}: {walls:?}");
        }
    }
}

/// So are their products, and their quotients where they are: of `k mod 3 = 0` with `k = floor(x)`, written as `k - 3 floor(k/3)`, the walls are met, though what is chosen below zero, where it never is, would fill everything.
#[test]
fn products_and_quotients_of_whole_numbers_are_exact() {
    let (mut p, [x, _, _]) = Pen::new();
    let (three, inside, outside) = (p.c(3.0), p.c(-1.0), p.c(1.0));
    let k = p.op(Op::Function(Function::Floor, x));
    let thirds = p.op(Op::Div(k, three));
    let whole = p.op(Op::Function(Function::Floor, thirds));
    let threes = p.mul(three, whole);
    let rest = p.sub(k, threes);
    let f = p.op(Op::Select([rest, inside, inside, outside]));
    let g = p.op(Op::Select([rest, inside, outside, outside]));
    let (slabs, nothing) = (iso(&p.done(f), 3.25), iso(&p.done(g), 3.25));
    for (y, slope) in [(0.25, 0.0), (-1.5, 1e-3), (0.125, 0.03)] {
        let ray = Ray::new(Point3::new(-4.0, y, 0.1), Vec3::new(1.0, 0.0, slope));
        let found = all(&slabs, &ray);
        let walls: Vec<&Root> = found.iter().filter(|root| root.face == 0).collect();
        assert_eq!(walls.len(), 5, "{y}: {walls:?}");
        for (root, wall) in walls.iter().zip([-3.0, -2.0, 0.0, 1.0, 3.0]) {
            let t = wall + 4.0;
            assert!(root.lo <= t && t <= root.hi && root.hi - root.lo < 1e-14, "{y}: {root:?}");
        }
        assert_eq!(all(&nothing, &ray), [], "{y}");
    }
}

/// A wall, where a formula jumps, has the normal of what decides about the side, outward as the ray goes.
#[test]
fn walls_have_the_normals_of_what_jumps() {
    let (mut p, [x, y, z]) = Pen::new();
    let (half, one, two, far) = (p.c(0.5), p.c(1.0), p.c(2.0), p.c(100.0));
    let floor = p.op(Op::Function(Function::Floor, x));
    let stairs = p.sub(y, floor);
    let less = p.op(Op::Compare(Comparison::Less, x, y));
    let less = p.sub(less, half);
    let sum = p.add(x, z);
    let minus = p.op(Op::Neg(one));
    let chosen = p.op(Op::Select([sum, minus, one, one]));
    let twice = p.mul(y, two);
    let slanted = p.add(x, twice);
    let slanted = p.add(slanted, far);
    let rest = p.op(Op::Rem(slanted, one));
    let rest = p.sub(rest, half);
    let angle = p.op(Op::Atan2(y, x));
    for (f, normal, d) in [
        (stairs, [1.0, 0.0, 0.0], [1.0, 0.01, 0.2]),
        (less, [1.0, -1.0, 0.0], [1.0, 0.25, 0.125]),
        (chosen, [1.0, 0.0, 1.0], [0.75, 0.5, 1.0]),
        (rest, [1.0, 2.0, 0.0], [1.0, 0.125, 0.5]),
        (angle, [0.0, 1.0, 0.0], [-0.125, 1.0, 0.25]),
    ] {
        let surface = iso(&p.done(f), 3.0);
        let normal = Vec3::from(normal) * (1.0 / Vec3::from(normal).length());
        for way in [1.0, -1.0] {
            let d = Vec3::from(d) * way;
            let through = Point3::new(-0.625, 0.28125, 0.375);
            let ray = Ray::new(through - d * 8.0, d);
            let found = all(&surface, &ray);
            let walls: Vec<&Root> = found.iter().filter(|root| root.face == 0).collect();
            assert!(!walls.is_empty(), "{f:?}: {found:?}");
            for root in walls {
                let at = surface.resolve(&LocalRay::new(&ray), root, Need::ALL);
                let n = at.ng.to_vec();
                // Stairs have level steps, too, of which these rays meet none.
                let off = n - normal * n.dot(normal).signum();
                assert!(off.length() < 1e-12, "{f:?}: {at:?}, expected {normal:?}");
                assert_eq!(n.dot(d).signum(), f64::from(root.sign), "{f:?}: {at:?} {root:?}");
            }
        }
    }
}

/// `x` without its whole part, from 0 to 1, by each of the steps that can say it.
fn parts(p: &mut Pen, x: NodeId) -> Vec<NodeId> {
    let one = p.c(1.0);
    let floor = p.op(Op::Function(Function::Floor, x));
    let ceil = p.op(Op::Function(Function::Ceil, x));
    let (down, up) = (p.sub(x, floor), p.sub(x, ceil));
    // Above zero only.
    let far = p.c(100.0);
    let positive = p.add(x, far);
    let rest = p.op(Op::Rem(positive, one));
    // Of either sign, and one more where it is below zero.
    let signed = p.op(Op::Rem(x, one));
    let more = p.add(signed, one);
    let chosen = p.op(Op::Select([signed, more, signed, signed]));
    vec![down, p.add(up, one), rest, chosen]
}

/// A saw `|frac(x) - 1/2| - y` does not jump where `frac` does: a line meets its teeth and nothing else.
#[test]
fn what_jumps_to_and_fro_is_no_wall() {
    for which in 0..4 {
        let (mut p, [x, y, _]) = Pen::new();
        let part = parts(&mut p, x)[which];
        let half = p.c(0.5);
        let tooth = p.sub(part, half);
        let tooth = p.op(Op::Abs(tooth));
        let f = p.sub(tooth, y);
        let saw = iso(&p.done(f), 3.0);
        for y in [0.25, 0.125, 0.4375] {
            for (z, slope) in [(0.0, 0.0), (0.1, 1e-3), (0.7, 0.03)] {
                let ray = Ray::new(Point3::new(-4.0, y, z), Vec3::new(1.0, 0.0, slope));
                let found = all(&saw, &ray);
                let teeth: Vec<&Root> = found.iter().filter(|root| root.face == 0).collect();
                // |frac - 1/2| = y at n + 1/2 - y and n + 1/2 + y, n from -3 to 2.
                let expected = (-3..3).flat_map(|n| [0.5 - y, 0.5 + y].map(|at| f64::from(n) + at + 4.0));
                assert_eq!(teeth.len(), 12, "{which} {y} {slope}: {teeth:?}");
                for (root, t) in teeth.iter().zip(expected) {
                    let held = root.lo <= t && t <= root.hi;
                    assert!(held && root.kind == Kind::Simple, "{which} {y} {slope}: {root:?}, expected {t}");
                }
            }
        }
    }
}

/// An angle jumps behind the axis, and so do its whole turns: a gear of seven teeth, `r + cos(7 (a - 2 pi floor(a / 2 pi))) / 8 = 1`, is round there. Rays through
/// its axis meet it twice.
#[test]
fn angles_that_begin_anew_are_no_walls() {
    let (mut p, [x, y, _]) = Pen::new();
    let angle = p.op(Op::Atan2(y, x));
    let turn = p.c(std::f64::consts::TAU);
    let turns = p.op(Op::Div(angle, turn));
    let whole = p.op(Op::Function(Function::Floor, turns));
    let whole = p.mul(whole, turn);
    let part = p.sub(angle, whole);
    let seven = p.c(7.0);
    let part = p.mul(part, seven);
    let wave = p.op(Op::Function(Function::Cos, part));
    let eighth = p.c(0.125);
    let wave = p.mul(wave, eighth);
    let square = p.squares(&[x, y]);
    let r = p.op(Op::Sqrt(square));
    let sum = p.add(r, wave);
    let one = p.c(1.0);
    let f = p.sub(sum, one);
    let gear = iso(&p.done(f), 1.5);
    // Near the axis, not through it: there is no angle on it. The last ones cross the place where the angle jumps inside and outside of the gear.
    for (o, d) in [
        ([3.0, 1e-3, 0.1], [-1.0, 0.0, 0.0]),
        ([3.0, 0.25, 0.1], [-2.0, 0.0625, 0.0]),
        ([-0.5, 3.0, 0.1], [0.0, -1.0, 0.0]),
        ([-1.3, 3.0, 0.1], [0.0, -1.0, 0.0]),
    ] {
        let found = all(&gear, &Ray::new(Point3::from(o), Vec3::from(d)));
        let signs: Vec<i8> = found.iter().map(|root| root.sign).collect();
        let expected: &[i8] = if o[0] == -1.3 { &[] } else { &[-1, 1] };
        assert_eq!(signs, expected, "{o:?}: {found:?}");
        assert!(found.iter().all(|root| root.kind == Kind::Simple), "{o:?}: {found:?}");
    }
    // On the seam itself the normal is the gear's.
    let ray = Ray::new(Point3::new(-3.0, 0.0, 0.1), Vec3::new(1.0, 0.0, 0.0));
    let found = all(&gear, &ray);
    let at = gear.resolve(&LocalRay::new(&ray), &found[0], Need::ALL);
    assert!((at.ng.to_vec() + Vec3::new(1.0, 0.0, 0.0)).length() < 1e-9, "{at:?} {found:?}");
}

/// What is chosen by a sign: `|x|` as `x < 0 ? -x : x` is nowhere a wall, and three jumps at one place are told apart.
#[test]
fn choices_that_meet_are_no_walls() {
    let (mut p, [x, y, z]) = Pen::new();
    let pen = &mut p;
    let size = |pen: &mut Pen, x: NodeId| {
        let less = pen.op(Op::Neg(x));
        pen.op(Op::Select([x, less, x, x]))
    };
    // A diamond, |x| + |y| + |z| = 1.
    let sizes = [x, y, z].map(|x| size(pen, x));
    let sum = pen.add(sizes[0], sizes[1]);
    let sum = pen.add(sum, sizes[2]);
    let one = pen.c(1.0);
    let f = pen.sub(sum, one);
    let diamond = iso(&p.done(f), 2.0);
    for d in [[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, -2.0, 4.0], [0.0, 0.0, 1.0]] {
        let d = Vec3::from(d);
        let found = all(&diamond, &Ray::new(Point3::ORIGIN - d * 8.0, d));
        // Through its centre, where all three choices meet; the crossings lie at the corner or edge of a facet, or in it.
        assert_eq!(found.iter().map(|root| root.sign).collect::<Vec<_>>(), [-1, 1], "{d:?}: {found:?}");
        let l1 = d.abs().dot(Vec3::new(1.0, 1.0, 1.0));
        for (root, t) in found.iter().zip([8.0 - 1.0 / l1, 8.0 + 1.0 / l1]) {
            // t is rounded twice.
            let held = root.lo.next_down() <= t.next_up() && t.next_down() <= root.hi.next_up();
            assert!(held, "{d:?}: {root:?}, expected {t}");
        }
    }
}

/// Two choices by one sign: `a b = 2` on both sides, and -2 between them only where zero belongs to different sides.
#[test]
fn choices_by_one_sign_go_together() {
    for apart in [false, true] {
        let (mut p, [x, ..]) = Pen::new();
        let [low, high] = [-1.0, 1.0].map(|c| p.c(c));
        let [lower, higher] = [-2.0, 2.0].map(|c| p.c(c));
        let a = p.op(Op::Select([x, low, if apart { low } else { high }, high]));
        let b = p.op(Op::Select([x, lower, higher, higher]));
        let product = p.mul(a, b);
        let f = p.sub(product, high);
        let surface = iso(&p.done(f), 1.0);
        let found = all(&surface, &Ray::new(Point3::new(-3.0, 0.25, 0.1), Vec3::X));
        if apart {
            assert!(matches!(found[..], [Root { kind: Kind::Cluster, sign: 0, .. }]), "{found:?}");
            assert!(found[0].lo <= 3.0 && 3.0 <= found[0].hi, "{found:?}");
        } else {
            assert!(found.is_empty(), "{found:?}");
        }
    }
}

#[test]
fn cells_shorten_tapes() {
    // The union of nine balls: in most cells one or two are left.
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

/// Where a line only touches the container, and the formula holds there, it touches the solid.
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
        assert_eq!(met(&of(5.0), &line), [(1.0, 0, Kind::Grazing, true)]);
        assert_eq!(met(&of(5.0), &line.with_range(0.0, 0.5)), []);
        assert_eq!(met(&of(5.0), &line.with_range(1.0, 1.0)).len(), 1);
        // Outside of the formula, without caps, of a regular solid: nothing.
        assert_eq!(met(&of(1.0), &line), []);
        assert_eq!(met(&of(5.0).without_caps(), &line), []);
        assert_eq!(met(&of(5.0).regular(), &line), []);
    }
}

/// Next to its pole the ball is within the cushion by less than any bracket: a ray that starts outside of it and goes away meets nothing.
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

/// A ball, cut off: rays that cut its rim by less than pictures care for meet it there all the same.
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
    let mut dice = Dice(31);
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

/// A rim is where a formula's surface meets its container: a ray that passes there within rounding meets it once, if at all, or is inside for longer than that.
#[test]
fn a_rim_within_rounding_is_one_touch() {
    let (mut p, [x, y, _]) = Pen::new();
    let half = p.c(0.5);
    let sum = p.add(x, y);
    let f = p.add(sum, half);
    let surface = iso(&p.done(f), 1.0);
    let (mut dice, mut touches) = (Dice(32), 0);
    for _ in 0..2000 {
        // Through the rim at x = 1/2, y = -1, from below the one face to beyond the other.
        let rim = Vec3::new(0.5, -1.0, 0.5 * dice.unit());
        let d = Vec3::new(dice.unit() - 0.25, dice.unit(), dice.unit());
        let d = if d.x + d.y > 0.1 && d.y > 0.1 { d } else { Vec3::new(0.3, 0.7, 0.1) };
        let roots = all(&surface, &Ray::new((rim - d * (1.0 + 3.0 * dice.unit())).to_point(), d));
        let signs: Vec<_> = roots.iter().map(|r| (r.sign, r.kind)).collect();
        assert!(matches!(signs.as_slice(), [] | [(0, Kind::Cluster)]), "{d:?} {roots:?}");
        assert!(roots.iter().all(|r| r.hi - r.lo < 1e-12), "{d:?} {roots:?}");
        touches += roots.len();
    }
    assert!(touches > 200, "{touches}");
}

/// Along a cone's line within rounding nothing can be told; a cluster of it holds where the ball is entered and left, where the formula's sign is certain by chance.
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
    // Where the line is in the ball: |o + t d| = 3.
    let (enters, leaves) = (61.12941187261574, 8130.8705881273745);
    assert!(matches!(roots.as_slice(), [Root { sign: 0, kind: Kind::Cluster, .. }]), "{roots:?}");
    assert!(roots[0].lo <= enters && leaves <= roots[0].hi, "{roots:?}");
}

/// Next to a wall that is a plane within rounding, where the formula cannot be told from zero in the container's own face: the root before that is one by itself.
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
    // All but in the plane z = -1, where it is x² = 0: (1 + z) (y² + z - 1) + x² (1 - z).
    let o = Point3::new(124.99999999999999 - 125.0, -35.00000000000001, 998.9999999999999 - 1000.0);
    let roots = all(&surface, &Ray::new(o, Vec3::new(0.0, 0.0009765625, 0.0)));
    let signs: Vec<_> = roots.iter().map(|r| r.sign).collect();
    assert_eq!(signs, [-1, 1, -1, 1], "{roots:?}");
    // Where |y| = 2 at the walls, and y² = 1 - z = 2 between, to five decimals.
    for (root, t) in roots.iter().zip([33792.0, 34391.84531, 37288.15469, 37888.0]) {
        assert!(root.lo - 1e-5 <= t && t <= root.hi + 1e-5, "{root:?}");
    }
}
