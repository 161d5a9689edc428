//! Cameras: four vectors and a location, whatever the form of the block.

use std::rc::Rc;
use std::sync::Arc;

use durer_math::elementary;

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lens::Lens;
use crate::lexer::Mark;
use crate::mesh_camera::CameraMeshes;
use crate::parser::{Item, Parser};
use crate::scene_builder::{point, vector};
use crate::texture::Normal;
use crate::transform::{Matrix, cross, dot, length};
use crate::value::Value;

/// How the rays of a camera start.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Projection {
    #[default]
    Perspective,
    Orthographic,
    Fisheye,
    UltraWideAngle,
    Omnimax,
    Panoramic,
    Spherical,
    /// One of the four kinds.
    Cylinder(u8),
    /// From the faces of meshes.
    Mesh(Rc<CameraMeshes>),
}

/// A finished camera. Rays start at `location` along `direction + u right + v up` (perspective), or
/// at `location + u right + v up` along `direction` (orthographic), with u and v from -1/2 to 1/2.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Camera {
    pub(crate) projection: Projection,
    pub(crate) location: [f64; 3],
    pub(crate) direction: [f64; 3],
    pub(crate) right: [f64; 3],
    pub(crate) up: [f64; 3],
    pub(crate) sky: [f64; 3],
    /// The last `look_at` point; transformations do not change it.
    look_at: [f64; 3],
    /// The angles in degrees that the text gives: the horizontal one, and the vertical one.
    pub(crate) angles: [Option<f64>; 2],
    pub(crate) lens: Lens,
    /// The distance of the plane of focus; transformations do not change it.
    focus: f64,
    pub(crate) normal: Option<(Rc<Normal>, Place)>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            projection: Projection::Perspective,
            location: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
            right: [1.33, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            sky: [0.0, 1.0, 0.0],
            look_at: [0.0, 0.0, 1.0],
            angles: [None; 2],
            lens: Lens::default(),
            focus: 0.0,
            normal: None,
        }
    }
}

/// One item of the block, stored to be applied later.
#[derive(Clone, Copy, Debug)]
enum Setting {
    Right([f64; 3]),
    Direction([f64; 3]),
    Angle(f64, Place),
    Up([f64; 3]),
    Sky([f64; 3]),
    Location([f64; 3]),
    LookAt([f64; 3], Place),
    /// `orthographic`, in old scenes only.
    Orthographic,
}

impl Setting {
    /// The order in which scenes of version 3.5 and later apply items.
    fn rank(&self) -> u8 {
        match self {
            Self::Right(_) => 0,
            Self::Direction(_) => 1,
            Self::Angle(..) => 2,
            Self::Up(_) => 3,
            Self::Sky(_) => 4,
            Self::Location(_) => 5,
            Self::LookAt(..) => 6,
            Self::Orthographic => 7,
        }
    }
}

fn scaled(v: [f64; 3], by: f64) -> [f64; 3] {
    v.map(|part| part * by)
}

impl Camera {
    /// The camera as data of the scene.
    pub(crate) fn scene(&self) -> Result<durer_scene::Camera> {
        let normal = match &self.normal {
            Some((own, at)) => crate::normal_builder::normal(own, *at)?.map(Arc::new),
            None => None,
        };
        Ok(durer_scene::Camera {
            projection: self.projection()?,
            location: point(self.location),
            direction: vector(self.direction),
            right: vector(self.right),
            up: vector(self.up),
            lens: self.lens.scene(self.focus)?,
            normal,
        })
    }

    /// The projection as data of the scene.
    fn projection(&self) -> Result<durer_scene::Projection> {
        use durer_scene::Projection as To;
        let angle = |absent: f64| self.angles[0].unwrap_or(absent).to_radians();
        Ok(match &self.projection {
            Projection::Perspective => To::Perspective,
            Projection::Orthographic => To::Orthographic,
            Projection::Fisheye => To::Fisheye(angle(90.0)),
            Projection::UltraWideAngle => To::UltraWideAngle(angle(90.0)),
            Projection::Omnimax => To::Omnimax,
            Projection::Panoramic => To::Panoramic,
            Projection::Spherical => {
                let wide = angle(360.0);
                To::Spherical(wide, self.angles[1].map_or(wide * 0.5, f64::to_radians))
            }
            Projection::Cylinder(kind) => {
                To::Cylinder { angle: angle(90.0), vertical: kind % 2 == 1, moving: *kind > 2 }
            }
            Projection::Mesh(meshes) => To::Mesh(Arc::new(meshes.scene()?)),
        })
    }

    /// The distance of the plane of focus for a focal point: that of the point itself (a fact of the
    /// scene language).
    fn distance_to(&self, target: [f64; 3]) -> f64 {
        length(std::array::from_fn(|i| target[i] - self.location[i]))
    }

    fn transform(&mut self, by: &Matrix) {
        self.location = by.point(self.location);
        for vector in [&mut self.direction, &mut self.right, &mut self.up, &mut self.sky] {
            *vector = by.direction(*vector);
        }
    }

