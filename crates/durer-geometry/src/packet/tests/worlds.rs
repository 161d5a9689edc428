//! Worlds of one surface each: as it is, inside out, and placed by maps that are hard on a packet
//! filter.

use super::point;
use crate::{Geometry, Hit};
use durer_formula::Function;
use durer_formula::{Builder, Op};
use durer_math::{Affine, Dyadic, Isa, Normal3, Point3, Ray, Vec3};
use durer_surfaces::PREVIEW_WIDTH;
use durer_surfaces::{
    Algebraic, AlgebraicSurface, Annulus, Axis, AxisBox, Bezier, Blob, BlobComponent, BlobShape,
    CappedCylinder, Clip, Complement, Cone, Container, CurvedPrism, Disc, DynSurface, Ellipsoid,
    EllipticCylinder, EllipticParaboloid, FillRule, Frustum, HyperbolicCylinder, HyperbolicParaboloid,
    HyperboloidOfOneSheet, HyperboloidOfTwoSheets, Isosurface, Julia, JuliaAlgebra, JuliaPower, JuliaSet,
    Mesh, MeshData, ParabolicCylinder, Parallelogram, Placed, Plane, Polygon, Prism, Quadric, Region, Sphere,
    SphericalSector, SurfaceOfRevolution, Torus, Triangle, superellipsoid,
};

/// The facts that the tests can decide about points beside the surface.
#[derive(Clone, Copy)]
pub(super) enum Sides {
    /// A solid with a single face: it has an inside and an outside along the normal everywhere.
    Smooth,
    /// Smooth, but the kernel decides sides in f64: within rounding it returns that a point is on
    /// the surface.
    Rounded,
    /// Rounded, and whether a crossing is in a ray's range is decided by its bracket, which may
    /// contain an end of the range.
    Bracketed,
    /// Bracketed, with edges where a container cuts it off, closed or not: whether a ray meets such
    /// an edge is decided within rounding.
    Rimmed { closed: bool },
    /// A convex solid with edges: a ray that leaves it is outside, also at an edge.
    Convex,
    /// A solid with edges that is not convex.
    Solid,
    /// A part of the plane with this normal through this point, both exact.
    Flat(Vec3, Point3),
    /// An open surface that is not flat.
    Sheet,
}

/// A surface, and how it was placed.
pub(super) struct World {
    pub(super) surface: &'static str,
    pub(super) name: String,
    pub(super) geometry: Geometry,
    pub(super) sides: Sides,
    pub(super) turned: bool,
    /// Two surfaces with the same placement: where a ray meets both, this one has an edge.
    edges: Option<[Geometry; 2]>,
    /// The maps that placed it, the first one first.
    maps: Vec<Affine>,
}

impl World {
    /// A world about whose surface nothing more is known.
    pub(super) fn of(surface: &'static str, geometry: Geometry) -> Self {
        let (name, sides) = (surface.to_string(), Sides::Sheet);
        Self { surface, name, geometry, sides, turned: false, edges: None, maps: Vec::new() }
    }

    /// A placed world about whose surface nothing more is known.
    pub(super) fn placed(surface: &'static str, how: &str, geometry: Geometry, maps: Vec<Affine>) -> Self {
        Self { name: format!("{surface}, {how}"), maps, ..Self::of(surface, geometry) }
    }

    /// The image of a point of the surface's own frame; rounded, or exact if all numbers are short.
    pub(super) fn place(&self, p: Point3) -> Point3 {
        self.maps.iter().fold(p, |p, map| map.point(p))
    }

    /// The approximate size of the surface, or of the part that rays are aimed at.
    pub(super) fn size(&self) -> f64 {
        self.maps.iter().fold(2.0, |size, map| size * map.linear_norm())
    }

    /// A bound on all its coordinates under all its maps.
    pub(super) fn reach(&self) -> f64 {
        self.maps.iter().fold(2.0, |reach, map| reach * map.linear_norm() + map.centre().to_vec().length())
    }

    /// Whether a ray may meet an edge at a hit at `t` within `e`: both surfaces are met, within
    /// brackets as wide as those of pictures.
    pub(super) fn has_edge_on(&self, ray: &Ray, (t, e): (f64, f64)) -> bool {
        let line = Ray::new(ray.origin, ray.direction);
        let near = |a: &Hit| a.t_lo <= t + e && a.t_hi >= t - e;
        self.edges.as_ref().is_some_and(|[one, other]| {
            let others = other.all(&line);
            let meets = |a: &Hit, b: &Hit| {
                let rough = PREVIEW_WIDTH * a.t;
                a.t_lo <= b.t_hi + rough && a.t_hi + rough >= b.t_lo && (near(a) || near(b))
            };
            one.all(&line).iter().any(|a| others.iter().any(|b| meets(a, b)))
        })
    }

