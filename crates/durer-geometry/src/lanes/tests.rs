//! Lanes see what single rays see, and rarely have to ask.

use super::*;
use durer_math::Ray;
use durer_math::lanes::LANES;
use durer_math::{Affine, Isa, Normal3};
use durer_surfaces::{
    Annulus, AxisBox, CappedCylinder, Clip, Disc, Ellipsoid, EllipticParaboloid, FillRule, Frustum,
    HyperboloidOfOneSheet, HyperboloidOfTwoSheets, Inverse, Mesh, MeshData, Parallelogram, Placed, Plane,
    Polygon, Quadric, Region, Sphere, SphericalSector, Surface, Triangle,
};

/// Numbers at random in `[-1, 1)`.
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * size
    }
}

fn point(x: f64, y: f64, z: f64) -> Point3 {
    Point3::new(x, y, z)
}

fn map() -> Affine {
    let turn = Affine::rotation_x(0.7).unwrap().then(&Affine::rotation_z(-0.4).unwrap()).unwrap();
    let sheared = Affine::new([[1.0, 0.3, 0.0], [0.0, 0.8, -0.2], [0.1, 0.0, 1.3]], Point3::ORIGIN).unwrap();
    turn.then(&sheared).unwrap().then(&Affine::translation(Vec3::new(0.1, -0.2, 0.3)).unwrap()).unwrap()
}

fn tent() -> MeshData {
    MeshData {
        vertices: vec![
            point(-1.0, -1.0, 0.0),
            point(1.0, -1.0, 0.0),
            point(0.0, 1.0, 0.0),
            point(0.0, 0.0, 1.0),
        ],
        faces: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ..MeshData::default()
    }
}

/// A world of one surface, as it is and placed.
fn worlds<S: Surface + Clone + 'static>(surface: S, out: &mut Vec<(&'static str, Geometry)>) {
    let name = core::any::type_name::<S>();
    let world = |g: &mut crate::Builder| g.build().unwrap();
    out.push((name, world(Geometry::builder().add(surface.clone()))));
    out.push((name, world(Geometry::builder().add(Inverse(surface.clone())))));
    out.push((name, world(Geometry::builder().add(Placed::new(surface, map())))));
}

