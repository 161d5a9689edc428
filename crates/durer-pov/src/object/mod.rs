//! Objects: shapes with a place, a look and habits.

mod blob;
mod deform;
pub(crate) mod extension;
mod ifs;
mod julia;
mod mesh;
mod modifiers;
mod parametric;
mod patch;
pub(crate) mod queries;
mod shapes;
mod subdivision;
mod sweep;
mod swept;
mod terrain;
mod text;

use std::rc::Rc;

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::light::Light;
use crate::limits::{self, Charge};
use crate::parser::{Item, Parser};
use crate::texture::{Interior, Layer, Texture};
use crate::transform::{Matrix, dot};
use crate::value::Value;
use durer_scene as scene;
use scene::Operation;

/// The shape of an object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    /// A surface as the scene describes it.
    Leaf(scene::Shape),
    /// A mesh or a blob, and the textures that its faces refer to or that its components have.
    Textured(scene::Shape, Rc<[Option<Rc<Texture>>]>),
    /// A box that has no extent along one axis: a rectangle, which has no inside.
    FlatBox {
        a: [f64; 3],
        b: [f64; 3],
    },
    /// An object without a visible point, such as a sphere of radius 0.
    Nothing,
    /// A solid and its warps.
    Deform(Rc<Object>, Rc<[scene::Warp]>),
    Union(Vec<Rc<Object>>),
    Csg(Operation, Vec<Rc<Object>>),
    Light(Rc<Light>),
}

impl From<scene::Shape> for Shape {
    fn from(leaf: scene::Shape) -> Self {
        Self::Leaf(leaf)
    }
}

impl Shape {
    /// The shape with textures. They are dropped if all are `None`.
    fn textured(leaf: scene::Shape, textures: Vec<Option<Rc<Texture>>>) -> Self {
        if textures.iter().all(Option::is_none) {
            Self::Leaf(leaf)
        } else {
            Self::Textured(leaf, textures.into())
        }
    }

    /// The single surface that it is, without its textures.
    pub(crate) fn leaf(&self) -> Option<&scene::Shape> {
        match self {
            Self::Leaf(leaf) | Self::Textured(leaf, _) => Some(leaf),
            _ => None,
        }
    }

    /// The memory of the lists and textures that all copies of it share.
    pub(crate) fn shared_bytes(&self) -> usize {
        use scene::Shape as Leaf;
        let outlines = |all: &[Vec<[f64; 2]>]| all.iter().map(|outline| size_of_val(&outline[..])).sum();
        let textures = match self {
            Self::Textured(_, all) => {
                let layers: usize = all.iter().flatten().map(|texture| texture.size()).sum();
                size_of_val(&all[..]) + layers * size_of::<Layer>()
            }
            _ => 0,
        };
        let numbers = match self.leaf() {
            Some(Leaf::Polygon { loops, .. }) => loops.iter().map(|points| size_of_val(&points[..])).sum(),
            Some(Leaf::Mesh(mesh)) => mesh::bytes(mesh),
            Some(Leaf::Polynomial { coefficients, .. }) => size_of_val(&coefficients[..]),
            Some(Leaf::Prism(prism)) => outlines(&prism.outlines),
            Some(Leaf::StraightSweep(sweep)) => outlines(&sweep.outlines),
            Some(Leaf::SphereSweep(_, spheres)) => size_of_val(&spheres[..]),
            Some(Leaf::Sor(points) | Leaf::Lathe(_, points)) => size_of_val(&points[..]),
            Some(Leaf::Patch(patch)) => size_of_val(&patch.points[..]),
            Some(Leaf::TriangularPatch(patch)) => size_of_val(&patch.points[..]),
            Some(Leaf::Nurbs(data)) => size_of_val(&data.points[..]),
            Some(Leaf::Sewn(data)) => data.surfaces.iter().map(|one| size_of_val(&one.points[..])).sum(),
            Some(Leaf::Subdivision(data)) => subdivision::bytes(data),
            Some(Leaf::Blob(blob)) => size_of_val(&blob.components[..]),
            Some(Leaf::HeightField(field)) => field.bytes(),
            _ => 0,
        };
        numbers + textures
    }
}