    /// The exact side of a flat surface's plane on which a point lies; positive in the direction of
    /// the mapped normal.
    pub(super) fn height(&self, p: Point3) -> Option<core::cmp::Ordering> {
        let Sides::Flat(normal, q) = self.sides else { return None };
        let exact = |v: Vec3| v.to_array().map(|x| Dyadic::new(x).unwrap());
        let dot =
            |a: &[Dyadic; 3], b: &[Dyadic; 3]| &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2]);
        // The point in the surface's own frame, as a fraction.
        let (mut y, mut whole) = (exact(p.to_vec()), Dyadic::new(1.0).unwrap());
        for map in self.maps.iter().rev() {
            let (adjugate, det) = map.adjugate::<Dyadic>();
            let c = exact(map.centre().to_vec());
            let from: [_; 3] = core::array::from_fn(|i| &y[i] - &(&whole * &c[i]));
            y = adjugate.map(|row| dot(&row, &from));
            whole = &whole * &det;
        }
        let n = exact(normal);
        let above = &dot(&n, &y) - &(&whole * &dot(&n, &exact(q.to_vec())));
        let sign = above.exact_sign();
        Some(if whole.exact_sign().is_lt() { sign.reverse() } else { sign })
    }
}

/// A map that rotates, shears and moves slightly: nothing stays dyadic.
pub(super) fn map() -> Affine {
    let turn = Affine::rotation_x(0.7).unwrap().then(&Affine::rotation_z(-0.4).unwrap()).unwrap();
    let sheared = Affine::new([[1.0, 0.3, 0.0], [0.0, 0.8, -0.2], [0.1, 0.0, 1.3]], Point3::ORIGIN).unwrap();
    turn.then(&sheared).unwrap().then(&Affine::translation(Vec3::new(0.1, -0.2, 0.3)).unwrap()).unwrap()
}

fn moved(x: f64, y: f64, z: f64) -> Affine {
    Affine::translation(Vec3::new(x, y, z)).unwrap()
}

fn scaled(k: f64) -> Affine {
    Affine::scaling(k, k, k).unwrap()
}

/// Every way to place a surface, by name: chains of maps, the first one first.
pub(super) fn placements() -> Vec<(&'static str, Vec<Affine>)> {
    let sheared = [[1.0, 0.5, 0.0], [0.0, -1.0, 0.25], [0.25, 0.0, 1.0]];
    let dyadic = Affine::new(sheared, point(0.5, -0.25, 1.0)).unwrap();
    let far = moved(1e6, -3e6 + 0.1, 2e6 + 0.7);
    vec![
        ("placed", vec![map()]),
        // Mirrored, too. Rays that are aimed at edges by short numbers meet them exactly.
        ("sheared", vec![dyadic]),
        ("tiny", vec![scaled(durer_math::scale::pow2(-60))]),
        ("huge", vec![scaled(durer_math::scale::pow2(60)), map()]),
        ("far", vec![map(), far]),
        ("far, exactly", vec![moved(1_048_576.0, -3_145_728.0, 2_097_152.0)]),
        // There and back again: the centre is moved by a map whose products are a million times as
        // large as their sum.
        ("returned", vec![far, moved(-1e6, 3e6, -2e6), map()]),
        ("turned about a far point", vec![far, moved(-1e6, 3e6, -2e6).then(&map()).unwrap()]),
        ("far and tiny", vec![scaled(1e-6), moved(1.0, 2.0, -0.7), map()]),
    ]
}

/// The worlds built so far, and the instruction set.
type Worlds = (Isa, Vec<World>);

/// A surface in all its placements.
fn worlds<S: Algebraic + 'static>(name: &'static str, sides: Sides, surface: S, (isa, out): &mut Worlds) {
    let surface = DynSurface::new(surface);
    let mut world = |how: &str, turned: bool, maps: Vec<Affine>, surface: DynSurface| {
        let geometry = Geometry::builder().isa(*isa).with(surface).build().unwrap();
        let full = format!("{name}, {how}");
        out.push(World { surface: name, name: full, geometry, sides, turned, edges: None, maps });
    };
    world("as it is", false, Vec::new(), surface.clone());
    world("inside out", true, Vec::new(), DynSurface::new(Complement(surface.clone())));
    for (how, maps) in placements() {
        let placed = maps.iter().fold(surface.clone(), |s, map| DynSurface::new(Placed::new(s, *map)));
        world(how, false, maps, placed);
    }
}

