//! The functions on which continuous patterns are based.

use std::sync::Arc;

use durer_formula::Formula;
use durer_math::{Point3, Vec3};

use crate::{
    Cells, DensityGrid, GridBetween, ImageMap, ImageValue, Object, Pigment, SampledFunction, Turbulence,
};

/// The function on which a continuous pattern is based.
#[derive(Clone, Debug, PartialEq)]
pub enum Ramp {
    /// From 0 to 1 in each unit along a direction (of any length but zero), then from 0 again.
    Gradient(Vec3),
    /// From 1 at the origin to 0 on the unit sphere and beyond it.
    Spherical,
    /// From 1 on the y axis to 0 at a distance of 1.
    Cylindrical,
    /// From 1 on the plane `y = 0` to 0 at a distance of 1.
    Planar,
    /// From 1 at the origin to 0 on the cube with sides of 2 and beyond it.
    Boxed,
    /// The distance from the origin.
    Onion,
    /// The square of the mean of the sines of the coordinates.
    Leopard,
    /// The angle around the y axis, in turns.
    Radial,
    /// The coordinate x, with a turbulence of its own.
    Marble(Option<Turbulence>),
    /// The distance from the z axis, with a turbulence of its own.
    Wood(Option<Turbulence>),
    /// A spiral around the z axis.
    Spiral {
        /// The number of arms.
        arms: f64,
        /// Whether a second spiral is laid over it.
        double: bool,
        /// The turbulence that also shifts the spiral along z.
        turbulence: Option<Turbulence>,
    },
    /// Cushions in unit cubes. The two numbers bend the seam at its bottom and at its top.
    Quilted(f64, f64),
    /// Noise.
    Noise(Grain),
    /// A random number for each unit cube.
    Cells,
    /// Waves around random centres.
    Ripples(Ripples),
    /// Distances to random points.
    Crackle(Crackle),
    /// The behaviour of points of the plane `z = 0` under an iteration.
    Fractal(Fractal),
    /// The number of the kind of a cell: 0, 1, 2 ...
    Kind(Cells),
    /// A formula of x, y and z.
    Formula(Arc<Formula>),
    /// A function of x, y and z that depends on textures.
    Sampled(Arc<SampledFunction>),
    /// A number of a picture.
    Image(Arc<ImageMap>, ImageValue),
    /// The grey value of a pigment.
    Pigment(Box<Pigment>),
    /// 1 in an object, 0 elsewhere.
    Inside(Box<Object>),
    /// The angle of the surface to a direction, and a height.
    Slope(Slope),
    /// The angle between the surface and the ray that meets it.
    Aoi,
    /// Tiles of the plane `y = 0`, by the number of the tiling: one of [`Ramp::TILINGS`].
    Tiling(u8),
    /// Tiles of the plane `y = 0` that are made of equal triangles, squares or hexagons.
    Pavement(Pavement),
    /// Numbers on a grid in the unit cube.
    Density(Arc<DensityGrid>, GridBetween),
}

impl Ramp {
    /// The numbers of the tilings.
    pub const TILINGS: core::ops::RangeInclusive<u8> = 1..=27;
}

/// A noise generator of the scene language. All have the same vector noise.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum NoiseGenerator {
    /// `n + 1/2`, clamped to `[0, 1]`, for the noise `n` around zero.
    First,
    /// `(n + 1.05242) 0.48985582`, clamped to `[0, 1]`.
    #[default]
    Second,
    /// `0.4925 + 0.795 g`, clamped to `[0, 1]`, for the gradient noise `g`.
    Third,
}

impl NoiseGenerator {
    /// The generator with this number, without its fraction: the first one for unknown numbers.
    pub fn numbered(number: f64) -> Self {
        match number.trunc() {
            2.0 => Self::Second,
            3.0 => Self::Third,
            _ => Self::First,
        }
    }
}

/// A pattern made of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// The kind of the pattern.
    pub kind: GrainKind,
    /// The generator of the noise; `None` for that of the scene.
    pub generator: Option<NoiseGenerator>,
}

