//! From a scene to the geometry that rays meet, and what each surface looks like.
//!
//! Unions are taken apart, what they say about looks is handed down, and every surface gets its two
//! numbers: `object` counts the scene's objects in the order of the text, `primitive` the surfaces
//! within the object, each face of a mesh by itself.

mod blob_texture;
mod build;
mod camera_media;
mod csg;
mod fold_transform;
mod level_set;
mod looks;
mod named_quadric;
mod shapes;
mod shared;

use std::sync::Arc;

use durer_geometry::{BuildError, Builder, EVERYTHING, Geometry, ObjectId, PrimitiveId};
use durer_math::{Aabb, Affine, AffineError, Point3, Vec3};

use crate::{Camera, Face, Flags, Interior, Mesh, Object, Place, Placement, Scene, Shape, Texture, mask};
use camera_media::Enclosure;
use looks::{LookTable, PrimitiveLooks};

pub use looks::{Look, LookId};

/// A scene made ready for rays.
pub struct Lowered {
    /// What rays meet.
    pub geometry: Geometry,
    /// Every look there is.
    pub looks: Vec<Look>,
    /// Every medium there is; the first is that of opaque objects without an interior of their own.
    pub media: Vec<Arc<Interior>>,
    /// What the reader of the text should be told: the scene is rendered all the same.
    pub warnings: Vec<(Option<Place>, String)>,
    primitives: PrimitiveLooks,
    around_camera: Vec<(u32, Box<dyn Enclosure>)>,
}

/// Why a scene has no geometry, and where it says so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{kind}")]
pub struct LowerError {
    /// Where the object is written.
    pub place: Option<Place>,
    /// What is wrong with it.
    pub kind: LowerErrorKind,
}