pub(super) fn tent() -> MeshData {
    MeshData {
        vertices: vec![
            point(-1.0, -1.0, 0.0),
            point(1.0, -1.0, 0.0),
            point(0.0, 1.0, 0.0),
            point(0.0, 0.0, 1.0),
        ],
        faces: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ..MeshData::default()
    }
}

/// A heart, and a round hole in it.
pub(super) fn heart() -> ([Bezier; 4], [Bezier; 2]) {
    (
        [
            [[0.0, -1.0], [0.5, -0.5], [1.0, 0.0], [1.0, 0.5]],
            [[1.0, 0.5], [1.0, 1.0], [0.25, 1.25], [0.0, 0.5]],
            [[0.0, 0.5], [-0.25, 1.25], [-1.0, 1.0], [-1.0, 0.5]],
            [[-1.0, 0.5], [-1.0, 0.0], [-0.5, -0.5], [0.0, -1.0]],
        ],
        [
            [[0.25, 0.0], [0.25, 0.5], [-0.25, 0.5], [-0.25, 0.0]],
            [[-0.25, 0.0], [-0.25, -0.5], [0.25, -0.5], [0.25, 0.0]],
        ],
    )
}

/// A star that winds twice around its middle.
pub(super) fn crossed_star() -> [[f64; 2]; 5] {
    [[-0.75, -1.25], [1.25, 0.25], [-1.25, 0.25], [0.75, -1.25], [-0.25, 1.25]]
}

/// A curve that crosses itself.
pub(super) fn crossed_eight() -> [Bezier; 3] {
    [
        [[0.0, 0.0], [1.0, 1.0], [1.5, -1.0], [0.25, -0.25]],
        [[0.25, -0.25], [-0.75, 0.75], [-1.5, 0.75], [-1.0, -0.5]],
        [[-1.0, -0.5], [-0.75, -1.0], [-0.5, -0.5], [0.0, 0.0]],
    ]
}