fn all_worlds() -> Vec<(&'static str, Geometry)> {
    let mut all = Vec::new();
    let o = Point3::ORIGIN;
    let up = Vec3::new(0.2, 1.0, -0.3);
    worlds(Sphere::new(point(0.1, 0.0, -0.2), 0.9).unwrap(), &mut all);
    worlds(Plane::new(up, -0.5).unwrap(), &mut all);
    worlds(AxisBox::new(point(-1.0, -0.5, -0.7), point(0.8, 0.5, 0.9)).unwrap(), &mut all);
    worlds(Disc::new(o, up, 0.9).unwrap(), &mut all);
    worlds(Annulus::new(o, up, 0.4, 1.0).unwrap(), &mut all);
    worlds(Parallelogram::new(point(-0.5, -0.5, 0.0), Vec3::X, Vec3::new(0.3, 1.1, 0.2)).unwrap(), &mut all);
    let corners = [point(-1.0, -0.8, 0.1), point(1.0, -0.6, 0.0), point(0.1, 1.0, -0.3)];
    let flat = Triangle::new(corners).unwrap();
    let normals = [Normal3::new(0.1, 0.2, 1.0), Normal3::new(-0.3, 0.1, 1.0), Normal3::new(0.0, -0.4, 2.0)];
    worlds(flat.clone().with_normals(normals).unwrap(), &mut all);
    worlds(flat, &mut all);
    worlds(Mesh::new(tent()).unwrap().solid(Vec3::X).unwrap(), &mut all);
    worlds(CappedCylinder::new(point(0.0, -0.8, 0.0), point(0.3, 0.9, 0.1), 0.5).unwrap(), &mut all);
    worlds(CappedCylinder::open(point(0.0, -0.8, 0.0), point(0.3, 0.9, 0.1), 0.5).unwrap(), &mut all);
    worlds(Frustum::new(point(0.0, -0.8, 0.0), 0.9, point(0.2, 0.9, 0.1), 0.2).unwrap(), &mut all);
    worlds(Frustum::new(point(0.0, -0.8, 0.0), 0.9, point(0.2, 0.9, 0.1), 0.0).unwrap(), &mut all);
    worlds(Ellipsoid::new(0.9, 0.5, 0.7).unwrap(), &mut all);
    worlds(EllipticParaboloid::new(0.6, 0.8, 0.9).unwrap().between(0.0, 1.0).unwrap(), &mut all);
    worlds(HyperboloidOfOneSheet::new(0.4, 0.5, 0.6).unwrap().between(-0.8, 0.8).unwrap(), &mut all);
    worlds(HyperboloidOfTwoSheets::new(0.4, 0.5, 0.3).unwrap(), &mut all);
    worlds(SphericalSector::new(o, 1.0, up, 0.6).unwrap(), &mut all);
    worlds(Quadric::new([1.0, 2.0, -0.5, 0.3, 0.0, 0.2, 0.1, 0.0, -0.4, -0.6]).unwrap(), &mut all);
    // A square with a hole, and a star that winds twice around its middle.
    let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]].map(|[x, y]| point(x, y, 0.5));
    worlds(Polygon::new(&[square(1.0), square(0.5)], FillRule::EvenOdd).unwrap(), &mut all);
    let star = [[0.0, 0.0], [4.0, 3.0], [-1.0, 3.0], [3.0, 0.0], [1.0, 5.0]]
        .map(|[x, y]| point(x / 4.0, 0.0, y / 4.0));
    worlds(Polygon::new(&[star], FillRule::EvenOdd).unwrap(), &mut all);
    worlds(Polygon::new(&[star], FillRule::NonZero).unwrap(), &mut all);
    let cut = Region::half_space(Normal3::new(0.3, 1.0, 0.1), 0.2).unwrap();
    let hole = Region::solid(Sphere::new(point(0.0, 0.0, 1.0), 0.6).unwrap()).inverse();
    let clipped = Clip::new(Sphere::new(o, 1.0).unwrap(), vec![cut, hole]);
    worlds(clipped, &mut all);
    all
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

/// How many rays meet anything, and how many lanes had to ask.
#[derive(Default)]
struct Tally {
    rays: usize,
    met: usize,
    asked: usize,
}

