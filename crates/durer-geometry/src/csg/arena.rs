//! The CSG solids of a geometry: one slot in the tree each.
//!
//! Rays hit the surfaces of leaves. So hits and sources refer to those, by slots numbered over all
//! leaves of all solids, with two flags above the number.

use super::compound::Compound;
use super::packet::PacketCsg;
use super::trace::{Found, Start};
use crate::arena::{AnyArena, Arrange, Filter, Unsorted, Visit};
use crate::closest::ClosestHit;
use crate::filter_cache::{FilterKind, SlotFilter};
use crate::ids::{Id, Ids};
use crate::spans::Tracks;
use core::ops::ControlFlow;
use core::ops::Range;
use durer_bvh::{Entry, Frame};
use durer_math::{Aabb, Isa, Point3, RaySide, Shaft};
use durer_surfaces::packet::FilterSource;
use durer_surfaces::{LocalPoint, LocalRay, Need, PartId, Root, Side, Solidity, SurfacePoint};
use rayon::prelude::*;
use std::sync::Arc;

/// Flag in the slot of a hit: its normal is that of the leaf, reversed.
pub(super) const TURNED: u32 = 1 << 31;
/// Flag in the slot of a hit: it was decided in a tie with crossings of other leaves.
pub(super) const TIED: u32 = 1 << 30;
/// The slot itself.
pub(super) const SLOT: u32 = TIED - 1;

/// Whether two slots of hits denote one surface with the same orientation. Slots of other arenas
/// have no flags.
#[inline(always)]
pub(crate) fn same_surface(a: u32, b: u32) -> bool {
    (a ^ b) & !TIED == 0
}

/// All CSG solids of a geometry.
#[derive(Default)]
pub(crate) struct Compounds {
    bodies: Vec<Arc<Compound>>,
    ids: Ids,
    /// The first slot of each solid's leaves, and the end.
    first: Vec<u32>,
}

impl Compounds {
    pub(crate) fn push(&mut self, body: Arc<Compound>, id: Id, mask: u32) {
        self.bodies.push(body);
        self.ids.push(id, mask);
    }

    /// The total number of the leaves' slots.
    pub(crate) fn leaf_slots(&self) -> u64 {
        self.bodies.iter().map(|b| u64::from(b.slots())).sum()
    }

    /// The greatest total number of slots.
    pub(crate) const MOST_SLOTS: u64 = SLOT as u64;

    /// The solid of a hit's slot, and the slot within it.
    fn body(&self, slot: u32) -> (usize, u32) {
        let slot = slot & SLOT;
        // Solids without leaves have no slot.
        let body = self.first.partition_point(|&first| first <= slot) - 1;
        (body, slot - self.first[body])
    }

    /// The start of the ray on a solid, if it starts there.
    fn from(&self, body: usize, filter: &Filter) -> Option<Start> {
        let (named, side) = filter.source?;
        let (of, slot) = self.body(named);
        let inside = side == RaySide::Back;
        let behind = inside != (named & TURNED != 0);
        let side = if behind { RaySide::Back } else { RaySide::Front };
        (of == body).then_some(Start { slot, side, inside, tied: named & TIED != 0 })
    }

    fn slot(&self, body: usize, found: &Found) -> u32 {
        let flags = if found.turned { TURNED } else { 0 } | if found.tied { TIED } else { 0 };
        (self.first[body] + found.slot) | flags
    }

    fn id(&self, body: usize, found: &Found) -> Id {
        let id = self.ids.name(body);
        Id { primitive: id.primitive.wrapping_add(found.primitive), ..id }
    }

    /// Passes the crossings of the admitted solids of a leaf to `show`, those of each solid
    /// ascending. When `show` returns [`ControlFlow::Break`] the next solid follows; when `is_done` returns
    /// true the search ends.
    fn each_body(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        mut show: impl FnMut(u32, Id, Root) -> ControlFlow<()>,
        mut is_done: impl FnMut() -> bool,
    ) {
        for body in leaf.map(|i| i as usize) {
            if is_done() {
                return;
            }
            if self.ids.admits(body, filter.mask) {
                self.bodies[body].trace(isa, ray, self.from(body, filter), &mut |found| {
                    show(self.slot(body, &found), self.id(body, &found), found.root)
                });
            }
        }
    }
}

impl AnyArena for Compounds {
    fn improve(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        best: &mut ClosestHit,
    ) {
        for body in leaf.map(|i| i as usize) {
            if best.is_satisfied() {
                return;
            }
            if self.ids.admits(body, filter.mask) {
                let until = if best.hit.is_some() { best.limit() } else { f64::INFINITY };
                self.bodies[body].first(isa, ray, self.from(body, filter), until, &mut |found| {
                    best.offer(self.slot(body, &found), self.id(body, &found), &found.root);
                });
            }
        }
    }

    fn each(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        filter: &Filter,
        visit: &mut Visit<'_>,
    ) -> ControlFlow<()> {
        let flow = core::cell::Cell::new(ControlFlow::Continue(()));
        let show = |slot, id, root| {
            flow.set(visit(slot, id, root));
            flow.get()
        };
        self.each_body(isa, leaf, ray, filter, show, || flow.get().is_break());
        flow.get()
    }