/// Habits; on a union they hold for every part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Habits {
    pub(crate) no_shadow: bool,
    pub(crate) no_image: bool,
    pub(crate) no_reflection: bool,
    pub(crate) hollow: bool,
    pub(crate) inverse: bool,
    pub(crate) open: bool,
    pub(crate) double_illuminate: bool,
    /// Whether it is a light group, and if so whether lights outside it light its objects.
    pub(crate) light_group: Option<bool>,
}

/// A shape with its place and its look.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Object {
    pub(crate) shape: Shape,
    /// The map from the shape's own frame to that of the block around.
    pub(crate) place: Matrix,
    pub(crate) texture: Option<Rc<Texture>>,
    /// The texture of the inside.
    pub(crate) interior_texture: Option<Rc<Texture>>,
    /// Whether its parts share their textures on cuts.
    pub(crate) cutaway_textures: bool,
    pub(crate) interior: Option<Rc<Interior>>,
    pub(crate) clips: Vec<Rc<Self>>,
    pub(crate) bounds: Vec<Rc<Self>>,
    pub(crate) habits: Habits,
    /// Its place in the text.
    pub(crate) at: Place,
    /// The nesting depth of unions, this one included.
    depth: u32,
    /// The number of surfaces in it.
    pub(crate) leaves: u64,
    /// Whether it, a part of it or one of its clips is [`Shape::FlatBox`] or [`Shape::Nothing`].
    pub(crate) lacks_volume: bool,
    charge: Charge,
    /// The charge for data that all copies of the shape share.
    pub(crate) shared: Option<Rc<Charge>>,
}

/// The largest nesting depth of unions, also by names: the steps after the reader visit them
/// recursively.
const DEEPEST: u32 = 256;

impl Object {
    pub(crate) fn new(shape: Shape, at: Place) -> Self {
        let (depth, leaves, extra) = match &shape {
            Shape::Union(parts) | Shape::Csg(_, parts) => {
                let depth = parts.iter().map(|part| part.depth).max().unwrap_or(0);
                let leaves = parts.iter().fold(0_u64, |sum, part| sum.saturating_add(part.leaves));
                (depth + 1, leaves, parts.len() * 8)
            }
            Shape::Deform(solid, _) => (solid.depth + 1, solid.leaves, 8),
            Shape::Light(light) => (1, light.looks_like.as_ref().map_or(0, |shown| shown.leaves), 200),
            _ => (1, 1, 0),
        };
        let lacks_volume = match &shape {
            Shape::FlatBox { .. } | Shape::Nothing => true,
            Shape::Union(parts) | Shape::Csg(_, parts) => parts.iter().any(|part| part.lacks_volume),
            _ => false,
        };
        let shared = Some(shape.shared_bytes()).filter(|bytes| *bytes > 0);
        Self {
            shape,
            place: Matrix::IDENTITY,
            texture: None,
            interior_texture: None,
            cutaway_textures: false,
            interior: None,
            clips: Vec::new(),
            bounds: Vec::new(),
            habits: Habits::default(),
            at,
            depth,
            leaves,
            lacks_volume,
            charge: Charge::new(size_of::<Self>() + extra),
            shared: shared.map(|bytes| Rc::new(Charge::new(bytes))),
        }
    }

    /// Moves the object with all it has so far.
    pub(crate) fn transform(&mut self, by: &Matrix) {
        self.place = self.place.then(by);
        Parser::move_texture(&mut self.texture, by);
        Parser::move_texture(&mut self.interior_texture, by);
        for part in self.clips.iter_mut().chain(&mut self.bounds) {
            Rc::make_mut(part).transform(by);
        }
    }

    /// Whether it or something in it shines.
    fn holds_light(&self) -> bool {
        match &self.shape {
            Shape::Light(_) => true,
            // A light group's lights light its objects wherever these stand.
            Shape::Union(parts) if self.habits.light_group.is_none() => {
                parts.iter().any(|part| part.holds_light())
            }
            _ => false,
        }
    }

    /// Counts the parts that were added to it.
    fn recount(&mut self) {
        let parts = self.clips.iter().chain(&self.bounds);
        let deepest = parts.clone().map(|part| part.depth + 1).max().unwrap_or(0);
        self.depth = self.depth.max(deepest);
        self.lacks_volume |= self.clips.iter().any(|clip| clip.lacks_volume);
        let textures = self.texture.iter().chain(&self.interior_texture);
        let texture = textures.map(|texture| texture.size() * size_of::<Layer>()).sum::<usize>();
        let own = match &self.shape {
            Shape::Union(parts) | Shape::Csg(_, parts) => parts.len(),
            _ => 0,
        };
        let parts = parts.count() + own;
        self.charge.resize(size_of::<Self>() + parts * size_of::<Self>() + texture);
    }
}

