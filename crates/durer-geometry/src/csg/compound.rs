//! A body with its leaves.

use super::lanes::Operand;
use super::sweep::{Crossing, Event, Scratch, Sense, partners};
use super::tree::{Expr, Tree, Values};
use crate::arena::{AnyArena, Filter};
use crate::geometry::slots;
use crate::ids::EVERYTHING;
use crate::outlines::Seen;
use crate::{BuildError, Builder, Geometry, ObjectId};
use core::cell::RefCell;
use durer_bvh::{Leaf, Line};
use durer_math::{Aabb, Isa, RaySide};
use durer_surfaces::outline::Sketch;
use durer_surfaces::{Flow, LocalPoint, LocalRay, Need, Root, Side, Solidity, Surface, SurfacePoint};

/// Unions, intersections and differences of solids as one solid: for [`Builder::add_compound`].
///
/// ```
/// use durer_geometry::{Compound, Geometry};
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{AxisBox, Sphere};
///
/// let mut csg = Compound::builder();
/// let cube = csg.leaf(AxisBox::new(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0))?)?;
/// let ball = csg.leaf(Sphere::new(Point3::ORIGIN, 1.25)?)?;
/// let body = csg.difference(cube, [ball]); // eight corners of the cube
/// let scene = Geometry::builder().add_compound(csg.build(body)?).build()?;
///
/// assert!(scene.closest(&Ray::new(Point3::new(0.0, 0.0, -5.0), Vec3::Z)).is_none());
/// let corner = scene.closest(&Ray::new(Point3::new(0.9, 0.9, -5.0), Vec3::Z)).unwrap();
/// assert_eq!((corner.t, corner.primitive), (4.0, 0)); // the cube is the first leaf
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Compound {
    /// The leaves; their objects are their numbers, their primitives are as they were given.
    leaves: Geometry,
    tree: Tree,
    /// What is known of each leaf.
    traits: Vec<Traits>,
    /// The first slot of each arena of the leaves, counted over all; one more at the end.
    first_slot: Vec<u32>,
    bounds: Aabb,
    /// It has a surface and no inside.
    is_sheet: bool,
}

/// What is known of a leaf.
#[derive(Clone, Copy, Debug)]
struct Traits {
    sense: Sense,
    shown: Shown,
}

/// Which faces of a leaf can be seen. What cannot be seen bounds the body all the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// All of them.
    #[default]
    All,
    /// The first one only: the wall of a cylinder without caps.
    Wall,
    /// None: the leaf cuts, and what it opens stays open.
    None,
}

impl Shown {
    fn holds(self, face: u32) -> bool {
        match self {
            Self::All => true,
            Self::Wall => face == 0,
            Self::None => false,
        }
    }
}

/// A solid under construction; it becomes a part of one other, or the whole.
#[derive(Debug)]
pub struct Part(u32);

