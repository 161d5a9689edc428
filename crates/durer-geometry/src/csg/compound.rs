//! A CSG solid with its leaves.

use super::packet::Operand;
use super::sweep::Sense;
use super::tree::{Expr, Extent, Tree, Values};
use crate::arena::AnyArena;
use crate::filter_cache::FilterKind;
use crate::geometry::slots;
use crate::ids::EVERYTHING;
use crate::{BuildError, Builder, Geometry, LeafId, ObjectId, PrimitiveId};
use durer_bvh::Leaf;
use durer_math::Aabb;
use durer_surfaces::{Accelerate, LocalPoint, PartId, Side, Solidity};

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
/// let scene = Geometry::builder().with_compound(csg.build(body)?).build()?;
///
/// assert!(scene.closest(&Ray::new(Point3::new(0.0, 0.0, -5.0), Vec3::Z)).is_none());
/// let corner = scene.closest(&Ray::new(Point3::new(0.9, 0.9, -5.0), Vec3::Z)).unwrap();
/// assert_eq!((corner.t, corner.primitive.0), (4.0, 0)); // the cube is the first leaf
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Compound {
    /// The leaves. Their object numbers are the leaves' numbers, their primitive numbers come from
    /// the caller. Each has the box in which it matters.
    pub(super) leaves: Geometry,
    pub(super) tree: Tree,
    /// The traits of each leaf.
    pub(super) traits: Vec<Traits>,
    /// The first slot of each arena of the leaves, counted over all, and the end.
    pub(super) first_slot: Vec<u32>,
    bounds: Aabb,
    /// An upper bound on the coordinates of all bounded leaves.
    pub(super) size: f64,
    /// Whether some leaves are in the tree in parts: then all parts that a ray crosses are needed
    /// to decide whether it starts inside.
    pub(super) in_parts: bool,
    /// Whether rays search the leaves piece by piece.
    pub(super) by_pieces: bool,
    /// Whether some leaves are unbounded, or may be met in several pieces.
    pub(super) one_by_one: bool,
    /// Whether it is a surface without an inside.
    is_sheet: bool,
}

/// Properties of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Traits {
    pub(super) sense: Sense,
    pub(super) shown: Shown,
    /// Whether it is unbounded, so that a ray may be inside without ever crossing it.
    pub(super) is_endless: bool,
}

/// The visible faces of a leaf. An invisible face bounds the solid, too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// All of them.
    #[default]
    All,
    /// The first one only: the wall of a cylinder without caps.
    Wall,
    /// None: the leaf only cuts, and leaves openings.
    None,
}

impl Shown {
    pub(super) fn holds(self, face: u32) -> bool {
        match self {
            Self::All => true,
            Self::Wall => face == 0,
            Self::None => false,
        }
    }
}

/// A solid under construction. It becomes an operand of one other, or the whole.
#[derive(Debug)]
pub struct Part(u32);

/// Why a solid cannot be combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CsgError {
    /// The surface has no inside.
    #[error("csg: a {0} has no inside, so it cannot be combined with other solids")]
    Sheet(&'static str),
    /// The leaves do not fit into a geometry.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Collects the leaves of a [`Compound`] and combines them.
#[derive(Default)]
pub struct CompoundBuilder {
    leaves: Builder,
    exprs: Vec<Expr>,
    traits: Vec<Traits>,
    extents: Vec<Extent>,
    primitives: u32,
}

impl CompoundBuilder {
    /// Adds a solid, as the next primitive.
    pub fn leaf<S: Accelerate + 'static>(&mut self, solid: S) -> Result<Part, CsgError> {
        self.leaf_as(solid, LeafId(self.primitives), Shown::All)
    }

    /// Adds a solid under the given number. If a surface has parts (the faces of a mesh), part `i`
    /// has the number plus `i`.
    pub fn leaf_as<S: Accelerate + 'static>(
        &mut self,
        solid: S,
        LeafId(primitive): LeafId,
        shown: Shown,
    ) -> Result<Part, CsgError> {
        if solid.solidity() != Solidity::Solid {
            return Err(CsgError::Sheet(core::any::type_name::<S>()));
        }
        let mut parts = 0;
        solid.parts(&mut |_, _| parts += 1);
        let sense = if parts > 1 { Sense::Parity } else { Sense::Sign };
        let leaf = self.traits.len() as u32;
        let bounds = solid.bounds();
        let is_endless = sense == Sense::Sign && !bounds.is_bounded() && !bounds.is_empty();
        self.traits.push(Traits { sense, shown, is_endless });
        let (inner, half_space) = (solid.inner_bounds(), solid.half_space());
        let quadric = if is_endless && half_space.is_none() {
            solid.packet_filter(PartId(0)).quadric_extent()
        } else {
            None
        };
        self.extents.push(Extent { bounds, inner, half_space, quadric });
        self.primitives = self.primitives.max(primitive.saturating_add(parts.max(1)));
        self.leaves.add_as(solid, ObjectId(leaf), PrimitiveId(primitive), EVERYTHING);
        Ok(self.part(Expr::Leaf(leaf)))
    }

    /// The points that lie in all of the parts.
    pub fn intersection(&mut self, parts: impl IntoIterator<Item = Part>) -> Part {
        let parts = parts.into_iter().map(|p| p.0).collect();
        self.part(Expr::All(parts))
    }

    /// The points that lie in any of the parts.
    pub fn union(&mut self, parts: impl IntoIterator<Item = Part>) -> Part {
        let parts = parts.into_iter().map(|p| p.0).collect();
        self.part(Expr::Any(parts))
    }

    /// Unites parts and keeps their inner faces: a ray also crosses the faces of a part that lie
    /// within other parts. POV-Ray draws a `union` this way, and a `merge` without inner faces. For
    /// pictures only: spans and crossings of the solid need [`Self::union`].
    pub fn union_with_inner_faces(&mut self, parts: impl IntoIterator<Item = Part>) -> Part {
        let parts = parts.into_iter().map(|p| p.0).collect();
        self.part(Expr::AnyWithInner(parts))
    }

    /// The points that lie in `from` and in none of the others.
    pub fn difference(&mut self, from: Part, others: impl IntoIterator<Item = Part>) -> Part {
        let mut parts = vec![from];
        for other in others {
            parts.push(self.inverse(other));
        }
        self.intersection(parts)
    }

    /// The points that do not lie in the part.
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

    /// Builds the solid; the builder is empty afterwards. `whole` must be a part of this builder.
    pub fn build(&mut self, whole: Part) -> Result<Compound, CsgError> {
        let mut all = core::mem::take(self);
        let tree = Tree::new(&all.exprs, whole.0, all.traits.len());
        let mut limits = tree.where_leaves_matter(&all.extents);
        for (limit, _) in limits.iter_mut().zip(&all.traits).filter(|(_, t)| t.sense == Sense::Parity) {
            *limit = Aabb::UNBOUNDED;
        }
        all.leaves.limits(limits);
        let leaves = all.leaves.build()?;
        let mut first_slot = vec![0_u32];
        for arena in &leaves.arenas {
            first_slot.push(first_slot[first_slot.len() - 1] + arena.len());
        }
        let bounds = tree.bounds(&all.extents);
        let bounded = all.extents.iter().map(|e| e.bounds).filter(Aabb::is_bounded);
        let size = bounded.fold(0.0, |most, b| b.magnitude().max(most));
        let in_parts = all.traits.iter().any(|t| t.sense == Sense::Parity);
        let by_pieces = all.traits.len() >= Compound::MANY && !in_parts;
        let one_by_one = by_pieces || all.traits.iter().any(|t| t.is_endless);
        Ok(Compound {
            leaves,
            tree,
            traits: all.traits,
            first_slot,
            bounds,
            size,
            in_parts,
            by_pieces,
            one_by_one,
            is_sheet: false,
        })
    }
}

