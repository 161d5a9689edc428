//! Any bytes as a picture: read as heights and as colours, or refused.
#![no_main]
#![allow(dead_code, reason = "the other targets use the rest")]

#[path = "../../crates/durer-pov/tests/corpus/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::picture(data));
