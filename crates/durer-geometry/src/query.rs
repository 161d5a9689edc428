//! The queries closest, any and all.

use crate::closest::ClosestHit;
use crate::context::RayContext;
use crate::geometry::{Geometry, slots};
use crate::ids::EVERYTHING;
use crate::{Hit, ObjectSpan, Span, spans::Tracks};
use core::ops::ControlFlow;
use durer_bvh::Leaf;
use durer_math::{Point3, Ray};
use durer_surfaces::{LocalPoint, LocalRay, Need, SurfacePoint};

/// A geometry restricted to the surfaces whose mask has a common bit with the query's.
///
/// Made by [`Geometry::masked`]. [`Masked::batch`] traces arrays of rays.
///
/// ```
/// use durer_geometry::{Geometry, ObjectId, PrimitiveId};
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::Sphere;
///
/// let ball = |x: f64| Sphere::new(Point3::new(x, 0.0, 0.0), 1.0);
/// let mut builder = Geometry::builder();
/// builder.add_as(ball(0.0)?, ObjectId(0), PrimitiveId(0), 0b01);
/// builder.add_as(ball(5.0)?, ObjectId(1), PrimitiveId(0), 0b10);
/// let scene = builder.build()?;
/// let ray = Ray::new(Point3::new(-3.0, 0.0, 0.0), Vec3::X);
/// assert_eq!(scene.all(&ray).len(), 4);
/// assert_eq!(scene.masked(0b10).all(&ray).len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Masked<'a> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) mask: u32,
}

