//! Surfaces as scene data: one function for each kind. Numbers are checked by building the surface once.

use crate::{formula, value_error};
use durer::math::{Aabb, Affine, Point3, Vec3};
use durer::scene::{
    Blob, BlobComponent, BlobShape, Boundary, Colour, Container, Curve, FillRule, Finish, HeightField, Ifs,
    IfsLeaf, Interior, Isosurface, Julia, JuliaAlgebra, JuliaPower, LatheSpline, Lattice, NamedQuadric,
    NurbsData, Object as SceneObject, Operation, Parametric, Patch, PathSpline, PathSweep, Pigment, Prism,
    QuadricKind, Reflection, Rgb, Scene, Scheme, SewnData, Shape, Spline, StraightSweep, SubdivisionData,
    Sweep, SweepData, SweepSpline, Terrain, TerrainData, Texture, TriangularPatch, TrimLoop, UvInterpolation,
    Warp,
};
use pyo3::prelude::*;
use std::sync::Arc;

type V3 = [f64; 3];

/// A surface or solid, with its placement and its look.
#[pyclass(frozen, module = "durer._native")]
#[derive(Clone)]
pub(crate) struct Object(pub(crate) SceneObject);

pub(crate) fn point(p: V3) -> Point3 {
    Point3::new(p[0], p[1], p[2])
}

pub(crate) fn vec3(v: V3) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

pub(crate) fn affine(rows: [[f64; 4]; 3]) -> PyResult<Affine> {
    let linear = rows.map(|r| [r[0], r[1], r[2]]);
    Affine::new(linear, Point3::new(rows[0][3], rows[1][3], rows[2][3])).map_err(value_error)
}

/// The shape, if a scene can hold it.
fn checked(shape: Shape) -> PyResult<Object> {
    checked_object(SceneObject::new(shape))
}

fn checked_object(object: SceneObject) -> PyResult<Object> {
    let scene = Scene { objects: vec![object], ..Scene::default() };
    scene.lower().map_err(value_error)?;
    let [object] = <[SceneObject; 1]>::try_from(scene.objects).map_err(|_| value_error("no object"))?;
    Ok(Object(object))
}

#[pyfunction]
fn sphere(centre: V3, radius: f64) -> PyResult<Object> {
    checked(Shape::Sphere { centre: point(centre), radius })
}

#[pyfunction]
fn axis_box(a: V3, b: V3) -> PyResult<Object> {
    checked(Shape::Box { a: point(a), b: point(b) })
}

#[pyfunction]
fn cylinder(base: V3, cap: V3, radius: f64) -> PyResult<Object> {
    checked(Shape::Cylinder { base: point(base), cap: point(cap), radius })
}

#[pyfunction]
fn cone(base: V3, base_radius: f64, cap: V3, cap_radius: f64) -> PyResult<Object> {
    checked(Shape::Cone { base: point(base), base_radius, cap: point(cap), cap_radius })
}

#[pyfunction]
fn plane(normal: V3, distance: f64) -> PyResult<Object> {
    checked(Shape::Plane { normal: vec3(normal), distance })
}

#[pyfunction]
fn disc(centre: V3, normal: V3, radius: f64, hole: f64) -> PyResult<Object> {
    checked(Shape::Disc { centre: point(centre), normal: vec3(normal), radius, hole })
}

#[pyfunction]
fn parallelogram(corner: V3, u: V3, v: V3) -> PyResult<Object> {
    checked(Shape::Parallelogram { corner: point(corner), u: vec3(u), v: vec3(v) })
}

#[pyfunction]
fn triangle(vertices: [V3; 3], normals: Option<[V3; 3]>) -> PyResult<Object> {
    let corners = vertices.map(point);
    checked(match normals {
        None => Shape::Triangle(corners),
        Some(normals) => Shape::SmoothTriangle(Box::new((corners, normals.map(vec3)))),
    })
}

#[pyfunction]
fn polygon(loops: Vec<Vec<V3>>, even_odd: bool) -> PyResult<Object> {
    let loops = loops.into_iter().map(|l| l.into_iter().map(point).collect()).collect();
    let rule = if even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
    checked(Shape::Polygon { loops, rule })
}