    fn spans(
        &self,
        isa: Isa,
        leaf: Range<u32>,
        ray: &LocalRay<'_>,
        _start: &LocalPoint<'_>,
        tracks: &mut Tracks,
    ) {
        let filter = tracks.filter();
        let solid =
            |&b: &usize| self.bodies[b].solidity() == Solidity::Solid && self.ids.admits(b, filter.mask);
        for body in leaf.map(|i| i as usize).filter(solid) {
            let before = tracks.len();
            let inside = self.bodies[body].trace(isa, ray, self.from(body, &filter), &mut |found| {
                tracks.push(body as u32, PartId(0), self.id(body, &found), &found.root);
                ControlFlow::Continue(())
            });
            if tracks.len() == before {
                tracks.start(body as u32, self.ids.name(body), inside);
            }
        }
    }

    fn start_of(&self, _: u32, _: &LocalRay<'_>, _: &LocalPoint<'_>, _: &mut Tracks) {
        // No CSG solid is in parts.
    }

    fn starts_inside(&self, slot: u32, ray: &LocalRay<'_>) -> bool {
        self.bodies[slot as usize].trace(Isa::detect(), ray, None, &mut |_| ControlFlow::Break(()))
    }

    fn misses(&self, slot: u32, shaft: &Shaft) -> bool {
        !shaft.may_meet(&self.bodies[slot as usize].bounds())
    }

    fn is_left(&self, _: u32, _: RaySide, _: &Shaft) -> bool {
        false
    }

    fn side(&self, surface: u32, point: &LocalPoint<'_>) -> Side {
        self.bodies[surface as usize].side(point)
    }

    fn resolve(&self, isa: Isa, slot: u32, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let (body, inner) = self.body(slot);
        let how = (slot & TURNED != 0, slot & TIED != 0);
        isa.run(
            #[inline(always)]
            || self.bodies[body].resolve(isa, inner, how, ray, root, need),
        )
    }

    fn drawn(&self, slot: u32) -> SlotFilter {
        let body = &self.bodies[slot as usize];
        let bounds = body.bounds();
        let first = self.first[slot as usize];
        let seen = match PacketCsg::new(body, first..first + body.slots()) {
            Some(body) => FilterKind::Body(Box::new(body)),
            None => FilterKind::of(&FilterSource::vague(bounds)),
        };
        SlotFilter { seen, bounds }
    }

    fn solid(&self, surface: u32) -> (FilterKind, Vec<u32>) {
        (self.drawn(surface).seen, vec![surface])
    }

    fn mask(&self, slot: u32) -> u32 {
        self.ids.mask(slot as usize)
    }

    fn part(&self, _: u32) -> PartId {
        PartId(0)
    }

    fn name(&self, slot: u32) -> Id {
        self.ids.name(slot as usize)
    }

    fn object_of(&self, surface: u32) -> u32 {
        self.ids.name(surface as usize).object
    }

    fn whole(&self, slot: u32) -> Option<u32> {
        Some(slot)
    }

    fn solids_in_parts(&self) -> Vec<(u32, Aabb)> {
        Vec::new()
    }

    fn slot_bounds(&self) -> Vec<Aabb> {
        self.bodies.iter().map(|body| body.bounds()).collect()
    }

    fn is_of_triangles(&self) -> bool {
        false
    }

    fn slot_corners(&self, _: u32) -> [Point3; 3] {
        [Point3::ORIGIN; 3]
    }

    fn as_any(&mut self) -> &mut dyn core::any::Any {
        self
    }

    fn reopen(self: Box<Self>) -> Box<dyn Arrange> {
        self
    }

    fn surface_name(&self, _slot: u32) -> &'static str {
        "CSG solid"
    }

    fn len(&self) -> u32 {
        self.bodies.len() as u32
    }

    fn bytes(&self) -> usize {
        self.bodies.iter().map(|b| size_of::<Compound>() + b.bytes()).sum::<usize>() + self.ids.bytes()
    }
}

impl Arrange for Compounds {
    fn seal(&mut self) {
        self.ids.shrink();
    }

    fn extent(&self, _: &[Aabb]) -> Aabb {
        let bounds = self.bodies.iter().map(|b| b.bounds());
        bounds.filter(Aabb::is_bounded).fold(Aabb::EMPTY, Aabb::union)
    }

    fn entries(&self, frame: &Frame, kind: u32, _: &[Aabb], entries: &mut Vec<Entry>) -> Unsorted {
        Unsorted::beside(entries, frame, kind, self.bodies.par_iter().map(|body| body.bounds()))
    }

    fn corners(&self, _index: u32) -> [Point3; 3] {
        [Point3::ORIGIN; 3]
    }

    fn arrange(&mut self, order: Vec<u32>) {
        let mut bodies: Vec<_> = core::mem::take(&mut self.bodies).into_iter().map(Some).collect();
        let old = core::mem::take(&mut self.ids);
        self.first = vec![0];
        for i in order {
            // Each index occurs in the order once.
            if let Some(body) = bodies[i as usize].take() {
                self.first.push(self.first[self.first.len() - 1] + body.slots());
                self.ids.push(old.name(i as usize), old.mask(i as usize));
                self.bodies.push(body);
            }
        }
    }

    fn finish(self: Box<Self>) -> Box<dyn AnyArena> {
        self
    }
}
