//! Deformed solids.

use crate::{Object, Warp};

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
