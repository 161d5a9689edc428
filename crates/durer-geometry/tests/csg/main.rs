//! CSG solids against the exact truth.

#[path = "../common/mod.rs"]
mod common;
mod witness;

use common::Draws;
use durer_geometry::{Compound, Geometry};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::laws::exact::{ExactBody, ExactLine, Oracle, Poly, exact3};
use durer_surfaces::{Ellipsoid, LocalPoint, RootKind, Side, Sphere};
use durer_testkit::TestRng;
use witness::{Expr, Leaf, body, random_expr};

fn small(dice: &mut TestRng) -> f64 {
    // Coarse numbers: faces and edges coincide often.
    (1 + dice.below(4)) as f64 * 0.5
}

fn random_leaf(dice: &mut TestRng) -> Leaf {
    let c = dice.grid();
    let c = Point3::new(c.x * 0.5, c.y * 0.5, c.z * 0.5);
    match dice.below(8) {
        0 | 1 => Leaf::Ball(c, small(dice)),
        2 | 3 => {
            let d = Vec3::new(small(dice), small(dice), small(dice));
            Leaf::Block(c, c + d)
        }
        4 => {
            let mut n = Vec3::ZERO;
            n[dice.below(3) as usize] = if dice.below(2) == 0 { 1.0 } else { -1.0 };
            Leaf::Half(n, small(dice) - 1.0)
        }
        5 => Leaf::Rod(c, dice.below(3) as usize, small(dice), small(dice) * 0.5),
        6 => Leaf::General([1.0, 2.0, 1.0, 0.0, 0.5, 0.0, c.x, c.y, 0.0, -1.0]),
        _ => {
            let turned = dice.below(2) == 0;
            let leaf = if dice.below(2) == 0 {
                Leaf::Ball(c, small(dice))
            } else {
                Leaf::Block(c, c + Vec3::new(1.0, 0.5, 1.0))
            };
            if turned { Leaf::Turned(Box::new(leaf)) } else { Leaf::Moved(Box::new(leaf), dice.affine()) }
        }
    }
}

fn random_ray(dice: &mut TestRng) -> Ray {
    let axis = |dice: &mut TestRng| {
        let mut d = Vec3::ZERO;
        d[dice.below(3) as usize] = if dice.below(2) == 0 { 1.0 } else { -1.0 };
        d
    };
    let start = dice.grid();
    let start = Point3::new(start.x * 0.25, start.y * 0.25, start.z * 0.25);
    match dice.below(4) {
        0 => Ray::new(start - axis(dice) * 8.0, dice.vector()),
        1 => {
            let d = axis(dice);
            Ray::new(start - d * 8.0, d)
        }
        2 => Ray::new(dice.point(6.0), start - dice.point(6.0)),
        _ => Ray::new(start, dice.vector()),
    }
}

#[test]
fn random_trees_are_what_their_leaves_say() {
    let mut met = 0;
    for seed in 0..400 {
        let mut dice = TestRng::new(seed);
        let count = 1 + dice.below(7) as usize;
        let leaves: Vec<Leaf> = (0..count).map(|_| random_leaf(&mut dice)).collect();
        let expr = random_expr(&mut dice, 0, count);
        let body = body(leaves, expr);
        for _ in 0..150 {
            met += body.check(&random_ray(&mut dice));
        }
    }
    assert!(met > 5_000, "only {met} crossings");
}

#[test]
fn unions_keep_their_inner_faces() {
    let (mut met, mut met_without) = (0, 0);
    for seed in 0..600 {
        let mut dice = TestRng::new(90_000 + seed);
        let count = 2 + dice.below(7) as usize;
        let leaves: Vec<Leaf> = (0..count).map(|_| random_leaf(&mut dice)).collect();
        let plain = random_expr(&mut dice, 0, count);
        let expr = Expr::AnyWithInner(vec![plain.clone().with_inner_faces(&mut dice)]);
        let (with, without) = (body(leaves.clone(), expr), body(leaves, plain));
        for _ in 0..100 {
            let ray = random_ray(&mut dice);
            let count = with.check(&ray);
            if count > 0 {
                (met, met_without) = (met + count, met_without + without.scene.all(&ray).len());
            }
        }
    }
    assert!(met > 5_000, "only {met} crossings");
    assert!(met > met_without + 500, "{met} crossings with inner faces, {met_without} without");
}

