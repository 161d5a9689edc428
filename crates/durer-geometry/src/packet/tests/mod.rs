//! Packets give the answers of single rays, and rarely fall back.
//!
//! Every result of a packet is compared with the kernels that decide exactly: `closest` and `any`
//! for hits, `side` and exact planes for the origins of spawned rays.

mod aimed;
mod bodies;
mod worlds;

use self::worlds::{Sides, World, all_worlds, clipped_worlds, star_worlds};
use super::*;
use crate::Hit;
use durer_math::lanes::LANES;
use durer_math::{Ray, U};
use durer_surfaces::{RootKind, Side, SurfacePoint};
use durer_testkit::TestRng;

fn point(x: f64, y: f64, z: f64) -> Point3 {
    Point3::new(x, y, z)
}

fn eight(mut ray: impl FnMut(usize) -> Ray) -> Rays8 {
    let mut rays = Rays8::NONE;
    for i in 0..LANES {
        let r = ray(i);
        (rays.origin.x.0[i], rays.origin.y.0[i], rays.origin.z.0[i]) = (r.origin.x, r.origin.y, r.origin.z);
        rays.direction.set_lane(i, r.direction);
        rays.t_max.0[i] = r.t_max;
        rays.source.set_lane(i, r.source());
        rays.live.set_lane(i, true);
    }
    rays
}

/// How many rays hit anything, how many lanes fell back, and how many were left out at edges.
#[derive(Default)]
struct Tally {
    rays: usize,
    met: usize,
    asked: usize,
    edges: usize,
}

impl Tally {
    fn add(&mut self, other: &Self) {
        (self.rays, self.met) = (self.rays + other.rays, self.met + other.met);
        (self.asked, self.edges) = (self.asked + other.asked, self.edges + other.edges);
    }
}

/// How rays are aimed.
#[derive(Clone, Copy, PartialEq)]
enum Aim {
    Random,
    /// At edges, rims, tips and tangents.
    Trouble,
}

/// Surfaces whose packet filters use coordinates of their own.
const OF_HIGHER_DEGREE: [&str; 46] = [
    "decic",
    "hypercomplex julia",
    "hypercomplex cubic julia",
    "cloud",
    "saddle in a block",
    "block in a saddle",
    "half of a saddle",
    "egg",
    "waves",
    "open waves",
    "boxed waves",
    "julia",
    "cubic julia",
    "cushion",
    "balls",
    "sausages",
    "blob with a hole",
    "heart and ball",
    "cone of curves and crossed star",
    "pyramid and heart",
    "cushion without a ball",
    "quartic",
    "cubic",
    "clipped cubic",
    "sextic",
    "heart with holes",
    "two hearts",
    "cone of curves without a block",
    "crossed star without a ball",
    "crossed curve with a lid",
    "pyramid without a wedge",
    "tiles",
    "bowl",
    "egg shell and ring",
    "crossed prism",
    "crossed conic prism",
    "crossed curved prism",
    "torus",
    "horn torus",
    "sor",
    "open sor",
    "ovus",
    "lemon",
    "curved prism",
    "conic curved prism",
    "open curved prism",
];

/// Compares packets with single rays, and repeats this `depth` times with rays that are spawned at
/// the hits.
fn compare(world: &World, aim: Aim, rays: &Rays8, dice: &mut TestRng, depth: u32, tally: &mut Tally) {
    let geometry = &world.geometry;
    let mut hits = Hits8::NONE;
    let scratch = &mut Scratch::default();
    let (only, mut met) = (slice::from_ref(rays), M8::NONE);
    geometry.first_visible8(None, only, u32::MAX, slice::from_mut(&mut hits), scratch);
    geometry.any8(None, only, u32::MAX, slice::from_mut(&mut met), scratch);
    let beam = geometry.bundle_candidates(only).unwrap();
    let asked = geometry.see(&beam, rays, u32::MAX, &mut Hits8::NONE.clone(), scratch);
    let Starts { smooth, proven } = check(world, rays, (&hits, met, asked), tally);
    check_starts(world, aim, &hits, smooth);
    if depth > 0 && proven.any() {
        let onward = onward(aim, rays, &hits, proven, dice);
        compare(world, aim, &onward, dice, depth - 1, tally);
    }
}

