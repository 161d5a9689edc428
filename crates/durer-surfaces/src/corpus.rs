//! Inputs that fuzzing found, run again as tests.

#[path = "../tests/corpus/operations.rs"]
mod operations;
#[path = "../../../fuzz/shared/replay.rs"]
mod replay;
#[path = "../tests/corpus/roots.rs"]
mod roots;
#[path = "../examples/tape_soak/case.rs"]
mod tape;

use replay::each;

#[test]
fn polynomials_have_the_roots_that_sturm_counts() {
    each("roots", roots::check);
}

#[test]
fn formulas_have_bounds_slopes_and_roots() {
    each("tape", tape::check);
}

#[test]
fn operations_have_bounds_that_hold_exact_values() {
    each("operations", operations::check);
}
