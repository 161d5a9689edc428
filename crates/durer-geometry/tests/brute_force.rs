//! The tree, the instruction set and the threads change nothing: answers equal those of testing
//! everything, bit for bit.

mod common;

use common::{Draws, both, fill, ground, rays};
use durer_geometry::{Builder, Compound, CompoundBuilder, Geometry, Hit, Part, Settings};
use durer_math::kernels::Path;
use durer_math::{Aabb, Isa, Point3, Ray, Shaft, Vec3, elementary};
use durer_surfaces::{
    Accelerate, AxisBox, CappedCylinder, DynSurface, LocalPoint, LocalRay, Mesh, MeshData, Need, Root, Side,
    Sink, Solidity, Sphere, Surface, SurfacePoint, Triangle,
};
use durer_testkit::TestRng;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The content of a hit without its place in memory.
fn public(hit: &Hit) -> impl PartialEq + core::fmt::Debug + use<> {
    let numbers = [hit.t, hit.t_lo, hit.t_hi, hit.tag[0], hit.tag[1]].map(f64::to_bits);
    (numbers, hit.object, hit.primitive, hit.instance, hit.face, hit.sign, hit.kind)
}

fn assert_same(tree: &Geometry, flat: &Geometry, rays: &[Ray]) -> usize {
    let mut crossings = 0;
    for ray in rays {
        let all = flat.all(ray);
        crossings += all.len();
        assert!(tree.all(ray).iter().map(public).eq(all.iter().map(public)), "all: {ray:?}");
        let first = all.first().map(public);
        assert_eq!(flat.closest(ray).as_ref().map(public), first, "closest is not the first of all: {ray:?}");
        assert_eq!(tree.closest(ray).as_ref().map(public), first, "closest: {ray:?}");
        assert_eq!(tree.any(ray), !all.is_empty(), "any: {ray:?}");
        assert_eq!(tree.spans(ray), flat.spans(ray), "spans: {ray:?}");
        assert_eq!(tree.side(ray.origin), flat.side(ray.origin), "side: {ray:?}");
        assert_eq!(tree.explain(ray).closest.as_ref().map(public), first, "explain: {ray:?}");
    }
    crossings
}

#[test]
fn mixed_surfaces() {
    let mut crossings = 0;
    for seed in 0..6 {
        let (tree, flat) = both(|builder| {
            let mut dice = TestRng::new(seed);
            let count = [1, 7, 60, 400][seed as usize % 4];
            fill(builder, &mut dice, count, seed % 2 == 0);
            if seed > 3 {
                builder.add(ground());
            }
        });
        crossings += assert_same(&tree, &flat, &rays(&mut TestRng::new(100 + seed), 250));
    }
    assert!(crossings > 2000, "{crossings} crossings test little");
}

/// Small triangles and large ones through them, single and as a mesh, a solid of long triangles,
/// and other surfaces.
fn fill_with_triangles(builder: &mut Builder, dice: &mut TestRng) {
    for i in 0..600 {
        let (a, size) = (dice.point(4.0), if i % 12 == 0 { 6.0 } else { 0.2 });
        if let Ok(triangle) = Triangle::new([a, a + (dice.vector() * size), a + (dice.vector() * 0.2)]) {
            builder.add(triangle);
        }
    }
    let vertices: Vec<Point3> = (0..300).map(|_| dice.point(4.0)).collect();
    let faces = (0..300).map(|i| [i, (i + 1) % 300, dice.below(300) as u32]).collect();
    builder.add(Mesh::new(MeshData { vertices, faces, ..MeshData::default() }).unwrap());
    // Two pyramids on one base.
    let mut vertices = vec![Point3::new(3.0, 3.0, 3.0), Point3::new(-3.0, -3.0, -3.0)];
    for i in 0..150 {
        let angle = f64::from(i) * core::f64::consts::TAU / 150.0;
        let (sin, cos) = elementary::sin_cos(angle);
        vertices.push(Point3::new(cos + sin, sin - cos, -2.0 * sin));
    }
    let side = |i: u32| [2 + i, 2 + (i + 1) % 150];
    let faces = (0..150).map(side).flat_map(|[a, b]| [[0, a, b], [1, b, a]]).collect();
    let data = MeshData { vertices, faces, ..MeshData::default() };
    builder.add(Mesh::new(data).unwrap().solid(Vec3::Y).unwrap());
    fill(builder, dice, 60, false);
}

