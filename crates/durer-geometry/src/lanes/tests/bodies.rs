//! Solids of solids, beside each other and beside simple surfaces.

use super::worlds::{World, map, tent};
use super::{Aim, Dice, Tally, compare, eight, point};
use crate::Geometry;
use durer_math::{Point3, Ray, Vec3};
use durer_surfaces::{AxisBox, Mesh, Placed, Plane, Sphere};

/// Solids of solids: convex and not, with faces in common, and several in one world.
fn bodies() -> Vec<World> {
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
        all.push(World::of(name, g.build().unwrap()));
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
        all.push(World::of(name, g.build().unwrap()));
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
    for world in bodies() {
        let mut tally = Tally::default();
        for round in 0..200 {
            let far = [4.0, 1.0, 1000.0, 30.0][round % 4];
            let rays = eight(|_| {
                let from = dice.vector(far).to_point();
                Ray::new(from, dice.vector(1.0).to_point() - from)
            });
            compare(&world, Aim::Random, &rays, &mut dice, 3, &mut tally);
        }
        assert!(tally.met > 200, "{}: {}", world.name, tally.met);
    }
}
