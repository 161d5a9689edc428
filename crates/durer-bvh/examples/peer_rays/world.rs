//! The mesh and its tree.

use crate::files::{MISS, Mesh, PeerRay};
use durer_bvh::{Bvh, Frame, Leaf, Packet32, Ray32, Ray64, Rays, Settings, TreeRay};
use durer_math::eft::{exponent, scale2};
use durer_math::lanes::F8;
use durer_math::{Aabb, Isa, Point3, Ray, Vec3};
use durer_surfaces::{Accelerate, Closest, LocalRay, MeshData, PartId, Surface, Triangle, meet_eight};
use rayon::prelude::*;

/// The build settings of a name.
pub(crate) fn quality(name: &str) -> Option<Settings> {
    match name {
        "fast" => Some(Settings::FAST),
        "good" => Some(Settings::GOOD),
        "best" => Some(Settings::BEST),
        _ => None,
    }
}

pub(crate) struct World {
    /// The exact triangles.
    exact: durer_surfaces::Mesh,
    tree: Bvh,
    /// The number of the triangle in each slot.
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

    /// Builds the tree; this is what is timed. `exact` holds the same triangles as `mesh`.
    pub(crate) fn build(mesh: &Mesh, exact: durer_surfaces::Mesh, settings: &Settings) -> Self {
        let frame = Frame::around(&exact.bounds());
        let corners = |n: u32| mesh.faces[n as usize].map(|i| point(mesh.vertices[i as usize]));
        let entry = |n: u32| frame.entry(&Aabb::from_points(corners(n)), 0, n);
        let mut entries: Vec<_> = (0..mesh.faces.len() as u32).into_par_iter().map(entry).collect();
        if !exact.dropped().is_empty() {
            entries.retain(|entry| exact.dropped().binary_search(&entry.index()).is_err());
        }
        let (tree, mut order) = Bvh::build(&frame, entries, &[Some(&corners)], settings);
        Self { exact, tree, numbers: order.remove(0) }
    }

    pub(crate) fn into_exact(self) -> durer_surfaces::Mesh {
        self.exact
    }

    pub(crate) fn bytes(&self) -> usize {
        self.tree.stats().bytes + self.numbers.capacity() * size_of::<u32>()
    }

    /// Where the ray hits one triangle, if it does.
    #[inline(never)]
    fn exactly(&self, isa: Isa, r: &PeerRay, leaf: &Leaf) -> Option<f64> {
        isa.run(
            #[inline(always)]
            || {
                let direction = Vec3::from(r.direction.map(f64::from));
                let ray =
                    Ray::new(point(r.origin), direction).with_range(f64::from(r.t_near), f64::from(r.t_far));
                let ray = LocalRay::new(&ray);
                let mut sink = Closest::default();
                match self.tree.corners(leaf) {
                    Some(corners) => Triangle::known(corners).roots(&ray, &mut sink),
                    None => self.exact.part_roots(PartId(self.number(leaf)), &ray, &mut sink),
                }
                sink.root.map(|root| root.t)
            },
        )
    }

