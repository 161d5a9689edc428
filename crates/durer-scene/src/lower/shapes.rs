//! Lowering of shapes: builds the surface of each shape from its numbers.

use std::fmt::Display;

use durer_math::{Affine, Normal3, Point3, Vec3};
use durer_surfaces::{
    Algebraic, AlgebraicSurface, Annulus, Axis, AxisBox, BezierPatch, Blob, BlobError, CappedCylinder,
    CurvedPrism, Cyclide, Disc, FLAT, Frustum, HeightField, JuliaSet, Lathe, Nurbs, NurbsError,
    Parallelogram, Parametric, ParametricError, PatchError, Plane, Polygon, PolygonError, Prism, Quadric,
    Region, Sewn, Sphere, SphereSweep, SphereSweepError, SphericalSector, SubdivisionError,
    SubdivisionSurface, SurfaceOfRevolution, Torus, Triangle, TriangleError, TriangularPatch, superellipsoid,
};

use durer_surfaces::terrain::{Heights, Sheet};

use super::build::{Target, To};
use super::camera_media::Enclosure;
use super::deformed_surface::{self, Made};
use super::{LowerErrorKind, fold_transform, level_set, named_quadric};
use crate::{Container, Mesh, Object, Shape, Spline, Sweep};

/// The result of lowering a shape.
pub(super) enum Built {
    /// It is in the geometry. If it is solid and the caller asks for it, the test for its inside is
    /// returned.
    Done(Option<Enclosure>),
    /// It has no points, for this reason.
    Nothing(String),
}

pub(super) type Result<T> = std::result::Result<T, LowerErrorKind>;

pub(super) fn shape_error(error: impl Display) -> LowerErrorKind {
    LowerErrorKind::Shape(error.to_string())
}

