//! The packet filter of CSG solids.
//!
//! A crossing of a leaf is a crossing of the solid if none of the other leaves decides against it:
//! on the path from the leaf to the root, every intersection needs all its other children to hold,
//! and every union, unless it keeps its inner faces, needs none of them to hold. So no crossings are put in order. Each crossing is
//! handled by itself, and the point is classified against other leaves only as far as necessary.
//!
//! The answers of leaves and nodes are *certainly in*, *certainly out*, or neither. Where faces
//! coincide, or nearly so, the answer is neither, and rays for which that matters sweep along their
//! crossings in order (`sweep.rs`).
//!
//! Certain answers are bit masks, one bit a ray: the evaluation of a tree of a few leaves takes
//! single instructions.

use super::arena::{SLOT, TIED, TURNED};
use super::compound::{Compound, Shown};
use super::tree::{Child, Rule};
use crate::ids::Id;
use crate::packet::Rays8;
use durer_math::lanes::{LANES, set_bits};
use durer_math::{F8, Isa, M8};
use durer_surfaces::packet::{
    self, Crossing8, Crossings, From8, Nearest, PacketFilter, RayLanes, SolidState8,
};

/// A CSG solid with the packet filters of its leaves.
#[derive(Debug)]
pub(crate) struct PacketCsg {
    leaves: Vec<Operand>,
    places: Vec<LeafPosition>,
    /// For each leaf a convex leaf outside of which it does not matter, if there is one.
    around: Vec<Option<u32>>,
    nodes: Vec<Node>,
    children: Vec<Child>,
    has_inner_faces: bool,
    /// The slots of the solid's leaves, counted over all solids.
    slots: core::ops::Range<u32>,
    /// The leaf of each slot, and its index among the slots of that leaf.
    owners: Box<[(u32, u32)]>,
}

/// A leaf.
#[derive(Debug)]
pub(super) struct Operand {
    pub(super) outline: PacketFilter,
    /// The slots of its faces, counted over all leaves of the solid; a single one if all faces
    /// share it.
    pub(super) slots: Box<[u32]>,
    pub(super) primitive: u32,
    pub(super) shown: Shown,
}

/// The position of a leaf in the tree.
#[derive(Clone, Copy, Debug)]
struct LeafPosition {
    node: u32,
    inverted: bool,
}

/// A union or an intersection.
#[derive(Debug)]
struct Node {
    parent: Option<u32>,
    rule: Rule,
    children: core::ops::Range<usize>,
}

/// Reusable memory for the states of eight rays relative to the leaves of one solid.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    sights: Vec<SolidState8>,
    /// For each leaf the mask of rays that certainly miss it.
    passed: Vec<u8>,
    crossings: Crossings,
}

/// The number of a solid's face is the leaf's number times this, plus the face of the leaf.
const FACES: f64 = PacketFilter::FACES as f64;

/// A face of a leaf, with the numbers for hits.
pub(crate) struct LeafFace<'b> {
    pub(crate) outline: &'b PacketFilter,
    pub(crate) face: u32,
    /// Whether the solid's normal is the leaf's, reversed.
    pub(crate) turned: bool,
    pub(crate) slot: u32,
    /// The primitive, counted from the solid's first.
    pub(crate) primitive: u32,
}

/// Eight rays, with their states relative to all leaves.
struct PacketState<'a> {
    isa: Isa,
    rays: &'a RayLanes<'a>,
    sights: &'a mut [SolidState8],
    passed: &'a mut [u8],
    steps: &'a mut packet::Scratch,
}

/// The rays that start on the solid: their mask, and for each the leaf, the face there, and whether
/// it starts behind it.
struct SpawnFaces {
    lanes: u8,
    leaf: [u32; LANES],
    face: F8,
    back: M8,
}

/// The masks of rays for which something certainly holds, and certainly does not.
#[derive(Clone, Copy)]
struct Sure {
    yes: u8,
    no: u8,
}