/// Whether `keyword` begins an object that durer reads.
pub(crate) fn begins_object(keyword: Keyword) -> bool {
    use Keyword::*;
    matches!(
        keyword,
        Sphere
            | Box
            | Cylinder
            | Cone
            | Plane
            | Disc
            | Triangle
            | SmoothTriangle
            | Polygon
            | Mesh
            | Mesh2
            | Quadric
            | Isosurface
            | Superellipsoid
            | Blob
            | JuliaFractal
            | HeightField
            | Torus
            | Prism
            | Text
            | SphereSweep
            | Sor
            | Lathe
            | BicubicPatch
            | Parametric
            | Ovus
            | Cubic
            | Quartic
            | Poly
            | Polynomial
            | Union
            | Merge
            | Intersection
            | Difference
            | Object
            | LightSource
            | LightGroup
    )
}

impl Parser<'_> {
    /// Whether an object comes next.
    pub(crate) fn starts_object(&mut self) -> Result<bool> {
        Ok(match self.peek()? {
            Item::Word(keyword) => begins_object(*keyword),
            Item::Value(Value::Object(_)) => true,
            Item::Unknown(_) => self.at_extension()?,
            _ => false,
        })
    }

    /// An object: a word with its block, or a name.
    pub(crate) fn object(&mut self) -> Result<Rc<Object>> {
        self.nested(|r| {
            let lexeme = r.next()?;
            let place = lexeme.place;
            let mut object = match &lexeme.item {
                Item::Value(Value::Object(known)) => return Ok(known.clone()),
                Item::Word(Keyword::LightSource) => return r.light_block().map(Rc::new),
                Item::Word(Keyword::Object) => {
                    r.expect(Mark::BraceOpen)?;
                    let inner = r.object()?;
                    let mut inner = (*inner).clone();
                    inner.at = place;
                    inner
                }
                Item::Word(Keyword::Union) => match r.parts("union", place)? {
                    none if none.is_empty() => Object::new(Shape::Nothing, place),
                    parts => Object::new(Shape::Union(parts), place),
                },
                Item::Word(Keyword::LightGroup) => {
                    let parts = r.parts("light_group", place)?;
                    let mut group = Object::new(Shape::Union(parts), place);
                    group.habits.light_group = Some(false);
                    group
                }
                Item::Word(Keyword::Merge) => r.combined(Operation::Merge, place)?,
                Item::Word(Keyword::Intersection) => r.combined(Operation::Intersection, place)?,
                Item::Word(Keyword::Difference) => r.combined(Operation::Difference, place)?,
                Item::Word(keyword) if begins_object(*keyword) => {
                    r.expect(Mark::BraceOpen)?;
                    match r.copied(place)? {
                        Some(known) => known,
                        None if *keyword == Keyword::Isosurface => r.isosurface(place)?,
                        None => Object::new(r.shape(*keyword, place)?, place),
                    }
                }
                Item::Unknown(name) => match r.extension(*name) {
                    Some(extension::Word::Deform) => Object::new(r.deform(place)?, place),
                    Some(word) => {
                        r.expect(Mark::BraceOpen)?;
                        match r.copied(place)? {
                            Some(known) => known,
                            None => Object::new(r.extension_shape(word, place)?, place),
                        }
                    }
                    None => return Err(r.unexpected(&lexeme, "an object")),
                },
                _ => return Err(r.unexpected(&lexeme, "an object")),
            };
            r.modifiers(&mut object)?;
            object.recount();
            if object.depth > DEEPEST {
                return Err(limits::exceeded(
                    place,
                    "nesting",
                    u64::from(DEEPEST),
                    "too many objects inside each other (this one cannot be raised)",
                ));
            }
            r.check_memory(0, place)?;
            Ok(Rc::new(object))
        })
    }

    /// The object whose name stands first in a block, to be changed by what follows.
    fn copied(&mut self, place: Place) -> Result<Option<Object>> {
        let Item::Value(Value::Object(known)) = self.peek()? else { return Ok(None) };
        let mut known = (**known).clone();
        known.at = place;
        self.next()?;
        Ok(Some(known))
    }

    /// A merge, intersection or difference.
    fn combined(&mut self, operation: Operation, place: Place) -> Result<Object> {
        let what = match operation {
            Operation::Merge => "merge",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
        };
        let parts = self.parts(what, place)?;
        if parts.is_empty() {
            return Ok(Object::new(Shape::Nothing, place));
        }
        if let Some(light) = parts.iter().find(|part| part.holds_light()) {
            return Err(Error::invalid(
                light.at,
                format!(
                    "a light source cannot be part of this {what}: only a union can contain light sources"
                ),
            ));
        }
        let mut solids = Vec::with_capacity(parts.len());
        for part in parts {
            solids.extend(self.as_solid(part, operation)?);
        }
        if solids.is_empty() {
            return Ok(Object::new(Shape::Nothing, place));
        }
        Ok(Object::new(Shape::Csg(operation, solids), place))
    }

    /// Replaces a part that is no solid. A disc without a hole becomes its plane, because the
    /// inside of a disc is all that lies behind it (a fact of the scene language). A merge leaves
    /// out a box without thickness.
    fn as_solid(&mut self, part: Rc<Object>, operation: Operation) -> Result<Option<Rc<Object>>> {
        match &part.shape {
            &Shape::Leaf(scene::Shape::Disc { centre, normal, hole: 0.0, .. }) => {
                self.note_left_out("the border of a disc in a solid", part.at)?;
                let [from, across] = [centre.to_array(), normal.to_array()];
                let distance = dot(from, across) / dot(across, across).sqrt();
                let mut plane = (*part).clone();
                plane.shape = scene::Shape::Plane { normal, distance }.into();
                Ok(Some(Rc::new(plane)))
            }
            Shape::FlatBox { .. } if operation == Operation::Merge => {
                self.note_left_out("a box without thickness in a merge", part.at)?;
                Ok(None)
            }
            _ => Ok(Some(part)),
        }
    }

    /// The objects of a union or of another combination, after its word. A block without any is
    /// read, with a warning.
    fn parts(&mut self, what: &str, place: Place) -> Result<Vec<Rc<Object>>> {
        self.expect(Mark::BraceOpen)?;
        let mut parts = Vec::new();
        while self.starts_object()? {
            parts.push(self.object()?);
            self.check_memory(parts.len() * 8, place)?;
        }
        if parts.is_empty() {
            let lexeme = self.next()?;
            // Modifiers may follow, anything else is taken for a part that is not understood.
            match lexeme.item {
                Item::Word(keyword) if !crate::unsupported::is_unsupported(keyword) => {}
                Item::Mark(Mark::BraceClose) => {}
                _ => return Err(self.unexpected(&lexeme, &format!("the first object of the {what}"))),
            }
            self.put_back(lexeme);
            self.notice(place, format!("this {what} has no objects"));
        }
        Ok(parts)
    }

    /// `{ object }`.
    pub(crate) fn object_in_braces(&mut self) -> Result<Rc<Object>> {
        self.expect(Mark::BraceOpen)?;
        let object = self.object()?;
        self.expect(Mark::BraceClose)?;
        Ok(object)
    }

    /// An object as a value.
    pub(crate) fn object_value(&mut self) -> Result<Value> {
        if self.starts_object()? {
            return Ok(Value::Object(self.object()?));
        }
        let lexeme = self.next()?;
        Err(self.unexpected(&lexeme, "a value"))
    }

    /// A length that must not be zero; a negative one is taken without its sign, as POV-Ray does.
    pub(crate) fn radius(&mut self, what: &str) -> Result<f64> {
        self.peek()?;
        let place = self.here();
        let radius = self.size()?;
        if radius == 0.0 {
            return Err(Error::invalid(place, format!("{what} is zero")));
        }
        Ok(radius)
    }

    /// A length; a negative one is taken without its sign, as POV-Ray does.
    pub(crate) fn size(&mut self) -> Result<f64> {
        Ok(self.float()?.abs())
    }

    /// The shape of an object that shows nothing, as in POV-Ray, and a warning that says so.
    pub(crate) fn nothing(&mut self, why: &str, place: Place) -> Shape {
        self.notice(place, format!("{why}: the object is not visible"));
        Shape::Nothing
    }
}