/// Builds the surface of an object that is not a union, placed in the world by `place`.
pub(super) fn build(object: &Object, open: bool, place: &Affine, mut target: Target<'_>) -> Result<Built> {
    let map = (*place != Affine::IDENTITY).then_some(place);
    match &object.shape {
        &Shape::Sphere { centre, radius } => {
            // The sign of a radius is ignored.
            let radius = radius.abs();
            match folded(map, |m| {
                Some((fold_transform::point(m, centre)?, fold_transform::length(m, radius)?))
            }) {
                Some((c, r)) => add(&mut target, Sphere::new(c, r).map_err(shape_error)?, None),
                None => add(&mut target, Sphere::new(centre, radius).map_err(shape_error)?, map),
            }
        }
        &Shape::Cylinder { base, cap, radius } => {
            let radius = radius.abs();
            target.contain(&CappedCylinder::new(base, cap, radius).map_err(shape_error)?, map);
            let make = |b, c, r| {
                let made = if open { CappedCylinder::open(b, c, r) } else { CappedCylinder::new(b, c, r) };
                made.map_err(shape_error)
            };
            let all = |m: &Affine| {
                Some((
                    fold_transform::point(m, base)?,
                    fold_transform::point(m, cap)?,
                    fold_transform::length(m, radius)?,
                ))
            };
            match folded(map, all) {
                Some((b, c, r)) => target.add(make(b, c, r)?, None),
                None => target.add(make(base, cap, radius)?, map),
            }
        }
        &Shape::Cone { base, base_radius, cap, cap_radius } => {
            target.contain(&Frustum::new(base, base_radius, cap, cap_radius).map_err(shape_error)?, map);
            let make = |b, r0, c, r1| {
                let made = if open { Frustum::open(b, r0, c, r1) } else { Frustum::new(b, r0, c, r1) };
                made.map_err(shape_error)
            };
            let all = |m: &Affine| {
                let ends = (fold_transform::point(m, base)?, fold_transform::point(m, cap)?);
                Some((ends, fold_transform::length(m, base_radius)?, fold_transform::length(m, cap_radius)?))
            };
            match folded(map, all) {
                Some(((b, c), r0, r1)) => target.add(make(b, r0, c, r1)?, None),
                None => target.add(make(base, base_radius, cap, cap_radius)?, map),
            }
        }
        Shape::Quadric(coefficients) => {
            target.add_final(Quadric::new(**coefficients).map_err(shape_error)?, map);
        }
        Shape::Polynomial { order, coefficients } => {
            let surface = AlgebraicSurface::new(*order, coefficients).map_err(shape_error)?;
            target.contain(&surface, map);
            target.add_rare(surface, map);
        }
        &Shape::Torus { major, minor } => {
            let made = |c, axis, major, minor| Torus::new(c, axis, major, minor).map_err(shape_error);
            let all = |m: &Affine| {
                let (axis, size) = fold_transform::axis(m, 1)?;
                Some((
                    m.centre(),
                    AXES[axis],
                    fold_transform::product(size, major)?,
                    fold_transform::product(size, minor)?,
                ))
            };
            match folded(map, all) {
                Some((c, axis, major, minor)) => add(&mut target, made(c, axis, major, minor)?, None),
                None => add(&mut target, made(Point3::ORIGIN, Axis::Y, major, minor)?, map),
            }
        }
        &Shape::Cyclide { a, c, d } => {
            let solid = Cyclide::new(a, c, d).map_err(shape_error)?;
            target.contain(&solid, map);
            target.add_rare(solid, map);
        }
        Shape::Own(surface) => add_closed(&mut target, surface.clone(), map),
        Shape::Prism(shape) => {
            prism(&shape.outlines, shape.spline, shape.heights, shape.sweep, open, map, &mut target)?;
        }
        Shape::StraightSweep(shape) => {
            let path = shape.straight_path().map_err(shape_error)?;
            let sweep = if path.is_conic() { Sweep::Conic } else { Sweep::Linear };
            let all = path.placement().then(place)?;
            prism(&shape.outlines, shape.spline, path.heights(), sweep, open, Some(&all), &mut target)?;
        }
        Shape::PathSweep(sweep) => {
            let sweep = sweep.clone();
            target.contain(&sweep, map);
            target.add_rare(if open { sweep.without_caps() } else { sweep }, map);
        }
        Shape::SphereSweep(spline, spheres) => match SphereSweep::new(*spline, spheres) {
            Err(nothing @ SphereSweepError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?, map),
        },
        Shape::Sor(points) => {
            turned(SurfaceOfRevolution::sor(points).map_err(shape_error)?, open, map, &mut target);
        }
        Shape::Lathe(spline, points) => {
            add_closed(&mut target, Lathe::new(*spline, points).map_err(shape_error)?, map);
        }
        Shape::Patch(it) => match BezierPatch::rational(it.size, &it.points) {
            Err(nothing @ PatchError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?.with_uv(it.uv), map),
        },
        Shape::TriangularPatch(it) => match TriangularPatch::rational(it.side, &it.points) {
            Err(nothing @ PatchError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?.with_uv(it.uv), map),
        },
        Shape::Nurbs(data) => match Nurbs::new((**data).clone()) {
            Err(nothing @ NurbsError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?, map),
        },
        Shape::Subdivision(data) => match SubdivisionSurface::new((**data).clone()) {
            Err(nothing @ SubdivisionError::Nothing(_)) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?, map),
        },
        Shape::Parametric(it) => {
            let container = it.container.map(container).transpose()?;
            let functions = it.functions.each_ref().map(|f| &**f);
            match Parametric::new(functions, it.domain, container.as_ref()) {
                Err(nothing @ ParametricError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
                made => add_closed(&mut target, made.map_err(shape_error)?, map),
            }
        }
        Shape::Sewn(data) => {
            add_closed(&mut target, Sewn::new((**data).clone()).map_err(shape_error)?, map);
        }
        &Shape::Ovus { bottom, top } => {
            turned(SurfaceOfRevolution::ovus(bottom, top).map_err(shape_error)?, open, map, &mut target);
        }
        &Shape::Lemon { base, base_radius, apex, apex_radius, inner_radius } => {
            let axis = apex - base;
            // A length beyond the range of f64 is an error.
            let height = axis.length();
            let solid = SurfaceOfRevolution::lemon(height, base_radius, apex_radius, inner_radius)
                .map_err(shape_error)?;
            let up = axis / height;
            let (u, v) = up.orthonormal_basis();
            let rows = [0, 1, 2].map(|i| [v[i], up[i], u[i]]);
            let all = Affine::new(rows, base)?.then(place)?;
            turned(solid, open, Some(&all), &mut target);
        }
        Shape::Named(quadric) => named_quadric::build(quadric, open, map, &mut target)?,
        &Shape::SphericalSector { centre, radius, axis, half_angle } => {
            let sector =
                SphericalSector::with_half_angle(centre, radius, axis, half_angle).map_err(shape_error)?;
            target.contain(&sector, map);
            target.add_rare(sector, map);
        }
        Shape::Isosurface(iso) => {
            let solid = target.isosurfaces.built(iso)?;
            target.contain(&solid, map);
            target.add_rare(if open { solid.without_caps() } else { solid }, map);
        }
        &Shape::Superellipsoid { e, n } => {
            add_closed(&mut target, superellipsoid(e, n).map_err(shape_error)?, map);
        }
        Shape::Ifs(system) => add_closed(&mut target, system.clone(), map),
        Shape::Julia(set) => add_closed(&mut target, JuliaSet::new(set).map_err(shape_error)?, map),
        Shape::HeightField(field) => sheet(&**field, map, &mut target)?,
        Shape::Terrain(terrain) => sheet(&**terrain, map, &mut target)?,
        Shape::Blob(it) => match Blob::new(it.threshold, &it.components) {
            Err(nothing @ BlobError::Nothing) => return Ok(Built::Nothing(nothing.to_string())),
            made => add_closed(&mut target, made.map_err(shape_error)?, map),
        },
        Shape::Deform(deform) => match deformed_surface::made(deform)? {
            Some(Made::Nothing(why)) => return Ok(Built::Nothing(why)),
            Some(Made::Surface(surface)) => add_closed(&mut target, *surface, map),
            None => match level_set::deformed(deform)? {
                None => {
                    let why = "deform: nothing is left of this solid, so it is left out";
                    return Ok(Built::Nothing(why.into()));
                }
                Some(solid) => add_closed(&mut target, solid, map),
            },
        },
        shape => return flat(shape, map, target),
    }
    Ok(Built::Done(target.inside))
}