/// The lanes with hits at which rays may start.
struct Starts {
    /// Those where the start is proven to be on the requested side.
    proven: M8,
    /// Those of them that are not at an edge, where a step off one face may cross another one.
    smooth: M8,
}

/// Compares a packet's `hits` and `met` with single rays; `asked` are the lanes that fell back.
fn check(world: &World, rays: &Rays8, (hits, met, asked): (&Hits8, M8, M8), tally: &mut Tally) -> Starts {
    let geometry = &world.geometry;
    tally.asked += asked.count();
    let mut starts = Starts { smooth: hits.hit, proven: hits.hit };
    for i in rays.live.lanes() {
        let ray = rays.lane(i);
        let exact = geometry.closest(&ray);
        tally.rays += 1;
        // Where an edge is met within a formula's rounding, single rays may answer either way, too.
        // The packet's `t` is as accurate as `see` requires.
        let seen = (hits.t.0[i], 0.5 * PREVIEW_WIDTH * hits.t.0[i]);
        let told = exact.map_or(seen, |hit| (hit.t, hit.t_hi - hit.t_lo));
        if [seen, told].into_iter().any(|near| world.has_edge_on(&ray, near)) {
            tally.edges += 1;
            starts.smooth.set_lane(i, false);
            continue;
        }
        // A tangent, as far as f64 can decide in a surface's frame, or a crossing at an end of the
        // range; the packet, whose bounds are tighter there, may have proven that there is none.
        let in_brackets = matches!(world.sides, Sides::Bracketed | Sides::Rimmed { .. });
        let untold = exact.is_some_and(|hit| {
            let at_an_end = hit.t_lo <= 0.0 || hit.t_hi >= ray.t_max;
            hit.kind == RootKind::Cluster && hit.sign == 0 || at_an_end && in_brackets
        });
        if untold && !asked.lane(i) && (in_brackets || matches!(world.sides, Sides::Rounded)) {
            assert_eq!(hits.hit.lane(i), met.lane(i), "{}: {ray:?} {exact:?}", world.name);
            continue;
        }
        assert_eq!(
            (hits.hit.lane(i), met.lane(i)),
            (exact.is_some(), exact.is_some()),
            "{}: {ray:?} {exact:?} {:?}, asked: {}",
            world.name,
            hits.t.0[i],
            asked.lane(i)
        );
        let Some(hit) = exact else { continue };
        tally.met += 1;
        if asked.lane(i) {
            let mut single = Hits8::NONE;
            let seen = geometry.masked(u32::MAX).first_visible(&ray, Need::SHADING_NORMAL);
            single.set_lane(i, seen);
            assert_eq!(
                format!("{:?}", one(hits, i)),
                format!("{:?}", one(&single, i)),
                "{}: {ray:?}",
                world.name
            );
            // Where a surface bends within the rounding of coordinates, such as a paraboloid 1e31
            // away, no start is proven, but at tips at which two bodies meet.
            let is_proven = |p: &SurfacePoint| p.aside != Vec3::ZERO || p.bend * p.off < 0.5;
            let proven = seen.is_some_and(|(_, p)| is_proven(&p));
            starts.smooth.set_lane(i, proven);
            starts.proven.set_lane(i, proven);
        } else {
            check_hit(world, &ray, &hit, hits, i);
        }
    }
    starts
}

