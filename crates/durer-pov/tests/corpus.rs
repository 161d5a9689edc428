//! What fuzzing has found worth keeping, once more.

#[path = "corpus/case.rs"]
mod case;

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
fn scenes_are_read_or_refused() {
    each("scene", case::scene);
}

#[test]
fn functions_have_bounds_or_are_refused() {
    each("function", case::function);
}