/// The container of a function's surface.
pub(super) fn container(it: Container) -> Result<durer_surfaces::Container> {
    Ok(match it {
        Container::Box(a, b) => durer_surfaces::Container::Box(AxisBox::new(a, b).map_err(shape_error)?),
        Container::Ball(centre, radius) => {
            durer_surfaces::Container::Ball(Sphere::new(centre, radius.abs()).map_err(shape_error)?)
        }
    })
}

/// Adds the prism of these outlines between two heights.
fn prism(
    outlines: &[Vec<[f64; 2]>],
    spline: Spline,
    [from, to]: [f64; 2],
    sweep: Sweep,
    open: bool,
    map: Option<&Affine>,
    target: &mut Target<'_>,
) -> Result<()> {
    match spline {
        Spline::Linear => {
            let solid = match sweep {
                Sweep::Linear => Prism::linear(outlines, from, to),
                Sweep::Conic => Prism::conic(outlines, from, to),
            }
            .map_err(shape_error)?;
            target.contain(&solid, map);
            target.add_rare(if open { solid.without_caps() } else { solid }, map);
        }
        Spline::Curved(spline) => {
            let outlines: Vec<_> = outlines.iter().map(|points| spline.pieces(points)).collect();
            let solid = match sweep {
                Sweep::Linear => CurvedPrism::linear(&outlines, from, to),
                Sweep::Conic => CurvedPrism::conic(&outlines, from, to),
            }
            .map_err(shape_error)?;
            target.contain(&solid, map);
            target.add_rare(if open { solid.without_caps() } else { solid }, map);
        }
    }
    Ok(())
}

/// Adds a solid of revolution.
fn turned(solid: SurfaceOfRevolution, open: bool, map: Option<&Affine>, target: &mut Target<'_>) {
    target.contain(&solid, map);
    target.add_rare(if open { solid.without_ends() } else { solid }, map);
}

