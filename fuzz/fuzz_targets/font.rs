//! Any bytes as a font: text is made of its letters, or it is refused.
#![no_main]
#![allow(dead_code, reason = "the other targets use the rest")]

#[path = "../../crates/durer-pov/tests/corpus/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::font(data));
