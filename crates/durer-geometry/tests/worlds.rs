//! The parts of worlds: instances, masks, numbers, parts, nothing at all.

mod common;

use common::{Draws, fill, ground, object, rays};
use durer_geometry::{BuildError, EVERYTHING, Geometry, ObjectId, PrimitiveId};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{
    AxisBox, Clip, DynSurface, EllipticCylinder, Frustum, Mesh, MeshData, Need, Placed, Plane, Quadric,
    Region, Side, Sphere,
};
use durer_testkit::TestRng;
use std::sync::Arc;

fn ball(x: f64, y: f64, z: f64, r: f64) -> Sphere {
    Sphere::new(Point3::new(x, y, z), r).unwrap()
}

fn along_x(x: f64) -> Ray {
    Ray::new(Point3::new(x, 0.0, 0.0), Vec3::X)
}

#[test]
fn nothing() {
    let world = Geometry::builder().build().unwrap();
    let ray = along_x(0.0);
    assert_eq!((world.closest(&ray), world.any(&ray), world.all(&ray)), (None, false, Vec::new()));
    assert_eq!((world.spans(&ray), world.contains(Point3::ORIGIN)), (Vec::new(), false));
    assert!(world.bounds().is_empty());
    assert!(world.explain(&ray).to_string().contains("meets nothing"));
    // An instance of an empty geometry is empty.
    let twice =
        Geometry::builder().with_instance(&Arc::new(world), Affine::IDENTITY, EVERYTHING).build().unwrap();
    assert!(!twice.any(&ray) && twice.bounds().is_empty());
}

#[test]
fn unbounded_things_only() {
    let world = Geometry::builder().with(ground()).build().unwrap();
    assert_eq!(world.stats().beside, 1);
    let down = Ray::new(Point3::ORIGIN, -Vec3::Y);
    assert_eq!(world.closest(&down).map(|h| (h.t, h.sign)), Some((4.0, -1)));
    let spans = world.spans(&down);
    assert_eq!((spans.len(), spans[0].t_in, spans[0].t_out), (1, 4.0, f64::INFINITY));
    assert_eq!(spans[0].object_out, None);
    // From below, up: it starts inside, infinitely deep.
    let up = Ray::new(Point3::new(0.0, -10.0, 0.0), Vec3::Y).with_range(f64::NEG_INFINITY, f64::INFINITY);
    let spans = world.spans(&up);
    assert_eq!((spans[0].t_in, spans[0].t_out, spans[0].object_in), (f64::NEG_INFINITY, 6.0, None));
    // Along the ground, below it: inside all the way, crossing nothing.
    let level = Ray::new(Point3::new(0.0, -10.0, 0.0), Vec3::X).with_range(1.0, 2.0);
    let spans = world.spans(&level);
    assert_eq!((spans.len(), spans[0].t_in, spans[0].t_out), (1, 1.0, 2.0));
    assert!(world.spans(&Ray::new(Point3::ORIGIN, Vec3::X)).is_empty());
    assert_eq!(world.side(Point3::new(3.0, -4.0, 1.0)), Side::On);
}

#[test]
fn invalid_rays_miss_and_are_counted() {
    let world = Geometry::builder().with(ball(0.0, 0.0, 0.0, 1.0)).build().unwrap();
    let broken = [
        Ray::new(Point3::new(f64::NAN, 0.0, 0.0), Vec3::X),
        Ray::new(Point3::ORIGIN, Vec3::ZERO),
        Ray::new(Point3::ORIGIN, Vec3::new(f64::INFINITY, 0.0, 0.0)),
        Ray::new(Point3::ORIGIN, Vec3::X).with_range(2.0, 1.0),
        Ray::new(Point3::ORIGIN, Vec3::X).with_range(f64::NAN, 1.0),
    ];
    for ray in &broken {
        assert!(world.closest(ray).is_none() && !world.any(ray) && world.all(ray).is_empty());
        assert!(world.spans(ray).is_empty());
    }
    assert_eq!(world.invalid_rays(), 4 * broken.len() as u64);
    assert!(world.explain(&broken[0]).to_string().contains("no ray"));
}

