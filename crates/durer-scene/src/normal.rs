//! Normals that look bumpy: perturbations of a surface's normal.

use std::sync::Arc;

use crate::{ImageMap, ImageValue, NoiseGenerator, Pattern, Placement, PointWarp, Ripples, Value};

/// A perturbation of a surface's normal at each point of space.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal {
    /// How the normal is perturbed.
    pub body: NormalBody,
    /// From the pattern's space to that of the texture (or normal) around it.
    pub placement: Placement,
    /// Whether bumps keep their slope, and not their depth, when they are scaled.
    pub keeps_slope: bool,
    /// Whether its pattern is seen at the surface's texture coordinates `(u, v, 0)` in place of the
    /// point. Then only its own placement counts.
    pub on_chart: bool,
    /// Where its whole texture is seen at the surface's texture coordinates: the placement by which the
    /// perturbation is turned, as that of other normals is by theirs. Without it the perturbation of a
    /// normal on a chart is turned by its own placement only.
    pub turn: Option<Placement>,
}

impl Normal {
    /// Whether anything in it is seen at texture coordinates.
    pub(crate) fn needs_chart(&self) -> bool {
        self.on_chart
            || match &self.body {
                NormalBody::Normals(pattern) => pattern.entries().any(Self::needs_chart),
                _ => false,
            }
    }
}

/// How a normal is perturbed.
#[derive(Clone, Debug, PartialEq)]
pub enum NormalBody {
    /// The surface looks like a landscape.
    Height(Box<Height>),
    /// A vector is added to the normal.
    Push {
        /// Maps of the point before.
        warps: Vec<PointWarp>,
        /// The vector.
        push: Push,
        /// Its factor.
        amount: f64,
    },
    /// The differences of a picture's values from pixel to pixel are subtracted from the normal along
    /// the picture's sides.
    Picture {
        /// Maps of the point before.
        warps: Vec<PointWarp>,
        /// The picture.
        map: Arc<ImageMap>,
        /// What its values are.
        value: ImageValue,
        /// The factor of the differences.
        amount: f64,
    },
    /// Other normals, selected or mixed by a pattern. They are placed in this normal's space.
    Normals(Box<Pattern<Normal>>),
}

/// A landscape whose heights are a pattern's values.
#[derive(Clone, Debug, PartialEq)]
pub struct Height {
    /// Maps of the point before.
    pub warps: Vec<PointWarp>,
    /// The heights.
    pub value: Value,
    /// A map of the heights: for each value a height and a slope. If empty, the heights do not
    /// change.
    pub slopes: Vec<(f64, [f64; 2])>,
    /// The factor of the heights.
    pub amount: f64,
    /// The distance of the points at which heights are compared.
    pub accuracy: f64,
}

/// A vector that is added to a normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Push {
    /// Noise.
    Bumps,
    /// Noise that is strong in few places.
    Dents {
        /// The generator of its strength; `None` for that of the scene.
        generator: Option<NoiseGenerator>,
    },
    /// Octaves of noise.
    Wrinkles,
    /// Waves around random centres.
    Ripples(Ripples),
    /// Cushions in unit cubes. The two numbers bend the seam.
    Quilted(f64, f64),
    /// A random vector along the surface, times this, for all points nearest to one of some random
    /// points.
    Facets(f64),
    /// The difference from the normal to the nearest of some random normals. These are the directions of
    /// random points, one in each cube of a grid; this is the width of the cubes.
    NormalFacets(f64),
}
