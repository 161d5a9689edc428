//! One arena per concrete surface type: one virtual call per leaf, static inside.
//!
//! A *slot* is what a tree's leaf holds: a surface, or one part of a surface that has several. Slots are kept in the
//! order of the leaves, so that a leaf is one contiguous range. Where every surface of an arena has one part, the surfaces
//! themselves are moved into that order, and slot and surface are the same number.

use crate::best::Best;
use crate::ids::{Id, Ids};
use crate::outlines::{Drawn, Seen};
use crate::spans::Tracks;
use core::ops::Range;
use durer_bvh::{Entry, Frame};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Isa, Point3, RaySide, Shaft};
use durer_surfaces::{
    Flow, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint,
};
use rayon::prelude::*;
use std::collections::HashMap;

/// What a ray meets of an arena.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filter {
    /// Surfaces with a common bit are met.
    pub(crate) mask: u32,
    /// The slot that the ray was spawned from and the side on which it starts, if it is in this arena.
    pub(crate) source: Option<(u32, RaySide)>,
}

/// A receiver of hits: slot, name, root.
pub(crate) type Visit<'a> = dyn FnMut(u32, Id, Root) -> Flow + 'a;

/// The object-safe face of an [`Arena`], for ranges of slots.
pub(crate) trait AnyArena: Send + Sync {
    /// Improves `best` by the slots of a leaf, until it is satisfied.
    fn improve(&self, isa: Isa, leaf: Range<u32>, ray: &LocalRay<'_>, filter: &Filter, best: &mut Best);
    /// Shows every hit of the leaf to `visit`, until it says stop.
    fn each(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        visit: &mut Visit<'_>,
    ) -> Flow;
    /// Adds the crossings of the leaf's solids.
    fn spans(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        start: &LocalPoint<'_>,
        tracks: &mut Tracks,
    );
    /// Adds what a solid of many parts needs to know beside the crossings of its parts: whether the ray starts inside.
    fn start_of(&self, surface: u32, ray: &LocalRay<'_>, start: &LocalPoint<'_>, tracks: &mut Tracks);
    /// Whether a ray starts inside the solid in a slot, which it does not cross in its range.
    fn starts_inside(&self, slot: u32, ray: &LocalRay<'_>) -> bool;
    /// Whether no ray of a bundle meets the surface in a slot: `true` is certain.
    fn misses(&self, slot: u32, shaft: &Shaft) -> bool;
    /// Whether no ray of a bundle that starts on this side of the surface in a slot comes back to it: `true` is certain.
    fn is_left(&self, slot: u32, side: RaySide, shaft: &Shaft) -> bool;
    /// On which side of a surface a point lies; `Out` for open surfaces.
    fn side(&self, surface: u32, point: &LocalPoint<'_>) -> Side;
    /// The point of a hit.
    fn resolve(&self, isa: Isa, slot: u32, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint;
    /// A slot as lanes see it.
    fn drawn(&self, slot: u32) -> Drawn;
    /// A solid of several parts as lanes see it, and the slots of its faces.
    fn solid(&self, surface: u32) -> (Seen, Vec<u32>);
    /// Which rays meet a slot.
    fn mask(&self, slot: u32) -> u32;
    /// Which part of its surface a slot is.
    fn part(&self, slot: u32) -> PartId;
    /// The name of a slot.
    fn name(&self, slot: u32) -> Id;
    /// The object of a surface.
    fn object_of(&self, surface: u32) -> u32;
    /// The surface of which a slot is all, if it is not a part of one.
    fn whole(&self, slot: u32) -> Option<u32>;
    /// Solids of several parts, with their boxes.
    fn solids_in_parts(&self) -> Vec<(u32, Aabb)>;
    /// The box of each slot, as it is now.
    fn slot_bounds(&self) -> Vec<Aabb>;
    /// Whether all slots are flat triangles.
    fn is_of_triangles(&self) -> bool;
    /// The corners of the triangle in a slot.
    fn slot_corners(&self, slot: u32) -> [Point3; 3];
    /// For taking the concrete arena back.
    fn as_any(&mut self) -> &mut dyn core::any::Any;
    /// The type's name.
    fn type_name(&self) -> &'static str;
    /// How many slots there are.
    fn len(&self) -> u32;
    /// Heap memory held, without what the surfaces own in turn.
    fn bytes(&self) -> usize;
}

/// What the builder asks of an arena.
pub(crate) trait Arrange: AnyArena {
    /// Lists the parts; no surface is added afterwards.
    fn seal(&mut self);
    /// The box of all bounded slots, each cut by its object's limit, if there is one.
    fn extent(&self, limits: &[Aabb]) -> Aabb;
    /// Appends the bounded slots, cut like that, as entries of the given kind, to `entries`, and sorts out the others.
    fn entries(&self, frame: &Frame, kind: u32, limits: &[Aabb], entries: &mut Vec<Entry>) -> Unsorted;
    /// The corners of a triangle, by its number in [`Arrange::entries`].
    fn corners(&self, index: u32) -> [Point3; 3];
    /// Puts the slots into a new order: the new slot `i` is the old `order[i]`. The array is used up.
    fn arrange(&mut self, order: Vec<u32>);
    /// As the arena of a finished geometry.
    fn finish(self: Box<Self>) -> Box<dyn AnyArena>;
}

/// Slots that no tree holds.
#[derive(Debug, Default)]
pub(crate) struct Unsorted {
    /// Unbounded, or with a box that is not a number: nothing can be disproved, so they are always tested.
    pub(crate) beside: Vec<u32>,
    /// Empty: there is nothing to meet.
    pub(crate) nothing: Vec<u32>,
}

impl Unsorted {
    pub(crate) fn take(&mut self, entry: &Entry) {
        if entry.is_empty() {
            self.nothing.push(entry.index());
        } else if !entry.is_bounded() {
            self.beside.push(entry.index());
        }
    }

    fn is_empty(&self) -> bool {
        self.beside.is_empty() && self.nothing.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.beside.len() + self.nothing.len()
    }
}

/// A slot of an arena whose surfaces have parts.
#[derive(Clone, Copy, Debug)]
struct PartRef {
    surface: u32,
    part: u32,
    /// The surface has no other part.
    whole: bool,
}

/// All surfaces of one type.
pub(crate) struct Arena<S> {
    surfaces: Vec<S>,
    ids: Ids,
    /// `None` if every surface is one part.
    parts: Option<Vec<(PartRef, Aabb)>>,
    /// The parts without their boxes, once these are in the tree.
    placed: Vec<PartRef>,
}

impl<S> Default for Arena<S> {
    fn default() -> Self {
        Self { surfaces: Vec::new(), ids: Ids::default(), parts: None, placed: Vec::new() }
    }
}

impl<S: Surface + 'static> Arena<S> {
    pub(crate) fn push(&mut self, surface: S, id: Id, mask: u32) {
        self.surfaces.push(surface);
        self.ids.push(id, mask);
    }

    /// Puts other surfaces in the place of those for which there is one, if they have the same parts, and gives back the old ones with their places.
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

    /// Puts surfaces in their places, and what was there in theirs.
    pub(crate) fn swap(&mut self, others: &mut [(usize, S)]) {
        for (i, other) in others {
            core::mem::swap(&mut self.surfaces[*i], other);
        }
    }

    /// Calls `f` with each admitted slot of a leaf: its surface, its part and the ray, which knows its side if it starts there.
    #[inline(always)]
    fn walk(
        &self,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        mut f: impl FnMut(Slot<'_, S>, &LocalRay<'_>) -> Flow,
    ) -> Flow {
        for slot in leaf {
            let item = self.slot(slot);
            if !self.ids.admits(item.index, filter.mask) {
                continue;
            }
            // One call: what is inlined here is large.
            let started;
            let ray = match filter.source {
                Some((source, side)) if source == slot => {
                    started = ray.from_side(Some(side));
                    &started
                }
                _ => ray,
            };
            if f(item, ray) == Flow::Stop {
                return Flow::Stop;
            }
        }
        Flow::Continue
    }

    #[inline(always)]
    fn slot(&self, slot: u32) -> Slot<'_, S> {
        // An arena without parts keeps no list of them: slot and surface are the same number.
        let (index, part, whole) = match self.placed.get(slot as usize) {
            Some(p) => (p.surface as usize, PartId(p.part), p.whole),
            None => (slot as usize, PartId(0), true),
        };
        Slot { arena: self, surface: &self.surfaces[index], index, slot, part, whole }
    }

    fn slot_boxes(&self, limits: &[Aabb]) -> impl IndexedParallelIterator<Item = Aabb> {
        let count = self.parts.as_ref().map_or(self.surfaces.len(), Vec::len);
        (0..count).into_par_iter().map(|i| {
            let (surface, bounds) = match &self.parts {
                Some(parts) => (parts[i].0.surface as usize, parts[i].1),
                None => (i, self.surfaces[i].bounds()),
            };
            match limits.get(self.ids.name(surface).object as usize) {
                Some(limit) => bounds.intersection(*limit),
                None => bounds,
            }
        })
    }
}

/// A slot at hand.
struct Slot<'a, S> {
    arena: &'a Arena<S>,
    surface: &'a S,
    index: usize,
    slot: u32,
    part: PartId,
    whole: bool,
}

impl<S: Surface> Slot<'_, S> {
    /// Shows the roots to any sink. Compiled once per path, where [`AnyArena::improve`] has a copy of its own.
    #[inline(never)]
    fn show(&self, isa: Isa, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        isa.run(
            #[inline(always)]
            || self.surface.part_roots(self.part, ray, sink),
        );
    }