impl Compound {
    /// With this many leaves or more, rays search them piece by piece.
    const MANY: usize = 64;

    /// Starts a new CSG solid.
    pub fn builder() -> CompoundBuilder {
        CompoundBuilder::default()
    }

    /// The surface alone, without an inside.
    #[must_use]
    pub fn as_sheet(self) -> Self {
        Self { is_sheet: true, ..self }
    }

    /// Whether it has an inside.
    pub fn solidity(&self) -> Solidity {
        if self.is_sheet { Solidity::Open } else { Solidity::Solid }
    }

    /// A box around the solid; unbounded if there is no bounded one.
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

    /// Memory held, approximately.
    pub(super) fn bytes(&self) -> usize {
        self.leaves.stats().bytes + self.traits.len() * 64 + self.tree.nodes() * 16
    }

    /// Converts a slot counted over all arenas to its arena and the slot there.
    pub(super) fn place(&self, slot: u32) -> (u32, u32) {
        let arena = self.first_slot.partition_point(|&first| first <= slot) - 1;
        (arena as u32, slot - self.first_slot[arena])
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The leaves with their packet filters, in their order; `None` if one has no filter.
    pub(super) fn operands(&self) -> Option<Vec<Operand>> {
        let mut operands: Vec<Option<Operand>> = self.traits.iter().map(|_| None).collect();
        for (arena, &first) in self.leaves.arenas.iter().zip(&self.first_slot) {
            let in_parts = arena.solids_in_parts().into_iter().map(|(surface, _)| {
                let (seen, slots) = arena.solid(surface);
                // For leaves in parts crossings count by parity, whatever the orientation.
                let seen = match seen {
                    FilterKind::Outline(outline) if outline.is_turned() => FilterKind::Nothing,
                    seen => seen,
                };
                (arena.object_of(surface), seen, slots)
            });
            let whole = (0..arena.len()).filter(|&slot| arena.whole(slot).is_some());
            let whole = whole.map(|slot| (arena.name(slot).object, arena.drawn(slot).seen, vec![slot]));
            for (leaf, seen, slots) in in_parts.chain(whole) {
                let (FilterKind::Outline(outline), Some(&any)) = (seen, slots.first()) else { return None };
                let (primitive, shown) = (arena.name(any).primitive, self.traits[leaf as usize].shown);
                let slots = slots.into_iter().map(|slot| first + slot).collect();
                operands[leaf as usize] = Some(Operand { outline, slots, primitive, shown });
            }
        }
        operands.into_iter().collect()
    }

    pub(super) fn arena(&self, arena: u32) -> &dyn AnyArena {
        &*self.leaves.arenas[arena as usize]
    }

    /// The side of the solid on which a point lies. A point on the borders of several leaves is on
    /// the solid's border, unless the other leaves decide.
    pub fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.is_sheet {
            return Side::Out;
        }
        // Evaluated twice: leaves on whose border the point lies count so as to make the solid
        // smaller, then larger.
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