impl Geometry {
    /// The queries of the surfaces whose mask has a common bit with `mask`.
    #[inline]
    pub fn masked(&self, mask: u32) -> Masked<'_> {
        Masked { geometry: self, mask }
    }

    /// [`Masked::closest`] of all surfaces.
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.masked(EVERYTHING).closest(ray)
    }

    /// [`Masked::any`] of all surfaces.
    pub fn any(&self, ray: &Ray) -> bool {
        self.masked(EVERYTHING).any(ray)
    }

    /// [`Masked::all`] of all surfaces.
    pub fn all(&self, ray: &Ray) -> Vec<Hit> {
        self.masked(EVERYTHING).all(ray)
    }

    /// [`Masked::spans`] of all solids.
    pub fn spans(&self, ray: &Ray) -> Vec<Span> {
        self.masked(EVERYTHING).spans(ray)
    }

    /// [`Masked::spans_by_object`] of all solids.
    pub fn spans_by_object(&self, ray: &Ray) -> Vec<ObjectSpan> {
        self.masked(EVERYTHING).spans_by_object(ray)
    }

    /// Whether the point lies inside or on a solid: exact.
    pub fn contains(&self, point: Point3) -> bool {
        self.side(point) != durer_surfaces::Side::Out
    }

    #[inline(always)]
    pub(crate) fn walk<R>(&self, ray: &Ray, mask: u32, f: impl FnOnce(&RayContext<'_>) -> R) -> Option<R> {
        self.walk_along(ray, LocalRay::new, mask, f)
    }

    /// `walk`, with brackets of the preview width.
    #[inline(always)]
    pub(crate) fn walk_roughly<R>(
        &self,
        ray: &Ray,
        mask: u32,
        f: impl FnOnce(&RayContext<'_>) -> R,
    ) -> Option<R> {
        self.walk_along(
            ray,
            #[inline(always)]
            |ray| LocalRay::new(ray).roughly(),
            mask,
            f,
        )
    }

    #[inline(always)]
    fn walk_along<R>(
        &self,
        ray: &Ray,
        local: impl FnOnce(&Ray) -> LocalRay<'static>,
        mask: u32,
        f: impl FnOnce(&RayContext<'_>) -> R,
    ) -> Option<R> {
        if !ray.is_valid() {
            self.count_invalid();
            return None;
        }
        Some(self.isa.run(
            #[inline(always)]
            || {
                let local = local(ray);
                f(&RayContext::new(self, ray, &local, mask))
            },
        ))
    }
}

impl Masked<'_> {
    /// The first hit: the least by (`t`, object, primitive), and of one primitive the first along
    /// the exact ray.
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.geometry.walk(ray, self.mask, |walk| {
            let mut best = ClosestHit::least();
            closest(walk, &mut best);
            best.hit
        })?
    }

    /// The first hit and its point, for pictures: brackets may be as wide as
    /// [`durer_surfaces::PREVIEW_WIDTH`] allows, so of two surfaces that are nearer to each other
    /// either may be returned. Whether anything is hit is exact.
    #[inline]
    pub fn first_visible(&self, ray: &Ray, need: Need) -> Option<(Hit, SurfacePoint)> {
        self.geometry.walk_roughly(
            ray,
            self.mask,
            #[inline(always)]
            |walk| {
                let mut best = ClosestHit::least();
                closest(walk, &mut best);
                let hit = best.hit?;
                Some((hit, self.geometry.point_of(walk.ray, ray.source(), &hit, need)))
            },
        )?
    }

    /// Whether anything is hit.
    pub fn any(&self, ray: &Ray) -> bool {
        self.geometry.walk_roughly(ray, self.mask, any).unwrap_or(false)
    }

    /// Whether there is a hit for which `accept` returns true. The hits come in no particular
    /// order, each at most once, and nothing is allocated.
    ///
    /// A result that must not depend on the order (a product of rounded numbers) is better computed
    /// from [`Masked::all_into`].
    pub fn any_where(&self, ray: &Ray, mut accept: impl FnMut(&Hit) -> bool) -> bool {
        let visit =
            &mut |hit: &Hit| if accept(hit) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        self.geometry.walk(ray, self.mask, |walk| each(walk, visit)).is_some_and(|flow| flow.is_break())
    }

    /// Every crossing, once, ascending in the order of [`Hit::order`].
    pub fn all(&self, ray: &Ray) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.all_into(ray, &mut hits);
        hits
    }

    /// [`Masked::all`] into a buffer that is cleared first and can be reused.
    pub fn all_into(&self, ray: &Ray, hits: &mut Vec<Hit>) {
        hits.clear();
        self.geometry.walk(ray, self.mask, |walk| {
            each(walk, &mut |hit| {
                hits.push(*hit);
                ControlFlow::Continue(())
            })
        });
        // Stable: two crossings of one surface may round to one t, and it reported them in their
        // exact order.
        hits.sort_by(Hit::order);
    }

    /// The intervals of the ray inside the union of all solids: merged, ascending; open surfaces
    /// are ignored.
    ///
    /// A ray that starts inside has `t_in = t_min` and no `object_in`. Unbounded solids are
    /// included. Touches have no length and are left out.
    pub fn spans(&self, ray: &Ray) -> Vec<Span> {
        self.tracks(ray).map_or_else(Vec::new, |tracks| tracks.merge(ray.t_min, ray.t_max))
    }

    /// The intervals of the ray inside each object: which solid it is in, from where to where.
    ///
    /// An object's own solids are merged as in [`Masked::spans`]; those of different objects are
    /// not, so where objects overlap each has its own interval. Ascending by `t_in`, then by
    /// object.
    ///
    /// ```
    /// use durer_geometry::Geometry;
    /// use durer_math::{Point3, Ray, Vec3};
    /// use durer_surfaces::Sphere;
    ///
    /// let ball = |x: f64| Sphere::new(Point3::new(x, 0.0, 0.0), 1.0);
    /// let scene = Geometry::builder().with(ball(0.0)?).with(ball(1.0)?).build()?;
    /// let spans = scene.spans_by_object(&Ray::new(Point3::new(-3.0, 0.0, 0.0), Vec3::X));
    /// let stretches: Vec<_> = spans.iter().map(|s| (s.object.0, s.span.t_in, s.span.t_out)).collect();
    /// assert_eq!(stretches, [(0, 2.0, 4.0), (1, 3.0, 5.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn spans_by_object(&self, ray: &Ray) -> Vec<ObjectSpan> {
        self.tracks(ray).map_or_else(Vec::new, |tracks| tracks.merge_by_object(ray.t_min, ray.t_max))
    }

    /// The crossings of all solids; `None` if the ray is not valid.
    fn tracks(&self, ray: &Ray) -> Option<Tracks> {
        self.geometry.walk(ray, self.mask, |walk| {
            let mut tracks = Tracks::new(self.mask);
            spans(walk, &LocalPoint::new(ray.origin), &mut tracks);
            tracks
        })
    }
}

/// Updates `best` with the hits of the ray in one geometry.
pub(crate) fn closest(walk: &RayContext<'_>, best: &mut ClosestHit) {
    walk.geometry.isa.run(
        #[inline(always)]
        || closest_here(walk, best),
    );
}

