//! Lowering: from a scene to the geometry that answers rays, and the look of each surface.
//!
//! Unions are split into their parts, which inherit the look of the union. Every surface gets two
//! numbers: `object` counts the scene's objects in the order of the text, and `primitive` counts
//! the surfaces within the object; each face of a mesh counts.

mod blob_texture;
mod build;
mod camera_media;
mod csg;
mod deformed_surface;
mod fold_transform;
mod level_set;
mod looks;
mod named_quadric;
mod shapes;
mod shared;

use std::sync::Arc;

use durer_geometry::{BuildError, Builder, EVERYTHING, Geometry, ObjectId, PrimitiveId};
use durer_math::{Aabb, Affine, AffineError, Point3, Ray, Vec3};
use durer_surfaces::Side;

use crate::{
    Camera, Chart, ChartKind, Face, FaceTexture, FieldWeights, Fields, Flags, Interior, LatheSpline, Mesh,
    Object, Place, Placement, Scene, Shape, Texture, TextureBody, mask,
};
use camera_media::Enclosure;
use looks::{LookTable, PrimitiveLooks};

pub use looks::{Look, LookId};

/// A scene prepared for rays.
pub struct Lowered {
    /// The geometry that rays hit.
    pub geometry: Geometry,
    /// All looks.
    pub looks: Vec<Look>,
    /// All media. The first is that of opaque objects without an interior of their own.
    pub media: Vec<Arc<Interior>>,
    /// For each medium, whether it fills hollow objects.
    pub hollow: Vec<bool>,
    /// Warnings about the scene. It is rendered nevertheless.
    pub warnings: Vec<(Option<Place>, String)>,
    primitives: PrimitiveLooks,
    around_camera: Vec<(u32, Enclosure)>,
}

/// Why a scene has no geometry, and the place in the text that is to blame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{kind}")]
pub struct LowerError {
    /// Where the object is written in the text.
    pub place: Option<Place>,
    /// What is wrong with it.
    pub kind: LowerErrorKind,
}

