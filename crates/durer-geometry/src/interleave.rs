//! Queries of several rays that traverse a tree at the same time: see [`durer_bvh::Rays`].

use crate::Hit;
use crate::closest::ClosestHit;
use crate::context::RayContext;
use crate::geometry::Geometry;
use crate::query::{any_in, closest_in};
use durer_bvh::{Leaf, PACKET, Packet32, Ray32, Ray64, Rays};
use durer_math::Ray;
use durer_surfaces::{LocalRay, Need, SurfacePoint};

/// A tree of fewer entries fits into the cache, where single rays are as fast.
const LEAST: usize = 1 << 12;

/// How many rays of a batch are set up at a time.
pub(crate) const ABREAST: usize = 256;

impl Geometry {
    /// [`Masked::closest`](crate::Masked::closest) of a few rays.
    pub(crate) fn closest_abreast(&self, rays: &[Ray], mask: u32, hits: &mut Vec<Option<Hit>>) {
        if self.tree.len() < LEAST {
            hits.extend(rays.iter().map(|ray| self.masked(mask).closest(ray)));
            return;
        }
        let mut memory = Abreast::default();
        let mut all = Closest::of(self, rays, mask, false, &mut memory);
        self.tree.closest_of_each(self.isa, rays.len(), &mut all);
        hits.extend(memory.best.into_iter().map(|best| best.hit));
    }

    /// [`Masked::first_visible`](crate::Masked::first_visible) of a few rays; `put` receives the
    /// answers with their rays' numbers.
    pub(crate) fn seen_abreast(
        &self,
        rays: &[Ray],
        mask: u32,
        need: Need,
        memory: &mut Abreast,
        mut put: impl FnMut(usize, Option<(Hit, SurfacePoint)>),
    ) {
        if self.tree.len() < LEAST || rays.len() == 1 {
            rays.iter().enumerate().for_each(|(i, ray)| put(i, self.masked(mask).first_visible(ray, need)));
            return;
        }
        let mut all = Closest::of(self, rays, mask, true, memory);
        self.tree.closest_of_each(self.isa, rays.len(), &mut all);
        for (i, (ray, best)) in rays.iter().zip(&memory.best).enumerate() {
            let point = |hit| (hit, self.point_of(&memory.locals[i], ray.source(), &hit, need));
            put(i, best.hit.map(point));
        }
    }

    /// [`Masked::any`](crate::Masked::any) of a few rays; `put` receives the answers with their rays'
    /// numbers.
    pub(crate) fn any_abreast(
        &self,
        rays: &[Ray],
        mask: u32,
        memory: &mut Abreast,
        mut put: impl FnMut(usize, bool),
    ) {
        if self.tree.len() < LEAST || rays.len() == 1 {
            rays.iter().enumerate().for_each(|(i, ray)| put(i, self.masked(mask).any(ray)));
            return;
        }
        let Abreast { locals, met, .. } = memory;
        met.clear();
        met.resize(rays.len(), false);
        let mut all = Any { all: All::of(self, rays, mask, locals), met };
        self.tree.any_of_each(self.isa, rays.len(), &mut all);
        met.iter().enumerate().for_each(|(i, &is_met)| put(i, is_met));
    }
}

/// Reusable memory for rays under way.
#[derive(Debug, Default)]
pub(crate) struct Abreast {
    locals: Vec<LocalRay<'static>>,
    best: Vec<ClosestHit>,
    met: Vec<bool>,
}

/// The rays of a query; those that have started are also in the geometry's frame.
struct All<'a> {
    geometry: &'a Geometry,
    rays: &'a [Ray],
    mask: u32,
    locals: &'a mut Vec<LocalRay<'static>>,
    /// The last sixteen rays that were set up in groups of eight, in the tree's form, each at its
    /// number modulo sixteen: a group of eight may have to wait for the next one.
    together: [Option<Ray64>; 2 * PACKET],
}

impl<'a> All<'a> {
    fn of(
        geometry: &'a Geometry,
        rays: &'a [Ray],
        mask: u32,
        locals: &'a mut Vec<LocalRay<'static>>,
    ) -> Self {
        locals.clear();
        locals.reserve(rays.len());
        Self { geometry, rays, mask, locals, together: [None; 2 * PACKET] }
    }

