//! What fuzzing has found worth keeping, once more.

#[path = "corpus/case.rs"]
mod case;

use durer_mesh::Format;
use std::path::Path;

#[test]
fn the_corpus_is_read_or_refused() {
    for (target, format) in
        [("obj", Format::Obj), ("ply", Format::Ply), ("stl", Format::Stl), ("gltf", Format::Gltf)]
    {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
        let files = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        let files: Vec<_> = files.filter_map(Result::ok).map(|f| f.path()).collect();
        assert!(files.len() > 2, "{target}");
        for file in files {
            let bytes = std::fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            println!("{}", file.display());
            case::check(&bytes, format);
        }
    }
}
