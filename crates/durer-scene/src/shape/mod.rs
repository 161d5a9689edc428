//! Shapes: what the constructors of all surfaces take, as numbers.

mod blob;
mod container;
mod deform;
mod isosurface;
mod mesh;
mod named_quadric;
mod parametric;
mod patch;
mod prism;
mod straight_sweep;

use std::sync::Arc;

use durer_math::{Point3, Vec3};
use durer_surfaces::DynSurface;

pub use self::blob::Blob;
pub use self::container::Container;
pub use self::deform::Deform;
pub use self::isosurface::Isosurface;
pub use self::mesh::{Face, FaceTexture, Mesh};
pub use self::named_quadric::{NamedQuadric, QuadricKind};
pub use self::parametric::Parametric;
pub use self::patch::{Patch, TriangularPatch};
pub use self::prism::{Prism, Spline, Sweep};
pub use self::straight_sweep::StraightSweep;
use crate::{
    FillRule, HeightField, Ifs, Julia, LatheSpline, NurbsData, Object, PathSweep, SewnData, SubdivisionData,
    SweepSpline, Terrain,
};

/// A surface in its object's own frame, not yet checked: lowering builds it or reports an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// All points at `radius` from `centre`.
    Sphere {
        /// The middle.
        centre: Point3,
        /// The radius.
        radius: f64,
    },
    /// An axis-aligned box between two opposite corners.
    Box {
        /// A corner.
        a: Point3,
        /// The opposite corner.
        b: Point3,
    },
    /// A circular cylinder; closed, unless the object is open.
    Cylinder {
        /// The middle of one end.
        base: Point3,
        /// The middle of the other.
        cap: Point3,
        /// The radius.
        radius: f64,
    },
    /// A circular cone or frustum; closed, unless the object is open.
    Cone {
        /// The middle of one end.
        base: Point3,
        /// The radius at `base`.
        base_radius: f64,
        /// The middle of the other end.
        cap: Point3,
        /// The radius at `cap`.
        cap_radius: f64,
    },
    /// The plane of points `p` with `p . normal = distance |normal|`; its inside is behind the
    /// normal.
    Plane {
        /// The normal, of any length but zero.
        normal: Vec3,
        /// The distance from the origin along the normal.
        distance: f64,
    },
    /// A disc, with a hole if `hole` is positive.
    Disc {
        /// The middle.
        centre: Point3,
        /// The normal, of any length but zero.
        normal: Vec3,
        /// The outer radius.
        radius: f64,
        /// The radius of the hole.
        hole: f64,
    },
    /// The points `corner + a u + b v`, `a` and `b` from 0 to 1.
    Parallelogram {
        /// A corner.
        corner: Point3,
        /// The first edge.
        u: Vec3,
        /// The second edge.
        v: Vec3,
    },
    /// A flat triangle.
    Triangle([Point3; 3]),
    /// A triangle with a normal at each corner, interpolated between them.
    SmoothTriangle(Box<([Point3; 3], [Vec3; 3])>),
    /// A plane polygon.
    Polygon {
        /// Its loops, one or more. Their first points are not repeated at their ends.
        loops: Arc<[Vec<Point3>]>,
        /// The rule that says which points are inside the loops.
        rule: FillRule,
    },
    /// Triangles over shared corners.
    Mesh(Arc<Mesh>),
    /// The general quadric `A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0`:
    /// the ten coefficients in this order.
    Quadric(Box<[f64; 10]>),
    /// The zero set of a polynomial in x, y and z; its inside is where the polynomial is negative.
    Polynomial {
        /// The greatest sum of powers.
        order: u32,
        /// All coefficients, by falling powers of x, then of y, then of z.
        coefficients: Arc<[f64]>,
    },
    /// A tube around a circle about the y axis.
    Torus {
        /// The radius of the circle.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
    /// A Dupin cyclide: swept by a sphere whose centre goes round an ellipse in the xz plane.
    Cyclide {
        /// The ellipse's semi-axis along x.
        a: f64,
        /// The distance of its foci from its centre, less than `a`.
        c: f64,
        /// The mean radius of the sphere, which is `d - c x / a` where the centre is at x.
        d: f64,
    },
    /// An outline swept along y.
    Prism(Arc<Prism>),
    /// A profile carried along a straight path.
    StraightSweep(Arc<StraightSweep>),
    /// A profile carried along any path.
    PathSweep(PathSweep),
    /// All balls whose centres and radii follow a spline of these: centre and radius each.
    SphereSweep(SweepSpline, Arc<[[f64; 4]]>),
    /// A smooth curve through these points, a radius and a height each, rotated about the y axis;
    /// the first and the last point only give slopes. Closed by flat ends unless the object is
    /// open.
    Sor(Arc<[[f64; 2]]>),
    /// A spline through points, a radius and a height each, rotated about the y axis.
    Lathe(LatheSpline, Arc<[[f64; 2]]>),
    /// A Bezier patch: a surface over the unit square.
    Patch(Arc<Patch>),
    /// A Bezier patch over a triangle: an open surface.
    TriangularPatch(Arc<TriangularPatch>),
    /// A surface of non-uniform rational B-splines.
    Nurbs(Arc<NurbsData>),
    /// The limit surface of a mesh of polygons that is refined for ever; a solid if it is closed.
    Subdivision(Arc<SubdivisionData>),
    /// Three functions of two parameters.
    Parametric(Arc<Parametric>),
    /// NURBS surfaces that share edges: a solid if they are closed.
    Sewn(Arc<SewnData>),
    /// An egg about the y axis: two spheres with a piece of a spindle between them.
    Ovus {
        /// The radius of the sphere about the origin.
        bottom: f64,
        /// The radius of the sphere about the point `bottom` above it.
        top: f64,
    },
    /// A spindle, cut off by planes across its axis; closed there unless the object is open.
    Lemon {
        /// The middle of one end.
        base: Point3,
        /// The radius at `base`.
        base_radius: f64,
        /// The middle of the other end.
        apex: Point3,
        /// The radius at `apex`.
        apex_radius: f64,
        /// The radius of the arc from one end to the other.
        inner_radius: f64,
    },
    /// A quadric by its name, centred at the origin with its axis along z.
    Named(Box<NamedQuadric>),
    /// The part of a ball within `half_angle` of an axis.
    SphericalSector {
        /// The middle of the ball.
        centre: Point3,
        /// The radius of the ball.
        radius: f64,
        /// The axis, of any length but zero.
        axis: Vec3,
        /// The angle between the axis and the cone, in radians.
        half_angle: f64,
    },
    /// Where a formula has a value.
    Isosurface(Box<Isosurface>),
    /// `(|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1`.
    Superellipsoid {
        /// The exponent of the sections across z.
        e: f64,
        /// The exponent along z.
        n: f64,
    },
    /// Where the fields of some balls and sausages add up to a value.
    Blob(Arc<Blob>),
    /// A Julia set.
    Julia(Box<Julia>),
    /// A leaf under all products of some contractions.
    Ifs(Ifs),
    /// A sheet over the unit square, or under it all if the object is part of a solid.
    HeightField(Box<HeightField>),
    /// A height field whose heights are made on demand.
    Terrain(Box<Terrain>),
    /// A solid, deformed. See [`Object::deformed`].
    Deform(Box<Deform>),
    /// A surface that a program brings along. Two are equal if they are the same in memory.
    Own(DynSurface),
    /// All the parts' surfaces together. Parts are placed in the union's own frame.
    Union(Vec<Object>),
    /// A solid made of solids. Parts are placed in its own frame; a union among them is the solid
    /// of all its parts.
    Csg(Operation, Vec<Object>),
}