    /// Starts the next ray; the tree requests them in their order.
    #[inline(always)]
    fn start(&mut self, ray: usize, local: LocalRay<'static>) -> bool {
        debug_assert_eq!(ray, self.locals.len());
        self.locals.push(local);
        let is_valid = self.rays[ray].is_valid();
        if !is_valid {
            self.geometry.count_invalid();
        }
        is_valid
    }

    /// A guess whether eight rays can form a packet: whether the first and the last have similar
    /// directions.
    #[inline(always)]
    fn are_alike(&self, first: usize) -> bool {
        let Some([a, .., b]) = self.rays[first..].first_chunk::<PACKET>() else { return false };
        (a.direction - b.direction).max_abs() <= a.direction.max_abs() * (1.0 / 8.0)
    }

    /// The result of the set-up of a ray, if it was set up in a group.
    #[inline(always)]
    fn made_ready(&self, ray: usize) -> Option<Option<Ray64>> {
        (ray < self.locals.len()).then(|| self.together[ray % (2 * PACKET)])
    }

    #[inline(always)]
    fn walk(&self, ray: usize) -> RayContext<'_> {
        RayContext::new(self.geometry, &self.rays[ray], &self.locals[ray], self.mask)
    }
}

struct Closest<'a> {
    all: All<'a>,
    best: &'a mut Vec<ClosestHit>,
    /// Whether the preview width of brackets suffices.
    rough: bool,
}

impl<'a> Closest<'a> {
    fn of(
        geometry: &'a Geometry,
        rays: &'a [Ray],
        mask: u32,
        rough: bool,
        Abreast { locals, best, .. }: &'a mut Abreast,
    ) -> Self {
        best.clear();
        best.resize_with(rays.len(), ClosestHit::least);
        Self { all: All::of(geometry, rays, mask, locals), best, rough }
    }

    /// Sets up a ray; `None` if nothing in the tree matters to it.
    #[inline(always)]
    fn ready(&mut self, ray: usize) -> Option<Ray64> {
        let local = LocalRay::new(&self.all.rays[ray]);
        if !self.all.start(ray, if self.rough { local.roughly() } else { local }) {
            return None;
        }
        let (walk, best) = (self.all.walk(ray), &mut self.best[ray]);
        for beside in &walk.geometry.beside {
            closest_in(&walk, beside.leaf(), best);
        }
        let mut line = walk.line();
        if best.hit.is_some() {
            line.t_max = line.t_max.min(walk.limit(best.limit()));
        }
        Some(line)
    }
}

impl Rays<f64> for Closest<'_> {
    type TreeRay = Ray64;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Ray64> {
        match self.all.made_ready(ray) {
            Some(line) => line,
            None => self.ready(ray),
        }
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Packet32> {
        if !self.all.are_alike(first) {
            return None;
        }
        let mut glances = [Ray32::NOTHING; PACKET];
        for (ray, glance) in (first..).zip(&mut glances) {
            let line = self.ready(ray);
            if let Some(line) = &line {
                *glance = self.all.geometry.tree.glance(line);
            }
            self.all.together[ray % (2 * PACKET)] = line;
        }
        Packet32::of(&glances)
    }

    #[inline(always)]
    fn admits(&self, ray: usize, triangle: Leaf) -> bool {
        self.all.walk(ray).admits(triangle)
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> f64 {
        let (walk, best) = (self.all.walk(ray), &mut self.best[ray]);
        closest_in(&walk, leaf, best);
        if best.hit.is_some() { walk.limit(best.limit()) } else { f64::INFINITY }
    }

    fn found(&mut self, _: usize) {}
}

struct Any<'a> {
    all: All<'a>,
    met: &'a mut [bool],
}

impl Any<'_> {
    /// Sets up a ray; `None` if nothing in the tree matters to it.
    #[inline(always)]
    fn ready(&mut self, ray: usize) -> Option<Ray64> {
        if !self.all.start(ray, LocalRay::new(&self.all.rays[ray]).roughly()) {
            return None;
        }
        let walk = self.all.walk(ray);
        if walk.geometry.beside.iter().any(|b| any_in(&walk, b.leaf())) {
            self.met[ray] = true;
            return None;
        }
        Some(walk.line())
    }
}

