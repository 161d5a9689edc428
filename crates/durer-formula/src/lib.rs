//! Formulas as tapes: `f(x, y, z)` as a list of steps that any number type can evaluate.
//!
//! A [`Formula`] is plain data: the content of a scene's `function { }`, with each subexpression
//! once and constants folded. A [`Tape`] is a formula ready to be evaluated on any [`Number`]: on
//! f64 for a value, on eight intervals for bounds on eight boxes or eight stretches of a ray (T.
//! Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive
//! solid geometry", SIGGRAPH 1992), on dual intervals for slopes. On a box where the branch of a
//! `min` or `select` is known, a tape can be [shortened](Tape::shortened) (M. Keeter, "Massively
//! parallel rendering of complex closed-form implicit surfaces", ACM TOG 39(4), 2020).
//!
//! The number types are [`number`]: f64, eight f64 in lanes, eight intervals in lanes ([`I8`]), and
//! [`Dual`] numbers over them. [`noise`] is Perlin's noise and distances to random points, with
//! bounds and slopes on boxes.

mod dual;
mod expr;
mod fold;
mod formula;
mod joined;
mod jumps;
mod lane_angles;
pub mod lane_intervals;
pub mod lane_logs;
mod lane_numbers;
mod lane_powers;
mod lane_waves;
pub mod noise;
pub mod number;
mod powers;
mod program;
mod vector;

pub use dual::Dual;
pub use expr::Expr;
pub use formula::{Builder, Formula, FormulaError, MOST_STEPS, NodeId, Op};
pub use joined::Joined;
pub use lane_intervals::I8;
pub use number::{Comparison, Function, Gradient, Number, Sloped, Slopes};
pub use powers::Powers;
pub use program::Tape;
pub use vector::{VectorTape, lanes};

use durer_math::{F8, Interval};

/// The unit vectors in the first lanes: what `axis` contributes to each.
pub fn seed(axis: usize) -> I8 {
    let mut d = I8::new(F8::ZERO, F8::ZERO);
    d.set_lane(axis, Interval { lo: 1.0, hi: 1.0 });
    d
}