/// Every kind of surface with a packet filter, in every placement. Numbers are short, so that rays
/// can be aimed at edges, rims, tips and tangents exactly.
pub(super) fn all_worlds(isa: Isa) -> Vec<World> {
    let mut all = (isa, Vec::new());
    let all = &mut all;
    let o = Point3::ORIGIN;
    let up = Vec3::new(0.25, 1.0, -0.5);
    worlds("sphere", Sides::Smooth, Sphere::new(point(0.25, 0.0, -0.25), 1.0).unwrap(), all);
    worlds("plane", Sides::Smooth, Plane::new(up, -0.5).unwrap(), all);
    worlds("level plane", Sides::Smooth, Plane::new(Vec3::Y, 0.5).unwrap(), all);
    let block = AxisBox::new(point(-1.0, -0.5, -0.75), point(0.75, 0.5, 1.0)).unwrap();
    worlds("box", Sides::Convex, block, all);
    worlds("disc", Sides::Flat(up, o), Disc::new(o, up, 1.0).unwrap(), all);
    let ring = Annulus::new(point(0.0, 0.25, 0.0), Vec3::Y, 0.5, 1.0).unwrap();
    worlds("annulus", Sides::Flat(Vec3::Y, point(0.0, 0.25, 0.0)), ring, all);
    let (corner, u, v) = (point(-0.5, -0.5, 0.0), Vec3::new(1.5, 0.0, 0.0), Vec3::new(0.25, 1.25, 0.25));
    let tile = Parallelogram::new(corner, u, v).unwrap();
    worlds("parallelogram", Sides::Flat(u.cross(v), corner), tile, all);
    let corners = [point(-1.0, -0.75, 0.25), point(1.0, -0.5, 0.0), point(0.25, 1.0, -0.25)];
    let across = Sides::Flat((corners[1] - corners[0]).cross(corners[2] - corners[0]), corners[0]);
    let flat = Triangle::new(corners).unwrap();
    let normals = [Normal3::new(0.1, 0.2, 1.0), Normal3::new(-0.3, 0.1, 1.0), Normal3::new(0.0, -0.4, 2.0)];
    worlds("smooth triangle", across, flat.clone().with_normals(normals).unwrap(), all);
    worlds("triangle", across, flat, all);
    worlds("mesh", Sides::Convex, Mesh::new(tent()).unwrap().solid(Vec3::X).unwrap(), all);
    let (base, cap) = (point(0.0, -0.75, 0.0), point(0.25, 1.0, 0.0));
    worlds("cylinder", Sides::Convex, CappedCylinder::new(base, cap, 0.5).unwrap(), all);
    worlds("open cylinder", Sides::Sheet, CappedCylinder::open(base, cap, 0.5).unwrap(), all);
    worlds("frustum", Sides::Convex, Frustum::new(base, 1.0, cap, 0.25).unwrap(), all);
    worlds("cone", Sides::Convex, Frustum::new(base, 1.0, cap, 0.0).unwrap(), all);
    worlds("open frustum", Sides::Sheet, Frustum::open(base, 0.25, point(0.0, 1.0, 0.0), 1.0).unwrap(), all);
    worlds("double cone", Sides::Smooth, Cone::new(0.5, 0.75, 1.0).unwrap(), all);
    worlds("ellipsoid", Sides::Smooth, Ellipsoid::new(1.0, 0.5, 0.75).unwrap(), all);
    let bowl = EllipticParaboloid::new(0.5, 0.75, 1.0).unwrap();
    worlds("paraboloid", Sides::Smooth, bowl.clone(), all);
    worlds("capped paraboloid", Sides::Convex, bowl.between(0.0, 1.0).unwrap(), all);
    let saddle = HyperbolicParaboloid::new(0.5, 0.75, 1.0).unwrap();
    worlds("hyperbolic paraboloid", Sides::Smooth, saddle, all);
    let tower = HyperboloidOfOneSheet::new(0.5, 0.5, 0.75).unwrap();
    worlds("capped hyperboloid", Sides::Solid, tower.between(-0.75, 0.75).unwrap(), all);
    worlds("hyperboloid of one sheet", Sides::Smooth, tower, all);
    let two = HyperboloidOfTwoSheets::new(0.5, 0.5, 0.25).unwrap();
    worlds("hyperboloid of two sheets", Sides::Smooth, two, all);
    worlds("elliptic cylinder", Sides::Smooth, EllipticCylinder::new(0.5, 1.0).unwrap(), all);
    worlds("hyperbolic cylinder", Sides::Smooth, HyperbolicCylinder::new(0.5, 0.75).unwrap(), all);
    worlds("parabolic cylinder", Sides::Smooth, ParabolicCylinder::new(0.5, 1.0).unwrap(), all);
    worlds("spherical sector", Sides::Solid, SphericalSector::new(o, 1.0, up, 0.625).unwrap(), all);
    let any = Quadric::new([1.0, 2.0, -0.5, 0.25, 0.0, 0.25, 0.125, 0.0, -0.5, -0.625]).unwrap();
    worlds("quadric", Sides::Smooth, any, all);
    // A square with a hole, and a star that winds twice around its middle.
    let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]].map(|[x, y]| point(x, y, 0.5));
    let frame = Polygon::new(&[square(1.0), square(0.5)], FillRule::EvenOdd).unwrap();
    worlds("frame", Sides::Flat(Vec3::Z, point(0.0, 0.0, 0.5)), frame, all);
    let star =
        [[-1.5, -2.5], [2.5, 0.5], [-2.5, 0.5], [1.5, -2.5], [-0.5, 2.5]].map(|[x, y]| point(x, 0.0, y));
    for (name, rule) in [("star", FillRule::EvenOdd), ("full star", FillRule::NonZero)] {
        worlds(name, Sides::Flat(-Vec3::Y, o), Polygon::new(&[star], rule).unwrap(), all);
    }
    let cut = Region::half_space(Normal3::new(0.25, 1.0, 0.125), 0.25).unwrap();
    let hole = Region::solid(Sphere::new(point(0.0, 0.0, 1.0), 0.5).unwrap()).inverse();
    let ball = Sphere::new(o, 1.0).unwrap();
    worlds("clipped sphere", Sides::Sheet, Clip::new(ball, vec![cut.clone(), hole]), all);
    let outlines = [
        [[-1.0, -1.0], [1.0, -1.0], [0.25, 0.25], [-1.0, 1.0]],
        [[-0.75, -0.75], [-0.5, 0.0], [0.0, -0.25], [0.0, -0.5]],
    ];
    worlds("prism", Sides::Solid, Prism::linear(&outlines, -0.5, 0.75).unwrap(), all);
    worlds("conic prism", Sides::Solid, Prism::conic(&outlines, -0.5, 1.0).unwrap(), all);
    worlds("open prism", Sides::Sheet, Prism::conic(&outlines, 0.25, 1.0).unwrap().without_caps(), all);
    // A sheet with one corner slightly out of the plane, and a surface without its part in a box.
    let mut bent = square(1.0);
    bent[3].z = 0.5 + durer_math::scale::pow2(-40);
    worlds("bent frame", Sides::Sheet, Polygon::new(&[bent], FillRule::EvenOdd).unwrap(), all);
    let hole = Region::axis_box(point(-0.5, -0.5, -0.25), point(2.0, 2.0, 0.75)).unwrap().inverse();
    worlds("sphere without a box", Sides::Sheet, Clip::new(ball, vec![hole.clone()]), all);
    worlds("box without a box", Sides::Sheet, Clip::new(block, vec![hole]), all);
    // Planes that cut off a whole wall, by far and by an ulp; planes that cut off nothing; and one
    // that contains the wall.
    let room = Region::axis_box(point(-0.25, -0.5, -2.0), point(2.0, 0.5_f64.next_down(), 0.25)).unwrap();
    worlds("box within a box", Sides::Sheet, Clip::new(block, vec![room]), all);
    let ring = Torus::new(point(0.25, 0.0, -0.25), Axis::Y, 0.75, 0.25).unwrap();
    worlds("torus", Sides::Smooth, ring, all);
    worlds("horn torus", Sides::Solid, Torus::new(o, Axis::X, 0.5, 0.5).unwrap(), all);
    let profile = [[0.25, -1.25], [0.5, -1.0], [0.75, -0.25], [0.25, 0.5], [0.5, 1.0], [1.0, 1.25]];
    let vase = SurfaceOfRevolution::sor(&profile).unwrap();
    worlds("sor", Sides::Solid, vase.clone(), all);
    worlds("open sor", Sides::Sheet, vase.without_ends(), all);
    worlds("ovus", Sides::Smooth, SurfaceOfRevolution::ovus(0.75, 0.5).unwrap(), all);
    worlds("lemon", Sides::Convex, SurfaceOfRevolution::lemon(1.5, 0.5, 0.25, 1.25).unwrap(), all);
    // A cushion with dimples, an unbounded cubic, one clipped by a ball and a half-space, and a
    // bowl of degree six.
    let of = |order: u32, terms: &[([u32; 3], f64)]| {
        let mut c = vec![0.0; durer_surfaces::algebraic::coefficient_count(order)];
        for &(powers, value) in terms {
            c[durer_surfaces::algebraic::place_of(order, powers)] += value;
        }
        AlgebraicSurface::new(order, &c).unwrap()
    };
    let dimples = [([4, 0, 0], 1.0), ([0, 4, 0], 1.0), ([0, 0, 4], 1.0), ([2, 2, 0], 0.5)];
    let lower = [([2, 0, 0], -0.5), ([0, 2, 0], -0.25), ([0, 1, 1], 0.25), ([0, 0, 0], -0.375)];
    let cushion = of(4, &[dimples.as_slice(), lower.as_slice()].concat());
    worlds("quartic", Sides::Smooth, cushion, all);
    let cubic = [([3, 0, 0], 1.0), ([1, 2, 0], -3.0), ([0, 0, 2], 1.0), ([0, 0, 1], 0.5), ([0, 0, 0], -0.25)];
    // Leading terms of zero in a list for quartics have no effect.
    let padded = of(4, &cubic);
    let cubic = of(3, &cubic);
    worlds("cubic", Sides::Smooth, cubic.clone(), all);
    let ball = Region::solid(Sphere::new(point(0.25, 0.0, 0.0), 1.25).unwrap());
    worlds("clipped cubic", Sides::Sheet, Clip::new(cubic, vec![cut, ball]), all);
    let sextic = [
        ([6, 0, 0], 1.0),
        ([0, 6, 0], 1.0),
        ([0, 0, 6], 0.5),
        ([2, 2, 2], -0.25),
        ([0, 1, 0], 0.25),
        ([0, 0, 0], -0.75),
    ];
    worlds("sextic", Sides::Smooth, of(6, &sextic), all);
    // Two balls that blend, with a dent; and a sausage across another one that is placed.
    let component = |shape, radius, strength, place| BlobComponent { shape, radius, strength, place };
    let ball = |x: f64, z: f64, r: f64, s: f64| {
        component(BlobShape::Ball(point(x, 0.25, z)), r, s, Affine::IDENTITY)
    };
    let balls = [ball(-0.5, 0.0, 1.0, 1.0), ball(0.5, 0.25, 0.75, 1.5), ball(0.0, -0.5, 0.5, -0.75)];
    worlds("balls", Sides::Rounded, Blob::new(0.5, &balls).unwrap(), all);
    let segment = |a, b| BlobShape::Segment(a, b);
    let sausages = [
        component(segment(point(-1.0, 0.0, 0.0), point(1.0, 0.0, 0.0)), 0.5, 1.0, Affine::IDENTITY),
        component(segment(point(0.0, -1.0, -0.25), point(0.0, 0.75, 0.5)), 0.5, 1.25, map()),
        component(BlobShape::Ball(point(0.25, 0.25, 0.25)), 0.75, -0.5, Affine::IDENTITY),
    ];
    worlds("sausages", Sides::Rounded, Blob::new(0.375, &sausages).unwrap(), all);
    let (heart, hole) = heart();
    let curves = [heart.as_slice(), hole.as_slice()];
    worlds("curved prism", Sides::Solid, CurvedPrism::linear(&curves, -0.5, 0.75).unwrap(), all);
    worlds("conic curved prism", Sides::Solid, CurvedPrism::conic(&curves, -0.5, 1.0).unwrap(), all);
    let open = CurvedPrism::conic(&curves, 0.25, 1.0).unwrap().without_caps();
    worlds("open curved prism", Sides::Sheet, open, all);
    // A star that winds twice around its middle, and an eight.
    let star = [crossed_star()];
    worlds("crossed prism", Sides::Solid, Prism::linear(&star, -0.5, 0.75).unwrap(), all);
    worlds("crossed conic prism", Sides::Solid, Prism::conic(&star, 0.25, 1.0).unwrap(), all);
    let eight = [crossed_eight()];
    worlds("crossed curved prism", Sides::Solid, CurvedPrism::linear(&eight, -0.5, 0.75).unwrap(), all);
    level_worlds(all);
    worlds("cubic", Sides::Smooth, padded, all);
    worlds("cloud", Sides::Rounded, cloud(), all);
    hypercomplex_worlds(all);
    // A cushion with sharper corners.
    let decic = [
        ([10, 0, 0], 1.0),
        ([0, 10, 0], 0.5),
        ([0, 0, 10], 1.0),
        ([4, 2, 4], 0.25),
        ([1, 0, 2], 0.125),
        ([0, 0, 0], -0.875),
    ];
    worlds("decic", Sides::Smooth, of(10, &decic), all);
    core::mem::take(&mut all.1)
}