#[test]
fn trees_of_many_leaves_are_what_their_leaves_say() {
    let mut met = 0;
    for seed in 0..16 {
        let mut dice = TestRng::new(7000 + seed);
        // With so many leaves the search goes piece by piece.
        let count = 64 + dice.below(64) as usize;
        let leaves: Vec<Leaf> = (0..count).map(|_| random_leaf(&mut dice)).collect();
        // Rooms side by side in a row of boxes, so that the parts are not all in one place.
        let rooms = |i: usize| {
            Leaf::Block(
                Point3::new(i as f64 * 0.5 - 4.0, -2.0, -2.0),
                Point3::new(i as f64 * 0.5 - 3.0, 2.0, 2.0),
            )
        };
        let mut all = leaves;
        let parts = (0..16).map(|i| {
            all.push(rooms(i));
            let (from, to) = (count * i / 16, count * (i + 1) / 16);
            let inner = random_expr(&mut dice, from, to - from);
            Expr::All(vec![Expr::Leaf(count + i), inner])
        });
        let expr = Expr::Any(parts.collect());
        let body = body(all, expr);
        for _ in 0..150 {
            met += body.check(&random_ray(&mut dice));
        }
    }
    assert!(met > 1_500, "only {met} crossings");
}

/// Every kind of solid once, at places where many of their faces lie in common planes.
fn kinds() -> Vec<Leaf> {
    let p = Point3::new;
    let turn = Affine::rotation_x(0.4).unwrap().then(&Affine::rotation_z(1.1).unwrap()).unwrap();
    let block = Leaf::Block(p(-1.0, -0.5, -1.0), p(1.0, 1.0, 0.5));
    vec![
        Leaf::Ball(p(0.5, 0.0, 0.0), 1.25),
        block.clone(),
        Leaf::Half(Vec3::new(0.0, 1.0, 0.0), 0.25),
        Leaf::Half(Vec3::new(3.0, 4.0, 0.0), 0.5),
        Leaf::Rod(p(0.0, -0.5, 0.0), 1, 1.5, 0.75),
        Leaf::General([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25]),
        Leaf::General([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, -0.5]),
        Leaf::General([0.25, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]),
        Leaf::Moved(Box::new(block), turn),
        Leaf::Moved(Box::new(Leaf::Rod(p(0.0, -0.5, 0.0), 1, 1.5, 0.75)), turn),
        Leaf::Turned(Box::new(Leaf::Ball(p(0.0, 0.0, 0.25), 1.0))),
    ]
}

fn two(a: usize, b: usize) -> (Box<Expr>, Vec<Expr>) {
    (Box::new(Expr::Leaf(a)), vec![Expr::Leaf(b)])
}

#[test]
fn nothing_is_left_of_a_solid_without_itself() {
    for leaf in kinds() {
        let (a, b) = two(0, 1);
        let empty = body(vec![leaf.clone(), leaf], Expr::Minus(a, b));
        let mut dice = TestRng::new(3);
        for _ in 0..300 {
            let ray = random_ray(&mut dice);
            assert_eq!(empty.scene.all(&ray), []);
            assert_eq!(empty.scene.spans(&ray), []);
        }
    }
}

/// The contents of a geometry's hits without the numbers of leaves.
fn told(scene: &Geometry, ray: &Ray) -> Vec<(u64, u64, u64, i8, RootKind)> {
    let bits = |x: f64| x.to_bits();
    scene.all(ray).iter().map(|h| (bits(h.t), bits(h.t_lo), bits(h.t_hi), h.sign, h.kind)).collect()
}

#[test]
fn identities_hold_for_every_pair_of_kinds() {
    let kinds = kinds();
    let mut met = 0;
    for (i, a) in kinds.iter().enumerate() {
        for (j, b) in kinds.iter().enumerate() {
            let leaf = |n: usize| Expr::Leaf(n);
            let not = |e: Expr| Expr::Not(Box::new(e));
            let minus = |x: Expr, y: Expr| Expr::Minus(Box::new(x), vec![y]);
            let (a, b) = (a.clone(), b.clone());
            let alone = body(vec![a.clone()], leaf(0));
            let twice = body(vec![a.clone(), a.clone()], Expr::Any(vec![leaf(0), leaf(1)]));
            let both = body(vec![a.clone(), b.clone()], Expr::All(vec![leaf(0), leaf(1)]));
            let less_less =
                body(vec![a.clone(), a.clone(), b.clone()], minus(leaf(0), minus(leaf(1), leaf(2))));
            let either = body(vec![a.clone(), b.clone()], Expr::Any(vec![leaf(0), leaf(1)]));
            let morgan = body(vec![a.clone(), b.clone()], not(Expr::All(vec![not(leaf(0)), not(leaf(1))])));
            let neither = body(vec![a.clone(), b.clone()], not(Expr::Any(vec![leaf(0), leaf(1)])));
            let outside = body(vec![a.clone(), b.clone()], Expr::All(vec![not(leaf(0)), not(leaf(1))]));
            let split = body(
                vec![a.clone(), b.clone(), a.clone(), b.clone()],
                Expr::Any(vec![minus(leaf(0), leaf(1)), Expr::All(vec![leaf(2), leaf(3)])]),
            );
            let mut dice = TestRng::new((i * 100 + j) as u64);
            for _ in 0..60 {
                let ray = random_ray(&mut dice);
                let own = told(&alone.scene, &ray);
                assert_eq!(told(&twice.scene, &ray), own, "A|A = A for {i}: {ray:?}");
                assert_eq!(told(&either.scene, &ray), told(&morgan.scene, &ray), "{i} {j}: {ray:?}");
                assert_eq!(told(&neither.scene, &ray), told(&outside.scene, &ray), "{i} {j}: {ray:?}");
                let met_both = told(&both.scene, &ray);
                assert_eq!(told(&less_less.scene, &ray), met_both, "A-(A-B) = A&B for {i} {j}: {ray:?}");
                let whole = told(&split.scene, &ray);
                // A solid that is cut in two and put together again has no seam.
                let close = either.truth(&ray).is_none();
                assert!(whole == own || close, "(A-B)|(A&B) = A for {i} {j}: {ray:?} {whole:?} {own:?}");
                met += met_both.len() + both.check(&ray) + either.check(&ray);
            }
        }
    }
    assert!(met > 3_000, "only {met} crossings");
}

