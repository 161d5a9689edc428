//! Objects: shapes with a placement, a look and flags.

use std::sync::Arc;

use durer_math::{Affine, AffineError};

use crate::{Deform, Interior, Placement, Shape, Texture, Warp};

/// A shape with its placement and its look.
///
/// A part of a union without a texture (or interior) of its own has the union's. The flags of a
/// union apply to all its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The shape.
    pub shape: Shape,
    /// From the shape's own frame to the space around the object (a union's frame, or the world).
    pub placement: Placement,
    /// Convex solids (spheres, boxes, planes and others; `inverse` keeps the outside) that clip the
    /// object: only the part in all of them is kept. They are placed in the space around the
    /// object.
    pub clips: Vec<Object>,
    /// Its texture, placed in the space around the object.
    pub texture: Option<Arc<Texture>>,
    /// The texture seen from inside, placed like `texture`. It is shown where a ray leaves a solid
    /// or runs along the normal of an open surface. For triangles and open meshes it is shown from
    /// the opposite side (a fact of the scene language).
    pub interior_texture: Option<Arc<Texture>>,
    /// If present, a part of this intersection or difference without a texture shows the textures
    /// of the other parts, mixed in equal amounts over all parts that contain the point. The parts
    /// that a difference subtracts lend no texture, and parts of unions borrow none (facts of the
    /// scene language). The value is the texture of parts that borrow none.
    pub cutaway_textures: Option<Arc<Texture>>,
    /// The medium that fills it.
    pub interior: Option<Arc<Interior>>,
    /// Its flags.
    pub flags: Flags,
    /// Its place in the text, for messages.
    pub place: Option<Place>,
}

/// Flags of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    /// It throws no shadow.
    pub no_shadow: bool,
    /// The camera does not see it.
    pub no_image: bool,
    /// Mirrors do not show it.
    pub no_reflection: bool,
    /// Fog and media of the scene continue inside it.
    pub hollow: bool,
    /// Inside and outside are exchanged.
    pub inverse: bool,
    /// Solids with caps, such as cylinders, cones and prisms, have none.
    pub open: bool,
    /// Light from behind the surface counts too.
    pub double_illuminate: bool,
    /// The number of the light group to which it belongs; that of a part counts before its union's.
    pub light_group: Option<u32>,
}

impl Flags {
    /// The union of two sets of flags.
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
            light_group: other.light_group.or(self.light_group),
        }
    }
}

/// A place in the text of a scene. The reader of the text knows the files by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The number of the file.
    pub file: u32,
    /// The number of bytes before the place.
    pub start: u32,
}

impl Object {
    /// An object with this shape, not moved and without a look.
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

    /// Deforms a solid. A union becomes a union of deformed parts, so that each keeps its look. So
    /// does a merge, intersection or difference if one of its parts has a look of its own, since
    /// the deformation of an intersection is the intersection of the deformed parts. Each part must
    /// then be bounded.
    ///
    /// Textures are not deformed. They are placed in the space around the deformed object, as the
    /// solid's own were placed in the space around the solid.
    pub fn deformed(mut solid: Self, warps: &[Warp]) -> Result<Self, AffineError> {
        let mut made = Self::new(Shape::Union(Vec::new()));
        (made.texture, made.interior, made.place) =
            (solid.texture.take(), solid.interior.take(), solid.place);
        made.interior_texture = solid.interior_texture.take();
        // Inverting before or after the deformation gives the same solid.
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

    /// Whether the object or a part of it has a texture or an interior.
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

    /// Returns the object with this texture.
    #[must_use]
    pub fn with_texture(mut self, texture: impl Into<Arc<Texture>>) -> Self {
        self.texture = Some(texture.into());
        self
    }

    /// Returns the object with this interior.
    #[must_use]
    pub fn with_interior(mut self, interior: impl Into<Arc<Interior>>) -> Self {
        self.interior = Some(interior.into());
        self
    }

    /// Transforms the object with everything it has so far, also its texture and its clips.
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
