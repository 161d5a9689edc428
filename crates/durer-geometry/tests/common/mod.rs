//! Shared by the tests: random numbers, and mixed worlds.
#![allow(dead_code, reason = "not every test needs everything")]

use durer_geometry::{Builder, Geometry, ObjectId};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{AxisBox, Disc, Placed, Plane, Sphere, Triangle};
use durer_testkit::TestRng;

/// Draws that only worlds need.
pub(crate) trait Draws {
    /// A point of a coarse grid, where coincidences are common.
    fn grid(&mut self) -> Point3;
    /// A sheared map; half of them are mirrored.
    fn affine(&mut self) -> Affine;
}

impl Draws for TestRng {
    fn grid(&mut self) -> Point3 {
        let mut x = || self.below(9) as f64 - 4.0;
        Point3::new(x(), x(), x())
    }

    fn affine(&mut self) -> Affine {
        loop {
            let rows = [0, 1, 2].map(|_| (self.vector() * 1.5).to_array());
            if let Ok(map) = Affine::new(rows, self.point(5.0))
                && map.inverse_norm() < 20.0
            {
                return map;
            }
        }
    }
}

/// Surfaces of many types; on the grid many touch, coincide and share edges.
pub(crate) fn fill(builder: &mut Builder, dice: &mut TestRng, count: usize, on_grid: bool) {
    for _ in 0..count {
        let place = |dice: &mut TestRng| if on_grid { dice.grid() } else { dice.point(4.0) };
        let c = place(dice);
        let r = if on_grid { 1.0 + dice.below(2) as f64 } else { 0.05 + 0.4 * dice.signed().abs() };
        match dice.below(6) {
            0 | 1 => builder.add(Sphere::new(c, r).unwrap()),
            2 => builder.add(AxisBox::new(c, c + Vec3::new(r, 2.0 * r, r)).unwrap()),
            3 => {
                let (a, b) = (place(dice), place(dice));
                match Triangle::new([c, a, b]) {
                    Ok(triangle) => builder.add(triangle),
                    Err(_) => builder,
                }
            }
            4 => builder.add(Disc::new(c, dice.vector(), r).unwrap()),
            _ => {
                let ball = Sphere::new(Point3::ORIGIN, r).unwrap();
                builder.add(Placed::new(ball, dice.affine()))
            }
        };
    }
}

/// Random rays, and rays between points of the grid, which meet edges, corners and tangents
/// exactly.
pub(crate) fn rays(dice: &mut TestRng, count: usize) -> Vec<Ray> {
    let ray = |dice: &mut TestRng| loop {
        let ray = if dice.below(2) == 0 {
            Ray::new(dice.point(8.0), dice.vector())
        } else {
            let (a, b) = (dice.grid(), dice.grid());
            Ray::new(a, b - a)
        };
        let ray = match dice.below(4) {
            0 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
            1 => ray.with_range(0.0, 1.0),
            _ => ray,
        };
        if ray.is_valid() {
            return ray;
        }
    };
    (0..count).map(|_| ray(dice)).collect()
}

/// The same world with and without a tree.
pub(crate) fn both(fill: impl Fn(&mut Builder)) -> (Geometry, Geometry) {
    let build = |flat: bool| {
        let mut builder = Geometry::builder();
        fill(&mut builder);
        if flat {
            builder = builder.without_tree();
        }
        builder.build().unwrap()
    };
    (build(false), build(true))
}

/// An unbounded solid below the origin.
pub(crate) fn ground() -> Plane {
    Plane::new(Vec3::Y, -4.0).unwrap()
}

/// The number of an object.
pub(crate) fn object(number: u32) -> ObjectId {
    ObjectId(number)
}
