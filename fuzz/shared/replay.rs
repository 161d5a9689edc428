//! What fuzzing has found worth keeping, once more: for the tests of the crates that the targets
//! are about.

use std::path::Path;

/// Checks each file of a target's corpus.
///
/// # Panics
///
/// If a file cannot be read, if there are fewer than two, or if the check does.
pub(super) fn each(target: &str, check: impl Fn(&[u8])) {
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
