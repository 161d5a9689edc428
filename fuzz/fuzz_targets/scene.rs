//! Any text as a scene: read and made ready for rays, or refused.
#![no_main]
#![allow(dead_code, reason = "the other target uses the rest")]

#[path = "../../crates/durer-pov/tests/corpus/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::scene(data));
