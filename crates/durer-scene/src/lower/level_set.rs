//! Deformed solids: formulas of the solids that can be deformed.

use durer_formula::Formula;
use durer_math::{Aabb, Affine, elementary};
use durer_surfaces::implicit::level_set::primitives::{self, Principal};
use durer_surfaces::{
    Accelerate, AxisBox, Blob, CappedCylinder, Cyclide, Frustum, Isosurface, LevelSet, Plane, Quadric,
    Sphere, SphericalSector, Surface, Torus,
};

use super::shapes::{self, Result, shape_error};
use super::{LowerErrorKind, named_quadric};
use crate::{Deform, NamedQuadric, Object, Operation, QuadricKind, Shape};

/// The surface of a deformed solid; `None` if it is empty.
pub(super) fn deformed(deform: &Deform) -> Result<Option<Isosurface>> {
    let mut solid = level_set(&deform.solid, &Affine::IDENTITY)?;
    for warp in &deform.warps {
        solid = solid.deformed(warp).map_err(shape_error)?;
    }
    if !solid.bounds().is_bounded() && !solid.bounds().is_empty() {
        return Err(shape_error(durer_surfaces::DeformError::Unbounded));
    }
    solid.surface().map_err(shape_error)
}

/// The level set of an object, placed by its own placement and then by `around`.
fn level_set(object: &Object, around: &Affine) -> Result<LevelSet> {
    if object.flags.open {
        return Err(LowerErrorKind::Deform("what is open"));
    }
    if !object.clips.is_empty() {
        return Err(LowerErrorKind::Deform("what is clipped"));
    }
    let place = object.placement.affine().then(around)?;
    let made = match &object.shape {
        Shape::Union(parts) => LevelSet::union(&all(parts, &place)?),
        Shape::Csg(Operation::Merge, parts) => LevelSet::union(&all(parts, &place)?),
        Shape::Csg(Operation::Intersection, parts) => LevelSet::intersection(&all(parts, &place)?),
        Shape::Csg(Operation::Difference, parts) => {
            let mut parts = all(parts, &place)?;
            for part in parts.iter_mut().skip(1) {
                *part = part.complement().map_err(shape_error)?;
            }
            LevelSet::intersection(&parts)
        }
        shape => return leaf(shape, &place, object.flags.inverse),
    };
    turned(made.map_err(shape_error)?, object.flags.inverse)
}

fn all(parts: &[Object], place: &Affine) -> Result<Vec<LevelSet>> {
    parts.iter().map(|part| level_set(part, place)).collect()
}

fn turned(solid: LevelSet, inverse: bool) -> Result<LevelSet> {
    if inverse { solid.complement().map_err(shape_error) } else { Ok(solid) }
}

/// Places a formula. `surface` is the same solid: its constructor has checked the numbers, and it
/// gives the bounds.
fn placed(formula: Formula, surface: &impl Accelerate, place: &Affine) -> Result<LevelSet> {
    let bounds = if surface.bounds().is_bounded() { surface.bounds_through(place) } else { Aabb::UNBOUNDED };
    LevelSet::new(formula, surface.bounds()).placed_within(place, bounds).map_err(shape_error)
}