#[pyfunction]
fn quadric(coefficients: [f64; 10]) -> PyResult<Object> {
    checked(Shape::Quadric(Box::new(coefficients)))
}

#[pyfunction]
fn polynomial(order: u32, coefficients: Vec<f64>) -> PyResult<Object> {
    checked(Shape::Polynomial { order, coefficients: coefficients.into() })
}

#[pyfunction]
fn torus(major: f64, minor: f64) -> PyResult<Object> {
    checked(Shape::Torus { major, minor })
}

#[pyfunction]
fn cyclide(a: f64, c: f64, d: f64) -> PyResult<Object> {
    checked(Shape::Cyclide { a, c, d })
}

#[pyfunction]
fn prism(outlines: Vec<Vec<[f64; 2]>>, heights: [f64; 2], spline: &str, conic: bool) -> PyResult<Object> {
    let spline = match spline {
        "linear" => Spline::Linear,
        "quadratic" => Spline::Curved(Curve::Quadratic),
        "cubic" => Spline::Curved(Curve::Cubic),
        "bezier" => Spline::Curved(Curve::Bezier),
        other => {
            return Err(value_error(format!(
                "prism: the spline must be 'linear', 'quadratic', 'cubic' or 'bezier', got '{other}'"
            )));
        }
    };
    let sweep = if conic { Sweep::Conic } else { Sweep::Linear };
    checked(Shape::Prism(Arc::new(Prism { outlines, spline, heights, sweep })))
}

#[pyfunction]
fn sweep(
    outlines: Vec<Vec<[f64; 2]>>,
    path: Vec<[f64; 3]>,
    sizes: Vec<f64>,
    up: Option<[f64; 3]>,
    spline: &str,
    path_spline: &str,
    twist: f64,
) -> PyResult<Object> {
    let spline = match spline {
        "linear" => Spline::Linear,
        "bezier" => Spline::Curved(Curve::Bezier),
        other => {
            return Err(value_error(format!(
                "sweep: the spline must be 'linear' or 'bezier', got '{other}'"
            )));
        }
    };
    let kind = match path_spline {
        "linear" => PathSpline::Linear,
        "cubic" => PathSpline::Cubic,
        "b" => PathSpline::BSpline,
        "bezier" => PathSpline::Bezier,
        other => {
            return Err(value_error(format!(
                "sweep: the path's spline must be 'linear', 'cubic', 'b' or 'bezier', got '{other}'"
            )));
        }
    };
    let up = up.map(vec3);
    if let (PathSpline::Linear, &[from, to], &[start, end], 0.0) = (kind, &path[..], &sizes[..], twist) {
        let (path, sizes) = ([from, to].map(point), [start, end]);
        return checked(Shape::StraightSweep(Arc::new(StraightSweep { outlines, spline, path, sizes, up })));
    }
    if sizes.len() != path.len() {
        return Err(value_error(format!(
            "sweep: {} points need as many sizes, got {}",
            path.len(),
            sizes.len()
        )));
    }
    let outlines = outlines.iter().map(|points| match spline {
        Spline::Curved(curve) => curve.pieces(points),
        Spline::Linear => SweepData::edges(points),
    });
    let path = path.iter().zip(&sizes).map(|(&[x, y, z], &size)| [x, y, z, size]).collect();
    let data = SweepData { outlines: outlines.collect(), spline: kind, path, twist, up };
    checked(Shape::PathSweep(PathSweep::new(data).map_err(|error| value_error(error.to_string()))?))
}

#[pyfunction]
fn sphere_sweep(spheres: Vec<[f64; 4]>, spline: &str) -> PyResult<Object> {
    let spline = match spline {
        "linear" => SweepSpline::Linear,
        "b" => SweepSpline::BSpline,
        "cubic" => SweepSpline::Cubic,
        other => {
            return Err(value_error(format!(
                "sphere sweep: the spline must be 'linear', 'b' or 'cubic', got '{other}'"
            )));
        }
    };
    checked(Shape::SphereSweep(spline, spheres.into()))
}