/// The error of an object.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LowerErrorKind {
    /// The shape's numbers are invalid.
    #[error("{0}")]
    Shape(String),
    /// The transformation is singular or not finite.
    #[error(transparent)]
    Placement(#[from] AffineError),
    /// The clipping object is not bounded by planes and quadrics.
    #[error(
        "clipped_by: {0} cannot clip: spheres, boxes, cylinders, cones, planes, all quadrics, spherical sectors and their inverses can"
    )]
    Clip(&'static str),
    /// A part of a solid has no inside.
    #[error("{0} has no inside, so it cannot be part of a merge, intersection or difference")]
    Sheet(&'static str),
    /// The object has no formula, so it cannot be deformed.
    #[error(
        "{0} cannot be deformed: spheres, boxes, cylinders, cones, planes, quadrics, tori, polynomials, superellipsoids, blobs, isosurfaces and solids of them can; patches, nurbs, sewn and parametric surfaces by themselves"
    )]
    Deform(&'static str),
    /// A mesh refers to a texture that it does not have.
    #[error("mesh: face {face} refers to texture {texture}, but there are {count}")]
    MeshTexture {
        /// The face.
        face: usize,
        /// The texture it refers to.
        texture: u32,
        /// The number of textures.
        count: usize,
    },
    /// A mesh refers to a normal that it does not have.
    #[error("mesh: face {face} refers to normal {normal}, but there are {count}")]
    MeshNormal {
        /// The face.
        face: usize,
        /// The normal it refers to.
        normal: u32,
        /// The number of normals.
        count: usize,
    },
    /// The textures on a cut would depend on the point.
    #[error("cutaway_textures: {0}")]
    Cutaway(&'static str),
    /// A mesh refers to texture coordinates that it does not have.
    #[error("mesh: face {face} refers to texture coordinates {uv}, but there are {count}")]
    MeshUv {
        /// The face.
        face: usize,
        /// The coordinates it refers to.
        uv: u32,
        /// The number of texture coordinates.
        count: usize,
    },
    /// A pattern has too few entries.
    #[error("texture: a pattern needs at least one entry for each of its kinds")]
    EmptyPattern,
    /// The geometry is too large.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// There are too many primitives to number.
    #[error("scene: at most {} primitives fit", u32::MAX)]
    TooMany,
}

impl Scene {
    /// Builds the geometry, and the look of each of its surfaces.
    ///
    /// Each crossing of an object is one of the solid's own.
    pub fn lower(&self) -> Result<Lowered, LowerError> {
        self.lower_for(Purpose::Queries)
    }

    /// [`Self::lower`] for pictures: a union within a merge, an intersection or a difference keeps
    /// the faces that lie inside its parts, as in POV-Ray. They show through transparent textures.
    pub fn lower_for_pictures(&self) -> Result<Lowered, LowerError> {
        self.lower_for(Purpose::Pictures)
    }

    fn lower_for(&self, purpose: Purpose) -> Result<Lowered, LowerError> {
        let mut lowering = Lowering::new(self, purpose);
        for (number, object) in (0..).zip(&self.objects) {
            lowering.object = ObjectId(number);
            lowering.table.begin().map_err(|kind| kind.at(object.place))?;
            lowering.top = object;
            lowering.common_medium = None;
            lowering.walk(object, &Context::default())?;
            lowering.table.end().map_err(|kind| kind.at(object.place))?;
        }
        lowering.finish()
    }
}

impl Lowered {
    /// The look of an object's primitive; `None` if there is no such primitive.
    #[inline]
    pub fn look_of(&self, object: u32, primitive: u32) -> Option<LookId> {
        self.primitives.of(object, primitive)
    }

    /// Appends the media of all solids inside which a camera ray starts: first those of solids
    /// without bounds, then the others, each in the order of the text. A ray that starts on the surface of a solid and goes into it starts inside.
    pub fn media_of(&self, ray: &Ray, media: &mut Vec<u32>) {
        for (medium, solid) in &self.around_camera {
            if solid.holds_start(ray) {
                media.push(*medium);
            }
        }
    }

    /// The media of all solids that contain a point, in the order of [`Lowered::media_of`]; `None` if the point
    /// lies on the surface of one: then the direction of a ray decides.
    pub fn media_at(&self, point: Point3) -> Option<Vec<u32>> {
        let mut media = Vec::new();
        for (medium, solid) in &self.around_camera {
            match solid.side(point) {
                Side::On => return None,
                Side::In => media.push(*medium),
                Side::Out => {}
            }
        }
        Some(media)
    }

    /// [`Lowered::media_at`] for all points of a box; `None` unless they are certainly in the same
    /// solids.
    pub fn media_in(&self, region: &Aabb) -> Option<Vec<u32>> {
        let mut media = Vec::new();
        for (medium, solid) in &self.around_camera {
            if solid.holds_all(region)? {
                media.push(*medium);
            }
        }
        Some(media)
    }

    /// The number of an object's primitives.
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

/// The properties that an object inherits from the unions around it.
#[derive(Clone, Default)]
struct Context<'s> {
    /// From the space around the object to the world.
    frame: Arc<Placement>,
    texture: Option<Painted>,
    /// If the texture is borrowed from the other parts of an intersection: the texture for parts of
    /// unions, which borrow none.
    unlent: Option<Arc<Texture>>,
    /// The texture seen from inside.
    inside: Option<Painted>,
    medium: Option<u32>,
    flags: Flags,
    /// The objects that clip the unions.
    clips: Vec<Cutter<'s>>,
}

/// An object that clips others.
#[derive(Clone)]
struct Cutter<'s> {
    object: &'s Object,
    /// From the space around the clipping object to the world.
    frame: Arc<Placement>,
    /// The region that it keeps, in the world, if it is bounded by planes and quadrics alone.
    region: Option<durer_surfaces::Region>,
}

/// The use for which the geometry is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// Crossings, spans, sides of points.
    Queries,
    /// Pictures.
    Pictures,
}