impl Rays<bool> for Any<'_> {
    type TreeRay = Ray64;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Ray64> {
        match self.all.made_ready(ray) {
            Some(line) => line,
            None => self.ready(ray),
        }
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Packet32> {
        if !self.all.are_alike(first) {
            return None;
        }
        let mut glances = [Ray32::NOTHING; PACKET];
        for (ray, glance) in (first..).zip(&mut glances) {
            let line = self.ready(ray);
            if let Some(line) = &line {
                *glance = self.all.geometry.tree.glance(line);
            }
            self.all.together[ray % (2 * PACKET)] = line;
        }
        Packet32::of(&glances)
    }

    #[inline(always)]
    fn admits(&self, ray: usize, triangle: Leaf) -> bool {
        self.all.walk(ray).admits(triangle)
    }

    #[inline(always)]
    fn test(&mut self, ray: usize, leaf: Leaf) -> bool {
        any_in(&self.all.walk(ray), leaf)
    }

    #[inline(always)]
    fn found(&mut self, ray: usize) {
        self.met[ray] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EVERYTHING, ObjectId, PrimitiveId};
    use durer_math::{Isa, Point3, Vec3};
    use durer_surfaces::{Mesh, MeshData, Plane, Sphere};

    /// A hilly sheet of 8192 triangles, 900 balls half sunk into it, every other one visible to
    /// some rays only, and a plane below.
    fn world(isa: Isa) -> Geometry {
        const SIDE: u32 = 64;
        let height = |i: u32, j: u32| f64::from((i * i + 3 * j * j + i * j) % 17) / 16.0;
        let at = |i: u32, j: u32| i * (SIDE + 1) + j;
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        for i in 0..=SIDE {
            for j in 0..=SIDE {
                vertices.push(Point3::new(f64::from(i), f64::from(j), height(i, j)));
                if i < SIDE && j < SIDE {
                    faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        let mut builder = Geometry::builder().isa(isa);
        builder.add(Mesh::new(MeshData { vertices, faces, ..MeshData::default() }).unwrap());
        for n in 0..900_u32 {
            let (i, j) = (2 * (n / 30) + 1, 2 * (n % 30) + 1);
            let ball = Sphere::new(Point3::new(f64::from(i), f64::from(j), height(i, j)), 0.6).unwrap();
            builder.add_as(ball, ObjectId(1 + n), PrimitiveId(0), if n % 2 == 0 { EVERYTHING } else { 2 });
        }
        builder.add(Plane::new(Vec3::Z, -1.0).unwrap());
        builder.build().unwrap()
    }

    /// Rays at the same time get the answers of single rays, to the bit: camera rays, rays that
    /// leave their hits, and some invalid rays.
    #[test]
    fn what_is_seen_abreast_is_what_is_seen() {
        for isa in Isa::available() {
            let geometry = world(isa);
            let mut rays: Vec<Ray> = (0..2048_u32)
                .map(|n| {
                    let (x, y) = (f64::from(n % 64), f64::from(n / 64));
                    Ray::new(Point3::new(30.3, -20.1, 40.2), Vec3::new(x - 31.9, 20.0 + 2.0 * y, -40.0))
                })
                .collect();
            rays[77].direction = Vec3::ZERO;
            let mut memory = Abreast::default();
            let mut hits = 0;
            for (generation, mask) in [(0, EVERYTHING), (1, 1), (2, 2)] {
                let mut next = Vec::new();
                let mut rest = rays.as_slice();
                for count in (1..=40).cycle() {
                    let (some, others) = rest.split_at(rest.len().min(count));
                    rest = others;
                    let mut told = 0;
                    geometry.seen_abreast(some, mask, Need::SHADING_NORMAL, &mut memory, |i, seen| {
                        assert_eq!(i, told);
                        told += 1;
                        assert_eq!(
                            seen,
                            geometry.masked(mask).first_visible(&some[i], Need::SHADING_NORMAL),
                            "{generation}: {:?}",
                            some[i]
                        );
                        if let Some((hit, point)) = seen {
                            hits += 1;
                            let away = f64::from(hit.object.0 % 5) - 2.0;
                            next.push(point.spawn(Vec3::new(away, f64::from(i as u32 % 7) - 3.0, 1.0)));
                        }
                    });
                    assert_eq!(told, some.len());
                    told = 0;
                    geometry.any_abreast(some, mask, &mut memory, |i, is_met| {
                        assert_eq!(i, told);
                        told += 1;
                        assert_eq!(
                            is_met,
                            geometry.masked(mask).any(&some[i]),
                            "{generation}: {:?}",
                            some[i]
                        );
                    });
                    assert_eq!(told, some.len());
                    if rest.is_empty() {
                        break;
                    }
                }
                rays = next;
            }
            assert!(hits > 2500, "{hits}");
        }
    }
}