    /// The name: parts of a surface may be primitives of their own.
    #[inline(always)]
    fn name(&self) -> Id {
        let id = self.arena.ids.name(self.index);
        Id { primitive: id.primitive.wrapping_add(self.surface.primitive_of(self.part)), ..id }
    }
}

/// A root with its `t` in the ray's range, where the exact crossing is: rounding may have put it a step outside. `None` where the exact `t`
/// is beyond all numbers: there is nothing to tell about such a crossing.
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

/// A root with the number next to its infinite `t`, unless the crossing itself is as far.
#[cold]
fn brought_back(root: Root, ray: &LocalRay<'_>) -> Option<Root> {
    let t = root.t.clamp(f64::MIN, f64::MAX);
    (root.lo <= t && t <= root.hi && ray.t_min <= t && t <= ray.t_max).then_some(Root { t, ..root })
}

/// All of a line: what a surface computes must not depend on what was met before.
const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// A root of one slot against the best so far.
struct Challenger<'a> {
    slot: u32,
    name: Id,
    ray: &'a LocalRay<'a>,
    best: &'a mut Best,
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
    fn push(&mut self, root: Root) -> Flow {
        // Roots ascend: behind one that lost, the others lose too.
        let Some(root) = in_range(root, self.ray) else { return Flow::Continue };
        if self.best.offer(self.slot, self.name, &root) { Flow::Continue } else { Flow::Stop }
    }
}