/// The state of the lowering.
struct Lowering {
    purpose: Purpose,
    builder: Builder,
    table: LookTable,
    media: Vec<Arc<Interior>>,
    hollow: Vec<bool>,
    /// The medium of all clear parts of the current object of the scene that have no interior.
    common_medium: Option<u32>,
    warnings: Vec<(Option<Place>, String)>,
    around_camera: Vec<(u32, Enclosure)>,
    /// Meshes that several objects share.
    shared: shared::Meshes,
    isosurfaces: shared::Isosurfaces,
    object: ObjectId,
    /// The address of the current object of the scene, for comparisons.
    top: *const Object,
    /// A box that contains the starts of camera rays.
    camera: Aabb,
    default_texture: Arc<Texture>,
    /// The one frame of everything that no union moves. It has one address, because looks are
    /// compared by the address of their frame.
    world: Arc<Placement>,
    /// Whether all objects are opaque and visible to all rays; then they have one mask.
    is_plain: bool,
}

impl Lowering {
    fn new(scene: &Scene, purpose: Purpose) -> Self {
        Self {
            purpose,
            builder: Geometry::builder(),
            table: LookTable::default(),
            media: vec![Arc::default()],
            hollow: vec![false],
            common_medium: None,
            warnings: Vec::new(),
            around_camera: Vec::new(),
            shared: shared::Meshes::of(&scene.objects),
            isosurfaces: shared::Isosurfaces::default(),
            top: core::ptr::null(),
            camera: scene.camera.as_ref().map_or(Aabb::EMPTY, Camera::standpoints),
            object: ObjectId(0),
            default_texture: Arc::default(),
            world: Arc::default(),
            is_plain: scene.objects.iter().all(is_plain),
        }
    }