    /// Sizes the orthographic picture so that it shows the same at `look_at` as the perspective one.
    fn size_as_at_look_at(&mut self) {
        let away = std::array::from_fn(|i| self.look_at[i] - self.location[i]);
        let by = length(away) / length(self.direction);
        self.right = scaled(self.right, by);
        self.up = scaled(self.up, by);
    }

    /// Applies `angle`: the horizontal angle of view determines the length of `direction`.
    fn set_angle(&mut self, degrees: f64) {
        let half = elementary::tan(degrees.to_radians() / 2.0);
        let wanted = length(self.right) / (2.0 * half);
        let now = length(self.direction);
        if now > 0.0 {
            self.direction = scaled(self.direction, wanted / now);
        }
    }

    /// Applies `look_at`: turns everything towards `target`; lengths and handedness are kept.
    fn look_at(&mut self, target: [f64; 3]) -> std::result::Result<(), &'static str> {
        let towards: [f64; 3] = std::array::from_fn(|i| target[i] - self.location[i]);
        let distance = length(towards);
        if distance == 0.0 {
            return Err("the camera looks at its own location");
        }
        let (long, wide, high) = (length(self.direction), length(self.right), length(self.up));
        // As in POV-Ray, an `up` parallel to the direction also counts as a mirrored camera.
        let hand = if dot(cross(self.up, self.direction), self.right) > 0.0 { 1.0 } else { -1.0 };
        self.direction = scaled(towards, long / distance);
        let side = cross(self.sky, self.direction);
        let side_length = length(side);
        // As in POV-Ray, a camera that looks along its sky keeps its right vector, a mirrored one
        // the opposite one. It need not be perpendicular to the direction: then `up` is shorter.
        let looks_along_sky = side_length == 0.0;
        self.right =
            if looks_along_sky { scaled(self.right, hand) } else { scaled(side, hand * wide / side_length) };
        let upward = cross(self.direction, self.right);
        let upward_length = if looks_along_sky { long * wide } else { length(upward) };
        if length(upward) == 0.0 {
            return Err("the camera looks along its own right vector");
        }
        // For a mirrored camera the cross product points down.
        self.up = scaled(upward, hand * high / upward_length);
        self.look_at = target;
        Ok(())
    }
}