/// Compares lanes with single rays, and goes on with rays that are spawned where these meet something, `depth` times.
fn compare(name: &str, world: &Geometry, rays: &Rays8, dice: &mut Dice, depth: u32, tally: &mut Tally) {
    let mut hits = Hits8::NONE;
    let scratch = &mut Scratch::default();
    world.seen_by_lanes(None, rays, u32::MAX, &mut hits, scratch);
    let met = world.any_by_lanes(None, rays, u32::MAX, scratch);
    if let Some(beam) = world.beam_of(core::slice::from_ref(rays)) {
        tally.asked += world.see(&beam, rays, u32::MAX, &mut Hits8::NONE.clone(), scratch).count();
    }
    for i in 0..LANES {
        let ray = rays.lane(i);
        let seen = world.seen(&ray, u32::MAX, Need::SHADING_NORMAL);
        tally.rays += 1;
        assert_eq!(
            (hits.hit.lane(i), met.lane(i)),
            (seen.is_some(), seen.is_some()),
            "{name}: {ray:?} {seen:?}"
        );
        let Some((hit, point)) = seen else { continue };
        tally.met += 1;
        assert!(
            (hits.t.0[i] - hit.t).abs() <= ROUGH * hit.t.abs().max(1.0),
            "{name}: {ray:?} {hit:?} {hits:?}"
        );
        assert_eq!(
            (hits.object[i], hits.primitive[i], hits.touching.lane(i)),
            (hit.object, hit.primitive, hit.sign == 0)
        );
        // Both brackets are as wide as is allowed, at most; normals turn with the curvature, here below 32.
        let apart = 2.0 * ROUGH * hit.t.abs().max(1.0) * ray.direction.length();
        let p = Vec3::new(hits.p.x.0[i], hits.p.y.0[i], hits.p.z.0[i]);
        assert!((p - point.p.to_vec()).max_abs() <= apart, "{name}: {p:?} {point:?}");
        for (ours, theirs) in [(hits.ng, point.ng), (hits.ns, point.ns)] {
            let turned = (ours.lane(i) - theirs.to_vec()).max_abs();
            assert!(turned <= 32.0 * apart, "{name}: {:?} {point:?}", ours.lane(i));
        }
        assert!(hits.off.0[i] > 0.0 && hits.off.0[i] < 1e-9, "{name}: {}", hits.off.0[i]);
        let (ours, theirs) = (hits.source.lane(i).unwrap(), point.source.unwrap());
        assert_eq!(
            (ours.arena, ours.index, ours.part, ours.face, ours.instance),
            (theirs.arena, theirs.index, theirs.part, theirs.face, theirs.instance),
            "{name}"
        );
    }
    if depth > 0 && hits.hit.any() {
        let mut onward = Rays8 { live: hits.hit, ..*rays };
        for i in 0..LANES {
            onward.direction.set_lane(i, dice.vector(1.0));
        }
        let (start, back) = hits.start_towards(onward.direction);
        (onward.origin, onward.source) = (start, hits.sources(back));
        // Spare lanes hold rays that were there already.
        for i in (0..LANES).filter(|&i| !hits.hit.lane(i)) {
            let ray = rays.lane(i);
            (onward.origin.x.0[i], onward.origin.y.0[i], onward.origin.z.0[i]) = ray.origin.to_array().into();
            onward.direction.set_lane(i, ray.direction);
            onward.source.set_lane(i, ray.source());
        }
        onward.live = M8::ALL;
        compare(name, world, &onward, dice, depth - 1, tally);
    }
}

#[test]
fn lanes_see_what_single_rays_see() {
    let mut dice = Dice(1);
    let mut whole = Tally::default();
    for (name, world) in all_worlds() {
        let mut tally = Tally::default();
        for round in 0..200 {
            // From about, from far away, and from within.
            let far = [4.0, 1.0, 1000.0, 30.0][round % 4];
            let t_max = if round % 8 < 6 { f64::INFINITY } else { 1.0 };
            let rays = eight(|_| {
                let from = dice.vector(far).to_point();
                let ray = Ray::new(from, dice.vector(1.0).to_point() - from);
                ray.with_range(0.0, t_max)
            });
            compare(name, &world, &rays, &mut dice, 3, &mut tally);
        }
        println!("{name}: {} rays, {} met, {} asked", tally.rays, tally.met, tally.asked);
        assert!(tally.met > 40, "{name}");
        whole.rays += tally.rays;
        whole.asked += tally.asked;
    }
    assert!(whole.asked * 500 < whole.rays, "{} of {} asked", whole.asked, whole.rays);
}

