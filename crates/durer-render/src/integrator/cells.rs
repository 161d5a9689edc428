//! Small cubes of space, each with what lies between it and a lamp.
//!
//! Points that are seen side by side are lit side by side: their shadow rays share one shaft, and mostly there is nothing in it. Cubes are cut
//! from a fixed grid and kept in a small table; which of them are there changes no picture, only how long it takes.

use crate::vector::floor;
use durer_geometry::{Beam, Geometry};
use durer_math::{Aabb, Point3, Ray, Shaft, Source, Vec3};

/// How many cubes are remembered: a power of two.
const CELLS: usize = 128;
/// Beyond this many cubes from the origin a grid is too coarse for f64.
const FARTHEST: f64 = (1_u64 << 50) as f64;

/// What is remembered.
pub(super) struct Cells(Vec<Option<Cell>>);

struct Cell {
    key: Key,
    shaft: Shaft,
    /// `None` if there is so much between that each ray should look for itself.
    beam: Option<Beam>,
}

#[derive(Clone, Copy, PartialEq)]
struct Key {
    corner: [f64; 3],
    size: f64,
    lamp: usize,
    /// The unbounded surface that the rays leave, if they do.
    source: Option<Source>,
}

impl Cells {
    pub(super) fn new() -> Self {
        Self((0..CELLS).map(|_| None).collect())
    }

    /// What may lie on a ray to a lamp, from a cube whose size is about `size`. The ray's `t` is in `[0, 1]`. Parallel light comes to points side by side
    /// from points side by side, any other from one.
    #[inline]
    pub(super) fn between(
        &mut self,
        geometry: &Geometry,
        ray: &Ray,
        (lamp, parallel): (usize, bool),
        size: f64,
    ) -> Option<&Beam> {
        let size = power_of_two(size);
        let scaled = ray.origin.to_vec() * (1.0 / size);
        // Not so where there is no size.
        let has_place = scaled.max_abs() < FARTHEST;
        if !has_place {
            return None;
        }
        let steps = [floor(scaled.x), floor(scaled.y), floor(scaled.z)];
        let key = Key {
            corner: [steps[0] * size, steps[1] * size, steps[2] * size],
            size,
            lamp,
            source: geometry.unbounded_source(ray),
        };
        let cell = &mut self.0[hash(steps, lamp)];
        if cell.as_ref().is_none_or(|c| c.key != key) {
            let corner = Point3::from(key.corner);
            let start = Aabb::new(corner, corner + Vec3::new(size, size, size));
            // The foot of a perpendicular moves no farther than its point, at most the cube's diagonal.
            let spread = if parallel { 2.0 * size } else { 0.0 };
            let end = Aabb::centred(ray.origin + ray.direction, Vec3::new(spread, spread, spread));
            let shaft = Shaft::between(start, end);
            *cell = Some(Cell { key, shaft, beam: geometry.beam(&shaft, key.source) });
        }
        let cell = cell.as_ref()?;
        if cell.shaft.holds(ray) { cell.beam.as_ref() } else { None }
    }
}

/// The greatest power of two not above a positive number of ordinary size; 0 or infinity for others.
#[inline(always)]
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits(x.to_bits() & EXPONENT)
}

/// Any mixture of the numbers will do.
#[inline(always)]
fn hash(steps: [f64; 3], lamp: usize) -> usize {
    let [x, y, z] = [steps[0] as i64 as u64, steps[1] as i64 as u64, steps[2] as i64 as u64];
    let mixed = x
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add(z.wrapping_mul(0x1656_67b1_9e37_79f9))
        .wrapping_add((lamp as u64).wrapping_mul(0x27d4_eb2f_1656_67c5));
    (mixed >> 40) as usize & (CELLS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_surfaces::Sphere;

    #[test]
    fn a_ray_is_shown_what_is_on_its_way_and_no_more() {
        let ball = |x: f64| Sphere::new(Point3::new(x, 0.0, 5.0), 1.0);
        let geometry = Geometry::builder().add(ball(0.0).unwrap()).add(ball(100.0).unwrap()).build().unwrap();
        let mut cells = Cells::new();
        let target = Point3::new(0.0, 0.0, 10.0);
        let mut shown = |x: f64, y: f64| {
            let origin = Point3::new(x, y, 0.0);
            let ray = Ray::new(origin, target - origin).with_range(0.0, 1.0);
            let beam = cells.between(&geometry, &ray, (0, false), 0.3).expect("an ordinary ray");
            (beam.is_empty(), geometry.any_in(beam, &ray, u32::MAX), geometry.any(&ray))
        };
        for i in 0..400 {
            let (x, y) = (f64::from(i % 20) * 0.37 - 3.7, f64::from(i / 20) * 0.37 - 3.7);
            let (empty, met, truth) = shown(x, y);
            assert_eq!(met, truth);
            // The ball's box throws a shadow of half-width 2.5.
            assert!(!empty || !truth);
            assert!(empty || x.abs().max(y.abs()) < 3.0);
        }
    }

    #[test]
    fn odd_sizes_and_places_are_no_harm() {
        let geometry = Geometry::builder().build().unwrap();
        let mut cells = Cells::new();
        for size in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
            for x in [0.0, 1e30, -5.0] {
                let ray = Ray::new(Point3::new(x, 0.0, 0.0), Vec3::X).with_range(0.0, 1.0);
                let _ = cells.between(&geometry, &ray, (3, true), size);
            }
        }
    }
}