/// Solids whose filters classify segments.
fn level_worlds(all: &mut Worlds) {
    let set = Julia {
        c: [-0.083, 0.0, -0.83, -0.025],
        algebra: JuliaAlgebra::Quaternion,
        power: JuliaPower::Square,
        iterations: 5,
        radius: 2.0,
        normal: [0.0, 0.25, 0.0, 1.0],
        distance: 0.125,
    };
    worlds("julia", Sides::Bracketed, JuliaSet::new(&set).unwrap(), all);
    let cube = Julia { c: [0.25, -0.5, 0.25, 0.0], power: JuliaPower::Cube, iterations: 3, ..set };
    worlds("cubic julia", Sides::Bracketed, JuliaSet::new(&cube).unwrap(), all);
    // Slightly smaller, so that few rays on a grid touch it: each that does evaluates the formula
    // thousands of times.
    let cushion = Placed::new(superellipsoid(0.5, 1.25).unwrap(), scaled(0.9));
    worlds("cushion", Sides::Bracketed, cushion, all);
    contained_worlds(all);
}

/// Sets of pairs of complex numbers.
fn hypercomplex_worlds(all: &mut Worlds) {
    let set = Julia {
        c: [-0.5, 0.125, 0.25, 0.0625],
        algebra: JuliaAlgebra::Hypercomplex,
        power: JuliaPower::Square,
        iterations: 5,
        radius: 4.0,
        normal: [0.0, 0.25, 0.0, 1.0],
        distance: 0.125,
    };
    worlds("hypercomplex julia", Sides::Bracketed, JuliaSet::new(&set).unwrap(), all);
    let cube = Julia { power: JuliaPower::Cube, iterations: 3, ..set };
    worlds("hypercomplex cubic julia", Sides::Bracketed, JuliaSet::new(&cube).unwrap(), all);
}

