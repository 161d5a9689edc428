//! Surfaces that move: new surfaces in an existing geometry.

use crate::arena::Arena;
use crate::filter_cache::Outlines;
use crate::geometry::{Geometry, solids_in_parts};
use crate::ids::Id;
use crate::{BuildError, ObjectId, PrimitiveId};
use durer_bvh::CornersOf;
use durer_math::Aabb;
use durer_surfaces::Accelerate;
use std::sync::OnceLock;

/// Why a geometry cannot be refitted. It is then unchanged; a geometry that is built anew can hold
/// any surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefitError {
    /// A surface has other parts than before: for example, a mesh has other faces with an area.
    #[error(
        "geometry: the parts of primitive {primitive} of object {object} have changed: use rebuild instead of refit"
    )]
    Parts {
        /// The object.
        object: u32,
        /// The primitive within the object.
        primitive: u32,
    },
    /// A surface was bounded and is not any more, or it was empty and is not any more, or the other
    /// way round.
    #[error(
        "geometry: the tree cannot hold the new bounds of primitive {primitive} of object {object}: use rebuild instead of refit"
    )]
    Bounds {
        /// The object.
        object: u32,
        /// The primitive within the object.
        primitive: u32,
    },
}

impl Geometry {
    /// Replaces surfaces of type `S` for which `moved` returns another one, given the object, the
    /// primitive and the present surface.
    ///
    /// The tree keeps its nodes and gets new boxes, in a fraction of the time of a build. Answers
    /// are those of a geometry that is built anew. Queries take as long as before while neighbours
    /// stay neighbours; when the tree's cost in [`Geometry::stats`] has grown by half, it pays to
    /// [build anew](Geometry::rebuild).
    ///
    /// ```
    /// use durer_geometry::Geometry;
    /// use durer_math::{Point3, Ray, Vec3};
    /// use durer_surfaces::Sphere;
    ///
    /// let mut scene = Geometry::builder().with(Sphere::new(Point3::ORIGIN, 1.0)?).build()?;
    /// let higher = Sphere::new(Point3::new(0.0, 0.0, 3.0), 1.0)?;
    /// scene.refit(|_, _, _: &Sphere| Some(higher))?;
    /// let hit = scene.closest(&Ray::new(Point3::new(0.0, 0.0, 9.0), -Vec3::Z)).unwrap();
    /// assert_eq!(hit.t, 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If the tree cannot hold the new surfaces; see [`RefitError`].
    pub fn refit<S: Accelerate + 'static>(
        &mut self,
        mut moved: impl FnMut(ObjectId, PrimitiveId, &S) -> Option<S>,
    ) -> Result<(), RefitError> {
        let found = self.arenas.iter_mut().position(|arena| arena.as_any().is::<Arena<S>>());
        let Some(kind) = found else { return Ok(()) };
        let parts = |Id { object, primitive }| RefitError::Parts { object, primitive };
        let by_name =
            |Id { object, primitive }, surface: &S| moved(ObjectId(object), PrimitiveId(primitive), surface);
        let Some(arena) = self.arenas[kind].as_any().downcast_mut::<Arena<S>>() else { return Ok(()) };
        let mut old = arena.replace(by_name).map_err(parts)?;
        let refitted = self.follow(kind);
        if refitted.is_err()
            && let Some(arena) = self.arenas[kind].as_any().downcast_mut::<Arena<S>>()
        {
            arena.swap(&mut old);
        }
        refitted
    }

    /// Replaces surfaces like [`Geometry::refit`], but builds the tree anew: as good as the first
    /// one, wherever things have moved, and with surfaces that have other parts or bounds.
    ///
    /// The surfaces that are not replaced are only sorted. Answers are those of a geometry that is
    /// built anew.
    ///
    /// ```
    /// use durer_geometry::Geometry;
    /// use durer_math::{Point3, Ray, Vec3};
    /// use durer_surfaces::Sphere;
    ///
    /// let scene = Geometry::builder().with(Sphere::new(Point3::ORIGIN, 1.0)?).build()?;
    /// let higher = Sphere::new(Point3::new(0.0, 0.0, 3.0), 1.0)?;
    /// let scene = scene.rebuild(|_, _, _: &Sphere| Some(higher))?;
    /// let hit = scene.closest(&Ray::new(Point3::new(0.0, 0.0, 9.0), -Vec3::Z)).unwrap();
    /// assert_eq!(hit.t, 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If there are too many parts now.
    pub fn rebuild<S: Accelerate + 'static>(
        self,
        moved: impl FnMut(ObjectId, PrimitiveId, &S) -> Option<S>,
    ) -> Result<Self, BuildError> {
        let mut builder = self.reopened();
        builder.replace(moved);
        builder.build()
    }

    /// Updates everything that depends on the positions of the surfaces of a kind; on an error
    /// nothing has changed.
    fn follow(&mut self, kind: usize) -> Result<(), RefitError> {
        let mut boxes: Vec<Vec<Aabb>> = self.arenas.iter().map(|arena| arena.slot_bounds()).collect();
        let refused = |slot: usize| {
            let Id { object, primitive } = self.arenas[kind].name(slot as u32);
            Err(RefitError::Bounds { object, primitive })
        };
        // The slots in the tree come first, then those that every ray tests, then the empty ones.
        let in_tree = self.tree.count(kind as u32);
        let asked = self.beside.iter().find(|b| b.arena as usize == kind);
        let met = asked.map_or(in_tree, |b| (b.first + b.count) as usize);
        let is_wrong = |(slot, b): (usize, &Aabb)| {
            if slot < in_tree { !b.is_bounded() || b.is_empty() } else { slot >= met && !b.is_empty() }
        };
        if let Some(slot) = boxes[kind].iter().enumerate().position(is_wrong) {
            return refused(slot);
        }
        let instances = self.instance_slots.iter().map(|&i| {
            let instance = &self.instances()[i as usize];
            instance.affine.bounds(&instance.geometry.bounds())
        });
        boxes.push(instances.collect());
        let corners: Vec<_> = self
            .arenas
            .iter()
            .map(|arena| arena.is_of_triangles().then_some(|slot| arena.slot_corners(slot)))
            .collect();
        let mut shapes: Vec<Option<CornersOf<'_>>> =
            corners.iter().map(|of| of.as_ref().map(|of| of as CornersOf<'_>)).collect();
        shapes.push(None);
        let place = |kind: u32, slot: u32| boxes[kind as usize][slot as usize];
        if let Err(durer_bvh::RefitError::Unbounded { slot, .. }) = self.tree.refit(place, &shapes) {
            return refused(slot as usize);
        }
        self.bounds = Aabb::EMPTY;
        for b in boxes.iter().flatten().filter(|b| !b.is_empty()) {
            self.bounds = if b.is_bounded() { self.bounds.union(*b) } else { Aabb::UNBOUNDED };
        }
        self.solids_in_parts = solids_in_parts(&self.arenas);
        self.outlines = OnceLock::<Outlines>::new();
        Ok(())
    }
}
