//! Any bytes as one operation of a formula and two intervals: the bounds hold what f64 and what
//! exact arithmetic compute.
#![no_main]

#[path = "../../crates/durer-surfaces/tests/corpus/operations.rs"]
mod operations;

libfuzzer_sys::fuzz_target!(|data: &[u8]| operations::check(data));
