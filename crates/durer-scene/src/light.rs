//! Lights.

use durer_math::{Affine, Point3};

use crate::Rgb;

/// A source of light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub location: Point3,
    /// Its light.
    pub colour: Rgb,
    /// Its form.
    pub kind: LightKind,
    /// Where it points, if it points anywhere.
    pub point_at: Point3,
    /// Its rays are parallel: all have the direction from `location` to `point_at`.
    pub parallel: bool,
    /// It throws no shadows and no highlights.
    pub shadowless: bool,
    /// How it fades with the distance.
    pub fade: Option<Fade>,
}

/// The form of a light's beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// The same in all directions.
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

/// A light is multiplied by `2 / (1 + (d / distance)^power)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fade {
    /// Where it has its own strength. With a negative one the formula is taken at its word.
    pub distance: f64,
    /// How sharply it fades; a light does not fade if this is not positive.
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
        }
    }

    /// Moves the light and where it points.
    pub fn transform(&mut self, map: &Affine) {
        self.location = map.point(self.location);
        self.point_at = map.point(self.point_at);
    }
}
