//! Surfaces made of faces of degree two: what spheres, quadrics, clipped surfaces and packet filters
//! share.
//!
//! [`form`] is the polynomial of a face and its restriction to a ray; [`boolean_faces`] the crossings
//! of a ray with faces that cut off each other; [`extent`] a box around a quadric between planes;
//! [`chart`] a surface's own coordinates and its texture coordinates.

pub mod boolean_faces;
pub mod chart;
pub mod extent;
pub mod form;
