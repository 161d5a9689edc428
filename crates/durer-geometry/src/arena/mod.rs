//! Arenas: one per concrete surface type, with one virtual call per leaf and static calls inside.
//!
//! A *slot* is an element of a tree's leaf: a surface, or one part of a surface that has several.
//! Slots are in the order of the leaves, so that a leaf is one contiguous range. If every surface
//! of an arena has one part, the surfaces themselves are sorted into that order, and slot and
//! surface have the same number.

mod arrange;
mod inside;

pub(crate) use self::arrange::{Arrange, Unsorted};

use self::inside::starts_inside;
use crate::closest::ClosestHit;
use crate::filter_cache::{FilterKind, SlotFilter};
use crate::ids::{Id, Ids};
use crate::spans::Tracks;
use core::ops::ControlFlow;
use core::ops::Range;
use durer_math::{Aabb, Isa, Point3, RaySide, Shaft};
use durer_surfaces::{
    Accelerate, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint,
};
use rayon::prelude::*;
use std::collections::HashMap;

/// The primitives of an arena that a ray can hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filter {
    /// The ray hits only surfaces whose mask has a common bit.
    pub(crate) mask: u32,
    /// The slot that the ray was spawned from, and the side on which it starts, if that slot is in
    /// this arena.
    pub(crate) source: Option<(u32, RaySide)>,
}

/// A receiver of hits: slot, numbers, root.
pub(crate) type Visit<'a> = dyn FnMut(u32, Id, Root) -> ControlFlow<()> + 'a;

