//! Objects: shapes with a place, a look and habits.

use std::sync::Arc;

use durer_math::{Affine, AffineError};

use crate::{Deform, Interior, Placement, Shape, Texture, Warp};

/// A shape with its place and its look.
///
/// What stands in a union and has no texture (interior) of its own takes the union's. Flags of a
/// union hold for all its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its surface.
    pub shape: Shape,
    /// From the shape's own frame to the space around the object (a union's frame, or the world).
    pub placement: Placement,
    /// Convex solids (spheres, boxes, planes, ...; `inverse` keeps what is outside): only what lies
    /// in all of them is left. Placed in the space around the object.
    pub clips: Vec<Object>,
    /// Its texture, placed in the space around the object.
    pub texture: Option<Arc<Texture>>,
    /// What is seen from inside in place of its texture, placed like that: where a ray leaves a
    /// solid, or goes along the normal of an open surface; of triangles and open meshes where it
    /// comes from the other side of that (a fact of the scene language).
    pub interior_texture: Option<Arc<Texture>>,
    /// Of an intersection or a difference: a part without a texture shows those of the other parts
    /// at each point, as far as they hold the point, in equal parts. What is taken away lends no
    /// texture, and parts of unions borrow none (facts of the scene language). This is what those
    /// show that borrow none.
    pub cutaway_textures: Option<Arc<Texture>>,
    /// What fills it.
    pub interior: Option<Arc<Interior>>,
    /// Its habits.
    pub flags: Flags,
    /// Where it was written, for messages.
    pub place: Option<Place>,
}

/// An object's habits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    /// It throws no shadow.
    pub no_shadow: bool,
    /// The camera does not see it.
    pub no_image: bool,
    /// Mirrors do not show it.
    pub no_reflection: bool,
    /// Fog and media of the scene go on inside it.
    pub hollow: bool,
    /// Inside and outside are exchanged.
    pub inverse: bool,
    /// Cylinders, cones and cut quadrics have no caps.
    pub open: bool,
    /// Light from behind the surface counts too.
    pub double_illuminate: bool,
}

impl Flags {
    /// The flags of either.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            no_shadow: self.no_shadow | other.no_shadow,
            no_image: self.no_image | other.no_image,
            no_reflection: self.no_reflection | other.no_reflection,
            hollow: self.hollow | other.hollow,
            inverse: self.inverse ^ other.inverse,
            open: self.open | other.open,
            double_illuminate: self.double_illuminate | other.double_illuminate,
        }
    }
}

/// A place in the text of a scene; its reader knows the files by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The number of the file.
    pub file: u32,
    /// Bytes before the place.
    pub start: u32,
}

impl Object {
    /// A shape where its own numbers put it, without a look.
    pub fn new(shape: Shape) -> Self {
        Self {
            shape,
            placement: Placement::IDENTITY,
            clips: Vec::new(),
            texture: None,
            interior_texture: None,
            cutaway_textures: None,
            interior: None,
            flags: Flags::default(),
            place: None,
        }
    }

    /// A solid, deformed. A union becomes a union of deformed parts, so that each keeps its look;
    /// so does a merge, intersection or difference if one of its parts has a look of its own, since
    /// the deformation of an intersection is that of its parts' deformations. Each part must have
    /// an end then.
    ///
    /// Textures are not deformed: they are placed in the space around the deformed object, where
    /// the solid's own were placed around the solid.
    pub fn deformed(mut solid: Self, warps: &[Warp]) -> Result<Self, AffineError> {
        let mut made = Self::new(Shape::Union(Vec::new()));
        (made.texture, made.interior, made.place) =
            (solid.texture.take(), solid.interior.take(), solid.place);
        made.interior_texture = solid.interior_texture.take();
        // Turned inside out after or before is the same.
        let open = Flags { open: solid.flags.open, ..Flags::default() };
        made.flags = Flags { open: false, ..core::mem::replace(&mut solid.flags, open) };
        let is_plain = solid.clips.is_empty() && !solid.flags.open;
        let each = |parts: Vec<Self>, place: &Placement| {
            let moved = |mut part: Self| {
                part.transform(place.affine())?;
                Self::deformed(part, warps)
            };
            parts.into_iter().map(moved).collect::<Result<Vec<_>, AffineError>>()
        };
        made.shape = match solid.shape {
            Shape::Union(parts) if is_plain => Shape::Union(each(parts, &solid.placement)?),
            Shape::Csg(operation, parts) if is_plain && parts.iter().any(Self::has_look) => {
                Shape::Csg(operation, each(parts, &solid.placement)?)
            }
            shape => {
                solid.shape = shape;
                Shape::Deform(Box::new(Deform { solid, warps: warps.to_vec() }))
            }
        };
        Ok(made)
    }

    /// Whether it or a part of it has a texture or an interior.
    fn has_look(&self) -> bool {
        self.texture.is_some()
            || self.interior_texture.is_some()
            || self.interior.is_some()
            || match &self.shape {
                Shape::Union(parts) | Shape::Csg(_, parts) => parts.iter().any(Self::has_look),
                Shape::Deform(deform) => deform.solid.has_look(),
                _ => false,
            }
    }

    /// The same object with a texture.
    #[must_use]
    pub fn with_texture(mut self, texture: impl Into<Arc<Texture>>) -> Self {
        self.texture = Some(texture.into());
        self
    }

    /// The same object with an interior.
    #[must_use]
    pub fn with_interior(mut self, interior: impl Into<Arc<Interior>>) -> Self {
        self.interior = Some(interior.into());
        self
    }

    /// Moves the object with all it has so far: its texture and its clips too.
    pub fn transform(&mut self, map: &Affine) -> Result<(), AffineError> {
        self.placement.then(map)?;
        for texture in self.texture.iter_mut().chain(&mut self.interior_texture) {
            if !texture.is_uniform() {
                Arc::make_mut(texture).transform(map)?;
            }
        }
        self.clips.iter_mut().try_for_each(|clip| clip.transform(map))
    }
}

impl From<Shape> for Object {
    fn from(shape: Shape) -> Self {
        Self::new(shape)
    }
}
