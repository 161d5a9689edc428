//! Solvers of equations in one unknown, and of two equations in two. One solver, one file.
//!
//! | module | what it solves |
//! |---|---|
//! | [`quadratic`] | quadratics, with the signs of other forms at their roots |
//! | [`polynomial`] | all roots of a polynomial on an interval, each in a bracket |
//! | [`bernstein`] | polynomials in Bernstein form: signs, roots counted, halved |
//! | [`exact`] | roots of polynomials with dyadic coefficients, counted and separated exactly |
//! | [`two_unknowns`] | zeros of two equations in a cell: Newton's step with Krawczyk's certificate |
//!
//! Functions of ray loops are generic or marked inline, so they are compiled where they are used.
#![forbid(unsafe_code)]

pub mod bernstein;
pub mod exact;
pub mod polynomial;
pub mod quadratic;
mod residues;
pub mod two_unknowns;
