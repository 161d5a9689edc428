//! What tests share: exact arithmetic as an oracle, and random numbers that aim at edges, tangents
//! and wild scales.
//!
//! Only tests depend on this crate. It shares no code with the kernels that it judges.
//!
//! | module | what it holds |
//! |---|---|
//! | [`exact`] | exact numbers `m 2^e`, and where an exact line meets bodies bounded by quadrics |
//! | [`exact_polynomial`] | polynomials in exact numbers |
//! | [`real_root`] | real roots of polynomials as exact numbers |
//! | [`soak`] | the cases that a run draws, and how it reports them |
//! | [`test_rng`] | one generator of random numbers, points, rays and maps |
#![forbid(unsafe_code)]

pub mod exact;
pub mod exact_polynomial;
pub mod real_root;
pub mod soak;
pub mod test_rng;

pub use exact::{
    Clipped, Crossing, Exact, ExactBody, ExactForm, ExactLine, LineCache, Oracle, Surd, exact3, near,
};
pub use real_root::{RealRoot, ZeroOracle, real_roots};
pub use soak::{case_seed, dice, drawn, report};
pub use test_rng::{Feature, TestRng, aim};
