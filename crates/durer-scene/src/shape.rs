//! Shapes: what the constructors of all surfaces take, as numbers.

use std::sync::Arc;

use durer_math::{Point3, Vec3};
use durer_surfaces::{DynSurface, StraightPath, StraightPathError};

use crate::{
    BlobComponent, FillRule, HeightField, Ifs, Julia, LatheSpline, NurbsData, Object, PathSweep, SewnData,
    SubdivisionData, SweepSpline, Terrain, Texture, Warp,
};
use durer_formula::Formula;

/// A surface in its object's own frame, not yet checked: lowering builds it and names what is
/// wrong.
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
        /// The radius there.
        base_radius: f64,
        /// The middle of the other end.
        cap: Point3,
        /// The radius there.
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
    /// A smooth curve through these points, a radius and a height each, turned about the y axis;
    /// the first and the last point only tell slopes. Closed by flat ends unless the object is
    /// open.
    Sor(Arc<[[f64; 2]]>),
    /// A spline through points, a radius and a height each, turned about the y axis.
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
        /// The radius there.
        base_radius: f64,
        /// The middle of the other end.
        apex: Point3,
        /// The radius there.
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
    /// The same, with heights made on demand.
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
    /// What the shape is called in messages, with its article.
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

/// How solids make a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// The union of the parts, without surfaces inside.
    Merge,
    /// The intersection of the parts.
    Intersection,
    /// The first part without all others.
    Difference,
}

/// The points of a container where a function of `x`, `y` and `z` has the value `threshold`; the
/// inside is where it is below.
#[derive(Clone, Debug, PartialEq)]
pub struct Isosurface {
    /// The function.
    pub function: Arc<Formula>,
    /// The value.
    pub threshold: f64,
    /// What holds the surface. Where it cuts the inside it is closed by its own face, unless the
    /// object is open.
    pub container: Container,
}

/// The surface of three functions of u and v; the stored normal is the cross product of its slopes
/// along u and v.
#[derive(Clone, Debug, PartialEq)]
pub struct Parametric {
    /// The functions of x, y and z, of two numbers each.
    pub functions: [Arc<Formula>; 3],
    /// From where to where u goes, and v.
    pub domain: [[f64; 2]; 2],
    /// What cuts the surface off. Without it the surface must be bounded.
    pub container: Option<Container>,
}

/// A solid, or a surface given by parameters, and what is done to it, in this order. All of it is
/// one surface with one texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Deform {
    /// The solid: of shapes with an inside that have a formula, combined in any way. A union is the
    /// solid of its parts here. Or one patch, NURBS, sewn or parametric surface. Textures in it do
    /// not count.
    pub solid: Object,
    /// The deformation.
    pub warps: Vec<Warp>,
}

/// The control net of a Bezier patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// How many points a row has, and how many rows there are.
    pub size: [usize; 2],
    /// The points row by row, and their weights: `[x, y, z, w]`. The parameter u runs along a row.
    pub points: Vec<[f64; 4]>,
    /// Texture coordinates at (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1).
    pub uv: [[f64; 2]; 4],
}

/// The control net of a Bezier patch over a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangularPatch {
    /// How many points a side has: the degree and one.
    pub side: usize,
    /// The points row by row, each row one point shorter, and their weights: `[x, y, z, w]`. The
    /// parameter u runs along a row.
    pub points: Vec<[f64; 4]>,
    /// Texture coordinates at (u, v) = (0, 0), (1, 0) and (0, 1).
    pub uv: [[f64; 2]; 3],
}

/// An outline in the xz plane, swept from one height to another; closed by flat caps unless the
/// object is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Closed outlines, `[x, z]` for each point. Inside is what they go round an odd number of
    /// times.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// How an outline goes through its points; curves have all the points that their spline asks
    /// for, the first one of the curve again as its last.
    pub spline: Spline,
    /// The heights of both ends, in any order.
    pub heights: [f64; 2],
    /// How the outline changes with the height.
    pub sweep: Sweep,
}

/// How an outline goes through its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// Straight from one to the next, and from the last to the first.
    Linear,
    /// On a curve.
    Curved(durer_surfaces::Spline),
}

/// How an outline changes along its sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// Not at all.
    Linear,
    /// At the height y it is y times as large.
    Conic,
}

