//! Regression tests: inputs that fuzzing found worth keeping.

#[path = "corpus/case.rs"]
mod case;
#[path = "../../../fuzz/shared/replay.rs"]
mod replay;

use durer_mesh::Format;

#[test]
fn the_corpus_is_read_or_refused() {
    for (target, format) in
        [("obj", Format::Obj), ("ply", Format::Ply), ("stl", Format::Stl), ("gltf", Format::Gltf)]
    {
        replay::each(target, |bytes| case::check(bytes, format));
    }
}
