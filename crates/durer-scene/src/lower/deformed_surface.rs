//! Deformed surfaces that are given by parameters: patches, NURBS, sewn and parametric surfaces.

use durer_surfaces::{
    BezierPatch, DeformSource, DeformStep, DeformedSurface, Nurbs, NurbsError, Parametric, ParametricError,
    PatchError, Sewn, TriangularPatch,
};

use super::LowerErrorKind;
use super::shapes::{Result, container, shape_error};
use crate::{Deform, Object, Shape};

/// The surface of a deformed object, or the reason why there is none.
pub(super) enum Made {
    Surface(Box<DeformedSurface>),
    /// Why there is nothing.
    Nothing(String),
}

/// The deformed surface; `None` for a solid of formulas.
pub(super) fn made(deform: &Deform) -> Result<Option<Made>> {
    let mut steps = Vec::new();
    let source = match source(deform, &mut steps)? {
        None => return Ok(None),
        Some(Err(nothing)) => return Ok(Some(Made::Nothing(nothing))),
        Some(Ok(source)) => source,
    };
    let made = DeformedSurface::new(source, steps).map_err(shape_error)?;
    let nothing = || Made::Nothing("deform: all points of this surface become one, so it is left out".into());
    Ok(Some(made.map_or_else(nothing, |made| Made::Surface(Box::new(made)))))
}

/// A surface, or why it has none.
type Found = core::result::Result<DeformSource, String>;

/// The surface that a deformation begins with, and all that is done to it.
fn source(deform: &Deform, steps: &mut Vec<DeformStep>) -> Result<Option<Found>> {
    let object = &deform.solid;
    let found = match &object.shape {
        Shape::Deform(inner) => source(inner, steps)?,
        _ => leaf(object)?,
    };
    if found.is_some() {
        if object.flags.open {
            return Err(LowerErrorKind::Deform("what is open"));
        }
        if !object.clips.is_empty() {
            return Err(LowerErrorKind::Deform("what is clipped"));
        }
        steps.push(DeformStep::Place(*object.placement.affine()));
        steps.extend(deform.warps.iter().cloned().map(DeformStep::Warp));
    }
    Ok(found)
}

fn leaf(object: &Object) -> Result<Option<Found>> {
    Ok(Some(match &object.shape {
        Shape::Patch(it) => match BezierPatch::rational(it.size, &it.points) {
            Err(nothing @ PatchError::Nothing) => Err(nothing.to_string()),
            made => Ok(DeformSource::Patch(made.map_err(shape_error)?.with_uv(it.uv))),
        },
        Shape::TriangularPatch(it) => match TriangularPatch::rational(it.side, &it.points) {
            Err(nothing @ PatchError::Nothing) => Err(nothing.to_string()),
            made => Ok(DeformSource::Triangular(made.map_err(shape_error)?.with_uv(it.uv))),
        },
        Shape::Nurbs(data) => match Nurbs::new((**data).clone()) {
            Err(nothing @ NurbsError::Nothing) => Err(nothing.to_string()),
            made => Ok(DeformSource::Nurbs(made.map_err(shape_error)?)),
        },
        Shape::Sewn(data) => Ok(DeformSource::Sewn(Sewn::new((**data).clone()).map_err(shape_error)?)),
        Shape::Parametric(it) => {
            let held = it.container.map(container).transpose()?;
            let functions = it.functions.each_ref().map(|f| &**f);
            match Parametric::new(functions, it.domain, held.as_ref()) {
                Err(nothing @ ParametricError::Nothing) => Err(nothing.to_string()),
                made => Ok(DeformSource::Parametric(made.map_err(shape_error)?)),
            }
        }
        _ => return Ok(None),
    }))
}
