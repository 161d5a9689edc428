//! Containers of surfaces that functions describe.

use durer_math::Point3;

/// The container of a function's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Container {
    /// A box between two opposite corners.
    Box(Point3, Point3),
    /// A ball: its middle and its radius.
    Ball(Point3, f64),
}