/// Why a solid cannot be combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CsgError {
    /// The surface has no inside.
    #[error("csg: a {0} has no inside, so it cannot be combined with other solids")]
    Sheet(&'static str),
    /// The leaves do not fit.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Gathers the leaves of a [`Compound`] and says how they are combined.
#[derive(Default)]
pub struct CompoundBuilder {
    leaves: Builder,
    exprs: Vec<Expr>,
    traits: Vec<Traits>,
    bounds: Vec<Aabb>,
    primitives: u32,
}

impl CompoundBuilder {
    /// Adds a solid, as the next primitive.
    pub fn leaf<S: Surface + 'static>(&mut self, solid: S) -> Result<Part, CsgError> {
        self.leaf_as(solid, self.primitives, Shown::All)
    }

    /// Adds a solid under the given number; where a surface has parts (the faces of a mesh), part `i` is the primitive `primitive + i`.
    pub fn leaf_as<S: Surface + 'static>(
        &mut self,
        solid: S,
        primitive: u32,
        shown: Shown,
    ) -> Result<Part, CsgError> {
        if solid.solidity() != Solidity::Solid {
            return Err(CsgError::Sheet(core::any::type_name::<S>()));
        }
        let mut parts = 0;
        solid.parts(&mut |_, _| parts += 1);
        let sense = if parts > 1 { Sense::Parity } else { Sense::Sign };
        let leaf = self.traits.len() as u32;
        self.traits.push(Traits { sense, shown });
        self.bounds.push(solid.bounds());
        self.primitives = self.primitives.max(primitive.saturating_add(parts.max(1)));
        self.leaves.add_as(solid, ObjectId(leaf), primitive, EVERYTHING);
        Ok(self.part(Expr::Leaf(leaf)))
    }

    /// All that lies in each of the parts.
    pub fn intersection(&mut self, parts: impl IntoIterator<Item = Part>) -> Part {
        let parts = parts.into_iter().map(|p| p.0).collect();
        self.part(Expr::All(parts))
    }

    /// All that lies in any of the parts.
    pub fn union(&mut self, parts: impl IntoIterator<Item = Part>) -> Part {
        let parts = parts.into_iter().map(|p| p.0).collect();
        self.part(Expr::Any(parts))
    }

    /// What lies in `from` and in none of the others.
    pub fn difference(&mut self, from: Part, others: impl IntoIterator<Item = Part>) -> Part {
        let mut parts = vec![from];
        for other in others {
            parts.push(self.inverse(other));
        }
        self.intersection(parts)
    }

    /// All that does not lie in the part.
    pub fn inverse(&mut self, part: Part) -> Part {
        self.part(Expr::Not(part.0))
    }

    fn part(&mut self, expr: Expr) -> Part {
        self.exprs.push(expr);
        Part((self.exprs.len() - 1) as u32)
    }

    /// How many leaves there are.
    pub fn len(&self) -> usize {
        self.traits.len()
    }

    /// Whether there is no leaf.
    pub fn is_empty(&self) -> bool {
        self.traits.is_empty()
    }

    /// Builds the solid; the builder is empty afterwards. `whole` is a part of this very builder.
    pub fn build(&mut self, whole: Part) -> Result<Compound, CsgError> {
        let mut all = core::mem::take(self);
        let tree = Tree::new(&all.exprs, whole.0, all.traits.len());
        let leaves = all.leaves.build()?;
        let mut first_slot = vec![0_u32];
        for arena in &leaves.arenas {
            first_slot.push(first_slot[first_slot.len() - 1] + arena.len());
        }
        let bounds = tree.bounds(&all.bounds);
        Ok(Compound { leaves, tree, traits: all.traits, first_slot, bounds, is_sheet: false })
    }
}

/// A root of the body, as a geometry's queries take it.
pub(super) struct Found {
    /// The slot of the leaf's surface among all of the compound.
    pub(super) slot: u32,
    /// Whether the body's normal is the leaf's turned round.
    pub(super) turned: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
    /// The primitive, counted from the compound's first.
    pub(super) primitive: u32,
    /// The leaf's root with the body's sign.
    pub(super) root: Root,
}

thread_local! {
    /// Each thread's memory for walks along rays.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Where on a body a ray starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// The slot among all of the compound.
    pub(super) slot: u32,
    /// The side of that leaf's own surface.
    pub(super) side: RaySide,
    /// Whether that is inside the body.
    pub(super) inside: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
}

impl Compound {
    /// Starts a new body.
    pub fn builder() -> CompoundBuilder {
        CompoundBuilder::default()
    }

    /// The surface alone: nothing is inside it.
    #[must_use]
    pub fn as_sheet(self) -> Self {
        Self { is_sheet: true, ..self }
    }

    /// Whether it has an inside.
    pub fn solidity(&self) -> Solidity {
        if self.is_sheet { Solidity::Open } else { Solidity::Solid }
    }

    /// A box that holds the body; unbounded if there is none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How many leaves there are.
    pub fn len(&self) -> usize {
        self.traits.len()
    }

    /// Whether there is no leaf.
    pub fn is_empty(&self) -> bool {
        self.traits.is_empty()
    }