/// Formulas in containers.
fn contained_worlds(all: &mut Worlds) {
    let o = Point3::ORIGIN;
    // x² + 2 y² + z⁴ + x z / 2 - 3/4, smooth and strictly within its container.
    let mut b = Builder::new();
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i).unwrap());
    let (two, half, rest) = (b.constant(2.0).unwrap(), b.constant(0.5).unwrap(), b.constant(0.75).unwrap());
    let (xx, yy) = (b.push(Op::Sqr(x)).unwrap(), b.push(Op::Sqr(y)).unwrap());
    let z4 = b.push(Op::Powi(z, 4)).unwrap();
    let xz = b.push(Op::Mul(x, z)).unwrap();
    let (yy, xz) = (b.push(Op::Mul(two, yy)).unwrap(), b.push(Op::Mul(half, xz)).unwrap());
    let sum = b.push(Op::Add(xx, yy)).unwrap();
    let sum = b.push(Op::Add(sum, z4)).unwrap();
    let sum = b.push(Op::Add(sum, xz)).unwrap();
    let root = b.push(Op::Sub(sum, rest)).unwrap();
    let held = AxisBox::new(point(-1.25, -1.25, -1.25), point(1.25, 1.25, 1.25)).unwrap();
    let egg = Isosurface::new(&b.finish(root, 3), 0.0, Container::Box(held)).unwrap();
    worlds("egg", Sides::Bracketed, egg, all);
    partly_defined_worlds(held, all);
    // sin 4x + y² - z, cut by a ball or a box.
    let mut b = Builder::new();
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i).unwrap());
    let four = b.constant(4.0).unwrap();
    let x = b.push(Op::Mul(four, x)).unwrap();
    let wave = b.push(Op::Function(Function::Sin, x)).unwrap();
    let size = b.push(Op::Sqr(y)).unwrap();
    let sum = b.push(Op::Add(wave, size)).unwrap();
    let root = b.push(Op::Sub(sum, z)).unwrap();
    let formula = b.finish(root, 3);
    let ball = Sphere::new(o, 1.0).unwrap();
    let waves = Isosurface::new(&formula, 0.25, Container::Ball(ball)).unwrap();
    let around = Container::Ball(Sphere::new(o, 4.0).unwrap());
    let endless = Isosurface::new(&formula, 0.25, around).unwrap().without_caps();
    let whole = || DynSurface::new(endless.clone());
    let [closed, open] = [true, false].map(|closed| Sides::Rimmed { closed });
    edged("waves", closed, waves.clone(), [DynSurface::new(ball), whole()], all);
    edged("open waves", open, waves.clone().without_caps(), [DynSurface::new(ball), whole()], all);
    let block = AxisBox::new(point(-1.0, -0.75, -0.5), point(0.75, 1.0, 0.875)).unwrap();
    let boxed = Isosurface::new(&formula, 0.25, Container::Box(block)).unwrap();
    edged("boxed waves", closed, boxed, [DynSurface::new(block), whole()], all);
}