/// The kinds of patterns made of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrainKind {
    /// The noise itself.
    Bozo,
    /// The cube of the noise.
    Dents,
    /// The sum of octaves of noise.
    Wrinkles,
    /// The sum of octaves of `|1/2 - noise|`.
    Granite,
    /// Bands along z, displaced by this turbulence times the amount.
    Agate(f64, Turbulence),
}

/// Octaves of noise that move points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octaves {
    /// The number of octaves.
    pub count: u32,
    /// The factor of frequency from one octave to the next.
    pub lambda: f64,
    /// The factor of strength from one octave to the next.
    pub omega: f64,
}

/// Waves around ten random centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripples {
    /// Whether their lengths differ from centre to centre.
    pub waves: bool,
    /// The number of waves in each unit.
    pub frequency: f64,
    /// The shift of the waves.
    pub phase: f64,
}

/// A linear combination of the distances to the nearest of random points, one in each unit cube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crackle {
    /// The factors of the distances to the nearest point, the second and the third.
    pub form: Vec3,
    /// The exponent of the distance: 2 for Euclid's.
    pub metric: f64,
    /// A distance along a fourth axis.
    pub offset: f64,
    /// Whether the number is constant over all points with the same nearest point.
    pub solid: bool,
    /// The noise generator of that number; `None` for that of the scene.
    pub generator: Option<NoiseGenerator>,
}

/// The angle of a surface's normal to a direction, mixed with a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The direction or point.
    pub to: SlopeTo,
    /// The slopes that give 0 and 1. A slope is 0 for a normal opposite to the direction, 1/2 for a
    /// perpendicular one, 1 for a parallel one.
    pub range: [f64; 2],
    /// A direction and the heights along it that give 0 and 1. Its length and that of the slope's
    /// direction are the weights of the mean.
    pub altitude: Option<(Vec3, [f64; 2])>,
}

/// The target of a slope, in the space of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlopeTo {
    /// A direction of any length but zero.
    Direction(Vec3),
    /// The direction from the surface to a point.
    Point(Point3),
}

/// The look of the corners of the tiles of a pavement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CornerLook {
    /// The sides meet in an angle.
    Sharp,
    /// The angle is cut off.
    Cut,
    /// The angle is rounded.
    Round,
}

/// Tiles of some triangles, squares or hexagons each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pavement {
    /// The number of sides of the cells: 3, 4 or 6.
    pub sides: u8,
    /// The number of cells of a tile, from 1.
    pub tiles: u8,
    /// The number of the pavement among those of such tiles, from 1 to [`Pavement::patterns`].
    pub pattern: u8,
    /// The look of pointed corners; hexagons have none.
    pub exterior: CornerLook,
    /// The look of corners into which other tiles point.
    pub interior: CornerLook,
    /// The look where a tile turns. Without one, squares have the look of other corners, and
    /// triangles and hexagons are sharp.
    pub form: Option<CornerLook>,
}

impl Pavement {
    /// The number of pavements of cells with so many sides and tiles of so many cells.
    pub fn patterns(sides: u8, tiles: u8) -> u8 {
        let counts: &[u8] = match sides {
            3 => &[1, 1, 1, 3, 4, 12],
            4 => &[1, 1, 2, 5, 12, 35],
            6 => &[1, 1, 3, 7, 22],
            _ => &[],
        };
        let index = usize::from(tiles).checked_sub(1);
        index.and_then(|index| counts.get(index)).map_or(0, |&count| count)
    }
}

/// An iteration in the complex plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// The function that is iterated.
    pub map: FractalMap,
    /// The constant; `None` if it is the point itself.
    pub constant: Option<(f64, f64)>,
    /// The greatest number of iterations.
    pub iterations: u32,
    /// The number for points that escape: its kind, 0 to 6, and its factor.
    pub exterior: (u8, f64),
    /// The number for points that do not: its kind, 0 to 6, and its factor.
    pub interior: (u8, f64),
}

/// A function that is iterated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FractalMap {
    /// `z^n + c`.
    Power(u32),
    /// The first model of a magnet.
    Magnet1,
    /// The second model of a magnet.
    Magnet2,
}