#[pyfunction]
fn surface_of_revolution(points: Vec<[f64; 2]>) -> PyResult<Object> {
    checked(Shape::Sor(points.into()))
}

#[pyfunction]
fn lathe(points: Vec<[f64; 2]>, spline: &str) -> PyResult<Object> {
    let spline = match spline {
        "linear" => LatheSpline::Linear,
        "quadratic" => LatheSpline::Quadratic,
        "cubic" => LatheSpline::Cubic,
        "bezier" => LatheSpline::Bezier,
        other => {
            return Err(value_error(format!(
                "lathe: the spline must be 'linear', 'quadratic', 'cubic' or 'bezier', got '{other}'"
            )));
        }
    };
    checked(Shape::Lathe(spline, points.into()))
}

#[pyfunction]
fn bezier_patch(points: Vec<[f64; 4]>, size: [usize; 2], uv: [[f64; 2]; 4]) -> PyResult<Object> {
    checked(Shape::Patch(Arc::new(Patch { size, points, uv })))
}

#[pyfunction]
fn triangular_patch(points: Vec<[f64; 4]>, side: usize, uv: [[f64; 2]; 3]) -> PyResult<Object> {
    checked(Shape::TriangularPatch(Arc::new(TriangularPatch { side, points, uv })))
}

#[pyfunction]
fn nurbs(
    points: Vec<[f64; 4]>,
    size: [usize; 2],
    degree: [usize; 2],
    knots: [Vec<f64>; 2],
    periodic: [bool; 2],
    trims: Vec<TrimCurve>,
) -> PyResult<Object> {
    let trims = trims.into_iter().map(trim_loop).collect::<PyResult<_>>()?;
    checked(Shape::Nurbs(Arc::new(NurbsData { degree, size, points, knots, periodic, trims })))
}

/// Surfaces of NURBS objects as one.
#[pyfunction]
fn sewn(surfaces: Vec<PyRef<'_, Object>>, seal: f64, closed: bool) -> PyResult<Object> {
    let mut data = SewnData { surfaces: Vec::new(), seal, closed };
    for (i, surface) in surfaces.iter().enumerate() {
        match &surface.0 {
            SceneObject { shape: Shape::Nurbs(nurbs), placement, .. }
                if *placement.affine() == Affine::IDENTITY =>
            {
                data.surfaces.push((**nurbs).clone());
            }
            _ => return Err(value_error(format!("surfaces: surface {i} is not a Nurbs in its own place"))),
        }
    }
    checked(Shape::Sewn(Arc::new(data)))
}

/// The kind of a trim, its points with their weights, and its degree and knots if it has any.
type TrimCurve = (String, Vec<V3>, usize, Vec<f64>);

fn trim_loop((kind, points, degree, knots): TrimCurve) -> PyResult<TrimLoop> {
    let flat = || points.iter().map(|p| [p[0], p[1]]).collect();
    match kind.as_str() {
        "polygon" => Ok(TrimLoop::Polygon(flat())),
        "bezier" => Ok(TrimLoop::Bezier(flat())),
        "nurbs" => Ok(TrimLoop::Nurbs { degree, points, knots }),
        other => Err(value_error(format!("trims: a kind is 'polygon', 'bezier' or 'nurbs', got '{other}'"))),
    }
}

#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the lists of a control mesh")]
fn subdivision(
    vertices: Vec<[f64; 3]>,
    faces: Vec<Vec<u32>>,
    uv: Vec<[f64; 2]>,
    uv_faces: Vec<Vec<u32>>,
    creases: Vec<(u32, u32, f64)>,
    corners: Vec<(u32, f64)>,
    holes: Vec<u32>,
    smooth_boundary: bool,
    is_loop: bool,
    smooth_uv: bool,
) -> PyResult<Object> {
    checked(Shape::Subdivision(Arc::new(SubdivisionData {
        scheme: if is_loop { Scheme::Loop } else { Scheme::CatmullClark },
        vertices: vertices.into_iter().map(point).collect(),
        faces,
        uv,
        uv_faces,
        creases: creases.into_iter().map(|(a, b, sharpness)| ([a, b], sharpness)).collect(),
        corners,
        holes,
        boundary: if smooth_boundary { Boundary::Smooth } else { Boundary::Corners },
        uv_interpolation: if smooth_uv { UvInterpolation::Smooth } else { UvInterpolation::Linear },
    })))
}