impl PacketState<'_> {
    /// Whether no ray meets a leaf.
    fn is_passed(&self, leaf: usize) -> bool {
        self.passed[leaf] == u8::MAX
    }
}

impl Sure {
    fn inverted(self, inverted: bool) -> Self {
        if inverted { Self { yes: self.no, no: self.yes } } else { self }
    }
}

impl PacketCsg {
    /// A solid with more leaves than this has no packet filter.
    const MOST: usize = 32;

    /// The filter of a solid whose leaves have these slots; `None` if there is none.
    pub(super) fn new(body: &Compound, slots: core::ops::Range<u32>) -> Option<Self> {
        if body.len() > Self::MOST {
            return None;
        }
        let leaves = body.operands()?;
        let places = body.tree().places().map(|p| p.map(|(node, inverted)| LeafPosition { node, inverted }));
        let places = places.collect::<Option<Vec<_>>>()?;
        if leaves.is_empty() || !leaves.iter().all(|leaf| leaf.outline.is_operand()) {
            return None;
        }
        let mut children = Vec::new();
        let nodes = body.tree().lists().map(|(parent, rule, list)| {
            let first = children.len();
            children.extend(list);
            Node { parent, rule, children: first..children.len() }
        });
        let nodes = nodes.collect();
        let mut owners = vec![(u32::MAX, 0); slots.len()];
        for (leaf, operand) in (0..).zip(&leaves) {
            for (place, &slot) in (0..).zip(&operand.slots) {
                if let Some(owner) = owners.get_mut(slot as usize) {
                    *owner = (leaf, place);
                }
            }
        }
        let mut body = Self {
            leaves,
            places,
            around: Vec::new(),
            nodes,
            children,
            has_inner_faces: body.tree().has_inner_faces(),
            slots,
            owners: owners.into(),
        };
        body.around = (0..body.leaves.len()).map(|i| body.around(i)).collect();
        Some(body)
    }

    /// A convex leaf that contains the relevant part of this one: a sibling of it, or of a node
    /// above it, in an intersection.
    fn around(&self, leaf: usize) -> Option<u32> {
        let is_cell = |i: u32| {
            let Operand { outline, .. } = &self.leaves[i as usize];
            i as usize != leaf
                && outline.is_convex()
                && outline.is_turned() == self.places[i as usize].inverted
        };
        let mut above = Some(self.places[leaf].node);
        while let Some(node) = above {
            let Node { parent, rule, children } = &self.nodes[node as usize];
            let mut leaves = self.children[children.clone()].iter().filter_map(|child| match child {
                Child::Leaf(leaf) => Some(*leaf),
                Child::Node(_) => None,
            });
            if *rule == Rule::All
                && let Some(cell) = leaves.find(|&i| is_cell(i))
            {
                return Some(cell);
            }
            above = *parent;
        }
        None
    }