#[inline(always)]
fn closest_here(walk: &RayContext<'_>, best: &mut ClosestHit) {
    let geometry = walk.geometry;
    for beside in &geometry.beside {
        closest_in(walk, beside.leaf(), best);
    }
    let mut line = walk.line();
    if best.hit.is_some() {
        line.t_max = line.t_max.min(walk.limit(best.limit()));
    }
    geometry.tree.closest(
        geometry.isa,
        &line,
        #[inline(always)]
        |triangle| walk.admits(triangle),
        #[inline(always)]
        |leaf| {
            closest_in(walk, leaf, best);
            if best.hit.is_some() { walk.limit(best.limit()) } else { f64::INFINITY }
        },
    );
}

#[inline(always)]
pub(crate) fn closest_in(walk: &RayContext<'_>, leaf: Leaf, best: &mut ClosestHit) {
    let geometry = walk.geometry;
    match geometry.arenas.get(leaf.kind as usize) {
        Some(arena) => {
            (best.placement, best.arena) = (walk.placement, leaf.kind);
            arena.improve(geometry.isa, slots(&leaf), walk.ray, &walk.filter(leaf.kind), best);
        }
        None => {
            for i in slots(&leaf) {
                walk.enter(geometry.instance(i), |inner| closest(inner, best));
            }
        }
    }
}

fn any(walk: &RayContext<'_>) -> bool {
    walk.geometry.isa.run(
        #[inline(always)]
        || any_here(walk),
    )
}

#[inline(always)]
fn any_here(walk: &RayContext<'_>) -> bool {
    let geometry = walk.geometry;
    geometry.beside.iter().any(|b| any_in(walk, b.leaf()))
        || geometry.tree.any(
            geometry.isa,
            &walk.line(),
            #[inline(always)]
            |triangle| walk.admits(triangle),
            #[inline(always)]
            |leaf| any_in(walk, leaf),
        )
}

#[inline(always)]
pub(crate) fn any_in(walk: &RayContext<'_>, leaf: Leaf) -> bool {
    let geometry = walk.geometry;
    match geometry.arenas.get(leaf.kind as usize) {
        Some(arena) => {
            let mut best = ClosestHit::any();
            arena.improve(geometry.isa, slots(&leaf), walk.ray, &walk.filter(leaf.kind), &mut best);
            best.is_satisfied()
        }
        None => slots(&leaf).any(|i| walk.enter(geometry.instance(i), any) == Some(true)),
    }
}

/// Passes every hit to `visit`.
pub(crate) fn each(walk: &RayContext<'_>, visit: &mut dyn FnMut(&Hit) -> ControlFlow<()>) -> ControlFlow<()> {
    let geometry = walk.geometry;
    let mut test = |leaf: Leaf| {
        if geometry.is_instances(&leaf) {
            let stops = |i: u32| {
                walk.enter(geometry.instance(i), |inner| each(inner, visit)) == Some(ControlFlow::Break(()))
            };
            slots(&leaf).any(stops)
        } else {
            let arena = &geometry.arenas[leaf.kind as usize];
            let filter = walk.filter(leaf.kind);
            let placement = &walk.placement;
            let mut show = |slot, name, root| visit(&placement.hit(leaf.kind, slot, name, &root));
            arena.each(geometry.isa, slots(&leaf), walk.ray, &filter, &mut show).is_break()
        }
    };
    let stopped = geometry.beside.iter().any(|b| test(b.leaf()))
        || geometry.tree.each(geometry.isa, &walk.line(), &mut test);
    if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

fn spans(walk: &RayContext<'_>, start: &LocalPoint<'_>, tracks: &mut Tracks) {
    let geometry = walk.geometry;
    let gather = |leaf: Leaf, tracks: &mut Tracks| {
        if geometry.is_instances(&leaf) {
            for i in slots(&leaf) {
                let instance = geometry.instance(i);
                walk.enter(instance, |inner| spans(inner, &start.through(&instance.affine), tracks));
            }
        } else {
            (tracks.placement, tracks.arena) = (walk.placement, leaf.kind);
            tracks.source = walk.filter(leaf.kind).source;
            geometry.arenas[leaf.kind as usize].spans(geometry.isa, slots(&leaf), walk.ray, start, tracks);
        }
    };
    for beside in &geometry.beside {
        gather(beside.leaf(), tracks);
    }
    let line = walk.line();
    geometry.tree.each(geometry.isa, &line, |leaf| {
        gather(leaf, tracks);
        false
    });
    // The whole range may be inside a solid in parts without being near any of its parts.
    (tracks.placement, tracks.source) = (walk.placement, None);
    for solid in &geometry.solids_in_parts {
        tracks.arena = solid.arena;
        if line.may_meet(&solid.bounds) && !tracks.tell(solid.surface) {
            geometry.arenas[solid.arena as usize].start_of(solid.surface, walk.ray, start, tracks);
        }
    }
}
