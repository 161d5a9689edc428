//! Formulas that jump: which jumps are walls of their surfaces, with which normals, and which are
//! not.

#[path = "common/formulas.rs"]
mod formulas;

use durer_formula::{Comparison, Function, I8};
use durer_formula::{NodeId, Op, Tape};
use durer_math::{Interval, Point3, Ray, Vec3};
use durer_surfaces::{LocalRay, Need, Root, RootKind, Surface};
use formulas::{Pen, all, iso};

#[test]
fn jumps_are_walls_and_undefined_is_nothing() {
    // select(x, -1, 1): the half-space below x = 0.
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
    assert!(roots[0].lo <= 3.25 && 3.25 <= roots[0].hi && roots[0].kind == RootKind::Simple);
    // A comparison is a formula too: x < z.
    let less = p.op(Op::Compare(Comparison::Less, x, z));
    let c = p.c(0.5);
    let f = p.sub(c, less);
    let slanted = iso(&p.done(f), 1.0);
    let roots = all(&slanted, &ray);
    assert!(roots.len() == 2 && (roots[1].t - 3.1).abs() < 1e-14, "{roots:?}");
}

/// Where two branches meet with the same value, nothing jumps: rays that cross there, or run along
/// it, have simple crossings.
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
        assert!(root.kind == RootKind::Simple && root.lo <= t && t <= root.hi, "{origin:?}: {root:?}");
        // Across the bend Newton's steps know the slope only as between 1/2 and 3.
        assert!(root.hi - root.lo < if i == 0 { 1e-10 } else { 1e-14 }, "{root:?}");
    }
    // The choice shortens the tapes of cells on either side.
    let tape = Tape::new(&p.done(f));
    let across = [Interval::new(-1.0, 0.0), Interval::new(0.0, 1.0)];
    for side in across {
        let boxed = [I8::splat(side), I8::splat(Interval::new(0.0, 1.0)), I8::splat(Interval::new(0.0, 1.0))];
        let (_, shorter) = tape.shortened(&boxed, |lane, _| lane == 0);
        assert!(shorter[0].as_ref().is_some_and(|shorter| shorter.len() + 3 <= tape.len()), "{side:?}");
    }
}

/// Sums of integers are exact: rays hit the walls of the checker
/// `mod(floor(x) + floor(y) + 10, 2) = 1/2`, and nothing between them.
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

/// Products of integers are exact, and so are quotients that are integers. Rays hit the walls of
/// `k mod 3 = 0` with `k = floor(x)`, written as `k - 3 floor(k/3)`. That expression is never
/// negative; if it were, the value chosen below zero would fill everything.
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

/// The normal of a wall, where a formula jumps, is that of the operand that decides the side;
/// outward along the ray.
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
                // Stairs also have level steps, which these rays do not hit.
                let off = n - normal * n.dot(normal).signum();
                assert!(off.length() < 1e-12, "{f:?}: {at:?}, expected {normal:?}");
                assert_eq!(n.dot(d).signum(), f64::from(root.sign), "{f:?}: {at:?} {root:?}");
            }
        }
    }
}

/// The fractional part of `x`, from 0 to 1, by each of the operations that can express it.
fn parts(p: &mut Pen, x: NodeId) -> Vec<NodeId> {
    let one = p.c(1.0);
    let floor = p.op(Op::Function(Function::Floor, x));
    let ceil = p.op(Op::Function(Function::Ceil, x));
    let (down, up) = (p.sub(x, floor), p.sub(x, ceil));
    // Valid only above zero.
    let far = p.c(100.0);
    let positive = p.add(x, far);
    let rest = p.op(Op::Rem(positive, one));
    // Of either sign, plus one where it is below zero.
    let signed = p.op(Op::Rem(x, one));
    let more = p.add(signed, one);
    let chosen = p.op(Op::Select([signed, more, signed, signed]));
    vec![down, p.add(up, one), rest, chosen]
}

/// A saw `|frac(x) - 1/2| - y` does not jump where `frac` does: a line hits its teeth and nothing
/// else.
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
                    assert!(
                        held && root.kind == RootKind::Simple,
                        "{which} {y} {slope}: {root:?}, expected {t}"
                    );
                }
            }
        }
    }
}

/// An angle jumps behind the axis, and so does its number of whole turns. A gear of seven teeth,
/// `r + cos(7 (a - 2 pi floor(a / 2 pi))) / 8 = 1`, is continuous there. Rays near its axis hit it
/// twice.
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
    // Near the axis, not through it, since the angle is undefined on it. The last rays cross the
    // place where the angle jumps, inside and outside the gear.
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
        assert!(found.iter().all(|root| root.kind == RootKind::Simple), "{o:?}: {found:?}");
    }
    // On the seam itself the normal is the gear's.
    let ray = Ray::new(Point3::new(-3.0, 0.0, 0.1), Vec3::new(1.0, 0.0, 0.0));
    let found = all(&gear, &ray);
    let at = gear.resolve(&LocalRay::new(&ray), &found[0], Need::ALL);
    assert!((at.ng.to_vec() + Vec3::new(1.0, 0.0, 0.0)).length() < 1e-9, "{at:?} {found:?}");
}

/// Values chosen by a sign: `|x|` as `x < 0 ? -x : x` is nowhere a wall, and three jumps at one
/// place are distinguished.
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
        // Through its centre, where all three choices meet; the crossings lie at the corner or edge
        // of a facet, or in it.
        assert_eq!(found.iter().map(|root| root.sign).collect::<Vec<_>>(), [-1, 1], "{d:?}: {found:?}");
        let l1 = d.abs().dot(Vec3::new(1.0, 1.0, 1.0));
        for (root, t) in found.iter().zip([8.0 - 1.0 / l1, 8.0 + 1.0 / l1]) {
            // t is rounded twice.
            let held = root.lo.next_down() <= t.next_up() && t.next_down() <= root.hi.next_up();
            assert!(held, "{d:?}: {root:?}, expected {t}");
        }
    }
}

/// Two choices by one sign: `a b = 2` on both sides, and -2 between them only if zero belongs to
/// different sides.
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
            assert!(matches!(found[..], [Root { kind: RootKind::Cluster, sign: 0, .. }]), "{found:?}");
            assert!(found[0].lo <= 3.0 && 3.0 <= found[0].hi, "{found:?}");
        } else {
            assert!(found.is_empty(), "{found:?}");
        }
    }
}
