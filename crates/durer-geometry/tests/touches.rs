//! One rule about touching: a ray that meets an edge or a vertex of a mesh and passes on without
//! entering has one grazing hit, the same in every query, and no length inside.

mod common;

use durer_geometry::{Geometry, ObjectId, PrimitiveId};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{Mesh, MeshData, RootKind, Side};
use durer_testkit::TestRng;
use std::sync::Arc;

const EVERYTHING: u32 = u32::MAX;

/// The cube from -1 to 1, each side of `n * n` squares, solid.
fn cube(n: u32) -> Mesh {
    let mut data = MeshData::default();
    for (axis, side) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(p, q)| {
                let at = |k: u32| 2.0 * f64::from(k) / f64::from(n) - 1.0;
                let mut v = [0.0; 3];
                (v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]) = (side, at(i + p), at(j + q));
                // Vertices are not shared, as in files of type STL.
                data.vertices.push(Point3::from(v));
                data.vertices.len() as u32 - 1
            });
            data.faces.extend(if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    Mesh::new(data).unwrap().solid(Vec3::new(0.48, 0.6, 0.64)).unwrap()
}

/// The common points of a line and the cube, by its slabs; the numbers are small and whole, and the
/// parameters are compared exactly.
fn common_with_cube(o: [i64; 3], d: [i64; 3]) -> Option<(f64, f64, bool)> {
    let (mut first, mut last) = ((i64::MIN, 1), (i64::MAX, 1));
    let less = |(a, b): (i64, i64), (c, d): (i64, i64)| {
        i128::from(a) * i128::from(d) < i128::from(c) * i128::from(b)
    };
    let mut is_inside = true;
    for i in 0..3 {
        if d[i] == 0 {
            if o[i].abs() > 1 {
                return None;
            }
            is_inside &= o[i].abs() < 1;
            continue;
        }
        let (sign, step) = (d[i].signum(), d[i].abs());
        let (near, far) = ((-1 - o[i] * sign, step), (1 - o[i] * sign, step));
        first = if less(first, near) { near } else { first };
        last = if less(far, last) { far } else { last };
    }
    let value = |(a, b): (i64, i64)| a as f64 / b as f64;
    (!less(last, first)).then(|| (value(first), value(last), is_inside && less(first, last)))
}

fn worlds(n: u32) -> Vec<(Geometry, Affine)> {
    let one = || Affine::translation(Vec3::ZERO).unwrap();
    let plain = Geometry::builder().with(cube(n)).build().unwrap();
    let bare = Geometry::builder().without_tree().with(cube(n)).build().unwrap();
    // The stored matrix is whole: images of whole rays are exact.
    let rows = [[0.0, 0.0, 2.0], [3.0, 0.0, 1.0], [0.0, -1.0, 5.0]];
    let map = Affine::new(rows, Point3::new(40.0, -7.0, 3.0)).unwrap();
    let inner = Arc::new(Geometry::builder().with(cube(n)).build().unwrap());
    let placed = Geometry::builder().with_instance(&inner, map, EVERYTHING).build().unwrap();
    vec![(plain, one()), (bare, one()), (placed, map)]
}

