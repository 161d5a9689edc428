//! Solvers of equations in one unknown, and of two equations in two. One solver, one file.

pub(crate) mod bernstein;
pub(crate) mod exact;
pub(crate) mod polynomial;
pub(crate) mod quadratic;
mod residues;
pub(crate) mod two_unknowns;
