//! Any bytes as a polynomial and a ray: the solver finds what Sturm's theorem counts.
#![no_main]

#[path = "../../crates/durer-surfaces/tests/corpus/roots.rs"]
mod roots;

libfuzzer_sys::fuzz_target!(|data: &[u8]| roots::check(data));
