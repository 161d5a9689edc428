//! A refitted geometry gives the answers of a new one.

mod common;

use common::rays;
use durer_geometry::{Geometry, Hit, ObjectId, PrimitiveId, RefitError, Settings};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{AxisBox, Mesh, MeshData, Plane, Sphere, Triangle};
use durer_testkit::TestRng;
use std::sync::Arc;

/// The content of a hit without its place in memory.
fn said(hit: &Hit) -> (u32, u32, u32, i8, [u64; 3]) {
    let Hit { t, t_lo, t_hi, object, primitive, instance, sign, .. } = *hit;
    (object.0, primitive.0, instance, sign, [t, t_lo, t_hi].map(f64::to_bits))
}

fn assert_same_answers(a: &Geometry, b: &Geometry, rays: &[Ray]) -> usize {
    assert_eq!(a.bounds(), b.bounds());
    let mut met = 0;
    for ray in rays {
        assert_eq!(a.closest(ray).as_ref().map(said), b.closest(ray).as_ref().map(said), "{ray:?}");
        assert_eq!(a.any(ray), b.any(ray));
        let all = |g: &Geometry| g.all(ray).iter().map(said).collect::<Vec<_>>();
        assert_eq!(all(a), all(b));
        assert_eq!(a.spans(ray), b.spans(ray));
        met += usize::from(a.any(ray));
    }
    met
}

/// A closed strip of triangles around the z axis, with its caps: a solid.
fn drum(dice: &mut TestRng, sides: u32, size: f64) -> Mesh {
    let mut data = MeshData::default();
    for i in 0..sides {
        let (x, y) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][(i % 4) as usize];
        let r = size * (1.0 + f64::from(i / 4));
        for z in [-1.0, 1.0] {
            let bend = 0.1 * dice.signed();
            data.vertices.push(Point3::new(r * x + bend, r * y - bend, z * size + bend));
        }
    }
    for i in 0..sides {
        let (a, b) = (2 * i, 2 * ((i + 1) % sides));
        data.faces.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        if (1..sides - 1).contains(&i) {
            data.faces.extend([[0, b, a], [1, a + 1, b + 1]]);
        }
    }
    Mesh::new(data).unwrap()
}

fn ball(dice: &mut TestRng) -> Sphere {
    Sphere::new(dice.point(4.0), 0.1 + 0.4 * dice.signed().abs()).unwrap()
}

#[test]
fn what_moved_is_met_where_it_is() {
    let mut dice = TestRng::new(31);
    let small =
        Arc::new(Geometry::builder().with(Sphere::new(Point3::ORIGIN, 0.7).unwrap()).build().unwrap());
    let map = Affine::translation(Vec3::new(2.0, 1.0, 0.0)).unwrap();
    for (flat, settings) in
        [(false, Settings::GOOD), (false, Settings::FAST), (false, Settings::BEST), (true, Settings::GOOD)]
    {
        for sides in [4, 40, 300] {
            let seed = dice.bits();
            let old: Vec<Sphere> = (0..60).map(|_| ball(&mut dice)).collect();
            let new: Vec<Sphere> = (0..60).map(|_| ball(&mut dice)).collect();
            let (mesh, bent) =
                (drum(&mut TestRng::new(seed), sides, 0.9), drum(&mut TestRng::new(seed + 1), sides, 1.3));
            let build = |balls: &[Sphere], mesh: &Mesh| {
                let mut builder = Geometry::builder().settings(settings);
                balls.iter().for_each(|b| {
                    builder.add(*b);
                });
                builder.add(mesh.clone()).add(Plane::new(Vec3::Y, -5.0).unwrap());
                builder.add(AxisBox::new(Point3::new(3.0, 3.0, 3.0), Point3::new(4.0, 4.0, 4.0)).unwrap());
                builder.instance(&small, map, u32::MAX);
                if flat {
                    builder = builder.without_tree();
                }
                builder.build().unwrap()
            };
            let mut moved = build(&old, &mesh);
            let rays = rays(&mut dice, 1500);
            let before = assert_same_answers(&moved, &build(&old, &mesh), &rays);
            moved.refit(|ObjectId(object), _, _: &Sphere| Some(new[object as usize])).unwrap();
            moved.refit(|_, _, _: &Mesh| Some(bent.clone())).unwrap();
            // There is no surface of this type.
            moved.refit(|_, _, _: &Triangle| None).unwrap();
            let met = assert_same_answers(&moved, &build(&new, &bent), &rays);
            assert!(before > 100 && met > 100);
            // Only some are replaced.
            moved
                .refit(|ObjectId(object), _, _: &Sphere| (object < 30).then(|| old[object as usize]))
                .unwrap();
            let some: Vec<_> = old[..30].iter().chain(&new[30..]).copied().collect();
            assert_same_answers(&moved, &build(&some, &bent), &rays);
        }
    }
}