/// What is wrong with an object.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LowerErrorKind {
    /// Its shape cannot exist.
    #[error("{0}")]
    Shape(String),
    /// Its transformation cannot place anything.
    #[error(transparent)]
    Placement(#[from] AffineError),
    /// What it is clipped by is not bounded by planes and quadrics.
    #[error(
        "clipped_by: {0} cannot clip: spheres, boxes, cylinders, cones, planes, all quadrics, spherical sectors and their inverses can"
    )]
    Clip(&'static str),
    /// A part of a solid has no inside.
    #[error("{0} has no inside, so it cannot be part of a merge, intersection or difference")]
    Sheet(&'static str),
    /// Something has no formula, so it cannot be deformed.
    #[error(
        "{0} cannot be deformed: spheres, boxes, cylinders, cones, planes, quadrics, tori, polynomials, superellipsoids, blobs, isosurfaces and solids of them can"
    )]
    Deform(&'static str),
    /// A mesh refers to a texture that it does not have.
    #[error("mesh: face {face} refers to texture {texture}, but there are {count}")]
    MeshTexture {
        /// The face.
        face: usize,
        /// The texture it names.
        texture: u32,
        /// How many there are.
        count: usize,
    },
    /// A mesh refers to a normal that it does not have.
    #[error("mesh: face {face} refers to normal {normal}, but there are {count}")]
    MeshNormal {
        /// The face.
        face: usize,
        /// The normal it names.
        normal: u32,
        /// How many there are.
        count: usize,
    },
    /// Which textures are shown where something is cut depends on the point.
    #[error("cutaway_textures: {0}")]
    Cutaway(&'static str),
    /// A mesh refers to texture coordinates that it does not have.
    #[error("mesh: face {face} refers to texture coordinates {uv}, but there are {count}")]
    MeshUv {
        /// The face.
        face: usize,
        /// The coordinates it names.
        uv: u32,
        /// How many there are.
        count: usize,
    },
    /// A pattern without entries.
    #[error("texture: a pattern needs at least one entry for each of its kinds")]
    EmptyPattern,
    /// The whole does not fit.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// More primitives than numbers.
    #[error("scene: at most {} primitives fit", u32::MAX)]
    TooMany,
}

impl Scene {
    /// Builds the geometry, and says what each of its surfaces looks like.
    ///
    /// Each crossing of an object is one of the solid's own.
    pub fn lower(&self) -> Result<Lowered, LowerError> {
        self.lower_for(Purpose::Queries)
    }

    /// As [`Self::lower`], for pictures: a union within a merge, an intersection or a difference
    /// keeps the faces that lie inside its parts, as POV-Ray draws it. They show through clear
    /// textures.
    pub fn lower_for_pictures(&self) -> Result<Lowered, LowerError> {
        self.lower_for(Purpose::Pictures)
    }

    fn lower_for(&self, purpose: Purpose) -> Result<Lowered, LowerError> {
        let mut lowering = Lowering::new(self, purpose);
        for (number, object) in (0..).zip(&self.objects) {
            lowering.object = ObjectId(number);
            lowering.table.begin().map_err(|kind| kind.at(object.place))?;
            lowering.top = object;
            lowering.walk(object, &Context::default())?;
            lowering.table.end().map_err(|kind| kind.at(object.place))?;
        }
        lowering.finish()
    }
}

impl Lowered {
    /// What a primitive of an object looks like; `None` if there is no such primitive.
    #[inline]
    pub fn look_of(&self, object: u32, primitive: u32) -> Option<LookId> {
        self.primitives.of(object, primitive)
    }

    /// Appends the media of all solids that hold `point`, at which a ray of the camera starts, in
    /// the order of the text.
    pub fn media_at(&self, point: Point3, media: &mut Vec<u32>) {
        for (medium, solid) in &self.around_camera {
            if !media.contains(medium) && solid.holds(point) {
                media.push(*medium);
            }
        }
    }

    /// The same for all points of a box, if those are certainly in the same solids.
    pub fn media_in(&self, region: &Aabb) -> Option<Vec<u32>> {
        let mut media = Vec::new();
        for (medium, solid) in &self.around_camera {
            if solid.holds_all(region)? && !media.contains(medium) {
                media.push(*medium);
            }
        }
        Some(media)
    }

    /// How many primitives an object has.
    pub fn primitives(&self, object: u32) -> u32 {
        self.primitives.count(object)
    }
}

impl core::fmt::Debug for Lowered {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Lowered")
            .field("geometry", &self.geometry)
            .field("looks", &self.looks.len())
            .field("media", &self.media.len())
            .field("warnings", &self.warnings)
            .finish_non_exhaustive()
    }
}

/// A texture and the space in which it is placed.
type Painted = (Arc<Texture>, Arc<Placement>);

/// What an object inherits from the unions around it.
#[derive(Clone, Default)]
struct Context<'s> {
    /// From the space around the object to the world.
    frame: Arc<Placement>,
    texture: Option<Painted>,
    /// The texture is that of the other parts of an intersection; parts of unions have this one.
    unlent: Option<Arc<Texture>>,
    /// What is seen from inside.
    inside: Option<Painted>,
    medium: Option<u32>,
    flags: Flags,
    /// What the unions are clipped by.
    clips: Vec<Cutter<'s>>,
}

/// What something is clipped by.
#[derive(Clone)]
struct Cutter<'s> {
    object: &'s Object,
    /// From the space around it to the world.
    frame: Arc<Placement>,
    /// What it holds, in the world, if it is bounded by planes and quadrics alone.
    region: Option<durer_surfaces::Region>,
}

/// What the geometry is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// Crossings, spans, sides of points.
    Queries,
    /// Pictures.
    Pictures,
}

/// The work at hand.
struct Lowering {
    purpose: Purpose,
    builder: Builder,
    table: LookTable,
    media: Vec<Arc<Interior>>,
    warnings: Vec<(Option<Place>, String)>,
    around_camera: Vec<(u32, Box<dyn Enclosure>)>,
    /// Meshes of several objects.
    shared: shared::Meshes,
    object: ObjectId,
    /// The object with that number, to compare addresses with.
    top: *const Object,
    /// Where rays of the camera start.
    camera: Aabb,
    default_texture: Arc<Texture>,
    /// The one frame of everything that no union moves: one address, so that looks can be told
    /// apart by it.
    world: Arc<Placement>,
    /// No object has habits and all are opaque: one mask for all.
    is_plain: bool,
}

