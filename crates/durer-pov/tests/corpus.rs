//! Regression tests: inputs that fuzzing found worth keeping.

#[path = "corpus/case.rs"]
mod case;

#[path = "../../../fuzz/shared/replay.rs"]
mod replay;

use replay::each;

#[test]
fn scenes_are_read_or_refused() {
    each("scene", case::scene);
}

#[test]
fn functions_have_bounds_or_are_refused() {
    each("function", case::function);
}
