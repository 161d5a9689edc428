//! Rays that are aimed at difficult points: at edges, rims, tips and tangents, exactly and by a few
//! ulps beside.

use super::worlds::{World, all_worlds};
use super::{Aim, Tally, TestRng, compare, eight, point};
use durer_math::{Isa, Point3, Ray, RaySide, Source};

/// The range of a ray that is aimed at `t = 1`.
fn range(dice: &mut TestRng) -> f64 {
    [f64::INFINITY, f64::INFINITY, f64::INFINITY, 1.0, 1.0_f64.next_down(), 0.5][dice.index(6)]
}

/// A point of a grid of quarters, half the time of one of halves, up to 2 from the origin.
fn grid(dice: &mut TestRng) -> Point3 {
    let step = [2.0, 4.0][dice.index(2)];
    let mut axis = || (dice.signed() * 2.0 * step).round() / step;
    point(axis(), axis(), axis())
}

/// A number that is up to `2^k` ulps beside `x`, for one `k` at random.
fn beside(x: f64, dice: &mut TestRng) -> f64 {
    let far = dice.signed() * durer_math::scale::pow2(dice.below(30) as i32 - 4);
    x + far * x.abs().max(0.25) * f64::EPSILON
}

#[test]
fn rays_on_a_grid() {
    let mut dice = TestRng::new(1);
    for world in all_worlds(Isa::detect()) {
        let mut tally = Tally::default();
        for round in 0..60 {
            let rays = eight(|_| {
                let (mut from, mut to) = (grid(&mut dice), grid(&mut dice));
                if round % 3 == 0 {
                    // Along an axis of the surface's own frame.
                    let axis = dice.index(3);
                    let keep = to;
                    to = from;
                    match axis {
                        0 => to.x = keep.x,
                        1 => to.y = keep.y,
                        _ => to.z = keep.z,
                    }
                }
                if round % 3 == 1 {
                    (to.x, to.y, from.z) =
                        (beside(to.x, &mut dice), beside(to.y, &mut dice), beside(from.z, &mut dice));
                }
                let (from, to) = (world.place(from), world.place(to));
                Ray::new(from, to - from).with_range(0.0, range(&mut dice))
            });
            compare(&world, Aim::Trouble, &rays, &mut dice, 1, &mut tally);
        }
    }
}

/// A ray that leaves a wall almost along it and meets it again 4e-7 from there. The wall is turned, so
/// its own normals are opposite to those of its hits.
#[test]
fn a_turned_wall_is_met_again_next_to_the_start() {
    let worlds = all_worlds(Isa::detect());
    let world = worlds.iter().find(|w| w.name == "open curved prism, inside out").unwrap();
    let origin = point(-0.999999999987271, 0.9999999999874666, 0.500000000015792);
    let way = durer_math::Vec3::new(0.2925213662750884, -0.29252136621553915, 0.9992350737027144);
    let source = Source { arena: 0, index: 0, part: 2, face: 0, instance: 0, side: RaySide::Front };
    let rays = eight(|_| Ray::new(origin, way).spawned_from(Some(source)));
    assert!(world.geometry.closest(&rays.lane(0)).is_some_and(|hit| hit.t < 1e-6));
    compare(world, Aim::Trouble, &rays, &mut TestRng::new(1), 0, &mut Tally::default());
}

/// The object, primitive and face that a ray hits first, if edges leave no doubt.
fn met(world: &World, from: Point3, to: Point3) -> Option<(u32, u32, u32)> {
    let hit = world.geometry.closest(&Ray::new(from, to - from))?;
    Some((hit.primitive.0, hit.face, u32::from(hit.sign > 0)))
}

#[test]
fn rays_at_a_border() {
    // If one of two targets is hit and the other is not, or on another face, there is a border
    // between them. A bisection with exact answers finds it.
    let mut dice = TestRng::new(4);
    for world in all_worlds(Isa::detect()) {
        let mut tally = Tally::default();
        for round in 0..40 {
            let from = world.place(dice.point([3.0, 100.0, 1.0][round % 3]));
            let (mut a, mut b) = (world.place(dice.point(1.5)), world.place(dice.point(1.5)));
            let here = met(&world, from, a);
            if met(&world, from, b) == here {
                continue;
            }
            for _ in 0..60 {
                let middle = a + (b - a) * 0.5;
                if met(&world, from, middle) == here {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            let rays = eight(|i| {
                let mut to = [a, b][i % 2];
                if i > 1 {
                    (to.x, to.y, to.z) =
                        (beside(to.x, &mut dice), beside(to.y, &mut dice), beside(to.z, &mut dice));
                }
                Ray::new(from, to - from).with_range(0.0, range(&mut dice))
            });
            compare(&world, Aim::Trouble, &rays, &mut dice, 1, &mut tally);
        }
    }
}

#[test]
fn numbers_near_the_end_of_their_range() {
    // Products of such lengths are subnormal or infinite.
    let mut dice = TestRng::new(5);
    for world in all_worlds(Isa::detect()) {
        let mut tally = Tally::default();
        for k in [-540, -525, -510, -300, -101, 101, 300, 510, 525] {
            let long = eight(|_| {
                let (from, to) = (dice.point(2.0), dice.point(1.0));
                let (from, to) = (world.place(from), world.place(to));
                Ray::new(from, (to - from) * durer_math::scale::pow2(k))
            });
            compare(&world, Aim::Trouble, &long, &mut dice, 0, &mut tally);
            // Near the origin, which is a tip or a centre of some surfaces.
            let near = eight(|i| {
                let small = durer_math::scale::pow2(k.min(-k));
                let (from, to) = (dice.vector() * 2.0 * small, dice.vector() * small);
                Ray::new(from.to_point(), (to - from) * if i < 4 { 1.0 } else { 1.0 / small })
            });
            compare(&world, Aim::Trouble, &near, &mut dice, 0, &mut tally);
        }
    }
}