    /// The face with this number.
    pub(crate) fn skin(&self, number: f64) -> LeafFace<'_> {
        let leaf = ((number / FACES) as usize).min(self.leaves.len() - 1);
        let (Operand { outline, slots, primitive, .. }, turned) =
            (&self.leaves[leaf], self.places[leaf].inverted);
        let face = (number - leaf as f64 * FACES) as u32;
        let slot = slots[(face as usize).min(slots.len() - 1)];
        LeafFace {
            outline,
            face,
            turned,
            slot: (self.slots.start + slot) | if turned { TURNED } else { 0 },
            primitive: *primitive,
        }
    }

    /// The numbers for a leaf's hits.
    pub(crate) fn name(body: Id, skin: &LeafFace<'_>) -> Id {
        Id { primitive: body.primitive.wrapping_add(skin.primitive), ..body }
    }

    /// Passes the first crossing of each ray to `nearest`, with the solid's number.
    pub(crate) fn meet(
        &self,
        isa: Isa,
        (arena, number): (u32, f64),
        (rays, lanes): (&Rays8, &RayLanes<'_>),
        nearest: &mut Nearest,
        (steps, memory): (&mut packet::Scratch, &mut Memory),
    ) {
        let Memory { sights, passed, crossings } = memory;
        sights.resize_with(self.leaves.len().max(sights.len()), SolidState8::default);
        passed.clear();
        for (leaf, sight) in self.leaves.iter().zip(&mut *sights) {
            passed.push(if leaf.outline.sight(lanes, sight) { u8::MAX } else { 0 });
        }
        let look = &mut PacketState { isa, rays: lanes, sights, passed, steps };
        let live = rays.live.bits();
        if self.has_no_face(look, live) {
            return;
        }
        let own = self.own_rays(arena, rays, live, nearest);
        for (i, leaf) in self.leaves.iter().enumerate() {
            if !look.is_passed(i) && leaf.outline.is_convex() {
                let from = own.as_ref().and_then(|own| own.of(i));
                let missed = leaf.outline.stay(lanes, from.as_ref(), &mut look.sights[i], look.steps);
                look.passed[i] = missed | !live;
            }
        }
        if self.has_no_face(look, live) {
            return;
        }
        for (i, leaf) in self.leaves.iter().enumerate() {
            let around = self.around[i].map(|cell| cell as usize);
            if look.is_passed(i)
                || leaf.shown == Shown::None
                || around.is_some_and(|cell| look.is_passed(cell))
            {
                continue;
            }
            let from = own.as_ref().and_then(|own| own.of(i));
            let within = around.filter(|_| leaf.outline.is_endless()).map(|cell| &look.sights[cell]);
            let sight = (&look.sights[i], within);
            leaf.outline.crossings(lanes, from.as_ref(), sight, look.steps, crossings);
            isa.run_in_lanes(
                #[inline(always)]
                || nearest.doubt_from(rays.live, crossings.doubt),
            );
            for crossing in crossings.iter() {
                self.decide(i, crossing, (rays, look), number, nearest);
            }
        }
    }

    /// Whether none of the rays `live` meets a visible face: no ray enters the solid, or the solid
    /// holds all rays and keeps no inner faces.
    fn has_no_face(&self, look: &mut PacketState<'_>, live: u8) -> bool {
        let Sure { yes, no } = self.node(0, look, None);
        let yes = if self.has_inner_faces { 0 } else { yes };
        yes | no | !live == u8::MAX
    }

    /// The rays that start on this solid.
    fn own_rays(&self, arena: u32, rays: &Rays8, live: u8, nearest: &mut Nearest) -> Option<SpawnFaces> {
        let source = &rays.source;
        let slot = |i: usize| source.slot[i] as u32 & SLOT;
        let is_own = |i: usize| {
            source.slot[i] >> 32 == u64::from(arena)
                && source.instance[i] == 0
                && self.slots.contains(&slot(i))
        };
        let lanes = M8::from_fn(is_own).bits() & live;
        if lanes == 0 {
            return None;
        }
        let (mut leaf, mut face, mut back) = ([u32::MAX; LANES], F8::ZERO, source.back);
        let mut tied = 0;
        for i in set_bits(lanes) {
            let place;
            (leaf[i], place) = self.owners[(slot(i) - self.slots.start) as usize];
            let faces = self.leaves.get(leaf[i] as usize).map_or(0, |leaf| leaf.slots.len());
            face.0[i] = f64::from(if faces > 1 { place } else { source.face[i] });
            let named = source.slot[i] as u32;
            // The side is that of the solid's normal.
            back.set_lane(i, source.back.lane(i) != (named & TURNED != 0));
            tied |= u8::from(named & TIED != 0) << i;
        }
        if tied != 0 {
            // A start in a tie of several leaves cannot be decided by one of them.
            nearest.doubt_from(M8::from_bits(tied), F8::ZERO);
        }
        Some(SpawnFaces { lanes, leaf, face, back })
    }

    /// Passes a crossing of a leaf to `nearest` where it is a crossing of the solid.
    fn decide(
        &self,
        leaf: usize,
        crossing: &Crossing8,
        (rays, look): (&Rays8, &mut PacketState<'_>),
        number: f64,
        nearest: &mut Nearest,
    ) {
        let (Operand { shown, outline, .. }, LeafPosition { node, .. }) =
            (&self.leaves[leaf], self.places[leaf]);
        let Crossing8 { sure, t, e, face, tag } = crossing;
        let mut open = look.isa.run_in_lanes(
            #[inline(always)]
            || {
                let limit = nearest.limit(look.rays);
                (rays.live & *sure & !((*t + *e).lt(F8::ZERO) | (*t - *e).gt(limit))).bits()
            },
        );
        if *shown == Shown::Wall {
            for i in set_bits(open) {
                open &= !(u8::from(outline.face_of(face.0[i] as u32) != 0) << i);
            }
        }
        let mut matters = u8::MAX;
        let (mut child, mut above) = (Child::Leaf(leaf as u32), Some(node));
        while let Some(node) = above {
            let Node { parent, rule, children } = &self.nodes[node as usize];
            let decides = *rule != Rule::AnyWithInner;
            let siblings = self.children[children.clone()].iter().filter(|&&c| decides && c != child);
            for &sibling in siblings {
                if open == 0 {
                    return;
                }
                let Sure { yes, no } = self.child(sibling, look, Some((t, e, open)));
                let (must, must_not) = if *rule == Rule::All { (yes, no) } else { (no, yes) };
                matters &= must;
                open &= !must_not;
            }
            (child, above) = (Child::Node(node), *parent);
        }
        if open == 0 {
            return;
        }
        look.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (open, matters) = (M8::from_bits(open), M8::from_bits(matters));
                let sure = open & matters & (*t - *e).gt(F8::ZERO) & (*t + *e).le(rays.t_max);
                nearest.take_at(sure, (*t, *e), number, *face + leaf as f64 * FACES, *tag);
                nearest.doubt_from(open & !sure, *t - *e);
            },
        );
    }

    /// Whether a child of a node holds at the points `at` of some rays, or on whole rays.
    fn child(&self, child: Child, look: &mut PacketState<'_>, at: Option<(&F8, &F8, u8)>) -> Sure {
        match child {
            Child::Node(node) => self.node(node, look, at),
            Child::Leaf(leaf) => {
                let i = leaf as usize;
                let outline = &self.leaves[i].outline;
                let sure = match at {
                    Some(at) if !look.is_passed(i) => {
                        let (yes, no) = outline.holds(look.rays, &look.sights[i], at, look.steps);
                        Sure { yes, no }
                    }
                    _ => Sure { yes: 0, no: look.passed[i] }.inverted(outline.is_turned()),
                };
                sure.inverted(self.places[i].inverted)
            }
        }
    }

    /// Whether a node holds at the points `at` of some rays, or on whole rays.
    fn node(&self, node: u32, look: &mut PacketState<'_>, at: Option<(&F8, &F8, u8)>) -> Sure {
        let Node { rule, children, .. } = &self.nodes[node as usize];
        let is_union = *rule != Rule::All;
        // A union is the complement of the complements' intersection.
        let mut sum = Sure { yes: u8::MAX, no: 0 };
        let asked = at.map_or(u8::MAX, |(_, _, lanes)| lanes);
        for &child in &self.children[children.clone()] {
            let Sure { yes, no } = self.child(child, look, at).inverted(is_union);
            sum.yes &= yes;
            sum.no |= no;
            if sum.no & asked == asked {
                break;
            }
        }
        sum.inverted(is_union)
    }
}

impl SpawnFaces {
    /// The rays that start on a leaf.
    fn of(&self, leaf: usize) -> Option<From8> {
        let lanes = M8::from_fn(
            #[inline(always)]
            |i| self.leaf[i] as usize == leaf,
        );
        let lanes = lanes.bits() & self.lanes;
        (lanes != 0).then(|| From8 { lanes: M8::from_bits(lanes), face: self.face, back: self.back })
    }
}
