//! Textures: the look of a surface at each of its points.

use std::sync::Arc;

use durer_math::{Affine, AffineError, Point3};
use durer_surfaces::Blob;

use crate::{Colour, Finish, ImageMap, Normal, Pattern, Placement, PointWarp, Rgb};

/// The look of a surface: layers, or a pattern of textures.
///
/// Its placement leads from the pattern's space to the space in which the object stands *after* the
/// object's own placement. So a transformation written after the texture moves both, and one
/// written before it moves the object alone. Textures inside a pattern are placed in the pattern's
/// space.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The layers, or the pattern.
    pub body: TextureBody,
    /// The placement of the texture.
    pub placement: Placement,
    /// Whether its pattern is shown by the surface's texture coordinates `(u, v, 0)` in place of the
    /// point. Then only its own placement counts.
    pub on_chart: bool,
    /// If it is shown by texture coordinates: the placement by which the perturbations of normals in
    /// its pattern are turned, if that is not its own placement.
    pub turn: Option<Placement>,
}

/// The contents of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureBody {
    /// Layers from the innermost to the outermost; at least one.
    Layers(Vec<Layer>),
    /// Other textures, selected or mixed by a pattern.
    Pattern(Box<Pattern<Arc<Texture>>>),
    /// Other textures, mixed by weights that change from point to point.
    Fields(Box<Fields>),
}

/// Textures that are mixed by weights. At each point it is the mean of the textures whose weights
/// are not zero there.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// From the space of the weights to that of the texture.
    pub placement: Placement,
    /// The weights.
    pub by: FieldWeights,
    /// The texture of each component or corner, placed in the space of the weights.
    pub textures: Vec<Option<Arc<Texture>>>,
    /// The texture of components without one of their own, placed in the space of the texture.
    pub rest: Arc<Texture>,
}

/// The weights of textures at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldWeights {
    /// The magnitudes of the fields of a blob's components.
    Blob(Blob),
    /// The barycentric coordinates in a triangle with these corners.
    Triangle([Point3; 3]),
}

impl Fields {
    /// All textures.
    fn all(&self) -> impl Iterator<Item = &Texture> {
        self.textures.iter().flatten().chain([&self.rest]).map(|texture| &**texture)
    }
}

/// A layer of a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its colour at each point.
    pub pigment: Pigment,
    /// How it reflects and scatters light.
    pub finish: Arc<Finish>,
    /// How the surface's normals are perturbed, if they are.
    pub normal: Option<Arc<Normal>>,
}

impl Texture {
    /// Makes a texture of a single layer.
    pub fn plain(pigment: Pigment, finish: impl Into<Arc<Finish>>) -> Self {
        Self::layers(vec![Layer { pigment, finish: finish.into(), normal: None }])
    }

    /// Makes a texture of several layers, from the innermost to the outermost.
    pub fn layers(layers: Vec<Layer>) -> Self {
        Self {
            body: TextureBody::Layers(layers),
            placement: Placement::IDENTITY,
            on_chart: false,
            turn: None,
        }
    }

    /// Makes a texture of other textures, selected or mixed by a pattern.
    pub fn pattern(pattern: Pattern<Arc<Texture>>) -> Self {
        Self {
            body: TextureBody::Pattern(Box::new(pattern)),
            placement: Placement::IDENTITY,
            on_chart: false,
            turn: None,
        }
    }

    /// Transforms the texture by `map`.
    pub fn transform(&mut self, map: &Affine) -> Result<(), AffineError> {
        if let Some(turn) = &mut self.turn {
            turn.then(map)?;
        }
        self.placement.then(map)
    }

    /// Whether no light passes anywhere. Layers are opaque if one of them is opaque everywhere.
    pub fn is_opaque(&self) -> bool {
        match &self.body {
            TextureBody::Layers(layers) => layers.iter().any(|l| l.pigment.is_opaque()),
            TextureBody::Pattern(pattern) => pattern.entries().all(|t| t.is_opaque()),
            TextureBody::Fields(fields) => fields.all().all(Self::is_opaque),
        }
    }

    /// Whether a pattern in it has fewer entries than kinds.
    pub fn has_empty_pattern(&self) -> bool {
        match &self.body {
            TextureBody::Layers(layers) => layers.iter().any(|l| l.pigment.has_empty_pattern()),
            TextureBody::Pattern(p) => p.lacks_entries() || p.entries().any(|t| t.has_empty_pattern()),
            TextureBody::Fields(fields) => fields.all().any(Self::has_empty_pattern),
        }
    }