/// The object-safe interface of an [`Arena`], for ranges of slots.
pub(crate) trait AnyArena: Send + Sync {
    /// Updates `best` with the slots of a leaf, until no further hit matters.
    fn improve(&self, isa: Isa, leaf: Range<u32>, ray: &LocalRay<'_>, filter: &Filter, best: &mut ClosestHit);
    /// Passes every hit of the leaf to `visit`, until it returns [`ControlFlow::Break`].
    fn each(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        visit: &mut Visit<'_>,
    ) -> ControlFlow<()>;
    /// Adds the crossings of the leaf's solids.
    fn spans(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        start: &LocalPoint<'_>,
        tracks: &mut Tracks,
    );
    /// Adds, for a solid of many parts, what the crossings of its parts do not decide: whether the
    /// ray starts inside.
    fn start_of(&self, surface: u32, ray: &LocalRay<'_>, start: &LocalPoint<'_>, tracks: &mut Tracks);
    /// Whether a ray starts inside the solid in a slot. The ray does not cross it in its range.
    fn starts_inside(&self, slot: u32, ray: &LocalRay<'_>) -> bool;
    /// Whether no ray of a bundle hits the surface in a slot; `true` is certain.
    fn misses(&self, slot: u32, shaft: &Shaft) -> bool;
    /// Whether no ray of a bundle that starts on this side of the surface in a slot hits it again;
    /// `true` is certain.
    fn is_left(&self, slot: u32, side: RaySide, shaft: &Shaft) -> bool;
    /// On which side of a surface a point lies; `Out` for open surfaces.
    fn side(&self, surface: u32, point: &LocalPoint<'_>) -> Side;
    /// The point of a hit.
    fn resolve(&self, isa: Isa, slot: u32, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;
    /// The packet filter of a slot.
    fn drawn(&self, slot: u32) -> SlotFilter;
    /// The packet filter of a solid of several parts, and the slots of its faces.
    fn solid(&self, surface: u32) -> (FilterKind, Vec<u32>);
    /// The mask of a slot.
    fn mask(&self, slot: u32) -> u32;
    /// The part of its surface that a slot holds.
    fn part(&self, slot: u32) -> PartId;
    /// The object and primitive numbers of a slot.
    fn name(&self, slot: u32) -> Id;
    /// The object of a surface.
    fn object_of(&self, surface: u32) -> u32;
    /// The surface that a slot holds, unless the slot is only a part of one.
    fn whole(&self, slot: u32) -> Option<u32>;
    /// The solids of several parts, with their boxes.
    fn solids_in_parts(&self) -> Vec<(u32, Aabb)>;
    /// The present box of each slot.
    fn slot_bounds(&self) -> Vec<Aabb>;
    /// Whether all slots are flat triangles.
    fn is_of_triangles(&self) -> bool;
    /// The corners of the triangle in a slot.
    fn slot_corners(&self, slot: u32) -> [Point3; 3];
    /// Access to the concrete arena.
    fn as_any(&mut self) -> &mut dyn core::any::Any;
    /// Converts to an arena that can be arranged anew.
    fn reopen(self: Box<Self>) -> Box<dyn Arrange>;
    /// The name of the surface in a slot.
    fn surface_name(&self, slot: u32) -> &'static str;
    /// How many slots there are.
    fn len(&self) -> u32;
    /// Bytes on the heap, without what the surfaces own in turn.
    fn bytes(&self) -> usize;
}

/// A slot of an arena whose surfaces have parts.
#[derive(Clone, Copy, Debug)]
struct PartRef {
    surface: u32,
    part: u32,
    /// Whether the surface has no other part.
    whole: bool,
}

/// All surfaces of one type.
pub(crate) struct Arena<S> {
    surfaces: Vec<S>,
    ids: Ids,
    /// `None` if every surface is one part.
    parts: Option<Vec<(PartRef, Aabb)>>,
    /// The parts without their boxes, after these have been put into the tree.
    placed: Vec<PartRef>,
}

impl<S> Default for Arena<S> {
    fn default() -> Self {
        Self { surfaces: Vec::new(), ids: Ids::default(), parts: None, placed: Vec::new() }
    }
}

impl<S: Accelerate + 'static> Arena<S> {
    pub(crate) fn push(&mut self, surface: S, id: Id, mask: u32) {
        self.surfaces.push(surface);
        self.ids.push(id, mask);
    }

    /// Replaces the surfaces for which `moved` returns one, if they have the same parts. Returns
    /// the old surfaces with their positions.
    pub(crate) fn replace(
        &mut self,
        mut moved: impl FnMut(Id, &S) -> Option<S>,
    ) -> Result<Vec<(usize, S)>, Id> {
        let parts = |surface: &S| {
            let mut parts = Vec::new();
            surface.parts(&mut |_, part| parts.push(part));
            parts
        };
        let mut new = Vec::new();
        for (i, surface) in self.surfaces.iter().enumerate() {
            let id = self.ids.name(i);
            let Some(other) = moved(id, surface) else { continue };
            let is_same = surface.is_in_parts() == other.is_in_parts()
                && (!surface.is_in_parts() || parts(surface) == parts(&other));
            if !is_same {
                return Err(id);
            }
            new.push((i, other));
        }
        self.swap(&mut new);
        Ok(new)
    }

    /// Replaces the surfaces for which `moved` returns one, whatever parts they have.
    pub(crate) fn renew(&mut self, mut moved: impl FnMut(Id, &S) -> Option<S>) {
        for (i, surface) in self.surfaces.iter_mut().enumerate() {
            if let Some(other) = moved(self.ids.name(i), surface) {
                *surface = other;
            }
        }
    }

    /// Exchanges surfaces with those at the given positions.
    pub(crate) fn swap(&mut self, others: &mut [(usize, S)]) {
        for (i, other) in others {
            core::mem::swap(&mut self.surfaces[*i], other);
        }
    }

    /// Calls `f` with each slot of a leaf that the mask admits, and the ray; if the ray starts on
    /// the slot, it carries its side.
    #[inline(always)]
    fn walk(
        &self,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        mut f: impl FnMut(Slot<'_, S>, &LocalRay<'_>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for slot in leaf {
            let item = self.slot(slot);
            if !self.ids.admits(item.index, filter.mask) {
                continue;
            }
            // Only one call of `f`, as the code inlined here is large.
            let started;
            let ray = match filter.source {
                Some((source, side)) if source == slot => {
                    started = ray.from_side(Some(side));
                    &started
                }
                _ => ray,
            };
            f(item, ray)?;
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn slot(&self, slot: u32) -> Slot<'_, S> {
        // An arena without parts has no list of them: slot and surface have the same number.
        let (index, part, whole) = match self.placed.get(slot as usize) {
            Some(p) => (p.surface as usize, PartId(p.part), p.whole),
            None => (slot as usize, PartId(0), true),
        };
        Slot { arena: self, surface: &self.surfaces[index], index, slot, part, whole }
    }
}

/// A slot with its surface.
struct Slot<'a, S> {
    arena: &'a Arena<S>,
    surface: &'a S,
    index: usize,
    slot: u32,
    part: PartId,
    whole: bool,
}

impl<S: Accelerate> Slot<'_, S> {
    /// Passes the roots to any sink. Compiled once per path; [`AnyArena::improve`] has a copy of
    /// its own.
    #[inline(never)]
    fn show(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        isa.run(
            #[inline(always)]
            || self.surface.part_roots(self.part, ray, sink),
        );
    }

    /// The object and primitive numbers: parts of a surface may be primitives of their own.
    #[inline(always)]
    fn name(&self) -> Id {
        let id = self.arena.ids.name(self.index);
        Id { primitive: id.primitive.wrapping_add(self.surface.primitive_of(self.part)), ..id }
    }
}

/// A root with its `t` moved into the ray's range, where the exact crossing is: rounding may have
/// put it a step outside. `None` if the exact `t` exceeds the range of f64.
#[inline(always)]
fn in_range(mut root: Root, ray: &LocalRay<'_>) -> Option<Root> {
    root.t = if root.t < ray.t_min {
        ray.t_min
    } else if root.t > ray.t_max {
        ray.t_max
    } else {
        root.t
    };
    if root.t.is_finite() { Some(root) } else { brought_back(root, ray) }
}

/// A root whose infinite `t` is replaced by the nearest finite number; `None` if the crossing
/// itself is beyond.
#[cold]
fn brought_back(root: Root, ray: &LocalRay<'_>) -> Option<Root> {
    let t = root.t.clamp(f64::MIN, f64::MAX);
    (root.lo <= t && t <= root.hi && ray.t_min <= t && t <= ray.t_max).then_some(Root { t, ..root })
}

/// The whole line: a surface's results must not depend on earlier hits.
const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// A sink that compares the roots of one slot with the best so far.
struct Challenger<'a> {
    slot: u32,
    name: Id,
    ray: &'a LocalRay<'a>,
    best: &'a mut ClosestHit,
}

impl Sink for Challenger<'_> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        ALL
    }