#[test]
fn trees_of_every_quality() {
    for (settings, most) in [(Settings::FAST, 0), (Settings::GOOD, 0), (Settings::BEST, 1000)] {
        for with_ground in [false, true] {
            let (tree, flat) = both(|builder| {
                *builder = core::mem::take(builder).settings(settings);
                fill_with_triangles(builder, &mut TestRng::new(51));
                if with_ground {
                    builder.add(ground());
                }
            });
            let stats = tree.stats();
            let shared = stats.tree.entries as u64 + stats.beside - stats.primitives;
            assert!(shared <= most && (shared > 0) == (most > 0), "{shared} triangles stand twice");
            let crossings = assert_same(&tree, &flat, &rays(&mut TestRng::new(52), 400));
            assert!(crossings > 4000, "{crossings} crossings test little");
        }
    }
}

#[test]
fn all_instruction_sets() {
    let build = |isa: Isa, flat: bool| {
        let mut builder = Geometry::builder().isa(isa);
        fill(&mut builder, &mut TestRng::new(9), 150, true);
        if flat {
            builder = builder.without_tree();
        }
        builder.build().unwrap()
    };
    let rays = rays(&mut TestRng::new(10), 200);
    let reference = build(Isa::REFERENCE, true);
    for isa in Isa::available() {
        let tree = build(isa, false);
        if isa.path() == Path::Unfused {
            // Each path has brackets of its own, equal for tree and brute force.
            assert_same(&tree, &build(isa, true), &rays);
        } else {
            assert_same(&tree, &reference, &rays);
        }
    }
}

#[test]
fn nested_instances() {
    let (tree, flat) = {
        let build = |flat: bool| {
            let mut dice = TestRng::new(21);
            let finish = |mut builder: Builder| {
                if flat {
                    builder = builder.without_tree();
                }
                Arc::new(builder.build().unwrap())
            };
            let mut inner = Geometry::builder();
            fill(&mut inner, &mut dice, 12, false);
            let inner = finish(inner);
            let mut middle = Geometry::builder();
            fill(&mut middle, &mut dice, 3, false);
            for _ in 0..5 {
                middle.instance(&inner, dice.affine(), u32::MAX);
            }
            let middle = finish(middle);
            let mut outer = Geometry::builder();
            fill(&mut outer, &mut dice, 10, false);
            for _ in 0..6 {
                outer.instance(&middle, dice.affine(), u32::MAX);
            }
            outer.add(ground());
            finish(outer)
        };
        (build(false), build(true))
    };
    assert_eq!((tree.depth(), tree.placements()), (2, 1 + 6 * (1 + 5)));
    let crossings = assert_same(&tree, &flat, &rays(&mut TestRng::new(22), 300));
    assert!(crossings > 300, "{crossings} crossings test little");
}

#[test]
fn batches_on_any_number_of_threads() {
    // In the larger world rays traverse the tree at the same time.
    for (things, count) in [(300, 3000), (5000, 1500)] {
        batches_of(things, count);
    }
}

fn batches_of(things: usize, count: usize) {
    let mut builder = Geometry::builder();
    fill(&mut builder, &mut TestRng::new(31), things, things < 1000);
    builder.add(ground());
    let world = builder.build().unwrap();
    let mut rays = rays(&mut TestRng::new(32), count);
    // Some rays are neighbours, and form packets where they can.
    let mut dice = TestRng::new(33);
    for some in rays.chunks_mut(24) {
        let one = some[0];
        for ray in some.iter_mut().skip(8) {
            let bend = dice.vector() * (0.005 * one.direction.max_abs());
            *ray = Ray::new(one.origin, one.direction + bend).with_range(one.t_min, one.t_max);
        }
    }
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            (
                world.batch(&rays).closest(),
                world.batch(&rays).any(),
                world.batch(&rays).all(),
                world.batch(&rays).spans(),
            )
        })
    };
    let one = on(1);
    for (i, ray) in rays.iter().enumerate() {
        assert_eq!(one.0[i], world.closest(ray));
        assert_eq!(one.1[i], world.any(ray));
        assert_eq!(one.2.of(i), world.all(ray));
        assert_eq!(one.3.of(i), world.spans(ray));
    }
    for threads in [2, 5] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

#[test]
fn builds_on_any_number_of_threads_answer_alike() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut builder = Geometry::builder();
            fill(&mut builder, &mut TestRng::new(41), 20_000, false);
            builder.build().unwrap()
        })
    };
    let (one, three) = (on(1), on(3));
    assert!(one.tree() == three.tree());
    // Even the places in memory are equal.
    for ray in rays(&mut TestRng::new(42), 300) {
        assert_eq!(one.closest(&ray), three.closest(&ray));
    }
}

