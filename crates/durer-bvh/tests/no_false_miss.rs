//! No box that the exact ray meets is missed.
//!
//! Rays are aimed, exactly, at points of boxes: all coordinates are integers below 2^53, and the
//! origin is `target - m d` for integers `m` and `d`, without rounding, so the exact ray is in the
//! box at `t = m`. Targets are corners, edges, faces and interiors; directions have components that
//! are zero or one unit; origins are near, on faces, and far; whole scenes are scaled by powers of
//! two.

mod common;

use common::{Draws, tree};
use durer_bvh::{Bvh, Ray64};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Isa, Point3, Vec3};
use durer_testkit::TestRng;

/// Integer coordinates.
type Place = [i64; 3];

fn point(p: Place, k: i32) -> Point3 {
    Point3::from(p.map(|x| scale2(x as f64, k)))
}

/// Boxes of all sizes, some flat in one or two directions, some points.
fn boxes(dice: &mut TestRng, grid: i64) -> Vec<(Place, Place)> {
    let most = [1, 2, 60][dice.below(3) as usize];
    let count = 1 + dice.below(most);
    let flat = dice.below(8);
    let one = |dice: &mut TestRng| {
        let size = 1 + dice.below(grid as u64) as i64 / (1 << dice.below(20));
        let lo: Place = core::array::from_fn(|axis| if flat >> axis & 1 == 1 { 7 } else { dice.about(grid) });
        let hi = core::array::from_fn(|axis| {
            let grows = flat >> axis & 1 == 0 && dice.below(4) > 0;
            if grows { lo[axis] + dice.below(size as u64 + 1) as i64 } else { lo[axis] }
        });
        (lo, hi)
    };
    (0..count).map(|_| one(dice)).collect()
}

/// Half of the scenes are far from the origin.
fn moved(dice: &mut TestRng, boxes: Vec<(Place, Place)>) -> Vec<(Place, Place)> {
    let place = common::place(dice, 51);
    let moved = |p: Place| [0, 1, 2].map(|i| p[i] + place[i]);
    boxes.into_iter().map(|(lo, hi)| (moved(lo), moved(hi))).collect()
}

/// A point of a box: on each axis an end or a point between.
fn aim(dice: &mut TestRng, (lo, hi): (Place, Place)) -> Place {
    core::array::from_fn(|i| match dice.below(3) {
        0 => lo[i],
        1 => hi[i],
        _ => lo[i] + dice.below((hi[i] - lo[i]) as u64 + 1) as i64,
    })
}

/// A direction and a number of steps along it that lead to the target from an exact origin.
fn approach(dice: &mut TestRng, target: Place) -> Option<(Place, i64)> {
    let size = [1, 9, 1000, 1 << 20][dice.below(4) as usize];
    let d: Place = core::array::from_fn(|_| match dice.below(6) {
        0 => 0,
        1 => dice.about(1),
        _ => dice.about(size),
    });
    let bits = dice.below(51);
    let steps = 1 + dice.below(1 << bits) as i64;
    let fits = |i: usize| {
        let start = i128::from(target[i]) - i128::from(d[i]) * i128::from(steps);
        start.abs() < 1 << 53
    };
    (d != [0; 3] && (0..3).all(fits)).then_some((d, steps))
}

/// The ray, and its `t` at the target.
fn line(target: Place, (d, steps): (Place, i64), k: i32) -> (Ray64, f64) {
    let direction = Vec3::from(d.map(|x| x as f64));
    let e = exponent(direction.max_abs());
    let line = Ray64 {
        origin: point([0, 1, 2].map(|i| target[i] - d[i] * steps), k),
        direction: direction.map(|x| scale2(x, -e)),
        origin_error: Vec3::ZERO,
        direction_error: Vec3::ZERO,
        t_min: 0.0,
        t_max: f64::INFINITY,
        inner: (0.0, f64::INFINITY),
    };
    (line, scale2(steps as f64, e + k))
}

