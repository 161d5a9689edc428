//! Light sources.

use durer_math::{Affine, Point3, Vec3};

use std::sync::Arc;

use crate::{Object, Rgb};

/// A light source.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The location.
    pub location: Point3,
    /// The colour of the light.
    pub colour: Rgb,
    /// The shape of the beam.
    pub kind: LightKind,
    /// The point it is aimed at, if it has a direction.
    pub point_at: Point3,
    /// Whether its rays are parallel, with the direction from `location` to `point_at`.
    pub parallel: bool,
    /// Whether it throws neither shadows nor highlights.
    pub shadowless: bool,
    /// How the light fades with the distance.
    pub fade: Option<Fade>,
    /// The extent of the light, for soft shadows; `None` for a point.
    pub area: Option<AreaLight>,
    /// The object through which it shines: only what lies behind this object is lit, and only what
    /// lies behind it throws shadows.
    pub through: Option<Arc<Object>>,
    /// The number of the light group whose objects it lights; `None` for all other objects, and
    /// those of groups with global lights.
    pub group: Option<u32>,
}

/// Lights that light only the objects of the group. Other lights do not light its objects, unless
/// it has global lights; neither do those of groups around it or within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightGroup {
    /// Whether lights without a group light its objects too.
    pub global_lights: bool,
}

impl LightGroup {
    /// Whether a light with this group lights an object with that one.
    pub fn lights(groups: &[Self], light: Option<u32>, object: Option<u32>) -> bool {
        let own = object.and_then(|group| groups.get(group as usize));
        light == object || light.is_none() && own.is_none_or(|group| group.global_lights)
    }
}

/// A grid of points, all of which throw shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// The two sides of the grid, whose middle is the location.
    pub sides: [Vec3; 2],
    /// The numbers of points along them, 1 at least.
    pub points: [u32; 2],
    /// Whether the grid is bent to a disc.
    pub circular: bool,
    /// Whether it is turned towards each point that is lit.
    pub orient: bool,
    /// Adaptive sampling starts with `2^level + 1` points along each side, and adds points where
    /// shadows differ.
    pub adaptive: Option<u32>,
    /// Whether the points also give the light itself, not only its shadows.
    pub illuminates: bool,
}

/// The shape of a light's beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// It is the same in all directions.
    Point,
    /// A cone towards `point_at`.
    Spot {
        /// Half the angle of the fully lit cone, in radians.
        radius: f64,
        /// Half the angle of the cone beyond which there is no light, in radians.
        falloff: f64,
        /// The exponent of the cosine of the angle to the axis.
        tightness: f64,
    },
    /// A straight beam towards `point_at`, always parallel.
    Cylinder {
        /// The radius of the fully lit beam.
        radius: f64,
        /// The radius beyond which there is no light.
        falloff: f64,
        /// The exponent of one minus the distance to the axis in units of `falloff`.
        tightness: f64,
    },
}

/// Fading with the distance `d`: the light is multiplied by `2 / (1 + (d / distance)^power)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fade {
    /// The distance at which the light has its full strength. With a negative one the formula is
    /// evaluated as it stands.
    pub distance: f64,
    /// The exponent of the fading; a light does not fade if this is not positive.
    pub power: f64,
}

impl Light {
    /// A light that shines in all directions.
    pub fn point(location: Point3, colour: Rgb) -> Self {
        Self {
            location,
            colour,
            kind: LightKind::Point,
            point_at: Point3::new(0.0, 0.0, 1.0),
            parallel: false,
            shadowless: false,
            fade: None,
            area: None,
            through: None,
            group: None,
        }
    }

    /// Transforms the light and the point it is aimed at.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.point_at = map.point(self.point_at);
        if let Some(area) = &mut self.area {
            area.sides = area.sides.map(|side| map.vector(side));
        }
    }
}