    /// Where each ray hits its triangle, if f64 proves that it does.
    #[inline(never)]
    fn exactly_eight(&self, isa: Isa, rays: [&PeerRay; 8], leaves: &[Option<Leaf>; 8]) -> [Option<f64>; 8] {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let mut t = [None; 8];
                let Some((rays, along)) = side_by_side(rays) else { return t };
                let Some([v0, v1, v2]) = self.tree.corners_of_each(leaves) else { return t };
                let along = widened(&along);
                let across = F8::ONE / along;
                let (o, d) = (widened_3(&rays.origin), widened_3(&rays.direction));
                let d = Vec3::new(d.x * across, d.y * across, d.z * across);
                let range = (widened(&rays.t_min) * along, widened(&rays.t_max) * along);
                let corners = [three_of(v0), three_of(v1), three_of(v2)];
                let found = meet_eight(o, d, range, corners);
                let s = found.s * across;
                // The caller ignores the answer of a ray without a triangle.
                for i in found.met.lanes() {
                    t[i] = Some(s.0[i]);
                }
                t
            },
        )
    }

    /// The number of a triangle.
    #[inline(always)]
    fn number(&self, leaf: &Leaf) -> u32 {
        self.numbers[leaf.first as usize]
    }

    #[inline(always)]
    fn closest_one(&self, isa: Isa, r: &PeerRay) -> (f32, u32) {
        let sight = Seen::new(r);
        let mut asked = Asked { world: self, isa, sight, best: (f64::INFINITY, MISS) };
        self.tree.closest(
            isa,
            &sight,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| asked.improve(leaf),
        );
        (asked.best.0 as f32, asked.best.1)
    }

    #[inline(always)]
    fn any_one(&self, isa: Isa, r: &PeerRay) -> bool {
        self.tree.any(
            isa,
            &Seen::new(r),
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |leaf: Leaf| self.exactly(isa, r, &leaf).is_some(),
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

/// A ray in the form that the tree wants: the largest component of the direction is in `[1, 2)`,
/// and the parameter is `2^k` times the ray's.
#[derive(Clone, Copy)]
struct Seen<'a> {
    r: &'a PeerRay,
    k: i32,
}

impl<'a> Seen<'a> {
    #[inline(always)]
    fn new(r: &'a PeerRay) -> Self {
        let [x, y, z] = r.direction;
        let size = |x: f32| x.to_bits() & (u32::MAX >> 1);
        let k = (size(x).max(size(y)).max(size(z)) >> 23) as i32 - 127;
        Self { r, k: if k == -127 { Self::of_subnormal(r) } else { k } }
    }

    #[cold]
    fn of_subnormal(r: &PeerRay) -> i32 {
        exponent(Vec3::from(r.direction.map(f64::from)).max_abs())
    }
}

impl TreeRay for Seen<'_> {
    #[inline(always)]
    fn line(&self) -> Ray64 {
        let (t_min, t_max) =
            (scale2(f64::from(self.r.t_near), self.k), scale2(f64::from(self.r.t_far), self.k));
        Ray64 {
            origin: point(self.r.origin),
            direction: Vec3::from(self.r.direction.map(f64::from)).scale2(-self.k),
            origin_error: Vec3::ZERO,
            direction_error: Vec3::ZERO,
            t_min,
            t_max,
            inner: (t_min, t_max),
        }
    }

    #[inline(always)]
    fn glance(&self) -> Ray32 {
        // Outside the range of f32: the tree then takes `line`.
        if !(-126..=126).contains(&self.k) {
            return Ray32::NOTHING;
        }
        let power = |k: i32| f32::from_bits(((127 + k) as u32) << 23);
        let (along, across) = (power(self.k), power(-self.k));
        let ([x, y, z], [dx, dy, dz]) = (self.r.origin, self.r.direction);
        Ray32 {
            origin: [x, y, z, self.r.t_near * along],
            direction: [dx * across, dy * across, dz * across, self.r.t_far * along],
            origin_error: [0.0; 4],
            direction_error: [0.0; 4],
            is_exact: true,
        }
    }
}

#[inline(always)]
fn widened(v: &[f32; 8]) -> F8 {
    let mut wide = F8::ZERO;
    for (wide, &x) in wide.0.iter_mut().zip(v) {
        *wide = f64::from(x);
    }
    wide
}

#[inline(always)]
fn widened_3(v: &[[f32; 8]; 3]) -> Vec3<F8> {
    Vec3::new(widened(&v[0]), widened(&v[1]), widened(&v[2]))
}

#[inline(always)]
fn three_of(v: [[f64; 8]; 3]) -> Vec3<F8> {
    Vec3::new(F8(v[0]), F8(v[1]), F8(v[2]))
}