impl Lowering {
    fn new(scene: &Scene, purpose: Purpose) -> Self {
        Self {
            purpose,
            builder: Geometry::builder(),
            table: LookTable::default(),
            media: vec![Arc::default()],
            warnings: Vec::new(),
            around_camera: Vec::new(),
            shared: shared::Meshes::of(&scene.objects),
            top: core::ptr::null(),
            camera: scene.camera.as_ref().map_or(Aabb::EMPTY, Camera::standpoints),
            object: ObjectId(0),
            default_texture: Arc::default(),
            world: Arc::default(),
            is_plain: scene.objects.iter().all(is_plain),
        }
    }

    fn finish(mut self) -> Result<Lowered, LowerError> {
        let geometry = self.builder.build().map_err(|e| LowerErrorKind::from(e).at(None))?;
        let (looks, primitives) = self.table.finish();
        Ok(Lowered {
            geometry,
            looks,
            media: self.media,
            warnings: self.warnings,
            primitives,
            around_camera: self.around_camera,
        })
    }

    /// Lowers an object with all its parts.
    fn walk<'s>(&mut self, object: &'s Object, around: &Context<'s>) -> Result<(), LowerError> {
        let fail = |kind: LowerErrorKind| kind.at(object.place);
        let inner = self.inherited(object, around)?;
        let place = join(&object.placement, &around.frame).map_err(|e| fail(e.into()))?;
        if let Shape::Union(parts) = &object.shape {
            let inner = Context { frame: Arc::new(place), ..inner };
            return parts.iter().try_for_each(|part| self.walk(part, &inner));
        }
        if matches!(object.shape, Shape::Csg(..)) || inner.clips.iter().any(|c| c.region.is_none()) {
            return self.compound(object, around, inner);
        }
        self.leaf(object, place.affine(), inner).map_err(fail)
    }

    /// What an object hands down to its parts: its own, and what it has none of from those around
    /// it.
    fn inherited<'s>(&mut self, object: &'s Object, around: &Context<'s>) -> Result<Context<'s>, LowerError> {
        let own = |texture: &Option<Arc<Texture>>, inherited: &Option<Painted>| match texture {
            Some(texture) if texture.has_empty_pattern() => {
                Err(LowerErrorKind::EmptyPattern.at(object.place))
            }
            Some(texture) => Ok(Some((Arc::clone(texture), self.frame(around)))),
            None => Ok(inherited.clone()),
        };
        let texture = own(&object.texture, &around.texture)?;
        let inside = own(&object.interior_texture, &around.inside)?;
        let medium = match &object.interior {
            Some(interior) => Some(self.medium(interior)),
            None => around.medium,
        };
        let mut clips = around.clips.clone();
        for clip in &object.clips {
            let region = match shapes::region(clip, around.frame.affine()) {
                Ok(region) => Some(region),
                Err(LowerErrorKind::Clip(_)) => None,
                Err(other) => return Err(other.at(clip.place.or(object.place))),
            };
            clips.push(Cutter { object: clip, frame: Arc::clone(&around.frame), region });
        }
        let flags = around.flags.or(object.flags);
        let unlent = around.unlent.clone().filter(|_| object.texture.is_none());
        Ok(Context { frame: Arc::clone(&around.frame), texture, unlent, inside, medium, flags, clips })
    }

    fn frame(&self, around: &Context<'_>) -> Arc<Placement> {
        if around.frame.is_identity() { Arc::clone(&self.world) } else { Arc::clone(&around.frame) }
    }

    fn medium(&mut self, interior: &Arc<Interior>) -> u32 {
        self.media.push(Arc::clone(interior));
        (self.media.len() - 1) as u32
    }

    /// The number of a look.
    fn look(
        &mut self,
        (texture, frame): Painted,
        medium: u32,
        flags: Flags,
        inside: Option<LookId>,
    ) -> LookId {
        let frame = if texture.is_uniform() { Arc::clone(&self.world) } else { frame };
        let is_clear = !texture.is_opaque();
        let double_illuminate = flags.double_illuminate;
        self.table.number(Look { texture, frame, medium, double_illuminate, is_clear, inside })
    }

    /// The texture in force and its frame.
    fn texture_of(&self, context: &Context<'_>) -> Painted {
        let default = || (Arc::clone(&self.default_texture), Arc::clone(&self.world));
        context.texture.clone().unwrap_or_else(default)
    }

    /// Lowers an object that is no union, placed in the world by `place`.
    fn leaf(&mut self, object: &Object, place: &Affine, context: Context<'_>) -> Result<(), LowerErrorKind> {
        let (texture, frame) = self.texture_of(&context);
        let is_clear = is_clear(object, &texture) || shows_through(&context.inside);
        // Each clear object without an interior has one of its own all the same: leaving it is
        // leaving it alone.
        let medium = match context.medium {
            Some(medium) => medium,
            None if is_clear => self.medium(&Arc::default()),
            None => 0,
        };
        let flags = context.flags;
        let (mut outside, mut inside) = ((texture, frame), context.inside.clone());
        // What is clipped keeps its normals (see `Target::add_rare`).
        if flags.inverse
            && !context.clips.is_empty()
            && let Some(inside) = &mut inside
        {
            core::mem::swap(&mut outside, inside);
        }
        let primitive = self.looks_of(object, place, outside, &inside, medium, flags)?;
        let mask = if self.is_plain { EVERYTHING } else { mask_of(flags, is_clear) };
        if let Some(mesh) = self.shared.whole(object)
            && context.clips.is_empty()
            && !flags.inverse
        {
            return self.instance(mesh, place, primitive, mask, medium);
        }
        let target = build::Target {
            to: build::To::Scene(&mut self.builder, self.object, primitive, mask),
            clips: context.clips.into_iter().filter_map(|c| c.region).collect(),
            inverse: flags.inverse,
            inside: None,
            camera: self.camera,
        };
        match shapes::build(object, flags.open, place, target)? {
            shapes::Built::Nothing(why) => self.warnings.push((object.place, why)),
            shapes::Built::Done(Some(inside)) => self.around_camera.push((medium, inside)),
            shapes::Built::Done(None) => {}
        }
        Ok(())
    }
}

