//! The mesh and its tree.

use crate::files::{MISS, Mesh, PeerRay};
use durer_bvh::{Bvh, Frame, Leaf, Line, Settings};
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

    #[inline(always)]
    fn ray(r: &PeerRay) -> (Ray, Line, i32) {
        let (t_min, t_max) = (f64::from(r.t_near), f64::from(r.t_far));
        let direction = Vec3::from(r.direction.map(f64::from));
        let ray = Ray::new(point(r.origin), direction).with_range(t_min, t_max);
        let k = exponent(direction.max_abs());
        let (t_min, t_max) = (scale2(t_min, k), scale2(t_max, k));
        let line = Line {
            origin: ray.origin,
            direction: direction.scale2(-k),
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min,
            t_max,
            inner: (t_min, t_max),
        };
        (ray, line, k)
    }

    /// Where the ray meets one triangle, if it does.
    #[inline(never)]
    fn exactly(&self, isa: Isa, ray: &Ray, number: u32) -> Option<f64> {
        isa.run(
            #[inline(always)]
            || {
                let mut sink = Closest::default();
                self.exact.part_roots(PartId(number), &LocalRay::new(ray), &mut sink);
                sink.root.map(|root| root.t)
            },
        )
    }

    #[inline(always)]
    fn closest_one(&self, isa: Isa, r: &PeerRay) -> (f32, u32) {
        let (ray, line, k) = Self::ray(r);
        let mut best = (f64::INFINITY, MISS);
        self.tree.closest(
            isa,
            &line,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| {
                let number = self.numbers[leaf.first as usize];
                if let Some(t) = self.exactly(isa, &ray, number)
                    && (t, number) < best
                {
                    best = (t, number);
                }
                scale2(best.0, k).next_up()
            },
        );
        (best.0 as f32, best.1)
    }

    #[inline(always)]
    fn any_one(&self, isa: Isa, r: &PeerRay) -> bool {
        let (ray, line, _) = Self::ray(r);
        self.tree.any(
            isa,
            &line,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| self.exactly(isa, &ray, self.numbers[leaf.first as usize]).is_some(),
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
        self.closest(isa, rays, t, triangle);
    }

    pub(crate) fn any_batch(&self, isa: Isa, rays: &[PeerRay], t: &mut [f32], triangle: &mut [u32]) {
        self.any(isa, rays, t, triangle);
    }
}
