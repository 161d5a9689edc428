//! Deformed solids.

use crate::{Object, Warp};

/// A solid or a parametric surface, and the warps applied to it, in order. All of it is one surface
/// with one texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Deform {
    /// The solid, made of shapes with an inside and a formula, combined in any way; a union has no
    /// inner faces here. Or one patch, NURBS, sewn or parametric surface. Textures in it are
    /// ignored.
    pub solid: Object,
    /// The deformation.
    pub warps: Vec<Warp>,
}
