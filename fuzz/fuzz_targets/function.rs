//! Any text as the body of a function: refused, or a formula whose bounds hold its values.
#![no_main]
#![allow(dead_code, reason = "the other target uses the rest")]

#[path = "../../crates/durer-pov/tests/corpus/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::function(data));