#[test]
fn bodies_that_touch_fuse() {
    let p = Point3::new;
    let blocks = (0..10).map(|i| Leaf::Block(p(f64::from(i), 0.0, 0.0), p(f64::from(i + 1), 1.0, 1.0)));
    let expr = Expr::Any((0..10).map(Expr::Leaf).collect());
    let row = body(blocks.collect(), expr);
    let through = row.scene.all(&Ray::new(p(-1.0, 0.5, 0.5), Vec3::X));
    assert_eq!(through.iter().map(|h| (h.t, h.sign)).collect::<Vec<_>>(), [(1.0, -1), (11.0, 1)]);
    // Along the seam, where two blocks have a common edge, and down on it.
    assert_eq!(row.scene.all(&Ray::new(p(3.0, 5.0, 0.5), -Vec3::Y)).len(), 2);
    assert_eq!(row.scene.all(&Ray::new(p(3.0, 5.0, 0.5), Vec3::new(0.25, -1.0, 0.0))).len(), 2);
    // A ray that leaves the seam does not hit it again.
    let ray = Ray::new(p(3.0, 5.0, 0.5), -Vec3::Y);
    let hit = row.scene.closest(&ray).unwrap();
    let point = row.scene.resolve(&ray, &hit);
    assert!(!row.scene.any(&point.spawn(Vec3::new(0.3, 1.0, 0.2))));
    assert_eq!(row.scene.all(&point.spawn(-Vec3::Y)).len(), 1);
}

#[test]
fn differences_nest_a_hundred_deep() {
    let p = Point3::new;
    // An onion: ((((b0 - b1) | b2) - b3) ... from the outside in.
    let mut csg = Compound::builder();
    let ball = |i: u32| Sphere::new(Point3::ORIGIN, f64::from(101 - i)).unwrap();
    let mut whole = csg.leaf(ball(0)).unwrap();
    for i in 1..=100 {
        let next = csg.leaf(ball(i)).unwrap();
        whole = if i % 2 == 1 { csg.difference(whole, [next]) } else { csg.union([whole, next]) };
    }
    let scene = Geometry::builder().with_compound(csg.build(whole).unwrap()).build().unwrap();
    let hits = scene.all(&Ray::new(p(-200.0, 0.0, 0.0), Vec3::X));
    assert_eq!(hits.len(), 202);
    assert!(hits.iter().enumerate().all(|(i, h)| h.sign == if i % 2 == 0 { -1 } else { 1 }));
    assert_eq!(scene.side(p(0.5, 0.0, 0.0)), Side::In);
    assert_eq!(scene.side(p(1.5, 0.0, 0.0)), Side::Out);
    // A - (B - (C - ...)), from the inside out, is the same set.
    let mut csg = Compound::builder();
    let mut whole = csg.leaf(ball(100)).unwrap();
    for i in (0..100).rev() {
        let outer = csg.leaf(ball(i)).unwrap();
        whole = csg.difference(outer, [whole]);
    }
    let scene = Geometry::builder().with_compound(csg.build(whole).unwrap()).build().unwrap();
    assert_eq!(scene.all(&Ray::new(p(-200.0, 0.0, 0.0), Vec3::X)).len(), 202);
}