#[pyfunction]
fn ovus(bottom: f64, top: f64) -> PyResult<Object> {
    checked(Shape::Ovus { bottom, top })
}

#[pyfunction]
fn lemon(base: V3, base_radius: f64, apex: V3, apex_radius: f64, inner_radius: f64) -> PyResult<Object> {
    checked(Shape::Lemon { base: point(base), base_radius, apex: point(apex), apex_radius, inner_radius })
}

#[pyfunction]
fn named_quadric(kind: &str, semi_axes: V3, extent: Option<[f64; 2]>) -> PyResult<Object> {
    let kind = match kind {
        "ellipsoid" => QuadricKind::Ellipsoid,
        "elliptic_paraboloid" => QuadricKind::EllipticParaboloid,
        "hyperbolic_paraboloid" => QuadricKind::HyperbolicParaboloid,
        "hyperboloid_one_sheet" => QuadricKind::HyperboloidOneSheet,
        "hyperboloid_two_sheets" => QuadricKind::HyperboloidTwoSheets,
        "elliptic_cone" => QuadricKind::EllipticCone,
        "elliptic_cylinder" => QuadricKind::EllipticCylinder,
        "hyperbolic_cylinder" => QuadricKind::HyperbolicCylinder,
        "parabolic_cylinder" => QuadricKind::ParabolicCylinder,
        other => return Err(value_error(format!("there is no quadric called '{other}'"))),
    };
    checked(Shape::Named(Box::new(NamedQuadric { kind, semi_axes, extent })))
}

#[pyfunction]
fn spherical_sector(centre: V3, radius: f64, axis: V3, half_angle: f64) -> PyResult<Object> {
    checked(Shape::SphericalSector { centre: point(centre), radius, axis: vec3(axis), half_angle })
}

#[pyfunction]
fn superellipsoid(e: f64, n: f64) -> PyResult<Object> {
    checked(Shape::Superellipsoid { e, n })
}

/// Each component: one end, the other end (equal for a ball), its radius and its strength.
#[pyfunction]
fn blob(components: Vec<(V3, V3, f64, f64)>, threshold: f64) -> PyResult<Object> {
    let component = |(a, b, radius, strength): (V3, V3, f64, f64)| BlobComponent {
        shape: if a == b { BlobShape::Ball(point(a)) } else { BlobShape::Segment(point(a), point(b)) },
        radius,
        strength,
        place: Affine::IDENTITY,
    };
    let components = components.into_iter().map(component).collect();
    checked(Shape::Blob(Arc::new(Blob { threshold, components, textures: Vec::new() })))
}

#[pyfunction]
fn julia(
    c: [f64; 4],
    power: u32,
    iterations: u32,
    radius: f64,
    normal: [f64; 4],
    distance: f64,
) -> PyResult<Object> {
    let power = match power {
        2 => JuliaPower::Square,
        3 => JuliaPower::Cube,
        other => return Err(value_error(format!("julia: the power must be 2 or 3, got {other}"))),
    };
    let algebra = JuliaAlgebra::Quaternion;
    let julia = Julia { c, algebra, power, iterations, radius, normal, distance };
    checked(Shape::Julia(Box::new(julia)))
}