impl Lowering {
    /// Numbers the primitives of a shape, each with its look; says which is the first.
    fn looks_of(
        &mut self,
        object: &Object,
        place: &Affine,
        texture: Painted,
        inside: &Option<Painted>,
        medium: u32,
        flags: Flags,
    ) -> Result<PrimitiveId, LowerErrorKind> {
        let texture = match &object.shape {
            Shape::Blob(blob) if blob.textures.iter().any(Option::is_some) => {
                (blob_texture::texture(blob, place, &texture)?, Arc::clone(&self.world))
            }
            _ => texture,
        };
        let look = match inside.clone() {
            None => self.look(texture, medium, flags, None),
            Some(inside) => {
                // A fact of the scene language: the corners of a flat triangle go round the other
                // way.
                let (front, back) =
                    if goes_round_backward(object) { (inside, texture) } else { (texture, inside) };
                let back = self.look(back, medium, flags, None);
                self.look(front, medium, flags, Some(back))
            }
        };
        let primitive = self.table.next()?;
        let Shape::Mesh(mesh) = &object.shape else {
            self.table.push(look);
            return Ok(primitive);
        };
        let own_frame = Arc::new(Placement::new(*place));
        let mut own = Vec::with_capacity(mesh.textures.len());
        for texture in &mesh.textures {
            own.push(self.look((Arc::clone(texture), Arc::clone(&own_frame)), medium, flags, None));
        }
        let is_shared = object.clips.is_empty() && self.shared.whole(object).is_some();
        if is_shared && core::ptr::eq(object, self.top) && self.table.same_as_before(mesh, look, own.clone())
        {
            return Ok(primitive);
        }
        for (face, given) in mesh.faces.iter().enumerate() {
            let look = match given.texture {
                None => look,
                Some(texture) => {
                    let count = own.len();
                    let missing = LowerErrorKind::MeshTexture { face, texture, count };
                    *own.get(texture as usize).ok_or(missing)?
                }
            };
            self.table.push(look);
        }
        Ok(primitive)
    }
}

