//! The builder of a geometry.

use crate::arena::{AnyArena, Arena, Arrange, Unsorted};
use crate::csg::{Compound, Compounds};
use crate::geometry::{Beside, Geometry, Instance};
use crate::ids::{EVERYTHING, Id};
use crate::{ObjectId, PrimitiveId, geometry};
use core::any::TypeId;
use durer_bvh::{Bvh, CornersOf, Entry, Frame, Settings};
use durer_math::{Aabb, Affine, Isa};
use durer_surfaces::Accelerate;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Collects surfaces and instances for a [`Geometry`].
///
/// ```
/// use durer_geometry::Geometry;
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::Sphere;
///
/// let ball = Sphere::new(Point3::ORIGIN, 1.0)?;
/// let scene = Geometry::builder().with(ball).build()?;
/// let hit = scene.closest(&Ray::new(Point3::new(0.0, 0.0, -5.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.sign, hit.object.0), (4.0, -1, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct Builder {
    arenas: Vec<Box<dyn Arrange>>,
    by_type: HashMap<TypeId, usize>,
    instances: Vec<Instance>,
    next_object: u32,
    without_tree: bool,
    settings: Settings,
    isa: Option<Isa>,
    limits: Vec<Aabb>,
}

/// Why a geometry cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// There are more surfaces or parts than a tree can number.
    #[error(
        "geometry: at most {limit} surfaces, parts and instances fit into one tree, got {count}; use instances of smaller geometries"
    )]
    TooMany {
        /// How many there are.
        count: usize,
        /// How many fit.
        limit: usize,
    },
    /// There are more placements, counting nested ones, than can be numbered.
    #[error("geometry: at most {} placements fit, counting nested ones", u32::MAX)]
    TooManyPlacements,
    /// Instances are nested too deeply.
    #[error("geometry: instances may be nested {limit} deep, got {depth}")]
    TooDeep {
        /// How deep they are.
        depth: u32,
        /// How deep they may be.
        limit: u32,
    },
}