#[test]
fn a_million_nested_duplicates() {
    let mut builder = Geometry::builder();
    for _ in 0..1_000_000 {
        builder.add(ball(0.0, 0.0, 0.0, 1.0));
    }
    let world = builder.build().unwrap();
    let stats = world.stats();
    assert!(stats.bytes < 200_000_000, "{} bytes", stats.bytes);
    assert!(stats.tree.depth <= 8);
    // All have the same `t`; the first object wins.
    let hit = world.closest(&along_x(-5.0)).unwrap();
    assert_eq!((hit.t, hit.object), (4.0, ObjectId(0)));
    let all = world.all(&along_x(-5.0));
    assert_eq!(all.len(), 2_000_000);
    assert!(all.is_sorted_by(|a, b| a.order(b).is_lt()));
    let spans = world.spans(&along_x(-5.0));
    assert_eq!((spans.len(), spans[0].t_in, spans[0].t_out), (1, 4.0, 6.0));
}

#[test]
fn numbers_are_what_they_were_asked_to_be() {
    let mut builder = Geometry::builder();
    builder.add_as(ball(0.0, 0.0, 0.0, 1.0), object(7), PrimitiveId(3), EVERYTHING);
    builder.add(ball(5.0, 0.0, 0.0, 1.0));
    let inner = Arc::new(builder.build().unwrap());
    assert_eq!(inner.objects(), 9);
    let mut builder = Geometry::builder();
    builder.add(ball(-9.0, 0.0, 0.0, 1.0));
    builder.instance_as(&inner, Affine::IDENTITY, object(100), PrimitiveId(1000), EVERYTHING);
    builder.instance(&inner, Affine::translation(Vec3::X * 20.0).unwrap(), EVERYTHING);
    let world = builder.build().unwrap();
    let seen: Vec<_> = world
        .all(&along_x(-20.0))
        .iter()
        .filter(|h| h.sign < 0)
        .map(|h| (h.object.0, h.primitive.0, h.instance))
        .collect();
    assert_eq!(seen, [(0, 0, 0), (107, 1003, 1), (108, 1000, 1), (116, 3, 2), (117, 0, 2)]);
}

#[test]
fn masks_hide_surfaces_and_instances() {
    let mut builder = Geometry::builder();
    builder.add_as(ball(0.0, 0.0, 0.0, 1.0), object(0), PrimitiveId(0), 0b01);
    builder.add_as(ball(4.0, 0.0, 0.0, 1.0), object(1), PrimitiveId(0), 0b10);
    builder.add_as(ground(), object(2), PrimitiveId(0), 0b10);
    let inner = Arc::new(builder.build().unwrap());
    let mut builder = Geometry::builder();
    builder.instance(&inner, Affine::translation(Vec3::X * 10.0).unwrap(), 0b110);
    builder.instance(&inner, Affine::translation(Vec3::X * 20.0).unwrap(), 0b001);
    let world = builder.build().unwrap();
    let ray = along_x(-5.0);
    let t = |mask: u32| world.masked(mask).closest(&ray).map(|h| h.t);
    assert_eq!((t(0b01), t(0b10), t(0b11), t(0b100)), (Some(24.0), Some(18.0), Some(14.0), None));
    assert_eq!(t(0), None);
    for mask in 0..8 {
        let all = world.masked(mask).all(&ray);
        assert_eq!(all.first().map(|h| h.t), t(mask));
        assert_eq!(world.masked(mask).any(&ray), !all.is_empty());
        assert_eq!(world.masked(mask).spans(&ray).len(), all.len() / 2);
    }
}