/// Formulas that are undefined on a line far outside their solids, and in a half-space beside them.
fn partly_defined_worlds(held: AxisBox, all: &mut Worlds) {
    // (sqrt(x² + z²) - 3/4)² + y² + sin(3 atan2(z, x)) / 32 - 1/8: a ring with an angle about its
    // axis.
    let mut b = Builder::new();
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i).unwrap());
    let numbers = [0.75, 3.0, 1.0 / 32.0, 0.125].map(|c| b.constant(c).unwrap());
    let [middle, three, little, rest] = numbers;
    let (xx, yy, zz) =
        (b.push(Op::Sqr(x)).unwrap(), b.push(Op::Sqr(y)).unwrap(), b.push(Op::Sqr(z)).unwrap());
    let across = b.push(Op::Add(xx, zz)).unwrap();
    let across = b.push(Op::Sqrt(across)).unwrap();
    let off = b.push(Op::Sub(across, middle)).unwrap();
    let off = b.push(Op::Sqr(off)).unwrap();
    let angle = b.push(Op::Atan2(z, x)).unwrap();
    let angle = b.push(Op::Mul(three, angle)).unwrap();
    let wave = b.push(Op::Function(Function::Sin, angle)).unwrap();
    let wave = b.push(Op::Mul(little, wave)).unwrap();
    let sum = b.push(Op::Add(off, yy)).unwrap();
    let sum = b.push(Op::Add(sum, wave)).unwrap();
    let root = b.push(Op::Sub(sum, rest)).unwrap();
    let ring = Isosurface::new(&b.finish(root, 3), 0.0, Container::Box(held)).unwrap();
    worlds("wavy ring", Sides::Bracketed, ring, all);
    // sqrt x + y² + z² - 1/2, which has no wall where its domain ends.
    let mut b = Builder::new();
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i).unwrap());
    let rest = b.constant(0.5).unwrap();
    let (x, y, z) = (b.push(Op::Sqrt(x)).unwrap(), b.push(Op::Sqr(y)).unwrap(), b.push(Op::Sqr(z)).unwrap());
    let sum = b.push(Op::Add(x, y)).unwrap();
    let sum = b.push(Op::Add(sum, z)).unwrap();
    let root = b.push(Op::Sub(sum, rest)).unwrap();
    let thorn = Isosurface::new(&b.finish(root, 3), 0.0, Container::Box(held)).unwrap();
    worlds("thorn", Sides::Rimmed { closed: false }, thorn, all);
}

