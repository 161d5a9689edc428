//! What fuzzing has found worth keeping, once more.

#[path = "../tests/corpus/operations.rs"]
mod operations;
#[path = "../tests/corpus/roots.rs"]
mod roots;
#[path = "../examples/tape_soak/case.rs"]
mod tape;

use std::path::Path;

fn each(target: &str, check: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
    let files = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let files: Vec<_> = files.filter_map(Result::ok).map(|f| f.path()).collect();
    assert!(files.len() > 1, "{target}");
    for file in files {
        let bytes = std::fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        println!("{}", file.display());
        check(&bytes);
    }
}

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
