//! Quadrics, and solids cut from space by them.
//!
//! [`body`] holds the method, one for all; [`form`] the arithmetic of one quadric along one ray; each other file one surface.

pub mod body;
pub mod form;
pub mod general;
pub mod round;
pub mod solid;
