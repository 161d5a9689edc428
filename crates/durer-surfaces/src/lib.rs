//! Exact surfaces. Each answers one question: *where does this ray meet the surface?*
//!
//! A surface implements [`Surface`]. [`Surface::roots`] pushes every crossing of a ray, in order,
//! as a bracket that provably holds it; [`Surface::resolve`] gives the point, its normals and error
//! bounds:
//!
//! ```
//! use durer_math::{Point3, Ray, Vec3};
//! use durer_surfaces::{All, LocalRay, Need, Sphere, Surface};
//!
//! let sphere = Sphere::new(Point3::new(0.0, 0.0, 0.0), 1.0)?;
//! let ray = Ray::new(Point3::new(0.0, 0.6, -1e6), Vec3::new(0.0, 0.0, 1.0));
//! let local = LocalRay::new(&ray);
//! let mut crossings = All::default();
//! let _ = sphere.roots(&local, &mut crossings);
//! assert_eq!(crossings.roots.len(), 2);
//! let entry = crossings.roots[0];
//! assert!(entry.lo <= 1e6 - 0.8 && 1e6 - 0.8 <= entry.hi && entry.sign == -1);
//! let point = sphere.resolve(&local, &entry, Need::ALL);
//! assert!(point.off < 1e-12); // a bound on the distance to the exact sphere
//! # Ok::<(), durer_surfaces::SphereError>(())
//! ```
//!
//! Applications use a `Geometry` (crate `durer-geometry`), which holds many surfaces in a tree.
//!
//! | where | what |
//! |---|---|
//! | `sphere`, `quadric/`, `torus`, `algebraic`, ... | one surface, one file or folder, with its equation on top |
//! | `zero_set`, [`polynomial_surface`] | surfaces of an author's own polynomial, and their solver |
//! | [`compose`] | placed, clipped and complemented surfaces |
//! | `ray/`, `sink` | re-centred rays, and the queries as sinks of roots |
//! | [`implicit`] | level sets of formulas, deformations |
//! | [`packet`] | bounded f64 models that answer for eight rays at once |
//! | [`textbook`] | the textbook forms and their weaknesses |
//! | `laws/` | what every surface must keep, checked against exact arithmetic |
#![forbid(unsafe_code)]

// Cases that the fuzz targets share with the tests name this crate as others do.
#[cfg(test)]
extern crate self as durer_surfaces;

mod accelerate;
pub mod algebraic;
pub mod annulus;
pub mod axis_box;
pub mod blob;
mod box_tree;
pub mod compose;
#[cfg(test)]
mod corpus;
pub mod cyclide;
mod degree;
pub mod disc;
mod edges;
pub mod faces;
mod facet;
mod fill_rule;
pub mod half_space;
pub mod ifs;
pub mod implicit;
pub mod julia;
#[cfg(any(test, feature = "laws"))]
pub mod laws;
pub mod lemon;
pub mod mesh;
pub mod ovus;
pub mod packet;
pub mod parallelogram;
pub mod parametric;
pub mod patch;
mod planar;
pub mod plane;
mod point;
pub mod polygon;
pub mod polynomial_surface;
pub mod prism;
pub mod quadric;
mod ray;
pub mod revolution;
mod root;
mod sink;
pub mod sor;
pub mod sphere;
pub mod sphere_sweep;
mod steps;
mod surface;
mod swift;
pub mod terrain;
pub mod textbook;
pub mod torus;
pub mod triangle;
mod zero_set;

pub use crate::accelerate::{Accelerate, PartId};
pub use crate::algebraic::{AlgebraicError, AlgebraicSurface};
pub use crate::annulus::{Annulus, AnnulusError};
pub use crate::axis_box::{AxisBox, AxisBoxError};
pub use crate::blob::{Blob, BlobComponent, BlobError, BlobShape};
pub use crate::compose::affine::{Place, Placed};
pub use crate::compose::clip::{Algebraic, Clip};
pub use crate::compose::complement::Complement;
pub use crate::compose::dynamic::DynSurface;
pub use crate::compose::region::{Region, RegionError};
pub use crate::cyclide::{Cyclide, CyclideError};
pub use crate::disc::{Disc, DiscError};
pub use crate::faces::extent::QuadricExtent;
pub use crate::fill_rule::FillRule;
pub use crate::half_space::HalfSpace;
pub use crate::ifs::{Ifs, IfsError, IfsLeaf};
pub use crate::implicit::deform::{DeformError, DeformStep, Lattice, Warp};
pub use crate::implicit::level_set::LevelSet;
pub use crate::implicit::{Container, Isosurface, IsosurfaceError, SuperellipsoidError, superellipsoid};
pub use crate::julia::{Julia, JuliaAlgebra, JuliaError, JuliaPower, JuliaSet};
pub use crate::lemon::LemonError;
pub use crate::mesh::{FLAT, Mesh, MeshData, MeshError};
pub use crate::ovus::OvusError;
pub use crate::parallelogram::{Parallelogram, ParallelogramError};
pub use crate::parametric::{
    DeformSource, DeformedSurface, Parametric, ParametricError, PathSpline, PathSweep, SweepData, SweepError,
};
pub use crate::patch::{
    BezierPatch, Boundary, Nurbs, NurbsData, NurbsError, PatchError, Scheme, Sewn, SewnData, SewnError,
    SubdivisionData, SubdivisionError, SubdivisionSurface, TriangularPatch, TrimError, TrimLoop,
    UvInterpolation,
};
pub use crate::plane::{Plane, PlaneError};
pub use crate::point::SurfacePoint;
pub use crate::polygon::{Polygon, PolygonError};
pub use crate::prism::curved::{Bezier, CurvedPrism, Spline};
pub use crate::prism::{Prism, PrismError, StraightPath, StraightPathError};
pub use crate::quadric::axial::{Axial, AxialError};
pub use crate::quadric::cone::Cone;
pub use crate::quadric::cylinder::{EllipticCylinder, HyperbolicCylinder, ParabolicCylinder};
pub use crate::quadric::ellipsoid::Ellipsoid;
pub use crate::quadric::general::{Quadric, QuadricError, QuadricKind};
pub use crate::quadric::hyperboloid::{HyperboloidOfOneSheet, HyperboloidOfTwoSheets};
pub use crate::quadric::paraboloid::{EllipticParaboloid, HyperbolicParaboloid};
pub use crate::quadric::round::{CappedCylinder, Frustum, RoundError};
pub use crate::quadric::sector::{SectorError, SphericalSector};
pub use crate::quadric::solid::QuadricSolid;
pub use crate::ray::{CentredRay, End, LocalPoint, LocalRay, PREVIEW_WIDTH, RingRay, WideCache};
pub use crate::revolution::SurfaceOfRevolution;
pub use crate::revolution::lathe::{Lathe, LatheError, LatheSpline};
pub use crate::root::{Root, RootKind};
pub use crate::sink::{All, Any, Closest, FirstCrossing, Forward, Sink};
pub use crate::sor::SorError;
pub use crate::sphere::{Sphere, SphereError};
pub use crate::sphere_sweep::{SphereSweep, SphereSweepError, SweepSpline};
pub use crate::steps::Steps;
pub use crate::surface::{Need, Side, Solidity, Surface};
pub use crate::swift::{Crossings, meet_eight};
pub use crate::terrain::{HeightField, HeightFieldError, Terrain, TerrainData, TerrainError};
pub use crate::torus::{Axis, Torus, TorusError};
pub use crate::triangle::{Triangle, TriangleError};
pub use crate::zero_set::{Polynomial, ZeroSet, ZeroSetError};