/// A leaf (its kind, its points, its radius) under all products of `depth` maps.
#[pyfunction]
fn ifs(kind: &str, points: Vec<V3>, radius: f64, maps: Vec<[[f64; 4]; 3]>, depth: u32) -> PyResult<Object> {
    let leaf = match (kind, &points[..]) {
        ("box", &[a, b]) => IfsLeaf::Box(point(a), point(b)),
        ("sphere", &[centre]) => IfsLeaf::Sphere(point(centre), radius),
        ("tetrahedron", &[a, b, c, d]) => IfsLeaf::Tetrahedron([a, b, c, d].map(point)),
        _ => return Err(value_error(format!("ifs: there is no leaf '{kind}' of {} points", points.len()))),
    };
    let maps = maps.into_iter().map(affine).collect::<PyResult<Vec<_>>>()?;
    let system = Ifs::new(leaf, &maps, depth).map_err(|error| value_error(error.to_string()))?;
    checked(Shape::Ifs(system))
}

#[pyfunction]
fn menger(depth: u32) -> PyResult<Object> {
    checked(Shape::Ifs(Ifs::menger(depth).map_err(|error| value_error(error.to_string()))?))
}

#[pyfunction]
fn sierpinski(depth: u32) -> PyResult<Object> {
    checked(Shape::Ifs(Ifs::sierpinski(depth).map_err(|error| value_error(error.to_string()))?))
}

/// A sheet over the unit square: columns, rows, and heights by rows, that at z = 1 first.
#[pyfunction]
fn height_field(
    size: [usize; 2],
    heights: Vec<f64>,
    water_level: Option<f64>,
    smooth: bool,
) -> PyResult<Object> {
    let field = HeightField::new(size, heights).map_err(|error| value_error(error.to_string()))?;
    let field = if smooth { field.smooth() } else { field };
    let field = field.with_water_level(water_level.unwrap_or(f64::NEG_INFINITY));
    checked(Shape::HeightField(Box::new(field)))
}

#[pyfunction]
fn terrain(
    levels: u32,
    numbers: [f64; 2],
    seed: u64,
    corners: [f64; 4],
    water_level: Option<f64>,
    smooth: bool,
) -> PyResult<Object> {
    let [roughness, amplitude] = numbers;
    let data = TerrainData { levels, roughness, amplitude, seed, corners };
    let terrain = Terrain::new(data).map_err(|error| value_error(error.to_string()))?;
    let terrain = if smooth { terrain.smooth() } else { terrain };
    let terrain = terrain.with_water_level(water_level.unwrap_or(f64::NEG_INFINITY));
    checked(Shape::Terrain(Box::new(terrain)))
}

/// A box or a ball, if one of them is given.
fn container(corners: Option<[V3; 2]>, ball: Option<(V3, f64)>) -> PyResult<Option<Container>> {
    Ok(match (corners, ball) {
        (None, None) => None,
        (Some([a, b]), None) => Some(Container::Box(point(a), point(b))),
        (None, Some((centre, radius))) => Some(Container::Ball(point(centre), radius)),
        (Some(_), Some(_)) => {
            return Err(value_error("there are two containers, a box and a ball: give one"));
        }
    })
}

/// The surface of three functions of u and v.
#[pyfunction]
fn parametric(
    functions: [Vec<formula::Step>; 3],
    domain: [[f64; 2]; 2],
    container_box: Option<[V3; 2]>,
    container_ball: Option<(V3, f64)>,
) -> PyResult<Object> {
    let [x, y, z] = functions;
    let of = |steps: Vec<formula::Step>| formula::build(&steps, 2).map(Arc::new);
    let functions = [of(x)?, of(y)?, of(z)?];
    let container = container(container_box, container_ball)?;
    checked(Shape::Parametric(Arc::new(Parametric { functions, domain, container })))
}

#[pyfunction]
fn isosurface(
    steps: Vec<formula::Step>,
    threshold: f64,
    container_box: Option<[V3; 2]>,
    container_ball: Option<(V3, f64)>,
) -> PyResult<Object> {
    let function = Arc::new(formula::build(&steps, 3)?);
    let Some(container) = container(container_box, container_ball)? else {
        return Err(value_error("formula: a box or a ball must hold the surface"));
    };
    checked(Shape::Isosurface(Box::new(Isosurface { function, threshold, container })))
}

/// The value of a formula at some points.
#[pyfunction]
fn formula_value(steps: Vec<formula::Step>, point: V3) -> PyResult<f64> {
    Ok(formula::build(&steps, 3)?.value(&point))
}