    /// Whether anything in it is shown by texture coordinates.
    pub fn needs_chart(&self) -> bool {
        let of_layer = |l: &Layer| {
            l.pigment.needs_chart() || l.normal.as_ref().is_some_and(|normal| normal.needs_chart())
        };
        self.on_chart
            || match &self.body {
                TextureBody::Layers(layers) => layers.iter().any(of_layer),
                TextureBody::Pattern(pattern) => pattern.entries().any(|t| t.needs_chart()),
                TextureBody::Fields(fields) => fields.all().any(Self::needs_chart),
            }
    }

    /// Whether it looks the same everywhere, so that moving it has no effect.
    pub fn is_uniform(&self) -> bool {
        match &self.body {
            TextureBody::Layers(layers) => {
                layers.iter().all(|l| l.normal.is_none() && matches!(l.pigment.body, PigmentBody::Solid(_)))
            }
            TextureBody::Pattern(_) | TextureBody::Fields(_) => false,
        }
    }
}

impl Default for Texture {
    /// A black layer with the default finish.
    fn default() -> Self {
        Self::plain(Pigment::default(), Finish::default())
    }
}

/// A colour at each point of space.
#[derive(Clone, Debug, PartialEq)]
pub struct Pigment {
    /// The colours.
    pub body: PigmentBody,
    /// From the pigment's space to that of the texture (or pigment) around it.
    pub placement: Placement,
    /// Whether it is shown by the surface's texture coordinates `(u, v, 0)` in place of the point.
    /// Then only its own placement counts.
    pub on_chart: bool,
}

/// The contents of a pigment.
#[derive(Clone, Debug, PartialEq)]
pub enum PigmentBody {
    /// One colour.
    Solid(Colour),
    /// Colours, selected or mixed by a pattern.
    Colours(Box<Pattern<Colour>>),
    /// Other pigments, selected or mixed by a pattern; a map mixes their colours. They are placed
    /// in this pigment's space.
    Pigments(Box<Pattern<Pigment>>),
    /// A picture, seen through maps of the point, in the order in which they are applied.
    Image(Vec<PointWarp>, Arc<ImageMap>),
}

impl Pigment {
    /// Makes a pigment with one colour everywhere.
    pub fn solid(colour: Colour) -> Self {
        Self { body: PigmentBody::Solid(colour), placement: Placement::IDENTITY, on_chart: false }
    }

    /// Makes a pigment of colours, selected or mixed by a pattern.
    pub fn colours(pattern: Pattern<Colour>) -> Self {
        Self {
            body: PigmentBody::Colours(Box::new(pattern)),
            placement: Placement::IDENTITY,
            on_chart: false,
        }
    }

    /// Makes a pigment of other pigments, selected or mixed by a pattern.
    pub fn pigments(pattern: Pattern<Pigment>) -> Self {
        Self {
            body: PigmentBody::Pigments(Box::new(pattern)),
            placement: Placement::IDENTITY,
            on_chart: false,
        }
    }

    /// Whether no light passes anywhere.
    pub fn is_opaque(&self) -> bool {
        let opaque = |c: &Colour| c.filter == 0.0 && c.transmit == 0.0;
        match &self.body {
            PigmentBody::Solid(colour) => opaque(colour),
            PigmentBody::Colours(pattern) => pattern.entries().all(opaque),
            PigmentBody::Pigments(pattern) => pattern.entries().all(Self::is_opaque),
            PigmentBody::Image(_, map) => !map.once && map.image.is_opaque(),
        }
    }

    /// Whether anything in it is shown by texture coordinates.
    fn needs_chart(&self) -> bool {
        self.on_chart
            || match &self.body {
                PigmentBody::Pigments(pattern) => pattern.entries().any(Self::needs_chart),
                PigmentBody::Solid(_) | PigmentBody::Colours(_) | PigmentBody::Image(..) => false,
            }
    }

    /// Whether a pattern in it has fewer entries than kinds.
    fn has_empty_pattern(&self) -> bool {
        match &self.body {
            PigmentBody::Solid(_) | PigmentBody::Image(..) => false,
            PigmentBody::Colours(pattern) => pattern.lacks_entries(),
            PigmentBody::Pigments(p) => p.lacks_entries() || p.entries().any(Self::has_empty_pattern),
        }
    }

    /// Transforms the pigment by `map`.
    pub fn transform(&mut self, map: &Affine) -> Result<(), AffineError> {
        self.placement.then(map)
    }
}

impl Default for Pigment {
    /// Opaque black.
    fn default() -> Self {
        Self::solid(Colour::opaque(Rgb::BLACK))
    }
}
