//! In a batch each ray visits the same leaves in the same order as in a single query.

mod common;

use common::QUALITIES;
use durer_bvh::{Bvh, Corners, Frame, Leaf, PACKET, Packet32, Ray32, Ray64, Rays, Settings};
use durer_math::eft::exponent;
use durer_math::kernels::Path;
use durer_math::{Aabb, Isa, Point3, Vec3};
use durer_testkit::TestRng;

/// Boxes and triangles, and the rays to send through them.
struct World {
    tree: Bvh,
    lines: Vec<Option<Ray64>>,
}

fn point(dice: &mut TestRng, size: f64) -> Point3 {
    Point3::new(
        (2.0 * dice.unit() - 1.0) * size,
        (2.0 * dice.unit() - 1.0) * size,
        (2.0 * dice.unit() - 1.0) * size,
    )
}

impl World {
    fn of(seed: u64, boxes: usize, triangles: usize, settings: &Settings) -> Self {
        let mut dice = TestRng::new(seed);
        let near = |dice: &mut TestRng, p: Point3| p + (point(dice, 0.3) - Point3::ORIGIN);
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
        let (tree, _) = Bvh::build(&frame, entries, &[None, Some(&shape)], settings);
        let line = |dice: &mut TestRng| {
            // Origins are inside, near and far; some rays have an empty range.
            let size = [0.5, 3.0, 1e6][dice.below(3) as usize];
            let origin = point(dice, size);
            let d = point(dice, 1.0) - origin;
            let d = d.scale2(-exponent(d.max_abs()));
            let error = [0.0, 1e-12][dice.below(2) as usize];
            let t_max = [f64::INFINITY, 1.2][dice.below(2) as usize];
            (dice.below(9) > 0).then_some(Ray64 {
                origin,
                direction: d,
                origin_error: Vec3::new(error, 0.0, error),
                direction_error: Vec3::ZERO,
                t_min: 0.0,
                t_max,
                inner: (0.0, t_max),
            })
        };
        let mut lines: Vec<Option<Ray64>> = (0..600).map(|_| line(&mut dice)).collect();
        // Some rays are similar: side by side, or from one point, which may be a corner of a box,
        // and along axes, or nearly so. As many as go by sixteen and by eight, and some more.
        for some in lines.chunks_mut(4 * PACKET) {
            let size = [0.5, 3.0][dice.below(2) as usize];
            let mut origin = point(&mut dice, size);
            let mut d = point(&mut dice, 1.0) - origin;
            if let (true, Some((_, b))) = (dice.below(2) == 0, bounds.get(dice.below(300) as usize)) {
                origin = Point3::new(b.max.x, b.min.y, [b.min.z, -2.0][dice.below(2) as usize]);
                d = Vec3::new([0.0, -0.0, 1e-9, 1.0][dice.below(4) as usize], 0.0, 1.0);
            }
            let d = d.scale2(-exponent(d.max_abs()));
            let spread = [0.0, 1e-3, 0.03][dice.below(3) as usize];
            let aside = [0.0, 1e-2][dice.below(2) as usize];
            for line in some.iter_mut().skip(PACKET / 2) {
                let t_max = [f64::INFINITY, 0.5 + dice.unit()][dice.below(2) as usize];
                let t_min = [0.0, 0.2][dice.below(2) as usize];
                let bend = (point(&mut dice, spread) - Point3::ORIGIN).abs();
                let bent = d + Vec3::new(bend.x.copysign(d.x), bend.y.copysign(d.y), 0.0) * d.z.abs();
                *line = Some(Ray64 {
                    origin: origin + (point(&mut dice, aside) - Point3::ORIGIN),
                    direction: bent.scale2(-exponent(bent.max_abs())),
                    origin_error: Vec3::ZERO,
                    direction_error: Vec3::ZERO,
                    t_min,
                    t_max,
                    inner: (t_min, t_max),
                });
            }
        }
        Self { tree, lines }
    }
}

/// Answers that depend on the ray and the leaf only.
fn says(ray: usize, leaf: Leaf) -> u64 {
    TestRng::new(ray as u64 ^ u64::from(leaf.first) << 20 ^ u64::from(leaf.kind) << 60).bits()
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

/// The leaves that each ray visits, and which rays have found something.
#[derive(Clone, Debug, Default, PartialEq)]
struct Log {
    shown: Vec<Vec<Leaf>>,
    found: Vec<bool>,
}

struct Logging<'a> {
    world: &'a World,
    log: Log,
    /// How many calls of `sight` there were.
    asked: usize,
    /// The end of the rays for which `glances` was called.
    glanced: usize,
}

impl Logging<'_> {
    fn glances(&mut self, first: usize) -> Option<Packet32> {
        assert!(first >= self.glanced, "asked once");
        self.glanced = first + PACKET;
        let lines = self.world.lines[first..].first_chunk::<PACKET>()?;
        if lines.iter().any(Option::is_none) {
            return None;
        }
        let tree = &self.world.tree;
        Packet32::of(&lines.map(|line| line.map_or(Ray32::NOTHING, |line| tree.glance(&line))))
    }
}

impl Rays<f64> for Logging<'_> {
    type TreeRay = Ray64;

    fn sight(&mut self, ray: usize) -> Option<Ray64> {
        self.asked += 1;
        self.world.lines[ray]
    }

    fn glances(&mut self, first: usize) -> Option<Packet32> {
        Logging::glances(self, first)
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
    type TreeRay = Ray64;

    fn sight(&mut self, ray: usize) -> Option<Ray64> {
        self.asked += 1;
        self.world.lines[ray]
    }

    fn glances(&mut self, first: usize) -> Option<Packet32> {
        Logging::glances(self, first)
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
    let (mut met, mut together) = (0, 0);
    let worlds = [(0, 0), (1, 0), (300, 0), (0, 2000), (200, 2000)].into_iter().enumerate();
    for (seed, (boxes, triangles), settings) in
        worlds.flat_map(|(seed, counts)| QUALITIES.map(|settings| (seed, counts, settings)))
    {
        let world = World::of(seed as u64, boxes, triangles, &settings);
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
                let mut rays = Logging { world: &world, log: nothing.clone(), asked: 0, glanced: 0 };
                world.tree.closest_of_each(isa, count, &mut rays);
                assert_eq!(rays.log, alone, "seed {seed}, {isa:?}, closest");
                together += count - rays.asked;

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
                let mut rays = Logging { world: &world, log: nothing, asked: 0, glanced: 0 };
                world.tree.any_of_each(isa, count, &mut rays);
                assert_eq!(rays.log, alone, "seed {seed}, {isa:?}, any");
                together += count - rays.asked;
            }
        }
    }
    assert!(met > 2000, "{met} leaves shown");
    let has_packets = Isa::available().any(|isa| matches!(isa.path(), Path::Avx2 | Path::Avx512));
    assert!(!has_packets || together > 500, "{together} rays went together");
}
