//! The mesh and its tree.

use crate::files::{MISS, Mesh, PeerRay};
use durer_bvh::{Bvh, Frame, Leaf, Line, Rays, Settings};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Isa, Point3, Ray, Vec3};
use durer_surfaces::{Closest, LocalRay, MeshData, PartId, Surface};
use rayon::prelude::*;

/// What a tree is built with.
pub(crate) fn quality(name: &str) -> Option<Settings> {
    (name == "good").then_some(Settings::GOOD)
}

pub(crate) struct World {
    /// The exact triangles.
    exact: durer_surfaces::Mesh,
    tree: Bvh,
    /// The triangles' numbers, slot by slot.
    numbers: Vec<u32>,
}

fn point(p: [f32; 3]) -> Point3 {
    Point3::from(p.map(f64::from))
}

impl World {
    pub(crate) fn exact(mesh: &Mesh) -> Result<durer_surfaces::Mesh, String> {
        let data = MeshData {
            vertices: mesh.vertices.iter().map(|&v| point(v)).collect(),
            faces: mesh.faces.clone(),
            ..MeshData::default()
        };
        durer_surfaces::Mesh::new(data).map_err(|e| e.to_string())
    }

    /// The part that is timed. `exact` holds the same triangles as `mesh`.
    pub(crate) fn build(mesh: &Mesh, exact: durer_surfaces::Mesh, settings: &Settings) -> Self {
        let frame = Frame::around(&exact.bounds());
        let corners = |n: u32| mesh.faces[n as usize].map(|i| point(mesh.vertices[i as usize]));
        let entry = |n: u32| frame.entry(&Aabb::from_points(corners(n)), 0, n);
        let live = |n: &u32| exact.dropped().is_empty() || exact.dropped().binary_search(n).is_err();
        let entries = (0..mesh.faces.len() as u32).into_par_iter().filter(live).map(entry).collect();
        let (tree, mut order) = Bvh::build(&frame, entries, &[Some(&corners)], settings);
        Self { exact, tree, numbers: order.remove(0) }
    }

    pub(crate) fn into_exact(self) -> durer_surfaces::Mesh {
        self.exact
    }

    pub(crate) fn bytes(&self) -> usize {
        self.tree.stats().bytes + self.numbers.capacity() * size_of::<u32>()
    }

    /// The `k` with which the largest component of a direction is in `[2^k, 2^(k+1))`, unless it is subnormal or not finite.
    #[inline(always)]
    fn clock(r: &PeerRay) -> i32 {
        let [x, y, z] = r.direction;
        let size = |x: f32| x.to_bits() & (u32::MAX >> 1);
        (size(x).max(size(y)).max(size(z)) >> 23) as i32 - 127
    }

    /// The line of a ray, whose parameter is `2^k` times that of the ray.
    #[inline(always)]
    fn line(r: &PeerRay) -> (Line, i32) {
        let k = Self::clock(r);
        if k == -127 {
            return Self::slow_line(r);
        }
        let power = |k: i32| f64::from_bits(((1023 + k) as u64) << 52);
        let (along, across) = (power(k), power(-k));
        let ([x, y, z], [dx, dy, dz]) = (r.origin, r.direction);
        let (t_min, t_max) = (f64::from(r.t_near) * along, f64::from(r.t_far) * along);
        let line = Line {
            origin: Point3::new(f64::from(x), f64::from(y), f64::from(z)),
            direction: Vec3::new(f64::from(dx) * across, f64::from(dy) * across, f64::from(dz) * across),
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min,
            t_max,
            inner: (t_min, t_max),
        };
        (line, k)
    }

    /// The same for directions that are subnormal numbers.
    #[cold]
    fn slow_line(r: &PeerRay) -> (Line, i32) {
        let direction = Vec3::from(r.direction.map(f64::from));
        let k = exponent(direction.max_abs());
        let (t_min, t_max) = (scale2(f64::from(r.t_near), k), scale2(f64::from(r.t_far), k));
        let line = Line {
            origin: point(r.origin),
            direction: direction.scale2(-k),
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min,
            t_max,
            inner: (t_min, t_max),
        };
        (line, k)
    }

    /// Where the ray meets one triangle, if it does.
    #[inline(never)]
    fn exactly(&self, isa: Isa, r: &PeerRay, number: u32) -> Option<f64> {
        isa.run(
            #[inline(always)]
            || {
                let direction = Vec3::from(r.direction.map(f64::from));
                let ray =
                    Ray::new(point(r.origin), direction).with_range(f64::from(r.t_near), f64::from(r.t_far));
                let mut sink = Closest::default();
                self.exact.part_roots(PartId(number), &LocalRay::new(&ray), &mut sink);
                sink.root.map(|root| root.t)
            },
        )
    }