/// Checks that all queries, on all paths, visit the leaf that holds box `wanted`.
fn assert_shown(tree: &Bvh, order: &[u32], line: &Ray64, t_hit: f64, wanted: u32) {
    let slot = order.iter().position(|&i| i == wanted).expect("each box is in a leaf") as u32;
    for isa in Isa::available() {
        let ranges = [
            (0.0, f64::INFINITY),
            (0.0, t_hit),
            (t_hit, t_hit),
            (t_hit, f64::INFINITY),
            (f64::NEG_INFINITY, t_hit),
        ];
        for (t_min, t_max) in ranges {
            let line = Ray64 { t_min, t_max, ..*line };
            let found =
                tree.any(isa, &line, |_| false, |leaf| (leaf.first..leaf.first + leaf.count).contains(&slot));
            assert!(found, "{isa:?}: box {wanted} is missed by {line:?}, which is in it at {t_hit}");
            let mut found = false;
            tree.closest(
                isa,
                &line,
                |_| true,
                |leaf| {
                    found |= (leaf.first..leaf.first + leaf.count).contains(&slot);
                    t_hit
                },
            );
            assert!(found, "{isa:?}: box {wanted} is missed by {line:?} with the limit {t_hit}");
        }
    }
}

#[test]
fn rays_aimed_at_boxes_meet_them() {
    let mut dice = TestRng::new(1);
    let mut rays = 0;
    for round in 0..6000 {
        let grid = [8, 1000, 1 << 24, 1 << 40][round % 4];
        let scale = [0, -40, 300, -700, 900][round % 5];
        let boxes = boxes(&mut dice, grid);
        let boxes = moved(&mut dice, boxes);
        let f64_boxes: Vec<Aabb> =
            boxes.iter().map(|(lo, hi)| Aabb::new(point(*lo, scale), point(*hi, scale))).collect();
        let (tree, order) = tree(&f64_boxes);
        tree.validate(|_, slot| f64_boxes[order[slot as usize] as usize]).expect("a valid tree");
        for _ in 0..20 {
            let wanted = dice.below(boxes.len() as u64) as usize;
            let target = aim(&mut dice, boxes[wanted]);
            if let Some(way) = approach(&mut dice, target) {
                let (line, t_hit) = line(target, way, scale);
                assert_shown(&tree, &order, &line, t_hit, wanted as u32);
                assert!(line.may_meet(&f64_boxes[wanted]));
                rays += 1;
            }
        }
    }
    assert!(rays > 50_000, "{rays}");
}

/// Rays from far outside of a tree that has no extent.
#[test]
fn rays_from_anywhere_meet_a_point() {
    for k in [0, 30, 60, 100, 300, 600, 1000] {
        for place in [0.0, 7.0] {
            let p = Point3::new(place, 0.0, place);
            let (tree, order) = tree(&[Aabb::from_points([p])]);
            let distance = scale2(1.0, k);
            if place != 0.0 && k > 50 {
                continue;
            }
            let line = Ray64 {
                origin: Point3::new(place + distance, 0.0, place),
                direction: Vec3::new(-1.0, 0.0, 0.0),
                origin_error: Vec3::ZERO,
                direction_error: Vec3::ZERO,
                t_min: 0.0,
                t_max: f64::INFINITY,
                inner: (0.0, f64::INFINITY),
            };
            assert_shown(&tree, &order, &line, distance, 0);
        }
    }
}

#[test]
fn rays_along_edges_and_in_faces_meet_them() {
    let mut dice = TestRng::new(2);
    for _ in 0..6000 {
        let boxes = boxes(&mut dice, 64);
        let boxes = moved(&mut dice, boxes);
        let f64_boxes: Vec<Aabb> =
            boxes.iter().map(|(lo, hi)| Aabb::new(point(*lo, -3), point(*hi, -3))).collect();
        let (tree, order) = tree(&f64_boxes);
        let wanted = dice.below(boxes.len() as u64) as usize;
        let target = aim(&mut dice, boxes[wanted]);
        let axis = dice.below(3) as usize;
        let mut d = [0; 3];
        d[axis] = 1;
        let (line, t_hit) = line(target, (d, [1, 63, 1 << 20, (1 << 50) + 1][dice.below(4) as usize]), -3);
        // Zeros of both signs.
        for minus in [1.0, -1.0] {
            let direction = line.direction.map(|x| if x == 0.0 { 0.0 * minus } else { x });
            assert_shown(&tree, &order, &Ray64 { direction, ..line }, t_hit, wanted as u32);
        }
    }
}