fn leaf(shape: &Shape, place: &Affine, inverse: bool) -> Result<LevelSet> {
    let made = match shape {
        &Shape::Sphere { centre, radius } => {
            let surface = Sphere::new(centre, radius.abs()).map_err(shape_error)?;
            placed(primitives::ball(centre, radius).map_err(shape_error)?, &surface, place)
        }
        &Shape::Box { a, b } => {
            let surface = AxisBox::new(a, b).map_err(shape_error)?;
            placed(primitives::cuboid(a, b).map_err(shape_error)?, &surface, place)
        }
        &Shape::Cylinder { base, cap, radius } => {
            let surface = CappedCylinder::new(base, cap, radius.abs()).map_err(shape_error)?;
            placed(
                primitives::frustum(base, radius.abs(), cap, radius.abs()).map_err(shape_error)?,
                &surface,
                place,
            )
        }
        &Shape::Cone { base, base_radius, cap, cap_radius } => {
            let surface = Frustum::new(base, base_radius, cap, cap_radius).map_err(shape_error)?;
            placed(
                primitives::frustum(base, base_radius, cap, cap_radius).map_err(shape_error)?,
                &surface,
                place,
            )
        }
        &Shape::Plane { normal, distance } => {
            let surface = Plane::new(normal, distance).map_err(shape_error)?;
            placed(primitives::half_space(normal, distance).map_err(shape_error)?, &surface, place)
        }
        Shape::Quadric(coefficients) => {
            let surface = Quadric::new(**coefficients).map_err(shape_error)?;
            placed(primitives::quadric(**coefficients).map_err(shape_error)?, &surface, place)
        }
        Shape::Polynomial { order, coefficients } => {
            let surface = durer_surfaces::AlgebraicSurface::new(*order, coefficients).map_err(shape_error)?;
            placed(primitives::polynomial(*order, coefficients).map_err(shape_error)?, &surface, place)
        }
        &Shape::Torus { major, minor } => {
            let axis = durer_surfaces::Axis::Y;
            let surface = Torus::new(durer_math::Point3::ORIGIN, axis, major, minor).map_err(shape_error)?;
            placed(primitives::torus(major, minor).map_err(shape_error)?, &surface, place)
        }
        &Shape::Cyclide { a, c, d } => {
            let surface = Cyclide::new(a, c, d).map_err(shape_error)?;
            placed(primitives::cyclide(a, c, d).map_err(shape_error)?, &surface, place)
        }
        Shape::Named(quadric) => {
            let formula = primitives::principal(&principal(quadric)).map_err(shape_error)?;
            let bounds = named_quadric::bounds(quadric, &Affine::IDENTITY)?;
            let placed_bounds = named_quadric::bounds(quadric, place)?;
            LevelSet::new(formula, bounds).placed_within(place, placed_bounds).map_err(shape_error)
        }
        &Shape::SphericalSector { centre, radius, axis, half_angle } => {
            let surface =
                SphericalSector::with_half_angle(centre, radius, axis, half_angle).map_err(shape_error)?;
            // As in the surface: the cosine of the f64 nearest to a right angle is not 0.
            let right = half_angle == core::f64::consts::FRAC_PI_2;
            let cosine = if right { 0.0 } else { elementary::cos(half_angle) };
            placed(primitives::sector(centre, radius, axis, cosine).map_err(shape_error)?, &surface, place)
        }
        Shape::Isosurface(iso) => {
            let container = shapes::container(iso.container)?;
            let own =
                primitives::isosurface(&iso.function, iso.threshold, &container).map_err(shape_error)?;
            own.placed(place).map_err(shape_error)
        }
        &Shape::Superellipsoid { e, n } => {
            primitives::superellipsoid(e, n).map_err(shape_error)?.placed(place).map_err(shape_error)
        }
        Shape::Blob(it) => {
            let surface = Blob::new(it.threshold, &it.components).map_err(shape_error)?;
            let own =
                primitives::blob(it.threshold, &it.components, surface.bounds()).map_err(shape_error)?;
            own.placed(place).map_err(shape_error)
        }
        Shape::Deform(deform) => {
            let mut solid = level_set(&deform.solid, &Affine::IDENTITY)?;
            for warp in &deform.warps {
                solid = solid.deformed(warp).map_err(shape_error)?;
            }
            solid.placed(place).map_err(shape_error)
        }
        shape => return Err(LowerErrorKind::Deform(shape.name())),
    };
    turned(made?, inverse)
}

/// The equation of a named quadric.
fn principal(it: &NamedQuadric) -> Principal {
    let (squares, linear, constant) = match it.kind {
        QuadricKind::Ellipsoid => ([1.0, 1.0, 1.0], [0.0; 3], -1.0),
        QuadricKind::EllipticParaboloid => ([1.0, 1.0, 0.0], [0.0, 0.0, -1.0], 0.0),
        QuadricKind::HyperbolicParaboloid => ([1.0, -1.0, 0.0], [0.0, 0.0, -1.0], 0.0),
        QuadricKind::HyperboloidOneSheet => ([1.0, 1.0, -1.0], [0.0; 3], -1.0),
        QuadricKind::HyperboloidTwoSheets => ([1.0, 1.0, -1.0], [0.0; 3], 1.0),
        QuadricKind::EllipticCone => ([1.0, 1.0, -1.0], [0.0; 3], 0.0),
        QuadricKind::EllipticCylinder => ([1.0, 1.0, 0.0], [0.0; 3], -1.0),
        QuadricKind::HyperbolicCylinder => ([1.0, -1.0, 0.0], [0.0; 3], -1.0),
        QuadricKind::ParabolicCylinder => ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0], 0.0),
    };
    // Semi-axes of axes that the kind does not use have no effect.
    let semi_axes = it.semi_axes.map(|a| if a > 0.0 { a } else { 1.0 });
    Principal { semi_axes, squares, linear, constant, extent: it.extent }
}