/// All members of one hit.
fn one(hits: &Hits8, i: usize) -> impl core::fmt::Debug {
    let p = Vec3::new(hits.p.x.0[i], hits.p.y.0[i], hits.p.z.0[i]);
    let numbers = (hits.t.0[i], p, hits.ng.lane(i), hits.ns.lane(i), hits.off.0[i]);
    (numbers, hits.object[i], hits.primitive[i], hits.touching.lane(i), hits.source.lane(i))
}

/// Compares a packet's certain hit with the first exact one.
fn check_hit(world: &World, ray: &Ray, first: &Hit, hits: &Hits8, i: usize) {
    let name = &world.name;
    // The bound that `see` requires; the exact crossing is in a bracket, too.
    let apart = 0.5 * PREVIEW_WIDTH * first.t + (first.t_hi - first.t_lo);
    assert!((hits.t.0[i] - first.t).abs() <= apart, "{name}: {ray:?} {first:?} {}", hits.t.0[i]);
    assert_eq!(
        (hits.object[i], hits.primitive[i], hits.touching.lane(i)),
        (first.object.0, first.primitive.0, first.sign == 0),
        "{name}: {ray:?} {first:?}"
    );
    let exact = world.geometry.resolve_with(ray, first, Need::SHADING_NORMAL);
    let length = ray.direction.length();
    // The point of the ray is moved onto the face, at most as far again.
    let p = Vec3::new(hits.p.x.0[i], hits.p.y.0[i], hits.p.z.0[i]);
    let far = 2.0 * apart * length + exact.dp.max_abs();
    assert!((p - exact.p.to_vec()).max_abs() <= far, "{name}: {ray:?} {p:?} {exact:?}");
    check_normals(world, far, &exact, (hits.ng.lane(i), hits.ns.lane(i)));
    // `off` is |f| and twice its error, over the gradient. With 16 U for each term of f that is at
    // most 3 * 16 U of the coordinates' sum for a plane; if the surface is curved, the squares of
    // coordinates add as much times the curvature.
    let off = hits.off.0[i];
    let extent = world.reach() + p.x.abs() + p.y.abs() + p.z.abs();
    // For faces of higher degree packets bound the largest terms, in coordinates three times as
    // large; rays start farther from self-crossing profiles.
    let terms = match world.surface {
        name if name.contains("crossed") => 4096.0,
        name if OF_HIGHER_DEGREE.contains(&name) => 64.0,
        _ => 1.0,
    };
    let most = 64.0 * U * terms * extent * (1.0 + exact.bend * extent);
    assert!(off > 0.0 && off <= most, "{name}: {ray:?} off {off} > {most} of {exact:?}");
    let (ours, theirs) = (hits.source.lane(i).unwrap(), exact.source.unwrap());
    assert_eq!(
        (ours.arena, ours.index, ours.part, ours.face, ours.instance),
        (theirs.arena, theirs.index, theirs.part, theirs.face, theirs.instance),
        "{name}: {ray:?}"
    );
}

/// Compares the normals of points that are at most `far` from each other.
fn check_normals(world: &World, far: f64, exact: &SurfacePoint, (ng, ns): (Vec3, Vec3)) {
    // A unit normal turns by at most the curvature times the distance, by twice that over the short
    // distance on which `bend` itself may change. Where the gradient is small, as near tips, the
    // rounding of coordinates counts as a distance, too. Normals of planes are rounded, as they are
    // and by inverse maps.
    let rounding = 64.0 * U;
    let turn = 2.0 * exact.bend * (far + rounding * world.size()) + rounding;
    let off_by = (ng - exact.ng.to_vec()).max_abs();
    assert!(off_by.is_finite() && off_by <= turn, "{}: {ng:?} {exact:?}: {off_by} > {turn}", world.name);
    // Normals over the triangle differ by less than 3 from each other, are longer than 0.5, and its
    // heights are above a third of its size; placed, they are longer than a quarter of that.
    let shading = turn + 4.0 * 3.0 * 3.0 / 0.5 * far / world.size();
    let off_by = (ns - exact.ns.to_vec()).max_abs();
    assert!(off_by <= shading, "{}: {ns:?} {exact:?}: {off_by} > {shading}", world.name);
}