#[test]
fn extreme_rays_and_sizes() {
    let mut dice = TestRng::new(51);
    let far = Vec3::new(1e6, -3e4, 2e3);
    for (scale, place) in
        [(1.0, Vec3::ZERO), (1e-150, Vec3::ZERO), (1e150, Vec3::ZERO), (1.0, far), (1e-6, far)]
    {
        let (tree, flat) = both(|builder| {
            let mut dice = TestRng::new(52);
            for _ in 0..60 {
                let c = dice.point(4.0).map(|x| x * scale) + place;
                builder.add(Sphere::new(c, (0.5 + 0.4 * dice.signed()) * scale).unwrap());
            }
        });
        let mut crossings = 0;
        for _ in 0..600 {
            // Aimed from 2^k sizes away, in steps of 2^j sizes.
            let power = |dice: &mut TestRng, most: u64| {
                let halves = dice.below(2 * most) as i32 - most as i32;
                durer_math::eft::scale2(1.0, halves)
            };
            let far = power(&mut dice, 60);
            let step = power(&mut dice, 400);
            let target = dice.point(3.0).map(|x| x * scale) + place;
            let way = dice.vector();
            let origin = target - way * (far * scale);
            let direction = way * step;
            let ray = Ray::new(origin, direction);
            if ray.is_valid() {
                crossings += assert_same(&tree, &flat, &[ray]);
            }
        }
        assert!(crossings > 200, "{crossings} crossings at scale {scale}, moved by {place:?}");
    }
    // Crossings beyond the range of f64 have no parameter to compare, but nothing panics.
    let (tree, _) = both(|builder| fill(builder, &mut TestRng::new(53), 40, true));
    let wild = [0.0, -0.0, 5e-324, 1e-310, 1e-160, 1.0, 4.0, 1e17, 1e160, f64::MAX];
    for _ in 0..4000 {
        let mut x =
            || wild[dice.below(wild.len() as u64) as usize] * if dice.below(2) == 0 { 1.0 } else { -1.0 };
        let ray = Ray::new(Point3::new(x(), x(), x()), Vec3::new(x(), x(), x()));
        if ray.is_valid() {
            let _ = (tree.closest(&ray), tree.any(&ray), tree.all(&ray), tree.spans(&ray));
        }
    }
}

/// Rays that share one search get the answers of single rays, and the first visible hit is the
/// closest.
#[test]
fn bundles_of_rays() {
    let (mut shared, mut hits) = (0, 0);
    for seed in 0..4 {
        let (tree, _) = both(|builder| {
            fill(builder, &mut TestRng::new(seed), [3, 20, 60, 200][seed as usize], seed % 2 == 0);
            builder.add(ground());
        });
        for ray in rays(&mut TestRng::new(200 + seed), 250) {
            if !ray.is_valid() || ray.t_min != 0.0 {
                continue;
            }
            let seen = tree.masked(u32::MAX).first_visible(&ray, Need::POINT);
            assert_eq!(seen.is_some(), tree.any(&ray), "{ray:?}");
            // Brackets may be wider, but they contain the same crossing.
            if let (Some((seen, _)), Some(closest)) = (&seen, tree.closest(&ray)) {
                assert!(seen.t_lo <= closest.t_hi && closest.t_lo <= seen.t_hi, "{seen:?} {closest:?}");
            }
            // A bundle around the ray, a thousandth as wide as it is long.
            let width = ray.direction.abs() * 1e-3 + Vec3::new(1e-3, 1e-3, 1e-3);
            let start = Aabb::centred(ray.origin, width);
            let shaft = if ray.t_max == 1.0 {
                Shaft::between(start, Aabb::centred(ray.origin + ray.direction, width))
            } else {
                Shaft::new(start, ray.direction - width, ray.direction + width)
            };
            if let Some(beam) = tree.candidates(&shaft, None) {
                shared += 1;
                let in_beam = tree.seen_in(&beam, &ray, u32::MAX, Need::POINT);
                assert_eq!(
                    in_beam.as_ref().map(|(hit, _)| public(hit)),
                    seen.as_ref().map(|(hit, _)| public(hit))
                );
                assert_eq!(tree.any_in(&beam, &ray, u32::MAX), seen.is_some());
                hits += usize::from(seen.is_some());
            }
        }
    }
    assert!(shared > 300 && hits > 100, "{shared} {hits}");
}