#[pyfunction]
fn union(objects: Vec<PyRef<'_, Object>>) -> Object {
    Object(SceneObject::new(Shape::Union(objects.iter().map(|o| o.0.clone()).collect())))
}

#[pyfunction]
fn csg(operation: &str, objects: Vec<PyRef<'_, Object>>) -> PyResult<Object> {
    let operation = match operation {
        "merge" => Operation::Merge,
        "intersection" => Operation::Intersection,
        "difference" => Operation::Difference,
        other => return Err(value_error(format!("there is no operation called '{other}'"))),
    };
    let parts: Vec<_> = objects.iter().map(|o| o.0.clone()).collect();
    if parts.is_empty() {
        return Err(value_error("a merge, intersection or difference needs at least one solid"));
    }
    checked(Shape::Csg(operation, parts))
}

/// Each warp: "twist", "taper" or "bend", its axis, its number and its two heights.
#[pyfunction]
fn deformed(object: &Object, warps: Vec<(String, V3, f64, [f64; 2], V3)>) -> PyResult<Object> {
    let warp = |(name, axis, number, [from, to], toward): (String, V3, f64, [f64; 2], V3)| {
        let axis = vec3(axis);
        Ok(match &*name {
            "twist" => Warp::Twist { axis, degrees: number, from, to },
            "taper" => Warp::Taper { axis, factor: number, from, to },
            "bend" => Warp::Bend { axis, toward: vec3(toward), degrees: number, from, to },
            other => return Err(value_error(format!("there is no deformation called '{other}'"))),
        })
    };
    let warps = warps.into_iter().map(warp).collect::<PyResult<Vec<_>>>()?;
    checked_object(SceneObject::deformed(object.0.clone(), &warps).map_err(value_error)?)
}

#[pyfunction]
fn latticed(
    object: &Object,
    low: V3,
    high: V3,
    size: [usize; 3],
    moves: Vec<([usize; 3], V3)>,
) -> PyResult<Object> {
    let mut lattice =
        Lattice::new(Aabb::from_points([point(low), point(high)]), size).map_err(value_error)?;
    for (place, by) in moves {
        lattice.shift(place, vec3(by)).map_err(value_error)?;
    }
    let warps = [Warp::Lattice(Arc::new(lattice))];
    checked_object(SceneObject::deformed(object.0.clone(), &warps).map_err(value_error)?)
}

#[pyfunction]
fn placed(object: &Object, rows: [[f64; 4]; 3]) -> PyResult<Object> {
    let mut object = object.0.clone();
    object.transform(&affine(rows)?).map_err(value_error)?;
    Ok(Object(object))
}

#[pyfunction]
fn complement(object: &Object) -> Object {
    let mut object = object.0.clone();
    object.flags.inverse = !object.flags.inverse;
    Object(object)
}

#[pyfunction]
fn without_caps(object: &Object) -> PyResult<Object> {
    let mut object = object.0.clone();
    object.flags.open = true;
    checked_object(object)
}

#[pyfunction]
fn clipped(object: &Object, clips: Vec<PyRef<'_, Object>>) -> PyResult<Object> {
    let mut object = object.0.clone();
    object.clips.extend(clips.iter().map(|c| c.0.clone()));
    checked_object(object)
}

fn rgb(c: V3) -> Rgb {
    Rgb::new(c[0], c[1], c[2])
}

/// The numbers of a look.
#[derive(FromPyObject)]
struct Look {
    colour: V3,
    filter: f64,
    transmit: f64,
    ambient: f64,
    diffuse: f64,
    phong: f64,
    phong_size: f64,
    specular: f64,
    roughness: f64,
    reflection: f64,
    refraction: f64,
}

