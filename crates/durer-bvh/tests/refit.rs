//! A refitted tree gives the answers of a new one.

mod common;

use common::tree;
use durer_bvh::{Bvh, Corners, CornersOf, Frame, Leaf, Ray64, RefitError, Settings};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Isa, Point3, Ray, Vec3};
use durer_surfaces::{Closest, LocalRay, Surface, Triangle};
use durer_testkit::TestRng;

fn boxes(dice: &mut TestRng, count: usize, size: f64) -> Vec<Aabb> {
    let mut cube = || {
        let centre = Point3::from([0, 1, 2].map(|_| size * (dice.unit() - 0.5)));
        Aabb::centred(centre, Vec3::from([0, 1, 2].map(|_| 0.03 * size * dice.unit())))
    };
    (0..count).map(|_| cube()).collect()
}

#[test]
fn boxes_that_moved_are_found_where_they_are() {
    let mut dice = TestRng::new(21);
    // To larger and smaller units, and to the ends of f64's range.
    for (count, size) in [(1, 1.0), (9, 1e6), (700, 1e-9), (20_000, 3.0), (700, 1e300), (700, 1e-305)] {
        let (mut tree, order) = tree(&boxes(&mut dice, count, 1.0));
        let moved = boxes(&mut dice, count, size);
        let place = |_: u32, slot: u32| moved[order[slot as usize] as usize];
        tree.refit(place, &[None]).unwrap();
        tree.validate(place).unwrap_or_else(|e| panic!("{count}, {size}: {e}"));
        for (i, b) in moved.iter().enumerate().step_by(1 + count / 300) {
            let target = Point3::from([0, 1, 2].map(|i| b.min[i] + dice.unit() * (b.max[i] - b.min[i])));
            let origin = Point3::from([0, 1, 2].map(|_| size * (dice.unit() - 0.5)));
            let direction = (target - origin) / size;
            if direction == Vec3::ZERO {
                continue;
            }
            // The rounding of the direction to the target is far below the errors.
            let direction = direction.scale2(-exponent(direction.max_abs()));
            let line = Ray64 {
                origin,
                direction,
                origin_error: Vec3::from([1e-12 * size; 3]),
                direction_error: Vec3::from([1e-9; 3]),
                t_min: f64::NEG_INFINITY,
                t_max: f64::INFINITY,
                inner: (f64::NEG_INFINITY, f64::INFINITY),
            };
            let holds =
                |leaf: Leaf| (leaf.first..leaf.first + leaf.count).any(|s| order[s as usize] == i as u32);
            assert!(tree.any(Isa::detect(), &line, |_| true, holds));
        }
    }
}

fn triangles(dice: &mut TestRng, count: usize, size: f64) -> Vec<Corners> {
    let mut corner = |about: Point3, r: f64| about + Vec3::from([0, 1, 2].map(|_| r * (dice.unit() - 0.5)));
    let mut one = || {
        let a = corner(Point3::ORIGIN, size);
        [a, corner(a, 0.2 * size), corner(a, 0.2 * size)]
    };
    (0..count).map(|_| one()).collect()
}

fn around(v: Corners) -> Aabb {
    Aabb::from_points(v)
}

/// The first hit of a ray among some triangles.
fn meet(shape: &[Corners], numbers: impl Iterator<Item = u32>, ray: &LocalRay<'_>) -> Option<(f64, u32)> {
    let root = |n: u32| {
        let mut sink = Closest::default();
        Triangle::known(shape[n as usize]).roots(ray, &mut sink);
        sink.root.map(|root| (root.t, n))
    };
    numbers.filter_map(root).min_by(|a, b| a.partial_cmp(b).unwrap())
}

fn closest(tree: &Bvh, order: &[u32], shape: &[Corners], ray: &Ray) -> Option<(f64, u32)> {
    let local = LocalRay::new(ray);
    let line = Ray64 {
        origin: ray.origin,
        direction: ray.direction.scale2(-exponent(ray.direction.max_abs())),
        origin_error: Vec3::ZERO,
        direction_error: Vec3::ZERO,
        t_min: 0.0,
        t_max: f64::INFINITY,
        inner: (0.0, f64::INFINITY),
    };
    let mut best: Option<(f64, u32)> = None;
    tree.closest(
        Isa::detect(),
        &line,
        |_| true,
        |leaf| {
            let held = (leaf.first..leaf.first + leaf.count).map(|slot| order[slot as usize]);
            let found = meet(shape, held, &local);
            best = [best, found].into_iter().flatten().min_by(|a, b| a.partial_cmp(b).unwrap());
            best.map_or(f64::INFINITY, |(t, _)| scale2(t, exponent(ray.direction.max_abs())).next_up())
        },
    );
    best
}

