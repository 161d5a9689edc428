//! Solvers of equations in one unknown. One solver, one file.

pub(crate) mod bernstein;
pub(crate) mod exact;
pub(crate) mod polynomial;
pub(crate) mod quadratic;
mod residues;
