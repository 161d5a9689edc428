//! Surfaces of functions of two parameters.

use std::sync::Arc;

use durer_formula::Formula;

use crate::Container;

/// The surface of three functions of u and v; the stored normal is the cross product of its slopes
/// along u and v.
#[derive(Clone, Debug, PartialEq)]
pub struct Parametric {
    /// The functions of x, y and z, of two numbers each.
    pub functions: [Arc<Formula>; 3],
    /// The ranges of u and of v.
    pub domain: [[f64; 2]; 2],
    /// The container that cuts the surface off. Without it the surface must be bounded.
    pub container: Option<Container>,
}