/// Checks that rays start strictly on the side that is requested.
fn check_starts(world: &World, aim: Aim, hits: &Hits8, lanes: M8) {
    let sides = [1.0, -1.0].map(|k| {
        let n = hits.ng;
        let (start, back) = hits.start_towards(Vec3::new(n.x * k, n.y * k, n.z * k));
        assert_eq!(hits.hit & back, if k < 0.0 { hits.hit } else { M8::NONE });
        start
    });
    for i in lanes.lanes() {
        let [front, back] = sides.map(|s| point(s.x.0[i], s.y.0[i], s.z.0[i]));
        let place = || format!("{}: {front:?} {back:?} {:?}", world.name, hits.ng.lane(i));
        if matches!(world.sides, Sides::Flat(..)) {
            let (above, below) = (world.height(front).unwrap(), world.height(back).unwrap());
            assert!(above.is_ne() && below == above.reverse(), "{}", place());
            let clear = front + hits.ng.lane(i) * (world.size() * 0.125);
            assert_eq!(world.height(clear), Some(above), "{}", place());
        }
        let (outer, inner) = if world.turned { (back, front) } else { (front, back) };
        let (out, within) = if world.turned { (Side::In, Side::Out) } else { (Side::Out, Side::In) };
        // At an edge a step off one face may cross another one.
        let (check_outer, check_inner) = match world.sides {
            Sides::Smooth | Sides::Rounded | Sides::Bracketed => (true, true),
            Sides::Convex => (true, aim == Aim::Random),
            Sides::Solid | Sides::Rimmed { closed: true } => (aim == Aim::Random, aim == Aim::Random),
            Sides::Flat(..) | Sides::Sheet | Sides::Rimmed { closed: false } => (false, false),
        };
        let is = |p: Point3, side: Side| {
            let told = world.geometry.side(p);
            told == side
                || told == Side::On
                    && matches!(world.sides, Sides::Rounded | Sides::Bracketed | Sides::Rimmed { .. })
        };
        assert!(!check_outer || is(outer, out), "{}", place());
        assert!(!check_inner || is(inner, within), "{}", place());
    }
}

/// Rays that are spawned at the hits of `lanes`, in random directions or nearly along the surface.
/// The other lanes hold rays that were there before.
fn onward(aim: Aim, rays: &Rays8, hits: &Hits8, lanes: M8, dice: &mut TestRng) -> Rays8 {
    let mut onward = *rays;
    for i in lanes.lanes() {
        let (d, n) = (dice.vector(), hits.ng.lane(i));
        let graze = if aim == Aim::Trouble { 1.0 - durer_math::scale::pow2(-7 * i as i32) } else { 0.0 };
        onward.direction.set_lane(i, d - n * (n.dot(d) * graze));
    }
    let (start, back) = hits.start_towards(onward.direction);
    let sources = hits.sources(back);
    for i in lanes.lanes() {
        (onward.origin.x.0[i], onward.origin.y.0[i], onward.origin.z.0[i]) =
            (start.x.0[i], start.y.0[i], start.z.0[i]);
        onward.source.copy_lane(i, &sources, i);
    }
    onward
}

