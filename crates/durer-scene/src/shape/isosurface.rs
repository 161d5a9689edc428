//! Isosurfaces.

use std::sync::Arc;

use durer_formula::Formula;

use crate::Container;

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