#[test]
fn a_filter_sees_every_hit_and_may_stop() {
    let mut builder = Geometry::builder();
    fill(&mut builder, &mut TestRng::new(1), 200, true);
    let world = builder.build().unwrap();
    let mut buffer = Vec::new();
    for ray in rays(&mut TestRng::new(2), 100) {
        let mut seen = Vec::new();
        assert!(!world.masked(EVERYTHING).any_where(&ray, |hit| {
            seen.push(*hit);
            false
        }));
        seen.sort_by(durer_geometry::Hit::order);
        world.masked(EVERYTHING).all_into(&ray, &mut buffer);
        assert_eq!(seen, buffer);
        let mut calls = 0;
        let stopped = world.masked(EVERYTHING).any_where(&ray, |_| {
            calls += 1;
            true
        });
        assert_eq!((stopped, calls), (!buffer.is_empty(), usize::from(!buffer.is_empty())));
    }
}

/// A cone whose wall a ray enters and whose disc it leaves behind it, both at one rounded `t`:
/// found by the oracle in `tests/outside`.
#[test]
fn a_cone_clipped_at_its_rim_is_entered_first() {
    let map = Affine::new(
        [[1.0, -4.0, 8.0], [4.0, -7.0, -4.0], [-8.0, -4.0, -1.0]],
        Point3::new(125.0, 0.125, 0.0),
    );
    let base = Point3::new(2048.0, 5120.0, 7168.0);
    let cone = Frustum::new(base, 39936.0, Point3::new(12288.0, 10240.0, -3072.0), 39936.0).unwrap();
    let world = Geometry::builder().with(DynSurface::new(Placed::new(cone, map.unwrap()))).build().unwrap();
    let origin = Point3::new(316870.8445767619, -19390.6469906667, -125622.15542323812);
    let ray = Ray::new(origin, Vec3::new(-0.5, -0.875, -0.5));
    let all = world.all(&ray);
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1]);
    assert_eq!(all[0].t, all[1].t);
    assert_eq!(world.closest(&ray), Some(all[0]));
    assert_eq!(world.batch(&[ray]).closest(), [Some(all[0])]);
    assert_eq!(world.batch(&[ray]).all().of(0), all);
}