/// Rays that start on a plane do not hit it if they all end on its side.
#[test]
fn bundles_that_leave_a_plane() {
    let mut builder = Geometry::builder();
    builder.add(ground());
    let world = builder.build().unwrap();
    let down = Ray::new(Point3::new(0.3, 5.0, 0.2), -Vec3::Y);
    let (_, point) = world.masked(u32::MAX).first_visible(&down, Need::POINT).unwrap();
    for (height, beam_is_empty) in [(9.0, true), (-9.0, true), (0.0, false)] {
        let target = point.p + Vec3::new(1.0, height, 2.0);
        let ray = point.spawn_to(target);
        let wide = Vec3::new(0.1, 0.1, 0.1);
        let shaft = Shaft::between(Aabb::centred(ray.origin, wide), Aabb::centred(target, wide));
        let source = ray.source();
        assert!(source.is_some());
        let beam = world.candidates(&shaft, source).unwrap();
        assert_eq!(beam.is_empty(), beam_is_empty, "{height}");
        // Without the source the plane remains a candidate.
        assert!(!world.candidates(&shaft, None).unwrap().is_empty());
        assert!(!world.any_in(&beam, &ray, u32::MAX) || height == 0.0);
    }
}

/// A solid that counts how often rays test it.
struct Counted(DynSurface, Arc<AtomicU64>);

impl Surface for Counted {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.roots(ray, sink);
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.0.resolve(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.0.side(point)
    }
}

impl Accelerate for Counted {}

/// How many leaves of a CSG solid the rays test for their first hits. Also checks these hits
/// against the lists of all hits.
fn asked(
    rays: &[Ray],
    body: impl FnOnce(&mut CompoundBuilder, &dyn Fn(DynSurface) -> Counted) -> Part,
) -> u64 {
    let count = Arc::new(AtomicU64::new(0));
    let mut csg = Compound::builder();
    let whole = body(&mut csg, &|solid| Counted(solid, Arc::clone(&count)));
    let scene = Geometry::builder().with_compound(csg.build(whole).unwrap()).build().unwrap();
    let first: Vec<_> = rays.iter().map(|ray| scene.closest(ray)).collect();
    let asked = count.load(Ordering::Relaxed);
    let mut met = 0;
    for (ray, first) in rays.iter().zip(first) {
        assert_eq!(scene.all(ray).first(), first.as_ref(), "{ray:?}");
        assert_eq!(scene.any(ray), first.is_some());
        met += usize::from(first.is_some());
    }
    assert!(met * 20 > rays.len(), "{met} of {} rays meet the body", rays.len());
    asked
}

#[test]
fn ten_thousand_leaves_are_asked_at_most_ten_times_as_often_as_a_hundred() {
    let p = Point3::new;
    let mut dice = TestRng::new(8);
    let rays: Vec<Ray> = (0..400)
        .map(|_| {
            let way = dice.vector();
            let origin = (way * (4.0 / way.length())).to_point();
            Ray::new(origin, dice.point(1.0) - origin)
        })
        .collect();
    let plate = |side: u32| {
        asked(&rays, |csg, counted| {
            let at = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
            let plate = AxisBox::new(p(-1.0, -0.05, -1.0), p(1.0, 0.05, 1.0)).unwrap();
            let plate = csg.leaf(counted(DynSurface::new(plate))).unwrap();
            let holes = (0..side * side).map(|i| {
                let (x, z) = (at(i % side), at(i / side));
                let hole = CappedCylinder::new(p(x, -1.0, z), p(x, 1.0, z), 0.7 / f64::from(side)).unwrap();
                csg.leaf(counted(DynSurface::new(hole))).unwrap()
            });
            let holes: Vec<Part> = holes.collect();
            csg.difference(plate, holes)
        })
    };
    let (few, many) = (plate(10), plate(100));
    assert!(many < 4 * few, "a plate: {few} and {many}");
    // Every ray through it crosses many sheets, but the first few decide.
    let sheets = |count: u32| {
        asked(&rays, |csg, counted| {
            let sheets = (0..count / 2).map(|i| {
                let x = 4.0 * f64::from(i) / f64::from(count) - 1.0;
                let sheet = AxisBox::new(p(x, -1.0, -1.0), p(x + 2.0 / f64::from(count), 1.0, 1.0)).unwrap();
                csg.leaf(counted(DynSurface::new(sheet))).unwrap()
            });
            let sheets: Vec<Part> = sheets.collect();
            let mut dice = TestRng::new(9);
            let craters = (0..count / 2).map(|_| {
                let crater = Sphere::new(dice.point(1.0), 1.2 / elementary::cbrt(f64::from(count))).unwrap();
                csg.leaf(counted(DynSurface::new(crater))).unwrap()
            });
            let craters: Vec<Part> = craters.collect();
            let whole = csg.union(sheets);
            csg.difference(whole, craters)
        })
    };
    let (few, many) = (sheets(100), sheets(10_000));
    assert!(many < 10 * few, "sheets: {few} and {many}");
}
