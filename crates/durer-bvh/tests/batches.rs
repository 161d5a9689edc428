//! Many rays at once are shown what each is shown alone, in the same order.

mod common;

use common::Dice;
use durer_bvh::{Bvh, Corners, Frame, Leaf, Line, Rays, Settings};
use durer_math::eft::exponent;
use durer_math::{Aabb, Isa, Point3, Vec3};

/// Boxes and triangles, and the rays to send through them.
struct World {
    tree: Bvh,
    lines: Vec<Option<Line>>,
}

fn point(dice: &mut Dice, size: f64) -> Point3 {
    Point3::new(
        (2.0 * dice.unit() - 1.0) * size,
        (2.0 * dice.unit() - 1.0) * size,
        (2.0 * dice.unit() - 1.0) * size,
    )
}

impl World {
    fn of(seed: u64, boxes: usize, triangles: usize) -> Self {
        let mut dice = Dice(seed);
        let near = |dice: &mut Dice, p: Point3| p + (point(dice, 0.3) - Point3::ORIGIN);
        let corners: Vec<Corners> = (0..triangles)
            .map(|_| {
                let p = point(&mut dice, 1.0);
                [p, near(&mut dice, p), near(&mut dice, p)]
            })
            .collect();
        let mut bounds: Vec<(u32, Aabb)> = corners.iter().map(|&c| (1, Aabb::from_points(c))).collect();
        for _ in 0..boxes {
            let p = point(&mut dice, 1.0);
            bounds.push((0, Aabb::from_points([p, near(&mut dice, p)])));
        }
        let frame = Frame::around(&bounds.iter().fold(Aabb::EMPTY, |all, (_, b)| all.union(*b)));
        let entry = |(i, (kind, b)): (usize, &(u32, Aabb))| frame.entry(b, *kind, i as u32);
        let entries = bounds.iter().enumerate().map(entry).collect();
        let shape = |n: u32| corners[n as usize];
        let (tree, _) = Bvh::build(&frame, entries, &[None, Some(&shape)], &Settings::GOOD);
        let line = |dice: &mut Dice| {
            // From within, from near and from far; some have nothing to look for.
            let size = [0.5, 3.0, 1e6][dice.below(3) as usize];
            let origin = point(dice, size);
            let d = point(dice, 1.0) - origin;
            let d = d.scale2(-exponent(d.max_abs()));
            let error = [0.0, 1e-12][dice.below(2) as usize];
            let t_max = [f64::INFINITY, 1.2][dice.below(2) as usize];
            (dice.below(9) > 0).then_some(Line {
                origin,
                direction: d,
                origin_error: Vec3::new(error, 0.0, error),
                direction_error: Vec3::ZERO,
                t_min: 0.0,
                t_max,
                inner: (0.0, t_max),
            })
        };
        let lines = (0..300).map(|_| line(&mut dice)).collect();
        Self { tree, lines }
    }
}

/// Answers that depend on nothing but ray and leaf.
fn says(ray: usize, leaf: Leaf) -> u64 {
    Dice(ray as u64 ^ u64::from(leaf.first) << 20 ^ u64::from(leaf.kind) << 60).next()
}

fn admits(ray: usize, leaf: Leaf) -> bool {
    says(ray, leaf) & 3 > 0
}

fn limit(ray: usize, leaf: Leaf) -> f64 {
    if says(ray, leaf) & 4 == 0 {
        f64::INFINITY
    } else {
        (says(ray, leaf) >> 11) as f64 / (1_u64 << 52) as f64
    }
}

fn is_hit(ray: usize, leaf: Leaf) -> bool {
    says(ray, leaf) & 24 == 0
}

/// What each ray is shown, and which have found something.
#[derive(Clone, Debug, Default, PartialEq)]
struct Log {
    shown: Vec<Vec<Leaf>>,
    found: Vec<bool>,
}

struct Logging<'a> {
    world: &'a World,
    log: Log,
}

impl Rays<f64> for Logging<'_> {
    fn line(&mut self, ray: usize) -> Option<Line> {
        self.world.lines[ray]
    }

    fn admits(&self, ray: usize, triangle: Leaf) -> bool {
        admits(ray, triangle)
    }

    fn test(&mut self, ray: usize, leaf: Leaf) -> f64 {
        self.log.shown[ray].push(leaf);
        limit(ray, leaf)
    }

    fn found(&mut self, _: usize) {
        unreachable!("the closest is not known before the end");
    }
}

impl Rays<bool> for Logging<'_> {
    fn line(&mut self, ray: usize) -> Option<Line> {
        self.world.lines[ray]
    }

    fn admits(&self, ray: usize, triangle: Leaf) -> bool {
        admits(ray, triangle)
    }

    fn test(&mut self, ray: usize, leaf: Leaf) -> bool {
        self.log.shown[ray].push(leaf);
        is_hit(ray, leaf)
    }

    fn found(&mut self, ray: usize) {
        assert!(!self.log.found[ray], "told once");
        self.log.found[ray] = true;
    }
}

#[test]
fn rays_are_shown_the_same_as_alone() {
    let mut met = 0;
    for (seed, (boxes, triangles)) in
        [(0, 0), (1, 0), (300, 0), (0, 2000), (200, 2000)].into_iter().enumerate()
    {
        let world = World::of(seed as u64, boxes, triangles);
        for isa in Isa::available() {
            for count in [0, 1, 5, world.lines.len()] {
                let nothing = Log { shown: vec![Vec::new(); count], found: vec![false; count] };
                let mut alone = nothing.clone();
                for (ray, line) in world.lines[..count].iter().enumerate() {
                    let Some(line) = line else { continue };
                    let shown = &mut alone.shown[ray];
                    world.tree.closest(
                        isa,
                        line,
                        |leaf| admits(ray, leaf),
                        |leaf| {
                            shown.push(leaf);
                            limit(ray, leaf)
                        },
                    );
                    met += shown.len();
                }
                let mut rays = Logging { world: &world, log: nothing.clone() };
                world.tree.closest_of_each(isa, count, &mut rays);
                assert_eq!(rays.log, alone, "seed {seed}, {isa:?}, closest");

                let mut alone = nothing.clone();
                for (ray, line) in world.lines[..count].iter().enumerate() {
                    let Some(line) = line else { continue };
                    let shown = &mut alone.shown[ray];
                    alone.found[ray] = world.tree.any(
                        isa,
                        line,
                        |leaf| admits(ray, leaf),
                        |leaf| {
                            shown.push(leaf);
                            is_hit(ray, leaf)
                        },
                    );
                }
                let mut rays = Logging { world: &world, log: nothing };
                world.tree.any_of_each(isa, count, &mut rays);
                assert_eq!(rays.log, alone, "seed {seed}, {isa:?}, any");
            }
        }
    }
    assert!(met > 2000, "{met} leaves shown");
}
