//! Rays that go through a tree side by side: see [`durer_bvh::Rays`].

use crate::Hit;
use crate::best::Best;
use crate::geometry::Geometry;
use crate::ids::EVERYTHING;
use crate::query::{any_in, closest_in};
use crate::walk::Walk;
use durer_bvh::{Glance, Glances, Leaf, Line, PACKET, Rays, Sight};
use durer_math::Ray;
use durer_surfaces::LocalRay;

/// A tree of fewer things is in the cache, where single rays are as fast.
const LEAST: usize = 1 << 12;

/// How many rays of a batch are prepared at a time.
pub(crate) const ABREAST: usize = 256;

impl Geometry {
    /// [`Geometry::closest`] of a few rays.
    pub(crate) fn closest_abreast(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        if self.tree.len() < LEAST {
            hits.extend(rays.iter().map(|ray| self.closest(ray)));
            return;
        }
        let mut best: Vec<Best> = Vec::with_capacity(rays.len());
        best.resize_with(rays.len(), Best::least);
        let mut all = Closest { all: All::of(self, rays), best };
        self.tree.closest_of_each(self.isa, rays.len(), &mut all);
        hits.extend(all.best.into_iter().map(|best| best.hit));
    }

    /// [`Geometry::any`] of a few rays.
    pub(crate) fn any_abreast(&self, rays: &[Ray], hits: &mut Vec<bool>) {
        if self.tree.len() < LEAST {
            hits.extend(rays.iter().map(|ray| self.any(ray)));
            return;
        }
        let mut all = Any { all: All::of(self, rays), met: vec![false; rays.len()] };
        self.tree.any_of_each(self.isa, rays.len(), &mut all);
        hits.append(&mut all.met);
    }
}

/// Rays, and those under way in the geometry's frame.
struct All<'a> {
    geometry: &'a Geometry,
    rays: &'a [Ray],
    locals: Vec<LocalRay<'static>>,
    /// The last eight rays that were asked for together, from this one on, as the tree sees them.
    together: (usize, [Option<Line>; PACKET]),
}

impl<'a> All<'a> {
    fn of(geometry: &'a Geometry, rays: &'a [Ray]) -> Self {
        Self { geometry, rays, locals: Vec::with_capacity(rays.len()), together: (0, [None; PACKET]) }
    }

    /// Makes ready the next ray: they are asked for in their order.
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

    /// Whether eight rays look as if they could go together: the first and the last have much the same direction.
    #[inline(always)]
    fn are_alike(&self, first: usize) -> bool {
        let Some([a, .., b]) = self.rays[first..].first_chunk::<PACKET>() else { return false };
        (a.direction - b.direction).max_abs() <= a.direction.max_abs() * (1.0 / 8.0)
    }

    /// The line of a ray that was made ready together with others.
    #[inline(always)]
    fn made_ready(&self, ray: usize) -> Option<Option<Line>> {
        if ray < self.locals.len() { self.together.1.get(ray - self.together.0).copied() } else { None }
    }

    #[inline(always)]
    fn walk(&self, ray: usize) -> Walk<'_> {
        Walk::new(self.geometry, &self.rays[ray], &self.locals[ray], EVERYTHING)
    }
}

struct Closest<'a> {
    all: All<'a>,
    best: Vec<Best>,
}

impl Closest<'_> {
    /// Makes a ray ready; `None` if it is to meet nothing more.
    #[inline(always)]
    fn ready(&mut self, ray: usize) -> Option<Line> {
        if !self.all.start(ray, LocalRay::new(&self.all.rays[ray])) {
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
    type Sight = Line;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Line> {
        match self.all.made_ready(ray) {
            Some(line) => line,
            None => self.ready(ray),
        }
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Glances> {
        if !self.all.are_alike(first) {
            return None;
        }
        let (mut lines, mut glances) = ([None; PACKET], [Glance::NOTHING; PACKET]);
        for (i, (line, glance)) in lines.iter_mut().zip(&mut glances).enumerate() {
            *line = self.ready(first + i);
            if let Some(line) = line {
                *glance = line.glance();
            }
        }
        self.all.together = (first, lines);
        Glances::of(&glances)
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
    met: Vec<bool>,
}

impl Any<'_> {
    /// Makes a ray ready; `None` if it is to meet nothing more.
    #[inline(always)]
    fn ready(&mut self, ray: usize) -> Option<Line> {
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
    type Sight = Line;

    #[inline(always)]
    fn sight(&mut self, ray: usize) -> Option<Line> {
        match self.all.made_ready(ray) {
            Some(line) => line,
            None => self.ready(ray),
        }
    }

    #[inline(always)]
    fn glances(&mut self, first: usize) -> Option<Glances> {
        if !self.all.are_alike(first) {
            return None;
        }
        let (mut lines, mut glances) = ([None; PACKET], [Glance::NOTHING; PACKET]);
        for (i, (line, glance)) in lines.iter_mut().zip(&mut glances).enumerate() {
            *line = self.ready(first + i);
            if let Some(line) = line {
                *glance = line.glance();
            }
        }
        self.all.together = (first, lines);
        Glances::of(&glances)
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
