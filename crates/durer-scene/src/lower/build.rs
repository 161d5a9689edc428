//! Adding a surface to the geometry: placed, clipped, inverted.

use durer_geometry::{Builder, CompoundBuilder, LeafId, ObjectId, Part, PrimitiveId, Shown};
use durer_math::{Aabb, Affine};
use durer_surfaces::{Accelerate, Algebraic, Clip, Complement, DynSurface, Placed, Region, Solidity};

use super::camera_media::Enclosure;
use super::shared::Isosurfaces;

/// Where a surface is added.
pub(super) enum To<'b> {
    /// As a primitive of an object of the scene, hit by rays with this mask.
    Scene(&'b mut Builder, ObjectId, PrimitiveId, u32),
    /// As a leaf of a CSG compound. The part number is set when the leaf is added.
    Leaf(&'b mut CompoundBuilder, LeafId, Shown, &'b mut Option<Part>),
}

/// Where a surface is added, and how it is changed before.
pub(super) struct Target<'b> {
    pub(super) to: To<'b>,
    pub(super) clips: Vec<Region>,
    pub(super) inverse: bool,
    /// The solid, if camera rays may start inside it.
    pub(super) inside: Option<Enclosure>,
    /// A box that contains the starts of camera rays.
    pub(super) camera: Aabb,
    pub(super) isosurfaces: &'b mut Isosurfaces,
}

impl Target<'_> {
    /// Adds a surface of a common kind, placed by `map` if its numbers are not final. Such kinds
    /// have arrays of their own, plain and placed.
    pub(super) fn add<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        match map {
            _ if self.is_changed() => self.add_rare(surface, map),
            None => self.push(surface),
            Some(map) => self.push(Placed::new(surface, *map)),
        }
    }

    /// Adds a surface of a kind that has an array of its own only if its numbers are final.
    pub(super) fn add_final<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        if map.is_none() && !self.is_changed() {
            self.push(surface);
        } else {
            self.add_rare(surface, map);
        }
    }

    /// Adds a surface of a rare kind. A clipped surface is an open sheet, so inverting it has no
    /// effect.
    pub(super) fn add_rare<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        if self.clips.is_empty() {
            self.add_whole(surface, map);
            return;
        }
        let clips = core::mem::take(&mut self.clips);
        self.push(DynSurface::new(Clip::new(erased(surface, map), clips)));
    }

    fn add_whole<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        let whole = erased(surface, map);
        if self.inverse { self.push(Complement(whole)) } else { self.push(whole) }
    }

    fn is_changed(&self) -> bool {
        self.inverse || !self.clips.is_empty()
    }

    /// Keeps the closed, unclipped solid if camera rays may start inside it: the scene language
    /// uses it to find the media around the camera.
    pub(super) fn contain<S: Algebraic + Clone + 'static>(&mut self, solid: &S, map: Option<&Affine>) {
        let bounds = || map.map_or_else(|| solid.bounds(), |m| solid.bounds_through(m));
        if self.camera.is_empty()
            || solid.solidity() != Solidity::Solid
            || !self.inverse && bounds().intersection(self.camera).is_empty()
        {
            return;
        }
        let solid = erased(solid.clone(), map);
        let inside = if self.inverse { Enclosure::Complement(solid) } else { Enclosure::Solid(solid) };
        self.inside = (inside.holds_all(&self.camera) != Some(false)).then_some(inside);
    }

    fn push<S: Accelerate + 'static>(&mut self, surface: S) {
        match &mut self.to {
            To::Scene(builder, object, primitive, mask) => {
                builder.add_as(surface, *object, *primitive, *mask);
            }
            // The caller sees from `part` whether a leaf was added: an open sheet is refused. Several
            // surfaces are united.
            To::Leaf(csg, leaf, shown, part) => {
                let more = csg.leaf_as(surface, *leaf, *shown).ok();
                **part = match (part.take(), more) {
                    (Some(one), Some(other)) => Some(csg.union(vec![one, other])),
                    (one, other) => other.or(one),
                };
            }
        }
    }
}

/// Boxes a surface, placed by `map`. `Placed` wraps the boxed surface, so that its code is compiled
/// once for all kinds.
fn erased<S: Algebraic + 'static>(surface: S, map: Option<&Affine>) -> DynSurface {
    let surface = DynSurface::new(surface);
    match map {
        None => surface,
        Some(map) => DynSurface::new(Placed::new(surface, *map)),
    }
}