/// Solids of solids: convex and not, with faces in common, and several in one world.
fn bodies() -> Vec<(&'static str, Geometry)> {
    let mut all = Vec::new();
    let ball = |z: f64, r: f64| Sphere::new(point(0.0, 0.0, z), r).unwrap();
    let block = |a: f64, b: f64| AxisBox::new(point(a, a, a), point(b, b, b)).unwrap();
    let mut world = |name, make: &dyn Fn(&mut crate::CompoundBuilder) -> crate::Part| {
        let body = |csg: &mut crate::CompoundBuilder| {
            let whole = make(csg);
            csg.build(whole).unwrap()
        };
        let mut g = Geometry::builder();
        g.add_compound(body(&mut crate::Compound::builder()));
        all.push((name, g.build().unwrap()));
        // Beside others, so that numbers of slots and of bodies differ.
        let mut g = Geometry::builder();
        for x in [-3.0, 3.0] {
            let csg = &mut crate::Compound::builder();
            let one = csg.leaf(Sphere::new(point(x, 0.5, 0.0), 1.0).unwrap()).unwrap();
            let two = csg.leaf(Sphere::new(point(x, -0.5, 0.0), 1.0).unwrap()).unwrap();
            let both = csg.union([one, two]);
            g.add_compound(csg.build(both).unwrap());
        }
        g.add_compound(body(&mut crate::Compound::builder()));
        g.add(Plane::new(Vec3::Y, -2.0).unwrap());
        all.push((name, g.build().unwrap()));
    };
    world("lens", &|csg| {
        let parts = [csg.leaf(ball(-1.2, 1.6)).unwrap(), csg.leaf(ball(1.2, 1.6)).unwrap()];
        csg.intersection(parts)
    });
    world("shell", &|csg| {
        let parts = [ball(0.0, 1.0), ball(0.0, 0.8)].map(|b| csg.leaf(b).unwrap());
        let [outer, inner] = parts;
        csg.difference(outer, [inner])
    });
    world("blocks", &|csg| {
        let parts = [block(-1.0, 1.0), block(0.0, 1.0), block(-1.0, 0.0)].map(|b| csg.leaf(b).unwrap());
        let [outer, upper, lower] = parts;
        csg.difference(outer, [upper, lower])
    });
    world("turned blocks with a face in common", &|csg| {
        let slab = |a: Point3, b: Point3| Placed::new(AxisBox::new(a, b).unwrap(), map());
        let one = csg.leaf(slab(point(-1.0, -1.0, -1.0), point(0.3, 0.7, 1.0))).unwrap();
        let two = csg.leaf(slab(point(0.3, -1.0, -1.0), point(1.0, 0.7, 0.5))).unwrap();
        let cut = csg.leaf(slab(point(-0.5, 0.1, -2.0), point(0.5, 0.7, 2.0))).unwrap();
        let both = csg.union([one, two]);
        csg.difference(both, [cut])
    });
    world("half-space with a dent", &|csg| {
        let half = csg.leaf(Plane::new(Vec3::new(0.1, 1.0, 0.2), 0.0).unwrap()).unwrap();
        let dent = csg.leaf(ball(0.0, 0.9)).unwrap();
        csg.difference(half, [dent])
    });
    let mut tetrahedron = tent();
    // Turned inside out: its own normals do not matter to the body.
    tetrahedron.faces.iter_mut().for_each(|f| f.swap(1, 2));
    let mesh = Mesh::new(tetrahedron).unwrap().solid(Vec3::X).unwrap();
    world("mesh with a hole", &|csg| {
        let outer = csg.leaf(mesh.clone()).unwrap();
        let hole = csg.leaf(ball(0.2, 0.35)).unwrap();
        csg.difference(outer, [hole])
    });
    all
}

#[test]
fn lanes_see_what_single_rays_see_of_solids_of_solids() {
    let mut dice = Dice(7);
    for (name, world) in bodies() {
        let mut tally = Tally::default();
        for round in 0..200 {
            let far = [4.0, 1.0, 1000.0, 30.0][round % 4];
            let rays = eight(|_| {
                let from = dice.vector(far).to_point();
                Ray::new(from, dice.vector(1.0).to_point() - from)
            });
            compare(name, &world, &rays, &mut dice, 3, &mut tally);
        }
        assert!(tally.met > 200, "{name}: {}", tally.met);
    }
}

#[test]
fn all_paths_see_the_same_bits() {
    let ball = || Placed::new(Ellipsoid::new(0.9, 0.5, 0.7).unwrap(), map());
    let worlds: Vec<_> =
        Isa::available().map(|isa| Geometry::builder().isa(isa).add(ball()).build().unwrap()).collect();
    let mut dice = Dice(2);
    for _ in 0..200 {
        let rays = eight(|_| {
            let from = dice.vector(3.0).to_point();
            Ray::new(from, dice.vector(1.0).to_point() - from)
        });
        let seen: Vec<_> = worlds
            .iter()
            .map(|w| {
                let mut hits = Hits8::NONE;
                w.seen_by_lanes(None, &rays, 1, &mut hits, &mut Scratch::default());
                format!("{hits:?}")
            })
            .collect();
        assert!(seen.iter().all(|s| *s == seen[0]));
    }
}
