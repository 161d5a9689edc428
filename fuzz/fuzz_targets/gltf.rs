//! Any bytes as a mesh file in the format glTF, as text or binary.
#![no_main]

#[path = "../../crates/durer-mesh/tests/corpus/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::check(data, durer_mesh::Format::Gltf));