impl LowerErrorKind {
    fn at(self, place: Option<Place>) -> LowerError {
        LowerError { place, kind: self }
    }
}

/// `first`, then `next`.
fn join(first: &Placement, next: &Placement) -> Result<Placement, AffineError> {
    let mut all = first.clone();
    if !next.is_identity() {
        all.then(next.affine())?;
    }
    Ok(all)
}

/// Whether some light may pass a shape of this texture.
fn is_clear(object: &Object, texture: &Texture) -> bool {
    let own = match &object.shape {
        Shape::Mesh(mesh) => mesh.textures.iter().any(|t| !t.is_opaque()),
        Shape::Blob(blob) => blob.textures.iter().flatten().any(|t| !t.is_opaque()),
        _ => false,
    };
    own || !texture.is_opaque()
}

/// Whether some light may pass a texture.
fn shows_through(texture: &Option<Painted>) -> bool {
    texture.as_ref().is_some_and(|(texture, _)| !texture.is_opaque())
}

/// Whether it is made of triangles, has no inside, and its outside is not where the corners go
/// round counterclockwise. Flat triangles are such; of smooth ones the normals tell, those of most
/// faces where they disagree.
fn goes_round_backward(object: &Object) -> bool {
    match &object.shape {
        Shape::Triangle(_) => true,
        Shape::Mesh(mesh) if mesh.inside_vector.is_none() => {
            let forward = mesh.faces.iter().filter(|face| looks_forward(mesh, face)).count();
            2 * forward <= mesh.faces.len()
        }
        _ => false,
    }
}

/// Whether a face is smooth, and its normals look to where its corners go round counterclockwise.
fn looks_forward(mesh: &Mesh, face: &Face) -> bool {
    let Some(normals) = face.normals else { return false };
    let corners = face.vertices.map(|i| mesh.vertices.get(i as usize).copied());
    let [Some(a), Some(b), Some(c)] = corners else { return false };
    let sum =
        normals.iter().filter_map(|&i| mesh.normals.get(i as usize)).fold(Vec3::ZERO, |sum, &n| sum + n);
    (b - a).cross(c - a).dot(sum) > 0.0
}

/// Whether every ray meets the object, and no light passes it.
fn is_plain(object: &Object) -> bool {
    let Flags { no_shadow, no_image, no_reflection, .. } = object.flags;
    let opaque = |t: &Arc<Texture>| t.is_opaque();
    !(no_shadow || no_image || no_reflection)
        && object.texture.iter().chain(&object.interior_texture).chain(&object.cutaway_textures).all(opaque)
        && match &object.shape {
            Shape::Union(parts) | Shape::Csg(_, parts) => parts.iter().all(is_plain),
            Shape::Mesh(mesh) => mesh.textures.iter().all(opaque),
            Shape::Blob(blob) => blob.textures.iter().flatten().all(opaque),
            _ => true,
        }
}

fn mask_of(flags: Flags, is_clear: bool) -> u32 {
    let mut bits = mask::SHAPE;
    if !flags.no_image {
        bits |= mask::CAMERA;
    }
    if !flags.no_reflection {
        bits |= mask::MIRROR;
    }
    if !flags.no_shadow {
        bits |= if is_clear { mask::CLEAR_SHADOW } else { mask::SHADOW };
    }
    bits
}