impl Shape {
    /// The name of the shape in messages, with its article.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "a sphere",
            Self::Box { .. } => "a box",
            Self::Cylinder { .. } => "a cylinder",
            Self::Cone { .. } => "a cone",
            Self::Plane { .. } => "a plane",
            Self::Disc { .. } => "a disc",
            Self::Parallelogram { .. } => "a parallelogram",
            Self::Triangle(_) => "a triangle",
            Self::SmoothTriangle(_) => "a smooth triangle",
            Self::Polygon { .. } => "a polygon",
            Self::Mesh(_) => "a mesh",
            Self::Quadric(_) => "a quadric",
            Self::Polynomial { .. } => "a polynomial",
            Self::Torus { .. } => "a torus",
            Self::Cyclide { .. } => "a cyclide",
            Self::Prism(_) => "a prism",
            Self::StraightSweep(_) | Self::PathSweep(_) => "a sweep",
            Self::SphereSweep(..) => "a sphere sweep",
            Self::Sor(_) => "a sor",
            Self::Lathe(..) => "a lathe",
            Self::Patch(_) => "a patch",
            Self::TriangularPatch(_) => "a triangular patch",
            Self::Nurbs(_) => "a nurbs surface",
            Self::Subdivision(_) => "a subdivision surface",
            Self::Parametric(_) => "a parametric",
            Self::Sewn(_) => "a sewn surface",
            Self::Ovus { .. } => "an ovus",
            Self::Lemon { .. } => "a lemon",
            Self::Named(_) => "a named quadric",
            Self::SphericalSector { .. } => "a spherical sector",
            Self::Isosurface(_) => "an isosurface",
            Self::Superellipsoid { .. } => "a superellipsoid",
            Self::Blob(_) => "a blob",
            Self::Julia(_) => "a Julia set",
            Self::Ifs(_) => "an ifs",
            Self::HeightField(_) => "a height field",
            Self::Terrain(_) => "a terrain",
            Self::Deform(_) => "a deformed solid",
            Self::Own(_) => "a surface of the program's own",
            Self::Union(_) => "a union",
            Self::Csg(Operation::Merge, _) => "a merge",
            Self::Csg(Operation::Intersection, _) => "an intersection",
            Self::Csg(Operation::Difference, _) => "a difference",
        }
    }
}

/// The set operation that combines solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// The union of the parts, without surfaces inside.
    Merge,
    /// The intersection of the parts.
    Intersection,
    /// The first part without all others.
    Difference,
}