/// Found by the oracle in `tests/outside`: the ray leaves the first of these, a cylinder clipped
/// by a half-space, at `t` of about 1e321.
#[test]
fn what_is_met_beyond_all_numbers_is_not_met() {
    let clipped = Clip::new(
        EllipticCylinder::new(1.0, 5.0).unwrap(),
        vec![Region::half_space(-Vec3::Y.to_normal(), 0.0).unwrap()],
    );
    let map = Affine::new(
        [[0.00390625, 0.0, 0.0], [0.0, 0.001953125, 0.0], [0.0, 0.0, 128.0]],
        Point3::new(0.0, 1000.0, 1000.0),
    );
    let first =
        Geometry::builder().with(DynSurface::new(Placed::new(clipped, map.unwrap()))).build().unwrap();
    let origin = Point3::new(0.0015024038461538462, 1000.0090144230769, 1000.0);
    let first_ray = Ray::new(origin, Vec3::new(5e-324, 0.0, 0.6141631519109444));
    // x² + y² <= 1, and a half-space in its place.
    let pipe = Quadric::new([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).unwrap();
    let second = Geometry::builder().with(DynSurface::new(pipe.clone())).build().unwrap();
    let third = Geometry::builder().with(DynSurface::new(Plane::new(Vec3::X, 1.0).unwrap())).build().unwrap();
    let whole = (f64::NEG_INFINITY, f64::INFINITY);
    let along = |x: f64| Ray::new(Point3::ORIGIN, Vec3::new(x, 0.0, 1.0)).with_range(whole.0, whole.1);
    for (world, ray) in
        [(&first, first_ray), (&second, along(5e-324)), (&second, along(-1e-310)), (&third, along(5e-324))]
    {
        assert_eq!((world.all(&ray), world.closest(&ray), world.any(&ray)), (vec![], None, false), "{ray:?}");
        assert!(!world.masked(EVERYTHING).any_where(&ray, |_| true));
    }
    for world in [&second, &third] {
        let spans = world.spans(&along(5e-324));
        assert_eq!(
            spans.iter().map(|s| (s.t_in, s.t_out, s.object_in, s.object_out)).collect::<Vec<_>>(),
            [(whole.0, whole.1, None, None)]
        );
        assert!(world.spans(&Ray::new(Point3::new(2.0, 0.0, 0.0), Vec3::new(5e-324, 0.0, 1.0))).is_empty());
    }
    // Just within the range of f64: hit, though a bracket's end may be infinite.
    for (world, count, x) in [
        (&second, 2, 1e-307),
        (&second, 2, 6e-309),
        (&third, 1, 1e-307),
        (&third, 1, -1e-307),
        (&third, 1, 6e-309),
    ] {
        let all = world.all(&along(x));
        assert_eq!(all.len(), count, "{x:e}: {all:?}");
        assert!(all.iter().all(|h| h.t.is_finite() && h.t_lo <= h.t && h.t <= h.t_hi), "{all:?}");
        assert_eq!(world.closest(&along(x)), Some(all[0]));
    }
}

/// The crossings at a box's corner, where the entry has a wide bracket and the exit a narrow one
/// within it: found by the oracle, too.
#[test]
fn a_box_clipped_at_its_corner_is_entered_first() {
    let map =
        Affine::new([[8.0, -4.0, 1.0], [-1.0, -4.0, -8.0], [4.0, 7.0, -4.0]], Point3::new(1.0, -7.0, 0.0));
    let corners = (Point3::new(0.0, -1.0, 0.0), Point3::new(2.0, 0.0, 1.0));
    let world = Geometry::builder()
        .with(Placed::new(AxisBox::new(corners.0, corners.1).unwrap(), map.unwrap()))
        .build()
        .unwrap();
    let origin = Point3::new(1.485398358671441, -14.74269917933572, -1.169690972692925);
    let ray = Ray::new(origin, Vec3::new(0.09375, -0.046875, -0.515625));
    let all = world.all(&ray);
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1], "{all:?}");
    assert!(all[0].t <= all[1].t && all[0].t_hi <= all[1].t_hi && all[0].t_lo <= all[1].t_lo);
    // By exact arithmetic: 5.489084174171296 and, an ulp or so behind it, 5.489084174171297.
    assert!(all.iter().all(|h| h.t_lo <= 5.489084174171297 && 5.489084174171296 <= h.t_hi), "{all:?}");
    assert_eq!(world.closest(&ray), Some(all[0]));
    let spans = world.spans(&ray);
    assert_eq!(spans.iter().map(|s| (s.t_in, s.t_out)).collect::<Vec<_>>(), [(all[0].t, all[1].t)]);
}

#[test]
fn solids_are_entered_and_left_in_turn_where_t_cannot_tell() {
    let mut dice = TestRng::new(11);
    let (mut tied, mut hits) = (0, 0);
    for _ in 0..60 {
        // Several solids in one arena; rays from afar that cut off a corner or a rim by about an
        // ulp of `t`.
        let mut builder = Geometry::builder();
        let maps = [0; 4].map(|_| dice.affine());
        for map in &maps {
            builder.add(Placed::new(AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)).unwrap(), *map));
            builder.add(Placed::new(
                Frustum::new(Point3::ORIGIN, 1.0, Point3::new(0.0, 0.0, 1.0), 0.5).unwrap(),
                *map,
            ));
        }
        let world = builder.build().unwrap();
        for _ in 0..200 {
            let map = dice.below(4) as usize;
            let on_edge = Point3::new(1.0, 0.0, 0.0) + Vec3::Y * (0.5 * dice.signed() + 0.5);
            let on_rim =
                if dice.below(2) == 0 { Point3::new(0.0, -1.0, 0.0) } else { Point3::new(0.6, 0.8, 0.0) };
            let (target, out) = if dice.below(2) == 0 {
                (on_edge, Vec3::new(1.0, 0.0, -1.0))
            } else {
                (on_rim, on_rim.to_vec() - Vec3::Z)
            };
            // Nearly across the outward direction.
            let across = out.cross(dice.vector());
            let (target, d) = (maps[map].point(target), maps[map].vector(across));
            let ray = Ray::new(target - d * 1e5, d);
            let all = world.all(&ray);
            assert_eq!(world.closest(&ray), all.first().copied(), "{ray:?}");
            for object in 0..world.objects() {
                let one: Vec<_> =
                    all.iter().filter(|h| h.object == ObjectId(object) && h.sign != 0).collect();
                for pair in one.windows(2) {
                    assert_eq!(pair[0].sign, -pair[1].sign, "{ray:?}: {one:?}");
                    tied += usize::from(pair[0].t == pair[1].t);
                }
                assert!(one.first().is_none_or(|h| h.sign == -1), "{ray:?}: {one:?}");
                hits += one.len();
            }
        }
    }
    assert!(tied > 1000 && hits > 10_000, "{tied} ties, {hits} hits");
}