    fn finish(self) -> Result<Lowered, LowerError> {
        let geometry = self.builder.build().map_err(|e| LowerErrorKind::from(e).at(None))?;
        let (looks, primitives) = self.table.finish();
        // Solids without bounds, such as a sky, enclose the others.
        let (bounded, mut around_camera): (Vec<_>, Vec<_>) =
            self.around_camera.into_iter().partition(|(_, solid)| solid.is_bounded());
        around_camera.extend(bounded);
        Ok(Lowered {
            geometry,
            looks,
            media: self.media,
            hollow: self.hollow,
            warnings: self.warnings,
            primitives,
            around_camera,
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

    /// The properties that an object hands down to its parts: its own, and otherwise those that it
    /// inherits.
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
            Some(interior) => Some(self.medium(interior, around.flags.or(object.flags).hollow)),
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

    /// The medium of a leaf; `given` is that of an interior. A fact of the scene language: all parts
    /// of one object of the scene that have no interior share one, so that a ray in one of them
    /// leaves it where it meets another one. An interior is hollow if its last leaf is.
    fn medium_of(&mut self, given: Option<u32>, needs_one: bool, flags: Flags) -> u32 {
        let medium = match given.or(self.common_medium) {
            Some(medium) => medium,
            None if needs_one => self.medium(&Arc::default(), flags.hollow),
            None => return 0,
        };
        if given.is_none() {
            self.common_medium = Some(medium);
        }
        if let Some(hollow) = self.hollow.get_mut(medium as usize) {
            *hollow = flags.hollow;
        }
        medium
    }

    fn medium(&mut self, interior: &Arc<Interior>, hollow: bool) -> u32 {
        self.media.push(Arc::clone(interior));
        self.hollow.push(hollow);
        (self.media.len() - 1) as u32
    }

    /// The index of a look.
    fn look(
        &mut self,
        (texture, frame): Painted,
        medium: u32,
        flags: Flags,
        inside: Option<LookId>,
        chart: &Option<Arc<Chart>>,
    ) -> LookId {
        let frame = if texture.is_uniform() { Arc::clone(&self.world) } else { frame };
        let is_clear = !texture.is_opaque();
        let chart = chart.clone().filter(|_| texture.needs_chart());
        let Flags { double_illuminate, light_group, .. } = flags;
        let look = Look { texture, frame, medium, double_illuminate, light_group, is_clear, inside, chart };
        self.table.number(look)
    }

    /// The texture that applies, and its frame.
    fn texture_of(&self, context: &Context<'_>) -> Painted {
        let default = || (Arc::clone(&self.default_texture), Arc::clone(&self.world));
        context.texture.clone().unwrap_or_else(default)
    }

    /// Lowers an object that is not a union, placed in the world by `place`.
    fn leaf(&mut self, object: &Object, place: &Affine, context: Context<'_>) -> Result<(), LowerErrorKind> {
        let (texture, frame) = self.texture_of(&context);
        let is_clear = is_clear(object, &texture) || shows_through(&context.inside);
        let flags = context.flags;
        let medium = self.medium_of(context.medium, is_clear || flags.hollow, flags);
        let (mut outside, mut inside) = ((texture, frame), context.inside.clone());
        // A clipped surface keeps its normals (see `Target::add_rare`).
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
            isosurfaces: &mut self.isosurfaces,
        };
        match shapes::build(object, flags.open, place, target)? {
            shapes::Built::Nothing(why) => self.warnings.push((object.place, why)),
            shapes::Built::Done(Some(inside)) => self.around_camera.push((medium, inside)),
            shapes::Built::Done(None) => {}
        }
        Ok(())
    }
}

/// The name of a shape whose texture coordinates in POV-Ray are others than those here.
fn has_other_coordinates(shape: &Shape) -> Option<&'static str> {
    Some(match shape {
        Shape::Lathe(LatheSpline::Linear, _) => return None,
        Shape::Lathe(..) => "lathe with a curved spline",
        Shape::Ovus { .. } => "ovus",
        Shape::Patch(_) | Shape::TriangularPatch(_) => "patch",
        Shape::Parametric(_) => "parametric",
        _ => return None,
    })
}

impl Lowering {
    /// The texture coordinates of a shape, if one of its textures is shown by them.
    fn chart(
        &mut self,
        object: &Object,
        place: &Affine,
        textures: [Option<&Painted>; 2],
        first: PrimitiveId,
    ) -> Option<Arc<Chart>> {
        let own = if let Shape::Mesh(mesh) = &object.shape { &mesh.textures[..] } else { &[] };
        let shown = textures.into_iter().flatten().map(|(texture, _)| texture);
        if !shown.chain(own).any(|texture| texture.needs_chart()) {
            return None;
        }
        let kind = match &object.shape {
            Shape::Sphere { centre, .. } => ChartKind::Sphere(*centre),
            Shape::Box { a, b } => {
                let (a, b) = (a.to_array(), b.to_array());
                let corner =
                    |end: fn(f64, f64) -> f64| Point3::new(end(a[0], b[0]), end(a[1], b[1]), end(a[2], b[2]));
                ChartKind::Box([corner(f64::min), corner(f64::max)])
            }
            Shape::Torus { major, .. } => ChartKind::Torus(*major),
            Shape::Mesh(mesh) => ChartKind::Mesh(Arc::clone(mesh)),
            Shape::Sor(points) => ChartKind::Revolution(Arc::clone(points)),
            Shape::Lathe(LatheSpline::Linear, points) => ChartKind::Lathe(Arc::clone(points)),
            _ => ChartKind::Flat,
        };
        if let Some(name) = has_other_coordinates(&object.shape) {
            let text = format!(
                "uv_mapping of a {name} is not supported yet: its texture is shown by x and y of the world"
            );
            self.warnings.push((object.place, text));
        }
        Some(Arc::new(Chart { kind, placement: Placement::new(*place), first: first.0 }))
    }

