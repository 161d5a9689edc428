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
    /// The container. Where it cuts the inside, its own face closes the solid, unless the object is
    /// open.
    pub container: Container,
}