    /// How many slots its leaves have.
    pub(super) fn slots(&self) -> u32 {
        self.first_slot[self.first_slot.len() - 1]
    }

    /// Memory held, about.
    pub(super) fn bytes(&self) -> usize {
        self.leaves.stats().bytes + self.traits.len() * 64 + self.tree.nodes() * 16
    }

    /// The arena and the slot in it of a slot among all.
    fn place(&self, slot: u32) -> (u32, u32) {
        let arena = self.first_slot.partition_point(|&first| first <= slot) - 1;
        (arena as u32, slot - self.first_slot[arena])
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The leaves as lanes see them, in their order; `None` if lanes cannot see one.
    pub(super) fn operands(&self) -> Option<Vec<Operand>> {
        let mut operands: Vec<Option<Operand>> = self.traits.iter().map(|_| None).collect();
        for (arena, &first) in self.leaves.arenas.iter().zip(&self.first_slot) {
            // Of a leaf in parts lanes see the box.
            for (surface, bounds) in arena.solids_in_parts() {
                let (leaf, outline) = (arena.object_of(surface) as usize, Sketch::vague(bounds).outline()?);
                operands[leaf] =
                    Some(Operand { outline, slot: first, primitive: 0, shown: self.traits[leaf].shown });
            }
            for slot in (0..arena.len()).filter(|&slot| arena.whole(slot).is_some()) {
                let (name, seen) = (arena.name(slot), arena.drawn(slot).seen);
                let Seen::Outline(outline) = seen else { return None };
                let shown = self.traits[name.object as usize].shown;
                let operand = Operand { outline, slot: first + slot, primitive: name.primitive, shown };
                operands[name.object as usize] = Some(operand);
            }
        }
        operands.into_iter().collect()
    }

    fn arena(&self, arena: u32) -> &dyn AnyArena {
        &*self.leaves.arenas[arena as usize]
    }

    /// Gathers the crossings of all leaves ahead of the ray's start.
    fn gather(&self, isa: Isa, ray: &LocalRay<'_>, from: Option<Start>, scratch: &mut Scratch) {
        scratch.begin(self.traits.len());
        let (near, far) = ray.unmoved().window((ray.t_min, ray.t_max));
        let line = Line {
            origin: ray.o,
            direction: ray.d,
            origin_error: ray.o_err,
            direction_error: ray.d_err,
            t_min: near,
            t_max: far,
        };
        let mut ahead = ray.from_side(None);
        // What lies behind the range tells where a leaf is in it.
        (ahead.t_max, ahead.rough) = (f64::INFINITY, false);
        let from = from.map(|start| (self.place(start.slot), start.side));
        for beside in &self.leaves.beside {
            for slot in slots(&beside.leaf()) {
                let before = scratch.len();
                self.visit(isa, Leaf { kind: beside.arena, first: slot, count: 1 }, &ahead, from, scratch);
                if scratch.len() == before {
                    let side = from.filter(|(place, _)| *place == (beside.arena, slot)).map(|f| f.1);
                    let arena = self.arena(beside.arena);
                    if arena.starts_inside(slot, &ahead.from_side(side)) {
                        scratch.start_inside(arena.name(slot).object);
                    }
                }
            }
        }
        self.leaves.tree.any(isa, &line, |leaf| {
            self.visit(isa, leaf, &ahead, from, scratch);
            false
        });
    }

    fn visit(
        &self,
        isa: Isa,
        leaf: Leaf,
        ray: &LocalRay<'_>,
        from: Option<((u32, u32), RaySide)>,
        scratch: &mut Scratch,
    ) {
        let arena = leaf.kind;
        let source = from.filter(|(place, _)| place.0 == arena).map(|(place, side)| (place.1, side));
        let filter = Filter { mask: EVERYTHING, source };
        let mut take = |slot, id: crate::ids::Id, root| {
            scratch.push(id.object, self.traits[id.object as usize].sense, (arena, slot), root);
            Flow::Continue
        };
        self.arena(arena).each(isa, slots(&leaf), ray, &filter, &mut take);
    }

    /// Shows the crossings of the body in the ray's range, ascending; says whether the ray starts inside.
    pub(super) fn trace(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        show: &mut dyn FnMut(Found) -> Flow,
    ) -> bool {
        SCRATCH.with_borrow_mut(|scratch| {
            self.gather(isa, ray, from, scratch);
            let mut inside = scratch.starts_inside(&self.tree);
            // On an edge where leaves meet the ray's start is on the right side of one of them only.
            let mut astray = from.is_some_and(|start| start.tied && start.inside != inside);
            scratch.sweep(
                &self.tree,
                |leaf| self.traits[leaf as usize].sense,
                |event| self.traits[event.leaf as usize].shown.holds(event.root.face),
                |crossing| {
                    if crossing.event.root.lo > ray.t_max {
                        return Flow::Stop;
                    }
                    if core::mem::take(&mut astray) && self.starts_at(isa, ray, &crossing.event) {
                        inside = !inside;
                        return Flow::Continue;
                    }
                    match self.in_range(isa, ray, crossing) {
                        Some(root) => show(self.found(crossing, root)),
                        None => Flow::Continue,
                    }
                },
            );
            inside
        })
    }

    /// Whether a ray starts so near to a surface that it crosses that nothing but rounding is between.
    #[cold]
    fn starts_at(&self, isa: Isa, ray: &LocalRay<'_>, event: &Event) -> bool {
        let local = ray.from_side(None);
        let q = self.arena(event.arena).resolve(isa, event.slot, &local, &event.root, Need::POINT);
        let start = ray.point_at_start();
        let way = q.p - start;
        let height = q.ng.to_vec().dot(way).abs();
        // Starts are at most a few roundings of their coordinates away from the point that was meant, and that is as far from the surface.
        let spacing = start.to_vec().max_abs() * (64.0 * durer_math::U);
        height <= 4.0 * q.off + spacing + q.bend * way.dot(way)
    }

    /// The crossing's root if it is in the ray's range. Its start was looked at where the crossing was found.
    fn in_range(&self, isa: Isa, ray: &LocalRay<'_>, crossing: &Crossing) -> Option<Root> {
        let Event { root, arena, slot, .. } = crossing.event;
        if root.hi <= ray.t_max {
            return Some(root);
        }
        let mut found = None;
        let mut local = ray.from_side(None);
        local.rough = false;
        let filter = Filter { mask: EVERYTHING, source: None };
        let mut take = |_, _, r: Root| {
            if (r.s.to_bits(), r.face, r.sign) == (root.s.to_bits(), root.face, root.sign) {
                found = Some(r);
            }
            Flow::Continue
        };
        self.arena(arena).each(isa, slot..slot + 1, &local, &filter, &mut take);
        found
    }

    fn found(&self, crossing: &Crossing, root: Root) -> Found {
        let Event { arena, slot, leaf, .. } = crossing.event;
        let name = self.arena(arena).name(slot);
        Found {
            slot: self.first_slot[arena as usize] + slot,
            turned: if crossing.sign == 0 { self.tree.is_inverted(leaf) } else { crossing.sign != root.sign },
            tied: crossing.tied,
            primitive: name.primitive,
            root: Root { sign: crossing.sign, ..root },
        }
    }

    /// The point of a root.
    pub(super) fn resolve(
        &self,
        isa: Isa,
        slot: u32,
        (turned, tied): (bool, bool),
        ray: &LocalRay<'_>,
        root: &Root,
        need: Need,
    ) -> SurfacePoint {
        let turn = |side: RaySide| match (turned, side) {
            (false, side) => side,
            (true, RaySide::Front) => RaySide::Back,
            (true, RaySide::Back) => RaySide::Front,
        };
        let (arena, inner) = self.place(slot);
        let own = Root { sign: if turned { -root.sign } else { root.sign }, ..*root };
        let local = ray.from_side(ray.source.map(turn));
        let mut point = self.arena(arena).resolve(isa, inner, &local, &own, need);
        if tied {
            point.off = self.clear_of_partners(isa, (arena, inner), &local, &own, &point);
        }
        if turned {
            (point.ng, point.ns) = (-point.ng, -point.ns);
            (point.dndu, point.dndv) = (-point.dndu, -point.dndv);
        }
        point
    }

    /// A distance along the normal that leaves all surfaces behind which lie along the point's own and could not be told from it.
    ///
    /// Where `n` and `n'` are the normals here and of another surface, and `h` its height over this point along `n'`, a step `x n` leaves it
    /// if `x |n.n'| - |h|` is more than the other's own bound and what it bends away over the distance between its point and the end of the
    /// step. A surface that crosses this one at an angle is not left by going along `n`, but rays decide exactly on which side of it they are.
    #[cold]
    fn clear_of_partners(
        &self,
        isa: Isa,
        (arena, slot): (u32, u32),
        ray: &LocalRay<'_>,
        root: &Root,
        point: &SurfacePoint,
    ) -> f64 {
        let event = |e: &Event| (e.arena, e.slot, e.root.face, e.root.s.to_bits());
        let own = (arena, slot, root.face, root.s.to_bits());
        SCRATCH.with_borrow_mut(|scratch| {
            self.gather(isa, ray, None, scratch);
            scratch.starts_inside(&self.tree);
            scratch.sweep(&self.tree, |leaf| self.traits[leaf as usize].sense, |_| true, |_| Flow::Continue);
            let mut off = point.off;
            for other in partners(scratch, &|e| event(e) == own) {
                let q = self.arena(other.arena).resolve(isa, other.slot, ray, &other.root, Need::POINT);
                let (n, m) = (point.ng.to_vec(), q.ng.to_vec());
                let along = n.dot(m).abs();
                let apart = (q.p - point.p).length();
                // Half: which surfaces lie along this one, and which cross it.
                if along >= 0.5 && q.bend.is_finite() {
                    let height = m.dot(q.p - point.p).abs();
                    let reach = apart + 2.0 * (point.off + q.off);
                    let away = q.bend * reach * reach;
                    off = off.max(
                        (height + 2.0 * q.off + away) / along * (1.0 + 64.0 * durer_math::U) + point.off,
                    );
                }
            }
            off
        })
    }

    /// On which side of the body a point lies. Where it is on the borders of several leaves it is on the body's, unless the other leaves decide.
    pub fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.is_sheet {
            return Side::Out;
        }
        // Both ways: leaves on whose border the point lies count as what makes the body smaller, then larger.
        let (mut less, mut more) = (Values::default(), Values::default());
        less.begin(&self.tree);
        more.begin(&self.tree);
        let mut learn = |leaf: u32, side: Side| {
            let inverted = self.tree.is_inverted(leaf);
            less.set(&self.tree, leaf, side == Side::In || side == Side::On && inverted);
            more.set(&self.tree, leaf, side == Side::In || side == Side::On && !inverted);
        };
        let leaves = &self.leaves;
        let mut ask = |leaf: Leaf| {
            let arena = self.arena(leaf.kind);
            for surface in slots(&leaf).filter_map(|slot| arena.whole(slot)) {
                learn(arena.object_of(surface), arena.side(surface, point));
            }
            false
        };
        for beside in &leaves.beside {
            ask(beside.leaf());
        }
        leaves.tree.containing(point.p, point.p_err, &mut ask);
        for solid in &leaves.solids_in_parts {
            let arena = self.arena(solid.arena);
            if solid.bounds.expanded(point.p_err).contains(point.p) {
                learn(arena.object_of(solid.surface), arena.side(solid.surface, point));
            }
        }
        match (less.holds(&self.tree), more.holds(&self.tree)) {
            (true, _) => Side::In,
            (_, false) => Side::Out,
            _ => Side::On,
        }
    }
}

impl core::fmt::Debug for Compound {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Compound")
            .field("leaves", &self.leaves)
            .field("bounds", &self.bounds)
            .finish_non_exhaustive()
    }
}