/// Filters that classify segments test many packets at once, and rays change their lanes meanwhile.
#[test]
fn many_eights_together_see_what_single_rays_see() {
    let mut dice = TestRng::new(11);
    let scratch = &mut Scratch::default();
    let (mut worlds, mut all) = (0, Tally::default());
    for world in &all_worlds(Isa::detect()) {
        let geometry = &world.geometry;
        let mut tally = Tally::default();
        for round in 0..12 {
            let far = [4.0, 1.0, 100.0][round % 3];
            let mut ray = |_| {
                let from = world.place(dice.point(far));
                Ray::new(from, world.place(dice.point(1.0)) - from)
            };
            // Full and half empty packets, one without a ray, and fewer packets than are tested
            // together.
            let mut rays: Vec<Rays8> = (0..=round + 1).map(|_| eight(&mut ray)).collect();
            rays[0].live = M8::from_bits(0b1001_0100);
            rays[round / 2].live = M8::NONE;
            for _ in 0..3 {
                let Some(beam) = geometry.bundle_candidates(&rays) else { break };
                if !geometry.is_asked_together(&beam, u32::MAX) {
                    break;
                }
                let (mut hits, mut met) = (vec![Hits8::NONE; rays.len()], vec![M8::NONE; rays.len()]);
                let mut asked = ArrayVec::new();
                geometry.see_many(&beam, &rays, u32::MAX, &mut hits, &mut asked, scratch);
                geometry.first_visible8(Some(&beam), &rays, u32::MAX, &mut hits, scratch);
                geometry.any8(Some(&beam), &rays, u32::MAX, &mut met, scratch);
                for (i, rays) in rays.iter_mut().enumerate() {
                    assert_eq!((hits[i].hit | met[i]) & !rays.live, M8::NONE, "{}", world.name);
                    let starts = check(world, rays, (&hits[i], met[i], asked[i]), &mut tally);
                    check_starts(world, Aim::Random, &hits[i], starts.smooth);
                    *rays = onward(Aim::Random, rays, &hits[i], starts.proven, &mut dice);
                    rays.live = starts.proven;
                }
            }
        }
        worlds += usize::from(tally.met > 100);
        all.add(&tally);
    }
    let Tally { rays, asked, .. } = all;
    assert!(worlds >= 8 && asked * 3 < rays, "{worlds} worlds, {rays} rays, {asked} asked");
}

#[test]
fn lanes_see_what_single_rays_see() {
    let mut dice = TestRng::new(1);
    let mut surfaces: Vec<(&str, Tally)> = Vec::new();
    let mut many = Vec::new();
    let mut worlds = all_worlds(Isa::detect());
    worlds.append(&mut star_worlds(Isa::detect()));
    for world in &worlds {
        let mut tally = Tally::default();
        for round in 0..64 {
            // From around, from far away, and from inside.
            let far = [4.0, 1.0, 1000.0, 30.0][round % 4];
            let rays = eight(|_| {
                let from = world.place(dice.point(far));
                let way = world.place(dice.point(1.0)) - from;
                // Directions have any length.
                let length = durer_math::scale::pow2([0, 60, -60][dice.index(3)]);
                let t_max = if round % 8 < 6 { f64::INFINITY } else { 1.0 / length };
                Ray::new(from, way * length).with_range(0.0, t_max)
            });
            compare(world, Aim::Random, &rays, &mut dice, 3, &mut tally);
        }
        assert!(tally.met * 16 > tally.rays, "{}: {} met", world.name, tally.met);
        match surfaces.last_mut().filter(|(name, _)| *name == world.surface) {
            Some((_, all)) => all.add(&tally),
            None => surfaces.push((world.surface, tally)),
        }
    }
    for (name, Tally { rays, asked, edges, .. }) in surfaces {
        println!("{name}: {rays} rays, {asked} asked, {edges} at edges");
        // Brackets are narrow: random rays hardly ever meet an edge within one.
        assert!(edges * 500 <= rays, "{name}: {edges} of {rays} at edges");
        // At least five standard deviations above the means of fourteen seeds. Rays that are spawned
        // where packets fall back often fall back, too.
        let least = match name {
            // A face, or a part of one, lies exactly in a face of the clip: only exact arithmetic
            // can prove that it is kept.
            "box without a box" => 20,
            "box within a box" => 12,
            // It is unbounded and hardly curved: rays from inside hit it thousands of times its
            // size away, where the rounding of their squares is that of the form.
            "parabolic cylinder" => 300,
            // Where a plane through a ray and the origin meets a profile at a slant, its
            // intersection has a large error bound.
            "crossed conic prism" => 6,
            // A clipped surface is tested within the clip only; an unclipped one as far as it
            // extends, and far away the degree counts.
            "clipped cubic" => 400,
            "cubic" => 200,
            "quartic" => 50,
            "balls" => 40,
            "sausages" => 30,
            "sextic" => 15,
            // Where a point has a large error bound, far away, so has the gradient around it.
            "cushion" => 3,
            // The formula decides for rays that start inside, and its ridges are arbitrarily steep.
            "star" => 12,
            "julia" | "cubic julia" | "hypercomplex julia" | "hypercomplex cubic julia" => 8,
            // Next to where a formula is undefined nothing is certain.
            "thorn" => 1,
            "wavy ring" => 6,
            "egg" | "waves" | "open waves" | "boxed waves" => 3,
            // Rays along a plane across the axis, and tangent rays.
            _ if OF_HIGHER_DEGREE.contains(&name) => 12,
            // These have a tip, or are unbounded, too.
            "double cone" => 350,
            _ => 500,
        };
        if asked * least >= rays {
            many.push(format!("{name}: {asked} of {rays}"));
        }
    }
    assert!(many.is_empty(), "asked: {many:?}");
}