    /// Numbers the primitives of a shape, each with its look. Returns the first number.
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
        let primitive = self.table.next()?;
        let chart = self.chart(object, place, [Some(&texture), inside.as_ref()], primitive);
        let look = match inside.clone() {
            None => self.look(texture, medium, flags, None, &chart),
            Some(inside) => {
                // The corners of a flat triangle are in the opposite order (a fact of the scene
                // language).
                let (front, back) =
                    if goes_round_backward(object) { (inside, texture) } else { (texture, inside) };
                let back = self.look(back, medium, flags, None, &chart);
                self.look(front, medium, flags, Some(back), &chart)
            }
        };
        let Shape::Mesh(mesh) = &object.shape else {
            self.table.push(look);
            return Ok(primitive);
        };
        let own_frame = Arc::new(Placement::new(*place));
        let mut own = Vec::with_capacity(mesh.textures.len());
        for texture in &mesh.textures {
            own.push(self.look((Arc::clone(texture), Arc::clone(&own_frame)), medium, flags, None, &chart));
        }
        // A texture of its own for each face with textures at its corners.
        let mixes = mesh.faces.iter().any(|face| matches!(face.texture, Some(FaceTexture::Corners(_))));
        let is_shared = !mixes && object.clips.is_empty() && self.shared.whole(object).is_some();
        if is_shared && core::ptr::eq(object, self.top) && self.table.same_as_before(mesh, look, own.clone())
        {
            return Ok(primitive);
        }
        for (face, given) in mesh.faces.iter().enumerate() {
            let of = |texture: u32| {
                let count = own.len();
                let missing = LowerErrorKind::MeshTexture { face, texture, count };
                own.get(texture as usize).copied().ok_or(missing)
            };
            let look = match given.texture {
                None => look,
                Some(FaceTexture::One(texture)) => of(texture)?,
                Some(FaceTexture::Corners(textures)) => {
                    for texture in textures {
                        of(texture)?;
                    }
                    match corner_texture(mesh, given, textures) {
                        None => of(textures[0])?,
                        Some(mixed) => {
                            let painted = (Arc::new(mixed), Arc::clone(&own_frame));
                            self.look(painted, medium, flags, None, &chart)
                        }
                    }
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

/// The mixture of the textures at a face's corners, in the mesh's own space; `None` if they are the
/// same.
fn corner_texture(mesh: &Mesh, face: &Face, textures: [u32; 3]) -> Option<Texture> {
    let textures = textures.map(|number| &mesh.textures[number as usize]);
    let [first, others @ ..] = textures;
    if others.iter().all(|other| *other == first) {
        return None;
    }
    let corners = face.vertices.map(|i| mesh.vertices.get(i as usize).copied());
    let [Some(a), Some(b), Some(c)] = corners else { return None };
    let fields = Fields {
        placement: Placement::IDENTITY,
        by: FieldWeights::Triangle([a, b, c]),
        textures: textures.map(|texture| Some(Arc::clone(texture))).into(),
        rest: Arc::clone(first),
    };
    let body = TextureBody::Fields(Box::new(fields));
    Some(Texture { body, placement: Placement::IDENTITY, on_chart: false, turn: None })
}

/// The placement `first`, followed by `next`.
fn join(first: &Placement, next: &Placement) -> Result<Placement, AffineError> {
    let mut all = first.clone();
    if !next.is_identity() {
        all.then(next.affine())?;
    }
    Ok(all)
}

/// Whether some light may pass a shape with this texture.
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

/// Whether an object consists of triangles, has no inside, and its outside is the side from which
/// the corners run clockwise. That holds for flat triangles. For smooth ones the normals decide, by
/// the majority of faces.
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

/// Whether a face is smooth and its normals point to the side from which its corners run
/// counterclockwise.
fn looks_forward(mesh: &Mesh, face: &Face) -> bool {
    let Some(normals) = face.normals else { return false };
    let corners = face.vertices.map(|i| mesh.vertices.get(i as usize).copied());
    let [Some(a), Some(b), Some(c)] = corners else { return false };
    let sum =
        normals.iter().filter_map(|&i| mesh.normals.get(i as usize)).fold(Vec3::ZERO, |sum, &n| sum + n);
    (b - a).cross(c - a).dot(sum) > 0.0
}

/// Whether all kinds of rays can hit the object, and no light passes it.
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