#[test]
fn what_cannot_be_followed_is_named_and_changes_nothing() {
    let mut dice = TestRng::new(32);
    let mesh = drum(&mut dice, 8, 1.0);
    let build = || Geometry::builder().with(ball(&mut TestRng::new(33))).with(mesh.clone()).build().unwrap();
    let mut geometry = build();
    let mut data = mesh.data().clone();
    // A face whose area becomes zero is no part any more.
    let [a, b, _] = data.faces[3];
    data.vertices[a as usize] = data.vertices[b as usize];
    let flat = Mesh::new(data).unwrap();
    let lost = geometry.refit(|_, _, _: &Mesh| Some(flat.clone()));
    assert_eq!(lost, Err(RefitError::Parts { object: 1, primitive: 0 }));
    // So large that no box can contain it.
    let vast = Sphere::new(Point3::new(1.7e308, 0.0, 0.0), 1e308).unwrap();
    let lost = geometry.refit(|_, _, _: &Sphere| Some(vast));
    assert_eq!(lost, Err(RefitError::Bounds { object: 0, primitive: 0 }));
    assert_same_answers(&geometry, &build(), &rays(&mut dice, 500));
}

#[test]
fn what_is_built_again_answers_as_what_is_built_anew() {
    let mut dice = TestRng::new(34);
    let small =
        Arc::new(Geometry::builder().with(Sphere::new(Point3::ORIGIN, 0.7).unwrap()).build().unwrap());
    let map = Affine::translation(Vec3::new(2.0, 1.0, 0.0)).unwrap();
    let qualities = [Some(Settings::GOOD), Some(Settings::FAST), Some(Settings::BEST), None];
    for (settings, sides) in
        qualities.into_iter().flat_map(|settings| [4, 300].map(|sides| (settings, sides)))
    {
        let mut balls: Vec<Sphere> = (0..60).map(|_| ball(&mut dice)).collect();
        let mut planes = [Plane::new(Vec3::Y, -5.0).unwrap(), Plane::new(Vec3::X, -6.0).unwrap()];
        let mut mesh = drum(&mut dice, sides, 0.9);
        let build = |balls: &[Sphere], planes: &[Plane], mesh: &Mesh| {
            let builder = Geometry::builder();
            let mut builder = match settings {
                Some(settings) => builder.settings(settings),
                None => builder.without_tree(),
            };
            balls.iter().for_each(|b| {
                builder.add(*b);
            });
            planes.iter().for_each(|p| {
                builder.add(*p);
            });
            builder.add(mesh.clone()).instance(&small, map, u32::MAX);
            builder.build().unwrap()
        };
        let mut geometry = build(&balls, &planes, &mesh);
        let rays = rays(&mut dice, 600);
        for round in 0..3 {
            // Half of the balls, one of them beyond all boxes and back; one plane; and a mesh with
            // more or fewer faces.
            for ball in balls.iter_mut().step_by(2) {
                *ball = self::ball(&mut dice);
            }
            if round == 1 {
                balls[4] = Sphere::new(Point3::new(1.7e308, 0.0, 0.0), 1e308).unwrap();
            }
            planes[1] = Plane::new(Vec3::X, -4.0 - dice.signed()).unwrap();
            mesh = drum(&mut dice, sides + [40, 3, 0][round], 1.2);
            let moved = |ObjectId(object), _: PrimitiveId, _: &Sphere| {
                (object % 2 == 0).then(|| balls[object as usize])
            };
            geometry = geometry.rebuild(moved).unwrap();
            geometry = geometry
                .rebuild(|ObjectId(object), _, _: &Plane| (object == 61).then_some(planes[1]))
                .unwrap()
                .rebuild(|_, _, _: &Mesh| Some(mesh.clone()))
                .unwrap()
                // There is no surface of this type.
                .rebuild(|_, _, _: &Triangle| None)
                .unwrap();
            let anew = build(&balls, &planes, &mesh);
            assert_eq!(geometry.objects(), anew.objects());
            assert!(assert_same_answers(&geometry, &anew, &rays) > 100);
        }
    }
}