#[test]
fn rays_that_are_known_within_errors_meet_what_the_exact_ones_meet() {
    let mut dice = TestRng::new(3);
    for _ in 0..3000 {
        let boxes = boxes(&mut dice, 1000);
        let boxes = moved(&mut dice, boxes);
        let f64_boxes: Vec<Aabb> =
            boxes.iter().map(|(lo, hi)| Aabb::new(point(*lo, -10), point(*hi, -10))).collect();
        let (tree, order) = tree(&f64_boxes);
        let wanted = dice.below(boxes.len() as u64) as usize;
        let target = aim(&mut dice, boxes[wanted]);
        let Some(way) = approach(&mut dice, target) else { continue };
        let (line, t_hit) = line(target, way, -10);
        let size = [0.0, 1e-12, 1e-6, 1e-3, 10.0][dice.below(5) as usize];
        let mut off = |by: f64| Vec3::from([0, 1, 2].map(|_| (2.0 * dice.unit() - 1.0) * by));
        let (do_, dd) = (off(size), off(size / t_hit));
        let direction = line.direction + dd;
        let e = exponent(direction.max_abs());
        let (direction, dd) = (direction.map(|x| scale2(x, -e)), dd.map(|x| scale2(x, -e)));
        let room = Vec3::new(1e-13, 1e-13, 1e-13);
        let known = Ray64 {
            origin: line.origin + do_,
            direction,
            // These errors include the rounding of the sums.
            origin_error: do_.abs() + room * line.origin.to_vec().max_abs().max(1.0),
            direction_error: dd.abs() + room,
            ..line
        };
        assert_shown(&tree, &order, &known, scale2(t_hit, e), wanted as u32);
        assert!(known.may_meet(&f64_boxes[wanted]));
    }
}

#[test]
fn points_are_found_in_their_boxes() {
    let mut dice = TestRng::new(4);
    for round in 0..2000 {
        let scale = [0, -900, 900, -1040][round % 4];
        let boxes = boxes(&mut dice, 1000);
        let boxes = moved(&mut dice, boxes);
        let f64_boxes: Vec<Aabb> =
            boxes.iter().map(|(lo, hi)| Aabb::new(point(*lo, scale), point(*hi, scale))).collect();
        let (tree, order) = tree(&f64_boxes);
        let wanted = dice.below(boxes.len() as u64) as usize;
        let p = point(aim(&mut dice, boxes[wanted]), scale);
        let mut seen = Vec::new();
        let stopped = tree.containing(p, Vec3::ZERO, |leaf| {
            seen.extend((leaf.first..leaf.first + leaf.count).map(|slot| order[slot as usize]));
            false
        });
        assert!(!stopped && seen.contains(&(wanted as u32)));
    }
}

#[test]
fn boxes_far_off_the_ray_are_not_tested() {
    // The test is conservative but not useless: a ray across a row of boxes meets few of them.
    let boxes: Vec<Aabb> = (0..4096)
        .map(|i| Aabb::centred(Point3::new(f64::from(i), 0.0, 0.0), Vec3::new(0.25, 0.25, 0.25)))
        .collect();
    let (tree, _) = tree(&boxes);
    for far in [1.0, 1e6, 1e12] {
        let origin = Point3::new(1234.0, 0.1, far);
        let line = Ray64 {
            origin,
            direction: -Vec3::Z,
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min: 0.0,
            t_max: f64::INFINITY,
            inner: (0.0, f64::INFINITY),
        };
        let mut tested = 0;
        tree.any(
            Isa::detect(),
            &line,
            |_| false,
            |leaf| {
                tested += leaf.count;
                false
            },
        );
        assert!(tested <= 8, "{tested} boxes tested from {far}");
    }
}
