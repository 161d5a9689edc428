//! This crate describes a scene as plain data: objects, textures, lights and a camera.
//!
//! A [`Scene`] can be printed, compared and cloned. It has no syntax of its own and does nothing by
//! itself. Readers build it from text, and programs build it directly:
//!
//! ```
//! use durer_math::Point3;
//! use durer_scene::{Colour, Finish, Light, Object, Pigment, Rgb, Scene, Shape, Texture};
//!
//! let red = Pigment::solid(Colour::opaque(Rgb::new(1.0, 0.0, 0.0)));
//! let ball = Object::new(Shape::Sphere { centre: Point3::new(0.0, 0.0, 5.0), radius: 1.0 })
//!     .with_texture(Texture::plain(red, Finish::default()));
//! let scene = Scene {
//!     objects: vec![ball],
//!     lights: vec![Light::point(Point3::new(-10.0, 10.0, 0.0), Rgb::WHITE)],
//!     ..Scene::default()
//! };
//! assert_eq!(scene.clone(), scene);
//! ```
#![forbid(unsafe_code)]

mod camera;
mod chart;
mod colour;
mod density_grid;
mod finish;
mod fog;
mod image;
mod interior;
mod learned_noise;
mod light;
mod lower;
pub mod mask;
mod normal;
mod object;
mod pattern;
mod placement;
mod point_warp;
mod rainbow;
mod ramp;
mod sampled;
mod scene;
mod shape;
mod texture;

pub use crate::camera::{Camera, Distribution, Lens, MeshCamera, Projection};
pub use crate::chart::{Chart, ChartKind, unfolded};
pub use crate::colour::{Colour, Rgb};
pub use crate::density_grid::{DensityGrid, GridBetween};
pub use crate::finish::{Finish, Irid, Reflection};
pub use crate::fog::{Fog, GroundFog};
pub use crate::image::{Between, Image, ImageMap, ImageValue, Layout};
pub use crate::interior::Interior;
pub use crate::learned_noise::LearnedNoise;
pub use crate::light::{AreaLight, Fade, Light, LightGroup, LightKind};
pub use crate::lower::{Look, LookId, LowerError, LowerErrorKind, Lowered};
pub use crate::normal::{Height, Normal, NormalBody, Push};
pub use crate::object::{Flags, Object, Place};
pub use crate::pattern::{Cells, Pattern, Value, Wave};
pub use crate::placement::Placement;
pub use crate::point_warp::{Around, BlackHole, PointWarp, Turbulence, Wrap};
pub use crate::rainbow::Rainbow;
pub use crate::ramp::{
    CornerLook, Crackle, Fractal, FractalMap, Grain, GrainKind, NoiseGenerator, Octaves, Pavement, Ramp,
    Ripples, Slope, SlopeTo,
};
pub use crate::sampled::{SampledFunction, TextureSample, TextureSource};
pub use crate::scene::{AssumedGamma, Background, Scene, Settings, SkySphere};
pub use crate::shape::{
    Blob, Container, Deform, Face, FaceTexture, Isosurface, Mesh, NamedQuadric, Operation, Parametric, Patch,
    Prism, QuadricKind, Shape, Spline, StraightSweep, Sweep, TriangularPatch,
};
pub use crate::texture::{FieldWeights, Fields, Layer, Pigment, PigmentBody, Texture, TextureBody};
pub use durer_formula::noise::CellNumbers;
pub use durer_surfaces::LatheSpline;
pub use durer_surfaces::Spline as Curve;
pub use durer_surfaces::algebraic::{MAX_ORDER, coefficient_count, place_of};
pub use durer_surfaces::ifs::{Ifs, IfsError, IfsLeaf, MOST_LEVELS};
pub use durer_surfaces::julia::MOST_ITERATIONS;
pub use durer_surfaces::terrain::MOST_SAMPLES;
pub use durer_surfaces::{
    BlobComponent, BlobShape, Boundary, FillRule, HeightField, Julia, JuliaAlgebra, JuliaPower, NurbsData,
    NurbsError, Scheme, SewnData, SewnError, SubdivisionData, SubdivisionError, SweepSpline, Terrain,
    TerrainData, TrimError, TrimLoop, UvInterpolation, Warp,
};
/// A lattice of control points, and why there is none.
pub use durer_surfaces::{DeformError, Lattice};
/// A profile swept along any path.
pub use durer_surfaces::{PathSpline, PathSweep, SweepData, SweepError};