    #[inline(always)]
    fn closest_one(&self, isa: Isa, r: &PeerRay) -> (f32, u32) {
        let (line, k) = Self::line(r);
        let mut asked = Asked { world: self, isa, r, k, best: (f64::INFINITY, MISS) };
        self.tree.closest(
            isa,
            &line,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| asked.improve(leaf),
        );
        (asked.best.0 as f32, asked.best.1)
    }

    #[inline(always)]
    fn any_one(&self, isa: Isa, r: &PeerRay) -> bool {
        let (line, _) = Self::line(r);
        self.tree.any(
            isa,
            &line,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| self.exactly(isa, r, self.numbers[leaf.first as usize]).is_some(),
        )
    }

    pub(crate) fn closest(&self, isa: Isa, rays: &[PeerRay], t: &mut [f32], triangle: &mut [u32]) {
        isa.run(
            #[inline(always)]
            || {
                for (i, ray) in rays.iter().enumerate() {
                    (t[i], triangle[i]) = self.closest_one(isa, ray);
                }
            },
        );
    }

    pub(crate) fn any(&self, isa: Isa, rays: &[PeerRay], t: &mut [f32], triangle: &mut [u32]) {
        isa.run(
            #[inline(always)]
            || {
                for (i, ray) in rays.iter().enumerate() {
                    (t[i], triangle[i]) =
                        if self.any_one(isa, ray) { (0.0, 0) } else { (f32::INFINITY, MISS) };
                }
            },
        );
    }

    pub(crate) fn closest_batch(&self, isa: Isa, rays: &[PeerRay], t: &mut [f32], triangle: &mut [u32]) {
        let mut batch =
            ClosestOfEach { world: self, isa, rays, best: vec![(f64::INFINITY, MISS); rays.len()] };
        self.tree.closest_of_each(isa, rays.len(), &mut batch);
        for (i, &(at, number)) in batch.best.iter().enumerate() {
            (t[i], triangle[i]) = (at as f32, number);
        }
    }

    pub(crate) fn any_batch(&self, isa: Isa, rays: &[PeerRay], t: &mut [f32], triangle: &mut [u32]) {
        t.fill(f32::INFINITY);
        triangle.fill(MISS);
        self.tree.any_of_each(isa, rays.len(), &mut AnyOfEach { world: self, isa, rays, t, triangle });
    }
}

/// A ray and what it has met.
struct Asked<'a> {
    world: &'a World,
    isa: Isa,
    r: &'a PeerRay,
    k: i32,
    best: (f64, u32),
}

impl Asked<'_> {
    #[inline(always)]
    fn improve(&mut self, leaf: Leaf) -> f64 {
        let number = self.world.numbers[leaf.first as usize];
        if let Some(t) = self.world.exactly(self.isa, self.r, number)
            && (t, number) < self.best
        {
            self.best = (t, number);
        }
        scale2(self.best.0, self.k).next_up()
    }
}

struct ClosestOfEach<'a> {
    world: &'a World,
    isa: Isa,
    rays: &'a [PeerRay],
    best: Vec<(f64, u32)>,
}

impl Rays<f64> for ClosestOfEach<'_> {
    #[inline(always)]
    fn line(&mut self, ray: usize) -> Option<Line> {
        Some(World::line(&self.rays[ray]).0)
    }

    #[inline(always)]
    fn admits(&self, _: usize, _: Leaf) -> bool {
        true
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> f64 {
        let number = self.world.numbers[leaf.first as usize];
        let (r, best) = (&self.rays[ray], &mut self.best[ray]);
        if let Some(t) = self.world.exactly(self.isa, r, number)
            && (t, number) < *best
        {
            *best = (t, number);
        }
        scale2(best.0, World::line(r).1).next_up()
    }

    #[inline(always)]
    fn found(&mut self, _: usize) {}
}

struct AnyOfEach<'a> {
    world: &'a World,
    isa: Isa,
    rays: &'a [PeerRay],
    t: &'a mut [f32],
    triangle: &'a mut [u32],
}

impl Rays<bool> for AnyOfEach<'_> {
    #[inline(always)]
    fn line(&mut self, ray: usize) -> Option<Line> {
        Some(World::line(&self.rays[ray]).0)
    }

    #[inline(always)]
    fn admits(&self, _: usize, _: Leaf) -> bool {
        true
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> bool {
        let number = self.world.numbers[leaf.first as usize];
        self.world.exactly(self.isa, &self.rays[ray], number).is_some()
    }

    #[inline(always)]
    fn found(&mut self, ray: usize) {
        (self.t[ray], self.triangle[ray]) = (0.0, 0);
    }
}