/// Hands roots on to a visitor.
struct Forward<'a, 'b> {
    slot: u32,
    name: Id,
    ray: &'a LocalRay<'a>,
    visit: &'a mut Visit<'b>,
    flow: Flow,
}

impl Sink for Forward<'_, '_> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        ALL
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> Flow {
        if self.flow == Flow::Continue
            && let Some(root) = in_range(root, self.ray)
        {
            self.flow = (self.visit)(self.slot, self.name, root);
        }
        self.flow
    }
}

impl<S: Surface + 'static> AnyArena for Arena<S> {
    fn improve(&self, isa: Isa, leaf: Range<u32>, ray: &LocalRay<'_>, filter: &Filter, best: &mut Best) {
        isa.run(
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
                        if best.is_satisfied() { Flow::Stop } else { Flow::Continue }
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
    ) -> Flow {
        self.walk(leaf, ray, filter, |slot, ray| {
            let (name, flow) = (slot.name(), Flow::Continue);
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
        self.walk(leaf, ray, &filter, |slot, ray| {
            if slot.surface.solidity() == Solidity::Solid {
                let before = tracks.len();
                let (name, flow) = (slot.name(), Flow::Continue);
                let visit = &mut |_: u32, _: Id, root: Root| {
                    tracks.push(slot.index as u32, name, &root);
                    Flow::Continue
                };
                slot.show(isa, ray, &mut Forward { slot: slot.slot, name, ray, visit, flow });
                if slot.whole && tracks.len() == before {
                    tracks.start(slot.index as u32, starts_inside(slot.surface, ray, start));
                }
            }
            Flow::Continue
        });
    }

    fn start_of(&self, surface: u32, ray: &LocalRay<'_>, start: &LocalPoint<'_>, tracks: &mut Tracks) {
        if self.ids.admits(surface as usize, tracks.filter().mask) {
            tracks.start(surface, starts_inside(&self.surfaces[surface as usize], ray, start));
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
        if surface.solidity() == Solidity::Solid { surface.side(point) } else { Side::Out }
    }

    fn resolve(&self, isa: Isa, slot: u32, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let surface = self.slot(slot).surface;
        isa.run(
            #[inline(always)]
            || surface.resolve(ray, root, need),
        )
    }

    fn drawn(&self, slot: u32) -> Drawn {
        let Slot { surface, part, whole, .. } = self.slot(slot);
        let sketch = surface.sketch(part);
        // The surface's own box is the tighter one, unless this is a small part of it.
        let bounds = if whole { surface.bounds() } else { sketch.bounds() };
        Drawn { seen: Seen::of(&sketch), bounds }
    }

    fn solid(&self, surface: u32) -> (Seen, Vec<u32>) {
        let (sketch, parts) = self.surfaces[surface as usize].solid_sketch();
        let slot_of = |part: PartId| {
            let slot = self.placed.iter().position(|p| p.surface == surface && p.part == part.0);
            slot.map_or(surface, |slot| slot as u32)
        };
        (Seen::of(&sketch), parts.into_iter().map(slot_of).collect())
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
        // A part that is gone is nowhere.
        self.placed.iter().map(|p| parts.get(&(p.surface, p.part)).copied().unwrap_or(Aabb::EMPTY)).collect()
    }

    fn is_of_triangles(&self) -> bool {
        // All surfaces of a type, or none.
        self.surfaces.first().is_some_and(|surface| surface.corners(PartId(0)).is_some())
    }

    fn slot_corners(&self, slot: u32) -> [Point3; 3] {
        let Slot { surface, part, .. } = self.slot(slot);
        surface.corners(part).unwrap_or([Point3::ORIGIN; 3])
    }

    fn as_any(&mut self) -> &mut dyn core::any::Any {
        self
    }

    fn type_name(&self) -> &'static str {
        core::any::type_name::<S>()
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

/// Whether a ray comes to its start (at `t_min`) inside a solid whose crossings within its range leave that open; `start` is some point of its line.
///
/// A crossing at the very start is one of the range, and says what was before. Else it is decided by the signs of the crossings before and behind the range, and where the line crosses the solid nowhere, and the solid has no bounds, by the exact
/// side of a point of it. A point may be known to be inside that is on no chord known: where a tangent touches a formula's solid within rounding.
fn starts_inside<S: Surface>(surface: &S, ray: &LocalRay<'_>, start: &LocalPoint<'_>) -> bool {
    if let Some(side) = ray.source {
        return side == RaySide::Back;
    }
    let signs = |t_min: f64, t_max: f64| {
        let mut part_of_line = *ray;
        (part_of_line.t_min, part_of_line.t_max) = (t_min, t_max);
        let mut ends = Ends::default();
        surface.roots::<dyn Sink>(&part_of_line, &mut ends);
        ends.closed()
    };
    if let Some(sign) = signs(ray.t_min, ray.t_min).first {
        return sign > 0;
    }
    if let Some(sign) = signs(f64::NEG_INFINITY, ray.t_min).last {
        return sign < 0;
    }
    // One at the very end is one of the range, too: behind it is what was before, as the crossings of the range cancel.
    if let Some(sign) = signs(ray.t_max, ray.t_max).last {
        return sign < 0;
    }
    if let Some(sign) = signs(ray.t_max, f64::INFINITY).first {
        return sign > 0;
    }
    if surface.bounds().is_bounded() {
        // The line comes from outside and goes there, and does not cross it on the way.
        return false;
    }
    match surface.side(start) {
        Side::In => true,
        Side::Out => false,
        Side::On => runs_inside(surface, ray),
    }
}

/// Whether a line lies in a closed solid that it does not cross, though it may touch it in single points.
///
/// All its points but those lie on one side. Solids with quadric faces, of which there are six at most, are touched in no more than
/// twelve points; a line in a face of a solid of many faces has left it where it has left the box. A line of which no point
/// is off the boundary lies in it, and so in the closed solid.
fn runs_inside<S: Surface>(surface: &S, ray: &LocalRay<'_>) -> bool {
    let bounds = surface.bounds();
    let far = bounds.max.to_vec().max_abs().max(bounds.min.to_vec().max_abs()).max(ray.o.to_vec().max_abs());
    let beyond = if far.is_finite() { scale2(1.0, (exponent(far) + 2).min(1000)) } else { 1.0 };
    let near = (1..=7).map(f64::from);
    let mut sides =
        near.chain([beyond]).flat_map(|s| [s, -s]).map(|s| surface.side(&LocalPoint::along(ray, s)));
    sides.find(|&side| side != Side::On) != Some(Side::Out)
}

/// The signs of the first and the last crossing that changes sides. Crossings whose enclosures overlap count as one, by their sum: where the line touches an edge, it
/// goes in and out at one point, or out and in, and their order says nothing.
#[derive(Default)]
struct Ends {
    first: Option<i32>,
    last: Option<i32>,
    /// The crossings that overlap the last one: their sum, and how far they reach.
    group: Option<(i32, f64)>,
}

impl Ends {
    /// Ends the group.
    fn closed(mut self) -> Self {
        if let Some((sum, _)) = self.group.take()
            && sum != 0
        {
            self.first = self.first.or(Some(sum));
            self.last = Some(sum);
        }
        self
    }
}

impl Sink for Ends {
    fn range(&self) -> (f64, f64) {
        ALL
    }

    fn push(&mut self, root: Root) -> Flow {
        let sign = i32::from(root.sign);
        if sign != 0 {
            *self = match self.group {
                Some((sum, reach)) if root.lo <= reach => {
                    Self { group: Some((sum + sign, reach.max(root.hi))), ..core::mem::take(self) }
                }
                _ => Self { group: Some((sign, root.hi)), ..core::mem::take(self).closed() },
            };
        }
        Flow::Continue
    }
}

impl<S: Surface + 'static> Arrange for Arena<S> {
    fn seal(&mut self) {
        self.surfaces.shrink_to_fit();
        self.ids.shrink();
        if !self.surfaces.iter().any(Surface::is_in_parts) {
            return;
        }
        let mut parts = Vec::new();
        for (i, s) in self.surfaces.iter().enumerate() {
            let (surface, whole, first) = (i as u32, false, parts.len());
            s.parts(&mut |bounds, part| parts.push((PartRef { surface, part: part.0, whole }, bounds)));
            if let [(part, _)] = &mut parts[first..] {
                part.whole = true;
            }
        }
        self.parts = Some(parts);
    }

    fn extent(&self, limits: &[Aabb]) -> Aabb {
        let bounded = |b: Aabb| if b.is_bounded() { b } else { Aabb::EMPTY };
        self.slot_boxes(limits).map(bounded).reduce(|| Aabb::EMPTY, Aabb::union)
    }

    fn entries(&self, frame: &Frame, kind: u32, limits: &[Aabb], entries: &mut Vec<Entry>) -> Unsorted {
        let first = entries.len();
        entries.par_extend(self.slot_boxes(limits).enumerate().map(|(i, b)| frame.entry(&b, kind, i as u32)));
        let mut unsorted = Unsorted::default();
        entries[first..].iter().for_each(|e| unsorted.take(e));
        if !unsorted.is_empty() {
            let mut at = 0;
            entries.retain(|e| {
                at += 1;
                at <= first || e.is_bounded()
            });
        }
        unsorted
    }

    fn corners(&self, index: u32) -> [Point3; 3] {
        let corners = match &self.parts {
            Some(parts) => {
                let part = &parts[index as usize].0;
                self.surfaces[part.surface as usize].corners(PartId(part.part))
            }
            None => self.surfaces[index as usize].corners(PartId(0)),
        };
        corners.unwrap_or([Point3::ORIGIN; 3])
    }

    fn arrange(&mut self, mut order: Vec<u32>) {
        if let Some(parts) = self.parts.take() {
            self.placed = order.iter().map(|&i| parts[i as usize].0).collect();
            return;
        }
        // The permutation's cycles, in place: surfaces need not be `Clone`, and no second arena is held.
        for start in 0..order.len() {
            let mut to = start;
            loop {
                let from = order[to] as usize;
                order[to] = to as u32;
                if from == start {
                    break;
                }
                self.surfaces.swap(to, from);
                self.ids.swap(to, from);
                to = from;
            }
        }
    }

    fn finish(self: Box<Self>) -> Box<dyn AnyArena> {
        self
    }
}