/// A star, for random rays. Its ridges are edges that `edges` does not contain, and a start beside
/// one may be on either side.
pub(super) fn star_worlds(isa: Isa) -> Vec<World> {
    let mut all = (isa, Vec::new());
    let star = Placed::new(superellipsoid(3.0, 2.5).unwrap(), scaled(0.9));
    worlds("star", Sides::Rimmed { closed: true }, star, &mut all);
    all.1
}

/// Surfaces that are clipped within their bounding boxes, so that rays enter and leave these where
/// nothing is left: packets know only the boxes.
pub(super) fn clipped_worlds(isa: Isa) -> Vec<World> {
    let all = &mut (isa, Vec::new());
    let pieces = [-0.5, 0.0, 0.5].map(|x| BlobComponent {
        shape: BlobShape::Ball(point(x, 0.0, 0.0)),
        radius: 1.0,
        strength: 1.0,
        place: Affine::IDENTITY,
    });
    let blob = Blob::new(0.5, &pieces).unwrap();
    let middle = Region::solid(Sphere::new(point(0.125, 0.5, -0.25), 0.5).unwrap());
    let hole = Region::solid(Sphere::new(point(0.25, 0.5, 0.0), 0.5).unwrap()).inverse();
    worlds("clipped blob", Sides::Sheet, Clip::new(blob.clone(), vec![middle]), all);
    worlds("blob with a bite", Sides::Sheet, Clip::new(blob, vec![hole]), all);
    core::mem::take(&mut all.1)
}

/// Forty balls and sausages along a spiral, large and small; some are placed, and some are
/// negative.
fn cloud() -> Blob {
    let components = (0..40).map(f64::from).map(|i| {
        let (sin, cos) = durer_math::elementary::sin_cos(i * 0.7);
        let centre = point(cos * i / 50.0, sin * i / 50.0, i / 25.0 - 0.75);
        let shape = match i as u32 % 3 {
            0 => BlobShape::Segment(centre, point(0.0, 0.0, centre.z)),
            _ => BlobShape::Ball(centre),
        };
        let strength = if i as u32 % 7 == 3 { -0.75 } else { 1.0 };
        let place = if i as u32 % 5 == 1 { map() } else { Affine::IDENTITY };
        BlobComponent { shape, radius: 0.125 + i / 100.0, strength, place }
    });
    Blob::new(0.375, &components.collect::<Vec<_>>()).unwrap()
}

/// A surface in all its placements, with edges where a ray meets two other surfaces.
fn edged<S: Algebraic + 'static>(
    name: &'static str,
    sides: Sides,
    surface: S,
    others: [DynSurface; 2],
    all: &mut Worlds,
) {
    let first = all.1.len();
    worlds(name, sides, surface, all);
    let others = others.map(|other| {
        let mut placed = (all.0, Vec::new());
        worlds(name, sides, other, &mut placed);
        placed.1
    });
    let [one, other] = others;
    for ((world, one), other) in all.1[first..].iter_mut().zip(one).zip(other) {
        world.edges = Some([one.geometry, other.geometry]);
    }
}
