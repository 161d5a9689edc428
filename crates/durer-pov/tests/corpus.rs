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
fn pictures_are_read_or_refused() {
    each("picture", case::picture);
}

#[test]
fn fonts_are_read_or_refused() {
    each("font", case::font);
}

#[test]
fn functions_have_bounds_or_are_refused() {
    each("function", case::function);
}