impl Parser<'_> {
    /// Reads what stands in braces after `camera`.
    pub(crate) fn camera_block(&mut self) -> Result<Camera> {
        let begin = self.here();
        self.expect(Mark::BraceOpen)?;
        let known = match self.peek()? {
            Item::Value(Value::Camera(known)) => Some((**known).clone()),
            _ => None,
        };
        if known.is_some() {
            self.next()?;
        }
        // Only in old scenes may a declared camera be changed in more than its placement.
        let is_whole = known.is_some() && !self.applies_in_written_order();
        let mut camera = known.unwrap_or_else(|| match &self.scene.camera {
            Some(before) if self.applies_in_written_order() => before.clone(),
            _ => self.default_camera.clone(),
        });
        let mut settings = Vec::new();
        let mut moves = Vec::new();
        loop {
            if let Some(by) = self.transform_item()? {
                moves.push(by);
                continue;
            }
            let lexeme = self.next()?;
            let place = lexeme.place;
            settings.push(match &lexeme.item {
                Item::Mark(Mark::BraceClose) => break,
                _ if is_whole => return Err(self.unexpected(&lexeme, "a transform of the camera, or `}`")),
                Item::Word(Keyword::Perspective) => {
                    camera.projection = Projection::Perspective;
                    continue;
                }
                Item::Word(Keyword::Orthographic) => {
                    camera.projection = Projection::Orthographic;
                    if !self.applies_in_written_order() {
                        continue;
                    }
                    Setting::Orthographic
                }
                Item::Word(Keyword::Fisheye) => {
                    camera.projection = Projection::Fisheye;
                    continue;
                }
                Item::Word(Keyword::UltraWideAngle) => {
                    camera.projection = Projection::UltraWideAngle;
                    continue;
                }
                Item::Word(Keyword::Omnimax) => {
                    camera.projection = Projection::Omnimax;
                    continue;
                }
                Item::Word(Keyword::MeshCamera) => {
                    camera.projection = Projection::Mesh(Rc::new(self.nested(Self::mesh_camera)?));
                    continue;
                }
                Item::Word(Keyword::Panoramic) => {
                    camera.projection = Projection::Panoramic;
                    continue;
                }
                Item::Word(Keyword::Spherical) => {
                    camera.projection = Projection::Spherical;
                    continue;
                }
                Item::Word(Keyword::Cylinder) => {
                    let kind = self.float()?;
                    if !(1.0..5.0).contains(&kind) {
                        let text = format!("a camera's cylinder is of the kind 1 to 4, not {kind}");
                        return Err(Error::invalid(place, text));
                    }
                    camera.projection = Projection::Cylinder(kind as u8);
                    continue;
                }
                Item::Word(Keyword::Normal) => {
                    let normal = self.nested(|r| r.normal_block(&Normal::default()))?;
                    camera.normal = Some((Rc::new(normal), place));
                    continue;
                }
                Item::Word(keyword) if self.lens_item(*keyword, &mut camera.lens, place)? => continue,
                Item::Word(Keyword::Right) => Setting::Right(self.axis("right")?),
                Item::Word(Keyword::Up) => Setting::Up(self.axis("up")?),
                Item::Word(Keyword::Direction) => Setting::Direction(self.axis("direction")?),
                Item::Word(Keyword::Sky) => Setting::Sky(self.axis("sky")?),
                Item::Word(Keyword::Location) => Setting::Location(self.vector()?),
                Item::Word(Keyword::LookAt) => Setting::LookAt(self.vector()?, place),
                Item::Word(Keyword::Angle) => {
                    // A word without a number means 0.
                    let angle = self.float_or(0.0)?;
                    let vertical = if self.take_mark(Mark::Comma)? || self.starts_number()? {
                        Some(self.float()?)
                    } else {
                        None
                    };
                    camera.angles = [Some(angle).filter(|angle| *angle > 0.0), vertical];
                    Setting::Angle(angle, place)
                }
                _ => return Err(self.unexpected(&lexeme, "a part of a camera")),
            });
            self.skip_comma()?;
        }
        if !is_whole {
            if !self.applies_in_written_order() {
                settings.sort_by_key(Setting::rank);
            }
            self.apply(&mut camera, &settings)?;
        }
        if !is_whole {
            camera.focus = camera.distance_to(camera.lens.focal_point);
        }
        for by in &moves {
            camera.transform(by);
        }
        let volume = dot(cross(camera.direction, camera.up), camera.right);
        let is_flat = volume == 0.0 || !volume.is_finite();
        // The vectors of a mesh camera have no meaning.
        if is_flat && !matches!(camera.projection, Projection::Mesh(_)) {
            let text = "the camera's direction, up and right do not span space";
            return Err(Error::invalid(begin, text));
        }
        Ok(camera)
    }

    /// Whether a camera's items are applied in the order in which they are written.
    fn applies_in_written_order(&self) -> bool {
        self.language.version < 3.5
    }

    fn axis(&mut self, name: &str) -> Result<[f64; 3]> {
        let place = self.here();
        let v = self.vector()?;
        if length(v) == 0.0 {
            return Err(Error::invalid(place, format!("the camera's {name} has no length")));
        }
        Ok(v)
    }

    fn apply(&self, camera: &mut Camera, settings: &[Setting]) -> Result<()> {
        let (mut sized, mut angled) = (false, false);
        let is_flat = matches!(camera.projection, Projection::Perspective | Projection::Orthographic);
        for setting in settings {
            match *setting {
                Setting::Right(v) => (camera.right, sized) = (v, true),
                Setting::Up(v) => (camera.up, sized) = (v, true),
                Setting::Direction(v) => camera.direction = v,
                Setting::Sky(v) => camera.sky = v,
                Setting::Location(v) => camera.location = v,
                // Elsewhere the angle is not that of a plane picture.
                Setting::Angle(..) if !is_flat => {}
                Setting::Angle(degrees, place) => {
                    if !(0.0..180.0).contains(&degrees) {
                        let text = format!("a camera's angle is between 0 and 180 degrees, not {degrees}");
                        return Err(Error::invalid(place, text));
                    }
                    // An angle of 0 does not change the direction.
                    if degrees > 0.0 {
                        camera.set_angle(degrees);
                    }
                    angled = true;
                }
                Setting::LookAt(target, place) => {
                    camera.look_at(target).map_err(|text| Error::invalid(place, text))?;
                }
                Setting::Orthographic => camera.size_as_at_look_at(),
            }
        }
        if camera.projection == Projection::Orthographic
            && (angled || !sized)
            && !self.applies_in_written_order()
        {
            camera.size_as_at_look_at();
        }
        Ok(())
    }

    /// Reads `camera` in `#default`: the values that cameras start with. A scene without a camera
    /// does not get this one (a fact of the language).
    pub(crate) fn default_camera_item(&mut self) -> Result<()> {
        self.default_camera = self.nested(Self::camera_block)?;
        Ok(())
    }

    /// Reads `camera` as a statement.
    pub(crate) fn camera_statement(&mut self, place: Place) -> Result<()> {
        let camera = self.nested(Self::camera_block)?;
        if self.scene.camera.replace(camera).is_some() {
            self.notice(place, "the scene has more than one camera: this one replaces the earlier one");
        }
        Ok(())
    }

    /// Reads `camera` as a value.
    pub(crate) fn camera_value(&mut self) -> Result<Value> {
        Ok(Value::Camera(Rc::new(self.nested(Self::camera_block)?)))
    }
}