#[test]
fn every_query_follows_the_rule_in_every_direction() {
    let mut seen = [0; 3];
    for n in [1, 3] {
        let worlds = worlds(n);
        let mut dice = TestRng::new(u64::from(n));
        let whole = |dice: &mut TestRng, n: i64| [0, 1, 2].map(|_| dice.below(2 * n as u64 + 1) as i64 - n);
        for _ in 0..2500 {
            let d = whole(&mut dice, 2);
            if d == [0; 3] {
                continue;
            }
            // Through corners, edges, middles of edges and faces, and beside.
            let reach = if dice.below(4) == 0 { 2 } else { 1 };
            let at = whole(&mut dice, reach);
            let o = [0, 1, 2].map(|i| at[i] - 8 * d[i]);
            let expected = common_with_cube(o, d);
            let float = |v: [i64; 3]| v.map(|x| x as f64);
            for (world, map) in &worlds {
                let ray = Ray::new(map.point(Point3::from(float(o))), map.vector(Vec3::from(float(d))));
                let all = world.all(&ray);
                let (first, any, spans) = (world.closest(&ray), world.any(&ray), world.spans(&ray));
                assert_eq!(any, expected.is_some(), "{ray:?}");
                assert_eq!(first, all.first().copied(), "{ray:?}");
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
                match expected {
                    None => assert!(all.is_empty() && spans.is_empty(), "{all:?} {ray:?}"),
                    Some((t, _, false)) => {
                        assert_eq!(all.len(), 1, "{all:?} {ray:?}");
                        assert_eq!((all[0].sign, all[0].kind), (0, RootKind::Grazing), "{ray:?}");
                        assert!(near(all[0].t, t) && all[0].t_lo <= all[0].t && all[0].t <= all[0].t_hi);
                        assert!(spans.is_empty(), "{spans:?} {ray:?}");
                        let point = world.resolve(&ray, &all[0]);
                        let off = (map.inverse_point(point.p).to_vec()
                            - map.inverse_point(ray.at(t)).to_vec())
                        .abs();
                        assert!(off.max_abs() < 1e-12, "{off:?}");
                    }
                    Some((a, b, true)) => {
                        let turns = all.iter().map(|h| h.kind).collect::<Vec<_>>();
                        assert_eq!(turns, [RootKind::Simple; 2], "{all:?} {ray:?}");
                        let ends: Vec<_> = spans.iter().map(|s| (s.t_in, s.t_out)).collect();
                        assert_eq!(ends, [(all[0].t, all[1].t)], "{ray:?}");
                        assert!(near(ends[0].0, a) && near(ends[0].1, b), "{ends:?} {a} {b}");
                    }
                }
                seen[expected.map_or(0, |e| 1 + usize::from(e.2))] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 500), "{seen:?}");
}

#[test]
fn batches_and_ranges_give_the_same_touches() {
    let (world, _) = worlds(2).swap_remove(0);
    let mut rays = Vec::new();
    for (x, d) in [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (0.25, 1.0)] {
        for y in [-1.0, -0.5, 0.0, 0.3, 1.0, 1.5] {
            rays.push(Ray::new(Point3::new(x, y, -5.0 * d), Vec3::Z * d));
            rays.push(Ray::new(Point3::new(y, -5.0 * d, x), Vec3::Y * d));
        }
    }
    let (firsts, hits, every) =
        (world.batch(&rays).closest(), world.batch(&rays).any(), world.batch(&rays).all());
    for (i, ray) in rays.iter().enumerate() {
        assert_eq!((firsts[i], hits[i]), (world.closest(ray), world.any(ray)));
        assert_eq!(every.of(i), world.all(ray));
        if let [touch] = world.all(ray)[..] {
            // The range is closed; behind the touch nothing is left.
            let within = |a: f64, b: f64| world.all(&ray.with_range(a, b)).len();
            assert_eq!((within(0.0, touch.t), within(touch.t, 9.0)), (1, 1));
            assert_eq!((within(0.0, touch.t.next_down()), within(touch.t.next_up(), 9.0)), (0, 0));
        }
    }
    // Within a side, and on an edge, points are on the solid.
    assert_eq!(world.side(Point3::new(1.0, 0.3, 0.2)), Side::On);
    assert_eq!(world.side(Point3::new(1.0, 1.0, 0.2)), Side::On);
}

#[test]
fn spans_by_object_of_bodies_that_overlap() {
    let mut builder = Geometry::builder();
    builder.add_as(cube(2), ObjectId(4), PrimitiveId(0), EVERYTHING);
    builder.add_as(cube(1), ObjectId(2), PrimitiveId(0), EVERYTHING);
    let inner = Arc::new(Geometry::builder().with(cube(1)).build().unwrap());
    let map = Affine::translation(Vec3::X).unwrap();
    builder.instance_as(&inner, map, ObjectId(7), PrimitiveId(0), EVERYTHING);
    // A second body of object 7 that touches its first one.
    let beside = Affine::translation(Vec3::X * 3.0).unwrap();
    builder.instance_as(&inner, beside, ObjectId(7), PrimitiveId(0), EVERYTHING);
    let world = builder.build().unwrap();
    let spans = |x: f64, y: f64, t_max: f64| -> Vec<_> {
        let ray = Ray::new(Point3::new(x, y, 0.3), Vec3::X).with_range(0.0, t_max);
        let found = world.spans_by_object(&ray);
        assert_eq!(world.batch(&[ray]).spans_by_object().of(0), found);
        found
            .iter()
            .map(|s| {
                let own = [s.span.object_in, s.span.object_out].map(|o| o.map(|o| o == s.object));
                (s.object.0, s.span.t_in, s.span.t_out, own)
            })
            .collect()
    };
    let through = [Some(true); 2];
    assert_eq!(
        spans(-5.0, 0.1, 99.0),
        [(2, 4.0, 6.0, through), (4, 4.0, 6.0, through), (7, 5.0, 9.0, through)]
    );
    let begun = [None, Some(true)];
    assert_eq!(spans(0.5, 0.1, 99.0), [(2, 0.0, 0.5, begun), (4, 0.0, 0.5, begun), (7, 0.0, 3.5, begun)]);
    assert_eq!(spans(2.5, 0.1, 1.0), [(7, 0.0, 1.0, [None, None])]);
    assert_eq!(spans(-5.0, 1.0, 99.0), [], "along the outline");
}