impl Builder {
    /// [`Builder::add`] for chains.
    #[must_use]
    pub fn with<S: Accelerate + 'static>(mut self, surface: S) -> Self {
        self.add(surface);
        self
    }

    /// [`Builder::add_compound`] for chains.
    #[must_use]
    pub fn with_compound(mut self, body: impl Into<Arc<Compound>>) -> Self {
        self.add_compound(body);
        self
    }

    /// [`Builder::instance`] for chains.
    #[must_use]
    pub fn with_instance(mut self, geometry: &Arc<Geometry>, affine: Affine, mask: u32) -> Self {
        self.instance(geometry, affine, mask);
        self
    }

    /// Adds a surface as an object of its own, with the next free number.
    pub fn add<S: Accelerate + 'static>(&mut self, surface: S) -> &mut Self {
        self.add_as(surface, ObjectId(self.next_object), PrimitiveId(0), EVERYTHING)
    }

    /// Adds a surface under the given numbers. If a surface has parts (the faces of a mesh), part
    /// `i` is the primitive `primitive + i`.
    ///
    /// A ray with mask `m` can hit the surface if `m & mask != 0`. Two surfaces may have the same
    /// numbers.
    pub fn add_as<S: Accelerate + 'static>(
        &mut self,
        surface: S,
        object: ObjectId,
        primitive: PrimitiveId,
        mask: u32,
    ) -> &mut Self {
        let arenas = &mut self.arenas;
        let index = *self.by_type.entry(TypeId::of::<S>()).or_insert_with(|| {
            arenas.push(Box::new(Arena::<S>::default()));
            arenas.len() - 1
        });
        let arena = self.arenas[index].as_any().downcast_mut::<Arena<S>>();
        // Always succeeds: the map has the arena of each type under that type.
        if let Some(arena) = arena {
            arena.push(surface, Id { object: object.0, primitive: primitive.0 }, mask);
        }
        self.next_object = self.next_object.max(object.0.saturating_add(1));
        self
    }

    /// Adds a CSG solid as an object of its own, with the next free number.
    pub fn add_compound(&mut self, body: impl Into<Arc<Compound>>) -> &mut Self {
        self.add_compound_as(body, ObjectId(self.next_object), PrimitiveId(0), EVERYTHING)
    }

    /// Adds a CSG solid to an object; `first` is added to the primitive numbers of its leaves.
    pub fn add_compound_as(
        &mut self,
        body: impl Into<Arc<Compound>>,
        object: ObjectId,
        first: PrimitiveId,
        mask: u32,
    ) -> &mut Self {
        let arenas = &mut self.arenas;
        let index = *self.by_type.entry(TypeId::of::<Compound>()).or_insert_with(|| {
            arenas.push(Box::new(Compounds::default()));
            arenas.len() - 1
        });
        if let Some(bodies) = self.arenas[index].as_any().downcast_mut::<Compounds>() {
            bodies.push(body.into(), Id { object: object.0, primitive: first.0 }, mask);
        }
        self.next_object = self.next_object.max(object.0.saturating_add(1));
        self
    }

    /// Adds a placement of a whole geometry. Its objects get the next free numbers, in their order.
    pub fn instance(&mut self, geometry: &Arc<Geometry>, affine: Affine, mask: u32) -> &mut Self {
        self.instance_as(geometry, affine, ObjectId(self.next_object), PrimitiveId(0), mask)
    }

    /// Adds a placement of a whole geometry; `object` and `primitive` are added to its numbers.
    pub fn instance_as(
        &mut self,
        geometry: &Arc<Geometry>,
        affine: Affine,
        object: ObjectId,
        primitive: PrimitiveId,
        mask: u32,
    ) -> &mut Self {
        let (geometry, first_placement) = (Arc::clone(geometry), 0);
        self.next_object = self.next_object.max(object.0.saturating_add(geometry.objects().max(1)));
        self.instances.push(Instance {
            geometry,
            affine,
            object: object.0,
            primitive: primitive.0,
            mask,
            first_placement,
        });
        self
    }

    /// Sets how the tree is built; the default is [`Settings::GOOD`]. Answers do not depend on it.
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// Builds no tree: every query tests everything. This defines the answers; those with a tree
    /// are equal, bit for bit.
    #[must_use]
    pub fn without_tree(mut self) -> Self {
        self.without_tree = true;
        self
    }

    /// Sets the instruction set, in place of that from [`Isa::detect`]. Answers do not depend on
    /// it.
    #[must_use]
    pub fn isa(mut self, isa: Isa) -> Self {
        self.isa = Some(isa);
        self
    }

    /// Sets a box for each object; what lies outside of it does not matter, so that rays that miss
    /// the box need no test.
    pub(crate) fn limits(&mut self, limits: Vec<Aabb>) {
        self.limits = limits;
    }

    /// A builder with the content of a geometry. Nothing may be added, as it has no map of types.
    pub(crate) fn again(
        arenas: Vec<Box<dyn Arrange>>,
        instances: Vec<Instance>,
        next_object: u32,
        settings: Option<Settings>,
        isa: Isa,
    ) -> Self {
        Self {
            arenas,
            instances,
            next_object,
            without_tree: settings.is_none(),
            settings: settings.unwrap_or_default(),
            isa: Some(isa),
            ..Self::default()
        }
    }

    /// Replaces the surfaces of type `S` for which `moved` returns another one, given the object,
    /// the primitive and the present surface.
    pub(crate) fn replace<S: Accelerate + 'static>(
        &mut self,
        mut moved: impl FnMut(ObjectId, PrimitiveId, &S) -> Option<S>,
    ) {
        let arenas = self.arenas.iter_mut();
        if let Some(arena) = arenas.filter_map(|arena| arena.as_any().downcast_mut::<Arena<S>>()).next() {
            arena.renew(|Id { object, primitive }, surface| {
                moved(ObjectId(object), PrimitiveId(primitive), surface)
            });
        }
    }

    /// Builds the geometry. It does not depend on the number of threads.
    pub fn build(self) -> Result<Geometry, BuildError> {
        let builder = self;
        let mut arenas = builder.arenas;
        let mut instances = builder.instances;
        let placements = number_placements(&mut instances)?;
        arenas.iter_mut().for_each(|a| a.seal());

        // Computed twice, which takes less than storing them.
        let placed = || instances.par_iter().map(|i| i.affine.bounds(&i.geometry.bounds()));
        let bounded = |b: Aabb| if b.is_bounded() { b } else { Aabb::EMPTY };
        let extent = arenas
            .iter()
            .map(|a| a.extent(&builder.limits))
            .fold(placed().map(bounded).reduce(|| Aabb::EMPTY, Aabb::union), Aabb::union);

        let leaf_slots: u64 = arenas.iter_mut().map(|a| leaf_slots(&mut **a)).sum();
        if leaf_slots > Compounds::MOST_SLOTS {
            return Err(BuildError::TooMany {
                count: leaf_slots as usize,
                limit: Compounds::MOST_SLOTS as usize,
            });
        }
        let frame = Frame::around(&extent);
        let mut entries: Vec<Entry> = Vec::new();
        let mut unsorted = Vec::new();
        for (kind, arena) in arenas.iter().enumerate() {
            unsorted.push(arena.entries(&frame, kind as u32, &builder.limits, &mut entries));
        }
        let instance_kind = arenas.len() as u32;
        unsorted.push(Unsorted::beside(&mut entries, &frame, instance_kind, placed()));
        let count = entries.len() + unsorted.iter().map(Unsorted::len).sum::<usize>();
        if count > durer_bvh::MAX_ENTRIES {
            return Err(BuildError::TooMany { count, limit: durer_bvh::MAX_ENTRIES });
        }

        let (tree, mut orders) = if builder.without_tree {
            let mut orders = vec![Vec::new(); unsorted.len()];
            entries.iter().for_each(|e| orders[e.kind() as usize].push(e.index()));
            (Bvh::empty(), orders)
        } else {
            let corners: Vec<_> = arenas
                .iter()
                .map(|arena| arena.is_of_triangles().then_some(|index| arena.corners(index)))
                .collect();
            let mut shapes: Vec<Option<CornersOf<'_>>> =
                corners.iter().map(|of| of.as_ref().map(|of| of as CornersOf<'_>)).collect();
            // The kind of instances.
            shapes.push(None);
            Bvh::build(&frame, entries, &shapes, &builder.settings)
        };
        let mut beside = Vec::new();
        let mut bounds = extent;
        for (arena, (order, unsorted)) in orders.iter_mut().zip(&unsorted).enumerate() {
            let first = if builder.without_tree { 0 } else { order.len() as u32 };
            order.extend_from_slice(&unsorted.beside);
            let count = order.len() as u32 - first;
            if count > 0 {
                beside.push(Beside { arena: arena as u32, first, count });
            }
            if !unsorted.beside.is_empty() {
                bounds = Aabb::UNBOUNDED;
            }
            order.extend_from_slice(&unsorted.nothing);
        }
        let instance_slots = orders.pop().unwrap_or_default();
        for (arena, order) in arenas.iter_mut().zip(orders) {
            arena.arrange(order);
        }
        let arenas: Vec<Box<dyn AnyArena>> = arenas.into_iter().map(Arrange::finish).collect();
        let solids_in_parts = geometry::solids_in_parts(&arenas);
        Ok(Geometry::assembled(
            builder.isa.unwrap_or_else(Isa::detect),
            arenas,
            instances,
            instance_slots,
            tree,
            beside,
            solids_in_parts,
            bounds,
            (!builder.without_tree).then_some(builder.settings),
            builder.next_object,
            placements,
        ))
    }
}

/// The total number of slots of the leaves of an arena's compounds.
fn leaf_slots(arena: &mut dyn Arrange) -> u64 {
    arena.as_any().downcast_ref::<Compounds>().map_or(0, Compounds::leaf_slots)
}

/// Numbers the placements in the order in which instances were added, each followed by its nested
/// ones. Returns how many there are, including the geometry's own.
fn number_placements(instances: &mut [Instance]) -> Result<u32, BuildError> {
    let mut next = 1_u32;
    for instance in instances {
        let depth = instance.geometry.depth() + 1;
        if depth > geometry::MAX_NESTING {
            return Err(BuildError::TooDeep { depth, limit: geometry::MAX_NESTING });
        }
        instance.first_placement = next;
        next = next.checked_add(instance.geometry.placements()).ok_or(BuildError::TooManyPlacements)?;
    }
    Ok(next)
}