/// Adds a sheet over the unit square; for a solid, everything below it, also below its water level.
fn sheet<H: Heights + 'static>(
    sheet: &Sheet<H>,
    map: Option<&Affine>,
    target: &mut Target<'_>,
) -> Result<()> {
    let sheet = sheet.clone().shown_in(map);
    let solid = sheet.clone().solid();
    target.contain(&solid, map);
    if matches!(target.to, To::Scene(..)) {
        target.add_rare(sheet, map);
        return Ok(());
    }
    target.add_rare(solid, map);
    let level = sheet.water_level();
    if level > sheet.range()[0] {
        let water = HeightField::new([2, 2], vec![level; 4]).map_err(shape_error)?;
        target.add_rare(water.solid(), map);
    }
    Ok(())
}

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// Adds a solid whose type has an arena of its own.
fn add<S: Algebraic + Clone + 'static>(target: &mut Target<'_>, solid: S, map: Option<&Affine>) {
    target.contain(&solid, map);
    target.add(solid, map);
}

/// Adds a solid that has no ends that could be left open.
fn add_closed<S: Algebraic + Clone + 'static>(target: &mut Target<'_>, solid: S, map: Option<&Affine>) {
    target.contain(&solid, map);
    target.add_rare(solid, map);
}

/// Builds flat shapes.
fn flat(shape: &Shape, map: Option<&Affine>, mut target: Target<'_>) -> Result<Built> {
    match shape {
        &Shape::Box { a, b } => {
            let corners = |m: &Affine| {
                fold_transform::is_diagonal(m).then_some(())?;
                Some((fold_transform::point(m, a)?, fold_transform::point(m, b)?))
            };
            match folded(map, corners) {
                Some((a, b)) => add_flat(&mut target, AxisBox::new(a, b).map_err(shape_error)?, None),
                None => add_flat(&mut target, AxisBox::new(a, b).map_err(shape_error)?, map),
            }
        }
        &Shape::Plane { normal, distance } => {
            add_flat(&mut target, Plane::new(normal, distance).map_err(shape_error)?, map);
        }
        &Shape::Disc { centre, normal, radius, hole } => {
            let lengths = |m: &Affine| {
                Some((
                    fold_transform::point(m, centre)?,
                    fold_transform::length(m, radius)?,
                    fold_transform::length(m, hole)?,
                ))
            };
            let (map, (centre, radius, hole)) = match folded(map, lengths) {
                Some(folded) => (None, folded),
                None => (map, (centre, radius, hole)),
            };
            if hole > 0.0 && hole >= radius {
                return Ok(Built::Nothing(
                    "disc: its hole is as large as the disc or larger, so the disc is left out".into(),
                ));
            }
            if hole > 0.0 {
                target.add_rare(Annulus::new(centre, normal, hole, radius).map_err(shape_error)?, map);
            } else {
                target.add_rare(Disc::new(centre, normal, radius).map_err(shape_error)?, map);
            }
        }
        &Shape::Parallelogram { corner, u, v } => {
            let all = |m: &Affine| {
                Some((
                    fold_transform::point(m, corner)?,
                    fold_transform::vector(m, u)?,
                    fold_transform::vector(m, v)?,
                ))
            };
            let (map, (corner, u, v)) = match kept_side(map, all) {
                Some(folded) => (None, folded),
                None => (map, (corner, u, v)),
            };
            target.add_rare(Parallelogram::new(corner, u, v).map_err(shape_error)?, map);
        }
        Shape::Triangle(corners) => {
            let (map, corners) = match kept_side(map, |m| points(m, corners)) {
                Some(folded) => (None, folded),
                None => (map, *corners),
            };
            match Triangle::new(corners) {
                Ok(triangle) => target.add_final(triangle, map),
                Err(TriangleError::Degenerate) => return Ok(Built::Nothing(DEGENERATE.into())),
                Err(e) => return Err(shape_error(e)),
            }
        }
        Shape::SmoothTriangle(data) => {
            let (mut corners, mut normals) = **data;
            match front(&corners, &normals, map) {
                Some(true) => {}
                Some(false) => {
                    corners.swap(1, 2);
                    normals.swap(1, 2);
                }
                None => return Ok(Built::Nothing(TWO_SIDED.into())),
            }
            // Only a translation leaves the normals exactly as they are.
            let moved = |m: &Affine| m.as_translation().and_then(|_| points(m, &corners));
            let (map, corners) = match folded(map, moved) {
                Some(folded) => (None, folded),
                None => (map, corners),
            };
            match Triangle::new(corners) {
                Ok(triangle) => {
                    let normals = normals.map(Vec3::to_normal);
                    target.add_final(triangle.with_normals(normals).map_err(shape_error)?, map);
                }
                Err(TriangleError::Degenerate) => return Ok(Built::Nothing(DEGENERATE.into())),
                Err(e) => return Err(shape_error(e)),
            }
        }
        Shape::Polygon { loops, rule } => match Polygon::new(loops, *rule) {
            Ok(polygon) => target.add_rare(polygon, map),
            Err(why @ (PolygonError::Degenerate | PolygonError::NotPlanar { .. })) => {
                return Ok(Built::Nothing(format!("{why}, so it is left out")));
            }
            Err(why) => return Err(shape_error(why)),
        },
        Shape::Mesh(data) => {
            let mesh = mesh(data)?;
            add_flat(&mut target, mesh, map);
        }
        // The others were built before.
        _ => {}
    }
    Ok(Built::Done(target.inside))
}