/// Eight unscaled rays, and `2^k` of each (see [`Seen`]); `None` if one of these powers is extreme.
#[inline(always)]
fn side_by_side(rays: [&PeerRay; 8]) -> Option<(Packet32, [f32; 8])> {
    let mut seen =
        Packet32 { origin: [[0.0; 8]; 3], direction: [[0.0; 8]; 3], t_min: [0.0; 8], t_max: [0.0; 8] };
    for (i, ray) in rays.iter().enumerate() {
        for axis in 0..3 {
            seen.origin[axis][i] = ray.origin[axis];
            seen.direction[axis][i] = ray.direction[axis];
        }
        (seen.t_min[i], seen.t_max[i]) = (ray.t_near, ray.t_far);
    }
    let (mut are_in_range, mut powers) = (true, [0.0; 8]);
    for (i, power) in powers.iter_mut().enumerate() {
        let size = |axis: usize| seen.direction[axis][i].to_bits() & (u32::MAX >> 1);
        let (x, y, z) = (size(0), size(1), size(2));
        let biased = x.max(y).max(z) >> 23;
        are_in_range &= (1..=253).contains(&biased);
        *power = f32::from_bits(biased << 23);
    }
    are_in_range.then_some((seen, powers))
}

/// [`Seen::glance`] of eight rays.
#[inline(always)]
fn seen_together(rays: &[PeerRay]) -> Option<Packet32> {
    let [a, b, c, d, e, f, g, h] = rays.first_chunk()?;
    let (mut seen, along) = side_by_side([a, b, c, d, e, f, g, h])?;
    for (i, along) in along.into_iter().enumerate() {
        let across = 1.0 / along;
        for axis in 0..3 {
            seen.direction[axis][i] *= across;
        }
        seen.t_min[i] *= along;
        seen.t_max[i] *= along;
    }
    Some(seen)
}

/// A ray and its closest hit so far.
struct Asked<'a> {
    world: &'a World,
    isa: Isa,
    sight: Seen<'a>,
    best: (f64, u32),
}

impl Asked<'_> {
    #[inline(always)]
    fn improve(&mut self, leaf: Leaf) -> f64 {
        if let Some(t) = self.world.exactly(self.isa, self.sight.r, &leaf) {
            let number = self.world.number(&leaf);
            if (t, number) < self.best {
                self.best = (t, number);
            }
        }
        scale2(self.best.0, self.sight.k).next_up()
    }
}

struct ClosestOfEach<'a> {
    world: &'a World,
    isa: Isa,
    rays: &'a [PeerRay],
    best: Vec<(f64, u32)>,
}

impl<'a> Rays<f64> for ClosestOfEach<'a> {
    type TreeRay = Seen<'a>;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Seen<'a>> {
        Some(Seen::new(&self.rays[ray]))
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Packet32> {
        seen_together(&self.rays[first..])
    }

    #[inline(always)]
    fn admits(&self, _: usize, _: Leaf) -> bool {
        true
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> f64 {
        let (sight, best) = (Seen::new(&self.rays[ray]), &mut self.best[ray]);
        if let Some(t) = self.world.exactly(self.isa, sight.r, &leaf) {
            let number = self.world.number(&leaf);
            if (t, number) < *best {
                *best = (t, number);
            }
        }
        scale2(best.0, sight.k).next_up()
    }

    #[inline(always)]
    fn last_tests(&mut self, rays: &[usize; 8], leaves: &[Option<Leaf>; 8]) {
        let mut eight = [&self.rays[0]; 8];
        for (one, &ray) in eight.iter_mut().zip(rays) {
            *one = &self.rays[ray];
        }
        let met = self.world.exactly_eight(self.isa, eight, leaves);
        for (i, leaf) in leaves.iter().enumerate() {
            let Some(leaf) = leaf else { continue };
            match met[i] {
                Some(t) => {
                    let number = self.world.number(leaf);
                    if (t, number) < self.best[rays[i]] {
                        self.best[rays[i]] = (t, number);
                    }
                }
                None => {
                    self.test(rays[i], *leaf);
                }
            }
        }
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

impl<'a> Rays<bool> for AnyOfEach<'a> {
    type TreeRay = Seen<'a>;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Seen<'a>> {
        Some(Seen::new(&self.rays[ray]))
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Packet32> {
        seen_together(&self.rays[first..])
    }

    #[inline(always)]
    fn admits(&self, _: usize, _: Leaf) -> bool {
        true
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> bool {
        self.world.exactly(self.isa, &self.rays[ray], &leaf).is_some()
    }

    #[inline(always)]
    fn found(&mut self, ray: usize) {
        (self.t[ray], self.triangle[ray]) = (0.0, 0);
    }
}