/// A profile that moves along a straight path, closed by flat caps unless the object is open.
#[derive(Clone, Debug, PartialEq)]
pub struct StraightSweep {
    /// Closed outlines in the plane across the path. Inside is what they go round an odd number of
    /// times.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// How an outline goes through its points, as in [`Prism::spline`].
    pub spline: Spline,
    /// The ends of the path.
    pub path: [Point3; 2],
    /// The sizes of the profile at the ends, positive; linear between them.
    pub sizes: [f64; 2],
    /// The profile's second axis points to this side. For the frame without it see
    /// [`StraightPath::new`](durer_surfaces::StraightPath::new).
    pub up: Option<Vec3>,
}

impl StraightSweep {
    /// The path with the frame and the sizes of the profile.
    pub fn straight_path(&self) -> Result<StraightPath, StraightPathError> {
        let [from, to] = self.path;
        StraightPath::new(from, to, self.sizes, self.up)
    }
}

/// The points where fields add up to `threshold`; the inside is where there is more.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob {
    /// The value, which is positive.
    pub threshold: f64,
    /// The fields.
    pub components: Vec<BlobComponent>,
    /// The texture of each of them, placed in the blob's space; what has none has the blob's. Empty
    /// if none has one.
    pub textures: Vec<Option<Arc<Texture>>>,
}

/// The container of a function's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Container {
    /// A box between two opposite corners.
    Box(Point3, Point3),
    /// A ball: its middle and its radius.
    Ball(Point3, f64),
}

/// A quadric in its principal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedQuadric {
    /// Its name.
    pub kind: QuadricKind,
    /// Its semi-axes along x, y and z; see [`QuadricKind`] for what each means. Unused ones are
    /// ignored.
    pub semi_axes: [f64; 3],
    /// The part between two planes `z = from` and `z = to`, closed by flat caps unless the object
    /// is open; all of it if absent.
    pub extent: Option<[f64; 2]>,
}

/// The quadrics that have names, with semi-axes a, b, c.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuadricKind {
    /// `x^2/a^2 + y^2/b^2 + z^2/c^2 = 1`; a spheroid if two of them are equal.
    Ellipsoid,
    /// `x^2/a^2 + y^2/b^2 = z/c`; circular if `a = b`.
    EllipticParaboloid,
    /// `x^2/a^2 - y^2/b^2 = z/c`.
    HyperbolicParaboloid,
    /// `x^2/a^2 + y^2/b^2 - z^2/c^2 = 1`.
    HyperboloidOneSheet,
    /// `z^2/c^2 - x^2/a^2 - y^2/b^2 = 1`.
    HyperboloidTwoSheets,
    /// `x^2/a^2 + y^2/b^2 = z^2/c^2`: a double cone; circular if `a = b`.
    EllipticCone,
    /// `x^2/a^2 + y^2/b^2 = 1`; circular if `a = b`.
    EllipticCylinder,
    /// `x^2/a^2 - y^2/b^2 = 1`.
    HyperbolicCylinder,
    /// `x^2/a^2 = y/b`.
    ParabolicCylinder,
}

/// Triangles over shared corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<Point3>,
    /// The normals that faces may refer to, of any length.
    pub normals: Vec<Vec3>,
    /// The triangles.
    pub faces: Vec<Face>,
    /// The texture coordinates that faces may refer to.
    pub uv: Vec<[f64; 2]>,
    /// The numbers of the texture coordinates at each face's corners, if it has any; as many as
    /// there are faces, or none for all. The coordinates of hits are interpolated between them; on
    /// other faces the corners have (0, 0), (1, 0) and (0, 1).
    pub uv_faces: Vec<Option<[u32; 3]>>,
    /// The textures that faces may refer to, placed in the mesh's own frame.
    pub textures: Vec<Arc<Texture>>,
    /// A direction that decides what is inside: points from which it crosses the mesh an odd number
    /// of times. Without it the mesh is a sheet.
    pub inside_vector: Option<Vec3>,
}

/// A triangle of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// The numbers of its corners.
    pub vertices: [u32; 3],
    /// The numbers of the normals at its corners; flat without them.
    pub normals: Option<[u32; 3]>,
    /// Its texture; the object's without it.
    pub texture: Option<FaceTexture>,
}

/// The numbers of a face's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceTexture {
    /// One texture.
    One(u32),
    /// A texture for each corner, mixed by the point's barycentric coordinates.
    Corners([u32; 3]),
}
