//! Any boxes make a valid tree, and the same tree on any number of threads.

mod common;

use common::{QUALITIES, tree, tree_of};
use durer_bvh::{Bvh, Corners, Frame, Settings};
use durer_math::{Aabb, Isa, Point3, Vec3};
use durer_testkit::TestRng;

fn assert_valid(boxes: &[Aabb]) -> Bvh {
    let [_, good, _] = QUALITIES.map(|settings| assert_valid_as(boxes, &settings));
    good
}

fn assert_valid_as(boxes: &[Aabb], settings: &Settings) -> Bvh {
    let (tree, order) = tree_of(boxes, settings);
    tree.validate(|_, slot| boxes[order[slot as usize] as usize]).unwrap_or_else(|e| panic!("{e}"));
    let stats = tree.stats();
    assert_eq!(stats.entries, boxes.len(), "{settings:?}");
    assert!(stats.depth <= 36, "depth {}", stats.depth);
    tree
}

fn cube(x: f64, y: f64, z: f64, r: f64) -> Aabb {
    Aabb::centred(Point3::new(x, y, z), Vec3::new(r, r, r))
}

#[test]
fn nothing_and_little() {
    let (tree, order) = tree(&[]);
    assert!(tree.is_empty() && order.is_empty() && tree.bounds() == Aabb::EMPTY);
    assert_eq!(tree.validate(|_, _| Aabb::EMPTY), Ok(()));
    assert_eq!(tree.stats().nodes, 0);
    for n in 1..40 {
        let boxes: Vec<_> = (0..n).map(|i| cube(f64::from(i * i), 0.0, 0.0, 1.0)).collect();
        let tree = assert_valid(&boxes);
        assert!(tree.bounds().encloses(&boxes[0]));
    }
}

#[test]
fn a_million_identical_boxes() {
    let tree = assert_valid(&vec![cube(1.0, 2.0, 3.0, 0.5); 1_000_000]);
    assert!(tree.stats().depth <= 8, "{:?}", tree.stats());
}

#[test]
fn a_hundred_thousand_nested_boxes() {
    // Each box is half as large as the one before: the heuristic splits off one at a time until the
    // exponents end.
    let boxes: Vec<_> =
        (0..100_000).map(|i| cube(0.0, 0.0, 0.0, 1.5_f64.powf_by_squaring(-(i % 1700)))).collect();
    assert_valid(&boxes);
}

#[test]
fn geometric_rows_do_not_grow_deep() {
    // x = 2^i: a tree by area alone would degenerate to a list.
    let boxes: Vec<_> = (-1000..1000)
        .map(|i| {
            let x = 2.0_f64.powf_by_squaring(i);
            Aabb::new(Point3::new(x, x, x), Point3::new(1.5 * x, 1.5 * x, 1.5 * x))
        })
        .collect();
    assert_valid(&boxes);
}

trait Power {
    fn powf_by_squaring(self, n: i32) -> f64;
}

impl Power for f64 {
    fn powf_by_squaring(self, n: i32) -> f64 {
        let base = if n < 0 { 1.0 / self } else { self };
        (0..n.abs()).fold(1.0, |x, _| x * base)
    }
}

#[test]
fn flat_straight_and_pointlike() {
    let mut dice = TestRng::new(5);
    for flat in 1..8_u64 {
        let boxes: Vec<_> = (0..5000)
            .map(|_| {
                let c = [0, 1, 2].map(|i| if flat >> i & 1 == 1 { 3.0 } else { dice.unit() });
                let r = if flat == 7 { 0.0 } else { 0.01 * dice.unit() };
                let half = [0, 1, 2].map(|i| if flat >> i & 1 == 1 { 0.0 } else { r });
                Aabb::centred(Point3::from(c), Vec3::from(half))
            })
            .collect();
        assert_valid(&boxes);
    }
}

#[test]
fn huge_and_tiny_extents() {
    for size in [f64::MAX, 1e300, 1e-300, 1e-310, 5e-324] {
        let boxes = [
            Aabb::new(Point3::new(-size, -size, -size), Point3::ORIGIN),
            Aabb::new(Point3::ORIGIN, Point3::new(size, size, size)),
            Aabb::new(Point3::new(size, 0.0, 0.0), Point3::new(size, size, 0.0)),
        ];
        assert_valid(&boxes);
    }
}

#[test]
fn leaves_hold_one_kind() {
    let mut dice = TestRng::new(6);
    for kinds in [1, 2, 3, 40] {
        // All entries at few places, so that kinds must be separated where boxes cannot be.
        let count = 4000;
        let boxes: Vec<_> = (0..count).map(|_| cube(dice.below(9) as f64, 0.0, 0.0, 0.6)).collect();
        let kind: Vec<_> = (0..count).map(|_| dice.below(kinds) as u32).collect();
        let frame = Frame::around(&boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union));
        for settings in QUALITIES {
            let entries = (0..count).map(|i| frame.entry(&boxes[i], kind[i], i as u32)).collect();
            let (tree, order) = Bvh::build(&frame, entries, &vec![None; kinds as usize + 2], &settings);
            tree.validate(|k, slot| {
                let index = order[k as usize][slot as usize] as usize;
                assert_eq!(kind[index], k);
                boxes[index]
            })
            .unwrap_or_else(|e| panic!("{e}"));
            let held: usize = order.iter().map(Vec::len).sum();
            assert_eq!(held, count);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let mut dice = TestRng::new(7);
    let boxes: Vec<_> =
        (0..120_000).map(|_| cube(dice.unit(), dice.unit(), dice.unit(), 0.02 * dice.unit())).collect();
    assert_valid(&boxes);
    let slivers = slivers(&mut dice, 60_000);
    let bounds = |n: usize| Aabb::from_points(slivers[n]);
    let frame = Frame::around(&(0..slivers.len()).map(bounds).fold(Aabb::EMPTY, Aabb::union));
    let corners = |n: u32| slivers[n as usize];
    for settings in QUALITIES {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let entries = (0..slivers.len()).map(|n| frame.entry(&bounds(n), 0, n as u32)).collect();
            pool.install(|| {
                (tree_of(&boxes, &settings), Bvh::build(&frame, entries, &[Some(&corners)], &settings))
            })
        };
        let one = on(1);
        for threads in [2, 3, 8] {
            assert!(on(threads) == one, "{settings:?}: {threads} threads build another tree");
        }
    }
}