#[test]
fn an_instance_is_the_placed_surface() {
    // Sheared, mirrored, nested: the same bits as the wrapper type.
    let mut dice = TestRng::new(3);
    let mut crossings = 0;
    for _ in 0..40 {
        let (outer, inner) = (dice.affine(), dice.affine());
        let ball = ball(0.3, -0.2, 0.1, 0.9);
        let placed = Placed::new(Placed::new(ball, inner), outer);
        let direct = Geometry::builder().with(placed).build().unwrap();
        let innermost = Arc::new(Geometry::builder().with(ball).build().unwrap());
        let middle =
            Arc::new(Geometry::builder().with_instance(&innermost, inner, EVERYTHING).build().unwrap());
        let world = Geometry::builder().with_instance(&middle, outer, EVERYTHING).build().unwrap();
        let centre = outer.point(inner.point(Point3::new(0.3, -0.2, 0.1)));
        for _ in 0..25 {
            let origin = dice.point(20.0);
            let ray = Ray::new(origin, centre + dice.vector() - origin);
            let (a, b) = (direct.all(&ray), world.all(&ray));
            assert_eq!(a.len(), b.len());
            for (x, y) in a.iter().zip(&b) {
                assert_eq!((x.t, x.t_lo, x.t_hi, x.sign), (y.t, y.t_lo, y.t_hi, y.sign));
                assert_eq!(y.instance, 2);
                let (p, q) = (direct.resolve(&ray, x), world.resolve(&ray, y));
                assert_eq!((p.p, p.dp, p.off, p.ng, p.uv), (q.p, q.dp, q.off, q.ng, q.uv));
                crossings += 1;
            }
            assert_eq!(direct.spans(&ray).len(), world.spans(&ray).len());
            assert_eq!(direct.side(origin), world.side(origin));
        }
        assert!(world.contains(centre));
    }
    assert!(crossings > 500, "{crossings}");
}

#[test]
fn too_deep_is_refused() {
    let mut world = Arc::new(Geometry::builder().with(ball(0.0, 0.0, 0.0, 1.0)).build().unwrap());
    for _ in 0..8 {
        world = Arc::new(
            Geometry::builder().with_instance(&world, Affine::IDENTITY, EVERYTHING).build().unwrap(),
        );
    }
    assert!(world.any(&along_x(-5.0)));
    let error = Geometry::builder().with_instance(&world, Affine::IDENTITY, EVERYTHING).build().unwrap_err();
    assert_eq!(error, BuildError::TooDeep { depth: 9, limit: 8 });
    // 2^33 placements exceed the numbers.
    let mut many = Arc::new(Geometry::builder().build().unwrap());
    let result = (0..5).try_for_each(|_| {
        let mut builder = Geometry::builder();
        (0..100).for_each(|_| _ = builder.instance(&many, Affine::IDENTITY, EVERYTHING));
        many = Arc::new(builder.build()?);
        Ok(())
    });
    assert_eq!(result, Err(BuildError::TooManyPlacements));
}