#[test]
fn triangles_that_moved_are_met_where_they_are() {
    let mut dice = TestRng::new(22);
    // With corners that f32 holds exactly, and rounded.
    for (count, size, is_held) in [(1, 1.0, false), (300, 1.0, true), (300, 1e5, false), (3000, 0.1, true)] {
        let mut shape = |size: f64| {
            let mut shape = triangles(&mut dice, count, size);
            if is_held {
                let round = |v: Point3| v.map(|x| f64::from(x as f32));
                shape.iter_mut().for_each(|v| *v = v.map(round));
            }
            shape
        };
        let (old, new) = (shape(1.0), shape(size));
        let frame = Frame::around(&old.iter().map(|v| around(*v)).fold(Aabb::EMPTY, Aabb::union));
        let entries = old.iter().enumerate().map(|(i, v)| frame.entry(&around(*v), 0, i as u32)).collect();
        let was = |index: u32| old[index as usize];
        let (mut tree, order) = Bvh::build(&frame, entries, &[Some(&was)], &Settings::GOOD);
        let order = &order[0];
        let is = |slot: u32| new[order[slot as usize] as usize];
        tree.refit(|_, slot| around(is(slot)), &[Some(&is)]).unwrap();
        tree.validate(|_, slot| around(is(slot))).unwrap();
        let mut met = 0;
        for i in 0..3000 {
            let origin = Point3::from([0, 1, 2].map(|_| 2.0 * size * (dice.unit() - 0.5)));
            // Half of the rays aim at a triangle.
            let direction = if i % 2 == 0 {
                let [a, b, c] = dice.pick(&new);
                a.lerp(b.lerp(c, 0.5), 0.5) - origin
            } else {
                Vec3::from([0, 1, 2].map(|_| dice.unit() - 0.5))
            };
            let ray = Ray::new(origin, direction);
            let expected = meet(&new, 0..count as u32, &LocalRay::new(&ray));
            assert_eq!(closest(&tree, order, &new, &ray), expected);
            met += usize::from(expected.is_some());
        }
        assert!(met > 0);
        // A refit back gives the same tree, but for rounding.
        let back = |slot: u32| old[order[slot as usize] as usize];
        let mut again = tree.clone();
        again.refit(|_, slot| around(back(slot)), &[Some(&back)]).unwrap();
        let (built, _) = Bvh::build(
            &frame,
            old.iter().enumerate().map(|(i, v)| frame.entry(&around(*v), 0, i as u32)).collect(),
            &[Some(&was)],
            &Settings::GOOD,
        );
        assert!(again == built);
    }
}

#[test]
fn several_kinds_go_and_come_back() {
    let mut dice = TestRng::new(24);
    // Kinds of boxes and of triangles, and an empty kind.
    let kinds: [(usize, bool); 6] = [(60, false), (500, true), (0, true), (3, false), (90, true), (0, false)];
    let mut scene = |size: f64| kinds.map(|(count, _)| triangles(&mut dice, count, size));
    let (old, new) = (scene(1.0), scene(40.0));
    let all = old.iter().flatten().map(|v| around(*v)).fold(Aabb::EMPTY, Aabb::union);
    let frame = Frame::around(&all);
    let entry = |kind: usize, (i, v): (usize, &Corners)| frame.entry(&around(*v), kind as u32, i as u32);
    let entries =
        old.iter().enumerate().flat_map(|(kind, list)| list.iter().enumerate().map(move |v| entry(kind, v)));
    let was = [0, 1, 2, 3, 4, 5].map(|kind: usize| {
        let list = &old[kind];
        move |i: u32| list[i as usize]
    });
    let shapes: Vec<Option<CornersOf<'_>>> =
        was.iter().zip(kinds).map(|(of, (_, flat))| flat.then_some(of as CornersOf<'_>)).collect();
    let (built, order) = Bvh::build(&frame, entries.collect(), &shapes, &Settings::GOOD);
    let mut moved = built.clone();
    for list in [&new, &old] {
        let is = [0, 1, 2, 3, 4, 5].map(|kind: usize| {
            let order = &order[kind];
            move |slot: u32| list[kind][order[slot as usize] as usize]
        });
        let shapes: Vec<Option<CornersOf<'_>>> =
            is.iter().zip(kinds).map(|(of, (_, flat))| flat.then_some(of as CornersOf<'_>)).collect();
        let place = |kind: u32, slot: u32| around(is[kind as usize](slot));
        moved.refit(place, &shapes).unwrap();
        moved.validate(place).unwrap();
        assert!((moved == built) == core::ptr::eq(list, &old));
    }
}

#[test]
fn what_no_box_holds_is_named_and_changes_nothing() {
    let mut dice = TestRng::new(23);
    let places = boxes(&mut dice, 100, 1.0);
    let (mut tree, order) = tree(&places);
    let before = tree.clone();
    for lost in [Aabb::EMPTY, Aabb::UNBOUNDED] {
        let place = |_: u32, slot: u32| if slot == 7 { lost } else { places[order[slot as usize] as usize] };
        assert_eq!(tree.refit(place, &[None]), Err(RefitError::Unbounded { kind: 0, slot: 7 }));
        assert!(tree == before);
    }
}