#[test]
fn what_is_clipped_within_its_box_is_seen() {
    let mut dice = TestRng::new(6);
    for world in clipped_worlds(Isa::detect()) {
        let mut tally = Tally::default();
        for _ in 0..64 {
            let rays = eight(|_| {
                let from = world.place(dice.point(4.0));
                Ray::new(from, world.place(dice.point(0.75)) - from)
            });
            compare(&world, Aim::Random, &rays, &mut dice, 0, &mut tally);
        }
        assert!(tally.met * 16 > tally.rays, "{}: {} met", world.name, tally.met);
    }
}

/// The distance from the ray's origin to its start has no influence on how near counts as close.
#[test]
fn rays_from_within_level_sets_are_seen() {
    let mut dice = TestRng::new(7);
    // Far from the origin points have larger error bounds than that.
    let far = |name: &str| name.contains("far") || name.contains("returned");
    let within = |w: &&World| ["cushion", "egg"].contains(&w.surface) && !far(&w.name);
    for world in all_worlds(Isa::detect()).iter().filter(within) {
        let mut tally = Tally::default();
        for _ in 0..64 {
            let rays = eight(|_| {
                let from = world.place(dice.point(0.125));
                Ray::new(from, world.place(dice.point(1.0)) - from)
            });
            compare(world, Aim::Random, &rays, &mut dice, 0, &mut tally);
        }
        println!("{}: {} rays, {} met, {} asked", world.name, tally.rays, tally.met, tally.asked);
        assert!(tally.met == tally.rays && tally.asked * 32 <= tally.rays, "{}: {}", world.name, tally.asked);
    }
}

#[test]
fn all_paths_see_the_same_bits() {
    let paths: Vec<_> = Isa::available().map(all_worlds).collect();
    let mut dice = TestRng::new(2);
    for i in 0..paths[0].len() {
        for _ in 0..8 {
            let world = &paths[0][i];
            let rays = eight(|_| {
                let from = world.place(dice.point(3.0));
                Ray::new(from, world.place(dice.point(1.0)) - from)
            });
            let seen = paths.iter().map(|worlds| {
                let mut hits = Hits8::NONE;
                let (rays, to) = (slice::from_ref(&rays), slice::from_mut(&mut hits));
                worlds[i].geometry.first_visible8(None, rays, 1, to, &mut Scratch::default());
                format!("{hits:?}")
            });
            let seen: Vec<_> = seen.collect();
            assert!(seen.iter().all(|s| *s == seen[0]), "{}: {seen:?}", world.name);
        }
    }
}