    #[inline(always)]
    fn limit(&self) -> f64 {
        self.best.limit()
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        // Roots ascend: once one is not better, the later ones are not either.
        let Some(root) = in_range(root, self.ray) else { return ControlFlow::Continue(()) };
        if self.best.offer(self.slot, self.name, &root) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    }
}

/// A sink that passes roots to a visitor.
struct Forward<'a, 'b> {
    slot: u32,
    name: Id,
    ray: &'a LocalRay<'a>,
    visit: &'a mut Visit<'b>,
    flow: ControlFlow<()>,
}

impl Sink for Forward<'_, '_> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        ALL
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if self.flow.is_continue()
            && let Some(root) = in_range(root, self.ray)
        {
            self.flow = (self.visit)(self.slot, self.name, root);
        }
        self.flow
    }
}

impl<S: Accelerate + 'static> AnyArena for Arena<S> {
    fn improve(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        best: &mut ClosestHit,
    ) {
        let _ = isa.run(
            #[inline(always)]
            || {
                self.walk(
                    leaf,
                    ray,
                    filter,
                    #[inline(always)]
                    |slot, ray| {
                        let challenger = &mut Challenger { slot: slot.slot, name: slot.name(), ray, best };
                        slot.surface.part_roots(slot.part, ray, challenger);
                        if best.is_satisfied() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                    },
                )
            },
        );
    }

    fn each(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        visit: &mut Visit<'_>,
    ) -> ControlFlow<()> {
        self.walk(leaf, ray, filter, |slot, ray| {
            let (name, flow) = (slot.name(), ControlFlow::Continue(()));
            let mut forward = Forward { slot: slot.slot, name, ray, visit, flow };
            slot.show(isa, ray, &mut forward);
            forward.flow
        })
    }

    fn spans(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        start: &LocalPoint<'_>,
        tracks: &mut Tracks,
    ) {
        let filter = tracks.filter();
        let _ = self.walk(leaf, ray, &filter, |slot, ray| {
            if slot.surface.solidity() == Solidity::Solid {
                let before = tracks.len();
                let (name, flow) = (slot.name(), ControlFlow::Continue(()));
                let visit = &mut |_: u32, _: Id, root: Root| {
                    tracks.push(slot.index as u32, slot.part, name, &root);
                    ControlFlow::Continue(())
                };
                slot.show(isa, ray, &mut Forward { slot: slot.slot, name, ray, visit, flow });
                if slot.whole && !tracks.tell_from(before) {
                    tracks.start(slot.index as u32, name, starts_inside(slot.surface, ray, start));
                }
            }
            ControlFlow::Continue(())
        });
    }

    fn start_of(&self, surface: u32, ray: &LocalRay<'_>, start: &LocalPoint<'_>, tracks: &mut Tracks) {
        if self.ids.admits(surface as usize, tracks.filter().mask) {
            let inside = starts_inside(&self.surfaces[surface as usize], ray, start);
            tracks.start(surface, self.ids.name(surface as usize), inside);
        }
    }

    fn starts_inside(&self, slot: u32, ray: &LocalRay<'_>) -> bool {
        starts_inside(self.slot(slot).surface, ray, &LocalPoint::along(ray, 0.0))
    }

    fn misses(&self, slot: u32, shaft: &Shaft) -> bool {
        self.slot(slot).surface.misses(shaft)
    }

    fn is_left(&self, slot: u32, side: RaySide, shaft: &Shaft) -> bool {
        self.slot(slot).surface.is_left(side, shaft)
    }

    fn side(&self, surface: u32, point: &LocalPoint<'_>) -> Side {
        let surface = &self.surfaces[surface as usize];
        if surface.solidity() != Solidity::Solid {
            return Side::Out;
        }
        Isa::detect().run(
            #[inline(always)]
            || surface.side(point),
        )
    }

    fn resolve(&self, isa: Isa, slot: u32, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let surface = self.slot(slot).surface;
        isa.run(
            #[inline(always)]
            || surface.resolve(ray, root, need),
        )
    }

    fn drawn(&self, slot: u32) -> SlotFilter {
        let Slot { surface, part, whole, .. } = self.slot(slot);
        let sketch = surface.packet_filter(part);
        // The surface's own box is tighter, unless the slot is a part of it.
        let bounds = if whole { surface.bounds() } else { sketch.bounds() };
        SlotFilter { seen: FilterKind::of(&sketch), bounds }
    }

    fn solid(&self, surface: u32) -> (FilterKind, Vec<u32>) {
        let (sketch, parts) = self.surfaces[surface as usize].solid_packet_filter();
        let slot_of = |part: PartId| {
            let slot = self.placed.iter().position(|p| p.surface == surface && p.part == part.0);
            slot.map_or(surface, |slot| slot as u32)
        };
        (FilterKind::of(&sketch), parts.into_iter().map(slot_of).collect())
    }

    fn mask(&self, slot: u32) -> u32 {
        self.ids.mask(self.slot(slot).index)
    }

    fn part(&self, slot: u32) -> PartId {
        self.slot(slot).part
    }

    fn name(&self, slot: u32) -> Id {
        self.slot(slot).name()
    }

    fn object_of(&self, surface: u32) -> u32 {
        self.ids.name(surface as usize).object
    }

    fn whole(&self, slot: u32) -> Option<u32> {
        let slot = self.slot(slot);
        slot.whole.then_some(slot.index as u32)
    }

    fn solids_in_parts(&self) -> Vec<(u32, Aabb)> {
        let mut surfaces: Vec<u32> = self.placed.iter().filter(|p| !p.whole).map(|p| p.surface).collect();
        surfaces.sort_unstable();
        surfaces.dedup();
        let solid = |i: &u32| self.surfaces[*i as usize].solidity() == Solidity::Solid;
        surfaces.into_iter().filter(solid).map(|i| (i, self.surfaces[i as usize].bounds())).collect()
    }

    fn slot_bounds(&self) -> Vec<Aabb> {
        if self.placed.is_empty() {
            return self.surfaces.par_iter().map(Surface::bounds).collect();
        }
        if self.is_of_triangles() {
            return (0..self.len())
                .into_par_iter()
                .map(|slot| Aabb::from_points(self.slot_corners(slot)))
                .collect();
        }
        let mut parts = HashMap::new();
        for (surface, s) in self.surfaces.iter().enumerate() {
            s.parts(&mut |bounds, part| {
                parts.insert((surface as u32, part.0), bounds);
            });
        }
        // A part that no longer exists has an empty box.
        self.placed.iter().map(|p| parts.get(&(p.surface, p.part)).copied().unwrap_or(Aabb::EMPTY)).collect()
    }

    fn is_of_triangles(&self) -> bool {
        // Either all surfaces of a type are triangles, or none.
        self.surfaces.first().is_some_and(|surface| surface.corners(PartId(0)).is_some())
    }

    fn slot_corners(&self, slot: u32) -> [Point3; 3] {
        let Slot { surface, part, .. } = self.slot(slot);
        surface.corners(part).unwrap_or([Point3::ORIGIN; 3])
    }

    fn as_any(&mut self) -> &mut dyn core::any::Any {
        self
    }

    fn reopen(self: Box<Self>) -> Box<dyn Arrange> {
        self
    }

    fn surface_name(&self, slot: u32) -> &'static str {
        self.slot(slot).surface.name()
    }

    fn len(&self) -> u32 {
        if self.placed.is_empty() { self.surfaces.len() as u32 } else { self.placed.len() as u32 }
    }

    fn bytes(&self) -> usize {
        self.surfaces.capacity() * size_of::<S>()
            + self.ids.bytes()
            + self.placed.capacity() * size_of::<PartRef>()
    }
}