/// Adds a flat-faced solid or sheet.
fn add_flat<S: Algebraic + Clone + 'static>(target: &mut Target<'_>, surface: S, map: Option<&Affine>) {
    target.contain(&surface, map);
    target.add_final(surface, map);
}

const DEGENERATE: &str = "triangle: its corners lie on one line, so it is left out";
const TWO_SIDED: &str = "smooth_triangle: its normals do not all look to one side of it, so it is left out";

/// Whether the normals of a smooth triangle point to the side from which its corners are
/// counterclockwise; `None` if they do not all point to one side, before or after placement (a
/// shear rotates a plane's normal and others differently). The scene language has no such triangles
/// except in meshes.
fn front(&[a, b, c]: &[Point3; 3], normals: &[Vec3; 3], map: Option<&Affine>) -> Option<bool> {
    let n = (b - a).cross(c - a);
    if n == Vec3::ZERO {
        // Its corners are refused later.
        return Some(true);
    }
    let side = |n: Vec3, normals: [Vec3; 3]| {
        let sides = normals.map(|v| n.dot(v));
        let all_in_front = sides.iter().all(|&s| s > 0.0);
        (all_in_front || sides.iter().all(|&s| s < 0.0)).then_some(all_in_front)
    };
    let here = side(n, *normals)?;
    let Some(map) = map else { return Some(here) };
    let placed = |v: Vec3| map.normal(v.to_normal()).to_vec();
    side(placed(n), normals.map(placed))
}

/// The numbers of a shape after its placement, if they can express it; without a placement they are
/// the text's own.
fn folded<T>(map: Option<&Affine>, numbers: impl Fn(&Affine) -> Option<T>) -> Option<T> {
    numbers(map.unwrap_or(&Affine::IDENTITY))
}

/// [`folded`] for surfaces whose sides depend on the order of their corners: a mirror image would
/// swap them.
fn kept_side<T>(map: Option<&Affine>, numbers: impl Fn(&Affine) -> Option<T>) -> Option<T> {
    if map.is_some_and(Affine::determinant_is_negative) { None } else { folded(map, numbers) }
}

fn points(map: &Affine, points: &[Point3; 3]) -> Option<[Point3; 3]> {
    let [a, b, c] = points;
    Some([fold_transform::point(map, *a)?, fold_transform::point(map, *b)?, fold_transform::point(map, *c)?])
}