/// A cube of side 2 about the origin, faces outward.
fn cube() -> Mesh {
    let vertices = (0..8)
        .map(|i| {
            let x = |bit: i32| f64::from((i >> bit & 1) * 2 - 1);
            Point3::new(x(0), x(1), x(2))
        })
        .collect();
    let faces = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    Mesh::new(MeshData { vertices, faces: faces.to_vec(), ..MeshData::default() })
        .unwrap()
        .solid(Vec3::X)
        .unwrap()
}

#[test]
fn the_faces_of_a_mesh_are_primitives() {
    let mut builder = Geometry::builder();
    builder.add(ball(9.0, 0.0, 0.0, 1.0));
    builder.add_as(cube(), object(5), PrimitiveId(40), EVERYTHING);
    let world = builder.build().unwrap();
    assert_eq!(world.stats().primitives, 13);
    let mut dice = TestRng::new(4);
    for _ in 0..300 {
        let (a, b) = ((dice.vector() * 0.99), (dice.vector() * 0.99));
        // From a point inside outward, both ways: one crossing each.
        let ray = Ray::new(a.to_point(), b).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let hits: Vec<_> = world.all(&ray).into_iter().filter(|h| h.object == ObjectId(5)).collect();
        assert_eq!(hits.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1]);
        for hit in &hits {
            assert!((40..52).contains(&hit.primitive.0));
            let p = world.resolve_with(&ray, hit, Need::POINT);
            assert!((p.p.to_vec().max_abs() - 1.0).abs() < 1e-12);
        }
        let spans = world.spans(&Ray::new(a.to_point(), b).with_range(0.0, 1e-3));
        assert_eq!(spans.len(), 1, "inside, with no face near");
        assert!(world.contains(a.to_point()));
        assert!(!world.contains((a * 3.0).to_point()) || a.max_abs() * 3.0 <= 1.0);
    }
}

#[test]
fn spawned_rays_do_not_meet_where_they_start() {
    let mut builder = Geometry::builder();
    builder.add(ball(0.0, 0.0, 0.0, 1.0)).add(cube());
    let inner = Arc::new(builder.build().unwrap());
    let mut dice = TestRng::new(5);
    let mut builder = Geometry::builder();
    builder.add(ball(0.0, 0.0, 0.0, 1e3));
    for _ in 0..10 {
        builder.instance(&inner, dice.affine(), EVERYTHING);
    }
    let world = builder.build().unwrap();
    let mut leaving = 0;
    for ray in rays(&mut dice, 400) {
        for hit in world.all(&ray) {
            let point = world.resolve(&ray, &hit);
            assert!(point.source.is_some());
            let out = point.spawn(point.ng.to_vec());
            if let Some(next) = world.closest(&out) {
                let same = (next.object, next.primitive, next.instance, next.face)
                    == (hit.object, hit.primitive, hit.instance, hit.face);
                assert!(!same, "a ray that leaves a convex surface meets it again: {hit:?} {next:?}");
            }
            // Through the ball: it starts inside and leaves once.
            let into = point.spawn(-point.ng.to_vec());
            assert!(world.any(&into) || hit.object > ObjectId(0));
            leaving += 1;
        }
    }
    assert!(leaving > 400, "{leaving}");
}

#[test]
fn the_story_names_what_happened() {
    let mut builder = Geometry::builder();
    builder.add(ball(0.0, 0.0, 0.0, 1.0)).add(ball(3.0, 0.0, 0.0, 1.0)).add(ground());
    let inner = Arc::new(builder.build().unwrap());
    let world = Geometry::builder()
        .with(ball(-8.0, 5.0, 0.0, 1.0))
        .with_instance(&inner, Affine::IDENTITY, 1)
        .build()
        .unwrap();
    let ray = Ray::new(Point3::new(-5.0, 0.1, 0.0), Vec3::X);
    let story = world.explain(&ray);
    assert_eq!(story.closest, world.closest(&ray));
    let text = story.to_string();
    for words in [
        "plane",
        "tested first",
        "instance 1: entered",
        "sphere (object 1",
        "the closest so far",
        "closest: object 1",
    ] {
        assert!(text.contains(words), "{words:?} is not in\n{text}");
    }
}