#[pyfunction]
fn with_texture(object: &Object, look: Look) -> Object {
    let pigment =
        Pigment::solid(Colour { rgb: rgb(look.colour), filter: look.filter, transmit: look.transmit });
    let finish = Finish {
        ambient: Rgb::grey(look.ambient),
        diffuse: look.diffuse,
        phong: look.phong,
        phong_size: look.phong_size,
        specular: look.specular,
        roughness: look.roughness,
        reflection: (look.reflection != 0.0)
            .then(|| Box::new(Reflection::constant(Rgb::grey(look.reflection)))),
        ..Finish::default()
    };
    let mut object = object.0.clone().with_texture(Texture::plain(pigment, finish));
    if look.refraction != 1.0 {
        object = object.with_interior(Interior { ior: look.refraction, ..Interior::default() });
    }
    Object(object)
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Object>()?;
    module.add_function(wrap_pyfunction!(sphere, module)?)?;
    module.add_function(wrap_pyfunction!(axis_box, module)?)?;
    module.add_function(wrap_pyfunction!(cylinder, module)?)?;
    module.add_function(wrap_pyfunction!(cone, module)?)?;
    module.add_function(wrap_pyfunction!(plane, module)?)?;
    module.add_function(wrap_pyfunction!(disc, module)?)?;
    module.add_function(wrap_pyfunction!(parallelogram, module)?)?;
    module.add_function(wrap_pyfunction!(triangle, module)?)?;
    module.add_function(wrap_pyfunction!(polygon, module)?)?;
    module.add_function(wrap_pyfunction!(quadric, module)?)?;
    module.add_function(wrap_pyfunction!(polynomial, module)?)?;
    module.add_function(wrap_pyfunction!(torus, module)?)?;
    module.add_function(wrap_pyfunction!(cyclide, module)?)?;
    module.add_function(wrap_pyfunction!(prism, module)?)?;
    module.add_function(wrap_pyfunction!(sphere_sweep, module)?)?;
    module.add_function(wrap_pyfunction!(surface_of_revolution, module)?)?;
    module.add_function(wrap_pyfunction!(lathe, module)?)?;
    module.add_function(wrap_pyfunction!(sweep, module)?)?;
    module.add_function(wrap_pyfunction!(bezier_patch, module)?)?;
    module.add_function(wrap_pyfunction!(triangular_patch, module)?)?;
    module.add_function(wrap_pyfunction!(nurbs, module)?)?;
    module.add_function(wrap_pyfunction!(subdivision, module)?)?;
    module.add_function(wrap_pyfunction!(sewn, module)?)?;
    module.add_function(wrap_pyfunction!(ovus, module)?)?;
    module.add_function(wrap_pyfunction!(lemon, module)?)?;
    module.add_function(wrap_pyfunction!(named_quadric, module)?)?;
    module.add_function(wrap_pyfunction!(spherical_sector, module)?)?;
    module.add_function(wrap_pyfunction!(superellipsoid, module)?)?;
    module.add_function(wrap_pyfunction!(blob, module)?)?;
    module.add_function(wrap_pyfunction!(julia, module)?)?;
    module.add_function(wrap_pyfunction!(ifs, module)?)?;
    module.add_function(wrap_pyfunction!(menger, module)?)?;
    module.add_function(wrap_pyfunction!(sierpinski, module)?)?;
    module.add_function(wrap_pyfunction!(height_field, module)?)?;
    module.add_function(wrap_pyfunction!(terrain, module)?)?;
    module.add_function(wrap_pyfunction!(parametric, module)?)?;
    module.add_function(wrap_pyfunction!(isosurface, module)?)?;
    module.add_function(wrap_pyfunction!(formula_value, module)?)?;
    module.add_function(wrap_pyfunction!(union, module)?)?;
    module.add_function(wrap_pyfunction!(csg, module)?)?;
    module.add_function(wrap_pyfunction!(deformed, module)?)?;
    module.add_function(wrap_pyfunction!(latticed, module)?)?;
    module.add_function(wrap_pyfunction!(placed, module)?)?;
    module.add_function(wrap_pyfunction!(complement, module)?)?;
    module.add_function(wrap_pyfunction!(without_caps, module)?)?;
    module.add_function(wrap_pyfunction!(clipped, module)?)?;
    module.add_function(wrap_pyfunction!(with_texture, module)?)
}