/// The surface of a mesh.
pub(super) fn mesh(data: &Mesh) -> Result<durer_surfaces::Mesh> {
    let mut normal_faces = Vec::new();
    if data.faces.iter().any(|f| f.normals.is_some()) {
        for (number, face) in data.faces.iter().enumerate() {
            let Some(normals) = face.normals else {
                normal_faces.push(FLAT);
                continue;
            };
            let mut values = [Vec3::ZERO; 3];
            for (value, &n) in values.iter_mut().zip(&normals) {
                *value = *data.normals.get(n as usize).ok_or(LowerErrorKind::MeshNormal {
                    face: number,
                    normal: n,
                    count: data.normals.len(),
                })?;
            }
            // A fact of the scene language: a face whose three normals are equal is flat.
            let equal = values[0] == values[1] && values[1] == values[2];
            normal_faces.push(if equal { FLAT } else { normals });
        }
    }
    let normals = if normal_faces.is_empty() { Vec::new() } else { data.normals.clone() };
    let (uv, uv_faces) = texture_coordinates(data)?;
    let built = durer_surfaces::Mesh::new(durer_surfaces::MeshData {
        vertices: data.vertices.clone(),
        faces: data.faces.iter().map(|f| f.vertices).collect(),
        normals: normals.into_iter().map(Vec3::to_normal).collect::<Vec<Normal3>>(),
        normal_faces,
        uv,
        uv_faces,
        ..Default::default()
    });
    let mesh = built.map_err(shape_error)?;
    match data.inside_vector {
        None => Ok(mesh),
        Some(direction) => mesh.solid(direction).map_err(shape_error),
    }
}

/// A number for each corner of each face.
type Triples = Vec<[u32; 3]>;

/// The texture coordinates of all faces. Faces without any get the default ones.
fn texture_coordinates(data: &Mesh) -> Result<(Vec<[f64; 2]>, Triples)> {
    if data.uv_faces.iter().all(Option::is_none) {
        return Ok((Vec::new(), Vec::new()));
    }
    let mut uv = data.uv.clone();
    let count = uv.len();
    uv.extend([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let default = [0, 1, 2].map(|i| (count + i) as u32);
    let of = |face: usize| {
        let named = data.uv_faces.get(face).copied().flatten();
        let missing = named.iter().flatten().find(|&&i| i as usize >= count);
        match missing {
            Some(&uv) => Err(LowerErrorKind::MeshUv { face, uv, count }),
            None => Ok(named.unwrap_or(default)),
        }
    };
    let faces = (0..data.faces.len()).map(of).collect::<Result<_>>()?;
    Ok((uv, faces))
}

/// The region of a clipping solid, placed in the world by its own placement and then by `around`.
pub(super) fn region(clip: &Object, around: &Affine) -> Result<Region> {
    let region = match &clip.shape {
        &Shape::Sphere { centre, radius } => {
            Region::solid(Sphere::new(centre, radius.abs()).map_err(shape_error)?)
        }
        &Shape::Box { a, b } => {
            let boxed = AxisBox::new(a, b).map_err(shape_error)?;
            Region::axis_box(boxed.min(), boxed.max()).map_err(shape_error)?
        }
        &Shape::Cylinder { base, cap, radius } => {
            Region::solid(*CappedCylinder::new(base, cap, radius).map_err(shape_error)?.shape())
        }
        &Shape::Cone { base, base_radius, cap, cap_radius } => {
            Region::solid(*Frustum::new(base, base_radius, cap, cap_radius).map_err(shape_error)?.shape())
        }
        &Shape::Plane { normal, distance } => {
            Region::half_space(normal.to_normal(), distance * normal.length()).map_err(shape_error)?
        }
        Shape::Quadric(coefficients) => {
            Region::solid(*Quadric::new(**coefficients).map_err(shape_error)?.shape())
        }
        Shape::Named(quadric) => named_quadric::region(quadric)?,
        &Shape::SphericalSector { centre, radius, axis, half_angle } => {
            let sector = SphericalSector::with_half_angle(centre, radius, axis, half_angle);
            Region::solid(*sector.map_err(shape_error)?.shape())
        }
        shape => return Err(LowerErrorKind::Clip(shape.name())),
    };
    if !clip.clips.is_empty() {
        return Err(LowerErrorKind::Clip("an object that is itself clipped"));
    }
    let region = if clip.flags.inverse { region.inverse() } else { region };
    let place = clip.placement.affine().then(around)?;
    Ok(if place == Affine::IDENTITY { region } else { region.placed(place) })
}
