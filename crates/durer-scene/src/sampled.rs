//! Functions that depend on textures: formulas in which the numbers of patterns and pigments stand.
//!
//! ```text
//!   f(x) = F(x, s_0, s_1, ...),   s_k = the number of texture k at the point (A_k, B_k, C_k)(x, s_0, ..., s_(k-1))
//! ```
//!
//! `F` and the coordinates `A_k`, `B_k`, `C_k` are formulas of the function's own inputs `x` and of
//! the numbers before. Textures have no proven bounds, so such a function can be evaluated, but it
//! cannot be the surface of an isosurface.

use std::sync::Arc;

use durer_formula::Formula;

use crate::{Pigment, Placement, PointWarp, Value};

/// A texture that gives numbers at points.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureSource {
    /// The components of a pigment's colour: red, green, blue, filter and transmit are 0 to 4.
    Pigment(Pigment),
    /// The number of a pattern.
    Pattern {
        /// From the pattern's space to that of the function.
        placement: Placement,
        /// Maps of the point, in the order in which they are applied.
        warps: Vec<PointWarp>,
        /// The number.
        value: Value,
    },
}

/// A number of a texture at a point that formulas give.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSample {
    /// The texture.
    pub source: Arc<TextureSource>,
    /// The component of a pigment's colour; without meaning for others.
    pub part: u8,
    /// The coordinates of the point.
    pub at: [Formula; 3],
}

/// A function that depends on textures.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledFunction {
    /// The number of its inputs.
    pub inputs: u32,
    /// The numbers of textures, each of which may depend on those before it.
    pub samples: Vec<TextureSample>,
    /// The value, a formula of the inputs and the numbers of textures.
    pub formula: Formula,
}
