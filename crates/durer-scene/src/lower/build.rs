//! Putting a surface into the geometry: placed, clipped, turned inside out.

use durer_geometry::{Builder, CompoundBuilder, LeafId, ObjectId, Part, PrimitiveId, Shown};
use durer_math::{Aabb, Affine};
use durer_surfaces::{Algebraic, Clip, Complement, DynSurface, Placed, Region, Solidity, Surface};

use super::camera_media::{Enclosure, Held};

/// Where a surface goes.
pub(super) enum To<'b> {
    /// It is a primitive of an object of the scene, met by rays with the mask.
    Scene(&'b mut Builder, ObjectId, PrimitiveId, u32),
    /// It is a leaf of a solid made of solids; its part of it, once it is there.
    Leaf(&'b mut CompoundBuilder, LeafId, Shown, &'b mut Option<Part>),
}

/// Where a surface goes, and what is done to it on the way.
pub(super) struct Target<'b> {
    pub(super) to: To<'b>,
    pub(super) clips: Vec<Region>,
    pub(super) inverse: bool,
    /// The solid, if rays of the camera may start in it.
    pub(super) inside: Option<Box<dyn Enclosure>>,
    /// Where rays of the camera start.
    pub(super) camera: Aabb,
}

impl Target<'_> {
    /// Adds a surface of a common kind, placed by `map` if its numbers are not final: it has an
    /// array of its own, for either case.
    pub(super) fn add<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        match map {
            _ if self.is_changed() => self.add_rare(surface, map),
            None => self.push(surface),
            Some(map) => self.push(Placed::new(surface, *map)),
        }
    }

    /// Adds a surface of a kind that is common where its numbers are final.
    pub(super) fn add_final<S: Algebraic + 'static>(&mut self, surface: S, map: Option<&Affine>) {
        if map.is_none() && !self.is_changed() {
            self.push(surface);
        } else {
            self.add_rare(surface, map);
        }
    }

    /// Adds a surface of a rare kind. What is clipped is a sheet: turning it inside out changes
    /// nothing.
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

    /// Keeps the closed, unclipped solid if rays of the camera may start in it: that is what the
    /// scene language asks where the camera is concerned.
    pub(super) fn contain<S: Surface + Clone + 'static>(&mut self, solid: &S, map: Option<&Affine>) {
        let bounds = || map.map_or_else(|| solid.bounds(), |m| solid.bounds_through(m));
        if self.camera.is_empty()
            || solid.solidity() != Solidity::Solid
            || !self.inverse && bounds().intersection(self.camera).is_empty()
        {
            return;
        }
        let (solid, inverse) = (solid.clone(), self.inverse);
        let inside: Box<dyn Enclosure> = match map {
            None => Box::new(Held { solid, inverse }),
            Some(map) => Box::new(Held { solid: Placed::new(solid, *map), inverse }),
        };
        self.inside = (inside.holds_all(&self.camera) != Some(false)).then_some(inside);
    }

    fn push<S: Surface + 'static>(&mut self, surface: S) {
        match &mut self.to {
            To::Scene(builder, object, primitive, mask) => {
                builder.add_as(surface, *object, *primitive, *mask);
            }
            // Whoever asks for a leaf sees whether there is one: sheets are none. Of several surfaces
            // it is the union.
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

/// A surface, placed by `map`, behind pointers. What is done to it is done outside of its own, so
/// that each kind is compiled once.
fn erased<S: Algebraic + 'static>(surface: S, map: Option<&Affine>) -> DynSurface {
    let surface = DynSurface::new(surface);
    match map {
        None => surface,
        Some(map) => DynSurface::new(Placed::new(surface, *map)),
    }
}