/// Small triangles, and some large and thin ones through all of them.
fn slivers(dice: &mut TestRng, count: usize) -> Vec<Corners> {
    let mut point =
        |about: Point3, size: f64| about + Vec3::from([0, 1, 2].map(|_| size * (dice.unit() - 0.5)));
    let mut one = |n: usize| {
        let a = point(Point3::ORIGIN, 1.0);
        [a, point(a, 0.02), if n.is_multiple_of(16) { point(a, 2.0) } else { point(a, 0.02) }]
    };
    (0..count).map(&mut one).collect()
}

#[test]
fn parts_of_triangles_are_held_by_the_boxes_of_their_leaves() {
    let mut dice = TestRng::new(9);
    // As f64 and as f32; also where scaling is inexact, or surfaces are too small for f32, so that
    // the triangles are not split.
    for (is_held, size) in
        [(false, 1.0), (true, 1.0), (true, 1e30), (false, 1e-300), (false, 1e-315), (false, 1e308)]
    {
        let mut slivers = slivers(&mut dice, 5000);
        let round = |x: f64| if is_held { f64::from(x as f32) } else { x };
        slivers
            .iter_mut()
            .for_each(|v| *v = v.map(|p| Point3::from(p.map(round).to_array().map(|x| x * size))));
        let bounds = |n: u32| Aabb::from_points(slivers[n as usize]);
        let frame = Frame::around(&(0..5000).map(bounds).fold(Aabb::EMPTY, Aabb::union));
        let corners = |n: u32| slivers[n as usize];
        let entries = (0..5000).map(|n| frame.entry(&bounds(n), 0, n)).collect();
        let (mut tree, order) = Bvh::build(&frame, entries, &[Some(&corners)], &Settings::BEST);
        let place = |_: u32, slot: u32| bounds(order[0][slot as usize]);
        tree.validate(place).unwrap_or_else(|e| panic!("{size}: {e}"));
        let mut slots = order[0].clone();
        slots.sort_unstable();
        assert!(slots.iter().copied().eq(0..5000));
        let more = tree.stats().entries - 5000;
        assert!(more <= 5000 / 4 && (more > 500 || size < 1e-200), "{size}: {more} references more");
        // A triangle that is elsewhere is not covered, whether it is in one leaf or in several.
        for lost in [0, 4999] {
            let elsewhere = |kind: u32, slot: u32| {
                let b = place(kind, slot);
                if slot == lost { Aabb::new(b.min - Vec3::X * size, b.max - Vec3::X * size) } else { b }
            };
            assert!(tree.validate(elsewhere).is_err());
        }
        // After a refit leaves hold whole triangles, which must be covered, too.
        tree.refit(place, &[Some(&|slot| corners(order[0][slot as usize]))]).unwrap();
        tree.validate(place).unwrap_or_else(|e| panic!("{size}: {e}"));
    }
}

#[test]
fn a_broken_tree_is_found_out() {
    let boxes: Vec<_> = (0..100).map(|i| cube(f64::from(i), 0.0, 0.0, 0.4)).collect();
    let (tree, order) = tree(&boxes);
    // Validation detects an entry that is outside its leaf.
    let moved = |_: u32, slot: u32| {
        let b = boxes[order[slot as usize] as usize];
        if slot == 50 { Aabb::new(b.min, b.max + Vec3::Y) } else { b }
    };
    assert!(tree.validate(moved).is_err());
}

#[test]
fn the_story_is_the_traversal() {
    let mut dice = TestRng::new(8);
    let boxes: Vec<_> = (0..3000).map(|_| cube(dice.unit(), dice.unit(), dice.unit(), 0.03)).collect();
    let (tree, _) = tree(&boxes);
    for _ in 0..200 {
        let line = durer_bvh::Ray64 {
            origin: Point3::new(dice.unit(), dice.unit(), -1.0),
            direction: Vec3::new(dice.unit() - 0.5, dice.unit() - 0.5, 1.0),
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min: 0.0,
            t_max: f64::INFINITY,
            inner: (0.0, f64::INFINITY),
        };
        let limit = |n: usize| if n > 3 { 1.5 } else { f64::INFINITY };
        for isa in Isa::available().filter(|i| i.path() != durer_math::kernels::Path::Unfused) {
            let mut walked = Vec::new();
            tree.closest(
                isa,
                &line,
                |_| true,
                |leaf| {
                    walked.push(leaf);
                    limit(walked.len())
                },
            );
            let mut told = Vec::new();
            tree.trace(&line, |step| {
                if let durer_bvh::Step::Leaf { leaf, .. } = step {
                    told.push(*leaf);
                }
                limit(told.len())
            });
            assert_eq!(walked, told);
        }
    }
}