#[test]
fn points_are_in_where_the_expression_says() {
    for seed in 0..200 {
        let mut dice = TestRng::new(seed + 5000);
        let count = 1 + dice.below(6) as usize;
        let leaves: Vec<Leaf> = (0..count).map(|_| random_leaf(&mut dice)).collect();
        let expr = random_expr(&mut dice, 0, count);
        let body = body(leaves, expr);
        for _ in 0..40 {
            let q = dice.point(3.0);
            let at = exact3(q.to_array());
            let bits = body.witnesses.iter().zip(&body.leaves);
            let bits: Vec<bool> = bits.map(|(w, l)| w.side(&at).unwrap().is_lt() != l.is_turned()).collect();
            let want = if body.expr.holds(&bits) { Side::In } else { Side::Out };
            assert_eq!(body.scene.side(q), want);
        }
    }
}

#[test]
fn rays_leave_a_body_on_the_side_they_are_asked_for() {
    let mut left = 0;
    for seed in 0..200 {
        let mut dice = TestRng::new(seed + 900);
        let count = 2 + dice.below(5) as usize;
        let leaves: Vec<Leaf> = (0..count).map(|_| random_leaf(&mut dice)).collect();
        let expr = random_expr(&mut dice, 0, count);
        let body = body(leaves, expr);
        for _ in 0..30 {
            let ray = random_ray(&mut dice);
            let (Some(truth), hits) = (body.truth(&ray), body.scene.all(&ray)) else { continue };
            for (i, hit) in hits.iter().enumerate() {
                let point = body.scene.resolve(&ray, hit);
                let ahead = point.spawn(ray.direction);
                // The rest of the ray: the crossings behind this one, each once.
                let rest = body.scene.all(&ahead);
                let far = truth
                    .get(i + 1)
                    .is_none_or(|c| (c.t.about(100).to_f64() - hit.t) * ray.direction.length() > 1e-6);
                let slant = point.ng.to_vec().dot(ray.direction).abs() / ray.direction.length();
                // On an edge of a leaf its own faces disagree about the side.
                let line = ExactLine::new(&ray);
                let on = |w: &ExactBody| {
                    w.faces.iter().filter(|f| truth[i].t.sign_of(&f.along(&line)).is_eq()).count()
                };
                let edge = on(&body.witnesses[hit.primitive.0 as usize]) > 1;
                // A ray in a face of a leaf starts beside it.
                let in_face = |w: &ExactBody| {
                    w.faces.iter().any(|f| {
                        let Poly { a, b, c } = f.along(&line);
                        [a, b, c].iter().all(|x| x.sign().is_eq())
                    })
                };
                let in_face = body.witnesses.iter().any(in_face);
                if far && slant > 1e-3 && !edge && !in_face {
                    let signs =
                        |hits: &[durer_geometry::Hit]| hits.iter().map(|h| h.sign).collect::<Vec<_>>();
                    assert_eq!(
                        signs(&rest),
                        signs(&hits[i + 1..]),
                        "{ray:?} {hits:?} {rest:?} {:?} {:?}",
                        body.expr,
                        body.leaves
                    );
                    left += 1;
                }
            }
        }
    }
    assert!(left > 500, "only {left} rays");
}

#[test]
fn a_touch_does_not_tell_where_a_ray_starts() {
    // The ray is in the first solid (the outside of an infinite cylinder), touches its border and
    // stays inside; so what is in the solid is not visible.
    let outside = Leaf::General([-1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let ball = Leaf::Ball(Point3::new(1.0, -3.0, 0.0), 0.5);
    let union = body(vec![outside, ball], Expr::Any(vec![Expr::Leaf(0), Expr::Leaf(1)]));
    let ray = Ray::new(Point3::new(1.0, -8.0, 0.0), Vec3::Y);
    let signs: Vec<i8> = union.scene.all(&ray).iter().map(|h| h.sign).collect();
    assert!(signs.iter().all(|&s| s == 0), "{signs:?}");
    assert_eq!(union.scene.spans(&ray).len(), 1);
}

#[test]
fn local_points_are_asked_too() {
    let mut csg = Compound::builder();
    let a = csg.leaf(Sphere::new(Point3::ORIGIN, 1.0).unwrap()).unwrap();
    let b = csg.leaf(Ellipsoid::new(0.5, 0.5, 2.0).unwrap()).unwrap();
    let whole = csg.difference(a, [b]);
    let body = csg.build(whole).unwrap();
    assert_eq!(body.side(&LocalPoint::new(Point3::new(0.75, 0.0, 0.0))), Side::In);
    assert_eq!(body.side(&LocalPoint::new(Point3::new(0.5, 0.0, 0.0))), Side::On);
    assert_eq!(body.side(&LocalPoint::new(Point3::ORIGIN)), Side::Out);
}
